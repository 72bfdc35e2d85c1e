(* The tests of or-DOPs on IEEE 754 numbers, as functions that run: one pair, one lane. *)
From Coq Require Import ZArith Bool List.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Import Ieee Run.
Import ListNotations.
Open Scope Z_scope.

Definition negative (x : f32) : bool :=
  match x with B754_zero s | B754_infinity s | B754_finite s _ _ _ => s | B754_nan => false end.
Definition flip32 (x sign : f32) : f32 := if negative sign then Bopp x else x.
Definition dot32 (a b : three f32) : f32 :=
  plus32 (plus32 (mult32 (first a) (first b)) (mult32 (second a) (second b)))
    (mult32 (third a) (third b)).
Definition half32 : f32 := number 1 (-1).

(* src/overlap/ordop/slabs.rs: LaneSlabs::own. Of each of the 13 directions, the end that it faces and the one
   that its opposite faces. *)
Definition slabs : Type := list (f32 * f32).
Definition end_of (s : slabs) (member : nat) (opposite : bool) : f32 :=
  let ends := nth member s (zero32, zero32) in if opposite then snd ends else fst ends.
Definition mirrored (s : slabs) : slabs := map (fun ends => (snd ends, fst ends)) s.
Definition axes (s : slabs) '(x, y, z) : three f32 :=
  Three (end_of s 0 x) (end_of s 1 y) (end_of s 2 z).
Definition pair (s : slabs) (member : nat) (x y : bool) : f32 :=
  end_of s (if xorb x y then S member else member) x.
Definition pairs (s : slabs) '(x, y, z) : three f32 :=
  Three (pair s 3 x y) (pair s 5 x z) (pair s 7 y z).
Definition facing (s : slabs) (x y z : bool) : f32 :=
  end_of s (9 + (if xorb x z then 1 else 0) + (if xorb y z then 2 else 0)) z.
Definition cube (s : slabs) '(x, y, z) : f32 * three f32 :=
  (facing s x y z, Three (facing s (negb x) y z) (facing s x (negb y) z) (facing s x y (negb z))).

(* src/overlap/ordop/support.rs: minima, leads, support_14, support_18, support_26, support *)
Definition minima (v : three f32) : f32 * three f32 :=
  let '(Three a b c) := v in
  let ab := lesser a b in (lesser ab c, Three ab (lesser a c) (lesser b c)).
Definition leads (s : slabs) (signs : bool * bool * bool) (v : three f32) : f32 :=
  let '(Three a b c) := v in
  let lead x y z := greater_of (minus32 x (greater_of y z)) zero32 in
  dot32 (Three (lead a b c) (lead b a c) (lead c a b)) (axes s signs).
Definition support_14 (s : slabs) signs (v : three f32) : f32 :=
  let '(low, Three ab ac bc) := minima v in
  let median := greater_of (greater_of ab ac) bc in
  let (straight, over) := cube s signs in
  let base := mult32 (mult32 half32 (plus32 median low)) straight in
  let bend x end_ := mult32 (mult32 half32 (minus32 x low)) end_ in
  let bent := plus32 (plus32 (bend ab (third over)) (bend ac (second over))) (bend bc (first over)) in
  plus32 (plus32 base bent) (leads s signs v).
Definition support_18 (s : slabs) signs (v : three f32) : f32 :=
  let '(Three a b c) := v in
  let ca := lesser a (plus32 b c) in
  let cb := lesser b (plus32 a c) in
  let cc := lesser c (plus32 a b) in
  let ends := pairs s signs in
  let part x y z end_ :=
    mult32 (greater_of (mult32 half32 (minus32 (plus32 x y) z)) zero32) end_ in
  let faces := plus32 (plus32 (part ca cb cc (first ends)) (part ca cc cb (second ends)))
    (part cb cc ca (third ends)) in
  plus32 faces (dot32 (Three (minus32 a ca) (minus32 b cb) (minus32 c cc)) (axes s signs)).
Definition support_26 (s : slabs) signs (v : three f32) : f32 :=
  let '(low, Three ab ac bc) := minima v in
  let faces := dot32 (Three (minus32 ab low) (minus32 ac low) (minus32 bc low)) (pairs s signs) in
  plus32 (plus32 (mult32 low (fst (cube s signs))) faces) (leads s signs v).
Definition support (k : Z) (s : slabs) (e : three f32) : f32 :=
  let signs := (negative (first e), negative (second e), negative (third e)) in
  let size := each Babs e in
  if k =? 6 then dot32 size (axes s signs)
  else if k =? 14 then support_14 s signs size
  else if k =? 18 then support_18 s signs size
  else support_26 s signs size.

