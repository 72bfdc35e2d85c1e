(* Theorem K where balls stand for cubes: a list that was made of cubes grown by a skin holds every
   pair that the test of cubes lets through later, as long as each stays within its skin.
   With gradual
   underflow. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double WorldBall Sphere Ieee Shows Grid Outward Finder
  Lists.
From Sdop Require Import Place Cubes.
Open Scope R_scope.

(* The test of the two cubes that balls stand for. *)
Definition cubes_parted (a b : ball) : bool :=
  beyond (computed (centre a) (centre b)) (add gradual (radius a) (radius b)).

(* One axis. *)
Lemma axis_listed (x y x' y' ra rb ra' rb' pa pb la lb : R) :
  0 <= ra' -> 0 <= rb' -> 0 <= pa -> 0 <= pb ->
  Rabs (x - x') + ra' * (1 + 16 * u) <= pa -> Rabs (y - y') + rb' * (1 + 16 * u) <= pb ->
  pa * (1 + 12 * u) + 8 * radius_floor <= la -> pb * (1 + 12 * u) + 8 * radius_floor <= lb ->
  Rabs (sub gradual y' x') <= add gradual ra' rb' ->
  Rabs (sub gradual y x) <= add gradual la lb.
Proof.
  intros Ra' Rb' Pa Pb A B La Lb H. pose proof (proj1 half_step_value) as H0.
  pose proof (proj2 half_step_value) as HT. pose proof tiny_value as T. rewrite floor_value in *.
  rewrite gradual_sub, gradual_add in *.
  pose proof (nearest32_error (y' - x')) as E.
  pose proof (Rabs_triang_inv (y' - x') (nearest32 (y' - x'))) as I.
  rewrite (Rabs_minus_sym (y' - x')) in I.
  pose proof (nearest32_above (ra' + rb') ltac:(lra)) as S.
  assert (D : Rabs (y' - x') <= (ra' + rb') * (1 + 3 * u) + 4 * half_step) by (unfold u in *; lra).
  assert (N : Rabs (y - x) <= pa + pb + 4 * half_step).
  { replace (y - x) with ((y - y') + ((y' - x') + (x' - x))) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). pose proof (Rabs_triang (y' - x') (x' - x)) as T1.
    rewrite (Rabs_minus_sym x' x) in T1. unfold u in *. lra. }
  pose proof (nearest32_error (y - x)) as E2.
  pose proof (Rabs_triang_inv (nearest32 (y - x)) (y - x)) as I2.
  pose proof (nearest32_below (la + lb) ltac:(unfold u in *; lra)) as L. unfold u in *. lra.
Qed.

Theorem cube_lists_hold (s : skin) (moves_a moves_b : bool) (a b now_a now_b : ball) :
  sound_skin s -> 0 <= radius a -> 0 <= radius b -> 0 <= radius now_a -> 0 <= radius now_b ->
  follows s moves_a now_a a -> follows s moves_b now_b b ->
  cubes_parted now_a now_b = false ->
  cubes_parted (listed s moves_a a) (listed s moves_b b) = false.
Proof.
  intros Hs Ha Hb Na Nb Fa Fb H.
  pose proof (follows_near s moves_a now_a a Hs Fa) as Wa.
  pose proof (follows_near s moves_b now_b b Hs Fb) as Wb.
  pose proof (listed_large s moves_a (radius a) Hs Ha) as La.
  pose proof (listed_large s moves_b (radius b) Hs Hb) as Lb.
  set (pa := radius a * (1 + 16 * u) + _) in *. set (pb := radius b * (1 + 16 * u) + _) in *.
  destruct (coordinates_of_norm _ _ (Rle_refl (norm (minus (centre now_a) (centre a)))))
    as (Xa & Ya & Za).
  destruct (coordinates_of_norm _ _ (Rle_refl (norm (minus (centre now_b) (centre b)))))
    as (Xb & Yb & Zb).
  fold (distance (centre a) (centre now_a)) in Xa, Ya, Za.
  fold (distance (centre b) (centre now_b)) in Xb, Yb, Zb.
  unfold minus in Xa, Ya, Za, Xb, Yb, Zb. cbn [px py pz] in Xa, Ya, Za, Xb, Yb, Zb.
  rewrite Rabs_minus_sym in Xa, Ya, Za, Xb, Yb, Zb.
  pose proof (norm_nonneg (minus (centre now_a) (centre a))) as N1.
  fold (distance (centre a) (centre now_a)) in N1.
  pose proof (norm_nonneg (minus (centre now_b) (centre b))) as N2.
  fold (distance (centre b) (centre now_b)) in N2.
  assert (Pa : 0 <= pa) by (unfold u in *; lra). assert (Pb : 0 <= pb) by (unfold u in *; lra).
  unfold cubes_parted, beyond, greater in *. rewrite !read_is in *. revert H.
  case Rlt_bool_spec; [discriminate |]. intros H _. unfold computed in *. cbn [px py pz] in *.
  cbn [listed centre radius]. apply Rlt_bool_false.
  pose proof (Rle_trans _ _ _ (Rmax_r _ _) H) as Hz.
  pose proof (Rle_trans _ _ _ (Rmax_l _ _) H) as Hxy.
  pose proof (Rle_trans _ _ _ (Rmax_r _ _) Hxy) as Hy.
  pose proof (Rle_trans _ _ _ (Rmax_l _ _) Hxy) as Hx.
  apply Rmax_lub; [apply Rmax_lub |].
  - apply (axis_listed (px (centre a)) (px (centre b)) (px (centre now_a)) (px (centre now_b))
      (radius a) (radius b)
      (radius now_a) (radius now_b) pa pb _ _ Na Nb Pa Pb ltac:(lra) ltac:(lra) La Lb Hx).
  - apply (axis_listed (py (centre a)) (py (centre b)) (py (centre now_a)) (py (centre now_b))
      (radius a) (radius b)
      (radius now_a) (radius now_b) pa pb _ _ Na Nb Pa Pb ltac:(lra) ltac:(lra) La Lb Hy).
  - apply (axis_listed (pz (centre a)) (pz (centre b)) (pz (centre now_a)) (pz (centre now_b))
      (radius a) (radius b)
      (radius now_a) (radius now_b) pa pb _ _ Na Nb Pa Pb ltac:(lra) ltac:(lra) La Lb Hz).
Qed.
