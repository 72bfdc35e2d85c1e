//! The corpus of hard cases on ranks.

use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::volume::{Axes, DirectionSet};
use sdop_judge::configuration::cullers::settings;
use sdop_judge::draw::hard::{FILES, HardCaseGroup};

use crate::domain::{pairs_alone, pairs_on};

/// Ranks report the pairs of one process in every group.
#[test]
fn hard_cases_match_on_ranks() {
    let ways = [
        (Strategy::Sphere, Finder::Grid),
        (Strategy::SDopSequential, Finder::Sweep),
        (Strategy::OrDop, Finder::Neighbours),
        (Strategy::Aabb, Finder::Grid),
        (Strategy::Obb, Finder::AllPairs),
    ];
    for (name, text) in FILES {
        let group = HardCaseGroup::parse(text).unwrap();
        let cases = group.cases(DirectionSet::K18, Axes::Principal).unwrap();
        for frames in &cases.runs {
            for (strategy, finder) in ways {
                let base = CullSettings { pairs: finder, ..CullSettings::default() };
                let settings = settings(strategy, &base, frames[0].len());
                let shapes = &cases.shapes.built;
                let alone = pairs_alone(shapes, frames, &settings);
                for ranks in [2, 3, 8] {
                    let shared = pairs_on(ranks, shapes, frames, &settings);
                    assert_eq!(shared, alone, "{name}: {strategy} over {finder} on {ranks}");
                }
            }
        }
    }
}
