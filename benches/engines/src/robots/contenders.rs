//! Ways to find the pairs of parts of robots.

use parry3d::bounding_volume::Aabb;
use parry3d::math::Vector;
use parry3d::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use rapier3d::dynamics::{IntegrationParameters, RigidBodySet};
use rapier3d::geometry::{
    ActiveCollisionTypes, BroadPhaseBvh, BroadPhasePairEvent, ColliderBuilder, ColliderHandle,
    ColliderSet,
};
use sdop::compound::{Compound, PartCuller, PartPair};
use sdop::{Body, BodyId, World};
use sdop_bench::remedy::OrReport as _;

use super::scene::{HALF_SIDES, Meeting, PARTS, PartPose, RobotPose, Robots, named};
use crate::changes::Changes;
use crate::rapier::NO_SKIN;

/// A way to find them. The timed work is from the robots' poses to a complete answer in memory.
pub trait Contender {
    /// Finds the pairs of a frame. This is timed.
    fn frame(&mut self, robots: &Robots, poses: &[RobotPose]);

    /// Does what is left over from the frame, outside of the clock.
    fn settle(&mut self) {}

    /// The pairs of the last frame, sorted.
    fn pairs(&self) -> Vec<Meeting>;
}

/// One body per robot: S-DOP on two levels.
pub struct Compounds {
    world: World,
    ids: Vec<BodyId>,
    culler: PartCuller,
}

impl Compounds {
    pub fn new(robots: &Robots) -> miette::Result<Self> {
        let compound = Compound::build("robot", &robots.shapes, &robots.parts).or_report()?;
        let mut world = World::new(vec![compound.shape().clone()]).or_report()?;
        let at = |pose: &RobotPose| Body::at(0, pose.rotation, pose.translation);
        let ids = robots.frames[0]
            .iter()
            .map(|pose| world.insert(at(pose)).or_report());
        let ids = ids.collect::<miette::Result<_>>()?;
        let mut culler = PartCuller::new();
        culler.set_parts(0, compound);
        Ok(Self { world, ids, culler })
    }
}

impl Contender for Compounds {
    fn frame(&mut self, _: &Robots, poses: &[RobotPose]) {
        for (&id, pose) in self.ids.iter().zip(poses) {
            let set = self.world.set_pose(id, pose.rotation, pose.translation);
            assert!(set.is_ok(), "{set:?}");
        }
        let culled = self.world.cull().map(drop);
        assert!(culled.is_ok(), "{culled:?}");
        let found = self.culler.cull(&self.world).map(drop);
        assert!(found.is_ok(), "{found:?}");
    }

    fn pairs(&self) -> Vec<Meeting> {
        let named = |pair: &PartPair| {
            [0, 1].map(|side| [pair.bodies[side].slot() as u32, pair.parts[side]])
        };
        let mut pairs: Vec<Meeting> = self.culler.pairs().iter().map(named).collect();
        pairs.sort_unstable();
        pairs
    }
}

/// One body per part: pairs within a robot are excluded.
pub struct Parts {
    world: World,
    ids: Vec<BodyId>,
}

impl Parts {
    pub fn new(robots: &Robots) -> miette::Result<Self> {
        let mut world = World::new(robots.shapes.clone()).or_report()?;
        let mut ids = Vec::new();
        for part in robots.posed(&robots.frames[0]) {
            let rotation = part.rotation.map(|x| x as f32);
            let body = Body::at(part.shape as u32, rotation, part.translation);
            ids.push(world.insert(body).or_report()?);
        }
        for robot in ids.chunks(PARTS) {
            for (number, &part) in robot.iter().enumerate() {
                for &other in &robot[..number] {
                    world.exclude(part, other).or_report()?;
                }
            }
        }
        Ok(Self { world, ids })
    }
}

impl Contender for Parts {
    fn frame(&mut self, robots: &Robots, poses: &[RobotPose]) {
        for (&id, part) in self.ids.iter().zip(robots.posed(poses)) {
            let set = self
                .world
                .set_pose(id, part.rotation.map(|x| x as f32), part.translation);
            assert!(set.is_ok(), "{set:?}");
        }
        let culled = self.world.cull().map(drop);
        assert!(culled.is_ok(), "{culled:?}");
    }

    fn pairs(&self) -> Vec<Meeting> {
        // Sorted by slots, which are numbered by robots.
        self.world
            .pairs()
            .map(|pair| pair.map(|id| named(id.slot())))
            .collect()
    }
}

