(* Bodies, balls and lines to which theorems D, F, G, K, Q, U and V apply: they meet all hypotheses, so
   none of these theorems holds for want of inputs. *)
From Coq Require Import Reals ZArith Bool List Lra Lia Arith.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Sphere Rejected Ieee Shows.
From Sdop Require Import Grid Outward Finder Lists Cubes Duality Vectors Norms64 OrDopPose Swept.
From Sdop Require Import Query InBody QueryBody QuerySupport QueryPair QueryLine Kept Parts.
Import ListNotations.
Open Scope R_scope.

Local Notation g := gradual64.

(* Small whole numbers are f32 and f64. *)
Lemma whole_format (precision least : Z) (n : Z) :
  (0 < precision)%Z -> (least <= 0)%Z -> (Z.abs n < 2 ^ precision)%Z ->
  generic_format radix2 (FLT_exp least precision) (IZR n).
Proof.
  intros P L B. apply generic_format_FLT. apply (FLT_spec _ _ _ _ (Float radix2 n 0)).
  - unfold F2R. cbn. ring.
  - exact B.
  - exact L.
Qed.
Ltac whole :=
  match goal with
  | |- format64 ?x => first [change x with (IZR 0) | change x with (IZR 1) | change x with (IZR 2)];
      apply whole_format; vm_compute; easy
  | |- format32 ?x => first [change x with (IZR 0) | change x with (IZR 1) | change x with (IZR 2)];
      apply whole_format; vm_compute; easy
  end.

Definition unturned : quaternion := {| qx := 0; qy := 0; qz := 0; qw := 1 |}.
Definition nowhere : point := pt 0 0 0.

Lemma unturned_sound : sound_quaternion unturned.
Proof.
  unfold sound_quaternion, norm_of, unturned, least_norm, greatest_norm. cbn [qx qy qz qw].
  replace (0 * 0 + 0 * 0 + 0 * 0 + 1 * 1) with 1 by ring. split.
  - rewrite <- Rinv_1. apply Rinv_le_contravar; [lra | apply IZR_le; vm_compute; easy].
  - apply IZR_le. vm_compute. easy.
Qed.

Lemma unturned_posed (x t : point) : posed unturned t x = plus x t.
Proof.
  unfold posed, apply, exact_rotation, dot, plus, unturned, norm_of, pt.
  cbn [row0 row1 row2 px py pz qx qy qz qw]. f_equal; field.
Qed.

Lemma norm_along (x : R) : norm (pt x 0 0) = Rabs x.
Proof.
  unfold norm, square, pt. cbn [px py pz].
  replace (x * x + 0 * 0 + 0 * 0) with (Rsqr x) by (unfold Rsqr; ring). apply sqrt_Rsqr_abs.
Qed.

(* A slab from -1 to 1 about the origin, and the point of it at 1. *)
Definition rod : solid :=
  {| slabs := [{| normal := pt 1 0 0; length := 1; low := -1; high := 1 |}]; middle := nowhere;
     ball_radius := 1; reach := 1; turn := unturned; place := nowhere; margin := 0 |}.
Definition tip : point := pt 1 0 0.

Lemma nowhere_format : format_point nowhere.
Proof. repeat split; cbn; whole. Qed.

Lemma rod_sound : sound_solid rod.
Proof.
  unfold sound_solid, rod. cbn [turn place middle slabs reach margin].
  split; [exact unturned_sound |]. do 2 (split; [exact nowhere_format |]). split.
  - constructor; [| constructor]. unfold sound_slab. cbn [normal length].
    rewrite norm_along, Rabs_R1, Rminus_diag_eq, Rabs_R0 by reflexivity.
    pose proof v_value. lra.
  - unfold nowhere. rewrite norm_along, Rabs_R0. lra.
Qed.

Lemma tip_in_rod : in_mesh rod tip.
Proof.
  unfold in_mesh, rod, tip. cbn [slabs reach middle ball_radius]. split; [| split].
  - constructor; [| constructor]. unfold dot, pt. cbn [normal low high px py pz]. lra.
  - rewrite norm_along, Rabs_R1. lra.
  - replace (minus (pt 1 0 0) nowhere) with (pt 1 0 0)
      by (unfold minus, nowhere, pt; cbn [px py pz]; f_equal; ring).
    rewrite norm_along, Rabs_R1. lra.
Qed.

Lemma tip_place : distance tip (posed (turn rod) (place rod) tip) <= margin rod.
Proof.
  cbn [turn place margin rod]. rewrite unturned_posed. unfold distance.
  replace (minus _ tip) with (pt 0 0 0)
    by (unfold minus, plus, tip, nowhere, pt; cbn [px py pz]; f_equal; ring).
  rewrite norm_along, Rabs_R0. lra.
Qed.

Lemma tip_occupied : occupied rod tip.
Proof. exists tip. split; [exact tip_in_rod | exact tip_place]. Qed.

