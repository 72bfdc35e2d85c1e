(* Theorem D (2): the pose at which a part is tested, and how far that may move a point of it. With
   gradual underflow. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Rejected Ieee Shows Outward.
From Sdop Require Import Finder.
From Sdop Require Import Duality Vectors Norms64 OrDopPose Swept Query.
Open Scope R_scope.

Local Notation g := gradual64.

(* The rotation by the first after that by the second, and the reverse of one. *)
Definition times (p q : quaternion) : quaternion :=
  let '(x, y, z, w) := (qx p, qy p, qz p, qw p) in
  let '(a, b, c, d) := (qx q, qy q, qz q, qw q) in
  {| qx := w * a + x * d + y * c - z * b; qy := w * b - x * c + y * d + z * a;
     qz := w * c + x * b - y * a + z * d; qw := w * d - x * a - y * b - z * c |}.
Definition reverse (q : quaternion) : quaternion :=
  {| qx := - qx q; qy := - qy q; qz := - qz q; qw := qw q |}.
Definition sized (k : R) (q : quaternion) : quaternion :=
  {| qx := k * qx q; qy := k * qy q; qz := k * qz q; qw := k * qw q |}.
Definition apart (p q : quaternion) : quaternion :=
  {| qx := qx p - qx q; qy := qy p - qy q; qz := qz p - qz q; qw := qw p - qw q |}.

Lemma times_norm (p q : quaternion) : norm_of (times p q) = norm_of p * norm_of q.
Proof. unfold norm_of, times. cbn [qx qy qz qw]. ring. Qed.

Lemma times_turns (p q : quaternion) (x : point) :
  0 < norm_of p -> 0 < norm_of q ->
  apply (exact_rotation (times p q)) x = apply (exact_rotation p) (apply (exact_rotation q) x).
Proof.
  intros P Q. pose proof (times_norm p q) as N.
  unfold apply, dot, exact_rotation, pt. cbn [row0 row1 row2 px py pz]. rewrite N.
  unfold times, norm_of in *. cbn [qx qy qz qw]. clear N.
  f_equal; field; lra.
Qed.

(* A larger quaternion turns by no more. *)
Lemma sized_turns (k : R) (q : quaternion) :
  k <> 0 -> 0 < norm_of q -> exact_rotation (sized k q) = exact_rotation q.
Proof.
  intros K Q. assert (N : norm_of (sized k q) = k * k * norm_of q)
    by (unfold norm_of, sized; cbn [qx qy qz qw]; ring).
  unfold exact_rotation. rewrite N. unfold sized. cbn [qx qy qz qw].
  f_equal; unfold pt; f_equal; field; lra.
Qed.

(* Two quaternions turn a point to places that are apart by their difference. *)
Lemma turned_apart (p q : quaternion) (x : point) (k : R) :
  0 < norm_of p -> 0 < norm_of q -> 0 <= k -> norm_of (apart p q) <= k * k * norm_of p ->
  norm (minus (apply (exact_rotation q) x) (apply (exact_rotation p) x)) <= 2 * k * norm x.
Proof.
  intros P Q K D. set (r := times (reverse p) q).
  assert (Pr : norm_of (reverse p) = norm_of p) by (unfold norm_of, reverse; cbn [qx qy qz qw]; ring).
  assert (Nr : norm_of r = norm_of p * norm_of q) by (unfold r; rewrite times_norm, Pr; ring).
  assert (R0 : 0 < norm_of r) by (rewrite Nr; now apply Rmult_lt_0_compat).
  assert (E : times p r = sized (norm_of p) q).
  { unfold r, times, reverse, sized, norm_of. cbn [qx qy qz qw]. f_equal; ring. }
  assert (T : apply (exact_rotation q) x
    = apply (exact_rotation p) (apply (exact_rotation r) x)).
  { rewrite <- times_turns, E, sized_turns by lra. reflexivity. }
  rewrite T. set (y := apply (exact_rotation r) x).
  replace (minus (apply (exact_rotation p) y) (apply (exact_rotation p) x))
    with (apply (exact_rotation p) (minus y x))
    by (unfold apply, minus, dot, pt; cbn [px py pz]; f_equal; ring).
  pose proof (norm_nonneg x) as X. apply norm_below.
  - apply Rmult_le_pos; lra.
  - rewrite rotation_keeps_norm by lra.
    apply Rle_trans with (1 := chord_square r x R0). rewrite <- norm_square.
    assert (G : (norm_of r - qw r * qw r) / norm_of r <= k * k).
    { apply Rmult_le_reg_r with (norm_of r); [exact R0 |]. unfold Rdiv.
      rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
      apply Rle_trans with (norm_of q * norm_of (apart p q)).
      - pose proof (Rle_0_sqr (norm_of q - qw r)) as S. unfold Rsqr in S. rewrite Nr in *.
        replace (norm_of (apart p q)) with (norm_of p + norm_of q - 2 * qw r)
          by (unfold r, times, reverse, norm_of, apart; cbn [qx qy qz qw]; ring). lra.
      - rewrite Nr. apply Rle_trans with (norm_of q * (k * k * norm_of p)); [| lra].
        apply Rmult_le_compat_l; lra. }
    apply Rle_trans with (4 * (k * k) * (norm x * norm x)); [| lra].
    apply Rmult_le_compat_r; [now apply Rmult_le_pos | lra].
Qed.

(* src/rounding/compose.rs: product *)
Definition computed_product (p q : quaternion) : quaternion :=
  let '(x, y, z, w) := (qx p, qy p, qz p, qw p) in
  let '(a, b, c, d) := (qx q, qy q, qz q, qw q) in
  let of i j := mul64 g i j in
  {| qx := sub64 g (add64 g (add64 g (of w a) (of x d)) (of y c)) (of z b);
     qy := add64 g (add64 g (sub64 g (of w b) (of x c)) (of y d)) (of z a);
     qz := add64 g (sub64 g (add64 g (of w c) (of x b)) (of y a)) (of z d);
     qw := sub64 g (sub64 g (sub64 g (of w d) (of x a)) (of y b)) (of z c) |}.
Definition largest_of (q : quaternion) : R :=
  Rmax (Rmax (Rmax (Rmax 0 (Rabs (qx q))) (Rabs (qy q))) (Rabs (qz q))) (Rabs (qw q)).
Definition product (p q : quaternion) : quaternion :=
  let c := computed_product p q in
  let over x := fl gradual (div64 g x (largest_of c)) in
  {| qx := over (qx c); qy := over (qy c); qz := over (qz c); qw := over (qw c) |}.

Lemma sum_of_four (a b c d A B C D : R) :
  Rabs (a - A) <= v * Rabs A + dust -> Rabs (b - B) <= v * Rabs B + dust ->
  Rabs (c - C) <= v * Rabs C + dust -> Rabs (d - D) <= v * Rabs D + dust ->
  Rabs (add64 g (add64 g (add64 g a b) c) d - (A + B + C + D))
    <= 4.01 * v * (Rabs A + Rabs B + Rabs C + Rabs D) + 10 * dust.
Proof.
  intros HA HB HC HD. pose proof v_value as V. pose proof dust_value as Du.
  pose proof (add64_near g valid_g _ _ _ _ _ _ HA HB) as E1.
  pose proof (add64_near g valid_g _ _ _ _ _ _ E1 HC) as E2.
  pose proof (add64_near g valid_g _ _ _ _ _ _ E2 HD) as E3.
  apply Rle_trans with (1 := E3). clear E1 E2 E3 HA HB HC HD.
  pose proof (Rabs_triang A B) as T1. pose proof (Rabs_triang (A + B) C) as T2.
  pose proof (Rabs_triang (A + B + C) D) as T3.
  pose proof (Rabs_pos A). pose proof (Rabs_pos B). pose proof (Rabs_pos C). pose proof (Rabs_pos D).
  unfold v in *. lra.
Qed.

(* Cauchy and Schwarz for quaternions. *)
Lemma four_products (a b c d e f h i : R) :
  0 <= a -> 0 <= b -> 0 <= c -> 0 <= d -> 0 <= e -> 0 <= f -> 0 <= h -> 0 <= i ->
  forall n, 0 <= n -> (a * a + b * b + c * c + d * d) * (e * e + f * f + h * h + i * i) = n * n ->
  a * e + b * f + c * h + d * i <= n.
Proof.
  intros A B C D E F H I n N Eq. apply Rsqr_incr_0_var; [| exact N]. unfold Rsqr. rewrite <- Eq.
  pose proof (Rle_0_sqr (a * f - b * e)). pose proof (Rle_0_sqr (a * h - c * e)).
  pose proof (Rle_0_sqr (a * i - d * e)). pose proof (Rle_0_sqr (b * h - c * f)).
  pose proof (Rle_0_sqr (b * i - d * f)). pose proof (Rle_0_sqr (c * i - d * h)).
  unfold Rsqr in *. lra.
Qed.

Section Product.
Variables p q : quaternion.
Hypothesis Hp : sound_quaternion p.
Hypothesis Hq : sound_quaternion q.
Let n : R := sqrt (norm_of p * norm_of q).
Let exact : quaternion := times p q.
Let found : quaternion := computed_product p q.

Lemma product_size : 0 < n /\ n * n = norm_of exact /\ 1000000 * dust <= v * n.
Proof.
  pose proof (sound_positive p Hp) as P. pose proof (sound_positive q Hq) as Q.
  assert (PQ : 0 < norm_of p * norm_of q) by now apply Rmult_lt_0_compat.
  assert (N : 0 < n) by now apply sqrt_lt_R0.
  split; [exact N |]. split.
  - unfold exact. rewrite times_norm. apply sqrt_sqrt. lra.
  - assert (L : 0 < least_norm) by (unfold least_norm; apply Rinv_0_lt_compat; now apply IZR_lt).
    assert (S : least_norm <= n).
    { unfold n. rewrite <- (sqrt_square least_norm) by lra. apply sqrt_le_1_alt.
      apply Rmult_le_compat; try lra; [apply Hp | apply Hq]. }
    pose proof (dust_share n S) as D. pose proof small_share as (_ & Sh).
    assert (n * / IZR (2 ^ 400) <= n * (v / 1000000)) by (apply Rmult_le_compat_l; lra). lra.
Qed.

Lemma sum_below (a b c d e f h i : R) :
  a * a + b * b + c * c + d * d = norm_of p -> e * e + f * f + h * h + i * i = norm_of q ->
  Rabs (a * e) + Rabs (b * f) + Rabs (c * h) + Rabs (d * i) <= n.
Proof.
  intros P Q. rewrite !Rabs_mult. destruct product_size as (N & E & _).
  apply four_products; try apply Rabs_pos; [lra |]. rewrite !absolute_square, P, Q.
  unfold n. symmetry. apply sqrt_sqrt. apply Rlt_le, Rmult_lt_0_compat; now apply sound_positive.
Qed.

Definition close (a b d : R) : Prop := Rabs (a - b) <= d.

Lemma product_close :
  close (qx found) (qx exact) (4.02 * v * n) /\ close (qy found) (qy exact) (4.02 * v * n) /\
  close (qz found) (qz exact) (4.02 * v * n) /\ close (qw found) (qw exact) (4.02 * v * n).
Proof.
  destruct (components_big p Hp) as (Px & Py & Pz & Pw).
  destruct (components_big q Hq) as (Qx & Qy & Qz & Qw).
  destruct product_size as (N & _ & D). pose proof v_value as V.
  assert (Plus : forall a b, Rabs a <= big -> Rabs b <= big ->
    Rabs (mul64 g a b - a * b) <= v * Rabs (a * b) + dust) by (intros; now apply (mul64_error g valid_g)).
  assert (Minus : forall a b, Rabs a <= big -> Rabs b <= big ->
    Rabs (- mul64 g a b - - (a * b)) <= v * Rabs (- (a * b)) + dust)
    by (intros; now apply (negative_error g valid_g)).
  unfold close, found, exact, computed_product, times. cbn [qx qy qz qw]. rewrite !sub64_as_add.
  unfold Rminus.
  repeat split.
  all: eapply Rle_trans; [apply sum_of_four; first [now apply Plus | now apply Minus] |].
  all: rewrite !Rabs_Ropp.
  all: match goal with
    |- 4.01 * v * (Rabs (?a * ?i) + Rabs (?b * ?j) + Rabs (?c * ?k) + Rabs (?d * ?l)) + _ <= _ =>
      pose proof (sum_below a b c d i j k l ltac:(unfold norm_of; ring) ltac:(unfold norm_of; ring)) as S
    end.
  all: apply (Rmult_le_compat_l v) in S; [| lra].
  all: pose proof dust_value; lra.
Qed.

Definition all_close (a b : quaternion) (k d : R) : Prop :=
  close (qx a) (qx b) (k * Rabs (qx b) + d) /\ close (qy a) (qy b) (k * Rabs (qy b) + d) /\
  close (qz a) (qz b) (k * Rabs (qz b) + d) /\ close (qw a) (qw b) (k * Rabs (qw b) + d).

Lemma largest_found :
  0.49 * n <= largest_of found <= 1.001 * n /\ Rabs (qx found) <= largest_of found /\
  Rabs (qy found) <= largest_of found /\ Rabs (qz found) <= largest_of found /\
  Rabs (qw found) <= largest_of found.
Proof.
  destruct product_size as (N & E & _). destruct product_close as (X & Y & Z & W).
  pose proof v_value as V. unfold close in *.
  assert (L : Rabs (qx found) <= largest_of found /\ Rabs (qy found) <= largest_of found /\
    Rabs (qz found) <= largest_of found /\ Rabs (qw found) <= largest_of found).
  { unfold largest_of. repeat split; repeat (first [apply Rmax_r | apply Rle_trans with (2 := Rmax_l _ _)]). }
  split; [| exact L]. destruct L as (Lx & Ly & Lz & Lw).
  assert (Small : v * n <= / 1000000 * n) by (apply Rmult_le_compat_r; unfold v; lra).
  split.
  2: { assert (S : forall f t, Rabs (f - t) <= 4.02 * v * n -> t * t <= n * n -> Rabs f <= 1.001 * n).
    { intros f t H B. assert (T : Rabs t <= n).
      { rewrite <- (Rabs_pos_eq n) by lra. now apply Rsqr_le_abs_0. }
      pose proof (Rabs_triang_inv f t). lra. }
    destruct (square_shares exact) as (Qx & Qy & Qz & Qw). unfold norm_of in E.
    unfold largest_of. repeat apply Rmax_lub; [lra | eapply S; eauto; lra ..]. }
  destruct (Rle_or_lt (0.49 * n) (largest_of found)) as [G | G]; [exact G | exfalso].
  assert (S : forall f t, Rabs (f - t) <= 4.02 * v * n -> Rabs f <= largest_of found ->
    t * t <= 0.4999 * n * (0.4999 * n)).
  { intros f t H B. rewrite <- absolute_square. pose proof (Rabs_triang_inv t f).
    rewrite Rabs_minus_sym in H. pose proof (Rabs_pos t).
    apply Rmult_le_compat; lra. }
  pose proof (S _ _ X Lx). pose proof (S _ _ Y Ly). pose proof (S _ _ Z Lz). pose proof (S _ _ W Lw).
  assert (0 < n * n) by (apply Rmult_lt_0_compat; lra). unfold norm_of in E. lra.
Qed.

(* A number divided by the largest, within a rounding of the exact one. *)
Lemma rounded_share (f t l : R) :
  0.49 * n <= l -> Rabs f <= l -> Rabs (f - t) <= 4.02 * v * n ->
  close (fl gradual (div64 g f l)) (/ l * t) (u * Rabs (/ l * t) + 9.3 * v).
Proof.
  intros L B H. destruct product_size as (N & _). pose proof v_value as V. pose proof u_value as U.
  pose proof half_step_small as Hs. pose proof (proj1 tiny64_value) as T0. pose proof tiny64_dust as T1.
  assert (P : 0 < l) by lra. assert (I : 0 < / l) by now apply Rinv_0_lt_compat.
  assert (D : dust <= v / 1000000).
  { pose proof small_share as (_ & S). apply Rle_trans with (2 := S). unfold dust.
    apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
  assert (E1 : Rabs (f / l - / l * t) <= 8.21 * v).
  { replace (f / l - / l * t) with ((f - t) * / l) by (unfold Rdiv; ring).
    rewrite Rabs_mult, (Rabs_pos_eq (/ l)) by lra. apply Rmult_le_reg_r with l; [exact P |].
    rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra. apply Rle_trans with (1 := H).
    apply Rle_trans with (8.21 * v * (0.49 * n)); [| apply Rmult_le_compat_l; lra].
    assert (0 <= v * n) by (apply Rmult_le_pos; lra). lra. }
  assert (E2 : Rabs (f / l) <= 1).
  { unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ l)) by lra. apply Rmult_le_reg_r with l; [exact P |].
    rewrite Rmult_assoc, Rinv_l, Rmult_1_r, Rmult_1_l by lra. exact B. }
  unfold close, div64. rewrite !read64_is. pose proof (fl64_error g valid_g (f / l)) as E3.
  set (x := fl64 g (f / l)) in *. set (y := / l * t) in *. set (z := f / l) in *.
  pose proof (gradual_cast x) as E4.
  assert (E5 : Rabs (x - y) <= 9.22 * v).
  { replace (x - y) with ((x - z) + (z - y)) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
    assert (v * Rabs z <= v * 1) by (apply Rmult_le_compat_l; lra). lra. }
  assert (E6 : Rabs x <= Rabs y + 9.22 * v) by (pose proof (Rabs_triang_inv x y); lra).
  replace (fl gradual x - y) with ((fl gradual x - x) + (x - y)) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _).
  assert (u * Rabs x <= u * (Rabs y + 9.22 * v)) by (apply Rmult_le_compat_l; lra).
  assert (u * v <= / 1000000 * v) by (apply Rmult_le_compat_r; unfold u; lra). lra.
