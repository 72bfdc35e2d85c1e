//! Ghosts: which bodies are sent to which rank, and their poses until owners change.

use super::body_columns::{BodyColumns, BodyMessage, read_poses, write_pose};
use super::cut::Cuts;
use crate::network::Network;
use sdop::rounding::border::may_meet;

/// A body's ball centre and its reach, by place.
pub(super) type BallReaches = [([f32; 3], f32)];

/// Which bodies travel between this rank and each other one, by their places here, in the order of
/// their poses in a message.
#[derive(Debug)]
pub(super) struct GhostPlan {
    send: Vec<Vec<u32>>,
    receive: Vec<Vec<u32>>,
}

/// What is agreed on before ghosts are sent.
#[derive(Debug)]
pub(super) struct BorderFacts {
    /// The largest reach of a body that each rank owns.
    pub widest: Vec<f32>,
    /// How far a body may drift before owners and ghosts are found anew.
    pub skin: f32,
    /// A body that every rank must know: the one that a view cone looks from.
    pub everywhere: Option<u32>,
}

impl GhostPlan {
    /// Nothing travels.
    pub fn none(ranks: usize) -> Self {
        let [send, receive] = [(); 2].map(|()| vec![Vec::new(); ranks]);
        Self { send, receive }
    }

    /// Finds the ghosts that others need of `held`, all owned, sends them, and adds those received.
    /// Collective.
    pub fn make(
        network: &impl Network,
        cuts: &Cuts,
        border: &BorderFacts,
        held: &mut BodyColumns,
        balls: &BallReaches,
    ) -> (Self, u64) {
        let (rank, ranks) = (network.rank(), network.size());
        let mut numbers: Vec<Vec<u32>> = vec![Vec::new(); ranks];
        for (place, &(centre, reach)) in balls.iter().enumerate() {
            let number = held.numbers[place];
            if border.everywhere == Some(number) {
                let others = numbers.iter_mut().enumerate();
                others.for_each(|(other, list)| list.extend((other != rank).then_some(number)));
                continue;
            }
            let far = 2.0 * f64::from(reach) + 2.0 * f64::from(border.skin);
            cuts.near(centre, far, &mut |other, distance| {
                if other != rank && may_meet(distance, reach, border.widest[other], border.skin) {
                    numbers[other].push(number);
                }
            });
        }
        let message = |list: &Vec<u32>| {
            let mut message = Vec::new();
            let places = list.iter().filter_map(|&number| held.place(number));
            places.for_each(|place| held.record(place, false).write(&mut message));
            message
        };
        let outgoing: Vec<_> = numbers.iter().map(message).collect();
        let bytes = outgoing.iter().map(|message| message.len() as u64).sum();
        let received = network.exchange(outgoing);
        let ghosts: Vec<Vec<BodyMessage>> = received
            .iter()
            .map(|message| BodyMessage::read_all(message, false).collect())
            .collect();
        held.change(|_| true, ghosts.concat());
        // Static bodies stay where they are, and so do their ghosts.
        let moving = |numbers: &mut dyn Iterator<Item = u32>| -> Vec<u32> {
            let places = numbers.filter_map(|number| held.place(number));
            let moving = places.filter(|&place| held.bodies.dynamic[place]);
            moving.map(|place| place as u32).collect()
        };
        let plan = Self {
            send: numbers.iter().map(|list| moving(&mut list.iter().copied())).collect(),
            receive: ghosts
                .iter()
                .map(|list| moving(&mut list.iter().map(|ghost| ghost.number)))
                .collect(),
        };
        (plan, bytes)
    }

    /// Brings the ghosts' poses up to date; returns the bytes sent. Collective.
    pub fn follow(&self, network: &impl Network, held: &mut BodyColumns) -> u64 {
        let bodies = &mut held.bodies;
        let message = |places: &Vec<u32>| {
            let mut message = Vec::new();
            for &place in places {
                let place = place as usize;
                write_pose(bodies.rotation[place], bodies.translation[place], &mut message);
            }
            message
        };
        let outgoing: Vec<_> = self.send.iter().map(message).collect();
        let bytes = outgoing.iter().map(|message| message.len() as u64).sum();
        let received = network.exchange(outgoing);
        for (places, message) in self.receive.iter().zip(received) {
            for (&place, (rotation, translation)) in places.iter().zip(read_poses(&message)) {
                let place = place as usize;
                (bodies.rotation[place], bodies.translation[place]) = (rotation, translation);
            }
        }
        bytes
    }

    /// How many ghosts move; each of them is updated once per frame.
    pub fn followers(&self) -> u64 {
        self.receive.iter().map(|list| list.len() as u64).sum()
    }
}
