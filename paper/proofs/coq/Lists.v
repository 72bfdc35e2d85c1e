(* Theorem K: a list that was made of balls grown by a skin holds every pair that the sphere test
   reports later, as long as each ball stays within its skin. With gradual underflow. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double WorldBall Sphere Ieee Shows Grid Outward Finder.
Open Scope R_scope.

(* 2^-60 and 2^-56 *)
Definition skin_floor : R := / IZR (2 ^ 60).
Definition reach_floor : R := / IZR (2 ^ 56).

Lemma skin_floor_value : skin_floor = 1024 * radius_floor /\ reach_floor = 16 * skin_floor.
Proof.
  unfold skin_floor, reach_floor, radius_floor.
  change (2 ^ 70)%Z with (1024 * 2 ^ 60)%Z. change (2 ^ 60)%Z with (16 * 2 ^ 56)%Z.
  rewrite !mult_IZR. split; field; now apply IZR_neq.
Qed.

(* The sum of three squares that the tests compute, from the differences that they compute. *)
Definition squares (dx dy dz : R) : R :=
  add gradual (add gradual (mul gradual dx dx) (mul gradual dy dy)) (mul gradual dz dz).

Lemma squares_below (d : point) :
  square d * (1 - 4 * u) - 6 * half_step <= squares (px d) (py d) (pz d).
Proof.
  unfold squares, square. rewrite !gradual_add, !gradual_mul.
  pose proof (proj1 half_step_value) as P.
  pose proof (Rle_0_sqr (px d)) as X. pose proof (Rle_0_sqr (py d)) as Y.
  pose proof (Rle_0_sqr (pz d)) as Z. unfold Rsqr in *.
  pose proof (nearest32_nonneg _ X). pose proof (nearest32_nonneg _ Y).
  pose proof (nearest32_nonneg _ Z).
  pose proof (nearest32_below _ X). pose proof (nearest32_below _ Y).
  pose proof (nearest32_below _ Z).
  set (x := nearest32 (px d * px d)) in *. set (y := nearest32 (py d * py d)) in *.
  set (z := nearest32 (pz d * pz d)) in *.
  assert (XY : 0 <= x + y) by lra. pose proof (nearest32_below _ XY).
  pose proof (nearest32_nonneg _ XY). set (xy := nearest32 (x + y)) in *.
  assert (XYZ : 0 <= xy + z) by lra. pose proof (nearest32_below _ XYZ).
  set (xyz := nearest32 (xy + z)) in *. unfold u in *. lra.
Qed.

(* The differences that are computed, and how far they are from the exact ones. *)
Definition computed (a b : point) : point :=
  {| px := sub gradual (px b) (px a); py := sub gradual (py b) (py a);
     pz := sub gradual (pz b) (pz a) |}.

Lemma computed_norm (a b : point) :
  distance a b <= norm (computed a b) * (1 + 2 * u) + 4 * half_step.
Proof.
  pose proof (norm_nonneg (minus b a)) as N. pose proof (norm_nonneg (computed a b)) as M.
  pose proof (proj1 half_step_value) as H0.
  set (e := minus (minus b a) (computed a b)).
  assert (T : distance a b <= norm (computed a b) + norm e).
  { unfold distance. replace (minus b a) with (plus (computed a b) e) at 1; [apply triangle |].
    unfold e, plus, minus. cbn. f_equal; ring. }
  assert (E : norm e <= norm (minus b a) * u + 2 * half_step).
  { (* |e| is at most u times the coordinates of the difference, and half a step each. *)
    set (w := {| px := u * Rabs (px (minus b a)); py := u * Rabs (py (minus b a));
                 pz := u * Rabs (pz (minus b a)) |}).
    set (s := {| px := half_step; py := half_step; pz := half_step |}).
    assert (C : forall x y, Rabs (y - x - sub gradual y x) <= u * Rabs (y - x) + half_step).
    { intros x y. rewrite gradual_sub, Rabs_minus_sym. apply nearest32_error. }
    assert (Hn : norm e <= norm (plus w s)).
    { apply norm_below; [apply norm_nonneg |]. rewrite norm_square. unfold square.
      assert (Q : forall p q, Rabs p <= q -> p * p <= q * q).
      { intros p q Hpq. pose proof (Rsqr_abs p) as A. unfold Rsqr in A. rewrite A.
        pose proof (Rabs_pos p). apply Rmult_le_compat; lra. }
      pose proof (Q _ _ (C (px a) (px b))). pose proof (Q _ _ (C (py a) (py b))).
      pose proof (Q _ _ (C (pz a) (pz b))).
      unfold e, computed, plus, w, s, minus. cbn [px py pz]. lra. }
    apply Rle_trans with (1 := Hn). apply Rle_trans with (1 := triangle w s).
    apply Rplus_le_compat.
    - apply norm_below; [apply Rmult_le_pos; [lra | unfold u; lra] |].
      replace (norm (minus b a) * u * (norm (minus b a) * u))
        with (u * u * (norm (minus b a) * norm (minus b a))) by ring.
      rewrite norm_square. unfold square, w. cbn [px py pz].
      assert (A : forall x, u * Rabs x * (u * Rabs x) = u * u * (x * x)).
      { intro x. pose proof (Rsqr_abs x) as S. unfold Rsqr in S. rewrite S. ring. }
      rewrite !A. lra.
    - apply norm_below; [lra |]. unfold square, s. cbn [px py pz].
      assert (0 <= half_step * half_step) by (apply Rmult_le_pos; lra). lra. }
  unfold distance in *. unfold u in *. lra.
Qed.

(* What the sphere test reports, in the Euclidean norm. *)
Theorem reported_near_norm (a b : ball) :
  radius_floor / 2 <= radius a -> radius_floor / 2 <= radius b ->
  rejects gradual a b = false ->
  distance (centre a) (centre b)
    <= (radius a + radius b) * (1 + 8 * u) + finder_floor * 2.
Proof.
  intros Ha Hb H. set (P := radius a + radius b). pose proof (proj1 half_step_value) as H0.
  pose proof (computed_norm (centre a) (centre b)) as C. set (d := computed _ _) in *.
  assert (HP : radius_floor <= P) by (unfold P; lra).
  assert (N : norm d <= P * (1 + 5 * u) + finder_floor * 15 / 8).
  { pose proof floors_product as K. rewrite finder_floor_value in *. rewrite floor_value in *.
    pose proof tiny_value as T. pose proof (proj2 half_step_value) as HT.
    set (s := add gradual (radius a) (radius b)).
    assert (Hs : s <= P * (1 + u) + half_step).
    { unfold s. rewrite gradual_add. apply nearest32_above. fold P. lra. }
    assert (Ps : 0 <= s) by (unfold s; rewrite gradual_add; apply nearest32_nonneg; fold P; lra).
    unfold rejects, apart, greater in H. revert H. rewrite !read_is. fold s.
    change (sub gradual (px (centre b)) (px (centre a))) with (px d).
    change (sub gradual (py (centre b)) (py (centre a))) with (py d).
    change (sub gradual (pz (centre b)) (pz (centre a))) with (pz d).
    fold (squares (px d) (py d) (pz d)).
    case Rlt_bool_spec; [discriminate |]. intros Ha' _. rewrite gradual_mul in Ha'.
    pose proof (squares_below d) as L.
    assert (S : s * s <= (P * (1 + u) + half_step) * (P * (1 + u) + half_step))
      by (apply Rmult_le_compat; lra).
    pose proof (nearest32_above (s * s) (Rle_0_sqr s)) as M.
    set (G := 281474976710656 * tiny) in *. set (F := 72057594037927936 * tiny) in *.
    assert (G0 : 0 < G) by (unfold G; lra). assert (F0 : 0 < F) by (unfold F; lra).
    assert (P0 : 0 <= P) by lra.
    assert (PG : F * G <= P * G) by (apply Rmult_le_compat_r; lra).
    assert (PH : P * half_step <= P * G / 1000000).
    { unfold Rdiv. rewrite Rmult_assoc. apply Rmult_le_compat_l; [lra |]. unfold G. lra. }
    assert (HH : half_step * half_step <= P * half_step).
    { apply Rmult_le_compat_r; [lra |]. apply Rle_trans with (2 := HP). unfold F. lra. }
    assert (PP : 0 <= P * P) by (apply Rmult_le_pos; lra).
    assert (GG : 0 <= G * G) by (apply Rmult_le_pos; lra).
    assert (PG0 : 0 <= P * G) by (apply Rmult_le_pos; lra).
    apply norm_below; [unfold u; lra |].
    pose proof (square_nonneg d). clearbody d s G F. unfold u in *. lra. }
  rewrite finder_floor_value in *. rewrite floor_value in *. pose proof tiny_value.
  pose proof (proj2 half_step_value). unfold u in *. lra.
Qed.

(* src/rounding/skin.rs: Skin::of, stays *)
Record skin := { share : R; least : R }.
Definition sound_skin (s : skin) : Prop :=
  0 <= share s <= 1 /\ skin_floor <= least s <= IZR (2 ^ 100).
Definition skin_of (s : skin) (radius : R) : R := Rmax (mul gradual radius (share s)) (least s).
Definition left_of (s : skin) (now before : R) : R :=
  Rmax (sub gradual (skin_of s before) (Rmax (sub gradual now before) 0)) 0.
Definition stays (s : skin) (now before : ball) : bool :=
  let left := left_of s (radius now) (radius before) in
  let d := computed (centre before) (centre now) in
  greater gradual (mul gradual left left) (squares (px d) (py d) (pz d)).

Definition budget (s : skin) (radius : R) : R := skin_of s radius * (1 + 32 * u) + skin_floor.

Theorem drift_within_budget (s : skin) (now before : ball) :
  0 <= least s -> stays s now before = true ->
  distance (centre before) (centre now)
    + Rmax (radius now - radius before) 0 * (1 + 16 * u) <= budget s (radius before).
Proof.
  intros Hl H. pose proof (proj1 half_step_value) as H0.
  pose proof (proj2 half_step_value) as HT. pose proof tiny_value as T.
  destruct skin_floor_value as [KF _]. rewrite floor_value in KF.
  pose proof (computed_norm (centre before) (centre now)) as C.
  unfold stays in H. set (d := computed _ _) in *.
  set (left := left_of s (radius now) (radius before)) in *.
  unfold greater in H. rewrite !read_is, gradual_mul in H. revert H.
  case Rlt_bool_spec; [| discriminate]. intros H _.
  pose proof (squares_below d) as L.
  assert (P : 0 <= left) by (unfold left, left_of; apply Rmax_r).
  pose proof (nearest32_above (left * left) (Rle_0_sqr left)) as M.
  set (far := left * (1 + 3 * u) + skin_floor / 1024).
  assert (N : norm d <= far).
  { assert (F : half_step * 8 <= skin_floor / 1024 * (skin_floor / 1024)).
    { unfold skin_floor, half_step, Rdiv.
      change (2 ^ 150)%Z with (1024 * 1024 * (2 ^ 60 * 2 ^ 60) * 2 ^ 10)%Z.
      rewrite !mult_IZR. set (a := IZR (2 ^ 60)).
      assert (0 < a) by (apply IZR_lt; reflexivity).
      change (IZR (2 ^ 10)) with 1024.
      replace (/ (1024 * 1024 * (a * a) * 1024))
        with (/ 1024 * / 1024 * / 1024 * (/ a * / a)) by (field; lra).
      assert (0 < / a * / a) by (apply Rmult_lt_0_compat; apply Rinv_0_lt_compat; lra).
      replace (/ a * / 1024 * (/ a * / 1024)) with (/ 1024 * / 1024 * (/ a * / a)) by ring. lra. }
    set (f := skin_floor / 1024) in *.
    assert (0 <= left * f).
    { apply Rmult_le_pos; [exact P |]. unfold f. rewrite KF. lra. }
    assert (0 <= left * left) by apply Rle_0_sqr.
    pose proof (square_nonneg d) as Q.
    apply norm_below; [unfold far, f; rewrite KF; unfold u; lra |].
    unfold far. fold f. clearbody f left d. unfold u in *. lra. }
  (* Something of the skin is left. *)
  set (skin := skin_of s (radius before)) in *.
  set (grown := Rmax (sub gradual (radius now) (radius before)) 0) in *.
  assert (Pg : 0 <= grown) by apply Rmax_r.
  assert (LP : 0 < left).
  { destruct (Rle_lt_or_eq_dec 0 left P) as [E | E]; [exact E | exfalso].
    rewrite <- E, Rmult_0_l in H.
    assert (Z : nearest32 0 = 0) by (apply round_0; typeclasses eauto). rewrite Z in H.
    revert H. apply Rle_not_lt. unfold squares. rewrite !gradual_add, !gradual_mul.
    pose proof (nearest32_nonneg _ (Rle_0_sqr (px d))).
    pose proof (nearest32_nonneg _ (Rle_0_sqr (py d))).
    pose proof (nearest32_nonneg _ (Rle_0_sqr (pz d))). unfold Rsqr in *.
    apply nearest32_nonneg. apply Rplus_le_le_0_compat; [apply nearest32_nonneg |]; lra. }
  assert (LS : left <= (skin - grown) * (1 + u) + half_step).
  { unfold left, left_of in *. fold skin grown in LP |- *. revert LP. rewrite gradual_sub.
    unfold Rmax at 1 2. destruct Rle_dec as [D | D]; intro LP; [lra |].
    destruct (Rle_or_lt 0 (skin - grown)) as [S | S]; [now apply nearest32_above |].
    exfalso. apply D. rewrite <- (round_0 radix2 (FLT_exp (-149) 24) ZnearestE).
    apply round_le; [typeclasses eauto | typeclasses eauto | lra]. }
  assert (GR : Rmax (radius now - radius before) 0 <= (grown + half_step) * (1 + 2 * u)).
  { unfold Rmax at 1. destruct Rle_dec as [D | D].
    - apply Rmult_le_pos; unfold u; lra.
    - assert (0 <= radius now - radius before) as E by lra.
      pose proof (nearest32_below _ E) as B. rewrite <- gradual_sub in B.
      pose proof (Rmax_l (sub gradual (radius now) (radius before)) 0) as A. fold grown in A.
      unfold u in *. lra. }
  unfold budget. fold skin. unfold far in N. rewrite KF in *.
  set (g := Rmax (radius now - radius before) 0) in *.
  clearbody g grown skin left d. unfold u in *. lra.
Qed.

(* src/rounding/skin.rs: Reach::with_skin, Reach::of *)
Definition reach_of (s : skin) (radius : R) : R :=
  let factor := fl gradual (mul64 gradual64 (add64 gradual64 1 (share s)) (1 + 64 * u)) in
  let floor := fl gradual
    (add64 gradual64 (mul64 gradual64 (least s) (1 + 64 * u)) reach_floor) in
  add gradual (mul gradual radius factor) floor.

Lemma rounded64_near (x : R) : Rabs (fl64 gradual64 x - x) <= v * Rabs x + tiny64.
Proof. apply fl64_error, gradually_valid64. Qed.

Lemma reach_above (s : skin) (r : R) :
  sound_skin s -> 0 <= r ->
  r * (1 + share s) * (1 + 59 * u) + least s * (1 + 59 * u) + reach_floor / 2 <= reach_of s r.
Proof.
  intros ((S0 & S1) & (L0 & L1)) Hr. pose proof (proj1 half_step_value) as H0.
  pose proof (proj2 half_step_value) as HT. pose proof tiny_value as T. pose proof v_value as V.
  destruct skin_floor_value as [KF RF]. rewrite floor_value in KF.
  assert (T64 : 0 < tiny64 <= half_step).
  { split; [apply tiny64_value |]. unfold tiny64, half_step.
    apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
  assert (HS : half_step <= / 1000000000000).
  { unfold half_step. apply Rinv_le_contravar; [lra | now apply IZR_le]. }
  unfold reach_of. rewrite gradual_add, gradual_mul, !gradual_fl.
  unfold mul64, add64. rewrite !read64_is.
  pose proof (rounded64_near (1 + share s)) as E1. rewrite (Rabs_pos_eq (1 + share s)) in E1 by lra.
  apply Rabs_le_inv in E1. set (a := fl64 gradual64 (1 + share s)) in *.
  assert (Pa : 0 <= a * (1 + 64 * u)) by (apply Rmult_le_pos; unfold u, v in *; lra).
  pose proof (rounded64_near (a * (1 + 64 * u))) as E2. rewrite (Rabs_pos_eq _ Pa) in E2.
  apply Rabs_le_inv in E2. set (b := fl64 gradual64 (a * (1 + 64 * u))) in *.
  assert (Pb : 0 <= b) by (unfold u, v in *; lra).
  pose proof (nearest32_below b Pb) as E3. set (factor := nearest32 b) in *.
  assert (F : (1 + share s) * (1 + 62 * u) <= factor) by (unfold u, v in *; lra).
  assert (Pl : 0 <= least s * (1 + 64 * u)) by (apply Rmult_le_pos; unfold u in *; lra).
  pose proof (rounded64_near (least s * (1 + 64 * u))) as G1. rewrite (Rabs_pos_eq _ Pl) in G1.
  apply Rabs_le_inv in G1. set (c := fl64 gradual64 (least s * (1 + 64 * u))) in *.
  assert (Pc : 0 <= c + reach_floor) by (unfold u, v in *; lra).
  pose proof (rounded64_near (c + reach_floor)) as G2. rewrite (Rabs_pos_eq _ Pc) in G2.
  apply Rabs_le_inv in G2. set (e := fl64 gradual64 (c + reach_floor)) in *.
  assert (Pe : 0 <= e) by (unfold u, v in *; lra).
  pose proof (nearest32_below e Pe) as G3. set (floor := nearest32 e) in *.
  assert (G : least s * (1 + 62 * u) + reach_floor * 3 / 4 <= floor) by (unfold u, v in *; lra).
  assert (RF1 : r * ((1 + share s) * (1 + 62 * u)) <= r * factor) by (apply Rmult_le_compat_l; lra).
  assert (Pr : 0 <= r * (1 + share s)) by (apply Rmult_le_pos; lra).
  assert (P1 : 0 <= r * factor) by (unfold u in *; lra).
  pose proof (nearest32_below _ P1) as M1. set (m := nearest32 (r * factor)) in *.
  pose proof (nearest32_nonneg _ P1) as M0. fold m in M0.
  assert (P2 : 0 <= m + floor) by (unfold u in *; lra).
  pose proof (nearest32_below _ P2) as M2.
  set (rs := r * (1 + share s)) in *.
  replace (r * ((1 + share s) * (1 + 62 * u))) with (rs * (1 + 62 * u)) in RF1
    by (unfold rs; ring).
  clearbody rs m factor floor. unfold u in *. lra.
Qed.

(* src/broad_phase/neighbours/list.rs: BuildList::run. A ball as a list takes it: grown by the skin, or
   where it is static by that of no share. *)
Definition still : skin := {| share := 0; least := skin_floor |}.
Definition skin_for (s : skin) (moves : bool) : skin := if moves then s else still.
Definition listed (s : skin) (moves : bool) (b : ball) : ball :=
  {| centre := centre b; radius := reach_of (skin_for s moves) (radius b) |}.
(* What a frame finds of it later: a ball that stays, or the same one. *)
Definition follows (s : skin) (moves : bool) (now before : ball) : Prop :=
  if moves then stays s now before = true else now = before.

Lemma still_sound : sound_skin still.
Proof.
  unfold sound_skin, still. cbn. split; [lra |]. unfold skin_floor. split; [lra |].
  apply Rle_trans with (/ 1); [| rewrite Rinv_1; now apply IZR_le].
  apply Rinv_le_contravar; [lra | now apply IZR_le].
Qed.

Lemma skin_below (s : skin) (r : R) :
  sound_skin s -> 0 <= r -> skin_of s r <= r * share s * (1 + u) + least s + half_step.
Proof.
  intros ((S0 & S1) & (L0 & L1)) Hr. pose proof (proj1 half_step_value) as H0.
  pose proof (proj2 half_step_value) as HT. pose proof tiny_value as T.
  destruct skin_floor_value as [KF _]. rewrite floor_value in KF.
  assert (P : 0 <= r * share s) by (apply Rmult_le_pos; lra).
  unfold skin_of. rewrite gradual_mul. pose proof (nearest32_above _ P) as N.
  apply Rmax_lub; unfold u in *; lra.
Qed.

(* How far each centre has come, with what its radius gained. *)
Lemma follows_near (s : skin) (moves : bool) (now before : ball) :
  sound_skin s -> follows s moves now before ->
  distance (centre before) (centre now) + radius now * (1 + 16 * u)
    <= radius before * (1 + 16 * u)
       + (if moves then budget s (radius before) else 0).
Proof.
  intros Hs F. destruct skin_floor_value as [KF _]. pose proof tiny_value.
  rewrite floor_value in KF. destruct moves; cbn in F.
  - pose proof (drift_within_budget s now before ltac:(destruct Hs; lra) F) as B.
    pose proof (Rmax_l (radius now - radius before) 0). unfold u in *. lra.
  - subst now. unfold distance, norm, square, minus. cbn [px py pz].
    replace (_ + _ + _) with 0 by ring. rewrite sqrt_0. lra.
Qed.

(* A grown radius has room for that, and for the margins of the sphere test, however small it is. *)
Lemma listed_large (s : skin) (moves : bool) (r : R) :
  sound_skin s -> 0 <= r ->
  (r * (1 + 16 * u) + (if moves then budget s r else 0)) * (1 + 12 * u) + 8 * radius_floor
    <= reach_of (skin_for s moves) r.
Proof.
  intros Hs Hr. pose proof (proj1 half_step_value) as H0. pose proof (proj2 half_step_value) as HT.
  pose proof tiny_value as T. destruct skin_floor_value as [KF RF]. rewrite floor_value in *.
  destruct moves; cbn [skin_for].
  - pose proof (reach_above s r Hs ltac:(lra)) as R. pose proof (skin_below s r Hs ltac:(lra)) as S.
    unfold budget. destruct Hs as ((S0 & S1) & (L0 & L1)).
    assert (P : 0 <= r * share s) by (apply Rmult_le_pos; lra).
    replace (r * (1 + share s) * (1 + 59 * u)) with ((r + r * share s) * (1 + 59 * u)) in R by ring.
    set (k := skin_of s r) in *. set (rs := r * share s) in *.
    rewrite RF, KF in *. clearbody k rs. unfold u in *. lra.
  - pose proof (reach_above still r still_sound ltac:(lra)) as R. cbn [share least still] in R.
    rewrite Rplus_0_r, Rmult_1_r in R. rewrite RF, KF in *. unfold u in *. lra.
Qed.

(* Theorem K. Radii are inflated ones. *)
Theorem lists_hold_reported_pairs (s : skin) (moves_a moves_b : bool) (a b now_a now_b : ball) :
  sound_skin s ->
  radius_floor / 2 <= radius a -> radius_floor / 2 <= radius b ->
  radius_floor / 2 <= radius now_a -> radius_floor / 2 <= radius now_b ->
  follows s moves_a now_a a -> follows s moves_b now_b b ->
  rejects gradual now_a now_b = false ->
  rejects gradual (listed s moves_a a) (listed s moves_b b) = false.
Proof.
  intros Hs Ha Hb Na Nb Fa Fb H.
  pose proof (proj1 half_step_value) as H0. pose proof (proj2 half_step_value) as HT.
  pose proof tiny_value as T.
  pose proof (reported_near_norm now_a now_b Na Nb H) as D.
  pose proof (follows_near s moves_a now_a a Hs Fa) as Wa.
  pose proof (follows_near s moves_b now_b b Hs Fb) as Wb.
  assert (Pf : 0 < radius_floor) by (rewrite floor_value; lra).
  pose proof (listed_large s moves_a (radius a) Hs ltac:(lra)) as La.
  pose proof (listed_large s moves_b (radius b) Hs ltac:(lra)) as Lb.
  set (pa := radius a * (1 + 16 * u) + _) in *. set (pb := radius b * (1 + 16 * u) + _) in *.
  pose proof (distance_triangle (centre a) (centre now_a) (centre b)) as T1.
  pose proof (distance_triangle (centre now_a) (centre now_b) (centre b)) as T2.
  rewrite (distance_symmetric (centre now_b) (centre b)) in T2.
  pose proof (norm_nonneg (minus (centre now_a) (centre a))) as N1.
  fold (distance (centre a) (centre now_a)) in N1.
  pose proof (norm_nonneg (minus (centre now_b) (centre b))) as N2.
  fold (distance (centre b) (centre now_b)) in N2.
  rewrite finder_floor_value in D. rewrite floor_value in *.
  set (la := reach_of _ (radius a)) in *. set (lb := reach_of _ (radius b)) in *.
  set (P := pa + pb + radius_floor).
  assert (Near : distance (centre a) (centre b) <= P).
  { unfold P. rewrite floor_value. unfold u in *. lra. }
  assert (Pa : 0 <= pa) by (unfold u in *; lra). assert (Pb : 0 <= pb) by (unfold u in *; lra).
  unfold rejects, listed. cbn [centre radius]. fold la lb.
  set (way := minus (centre b) (centre a)).
  apply decision with (X := px way) (Y := py way) (Z := pz way) (P := P);
    try apply difference_above; try apply gradual_valid.
  - unfold P. rewrite floor_value. lra.
  - change (square way <= (P + room) * (P + room)). rewrite <- norm_square.
    pose proof (norm_nonneg way). unfold distance in Near. fold way in Near.
    pose proof slack_in_room. apply Rmult_le_compat; lra.
  - rewrite gradual_add. assert (L : 0 <= la + lb) by (unfold u in *; lra).
    pose proof (nearest32_below _ L) as B. unfold P. rewrite floor_value. unfold u in *. lra.
Qed.
