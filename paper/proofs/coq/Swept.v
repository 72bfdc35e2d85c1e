(* Theorem U: a mesh on its way stays within its swept margin of its first place. With gradual
   underflow. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Rejected Ieee Shows Outward Finder.
From Sdop Require Import Duality Vectors Norms64.
Open Scope R_scope.

Local Notation g := gradual64.

(* src/volume/swept.rs: Shape::swept_margin. The reach is about the vertices' own origin, which poses
   place at an offset. *)
Definition swept_margin (linear angular offset : point) (reach seconds : R) : R :=
  let size := add64 g reach (norm_in_f64 offset) in
  let angle := mul64 g (norm_in_f64 angular) seconds in
  next_above (add64 g (mul64 g (norm_in_f64 linear) seconds) (mul64 g (Rmin angle 2) size)).

(* A rotation moves a point by twice its sine of half the angle, at most. *)
Lemma chord_square (q : quaternion) (p : point) :
  0 < norm_of q ->
  square (minus (apply (exact_rotation q) p) p)
    <= 4 * ((norm_of q - qw q * qw q) / norm_of q) * square p.
Proof.
  intro N. set (v := pt (qx q) (qy q) (qz q)).
  assert (E : square (minus (apply (exact_rotation q) p) p)
    = 4 * (square v * square p - dot v p * dot v p) / norm_of q).
  { unfold square, minus, apply, exact_rotation, dot, v, pt, norm_of in *.
    cbn [row0 row1 row2 px py pz]. field. lra. }
  rewrite E. replace (norm_of q - qw q * qw q) with (square v)
    by (unfold v, square, norm_of, pt; cbn [px py pz]; ring).
  pose proof (Rle_0_sqr (dot v p)) as S. unfold Rsqr in S.
  apply Rmult_le_reg_r with (norm_of q); [exact N |].
  replace (4 * (square v * square p - dot v p * dot v p) / norm_of q * norm_of q)
    with (4 * (square v * square p - dot v p * dot v p)) by (field; lra).
  replace (4 * (square v / norm_of q) * square p * norm_of q) with (4 * (square v * square p))
    by (field; lra). lra.
Qed.

Lemma chord (q : quaternion) (p : point) :
  norm_of q = 1 ->
  norm (minus (apply (exact_rotation q) p) p) <= 2 * (sqrt (1 - qw q * qw q) * norm p).
Proof.
  intro N. pose proof (chord_square q p ltac:(lra)) as C.
  rewrite N in C. unfold Rdiv in C. rewrite Rinv_1, Rmult_1_r in C.
  assert (V : 0 <= 1 - qw q * qw q).
  { destruct (square_shares q) as (X & Y & Z & _). unfold norm_of in N. lra. }
  pose proof (sqrt_pos (1 - qw q * qw q)) as P. pose proof (norm_nonneg p). apply norm_below.
  - apply Rmult_le_pos; [lra |]. now apply Rmult_le_pos.
  - apply Rle_trans with (1 := C). rewrite <- norm_square, <- (sqrt_sqrt _ V) at 1. lra.
Qed.

Lemma half_chord (angle : R) :
  0 <= angle -> 2 * sqrt (1 - cos (angle / 2) * cos (angle / 2)) <= Rmin angle 2.
Proof.
  intro P. pose proof (sin2 (angle / 2)) as S. unfold Rsqr in S. rewrite <- S.
  replace (sqrt (sin (angle / 2) * sin (angle / 2))) with (Rabs (sin (angle / 2)))
    by (symmetry; apply sqrt_Rsqr_abs).
  pose proof (SIN_bound (angle / 2)) as B. apply Rmin_glb.
  - destruct (Req_dec angle 0) as [-> | N].
    + unfold Rdiv. rewrite Rmult_0_l, sin_0, Rabs_R0. lra.
    + pose proof (sin_lt_x (angle / 2) ltac:(lra)) as L.
      pose proof (sin_lt_x (- (angle / 2))) as L'.
      assert (M : - (angle / 2) <= sin (angle / 2)).
      { destruct (Rle_or_lt PI (angle / 2)) as [G | G].
        - pose proof PI_RGT_0. pose proof PI2_1. lra.
        - pose proof (sin_ge_0 (angle / 2) ltac:(lra) ltac:(lra)). lra. }
      assert (Rabs (sin (angle / 2)) <= angle / 2) by (apply Rabs_le; lra). lra.
  - assert (Rabs (sin (angle / 2)) <= 1) by (apply Rabs_le; lra). lra.
Qed.

(* `up` leaves room in both units. *)
Lemma next_above_room (x : R) :
  0 <= x -> x * (1 + / 134217728) + half_step / 2 <= next_above x.
Proof.
  intro H. unfold next_above, WorldBall.up. rewrite gradual_fl.
  pose proof (nearest32_nonneg x H) as P. rewrite succ_eq_pos by exact P.
  pose proof (error_le_half_ulp_round radix2 (FLT_exp (-149) 24) (fun z => negb (Z.even z)) x) as E.
  fold (nearest32 x) in E.
  pose proof (ulp_FLT_gt radix2 (-149) 24 (nearest32 x)) as G. rewrite Rabs_pos_eq in G by exact P.
  change (bpow radix2 (- (24))) with (/ 16777216) in G.
  assert (L : bpow radix2 (-149) <= ulp radix2 (FLT_exp (-149) 24) (nearest32 x)).
  { apply Rle_trans with (ulp radix2 (FLT_exp (-149) 24) 0).
    - rewrite ulp_FLT_0; [apply Rle_refl | typeclasses eauto].
    - apply ulp_ge_ulp_0; typeclasses eauto. }
  assert (B : bpow radix2 (-149) = 2 * half_step).
  { unfold half_step. change (bpow radix2 (-149)) with (/ IZR (2 ^ 149)).
    change (2 ^ 150)%Z with (2 * 2 ^ 149)%Z. rewrite mult_IZR, Rinv_mult.
    set (h := / IZR (2 ^ 149)). lra. }
  apply Rabs_le_inv in E. lra.
Qed.

Theorem swept_contains (q0 q1 k : quaternion) (t0 t1 x linear angular offset : point)
    (reach seconds angle : R) :
  norm_of q0 <> 0 -> norm_of k = 1 -> qw k = cos (angle / 2) ->
  (forall p, apply (exact_rotation q1) p
    = apply (exact_rotation k) (apply (exact_rotation q0) p)) ->
  0 <= angle <= norm angular * seconds -> distance t0 t1 <= norm linear * seconds ->
  norm x <= reach + norm offset -> 0 <= reach <= IZR (2 ^ 62) -> 0 <= seconds <= IZR (2 ^ 62) ->
  norm linear <= IZR (2 ^ 62) -> norm angular <= IZR (2 ^ 62) -> norm offset <= IZR (2 ^ 62) ->
  distance (posed q0 t0 x) (posed q1 t1 x) <= swept_margin linear angular offset reach seconds.
Proof.
  intros N0 Nk W Turn (A0 & A1) T X (R0 & R1) (S0 & S1) Bl Ba Bo.
  pose proof v_value as V. pose proof tiny64_dust as TD. pose proof (proj1 tiny64_value) as T0.
  pose proof small_dust as (SD & SD').
  destruct small_value as (Sm0 & _ & Sm).
  pose proof half_step_value as (H0 & H1).
  set (far := IZR (2 ^ 62)) in *.
  assert (Far : 1 <= far) by (unfold far; now apply IZR_le).
  assert (Tiny : 1000 * (small * (far * far)) <= half_step).
  { unfold small, half_step, far. rewrite <- mult_IZR.
    apply Rle_trans with (/ IZR (2 ^ 10) ^ 0 * (1000 * (/ IZR (2 ^ 176)))).
    - cbn [pow]. rewrite Rinv_1, Rmult_1_l. apply Rmult_le_compat_l; [lra |].
      change (2 ^ 62 * 2 ^ 62)%Z with (2 ^ 124)%Z. change (2 ^ 300)%Z with (2 ^ 124 * 2 ^ 176)%Z.
      rewrite mult_IZR, Rinv_mult.
      assert (P : 0 < IZR (2 ^ 124)) by now apply IZR_lt.
      replace (/ IZR (2 ^ 124) * / IZR (2 ^ 176) * IZR (2 ^ 124)) with (/ IZR (2 ^ 176)); [lra |].
      field. split; apply IZR_neq; discriminate.
    - cbn [pow]. rewrite Rinv_1, Rmult_1_l. change (2 ^ 176)%Z with (2 ^ 26 * 2 ^ 150)%Z.
      rewrite mult_IZR, Rinv_mult. assert (0 < / IZR (2 ^ 150)) by
        (apply Rinv_0_lt_compat; now apply IZR_lt).
      assert (1000 * / IZR (2 ^ 26) <= 1) by lra.
      rewrite <- (Rmult_1_l (/ IZR (2 ^ 150))) at 2. rewrite <- Rmult_assoc.
      apply Rmult_le_compat_r; lra. }
  (* The exact way. *)
  set (turned := Rmin angle 2).
  set (r0 := apply (exact_rotation q0) x).
  assert (Nr : norm r0 = norm x).
  { unfold r0, norm. rewrite rotation_keeps_norm; [reflexivity |].
    pose proof (Rle_0_sqr (qx q0)). pose proof (Rle_0_sqr (qy q0)). pose proof (Rle_0_sqr (qz q0)).
    pose proof (Rle_0_sqr (qw q0)). unfold Rsqr, norm_of in *. lra. }
  assert (Way : distance (posed q0 t0 x) (posed q1 t1 x)
    <= norm linear * seconds + turned * (reach + norm offset)).
  { unfold distance. replace (minus (posed q1 t1 x) (posed q0 t0 x))
      with (plus (minus t1 t0) (minus (apply (exact_rotation k) r0) r0)).
    - apply Rle_trans with (1 := triangle _ _). apply Rplus_le_compat; [exact T |].
      apply Rle_trans with (1 := chord k r0 Nk). rewrite W, Nr.
      pose proof (half_chord angle A0) as C. fold turned in C.
      rewrite <- Rmult_assoc. apply Rmult_le_compat; [| apply norm_nonneg | exact C | exact X].
      apply Rmult_le_pos; [lra | apply sqrt_pos].
    - unfold posed. rewrite Turn. fold r0. unfold plus, minus. cbn [px py pz]. f_equal; ring. }
  apply Rle_trans with (1 := Way). clear Way.
  (* What is computed. *)
  assert (Up : far <= IZR (2 ^ 100)) by (unfold far; now apply IZR_le).
  destruct (norm_in_f64_error linear ltac:(lra)) as (L0 & L1 & _).
  destruct (norm_in_f64_error angular ltac:(lra)) as (G0 & G1 & _).
  destruct (norm_in_f64_error offset ltac:(lra)) as (O0 & O1 & _).
  pose proof (norm_nonneg linear) as Pl. pose proof (norm_nonneg angular) as Pa.
  pose proof (norm_nonneg offset) as Po.
  assert (Below : forall y, 0 <= y -> y * (1 - v) - dust <= fl64 g y).
  { intros y Py. pose proof (fl64_error g gradually_valid64 y) as E.
    rewrite (Rabs_pos_eq y) in E by exact Py. apply Rabs_le_inv in E. lra. }
  unfold swept_margin, add64, mul64. rewrite !read64_is.
  set (l := norm_in_f64 linear) in *. set (a := norm_in_f64 angular) in *.
  set (o := norm_in_f64 offset) in *.
  assert (Small : small <= small * far) by (rewrite <- (Rmult_1_r small) at 1;
    apply Rmult_le_compat_l; lra).
  assert (Small' : small * far <= small * (far * far)) by (apply Rmult_le_compat_l; [lra |];
    rewrite <- (Rmult_1_r far) at 1; apply Rmult_le_compat_l; lra).
  (* Sizes. *)
  pose proof (Below (reach + o) ltac:(lra)) as B1. pose proof (fl64_nonneg g (reach + o) ltac:(lra)) as P1.
  set (size := fl64 g (reach + o)) in *.
  assert (Size : (reach + norm offset) * (1 - 7 * v) - 3 * small <= size) by (unfold v in *; lra).
  (* The turn. *)
  assert (Las : (norm angular * (1 - 5 * v) - small) * seconds <= a * seconds)
    by (apply Rmult_le_compat_r; lra).
  assert (Ls : small * seconds <= small * far) by (apply Rmult_le_compat_l; lra).
  pose proof (Below (a * seconds) ltac:(apply Rmult_le_pos; lra)) as B2.
  pose proof (fl64_nonneg g (a * seconds) ltac:(apply Rmult_le_pos; lra)) as P2.
  set (angle64 := fl64 g (a * seconds)) in *.
  assert (Pas : 0 <= norm angular * seconds) by (apply Rmult_le_pos; lra).
  assert (Ang : norm angular * seconds * (1 - 7 * v) - 3 * (small * far) <= angle64)
    by (unfold v in *; lra).
  set (turned64 := Rmin angle64 2).
  assert (Turned : 0 <= turned64 /\ turned * (1 - 7 * v) - 3 * (small * far) <= turned64).
  { unfold turned64, turned. split; [apply Rmin_glb; lra |]. unfold Rmin.
    repeat destruct Rle_dec; unfold v in *; lra. }
  assert (Tb : 0 <= turned <= 2).
  { unfold turned. split; [apply Rmin_glb; lra | apply Rmin_r]. }
  (* The products. *)
  assert (Sz : 0 <= reach + norm offset <= 2 * far) by lra.
  assert (Prod : turned * (reach + norm offset) * (1 - 15 * v) - 20 * (small * (far * far))
    <= turned64 * size).
  { destruct Turned as (Q0 & Q1).
    set (s := reach + norm offset) in *. set (e := 3 * (small * far)) in *.
    assert (E0 : 0 <= e) by (unfold e; lra).
    assert (A2 : turned * (1 - 7 * v) <= turned64 + e) by lra.
    assert (A3 : s * (1 - 7 * v) <= size + 3 * small) by lra.
    assert (A4 : turned * (1 - 7 * v) * (s * (1 - 7 * v)) <= (turned64 + e) * (size + 3 * small)).
    { apply Rmult_le_compat; [| | exact A2 | exact A3]; apply Rmult_le_pos; unfold v; lra. }
    destruct (Rle_or_lt size (2.1 * far)) as [Z | Z].
    - assert (A5 : turned64 <= 2) by apply Rmin_r.
      assert (turned64 * (3 * small) <= 2 * (3 * small)) by (apply Rmult_le_compat_r; lra).
      assert (e * size <= e * (2.1 * far)) by (apply Rmult_le_compat_l; lra).
      assert (e * (3 * small) <= e * far) by (apply Rmult_le_compat_l; [lra |]; lra).
      assert (e * far = 3 * (small * (far * far))) by (unfold e; ring).
      assert (0 <= turned * s) by (apply Rmult_le_pos; lra).
      unfold v in *. lra.
    - assert (A5 : turned64 * (2.1 * far) <= turned64 * size) by (apply Rmult_le_compat_l; lra).
      assert (A6 : turned * s <= turned * (2 * far)) by (apply Rmult_le_compat_l; lra).
      assert (A7 : (turned * (1 - 7 * v) - e) * (2.1 * far) <= turned64 * (2.1 * far))
        by (apply Rmult_le_compat_r; lra).
      assert (e * far = 3 * (small * (far * far))) by (unfold e; ring).
      assert (0 <= turned * far) by (apply Rmult_le_pos; lra).
      assert (0 <= turned * s) by (apply Rmult_le_pos; lra).
      unfold v in *. lra. }
  assert (Pl64 : 0 <= l * seconds) by (apply Rmult_le_pos; lra).
  assert (Lin : (norm linear * (1 - 5 * v) - small) * seconds <= l * seconds)
    by (apply Rmult_le_compat_r; lra).
  assert (Lin' : norm linear * seconds * (1 - 5 * v) - small * far <= l * seconds) by lra.
  assert (Pls : 0 <= norm linear * seconds) by (apply Rmult_le_pos; lra).
  assert (Pt : 0 <= turned64 * size) by (apply Rmult_le_pos; [apply Turned | exact P1]).
  pose proof (Below _ Pl64) as B3. pose proof (fl64_nonneg g _ Pl64) as P3.
  pose proof (Below _ Pt) as B4. pose proof (fl64_nonneg g _ Pt) as P4.
  set (lin := fl64 g (l * seconds)) in *. set (turn := fl64 g (turned64 * size)) in *.
  pose proof (Below (lin + turn) ltac:(lra)) as B5.
  pose proof (fl64_nonneg g (lin + turn) ltac:(lra)) as P5.
  pose proof (next_above_room _ P5) as Out.
  apply Rle_trans with (2 := Out).
  set (sum := fl64 g (lin + turn)) in *.
  assert (Pts : 0 <= turned * (reach + norm offset)) by (apply Rmult_le_pos; lra).
  set (way := turned * (reach + norm offset)) in *. set (go := norm linear * seconds) in *.
  assert (All : (go + way) * (1 - 20 * v) - 40 * (small * (far * far)) <= sum)
    by (unfold v in *; lra).
  unfold v in *. lra.
Qed.
