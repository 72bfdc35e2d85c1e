//! The library's pair finder on given boxes: the grid finds candidates, cubes sift them, the boxes decide.
//!
//! The culler itself takes poses and fits its own volumes with a margin for rounding. Engines are handed boxes, so its
//! finder is put together here with a test of them. Cubes about the boxes are what the grid keeps at hand, four numbers a
//! body; they are widened by more than f32 rounds, so no pair of boxes is lost, and the boxes are compared as they are.

use std::ops::Range;

use sdop::broad_phase::{
    BLOCK_BODIES, Block, FirstTest, Grid, MOST_CANDIDATES, PairFinder, Reorder, Slots, columns,
};
use sdop::crew::Crew;
use sdop::places::Places;
use sdop::simd::{Kernel, LANES, Lanes, Level, MAX_WIDTH, dispatch};

use crate::boxes::{Frame, Slabs, meet};
use crate::peer::{Peer, Setup};

/// Slots of a run that are tested at once.
const PIECE: usize = MOST_CANDIDATES;
/// Bodies whose cubes one thread makes at once.
const CUBES: usize = 4096;
/// Shares of the work a thread: whoever is done early takes another's.
const SHARES: usize = 4;

/// Boxes in a grid.
pub struct Boxes {
    level: Level,
    crew: Crew,
    finder: PairFinder,
    places: Places,
    /// The body in each place.
    names: Vec<u32>,
    order: Vec<u32>,
    /// Cubes about the boxes by place: centre and half side.
    cubes: Vec<[f32; 4]>,
    /// The boxes in the grid's order.
    slabs: Vec<Slabs>,
    shares: Vec<Share>,
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
            level: Level::detect(),
            crew: Crew::new(setup.threads)?,
            finder: PairFinder::Grid(Grid::default()),
            names: places.body.clone(),
            order: Vec::new(),
            cubes: vec![[0.0; 4]; places.len()],
            slabs: vec![Slabs::default(); places.len()],
            shares: vec![Share::default(); shares],
            places,
        };
        boxes.update(&setup.first.boxes);
        Ok(boxes)
    }

    fn update(&mut self, boxes: &[Slabs]) {
        let (names, cubes) = (&self.names, &mut self.cubes);
        self.crew.pieces(cubes, CUBES, |start, piece| {
            for (cube, &body) in piece.iter_mut().zip(&names[start..]) {
                *cube = cube_about(&boxes[body as usize]);
            }
        });
    }
}

impl Peer for Boxes {
    fn frame(&mut self, frame: &Frame) {
        let (finder, order) = (&mut self.finder, &mut self.order);
        if finder.reorder(&self.places, &self.cubes, &self.names, order) != Reorder::None {
            self.names.copy_from_slice(order);
        }
        self.update(&frame.boxes);
        let finder = &mut self.finder;
        finder.arrange(
            self.level,
            &self.crew,
            &self.places,
            &self.cubes,
            &self.names,
        );
        let names = &finder.slots().names;
        self.crew.pieces(&mut self.slabs, CUBES, |start, piece| {
            for (slabs, &body) in piece.iter_mut().zip(&names[start..]) {
                *slabs = frame.boxes[body as usize];
            }
        });
        let (finder, parts, count) = (&self.finder, self.finder.parts(), self.shares.len());
        self.crew.each(&mut self.shares, |index, share| {
            share.clear();
            let test = Test {
                slots: finder.slots(),
                slabs: &self.slabs,
                share,
                hits: [0; PIECE + MAX_WIDTH],
            };
            let parts = index * parts / count..(index + 1) * parts / count;
            let find = Find {
                finder,
                parts,
                test,
            };
            dispatch(self.level, find);
        });
        let candidates = self.shares.iter().map(|share| share.candidates).sum();
        self.finder.observe(candidates);
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.shares.iter().flat_map(Share::pairs).collect()
    }
}

/// How much wider a cube is than its box: the differences below round by 2⁻²⁴ each, those of the test by as much.
const WIDER: f32 = 1.0 + 1.0 / (1 << 20) as f32;
const FLOOR: f32 = 1e-30;

/// A cube about a box, wider than it by more than this and comparing cubes can round.
fn cube_about(slabs: &Slabs) -> [f32; 4] {
    let (mut cube, mut half) = ([0.0; 4], 0.0_f32);
    for (axis, &[lo, hi]) in slabs.iter().enumerate() {
        cube[axis] = 0.5 * (lo + hi);
        half = half.max(hi - cube[axis]).max(cube[axis] - lo);
    }
    cube[3] = half * WIDER + FLOOR;
    cube
}

