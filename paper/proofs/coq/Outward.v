(* Theorem O and what follows from it alone: numbers rounded outward are outward, whatever cancels;
   sweeps' ends, cubes about boxes, balls with a margin, lists of long boxes. With gradual underflow,
   the mode in which the code computes. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double WorldBall Ieee Shows.
Open Scope R_scope.

Definition format32 : R -> Prop := generic_format radix2 (FLT_exp (-149) 24).
Definition format64 : R -> Prop := generic_format radix2 (FLT_exp (-1074) 53).

Lemma format32_64 (x : R) : format32 x -> format64 x.
Proof.
  intro H. apply generic_inclusion_mag with (FLT_exp (-149) 24); [| exact H].
  intros _. unfold FLT_exp. lia.
Qed.

(* src/rounding/mod.rs: up, down *)
Definition next_above (x : R) : R := WorldBall.up gradual x.
Definition next_below (x : R) : R := - next_above (- x).

Lemma next_above_format (x : R) : format32 (next_above x).
Proof.
  unfold next_above, WorldBall.up. rewrite gradual_fl. apply generic_format_succ.
  - typeclasses eauto.
  - apply generic_format_round; typeclasses eauto.
Qed.

(* `up` of the outcome of one f64 operation is no less than the exact one. *)
Theorem up_outward (x : R) : x <= next_above (fl64 gradual64 x).
Proof.
  pose proof (next_above_format (fl64 gradual64 x)) as F.
  unfold next_above, WorldBall.up in *. rewrite gradual_fl, gradual_fl64 in *.
  set (y := nearest64 x) in *. set (z := succ radix2 (FLT_exp (-149) 24) (nearest32 y)) in *.
  destruct (Rle_or_lt x z) as [H | H]; [exact H | exfalso].
  assert (L : z <= y).
  { unfold y, nearest64. rewrite <- (round_generic radix2 (FLT_exp (-1074) 53) ZnearestE z)
      by now apply format32_64.
    apply round_le; [typeclasses eauto | typeclasses eauto | now apply Rlt_le]. }
  assert (U : y <= z).
  { unfold z, nearest32. apply succ_round_ge_id; typeclasses eauto. }
  assert (E : y = z) by lra.
  assert (S : nearest32 z = z) by (unfold nearest32; now apply round_generic; [typeclasses eauto |]).
  assert (Z : z = succ radix2 (FLT_exp (-149) 24) z).
  { transitivity (succ radix2 (FLT_exp (-149) 24) (nearest32 y)); [reflexivity |].
    now rewrite E, S. }
  destruct (Req_dec z 0) as [N | N].
  - rewrite N, succ_0 in Z. unfold ulp in Z. rewrite Req_bool_true in Z by reflexivity. revert Z.
    destruct (negligible_exp_FLT (-149) 24) as (n & -> & _). intro Z.
    pose proof (bpow_gt_0 radix2 (FLT_exp (-149) 24 n)). lra.
  - pose proof (succ_gt_id radix2 (FLT_exp (-149) 24) z N). lra.
Qed.

Theorem down_outward (x : R) : next_below (fl64 gradual64 x) <= x.
Proof.
  unfold next_below. rewrite !gradual_fl64. unfold nearest64.
  rewrite <- round_NE_opp. change (round _ _ _ (- x)) with (nearest64 (- x)).
  rewrite <- gradual_fl64. pose proof (up_outward (- x)). lra.
Qed.

Lemma read64_is (x : R) : read64 gradual64 x = x.
Proof. reflexivity. Qed.

Lemma sum_outward (a b : R) : a + b <= next_above (add64 gradual64 a b).
Proof. apply up_outward. Qed.
Lemma difference_outward (a b : R) : next_below (sub64 gradual64 a b) <= a - b.
Proof. apply down_outward. Qed.

(* src/broad_phase/sweep.rs: Sweep::end. Of two balls whose centres are no farther apart along an
   axis than their widened radii together, the one that begins later begins before the other ends. *)
Definition sweep_end (x w : R) : R := next_above (add64 gradual64 x w).
Definition sweep_start (x w : R) : R := next_below (sub64 gradual64 x w).

Theorem sweep_finds (x w y r : R) : Rabs (y - x) <= w + r -> sweep_start y r <= sweep_end x w.
Proof.
  intro H. apply Rabs_le_inv in H. pose proof (difference_outward y r).
  pose proof (sum_outward x w). unfold sweep_start, sweep_end. lra.
Qed.

(* src/update/intervals.rs: cube_about, one axis, wherever its centre was rounded to. Cubes' half
   sides are the largest of the axes'. *)
Definition half_about (lo hi centre : R) : R :=
  next_above (Rmax (sub64 gradual64 hi centre) (sub64 gradual64 centre lo)).

Lemma next_above_monotone (x y : R) : x <= y -> next_above x <= next_above y.
Proof.
  intro H. unfold next_above, WorldBall.up. rewrite !gradual_fl. apply succ_le.
  - typeclasses eauto.
  - apply generic_format_round; typeclasses eauto.
  - apply generic_format_round; typeclasses eauto.
  - unfold nearest32. apply round_le; [typeclasses eauto | typeclasses eauto | exact H].
Qed.

Theorem cube_contains (lo hi centre half : R) :
  half_about lo hi centre <= half -> centre - half <= lo /\ hi <= centre + half.
Proof.
  intro H. unfold half_about in H.
  pose proof (next_above_monotone _ _ (Rmax_l (sub64 gradual64 hi centre)
    (sub64 gradual64 centre lo))) as A.
  pose proof (next_above_monotone _ _ (Rmax_r (sub64 gradual64 hi centre)
    (sub64 gradual64 centre lo))) as B.
  pose proof (up_outward (hi - centre)) as C. pose proof (up_outward (centre - lo)) as D.
  unfold sub64 in *. rewrite !read64_is in *. lra.
Qed.

(* Boxes that meet have cubes that do: their centres are no farther apart along any axis than their
   half sides together. *)
Theorem boxes_that_meet_have_near_cubes (lo hi c h lo' hi' c' h' : R) :
  half_about lo hi c <= h -> half_about lo' hi' c' <= h' -> lo <= hi' -> lo' <= hi ->
  Rabs (c' - c) <= h + h'.
Proof.
  intros A B M N. destruct (cube_contains _ _ _ _ A). destruct (cube_contains _ _ _ _ B).
  apply Rabs_le. lra.
Qed.

(* Theorem M. src/update/frame.rs: ShapeFrame::grown. What lies up to a margin from a point of a ball
   lies in the grown ball; the reach grows in the same way. *)
Definition grown (size margin : R) : R := next_above (add64 gradual64 size margin).

Theorem ball_with_margin (b : ball) (p x : point) (margin : R) :
  in_ball x b -> distance p x <= margin ->
  in_ball p {| centre := centre b; radius := grown (radius b) margin |}.
Proof.
  unfold in_ball, grown. cbn [centre radius]. intros H M.
  pose proof (distance_triangle p x (centre b)). pose proof (sum_outward (radius b) margin). lra.
Qed.

(* Theorem W. src/broad_phase/ends.rs: EndSlots::hold, with_common_points, which compare ends
   without arithmetic. Of boxes within grown ones, those that meet have grown ones that meet, so that
   a list of these holds them. *)
Record extent := { low : R; high : R }.
Definition within_extent (a b : extent) : bool :=
  negb (Rlt_bool (low a) (low b)) && negb (Rlt_bool (high b) (high a)).
Definition parted (a b : extent) : bool := Rlt_bool (high b) (low a) || Rlt_bool (high a) (low b).

Lemma not_below (x y : R) : negb (Rlt_bool x y) = true -> y <= x.
Proof. case Rlt_bool_spec; intros; [discriminate | assumption]. Qed.

Theorem grown_boxes_meet (a b grown_a grown_b : extent) :
  within_extent a grown_a = true -> within_extent b grown_b = true ->
  parted grown_a grown_b = true -> parted a b = true.
Proof.
  unfold within_extent, parted. intros A B. apply andb_prop in A, B.
  destruct A as [A1 A2], B as [B1 B2]. apply not_below in A1, A2, B1, B2.
  do 4 case Rlt_bool_spec; intros; try reflexivity; try discriminate; exfalso; lra.
Qed.

Lemma read_is (x : R) : read gradual x = x.
Proof. reflexivity. Qed.

(* src/broad_phase/ends.rs: grown. An end of a grown box is no farther out than the box's own and
   the skin, so that the grid, whose reach is that of theorem K, hands it over. *)
Definition grown_extent (a : extent) (skin : R) : extent :=
  {| low := Rmin (low a) (succ radix2 (FLT_exp (-149) 24) (sub gradual (low a) skin));
     high := Rmax (high a) (pred radix2 (FLT_exp (-149) 24) (add gradual (high a) skin)) |}.

Theorem grown_no_farther (a : extent) (skin : R) :
  0 <= skin -> low a - skin <= low (grown_extent a skin) /\
  high (grown_extent a skin) <= high a + skin.
Proof.
  intro P. unfold grown_extent. cbn [low high]. unfold sub, add.
  rewrite !read_is, !gradual_fl. split.
  - apply Rmin_glb; [lra |]. unfold nearest32. apply succ_round_ge_id; typeclasses eauto.
  - apply Rmax_lub; [lra |]. unfold nearest32. apply pred_round_le_id; typeclasses eauto.
Qed.
