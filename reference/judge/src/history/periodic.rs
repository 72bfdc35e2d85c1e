//! Histories in space that repeats: the bodies of a drawn history, each moved by whole periods, in
//! the periodic worlds. Truth uses the exact periods.
//!
//! The slots of images depend on what has come and gone, and which of two bodies is the first one
//! decides a close case of a refined test. Therefore a world with such a test may lack pairs that a
//! newly built one reports, as long as none is required; with spheres alone, lists are equal.

use sdop_reference::exact::period::{meeting_images, separation};
use sdop_reference::exact::{ordop, sphere};
use sdop_reference::{Body as JudgedBody, Overlap, Pose};

use super::draw::{MARGINS, SMALL_MARGINS};
use super::judge::{Life, Truth, grown_shape, with_margins};
use super::places::place;
use super::state::{NumberedPair, Pairs, State, in_order};
use super::worlds::Properties;
use super::{Change, ChangeKind, History, HistoryError, WorldKind};
use crate::configuration::Mode;
use crate::configuration::coverage::ListLedger;
use crate::configuration::cullers::{box_culler, culler, finder};
use crate::configuration::world_kind::PERIODIC;
use crate::truth::reference_shapes::{InvalidInput, Shapes};
use sdop::boxes::BoxBody;
use sdop::periodic::{PeriodicBox, PeriodicBoxes};
use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet};
use sdop::world::Body;
use sdop::world::PeriodicWorld;

/// The least period that is drawn: more than twice the widest box, or ball with its margin.
const LEAST_OF_BOXES: f64 = 17.0;
const LEAST_OF_MESHES: f64 = 9.0;

/// Translations of meshes are multiples of this step before periods are added, which are multiples
/// of 2⁻⁴⁹. Meshes that may meet are less than 16 apart, so that f64 holds the difference.
const STEP: f64 = 1.0 / (1_u64 << 46) as f64;

/// A history in space that repeats.
#[derive(Clone, Debug)]
pub struct Repeated<B> {
    /// The period of each axis that has one.
    pub periods: [Option<f64>; 3],
    /// The bodies, anywhere, and their changes.
    pub history: History<B>,
}

impl Repeated<PeriodicBox> {
    /// A history of given boxes, each of them moved by periods that `below` draws.
    pub fn boxes(history: &History<BoxBody>, below: &mut impl FnMut(u32) -> u32) -> Self {
        Self::of(history, LEAST_OF_BOXES, below, |body, moved| PeriodicBox {
            min: moved(body.bounds.min.map(f64::from)),
            max: moved(body.bounds.max.map(f64::from)),
            motion: body.motion,
            groups: body.groups,
        })
    }
}

impl Repeated<Body> {
    /// A history of meshes in one region and with small margins, each of them moved by periods that
    /// `below` draws.
    pub fn meshes(
        shapes: &Shapes,
        history: &History<Body>,
        below: &mut impl FnMut(u32) -> u32,
    ) -> Self {
        Self::of(history, LEAST_OF_MESHES, below, |body, moved| {
            let (_, within) = place(&shapes.built, body);
            Body {
                translation: moved(within.map(|x| (x / STEP).round() * STEP)),
                margin: body.margin.min(MARGINS[SMALL_MARGINS - 1]),
                ..*body
            }
        })
    }
}

