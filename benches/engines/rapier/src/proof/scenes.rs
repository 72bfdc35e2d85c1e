//! The scenes as rapier worlds.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sdop::mesh::TriangleMesh;

use super::super::rapier::math::{Pose, Real, Rotation, Vector};
use super::super::rapier::prelude::*;
use crate::plan::{Kind, Plan, Scene};

/// Distance between bodies when they are set out; none is larger than 1.
const SPACING: Real = 1.1;

/// Half the thickness of walls.
pub(super) const WALL: Real = 0.5;

/// A world, and what happens to it from outside.
pub struct Stage {
    /// All of rapier's sets.
    pub world: PhysicsWorld,
    pub(super) plan: Plan,
    /// The colliders of one body of each form.
    pub(super) colliders: Vec<Vec<Collider>>,
    pub(super) random: Random,
    belt: Option<Belt>,
}

#[derive(Clone, Copy)]
struct Belt {
    body: RigidBodyHandle,
    length: Real,
    width: Real,
}

/// Numbers of a seed, the same on every platform.
#[derive(Clone)]
pub(super) struct Random(ChaCha8Rng);

impl Random {
    /// Uniform in [−1, 1).
    pub fn sign(&mut self) -> Real {
        (self.0.next_u32() >> 8) as Real / (1 << 23) as Real - 1.0
    }

    pub fn vector(&mut self) -> Vector {
        Vector::new(self.sign(), self.sign(), self.sign())
    }

    /// Uniform over all rotations: a quaternion from the unit ball.
    pub fn rotation(&mut self) -> Rotation {
        loop {
            let [x, y, z, w] = std::array::from_fn(|_| self.sign());
            let square = x * x + y * y + z * z + w * w;
            if square > 0.01 && square <= 1.0 {
                let scale = 1.0 / square.sqrt();
                return Rotation::from_xyzw(x * scale, y * scale, z * scale, w * scale);
            }
        }
    }

    pub fn below(&mut self, count: usize) -> usize {
        ((u64::from(self.0.next_u32()) * count as u64) >> 32) as usize
    }
}

impl Stage {
    /// Sets a scene up. `hooks` is what every body's colliders ask rapier to call.
    ///
    /// # Panics
    /// If one of `forms` is no body at all: they are this program's own.
    #[must_use]
    pub fn new(plan: Plan, forms: &[TriangleMesh], hooks: ActiveHooks) -> Self {
        let kinds = if plan.scene == Scene::Zoo { Kind::ALL } else { &[plan.kind] };
        let made = |form| kinds.iter().map(move |&kind| made_of(kind, form, hooks));
        let colliders = forms.iter().flat_map(made).collect();
        let mut stage = Self {
            world: PhysicsWorld::new(),
            plan,
            colliders,
            random: Random(ChaCha8Rng::seed_from_u64(plan.seed)),
            belt: None,
        };
        match plan.scene {
            Scene::Pile => stage.pile(),
            Scene::Tumbler => stage.tumbler(),
            Scene::Conveyor => stage.conveyor(),
            Scene::Cloud => stage.cloud(),
            Scene::Zoo => stage.zoo(),
        }
        stage
    }

    /// The shapes that bodies are made of.
    pub fn shapes(&self) -> impl Iterator<Item = &SharedShape> {
        self.colliders.iter().flatten().map(Collider::shared_shape)
    }

    fn pile(&mut self) {
        let side = self.lattice(1.0, Vector::ZERO, 0.0);
        let half = side * SPACING / 2.0 + 0.2;
        self.box_around(None, Vector::splat(half), 5);
    }

    fn tumbler(&mut self) {
        let drum = RigidBodyBuilder::kinematic_velocity_based().angvel(Vector::Z);
        let drum = self.world.insert_body(drum);
        let side = self.lattice(1.0, Vector::ZERO, 0.0);
        self.box_around(Some(drum), Vector::splat(side * SPACING / 2.0 + 1.0), 6);
    }

