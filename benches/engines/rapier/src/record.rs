//! What a run found, as rows of a table.

use sdop_bench::measure::machine::Machine;
use serde::{Deserialize, Serialize};

/// Steps of a filtered run, each also taken without the filter from the same state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// Steps taken.
    pub steps: usize,
    /// Pairs with contact points in the unfiltered steps.
    pub touching: u64,
    /// Pairs of a sensor and what overlaps it in the unfiltered steps.
    pub overlapping: u64,
    /// Of those with points, pairs that the filtered step lacks because rapier would not have found
    /// them either: farther apart than it looks, with points left over from a shape that was
    /// replaced since.
    #[serde(default)]
    pub leftovers: u64,
    /// Of all of them, others that the filtered step lacks. Must be zero.
    pub dropped: u64,
    /// The first step with one, and the pair's collider indices.
    pub first_dropped: Option<(usize, [u32; 2])>,
    /// Pairs in both whose points or impulses differ in a bit.
    pub contacts_that_differ: u64,
    /// Bodies whose pose or velocities differ in a bit afterwards.
    pub bodies_that_differ: u64,
    /// Narrow-phase checks of the filtered steps.
    pub checked: u64,
    /// Narrow-phase checks of the unfiltered steps.
    pub checked_unfiltered: u64,
}

/// One mode's share of a measurement in turns.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// How it was stepped.
    pub mode: String,
    /// Milliseconds per step by rapier's counters, mean over steps.
    pub step_ms: f64,
    /// The same, median.
    pub step_ms_median: f64,
    /// Of it the narrow phase, mean.
    pub narrow_ms: f64,
    /// The same, median.
    pub narrow_ms_median: f64,
    /// Processor time of the stepping thread per step, which other processes don't add to.
    pub cpu_ms: f64,
    /// Pairs that reached the narrow phase, per step.
    pub checks: f64,
    /// Of them with contact points afterwards.
    pub hits: f64,
    /// Pairs that the filter rejected, per step. For a hook: those that its partner checked and it
    /// didn't.
    pub rejected: f64,
    /// Pairs that the filter in the dispatcher tested or passed, per step.
    pub asked: f64,
    /// The filter's own milliseconds per step: a hook's taking over of poses.
    pub mirror_ms: f64,
    /// A hook's culling.
    pub cull_ms: f64,
    /// Steps in which all contacts were equal to the bit to those of the same mode without the
    /// filter, from the first on.
    pub equal_steps: usize,
}

/// Nanoseconds, from a run with another seed in which nothing is rejected.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Prices {
    /// A narrow-phase check that the filter would have rejected.
    pub rejected_ns: f64,
    /// A narrow-phase check with contact points.
    pub hit_ns: f64,
    /// The filter's pair test.
    pub test_ns: f64,
}

impl Prices {
    /// Milliseconds that the filter in the dispatcher should save.
    #[must_use]
    pub fn gain_ms(&self, share: &Share) -> f64 {
        (share.rejected * self.rejected_ns - share.asked * self.test_ns) * 1e-6
    }
}

/// A run and what it found: one file.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Record {
    /// What was run.
    pub command: String,
    /// Where.
    pub machine: Machine,
    /// The scene.
    pub scene: String,
    /// What bodies are made of.
    pub kind: String,
    /// How finely they are cut.
    pub detail: String,
    /// How many.
    pub bodies: usize,
    /// Steps taken.
    pub steps: usize,
    /// Where random draws started.
    pub seed: u64,
    /// Rapier's numbers.
    pub real: String,
    /// What was found.
    #[serde(flatten)]
    pub found: RecordedFinding,
}

/// What was found.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RecordedFinding {
    /// By `check`.
    Checked {
        /// How it was filtered.
        mode: String,
        /// Whether a bug was planted.
        without_margin: bool,
        /// The comparison.
        check: Check,
    },
    /// By `measure`.
    Measured {
        /// One per mode.
        shares: Vec<Share>,
        /// For predictions.
        prices: Prices,
    },
}
