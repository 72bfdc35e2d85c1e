//! The runs of the filter in physics engines, `examples/rapier` and `examples/bullet`.

use super::experiment::Step;

/// Contacts with the filter and without: counts, which no load changes.
pub(super) const RAPIER_CONTACTS: &[Step] = &[
    Step::Rapier(
        "pile-mesh-100-dispatcher-f32.json",
        "check --scene pile --kind mesh --bodies 100 --steps 1000 --mode dispatcher --real f32",
    ),
    Step::Rapier(
        "pile-mesh-500-dispatcher-f32.json",
        "check --scene pile --kind mesh --bodies 500 --steps 200 --mode dispatcher --real f32",
    ),
    Step::Rapier(
        "pile-hull-500-dispatcher-f32.json",
        "check --scene pile --kind hull --bodies 500 --steps 1000 --mode dispatcher --real f32",
    ),
    Step::Rapier(
        "pile-hull-200-dispatcher-f64.json",
        "check --scene pile --kind hull --bodies 200 --steps 1000 --mode dispatcher --real f64",
    ),
    Step::Rapier(
        "pile-hull-5000-dispatcher-f32.json",
        "check --scene pile --kind hull --bodies 5000 --steps 60 --mode dispatcher --real f32",
    ),
    Step::Rapier(
        "pile-box-500-dispatcher-f32.json",
        "check --scene pile --kind box --bodies 500 --steps 300 --mode dispatcher --real f32",
    ),
    Step::Rapier(
        "pile-ball-500-dispatcher-f32.json",
        "check --scene pile --kind ball --bodies 500 --steps 300 --mode dispatcher --real f32",
    ),
    Step::Rapier(
        "tumbler-compound-100-dispatcher-f32.json",
        "check --scene tumbler --kind compound --bodies 100 --steps 1000 --mode dispatcher --real f32",
    ),
    Step::Rapier(
        "tumbler-mesh-100-dispatcher-f32.json",
        "check --scene tumbler --kind mesh --bodies 100 --steps 300 --mode dispatcher --real f32",
    ),
    Step::Rapier(
        "conveyor-colliders-100-dispatcher-f32.json",
        "check --scene conveyor --kind colliders --bodies 100 --steps 1000 --mode dispatcher --real f32",
    ),
    Step::Rapier(
        "cloud-mesh-300-dispatcher-f32.json",
        "check --scene cloud --kind mesh --bodies 300 --steps 1000 --mode dispatcher --real f32",
    ),
    Step::Rapier(
        "zoo-hull-200-dispatcher-f32.json",
        "check --scene zoo --kind hull --bodies 200 --steps 1000 --mode dispatcher --real f32",
    ),
    Step::Rapier(
        "zoo-hull-200-dispatcher-f64.json",
        "check --scene zoo --kind hull --bodies 200 --steps 300 --mode dispatcher --real f64",
    ),
    Step::Rapier(
        "pile-mesh-100-hook-f32.json",
        "check --scene pile --kind mesh --bodies 100 --steps 300 --mode hook --real f32",
    ),
    Step::Rapier(
        "pile-hull-500-hook-f32.json",
        "check --scene pile --kind hull --bodies 500 --steps 200 --mode hook --real f32",
    ),
    Step::Rapier(
        "pile-hull-200-hook-f64.json",
        "check --scene pile --kind hull --bodies 200 --steps 300 --mode hook --real f64",
    ),
    Step::Rapier(
        "tumbler-compound-100-hook-f32.json",
        "check --scene tumbler --kind compound --bodies 100 --steps 300 --mode hook --real f32",
    ),
    Step::Rapier(
        "conveyor-colliders-100-hook-f32.json",
        "check --scene conveyor --kind colliders --bodies 100 --steps 300 --mode hook --real f32",
    ),
    Step::Rapier(
        "cloud-mesh-300-hook-f32.json",
        "check --scene cloud --kind mesh --bodies 300 --steps 150 --mode hook --real f32",
    ),
    Step::Rapier(
        "zoo-hull-200-hook-f32.json",
        "check --scene zoo --kind hull --bodies 200 --steps 300 --mode hook --real f32",
    ),
    Step::Rapier(
        "zoo-hull-200-hook-f64.json",
        "check --scene zoo --kind hull --bodies 200 --steps 200 --mode hook --real f64",
    ),
    Step::Rapier(
        "margin-left-out-dispatcher.json",
        "check --scene pile --kind hull --bodies 60 --steps 150 --mode dispatcher --without-margin",
    ),
    Step::Rapier(
        "margin-left-out-hook.json",
        "check --scene pile --kind hull --bodies 60 --steps 150 --mode hook --without-margin",
    ),
];

