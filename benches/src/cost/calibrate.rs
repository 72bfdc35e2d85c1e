//! Calibration: Cu, Cv and Co of every volume, from seeded scenes that no prediction is compared
//! with.
//!
//! The scenes resample the one that is predicted ([`scenes`]): other numbers of bodies, other
//! boxes, other seeds, none within a tenth of it, on both sides of it in numbers and in density.
//! They take turns with the frames that they predict ([`pass`](super::pass)), so that whatever the
//! machine does meanwhile falls on both. [`explain`](mod@super::explain) then explains each stage's
//! seconds by its counts. Dividing a run's own seconds by its own counts would predict nothing.

use std::time::Instant;

use super::explain::{self, Observed, Split};
use super::predict::Prices;
use crate::effects::Velocities;
use crate::measure::counts::{Counts, Volume};
use crate::measure::culling::Culling;
use crate::measure::turns::{Regime, Times, Turns, median, next_turn};
use crate::measure::variant::Variant;
use crate::measure::waiting::Waiting;
use crate::number::Interval;
use crate::random::Stream;
use crate::scene::Scene;
use crate::simulate::{SimulationError, Trajectory};
use sdop::bodies::Bodies;
use sdop::settings::{Axes, Budget, CullSettings, Interest};
use sdop::simd::Tier;
use sdop::volume::{Ball, Shape};
use sdop_judge::contestant::Contestant;

/// Bodies of the calibration scenes, as parts of the scene's number. Near it, though none within a
/// tenth of it: a price isn't the same at any number of bodies (loops end where the CPU foresees
/// it, or don't), and its curve is straight nearby.
const SIZES: [f64; 4] = [0.82, 0.89, 1.12, 1.2];
/// Sides of the calibration scenes' boxes, as multiples of the scene's. A vector of lanes that has
/// a hit or none is a branch, and how often it is foreseen follows a curve in density and in the
/// number of pairs: so both are near the scene's, on both sides of it.
const SIDES: [f64; 2] = [0.89, 1.13];
/// Where all calibration draws start; scenes count their seeds from 1.
const SEED: u64 = 0xca11_b8a7_e000_0000;
/// The calibration scene with the most pairs, on which hits and misses are told apart.
const DENSEST: usize = (SIZES.len() - 1) * SIDES.len();

/// The number of calibration scenes.
pub const SCENES: usize = SIZES.len() * SIDES.len();

/// How long to calibrate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Effort {
    /// Turns of each calibration scene in a pass.
    pub turns: usize,
    /// How often volumes and cullers are built in a pass, to measure Co; calibration builds them in
    /// each turn.
    pub builds: usize,
}

/// The calibration scenes of a scene: every size in every box.
pub fn scenes(scene: &Scene) -> impl ExactSizeIterator<Item = Scene> + '_ {
    (0..SCENES).map(|number| {
        let (size, side) = (SIZES[number / SIDES.len()], SIDES[number % SIDES.len()]);
        let bodies = (scene.bodies.len() as f64 * size).round() as usize;
        resample(scene, bodies.max(2), side as f32, number as u64)
    })
}

/// `n` of the scene's bodies placed and set going afresh in a box of `stretch` times its side.
///
/// They keep the scene's order, in which bodies of one shape stand together: such pairs are faster
/// to test than mixed ones.
fn resample(scene: &Scene, n: usize, stretch: f32, stream: u64) -> Scene {
    let mut draws = Stream::new(SEED, stream);
    let original = &scene.bodies;
    let side = stretch * scene.side.unwrap_or_else(|| extent(scene));
    let widest = scene
        .shapes
        .iter()
        .map(|shape| shape.ball.radius)
        .fold(0.0, f32::max);
    let side = side.max(2.0 * widest);
    let (mut bodies, mut velocities) = (Bodies::default(), Velocities::default());
    for i in 0..n {
        let body = i * original.len() / n;
        let limit = 0.5 * side - scene.shapes[original.shape[body] as usize].ball.radius;
        bodies.shape.push(original.shape[body]);
        bodies.dynamic.push(original.dynamic[body]);
        bodies.rotation.push(draws.rotation());
        bodies
            .translation
            .push([(); 3].map(|()| draws.between(-limit, limit)));
        for (from, to) in [
            (&scene.velocities.linear, &mut velocities.linear),
            (&scene.velocities.angular, &mut velocities.angular),
        ] {
            let [x, y, z] = from[body];
            let length = libm::sqrtf(x * x + y * y + z * z);
            to.push(draws.vector(Interval {
                min: length,
                max: length,
            }));
        }
    }
    Scene {
        bodies,
        velocities,
        side: Some(side),
        seed: SEED,
        ..scene.clone()
    }
}

