(* Poses: the point R(q) x + t as f64 arithmetic finds it, and how far it is from the exact one. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double.
Open Scope R_scope.

Record quaternion := { qx : R; qy : R; qz : R; qw : R }.
Record matrix := { row0 : point; row1 : point; row2 : point }.

Definition pt (a b c : R) : point := {| px := a; py := b; pz := c |}.
Definition dot (a b : point) : R := px a * px b + py a * py b + pz a * pz b.
Definition apply (a : matrix) (p : point) : point :=
  pt (dot (row0 a) p) (dot (row1 a) p) (dot (row2 a) p).

(* The exact rotation of a quaternion of any norm. *)
Definition norm_of (q : quaternion) : R :=
  qx q * qx q + qy q * qy q + qz q * qz q + qw q * qw q.
Definition exact_rotation (q : quaternion) : matrix :=
  let '(x, y, z, w) := (qx q, qy q, qz q, qw q) in
  let n := norm_of q in
  {| row0 := pt (((x * x - y * y) + (w * w - z * z)) / n) (2 * (x * y + - (w * z)) / n)
                (2 * (x * z + w * y) / n);
     row1 := pt (2 * (x * y + w * z) / n) (((y * y - x * x) + (w * w - z * z)) / n)
                (2 * (y * z + - (w * x)) / n);
     row2 := pt (2 * (x * z + - (w * y)) / n) (2 * (y * z + w * x) / n)
                (((z * z - x * x) + (w * w - y * y)) / n) |}.

Section Code.
Variable m : mode64.

(* src/rounding/pose.rs: twice *)
Definition twice (a b over : R) : R := mul64 m (mul64 m 2 (add64 m a b)) over.

(* src/rounding/pose.rs: rotation_of *)
Definition diagonal (a b c d over : R) : R :=
  mul64 m (add64 m (sub64 m a b) (sub64 m c d)) over.
Definition rotation_of (q : quaternion) : matrix :=
  let '(x, y, z, w) := (qx q, qy q, qz q, qw q) in
  let '(xx, yy, zz, ww) := (mul64 m x x, mul64 m y y, mul64 m z z, mul64 m w w) in
  let over := div64 m 1 (add64 m (add64 m (add64 m xx yy) zz) ww) in
  {| row0 := pt (diagonal xx yy ww zz over) (twice (mul64 m x y) (- mul64 m w z) over)
                (twice (mul64 m x z) (mul64 m w y) over);
     row1 := pt (twice (mul64 m x y) (mul64 m w z) over) (diagonal yy xx ww zz over)
                (twice (mul64 m y z) (- mul64 m w x) over);
     row2 := pt (twice (mul64 m x z) (- mul64 m w y) over) (twice (mul64 m y z) (mul64 m w x) over)
                (diagonal zz xx ww yy over) |}.

(* src/rounding/pose.rs: rotate_of, one row *)
Definition rotate_row (a p : point) : R :=
  add64 m (add64 m (mul64 m (px a) (px p)) (mul64 m (py a) (py p))) (mul64 m (pz a) (pz p)).

(* src/rounding/pose.rs: transform *)
Definition transform (a : matrix) (p t : point) : point :=
  pt (add64 m (rotate_row (row0 a) p) (px t)) (add64 m (rotate_row (row1 a) p) (py t))
     (add64 m (rotate_row (row2 a) p) (pz t)).
End Code.

(* Numbers of the contract: |q|^2 of a quaternion of f32 that isn't zero. *)
Definition least_norm : R := / IZR (2 ^ 298).
Definition greatest_norm : R := IZR (2 ^ 258).
Definition sound_quaternion (q : quaternion) : Prop := least_norm <= norm_of q <= greatest_norm.

(* dust is a small share of any such |q|^2, and |q|^2 no more than a small share of 1 / dust. *)
Lemma dust_share (n : R) :
  least_norm <= n -> dust <= n * / IZR (2 ^ 400).
Proof.
  intro H. apply Rle_trans with (least_norm * / IZR (2 ^ 400)).
  - unfold dust, least_norm. rewrite <- Rinv_mult. rewrite <- mult_IZR.
    apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le].
  - apply Rmult_le_compat_r; [| exact H]. apply Rlt_le, Rinv_0_lt_compat. now apply IZR_lt.
Qed.

Lemma dust_times (n : R) : n <= greatest_norm -> dust * n <= / IZR (2 ^ 400).
Proof.
  intro H. apply Rle_trans with (dust * greatest_norm).
  - apply Rmult_le_compat_l; [apply Rlt_le, dust_value | exact H].
  - unfold dust, greatest_norm. apply Rmult_le_reg_l with (IZR (2 ^ 700)); [now apply IZR_lt |].
    rewrite <- Rmult_assoc, Rinv_r, Rmult_1_l by now apply IZR_neq.
    change (2 ^ 700)%Z with (2 ^ 300 * 2 ^ 400)%Z. rewrite mult_IZR, Rmult_assoc, Rinv_r, Rmult_1_r
      by now apply IZR_neq.
    now apply IZR_le.
Qed.

Lemma small_share : 0 < / IZR (2 ^ 400) <= v / 1000000.
Proof.
  split; [apply Rinv_0_lt_compat; now apply IZR_lt |].
  unfold v, Rdiv. rewrite <- Rinv_mult, <- mult_IZR.
  apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le].
