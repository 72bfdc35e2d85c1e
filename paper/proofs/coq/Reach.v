(* Theorem B with rounding: pair finders that bin or-DOPs alone by balls of their own hand over every
   pair that the test along slab normals reports. With gradual underflow. *)
From Coq Require Import Reals ZArith Bool List Lra Lia Classical.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Sphere Rejected Ieee Shows.
From Sdop Require Import Same Outward Finder Duality Vectors Rounded SupportParts Separated OrDopTest.
From Sdop Require Import OrDop Norms64 OrDopPose SlabEnd OrDopBody Binning Above.
Import ListNotations.
Open Scope R_scope.

Local Notation g := gradual64.

(* src/overlap/ordop/reach.rs: MARGIN, OFFSET_MARGIN, reach; src/culler/models.rs: Models::binned *)
Definition offset_margin : R := / 1048576.
Definition half_of (s : slabs) (member : nat) : R :=
  div64 g (Rmax (fst (s member)) (snd (s member))) (sqrt64 g (square (direction member))).
Definition widest_half (k : kind) (s : slabs) : R :=
  fold_left (fun most member => Rmax most (half_of s member)) (members k) 0.
Definition bin_radius (k : kind) (s : slabs) (reach : R) : R :=
  next_above (add64 g (mul64 g (mul64 g (widest_half k s) (nearest64 (factor k))) (4097 / 4096))
    (mul64 g reach offset_margin)).
Definition bin (k : kind) (b : ordop_body) : body :=
  {| shape := {| centre := middle b; radius := bin_radius k (table_of_body b) (extent b) |};
     Rejected.turn := pose b; place := position b |}.

(* One f64 operation from below and above. *)
Lemma rounded64_within (x : R) : 0 <= x -> x * (1 - v) - dust <= fl64 g x <= x * (1 + v) + dust.
Proof.
  intro H. pose proof (fl64_error g gradually_valid64 x) as E. rewrite (Rabs_pos_eq x) in E by exact H.
  apply Rabs_le_inv in E. pose proof tiny64_dust. pose proof (proj1 tiny64_value). lra.
Qed.

(* A half width over its direction's length. *)
Lemma half_above (s : slabs) (member : nat) (x : R) :
  In member (members K26) -> 0 <= x -> x <= Rmax (fst (s member)) (snd (s member)) ->
  x <= (half_of s member * (1 + 4 * v) + 2 * dust) * norm (direction member).
Proof.
  intros M P H. pose proof (direction_long member M) as L.
  assert (U : norm (direction member) <= 1.7321).
  { apply norm_below; [lra |]. unfold square, direction, directions, pt.
    cbn in M. repeat (destruct M as [<- | M]); [.. | destruct M]; cbn [nth map px py pz]; lra. }
  pose proof v_value as V. pose proof dust_value as D. pose proof small_dust as SD.
  assert (Dv : dust <= v / 1000).
  { unfold dust, v. unfold Rdiv. rewrite <- Rinv_mult.
    apply Rinv_le_contravar; [lra |]. rewrite <- mult_IZR. now apply IZR_le. }
  unfold half_of, div64, sqrt64. rewrite !read64_is.
  change (sqrt (square (direction member))) with (norm (direction member)).
  set (n := norm (direction member)) in *. set (y := Rmax _ _) in *.
  destruct (rounded64_within n ltac:(lra)) as (R0 & R1). set (r := fl64 g n) in *.
  assert (Rp : 0.9 <= r <= 2) by (unfold v in *; lra).
  assert (Py : 0 <= y / r) by (apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra]).
  destruct (rounded64_within (y / r) Py) as (Q & _). set (h := fl64 g (y / r)) in *.
  assert (E : y = y / r * r) by (field; lra).
  apply Rle_trans with (1 := H). rewrite E. set (t := y / r) in *.
  assert (t * r <= t * (n * (1 + 1.01 * v))) by (apply Rmult_le_compat_l; [exact Py | unfold v in *; lra]).
  apply Rle_trans with (t * (1 + 1.01 * v) * n); [lra |]. apply Rmult_le_compat_r; [lra |].
  unfold v in *. lra.
