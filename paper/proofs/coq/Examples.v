(* Bodies to which theorem S applies: they meet all hypotheses, occupy points, and one pair of them is
   rejected and another isn't. So the theorem doesn't hold for want of inputs. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Run.
From Sdop Require Import Format Double Geometry Pose Place ReadPose WorldBall Sphere Rejected Ieee.
From Sdop Require Import Controls Shows Same.
Import ListNotations.
Open Scope R_scope.

(* Bounds of a number that is computed. *)
Lemma within_computed (n : Z) (x : f32) :
  (-100 <= n <= 100)%Z -> is_finite x && negb (greater32 (Babs x) (number 1 n)) = true ->
  is_finite x = true /\ Rabs (B2R x) <= bpow radix2 n.
Proof.
  intros N H. apply andb_prop in H. destruct H as (F & G). split; [exact F |].
  assert (V : B2R (number 1 n) = bpow radix2 n) by (rewrite number_value by lia; ring).
  assert (Fn : is_finite (number 1 n) = true).
  { unfold number. pose proof (binary_normalize_correct 24 128 _ _ mode_NE 1 n false) as C.
    cbv zeta in C. rewrite Rlt_bool_true in C; [apply C |].
    apply Rle_lt_trans with (bpow radix2 n); [| apply bpow_lt; lia].
    apply abs_round_le_generic; [typeclasses eauto | typeclasses eauto | |].
    - apply generic_format_FLT_bpow; [typeclasses eauto | unfold SpecFloat.emin; lia].
    - unfold F2R. cbn [Fnum Fexp]. rewrite Rmult_1_l, Rabs_pos_eq by apply bpow_ge_0. apply Rle_refl. }
  unfold greater32 in G. rewrite Bcompare_correct in G by (rewrite ?is_finite_Babs; assumption).
  rewrite V, B2R_Babs in G. destruct (Rcompare_spec (Rabs (B2R x)) (bpow radix2 n)); [lra | lra | discriminate].
Qed.

Lemma nonneg_computed {prec emax} (x : binary_float prec emax) : Bsign x = false -> 0 <= B2R x.
Proof.
  destruct x as [s | s | | s m e H]; cbn; try lra. intros ->. apply F2R_ge_0. cbn. lia.
Qed.

Lemma nonzero_computed {prec emax} (x : binary_float prec emax) :
  is_finite_strict x = true -> B2R x <> 0.
Proof.
  destruct x as [s | s | | s m e H]; cbn; try discriminate. intros _.
  destruct s; [apply Rlt_not_eq, F2R_lt_0 | apply Rgt_not_eq, F2R_gt_0]; cbn; lia.
Qed.

Ltac run := vm_compute; reflexivity.

Definition zero : f32 := Run.zero32.
Definition at_x (n e : Z) : Run.three f32 := Run.Three (number n e) zero zero.

(* Theorem S: balls of radius 1 about a point at 1/2 in the frame of a turned body. *)
Definition turned_ball (x : Z) : given :=
  {| g_turn := (number 1 0, number 2 0, number 3 0, number 4 0); g_place := at_x x 0;
     g_centre := at_x 1 (-1); g_radius := number 1 0 |}.

Lemma turned_ball_is (x : Z) :
  (Z.abs x < 100)%Z ->
  body_of (turned_ball x)
  = {| shape := {| centre := pt (/ 2) 0 0; radius := 1 |};
       turn := {| qx := 1; qy := 2; qz := 3; qw := 4 |}; place := pt (IZR x) 0 0 |}.
Proof.
  intro X. unfold body_of, turned_ball, at_x, real_point, quaternion_of, pt.
  cbn [g_turn g_place g_centre g_radius Run.first Run.second Run.third].
  rewrite !number_value by lia. cbn [B2R Run.zero32 zero]. change (bpow radix2 0) with 1.
  change (bpow radix2 (-1)) with (/ 2). now rewrite !Rmult_1_r, !Rmult_1_l.
Qed.

Lemma turned_ball_sound (x : Z) : (Z.abs x < 100)%Z -> sound gradually (body_of (turned_ball x)).
Proof.
  intro X. rewrite turned_ball_is by exact X.
  assert (Rx : Rabs (IZR x) <= 100) by (rewrite <- abs_IZR; apply IZR_le; lia).
  assert (L : 100 <= limit) by (unfold limit; now apply IZR_le).
  unfold sound, sound_quaternion, readable, within, norm_of, pt.
  cbn [turn place shape centre radius qx qy qz qw px py pz pose32 gradually].
  repeat split; try discriminate; try (apply Rabs_le_inv in Rx; apply Rabs_le);
    try (unfold least_norm, greatest_norm; lra); lra.
Qed.

Lemma turned_ball_centre (x : Z) :
  (Z.abs x < 100)%Z -> in_ball (pt (/ 2) 0 0) (shape (body_of (turned_ball x))).
Proof.
  intro X. rewrite turned_ball_is by exact X. unfold in_ball, distance. cbn [shape centre radius].
  apply norm_below; [lra |]. unfold square, minus, pt. cbn [px py pz]. lra.
Qed.

Lemma holds_computed (x : f32) :
  is_finite x && negb (greater32 (Babs x) (number 1 62)) = true -> holds x (B2R x) reach.
Proof. intro H. destruct (within_computed 62 x ltac:(lia) H) as (F & B). now repeat split. Qed.

Ltac finite_ball :=
  split; [repeat split; run |]; split; [repeat split; run |]; split; [run |]; split; [run |];
  split; [apply nonzero_computed; run |];
  split; [| split; [| split; [| split]]]; try (apply nonneg_computed; run);
  apply holds_computed; run.

Definition ball_here : given := turned_ball 0.
Definition ball_touching : given := turned_ball 1.
Definition ball_away : given := turned_ball 4.

Lemma balls_finite :
  finite_given ball_here /\ finite_given ball_touching /\ finite_given ball_away.
Proof. split; [| split]; finite_ball. Qed.

Example spheres_are_rejected :
  let (a, b) := (body_of ball_here, body_of ball_away) in
  sound gradually a /\ sound gradually b /\
  rejects32 factor32 floor32 (stored ball_here) (stored ball_away) = true /\
  rejects gradual (sphere gradually a) (sphere gradually b) = true /\
  (exists p, occupies a p) /\ (exists p, occupies b p).
Proof.
  destruct balls_finite as (Fa & _ & Fb).
  assert (Sa : sound gradually (body_of ball_here)) by (apply turned_ball_sound; lia).
  assert (Sb : sound gradually (body_of ball_away)) by (apply turned_ball_sound; lia).
  assert (H : rejects32 factor32 floor32 (stored ball_here) (stored ball_away) = true) by run.
  split; [exact Sa |]. split; [exact Sb |]. split; [exact H |]. split.
  - rewrite rejects32_is_rejects in H by (apply Fa || apply Fb).
    now rewrite (stored_is _ Sa Fa), (stored_is _ Sb Fb) in H.
  - split; eexists; exists (pt (/ 2) 0 0);
      (split; [apply turned_ball_centre; lia | reflexivity]).
Qed.

Example spheres_are_reported :
  let (a, b) := (body_of ball_here, body_of ball_touching) in
  sound gradually a /\ sound gradually b /\
  rejects32 factor32 floor32 (stored ball_here) (stored ball_touching) = false /\
  exists p, occupies a p /\ occupies b p.
Proof.
  split; [apply turned_ball_sound; lia |]. split; [apply turned_ball_sound; lia |].
  split; [run |]. eexists. split.
  - exists (pt (/ 2) 0 0). split; [apply turned_ball_centre; lia | reflexivity].
  - exists (pt (/ 2 - 4 / 30) (20 / 30) (- (22 / 30))). unfold ball_here, ball_touching.
    rewrite !turned_ball_is by lia. cbn [turn place shape centre radius]. split.
    + unfold in_ball, distance. cbn [centre radius].
      apply norm_below; [lra |]. unfold square, minus, pt. cbn [px py pz]. lra.
    + unfold posed, plus, apply, exact_rotation, norm_of, dot, pt.
      cbn [qx qy qz qw px py pz row0 row1 row2]. f_equal; field.
Qed.
