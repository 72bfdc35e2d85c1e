//! Two bodies with any poses within the contract: what the exact reference reports, every strategy reports.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use sdop::scene::bodies::Bodies;
use sdop::scene::contract::check_bodies;
use sdop::simd::Level;
use sdop::verify::contact::Placed;
use sdop::verify::draw::add;
use sdop::verify::rounds::{Ledger, check, ways};
use sdop::verify::{Answers, Predicate, Shapes};
use sdop::mesh::ProceduralShape;
use sdop::volume::{Axes, DirectionSet, Origin, Shape, ShapeSpec};

const NAMES: [&str; 4] = ["box", "l-shape", "needle", "plate"];
const SETS: [DirectionSet; 4] = [
    DirectionSet::K6,
    DirectionSet::K14,
    DirectionSet::K18,
    DirectionSet::K26,
];

static SHAPES: LazyLock<Vec<Shapes>> = LazyLock::new(|| {
    let build = |&directions| {
        let spec = ShapeSpec {
            origin: Origin::File,
            directions,
            axes: Axes::Principal,
            ..ShapeSpec::default()
        };
        let shapes = NAMES.map(|name| {
            let mesh = ProceduralShape::default_of(name).and_then(|shape| shape.build().ok());
            mesh.and_then(|mesh| Shape::build(&mesh, &spec).ok())
        });
        Shapes::new(shapes.into_iter().flatten().collect()).expect("procedural shapes are sound")
    };
    SETS.iter().map(build).collect()
});

/// Seven f32 from the bytes as they are: NaN, infinities and subnormals included.
fn pose(bytes: &[u8]) -> Placed {
    let number = |i: usize| f32::from_le_bytes(std::array::from_fn(|b| bytes[4 * i + b]));
    Placed {
        shape: 0,
        rotation: std::array::from_fn(number),
        translation: std::array::from_fn(|i| number(4 + i)),
    }
}

fuzz_target!(|data: &[u8]| {
    if data.len() < 59 {
        return;
    }
    let set = usize::from(data[0]) % SETS.len();
    let mut bodies = Bodies::default();
    for body in 0..2 {
        let mut placed = pose(&data[3 + 28 * body..]);
        placed.shape = usize::from(data[1 + body]) % NAMES.len();
        add(&mut bodies, &placed, true);
    }
    let shapes = &SHAPES[set];
    if check_bodies(&bodies, &shapes.built).is_err() {
        return;
    }
    let answers = [Answers::judge(shapes, &bodies, SETS[set], &Predicate::ALL).expect("within the contract")];
    let mut ledger = Ledger::default();
    for (n, way) in ways(SETS[set], Axes::Principal).iter().enumerate() {
        let levels = Level::available();
        let level = levels[n % levels.len()];
        let frames = [bodies.clone()];
        check(shapes, &frames, &answers, way, level, &mut ledger).expect("settings fit");
    }
    assert_eq!(ledger.missed(), 0, "{:?}", ledger.failures.first().map(|f| &f.settings));
});
