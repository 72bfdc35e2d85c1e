//! Inflated slabs as look-up tables: for each slab group, the end that an octant of directions faces.
//!
//! A group is an unsigned pattern of coordinates: the three axes, the three pairs of axes (face diagonals), and all
//! three (cube diagonals). The signs of a direction pick one of the group's up to eight slab ends, so a support needs no
//! branch: `h = table[8·group + octant]`. Unused groups of a smaller k hold zeros that nothing reads.

use crate::rounding::pose::norm;
use crate::rounding::slab::inflate_slab;
use crate::volume::{DirectionSet, OrDop, Shape};

/// Floats in one shape's table.
pub const TABLE: usize = 64;

/// Groups in a table: axes x, y, z; pairs xy, xz, yz; the cube diagonals.
pub const GROUPS: usize = 7;
/// First group of the pairs.
pub const PAIRS: usize = 3;
/// The group of the cube diagonals.
pub const DIAGONALS: usize = 6;

/// Where a direction's own slab ends stand in a table.
#[derive(Clone, Copy, Debug)]
pub struct OwnSlab {
    /// The group.
    pub group: usize,
    /// The octant of the direction itself: the upper end.
    pub plus: usize,
    /// The octant of its opposite: minus the lower end.
    pub minus: usize,
}

/// All 13 directions in the order of K26, as integer coefficients over the basis.
pub const COEFFICIENTS: [[i8; 3]; 13] = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 1, 0],
    [1, -1, 0],
    [1, 0, 1],
    [1, 0, -1],
    [0, 1, 1],
    [0, 1, -1],
    [1, 1, 1],
    [-1, 1, 1],
    [1, -1, 1],
    [-1, -1, 1],
];

/// The slab of each of the 13 directions.
pub const OWN: [OwnSlab; 13] = own_slabs();

/// Which of the 13 directions the set of k half-spaces has, in its order.
#[must_use]
pub const fn members_of(k: usize) -> &'static [usize] {
    match k {
        6 => &[0, 1, 2],
        14 => &[0, 1, 2, 9, 10, 11, 12],
        18 => &[0, 1, 2, 3, 4, 5, 6, 7, 8],
        _ => &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12],
    }
}

const fn own_slabs() -> [OwnSlab; 13] {
    let mut own = [OwnSlab {
        group: 0,
        plus: 0,
        minus: 0,
    }; 13];
    let mut i = 0;
    while i < 13 {
        let [x, y, z] = COEFFICIENTS[i];
        let group = match (x != 0, y != 0, z != 0) {
            (true, false, false) => 0,
            (false, true, false) => 1,
            (false, false, true) => 2,
            (true, true, false) => 3,
            (true, false, true) => 4,
            (false, true, true) => 5,
            _ => DIAGONALS,
        };
        let plus = (x < 0) as usize | ((y < 0) as usize) << 1 | ((z < 0) as usize) << 2;
        let used = (x != 0) as usize | ((y != 0) as usize) << 1 | ((z != 0) as usize) << 2;
        own[i] = OwnSlab {
            group,
            plus,
            minus: plus ^ used,
        };
        i += 1;
    }
    own
}

/// The tables of all shapes, one behind the other.
#[derive(Clone, Debug)]
pub struct SlabTables {
    directions: DirectionSet,
    entries: Vec<f32>,
}

impl SlabTables {
    /// Builds the tables of `shapes`, each with its or-DOP as `ordop` picks it; all have the same directions.
    pub fn new<'a>(
        directions: DirectionSet,
        shapes: impl IntoIterator<Item = (&'a Shape, &'a OrDop)>,
    ) -> Self {
        let entries = shapes
            .into_iter()
            .flat_map(|(shape, ordop)| table(ordop, shape.ball.centre.to_array(), shape.reach))
            .collect();
        Self {
            directions,
            entries,
        }
    }

    /// Appends a table: an or-DOP about the ball's `centre`, no point of it farther than `reach` from the body origin.
    pub(crate) fn push(&mut self, ordop: &OrDop, centre: [f32; 3], reach: f32) {
        self.entries.extend(table(ordop, centre, reach));
    }

    /// The directions that all tables have.
    #[must_use]
    pub fn directions(&self) -> DirectionSet {
        self.directions
    }

    /// All entries; shape s begins at s·[`TABLE`].
    #[must_use]
    pub fn entries(&self) -> &[f32] {
        &self.entries
    }

    /// One shape's entries.
    #[inline(always)]
    pub(crate) fn shape(&self, shape: u32) -> &[f32; TABLE] {
        let (tables, _) = self.entries.as_chunks::<TABLE>();
        &tables[shape as usize]
    }
}

fn table(ordop: &OrDop, centre: [f32; 3], reach: f32) -> [f32; TABLE] {
    let mut table = [0.0; TABLE];
    let columns = ordop.basis.columns.map(|column| column.to_array());
    let scale = norm(columns[0]);
    for (slab, &member) in members_of(2 * ordop.lo.len()).iter().enumerate() {
        let coefficients = COEFFICIENTS[member];
        let direction = std::array::from_fn(|axis| {
            (0..3)
                .map(|j| f32::from(coefficients[j]) * columns[j][axis])
                .sum()
        });
        let (lo, hi) = inflate_slab(
            ordop.lo[slab],
            ordop.hi[slab],
            direction,
            scale,
            centre,
            reach,
        );
        let OwnSlab { group, plus, minus } = OWN[member];
        // Octants that differ only in coordinates the group doesn't use face the same end.
        let used = plus ^ minus;
        for octant in 0..8 {
            if octant & used == plus & used {
                table[8 * group + octant] = hi;
            } else if octant & used == minus & used {
                table[8 * group + octant] = -lo;
            }
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_slabs_and_members_agree_with_the_coefficients() {
        for (own, coefficients) in OWN.iter().zip(COEFFICIENTS) {
            let sign = |octant: usize, axis: usize| if octant >> axis & 1 == 1 { -1 } else { 1 };
            for (axis, c) in coefficients.into_iter().enumerate() {
                assert_eq!(c, c.abs() * sign(own.plus, axis));
                assert_eq!(-c, c.abs() * sign(own.minus, axis));
            }
        }
        // Every octant of a used group is the plus or minus end of exactly one member.
        for octant in 0..8usize {
            let facing = OWN.iter().filter(|own| {
                own.group == DIAGONALS && (own.plus == octant || own.minus == octant)
            });
            assert_eq!(facing.count(), 1);
        }
        assert_eq!(members_of(18).len(), 9);
        assert_eq!(members_of(14).len(), 7);
    }
}
