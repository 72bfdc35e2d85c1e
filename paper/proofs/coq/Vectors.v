(* Norms of vectors that rounding has changed, and orthonormal axes, for theorems N and E. *)
From Coq Require Import Reals Lra.
From Sdop Require Import Format Geometry Pose Duality.
Open Scope R_scope.

Definition opposite (a : point) : point := pt (- px a) (- py a) (- pz a).
Definition scaled (k : R) (a : point) : point := pt (k * px a) (k * py a) (k * pz a).

Lemma dot_norms (a b : point) : Rabs (dot a b) <= norm a * norm b.
Proof.
  pose proof (norm_nonneg a) as N. pose proof (norm_nonneg b) as M.
  rewrite <- (Rabs_pos_eq (norm a * norm b)) by (now apply Rmult_le_pos).
  apply Rsqr_le_abs_0. unfold Rsqr.
  replace (norm a * norm b * (norm a * norm b)) with (square a * square b)
    by (rewrite <- !norm_square; ring).
  unfold dot, square.
  pose proof (Rle_0_sqr (px a * py b - py a * px b)).
  pose proof (Rle_0_sqr (px a * pz b - pz a * px b)).
  pose proof (Rle_0_sqr (py a * pz b - pz a * py b)). unfold Rsqr in *. lra.
Qed.

Lemma absolute_square (x : R) : Rabs x * Rabs x = x * x.
Proof. pose proof (Rsqr_abs x) as E. unfold Rsqr in E. lra. Qed.

Lemma norm_monotone (a b : point) :
  Rabs (px a) <= px b -> Rabs (py a) <= py b -> Rabs (pz a) <= pz b -> norm a <= norm b.
Proof.
  intros X Y Z. apply norm_below; [apply norm_nonneg |]. rewrite norm_square. unfold square.
  assert (S : forall x y, Rabs x <= y -> x * x <= y * y).
  { intros x y H. rewrite <- absolute_square. pose proof (Rabs_pos x).
    apply Rmult_le_compat; lra. }
  pose proof (S _ _ X). pose proof (S _ _ Y). pose proof (S _ _ Z). lra.
Qed.

Definition absolute (a : point) : point := pt (Rabs (px a)) (Rabs (py a)) (Rabs (pz a)).

Lemma norm_absolute (a : point) : norm (absolute a) = norm a.
Proof.
  unfold norm, absolute, square, pt. cbn [px py pz]. now rewrite !absolute_square.
Qed.

(* The sum of products of absolute values; the sum of coordinates; one coordinate. *)
Lemma absolute_dot (a b : point) :
  Rabs (px a * px b) + Rabs (py a * py b) + Rabs (pz a * pz b) <= norm a * norm b.
Proof.
  rewrite <- (norm_absolute a), <- (norm_absolute b). rewrite !Rabs_mult.
  apply Rle_trans with (2 := dot_norms (absolute a) (absolute b)).
  apply Rle_trans with (2 := Rle_abs _). unfold dot, absolute, pt. cbn [px py pz]. lra.
Qed.

Lemma coordinates_sum (a : point) : Rabs (px a) + Rabs (py a) + Rabs (pz a) <= 1.73206 * norm a.
Proof.
  pose proof (absolute_dot a (pt 1 1 1)) as H. unfold pt in H. cbn [px py pz] in H.
  rewrite !Rmult_1_r in H. apply Rle_trans with (1 := H).
  rewrite Rmult_comm. apply Rmult_le_compat_r; [apply norm_nonneg |].
  apply norm_below; [lra |]. unfold square. cbn [px py pz]. lra.
Qed.

Lemma norm_scaled (k : R) (a : point) : 0 <= k -> norm (scaled k a) = k * norm a.
Proof.
  intro H. unfold norm. rewrite <- (sqrt_square k) at 2 by exact H.
  rewrite <- sqrt_mult.
  - f_equal. unfold square, scaled, pt. cbn [px py pz]. ring.
  - apply Rle_0_sqr.
  - apply square_nonneg.
Qed.

Lemma norm_opposite (a : point) : norm (opposite a) = norm a.
Proof. unfold norm, opposite, square, pt. cbn [px py pz]. f_equal. ring. Qed.

Lemma norm_same (a b c : R) : 0 <= c -> Rabs a <= c -> Rabs b <= c -> forall d, Rabs d <= c ->
  norm (pt a b d) <= 1.73206 * c.
Proof.
  intros Hc A B d D. apply Rle_trans with (norm (pt c c c)); [now apply norm_monotone |].
  apply norm_below; [lra |]. unfold square, pt. cbn [px py pz].
  pose proof (Rle_0_sqr c) as Q. unfold Rsqr in Q. lra.