/// The pairs of one share of the work, as two columns.
#[derive(Clone, Debug, Default)]
struct Share {
    first: Vec<u32>,
    second: Vec<u32>,
    len: usize,
    candidates: u64,
}

impl Share {
    fn clear(&mut self) {
        (self.len, self.candidates) = (0, 0);
    }

    fn pairs(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let columns = self.first.iter().zip(&self.second);
        columns.take(self.len).map(|(&i, &j)| [i, j])
    }

    /// Both columns behind the last pair, with room for `more`.
    #[inline(always)]
    fn room(&mut self, more: usize) -> (&mut [u32], &mut [u32]) {
        let needed = self.len + more;
        if needed > self.first.len() {
            let size = needed.next_power_of_two();
            self.first.resize(size, 0);
            self.second.resize(size, 0);
        }
        (&mut self.first[self.len..], &mut self.second[self.len..])
    }
}

struct Find<'a> {
    finder: &'a PairFinder,
    parts: Range<usize>,
    test: Test<'a>,
}

impl Kernel for Find<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(mut self, l: L) {
        self.finder.find(l, self.parts, &mut self.test);
    }
}

struct Test<'a> {
    slots: &'a Slots,
    slabs: &'a [Slabs],
    share: &'a mut Share,
    hits: [u32; PIECE + MAX_WIDTH],
}

impl FirstTest for Test<'_> {
    #[inline(always)]
    fn run<L: Lanes>(&mut self, l: L, i: usize, run: Range<usize>) {
        self.share.candidates += run.len() as u64;
        let one = self.slots.ball(i).map(|number| l.splat(number));
        for first in run.clone().step_by(PIECE) {
            let (end, mut found) = (run.end.min(first + PIECE), 0);
            for start in (first..end).step_by(L::WIDTH) {
                let other = self.slots.load(l, start);
                let hit = touching(l, one, other, end - start);
                let slot = l.add_u32(l.splat_u32(start as u32), l.load_u32(&LANES));
                l.compress(hit, slot, &mut self.hits[found..]);
                found += hit.count_ones() as usize;
            }
            self.list(found, |slot| (i, slot as usize));
        }
    }

    #[inline(always)]
    fn block<L: Lanes>(&mut self, l: L, block: &Block) {
        let (codes, count) = (block.padded_codes(), block.codes().len());
        self.share.candidates += count as u64;
        let (first, mut found) = (block.first(), 0);
        let ours = columns(l, &self.slots.balls[first..][..BLOCK_BODIES]);
        for start in (0..count).step_by(L::WIDTH) {
            let code = l.load_u32(&codes[start..]);
            let (_, lane) = l.split_u32(code);
            let [x, y, z, half] = &ours;
            let one = [
                l.lookup_16(x, lane),
                l.lookup_16(y, lane),
                l.lookup_16(z, lane),
                l.lookup_16(half, lane),
            ];
            let other = l.gather_quads(&self.slots.balls, &codes[start..]);
            let hit = touching(l, one, other, count - start);
            l.compress(hit, code, &mut self.hits[found..]);
            found += hit.count_ones() as usize;
        }
        self.list(found, |code| {
            (first + (code & 15) as usize, (code >> 4) as usize)
        });
    }
}

impl Test<'_> {
    /// Lists the first `found` hits whose boxes meet, by body.
    #[inline(always)]
    fn list(&mut self, found: usize, slots: impl Fn(u32) -> (usize, usize)) {
        let (first, second) = self.share.room(found);
        let (mut kept, names) = (0, &self.slots.names);
        for &hit in &self.hits[..found] {
            let (i, j) = slots(hit);
            (first[kept], second[kept]) = (names[i], names[j]);
            kept += usize::from(meet(&self.slabs[i], &self.slabs[j]));
        }
        self.share.len += kept;
    }
}

/// Bits of the lanes below `count` whose cubes overlap.
#[inline(always)]
fn touching<L: Lanes>(l: L, one: [L::F; 4], other: [L::F; 4], count: usize) -> u32 {
    let reach = one[3] + other[3];
    let x = l.gt(l.abs(other[0] - one[0]), reach);
    let y = l.gt(l.abs(other[1] - one[1]), reach);
    let z = l.gt(l.abs(other[2] - one[2]), reach);
    !l.bits(x | y | z) & l.bits(l.first(count))
}
