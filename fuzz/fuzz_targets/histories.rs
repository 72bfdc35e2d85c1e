//! Long-lived worlds of boxes and of meshes, also in space that repeats, and of compounds, with
//! bodies that come, go, move, rest, wake and change; the bytes choose everything. After each
//! frame, their pairs and events are those of a newly built world, and no pair that the exact
//! reference requires is missing.
#![no_main]

use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use sdop::Tier;
use sdop::settings::{CullSettings, Overlap};
use sdop_judge::configuration::{Mode, rows, variants};
use sdop_judge::history::{
    Repeated, Robots, draw_boxes, draw_meshes, history_shapes, judge_boxes, judge_compounds,
    judge_meshes, judge_periodic_boxes, judge_periodic_meshes,
};
use sdop_judge::truth::Shapes;

/// A number below another, of as many bytes as that takes; 0 when none are left.
fn below(n: u32, bytes: &mut impl Iterator<Item = u8>) -> u32 {
    let length = (n - 1).max(1).ilog2() / 8 + 1;
    let number = (0..length).fold(0, |sum: u32, _| sum << 8 | u32::from(bytes.next().unwrap_or(0)));
    number % n
}

/// The shapes of each or-DOP, built once.
fn shapes(variant: usize) -> &'static Shapes {
    static BUILT: OnceLock<Vec<Shapes>> = OnceLock::new();
    let build = |variant| history_shapes(variant, 1, false).expect("its forms can be built");
    &BUILT.get_or_init(|| variants().map(build).collect())[variant]
}

fuzz_target!(|data: &[u8]| {
    let mut bytes = data.iter().copied();
    let mut below = |n| below(n, &mut bytes);
    let tiers = Tier::available();
    let mode = Mode::plain(tiers[below(tiers.len() as u32) as usize]);
    let (is_of_boxes, kind) = (below(2) == 0, below(3));
    let is_periodic = kind == 0;
    let judged = if is_of_boxes {
        let history = draw_boxes(!is_periodic, &mut below);
        if is_periodic {
            judge_periodic_boxes(&Repeated::boxes(&history, &mut below), &[mode])
        } else {
            judge_boxes(&history, &[mode])
        }
    } else {
        let number = below(variants().count() as u32) as usize;
        let variant = variants().nth(number).expect("one of them");
        let row = below(rows(variant).len() as u32) as usize;
        let modes = |wanted: usize| move |n| if n == wanted { vec![mode] } else { Vec::new() };
        if kind == 1 {
            let robots = Robots::draw(shapes(number).clone(), &mut below).expect("valid parts");
            let history = robots.history(&mut below);
            let rows = rows(variant);
            let is_judged = |other: &CullSettings| {
                other.strategy == rows[row].strategy && other.overlap == Overlap::TwoSided
            };
            let row = rows.iter().position(is_judged).expect("a row of each strategy");
            let judged = judge_compounds(&robots, &history, variant, modes(row));
            assert_eq!(judged.expect("histories are valid").failure, None);
            return;
        }
        let history = draw_meshes(shapes(number), &mut below);
        if is_periodic {
            let history = Repeated::meshes(shapes(number), &history, &mut below);
            judge_periodic_meshes(shapes(number), &history, variant, &[mode])
        } else {
            judge_meshes(shapes(number), &history, variant, modes(row))
        }
    };
    assert_eq!(judged.expect("histories are valid").failure, None);
});
