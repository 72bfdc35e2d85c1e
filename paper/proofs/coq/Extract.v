(* A program of the functions that run: each takes the bits of its numbers and returns those of its
   results. cases.ml reads cases and compares. *)
From Coq Require Import ZArith Bool List.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Import Format Double Ieee Run RunOrDop.
From Coq Require Extraction ExtrOcamlBasic ExtrOcamlZBigInt.
Import ListNotations.
Open Scope Z_scope.

(* Bits of a format with w bits of fraction; all NaN are one. *)
Section Bits.
Context {prec emax : Z} {Hprec : Prec_gt_0 prec} {Hmax : Prec_lt_emax prec emax}.
Definition hidden : Z := 2 ^ (prec - 1).
Definition of_bits (n : Z) : binary_float prec emax :=
  let negative := negb (n <? hidden * (2 * emax)) in
  let e := (n / hidden) mod (2 * emax) in
  let m := n mod hidden in
  if e =? 2 * emax - 1 then if m =? 0 then B754_infinity negative else B754_nan
  else
    let '(m, e) := if e =? 0 then (m, 1) else (m + hidden, e) in
    binary_normalize prec emax _ _ mode_NE (cond_Zopp negative m) (e - emax + 2 - prec) negative.
Definition to_bits (x : binary_float prec emax) : Z :=
  let sign (s : bool) := if s then hidden * (2 * emax) else 0 in
  match x with
  | B754_zero s => sign s
  | B754_infinity s => sign s + hidden * (2 * emax - 1)
  | B754_nan => hidden * (2 * emax - 1) + hidden / 2
  | B754_finite s m e _ =>
    sign s + (if Zpos m <? hidden then Zpos m
              else Zpos m - hidden + (e + prec - 2 + emax) * hidden)
  end.
End Bits.

Definition f (n : Z) : f32 := of_bits n.
Definition d (n : Z) : f64 := of_bits n.
Definition of_f32 (x : f32) : Z := to_bits x.
Definition of_f64 (x : f64) : Z := to_bits x.
Definition bit (b : bool) : list Z := [if b then 1 else 0].
Definition of_three32 (v : three f32) : list Z := map of_f32 (listed v).
Definition of_pair (ends : f32 * f32) : list Z := [of_f32 (fst ends); of_f32 (snd ends)].
Definition of_ball (b : ball32) : list Z := [of_f32 (x32 b); of_f32 (y32 b); of_f32 (z32 b); of_f32 (r32 b)].
Definition of_matrix {A} (of : A -> Z) (m : three (three A)) : list Z :=
  map of (listed (first m) ++ listed (second m) ++ listed (third m)).

Definition ball (x y z r : Z) : ball32 := {| x32 := f x; y32 := f y; z32 := f z; r32 := f r |}.
Definition v (x y z : Z) : three f32 := Three (f x) (f y) (f z).
Definition turned (x y z w : Z) : three (three f64) :=
  rotation64 (to_f64 (f x)) (to_f64 (f y)) (to_f64 (f z)) (to_f64 (f w)).

(* A list of another length has no answer. *)
Definition run_outward (l : list Z) : list Z :=
  match l with [x] => of_pair (down (d x), up (d x)) | _ => [] end.
Definition run_widen (l : list Z) : list Z :=
  match l with [r] => [of_f32 (widen32 (f r))] | _ => [] end.
Definition run_inflate (l : list Z) : list Z :=
  match l with [r] => [of_f32 (inflate32 factor32 floor32 (f r))] | _ => [] end.
Definition run_spheres (l : list Z) : list Z :=
  match l with
  | [x; y; z; r; p; q; s; t] => bit (rejects32 factor32 floor32 (ball x y z r) (ball p q s t))
  | _ => []
  end.
Definition run_rotation (l : list Z) : list Z :=
  match l with [x; y; z; w] => of_matrix of_f64 (turned x y z w) | _ => [] end.
Definition run_transform (l : list Z) : list Z :=
  match l with
  | [x; y; z; w; a; b; c; t; u; s] =>
    map of_f64 (listed (transform64 (turned x y z w) (each to_f64 (v a b c)) (each to_f64 (v t u s))))
  | _ => []
  end.
Definition run_world_ball (l : list Z) : list Z :=
  match l with
  | [x; y; z; w; t; u; s; a; b; c; r] =>
    of_ball (sphere32 (f x, f y, f z, f w) (v t u s) (v a b c) (f r))
  | _ => []
  end.
