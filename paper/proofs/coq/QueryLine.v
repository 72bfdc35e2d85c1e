(* Theorem Q (5): a line that meets the mesh of a posed body, grown by its margin, crosses its slabs
   there, so that no later parameter is taken for the first. With gradual underflow. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Ieee Shows Cells Outward.
From Sdop Require Import Finder Duality Vectors Norms64 OrDopTest Query InBody QueryBody.
Import ListNotations.
Open Scope R_scope.

Local Notation g := gradual64.

(* src/posed/mod.rs: PosedShape::crossed_by, without the ball *)
Definition line_out (b : solid) (far : R) : R :=
  add64 g (margin b) (slack_of (add64 g far (size_of b))).
Definition slab_crossing (b : solid) (from speed : point) (out : R) (s : slab) : crossed :=
  let o := mul64 g (length s) out in
  crossing (rotate_row g (normal s) from) (rotate_row g (normal s) speed)
    (sub64 g (low s) o) (add64 g (high s) o).
Definition slabs_crossed (b : solid) (p speed : point) : list crossed :=
  let r := rotation_of g (turn b) in
  let w := seen_from p (place b) in
  map (slab_crossing b (turned_back r w) (turned_back r speed) (line_out b (largest w))) (slabs b).
Definition first_of (all : list crossed) : R :=
  fold_right (fun c m => match c with Between first _ => Rmax first m | _ => m end) 0 all.

Theorem lines_are_crossed (b : solid) (p speed exact y : point) (s : R) :
  sound_solid b -> format_point p ->
  Forall (fun l => Rabs (low l) <= 2 * norm (normal l) * reach b /\
    Rabs (high l) <= 2 * norm (normal l) * reach b) (slabs b) ->
  (* The exact direction: that of a ray as it is, that of a segment rounded once. *)
  norm (minus speed exact) <= 1.001 * v * norm speed -> norm speed <= IZR (2 ^ 100) ->
  0 <= s <= IZR (2 ^ 189) -> s <= 1 \/ / IZR (2 ^ 60) <= norm exact ->
  in_mesh b y ->
  distance (plus p (scaled s exact)) (posed (turn b) (place b) y) <= margin b ->
  Forall (fun c => crossed_at c s) (slabs_crossed b p speed) /\ first_of (slabs_crossed b p speed) <= s.
Proof.
  intros B Fp Tight Dv Bv (S0 & S1) Sp Y Z.
  pose proof B as (Q & Ft & _ & Sl & R0 & M0 & _).
  pose proof v_value as V. pose proof floor_small as (Fl & T). pose proof (proj1 tiny64_value) as T0.
  assert (All : Forall (fun c => crossed_at c s) (slabs_crossed b p speed)).
  2: { split; [exact All |]. induction All as [| c all C All IH]; cbn; [exact S0 |].
    destruct c; try exact IH. apply Rmax_lub; [apply C | exact IH]. }
  unfold slabs_crossed. set (w := seen_from p (place b)). set (far := largest w).
  destruct (largest_above w) as (W0 & _). fold far in W0.
  destruct (turned_back_near _ w _ Q (seen_from_near p (place b) Fp Ft)) as (E1 & X1). fold far in E1, X1.
  destruct (turned_back_near _ speed _ Q Dv) as (E2 & X2).
  destruct (largest_above speed) as (L0 & _). pose proof (largest_below speed) as L1.
  set (from := turned_back (rotation_of g (turn b)) w) in *.
  set (way := turned_back (rotation_of g (turn b)) speed) in *.
  set (e := apply (transposed (exact_rotation (turn b)))) in *.
  set (x := e (minus p (place b))) in *. set (u := e exact) in *.
  set (A := margin b). set (S := far + reach b + margin b).
  assert (O : moves_out A S (line_out b far)).
  { pose proof (add_least _ _ R0 M0) as A1. pose proof (add_positive _ _ R0 M0) as P1.
    fold (size_of b) in A1, P1. pose proof (add_least _ _ W0 P1) as A2.
    pose proof (add_positive _ _ W0 P1) as P2. unfold line_out. apply out_above; try assumption.
    - unfold A, S. lra.
    - unfold A. assert (0 <= v * margin b) by (apply Rmult_le_pos; lra). lra.
    - unfold S. set (s1 := size_of b) in *. set (s2 := add64 g far s1) in *. clearbody s1 s2 far.
      unfold v in *. lra. }
  set (out := line_out b far) in *. pose proof O as ((A0 & AS) & _).
  (* The common point in the body's frame. *)
  assert (Meet : norm (minus (plus x (scaled s u)) y) <= A).
  { unfold A. rewrite distance_symmetric in Z. unfold distance in Z. apply Rle_trans with (2 := Z).
    rewrite <- (back_norm (turn b) Q (minus (plus p (scaled s exact)) _)). right. f_equal.
    replace y with (e (apply (exact_rotation (turn b)) y)) at 1 by (unfold e; now apply back_inverts).
    unfold x, u, e, posed, plus, minus, scaled, apply, dot, pt. cbn [px py pz row0 row1 row2].
    f_equal; ring. }
  assert (Nu : norm u = norm exact) by (unfold u, e; now apply back_norm).
  assert (Ny : norm y <= reach b) by apply Y.
  assert (Su : s * norm exact <= 1.7321 * S).
  { rewrite <- Nu, <- (norm_scaled s u S0).
    pose proof (triangle (minus (plus x (scaled s u)) y) (minus y x)) as Tr.
    replace (plus (minus (plus x (scaled s u)) y) (minus y x)) with (scaled s u) in Tr
      by (unfold plus, minus, scaled, pt; cbn [px py pz]; f_equal; ring).
    pose proof (norm_difference y x) as K. pose proof (triangle y (opposite x)) as K2.
    replace (plus y (opposite x)) with (minus y x) in K2
      by (unfold plus, minus, opposite, pt; cbn [px py pz]; f_equal; ring).
    rewrite norm_opposite in K2. unfold S. unfold A in Meet. lra. }
  assert (Us : norm speed <= 1.0011 * norm exact).
  { pose proof (norm_difference speed exact). pose proof (norm_nonneg exact). unfold v in *. lra. }
  assert (Ls : s * largest speed <= 1.735 * S).
  { apply Rle_trans with (s * (1.0011 * norm exact)); [apply Rmult_le_compat_l; lra | lra]. }
  assert (VS : 0 <= v * far <= v * S).
  { split; [apply Rmult_le_pos; lra | apply Rmult_le_compat_l; unfold S; lra]. }
  assert (Ts : s * tiny64 <= tiny64 + / 1000000 * (v * S)).
  { destruct Sp as [Sp | Sp].
    - assert (s * tiny64 <= 1 * tiny64) by (apply Rmult_le_compat_r; lra). lra.
    - assert (P60 : 0 < / IZR (2 ^ 60)) by (apply Rinv_0_lt_compat; now apply IZR_lt).
      assert (Su' : s * / IZR (2 ^ 60) <= 1.7321 * S).
      { apply Rle_trans with (2 := Su). now apply Rmult_le_compat_l. }
      assert (Td : tiny64 <= v / 10000000 * / IZR (2 ^ 60)).
      { unfold tiny64, v, Rdiv. rewrite <- !Rinv_mult, <- !mult_IZR.
        apply Rinv_le_contravar; [apply IZR_lt | apply IZR_le]; vm_compute; easy. }
      assert (s * tiny64 <= s * (v / 10000000 * / IZR (2 ^ 60))) by (apply Rmult_le_compat_l; lra).
      replace (s * (v / 10000000 * / IZR (2 ^ 60))) with (v / 10000000 * (s * / IZR (2 ^ 60))) in *
        by ring.
      assert (v / 10000000 * (s * / IZR (2 ^ 60)) <= v / 10000000 * (1.7321 * S))
        by (apply Rmult_le_compat_l; lra). lra. }
  apply Forall_forall. intros c C. apply in_map_iff in C. destruct C as (l & <- & I).
  rewrite Forall_forall in Sl, Tight. specialize (Sl l I). specialize (Tight l I).
  cbv beta in Tight. destruct Tight as (Tl & Th). apply Rabs_le_inv in Tl, Th.
  destruct Y as (Y & _). rewrite Forall_forall in Y. specialize (Y l I). cbv beta in Y.
  pose proof Sl as (N & _).
  pose proof (slab_seen (normal l) from x far ltac:(lra) W0 E1 X1) as C1.
  pose proof (slab_seen (normal l) way u (largest speed) ltac:(lra) L0 E2 X2) as C2.
  pose proof (ends_move l A S out Sl O) as M.
  set (n := norm (normal l)) in *. set (o := mul64 g (length l) out) in *.
  unfold slab_crossing. fold o. set (at_ := rotate_row g (normal l) from) in *.
  set (sp := rotate_row g (normal l) way) in *.
  assert (PS : 0 <= S) by lra.
  assert (NV : 0 <= n * (v * S)) by (repeat apply Rmult_le_pos; lra).
  assert (Po : 0 <= o).
  { assert (0 <= n * A) by (apply Rmult_le_pos; lra). lra. }
  apply crossing_contains; try apply format64_result.
  - (* The speed is far below the largest one. *)
    assert (F : Rabs (dot (normal l) u) <= 4 * (1.0011 * IZR (2 ^ 100))).
    { apply Rle_trans with (1 := dot_norms _ _). fold n. rewrite Nu.
      apply Rmult_le_compat; try apply norm_nonneg; [lra |].
      rewrite norm_reversed in Dv. pose proof (norm_difference exact speed).
      assert (v * norm speed <= 0.001 * norm speed)
        by (apply Rmult_le_compat_r; [apply norm_nonneg | unfold v; lra]). lra. }
    pose proof (Rabs_triang_inv sp (dot (normal l) u)) as Tr.
    assert (G : n * (64 * v * largest speed) <= 4 * (0.001 * IZR (2 ^ 100))).
    { apply Rmult_le_compat; try lra; [repeat apply Rmult_le_pos; lra |].
      apply Rmult_le_compat; lra. }
    assert (H : 100 * tiny64 <= 1).
    { pose proof tiny64_small. lra. }
    apply Rle_trans with (8 * IZR (2 ^ 100)).
    + assert (1 <= IZR (2 ^ 100)) by (apply IZR_le; vm_compute; easy). lra.
    + rewrite <- mult_IZR. apply IZR_le. vm_compute. easy.
  - split; [exact S0 | exact S1].
  - (* Where the common point is along the slab, and where it is computed. *)
    assert (D : low l - n * A <= dot (normal l) x + s * dot (normal l) u <= high l + n * A).
    { pose proof (dot_far (normal l) _ A Meet) as F. fold n in F.
      replace (dot (normal l) (minus (plus x (scaled s u)) y))
        with (dot (normal l) x + s * dot (normal l) u - dot (normal l) y) in F
        by (unfold dot, minus, plus, scaled, pt; cbn [px py pz]; ring). lra. }
    assert (Es : Rabs (s * sp - s * dot (normal l) u) <= n * (112 * (v * S)) + 100 * (s * tiny64)).
    { rewrite <- Rmult_minus_distr_l, Rabs_mult, (Rabs_pos_eq s S0).
      apply Rle_trans with (s * (n * (64 * v * largest speed) + 100 * tiny64)).
      - now apply Rmult_le_compat_l.
      - replace (s * (n * (64 * v * largest speed) + 100 * tiny64))
          with (64 * (n * (v * (s * largest speed))) + 100 * (s * tiny64)) by ring.
        assert (n * (v * (s * largest speed)) <= n * (v * (1.735 * S)))
          by (apply Rmult_le_compat_l; [lra | apply Rmult_le_compat_l; lra]). lra. }
    assert (Nf : n * (64 * v * far) <= n * (64 * (v * S))) by (apply Rmult_le_compat_l; lra).
    assert (Nt : / 4 * (v * S) <= n * (v * S)) by (apply Rmult_le_compat_r; lra).
    apply Rabs_le_inv in C1, Es.
    assert (Range : low l - n * A - n * (180 * (v * S)) - 300 * tiny64 <= at_ + s * sp
      <= high l + n * A + n * (180 * (v * S)) + 300 * tiny64) by lra.
    clear C1 C2 Es Nf D.
    assert (RS : n * (v * reach b) <= n * (v * S)).
    { apply Rmult_le_compat_l; [lra |]. apply Rmult_le_compat_l; unfold S; lra. }
    assert (nA : 0 <= n * A) by (apply Rmult_le_pos; lra).
    assert (vnA : v * (n * A) <= n * (v * S)).
    { replace (v * (n * A)) with (n * (v * A)) by ring.
      apply Rmult_le_compat_l; [lra |]. apply Rmult_le_compat_l; lra. }
    assert (Mo : n * A + 238 * (n * (v * S)) + 900 * tiny64 <= o * (1 - v)).
    { apply Rle_trans with ((n * (A + 240 * v * S) + 1000 * tiny64) * (1 - v)).
      - assert (v * (240 * (n * (v * S)) + 1000 * tiny64) <= / 1000 * (240 * (n * (v * S)) + 1000 * tiny64))
          by (apply Rmult_le_compat_r; [lra | unfold v; lra]). lra.
      - apply Rmult_le_compat_r; [unfold v; lra | exact M]. }
    assert (Ends : forall end_, Rabs end_ <= 2 * n * reach b -> forall k, k = 1 \/ k = -1 ->
      Rabs (fl64 g (end_ + k * o) - (end_ + k * o)) <= 2 * (n * (v * S)) + v * o + tiny64).
    { intros end_ H k K. apply Rle_trans with (1 := rounded64 _).
      pose proof (Rabs_triang end_ (k * o)) as Tr.
      assert (Ko : Rabs (k * o) = o).
      { destruct K as [-> | ->]; [rewrite Rmult_1_l; now apply Rabs_pos_eq |].
        replace (-1 * o) with (- o) by ring. rewrite Rabs_Ropp. now apply Rabs_pos_eq. }
      assert (v * Rabs (end_ + k * o) <= v * (2 * n * reach b + o)) by (apply Rmult_le_compat_l; lra).
      lra. }
    pose proof (Ends (high l) ltac:(apply Rabs_le; lra) 1 ltac:(auto)) as Eh.
    pose proof (Ends (low l) ltac:(apply Rabs_le; lra) (-1) ltac:(auto)) as El.
    unfold add64, sub64. rewrite !read64_is.
    replace (high l + 1 * o) with (high l + o) in Eh by ring.
    replace (low l + -1 * o) with (low l - o) in El by ring.
    apply Rabs_le_inv in Eh, El. lra.
Qed.
