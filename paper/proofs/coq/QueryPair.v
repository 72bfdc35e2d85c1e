(* Theorem Q (4): two posed bodies whose meshes, grown by their margins, share a point may touch. With
   gradual underflow. *)
From Coq Require Import Reals ZArith Bool List Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place WorldBall Ieee Shows Outward.
From Sdop Require Import Finder Duality Vectors Norms64 Separated OrDopTest OrDop OrDopPose.
From Sdop Require Import Cells Query InBody QueryBody QuerySupport.
Import ListNotations.
Open Scope R_scope.

Local Notation g := gradual64.

(* Coordinates along the basis by number, and sums of signed basis vectors as points. *)
Definition coordinate (i : nat) (p : point) : R := match i with O => px p | 1%nat => py p | _ => pz p end.
Definition sign (x : R) : R := if Rlt_bool x 0 then -1 else 1.
Definition signed_unit (i : nat) (x : R) : point :=
  match i with O => pt (sign x) 0 0 | 1%nat => pt 0 (sign x) 0 | _ => pt 0 0 (sign x) end.
Definition orders : list (nat * nat * nat) :=
  [(0, 1, 2); (0, 2, 1); (1, 0, 2); (1, 2, 0); (2, 0, 1); (2, 1, 0)]%nat.

(* src/posed/mod.rs: QueryShape::of. What a support needs: the basis and the end that faces each sum
   of signed basis vectors. *)
Record facets := { set_of : kind; basis : matrix; basis_length : R; over_square : R;
                   ends : point -> R }.
Definition facing_of (h : facets) (a : point) (i j l : nat) : facing :=
  let u n := signed_unit n (coordinate n a) in
  {| own_a := ends h (u i); own_b := ends h (u j); own_c := ends h (u l);
     pair_ab := ends h (plus (u i) (u j)); pair_ac := ends h (plus (u i) (u l));
     pair_bc := ends h (plus (u j) (u l)); all_abc := ends h (plus (u i) (plus (u j) (u l)));
     bent_abc := ends h (plus (u i) (plus (u j) (opposite (u l)))) |}.
Definition along_basis (h : facets) (e : point) : point :=
  let along b := mul64 g (rotate_row g e b) (over_square h) in
  pt (along (row0 (basis h))) (along (row1 (basis h))) (along (row2 (basis h))).

(* src/posed/mod.rs: QueryShape::support. Of equal sizes either may come first. *)
Definition is_support (h : facets) (e : point) (s : R) : Prop :=
  let a := along_basis h e in
  let size n := Rabs (coordinate n a) in
  exists i j l, In (i, j, l) orders /\ size l <= size j /\ size j <= size i /\
    s = support64 (set_of h) (facing_of h a i j l) (size i) (size j) (size l).

(* Facets of slabs that are tight about a mesh with this point. *)
Definition basis_coordinates (h : facets) (y : point) : point := apply (basis h) y.
Definition sum_of (count : R) (f : point) : Prop :=
  let one x := x = -1 \/ x = 0 \/ x = 1 in one (px f) /\ one (py f) /\ one (pz f) /\ square f = count.
Definition counts (k : kind) : list R :=
  match k with K6 => [1] | K14 => [1; 3] | K18 => [1; 2] | K26 => [1; 2; 3] end.
Definition sound_facets (h : facets) (reach : R) (y : point) : Prop :=
  basis_of_length (basis h) (basis_length h) /\
  Rabs (over_square h - / (basis_length h * basis_length h))
    <= 3 * v * / (basis_length h * basis_length h) /\
  norm y <= reach /\
  forall count f, In count (counts (set_of h)) -> sum_of count f ->
    dot f (basis_coordinates h y) <= ends h f /\ Rabs (ends h f) <= 2 * basis_length h * reach.

Section Support.
Variable h : facets.
Variables reach : R.
Variable y : point.
Hypothesis Hh : sound_facets h reach y.
Let n : R := basis_length h.
Let w : point := basis_coordinates h y.

Lemma basis_sizes : / 4 <= n <= 2 /\ norm w <= n * reach /\ 0 <= reach /\
  forall e, dot e y = dot (apply (basis h) e) w / (n * n).
Proof.
  destruct Hh as (Bs & _ & Y & _). pose proof Bs as (N & _). fold n in N.
  pose proof (unit_basis_orthonormal _ _ Bs) as O. fold n in O. pose proof (norm_nonneg y) as Py.
  assert (Scale : forall x, apply (unit_basis (basis h) n) x = scaled (/ n) (apply (basis h) x)).
  { intro x. unfold apply, unit_basis, scaled, dot, pt. cbn [row0 row1 row2 px py pz]. f_equal; ring. }
  split; [exact N |]. split; [| split; [lra |]].
  - pose proof (norm_apply _ y O) as A. rewrite Scale, norm_scaled in A
      by (apply Rlt_le, Rinv_0_lt_compat; lra). fold w in A.
    apply Rmult_le_reg_l with (/ n); [apply Rinv_0_lt_compat; lra |].
    rewrite <- Rmult_assoc, Rinv_l, Rmult_1_l by lra. unfold w, basis_coordinates. lra.
  - intro e. rewrite <- (combined_apply _ e O) at 1. rewrite combined_dot, !Scale.
    unfold w, basis_coordinates, scaled, dot, pt. cbn [px py pz]. field. lra.
