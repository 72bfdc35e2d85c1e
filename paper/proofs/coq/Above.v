(* How much more than the exact support of an or-DOP the computed one can be, with gradual underflow,
   for theorem B: what is too far apart is rejected. *)
From Coq Require Import Reals Bool List Lra.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Pose Ieee Finder Duality Vectors Rounded SupportParts.
From Sdop Require Import Binning.
Import ListNotations.
Open Scope R_scope.

(* The lanes' minima and maxima read every number as it is. *)
Ltac plain_extremes :=
  repeat match goal with
  | |- context [least gradual ?x ?y] => change (least gradual x y) with (Rmin x y)
  | |- context [most gradual ?x ?y] => change (most gradual x y) with (Rmax x y)
  end.

Section Octant.
Variables a b c : R.
Hypothesis Ha : 0 <= a.
Hypothesis Hb : 0 <= b.
Hypothesis Hc : 0 <= c.
(* The largest half width; ends are no larger than the products of it with directions' lengths. *)
Variable w : R.
Hypothesis Hw : 0 <= w.
Let sum := a + b + c.
Let share := u * sum + half_step.
Definition excess_unit : R := u * ((a + b + c) * w) + half_step * (w + 1).
Let unit := excess_unit.

(* A multiplier that is computed as l, at most n units above L. *)
Definition multiplier (n l L : R) : Prop := 0 <= l /\ 0 <= L <= sum /\ l <= L + n * share.
(* A sum that is computed as x, at most n units above X. *)
Definition upto (n k x X : R) : Prop := 0 <= x /\ 0 <= X <= k * (sum * w) /\ x <= X + n * unit.

Lemma units : 0 < half_step /\ 0 <= sum * w /\ 0 <= u * (sum * w) /\ 0 <= half_step * w /\
  half_step <= unit /\ u * (sum * w) <= unit.
Proof.
  pose proof (proj1 half_step_value) as H. assert (S : 0 <= sum * w)
    by (apply Rmult_le_pos; unfold sum; lra).
  assert (0 <= u * (sum * w)) by (apply Rmult_le_pos; unfold u; lra).
  assert (0 <= half_step * w) by (apply Rmult_le_pos; lra).
  unfold unit, excess_unit. fold sum. repeat split; lra.
Qed.

Lemma nearest_upto (n k x X : R) :
  upto n k x X -> 0 <= k <= 40 -> 0 <= n <= 1000 -> upto (n + k + 2) k (nearest32 x) X.
Proof.
  intros (P & (Q0 & Q) & L) K N. pose proof units as (H0 & S & Us & Hs & H1 & H2).
  split; [now apply nearest32_nonneg |]. split; [lra |].
  pose proof (nearest32_above x P) as A.
  assert (B : u * X <= k * (u * (sum * w))).
  { replace (k * (u * (sum * w))) with (u * (k * (sum * w))) by ring.
    apply Rmult_le_compat_l; [unfold u; lra | exact Q]. }
  assert (C : k * (u * (sum * w)) <= k * unit) by (apply Rmult_le_compat_l; lra).
  assert (D : u * (n * unit) <= unit).
  { assert (n * unit <= 1000 * unit) by (apply Rmult_le_compat_r; lra).
    unfold u. assert (0 <= n * unit) by (apply Rmult_le_pos; lra). lra. }
  replace ((n + k + 2) * unit) with (n * unit + k * unit + 2 * unit) by ring.
  assert (u * x <= u * (X + n * unit)) by (apply Rmult_le_compat_l; [unfold u; lra | exact L]).
  lra.
Qed.

Lemma add_upto (n k x X n' k' y Y : R) :
  upto n k x X -> upto n' k' y Y -> 0 <= k -> 0 <= k' -> k + k' <= 40 -> 0 <= n -> 0 <= n' ->
  n + n' <= 1000 -> upto (n + n' + (k + k') + 2) (k + k') (add gradual x y) (X + Y).
Proof.
  intros (P & (Q0 & Q) & L) (P' & (Q0' & Q') & L') K K' KK N N' NN. rewrite gradual_add.
  apply nearest_upto; [| lra | lra]. split; [lra |]. split; [| lra].
  rewrite Rmult_plus_distr_r. lra.
Qed.

Lemma mul_upto (n l L h H : R) :
  multiplier n l L -> 0 <= h <= H -> H <= 1.7321 * w -> 0 <= n <= 100 ->
  upto (1.7321 * n + 1.7321 + 2) 1.7321 (mul gradual l h) (L * H).
Proof.
  intros (P & (Q0 & Q) & M) (h0 & h1) T N. pose proof units as (H0 & S & Us & Hs & H1 & H2).
  rewrite gradual_mul. apply nearest_upto; [| lra | lra].
  assert (Sh : 0 <= share) by (unfold share, sum, u in *; lra).
  split; [now apply Rmult_le_pos |]. split; [split |].
  - apply Rmult_le_pos; lra.
  - replace (1.7321 * (sum * w)) with (sum * (1.7321 * w)) by ring.
    apply Rmult_le_compat; lra.
  - apply Rle_trans with ((L + n * share) * H); [apply Rmult_le_compat; lra |].
    rewrite Rmult_plus_distr_r. apply Rplus_le_compat_l.
    apply Rle_trans with (n * share * (1.7321 * w)).
    + apply Rmult_le_compat_l; [apply Rmult_le_pos; lra | exact T].
    + replace (n * share * (1.7321 * w)) with (1.7321 * n * (share * w)) by ring.
      apply Rmult_le_compat_l; [lra |]. unfold share, unit, excess_unit. fold sum. lra.
Qed.

Lemma upto_more (n k x X n' k' : R) : upto n k x X -> n <= n' -> k <= k' -> upto n' k' x X.
Proof.
  intros (P & (Q0 & Q) & L) N K. pose proof units as (H0 & S & Us & Hs & H1 & H2).
  assert (n * unit <= n' * unit) by (apply Rmult_le_compat_r; lra).
  assert (k * (sum * w) <= k' * (sum * w)) by (apply Rmult_le_compat_r; lra).
  repeat split; lra.
Qed.

Lemma exact_multiplier (x : R) : 0 <= x <= sum -> multiplier 0 x x.
Proof. intro. unfold multiplier. lra. Qed.

Lemma share_positive : 0 < share /\ u * sum <= share /\ half_step <= share.
Proof.
  pose proof (proj1 half_step_value). assert (0 <= u * sum) by (unfold sum, u; lra).
  unfold share. lra.
Qed.

(* A rounded number of a size of about twice the sum or less. *)
Lemma rounded_share (x : R) : Rabs x <= 2 * sum + 8 * share -> Rabs (nearest32 x - x) <= 3 * share.
Proof.
  intro H. pose proof (nearest32_error x) as E. pose proof share_positive as (P & Q & T).
  apply Rle_trans with (1 := E).
  assert (u * Rabs x <= u * (2 * sum + 8 * share)) by (apply Rmult_le_compat_l; [unfold u |]; lra).
  assert (u * (8 * share) <= / 1000 * share) by (unfold u; lra).
  assert (share = u * sum + half_step) by reflexivity. lra.
Qed.

Lemma lead_multiplier (i j l : R) :
  0 <= i <= sum -> 0 <= j <= sum -> 0 <= l <= sum ->
  multiplier 3 (lead_of gradual i j l) (lead i j l).
Proof.
  intros I J L. unfold lead_of, lead. plain_extremes. rewrite gradual_sub.
  pose proof share_positive as (Sh & _ & _).
  assert (R0 : - sum <= i - Rmax j l <= sum) by (unfold Rmax; destruct Rle_dec; lra).
  pose proof (rounded_share (i - Rmax j l) ltac:(apply Rabs_le; lra)) as E.
  apply Rabs_le_inv in E. set (x := i - Rmax j l) in *.
  pose proof (Rmax_l x 0). pose proof (Rmax_r x 0).
  split; [apply Rmax_r |]. split; [split; [lra | apply Rmax_lub; lra] |].
  apply Rmax_lub; lra.
Qed.

Lemma difference_multiplier (x y : R) :
  0 <= y <= x -> x <= sum -> multiplier 3 (sub gradual x y) (x - y).
Proof.
  intros Y X. rewrite gradual_sub. pose proof share_positive as (Sh & _ & _).
  pose proof (rounded_share (x - y) ltac:(apply Rabs_le; lra)) as E. apply Rabs_le_inv in E.
  pose proof (nearest32_nonneg (x - y) ltac:(lra)). unfold multiplier. lra.
Qed.

Lemma half_multiplier (n l L : R) :
  multiplier n l L -> 0 <= n <= 100 -> multiplier (n + 2) (mul gradual (/ 2) l) (/ 2 * L).
Proof.
  intros (P & Q & M) N. rewrite gradual_mul. pose proof share_positive as (Sh & S1 & S2).
  pose proof (nearest32_above (/ 2 * l) ltac:(lra)) as E.
  assert (0 <= n * share <= 100 * share)
    by (split; [apply Rmult_le_pos | apply Rmult_le_compat_r]; lra).
  split; [apply nearest32_nonneg; lra |]. split; [lra |].
  replace ((n + 2) * share) with (n * share + 2 * share) by ring.
  assert (u * L <= u * sum) by (apply Rmult_le_compat_l; [unfold u |]; lra).
  unfold u in *. lra.
Qed.

Variables x y z xy xz yz straight over_a over_b over_c : R.
Variables X Y Z XY XZ YZ ST OA OB OC : R.
Hypothesis Bx : 0 <= x <= X /\ X <= 1.7321 * w.
Hypothesis By : 0 <= y <= Y /\ Y <= 1.7321 * w.
Hypothesis Bz : 0 <= z <= Z /\ Z <= 1.7321 * w.

Let In_sum : a <= sum /\ b <= sum /\ c <= sum.
Proof. unfold sum. lra. Qed.

Lemma dot_upto (n l0 l1 l2 L0 L1 L2 h0 h1 h2 H0 H1 H2 : R) :
  0 <= n <= 20 -> multiplier n l0 L0 -> multiplier n l1 L1 -> multiplier n l2 L2 ->
  0 <= h0 <= H0 /\ H0 <= 1.7321 * w -> 0 <= h1 <= H1 /\ H1 <= 1.7321 * w ->
  0 <= h2 <= H2 /\ H2 <= 1.7321 * w ->
  upto (5.2 * n + 25) 5.2 (dot_of gradual (pt l0 l1 l2) (pt h0 h1 h2)) (L0 * H0 + L1 * H1 + L2 * H2).
Proof.
  intros N M0 M1 M2 (A0 & A1) (B0 & B1) (C0 & C1). unfold dot_of, pt. cbn [px py pz].
  pose proof (mul_upto _ _ _ _ _ M0 A0 A1 ltac:(lra)) as P0.
  pose proof (mul_upto _ _ _ _ _ M1 B0 B1 ltac:(lra)) as P1.
  pose proof (mul_upto _ _ _ _ _ M2 C0 C1 ltac:(lra)) as P2.
  pose proof (add_upto _ _ _ _ _ _ _ _ P0 P1 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra)) as S.
  pose proof (add_upto _ _ _ _ _ _ _ _ S P2 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra)) as T.
  revert T. intro T. apply (upto_more _ _ _ _ _ _ T); lra.
Qed.

Lemma above_6 : upto 300 13 (rounded_6 gradual x y z a b c) (support_6 X Y Z a b c).
Proof.
  unfold rounded_6, support_6. destruct In_sum as (I & J & K).
  pose proof (dot_upto 0 a b c a b c x y z X Y Z ltac:(lra) (exact_multiplier a ltac:(lra))
    (exact_multiplier b ltac:(lra)) (exact_multiplier c ltac:(lra)) Bx By Bz) as D.
  apply (upto_more _ _ _ _ _ _ D); lra.
Qed.

Lemma leads_upto : upto 41 5.2 (leads_of gradual x y z a b c) (leads X Y Z a b c).
Proof.
  unfold leads_of, leads. destruct In_sum as (I & J & K).
  pose proof (dot_upto 3 _ _ _ _ _ _ x y z X Y Z ltac:(lra)
    (lead_multiplier a b c ltac:(lra) ltac:(lra) ltac:(lra))
    (lead_multiplier b a c ltac:(lra) ltac:(lra) ltac:(lra))
    (lead_multiplier c a b ltac:(lra) ltac:(lra) ltac:(lra)) Bx By Bz) as D.
  apply (upto_more _ _ _ _ _ _ D); lra.
Qed.

Lemma minima : let low := Rmin (Rmin a b) c in
  0 <= low /\ low <= Rmin a b /\ low <= Rmin a c /\ low <= Rmin b c /\
  Rmin a b <= sum /\ Rmin a c <= sum /\ Rmin b c <= sum.
Proof.
  unfold sum. cbv zeta. unfold Rmin. repeat destruct Rle_dec; lra.
Qed.

Section Pairs.
Hypothesis Bxy : 0 <= xy <= XY /\ XY <= 1.7321 * w.
Hypothesis Bxz : 0 <= xz <= XZ /\ XZ <= 1.7321 * w.
Hypothesis Byz : 0 <= yz <= YZ /\ YZ <= 1.7321 * w.

Lemma above_26 :
  0 <= straight <= ST /\ ST <= 1.7321 * w ->
  upto 300 13 (rounded_26 gradual x y z xy xz yz straight a b c)
    (support_26 X Y Z XY XZ YZ ST a b c).
Proof.
  intros (S0 & S1). unfold rounded_26, support_26. cbv zeta. plain_extremes.
  destruct minima as (M0 & M1 & M2 & M3 & N1 & N2 & N3).
  pose proof (mul_upto 0 _ _ _ _ (exact_multiplier (Rmin (Rmin a b) c) ltac:(lra)) S0 S1 ltac:(lra))
    as P.
  pose proof (dot_upto 3 _ _ _ _ _ _ xy xz yz XY XZ YZ ltac:(lra)
    (difference_multiplier (Rmin a b) _ (conj M0 M1) N1)
    (difference_multiplier (Rmin a c) _ (conj M0 M2) N2)
    (difference_multiplier (Rmin b c) _ (conj M0 M3) N3) Bxy Bxz Byz) as D.
  pose proof (add_upto _ _ _ _ _ _ _ _ P D ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra)) as S.
  pose proof (add_upto _ _ _ _ _ _ _ _ S leads_upto ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra) ltac:(lra)) as T.
  apply (upto_more _ _ _ _ _ _ T); lra.
