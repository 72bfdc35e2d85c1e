//! Bodies in contact with a probe, by kind of contact.

use std::collections::BTreeMap;

use rand::{Rng, RngExt};

use super::DrawnCase;
use crate::case::Frame;
use crate::draw::bodies::{ContactSpec, TurnKind, probe};
use crate::draw::contact::ContactKind;
use crate::draw::forms::{self, Form, FormError};
use sdop::volume::{Axes, DirectionSet};

/// Small forms, flat ones among them.
pub fn forms(rng: &mut impl Rng, count: usize) -> Vec<Form> {
    let sized = |name: &str, size: &str, value: f64| Form {
        sizes: BTreeMap::from([(size.to_owned(), value)]),
        ..Form::of(name, [-1.0, 1.0])
    };
    let pool = [
        Form::of("tetrahedron", [-1.0, 1.0]),
        Form::of("box", [-1.0, 1.0]),
        Form::of("triangle", [-1.0, 1.0]),
        Form::of("segment", [-1.0, 1.0]),
        Form::of("plate", [-1.0, 1.0]),
        Form::of("l-shape", [-1.0, 1.0]),
        sized("icosphere", "subdivisions", 0.0),
        sized("needle", "sides", 4.0),
    ];
    (0..count).map(|_| pool[rng.random_range(0..pool.len())].clone()).collect()
}

/// The or-DOP of a case: every set of directions has its turn, along both kinds of axes.
pub fn volumes(number: u32) -> (DirectionSet, Axes) {
    let k = [DirectionSet::K18, DirectionSet::K14, DirectionSet::K26, DirectionSet::K6];
    let axes = if (number / 4).is_multiple_of(2) { Axes::Principal } else { Axes::Model };
    (k[number as usize % k.len()], axes)
}

/// A dynamic probe among static partners, each in contact with it.
pub fn around_a_probe(
    kind: ContactKind,
    turn: TurnKind,
    origin: Option<[f64; 2]>,
    number: u32,
    partners: usize,
    rng: &mut impl Rng,
) -> Result<DrawnCase, FormError> {
    let (k, axes) = volumes(number);
    let mut forms = forms(rng, 3);
    if number % 4 == 3 {
        // Balls whose centres turn with their bodies.
        for form in &mut forms {
            form.radius = None;
            form.offset = Some([0.7, -0.3, 0.4]);
        }
    }
    let shapes = forms::build(&forms, 1, k, axes, rng)?;
    let spec = ContactSpec {
        kinds: vec![kind],
        turn,
        gap: [0.0, 0.25, 1.0, 4.0][number as usize / 2 % 4],
        origin,
        ..ContactSpec::default()
    };
    let shape = rng.random_range(0..shapes.built.len());
    let bodies = probe(&shapes, &spec, shape, partners, rng);
    let frames = vec![Frame::fitted(bodies, &shapes.built)];
    Ok(DrawnCase { shapes: shapes.built, frames })
}
