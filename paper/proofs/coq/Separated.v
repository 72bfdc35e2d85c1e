(* Theorems N and E with rounding: where the code's comparison rejects a pair of or-DOPs along an
   axis, their polytopes have no common point, since the slabs' margin exceeds what rounding can
   take. Any underflow is included. *)
From Coq Require Import Reals Bool List Lra.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Pose Duality Vectors Rounded SupportParts SupportRounded.
Import ListNotations.
Open Scope R_scope.

(* A reach in units of which the margin of its slabs is 2^-17: SLAB_FLOOR is 2^-17 of 2^-93. *)
Definition share_of (reach : R) : R := reach + / IZR (2 ^ 93).
Definition margin_of (reach : R) : R := 127 * u * share_of reach.

Lemma share_value (reach : R) : 0 <= reach -> 8589934592 * tiny <= share_of reach.
Proof.
  intro H. unfold share_of, tiny. change (2 ^ 126)%Z with (8589934592 * 2 ^ 93)%Z.
  rewrite mult_IZR, Rinv_mult. assert (0 < / IZR (2 ^ 93)) by
    (apply Rinv_0_lt_compat; now apply IZR_lt). lra.
Qed.

Definition unit_of (w : point) : point := scaled (/ norm w) w.

Lemma unit_along (w d : point) : 0 < norm w -> dot d (unit_of w) <= norm d.
Proof.
  intro H. pose proof (dot_norms d (unit_of w)) as D. pose proof (Rle_abs (dot d (unit_of w))).
  unfold unit_of in *. rewrite norm_scaled in D by (apply Rlt_le, Rinv_0_lt_compat, H).
  rewrite Rinv_l, Rmult_1_r in D by lra. lra.
Qed.

Lemma unit_dot (w : point) : 0 < norm w -> dot w (unit_of w) = norm w.
Proof.
  intro H. transitivity (/ norm w * square w).
  - unfold dot, unit_of, scaled, square, pt. cbn [px py pz]. ring.
  - rewrite <- norm_square. field. lra.
Qed.

Lemma opposite_dot (d w : point) : dot (opposite d) w = - dot d w.
Proof. unfold dot, opposite, pt. cbn [px py pz]. ring. Qed.

(* One support, along a computed direction: of a margin of 127u, 81u are left. *)
Lemma one_side (m : mode) (k : kind) (s : slabs) (signs : bool * bool * bool) (w z : point)
    (reach : R) :
  valid m -> signs_of signs w -> 0 <= reach -> holds_with (margin_of reach) k s z ->
  norm z <= 1.7321 * reach -> 0.4 <= norm w ->
  0 <= support_of m k s signs w /\
  dot w z + 81 * (u * (share_of reach * norm w)) <= support_of m k s signs w.
