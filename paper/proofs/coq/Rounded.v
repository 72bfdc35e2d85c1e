(* One and a few rounded operations of f32, underflow included: additions, products, dot products,
   the lesser and the greater of two numbers. *)
From Coq Require Import Reals Bool Lra.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Pose Duality Vectors.
Open Scope R_scope.

Section Operations.
Variable m : mode.
Hypothesis Hm : valid m.

Lemma fl_error (x : R) : Rabs (fl m x - x) <= u * Rabs x + tiny.
Proof.
  pose proof Hm as Ht. unfold valid in Ht. pose proof half_step_value. pose proof u_value.
  pose proof (Rabs_pos x). assert (0 <= u * Rabs x) by (apply Rmult_le_pos; lra).
  unfold fl. case Rlt_bool_spec; intro L.
  - rewrite Rminus_0_l, Rabs_Ropp. lra.
  - pose proof (nearest32_error x). lra.
Qed.

Lemma add_near (x y : R) : Rabs (add m x y - (x + y)) <= u * Rabs (x + y) + 4 * tiny.
Proof.
  unfold add. pose proof (fl_error (read m x + read m y)) as F.
  pose proof (read_error m x) as X. pose proof (read_error m y) as Y. pose proof tiny_value.
  assert (D : Rabs (read m x + read m y - (x + y)) <= 2 * tiny)
    by (apply Rabs_le_inv in X, Y; apply Rabs_le; lra).
  pose proof (Rabs_triang_inv (read m x + read m y) (x + y)). pose proof D as D'.
  apply Rabs_le_inv in F, D'. unfold u in *. apply Rabs_le. lra.
Qed.

Lemma sub_near (x y : R) : Rabs (sub m x y - (x - y)) <= u * Rabs (x - y) + 4 * tiny.
Proof.
  unfold sub. pose proof (fl_error (read m x - read m y)) as F.
  pose proof (read_error m x) as X. pose proof (read_error m y) as Y. pose proof tiny_value.
  assert (D : Rabs (read m x - read m y - (x - y)) <= 2 * tiny)
    by (apply Rabs_le_inv in X, Y; apply Rabs_le; lra).
  pose proof (Rabs_triang_inv (read m x - read m y) (x - y)). pose proof D as D'.
  apply Rabs_le_inv in F, D'. unfold u in *. apply Rabs_le. lra.
Qed.

Lemma mul_near (x y : R) :
  Rabs (mul m x y - x * y) <= u * Rabs (x * y) + tiny * (Rabs x + Rabs y + 1).
Proof.
  unfold mul. pose proof (fl_error (read m x * read m y)) as F.
  pose proof (read_error m x) as X. pose proof (read_error m y) as Y. pose proof tiny_value.
  pose proof (read_abs m x) as A. pose proof (read_abs m y) as B. pose proof u_value.
  pose proof (Rabs_pos x). pose proof (Rabs_pos y). pose proof (Rabs_pos (read m x)).
  pose proof (Rabs_pos (read m y)). pose proof (Rabs_pos (read m x - x)).
  pose proof (Rabs_pos (read m y - y)).
  assert (P : Rabs (read m x * read m y) <= Rabs (x * y))
    by (rewrite !Rabs_mult; apply Rmult_le_compat; lra).
  assert (D : Rabs (read m x * read m y - x * y) <= tiny * (Rabs x + Rabs y)).
  { replace (read m x * read m y - x * y)
      with ((read m x - x) * read m y + x * (read m y - y)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult.
    assert (Rabs (read m x - x) * Rabs (read m y) <= tiny * Rabs y)
      by (apply Rmult_le_compat; lra).
    assert (Rabs x * Rabs (read m y - y) <= Rabs x * tiny) by (apply Rmult_le_compat_l; lra). lra. }
  apply (Rmult_le_compat_l u) in P; [| lra].
  replace (fl m (read m x * read m y) - x * y) with
    ((fl m (read m x * read m y) - read m x * read m y) + (read m x * read m y - x * y)) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). lra.
Qed.

(* src/overlap/ordop/axes.rs: dot *)
Definition dot_of (a b : point) : R :=
  add m (add m (mul m (px a) (px b)) (mul m (py a) (py b))) (mul m (pz a) (pz b)).

Lemma dot_near (a b : point) :
  Rabs (dot_of a b - dot a b) <= 3.01 * u * (norm a * norm b) + tiny * (2 * (norm a + norm b) + 12).
