(* The machine's f64 operations as functions of real numbers, with one error bound each. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core Relative.
From Sdop Require Import Format.
Open Scope R_scope.

(* The unit roundoff of f64 and its least normal number, 2^-53 and 2^-1022. *)
Definition v : R := / 9007199254740992.
Definition tiny64 : R := / IZR (2 ^ 1022).

#[export] Instance precision64 : Prec_gt_0 53 := eq_refl.

Definition nearest64 (x : R) : R := round radix2 (FLT_exp (-1074) 53) ZnearestE x.

(* Underflow of f64, as `mode` has it for f32. *)
Record mode64 := { threshold64 : R; reads_zero64 : bool }.

Definition valid64 (m : mode64) : Prop := 0 <= threshold64 m <= tiny64.

Definition fl64 (m : mode64) (x : R) : R :=
  if Rlt_bool (Rabs x) (threshold64 m) then 0 else nearest64 x.

Definition read64 (m : mode64) (x : R) : R :=
  if reads_zero64 m && Rlt_bool (Rabs x) tiny64 then 0 else x.

Definition add64 (m : mode64) (x y : R) : R := fl64 m (read64 m x + read64 m y).
Definition sub64 (m : mode64) (x y : R) : R := fl64 m (read64 m x - read64 m y).
Definition mul64 (m : mode64) (x y : R) : R := fl64 m (read64 m x * read64 m y).
Definition div64 (m : mode64) (x y : R) : R := fl64 m (read64 m x / read64 m y).
Definition sqrt64 (m : mode64) (x : R) : R := fl64 m (sqrt (read64 m x)).

(* Underflow takes no more than 2^-700 of operations on numbers up to 2^300. *)
Definition dust : R := / IZR (2 ^ 700).
Definition big : R := IZR (2 ^ 300).

Lemma tiny64_value : 0 < tiny64 /\ tiny64 * (4 + 4 * big) <= dust.
Proof.
  unfold tiny64, dust, big. split; [apply Rinv_0_lt_compat; now apply IZR_lt |].
  change (2 ^ 1022)%Z with (2 ^ 322 * 2 ^ 700)%Z. rewrite mult_IZR, Rinv_mult.
  rewrite <- (Rmult_1_l (/ IZR (2 ^ 700))) at 2.
  rewrite Rmult_assoc, (Rmult_comm (/ IZR (2 ^ 700))), <- Rmult_assoc.
  apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; now apply IZR_lt |].
  rewrite <- mult_IZR, <- plus_IZR. apply Rmult_le_reg_l with (IZR (2 ^ 322)); [now apply IZR_lt |].
  rewrite <- Rmult_assoc, Rinv_r, Rmult_1_l, Rmult_1_r by now apply IZR_neq.
  now apply IZR_le.
Qed.

Lemma dust_value : 0 < dust.
Proof. unfold dust. apply Rinv_0_lt_compat. now apply IZR_lt. Qed.

Lemma big_value : 1 <= big.
Proof. unfold big. now apply IZR_le. Qed.

Lemma v_value : 0 < v < / 9007199254740991.
Proof. unfold v. lra. Qed.

Lemma tiny64_dust : 4 * tiny64 <= dust.
Proof.
  pose proof tiny64_value as [Ht0 H]. pose proof big_value.
  assert (0 <= tiny64 * big) by (apply Rmult_le_pos; lra). lra.
Qed.

Section Operations.
Variable m : mode64.
Hypothesis Hm : valid64 m.

Lemma fl64_error (x : R) : Rabs (fl64 m x - x) <= v * Rabs x + tiny64.
Proof.
  pose proof Hm as Ht. unfold valid64 in Ht. pose proof (Rabs_pos x) as Hx.
  pose proof v_value as Hv. pose proof tiny64_value as [Ht0 _].
  assert (Hp : 0 <= v * Rabs x) by (apply Rmult_le_pos; lra).
  unfold fl64. case Rlt_bool_spec; intro H.
  - rewrite Rminus_0_l, Rabs_Ropp. lra.
  - destruct (error_N_FLT radix2 (-1074) 53 eq_refl (fun z => negb (Z.even z)) x)
      as (eps & eta & Heps & Heta & _ & Hround).
    unfold nearest64. rewrite Hround.
    replace (x * (1 + eps) + eta - x) with (eps * x + eta) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_mult.
    apply Rplus_le_compat.
    + apply Rmult_le_compat_r; [apply Rabs_pos |].
      apply Rle_trans with (1 := Heps). unfold v. cbn. lra.
    + apply Rle_trans with (1 := Heta). unfold tiny64.
      apply Rle_trans with (bpow radix2 (-1074)).
      * pose proof (bpow_gt_0 radix2 (-1074)). lra.
      * change (/ IZR (2 ^ 1022)) with (bpow radix2 (-1022)). now apply bpow_le.
