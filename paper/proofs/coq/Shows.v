(* Numbers of IEEE 754 and the real numbers that they stand for: each operation that runs is the one
   that the theorems speak of, where its result is finite. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Import Run.
From Sdop Require Import Format Double WorldBall Ieee.
Open Scope R_scope.

(* A number, if it is finite, stands for a real one. *)
Definition shows {prec emax} (x : binary_float prec emax) (a : R) : Prop :=
  is_finite x = true -> B2R x = a.

Section Operations.
Context {prec emax : Z} {Hprec : Prec_gt_0 prec} {Hmax : Prec_lt_emax prec emax}.
Definition rounded (x : R) : R := round radix2 (SpecFloat.fexp prec emax) ZnearestE x.
Variables x y : binary_float prec emax.
Variables a b : R.
Hypothesis Hx : shows x a.
Hypothesis Hy : shows y b.

Lemma overflow_infinite (z : binary_float prec emax) (s : bool) :
  is_finite z = true -> B2SF z = binary_overflow prec emax mode_NE s -> False.
Proof. intros F E. rewrite <- is_finite_SF_B2SF, E in F. discriminate. Qed.

Ltac both_finite F :=
  destruct x as [[|] | [|] | |], y as [[|] | [|] | |]; try discriminate F; split; reflexivity.

Lemma shows_plus : shows (Bplus mode_NE x y) (rounded (a + b)).
Proof.
  intro F. assert (Both : is_finite x = true /\ is_finite y = true) by both_finite F.
  destruct Both as [Fx Fy]. pose proof (Bplus_correct prec emax _ _ mode_NE x y Fx Fy) as C.
  rewrite (Hx Fx), (Hy Fy) in C. destruct Rlt_bool in C; [exact (proj1 C) |].
  exfalso. exact (overflow_infinite _ _ F (proj1 C)).
Qed.

Lemma shows_minus : shows (Bminus mode_NE x y) (rounded (a - b)).
Proof.
  intro F. assert (Both : is_finite x = true /\ is_finite y = true) by both_finite F.
  destruct Both as [Fx Fy]. pose proof (Bminus_correct prec emax _ _ mode_NE x y Fx Fy) as C.
  rewrite (Hx Fx), (Hy Fy) in C. destruct Rlt_bool in C; [exact (proj1 C) |].
  exfalso. exact (overflow_infinite _ _ F (proj1 C)).
Qed.

Lemma shows_mult : shows (Bmult mode_NE x y) (rounded (a * b)).
Proof.
  intro F. assert (Both : is_finite x = true /\ is_finite y = true) by both_finite F.
  destruct Both as [Fx Fy]. pose proof (Bmult_correct prec emax _ _ mode_NE x y) as C.
  rewrite (Hx Fx), (Hy Fy) in C. destruct Rlt_bool in C; [exact (proj1 C) |].
  exfalso. exact (overflow_infinite _ _ F C).
Qed.

Lemma shows_divide :
  is_finite y = true -> b <> 0 -> shows (Bdiv mode_NE x y) (rounded (a / b)).
Proof.
  intros Fy Hb F. assert (Fx : is_finite x = true).
  { destruct x as [s | s | | s m e H], y as [t | t | | t n g I];
      try reflexivity; try discriminate F; discriminate Fy. }
  pose proof (Bdiv_correct prec emax _ _ mode_NE x y) as C.
  rewrite (Hx Fx), (Hy Fy) in C. specialize (C Hb). destruct Rlt_bool in C; [exact (proj1 C) |].
  exfalso. exact (overflow_infinite _ _ F C).
Qed.

Lemma shows_root : shows (Bsqrt mode_NE x) (rounded (sqrt a)).
Proof.
  intro F. assert (Fx : is_finite x = true).
  { destruct x as [s | s | | s m e H]; try reflexivity; try discriminate F.
    destruct s; discriminate F. }
  rewrite <- (Hx Fx). exact (proj1 (Bsqrt_correct prec emax _ _ mode_NE x)).
Qed.

Lemma shows_opposite : shows (Bopp x) (- a).
Proof. intro F. rewrite is_finite_Bopp in F. now rewrite B2R_Bopp, (Hx F). Qed.

Lemma shows_absolute : shows (Babs x) (Rabs a).
Proof. intro F. rewrite is_finite_Babs in F. now rewrite B2R_Babs, (Hx F). Qed.

Lemma less_is :
  is_finite x = true -> is_finite y = true -> Run.less x y = Rlt_bool a b.
Proof.
  intros Fx Fy. unfold Run.less. rewrite Bcompare_correct by assumption.
  rewrite (Hx Fx), (Hy Fy). unfold Rlt_bool. now destruct Rcompare.
Qed.
End Operations.

Section More.
Context {prec emax : Z} {Hprec : Prec_gt_0 prec} {Hmax : Prec_lt_emax prec emax}.
Variables x y : binary_float prec emax.
Variables a b : R.
Hypothesis Fx : is_finite x = true.
Hypothesis Fy : is_finite y = true.
Hypothesis Hx : shows x a.
Hypothesis Hy : shows y b.

Lemma greater_of_is :
  is_finite (Run.greater_of x y) = true /\ B2R (Run.greater_of x y) = Rmax a b.
Proof.
  unfold Run.greater_of. rewrite (less_is y x b a Hy Hx Fy Fx).
  case Rlt_bool_spec; intro H; (split; [assumption |]).
  - rewrite (Hx Fx), Rmax_left; lra.
  - rewrite (Hy Fy), Rmax_right; lra.
Qed.


Lemma lesser_is :
  is_finite (Run.lesser x y) = true /\ B2R (Run.lesser x y) = Rmin a b.
Proof.
  unfold Run.lesser. rewrite (less_is x y a b Hx Hy Fx Fy).
  case Rlt_bool_spec; intro H; (split; [assumption |]).
  - rewrite (Hx Fx), Rmin_left; lra.
  - rewrite (Hy Fy), Rmin_right; lra.
Qed.

Lemma is_zero_is : Run.is_zero x = Req_bool a 0.
Proof.
  rewrite <- (Hx Fx). clear Hx Hy. destruct x as [s | s | | s m e H]; try discriminate Fx; cbn.
  - now rewrite Req_bool_true.
  - rewrite Req_bool_false; [reflexivity |]. apply F2R_neq_0. destruct s; discriminate.
Qed.
End More.

(* IEEE 754 as it is by default. *)
Definition gradual64 : mode64 := {| threshold64 := 0; reads_zero64 := false |}.

Lemma gradual_fl64 (x : R) : fl64 gradual64 x = nearest64 x.
Proof. unfold fl64. cbn. now rewrite Rlt_bool_false by apply Rabs_pos. Qed.

(* Conversions. *)
Lemma to_f64_is (x : f32) :
  is_finite x = true -> is_finite (Run.to_f64 x) = true /\ B2R (Run.to_f64 x) = B2R x.
Proof.
  intro F. destruct x as [s | s | | s m e H]; try discriminate F; [split; reflexivity |].
  set (x := B754_finite s m e H : f32). cbn [Run.to_f64].
  pose proof (binary_normalize_correct 53 1024 _ _ mode_NE (cond_Zopp s (Z.pos m)) e s) as C.
  cbv zeta in C. change (F2R _) with (B2R x) in C.
  assert (G : generic_format radix2 (SpecFloat.fexp 53 1024) (B2R x)).
  { apply generic_inclusion_mag with (SpecFloat.fexp 24 128); [| apply generic_format_B2R].
    intros _. unfold SpecFloat.fexp, SpecFloat.emin. lia. }
  rewrite round_generic in C by (typeclasses eauto || exact G).
  rewrite Rlt_bool_true in C; [tauto |].
  apply Rlt_trans with (bpow radix2 128); [apply abs_B2R_lt_emax | now apply bpow_lt].
Qed.

Lemma shows_to_f64 (x : f32) (a : R) : shows x a -> shows (Run.to_f64 x) (read gradual a).
Proof.
  intros H F. assert (Fx : is_finite x = true) by (destruct x; try reflexivity; discriminate F).
  destruct (to_f64_is x Fx) as [_ E]. rewrite E. exact (H Fx).
Qed.

Lemma shows_to_f32 (x : Run.f64) (a : R) : shows x a -> shows (Run.to_f32 x) (fl gradual a).
Proof.
  intros H F. assert (Fx : is_finite x = true) by (destruct x; try reflexivity; discriminate F).
  rewrite gradual_fl, <- (H Fx). destruct x as [s | s | | s m e I]; try discriminate Fx.
  - symmetry. apply round_0. typeclasses eauto.
  - set (x := B754_finite s m e I : Run.f64) in *. unfold x in F. cbn [Run.to_f32] in *.
    pose proof (binary_normalize_correct 24 128 _ _ mode_NE (cond_Zopp s (Z.pos m)) e s) as C.
    cbv zeta in C. change (F2R _) with (B2R x) in C.
    destruct Rlt_bool in C; [exact (proj1 C) |]. exfalso. exact (overflow_infinite _ _ F C).
Qed.

(* The operations of the theorems. *)
Section Statements.
Variables x y : Run.f64.
Variables a b : R.
Hypothesis Hx : shows x a.
Hypothesis Hy : shows y b.

Lemma shows_plus64 : shows (Run.plus64 x y) (add64 gradual64 a b).
Proof. unfold add64. rewrite gradual_fl64. exact (shows_plus x y a b Hx Hy). Qed.
Lemma shows_minus64 : shows (Run.minus64 x y) (sub64 gradual64 a b).
Proof. unfold sub64. rewrite gradual_fl64. exact (shows_minus x y a b Hx Hy). Qed.
Lemma shows_mult64 : shows (Run.mult64 x y) (mul64 gradual64 a b).
Proof. unfold mul64. rewrite gradual_fl64. exact (shows_mult x y a b Hx Hy). Qed.
Lemma shows_divide64 :
  is_finite y = true -> b <> 0 -> shows (Run.divide64 x y) (div64 gradual64 a b).
Proof. intros. unfold div64. rewrite gradual_fl64. now apply (shows_divide x y a b Hx Hy). Qed.
Lemma shows_root64 : shows (Run.root64 x) (sqrt64 gradual64 a).
Proof. unfold sqrt64. rewrite gradual_fl64. exact (shows_root x a Hx). Qed.
Lemma shows_opposite64 : shows (Run.opposite64 x) (- a).
Proof. exact (shows_opposite x a Hx). Qed.
End Statements.

Section Statements32.
Variables x y : f32.
Variables a b : R.
Hypothesis Hx : shows x a.
Hypothesis Hy : shows y b.

Lemma shows_plus32 : shows (plus32 x y) (add gradual a b).
Proof. unfold add. rewrite gradual_fl. exact (shows_plus x y a b Hx Hy). Qed.
Lemma shows_minus32 : shows (minus32 x y) (sub gradual a b).
Proof. unfold sub. rewrite gradual_fl. exact (shows_minus x y a b Hx Hy). Qed.
Lemma shows_mult32 : shows (mult32 x y) (mul gradual a b).
Proof. unfold mul. rewrite gradual_fl. exact (shows_mult x y a b Hx Hy). Qed.
End Statements32.

(* The next f32 above a number that isn't negative. *)
Lemma shows_up (x : Run.f64) (a : R) :
  shows x a -> 0 <= B2R (Run.up x) -> shows (Run.up x) (WorldBall.up gradual a).
Proof.
  intros H P F. unfold Run.up, WorldBall.up in *.
  assert (Fx : is_finite (Run.to_f32 x) = true).
  { destruct (Run.to_f32 x) as [s | s | | s m e I]; try reflexivity; [| discriminate F].
    destruct s; [| discriminate F]. exfalso. revert P. apply Rlt_not_le.
    change (B2R _) with (F2R (Float radix2 (-16777215) 104)). unfold F2R. cbn. lra. }
  pose proof (Bsucc_correct 24 128 _ _ (Run.to_f32 x) Fx) as C.
  rewrite (shows_to_f32 x a H Fx) in C.
  destruct Rlt_bool in C; [exact (proj1 C) |].
  exfalso. rewrite <- is_finite_SF_B2SF in F. rewrite C in F. discriminate.
Qed.

Lemma shows_one64 : shows (Run.number64 1 0) 1.
Proof. intros _. change (F2R (Float radix2 4503599627370496 (-52)) = 1). unfold F2R. cbn. lra. Qed.
Lemma shows_two64 : shows (Run.number64 2 0) 2.
Proof. intros _. change (F2R (Float radix2 4503599627370496 (-51)) = 2). unfold F2R. cbn. lra. Qed.

Ltac show := repeat first
  [ match goal with H : shows ?x _ |- shows ?x _ => exact H end | apply shows_plus64 | apply shows_minus64 | apply shows_mult64
  | apply shows_opposite64 | apply shows_root64 | apply shows_two64 | apply shows_one64
  | apply shows_plus32 | apply shows_minus32 | apply shows_mult32 | apply shows_to_f32
  | apply shows_to_f64 ].
