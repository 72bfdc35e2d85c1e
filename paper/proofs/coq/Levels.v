(* Theorem C between levels: a ball looks in the cells of another level for every ball there that the
   sphere test reports with it. With gradual underflow. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double WorldBall Sphere Ieee Shows Cells Grid Outward.
From Sdop Require Import Finder.
Open Scope R_scope.

Lemma normal_of_format32 (x : R) : format32 x -> normal64 x.
Proof.
  intro F. split; [now apply format32_64 |].
  destruct (Req_dec x 0) as [Z | N]; [now left | right].
  apply Rle_trans with (bpow radix2 (-149)).
  - change tiny64 with (/ IZR (2 ^ 1022)). change (/ IZR (2 ^ 1022)) with (bpow radix2 (-1022)).
    apply bpow_le. lia.
  - apply generic_format_ge_bpow with (FLT_exp (-149) 24).
    + intro e. unfold FLT_exp. lia.
    + now apply Rabs_pos_lt.
    + now apply generic_format_abs.
Qed.

(* src/broad_phase/grid/across.rs: Grid::across. How far a ball looks into a level whose largest
   widened radius is `widest`. *)
Definition reach_across (radius widest : R) : R :=
  add64 gradual64 (Grid.widen gradual gradual64 radius) widest.

Lemma reported_within_reach_across (a b : ball) (axis : nat) (widest : R) :
  radius_floor / 2 <= radius a <= IZR (2 ^ 200) -> radius_floor / 2 <= radius b <= IZR (2 ^ 200) ->
  Grid.widen gradual gradual64 (radius b) <= widest ->
  rejects gradual a b = false ->
  Rabs (coordinate_of axis (centre b) - coordinate_of axis (centre a))
    <= reach_across (radius a) widest.
Proof.
  intros Ha Hb Hw H. pose proof (widen_above_factor _ Ha) as Wa.
  pose proof (widen_above_factor _ Hb) as Wb.
  pose proof (reported_with_room a b axis (proj1 Ha) (proj1 Hb) H) as N.
  set (wa := Grid.widen gradual gradual64 (radius a)) in *.
  set (wb := Grid.widen gradual gradual64 (radius b)) in *.
  pose proof tiny_value as T. rewrite finder_floor_value in *. rewrite floor_value in *.
  unfold reach_across. fold wa. unfold add64. rewrite !read64_is.
  assert (P : 0 <= wa + widest) by (unfold u in *; lra).
  pose proof (fl64_error gradual64 gradually_valid64 (wa + widest)) as E.
  rewrite (Rabs_pos_eq _ P) in E. apply Rabs_le_inv in E.
  assert (T64 : tiny64 <= tiny).
  { unfold tiny64, tiny. apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
  pose proof v_value. unfold u, v in *. lra.
Qed.

Theorem levels_hand_over (a b : ball) (axis : nat) (widest origin inverse last : R) :
  radius_floor / 2 <= radius a <= IZR (2 ^ 200) -> radius_floor / 2 <= radius b <= IZR (2 ^ 200) ->
  Grid.widen gradual gradual64 (radius b) <= widest ->
  rejects gradual a b = false ->
  let (x, y) := (coordinate_of axis (centre a), coordinate_of axis (centre b)) in
  format32 x -> format32 y -> 0 <= inverse ->
  to_integer <= cell gradual64 origin inverse y <= last ->
  exists lo hi,
    around gradual64 origin inverse x (reach_across (radius a) widest) last = Some (lo, hi) /\
    (number lo <= number (cell gradual64 origin inverse y) <= number hi)%Z.
Proof.
  intros Ha Hb Hw H Fx Fy Hi C.
  pose proof (reported_within_reach_across a b axis widest Ha Hb Hw H) as D.
  apply around_covers; try assumption.
  - exact gradually_valid64.
  - now apply normal_of_format32.
  - now apply normal_of_format32.
  - pose proof (widen_above_factor _ Ha) as Wa. pose proof (widen_above_factor _ Hb) as Wb.
    pose proof tiny_value as T. rewrite finder_floor_value in *. rewrite floor_value in *.
    unfold reach_across, add64. rewrite !read64_is, gradual_fl64.
    set (s := _ + widest). assert (P : tiny <= s) by (unfold s, u in *; lra). split.
    + apply generic_format_round; typeclasses eauto.
    + right. rewrite Rabs_pos_eq.
      * apply Rle_trans with tiny.
        { unfold tiny64, tiny. apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
        unfold nearest64. apply round_ge_generic; [typeclasses eauto | typeclasses eauto | | exact P].
        change tiny with (/ IZR (2 ^ 126)). change (/ IZR (2 ^ 126)) with (bpow radix2 (-126)).
        apply generic_format_bpow. unfold FLT_exp. lia.
      * rewrite <- gradual_fl64. apply fl64_nonneg. lra.
Qed.
