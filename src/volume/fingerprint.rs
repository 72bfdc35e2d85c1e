//! One hash over every volume of a scene: results of two machines are comparable only where it agrees.

use sha2::{Digest, Sha256};

use super::Shape;

/// SHA-256, in hexadecimal, of each shape's ball (c, r), basis (three columns), lo and hi, as little-endian f32 in order.
#[must_use]
pub fn volumes_sha256(shapes: &[Shape]) -> String {
    let mut hash = Sha256::new();
    let mut write = |values: &[f32]| values.iter().for_each(|v| hash.update(v.to_le_bytes()));
    for shape in shapes {
        write(&shape.ball.centre.to_array());
        write(&[shape.ball.radius]);
        for column in shape.ordop.basis.columns {
            write(&column.to_array());
        }
        write(&shape.ordop.lo);
        write(&shape.ordop.hi);
    }
    hash.finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}
