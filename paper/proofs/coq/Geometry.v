(* Points, the Euclidean norm and balls. *)
From Coq Require Import Reals Lra.
Open Scope R_scope.

Record point := { px : R; py : R; pz : R }.
Record ball := { centre : point; radius : R }.

Definition plus (a b : point) : point :=
  {| px := px a + px b; py := py a + py b; pz := pz a + pz b |}.
Definition minus (a b : point) : point :=
  {| px := px a - px b; py := py a - py b; pz := pz a - pz b |}.

Definition square (a : point) : R := px a * px a + py a * py a + pz a * pz a.
Definition norm (a : point) : R := sqrt (square a).
Definition distance (a b : point) : R := norm (minus b a).

Definition in_ball (p : point) (b : ball) : Prop := distance p (centre b) <= radius b.

Lemma square_nonneg (a : point) : 0 <= square a.
Proof.
  pose proof (Rle_0_sqr (px a)). pose proof (Rle_0_sqr (py a)). pose proof (Rle_0_sqr (pz a)).
  unfold square, Rsqr in *. lra.
Qed.

Lemma norm_nonneg (a : point) : 0 <= norm a.
Proof. apply sqrt_pos. Qed.

Lemma norm_square (a : point) : norm a * norm a = square a.
Proof. apply sqrt_sqrt. apply square_nonneg. Qed.

Lemma norm_below (a : point) (l : R) : 0 <= l -> square a <= l * l -> norm a <= l.
Proof.
  intros Hl H. rewrite <- (sqrt_square l) by exact Hl. now apply sqrt_le_1_alt.
Qed.

Lemma triangle (a b : point) : norm (plus a b) <= norm a + norm b.
Proof.
  pose proof (norm_nonneg a) as Ha. pose proof (norm_nonneg b) as Hb.
  apply norm_below; [lra |].
  set (dot := px a * px b + py a * py b + pz a * pz b).
  assert (Hdot : dot <= norm a * norm b).
  { apply Rle_trans with (Rabs dot); [apply Rle_abs |].
    rewrite <- (Rabs_pos_eq (norm a * norm b)) by (apply Rmult_le_pos; assumption).
    apply Rsqr_le_abs_0. unfold Rsqr.
    replace (norm a * norm b * (norm a * norm b)) with (square a * square b)
      by (rewrite <- !norm_square; ring).
    unfold dot, square.
    pose proof (Rle_0_sqr (px a * py b - py a * px b)).
    pose proof (Rle_0_sqr (px a * pz b - pz a * px b)).
    pose proof (Rle_0_sqr (py a * pz b - pz a * py b)). unfold Rsqr in *. lra. }
  replace (square (plus a b)) with (square a + square b + 2 * dot)
    by (unfold square, plus, dot; cbn; ring).
  rewrite <- !norm_square. lra.
Qed.

Lemma distance_triangle (a b c : point) : distance a c <= distance a b + distance b c.
Proof.
  unfold distance. replace (minus c a) with (plus (minus b a) (minus c b)) by
    (unfold plus, minus; cbn; f_equal; ring).
  apply triangle.
Qed.

Lemma distance_symmetric (a b : point) : distance a b = distance b a.
Proof. unfold distance, norm, square, minus. cbn. f_equal. ring. Qed.

(* Balls with a common point have centres no farther apart than the sum of their radii. *)
Lemma balls_meet (p : point) (a b : ball) :
  in_ball p a -> in_ball p b -> distance (centre a) (centre b) <= radius a + radius b.
Proof.
  unfold in_ball. intros Ha Hb.
  pose proof (distance_triangle (centre a) p (centre b)).
  rewrite (distance_symmetric (centre a) p) in *. lra.
Qed.
