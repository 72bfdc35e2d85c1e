//! Two bodies with any poses within the contract, or placed in contact: every strategy reports what
//! the exact reference reports.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use sdop::Tier;
use sdop::bodies::Bodies;
use sdop::mesh::ProceduralShape;
use sdop::volume::check_bodies;
use sdop::volume::{Axes, DirectionSet, Origin, Shape, ShapeSpec};
use sdop_judge::configuration::Rotation;
use sdop_judge::draw::bodies::add;
use sdop_judge::draw::contact::{Contact, ContactKind, PlacedShape};
use sdop_judge::truth::{Answers, Predicate, Shapes};
use sdop_judge::verify::{Ledger, Run};

const NAMES: [&str; 4] = ["box", "l-shape", "needle", "plate"];

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
    DirectionSet::ALL.iter().map(build).collect()
});

/// Seven f32 from the bytes as they are: NaN, infinities and subnormals included.
fn pose(bytes: &[u8]) -> PlacedShape {
    let number = |i: usize| f32::from_le_bytes(std::array::from_fn(|b| bytes[4 * i + b]));
    PlacedShape {
        shape: 0,
        rotation: std::array::from_fn(number),
        translation: std::array::from_fn(|i| number(4 + i)),
    }
}

/// Which volumes and shapes, how the bodies touch, and two poses.
const HEAD: usize = 7;
const BYTES: usize = HEAD + 2 * 28;

/// The translation that brings the second body in touch with the first, along the direction that
/// its bytes say; `None`, and bodies stay where they are, for seven in sixteen values of the head's
/// second byte.
fn in_touch(
    shapes: &Shapes,
    head: &[u8],
    first: &PlacedShape,
    second: &PlacedShape,
) -> Option<[f32; 3]> {
    let contact = Contact {
        kind: *ContactKind::ALL.get(usize::from(head[1] % 16))?,
        pick: [head[4], head[5]].map(u32::from),
        direction: second.translation.map(f64::from),
        gap: f64::from(head[6].cast_signed()) / 16.0,
    };
    contact.place(shapes, first, second.shape, second.rotation)
}

fuzz_target!(|data: &[u8]| {
    if data.len() < BYTES {
        return;
    }
    let (head, poses) = data.split_at(HEAD);
    let set = usize::from(head[0]) % DirectionSet::ALL.len();
    let shapes = &SHAPES[set];
    let [first, mut second] = [0, 1].map(|body| {
        let mut placed = pose(&poses[28 * body..]);
        placed.shape = usize::from(head[2 + body]) % NAMES.len();
        placed
    });
    if let Some(translation) = in_touch(shapes, head, &first, &second) {
        second.translation = translation;
    }
    let mut bodies = Bodies::default();
    add(&mut bodies, &first, true);
    add(&mut bodies, &second, true);
    if check_bodies(&bodies, &shapes.built).is_err() {
        return;
    }
    let answers = [Answers::judge(shapes, &bodies, DirectionSet::ALL[set], &Predicate::ALL)
        .expect("within the contract")];
    let mut ledger = Ledger::default();
    let modes = Rotation::new(&Tier::available()).turn(u64::from(head[1] / 16));
    let run = Run { shapes, frames: &[bodies], answers: &answers };
    run.check((DirectionSet::ALL[set], Axes::Principal), &modes, &mut ledger)
        .expect("settings fit");
    assert_eq!(
        (ledger.missed(), ledger.differing()),
        (0, 0),
        "{:?}",
        ledger.failures.first().map(|f| &f.settings)
    );
});
