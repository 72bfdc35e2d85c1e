(* Bodies to which theorems S, N and E apply: they meet all hypotheses, occupy points, and some pairs
   of them are rejected and others aren't. So the theorems don't hold for want of inputs. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Run RunOrDop.
From Sdop Require Import Format Double Geometry Pose Place ReadPose WorldBall Sphere Rejected Ieee.
From Sdop Require Import Controls Shows Same Outward Duality Vectors SupportParts OrDopTest OrDop.
From Sdop Require Import Norms64 OrDopPose OrDopBody Fits SameOrDop OrDopRun.
Import ListNotations.
Open Scope R_scope.

(* Bounds of a number that is computed. *)
Lemma within_computed (n : Z) (x : f32) :
  (-100 <= n <= 100)%Z -> is_finite x && negb (greater32 (Babs x) (number 1 n)) = true ->
  within_power n x.
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

Ltac values := rewrite ?number_value by lia; cbn [Run.zero32 B2R zero]; change (bpow radix2 0) with 1;
  change (bpow radix2 (-1)) with (/ 2).

Lemma turned_ball_sound (x : Z) : (Z.abs x < 100)%Z -> sound gradually (body_of (turned_ball x)).
Proof.
  intro X. assert (Rx : Rabs (IZR x) <= 100).
  { rewrite <- abs_IZR. apply IZR_le. lia. }
  assert (L : 100 <= limit) by (unfold limit; now apply IZR_le).
  unfold sound, body_of, turned_ball, at_x, sound_quaternion, readable, within, norm_of, real_point, pt.
  cbn [g_turn g_place g_centre g_radius Rejected.turn place shape centre radius quaternion_of qx qy qz qw
    px py pz Run.first Run.second Run.third pose32 gradually].
  values. repeat split; try discriminate; try (apply Rabs_le_inv in Rx; apply Rabs_le);
    try (unfold least_norm, greatest_norm; lra); lra.
Qed.

Lemma holds_computed (x : f32) : within_power 62 x -> holds x (B2R x) reach.
Proof. intros (F & B). now repeat split. Qed.

Ltac finite_ball :=
  split; [repeat split; run |]; split; [repeat split; run |]; split; [run |]; split; [run |];
  split; [apply nonzero_computed; run |];
  split; [| split; [| split; [| split]]]; try (apply nonneg_computed; run);
  apply holds_computed, within_computed; [lia | run | lia | run | lia | run | lia | run].

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
  - split; eexists; exists (pt (/ 2) 0 0); (split; [| reflexivity]);
      unfold in_ball, distance; (apply norm_below; [cbn; values; lra |]);
      unfold square, minus; cbn; values; lra.
Qed.

Example spheres_are_reported :
  let (a, b) := (body_of ball_here, body_of ball_touching) in
  sound gradually a /\ sound gradually b /\
  rejects32 factor32 floor32 (stored ball_here) (stored ball_touching) = false /\
  exists p, occupies a p /\ occupies b p.
Proof.
  split; [apply turned_ball_sound; lia |]. split; [apply turned_ball_sound; lia |].
  split; [run |]. eexists. split.
  - exists (pt (/ 2) 0 0). split; [| reflexivity].
    unfold in_ball, distance. apply norm_below; [cbn; values; lra |].
    unfold square, minus. cbn. values. lra.
  - exists (pt (/ 2 - 4 / 30) (20 / 30) (- (22 / 30))). split.
    + unfold in_ball, distance. apply norm_below; [cbn; values; lra |].
      unfold square, minus. cbn. values. lra.
    + unfold posed, plus, apply, exact_rotation, norm_of, dot, pt. cbn. values.
      f_equal; field.
Qed.

(* Theorems N and E: or-DOPs along an oblique basis of length 5/8, turned, with a centre off the
   origin. *)
Definition eighths (x y z : Z) : Run.three f32 :=
  Run.Three (number x (-3)) (number y (-3)) (number z (-3)).
Definition oblique : Run.three (Run.three f32) :=
  Run.Three (eighths 3 4 0) (eighths (-4) 3 0) (eighths 0 0 5).
Definition oblique_directions (member : nat) : Run.three f32 :=
  nth member
    [eighths 3 4 0; eighths (-4) 3 0; eighths 0 0 5; eighths (-1) 7 0; eighths 7 1 0;
     eighths 3 4 5; eighths 3 4 (-5); eighths (-4) 3 5; eighths (-4) 3 (-5); eighths (-1) 7 5;
     eighths (-7) (-1) 5; eighths 7 1 5; eighths 1 (-7) 5] (eighths 0 0 0).
Definition block (x e : Z) : given_ordop :=
  {| v_basis := oblique; v_lows := fun _ => number (-1) 0; v_highs := fun _ => number 1 0;
     v_middle := at_x 1 (-1); v_extent := number 4 0;
     v_pose := (number 1 0, number 2 0, number 3 0, number 4 0); v_position := at_x x e;
     v_directions := oblique_directions |}.

Ltac eighth_values := values; change (bpow radix2 (-3)) with (/ 8).

Lemma block_sound (x e : Z) : sound_ordop (ordop_of (5 / 8) (block x e)).
Proof.
  unfold sound_ordop, basis_of_length, sound_quaternion, norm_of, ordop_of, block, real_matrix,
    real_point, oblique, eighths, at_x, pt, square, dot.
  cbn [v_basis v_extent v_pose v_middle basis length extent middle pose quaternion_of qx qy qz qw
    row0 row1 row2 px py pz Run.first Run.second Run.third].
  eighth_values. repeat split; try lra.
  - unfold least_norm. lra.
  - unfold greatest_norm. lra.
  - apply Rle_trans with 4; [lra | now apply IZR_le].
  - apply Rle_trans with 1; [| now apply IZR_le].
    apply norm_below; [lra |]. unfold square. cbn [px py pz]. lra.
Qed.

Ltac fill_block :=
  split;
    [intros member M; cbn [ordop_of block lows highs v_lows v_highs]; apply members_all in M;
     cbn in M; repeat (destruct M as [<- | M]); [.. | destruct M]; cbn; eighth_values; lra
    |].

Lemma block_between (k : kind) (x e : Z) : between k (ordop_of (5 / 8) (block x e)) (pt 0 0 0).
Proof.
  fill_block. apply reached_near. cbn. values.
  apply norm_below; [lra |]. unfold square. cbn. lra.
Qed.

Definition all_within (n : Z) (v : Run.three f32) : bool :=
  let one x := is_finite x && negb (greater32 (Babs x) (number 1 n)) in
  one (Run.first v) && one (Run.second v) && one (Run.third v).

Lemma within_three_computed (n : Z) (v : Run.three f32) :
  (-100 <= n <= 100)%Z -> all_within n v = true -> within_three n v.
Proof.
  intros N H. unfold all_within in H. apply andb_prop in H. destruct H as (H & C).
  apply andb_prop in H. destruct H as (A & B). now repeat split; apply within_computed.
Qed.

(* A slab's ends, checked by running. *)
Definition ends_checked (b : given_ordop) (member : nat) : bool :=
  let (hi, lo) := ends_of_given b member in
  let one x := is_finite x && negb (greater32 (Babs x) (number 1 66)) && negb (Bsign x) in
  one hi && one lo && is_finite (about_middle b member (v_highs b member))
    && is_finite (about_middle b member (v_lows b member)).

Lemma ends_computed (b : given_ordop) (member : nat) :
  ends_checked b member = true ->
  let (hi, lo) := ends_of_given b member in
  within_power 66 hi /\ 0 <= B2R hi /\ within_power 66 lo /\ 0 <= B2R lo /\
  is_finite (about_middle b member (v_highs b member)) = true /\
  is_finite (about_middle b member (v_lows b member)) = true.
Proof.
  unfold ends_checked. destruct (ends_of_given b member) as [hi lo]. intro H.
  apply andb_prop in H. destruct H as (H & L). apply andb_prop in H. destruct H as (H & U).
  apply andb_prop in H. destruct H as (A & B). apply andb_prop in A, B.
  destruct A as (A & A'), B as (B & B'). apply negb_true_iff in A', B'.
  repeat split; try assumption; try (now apply nonneg_computed); now apply within_computed.
Qed.

Ltac finite_block directions :=
  unfold finite_ordop; split; [run |]; split; [apply nonzero_computed; run |]; split; [run |];
  split; [repeat split; run |]; split; [apply within_three_computed; [lia | run] |];
  split; [apply within_three_computed; [lia | run] |];
  split; [split; [| split]; (apply within_three_computed; [lia | run]) |];
  intros member M; (assert (C : ends_checked _ member = true) by
    (cbn in M; repeat (destruct M as [<- | M]); [.. | destruct M]; run));
  apply ends_computed in C; destruct (ends_of_given _ member) as [hi lo];
  repeat (split; [apply C |]); clear C hi lo;
  cbn in M; repeat (destruct M as [<- | M]); [.. | destruct M]; directions.

Ltac oblique_is := unfold real_point, combined, direction, directions, pt; cbn; eighth_values;
  f_equal; lra.

Definition block_here : given_ordop := block 0 0.
Definition block_touching : given_ordop := block 1 (-1).
Definition block_away : given_ordop := block 8 0.

Lemma fewer_ends (k : kind) (b : given_ordop) : finite_ordop K26 b -> finite_ordop k b.
Proof.
  unfold finite_ordop. intro H. repeat (split; [apply H |]).
  intros member M. apply H. now apply (members_all k).
Qed.

Lemma blocks_finite (k : kind) :
  finite_ordop k block_here /\ finite_ordop k block_touching /\ finite_ordop k block_away.
Proof. split; [| split]; apply fewer_ends; finite_block oblique_is. Qed.

Definition parted (k : kind) (full : bool) (a b : given_ordop) : bool :=
  RunOrDop.ordops_apart (number_of k) full (row_of_given a) (row_of_given b)
    (slabs_of_given k a) (slabs_of_given k b).

(* Slabs that are equal where the test reads them. *)
Lemma support_of_same (m : mode) (k : kind) (s t : slabs) (signs : bool * bool * bool) (e : point) :
  (forall member, In member (members K26) -> s member = t member) ->
  support_of m k s signs e = support_of m k t signs e.
Proof.
  intro H. destruct signs as [[i j] l]. unfold support_of, pair, facing, Duality.end_of.
  destruct i, j, l; cbn [xorb negb Nat.add];
    rewrite !(H 0%nat), !(H 1%nat), !(H 2%nat), ?(H 3%nat), ?(H 4%nat), ?(H 5%nat), ?(H 6%nat),
      ?(H 7%nat), ?(H 8%nat), ?(H 9%nat), ?(H 10%nat), ?(H 11%nat), ?(H 12%nat) by (cbn; tauto);
    reflexivity.
Qed.

Lemma rejected_same (m : mode) (k : kind) (x y : row) (sa sb ta tb : slabs) :
  (forall member, In member (members K26) -> sa member = ta member) ->
  (forall member, In member (members K26) -> sb member = tb member) ->
  ordops_rejected m k x y sa sb -> ordops_rejected m k x y ta tb.
Proof.
  intros Ha Hb.
  assert (Ma : forall member, In member (members K26) -> mirrored sa member = mirrored ta member)
    by (intros; unfold mirrored; now rewrite Ha).
  assert (Mb : forall member, In member (members K26) -> mirrored sb member = mirrored tb member)
    by (intros; unfold mirrored; now rewrite Hb).
  intros [(member & M & n & signs & S & T & G) | [(member & M & n & signs & S & T & G)
    | (ea & eb & n & va & vb & S & T & V & L & G)]].
  - left. exists member. split; [exact M |]. exists n, signs. repeat (split; [assumption |]).
    now rewrite <- (support_of_same _ _ _ _ _ _ Mb), <- (Ha _ (members_all k _ M)).
  - right. left. exists member. split; [exact M |]. exists n, signs. repeat (split; [assumption |]).
    now rewrite <- (support_of_same _ _ _ _ _ _ Ma), <- (Hb _ (members_all k _ M)).
  - right. right. exists ea, eb, n, va, vb. repeat (split; [assumption |]).
    now rewrite <- (support_of_same _ _ _ _ _ _ Ha), <- (support_of_same _ _ _ _ _ _ Hb).
Qed.

Lemma rejected_bodies (a b : given_ordop) (n n' : R) (full : bool) :
  sound_ordop (ordop_of n a) -> sound_ordop (ordop_of n' b) -> finite_ordop K26 a ->
  finite_ordop K26 b -> parted K26 full a b = true ->
  ordops_rejected gradual K26 (row_of_body (ordop_of n a)) (row_of_body (ordop_of n' b))
    (table_of_body (ordop_of n a)) (table_of_body (ordop_of n' b)).
Proof.
  intros Sa Sb Fa Fb H.
  pose proof (run_rejects K26 full _ _ _ _ _ _ (row_is K26 a n Sa Fa) (row_is K26 b n' Sb Fb)
    (slabs_fit_given K26 a n Sa Fa) (slabs_fit_given K26 b n' Sb Fb) H) as Rejected.
  revert Rejected. apply rejected_same; intros member M;
    [now apply (slabs_are K26 a n Sa Fa) | now apply (slabs_are K26 b n' Sb Fb)].
Qed.

Example ordops_are_rejected :
  let (a, b) := (ordop_of (5 / 8) block_here, ordop_of (5 / 8) block_away) in
  sound_ordop a /\ sound_ordop b /\
  ordops_rejected gradual K26 (row_of_body a) (row_of_body b) (table_of_body a) (table_of_body b) /\
  forall k, finite_ordop k block_here /\ finite_ordop k block_away /\
    parted k false block_here block_away = true /\
    (exists p, fills k a p) /\ (exists p, fills k b p).
Proof.
  destruct (blocks_finite K26) as (Fa & _ & Fb).
  split; [apply block_sound |]. split; [apply block_sound |]. split.
  - apply (rejected_bodies _ _ _ _ false); try assumption; try apply block_sound. run.
  - intro k. destruct (blocks_finite k) as (Ga & _ & Gb). split; [exact Ga |]. split; [exact Gb |].
    split; [destruct k; run |].
    split; eexists; exists (pt 0 0 0); (split; [apply block_between | reflexivity]).
Qed.

Example ordops_are_reported (k : kind) :
  let (a, b) := (ordop_of (5 / 8) block_here, ordop_of (5 / 8) block_touching) in
  sound_ordop a /\ sound_ordop b /\ finite_ordop k block_here /\ finite_ordop k block_touching /\
  parted k true block_here block_touching = false /\ exists p, fills k a p /\ fills k b p.
Proof.
  destruct (blocks_finite k) as (Fa & Fb & _).
  split; [apply block_sound |]. split; [apply block_sound |].
  split; [exact Fa |]. split; [exact Fb |]. split; [destruct k; run |].
  eexists. split; [exists (pt 0 0 0); split; [apply block_between | reflexivity] |].
  exists (pt (- (2 / 30)) (10 / 30) (- (11 / 30))). split.
  - fill_block. apply reached_near. cbn. values.
    apply norm_below; [lra |]. unfold square. cbn. lra.
  - unfold posed, plus, apply, exact_rotation, norm_of, dot, pt. cbn. values. f_equal; field.
Qed.

(* Two boxes turned about different axes, which no slab normal separates but two edges do. *)
Definition turned_box (y z : Z) (x : f32) : given_ordop :=
  let unit a b c := Run.Three (number a 0) (number b 0) (number c 0) in
  let axes := Run.Three (unit 1 0 0)%Z (unit 0 1 0)%Z (unit 0 0 1)%Z in
  {| v_basis := axes; v_lows := fun _ => number (-1) 0; v_highs := fun _ => number 1 0;
     v_middle := at_x 0 0; v_extent := number 2 0;
     v_pose := (zero, number y 0, number z 0, number 2 0); v_position := Run.Three x zero zero;
     v_directions := fun member => nth member
       [Run.first axes; Run.second axes; Run.third axes] (unit 0 0 0)%Z |}.
Definition box_here : given_ordop := turned_box 0 1 zero.
Definition box_crossing : given_ordop := turned_box 1 0 (number 93 (-5)).

Example edges_are_needed :
  sound_ordop (ordop_of 1 box_here) /\ sound_ordop (ordop_of 1 box_crossing) /\
  finite_ordop K6 box_here /\ finite_ordop K6 box_crossing /\
  parted K6 false box_here box_crossing = false /\ parted K6 true box_here box_crossing = true.
Proof.
  assert (S : forall y z x, (Z.abs y < 100)%Z -> (Z.abs z < 100)%Z ->
    sound_ordop (ordop_of 1 (turned_box y z x))).
  { intros y z x Y Z. assert (B : Rabs (IZR y) <= 100) by (rewrite <- abs_IZR; apply IZR_le; lia).
    assert (C : Rabs (IZR z) <= 100) by (rewrite <- abs_IZR; apply IZR_le; lia).
    assert (Q : forall t, Rabs t <= 100 -> 0 <= t * t <= 10000).
    { intros t T. split; [apply Rle_0_sqr |]. rewrite <- absolute_square. pose proof (Rabs_pos t).
      apply Rle_trans with (100 * 100); [apply Rmult_le_compat; lra | lra]. }
    pose proof (Q _ B). pose proof (Q _ C).
    unfold sound_ordop, basis_of_length, sound_quaternion, norm_of, ordop_of, turned_box,
      real_matrix, real_point, at_x, pt, square, dot.
    cbn [v_basis v_extent v_pose v_middle basis length extent middle pose quaternion_of qx qy qz qw
      row0 row1 row2 px py pz Run.first Run.second Run.third].
    values. rewrite !Rmult_1_r. repeat split; try lra.
    - unfold least_norm. lra.
    - unfold greatest_norm. lra.
    - apply Rle_trans with 2; [lra | now apply IZR_le].
    - apply Rle_trans with 1; [| now apply IZR_le].
      apply norm_below; [lra |]. unfold square. cbn [px py pz]. lra. }
  split; [apply S; lia |]. split; [apply S; lia |].
  split; [| split; [| split; run]];
    finite_block ltac:(unfold real_point, combined, direction, directions, pt; cbn; values;
      f_equal; lra).
Qed.
