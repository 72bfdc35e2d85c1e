//! [`Rank`]: one of many ranks, which culls frames in step with the others.

use std::time::Instant;

use serde::Serialize;

use super::body_columns::BodyColumns;
use super::cut::Cuts;
use super::error::{DomainError, agree};
use super::ghosts::{BallReaches, GhostPlan};
use crate::effects::Effects;
use crate::network::Network;
use crate::scene::Scene;
use crate::simulate::SimulationError;
use sdop::bodies::Bodies;
use sdop::bodies::contract::{ContractError, check_poses};
use sdop::counters::Seconds;
use sdop::culler::{CullError, Culler};
use sdop::rounding::border;
use sdop::settings::{CullSettings, Interest};
use sdop::simd::Tier;

/// A rank with what it holds of a scene.
pub struct Rank<'a, N> {
    pub(super) network: &'a N,
    pub(super) scene: Scene,
    pub(super) culler: Culler,
    pub(super) effects: Effects,
    pub(super) held: BodyColumns,
    pub(super) cuts: Option<Cuts>,
    pub(super) plan: GhostPlan,
    /// Centre and reach of each body held when owners were found last.
    pub(super) then: Vec<([f32; 3], f32)>,
    pub(super) skin: f32,
    pub(super) next: u32,
    pub(super) pairs: Vec<[u32; 2]>,
    pub(super) work: BorderCosts,
}

/// Wall time that borders add to [`Seconds`]. Sums over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BorderSeconds {
    /// Finding, sending and taking up ghosts, and telling own pairs from others'.
    pub ghosts: f64,
    /// Finding owners, moving bodies to them, and the culler's change to another set.
    pub migration: f64,
    /// Waiting for the slowest rank.
    pub waiting: f64,
}

/// What borders cost a rank, in addition to what its culler counts; sums over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct BorderCosts {
    pub seconds: BorderSeconds,
    /// Ghosts held.
    pub ghosts: u64,
    /// Those of them that move: each is updated again where it is a ghost.
    pub moving_ghosts: u64,
    /// Pairs that the culler found and another rank reports.
    pub others_pairs: u64,
    pub bytes_of_ghosts: u64,
    pub bytes_of_migration: u64,
    pub migrated: u64,
    /// How often owners were found, and space was cut.
    pub renewals: u64,
    pub cuts: u64,
}

/// One culled frame of a rank.
#[derive(Debug)]
pub struct RankFrame<'a> {
    /// Counted from 0.
    pub number: u32,
    /// The pairs that this rank reports, by the bodies' numbers in the scene, in the finder's
    /// order.
    pub pairs: &'a [[u32; 2]],
    /// What this rank's culling of it took; without effects and borders.
    pub seconds: Seconds,
}

impl<'a, N: Network> Rank<'a, N> {
    /// Prepares a rank for its share of the scene, as
    /// [`SceneFile::build_share`](crate::scene::SceneFile::build_share) has made it. Collective.
    ///
    /// # Errors
    /// What depends on the order of all pairs: a budget, and effects that depend on contacts.
    /// Settings that can't be carried out.
    pub fn new(
        network: &'a N,
        mut scene: Scene,
        tier: Tier,
        threads: usize,
    ) -> Result<Self, DomainError> {
        agree(network, supported(&scene, network.size()), 0)?;
        let start = scene.start_effects().map_err(SimulationError::Effect);
        let (effects, _) = agree(network, start.map_err(DomainError::from), 0)?;
        let share = scene.share();
        let bodies = std::mem::take(&mut scene.bodies);
        scene.velocities = Default::default();
        // Nobody is of interest before bodies are there.
        let settings = CullSettings {
            interest: scene.cull.interest.as_ref().map(|_| Interest::Bodies(Vec::new())),
            ..scene.cull.clone()
        };
        let culler = Culler::builder().settings(&settings).tier(tier).threads(threads);
        let culler = culler.build(&scene.shapes, &Bodies::default());
        let culler = culler.map_err(|error| SimulationError::Cull(error).into());
        let (culler, _) = agree(network, culler, 0)?;
        Ok(Self {
            network,
            culler,
            effects,
            held: BodyColumns::new(share.held.start, bodies),
            cuts: None,
            plan: GhostPlan::none(network.size()),
            then: Vec::new(),
            skin: 0.0,
            next: 0,
            pairs: Vec::new(),
            work: BorderCosts::default(),
            scene,
        })
    }