(* Theorem Q. *)
Example ball_touches_rod : may_touch_ball rod (pt 2 0 0) 1 = true.
Proof.
  apply (balls_are_touched rod _ 1 tip rod_sound); [| lra | exact tip_occupied |].
  - repeat split; cbn; whole.
  - unfold distance. replace (minus (pt 2 0 0) tip) with (pt 1 0 0)
      by (unfold minus, tip, pt; cbn [px py pz]; f_equal; ring). rewrite norm_along, Rabs_R1. lra.
Qed.

Example box_touches_rod : may_touch_box rod tip (pt 2 0 0) = true.
Proof.
  apply (boxes_are_touched rod _ _ tip rod_sound); try exact tip_occupied;
    unfold tip, pt; cbn [px py pz]; try lra; repeat split; cbn; whole.
Qed.

Definition cube_facets : facets :=
  {| set_of := K6; basis := {| row0 := pt 1 0 0; row1 := pt 0 1 0; row2 := pt 0 0 1 |};
     basis_length := 1; over_square := 1; ends := fun _ => 1 |}.

Lemma cube_facets_sound : sound_facets cube_facets 1 tip.
Proof.
  unfold sound_facets, cube_facets. cbn [set_of basis basis_length over_square ends]. split.
  - unfold basis_of_length, square, dot, pt. cbn [row0 row1 row2 px py pz]. lra.
  - split; [| split].
    + rewrite Rmult_1_r, Rinv_1, Rminus_diag_eq, Rabs_R0 by reflexivity. pose proof v_value. lra.
    + unfold tip. rewrite norm_along, Rabs_R1. lra.
    + intros count f C (X & _ & _ & _). unfold basis_coordinates, tip, apply, dot, pt.
      cbn [basis row0 row1 row2 px py pz]. rewrite Rabs_R1. lra.
Qed.

Example rods_touch :
  ~ separates rod rod cube_facets (seen_from nowhere nowhere) (way_out rod rod (seen_from nowhere nowhere)).
Proof.
  apply (pairs_are_touched rod rod cube_facets cube_facets tip rod_sound rod_sound).
  exists tip, tip. pose proof tip_in_rod. pose proof cube_facets_sound. pose proof tip_place. auto 6.
Qed.

Example line_meets_rod : first_of (slabs_crossed rod (pt 2 0 0) (pt (-1) 0 0)) <= 1.
Proof.
  apply (lines_are_crossed rod (pt 2 0 0) (pt (-1) 0 0) (pt (-1) 0 0) tip 1 rod_sound).
  - repeat split; cbn; whole.
  - constructor; [| constructor]. cbn [low high normal reach rod]. rewrite norm_along, Rabs_R1.
    rewrite (Rabs_left (-1)) by lra. lra.
  - replace (minus _ _) with (pt 0 0 0) by (unfold minus, pt; cbn [px py pz]; f_equal; ring).
    rewrite !norm_along, Rabs_R0. apply Rmult_le_pos; [pose proof v_value; lra | apply Rabs_pos].
  - rewrite norm_along, Rabs_left by lra. apply Rle_trans with 1; [lra |]. apply IZR_le. vm_compute. easy.
  - split; [lra |]. apply IZR_le. vm_compute. easy.
  - left. lra.
  - exact tip_in_rod.
  - replace (plus (pt 2 0 0) (scaled 1 (pt (-1) 0 0))) with tip; [exact tip_place |].
    unfold plus, scaled, tip, pt. cbn [px py pz]. f_equal; ring.
Qed.

(* Theorem D: a part that is where its body is. *)
Example part_is_near :
  0 < norm_of (product unturned unturned) /\
  distance (posed (product unturned unturned) (transform g (rotation_of g unturned) tip tip) tip)
    (posed unturned tip (posed unturned tip tip)) * (1 + 16 * v) <= part_error 1 1.
Proof.
  assert (One : 1 <= big / 2).
  { apply Rle_trans with (IZR (2 ^ 299)); [apply IZR_le; vm_compute; easy |].
    unfold big. change (2 ^ 300)%Z with (2 * 2 ^ 299)%Z. rewrite mult_IZR. lra. }
  pose proof big_value. apply part_near; try exact unturned_sound.
  - unfold within, tip, pt. cbn [px py pz]. rewrite Rabs_R1, Rabs_R0. lra.
  - unfold within, tip, pt. cbn [px py pz]. rewrite Rabs_R1, Rabs_R0. lra.
  - split; [| exact One]. rewrite <- Rinv_1.
    apply Rinv_le_contravar; [lra | apply IZR_le; vm_compute; easy].
  - unfold tip. rewrite norm_along, Rabs_R1. lra.
Qed.

(* Theorem V: of three bodies the first moves away from the second, to the third. *)
Definition before (i : nat) : nat := nth i [1; 2; 9]%nat 0%nat.
Definition after (i : nat) : nat := nth i [8; 2; 9]%nat 0%nat.
Definition next_to (x y : nat) : bool := ((x =? S y) || (y =? S x))%nat.
Definition none (i j : nat) : bool := false.
Definition lists : nat -> nat -> bool := met nat next_to before none.

