(* Two rules that Gappa uses on formats without a least exponent and that its Coq library lacks. A
   certificate calls them by the names UNKNOWN_..., which the notations at the end define. *)
From Coq Require Export Reals.
From Coq Require Import ZArith Bool Lra Lia Classical_Prop.
From Flocq Require Import Core.
Require Import Gappa.Gappa_library.
Require Import Gappa.Gappa_round_def.
Open Scope R_scope.

(* The least e such that every |x| <= u is rounded to p bits with an error of at most 2^e: half a
   unit in the last place of u, or a quarter where u is hardly above a power of two. *)
Definition bound (p : positive) (e : Z) : float2 := Float2 (2 ^ (Zpos p + 1) + 1) e.

Definition wide_exponent (p : positive) (u : float2) : Z :=
  let e := (floatx_ulp p (Fnum u) (Fexp u) - 2)%Z in
  if Gappa_dyadic.Fle2 u (bound p e) then e else (e + 1)%Z.

Definition symmetric (e : Z) (zi : FF) : bool :=
  Gappa_dyadic.Fle2 (lower zi) (Float2 (-1) e) && Gappa_dyadic.Fle2 (Float2 1 e) (upper zi).

Lemma within_symmetric (x : R) (e : Z) (zi : FF) :
  symmetric e zi = true -> Rabs x <= bpow radix2 e -> BND x zi.
Proof.
  intros Hs Hx. apply andb_prop in Hs. destruct Hs as [Hl Hu].
  apply Gappa_dyadic.Fle2_correct in Hl. apply Gappa_dyadic.Fle2_correct in Hu.
  apply Rabs_le_inv in Hx. unfold BND.
  unfold float2R at 2, F2R in Hl. unfold float2R at 1, F2R in Hu. cbn in Hl, Hu. lra.
Qed.

Definition floatx_absolute_wide_ne_helper (p : positive) (xi zi : FF) : bool :=
  let e := wide_exponent p (upper xi) in
  Gappa_dyadic.Fle2 (upper xi) (bound p e) && symmetric e zi.

Lemma nearest_error (p : positive) (e : Z) (x : R) :
  Rabs x <= bound p e ->
  Rabs (round radix2 (FLX_exp (Zpos p)) rndNE x - x) <= bpow radix2 e.
Proof.
  intros Hx.
  set (k := (e + Zpos p + 1)%Z).
  assert (Hb : float2R (bound p e) = bpow radix2 k + bpow radix2 e).
  { unfold float2R, F2R, bound, k. cbn [Defs.Fnum Defs.Fexp Fnum Fexp].
    rewrite plus_IZR. change 2%Z with (radix_val radix2). rewrite IZR_Zpower by lia.
    rewrite <- Z.add_assoc, (bpow_plus radix2 e). ring. }
  rewrite Hb in Hx.
  destruct (Rlt_or_le (Rabs x) (bpow radix2 k)) as [Hlow | Hhigh].
  - replace e with (FLX_exp (Zpos p) k - 1)%Z by (unfold FLX_exp, k; lia).
    apply floatx_absolute_n_whole. exact Hlow.
  - rewrite floatx_absolute_ne_sym.
    assert (Hf : generic_format radix2 (FLX_exp (Zpos p)) (bpow radix2 k)).
    { apply generic_format_bpow. unfold FLX_exp. lia. }
    assert (Hp : Prec_gt_0 (Zpos p)) by exact (zpos_gt_0 p).
    destruct (round_N_pt radix2 (FLX_exp (Zpos p)) (fun z => negb (Z.even z)) (Rabs x)) as [_ Hn].
    specialize (Hn _ Hf).
    apply Rle_trans with (1 := Hn).
    apply Rabs_le. lra.
Qed.

Lemma floatx_absolute_wide_ne (p : positive) (x : R) (xi zi : FF) :
  ABS x xi -> floatx_absolute_wide_ne_helper p xi zi = true ->
  BND (round radix2 (FLX_exp (Zpos p)) rndNE x - x) zi.
Proof.
  intros [_ [_ Hx]] H. apply andb_prop in H. destruct H as [Hu Hs].
  apply within_symmetric with (1 := Hs). apply nearest_error.
  apply Rle_trans with (1 := Hx). apply Gappa_dyadic.Fle2_correct. exact Hu.
