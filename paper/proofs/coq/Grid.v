(* Theorem C for bodies: those that share a point fall in cells next to each other, in a level that
   is sized by its widest ball. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place ReadPose WorldBall Sphere Rejected Cells.
Open Scope R_scope.

(* A point's coordinate along an axis. *)
Definition coordinate_of (axis : nat) (p : point) : R :=
  match axis with 0%nat => px p | 1%nat => py p | _ => pz p end.

Lemma coordinate_below_distance (axis : nat) (a b : point) :
  Rabs (coordinate_of axis b - coordinate_of axis a) <= distance a b.
Proof.
  destruct (coordinates_of_norm (minus b a) (distance a b) (Rle_refl _)) as (Hx & Hy & Hz).
  destruct axis as [| [| axis]]; cbn; assumption.
Qed.

(* The inflated radius exceeds the radius by most of the floor. *)
Lemma inflated_above (m : mode) (a : R) :
  valid m -> 0 <= a -> a + radius_floor / 2 <= inflate_radius m a.
Proof.
  intros Hm Ha. pose proof (inflate_below m a Hm Ha) as H. rewrite floor_value in *.
  pose proof tiny_value. unfold u in *. lra.
Qed.

(* Spheres of bodies that share a point are no farther apart than their inflated radii add up to. *)
Theorem touching_spheres (ma mb : modes) (a b : body) (p : point) :
  valid_modes ma -> valid_modes mb -> sound ma a -> sound mb b -> occupies a p -> occupies b p ->
  distance (centre (sphere ma a)) (centre (sphere mb b)) + radius_floor / 2
    <= radius (sphere ma a) + radius (sphere mb b).
Proof.
  intros Hma Hmb Ha Hb Pa Pb.
  destruct (occupied_near ma a p Hma Ha Pa) as [Ra Da].
  destruct (occupied_near mb b p Hmb Hb Pb) as [Rb Db].
  unfold sphere, inflated. cbn [centre radius].
  set (wa := world_ball (pose32 ma) (pose64 ma) _ _ _ _) in *.
  set (wb := world_ball (pose32 mb) (pose64 mb) _ _ _ _) in *.
  pose proof (distance_triangle (centre wa) p (centre wb)) as T.
  rewrite (distance_symmetric (centre wa) p) in T.
  pose proof (inflated_above (inflation ma) (radius wa) (proj2 (proj2 Hma)) Ra).
  pose proof (inflated_above (inflation mb) (radius wb) (proj2 (proj2 Hmb)) Rb).
  pose proof tiny_value. rewrite floor_value in *. unfold slack in *. lra.
Qed.

Section Fit.
Variable m : mode.
Variable m64 : mode64.
Hypothesis Hm : valid m.
Hypothesis Hm64 : valid64 m64.

(* src/rounding/mod.rs: FINDER_FACTOR, FINDER_FLOOR, widen *)
Definition finder_factor : R := 1 + 16 * u.
Definition finder_floor : R := / IZR (2 ^ 78).
Definition widen (r : R) : R :=
  up m (add64 m64 (mul64 m64 (read m r) finder_factor) finder_floor).

Lemma finder_floor_value : finder_floor = 281474976710656 * tiny.
Proof.
  unfold finder_floor, tiny. change (2 ^ 126)%Z with (281474976710656 * 2 ^ 78)%Z.
  rewrite mult_IZR. field. now apply IZR_neq.
Qed.

Lemma widen_above (r : R) : 0 <= r <= IZR (2 ^ 200) -> r <= widen r.
Proof.
  intros [Hr Hb]. pose proof tiny_value as T. pose proof v_value as V.
  pose proof dust_root_value as (R0 & _ & R2 & R3). pose proof dust_value as D.
  pose proof (read_nonneg m r Hr) as N. pose proof (read_error m r) as E. apply Rabs_le_inv in E.
  assert (B1 : Rabs (read m r) <= big).
  { rewrite Rabs_pos_eq by lra. apply Rle_trans with (IZR (2 ^ 200)); [lra |]. now apply IZR_le. }
  assert (F : 1 <= finder_factor <= 2) by (unfold finder_factor, u; lra).
  assert (B2 : Rabs finder_factor <= big).
  { rewrite Rabs_pos_eq by lra. apply Rle_trans with 2; [lra |]. now apply IZR_le. }
  pose proof (mul64_error m64 Hm64 _ _ B1 B2) as M.
  assert (P0 : 0 <= read m r * finder_factor) by (apply Rmult_le_pos; lra).
  rewrite (Rabs_pos_eq (read m r * finder_factor)) in M by exact P0. apply Rabs_le_inv in M.
  pose proof (mul64_nonneg m64 (read m r) finder_factor (proj1 N) ltac:(lra)) as P1.
  assert (P2 : 0 <= finder_floor) by (rewrite finder_floor_value; lra).
  pose proof (add64_below m64 Hm64 _ _ P1 P2) as A. pose proof (add64_nonneg m64 _ _ P1 P2) as P3.
  unfold widen. pose proof (up_above m Hm _ P3) as U.
  set (x := read m r) in *. unfold finder_factor in *. rewrite finder_floor_value in *.
  unfold u, v in *. lra.
Qed.

(* src/broad_phase/grid/cells.rs: Cells::fit takes the larger of these two sizes, or a larger one
   still. `longest` is the longest side of the box of centres. *)
Definition needed (widest : R) : R := mul64 m64 (mul64 m64 2 (widen widest)) (1 + / 65536).
Definition fewest (longest : R) : R := div64 m64 longest (IZR (2 ^ 29)).

Lemma needed_above (widest : R) :
  0 <= widest <= IZR (2 ^ 100) -> widen widest <= IZR (2 ^ 200) ->
  2 * widen widest * (1 + / 65537) <= needed widest.
Proof.
  intros Hw Hb. pose proof v_value as V. pose proof dust_value as D.
  assert (W : IZR (2 ^ 100) <= IZR (2 ^ 200)) by now apply IZR_le.
  pose proof (widen_above widest ltac:(lra)) as L.
  assert (L' : finder_floor / 2 <= widen widest).
  { unfold widen. pose proof (read_nonneg m widest (proj1 Hw)) as N.
    pose proof (mul64_nonneg m64 (read m widest) finder_factor (proj1 N)
      ltac:(unfold finder_factor, u; lra)) as P1.
    assert (P2 : 0 <= finder_floor).
    { rewrite finder_floor_value. pose proof tiny_value. lra. }
    pose proof (add64_below m64 Hm64 _ _ P1 P2) as A.
    pose proof (add64_nonneg m64 _ _ P1 P2) as P3. pose proof (up_above m Hm _ P3) as U.
    pose proof dust_root_value as (R0 & _ & R2 & R3).
    rewrite finder_floor_value in *. unfold v in *. pose proof tiny_value. lra. }
  pose proof dust_root_value as (R0 & _ & R2 & R3). pose proof tiny_value as T.
  rewrite finder_floor_value in L'.
  set (w := widen widest) in *.
  assert (Bw : Rabs w <= big).
  { rewrite Rabs_pos_eq by lra. apply Rle_trans with (1 := Hb). now apply IZR_le. }
  assert (B2 : Rabs 2 <= big) by (rewrite Rabs_pos_eq by lra; now apply IZR_le).
  pose proof (mul64_error m64 Hm64 2 w B2 Bw) as E. rewrite (Rabs_pos_eq (2 * w)) in E by lra.
  apply Rabs_le_inv in E.
  unfold needed. fold w. set (d := mul64 m64 2 w) in *.
  assert (Hd : 0 <= d) by (unfold v in *; lra).
  assert (Bd : Rabs d <= big).
  { rewrite Rabs_pos_eq by exact Hd. apply Rle_trans with (3 * IZR (2 ^ 200)).
    - unfold v in *. lra.
    - unfold big. rewrite <- mult_IZR. now apply IZR_le. }
  assert (B3 : Rabs (1 + / 65536) <= big).
  { rewrite Rabs_pos_eq by lra. apply Rle_trans with 2; [lra | now apply IZR_le]. }
  pose proof (mul64_error m64 Hm64 d (1 + / 65536) Bd B3) as E2.
  rewrite (Rabs_pos_eq (d * (1 + / 65536))) in E2 by lra. apply Rabs_le_inv in E2.
  set (result := mul64 m64 d (1 + / 65536)) in *. unfold v in *. lra.
Qed.

(* Hardly more than 2^29 cells lie between two ends of the box. *)
Lemma fit_most_cells (lo hi x longest size : R) :
  lo <= x <= hi -> sub64 m64 hi lo <= longest -> 0 <= longest ->
  fewest longest <= size -> / IZR (2 ^ 100) <= size -> x - lo <= most_cells * size.
Proof.
  intros Hx Hl L0 Hs Hmin. pose proof v_value as V. pose proof dust_value as D.
  pose proof tiny64_dust as T1. pose proof (proj1 tiny64_value) as T0.
  assert (D1 : dust <= / 1000000000000 * / IZR (2 ^ 100)).
  { unfold dust. rewrite <- Rinv_mult, <- mult_IZR.
    apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
  assert (E0 : forall a : R, Rabs (a - a) <= 0) by (intro; rewrite Rminus_diag_eq, Rabs_R0; lra).
  pose proof (sub64_near m64 Hm64 hi lo hi lo 0 0 (E0 hi) (E0 lo)) as S.
  rewrite (Rabs_pos_eq (hi - lo)) in S by lra. apply Rabs_le_inv in S.
  pose proof (read64_error m64 longest) as Rl. apply Rabs_le_inv in Rl.
  pose proof (read64_nonneg m64 longest L0) as Rn.
  assert (R29 : read64 m64 (IZR (2 ^ 29)) = 536870912).
  { destruct (read64_cases m64 (IZR (2 ^ 29))) as [-> | [A _]]; [reflexivity |].
    exfalso. pose proof tiny64_small. rewrite Rabs_pos_eq in A; lra. }
  unfold fewest, div64 in Hs. rewrite R29 in Hs.
  set (l := read64 m64 longest) in *.
  pose proof (fl64_error m64 Hm64 (l / 536870912)) as F.
  rewrite (Rabs_pos_eq (l / 536870912)) in F by lra. apply Rabs_le_inv in F.
  set (size' := fl64 m64 (l / 536870912)) in *. unfold most_cells.
  assert (A : (hi - lo) * (1 - 3 * v) <= 536870912 * size + / IZR (2 ^ 100) * / 1000).
  { unfold v in *. lra. }
  unfold v in *. lra.
Qed.
End Fit.

(* Bodies a and b of a level that share a point, along one axis: `widest` is no less than their
   radii, `size` no less than what Cells::fit starts from, `origin` no more than their coordinates,
   which are read as m reads them. *)
Theorem touching_bodies_in_neighbouring_cells
    (m : mode) (m64 : mode64) (ma mb : modes) (a b : body) (p : point) (axis : nat)
    (widest size origin : R) :
  valid m -> valid64 m64 -> valid_modes ma -> valid_modes mb -> sound ma a -> sound mb b ->
  occupies a p -> occupies b p ->
  radius (sphere ma a) <= widest -> radius (sphere mb b) <= widest -> widest <= IZR (2 ^ 80) ->
  widen m m64 widest <= IZR (2 ^ 100) ->
  needed m m64 widest <= size -> / IZR (2 ^ 100) <= size <= IZR (2 ^ 100) ->
  let x := read m (coordinate_of axis (centre (sphere ma a))) in
  let y := read m (coordinate_of axis (centre (sphere mb b))) in
  origin <= x -> origin <= y ->
  x - origin <= most_cells * size -> y - origin <= most_cells * size ->
  let inverse := div64 m64 1 size in
  (Z.abs (number (cell m64 origin inverse x) - number (cell m64 origin inverse y)) <= 1)%Z.
Proof.
  intros Hm Hm64 Hma Hmb Ha Hb Pa Pb Wa Wb Hw Hwiden Hneed Hsize x y Ox Oy Mx My inverse.
  pose proof (touching_spheres ma mb a b p Hma Hmb Ha Hb Pa Pb) as T.
  pose proof (coordinate_below_distance axis (centre (sphere ma a)) (centre (sphere mb b))) as C.
  pose proof (read_error m (coordinate_of axis (centre (sphere ma a)))) as Ea.
  pose proof (read_error m (coordinate_of axis (centre (sphere mb b)))) as Eb.
  fold x in Ea. fold y in Eb. pose proof tiny_value as Ht. rewrite floor_value in T.
  apply Rabs_le_inv in C, Ea, Eb.
  pose proof (norm_nonneg (minus (centre (sphere mb b)) (centre (sphere ma a)))) as N.
  fold (distance (centre (sphere ma a)) (centre (sphere mb b))) in N.
  assert (I1 : IZR (2 ^ 80) <= IZR (2 ^ 100)) by now apply IZR_le.
  assert (I2 : IZR (2 ^ 100) <= IZR (2 ^ 200)) by now apply IZR_le.
  assert (W0 : 0 <= widest) by lra.
  pose proof (widen_above m m64 Hm Hm64 widest ltac:(lra)) as L.
  pose proof (needed_above m m64 Hm Hm64 widest ltac:(lra) ltac:(lra)) as F.
  destruct (Rle_or_lt y x) as [H | H].
  - pose proof (neighbouring_cells m64 Hm64 origin size Hsize x y (widen m m64 widest)
      ltac:(lra) Mx ltac:(lra) ltac:(lra)) as R. fold inverse in R. lia.
  - pose proof (neighbouring_cells m64 Hm64 origin size Hsize y x (widen m m64 widest)
      ltac:(lra) My ltac:(lra) ltac:(lra)) as R. fold inverse in R. lia.
Qed.
