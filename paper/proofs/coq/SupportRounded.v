(* The support of an or-DOP as f32 arithmetic finds it: it exceeds that of a direction near the
   given one, but for five roundings. Any underflow is included. *)
From Coq Require Import Reals Bool List Lra.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Pose Duality Vectors Rounded SupportParts.
Import ListNotations.
Open Scope R_scope.

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
Let sum : R := a + b + c.
Let far : R := Rabs p + Rabs q + Rabs r.
Let supported : R -> Prop := SupportParts.supported a b c p q r.
Let combine_support := SupportParts.combine_support a b c p q r.
Let half_near := SupportParts.half_near m Hm.
Let lead_error := SupportParts.lead_error m Hm.
Let minimum_error := SupportParts.minimum_error m.
Let low_below := SupportParts.low_below m a b c Ha Hb.
Let far_sums := SupportParts.far_sums p q r.
Let leads_cover := SupportParts.leads_cover m Hm a b c p q r Ha Hb Hc x y z X Y Z.

Lemma supported_14 :
  0 <= straight /\ p + q + r <= straight -> 0 <= over_a /\ - p + q + r <= over_a ->
  0 <= over_b /\ p - q + r <= over_b -> 0 <= over_c /\ p + q - r <= over_c ->
  supported (rounded_14 m x y z straight over_a over_b over_c a b c).
