(* How far a posed point is from where f64 arithmetic finds it, in the Euclidean norm. *)
From Coq Require Import Reals ZArith Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose.
Open Scope R_scope.

(* Each row of an exact rotation is a unit vector. *)
Lemma unit_rows (q : quaternion) :
  0 < norm_of q ->
  dot (row0 (exact_rotation q)) (row0 (exact_rotation q)) = 1 /\
  dot (row1 (exact_rotation q)) (row1 (exact_rotation q)) = 1 /\
  dot (row2 (exact_rotation q)) (row2 (exact_rotation q)) = 1.
Proof.
  intro H. unfold exact_rotation, dot, pt, norm_of in *. cbn [row0 row1 row2 px py pz].
  repeat split; field; lra.
Qed.

Section Row.
Variable m : mode64.
Hypothesis Hm : valid64 m.
Variables a e p : point.
Hypothesis Ha : row_error a e.
Hypothesis He : dot e e = 1.
Variable size : R.
Hypothesis Hsize : 0 <= size <= big / 2.
Hypothesis Hx : Rabs (px p) <= size.
Hypothesis Hy : Rabs (py p) <= size.
Hypothesis Hz : Rabs (pz p) <= size.

Lemma entries_sum : Rabs (px e) + Rabs (py e) + Rabs (pz e) <= 1.73206.
Proof.
  pose proof (Rabs_pos (px e)). pose proof (Rabs_pos (py e)). pose proof (Rabs_pos (pz e)).
  assert (E : Rabs (px e) * Rabs (px e) + Rabs (py e) * Rabs (py e)
    + Rabs (pz e) * Rabs (pz e) = 1).
  { pose proof He as E. unfold dot in E.
    pose proof (Rsqr_abs (px e)) as A. pose proof (Rsqr_abs (py e)) as B.
    pose proof (Rsqr_abs (pz e)) as C. unfold Rsqr in *. lra. }
  set (x := Rabs (px e)) in *. set (y := Rabs (py e)) in *. set (z := Rabs (pz e)) in *.
  apply Rsqr_incr_0; [| lra | lra]. unfold Rsqr.
  pose proof (Rle_0_sqr (x - y)). pose proof (Rle_0_sqr (y - z)). pose proof (Rle_0_sqr (x - z)).
  unfold Rsqr in *. lra.
Qed.

Lemma term_error (b c f : R) :
  Rabs (b - c) <= 9.1 * v -> Rabs c <= 1.8 -> Rabs f <= size ->
  Rabs (mul64 m b f - c * f) <= v * (Rabs c * size) + dust + (1 + v) * (9.1 * v * size).
Proof.
  intros Hb Hc Hf. pose proof v_value as V. pose proof big_value as B.
  assert (D : Rabs (b * f - c * f) <= 9.1 * v * size).
  { replace (b * f - c * f) with ((b - c) * f) by ring. rewrite Rabs_mult.
    apply Rmult_le_compat; try apply Rabs_pos; assumption. }
  assert (Bb : Rabs b <= big).
  { replace b with (c + (b - c)) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
    apply Rle_trans with 2; [unfold v in *; lra |]. unfold big. now apply IZR_le. }
  assert (Bf : Rabs f <= big) by lra.
  apply Rle_trans with (1 := mul64_near m Hm b f _ _ Bb Bf D).
  do 2 apply Rplus_le_compat_r. apply Rmult_le_compat_l; [lra |]. rewrite Rabs_mult.
  apply Rmult_le_compat_l; [apply Rabs_pos | exact Hf].
Qed.

Lemma coordinate_error (t : R) :
  Rabs t <= size ->
  Rabs (add64 m (rotate_row m a p) t - (dot e p + t)) <= 35.3 * v * size + 20 * dust.
