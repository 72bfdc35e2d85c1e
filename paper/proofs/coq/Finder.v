(* Theorem F: a pair that the sphere test reports lies within the finders' widened radii, along each
   axis. With gradual underflow. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double WorldBall Sphere Ieee Shows Grid Outward.
Open Scope R_scope.

Lemma nearest32_below (x : R) : 0 <= x -> x * (1 - u) - half_step <= nearest32 x.
Proof.
  intro H. pose proof (nearest32_error x) as E. rewrite (Rabs_pos_eq x) in E by exact H.
  apply Rabs_le_inv in E. lra.
Qed.

Lemma nearest32_above (x : R) : 0 <= x -> nearest32 x <= x * (1 + u) + half_step.
Proof.
  intro H. pose proof (nearest32_error x) as E. rewrite (Rabs_pos_eq x) in E by exact H.
  apply Rabs_le_inv in E. lra.
Qed.

Lemma gradual_add (x y : R) : add gradual x y = nearest32 (x + y).
Proof. unfold add. now rewrite gradual_fl. Qed.
Lemma gradual_sub (x y : R) : sub gradual x y = nearest32 (x - y).
Proof. unfold sub. now rewrite gradual_fl. Qed.
Lemma gradual_mul (x y : R) : mul gradual x y = nearest32 (x * y).
Proof. unfold mul. now rewrite gradual_fl. Qed.

(* One square of a sum of three is no more than the sum, but for rounding. *)
Lemma square_within (dx dy dz d : R) :
  d = dx \/ d = dy \/ d = dz ->
  d * d * (1 - 3 * u) - 4 * half_step
    <= add gradual (add gradual (mul gradual dx dx) (mul gradual dy dy)) (mul gradual dz dz).
Proof.
  intro H. rewrite !gradual_add, !gradual_mul. pose proof (proj1 half_step_value) as P.
  pose proof (Rle_0_sqr dx) as X. pose proof (Rle_0_sqr dy) as Y. pose proof (Rle_0_sqr dz) as Z.
  unfold Rsqr in *.
  pose proof (nearest32_nonneg _ X) as NX. pose proof (nearest32_nonneg _ Y) as NY.
  pose proof (nearest32_nonneg _ Z) as NZ.
  pose proof (nearest32_below _ X) as BX. pose proof (nearest32_below _ Y) as BY.
  pose proof (nearest32_below _ Z) as BZ.
  set (x := nearest32 (dx * dx)) in *. set (y := nearest32 (dy * dy)) in *.
  set (z := nearest32 (dz * dz)) in *.
  assert (XY : 0 <= x + y) by lra.
  pose proof (nearest32_below _ XY) as BXY. pose proof (nearest32_nonneg _ XY) as NXY.
  set (xy := nearest32 (x + y)) in *. assert (XYZ : 0 <= xy + z) by lra.
  pose proof (nearest32_below _ XYZ) as B. set (xyz := nearest32 (xy + z)) in *.
  destruct H as [-> | [-> | ->]]; unfold u in *; lra.
Qed.

(* In numbers that lra can compare: a quarter of the product of the floors 2^-70 and 2^-78 exceeds
   every amount that underflow takes. *)
Lemma floors_product : 16 * half_step <= radius_floor * finder_floor * (1025 / 1024 * 4).
Proof.
  unfold half_step, radius_floor, finder_floor.
  replace (IZR (2 ^ 150)) with (4 * (IZR (2 ^ 70) * IZR (2 ^ 78)))
    by (rewrite <- !mult_IZR; reflexivity).
  set (a := IZR (2 ^ 70)). set (b := IZR (2 ^ 78)).
  assert (0 < a) by (apply IZR_lt; reflexivity). assert (0 < b) by (apply IZR_lt; reflexivity).
  replace (/ (4 * (a * b))) with (/ 4 * / (a * b)) by (field; lra).
  replace (/ a * / b) with (/ (a * b)) by (field; lra).
  assert (0 < / (a * b)) by (apply Rinv_0_lt_compat; now apply Rmult_lt_0_compat). lra.
Qed.

(* What isn't rejected, along an axis, for radii that are no less than most of a floor each. *)
Lemma reported_near (dx dy dz D P s : R) :
  radius_floor <= P -> s <= P * (1 + u) + half_step -> 0 <= s ->
  D = Rabs dx \/ D = Rabs dy \/ D = Rabs dz ->
  apart gradual dx dy dz s = false -> D <= P * (1 + 4 * u) + finder_floor * 15 / 8.
Proof.
  intros HP Hs Ps HD Ha. apply Rnot_lt_le. intro Hn.
  unfold apart, greater in Ha. revert Ha. rewrite !read_is. case Rlt_bool_spec; [discriminate |].
  intros Ha _. revert Ha. apply Rlt_not_le.
  pose proof (proj1 half_step_value) as H0. pose proof floors_product as K.
  rewrite finder_floor_value in *. rewrite floor_value in *. pose proof tiny_value as T.
  pose proof (proj2 half_step_value) as HT.
  assert (L : D * D * (1 - 3 * u) - 4 * half_step <=
    add gradual (add gradual (mul gradual dx dx) (mul gradual dy dy)) (mul gradual dz dz)).
  { assert (E : exists d, D * D = d * d /\ (d = dx \/ d = dy \/ d = dz)).
    { destruct HD as [-> | [-> | ->]]; [exists dx | exists dy | exists dz];
        (split; [| tauto]; symmetry; apply Rsqr_abs). }
    destruct E as (d & -> & E). now apply square_within. }
  apply Rlt_le_trans with (2 := L). rewrite gradual_mul.
  assert (S : s * s <= (P * (1 + u) + half_step) * (P * (1 + u) + half_step))
    by (apply Rmult_le_compat; lra).
  pose proof (nearest32_above (s * s) (Rle_0_sqr s)) as N.
  apply Rle_lt_trans with (1 := N).
  set (G := 281474976710656 * tiny) in *. set (F := 72057594037927936 * tiny) in *.
  assert (G0 : 0 < G) by (unfold G; lra). assert (F0 : 0 < F) by (unfold F; lra).
  set (low := P * (1 + 4 * u) + G * 15 / 8) in *.
  assert (P0 : 0 <= P) by lra.
  assert (D2 : low * low <= D * D).
  { assert (0 <= low) by (unfold low, u; lra). apply Rmult_le_compat; lra. }
  assert (PG : F * G <= P * G) by (apply Rmult_le_compat_r; lra).
  assert (PH : P * half_step <= P * G / 1000000).
  { unfold Rdiv. rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra |]. unfold G. lra. }
  assert (HH : half_step * half_step <= P * half_step).
  { apply Rmult_le_compat_r; [lra |]. apply Rle_trans with (2 := HP). unfold F. lra. }
  assert (PP : 0 <= P * P) by (apply Rmult_le_pos; lra).
  assert (GG : 0 <= G * G) by (apply Rmult_le_pos; lra).
  assert (PG0 : 0 <= P * G) by (apply Rmult_le_pos; lra).
  unfold low, u in *. lra.
Qed.

Lemma gradually_valid64 : valid64 gradual64.
Proof. unfold valid64. cbn. pose proof tiny64_value. lra. Qed.

Lemma difference_below (a b : R) : Rabs (b - a) * (1 - u) - half_step <= Rabs (sub gradual b a).
Proof.
  rewrite gradual_sub. pose proof (nearest32_error (b - a)) as E.
  pose proof (Rabs_triang_inv (b - a) (nearest32 (b - a))) as T.
  rewrite (Rabs_minus_sym (b - a)) in T. lra.
Qed.

Lemma widen_above_factor (r : R) :
  radius_floor / 2 <= r <= IZR (2 ^ 200) ->
  r * (1 + 15 * u) + finder_floor * 1023 / 1024 <= Grid.widen gradual gradual64 r.
Proof.
  intros [H B]. pose proof (up_outward (mul64 gradual64 r finder_factor + finder_floor)) as U.
  change (fl64 gradual64 (mul64 gradual64 r finder_factor + finder_floor))
    with (add64 gradual64 (mul64 gradual64 (read gradual r) finder_factor) finder_floor) in U.
  change (next_above _) with (Grid.widen gradual gradual64 r) in U.
  apply Rle_trans with (2 := U). pose proof tiny_value as T. rewrite finder_floor_value.
  rewrite floor_value in H. pose proof dust_root_value as (D0 & _ & D2 & D3).
  assert (V64 : valid64 gradual64) by apply gradually_valid64.
  assert (B1 : Rabs r <= big).
  { rewrite Rabs_pos_eq by lra. apply Rle_trans with (1 := B). now apply IZR_le. }
  assert (F : 1 <= finder_factor <= 2) by (unfold finder_factor, u; lra).
  assert (B2 : Rabs finder_factor <= big).
  { rewrite Rabs_pos_eq by lra. apply Rle_trans with 2; [lra |]. now apply IZR_le. }
  pose proof (mul64_error gradual64 V64 _ _ B1 B2) as M.
  assert (P0 : 0 <= r * finder_factor) by (apply Rmult_le_pos; lra).
  rewrite (Rabs_pos_eq (r * finder_factor)) in M by exact P0. apply Rabs_le_inv in M.
  pose proof v_value as V. unfold finder_factor, u, v in *. lra.
Qed.

(* With inflated radii, each at least half of the floor. *)
Lemma reported_with_room (a b : ball) (axis : nat) :
  radius_floor / 2 <= radius a -> radius_floor / 2 <= radius b ->
  rejects gradual a b = false ->
  Rabs (coordinate_of axis (centre b) - coordinate_of axis (centre a))
    <= (radius a + radius b) * (1 + 6 * u) + finder_floor * 31 / 16.
Proof.
  intros Ha Hb H. pose proof tiny_value as T.
  pose proof half_step_value as [S0 S1].
  unfold rejects in H. set (dx := sub gradual (px (centre b)) (px (centre a))) in *.
  set (dy := sub gradual (py (centre b)) (py (centre a))) in *.
  set (dz := sub gradual (pz (centre b)) (pz (centre a))) in *.
  set (P := radius a + radius b) in *.
  assert (HP : radius_floor <= P) by (unfold P; lra).
  pose proof HP as HP'. rewrite floor_value in HP'.
  assert (Sum : add gradual (radius a) (radius b) <= P * (1 + u) + half_step).
  { rewrite gradual_add. apply nearest32_above. fold P. lra. }
  assert (Pos : 0 <= add gradual (radius a) (radius b)).
  { rewrite gradual_add. apply nearest32_nonneg. fold P. lra. }
  set (D := Rabs (sub gradual (coordinate_of axis (centre b)) (coordinate_of axis (centre a)))).
  assert (HD : D = Rabs dx \/ D = Rabs dy \/ D = Rabs dz).
  { unfold D. destruct axis as [| [| axis]]; cbn; tauto. }
  pose proof (reported_near dx dy dz D P _ HP Sum Pos HD H) as N.
  pose proof (difference_below (coordinate_of axis (centre a)) (coordinate_of axis (centre b))) as E.
  fold D in E.
  set (X := Rabs (coordinate_of axis (centre b) - coordinate_of axis (centre a))) in *.
  rewrite finder_floor_value in *. unfold u in *. lra.
Qed.

(* Theorem F. *)
Theorem reported_within_reach (a b : ball) (axis : nat) :
  radius_floor / 2 <= radius a <= IZR (2 ^ 200) -> radius_floor / 2 <= radius b <= IZR (2 ^ 200) ->
  rejects gradual a b = false ->
  Rabs (coordinate_of axis (centre b) - coordinate_of axis (centre a))
    <= Grid.widen gradual gradual64 (radius a) + Grid.widen gradual gradual64 (radius b).
Proof.
  intros Ha Hb H. pose proof (widen_above_factor _ Ha). pose proof (widen_above_factor _ Hb).
  pose proof (reported_with_room a b axis (proj1 Ha) (proj1 Hb) H). pose proof tiny_value.
  rewrite finder_floor_value in *. rewrite floor_value in *. unfold u in *. lra.
Qed.
