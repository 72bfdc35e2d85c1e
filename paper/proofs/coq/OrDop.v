(* Theorems N and E: or-DOPs that the code's test rejects have no point in common. From the posed
   axes and offsets, once rounded, to the comparison. Any underflow is included. *)
From Coq Require Import Reals Bool List Lra.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Pose Duality Vectors Rounded SupportParts SupportRounded.
From Sdop Require Import Separated OrDopTest.
Import ListNotations.
Open Scope R_scope.

Lemma members_all (k : kind) (member : nat) : In member (members k) -> In member (members K26).
Proof. destruct k; cbn; tauto. Qed.

(* One axis, for either body as the one whose coordinates it is in. *)
Section Axis.
Variable m : mode.
Hypothesis Hm : valid m.
Variable k : kind.
Variables qa qb : matrix.
Hypothesis Oa : orthonormal qa.
Hypothesis Ob : orthonormal qb.
Variables gap y z : point.
Hypothesis Meet : combined qa y = plus gap (combined qb z).
Variables ra rb : R.
Hypothesis Ra : 0 <= ra.
Hypothesis Rb : 0 <= rb.
Variables own other : slabs.
Hypothesis Ny : norm y <= 1.7321 * ra.
Hypothesis Nz : norm z <= 1.7321 * rb.
Hypothesis Hy : holds_with (margin_of ra) k own y.
Hypothesis Hz : holds_with (margin_of rb) k other z.
Variables lines : matrix.
Hypothesis Near : lines_near lines qa qb.
Variable gap32 : point.
Hypothesis Gap : norm (minus gap32 (apply qa gap)) <= 22 * (u * (share_of ra + share_of rb)).

Definition sign (negative : bool) : R := if negative then -1 else 1.

Lemma sign_cases (negative : bool) : sign negative = 1 \/ sign negative = -1.
Proof. destruct negative; [now right | now left]. Qed.

Lemma back_norm (t : R) (v : point) : t = 1 \/ t = -1 -> norm (scaled (- t) v) = norm v.
Proof.
  intros [-> | ->]; unfold norm, square, scaled, pt; cbn [px py pz]; f_equal; ring.
Qed.

Lemma sign_abs (negative : bool) (t : R) : sign_of negative t -> Rabs t = sign negative * t.
Proof.
  destruct negative; cbn; intro H; [rewrite Rabs_left1 by exact H | rewrite Rabs_pos_eq by exact H];
    lra.
Qed.

Lemma flipped_is (negative : bool) (v : point) : flipped negative v = scaled (sign negative) v.
Proof.
  destruct negative, v as [i j l]; unfold flipped, sign, opposite, scaled, pt; cbn [px py pz];
    f_equal; ring.
Qed.

Lemma flipped_norm (negative : bool) (v : point) : norm (flipped negative v) = norm v.
Proof. destruct negative; [apply norm_opposite | reflexivity]. Qed.

Lemma mirrored_holds (margin : R) (s : slabs) (x : point) :
  holds_with margin k s x -> holds_with margin k (mirrored s) (opposite x).
Proof.
  intros H d Hd. destruct (H d Hd) as (A & B & C & D). unfold mirrored. cbn [fst snd].
  assert (E : dot (direction d) (opposite x) = - dot (direction d) x)
    by (unfold dot, opposite, pt; cbn [px py pz]; ring).
  rewrite E. repeat split; try assumption; lra.
Qed.

Lemma line_dot (c b v : point) :
  dot b b = 1 -> norm (minus c (apply qa b)) <= 8.77 * u ->
  norm c <= 1.0001 /\ Rabs (dot c v - dot b (combined qa v)) <= 8.77 * (u * norm v).
