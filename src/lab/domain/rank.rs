//! One of many ranks: its frames, one after the other, in step with the others.

use std::time::Instant;

use super::cut::Cuts;
use super::error::{DomainError, agree};
use super::ghosts::{Balls, Border, Plan};
use super::held::{Held, Record};
use super::network::Network;
use super::run::BorderSeconds;
use crate::bodies::Bodies;
use crate::bodies::contract::{ContractError, check_poses};
use crate::culler::{CullError, Culler};
use crate::lab::effects::{Effects, runs};
use crate::lab::scene::Scene;
use crate::lab::simulate::SimulationError;
use crate::rounding::border;
use crate::settings::{CullSettings, Interest, ViewCone};
use crate::simd::Tier;

/// A skin of this share of the mean reach: wide enough for some frames of bodies that move a few hundredths of their radius a
/// frame, narrow enough that it adds few ghosts.
const SKIN: f64 = 0.25;

/// Space is cut anew when a rank owns this much more than its equal share, and more than a few bodies.
const UNEQUAL: f64 = 1.1;
const A_FEW: f64 = 16.0;

/// A rank with what it holds of a scene.
pub struct Rank<'a, N> {
    network: &'a N,
    scene: Scene,
    culler: Culler,
    effects: Effects,
    held: Held,
    cuts: Option<Cuts>,
    plan: Plan,
    /// Centre and reach of each body held when owners were found last.
    then: Vec<([f32; 3], f32)>,
    skin: f32,
    next: u32,
    pairs: Vec<[u32; 2]>,
    work: Work,
}

/// What borders cost a rank, besides what its culler counts. Sums over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Work {
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
    /// The pairs that this rank reports, by the bodies' numbers in the scene, in the finder's order.
    pub pairs: &'a [[u32; 2]],
}