Definition run_axes (l : list Z) : list Z :=
  match l with
  | [x; y; z; w; a; b; c; g; h; i; j; k; o] =>
    of_matrix of_f32 (world_axes64 (turned x y z w)
      (Three (each to_f64 (v a b c)) (each to_f64 (v g h i)) (each to_f64 (v j k o))))
  | _ => []
  end.
Definition run_refit (l : list Z) : list Z :=
  match l with
  | [lo; hi; reach; t; u; s] => of_pair (refit64 (d lo) (d hi) (f reach) (v t u s))
  | _ => []
  end.
Definition run_slab (l : list Z) : list Z :=
  match l with
  | [lo; hi; a; b; c; scale; x; y; z; reach] =>
    of_pair (inflate_slab (f lo) (f hi) (v a b c) (d scale) (v x y z) (f reach))
  | _ => []
  end.

(* Cells of a wrapped table: the ends of the box of centres, the widest ball, a centre and a reach
   give counts, then the cells along each axis that may hold a centre within reach; with a centre
   out of reach the counts alone. *)
Definition run_cells (l : list Z) : list Z :=
  match l with
  | [a; b; c; g; h; i; widest; x; y; z; reach] =>
    let cells := fit (v a b c) (v g h i) (f widest) in
    let at_axis o count x := around64 cells (d reach) o count (to_f64 x) in
    let '(o, n, p) := (origin64 cells, count cells, v x y z) in
    listed n ++
      match at_axis (first o) (first n) (first p), at_axis (second o) (second n) (second p),
        at_axis (third o) (third n) (third p) with
      | Some (lx, hx), Some (ly, hy), Some (lz, hz) => [lx; ly; lz; hx; hy; hz]
      | _, _, _ => []
      end
  | _ => []
  end.

Definition run_stays (l : list Z) : list Z :=
  match l with
  | [sh; le; x; y; z; r; p; q; s; t] =>
    bit (stays32 {| share := f sh; least := f le |} (ball x y z r) (ball p q s t))
  | _ => []
  end.
Definition run_reach (l : list Z) : list Z :=
  match l with
  | [sh; le; r] => [of_f32 (grown_radius {| share := f sh; least := f le |} (f r))]
  | _ => []
  end.
Definition run_cube (l : list Z) : list Z :=
  match l with
  | [a; b; c; g; h; i] => let (b, gap) := cube_about (v a b c) (v g h i) in of_ball b ++ [of_f32 gap]
  | _ => []
  end.
(* Whether cubes are apart, and if not, whether the boxes surely meet, for a largest gap. *)
Definition run_cubes (l : list Z) : list Z :=
  match l with
  | [x; y; z; r; p; q; s; t; gap] =>
    let (a, b) := (ball x y z r, ball p q s t) in
    bit (cubes_apart a b) ++ bit (surely_meet a b (less_than_sure (f gap)))
  | _ => []
  end.

Fixpoint numbers (l : list Z) : slabs :=
  match l with a :: b :: rest => (f a, f b) :: numbers rest | _ => [] end.
(* k, a direction and the 13 pairs of ends. *)
Definition run_support (l : list Z) : list Z :=
  match l with
  | k :: x :: y :: z :: ends => [of_f32 (support k (numbers ends) (v x y z))]
  | _ => []
  end.
Definition row_of (l : list Z) : row :=
  let n i := nth i l 0 in
  let at_place i := v (n i) (n (1 + i)%nat) (n (2 + i)%nat) in
  {| axis_of_row := Three (at_place 0%nat) (at_place 3%nat) (at_place 6%nat);
     translation := at_place 9%nat; offset := at_place 12%nat |}.
(* k, whether edges are tried, two rows of 15 numbers and twice 13 pairs of ends. *)
Definition run_ordops (l : list Z) : list Z :=
  match l with
  | k :: full :: rest =>
    let after n := skipn n rest in
    bit (ordops_apart k (full =? 1) (row_of rest) (row_of (after 15%nat))
      (numbers (firstn 26 (after 30%nat))) (numbers (after 56%nat)))
  | _ => []
  end.

Extraction "functions.ml" run_outward run_widen run_inflate run_spheres run_rotation run_transform
  run_world_ball run_axes run_refit run_slab run_cells run_stays run_reach run_cube run_cubes
  run_support run_ordops.
