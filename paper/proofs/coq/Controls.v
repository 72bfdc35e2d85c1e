(* Controls of theorem S: with a smaller factor or a smaller floor, Ieee.v's test, run in Coq,
   rejects balls that have a common point; with the constants of the code it doesn't. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Import Format Double Geometry Sphere Ieee Run.
Open Scope R_scope.

(* Balls whose centres are no farther apart than the sum of their radii have a common point. *)
Lemma common_point (a b : ball) :
  0 < radius a -> 0 < radius b ->
  square (minus (centre b) (centre a)) <= (radius a + radius b) * (radius a + radius b) ->
  exists p, in_ball p a /\ in_ball p b.
Proof.
  intros Ha Hb H. set (way := minus (centre b) (centre a)) in *.
  set (whole := radius a + radius b) in *. assert (Hw : 0 < whole) by (unfold whole; lra).
  set (at_share := fun s => {| px := px (centre a) + s * px way; py := py (centre a) + s * py way;
                             pz := pz (centre a) + s * pz way |}).
  assert (Scaled : forall s, s * s * square way <= (s * whole) * (s * whole)).
  { intros s. replace (s * whole * (s * whole)) with (s * s * (whole * whole)) by ring.
    apply Rmult_le_compat_l; [apply Rle_0_sqr | exact H]. }
  exists (at_share (radius a / whole)). unfold in_ball, distance.
  split; (apply norm_below; [lra |]).
  - set (s := radius a / whole). replace (radius a) with (s * whole) by (unfold s; field; lra).
    replace (square _) with (s * s * square way); [now apply Scaled |].
    unfold square, minus, at_share. cbn. ring.
  - set (s := radius b / whole). replace (radius b) with (s * whole) by (unfold s; field; lra).
    replace (square _) with (s * s * square way); [now apply Scaled |].
    assert (Hs : radius a / whole = 1 - s) by (unfold s, whole; field; unfold whole in Hw; lra).
    rewrite Hs. unfold square, minus, at_share, way, minus. cbn. ring.
Qed.

Lemma number_value (n e : Z) :
  (Z.abs n < 2 ^ 24)%Z -> (-149 <= e <= 100)%Z -> B2R (number n e) = IZR n * bpow radix2 e.
Proof.
  intros Hn He. unfold number.
  pose proof (binary_normalize_correct 24 128 _ _ mode_NE n e false) as C. cbv zeta in C.
  assert (F : generic_format radix2 (FLT_exp (-149) 24) (F2R (Float radix2 n e))).
  { apply generic_format_FLT. exists (Float radix2 n e); [reflexivity | exact Hn | cbn; lia]. }
  change (round radix2 _ _ (F2R (Float radix2 n e)))
    with (round radix2 (FLT_exp (-149) 24) ZnearestE (F2R (Float radix2 n e))) in C.
  rewrite round_generic in C; [| typeclasses eauto | exact F].
  rewrite Rlt_bool_true in C; [exact (proj1 C) |].
  unfold F2R. cbn [Fnum Fexp]. rewrite Rabs_mult, <- abs_IZR, (Rabs_pos_eq (bpow radix2 e))
    by apply bpow_ge_0.
  apply Rlt_le_trans with (bpow radix2 24 * bpow radix2 e).
  - apply Rmult_lt_compat_r; [apply bpow_gt_0 |]. change (bpow radix2 24) with (IZR (2 ^ 24)).
    now apply IZR_lt.
  - rewrite <- bpow_plus. apply bpow_le. lia.
Qed.

(* 1 + 2u instead of 1 + 8u. *)
Definition lower_factor : f32 := number 8388609 (-23).
Definition large_a : ball32 :=
  {| x32 := number (-1) 0; y32 := number (-1) 0; z32 := number (-1) 0; r32 := number 10793243 0 |}.
Definition large_b : ball32 :=
  {| x32 := number 9050277 1; y32 := number 2307300 0; z32 := number 15148691 1;
     r32 := number 12287306 1 |}.

(* 2^-78 instead of 2^-70. *)
Definition lower_floor : f32 := number 1 (-78).
Definition tiny_a : ball32 :=
  {| x32 := number 0 0; y32 := number 0 0; z32 := number 0 0; r32 := number 739 (-84) |}.
Definition tiny_b : ball32 :=
  {| x32 := number 523 (-84); y32 := number 583 (-84); z32 := number 579 (-84);
     r32 := number 235 (-84) |}.

Ltac meet :=
  apply common_point; unfold ball_of; cbn [x32 y32 z32 r32 radius centre px py pz square minus];
  unfold square, minus; cbn [px py pz]; rewrite !number_value by lia;
  change (bpow radix2 0) with 1; change (bpow radix2 1) with 2;
  change (bpow radix2 (-84)) with (/ IZR (2 ^ 84)); lra.

Theorem lower_factor_refuted :
  rejects32 lower_factor floor32 large_a large_b = true /\
  rejects32 factor32 floor32 large_a large_b = false /\
  exists p, in_ball p (ball_of large_a) /\ in_ball p (ball_of large_b).
Proof.
  split; [vm_compute; reflexivity |]. split; [vm_compute; reflexivity |].
  unfold large_a, large_b. meet.
Qed.

Theorem lower_floor_refuted :
  rejects32 factor32 lower_floor tiny_a tiny_b = true /\
  rejects32 factor32 floor32 tiny_a tiny_b = false /\
  exists p, in_ball p (ball_of tiny_a) /\ in_ball p (ball_of tiny_b).
Proof.
  split; [vm_compute; reflexivity |]. split; [vm_compute; reflexivity |].
  unfold tiny_a, tiny_b. meet.
Qed.

(* The grid's former count of cells, round(extent / size) + 1 with one division, where a centre's
   cell comes from a product with 1 / size. For this widened radius and these ends of the box the
   quotient is below 21.5, so the last cell was 21, and the farthest centre falls in cell 22. *)
Definition widened : f64 := number64 23408582 (-24).
Definition low_end : f64 := number64 (-17187326) (-48).
Definition high_end : f64 := number64 31455762 (-19).

(* src/broad_phase/grid/cells.rs: Cells::fit *)
Definition size64 : f64 := mult64 (mult64 (number64 2 0) widened) (number64 65537 (-16)).
Definition extent : f64 := minus64 high_end low_end.

Theorem former_count_refuted :
  Bcompare (divide64 extent size64) (number64 43 (-1)) = Some Lt /\
  Bcompare (cell64 low_end (divide64 (number64 1 0) size64) high_end)
    (number64 (3 * 2 ^ 51 + 22) 0) = Some Eq.
Proof. split; vm_compute; reflexivity. Qed.