Qed.

(* The least of a number and the rounded sum of the other two. *)
Lemma least_of_sum (i j l : R) :
  0 <= i -> 0 <= j -> 0 <= l -> i + j + l = sum ->
  let t := Rmin i (add gradual j l) in
  0 <= t <= i /\ 0 <= Rmin i (j + l) <= i /\ Rabs (t - Rmin i (j + l)) <= 3 * share.
Proof.
  intros I J L E. cbv zeta. rewrite gradual_add. pose proof share_positive as (Sh & _ & _).
  pose proof (rounded_share (j + l) ltac:(apply Rabs_le; lra)) as R0.
  pose proof (nearest32_nonneg (j + l) ltac:(lra)) as P.
  split; [unfold Rmin; destruct Rle_dec; lra |]. split; [unfold Rmin; destruct Rle_dec; lra |].
  apply Rabs_le_inv in R0. apply Rabs_le. unfold Rmin. repeat destruct Rle_dec; lra.
Qed.

Lemma part_multiplier (p q r p' q' r' : R) :
  0 <= p -> 0 <= q -> 0 <= r -> p + q <= sum -> r <= sum ->
  0 <= p' -> 0 <= q' -> 0 <= r' -> p' + q' <= sum -> r' <= sum ->
  Rabs (p' - p) <= 3 * share -> Rabs (q' - q) <= 3 * share -> Rabs (r' - r) <= 3 * share ->
  multiplier 12 (most gradual (mul gradual (/ 2) (sub gradual (add gradual p' q') r')) 0)
    (Rmax (/ 2 * (p + q - r)) 0).
Proof.
  intros P Q R0 PQ Rs P' Q' R0' PQ' Rs' Ep Eq Er.
  plain_extremes. rewrite gradual_mul, gradual_sub, gradual_add.
  pose proof share_positive as (Sh & _ & _).
  pose proof (rounded_share (p' + q') ltac:(apply Rabs_le; lra)) as E1. apply Rabs_le_inv in E1.
  set (s1 := nearest32 (p' + q')) in *.
  pose proof (rounded_share (s1 - r') ltac:(apply Rabs_le; lra)) as E2. apply Rabs_le_inv in E2.
  set (s2 := nearest32 (s1 - r')) in *.
  pose proof (rounded_share (/ 2 * s2) ltac:(apply Rabs_le; lra)) as E3. apply Rabs_le_inv in E3.
  apply Rabs_le_inv in Ep, Eq, Er.
  pose proof (Rmax_l (/ 2 * (p + q - r)) 0). pose proof (Rmax_r (/ 2 * (p + q - r)) 0).
  split; [apply Rmax_r |]. split; [split; [lra | apply Rmax_lub; lra] |].
  apply Rmax_lub; lra.
Qed.

Lemma above_18 :
  upto 300 13 (rounded_18 gradual x y z xy xz yz a b c) (support_18 X Y Z XY XZ YZ a b c).
Proof.
  unfold rounded_18, support_18. cbv zeta. plain_extremes.
  destruct (least_of_sum a b c Ha Hb Hc eq_refl) as (A0 & A1 & A2).
  destruct (least_of_sum b a c Hb Ha Hc ltac:(unfold sum; ring)) as (B0 & B1 & B2).
  destruct (least_of_sum c a b Hc Ha Hb ltac:(unfold sum; ring)) as (C0 & C1 & C2). cbv zeta in *.
  set (ca := Rmin a (b + c)) in *. set (cb := Rmin b (a + c)) in *. set (cc := Rmin c (a + b)) in *.
  set (ca' := Rmin a (add gradual b c)) in *. set (cb' := Rmin b (add gradual a c)) in *.
  set (cc' := Rmin c (add gradual a b)) in *. destruct In_sum as (I & J & K).
  destruct Bxy as (Bxy0 & Bxy1), Bxz as (Bxz0 & Bxz1), Byz as (Byz0 & Byz1).
  assert (Sum : a + b + c = sum) by reflexivity. pose proof share_positive as (Sh & _ & _).
  pose proof (mul_upto _ _ _ _ _ (part_multiplier ca cb cc ca' cb' cc' ltac:(lra) ltac:(lra)
    ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) A2 B2 C2)
    Bxy0 Bxy1 ltac:(lra)) as P1.
  pose proof (mul_upto _ _ _ _ _ (part_multiplier ca cc cb ca' cc' cb' ltac:(lra) ltac:(lra)
    ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) A2 C2 B2)
    Bxz0 Bxz1 ltac:(lra)) as P2.
  pose proof (mul_upto _ _ _ _ _ (part_multiplier cb cc ca cb' cc' ca' ltac:(lra) ltac:(lra)
    ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) B2 C2 A2)
    Byz0 Byz1 ltac:(lra)) as P3.
  assert (Rest : forall i c0 c1, 0 <= c1 <= i -> 0 <= c0 <= i -> Rabs (c1 - c0) <= 3 * share ->
    i <= sum -> multiplier 6 (sub gradual i c1) (i - c0)).
  { intros i c0 c1 H1 H0 E L. destruct (difference_multiplier i c1 H1 L) as (D0 & D1 & D2).
    apply Rabs_le_inv in E. unfold multiplier. lra. }
  pose proof (dot_upto 6 _ _ _ _ _ _ x y z X Y Z ltac:(lra) (Rest a ca ca' A0 A1 A2 I)
    (Rest b cb cb' B0 B1 B2 J) (Rest c cc cc' C0 C1 C2 K) Bx By Bz) as D.
  pose proof (add_upto _ _ _ _ _ _ _ _ P1 P2 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra)) as S1.
  pose proof (add_upto _ _ _ _ _ _ _ _ S1 P3 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra)) as S2.
  pose proof (add_upto _ _ _ _ _ _ _ _ S2 D ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra)) as S3.
  apply (upto_more _ _ _ _ _ _ S3); lra.
Qed.
End Pairs.

Lemma above_14 :
  0 <= straight <= ST /\ ST <= 1.7321 * w -> 0 <= over_a <= OA /\ OA <= 1.7321 * w ->
  0 <= over_b <= OB /\ OB <= 1.7321 * w -> 0 <= over_c <= OC /\ OC <= 1.7321 * w ->
  upto 300 13 (rounded_14 gradual x y z straight over_a over_b over_c a b c)
    (support_14 X Y Z ST OA OB OC a b c).
Proof.
  intros (S0 & S1) (A0 & A1) (B0 & B1) (C0 & C1). unfold rounded_14, support_14. cbv zeta.
  plain_extremes.
  destruct minima as (M0 & M1 & M2 & M3 & N1 & N2 & N3).
  set (low := Rmin (Rmin a b) c) in *. set (ab := Rmin a b) in *. set (ac := Rmin a c) in *.
  set (bc := Rmin b c) in *. set (median := Rmax (Rmax ab ac) bc) in *.
  assert (Med : 0 <= median /\ median + low <= sum).
  { unfold median, low, ab, ac, bc, sum. unfold Rmin, Rmax. repeat destruct Rle_dec; lra. }
  pose proof share_positive as (Sh & _ & _).
  assert (Whole : multiplier 3 (add gradual median low) (median + low)).
  { rewrite gradual_add. pose proof (rounded_share (median + low) ltac:(apply Rabs_le; lra)) as E.
    apply Rabs_le_inv in E. pose proof (nearest32_nonneg (median + low) ltac:(lra)).
    unfold multiplier. lra. }
  pose proof (mul_upto _ _ _ _ _ (half_multiplier _ _ _ Whole ltac:(lra)) S0 S1 ltac:(lra)) as P0.
  pose proof (mul_upto _ _ _ _ _ (half_multiplier _ _ _ (difference_multiplier ab low
    (conj M0 M1) N1) ltac:(lra)) C0 C1 ltac:(lra)) as P1.
  pose proof (mul_upto _ _ _ _ _ (half_multiplier _ _ _ (difference_multiplier ac low
    (conj M0 M2) N2) ltac:(lra)) B0 B1 ltac:(lra)) as P2.
  pose proof (mul_upto _ _ _ _ _ (half_multiplier _ _ _ (difference_multiplier bc low
    (conj M0 M3) N3) ltac:(lra)) A0 A1 ltac:(lra)) as P3.
  pose proof (add_upto _ _ _ _ _ _ _ _ P1 P2 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra)) as T1.
  pose proof (add_upto _ _ _ _ _ _ _ _ T1 P3 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra)) as T2.
  pose proof (add_upto _ _ _ _ _ _ _ _ P0 T2 ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra)) as T3.
  pose proof (add_upto _ _ _ _ _ _ _ _ T3 leads_upto ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
    ltac:(lra) ltac:(lra)) as T4.
  apply (upto_more _ _ _ _ _ _ T4); lra.
Qed.
End Octant.

Ltac listed := cbn; repeat first [left; reflexivity | right].

(* The computed support of slabs that end within w of the centre, in units of the directions. *)
Theorem computed_support_above (k : kind) (s : slabs) (w : R) (signs : bool * bool * bool)
    (e : point) :
  0 <= w ->
  (forall member, In member (members k) -> 0 <= fst (s member) /\ 0 <= snd (s member)) ->
  no_wider k s w ->
  let sum := Rabs (px e) + Rabs (py e) + Rabs (pz e) in
  0 <= support_of gradual k s signs e <=
    w * (spread k * norm e) + 300 * (u * (sum * w) + half_step * (w + 1)).
Proof.
  intros W Pos Wide. cbv zeta. destruct signs as [[i j] l].
  pose proof (ball_support k w (i, j, l) e W) as B.
  pose proof (Rabs_pos (px e)) as A0. pose proof (Rabs_pos (py e)) as B0.
  pose proof (Rabs_pos (pz e)) as C0.
  assert (Ball : forall member n, In member (members k) ->
    0 <= end_of s member n <= end_of (ball_slabs w) member n /\
    end_of (ball_slabs w) member n <= 1.7321 * w).
  { intros member n M. destruct (Pos member M) as (P & Q). destruct (Wide member M) as (F & G).
    assert (U : norm (direction member) <= 1.7321).
    { apply norm_below; [lra |]. unfold square, direction, directions, pt.
      assert (M' : In member (members K26)) by (destruct k; cbn in M |- *; tauto).
      cbn in M'. repeat (destruct M' as [<- | M']); [.. | destruct M']; cbn [nth map px py pz]; lra. }
    assert (w * norm (direction member) <= w * 1.7321) by (apply Rmult_le_compat_l; lra).
    unfold end_of, ball_slabs. destruct n; cbn [fst snd]; lra. }
  clear Pos Wide.
  assert (Upto : upto (Rabs (px e)) (Rabs (py e)) (Rabs (pz e)) w 300 13
    (support_of gradual k s (i, j, l) e) (support k (ball_slabs w) (i, j, l) e)).
  { unfold support_of, support, pair, facing.
    cbv beta iota zeta.
    destruct k.
    - apply above_6; try assumption; apply Ball; listed.
    - apply above_14; try assumption; apply Ball; destruct i, j, l; listed.
    - apply above_18; try assumption; apply Ball; destruct i, j, l; listed.
    - apply above_26; try assumption; apply Ball; destruct i, j, l; listed. }
  destruct Upto as (P0 & _ & U). unfold excess_unit in U. split; [exact P0 | lra].
Qed.