Proof.
  intro Ht. pose proof v_value as V. pose proof dust_value as D. pose proof entries_sum as S.
  destruct Ha as (Ax & Ay & Az).
  pose proof (Rabs_pos (px e)) as Nx. pose proof (Rabs_pos (py e)) as Ny.
  pose proof (Rabs_pos (pz e)) as Nz.
  pose proof (term_error _ _ _ Ax ltac:(lra) Hx) as Ex.
  pose proof (term_error _ _ _ Ay ltac:(lra) Hy) as Ey.
  pose proof (term_error _ _ _ Az ltac:(lra) Hz) as Ez.
  pose proof (add64_near m Hm _ _ _ _ _ _ Ex Ey) as E1.
  pose proof (add64_near m Hm _ _ _ _ _ _ E1 Ez) as E2.
  assert (Et : Rabs (t - t) <= 0) by (rewrite Rminus_diag_eq, Rabs_R0; lra).
  pose proof (add64_near m Hm _ _ _ _ _ _ E2 Et) as E3.
  clear E1 E2 Ex Ey Ez. unfold rotate_row, dot. apply Rle_trans with (1 := E3). clear E3.
  assert (T : forall c f, Rabs f <= size -> Rabs (c * f) <= Rabs c * size).
  { intros c f Hf. rewrite Rabs_mult. apply Rmult_le_compat_l; [apply Rabs_pos | exact Hf]. }
  pose proof (T (px e) _ Hx) as Tx. pose proof (T (py e) _ Hy) as Ty.
  pose proof (T (pz e) _ Hz) as Tz.
  set (x := px e * px p) in *. set (y := py e * py p) in *. set (z := pz e * pz p) in *.
  assert (Sum : Rabs (px e) * size + Rabs (py e) * size + Rabs (pz e) * size <= 1.73206 * size).
  { rewrite <- !Rmult_plus_distr_r. apply Rmult_le_compat_r; lra. }
  set (kx := Rabs (px e) * size) in *. set (ky := Rabs (py e) * size) in *.
  set (kz := Rabs (pz e) * size) in *.
  pose proof (Rabs_pos x). pose proof (Rabs_pos y). pose proof (Rabs_pos z).
  assert (P1 : Rabs (x + y) <= 1.73206 * size).
  { apply Rle_trans with (1 := Rabs_triang _ _). lra. }
  assert (P2 : Rabs (x + y + z) <= 1.73206 * size).
  { apply Rle_trans with (1 := Rabs_triang _ _). pose proof (Rabs_triang x y). lra. }
  assert (P3 : Rabs (x + y + z + t) <= 2.73206 * size).
  { apply Rle_trans with (1 := Rabs_triang _ _). lra. }
  apply (Rmult_le_compat_l v) in P1, P2, P3; [| lra | lra | lra].
  apply (Rmult_le_compat_l v) in Sum; [| lra].
  assert (0 <= v * size) by (apply Rmult_le_pos; lra).
  set (vs := v * size) in *.
  replace (9.1 * v * size) with (9.1 * vs) by (unfold vs; ring).
  replace (35.3 * v * size) with (35.3 * vs) by (unfold vs; ring).
  replace (v * (1.73206 * size)) with (1.73206 * vs) in * by (unfold vs; ring).
  replace (v * (2.73206 * size)) with (2.73206 * vs) in * by (unfold vs; ring).
  clearbody vs x y z kx ky kz. unfold v in *. lra.
Qed.
End Row.

(* A ball's centre and a body's place in the contract, and the larger of their coordinates. *)
Definition within (size : R) (p : point) : Prop :=
  Rabs (px p) <= size /\ Rabs (py p) <= size /\ Rabs (pz p) <= size.

Lemma norm_of_coordinates (p : point) (d : R) : within d p -> norm p <= 1.73206 * d.
Proof.
  intros (Hx & Hy & Hz). pose proof (Rabs_pos (px p)).
  apply norm_below; [lra |]. unfold square.
  assert (S : forall c, Rabs c <= d -> c * c <= d * d).
  { intros c Hc. pose proof (Rsqr_abs c) as E. unfold Rsqr in E. rewrite E.
    pose proof (Rabs_pos c). apply Rmult_le_compat; lra. }
  pose proof (S _ Hx). pose proof (S _ Hy). pose proof (S _ Hz). pose proof (Rle_0_sqr d) as Q.
  unfold Rsqr in Q. lra.
Qed.

(* The exact place of a point. *)
Definition posed (q : quaternion) (t p : point) : point := plus (apply (exact_rotation q) p) t.

Lemma transform_error (m : mode64) (q : quaternion) (t p : point) (size : R) :
  valid64 m -> sound_quaternion q -> 0 <= size <= big / 2 -> within size t -> within size p ->
  distance (posed q t p) (transform m (rotation_of m q) p t) <= 61.15 * v * size + 40 * dust.
