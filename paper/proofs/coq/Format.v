(* The machine's f32 operations as functions of real numbers. Numbers have no greatest exponent
   here; Ieee.v shows that no operation of the contract leaves binary32. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core Relative.
Open Scope R_scope.

(* The unit roundoff of f32 and its least normal number, 2^-24 and 2^-126. *)
Definition u : R := / 16777216.
Definition tiny : R := / IZR (2 ^ 126).

#[export] Instance precision32 : Prec_gt_0 24 := eq_refl.

Definition nearest32 (x : R) : R := round radix2 (FLT_exp (-149) 24) ZnearestE x.

(* What the control register of the CPU says of underflow: whether operands below 2^-126 are read
   as zero, and below which exact value results are flushed to zero. The threshold is 0 without
   flushing; a CPU that judges before rounding (Arm) has 2^-126, one that judges after (x86) a
   little less. The theorems hold for any threshold up to 2^-126. *)
Record mode := { threshold : R; reads_zero : bool }.

Definition valid (m : mode) : Prop := 0 <= threshold m <= tiny.

Definition fl (m : mode) (x : R) : R :=
  if Rlt_bool (Rabs x) (threshold m) then 0 else nearest32 x.

Definition read (m : mode) (x : R) : R :=
  if reads_zero m && Rlt_bool (Rabs x) tiny then 0 else x.

Definition add (m : mode) (x y : R) : R := fl m (read m x + read m y).
Definition sub (m : mode) (x y : R) : R := fl m (read m x - read m y).
Definition mul (m : mode) (x y : R) : R := fl m (read m x * read m y).
Definition greater (m : mode) (x y : R) : bool := Rlt_bool (read m y) (read m x).

Lemma u_value : 0 < u < / 16777215.
Proof. unfold u. lra. Qed.

Lemma tiny_value : 0 < tiny.
Proof. unfold tiny. apply Rinv_0_lt_compat. now apply IZR_lt. Qed.

(* One rounding: relative error u, and 2^-150 where it underflows gradually. *)
Definition half_step : R := / IZR (2 ^ 150).

Lemma half_step_value : 0 < half_step /\ 16777216 * half_step = tiny.
Proof.
  unfold half_step, tiny. split.
  - apply Rinv_0_lt_compat. now apply IZR_lt.
  - change (2 ^ 150)%Z with (16777216 * 2 ^ 126)%Z. rewrite mult_IZR. field.
    now apply IZR_neq.
Qed.

Lemma nearest32_error (x : R) : Rabs (nearest32 x - x) <= u * Rabs x + half_step.
Proof.
  destruct (error_N_FLT radix2 (-149) 24 eq_refl (fun z => negb (Z.even z)) x)
    as (eps & eta & Heps & Heta & _ & Hround).
  unfold nearest32. rewrite Hround.
  replace (x * (1 + eps) + eta - x) with (eps * x + eta) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_mult.
  apply Rplus_le_compat.
  - apply Rmult_le_compat_r; [apply Rabs_pos |].
    apply Rle_trans with (1 := Heps). unfold u. cbn. lra.
  - apply Rle_trans with (1 := Heta). unfold half_step. cbn. lra.
Qed.

Lemma nearest32_nonneg (x : R) : 0 <= x -> 0 <= nearest32 x.
Proof.
  intro H. unfold nearest32.
  rewrite <- (round_0 radix2 (FLT_exp (-149) 24) ZnearestE).
  apply round_le; [typeclasses eauto | typeclasses eauto | exact H].
Qed.

Section Operations.
Variable m : mode.
Hypothesis Hm : valid m.

Lemma fl_above (x : R) : Rabs (fl m x) <= Rabs x * (1 + u) + half_step.
Proof.
  pose proof u_value. pose proof half_step_value. pose proof (Rabs_pos x).
  unfold fl. case Rlt_bool.
  - rewrite Rabs_R0. pose proof (Rmult_le_pos (Rabs x) (1 + u)). lra.
  - pose proof (nearest32_error x).
    pose proof (Rabs_triang_inv (nearest32 x) x). lra.
Qed.

Lemma fl_nonneg (x : R) : 0 <= x -> 0 <= fl m x.
Proof. intro H. unfold fl. case Rlt_bool; [lra | now apply nearest32_nonneg]. Qed.

(* Not flushed, a nonnegative result loses little. *)
Lemma fl_kept (x : R) : threshold m <= x -> x * (1 - u) - half_step <= fl m x.
Proof.
  intro H. pose proof Hm as Ht. unfold valid in Ht. unfold fl.
  rewrite Rabs_pos_eq by lra. rewrite Rlt_bool_false by lra.
  pose proof (nearest32_error x) as He. rewrite (Rabs_pos_eq x) in He by lra.
  apply Rabs_le_inv in He. lra.
Qed.

Lemma fl_flushed (x : R) : Rabs x < threshold m -> fl m x = 0.
Proof. intro H. unfold fl. now rewrite Rlt_bool_true. Qed.

Lemma fl_below (x : R) : 0 <= x -> x * (1 - u) - tiny <= fl m x.
Proof.
  intro H. pose proof Hm as Ht. unfold valid in Ht. pose proof half_step_value. pose proof u_value.
  destruct (Rlt_or_le x (threshold m)) as [Hx | Hx].
  - rewrite fl_flushed by (rewrite Rabs_pos_eq; lra).
    assert (x * (1 - u) <= x * 1) by (apply Rmult_le_compat_l; lra). lra.
  - pose proof (fl_kept x Hx). lra.
Qed.

Lemma read_cases (x : R) : read m x = x \/ (Rabs x < tiny /\ read m x = 0).
Proof.
  unfold read. case (reads_zero m); [| now left]. cbn.
  case Rlt_bool_spec; [right | left]; auto.
Qed.

Lemma read_large (x : R) : tiny <= x -> read m x = x.
Proof.
  intro H. pose proof tiny_value. destruct (read_cases x) as [| [Hx _]]; [assumption |].
  rewrite Rabs_pos_eq in Hx; lra.
Qed.

Lemma read_error (x : R) : Rabs (read m x - x) <= tiny.
Proof.
  destruct (read_cases x) as [-> | [H ->]].
  - replace (x - x) with 0 by ring. rewrite Rabs_R0. pose proof tiny_value. lra.
  - rewrite Rminus_0_l, Rabs_Ropp. lra.
Qed.

Lemma read_abs (x : R) : Rabs (read m x) <= Rabs x.
Proof.
  destruct (read_cases x) as [-> | [_ ->]]; [lra |]. rewrite Rabs_R0. apply Rabs_pos.
Qed.

Lemma read_nonneg (x : R) : 0 <= x -> 0 <= read m x <= x.
Proof. intro H. destruct (read_cases x) as [-> | [_ ->]]; lra. Qed.

Lemma read_monotone (x y : R) : 0 <= x <= y -> read m x <= read m y.
Proof.
  intro H. destruct (read_cases y) as [-> | [Hy Ey]].
  - pose proof (read_nonneg x). lra.
  - rewrite Ey. unfold read in *. destruct (reads_zero m); cbn in *.
    + rewrite Rabs_pos_eq in * by lra. rewrite Rlt_bool_true by lra. lra.
    + lra.
Qed.

(* What is less or equal doesn't compare as greater, whatever is read as zero. *)
Lemma not_greater (x y : R) : 0 <= x <= y -> greater m x y = false.
Proof. intro H. apply Rlt_bool_false. now apply read_monotone. Qed.
End Operations.

(* The sphere test leaves room for 2^-116, and posing a ball moves it by no more than half of that
   where numbers are read as zero. *)
Definition slack : R := 1024 * tiny.