Qed.

(* Coordinates that err by a share of their own and no more than e. *)
Lemma norm_shares (x v : point) (k e : R) :
  0 <= k -> 0 <= e ->
  Rabs (px x - px v) <= k * Rabs (px v) + e -> Rabs (py x - py v) <= k * Rabs (py v) + e ->
  Rabs (pz x - pz v) <= k * Rabs (pz v) + e -> norm (minus x v) <= k * norm v + 1.73206 * e.
Proof.
  intros K E X Y Z.
  apply Rle_trans with (norm (plus (scaled k (absolute v)) (pt e e e))).
  - apply norm_monotone; unfold plus, minus, scaled, absolute, pt; cbn [px py pz]; assumption.
  - apply Rle_trans with (1 := triangle _ _). rewrite norm_scaled, norm_absolute by exact K.
    apply Rplus_le_compat_l. apply norm_same; rewrite ?Rabs_pos_eq; lra.
Qed.

Lemma norm_difference (a b : point) : norm a <= norm b + norm (minus a b).
Proof.
  replace a with (plus b (minus a b)) at 1; [apply triangle |].
  destruct a as [i j k], b as [l m n]. unfold plus, minus. cbn [px py pz]. f_equal; ring.
Qed.

(* Coordinates along orthonormal axes are no longer than the vector (Bessel), and a combination of
   the axes is as long as its coordinates. *)
Lemma norm_apply (q : matrix) (w : point) : orthonormal q -> norm (apply q w) <= norm w.
Proof.
  destruct q as [[a b c] [d e f] [g h i]], w as [x y z].
  unfold orthonormal, dot. cbn [row0 row1 row2 px py pz]. intros (U0 & U1 & U2 & V0 & V1 & V2).
  apply norm_below; [apply norm_nonneg |]. rewrite norm_square.
  unfold square, apply, dot, pt. cbn [row0 row1 row2 px py pz].
  set (p := a * x + b * y + c * z). set (q := d * x + e * y + f * z).
  set (r := g * x + h * y + i * z).
  pose proof (Rle_0_sqr (x - p * a - q * d - r * g)) as X.
  pose proof (Rle_0_sqr (y - p * b - q * e - r * h)) as Y.
  pose proof (Rle_0_sqr (z - p * c - q * f - r * i)) as Z. unfold Rsqr in *.
  assert (E : (x - p * a - q * d - r * g) * (x - p * a - q * d - r * g)
    + (y - p * b - q * e - r * h) * (y - p * b - q * e - r * h)
    + (z - p * c - q * f - r * i) * (z - p * c - q * f - r * i)
    = x * x + y * y + z * z - 2 * (p * p + q * q + r * r)
      + p * p * (a * a + b * b + c * c) + q * q * (d * d + e * e + f * f)
      + r * r * (g * g + h * h + i * i) + 2 * (p * q * (a * d + b * e + c * f)
      + p * r * (a * g + b * h + c * i) + q * r * (d * g + e * h + f * i)))
    by (unfold p, q, r; ring).
  rewrite U0, U1, U2, V0, V1, V2 in E. lra.
Qed.

Lemma norm_combined (q : matrix) (v : point) : orthonormal q -> norm (combined q v) = norm v.
Proof.
  destruct q as [[a b c] [d e f] [g h i]], v as [x y z].
  unfold orthonormal, dot. cbn [row0 row1 row2 px py pz]. intros (U0 & U1 & U2 & V0 & V1 & V2).
  unfold norm. f_equal. unfold square, combined, pt. cbn [row0 row1 row2 px py pz].
  transitivity (x * x * (a * a + b * b + c * c) + y * y * (d * d + e * e + f * f)
    + z * z * (g * g + h * h + i * i) + 2 * (x * y * (a * d + b * e + c * f)
    + x * z * (a * g + b * h + c * i) + y * z * (d * g + e * h + f * i))); [ring |].
  rewrite U0, U1, U2, V0, V1, V2. ring.
Qed.

(* Dot products of vectors near others. *)
Lemma dot_change (a b c : point) : Rabs (dot a b - dot a c) <= norm a * norm (minus b c).
Proof.
  replace (dot a b - dot a c) with (dot a (minus b c)); [apply dot_norms |].
  unfold dot, minus. cbn [px py pz]. ring.
Qed.

Lemma dot_swap (a b : point) : dot a b = dot b a.
Proof. unfold dot. ring. Qed.