Qed.

Lemma read64_cases (x : R) : read64 m x = x \/ (Rabs x < tiny64 /\ read64 m x = 0).
Proof.
  unfold read64. case (reads_zero64 m); [| now left]. cbn.
  case Rlt_bool_spec; [right | left]; auto.
Qed.

Lemma read64_error (x : R) : Rabs (read64 m x - x) <= tiny64.
Proof.
  pose proof tiny64_value as [Ht0 _]. destruct (read64_cases x) as [-> | [H ->]].
  - replace (x - x) with 0 by ring. rewrite Rabs_R0. lra.
  - rewrite Rminus_0_l, Rabs_Ropp. lra.
Qed.

Lemma read64_abs (x : R) : Rabs (read64 m x) <= Rabs x.
Proof.
  destruct (read64_cases x) as [-> | [_ ->]]; [lra |]. rewrite Rabs_R0. apply Rabs_pos.
Qed.

(* A rounded value near another one. *)
Lemma fl64_near (x y e : R) :
  Rabs (x - y) <= e -> Rabs (fl64 m x - y) <= v * Rabs y + tiny64 + (1 + v) * e.
Proof.
  intro H. pose proof (fl64_error x) as Hf. pose proof v_value as Hv.
  assert (Hx : Rabs x <= Rabs y + e).
  { replace x with (y + (x - y)) by ring. apply Rle_trans with (1 := Rabs_triang _ _). lra. }
  replace (fl64 m x - y) with ((fl64 m x - x) + (x - y)) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _).
  assert (v * Rabs x <= v * (Rabs y + e)) by (apply Rmult_le_compat_l; lra). lra.
Qed.

Lemma add64_near (x y X Y d e : R) :
  Rabs (x - X) <= d -> Rabs (y - Y) <= e ->
  Rabs (add64 m x y - (X + Y)) <= v * Rabs (X + Y) + dust + (1 + v) * (d + e).
Proof.
  intros Hd He. unfold add64.
  pose proof (read64_error x) as Hx. pose proof (read64_error y) as Hy.
  assert (H : Rabs (read64 m x + read64 m y - (X + Y)) <= 2 * tiny64 + (d + e)).
  { apply Rabs_le_inv in Hd, He, Hx, Hy. apply Rabs_le. lra. }
  apply fl64_near in H. pose proof tiny64_value as [Ht0 _]. pose proof tiny64_dust.
  unfold v in *. lra.
Qed.

Lemma sub64_near (x y X Y d e : R) :
  Rabs (x - X) <= d -> Rabs (y - Y) <= e ->
  Rabs (sub64 m x y - (X - Y)) <= v * Rabs (X - Y) + dust + (1 + v) * (d + e).
Proof.
  intros Hd He. unfold sub64.
  pose proof (read64_error x) as Hx. pose proof (read64_error y) as Hy.
  assert (H : Rabs (read64 m x - read64 m y - (X - Y)) <= 2 * tiny64 + (d + e)).
  { apply Rabs_le_inv in Hd, He, Hx, Hy. apply Rabs_le. lra. }
  apply fl64_near in H. pose proof tiny64_value as [Ht0 _]. pose proof tiny64_dust.
  unfold v in *. lra.
Qed.

(* A product near Q, where the exact product of the operands is within e of it. *)
Lemma mul64_near (x y Q e : R) :
  Rabs x <= big -> Rabs y <= big -> Rabs (x * y - Q) <= e ->
  Rabs (mul64 m x y - Q) <= v * Rabs Q + dust + (1 + v) * e.
