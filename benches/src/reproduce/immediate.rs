//! The paper's sequential algorithm to the letter: each pair whose spheres overlap goes to its
//! or-DOP test at once.
//!
//! The culler's sequential strategy passes on blocks of 256 pairs. With 50 or 150 objects, one
//! block is the whole list, so it cannot show whether testing at once beats listing first, as the
//! paper claims. Here a pair loop in scalar code passes pairs on one by one, sixteen at a time, or
//! all at the end, and differs in nothing else.

use super::plan::PaperScene;
use crate::measure::turns::{Regime, Turns, median, next_turn, turn_frames};
use crate::posed_ordops::PosedOrDops;
use crate::scene::Scene;
use crate::simulate::{SimulationError, Trajectory};
use sdop::bodies::Bodies;
use sdop::choice::choices;
use sdop::pairs::PairList;
use sdop::settings::Overlap;
use sdop::simd::Tier;
use sdop::update::ShapeFrame;
use sdop::volume::Shape;
use sdop_judge::contestant::Contestant;

/// Frames of each measurement.
const FRAMES: u32 = 24;

choices! {
    /// When a pair whose spheres overlap is tested by its or-DOPs, and how.
    Handing, "way to hand pairs on", {
        /// One pair at a time, scalar code.
        EachPair = "each pair at once, scalar",
        /// When all pairs are listed, the same scalar code.
        ScalarList = "list, scalar",
        /// When sixteen are listed, in the widest tier.
        Sixteen = "blocks of 16, SIMD",
        /// When all pairs are listed, in the widest tier.
        List = "list, SIMD",
    }
}

impl Handing {
    /// Pairs that are handed on together.
    const fn block(self) -> usize {
        match self {
            Self::EachPair => 1,
            Self::Sixteen => 16,
            Self::ScalarList | Self::List => usize::MAX,
        }
    }

    /// The tier of the or-DOP test.
    fn tier(self, widest: Tier) -> Tier {
        match self {
            Self::EachPair | Self::ScalarList => Tier::SCALAR,
            Self::Sixteen | Self::List => widest,
        }
    }
}

/// What each way takes in one scene with one seed.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct HandingTimes {
    /// The scene.
    pub scene: PaperScene,
    /// The seed.
    pub seed: u64,
    /// Median seconds of a warm frame, in the order of [`Handing::ALL`].
    pub seconds: Vec<f64>,
}

/// Sphere tests pair by pair; hits are handed on as the way says.
pub struct PairLoop<'a> {
    shapes: &'a [Shape],
    frames: Vec<ShapeFrame>,
    overlap: Overlap,
    handing: Handing,
    tier: Tier,
    waiting: PairList,
    pairs: PairList,
}

impl<'a> PairLoop<'a> {
    /// A loop over the scene's bodies.
    #[must_use]
    pub fn new(scene: &'a Scene, handing: Handing, widest: Tier) -> Self {
        let frame = |shape: &Shape| ShapeFrame::new(shape, &shape.ordop.basis);
        Self {
            shapes: &scene.shapes,
            frames: scene.shapes.iter().map(frame).collect(),
            overlap: scene.cull.overlap,
            handing,
            tier: handing.tier(widest),
            waiting: PairList::default(),
            pairs: PairList::default(),
        }
    }
}

impl Contestant for PairLoop<'_> {
    fn frame(&mut self, bodies: &Bodies) {
        let sphere = |body: usize| {
            let frame = &self.frames[bodies.shape[body] as usize];
            frame.sphere(bodies.rotation[body], bodies.translation[body])
        };
        let spheres: Vec<[f32; 4]> = (0..bodies.len()).map(sphere).collect();
        let ordops = self.shapes.iter().map(|shape| (shape, &shape.ordop));
        let posed = PosedOrDops::new(ordops, bodies, self.tier);
        let columns = posed.columns(self.overlap);
        let (waiting, pairs) = (&mut self.waiting, &mut self.pairs);
        pairs.clear();
        let mut hand_on = |waiting: &mut PairList| {
            columns.test_pairs(self.tier, waiting.first(), waiting.second(), pairs);
            waiting.clear();
        };
        for i in 0..bodies.len() {
            for j in i + 1..bodies.len() {
                if (bodies.dynamic[i] || bodies.dynamic[j]) && overlap(spheres[i], spheres[j]) {
                    waiting.push(i as u32, j as u32);
                    if waiting.len() >= self.handing.block() {
                        hand_on(waiting);
                    }
                }
            }
        }
        hand_on(waiting);
    }

    fn pairs(&self) -> Vec<[u32; 2]> {
        self.pairs.iter().collect()
    }
}

/// The culler's sphere test: by differences, then squares, rejected by a strict comparison.
fn overlap(a: [f32; 4], b: [f32; 4]) -> bool {
    let (dx, dy, dz, s) = (a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] + b[3]);
    let apart = dx * dx + dy * dy + dz * dz > s * s;
    !apart
}

/// Times every way on the first frames of a scene, in turns.
///
/// # Errors
/// Effects that can't be simulated, a body that leaves the contract.
pub fn measure(
    scene: &Scene,
    name: PaperScene,
    widest: Tier,
) -> Result<HandingTimes, SimulationError> {
    let way = |&handing: &Handing| PairLoop::new(scene, handing, widest);
    let mut loops: Vec<PairLoop<'_>> = Handing::ALL.iter().map(way).collect();
    let mut seconds = vec![Vec::new(); loops.len()];
    let mut trajectory = Trajectory::new(scene)?.with_frames(FRAMES);
    let mut turns = Turns::from_stream(2);
    let frames = turn_frames(scene.bodies.len());
    loop {
        let poses = next_turn(&mut trajectory, frames)?;
        if poses.is_empty() {
            break;
        }
        turns.round(&mut loops, &poses, |timed| {
            if timed.regime == Regime::Warm {
                seconds[timed.number].push(timed.seconds);
            }
        });
    }
    Ok(HandingTimes {
        scene: name,
        seed: scene.seed,
        seconds: seconds.into_iter().map(median).collect(),
    })
}
