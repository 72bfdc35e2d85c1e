(* Theorem Q for boxes: a line is at a box no earlier than the parameter that is computed, and a ball
   that reaches a box isn't taken to be beyond it. With gradual underflow. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core Relative Plus_error.
From Sdop Require Import Format Geometry Double WorldBall Ieee Shows Cells Outward Finder.
Open Scope R_scope.

Local Notation g := gradual64.

(* src/rounding/query.rs: QUERY_FLOOR, WIDENING, STILL, STILL_FLOOR *)
Definition query_floor : R := / IZR (2 ^ 1000).
Definition widening : R := 8 * v.
Definition still : R := / IZR (2 ^ 800).
Definition still_floor : R := / IZR (2 ^ 600).

(* src/rounding/query.rs: earlier, later; Course::new, Course::between, crossing. For a still line
   the code has ends of 2^1000, which are beyond every parameter, in place of Always and Never. *)
Definition widened (s : R) : R := add64 g (mul64 g (Rabs s) widening) query_floor.
Definition earlier (s : R) : R := sub64 g s (widened s).
Definition later (s : R) : R := add64 g s (widened s).
Definition parameter (end_ at_ inverse : R) : R := mul64 g (sub64 g end_ at_) inverse.
Inductive crossed := Never | Always | Between (first last : R).
Definition crossing (at_ speed lo hi : R) : crossed :=
  if Rlt_bool (Rabs speed) still then
    if Rle_bool (sub64 g lo still_floor) at_ && Rle_bool at_ (add64 g hi still_floor) then Always
    else Never
  else
    let inverse := div64 g 1 speed in
    let (near, far) := if Rlt_bool 0 inverse then (lo, hi) else (hi, lo) in
    Between (earlier (parameter near at_ inverse)) (later (parameter far at_ inverse)).
Definition crossed_at (c : crossed) (s : R) : Prop :=
  match c with Never => False | Always => True | Between first last => first <= s <= last end.

(* src/rounding/query.rs: is_beyond *)
Definition outside (p lo hi : R) : R := Rmax (Rmax (sub64 g lo p) (sub64 g p hi)) 0.
Definition squared (x y z : R) : R :=
  add64 g (add64 g (mul64 g x x) (mul64 g y y)) (mul64 g z z).
Definition is_beyond (p lo hi : point) (radius : R) : bool :=
  let within := mul64 g radius radius in
  Rlt_bool (add64 g within (widened within))
    (squared (outside (px p) (px lo) (px hi)) (outside (py p) (py lo) (py hi))
      (outside (pz p) (pz lo) (pz hi))).

Lemma format64_result (x : R) : format64 (fl64 g x).
Proof.
  rewrite gradual_fl64. apply generic_format_round; typeclasses eauto.
Qed.

Lemma u_ro_value : u_ro radix2 53 / (1 + u_ro radix2 53) <= v.
Proof.
  assert (E : u_ro radix2 53 = v).
  { unfold u_ro, v. change (bpow radix2 (- (53) + 1)) with (/ 4503599627370496). lra. }
  rewrite E. pose proof v_value as V. apply Rmult_le_reg_r with (1 + v); [lra |].
  unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. unfold v in *. lra.
Qed.

(* A sum of two numbers doesn't underflow. *)
Lemma add64_share (x y : R) :
  format64 x -> format64 y -> Rabs (add64 g x y - (x + y)) <= v * Rabs (x + y).
Proof.
  intros X Y. unfold add64. rewrite !read64_is, gradual_fl64. unfold nearest64.
  destruct (FLT_plus_error_N_ex radix2 (-1074) 53 (fun z => negb (Z.even z)) x y X Y)
    as (e & E & ->). pose proof u_ro_value as U.
  replace ((x + y) * (1 + e) - (x + y)) with (e * (x + y)) by ring. rewrite Rabs_mult.
  apply Rmult_le_compat_r; [apply Rabs_pos | lra].
Qed.

Lemma sub64_as_add (x y : R) : sub64 g x y = add64 g x (- y).
Proof. unfold sub64, add64. now rewrite !read64_is. Qed.

Lemma sub64_share (x y : R) :
  format64 x -> format64 y -> Rabs (sub64 g x y - (x - y)) <= v * Rabs (x - y).
Proof.
  intros X Y. apply (generic_format_opp radix2) in Y. exact (add64_share x (- y) X Y).
Qed.

Lemma rounded64 (x : R) : Rabs (fl64 g x - x) <= v * Rabs x + tiny64.
Proof. apply fl64_error, gradually_valid64. Qed.

Lemma floor_exceeds : 0 < tiny64 /\ 1000000 * tiny64 <= query_floor.
Proof.
  split; [apply tiny64_value |]. unfold tiny64, query_floor.
  change (2 ^ 1022)%Z with (2 ^ 22 * 2 ^ 1000)%Z. rewrite mult_IZR, Rinv_mult, <- Rmult_assoc.
  assert (0 < / IZR (2 ^ 1000)) by (apply Rinv_0_lt_compat; now apply IZR_lt).
  assert (1000000 * / IZR (2 ^ 22) <= 1) by lra.
  rewrite <- (Rmult_1_l (/ IZR (2 ^ 1000))) at 2. apply Rmult_le_compat_r; lra.
Qed.

Lemma widened_above (s : R) :
  format64 s -> Rabs s * (7.99 * v) + query_floor / 2 <= widened s /\ format64 (widened s).
Proof.
  intro F. split; [| apply format64_result]. pose proof v_value as V.
  destruct floor_exceeds as (T0 & T). pose proof (Rabs_pos s) as P.
  unfold widened, add64, mul64. rewrite !read64_is.
  assert (P1 : 0 <= Rabs s * widening) by (apply Rmult_le_pos; unfold widening; lra).
  pose proof (rounded64 (Rabs s * widening)) as E. rewrite (Rabs_pos_eq _ P1) in E.
  apply Rabs_le_inv in E. pose proof (fl64_nonneg g _ P1) as Q.
  set (m := fl64 g (Rabs s * widening)) in *.
  pose proof (rounded64 (m + query_floor)) as E2. rewrite (Rabs_pos_eq (m + query_floor)) in E2 by lra.
  apply Rabs_le_inv in E2.
  unfold widening in *. replace (Rabs s * (8 * v)) with (8 * (v * Rabs s)) in * by ring.
  replace (Rabs s * (7.99 * v)) with (7.99 * (v * Rabs s)) by ring.
  assert (0 <= v * Rabs s) by (apply Rmult_le_pos; lra). set (k := v * Rabs s) in *.
  unfold v in *. lra.
Qed.

(* A parameter that is computed well enough lies between its earlier and its later one. *)
Lemma earlier_later (s S : R) :
  format64 s -> Rabs (s - S) <= 4.1 * v * Rabs S + 4 * tiny64 ->
  earlier s <= S <= later s.
Proof.
  intros F E. destruct (widened_above s F) as (W & Fw). pose proof v_value as V.
  destruct floor_exceeds as (T0 & T).
  pose proof (sub64_share s (widened s) F Fw) as A. pose proof (add64_share s (widened s) F Fw) as B.
  fold (earlier s) in A. fold (later s) in B. set (w := widened s) in *.
  pose proof (Rabs_triang_inv S s) as N. rewrite Rabs_minus_sym in N.
  pose proof (Rabs_pos s) as Ps.
  assert (S0 : Rabs S <= Rabs s * (1 + 5 * v) + 5 * tiny64) by (unfold v in *; lra).
  assert (Pw : 0 <= w) by (unfold v in *; lra).
  assert (A' : Rabs (s - w) <= Rabs s + w).
  { unfold Rminus. apply Rle_trans with (1 := Rabs_triang _ _). rewrite Rabs_Ropp, (Rabs_pos_eq w); lra. }
  assert (B' : Rabs (s + w) <= Rabs s + w).
  { apply Rle_trans with (1 := Rabs_triang _ _). rewrite (Rabs_pos_eq w); lra. }
  apply Rabs_le_inv in A, B, E. unfold v in *. lra.
Qed.

Lemma parameter_near (end_ at_ speed : R) :
  format64 end_ -> format64 at_ -> still <= Rabs speed <= IZR (2 ^ 200) ->
  Rabs (parameter end_ at_ (div64 g 1 speed) - (end_ - at_) / speed)
    <= 4.1 * v * Rabs ((end_ - at_) / speed) + 4 * tiny64.
Proof.
  intros Fe Fa (S0 & S1). pose proof v_value as V. destruct floor_exceeds as (T0 & _).
  assert (P : 0 < still) by (unfold still; apply Rinv_0_lt_compat; now apply IZR_lt).
  assert (N : speed <> 0) by (intros ->; rewrite Rabs_R0 in S0; lra).
  pose proof (sub64_share end_ at_ Fe Fa) as D. set (d := sub64 g end_ at_) in *.
  unfold parameter. fold d. unfold div64, mul64. rewrite !read64_is.
  pose proof (rounded64 (1 / speed)) as I.
  assert (T : tiny64 <= v / 1000000 * Rabs (1 / speed)).
  { unfold Rdiv at 2. rewrite Rmult_1_l, Rabs_inv.
    apply Rle_trans with (v / 1000000 * / IZR (2 ^ 200)).
    - unfold tiny64, v, Rdiv. rewrite <- !Rinv_mult, <- !mult_IZR.
      apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le].
    - apply Rmult_le_compat_l; [lra |]. apply Rinv_le_contravar; lra. }
  assert (I' : Rabs (fl64 g (1 / speed) - 1 / speed) <= 1.01 * v * Rabs (1 / speed))
    by (unfold v in *; lra).
  set (i := fl64 g (1 / speed)) in *. pose proof (rounded64 (d * i)) as E.
  set (X := end_ - at_) in *. set (J := 1 / speed) in *.
  replace (X / speed) with (X * J) by (unfold J; field; exact N).
  assert (Q : Rabs (d * i - X * J) <= 2.02 * v * Rabs (X * J)).
  { replace (d * i - X * J) with ((d - X) * J + X * (i - J) + (d - X) * (i - J)) by ring.
    rewrite Rabs_mult. apply Rle_trans with (1 := Rabs_triang _ _).
    pose proof (Rabs_triang ((d - X) * J) (X * (i - J))) as T2. rewrite !Rabs_mult in *.
    pose proof (Rabs_pos X) as PX. pose proof (Rabs_pos J) as PJ.
    assert (Q1 : Rabs (d - X) * Rabs J <= v * Rabs X * Rabs J) by (apply Rmult_le_compat_r; lra).
    assert (Q2 : Rabs X * Rabs (i - J) <= Rabs X * (1.01 * v * Rabs J))
      by (apply Rmult_le_compat_l; lra).
    assert (Q3 : Rabs (d - X) * Rabs (i - J) <= v * Rabs X * (1.01 * v * Rabs J))
      by (apply Rmult_le_compat; try apply Rabs_pos; assumption).
    assert (0 <= Rabs X * Rabs J) by (apply Rmult_le_pos; lra).
    replace (v * Rabs X * Rabs J) with (v * (Rabs X * Rabs J)) in Q1 by ring.
    replace (Rabs X * (1.01 * v * Rabs J)) with (1.01 * v * (Rabs X * Rabs J)) in Q2 by ring.
    replace (v * Rabs X * (1.01 * v * Rabs J)) with (v * (1.01 * v * (Rabs X * Rabs J))) in Q3 by ring.
    set (XJ := Rabs X * Rabs J) in *. unfold v in *. lra. }
  pose proof (Rabs_triang_inv (d * i) (X * J)) as N2.
  replace (fl64 g (d * i) - X * J) with ((fl64 g (d * i) - d * i) + (d * i - X * J)) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _). pose proof (Rabs_pos (X * J)). unfold v in *. lra.
Qed.

(* Wherever the line is between two ends, that parameter is crossed. *)
Theorem crossing_contains (at_ speed lo hi s : R) :
  format64 at_ -> format64 lo -> format64 hi -> Rabs speed <= IZR (2 ^ 200) ->
  0 <= s <= IZR (2 ^ 189) -> lo <= at_ + s * speed <= hi ->
  crossed_at (crossing at_ speed lo hi) s.
Proof.
  intros Fa Fl Fh B (S0 & S1) (L & H). unfold crossing.
  case Rlt_bool_spec; intro St.
  - assert (W : Rabs (s * speed) <= still_floor).
    { rewrite Rabs_mult, (Rabs_pos_eq s S0). apply Rle_trans with (IZR (2 ^ 189) * still).
      - apply Rmult_le_compat; try apply Rabs_pos; lra.
      - unfold still, still_floor. change (2 ^ 800)%Z with (2 ^ 189 * 2 ^ 611)%Z.
        rewrite mult_IZR. rewrite Rinv_mult.
        rewrite <- Rmult_assoc, Rinv_r, Rmult_1_l by now apply IZR_neq.
        apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
    apply Rabs_le_inv in W.
    assert (A : fl64 g at_ = at_).
    { rewrite gradual_fl64. apply round_generic; [typeclasses eauto | exact Fa]. }
    unfold sub64, add64. rewrite !read64_is.
    pose proof (fl64_monotone g (lo - still_floor) at_ ltac:(lra)) as M1. rewrite A in M1.
    pose proof (fl64_monotone g at_ (hi + still_floor) ltac:(lra)) as M2. rewrite A in M2.
    rewrite !Rle_bool_true by assumption. exact I.
  - assert (N : speed <> 0).
    { intros ->. rewrite Rabs_R0 in St. assert (0 < still)
        by (unfold still; apply Rinv_0_lt_compat; now apply IZR_lt). lra. }
    pose proof (parameter_near lo at_ speed Fl Fa (conj St B)) as Pl.
    pose proof (parameter_near hi at_ speed Fh Fa (conj St B)) as Ph.
    pose proof (earlier_later _ _ (format64_result _) Pl) as El.
    pose proof (earlier_later _ _ (format64_result _) Ph) as Eh.
    set (i := div64 g 1 speed) in *.
    destruct (Rlt_or_le 0 speed) as [P | P].
    + assert (Pi : 0 < i).
      { assert (Q : Rabs (i - 1 / speed) <= v * Rabs (1 / speed) + tiny64)
          by (unfold i, div64; rewrite !read64_is; apply rounded64).
        assert (J : 0 < 1 / speed) by (unfold Rdiv; rewrite Rmult_1_l; now apply Rinv_0_lt_compat).
        rewrite (Rabs_pos_eq (1 / speed)) in Q by lra. apply Rabs_le_inv in Q.
        assert (T : tiny64 <= / 2 * (1 / speed)).
        { rewrite Rabs_pos_eq in B by lra.
          apply Rle_trans with (/ 2 * (1 / IZR (2 ^ 200))).
          - unfold tiny64, Rdiv. rewrite Rmult_1_l, <- Rinv_mult.
            rewrite <- (mult_IZR 2).
            apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le].
          - apply Rmult_le_compat_l; [lra |]. unfold Rdiv. rewrite !Rmult_1_l.
            apply Rinv_le_contravar; lra. }
        pose proof v_value. unfold v in *. lra. }
      rewrite Rlt_bool_true by exact Pi. cbn [crossed_at].
      assert (Lo : (lo - at_) / speed <= s).
      { apply Rmult_le_reg_r with speed; [exact P |]. unfold Rdiv.
        rewrite Rmult_assoc, Rinv_l by exact N. lra. }
      assert (Hi : s <= (hi - at_) / speed).
      { apply Rmult_le_reg_r with speed; [exact P |]. unfold Rdiv.
        rewrite Rmult_assoc, Rinv_l by exact N. lra. }
      split; [apply Rle_trans with (2 := Lo); apply El | apply Rle_trans with (1 := Hi); apply Eh].
    + assert (P' : 0 < - speed) by lra.
      assert (Pi : i <= 0).
      { unfold i, div64. rewrite !read64_is.
        assert (J : 1 / speed <= 0).
        { replace (1 / speed) with (- (1 / - speed)) by (field; lra).
          assert (0 < 1 / - speed) by (unfold Rdiv; rewrite Rmult_1_l; now apply Rinv_0_lt_compat).
          lra. }
        rewrite <- (round_0 radix2 (FLT_exp (-1074) 53) ZnearestE), gradual_fl64.
        unfold nearest64. apply round_le; [typeclasses eauto | typeclasses eauto | exact J]. }
      rewrite Rlt_bool_false by exact Pi. cbn [crossed_at].
      assert (Lo : (hi - at_) / speed <= s).
      { replace ((hi - at_) / speed) with ((at_ - hi) / - speed) by (field; lra).
        apply Rmult_le_reg_r with (- speed); [exact P' |]. unfold Rdiv.
        rewrite Rmult_assoc, Rinv_l by lra. lra. }
      assert (Hi : s <= (lo - at_) / speed).
      { replace ((lo - at_) / speed) with ((at_ - lo) / - speed) by (field; lra).
        apply Rmult_le_reg_r with (- speed); [exact P' |]. unfold Rdiv.
        rewrite Rmult_assoc, Rinv_l by lra. lra. }
      split; [apply Rle_trans with (2 := Lo); apply Eh | apply Rle_trans with (1 := Hi); apply El].
Qed.

(* How far a coordinate is outside of an interval, at most: q is a point of it. *)
Lemma outside_near (p lo hi q : R) :
  format64 p -> format64 lo -> format64 hi -> lo <= q <= hi ->
  0 <= outside p lo hi <= Rabs (q - p) * (1 + v).
Proof.
  intros Fp Fl Fh (L & H). pose proof v_value as V. pose proof (Rabs_pos (q - p)) as P.
  unfold outside. split; [apply Rmax_r |].
  pose proof (sub64_share lo p Fl Fp) as A. pose proof (sub64_share p hi Fp Fh) as B.
  pose proof (Rle_abs (q - p)) as Q. pose proof (Rle_abs (- (q - p))) as Q'. rewrite Rabs_Ropp in Q'.
  assert (Z : forall x, x * (1 + v) <= Rabs (q - p) * (1 + v) -> True) by trivial. clear Z.
  assert (C : forall d e, Rabs (d - e) <= v * Rabs e -> e <= Rabs (q - p) ->
    d <= Rabs (q - p) * (1 + v)).
  { intros d e D E. apply Rabs_le_inv in D. destruct (Rle_or_lt 0 e) as [E0 | E0].
    - rewrite (Rabs_pos_eq e) in D by exact E0. unfold v in *. lra.
    - rewrite (Rabs_left e) in D by exact E0. assert (d <= 0) by (unfold v in *; lra).
      assert (0 <= Rabs (q - p) * (1 + v)) by (apply Rmult_le_pos; lra). lra. }
  apply Rmax_lub; [apply Rmax_lub; eapply C; eauto; lra |].
  apply Rmult_le_pos; lra.
Qed.

Lemma square64_above (x e : R) : 0 <= x <= e -> 0 <= mul64 g x x <= e * e * (1 + v) + tiny64.
Proof.
  intros (P & H). unfold mul64. rewrite !read64_is. pose proof v_value as V.
  assert (Q : 0 <= x * x <= e * e) by (split; [apply Rle_0_sqr | apply Rmult_le_compat; lra]).
  pose proof (rounded64 (x * x)) as E. rewrite (Rabs_pos_eq (x * x)) in E by apply Q. apply Rabs_le_inv in E.
  split; [apply fl64_nonneg, Q | unfold v in *; lra].
Qed.

Theorem beyond_is_certain (p lo hi q : point) (radius : R) :
  format64 (px p) -> format64 (py p) -> format64 (pz p) ->
  format64 (px lo) -> format64 (py lo) -> format64 (pz lo) ->
  format64 (px hi) -> format64 (py hi) -> format64 (pz hi) ->
  px lo <= px q <= px hi -> py lo <= py q <= py hi -> pz lo <= pz q <= pz hi ->
  0 <= radius -> distance p q <= radius -> is_beyond p lo hi radius = false.
Proof.
  intros P0 P1 P2 L0 L1 L2 H0 H1 H2 I0 I1 I2 R0 D. pose proof v_value as V.
  destruct floor_exceeds as (T0 & T).
  pose proof (outside_near _ _ _ _ P0 L0 H0 I0) as X. pose proof (outside_near _ _ _ _ P1 L1 H1 I1) as Y.
  pose proof (outside_near _ _ _ _ P2 L2 H2 I2) as Z.
  assert (Dist : square (minus q p) <= radius * radius).
  { rewrite <- norm_square. unfold distance in D. pose proof (norm_nonneg (minus q p)).
    apply Rmult_le_compat; lra. }
  unfold square, minus in Dist. cbn [px py pz] in Dist.
  apply square64_above in X, Y, Z.
  assert (Sq : forall t, Rabs t * (1 + v) * (Rabs t * (1 + v)) = t * t * ((1 + v) * (1 + v))).
  { intro t. pose proof (Rsqr_abs t) as E. unfold Rsqr in E.
    replace (Rabs t * (1 + v) * (Rabs t * (1 + v))) with (Rabs t * Rabs t * ((1 + v) * (1 + v))) by ring.
    rewrite <- E. ring. }
  rewrite Sq in X, Y, Z.
  unfold is_beyond, squared. apply Rlt_bool_false.
  set (x := mul64 g (outside (px p) _ _) _) in *. set (y := mul64 g (outside (py p) _ _) _) in *.
  set (z := mul64 g (outside (pz p) _ _) _) in *.
  set (dx := (px q - px p) * (px q - px p)) in *. set (dy := (py q - py p) * (py q - py p)) in *.
  set (dz := (pz q - pz p) * (pz q - pz p)) in *.
  assert (Qx : 0 <= dx) by apply Rle_0_sqr. assert (Qy : 0 <= dy) by apply Rle_0_sqr.
  assert (Qz : 0 <= dz) by apply Rle_0_sqr.
  assert (Add : forall a b, 0 <= a -> 0 <= b -> 0 <= add64 g a b <= (a + b) * (1 + v) + tiny64).
  { intros a b A B. unfold add64. rewrite !read64_is. pose proof (rounded64 (a + b)) as E.
    rewrite (Rabs_pos_eq (a + b)) in E by lra. apply Rabs_le_inv in E. split; [apply fl64_nonneg |]; lra. }
  pose proof (Add x y (proj1 X) (proj1 Y)) as XY. pose proof (Add _ z (proj1 XY) (proj1 Z)) as XYZ.
  apply Rle_trans with (1 := proj2 XYZ).
  assert (Left : (add64 g x y + z) * (1 + v) + tiny64
    <= (dx + dy + dz) * (1 + 5.01 * v) + 10 * tiny64) by (unfold v in *; lra).
  apply Rle_trans with (1 := Left).
  (* The other side. *)
  set (r := radius * radius) in *. assert (Pr : 0 <= r) by apply Rle_0_sqr.
  assert (W : r * (1 - v) - tiny64 <= mul64 g radius radius /\ 0 <= mul64 g radius radius
    /\ format64 (mul64 g radius radius)).
  { unfold mul64. rewrite !read64_is. fold r. pose proof (rounded64 r) as E.
    rewrite (Rabs_pos_eq r) in E by exact Pr. apply Rabs_le_inv in E.
    split; [lra |]. split; [now apply fl64_nonneg | apply format64_result]. }
  destruct W as (W0 & W1 & W2). set (w := mul64 g radius radius) in *.
  destruct (widened_above w W2) as (W3 & W4). rewrite Rabs_pos_eq in W3 by exact W1.
  pose proof (add64_share w (widened w) W2 W4) as E.
  assert (Pw : 0 <= widened w) by (assert (0 <= w * (7.99 * v)) by (apply Rmult_le_pos; lra); lra).
  rewrite (Rabs_pos_eq (w + widened w)) in E by lra. apply Rabs_le_inv in E.
  set (ww := widened w) in *. unfold v in *. lra.
Qed.