/// Steps of the engine in turns.
pub(super) const RAPIER_TIMES: &[Step] = &[
    Step::Rapier(
        "pile-hull-500.json",
        "measure --scene pile --kind hull --bodies 500 --steps 300 --calibrate 60",
    ),
    Step::Rapier(
        "pile-mesh-100.json",
        "measure --scene pile --kind mesh --bodies 100 --steps 300 --calibrate 60",
    ),
    Step::Rapier(
        "tumbler-hull-500.json",
        "measure --scene tumbler --kind hull --bodies 500 --steps 150 --calibrate 60",
    ),
    Step::Rapier(
        "tumbler-mesh-100.json",
        "measure --scene tumbler --kind mesh --bodies 100 --steps 150 --calibrate 60",
    ),
    Step::Rapier(
        "cloud-mesh-300.json",
        "measure --scene cloud --kind mesh --bodies 300 --steps 200 --calibrate 60 --modes plain,dispatcher",
    ),
    Step::Rapier(
        "conveyor-hull-100.json",
        "measure --scene conveyor --kind hull --bodies 100 --steps 600 --calibrate 60 --modes plain,dispatcher",
    ),
    Step::Rapier(
        "pile-hull-5000.json",
        "measure --scene pile --kind hull --bodies 5000 --steps 40 --calibrate 60 --modes plain,dispatcher",
    ),
    Step::Rapier(
        "pile-mesh-40-fine.json",
        "measure --scene pile --kind mesh --bodies 40 --steps 100 --calibrate 60 --detail fine --modes plain,dispatcher",
    ),
    Step::Rapier(
        "pile-box-500.json",
        "measure --scene pile --kind box --bodies 500 --steps 300 --calibrate 60 --modes plain,dispatcher",
    ),
    Step::Rapier(
        "pile-ball-500.json",
        "measure --scene pile --kind ball --bodies 500 --steps 300 --calibrate 60 --modes plain,dispatcher",
    ),
];

/// Judged and timed.
pub(super) const BULLET: &[Step] = &[
    Step::Bullet(
        "pile-hull-100.json",
        "--scene pile --kind hull --bodies 100 --steps 1000",
    ),
    Step::Bullet(
        "pile-hull-500.json",
        "--scene pile --kind hull --bodies 500 --steps 1000",
    ),
    Step::Bullet(
        "pile-hull-5000.json",
        "--scene pile --kind hull --bodies 5000 --steps 60",
    ),
    Step::Bullet(
        "pile-mesh-100.json",
        "--scene pile --kind mesh --bodies 100 --steps 1000",
    ),
    Step::Bullet(
        "pile-mesh-500.json",
        "--scene pile --kind mesh --bodies 500 --steps 100",
    ),
    Step::Bullet(
        "pile-mesh-40-fine.json",
        "--scene pile --kind mesh --bodies 40 --steps 100 --detail fine",
    ),
    Step::Bullet(
        "pile-box-500.json",
        "--scene pile --kind box --bodies 500 --steps 300",
    ),
    Step::Bullet(
        "pile-ball-500.json",
        "--scene pile --kind ball --bodies 500 --steps 300",
    ),
    Step::Bullet(
        "tumbler-hull-500.json",
        "--scene tumbler --kind hull --bodies 500 --steps 300",
    ),
    Step::Bullet(
        "tumbler-mesh-100.json",
        "--scene tumbler --kind mesh --bodies 100 --steps 300",
    ),
    Step::Bullet(
        "cloud-hull-300.json",
        "--scene cloud --kind hull --bodies 300 --steps 1000",
    ),
    Step::Bullet(
        "cloud-mesh-300.json",
        "--scene cloud --kind mesh --bodies 300 --steps 1000",
    ),
    Step::Bullet(
        "pile-hull-60-without-margin.json",
        "--scene pile --kind hull --bodies 60 --steps 150 --without-margin",
    ),
    Step::Bullet(
        "pile-mesh-60-without-margin.json",
        "--scene pile --kind mesh --bodies 60 --steps 150 --without-margin",
    ),
];