Qed.

Lemma along_near (e b : point) :
  / 8 <= norm e -> norm b = n ->
  Rabs (mul64 g (rotate_row g e b) (over_square h) - dot b e / (n * n)) <= 7.2 * v * (norm e / n) /\
  Rabs (mul64 g (rotate_row g e b) (over_square h)) <= 1.01 * (norm e / n).
Proof.
  intros E Nb. destruct basis_sizes as (N & _). destruct Hh as (_ & Ov & _). fold n in Ov.
  pose proof v_value as V. pose proof (proj1 tiny64_value) as T0.
  pose proof (dot_rounded e b) as D. rewrite Nb in D. rewrite (dot_swap b e).
  set (d := rotate_row g e b) in *. set (o := over_square h) in *. set (x := dot e b) in *.
  set (i := / (n * n)) in *.
  assert (Nn : / 16 <= n * n).
  { replace (/ 16) with (/ 4 * / 4) by lra. apply Rmult_le_compat; lra. }
  assert (I : 0 < i <= 16).
  { unfold i. split; [apply Rinv_0_lt_compat; lra |]. rewrite <- (Rinv_inv 16). apply Rinv_le_contravar; lra. }
  assert (X : Rabs x <= norm e * n) by (rewrite <- Nb; apply dot_norms).
  assert (En : / 16 <= norm e / n).
  { unfold Rdiv. replace (/ 16) with (/ 8 * / 2) by lra. apply Rmult_le_compat; try lra.
    apply Rinv_le_contravar; lra. }
  assert (Ei : norm e * n * i = norm e / n) by (unfold i; field; lra).
  set (k := norm e / n) in *.
  assert (Tk : tiny64 <= / 1000000 * (v * k)).
  { pose proof tiny64_dust.
    assert (dust <= v / 1000000 / 1000000).
    { unfold dust, v, Rdiv. rewrite <- !Rinv_mult, <- !mult_IZR.
      apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
    assert (v * / 16 <= v * k) by (apply Rmult_le_compat_l; lra). lra. }
  assert (Oi : Rabs o <= 1.001 * i).
  { pose proof (Rabs_triang_inv o i) as Tr. rewrite (Rabs_pos_eq i) in Tr by lra. unfold v in *. lra. }
  assert (P : Rabs (d * o - x * i) <= 6.05 * (v * k)).
  { replace (d * o - x * i) with ((d - x) * o + x * (o - i)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). rewrite !Rabs_mult.
    assert (A1 : Rabs (d - x) * Rabs o <= (3.01 * v * (norm e * n) + 6 * tiny64) * (1.001 * i))
      by (apply Rmult_le_compat; try apply Rabs_pos; assumption).
    assert (A2 : Rabs x * Rabs (o - i) <= norm e * n * (3 * v * i))
      by (apply Rmult_le_compat; try apply Rabs_pos; assumption).
    replace (norm e * n * (3 * v * i)) with (3 * (v * k)) in A2 by (rewrite <- Ei; ring).
    replace ((3.01 * v * (norm e * n) + 6 * tiny64) * (1.001 * i))
      with (3.01 * 1.001 * (v * k) + 6 * 1.001 * (tiny64 * i)) in A1 by (rewrite <- Ei; ring).
    assert (tiny64 * i <= tiny64 * 16) by (apply Rmult_le_compat_l; lra). lra. }
  unfold mul64. rewrite !read64_is. pose proof (rounded64 (d * o)) as R.
  assert (Xk : Rabs (x * i) <= k).
  { rewrite Rabs_mult, (Rabs_pos_eq i) by lra. rewrite <- Ei. apply Rmult_le_compat_r; lra. }
  pose proof (Rabs_triang_inv (d * o) (x * i)) as Tr.
  assert (Vk : 0 <= v * k <= / 1000000 * k).
  { split; [apply Rmult_le_pos; lra | apply Rmult_le_compat_r; unfold v; lra]. }
  assert (Do : Rabs (d * o) <= 1.001 * k) by lra.
  apply (Rmult_le_compat_l v) in Do; [| lra].
  assert (Fin : Rabs (fl64 g (d * o) - x * i) <= 7.2 * (v * k)).
  { replace (fl64 g (d * o) - x * i) with ((fl64 g (d * o) - d * o) + (d * o - x * i)) by ring.
    apply Rle_trans with (1 := Rabs_triang _ _). lra. }
  unfold Rdiv. fold i. split; [lra |]. pose proof (Rabs_triang_inv (fl64 g (d * o)) (x * i)). lra.
Qed.

Lemma sign_square (x : R) : sign x * sign x = 1.
Proof. unfold sign. case Rlt_bool; ring. Qed.

Lemma signs_sum (count : R) (f : point) :
  let one x := x = 0 \/ x * x = 1 in
  one (px f) -> one (py f) -> one (pz f) -> square f = count -> sum_of count f.
Proof.
  intros one X Y Z S.
  assert (One : forall x, one x -> x = -1 \/ x = 0 \/ x = 1).
  { intros x [-> | H]; [auto |]. assert (E : (x - 1) * (x + 1) = 0) by (ring_simplify; lra).
    apply Rmult_integral in E. lra. }
  repeat split; auto.
Qed.

Ltac signs :=
  apply signs_sum; unfold square, plus, opposite, signed_unit, pt; cbn [px py pz];
  rewrite ?Ropp_0, ?Rplus_0_l, ?Rplus_0_r, ?Rmult_opp_opp, ?Rmult_0_l, ?Rplus_0_l, ?Rplus_0_r,
    ?sign_square; auto; lra.

Lemma signed_coordinate (i : nat) (a z : point) :
  In i [0; 1; 2]%nat ->
  Rabs (coordinate i a) * dot (signed_unit i (coordinate i a)) z = coordinate i a * coordinate i z.
Proof.
  intro I. unfold signed_unit, sign. cbn in I.
  destruct I as [<- | [<- | [<- | []]]]; cbn [coordinate];
    (case Rlt_bool_spec; intro S; [rewrite Rabs_left by exact S | rewrite Rabs_pos_eq by exact S]);
    unfold dot, pt; cbn [px py pz]; ring.
Qed.

Lemma facet_holds (count : R) (f : point) :
  In count (counts (set_of h)) -> sum_of count f ->
  dot f w <= ends h f /\ bounded (2 * n * reach) (ends h f) /\ bounded (2 * n * reach) (dot f w).
Proof.
  intros C S. destruct basis_sizes as (N & W & R0 & _). destruct Hh as (_ & _ & _ & F).
  destruct (F count f C S) as (F1 & F2). fold n w in F1, F2.
  split; [exact F1 |]. split; [exact F2 |]. unfold bounded.
  apply Rle_trans with (1 := dot_norms f w). replace (2 * n * reach) with (2 * (n * reach)) by ring.
  apply Rmult_le_compat; try apply norm_nonneg; [| exact W].
  apply norm_below; [lra |]. destruct S as (_ & _ & _ & ->).
  destruct (set_of h); cbn in C; intuition lra.
Qed.

Theorem support_bounds_mesh (e : point) (s : R) :
  / 8 <= norm e -> is_support h e s -> dot e y <= s + 80 * v * (norm e * reach) + 10 * tiny64.
Proof.
  intros E (i & j & l & O & S1 & S2 & ->). destruct basis_sizes as (N & W & R0 & Dot).
  pose proof v_value as V. pose proof (proj1 tiny64_value) as T0.
  pose proof Hh as (Bs & _). destruct (basis_norm _ _ Bs) as (N0 & N1 & N2). fold n in N0, N1, N2.
  set (a := along_basis h e) in *. set (B := 2 * n * reach).
  set (k := norm e / n).
  assert (Near : forall m, In m [0; 1; 2]%nat -> format64 (coordinate m a) /\
    Rabs (coordinate m a) <= 1.01 * k /\
    Rabs (coordinate m a * coordinate m w - coordinate m (apply (basis h) e) / (n * n) * coordinate m w)
      <= 7.2 * v * (norm e * reach)).
  { intros m M.
    assert (K : Rabs (coordinate m w) <= n * reach).
    { destruct (coordinates_of_norm w _ W) as (X & Y & Z). cbn in M.
      destruct M as [<- | [<- | [<- | []]]]; assumption. }
    assert (A : Rabs (coordinate m a - coordinate m (apply (basis h) e) / (n * n)) <= 7.2 * v * k /\
      Rabs (coordinate m a) <= 1.01 * k /\ format64 (coordinate m a)).
    { cbn in M. destruct M as [<- | [<- | [<- | []]]]; cbn [coordinate];
        unfold a, along_basis, apply, pt; cbn [px py pz];
        (split; [now apply along_near | split; [now apply along_near | apply format64_result]]). }
    destruct A as (A1 & A2 & A3). split; [exact A3 |]. split; [exact A2 |].
    rewrite <- Rmult_minus_distr_r, Rabs_mult.
    replace (7.2 * v * (norm e * reach)) with (7.2 * v * k * (n * reach)) by (unfold k; field; lra).
    apply Rmult_le_compat; try apply Rabs_pos; assumption. }
  assert (Dots : dot e y = coordinate 0 (apply (basis h) e) / (n * n) * coordinate 0 w
    + coordinate 1 (apply (basis h) e) / (n * n) * coordinate 1 w
    + coordinate 2 (apply (basis h) e) / (n * n) * coordinate 2 w).
  { rewrite Dot. unfold dot, coordinate. field. lra. }
  destruct (Near 0%nat ltac:(cbn; tauto)) as (_ & _ & C0).
  destruct (Near 1%nat ltac:(cbn; tauto)) as (_ & _ & C1).
  destruct (Near 2%nat ltac:(cbn; tauto)) as (_ & _ & C2).
  apply Rabs_le_inv in C0, C1, C2.
  assert (Mem : In i [0; 1; 2]%nat /\ In j [0; 1; 2]%nat /\ In l [0; 1; 2]%nat).
  { cbn in O. repeat (destruct O as [O | O]; [injection O as <- <- <-; cbn; tauto |]). destruct O. }
  destruct Mem as (Mi & Mj & Ml).
  destruct (Near i Mi) as (Fi & Bi & _). destruct (Near j Mj) as (Fj & _). destruct (Near l Ml) as (Fl & _).
  set (u := fun m => signed_unit m (coordinate m a)).
  assert (Sum : coordinate 0 a * coordinate 0 w + coordinate 1 a * coordinate 1 w
    + coordinate 2 a * coordinate 2 w = Rabs (coordinate i a) * dot (u i) w
    + Rabs (coordinate j a) * dot (u j) w + Rabs (coordinate l a) * dot (u l) w).
  { unfold u. rewrite !signed_coordinate by assumption. cbn in O.
    repeat (destruct O as [O | O]; [injection O as <- <- <-; ring |]). destruct O. }
  assert (PB : 0 <= B) by (unfold B; apply Rmult_le_pos; lra).
  assert (Formats : format64 (Rabs (coordinate i a)) /\ format64 (Rabs (coordinate j a)) /\
    format64 (Rabs (coordinate l a))) by (repeat split; now apply generic_format_abs).
  assert (One : forall m, sum_of 1 (u m)).
  { intro m. unfold u. destruct m as [| [| m]]; signs. }
  assert (Two : forall x z, (x, z) = (i, j) \/ (x, z) = (i, l) \/ (x, z) = (j, l) ->
    sum_of 2 (plus (u x) (u z))).
  { intros x z H. cbn in O. unfold u.
    repeat (destruct O as [O | O]; [injection O as <- <- <-;
      destruct H as [H | [H | H]]; injection H as -> ->; signs |]). destruct O. }
  assert (Three : sum_of 3 (plus (u i) (plus (u j) (u l))) /\
    sum_of 3 (plus (u i) (plus (u j) (opposite (u l))))).
  { cbn in O. unfold u.
    repeat (destruct O as [O | O]; [injection O as <- <- <-; split; signs |]). destruct O. }
  assert (Faces : faces (dot (u i) w) (dot (u j) w) (dot (u l) w) B (set_of h) (facing_of h a i j l)).
  { unfold faces, facing_of. cbn [own_a own_b own_c pair_ab pair_ac pair_bc all_abc bent_abc].
    pose proof facet_holds as Fh. fold B in Fh. fold (u i) (u j) (u l).
    assert (D2 : forall x z, dot (plus x z) w = dot x w + dot z w)
      by (intros; unfold dot, plus; cbn [px py pz]; ring).
    assert (Do : forall x, dot (opposite x) w = - dot x w) by (intros; apply opposite_dot).
    destruct Three as (T1 & T2).
    pose proof (Two i j ltac:(tauto)) as Pij. pose proof (Two i l ltac:(tauto)) as Pil.
    pose proof (Two j l ltac:(tauto)) as Pjl.
    split; [| split; [| split; [| split]]].
    - intro K. rewrite K in Fh. split; apply (Fh 1); cbn; auto.
    - apply (Fh 1); [| apply One]. destruct (set_of h); cbn; tauto.
    - intro K. rewrite K in Fh.
      replace (dot (u i) w + dot (u j) w + dot (u l) w) with (dot (plus (u i) (plus (u j) (u l))) w)
        by (rewrite !D2; ring).
      replace (dot (u i) w + dot (u j) w - dot (u l) w)
        with (dot (plus (u i) (plus (u j) (opposite (u l)))) w) by (rewrite !D2, Do; ring).
      split; apply (Fh 3); cbn; auto.
    - intro K. rewrite K in Fh. rewrite <- !D2.
      split; [| split]; apply (Fh 2); cbn; auto.
    - intro K. rewrite K in Fh. rewrite <- D2.
      replace (dot (plus (u i) (u j)) w + dot (u l) w) with (dot (plus (u i) (plus (u j) (u l))) w)
        by (rewrite !D2; ring).
      split; [apply (Fh 3) | apply (Fh 2)]; cbn; auto. }
  pose proof (support_covers _ _ _ _ _ _ B ltac:(repeat split; [apply Rabs_pos | exact S1 | exact S2])
    Formats PB (set_of h) _ Faces) as Co.
  rewrite <- Sum in Co.
  assert (VB : v * Rabs (coordinate i a) * B <= 2.02 * (v * (norm e * reach))).
  { assert (Kn : norm e = k * n) by (unfold k; field; lra). rewrite Kn.
    apply Rle_trans with (v * (1.01 * k) * B); [| unfold B; lra].
    apply Rmult_le_compat_r; [exact PB |]. apply Rmult_le_compat_l; lra. }
  assert (TB : 14 * (tiny64 * B) <= / 100 * (v * (norm e * reach))).
  { assert (dust <= v / 1000000 / 1000000).
    { unfold dust, v, Rdiv. rewrite <- !Rinv_mult, <- !mult_IZR.
      apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
    pose proof tiny64_dust.
    assert (tiny64 * B <= v / 1000000 / 1000000 * (4 * reach)).
    { apply Rmult_le_compat; try lra. unfold B. apply Rmult_le_compat_r; lra. }
    assert (v * (/ 8 * reach) <= v * (norm e * reach))
      by (apply Rmult_le_compat_l; [lra | apply Rmult_le_compat_r; lra]).
    assert (0 <= v * reach) by (apply Rmult_le_pos; lra). lra. }
  assert (0 <= v * (norm e * reach)) by (repeat apply Rmult_le_pos; lra).
  rewrite Dots. lra.
Qed.
End Support.

(* src/posed/mod.rs: PosedShape::separates. `down` and `up` are the supports of the other body. The
   code compares only the end that is nearer to the other's centre, so it separates less often. *)
Definition seen_normal (a b : solid) (s : slab) : point :=
  turned_back (rotation_of g (turn b)) (turned (rotation_of g (turn a)) (normal s)).
Definition separates (a b : solid) (hb : facets) (apart : point) (out : R) : Prop :=
  exists s down up, In s (slabs a) /\
    is_support hb (opposite (seen_normal a b s)) down /\ is_support hb (seen_normal a b s) up /\
    let at_ := rotate_row g (normal s) (turned_back (rotation_of g (turn a)) apart) in
    let p := mul64 g (length s) out in
    add64 g (high s) p < sub64 g at_ down \/ add64 g at_ up < sub64 g (low s) p.

(* src/posed/mod.rs: PosedShape::may_touch *)
Definition way_out (a b : solid) (apart : point) : R :=
  add64 g (add64 g (margin a) (margin b))
    (slack_of (add64 g (add64 g (largest apart) (size_of a)) (size_of b))).
Definition centres_beyond (a b : solid) (apart : point) (out : R) : bool :=
  let from := turned (rotation_of g (turn a)) (middle a) in
  let to := turned (rotation_of g (turn b)) (middle b) in
  let between := pt (add64 g (px apart) (px to)) (add64 g (py apart) (py to))
    (add64 g (pz apart) (pz to)) in
  is_beyond between from from (add64 g (add64 g (ball_radius a) (ball_radius b)) out).

Lemma normal_seen (a b : solid) (s : slab) :
  sound_quaternion (turn a) -> sound_quaternion (turn b) -> sound_slab s ->
  let exact := apply (transposed (exact_rotation (turn b))) (apply (exact_rotation (turn a)) (normal s)) in
  norm exact = norm (normal s) /\
  norm (minus (seen_normal a b s) exact) <= 65.4 * v * norm (normal s).
Proof.
  intros Qa Qb (N & _) exact. pose proof v_value as V. pose proof (proj1 tiny64_value) as T0.
  set (n := norm (normal s)) in *.
  assert (Tn : tiny64 <= / 1000000 * (v * n)).
  { pose proof tiny64_dust.
    assert (dust <= v / 1000000 / 1000000).
    { unfold dust, v, Rdiv. rewrite <- !Rinv_mult, <- !mult_IZR.
      apply Rinv_le_contravar; [now apply IZR_lt | now apply IZR_le]. }
    assert (v * / 4 <= v * n) by (apply Rmult_le_compat_l; lra). lra. }
  destruct (rotation_near _ Qa) as (Na & _). destruct (rotation_near _ Qb) as (_ & Nb).
  pose proof (turned_near _ _ (normal s) Na) as A. fold n in A.
  set (d := turned (rotation_of g (turn a)) (normal s)) in *.
  set (e := apply (exact_rotation (turn a)) (normal s)) in *.
  assert (Ne : norm e = n) by (unfold e; now apply turned_norm).
  pose proof (turned_near _ _ d Nb) as B.
  assert (Nd : norm d <= 1.001 * n) by (pose proof (norm_difference d e); unfold v in *; lra).
  apply (Rmult_le_compat_l v) in Nd; [| lra].
  split; [unfold exact; rewrite back_norm by exact Qb; exact Ne |].
  unfold seen_normal. fold d. fold (turned_back (rotation_of g (turn b)) d) in B.
  replace (minus (turned_back _ d) exact) with (plus
    (minus (turned_back (rotation_of g (turn b)) d) (apply (transposed (exact_rotation (turn b))) d))
    (apply (transposed (exact_rotation (turn b))) (minus d e)))
    by (unfold exact, plus, apply, minus, dot, pt; cbn [px py pz]; f_equal; ring).
  apply Rle_trans with (1 := triangle _ _). rewrite back_norm by exact Qb.
  assert (0 <= v * n) by (apply Rmult_le_pos; lra). lra.
Qed.

Lemma not_separated (a b : solid) (hb : facets) (apart y z : point) (A S out : R) :
  sound_solid a -> sound_solid b -> in_mesh a y -> sound_facets hb (reach b) z ->
  norm (minus apart (minus (place b) (place a))) <= 1.001 * v * norm apart ->
  distance (posed (turn a) (place a) y) (posed (turn b) (place b) z) <= A ->
  moves_out A S out -> largest apart + reach b <= S -> ~ separates a b hb apart out.
Proof.
  intros Sa Sb Y Hz D Z O Far (s & down & up & I & Down & Up & H).
  pose proof Sa as (Qa & _ & _ & Sl & _). pose proof Sb as (Qb & _ & _ & _ & Rb & _).
  rewrite Forall_forall in Sl. specialize (Sl s I). pose proof Sl as (N & _).
  destruct Y as (Y & _). rewrite Forall_forall in Y. specialize (Y s I). cbv beta in Y.
  pose proof v_value as V. pose proof (proj1 tiny64_value) as T0.
  destruct (normal_seen a b s Qa Qb Sl) as (E1 & E2).
  destruct (turned_back_near _ apart _ Qa D) as (X1 & X2).
  destruct (largest_above apart) as (L0 & _).
  pose proof (slab_seen (normal s) _ _ _ ltac:(lra) L0 X1 X2) as At.
  pose proof (ends_move s A S out Sl O) as P.
  set (x := apply (transposed (exact_rotation (turn a))) (minus (place b) (place a))) in *.
  set (at_ := rotate_row g (normal s) _) in *. set (p := mul64 g (length s) out) in *.
  set (e := seen_normal a b s) in *. set (far := largest apart) in *.
  set (exact := apply (transposed (exact_rotation (turn b))) _) in *.
  set (n := norm (normal s)) in *.
  (* The exact place of the other's point along the slab. *)
  assert (Along : low s - n * A <= dot (normal s) x + dot exact z <= high s + n * A).
  { set (gap := minus (posed (turn b) (place b) z) (posed (turn a) (place a) y)).
    pose proof (dot_far (normal s) (apply (transposed (exact_rotation (turn a))) gap) A) as F.
    rewrite back_norm in F by exact Qa. specialize (F Z). fold n in F.
    replace (dot (normal s) (apply (transposed (exact_rotation (turn a))) gap))
      with (dot (normal s) x + dot exact z - dot (normal s) y) in F; [lra |].
    rewrite <- !apply_transposed. unfold x, exact. rewrite <- !apply_transposed.
    rewrite (dot_swap (apply _ _) z), <- apply_transposed.
    replace (dot (normal s) y) with (dot (apply (exact_rotation (turn a)) (normal s))
      (apply (exact_rotation (turn a)) y))
      by (apply rotation_keeps_dot; now apply sound_positive).
    unfold gap, posed, plus, minus, dot. cbn [px py pz]. ring. }
  assert (Ne : / 8 <= norm e <= 1.001 * n).
  { pose proof (norm_difference e exact). pose proof (norm_difference exact e) as K.
    rewrite norm_reversed in K. unfold v in *. lra. }
  pose proof (support_bounds_mesh hb (reach b) z Hz e up ltac:(lra) Up) as U1.
  pose proof (support_bounds_mesh hb (reach b) z Hz (opposite e) down
    ltac:(rewrite norm_opposite; lra) Down) as U2.
  rewrite norm_opposite, opposite_dot in U2.
  assert (Nz : norm z <= reach b) by apply Hz.
  assert (Ez : Rabs (dot e z - dot exact z) <= 65.4 * (v * (n * reach b))).
  { rewrite (dot_swap e), (dot_swap exact). apply Rle_trans with (1 := dot_change z e exact).
    replace (65.4 * (v * (n * reach b))) with (reach b * (65.4 * v * n)) by ring.
    apply Rmult_le_compat; try apply norm_nonneg; assumption. }
  assert (Nr : norm e * reach b <= 1.001 * n * reach b) by (apply Rmult_le_compat_r; lra).
  apply (Rmult_le_compat_l v) in Nr; [| lra].
  assert (Sum : n * (v * (far + reach b)) <= n * (v * S))
    by (apply Rmult_le_compat_l; [lra | apply Rmult_le_compat_l; lra]).
  assert (0 <= n * (v * far)) by (repeat apply Rmult_le_pos; lra).
  assert (0 <= n * (v * reach b)) by (repeat apply Rmult_le_pos; lra).
  apply Rabs_le_inv in At, Ez. cbv zeta in H. unfold add64, sub64 in H. rewrite !read64_is in H.
  destruct H as [H | H].
  - assert (fl64 g (at_ - down) <= fl64 g (high s + p)) by (apply fl64_monotone; lra). lra.
  - assert (fl64 g (low s - p) <= fl64 g (at_ + up)) by (apply fl64_monotone; lra). lra.
Qed.

(* A ball's radius as a sum leaves it, and the distance of a point of the mesh from its centre. *)
Lemma radius_left (b : solid) (y : point) :
  sound_solid b -> in_mesh b y ->
  norm (minus y (middle b)) <= ball_radius b * (1 - 3 * v) + 20 * v * reach b.
Proof.
  intros (_ & _ & _ & _ & R0 & _ & C) (_ & Y & B). pose proof v_value as V.
  pose proof (norm_nonneg (minus y (middle b))).
  assert (Near : norm (minus y (middle b)) <= 3 * reach b).
  { replace (minus y (middle b)) with (plus y (opposite (middle b)))
      by (unfold plus, opposite, minus, pt; cbn [px py pz]; f_equal; ring).
    apply Rle_trans with (1 := triangle _ _). rewrite norm_opposite. lra. }
  assert (0 <= v * reach b) by (apply Rmult_le_pos; lra).
  destruct (Rle_or_lt (ball_radius b) (4 * reach b)).
  - assert (v * ball_radius b <= v * (4 * reach b)) by (apply Rmult_le_compat_l; lra). lra.
  - assert (4 * reach b * (1 - 3 * v) <= ball_radius b * (1 - 3 * v))
      by (apply Rmult_le_compat_r; unfold v in *; lra). unfold v in *. lra.
Qed.

Theorem pairs_are_touched (a b : solid) (ha hb : facets) (p : point) :
  sound_solid a -> sound_solid b -> 
  (exists y z, in_mesh a y /\ in_mesh b z /\ sound_facets ha (reach a) y /\
    sound_facets hb (reach b) z /\ distance p (posed (turn a) (place a) y) <= margin a /\
    distance p (posed (turn b) (place b) z) <= margin b) ->
  let apart := seen_from (place b) (place a) in
  let out := way_out a b apart in
  centres_beyond a b apart out = false /\ ~ separates a b hb apart out /\
  ~ separates b a ha (opposite apart) out.
Proof.
  intros Sa Sb (y & z & Y & Z & Hy & Hz & Da & Db) apart out.
  pose proof Sa as (Qa & Fa & _ & _ & Ra & Ma & Ca). pose proof Sb as (Qb & Fb & _ & _ & Rb & Mb & Cb).
  pose proof v_value as V. pose proof floor_small as (Fl & T). pose proof (proj1 tiny64_value) as T0.
  destruct (largest_above apart) as (L0 & _ & L1).
  pose proof (seen_from_near (place b) (place a) Fb Fa) as D. fold apart in D.
  set (far := largest apart) in *. set (A := margin a + margin b).
  set (S := far + reach a + margin a + reach b + margin b).
  assert (O : moves_out A S out).
  { pose proof (add_least _ _ Ra Ma) as A1. pose proof (add_positive _ _ Ra Ma) as P1.
    pose proof (add_least _ _ Rb Mb) as A2. pose proof (add_positive _ _ Rb Mb) as P2.
    fold (size_of a) in A1, P1. fold (size_of b) in A2, P2.
    pose proof (add_least _ _ L0 P1) as A3. pose proof (add_positive _ _ L0 P1) as P3.
    pose proof (add_least _ _ P3 P2) as A4. pose proof (add_positive _ _ P3 P2) as P4.
    pose proof (add_least _ _ Ma Mb) as A5. pose proof (add_positive _ _ Ma Mb) as P5.
    unfold out, way_out. fold far. apply out_above; try lra; try (unfold A, S; lra).
    - unfold A. assert (0 <= v * (margin a + margin b)) by (apply Rmult_le_pos; lra). lra.
    - unfold S. set (s1 := size_of a) in *. set (s2 := size_of b) in *.
      set (s3 := add64 g far s1) in *. set (s4 := add64 g s3 s2) in *. clearbody s1 s2 s3 s4.
      unfold v in *. lra. }
  assert (Meet : distance (posed (turn a) (place a) y) (posed (turn b) (place b) z) <= A).
  { pose proof (distance_triangle (posed (turn a) (place a) y) p (posed (turn b) (place b) z)) as K.
    rewrite (distance_symmetric _ p) in K. unfold A. lra. }
  assert (VF : 0 <= v * far) by (apply Rmult_le_pos; lra).
  assert (VA : 0 <= v * reach a) by (apply Rmult_le_pos; lra).
  assert (VB : 0 <= v * reach b) by (apply Rmult_le_pos; lra).
  assert (VS : v * far + v * reach a + v * reach b <= v * S).
  { rewrite <- !Rmult_plus_distr_l. apply Rmult_le_compat_l; unfold S; lra. }
  pose proof O as ((A0 & AS) & Po).
  split; [| split].
  - unfold centres_beyond.
    destruct (rotation_near _ Qa) as (Na & _). destruct (rotation_near _ Qb) as (Nb & _).
    pose proof (turned_near _ _ (middle a) Na) as Ta. pose proof (turned_near _ _ (middle b) Nb) as Tb.
    set (from := turned (rotation_of g (turn a)) (middle a)) in *.
    set (to := turned (rotation_of g (turn b)) (middle b)) in *.
    set (ea := exact_rotation (turn a)) in *. set (eb := exact_rotation (turn b)) in *.
    assert (Mna : v * norm (middle a) <= v * (2 * reach a)) by (apply Rmult_le_compat_l; lra).
    assert (Mnb : v * norm (middle b) <= v * (2 * reach b)) by (apply Rmult_le_compat_l; lra).
    set (between := pt _ _ _).
    assert (Ft : format_point apart /\ format_point to /\ format_point from)
      by (repeat split; apply format64_result).
    destruct Ft as ((X0 & X1 & X2) & (Y0 & Y1 & Y2) & Z0 & Z1 & Z2).
    assert (Bt : norm (minus between (plus apart to)) <= v * norm (plus apart to) + 1.73206 * 0).
    { apply norm_shares; try lra; rewrite Rplus_0_r; now apply add64_share. }
    pose proof (triangle apart to) as Ts.
    assert (To : norm to <= 2.001 * reach b + 11 * tiny64).
    { pose proof (norm_difference to (apply eb (middle b))) as K. unfold eb in K at 1.
      rewrite turned_norm in K by exact Qb. fold eb in K. unfold v in *. lra. }
    assert (Ts' : v * norm (plus apart to) <= v * (1.73206 * far + 2.001 * reach b + 11 * tiny64))
      by (apply Rmult_le_compat_l; lra).
    assert (v * tiny64 <= 0.01 * tiny64) by (apply Rmult_le_compat_r; unfold v; lra).
    assert (VL : v * norm apart <= v * (1.73206 * far)) by (apply Rmult_le_compat_l; lra).
    pose proof (radius_left a y Sa Y) as Ga. pose proof (radius_left b z Sb Z) as Gb.
    assert (Pa : 0 <= ball_radius a) by (destruct Y as (_ & _ & Y); pose proof (norm_nonneg (minus y (middle a))); lra).
    assert (Pb : 0 <= ball_radius b) by (destruct Z as (_ & _ & Z); pose proof (norm_nonneg (minus z (middle b))); lra).
    pose proof (add_least _ _ Pa Pb) as S1. pose proof (add_positive _ _ Pa Pb) as S2.
    set (sum := add64 g (ball_radius a) (ball_radius b)) in *.
    assert (PO : 0 <= out) by lra.
    pose proof (add_least _ _ S2 PO) as S3.
    apply beyond_is_certain with (q := from); try assumption; try lra; try apply format64_result.
    + now apply add_positive.
    + apply Rle_trans with (2 := S3). rewrite distance_symmetric. unfold distance.
      (* between - from, through the points of the meshes *)
      assert (Path : norm (minus between from) <= norm (minus between (plus apart to))
        + norm (minus apart (minus (place b) (place a))) + norm (minus to (apply eb (middle b)))
        + norm (minus z (middle b)) + A + norm (minus y (middle a)) + norm (minus from (apply ea (middle a)))).
      { replace (minus between from) with (plus (minus between (plus apart to))
          (plus (minus apart (minus (place b) (place a))) (plus (minus to (apply eb (middle b)))
          (plus (apply eb (minus (middle b) z)) (plus (minus (posed (turn b) (place b) z)
          (posed (turn a) (place a) y)) (plus (apply ea (minus y (middle a)))
          (minus (apply ea (middle a)) from)))))))
          by (unfold ea, eb, posed, plus, minus, apply, dot, pt; cbn [px py pz]; f_equal; ring).
        assert (Nb' : norm (apply eb (minus (middle b) z)) = norm (minus z (middle b)))
          by (unfold eb; rewrite turned_norm by exact Qb; apply norm_reversed).
        assert (Na' : norm (apply ea (minus y (middle a))) = norm (minus y (middle a)))
          by (unfold ea; now apply turned_norm).
        rewrite (norm_reversed from).
        repeat (eapply Rle_trans; [apply triangle |]; rewrite ?Rplus_assoc; apply Rplus_le_compat_l).
        eapply Rle_trans; [apply triangle |]. rewrite Nb'. apply Rplus_le_compat_l.
        eapply Rle_trans; [apply triangle |]. apply Rplus_le_compat; [exact Meet |].
        eapply Rle_trans; [apply triangle |]. rewrite Na'. lra. }
      apply Rle_trans with (1 := Path).
      assert (Sv : sum * (1 - v) >= (ball_radius a + ball_radius b) * (1 - 2 * v) - 2 * tiny64).
      { apply Rle_ge. apply Rle_trans with (((ball_radius a + ball_radius b) * (1 - v) - tiny64) * (1 - v)).
        - assert (0 <= v * v * (ball_radius a + ball_radius b)) by (repeat apply Rmult_le_pos; lra).
          assert (0 <= v * tiny64) by (apply Rmult_le_pos; lra). lra.
        - apply Rmult_le_compat_r; [unfold v; lra | exact S1]. }
      assert (Vo : A + 200 * (v * S) + query_floor / 3 <= out * (1 - v)).
      { apply Rle_trans with ((A + 250 * v * S + query_floor / 2) * (1 - v)).
        - assert (v * A <= v * S) by (apply Rmult_le_compat_l; lra).
          assert (0 <= v * S) by lra. replace (250 * v * S) with (250 * (v * S)) by ring.
          set (vs := v * S) in *. clearbody vs. unfold v in *. lra.
        - apply Rmult_le_compat_r; [unfold v; lra | exact Po]. }
      assert (0 <= v * ball_radius a) by (apply Rmult_le_pos; lra).
      assert (0 <= v * ball_radius b) by (apply Rmult_le_pos; lra).
      lra.
  - apply (not_separated a b hb apart y z A S out); try assumption. unfold S. fold far. lra.
  - apply (not_separated b a ha (opposite apart) z y A S out); try assumption.
    + rewrite norm_opposite. replace (minus (opposite apart) (minus (place a) (place b)))
        with (opposite (minus apart (minus (place b) (place a))))
        by (unfold opposite, minus, pt; cbn [px py pz]; f_equal; ring).
      rewrite norm_opposite. exact D.
    + rewrite distance_symmetric. exact Meet.
    + replace (largest (opposite apart)) with far; [unfold S; lra |].
      unfold far, largest, opposite, pt. cbn [px py pz]. now rewrite !Rabs_Ropp.
Qed.
