//! Bullet finds no contact that the filter would reject, the filter rejects something, and a
//! missing margin is detected.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use clap::ValueEnum;
use sdop::mesh::TriangleMesh;
use sdop_bullet::plan::{Detail, Kind, Plan, SceneKind};
use sdop_bullet::stage::is_filtered;
use sdop_bullet::study::judge;

fn forms() -> Vec<TriangleMesh> {
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/meshes");
    sdop_bullet::forms::forms(&meshes, Detail::Coarse).unwrap()
}

fn plans() -> impl Iterator<Item = Plan> {
    SceneKind::value_variants().iter().flat_map(|&scene| {
        Kind::value_variants().iter().map(move |&kind| Plan { scene, kind, bodies: 30, seed: 3 })
    })
}

#[test]
fn no_scene_loses_a_contact() {
    for plan in plans() {
        let counts = judge(plan, &forms(), 120, 1.0);
        assert!(counts.touching > 0, "{plan:?}: nothing touched");
        assert_eq!(counts.dropped, 0, "{plan:?}: {counts:?}");
        assert_eq!(counts.rejected > 0, is_filtered(plan.kind), "{plan:?}: {counts:?}");
    }
}

/// Margins that are left out are seen.
#[test]
fn missing_margins_are_detected() {
    let dropped = |kind| {
        let plans = plans().filter(move |plan| plan.kind == kind);
        plans.map(|plan| judge(plan, &forms(), 120, 0.0).dropped).sum::<u64>()
    };
    assert!(dropped(Kind::Hull) > 0);
    assert!(dropped(Kind::Mesh) > 0);
}
