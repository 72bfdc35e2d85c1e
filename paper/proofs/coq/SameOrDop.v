(* The test of two or-DOPs that runs (RunOrDop.v) is the one that theorems N and E speak of: on
   numbers of the contract nothing overflows. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Coq Require Import FunctionalExtensionality.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Run RunOrDop Same Controls.
From Sdop Require Import Format Geometry Pose Ieee Shows Duality Vectors Rounded SupportParts.
From Sdop Require Import SupportRounded Separated OrDopTest OrDop Fits.
Import ListNotations.
Open Scope R_scope.

(* Slabs, as the real ones that they stand for. *)
Definition real_slabs (s : RunOrDop.slabs) : slabs :=
  fun member => (B2R (fst (nth member s (Run.zero32, Run.zero32))),
                 B2R (snd (nth member s (Run.zero32, Run.zero32)))).
Definition slabs_fit (s : RunOrDop.slabs) : Prop :=
  forall member negative,
    fits 66 (RunOrDop.end_of s member negative) (end_of (real_slabs s) member negative).

Lemma mirrored_end (s : RunOrDop.slabs) (member : nat) (negative : bool) :
  RunOrDop.end_of (RunOrDop.mirrored s) member negative = RunOrDop.end_of s member (negb negative).
Proof.
  unfold RunOrDop.end_of, RunOrDop.mirrored.
  change (Run.zero32, Run.zero32) with
    ((fun ends : f32 * f32 => (snd ends, fst ends)) (Run.zero32, Run.zero32)).
  rewrite map_nth. now destruct negative.
Qed.

Lemma mirrored_fit (s : RunOrDop.slabs) : slabs_fit s -> slabs_fit (RunOrDop.mirrored s).
Proof.
  intros H member negative. destruct (H member (negb negative)) as (F & E & B).
  pose proof (mirrored_end s member true) as T. pose proof (mirrored_end s member false) as D.
  unfold RunOrDop.end_of in T, D. cbn [negb] in T, D.
  unfold fits. rewrite mirrored_end. unfold real_slabs, end_of in *. cbn [fst snd] in *.
  rewrite T, D. destruct negative; cbn [negb] in *; now repeat split.
Qed.

Lemma mirrored_real (s : RunOrDop.slabs) (member : nat) :
  real_slabs (RunOrDop.mirrored s) member = mirrored (real_slabs s) member.
Proof.
  pose proof (mirrored_end s member true) as T. pose proof (mirrored_end s member false) as D.
  unfold RunOrDop.end_of in T, D. cbn [negb] in T, D.
  unfold real_slabs, mirrored. cbn [fst snd]. now rewrite T, D.
Qed.

Definition number_of (k : kind) : Z := match k with K6 => 6 | K14 => 14 | K18 => 18 | K26 => 26 end.

Definition signs_of_three (e : Run.three f32) : bool * bool * bool :=
  (RunOrDop.negative (Run.first e), RunOrDop.negative (Run.second e),
   RunOrDop.negative (Run.third e)).

Lemma signs_are (n : Z) (e : Run.three f32) (p : point) :
  fits_three n e p -> signs_of (signs_of_three e) p.
Proof.
  intros (X & Y & Z). unfold signs_of, signs_of_three.
  repeat split; eapply negative_sign; eassumption.
Qed.

(* Directions of the test are no longer than 2^20. *)
Lemma support_fits (k : kind) (s : RunOrDop.slabs) (e : Run.three f32) (p : point) :
  slabs_fit s -> fits_three 20 e p ->
  exists n, in_range (n + 1) = true /\ (n <= 110)%Z /\
    fits n (RunOrDop.support (number_of k) s e)
      (support_of gradual k (real_slabs s) (signs_of_three e) p).
Proof.
  intros Hs (E0 & E1 & E2). destruct e as [e0 e1 e2]. cbn [Run.first Run.second Run.third] in *.
  pose proof (absolute_fits _ _ _ E0) as A. pose proof (absolute_fits _ _ _ E1) as B.
  pose proof (absolute_fits _ _ _ E2) as C.
  unfold RunOrDop.support, support_of, signs_of_three, Run.each.
  cbn [Run.first Run.second Run.third].
  set (i := RunOrDop.negative e0). set (j := RunOrDop.negative e1).
  set (l := RunOrDop.negative e2). set (a := Babs e0) in *. set (b := Babs e1) in *.
  set (c := Babs e2) in *. clearbody i j l a b c.
  pose proof (Hs 0%nat i) as X. pose proof (Hs 1%nat j) as Y. pose proof (Hs 2%nat l) as Z.
  assert (Pair : forall member x y,
    fits 66 (RunOrDop.pair s member x y) (pair (real_slabs s) member x y)) by (intros; apply Hs).
  assert (Facing : forall x y z,
    fits 66 (RunOrDop.facing s x y z) (facing (real_slabs s) x y z)) by (intros; apply Hs).
  pose proof (Pair 3%nat i j) as XY. pose proof (Pair 5%nat i l) as XZ.
  pose proof (Pair 7%nat j l) as YZ. pose proof (Facing i j l) as S.
  pose proof (Facing (negb i) j l) as Oa. pose proof (Facing i (negb j) l) as Ob.
  pose proof (Facing i j (negb l)) as Oc. clear Pair Facing Hs E0 E1 E2.
  destruct k; (cbn [number_of Z.eqb Pos.eqb];
    unfold RunOrDop.support_14, RunOrDop.support_18, RunOrDop.support_26, RunOrDop.minima,
      RunOrDop.leads, RunOrDop.cube, RunOrDop.pairs, RunOrDop.axes,
      rounded_6, rounded_14, rounded_18, rounded_26, leads_of, lead_of;
    cbv beta iota zeta; cbn [Run.first Run.second Run.third fst snd];
    eexists; (split; [| split]); [| | repeat fit_step];
    [vm_compute; reflexivity | vm_compute; discriminate]).
Qed.

Lemma members_are (k : kind) : RunOrDop.members (number_of k) = members k.
Proof. now destruct k. Qed.

Lemma mirrored_slabs (s : RunOrDop.slabs) :
  real_slabs (RunOrDop.mirrored s) = mirrored (real_slabs s).
Proof. apply functional_extensionality. apply mirrored_real. Qed.

Lemma combination_fits (n : Z) (v : Run.three f32) (p : point) (member : nat) :
  fits_three n v p -> (-100 <= n <= 100)%Z -> In member (members K26) ->
  fits (n + 2) (nth member (RunOrDop.combinations v) Run.zero32) (combination gradual p member).
Proof.
  intros (X & Y & Z) N M. destruct v as [x y z]. cbn [Run.first Run.second Run.third] in *.
  assert (R1 : in_range (Z.max n n + 1) = true)
    by (unfold in_range; apply andb_true_intro; rewrite !Z.leb_le; lia).
  assert (R2 : in_range (Z.max (Z.max n n + 1) n + 1) = true)
    by (unfold in_range; apply andb_true_intro; rewrite !Z.leb_le; lia).
  assert (R3 : in_range (Z.max n (Z.max n n + 1) + 1) = true)
    by (unfold in_range; apply andb_true_intro; rewrite !Z.leb_le; lia).
  pose proof (plus_fits _ _ _ _ _ _ X Y R1) as S. pose proof (minus_fits _ _ _ _ _ _ X Y R1) as D.
  pose proof (plus_fits _ _ _ _ _ _ S Z R2) as S1. pose proof (minus_fits _ _ _ _ _ _ Z D R3) as S2.
  pose proof (plus_fits _ _ _ _ _ _ D Z R2) as S3. pose proof (minus_fits _ _ _ _ _ _ Z S R3) as S4.
  pose proof (plus_fits _ _ _ _ _ _ X Z R1) as S5. pose proof (minus_fits _ _ _ _ _ _ X Z R1) as S6.
  pose proof (plus_fits _ _ _ _ _ _ Y Z R1) as S7. pose proof (minus_fits _ _ _ _ _ _ Y Z R1) as S8.
  unfold RunOrDop.combinations, combination. cbv beta iota zeta.
  repeat (destruct M as [<- | M]); [.. | destruct M]; cbn [nth];
    match goal with H : fits ?k ?a _ |- fits _ ?a _ => apply (fits_more k); [lia | exact H] end.
Qed.

Definition flipped_number (negative : bool) (a : R) : R := if negative then - a else a.

Lemma flip_fits (n : Z) (x sign : f32) (a : R) :
  fits n x a -> fits n (RunOrDop.flip32 x sign) (flipped_number (RunOrDop.negative sign) a).
Proof.
  intro H. unfold RunOrDop.flip32, flipped_number.
  destruct (RunOrDop.negative sign); [now apply opposite_fits | exact H].
Qed.

Lemma flipped_point (negative : bool) (p : point) :
  flipped negative p = pt (flipped_number negative (px p)) (flipped_number negative (py p))
    (flipped_number negative (pz p)).
Proof. destruct negative, p; reflexivity. Qed.

Definition fits_matrix (n : Z) (r : Run.three (Run.three f32)) (a : matrix) : Prop :=
  fits_three n (Run.first r) (row0 a) /\ fits_three n (Run.second r) (row1 a) /\
  fits_three n (Run.third r) (row2 a).

Lemma transposed_fits (n : Z) (r : Run.three (Run.three f32)) (a : matrix) :
  fits_matrix n r a -> fits_matrix n (RunOrDop.transposed r) (transposed a).
Proof.
  intros ((A0 & A1 & A2) & (B0 & B1 & B2) & (C0 & C1 & C2)). repeat split; assumption || apply A0
    || apply A1 || apply A2 || apply B0 || apply B1 || apply B2 || apply C0 || apply C1 || apply C2.
Qed.

(* One body's normals. *)
Lemma normals_are (k : kind) (t : Run.three (Run.three f32)) (gap : Run.three f32)
    (own other : RunOrDop.slabs) (lines : matrix) (p : point) :
  fits_matrix 4 (RunOrDop.transposed t) lines -> fits_three 68 gap p -> slabs_fit own ->
  slabs_fit other -> RunOrDop.by_normals (number_of k) t gap own other = true ->
  exists member, In member (members k) /\
    normal_separates gradual k lines p (real_slabs own) (real_slabs other) member.
Proof.
  intros (L0 & L1 & L2) G Ho Hs H. unfold RunOrDop.by_normals in H. cbv zeta in H.
  rewrite members_are in H. apply existsb_exists in H. destruct H as (member & M & H).
  exists member. split; [exact M |]. pose proof (members_all k member M) as M'.
  set (tau := nth member (RunOrDop.combinations gap) Run.zero32) in *.
  pose proof (combination_fits _ gap p member G ltac:(lia) M') as Tau. fold tau in Tau.
  pose proof (combination_fits _ _ _ member L0 ltac:(lia) M') as C0.
  pose proof (combination_fits _ _ _ member L1 ltac:(lia) M') as C1.
  pose proof (combination_fits _ _ _ member L2 ltac:(lia) M') as C2.
  unfold Run.each in H. cbn [Run.first Run.second Run.third] in H.
  apply (flip_fits _ _ tau) in C0, C1, C2.
  set (e := pt (combination gradual (row0 lines) member) (combination gradual (row1 lines) member)
    (combination gradual (row2 lines) member)).
  match type of H with context [RunOrDop.support _ _ ?v] => set (towards := v) in * end.
  assert (T : fits_three 20 towards (flipped (RunOrDop.negative tau) e)).
  { rewrite flipped_point. split; [| split]; (eapply fits_more; [| eassumption]); lia. }
  destruct (support_fits k _ _ _ (mirrored_fit other Hs) T) as (n & R & N & S).
  rewrite mirrored_slabs in S.
  pose proof (Ho member (RunOrDop.negative tau)) as O.
  assert (Rn : in_range (Z.max 66 n + 1) = true).
  { unfold in_range in *. apply andb_prop in R. apply andb_true_intro. rewrite !Z.leb_le in *. lia.
    }
  pose proof (plus_fits _ _ _ _ _ _ O S Rn) as Sum.
  rewrite (greater32_fits _ _ _ _ _ _ (absolute_fits _ _ _ Tau) Sum) in H.
  exists (RunOrDop.negative tau), (signs_of_three towards).
  split; [exact (negative_sign _ _ _ Tau) |]. split; [exact (signs_are _ _ _ T) | exact H].
Qed.

(* Edges. *)
Lemma edge_fits (k : kind) (e : Run.three f32) :
  In e (RunOrDop.edges (number_of k)) -> fits_three 1 e (Same.real_point e).
Proof.
  unfold RunOrDop.edges. cbv zeta. intro H. apply in_map_iff in H.
  destruct H as ([[x y] z] & <- & H).
  set (small := fun t : Z * Z * Z => let '(x, y, z) := t in
    ((Z.abs x <=? 2) && (Z.abs y <=? 2) && (Z.abs z <=? 2))%Z).
  assert (Small : small (x, y, z) = true).
  { revert H. apply forallb_forall. destruct k; vm_compute; reflexivity. }
  unfold small in Small. apply andb_prop in Small. destruct Small as [Small Z'].
  apply andb_prop in Small. destruct Small as [X' Y']. apply Z.leb_le in X', Y', Z'.
  assert (One : forall n, (Z.abs n <= 2)%Z -> fits 1 (number n 0) (B2R (number n 0))).
  { intros n N. split; [| split; [reflexivity |]].
    - assert (C : (n = -2 \/ n = -1 \/ n = 0 \/ n = 1 \/ n = 2)%Z) by lia.
      destruct C as [-> | [-> | [-> | [-> | ->]]]]; vm_compute; reflexivity.
    - rewrite Controls.number_value by lia. change (bpow radix2 0) with 1.
      rewrite Rmult_1_r, <- abs_IZR. change (bpow radix2 1) with 2. now apply IZR_le. }
  split; [| split]; unfold Same.real_point, pt; cbn [Run.first Run.second Run.third px py pz];
    now apply One.
Qed.

Lemma cross_fits (n v : Run.three f32) (p q : point) :
  fits_three 1 n p -> fits_three 7 v q ->
  fits_three 9 (RunOrDop.cross n v) (cross gradual p q).
Proof.
  destruct n as [a b c], v as [x y z]. intros (A & B & C) (X & Y & Z).
  cbn [Run.first Run.second Run.third] in *. unfold RunOrDop.cross, cross.
  split; [| split]; cbn [Run.first Run.second Run.third px py pz pt];
    change 9%Z with (Z.max (1 + 7) (1 + 7) + 1)%Z; repeat fit_step.
Qed.

Lemma negated_fits (n : Z) (x : f32) (a : R) :
  fits n x a -> (-100 <= n <= 100)%Z -> fits (n + 1) (minus32 Run.zero32 x) (sub gradual 0 a).
Proof.
  intros H N. assert (E : (Z.max (-100) n + 1 = n + 1)%Z) by lia. rewrite <- E.
  apply minus_fits; [exact zero_fits | exact H |].
  unfold in_range. apply andb_true_intro. rewrite !Z.leb_le. lia.
Qed.

Lemma edges_are (k : kind) (f : RunOrDop.frames) (a b : RunOrDop.slabs) (t : matrix) (p : point) :
  fits_matrix 4 (RunOrDop.turn f) t -> fits_three 68 (RunOrDop.gap_a f) p -> slabs_fit a ->
  slabs_fit b -> RunOrDop.by_edges (number_of k) f a b = true ->
  exists edge_a edge_b,
    edges_separate gradual k t p (real_slabs a) (real_slabs b) edge_a edge_b.
Proof.
  intros T G Ha Hb H. unfold RunOrDop.by_edges in H. cbv zeta in H.
  apply existsb_exists in H. destruct H as (edge_b & Mb & H).
  apply existsb_exists in H. destruct H as (edge_a & Ma & H).
  apply edge_fits in Ma, Mb.
  exists (Same.real_point edge_a), (Same.real_point edge_b). unfold edges_separate. cbv zeta.
  pose proof (transposed_fits _ _ _ T) as T'. destruct T as (T0 & T1 & T2).
  set (axis := cross gradual (Same.real_point edge_a) _).
  match type of H with context [RunOrDop.cross edge_a ?v] =>
    set (axis32 := RunOrDop.cross edge_a v) in * end.
  assert (Axis : fits_three 9 axis32 axis).
  { apply cross_fits; [exact Ma |]. unfold Run.each.
    split; [| split]; cbn [Run.first Run.second Run.third px py pz pt];
      change 7%Z with (1 + 4 + 2)%Z; now apply dot_fits. }
  clearbody axis axis32. clear Ma Mb edge_a edge_b.
  pose proof (dot_fits _ _ _ _ _ _ Axis G eq_refl eq_refl) as Tau.
  set (tau := RunOrDop.dot32 axis32 (RunOrDop.gap_a f)) in *.
  destruct Axis as (A0 & A1 & A2).
  match type of H with context [Run.each ?v axis32] => set (towards := Run.each v axis32) in * end.
  assert (Tw : fits_three 9 towards (flipped (RunOrDop.negative tau) axis)).
  { rewrite flipped_point. unfold towards, Run.each. split; [| split]; now apply flip_fits. }
  match type of H with context [RunOrDop.support _ b ?v] => set (away := v) in * end.
  assert (Aw : fits_three 16 away
    (negated gradual (along_axes gradual (transposed t) (flipped (RunOrDop.negative tau) axis)))).
  { destruct T' as (C0 & C1 & C2). unfold away, Run.each, negated, along_axes.
    split; [| split]; cbn [Run.first Run.second Run.third px py pz pt];
      change 16%Z with (4 + 9 + 2 + 1)%Z; (apply negated_fits; [| lia]); now apply dot_fits. }
  assert (Tw' : fits_three 20 towards (flipped (RunOrDop.negative tau) axis)).
  { destruct Tw as (B0 & B1 & B2). split; [| split]; (eapply fits_more; [| eassumption]); lia. }
  assert (Aw' : fits_three 20 away
    (negated gradual (along_axes gradual (transposed t) (flipped (RunOrDop.negative tau) axis)))).
  { destruct Aw as (B0 & B1 & B2). split; [| split]; (eapply fits_more; [| eassumption]); lia. }
  destruct (support_fits k a _ _ Ha Tw') as (n & Rn & _ & Sa).
  destruct (support_fits k b _ _ Hb Aw') as (n' & Rn' & _ & Sb).
  apply andb_prop in H. destruct H as (Long & H).
  pose proof (dot_fits _ _ _ _ _ _ (conj A0 (conj A1 A2)) (conj A0 (conj A1 A2)) eq_refl eq_refl)
    as Square.
  rewrite (greater32_fits _ _ _ _ _ _ Square quarter_fits) in Long.
  assert (R : in_range (Z.max n n' + 1) = true).
  { unfold in_range in *. apply andb_prop in Rn, Rn'. apply andb_true_intro.
    rewrite !Z.leb_le in *. lia. }
  pose proof (plus_fits _ _ _ _ _ _ Sa Sb R) as Sum.
  rewrite (greater32_fits _ _ _ _ _ _ (absolute_fits _ _ _ Tau) Sum) in H.
  exists (RunOrDop.negative tau), (signs_of_three towards), (signs_of_three away).
  split; [exact (negative_sign _ _ _ Tau) |]. split; [exact (signs_are _ _ _ Tw) |].
  split; [exact (signs_are _ _ _ Aw) |]. now split.
Qed.

(* Rows. *)
Definition row_fits (r : RunOrDop.row) (x : row) : Prop :=
  fits_matrix 1 (RunOrDop.axis_of_row r) (row_axes x) /\
  fits_three 62 (RunOrDop.translation r) (row_place x) /\
  fits_three 62 (RunOrDop.offset r) (row_offset x).

Lemma frames_fit (a b : RunOrDop.row) (x y : row) :
  row_fits a x -> row_fits b y ->
  let f := RunOrDop.frames_of a b in
  fits_matrix 4 (RunOrDop.turn f) (turn gradual x y) /\
  fits_three 68 (RunOrDop.gap_a f) (gap_a gradual x y) /\
  fits_three 68 (RunOrDop.gap_b f) (gap_b gradual x y).
Proof.
  intros ((A0 & A1 & A2) & (S0 & S1 & S2) & (O0 & O1 & O2))
    ((B0 & B1 & B2) & (T0 & T1 & T2) & (P0 & P1 & P2)). unfold RunOrDop.frames_of. cbv zeta.
  match goal with |- context [RunOrDop.dot32 _ (Run.Three ?x ?y ?z)] =>
    set (delta32 := Run.Three x y z) in * end.
  assert (D : fits_three 64 delta32 (delta gradual x y)).
  { unfold delta32, delta. cbv zeta.
    split; [| split]; cbn [Run.first Run.second Run.third px py pz pt];
      change 64%Z with (Z.max (Z.max 62 62 + 1) (Z.max 62 62 + 1) + 1)%Z; repeat fit_step. }
  clearbody delta32. cbn [RunOrDop.turn RunOrDop.gap_a RunOrDop.gap_b].
  split; [| split].
  - unfold turn, Run.each. split; [| split]; (split; [| split]);
      cbn [Run.first Run.second Run.third px py pz pt row0 row1 row2];
      change 4%Z with (1 + 1 + 2)%Z; now apply dot_fits.
  - unfold gap_a, along_axes, Run.each. split; [| split];
      cbn [Run.first Run.second Run.third px py pz pt]; apply (fits_more (1 + 64 + 2));
      try lia; now apply dot_fits.
  - unfold gap_b, negated, along_axes, Run.each. split; [| split];
      cbn [Run.first Run.second Run.third px py pz pt];
      change 68%Z with (1 + 64 + 2 + 1)%Z; (apply negated_fits; [| lia]); now apply dot_fits.
Qed.

(* What the test that runs rejects is rejected by the one of real numbers. *)
Theorem run_rejects (k : kind) (full : bool) (a b : RunOrDop.row) (sa sb : RunOrDop.slabs)
    (x y : row) :
  row_fits a x -> row_fits b y -> slabs_fit sa -> slabs_fit sb ->
  RunOrDop.ordops_apart (number_of k) full a b sa sb = true ->
  ordops_rejected gradual k x y (real_slabs sa) (real_slabs sb).
Proof.
  intros Hx Hy Ha Hb H. destruct (frames_fit a b x y Hx Hy) as (T & Ga & Gb).
  unfold RunOrDop.ordops_apart in H. cbv zeta in H. set (f := RunOrDop.frames_of a b) in *.
  apply orb_prop in H. destruct H as [H | H]; [apply orb_prop in H; destruct H as [H | H] |].
  - left. revert H. apply normals_are; try assumption. now apply transposed_fits.
  - right. left. revert H. apply normals_are; try assumption.
  - right. right. apply andb_prop in H. destruct H as (_ & H). revert H.
    now apply edges_are.
Qed.
