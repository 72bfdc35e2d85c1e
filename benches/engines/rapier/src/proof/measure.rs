//! Runs of one scene in all modes, step by step in turns.

use std::time::Instant;

use rustix::time::{ClockId, clock_gettime};
use sdop::mesh::TriangleMesh;

use super::calls::{CallTimes, Filtering};
use super::sim::{Sim, StepMs, touches};
use crate::plan::{Mode, Plan};
use crate::record::{Prices, Share};

/// One mode, and what was measured of it.
struct Lane {
    sim: Sim,
    steps: Vec<StepMs>,
    cpu: f64,
    equal_steps: usize,
    equal: bool,
}

/// Steps the scene in each of the modes, in turns, and shares out what was measured.
#[must_use]
pub fn measure(plan: Plan, forms: &[TriangleMesh], modes: &[Mode], steps: usize) -> Vec<Share> {
    let lane = |&mode: &Mode| Lane {
        sim: Sim::new(plan, forms, mode),
        steps: Vec::new(),
        cpu: 0.0,
        equal_steps: 0,
        equal: true,
    };
    let mut lanes: Vec<Lane> = modes.iter().map(lane).collect();
    for step in 0..steps {
        for turn in 0..lanes.len() {
            let turn = (step + turn) % modes.len();
            let lane = &mut lanes[turn];
            let start = clock_gettime(ClockId::ThreadCPUTime);
            let ms = lane.sim.step();
            let end = clock_gettime(ClockId::ThreadCPUTime);
            lane.cpu += (end.tv_sec - start.tv_sec) as f64 * 1e3
                + (end.tv_nsec - start.tv_nsec) as f64 * 1e-6;
            lane.steps.push(ms);
        }
        compare(&mut lanes);
    }
    lanes.iter().map(|lane| share(lane, &lanes)).collect()
}

/// Whether each mode's contacts are still those of the same mode without the filter.
fn compare(lanes: &mut [Lane]) {
    for i in 0..lanes.len() {
        let mode = lanes[i].sim.mode;
        let partner = lanes.iter().find(|other| other.sim.mode == mode.unfiltered());
        let Some(partner) = partner.filter(|_| lanes[i].equal) else {
            continue;
        };
        let equal = touches(&partner.sim.stage.world) == touches(&lanes[i].sim.stage.world);
        lanes[i].equal = equal;
        lanes[i].equal_steps += usize::from(equal);
    }
}

fn share(lane: &Lane, lanes: &[Lane]) -> Share {
    let (calls, steps) = (lane.sim.calls(), lane.steps.len().max(1) as f64);
    let partner = lanes.iter().find(|other| other.sim.mode == lane.sim.mode.unfiltered());
    let checked = |lane: &Lane| lane.sim.calls().narrow() as f64;
    let fewer = partner.map_or(0.0, |partner| checked(partner) - checked(lane));
    let of = |part: fn(&StepMs) -> f64| lane.steps.iter().map(part).collect::<Vec<f64>>();
    let (step, narrow) = (of(|ms| ms.step), of(|ms| ms.narrow));
    let cost = lane.sim.cost();
    Share {
        mode: lane.sim.mode.to_string(),
        step_ms: step.iter().sum::<f64>() / steps,
        step_ms_median: median(step),
        narrow_ms: narrow.iter().sum::<f64>() / steps,
        narrow_ms_median: median(narrow),
        cpu_ms: lane.cpu / steps,
        checks: calls.narrow() as f64 / steps,
        hits: calls.hits.count() as f64 / steps,
        rejected: match lane.sim.mode {
            Mode::Hook => fewer / steps,
            _ => calls.culled.count() as f64 / steps,
        },
        asked: calls.asked.count() as f64 / steps,
        mirror_ms: cost.mirror * 1e3 / steps,
        cull_ms: cost.cull * 1e3 / steps,
        equal_steps: lane.equal_steps,
    }
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_unstable_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied().unwrap_or(0.0)
}

/// Prices checks and tests in a run of `steps` steps in which nothing is rejected, with another
/// seed.
#[must_use]
pub fn calibrate(plan: Plan, forms: &[TriangleMesh], steps: usize) -> Prices {
    let plan = Plan { seed: plan.seed + 1, ..plan };
    let mut sim = Sim::new(plan, forms, Mode::Dispatcher);
    sim.calls().set_filtering(Filtering::Shadow);
    sim.calls().set_timing(true);
    for _ in 0..steps {
        sim.step();
    }
    let (calls, clock) = (sim.calls(), clock_ns());
    let price = |timed: &CallTimes| (timed.mean_ns() - clock).max(0.0);
    Prices {
        rejected_ns: price(&calls.culled),
        hit_ns: price(&calls.hits),
        test_ns: price(&calls.asked),
    }
}

/// What timing nothing takes.
fn clock_ns() -> f64 {
    let elapsed = || Instant::now().elapsed().as_nanos() as f64;
    median((0..10_000).map(|_| elapsed()).collect())
}