Proof.
  intros Hm Sw Hr H Hz Hw. pose proof tiny_value as T0. pose proof tiny_small as T1.
  pose proof (share_value reach Hr) as Share.
  set (r := share_of reach) in *.
  assert (Rr : reach <= r).
  { unfold r, share_of. assert (0 < / IZR (2 ^ 93)) by
      (apply Rinv_0_lt_compat; now apply IZR_lt). lra. }
  set (z' := plus z (scaled (margin_of reach) (unit_of w))).
  assert (M0 : 0 <= margin_of reach) by (unfold margin_of; fold r; unfold u; lra).
  assert (Inside : holds_with 0 k s z').
  { intros d Hd. destruct (H d Hd) as (A & B & C & D).
    pose proof (unit_along w (direction d) ltac:(lra)) as L.
    pose proof (unit_along w (opposite (direction d)) ltac:(lra)) as L'.
    rewrite opposite_dot, norm_opposite in L'.
    assert (E : dot (direction d) z'
      = dot (direction d) z + margin_of reach * dot (direction d) (unit_of w))
      by (unfold z', dot, plus, scaled, pt; cbn [px py pz]; ring).
    apply (Rmult_le_compat_l (margin_of reach)) in L, L'; [| exact M0 | exact M0].
    rewrite E. repeat split; lra. }
  destruct (support_rounded m k s signs w z' Hm Sw Inside) as (P & e' & Ne & Le).
  split; [exact P |]. apply Rle_trans with (2 := Le). clear Le P.
  pose proof (coordinates_sum w) as Sum. pose proof (coordinates_sum z') as Far.
  set (sum := Rabs (px w) + Rabs (py w) + Rabs (pz w)) in *.
  set (far := Rabs (px z') + Rabs (py z') + Rabs (pz z')) in *.
  assert (Nz : norm z' <= 1.7322 * r).
  { unfold z'. apply Rle_trans with (1 := triangle _ _).
    rewrite norm_scaled by exact M0.
    assert (N1 : norm (unit_of w) = 1).
    { unfold unit_of. rewrite norm_scaled by (apply Rlt_le, Rinv_0_lt_compat; lra).
      apply Rinv_l. lra. }
    rewrite N1. unfold margin_of. fold r. unfold u. lra. }
  pose proof (norm_nonneg z') as Pz. pose proof (norm_nonneg w) as Pw.
  pose proof (norm_nonneg (minus e' w)) as Pe.
  pose proof (dot_change z' e' w) as Change. rewrite !(dot_swap z') in Change.
  assert (Exact : dot w z' = dot w z + margin_of reach * norm w).
  { rewrite <- (unit_dot w) by lra.
    unfold z', dot, plus, scaled, pt; cbn [px py pz]; ring. }
  unfold turn_error, lost in *.
  set (n := norm w) in *. set (N := norm (minus e' w)) in *. set (Z := norm z') in *.
  assert (R0 : 0 < r) by lra.
  assert (Tn : tiny * n <= / 500 * (u * r) * n) by (apply Rmult_le_compat_r; unfold u; lra).
  assert (Tr : tiny * r <= / 1000000000000000000000000000000 * r) by (apply Rmult_le_compat_r; lra).
  assert (Rn : 0.4 * r <= n * r) by (apply Rmult_le_compat_r; lra).
  set (rn := r * n) in *.
  assert (NN : N <= 21.01 * (u * n)) by (unfold u in *; lra).
  assert (Ce : Z * N <= 36.4 * (u * rn)).
  { apply Rle_trans with (1.7322 * r * (21.01 * (u * n))); [apply Rmult_le_compat; lra |].
    unfold rn. assert (0 <= u * (r * n)) by (unfold u; nra). lra. }
  assert (We : Rabs (dot w z') <= 1.7322 * rn).
  { apply Rle_trans with (1 := dot_norms w z'). fold n Z. unfold rn.
    apply Rle_trans with (n * (1.7322 * r)); [apply Rmult_le_compat_l; lra | lra]. }
  assert (Far' : tiny * far <= 1.74 * (1.7322 * (tiny * r))).
  { apply Rle_trans with (tiny * (1.74 * (1.7322 * r))); [apply Rmult_le_compat_l; lra | lra]. }
  assert (Sum' : tiny * sum <= 1.74 * (tiny * n)).
  { apply Rle_trans with (tiny * (1.74 * n)); [apply Rmult_le_compat_l; lra | lra]. }
  assert (One : tiny <= 2.5 * (tiny * n)).
  { assert (tiny * 0.4 <= tiny * n) by (apply Rmult_le_compat_l; lra). lra. }
  unfold margin_of in Exact. fold r in Exact.
  replace (127 * u * r * n) with (127 * (u * rn)) in Exact by (unfold rn; ring).
  replace (/ 500 * (u * r) * n) with (/ 500 * (u * rn)) in Tn by (unfold rn; ring).
  replace (n * r) with rn in Rn by (unfold rn; ring).
  apply Rabs_le_inv in Change, We. rewrite Exact in We, Change.
  replace (tiny * (8 * sum + 10 * far + 40)) with (8 * (tiny * sum) + 10 * (tiny * far) + 40 * tiny)
    by ring.
  set (ts := tiny * sum) in *. set (tf := tiny * far) in *. set (tn := tiny * n) in *.
  set (tr := tiny * r) in *. set (ZN := Z * N) in *. set (d' := dot e' z') in *.
  set (d := dot w z) in *.
  clear - Change We Ce Far' Sum' One Tn Tr Rn. unfold u in *. lra.
Qed.

(* Three orthonormal axes of space are a basis: coordinates along them give the vector again, and
   keep the norm. *)
Lemma combined_apply (q : matrix) (w : point) : orthonormal q -> combined q (apply q w) = w.
Proof.
  destruct q as [[a b c] [d e f] [g h i]], w as [x y z].
  unfold orthonormal, dot. cbn [row0 row1 row2 px py pz]. intros (U0 & U1 & U2 & V0 & V1 & V2).
  set (det := a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)).
  assert (D : det * det = 1).
  { transitivity ((a * a + b * b + c * c) * ((d * d + e * e + f * f) * (g * g + h * h + i * i)
      - (d * g + e * h + f * i) * (d * g + e * h + f * i))
      - (a * d + b * e + c * f) * ((a * d + b * e + c * f) * (g * g + h * h + i * i)
      - (d * g + e * h + f * i) * (a * g + b * h + c * i))
      + (a * g + b * h + c * i) * ((a * d + b * e + c * f) * (d * g + e * h + f * i)
      - (d * d + e * e + f * f) * (a * g + b * h + c * i))); [unfold det; ring |].
    rewrite U0, U1, U2, V0, V1, V2. ring. }
  set (p := a * x + b * y + c * z). set (q := d * x + e * y + f * z).
  set (r := g * x + h * y + i * z).
  assert (N : det <> 0) by (intro E; rewrite E in D; lra).
  unfold combined, apply, dot, pt. cbn [row0 row1 row2 px py pz]. fold p q r.
  (* The rest of w is orthogonal to all three axes. *)
  set (s := p * a + q * d + r * g - x). set (t := p * b + q * e + r * h - y).
  set (v := p * c + q * f + r * i - z).
  assert (E0 : a * s + b * t + c * v = 0).
  { transitivity (p * (a * a + b * b + c * c) + q * (a * d + b * e + c * f)
      + r * (a * g + b * h + c * i) - p); [unfold s, t, v, p; ring |].
    rewrite U0, V0, V1. ring. }
  assert (E1 : d * s + e * t + f * v = 0).
  { transitivity (p * (a * d + b * e + c * f) + q * (d * d + e * e + f * f)
      + r * (d * g + e * h + f * i) - q); [unfold s, t, v, q; ring |].
    rewrite U1, V0, V2. ring. }
  assert (E2 : g * s + h * t + i * v = 0).
  { transitivity (p * (a * g + b * h + c * i) + q * (d * g + e * h + f * i)
      + r * (g * g + h * h + i * i) - r); [unfold s, t, v, r; ring |].
    rewrite U2, V1, V2. ring. }
  assert (Cramer : s = 0 /\ t = 0 /\ v = 0).
  { repeat split; apply Rmult_eq_reg_l with det; try exact N; rewrite Rmult_0_r.
    - transitivity ((e * i - f * h) * (a * s + b * t + c * v)
        - (b * i - c * h) * (d * s + e * t + f * v) + (b * f - c * e) * (g * s + h * t + i * v));
        [unfold det; ring | rewrite E0, E1, E2; ring].
    - transitivity ((f * g - d * i) * (a * s + b * t + c * v)
        + (a * i - c * g) * (d * s + e * t + f * v) - (a * f - c * d) * (g * s + h * t + i * v));
        [unfold det; ring | rewrite E0, E1, E2; ring].
    - transitivity ((d * h - e * g) * (a * s + b * t + c * v)
        - (a * h - b * g) * (d * s + e * t + f * v) + (a * e - b * d) * (g * s + h * t + i * v));
        [unfold det; ring | rewrite E0, E1, E2; ring]. }
  destruct Cramer as (S & T & V). f_equal; unfold s, t, v in *; lra.
Qed.

Lemma apply_keeps_norm (q : matrix) (w : point) : orthonormal q -> norm (apply q w) = norm w.
Proof. intro O. now rewrite <- (norm_combined q _ O), combined_apply. Qed.

(* The two bodies along one axis. Points y and z of the two, about their slabs' centres and along
   their axes, coincide if Q_A y = gap + Q_B z. *)
Section Axis.
Variable m : mode.
Hypothesis Hm : valid m.
Variables qa qb : matrix.
Hypothesis Oa : orthonormal qa.
Hypothesis Ob : orthonormal qb.
Variables gap y z : point.
Hypothesis Meet : combined qa y = plus gap (combined qb z).
Variables ra rb : R.
Hypothesis Ra : 0 <= ra.
Hypothesis Rb : 0 <= rb.
Hypothesis Ny : norm y <= 1.7321 * ra.
Hypothesis Nz : norm z <= 1.7321 * rb.
Let both : R := share_of ra + share_of rb.

Lemma share_above (reach : R) : reach <= share_of reach.
Proof.
  unfold share_of. assert (0 < / IZR (2 ^ 93)) by (apply Rinv_0_lt_compat; now apply IZR_lt). lra.
Qed.

Lemma gap_size : norm gap <= 1.7321 * both.
Proof.
  assert (E : gap = minus (combined qa y) (combined qb z)).
  { rewrite Meet. destruct gap as [a b c]. unfold plus, minus. cbn [px py pz]. f_equal; ring. }
  rewrite E. pose proof (norm_difference (minus (combined qa y) (combined qb z))
    (combined qa y)) as T.
  replace (minus (minus (combined qa y) (combined qb z)) (combined qa y))
    with (opposite (combined qb z)) in T
    by (unfold opposite, minus, pt; cbn [px py pz]; f_equal; ring).
  rewrite norm_opposite, !norm_combined in T by assumption.
  pose proof (share_above ra). pose proof (share_above rb). unfold both. lra.
Qed.

(* Where an axis a, the gap along A's axes, the projection tau of it, the direction w along B's axes
   and the two supports are computed well enough, points that coincide are not separated. *)
Theorem not_separated (a gap32 w : point) (tau s ha hb : R) :
  0.49 <= norm a -> s = 1 \/ s = -1 -> Rabs tau = s * tau ->
  norm (minus gap32 (apply qa gap)) <= 22 * (u * both) ->
  Rabs (tau - dot a gap32)
    <= 3.01 * u * (norm a * norm gap32) + tiny * (2 * (norm a + norm gap32) + 12) ->
  norm (minus w (scaled (- s) (apply qb (combined qa a)))) <= 22.6 * (u * norm a) ->
  0 <= ha -> s * dot a y + 81 * (u * (share_of ra * norm a)) <= ha ->
  0 <= hb -> dot w z + 81 * (u * (share_of rb * norm w)) <= hb ->
  greater m (Rabs tau) (add m ha hb) = false.
Proof.
  intros Na Hs Ht Ng Et Nw Pa Ha Pb Hb. pose proof tiny_value as T0. pose proof tiny_small as T1.
  pose proof (share_value ra Ra) as Sa. pose proof (share_value rb Rb) as Sb.
  pose proof (share_above ra) as Aa. pose proof (share_above rb) as Ab.
  pose proof gap_size as Gap. unfold both in *.
  set (A := share_of ra) in *. set (B := share_of rb) in *. set (n := norm a) in *.
  set (e := apply qb (combined qa a)) in *.
  assert (Ne : norm e = n) by (unfold e; rewrite apply_keeps_norm, norm_combined; trivial).
  (* The projection. *)
  pose proof (apply_keeps_norm qa gap Oa) as Kg.
  pose proof (norm_difference gap32 (apply qa gap)) as Dg. rewrite Kg in Dg.
  pose proof (dot_change a gap32 (apply qa gap)) as Cg. fold n in Cg.
  assert (G32 : norm gap32 <= 1.7322 * (A + B)) by (unfold u in *; lra).
  pose proof (norm_nonneg gap32) as G0.
  set (U := u * (n * (A + B))).
  assert (Pn : 0 <= n * (A + B)) by (apply Rmult_le_pos; lra).
  assert (Tn : tiny * n <= / 1000 * U).
  { unfold U. replace (/ 1000 * (u * (n * (A + B)))) with (/ 1000 * (u * (A + B)) * n) by ring.
    apply Rmult_le_compat_r; unfold u; lra. }
  assert (One : tiny <= 2.1 * (tiny * n)).
  { assert (tiny * 0.49 <= tiny * n) by (apply Rmult_le_compat_l; lra). lra. }
  assert (Tg : tiny * norm gap32 <= / 1000 * U).
  { apply Rle_trans with (/ 1000000000000000000000000000000 * (1.7322 * (A + B))).
    - apply Rmult_le_compat; lra.
    - assert (0.49 * (A + B) <= n * (A + B)) by (apply Rmult_le_compat_r; lra).
      unfold U, u. lra. }
  assert (E1 : 3.01 * u * (n * norm gap32) <= 5.23 * U).
  { assert (n * norm gap32 <= n * (1.7322 * (A + B))) by (apply Rmult_le_compat_l; lra).
    unfold U, u. lra. }
  assert (E2 : n * norm (minus gap32 (apply qa gap)) <= 22 * U).
  { apply Rle_trans with (n * (22 * (u * (A + B)))); [apply Rmult_le_compat_l; lra |].
    unfold U. lra. }
  replace (tiny * (2 * (n + norm gap32) + 12))
    with (2 * (tiny * n) + 2 * (tiny * norm gap32) + 12 * tiny) in Et by ring.
  assert (Tau : Rabs (tau - dot a (apply qa gap)) <= 27.4 * U).
  { replace (tau - dot a (apply qa gap))
      with ((tau - dot a gap32) + (dot a gap32 - dot a (apply qa gap))) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). lra. }
  (* The exact projection of points that coincide. *)
  assert (Proj : dot a (apply qa gap) = dot a y - dot e z).
  { rewrite <- (apply_combined qa y Oa) at 1. rewrite Meet. rewrite <- !combined_dot.
    unfold e. replace (dot (apply qb (combined qa a)) z)
      with (dot (combined qa a) (combined qb z)).
    - unfold dot, plus. cbn [px py pz]. ring.
    - unfold dot, apply, combined, dot, pt. cbn [px py pz]. ring. }
  (* B's side. *)
  pose proof (dot_change z w (scaled (- s) e)) as Cw. rewrite !(dot_swap z) in Cw.
  assert (Es : dot (scaled (- s) e) z = - s * dot e z)
    by (unfold dot, scaled, pt; cbn [px py pz]; ring).
  assert (Nse : norm (scaled (- s) e) = n).
  { rewrite <- Ne. destruct Hs as [-> | ->]; unfold norm, square, scaled, pt; cbn [px py pz];
      f_equal; ring. }
  pose proof (norm_difference (scaled (- s) e) w) as Dw.
  replace (norm (minus (scaled (- s) e) w)) with (norm (minus w (scaled (- s) e))) in Dw
    by (unfold norm, square, minus; cbn [px py pz]; f_equal; ring).
  rewrite Nse in Dw. rewrite Es in Cw.
  set (Ub := u * (n * B)). set (Ua := u * (n * A)).
  assert (Split : U = Ua + Ub) by (unfold U, Ua, Ub; ring).
  assert (Pu : 0 <= Ua /\ 0 <= Ub) by (unfold Ua, Ub, u; split; repeat apply Rmult_le_pos; lra).
  assert (E3 : norm z * norm (minus w (scaled (- s) e)) <= 39.2 * Ub).
  { apply Rle_trans with (1.7321 * B * (22.6 * (u * n))).
    - apply Rmult_le_compat; try apply norm_nonneg; lra.
    - unfold Ub. assert (0 <= u * (n * B)) by apply Pu. lra. }
  assert (E4 : 80.9 * Ub <= 81 * (u * (B * norm w))).
  { assert (B * (n * (1 - 22.6 * u)) <= B * norm w) by (apply Rmult_le_compat_l; lra).
    assert (0 <= n * B) by (apply Rmult_le_pos; lra).
    unfold Ub, u in *. lra. }
  replace (81 * (u * (A * n))) with (81 * Ua) in Ha by (unfold Ua; ring).
  (* The sum and the comparison. *)
  assert (X : Rabs (s * (dot a y - dot e z)) <= 1.7321 * (n * (A + B))).
  { rewrite Rabs_mult. replace (Rabs s) with 1
      by (destruct Hs as [-> | ->]; [now rewrite Rabs_R1 | rewrite Rabs_left; lra]).
    rewrite Rmult_1_l. rewrite <- Proj. apply Rle_trans with (1 := dot_norms a (apply qa gap)).
    rewrite Kg. fold n. replace (1.7321 * (n * (A + B))) with (n * (1.7321 * (A + B))) by ring.
    apply Rmult_le_compat_l; lra. }
  apply Rlt_bool_false.
  pose proof (read_nonneg m _ (Rabs_pos tau)) as Rt.
  pose proof (add_nonneg m ha hb Pa Pb) as Rs. pose proof (read_error m (add m ha hb)) as Re.
  apply Rabs_le_inv in Re.
  assert (Sum : (ha + hb) * (1 - u) - 3 * tiny <= add m ha hb).
  { unfold add. pose proof (read_nonneg m ha Pa). pose proof (read_nonneg m hb Pb).
    pose proof (read_error m ha) as F1. pose proof (read_error m hb) as F2.
    apply Rabs_le_inv in F1, F2.
    pose proof (fl_below m Hm (read m ha + read m hb) ltac:(lra)). unfold u in *. lra. }
  apply Rabs_le_inv in Tau, Cw, X. rewrite Proj in Tau.
  set (exact := dot a y - dot e z) in *.
  assert (St : s * tau <= s * exact + 27.4 * U) by (destruct Hs as [-> | ->]; lra).
  assert (Low : s * exact + 41 * U <= ha + hb).
  { unfold exact. rewrite Split. lra. }
  assert (Small : u * (s * exact + 41 * U) <= 1.74 * U).
  { assert (H : s * exact + 41 * U <= 1.74 * (n * (A + B))).
    { unfold U. assert (0 <= n * (A + B)) by (apply Rmult_le_pos; lra). unfold u. lra. }
    apply (Rmult_le_compat_l u) in H; [| unfold u; lra]. unfold U at 2. lra. }
  apply (Rmult_le_compat_r (1 - u)) in Low; [| unfold u; lra].
  clear - Rt Rs Re Sum St Low Small Ht One Tn T0 Pu Split. lra.
Qed.
End Axis.
