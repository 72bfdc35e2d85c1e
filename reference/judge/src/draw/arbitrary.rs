//! Strategies of proptest that draw near-touching configurations on purpose (feature `proptest`).
//!
//! Uniformly drawn bodies are far apart or deep inside one another. Here two bodies are put into
//! contact ([`Contact`]). Proptest shrinks a failure towards equal bodies without rotation and with
//! a gap of zero.

use proptest::prelude::*;

use crate::draw::contact::{Contact, ContactKind, PlacedShape};

/// A quaternion: any direction with a norm of 0.1 to 2, small integers, or a tiny or huge norm.
pub fn rotation() -> impl Strategy<Value = [f32; 4]> {
    let any = prop::array::uniform4(-1.0_f32..1.0);
    let integers = prop::array::uniform4(-2_i8..=2).prop_map(|q| q.map(f32::from));
    let scaled = (prop::array::uniform4(-1.0_f32..1.0), -60_i32..60)
        .prop_map(|(q, e)| q.map(|x| x * 2_f32.powi(e)));
    prop_oneof![3 => integers, 6 => any, 1 => scaled]
        .prop_filter("a rotation has a norm", |q| q.iter().any(|x| x.abs() > 1e-20))
}

/// A translation: at the origin, nearby, or up to 2⁴⁰ away.
pub fn translation() -> impl Strategy<Value = [f32; 3]> {
    let far = (prop::array::uniform3(-1.0_f32..1.0), 0_i32..40)
        .prop_map(|(t, e)| t.map(|x| x * 2_f32.powi(e)));
    prop_oneof![2 => Just([0.0; 3]), 3 => prop::array::uniform3(-10.0_f32..10.0), 2 => far]
}

/// A contact of any kind with a gap of up to 8u of the bodies' reach either way.
pub fn contact() -> impl Strategy<Value = Contact> {
    let direction = prop::array::uniform3(-1.0_f64..1.0)
        .prop_filter("a direction", |d| d.iter().any(|x| x.abs() > 1e-3));
    let gap = prop_oneof![Just(0.0), -8.0..8.0];
    (prop::sample::select(&ContactKind::ALL[..]), [0_u32..64, 0..64], direction, gap)
        .prop_map(|(kind, pick, direction, gap)| Contact { kind, pick, direction, gap })
}

/// A body in one of `shapes` shapes.
pub fn placed(shapes: usize) -> impl Strategy<Value = PlacedShape> {
    (0..shapes, rotation(), translation()).prop_map(|(shape, rotation, translation)| PlacedShape {
        shape,
        rotation,
        translation,
    })
}

/// A body and, for each of up to `most` partners, a shape, an orientation and the contact that
/// places it: feed them to [`Contact::place`] one by one.
pub fn probe(
    shapes: usize,
    most: usize,
) -> impl Strategy<Value = (PlacedShape, Vec<(usize, [f32; 4], Contact)>)> {
    let partner = (0..shapes, rotation(), contact());
    (placed(shapes), prop::collection::vec(partner, 1..=most))
}
