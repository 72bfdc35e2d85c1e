//! The experiments with the filter in physics engines, `benches/engines/rapier` and `bullet`.

use super::step::ExperimentStep;

/// A line per run: the file that it becomes, and its arguments.
macro_rules! runs {
    ($(#[$doc:meta])* $name:ident = $engine:ident { $($file:literal $arguments:literal)+ }) => {
        $(#[$doc])*
        pub(super) const $name: &[ExperimentStep] = &[$(ExperimentStep::$engine(concat!($file, ".json"), $arguments)),+];
    };
}

runs! {
    /// Contacts with the filter and without: counts, which no load changes.
    RAPIER_CONTACTS = Rapier {
        "pile-mesh-100-dispatcher-f32"          "check --scene pile --kind mesh --bodies 100 --steps 1000 --mode dispatcher --real f32"
        "pile-mesh-500-dispatcher-f32"          "check --scene pile --kind mesh --bodies 500 --steps 200 --mode dispatcher --real f32"
        "pile-hull-500-dispatcher-f32"          "check --scene pile --kind hull --bodies 500 --steps 1000 --mode dispatcher --real f32"
        "pile-hull-200-dispatcher-f64"          "check --scene pile --kind hull --bodies 200 --steps 1000 --mode dispatcher --real f64"
        "pile-hull-5000-dispatcher-f32"         "check --scene pile --kind hull --bodies 5000 --steps 60 --mode dispatcher --real f32"
        "pile-box-500-dispatcher-f32"           "check --scene pile --kind box --bodies 500 --steps 300 --mode dispatcher --real f32"
        "pile-ball-500-dispatcher-f32"          "check --scene pile --kind ball --bodies 500 --steps 300 --mode dispatcher --real f32"
        "tumbler-compound-100-dispatcher-f32"   "check --scene tumbler --kind compound --bodies 100 --steps 1000 --mode dispatcher --real f32"
        "tumbler-mesh-100-dispatcher-f32"       "check --scene tumbler --kind mesh --bodies 100 --steps 300 --mode dispatcher --real f32"
        "conveyor-colliders-100-dispatcher-f32" "check --scene conveyor --kind colliders --bodies 100 --steps 1000 --mode dispatcher --real f32"
        "cloud-mesh-300-dispatcher-f32"         "check --scene cloud --kind mesh --bodies 300 --steps 1000 --mode dispatcher --real f32"
        "zoo-hull-200-dispatcher-f32"           "check --scene zoo --kind hull --bodies 200 --steps 1000 --mode dispatcher --real f32"
        "zoo-hull-200-dispatcher-f64"           "check --scene zoo --kind hull --bodies 200 --steps 300 --mode dispatcher --real f64"
        "pile-mesh-100-hook-f32"                "check --scene pile --kind mesh --bodies 100 --steps 300 --mode hook --real f32"
        "pile-hull-500-hook-f32"                "check --scene pile --kind hull --bodies 500 --steps 200 --mode hook --real f32"
        "pile-hull-200-hook-f64"                "check --scene pile --kind hull --bodies 200 --steps 300 --mode hook --real f64"
        "tumbler-compound-100-hook-f32"         "check --scene tumbler --kind compound --bodies 100 --steps 300 --mode hook --real f32"
        "conveyor-colliders-100-hook-f32"       "check --scene conveyor --kind colliders --bodies 100 --steps 300 --mode hook --real f32"
        "cloud-mesh-300-hook-f32"               "check --scene cloud --kind mesh --bodies 300 --steps 150 --mode hook --real f32"
        "zoo-hull-200-hook-f32"                 "check --scene zoo --kind hull --bodies 200 --steps 300 --mode hook --real f32"
        "zoo-hull-200-hook-f64"                 "check --scene zoo --kind hull --bodies 200 --steps 200 --mode hook --real f64"
        "margin-left-out-dispatcher"            "check --scene pile --kind hull --bodies 60 --steps 150 --mode dispatcher --without-margin"
        "margin-left-out-hook"                  "check --scene pile --kind hull --bodies 60 --steps 150 --mode hook --without-margin"
    }
}

runs! {
    /// Steps of the engine in turns.
    RAPIER_TIMES = Rapier {
        "pile-hull-500"     "measure --scene pile --kind hull --bodies 500 --steps 300 --calibrate 60"
        "pile-mesh-100"     "measure --scene pile --kind mesh --bodies 100 --steps 300 --calibrate 60"
        "tumbler-hull-500"  "measure --scene tumbler --kind hull --bodies 500 --steps 150 --calibrate 60"
        "tumbler-mesh-100"  "measure --scene tumbler --kind mesh --bodies 100 --steps 150 --calibrate 60"
        "cloud-mesh-300"    "measure --scene cloud --kind mesh --bodies 300 --steps 200 --calibrate 60 --modes plain,dispatcher"
        "conveyor-hull-100" "measure --scene conveyor --kind hull --bodies 100 --steps 600 --calibrate 60 --modes plain,dispatcher"
        "pile-hull-5000"    "measure --scene pile --kind hull --bodies 5000 --steps 40 --calibrate 60 --modes plain,dispatcher"
        "pile-mesh-40-fine" "measure --scene pile --kind mesh --bodies 40 --steps 100 --calibrate 60 --detail fine --modes plain,dispatcher"
        "pile-box-500"      "measure --scene pile --kind box --bodies 500 --steps 300 --calibrate 60 --modes plain,dispatcher"
        "pile-ball-500"     "measure --scene pile --kind ball --bodies 500 --steps 300 --calibrate 60 --modes plain,dispatcher"
    }
}

runs! {
    /// Judged and timed.
    BULLET = Bullet {
        "pile-hull-100"               "--scene pile --kind hull --bodies 100 --steps 1000"
        "pile-hull-500"               "--scene pile --kind hull --bodies 500 --steps 1000"
        "pile-hull-5000"              "--scene pile --kind hull --bodies 5000 --steps 60"
        "pile-mesh-100"               "--scene pile --kind mesh --bodies 100 --steps 1000"
        "pile-mesh-500"               "--scene pile --kind mesh --bodies 500 --steps 100"
        "pile-mesh-40-fine"           "--scene pile --kind mesh --bodies 40 --steps 100 --detail fine"
        "pile-box-500"                "--scene pile --kind box --bodies 500 --steps 300"
        "pile-ball-500"               "--scene pile --kind ball --bodies 500 --steps 300"
        "tumbler-hull-500"            "--scene tumbler --kind hull --bodies 500 --steps 300"
        "tumbler-mesh-100"            "--scene tumbler --kind mesh --bodies 100 --steps 300"
        "cloud-hull-300"              "--scene cloud --kind hull --bodies 300 --steps 1000"
        "cloud-mesh-300"              "--scene cloud --kind mesh --bodies 300 --steps 1000"
        "pile-hull-60-without-margin" "--scene pile --kind hull --bodies 60 --steps 150 --without-margin"
        "pile-mesh-60-without-margin" "--scene pile --kind mesh --bodies 60 --steps 150 --without-margin"
    }
}
