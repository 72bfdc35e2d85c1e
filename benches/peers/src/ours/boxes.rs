//! The library's pair finder on given boxes.
//!
//! The culler takes poses and fits its own volumes with a margin for rounding; engines are handed boxes. What they share is
//! the seam between [`PairFinder`] and [`FirstTest`](sdop::broad_phase::FirstTest): a finder sorts balls and hands
//! candidates to whatever test it is given. Here the balls are cubes about the boxes, and the test is [`cubes`]'s.

mod cubes;

use sdop::bodies::Places;
use sdop::broad_phase::{Grid, PairFinder, Reorder};
use sdop::simd::{Tier, dispatch};
use sdop::threads::Threads;

use self::cubes::{Find, Found, Gap, Test, cube_about};
use sdop::lab::measure::contestant::Contestant;

use crate::boxes::{Frame, Slabs};
use crate::entry::Setup;

/// Bodies whose cubes one thread makes at once.
const CUBES: usize = 4096;
/// Bodies whose boxes are copied before any is looked at: each is a cache miss, and so more of them are on their way at once.
const TOGETHER: usize = 64;
/// Ranges of the work per thread: a thread that is done early takes another one.
const SHARES: usize = 4;

/// Boxes in a grid.
pub struct Boxes {
    tier: Tier,
    pool: Threads,
    finder: PairFinder,
    places: Places,
    /// The body in each place.
    names: Vec<u32>,
    order: Vec<u32>,
    /// Cubes about the boxes by place: centre and half side.
    cubes: Vec<[f32; 4]>,
    gap: Gap,
    shares: Vec<Found>,
}

impl Boxes {
    /// A grid of the first frame's boxes.
    pub fn new(setup: &Setup<'_>) -> miette::Result<Self> {
        let places = Places::as_given(&setup.first.bodies);
        let shares = match setup.threads {
            1 => 1,
            threads => SHARES * threads,
        };
        let mut boxes = Self {
            tier: Tier::detect(),
            pool: Threads::new(setup.threads)?,
            finder: PairFinder::Grid(Grid::default()),
            names: places.body.clone(),
            order: Vec::new(),
            cubes: vec![[0.0; 4]; places.len()],
            gap: Gap::default(),
            shares: vec![Found::default(); shares],
            places,
        };
        boxes.update(&setup.first.boxes);
        Ok(boxes)
    }

    fn update(&mut self, boxes: &[Slabs]) {
        let names = &self.names;
        self.gap = Gap::default();
        let frame_gap = &self.gap;
        self.pool.pieces(&mut self.cubes, CUBES, |start, piece| {
            let mut most = 0.0;
            let mut near = [Slabs::default(); TOGETHER];
            for (cubes, names) in piece
                .chunks_mut(TOGETHER)
                .zip(names[start..].chunks(TOGETHER))
            {
                for (near, &body) in near.iter_mut().zip(names) {
                    *near = boxes[body as usize];
                }
                for (cube, slabs) in cubes.iter_mut().zip(&near) {
                    let gap;
                    (*cube, gap) = cube_about(slabs);
                    most = if gap > most { gap } else { most };
                }
            }
            frame_gap.raise(most);
        });
    }
}

impl Contestant<Frame> for Boxes {
    fn frame(&mut self, frame: &Frame) {
        let (finder, order) = (&mut self.finder, &mut self.order);
        if finder.reorder(&self.places, &self.cubes, &self.names, order) != Reorder::None {
            self.names.copy_from_slice(order);
        }
        self.update(&frame.boxes);
        let (tier, pool) = (self.tier, &self.pool);
        self.finder
            .arrange(pool.executor(tier), &self.places, &self.cubes, &self.names);
        let (finder, parts, count) = (&self.finder, self.finder.parts(), self.shares.len());
        let gap = self.gap.twice();
        pool.each(&mut self.shares, |index, found| {
            let test = Test::new(finder.slots(), &frame.boxes, gap, found);
            let parts = index * parts / count..(index + 1) * parts / count;
            let find = Find {
                finder,
                parts,
                test,
            };
            dispatch(tier, find);
        });
        let candidates = self.shares.iter().map(Found::candidates).sum();
        self.finder.observe(candidates);
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.shares.iter().flat_map(Found::pairs).collect()
    }
}
