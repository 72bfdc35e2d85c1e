(* Theorem S for stored balls: the sphere test rejects no two balls that meet. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry.
Open Scope R_scope.

(* src/rounding/sphere.rs: RADIUS_FACTOR, RADIUS_FLOOR *)
Definition radius_factor : R := 1 + 8 * u.
Definition radius_floor : R := / IZR (2 ^ 70).

(* src/rounding/sphere.rs: inflate_radius *)
Definition inflate_radius (m : mode) (r : R) : R := add m (mul m r radius_factor) radius_floor.

(* src/rounding/sphere.rs: apart *)
Definition apart (m : mode) (dx dy dz s : R) : bool :=
  greater m (add m (add m (mul m dx dx) (mul m dy dy)) (mul m dz dz)) (mul m s s).

(* src/broad_phase/slot_test.rs: hits_of, with src/overlap/sphere.rs: Spheres::apart. Of the balls
   in slots, the radius is the inflated one. *)
Definition rejects (m : mode) (one other : ball) : bool :=
  let (a, b) := (centre one, centre other) in
  apart m (sub m (px b) (px a)) (sub m (py b) (py a)) (sub m (pz b) (pz a))
    (add m (radius one) (radius other)).

(* src/update/frame.rs: ShapeFrame::sphere, from the centre and the radius of a world ball *)
Definition inflated (m : mode) (b : ball) : ball :=
  {| centre := centre b; radius := inflate_radius m (radius b) |}.

(* In numbers that lra can compare: 2^-70 = 2^56 * 2^-126. *)
Lemma floor_value : radius_floor = 72057594037927936 * tiny.
Proof.
  unfold radius_floor, tiny. change (2 ^ 126)%Z with (72057594037927936 * 2 ^ 70)%Z.
  rewrite mult_IZR. field. now apply IZR_neq.
Qed.

Lemma tiny_square : tiny = IZR (2 ^ 126) * (tiny * tiny).
Proof. unfold tiny. field. now apply IZR_neq. Qed.

Lemma inflate_below (m : mode) (a : R) :
  valid m -> 0 <= a ->
  a * ((1 + 8 * u) * ((1 - u) * (1 - u))) + radius_floor * (1 - 2 * u) <= inflate_radius m a.
Proof.
  intros Hm Ha. rewrite floor_value. pose proof tiny_value as Ht. unfold inflate_radius, add, mul.
  assert (Hk : read m radius_factor = radius_factor).
  { apply read_large. unfold radius_factor, u, tiny. lra. }
  assert (Hf : read m radius_floor = radius_floor).
  { apply read_large. rewrite floor_value. lra. }
  rewrite Hk, Hf, floor_value.
  pose proof (read_nonneg m a Ha) as Ha'. pose proof (read_error m a) as He.
  apply Rabs_le_inv in He.
  set (a' := read m a) in *.
  assert (Hp : 0 <= a' * radius_factor).
  { apply Rmult_le_pos; [lra |]. unfold radius_factor, u. lra. }
  pose proof (fl_below m Hm _ Hp) as Hb. pose proof (fl_nonneg m _ Hp) as Hn.
  set (p := fl m (a' * radius_factor)) in *.
  pose proof (read_nonneg m p Hn) as Hp'. pose proof (read_error m p) as He'.
  apply Rabs_le_inv in He'.
  set (p' := read m p) in *.
  assert (Hs : 0 <= p' + 72057594037927936 * tiny) by lra.
  pose proof (fl_below m Hm _ Hs) as Hr.
  set (result := fl m (p' + 72057594037927936 * tiny)) in *.
  unfold radius_factor, u in *. lra.
Qed.

(* The sum of two inflated radii exceeds that of the radii by 4u and nearly two floors. *)
Lemma sum_below (m ma mb : mode) (a b : R) :
  valid m -> valid ma -> valid mb -> 0 <= a -> 0 <= b ->
  (a + b) * (1 + 4 * u) + radius_floor * (2 - 8 * u)
    <= add m (inflate_radius ma a) (inflate_radius mb b).
Proof.
  intros Hm Hma Hmb Ha Hb. unfold add.
  pose proof (inflate_below ma a Hma Ha) as Ia. pose proof (inflate_below mb b Hmb Hb) as Ib.
  set (ra := inflate_radius ma a) in *. set (rb := inflate_radius mb b) in *.
  rewrite floor_value in *. pose proof tiny_value as Ht.
  assert (Hra : tiny <= ra) by (unfold u in Ia; lra).
  assert (Hrb : tiny <= rb) by (unfold u in Ib; lra).
  rewrite (read_large m ra Hra), (read_large m rb Hrb).
  assert (Hs : 0 <= ra + rb) by lra.
  pose proof (fl_below m Hm _ Hs) as H. set (s := fl m (ra + rb)) in *.
  unfold u in *. lra.
Qed.

Lemma difference_above (m : mode) (a b : R) :
  Rabs (sub m a b) <= (Rabs (a - b) + 3 * tiny) * (1 + u).
Proof.
  unfold sub. pose proof (fl_above m (read m a - read m b)) as H.
  pose proof (read_error m a) as Ha. pose proof (read_error m b) as Hb.
  pose proof half_step_value as Hh. pose proof tiny_value as Ht.
  assert (Hd : Rabs (read m a - read m b) <= Rabs (a - b) + 2 * tiny).
  { replace (read m a - read m b) with ((a - b) + ((read m a - a) - (read m b - b))) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat_l.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra. }
  unfold u in *. lra.
Qed.

Lemma read_square (m : mode) (d e : R) :
  Rabs d <= e -> 0 <= read m d * read m d <= e * e.
Proof.
  intro Hd. pose proof (read_abs m d) as Hr. set (d' := read m d) in *.
  split; [apply Rle_0_sqr |]. rewrite <- (Rabs_pos_eq (d' * d')) by apply Rle_0_sqr.
  rewrite Rabs_mult. pose proof (Rabs_pos d'). apply Rmult_le_compat; lra.
Qed.

Lemma square_above (m : mode) (d e : R) :
  Rabs d <= e -> 0 <= mul m d d <= e * e * (1 + u) + half_step.
Proof.
  intro Hd. pose proof (read_square m d e Hd) as Hs. unfold mul.
  pose proof (fl_above m (read m d * read m d)) as H.
  pose proof (fl_nonneg m _ (proj1 Hs)) as Hn.
  rewrite !Rabs_pos_eq in H by tauto. split; [exact Hn |]. unfold u in *. lra.
Qed.

Lemma add_above (m : mode) (a b : R) :
  0 <= a -> 0 <= b -> 0 <= add m a b <= (a + b) * (1 + u) + half_step.
Proof.
  intros Ha Hb. unfold add.
  pose proof (read_nonneg m a Ha). pose proof (read_nonneg m b Hb).
  assert (Hs : 0 <= read m a + read m b) by lra.
  pose proof (fl_above m (read m a + read m b)) as H'. pose proof (fl_nonneg m _ Hs).
  rewrite !Rabs_pos_eq in H' by tauto. unfold u in *. lra.
Qed.

(* What the test leaves room for beyond the radii; posing balls takes no more than the slack. *)
Definition room : R := radius_floor / 4.

Lemma room_value : room = 18014398509481984 * tiny.
Proof. unfold room. rewrite floor_value. lra. Qed.

Lemma slack_in_room : 0 <= slack <= room.
Proof. rewrite room_value. pose proof tiny_value. unfold slack. lra. Qed.

Section Decision.
Variable m : mode.
Hypothesis Hm : valid m.
(* The exact differences, the differences as computed and the sum of the radii as computed. *)
Variables X Y Z dx dy dz P s : R.
Hypothesis Hx : Rabs dx <= (Rabs X + 3 * tiny) * (1 + u).
Hypothesis Hy : Rabs dy <= (Rabs Y + 3 * tiny) * (1 + u).
Hypothesis Hz : Rabs dz <= (Rabs Z + 3 * tiny) * (1 + u).
Hypothesis HP : 0 <= P.
Hypothesis Hmeet : X * X + Y * Y + Z * Z <= (P + room) * (P + room).
Hypothesis Hs : P * (1 + 4 * u) + radius_floor * (2 - 8 * u) <= s.

Let d2 := add m (add m (mul m dx dx) (mul m dy dy)) (mul m dz dz).

Lemma coordinate (W : R) : W * W <= (P + room) * (P + room) -> Rabs W <= P + room.
Proof.
  intro H. pose proof tiny_value. rewrite <- (Rabs_pos_eq (P + room)) by (rewrite room_value; lra).
  now apply Rsqr_le_abs_0.
Qed.

Lemma coordinates : Rabs X <= P + room /\ Rabs Y <= P + room /\ Rabs Z <= P + room.
Proof.
  pose proof (Rle_0_sqr X). pose proof (Rle_0_sqr Y). pose proof (Rle_0_sqr Z). unfold Rsqr in *.
  repeat split; apply coordinate; lra.
Qed.

Lemma sum_large : tiny <= s.
Proof.
  pose proof tiny_value. rewrite floor_value in Hs. unfold u in Hs. lra.
Qed.

Lemma squares_above :
  0 <= d2 <= ((P + room) * (P + room) + 18 * tiny * (P + room) + 27 * (tiny * tiny))
               * (1 + 6 * u) + 8 * half_step.
Proof.
  pose proof coordinates as (Ix & Iy & Iz).
  pose proof (square_above m dx _ Hx) as Sx. pose proof (square_above m dy _ Hy) as Sy.
  pose proof (square_above m dz _ Hz) as Sz.
  pose proof (add_above m _ _ (proj1 Sx) (proj1 Sy)) as Sxy.
  pose proof (add_above m _ _ (proj1 Sxy) (proj1 Sz)) as Sxyz. fold d2 in Sxyz.
  split; [tauto |].
  assert (Hsum : (Rabs X + 3 * tiny) * (Rabs X + 3 * tiny)
      + (Rabs Y + 3 * tiny) * (Rabs Y + 3 * tiny) + (Rabs Z + 3 * tiny) * (Rabs Z + 3 * tiny)
      <= (P + room) * (P + room) + 18 * tiny * (P + room) + 27 * (tiny * tiny)).
  { assert (E : forall W, (Rabs W + 3 * tiny) * (Rabs W + 3 * tiny)
        = W * W + 6 * (tiny * Rabs W) + 9 * (tiny * tiny)).
    { intro W. pose proof (Rsqr_abs W) as A. unfold Rsqr in A. rewrite A. ring. }
    rewrite !E. pose proof tiny_value as Ht.
    assert (tiny * Rabs X <= tiny * (P + room)) by (apply Rmult_le_compat_l; lra).
    assert (tiny * Rabs Y <= tiny * (P + room)) by (apply Rmult_le_compat_l; lra).
    assert (tiny * Rabs Z <= tiny * (P + room)) by (apply Rmult_le_compat_l; lra).
    lra. }
  pose proof (Rle_0_sqr (Rabs X + 3 * tiny)) as Qx.
  pose proof (Rle_0_sqr (Rabs Y + 3 * tiny)) as Qy.
  pose proof (Rle_0_sqr (Rabs Z + 3 * tiny)) as Qz. unfold Rsqr in Qx, Qy, Qz.
  assert (F : forall q, (q * (1 + u)) * (q * (1 + u)) = (q * q) * ((1 + u) * (1 + u)))
    by (intro; ring).
  rewrite F in Sx, Sy, Sz.
  pose proof half_step_value as Hh. pose proof tiny_value.
  set (qx := (Rabs X + 3 * tiny) * (Rabs X + 3 * tiny)) in *.
  set (qy := (Rabs Y + 3 * tiny) * (Rabs Y + 3 * tiny)) in *.
  set (qz := (Rabs Z + 3 * tiny) * (Rabs Z + 3 * tiny)) in *.
  set (bound := (P + room) * (P + room) + 18 * tiny * (P + room) + 27 * (tiny * tiny)) in *.
  clearbody qx qy qz bound.
  apply Rle_trans with ((qx + qy + qz) * (1 + 6 * u) + 8 * half_step);
    unfold u in *; lra.
Qed.

Lemma not_flushed : threshold m <= s * s -> d2 <= mul m s s.
Proof.
  intro H. unfold mul. rewrite (read_large m s sum_large).
  pose proof (fl_kept m Hm _ H) as Ht. pose proof squares_above as Hd.
  apply Rle_trans with (1 := proj2 Hd). apply Rle_trans with (2 := Ht).
  pose proof tiny_value as Hw. pose proof tiny_square as Hw2. pose proof half_step_value as Hh.
  rewrite floor_value in Hs.
  set (lower := P * (1 + 4 * u) + 72057594037927936 * tiny * (2 - 8 * u)) in *.
  assert (Hl : 0 <= lower).
  { unfold lower, u. lra. }
  assert (Hss : lower * lower <= s * s) by (apply Rmult_le_compat; lra).
  apply Rle_trans with (lower * lower * (1 - u) - half_step); [| unfold u in *; lra].
  unfold lower, u. rewrite room_value.
  assert (0 <= P * P) by apply Rle_0_sqr.
  assert (0 <= P * tiny) by (apply Rmult_le_pos; lra).
  assert (0 <= tiny * tiny) by apply Rle_0_sqr.
  lra.
Qed.

(* Where s * s is flushed, so is each square of a difference. *)
Lemma difference_less (W dw : R) :
  s * s < threshold m -> Rabs W <= P + room -> Rabs dw <= (Rabs W + 3 * tiny) * (1 + u) ->
  Rabs dw < s.
Proof.
  intros Hf HW Hd. pose proof tiny_value as Hw. pose proof Hm as Ht. unfold valid in Ht.
  assert (Hb : s <= 16777216 * radius_floor).
  { apply Rnot_lt_le. intro Hn. rewrite floor_value in Hn. pose proof tiny_square as Hw2.
    assert (16777216 * (72057594037927936 * tiny)
      * (16777216 * (72057594037927936 * tiny)) <= s * s)
      by (apply Rmult_le_compat; lra).
    pose proof (Rle_0_sqr tiny) as Hq. unfold Rsqr in Hq. lra. }
  rewrite room_value, floor_value in *. unfold u in *. lra.
Qed.

Lemma square_flushed (dw : R) : s * s < threshold m -> Rabs dw < s -> mul m dw dw = 0.
Proof.
  intros Hf Hd. pose proof (read_square m dw s (Rlt_le _ _ Hd)) as H. unfold mul.
  apply fl_flushed. rewrite Rabs_pos_eq; lra.
Qed.

Lemma flushed : s * s < threshold m -> d2 = 0.
Proof.
  intro H. pose proof coordinates as (Ix & Iy & Iz). unfold d2.
  rewrite !square_flushed by eauto using difference_less.
  assert (E : add m 0 0 = 0).
  { unfold add. destruct (read_cases m 0) as [-> | [_ ->]]; rewrite Rplus_0_l;
      apply fl_flushed; rewrite Rabs_R0; pose proof (Rle_0_sqr s) as Q; unfold Rsqr in Q; lra. }
  now rewrite !E.
Qed.

Lemma decision : apart m dx dy dz s = false.
Proof.
  pose proof squares_above as [Hd _]. apply not_greater. fold d2. split; [exact Hd |].
  destruct (Rlt_or_le (s * s) (threshold m)) as [H | H].
  - rewrite (flushed H). unfold mul. apply fl_nonneg. apply Rle_0_sqr.
  - now apply not_flushed.
Qed.
End Decision.

(* Balls that come within that of each other are not rejected. m is the mode of the test, ma
   and mb those in which the radii were inflated. *)
Theorem near_balls_not_rejected (m ma mb : mode) (a b : ball) :
  valid m -> valid ma -> valid mb -> 0 <= radius a -> 0 <= radius b ->
  distance (centre a) (centre b) <= radius a + radius b + room ->
  rejects m (inflated ma a) (inflated mb b) = false.
Proof.
  intros Hm Hma Hmb Ha Hb H. unfold rejects, inflated. cbn.
  set (way := minus (centre b) (centre a)).
  apply decision with (X := px way) (Y := py way) (Z := pz way) (P := radius a + radius b);
    try apply difference_above; try assumption.
  - lra.
  - change (square way <= (radius a + radius b + room) * (radius a + radius b + room)).
    rewrite <- norm_square. pose proof (norm_nonneg way). now apply Rmult_le_compat.
  - now apply sum_below.
Qed.

(* Stored balls that the test rejects have no common point. *)
Theorem stored_balls_disjoint (m ma mb : mode) (a b : ball) :
  valid m -> valid ma -> valid mb -> 0 <= radius a -> 0 <= radius b ->
  rejects m (inflated ma a) (inflated mb b) = true ->
  forall p, ~ (in_ball p a /\ in_ball p b).
Proof.
  intros Hm Hma Hmb Ha Hb Hr p [Pa Pb]. pose proof (balls_meet p a b Pa Pb) as H.
  rewrite near_balls_not_rejected in Hr; try assumption; [discriminate |].
  pose proof slack_in_room. lra.
Qed.