Proof.
  intros U H.
  assert (N : norm (apply qa b) = 1).
  { rewrite apply_keeps_norm by exact Oa. unfold norm.
    replace (square b) with (dot b b) by reflexivity. rewrite U. apply sqrt_1. }
  pose proof (norm_difference c (apply qa b)) as D. rewrite N in D. split; [unfold u in *; lra |].
  pose proof (dot_change v c (apply qa b)) as C. rewrite !(dot_swap v) in C.
  rewrite (dot_swap (apply qa b) v), <- combined_dot, (dot_swap (combined qa v)) in C.
  apply Rle_trans with (1 := C). pose proof (norm_nonneg v).
  assert (norm v * norm (minus c (apply qa b)) <= norm v * (8.77 * u))
    by (apply Rmult_le_compat_l; assumption). lra.
Qed.

Lemma direction_long (member : nat) : In member (members K26) -> 1 <= norm (direction member).
Proof.
  intro H. rewrite <- sqrt_1. apply sqrt_le_1_alt. unfold square, direction, directions, pt.
  cbn in H. repeat (destruct H as [<- | H]); [.. | destruct H]; cbn [nth map px py pz]; lra.
Qed.

Lemma tiny_near (n : R) : 0.49 <= n -> tiny <= / 1000000000000 * (u * n).
Proof. intro H. pose proof tiny_small. unfold u. lra. Qed.

Lemma projected (e32 a : point) (s : R) :
  s = 1 \/ s = -1 ->
  Rabs (px e32 + s * dot (row0 qb) (combined qa a)) <= 13 * (u * norm a) ->
  Rabs (py e32 + s * dot (row1 qb) (combined qa a)) <= 13 * (u * norm a) ->
  Rabs (pz e32 + s * dot (row2 qb) (combined qa a)) <= 13 * (u * norm a) ->
  norm (minus e32 (scaled (- s) (apply qb (combined qa a)))) <= 22.6 * (u * norm a).
Proof.
  intros S A B C. pose proof (norm_nonneg a).
  apply Rle_trans with (1.73206 * (13 * (u * norm a))); [| unfold u; lra].
  assert (F : forall x t, x - - s * t = x + s * t) by (intros; ring).
  apply norm_same; unfold scaled, apply, pt; cbn [px py pz]; rewrite ?F; try assumption.
  unfold u; lra.
Qed.

Theorem normal_keeps (member : nat) :
  In member (members k) -> ~ normal_separates m k lines gap32 own other member.
