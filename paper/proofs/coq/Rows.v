(* Theorem C (4): in which entries of the table a body looks for others. Cells of two different bodies
   that are next to each other are looked at by one of the two, once; in a box no other cells are. *)
From Coq Require Import ZArith Bool List Lia.
Import ListNotations.
Open Scope Z_scope.

(* A cell, or a step from one to another. *)
Record cell := { cx : Z; cy : Z; cz : Z }.
Definition moved (c s : cell) : cell :=
  {| cx := cx c + cx s; cy := cy c + cy s; cz := cz c + cz s |}.
Definition reversed (s : cell) : cell := {| cx := - cx s; cy := - cy s; cz := - cz s |}.
Definition is_step (s : cell) : Prop := -1 <= cx s <= 1 /\ -1 <= cy s <= 1 /\ -1 <= cz s <= 1.
Lemma same_cell (a b : cell) : {a = b} + {a <> b}.
Proof. decide equality; apply Z.eq_dec. Defined.
Definition origin : cell := {| cx := 0; cy := 0; cz := 0 |}.

(* src/broad_phase/grid/cells.rs: FORWARD_ROWS; near.rs: the next cell, and rows of three. *)
Definition forward_rows : list (Z * Z) := [(1, 0); (-1, 1); (0, 1); (1, 1)].
Definition steps : list cell :=
  {| cx := 1; cy := 0; cz := 0 |} ::
  flat_map (fun '(y, z) => map (fun x => {| cx := x; cy := y; cz := z |}) [-1; 0; 1]) forward_rows.

Lemma steps_are (s : cell) : In s steps -> is_step s /\ s <> origin.
Proof.
  intro H. cbn in H. unfold is_step, origin.
  repeat (destruct H as [<- | H]); [.. | destruct H]; cbn; split; try lia; discriminate.
Qed.

(* Of a step and its reverse one is among them, and not both. *)
Definition every_step : list cell :=
  flat_map (fun x => flat_map (fun y => map (fun z => {| cx := x; cy := y; cz := z |}) [-1; 0; 1])
    [-1; 0; 1]) [-1; 0; 1].
Definition is_taken (s : cell) : bool := if in_dec same_cell s steps then true else false.

Lemma every_step_halved :
  forallb (fun s => if same_cell s origin then true
    else eqb (is_taken s) (negb (is_taken (reversed s)))) every_step = true.
Proof. vm_compute. reflexivity. Qed.

Lemma half_of_steps (s : cell) :
  is_step s -> s <> origin -> (In s steps <-> ~ In (reversed s) steps).
Proof.
  intros H N. pose proof every_step_halved as E. rewrite forallb_forall in E.
  assert (I : In s every_step).
  { destruct s as [x y z]. unfold is_step in H. cbn [cx cy cz] in H. unfold every_step.
    apply in_flat_map. exists x. split; [cbn; lia |]. apply in_flat_map. exists y.
    split; [cbn; lia |]. apply in_map_iff. exists z. split; [reflexivity | cbn; lia]. }
  specialize (E s I). destruct (same_cell s origin); [contradiction |].
  unfold is_taken in E.
  destruct (in_dec same_cell s steps), (in_dec same_cell (reversed s) steps); cbn in E;
    try discriminate; tauto.
Qed.

(* Cells::lay_out_box, Cells::index: u32 without wrapping, as smt/slots.py has it. *)
Section Box.
Variables nx ny nz : Z.
Hypothesis Nx : 1 <= nx.
Hypothesis Ny : 1 <= ny.
Hypothesis Nz : 1 <= nz.
Definition row : Z := nx + 1.
Definition rows : Z := ny + (if 1 <? ny then 1 else 0).
Definition layer : Z := row * rows.
Definition index (c : cell) : Z := cx c + row * cy c + layer * cz c.
Definition in_box (c : cell) : Prop := 0 <= cx c < nx /\ 0 <= cy c < ny /\ 0 <= cz c < nz.

(* Cells::take_forward: no rows to the side in a layer of one row, none above in one layer. *)
Definition taken (s : cell) : Prop := (cy s = 0 \/ 1 < ny) /\ (cz s = 0 \/ 1 < nz).
Definition looks (c d : cell) : Prop :=
  exists s, In s steps /\ taken s /\ index d = index c + index s.

Lemma multiple_below (a k : Z) : 0 < a -> Z.abs (a * k) < a -> k = 0.
Proof. intros A H. destruct (Z.eq_dec k 0); [assumption | nia]. Qed.

(* One empty cell after a row and one empty row after a layer keep rows apart. *)
Lemma reached_by (c d s : cell) :
  in_box c -> in_box d -> is_step s -> taken s -> index d = index c + index s -> d = moved c s.
Proof.
  destruct c as [x y z], d as [x' y' z'], s as [i j k].
  unfold in_box, is_step, taken, index, layer, moved. cbn.
  intros (X & Y & Z) (X' & Y' & Z') (I & J & K) (Tj & Tk) E.
  assert (R : x + i - x' = - (row * ((y + j - y') + rows * (z + k - z')))) by lia.
  assert (M : (y + j - y') + rows * (z + k - z') = 0).
  { apply (multiple_below row); unfold row in *; lia. }
  rewrite M in R.
  assert (P : 0 < rows /\ Z.abs (y + j - y') < rows).
  { unfold rows. destruct (Z.ltb_spec 1 ny); lia. }
  assert (L : z + k - z' = 0) by (apply (multiple_below rows); lia).
  rewrite L in M. f_equal; lia.
Qed.

Definition near (c d : cell) : Prop := exists s, is_step s /\ d = moved c s.

Lemma index_moved (c s : cell) : index (moved c s) = index c + index s.
Proof. unfold index, moved. cbn. ring. Qed.

Lemma moved_taken (c s : cell) : in_box c -> in_box (moved c s) -> taken s.
Proof. unfold in_box, moved, taken. cbn. lia. Qed.

Lemma moved_back (c d s : cell) : d = moved c s -> c = moved d (reversed s).
Proof. intros ->. destruct c, s. unfold moved, reversed. cbn. f_equal; ring. Qed.

Lemma moved_by_one (c s t : cell) : moved c s = moved c t -> s = t.
Proof.
  destruct c, s, t. unfold moved. cbn. intro E. injection E as A B C. f_equal; lia.
Qed.

Theorem box_looks_once (c d : cell) :
  in_box c -> in_box d -> c <> d ->
  (near c d <-> looks c d \/ looks d c) /\ ~ (looks c d /\ looks d c) /\
  (forall s t, In s steps -> In t steps -> taken s -> taken t ->
    index d = index c + index s -> index d = index c + index t -> s = t).
Proof.
  intros Hc Hd N. split; [split | split].
  - intros (s & S & E).
    assert (O : s <> origin).
    { intros ->. apply N. rewrite E. destruct c. unfold moved, origin. cbn. f_equal; ring. }
    assert (T : taken s) by (apply (moved_taken c); [exact Hc | now rewrite <- E]).
    destruct (in_dec same_cell (reversed s) steps) as [I | I].
    + right. exists (reversed s). split; [exact I |].
      split; [unfold taken, reversed in *; cbn; lia |].
      rewrite <- index_moved. f_equal. now apply moved_back.
    + left. exists s. split; [now apply half_of_steps |]. split; [exact T |].
      rewrite <- index_moved. now f_equal.
  - intros [(s & I & T & E) | (s & I & T & E)]; destruct (steps_are s I) as (S & _).
    + exists s. split; [exact S |]. now apply reached_by.
    + exists (reversed s). split; [unfold is_step, reversed in *; cbn; lia |].
      apply moved_back. now apply reached_by.
  - intros [(s & I & T & E) (t & J & V & F)]. destruct (steps_are s I) as (S & O).
    destruct (steps_are t J) as (S' & _).
    apply reached_by in E; try assumption. apply reached_by in F; try assumption.
    apply moved_back in F. rewrite E in F. apply moved_by_one in F.
    apply (proj1 (half_of_steps s S O) I). rewrite F.
    replace (reversed (reversed t)) with t; [exact J |].
    destruct t. unfold reversed. cbn. f_equal; ring.
  - intros s t I J T V E F. destruct (steps_are s I) as (S & _). destruct (steps_are t J) as (S' & _).
    apply reached_by in E; try assumption. apply reached_by in F; try assumption.
    apply (moved_by_one c). congruence.
Qed.
End Box.

(* Cells::wrap. The two constants are the f64 numbers nearest to 0.754877666246693 and
   0.569840290998053, whose product with a power of two is exact. A mask is a remainder. *)
Definition wrapped_row (t : Z) : Z := Z.lor (849916694104729 * 2 ^ t / 2 ^ 50) 1.
Definition wrapped_layer (t : Z) : Z := Z.lor (5132665044399053 * 2 ^ t / 2 ^ 53) 1.
Definition offset (t : Z) (s : cell) : Z :=
  cx s + wrapped_row t * cy s + wrapped_layer t * cz s.
Definition wrapped_index (t : Z) (c : cell) : Z := offset t c mod 2 ^ t.

(* Tables are from 2^6 to 2^30 long. Rows that differ by up to two each way are three apart. *)
Definition lengths : list Z := map Z.of_nat (seq 6 25).
Definition rows_apart (t : Z) : bool :=
  forallb (fun y => forallb (fun z =>
    let at_ := (wrapped_row t * y + wrapped_layer t * z) mod 2 ^ t in
    (y =? 0) && (z =? 0) || (3 <=? at_) && (at_ <=? 2 ^ t - 3))
    [-2; -1; 0; 1; 2]) [-2; -1; 0; 1; 2].

Lemma all_rows_apart : forallb rows_apart lengths = true.
Proof. vm_compute. reflexivity. Qed.

Lemma apart_rows (t y z : Z) :
  6 <= t <= 30 -> -2 <= y <= 2 -> -2 <= z <= 2 -> y <> 0 \/ z <> 0 ->
  let at_ := (wrapped_row t * y + wrapped_layer t * z) mod 2 ^ t in 3 <= at_ <= 2 ^ t - 3.
Proof.
  intros T Y Z N. pose proof all_rows_apart as H. rewrite forallb_forall in H.
  assert (I : In t lengths).
  { unfold lengths. apply in_map_iff. exists (Z.to_nat t). split; [lia |]. apply in_seq. lia. }
  specialize (H t I). unfold rows_apart in H. rewrite forallb_forall in H.
  assert (A : forall i, -2 <= i <= 2 -> In i [-2; -1; 0; 1; 2]) by (intros; cbn; lia).
  specialize (H y (A y Y)). rewrite forallb_forall in H. specialize (H z (A z Z)). cbv zeta in H.
  apply orb_prop in H. destruct H as [H | H]; apply andb_prop in H.
  - rewrite !Z.eqb_eq in H. lia.
  - rewrite !Z.leb_le in H. cbv zeta. lia.
Qed.

(* Entries that two steps lead to from one entry are different. *)
Theorem wrapped_steps_apart (t : Z) (s r : cell) :
  6 <= t <= 30 -> is_step s -> is_step r -> offset t s mod 2 ^ t = offset t r mod 2 ^ t -> s = r.
Proof.
  intros T. destruct s as [x y z], r as [x' y' z']. unfold is_step, offset. cbn.
  intros (X & Y & Z) (X' & Y' & Z') E.
  assert (P : 64 <= 2 ^ t) by (change 64 with (2 ^ 6); apply Z.pow_le_mono_r; lia).
  set (d := wrapped_row t * (y - y') + wrapped_layer t * (z - z')).
  assert (F : d mod 2 ^ t = (x' - x) mod 2 ^ t).
  { unfold d. replace (wrapped_row t * (y - y') + wrapped_layer t * (z - z'))
      with ((x + wrapped_row t * y + wrapped_layer t * z)
        - (x' + wrapped_row t * y' + wrapped_layer t * z') + (x' - x)) by ring.
    rewrite <- Zplus_mod_idemp_l, Zminus_mod, E, Z.sub_diag, Zmod_0_l. reflexivity. }
  destruct (Z.eq_dec y y') as [Ey | Ny]; destruct (Z.eq_dec z z') as [Ez | Nz].
  - subst. replace d with 0 in F by (unfold d; ring). rewrite Zmod_0_l in F.
    assert (x' - x = 0); [| f_equal; lia].
    destruct (Z.eq_dec (x' - x) 0) as [| N]; [assumption | exfalso].
    destruct (Z_lt_le_dec (x' - x) 0).
    + replace (x' - x) with ((x' - x + 2 ^ t) + -1 * 2 ^ t) in F by ring.
      rewrite Z_mod_plus_full, Z.mod_small in F by lia. lia.
    + rewrite Z.mod_small in F by lia. lia.
  - exfalso. pose proof (apart_rows t (y - y') (z - z') T ltac:(lia) ltac:(lia) ltac:(lia)) as A.
    cbv zeta in A. fold d in A. rewrite F in A. revert A.
    destruct (Z_lt_le_dec (x' - x) 0).
    + replace (x' - x) with ((x' - x + 2 ^ t) + -1 * 2 ^ t) by ring.
      rewrite Z_mod_plus_full, Z.mod_small by lia. lia.
    + rewrite Z.mod_small by lia. lia.
  - exfalso. pose proof (apart_rows t (y - y') (z - z') T ltac:(lia) ltac:(lia) ltac:(lia)) as A.
    cbv zeta in A. fold d in A. rewrite F in A. revert A.
    destruct (Z_lt_le_dec (x' - x) 0).
    + replace (x' - x) with ((x' - x + 2 ^ t) + -1 * 2 ^ t) by ring.
      rewrite Z_mod_plus_full, Z.mod_small by lia. lia.
    + rewrite Z.mod_small by lia. lia.
  - exfalso. pose proof (apart_rows t (y - y') (z - z') T ltac:(lia) ltac:(lia) ltac:(lia)) as A.
    cbv zeta in A. fold d in A. rewrite F in A. revert A.
    destruct (Z_lt_le_dec (x' - x) 0).
    + replace (x' - x) with ((x' - x + 2 ^ t) + -1 * 2 ^ t) by ring.
      rewrite Z_mod_plus_full, Z.mod_small by lia. lia.
    + rewrite Z.mod_small by lia. lia.
Qed.

Definition wrapped_looks (t i j : Z) : Prop :=
  exists s, In s steps /\ j = (i + offset t s) mod 2 ^ t.

(* Entries i and j of a wrapped table. Cells next to each other are in the same entry or one looks at
   the other's; of two entries at most one looks at the other, by one step. *)
Theorem wrapped_looks_once (t : Z) (c d : cell) :
  6 <= t <= 30 ->
  let (i, j) := (wrapped_index t c, wrapped_index t d) in
  (near c d -> c = d \/ wrapped_looks t i j \/ wrapped_looks t j i) /\
  ~ (wrapped_looks t i j /\ wrapped_looks t j i) /\
  (forall s r, In s steps -> In r steps ->
    j = (i + offset t s) mod 2 ^ t -> j = (i + offset t r) mod 2 ^ t -> s = r).
Proof.
  intro T. set (i := wrapped_index t c). set (j := wrapped_index t d). cbv zeta.
  assert (P : 0 < 2 ^ t) by (apply Z.pow_pos_nonneg; lia).
  assert (Moved : forall a s, wrapped_index t (moved a s)
    = (wrapped_index t a + offset t s) mod 2 ^ t).
  { intros a s. unfold wrapped_index. rewrite Zplus_mod_idemp_l. f_equal. unfold offset, moved.
    cbn. ring. }
  split; [| split].
  - intros (s & S & E).
    destruct (in_dec same_cell s [origin]) as [[O | []] | O].
    { left. rewrite E, <- O. destruct c. unfold moved, origin. cbn. f_equal; ring. }
    assert (O' : s <> origin) by (intros ->; apply O; now left).
    destruct (in_dec same_cell (reversed s) steps) as [I | I].
    + right. right. exists (reversed s). split; [exact I |]. unfold i, j. rewrite <- Moved. f_equal.
      now apply moved_back.
    + right. left. exists s. split; [now apply half_of_steps |]. unfold i, j. rewrite <- Moved.
      now f_equal.
  - intros [(s & I & E) (r & J & F)]. destruct (steps_are s I) as (S & O).
    destruct (steps_are r J) as (S' & _).
    assert (Z0 : (offset t s + offset t r) mod 2 ^ t = 0).
    { rewrite E, Zplus_mod_idemp_l in F.
      assert (B : i = i mod 2 ^ t).
      { unfold i, wrapped_index. now rewrite Zmod_mod. }
      replace (offset t s + offset t r) with ((i + offset t s + offset t r) - i) by ring.
      rewrite Zminus_mod, <- F, <- B, Z.sub_diag. apply Zmod_0_l. }
    assert (Q : offset t s mod 2 ^ t = offset t (reversed r) mod 2 ^ t).
    { replace (offset t (reversed r)) with (- offset t r)
        by (unfold offset, reversed; cbn; ring).
      replace (offset t s) with ((offset t s + offset t r) + - offset t r) by ring.
      now rewrite <- Zplus_mod_idemp_l, Z0. }
    apply wrapped_steps_apart in Q; try assumption;
      [| unfold is_step, reversed in *; cbn; lia].
    apply (proj1 (half_of_steps s S O) I). rewrite Q.
    replace (reversed (reversed r)) with r; [exact J |].
    destruct r. unfold reversed. cbn. f_equal; ring.
  - intros s r I J E F. destruct (steps_are s I) as (S & _). destruct (steps_are r J) as (S' & _).
    apply (wrapped_steps_apart t); try assumption. rewrite E in F.
    replace (offset t s) with ((i + offset t s) - i) by ring.
    replace (offset t r) with ((i + offset t r) - i) by ring.
    now rewrite (Zminus_mod (i + offset t s)), (Zminus_mod (i + offset t r)), F.
Qed.
