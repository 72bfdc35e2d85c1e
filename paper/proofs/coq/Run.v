(* The code's arithmetic on IEEE 754 numbers, as functions that run. Extract.v makes a program of
   them that is compared with the Rust code on the same inputs; Same.v proves that they are the
   functions of real numbers that the theorems speak of. *)
From Coq Require Import ZArith Bool List.
From Flocq Require Import Core BinarySingleNaN.
From Sdop Require Import Format Double Ieee.
Import ListNotations.
Open Scope Z_scope.

Definition divide32 : f32 -> f32 -> f32 := Bdiv mode_NE.
#[export] Instance exponents64 : Prec_lt_emax 53 1024 := eq_refl.
Definition f64 : Type := binary_float 53 1024.
Definition plus64 : f64 -> f64 -> f64 := Bplus mode_NE.
Definition minus64 : f64 -> f64 -> f64 := Bminus mode_NE.
Definition mult64 : f64 -> f64 -> f64 := Bmult mode_NE.
Definition divide64 : f64 -> f64 -> f64 := Bdiv mode_NE.
Definition root64 : f64 -> f64 := Bsqrt mode_NE.
Definition opposite64 : f64 -> f64 := Bopp.

(* n * 2^e *)
Definition number64 (n e : Z) : f64 := binary_normalize 53 1024 _ _ mode_NE n e false.

Definition less {prec emax} (x y : binary_float prec emax) : bool :=
  match Bcompare x y with Some Lt => true | _ => false end.
(* Of equal zeros and of NaN the second, as the lanes have it. *)
Definition lesser {prec emax} (x y : binary_float prec emax) := if less x y then x else y.
Definition greater_of {prec emax} (x y : binary_float prec emax) := if less y x then x else y.

Definition to_f64 (x : f32) : f64 :=
  match x with
  | B754_zero s => B754_zero s
  | B754_infinity s => B754_infinity s
  | B754_nan => B754_nan
  | B754_finite s m e _ => binary_normalize 53 1024 _ _ mode_NE (cond_Zopp s (Zpos m)) e s
  end.
Definition to_f32 (x : f64) : f32 :=
  match x with
  | B754_zero s => B754_zero s
  | B754_infinity s => B754_infinity s
  | B754_nan => B754_nan
  | B754_finite s m e _ => binary_normalize 24 128 _ _ mode_NE (cond_Zopp s (Zpos m)) e s
  end.

(* src/rounding/mod.rs: up, down, widen *)
Definition up (x : f64) : f32 := Bsucc (to_f32 x).
Definition down (x : f64) : f32 := Bpred (to_f32 x).
Definition finder_factor64 : f64 := number64 (2 ^ 20 + 1) (-20).
Definition finder_floor64 : f64 := number64 1 (-78).
Definition widen32 (r : f32) : f32 :=
  up (plus64 (mult64 (to_f64 r) finder_factor64) finder_floor64).

Record three (A : Type) : Type := Three { first : A; second : A; third : A }.
Arguments Three {A}.
Arguments first {A}.
Arguments second {A}.
Arguments third {A}.
Definition each {A B} (f : A -> B) (v : three A) : three B :=
  Three (f (first v)) (f (second v)) (f (third v)).
Definition listed {A} (v : three A) : list A := [first v; second v; third v].

(* src/rounding/pose.rs: rotation_of, rotate_of, transform *)
Definition twice64 (a b over : f64) : f64 := mult64 (mult64 (number64 2 0) (plus64 a b)) over.
Definition diagonal64 (a b c d over : f64) : f64 :=
  mult64 (plus64 (minus64 a b) (minus64 c d)) over.
Definition norm64 (x y z w : f64) : f64 :=
  plus64 (plus64 (plus64 (mult64 x x) (mult64 y y)) (mult64 z z)) (mult64 w w).
Definition rotation64 (x y z w : f64) : three (three f64) :=
  let '(xx, yy, zz, ww) := (mult64 x x, mult64 y y, mult64 z z, mult64 w w) in
  let over := divide64 (number64 1 0) (norm64 x y z w) in
  Three
    (Three (diagonal64 xx yy ww zz over) (twice64 (mult64 x y) (opposite64 (mult64 w z)) over)
       (twice64 (mult64 x z) (mult64 w y) over))
    (Three (twice64 (mult64 x y) (mult64 w z) over) (diagonal64 yy xx ww zz over)
       (twice64 (mult64 y z) (opposite64 (mult64 w x)) over))
    (Three (twice64 (mult64 x z) (opposite64 (mult64 w y)) over)
       (twice64 (mult64 y z) (mult64 w x) over) (diagonal64 zz xx ww yy over)).
Definition dot64 (a b : three f64) : f64 :=
  plus64 (plus64 (mult64 (first a) (first b)) (mult64 (second a) (second b)))
    (mult64 (third a) (third b)).
Definition rotate64 (r : three (three f64)) (x : three f64) : three f64 :=
  each (fun row => dot64 row x) r.