Proof.
  intros Hd (negative & signs & St & Se & G). pose proof (members_all k _ Hd) as Hall.
  pose proof (direction_long _ Hall) as Long.
  pose proof (tiny_near (norm (direction member)) ltac:(lra)) as T. pose proof tiny_value as T0.
  set (d := direction member) in *. set (s := sign negative).
  pose proof (sign_cases negative) as Hs. fold s in Hs.
  destruct Near as (L0 & L1 & L2). pose proof Ob as (U0 & U1 & U2 & _).
  assert (Part : forall c b, dot b b = 1 -> norm (minus c (apply qa b)) <= 8.77 * u ->
    Rabs (combination m c member - dot b (combined qa d)) <= 12 * (u * norm d)).
  { intros c b U L. destruct (line_dot c b d U L) as (Nc & D).
    pose proof (combination_near m Hm c member Hall) as C. fold d in C.
    rewrite (dot_swap c d) in D.
    assert (norm d * norm c <= norm d * 1.0001) by (apply Rmult_le_compat_l; lra).
    apply Rabs_le_inv in C, D. apply Rabs_le. unfold u in *. lra. }
  pose proof (Part _ _ U0 L0) as P0. pose proof (Part _ _ U1 L1) as P1.
  pose proof (Part _ _ U2 L2) as P2. clear Part.
  set (e := pt (combination m (row0 lines) member) (combination m (row1 lines) member)
    (combination m (row2 lines) member)) in *.
  set (w := opposite (flipped negative e)).
  assert (W : norm (minus w (scaled (- s) (apply qb (combined qa d)))) <= 22.6 * (u * norm d)).
  { apply projected; [exact Hs | | |]; unfold w; rewrite flipped_is; fold s;
      unfold e, opposite, scaled, pt; cbn [px py pz];
      match goal with |- Rabs (- (s * ?x) + s * ?y) <= _ =>
        replace (- (s * x) + s * y) with (- s * (x - y)) by ring end;
      rewrite Rabs_mult, Rabs_Ropp;
      replace (Rabs s) with 1 by (destruct Hs as [-> | ->]; [now rewrite Rabs_R1
        | rewrite Rabs_left; lra]);
      (apply Rle_trans with (12 * (u * norm d)); [lra | unfold u; lra]). }
  assert (Ne : norm w = norm (flipped negative e)) by apply norm_opposite.
  assert (Size : 0.4 <= norm w).
  { pose proof (norm_difference (scaled (- s) (apply qb (combined qa d))) w) as D.
    replace (norm (minus (scaled (- s) (apply qb (combined qa d))) w))
      with (norm (minus w (scaled (- s) (apply qb (combined qa d))))) in D
      by (unfold norm, square, minus; cbn [px py pz]; f_equal; ring).
    assert (E : norm (scaled (- s) (apply qb (combined qa d))) = norm d).
    { rewrite back_norm by exact Hs. now rewrite apply_keeps_norm, norm_combined. }
    rewrite E in D. unfold u in *. lra. }
  rewrite Ne in Size.
  pose proof (mirrored_holds _ _ _ Hz) as Hz'.
  destruct (one_side m k (mirrored other) signs (flipped negative e) (opposite z) rb Hm Se Rb Hz'
    ltac:(now rewrite norm_opposite) Size) as (B0 & B1).
  assert (A0 : 0 <= end_of own member negative /\
    s * dot d y + margin_of ra * norm d <= end_of own member negative).
  { destruct (Hy member Hd) as (F & F' & P & P'). fold d in F, F'. unfold s, sign, end_of.
    destruct negative; split; lra. }
  pose proof (share_value ra Ra) as Share.
  assert (Ps : 0 <= share_of ra * norm d) by (apply Rmult_le_pos; lra).
  rewrite (not_separated m Hm qa qb Oa Ob gap y z Meet ra rb Ra Rb Ny Nz d gap32 w
    (combination m gap32 member) s) in G; [discriminate | lra | exact Hs | now apply sign_abs
    | exact Gap | | exact W | apply A0 | | exact B0 |].
  - apply Rle_trans with (1 := combination_near m Hm gap32 member Hall). fold d.
    pose proof (norm_nonneg gap32). assert (0 <= tiny * (norm d + norm gap32))
      by (apply Rmult_le_pos; lra). lra.
  - apply Rle_trans with (2 := proj2 A0). unfold margin_of.
    replace (127 * u * share_of ra * norm d) with (127 * (u * (share_of ra * norm d))) by ring.
    unfold u. lra.
  - apply Rle_trans with (2 := B1). rewrite Ne. apply Rplus_le_compat_r. apply Req_le.
    unfold w, dot, opposite, pt. cbn [px py pz]. ring.
Qed.

Theorem edges_keep (t : matrix) (edge_a edge_b : point) :
  lines = transposed t -> ~ edges_separate m k t gap32 own other edge_a edge_b.
