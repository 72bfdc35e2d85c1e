(* The support of an or-DOP as f32 arithmetic finds it: the code's functions, what all of them have
   in common, and the proofs for k = 6 and 26. SupportRounded.v has those for 14 and 18. *)
From Coq Require Import Reals Bool List Lra.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Pose Duality Vectors Rounded.
Import ListNotations.
Open Scope R_scope.

Section Code.
Variable m : mode.

(* src/overlap/ordop/support.rs: leads, support_14, support_18, support_26, from the ends that e
   faces, as in Duality.v. *)
Definition lead_of (x y z : R) : R := most m (sub m x (most m y z)) 0.
Definition leads_of (x y z a b c : R) : R :=
  dot_of m (pt (lead_of a b c) (lead_of b a c) (lead_of c a b)) (pt x y z).
Definition rounded_6 (x y z a b c : R) : R := dot_of m (pt a b c) (pt x y z).
Definition rounded_14 (x y z straight over_a over_b over_c a b c : R) : R :=
  let '(ab, ac, bc) := (least m a b, least m a c, least m b c) in
  let low := least m ab c in
  let median := most m (most m ab ac) bc in
  let bend x end_ := mul m (mul m (/ 2) (sub m x low)) end_ in
  add m (add m (mul m (mul m (/ 2) (add m median low)) straight)
    (add m (add m (bend ab over_c) (bend ac over_b)) (bend bc over_a))) (leads_of x y z a b c).
Definition rounded_18 (x y z xy xz yz a b c : R) : R :=
  let '(ca, cb, cc) := (least m a (add m b c), least m b (add m a c), least m c (add m a b)) in
  let part p q r end_ := mul m (most m (mul m (/ 2) (sub m (add m p q) r)) 0) end_ in
  add m (add m (add m (part ca cb cc xy) (part ca cc cb xz)) (part cb cc ca yz))
    (dot_of m (pt (sub m a ca) (sub m b cb) (sub m c cc)) (pt x y z)).
Definition rounded_26 (x y z xy xz yz straight a b c : R) : R :=
  let '(ab, ac, bc) := (least m a b, least m a c, least m b c) in
  let low := least m ab c in
  add m (add m (mul m low straight)
    (dot_of m (pt (sub m ab low) (sub m ac low) (sub m bc low)) (pt xy xz yz)))
    (leads_of x y z a b c).

(* src/overlap/ordop/support.rs: support *)
Definition support_of (k : kind) (s : slabs) (signs : bool * bool * bool) (e : point) : R :=
  let '(i, j, l) := signs in
  let '(a, b, c) := (Rabs (px e), Rabs (py e), Rabs (pz e)) in
  let '(x, y, z) := (end_of s 0 i, end_of s 1 j, end_of s 2 l) in
  let '(xy, xz, yz) := (pair s 3 i j, pair s 5 i l, pair s 7 j l) in
  let over := facing s in
  match k with
  | K6 => rounded_6 x y z a b c
  | K14 => rounded_14 x y z (over i j l) (over (negb i) j l) (over i (negb j) l)
      (over i j (negb l)) a b c
  | K18 => rounded_18 x y z xy xz yz a b c
  | K26 => rounded_26 x y z xy xz yz (over i j l) a b c
  end.
End Code.

Section Octant.
Variable m : mode.
Hypothesis Hm : valid m.
Variables a b c p q r : R.
Hypothesis Ha : 0 <= a.
Hypothesis Hb : 0 <= b.
Hypothesis Hc : 0 <= c.
Variables x y z xy xz yz straight over_a over_b over_c : R.
Hypothesis X : 0 <= x /\ p <= x.
Hypothesis Y : 0 <= y /\ q <= y.
Hypothesis Z : 0 <= z /\ r <= z.

(* How far the direction may be off, and what underflow takes. *)
Definition turn_error (sum : R) : R := 7 * u * sum + 100 * tiny.
Definition lost (sum far : R) : R := tiny * (8 * sum + 10 * far + 40).
Let sum := a + b + c.
Let far := Rabs p + Rabs q + Rabs r.

