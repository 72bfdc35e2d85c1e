//! T = Nu·Cu + F + Nv·Cv, frame by frame: a run's counters at prices calibrated for its shapes and
//! the level of its working set.

use super::{ShownRun, ShownStrategy};
use crate::cost::calibrate::{Calibration, Effort};
use crate::cost::predict::Prices;
use crate::effects::{EffectsSpec, Velocities};
use crate::measure::counts::{Counts, Volume};
use crate::measure::variant::Variant;
use crate::scene::{FineTranslations, Scene};
use crate::simulate::SimulationError;
use sdop::settings::{CullSettings, Strategy};
use sdop::simd::Tier;
use sdop_judge::record::VolumeLine;

/// Enough for a picture: one round, in a second for hundreds of bodies.
const EFFORT: Effort = Effort { turns: 1, builds: 1 };

/// Seconds per frame by term, and once.
#[derive(Clone, Debug, PartialEq)]
pub struct TermCourse {
    /// Co.
    pub construct: f64,
    /// Nu·Cu, F, Nv·Cv of each frame.
    pub frames: Vec<[f64; 3]>,
}

/// Calibrates the prices of the volumes that `culled` tested, on this machine, for warm frames.
///
/// # Errors
/// The settings can't be carried out.
pub fn prices(
    show: &ShownRun,
    culled: &ShownStrategy,
    tier: Tier,
) -> Result<Option<Prices>, SimulationError> {
    let culls = |cull: &CullSettings| cull.strategy != Strategy::None;
    let Some(cull) = culled.settings.clone().filter(culls) else {
        return Ok(None);
    };
    let mut bodies = show.bodies.clone();
    if let Some(first) = show.frames.first() {
        first.pose(&mut bodies);
    }
    let variant = Variant::of(culled.name.clone(), cull.clone());
    let at_rest = vec![[0.0; 3]; bodies.len()];
    let scene = Scene {
        name: show.header.scene.clone(),
        seed: show.header.seed,
        frames: 1,
        dt: 0.0,
        side: show.header.side,
        shapes: show.shapes.clone(),
        velocities: Velocities { linear: at_rest.clone(), angular: at_rest },
        bodies,
        fine: FineTranslations::default(),
        share: None,
        effects: EffectsSpec::default(),
        cull,
        construct_seconds: 0.0,
    };
    let mut calibration = Calibration::new(&scene, &[variant], tier, EFFORT)?;
    let [warm, _cold] = calibration.round()?.prices;
    Ok(warm.into_iter().next())
}

impl TermCourse {
    /// T by its terms. `None` if a counted volume has no price.
    pub fn predict(show: &ShownRun, culled: &ShownStrategy, prices: &Prices) -> Option<Self> {
        let counters = culled.counters.as_ref()?;
        let bodies = show.bodies.len();
        let mut course = Self { construct: 0.0, frames: Vec::new() };
        for lines in counters {
            let terms = prices.predict(&counts(lines)?, 1, bodies);
            course.construct = terms.iter().map(|term| term.construct).sum();
            course.frames.push([
                terms.iter().map(|term| term.update).sum(),
                terms.iter().map(|term| term.finding).sum(),
                terms.iter().map(|term| term.test).sum(),
            ]);
        }
        Some(course)
    }
}

/// The counters of a frame. `None` if it has a volume that this program lacks.
fn counts(lines: &[VolumeLine]) -> Option<Counts> {
    let mut counts = Counts::default();
    for VolumeLine { volume, counters } in lines {
        let place = match volume.parse().ok()? {
            Volume::Sphere => &mut counts.culler.sphere,
            Volume::OrDop => &mut counts.culler.ordop,
            Volume::Aabb => &mut counts.culler.aabb,
            Volume::KDop => &mut counts.culler.kdop,
            Volume::Obb => &mut counts.culler.obb,
            Volume::Hull => &mut counts.hulls,
        };
        *place = *counters;
    }
    Some(counts)
}
