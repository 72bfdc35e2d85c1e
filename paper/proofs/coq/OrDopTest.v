(* The test of two or-DOPs as the code has it, and how far the turn between them and the gap are
   from exact. Any underflow is included. *)
From Coq Require Import Reals Bool List Lra.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Pose Duality Vectors Rounded SupportParts SupportRounded
  Separated.
Import ListNotations.
Open Scope R_scope.

Section Code.
Variable m : mode.

(* src/overlap/ordop/axes.rs: PairFrames::new. A row: the axes, the translation and the offset. *)
Record row := { row_axes : matrix; row_place : point; row_offset : point }.
Definition along_axes (q : matrix) (d : point) : point :=
  pt (dot_of m (row0 q) d) (dot_of m (row1 q) d) (dot_of m (row2 q) d).
Definition delta (a b : row) : point :=
  let along f := add m (sub m (f (row_place b)) (f (row_place a)))
    (sub m (f (row_offset b)) (f (row_offset a))) in
  pt (along px) (along py) (along pz).
Definition gap_a (a b : row) : point := along_axes (row_axes a) (delta a b).
Definition negated (v : point) : point := pt (sub m 0 (px v)) (sub m 0 (py v)) (sub m 0 (pz v)).
Definition gap_b (a b : row) : point := negated (along_axes (row_axes b) (delta a b)).
Definition turn (a b : row) : matrix :=
  let line x := pt (dot_of m x (row0 (row_axes b))) (dot_of m x (row1 (row_axes b)))
    (dot_of m x (row2 (row_axes b))) in
  {| row0 := line (row0 (row_axes a)); row1 := line (row1 (row_axes a));
     row2 := line (row2 (row_axes a)) |}.

(* src/overlap/ordop/axes.rs: PairFrames::column *)
Definition transposed (t : matrix) : matrix :=
  {| row0 := pt (px (row0 t)) (px (row1 t)) (px (row2 t));
     row1 := pt (py (row0 t)) (py (row1 t)) (py (row2 t));
     row2 := pt (pz (row0 t)) (pz (row1 t)) (pz (row2 t)) |}.

(* src/overlap/ordop/axes.rs: combinations *)
Definition combination (v : point) (member : nat) : R :=
  let '(x, y, z) := (px v, py v, pz v) in
  let (sum, difference) := (add m x y, sub m x y) in
  nth member
    [x; y; z; sum; difference; add m x z; sub m x z; add m y z; sub m y z; add m sum z;
     sub m z difference; add m difference z; sub m z sum] 0.

(* A sign bit, of a zero either one. *)
Definition flipped (negative : bool) (v : point) : point := if negative then opposite v else v.
Definition mirrored (s : slabs) : slabs := fun member => (snd (s member), fst (s member)).

