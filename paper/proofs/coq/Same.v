(* The functions that run are those of the theorems: from finite numbers, where their results are
   finite, they give what the functions of real numbers give with gradual underflow. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Import Run.
From Sdop Require Import Format Geometry Double Pose Place ReadPose WorldBall Sphere Rejected Ieee.
From Sdop Require Import Cells Grid Shows.
Open Scope R_scope.

(* Poses. *)
Definition shows_point {prec emax} (v : Run.three (binary_float prec emax)) (p : point) : Prop :=
  shows (Run.first v) (px p) /\ shows (Run.second v) (py p) /\ shows (Run.third v) (pz p).
Definition shows_matrix (r : Run.three (Run.three Run.f64)) (a : matrix) : Prop :=
  shows_point (Run.first r) (row0 a) /\ shows_point (Run.second r) (row1 a) /\
  shows_point (Run.third r) (row2 a).

Lemma rotation64_is (x y z w : Run.f64) (q : quaternion) :
  shows x (qx q) -> shows y (qy q) -> shows z (qz q) -> shows w (qw q) ->
  is_finite (Run.norm64 x y z w) = true -> B2R (Run.norm64 x y z w) <> 0 ->
  shows_matrix (Run.rotation64 x y z w) (rotation_of gradual64 q).
Proof.
  intros Hx Hy Hz Hw F N. unfold Run.norm64 in *.
  assert (D : shows (Run.norm64 x y z w) (add64 gradual64 (add64 gradual64 (add64 gradual64
    (mul64 gradual64 (qx q) (qx q)) (mul64 gradual64 (qy q) (qy q)))
    (mul64 gradual64 (qz q) (qz q))) (mul64 gradual64 (qw q) (qw q)))) by (unfold Run.norm64; show).
  assert (Over : shows (Run.divide64 (Run.number64 1 0) (Run.norm64 x y z w))
    (div64 gradual64 1 (add64 gradual64 (add64 gradual64 (add64 gradual64
      (mul64 gradual64 (qx q) (qx q)) (mul64 gradual64 (qy q) (qy q)))
      (mul64 gradual64 (qz q) (qz q))) (mul64 gradual64 (qw q) (qw q))))).
  { apply shows_divide64; [apply shows_one64 | exact D | exact F |]. now rewrite <- (D F). }
  unfold Run.norm64 in Over. unfold Run.rotation64, rotation_of, shows_matrix, shows_point.
  unfold Run.twice64, Run.diagonal64, Run.norm64, Pose.twice, Pose.diagonal.
  cbn [Run.first Run.second Run.third row0 row1 row2 px py pz pt].
  repeat split; show.
Qed.

Lemma transform64_is (r : Run.three (Run.three Run.f64)) (a : matrix)
    (x t : Run.three Run.f64) (p s : point) :
  shows_matrix r a -> shows_point x p -> shows_point t s ->
  shows_point (Run.transform64 r x t) (transform gradual64 a p s).
Proof.
  intros ((A1 & A2 & A3) & (B1 & B2 & B3) & (C1 & C2 & C3)) (P1 & P2 & P3) (T1 & T2 & T3).
  unfold Run.transform64, Run.dot64, transform, rotate_row, shows_point.
  cbn [Run.first Run.second Run.third px py pz pt]. repeat split; show.
Qed.

(* The world ball, from finite numbers. *)
Definition finite_three {prec emax} (v : Run.three (binary_float prec emax)) : Prop :=
  is_finite (Run.first v) = true /\ is_finite (Run.second v) = true /\
  is_finite (Run.third v) = true.
Definition real_point {prec emax} (v : Run.three (binary_float prec emax)) : point :=
  pt (B2R (Run.first v)) (B2R (Run.second v)) (B2R (Run.third v)).

Lemma largest64_is (numbers : list Run.f64) (least : Run.f64) :
  is_finite least = true -> (forall x, In x numbers -> is_finite x = true) ->
  is_finite (Run.largest64 least numbers) = true /\
  B2R (Run.largest64 least numbers) =
    fold_left (fun most x => Rmax most (Rabs x)) (map B2R numbers) (B2R least).
Proof.
  revert least. induction numbers as [| x rest IH]; intros least F All; [now split |].
  cbn [Run.largest64 fold_left map]. unfold Run.largest64 in *. cbn [fold_left].
  assert (Fx : is_finite (Babs x) = true) by (rewrite is_finite_Babs; apply All; now left).
  destruct (greater_of_is least (Babs x) (B2R least) (B2R (Babs x)) F Fx ltac:(now intro)
    ltac:(now intro)) as [G E].
  destruct (IH _ G ltac:(intros; apply All; now right)) as [I J]. split; [exact I |].
  now rewrite J, E, B2R_Babs.
Qed.

Definition quaternion_of (q : f32 * f32 * f32 * f32) : quaternion :=
  let '(x, y, z, w) := q in {| qx := B2R x; qy := B2R y; qz := B2R z; qw := B2R w |}.
Definition norm_of_f32 (q : f32 * f32 * f32 * f32) : Run.f64 :=
  let '(x, y, z, w) := q in
  Run.norm64 (Run.to_f64 x) (Run.to_f64 y) (Run.to_f64 z) (Run.to_f64 w).

Lemma shows_itself {prec emax} (x : binary_float prec emax) : shows x (B2R x).
Proof. now intro. Qed.

Lemma shows_stretch : shows Run.stretch64 stretch.
Proof.
  unfold Run.stretch64, stretch.
  assert (T : shows (Run.number64 10001 0) 10001).
  { intros _. change (F2R (Float radix2 (10001 * 2 ^ 39) (-39)) = 10001). unfold F2R. cbn. lra. }
  assert (B : shows (Run.number64 10000 0) 10000).
  { intros _. change (F2R (Float radix2 (10000 * 2 ^ 39) (-39)) = 10000). unfold F2R. cbn. lra. }
  pose proof (shows_divide _ _ _ _ T B eq_refl ltac:(lra)) as D.
  replace 1.0001 with (10001 / 10000) by lra. exact D.
Qed.

Theorem world_ball64_is (q : f32 * f32 * f32 * f32) (t c : Run.three f32) (r : f32) :
  finite_three t -> finite_three c -> is_finite r = true -> 0 <= B2R r ->
  is_finite (norm_of_f32 q) = true -> B2R (norm_of_f32 q) <> 0 ->
  let (centre, radius) := Run.world_ball64 q t c r in
  let w := world_ball gradual gradual64 (quaternion_of q) (real_point t) (real_point c) (B2R r) in
  0 <= B2R radius ->
  shows_point centre (Geometry.centre w) /\ shows radius (Geometry.radius w).
Proof.
  intros (T1 & T2 & T3) (C1 & C2 & C3) Fr Pr Fn Nn.
  unfold Run.world_ball64, world_ball.
  assert (O : is_origin gradual (real_point c)
    = Run.is_zero (Run.first c) && Run.is_zero (Run.second c) && Run.is_zero (Run.third c)).
  { unfold is_origin, real_point, pt. cbn [px py pz].
    symmetry. apply f_equal2; [apply f_equal2 |]; (apply is_zero_is; [| now intro]); [exact C1 | exact C2 | exact C3]. }
  rewrite O. destruct (Run.is_zero (Run.first c) && Run.is_zero (Run.second c)
    && Run.is_zero (Run.third c)).
  { intros _. cbn [centre radius]. split; [unfold shows_point, real_point, pt; cbn |];
      repeat split; now intro. }
  destruct q as [[[x y] z] w]. cbn [norm_of_f32] in *.
  assert (Rot : shows_matrix (Run.rotation64 (Run.to_f64 x) (Run.to_f64 y) (Run.to_f64 z)
    (Run.to_f64 w)) (rotation_of gradual64 (read_quaternion gradual (quaternion_of (x, y, z, w))))).
  { apply rotation64_is; try assumption; apply shows_to_f64, shows_itself. }
  assert (Ex : shows_point (Run.transform64 (Run.rotation64 (Run.to_f64 x) (Run.to_f64 y)
      (Run.to_f64 z) (Run.to_f64 w)) (Run.each Run.to_f64 c) (Run.each Run.to_f64 t))
    (transform gradual64 (rotation_of gradual64 (read_quaternion gradual (quaternion_of (x, y, z, w))))
      (read_point gradual (real_point c)) (read_point gradual (real_point t)))).
  { apply transform64_is; [exact Rot | |]; repeat split; apply shows_to_f64, shows_itself. }
  set (exact := Run.transform64 _ _ _) in *. set (place := transform _ _ _ _) in *.
  clearbody exact place. destruct Ex as (E1 & E2 & E3). intro P. split.
  { unfold shows_point, cast_point, pt.
    cbn [Run.each Run.first Run.second Run.third Geometry.centre px py pz].
    repeat split; apply shows_to_f32; assumption. }
  cbn [radius]. revert P. apply shows_up.
  assert (Zero : shows Run.zero64 0) by now intro.
  assert (M : shows (Run.moved64 exact (Run.each Run.to_f64 (Run.each Run.to_f32 exact)))
    (moved gradual64 place (read_point gradual (cast_point gradual place)))).
  { unfold Run.moved64, moved, read_point, cast_point, pt. apply shows_root64.
    cbn [Run.each Run.first Run.second Run.third px py pz]. show. }
  assert (S : is_finite (Run.largest64 Run.zero64
      (Run.listed (Run.each Run.to_f64 c) ++ Run.listed (Run.each Run.to_f64 t))) = true /\
    B2R (Run.largest64 Run.zero64
      (Run.listed (Run.each Run.to_f64 c) ++ Run.listed (Run.each Run.to_f64 t)))
    = largest (read_point gradual (real_point c)) (read_point gradual (real_point t))).
  { assert (G1 : is_finite (Run.to_f64 (Run.first c)) = true) by exact (proj1 (to_f64_is _ C1)).
    assert (H1 : B2R (Run.to_f64 (Run.first c)) = B2R (Run.first c))
      by exact (proj2 (to_f64_is _ C1)).
    assert (G2 : is_finite (Run.to_f64 (Run.second c)) = true) by exact (proj1 (to_f64_is _ C2)).
    assert (H2 : B2R (Run.to_f64 (Run.second c)) = B2R (Run.second c))
      by exact (proj2 (to_f64_is _ C2)).
    assert (G3 : is_finite (Run.to_f64 (Run.third c)) = true) by exact (proj1 (to_f64_is _ C3)).
    assert (H3 : B2R (Run.to_f64 (Run.third c)) = B2R (Run.third c))
      by exact (proj2 (to_f64_is _ C3)).
    assert (G4 : is_finite (Run.to_f64 (Run.first t)) = true) by exact (proj1 (to_f64_is _ T1)).
    assert (H4 : B2R (Run.to_f64 (Run.first t)) = B2R (Run.first t))
      by exact (proj2 (to_f64_is _ T1)).
    assert (G5 : is_finite (Run.to_f64 (Run.second t)) = true) by exact (proj1 (to_f64_is _ T2)).
    assert (H5 : B2R (Run.to_f64 (Run.second t)) = B2R (Run.second t))
      by exact (proj2 (to_f64_is _ T2)).
    assert (G6 : is_finite (Run.to_f64 (Run.third t)) = true) by exact (proj1 (to_f64_is _ T3)).
    assert (H6 : B2R (Run.to_f64 (Run.third t)) = B2R (Run.third t))
      by exact (proj2 (to_f64_is _ T3)).
    destruct (largest64_is (Run.listed (Run.each Run.to_f64 c) ++ Run.listed (Run.each Run.to_f64 t))
      Run.zero64 eq_refl) as [F E].
    - cbn [Run.listed Run.each Run.first Run.second Run.third app In].
      intros v [<- | [<- | [<- | [<- | [<- | [<- | []]]]]]];
        [exact G1 | exact G2 | exact G3 | exact G4 | exact G5 | exact G6].
    - split; [exact F |]. rewrite E. cbn [Run.listed Run.each Run.first Run.second Run.third app map].
      rewrite H1, H2, H3, H4, H5, H6. reflexivity. }
  destruct S as [_ S].
  assert (Size : shows (Run.largest64 Run.zero64
      (Run.listed (Run.each Run.to_f64 c) ++ Run.listed (Run.each Run.to_f64 t)))
      (largest (read_point gradual (real_point c)) (read_point gradual (real_point t))))
    by (intros _; exact S).
  assert (K : shows (Run.number64 1 (-47)) centre_error).
  { intros _. change (F2R (Float radix2 4503599627370496 (-99)) = centre_error).
    unfold F2R, centre_error, v. cbn. lra. }
  assert (L : shows (Run.number64 1 (-125)) centre_floor).
  { intros _. change (F2R (Float radix2 4503599627370496 (-177)) = centre_floor).
    unfold F2R, centre_floor, tiny. cbn. lra. }
  pose proof shows_stretch. show. apply shows_itself.
Qed.

(* A body as its numbers are given, and the ball that is stored for it before it is inflated. *)
Record given := { g_turn : f32 * f32 * f32 * f32; g_place : Run.three f32;
                  g_centre : Run.three f32; g_radius : f32 }.
Definition body_of (g : given) : body :=
  {| shape := {| centre := real_point (g_centre g); radius := B2R (g_radius g) |};
     turn := quaternion_of (g_turn g); place := real_point (g_place g) |}.
Definition stored (g : given) : ball32 :=
  let (c, r) := Run.world_ball64 (g_turn g) (g_place g) (g_centre g) (g_radius g) in
  {| x32 := Run.first c; y32 := Run.second c; z32 := Run.third c; r32 := r |}.

(* Finite numbers, |q|^2 of which is neither infinite nor zero in f64, and a stored ball within
   2^62. *)
Definition finite_given (g : given) : Prop :=
  finite_three (g_place g) /\ finite_three (g_centre g) /\ is_finite (g_radius g) = true /\
  is_finite (norm_of_f32 (g_turn g)) = true /\ B2R (norm_of_f32 (g_turn g)) <> 0 /\
  sound32 (stored g).

Definition gradually : modes :=
  {| pose32 := gradual; pose64 := gradual64; inflation := gradual |}.

Lemma gradually_valid : valid_modes gradually.
Proof.
  pose proof gradual_valid. repeat split; try apply H; cbn; try lra.
  apply Rlt_le, tiny64_value.
Qed.

Lemma stored_is (g : given) :
  sound gradually (body_of g) -> finite_given g ->
  inflated gradual (ball_of (stored g)) = sphere gradually (body_of g).
Proof.
  intros (_ & _ & _ & _ & P) (Ft & Fc & Fr & Fn & Nn & S).
  pose proof (world_ball64_is (g_turn g) (g_place g) (g_centre g) (g_radius g) Ft Fc Fr P Fn Nn)
    as W.
  unfold sphere, stored in *. destruct (Run.world_ball64 _ _ _ _) as [c r]. cbn zeta in W.
  destruct S as ((X & _) & (Y & _) & (Z & _) & (R & _) & Pr). cbn [x32 y32 z32 r32] in *.
  destruct (W Pr) as ((W1 & W2 & W3) & W4).
  specialize (W1 X). specialize (W2 Y). specialize (W3 Z). specialize (W4 R).
  cbn [pose32 pose64 inflation gradually turn place shape body_of centre radius].
  set (w := world_ball _ _ _ _ _ _) in *. clearbody w. destruct w as [[wx wy wz] wr].
  cbn in W1, W2, W3, W4. unfold inflated, ball_of. cbn [centre radius x32 y32 z32 r32].
  f_equal; [f_equal; [exact W1 | exact W2 | exact W3] | f_equal; exact W4].
Qed.

(* Theorem S of the functions that run: what they reject has no common point. *)
Theorem run_rejects_disjoint (a b : given) :
  sound gradually (body_of a) -> sound gradually (body_of b) -> finite_given a -> finite_given b ->
  rejects32 factor32 floor32 (stored a) (stored b) = true ->
  forall p, ~ (occupies (body_of a) p /\ occupies (body_of b) p).
Proof.
  intros Sa Sb Fa Fb H.
  rewrite rejects32_is_rejects in H by (apply Fa || apply Fb).
  rewrite (stored_is a Sa Fa), (stored_is b Sb Fb) in H.
  pose proof gradually_valid as V. pose proof gradual_valid as G.
  exact (sphere_rejects_disjoint gradual gradually gradually _ _ G V V Sa Sb H).
Qed.

(* Finders and cells. *)
Lemma widen32_is (r : f32) (a : R) :
  shows r a -> 0 <= B2R (Run.widen32 r) ->
  shows (Run.widen32 r) (Grid.widen gradual gradual64 a).
Proof.
  intros H P. revert P. unfold Run.widen32, Grid.widen. apply shows_up.
  assert (K : shows Run.finder_factor64 finder_factor).
  { intros _. change (F2R (Float radix2 (1048577 * 2 ^ 32) (-52)) = finder_factor).
    unfold F2R, finder_factor, u. cbn. lra. }
  assert (L : shows Run.finder_floor64 finder_floor).
  { intros _. change (F2R (Float radix2 4503599627370496 (-130)) = finder_floor).
    unfold F2R, finder_floor. cbn. lra. }
  show.
Qed.

Lemma cell64_is (origin inverse x : Run.f64) (o i a : R) :
  shows origin o -> shows inverse i -> shows x a ->
  shows (Run.cell64 origin inverse x) (cell gradual64 o i a).
Proof.
  intros Ho Hi Hx. unfold Run.cell64, cell.
  assert (T : shows Run.to_integer64 to_integer).
  { intros _. change (F2R (Float radix2 (3 * 2 ^ 51) 0) = to_integer).
    unfold F2R, to_integer. cbn. lra. }
  show.
Qed.

(* The low 32 bits of a cell, which is from 2^52 to 2^53, are its number. *)
Lemma number_of_is (c : Run.f64) :
  is_finite c = true -> 4503599627370496 <= B2R c < 9007199254740992 ->
  Run.number_of c = (number (B2R c) mod 2 ^ 32)%Z.
Proof.
  intros F B. destruct c as [s | s | | s m e H]; try discriminate F; cbn [B2R] in B.
  { exfalso. cbn in B. lra. }
  assert (C : canonical radix2 (SpecFloat.fexp 53 1024) (Float radix2 (cond_Zopp s (Z.pos m)) e))
    by (apply canonical_bounded; exact H).
  assert (E : e = 0%Z).
  { unfold canonical in C. cbn [Fexp] in C. rewrite C. unfold cexp.
    set (r := F2R _) in *. assert (M : mag radix2 r = 53%Z :> Z).
    { apply mag_unique. rewrite Rabs_pos_eq by lra. split.
      - change (bpow radix2 (53 - 1)) with 4503599627370496. lra.
      - change (bpow radix2 53) with 9007199254740992. lra. }
    rewrite M. reflexivity. }
  subst e. assert (S : s = false).
  { destruct s; [exfalso | reflexivity]. unfold F2R in B. cbn in B.
    pose proof (IZR_lt (Z.neg m) 0 ltac:(lia)). lra. }
  subst s. unfold number, Run.number_of. cbn [B2R cond_Zopp]. unfold F2R. cbn [Fnum Fexp bpow].
  rewrite Rmult_1_r, Zfloor_IZR.
  rewrite <- (Z_mod_plus_full (Z.pos m - 3 * 2 ^ 51) (3 * 2 ^ 19) (2 ^ 32)).
  f_equal. reflexivity || lia.
Qed.
