(* World balls: the posed ball lies in the ball that is stored for it, but for `slack`. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place ReadPose.
Open Scope R_scope.

Section WorldBall.
(* The modes of f32 and of f64. *)
Variable m : mode.
Variable m64 : mode64.
Hypothesis Hm : valid m.
Hypothesis Hm64 : valid64 m64.

(* src/rounding/mod.rs: up *)
Definition up (x : R) : R := succ radix2 (FLT_exp (-149) 24) (fl m x).

Lemma up_above (x : R) : 0 <= x -> x * (1 + / 67108864) - 2 * tiny <= up x.
Proof.
  intro H. pose proof Hm as Ht. unfold valid in Ht. pose proof tiny_value as T.
  pose proof half_step_value as Hh.
  assert (N : 0 <= fl m x) by now apply fl_nonneg.
  unfold up. rewrite succ_eq_pos by exact N.
  pose proof (ulp_ge_0 radix2 (FLT_exp (-149) 24) (fl m x)) as U.
  destruct (Rlt_or_le x (threshold m)) as [Hx | Hx]; [lra |].
  pose proof (fl_kept m Hm x Hx) as K. unfold fl in *.
  rewrite Rabs_pos_eq in * by exact H. rewrite Rlt_bool_false in * by lra.
  pose proof (error_le_half_ulp_round radix2 (FLT_exp (-149) 24) (fun z => negb (Z.even z)) x) as E.
  fold (nearest32 x) in E.
  pose proof (ulp_FLT_gt radix2 (-149) 24 (nearest32 x)) as G.
  rewrite (Rabs_pos_eq (nearest32 x)) in G by exact N.
  change (bpow radix2 (- (24))) with (/ 16777216) in G.
  apply Rabs_le_inv in E. unfold u in *. lra.
Qed.

(* src/rounding/sphere.rs: CENTRE_ERROR, CENTRE_FLOOR and the factor of world_ball *)
Definition centre_error : R := 64 * v.
Definition centre_floor : R := 2 * tiny.
Definition stretch : R := nearest64 1.0001.

(* f64::from of an f32 *)
Definition read_point (p : point) : point := pt (read m (px p)) (read m (py p)) (read m (pz p)).
(* `as f32` of an f64 *)
Definition cast_point (p : point) : point := pt (fl m (px p)) (fl m (py p)) (fl m (pz p)).
Definition is_origin (p : point) : bool :=
  Req_bool (read m (px p)) 0 && Req_bool (read m (py p)) 0 && Req_bool (read m (pz p)) 0.

Definition moved (a b : point) : R :=
  let squared x := mul64 m64 x x in
  sqrt64 m64
    (add64 m64
      (add64 m64 (add64 m64 0 (squared (sub64 m64 (px a) (px b))))
        (squared (sub64 m64 (py a) (py b))))
      (squared (sub64 m64 (pz a) (pz b)))).

Definition largest (p t : point) : R :=
  fold_left (fun most x => Rmax most (Rabs x))
    (px p :: py p :: pz p :: px t :: py t :: pz t :: nil) 0.

(* src/rounding/sphere.rs: world_ball, of src/rounding/pose.rs: rotation *)
Definition world_ball (q : quaternion) (t c : point) (r : R) : ball :=
  if is_origin c then {| centre := t; radius := r |} else
  let exact := transform m64 (rotation_of m64 (read_quaternion m q))
    (read_point c) (read_point t) in
  let centre := cast_point exact in
  let moved := moved exact (read_point centre) in
  let size := largest (read_point c) (read_point t) in
  {| centre := centre;
     radius := up (add64 m64 (add64 m64 (add64 m64 (read m r) (mul64 m64 stretch moved))
                     (mul64 m64 centre_error size)) centre_floor) |}.

(* The distance that the cast moves a centre, for numbers up to 2^64. *)
Definition far : R := IZR (2 ^ 64).
Definition dust_root : R := / IZR (2 ^ 290).

Lemma dust_root_value : 0 < dust_root /\ 100 * (dust * far) <= dust_root * dust_root /\
  dust <= dust_root /\ 1000 * dust_root <= tiny.
Proof.
  unfold dust_root, dust, far, tiny.
  assert (P : forall e, (0 <= e)%Z -> 0 < IZR (2 ^ e))
    by (intros; apply IZR_lt; now apply Z.pow_pos_nonneg).
  repeat split.
  - apply Rinv_0_lt_compat. now apply P.
  - change (2 ^ 700)%Z with (2 ^ 64 * 2 ^ 636)%Z. rewrite mult_IZR.
    replace (100 * (/ (IZR (2 ^ 64) * IZR (2 ^ 636)) * IZR (2 ^ 64))) with (100 * / IZR (2 ^ 636))
      by (field; split; now apply IZR_neq).
    rewrite <- Rinv_mult, <- mult_IZR. change (2 ^ 636)%Z with (2 ^ 290 * 2 ^ 290 * 2 ^ 56)%Z.
    rewrite (mult_IZR (2 ^ 290 * 2 ^ 290)), Rinv_mult.
    set (a := / IZR (2 ^ 290 * 2 ^ 290)).
    assert (0 <= a) by (apply Rlt_le, Rinv_0_lt_compat; now apply IZR_lt).
    assert (100 * / IZR (2 ^ 56) <= 1) by lra.
    replace (100 * (a * / IZR (2 ^ 56))) with (a * (100 * / IZR (2 ^ 56))) by ring.
    rewrite <- (Rmult_1_r a) at 2. now apply Rmult_le_compat_l.
  - apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le].
  - change (2 ^ 290)%Z with (2 ^ 164 * 2 ^ 126)%Z. rewrite mult_IZR, Rinv_mult, <- Rmult_assoc.
    set (a := / IZR (2 ^ 126)).
    assert (0 <= a) by (apply Rlt_le, Rinv_0_lt_compat; now apply IZR_lt).
    assert (1000 * / IZR (2 ^ 164) <= 1) by lra.
    rewrite <- (Rmult_1_l a) at 2. now apply Rmult_le_compat_r.
