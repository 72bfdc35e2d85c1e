(* Theorem V: verdicts that are kept from one cull to the next, and cells in which a changed body's
   partners are looked for. *)
From Coq Require Import Reals ZArith Bool List Lra Lia Arith.
From Flocq Require Import Core.
From Sdop Require Import Format Double Ieee Shows Cells Outward Finder.
Import ListNotations.
Open Scope R_scope.

(* 1. Lists of partners. *)
Section Partners.
(* What a verdict depends on: of each slot its value, and of each pair whether it is excluded. An
   empty slot is a value, too. *)
Variable value : Type.
Variable verdict : value -> value -> bool.
Hypothesis verdict_symmetric : forall x y, verdict x y = verdict y x.
Variables before after : nat -> value.
Variables was_excluded is_excluded : nat -> nat -> bool.
Hypothesis was_symmetric : forall i j, was_excluded i j = was_excluded j i.
Hypothesis is_symmetric : forall i j, is_excluded i j = is_excluded j i.

Definition met (values : nat -> value) (excluded : nat -> nat -> bool) (i j : nat) : bool :=
  negb (i =? j) && verdict (values i) (values j) && negb (excluded i j).

(* The slots that were noted since the last cull, each once: what isn't noted hasn't changed. *)
Variable noted : list nat.
Definition changed (i : nat) : bool := existsb (Nat.eqb i) noted.
Hypothesis noted_once : NoDup noted.
Hypothesis values_noted : forall i, changed i = false -> after i = before i.
Hypothesis exclusions_noted : forall i j,
  changed i = false -> changed j = false -> is_excluded i j = was_excluded i j.

(* What Movers::find has found for each noted slot. *)
Variable found : nat -> nat -> bool.
Hypothesis found_all : forall i j, changed i = true -> found i j = met after is_excluded i j.

