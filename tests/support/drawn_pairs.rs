//! Random pairs of shapes for estimators with known answers.

use sdop::bodies::Bodies;
use sdop::pairs::PairList;
use sdop::rounding::pose::{rotate, rotation};
use sdop::settings::Overlap;
use sdop::simd::Tier;
use sdop::volume::{OrDop, Shape};
use sdop_bench::hull_test::{HullGraph, PosedHull, may_touch};
use sdop_bench::posed_ordops::PosedOrDops;
use sdop_bench::random::Stream;

/// The seed of the draws; scenes count their seeds from 1.
const SEED: u64 = 0x5a3e_7000_0000_0000;

/// Random pairs of shapes: body 2n with body 2n + 1.
pub struct DrawnPairs {
    /// The bodies.
    pub bodies: Bodies,
}

impl DrawnPairs {
    /// `pairs` pairs of shapes drawn from `shapes`. The second's ball centre is uniform in the ball
    /// of `stretch` times both radii about the first's: at 1 these are exactly the pairs whose
    /// spheres overlap.
    pub fn new(shapes: &[Shape], stretch: f32, pairs: u32, stream: u64) -> Self {
        let mut draws = Stream::new(SEED, stream);
        let mut bodies = Bodies::default();
        for _ in 0..pairs {
            let [a, b] = [(); 2].map(|()| draws.index(shapes.len() as u32));
            let reach = shapes[a as usize].ball.radius + shapes[b as usize].ball.radius;
            let centre = draws.ball(stretch * reach);
            for (shape, centre) in [(a, [0.0; 3]), (b, centre)] {
                let q = draws.rotation();
                let ball = shapes[shape as usize].ball.centre;
                // The drawn position is that of the ball's centre, independent of the body's
                // origin.
                let offset = rotate(&rotation(q), ball);
                let t = [0, 1, 2].map(|axis| (f64::from(centre[axis]) - offset[axis]) as f32);
                bodies.push(shape, true, q, t);
            }
        }
        Self { bodies }
    }

    /// Its pairs.
    pub fn pairs(&self) -> impl ExactSizeIterator<Item = [u32; 2]> + '_ {
        (0..self.bodies.len() as u32 / 2).map(|pair| [2 * pair, 2 * pair + 1])
    }

    /// The pairs whose or-DOPs overlap. Each shape has one, and all have the same directions.
    pub fn ordop_hits(
        &self,
        shapes: &[Shape],
        ordops: &[OrDop],
        overlap: Overlap,
        tier: Tier,
    ) -> PairList {
        let posed = PosedOrDops::new(shapes.iter().zip(ordops), &self.bodies, tier);
        let (first, second): (Vec<u32>, Vec<u32>) = self.pairs().map(|[i, j]| (i, j)).unzip();
        let mut out = PairList::default();
        posed.columns(overlap).test_pairs(tier, &first, &second, &mut out);
        out
    }

    /// Number of pairs whose hulls meet.
    pub fn hull_hits(&self, shapes: &[Shape]) -> usize {
        let graphs: Vec<_> = shapes.iter().map(HullGraph::new).collect();
        let posed = |body| PosedHull::of(&graphs, &self.bodies, body as usize);
        self.pairs().filter(|&[i, j]| may_touch(&posed(i), &posed(j))).count()
    }
}