Proof.
  unfold dot_of, dot. pose proof (absolute_dot a b) as N.
  pose proof (coordinates_sum a) as A. pose proof (coordinates_sum b) as B.
  pose proof (mul_near (px a) (px b)) as X. pose proof (mul_near (py a) (py b)) as Y.
  pose proof (mul_near (pz a) (pz b)) as Z. pose proof tiny_value as T.
  apply (Rmult_le_compat_l tiny) in A, B; [| lra | lra].
  rewrite !Rmult_plus_distr_l in *. rewrite !Rmult_1_r in *.
  set (xa := tiny * Rabs (px a)) in *. set (ya := tiny * Rabs (py a)) in *.
  set (za := tiny * Rabs (pz a)) in *. set (xb := tiny * Rabs (px b)) in *.
  set (yb := tiny * Rabs (py b)) in *. set (zb := tiny * Rabs (pz b)) in *.
  assert (Pos : 0 <= xa /\ 0 <= ya /\ 0 <= za /\ 0 <= xb /\ 0 <= yb /\ 0 <= zb)
    by (repeat split; apply Rmult_le_pos; try lra; apply Rabs_pos).
  set (p := mul m (px a) (px b)) in *. set (q := mul m (py a) (py b)) in *.
  set (r := mul m (pz a) (pz b)) in *.
  set (x := px a * px b) in *. set (y := py a * py b) in *. set (z := pz a * pz b) in *.
  pose proof (add_near p q) as S. pose proof (add_near (add m p q) r) as V.
  set (s := add m p q) in *. set (v := add m s r) in *.
  replace (3.01 * u * (norm a * norm b)) with (3.01 * (u * (norm a * norm b))) by ring.
  apply (Rmult_le_compat_l u) in N; [| unfold u; lra].
  set (n := u * (norm a * norm b)) in *.
  replace (tiny * (1.73206 * norm a)) with (1.73206 * (tiny * norm a)) in A by ring.
  replace (tiny * (1.73206 * norm b)) with (1.73206 * (tiny * norm b)) in B by ring.
  replace (tiny * (2 * norm a)) with (2 * (tiny * norm a)) by ring.
  replace (tiny * (2 * norm b)) with (2 * (tiny * norm b)) by ring.
  set (ta := tiny * norm a) in *. set (tb := tiny * norm b) in *.
  assert (PQ : Rabs (p + q) <= 1.001 * (Rabs x + Rabs y) + xa + ya + xb + yb + 2 * tiny).
  { pose proof (Rabs_triang p q). pose proof (Rabs_triang_inv p x).
    pose proof (Rabs_triang_inv q y).
    pose proof (Rabs_pos x). pose proof (Rabs_pos y). unfold u in *. lra. }
  assert (SR : Rabs (s + r) <= 1.002 * (Rabs x + Rabs y + Rabs z)
    + 1.1 * (xa + ya + za + xb + yb + zb) + 8 * tiny).
  { pose proof (Rabs_triang s r). pose proof (Rabs_triang_inv r z).
    pose proof (Rabs_triang_inv s (p + q)). pose proof (Rabs_pos x). pose proof (Rabs_pos y).
    pose proof (Rabs_pos z). unfold u in *. lra. }
  pose proof (Rabs_pos x). pose proof (Rabs_pos y). pose proof (Rabs_pos z).
  apply Rabs_le_inv in X, Y, Z, S, V. clearbody xa ya za xb yb zb ta tb n p q r s v x y z.
  clear - PQ SR X Y Z S V A B N T Pos H H0 H1. unfold u in *. apply Rabs_le. lra.
Qed.