Qed.

Definition floatx_absolute_inv_ne_helper (p : positive) (xi zi : FF) : bool :=
  let e := (floatx_ulp p (Fnum (upper xi)) (Fexp (upper xi)) - 1)%Z in
  Gappa_dyadic.Flt2 (upper xi) (Float2 1 (e + Zpos p + 1)) && symmetric e zi.

Lemma floatx_absolute_inv_ne (p : positive) (x : R) (xi zi : FF) :
  ABS (round radix2 (FLX_exp (Zpos p)) rndNE x) xi ->
  floatx_absolute_inv_ne_helper p xi zi = true ->
  BND (round radix2 (FLX_exp (Zpos p)) rndNE x - x) zi.
Proof.
  intros [_ [_ Hx]] H. apply andb_prop in H. destruct H as [Hu Hs].
  apply within_symmetric with (1 := Hs).
  set (e := (floatx_ulp p (Fnum (upper xi)) (Fexp (upper xi)) - 1)%Z) in *.
  replace e with (FLX_exp (Zpos p) (e + Zpos p + 1) - 1)%Z by (unfold FLX_exp; lia).
  apply floatx_absolute_inv_n_whole.
  apply Rle_lt_trans with (1 := Hx).
  apply Gappa_dyadic.Flt2_correct in Hu.
  unfold float2R at 2, F2R in Hu. cbn in Hu. rewrite Rmult_1_l in Hu. exact Hu.
Qed.

Notation UNKNOWN_floatx_absolute_wide_ne :=
  (floatx_absolute_wide_ne _ _ _ _ ltac:(eassumption) _) (only parsing).
Notation UNKNOWN_floatx_absolute_inv_ne :=
  (floatx_absolute_inv_ne _ _ _ _ ltac:(eassumption) _) (only parsing).

(* The powers of two in a goal and its hypotheses as numbers. *)
Ltac powers_as_numbers :=
  repeat match goal with
  | |- context [bpow radix2 (Zneg ?p)] =>
    let n := eval vm_compute in (Z.pow_pos 2 p) in change (bpow radix2 (Zneg p)) with (/ IZR n)
  | H : context [bpow radix2 (Zneg ?p)] |- _ =>
    let n := eval vm_compute in (Z.pow_pos 2 p) in
    change (bpow radix2 (Zneg p)) with (/ IZR n) in H
  end.

(* What a rewriting divides by is a number, one of the terms that its condition excludes from
   being zero, a factor of such a term, or such a term times another. *)
Ltac nonzero :=
  repeat split;
  first
  [ assumption
  | lra
  | let Hzero := fresh in
    intro Hzero;
    match goal with
    | Hterm : _ <> 0 |- _ => apply Hterm; rewrite Hzero; ring
    | Hterm : _ <> 0, Hother : ?d <> 0 |- _ =>
      apply Hterm;
      match type of Hzero with
      | ?x = 0 => transitivity (x / d); [field; assumption | rewrite Hzero; field; assumption]
      end
    end ].

(* Proves a rewriting that a script gives as a hint: an identity in the field of real numbers. *)
Ltac rewriting :=
  intros; unfold Float1, float2R, F2R in *; cbn [Defs.Fnum Defs.Fexp Fnum Fexp] in *;
  first [ ring | powers_as_numbers; field; nonzero ].

(* A certificate ends with l1: the hypotheses contradict the negation of the claim, which for two
   claims is a disjunction. *)
Lemma implied (hypotheses claim : Prop) :
  (hypotheses /\ ~ claim -> False) -> hypotheses -> claim.
Proof. intros H h. apply NNPP. intro n. exact (H (conj h n)). Qed.

Lemma implied_both (hypotheses claim1 claim2 : Prop) :
  (hypotheses /\ (~ claim1 \/ ~ claim2) -> False) -> hypotheses -> claim1 /\ claim2.
Proof. intros H h. split; apply NNPP; intro n; apply H; split; tauto. Qed.

Ltac conclude l1 := first [exact (implied _ _ l1) | exact (implied_both _ _ _ l1)].