Proof.
  intros Hm Hq Hs (Tx & Ty & Tz) (Px & Py & Pz).
  destruct (rotation_error m Hm q Hq) as (R0 & R1 & R2).
  assert (Hn : 0 < norm_of q).
  { destruct Hq as [Hl _]. apply Rlt_le_trans with (2 := Hl).
    unfold least_norm. apply Rinv_0_lt_compat. now apply IZR_lt. }
  destruct (unit_rows q Hn) as (U0 & U1 & U2).
  pose proof dust_value as D. pose proof v_value as V.
  unfold distance. apply Rle_trans with (1.73206 * (35.3 * v * size + 20 * dust)).
  - apply norm_of_coordinates. unfold posed, transform, apply, minus, plus, pt, within.
    cbn [px py pz]. repeat split; apply coordinate_error; assumption.
  - assert (0 <= v * size) by (apply Rmult_le_pos; lra). lra.
Qed.

Lemma dot_bound (e p : point) (size : R) :
  dot e e = 1 -> within size p -> Rabs (dot e p) <= 1.73206 * size.
Proof.
  intros He (Hx & Hy & Hz). pose proof (entries_sum e He) as S.
  pose proof (Rabs_pos (px p)) as P.
  unfold dot. apply Rle_trans with (1 := Rabs_triang _ _).
  assert (T : forall c f, Rabs f <= size -> Rabs (c * f) <= Rabs c * size).
  { intros c f Hf. rewrite Rabs_mult. apply Rmult_le_compat_l; [apply Rabs_pos | exact Hf]. }
  pose proof (Rabs_triang (px e * px p) (py e * py p)).
  pose proof (T (px e) _ Hx). pose proof (T (py e) _ Hy). pose proof (T (pz e) _ Hz).
  apply Rle_trans with ((Rabs (px e) + Rabs (py e) + Rabs (pz e)) * size); [lra |].
  apply Rmult_le_compat_r; lra.
Qed.

Lemma sound_positive (q : quaternion) : sound_quaternion q -> 0 < norm_of q.
Proof.
  intros [Hl _]. apply Rlt_le_trans with (2 := Hl).
  unfold least_norm. apply Rinv_0_lt_compat. now apply IZR_lt.
Qed.

Lemma posed_within (q : quaternion) (t p : point) (a b : R) :
  sound_quaternion q -> within a t -> within b p -> within (1.73206 * b + a) (posed q t p).
Proof.
  intros Hq (Tx & Ty & Tz) Hp. destruct (unit_rows q (sound_positive q Hq)) as (U0 & U1 & U2).
  pose proof (dot_bound _ _ _ U0 Hp). pose proof (dot_bound _ _ _ U1 Hp).
  pose proof (dot_bound _ _ _ U2 Hp).
  unfold posed, apply, plus, pt, within. cbn [px py pz].
  repeat split; (apply Rle_trans with (1 := Rabs_triang _ _); lra).
Qed.

(* Moving the point and the translation moves the posed point. *)
Lemma posed_moved (q : quaternion) (t t' p p' : point) (d : R) :
  sound_quaternion q -> within d (minus t' t) -> within d (minus p' p) ->
  distance (posed q t p) (posed q t' p') <= 4.8 * d.
Proof.
  intros Hq Ht Hp. pose proof (Rabs_pos (px (minus p' p))).
  assert (0 <= d) by (destruct Hp; lra).
  unfold distance.
  replace (minus (posed q t' p') (posed q t p)) with (posed q (minus t' t) (minus p' p)).
  - apply Rle_trans with (1.73206 * (1.73206 * d + d)); [| lra].
    apply norm_of_coordinates. now apply posed_within.
  - unfold posed, apply, plus, minus, dot, pt. cbn [px py pz]. f_equal; ring.
Qed.

Lemma coordinates_of_norm (p : point) (d : R) : norm p <= d -> within d p.
Proof.
  intro H. pose proof (norm_nonneg p) as N. pose proof (norm_square p) as S.
  pose proof (Rle_0_sqr (px p)). pose proof (Rle_0_sqr (py p)). pose proof (Rle_0_sqr (pz p)).
  unfold Rsqr, square, within in *.
  repeat split; (apply Rle_trans with (2 := H); rewrite <- (Rabs_pos_eq (norm p)) by exact N;
    apply Rsqr_le_abs_0; unfold Rsqr; lra).
Qed.
