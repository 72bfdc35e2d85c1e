//! [`SlabTables`]: the inflated slabs of all shapes, as rows that lanes load.
//!
//! A shape has two rows. For its n-th direction d (in the order of its set), number 2n is the end
//! in the direction d, hi, and number 2n + 1 the one in the direction −d, −lo. Both are support
//! values, so both are positive.

use crate::rounding::pose::norm;
use crate::rounding::slab::inflate_slab;
use crate::settings::K26;
use crate::simd::ROW;
use crate::volume::{DirectionSet, OrDop, Shape};

/// Floats in a shape's table, which has two rows.
pub const FLOATS_PER_TABLE: usize = 2 * ROW;

/// All 13 directions in the order of K26, as integer coefficients over the basis.
pub const COEFFICIENTS: [[i8; 3]; 13] = K26;

/// The members of the set of k half-spaces among the 13 directions, in its order.
#[must_use]
pub const fn members_of(k: usize) -> &'static [usize] {
    match k {
        6 => &[0, 1, 2],
        14 => &[0, 1, 2, 9, 10, 11, 12],
        18 => &[0, 1, 2, 3, 4, 5, 6, 7, 8],
        _ => &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12],
    }
}

/// The index of a member in the set of k half-spaces, if it is in it.
#[must_use]
pub const fn place_of(member: usize, k: usize) -> Option<usize> {
    match (k, member) {
        (_, 0..3) | (18 | 26, 0..9) | (26, 0..13) => Some(member),
        (14, 9..13) => Some(member - 6),
        _ => None,
    }
}

/// Unrolls `$body` for every direction `$member` of the set of `$k` half-spaces, at index `$place`
/// in it. A loop would keep vectors in memory because of its index, and take twice the time.
macro_rules! each_direction {
    ($k:expr, |$member:ident, $place:ident| $body:block) => {
        each_direction!(@ $k, |$member, $place| $body, 0 1 2 3 4 5 6 7 8 9 10 11 12)
    };
    (@ $k:expr, |$member:ident, $place:ident| $body:block, $($n:literal)*) => {
        $(if let Some($place) = $crate::overlap::ordop::table::place_of($n, $k) {
            let $member = $n;
            $body
        })*
    };
}
pub(super) use each_direction;

/// The tables of all shapes, one after the other.
#[derive(Clone, Debug)]
pub struct SlabTables {
    directions: DirectionSet,
    rows: Vec<[f32; ROW]>,
    columns: Vec<[f32; ROW]>,
}

impl SlabTables {
    /// Builds the tables of `shapes`, each with the or-DOP that `ordop` returns. All have the same
    /// directions.
    pub fn new<'a>(
        directions: DirectionSet,
        shapes: impl IntoIterator<Item = (&'a Shape, &'a OrDop)>,
    ) -> Self {
        let mut tables =
            Self { directions, rows: Vec::new(), columns: vec![[0.0; ROW]; directions.k()] };
        for (shape, ordop) in shapes {
            tables.push(ordop, shape.ball.centre, shape.reach);
        }
        tables
    }

    /// Appends the table of an or-DOP about the ball's `centre`, all of whose points are within
    /// `reach` of the body origin.
    pub(crate) fn push(&mut self, ordop: &OrDop, centre: [f32; 3], reach: f32) {
        let (shape, table) = (self.rows.len() / 2, table(ordop, centre, reach));
        self.rows.extend_from_slice(table.as_chunks::<ROW>().0);
        if shape < ROW {
            for (column, end) in self.columns.iter_mut().zip(table) {
                column[shape] = end;
            }
        } else {
            self.columns.clear();
        }
    }

    /// Replaces a table; arguments are those of [`Self::push`].
    pub(crate) fn set(&mut self, shape: usize, ordop: &OrDop, centre: [f32; 3], reach: f32) {
        let table = table(ordop, centre, reach);
        self.rows[2 * shape..2 * shape + 2].copy_from_slice(table.as_chunks::<ROW>().0);
        for (column, end) in self.columns.iter_mut().zip(table) {
            column[shape] = end;
        }
    }

    /// Keeps the first `shapes` tables, and frees other memory.
    pub(crate) fn shrink_to(&mut self, shapes: usize) {
        self.rows.truncate(2 * shapes);
        self.rows.shrink_to_fit();
        if shapes <= ROW && self.columns.is_empty() {
            let mut columns = vec![[0.0; ROW]; self.directions.k()];
            for (shape, table) in self.rows.chunks_exact(2).enumerate() {
                for (column, &end) in columns.iter_mut().zip(table.as_flattened()) {
                    column[shape] = end;
                }
            }
            self.columns = columns;
        }
    }

    /// The directions that all tables have.
    #[must_use]
    pub fn directions(&self) -> DirectionSet {
        self.directions
    }

    /// All rows. Shape s has rows 2s and 2s + 1.
    #[must_use]
    pub fn rows(&self) -> &[[f32; ROW]] {
        &self.rows
    }

    /// For up to [`ROW`] shapes, the transposed table: row n has number n of every shape. Otherwise
    /// empty.
    #[must_use]
    pub fn columns(&self) -> &[[f32; ROW]] {
        &self.columns
    }

    /// One shape's entries.
    pub(crate) fn shape(&self, shape: usize) -> &[f32] {
        self.rows[2 * shape..2 * shape + 2].as_flattened()
    }
}

