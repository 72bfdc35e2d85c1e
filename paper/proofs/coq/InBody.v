(* Theorem Q (1): points and vectors turned into a body's frame and out of it, in f64 with gradual
   underflow, and how far they are from exact. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Rejected Ieee Shows Outward.
From Sdop Require Import Finder Duality Vectors Norms64 OrDopTest OrDopPose Query.
Open Scope R_scope.

Local Notation g := gradual64.

Definition format_point (p : point) : Prop :=
  format64 (px p) /\ format64 (py p) /\ format64 (pz p).

(* src/rounding/pose.rs: rotate_of; src/rounding/query.rs: turn_back, into_body, largest *)
Definition turned (a : matrix) (p : point) : point :=
  pt (rotate_row g (row0 a) p) (rotate_row g (row1 a) p) (rotate_row g (row2 a) p).
Definition turned_back (a : matrix) (p : point) : point := turned (transposed a) p.
Definition seen_from (p t : point) : point :=
  pt (sub64 g (px p) (px t)) (sub64 g (py p) (py t)) (sub64 g (pz p) (pz t)).
Definition largest (p : point) : R :=
  Rmax (Rmax (Rmax 0 (Rabs (px p))) (Rabs (py p))) (Rabs (pz p)).

Lemma largest_above (p : point) : 0 <= largest p /\ within (largest p) p /\ norm p <= 1.73206 * largest p.
Proof.
  unfold largest. set (a := Rabs (px p)). set (b := Rabs (py p)). set (c := Rabs (pz p)).
  assert (A : 0 <= a) by apply Rabs_pos.
  assert (W : within (Rmax (Rmax (Rmax 0 a) b) c) p).
  { unfold within. fold a b c. repeat split;
      repeat (first [apply Rmax_r | apply Rle_trans with (2 := Rmax_l _ _)]). }
  split; [apply Rle_trans with (1 := A), W | split; [exact W | now apply norm_of_coordinates]].
Qed.

Lemma largest_below (p : point) : largest p <= norm p.
Proof.
  destruct (coordinates_of_norm p (norm p) (Rle_refl _)) as (X & Y & Z). pose proof (norm_nonneg p).
  unfold largest. repeat apply Rmax_lub; assumption.
Qed.

Lemma apply_transposed (a : matrix) (x y : point) :
  dot (apply a x) y = dot x (apply (transposed a) y).
Proof. unfold apply, transposed, dot, pt. cbn [row0 row1 row2 px py pz]. ring. Qed.

(* A sum of three products. *)
Lemma dot_rounded (a b : point) :
  Rabs (rotate_row g a b - dot a b) <= 3.01 * v * (norm a * norm b) + 6 * tiny64.
Proof.
  pose proof v_value as V. pose proof (proj1 tiny64_value) as T.
  pose proof (rounded64 (px a * px b)) as X. pose proof (rounded64 (py a * py b)) as Y.
  pose proof (rounded64 (pz a * pz b)) as Z. pose proof (absolute_dot a b) as S.
  unfold rotate_row, add64, mul64, dot. rewrite !read64_is.
  set (p := px a * px b) in *. set (q := py a * py b) in *. set (r := pz a * pz b) in *.
  set (n := norm a * norm b) in *.
  set (p' := fl64 g p) in *. set (q' := fl64 g q) in *. set (r' := fl64 g r) in *.
  pose proof (rounded64 (p' + q')) as PQ. set (s := fl64 g (p' + q')) in *.
  pose proof (rounded64 (s + r')) as E.
  pose proof (Rabs_triang_inv p' p). pose proof (Rabs_triang_inv q' q). pose proof (Rabs_triang_inv r' r).
  pose proof (Rabs_triang p' q'). pose proof (Rabs_triang_inv s (p' + q')). pose proof (Rabs_triang s r').
  replace (fl64 g (s + r') - (p + q + r))
    with ((fl64 g (s + r') - (s + r')) + ((s - (p' + q')) + ((p' - p) + ((q' - q) + (r' - r))))) by ring.
  repeat (eapply Rle_trans; [apply Rabs_triang |]; apply Rle_trans with (2 := Rle_refl _)).
  pose proof (Rabs_triang (p' - p) ((q' - q) + (r' - r))). pose proof (Rabs_triang (q' - q) (r' - r)).
  pose proof (Rabs_triang (s - (p' + q')) ((p' - p) + ((q' - q) + (r' - r)))).
  pose proof (Rabs_pos p). pose proof (Rabs_pos q). pose proof (Rabs_pos r).
  clearbody p q r p' q' r' s n. unfold v in *. lra.
Qed.

(* A matrix of f64 near an exact one with rows of length 1. *)
Definition near_matrix (a e : matrix) : Prop :=
  (row_error (row0 a) (row0 e) /\ row_error (row1 a) (row1 e) /\ row_error (row2 a) (row2 e)) /\
  norm (row0 e) = 1 /\ norm (row1 e) = 1 /\ norm (row2 e) = 1.

Lemma row_turned (a e w : point) :
  row_error a e -> norm e = 1 ->
  Rabs (rotate_row g a w - dot e w) <= 18.8 * v * norm w + 6 * tiny64.
Proof.
  intros (X & Y & Z) N. pose proof v_value as V. pose proof (dot_rounded a w) as D.
  pose proof (norm_nonneg w) as W.
  assert (E : norm (minus a e) <= 15.77 * v).
  { apply Rle_trans with (1.73206 * (9.1 * v)); [| lra].
    apply norm_of_coordinates. unfold within, minus. cbn [px py pz]. repeat split; assumption. }
  assert (A : norm a <= 1.0001).
  { pose proof (norm_difference a e). unfold v in *. lra. }
  assert (C : Rabs (dot a w - dot e w) <= 15.77 * v * norm w).
  { rewrite (dot_swap a), (dot_swap e). apply Rle_trans with (1 := dot_change w a e).
    rewrite Rmult_comm. apply Rmult_le_compat_r; assumption. }
  replace (rotate_row g a w - dot e w) with ((rotate_row g a w - dot a w) + (dot a w - dot e w)) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _).
  assert (P : norm a * norm w <= 1.0001 * norm w) by (apply Rmult_le_compat_r; assumption).
  apply (Rmult_le_compat_l v) in P; [| lra].
  assert (0 <= v * norm w) by (apply Rmult_le_pos; lra). lra.
Qed.

Lemma turned_near (a e : matrix) (w : point) :
  near_matrix a e -> norm (minus (turned a w) (apply e w)) <= 32.6 * v * norm w + 11 * tiny64.
Proof.
  intros ((A0 & A1 & A2) & N0 & N1 & N2). pose proof v_value as V. pose proof (norm_nonneg w) as W.
  pose proof (proj1 tiny64_value) as T.
  apply Rle_trans with (1.73206 * (18.8 * v * norm w + 6 * tiny64)).
  - apply norm_of_coordinates. unfold within, minus, turned, apply, pt. cbn [px py pz].
    repeat split; now apply row_turned.
  - assert (0 <= v * norm w) by (apply Rmult_le_pos; lra). lra.
Qed.

(* A difference of f64 points. *)
Lemma seen_from_near (p t : point) :
  format_point p -> format_point t ->
  norm (minus (seen_from p t) (minus p t)) <= 1.001 * v * norm (seen_from p t).
Proof.
  intros (P0 & P1 & P2) (T0 & T1 & T2). pose proof v_value as V.
  pose proof (sub64_share _ _ P0 T0) as X. pose proof (sub64_share _ _ P1 T1) as Y.
  pose proof (sub64_share _ _ P2 T2) as Z.
  assert (B : norm (minus (seen_from p t) (minus p t)) <= v * norm (minus p t) + 1.73206 * 0).
  { apply norm_shares; try lra; rewrite Rplus_0_r; assumption. }
  pose proof (norm_difference (minus p t) (seen_from p t)) as D.
  assert (S : norm (minus (minus p t) (seen_from p t)) = norm (minus (seen_from p t) (minus p t))).
  { rewrite <- norm_opposite. f_equal. unfold opposite, minus, pt. cbn [px py pz]. f_equal; ring. }
  rewrite S in D. set (d := norm (minus (seen_from p t) (minus p t))) in *. clearbody d.
  pose proof (norm_nonneg (minus p t)). unfold v in *. lra.
Qed.

Section Rotation.
Variable q : quaternion.
Hypothesis Hq : sound_quaternion q.
Let r : matrix := rotation_of g q.
Let e : matrix := exact_rotation q.

Lemma rotation_near : near_matrix r e /\ near_matrix (transposed r) (transposed e).
Proof.
  destruct (rotation_error g valid_g q Hq) as ((X0 & Y0 & Z0) & (X1 & Y1 & Z1) & X2 & Y2 & Z2).
  pose proof (sound_positive q Hq) as P. destruct (unit_rows q P) as (U0 & U1 & U2).
  assert (Unit : forall x, dot x x = 1 -> norm x = 1).
  { intros x D. unfold norm. replace (square x) with (dot x x) by reflexivity. now rewrite D, sqrt_1. }
  unfold near_matrix, row_error, transposed. cbn [row0 row1 row2]. unfold pt. cbn [px py pz].
  repeat split; try assumption; apply Unit; try assumption.
  all: unfold e, exact_rotation, dot, pt, norm_of in *; cbn [row0 row1 row2 px py pz]; field; lra.
Qed.

Lemma back_inverts (x : point) : apply (transposed e) (apply e x) = x.
Proof.
  pose proof (sound_positive q Hq) as P. destruct x as [a b c].
  unfold e, apply, transposed, exact_rotation, dot, pt, norm_of in *. cbn [row0 row1 row2 px py pz].
  f_equal; field; lra.
Qed.

Lemma turned_norm (x : point) : norm (apply e x) = norm x.
Proof. unfold norm, e. now rewrite (rotation_keeps_norm q x (sound_positive q Hq)). Qed.

Lemma back_norm (x : point) : norm (apply (transposed e) x) = norm x.
Proof.
  pose proof (sound_positive q Hq) as P. unfold norm. f_equal. destruct x as [a b c].
  unfold square, e, apply, transposed, exact_rotation, dot, pt, norm_of in *.
  cbn [row0 row1 row2 px py pz]. field. lra.
Qed.

Lemma forth_inverts (x : point) : apply e (apply (transposed e) x) = x.
Proof.
  pose proof (sound_positive q Hq) as P. destruct x as [a b c].
  unfold e, apply, transposed, exact_rotation, dot, pt, norm_of in *. cbn [row0 row1 row2 px py pz].
  f_equal; field; lra.
Qed.

(* A difference of places, seen from the body. *)
Lemma into_body_near (w d : point) :
  norm (minus w d) <= 1.001 * v * norm w ->
  norm (minus (turned_back r w) (apply (transposed e) d)) <= 33.7 * v * norm w + 11 * tiny64.
Proof.
  intro D. pose proof v_value as V. destruct rotation_near as (_ & N).
  pose proof (turned_near _ _ w N) as A.
  replace (minus (turned_back r w) (apply (transposed e) d))
    with (plus (minus (turned_back r w) (apply (transposed e) w)) (apply (transposed e) (minus w d)))
    by (unfold plus, apply, minus, dot, pt; cbn [px py pz]; f_equal; ring).
  apply Rle_trans with (1 := triangle _ _). rewrite back_norm. fold (turned_back r w) in A.
  assert (0 <= v * norm w) by (apply Rmult_le_pos; [lra | apply norm_nonneg]). lra.
Qed.
End Rotation.