impl<B> Repeated<B> {
    fn of<A>(
        history: &History<A>,
        least: f64,
        below: &mut impl FnMut(u32) -> u32,
        place: impl Fn(&A, &dyn Fn([f64; 3]) -> [f64; 3]) -> B,
    ) -> Self {
        let axes = 1 + below(7);
        let periods = [0, 1, 2].map(|axis| (axes >> axis & 1 == 1).then(|| period(least, below)));
        // Borders are anywhere among the bodies.
        let offset = [(); 3].map(|()| f64::from(below(1 << 16)) / f64::from(1 << 11));
        let moved = |body: &A, way: [i32; 3]| {
            let moved = |at: [f64; 3]| {
                [0, 1, 2].map(|axis| {
                    let period = periods[axis].unwrap_or(0.0);
                    f64::from(way[axis]).mul_add(period, at[axis] + offset[axis])
                })
            };
            place(body, &moved)
        };
        let (mut ways, mut saved): (Vec<[i32; 3]>, _) = (Vec::new(), Vec::new());
        let mut first = Vec::new();
        for body in &history.first {
            ways.push(draw_way(below));
            first.push(moved(body, ways[ways.len() - 1]));
        }
        let mut change = |(kind, change): &(ChangeKind, Change<A>)| {
            let change = match change {
                Change::Insert(body) => {
                    ways.push(draw_way(below));
                    Change::Insert(moved(body, ways[ways.len() - 1]))
                }
                Change::Set(number, body) => {
                    if *kind == ChangeKind::Moved {
                        ways[*number] = draw_way(below);
                    }
                    Change::Set(*number, moved(body, ways[*number]))
                }
                Change::Remove(number) => Change::Remove(*number),
                Change::Exclude(pair, is_excluded) => Change::Exclude(*pair, *is_excluded),
                Change::Interest(numbers) => Change::Interest(numbers.clone()),
                Change::Save => {
                    saved.clone_from(&ways);
                    Change::Save
                }
                Change::Restore => {
                    ways[..saved.len()].copy_from_slice(&saved);
                    Change::Restore
                }
                Change::Detour(kind) => Change::Detour(*kind),
            };
            (*kind, change)
        };
        let frames = history.frames.iter();
        let frames = frames.map(|frame| frame.iter().map(&mut change).collect());
        Self { periods, history: History { first, frames: frames.collect() } }
    }
}

/// A whole period, or one with all bits of an f64.
fn period(least: f64, below: &mut impl FnMut(u32) -> u32) -> f64 {
    let whole = f64::from(below(8));
    let parts = below(2) * 4;
    let fraction =
        (0..parts).fold(0.0, |sum, _| (sum + f64::from(below(1 << 14))) / f64::from(1 << 14));
    least + whole + fraction
}

/// By how many periods a body is moved: few, or many.
fn draw_way(below: &mut impl FnMut(u32) -> u32) -> [i32; 3] {
    [(); 3].map(|()| match below(8) {
        0 => below(1 << 21) as i32 - (1 << 20),
        _ => below(5) as i32 - 2,
    })
}

/// A history of boxes in these modes.
///
/// # Errors
/// Threads that the system refuses, invalid boxes.
pub fn judge_periodic_boxes(
    repeated: &Repeated<PeriodicBox>,
    modes: &[Mode],
) -> Result<ListLedger, HistoryError> {
    let Repeated { periods, history } = repeated;
    let states = State::all(history)?;
    let meeting = |a: &PeriodicBox, b: &PeriodicBox| {
        Ok(meeting_images([a.min, a.max], [b.min, b.max], *periods))
    };
    let truth = Truth::exact(required(&states, meeting)?);
    let mut ledger = ListLedger::default();
    for (number, &mode) in modes.iter().enumerate() {
        let make =
            |turn| Ok(PeriodicBoxes::with(&box_culler(finder(number + turn), mode), *periods)?);
        let life = Life::new(make, history, &states)?;
        life.live(WorldKind::PeriodicBoxes, mode, &truth, &mut ledger)?;
    }
    Ok(ledger)
}

