(* Theorem Q (4): the support of posed bodies, from slabs by multipliers in f64, is no less than e . y
   for each point y of the mesh but for 80 roundings. With gradual underflow. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Ieee Shows Outward.
From Sdop Require Import Finder Duality Vectors Norms64 OrDopPose Query InBody QueryBody.
Open Scope R_scope.

Local Notation g := gradual64.

(* src/posed/mod.rs: QueryShape::support. The sizes along the basis are sorted; `own` are the ends
   that single axes face, `pair` and `all` those of sums, and `bent` has the last axis reversed. *)
Record facing := { own_a : R; own_b : R; own_c : R; pair_ab : R; pair_ac : R; pair_bc : R;
                   all_abc : R; bent_abc : R }.
Definition half (x : R) : R := mul64 g (/ 2) x.
Definition sum_of_parts (l h m i n j : R) : R :=
  add64 g (add64 g (mul64 g l h) (mul64 g m i)) (mul64 g n j).
Definition support64 (k : kind) (f : facing) (high median low : R) : R :=
  match k with
  | K6 => sum_of_parts high (own_a f) median (own_b f) low (own_c f)
  | K14 => sum_of_parts (half (add64 g median low)) (all_abc f) (half (sub64 g median low)) (bent_abc f)
      (sub64 g high median) (own_a f)
  | K18 =>
    if Rlt_bool (add64 g median low) high then
      sum_of_parts low (pair_ac f) median (pair_ab f)
        (Rmax (sub64 g (sub64 g high median) low) 0) (own_a f)
    else
      sum_of_parts (half (add64 g (sub64 g high low) median)) (pair_ab f)
        (half (add64 g (sub64 g high median) low)) (pair_ac f)
        (Rmax (half (add64 g (sub64 g median high) low)) 0) (pair_bc f)
  | K26 => sum_of_parts low (all_abc f) (sub64 g median low) (pair_ab f) (sub64 g high median) (own_a f)
  end.

(* A part of the sum, whose multiplier is near an exact one. *)
Lemma part_covers (l L d h q B : R) :
  0 <= l -> Rabs (l - L) <= d -> q <= h -> Rabs h <= B -> Rabs q <= B ->
  L * q - d * B - v * (l * B) - tiny64 <= mul64 g l h /\ Rabs (mul64 g l h) <= 1.001 * (l * B) + tiny64.
Proof.
  intros Pl D Q H Bq. pose proof v_value as V. unfold mul64. rewrite !read64_is.
  pose proof (rounded64 (l * h)) as E. rewrite Rabs_mult, (Rabs_pos_eq l Pl) in E.
  assert (LB : l * Rabs h <= l * B) by (now apply Rmult_le_compat_l).
  assert (PB : 0 <= l * Rabs h) by (apply Rmult_le_pos; [exact Pl | apply Rabs_pos]).
  assert (VL : v * (l * Rabs h) <= v * (l * B)) by (apply Rmult_le_compat_l; lra).
  pose proof (Rabs_triang_inv (fl64 g (l * h)) (l * h)) as T. rewrite (Rabs_mult l), (Rabs_pos_eq l Pl) in T.
  apply Rabs_le_inv in E. split.
  - assert (l * q <= l * h) by (now apply Rmult_le_compat_l).
    assert (K : Rabs ((l - L) * q) <= d * B).
    { rewrite Rabs_mult. apply Rmult_le_compat; try apply Rabs_pos; assumption. }
    apply Rabs_le_inv in K. lra.
  - assert (G : Rabs (fl64 g (l * h) - l * h) <= v * (l * Rabs h) + tiny64) by (apply Rabs_le; lra).
    assert (v * (l * B) <= 0.001 * (l * B)) by (apply Rmult_le_compat_r; unfold v; lra). lra.
Qed.

Section Parts.
Variables top B : R.
Hypothesis Top : 0 <= top.
Hypothesis PB : 0 <= B.
Definition bounded (x : R) : Prop := Rabs x <= B.

Lemma three_parts (l L h i m M n N j x y z : R) :
  0 <= l <= 1.01 * top -> 0 <= m <= 1.01 * top -> 0 <= n <= 1.01 * top ->
  Rabs (l - L) <= 4 * (v * top) + 4 * tiny64 -> Rabs (m - M) <= 4 * (v * top) + 4 * tiny64 ->
  Rabs (n - N) <= 4 * (v * top) + 4 * tiny64 ->
  x <= h -> y <= i -> z <= j -> bounded h -> bounded i -> bounded j -> bounded x -> bounded y ->
  bounded z ->
  L * x + M * y + N * z - 25 * (v * top * B) - 13 * (tiny64 * B) - 10 * tiny64
    <= sum_of_parts l h m i n j.
Proof.
  intros Hl Hm Hn Dl Dm Dn X Y Z Bh Bi Bj Bx By Bz. pose proof v_value as V.
  pose proof (proj1 tiny64_value) as T0.
  destruct (part_covers l L _ h x B (proj1 Hl) Dl X Bh Bx) as (C1 & A1).
  destruct (part_covers m M _ i y B (proj1 Hm) Dm Y Bi By) as (C2 & A2).
  destruct (part_covers n N _ j z B (proj1 Hn) Dn Z Bj Bz) as (C3 & A3).
  unfold sum_of_parts. set (s := mul64 g l h) in *. set (t := mul64 g m i) in *.
  set (w := mul64 g n j) in *. unfold add64. rewrite !read64_is.
  pose proof (rounded64 (s + t)) as E1. set (st := fl64 g (s + t)) in *.
  pose proof (rounded64 (st + w)) as E2. set (all := fl64 g (st + w)) in *.
  pose proof (Rabs_triang s t) as T1. pose proof (Rabs_triang st w) as T2.
  pose proof (Rabs_triang_inv st (s + t)) as T3.
  set (hb := top * B). assert (Phb : 0 <= hb) by (apply Rmult_le_pos; lra).
  assert (Each : forall k, 0 <= k <= 1.01 * top -> k * B <= 1.01 * hb).
  { intros k (_ & K). unfold hb. rewrite <- Rmult_assoc. apply Rmult_le_compat_r; lra. }
  pose proof (Each l Hl) as Lb. pose proof (Each m Hm) as Mb. pose proof (Each n Hn) as Nb.
  set (lb := l * B) in *. set (mb := m * B) in *. set (nb := n * B) in *.
  assert (0 <= tiny64 * B) by (apply Rmult_le_pos; lra).
  assert (S1 : Rabs (s + t) <= 2.03 * hb + 2 * tiny64) by lra.
  assert (S0 : v * Rabs (s + t) <= 0.001 * Rabs (s + t))
    by (apply Rmult_le_compat_r; [apply Rabs_pos | unfold v; lra]).
  assert (S2 : Rabs (st + w) <= 3.1 * hb + 5 * tiny64) by lra.
  apply (Rmult_le_compat_l v) in S1; [| lra]. apply (Rmult_le_compat_l v) in S2; [| lra].
  apply (Rmult_le_compat_l v) in Lb; [| lra]. apply (Rmult_le_compat_l v) in Mb; [| lra].
  apply (Rmult_le_compat_l v) in Nb; [| lra].
  assert (v * tiny64 <= 0.01 * tiny64) by (apply Rmult_le_compat_r; unfold v; lra).
  apply Rabs_le_inv in E1, E2.
  replace (v * top * B) with (v * hb) by (unfold hb; ring).
  replace ((4 * (v * top) + 4 * tiny64) * B) with (4 * (v * hb) + 4 * (tiny64 * B)) in *
    by (unfold hb; ring).
  assert (0 <= v * hb) by (apply Rmult_le_pos; lra). lra.
Qed.
End Parts.

Section Sorted.
(* The sizes, and the point's coordinates in the same order, each signed as the direction's. *)
Variables high median low p q r B : R.
Hypothesis Order : 0 <= low <= median /\ median <= high.
Hypothesis Formats : format64 high /\ format64 median /\ format64 low.
Hypothesis PB : 0 <= B.

(* What the ends of the slabs say of the point. *)
Definition faces (k : kind) (f : facing) : Prop :=
  let holds x h := x <= h /\ bounded B h /\ bounded B x in
  (k = K6 -> holds q (own_b f) /\ holds r (own_c f)) /\ holds p (own_a f) /\
  (k = K14 -> holds (p + q + r) (all_abc f) /\ holds (p + q - r) (bent_abc f)) /\
  (k = K18 -> holds (p + q) (pair_ab f) /\ holds (p + r) (pair_ac f) /\ holds (q + r) (pair_bc f)) /\
  (k = K26 -> holds (p + q + r) (all_abc f) /\ holds (p + q) (pair_ab f)).

Lemma half_near (x X e : R) :
  Rabs (x - X) <= e -> Rabs (half x - X / 2) <= v * Rabs X / 2 + 0.51 * e + tiny64.
Proof.
  intro E. pose proof v_value as V. unfold half, mul64. rewrite !read64_is.
  pose proof (rounded64 (/ 2 * x)) as R. pose proof (Rabs_triang_inv x X) as T.
  rewrite Rabs_mult, (Rabs_pos_eq (/ 2)) in R by lra.
  apply Rabs_le_inv in R. pose proof E as E'. apply Rabs_le_inv in E'.
  assert (v * Rabs x <= v * (Rabs X + e)) by (apply Rmult_le_compat_l; lra).
  assert (0 <= e) by (pose proof (Rabs_pos (x - X)); lra).
  assert (v * e <= 0.01 * e) by (apply Rmult_le_compat_r; unfold v; lra).
  apply Rabs_le. lra.
Qed.

Lemma half_positive (x : R) : 0 <= x -> 0 <= half x.
Proof. intro H. apply mul_positive; lra. Qed.

Lemma sub_positive (x y : R) : y <= x -> 0 <= sub64 g x y.
Proof. intro H. unfold sub64. rewrite !read64_is. apply fl64_nonneg. lra. Qed.

Lemma sum_near (x y X Y d : R) :
  Rabs (x - X) + Rabs (y - Y) <= d -> Rabs (add64 g x y - (X + Y)) <= v * Rabs (X + Y) + 1.01 * d + tiny64.
Proof.
  intro D. pose proof v_value as V. unfold add64. rewrite !read64_is. pose proof (rounded64 (x + y)) as R.
  assert (E : Rabs (x + y - (X + Y)) <= d).
  { replace (x + y - (X + Y)) with ((x - X) + (y - Y)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). exact D. }
  pose proof (Rabs_triang_inv (x + y) (X + Y)) as T.
  assert (0 <= d) by (pose proof (Rabs_pos (x - X)); pose proof (Rabs_pos (y - Y)); lra).
  assert (v * Rabs (x + y) <= v * (Rabs (X + Y) + d)) by (apply Rmult_le_compat_l; lra).
  assert (v * d <= 0.01 * d) by (apply Rmult_le_compat_r; unfold v; lra).
  replace (fl64 g (x + y) - (X + Y)) with ((fl64 g (x + y) - (x + y)) + (x + y - (X + Y))) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.

(* Clipped at 0, near a number that is hardly below 0. *)
Lemma clipped_near (x X d : R) : Rabs (x - X) <= d -> - d <= X -> Rabs (Rmax x 0 - X) <= d.
Proof.
  intros D L. apply Rabs_le_inv in D. apply Rabs_le. unfold Rmax. destruct Rle_dec; lra.
Qed.

Theorem support_covers (k : kind) (f : facing) :
  faces k f ->
  high * p + median * q + low * r - 25 * (v * high * B) - 14 * (tiny64 * B) - 10 * tiny64
    <= support64 k f high median low.
Proof.
  intros (F6 & (Pa & Ba & Bp) & F14 & F18 & F26). destruct Order as ((L0 & L1) & L2).
  destruct Formats as (Fh & Fm & Fl). pose proof v_value as V. pose proof (proj1 tiny64_value) as T0.
  set (top := high + 100 * tiny64).
  assert (Vh : 0 <= v * high <= 0.001 * high).
  { split; [apply Rmult_le_pos; lra | apply Rmult_le_compat_r; unfold v; lra]. }
  assert (Vt : v * high <= v * top) by (apply Rmult_le_compat_l; unfold top; lra).
  assert (Top : 0 <= top /\ high <= top) by (unfold top; lra). destruct Top as (Pt & Ht).
  assert (TB : 0 <= tiny64 * B) by (apply Rmult_le_pos; lra).
  assert (End : forall e s, e - 25 * (v * top * B) - 13 * (tiny64 * B) - 10 * tiny64 <= s ->
    e - 25 * (v * high * B) - 14 * (tiny64 * B) - 10 * tiny64 <= s).
  { intros e s H. apply Rle_trans with (2 := H). unfold top.
    replace (v * (high + 100 * tiny64) * B) with (v * high * B + 100 * v * (tiny64 * B)) by ring.
    assert (100 * v * (tiny64 * B) <= / 1000 * (tiny64 * B))
      by (apply Rmult_le_compat_r; [exact TB | unfold v; lra]). lra. }
  assert (Vm : 0 <= v * median <= v * high) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_l]; lra).
  assert (Vl : 0 <= v * low <= v * median) by (split; [apply Rmult_le_pos | apply Rmult_le_compat_l]; lra).
  assert (Zero : forall x, Rabs (x - x) <= 4 * (v * top) + 4 * tiny64).
  { intro x. rewrite Rminus_diag_eq, Rabs_R0 by reflexivity. lra. }
  assert (Diff : forall x y, format64 x -> format64 y -> 0 <= y <= x -> x <= high ->
    0 <= sub64 g x y /\ Rabs (sub64 g x y - (x - y)) <= v * high).
  { intros x y Fx Fy H H'. split; [apply sub_positive; lra |].
    apply Rle_trans with (1 := sub64_share _ _ Fx Fy). rewrite Rabs_pos_eq by lra.
    apply Rmult_le_compat_l; lra. }
  assert (Most : forall x X, Rabs (x - X) <= 4 * (v * high) + 4 * tiny64 -> X <= high -> x <= 1.01 * top).
  { intros x X D H. apply Rabs_le_inv in D. unfold top. lra. }
  set (bound := 4 * (v * high) + 4 * tiny64) in Most.
  destruct (Diff high median Fh Fm ltac:(lra) ltac:(lra)) as (P1 & D1).
  destruct (Diff median low Fm Fl ltac:(lra) ltac:(lra)) as (P2 & D2).
  destruct (Diff high low Fh Fl ltac:(lra) ltac:(lra)) as (P3 & D3).
  assert (Sml : 0 <= add64 g median low /\
    Rabs (add64 g median low - (median + low)) <= 2 * (v * high)).
  { split; [apply add_positive; lra |]. apply Rle_trans with (1 := add64_share _ _ Fm Fl).
    rewrite Rabs_pos_eq by lra. rewrite Rmult_plus_distr_l. lra. }
  destruct Sml as (P4 & D4). apply End. clear End.
  destruct k; unfold support64.
  - destruct (F6 eq_refl) as ((Q1 & Q2 & Q3) & R1 & R2 & R3).
    apply three_parts; try assumption; try lra; apply Zero.
  - destruct (F14 eq_refl) as ((Q1 & Q2 & Q3) & R1 & R2 & R3).
    pose proof (half_near _ _ _ D4) as H4. pose proof (half_near _ _ _ D2) as H2.
    rewrite (Rabs_pos_eq (median + low)) in H4 by lra.
    rewrite (Rabs_pos_eq (median - low)) in H2 by lra.
    pose proof (half_positive _ P4) as P5. pose proof (half_positive _ P2) as P6.
    replace (high * p + median * q + low * r) with ((median + low) / 2 * (p + q + r)
      + (median - low) / 2 * (p + q - r) + (high - median) * p) by field.
    apply three_parts; try assumption; try lra.
    + split; [exact P5 |]. apply (Most _ _ (Rle_trans _ _ bound H4 ltac:(unfold bound; lra))). lra.
    + split; [exact P6 |]. apply (Most _ _ (Rle_trans _ _ bound H2 ltac:(unfold bound; lra))). lra.
    + split; [exact P1 |]. apply (Most _ _ (Rle_trans _ _ bound D1 ltac:(unfold bound; lra))). lra.
  - destruct (F18 eq_refl) as ((Q1 & Q2 & Q3) & (R1 & R2 & R3) & S1 & S2 & S3).
    case Rlt_bool_spec; intro C.
    + apply Rabs_le_inv in D4.
      assert (Ex : Rabs (Rmax (sub64 g (sub64 g high median) low) 0 - (high - median - low))
        <= 2.1 * (v * high) + tiny64).
      { apply clipped_near; [| lra].
        rewrite sub64_as_add.
        replace (high - median - low) with ((high - median) + - low) by ring.
        apply Rle_trans with (v * Rabs (high - median + - low) + 1.01 * (v * high) + tiny64).
        - apply sum_near. rewrite (Rminus_diag_eq (- low)), Rabs_R0 by reflexivity. lra.
        - assert (Rabs (high - median + - low) <= high) by (apply Rabs_le; lra).
          assert (v * Rabs (high - median + - low) <= v * high) by (apply Rmult_le_compat_l; lra). lra. }
      replace (high * p + median * q + low * r) with (low * (p + r) + median * (p + q)
        + (high - median - low) * p) by ring.
      apply three_parts; try assumption; try lra; try apply Zero.
      split; [apply Rmax_r |]. apply (Most _ _ (Rle_trans _ _ bound Ex ltac:(unfold bound; lra))). lra.
    + apply Rabs_le_inv in D4.
      assert (E1 : Rabs (add64 g (sub64 g high low) median - (high - low + median))
        <= 3.1 * (v * high) + tiny64).
      { apply Rle_trans with (v * Rabs (high - low + median) + 1.01 * (v * high) + tiny64).
        - apply sum_near. rewrite (Rminus_diag_eq median), Rabs_R0 by reflexivity. lra.
        - assert (Rabs (high - low + median) <= 2 * high) by (apply Rabs_le; lra).
          assert (v * Rabs (high - low + median) <= v * (2 * high)) by (apply Rmult_le_compat_l; lra). lra. }
      assert (E2 : Rabs (add64 g (sub64 g high median) low - (high - median + low))
        <= 3.1 * (v * high) + tiny64).
      { apply Rle_trans with (v * Rabs (high - median + low) + 1.01 * (v * high) + tiny64).
        - apply sum_near. rewrite (Rminus_diag_eq low), Rabs_R0 by reflexivity. lra.
        - assert (Rabs (high - median + low) <= 2 * high) by (apply Rabs_le; lra).
          assert (v * Rabs (high - median + low) <= v * (2 * high)) by (apply Rmult_le_compat_l; lra). lra. }
      assert (E3 : Rabs (add64 g (sub64 g median high) low - (median - high + low))
        <= 2.1 * (v * high) + tiny64).
      { apply Rle_trans with (v * Rabs (median - high + low) + 1.01 * (v * high) + tiny64).
        - apply sum_near. rewrite (Rminus_diag_eq low), Rabs_R0 by reflexivity.
          pose proof (sub64_share _ _ Fm Fh) as K. rewrite (Rabs_left1 (median - high)) in K by lra.
          assert (v * - (median - high) <= v * high) by (apply Rmult_le_compat_l; lra). lra.
        - assert (Rabs (median - high + low) <= high) by (apply Rabs_le; lra).
          assert (v * Rabs (median - high + low) <= v * high) by (apply Rmult_le_compat_l; lra). lra. }
      pose proof (half_near _ _ _ E1) as H1. pose proof (half_near _ _ _ E2) as H2.
      pose proof (half_near _ _ _ E3) as H3.
      assert (A1 : v * Rabs (high - low + median) <= 2 * (v * high)).
      { rewrite Rabs_pos_eq by lra. rewrite Rmult_plus_distr_l, Rmult_minus_distr_l. lra. }
      assert (A2 : v * Rabs (high - median + low) <= v * high).
      { rewrite Rabs_pos_eq by lra. rewrite Rmult_plus_distr_l, Rmult_minus_distr_l. lra. }
      assert (A3 : v * Rabs (median - high + low) <= v * high).
      { apply Rmult_le_compat_l; [lra |]. apply Rabs_le. lra. }
      replace (high * p + median * q + low * r) with ((high - low + median) / 2 * (p + q)
        + (high - median + low) / 2 * (p + r) + (median - high + low) / 2 * (q + r)) by field.
      assert (H3' : Rabs (Rmax (half (add64 g (sub64 g median high) low)) 0 - (median - high + low) / 2)
        <= 2 * (v * high) + 2 * tiny64) by (apply clipped_near; lra).
      apply three_parts; try assumption; try lra.
      * split; [apply half_positive, add_positive; lra |].
        apply (Most _ _ (Rle_trans _ _ bound H1 ltac:(unfold bound; lra))). lra.
      * split; [apply half_positive, add_positive; lra |].
        apply (Most _ _ (Rle_trans _ _ bound H2 ltac:(unfold bound; lra))). lra.
      * split; [apply Rmax_r |]. apply (Most _ _ (Rle_trans _ _ bound H3' ltac:(unfold bound; lra))). lra.
  - destruct (F26 eq_refl) as ((Q1 & Q2 & Q3) & R1 & R2 & R3).
    replace (high * p + median * q + low * r) with (low * (p + q + r)
      + (median - low) * (p + q) + (high - median) * p) by ring.
    apply three_parts; try assumption; try lra; try apply Zero.
    + split; [exact P2 |]. apply (Most _ _ (Rle_trans _ _ bound D2 ltac:(unfold bound; lra))). lra.
    + split; [exact P1 |]. apply (Most _ _ (Rle_trans _ _ bound D1 ltac:(unfold bound; lra))). lra.
Qed.
End Sorted.
