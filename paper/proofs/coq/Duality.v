(* Theorems N and E without rounding: the support of an or-DOP that the code takes from its slabs bounds
   every point of it (weak duality), and an axis along which the gap exceeds both supports separates.
   What rounding takes from this is in SupportRounded.v and OrDop.v. *)
From Coq Require Import Reals Bool List Lra.
From Sdop Require Import Geometry Pose.
Import ListNotations.
Open Scope R_scope.

(* src/overlap/ordop/table.rs: COEFFICIENTS *)
Definition directions : list point :=
  map (fun '(x, y, z) => pt x y z)
    [(1, 0, 0); (0, 1, 0); (0, 0, 1); (1, 1, 0); (1, -1, 0); (1, 0, 1); (1, 0, -1); (0, 1, 1);
     (0, 1, -1); (1, 1, 1); (-1, 1, 1); (1, -1, 1); (-1, -1, 1)].
Definition direction (member : nat) : point := nth member directions (pt 0 0 0).

Inductive kind := K6 | K14 | K18 | K26.
Definition members (k : kind) : list nat :=
  match k with
  | K6 => [0; 1; 2]
  | K14 => [0; 1; 2; 9; 10; 11; 12]
  | K18 => [0; 1; 2; 3; 4; 5; 6; 7; 8]
  | K26 => [0; 1; 2; 3; 4; 5; 6; 7; 8; 9; 10; 11; 12]
  end%nat.

(* Of each direction, the end that it faces and the one that its opposite faces. *)
Definition slabs : Type := nat -> R * R.
Definition inside (k : kind) (s : slabs) (z : point) : Prop :=
  forall member, In member (members k) ->
    dot (direction member) z <= fst (s member) /\ - dot (direction member) z <= snd (s member).

(* src/overlap/ordop/slabs.rs: LaneSlabs::own, LaneSlabs::pair, LaneSlabs::cube, as RunOrDop.v has them. *)
Definition end_of (s : slabs) (member : nat) (opposite : bool) : R :=
  if opposite then snd (s member) else fst (s member).
Definition pair (s : slabs) (member : nat) (x y : bool) : R :=
  end_of s (if xorb x y then S member else member) x.
Definition facing (s : slabs) (x y z : bool) : R :=
  end_of s (9 + (if xorb x z then 1 else 0) + (if xorb y z then 2 else 0)) z.

(* src/overlap/ordop/support.rs: support, the four of |e| = (a, b, c), from the ends that e faces. *)
Definition lead (x y z : R) : R := Rmax (x - Rmax y z) 0.
Definition leads (x y z a b c : R) : R := lead a b c * x + lead b a c * y + lead c a b * z.
Definition support_6 (x y z a b c : R) : R := a * x + b * y + c * z.
Definition support_14 (x y z straight over_a over_b over_c a b c : R) : R :=
  let '(ab, ac, bc) := (Rmin a b, Rmin a c, Rmin b c) in
  let low := Rmin ab c in
  let median := Rmax (Rmax ab ac) bc in
  / 2 * (median + low) * straight +
  (/ 2 * (ab - low) * over_c + / 2 * (ac - low) * over_b + / 2 * (bc - low) * over_a) +
  leads x y z a b c.
Definition support_18 (x y z xy xz yz a b c : R) : R :=
  let '(ca, cb, cc) := (Rmin a (b + c), Rmin b (a + c), Rmin c (a + b)) in
  Rmax (/ 2 * (ca + cb - cc)) 0 * xy + Rmax (/ 2 * (ca + cc - cb)) 0 * xz +
  Rmax (/ 2 * (cb + cc - ca)) 0 * yz + ((a - ca) * x + (b - cb) * y + (c - cc) * z).
Definition support_26 (x y z xy xz yz straight a b c : R) : R :=
  let '(ab, ac, bc) := (Rmin a b, Rmin a c, Rmin b c) in
  let low := Rmin ab c in
  low * straight + ((ab - low) * xy + (ac - low) * xz + (bc - low) * yz) + leads x y z a b c.

Definition support (k : kind) (s : slabs) (signs : bool * bool * bool) (e : point) : R :=
  let '(i, j, l) := signs in
  let '(a, b, c) := (Rabs (px e), Rabs (py e), Rabs (pz e)) in
  let '(x, y, z) := (end_of s 0 i, end_of s 1 j, end_of s 2 l) in
  let '(xy, xz, yz) := (pair s 3 i j, pair s 5 i l, pair s 7 j l) in
  let over := facing s in
  match k with
  | K6 => support_6 x y z a b c
  | K14 => support_14 x y z (over i j l) (over (negb i) j l) (over i (negb j) l)
      (over i j (negb l)) a b c
  | K18 => support_18 x y z xy xz yz a b c
  | K26 => support_26 x y z xy xz yz (over i j l) a b c
  end.

Ltac each_order :=
  unfold leads, lead, Rmin, Rmax;
  repeat match goal with
  | |- context [Rle_dec ?x ?y] =>
    lazymatch x with context [Rle_dec _ _] => fail | _ => idtac end;
    lazymatch y with context [Rle_dec _ _] => fail | _ => idtac end;
    destruct (Rle_dec x y)
  end; try lra.

Lemma bound (l h v : R) : 0 <= l -> v <= h -> l * v <= l * h.
Proof. intros. now apply Rmult_le_compat_l. Qed.

Section Supports.
(* The point turned into the octant of e. *)
Variables a b c p q r : R.
Hypothesis Ha : 0 <= a.
Hypothesis Hb : 0 <= b.
Hypothesis Hc : 0 <= c.
Variables x y z xy xz yz straight over_a over_b over_c : R.
Hypothesis X : p <= x.
Hypothesis Y : q <= y.
Hypothesis Z : r <= z.

Lemma bounded_6 : a * p + b * q + c * r <= support_6 x y z a b c.
Proof.
  unfold support_6. pose proof (bound _ _ _ Ha X). pose proof (bound _ _ _ Hb Y).
  pose proof (bound _ _ _ Hc Z). lra.
Qed.

Lemma leads_bound : lead a b c * p + lead b a c * q + lead c a b * r <= leads x y z a b c.
Proof.
  unfold leads. pose proof (bound (lead a b c) x p (Rmax_r _ _) X).
  pose proof (bound (lead b a c) y q (Rmax_r _ _) Y).
  pose proof (bound (lead c a b) z r (Rmax_r _ _) Z). lra.
Qed.

Lemma bounded_26 :
  p + q <= xy -> p + r <= xz -> q + r <= yz -> p + q + r <= straight ->
  a * p + b * q + c * r <= support_26 x y z xy xz yz straight a b c.
Proof.
  intros XY XZ YZ S. unfold support_26. cbv zeta.
  pose proof leads_bound as L.
  set (low := Rmin (Rmin a b) c).
  assert (P0 : 0 <= low) by (unfold low; each_order).
  assert (P1 : 0 <= Rmin a b - low) by (unfold low; each_order).
  assert (P2 : 0 <= Rmin a c - low) by (unfold low; each_order).
  assert (P3 : 0 <= Rmin b c - low) by (unfold low; each_order).
  pose proof (bound _ _ _ P0 S). pose proof (bound _ _ _ P1 XY). pose proof (bound _ _ _ P2 XZ).
  pose proof (bound _ _ _ P3 YZ).
  assert (E1 : a = low + (Rmin a b - low) + (Rmin a c - low) + lead a b c)
    by (unfold low; each_order).
  assert (E2 : b = low + (Rmin a b - low) + (Rmin b c - low) + lead b a c)
    by (unfold low; each_order).
  assert (E3 : c = low + (Rmin a c - low) + (Rmin b c - low) + lead c a b)
    by (unfold low; each_order).
  apply (f_equal (fun t => t * p)) in E1. apply (f_equal (fun t => t * q)) in E2.
  apply (f_equal (fun t => t * r)) in E3. cbv beta in *. lra.
Qed.

Lemma bounded_14 :
  p + q + r <= straight -> - p + q + r <= over_a -> p - q + r <= over_b -> p + q - r <= over_c ->
  a * p + b * q + c * r <= support_14 x y z straight over_a over_b over_c a b c.
Proof.
  intros S A B C. unfold support_14. cbv zeta. pose proof leads_bound as L.
  set (low := Rmin (Rmin a b) c). set (median := Rmax (Rmax (Rmin a b) (Rmin a c)) (Rmin b c)).
  assert (P0 : 0 <= / 2 * (median + low)) by (unfold low, median; each_order).
  assert (P1 : 0 <= / 2 * (Rmin a b - low)) by (unfold low; each_order).
  assert (P2 : 0 <= / 2 * (Rmin a c - low)) by (unfold low; each_order).
  assert (P3 : 0 <= / 2 * (Rmin b c - low)) by (unfold low; each_order).
  pose proof (bound _ _ _ P0 S). pose proof (bound _ _ _ P1 C). pose proof (bound _ _ _ P2 B).
  pose proof (bound _ _ _ P3 A).
  assert (E1 : a = / 2 * (median + low) + / 2 * (Rmin a b - low) + / 2 * (Rmin a c - low)
    - / 2 * (Rmin b c - low) + lead a b c) by (unfold low, median; each_order).
  assert (E2 : b = / 2 * (median + low) + / 2 * (Rmin a b - low) - / 2 * (Rmin a c - low)
    + / 2 * (Rmin b c - low) + lead b a c) by (unfold low, median; each_order).
  assert (E3 : c = / 2 * (median + low) - / 2 * (Rmin a b - low) + / 2 * (Rmin a c - low)
    + / 2 * (Rmin b c - low) + lead c a b) by (unfold low, median; each_order).
  apply (f_equal (fun t => t * p)) in E1. apply (f_equal (fun t => t * q)) in E2.
  apply (f_equal (fun t => t * r)) in E3. cbv beta in *. lra.
Qed.

Lemma bounded_18 :
  p + q <= xy -> p + r <= xz -> q + r <= yz ->
  a * p + b * q + c * r <= support_18 x y z xy xz yz a b c.
Proof.
  intros XY XZ YZ. unfold support_18. cbv zeta.
  set (ca := Rmin a (b + c)). set (cb := Rmin b (a + c)). set (cc := Rmin c (a + b)).
  pose proof (bound _ _ _ (Rmax_r (/ 2 * (ca + cb - cc)) 0) XY).
  pose proof (bound _ _ _ (Rmax_r (/ 2 * (ca + cc - cb)) 0) XZ).
  pose proof (bound _ _ _ (Rmax_r (/ 2 * (cb + cc - ca)) 0) YZ).
  assert (P1 : 0 <= a - ca) by (unfold ca; each_order).
  assert (P2 : 0 <= b - cb) by (unfold cb; each_order).
  assert (P3 : 0 <= c - cc) by (unfold cc; each_order).
  pose proof (bound _ _ _ P1 X). pose proof (bound _ _ _ P2 Y). pose proof (bound _ _ _ P3 Z).
  assert (E1 : a = Rmax (/ 2 * (ca + cb - cc)) 0 + Rmax (/ 2 * (ca + cc - cb)) 0 + (a - ca))
    by (unfold ca, cb, cc; each_order).
  assert (E2 : b = Rmax (/ 2 * (ca + cb - cc)) 0 + Rmax (/ 2 * (cb + cc - ca)) 0 + (b - cb))
    by (unfold ca, cb, cc; each_order).
  assert (E3 : c = Rmax (/ 2 * (ca + cc - cb)) 0 + Rmax (/ 2 * (cb + cc - ca)) 0 + (c - cc))
    by (unfold ca, cb, cc; each_order).
  apply (f_equal (fun t => t * p)) in E1. apply (f_equal (fun t => t * q)) in E2.
  apply (f_equal (fun t => t * r)) in E3. cbv beta in *. lra.
Qed.
End Supports.

(* Signs as the code reads them: a zero may have either. *)
Definition sign_of (negative : bool) (x : R) : Prop := if negative then x <= 0 else 0 <= x.
Definition signs_of (signs : bool * bool * bool) (e : point) : Prop :=
  let '(i, j, l) := signs in sign_of i (px e) /\ sign_of j (py e) /\ sign_of l (pz e).

Lemma turned (negative : bool) (x v : R) :
  sign_of negative x -> x * v = Rabs x * (if negative then - v else v).
Proof.
  destruct negative; cbn; intro H; [rewrite Rabs_left1 by exact H | rewrite Rabs_pos_eq by exact H];
    ring.
Qed.

(* The support that the code takes is no less than e . z for any point z of the polytope. *)
Theorem support_bounds (k : kind) (s : slabs) (signs : bool * bool * bool) (e z : point) :
  signs_of signs e -> inside k s z -> dot e z <= support k s signs e.
Proof.
  destruct signs as [[i j] l]. intros (I & J & L) H. unfold dot.
  rewrite (turned i _ _ I), (turned j _ _ J), (turned l _ _ L).
  assert (A : 0 <= Rabs (px e)) by apply Rabs_pos. assert (B : 0 <= Rabs (py e)) by apply Rabs_pos.
  assert (C : 0 <= Rabs (pz e)) by apply Rabs_pos. clear I J L.
  unfold support, pair, facing, end_of.
  destruct k;
    [apply bounded_6 | apply bounded_14 | apply bounded_18 | apply bounded_26]; try assumption;
    destruct i, j, l; cbn [xorb negb Nat.add];
    lazymatch goal with
    | |- _ <= fst (s ?m) => destruct (H m ltac:(cbn; tauto)) as [F _]
    | |- _ <= snd (s ?m) => destruct (H m ltac:(cbn; tauto)) as [_ F]
    end;
    unfold dot, direction, directions, pt in F; cbn [nth map px py pz] in F; lra.
Qed.

(* The exact test of an axis. Of bodies with orthonormal axes Q_A and Q_B and the gap between their
   slabs' centres, the points Q_A y and gap + Q_B z of the two. *)
Definition orthonormal (q : matrix) : Prop :=
  dot (row0 q) (row0 q) = 1 /\ dot (row1 q) (row1 q) = 1 /\ dot (row2 q) (row2 q) = 1 /\
  dot (row0 q) (row1 q) = 0 /\ dot (row0 q) (row2 q) = 0 /\ dot (row1 q) (row2 q) = 0.
(* Rows are the axes: a combination of them, and coordinates along them. *)
Definition combined (q : matrix) (v : point) : point :=
  pt (px v * px (row0 q) + py v * px (row1 q) + pz v * px (row2 q))
     (px v * py (row0 q) + py v * py (row1 q) + pz v * py (row2 q))
     (px v * pz (row0 q) + py v * pz (row1 q) + pz v * pz (row2 q)).

Lemma combined_dot (q : matrix) (v w : point) : dot (combined q v) w = dot v (apply q w).
Proof. unfold combined, apply, dot, pt. cbn [px py pz]. ring. Qed.

Lemma apply_combined (q : matrix) (v : point) : orthonormal q -> apply q (combined q v) = v.
Proof.
  destruct q as [[a b c] [d e f] [g h i]], v as [x y z].
  unfold orthonormal, apply, combined, dot, pt. cbn [row0 row1 row2 px py pz].
  intros (U0 & U1 & U2 & V0 & V1 & V2). f_equal.
  - replace (_ + _ + _) with (x * (a * a + b * b + c * c) + y * (a * d + b * e + c * f)
      + z * (a * g + b * h + c * i)) by ring. rewrite U0, V0, V1. ring.
  - replace (_ + _ + _) with (x * (a * d + b * e + c * f) + y * (d * d + e * e + f * f)
      + z * (d * g + e * h + f * i)) by ring. rewrite U1, V0, V2. ring.
  - replace (_ + _ + _) with (x * (a * g + b * h + c * i) + y * (d * g + e * h + f * i)
      + z * (g * g + h * h + i * i)) by ring. rewrite U2, V1, V2. ring.
Qed.

(* Any vector a, in coordinates of A: where its gap exceeds the support of A along it and that of B
   along the opposite, no point is common. *)
Theorem axis_separates (k : kind) (qa qb : matrix) (gap a : point) (sa sb : slabs)
    (signs_a signs_b : bool * bool * bool) :
  orthonormal qa ->
  let back := apply qb (combined qa a) in
  let away := pt (- px back) (- py back) (- pz back) in
  signs_of signs_a a -> signs_of signs_b away ->
  support k sa signs_a a + support k sb signs_b away < dot a (apply qa gap) ->
  forall y z, inside k sa y -> inside k sb z -> combined qa y <> plus gap (combined qb z).
Proof.
  intros Oa back away Sa Sb H y z Iy Iz E.
  pose proof (support_bounds k sa signs_a a y Sa Iy) as Ba.
  pose proof (support_bounds k sb signs_b away z Sb Iz) as Bb.
  assert (G : dot a y = dot a (apply qa gap) + dot back z).
  { rewrite <- (apply_combined qa y Oa) at 1. rewrite E. rewrite <- !combined_dot.
    unfold back. replace (dot (apply qb (combined qa a)) z)
      with (dot (combined qa a) (combined qb z)).
    - unfold dot, plus. cbn [px py pz]. ring.
    - unfold dot, apply, combined, dot, pt. cbn [px py pz]. ring. }
  assert (N : dot away z = - dot back z).
  { unfold away, dot, pt. cbn [px py pz]. ring. }
  lra.
Qed.