Example first_body_moves :
  let now := change_all [0%nat] (met nat next_to after none) lists in
  (lists 0%nat 1%nat, lists 1%nat 0%nat, lists 0%nat 2%nat) = (true, true, false) /\
  (now 0%nat 1%nat, now 1%nat 0%nat, now 0%nat 2%nat, now 2%nat 0%nat) = (false, false, true, true) /\
  forall i j, now i j = met nat next_to after none i j.
Proof.
  cbv zeta. split; [reflexivity |]. split; [reflexivity |].
  apply (kept_verdicts nat next_to) with (before := before) (was_excluded := none); try reflexivity.
  - intros x y. unfold next_to. apply orb_comm.
  - constructor; [easy | constructor].
  - intros [| i] H; [discriminate | reflexivity].
Qed.

(* Theorems F and K: balls of radius 1 about one point, which don't move. *)
Definition unit_ball : ball := {| centre := nowhere; radius := 1 |}.

Lemma unit_balls_reported : rejects gradual unit_ball unit_ball = false.
Proof.
  unfold rejects, Sphere.apart, unit_ball, nowhere, pt. cbn [centre radius px py pz].
  assert (Zero : fl gradual 0 = 0).
  { unfold fl. case Rlt_bool; [reflexivity |]. apply round_0. typeclasses eauto. }
  unfold add, sub, mul. rewrite !read_is, Rminus_0_r, Zero, Rmult_0_r, Zero.
  rewrite !Rplus_0_r, !Zero. apply not_greater. split; [lra |].
  apply fl_nonneg. apply Rle_0_sqr.
Qed.

Lemma unit_radius : radius_floor / 2 <= radius unit_ball <= IZR (2 ^ 200).
Proof.
  cbn [radius unit_ball]. unfold radius_floor. split.
  - assert (/ IZR (2 ^ 70) <= / 1) by (apply Rinv_le_contravar; [lra | apply IZR_le; vm_compute; easy]).
    lra.
  - apply IZR_le. vm_compute. easy.
Qed.

Example unit_balls_in_reach (axis : nat) :
  Rabs (coordinate_of axis (centre unit_ball) - coordinate_of axis (centre unit_ball))
    <= widen gradual gradual64 1 + widen gradual gradual64 1.
Proof. apply reported_within_reach; [exact unit_radius | exact unit_radius | exact unit_balls_reported]. Qed.

Example unit_balls_listed :
  rejects gradual (listed Lists.still false unit_ball) (listed Lists.still false unit_ball) = false.
Proof.
  destruct unit_radius as (R & _).
  apply (lists_hold_reported_pairs Lists.still false false unit_ball unit_ball unit_ball unit_ball
    still_sound R R R R); try reflexivity. exact unit_balls_reported.
Qed.

(* Theorem G: boxes that share a corner. *)
Example corner_boxes_not_parted :
  let a := {| lower := nowhere; upper := pt 1 1 1 |} in
  let b := {| lower := pt 1 1 1; upper := pt 2 2 2 |} in
  beyond (way a b) (add gradual (half_side a) (half_side b)) = false.
Proof.
  cbv zeta. apply cubes_lose_none.
  - unfold sound_box, nowhere, pt. cbn [lower upper px py pz]. repeat split; try lra; whole.
  - unfold sound_box, pt. cbn [lower upper px py pz]. repeat split; try lra; whole.
  - unfold boxes_meet, nowhere, pt. cbn [lower upper px py pz]. lra.
Qed.

(* Theorem U: a body that moves by 1 in a second and doesn't turn. *)
Example moving_point_contained :
  distance (posed unturned nowhere tip) (posed unturned tip tip)
    <= swept_margin tip nowhere nowhere 1 1.
Proof.
  assert (Far : 1 <= IZR (2 ^ 62)) by (apply IZR_le; vm_compute; easy).
  assert (N : norm_of unturned = 1) by (unfold norm_of, unturned; cbn [qx qy qz qw]; ring).
  assert (T : norm tip = 1) by (unfold tip; rewrite norm_along; apply Rabs_R1).
  assert (Z : norm nowhere = 0) by (unfold nowhere; rewrite norm_along; apply Rabs_R0).
  apply (swept_contains unturned unturned unturned nowhere tip tip tip nowhere nowhere 1 1 0);
    rewrite ?N, ?T, ?Z; try lra.
  - cbn [qw unturned]. unfold Rdiv. now rewrite Rmult_0_l, cos_0.
  - intro p. assert (I : forall x, apply (exact_rotation unturned) x = x).
    { intro x. pose proof (unturned_posed x nowhere) as P. unfold posed in P.
      destruct x as [a b c], (apply (exact_rotation unturned) {| px := a; py := b; pz := c |}) as [i j k].
      unfold plus, nowhere, pt in P. cbn [px py pz] in P. injection P as P0 P1 P2. f_equal; lra. }
    now rewrite !I.
  - unfold distance. replace (minus tip nowhere) with tip; [lra |].
    unfold minus, tip, nowhere, pt. cbn [px py pz]. f_equal; ring.
Qed.