(* The lanes' min and max, of operands that may be read as zero. *)
Definition least (x y : R) : R := Rmin (read m x) (read m y).
Definition most (x y : R) : R := Rmax (read m x) (read m y).

Lemma least_near (x y X Y d : R) :
  Rabs (x - X) <= d -> Rabs (y - Y) <= d -> Rabs (least x y - Rmin X Y) <= d + tiny.
Proof.
  intros D E. unfold least. pose proof (read_error m x) as A. pose proof (read_error m y) as B.
  apply Rabs_le_inv in A, B, D, E. apply Rabs_le. unfold Rmin.
  repeat destruct Rle_dec; lra.
Qed.

Lemma most_near (x y X Y d : R) :
  Rabs (x - X) <= d -> Rabs (y - Y) <= d -> Rabs (most x y - Rmax X Y) <= d + tiny.
Proof.
  intros D E. unfold most. pose proof (read_error m x) as A. pose proof (read_error m y) as B.
  apply Rabs_le_inv in A, B, D, E. apply Rabs_le. unfold Rmax.
  repeat destruct Rle_dec; lra.
Qed.

Lemma least_below (x y : R) :
  0 <= x -> 0 <= y -> 0 <= least x y /\ least x y <= x /\ least x y <= y.
Proof.
  intros X Y. pose proof (read_nonneg m x X). pose proof (read_nonneg m y Y). unfold least, Rmin.
  destruct Rle_dec; lra.
Qed.

Lemma sub_nonneg (x y : R) : 0 <= y <= x -> 0 <= sub m x y.
Proof.
  intro H. unfold sub. apply fl_nonneg. pose proof (read_monotone m y x H). lra.
Qed.
Lemma add_nonneg (x y : R) : 0 <= x -> 0 <= y -> 0 <= add m x y.
Proof.
  intros X Y. unfold add. apply fl_nonneg. pose proof (read_nonneg m x X).
  pose proof (read_nonneg m y Y). lra.
Qed.
Lemma mul_nonneg (x y : R) : 0 <= x -> 0 <= y -> 0 <= mul m x y.
Proof.
  intros X Y. unfold mul. apply fl_nonneg. pose proof (read_nonneg m x X).
  pose proof (read_nonneg m y Y). apply Rmult_le_pos; lra.
Qed.
Lemma most_nonneg (x : R) : 0 <= most x 0.
Proof.
  unfold most. destruct (read_cases m 0) as [-> | [_ ->]]; apply Rmax_r.
Qed.

(* A computed sum of nonnegative terms covers the exact one, W, but for n roundings and e times the
   least normal number. *)
Definition covers (n W e v : R) : Prop :=
  0 <= W /\ 0 <= e /\ 0 <= v /\ W * (1 - n * u) - tiny * e <= v.

Lemma covers_mul (l h g : R) :
  0 <= l -> 0 <= h -> g <= h -> covers 1 (l * Rmax 0 g) (l + Rabs g + 1) (mul m l h).
Proof.
  intros L H G. pose proof tiny_value as T. pose proof (Rabs_pos g) as Pg.
  set (k := Rmax 0 g). assert (K : 0 <= k <= h /\ k <= Rabs g).
  { unfold k, Rmax. pose proof (Rle_abs g). destruct Rle_dec; lra. }
  repeat split; [apply Rmult_le_pos; lra | lra | now apply mul_nonneg |].
  unfold mul. pose proof (read_nonneg m l L) as A. pose proof (read_nonneg m h H) as B.
  pose proof (read_error m l) as C. pose proof (read_error m h) as D.
  apply Rabs_le_inv in C, D.
  assert (P : 0 <= read m l * read m h) by (apply Rmult_le_pos; lra).
  pose proof (fl_below m Hm _ P) as F. pose proof u_value as U.
  assert (Q : l * k - tiny * (l + k) <= read m l * read m h).
  { destruct (Rle_or_lt k (read m h)) as [E | E].
    - assert (read m l * k <= read m l * read m h) by (apply Rmult_le_compat_l; lra).
      assert ((l - read m l) * k <= tiny * k) by (apply Rmult_le_compat_r; lra).
      assert (0 <= tiny * l) by (apply Rmult_le_pos; lra). lra.
    - assert ((l - read m l) * k <= tiny * k) by (apply Rmult_le_compat_r; lra).
      assert (read m l * (k - read m h) <= l * tiny) by (apply Rmult_le_compat; lra). lra. }
  assert (tiny * k <= tiny * Rabs g) by (apply Rmult_le_compat_l; lra).
  assert (0 <= tiny * l) by (apply Rmult_le_pos; lra).
  assert (0 <= tiny * k) by (apply Rmult_le_pos; lra).
  set (w := l * k) in *. set (w' := read m l * read m h) in *.
  assert (0 <= u * (tiny * (l + k))) by (repeat apply Rmult_le_pos; lra).
  unfold u in *. lra.
Qed.

Lemma covers_add (k n W e v n' W' e' v' : R) :
  covers n W e v -> covers n' W' e' v' -> 0 <= k -> n <= k -> n' <= k ->
  covers (k + 1) (W + W') (e + e' + 3) (add m v v').
Proof.
  intros (P & E & V & H) (P' & E' & V' & H') K N N'. pose proof tiny_value as T.
  pose proof u_value as U. repeat split; try lra; [now apply add_nonneg |].
  assert (A : W * (1 - k * u) - tiny * e <= v).
  { assert (W * (n * u) <= W * (k * u)) by (apply Rmult_le_compat_l; [exact P |];
      apply Rmult_le_compat_r; lra). lra. }
  assert (A' : W' * (1 - k * u) - tiny * e' <= v').
  { assert (W' * (n' * u) <= W' * (k * u)) by (apply Rmult_le_compat_l; [exact P' |];
      apply Rmult_le_compat_r; lra). lra. }
  unfold add. pose proof (read_nonneg m v V) as B. pose proof (read_nonneg m v' V') as B'.
  pose proof (read_error m v) as C. pose proof (read_error m v') as C'. apply Rabs_le_inv in C, C'.
  pose proof (fl_below m Hm (read m v + read m v') ltac:(lra)) as F.
  assert (L : (W + W') * (1 - k * u) - tiny * (e + e') - 2 * tiny <= read m v + read m v') by lra.
  apply (Rmult_le_compat_r (1 - u)) in L; [| lra].
  assert (0 <= (W + W') * (k * u * u)).
  { apply Rmult_le_pos; [lra |]. repeat apply Rmult_le_pos; lra. }
  assert (0 <= u * (tiny * (e + e') + 2 * tiny)).
  { apply Rmult_le_pos; [lra |]. assert (0 <= tiny * (e + e')) by (apply Rmult_le_pos; lra). lra. }
  lra.
Qed.

Lemma covers_more (n W e v n' e' : R) : n <= n' -> e <= e' -> covers n W e v -> covers n' W e' v.
Proof.
  intros N E (P & Q & V & H). pose proof u_value as U. pose proof tiny_value as T.
  repeat split; try lra.
  assert (W * (n * u) <= W * (n' * u)) by (apply Rmult_le_compat_l; [exact P |];
    apply Rmult_le_compat_r; lra).
  assert (tiny * e <= tiny * e') by (apply Rmult_le_compat_l; lra). lra.
Qed.

Lemma sub_of_near (x y X Y d e s : R) :
  Rabs (x - X) <= d -> Rabs (y - Y) <= e -> Rabs (x - y) <= s ->
  Rabs (sub m x y - (X - Y)) <= u * s + d + e + 4 * tiny.
Proof.
  intros D E S. pose proof (sub_near x y) as N. apply (Rmult_le_compat_l u) in S; [| unfold u; lra].
  apply Rabs_le_inv in D, E, N. apply Rabs_le. lra.
Qed.
Lemma add_of_near (x y X Y d e s : R) :
  Rabs (x - X) <= d -> Rabs (y - Y) <= e -> Rabs (x + y) <= s ->
  Rabs (add m x y - (X + Y)) <= u * s + d + e + 4 * tiny.
Proof.
  intros D E S. pose proof (add_near x y) as N. apply (Rmult_le_compat_l u) in S; [| unfold u; lra].
  apply Rabs_le_inv in D, E, N. apply Rabs_le. lra.
Qed.
End Operations.

Lemma tiny_small : tiny <= / 1000000000000000000000000000000.
Proof. unfold tiny. apply Rinv_le_contravar; [lra | now apply IZR_le]. Qed.

(* A dot product of nonnegative multipliers with slab ends. *)
Lemma covers_dot (m : mode) (l h : point) (g0 g1 g2 : R) :
  valid m -> 0 <= px l -> 0 <= py l -> 0 <= pz l -> 0 <= px h -> 0 <= py h -> 0 <= pz h ->
  g0 <= px h -> g1 <= py h -> g2 <= pz h ->
  covers 3 (px l * Rmax 0 g0 + py l * Rmax 0 g1 + pz l * Rmax 0 g2)
    (px l + py l + pz l + Rabs g0 + Rabs g1 + Rabs g2 + 9) (dot_of m l h).
Proof.
  intros Hm L0 L1 L2 H0 H1 H2 G0 G1 G2. unfold dot_of.
  pose proof (covers_mul m Hm _ _ _ L0 H0 G0) as A.
  pose proof (covers_mul m Hm _ _ _ L1 H1 G1) as B.
  pose proof (covers_mul m Hm _ _ _ L2 H2 G2) as C.
  pose proof (covers_add m Hm 1 _ _ _ _ _ _ _ _ A B
    ltac:(lra) ltac:(lra) ltac:(lra)) as D.
  pose proof (covers_add m Hm 2 _ _ _ _ _ _ _ _ D C
    ltac:(lra) ltac:(lra) ltac:(lra)) as E.
  revert E. apply covers_more; lra.
Qed.
