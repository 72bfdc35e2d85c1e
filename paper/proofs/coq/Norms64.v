(* Lengths and quotients in f64 with gradual underflow, as the code computes them for or-DOPs. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Ieee Shows Outward Finder.
From Sdop Require Import Duality Vectors Rounded.
Open Scope R_scope.

Local Notation g := gradual64.
Lemma valid_g : valid64 g. Proof. exact gradually_valid64. Qed.

(* src/rounding/pose.rs: norm, over_norm *)
Definition norm_in_f64 (x : point) : R := sqrt64 g (rotate_row g x x).
Definition over_norm (x : point) : R := div64 g 1 (norm_in_f64 x).

Lemma gradual_cast (x : R) : Rabs (fl gradual x - x) <= u * Rabs x + half_step.
Proof. rewrite gradual_fl. apply nearest32_error. Qed.

(* Numbers that are small, and yet large next to what underflow takes of f64. *)
Definition small : R := / IZR (2 ^ 300).

Lemma small_value : 0 < small /\ 1000000 * dust <= v * (small * small) /\
  1000000 * small <= v * / IZR (2 ^ 200).
Proof.
  assert (P : forall e, (0 <= e)%Z -> 0 < / IZR (2 ^ e))
    by (intros; apply Rinv_0_lt_compat, IZR_lt; now apply Z.pow_pos_nonneg).
  unfold small, dust, v. change 9007199254740992 with (IZR (2 ^ 53)).
  split; [now apply P |]. rewrite <- !Rinv_mult, <- !mult_IZR. split.
  - change (2 ^ 700)%Z with (2 ^ 53 * (2 ^ 300 * 2 ^ 300) * 2 ^ 47)%Z.
    rewrite (mult_IZR _ (2 ^ 47)), Rinv_mult. set (a := / IZR (2 ^ 53 * (2 ^ 300 * 2 ^ 300))).
    assert (0 <= a) by (apply Rlt_le, Rinv_0_lt_compat; now apply IZR_lt).
    assert (1000000 * / IZR (2 ^ 47) <= 1) by lra.
    replace (1000000 * (a * / IZR (2 ^ 47))) with (a * (1000000 * / IZR (2 ^ 47))) by ring.
    rewrite <- (Rmult_1_r a) at 2. now apply Rmult_le_compat_l.
  - change (2 ^ 300)%Z with (2 ^ 53 * 2 ^ 200 * 2 ^ 47)%Z.
    rewrite (mult_IZR _ (2 ^ 47)), Rinv_mult. set (a := / IZR (2 ^ 53 * 2 ^ 200)).
    assert (0 <= a) by (apply Rlt_le, Rinv_0_lt_compat; now apply IZR_lt).
    assert (1000000 * / IZR (2 ^ 47) <= 1) by lra.
    replace (1000000 * (a * / IZR (2 ^ 47))) with (a * (1000000 * / IZR (2 ^ 47))) by ring.
    rewrite <- (Rmult_1_r a) at 2. now apply Rmult_le_compat_l.
Qed.

Lemma small_dust : 1000000 * dust <= v * small /\ dust <= small.
Proof.
  destruct small_value as (S & A & _). pose proof v_value as V. pose proof dust_value as D.
  assert (small <= 1).
  { unfold small. rewrite <- Rinv_1. apply Rinv_le_contravar; [lra | now apply IZR_le]. }
  assert (small * small <= small * 1) by (apply Rmult_le_compat_l; lra).
  assert (v * (small * small) <= v * (small * 1)) by (apply Rmult_le_compat_l; lra).
  assert (v * small <= 1 * small) by (apply Rmult_le_compat_r; lra). lra.
Qed.

Lemma add_zero (x : R) : add64 g (fl64 g x) 0 = fl64 g x.
Proof.
  unfold add64. rewrite !read64_is, !gradual_fl64, Rplus_0_r. unfold nearest64 at 1.
  apply round_generic; [typeclasses eauto |]. apply generic_format_round; typeclasses eauto.
Qed.

Lemma rotate_row_error (a e p : point) (size : R) :
  row_error a e -> dot e e = 1 -> 0 <= size <= big / 2 -> norm p <= size ->
  Rabs (rotate_row g a p - dot e p) <= 35.3 * v * size + 20 * dust.
Proof.
  intros Ha He Hs Hp. destruct (coordinates_of_norm p size Hp) as (X & Y & Z).
  pose proof (coordinate_error g valid_g a e p Ha He size Hs X Y Z 0
    ltac:(rewrite Rabs_R0; apply Hs)) as E.
  rewrite Rplus_0_r in E.
  replace (add64 g (rotate_row g a p) 0) with (rotate_row g a p) in E; [exact E |].
  symmetry. exact (add_zero _).
Qed.

(* Square roots of numbers near others. *)
Lemma root_near (s S e : R) : 0 < S -> 0 <= s -> Rabs (s - S) <= e -> Rabs (sqrt s - sqrt S) <= e /
  sqrt S.
Proof.
  intros P Ps E. pose proof (sqrt_lt_R0 S P) as R. pose proof (sqrt_pos s) as Q.
  apply Rmult_le_reg_r with (sqrt S); [exact R |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra.
  rewrite Rmult_1_r. apply Rle_trans with (2 := E).
  replace (s - S) with ((sqrt s - sqrt S) * (sqrt s + sqrt S)).
  - rewrite Rabs_mult. apply Rmult_le_compat_l; [apply Rabs_pos |].
    rewrite (Rabs_pos_eq (_ + _)) by lra. lra.
  - rewrite <- (sqrt_sqrt s) at 3 by exact Ps. rewrite <- (sqrt_sqrt S) at 3 by lra. ring.
Qed.

(* A dot product in f64. *)
Lemma dot_in_f64_error (x y : point) (a b : R) :
  norm x <= a -> norm y <= b -> a <= big -> b <= big ->
  Rabs (rotate_row g x y - dot x y) <= 3.01 * v * (a * b) + 8 * dust.
Proof.
  intros A B A' B'. destruct (coordinates_of_norm x _ A) as (X0 & X1 & X2).
  destruct (coordinates_of_norm y _ B) as (Y0 & Y1 & Y2). pose proof dust_value as D.
  pose proof (mul64_error g valid_g (px x) (px y) ltac:(lra) ltac:(lra)) as E0.
  pose proof (mul64_error g valid_g (py x) (py y) ltac:(lra) ltac:(lra)) as E1.
  pose proof (mul64_error g valid_g (pz x) (pz y) ltac:(lra) ltac:(lra)) as E2.
  pose proof (add64_near g valid_g _ _ _ _ _ _ E0 E1) as E3.
  pose proof (add64_near g valid_g _ _ _ _ _ _ E3 E2) as E4.
  unfold rotate_row, dot. apply Rle_trans with (1 := E4).
  assert (S : Rabs (px x * px y) + Rabs (py x * py y) + Rabs (pz x * pz y) <= a * b).
  { apply Rle_trans with (1 := absolute_dot x y).
    apply Rmult_le_compat; try apply norm_nonneg; assumption. }
  set (p := px x * px y) in *. set (q := py x * py y) in *. set (r := pz x * pz y) in *.
  pose proof (Rabs_triang p q). pose proof (Rabs_triang (p + q) r).
  pose proof (Rabs_pos p). pose proof (Rabs_pos q). pose proof (Rabs_pos r).
  set (ab := a * b) in *. clearbody p q r ab. clear - S H H0 H1 H2 H3 D. unfold v. lra.
Qed.

(* The norm of a vector in f64. *)
Lemma norm_in_f64_error (x : point) :
  norm x <= IZR (2 ^ 100) ->
  0 <= norm_in_f64 x /\ norm x * (1 - 5 * v) - small <= norm_in_f64 x /\
  (small <= norm x -> Rabs (norm_in_f64 x - norm x) <= 5 * v * norm x).
Proof.
  intro B. pose proof v_value as V. pose proof dust_value as D. pose proof (norm_nonneg x) as N.
  destruct small_value as (S0 & S1 & _). pose proof small_dust as (S2 & S3).
  assert (Bb : norm x <= big) by (apply Rle_trans with (1 := B); unfold big; now apply IZR_le).
  assert (P : 0 <= rotate_row g x x).
  { unfold rotate_row. repeat apply add64_nonneg; unfold mul64; apply fl64_nonneg, Rle_0_sqr. }
  assert (Root : 0 <= norm_in_f64 x).
  { unfold norm_in_f64, sqrt64. apply fl64_nonneg, sqrt_pos. }
  assert (Near : small <= norm x -> Rabs (norm_in_f64 x - norm x) <= 5 * v * norm x).
  { intro L. pose proof (dot_in_f64_error x x (norm x) (norm x) ltac:(lra) ltac:(lra) Bb Bb) as E.
    replace (dot x x) with (square x) in E by reflexivity.
    assert (Q : small * small <= norm x * norm x) by (apply Rmult_le_compat; lra).
    assert (E' : Rabs (rotate_row g x x - square x) <= 3.1 * v * (norm x * norm x))
      by (unfold v in *; lra).
    assert (Ps : 0 < square x).
    { rewrite <- norm_square. apply Rmult_lt_0_compat; lra. }
    pose proof (root_near _ _ _ Ps P E') as R. fold (norm x) in R.
    replace (3.1 * v * (norm x * norm x) / norm x) with (3.1 * v * norm x) in R by (field; lra).
    unfold norm_in_f64, sqrt64. rewrite read64_is.
    pose proof (fl64_error g valid_g (sqrt (rotate_row g x x))) as F.
    rewrite (Rabs_pos_eq (sqrt _)) in F by apply sqrt_pos.
    pose proof tiny64_dust as T. pose proof (proj1 tiny64_value).
    apply Rabs_le_inv in R, F. apply Rabs_le. unfold v in *. lra. }
  split; [exact Root |]. split; [| exact Near].
  destruct (Rle_or_lt small (norm x)) as [L | L].
  - specialize (Near L). apply Rabs_le_inv in Near. unfold v in *. lra.
  - assert (0 <= norm x * (5 * v)) by (apply Rmult_le_pos; unfold v; lra). lra.
Qed.

(* The length of a basis vector in f64, and a number divided by it. *)
Lemma scale_error (x : point) (n : R) :
  norm x = n -> / 4 <= n <= 2 -> Rabs (norm_in_f64 x - n) <= 5 * v * n /\ / 5 <= norm_in_f64 x <= 3.
Proof.
  intros E N. destruct (norm_in_f64_error x) as (_ & _ & R).
  { rewrite E. apply Rle_trans with 2; [lra |]. now apply IZR_le. }
  rewrite E in R. specialize (R ltac:(destruct small_value as (_ & _ & S); pose proof v_value;
    assert (/ IZR (2 ^ 200) <= 1) by (rewrite <- Rinv_1; apply Rinv_le_contravar;
      [lra | now apply IZR_le]); unfold v in *; lra)).
  split; [exact R |]. apply Rabs_le_inv in R. unfold v in *. lra.
Qed.

Lemma divided_error (x X e n N : R) :
  / 4 <= N <= 2 -> Rabs (n - N) <= 5 * v * N -> Rabs (x - X) <= e ->
  Rabs (div64 g x n - X / N) <= 7 * v * (Rabs X / N) + 1.01 * (e / N) + tiny64.
Proof.
  intros HN Hn Hx. pose proof v_value as V. pose proof (Rabs_pos X) as P.
  pose proof (Rabs_pos (x - X)) as P'.
  assert (Hn' : N * (1 - 5 * v) <= n) by (apply Rabs_le_inv in Hn; lra).
  assert (Pn : 0 < n) by (unfold v in *; lra).
  assert (Q : Rabs (x / n - X / N) <= 5.01 * v * (Rabs X / N) + 1.001 * (e / N)).
  { replace (x / n - X / N) with (((x - X) - X / N * (n - N)) / n) by (field; lra).
    unfold Rdiv at 1. rewrite Rabs_mult, (Rabs_pos_eq (/ n)) by (apply Rlt_le, Rinv_0_lt_compat;
      lra).
    apply Rmult_le_reg_r with n; [exact Pn |]. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
    apply Rle_trans with (e + Rabs X / N * (5 * v * N)).
    - unfold Rminus at 1. apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp, Rabs_mult.
      unfold Rdiv at 1. rewrite Rabs_mult, (Rabs_pos_eq (/ N))
        by (apply Rlt_le, Rinv_0_lt_compat; lra).
      apply Rplus_le_compat; [exact Hx |]. apply Rmult_le_compat_l; [| exact Hn].
      apply Rmult_le_pos; [exact P |]. apply Rlt_le, Rinv_0_lt_compat. lra.
    - assert (A : 0 <= 5.01 * v * (Rabs X / N) + 1.001 * (e / N)).
      { assert (0 <= Rabs X / N) by (apply Rmult_le_pos; [exact P | apply Rlt_le, Rinv_0_lt_compat;
          lra]).
        assert (0 <= e / N) by (apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra]).
        assert (0 <= v * (Rabs X / N)) by (apply Rmult_le_pos; lra). lra. }
      apply Rle_trans with ((5.01 * v * (Rabs X / N) + 1.001 * (e / N)) * (N * (1 - 5 * v)));
        [| now apply Rmult_le_compat_l].
      replace ((5.01 * v * (Rabs X / N) + 1.001 * (e / N)) * (N * (1 - 5 * v)))
        with ((5.01 * (v * Rabs X) + 1.001 * e) * (1 - 5 * v)) by (field; lra).
      replace (e + Rabs X / N * (5 * v * N)) with (e + 5 * (v * Rabs X)) by (field; lra).
      assert (0 <= v * Rabs X) by (apply Rmult_le_pos; lra).
      set (vx := v * Rabs X) in *. assert (0 <= e) by lra. unfold v. lra. }
  unfold div64. rewrite !read64_is.
  pose proof (fl64_near g valid_g (x / n) (X / N) _ Q) as F.
  replace (Rabs (X / N)) with (Rabs X / N) in F by (unfold Rdiv; rewrite Rabs_mult,
    (Rabs_pos_eq (/ N)) by (apply Rlt_le, Rinv_0_lt_compat; lra); reflexivity).
  assert (0 <= Rabs X / N) by (apply Rmult_le_pos; [exact P | apply Rlt_le, Rinv_0_lt_compat; lra]).
  assert (0 <= e / N) by (apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra]).
  apply Rle_trans with (1 := F). set (xn := Rabs X / N) in *. set (en := e / N) in *.
  unfold v. lra.
Qed.

Lemma half_step_small : 0 < half_step <= v / 1000000.
Proof.
  pose proof half_step_value as (H & E). split; [exact H |]. pose proof tiny_small.
  unfold v. lra.
Qed.

Lemma sub64_monotone (x y z : R) : x <= y -> sub64 g x z <= sub64 g y z.
Proof.
  intro H. unfold sub64. rewrite !read64_is, !gradual_fl64. unfold nearest64.
  apply round_le; [typeclasses eauto | typeclasses eauto | lra].
Qed.
Lemma div64_monotone (x y z : R) : 0 < z -> x <= y -> div64 g x z <= div64 g y z.
Proof.
  intros P H. unfold div64. rewrite !read64_is, !gradual_fl64. unfold nearest64.
  apply round_le; [typeclasses eauto | typeclasses eauto |].
  apply Rmult_le_compat_r; [apply Rlt_le, Rinv_0_lt_compat; exact P | exact H].
Qed.
