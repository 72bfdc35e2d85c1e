//! Tests one pair at a time, without a set of bodies, for engines that call back with two shapes
//! and their relative pose.
//!
//! A [`World`](super::World) finds the pairs of all bodies and tests them a vector at a time; here
//! another broad phase has found a pair, and its two or-DOPs are tested by the same arithmetic.
//! That takes about ten times as long per pair as a world's test, and still a fraction of a
//! narrow-phase check.

use super::margins::check_margin;
use crate::bodies::contract::{ContractError, check_pose};
use crate::culler::FAR_SHAPE_HELP;
use crate::overlap::ordop::{OrDopColumns, SlabTables};
use crate::settings::Overlap;
use crate::simd::{ROW, in_default_mode};
use crate::update::{RowsByNumber, ShapeFrame};
use crate::volume::check_shape;
use crate::volume::{DirectionSet, OrDop, Shape};

/// The or-DOPs of shapes, with and without margins.
///
/// ```
/// use sdop::mesh;
/// use sdop::volume::{DirectionSet, Shape, ShapeSpec};
/// use sdop::world::PairTest;
///
/// let cow = mesh::read("data/meshes/spot.tri", &mesh::ReadOptions::default())?;
/// let mut test = PairTest::new(DirectionSet::K18);
/// let cow = test.add(&Shape::build(&cow, &ShapeSpec::default())?)?;
/// let wider = test.grown(cow, 1.5)?;
/// let unturned = [0.0, 0.0, 0.0, 1.0];
/// assert!(!test.may_touch(cow, cow, unturned, [1.5, 0.0, 0.0]));
/// assert!(test.may_touch(wider, cow, unturned, [1.5, 0.0, 0.0]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PairTest {
    models: Vec<Model>,
    tables: SlabTables,
}

#[derive(Clone, Debug)]
struct Model {
    ordop: OrDop,
    frame: ShapeFrame,
    /// The row of a body at the identity pose: the first of every pair.
    unturned: [f32; ROW],
}

impl PairTest {
    /// A test without shapes. All shapes will have slabs along `directions`.
    #[must_use]
    pub fn new(directions: DirectionSet) -> Self {
        Self { models: Vec::new(), tables: SlabTables::new(directions, []) }
    }

    /// Adds a shape and returns its number for tests.
    ///
    /// # Errors
    /// The shape is larger than 2⁶⁰, or far from its origin ([`Shape::pose_offset`]).
    pub fn add(&mut self, shape: &Shape) -> Result<u32, ContractError> {
        check_shape(self.models.len(), 0, std::slice::from_ref(shape))?;
        if shape.is_far() {
            return Err(ContractError {
                body: self.models.len(),
                quantity: "shape",
                value: format!("{} lies far from the origin of its file", shape.name),
                hint: FAR_SHAPE_HELP,
            });
        }
        let directions = self.tables.directions();
        let (ordop, frame) = in_default_mode(|| {
            let ordop = shape.slabs(shape.ordop.basis, directions);
            let frame = ShapeFrame::new(shape, &ordop.basis);
            (ordop, frame)
        });
        Ok(self.push(ordop, frame))
    }

    /// Adds a shape grown by a margin and returns its number. Each call adds one, so keep the
    /// number.
    ///
    /// # Errors
    /// No shape has the number, or the margin is negative, not finite, or larger than 2⁶⁰ together
    /// with the shape.
    pub fn grown(&mut self, shape: u32, margin: f32) -> Result<u32, ContractError> {
        let Some(model) = self.models.get(shape as usize) else {
            return Err(ContractError {
                body: shape as usize,
                quantity: "shape",
                value: format!("{shape} of {}", self.models.len()),
                hint: "numbers come from `add` and `grown`",
            });
        };
        let (ordop, frame) = in_default_mode(|| {
            check_margin(shape as usize, model.frame.reach(), margin)?;
            Ok((model.ordop.grown(margin), model.frame.grown(margin)))
        })?;
        Ok(self.push(ordop, frame))
    }

    /// Whether two shapes may touch, the second posed in the frame of the first: false only if
    /// their meshes, grown by their margins, are apart in exact arithmetic. It returns true for
    /// numbers without a shape, and for poses outside of the contract.
    ///
    /// `rotation` is a quaternion (x, y, z, w) of any non-zero norm, `translation` the second
    /// body's origin. If the pose was rounded to f32, use a margin of at least that error.
    #[must_use]
    pub fn may_touch(
        &self,
        first: u32,
        second: u32,
        rotation: [f32; 4],
        translation: [f32; 3],
    ) -> bool {
        let model = |number: u32| self.models.get(number as usize);
        let (Some(a), Some(b)) = (model(first), model(second)) else {
            return true;
        };
        in_default_mode(|| {
            if check_pose(0, &rotation, &translation.map(f64::from)).is_err() {
                return true;
            }
            let rows = [a.unturned, b.frame.row(second, rotation, translation)];
            let columns = OrDopColumns {
                rows: RowsByNumber::all(&rows),
                tables: &self.tables,
                overlap: Overlap::TwoSided,
            };
            columns.may_overlap(0, 1)
        })
    }

    fn push(&mut self, ordop: OrDop, frame: ShapeFrame) -> u32 {
        let number = self.models.len() as u32;
        self.tables.push(&ordop, frame.centre(), frame.reach());
        let unturned = frame.row(number, [0.0, 0.0, 0.0, 1.0], [0.0; 3]);
        self.models.push(Model { ordop, frame, unturned });
        number
    }
}
