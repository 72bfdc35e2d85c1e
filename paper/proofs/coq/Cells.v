(* Theorem C within a level: which cell of the grid a centre falls in. Every centre falls in one of
   the table's, and the centres of balls that touch fall in cells next to each other. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Double.
Open Scope R_scope.

(* src/broad_phase/grid/cells.rs: TO_INTEGER *)
Definition to_integer : R := IZR (3 * 2 ^ 51).

Lemma to_integer_value : to_integer = 6755399441055744.
Proof. reflexivity. Qed.

Section Rule.
Variable m : mode64.
Hypothesis Hm : valid64 m.
Variables origin inverse : R.

(* src/broad_phase/grid/cells.rs: CellRule::cell *)
Definition cell (x : R) : R := add64 m (mul64 m (sub64 m x origin) inverse) to_integer.

(* src/broad_phase/grid/cells.rs: number. The low 32 bits of 1.5 * 2^52 + k are k, for 0 <= k < 2^31
   (the number's unit in the last place is 1). *)
Definition number (c : R) : Z := (Zfloor c - 3 * 2 ^ 51)%Z.

Lemma read64_monotone (x y : R) : x <= y -> read64 m x <= read64 m y.
Proof.
  intro H. unfold read64. case (reads_zero64 m); cbn; [| exact H].
  do 2 case Rlt_bool_spec; intros Hy Hx; try lra.
  - apply Rabs_def2 in Hx. destruct (Rle_or_lt 0 y) as [P | N]; [exact P |].
    rewrite Rabs_left in Hy by exact N. lra.
  - apply Rabs_def2 in Hy. destruct (Rle_or_lt x 0) as [P | N]; [exact P |].
    rewrite Rabs_pos_eq in Hx by lra. lra.
Qed.

Lemma nearest64_monotone (x y : R) : x <= y -> nearest64 x <= nearest64 y.
Proof. intro H. unfold nearest64. apply round_le; try typeclasses eauto. exact H. Qed.

Lemma nearest64_zero : nearest64 0 = 0.
Proof. unfold nearest64. apply round_0. typeclasses eauto. Qed.

Lemma fl64_monotone (x y : R) : x <= y -> fl64 m x <= fl64 m y.
Proof.
  intro H. unfold fl64. do 2 case Rlt_bool_spec; intros Hy Hx.
  - lra.
  - apply Rabs_def2 in Hx. rewrite <- nearest64_zero. apply nearest64_monotone.
    destruct (Rle_or_lt 0 y) as [P | N]; [exact P |]. rewrite Rabs_left in Hy by exact N. lra.
  - apply Rabs_def2 in Hy. rewrite <- nearest64_zero. apply nearest64_monotone.
    destruct (Rle_or_lt x 0) as [P | N]; [exact P |]. rewrite Rabs_pos_eq in Hx by lra. lra.
  - now apply nearest64_monotone.
Qed.

Lemma cell_monotone (x y : R) : 0 <= inverse -> x <= y -> cell x <= cell y.
Proof.
  intros Hi H. unfold cell, add64, mul64, sub64. apply fl64_monotone, Rplus_le_compat_r.
  apply read64_monotone, fl64_monotone. apply Rmult_le_compat_r.
  - destruct (read64_cases m inverse) as [-> | [_ ->]]; lra.
  - apply read64_monotone, fl64_monotone. apply read64_monotone in H. lra.
Qed.

Lemma tiny64_small : tiny64 <= / 1000000.
Proof. unfold tiny64. apply Rinv_le_contravar; [lra | now apply IZR_le]. Qed.

Lemma read64_to_integer : read64 m to_integer = to_integer.
Proof.
  destruct (read64_cases m to_integer) as [-> | [H _]]; [reflexivity |]. exfalso.
  pose proof tiny64_small. rewrite to_integer_value, Rabs_pos_eq in H; lra.
Qed.

(* There f64 numbers are integers. *)
Lemma nearest64_integer (x : R) :
  4503599627370496 <= x < 9007199254740992 -> nearest64 x = IZR (ZnearestE x).
Proof.
  intro H. unfold nearest64, round, scaled_mantissa, cexp.
  assert (M : mag radix2 x = 53%Z :> Z).
  { apply mag_unique. rewrite Rabs_pos_eq by lra. split.
    - change (bpow radix2 (53 - 1)) with 4503599627370496. lra.
    - change (bpow radix2 53) with 9007199254740992. lra. }
  rewrite M. change (FLT_exp (-1074) 53 53) with 0%Z. unfold F2R. cbn.
  now rewrite !Rmult_1_r.
Qed.

Lemma integer_cell (q : R) :
  Rabs q <= 2147483648 -> add64 m q to_integer = IZR (ZnearestE (read64 m q + to_integer)).
Proof.
  intro H. unfold add64. rewrite read64_to_integer. pose proof (read64_abs m q) as A.
  assert (B : Rabs (read64 m q) <= 2147483648) by lra. apply Rabs_le_inv in B.
  pose proof Hm as Ht. unfold valid64 in Ht. pose proof tiny64_small.
  rewrite to_integer_value in *. unfold fl64. rewrite Rabs_pos_eq by lra.
  rewrite Rlt_bool_false by lra. apply nearest64_integer. lra.
Qed.

(* (1) Each centre between the lowest and the farthest one has a number below the count, which is
   that of the farthest one and one (CellRule::count). *)
Theorem centre_in_table (x hi : R) :
  0 <= inverse -> origin <= x <= hi -> (0 <= number (cell x) <= number (cell hi))%Z.
Proof.
  intros Hi [H0 H1]. unfold number.
  assert (O : cell origin = to_integer).
  { unfold cell, sub64. rewrite Rminus_diag_eq by reflexivity.
    assert (Z : fl64 m 0 = 0) by (unfold fl64; case Rlt_bool; [reflexivity | apply nearest64_zero]).
    assert (Zr : read64 m 0 = 0) by (destruct (read64_cases m 0) as [-> | [_ ->]]; reflexivity).
    rewrite Z. unfold mul64. rewrite Zr, Rmult_0_l, Z.
    rewrite integer_cell by (rewrite Rabs_R0; lra).
    rewrite Zr, Rplus_0_l. unfold to_integer. now rewrite (Zrnd_IZR ZnearestE). }
  pose proof (cell_monotone _ _ Hi H0) as L. rewrite O in L.
  pose proof (cell_monotone _ _ Hi H1) as U.
  apply Zfloor_le in L, U. unfold to_integer in L. rewrite Zfloor_IZR in L. lia.
Qed.
End Rule.

(* (2) A cell size of hardly less than 2 w (1 + 2^-16), w being the radius of the widest ball or
   more, and hardly more than 2^29 cells along an axis: Grid.v shows both (needed_above,
   fit_most_cells). *)
Section Level.
Variable m : mode64.
Hypothesis Hm : valid64 m.
Variables origin size : R.
Hypothesis Hsize : / IZR (2 ^ 100) <= size <= IZR (2 ^ 100).

Definition most_cells : R := 536870913.

Let inverse := div64 m 1 size.
Let quotient (x : R) : R := mul64 m (sub64 m x origin) inverse.

Lemma quotient_error (x : R) :
  0 <= x - origin <= most_cells * size -> Rabs (quotient x - (x - origin) / size) <= / 4194304.
Proof.
  intro H. pose proof dust_value as D. pose proof v_value as V.
  pose proof tiny64_dust as T. pose proof (proj1 tiny64_value) as T0.
  assert (P : 0 < / IZR (2 ^ 100)) by (apply Rinv_0_lt_compat; now apply IZR_lt).
  assert (D1 : dust * IZR (2 ^ 130) <= / IZR (2 ^ 100)).
  { unfold dust. change (2 ^ 700)%Z with (2 ^ 570 * 2 ^ 130)%Z. rewrite mult_IZR, Rinv_mult,
      Rmult_assoc, Rinv_l, Rmult_1_r by now apply IZR_neq.
    apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
  assert (D2 : dust <= / IZR (2 ^ 100)).
  { unfold dust. apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
  assert (D3 : / IZR (2 ^ 100) <= v / 1000000).
  { unfold v, Rdiv. rewrite <- Rinv_mult, <- mult_IZR.
    apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
  pose proof (inverse64_error m Hm size ltac:(lra)) as Ei. fold inverse in Ei.
  assert (Ex : Rabs (x - x) <= 0) by (rewrite Rminus_diag_eq, Rabs_R0 by reflexivity; lra).
  assert (Eo : Rabs (origin - origin) <= 0)
    by (rewrite Rminus_diag_eq, Rabs_R0 by reflexivity; lra).
  pose proof (sub64_near m Hm x origin x origin 0 0 Ex Eo) as Ed.
  set (X := x - origin) in *. rewrite (Rabs_pos_eq X) in Ed by lra.
  unfold quotient. set (d := sub64 m x origin) in *.
  assert (Hi : 0 < / size <= IZR (2 ^ 100)).
  { split; [apply Rinv_0_lt_compat; lra |].
    rewrite <- (Rinv_inv (IZR (2 ^ 100))). apply Rinv_le_contravar; lra. }
  set (k := X / size). assert (Hk : 0 <= k <= 536870913).
  { unfold k, Rdiv. split; [apply Rmult_le_pos; lra |].
    apply Rmult_le_reg_r with size; [lra |]. rewrite Rmult_assoc, Rinv_l by lra.
    unfold most_cells in H. lra. }
  assert (Xb : X <= IZR (2 ^ 130)).
  { apply Rle_trans with (most_cells * IZR (2 ^ 100)).
    - apply Rle_trans with (1 := proj2 H). apply Rmult_le_compat_l; [now apply IZR_le | lra].
    - unfold most_cells. rewrite <- mult_IZR. now apply IZR_le. }
  assert (Dx : dust * X <= / IZR (2 ^ 100)).
  { apply Rle_trans with (2 := D1). apply Rmult_le_compat_l; [lra |].
    apply Rle_trans with (1 := Xb). now apply IZR_le. }
  assert (Di : dust * / size <= / IZR (2 ^ 100)).
  { apply Rle_trans with (2 := D1). apply Rmult_le_compat_l; [lra |].
    apply Rle_trans with (1 := proj2 Hi). now apply IZR_le. }
  assert (E : Rabs (d * inverse - k) <= 2.01 * v * k + 3 * / IZR (2 ^ 100)).
  { replace (d * inverse - k) with ((d - X) * inverse + X * (inverse - / size))
      by (unfold k; field; lra).
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult, (Rabs_pos_eq X) by lra.
    assert (Ri : Rabs inverse <= / size * (1 + v) + dust).
    { replace inverse with (/ size + (inverse - / size)) by ring.
      apply Rle_trans with (1 := Rabs_triang _ _). rewrite (Rabs_pos_eq (/ size)) by lra. lra. }
    assert (A : Rabs (d - X) * Rabs inverse
      <= (v * X + dust + (1 + v) * (0 + 0)) * (/ size * (1 + v) + dust))
      by (apply Rmult_le_compat; try apply Rabs_pos; lra).
    assert (B : X * Rabs (inverse - / size) <= X * (v * / size + dust))
      by (apply Rmult_le_compat_l; lra).
    replace ((v * X + dust + (1 + v) * (0 + 0)) * (/ size * (1 + v) + dust))
      with (v * (1 + v) * k + v * (dust * X) + (1 + v) * (dust * / size) + dust * dust) in A
      by (unfold k, Rdiv; ring).
    replace (X * (v * / size + dust)) with (v * k + dust * X) in B by (unfold k, Rdiv; ring).
    assert (DD : dust * dust <= 1 / 1000 * / IZR (2 ^ 100)).
    { apply Rmult_le_compat; unfold v in *; lra. }
    unfold v in *. lra. }
  assert (Bd : Rabs d <= big).
  { replace d with (X + (d - X)) by ring. apply Rle_trans with (1 := Rabs_triang _ _).
    rewrite (Rabs_pos_eq X) by lra. apply Rle_trans with (2 * IZR (2 ^ 130)).
    - assert (1 <= IZR (2 ^ 130)) by now apply IZR_le. unfold v in *. lra.
    - unfold big. rewrite <- mult_IZR. now apply IZR_le. }
  assert (Bi : Rabs inverse <= big).
  { replace inverse with (/ size + (inverse - / size)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite (Rabs_pos_eq (/ size)) by lra.
    apply Rle_trans with (2 * IZR (2 ^ 100)).
    - assert (1 <= IZR (2 ^ 100)) by now apply IZR_le. unfold v in *. lra.
    - unfold big. rewrite <- mult_IZR. now apply IZR_le. }
  pose proof (mul64_near m Hm d inverse k _ Bd Bi E) as Q. rewrite (Rabs_pos_eq k) in Q by lra.
  apply Rle_trans with (1 := Q). unfold v in *. lra.
Qed.

(* Centres x and y of a level, no farther apart than twice the widest radius w. *)
Theorem neighbouring_cells (x y w : R) :
  origin <= y <= x -> x - origin <= most_cells * size ->
  2 * w * (1 + / 65537) <= size -> x - y <= 2 * w ->
  (0 <= number (cell m origin inverse x) - number (cell m origin inverse y) <= 1)%Z.
Proof.
  intros [Hy Hx] Hmost Hw Hxy.
  assert (P : 0 < / IZR (2 ^ 100)) by (apply Rinv_0_lt_compat; now apply IZR_lt).
  pose proof (quotient_error x ltac:(lra)) as Qx. pose proof (quotient_error y ltac:(lra)) as Qy.
  unfold cell. fold (quotient x) (quotient y).
  assert (Share : (x - origin) / size - (y - origin) / size <= 1 - / 100000).
  { replace ((x - origin) / size - (y - origin) / size) with ((x - y) / size) by (field; lra).
    apply Rmult_le_reg_r with size; [lra |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra. }
  assert (Bound : forall z, origin <= z <= x -> 0 <= (z - origin) / size <= 536870913).
  { intros z Hz. unfold Rdiv. pose proof (Rinv_0_lt_compat size ltac:(lra)) as Pi.
    split; [apply Rmult_le_pos; lra |]. apply Rmult_le_reg_r with size; [lra |].
    rewrite Rmult_assoc, Rinv_l by lra. unfold most_cells in Hmost. lra. }
  pose proof (Bound x ltac:(lra)) as Bx. pose proof (Bound y ltac:(lra)) as By.
  apply Rabs_le_inv in Qx, Qy.
  assert (Ax : Rabs (quotient x) <= 2147483648) by (apply Rabs_le; lra).
  assert (Ay : Rabs (quotient y) <= 2147483648) by (apply Rabs_le; lra).
  rewrite (integer_cell m Hm _ Ax), (integer_cell m Hm _ Ay). unfold number.
  rewrite !Zfloor_IZR.
  pose proof (read64_error m (quotient x)) as Rx. pose proof (read64_error m (quotient y)) as Ry.
  apply Rabs_le_inv in Rx, Ry. pose proof tiny64_small as Ts.
  set (a := read64 m (quotient x) + to_integer). set (b := read64 m (quotient y) + to_integer).
  pose proof (Znearest_half (fun z => negb (Z.even z)) a) as Na.
  pose proof (Znearest_half (fun z => negb (Z.even z)) b) as Nb.
  apply Rabs_le_inv in Na, Nb.
  split.
  - assert (M : cell m origin inverse y <= cell m origin inverse x).
    { apply cell_monotone; [| exact Hx].
      unfold inverse, div64. apply Rle_trans with (fl64 m 0).
      - unfold fl64. case Rlt_bool; [lra |]. rewrite nearest64_zero. lra.
      - apply fl64_monotone. unfold Rdiv. apply Rmult_le_pos.
        + destruct (read64_cases m 1) as [-> | [_ ->]]; lra.
        + destruct (read64_cases m size) as [-> | [_ ->]]; [apply Rlt_le, Rinv_0_lt_compat; lra |].
          rewrite Rinv_0. lra. }
    unfold cell in M. fold (quotient x) (quotient y) in M.
    rewrite (integer_cell m Hm _ Ax), (integer_cell m Hm _ Ay) in M. apply le_IZR in M.
    fold a b in M. lia.
  - assert (L : IZR (ZnearestE a - ZnearestE b) < 2).
    { rewrite minus_IZR. unfold a, b in *. lra. }
    apply lt_IZR in L. lia.
Qed.
End Level.

(* (3) What a body of another level looks at: the cells from that of x - reach to that of x + reach,
   clamped to the table. They hold that of each centre within reach. *)
Section Around.
Variable m : mode64.
Hypothesis Hm : valid64 m.
Variables origin inverse : R.
Hypothesis Hi : 0 <= inverse.

(* An f64 that is zero or not below 2^-1022, as each f32 is. *)
Definition normal64 (x : R) : Prop :=
  generic_format radix2 (FLT_exp (-1074) 53) x /\ (x = 0 \/ tiny64 <= Rabs x).

Lemma read64_normal (x : R) : normal64 x -> read64 m x = x.
Proof.
  intros [_ H]. destruct (read64_cases m x) as [-> | [A ->]]; [reflexivity |].
  destruct H as [-> | H]; [reflexivity | lra].
Qed.

Lemma fl64_normal (x : R) : normal64 x -> fl64 m x = x.
Proof.
  intros [F H]. pose proof Hm as Ht. unfold valid64 in Ht. unfold fl64. case Rlt_bool_spec; intro A.
  - destruct H as [-> | H]; [reflexivity | lra].
  - unfold nearest64. apply round_generic; [typeclasses eauto | exact F].
Qed.

(* src/broad_phase/grid/cells.rs: Cells::around, one axis; `last` is the cell of the farthest
   centre. *)
Definition around (x reach last : R) : option (R * R) :=
  let lo := cell m origin inverse (sub64 m x reach) in
  let hi := cell m origin inverse (add64 m x reach) in
  if Rlt_bool last lo || Rlt_bool hi to_integer then None
  else Some (Rmin (Rmax lo to_integer) last, Rmin (Rmax hi to_integer) last).

Theorem around_covers (x y reach last : R) :
  normal64 x -> normal64 y -> normal64 reach -> Rabs (y - x) <= reach ->
  to_integer <= cell m origin inverse y <= last ->
  exists lo hi, around x reach last = Some (lo, hi) /\
    (number lo <= number (cell m origin inverse y) <= number hi)%Z.
Proof.
  intros Nx Ny Nr Hr [Hy0 Hy1]. apply Rabs_le_inv in Hr.
  assert (L : sub64 m x reach <= y).
  { unfold sub64. rewrite (read64_normal x Nx), (read64_normal reach Nr).
    rewrite <- (fl64_normal y Ny). apply fl64_monotone. lra. }
  assert (U : y <= add64 m x reach).
  { unfold add64. rewrite (read64_normal x Nx), (read64_normal reach Nr).
    rewrite <- (fl64_normal y Ny) at 1. apply fl64_monotone. lra. }
  apply (cell_monotone m origin inverse _ _ Hi) in L, U.
  unfold around. set (lo := cell m origin inverse (sub64 m x reach)) in *.
  set (hi := cell m origin inverse (add64 m x reach)) in *.
  rewrite !Rlt_bool_false by lra. cbn. eexists. eexists. split; [reflexivity |].
  unfold number. split; apply Z.sub_le_mono_r, Zfloor_le.
  - apply Rle_trans with (1 := Rmin_l _ _). now apply Rmax_lub; lra.
  - apply Rmin_glb; [| exact Hy1]. apply Rle_trans with (1 := U). apply Rmax_l.
Qed.
End Around.