Proof.
  intros Lines. unfold edges_separate. set (axis := cross m edge_a _). clearbody axis.
  intros (negative & signs_a & signs_b & St & Sa & Sb & Large & G). rewrite <- Lines in *.
  pose proof tiny_value as T0. pose proof tiny_small as T1.
  assert (Long : 0.49 <= norm axis).
  { destruct (Rle_or_lt 0.49 (norm axis)) as [L | L]; [exact L | exfalso].
    pose proof (norm_nonneg axis) as N. pose proof (dot_near m Hm axis axis) as D.
    replace (dot axis axis) with (norm axis * norm axis) in D by apply norm_square.
    assert (Q : norm axis * norm axis <= 0.49 * 0.49) by (apply Rmult_le_compat; lra).
    assert (F : tiny * (2 * (norm axis + norm axis) + 12) <= tiny * 14)
      by (apply Rmult_le_compat_l; lra).
    unfold greater in Large. revert Large. case Rlt_bool_spec; [intros C _ | discriminate].
    pose proof (read_error m (/ 4)) as E1. pose proof (read_error m (dot_of m axis axis)) as E2.
    apply Rabs_le_inv in E1, E2, D. unfold u in *. lra. }
  pose proof (tiny_near (norm axis) Long) as T.
  set (s := sign negative). pose proof (sign_cases negative) as Hs. fold s in Hs.
  set (towards := flipped negative axis) in *.
  assert (Nt : norm towards = norm axis) by apply flipped_norm.
  destruct Near as (L0 & L1 & L2). pose proof Ob as (U0 & U1 & U2 & _).
  assert (Part : forall c b, dot b b = 1 -> norm (minus c (apply qa b)) <= 8.77 * u ->
    Rabs (sub m 0 (dot_of m c towards) + s * dot b (combined qa axis)) <= 13 * (u * norm axis)).
  { intros c b U L. destruct (line_dot c b towards U L) as (Nc & D).
    assert (E : dot b (combined qa towards) = s * dot b (combined qa axis)).
    { unfold towards. rewrite flipped_is. fold s. unfold dot, combined, scaled, pt.
      cbn [px py pz]. ring. }
    assert (B : Rabs (dot b (combined qa towards)) <= norm axis).
    { apply Rle_trans with (1 := dot_norms _ _). rewrite norm_combined, Nt by exact Oa.
      replace (norm b) with 1; [lra |]. unfold norm.
      replace (square b) with (dot b b) by reflexivity.
      now rewrite U, sqrt_1. }
    rewrite <- E. rewrite Nt in D. pose proof (norm_nonneg c).
    pose proof (dot_near m Hm c towards) as F. rewrite Nt in F.
    assert (C1 : norm c * norm axis <= 1.0001 * norm axis) by (apply Rmult_le_compat_r; lra).
    assert (C2 : tiny * (2 * (norm c + norm axis) + 12) <= tiny * (16 + 2 * norm axis))
      by (apply Rmult_le_compat_l; lra).
    assert (C3 : tiny * norm axis <= / 1000000000000000000000000000000 * norm axis)
      by (apply Rmult_le_compat_r; lra).
    pose proof (sub_near m Hm 0 (dot_of m c towards)) as S.
    replace (0 - dot_of m c towards) with (- dot_of m c towards) in S by ring.
    rewrite Rabs_Ropp in S.
    assert (I : Rabs (dot_of m c towards) <= 1.001 * norm axis).
    { apply Rabs_le_inv in F, D, B. apply Rabs_le. unfold u in *. lra. }
    apply Rabs_le_inv in F, D, S. apply Rabs_le. unfold u in *. lra. }
  set (away := negated m (along_axes m lines towards)) in *.
  assert (W : norm (minus away (scaled (- s) (apply qb (combined qa axis))))
    <= 22.6 * (u * norm axis)).
  { apply projected; [exact Hs | | |]; unfold away, negated, along_axes, pt; cbn [px py pz];
      now apply Part. }
  clear Part.
  assert (Size : 0.4 <= norm away).
  { pose proof (norm_difference (scaled (- s) (apply qb (combined qa axis))) away) as D.
    replace (norm (minus (scaled (- s) (apply qb (combined qa axis))) away))
      with (norm (minus away (scaled (- s) (apply qb (combined qa axis))))) in D
      by (unfold norm, square, minus; cbn [px py pz]; f_equal; ring).
    assert (E : norm (scaled (- s) (apply qb (combined qa axis))) = norm axis).
    { rewrite back_norm by exact Hs. now rewrite apply_keeps_norm, norm_combined. }
    rewrite E in D. unfold u in *. lra. }
  destruct (one_side m k own signs_a towards y ra Hm Sa Ra Hy Ny ltac:(lra)) as (A0 & A1).
  destruct (one_side m k other signs_b away z rb Hm Sb Rb Hz Nz Size) as (B0 & B1).
  rewrite (not_separated m Hm qa qb Oa Ob gap y z Meet ra rb Ra Rb Ny Nz axis gap32 away
    (dot_of m axis gap32) s) in G; [discriminate | exact Long | exact Hs | now apply sign_abs
    | exact Gap | now apply dot_near | exact W | exact A0 | | exact B0 | exact B1].
  apply Rle_trans with (2 := A1). rewrite Nt. apply Rplus_le_compat_r. apply Req_le.
  unfold towards. rewrite flipped_is. fold s. unfold dot, scaled, pt. cbn [px py pz]. ring.