Qed.

Lemma far_value : 1 <= far <= big / 4.
Proof.
  unfold far, big. split; [now apply IZR_le |].
  change (2 ^ 300)%Z with (2 ^ 298 * 4)%Z. rewrite mult_IZR. unfold Rdiv.
  rewrite Rmult_assoc, Rinv_r, Rmult_1_r by lra. now apply IZR_le.
Qed.

Lemma square64_below (x y : R) :
  Rabs (x - y) <= far ->
  let d := sub64 m64 x y in
  0 <= mul64 m64 d d /\ (x - y) * (x - y) * (1 - 4 * v) - 4 * (dust * far) <= mul64 m64 d d.
Proof.
  intros Hf d. pose proof v_value as V. pose proof dust_value as D. pose proof far_value as F.
  pose proof dust_root_value as (R0 & R1 & R2 & R3).
  assert (N : 0 <= mul64 m64 d d) by (unfold mul64; apply fl64_nonneg, Rle_0_sqr).
  split; [exact N |].
  assert (Ex : Rabs (x - x) <= 0) by (rewrite Rminus_diag_eq, Rabs_R0; lra).
  assert (Ey : Rabs (y - y) <= 0) by (rewrite Rminus_diag_eq, Rabs_R0; lra).
  pose proof (sub64_near m64 Hm64 x y x y 0 0 Ex Ey) as E. fold d in E.
  set (w := x - y) in *.
  assert (Small : dust <= far / 1000000).
  { unfold dust, far. apply Rle_trans with (/ 1000000); [| lra].
    apply Rinv_le_contravar; [lra | now apply IZR_le]. }
  assert (Bd : Rabs d <= big).
  { replace d with (w + (d - w)) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
    unfold v in *. lra. }
  pose proof (mul64_error m64 Hm64 d d Bd Bd) as M.
  rewrite (Rabs_pos_eq (d * d)) in M by apply Rle_0_sqr. apply Rabs_le_inv in M.
  assert (S : Rabs w * (1 - v) - dust <= Rabs d).
  { pose proof (Rabs_triang d (w - d)) as T. replace (d + (w - d)) with w in T by ring.
    rewrite Rabs_minus_sym in E. lra. }
  assert (Q : (Rabs w * (1 - v)) * (Rabs w * (1 - v)) - 2 * (dust * far) <= d * d).
  { pose proof (Rsqr_abs d) as A. unfold Rsqr in A. rewrite A.
    pose proof (Rabs_pos w) as W. pose proof (Rabs_pos d) as Pd.
    set (p := Rabs w * (1 - v)) in *.
    assert (P : 0 <= p <= far).
    { unfold p. split; [apply Rmult_le_pos; lra |].
      rewrite <- (Rmult_1_r far). apply Rmult_le_compat; lra. }
    destruct (Rle_or_lt p dust) as [L | L].
    - assert (p * p <= dust * far) by (apply Rmult_le_compat; lra).
      assert (0 <= dust * far) by (apply Rmult_le_pos; lra).
      pose proof (Rle_0_sqr (Rabs d)) as Z. unfold Rsqr in Z. lra.
    - assert (Z : (p - dust) * (p - dust) <= Rabs d * Rabs d) by (apply Rmult_le_compat; lra).
      assert (dust * p <= dust * far) by (apply Rmult_le_compat_l; lra).
      pose proof (Rle_0_sqr dust) as Y. unfold Rsqr in Y. lra. }
  pose proof (Rsqr_abs w) as A. unfold Rsqr in A.
  assert (dust <= dust * far)
    by (rewrite <- (Rmult_1_r dust) at 1; apply Rmult_le_compat_l; lra).
  replace (Rabs w * (1 - v) * (Rabs w * (1 - v))) with (w * w * ((1 - v) * (1 - v))) in Q
    by (rewrite A; ring).
  pose proof (Rle_0_sqr w) as W2. unfold Rsqr in W2.
  set (ww := w * w) in *. clearbody ww. unfold v in *. lra.