Qed.

Section Errors.
Variable m : mode64.
Hypothesis Hm : valid64 m.

(* A numerator and the denominator within their errors give an entry within its own. *)
Lemma entry_error (A n num den : R) :
  least_norm <= n <= greatest_norm -> Rabs A <= n ->
  Rabs (num - A) <= 3.01 * v * n -> Rabs (den - n) <= 4.01 * v * n ->
  Rabs (mul64 m num (div64 m 1 den) - A / n) <= 9.1 * v.
Proof.
  intros [Hlow Hhigh] HA Hnum Hden.
  pose proof (dust_share n Hlow) as D1. pose proof (dust_times n Hhigh) as D2.
  pose proof small_share as [S0 S1]. pose proof dust_value as D0. pose proof v_value as V.
  pose proof tiny64_dust as T. pose proof tiny64_value as [T0 _].
  assert (L0 : 0 < least_norm) by (unfold least_norm; apply Rinv_0_lt_compat; now apply IZR_lt).
  assert (Hn : 0 < n) by lra.
  assert (Hvn : 0 <= v * n) by (apply Rmult_le_pos; lra).
  assert (Hden' : (1 - 4.01 * v) * n <= den <= (1 + 4.01 * v) * n)
    by (apply Rabs_le_inv in Hden; lra).
  assert (Hdn : n / 2 <= den) by (unfold v in *; lra).
  assert (Ht : tiny64 <= den).
  { assert (n * / IZR (2 ^ 400) <= n * (v / 1000000)) by (apply Rmult_le_compat_l; lra).
    unfold v in *. lra. }
  pose proof (inverse64_error m Hm den Ht) as Ho.
  set (o := div64 m 1 den) in *.
  (* k is n / den *)
  set (k := n * / den).
  assert (Hk : den * k = n) by (unfold k; field; lra).
  assert (K1 : 1 - 4.02 * v <= k <= 1 + 4.02 * v).
  { split.
    - apply Rmult_le_reg_l with den; [lra |]. rewrite Hk.
      apply Rle_trans with ((1 + 4.01 * v) * n * (1 - 4.02 * v)).
      + apply Rmult_le_compat_r; [unfold v; lra | lra].
      + replace ((1 + 4.01 * v) * n * (1 - 4.02 * v))
          with (n * ((1 + 4.01 * v) * (1 - 4.02 * v))) by ring.
        rewrite <- (Rmult_1_r n) at 2. apply Rmult_le_compat_l; [lra |]. unfold v. lra.
    - apply Rmult_le_reg_l with den; [lra |]. rewrite Hk.
      apply Rle_trans with ((1 - 4.01 * v) * n * (1 + 4.02 * v)).
      + replace ((1 - 4.01 * v) * n * (1 + 4.02 * v))
          with (n * ((1 - 4.01 * v) * (1 + 4.02 * v))) by ring.
        rewrite <- (Rmult_1_r n) at 1. apply Rmult_le_compat_l; [lra |]. unfold v. lra.
      + apply Rmult_le_compat_r; [unfold v; lra | lra]. }
  assert (G : Rabs (o * n - 1) <= 5.03 * v).
  { assert (Gk : Rabs (o * n - k) <= v * k + dust * n).
    { replace (o * n - k) with ((o - / den) * n) by (unfold k; ring).
      rewrite Rabs_mult, (Rabs_pos_eq n) by lra.
      replace (v * k + dust * n) with ((v * / den + dust) * n) by (unfold k; ring).
      apply Rmult_le_compat_r; lra. }
    apply Rabs_le_inv in Gk. apply Rabs_le. unfold v in *. lra. }
  (* h is num / n, and num * o = h * (o * n) *)
  set (g := o * n) in *. set (h := num / n). set (B := A / n).
  assert (HB : Rabs B <= 1).
  { unfold B, Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ n)) by (apply Rlt_le, Rinv_0_lt_compat; lra).
    apply Rmult_le_reg_r with n; [lra |]. rewrite Rmult_assoc, Rinv_l; lra. }
  assert (Hh : Rabs (h - B) <= 3.01 * v).
  { replace (h - B) with ((num - A) * / n) by (unfold h, B; field; lra).
    rewrite Rabs_mult, (Rabs_pos_eq (/ n)) by (apply Rlt_le, Rinv_0_lt_compat; lra).
    apply Rmult_le_reg_r with n; [lra |]. rewrite Rmult_assoc, Rinv_l; lra. }
  assert (P : Rabs (num * o - B) <= 8.05 * v).
  { replace (num * o) with (h * g) by (unfold h, g; field; lra).
    replace (h * g - B) with ((h - B) * g + B * (g - 1)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult.
    assert (Rabs g <= 1 + 5.03 * v).
    { replace g with (1 + (g - 1)) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
      rewrite Rabs_R1. lra. }
    pose proof (Rabs_pos (h - B)). pose proof (Rabs_pos g). pose proof (Rabs_pos B).
    pose proof (Rabs_pos (g - 1)).
    assert (Rabs (h - B) * Rabs g <= 3.01 * v * (1 + 5.03 * v)) by (apply Rmult_le_compat; lra).
    assert (Rabs B * Rabs (g - 1) <= 1 * (5.03 * v)) by (apply Rmult_le_compat; lra).
    unfold v in *. lra. }
  assert (Bnum : Rabs num <= big).
  { replace num with (A + (num - A)) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
    apply Rle_trans with (2 * greatest_norm); [unfold v in *; lra |].
    unfold greatest_norm, big. rewrite <- mult_IZR. now apply IZR_le. }
  assert (Bo : Rabs o <= big).
  { assert (Hi : Rabs o * n <= 2).
    { rewrite <- (Rabs_pos_eq n) by lra. rewrite <- Rabs_mult. fold g.
      replace g with (1 + (g - 1)) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
      rewrite Rabs_R1. unfold v in *. lra. }
    apply Rmult_le_reg_r with least_norm; [lra |].
    apply Rle_trans with (Rabs o * n); [apply Rmult_le_compat_l; [apply Rabs_pos | lra] |].
    apply Rle_trans with (1 := Hi). unfold big, least_norm.
    change (2 ^ 300)%Z with (4 * 2 ^ 298)%Z. rewrite mult_IZR, Rmult_assoc, Rinv_r; [lra |].
    now apply IZR_neq. }
  pose proof (mul64_near m Hm num o B (8.05 * v) Bnum Bo P) as R.
  assert (dust <= v / 1000).
  { unfold dust, v, Rdiv. rewrite <- Rinv_mult, <- mult_IZR.
    apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
  assert (v * Rabs B <= v * 1) by (apply Rmult_le_compat_l; lra).
  unfold v in *. lra.
Qed.

(* The four squares and the six products of a quaternion's components. *)
Variable q : quaternion.
Hypothesis Hq : sound_quaternion q.
Let n := norm_of q.

Lemma square_shares :
  0 <= qx q * qx q /\ 0 <= qy q * qy q /\ 0 <= qz q * qz q /\ 0 <= qw q * qw q.
Proof. repeat split; apply Rle_0_sqr. Qed.

Lemma component_big (c : R) : c * c <= n -> Rabs c <= big.
Proof.
  intro H. assert (Hb : 0 <= big) by (pose proof big_value; lra).
  rewrite <- (Rabs_pos_eq big) by exact Hb. apply Rsqr_le_abs_0. unfold Rsqr.
  apply Rle_trans with (1 := H). apply Rle_trans with greatest_norm; [apply Hq |].
  unfold greatest_norm, big. rewrite <- mult_IZR. now apply IZR_le.
Qed.

Lemma components_big :
  Rabs (qx q) <= big /\ Rabs (qy q) <= big /\ Rabs (qz q) <= big /\ Rabs (qw q) <= big.
Proof.
  pose proof square_shares. unfold n, norm_of in *.
  repeat split; apply component_big; unfold n, norm_of; lra.
Qed.

Lemma dust_small : 0 < dust <= v / 1000000 * n.
Proof.
  split; [apply dust_value |]. destruct Hq as [Hlow _].
  assert (L0 : 0 < least_norm) by (unfold least_norm; apply Rinv_0_lt_compat; now apply IZR_lt).
  apply Rle_trans with (1 := dust_share n Hlow). rewrite Rmult_comm.
  apply Rmult_le_compat_r; [fold n in Hlow; lra | apply small_share].
Qed.

Lemma denominator_error :
  let '(x, y, z, w) := (qx q, qy q, qz q, qw q) in
  Rabs (add64 m (add64 m (add64 m (mul64 m x x) (mul64 m y y)) (mul64 m z z)) (mul64 m w w) - n)
    <= 4.01 * v * n.
Proof.
  destruct components_big as (Bx & By & Bz & Bw). destruct square_shares as (Px & Py & Pz & Pw).
  pose proof dust_small as D. pose proof v_value as V.
  pose proof (mul64_error m Hm _ _ Bx Bx) as Ex. pose proof (mul64_error m Hm _ _ By By) as Ey.
  pose proof (mul64_error m Hm _ _ Bz Bz) as Ez. pose proof (mul64_error m Hm _ _ Bw Bw) as Ew.
  pose proof (add64_near m Hm _ _ _ _ _ _ Ex Ey) as E1.
  pose proof (add64_near m Hm _ _ _ _ _ _ E1 Ez) as E2.
  pose proof (add64_near m Hm _ _ _ _ _ _ E2 Ew) as E3.
  clear E1 E2 Ex Ey Ez Ew. unfold n, norm_of in *.
  set (X := qx q * qx q) in *. set (Y := qy q * qy q) in *.
  set (Z := qz q * qz q) in *. set (W := qw q * qw q) in *.
  rewrite (Rabs_pos_eq X), (Rabs_pos_eq Y), (Rabs_pos_eq Z), (Rabs_pos_eq W),
    (Rabs_pos_eq (X + Y)), (Rabs_pos_eq (X + Y + Z)), (Rabs_pos_eq (X + Y + Z + W)) in E3 by lra.
  apply Rle_trans with (1 := E3). unfold v in *. lra.
Qed.

(* Of two squares A and B of components, or the half sums of squares that bound products. *)
Lemma diagonal_error (a b c d : R) :
  Rabs a <= big -> Rabs b <= big -> Rabs c <= big -> Rabs d <= big ->
  a * a + b * b + c * c + d * d = n ->
  let A := (a * a - b * b) + (c * c - d * d) in
  Rabs A <= n /\
  Rabs (add64 m (sub64 m (mul64 m a a) (mul64 m b b)) (sub64 m (mul64 m c c) (mul64 m d d)) - A)
    <= 3.01 * v * n.
Proof.
  intros Ba Bb Bc Bd Hn A. pose proof dust_small as D. pose proof v_value as V.
  pose proof (Rle_0_sqr a) as Pa. pose proof (Rle_0_sqr b) as Pb.
  pose proof (Rle_0_sqr c) as Pc. pose proof (Rle_0_sqr d) as Pd. unfold Rsqr in *.
  assert (HA : Rabs A <= n) by (apply Rabs_le; unfold A; lra). split; [exact HA |].
  pose proof (mul64_error m Hm _ _ Ba Ba) as Ea. pose proof (mul64_error m Hm _ _ Bb Bb) as Eb.
  pose proof (mul64_error m Hm _ _ Bc Bc) as Ec. pose proof (mul64_error m Hm _ _ Bd Bd) as Ed.
  pose proof (sub64_near m Hm _ _ _ _ _ _ Ea Eb) as E1.
  pose proof (sub64_near m Hm _ _ _ _ _ _ Ec Ed) as E2.
  pose proof (add64_near m Hm _ _ _ _ _ _ E1 E2) as E3. fold A in E3.
  clear E1 E2 Ea Eb Ec Ed.
  assert (H1 : Rabs (a * a - b * b) <= a * a + b * b) by (apply Rabs_le; lra).
  assert (H2 : Rabs (c * c - d * d) <= c * c + d * d) by (apply Rabs_le; lra).
  rewrite (Rabs_pos_eq (a * a)), (Rabs_pos_eq (b * b)), (Rabs_pos_eq (c * c)),
    (Rabs_pos_eq (d * d)) in E3 by assumption.
  apply Rle_trans with (1 := E3).
  assert (v * Rabs A <= v * n) by (apply Rmult_le_compat_l; lra).
  assert (v * Rabs (a * a - b * b) <= v * (a * a + b * b)) by (apply Rmult_le_compat_l; lra).
  assert (v * Rabs (c * c - d * d) <= v * (c * c + d * d)) by (apply Rmult_le_compat_l; lra).
  unfold v in *. lra.
Qed.

Lemma product_share (a b : R) : 2 * Rabs (a * b) <= a * a + b * b.
Proof.
  rewrite Rabs_mult. pose proof (Rle_0_sqr (Rabs a - Rabs b)) as H. unfold Rsqr in H.
  pose proof (Rsqr_abs a) as Ea. pose proof (Rsqr_abs b) as Eb. unfold Rsqr in Ea, Eb.
  rewrite Ea, Eb. lra.
Qed.

Lemma twice_error (a b c d s t : R) :
  a * a + b * b + c * c + d * d = n -> Rabs s = Rabs (a * b) -> Rabs t = Rabs (c * d) ->
  forall s' t', Rabs (s' - s) <= v * Rabs s + dust -> Rabs (t' - t) <= v * Rabs t + dust ->
  Rabs (2 * (s + t)) <= n /\
  Rabs (mul64 m 2 (add64 m s' t') - 2 * (s + t)) <= 3.01 * v * n.
Proof.
  intros Hn Hs Ht s' t' Es Et. pose proof dust_small as D. pose proof v_value as V.
  pose proof (product_share a b) as Pab. pose proof (product_share c d) as Pcd.
  rewrite <- Hs in Pab. rewrite <- Ht in Pcd.
  pose proof (Rabs_triang s t) as Tr.
  assert (H2 : Rabs (2 * (s + t)) <= n).
  { rewrite Rabs_mult, (Rabs_pos_eq 2) by lra. lra. }
  split; [exact H2 |].
  pose proof (add64_near m Hm _ _ _ _ _ _ Es Et) as E1.
  set (f := add64 m s' t') in *.
  rewrite Rabs_mult, (Rabs_pos_eq 2) in H2 by lra.
  assert (F : Rabs (2 * f - 2 * (s + t)) <= 2.001 * v * n).
  { replace (2 * f - 2 * (s + t)) with (2 * (f - (s + t))) by ring.
    rewrite Rabs_mult, (Rabs_pos_eq 2) by lra.
    assert (v * (2 * Rabs (s + t)) <= v * n) by (apply Rmult_le_compat_l; lra).
    assert (v * (2 * Rabs s + 2 * Rabs t) <= v * n) by (apply Rmult_le_compat_l; lra).
    unfold v in *. lra. }
  assert (N : n <= greatest_norm) by apply Hq.
  assert (Bf : Rabs f <= big).
  { replace f with ((s + t) + (f - (s + t))) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
    apply Rle_trans with (2 * greatest_norm).
    - replace (2 * f - 2 * (s + t)) with (2 * (f - (s + t))) in F by ring.
      rewrite Rabs_mult, (Rabs_pos_eq 2) in F by lra. unfold v in *. lra.
    - unfold greatest_norm, big. rewrite <- mult_IZR. now apply IZR_le. }
  assert (B2 : Rabs 2 <= big).
  { rewrite Rabs_pos_eq by lra. unfold big. now apply IZR_le. }
  pose proof (mul64_near m Hm 2 f _ _ B2 Bf F) as E2.
  apply Rle_trans with (1 := E2). rewrite Rabs_mult, (Rabs_pos_eq 2) by lra.
  assert (v * (2 * Rabs (s + t)) <= v * n) by (apply Rmult_le_compat_l; lra).
  unfold v in *. lra.
Qed.

(* A row within 9.1 v of an exact one. *)
Definition row_error (a b : point) : Prop :=
  Rabs (px a - px b) <= 9.1 * v /\ Rabs (py a - py b) <= 9.1 * v /\ Rabs (pz a - pz b) <= 9.1 * v.

Lemma negative_error (a b : R) :
  Rabs a <= big -> Rabs b <= big ->
  Rabs (- mul64 m a b - - (a * b)) <= v * Rabs (- (a * b)) + dust.
Proof.
  intros Ba Bb. replace (- mul64 m a b - - (a * b)) with (- (mul64 m a b - a * b)) by ring.
  rewrite !Rabs_Ropp. now apply mul64_error.
Qed.

Lemma rotation_error :
  row_error (row0 (rotation_of m q)) (row0 (exact_rotation q)) /\
  row_error (row1 (rotation_of m q)) (row1 (exact_rotation q)) /\
  row_error (row2 (rotation_of m q)) (row2 (exact_rotation q)).
Proof.
  destruct components_big as (Bx & By & Bz & Bw).
  pose proof denominator_error as Hden. cbv zeta beta in Hden.
  unfold rotation_of, exact_rotation, row_error, twice, diagonal, pt. cbn [row0 row1 row2 px py pz].
  assert (Diag : forall a b c d, Rabs a <= big -> Rabs b <= big -> Rabs c <= big -> Rabs d <= big ->
    a * a + b * b + c * c + d * d = n -> _)
    by (intros a b c d Ba Bb Bc Bd E; exact (diagonal_error a b c d Ba Bb Bc Bd E)).
  assert (Plus : forall a b c d, Rabs a <= big -> Rabs b <= big -> Rabs c <= big -> Rabs d <= big ->
    a * a + b * b + c * c + d * d = n -> _)
    by (intros a b c d Ba Bb Bc Bd E;
        exact (twice_error a b c d _ _ E eq_refl eq_refl _ _ (mul64_error m Hm a b Ba Bb)
                 (mul64_error m Hm c d Bc Bd))).
  assert (Minus : forall a b c d,
    Rabs a <= big -> Rabs b <= big -> Rabs c <= big -> Rabs d <= big ->
    a * a + b * b + c * c + d * d = n -> _)
    by (intros a b c d Ba Bb Bc Bd E;
        exact (twice_error a b c d _ _ E eq_refl (Rabs_Ropp _) _ _ (mul64_error m Hm a b Ba Bb)
                 (negative_error c d Bc Bd))).
  cbv beta in Diag, Plus, Minus.
  repeat split; (apply entry_error; [exact Hq | | | exact Hden]);
    first [ apply Diag | apply Plus | apply Minus ]; try assumption;
    unfold n, norm_of; ring.
Qed.
End Errors.
