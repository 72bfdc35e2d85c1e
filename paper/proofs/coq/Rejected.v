(* Theorem S: bodies that the sphere test rejects have no point in common. *)
From Coq Require Import Reals ZArith Bool Lra Lia.
From Flocq Require Import Core.
From Sdop Require Import Format Geometry Double Pose Place ReadPose WorldBall Sphere.
Open Scope R_scope.

(* A body: the ball of its shape, its rotation and its translation, each as it is given. *)
Record body := { shape : ball; turn : quaternion; place : point }.

(* The points of a body: those of its shape, posed without rounding. *)
Definition occupies (b : body) (p : point) : Prop :=
  exists x, in_ball x (shape b) /\ p = posed (turn b) (place b) x.

(* The modes of the arithmetic that poses a body, in f32 and f64, and of the one that inflates its
   radius, which may be done at another time. *)
Record modes := { pose32 : mode; pose64 : mode64; inflation : mode }.

Definition valid_modes (m : modes) : Prop :=
  valid (pose32 m) /\ valid64 (pose64 m) /\ valid (inflation m).

(* src/update/frame.rs: ShapeFrame::sphere *)
Definition sphere (m : modes) (b : body) : ball :=
  inflated (inflation m)
    (world_ball (pose32 m) (pose64 m) (turn b) (place b) (centre (shape b)) (radius (shape b))).

(* The contract of a body. *)
Definition sound (m : modes) (b : body) : Prop :=
  sound_quaternion (turn b) /\ readable (pose32 m) (turn b) /\
  within limit (place b) /\ within limit (centre (shape b)) /\ 0 <= radius (shape b).

(* Rotations keep distances. *)
Lemma rotation_keeps_norm (q : quaternion) (p : point) :
  0 < norm_of q -> square (apply (exact_rotation q) p) = square p.
Proof.
  intro H. unfold square, apply, exact_rotation, dot, pt, norm_of in *.
  cbn [row0 row1 row2 px py pz]. field. lra.
Qed.

Lemma posed_keeps_distance (q : quaternion) (t a b : point) :
  0 < norm_of q -> distance (posed q t a) (posed q t b) = distance a b.
Proof.
  intro H. unfold distance, norm. f_equal.
  rewrite <- (rotation_keeps_norm q (minus b a) H). f_equal.
  unfold posed, plus, minus, apply, dot, pt. cbn [px py pz]. f_equal; ring.
Qed.

(* A point of a body is no farther from its world ball's centre than the radius and half the
   slack. *)
Lemma occupied_near (m : modes) (b : body) (p : point) :
  valid_modes m -> sound m b -> occupies b p ->
  let w := world_ball (pose32 m) (pose64 m) (turn b) (place b)
    (centre (shape b)) (radius (shape b)) in
  0 <= radius w /\ distance p (centre w) <= radius w + slack / 2.
Proof.
  intros (Hm & Hm64 & _) (Hq & Hread & Ht & Hc & Hr) (x & Hx & ->) w.
  destruct (world_ball_contains _ _ Hm Hm64 _ _ _ _ Hq Hread Ht Hc Hr) as [R0 R1]. fold w in R0, R1.
  split; [exact R0 |]. unfold in_ball in Hx.
  pose proof (distance_triangle (posed (turn b) (place b) x)
    (posed (turn b) (place b) (centre (shape b))) (centre w)) as T.
  rewrite posed_keeps_distance in T by now apply sound_positive.
  lra.
Qed.

(* m is the mode of the test, ma and mb are those in which the two bodies were posed. *)
Theorem sphere_rejects_disjoint (m : mode) (ma mb : modes) (a b : body) :
  valid m -> valid_modes ma -> valid_modes mb -> sound ma a -> sound mb b ->
  rejects m (sphere ma a) (sphere mb b) = true ->
  forall p, ~ (occupies a p /\ occupies b p).
Proof.
  intros Hm Hma Hmb Ha Hb Hr p [Pa Pb].
  destruct (occupied_near ma a p Hma Ha Pa) as [Ra Da].
  destruct (occupied_near mb b p Hmb Hb Pb) as [Rb Db].
  unfold sphere in Hr. rewrite near_balls_not_rejected in Hr; try assumption;
    [discriminate | apply Hma | apply Hmb |].
  pose proof (distance_triangle (centre (world_ball (pose32 ma) (pose64 ma) (turn a) (place a)
    (centre (shape a)) (radius (shape a)))) p (centre (world_ball (pose32 mb) (pose64 mb) (turn b)
    (place b) (centre (shape b)) (radius (shape b))))) as T.
  rewrite (distance_symmetric _ p) in T. pose proof slack_in_room. lra.
Qed.

(* A quaternion of finite f32 numbers, not all of them zero, meets the contract. *)
Definition finite32 (x : R) : Prop :=
  generic_format radix2 (FLT_exp (-149) 24) x /\ Rabs x <= IZR (2 ^ 128).

Lemma finite32_square (x : R) :
  finite32 x -> x * x <= IZR (2 ^ 256) /\ (x = 0 \/ least_norm <= x * x).
Proof.
  intros [F H]. pose proof (Rabs_pos x) as P. pose proof (Rsqr_abs x) as E. unfold Rsqr in E.
  rewrite E. split.
  - change (2 ^ 256)%Z with (2 ^ 128 * 2 ^ 128)%Z. rewrite mult_IZR. apply Rmult_le_compat; lra.
  - destruct (Req_dec x 0) as [Z | N]; [now left | right].
    assert (L : bpow radix2 (-149) <= Rabs x).
    { apply generic_format_ge_bpow with (FLT_exp (-149) 24).
      - intro e. unfold FLT_exp. lia.
      - now apply Rabs_pos_lt.
      - now apply generic_format_abs. }
    replace least_norm with (bpow radix2 (-149) * bpow radix2 (-149)).
    + pose proof (bpow_gt_0 radix2 (-149)). apply Rmult_le_compat; lra.
    + rewrite <- bpow_plus. reflexivity.
Qed.

Lemma quaternion_sound (q : quaternion) :
  finite32 (qx q) -> finite32 (qy q) -> finite32 (qz q) -> finite32 (qw q) ->
  norm_of q <> 0 -> sound_quaternion q.
Proof.
  intros Fx Fy Fz Fw N. unfold sound_quaternion, greatest_norm, norm_of in *.
  pose proof (square_shares q) as (Px & Py & Pz & Pw).
  destruct (finite32_square _ Fx) as [Ux Lx]. destruct (finite32_square _ Fy) as [Uy Ly].
  destruct (finite32_square _ Fz) as [Uz Lz]. destruct (finite32_square _ Fw) as [Uw Lw].
  split.
  - destruct Lx as [Ex | Lx]; [| lra]. destruct Ly as [Ey | Ly]; [| lra].
    destruct Lz as [Ez | Lz]; [| lra]. destruct Lw as [Ew | Lw]; [| lra].
    exfalso. apply N. rewrite Ex, Ey, Ez, Ew. ring.
  - change (2 ^ 258)%Z with (4 * 2 ^ 256)%Z. rewrite mult_IZR. lra.
Qed.
