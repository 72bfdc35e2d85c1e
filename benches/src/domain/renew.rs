//! Renewals: owners and ghosts are determined again, bodies migrate, and space is cut again if the
//! ranks' numbers of bodies have become unequal.

use std::time::Instant;

use super::body_columns::BodyMessage;
use super::cut::Cuts;
use super::ghosts::{BorderFacts, GhostPlan};
use super::rank::Rank;
use crate::effects::runs;
use crate::network::Network;
use sdop::rounding::border;
use sdop::settings::{Interest, ViewCone};

/// A skin of this share of the mean reach: a renewal costs a rank what some frames of all its
/// bodies do, and a wider skin adds ghosts at its borders alone. Wider still pays in worlds of
/// millions a rank, and not in small or crowded ones.
const SKIN_SHARE: f64 = 0.5;

/// Space is cut anew when a rank owns this much more than its equal share, and more than a few
/// bodies.
const MOST_IMBALANCE: f64 = 1.1;
const SPARE_BODIES: f64 = 16.0;

impl<N: Network> Rank<'_, N> {
    /// Finds owners and ghosts anew.
    pub(super) fn renew(&mut self) {
        let start = Instant::now();
        self.held.velocities = self.effects.take_velocities();
        self.migrate();
        let migrated = Instant::now();
        self.then = self.balls();
        let border = self.border();
        self.skin = border.skin;
        if let Some(cuts) = &self.cuts {
            let (plan, bytes) =
                GhostPlan::make(self.network, cuts, &border, &mut self.held, &self.then);
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

    /// Drops the ghosts and moves bodies to their owners; cuts space where these are not there yet,
    /// or too unequal.
    fn migrate(&mut self) {
        let (network, ranks) = (self.network, self.network.size());
        if ranks == 1 {
            return;
        }
        let places: Vec<usize> = self.held.own().collect();
        let centres: Vec<[f32; 3]> = places.iter().map(|&place| self.ball(place).0).collect();
        let fair = |cuts: &Cuts| {
            let mut owned = vec![0; ranks];
            centres.iter().for_each(|centre| owned[cuts.owner(*centre)] += 1);
            network.sum(&mut owned);
            let most = owned.iter().max().map_or(0.0, |&most| most as f64);
            let equal = owned.iter().sum::<u64>() as f64 / ranks as f64;
            most <= MOST_IMBALANCE * equal + SPARE_BODIES
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
        let arrived = received.iter().flat_map(|message| BodyMessage::read_all(message, true));
        self.held.change(|place| stays[place], arrived.collect());
    }

    /// What all ranks must know of the bodies before ghosts are sent. Collective.
    fn border(&self) -> BorderFacts {
        let reaches = || self.then.iter().map(|(_, reach)| *reach);
        let widest = reaches().fold(0.0, f32::max);
        let sum: f64 = reaches().map(f64::from).sum();
        let mine = [self.then.len() as u64, sum.to_bits(), u64::from(widest.to_bits())];
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
        BorderFacts {
            widest: ranks.iter().map(|[.., widest]| f32::from_bits(*widest as u32)).collect(),
            skin: border::skin(mean, SKIN_SHARE),
            everywhere,
        }
    }

    /// Gives the bodies that the rank holds now to the effects and the culler.
    fn take_up(&mut self) {
        let held = &mut self.held;
        let movers: Vec<bool> =
            held.owned.iter().zip(&held.bodies.dynamic).map(|(a, b)| *a && *b).collect();
        let velocities = std::mem::take(&mut held.velocities);
        self.effects.replace(&held.numbers, velocities, runs(&movers));
        if let Some(interest) = &self.scene.cull.interest {
            let place = |number: u32| held.place(number).map(|place| place as u32);
            self.culler.set_interest(match interest {
                Interest::Bodies(list) => {
                    Interest::Bodies(list.iter().filter_map(|&number| place(number)).collect())
                }
                Interest::Cone(cone) => {
                    Interest::Cone(ViewCone { body: cone.body.and_then(place), ..cone.clone() })
                }
            });
        }
        self.culler.replace(&held.bodies, &vec![true; held.len()]);
    }
}