(* src/overlap/ordop/axes.rs: by_normals, one axis, whose rows of turn are the other body's axes
   along this one's *)
Definition normal_separates (k : kind) (columns : matrix) (gap : point) (own other : slabs)
    (member : nat) : Prop :=
  let tau := combination gap member in
  let e := pt (combination (row0 columns) member) (combination (row1 columns) member)
    (combination (row2 columns) member) in
  exists negative signs, sign_of negative tau /\ signs_of signs (flipped negative e) /\
    greater m (Rabs tau) (add m (end_of own member negative)
      (support_of m k (mirrored other) signs (flipped negative e))) = true.

(* src/overlap/ordop/axes.rs: cross, PairFrames::by_edges, one pair of edges; edges.rs: EDGES *)
Definition cross (n v : point) : point :=
  pt (sub m (mul m (py n) (pz v)) (mul m (pz n) (py v)))
    (sub m (mul m (pz n) (px v)) (mul m (px n) (pz v)))
    (sub m (mul m (px n) (py v)) (mul m (py n) (px v))).
Definition edges_separate (k : kind) (t : matrix) (gap : point) (own other : slabs)
    (edge_a edge_b : point) : Prop :=
  let axis := cross edge_a (pt (dot_of m edge_b (row0 t)) (dot_of m edge_b (row1 t))
    (dot_of m edge_b (row2 t))) in
  let tau := dot_of m axis gap in
  exists negative signs_a signs_b,
    let towards := flipped negative axis in
    let away := negated (along_axes (transposed t) towards) in
    sign_of negative tau /\ signs_of signs_a towards /\ signs_of signs_b away /\
    greater m (dot_of m axis axis) (/ 4) = true /\
    greater m (Rabs tau) (add m (support_of m k own signs_a towards)
      (support_of m k other signs_b away)) = true.

(* src/overlap/ordop/kernel.rs: OrDopColumns::test_one; with fewer axes it rejects less. Any two
   vectors may be edges. *)
Definition ordops_rejected (k : kind) (a b : row) (sa sb : slabs) : Prop :=
  (exists member, In member (members k) /\
    normal_separates k (transposed (turn a b)) (gap_a a b) sa sb member) \/
  (exists member, In member (members k) /\
    normal_separates k (turn a b) (gap_b a b) sb sa member) \/
  (exists edge_a edge_b, edges_separate k (turn a b) (gap_a a b) sa sb edge_a edge_b).
End Code.

(* What is rounded once: axes and offset of a pose, against exact ones. *)
Definition row_of (q : matrix) (t o : point) (reach : R) (r : row) : Prop :=
  orthonormal q /\ row_place r = t /\
  norm (minus (row0 (row_axes r)) (row0 q)) <= 1.01 * u /\
  norm (minus (row1 (row_axes r)) (row1 q)) <= 1.01 * u /\
  norm (minus (row2 (row_axes r)) (row2 q)) <= 1.01 * u /\
  norm o <= reach /\ norm (minus (row_offset r) o) <= 1.01 * u * reach + 2 * tiny.

Section Pair.
Variable m : mode.
Hypothesis Hm : valid m.

Lemma combination_near (v : point) (member : nat) :
  In member (members K26) ->
  Rabs (combination m v member - dot (direction member) v)
    <= 3.01 * u * (norm (direction member) * norm v) + 12 * tiny.
Proof.
  intro H. pose proof (absolute_dot (direction member) v) as A. pose proof tiny_value as T.
  set (k := norm (direction member) * norm v) in *.
  pose proof (add_near m Hm (px v) (py v)) as S. pose proof (sub_near m Hm (px v) (py v)) as D.
  assert (P : forall x y z : R, Rabs x + Rabs y + Rabs z <= k -> 0 <= k)
    by (intros x y z; pose proof (Rabs_pos x); pose proof (Rabs_pos y); pose proof (Rabs_pos z);
      lra).
  pose proof (P _ _ _ A) as K. clear P.
  pose proof (add_near m Hm (add m (px v) (py v)) (pz v)) as S1.
  pose proof (sub_near m Hm (pz v) (sub m (px v) (py v))) as S2.
  pose proof (add_near m Hm (sub m (px v) (py v)) (pz v)) as S3.
  pose proof (sub_near m Hm (pz v) (add m (px v) (py v))) as S4.
  pose proof (add_near m Hm (px v) (pz v)) as S5. pose proof (sub_near m Hm (px v) (pz v)) as S6.
  pose proof (add_near m Hm (py v) (pz v)) as S7. pose proof (sub_near m Hm (py v) (pz v)) as S8.
  unfold combination. destruct v as [x y z].
  cbn in H. cbn [px py pz] in *.
  set (s := add m x y) in *. set (d := sub m x y) in *.
  unfold direction, directions, dot, pt in *.
  assert (Abs : forall t, - t <= Rabs t /\ t <= Rabs t /\ 0 <= Rabs t).
  { intro t. pose proof (Rle_abs t). pose proof (Rle_abs (- t)) as N. rewrite Rabs_Ropp in N.
    pose proof (Rabs_pos t). lra. }
  repeat (destruct H as [<- | H]); [.. | destruct H]; cbn [nth map px py pz] in A |- *;
    rewrite ?Rmult_1_l, ?Rmult_0_l, ?Rabs_R0 in A;
    replace (-1 * x) with (- x) in * by ring; replace (-1 * y) with (- y) in * by ring;
    replace (-1 * z) with (- z) in * by ring; rewrite ?Rabs_Ropp in A;
    destruct (Abs x) as (X1 & X2 & X3); destruct (Abs y) as (Y1 & Y2 & Y3);
    destruct (Abs z) as (Z1 & Z2 & Z3); clear Abs.
  all: try (apply Rabs_le; unfold u; lra).
  all: first
    [ assert (B : Rabs (x + y) <= k) by (apply Rabs_le; lra);
      apply Rabs_le_inv in S; apply Rabs_le; unfold u in *; lra
    | assert (B : Rabs (x - y) <= k) by (apply Rabs_le; lra);
      apply Rabs_le_inv in D; apply Rabs_le; unfold u in *; lra
    | assert (B : Rabs (x + z) <= k) by (apply Rabs_le; lra);
      apply Rabs_le_inv in S5; apply Rabs_le; unfold u in *; lra
    | assert (B : Rabs (x - z) <= k) by (apply Rabs_le; lra);
      apply Rabs_le_inv in S6; apply Rabs_le; unfold u in *; lra
    | assert (B : Rabs (y + z) <= k) by (apply Rabs_le; lra);
      apply Rabs_le_inv in S7; apply Rabs_le; unfold u in *; lra
    | assert (B : Rabs (y - z) <= k) by (apply Rabs_le; lra);
      apply Rabs_le_inv in S8; apply Rabs_le; unfold u in *; lra
    | assert (B : Rabs (x + y) <= k) by (apply Rabs_le; lra);
      apply Rabs_le_inv in S;
      assert (B' : Rabs (s + z) <= 1.001 * k + 8 * tiny) by (apply Rabs_le; unfold u in *; lra);
      apply Rabs_le_inv in S1; apply Rabs_le; unfold u in *; lra
    | assert (B : Rabs (x + y) <= k) by (apply Rabs_le; lra);
      apply Rabs_le_inv in S;
      assert (B' : Rabs (z - s) <= 1.001 * k + 8 * tiny) by (apply Rabs_le; unfold u in *; lra);
      apply Rabs_le_inv in S4; apply Rabs_le; unfold u in *; lra
    | assert (B : Rabs (x - y) <= k) by (apply Rabs_le; lra);
      apply Rabs_le_inv in D;
      assert (B' : Rabs (d + z) <= 1.001 * k + 8 * tiny) by (apply Rabs_le; unfold u in *; lra);
      apply Rabs_le_inv in S3; apply Rabs_le; unfold u in *; lra
    | assert (B : Rabs (x - y) <= k) by (apply Rabs_le; lra);
      apply Rabs_le_inv in D;
      assert (B' : Rabs (z - d) <= 1.001 * k + 8 * tiny) by (apply Rabs_le; unfold u in *; lra);
      apply Rabs_le_inv in S2; apply Rabs_le; unfold u in *; lra ].
Qed.

Lemma axes_near (q r w : point) :
  dot q q = 1 -> norm (minus r q) <= 1.01 * u ->
  Rabs (dot_of m r w - dot q w) <= 4.03 * (u * norm w) + 20 * tiny.
Proof.
  intros Q E. pose proof tiny_value as T. pose proof tiny_small as T'.
  assert (Nq : norm q = 1).
  { unfold norm. replace (square q) with (dot q q) by reflexivity. rewrite Q. apply sqrt_1. }
  pose proof (norm_difference r q) as Nr. rewrite Nq in Nr.
  pose proof (norm_nonneg w) as W. pose proof (norm_nonneg r) as R0.
  pose proof (dot_near m Hm r w) as D. pose proof (dot_change w r q) as C.
  rewrite !(dot_swap w) in C.
  assert (A : norm r * norm w <= 1.0001 * norm w) by (apply Rmult_le_compat_r; unfold u in *; lra).
  assert (B : norm w * norm (minus r q) <= norm w * (1.01 * u)) by (apply Rmult_le_compat_l; lra).
  assert (F : tiny * norm w <= / 1000000000000000000000000000000 * norm w)
    by (apply Rmult_le_compat_r; lra).
  assert (G : tiny * norm r <= tiny * 1.1) by (apply Rmult_le_compat_l; unfold u in *; lra).
  replace (tiny * (2 * (norm r + norm w) + 12)) with (2 * (tiny * norm r) + 2 * (tiny * norm w)
    + 12 * tiny) in D by ring.
  set (rw := norm r * norm w) in *. set (x := dot_of m r w) in *.
  set (y := dot r w) in *. set (z := dot q w) in *.
  set (nw := norm w * norm (minus r q)) in *.
  apply Rabs_le_inv in C, D. clear - A B C D F G T W. unfold u in *. apply Rabs_le. lra.
Qed.

Lemma unit_row (q : matrix) : orthonormal q ->
  norm (row0 q) = 1 /\ norm (row1 q) = 1 /\ norm (row2 q) = 1.
Proof.
  intros (A & B & C & _). unfold norm.
  replace (square (row0 q)) with (dot (row0 q) (row0 q)) by reflexivity.
  replace (square (row1 q)) with (dot (row1 q) (row1 q)) by reflexivity.
  replace (square (row2 q)) with (dot (row2 q) (row2 q)) by reflexivity.
  rewrite A, B, C. repeat split; apply sqrt_1.
Qed.

Lemma along_axes_near (q q32 : matrix) (d : point) :
  orthonormal q -> norm (minus (row0 q32) (row0 q)) <= 1.01 * u ->
  norm (minus (row1 q32) (row1 q)) <= 1.01 * u -> norm (minus (row2 q32) (row2 q)) <= 1.01 * u ->
  norm (minus (along_axes m q32 d) (apply q d)) <= 6.99 * (u * norm d) + 40 * tiny /\
  norm (minus (negated m (along_axes m q32 d)) (opposite (apply q d)))
    <= 8.73 * (u * norm d) + 50 * tiny.
Proof.
  intros O E0 E1 E2. pose proof tiny_value as T. pose proof tiny_small as T'.
  pose proof O as (U0 & U1 & U2 & _). destruct (unit_row q O) as (N0 & N1 & N2).
  pose proof (axes_near _ _ d U0 E0) as A0. pose proof (axes_near _ _ d U1 E1) as A1.
  pose proof (axes_near _ _ d U2 E2) as A2. pose proof (norm_nonneg d) as D.
  pose proof (dot_norms (row0 q) d) as B0. pose proof (dot_norms (row1 q) d) as B1.
  pose proof (dot_norms (row2 q) d) as B2. rewrite N0, N1, N2, Rmult_1_l in *.
  set (e := 4.03 * (u * norm d) + 20 * tiny) in *.
  assert (Pe : 0 <= e) by (unfold e, u; lra). split.
  - apply Rle_trans with (1.73206 * e); [| unfold e, u; lra].
    apply norm_same; [exact Pe | exact A0 | exact A1 | exact A2].
  - assert (Neg : forall x X, Rabs (x - X) <= e -> Rabs X <= norm d ->
      Rabs (sub m 0 x - - X) <= 5.04 * (u * norm d) + 25 * tiny).
    { intros x X A B. pose proof (sub_near m Hm 0 x) as S. replace (0 - x) with (- x) in S by ring.
      rewrite Rabs_Ropp in S. pose proof (Rabs_triang_inv x X) as I.
      apply Rabs_le_inv in S. pose proof A as A'. apply Rabs_le_inv in A'.
      unfold e, u in *. apply Rabs_le. lra. }
    apply Rle_trans with (1.73206 * (5.04 * (u * norm d) + 25 * tiny)); [| unfold u; lra].
    apply norm_same; [unfold u; lra | | |]; now apply Neg.
Qed.

Lemma rounded_vector (x v : point) :
  Rabs (px x - px v) <= u * Rabs (px v) + 4 * tiny -> Rabs (py x - py v) <= u * Rabs (py v) + 4 *
    tiny ->
  Rabs (pz x - pz v) <= u * Rabs (pz v) + 4 * tiny -> norm (minus x v) <= u * norm v + 7 * tiny.
Proof.
  intros A B C. pose proof tiny_value.
  apply Rle_trans with (u * norm v + 1.73206 * (4 * tiny)); [| lra].
  apply norm_shares; try assumption; unfold u; lra.
Qed.

Variables qa qb : matrix.
Variables ta tb oa ob : point.
Variables ra rb : R.
Variables a b : row.
Hypothesis Ra : 0 <= ra.
Hypothesis Rb : 0 <= rb.
Hypothesis Ha : row_of qa ta oa ra a.
Hypothesis Hb : row_of qb tb ob rb b.
Let both : R := share_of ra + share_of rb.
Let gap : point := minus (plus tb ob) (plus ta oa).

Lemma delta_error :
  norm (minus (delta m a b) gap) <= 2.001 * (u * norm gap) + 3.02 * (u * (ra + rb)) + 40 * tiny.
Proof.
  destruct Ha as (_ & Ta & _ & _ & _ & Na & Ea).
  destruct Hb as (_ & Tb & _ & _ & _ & Nb & Eb).
  pose proof tiny_value as T0. pose proof (norm_nonneg gap) as G0.
  set (dt := minus tb ta). set (do := minus ob oa).
  set (do' := minus (row_offset b) (row_offset a)).
  set (st := pt (sub m (px (row_place b)) (px (row_place a)))
    (sub m (py (row_place b)) (py (row_place a))) (sub m (pz (row_place b)) (pz (row_place a)))).
  set (so := pt (sub m (px (row_offset b)) (px (row_offset a)))
    (sub m (py (row_offset b)) (py (row_offset a))) (sub m (pz (row_offset b)) (pz (row_offset
      a)))).
  assert (E1 : norm (minus st dt) <= u * norm dt + 7 * tiny).
  { unfold st, dt. rewrite Ta, Tb.
    apply rounded_vector; unfold minus, pt; cbn [px py pz]; now apply sub_near. }
  assert (E2 : norm (minus so do') <= u * norm do' + 7 * tiny).
  { unfold so, do'. apply rounded_vector; unfold minus, pt; cbn [px py pz]; now apply sub_near. }
  assert (E3 : norm (minus (delta m a b) (plus st so)) <= u * norm (plus st so) + 7 * tiny).
  { unfold delta, st, so.
    apply rounded_vector; unfold plus, pt; cbn [px py pz]; now apply add_near. }
  assert (E4 : norm (minus do' do) <= 1.01 * (u * (ra + rb)) + 4 * tiny).
  { replace (minus do' do)
      with (plus (minus (row_offset b) ob) (opposite (minus (row_offset a) oa)))
      by (unfold do', do, plus, opposite, minus, pt; cbn [px py pz]; f_equal; ring).
    apply Rle_trans with (1 := triangle _ _). rewrite norm_opposite. unfold u in *. lra. }
  assert (N1 : norm do <= ra + rb).
  { unfold do. replace (minus ob oa) with (plus ob (opposite oa))
      by (unfold plus, opposite, minus, pt; cbn [px py pz]; f_equal; ring).
    apply Rle_trans with (1 := triangle _ _). rewrite norm_opposite. lra. }
  assert (N2 : norm dt <= norm gap + (ra + rb)).
  { replace dt with (plus gap (opposite do))
      by (unfold gap, dt, do, plus, opposite, minus, pt; cbn [px py pz]; f_equal; ring).
    apply Rle_trans with (1 := triangle _ _). rewrite norm_opposite. lra. }
  pose proof (norm_difference do' do) as N3.
  assert (E5 : norm (minus (plus st so) gap)
    <= u * norm gap + 3.011 * (u * (ra + rb)) + 19 * tiny).
  { replace (minus (plus st so) gap)
      with (plus (minus st dt) (plus (minus so do') (minus do' do)))
      by (unfold gap, dt, do, plus, minus; cbn [px py pz]; f_equal; ring).
    apply Rle_trans with (1 := triangle _ _).
    pose proof (triangle (minus so do') (minus do' do)). unfold u in *. lra. }
  pose proof (norm_difference (plus st so) gap) as N4.
  replace (minus (delta m a b) gap)
    with (plus (minus (delta m a b) (plus st so)) (minus (plus st so) gap))
    by (unfold plus, minus; cbn [px py pz]; f_equal; ring).
  apply Rle_trans with (1 := triangle _ _). unfold u in *. lra.
Qed.

Lemma delta_near : norm gap <= 1.7321 * both -> norm (minus (delta m a b) gap) <= 6.55 * (u * both).
Proof.
  intro G. pose proof delta_error as D. pose proof tiny_value as T0.
  pose proof (share_value ra Ra) as Sa. pose proof (share_value rb Rb) as Sb.
  pose proof (share_above ra) as Aa. pose proof (share_above rb) as Ab.
  unfold both, u in *. lra.
Qed.

Lemma gaps_near :
  norm gap <= 1.7321 * both ->
  norm (minus (gap_a m a b) (apply qa gap)) <= 22 * (u * both) /\
  norm (minus (gap_b m a b) (apply qb (opposite gap))) <= 22 * (u * both).
Proof.
  intro G. pose proof (delta_near G) as D.
  destruct Ha as (Oa & _ & A0 & A1 & A2 & _). destruct Hb as (Ob & _ & B0 & B1 & B2 & _).
  pose proof tiny_value as T0.
  pose proof (share_value ra Ra) as Sa. pose proof (share_value rb Rb) as Sb.
  pose proof (norm_difference (delta m a b) gap) as N. set (d := delta m a b) in *.
  assert (Nd : norm d <= 1.7322 * both) by (unfold both, u in *; lra).
  assert (T : tiny <= / 1000 * (u * both)) by (unfold both, u in *; lra).
  pose proof (along_axes_near qa _ d Oa A0 A1 A2) as [La _].
  pose proof (along_axes_near qb _ d Ob B0 B1 B2) as [_ Lb].
  split.
  - pose proof (apply_keeps_norm qa (minus d gap) Oa) as K. rewrite <- K in D.
    replace (apply qa (minus d gap)) with (minus (apply qa d) (apply qa gap)) in D
      by (unfold apply, minus, dot, pt; cbn [px py pz]; f_equal; ring).
    unfold gap_a. fold d.
    replace (minus (along_axes m (row_axes a) d) (apply qa gap))
      with (plus (minus (along_axes m (row_axes a) d) (apply qa d)) (minus (apply qa d) (apply qa
        gap)))
      by (unfold plus, minus; cbn [px py pz]; f_equal; ring).
    apply Rle_trans with (1 := triangle _ _). unfold u in *. lra.
  - pose proof (apply_keeps_norm qb (minus gap d) Ob) as K.
    assert (D' : norm (minus gap d) <= 6.55 * (u * both)).
    { apply Rle_trans with (2 := D). apply Req_le. unfold norm, square, minus. cbn [px py pz].
      f_equal. ring. }
    rewrite <- K in D'.
    replace (apply qb (minus gap d))
      with (minus (opposite (apply qb d)) (apply qb (opposite gap))) in D'
      by (unfold apply, opposite, minus, dot, pt; cbn [px py pz]; f_equal; ring).
    unfold gap_b. fold d.
    replace (minus (negated m (along_axes m (row_axes b) d)) (apply qb (opposite gap)))
      with (plus (minus (negated m (along_axes m (row_axes b) d)) (opposite (apply qb d)))
        (minus (opposite (apply qb d)) (apply qb (opposite gap))))
      by (unfold plus, minus; cbn [px py pz]; f_equal; ring).
    apply Rle_trans with (1 := triangle _ _). unfold u in *. lra.
Qed.

(* An entry of the turn, and a line of it as the axis that it stands for. *)
Lemma entry_near (p q r s : point) :
  norm q = 1 -> norm s = 1 -> norm (minus p q) <= 1.01 * u -> norm (minus r s) <= 1.01 * u ->
  Rabs (dot_of m p r - dot q s) <= 5.06 * u.
Proof.
  intros Q S P R. pose proof tiny_value as T. pose proof tiny_small as T'.
  pose proof (norm_difference p q) as Np. pose proof (norm_difference r s) as Nr.
  pose proof (norm_nonneg p). pose proof (norm_nonneg r).
  pose proof (dot_near m Hm p r) as D. pose proof (dot_change p r s) as C.
  pose proof (dot_change s p q) as C'. rewrite !(dot_swap s) in C'. rewrite S in C'.
  assert (A : norm p * norm r <= 1.0001 * 1.0001)
    by (apply Rmult_le_compat; unfold u in *; lra).
  assert (B : norm p * norm (minus r s) <= 1.0001 * (1.01 * u))
    by (apply Rmult_le_compat; try apply norm_nonneg; unfold u in *; lra).
  assert (F : tiny * (2 * (norm p + norm r) + 12) <= tiny * 17)
    by (apply Rmult_le_compat_l; unfold u in *; lra).
  set (rw := norm p * norm r) in *. set (x := dot_of m p r) in *.
  set (y := dot p r) in *. set (z := dot q s) in *. set (w := dot p s) in *.
  set (nw := norm p * norm (minus r s)) in *. set (f := tiny * _) in *.
  apply Rabs_le_inv in C, C', D. clear - A B C C' D F T T' P. unfold u in *. apply Rabs_le. lra.
Qed.

Definition lines_near (t q p : matrix) : Prop :=
  norm (minus (row0 t) (apply q (row0 p))) <= 8.77 * u /\
  norm (minus (row1 t) (apply q (row1 p))) <= 8.77 * u /\
  norm (minus (row2 t) (apply q (row2 p))) <= 8.77 * u.

Lemma turn_near :
  lines_near (transposed (turn m a b)) qa qb /\ lines_near (turn m a b) qb qa.
Proof.
  destruct Ha as (Oa & _ & A0 & A1 & A2 & _). destruct Hb as (Ob & _ & B0 & B1 & B2 & _).
  destruct (unit_row qa Oa) as (U0 & U1 & U2). destruct (unit_row qb Ob) as (V0 & V1 & V2).
  assert (K : 1.73206 * (5.06 * u) <= 8.77 * u) by (unfold u; lra).
  assert (P : 0 <= 5.06 * u) by (unfold u; lra).
  split; repeat split; (apply Rle_trans with (2 := K); apply norm_same; [exact P | | |]);
    unfold turn, transposed, apply, pt; cbn [row0 row1 row2 px py pz];
    try (now apply entry_near);
    match goal with |- Rabs (_ - dot ?x ?y) <= _ => rewrite (dot_swap x y) end;
    now apply entry_near.
Qed.
End Pair.