Qed.

Lemma moved_below (a b : point) :
  within far (minus a b) ->
  0 <= moved a b /\ distance b a * (1 - 20 * v) - 3 * dust_root <= moved a b.
Proof.
  intros (Fx & Fy & Fz). cbn [minus px py pz] in *.
  pose proof v_value as V. pose proof dust_value as D. pose proof far_value as F.
  pose proof dust_root_value as (R0 & R1 & R2 & R3).
  destruct (square64_below _ _ Fx) as [Nx Sx]. destruct (square64_below _ _ Fy) as [Ny Sy].
  destruct (square64_below _ _ Fz) as [Nz Sz]. cbv zeta in *.
  unfold moved.
  set (sx := mul64 m64 (sub64 m64 (px a) (px b)) (sub64 m64 (px a) (px b))) in *.
  set (sy := mul64 m64 (sub64 m64 (py a) (py b)) (sub64 m64 (py a) (py b))) in *.
  set (sz := mul64 m64 (sub64 m64 (pz a) (pz b)) (sub64 m64 (pz a) (pz b))) in *.
  pose proof (add64_nonneg m64 0 sx (Rle_refl 0) Nx) as N1.
  pose proof (add64_below m64 Hm64 0 sx (Rle_refl 0) Nx) as B1.
  pose proof (add64_nonneg m64 _ sy N1 Ny) as N2.
  pose proof (add64_below m64 Hm64 _ sy N1 Ny) as B2.
  pose proof (add64_nonneg m64 _ sz N2 Nz) as N3.
  pose proof (add64_below m64 Hm64 _ sz N2 Nz) as B3.
  set (s3 := add64 m64 (add64 m64 (add64 m64 0 sx) sy) sz) in *.
  set (k := distance b a).
  assert (K : k * k = (px a - px b) * (px a - px b) + (py a - py b) * (py a - py b)
    + (pz a - pz b) * (pz a - pz b)) by apply (norm_square (minus a b)).
  assert (K0 : 0 <= k) by apply norm_nonneg.
  pose proof (Rle_0_sqr (px a - px b)). pose proof (Rle_0_sqr (py a - py b)).
  pose proof (Rle_0_sqr (pz a - pz b)). unfold Rsqr in *.
  assert (DF : dust <= dust * far)
    by (rewrite <- (Rmult_1_r dust) at 1; apply Rmult_le_compat_l; lra).
  assert (S : k * k * (1 - 8 * v) - 20 * (dust * far) <= s3).
  { rewrite K. unfold v in *. lra. }
  assert (S' : k * k * (1 - 8 * v) - 21 * (dust * far) <= read64 m64 s3).
  { pose proof (read64_error m64 s3) as E. apply Rabs_le_inv in E.
    pose proof tiny64_dust. pose proof tiny64_value as [T0 _]. lra. }
  pose proof (read64_nonneg m64 s3 N3) as N4.
  set (s4 := read64 m64 s3) in *.
  assert (Q : k * (1 - 8 * v) - dust_root <= sqrt s4).
  { destruct (Rle_or_lt (k * (1 - 8 * v)) dust_root) as [L | L].
    - pose proof (sqrt_pos s4). lra.
    - rewrite <- (sqrt_square (k * (1 - 8 * v) - dust_root)) by lra. apply sqrt_le_1_alt.
      apply Rle_trans with (2 := S').
      assert (dust_root * dust_root <= k * (1 - 8 * v) * dust_root)
        by (apply Rmult_le_compat_r; lra).
      pose proof (Rle_0_sqr k) as Kk. unfold Rsqr in Kk.
      replace ((k * (1 - 8 * v) - dust_root) * (k * (1 - 8 * v) - dust_root))
        with (k * k * ((1 - 8 * v) * (1 - 8 * v)) - 2 * (k * (1 - 8 * v) * dust_root)
          + dust_root * dust_root) by ring.
      set (kk := k * k) in *. unfold v in *. lra. }
  pose proof (sqrt_pos s4) as Q0.
  unfold sqrt64. fold s4. split; [now apply fl64_nonneg |].
  pose proof (fl64_error m64 Hm64 (sqrt s4)) as E. rewrite (Rabs_pos_eq (sqrt s4)) in E by exact Q0.
  apply Rabs_le_inv in E. pose proof tiny64_dust. pose proof tiny64_value as [T0 _].
  set (y := sqrt s4) in *. unfold v in *. lra.
Qed.

Lemma stretch_bounds : 1.00009 <= stretch <= 2.
Proof.
  unfold stretch. set (none := {| threshold64 := 0; reads_zero64 := false |}).
  assert (Hnone : valid64 none).
  { unfold valid64, none. cbn. pose proof tiny64_value as [T0 _]. lra. }
  pose proof (fl64_error none Hnone 1.0001) as E. unfold fl64 in E. cbn in E.
  rewrite Rlt_bool_false in E by apply Rabs_pos.
  rewrite (Rabs_pos_eq 1.0001) in E by lra. apply Rabs_le_inv in E.
  pose proof tiny64_dust. pose proof (proj1 tiny64_value).
  assert (dust <= v).
  { unfold dust, v. apply Rinv_le_contravar; [lra | now apply IZR_le]. }
  unfold v in *. lra.
Qed.

Lemma fl_error (x : R) : Rabs (fl m x - x) <= u * Rabs x + tiny.
Proof.
  pose proof Hm as Ht. unfold valid in Ht. pose proof (Rabs_pos x).
  pose proof half_step_value. pose proof u_value.
  assert (0 <= u * Rabs x) by (apply Rmult_le_pos; lra).
  unfold fl. case Rlt_bool_spec; intro H'.
  - rewrite Rminus_0_l, Rabs_Ropp. lra.
  - pose proof (nearest32_error x). lra.
Qed.

Lemma largest_bounds (p t : point) (limit : R) :
  within limit p -> within limit t -> let size := largest p t in
  0 <= size <= limit /\ within size p /\ within size t.
Proof.
  intros (Px & Py & Pz) (Tx & Ty & Tz) size. unfold size, largest, within. cbn.
  pose proof (Rabs_pos (px p)).
  repeat match goal with |- context [Rmax ?a ?b] =>
    pose proof (Rmax_l a b); pose proof (Rmax_r a b);
    assert (Rmax a b <= limit) by (apply Rmax_lub; lra);
    set (Rmax a b) in *
  end.
  repeat split; lra.
Qed.

(* src/rounding/mod.rs: LIMIT *)
Definition limit : R := IZR (2 ^ 60).

Lemma limit_value : 1 <= limit /\ 16 * limit = far.
Proof.
  unfold limit, far. split; [now apply IZR_le |].
  change (2 ^ 64)%Z with (16 * 2 ^ 60)%Z. now rewrite mult_IZR.
Qed.

Lemma read_within (size : R) (p : point) :
  within size p -> within size (read_point p) /\ within tiny (minus (read_point p) p).
Proof.
  intros (Hx & Hy & Hz). unfold within, read_point, minus, pt. cbn [px py pz].
  repeat split; try apply read_error;
    (eapply Rle_trans; [apply read_abs | assumption]).
Qed.

Lemma origin_near (q : quaternion) (t c : point) :
  sound_quaternion q -> is_origin c = true -> distance (posed q t c) t <= 4.8 * tiny.
Proof.
  intros Hq H. pose proof tiny_value as T. set (o := pt 0 0 0).
  assert (E : posed q t o = t).
  { unfold posed, apply, plus, dot, o, pt. cbn [px py pz]. destruct t. cbn. f_equal; ring. }
  assert (D : distance (posed q t c) (posed q t o) <= 4.8 * tiny); [| now rewrite E in D].
  apply posed_moved; [exact Hq | |].
  - unfold within, minus. cbn [px py pz]. rewrite !Rminus_diag_eq, Rabs_R0 by reflexivity. lra.
  - unfold is_origin in H. apply andb_prop in H. destruct H as [H Hz].
    apply andb_prop in H. destruct H as [Hx Hy].
    assert (Z : forall x, Req_bool (read m x) 0 = true -> Rabs (0 - x) <= tiny).
    { intros x Hxx. revert Hxx. case Req_bool_spec; [| discriminate]. intros R0 _.
      rewrite <- R0. apply read_error. }
    unfold within, minus, o, pt. cbn [px py pz]. repeat split; now apply Z.
Qed.

Lemma cast_near (e : point) (d : R) :
  within d e ->
  within (u * d + 2 * tiny) (minus e (read_point (cast_point e))) /\
  distance (read_point (cast_point e)) (cast_point e) <= 2 * tiny.
Proof.
  intros (Hx & Hy & Hz). pose proof tiny_value as T. pose proof u_value as U. split.
  - assert (C : forall x, Rabs x <= d -> Rabs (x - read m (fl m x)) <= u * d + 2 * tiny).
    { intros x H. pose proof (fl_error x) as F. pose proof (read_error m (fl m x)) as E.
      rewrite Rabs_minus_sym.
      replace (read m (fl m x) - x) with ((read m (fl m x) - fl m x) + (fl m x - x)) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _).
      assert (u * Rabs x <= u * d) by (apply Rmult_le_compat_l; lra). lra. }
    unfold within, minus, read_point, cast_point, pt. cbn [px py pz].
    repeat split; apply C; assumption.
  - unfold distance. apply Rle_trans with (1.73206 * tiny); [| lra].
    apply norm_of_coordinates. unfold within, minus, read_point, cast_point, pt. cbn [px py pz].
    repeat split; rewrite Rabs_minus_sym; apply read_error.
Qed.

(* What is written is no less than what it stands for. *)
Lemma written_radius (r k size : R) :
  0 <= r -> 0 <= k -> 0 <= size <= limit ->
  let sum := add64 m64 (add64 m64 (add64 m64 r (mul64 m64 stretch k)) (mul64 m64 centre_error size))
    centre_floor in
  0 <= up sum /\ r + k * 1.00008 + 64 * v * size - 3 * tiny <= up sum.
Proof.
  intros Hr Hk Hs sum. pose proof v_value as V. pose proof tiny_value as T.
  pose proof dust_root_value as (R0 & R1 & R2 & R3). pose proof stretch_bounds as S.
  pose proof (proj1 tiny64_value) as T0. pose proof tiny64_dust as T1. pose proof dust_value as D.
  assert (V64 : tiny64 <= centre_error <= 2).
  { assert (dust <= v).
    { unfold dust, v. apply Rinv_le_contravar; [lra | now apply IZR_le]. }
    unfold centre_error, v in *. lra. }
  assert (Dv : dust <= 1).
  { unfold dust. apply Rle_trans with (/ 1); [| lra].
    apply Rinv_le_contravar; [lra | now apply IZR_le]. }
  pose proof (mul64_below m64 Hm64 stretch k ltac:(lra) ltac:(lra) Hk) as M1.
  pose proof (mul64_nonneg m64 stretch k ltac:(lra) Hk) as N1.
  pose proof (mul64_below m64 Hm64 centre_error size (proj1 V64) (proj2 V64) (proj1 Hs)) as M2.
  pose proof (mul64_nonneg m64 centre_error size ltac:(lra) (proj1 Hs)) as N2.
  pose proof (add64_below m64 Hm64 _ _ Hr N1) as A1. pose proof (add64_nonneg m64 _ _ Hr N1) as P1.
  pose proof (add64_below m64 Hm64 _ _ P1 N2) as A2. pose proof (add64_nonneg m64 _ _ P1 N2) as P2.
  assert (F : 0 <= centre_floor) by (unfold centre_floor; lra).
  pose proof (add64_below m64 Hm64 _ _ P2 F) as A3. pose proof (add64_nonneg m64 _ _ P2 F) as P3.
  fold sum in A3, P3. pose proof (up_above sum P3) as U.
  split.
  { unfold up. rewrite succ_eq_pos by now apply fl_nonneg. pose proof (fl_nonneg m sum P3).
    pose proof (ulp_ge_0 radix2 (FLT_exp (-149) 24) (fl m sum)). lra. }
  assert (K1 : k * 1.00009 <= stretch * k) by (rewrite Rmult_comm; apply Rmult_le_compat_r; lra).
  set (sk := stretch * k) in *. unfold centre_error, centre_floor in *.
  unfold v in *. lra.
Qed.

(* The posed ball lies in the world ball, but for numbers that are read as zero. *)
Theorem world_ball_contains (q : quaternion) (t c : point) (r : R) :
  sound_quaternion q -> readable m q -> within limit t -> within limit c -> 0 <= r ->
  let b := world_ball q t c r in
  0 <= radius b /\ distance (posed q t c) (centre b) + r <= radius b + slack / 2.
Proof.
  intros Hq Hread Ht Hc Hr. unfold world_ball. pose proof tiny_value as T.
  destruct (is_origin c) eqn:O; cbn [centre radius].
  - pose proof (origin_near q t c Hq O). unfold slack. lra.
  - destruct (read_within _ _ Ht) as [Ht' Mt]. destruct (read_within _ _ Hc) as [Hc' Mc].
    set (t' := read_point t) in *. set (c' := read_point c) in *.
    destruct (largest_bounds c' t' limit Hc' Ht') as (Hs & Sc & St).
    set (size := largest c' t') in *.
    pose proof limit_value as [L0 L1]. pose proof far_value as F. pose proof v_value as V.
    pose proof dust_root_value as (R0 & R1 & R2 & R3). pose proof dust_value as D.
    destruct (read_turn m q t' c' size Hq Hread Sc) as [Hq' E0].
    set (q' := read_quaternion m q) in *.
    pose proof (transform_error m64 q' t' c' size Hm64 Hq' ltac:(lra) St Sc) as E1.
    set (e := transform m64 (rotation_of m64 q') c' t') in *.
    pose proof (posed_moved q t t' c c' tiny Hq Mt Mc) as E2.
    assert (We : within (4 * limit) e).
    { pose proof (posed_within q' t' c' size size Hq' St Sc) as P.
      pose proof (coordinates_of_norm _ _ E1) as Q.
      unfold within, distance, minus in *. cbn [px py pz] in Q.
      assert (W : forall a b d f, Rabs b <= d -> Rabs (a - b) <= f -> Rabs a <= d + f).
      { intros a b d f Hb Hd. replace a with (b + (a - b)) by ring.
        apply Rle_trans with (1 := Rabs_triang _ _). lra. }
      assert (B : 1.73206 * size + size + (61.15 * v * size + 40 * dust) <= 4 * limit).
      { assert (v * size <= v * limit) by (apply Rmult_le_compat_l; lra).
        assert (tiny <= 1 / 1000) by (unfold tiny; lra). unfold v in *. lra. }
      destruct P as (P0 & P1 & P2). destruct Q as (Q0 & Q1 & Q2).
      exact (conj (Rle_trans _ _ _ (W _ _ _ _ P0 Q0) B)
        (conj (Rle_trans _ _ _ (W _ _ _ _ P1 Q1) B) (Rle_trans _ _ _ (W _ _ _ _ P2 Q2) B))). }
    destruct (cast_near e _ We) as [C1 C2].
    assert (Tf : tiny <= 1 / 1000) by (unfold tiny; lra).
    assert (Wd : within far (minus e (read_point (cast_point e)))).
    { destruct C1 as (C1x & C1y & C1z). repeat split;
        (eapply Rle_trans; [eassumption |]); unfold u in *; lra. }
    destruct (moved_below _ _ Wd) as [K0 K1].
    assert (R' : 0 <= read m r) by now apply read_nonneg.
    pose proof (read_error m r) as Rr. apply Rabs_le_inv in Rr.
    destruct (written_radius (read m r) _ size R' K0 Hs) as [U0 U1].
    split; [exact U0 |].
    set (w := cast_point e) in *. set (k := moved e (read_point w)) in *.
    pose proof (distance_triangle (posed q t c) (posed q t' c') w).
    pose proof (distance_triangle (posed q t' c') (posed q' t' c') w).
    pose proof (distance_triangle (posed q' t' c') e w).
    pose proof (distance_triangle e (read_point w) w).
    rewrite (distance_symmetric e (read_point w)) in *.
    set (total := up _) in *.
    pose proof (norm_nonneg (minus e (read_point w))) as N. fold (distance (read_point w) e) in N.
    assert (0 <= v * size) by (apply Rmult_le_pos; lra).
    set (vs := v * size) in *.
    replace (0.2 * v * size) with (0.2 * vs) in E0 by (unfold vs; ring).
    replace (61.15 * v * size) with (61.15 * vs) in E1 by (unfold vs; ring).
    replace (64 * v * size) with (64 * vs) in U1 by (unfold vs; ring).
    unfold slack, v in *. lra.
Qed.
End WorldBall.
