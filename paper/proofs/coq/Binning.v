(* Theorem B without rounding: a polytope lies in a ball about its slabs' centre, and two that are
   farther apart than the radii by which they are binned are separated along a normal of the first.
   *)
From Coq Require Import Reals Bool List Lra Classical.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Pose Duality Vectors Separated.
Import ListNotations.
Open Scope R_scope.

(* src/overlap/ordop/reach.rs: reach. What it multiplies the largest half width by is the square of
   this. *)
Definition factor (k : kind) : R :=
  match k with K6 => 3 | K14 => 1.536 | K18 => 1.5 | K26 => 1.273 end.
Definition spread (k : kind) : R := sqrt (factor k).

Lemma spread_square (k : kind) : 1 <= spread k /\ spread k * spread k = factor k.
Proof.
  split; [| apply sqrt_sqrt; destruct k; cbn; lra].
  unfold spread. rewrite <- sqrt_1 at 1. apply sqrt_le_1_alt. destruct k; cbn; lra.
Qed.

(* The slabs of a ball of radius w. *)
Definition ball_slabs (w : R) : slabs :=
  fun member => (w * norm (direction member), w * norm (direction member)).

(* Coefficients in any order, by Cauchy and Schwarz. *)
Lemma weighted (k : kind) (a b c p q r : R) :
  p * p + q * q + r * r <= factor k -> p * a + q * b + r * c <= spread k * norm (pt a b c).
Proof.
  intro H. pose proof (dot_norms (pt p q r) (pt a b c)) as D.
  change (p * a + q * b + r * c) with (dot (pt p q r) (pt a b c)).
  apply Rle_trans with (1 := Rle_abs _). apply Rle_trans with (1 := D).
  apply Rmult_le_compat_r; [apply norm_nonneg |]. unfold norm, spread. apply sqrt_le_1_alt.
  exact H.
Qed.

Section Octant.
Variables a b c : R.
Hypothesis Ha : 0 <= a.
Hypothesis Hb : 0 <= b.
Hypothesis Hc : 0 <= c.
Variables t h : R.
Hypothesis T : t * t = 2.
Hypothesis H : h * h = 3.
Hypothesis T0 : 1.414 <= t <= 1.4143.
Hypothesis H0 : 1.732 <= h <= 1.7321.

(* Minima and maxima of numbers whose order is known, innermost first. *)
Ltac plain x := lazymatch x with context [Rmin _ _] => fail | context [Rmax _ _] => fail | _ =>
  idtac end.
Ltac in_order :=
  repeat match goal with
  | |- context [Rmin ?x ?y] => plain x; plain y;
    first [rewrite (Rmin_left x y) by lra | rewrite (Rmin_right x y) by lra]
  | |- context [Rmax ?x ?y] => plain x; plain y;
    first [rewrite (Rmax_left x y) by lra | rewrite (Rmax_right x y) by lra]
  end.

Lemma spread_6 : support_6 1 1 1 a b c <= spread K6 * norm (pt a b c).
Proof.
  pose proof (weighted K6 a b c 1 1 1 ltac:(cbn; lra)). unfold support_6. lra.
Qed.

Lemma spread_14 : support_14 1 1 1 h h h h a b c <= spread K14 * norm (pt a b c).
Proof.
  assert (S : 1 * 1 + (h - 1) * (h - 1) <= 1.536) by nra.
  pose proof (weighted K14 a b c 1 (h - 1) 0 ltac:(cbn; lra)) as W1.
  pose proof (weighted K14 a b c 1 0 (h - 1) ltac:(cbn; lra)) as W2.
  pose proof (weighted K14 a b c (h - 1) 1 0 ltac:(cbn; lra)) as W3.
  pose proof (weighted K14 a b c 0 1 (h - 1) ltac:(cbn; lra)) as W4.
  pose proof (weighted K14 a b c (h - 1) 0 1 ltac:(cbn; lra)) as W5.
  pose proof (weighted K14 a b c 0 (h - 1) 1 ltac:(cbn; lra)) as W6.
  unfold support_14, leads, lead. cbv zeta.
  destruct (Rle_dec a b), (Rle_dec b c), (Rle_dec a c); try (exfalso; lra); in_order; lra.
Qed.

