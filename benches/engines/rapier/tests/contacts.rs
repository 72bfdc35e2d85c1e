//! Contacts stay what they were: small runs of every scene, kind and seam, in both of rapier's
//! crates.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use sdop::mesh::TriangleMesh;
use sdop_rapier::plan::{Detail, Kind, Mode, Plan, Scene};
use sdop_rapier::record::Check;
use sdop_rapier::{double, single};

const FILTERED: [Mode; 3] = [Mode::Hook, Mode::Dispatcher, Mode::DispatcherFull];

fn forms() -> Vec<TriangleMesh> {
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../data/meshes");
    let forms = sdop_rapier::forms::forms(&meshes, Detail::Coarse).unwrap();
    // Quick to collide: the cow and the knot have hundreds of triangles.
    forms.into_iter().filter(|form| form.triangles.len() < 290).collect()
}

fn check(plan: Plan, mode: Mode, steps: usize) -> [Check; 2] {
    let forms = forms();
    let cases = tempfile::tempdir().unwrap();
    let run = |check: fn(_, &[_], _, _, _, &Path) -> miette::Result<Check>| {
        check(plan, &forms, mode, steps, false, cases.path()).unwrap()
    };
    [run(single::proof::check), run(double::proof::check)]
}

/// No scene loses a contact and few checks are left.
#[test]
fn no_scene_loses_a_contact() {
    for &kind in Kind::ALL {
        for mode in FILTERED {
            let (mut checked, mut unfiltered) = (0, 0);
            for &scene in Scene::ALL {
                let plan = Plan { scene, kind, bodies: 20, seed: 3 };
                for check in check(plan, mode, 40) {
                    assert_eq!(check.dropped, 0, "{plan:?}, {mode}: {check:?}");
                    assert_eq!(check.contacts_that_differ, 0, "{plan:?}, {mode}: {check:?}");
                    assert_eq!(check.bodies_that_differ, 0, "{plan:?}, {mode}: {check:?}");
                    checked += check.checked;
                    unfiltered += check.checked_unfiltered;
                }
            }
            // A scene so small may have no pair to reject; all scenes of a kind have some.
            let passes = matches!(kind, Kind::Box | Kind::Ball);
            assert!(
                passes || checked < unfiltered,
                "{kind:?}, {mode}: {checked} of {unfiltered} checks are left"
            );
        }
    }
}

/// The check sees margins left out and saves the pair.
#[test]
fn check_detects_missing_margins() {
    let forms = forms();
    let plan = Plan { scene: Scene::Pile, kind: Kind::Hull, bodies: 40, seed: 5 };
    for mode in [Mode::Hook, Mode::DispatcherFull] {
        let cases = tempfile::tempdir().unwrap();
        let found = single::proof::check(plan, &forms, mode, 120, true, cases.path()).unwrap();
        assert!(found.dropped > 0, "{mode}: {found:?}");
        let scene = cases.path().join("dropped-pair.toml");
        let scene = sdop_bench::scene::SceneFile::read(&scene).unwrap().build().unwrap();
        assert_eq!(scene.bodies.len(), 2);
    }
}