Qed.

Lemma fold_above (f : nat -> R) (l : list nat) (from : R) :
  from <= fold_left (fun most member => Rmax most (f member)) l from /\
  forall member, In member l ->
    f member <= fold_left (fun most member => Rmax most (f member)) l from.
Proof.
  revert from. induction l as [| i l IH]; intro from; cbn [fold_left]; [split; [lra | intros ? []] |].
  destruct (IH (Rmax from (f i))) as (A & B). pose proof (Rmax_l from (f i)).
  pose proof (Rmax_r from (f i)). split; [lra |].
  intros member [<- | M]; [lra | now apply B].
Qed.

(* The radius that a finder uses has room for the widest half width and a share of the reach. *)
Lemma bin_radius_above (k : kind) (s : slabs) (reach : R) :
  0 <= reach ->
  (forall member, In member (members k) -> 0 <= fst (s member) /\ 0 <= snd (s member)) ->
  exists w, 0 <= w /\ no_wider k s w /\
    factor k * w * (1 + 4090 * u) + 15.9 * (u * reach) - tiny <= bin_radius k s reach.
Proof.
  intros R0 Pos. pose proof v_value as V. pose proof dust_value as D.
  set (W := widest_half k s). destruct (fold_above (half_of s) (members k) 0) as (W0 & W1).
  fold (widest_half k s) in W0, W1. fold W in W0, W1.
  exists (W * (1 + 4 * v) + 2 * dust).
  split; [unfold v in *; lra |]. split.
  - intros member M. destruct (Pos member M) as (P & Q). specialize (W1 member M).
    pose proof (direction_long member (members_all k member M)) as L.
    assert (C : forall x, 0 <= x -> x <= Rmax (fst (s member)) (snd (s member)) ->
      x <= (W * (1 + 4 * v) + 2 * dust) * norm (direction member)).
    { intros x X H. apply Rle_trans with (1 := half_above s member x (members_all k member M) X H).
      apply Rmult_le_compat_r; [lra |]. unfold v in *. lra. }
    split; apply C; try assumption; [apply Rmax_l | apply Rmax_r].
  - set (F := factor k). assert (Fk : 1.2 <= F <= 3) by (unfold F; destruct k; cbn; lra).
    assert (Dt : 1000 * dust <= tiny).
    { unfold dust, tiny. change (2 ^ 700)%Z with (2 ^ 574 * 2 ^ 126)%Z.
      rewrite mult_IZR, Rinv_mult, <- Rmult_assoc.
      assert (1000 * / IZR (2 ^ 574) <= 1) by lra.
      assert (0 < / IZR (2 ^ 126)) by (apply Rinv_0_lt_compat; now apply IZR_lt).
      rewrite <- (Rmult_1_l (/ IZR (2 ^ 126))) at 2. apply Rmult_le_compat_r; lra. }
    unfold bin_radius. apply Rle_trans with (2 := sum_outward _ _).
    fold W F.
    destruct (rounded64_within F ltac:(lra)) as (F0 & F1). rewrite gradual_fl64 in F0, F1.
    set (F' := nearest64 F) in *.
    unfold mul64. rewrite !read64_is.
    assert (Dv : dust <= v / 1000).
    { unfold dust, v. unfold Rdiv. rewrite <- Rinv_mult.
      apply Rinv_le_contravar; [lra |]. rewrite <- mult_IZR. now apply IZR_le. }
    assert (WF : W * (F * (1 - 1.01 * v)) <= W * F').
    { apply Rmult_le_compat_l; [exact W0 |]. unfold v in *. lra. }
    assert (Wp : 0 <= W * F) by (apply Rmult_le_pos; lra).
    replace (W * (F * (1 - 1.01 * v))) with (W * F * (1 - 1.01 * v)) in WF by ring.
    assert (P1 : 0 <= W * F') by (unfold v in *; lra).
    destruct (rounded64_within _ P1) as (A & _). pose proof (fl64_nonneg g _ P1) as A0.
    set (x := fl64 g (W * F')) in *.
    assert (P2 : 0 <= x * (4097 / 4096)) by lra.
    destruct (rounded64_within _ P2) as (B & _). pose proof (fl64_nonneg g _ P2) as B0.
    set (y := fl64 g (x * (4097 / 4096))) in *.
    assert (P3 : 0 <= reach * offset_margin) by (apply Rmult_le_pos; unfold offset_margin; lra).
    destruct (rounded64_within _ P3) as (C & _). set (z := fl64 g (reach * offset_margin)) in *.
    unfold offset_margin in C.
    replace (F * (W * (1 + 4 * v) + 2 * dust) * (1 + 4090 * u))
      with ((W * F * (1 + 4 * v) + 2 * (F * dust)) * (1 + 4090 * u)) by ring.
    assert (F * dust <= 3 * dust) by (apply Rmult_le_compat_r; lra).
    assert (0 <= u * reach) by (apply Rmult_le_pos; unfold u; lra).
    set (WFx := W * F) in *. unfold u, v in *. lra.
Qed.

(* Two or-DOPs whose centres are that far apart: a normal of the first rejects them. *)
Section Far.
Variable k : kind.
Variables qa qb : matrix.
Variables ta tb oa ob : point.
Variables ra rb : R.
Variables a b : row.
Hypothesis Ra : 0 <= ra.
Hypothesis Rb : 0 <= rb.
Hypothesis Ha : row_of qa ta oa ra a.
Hypothesis Hb : row_of qb tb ob rb b.
Variables sa sb : slabs.
Variables wa wb : R.
Hypothesis Wa : 0 <= wa.
Hypothesis Wb : 0 <= wb.
Hypothesis Pa : forall member, In member (members k) -> 0 <= fst (sa member) /\ 0 <= snd (sa member).
Hypothesis Pb : forall member, In member (members k) -> 0 <= fst (sb member) /\ 0 <= snd (sb member).
Hypothesis Na : no_wider k sa wa.
Hypothesis Nb : no_wider k sb wb.
Let gap : point := minus (plus tb ob) (plus ta oa).
Let far : R := norm gap.
Let lines : matrix := transposed (turn gradual a b).
Let gap32 : point := gap_a gradual a b.

Lemma gap32_near :
  norm (minus gap32 (apply qa gap)) <= 9.1 * (u * far) + 3.03 * (u * (ra + rb)) + 100 * tiny.
Proof.
  pose proof (delta_error gradual gradual_valid qa qb ta tb oa ob ra rb a b Ra Rb Ha Hb) as D.
  fold gap in D. fold far in D. pose proof tiny_value as T.
  pose proof Ha as (Oa & _ & A0 & A1 & A2 & _).
  pose proof (along_axes_near gradual gradual_valid qa _ (delta gradual a b) Oa A0 A1 A2) as [L _].
  pose proof (norm_difference (delta gradual a b) gap) as N. fold far in N.
  assert (F0 : 0 <= far) by apply norm_nonneg.
  set (d := delta gradual a b) in *. pose proof D as D'.
  pose proof (apply_keeps_norm qa (minus d gap) Oa) as K. rewrite <- K in D.
  replace (apply qa (minus d gap)) with (minus (apply qa d) (apply qa gap)) in D
    by (unfold apply, minus, dot, pt; cbn [px py pz]; f_equal; ring).
  unfold gap32, gap_a. fold d.
  replace (minus (along_axes gradual (row_axes a) d) (apply qa gap))
    with (plus (minus (along_axes gradual (row_axes a) d) (apply qa d))
      (minus (apply qa d) (apply qa gap)))
    by (unfold plus, minus; cbn [px py pz]; f_equal; ring).
  apply Rle_trans with (1 := triangle _ _). clear K. unfold u in *. lra.
Qed.

(* A normal of the first body along the other's axes is hardly longer than it is. *)
Lemma normal_length (member : nat) :
  In member (members k) ->
  norm (pt (combination gradual (row0 lines) member) (combination gradual (row1 lines) member)
    (combination gradual (row2 lines) member)) <= norm (direction member) * (1 + 21 * u).
Proof.
  intro M. pose proof (members_all k member M) as M'. pose proof tiny_value as T0.
  pose proof (direction_long _ M') as Long.
  pose proof (tiny_near (norm (direction member)) ltac:(lra)) as T.
  pose proof Ha as (Oa & _). pose proof Hb as (Ob & _).
  destruct (turn_near gradual gradual_valid qa qb ta tb oa ob ra rb a b Ha Hb) as ((L0 & L1 & L2) & _).
  fold lines in L0, L1, L2. pose proof Ob as (U0 & U1 & U2 & _).
  set (d := direction member) in *.
  assert (Part : forall c r, dot r r = 1 -> norm (minus c (apply qa r)) <= 8.77 * u ->
    Rabs (combination gradual c member - dot r (combined qa d)) <= 12 * (u * norm d)).
  { intros c r U L. destruct (line_dot qa Oa c r d U L) as (Nc & D).
    pose proof (combination_near gradual gradual_valid c member M') as C. fold d in C.
    rewrite (dot_swap c d) in D.
    assert (norm d * norm c <= norm d * 1.0001) by (apply Rmult_le_compat_l; lra).
    apply Rabs_le_inv in C, D. apply Rabs_le. unfold u in *. lra. }
  pose proof (Part _ _ U0 L0) as P0. pose proof (Part _ _ U1 L1) as P1.
  pose proof (Part _ _ U2 L2) as P2.
  set (e := pt _ _ _). pose proof (norm_difference e (apply qb (combined qa d))) as N.
  rewrite (apply_keeps_norm qb _ Ob), (norm_combined qa d Oa) in N.
  assert (E : norm (minus e (apply qb (combined qa d))) <= 1.73206 * (12 * (u * norm d))).
  { apply norm_same; [unfold u; lra | | |]; unfold e, apply, pt; cbn [px py pz]; assumption. }
  unfold u in *. lra.
Qed.

Theorem far_normal_separates :
  factor k * (wa + wb) * (1 + 4000 * u) + 6 * (u * (ra + rb)) + 1000 * tiny < far ->
  exists member, In member (members k) /\ normal_separates gradual k lines gap32 sa sb member.
Proof.
  intro Far. apply NNPP. intro No. pose proof tiny_value as T0.
  pose proof half_step_value as (H0 & H1). pose proof tiny_small as T1.
  pose proof Ha as (Oa & _). destruct (spread_square k) as (S1 & S2).
  assert (F0 : 0 <= far) by apply norm_nonneg.
  set (c := spread k) in *.
  assert (C2 : c <= 1.7321).
  { destruct (Rle_or_lt c 1.7321) as [| L]; [assumption | exfalso].
    assert (1.7321 * 1.7321 < c * c) by (apply Rmult_le_0_lt_compat; lra).
    assert (factor k <= 3) by (destruct k; cbn; lra). lra. }
  set (W := c * (wa + wb) * (1 + 1000 * u) + 12.3 * (u * far) + 3.05 * (u * (ra + rb)) + 500 * tiny).
  assert (Inside : inside k (ball_slabs W) (apply qa gap)).
  { intros member M. pose proof (members_all k member M) as M'.
    pose proof (direction_long _ M') as N1. pose proof (normal_length member M) as Le.
    set (e := pt _ _ _) in Le. set (n := norm (direction member)) in *.
    set (tau := combination gradual gap32 member).
    assert (Sign : exists negative, sign_of negative tau).
    { destruct (Rle_or_lt 0 tau); [exists false | exists true]; unfold sign_of; lra. }
    destruct Sign as (negative & St). destruct (any_signs (flipped negative e)) as (signs & Se).
    assert (G : greater gradual (Rabs tau) (add gradual (end_of sa member negative)
      (support_of gradual k (mirrored sb) signs (flipped negative e))) = false).
    { apply not_true_is_false. intro G. apply No. exists member. split; [exact M |].
      exists negative, signs. split; [exact St |]. split; [exact Se | exact G]. }
    unfold greater in G. rewrite !read_is in G. revert G.
    case Rlt_bool_spec; [discriminate |]. intros G _. rewrite gradual_add in G.
    assert (Own : 0 <= end_of sa member negative <= wa * n).
    { destruct (Pa member M), (Na member M). unfold end_of. destruct negative; split; assumption. }
    pose proof (computed_support_above k (mirrored sb) wb signs (flipped negative e) Wb
      ltac:(intros i I; destruct (Pb i I); unfold mirrored; cbn; split; assumption)
      ltac:(intros i I; destruct (Nb i I); unfold mirrored; cbn; split; assumption)) as Sup.
    cbv zeta in Sup. destruct Sup as (P0 & Sup). fold c in Sup.
    pose proof (coordinates_sum (flipped negative e)) as Sum. rewrite flipped_norm in Sup, Sum.
    set (sup := support_of gradual k (mirrored sb) signs (flipped negative e)) in *.
    set (sum := Rabs (px (flipped negative e)) + _ + _) in *.
    assert (Sw : u * (sum * wb) <= 1.74 * (u * (n * wb))).
    { replace (1.74 * (u * (n * wb))) with (u * (1.74 * n * wb)) by ring.
      apply Rmult_le_compat_l; [unfold u; lra |]. apply Rmult_le_compat_r; [exact Wb |].
      unfold u in *. lra. }
    assert (Nw : wb <= n * wb).
    { rewrite <- (Rmult_1_l wb) at 1. apply Rmult_le_compat_r; lra. }
    assert (Hw : half_step * wb <= u * (n * wb)).
    { apply Rmult_le_compat; [lra | exact Wb | | exact Nw]. unfold u. lra. }
    assert (Ce : wb * (c * norm e) <= c * (n * wb) * (1 + 21 * u)).
    { replace (c * (n * wb) * (1 + 21 * u)) with (wb * (c * (n * (1 + 21 * u)))) by ring.
      apply Rmult_le_compat_l; [exact Wb |]. apply Rmult_le_compat_l; lra. }
    assert (Cb : n * wb <= c * (n * wb)).
    { rewrite <- (Rmult_1_l (n * wb)) at 1. apply Rmult_le_compat_r; [apply Rmult_le_pos |]; lra. }
    assert (Ca : wa * n <= c * (n * wa)).
    { rewrite (Rmult_comm wa n), <- (Rmult_1_l (n * wa)) at 1.
      apply Rmult_le_compat_r; [apply Rmult_le_pos |]; lra. }
    assert (Pwb : 0 <= n * wb) by (apply Rmult_le_pos; lra).
    pose proof (nearest32_above (end_of sa member negative + sup) ltac:(lra)) as Sm.
    assert (Tau : Rabs tau <= c * (n * (wa + wb)) * (1 + 900 * u) + tiny).
    { apply Rle_trans with (1 := G). apply Rle_trans with (1 := Sm).
      replace (c * (n * (wa + wb))) with (c * (n * wa) + c * (n * wb)) by ring.
      set (x := c * (n * wa)) in *. set (y := c * (n * wb)) in *. unfold u in *. lra. }
    pose proof gap32_near as Near. pose proof (norm_difference gap32 (apply qa gap)) as N32.
    rewrite (apply_keeps_norm qa gap Oa) in N32. fold far in N32.
    pose proof (combination_near gradual gradual_valid gap32 member M') as Co. fold n tau in Co.
    pose proof (dot_change (direction member) gap32 (apply qa gap)) as Ch. fold n in Ch.
    set (near := norm (minus gap32 (apply qa gap))) in *.
    assert (Pr : 0 <= u * (ra + rb)) by (apply Rmult_le_pos; unfold u; lra).
    assert (Err : n * near + 3.01 * u * (n * norm gap32) + 12 * tiny
      <= n * (12.3 * (u * far) + 3.05 * (u * (ra + rb)) + 400 * tiny)).
    { replace (n * near + 3.01 * u * (n * norm gap32) + 12 * tiny)
        with (n * (near + 3.01 * u * norm gap32) + 12 * tiny) by ring.
      assert (tiny <= n * tiny) by (rewrite <- (Rmult_1_l tiny) at 1; apply Rmult_le_compat_r; lra).
      apply Rle_trans with (n * (near + 3.01 * u * norm gap32 + 12 * tiny)); [lra |].
      apply Rmult_le_compat_l; [lra |]. unfold u in *. lra. }
    assert (Total : Rabs (dot (direction member) (apply qa gap)) <= W * n).
    { apply Rabs_le_inv in Co, Ch, Tau. 
      assert (tiny <= n * tiny) by (rewrite <- (Rmult_1_l tiny) at 1; apply Rmult_le_compat_r; lra).
      unfold W. set (y := dot (direction member) (apply qa gap)) in *.
      set (z := dot (direction member) gap32) in *.
      assert (Pw : 0 <= c * (n * (wa + wb))) by (repeat apply Rmult_le_pos; lra).
      replace ((c * (wa + wb) * (1 + 1000 * u) + 12.3 * (u * far) + 3.05 * (u * (ra + rb))
        + 500 * tiny) * n) with (c * (n * (wa + wb)) * (1 + 1000 * u)
        + n * (12.3 * (u * far) + 3.05 * (u * (ra + rb)) + 400 * tiny) + 100 * (n * tiny)) by ring.
      apply Rabs_le. unfold u in *. lra. }
    apply Rabs_le_inv in Total. unfold ball_slabs. cbn [fst snd]. fold n. lra. }
  assert (PW : 0 <= W).
  { unfold W. assert (0 <= c * (wa + wb)) by (apply Rmult_le_pos; lra).
    assert (0 <= u * (ra + rb)) by (apply Rmult_le_pos; unfold u; lra). unfold u in *. lra. }
  pose proof (within_ball_slabs k W _ PW Inside) as D. fold c in D.
  rewrite (apply_keeps_norm qa gap Oa) in D. fold far in D.
  assert (CW : c * W <= factor k * (wa + wb) * (1 + 1000 * u)
    + 1.7321 * (12.3 * (u * far) + 3.05 * (u * (ra + rb)) + 500 * tiny)).
  { unfold W. assert (0 <= u * (ra + rb)) by (apply Rmult_le_pos; unfold u; lra).
    assert (0 <= u * far) by (apply Rmult_le_pos; unfold u; lra).
    replace (c * (c * (wa + wb) * (1 + 1000 * u) + 12.3 * (u * far) + 3.05 * (u * (ra + rb))
      + 500 * tiny)) with (c * c * (wa + wb) * (1 + 1000 * u)
      + c * (12.3 * (u * far) + 3.05 * (u * (ra + rb)) + 500 * tiny)) by ring.
    rewrite S2. apply Rplus_le_compat_l. apply Rmult_le_compat_r; lra. }
  assert (PF : 0 <= factor k * (wa + wb)) by (apply Rmult_le_pos; [destruct k; cbn; lra | lra]).
  assert (0 <= u * (ra + rb)) by (apply Rmult_le_pos; unfold u; lra).
  set (f := factor k * (wa + wb)) in *. unfold u in *. lra.
Qed.
End Far.

(* What the finder's test of balls rejects, a normal of the first body rejects. *)
Theorem reported_ordops_binned (k : kind) (a b : ordop_body) :
  sound_ordop a -> sound_ordop b -> sound gradually (bin k a) -> sound gradually (bin k b) ->
  norm (middle a) <= 2 * extent a -> norm (middle b) <= 2 * extent b ->
  (exists x, between k a x) -> (exists x, between k b x) ->
  rejects gradual (sphere gradually (bin k a)) (sphere gradually (bin k b)) = true ->
  let (x, y) := (row_of_body a, row_of_body b) in
  exists member, In member (members k) /\
    normal_separates gradual k (transposed (turn gradual x y)) (gap_a gradual x y)
      (table_of_body a) (table_of_body b) member.
Proof.
  intros Sa Sb Ba Bb Ca Cb (p & Ia) (q & Ib) H. cbv zeta.
  assert (Pos : forall c x, sound_ordop c -> between k c x ->
    forall member, In member (members k) ->
      0 <= fst (table_of_body c member) /\ 0 <= snd (table_of_body c member)).
  { intros c x Sc Ic member M. destruct (between_held k c x Sc Ic) as (Hc & _).
    destruct (Hc member M) as (_ & _ & P & Q). split; assumption. }
  pose proof (Pos a p Sa Ia) as Pa. pose proof (Pos b q Sb Ib) as Pb. clear Pos.
  pose proof Sa as (Oa & Qa & (Ea & Ea') & Ma). pose proof Sb as (Ob & Qb & (Eb & Eb') & Mb).
  destruct (bin_radius_above k (table_of_body a) (extent a) Ea Pa) as (wa & Wa & Na & La).
  destruct (bin_radius_above k (table_of_body b) (extent b) Eb Pb) as (wb & Wb & Nb & Lb).
  assert (Big : IZR (2 ^ 62) <= IZR (2 ^ 100)) by now apply IZR_le.
  pose proof (posed_row_is (pose a) Qa (basis a) (length a) Oa (position a) (middle a)
    (norm (middle a)) ltac:(lra) ltac:(lra)) as Ra.
  pose proof (posed_row_is (pose b) Qb (basis b) (length b) Ob (position b) (middle b)
    (norm (middle b)) ltac:(lra) ltac:(lra)) as Rb.
  apply (far_normal_separates k _ _ _ _ _ _ (norm (middle a)) (norm (middle b)) (row_of_body a)
    (row_of_body b) (norm_nonneg _) (norm_nonneg _) Ra Rb (table_of_body a) (table_of_body b)
    wa wb Wa Wb Pa Pb Na Nb).
  (* The balls' centres are farther apart than the radii. *)
  pose proof gradually_valid as (V & V64 & _).
  destruct Ba as (Qa' & Fa & Ta & Xa & Ya), Bb as (Qb' & Fb & Tb & Xb & Yb).
  destruct (world_ball_contains gradual gradual64 V V64 _ _ _ _ Qa' Fa Ta Xa Ya) as (A0 & A1).
  destruct (world_ball_contains gradual gradual64 V V64 _ _ _ _ Qb' Fb Tb Xb Yb) as (B0 & B1).
  unfold sphere in H. cbn [inflation pose32 pose64 gradually] in H.
  set (ballA := world_ball gradual gradual64 (Rejected.turn (bin k a)) (place (bin k a))
    (centre (shape (bin k a))) (radius (shape (bin k a)))) in *.
  set (ballB := world_ball gradual gradual64 (Rejected.turn (bin k b)) (place (bin k b))
    (centre (shape (bin k b))) (radius (shape (bin k b)))) in *.
  cbn [bin Rejected.turn place shape centre radius] in *.
  assert (Far : radius ballA + radius ballB + room < distance (centre ballA) (centre ballB)).
  { apply Rnot_le_lt. intro N.
    now rewrite (near_balls_not_rejected gradual gradual gradual ballA ballB V V V A0 B0 N) in H. }
  set (ca := posed (pose a) (position a) (middle a)) in *.
  set (cb := posed (pose b) (position b) (middle b)) in *.
  pose proof (distance_triangle (centre ballA) ca (centre ballB)) as T1.
  pose proof (distance_triangle ca cb (centre ballB)) as T2.
  rewrite (distance_symmetric (centre ballA) ca) in T1.
  assert (Gap : distance ca cb = norm (minus
    (plus (position b) (apply (exact_rotation (pose b)) (middle b)))
    (plus (position a) (apply (exact_rotation (pose a)) (middle a))))).
  { unfold distance, ca, cb, posed. f_equal. unfold minus, plus. cbn [px py pz]. f_equal; ring. }
  rewrite <- Gap. pose proof tiny_value as T0. rewrite room_value in Far. unfold slack in *.
  assert (0 <= u * extent a) by (apply Rmult_le_pos; unfold u; lra).
  assert (0 <= u * extent b) by (apply Rmult_le_pos; unfold u; lra).
  assert (PA : 0 <= factor k * wa) by (apply Rmult_le_pos; [destruct k; cbn; lra | lra]).
  assert (PB : 0 <= factor k * wb) by (apply Rmult_le_pos; [destruct k; cbn; lra | lra]).
  replace (factor k * (wa + wb)) with (factor k * wa + factor k * wb) by ring.
  unfold u in *. lra.
Qed.
