(* Theorem T: a body's place about a local origin is no farther from the exact one than its margin
   grows by. Theorem M for slabs: those that are moved out contain what lies within a margin. With
   gradual underflow. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Ieee Shows Outward Finder Duality Vectors.
Open Scope R_scope.

(* src/world/region.rs: MOVED, MOVED_BEFORE, MOVED_LEAST: 2^-23, 2^-52 and 2^-149. *)
Definition moved_share : R := 2 * u.
Definition moved_before : R := 2 * v.
Definition moved_least : R := 2 * half_step.

(* src/world/region.rs: Region::place, one axis: the two differences, and the f32 of the second. *)
Definition from_origin (t o : R) : R := sub64 gradual64 t o.
Definition from_corner (t o c : R) : R := sub64 gradual64 (from_origin t o) c.
Definition local (t o c : R) : R := fl gradual (from_corner t o c).

(* An operation's error as a share of its result. *)
Lemma error_of_result (x : R) :
  Rabs (fl64 gradual64 x - x) <= v * Rabs (fl64 gradual64 x) + tiny64.
Proof.
  rewrite gradual_fl64. unfold nearest64.
  pose proof (error_le_half_ulp_round radix2 (FLT_exp (-1074) 53) (fun z => negb (Z.even z)) x) as E.
  fold (nearest64 x) in *. apply Rle_trans with (1 := E).
  destruct (Req_dec (nearest64 x) 0) as [Z | N].
  - rewrite Z, ulp_FLT_small.
    + rewrite Rabs_R0, Rmult_0_r, Rplus_0_l. change tiny64 with (/ IZR (2 ^ 1022)).
      change (/ IZR (2 ^ 1022)) with (bpow radix2 (-1022)).
      pose proof (bpow_gt_0 radix2 (-1074)). pose proof (bpow_le radix2 (-1074) (-1022) ltac:(lia)). lra.
    + typeclasses eauto.
    + rewrite Rabs_R0. apply bpow_gt_0.
  - pose proof (ulp_FLT_le radix2 (-1074) 53 (nearest64 x)) as U.
    destruct (Rle_or_lt (bpow radix2 (-1074 + 53 - 1)) (Rabs (nearest64 x))) as [L | L].
    + specialize (U L). change (bpow radix2 (1 - 53)) with (/ 4503599627370496) in U.
      pose proof (proj1 tiny64_value). unfold v. lra.
    + rewrite ulp_FLT_small; [| typeclasses eauto |].
      * pose proof (Rabs_pos (nearest64 x)). change tiny64 with (/ IZR (2 ^ 1022)).
        change (/ IZR (2 ^ 1022)) with (bpow radix2 (-1022)).
        pose proof (bpow_gt_0 radix2 (-1074)).
        pose proof (bpow_le radix2 (-1074) (-1022) ltac:(lia)).
        assert (0 <= v * Rabs (nearest64 x)) by (apply Rmult_le_pos; [unfold v; lra | lra]). lra.
      * apply Rlt_le_trans with (1 := L). apply bpow_le. lia.
Qed.

Lemma local_error (t o c : R) :
  Rabs (local t o c - (t - o - c))
    <= v * Rabs (from_origin t o) + (u + v) * Rabs (from_corner t o c) + half_step + 2 * tiny64.
Proof.
  unfold local. rewrite gradual_fl.
  pose proof (nearest32_error (from_corner t o c)) as A.
  pose proof (error_of_result (from_origin t o - c)) as B.
  pose proof (error_of_result (t - o)) as C.
  fold (from_corner t o c) in B. fold (from_origin t o) in C.
  change (fl64 gradual64 (from_origin t o - c)) with (from_corner t o c) in B.
  change (fl64 gradual64 (t - o)) with (from_origin t o) in C.
  replace (nearest32 (from_corner t o c) - (t - o - c))
    with ((nearest32 (from_corner t o c) - from_corner t o c)
      + ((from_corner t o c - (from_origin t o - c)) + (from_origin t o - (t - o)))) by ring.
  apply Rle_trans with (1 := Rabs_triang _ _).
  pose proof (Rabs_triang (from_corner t o c - (from_origin t o - c)) (from_origin t o - (t - o))).
  lra.
Qed.

(* What joins the margin, of the largest differences along the axes. *)
Definition moved_by (near far : R) : R :=
  add64 gradual64 (add64 gradual64 (mul64 gradual64 near moved_share)
    (mul64 gradual64 far moved_before)) moved_least.

Theorem place_within_moved (t o c : point) (near far : R) :
  0 <= near <= IZR (2 ^ 200) -> 0 <= far <= IZR (2 ^ 200) ->
  within far (pt (from_origin (px t) (px o)) (from_origin (py t) (py o))
    (from_origin (pz t) (pz o))) ->
  within near (pt (from_corner (px t) (px o) (px c)) (from_corner (py t) (py o) (py c))
    (from_corner (pz t) (pz o) (pz c))) ->
  distance (minus (minus t o) c)
    (pt (local (px t) (px o) (px c)) (local (py t) (py o) (py c)) (local (pz t) (pz o) (pz c)))
    <= moved_by near far.
Proof.
  intros (Hn & Bn) (Hf & Bf) (Fx & Fy & Fz) (Nx & Ny & Nz).
  cbn [pt px py pz] in Fx, Fy, Fz, Nx, Ny, Nz.
  pose proof v_value as V. pose proof (proj1 half_step_value) as H0.
  assert (T : 0 < tiny64 <= half_step / 1000000).
  { split; [apply tiny64_value |]. unfold tiny64, half_step, Rdiv.
    rewrite <- Rinv_mult, <- mult_IZR.
    apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
  set (e := v * far + (u + v) * near + half_step + 2 * tiny64).
  assert (Axis : forall a b d, Rabs (from_origin a b) <= far -> Rabs (from_corner a b d) <= near ->
    Rabs (local a b d - (a - b - d)) <= e).
  { intros a b d A B. apply Rle_trans with (1 := local_error a b d).
    assert (v * Rabs (from_origin a b) <= v * far) by (apply Rmult_le_compat_l; lra).
    assert ((u + v) * Rabs (from_corner a b d) <= (u + v) * near)
      by (apply Rmult_le_compat_l; [unfold u; lra | exact B]).
    unfold e. lra. }
  unfold distance. apply Rle_trans with (1.73206 * e).
  { apply norm_of_coordinates. unfold minus, pt, within. cbn [px py pz].
    repeat split; apply Axis; assumption. }
  pose proof (fun x => fl64_error gradual64 gradually_valid64 x) as E.
  assert (Pn : 0 <= near * moved_share) by (apply Rmult_le_pos; unfold moved_share, u; lra).
  assert (Pf : 0 <= far * moved_before) by (apply Rmult_le_pos; unfold moved_before; lra).
  unfold moved_by, add64, mul64. rewrite !read64_is.
  pose proof (E (near * moved_share)) as E1. rewrite (Rabs_pos_eq _ Pn) in E1.
  pose proof (E (far * moved_before)) as E2. rewrite (Rabs_pos_eq _ Pf) in E2.
  apply Rabs_le_inv in E1, E2.
  pose proof (fl64_nonneg gradual64 _ Pn) as Q1. pose proof (fl64_nonneg gradual64 _ Pf) as Q2.
  set (a := fl64 gradual64 (near * moved_share)) in *.
  set (b := fl64 gradual64 (far * moved_before)) in *.
  assert (Pab : 0 <= a + b) by lra.
  pose proof (E (a + b)) as E3. rewrite (Rabs_pos_eq _ Pab) in E3. apply Rabs_le_inv in E3.
  pose proof (fl64_nonneg gradual64 _ Pab) as Q3. set (ab := fl64 gradual64 (a + b)) in *.
  assert (Pl : 0 <= ab + moved_least) by (unfold moved_least; lra).
  pose proof (E (ab + moved_least)) as E4. rewrite (Rabs_pos_eq _ Pl) in E4.
  apply Rabs_le_inv in E4. set (all := fl64 gradual64 (ab + moved_least)) in *.
  clear E. unfold e, moved_share, moved_before, moved_least in *. clearbody a b ab all.
  unfold u, v in *. lra.
Qed.

(* Where no step loses anything the place is the exact one. *)
Lemma exact_place (t o c : R) :
  from_origin t o = t - o -> from_corner t o c = from_origin t o - c ->
  local t o c = from_corner t o c -> local t o c = t - o - c.
Proof. intros A B C. rewrite C, B, A. reflexivity. Qed.

(* src/volume/ordop.rs: OrDop::grown, one end. The length of a direction is computed with a relative
   error of less than 2^-45. *)
Definition slab_factor : R := 1 + / 1099511627776.
Definition grown_end (hi margin length : R) : R :=
  next_above (add64 gradual64 hi (mul64 gradual64 (mul64 gradual64 margin length) slab_factor)).

Theorem slab_with_margin (d p q : point) (hi margin length : R) :
  dot d p <= hi -> distance p q <= margin ->
  norm d * (1 - / 35184372088832) <= length <= big -> / IZR (2 ^ 200) <= norm d ->
  / IZR (2 ^ 150) <= margin <= big ->
  dot d q <= grown_end hi margin length.
Proof.
  intros Hp Hq (L0 & L1) Hd (M0 & M1).
  assert (Dot : dot d q <= hi + norm d * margin).
  { replace (dot d q) with (dot d p + dot d (minus q p)).
    - pose proof (Rle_trans _ _ _ (Rle_abs _) (dot_norms d (minus q p))) as C. unfold distance in Hq.
      pose proof (norm_nonneg d).
      assert (norm d * norm (minus q p) <= norm d * margin) by (apply Rmult_le_compat_l; lra). lra.
    - unfold dot, minus. cbn [px py pz]. ring. }
  apply Rle_trans with (1 := Dot). unfold grown_end.
  set (out := mul64 gradual64 (mul64 gradual64 margin length) slab_factor).
  pose proof (up_outward (hi + out)) as U.
  change (fl64 gradual64 (hi + out)) with (add64 gradual64 hi out) in U.
  apply Rle_trans with (2 := U). apply Rplus_le_compat_l. clear U Dot.
  assert (P150 : 0 < / IZR (2 ^ 150)) by (apply Rinv_0_lt_compat; now apply IZR_lt).
  assert (P200 : 0 < / IZR (2 ^ 200)) by (apply Rinv_0_lt_compat; now apply IZR_lt).
  assert (Small : tiny64 <= / 1000000000000000000 * (norm d * margin)).
  { apply Rle_trans with (/ 1000000000000000000 * (/ IZR (2 ^ 200) * / IZR (2 ^ 150))).
    - unfold tiny64. rewrite <- !Rinv_mult, <- !mult_IZR.
      apply Rinv_le_contravar; [apply IZR_lt | apply IZR_le]; vm_compute; easy.
    - apply Rmult_le_compat_l; [lra |]. apply Rmult_le_compat; lra. }
  assert (Pl : 0 <= length).
  { apply Rle_trans with (2 := L0). apply Rmult_le_pos; lra. }
  assert (Pm : 0 <= margin * length) by (apply Rmult_le_pos; lra).
  assert (Lower : norm d * margin * (1 - / 35184372088832) <= margin * length).
  { replace (norm d * margin * (1 - / 35184372088832))
      with (margin * (norm d * (1 - / 35184372088832))) by ring.
    apply Rmult_le_compat_l; lra. }
  unfold out, mul64. rewrite !read64_is.
  pose proof (fl64_error gradual64 gradually_valid64 (margin * length)) as E1.
  rewrite (Rabs_pos_eq _ Pm) in E1. apply Rabs_le_inv in E1.
  pose proof (fl64_nonneg gradual64 _ Pm) as Q1.
  set (a := fl64 gradual64 (margin * length)) in *.
  assert (Pa : 0 <= a * slab_factor) by (apply Rmult_le_pos; unfold slab_factor; lra).
  pose proof (fl64_error gradual64 gradually_valid64 (a * slab_factor)) as E2.
  rewrite (Rabs_pos_eq _ Pa) in E2. apply Rabs_le_inv in E2.
  set (b := fl64 gradual64 (a * slab_factor)) in *.
  set (k := norm d * margin) in *. set (ml := margin * length) in *.
  clearbody a b k ml. unfold slab_factor, v in *. lra.
Qed.
