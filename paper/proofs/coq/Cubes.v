(* Theorem G: cubes about boxes lose no pair of boxes that meet, and what they take to meet without
   a
   look at the boxes' ends does. With gradual underflow. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double WorldBall Ieee Shows Outward Finder.
Open Scope R_scope.

(* src/rounding/cube.rs: WIDER, NARROWER, FLOOR: 1 + 16u, 1 - 16u and the f32 next to 10^-30 *)
Definition wider : R := 1 + 16 * u.
Definition narrower : R := 1 - 16 * u.
Definition cube_floor : R := nearest32 (/ IZR (10 ^ 30)).

Lemma cube_floor_value : 1000 * half_step <= cube_floor.
Proof.
  unfold cube_floor.
  assert (F : bpow radix2 (-140) = nearest32 (bpow radix2 (-140))).
  { symmetry. apply round_generic; [typeclasses eauto |]. apply generic_format_FLT_bpow.
    - typeclasses eauto.
    - lia. }
  apply Rle_trans with (bpow radix2 (-140)).
  - unfold half_step. change (bpow radix2 (-140)) with (/ IZR (2 ^ 140)).
    change (2 ^ 150)%Z with (1024 * 2 ^ 140)%Z. rewrite mult_IZR, Rinv_mult.
    assert (0 < / IZR (2 ^ 140)) by (apply Rinv_0_lt_compat; now apply IZR_lt). lra.
  - rewrite F. unfold nearest32. apply round_le; [typeclasses eauto | typeclasses eauto |].
    change (bpow radix2 (-140)) with (/ IZR (2 ^ 140)).
    assert (A : 0 < IZR (10 ^ 30)) by (apply IZR_lt; reflexivity).
    assert (B : IZR (10 ^ 30) <= IZR (2 ^ 140)) by (apply IZR_le; vm_compute; discriminate).
    exact (Rinv_le_contravar _ _ A B).
Qed.

(* A sixteenth is exact but for underflow, and so is twice a number. *)
Lemma sixteenth_near (x : R) :
  format32 x -> Rabs (nearest32 (x * / 16) - x * / 16) <= half_step.
Proof.
  intro F. pose proof (proj1 half_step_value) as H0.
  apply FLT_format_generic in F; [| typeclasses eauto]. destruct F as [[n e] E N L]. cbn in N, L.
  assert (S : x * / 16 = F2R (Float radix2 n (e - 4))).
  { rewrite E. unfold F2R. cbn [Fnum Fexp]. unfold Zminus. rewrite bpow_plus.
    change (bpow radix2 (- (4))) with (/ 16). ring. }
  destruct (Z_le_gt_dec (-149) (e - 4)) as [G | G].
  - unfold nearest32. rewrite round_generic.
    + rewrite Rminus_diag_eq, Rabs_R0 by reflexivity. lra.
    + typeclasses eauto.
    + rewrite S. apply generic_format_FLT.
      exists (Float radix2 n (e - 4)); [reflexivity | |]; assumption.
  - pose proof (error_le_half_ulp radix2 (FLT_exp (-149) 24) (fun z => negb (Z.even z)) (x * / 16))
      as H.
    unfold nearest32. apply Rle_trans with (1 := H). rewrite ulp_FLT_small.
    + unfold half_step. change (bpow radix2 (-149)) with (/ IZR (2 ^ 149)).
      change (2 ^ 150)%Z with (2 * 2 ^ 149)%Z. rewrite mult_IZR, Rinv_mult. lra.
    + typeclasses eauto.
    + rewrite S. apply Rlt_le_trans with (bpow radix2 (24 + (e - 4))).
      * unfold F2R. cbn [Fnum Fexp]. rewrite Rabs_mult, (Rabs_pos_eq (bpow _ _)) by apply bpow_ge_0.
        rewrite bpow_plus. apply Rmult_lt_compat_r; [apply bpow_gt_0 |].
        rewrite <- abs_IZR. change (bpow radix2 24) with (IZR (2 ^ 24)). now apply IZR_lt.
      * apply bpow_le. lia.
Qed.

Lemma twice_exact (x : R) : nearest32 (nearest32 x + nearest32 x) = nearest32 x + nearest32 x.
Proof.
  apply round_generic; [typeclasses eauto |].
  assert (F : format32 (nearest32 x)) by (apply generic_format_round; typeclasses eauto).
  apply FLT_format_generic in F; [| typeclasses eauto]. destruct F as [[n e] E N L]. cbn in N, L.
  apply generic_format_FLT. exists (Float radix2 n (e + 1)); cbn [Fnum Fexp]; [| exact N | lia].
  rewrite E. unfold F2R. cbn [Fnum Fexp]. rewrite bpow_plus. change (bpow radix2 1) with 2. ring.
Qed.

(* src/rounding/cube.rs: Cube::about, one axis: the centre, and how far the two ends are from it, an
   eighth in size. *)
Definition centre_of (lower upper : R) : R :=
  add gradual (mul gradual lower (/ 16)) (mul gradual upper (/ 16)).
Definition below_of (lower upper : R) : R :=
  let lo := mul gradual lower (/ 16) in sub gradual (centre_of lower upper) (add gradual lo lo).
Definition above_of (lower upper : R) : R :=
  let hi := mul gradual upper (/ 16) in sub gradual (add gradual hi hi) (centre_of lower upper).

Lemma nearest32_monotone (x y : R) : x <= y -> nearest32 x <= nearest32 y.
Proof. intro H. unfold nearest32.
apply round_le; [typeclasses eauto | typeclasses eauto | exact H]. Qed.

Lemma extents_near (lower upper : R) :
  format32 lower -> format32 upper -> lower <= upper ->
  let below := centre_of lower upper - lower / 8 in
  let above := upper / 8 - centre_of lower upper in
  - 2 * half_step <= below /\ - 2 * half_step <= above /\
  Rabs (below_of lower upper - below) <= u * below + 4 * half_step /\
  Rabs (above_of lower upper - above) <= u * above + 4 * half_step.
Proof.
  intros Fl Fu Le. pose proof (proj1 half_step_value) as H0.
  pose proof (sixteenth_near lower Fl) as A. pose proof (sixteenth_near upper Fu) as B.
  unfold below_of, above_of, centre_of. rewrite !gradual_add, !gradual_sub, !gradual_mul.
  pose proof (nearest32_monotone (lower * / 16) (upper * / 16) ltac:(lra)) as M.
  pose proof (twice_exact (lower * / 16)) as TL. pose proof (twice_exact (upper * / 16)) as TU.
  rewrite TL, TU.
  set (lo := nearest32 (lower * / 16)) in *. set (hi := nearest32 (upper * / 16)) in *.
  pose proof (nearest32_monotone (lo + lo) (lo + hi) ltac:(lra)) as CL. rewrite TL in CL.
  pose proof (nearest32_monotone (lo + hi) (hi + hi) ltac:(lra)) as CU. rewrite TU in CU.
  set (c := nearest32 (lo + hi)) in *.
  pose proof (nearest32_error (c - (lo + lo))) as EL.
  rewrite (Rabs_pos_eq (c - (lo + lo))) in EL by lra.
  pose proof (nearest32_error (hi + hi - c)) as EU.
  rewrite (Rabs_pos_eq (hi + hi - c)) in EU by lra.
  cbv zeta. apply Rabs_le_inv in A, B, EL, EU.
  assert (U : 0 < u < / 10) by (unfold u; lra).
  repeat split; [lra | lra | |]; apply Rabs_le; unfold u in *; lra.
Qed.

(* The cube about a box, and the least of its extents. *)
Record box := { lower : point; upper : point }.
Definition sound_box (b : box) : Prop :=
  (format32 (px (lower b)) /\ format32 (px (upper b)) /\ px (lower b) <= px (upper b)) /\
  (format32 (py (lower b)) /\ format32 (py (upper b)) /\ py (lower b) <= py (upper b)) /\
  (format32 (pz (lower b)) /\ format32 (pz (upper b)) /\ pz (lower b) <= pz (upper b)).
Definition of_axes (f : R -> R -> R) (b : box) : point :=
  {| px := f (px (lower b)) (px (upper b)); py := f (py (lower b)) (py (upper b));
     pz := f (pz (lower b)) (pz (upper b)) |}.
Definition middle_of (b : box) : point := of_axes centre_of b.
Definition widest (b : box) : R :=
  let ends := of_axes (fun lo hi => Rmax (below_of lo hi) (above_of lo hi)) b in
  Rmax (Rmax (Rmax 0 (px ends)) (py ends)) (pz ends).
Definition narrowest (b : box) : R :=
  let ends := of_axes (fun lo hi => Rmin (below_of lo hi) (above_of lo hi)) b in
  Rmin (Rmin (px ends) (py ends)) (pz ends).
Definition half_side (b : box) : R := add gradual (mul gradual (widest b) wider) cube_floor.
Definition gap_of (b : box) : R := sub gradual (half_side b) (narrowest b).

(* src/rounding/cube.rs: apart, less_than_sure, sure; src/boxes/cube_test.rs: CubeTest::apart,
   CubeTest::touching *)
Definition way (a b : box) : point :=
  let f x y := sub gradual x y in
  {| px := f (px (middle_of b)) (px (middle_of a)); py := f (py (middle_of b)) (py (middle_of a));
     pz := f (pz (middle_of b)) (pz (middle_of a)) |}.
Definition beyond (d : point) (distance : R) : bool :=
  greater gradual (Rmax (Rmax (Rabs (px d)) (Rabs (py d))) (Rabs (pz d))) distance.
Definition less_than_sure (gap : R) : R :=
  add gradual (mul gradual (mul gradual 2 gap) wider) (mul gradual 2 cube_floor).
Definition sure (reach less : R) : R := sub gradual (mul gradual reach narrower) less.

Definition boxes_meet (a b : box) : Prop :=
  (px (lower a) <= px (upper b) /\ px (lower b) <= px (upper a)) /\
  (py (lower a) <= py (upper b) /\ py (lower b) <= py (upper a)) /\
  (pz (lower a) <= pz (upper b) /\ pz (lower b) <= pz (upper a)).

Lemma widest_above (b : box) :
  0 <= widest b /\
  (below_of (px (lower b)) (px (upper b)) <= widest b /\
   above_of (px (lower b)) (px (upper b)) <= widest b) /\
  (below_of (py (lower b)) (py (upper b)) <= widest b /\
   above_of (py (lower b)) (py (upper b)) <= widest b) /\
  (below_of (pz (lower b)) (pz (upper b)) <= widest b /\
   above_of (pz (lower b)) (pz (upper b)) <= widest b).
Proof.
  unfold widest, of_axes. cbn [px py pz].
  set (x := below_of (px _) _). set (x' := above_of (px _) _).
  set (y := below_of (py _) _). set (y' := above_of (py _) _).
  set (z := below_of (pz _) _). set (z' := above_of (pz _) _).
  pose proof (Rmax_l x x'). pose proof (Rmax_r x x'). pose proof (Rmax_l y y').
  pose proof (Rmax_r y y'). pose proof (Rmax_l z z'). pose proof (Rmax_r z z').
  pose proof (Rmax_l 0 (Rmax x x')). pose proof (Rmax_r 0 (Rmax x x')).
  pose proof (Rmax_l (Rmax 0 (Rmax x x')) (Rmax y y')).
  pose proof (Rmax_r (Rmax 0 (Rmax x x')) (Rmax y y')).
  pose proof (Rmax_l (Rmax (Rmax 0 (Rmax x x')) (Rmax y y')) (Rmax z z')).
  pose proof (Rmax_r (Rmax (Rmax 0 (Rmax x x')) (Rmax y y')) (Rmax z z')). repeat split; lra.
Qed.

Lemma half_side_above (b : box) :
  0 <= half_side b /\ widest b * (1 + 13 * u) + 900 * half_step <= half_side b.
Proof.
  pose proof (proj1 (widest_above b)) as W. pose proof cube_floor_value as F.
  pose proof (proj1 half_step_value) as H0. unfold half_side, wider.
  rewrite gradual_add, gradual_mul. set (w := widest b) in *.
  assert (P : 0 <= w * (1 + 16 * u)) by (apply Rmult_le_pos; unfold u; lra).
  pose proof (nearest32_below _ P) as A. pose proof (nearest32_nonneg _ P) as A0.
  set (q := nearest32 (w * (1 + 16 * u))) in *.
  assert (Q : 0 <= q + cube_floor) by lra.
  pose proof (nearest32_below _ Q) as B. pose proof (nearest32_nonneg _ Q) as B0.
  split; [exact B0 |]. unfold u in *. lra.
Qed.

(* Cubes lose none: along an axis on which boxes meet, centres are no farther apart than the sum of
   the half sides, as computed. *)
Lemma axis_near (la ua lb ub Ha Hb wa wb : R) :
  format32 la -> format32 ua -> la <= ua -> format32 lb -> format32 ub -> lb <= ub ->
  below_of la ua <= wa -> above_of la ua <= wa -> below_of lb ub <= wb -> above_of lb ub <= wb ->
  0 <= wa -> 0 <= wb -> wa * (1 + 13 * u) + 900 * half_step <= Ha ->
  wb * (1 + 13 * u) + 900 * half_step <= Hb ->
  la <= ub -> lb <= ua ->
  Rabs (sub gradual (centre_of lb ub) (centre_of la ua)) <= add gradual Ha Hb.
Proof.
  intros Fla Fua Oa Flb Fub Ob Ba Aa Bb Ab Pa Pb Wa Wb M N.
  destruct (extents_near la ua Fla Fua Oa) as (_ & _ & E1 & E2).
  destruct (extents_near lb ub Flb Fub Ob) as (_ & _ & E3 & E4). cbv zeta in *.
  pose proof (proj1 half_step_value) as H0.
  set (ca := centre_of la ua) in *. set (cb := centre_of lb ub) in *.
  set (ba := below_of la ua) in *. set (aa := above_of la ua) in *.
  set (bb := below_of lb ub) in *. set (ab := above_of lb ub) in *.
  apply Rabs_le_inv in E1, E2, E3, E4.
  assert (D : Rabs (cb - ca) <= (wa + wb) * (1 + 2 * u) + 20 * half_step)
    by (apply Rabs_le; unfold u in *; lra).
  rewrite gradual_sub, gradual_add.
  pose proof (nearest32_error (cb - ca)) as E.
  pose proof (Rabs_triang_inv (nearest32 (cb - ca)) (cb - ca)) as T.
  assert (S : 0 <= Ha + Hb) by (unfold u in *; lra).
  pose proof (nearest32_below _ S) as L. unfold u in *. lra.
Qed.

Theorem cubes_lose_none (a b : box) :
  sound_box a -> sound_box b -> boxes_meet a b ->
  beyond (way a b) (add gradual (half_side a) (half_side b)) = false.
Proof.
  intros (Xa & Ya & Za) (Xb & Yb & Zb) (X & Y & Z).
  destruct (widest_above a) as (Wa & (Xa1 & Xa2) & (Ya1 & Ya2) & (Za1 & Za2)).
  destruct (widest_above b) as (Wb & (Xb1 & Xb2) & (Yb1 & Yb2) & (Zb1 & Zb2)).
  destruct (half_side_above a) as (_ & Ha). destruct (half_side_above b) as (_ & Hb).
  destruct Xa as (A1 & A2 & A3), Ya as (A4 & A5 & A6), Za as (A7 & A8 & A9).
  destruct Xb as (B1 & B2 & B3), Yb as (B4 & B5 & B6), Zb as (B7 & B8 & B9).
  destruct X as (X1 & X2), Y as (Y1 & Y2), Z as (Z1 & Z2).
  pose proof (axis_near _ _ _ _ _ _ _ _ A1 A2 A3 B1 B2 B3 Xa1 Xa2 Xb1 Xb2 Wa Wb Ha Hb X1 X2) as P.
  pose proof (axis_near _ _ _ _ _ _ _ _ A4 A5 A6 B4 B5 B6 Ya1 Ya2 Yb1 Yb2 Wa Wb Ha Hb Y1 Y2) as Q.
  pose proof (axis_near _ _ _ _ _ _ _ _ A7 A8 A9 B7 B8 B9 Za1 Za2 Zb1 Zb2 Wa Wb Ha Hb Z1 Z2) as R.
  unfold beyond, way, middle_of, of_axes. cbn [px py pz]. apply Rlt_bool_false.
  rewrite !read_is. repeat apply Rmax_lub; assumption.
Qed.

(* Cubes add none: boxes whose centres are that near meet. *)
Lemma axis_meets (la ua lb ub Ha Hb na nb g : R) :
  format32 la -> format32 ua -> la <= ua -> format32 lb -> format32 ub -> lb <= ub ->
  na <= below_of la ua <= Ha -> na <= above_of la ua <= Ha ->
  nb <= below_of lb ub <= Hb -> nb <= above_of lb ub <= Hb ->
  0 <= Ha -> 0 <= Hb -> 0 <= g -> sub gradual Ha na <= g -> sub gradual Hb nb <= g -> na <= Ha -> nb
    <= Hb ->
  Rabs (sub gradual (centre_of lb ub) (centre_of la ua))
    <= sure (add gradual Ha Hb) (less_than_sure g) ->
  la <= ub /\ lb <= ua.
Proof.
  intros Fla Fua Oa Flb Fub Ob (Ba & Ba') (Aa & Aa') (Bb & Bb') (Ab & Ab') Pa Pb Pg Ga Gb Na Nb S.
  destruct (extents_near la ua Fla Fua Oa) as (_ & _ & E1 & E2).
  destruct (extents_near lb ub Flb Fub Ob) as (_ & _ & E3 & E4). cbv zeta in *.
  pose proof (proj1 half_step_value) as H0. pose proof cube_floor_value as Fl.
  set (ca := centre_of la ua) in *. set (cb := centre_of lb ub) in *.
  set (ba := below_of la ua) in *. set (aa := above_of la ua) in *.
  set (bb := below_of lb ub) in *. set (ab := above_of lb ub) in *.
  apply Rabs_le_inv in E1, E2, E3, E4.
  (* What is left of the extents. *)
  rewrite gradual_sub in Ga, Gb.
  pose proof (nearest32_below (Ha - na) ltac:(lra)) as Ka.
  pose proof (nearest32_below (Hb - nb) ltac:(lra)) as Kb.
  (* The distance. *)
  unfold sure, less_than_sure, wider, narrower in S.
  rewrite !gradual_sub, !gradual_add, !gradual_mul in S.
  pose proof (nearest32_above (Ha + Hb) ltac:(lra)) as R1.
  pose proof (nearest32_nonneg (Ha + Hb) ltac:(lra)) as R0.
  set (reach := nearest32 (Ha + Hb)) in *.
  assert (P2 : 0 <= reach * (1 - 16 * u)) by (apply Rmult_le_pos; unfold u; lra).
  pose proof (nearest32_above _ P2) as R2. set (reach' := nearest32 (reach * (1 - 16 * u))) in *.
  pose proof (nearest32_below (2 * g) ltac:(lra)) as L1.
  pose proof (nearest32_nonneg (2 * g) ltac:(lra)) as L0. set (g2 := nearest32 (2 * g)) in *.
  assert (P3 : 0 <= g2 * (1 + 16 * u)) by (apply Rmult_le_pos; unfold u; lra).
  pose proof (nearest32_below _ P3) as L2. pose proof (nearest32_nonneg _ P3) as L3.
  set (g3 := nearest32 (g2 * (1 + 16 * u))) in *.
  pose proof (nearest32_below (2 * cube_floor) ltac:(lra)) as L4.
  pose proof (nearest32_nonneg (2 * cube_floor) ltac:(lra)) as L5.
  set (f2 := nearest32 (2 * cube_floor)) in *.
  pose proof (nearest32_below (g3 + f2) ltac:(lra)) as L6. set (less := nearest32 (g3 + f2)) in *.
  pose proof (nearest32_error (reach' - less)) as E5. set (near := nearest32 (reach' - less)) in *.
  pose proof (nearest32_error (cb - ca)) as E6.
  pose proof (Rabs_triang_inv (cb - ca) (nearest32 (cb - ca))) as T6.
  rewrite (Rabs_minus_sym (cb - ca)) in T6. pose proof (Rabs_pos (nearest32 (cb - ca))) as N0.
  assert (X : Rabs (reach' - less) <= (reach' - less) + 4 * half_step).
  { destruct (Rle_or_lt 0 (reach' - less)) as [Y | Y].
    - rewrite Rabs_pos_eq by exact Y. lra.
    - rewrite (Rabs_left _ Y) in E5 |- *. apply Rabs_le_inv in E5. unfold u in *. lra. }
  apply Rabs_le_inv in E5.
  assert (D : Rabs (cb - ca) <= (Ha + Hb) * (1 - 3 * u) - 2 * g * (1 + 3 * u) - 500 * half_step).
  { unfold u in *. lra. }
  apply Rabs_le_inv in D. unfold u in *. lra.
Qed.

Lemma narrowest_below (b : box) :
  (narrowest b <= below_of (px (lower b)) (px (upper b)) /\
   narrowest b <= above_of (px (lower b)) (px (upper b))) /\
  (narrowest b <= below_of (py (lower b)) (py (upper b)) /\
   narrowest b <= above_of (py (lower b)) (py (upper b))) /\
  (narrowest b <= below_of (pz (lower b)) (pz (upper b)) /\
   narrowest b <= above_of (pz (lower b)) (pz (upper b))).
Proof.
  unfold narrowest, of_axes. cbn [px py pz].
  set (x := below_of (px _) _). set (x' := above_of (px _) _).
  set (y := below_of (py _) _). set (y' := above_of (py _) _).
  set (z := below_of (pz _) _). set (z' := above_of (pz _) _).
  pose proof (Rmin_l x x'). pose proof (Rmin_r x x'). pose proof (Rmin_l y y').
  pose proof (Rmin_r y y'). pose proof (Rmin_l z z'). pose proof (Rmin_r z z').
  pose proof (Rmin_l (Rmin x x') (Rmin y y')). pose proof (Rmin_r (Rmin x x') (Rmin y y')).
  pose proof (Rmin_l (Rmin (Rmin x x') (Rmin y y')) (Rmin z z')).
  pose proof (Rmin_r (Rmin (Rmin x x') (Rmin y y')) (Rmin z z')). repeat split; lra.
Qed.

Theorem cubes_add_none (a b : box) (g : R) :
  sound_box a -> sound_box b -> gap_of a <= g -> gap_of b <= g ->
  beyond (way a b) (sure (add gradual (half_side a) (half_side b)) (less_than_sure g)) = false ->
  boxes_meet a b.
Proof.
  intros (Xa & Ya & Za) (Xb & Yb & Zb) Ga Gb S.
  destruct (widest_above a) as (Wa & (Xa1 & Xa2) & (Ya1 & Ya2) & (Za1 & Za2)).
  destruct (widest_above b) as (Wb & (Xb1 & Xb2) & (Yb1 & Yb2) & (Zb1 & Zb2)).
  destruct (half_side_above a) as (Pa & Ha). destruct (half_side_above b) as (Pb & Hb).
  destruct (narrowest_below a) as ((Na1 & Na2) & (Na3 & Na4) & (Na5 & Na6)).
  destruct (narrowest_below b) as ((Nb1 & Nb2) & (Nb3 & Nb4) & (Nb5 & Nb6)).
  pose proof (proj1 half_step_value) as H0.
  assert (Sa : widest a <= half_side a) by (unfold u in *; lra).
  assert (Sb : widest b <= half_side b) by (unfold u in *; lra).
  assert (Pg : 0 <= g).
  { apply Rle_trans with (2 := Ga). unfold gap_of. rewrite gradual_sub.
    apply nearest32_nonneg. lra. }
  destruct Xa as (A1 & A2 & A3), Ya as (A4 & A5 & A6), Za as (A7 & A8 & A9).
  destruct Xb as (B1 & B2 & B3), Yb as (B4 & B5 & B6), Zb as (B7 & B8 & B9).
  unfold beyond, greater in S. rewrite !read_is in S. revert S.
  case Rlt_bool_spec; [discriminate |]. intros S _.
  unfold way, middle_of, of_axes in S. cbn [px py pz] in S.
  pose proof (Rle_trans _ _ _ (Rmax_r _ _) S) as Sz.
  pose proof (Rle_trans _ _ _ (Rmax_l _ _) S) as Sxy.
  pose proof (Rle_trans _ _ _ (Rmax_r _ _) Sxy) as Sy.
  pose proof (Rle_trans _ _ _ (Rmax_l _ _) Sxy) as Sx.
  assert (Na : narrowest a <= half_side a) by lra.
  assert (Nb : narrowest b <= half_side b) by lra.
  split; [| split].
  - exact (axis_meets _ _ _ _ _ _ _ _ g A1 A2 A3 B1 B2 B3
      (conj Na1 (Rle_trans _ _ _ Xa1 Sa)) (conj Na2 (Rle_trans _ _ _ Xa2 Sa))
      (conj Nb1 (Rle_trans _ _ _ Xb1 Sb)) (conj Nb2 (Rle_trans _ _ _ Xb2 Sb)) Pa Pb Pg Ga Gb Na Nb
        Sx).
  - exact (axis_meets _ _ _ _ _ _ _ _ g A4 A5 A6 B4 B5 B6
      (conj Na3 (Rle_trans _ _ _ Ya1 Sa)) (conj Na4 (Rle_trans _ _ _ Ya2 Sa))
      (conj Nb3 (Rle_trans _ _ _ Yb1 Sb)) (conj Nb4 (Rle_trans _ _ _ Yb2 Sb)) Pa Pb Pg Ga Gb Na Nb
        Sy).
  - exact (axis_meets _ _ _ _ _ _ _ _ g A7 A8 A9 B7 B8 B9
      (conj Na5 (Rle_trans _ _ _ Za1 Sa)) (conj Na6 (Rle_trans _ _ _ Za2 Sa))
      (conj Nb5 (Rle_trans _ _ _ Zb1 Sb)) (conj Nb6 (Rle_trans _ _ _ Zb2 Sb)) Pa Pb Pg Ga Gb Na Nb
        Sz).
Qed.
