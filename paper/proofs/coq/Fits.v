(* Numbers of binary32 with the real ones that they stand for and a power of two that these don't
   exceed: no operation on them overflows, and each is the one of real numbers. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Run RunOrDop.
From Sdop Require Import Format Geometry Pose Ieee Shows Duality Vectors Rounded.
Open Scope R_scope.

(* A finite number, the real one that it stands for, and a power of two that this doesn't exceed. *)
Definition fits (n : Z) (x : f32) (y : R) : Prop :=
  is_finite x = true /\ B2R x = y /\ Rabs y <= bpow radix2 n.
Definition in_range (n : Z) : bool := ((-149 <=? n) && (n <=? 127))%Z.

Lemma nearest32_power (n : Z) (x : R) :
  in_range n = true -> Rabs x <= bpow radix2 n ->
  Rabs (nearest32 x) <= bpow radix2 n /\ Rlt_bool (Rabs (nearest32 x)) (bpow radix2 128) = true.
Proof.
  intros N H. apply andb_prop in N. destruct N as [L U]. apply Z.leb_le in L, U.
  assert (A : Rabs (nearest32 x) <= bpow radix2 n).
  { unfold nearest32. apply abs_round_le_generic; [typeclasses eauto | typeclasses eauto | | exact
      H].
    now apply generic_format_FLT_bpow. }
  split; [exact A |]. apply Rlt_bool_true. apply Rle_lt_trans with (1 := A). apply bpow_lt. lia.
Qed.

Lemma fits_more (n m : Z) (x : f32) (y : R) : (n <= m)%Z -> fits n x y -> fits m x y.
Proof.
  intros L (F & E & B). repeat split; trivial. apply Rle_trans with (1 := B). now apply bpow_le.
Qed.

Section Operations.
Variables n k : Z.
Variables x y : f32.
Variables a b : R.
Hypothesis Hx : fits n x a.
Hypothesis Hy : fits k y b.

Lemma sum_power (s : R) :
  Rabs s <= Rabs a + Rabs b -> Rabs s <= bpow radix2 (Z.max n k + 1).
Proof.
  intro H. destruct Hx as (_ & _ & A). destruct Hy as (_ & _ & B).
  pose proof (bpow_le radix2 n (Z.max n k) ltac:(lia)).
  pose proof (bpow_le radix2 k (Z.max n k) ltac:(lia)).
  rewrite bpow_plus. change (bpow radix2 1) with 2. lra.
Qed.

Lemma plus_fits :
  in_range (Z.max n k + 1) = true -> fits (Z.max n k + 1) (plus32 x y) (add gradual a b).
Proof.
  intro N. destruct (nearest32_power _ (a + b) N (sum_power _ (Rabs_triang a b))) as (L & C).
  destruct Hx as (Fx & Ex & _). destruct Hy as (Fy & Ey & _).
  pose proof (Bplus_correct 24 128 _ _ mode_NE x y Fx Fy) as P. rewrite Ex, Ey in P.
  change (round radix2 _ _ (a + b)) with (nearest32 (a + b)) in P. rewrite C in P.
  unfold add. rewrite gradual_fl. change (read gradual a) with a. change (read gradual b) with b.
  destruct P as (P1 & P2 & _). repeat split; assumption.
Qed.

Lemma minus_fits :
  in_range (Z.max n k + 1) = true -> fits (Z.max n k + 1) (minus32 x y) (sub gradual a b).
Proof.
  intro N. assert (S : Rabs (a - b) <= Rabs a + Rabs b).
  { unfold Rminus. apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra. }
  destruct (nearest32_power _ (a - b) N (sum_power _ S)) as (L & C).
  destruct Hx as (Fx & Ex & _). destruct Hy as (Fy & Ey & _).
  pose proof (Bminus_correct 24 128 _ _ mode_NE x y Fx Fy) as P. rewrite Ex, Ey in P.
  change (round radix2 _ _ (a - b)) with (nearest32 (a - b)) in P. rewrite C in P.
  unfold sub. rewrite gradual_fl. change (read gradual a) with a. change (read gradual b) with b.
  destruct P as (P1 & P2 & _). repeat split; assumption.
Qed.

Lemma mult_fits :
  in_range (n + k) = true -> fits (n + k) (mult32 x y) (mul gradual a b).
Proof.
  intro N. destruct Hx as (Fx & Ex & A). destruct Hy as (Fy & Ey & B).
  assert (S : Rabs (a * b) <= bpow radix2 (n + k)).
  { rewrite Rabs_mult, bpow_plus. apply Rmult_le_compat; try apply Rabs_pos; assumption. }
  destruct (nearest32_power _ (a * b) N S) as (L & C).
  pose proof (Bmult_correct 24 128 _ _ mode_NE x y) as P. rewrite Ex, Ey in P.
  change (round radix2 _ _ (a * b)) with (nearest32 (a * b)) in P. rewrite C, Fx, Fy in P.
  unfold mul. rewrite gradual_fl. change (read gradual a) with a. change (read gradual b) with b.
  destruct P as (P1 & P2 & _). repeat split; assumption.
Qed.

Lemma lesser_fits : fits (Z.max n k) (Run.lesser x y) (least gradual a b).
Proof.
  destruct Hx as (Fx & Ex & A). destruct Hy as (Fy & Ey & B).
  destruct (lesser_is x y a b Fx Fy (fun _ => Ex) (fun _ => Ey)) as (F & E).
  repeat split; [exact F | exact E |]. unfold least. change (read gradual a) with a.
  change (read gradual b) with b. pose proof (bpow_le radix2 n (Z.max n k) ltac:(lia)).
  pose proof (bpow_le radix2 k (Z.max n k) ltac:(lia)).
  unfold Rmin. destruct Rle_dec; lra.
Qed.

Lemma greater_fits : fits (Z.max n k) (Run.greater_of x y) (most gradual a b).
Proof.
  destruct Hx as (Fx & Ex & A). destruct Hy as (Fy & Ey & B).
  destruct (greater_of_is x y a b Fx Fy (fun _ => Ex) (fun _ => Ey)) as (F & E).
  repeat split; [exact F | exact E |]. unfold most. change (read gradual a) with a.
  change (read gradual b) with b. pose proof (bpow_le radix2 n (Z.max n k) ltac:(lia)).
  pose proof (bpow_le radix2 k (Z.max n k) ltac:(lia)).
  unfold Rmax. destruct Rle_dec; lra.
Qed.

Lemma greater32_fits : greater32 x y = greater gradual a b.
Proof.
  destruct Hx as (Fx & Ex & A). destruct Hy as (Fy & Ey & B).
  exact (greater32_holds x y a b _ _ (conj Fx (conj Ex A)) (conj Fy (conj Ey B))).
Qed.
End Operations.

Lemma absolute_fits (n : Z) (x : f32) (a : R) : fits n x a -> fits n (Babs x) (Rabs a).
Proof.
  intros (F & E & B). repeat split; [now rewrite is_finite_Babs | now rewrite B2R_Babs, E |].
  now rewrite Rabs_Rabsolu.
Qed.
Lemma opposite_fits (n : Z) (x : f32) (a : R) : fits n x a -> fits n (Bopp x) (- a).
Proof.
  intros (F & E & B). repeat split; [now rewrite is_finite_Bopp | now rewrite B2R_Bopp, E |].
  now rewrite Rabs_Ropp.
Qed.
Lemma zero_fits : fits (-100) Run.zero32 0.
Proof. repeat split. rewrite Rabs_R0. apply bpow_ge_0. Qed.
Lemma half_fits : fits (-1) RunOrDop.half32 (/ 2).
Proof.
  repeat split.
  - change (F2R (Float radix2 8388608 (-24)) = / 2). unfold F2R. cbn. lra.
  - rewrite Rabs_pos_eq by lra. cbn. lra.
Qed.
Lemma quarter_fits : fits (-2) (number 1 (-2)) (/ 4).
Proof.
  repeat split.
  - change (F2R (Float radix2 8388608 (-25)) = / 4). unfold F2R. cbn. lra.
  - rewrite Rabs_pos_eq by lra. cbn. lra.
Qed.

(* The sign bit. *)
Lemma negative_sign (n : Z) (x : f32) (a : R) : fits n x a -> sign_of (RunOrDop.negative x) a.
Proof.
  intros (F & <- & _). destruct x as [s | s | | s m e H]; try discriminate F; cbn.
  - destruct s; cbn; lra.
  - destruct s; cbn [sign_of cond_Zopp].
    + apply F2R_le_0. cbn. lia.
    + apply F2R_ge_0. cbn. lia.
Qed.

(* Vectors. *)
Definition fits_three (n : Z) (v : Run.three f32) (p : point) : Prop :=
  fits n (Run.first v) (px p) /\ fits n (Run.second v) (py p) /\ fits n (Run.third v) (pz p).

Lemma dot_fits (n k : Z) (v w : Run.three f32) (p q : point) :
  fits_three n v p -> fits_three k w q -> in_range (n + k) = true -> in_range (n + k + 2) = true ->
  fits (n + k + 2) (RunOrDop.dot32 v w) (dot_of gradual p q).
Proof.
  intros (V0 & V1 & V2) (W0 & W1 & W2) N N'. unfold RunOrDop.dot32, dot_of.
  pose proof (mult_fits _ _ _ _ _ _ V0 W0 N) as A. pose proof (mult_fits _ _ _ _ _ _ V1 W1 N) as B.
  pose proof (mult_fits _ _ _ _ _ _ V2 W2 N) as C.
  assert (M : in_range (Z.max (n + k) (n + k) + 1) = true)
    by (unfold in_range in *; apply andb_prop in N, N'; apply andb_true_intro;
        rewrite !Z.leb_le in *; lia).
  pose proof (plus_fits _ _ _ _ _ _ A B M) as D.
  replace (n + k + 2)%Z with (Z.max (Z.max (n + k) (n + k) + 1) (n + k) + 1)%Z by lia.
  apply (plus_fits _ _ _ _ _ _ D C). now replace (Z.max _ _ + 1)%Z with (n + k + 2)%Z by lia.
Qed.

Ltac fit_step :=
  lazymatch goal with
  | H : fits _ ?x _ |- fits _ ?x _ => exact H
  | |- fits _ (plus32 _ _) _ => eapply plus_fits
  | |- fits _ (minus32 _ _) _ => eapply minus_fits
  | |- fits _ (mult32 _ _) _ => eapply mult_fits
  | |- fits _ (Run.lesser _ _) _ => eapply lesser_fits
  | |- fits _ (Run.greater_of _ _) _ => eapply greater_fits
  | |- fits _ (RunOrDop.dot32 _ _) _ => eapply dot_fits
  | |- fits _ (Babs _) _ => eapply absolute_fits
  | |- fits _ Run.zero32 _ => exact zero_fits
  | |- fits _ RunOrDop.half32 _ => exact half_fits
  | |- fits_three _ _ _ => split; [| split]; cbn [Run.first Run.second Run.third px py pz pt]
  | |- in_range _ = true => vm_compute; reflexivity
  end.
