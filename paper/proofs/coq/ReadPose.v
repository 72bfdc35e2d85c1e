(* A quaternion whose components may be read as zero: what that turns a pose by. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place.
Open Scope R_scope.

(* A share of |q|^2: what a product of two components changes by, 2^-61 |q|^2. *)
Definition share : R := v / 256.

(* An entry whose numerator and denominator change by four such products. *)
Lemma entry_change (A B n l : R) :
  0 < n -> Rabs A <= n -> Rabs (B - A) <= 4 * share * n -> Rabs (l - n) <= 4 * share * n ->
  Rabs (B / l - A / n) <= 9 * share.
Proof.
  intros Hn HA HB Hl. pose proof v_value as V. unfold share in *.
  apply Rabs_le_inv in Hl. assert (L : n * (1 - v / 64) <= l) by lra.
  assert (Lp : 0 < l) by (unfold v in *; lra).
  assert (E : B / l - A / n = ((B - A) - A / n * (l - n)) / l) by (field; lra).
  rewrite E. unfold Rdiv at 1. rewrite Rabs_mult, (Rabs_pos_eq (/ l))
    by (apply Rlt_le, Rinv_0_lt_compat; lra).
  apply Rmult_le_reg_r with l; [lra |]. rewrite Rmult_assoc, Rinv_l, Rmult_1_r by lra.
  assert (K : Rabs (A / n) <= 1).
  { unfold Rdiv. rewrite Rabs_mult, (Rabs_pos_eq (/ n)) by (apply Rlt_le, Rinv_0_lt_compat; lra).
    apply Rmult_le_reg_r with n; [lra |]. rewrite Rmult_assoc, Rinv_l; lra. }
  assert (M : Rabs (A / n * (l - n)) <= 1 * (4 * (v / 256) * n)).
  { rewrite Rabs_mult. apply Rmult_le_compat; try apply Rabs_pos; [exact K |].
    apply Rabs_le. lra. }
  apply Rle_trans with (Rabs (B - A) + Rabs (A / n * (l - n))).
  - unfold Rminus at 1. apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp. lra.
  - unfold v in *. lra.
Qed.

Section Read.
Variable m : mode.
Variable q : quaternion.
Hypothesis Hlarge : / IZR (2 ^ 128) <= norm_of q.
Let n := norm_of q.

Definition read_quaternion : quaternion :=
  {| qx := read m (qx q); qy := read m (qy q); qz := read m (qz q); qw := read m (qw q) |}.

Lemma tiny_share : tiny * tiny <= share * share / 4 * n.
Proof.
  apply Rle_trans with (share * share / 4 * / IZR (2 ^ 128)).
  - unfold tiny, share, v. lra.
  - apply Rmult_le_compat_l; [| exact Hlarge]. pose proof v_value.
    pose proof (Rle_0_sqr share) as S. unfold Rsqr in S. lra.
Qed.

Lemma product_change (a b : R) :
  a * a <= n -> b * b <= n -> Rabs (read m a * read m b - a * b) <= share * n.
Proof.
  intros Ha Hb. pose proof tiny_share as T. pose proof tiny_value as T0. pose proof v_value as V.
  assert (N : 0 < n).
  { apply Rlt_le_trans with (2 := Hlarge). apply Rinv_0_lt_compat. now apply IZR_lt. }
  assert (S : 0 < share) by (unfold share; lra).
  assert (One : forall c d, d * d <= n -> Rabs c <= tiny -> Rabs (c * d) <= share / 2 * n).
  { intros c d Hd Hc.
    assert (P : 0 <= share / 2 * n) by (apply Rmult_le_pos; lra).
    rewrite <- (Rabs_pos_eq (share / 2 * n)) by exact P. apply Rsqr_le_abs_0. unfold Rsqr.
    replace (c * d * (c * d)) with (c * c * (d * d)) by ring.
    replace (share / 2 * n * (share / 2 * n)) with (share * share / 4 * n * n) by field.
    apply Rmult_le_compat; [apply Rle_0_sqr | apply Rle_0_sqr | | exact Hd].
    apply Rle_trans with (2 := T). pose proof (Rsqr_abs c) as E. unfold Rsqr in E. rewrite E.
    pose proof (Rabs_pos c). apply Rmult_le_compat; lra. }
  replace (read m a * read m b - a * b)
    with ((read m a - a) * read m b + (read m b - b) * a) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _).
  assert (Hb' : read m b * read m b <= n).
  { destruct (read_cases m b) as [-> | [_ ->]]; lra. }
  pose proof (One _ _ Hb' (read_error m a)). pose proof (One _ _ Ha (read_error m b)). lra.
Qed.

Lemma components_below :
  qx q * qx q <= n /\ qy q * qy q <= n /\ qz q * qz q <= n /\ qw q * qw q <= n.
Proof. pose proof (square_shares q). unfold n, norm_of. repeat split; lra. Qed.

Definition row_change (a b : point) : Prop :=
  Rabs (px a - px b) <= 9 * share /\ Rabs (py a - py b) <= 9 * share /\
  Rabs (pz a - pz b) <= 9 * share.

Lemma rotation_change :
  let (e, f) := (exact_rotation read_quaternion, exact_rotation q) in
  row_change (row0 e) (row0 f) /\ row_change (row1 e) (row1 f) /\ row_change (row2 e) (row2 f).
Proof.
  destruct components_below as (Bx & By & Bz & Bw).
  assert (N : 0 < n).
  { apply Rlt_le_trans with (2 := Hlarge). apply Rinv_0_lt_compat. now apply IZR_lt. }
  pose proof (product_change _ _ Bx Bx) as Cxx. pose proof (product_change _ _ By By) as Cyy.
  pose proof (product_change _ _ Bz Bz) as Czz. pose proof (product_change _ _ Bw Bw) as Cww.
  pose proof (product_change _ _ Bx By) as Cxy. pose proof (product_change _ _ Bx Bz) as Cxz.
  pose proof (product_change _ _ By Bz) as Cyz. pose proof (product_change _ _ Bw Bx) as Cwx.
  pose proof (product_change _ _ Bw By) as Cwy. pose proof (product_change _ _ Bw Bz) as Cwz.
  pose proof (square_shares q) as (Px & Py & Pz & Pw).
  pose proof (product_share (qx q) (qy q)) as Sxy. pose proof (product_share (qx q) (qz q)) as Sxz.
  pose proof (product_share (qy q) (qz q)) as Syz. pose proof (product_share (qw q) (qx q)) as Swx.
  pose proof (product_share (qw q) (qy q)) as Swy. pose proof (product_share (qw q) (qz q)) as Swz.
  unfold exact_rotation, row_change, pt, read_quaternion. cbn [row0 row1 row2 px py pz qx qy qz qw].
  unfold norm_of. cbn [qx qy qz qw]. unfold n, norm_of in *.
  apply Rabs_le_inv in Cxx, Cyy, Czz, Cww, Cxy, Cxz, Cyz, Cwx, Cwy, Cwz.
  assert (Abs : forall t k, 2 * Rabs t <= k -> - k <= 2 * t <= k).
  { intros t k H. assert (T : Rabs t <= k / 2) by lra. apply Rabs_le_inv in T. lra. }
  apply Abs in Sxy, Sxz, Syz, Swx, Swy, Swz.
  repeat split; (apply entry_change; [exact N | apply Rabs_le; lra | apply Rabs_le; lra |
    apply Rabs_le; lra]).
Qed.

(* The exact places of a point under both quaternions. *)
Lemma pose_change (t p : point) (size : R) :
  within size p -> distance (posed q t p) (posed read_quaternion t p) <= 0.2 * v * size.
Proof.
  intro Hp. pose proof rotation_change as (R0 & R1 & R2). pose proof v_value as V.
  assert (Hs : 0 <= size) by (pose proof (Rabs_pos (px p)); destruct Hp; lra).
  assert (Row : forall a b, row_change a b -> Rabs (dot a p - dot b p) <= 27 * share * size).
  { intros a b (Hx & Hy & Hz). destruct Hp as (Px & Py & Pz). unfold dot.
    replace (px a * px p + py a * py p + pz a * pz p - (px b * px p + py b * py p + pz b * pz p))
      with ((px a - px b) * px p + (py a - py b) * py p + (pz a - pz b) * pz p) by ring.
    assert (T : forall c d,
      Rabs c <= 9 * share -> Rabs d <= size -> Rabs (c * d) <= 9 * share * size).
    { intros c d Hc Hd. rewrite Rabs_mult. apply Rmult_le_compat; try apply Rabs_pos; assumption. }
    apply Rle_trans with (1 := Rabs_triang _ _).
    pose proof (Rabs_triang ((px a - px b) * px p) ((py a - py b) * py p)).
    pose proof (T _ _ Hx Px). pose proof (T _ _ Hy Py). pose proof (T _ _ Hz Pz). lra. }
  unfold distance. apply Rle_trans with (1.73206 * (27 * share * size)).
  - apply norm_of_coordinates. unfold within, minus, posed, plus, apply, pt. cbn [px py pz].
    assert (C : forall a b c, a + c - (b + c) = a - b) by (intros; ring). rewrite !C.
    repeat split; now apply Row.
  - unfold share. assert (0 <= v * size) by (apply Rmult_le_pos; lra). lra.
Qed.

(* What is read is a quaternion of the contract too. *)
Lemma read_sound : sound_quaternion q -> sound_quaternion read_quaternion.
Proof.
  intros [_ Hhigh]. destruct components_below as (Bx & By & Bz & Bw).
  pose proof (product_change _ _ Bx Bx) as Cxx. pose proof (product_change _ _ By By) as Cyy.
  pose proof (product_change _ _ Bz Bz) as Czz. pose proof (product_change _ _ Bw Bw) as Cww.
  apply Rabs_le_inv in Cxx, Cyy, Czz, Cww.
  pose proof (square_shares q) as (Px & Py & Pz & Pw). pose proof v_value as V.
  assert (D : forall c, read m c * read m c <= c * c).
  { intro c. pose proof (Rle_0_sqr c) as P. unfold Rsqr in P.
    destruct (read_cases m c) as [-> | [_ ->]]; lra. }
  unfold sound_quaternion, norm_of, read_quaternion in *. cbn [qx qy qz qw].
  pose proof (D (qx q)). pose proof (D (qy q)). pose proof (D (qz q)). pose proof (D (qw q)).
  split; [| lra].
  apply Rle_trans with (norm_of q / 2).
  - apply Rle_trans with (/ IZR (2 ^ 128) / 2); [unfold least_norm; lra | unfold norm_of; lra].
  - unfold share, n, norm_of in *. unfold v in *. lra.
Qed.
End Read.

(* Where operands are read as zero, a quaternion must not be that small: |q|^2 >= 2^-128. *)
Definition readable (m : mode) (q : quaternion) : Prop :=
  reads_zero m = true -> / IZR (2 ^ 128) <= norm_of q.

Lemma unread (m : mode) (q : quaternion) : reads_zero m = false -> read_quaternion m q = q.
Proof.
  intro H. unfold read_quaternion, read. rewrite H. cbn. now destruct q.
Qed.

(* The quaternion as it is read, and how far that moves a point. *)
Lemma read_turn (m : mode) (q : quaternion) (t p : point) (size : R) :
  sound_quaternion q -> readable m q -> within size p ->
  sound_quaternion (read_quaternion m q) /\
  distance (posed q t p) (posed (read_quaternion m q) t p) <= 0.2 * v * size.
Proof.
  intros Hq Hread Hp. destruct (reads_zero m) eqn:E.
  - specialize (Hread E). split; [now apply read_sound | now apply pose_change].
  - rewrite (unread m q E). split; [exact Hq |].
    pose proof (posed_moved q t t p p 0 Hq) as M. pose proof v_value as V.
    assert (Z : forall a, within 0 (minus a a)).
    { intro a. unfold within, minus. cbn [px py pz].
      rewrite !Rminus_diag_eq, Rabs_R0 by reflexivity. lra. }
    specialize (M (Z t) (Z p)).
    assert (0 <= size) by (pose proof (Rabs_pos (px p)); destruct Hp; lra).
    assert (0 <= v * size) by (apply Rmult_le_pos; lra). lra.
Qed.
