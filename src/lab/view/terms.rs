//! T = Nu·Cu + F + Nv·Cv, frame by frame: a run's counters at prices calibrated for its shapes.

use super::{Culled, Show};
use crate::lab::cost::calibrate::{Effort, calibrate};
use crate::lab::cost::predict::{Prices, Volume};
use crate::lab::effects::{EffectsSpec, Velocities};
use crate::lab::record::VolumeLine;
use crate::lab::scene::Scene;
use crate::lab::simulate::SimulationError;
use crate::settings::Strategy;
use crate::simd::Tier;

/// Enough for a picture: prices within a tenth, in a fraction of a second.
const EFFORT: Effort = Effort {
    frames: 24,
    builds: 3,
};

/// Seconds per frame by term, and once.
#[derive(Clone, Debug, PartialEq)]
pub struct TermCourse {
    /// Co.
    pub construct: f64,
    /// Nu·Cu, F, Nv·Cv of each frame.
    pub frames: Vec<[f64; 3]>,
}

/// Calibrates the prices of what `culled` tested, on this machine.
///
/// # Errors
/// Settings that can't be carried out.
pub fn prices(show: &Show, culled: &Culled, tier: Tier) -> Result<Option<Prices>, SimulationError> {
    let Some(cull) = culled
        .settings
        .clone()
        .filter(|cull| cull.strategy != Strategy::None)
    else {
        return Ok(None);
    };
    let mut bodies = show.bodies.clone();
    if let Some(first) = show.frames.first() {
        first.pose(&mut bodies);
    }
    let strategy = cull.strategy;
    let scene = Scene {
        name: show.header.scene.clone(),
        seed: show.header.seed,
        frames: EFFORT.frames,
        dt: 0.0,
        side: show.header.side,
        shapes: show.shapes.clone(),
        velocities: Velocities {
            linear: vec![[0.0; 3]; bodies.len()],
            angular: vec![[0.0; 3]; bodies.len()],
        },
        bodies,
        effects: EffectsSpec::default(),
        cull,
        construct_seconds: 0.0,
    };
    calibrate(&scene, &[strategy], tier, EFFORT, |_| {}).map(Some)
}

impl TermCourse {
    /// T by its terms; none where the counters are of volumes that have no price.
    pub fn predict(show: &Show, culled: &Culled, prices: &Prices) -> Option<Self> {
        let counters = culled.counters.as_ref()?;
        let volumes = volumes(counters.first()?)?;
        let bodies = show.bodies.len();
        let frame = |lines: &Vec<VolumeLine>| {
            let terms = volumes
                .iter()
                .zip(lines)
                .map(|(&volume, line)| prices.terms(volume, &line.counters, 1, bodies));
            terms.fold([0.0; 3], |[update, find, test], terms| {
                [
                    update + terms.update,
                    find + terms.finding,
                    test + terms.test,
                ]
            })
        };
        Some(Self {
            construct: volumes
                .iter()
                .map(|&volume| prices.get(volume).construct)
                .sum(),
            frames: counters.iter().map(frame).collect(),
        })
    }
}

/// The volumes that have these names.
fn volumes(lines: &[VolumeLine]) -> Option<Vec<Volume>> {
    lines.iter().map(|line| line.volume.parse().ok()).collect()
}