/// A history of meshes in these modes.
///
/// # Errors
/// Threads that the system refuses, poses outside the contract.
pub fn judge_periodic_meshes(
    shapes: &Shapes,
    repeated: &Repeated<Body>,
    (k, axes): (DirectionSet, Axes),
    modes: &[Mode],
) -> Result<ListLedger, HistoryError> {
    let Repeated { periods, history } = repeated;
    let states = State::all(history)?;
    let world = |strategy, pairs, mode| {
        let way = CullSettings { strategy, pairs, k, axes, ..CullSettings::default() };
        let built = shapes.built.clone();
        PeriodicWorld::with(built, &culler(&way, mode), *periods)
    };
    let grown = with_margins(shapes)?;
    let mut ledger = ListLedger::default();
    for strategy in PERIODIC {
        let meeting = |a: &Body, b: &Body| touching_images(&grown, [a, b], *periods, strategy);
        let fresh = states.iter().map(|state| {
            let spheres = world(Strategy::Sphere, Finder::AllPairs, Mode::plain(Tier::SCALAR))?;
            state.fresh(spheres)
        });
        let truth = Truth {
            required: required(&states, meeting)?,
            fresh: fresh.collect::<Result<_, _>>()?,
            may_lack: strategy != Strategy::Sphere,
            allowed: None,
        };
        for (number, &mode) in modes.iter().enumerate() {
            let make = |turn| Ok(world(strategy, finder(number + turn), mode)?);
            let life = Life::new(make, history, &states)?;
            life.live(WorldKind::PeriodicMeshes(strategy), mode, &truth, &mut ledger)?;
        }
    }
    Ok(ledger)
}

/// The pairs that a world must report after each frame: of each two bodies that may collide, the
/// images that meet.
fn required<B: Properties>(
    states: &[State<B>],
    meeting: impl Fn(&B, &B) -> Result<Vec<[i64; 3]>, InvalidInput>,
) -> Result<Vec<Pairs>, InvalidInput> {
    let required = |state: &State<B>| {
        let (numbers, parts) = state.parts(|body| *body.to_owned().groups());
        let mut bodies: Vec<B> = state.present().map(|(_, body)| body).collect();
        let is_fixed = bodies.iter_mut().map(|body| !body.motion().is_dynamic());
        let is_fixed: Vec<bool> = is_fixed.collect();
        let mut pairs = Vec::new();
        for j in 0..bodies.len() {
            for i in 0..j {
                if is_fixed[i] && is_fixed[j] || parts([i as u32, j as u32]) {
                    continue;
                }
                let pair = [numbers[i] as u32, numbers[j] as u32];
                for image in meeting(&bodies[i], &bodies[j])? {
                    // No position is that many periods away.
                    pairs.push(NumberedPair::new(pair, None, image.map(|n| n as i32)));
                }
            }
        }
        Ok(in_order(pairs.into_iter()))
    };
    states.iter().map(required).collect()
}

/// The images in which the exact volumes of two bodies touch, grown by their margins.
fn touching_images(
    grown: &Shapes,
    [a, b]: [&Body; 2],
    periods: [Option<f64>; 3],
    strategy: Strategy,
) -> Result<Vec<[i64; 3]>, InvalidInput> {
    let judged = |body: &Body, at| {
        Ok(JudgedBody {
            shape: &grown.judged[grown_shape(body) as usize],
            pose: Pose::from_f64(body.rotation, at)?,
            dynamic: true,
        })
    };
    let first = judged(a, [0.0; 3])?;
    let reach = |body: &Body| {
        let ball = &grown.judged[grown_shape(body) as usize].ball;
        let [x, y, z] = ball.centre.map(f64::from);
        f64::from(ball.radius) + (x * x + y * y + z * z).sqrt() + 1.0e-6 // for rounding here
    };
    let reach = reach(a) + reach(b);
    let near = [-reach, reach].map(|out| a.translation.map(|x| x + out));
    let mut images = meeting_images(near, [b.translation; 2], periods);
    let mut outcome = Ok(());
    images.retain(|&image| {
        let apart = separation(a.translation, b.translation, image, periods);
        let apart = apart.unwrap_or_else(|| unreachable!("a multiple of 2⁻⁴⁹ below 16"));
        let second = judged(b, apart).unwrap_or_else(|error| {
            outcome = Err(error);
            first
        });
        sphere::overlap(&first, &second).value
            && (strategy == Strategy::Sphere
                || ordop::overlap(&first, &second, Overlap::TwoSided).value)
    });
    outcome.map(|()| images)
}
