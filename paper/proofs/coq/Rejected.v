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
  rewrite (distance_symmetric _ p) in T. lra.
Qed.
