//! Table 1: collisions detected over tests, under every plausible reading of "tests".
//!
//! The paper only says "percentage of detected collision over total number of testing". A
//! strategy's own test is the last one that it makes; an entry written to the list of sphere hits
//! may have been counted as a test as well.

use serde::{Deserialize, Serialize};

use super::experiment::Results;
use super::{Estimate, paper};
use sdop::choice::choices;
use sdop::counters::Counters;
use sdop::settings::{Flow, Strategy};

choices! {
    /// What counts as a test.
    Reading, "reading", {
        /// The strategy's last test alone: spheres for `sphere`, or-DOPs for the others.
        OwnTests = "hits/own tests",
        /// Sphere tests and or-DOP tests.
        AllTests = "hits/all tests",
        /// The strategy's last test and, where a list is kept, each entry of the list.
        TestsAndList = "hits/(tests + list entries)",
        /// Sphere tests, or-DOP tests and list entries.
        AllTestsAndList = "hits/(all tests + list entries)",
        /// All n² ordered pairs, which the paper says a scene requires.
        OrderedPairs = "hits/n² pairs",
    }
}

/// The strategies of the paper's Table 1, in its order.
pub const TABLE_1_STRATEGIES: [Strategy; 4] =
    [Strategy::Sphere, Strategy::OrDop, Strategy::SDopSequential, Strategy::SDopBatch];

impl Reading {
    /// The reading under which figures show a strategy: where a list is kept, its entries count.
    #[must_use]
    pub const fn shown(strategy: Strategy) -> Self {
        match strategy.scheme().flow {
            Flow::Batch => Self::TestsAndList,
            _ => Self::OwnTests,
        }
    }

    /// Hits in percent of the tests of `frames` frames with `bodies` bodies.
    #[must_use]
    pub fn percentage(self, strategy: Strategy, run: &Counters, frames: u32, bodies: usize) -> f64 {
        let own = if strategy.scheme().has_overlap_test() { run.ordop } else { run.sphere };
        let all = run.sphere.tests + run.ordop.tests;
        let entries = match strategy.scheme().flow {
            Flow::Batch => run.sphere.hits,
            _ => 0,
        };
        let tests = match self {
            Self::OwnTests => own.tests,
            Self::AllTests => all,
            Self::TestsAndList => own.tests + entries,
            Self::AllTestsAndList => all + entries,
            Self::OrderedPairs => u64::from(frames) * (bodies * bodies) as u64,
        };
        100.0 * own.hits as f64 / tests as f64
    }
}

/// One cell of Table 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Table1Cell {
    /// The scene.
    pub scene: String,
    /// Whether that is the paper's one box.
    #[serde(skip)]
    pub in_papers_box: bool,
    /// N.
    pub bodies: usize,
    /// The strategy.
    pub strategy: Strategy,
    /// What counts as a test.
    pub reading: Reading,
    /// Percent, over seeds.
    pub measured: Estimate,
    /// The paper's percentage, where it has one for this N in its one box.
    pub paper: Option<f64>,
}

impl Results {
    /// A strategy's percentages in a scene, seed by seed.
    pub(super) fn percent(&self, scene: &str, strategy: Strategy, reading: Reading) -> Vec<f64> {
        self.by_seed(scene, strategy, |run| {
            reading.percentage(strategy, &run.counters, run.frames, run.bodies)
        })
    }
}

/// One cell.
#[must_use]
pub fn cell(results: &Results, scene: &str, strategy: Strategy, reading: Reading) -> Table1Cell {
    let bodies = results.example(scene).map_or(0, |run| run.bodies);
    let values = results.percent(scene, strategy, reading);
    let comparable = results.paper_scenes().any(|name| name == scene);
    Table1Cell {
        scene: scene.to_owned(),
        in_papers_box: comparable,
        bodies,
        strategy,
        reading,
        measured: Estimate::of(&values),
        paper: paper::percentage(strategy, bodies).filter(|_| comparable),
    }
}

/// All cells: reading by reading, strategy by strategy, scene by scene.
#[must_use]
pub fn table(results: &Results) -> Vec<Table1Cell> {
    let mut cells = Vec::new();
    for &reading in Reading::ALL {
        for strategy in TABLE_1_STRATEGIES {
            let scenes = results.scenes();
            cells.extend(scenes.map(|scene| cell(results, scene, strategy, reading)));
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use sdop::counters::VolumeCounters;

    #[test]
    fn readings_count_what_they_say() {
        let volume = |tests, hits| VolumeCounters { updates: 0, tests, hits };
        let run =
            Counters { sphere: volume(1000, 20), ordop: volume(20, 9), ..Counters::default() };
        let read = |strategy| {
            Reading::ALL.iter().map(|r| r.percentage(strategy, &run, 2, 25)).collect::<Vec<_>>()
        };
        let all = 900.0 / 1020.0;
        assert_eq!(read(Strategy::SDopSequential), [45.0, all, 45.0, all, 900.0 / 1250.0]);
        assert_eq!(read(Strategy::SDopBatch), [45.0, all, 22.5, 900.0 / 1040.0, 900.0 / 1250.0]);
        let spheres = Counters { ordop: volume(0, 0), ..run };
        let read = |reading: Reading| reading.percentage(Strategy::Sphere, &spheres, 2, 25);
        assert_eq!(
            Reading::ALL.iter().map(|&r| read(r)).collect::<Vec<_>>(),
            [2.0, 2.0, 2.0, 2.0, 1.6]
        );
    }
}
