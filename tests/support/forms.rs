//! Forms that several suites use.

#![allow(dead_code, reason = "each test binary uses its own part of this support")]

use sdop::mesh::ProceduralShape;
use sdop::settings::{CullSettings, Strategy};

/// The strategies that need no further settings, and so report every pair that they don't reject.
pub fn strategies_that_report_all() -> Vec<Strategy> {
    let reports_all = |&strategy: &Strategy| {
        let settings = CullSettings { strategy, ..CullSettings::default() };
        strategy.scheme().culls() && settings.check(2).is_ok()
    };
    let strategies: Vec<_> = Strategy::ALL.iter().copied().filter(reports_all).collect();
    assert!(strategies.len() > 5, "{strategies:?}");
    strategies
}

/// Meshes of three kinds: with faces on the axes, round, and thin.
pub const FORMS: [ProceduralShape; 3] = [
    ProceduralShape::Box { x: 1.0, y: 2.0, z: 1.5 },
    ProceduralShape::Icosphere { radius: 1.0, subdivisions: 1 },
    ProceduralShape::Needle { length: 4.0, radius: 0.25, sides: 8 },
];

/// The triangles of a box whose corners are numbered with x the fastest.
pub const BOX_FACES: [[u32; 3]; 12] = [
    [0, 2, 1],
    [1, 2, 3],
    [4, 5, 6],
    [5, 7, 6],
    [0, 1, 4],
    [1, 5, 4],
    [2, 6, 3],
    [3, 6, 7],
    [0, 4, 2],
    [2, 4, 6],
    [1, 3, 5],
    [3, 7, 5],
];