    /// Goes to the next frame (the first needs no step) and culls it; `None` after the last.
    /// Collective.
    ///
    /// # Errors
    /// A body that left the contract, on any rank.
    pub fn next_frame(&mut self) -> Result<Option<RankFrame<'_>>, DomainError> {
        if self.next >= self.scene.frames {
            return Ok(None);
        }
        let stepped = if self.next == 0 { Ok(()) } else { self.step() };
        self.frame(stepped).map(Some)
    }

    /// Goes to the next frame with poses from elsewhere, one for each body of the scene, in place
    /// of a step, and culls it. Static bodies stay where they are. Collective.
    ///
    /// # Errors
    /// A pose outside of the contract.
    ///
    /// # Panics
    /// Fewer poses than the scene has bodies.
    pub fn frame_at(&mut self, poses: &Bodies) -> Result<RankFrame<'_>, DomainError> {
        let held = &mut self.held;
        let own = (0..held.len()).filter(|&place| held.owned[place] && held.bodies.dynamic[place]);
        for place in own {
            let number = held.numbers[place] as usize;
            held.bodies.rotation[place] = poses.rotation[number];
            held.bodies.translation[place] = poses.translation[number];
        }
        let checked = check_poses(&held.bodies, 0..held.len());
        let checked = checked.map_err(|error| self.contract_error(error));
        self.frame(checked)
    }

    /// Culls the bodies where they are now, unless a rank failed to bring them there.
    fn frame(&mut self, stepped: Result<(), DomainError>) -> Result<RankFrame<'_>, DomainError> {
        let number = self.next;
        let start = Instant::now();
        let drifted = number == 0 || stepped.is_err() || self.has_drifted();
        let measured = Instant::now();
        let ((), drifted) = agree(self.network, stepped, drifted.into())?;
        self.work.seconds.waiting += measured.elapsed().as_secs_f64();
        self.work.seconds.ghosts += (measured - start).as_secs_f64();
        if drifted == 0 {
            let start = Instant::now();
            self.work.bytes_of_ghosts += self.plan.follow(self.network, &mut self.held);
            self.work.seconds.ghosts += start.elapsed().as_secs_f64();
        } else {
            self.renew();
        }
        let before = *self.culler.seconds();
        let culled = self.cull();
        let seconds = self.culler.seconds().since(&before);
        let start = Instant::now();
        agree(self.network, culled, 0)?;
        self.work.seconds.waiting += start.elapsed().as_secs_f64();
        self.next += 1;
        let start = Instant::now();
        self.select();
        self.work.seconds.ghosts += start.elapsed().as_secs_f64();
        Ok(RankFrame { number, pairs: &self.pairs, seconds })
    }

    fn step(&mut self) -> Result<(), DomainError> {
        let step = self.effects.step(&mut self.held.bodies);
        step.map_err(|error| self.contract_error(error))
    }

    fn cull(&mut self) -> Result<(), DomainError> {
        match self.culler.cull(&self.held.bodies).err() {
            None => Ok(()),
            Some(CullError::Contract(error)) => Err(self.contract_error(error)),
            Some(error) => Err(SimulationError::Cull(error).into()),
        }
    }

    /// The error with the body's number in the scene.
    fn contract_error(&self, error: ContractError) -> DomainError {
        let (frame, body) = (self.next, self.held.numbers[error.body] as usize);
        let error = ContractError { body, ..error };
        SimulationError::contract(frame, error).into()
    }

    /// The ball of the body in a place now.
    pub(super) fn ball(&self, place: usize) -> ([f32; 3], f32) {
        let Bodies { shape, rotation, translation, .. } = &self.held.bodies;
        self.culler.reach(shape[place], rotation[place], translation[place])
    }

    fn has_drifted(&self) -> bool {
        let mut own = self.held.own().filter(|&place| self.held.bodies.dynamic[place]);
        let stays = |place| border::stays(self.ball(place), self.then[place], self.skin);
        self.network.size() > 1 && own.any(|place| !stays(place))
    }

    /// Selects the pairs that this rank reports from those that its culler has found.
    fn select(&mut self) {
        let held = &self.held;
        let found = self.culler.pairs();
        self.pairs.clear();
        // Most pairs are of two bodies owned here: nothing is to be looked up for those.
        let both = |pair: [u32; 2]| pair.iter().all(|&place| held.owned[place as usize]);
        let own = found.iter().filter(|&pair| both(pair) || held.owned[decider(&self.then, pair)]);
        let named = own.map(|pair| pair.map(|place| held.numbers[place as usize]));
        self.pairs.extend(named);
        let ghosts = held.owned.iter().filter(|owned| !**owned).count();
        self.work.ghosts += ghosts as u64;
        self.work.moving_ghosts += self.plan.followers();
        self.work.others_pairs += (found.len() - self.pairs.len()) as u64;
    }

    /// How many bodies this rank owns, and how many ghosts it holds.
    #[must_use]
    pub fn bodies(&self) -> [usize; 2] {
        let own = self.held.own().count();
        [own, self.held.len() - own]
    }

    /// The numbers and poses of the bodies that this rank owns.
    pub fn poses(&self) -> impl Iterator<Item = (u32, [f32; 4], [f32; 3])> + '_ {
        let Bodies { rotation, translation, .. } = &self.held.bodies;
        let pose = |place| (self.held.numbers[place], rotation[place], translation[place]);
        self.held.own().map(pose)
    }
}

/// The place of the body whose owner reports a pair of places: the one that reaches less far, of
/// two alike the lower.
fn decider(balls: &BallReaches, [i, j]: [u32; 2]) -> usize {
    let [i, j] = [i as usize, j as usize];
    if balls[j].1 < balls[i].1 { j } else { i }
}

/// Whether a scene's frames can be shared by ranks.
fn supported(scene: &Scene, ranks: usize) -> Result<(), DomainError> {
    let refuse = |what: String, hint| Err(DomainError::Unsupported { what, ranks, hint });
    let strategy = scene.cull.strategy;
    if let Some((exact, nearest)) = scene.fine.first() {
        let hint =
            "ranks exchange f32 poses: leave mpirun out, or write the nearest f32 into `poses`";
        let what =
            format!("`poses` with the translation {exact:?}, whose nearest f32 is {nearest:?},");
        return refuse(what, hint);
    }
    if ranks > 1 && strategy.scheme().has_budget() {
        let hint =
            "a budget is spent in one order over all pairs: take another strategy, or one process";
        return refuse(format!("strategy {strategy}"), hint);
    }
    if ranks > 1 && scene.effects.response.is_some() {
        let hint = "contacts are answered one after the other over all bodies: leave `response` out, or take one process";
        return refuse("effect response".to_owned(), hint);
    }
    if ranks > 1 && scene.effects.rest.is_some() {
        let hint = "how long bodies have been slow isn't sent between ranks: leave `rest` out, or take one process";
        return refuse("effect rest".to_owned(), hint);
    }
    Ok(())
}