fn table(ordop: &OrDop, centre: [f32; 3], reach: f32) -> [f32; FLOATS_PER_TABLE] {
    let mut table = [0.0; FLOATS_PER_TABLE];
    let columns = ordop.basis.columns;
    let scale = norm(columns[0]);
    for (slab, &member) in members_of(2 * ordop.lo.len()).iter().enumerate() {
        let coefficients = COEFFICIENTS[member];
        let direction = std::array::from_fn(|axis| {
            (0..3).map(|j| f32::from(coefficients[j]) * columns[j][axis]).sum()
        });
        let (lo, hi) =
            inflate_slab(ordop.lo[slab], ordop.hi[slab], direction, scale, centre, reach);
        (table[2 * slab], table[2 * slab + 1]) = (hi, -lo);
    }
    table
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::mesh::shapes::ProceduralShape;
    use crate::volume::ShapeSpec;

    /// Members are the directions of each set.
    #[test]
    fn members_match_each_set() {
        for &directions in DirectionSet::ALL {
            let members = members_of(directions.k()).iter();
            let places = members.clone().map(|&m| place_of(m, directions.k()));
            assert!(places.eq((0..directions.slabs()).map(Some)));
            let among = (0..13).filter_map(|m| place_of(m, directions.k()));
            assert_eq!(among.count(), directions.slabs());
            let coefficients: Vec<_> = members.map(|&member| COEFFICIENTS[member]).collect();
            assert_eq!(coefficients, directions.coefficients());
        }
    }

    /// Rows and columns give the same numbers.
    #[test]
    fn columns_transpose_the_rows() {
        let box_of = |z: u16| {
            let mesh = ProceduralShape::Box { x: 1.0, y: 2.0, z: f32::from(z) };
            Shape::build(&mesh.build().unwrap(), &ShapeSpec::default()).unwrap()
        };
        let mut tables = SlabTables::new(box_of(1).ordop.directions, []);
        for shapes in 1..=ROW + 2 {
            let shape = box_of(shapes as u16);
            tables.push(&shape.ordop, shape.ball.centre, shape.reach);
            assert_eq!(tables.rows().len(), 2 * shapes);
            assert_eq!(tables.columns().is_empty(), shapes > ROW, "{shapes}");
            for (number, column) in tables.columns().iter().enumerate() {
                let own = (0..shapes).map(|shape| tables.shape(shape)[number]);
                assert!(column[..shapes].iter().copied().eq(own), "{number} of {shapes}");
            }
        }
    }
}