Proof.
  intros S A B D. unfold rounded_14.
  pose proof tiny_value as T. pose proof tiny_small as T'.
  destruct (minimum_error a b Ha Hb) as (A0 & A1 & A2 & A3).
  destruct (minimum_error a c Ha Hc) as (B0 & B1 & B2 & B3).
  destruct (minimum_error b c Hb Hc) as (C0 & C1 & C2 & C3).
  cbv zeta in *. set (ab := least m a b) in *. set (ac := least m a c) in *.
  set (bc := least m b c) in *.
  pose proof (least_near m ab c (Rmin a b) c tiny A3 (exact_here c tiny ltac:(lra))) as L.
  destruct (least_below m ab c A0 Hc) as (L0 & L1 & L2).
  destruct low_below as (La & Lb). cbv zeta in La, Lb. fold ab ac bc in La, Lb.
  pose proof (most_near m ab ac _ _ tiny A3 B3) as M1.
  assert (C3' : Rabs (bc - Rmin b c) <= tiny + tiny) by lra.
  pose proof (most_near m _ bc _ _ _ M1 C3') as M2.
  assert (M0 : 0 <= most m (most m ab ac) bc <= sum).
  { pose proof (read_nonneg m ab A0). pose proof (read_nonneg m ac B0).
    pose proof (read_nonneg m bc C0). pose proof (most_nonneg m ab) as Q.
    assert (W : 0 <= most m ab ac <= a + b + c)
      by (unfold most, Rmax; destruct Rle_dec; lra).
    pose proof (read_nonneg m _ (proj1 W)). unfold sum.
    unfold most at 1 3. unfold Rmax. destruct Rle_dec; lra. }
  set (low := least m ab c) in *. set (median := most m (most m ab ac) bc) in *.
  set (Low := Rmin (Rmin a b) c) in *.
  set (Median := Rmax (Rmax (Rmin a b) (Rmin a c)) (Rmin b c)) in *.
  assert (Orders : 0 <= Low /\ 0 <= Median /\ Median + Low <= sum /\ Rmin a b <= sum /\
    Rmin a c <= sum /\ Rmin b c <= sum /\ Low <= Rmin a b /\ Low <= Rmin a c /\ Low <= Rmin b c).
  { unfold Low, Median, sum. repeat split; each_order. }
  destruct Orders as (O1 & O2 & O3 & O4 & O5 & O6 & O7 & O8 & O9).
  assert (Base : 0 <= mul m (/ 2) (add m median low) /\
    Rabs (mul m (/ 2) (add m median low) - / 2 * (Median + Low)) <= 1.6 * (u * sum) + 10 * tiny).
  { split; [apply mul_nonneg; [lra | apply add_nonneg; lra] |].
    pose proof (add_of_near m Hm median low Median Low _ _ (2 * sum) M2 L) as N.
    specialize (N ltac:(rewrite Rabs_pos_eq; unfold sum in *; lra)).
    pose proof (half_near _ _ _ N) as H. rewrite (Rabs_pos_eq (Median + Low)) in H by lra.
    unfold u, sum in *. lra. }
  assert (Bend : forall w W, 0 <= w -> w <= sum -> low <= w -> Rabs (w - W) <= tiny -> Low <= W ->
    W <= sum -> 0 <= mul m (/ 2) (sub m w low) /\
    Rabs (mul m (/ 2) (sub m w low) - / 2 * (W - Low)) <= 1.04 * (u * sum) + 7 * tiny).
  { intros w W P0 P1 P2 P3 P4 P5. split; [apply mul_nonneg; [lra | apply sub_nonneg; lra] |].
    pose proof (sub_of_near m Hm w low W _ _ _ sum P3 L) as N. unfold sum in *.
    specialize (N ltac:(apply Rabs_le; lra)).
    pose proof (half_near _ _ _ N) as H. rewrite (Rabs_pos_eq (W - Low)) in H by lra.
    unfold u in *. lra. }
  destruct (Bend ab _ A0 ltac:(unfold sum; lra) L1 A3 O7 O4) as (D0 & D1).
  destruct (Bend ac _ B0 ltac:(unfold sum; lra) La B3 O8 O5) as (E0 & E1).
  destruct (Bend bc _ C0 ltac:(unfold sum; lra) Lb C3 O9 O6) as (F0 & F1). clear Bend.
  destruct Base as (H0 & H1).
  destruct (lead_error a b c Ha Hb Hc) as (Ga0 & Ga1).
  destruct (lead_error b a c Hb Ha Hc) as (Gb0 & Gb1).
  destruct (lead_error c a b Hc Ha Hb) as (Gc0 & Gc1).
  pose proof leads_cover as G.
  set (base := mul m (/ 2) (add m median low)) in *.
  set (dab := mul m (/ 2) (sub m ab low)) in *. set (dac := mul m (/ 2) (sub m ac low)) in *.
  set (dbc := mul m (/ 2) (sub m bc low)) in *.
  set (la' := lead_of m a b c) in *. set (lb' := lead_of m b a c) in *.
  set (lc' := lead_of m c a b) in *.
  pose proof (covers_mul m Hm base straight _ H0 (proj1 S) (proj2 S)) as P0.
  pose proof (covers_mul m Hm dab over_c _ D0 (proj1 D) (proj2 D)) as P1.
  pose proof (covers_mul m Hm dac over_b _ E0 (proj1 B) (proj2 B)) as P2.
  pose proof (covers_mul m Hm dbc over_a _ F0 (proj1 A) (proj2 A)) as P3.
  pose proof (covers_add m Hm 1 _ _ _ _ _ _ _ _ P1 P2 ltac:(lra) ltac:(lra) ltac:(lra)) as P4.
  pose proof (covers_add m Hm 2 _ _ _ _ _ _ _ _ P4 P3 ltac:(lra) ltac:(lra) ltac:(lra)) as P5.
  pose proof (covers_add m Hm 3 _ _ _ _ _ _ _ _ P0 P5 ltac:(lra) ltac:(lra) ltac:(lra)) as P6.
  pose proof (covers_add m Hm 4 _ _ _ _ _ _ _ _ P6 G ltac:(lra) ltac:(lra) ltac:(lra)) as C.
  pose proof far_sums as (_ & _ & _ & K4 & K5 & K6 & K7).
  apply Rabs_le_inv in D1, E1, F1, H1, Ga1, Gb1, Gc1.
  apply (combine_support _ _ _ _ (base + dab + dac - dbc + la') (base + dab - dac + dbc + lb')
    (base - dab + dac + dbc + lc') C); [lra | | | | |].
  - pose proof (Rabs_pos (p + q + r)).
    assert (Q : forall i j k, 0 <= i -> 0 <= j -> 0 <= k -> lead i j k <= i)
      by (intros; unfold lead, Rmax; repeat destruct Rle_dec; lra).
    pose proof (Q a b c Ha Hb Hc). pose proof (Q b a c Hb Ha Hc). pose proof (Q c a b Hc Ha Hb).
    unfold sum in *. clear - H H2 H3 H4 D1 E1 F1 H1 Ga1 Gb1 Gc1 K4 K5 K6 K7 T T' Ha Hb Hc
      O1 O3 O4 O5 O6.
    unfold u in *. lra.
  - pose proof (positive_part base (p + q + r) H0). pose proof (positive_part dab (p + q - r) D0).
    pose proof (positive_part dac (p - q + r) E0).
    pose proof (positive_part dbc (- p + q + r) F0).
    pose proof (positive_part la' p Ga0). pose proof (positive_part lb' q Gb0).
    pose proof (positive_part lc' r Gc0). lra.
  - assert (I : a = / 2 * (Median + Low) + / 2 * (Rmin a b - Low) + / 2 * (Rmin a c - Low)
      - / 2 * (Rmin b c - Low) + lead a b c) by (unfold Median, Low; each_order).
    unfold turn_error, sum, u in *. clear - I H1 D1 E1 F1 Ga1 T Ha Hb Hc. apply Rabs_le. lra.
  - assert (I : b = / 2 * (Median + Low) + / 2 * (Rmin a b - Low) - / 2 * (Rmin a c - Low)
      + / 2 * (Rmin b c - Low) + lead b a c) by (unfold Median, Low; each_order).
    unfold turn_error, sum, u in *. clear - I H1 D1 E1 F1 Gb1 T Ha Hb Hc. apply Rabs_le. lra.
  - assert (I : c = / 2 * (Median + Low) - / 2 * (Rmin a b - Low) + / 2 * (Rmin a c - Low)
      + / 2 * (Rmin b c - Low) + lead c a b) by (unfold Median, Low; each_order).
    unfold turn_error, sum, u in *. clear - I H1 D1 E1 F1 Gc1 T Ha Hb Hc. apply Rabs_le. lra.
Qed.

(* The part of a coordinate that face diagonals take, and the rest. *)
Lemma part_error (i j l : R) :
  0 <= i -> 0 <= j -> 0 <= l ->
  let w := least m i (add m j l) in
  0 <= w /\ w <= i /\ Rabs (w - Rmin i (j + l)) <= u * (j + l) + 5 * tiny /\
  0 <= sub m i w /\ Rabs (sub m i w - (i - Rmin i (j + l))) <= u * (i + j + l) + 9 * tiny.
Proof.
  intros I J L w. pose proof tiny_value as T.
  assert (P : 0 <= add m j l) by (now apply add_nonneg).
  destruct (least_below m i (add m j l) I P) as (W0 & W1 & _). fold w in W0, W1.
  pose proof (add_near m Hm j l) as A. rewrite (Rabs_pos_eq (j + l)) in A by lra.
  assert (Pd : 0 <= u * (j + l) + 4 * tiny) by (unfold u; lra).
  pose proof (least_near m i _ i _ _ (exact_here i _ Pd) A) as E. fold w in E.
  assert (E' : Rabs (w - Rmin i (j + l)) <= u * (j + l) + 5 * tiny) by lra.
  repeat split; [exact W0 | exact W1 | exact E' | apply sub_nonneg; lra |].
  pose proof (sub_of_near m Hm i w i _ 0 _ i (exact_here i 0 ltac:(lra)) E'
    ltac:(rewrite Rabs_pos_eq; lra)). unfold u in *. lra.
Qed.

Lemma supported_18 :
  0 <= xy /\ p + q <= xy -> 0 <= xz /\ p + r <= xz -> 0 <= yz /\ q + r <= yz ->
  supported (rounded_18 m x y z xy xz yz a b c).
Proof.
  intros XY XZ YZ. unfold rounded_18.
  pose proof tiny_value as T. pose proof tiny_small as T'.
  destruct (part_error a b c Ha Hb Hc) as (A0 & A1 & A2 & A3 & A4).
  destruct (part_error b a c Hb Ha Hc) as (B0 & B1 & B2 & B3 & B4).
  destruct (part_error c a b Hc Ha Hb) as (C0 & C1 & C2 & C3 & C4).
  cbv zeta in *. set (ca := least m a (add m b c)) in *. set (cb := least m b (add m a c)) in *.
  set (cc := least m c (add m a b)) in *.
  set (CA := Rmin a (b + c)) in *. set (CB := Rmin b (a + c)) in *.
  set (CC := Rmin c (a + b)) in *.
  assert (Orders : 0 <= CA <= a /\ 0 <= CB <= b /\ 0 <= CC <= c).
  { unfold CA, CB, CC. repeat split; each_order. }
  destruct Orders as (O1 & O2 & O3).
  assert (Part : forall f g h F G H i j l, i + j + l <= sum -> 0 <= i -> 0 <= j -> 0 <= l ->
    0 <= f <= i -> 0 <= g <= j -> 0 <= h <= l -> 0 <= F <= i -> 0 <= G <= j -> 0 <= H <= l ->
    Rabs (f - F) <= u * (j + l) + 5 * tiny -> Rabs (g - G) <= u * (i + l) + 5 * tiny ->
    Rabs (h - H) <= u * (i + j) + 5 * tiny ->
    let d := most m (mul m (/ 2) (sub m (add m f g) h)) 0 in
    0 <= d /\ Rabs (d - Rmax (/ 2 * (F + G - H)) 0) <= 2.6 * (u * sum) + 20 * tiny).
  { intros f g h F G H i j l Hs I J L Rf Rg Rh RF RG RH Ef Eg Eh d.
    split; [apply most_nonneg |].
    pose proof (add_of_near m Hm f g F G _ _ (i + j) Ef Eg ltac:(rewrite Rabs_pos_eq; lra)) as N1.
    pose proof N1 as N1'. apply Rabs_le_inv in N1'.
    pose proof (add_nonneg m f g ltac:(lra) ltac:(lra)) as N0.
    assert (Bound : Rabs (add m f g - h) <= 1.001 * sum + 20 * tiny)
      by (apply Rabs_le; unfold u in *; lra).
    pose proof (sub_of_near m Hm _ h (F + G) H _ _ _ N1 Eh Bound) as N2.
    pose proof (half_near _ _ _ N2) as N3.
    assert (Size : Rabs (F + G - H) <= sum) by (apply Rabs_le; lra).
    assert (N4 : Rabs (mul m (/ 2) (sub m (add m f g) h) - / 2 * (F + G - H))
      <= 2.6 * (u * sum) + 19 * tiny) by (unfold u in *; lra).
    assert (Pd : 0 <= 2.6 * (u * sum) + 19 * tiny) by (unfold u, sum in *; lra).
    pose proof (most_near m _ 0 _ 0 _ N4 (exact_here 0 _ Pd)) as N5. fold d in N5. lra. }
  destruct (Part ca cb cc CA CB CC a b c ltac:(unfold sum; lra) Ha Hb Hc ltac:(lra) ltac:(lra)
    ltac:(lra) O1 O2 O3 A2 B2 C2) as (D0 & D1).
  assert (C2' : Rabs (cc - CC) <= u * (a + b) + 5 * tiny) by exact C2.
  destruct (Part ca cc cb CA CC CB a c b ltac:(unfold sum; lra) Ha Hc Hb ltac:(lra) ltac:(lra)
    ltac:(lra) O1 O3 O2 ltac:(rewrite (Rplus_comm c b); exact A2) C2 B2) as (E0 & E1).
  destruct (Part cb cc ca CB CC CA b c a ltac:(unfold sum; lra) Hb Hc Ha ltac:(lra) ltac:(lra)
    ltac:(lra) O2 O3 O1 ltac:(rewrite (Rplus_comm c a); exact B2)
    ltac:(rewrite (Rplus_comm b a); exact C2) A2) as (F0 & F1). clear Part.
  cbv zeta in *.
  set (dab := most m (mul m (/ 2) (sub m (add m ca cb) cc)) 0) in *.
  set (dac := most m (mul m (/ 2) (sub m (add m ca cc) cb)) 0) in *.
  set (dbc := most m (mul m (/ 2) (sub m (add m cb cc) ca)) 0) in *.
  set (la' := sub m a ca) in *. set (lb' := sub m b cb) in *. set (lc' := sub m c cc) in *.
  pose proof (covers_mul m Hm dab xy _ D0 (proj1 XY) (proj2 XY)) as P1.
  pose proof (covers_mul m Hm dac xz _ E0 (proj1 XZ) (proj2 XZ)) as P2.
  pose proof (covers_mul m Hm dbc yz _ F0 (proj1 YZ) (proj2 YZ)) as P3.
  pose proof (covers_dot m (pt la' lb' lc') (pt x y z) p q r Hm A3 B3 C3 (proj1 X) (proj1 Y)
    (proj1 Z) (proj2 X) (proj2 Y) (proj2 Z)) as G. unfold pt in G. cbn [px py pz] in G.
  pose proof (covers_add m Hm 1 _ _ _ _ _ _ _ _ P1 P2 ltac:(lra) ltac:(lra) ltac:(lra)) as P4.
  pose proof (covers_add m Hm 2 _ _ _ _ _ _ _ _ P4 P3 ltac:(lra) ltac:(lra) ltac:(lra)) as P5.
  pose proof (covers_add m Hm 3 _ _ _ _ _ _ _ _ P5 G ltac:(lra) ltac:(lra) ltac:(lra)) as C.
  pose proof far_sums as (K1 & K2 & K3 & _).
  apply Rabs_le_inv in D1, E1, F1, A4, B4, C4.
  apply (combine_support _ _ _ _ (dab + dac + la') (dab + dbc + lb') (dac + dbc + lc') C);
    [lra | | | | |].
  - pose proof (Rabs_pos (p + q)).
    assert (Q : forall f g h, 0 <= f -> 0 <= g -> 0 <= h -> Rmax (/ 2 * (f + g - h)) 0 <= f + g)
      by (intros; unfold Rmax; destruct Rle_dec; lra).
    pose proof (Q CA CB CC (proj1 O1) (proj1 O2) (proj1 O3)).
    pose proof (Q CA CC CB (proj1 O1) (proj1 O3) (proj1 O2)).
    pose proof (Q CB CC CA (proj1 O2) (proj1 O3) (proj1 O1)).
    unfold far, sum in *. clear - H H0 H1 H2 D1 E1 F1 A4 B4 C4 K1 K2 K3 T T' Ha Hb Hc O1 O2 O3.
    unfold u in *. lra.
  - pose proof (positive_part dab (p + q) D0). pose proof (positive_part dac (p + r) E0).
    pose proof (positive_part dbc (q + r) F0). pose proof (positive_part la' p A3).
    pose proof (positive_part lb' q B3). pose proof (positive_part lc' r C3). lra.
  - assert (I : a = Rmax (/ 2 * (CA + CB - CC)) 0 + Rmax (/ 2 * (CA + CC - CB)) 0 + (a - CA))
      by (unfold CA, CB, CC; each_order).
    unfold turn_error, sum, u in *. clear - I D1 E1 A4 T Ha Hb Hc. apply Rabs_le. lra.
  - assert (I : b = Rmax (/ 2 * (CA + CB - CC)) 0 + Rmax (/ 2 * (CB + CC - CA)) 0 + (b - CB))
      by (unfold CA, CB, CC; each_order).
    unfold turn_error, sum, u in *. clear - I D1 F1 B4 T Ha Hb Hc. apply Rabs_le. lra.
  - assert (I : c = Rmax (/ 2 * (CA + CC - CB)) 0 + Rmax (/ 2 * (CB + CC - CA)) 0 + (c - CC))
      by (unfold CA, CB, CC; each_order).
    unfold turn_error, sum, u in *. clear - I E1 F1 C4 T Ha Hb Hc. apply Rabs_le. lra.
Qed.
End Octant.

(* The slabs hold a point with a margin to spare along each of their normals, and none ends before
   the centre. *)
Definition holds_with (margin : R) (k : kind) (s : slabs) (z : point) : Prop :=
  forall member, In member (members k) ->
    dot (direction member) z + margin * norm (direction member) <= fst (s member) /\
    - dot (direction member) z + margin * norm (direction member) <= snd (s member) /\
    0 <= fst (s member) /\ 0 <= snd (s member).

Lemma turned_sign (negative : bool) (x w : R) :
  sign_of negative x ->
  Rabs ((if negative then - w else w) - x) = Rabs (w - Rabs x).
Proof.
  destruct negative; cbn; intro H; [rewrite (Rabs_left1 x) by exact H | now rewrite (Rabs_pos_eq
    x)].
  replace (- w - x) with (- (w - - x)) by ring. apply Rabs_Ropp.
Qed.

Lemma turned_abs (negative : bool) (v : R) : Rabs (if negative then - v else v) = Rabs v.
Proof. destruct negative; [apply Rabs_Ropp | reflexivity]. Qed.

Theorem support_rounded (m : mode) (k : kind) (s : slabs) (signs : bool * bool * bool)
    (e z : point) :
  valid m -> signs_of signs e -> holds_with 0 k s z ->
  let sum := Rabs (px e) + Rabs (py e) + Rabs (pz e) in
  let far := Rabs (px z) + Rabs (py z) + Rabs (pz z) in
  0 <= support_of m k s signs e /\
  exists e', norm (minus e' e) <= 1.73206 * turn_error sum /\
    dot e' z * (1 - 5 * u) - lost sum far <= support_of m k s signs e.
Proof.
  intros Hm. destruct signs as [[i j] l]. intros (I & J & L) H sum far.
  assert (A : 0 <= Rabs (px e)) by apply Rabs_pos. assert (B : 0 <= Rabs (py e)) by apply Rabs_pos.
  assert (C : 0 <= Rabs (pz e)) by apply Rabs_pos.
  set (p := if i then - px z else px z). set (q := if j then - py z else py z).
  set (r := if l then - pz z else pz z).
  assert (Sup : supported (Rabs (px e)) (Rabs (py e)) (Rabs (pz e)) p q r
    (support_of m k s (i, j, l) e)).
  { unfold support_of, pair, facing, end_of, p, q, r.
    destruct k;
      [apply supported_6 | apply supported_14 | apply supported_18 | apply supported_26];
      try assumption; clear I J L;
      destruct i, j, l; cbn [xorb negb Nat.add];
      lazymatch goal with
      | |- 0 <= fst (s ?m) /\ _ => destruct (H m ltac:(cbn; tauto)) as (F & _ & P & _)
      | |- 0 <= snd (s ?m) /\ _ => destruct (H m ltac:(cbn; tauto)) as (_ & F & _ & P)
      end;
      unfold dot, direction, directions, pt in F; cbn [nth map px py pz] in F; lra. }
  destruct Sup as (P & a' & b' & c' & Ea & Eb & Ec & G). split; [exact P |].
  exists (pt (if i then - a' else a') (if j then - b' else b') (if l then - c' else c')).
  unfold turn_error, lost in *. fold sum in Ea, Eb, Ec, G. split.
  - pose proof tiny_value. apply norm_same; [unfold u, sum in *; lra | | |]; cbn [px py pz pt];
      rewrite turned_sign by assumption; assumption.
  - unfold p, q, r in G. rewrite !turned_abs in G. fold far in G.
    replace (dot (pt (if i then - a' else a') (if j then - b' else b') (if l then - c' else c')) z)
      with (a' * (if i then - px z else px z) + b' * (if j then - py z else py z)
        + c' * (if l then - pz z else pz z)); [exact G |].
    unfold dot, pt. cbn [px py pz]. destruct i, j, l; ring.
Qed.