Qed.

(* The product turns a point as the exact one, but for 2.0002 roundings of its distance. *)
Lemma product_turns (x : point) :
  0 < norm_of (product p q) /\
  norm (minus (apply (exact_rotation (product p q)) x)
    (apply (exact_rotation p) (apply (exact_rotation q) x))) <= 2.0002 * u * norm x.
Proof.
  destruct largest_found as ((L & L') & Lx & Ly & Lz & Lw). destruct product_size as (N & E & _).
  destruct product_close as (X & Y & Z & W). pose proof v_value as V. pose proof u_value as U.
  set (l := largest_of found) in *.
  assert (P : 0 < l) by lra. assert (I : 0 < / l) by now apply Rinv_0_lt_compat.
  pose proof (rounded_share _ _ l L Lx X) as Cx. pose proof (rounded_share _ _ l L Ly Y) as Cy.
  pose proof (rounded_share _ _ l L Lz Z) as Cz. pose proof (rounded_share _ _ l L Lw W) as Cw.
  set (t := sized (/ l) exact).
  assert (M : 0.99 <= norm_of t).
  { replace (norm_of t) with (n / l * (n / l)).
    - apply Rle_trans with (/ 1.001 * / 1.001); [lra |].
      assert (/ 1.001 <= n / l).
      { apply Rmult_le_reg_r with l; [exact P |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. }
      apply Rmult_le_compat; lra.
    - unfold t. replace (norm_of (sized (/ l) exact)) with (/ l * / l * norm_of exact)
        by (unfold norm_of, sized; cbn [qx qy qz qw]; ring).
      rewrite <- E. unfold Rdiv. ring. }
  assert (D : norm_of (apart t (product p q)) <= 1.0001 * u * (1.0001 * u) * norm_of t).
  { assert (S : forall a b, close a b (u * Rabs b + 9.3 * v) ->
      (b - a) * (b - a) <= 1.00001 * u * (1.00001 * u) * (b * b) + 0.00001 * u * (0.00001 * u)).
    { intros a b H. unfold close in H. rewrite Rabs_minus_sym in H.
      rewrite <- (absolute_square (b - a)), <- (absolute_square b).
      set (B := Rabs b) in *. assert (PB : 0 <= B) by apply Rabs_pos. pose proof (Rabs_pos (b - a)).
      assert (K : 9.3 * v <= / 50000000 * u) by (unfold u, v; lra).
      apply Rle_trans with ((u * (B + / 50000000)) * (u * (B + / 50000000))).
      - apply Rmult_le_compat; lra.
      - replace (u * (B + / 50000000) * (u * (B + / 50000000)))
          with (u * u * ((B + / 50000000) * (B + / 50000000))) by ring.
        replace (1.00001 * u * (1.00001 * u) * (B * B) + 0.00001 * u * (0.00001 * u))
          with (u * u * (1.00001 * 1.00001 * (B * B) + 0.00001 * 0.00001)) by ring.
        apply Rmult_le_compat_l; [apply Rle_0_sqr |].
        pose proof (Rle_0_sqr (B - 0.001)) as Q. unfold Rsqr in Q. lra. }
    pose proof (S _ _ Cx) as Sx. pose proof (S _ _ Cy) as Sy. pose proof (S _ _ Cz) as Sz.
    pose proof (S _ _ Cw) as Sw.
    assert (G : norm_of (apart t (product p q))
      <= 1.00001 * u * (1.00001 * u) * norm_of t + 4 * (0.00001 * u * (0.00001 * u))).
    { unfold norm_of at 1, norm_of at 1, apart, t, sized, product. cbn [qx qy qz qw]. fold found l.
      unfold norm_of. cbn [qx qy qz qw]. lra. }
    apply Rle_trans with (1 := G).
    replace (1.00001 * u * (1.00001 * u) * norm_of t + 4 * (0.00001 * u * (0.00001 * u)))
      with (u * u * (1.00001 * 1.00001 * norm_of t + 4 * (0.00001 * 0.00001))) by ring.
    replace (1.0001 * u * (1.0001 * u) * norm_of t) with (u * u * (1.0001 * 1.0001 * norm_of t)) by ring.
    apply Rmult_le_compat_l; [apply Rle_0_sqr | lra]. }
  assert (F : 0 < norm_of (product p q)).
  { destruct (square_shares (product p q)) as (Sx & Sy & Sz & Sw).
    destruct (Rle_or_lt (norm_of (product p q)) 0) as [G | G]; [exfalso | exact G].
    assert (Zero : forall y, 0 <= y * y -> y * y <= 0 -> y = 0)
      by (intros y A B; apply Rsqr_0_uniq; unfold Rsqr; lra).
    unfold norm_of in G.
    assert (H : norm_of (apart t (product p q)) = norm_of t).
    { unfold norm_of at 1, apart. cbn [qx qy qz qw].
      rewrite (Zero _ Sx ltac:(lra)), (Zero _ Sy ltac:(lra)), (Zero _ Sz ltac:(lra)),
        (Zero _ Sw ltac:(lra)).
      unfold norm_of. ring. }
    rewrite H in D. assert (1.0001 * u * (1.0001 * u) * norm_of t <= 0.1 * norm_of t).
    { apply Rmult_le_compat_r; [lra | unfold u; lra]. }
    lra. }
  split; [exact F |].
  rewrite <- times_turns by now apply sound_positive. fold exact.
  assert (Px : 0 < norm_of exact) by (rewrite <- E; apply Rmult_lt_0_compat; lra).
  rewrite <- (sized_turns (/ l) exact) by lra. fold t.
  apply Rle_trans with (2 * (1.0001 * u) * norm x); [| lra].
  apply turned_apart; [lra | exact F | unfold u; lra | exact D].
Qed.
End Product.

(* src/rounding/compose.rs: TURN_ERROR; src/rounding/pose.rs: OFFSET_ERROR;
   src/compound/part_set.rs: PartSet::posed, of a part that is turned and moved. *)
Definition turn_error : R := 1.125 * (2 * u).
Definition offset_error : R := 64 * v.
Definition part_error (size radius : R) : R :=
  add64 g (mul64 g size offset_error) (mul64 g turn_error radius).

(* A point of a part at its exact place is near where the part is tested, with room for the sums in
   which the error becomes a margin. *)
Theorem part_near (q inner : quaternion) (t inner_t y : point) (size radius : R) :
  sound_quaternion q -> sound_quaternion inner -> within size t -> within size inner_t ->
  / IZR (2 ^ 600) <= size <= big / 2 -> norm y <= radius <= big ->
  0 < norm_of (product q inner) /\
  distance (posed (product q inner) (transform g (rotation_of g q) inner_t t) y)
    (posed q t (posed inner inner_t y)) * (1 + 16 * v) <= part_error size radius.
Proof.
  intros Hq Hi Ht Hit (S0 & S1) (Y & R1). pose proof v_value as V. pose proof dust_value as D.
  destruct (product_turns q inner Hq Hi y) as (F & T). split; [exact F |].
  assert (P600 : 0 < / IZR (2 ^ 600)) by (apply Rinv_0_lt_compat; now apply IZR_lt).
  pose proof (norm_nonneg y) as Ny.
  pose proof (transform_error g q t inner_t size valid_g Hq ltac:(lra) Ht Hit) as E.
  assert (Du : 1000000 * dust <= v * size).
  { apply Rle_trans with (v * / IZR (2 ^ 600)); [| apply Rmult_le_compat_l; lra].
    unfold dust, v. rewrite <- Rinv_mult, <- mult_IZR. change (2 ^ 700)%Z with (2 ^ 47 * 2 ^ 653)%Z.
    rewrite mult_IZR, Rinv_mult. change (9007199254740992 * 2 ^ 600)%Z with (2 ^ 653)%Z.
    assert (0 < / IZR (2 ^ 653)) by (apply Rinv_0_lt_compat; now apply IZR_lt).
    assert (1000000 * / IZR (2 ^ 47) <= 1) by lra.
    rewrite <- Rmult_assoc. rewrite <- (Rmult_1_l (/ IZR (2 ^ 653))) at 2.
    apply Rmult_le_compat_r; lra. }
  assert (W : distance (posed (product q inner) (transform g (rotation_of g q) inner_t t) y)
    (posed q t (posed inner inner_t y)) <= 2.0002 * u * radius + 61.2 * v * size).
  { set (f := product q inner) in *. set (place := transform g (rotation_of g q) inner_t t) in *.
    assert (A : posed q t (posed inner inner_t y)
      = plus (apply (exact_rotation q) (apply (exact_rotation inner) y)) (posed q t inner_t)).
    { unfold posed, apply, plus, dot, pt. cbn [px py pz]. f_equal; ring. }
    unfold distance in *. rewrite A, <- norm_opposite.
    replace (opposite _) with (plus
      (minus (apply (exact_rotation f) y) (apply (exact_rotation q) (apply (exact_rotation inner) y)))
      (minus place (posed q t inner_t)))
      by (unfold posed at 3, opposite, plus, minus, pt; cbn [px py pz]; f_equal; ring).
    apply Rle_trans with (1 := triangle _ _).
    assert (2.0002 * u * norm y <= 2.0002 * u * radius) by (apply Rmult_le_compat_l; unfold u; lra).
    lra. }
  set (d := distance _ _) in *. assert (Pd : 0 <= d) by apply norm_nonneg.
  pose proof (fl64_error g valid_g) as Fl. pose proof tiny64_dust as T64.
  pose proof (proj1 tiny64_value) as T0.
  unfold part_error, add64, mul64. rewrite !read64_is.
  assert (P1 : 0 <= size * offset_error) by (apply Rmult_le_pos; unfold offset_error; lra).
  assert (P2 : 0 <= turn_error * radius) by (apply Rmult_le_pos; unfold turn_error, u; lra).
  pose proof (Fl (size * offset_error)) as E1. rewrite (Rabs_pos_eq _ P1) in E1.
  pose proof (Fl (turn_error * radius)) as E2. rewrite (Rabs_pos_eq _ P2) in E2.
  pose proof (fl64_nonneg g _ P1) as Q1. pose proof (fl64_nonneg g _ P2) as Q2.
  set (a := fl64 g (size * offset_error)) in *. set (b := fl64 g (turn_error * radius)) in *.
  pose proof (Fl (a + b)) as E3. rewrite (Rabs_pos_eq (a + b)) in E3 by lra.
  apply Rabs_le_inv in E1, E2, E3. clear Fl. set (c := fl64 g (a + b)) in *.
  assert (P3 : 0 <= v * size) by (apply Rmult_le_pos; lra).
  assert (P4 : 0 <= u * radius) by (apply Rmult_le_pos; unfold u; lra).
  clearbody a b c d. unfold offset_error, turn_error in *.
  replace (size * (64 * v)) with (64 * (v * size)) in E1, P1 by ring.
  replace (1.125 * (2 * u) * radius) with (2.25 * (u * radius)) in E2, P2 by lra.
  replace (2.0002 * u * radius) with (2.0002 * (u * radius)) in W by ring.
  replace (61.2 * v * size) with (61.2 * (v * size)) in W by ring.
  set (s := v * size) in *. set (r := u * radius) in *. clearbody s r.
  unfold v in *. lra.
Qed.
