(* The row of an or-DOP as the code computes it of a shape and a pose, with gradual underflow: axes
   and offset are once rounded. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Ieee Shows Outward Finder.
From Sdop Require Import Duality Vectors Rounded Separated OrDopTest Rejected Norms64.
Open Scope R_scope.

Local Notation g := gradual64.

(* src/volume/basis.rs: Basis::from_integer_quaternion. Three orthogonal vectors of one length. *)
Definition basis_of_length (b : matrix) (n : R) : Prop :=
  / 4 <= n <= 2 /\ square (row0 b) = n * n /\ square (row1 b) = n * n /\ square (row2 b) = n * n /\
  dot (row0 b) (row1 b) = 0 /\ dot (row0 b) (row2 b) = 0 /\ dot (row1 b) (row2 b) = 0.

(* src/rounding/pose.rs: axes_of, rotate_of; src/update/frame.rs: ShapeFrame::row *)
Definition rounded_axes (r b : matrix) : matrix :=
  let unit := over_norm (row0 b) in
  let axis x := pt (fl gradual (mul64 g (rotate_row g (row0 r) x) unit))
    (fl gradual (mul64 g (rotate_row g (row1 r) x) unit))
    (fl gradual (mul64 g (rotate_row g (row2 r) x) unit)) in
  {| row0 := axis (row0 b); row1 := axis (row1 b); row2 := axis (row2 b) |}.
Definition rounded_offset (r : matrix) (c : point) : point :=
  pt (fl gradual (rotate_row g (row0 r) c)) (fl gradual (rotate_row g (row1 r) c))
    (fl gradual (rotate_row g (row2 r) c)).
Definition posed_row (q : quaternion) (t c : point) (b : matrix) : row :=
  {| row_axes := rounded_axes (rotation_of g q) b; row_place := t;
     row_offset := if is_origin gradual c then pt 0 0 0 else rounded_offset (rotation_of g q) c |}.

(* The exact axes of a posed basis. *)
Definition unit_basis (b : matrix) (n : R) : matrix :=
  {| row0 := scaled (/ n) (row0 b); row1 := scaled (/ n) (row1 b); row2 := scaled (/ n) (row2 b) |}.
Definition posed_axes (q : quaternion) (b : matrix) (n : R) : matrix :=
  let turned x := apply (exact_rotation q) x in
  {| row0 := turned (row0 (unit_basis b n)); row1 := turned (row1 (unit_basis b n));
     row2 := turned (row2 (unit_basis b n)) |}.

Lemma unit_basis_orthonormal (b : matrix) (n : R) :
  basis_of_length b n -> orthonormal (unit_basis b n).
Proof.
  intros ((N & _) & S0 & S1 & S2 & D0 & D1 & D2).
  assert (P : n <> 0) by lra.
  assert (Sc : forall x y, dot (scaled (/ n) x) (scaled (/ n) y) = dot x y / (n * n)).
  { intros x y. unfold dot, scaled, pt. cbn [px py pz]. field. exact P. }
  unfold orthonormal, unit_basis. cbn [row0 row1 row2]. rewrite !Sc, D0, D1, D2.
  replace (dot (row0 b) (row0 b)) with (square (row0 b)) by reflexivity.
  replace (dot (row1 b) (row1 b)) with (square (row1 b)) by reflexivity.
  replace (dot (row2 b) (row2 b)) with (square (row2 b)) by reflexivity.
  rewrite S0, S1, S2. repeat split; field; exact P.
Qed.

Lemma rotation_keeps_dot (q : quaternion) (x y : point) :
  0 < norm_of q -> dot (apply (exact_rotation q) x) (apply (exact_rotation q) y) = dot x y.
Proof.
  intro H. unfold dot, apply, exact_rotation, dot, pt, norm_of in *.
  cbn [row0 row1 row2 px py pz]. field. lra.
Qed.

Lemma posed_axes_orthonormal (q : quaternion) (b : matrix) (n : R) :
  0 < norm_of q -> basis_of_length b n -> orthonormal (posed_axes q b n).
Proof.
  intros Q B. pose proof (unit_basis_orthonormal b n B) as O. unfold orthonormal in *.
  unfold posed_axes. cbn [row0 row1 row2]. now rewrite !rotation_keeps_dot.
Qed.

Lemma basis_norm (b : matrix) (n : R) :
  basis_of_length b n -> norm (row0 b) = n /\ norm (row1 b) = n /\ norm (row2 b) = n.
Proof.
  intros ((N & _) & S0 & S1 & S2 & _). unfold norm. rewrite S0, S1, S2.
  repeat split; apply sqrt_square; lra.
Qed.

Section Row.
Variable q : quaternion.
Hypothesis Hq : sound_quaternion q.
Variable b : matrix.
Variable n : R.
Hypothesis Hb : basis_of_length b n.

Lemma entry_of_axis (a e x : point) :
  row_error a e -> dot e e = 1 -> norm x = n ->
  Rabs (fl gradual (mul64 g (rotate_row g a x) (over_norm (row0 b))) - dot e (scaled (/ n) x))
    <= u * Rabs (dot e (scaled (/ n) x)) + 60 * v.
Proof.
  intros Ha He Hx. pose proof v_value as V. pose proof dust_value as D.
  destruct small_dust as (D1 & _). pose proof half_step_small as Hs.
  assert (D2 : dust <= v / 1000000).
  { destruct small_value as (S0 & _ & S1). assert (small <= 1).
    { unfold small. rewrite <- Rinv_1. apply Rinv_le_contravar; [lra | now apply IZR_le]. }
    assert (v * small <= v * 1) by (apply Rmult_le_compat_l; lra). lra. }
  pose proof Hb as (Hn & _). destruct (basis_norm b n Hb) as (N0 & _).
  pose proof big_value as Big.
  assert (Hsize : 0 <= n <= big / 2).
  { split; [lra |]. apply Rle_trans with 2; [lra |]. unfold big.
    change (2 ^ 300)%Z with (4 * 2 ^ 298)%Z. rewrite mult_IZR.
    pose proof (IZR_le 1 (2 ^ 298) ltac:(vm_compute; discriminate)). lra. }
  pose proof (rotate_row_error a e x n Ha He Hsize ltac:(lra)) as R.
  destruct (scale_error (row0 b) n N0 Hn) as (Sc & Sl).
  unfold over_norm.
  assert (One : Rabs (1 - 1) <= 0) by (rewrite Rminus_diag_eq, Rabs_R0; lra).
  pose proof (divided_error 1 1 0 (norm_in_f64 (row0 b)) n Hn Sc One) as U.
  rewrite Rabs_R1 in U. unfold Rdiv in U. rewrite !Rmult_1_l, Rmult_0_l, Rmult_0_r in U.
  set (unit := div64 g 1 (norm_in_f64 (row0 b))) in *.
  set (k := dot e (scaled (/ n) x)) in *. set (d := rotate_row g a x) in *.
  assert (K : dot e x = n * k).
  { unfold k, dot, scaled, pt. cbn [px py pz]. field. lra. }
  assert (B : Rabs k <= 1).
  { unfold k. apply Rle_trans with (1 := dot_norms _ _).
    rewrite norm_scaled, Hx by (apply Rlt_le, Rinv_0_lt_compat; lra). rewrite Rinv_l by lra.
    replace (norm e) with 1; [lra |]. unfold norm. replace (square e) with (dot e e) by reflexivity.
    now rewrite He, sqrt_1. }
  assert (I : / 2 <= / n <= 4).
  { split; [apply Rinv_le_contravar; lra |]. rewrite <- (Rinv_inv 4). apply Rinv_le_contravar; lra.
    }
  assert (T64 : tiny64 <= dust) by (pose proof tiny64_dust; pose proof (proj1 tiny64_value); lra).
  assert (Un : Rabs (unit - / n) <= 7.1 * v * / n) by (unfold v in *; lra).
  assert (Ua : Rabs unit <= 1.01 * / n).
  { pose proof (Rabs_triang_inv unit (/ n)). rewrite (Rabs_pos_eq (/ n)) in * by lra.
    unfold v in *. lra. }
  rewrite K in R.
  assert (Dn : Rabs (d - n * k) <= 35.4 * v * n) by (unfold v in *; lra).
  assert (Prod : Rabs (d * unit - k) <= 43 * v).
  { replace (d * unit - k) with ((d - n * k) * unit + n * k * (unit - / n)) by (field; lra).
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult, (Rabs_pos_eq n) by lra.
    assert (A1 : Rabs (d - n * k) * Rabs unit <= 35.4 * v * n * (1.01 * / n))
      by (apply Rmult_le_compat; try apply Rabs_pos; assumption).
    assert (A2 : n * Rabs k * Rabs (unit - / n) <= n * 1 * (7.1 * v * / n)).
    { apply Rmult_le_compat; [| apply Rabs_pos | | exact Un].
      - apply Rmult_le_pos; [lra | apply Rabs_pos].
      - apply Rmult_le_compat_l; lra. }
    replace (35.4 * v * n * (1.01 * / n)) with (35.4 * v * 1.01 * (n * / n)) in A1 by ring.
    replace (n * 1 * (7.1 * v * / n)) with (7.1 * v * (n * / n)) in A2 by ring.
    rewrite Rinv_r in A1, A2 by lra. lra. }
  assert (Bd : Rabs d <= big).
  { assert (Rabs d <= 3).
    { pose proof (Rabs_triang_inv d (n * k)) as T.
      rewrite (Rabs_mult n k), (Rabs_pos_eq n) in T by lra.
      assert (n * Rabs k <= 2 * 1) by (apply Rmult_le_compat; try apply Rabs_pos; lra).
      unfold v in *. lra. }
    apply Rle_trans with (1 := H). unfold big. now apply IZR_le. }
  assert (Bu : Rabs unit <= big).
  { apply Rle_trans with 5; [lra |]. unfold big. now apply IZR_le. }
  pose proof (mul64_near g valid_g d unit k _ Bd Bu Prod) as M.
  set (w := mul64 g d unit) in *.
  assert (W : Rabs (w - k) <= 45 * v) by (unfold v in *; lra).
  pose proof (gradual_cast w) as C. pose proof (Rabs_triang_inv w k) as T.
  apply Rabs_le_inv in C. pose proof W as W'. apply Rabs_le_inv in W'.
  unfold u, v in *. apply Rabs_le. lra.
Qed.

Lemma axis_error (x : point) :
  norm x = n ->
  norm (minus (pt (fl gradual (mul64 g (rotate_row g (row0 (rotation_of g q)) x) (over_norm (row0
    b))))
      (fl gradual (mul64 g (rotate_row g (row1 (rotation_of g q)) x) (over_norm (row0 b))))
      (fl gradual (mul64 g (rotate_row g (row2 (rotation_of g q)) x) (over_norm (row0 b)))))
    (apply (exact_rotation q) (scaled (/ n) x))) <= 1.01 * u.
Proof.
  intro Hx. pose proof (sound_positive q Hq) as P.
  destruct (rotation_error g valid_g q Hq) as (R0 & R1 & R2).
  destruct (unit_rows q P) as (U0 & U1 & U2). pose proof Hb as (Hn & _).
  assert (E : norm (apply (exact_rotation q) (scaled (/ n) x)) = 1).
  { unfold norm. rewrite rotation_keeps_norm by exact P. fold (norm (scaled (/ n) x)).
    rewrite norm_scaled, Hx by (apply Rlt_le, Rinv_0_lt_compat; lra). apply Rinv_l. lra. }
  apply Rle_trans with (u * norm (apply (exact_rotation q) (scaled (/ n) x)) + 1.73206 * (60 * v)).
  - apply norm_shares; [unfold u; lra | unfold v; lra | | |]; unfold apply, pt; cbn [px py pz];
      now apply entry_of_axis.
  - rewrite E. unfold u, v. lra.
Qed.

Theorem posed_row_is (t c : point) (reach : R) :
  norm c <= reach -> reach <= IZR (2 ^ 100) ->
  row_of (posed_axes q b n) t (apply (exact_rotation q) c) reach (posed_row q t c b).
Proof.
  intros Hc Hreach. pose proof (sound_positive q Hq) as P.
  destruct (basis_norm b n Hb) as (N0 & N1 & N2).
  split; [now apply posed_axes_orthonormal |]. split; [reflexivity |].
  cbn [posed_row row_axes rounded_axes row0 row1 row2 posed_axes unit_basis].
  split; [now apply axis_error |]. split; [now apply axis_error |].
  split; [now apply axis_error |].
  assert (Nc : norm (apply (exact_rotation q) c) = norm c).
  { unfold norm. now rewrite rotation_keeps_norm. }
  split; [lra |]. cbn [row_offset posed_row].
  pose proof (norm_nonneg c) as C0. pose proof tiny_value as T0.
  destruct (is_origin gradual c) eqn:O.
  - assert (Z : c = pt 0 0 0).
    { unfold is_origin in O. apply andb_prop in O. destruct O as [O O2]. apply andb_prop in O.
      destruct O as [O0 O1]. destruct c as [x y z].
      cbn [px py pz] in *. rewrite read_is in O0, O1, O2.
      revert O0 O1 O2. repeat case Req_bool_spec; intros; try discriminate.
      unfold pt. congruence. }
    rewrite Z. replace (norm (minus (pt 0 0 0) (apply (exact_rotation q) (pt 0 0 0)))) with 0.
    + assert (0 <= u * reach) by (apply Rmult_le_pos; unfold u; lra). lra.
    + symmetry. unfold norm. transitivity (sqrt 0); [f_equal | apply sqrt_0].
      unfold square, minus, apply, dot, pt. cbn [px py pz]. ring.
  - destruct (rotation_error g valid_g q Hq) as (R0 & R1 & R2).
    destruct (unit_rows q P) as (U0 & U1 & U2). pose proof v_value as V. pose proof dust_value as D.
    pose proof half_step_value as (H0 & H1).
    assert (Dt : dust <= half_step / 1000000).
    { destruct dust_root_value as (_ & _ & A & B). destruct small_dust as (S & _).
      unfold dust, half_step. unfold Rdiv. rewrite <- Rinv_mult, <- mult_IZR.
      apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
    assert (Hsize : 0 <= norm c <= big / 2).
    { split; [exact C0 |]. apply Rle_trans with (1 := Hc). apply Rle_trans with (1 := Hreach).
      unfold big. change (2 ^ 300)%Z with (2 ^ 299 * 2)%Z. rewrite mult_IZR.
      unfold Rdiv. rewrite Rmult_assoc, Rinv_r, Rmult_1_r by lra. now apply IZR_le. }
    assert (Entry : forall a e, row_error a e -> dot e e = 1 ->
      Rabs (fl gradual (rotate_row g a c) - dot e c)
        <= u * Rabs (dot e c) + (40 * (v * norm c) + 1.01 * half_step)).
    { intros a e Ha He. pose proof (rotate_row_error a e c (norm c) Ha He Hsize ltac:(lra)) as E.
      pose proof (gradual_cast (rotate_row g a c)) as F.
      pose proof (Rabs_triang_inv (rotate_row g a c) (dot e c)) as T.
      apply Rabs_le_inv in F. pose proof E as E'. apply Rabs_le_inv in E'.
      assert (0 <= v * norm c) by (apply Rmult_le_pos; lra).
      unfold u in *. apply Rabs_le. lra. }
    apply Rle_trans with (u * norm (apply (exact_rotation q) c)
      + 1.73206 * (40 * (v * norm c) + 1.01 * half_step)).
    + assert (0 <= v * norm c) by (apply Rmult_le_pos; lra).
      apply norm_shares; [unfold u; lra | lra | | |]; unfold rounded_offset, apply, pt;
        cbn [px py pz]; now apply Entry.
    + rewrite Nc. assert (u * norm c <= u * reach) by (apply Rmult_le_compat_l; [unfold u |]; lra).
      assert (v * norm c <= v * reach) by (apply Rmult_le_compat_l; lra).
      unfold u, v in *. lra.
Qed.
End Row.