Proof.
  intros Bx By He. unfold mul64.
  pose proof (read64_error x) as Hx. pose proof (read64_error y) as Hy.
  pose proof (read64_abs y) as Ay. pose proof (Rabs_pos (read64 m y)).
  pose proof (Rabs_pos x). pose proof (Rabs_pos (read64 m x - x)).
  pose proof (Rabs_pos (read64 m y - y)).
  assert (H' : Rabs (read64 m x * read64 m y - Q) <= tiny64 * (2 * big) + e).
  { replace (read64 m x * read64 m y - Q)
      with ((read64 m x - x) * read64 m y + x * (read64 m y - y) + (x * y - Q)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). apply Rplus_le_compat; [| exact He].
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult.
    assert (Rabs (read64 m x - x) * Rabs (read64 m y) <= tiny64 * big)
      by (apply Rmult_le_compat; lra).
    assert (Rabs x * Rabs (read64 m y - y) <= big * tiny64) by (apply Rmult_le_compat; lra). lra. }
  apply fl64_near in H'. pose proof tiny64_value as [Ht0 Ht1]. pose proof big_value.
  assert (0 <= tiny64 * big) by (apply Rmult_le_pos; lra). unfold v in *. lra.
Qed.

Lemma mul64_error (x y : R) :
  Rabs x <= big -> Rabs y <= big -> Rabs (mul64 m x y - x * y) <= v * Rabs (x * y) + dust.
Proof.
  intros Bx By. rewrite <- (Rplus_0_r (v * Rabs (x * y) + dust)), <- (Rmult_0_r (1 + v)).
  apply mul64_near; try assumption. unfold Rminus. rewrite Rplus_opp_r, Rabs_R0. lra.
Qed.

Lemma inverse64_error (x : R) :
  tiny64 <= x -> Rabs (div64 m 1 x - / x) <= v * / x + dust.
Proof.
  intro H. pose proof tiny64_value as [Ht0 _]. pose proof tiny64_dust.
  assert (E : read64 m 1 = 1).
  { destruct (read64_cases 1) as [-> | [A _]]; [reflexivity |]. exfalso. rewrite Rabs_R1 in A.
    assert (tiny64 < 1); [| lra]. change tiny64 with (bpow radix2 (-1022)).
    change 1 with (bpow radix2 0). now apply bpow_lt. }
  assert (Ex : read64 m x = x).
  { destruct (read64_cases x) as [-> | [A _]]; [reflexivity |]. rewrite Rabs_pos_eq in A; lra. }
  unfold div64. rewrite E, Ex. unfold Rdiv. rewrite Rmult_1_l.
  pose proof (fl64_error (/ x)) as Hf. pose proof (Rinv_0_lt_compat x ltac:(lra)) as Hi.
  rewrite (Rabs_pos_eq (/ x)) in Hf by lra. lra.
Qed.
(* From below, for nonnegative numbers. *)
Lemma add64_below (x y : R) : 0 <= x -> 0 <= y -> (x + y) * (1 - v) - dust <= add64 m x y.
Proof.
  intros Hx Hy.
  assert (Ex : Rabs (x - x) <= 0) by (rewrite Rminus_diag_eq, Rabs_R0; lra).
  assert (Ey : Rabs (y - y) <= 0) by (rewrite Rminus_diag_eq, Rabs_R0; lra).
  pose proof (add64_near x y x y 0 0 Ex Ey) as E.
  rewrite (Rabs_pos_eq (x + y)) in E by lra. apply Rabs_le_inv in E. lra.
Qed.

Lemma fl64_nonneg (x : R) : 0 <= x -> 0 <= fl64 m x.
Proof.
  intro H. unfold fl64. case Rlt_bool; [lra |]. unfold nearest64.
  rewrite <- (round_0 radix2 (FLT_exp (-1074) 53) ZnearestE).
  apply round_le; [typeclasses eauto | typeclasses eauto | exact H].
Qed.

Lemma read64_nonneg (x : R) : 0 <= x -> 0 <= read64 m x <= x.
Proof. intro H. destruct (read64_cases x) as [-> | [_ ->]]; lra. Qed.

Lemma add64_nonneg (x y : R) : 0 <= x -> 0 <= y -> 0 <= add64 m x y.
Proof.
  intros Hx Hy. unfold add64. apply fl64_nonneg. pose proof (read64_nonneg x Hx).
  pose proof (read64_nonneg y Hy). lra.
Qed.

Lemma mul64_nonneg (x y : R) : 0 <= x -> 0 <= y -> 0 <= mul64 m x y.
Proof.
  intros Hx Hy. unfold mul64. apply fl64_nonneg. pose proof (read64_nonneg x Hx).
  pose proof (read64_nonneg y Hy). apply Rmult_le_pos; lra.
Qed.

Lemma mul64_below (x y : R) :
  tiny64 <= x -> x <= 2 -> 0 <= y -> x * y * (1 - v) - dust <= mul64 m x y.
Proof.
  intros Hx Hx2 Hy. pose proof tiny64_value as [T0 _]. pose proof tiny64_dust as T.
  pose proof v_value as V. unfold mul64.
  destruct (read64_cases x) as [-> | [A _]]; [| rewrite Rabs_pos_eq in A; lra].
  pose proof (read64_error y) as E. apply Rabs_le_inv in E.
  pose proof (read64_nonneg y Hy) as N. set (y' := read64 m y) in *.
  assert (P : 0 <= x * y') by (apply Rmult_le_pos; lra).
  pose proof (fl64_error (x * y')) as F. rewrite (Rabs_pos_eq (x * y')) in F by exact P.
  apply Rabs_le_inv in F.
  assert (L : x * y - 2 * tiny64 <= x * y').
  { assert (x * (y - y') <= 2 * tiny64).
    { apply Rle_trans with (x * tiny64); [apply Rmult_le_compat_l; lra |].
      apply Rmult_le_compat_r; lra. }
    lra. }
  set (p := x * y') in *. set (w := x * y) in *. unfold v in *. lra.
Qed.
End Operations.