    fn cloud(&mut self) {
        self.world.gravity = Vector::ZERO;
        let side = self.lattice(2.0, Vector::ZERO, 5.0);
        self.box_around(None, Vector::splat(side * SPACING + 0.5), 6);
    }

    fn conveyor(&mut self) {
        let (rows, width) = (self.plan.bodies.div_ceil(8), 6.0);
        let length = rows as Real * SPACING;
        let body = RigidBodyBuilder::kinematic_velocity_based().linvel(Vector::X * 1.5);
        let body = self.world.insert_body(body);
        self.wall(Some(body), Vector::Y * -WALL, Vector::new(length / 2.0 + 1.0, WALL, width));
        for side in [-1.0, 1.0] {
            let place = Vector::new(0.0, 1.0, side * (width / 2.0 + WALL));
            self.wall(None, place, Vector::new(length / 2.0 + 1.0, 2.0, WALL));
        }
        self.belt = Some(Belt { body, length, width });
        for i in 0..self.plan.bodies {
            let (row, column, layer) = (i / 8, i % 4, i / 4 % 2);
            let place = Vector::new(
                (row as Real + 0.5) * SPACING - length / 2.0,
                0.8 + layer as Real * SPACING,
                (column as Real - 1.5) * SPACING,
            );
            self.drop_at(place, Vector::ZERO);
        }
    }

    /// Sets all bodies out on a cube's lattice about `centre`, `apart` times the usual distance;
    /// returns the cube's side in bodies.
    pub(super) fn lattice(&mut self, apart: Real, centre: Vector, speed: Real) -> Real {
        let side = (1..).find(|n| n * n * n >= self.plan.bodies).unwrap_or(1);
        for i in 0..self.plan.bodies {
            let cell = [i % side, i / side / side, i / side % side].map(|c| c as Real + 0.5);
            let middle = Vector::from_array(cell) - Vector::splat(side as Real / 2.0);
            let place = centre + middle * (SPACING * apart) + self.random.vector() * 0.05;
            let velocity = self.random.vector() * speed;
            self.drop_at(place, velocity);
        }
        side as Real
    }

    pub(super) fn drop_at(&mut self, place: Vector, velocity: Vector) {
        let form = self.random.below(self.colliders.len());
        let body = RigidBodyBuilder::dynamic()
            .pose(Pose::from_parts(place, self.random.rotation()))
            .linvel(velocity)
            .angvel(self.random.vector() * velocity.length() * 0.5);
        let body = self.world.insert_body(body);
        for collider in &self.colliders[form] {
            let mut collider = collider.clone();
            if self.plan.scene == Scene::Cloud {
                collider.set_restitution(1.0);
                collider.set_friction(0.0);
            }
            self.world.insert_collider(collider, Some(body));
        }
    }

    /// The first `count` walls of a box: the floor first, the ceiling last.
    pub(super) fn box_around(&mut self, body: Option<RigidBodyHandle>, half: Vector, count: usize) {
        let sides = [-Vector::Y, Vector::X, -Vector::X, Vector::Z, -Vector::Z, Vector::Y];
        for side in &sides[..count] {
            let flat = Vector::ONE - side.abs();
            let place = *side * (half + Vector::splat(WALL));
            let open = if count == 5 { Vector::Y * half.y } else { Vector::ZERO };
            let tall = if side.y == 0.0 { open } else { Vector::ZERO };
            let extent = flat * (half + Vector::splat(2.0 * WALL) + tall) + side.abs() * WALL;
            self.wall(body, place + tall, extent);
        }
    }

    fn wall(&mut self, body: Option<RigidBodyHandle>, place: Vector, half: Vector) {
        let wall = ColliderBuilder::cuboid(half.x, half.y, half.z).translation(place);
        let bounce = if self.plan.scene == Scene::Cloud { 1.0 } else { 0.0 };
        self.world.insert_collider(wall.restitution(bounce).friction(0.5), body);
    }