Lemma spread_18 : support_18 1 1 1 t t t a b c <= spread K18 * norm (pt a b c).
Proof.
  assert (S : 1 * 1 + (t - 1) * (t - 1) + (t - 1) * (t - 1) <= 1.5) by nra.
  assert (S' : t / 2 * (t / 2) = / 2) by lra.
  pose proof (weighted K18 a b c (t / 2) (t / 2) (t / 2) ltac:(cbn; lra)) as W0.
  pose proof (weighted K18 a b c 1 (t - 1) (t - 1) ltac:(cbn; lra)) as W1.
  pose proof (weighted K18 a b c (t - 1) 1 (t - 1) ltac:(cbn; lra)) as W2.
  pose proof (weighted K18 a b c (t - 1) (t - 1) 1 ltac:(cbn; lra)) as W3.
  unfold support_18. cbv zeta.
  destruct (Rle_dec a (b + c)), (Rle_dec b (a + c)), (Rle_dec c (a + b));
    try (exfalso; lra); in_order; lra.
Qed.

Lemma spread_26 : support_26 1 1 1 t t t h a b c <= spread K26 * norm (pt a b c).
Proof.
  assert (S : 1 * 1 + (t - 1) * (t - 1) + (h - t) * (h - t) <= 1.273).
  { assert (t * h >= 1.414 * 1.732) by nra. nra. }
  pose proof (weighted K26 a b c 1 (t - 1) (h - t) ltac:(cbn; lra)) as W1.
  pose proof (weighted K26 a b c 1 (h - t) (t - 1) ltac:(cbn; lra)) as W2.
  pose proof (weighted K26 a b c (t - 1) 1 (h - t) ltac:(cbn; lra)) as W3.
  pose proof (weighted K26 a b c (h - t) 1 (t - 1) ltac:(cbn; lra)) as W4.
  pose proof (weighted K26 a b c (t - 1) (h - t) 1 ltac:(cbn; lra)) as W5.
  pose proof (weighted K26 a b c (h - t) (t - 1) 1 ltac:(cbn; lra)) as W6.
  unfold support_26, leads, lead. cbv zeta.
  destruct (Rle_dec a b), (Rle_dec b c), (Rle_dec a c); try (exfalso; lra); in_order; lra.
Qed.
End Octant.

(* Directions' lengths. *)
Lemma lengths :
  norm (direction 0) = 1 /\ norm (direction 1) = 1 /\ norm (direction 2) = 1 /\
  (forall member, In member [3; 4; 5; 6; 7; 8]%nat -> norm (direction member) = sqrt 2) /\
  (forall member, In member [9; 10; 11; 12]%nat -> norm (direction member) = sqrt 3).
Proof.
  unfold norm, square, direction, directions, pt.
  repeat split.
  1-3: cbn [nth map px py pz]; transitivity (sqrt 1); [f_equal; ring | apply sqrt_1].
  all: intros member M; cbn in M; repeat (destruct M as [<- | M]); [.. | destruct M];
    cbn [nth map px py pz]; f_equal; ring.
Qed.

(* The support of a ball's slabs. *)
Lemma ball_support (k : kind) (w : R) (signs : bool * bool * bool) (e : point) :
  0 <= w -> support k (ball_slabs w) signs e <= w * (spread k * norm e).
Proof.
  intro W. destruct signs as [[i j] l].
  set (t := sqrt 2). set (h := sqrt 3).
  assert (T : t * t = 2) by (apply sqrt_sqrt; lra).
  assert (H : h * h = 3) by (apply sqrt_sqrt; lra).
  assert (T0 : 1.414 <= t <= 1.4143).
  { pose proof (sqrt_pos 2) as P. fold t in P. split; nra. }
  assert (H0 : 1.732 <= h <= 1.7321).
  { pose proof (sqrt_pos 3) as P. fold h in P. split; nra. }
  destruct lengths as (L0 & L1 & L2 & Lt & Lh). fold t in Lt. fold h in Lh.
  assert (E : forall member n, end_of (ball_slabs w) member n = w * norm (direction member))
    by (intros; destruct n; reflexivity).
  assert (Pair : forall member x y, In member [3; 5; 7]%nat ->
    pair (ball_slabs w) member x y = w * t).
  { intros member x y M. unfold pair. rewrite E. f_equal. apply Lt.
    cbn in M |- *. repeat (destruct M as [<- | M]); [.. | destruct M]; destruct (xorb x y); tauto. }
  assert (Facing : forall x y z, facing (ball_slabs w) x y z = w * h).
  { intros x y z. unfold facing. rewrite E. f_equal. apply Lh.
    destruct (xorb x z), (xorb y z); cbn; tauto. }
  pose proof (Rabs_pos (px e)) as A. pose proof (Rabs_pos (py e)) as B.
  pose proof (Rabs_pos (pz e)) as C.
  assert (N : norm e = norm (pt (Rabs (px e)) (Rabs (py e)) (Rabs (pz e))))
    by (symmetry; apply norm_absolute).
  rewrite N. unfold support. rewrite !E, L0, L1, L2, !Pair, !Facing by (cbn; tauto).
  set (a := Rabs (px e)) in *. set (b := Rabs (py e)) in *. set (c := Rabs (pz e)) in *.
  clearbody a b c t h. clear Pair Facing E L0 L1 L2 Lt Lh N.
  destruct k.
  - assert (S : support_6 1 1 1 a b c <= spread K6 * norm (pt a b c)) by (now apply spread_6).
    apply (Rmult_le_compat_l w _ _ W) in S. unfold support_6 in *. lra.
  - assert (S : support_14 1 1 1 h h h h a b c <= spread K14 * norm (pt a b c))
      by (now apply spread_14).
    apply (Rmult_le_compat_l w _ _ W) in S. unfold support_14, leads in *. cbv zeta in *. lra.
  - assert (S : support_18 1 1 1 t t t a b c <= spread K18 * norm (pt a b c))
      by (now apply spread_18).
    apply (Rmult_le_compat_l w _ _ W) in S. unfold support_18 in *. cbv zeta in *. lra.
  - assert (S : support_26 1 1 1 t t t h a b c <= spread K26 * norm (pt a b c))
      by (now apply spread_26).
    apply (Rmult_le_compat_l w _ _ W) in S. unfold support_26, leads in *. cbv zeta in *. lra.
Qed.

Lemma any_signs (e : point) : exists signs, signs_of signs e.
Proof.
  assert (One : forall x, exists n, sign_of n x).
  { intro x. destruct (Rle_or_lt 0 x); [exists false | exists true]; cbn; lra. }
  destruct (One (px e)) as (i & I). destruct (One (py e)) as (j & J).
  destruct (One (pz e)) as (l & L).
  now exists (i, j, l).
Qed.

Lemma within_ball_slabs (k : kind) (w : R) (z : point) :
  0 <= w -> inside k (ball_slabs w) z -> norm z <= spread k * w.
Proof.
  intros W I. destruct (any_signs z) as (signs & S).
  pose proof (support_bounds k (ball_slabs w) signs z z S I) as B.
  pose proof (ball_support k w signs z W) as C. pose proof (norm_nonneg z) as N.
  replace (dot z z) with (norm z * norm z) in B by apply norm_square.
  destruct (Req_dec (norm z) 0) as [Z | Z].
  - rewrite Z. apply Rmult_le_pos; [apply sqrt_pos | exact W].
  - apply Rmult_le_reg_r with (norm z); lra.
Qed.

(* The largest half width, as `reach` takes it. *)
Definition no_wider (k : kind) (s : slabs) (w : R) : Prop :=
  forall member, In member (members k) ->
    fst (s member) <= w * norm (direction member) /\ snd (s member) <= w * norm (direction member).

Theorem polytope_in_ball (k : kind) (s : slabs) (w : R) (z : point) :
  0 <= w -> no_wider k s w -> inside k s z -> norm z <= spread k * w.
Proof.
  intros W H I. apply within_ball_slabs; [exact W |]. intros member M.
  destruct (I member M), (H member M). unfold ball_slabs. cbn [fst snd]. lra.
Qed.

(* Beyond the radii, a normal d of the first body separates: the gap along d exceeds both supports,
   that of the other body along e, as long as d. *)
Theorem far_ordops_separated (k : kind) (qa : matrix) (gap : point) (wa wb : R) :
  orthonormal qa -> 0 <= wa -> 0 <= wb -> factor k * (wa + wb) < norm gap ->
  exists member, In member (members k) /\
    forall s signs e, no_wider k s wa -> norm e = norm (direction member) ->
      Rmax (fst (s member)) (snd (s member)) + support k (ball_slabs wb) signs e
        < Rabs (dot (direction member) (apply qa gap)).
Proof.
  intros O Wa Wb Far. destruct (spread_square k) as (C1 & C2).
  set (reach := spread k * (wa + wb)).
  assert (P : 0 <= reach) by (apply Rmult_le_pos; lra).
  destruct (classic (inside k (ball_slabs reach) (apply qa gap))) as [I | I].
  - exfalso. pose proof (within_ball_slabs k reach _ P I) as N.
    rewrite apply_keeps_norm in N by exact O. unfold reach in N.
    replace (spread k * (spread k * (wa + wb))) with (factor k * (wa + wb)) in N
      by (rewrite <- C2; ring). lra.
  - apply not_all_ex_not in I. destruct I as (member & I). apply imply_to_and in I.
    destruct I as (M & I). exists member. split; [exact M |]. intros s signs e H E.
    destruct (H member M) as (F & G). pose proof (ball_support k wb signs e Wb) as B.
    rewrite E in B.
    pose proof (norm_nonneg (direction member)) as N.
    assert (Out : reach * norm (direction member) < Rabs (dot (direction member) (apply qa gap))).
    { apply Rnot_le_lt. intro L. apply I. apply Rabs_le_inv in L. unfold ball_slabs.
      cbn [fst snd]. lra. }
    assert (Own : wa * norm (direction member) <= spread k * (wa * norm (direction member))).
    { rewrite <- (Rmult_1_l (wa * norm (direction member))) at 1.
      apply Rmult_le_compat_r; [now apply Rmult_le_pos | exact C1]. }
    apply Rle_lt_trans with (2 := Out). unfold reach.
    pose proof (Rmax_lub _ _ _ F G). lra.
Qed.