/// parry3d's tree over the boxes of parts.
pub struct Parry {
    tree: Bvh,
    workspace: BvhWorkspace,
    pairs: Vec<[u32; 2]>,
}

impl Parry {
    pub fn new(robots: &Robots) -> Self {
        let boxes: Vec<Aabb> = robots
            .posed(&robots.frames[0])
            .map(|part| aabb(&part))
            .collect();
        Self {
            tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes),
            workspace: BvhWorkspace::default(),
            pairs: Vec::new(),
        }
    }
}

impl Contender for Parry {
    fn frame(&mut self, robots: &Robots, poses: &[RobotPose]) {
        let Self {
            tree,
            workspace,
            pairs,
        } = self;
        for (number, part) in (0..).zip(robots.posed(poses)) {
            tree.insert_or_update_partially(aabb(&part), number, 0.0);
        }
        tree.optimize_incremental(workspace);
        tree.refit(workspace);
        pairs.clear();
        tree.traverse_bvtt_single_tree::<false>(workspace, &mut |i, j| {
            if are_apart([i, j]) {
                pairs.push([i, j]);
            }
        });
    }

    fn pairs(&self) -> Vec<Meeting> {
        sorted(&self.pairs)
    }
}

/// rapier3d's broad phase over the boxes of parts. It reports what has changed.
pub struct Rapier {
    broad_phase: BroadPhaseBvh,
    parameters: IntegrationParameters,
    colliders: ColliderSet,
    bodies: RigidBodySet,
    handles: Vec<ColliderHandle>,
    events: Vec<BroadPhasePairEvent>,
    changed: Vec<([u32; 2], bool)>,
    changes: Changes,
}

impl Rapier {
    pub fn new(robots: &Robots) -> Self {
        let mut colliders = ColliderSet::new();
        let parts = robots.count() * PARTS;
        let ball =
            || ColliderBuilder::ball(1.0).active_collision_types(ActiveCollisionTypes::all());
        let handles = (0..parts).map(|_| colliders.insert(ball())).collect();
        let parameters = IntegrationParameters {
            length_unit: NO_SKIN,
            ..IntegrationParameters::default()
        };
        Self {
            broad_phase: BroadPhaseBvh::new(),
            parameters,
            colliders,
            bodies: RigidBodySet::new(),
            handles,
            events: Vec::new(),
            changed: Vec::new(),
            changes: Changes::default(),
        }
    }
}

impl Contender for Rapier {
    fn frame(&mut self, robots: &Robots, poses: &[RobotPose]) {
        for (&handle, part) in self.handles.iter().zip(robots.posed(poses)) {
            self.broad_phase
                .set_aabb(&self.parameters, handle, aabb(&part));
        }
        self.events.clear();
        let Self {
            broad_phase,
            parameters,
            colliders,
            bodies,
            events,
            ..
        } = self;
        broad_phase.update(parameters, colliders, bodies, &[], &[], events);
        let changes = self.events.iter().map(crate::rapier::change);
        self.changed.clear();
        self.changed
            .extend(changes.filter(|(pair, _)| are_apart(*pair)));
    }

    fn settle(&mut self) {
        for &(pair, begins) in &self.changed {
            self.changes.note(pair, begins);
        }
    }

    fn pairs(&self) -> Vec<Meeting> {
        sorted(&self.changes.pairs())
    }
}

/// Whether two parts are of two robots.
fn are_apart([i, j]: [u32; 2]) -> bool {
    i / PARTS as u32 != j / PARTS as u32
}

fn sorted(pairs: &[[u32; 2]]) -> Vec<Meeting> {
    let named = pairs.iter().map(|pair| {
        let mut named = pair.map(|number| named(number as usize));
        named.sort_unstable();
        named
    });
    let mut named: Vec<Meeting> = named.collect();
    named.sort_unstable();
    named
}

/// The box about a part on the world's axes.
fn aabb(part: &PartPose) -> Aabb {
    let [x, y, z, w] = part.rotation.map(|x| x as f32);
    let rows = [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
        ],
        [
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
        ],
        [
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ];
    let half = rows.map(|row| {
        (0..3)
            .map(|i| row[i].abs() * HALF_SIDES[part.shape][i])
            .sum()
    });
    let middle = Vector::from_array(part.translation.map(|x| x as f32));
    Aabb::from_half_extents(middle, Vector::from_array(half))
}