/// The side of the cube about the origin that holds all bodies.
fn extent(scene: &Scene) -> f32 {
    let bodies = &scene.bodies;
    let reach = |body: usize| {
        let [x, y, z] = bodies.translation[body].map(f32::abs);
        x.max(y).max(z) + scene.shapes[bodies.shape[body] as usize].reach
    };
    2.0 * (0..bodies.len()).map(reach).fold(0.0, f32::max)
}

/// The settings for a calibration scene of another size: the same bodies of interest, and a budget
/// for the same share of its pairs.
fn adapted(settings: &CullSettings, of: &Scene, to: &Scene) -> CullSettings {
    let [n, of_n] = [to, of].map(|scene| scene.bodies.len());
    let counterpart = |body: u32| ((body as usize * n / of_n.max(1)) as u32).min(n as u32 - 1);
    let interest = settings.interest.clone().map(|interest| match interest {
        Interest::Bodies(list) => Interest::Bodies(list.into_iter().map(counterpart).collect()),
        Interest::Cone(mut cone) => {
            cone.body = cone.body.map(counterpart);
            Interest::Cone(cone)
        }
    });
    let bodies = n as f64 / of_n.max(1) as f64;
    let stretch = match (to.side, of.side) {
        (Some(to), Some(of)) => f64::from(to / of),
        _ => 1.0,
    };
    let pairs = bodies.powi(2) / stretch.powi(3);
    let budget = settings.budget.map(|budget| match budget {
        Budget::Tests(tests) => Budget::Tests((tests as f64 * pairs) as u64),
        Budget::Microseconds(us) => Budget::Microseconds((us as f64 * pairs) as u64),
    });
    CullSettings {
        interest,
        budget,
        ..settings.clone()
    }
}

/// A variant with what never changes of it.
struct Prepared {
    variant: Variant,
    shapes: Vec<Shape>,
    /// Seconds that each of its volumes takes for all shapes, turn by turn.
    volumes: Vec<Vec<f64>>,
    observed: [Vec<Observed>; 2],
    splits: Vec<Split>,
}

/// The calibration of some variants for one scene, in the same passes as the frames that it
/// predicts.
pub struct Calibration {
    prepared: Vec<Prepared>,
    /// Which of them is spheres alone.
    spheres: usize,
    companion: Option<Variant>,
    subjects: Vec<(Scene, Trajectory)>,
    scene: Scene,
    turns: Turns,
    tier: Tier,
    effort: Effort,
}

impl Calibration {
    /// Prepares the calibration scenes. Spheres alone are calibrated in any case
    /// ([`Self::companion`]): what other variants pay beyond them has a name.
    ///
    /// # Errors
    /// Effects that can't be simulated.
    pub fn new(
        scene: &Scene,
        variants: &[Variant],
        tier: Tier,
        effort: Effort,
    ) -> Result<Self, SimulationError> {
        let spheres = Variant::spheres(&scene.cull);
        let place = variants.iter().position(|variant| *variant == spheres);
        let companion = place.is_none().then_some(spheres);
        let prepared = |variant: &Variant| Prepared {
            shapes: variant.shapes(scene),
            variant: variant.clone(),
            volumes: Vec::new(),
            observed: [Vec::new(), Vec::new()],
            splits: Vec::new(),
        };
        let subject = |scene: Scene| {
            Ok((
                scene.clone(),
                Trajectory::new(&scene)?.with_frames(u32::MAX),
            ))
        };
        Ok(Self {
            prepared: variants.iter().chain(&companion).map(prepared).collect(),
            spheres: place.unwrap_or(variants.len()),
            companion,
            subjects: scenes(scene)
                .map(subject)
                .collect::<Result<_, SimulationError>>()?,
            scene: scene.clone(),
            turns: Turns::from_stream(1),
            tier,
            effort,
        })
    }

    /// Spheres alone, where they aren't among the variants. They take their turns with the
    /// predicted frames as well: the branches and caches that a culler finds depend on who else
    /// ran.
    #[must_use]
    pub fn companion(&self) -> Option<&Variant> {
        self.companion.as_ref()
    }

    /// How often Co is measured in a pass.
    #[must_use]
    pub fn builds_of_a_pass(&self) -> usize {
        self.effort.builds
    }

    /// How many calls of [`Self::turn`] make a pass.
    #[must_use]
    pub fn turns_of_a_pass(&self) -> usize {
        SCENES * self.effort.turns
    }