Definition transform64 (r : three (three f64)) (x t : three f64) : three f64 :=
  Three (plus64 (dot64 (first r) x) (first t)) (plus64 (dot64 (second r) x) (second t))
    (plus64 (dot64 (third r) x) (third t)).

(* src/rounding/pose.rs: norm, over_norm, world_axes *)
Definition length64 (v : three f64) : f64 := root64 (dot64 v v).
Definition world_axes64 (r basis : three (three f64)) : three (three f32) :=
  let unit := divide64 (number64 1 0) (length64 (first basis)) in
  each (fun column => each (fun x => to_f32 (mult64 x unit)) (rotate64 r column)) basis.

Definition largest64 (least : f64) (numbers : list f64) : f64 :=
  fold_left (fun most x => greater_of most (Babs x)) numbers least.
Definition zero64 : f64 := B754_zero false.

(* src/rounding/pose.rs: refit *)
Definition refit64 (lo hi : f64) (reach : f32) (t : three f32) : f32 * f32 :=
  let size := largest64 (to_f64 reach) (listed (each to_f64 t)) in
  let margin := plus64 (mult64 (number64 1 (-46)) size) (number64 1 (-120)) in
  (down (minus64 lo margin), up (plus64 hi margin)).

(* src/rounding/sphere.rs: world_ball; src/update/frame.rs: ShapeFrame::sphere *)
Definition stretch64 : f64 := divide64 (number64 10001 0) (number64 10000 0).
Definition is_zero {prec emax} (x : binary_float prec emax) : bool :=
  match x with B754_zero _ => true | _ => false end.
Definition moved64 (a b : three f64) : f64 :=
  let squared x y := mult64 (minus64 x y) (minus64 x y) in
  root64 (plus64 (plus64 (plus64 zero64 (squared (first a) (first b)))
    (squared (second a) (second b))) (squared (third a) (third b))).
Definition world_ball64 (q : f32 * f32 * f32 * f32) (t c : three f32) (r : f32)
    : three f32 * f32 :=
  if is_zero (first c) && is_zero (second c) && is_zero (third c) then (t, r) else
  let '(x, y, z, w) := q in
  let exact := transform64 (rotation64 (to_f64 x) (to_f64 y) (to_f64 z) (to_f64 w))
    (each to_f64 c) (each to_f64 t) in
  let centre := each to_f32 exact in
  let moved := moved64 exact (each to_f64 centre) in
  let size := largest64 zero64 (listed (each to_f64 c) ++ listed (each to_f64 t)) in
  (centre, up (plus64 (plus64 (plus64 (to_f64 r) (mult64 stretch64 moved))
     (mult64 (number64 1 (-47)) size)) (number64 1 (-125)))).
Definition sphere32 (q : f32 * f32 * f32 * f32) (t c : three f32) (r : f32) : ball32 :=
  let (centre, radius) := world_ball64 q t c r in
  {| x32 := first centre; y32 := second centre; z32 := third centre;
     r32 := inflate32 factor32 floor32 radius |}.

(* src/broad_phase/grid/cells.rs: Cells::fit of a wrapped table, CellRule::cell, CellRule::count, number,
   Cells::around *)
Definition to_integer64 : f64 := number64 (3 * 2 ^ 51) 0.
Definition cell64 (origin inverse x : f64) : f64 :=
  plus64 (mult64 (minus64 x origin) inverse) to_integer64.
(* The low 32 bits. *)
Definition number_of (cell : f64) : Z :=
  match cell with B754_finite _ m _ _ => Zpos m mod 2 ^ 32 | _ => 0 end.

Record cells := { origin64 : three f64; inverse64 : f64; count : three Z }.
Definition fit (lo hi : three f32) (widest : f32) : cells :=
  let (lo, hi) := (each to_f64 lo, each to_f64 hi) in
  let sides := [minus64 (first hi) (first lo); minus64 (second hi) (second lo);
    minus64 (third hi) (third lo)] in
  let longest := fold_left (fun most x => greater_of most x) sides zero64 in
  let needed := mult64 (mult64 (number64 2 0) (to_f64 (widen32 widest))) (number64 65537 (-16)) in
  let size := greater_of needed (divide64 longest (number64 1 29)) in
  let inverse := divide64 (number64 1 0) size in
  let along o x := number_of (greater_of (cell64 o inverse x) to_integer64) + 1 in
  {| origin64 := lo; inverse64 := inverse;
     count := Three (along (first lo) (first hi)) (along (second lo) (second hi))
       (along (third lo) (third hi)) |}.

Definition around64 (c : cells) (reach : f64) (o : f64) (count : Z) (x : f64) : option (Z * Z) :=
  let last := plus64 to_integer64 (number64 (count - 1) 0) in
  let lo := cell64 o (inverse64 c) (minus64 x reach) in
  let hi := cell64 o (inverse64 c) (plus64 x reach) in
  if less last lo || less hi to_integer64 then None
  else Some (number_of (lesser (greater_of lo to_integer64) last),
    number_of (lesser (greater_of hi to_integer64) last)).