    /// What happens from outside between two steps.
    pub fn between_steps(&mut self) {
        match self.plan.scene {
            Scene::Conveyor => self.convey(),
            Scene::Zoo => self.disturb(),
            _ => {}
        }
    }

    /// The belt is put back, what fell off is replaced.
    fn convey(&mut self) {
        let Some(Belt { body, length, width }) = self.belt else {
            return;
        };
        if let Some(belt) = self.world.bodies.get_mut(body) {
            belt.set_translation(Vector::ZERO, true);
        }
        let gone = |(_, rb): &(RigidBodyHandle, &RigidBody)| {
            rb.is_dynamic() && (rb.translation().x > length / 2.0 || rb.translation().y < -3.0)
        };
        let gone: Vec<_> =
            self.world.bodies.iter().filter(gone).map(|(handle, _)| handle).collect();
        for handle in gone {
            self.world.remove_body(handle);
            let z = self.random.sign() * (width / 2.0 - 0.6);
            let place = Vector::new(0.6 - length / 2.0, 2.0 + self.random.sign(), z);
            self.drop_at(place, Vector::ZERO);
        }
    }

    /// The same scene in the same state, to be stepped apart.
    #[must_use]
    pub fn fork(&self) -> Self {
        let from = &self.world;
        Self {
            world: PhysicsWorld {
                gravity: from.gravity,
                integration_parameters: from.integration_parameters,
                physics_pipeline: PhysicsPipeline::new(),
                collision_pipeline: CollisionPipeline::new(),
                islands: from.islands.clone(),
                broad_phase: from.broad_phase.clone(),
                narrow_phase: from.narrow_phase.clone(),
                bodies: from.bodies.clone(),
                colliders: from.colliders.clone(),
                impulse_joints: from.impulse_joints.clone(),
                multibody_joints: from.multibody_joints.clone(),
                soft_bodies: from.soft_bodies.clone(),
                ccd_solver: from.ccd_solver.clone(),
            },
            plan: self.plan,
            colliders: self.colliders.clone(),
            random: self.random.clone(),
            belt: self.belt,
        }
    }
}

/// The colliders of one body.
fn made_of(kind: Kind, form: &TriangleMesh, hooks: ActiveHooks) -> Vec<Collider> {
    let points: Vec<Vector> = form.vertices.iter().map(|v| to_vector(*v)).collect();
    let hull =
        |points: &[Vector]| SharedShape::convex_hull(points).expect("every form has a volume");
    let halves = || {
        // Two hulls that share the cut through the middle.
        let cut = |side: Real| -> Vec<Vector> {
            let middle = points.iter().filter(|p| p.x.abs() < 0.15);
            points.iter().filter(|p| p.x * side > 0.0).chain(middle).copied().collect()
        };
        [hull(&cut(-1.0)), hull(&cut(1.0))]
    };
    let shapes = match kind {
        Kind::Hull => vec![hull(&points)],
        Kind::Mesh => {
            let mesh = SharedShape::trimesh(points.clone(), form.triangles.clone());
            vec![mesh.expect("every form has triangles")]
        }
        Kind::Compound => {
            vec![SharedShape::compound(halves().map(|half| (Pose::IDENTITY, half)).to_vec())]
        }
        Kind::Colliders => halves().to_vec(),
        Kind::Box => {
            let top = points.iter().fold(Vector::ZERO, |top, p| top.max(p.abs()));
            vec![SharedShape::cuboid(top.x, top.y, top.z)]
        }
        Kind::Ball => vec![SharedShape::ball(0.5)],
    };
    let collider = |shape| ColliderBuilder::new(shape).friction(0.5).active_hooks(hooks).build();
    shapes.into_iter().map(collider).collect()
}

fn to_vector(v: [f32; 3]) -> Vector {
    let [x, y, z] = v.map(|c| c as Real);
    Vector::new(x, y, z)
}