    /// One turn of one calibration scene, `number` counted within the pass.
    ///
    /// # Errors
    /// Settings that can't be carried out, a body that leaves the contract.
    pub fn turn(&mut self, number: usize) -> Result<(), SimulationError> {
        // Neighbours in time are far apart in size: a drift must not look like a price. Five and
        // eight share no divisor.
        let subject = number * 5 % SCENES;
        let (scene, trajectory) = &mut self.subjects[subject];
        let poses = next_turn(trajectory, scene.bodies.len(), &mut Vec::new())?;
        let mut cullers = Vec::new();
        for prepared in &mut self.prepared {
            prepared
                .volumes
                .push(volume_seconds(&prepared.variant, &prepared.shapes));
            let variant = Variant {
                settings: adapted(&prepared.variant.settings, &self.scene, scene),
                ..prepared.variant.clone()
            };
            cullers.push(variant.culling_of(&prepared.shapes, scene, self.tier)?);
        }
        // Buffers have grown, and all others have run, before the first frame is timed; on other
        // poses, since what was just seen would not be cold.
        cullers
            .iter_mut()
            .for_each(|culler| culler.frame(&scene.bodies));
        let before: Vec<Counts> = cullers.iter().map(Culling::counts).collect();
        let mut times = vec![Times::default(); cullers.len()];
        self.turns.round(&mut cullers, &poses, |timed| {
            times[timed.number].push(&timed)
        });
        let listed = cullers[self.spheres].pairs();
        for (at, prepared) in self.prepared.iter_mut().enumerate() {
            let observed = Observed {
                bodies: scene.bodies.len(),
                frames: poses.len(),
                counts: cullers[at].counts().since(&before[at]),
                stages: Default::default(),
                construct: cullers[at].construct_seconds(),
            };
            for (&regime, all) in Regime::ALL.iter().zip(&mut prepared.observed) {
                let stages = times[at].medians(regime);
                all.push(Observed { stages, ..observed });
            }
            if subject == DENSEST {
                let kept = cullers[at].pairs();
                let split = Split::of(
                    &prepared.variant,
                    &prepared.shapes,
                    &poses[poses.len() - 1],
                    self.tier,
                    [&listed, &kept],
                );
                prepared.splits.extend(split);
            }
        }
        Ok(())
    }

    /// What the pass shows: prices for warm frames and for cold ones, of each variant. Another pass
    /// begins.
    pub fn prices(&mut self) -> [Vec<Prices>; 2] {
        let all = std::array::from_fn(|regime| {
            let spheres = explain::spheres(&self.prepared[self.spheres].observed[regime]);
            let of = |prepared: &Prepared| {
                let volumes = prepared.variant.volumes().len();
                let built = |volume: usize| {
                    median(prepared.volumes.iter().map(|turn| turn[volume]).collect())
                };
                let built: Vec<f64> = (0..volumes).map(built).collect();
                let observed = &prepared.observed[regime];
                explain::prices(
                    &prepared.variant,
                    observed,
                    &built,
                    &prepared.splits,
                    &spheres,
                )
            };
            let variants = self.prepared.len() - usize::from(self.companion.is_some());
            self.prepared[..variants].iter().map(of).collect()
        });
        for prepared in &mut self.prepared {
            prepared.observed.iter_mut().for_each(Vec::clear);
            prepared.splits.clear();
            prepared.volumes.clear();
        }
        all
    }
}

/// Builds what a variant's volume needs of one shape beyond what making the culler builds: the work
/// behind Co.
pub fn construct(volume: Volume, shape: &Shape, axes: Axes) {
    match volume {
        Volume::Sphere => drop(std::hint::black_box(Ball::smallest(&shape.vertices))),
        Volume::OrDop => drop(std::hint::black_box(
            shape.ordop_along(axes, shape.ordop.directions),
        )),
        // The culler builds these itself, from the hulls.
        Volume::Aabb | Volume::KDop | Volume::Obb | Volume::Hull => {}
    }
}

/// Seconds that each of a variant's volumes takes for all shapes, built once.
fn volume_seconds(variant: &Variant, shapes: &[Shape]) -> Vec<f64> {
    let mut waiting = Waiting::of_this_thread();
    let seconds = |volume: Volume| {
        let (waited, start) = (waiting.seconds(), Instant::now());
        shapes
            .iter()
            .for_each(|shape| construct(volume, shape, variant.settings.axes));
        let seconds = start.elapsed().as_secs_f64();
        (seconds - (waiting.seconds() - waited)).max(0.0)
    };
    variant.volumes().into_iter().map(seconds).collect()
}

/// Builds a variant's volumes of all shapes and its culler, once: the culler, and Co as measured,
/// in seconds.
///
/// # Errors
/// Settings that can't be carried out.
pub fn build(
    variant: &Variant,
    shapes: &[Shape],
    scene: &Scene,
    tier: Tier,
) -> Result<(Culling, f64), SimulationError> {
    let volumes: f64 = volume_seconds(variant, shapes).iter().sum();
    let culling = variant.culling_of(shapes, scene, tier)?;
    let seconds = volumes + culling.construct_seconds();
    Ok((culling, seconds))
}
