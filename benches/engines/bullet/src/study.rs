//! A scene judged, and timed in turns.

use rustix::time::{ClockId, clock_gettime};
use sdop::mesh::TriangleMesh;
use serde::{Deserialize, Serialize};

use crate::native::Counts;
use crate::plan::{Mode, Plan};
use crate::stage::Stage;

/// What a scene came to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Study {
    /// Steps judged: sums.
    pub judged: Counts,
    /// The time of an empty measurement in nanoseconds, which each of the judged times includes
    /// once.
    pub clock_ns: f64,
    /// Steps timed in turns, if they were.
    pub timed: Option<StepTimes>,
}

/// Steps with and without the filter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepTimes {
    /// Bullet without a filter: processor time of the stepping thread in milliseconds per step.
    pub plain_ms: f64,
    /// The same with the filter.
    pub filtered_ms: f64,
    /// Of the filtered steps: sums.
    pub filtered: Counts,
    /// How much of a plain step the filter should save by the prices of the judged run, as a share.
    pub predicted: f64,
}

/// Steps the scene without the filter and compares the filter's verdict on each pair, with all
/// margins multiplied by `share`.
#[must_use]
pub fn judge(plan: Plan, forms: &[TriangleMesh], steps: usize, share: f32) -> Counts {
    let mut stage = Stage::new(plan, forms, Mode::Judged, share);
    for _ in 0..steps {
        stage.step();
    }
    stage.counts()
}

/// Judges the scene, then steps it with and without the filter in turns unless margins are left
/// out.
#[must_use]
pub fn study(plan: Plan, forms: &[TriangleMesh], steps: usize, without_margin: bool) -> Study {
    let share = if without_margin { 0.0 } else { 1.0 };
    let (judged, clock_ns) = (judge(plan, forms, steps, share), clock_ns());
    let timed = (!without_margin).then(|| {
        let mut timed = time(plan, forms, steps);
        timed.predicted = saved_ms(&judged, clock_ns) / steps as f64 / timed.plain_ms;
        timed
    });
    Study { judged, clock_ns, timed }
}

/// The checks of rejected pairs less the tests of all.
fn saved_ms(judged: &Counts, clock_ns: f64) -> f64 {
    let checks = judged.rejected_ns - judged.rejected as f64 * clock_ns;
    let tests = judged.test_ns - judged.asked as f64 * clock_ns;
    (checks - tests) * 1e-6
}

fn time(plan: Plan, forms: &[TriangleMesh], steps: usize) -> StepTimes {
    let mut stages = [Mode::Plain, Mode::Filtered].map(|mode| Stage::new(plan, forms, mode, 1.0));
    let mut ms = [0.0; 2];
    for step in 0..steps {
        for turn in [step % 2, 1 - step % 2] {
            let start = cpu_ms();
            stages[turn].step();
            ms[turn] += cpu_ms() - start;
        }
    }
    StepTimes {
        plain_ms: ms[0] / steps as f64,
        filtered_ms: ms[1] / steps as f64,
        filtered: stages[1].counts(),
        predicted: 0.0,
    }
}

fn cpu_ms() -> f64 {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    now.tv_sec as f64 * 1e3 + now.tv_nsec as f64 * 1e-6
}

/// The median time of an empty measurement.
fn clock_ns() -> f64 {
    let mut times: Vec<_> =
        (0..10_000).map(|_| std::time::Instant::now().elapsed().as_nanos()).collect();
    times.sort_unstable();
    times[times.len() / 2] as f64
}
