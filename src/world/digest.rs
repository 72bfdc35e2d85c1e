//! Digests by which a restored world recognises its shapes, and a compound its own, the same on
//! every machine.

use crate::volume::Shape;

/// FNV-1a over words: shapes that differ in one word have different digests, others with a
/// probability of 1 − 2⁻⁶⁴.
struct Digest(u64);

impl Digest {
    fn word(&mut self, word: u32) {
        self.0 = (self.0 ^ u64::from(word)).wrapping_mul(0x0000_0100_0000_01b3);
    }

    /// Adds a number; −0 and 0 differ.
    fn number(&mut self, number: f32) {
        self.word(number.to_bits());
    }
}

/// The digest of all numbers of a shape that decide its pairs, and of its triangles.
pub(crate) fn of(shape: &Shape) -> u64 {
    let mut digest = Digest(0xcbf2_9ce4_8422_2325);
    digest.word(shape.vertices.len() as u32);
    for vertex in &shape.vertices {
        (0..3).for_each(|axis| digest.number(vertex[axis]));
    }
    digest.word(shape.triangles.len() as u32);
    for corner in shape.triangles.as_flattened() {
        digest.word(*corner);
    }
    (0..3).for_each(|axis| digest.number(shape.ball.centre[axis]));
    digest.number(shape.ball.radius);
    digest.number(shape.reach);
    for offset in shape.pose_offset.map(f64::to_bits) {
        digest.word(offset as u32);
        digest.word((offset >> 32) as u32);
    }
    digest.word(shape.ordop.directions.k() as u32);
    for column in &shape.ordop.basis.columns {
        (0..3).for_each(|axis| digest.number(column[axis]));
    }
    for &end in shape.ordop.lo.iter().chain(&shape.ordop.hi) {
        digest.number(end);
    }
    digest.0
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::mesh::ProceduralShape;
    use crate::volume::{DirectionSet, ShapeSpec};

    #[test]
    fn whatever_differs_in_a_shape_shows() {
        let mesh = ProceduralShape::default_of("box").unwrap().build().unwrap();
        let shape = Shape::build(&mesh, &ShapeSpec::default()).unwrap();
        let mut other = shape.clone();
        other.name = "another name".to_owned();
        assert_eq!(of(&shape), of(&other));
        type Change = fn(&mut Shape);
        let changes: [Change; 7] = [
            |shape| shape.vertices[3][1] = shape.vertices[3][1].next_up(),
            |shape| shape.triangles[2].rotate_left(1),
            |shape| shape.ball.centre[2] = 1.0e-30,
            |shape| shape.ball.radius = shape.ball.radius.next_up(),
            |shape| shape.reach = shape.reach.next_up(),
            |shape| shape.ordop.basis.columns[1][0] += 1.0,
            |shape| *shape = shape.clone().with_directions(DirectionSet::K26),
        ];
        for (number, change) in changes.into_iter().enumerate() {
            let mut other = shape.clone();
            change(&mut other);
            assert_ne!(of(&shape), of(&other), "change {number}");
        }
    }
}