(* src/overlap/ordop/axes.rs: PairFrames::new. A row is the three axes, the translation and the offset. *)
Record row := { axis_of_row : three (three f32); translation : three f32; offset : three f32 }.
Record frames := { turn : three (three f32); gap_a : three f32; gap_b : three f32 }.
Definition frames_of (a b : row) : frames :=
  let difference f := minus32 (f b) (f a) in
  let along i := plus32 (difference (fun r => i (translation r)))
    (difference (fun r => i (offset r))) in
  let delta := Three (along first) (along second) (along third) in
  {| turn := each (fun x => each (fun y => dot32 x y) (axis_of_row b)) (axis_of_row a);
     gap_a := each (fun x => dot32 x delta) (axis_of_row a);
     gap_b := each (fun x => minus32 zero32 (dot32 x delta)) (axis_of_row b) |}.
Definition transposed (m : three (three f32)) : three (three f32) :=
  Three (each first m) (each second m) (each third m).

Definition members (k : Z) : list nat :=
  if k =? 6 then [0; 1; 2]%nat
  else if k =? 14 then [0; 1; 2; 9; 10; 11; 12]%nat
  else if k =? 18 then seq 0 9 else seq 0 13.
Definition combinations (v : three f32) : list f32 :=
  let '(Three x y z) := v in
  let (sum, difference) := (plus32 x y, minus32 x y) in
  [x; y; z; sum; difference; plus32 x z; minus32 x z; plus32 y z; minus32 y z; plus32 sum z;
   minus32 z difference; plus32 difference z; minus32 z sum].
Definition by_normals (k : Z) (turn : three (three f32)) (gap : three f32) (own other : slabs)
    : bool :=
  let components := each combinations (transposed turn) in
  let taus := combinations gap in
  let separates i :=
    let tau := nth i taus zero32 in
    let towards := each (fun c => flip32 (nth i c zero32) tau) components in
    greater32 (Babs tau)
      (plus32 (end_of own i (negative tau)) (support k (mirrored other) towards)) in
  existsb separates (members k).

(* src/overlap/ordop/edges.rs: EDGES *)
Definition edges (k : Z) : list (three f32) :=
  let all := [(1, 0, 0); (0, 1, 0); (0, 0, 1); (1, 1, 0); (1, -1, 0); (1, 0, 1); (1, 0, -1);
    (0, 1, 1); (0, 1, -1); (1, 1, 1); (-1, 1, 1); (1, -1, 1); (-1, -1, 1); (2, 1, 1); (-2, 1, 1);
    (2, -1, 1); (2, 1, -1); (1, 2, 1); (-1, 2, 1); (1, -2, 1); (1, 2, -1); (1, 1, 2); (-1, 1, 2);
    (1, -1, 2); (1, 1, -2)] in
  let count := if k =? 6 then 3%nat else if k =? 14 then 9%nat
    else if k =? 18 then 13%nat else 25%nat in
  map (fun '(x, y, z) => Three (number x 0) (number y 0) (number z 0)) (firstn count all).
Definition cross (n v : three f32) : three f32 :=
  let '(Three x y z) := n in
  let '(Three p q r) := v in
  Three (minus32 (mult32 y r) (mult32 z q)) (minus32 (mult32 z p) (mult32 x r))
    (minus32 (mult32 x q) (mult32 y p)).
Definition by_edges (k : Z) (f : frames) (a b : slabs) : bool :=
  let separates edge_b edge_a :=
    let axis := cross edge_a (each (fun row => dot32 edge_b row) (turn f)) in
    let tau := dot32 axis (gap_a f) in
    let towards := each (fun c => flip32 c tau) axis in
    let away := each (fun column => minus32 zero32 (dot32 column towards)) (transposed (turn f)) in
    greater32 (dot32 axis axis) (number 1 (-2)) &&
      greater32 (Babs tau) (plus32 (support k a towards) (support k b away)) in
  existsb (fun edge_b => existsb (separates edge_b) (edges k)) (edges k).

(* src/overlap/ordop/kernel.rs: may_overlap, of all axes or of slab normals alone *)
Definition ordops_apart (k : Z) (full : bool) (a b : row) (sa sb : slabs) : bool :=
  let f := frames_of a b in
  by_normals k (turn f) (gap_a f) sa sb || by_normals k (transposed (turn f)) (gap_b f) sb sa ||
  full && by_edges k f sa sb.