(* src/living/live_pairs.rs: LivePairs::apply. A noted slot gets the list that was found; where that
   differs from its former one, lists of slots that aren't noted are changed as well. *)
Definition change (lists : nat -> nat -> bool) (i : nat) : nat -> nat -> bool :=
  fun a b =>
    if a =? i then found i b
    else if (b =? i) && xorb (lists i a) (found i a) && negb (changed a) then found i a
    else lists a b.
Definition change_all (lists : nat -> nat -> bool) : nat -> nat -> bool :=
  fold_left change noted lists.

Lemma changed_in (i : nat) : changed i = true <-> In i noted.
Proof.
  unfold changed. rewrite existsb_exists. split.
  - intros (j & H & E). apply Nat.eqb_eq in E. now subst.
  - intro H. exists i. split; [exact H | apply Nat.eqb_refl].
Qed.

Lemma met_symmetric (values : nat -> value) (excluded : nat -> nat -> bool) (i j : nat) :
  (forall i j, excluded i j = excluded j i) -> met values excluded i j = met values excluded j i.
Proof. intro S. unfold met. now rewrite Nat.eqb_sym, verdict_symmetric, S. Qed.

(* After some of the noted slots: their lists are new, those of noted ones that are still to come
   are as before, and of other slots the entries for the former are new. *)
Lemma change_some (lists : nat -> nat -> bool) (done : list nat) :
  NoDup done -> (forall i, In i done -> changed i = true) ->
  (forall a b, lists a b = met before was_excluded a b) ->
  forall a b, fold_left change done lists a b =
    if changed a then if existsb (Nat.eqb a) done then met after is_excluded a b else lists a b
    else if existsb (Nat.eqb b) done then met after is_excluded a b else lists a b.
Proof.
  intros N C L. induction done as [| i done IH] using rev_ind; intros a b.
  - cbn. now destruct (changed a).
  - assert (N' : NoDup done /\ ~ In i done).
    { apply NoDup_remove in N. rewrite app_nil_r in N. exact N. }
    destruct N' as (N' & I). assert (C' : forall j, In j done -> changed j = true)
      by (intros j J; apply C, in_or_app; now left).
    assert (Ci : changed i = true) by (apply C, in_or_app; right; now left).
    specialize (IH N' C'). rewrite fold_left_app. cbn [fold_left]. unfold change at 1.
    set (state := fold_left change done lists) in *.
    assert (Old : state i a = lists i a).
    { rewrite IH, Ci. destruct (existsb (Nat.eqb i) done) eqn:E; [| reflexivity].
      exfalso. apply I. apply existsb_exists in E. destruct E as (j & J & E). apply Nat.eqb_eq in E.
      now subst. }
    rewrite !existsb_app. cbn [existsb]. rewrite !orb_false_r.
    destruct (a =? i) eqn:Ai.
    + apply Nat.eqb_eq in Ai. subst a. rewrite Ci, orb_true_r. now apply found_all.
    + rewrite orb_false_r, Old, found_all by exact Ci. rewrite IH.
      destruct (changed a) eqn:Ca; [now rewrite andb_false_r |]. rewrite andb_true_r.
      destruct (b =? i) eqn:Bi; cbn [andb].
      * apply Nat.eqb_eq in Bi. subst b. rewrite orb_true_r.
        destruct (xorb (lists i a) (met after is_excluded i a)) eqn:X; [now apply met_symmetric |].
        apply xorb_eq in X. destruct (existsb (Nat.eqb i) done); [reflexivity |].
        (* The entry was right before, and it still is. *)
        rewrite (met_symmetric after), <- X, !L by assumption. now apply met_symmetric.
      * now rewrite orb_false_r.
Qed.

(* From the pairs of the last cull, those of this one. *)
Theorem kept_verdicts (lists : nat -> nat -> bool) :
  (forall i j, lists i j = met before was_excluded i j) ->
  forall i j, change_all lists i j = met after is_excluded i j.
Proof.
  intros L i j. unfold change_all.
  rewrite change_some by (try assumption; intros; now apply changed_in).
  fold (changed i) (changed j). destruct (changed i) eqn:I; [reflexivity |].
  destruct (changed j) eqn:J; [reflexivity |].
  rewrite L. unfold met. now rewrite !values_noted, exclusions_noted.
Qed.

(* Which slot, at its turn, notes that a pair has begun or ended (the same function). *)
Definition notes (lists : nat -> nat -> bool) (i j : nat) : bool :=
  changed i && xorb (lists i j) (found i j) && (negb (changed j) || (i <? j)).

(* Each pair that begins or ends is noted once, and no other. *)
Theorem changes_noted_once (lists : nat -> nat -> bool) (i j : nat) :
  (forall i j, lists i j = met before was_excluded i j) ->
  notes lists i j || notes lists j i = xorb (lists i j) (met after is_excluded i j) /\
  notes lists i j && notes lists j i = false.
Proof.
  intro L. unfold notes. pose proof (kept_verdicts lists L i j) as K. unfold change_all in K.
  assert (Sl : lists j i = lists i j) by (rewrite !L; now apply met_symmetric).
  assert (Sf : forall a b, changed a = true -> found a b = met after is_excluded a b) by assumption.
  assert (Sm : met after is_excluded j i = met after is_excluded i j) by now apply met_symmetric.
  assert (Same : changed i = false -> changed j = false ->
    lists i j = met after is_excluded i j).
  { intros I J. rewrite L. unfold met. now rewrite !values_noted, exclusions_noted. }
  assert (Irr : i = j -> lists i j = false /\ met after is_excluded i j = false).
  { intros ->. rewrite L. unfold met. now rewrite Nat.eqb_refl. }
  destruct (changed i) eqn:I, (changed j) eqn:J; cbn [andb orb negb];
    rewrite ?(Sf i j I), ?(Sf j i J), ?Sl, ?Sm.
  - destruct (Nat.eq_dec i j) as [E | N].
    + destruct (Irr E) as (-> & ->). now subst.
    + destruct (Nat.ltb_spec i j) as [A | A], (Nat.ltb_spec j i) as [B | B]; try lia;
        destruct (xorb (lists i j) (met after is_excluded i j)); now cbn.
  - rewrite orb_false_r, andb_true_r, andb_false_r. now destruct (xorb _ _).
  - rewrite andb_true_r. now destruct (xorb _ _).
  - rewrite (Same eq_refl eq_refl), xorb_nilpotent. now cbn.
Qed.
End Partners.

(* 2. Cells. *)
Local Notation g := gradual64.

(* The next f64 above or below. *)
Definition above (x : R) : R := succ radix2 (FLT_exp (-1074) 53) x.
Definition below (x : R) : R := pred radix2 (FLT_exp (-1074) 53) x.

Lemma rounded_format64 (x : R) : generic_format radix2 (FLT_exp (-1074) 53) (nearest64 x).
Proof. apply generic_format_round; typeclasses eauto. Qed.

Lemma below_less (x : R) : generic_format radix2 (FLT_exp (-1074) 53) x -> below x < x.
Proof.
  intro F. destruct (Req_dec x 0) as [-> | N]; [| now apply pred_lt_id].
  unfold below. rewrite pred_0.
  rewrite ulp_FLT_0 by typeclasses eauto. pose proof (bpow_gt_0 radix2 (-1074)). lra.
Qed.

Lemma above_more (x : R) : generic_format radix2 (FLT_exp (-1074) 53) x -> x < above x.
Proof.
  intro F. pose proof (below_less (- x) (generic_format_opp _ _ _ F)) as L.
  unfold below, above in *. rewrite pred_opp in L. lra.
Qed.

Lemma below_rounded (x : R) : below (fl64 g x) <= x.
Proof.
  rewrite gradual_fl64. pose proof (rounded_format64 x) as F.
  destruct (Rle_or_lt (below (nearest64 x)) x) as [L | L]; [exact L | exfalso].
  assert (B : generic_format radix2 (FLT_exp (-1074) 53) (below (nearest64 x)))
    by (apply generic_format_pred; [typeclasses eauto | exact F]).
  pose proof (nearest64_monotone _ _ (Rlt_le _ _ L)) as M.
  unfold nearest64 in M at 2. rewrite round_generic in M by (typeclasses eauto || exact B).
  pose proof (below_less _ F). lra.
Qed.

Lemma above_rounded (x : R) : x <= above (fl64 g x).
Proof.
  pose proof (below_rounded (- x)) as L. rewrite gradual_fl64 in *.
  assert (E : nearest64 (- x) = - nearest64 x) by apply round_NE_opp.
  rewrite E in L. unfold below, above in *. rewrite pred_opp in L. lra.
Qed.

(* src/broad_phase/box_index/levels.rs: longest_side, Levels::level_of, BoxLevel::new. What a size
   is rounded up to isn't less: SMT shows it of size_of_number(size_number(size)). *)
Definition longest_side (x y z : R) : R := above (Rmax (Rmax (Rmax 0 x) y) z).
Definition size_in_units (side unit_ : R) : R := above (div64 g side unit_).
Definition bound_of (size unit_ : R) : R := above (mul64 g unit_ size).

Theorem bound_exceeds_sides (lo hi : R) (x y z unit_ size : R) :
  0 < unit_ -> generic_format radix2 (FLT_exp (-1074) 53) (Rmax (Rmax (Rmax 0 x) y) z) ->
  sub64 g hi lo <= Rmax (Rmax (Rmax 0 x) y) z ->
  size_in_units (longest_side x y z) unit_ <= size ->
  hi - lo <= bound_of size unit_.
Proof.
  intros U F S N. set (m := Rmax _ _) in *.
  assert (A : hi - lo <= above m).
  { apply Rle_trans with (1 := above_rounded (hi - lo)). unfold sub64 in S. rewrite !read64_is in S.
    unfold above. apply succ_le; [typeclasses eauto | | exact F | exact S].
    rewrite gradual_fl64. apply rounded_format64. }
  unfold size_in_units, bound_of, div64, mul64, longest_side in *. fold m in N.
  rewrite !read64_is in *.
  pose proof (above_rounded (above m / unit_)) as B. pose proof (above_rounded (unit_ * size)) as C.
  apply Rle_trans with (1 := A). apply Rle_trans with (2 := C).
  apply Rmult_le_reg_r with (/ unit_); [now apply Rinv_0_lt_compat |].
  replace (unit_ * size * / unit_) with size by (field; lra). unfold Rdiv in *. lra.
Qed.

(* src/broad_phase/box_index/levels.rs: BoxLevel::cell, cells_near. The cast to i64 saturates. *)
Definition level_cell (cells_per_unit x : R) : Z :=
  Z.max (- 2 ^ 63) (Z.min (2 ^ 63 - 1) (Zfloor (mul64 g x cells_per_unit))).
Definition first_near (bound low : R) : R := below (sub64 g low bound).

Theorem partner_in_near_cells (bound cells_per_unit lo hi lo' hi' : R) :
  0 <= cells_per_unit -> hi' - lo' <= bound -> lo <= hi' -> lo' <= hi ->
  (level_cell cells_per_unit (first_near bound lo) <= level_cell cells_per_unit lo'
    <= level_cell cells_per_unit hi)%Z.
Proof.
  intros W B L H.
  assert (M : forall x y, x <= y -> (level_cell cells_per_unit x <= level_cell cells_per_unit y)%Z).
  { intros x y E. unfold level_cell. apply Z.max_le_compat_l, Z.min_le_compat_l, Zfloor_le.
    unfold mul64. rewrite !read64_is. apply fl64_monotone. now apply Rmult_le_compat_r. }
  split; apply M; [| exact H]. unfold first_near, sub64. rewrite !read64_is.
  apply Rle_trans with (1 := below_rounded (lo - bound)). lra.
Qed.
