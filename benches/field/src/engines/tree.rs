//! Trees that keep no pairs and only answer which of their boxes meet a box. Their user has to
//! write the rest, here as avian and Box3D drive theirs: leaves of moved boxes change, moved boxes
//! are searched, and each body has a list of its partners.

use miette::miette;
use sdop_judge::contestant::Contestant;

use super::events::Events;
use crate::entry::{Engine, Setup};
use crate::frame::{Frame, Slabs, meet};

/// A tree of boxes.
pub trait BoxTree {
    /// A tree of these boxes, by their numbers.
    fn new(boxes: &[Slabs]) -> Self;

    /// Changes the leaves of moved bodies; `boxes` are all leaves.
    fn update(&mut self, moved: &[u32], boxes: &[Slabs]);

    /// Calls `found` with each body whose leaf meets a box.
    fn search(&self, slabs: &Slabs, found: impl FnMut(u32));

    /// Makes the tree fast again after the moved bodies were searched.
    fn tidy(&mut self, moved: &[u32], bodies: usize);
}

/// A tree with the pairs of its bodies.
pub struct TreeEngine<T> {
    tree: T,
    margin: f32,
    /// The box of each leaf.
    boxes: Vec<Slabs>,
    moved: Vec<u32>,
    is_moved: Vec<bool>,
    partners: Vec<Vec<u32>>,
    events: Events,
}

/// An engine whose leaves are larger than their boxes by a margin.
pub fn new<T: BoxTree + 'static>(setup: &Setup<'_>, margin: f32) -> miette::Result<Engine> {
    let boxes: Vec<Slabs> = setup.first.boxes.iter().map(|slabs| grown(slabs, margin)).collect();
    if boxes.iter().flatten().flatten().any(|end| !end.is_finite()) {
        return Err(miette!("a box is not finite"));
    }
    let mut engine = TreeEngine {
        tree: T::new(&boxes),
        margin,
        moved: (0..boxes.len() as u32).collect(),
        is_moved: vec![true; boxes.len()],
        partners: vec![Vec::new(); boxes.len()],
        boxes,
        events: Events::default(),
    };
    engine.find();
    Ok(Box::new(engine))
}

impl<T: BoxTree> TreeEngine<T> {
    /// Takes over the boxes that leave their leaves.
    fn take(&mut self, frame: &Frame) {
        for body in self.moved.drain(..) {
            self.is_moved[body as usize] = false;
        }
        for (body, slabs) in frame.changes() {
            let (at, leaf) = (body as usize, &self.boxes[body as usize]);
            let is_inside = (0..3)
                .all(|axis| leaf[axis][0] <= slabs[axis][0] && slabs[axis][1] <= leaf[axis][1]);
            if !is_inside || (self.margin == 0.0 && leaf != slabs) {
                self.boxes[at] = grown(slabs, self.margin);
                self.is_moved[at] = true;
                self.moved.push(body);
            }
        }
        self.tree.update(&self.moved, &self.boxes);
    }

    fn find(&mut self) {
        let Self { tree, boxes, moved, is_moved, partners, events, .. } = self;
        events.last.clear();
        for &body in &*moved {
            end(partners, events, body, |other| {
                meet(&boxes[body as usize], &boxes[other as usize])
            });
        }
        for &body in &*moved {
            tree.search(&boxes[body as usize], |other| {
                // A pair of two moved bodies is found from the lower one.
                if other > body || !is_moved[other as usize] {
                    begin(partners, events, [body, other]);
                }
            });
        }
    }
}

/// Ends the pairs of a moved body with those of its partners that it no longer meets.
fn end(partners: &mut [Vec<u32>], events: &mut Events, body: u32, meets: impl Fn(u32) -> bool) {
    let mut at = 0;
    while let Some(&other) = partners[body as usize].get(at) {
        if meets(other) {
            at += 1;
            continue;
        }
        partners[body as usize].swap_remove(at);
        let others = &mut partners[other as usize];
        if let Some(at) = others.iter().position(|&partner| partner == body) {
            others.swap_remove(at);
        }
        events.last.push(([body, other], false));
    }
}

/// Adds a pair, unless it is already in the set.
fn begin(partners: &mut [Vec<u32>], events: &mut Events, [body, other]: [u32; 2]) {
    if !partners[body as usize].contains(&other) {
        partners[body as usize].push(other);
        partners[other as usize].push(body);
        events.last.push(([body, other], true));
    }
}

impl<T: BoxTree> Contestant<Frame> for TreeEngine<T> {
    fn frame(&mut self, frame: &Frame) {
        self.take(frame);
        self.find();
        self.tree.tidy(&self.moved, self.boxes.len());
    }

    fn settle(&mut self) {
        self.events.settle();
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.events.pairs()
    }
}

fn grown(slabs: &Slabs, margin: f32) -> Slabs {
    slabs.map(|[lo, hi]| [lo - margin, hi + margin])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pair begins once, and ends on both sides.
    #[test]
    fn pairs_begin_once_and_end_on_both_sides() {
        let (mut partners, mut events) = (vec![Vec::new(); 3], Events::default());
        for pair in [[0, 1], [1, 0], [1, 2]] {
            begin(&mut partners, &mut events, pair);
        }
        assert_eq!(events.last, [([0, 1], true), ([1, 2], true)]);
        events.last.clear();
        end(&mut partners, &mut events, 1, |other| other == 2);
        end(&mut partners, &mut events, 0, |_| false);
        assert_eq!(events.last, [([1, 0], false)]);
    }
}
