(* Theorems N and E of the functions that run: rows and slabs as they are computed of a body's
   numbers, and the test. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Run RunOrDop.
From Sdop Require Import Format Double Geometry Pose Place WorldBall Ieee Shows Outward Same
  Duality.
From Sdop Require Import Vectors Rounded SupportParts SupportRounded Separated OrDopTest OrDop.
From Sdop Require Import Norms64 OrDopPose SlabEnd OrDopBody Fits SameOrDop.
Import ListNotations.
Open Scope R_scope.

Local Notation g := gradual64.

(* A body as its numbers are given. *)
Record given_ordop := { v_basis : Run.three (Run.three f32); v_lows : nat -> f32;
  v_highs : nat -> f32; v_middle : Run.three f32; v_extent : f32;
  v_pose : f32 * f32 * f32 * f32; v_position : Run.three f32;
  v_directions : nat -> Run.three f32 }.

Definition real_matrix (b : Run.three (Run.three f32)) : matrix :=
  {| row0 := real_point (Run.first b); row1 := real_point (Run.second b);
     row2 := real_point (Run.third b) |}.
Definition ordop_of (n : R) (b : given_ordop) : ordop_body :=
  {| basis := real_matrix (v_basis b); length := n; lows := fun i => B2R (v_lows b i);
     highs := fun i => B2R (v_highs b i); middle := real_point (v_middle b);
     extent := B2R (v_extent b); pose := quaternion_of (v_pose b);
     position := real_point (v_position b) |}.

(* src/update/frame.rs: ShapeFrame::row *)
Definition rotation_of_given (b : given_ordop) : Run.three (Run.three Run.f64) :=
  let '(x, y, z, w) := v_pose b in
  Run.rotation64 (Run.to_f64 x) (Run.to_f64 y) (Run.to_f64 z) (Run.to_f64 w).
Definition row_of_given (b : given_ordop) : RunOrDop.row :=
  let r := rotation_of_given b in
  let c := v_middle b in
  {| RunOrDop.axis_of_row := Run.world_axes64 r (Run.each (Run.each Run.to_f64) (v_basis b));
     RunOrDop.translation := v_position b;
     RunOrDop.offset :=
       if Run.is_zero (Run.first c) && Run.is_zero (Run.second c) && Run.is_zero (Run.third c)
       then Run.Three Run.zero32 Run.zero32 Run.zero32
       else Run.each Run.to_f32 (Run.rotate64 r (Run.each Run.to_f64 c)) |}.
(* src/overlap/ordop/table.rs: table. Ends that the test doesn't read are zero. *)
Definition scale_of_given (b : given_ordop) : Run.f64 :=
  Run.length64 (Run.each Run.to_f64 (Run.first (v_basis b))).
Definition ends_of_given (b : given_ordop) (member : nat) : f32 * f32 :=
  let '(lo, hi) := Run.inflate_slab (v_lows b member) (v_highs b member) (v_directions b member)
    (scale_of_given b) (v_middle b) (v_extent b) in
  (hi, Bopp lo).
Definition slabs_of_given (k : kind) (b : given_ordop) : RunOrDop.slabs :=
  map (fun member => if existsb (Nat.eqb member) (members k) then ends_of_given b member
    else (Run.zero32, Run.zero32)) (seq 0 13).

Lemma nearest64_opp (x : R) : nearest64 (- x) = - nearest64 x.
Proof. apply round_NE_opp. Qed.
Lemma fl64_opp (x : R) : fl64 g (- x) = - fl64 g x.
Proof. rewrite !gradual_fl64. apply nearest64_opp. Qed.
Lemma fl_opp (x : R) : fl gradual (- x) = - fl gradual x.
Proof. rewrite !gradual_fl. apply round_NE_opp. Qed.

Lemma mul64_opp (x y : R) : mul64 g (- x) y = - mul64 g x y.
Proof.
  unfold mul64. rewrite !read64_is. rewrite <- fl64_opp. f_equal. ring.
Qed.
Lemma add64_opp (x y : R) : add64 g (- x) (- y) = - add64 g x y.
Proof. unfold add64. rewrite !read64_is. rewrite <- fl64_opp. f_equal. ring. Qed.
Lemma sub64_opp (x y : R) : sub64 g (- x) (- y) = - sub64 g x y.
Proof. unfold sub64. rewrite !read64_is. rewrite <- fl64_opp. f_equal. ring. Qed.
Lemma div64_opp (x y : R) : div64 g (- x) y = - div64 g x y.
Proof. unfold div64. rewrite !read64_is. rewrite <- fl64_opp. f_equal. unfold Rdiv. ring. Qed.

Lemma rotate_row_opp (d c : point) : rotate_row g (opposite d) c = - rotate_row g d c.
Proof.
  unfold rotate_row, opposite, pt. cbn [px py pz]. now rewrite !mul64_opp, !add64_opp.
Qed.
Lemma norm_in_f64_opp (d : point) : norm_in_f64 (opposite d) = norm_in_f64 d.
Proof.
  unfold norm_in_f64, rotate_row, opposite, pt. cbn [px py pz]. unfold mul64.
  rewrite !read64_is. now rewrite !Rmult_opp_opp.
Qed.

(* The lower end, turned round, is the upper one of the opposite direction. *)
Lemma lower_end (lo : R) (d c : point) (scale reach : R) :
  let offset := rotate_row g d c in
  let length := div64 g (norm_in_f64 d) scale in
  let size := add64 g reach (norm_in_f64 c) in
  let margin := mul64 g length (add64 g (mul64 g slab_margin size) slab_floor) in
  slab_end (- lo) (opposite d) c scale reach
  = WorldBall.up gradual
      (- sub64 g (Rmin (div64 g (sub64 g lo offset) scale) 0) margin).
Proof.
  cbv zeta. unfold slab_end, next_above.
  rewrite rotate_row_opp, norm_in_f64_opp, sub64_opp, div64_opp.
  f_equal. set (e := div64 g (sub64 g lo _) scale). set (margin := mul64 g _ _).
  replace (Rmax (- e) 0) with (- Rmin e 0).
  - unfold add64 at 1, sub64. rewrite !read64_is, <- fl64_opp. f_equal. ring.
  - unfold Rmin, Rmax. repeat destruct Rle_dec; lra.
Qed.

Lemma shows_succ (x : f32) (a : R) :
  shows x (fl gradual a) -> 0 <= B2R (Bsucc x) -> shows (Bsucc x) (WorldBall.up gradual a).
Proof.
  intros H P F. unfold WorldBall.up in *.
  assert (Fx : is_finite x = true).
  { destruct x as [s | s | | s m e I]; try reflexivity; [| discriminate F].
    destruct s; [| discriminate F]. exfalso. revert P. apply Rlt_not_le.
    change (B2R _) with (F2R (Float radix2 (-16777215) 104)). unfold F2R. cbn. lra. }
  pose proof (Bsucc_correct 24 128 _ _ x Fx) as C. rewrite (H Fx) in C.
  destruct Rlt_bool in C; [exact (proj1 C) |].
  exfalso. rewrite <- is_finite_SF_B2SF in F. rewrite C in F. discriminate.
Qed.

Lemma opposite_down (x : Run.f64) (a : R) :
  shows x a -> 0 <= B2R (Bopp (Run.down x)) ->
  shows (Bopp (Run.down x)) (WorldBall.up gradual (- a)).
Proof.
  intros H. unfold Run.down, Bpred. rewrite Bopp_involutive. apply shows_succ.
  rewrite fl_opp. apply shows_opposite. now apply shows_to_f32.
Qed.

Lemma shows_point_of (v : Run.three f32) :
  shows_point (Run.each Run.to_f64 v) (real_point v).
Proof. split; [| split]; apply shows_to_f64, shows_itself. Qed.

Lemma shows_rotate_row (a x : Run.three Run.f64) (p q : point) :
  shows_point a p -> shows_point x q -> shows (Run.dot64 a x) (rotate_row g p q).
Proof.
  intros (A & B & C) (X & Y & Z). unfold Run.dot64, rotate_row. show.
Qed.

Lemma shows_length (x : Run.three Run.f64) (p : point) :
  shows_point x p -> shows (Run.length64 x) (norm_in_f64 p).
Proof.
  intro H. unfold Run.length64, norm_in_f64. apply shows_root64. now apply shows_rotate_row.
Qed.

(* A slab's end about the centre, in units of the basis, before the margin. *)
Definition about_middle (b : given_ordop) (member : nat) (x : f32) : Run.f64 :=
  Run.divide64 (Run.minus64 (Run.to_f64 x) (Run.dot64
    (Run.each Run.to_f64 (v_directions b member)) (Run.each Run.to_f64 (v_middle b))))
    (scale_of_given b).

(* What is asked of numbers: they are finite, no larger than those of bodies of the contract, and
   directions are exact. *)
Definition within_power (n : Z) (x : f32) : Prop :=
  is_finite x = true /\ Rabs (B2R x) <= bpow radix2 n.
Definition within_three (n : Z) (v : Run.three f32) : Prop :=
  within_power n (Run.first v) /\ within_power n (Run.second v) /\ within_power n (Run.third v).
Definition finite_ordop (k : kind) (b : given_ordop) : Prop :=
  is_finite (norm_of_f32 (v_pose b)) = true /\ B2R (norm_of_f32 (v_pose b)) <> 0 /\
  is_finite (scale_of_given b) = true /\ finite_three (v_middle b) /\
  within_three 62 (v_position b) /\ within_three 62 (RunOrDop.offset (row_of_given b)) /\
  (let axes := RunOrDop.axis_of_row (row_of_given b) in
    within_three 1 (Run.first axes) /\ within_three 1 (Run.second axes) /\
    within_three 1 (Run.third axes)) /\
  (forall member, In member (members k) ->
    let (hi, lo) := ends_of_given b member in
    within_power 66 hi /\ 0 <= B2R hi /\ within_power 66 lo /\ 0 <= B2R lo /\
    is_finite (about_middle b member (v_highs b member)) = true /\
    is_finite (about_middle b member (v_lows b member)) = true /\
    real_point (v_directions b member) = combined (real_matrix (v_basis b)) (direction member)).

Section Given.
Variable k : kind.
Variable b : given_ordop.
Variable n : R.
Hypothesis Hs : sound_ordop (ordop_of n b).
Hypothesis Hf : finite_ordop k b.

Lemma rotation_of_given_is :
  shows_matrix (rotation_of_given b) (rotation_of g (quaternion_of (v_pose b))).
Proof.
  destruct Hf as (F & N & _). unfold rotation_of_given.
  destruct (v_pose b) as [[[x y] z] w]. cbn [norm_of_f32 quaternion_of] in *.
  apply rotation64_is; try assumption; apply shows_to_f64, shows_itself.
Qed.

Lemma scale_is :
  shows (scale_of_given b) (norm_in_f64 (real_point (Run.first (v_basis b)))) /\
  norm_in_f64 (real_point (Run.first (v_basis b))) <> 0.
Proof.
  split; [unfold scale_of_given; apply shows_length, shows_point_of |].
  destruct Hs as (B & _). pose proof (basis_norm _ _ B) as (N & _).
  destruct (scale_error _ _ N (proj1 B)) as (_ & P & _). cbn [ordop_of basis real_matrix row0] in P.
  lra.
Qed.

Lemma axis_is (x : Run.three f32) :
  within_three 1 (Run.each (fun x => Run.to_f32 (Run.mult64 x
    (Run.divide64 (Run.number64 1 0) (scale_of_given b))))
    (Run.rotate64 (rotation_of_given b) (Run.each Run.to_f64 x))) ->
  fits_three 1 (Run.each (fun x => Run.to_f32 (Run.mult64 x
    (Run.divide64 (Run.number64 1 0) (scale_of_given b))))
    (Run.rotate64 (rotation_of_given b) (Run.each Run.to_f64 x)))
  (let r := rotation_of g (quaternion_of (v_pose b)) in
   let unit := over_norm (real_point (Run.first (v_basis b))) in
   pt (fl gradual (mul64 g (rotate_row g (row0 r) (real_point x)) unit))
    (fl gradual (mul64 g (rotate_row g (row1 r) (real_point x)) unit))
    (fl gradual (mul64 g (rotate_row g (row2 r) (real_point x)) unit))).
Proof.
  intros W. destruct rotation_of_given_is as (R0 & R1 & R2). destruct scale_is as (Sc & Nz).
  pose proof Hf as (_ & _ & Fs & _).
  assert (Unit : shows (Run.divide64 (Run.number64 1 0) (scale_of_given b))
    (over_norm (real_point (Run.first (v_basis b))))).
  { unfold over_norm. apply shows_divide64; [apply shows_one64 | exact Sc | exact Fs | exact Nz]. }
  assert (One : forall a p, shows_point a p ->
    shows (Run.to_f32 (Run.mult64 (Run.dot64 a (Run.each Run.to_f64 x))
      (Run.divide64 (Run.number64 1 0) (scale_of_given b))))
    (fl gradual (mul64 g (rotate_row g p (real_point x))
      (over_norm (real_point (Run.first (v_basis b))))))).
  { intros a p H. apply shows_to_f32, shows_mult64; [| exact Unit].
    apply shows_rotate_row; [exact H | apply shows_point_of]. }
  unfold Run.rotate64, Run.each in W |- *. cbn [Run.first Run.second Run.third] in W |- *.
  destruct W as ((F0 & B0) & (F1 & B1) & (F2 & B2)). cbn [Run.first Run.second Run.third] in *.
  pose proof (One _ _ R0 F0) as E0. pose proof (One _ _ R1 F1) as E1.
  pose proof (One _ _ R2 F2) as E2. unfold Run.each in E0, E1, E2. cbv zeta.
  split; [| split]; cbn [Run.first Run.second Run.third px py pz pt]; (split; [| split]);
    try assumption; [rewrite <- E0 | rewrite <- E1 | rewrite <- E2]; assumption.
Qed.

Lemma row_is : row_fits (row_of_given b) (row_of_body (ordop_of n b)).
Proof.
  pose proof Hf as (_ & _ & _ & (M0 & M1 & M2) & (P0 & P1 & P2) & O & (A0 & A1 & A2) & _).
  split; [| split].
  - cbn [row_of_given RunOrDop.axis_of_row row_of_body posed_row row_axes] in A0, A1, A2 |- *.
    unfold Run.world_axes64, rounded_axes in *. cbv zeta in *.
    split; [| split]; cbn [Run.each Run.first Run.second Run.third row0 row1 row2] in *;
      apply axis_is; assumption.
  - cbn [row_of_given RunOrDop.translation row_of_body posed_row row_place].
    destruct P0 as (F0 & B0), P1 as (F1 & B1), P2 as (F2 & B2).
    split; [| split]; (split; [assumption | split; [reflexivity | assumption]]).
  - cbn [row_of_given RunOrDop.offset row_of_body posed_row row_offset] in O |- *.
    assert (Z : is_origin gradual (real_point (v_middle b))
      = Run.is_zero (Run.first (v_middle b)) && Run.is_zero (Run.second (v_middle b))
        && Run.is_zero (Run.third (v_middle b))).
    { unfold is_origin, real_point, pt. cbn [px py pz].
      symmetry. apply f_equal2; [apply f_equal2 |]; (apply is_zero_is; [| now intro]);
        [exact M0 | exact M1 | exact M2]. }
    cbn [ordop_of middle]. rewrite Z in *.
    destruct (Run.is_zero (Run.first (v_middle b)) && Run.is_zero (Run.second (v_middle b))
      && Run.is_zero (Run.third (v_middle b))).
    + split; [| split]; apply (fits_more (-100)); try lia; exact zero_fits.
    + destruct rotation_of_given_is as (R0 & R1 & R2).
      pose proof (shows_to_f32 _ _ (shows_rotate_row _ _ _ _ R0 (shows_point_of (v_middle b)))) as
        E0.
      pose proof (shows_to_f32 _ _ (shows_rotate_row _ _ _ _ R1 (shows_point_of (v_middle b)))) as
        E1.
      pose proof (shows_to_f32 _ _ (shows_rotate_row _ _ _ _ R2 (shows_point_of (v_middle b)))) as
        E2.
      destruct O as ((F0 & B0) & (F1 & B1) & (F2 & B2)).
      cbn [Run.each Run.rotate64 Run.first Run.second Run.third] in *.
      specialize (E0 F0). specialize (E1 F1). specialize (E2 F2).
      split; [| split]; cbn [Run.each Run.rotate64 Run.first Run.second Run.third rounded_offset
        px py pz pt]; (split; [| split]); try assumption;
        [exact (eq_ind _ (fun y => Rabs y <= bpow radix2 62) B0 _ E0)
        | exact (eq_ind _ (fun y => Rabs y <= bpow radix2 62) B1 _ E1)
        | exact (eq_ind _ (fun y => Rabs y <= bpow radix2 62) B2 _ E2)].
Qed.

Lemma ends_are (member : nat) :
  In member (members k) ->
  fits 66 (fst (ends_of_given b member)) (fst (table_of_body (ordop_of n b) member)) /\
  fits 66 (snd (ends_of_given b member)) (snd (table_of_body (ordop_of n b) member)).
Proof.
  intro M. pose proof Hf as (_ & _ & Fs & _ & _ & _ & _ & E). specialize (E member M).
  destruct scale_is as (Sc & Nz).
  unfold table_of_body, table. cbn [ordop_of lows highs basis middle extent fst snd].
  unfold ends_of_given, Run.inflate_slab in *. cbv zeta in *.
  set (d32 := Run.each Run.to_f64 (v_directions b member)) in *.
  set (c32 := Run.each Run.to_f64 (v_middle b)) in *.
  set (off := Run.plus64 (Run.plus64 (Run.mult64 (Run.first d32) (Run.first c32))
    (Run.mult64 (Run.second d32) (Run.second c32))) (Run.mult64 (Run.third d32) (Run.third c32)))
    in *.
  set (d := combined (real_matrix (v_basis b)) (direction member)) in *.
  destruct E as ((F0 & B0) & P0 & (F1 & B1) & P1 & Fh & Fl & D). cbn [fst snd].
  assert (Dp : shows_point d32 d) by (rewrite <- D; apply shows_point_of).
  assert (Cp : shows_point c32 (real_point (v_middle b))) by apply shows_point_of.
  pose proof (shows_rotate_row d32 c32 _ _ Dp Cp) as Off. unfold Run.dot64 in Off. fold off in Off.
  assert (Len : shows (Run.divide64 (Run.length64 d32) (scale_of_given b))
    (div64 g (norm_in_f64 d) (norm_in_f64 (real_point (Run.first (v_basis b)))))).
  { apply shows_divide64; [now apply shows_length | exact Sc | exact Fs | exact Nz]. }
  assert (Margin17 : shows (Run.number64 1 (-17)) slab_margin).
  { intros _. change (F2R (Float radix2 4503599627370496 (-69)) = slab_margin).
    unfold F2R, slab_margin, u. cbn. lra. }
  assert (Floor : shows (Run.number64 1 (-110)) slab_floor).
  { intros _. change (F2R (Float radix2 4503599627370496 (-162)) = slab_floor).
    unfold F2R, slab_floor. cbn. lra. }
  pose proof (shows_length c32 _ Cp) as Cl.
  pose proof (shows_to_f64 _ _ (shows_itself (v_extent b))) as Ex.
  change (read gradual (B2R (v_extent b))) with (B2R (v_extent b)) in Ex.
  (* The upper end. *)
  assert (Margin : shows (Run.mult64 (Run.divide64 (Run.length64 d32) (scale_of_given b))
      (Run.plus64 (Run.mult64 (Run.number64 1 (-17)) (Run.plus64 (Run.to_f64 (v_extent b))
        (Run.length64 c32))) (Run.number64 1 (-110))))
    (mul64 g (div64 g (norm_in_f64 d) (norm_in_f64 (real_point (Run.first (v_basis b)))))
      (add64 g (mul64 g slab_margin (add64 g (B2R (v_extent b))
        (norm_in_f64 (real_point (v_middle b))))) slab_floor))) by show.
  set (margin32 := Run.mult64 _ (Run.plus64 _ (Run.number64 1 (-110)))) in *.
  set (margin := mul64 g _ (add64 g _ slab_floor)) in *.
  assert (End : forall x, is_finite (about_middle b member x) = true ->
    shows (about_middle b member x) (div64 g (sub64 g (B2R x) (rotate_row g d
      (real_point (v_middle b)))) (norm_in_f64 (real_point (Run.first (v_basis b)))))).
  { intros x _. unfold about_middle. apply shows_divide64; [| exact Sc | exact Fs | exact Nz].
    apply shows_minus64; [| exact Off].
    exact (shows_to_f64 x (B2R x) (shows_itself x)). }
  pose proof (End _ Fh) as Eh. pose proof (End _ Fl) as El. clear End.
  unfold about_middle in Fh, Fl, Eh, El. unfold Run.dot64 in Fh, Fl, Eh, El.
  fold d32 c32 off in Fh, Fl, Eh, El.
  set (quotient_hi := Run.divide64 (Run.minus64 (Run.to_f64 (v_highs b member)) off) _) in *.
  set (quotient_lo := Run.divide64 (Run.minus64 (Run.to_f64 (v_lows b member)) off) _) in *.
  assert (Zero : shows Run.zero64 0) by now intro.
  destruct (greater_of_is quotient_hi Run.zero64 _ 0 Fh eq_refl Eh Zero) as (_ & Gh).
  destruct (lesser_is quotient_lo Run.zero64 _ 0 Fl eq_refl El Zero) as (_ & Gl).
  split; (split; [assumption |]).
  - assert (S : shows (Run.up (Run.plus64 (Run.greater_of quotient_hi Run.zero64) margin32))
      (slab_end (B2R (v_highs b member)) d (real_point (v_middle b))
        (norm_in_f64 (real_point (Run.first (v_basis b)))) (B2R (v_extent b)))).
    { unfold slab_end, next_above. apply shows_up; [| exact P0].
      apply shows_plus64; [intros _; exact Gh | exact Margin]. }
    specialize (S F0). split; [exact S |].
    exact (eq_ind _ (fun y => Rabs y <= bpow radix2 66) B0 _ S).
  - assert (S : shows (Bopp (Run.down (Run.minus64 (Run.lesser quotient_lo Run.zero64) margin32)))
      (slab_end (- B2R (v_lows b member)) (opposite d) (real_point (v_middle b))
        (norm_in_f64 (real_point (Run.first (v_basis b)))) (B2R (v_extent b)))).
    { rewrite lower_end. apply opposite_down; [| exact P1].
      apply shows_minus64; [intros _; exact Gl | exact Margin]. }
    specialize (S F1). split; [exact S |].
    exact (eq_ind _ (fun y => Rabs y <= bpow radix2 66) B1 _ S).
Qed.

Lemma slabs_are (member : nat) :
  In member (members k) ->
  real_slabs (slabs_of_given k b) member = table_of_body (ordop_of n b) member.
Proof.
  intro M. destruct (ends_are member M) as ((_ & E0 & _) & (_ & E1 & _)).
  assert (N : nth member (slabs_of_given k b) (Run.zero32, Run.zero32) = ends_of_given b member).
  { unfold slabs_of_given. pose proof (members_all k member M) as M'.
    assert (X : existsb (Nat.eqb member) (members k) = true).
    { apply existsb_exists. exists member. split; [exact M | apply Nat.eqb_refl]. }
    cbn in M'. repeat (destruct M' as [<- | M']); [.. | destruct M']; cbn [seq map nth];
      now rewrite X. }
  unfold real_slabs. rewrite N, E0, E1. now destruct (table_of_body (ordop_of n b) member).
Qed.

Lemma slabs_fit_given : slabs_fit (slabs_of_given k b).
Proof.
  intros member negative. unfold RunOrDop.end_of, end_of, real_slabs. cbn [fst snd].
  assert (Entry : forall ends, In ends (slabs_of_given k b) \/ ends = (Run.zero32, Run.zero32) ->
    is_finite (fst ends) = true /\ Rabs (B2R (fst ends)) <= bpow radix2 66 /\
    is_finite (snd ends) = true /\ Rabs (B2R (snd ends)) <= bpow radix2 66).
  { assert (Z : is_finite Run.zero32 = true /\ Rabs (B2R Run.zero32) <= bpow radix2 66).
    { split; [reflexivity |]. cbn [Run.zero32 B2R]. rewrite Rabs_R0. apply bpow_ge_0. }
    destruct Z as (Z0 & Z1). pose proof (conj Z0 (conj Z1 (conj Z0 Z1))) as Z.
    intros ends [H | ->]; [| exact Z].
    unfold slabs_of_given in H. apply in_map_iff in H. destruct H as (i & <- & _).
    destruct (existsb (Nat.eqb i) (members k)) eqn:X; [| exact Z].
    apply existsb_exists in X. destruct X as (j & M & Q). apply Nat.eqb_eq in Q. subst j.
    destruct (ends_are i M) as ((F0 & E0 & B0) & (F1 & E1 & B1)). 
    rewrite E0, E1. exact (conj F0 (conj B0 (conj F1 B1))). }
  specialize (Entry (nth member (slabs_of_given k b) (Run.zero32, Run.zero32))).
  destruct Entry as (F0 & B0 & F1 & B1).
  - destruct (nth_in_or_default member (slabs_of_given k b) (Run.zero32, Run.zero32)) as [I | D];
      [left; exact I | right; exact D].
  - destruct negative; (split; [assumption | split; [reflexivity | assumption]]).
Qed.
End Given.

(* What the test that runs rejects, along slab normals or along edges, has no common point. *)
Theorem run_ordops_reject_disjoint (k : kind) (full : bool) (a b : given_ordop) (n n' : R) :
  sound_ordop (ordop_of n a) -> sound_ordop (ordop_of n' b) -> finite_ordop k a -> finite_ordop k b
    ->
  RunOrDop.ordops_apart (number_of k) full (row_of_given a) (row_of_given b)
    (slabs_of_given k a) (slabs_of_given k b) = true ->
  forall p, ~ (fills k (ordop_of n a) p /\ fills k (ordop_of n' b) p).
Proof.
  intros Sa Sb Fa Fb H.
  pose proof (run_rejects k full _ _ _ _ _ _ (row_is k a n Sa Fa) (row_is k b n' Sb Fb)
    (slabs_fit_given k a n Sa Fa) (slabs_fit_given k b n' Sb Fb) H) as Rejected.
  exact (ordops_with_slabs_disjoint gradual k _ _ _ _ gradual_valid Sa Sb
    (slabs_are k a n Sa Fa) (slabs_are k b n' Sb Fb) Rejected).
Qed.
