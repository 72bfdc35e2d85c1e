//! The scenes, set up and stepped.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sdop::mesh::TriangleMesh;

use crate::native::{Counts, Motion, Scene};
use crate::plan::{Kind, Mode, Plan, SceneKind};

/// Distance between bodies when they are set out; none is larger than 1.
const SPACING: f32 = 1.25;

/// Seconds of a step.
const STEP: f32 = 1.0 / 60.0;

/// A scene that can be stepped.
pub struct Stage {
    scene: Scene,
    plan: Plan,
    steps: usize,
}

impl Stage {
    /// Sets it up. Margins are taken times `share`: 1, but for a planted bug.
    #[must_use]
    pub fn new(plan: Plan, forms: &[TriangleMesh], mode: Mode, share: f32) -> Self {
        let mut scene = Scene::new(mode);
        let shapes: Vec<_> = forms.iter().map(|form| scene.shape(plan.kind, form, share)).collect();
        let (apart, speed, restitution, friction) = match plan.scene {
            SceneKind::Cloud => (2.0, 5.0, 1.0, 0.0),
            SceneKind::Pile | SceneKind::Tumbler => (1.0, 0.0, 0.0, 0.5),
        };
        let side = (1..).find(|n| n * n * n >= plan.bodies).unwrap_or(plan.bodies);
        let half = side as f32 * SPACING * apart / 2.0 + 0.2;
        let walls = if plan.scene == SceneKind::Pile { 5 } else { 6 };
        for wall in 0..walls {
            // The floor first, the ceiling last.
            let (axis, sign) =
                [(1, 1.0), (0, 1.0), (0, -1.0), (2, 1.0), (2, -1.0), (1, -1.0)][wall];
            let mut normal = [0.0; 3];
            normal[axis] = sign;
            scene.wall(normal, -half, restitution);
        }
        let mut random = Random(ChaCha8Rng::seed_from_u64(plan.seed));
        for i in 0..plan.bodies {
            let cell = [i % side, i / side / side, i / side % side];
            let place = cell.map(|c| (c as f32 + 0.5 - side as f32 / 2.0) * SPACING * apart);
            let shape = shapes[random.below(shapes.len())];
            let jitter = random.vector(0.05);
            let motion = Motion {
                rotation: random.rotation(),
                translation: [0, 1, 2].map(|axis| place[axis] + jitter[axis]),
                velocity: random.vector(speed),
                spin: random.vector(speed * 0.5),
            };
            scene.body(shape, motion, restitution, friction);
        }
        let mut stage = Self { scene, plan, steps: 0 };
        stage.turn_gravity();
        stage
    }

    /// One step.
    pub fn step(&mut self) {
        if self.plan.scene == SceneKind::Tumbler {
            self.turn_gravity();
        }
        self.scene.step(STEP);
        self.steps += 1;
    }

    /// What has happened so far.
    #[must_use]
    pub fn counts(&self) -> Counts {
        self.scene.counts()
    }

    fn turn_gravity(&mut self) {
        let angle = match self.plan.scene {
            SceneKind::Tumbler => self.steps as f32 * STEP,
            SceneKind::Pile | SceneKind::Cloud => 0.0,
        };
        let strength = match self.plan.scene {
            SceneKind::Cloud => 0.0,
            SceneKind::Pile | SceneKind::Tumbler => 9.81,
        };
        let (sin, cos) = angle.sin_cos();
        self.scene.set_gravity([strength * sin, -strength * cos, 0.0]);
    }
}

/// Whether the filter looks at this kind.
#[must_use]
pub const fn is_filtered(kind: Kind) -> bool {
    matches!(kind, Kind::Hull | Kind::Mesh)
}

/// Numbers of a seed, the same on every platform.
struct Random(ChaCha8Rng);

impl Random {
    /// Uniform in [−1, 1).
    fn sign(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 / (1 << 23) as f32 - 1.0
    }

    fn vector(&mut self, scale: f32) -> [f32; 3] {
        std::array::from_fn(|_| self.sign() * scale)
    }

    /// Uniform over all rotations: a quaternion from the unit ball.
    fn rotation(&mut self) -> [f32; 4] {
        loop {
            let q: [f32; 4] = std::array::from_fn(|_| self.sign());
            let square: f32 = q.iter().map(|x| x * x).sum();
            if square > 0.01 && square <= 1.0 {
                return q.map(|x| x / square.sqrt());
            }
        }
    }

    fn below(&mut self, count: usize) -> usize {
        ((u64::from(self.0.next_u32()) * count as u64) >> 32) as usize
    }
}
