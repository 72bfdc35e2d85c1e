//! Long-lived worlds as contestants: one world has all frames of a case.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::frames::LivingWorld;
use crate::case::Frame;
use crate::contestant::{BodyPart, Contestant, Filter, WorldBox};
use crate::history::{HistoryError, JudgedWorld};
use sdop::bodies::Bodies;
use sdop::world::BodyId;

/// The bodies of the last frame: their ids and what they are; none for those that are to come.
type Held<W> = Vec<Option<(BodyId, <W as JudgedWorld>::Body)>>;

/// A world's saved state, its bodies and the excluded pairs.
type Saved<W> = (<W as JudgedWorld>::Saved, Held<W>, BTreeSet<[u32; 2]>);

/// A long-lived world as a contestant. What a world refuses is a panic, which the judge reports.
pub struct Living<W: LivingWorld> {
    world: W,
    /// What the coming frame brings.
    frame: Frame,
    held: Held<W>,
    excluded: BTreeSet<[u32; 2]>,
    pairs: Vec<[u32; 2]>,
    saved: Option<Saved<W>>,
}

impl<W: LivingWorld> Living<W> {
    /// A world without bodies.
    pub fn new(world: W) -> Self {
        let (held, pairs, excluded) = (Vec::new(), Vec::new(), BTreeSet::new());
        Self { world, frame: Frame::default(), held, excluded, pairs, saved: None }
    }

    /// Brings the bodies up to date, and finds the pairs.
    fn cull(&mut self) -> Result<(), HistoryError> {
        self.held.resize(self.frame.bodies.len(), None);
        for i in 0..self.held.len() {
            let body = self.world.body(&self.frame, i)?;
            let id = match self.held[i] {
                // What stays is not set again: a world has to know it.
                Some((id, from)) if from == body => id,
                Some((id, from)) => self.world.change(id, from, body).map(|()| id)?,
                None => self.world.insert(body)?,
            };
            self.held[i] = Some((id, body));
        }
        self.exclude()?;
        let ids = self.held.iter().flatten().map(|one| one.0);
        let slots = ids.clone().map(BodyId::slot).max().map_or(0, |last| last + 1);
        let mut numbers = vec![0; slots];
        ids.zip(0..).for_each(|(id, number): (BodyId, u32)| numbers[id.slot()] = number);
        let pairs = self.world.cull()?.into_iter().filter(|pair| pair.parts.is_none());
        let pairs = pairs.map(|pair| pair.bodies.map(|id| numbers[id.slot()]));
        self.pairs = pairs.map(|[i, j]| [i.min(j), i.max(j)]).collect();
        Ok(())
    }

    /// Excludes the pairs that the filter excludes, and includes the others again.
    fn exclude(&mut self) -> Result<(), HistoryError> {
        let filter = self.frame.filter.iter().flat_map(|filter| &filter.excluded);
        let wanted: BTreeSet<[u32; 2]> = filter.copied().collect();
        for pair in wanted.symmetric_difference(&self.excluded) {
            let [Some((a, _)), Some((b, _))] = pair.map(|body| self.held[body as usize]) else {
                continue;
            };
            self.world.exclude([a, b], wanted.contains(pair))?;
        }
        self.excluded = wanted;
        Ok(())
    }
}

fn done<T>(result: Result<T, HistoryError>) -> T {
    result.unwrap_or_else(|error| panic!("{error}"))
}

impl<W: LivingWorld> Contestant for Living<W> {
    fn frame(&mut self, bodies: &Bodies) {
        self.frame.bodies.clone_from(bodies);
        done(self.cull());
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.clone()
    }

    fn boxes(&mut self, boxes: &[WorldBox]) {
        self.frame.boxes = boxes.to_vec();
    }

    fn change(&mut self, _: &Bodies, was: &[Option<u32>]) -> bool {
        let stays = |was: &Option<u32>| was.and_then(|number| self.held[number as usize]);
        let now: Held<W> = was.iter().map(stays).collect();
        let kept: HashSet<BodyId> = now.iter().flatten().map(|one| one.0).collect();
        for (id, _) in self.held.iter().flatten().filter(|one| !kept.contains(&one.0)) {
            done(self.world.remove(*id));
        }
        let numbers: HashMap<u32, u32> =
            was.iter().zip(0..).filter_map(|(was, now)| Some(((*was)?, now))).collect();
        let renumbered = |pair: &[u32; 2]| {
            let [i, j] = pair.map(|body| numbers.get(&body).copied());
            Some([i?.min(j?), i?.max(j?)])
        };
        self.excluded = self.excluded.iter().filter_map(renumbered).collect();
        self.held = now;
        true
    }

    fn filter(&mut self, filter: &Filter) -> bool {
        self.frame.filter = Some(filter.clone());
        true
    }

    fn margins(&mut self, margins: &[f32]) -> bool {
        self.frame.margins = Some(margins.to_vec());
        self.world.has_margins()
    }

    fn body_parts(&mut self, parts: &[Vec<BodyPart>]) -> bool {
        self.frame.parts = Some(parts.to_vec());
        self.world.has_parts()
    }

    fn periods(&mut self, periods: [Option<f64>; 3]) -> bool {
        done(self.world.set_periods(periods))
    }

    fn save(&mut self) -> bool {
        let state = self.world.save();
        self.saved = Some((state, self.held.clone(), self.excluded.clone()));
        true
    }

    fn restore(&mut self) -> bool {
        let Some((state, held, excluded)) = &self.saved else {
            return false;
        };
        (self.held, self.excluded) = (held.clone(), excluded.clone());
        done(self.world.restore(state));
        true
    }
}
