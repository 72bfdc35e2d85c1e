(* Bodies to which theorems N and E apply: they meet all hypotheses, occupy points, and one pair of
   them is rejected and another isn't. So the theorems don't hold for want of inputs. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Run RunOrDop.
From Sdop Require Import Format Double Geometry Pose Place Ieee Controls Same Duality Vectors.
From Sdop Require Import SupportParts OrDopTest OrDop OrDopPose OrDopBody Fits SameOrDop OrDopRun.
From Sdop Require Import Examples.
Import ListNotations.
Open Scope R_scope.

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

Definition block_here : given_ordop := block 0 0.
Definition block_touching : given_ordop := block 1 (-1).
Definition block_away : given_ordop := block 8 0.

Definition real_block (t : R) : ordop_body :=
  {| basis := {| row0 := pt (3 / 8) (4 / 8) 0; row1 := pt (- 4 / 8) (3 / 8) 0;
                 row2 := pt 0 0 (5 / 8) |};
     length := 5 / 8; lows := fun _ => -1; highs := fun _ => 1; middle := pt (/ 2) 0 0; extent := 4;
     pose := {| qx := 1; qy := 2; qz := 3; qw := 4 |}; position := pt t 0 0 |}.

Lemma block_is (x e : Z) :
  (Z.abs x < 100)%Z -> (-10 <= e <= 10)%Z ->
  ordop_of (5 / 8) (block x e) = real_block (IZR x * bpow radix2 e).
Proof.
  intros X E. unfold ordop_of, block, real_block, real_matrix, oblique, eighths, at_x, real_point,
    quaternion_of, pt.
  cbn [v_basis v_lows v_highs v_middle v_extent v_pose v_position Run.first Run.second Run.third].
  rewrite !number_value by lia. cbn [B2R Run.zero32 zero]. change (bpow radix2 0) with 1.
  change (bpow radix2 (-1)) with (/ 2). change (bpow radix2 (-3)) with (/ 8).
  rewrite !Rmult_1_r, !Rmult_1_l, !Rmult_0_l. reflexivity.
Qed.

Lemma real_block_sound (t : R) : sound_ordop (real_block t).
Proof.
  unfold sound_ordop, real_block, basis_of_length, sound_quaternion, norm_of, square, dot, pt.
  cbn [basis length extent middle pose qx qy qz qw row0 row1 row2 px py pz].
  repeat split; try lra; try (unfold least_norm, greatest_norm; lra);
    try (apply Rle_trans with 4; [lra | now apply IZR_le]).
  apply Rle_trans with 1; [| now apply IZR_le].
  apply norm_below; [lra |]. unfold square. cbn [px py pz]. lra.
Qed.

Lemma block_sound (x e : Z) :
  (Z.abs x < 100)%Z -> (-10 <= e <= 10)%Z -> sound_ordop (ordop_of (5 / 8) (block x e)).
Proof. intros X E. rewrite block_is by assumption. apply real_block_sound. Qed.

Lemma real_block_between (k : kind) (t : R) (x : point) :
  Rabs (px x) <= 11 / 30 -> Rabs (py x) <= 11 / 30 -> Rabs (pz x) <= 11 / 30 ->
  between k (real_block t) x.
Proof.
  intros X Y Z. apply Rabs_le_inv in X, Y, Z. split.
  - intros member M. apply members_all in M. cbn [real_block lows highs basis].
    unfold combined, direction, directions, dot, pt.
    cbn in M. repeat (destruct M as [<- | M]); [.. | destruct M];
      cbn [nth map row0 row1 row2 px py pz]; clear - X Y Z; lra.
  - apply reached_near. cbn [real_block extent]. apply norm_below; [lra |]. unfold square.
    assert (S : forall c, - (11 / 30) <= c <= 11 / 30 -> c * c <= 1).
    { intros c C. assert (Rabs c <= 1) by (apply Rabs_le; lra). rewrite <- absolute_square.
      pose proof (Rabs_pos c). rewrite <- (Rmult_1_r 1). apply Rmult_le_compat; lra. }
    pose proof (S _ X). pose proof (S _ Y). pose proof (S _ Z). lra.
Qed.

Definition all_within (n : Z) (v : Run.three f32) : bool :=
  let one x := is_finite x && negb (greater32 (Babs x) (number 1 n)) in
  one (Run.first v) && one (Run.second v) && one (Run.third v).

Lemma within_three_computed (n : Z) (v : Run.three f32) :
  (-100 <= n <= 100)%Z -> all_within n v = true -> within_three n v.
Proof.
  intros N H. unfold all_within in H. apply andb_prop in H. destruct H as (H & C).
  apply andb_prop in H. destruct H as (A & B). split; [| split]; now apply within_computed.
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
  split; [now apply within_computed |]. split; [now apply nonneg_computed |].
  split; [now apply within_computed |]. split; [now apply nonneg_computed |]. now split.
Qed.

(* All of a body's numbers, checked by running. *)
Definition numbers_checked (k : kind) (b : given_ordop) : bool :=
  let (r, c) := (row_of_given b, v_middle b) in
  let axes := RunOrDop.axis_of_row r in
  is_finite_strict (norm_of_f32 (v_pose b)) && is_finite (scale_of_given b) &&
  (is_finite (Run.first c) && is_finite (Run.second c) && is_finite (Run.third c)) &&
  all_within 62 (v_position b) && all_within 62 (RunOrDop.offset r) &&
  (all_within 1 (Run.first axes) && all_within 1 (Run.second axes) && all_within 1 (Run.third axes))
  && forallb (ends_checked b) (members k).

Lemma finite_computed (k : kind) (b : given_ordop) :
  numbers_checked k b = true ->
  (forall member, In member (members k) ->
    real_point (v_directions b member) = combined (real_matrix (v_basis b)) (direction member)) ->
  finite_ordop k b.
Proof.
  intros H D. unfold numbers_checked in H.
  apply andb_prop in H. destruct H as (H & E). rewrite forallb_forall in E.
  apply andb_prop in H. destruct H as (H & A). apply andb_prop in A. destruct A as (A & A2).
  apply andb_prop in A. destruct A as (A0 & A1).
  apply andb_prop in H. destruct H as (H & O). apply andb_prop in H. destruct H as (H & P).
  apply andb_prop in H. destruct H as (H & C). apply andb_prop in C. destruct C as (C & C2).
  apply andb_prop in C. destruct C as (C0 & C1).
  apply andb_prop in H. destruct H as (N & S).
  assert (F : is_finite (norm_of_f32 (v_pose b)) = true)
    by (revert N; clear; now destruct (norm_of_f32 (v_pose b))).
  unfold finite_ordop. split; [exact F |]. split; [now apply nonzero_computed |].
  split; [exact S |]. split; [split; [exact C0 | split; [exact C1 | exact C2]] |].
  split; [apply within_three_computed; [lia | exact P] |].
  split; [apply within_three_computed; [lia | exact O] |].
  split; [split; [| split]; (apply within_three_computed; [lia | assumption]) |].
  intros member M. pose proof (ends_computed b member (E member M)) as X. specialize (D member M).
  destruct (ends_of_given b member) as [hi lo]. tauto.
Qed.

Lemma blocks_finite :
  finite_ordop K26 block_here /\ finite_ordop K26 block_touching /\ finite_ordop K26 block_away.
Proof.
  assert (D : forall x e member, In member (members K26) ->
    real_point (v_directions (block x e) member)
    = combined (real_matrix (v_basis (block x e))) (direction member)).
  { intros x e member M. unfold block, real_matrix, oblique, oblique_directions, eighths, real_point,
      combined, direction, directions, pt. cbn [v_directions v_basis].
    cbn in M. repeat (destruct M as [<- | M]); [.. | destruct M];
      cbn [nth map row0 row1 row2 px py pz Run.first Run.second Run.third];
      rewrite !number_value by lia; f_equal; ring. }
  split; [| split]; (apply finite_computed; [run | apply D]).
Qed.

Local Notation parted k full a b :=
  (RunOrDop.ordops_apart (number_of k) full (row_of_given a) (row_of_given b)
    (slabs_of_given k a) (slabs_of_given k b)).

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
  assert (Ea : forall member n, In member (members k) ->
    Duality.end_of ta member n = Duality.end_of sa member n)
    by (intros; unfold Duality.end_of; rewrite Ha by (now apply (members_all k)); reflexivity).
  assert (Eb : forall member n, In member (members k) ->
    Duality.end_of tb member n = Duality.end_of sb member n)
    by (intros; unfold Duality.end_of; rewrite Hb by (now apply (members_all k)); reflexivity).
  intros [(member & M & n & signs & S & T & G) | [(member & M & n & signs & S & T & G)
    | (ea & eb & n & va & vb & S & T & V & L & G)]].
  - left. exists member. split; [exact M |]. exists n, signs. repeat (split; [assumption |]).
    now rewrite <- (support_of_same _ _ _ _ _ _ Mb), Ea.
  - right. left. exists member. split; [exact M |]. exists n, signs. repeat (split; [assumption |]).
    now rewrite <- (support_of_same _ _ _ _ _ _ Ma), Eb.
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
  pose proof (run_rejects K26 full (row_of_given a) (row_of_given b) (slabs_of_given K26 a)
    (slabs_of_given K26 b) (row_of_body (ordop_of n a)) (row_of_body (ordop_of n' b))
    (row_is K26 a n Sa Fa) (row_is K26 b n' Sb Fb)
    (slabs_fit_given K26 a n Sa Fa) (slabs_fit_given K26 b n' Sb Fb) H) as Rejected.
  revert Rejected. apply rejected_same; intros member M;
    [now apply (slabs_are K26 a n Sa Fa) | now apply (slabs_are K26 b n' Sb Fb)].
Qed.

Example ordops_are_rejected :
  let (a, b) := (ordop_of (5 / 8) block_here, ordop_of (5 / 8) block_away) in
  sound_ordop a /\ sound_ordop b /\
  ordops_rejected gradual K26 (row_of_body a) (row_of_body b) (table_of_body a) (table_of_body b) /\
  finite_ordop K26 block_here /\ finite_ordop K26 block_away /\
  parted K26 false block_here block_away = true /\
  (exists p, fills K26 a p) /\ (exists p, fills K26 b p).
Proof.
  destruct blocks_finite as (Fa & _ & Fb).
  assert (H : parted K26 false block_here block_away = true) by run.
  split; [apply block_sound; lia |]. split; [apply block_sound; lia |]. split.
  - exact (rejected_bodies _ _ _ _ false (block_sound 0 0 ltac:(lia) ltac:(lia))
      (block_sound 8 0 ltac:(lia) ltac:(lia)) Fa Fb H).
  - split; [exact Fa |]. split; [exact Fb |]. split; [exact H |].
    split; eexists; exists (pt 0 0 0); (split; [| reflexivity]);
      unfold block_here, block_away; rewrite block_is by lia; apply real_block_between;
      unfold pt; cbn [px py pz]; rewrite Rabs_R0; lra.
Qed.

Example ordops_are_reported :
  let (a, b) := (ordop_of (5 / 8) block_here, ordop_of (5 / 8) block_touching) in
  sound_ordop a /\ sound_ordop b /\ finite_ordop K26 block_here /\ finite_ordop K26 block_touching /\
  parted K26 false block_here block_touching = false /\
  exists p, fills K26 a p /\ fills K26 b p.
Proof.
  destruct blocks_finite as (Fa & Fb & _).
  split; [apply block_sound; lia |]. split; [apply block_sound; lia |].
  split; [exact Fa |]. split; [exact Fb |]. split; [run |].
  unfold block_here, block_touching. rewrite !block_is by lia. eexists. split.
  - exists (pt 0 0 0). split; [| reflexivity].
    apply real_block_between; unfold pt; cbn [px py pz]; rewrite Rabs_R0; lra.
  - exists (pt (- (2 / 30)) (10 / 30) (- (11 / 30))).
    split; [apply real_block_between; unfold pt; cbn [px py pz]; apply Rabs_le; lra |].
    change (bpow radix2 (-1)) with (/ 2). change (bpow radix2 0) with 1.
    unfold real_block, posed, plus, apply, exact_rotation, norm_of, dot, pt.
    cbn [pose position qx qy qz qw px py pz row0 row1 row2]. f_equal; field.
Qed.