Qed.
End Axis.

(* Rows of two bodies, as exact as one rounding leaves them, and slabs with the code's margin: where
   any axis of the test rejects the pair, no point of one polytope is a point of the other. *)
Theorem rejected_polytopes_disjoint (m : mode) (k : kind) (qa qb : matrix) (ta tb oa ob : point)
    (ra rb : R) (a b : row) (sa sb : slabs) :
  valid m -> 0 <= ra -> 0 <= rb -> row_of qa ta oa ra a -> row_of qb tb ob rb b ->
  ordops_rejected m k a b sa sb ->
  forall y z, norm y <= 1.7321 * ra -> norm z <= 1.7321 * rb ->
    holds_with (margin_of ra) k sa y -> holds_with (margin_of rb) k sb z ->
    plus (plus ta oa) (combined qa y) <> plus (plus tb ob) (combined qb z).
Proof.
  intros Hm Ra Rb Ha Hb Rejected y z Ny Nz Hy Hz E.
  pose proof (proj1 Ha) as Oa. pose proof (proj1 Hb) as Ob.
  set (gap := minus (plus tb ob) (plus ta oa)).
  assert (Coordinates : forall p q : point, px p = px q -> py p = py q -> pz p = pz q -> p = q)
    by (intros [p0 p1 p2] [q0 q1 q2]; cbn; intros -> -> ->; reflexivity).
  assert (X : forall f, f = px \/ f = py \/ f = pz ->
    f (plus (plus ta oa) (combined qa y)) = f (plus (plus tb ob) (combined qb z)))
    by (intros; now rewrite E).
  pose proof (X px ltac:(tauto)) as X0. pose proof (X py ltac:(tauto)) as X1.
  pose proof (X pz ltac:(tauto)) as X2. clear X. unfold plus in X0, X1, X2.
  cbn [px py pz] in X0, X1, X2.
  assert (Meet : combined qa y = plus gap (combined qb z)).
  { apply Coordinates; unfold gap, plus, minus; cbn [px py pz]; lra. }
  assert (Back : combined qb z = plus (opposite gap) (combined qa y)).
  { apply Coordinates; unfold gap, plus, minus, opposite, pt; cbn [px py pz]; lra. }
  pose proof (gap_size qa qb Oa Ob gap y z Meet ra rb Ny Nz) as Size.
  destruct (gaps_near m Hm qa qb ta tb oa ob ra rb a b Ra Rb Ha Hb Size) as (Ga & Gb).
  fold gap in Ga, Gb.
  destruct (turn_near m Hm qa qb ta tb oa ob ra rb a b Ha Hb) as (La & Lb).
  destruct Rejected as [(member & Hd & S) | [(member & Hd & S) | (edge_a & edge_b & S)]]; revert S.
  - now apply (normal_keeps m Hm k qa qb Oa Ob gap y z Meet ra rb).
  - apply (normal_keeps m Hm k qb qa Ob Oa (opposite gap) z y Back rb ra); try assumption.
    rewrite (Rplus_comm (share_of rb)). exact Gb.
  - now apply (edges_keep m Hm k qa qb Oa Ob gap y z Meet ra rb Ra Rb sa sb Ny Nz Hy Hz _ La).
Qed.