(* src/rounding/skin.rs: Skin::of, stays, Reach::with_skin, Reach::of *)
Record skin := { share : f32; least : f32 }.
Definition skin_floor32 : f32 := number 1 (-60).
Definition skin_of (s : skin) (radius : f32) : f32 :=
  greater_of (mult32 radius (share s)) (least s).
Definition zero32 : f32 := B754_zero false.
Definition stays32 (s : skin) (now before : ball32) : bool :=
  let grown := greater_of (minus32 (r32 now) (r32 before)) zero32 in
  let left := greater_of (minus32 (skin_of s (r32 before)) grown) zero32 in
  let dx := minus32 (x32 now) (x32 before) in
  let dy := minus32 (y32 now) (y32 before) in
  let dz := minus32 (z32 now) (z32 before) in
  greater32 (mult32 left left) (plus32 (plus32 (mult32 dx dx) (mult32 dy dy)) (mult32 dz dz)).
Definition reach_factor64 : f64 := number64 (2 ^ 18 + 1) (-18).
Definition grown_radius (s : skin) (radius : f32) : f32 :=
  let factor := to_f32 (mult64 (plus64 (number64 1 0) (to_f64 (share s))) reach_factor64) in
  let floor := to_f32 (plus64 (mult64 (to_f64 (least s)) reach_factor64) (number64 1 (-56))) in
  plus32 (mult32 radius factor) floor.

(* src/rounding/cube.rs: Cube::about, apart, less_than_sure, sure *)
Definition wider32 : f32 := number (2 ^ 20 + 1) (-20).
Definition narrower32 : f32 := number (2 ^ 20 - 1) (-20).
Definition cube_floor32 : f32 := divide32 (number 1 0) (number (10 ^ 30) 0).
Definition infinity32 : f32 := B754_infinity false.
(* An axis: its centre, and how far its two ends are from there, an eighth in size. *)
Definition axis_of (lower upper : f32) : f32 * (f32 * f32) :=
  let (lo, hi) := (mult32 lower (number 1 (-4)), mult32 upper (number 1 (-4))) in
  let centre := plus32 lo hi in
  (centre, (minus32 centre (plus32 lo lo), minus32 (plus32 hi hi) centre)).
Definition cube_about (lower upper : three f32) : ball32 * f32 :=
  let '(cx, x) := axis_of (first lower) (first upper) in
  let '(cy, y) := axis_of (second lower) (second upper) in
  let '(cz, z) := axis_of (third lower) (third upper) in
  let extremes (f : f32 -> f32 -> f32) from :=
    fold_left (fun most ends => f most (f (fst ends) (snd ends))) [x; y; z] from in
  let half := plus32 (mult32 (extremes greater_of zero32) wider32) cube_floor32 in
  ({| x32 := cx; y32 := cy; z32 := cz; r32 := half |},
   minus32 half (extremes lesser infinity32)).
Definition farthest32 (d : three f32) : f32 :=
  greater_of (greater_of (Babs (first d)) (Babs (second d))) (Babs (third d)).
Definition way32 (a b : ball32) : three f32 :=
  Three (minus32 (x32 b) (x32 a)) (minus32 (y32 b) (y32 a)) (minus32 (z32 b) (z32 a)).
(* src/boxes/cube_test.rs: CubeTest::apart *)
Definition cubes_apart (a b : ball32) : bool :=
  greater32 (farthest32 (way32 a b)) (plus32 (r32 a) (r32 b)).
Definition less_than_sure (gap : f32) : f32 :=
  plus32 (mult32 (mult32 (number 2 0) gap) wider32) (mult32 (number 2 0) cube_floor32).
Definition sure (reach less : f32) : f32 := minus32 (mult32 reach narrower32) less.
(* src/boxes/cube_test.rs: CubeTest::touching, of a pair that cubes_apart has not parted *)
Definition surely_meet (a b : ball32) (less : f32) : bool :=
  negb (greater32 (farthest32 (way32 a b)) (sure (plus32 (r32 a) (r32 b)) less)).

(* src/rounding/slab.rs: inflate_slab *)
Definition inflate_slab (lo hi : f32) (direction : three f32) (scale : f64) (centre : three f32)
    (reach : f32) : f32 * f32 :=
  let (d, c) := (each to_f64 direction, each to_f64 centre) in
  let offset := plus64 (plus64 (mult64 (first d) (first c)) (mult64 (second d) (second c)))
    (mult64 (third d) (third c)) in
  let length := divide64 (length64 d) scale in
  let reach := plus64 (to_f64 reach) (length64 c) in
  let margin := mult64 length (plus64 (mult64 (number64 1 (-17)) reach) (number64 1 (-110))) in
  let end_of x := divide64 (minus64 (to_f64 x) offset) scale in
  (down (minus64 (lesser (end_of lo) zero64) margin),
   up (plus64 (greater_of (end_of hi) zero64) margin)).