impl<'a, N: Network> Rank<'a, N> {
    /// Prepares a rank for its share of the scene, as [`SceneFile::build_share`](crate::lab::scene::SceneFile::build_share)
    /// has made it. Collective.
    ///
    /// # Errors
    /// What depends on the order of all pairs: a budget, and the response to contacts. Settings that can't be carried out.
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
            interest: scene
                .cull
                .interest
                .as_ref()
                .map(|_| Interest::Bodies(Vec::new())),
            ..scene.cull.clone()
        };
        let culler = Culler::builder()
            .settings(&settings)
            .tier(tier)
            .threads(threads);
        let culler = culler.build(&scene.shapes, &Bodies::default());
        let culler = culler.map_err(|error| SimulationError::Cull(error).into());
        let (culler, _) = agree(network, culler, 0)?;
        Ok(Self {
            network,
            culler,
            effects,
            held: Held::new(share.held.start, bodies),
            cuts: None,
            plan: Plan::none(network.size()),
            then: Vec::new(),
            skin: 0.0,
            next: 0,
            pairs: Vec::new(),
            work: Work::default(),
            scene,
        })
    }

    /// Goes to the next frame (the first needs no step) and culls it; `None` after the last. Collective.
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

    /// Goes to the next frame with poses from elsewhere, one for each body of the scene, in place of a step, and culls it.
    /// Static bodies stay where they are. Collective.
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
        let culled = self.cull();
        agree(self.network, culled, 0)?;
        self.next += 1;
        let start = Instant::now();
        self.select();
        self.work.seconds.ghosts += start.elapsed().as_secs_f64();
        let pairs = &self.pairs;
        Ok(RankFrame { number, pairs })
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
        SimulationError::Contract { frame, error }.into()
    }

    /// The ball of the body in a place now.
    fn ball(&self, place: usize) -> ([f32; 3], f32) {
        let Bodies {
            shape,
            rotation,
            translation,
            ..
        } = &self.held.bodies;
        self.culler
            .reach(shape[place], rotation[place], translation[place])
    }

    fn has_drifted(&self) -> bool {
        let mut own = self
            .held
            .own()
            .filter(|&place| self.held.bodies.dynamic[place]);
        let stays = |place| border::stays(self.ball(place), self.then[place], self.skin);
        self.network.size() > 1 && own.any(|place| !stays(place))
    }

    /// Finds owners and ghosts anew.
    fn renew(&mut self) {
        let start = Instant::now();
        self.held.velocities = self.effects.take_velocities();
        self.migrate();
        let migrated = Instant::now();
        self.then = self.balls();
        let border = self.border();
        self.skin = border.skin;
        if let Some(cuts) = &self.cuts {
            let (plan, bytes) = Plan::make(self.network, cuts, &border, &mut self.held, &self.then);
            self.plan = plan;
            self.work.bytes_of_ghosts += bytes;
            self.then = self.balls();
        }
        let found = Instant::now();
        self.take_up();
        self.work.renewals += 1;
        let seconds = &mut self.work.seconds;
        seconds.migration += (migrated - start).as_secs_f64() + found.elapsed().as_secs_f64();
        seconds.ghosts += (found - migrated).as_secs_f64();
    }

    fn balls(&self) -> Vec<([f32; 3], f32)> {
        (0..self.held.len()).map(|place| self.ball(place)).collect()
    }

    /// Drops the ghosts and moves bodies to their owners; cuts space where these are not there yet, or too unequal.
    fn migrate(&mut self) {
        let (network, ranks) = (self.network, self.network.size());
        if ranks == 1 {
            return;
        }
        let places: Vec<usize> = self.held.own().collect();
        let centres: Vec<[f32; 3]> = places.iter().map(|&place| self.ball(place).0).collect();
        let fair = |cuts: &Cuts| {
            let mut owned = vec![0; ranks];
            centres
                .iter()
                .for_each(|centre| owned[cuts.owner(*centre)] += 1);
            network.sum(&mut owned);
            let most = owned.iter().max().map_or(0.0, |&most| most as f64);
            let equal = owned.iter().sum::<u64>() as f64 / ranks as f64;
            most <= UNEQUAL * equal + A_FEW
        };
        let kept = self.cuts.take().filter(fair);
        let cuts = kept.unwrap_or_else(|| {
            self.work.cuts += 1;
            Cuts::make(network, &centres)
        });
        let mut outgoing = vec![Vec::new(); ranks];
        let mut stays = vec![false; self.held.len()];
        for (&place, centre) in places.iter().zip(&centres) {
            let owner = cuts.owner(*centre);
            if owner == network.rank() {
                stays[place] = true;
            } else {
                self.held.record(place, true).write(&mut outgoing[owner]);
                self.work.migrated += 1;
            }
        }
        self.cuts = Some(cuts);
        self.work.bytes_of_migration += outgoing.iter().map(|m| m.len() as u64).sum::<u64>();
        let received = network.exchange(outgoing);
        let arrived = received
            .iter()
            .flat_map(|message| Record::read_all(message, true));
        self.held.change(|place| stays[place], arrived.collect());
    }

    /// What all ranks must know of the bodies before ghosts are sent. Collective.
    fn border(&self) -> Border {
        let reaches = || self.then.iter().map(|(_, reach)| *reach);
        let widest = reaches().fold(0.0, f32::max);
        let sum: f64 = reaches().map(f64::from).sum();
        let mine = [
            self.then.len() as u64,
            sum.to_bits(),
            u64::from(widest.to_bits()),
        ];
        let all = self.network.gather(&mine);
        let (ranks, _) = all.as_chunks::<3>();
        // Added up in the order of ranks, so that all come to the same mean.
        let bodies: u64 = ranks.iter().map(|[bodies, ..]| bodies).sum();
        let sum: f64 = ranks.iter().map(|[_, sum, _]| f64::from_bits(*sum)).sum();
        let mean = (sum / bodies.max(1) as f64) as f32;
        let everywhere = match &self.scene.cull.interest {
            Some(Interest::Cone(cone)) => cone.body,
            _ => None,
        };
        Border {
            widest: ranks
                .iter()
                .map(|[.., widest]| f32::from_bits(*widest as u32))
                .collect(),
            skin: border::skin(mean, SKIN),
            everywhere,
        }
    }

    /// Has effects and culler take up the bodies now held.
    fn take_up(&mut self) {
        let held = &mut self.held;
        let movers: Vec<bool> = held
            .owned
            .iter()
            .zip(&held.bodies.dynamic)
            .map(|(a, b)| *a && *b)
            .collect();
        let velocities = std::mem::take(&mut held.velocities);
        self.effects
            .replace(&held.numbers, velocities, runs(&movers));
        if let Some(interest) = &self.scene.cull.interest {
            let place = |number: u32| held.place(number).map(|place| place as u32);
            self.culler.set_interest(match interest {
                Interest::Bodies(list) => {
                    Interest::Bodies(list.iter().filter_map(|&number| place(number)).collect())
                }
                Interest::Cone(cone) => Interest::Cone(ViewCone {
                    body: cone.body.and_then(place),
                    ..cone.clone()
                }),
            });
        }
        self.culler.replace(&held.bodies, &vec![true; held.len()]);
    }

    /// Selects the pairs that this rank reports from those that its culler has found.
    fn select(&mut self) {
        let held = &self.held;
        let found = self.culler.pairs();
        self.pairs.clear();
        let own = found
            .iter()
            .filter(|&pair| held.owned[decider(&self.then, pair)]);
        let named = own.map(|pair| pair.map(|place| held.numbers[place as usize]));
        self.pairs.extend(named);
        let ghosts = held.owned.iter().filter(|owned| !**owned).count();
        self.work.ghosts += ghosts as u64;
        self.work.moving_ghosts += self.plan.followers();
        self.work.others_pairs += (found.len() - self.pairs.len()) as u64;
    }

    pub(super) fn network(&self) -> &'a N {
        self.network
    }

    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(super) fn culler(&self) -> &Culler {
        &self.culler
    }

    pub(super) fn effects(&self) -> &Effects {
        &self.effects
    }

    pub(super) fn work(&self) -> &Work {
        &self.work
    }

    /// How many bodies this rank owns, and how many ghosts it holds.
    #[must_use]
    pub fn bodies(&self) -> [usize; 2] {
        let own = self.held.own().count();
        [own, self.held.len() - own]
    }

    /// The numbers and poses of the bodies that this rank owns.
    pub fn poses(&self) -> impl Iterator<Item = (u32, [f32; 4], [f32; 3])> + '_ {
        let Bodies {
            rotation,
            translation,
            ..
        } = &self.held.bodies;
        let pose = |place| {
            (
                self.held.numbers[place],
                rotation[place],
                translation[place],
            )
        };
        self.held.own().map(pose)
    }
}

/// The place of the body whose owner reports a pair of places: the one that reaches less far, of two alike the lower.
fn decider(balls: &Balls, [i, j]: [u32; 2]) -> usize {
    let [i, j] = [i as usize, j as usize];
    if balls[j].1 < balls[i].1 { j } else { i }
}

/// Whether a scene's frames can be shared by ranks.
fn supported(scene: &Scene, ranks: usize) -> Result<(), DomainError> {
    let refuse = |what: String, hint| Err(DomainError::Unsupported { what, ranks, hint });
    let strategy = scene.cull.strategy;
    if ranks > 1 && strategy.scheme().has_budget() {
        let hint =
            "a budget is spent in one order over all pairs: take another strategy, or one process";
        return refuse(format!("strategy {strategy}"), hint);
    }
    if ranks > 1 && scene.effects.response.is_some() {
        let hint = "contacts are answered one after the other over all bodies: leave `response` out, or take one process";
        return refuse("effect response".to_owned(), hint);
    }
    Ok(())
}
