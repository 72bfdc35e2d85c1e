(* Theorem R: world-aligned slabs that are fitted to posed vertices contain the exact ones. With
   gradual underflow. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Ieee Shows Outward Finder.
Open Scope R_scope.

(* src/rounding/pose.rs: REFIT_MARGIN, REFIT_FLOOR, refit. One end; the other is mirrored. *)
Definition refit_margin : R := 128 * v.
Definition refit_floor : R := / IZR (2 ^ 120).
Definition refit_end (extreme size : R) : R :=
  next_above (add64 gradual64 extreme
    (add64 gradual64 (mul64 gradual64 refit_margin size) refit_floor)).

(* src/update/intervals.rs: fit. A direction's coefficients are -1, 0 or 1. *)
Definition unit_coefficient (c : R) : Prop := c = -1 \/ c = 0 \/ c = 1.
Definition along (c p : point) : R :=
  add64 gradual64 (add64 gradual64 (mul64 gradual64 (px c) (px p)) (mul64 gradual64 (py c) (py p)))
    (mul64 gradual64 (pz c) (pz p)).

Lemma coefficient_exact (c x : R) :
  unit_coefficient c -> mul64 gradual64 c (fl64 gradual64 x) = c * fl64 gradual64 x.
Proof.
  intro H. unfold mul64. rewrite !read64_is, !gradual_fl64.
  assert (F : generic_format radix2 (FLT_exp (-1074) 53) (nearest64 x)).
  { apply generic_format_round; typeclasses eauto. }
  unfold nearest64 at 1. apply round_generic; [typeclasses eauto |].
  destruct H as [-> | [-> | ->]].
  - replace (-1 * nearest64 x) with (- nearest64 x) by ring. now apply generic_format_opp.
  - rewrite Rmult_0_l. apply generic_format_0.
  - now rewrite Rmult_1_l.
Qed.

Theorem refit_contains (q : quaternion) (t x c : point) (extreme size : R) :
  sound_quaternion q -> 0 <= size <= IZR (2 ^ 100) -> within size t -> within size x ->
  unit_coefficient (px c) -> unit_coefficient (py c) -> unit_coefficient (pz c) ->
  along c (transform gradual64 (rotation_of gradual64 q) x t) <= extreme ->
  dot c (posed q t x) <= refit_end extreme size.
Proof.
  intros Hq (S0 & S1) (Tx & Ty & Tz) (Xx & Xy & Xz) Cx Cy Cz He.
  pose proof v_value as V. pose proof dust_value as D0. pose proof gradually_valid64 as G.
  assert (Big : size <= big / 2).
  { apply Rle_trans with (1 := S1). unfold big. change (2 ^ 300)%Z with (2 * 2 ^ 299)%Z.
    rewrite mult_IZR. unfold Rdiv. rewrite Rmult_comm, <- Rmult_assoc, Rinv_l, Rmult_1_l by lra.
    now apply IZR_le. }
  destruct (rotation_error gradual64 G q Hq) as (R0 & R1 & R2).
  assert (Hn : 0 < norm_of q) by now apply sound_positive.
  destruct (unit_rows q Hn) as (U0 & U1 & U2).
  pose proof (coordinate_error gradual64 G _ _ x R0 U0 size (conj S0 Big) Xx Xy Xz (px t) Tx) as Ex.
  pose proof (coordinate_error gradual64 G _ _ x R1 U1 size (conj S0 Big) Xx Xy Xz (py t) Ty) as Ey.
  pose proof (coordinate_error gradual64 G _ _ x R2 U2 size (conj S0 Big) Xx Xy Xz (pz t) Tz) as Ez.
  pose proof (dot_bound _ x size U0 (conj Xx (conj Xy Xz))) as Bx.
  pose proof (dot_bound _ x size U1 (conj Xx (conj Xy Xz))) as By.
  pose proof (dot_bound _ x size U2 (conj Xx (conj Xy Xz))) as Bz.
  unfold along, transform, pt in He. cbn [px py pz] in He.
  set (X := add64 gradual64 (rotate_row gradual64 _ x) (px t)) in *.
  set (Y := add64 gradual64 (rotate_row gradual64 _ x) (py t)) in *.
  set (Z := add64 gradual64 (rotate_row gradual64 _ x) (pz t)) in *.
  assert (MX : mul64 gradual64 (px c) X = px c * X) by (now apply coefficient_exact).
  assert (MY : mul64 gradual64 (py c) Y = py c * Y) by (now apply coefficient_exact).
  assert (MZ : mul64 gradual64 (pz c) Z = pz c * Z) by (now apply coefficient_exact).
  rewrite MX, MY, MZ in He. clear MX MY MZ.
  assert (Times : forall k w e, unit_coefficient k -> Rabs w <= e -> Rabs (k * w) <= e).
  { intros k w e K W. rewrite Rabs_mult. pose proof (Rabs_pos w).
    destruct K as [-> | [-> | ->]].
    - rewrite (Rabs_left (-1)) by lra. lra.
    - rewrite Rabs_R0. lra.
    - rewrite Rabs_R1. lra. }
  unfold dot, posed, apply, plus, pt. cbn [px py pz].
  set (x0 := dot (row0 _) x + px t) in *. set (y0 := dot (row1 _) x + py t) in *.
  set (z0 := dot (row2 _) x + pz t) in *.
  set (e := 35.3 * v * size + 20 * dust) in *.
  assert (Sizes : forall w d s, Rabs d <= 1.73206 * size -> Rabs s <= size -> w = d + s ->
    Rabs w <= 2.73206 * size).
  { intros w d s A B ->. apply Rle_trans with (1 := Rabs_triang _ _). lra. }
  pose proof (Sizes x0 _ _ Bx Tx eq_refl) as Lx. pose proof (Sizes y0 _ _ By Ty eq_refl) as Ly.
  pose proof (Sizes z0 _ _ Bz Tz eq_refl) as Lz. clear Sizes.
  assert (Part : forall k W w, unit_coefficient k -> Rabs (W - w) <= e ->
    Rabs (k * W - k * w) <= e).
  { intros k W w K A. replace (k * W - k * w) with (k * (W - w)) by ring. now apply Times. }
  pose proof (Part _ _ _ Cx Ex) as Px. pose proof (Part _ _ _ Cy Ey) as Py.
  pose proof (Part _ _ _ Cz Ez) as Pz.
  pose proof (Times _ _ _ Cx Lx) as Kx. pose proof (Times _ _ _ Cy Ly) as Ky.
  pose proof (Times _ _ _ Cz Lz) as Kz. clear Times Part.
  pose proof (add64_near gradual64 G _ _ _ _ _ _ Px Py) as E1.
  pose proof (add64_near gradual64 G _ _ _ _ _ _ E1 Pz) as E2.
  set (sum := add64 gradual64 (add64 gradual64 (px c * X) (py c * Y)) (pz c * Z)) in *.
  set (cx := px c * x0) in *. set (cy := py c * y0) in *. set (cz := pz c * z0) in *.
  assert (A1 : Rabs (cx + cy) <= 5.46412 * size).
  { apply Rle_trans with (1 := Rabs_triang _ _). lra. }
  assert (A2 : Rabs (cx + cy + cz) <= 8.19618 * size).
  { apply Rle_trans with (1 := Rabs_triang _ _). lra. }
  apply (Rmult_le_compat_l v) in A1, A2; [| lra | lra].
  apply Rabs_le_inv in E2.
  (* The margin. *)
  pose proof (up_outward (extreme + add64 gradual64 (mul64 gradual64 refit_margin size) refit_floor))
    as U.
  unfold refit_end. apply Rle_trans with (2 := U). clear U.
  assert (P0 : 0 <= refit_margin * size) by (apply Rmult_le_pos; unfold refit_margin; lra).
  pose proof (fl64_error gradual64 G (refit_margin * size)) as M1. rewrite (Rabs_pos_eq _ P0) in M1.
  apply Rabs_le_inv in M1. pose proof (fl64_nonneg gradual64 _ P0) as Q1.
  assert (F : 1000 * dust <= refit_floor).
  { unfold dust, refit_floor. change (2 ^ 700)%Z with (2 ^ 580 * 2 ^ 120)%Z.
    rewrite mult_IZR, Rinv_mult, <- Rmult_assoc.
    assert (1000 * / IZR (2 ^ 580) <= 1) by lra.
    assert (0 < / IZR (2 ^ 120)) by (apply Rinv_0_lt_compat; now apply IZR_lt).
    rewrite <- (Rmult_1_l (/ IZR (2 ^ 120))) at 2. apply Rmult_le_compat_r; lra. }
  unfold add64, mul64. rewrite !read64_is.
  set (m := fl64 gradual64 (refit_margin * size)) in *.
  assert (P1 : 0 <= m + refit_floor) by lra.
  pose proof (fl64_error gradual64 G (m + refit_floor)) as M2. rewrite (Rabs_pos_eq _ P1) in M2.
  apply Rabs_le_inv in M2. set (margin := fl64 gradual64 (m + refit_floor)) in *.
  pose proof tiny64_dust as TD. pose proof (proj1 tiny64_value) as T0.
  unfold e, refit_margin in *.
  assert (VS : 0 <= v * size) by (apply Rmult_le_pos; lra).
  replace (v * (5.46412 * size)) with (5.46412 * (v * size)) in A1 by ring.
  replace (v * (8.19618 * size)) with (8.19618 * (v * size)) in A2 by ring.
  replace (35.3 * v * size) with (35.3 * (v * size)) in * by ring.
  replace (128 * v * size) with (128 * (v * size)) in * by ring.
  set (vs := v * size) in *. set (f := refit_floor) in *.
  clearbody vs f m margin sum cx cy cz. clear Ex Ey Ez Px Py Pz Bx By Bz E1 Lx Ly Lz.
  unfold v in *. lra.
Qed.
