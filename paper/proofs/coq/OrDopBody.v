(* Theorems N and E from bodies on: bodies whose or-DOPs the code's test rejects are disjoint. Rows
   and slabs are computed with gradual underflow, the pair test may be done in any mode. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place Duality Vectors Rounded SupportParts.
From Sdop Require Import SupportRounded Separated OrDopTest OrDop Norms64 OrDopPose SlabEnd.
Import ListNotations.
Open Scope R_scope.

(* A body: its shape's slabs along integer combinations of an orthogonal basis, its ball's centre,
   a bound on the distance of its points from the body's origin, and its pose. *)
Record ordop_body := { basis : matrix; length : R; lows : nat -> R; highs : nat -> R;
                       middle : point; extent : R; pose : quaternion; position : point }.

(* The points between the slabs' ends, in the body frame. They end at the vertices, so a point of
   them is no farther from the centre than sqrt 3 of its bound. *)
Definition between (k : kind) (b : ordop_body) (x : point) : Prop :=
  (forall member, In member (members k) ->
    lows b member <= dot (combined (basis b) (direction member)) x <= highs b member) /\
  distance (middle b) x <= 1.7321 * (extent b + norm (middle b)).
Definition fills (k : kind) (b : ordop_body) (p : point) : Prop :=
  exists x, between k b x /\ p = posed (pose b) (position b) x.

(* The contract of a body. *)
Definition sound_ordop (b : ordop_body) : Prop :=
  basis_of_length (basis b) (length b) /\ sound_quaternion (pose b) /\
  0 <= extent b <= IZR (2 ^ 62) /\ norm (middle b) <= IZR (2 ^ 62).

Definition row_of_body (b : ordop_body) : row :=
  posed_row (pose b) (position b) (middle b) (basis b).
Definition table_of_body (b : ordop_body) : slabs :=
  table (lows b) (highs b) (basis b) (middle b) (extent b).

Lemma combined_direction (b : matrix) (n : R) (member : nat) :
  basis_of_length b n -> In member (members K26) ->
  norm (combined b (direction member)) = n * norm (direction member) /\
  n <= norm (combined b (direction member)) <= 1.7321 * n.
Proof.
  intros B M. pose proof (unit_basis_orthonormal b n B) as O. pose proof B as (N & _).
  assert (E : combined b (direction member)
    = scaled n (combined (unit_basis b n) (direction member))).
  { unfold combined, unit_basis, scaled, pt. cbn [row0 row1 row2 px py pz].
    f_equal; field; lra. }
  assert (Nd : norm (combined b (direction member)) = n * norm (direction member)).
  { rewrite E, norm_scaled, norm_combined by (assumption || lra). reflexivity. }
  split; [exact Nd |]. rewrite Nd. pose proof (direction_long member M) as L.
  assert (U : norm (direction member) <= 1.7321).
  { apply norm_below; [lra |]. unfold square, direction, directions, pt.
    cbn in M. repeat (destruct M as [<- | M]); [.. | destruct M]; cbn [nth map px py pz]; lra. }
  split; [| rewrite Rmult_comm; apply Rmult_le_compat_r; lra].
  rewrite <- (Rmult_1_r n) at 1. apply Rmult_le_compat_l; lra.
Qed.

(* Where a point of the polytope is in coordinates of the slabs: along the unit basis, about the
   centre. *)
Definition coordinates (b : ordop_body) (x : point) : point :=
  apply (unit_basis (basis b) (length b)) (minus x (middle b)).

Lemma between_held (k : kind) (b : ordop_body) (x : point) :
  sound_ordop b -> between k b x ->
  holds_with (margin_of (extent b + norm (middle b))) k (table_of_body b) (coordinates b x) /\
  norm (coordinates b x) <= 1.7321 * (extent b + norm (middle b)).
Proof.
  intros (B & _ & E & C) (H & D).
  pose proof (unit_basis_orthonormal _ _ B) as O. pose proof B as (N & _).
  destruct (basis_norm _ _ B) as (N0 & _).
  assert (Nx : norm (minus x (middle b)) <= 1.7321 * (extent b + norm (middle b))) by exact D.
  split; [| unfold coordinates; now rewrite apply_keeps_norm].
  intros member M. destruct (H member M) as (Lo & Hi).
  destruct (combined_direction _ _ member B (members_all k member M)) as (Nd & Dn).
  destruct (scale_error _ _ N0 N) as (Sc & _).
  set (d := combined (basis b) (direction member)) in *.
  assert (Along : dot (direction member) (coordinates b x) = (dot d x - dot d (middle b)) / length
    b).
  { unfold coordinates, d. unfold dot, apply, combined, unit_basis, scaled, minus, dot, pt.
    cbn [row0 row1 row2 px py pz]. field. lra. }
  assert (Len : norm (direction member) = norm d / length b) by (rewrite Nd; field; lra).
  assert (Far : Rabs (dot d x - dot d (middle b)) <= norm d * (1.7321 * (extent b + norm (middle
    b)))).
  { apply Rle_trans with (1 := dot_change d x (middle b)).
    apply Rmult_le_compat_l; [apply norm_nonneg | exact Nx]. }
  destruct (slab_end_covers d (middle b) (highs b member) (dot d x) (length b)
    (norm_in_f64 (row0 (basis b))) (extent b) N Sc Dn E C Hi Far) as (P & Q).
  assert (Far' : Rabs (- dot d x - dot (opposite d) (middle b))
    <= norm (opposite d) * (1.7321 * (extent b + norm (middle b)))).
  { rewrite opposite_dot, norm_opposite.
    replace (- dot d x - - dot d (middle b)) with (- (dot d x - dot d (middle b))) by ring.
    now rewrite Rabs_Ropp. }
  destruct (slab_end_covers (opposite d) (middle b) (- lows b member) (- dot d x) (length b)
    (norm_in_f64 (row0 (basis b))) (extent b) N Sc ltac:(now rewrite norm_opposite) E C
    ltac:(lra) Far') as (P' & Q').
  rewrite opposite_dot, norm_opposite in Q'.
  unfold table_of_body, table. cbn [fst snd]. fold d. rewrite Along, Len.
  repeat split; [exact Q | | exact P | exact P'].
  apply Rle_trans with (2 := Q'). apply Rplus_le_compat_r. apply Req_le. field. lra.
Qed.

(* The place of a posed point. *)
Lemma posed_coordinates (b : ordop_body) (x : point) :
  sound_ordop b ->
  posed (pose b) (position b) x
  = plus (plus (position b) (apply (exact_rotation (pose b)) (middle b)))
      (combined (posed_axes (pose b) (basis b) (length b)) (coordinates b x)).
Proof.
  intros (B & _). pose proof (unit_basis_orthonormal _ _ B) as O.
  pose proof (combined_apply _ (minus x (middle b)) O) as C. fold (coordinates b x) in C.
  assert (E : combined (posed_axes (pose b) (basis b) (length b)) (coordinates b x)
    = apply (exact_rotation (pose b)) (minus x (middle b))).
  { rewrite <- C. unfold posed_axes, combined, apply, dot, pt. cbn [row0 row1 row2 px py pz].
    f_equal; ring. }
  rewrite E. unfold posed, plus, apply, minus, dot, pt. cbn [px py pz]. f_equal; ring.
Qed.

(* The same with any slabs that are the table's where the test reads them. *)
Theorem ordops_with_slabs_disjoint (m : mode) (k : kind) (a b : ordop_body) (sa sb : slabs) :
  valid m -> sound_ordop a -> sound_ordop b ->
  (forall member, In member (members k) -> sa member = table_of_body a member) ->
  (forall member, In member (members k) -> sb member = table_of_body b member) ->
  ordops_rejected m k (row_of_body a) (row_of_body b) sa sb ->
  forall p, ~ (fills k a p /\ fills k b p).
Proof.
  intros Hm Sa Sb Ta Tb Rejected p ((x & Bx & ->) & (y & By & E)).
  destruct (between_held k a x Sa Bx) as (Ha & Na).
  destruct (between_held k b y Sb By) as (Hb & Nb).
  assert (Ha' : holds_with (margin_of (extent a + norm (middle a))) k sa (coordinates a x))
    by (intros member M; rewrite Ta by exact M; now apply Ha).
  assert (Hb' : holds_with (margin_of (extent b + norm (middle b))) k sb (coordinates b y))
    by (intros member M; rewrite Tb by exact M; now apply Hb).
  pose proof Sa as (Ba & Qa & (Ea & Ea') & Ca). pose proof Sb as (Bb & Qb & (Eb & Eb') & Cb).
  pose proof (norm_nonneg (middle a)). pose proof (norm_nonneg (middle b)).
  assert (Big : IZR (2 ^ 62) + IZR (2 ^ 62) <= IZR (2 ^ 100))
    by (rewrite <- plus_IZR; now apply IZR_le).
  pose proof (posed_row_is (pose a) Qa (basis a) (length a) Ba (position a) (middle a)
    (extent a + norm (middle a)) ltac:(lra) ltac:(lra)) as Ra.
  pose proof (posed_row_is (pose b) Qb (basis b) (length b) Bb (position b) (middle b)
    (extent b + norm (middle b)) ltac:(lra) ltac:(lra)) as Rb.
  apply (rejected_polytopes_disjoint m k _ _ _ _ _ _ (extent a + norm (middle a))
    (extent b + norm (middle b)) _ _ _ _ Hm ltac:(lra) ltac:(lra) Ra Rb Rejected
    (coordinates a x) (coordinates b y) Na Nb Ha' Hb').
  rewrite <- !posed_coordinates by assumption. exact E.
Qed.

(* Bodies that the test of or-DOPs rejects, along slab normals or along edges, have no common point.
   The pair test may be done in any mode; rows and tables are computed with gradual underflow. *)
Theorem ordops_reject_disjoint (m : mode) (k : kind) (a b : ordop_body) :
  valid m -> sound_ordop a -> sound_ordop b ->
  ordops_rejected m k (row_of_body a) (row_of_body b) (table_of_body a) (table_of_body b) ->
  forall p, ~ (fills k a p /\ fills k b p).
Proof. intros Hm Sa Sb. now apply ordops_with_slabs_disjoint. Qed.

(* Slabs that end at vertices, or an ulp from them, keep points that near. *)
Lemma tight_slabs_near (b : ordop_body) (x : point) :
  sound_ordop b ->
  (forall member, In member [0; 1; 2]%nat ->
    let d := combined (basis b) (direction member) in
    let most := norm d * (extent b + norm (middle b)) * (1 + / 1048576) in
    lows b member <= dot d x <= highs b member /\
    - most <= lows b member - dot d (middle b) /\ highs b member - dot d (middle b) <= most) ->
  distance (middle b) x <= 1.7321 * (extent b + norm (middle b)).
Proof.
  intros (B & _ & (E & _) & _) H. pose proof B as (N & _).
  pose proof (norm_nonneg (middle b)) as C.
  assert (P : 0 <= extent b + norm (middle b)) by lra.
  set (rho := extent b + norm (middle b)) in *. unfold distance.
  rewrite <- (apply_keeps_norm _ _ (unit_basis_orthonormal _ _ B)).
  assert (One : forall member, In member [0; 1; 2]%nat ->
    Rabs (dot (direction member) (coordinates b x)) <= rho * (1 + / 1048576)).
  { intros member M. specialize (H member M). cbv zeta in H. destruct H as (A & L & U).
    assert (M' : In member (members K26)) by (cbn in M |- *; tauto).
    destruct (combined_direction _ _ member B M') as (Nd & _).
    set (d := combined (basis b) (direction member)) in *.
    assert (Along : dot (direction member) (coordinates b x)
      = (dot d x - dot d (middle b)) / length b).
    { unfold coordinates, d. unfold dot, apply, combined, unit_basis, scaled, minus, dot, pt.
      cbn [row0 row1 row2 px py pz]. field. lra. }
    assert (Unit : norm (direction member) = 1).
    { unfold norm. rewrite <- sqrt_1. f_equal. unfold square, direction, directions, pt.
      cbn in M. repeat (destruct M as [<- | M]); [.. | destruct M]; cbn [nth map px py pz]; ring. }
    rewrite Along. rewrite Nd, Unit, Rmult_1_r in *. unfold Rdiv.
    rewrite Rabs_mult, (Rabs_pos_eq (/ length b)) by (apply Rlt_le, Rinv_0_lt_compat; lra).
    apply Rmult_le_reg_r with (length b); [lra |].
    rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra. apply Rabs_le. lra. }
  fold (coordinates b x).
  pose proof (One 0%nat ltac:(cbn; tauto)) as X. pose proof (One 1%nat ltac:(cbn; tauto)) as Y.
  pose proof (One 2%nat ltac:(cbn; tauto)) as Z. clear One.
  unfold dot, direction, directions, pt in X, Y, Z. cbn [nth map px py pz] in X, Y, Z.
  apply Rle_trans with (1.73206 * (rho * (1 + / 1048576))); [| lra].
  destruct (coordinates b x) as [i j l]. cbn [px py pz] in *. apply norm_same; [lra | | |].
  - now replace i with (1 * i + 0 * j + 0 * l) by ring.
  - now replace j with (0 * i + 1 * j + 0 * l) by ring.
  - now replace l with (0 * i + 0 * j + 1 * l) by ring.
Qed.

(* So does the bound itself. *)
Lemma reached_near (b : ordop_body) (x : point) :
  norm x <= extent b -> distance (middle b) x <= 1.7321 * (extent b + norm (middle b)).
Proof.
  intro H. pose proof (norm_nonneg (middle b)). pose proof (norm_nonneg x).
  unfold distance. replace (minus x (middle b)) with (plus x (opposite (middle b))).
  - apply Rle_trans with (1 := triangle _ _). rewrite norm_opposite. lra.
  - unfold plus, minus, opposite, pt. cbn [px py pz]. f_equal; ring.
Qed.
