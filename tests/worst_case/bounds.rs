//! Every bound with its search: shared by the short test and by the long search in
//! `benches/criterion/worst_case.rs`.

use sdop::rounding::pose::{COORDINATE_ERROR, REFIT_MARGIN};
use sdop::rounding::slab::{SLAB_FLOOR, SLAB_MARGIN, SUPPORT_ERROR};
use sdop::rounding::sphere::{CENTRE_ERROR, RADIUS_FLOOR};
use sdop::rounding::{FINDER_FACTOR, FLUSH, U};

use super::slabs::{self, Target};
use super::{poses, spheres};

/// 2⁻⁵³.
const EPSILON: f64 = f64::EPSILON / 2.0;

/// (seed, evaluations) → the largest error found.
type Search = Box<dyn Fn(u64, u64) -> f64 + Send + Sync>;

pub struct Bound {
    pub name: String,
    pub unit: &'static str,
    /// What no error may exceed.
    pub constant: f64,
    /// What a short search must reach, or it has no teeth.
    pub teeth: f64,
    pub search: Search,
}

fn bound(
    name: impl Into<String>,
    unit: &'static str,
    (teeth, constant): (f64, f64),
    search: impl Fn(u64, u64) -> f64 + Send + Sync + 'static,
) -> Bound {
    Bound { name: name.into(), unit, constant, teeth, search: Box::new(search) }
}

/// All bounds that the culler relies on.
pub fn all() -> Vec<Bound> {
    let mut bounds = vec![
        bound("sphere decision", "u", (7.7, 8.0), spheres::decision),
        bound("reported sphere distance", "u", (3.8, (FINDER_FACTOR - 1.0) / U), spheres::reported),
        bound("pose coordinate", "2⁻⁵³", (7.0, COORDINATE_ERROR / EPSILON), poses::coordinate),
        bound("ball centre", "2⁻⁵³", (8.0, CENTRE_ERROR / EPSILON), poses::centre),
        bound("world extent", "2⁻⁵³", (11.0, REFIT_MARGIN / EPSILON), poses::extent),
        bound("entry of M", "u", (2.3, 6.51), poses::product),
    ];
    for (k, constant) in SUPPORT_ERROR {
        let teeth = 0.55 * constant;
        bounds.push(bound(
            format!("support multipliers, k = {k}"),
            "u‖e‖",
            (teeth, constant),
            move |seed, n| slabs::multiplier(k, seed, n),
        ));
    }
    for target in targets() {
        let constant = SLAB_MARGIN / U;
        bounds.push(bound(name(target), "uρ‖a‖", (4.0, constant), move |seed, n| {
            slabs::rounding(target, seed, n)
        }));
    }
    for k in [6, 14, 18, 26] {
        let target = Target { k, edges: true, offset: false, boxes: false };
        let constant = SLAB_FLOOR / FLUSH;
        let name = format!("underflow flushed, k = {k}");
        bounds.push(bound(name, "2⁻¹²⁶‖a‖", (4.0, constant), move |seed, n| {
            slabs::underflow::<true>(target, seed, n)
        }));
    }
    bounds
}

/// Errors that must never be positive: something leaves its volume, or a touching pair is culled.
pub fn containments() -> Vec<Bound> {
    let none = (f64::NEG_INFINITY, 0.0);
    vec![
        bound("posed ball out of its world ball", "u", none, poses::ball_outside),
        bound("posed vertex out of its world extent", "2⁻⁵³", none, poses::extent_outside),
        bound("touching spheres culled", "(1: culled)", none, spheres::touching),
        bound("tiny touching spheres culled", "(1: culled)", none, |seed, n| {
            spheres::tiny::<false>(seed, n, RADIUS_FLOOR)
        }),
        bound("the same, flushed", "(1: culled)", none, |seed, n| {
            spheres::tiny::<true>(seed, n, RADIUS_FLOOR)
        }),
    ]
}

fn targets() -> Vec<Target> {
    let mut targets = Vec::new();
    for k in [6, 14, 18, 26] {
        for edges in [false, true] {
            targets.push(Target { k, edges, offset: false, boxes: false });
        }
        targets.push(Target { k, edges: false, offset: true, boxes: false });
    }
    for edges in [false, true] {
        targets.push(Target { k: 6, edges, offset: false, boxes: true });
    }
    targets
}

fn name(Target { k, edges, offset, boxes }: Target) -> String {
    let axes = if edges { "edge × edge" } else { "normals" };
    let solids = if boxes { ", boxes" } else { "" };
    let centre = if offset { ", c ≠ 0" } else { "" };
    format!("{axes}, k = {k}{solids}{centre}")
}
