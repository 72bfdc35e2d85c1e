(* Theorem Q against posed bodies: a body whose mesh, grown by its margin, shares a point with a
   query's ball, box or line isn't left out. With gradual underflow. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Ieee Shows Cells Outward.
From Sdop Require Import Finder Duality Vectors Norms64 OrDopTest Query InBody.
Import ListNotations.
Open Scope R_scope.

Local Notation g := gradual64.

(* src/rounding/query.rs: QUERY_ERROR, slack *)
Definition query_error : R := 256 * v.
Definition slack_of (size : R) : R := add64 g (mul64 g size query_error) query_floor.

(* src/posed/mod.rs: QueryShape::of, PosedShape::slabs. A slab has its direction, its length and its
   ends. *)
Record slab := { normal : point; length : R; low : R; high : R }.
Record solid := { slabs : list slab; middle : point; ball_radius : R; reach : R; turn : quaternion;
                  place : point; margin : R }.

(* src/posed/mod.rs: PosedShape::size *)
Definition size_of (b : solid) : R := add64 g (reach b) (margin b).
Definition between_ends (s : slab) (out at_ : R) : bool :=
  let p := mul64 g (length s) out in
  Rle_bool at_ (add64 g (high s) p) && Rle_bool (sub64 g (low s) p) at_.

(* What `volume` builds, and a point of the mesh. *)
Definition sound_slab (s : slab) : Prop :=
  / 4 <= norm (normal s) <= 4 /\ Rabs (length s - norm (normal s)) <= 5 * v * norm (normal s).
Definition sound_solid (b : solid) : Prop :=
  sound_quaternion (turn b) /\ format_point (place b) /\ format_point (middle b) /\
  Forall sound_slab (slabs b) /\ 0 <= reach b /\ 0 <= margin b /\ norm (middle b) <= 2 * reach b.
Definition in_mesh (b : solid) (y : point) : Prop :=
  Forall (fun s => low s <= dot (normal s) y <= high s) (slabs b) /\ norm y <= reach b /\
  norm (minus y (middle b)) <= ball_radius b.
(* The mesh at its pose, grown by the margin. *)
Definition occupied (b : solid) (z : point) : Prop :=
  exists y, in_mesh b y /\ distance z (posed (turn b) (place b) y) <= margin b.

Lemma at_most (x y : R) : Rle_bool x y = true -> x <= y.
Proof. case Rle_bool_spec; [trivial | discriminate]. Qed.

Lemma floor_small : 0 < query_floor /\ 1000000 * tiny64 <= query_floor.
Proof. destruct floor_exceeds as (A & B). split; [lra | exact B]. Qed.

Lemma add_least (x y : R) : 0 <= x -> 0 <= y -> (x + y) * (1 - v) - tiny64 <= add64 g x y.
Proof.
  intros X Y. unfold add64. rewrite !read64_is. pose proof (rounded64 (x + y)) as E.
  rewrite (Rabs_pos_eq (x + y)) in E by lra. apply Rabs_le_inv in E. lra.
Qed.
Lemma mul_least (x y : R) : 0 <= x -> 0 <= y -> x * y * (1 - v) - tiny64 <= mul64 g x y.
Proof.
  intros X Y. unfold mul64. rewrite !read64_is. pose proof (rounded64 (x * y)) as E.
  rewrite (Rabs_pos_eq (x * y)) in E by now apply Rmult_le_pos. apply Rabs_le_inv in E. lra.
Qed.
Lemma add_positive (x y : R) : 0 <= x -> 0 <= y -> 0 <= add64 g x y.
Proof. intros. unfold add64. rewrite !read64_is. apply fl64_nonneg. lra. Qed.
Lemma mul_positive (x y : R) : 0 <= x -> 0 <= y -> 0 <= mul64 g x y.
Proof. intros. unfold mul64. rewrite !read64_is. apply fl64_nonneg. now apply Rmult_le_pos. Qed.

(* Sums of margins (A) and of all sizes (S), and the distance by which slabs move out. *)
Definition moves_out (A S out : R) : Prop := 0 <= A <= S /\ A + 250 * v * S + query_floor / 2 <= out.

Lemma out_above (a s A S : R) :
  0 <= a -> 0 <= s -> 0 <= A <= S -> A * (1 - 3 * v) - 4 * tiny64 <= a ->
  S * (1 - 9 * v) - 9 * tiny64 <= s -> moves_out A S (add64 g a (slack_of s)).
Proof.
  intros Pa Ps (PA & AS) Ha Hs. split; [lra |]. pose proof v_value as V.
  pose proof floor_small as (F & T). pose proof (proj1 tiny64_value) as T0.
  assert (Q : 0 <= query_error) by (unfold query_error; lra).
  pose proof (mul_least s query_error Ps Q) as M. pose proof (mul_positive s query_error Ps Q) as PM.
  pose proof (add_least _ query_floor PM ltac:(lra)) as L.
  pose proof (add_positive _ query_floor PM ltac:(lra)) as PL. fold (slack_of s) in L, PL.
  pose proof (add_least a (slack_of s) Pa PL) as O.
  apply Rle_trans with (2 := O). unfold query_error in *.
  set (m := mul64 g s (256 * v)) in *. set (k := slack_of s) in *. clearbody m k.
  replace (s * (256 * v)) with (256 * (v * s)) in M by ring.
  assert (VS : v * (S * (1 - 9 * v) - 9 * tiny64) <= v * s) by (apply Rmult_le_compat_l; lra).
  replace (250 * v * S) with (250 * (v * S)) by ring.
  replace (v * (S * (1 - 9 * v) - 9 * tiny64)) with (v * S * (1 - 9 * v) - 9 * (v * tiny64)) in VS by ring.
  assert (v * tiny64 <= 1 * tiny64) by (apply Rmult_le_compat_r; unfold v; lra).
  assert (v * A <= v * S) by (apply Rmult_le_compat_l; lra).
  assert (0 <= v * A) by (apply Rmult_le_pos; lra).
  set (vs := v * S) in *. set (vx := v * s) in *. clearbody vs vx. unfold v in *. lra.
Qed.

(* By how much an end moves. *)
Lemma ends_move (s : slab) (A S out : R) :
  sound_slab s -> moves_out A S out ->
  norm (normal s) * (A + 240 * v * S) + 1000 * tiny64 <= mul64 g (length s) out.
Proof.
  intros (N & L) ((PA & AS) & O). pose proof v_value as V. pose proof floor_small as (Fl & T).
  pose proof (proj1 tiny64_value) as T0.
  set (n := norm (normal s)) in *. set (l := length s) in *.
  apply Rabs_le_inv in L. assert (Pl : 0 <= l) by (unfold v in *; lra).
  assert (PS : 0 <= 250 * v * S) by (apply Rmult_le_pos; lra).
  pose proof (mul_least l out Pl ltac:(lra)) as M. set (p := mul64 g l out) in *.
  apply Rle_trans with (2 := M).
  assert (B : n * (1 - 5 * v) * (A + 250 * v * S + query_floor / 2) <= l * out)
    by (apply Rmult_le_compat; unfold v in *; lra).
  assert (C : n * (A + 240 * v * S) + query_floor / 20
    <= n * (1 - 5 * v) * (A + 250 * v * S + query_floor / 2) * (1 - v)).
  { replace (n * (1 - 5 * v) * (A + 250 * v * S + query_floor / 2) * (1 - v))
      with (n * ((1 - 5 * v) * (1 - v) * (A + 250 * v * S + query_floor / 2))) by ring.
    assert (D : A + 240 * v * S + query_floor / 5
      <= (1 - 5 * v) * (1 - v) * (A + 250 * v * S + query_floor / 2)).
    { assert (v * A <= v * S) by (apply Rmult_le_compat_l; lra).
      assert (0 <= v * A) by (apply Rmult_le_pos; lra).
      replace (250 * v * S) with (250 * (v * S)) by ring.
      replace (240 * v * S) with (240 * (v * S)) by ring. set (vs := v * S) in *.
      replace (A + 240 * vs + query_floor / 5) with (A + 240 * vs + query_floor / 5) by ring.
      replace ((1 - 5 * v) * (1 - v)) with (1 - (6 * v - 5 * v * v)) by ring.
      assert (K : 0 <= 6 * v - 5 * v * v <= 6 * v) by (unfold v in *; lra).
      set (k := 6 * v - 5 * v * v) in *. clearbody k.
      assert (k * A <= 6 * v * A) by (apply Rmult_le_compat_r; lra).
      assert (k * (250 * vs + query_floor / 2) <= 0.001 * (250 * vs + query_floor / 2))
        by (apply Rmult_le_compat_r; unfold v in *; lra).
      lra. }
    apply (Rmult_le_compat_l n) in D; [| lra].
    assert (/ 4 * (query_floor / 5) <= n * (query_floor / 5)) by (apply Rmult_le_compat_r; lra).
    lra. }
  assert (B' : n * (1 - 5 * v) * (A + 250 * v * S + query_floor / 2) * (1 - v) <= l * out * (1 - v))
    by (apply Rmult_le_compat_r; [unfold v; lra | exact B]).
  lra.
Qed.

(* What is between the ends but for roundings is taken to be so. *)
Lemma ends_hold (s : slab) (A S out at_ X : R) :
  sound_slab s -> moves_out A S out -> format64 at_ ->
  low s - norm (normal s) * A <= X <= high s + norm (normal s) * A ->
  Rabs (at_ - X) <= norm (normal s) * (240 * v * S) + 1000 * tiny64 ->
  between_ends s out at_ = true.
Proof.
  intros Sl O F H E. pose proof (ends_move s A S out Sl O) as G.
  set (n := norm (normal s)) in *. set (p := mul64 g (length s) out) in *.
  apply Rabs_le_inv in E.
  assert (Keep : fl64 g at_ = at_).
  { rewrite gradual_fl64. apply round_generic; [typeclasses eauto | exact F]. }
  unfold between_ends. fold p. apply andb_true_intro. split; apply Rle_bool_true.
  - unfold add64. rewrite !read64_is. rewrite <- Keep. apply fl64_monotone. lra.
  - unfold sub64. rewrite !read64_is. rewrite <- Keep. apply fl64_monotone. lra.
Qed.

(* The ball about the mesh, which is no farther from its centre than three times the reach. *)
Lemma ball_holds (b : solid) (y : point) (A S out : R) :
  sound_solid b -> in_mesh b y -> moves_out A S out -> reach b <= S ->
  norm (minus y (middle b)) + A + 200 * v * S + query_floor / 4 <= add64 g (ball_radius b) out /\
  0 <= ball_radius b.
Proof.
  intros (_ & _ & _ & _ & R0 & _ & C) (_ & Y & B) ((PA & AS) & O) RS.
  pose proof v_value as V. pose proof floor_small as (F & T). pose proof (proj1 tiny64_value) as T0.
  pose proof (norm_nonneg (minus y (middle b))) as P.
  assert (PS : 0 <= v * S) by (apply Rmult_le_pos; lra).
  assert (Near : norm (minus y (middle b)) <= 3 * reach b).
  { replace (minus y (middle b)) with (plus y (opposite (middle b)))
      by (unfold plus, opposite, minus, pt; cbn [px py pz]; f_equal; ring).
    apply Rle_trans with (1 := triangle _ _). rewrite norm_opposite. lra. }
  replace (250 * v * S) with (250 * (v * S)) in O by ring.
  replace (200 * v * S) with (200 * (v * S)) by ring.
  split; [| lra].
  pose proof (add_least (ball_radius b) out ltac:(lra) ltac:(lra)) as L.
  apply Rle_trans with (2 := L).
  assert (v * A <= v * S) by (apply Rmult_le_compat_l; lra).
  assert (v * reach b <= v * S) by (apply Rmult_le_compat_l; lra).
  assert (O' : (A + 250 * (v * S) + query_floor / 2) * (1 - v) <= out * (1 - v))
    by (apply Rmult_le_compat_r; [unfold v; lra | exact O]).
  assert (0 <= v * A) by (apply Rmult_le_pos; lra).
  assert (Vo : A + 248 * (v * S) + query_floor / 3 <= out * (1 - v)).
  { apply Rle_trans with (2 := O'). set (vs := v * S) in *. clearbody vs. unfold v in *. lra. }
  destruct (Rle_or_lt (ball_radius b) (4 * reach b)) as [Small | Large].
  - assert (v * ball_radius b <= v * (4 * reach b)) by (apply Rmult_le_compat_l; lra). lra.
  - assert (4 * reach b * (1 - v) <= ball_radius b * (1 - v))
      by (apply Rmult_le_compat_r; unfold v in *; lra).
    lra.
Qed.

Lemma row_format (a p : point) : format64 (rotate_row g a p).
Proof. apply format64_result. Qed.

Lemma dot_far (d x : point) (a : R) : norm x <= a -> - (norm d * a) <= dot d x <= norm d * a.
Proof.
  intro H. pose proof (dot_norms d x) as D. apply Rabs_le_inv in D.
  assert (norm d * norm x <= norm d * a) by (apply Rmult_le_compat_l; [apply norm_nonneg | exact H]).
  lra.
Qed.

Lemma norm_reversed (a b : point) : norm (minus a b) = norm (minus b a).
Proof. exact (distance_symmetric b a). Qed.

(* A difference of places turned into a body's frame, and its distance along a slab's direction. *)
Lemma turned_back_near (q : quaternion) (w d : point) :
  sound_quaternion q -> norm (minus w d) <= 1.001 * v * norm w ->
  let x := apply (transposed (exact_rotation q)) d in
  norm (minus (turned_back (rotation_of g q) w) x) <= 58.4 * v * largest w + 11 * tiny64 /\
  norm x <= 1.73208 * largest w.
Proof.
  intros Q D x. pose proof v_value as V. destruct (largest_above w) as (W0 & _ & W1).
  pose proof (into_body_near _ Q w d D) as E. fold x in E.
  assert (G : v * norm w <= v * (1.73206 * largest w)) by (apply Rmult_le_compat_l; lra).
  assert (0 <= v * largest w) by (apply Rmult_le_pos; lra).
  split; [lra |]. unfold x. rewrite back_norm by exact Q.
  rewrite norm_reversed in D. pose proof (norm_difference d w). unfold v in *. lra.
Qed.

Lemma slab_seen (d seen x : point) (far : R) :
  norm d <= 4 -> 0 <= far -> norm (minus seen x) <= 58.4 * v * far + 11 * tiny64 ->
  norm x <= 1.73208 * far ->
  Rabs (rotate_row g d seen - dot d x) <= norm d * (64 * v * far) + 100 * tiny64.
Proof.
  intros N F E X. pose proof v_value as V. pose proof (proj1 tiny64_value) as T0.
  pose proof (norm_nonneg d) as N0.
  pose proof (dot_rounded d seen) as R1. pose proof (dot_change d seen x) as R2.
  pose proof (norm_difference seen x) as K. set (n := norm d) in *.
  assert (Ns : norm seen <= 1.7321 * far + 11 * tiny64) by (unfold v in *; lra).
  replace (rotate_row g d seen - dot d x)
    with ((rotate_row g d seen - dot d seen) + (dot d seen - dot d x)) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _).
  assert (G1 : n * norm seen <= n * (1.7321 * far + 11 * tiny64)) by (apply Rmult_le_compat_l; lra).
  apply (Rmult_le_compat_l v) in G1; [| lra].
  assert (G2 : n * norm (minus seen x) <= n * (58.4 * v * far + 11 * tiny64))
    by (apply Rmult_le_compat_l; lra).
  assert (G4 : n * tiny64 <= 4 * tiny64) by (apply Rmult_le_compat_r; lra).
  assert (G5 : v * (n * tiny64) <= 0.001 * (4 * tiny64)).
  { apply Rmult_le_compat; [lra | apply Rmult_le_pos; lra | unfold v; lra | lra]. }
  assert (0 <= n * (v * far)) by (apply Rmult_le_pos; [lra | apply Rmult_le_pos; lra]). lra.
Qed.

(* What a rotation and its reverse do to differences. *)
Lemma back_of_posed (q : quaternion) (t y p : point) :
  sound_quaternion q ->
  norm (minus (apply (transposed (exact_rotation q)) (minus p t)) y) = norm (minus p (posed q t y)).
Proof.
  intro Q. replace y with (apply (transposed (exact_rotation q)) (apply (exact_rotation q) y)) at 1
    by now apply back_inverts.
  replace (minus (apply _ _) (apply _ _)) with (apply (transposed (exact_rotation q))
    (minus p (posed q t y)))
    by (unfold posed, plus, minus, apply, dot, pt; cbn [px py pz]; f_equal; ring).
  now rewrite back_norm.
Qed.

Lemma norm_of_three (a b c : point) (x y z : point) :
  a = plus x (plus y z) -> norm a <= norm x + norm y + norm z.
Proof.
  intros ->. apply Rle_trans with (1 := triangle _ _). pose proof (triangle y z). lra.
Qed.

(* src/posed/mod.rs: PosedShape::may_touch_ball *)
Definition may_touch_ball (b : solid) (p : point) (radius : R) : bool :=
  let r := rotation_of g (turn b) in
  let w := seen_from p (place b) in
  let seen := turned_back r w in
  let out := add64 g (add64 g (margin b) radius)
    (slack_of (add64 g (add64 g (largest w) (size_of b)) radius)) in
  negb (is_beyond seen (middle b) (middle b) (add64 g (ball_radius b) out)) &&
  forallb (fun s => between_ends s out (rotate_row g (normal s) seen)) (slabs b).

Lemma moves_out_of_ball (b : solid) (far radius : R) :
  sound_solid b -> 0 <= far -> 0 <= radius ->
  moves_out (margin b + radius) (far + reach b + margin b + radius)
    (add64 g (add64 g (margin b) radius) (slack_of (add64 g (add64 g far (size_of b)) radius))).
Proof.
  intros (_ & _ & _ & _ & R0 & M0 & _) F P. pose proof v_value as V.
  pose proof (proj1 tiny64_value) as T.
  pose proof (add_least (reach b) (margin b) R0 M0) as L1. pose proof (add_positive _ _ R0 M0) as P1.
  fold (size_of b) in L1, P1.
  pose proof (add_least far (size_of b) F P1) as L2. pose proof (add_positive _ _ F P1) as P2.
  pose proof (add_least _ radius P2 P) as L3. pose proof (add_positive _ _ P2 P) as P3.
  pose proof (add_least _ _ M0 P) as L4. pose proof (add_positive _ _ M0 P) as P4.
  apply out_above; try lra.
  - assert (0 <= v * (margin b + radius)) by (apply Rmult_le_pos; lra). lra.
  - set (s1 := size_of b) in *. set (s2 := add64 g far s1) in *. set (s3 := add64 g s2 radius) in *.
    clearbody s1 s2 s3. unfold v in *. lra.
Qed.

Theorem balls_are_touched (b : solid) (p : point) (radius : R) (z : point) :
  sound_solid b -> format_point p -> 0 <= radius -> occupied b z -> distance z p <= radius ->
  may_touch_ball b p radius = true.
Proof.
  intros B Fp P (y & Y & D) Z. pose proof B as (Q & Ft & Fm & Sl & R0 & M0 & C).
  pose proof v_value as V. pose proof floor_small as (Fl & T). pose proof (proj1 tiny64_value) as T0.
  unfold may_touch_ball. set (w := seen_from p (place b)).
  destruct (largest_above w) as (W0 & _).
  destruct (turned_back_near _ w _ Q (seen_from_near p (place b) Fp Ft)) as (E & X1).
  pose proof (moves_out_of_ball b (largest w) radius B W0 P) as O.
  set (out := add64 g (add64 g (margin b) radius) _) in *.
  set (seen := turned_back (rotation_of g (turn b)) w) in *.
  set (far := largest w) in *. set (S := far + reach b + margin b + radius) in *.
  set (A := margin b + radius) in *.
  set (x := apply (transposed (exact_rotation (turn b))) (minus p (place b))) in *.
  (* The exact centre in the body's frame is within A of a point of the mesh. *)
  assert (X : norm (minus x y) <= A).
  { unfold x. rewrite back_of_posed by exact Q. rewrite distance_symmetric in D.
    replace (minus p (posed (turn b) (place b) y))
      with (plus (minus p z) (minus z (posed (turn b) (place b) y)))
      by (unfold plus, minus; cbn [px py pz]; f_equal; ring).
    apply Rle_trans with (1 := triangle _ _). unfold distance in D, Z. unfold A. lra. }
  assert (VS : 0 <= v * far <= v * S).
  { split; [apply Rmult_le_pos; lra | apply Rmult_le_compat_l; unfold S; lra]. }
  pose proof O as ((A0 & AS) & Po).
  apply andb_true_intro. split.
  - apply negb_true_iff. destruct Fm as (F0 & F1 & F2).
    destruct (ball_holds b y A S out B Y O ltac:(unfold S; lra)) as (H & R1).
    apply beyond_is_certain with (q := middle b); try assumption; try lra; try apply row_format.
    + apply add_positive; [exact R1 | lra].
    + apply Rle_trans with (2 := H). rewrite distance_symmetric. unfold distance.
      apply Rle_trans with (norm (minus seen x) + norm (minus x y) + norm (minus y (middle b)));
        [| lra].
      apply norm_of_three; try exact x.
      unfold plus, minus; cbn [px py pz]; f_equal; ring.
  - apply forallb_forall. intros s I. rewrite Forall_forall in Sl. specialize (Sl s I).
    destruct Y as (Y & _). rewrite Forall_forall in Y. specialize (Y s I). cbv beta in Y.
    apply (ends_hold s A S out _ (dot (normal s) x) Sl O (row_format _ _)).
    + pose proof (dot_far (normal s) (minus x y) A X) as F.
      replace (dot (normal s) (minus x y)) with (dot (normal s) x - dot (normal s) y) in F
        by (unfold dot, minus; cbn [px py pz]; ring). lra.
    + destruct Sl as (N & _). pose proof (slab_seen (normal s) seen x far ltac:(lra) W0 E X1) as L.
      assert (norm (normal s) * (v * far) <= norm (normal s) * (v * S))
        by (apply Rmult_le_compat_l; lra).
      assert (0 <= norm (normal s) * (v * S)) by (apply Rmult_le_pos; lra). lra.
Qed.

(* src/posed/mod.rs: PosedShape::may_touch_box *)
Definition lowest (e from to : point) : R :=
  let least a b c := Rmin (mul64 g a b) (mul64 g a c) in
  add64 g (add64 g (least (px e) (px from) (px to)) (least (py e) (py from) (py to)))
    (least (pz e) (pz from) (pz to)).
Definition highest (e from to : point) : R :=
  let most a b c := Rmax (mul64 g a b) (mul64 g a c) in
  add64 g (add64 g (most (px e) (px from) (px to)) (most (py e) (py from) (py to)))
    (most (pz e) (pz from) (pz to)).
Definition may_touch_box (b : solid) (lo hi : point) : bool :=
  let r := rotation_of g (turn b) in
  let (from, to) := (seen_from lo (place b), seen_from hi (place b)) in
  let out := add64 g (margin b)
    (slack_of (add64 g (Rmax (largest from) (largest to)) (size_of b))) in
  negb (is_beyond (turned r (middle b)) from to (add64 g (ball_radius b) out)) &&
  forallb (fun s =>
    let e := turned r (normal s) in
    let p := mul64 g (length s) out in
    Rle_bool (lowest e from to) (add64 g (high s) p) &&
    Rle_bool (sub64 g (low s) p) (highest e from to)) (slabs b).

Lemma add64_monotone (a b c d : R) : a <= c -> b <= d -> add64 g a b <= add64 g c d.
Proof. intros. unfold add64. rewrite !read64_is. apply fl64_monotone. lra. Qed.
Lemma mul64_order (a b c : R) : 0 <= a -> b <= c -> mul64 g a b <= mul64 g a c.
Proof. intros. unfold mul64. rewrite !read64_is. apply fl64_monotone. now apply Rmult_le_compat_l. Qed.
Lemma mul64_reversed (a b c : R) : a <= 0 -> b <= c -> mul64 g a c <= mul64 g a b.
Proof. intros. unfold mul64. rewrite !read64_is. apply fl64_monotone. now apply Rmult_le_compat_neg_l. Qed.

Lemma ends_of_products (a b c d : R) :
  b <= d <= c -> Rmin (mul64 g a b) (mul64 g a c) <= mul64 g a d
    <= Rmax (mul64 g a b) (mul64 g a c).
Proof.
  intros (L & H). destruct (Rle_or_lt 0 a) as [P | P].
  - split; [apply Rle_trans with (1 := Rmin_l _ _) | apply Rle_trans with (2 := Rmax_r _ _)];
      now apply mul64_order.
  - apply Rlt_le in P.
    split; [apply Rle_trans with (1 := Rmin_r _ _) | apply Rle_trans with (2 := Rmax_l _ _)];
      now apply mul64_reversed.
Qed.

Lemma ends_of_box (e from to x : point) :
  px from <= px x <= px to -> py from <= py x <= py to -> pz from <= pz x <= pz to ->
  lowest e from to <= rotate_row g e x <= highest e from to.
Proof.
  intros X Y Z. pose proof (ends_of_products (px e) _ _ _ X). pose proof (ends_of_products (py e) _ _ _ Y).
  pose proof (ends_of_products (pz e) _ _ _ Z). unfold lowest, highest, rotate_row.
  split; repeat apply add64_monotone; lra.
Qed.

Theorem boxes_are_touched (b : solid) (lo hi z : point) :
  sound_solid b -> format_point lo -> format_point hi -> occupied b z ->
  px lo <= px z <= px hi -> py lo <= py z <= py hi -> pz lo <= pz z <= pz hi ->
  may_touch_box b lo hi = true.
Proof.
  intros B Fl Fh (y & Y & D) Zx Zy Zz. pose proof B as (Q & Ft & Fm & Sl & R0 & M0 & C).
  pose proof v_value as V. pose proof floor_small as (F0 & T). pose proof (proj1 tiny64_value) as T0.
  unfold may_touch_box. set (from := seen_from lo (place b)). set (to := seen_from hi (place b)).
  set (far := Rmax (largest from) (largest to)).
  destruct (largest_above from) as (L0 & (Lx & Ly & Lz) & _).
  destruct (largest_above to) as (H0 & (Hx & Hy & Hz) & _).
  assert (Far : 0 <= far /\ largest from <= far /\ largest to <= far).
  { unfold far. pose proof (Rmax_l (largest from) (largest to)). pose proof (Rmax_r (largest from) (largest to)). lra. }
  destruct Far as (Far & FL & FH).
  (* The common point as f64 sees it from the body. *)
  set (x := minus z (place b)).
  set (c := pt (fl64 g (px x)) (fl64 g (py x)) (fl64 g (pz x))).
  assert (In : forall l k m t, l <= k <= m -> sub64 g l t <= fl64 g (k - t) <= sub64 g m t).
  { intros l k m t (H1 & H2). unfold sub64. rewrite !read64_is. split; apply fl64_monotone; lra. }
  pose proof (In _ _ _ (px (place b)) Zx) as Ix. pose proof (In _ _ _ (py (place b)) Zy) as Iy.
  pose proof (In _ _ _ (pz (place b)) Zz) as Iz. clear In.
  assert (Cf : norm c <= 1.73206 * far).
  { apply norm_of_coordinates. unfold within, c, pt. cbn [px py pz].
    set (lf := largest from) in *. set (lt := largest to) in *. clearbody far lf lt.
    apply Rabs_le_inv in Lx, Ly, Lz, Hx, Hy, Hz.
    unfold from, to, seen_from, pt in Lx, Ly, Lz, Hx, Hy, Hz.
    cbn [px py pz] in Lx, Ly, Lz, Hx, Hy, Hz. unfold x, minus. cbn [px py pz].
    repeat split; apply Rabs_le; lra. }
  assert (Cx : norm (minus c x) <= 1.001 * v * norm c + 2 * tiny64).
  { assert (K : norm (minus c x) <= v * norm x + 1.73206 * tiny64).
    { apply norm_shares; try lra; apply rounded64. }
    rewrite norm_reversed in K. pose proof (norm_difference x c) as G.
    pose proof (norm_nonneg c). rewrite norm_reversed. unfold v in *. lra. }
  assert (VC : v * norm c <= v * (1.73206 * far)) by (apply Rmult_le_compat_l; lra).
  pose proof (norm_nonneg c) as Pc.
  assert (PVC : 0 <= v * norm c) by (apply Rmult_le_pos; lra).
  destruct (rotation_near _ Q) as (Near & _).
  set (r := rotation_of g (turn b)) in *. set (e := exact_rotation (turn b)) in *.
  (* From the point of the mesh to the common one. *)
  assert (Xy : norm (minus x (apply e y)) <= margin b).
  { rewrite distance_symmetric in D. unfold distance in D. apply Rle_trans with (2 := D). right.
    f_equal. unfold x, e, posed, plus, minus; cbn [px py pz]. f_equal; ring. }
  pose proof (add_least (reach b) (margin b) R0 M0) as L1. pose proof (add_positive _ _ R0 M0) as P1.
  fold (size_of b) in L1, P1. pose proof (add_least far (size_of b) Far P1) as L2.
  pose proof (add_positive _ _ Far P1) as P2.
  set (S := far + reach b + margin b).
  assert (O : moves_out (margin b) S (add64 g (margin b) (slack_of (add64 g far (size_of b))))).
  { unfold S. apply out_above; try lra.
    - assert (0 <= v * margin b) by (apply Rmult_le_pos; lra). lra.
    - set (s1 := size_of b) in *. set (s2 := add64 g far s1) in *. clearbody s1 s2.
      unfold v in *. lra. }
  set (out := add64 g (margin b) _) in *.
  assert (VS : 0 <= v * far <= v * S).
  { split; [apply Rmult_le_pos; lra | apply Rmult_le_compat_l; unfold S; lra]. }
  assert (VR : 0 <= v * reach b <= v * S - v * far).
  { split; [apply Rmult_le_pos; lra |]. replace (v * S - v * far) with (v * (S - far)) by ring.
    apply Rmult_le_compat_l; unfold S; lra. }
  pose proof O as (_ & Po).
  apply andb_true_intro. split.
  - apply negb_true_iff.
    destruct (ball_holds b y (margin b) S out B Y O ltac:(unfold S; lra)) as (H & R1).
    apply beyond_is_certain with (q := c); try apply format64_result; try assumption.
    + apply add_positive; [exact R1 | lra].
    + apply Rle_trans with (2 := H). rewrite distance_symmetric. unfold distance.
      pose proof (turned_near r e (middle b) Near) as G.
      assert (G' : v * norm (middle b) <= v * (2 * reach b)) by (apply Rmult_le_compat_l; lra).
      apply Rle_trans with (norm (minus (turned r (middle b)) (apply e (middle b)))
        + norm (minus (apply e (middle b)) (apply e y)) + norm (minus (apply e y) c)).
      { apply norm_of_three; try exact x. unfold plus, minus; cbn [px py pz]; f_equal; ring. }
      assert (M : norm (minus (apply e (middle b)) (apply e y)) = norm (minus y (middle b))).
      { rewrite norm_reversed. replace (minus (apply e y) (apply e (middle b)))
          with (apply e (minus y (middle b)))
          by (unfold minus, apply, dot, pt; cbn [px py pz]; f_equal; ring).
        unfold e. now apply turned_norm. }
      assert (K : norm (minus (apply e y) c) <= norm (minus x (apply e y)) + norm (minus c x)).
      { rewrite (norm_reversed x), (norm_reversed c). replace (minus (apply e y) c)
          with (plus (minus (apply e y) x) (minus x c))
          by (unfold plus, minus; cbn [px py pz]; f_equal; ring). apply triangle. }
      rewrite M. lra.
  - apply forallb_forall. intros s I. rewrite Forall_forall in Sl. specialize (Sl s I).
    destruct Y as (Y & _). rewrite Forall_forall in Y. specialize (Y s I). cbv beta in Y.
    pose proof Sl as (N & _). set (n := norm (normal s)) in *.
    pose proof (turned_near r e (normal s) Near) as G. fold n in G.
    set (d := turned r (normal s)) in *.
    assert (Ed : norm (apply e (normal s)) = n) by (unfold e; now apply turned_norm).
    assert (Tn : tiny64 <= / 1000000 * (v * n)).
    { pose proof tiny64_dust. pose proof small_share as (_ & Sh).
      assert (dust <= v / 1000000 / 1000000).
      { unfold dust, v, Rdiv. rewrite <- !Rinv_mult, <- !mult_IZR.
        apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
      assert (v * / 4 <= v * n) by (apply Rmult_le_compat_l; lra). lra. }
    assert (E : Rabs (rotate_row g d c - dot (apply e (normal s)) x)
      <= n * (240 * v * S) + 1000 * tiny64).
    { pose proof (dot_rounded d c) as E1. pose proof (dot_change c d (apply e (normal s))) as E2.
      rewrite (dot_swap c d), (dot_swap c) in E2.
      pose proof (dot_change (apply e (normal s)) c x) as E3. rewrite Ed in E3.
      assert (Nd : norm d <= 1.001 * n).
      { pose proof (norm_difference d (apply e (normal s))). unfold v in *. lra. }
      replace (rotate_row g d c - dot (apply e (normal s)) x) with ((rotate_row g d c - dot d c)
        + ((dot d c - dot (apply e (normal s)) c) + (dot (apply e (normal s)) c
        - dot (apply e (normal s)) x))) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _).
      pose proof (Rabs_triang (dot d c - dot (apply e (normal s)) c)
        (dot (apply e (normal s)) c - dot (apply e (normal s)) x)).
      assert (G1 : norm d * norm c <= 1.001 * n * norm c) by (apply Rmult_le_compat_r; lra).
      apply (Rmult_le_compat_l v) in G1; [| lra].
      assert (G2 : norm c * norm (minus d (apply e (normal s))) <= norm c * (32.7 * (v * n)))
        by (apply Rmult_le_compat_l; lra).
      assert (G3 : n * norm (minus c x) <= n * (1.001 * v * norm c + 2 * tiny64))
        by (apply Rmult_le_compat_l; lra).
      assert (G4 : n * tiny64 <= 4 * tiny64) by (apply Rmult_le_compat_r; lra).
      assert (G5 : n * (v * norm c) <= n * (1.73206 * (v * S))) by (apply Rmult_le_compat_l; lra).
      assert (0 <= n * (v * S)) by (apply Rmult_le_pos; lra). lra. }
    assert (K : between_ends s out (rotate_row g d c) = true).
    { apply (ends_hold s (margin b) S out _ _ Sl O (row_format _ _)) with (2 := E).
      fold n. pose proof (dot_far (apply e (normal s)) (minus x (apply e y)) _ Xy) as F.
      rewrite Ed in F. replace (dot (apply e (normal s)) (minus x (apply e y)))
        with (dot (apply e (normal s)) x - dot (apply e (normal s)) (apply e y)) in F
        by (unfold dot, minus; cbn [px py pz]; ring).
      assert (Dk : dot (apply e (normal s)) (apply e y) = dot (normal s) y)
        by (apply OrDopPose.rotation_keeps_dot; now apply sound_positive).
      rewrite Dk in F.
      lra. }
    destruct (ends_of_box d from to c Ix Iy Iz) as (B1 & B2).
    unfold between_ends in K. apply andb_true_iff in K. destruct K as (K1 & K2).
    apply at_most in K1. apply at_most in K2.
    apply andb_true_intro. split; apply Rle_bool_true; lra.
Qed.
