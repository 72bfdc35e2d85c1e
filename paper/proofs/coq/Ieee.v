(* The sphere test on IEEE 754 binary32 numbers, as a function that runs, and that it is the one of
   Sphere.v on real numbers: nothing of the contract overflows. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Import Format Geometry Sphere.
Open Scope R_scope.

#[export] Instance exponents32 : Prec_lt_emax 24 128 := eq_refl.
Definition f32 : Type := binary_float 24 128.
Definition plus32 : f32 -> f32 -> f32 := Bplus mode_NE.
Definition minus32 : f32 -> f32 -> f32 := Bminus mode_NE.
Definition mult32 : f32 -> f32 -> f32 := Bmult mode_NE.
Definition greater32 (x y : f32) : bool :=
  match Bcompare x y with Some Gt => true | _ => false end.

(* n * 2^e *)
Definition number (n e : Z) : f32 := binary_normalize 24 128 _ _ mode_NE n e false.

Record ball32 := { x32 : f32; y32 : f32; z32 : f32; r32 : f32 }.

(* src/rounding/sphere.rs: inflate_radius, for any two constants *)
Definition inflate32 (factor floor r : f32) : f32 := plus32 (mult32 r factor) floor.

(* src/rounding/sphere.rs: apart; src/broad_phase/slot_test.rs: hits_of *)
Definition apart32 (dx dy dz s : f32) : bool :=
  greater32 (plus32 (plus32 (mult32 dx dx) (mult32 dy dy)) (mult32 dz dz)) (mult32 s s).
Definition rejects32 (factor floor : f32) (a b : ball32) : bool :=
  apart32 (minus32 (x32 b) (x32 a)) (minus32 (y32 b) (y32 a)) (minus32 (z32 b) (z32 a))
    (plus32 (inflate32 factor floor (r32 a)) (inflate32 factor floor (r32 b))).

Definition factor32 : f32 := number 2097153 (-21).
Definition floor32 : f32 := number 1 (-70).

(* IEEE 754 as it is by default: gradual underflow. *)
Definition gradual : mode := {| threshold := 0; reads_zero := false |}.

Lemma gradual_valid : valid gradual.
Proof. unfold valid, gradual. cbn. pose proof tiny_value. lra. Qed.

Lemma gradual_fl (x : R) : fl gradual x = nearest32 x.
Proof. unfold fl. cbn. now rewrite Rlt_bool_false by apply Rabs_pos. Qed.

(* A number that is a finite f32, no greater than some bound. *)
Definition holds (x : f32) (y bound : R) : Prop :=
  is_finite x = true /\ B2R x = y /\ Rabs y <= bound.

Definition greatest : R := IZR (2 ^ 127).

Lemma rounded_fits (x : R) :
  Rabs x <= 1.9 * greatest -> Rlt_bool (Rabs (nearest32 x)) (bpow radix2 128) = true.
Proof.
  intro H. apply Rlt_bool_true. pose proof (nearest32_error x) as E.
  pose proof (Rabs_triang_inv (nearest32 x) x) as T. pose proof (proj1 half_step_value) as Hh.
  assert (Hs : half_step <= 1).
  { unfold half_step. apply Rle_trans with (/ 1); [| lra].
    apply Rinv_le_contravar; [lra | now apply IZR_le]. }
  assert (G : 1000 <= greatest) by (unfold greatest; now apply IZR_le).
  change (bpow radix2 128) with (IZR (2 ^ 128)).
  change (2 ^ 128)%Z with (2 * 2 ^ 127)%Z. rewrite mult_IZR. fold greatest.
  unfold u in *. lra.
Qed.

Lemma gradual_bound (x bound : R) :
  Rabs x <= bound -> 1 <= bound -> Rabs (nearest32 x) <= bound * 1.001.
Proof.
  intros H Hb. pose proof (nearest32_error x) as E.
  pose proof (Rabs_triang_inv (nearest32 x) x) as T. pose proof (proj1 half_step_value) as Hh.
  assert (Hs : half_step <= 1 / 10000).
  { unfold half_step. apply Rle_trans with (/ 10000); [| lra].
    apply Rinv_le_contravar; [lra | now apply IZR_le]. }
  unfold u in *. lra.
Qed.

Section Operations.
Variables x y : f32.
Variables a b p q : R.
Hypothesis Hx : holds x a p.
Hypothesis Hy : holds y b q.

Lemma plus32_holds :
  1 <= p + q <= 1.9 * greatest -> holds (plus32 x y) (add gradual a b) ((p + q) * 1.001).
Proof.
  intro Hb. destruct Hx as (Fx & Ex & Bx). destruct Hy as (Fy & Ey & By).
  assert (S : Rabs (a + b) <= p + q) by (apply Rle_trans with (1 := Rabs_triang _ _); lra).
  pose proof (Bplus_correct 24 128 _ _ mode_NE x y Fx Fy) as C. rewrite Ex, Ey in C.
  change (round radix2 _ _ (a + b)) with (nearest32 (a + b)) in C.
  rewrite rounded_fits in C by lra. destruct C as (C1 & C2 & _).
  assert (E : add gradual a b = nearest32 (a + b)) by (unfold add; now rewrite gradual_fl).
  rewrite E. repeat split; [exact C2 | exact C1 | now apply gradual_bound].
Qed.

Lemma minus32_holds :
  1 <= p + q <= 1.9 * greatest -> holds (minus32 x y) (sub gradual a b) ((p + q) * 1.001).
Proof.
  intro Hb. destruct Hx as (Fx & Ex & Bx). destruct Hy as (Fy & Ey & By).
  assert (S : Rabs (a - b) <= p + q).
  { unfold Rminus. apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra. }
  pose proof (Bminus_correct 24 128 _ _ mode_NE x y Fx Fy) as C. rewrite Ex, Ey in C.
  change (round radix2 _ _ (a - b)) with (nearest32 (a - b)) in C.
  rewrite rounded_fits in C by lra. destruct C as (C1 & C2 & _).
  assert (E : sub gradual a b = nearest32 (a - b)) by (unfold sub; now rewrite gradual_fl).
  rewrite E. repeat split; [exact C2 | exact C1 | now apply gradual_bound].
Qed.

Lemma mult32_holds :
  1 <= p * q <= 1.9 * greatest -> holds (mult32 x y) (mul gradual a b) (p * q * 1.001).
Proof.
  intro Hb. destruct Hx as (Fx & Ex & Bx). destruct Hy as (Fy & Ey & By).
  assert (S : Rabs (a * b) <= p * q).
  { rewrite Rabs_mult. apply Rmult_le_compat; try apply Rabs_pos; assumption. }
  pose proof (Bmult_correct 24 128 _ _ mode_NE x y) as C. rewrite Ex, Ey in C.
  change (round radix2 _ _ (a * b)) with (nearest32 (a * b)) in C.
  rewrite rounded_fits in C by lra. destruct C as (C1 & C2 & _).
  assert (E : mul gradual a b = nearest32 (a * b)) by (unfold mul; now rewrite gradual_fl).
  rewrite E, Fx, Fy in *. repeat split; [exact C2 | exact C1 | now apply gradual_bound].
Qed.

Lemma greater32_holds : greater32 x y = greater gradual a b.
Proof.
  destruct Hx as (Fx & Ex & Bx). destruct Hy as (Fy & Ey & By).
  unfold greater32, greater. rewrite Bcompare_correct by assumption. rewrite Ex, Ey.
  unfold read. cbn. unfold Rlt_bool. rewrite Rcompare_sym. now destruct (Rcompare b a).
Qed.
End Operations.

(* What a ball of f32 stands for, and the contract: finite, coordinates and radius within 2^62. *)
Definition ball_of (b : ball32) : ball :=
  {| centre := {| px := B2R (x32 b); py := B2R (y32 b); pz := B2R (z32 b) |};
     radius := B2R (r32 b) |}.

Definition reach : R := IZR (2 ^ 62).
Definition sound32 (b : ball32) : Prop :=
  holds (x32 b) (B2R (x32 b)) reach /\ holds (y32 b) (B2R (y32 b)) reach /\
  holds (z32 b) (B2R (z32 b)) reach /\ holds (r32 b) (B2R (r32 b)) reach /\ 0 <= B2R (r32 b).

Lemma factor32_holds : holds factor32 radius_factor 1.5.
Proof.
  unfold holds. split; [reflexivity |].
  assert (E : B2R factor32 = radius_factor).
  { replace (B2R factor32) with (F2R (Float radix2 8388612 (-23))) by reflexivity.
    unfold F2R, radius_factor, u. cbn. lra. }
  split; [exact E |]. unfold radius_factor, u. rewrite Rabs_pos_eq; lra.
Qed.

Lemma floor32_holds : holds floor32 radius_floor 1.
Proof.
  unfold holds. split; [reflexivity |].
  assert (E : B2R floor32 = radius_floor).
  { replace (B2R floor32) with (F2R (Float radix2 8388608 (-93))) by reflexivity.
    unfold F2R, radius_floor. cbn. lra. }
  split; [exact E |]. unfold radius_floor. rewrite Rabs_pos_eq; lra.
Qed.

Lemma reach_value : 1000 <= reach /\ reach * reach * 8 = greatest.
Proof.
  unfold reach, greatest. split; [now apply IZR_le |]. now rewrite <- !mult_IZR.
Qed.

Lemma inflate32_holds (r : f32) (a : R) :
  holds r a reach -> holds (inflate32 factor32 floor32 r) (inflate_radius gradual a) (1.6 * reach).
Proof.
  intro H. pose proof reach_value as [R0 R1].
  assert (R2 : 1000 * reach <= reach * reach) by (apply Rmult_le_compat_r; lra).
  pose proof (mult32_holds _ _ _ _ _ _ H factor32_holds ltac:(lra)) as M.
  pose proof (plus32_holds _ _ _ _ _ _ M floor32_holds ltac:(lra)) as P.
  destruct P as (P1 & P2 & P3). unfold inflate32, inflate_radius.
  repeat split; [exact P1 | exact P2 | lra].
Qed.

(* On f32 numbers of the contract the test is the one of Sphere.v. *)
Theorem rejects32_is_rejects (a b : ball32) :
  sound32 a -> sound32 b ->
  rejects32 factor32 floor32 a b =
  rejects gradual (inflated gradual (ball_of a)) (inflated gradual (ball_of b)).
Proof.
  intros (Ax & Ay & Az & Ar & _) (Bx & By & Bz & Br & _).
  pose proof reach_value as [R0 R1].
  assert (R2 : 1000 * reach <= reach * reach) by (apply Rmult_le_compat_r; lra).
  pose proof (minus32_holds _ _ _ _ _ _ Bx Ax ltac:(lra)) as Dx.
  pose proof (minus32_holds _ _ _ _ _ _ By Ay ltac:(lra)) as Dy.
  pose proof (minus32_holds _ _ _ _ _ _ Bz Az ltac:(lra)) as Dz.
  pose proof (plus32_holds _ _ _ _ _ _ (inflate32_holds _ _ Ar) (inflate32_holds _ _ Br)
    ltac:(lra)) as S.
  assert (Big : forall k, (reach + reach) * k * ((reach + reach) * k) = 4 * k * k * (reach * reach))
    by (intros; ring).
  pose proof (mult32_holds _ _ _ _ _ _ Dx Dx ltac:(rewrite Big; lra)) as Qx.
  pose proof (mult32_holds _ _ _ _ _ _ Dy Dy ltac:(rewrite Big; lra)) as Qy.
  pose proof (mult32_holds _ _ _ _ _ _ Dz Dz ltac:(rewrite Big; lra)) as Qz.
  rewrite Big in Qx, Qy, Qz.
  pose proof (plus32_holds _ _ _ _ _ _ Qx Qy ltac:(lra)) as Qxy.
  pose proof (plus32_holds _ _ _ _ _ _ Qxy Qz ltac:(lra)) as Q.
  assert (Small : forall k l, (k * reach + k * reach) * l * ((k * reach + k * reach) * l)
    = 2 * k * l * (2 * k * l) * (reach * reach)) by (intros; ring).
  pose proof (mult32_holds _ _ _ _ _ _ S S ltac:(rewrite Small; lra)) as T.
  unfold rejects32, apart32. rewrite (greater32_holds _ _ _ _ _ _ Q T). reflexivity.
Qed.

(* What the test rejects, run on f32 numbers, has no common point. *)
Theorem rejected32_disjoint (a b : ball32) :
  sound32 a -> sound32 b -> rejects32 factor32 floor32 a b = true ->
  forall p, ~ (in_ball p (ball_of a) /\ in_ball p (ball_of b)).
Proof.
  intros Ha Hb H. rewrite rejects32_is_rejects in H by assumption.
  pose proof gradual_valid as V.
  apply stored_balls_disjoint with (4 := proj2 (proj2 (proj2 (proj2 Ha))))
    (5 := proj2 (proj2 (proj2 (proj2 Hb)))) (6 := H); exact V.
Qed.
