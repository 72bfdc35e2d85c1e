(* A slab's end as the code inflates it, with gradual underflow: of the margin of 128u at least 127u
   are left. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Ieee Shows Outward Finder.
From Sdop Require Import Duality Vectors Rounded SupportParts SupportRounded Separated Norms64.
Open Scope R_scope.

Local Notation g := gradual64.

(* src/rounding/slab.rs: SLAB_MARGIN, SLAB_FLOOR, inflate_slab. One end; the other is that of the
   opposite direction. *)
Definition slab_margin : R := 128 * u.
Definition slab_floor : R := / IZR (2 ^ 110).
Definition slab_end (hi : R) (direction centre : point) (scale reach : R) : R :=
  let offset := rotate_row g direction centre in
  let length := div64 g (norm_in_f64 direction) scale in
  let size := add64 g reach (norm_in_f64 centre) in
  let margin := mul64 g length (add64 g (mul64 g slab_margin size) slab_floor) in
  next_above (add64 g (Rmax (div64 g (sub64 g hi offset) scale) 0) margin).
(* src/overlap/ordop/table.rs: table *)
Definition table (lo hi : nat -> R) (b : matrix) (centre : point) (reach : R) : slabs :=
  fun member =>
    let d := combined b (direction member) in
    let scale := norm_in_f64 (row0 b) in
    (slab_end (hi member) d centre scale reach,
     slab_end (- lo member) (opposite d) centre scale reach).
Theorem slab_end_covers (d c : point) (hi w n scale reach : R) :
  / 4 <= n <= 2 -> Rabs (scale - n) <= 5 * v * n -> n <= norm d <= 1.7321 * n ->
  0 <= reach <= IZR (2 ^ 62) -> norm c <= IZR (2 ^ 62) -> w <= hi ->
  Rabs (w - dot d c) <= norm d * (1.7321 * (reach + norm c)) ->
  0 <= slab_end hi d c scale reach /\
  (w - dot d c) / n + margin_of (reach + norm c) * (norm d / n) <= slab_end hi d c scale reach.
Proof.
  intros Hn Hs (D0 & D1) (R0 & R1) Hc Hw HX. pose proof v_value as V. pose proof dust_value as Du.
  destruct small_value as (S0 & _ & S1). destruct small_dust as (S2 & S3).
  pose proof (norm_nonneg c) as C0. set (rho := reach + norm c) in *.
  pose proof (share_above rho) as Sh. pose proof (proj1 tiny64_value) as T0.
  pose proof tiny64_dust as T1.
  assert (Phi : share_of rho = rho + / IZR (2 ^ 93)) by reflexivity.
  assert (Phi0 : / IZR (2 ^ 200) <= / IZR (2 ^ 93))
    by (apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]).
  assert (P200 : 0 < / IZR (2 ^ 200)) by (apply Rinv_0_lt_compat; now apply IZR_lt).
  assert (Pn : 0 < scale) by (apply Rabs_le_inv in Hs; unfold v in *; lra).
  assert (Rho : 0 <= rho) by (unfold rho; lra).
  set (L := norm d / n).
  assert (Ln : norm d = L * n) by (unfold L; field; lra).
  assert (L1 : 1 <= L <= 1.7321).
  { split; apply Rmult_le_reg_r with n; try lra; rewrite <- Ln; lra. }
  assert (Big : IZR (2 ^ 62) <= big) by (unfold big; now apply IZR_le).
  assert (Hd : norm d <= IZR (2 ^ 62)).
  { apply Rle_trans with 4; [lra | now apply IZR_le]. }
  (* The end itself. *)
  pose proof (dot_in_f64_error d c (norm d) (norm c) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)) as
    Off.
  set (off := rotate_row g d c) in *. set (X := w - dot d c) in *.
  assert (Ew : Rabs (w - w) <= 0) by (rewrite Rminus_diag_eq, Rabs_R0; lra).
  pose proof (sub64_near g valid_g w off w (dot d c) 0 _ Ew Off) as Sub. fold X in Sub.
  assert (Q : norm d * norm c <= norm d * rho) by (apply Rmult_le_compat_l; unfold rho; lra).
  replace (norm d * (1.7321 * rho)) with (1.7321 * (norm d * rho)) in HX by ring.
  assert (Dr : norm d * rho = n * (L * rho)) by (rewrite Ln; ring).
  rewrite Dr in *. clear Dr.
  set (Lr := L * rho) in *. assert (Lr0 : 0 <= Lr) by (apply Rmult_le_pos; lra).
  assert (nLr : 0 <= n * Lr) by (apply Rmult_le_pos; lra).
  assert (Sub' : Rabs (sub64 g w off - X) <= 4.8 * v * (n * Lr) + 10 * dust)
    by (unfold v in *; lra).
  pose proof (divided_error _ X _ scale n Hn Hs Sub') as Div.
  assert (Xn : Rabs X / n <= 1.7321 * Lr).
  { apply Rmult_le_reg_r with n; [lra |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra. lra. }
  assert (En : (4.8 * v * (n * Lr) + 10 * dust) / n <= 4.8 * v * Lr + 40 * dust).
  { apply Rmult_le_reg_r with n; [lra |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l by lra.
    assert (dust * / 4 <= dust * n) by (apply Rmult_le_compat_l; lra). lra. }
  assert (Div' : X / n - (18 * v * Lr + 50 * dust) <= div64 g (sub64 g w off) scale).
  { apply Rabs_le_inv in Div. unfold v in *. lra. }
  pose proof (div64_monotone _ _ scale Pn (sub64_monotone w hi off Hw)) as Mono.
  set (end_ := div64 g (sub64 g hi off) scale) in *.
  (* The margin. *)
  destruct (norm_in_f64_error d) as (_ & _ & Nd).
  { apply Rle_trans with (1 := Hd). now apply IZR_le. }
  specialize (Nd ltac:(assert (/ IZR (2 ^ 200) <= 1) by (rewrite <- Rinv_1;
    apply Rinv_le_contravar; [lra | now apply IZR_le]); unfold v in *; lra)).
  pose proof (divided_error _ (norm d) _ scale n Hn Hs Nd) as Len.
  rewrite (Rabs_pos_eq (norm d)) in Len by apply norm_nonneg. fold L in Len.
  replace (5 * v * norm d / n) with (5 * v * L) in Len by (unfold L; field; lra).
  set (len := div64 g (norm_in_f64 d) scale) in *.
  assert (Len' : 0.9999 * L <= len <= 2).
  { apply Rabs_le_inv in Len. split; unfold v in *; lra. }
  destruct (norm_in_f64_error c) as (Nc0 & Nc & _).
  { apply Rle_trans with (1 := Hc). now apply IZR_le. }
  pose proof (add64_below g valid_g reach (norm_in_f64 c) R0 Nc0) as Size.
  pose proof (add64_nonneg g reach (norm_in_f64 c) R0 Nc0) as Size0.
  set (size := add64 g reach (norm_in_f64 c)) in *.
  assert (Size' : 0.99999 * rho - 2 * small <= size) by (unfold rho, v in *; lra).
  assert (Sm : tiny64 <= slab_margin <= 2).
  { unfold slab_margin, u. split; [| lra]. apply Rle_trans with dust; [lra |].
    assert (/ IZR (2 ^ 200) <= 1) by (rewrite <- Rinv_1; apply Rinv_le_contravar;
      [lra | now apply IZR_le]). unfold v in *. lra. }
  pose proof (mul64_below g valid_g slab_margin size (proj1 Sm) (proj2 Sm) Size0) as M1.
  pose proof (mul64_nonneg g slab_margin size ltac:(lra) Size0) as M1'.
  set (m1 := mul64 g slab_margin size) in *.
  assert (F0 : slab_floor = 128 * u * / IZR (2 ^ 93)).
  { unfold slab_floor, u. change (2 ^ 110)%Z with (131072 * 2 ^ 93)%Z.
    rewrite mult_IZR, Rinv_mult. lra. }
  pose proof (add64_below g valid_g m1 slab_floor M1' ltac:(rewrite F0; unfold u; lra)) as M2.
  pose proof (add64_nonneg g m1 slab_floor M1' ltac:(rewrite F0; unfold u; lra)) as M2'.
  set (m2 := add64 g m1 slab_floor) in *. rewrite F0 in M2.
  assert (Share : 127.9 * (u * share_of rho) <= m2).
  { rewrite Phi. unfold slab_margin, u, v in *. lra. }
  pose proof (mul64_below g valid_g len m2 ltac:(unfold v in *; lra) (proj2 Len') M2') as M3.
  pose proof (mul64_nonneg g len m2 ltac:(lra) M2') as M3'.
  set (margin := mul64 g len m2) in *.
  assert (Us : 0 <= u * share_of rho) by (unfold u; lra).
  assert (P : 0.9999 * L * (127.9 * (u * share_of rho)) <= len * m2)
    by (apply Rmult_le_compat; lra).
  assert (Ls : u * share_of rho <= L * (u * share_of rho)).
  { rewrite <- (Rmult_1_l (u * share_of rho)) at 1. apply Rmult_le_compat_r; lra. }
  assert (Lsr : u * Lr <= L * (u * share_of rho)).
  { unfold Lr. replace (u * (L * rho)) with (L * (u * rho)) by ring.
    apply Rmult_le_compat_l; [lra |]. apply Rmult_le_compat_l; [unfold u |]; lra. }
  (* Their sum, rounded outward. *)
  pose proof (sum_outward (Rmax end_ 0) margin) as Out.
  unfold slab_end. fold off end_ len size m1 m2 margin.
  pose proof (Rmax_l end_ 0). pose proof (Rmax_r end_ 0). split; [lra |].
  apply Rle_trans with (2 := Out). unfold margin_of.
  replace (127 * u * share_of rho * L) with (127 * (L * (u * share_of rho))) by ring.
  replace (0.9999 * L * (127.9 * (u * share_of rho)))
    with (0.9999 * 127.9 * (L * (u * share_of rho))) in P by ring.
  set (uLs := L * (u * share_of rho)) in *. set (lm := len * m2) in *.
  assert (Sdust : 60 * dust <= / 1000 * uLs).
  { rewrite Phi in Ls. unfold u, v in *. lra. }
  clear - Mono Div' P M3 Lsr Sdust H Du Lr0 Us Ls. unfold u, v in *. lra.
Qed.