Definition supported (h : R) : Prop :=
  0 <= h /\
  exists a' b' c', Rabs (a' - a) <= turn_error sum /\ Rabs (b' - b) <= turn_error sum /\
    Rabs (c' - c) <= turn_error sum /\
    (a' * p + b' * q + c' * r) * (1 - 5 * u) - lost sum far <= h.

Lemma exact_here (t d : R) : 0 <= d -> Rabs (t - t) <= d.
Proof. intro H. now rewrite Rminus_diag_eq, Rabs_R0 by reflexivity. Qed.

Lemma half_near (t T d : R) :
  Rabs (t - T) <= d -> Rabs (mul m (/ 2) t - / 2 * T) <= 0.52 * (u * Rabs T) + 0.51 * d + 3 * tiny.
Proof.
  intro D. pose proof (mul_near m Hm (/ 2) t) as E. pose proof tiny_value as P.
  pose proof tiny_small as Small. rewrite Rabs_mult, (Rabs_pos_eq (/ 2)) in E by lra.
  pose proof (Rabs_triang_inv t T) as I. pose proof (Rabs_pos t). pose proof (Rabs_pos (t - T)).
  assert (L : tiny * Rabs t <= / 1000000000000000000000000000000 * Rabs t) by (apply
    Rmult_le_compat_r; lra).
  replace (tiny * (/ 2 + Rabs t + 1)) with (tiny * Rabs t + 1.5 * tiny) in E by lra.
  apply Rabs_le_inv in E. pose proof D as D'. apply Rabs_le_inv in D'. unfold u in *.
  apply Rabs_le. lra.
Qed.

Lemma lead_error (i j l : R) :
  0 <= i -> 0 <= j -> 0 <= l ->
  0 <= lead_of m i j l /\ Rabs (lead_of m i j l - lead i j l) <= u * (i + j + l) + 8 * tiny.
Proof.
  intros I J L. split; [apply most_nonneg |]. unfold lead_of, lead. pose proof tiny_value.
  pose proof (most_near m j l j l 0 (exact_here j 0 ltac:(lra)) (exact_here l 0 ltac:(lra))) as M.
  pose proof (sub_near m Hm i (most m j l)) as S. set (w := most m j l) in *.
  assert (B : Rabs (i - w) <= i + j + l + tiny).
  { apply Rabs_le_inv in M. apply Rabs_le. revert M. unfold Rmax. destruct Rle_dec; intro; lra. }
  assert (D : Rabs (sub m i w - (i - Rmax j l)) <= u * (i + j + l) + 6 * tiny).
  { apply Rabs_le_inv in S, M. unfold u in *. apply Rabs_le. lra. }
  assert (P : 0 <= u * (i + j + l) + 6 * tiny) by (unfold u; lra).
  pose proof (most_near m _ 0 _ 0 _ D (exact_here 0 _ P)) as E. lra.
Qed.

Lemma positive_part (l g : R) : 0 <= l -> l * g <= l * Rmax 0 g.
Proof. intro L. apply Rmult_le_compat_l; [exact L | apply Rmax_r]. Qed.

(* A sum of products covers that of the direction that its multipliers combine. *)
Lemma combine_support (n W e h a' b' c' : R) :
  covers n W e h -> n <= 5 -> e <= 8 * sum + 10 * far + 40 -> a' * p + b' * q + c' * r <= W ->
  Rabs (a' - a) <= turn_error sum -> Rabs (b' - b) <= turn_error sum ->
  Rabs (c' - c) <= turn_error sum -> supported h.
Proof.
  intros C N E L A B D. apply (covers_more _ _ _ _ _ _ N E) in C. destruct C as (_ & _ & P & H).
  split; [exact P |]. exists a', b', c'. repeat split; try assumption.
  apply Rle_trans with (2 := H). apply Rplus_le_compat_r.
  apply Rmult_le_compat_r; [unfold u; lra | exact L].
Qed.

Lemma supported_6 : supported (rounded_6 m x y z a b c).
Proof.
  pose proof tiny_value as T. unfold rounded_6.
  pose proof (covers_dot m (pt a b c) (pt x y z) p q r Hm Ha Hb Hc (proj1 X) (proj1 Y) (proj1 Z)
    (proj2 X) (proj2 Y) (proj2 Z)) as C. unfold pt in *. cbn [px py pz] in C.
  pose proof (positive_part a p Ha). pose proof (positive_part b q Hb).
  pose proof (positive_part c r Hc). pose proof (Rabs_pos p). pose proof (Rabs_pos q).
  pose proof (Rabs_pos r).
  apply (combine_support _ _ _ _ a b c C); try lra; try (unfold sum, far; lra);
    (apply Rle_trans with (1 := exact_here _ 0 ltac:(lra)); unfold turn_error, sum, u; lra).
Qed.

(* The axes' part where diagonals take the rest. *)
Let la := lead_of m a b c.
Let lb := lead_of m b a c.
Let lc := lead_of m c a b.
Lemma leads_cover :
  covers 3 (la * Rmax 0 p + lb * Rmax 0 q + lc * Rmax 0 r)
    (la + lb + lc + far + 9) (leads_of m x y z a b c).
Proof.
  pose proof (lead_error a b c Ha Hb Hc) as (A & _).
  pose proof (lead_error b a c Hb Ha Hc) as (B & _).
  pose proof (lead_error c a b Hc Ha Hb) as (C & _).
  pose proof (covers_dot m (pt la lb lc) (pt x y z) p q r Hm A B C (proj1 X) (proj1 Y) (proj1 Z)
    (proj2 X) (proj2 Y) (proj2 Z)) as D. unfold pt in *. cbn [px py pz] in D.
  revert D. apply covers_more; unfold far; lra.
Qed.

Lemma minimum_error (i j : R) :
  0 <= i -> 0 <= j ->
  let w := least m i j in 0 <= w /\ w <= i /\ w <= j /\ Rabs (w - Rmin i j) <= tiny.
Proof.
  intros I J w. destruct (least_below m i j I J) as (P & Q & R). fold w in P, Q, R.
  repeat split; try assumption.
  pose proof (least_near m i j i j 0 (exact_here i 0 ltac:(lra)) (exact_here j 0 ltac:(lra))) as M.
  fold w in M. lra.
Qed.

Lemma low_below :
  least m (least m a b) c <= least m a c /\ least m (least m a b) c <= least m b c.
Proof.
  destruct (least_below m a b Ha Hb) as (A0 & A1 & A2).
  pose proof (read_nonneg m _ A0). pose proof (read_monotone m _ a (conj A0 A1)).
  pose proof (read_monotone m _ b (conj A0 A2)). set (ab := least m a b) in *. unfold least.
  split; unfold Rmin; repeat destruct Rle_dec; lra.
Qed.

Lemma far_sums : Rabs (p + q) <= far /\ Rabs (p + r) <= far /\ Rabs (q + r) <= far /\
  Rabs (p + q + r) <= far /\ Rabs (- p + q + r) <= far /\ Rabs (p - q + r) <= far /\
  Rabs (p + q - r) <= far.
Proof.
  unfold far. pose proof (Rle_abs p). pose proof (Rle_abs q). pose proof (Rle_abs r).
  pose proof (Rle_abs (- p)) as A. pose proof (Rle_abs (- q)) as B. pose proof (Rle_abs (- r)) as C.
  rewrite Rabs_Ropp in A, B, C. repeat split; apply Rabs_le; lra.
Qed.

Lemma supported_26 :
  0 <= xy /\ p + q <= xy -> 0 <= xz /\ p + r <= xz -> 0 <= yz /\ q + r <= yz ->
  0 <= straight /\ p + q + r <= straight ->
  supported (rounded_26 m x y z xy xz yz straight a b c).
Proof.
  intros XY XZ YZ S. unfold rounded_26.
  pose proof tiny_value as T. pose proof tiny_small as T'.
  destruct (minimum_error a b Ha Hb) as (A0 & A1 & A2 & A3).
  destruct (minimum_error a c Ha Hc) as (B0 & B1 & B2 & B3).
  destruct (minimum_error b c Hb Hc) as (C0 & C1 & C2 & C3).
  cbv zeta in *. set (ab := least m a b) in *. set (ac := least m a c) in *.
  set (bc := least m b c) in *.
  pose proof (least_near m ab c (Rmin a b) c tiny A3 (exact_here c tiny ltac:(lra))) as L.
  destruct (least_below m ab c A0 Hc) as (L0 & L1 & L2).
  set (low := least m ab c) in *.
  destruct low_below as (La & Lb). fold ab ac bc in La, Lb. fold low in La, Lb.
  assert (Sub : forall w W, 0 <= w -> w <= sum -> low <= w -> Rabs (w - W) <= tiny ->
    0 <= sub m w low /\ Rabs (sub m w low - (W - Rmin (Rmin a b) c)) <= u * sum + 7 * tiny).
  { intros w W P0 P1 P2 P3. split; [apply sub_nonneg; lra |].
    pose proof (sub_of_near m Hm w low W _ _ _ sum P3 L) as N. unfold sum in *.
    specialize (N ltac:(apply Rabs_le; lra)). lra. }
  destruct (Sub ab _ A0 ltac:(unfold sum; lra) L1 A3) as (D0 & D1).
  destruct (Sub ac _ B0 ltac:(unfold sum; lra) La B3) as (E0 & E1).
  destruct (Sub bc _ C0 ltac:(unfold sum; lra) Lb C3) as (F0 & F1). clear Sub.
  destruct (lead_error a b c Ha Hb Hc) as (Ga0 & Ga1).
  destruct (lead_error b a c Hb Ha Hc) as (Gb0 & Gb1).
  destruct (lead_error c a b Hc Ha Hb) as (Gc0 & Gc1).
  pose proof leads_cover as G. unfold la, lb, lc in *.
  set (dab := sub m ab low) in *. set (dac := sub m ac low) in *. set (dbc := sub m bc low) in *.
  set (la' := lead_of m a b c) in *. set (lb' := lead_of m b a c) in *.
  set (lc' := lead_of m c a b) in *.
  pose proof (covers_mul m Hm low straight _ L0 (proj1 S) (proj2 S)) as P1.
  pose proof (covers_dot m (pt dab dac dbc) (pt xy xz yz) (p + q) (p + r) (q + r) Hm D0 E0 F0
    (proj1 XY) (proj1 XZ) (proj1 YZ) (proj2 XY) (proj2 XZ) (proj2 YZ)) as P2.
  unfold pt in P2. cbn [px py pz] in P2.
  pose proof (covers_add m Hm 3 _ _ _ _ _ _ _ _ P1 P2
    ltac:(lra) ltac:(lra) ltac:(lra)) as P3.
  pose proof (covers_add m Hm 4 _ _ _ _ _ _ _ _ P3 G
    ltac:(lra) ltac:(lra) ltac:(lra)) as C.
  pose proof far_sums as (K1 & K2 & K3 & K4 & _).
  apply Rabs_le_inv in D1, E1, F1, Ga1, Gb1, Gc1, L, A3, B3, C3.
  apply (combine_support _ _ _ _ (low + dab + dac + la') (low + dab + dbc + lb')
    (low + dac + dbc + lc') C); [lra | | | | |].
  - unfold sum in *. clear - L1 L2 A1 A2 D1 E1 F1 Ga1 Gb1 Gc1 K1 K2 K3 K4 T T' Ha Hb Hc A0 B0 C0 A3
      B3 C3 L L0.
    assert (Q : forall i j k, 0 <= i -> 0 <= j -> 0 <= k -> lead i j k <= i)
      by (intros; unfold lead, Rmax; repeat destruct Rle_dec; lra).
    pose proof (Q a b c Ha Hb Hc). pose proof (Q b a c Hb Ha Hc). pose proof (Q c a b Hc Ha Hb).
    pose proof (Rmin_l a b). pose proof (Rmin_l a c). pose proof (Rmin_l b c).
    pose proof (Rabs_pos (p + q)). unfold u in *. lra.
  - pose proof (positive_part low (p + q + r) L0). pose proof (positive_part dab (p + q) D0).
    pose proof (positive_part dac (p + r) E0). pose proof (positive_part dbc (q + r) F0).
    pose proof (positive_part la' p Ga0). pose proof (positive_part lb' q Gb0).
    pose proof (positive_part lc' r Gc0). lra.
  - assert (I : a = Rmin (Rmin a b) c + (Rmin a b - Rmin (Rmin a b) c)
      + (Rmin a c - Rmin (Rmin a b) c) + lead a b c) by each_order.
    clearbody la' lb' lc' dab dac dbc low ab ac bc. unfold turn_error, sum, u in *.
    clear - I L D1 E1 Ga1 T Ha Hb Hc. apply Rabs_le. lra.
  - assert (I : b = Rmin (Rmin a b) c + (Rmin a b - Rmin (Rmin a b) c)
      + (Rmin b c - Rmin (Rmin a b) c) + lead b a c) by each_order.
    unfold turn_error, sum, u in *. clear - I L D1 F1 Gb1 T Ha Hb Hc. apply Rabs_le. lra.
  - assert (I : c = Rmin (Rmin a b) c + (Rmin a c - Rmin (Rmin a b) c)
      + (Rmin b c - Rmin (Rmin a b) c) + lead c a b) by each_order.
    unfold turn_error, sum, u in *. clear - I L E1 F1 Gc1 T Ha Hb Hc. apply Rabs_le. lra.
Qed.
End Octant.
