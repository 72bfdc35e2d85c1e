//! Worlds in which space repeats along some axes.

use std::sync::Mutex;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyIterator};
use sdop::periodic::{PeriodicBox, PeriodicError, PeriodicPair};
use sdop::{Body, BodyId, Finder, Groups};

use super::arguments::{GroupBits, Id, ShapeList, ShapeNumber, mistyped};
use super::arrays::{check_length, id_column, matrix, one_row, pairs, rows, wide_rows};
use super::errors::{locked, refused, with_help};
use super::ids::{bits_of, collected};
use super::world::{ROUND, builder, motion, named, pose};
use super::worlds::{WorldState, counted, events_class, mesh_class, world_class};

/// The ids of pairs, and the image of each.
type PeriodicPairs<'py> = (Bound<'py, PyArray2<u64>>, Bound<'py, PyArray2<i32>>);

fn arrays<'py>(py: Python<'py>, found: &[PeriodicPair]) -> PyResult<PeriodicPairs<'py>> {
    let images = collected(found.iter().map(|pair| pair.image)).map_err(refused)?;
    let ids = bits_of(found.iter().map(|pair| pair.bodies)).map_err(refused)?;
    Ok((pairs(py, ids)?, matrix(py, &images)?))
}

/// A period for each axis that has one.
fn periods(given: &Bound<'_, PyAny>) -> PyResult<[Option<f64>; 3]> {
    let help = "pass three numbers: the period along x, y and z, or None for an axis without one";
    let periods = given.try_iter().and_then(|all| all.map(|period| period?.extract()).collect());
    let periods: Vec<Option<f64>> = periods.map_err(|_| mistyped("periods", given, help))?;
    let wrong = |given: Vec<_>| with_help(format!("periods has {} entries", given.len()), help);
    periods.try_into().map_err(wrong)
}

events_class! {
    /// The changes between two calls of `events`: pairs in the form of `cull`, sorted.
    PeriodicEvents, sdop::periodic::PeriodicEvents, PeriodicPairs<'py>, arrays
}

/// A class with its own methods, and those of both periodic worlds.
macro_rules! periodic_class {
    ($(#[$doc:meta])* $name:ident, $world:ty, $body:ty, $contents:expr, { $($own:tt)* }) => {
        world_class! { $(#[$doc])* $name, $world, $body, $contents, {
            $($own)*

            /// The period along x, y and z; None for an axis without one.
            #[getter]
            fn periods(&self, py: Python<'_>) -> [Option<f64>; 3] {
                locked(py, &self.0, |state| state.world.periods())
            }

            /// Changes the periods. Bodies stay where they were put. If a body is too large for
            /// them, nothing changes.
            fn set_periods(&self, py: Python<'_>, periods: &Bound<'_, PyAny>) -> PyResult<()> {
                let periods = self::periods(periods)?;
                locked(py, &self.0, |state| state.world.set_periods(periods)).map_err(refused)
            }

            /// Finds the pairs that might touch now, each once. If images have more than `limit`
            /// pairs, it is an error.
            ///
            /// Returns
            /// -------
            /// array of uint64, shape (m, 2)
            ///     Ids of the bodies, sorted.
            /// array of int32, shape (m, 3)
            ///     By how many periods along x, y and z the second body has to be moved, from where
            ///     it was put, so that it may touch the first.
            #[pyo3(signature = (*, limit=None))]
            fn cull<'py>(
                &self, py: Python<'py>, limit: Option<usize>,
            ) -> PyResult<PeriodicPairs<'py>> {
                let found = locked(py, &self.0, |state| match limit {
                    Some(limit) => state.world.cull_up_to(limit).map(<[_]>::to_vec),
                    None => state.world.cull().map(<[_]>::to_vec),
                });
                arrays(py, &found.map_err(refused)?)
            }

            /// The pairs of the last cull, in the form of `cull`.
            fn pairs<'py>(&self, py: Python<'py>) -> PyResult<PeriodicPairs<'py>> {
                arrays(py, &locked(py, &self.0, |state| state.world.pairs().to_vec()))
            }

            /// What has changed between the last call of `events` and the last cull. Two bodies are
            /// one pair, whatever their image.
            fn events(&self, py: Python<'_>) -> PeriodicEvents {
                PeriodicEvents(locked(py, &self.0, |state| state.world.events()))
            }
        } }
    };
}

periodic_class! {
    /// A long-lived set of boxes in space that repeats along some axes: particles in a periodic
    /// cell, tilings.
    ///
    /// Boxes are float64 and may be anywhere, also many periods away. A pair is reported exactly
    /// if the boxes share a point when one of them is moved by whole periods, in exact arithmetic.
    /// Along a periodic axis, a box has to be shorter than half of the period.
    ///
    /// Parameters
    /// ----------
    /// periods : three floats or None
    ///     The period along x, y and z, a length; None for an axis without one.
    /// finder : str
    ///     The algorithm that finds candidates. The reported set doesn't depend on it.
    /// threads : int
    ///     Number of threads.
    PeriodicBoxes, sdop::periodic::PeriodicBoxes, PeriodicBox, |boxes, _| counted(boxes, "box", "boxes"), {
        #[new]
        #[pyo3(signature = (periods, *, finder="auto", threads=1))]
        fn new(periods: &Bound<'_, PyAny>, finder: &str, threads: usize) -> PyResult<Self> {
            let choice: Finder = finder.parse().map_err(refused)?;
            let builder = sdop::BoxCuller::builder().finder(choice).threads(threads);
            let boxes = sdop::periodic::PeriodicBoxes::with(&builder, self::periods(periods)?);
            let (world, choices) = (boxes.map_err(refused)?, Default::default());
            Ok(Self(Mutex::new(WorldState { world, shapes: Vec::new(), choices })))
        }

        /// Adds a box (lower corner x, y, z, then the upper one, float64) and returns its id, which
        /// stays until `remove`. Other parameters are those of `BoxWorld.insert`.
        #[pyo3(signature = (bounds, *, motion="dynamic", groups=GroupBits(Groups::ALL)))]
        fn insert(
            &self, py: Python<'_>, bounds: &Bound<'_, PyAny>, motion: &str, groups: GroupBits,
        ) -> PyResult<u64> {
            let [min, max] = one(bounds)?;
            let (motion, groups) = (self::motion(motion)?, groups.0);
            let body = PeriodicBox { motion, groups, ..PeriodicBox::new(min, max) };
            locked(py, &self.0, |state| state.world.insert(body)).map(BodyId::to_bits).map_err(refused)
        }

        /// Moves or resizes a box.
        fn set_bounds(&self, py: Python<'_>, id: Id, bounds: &Bound<'_, PyAny>) -> PyResult<()> {
            let ends = one(bounds)?;
            self.change(py, id, |body| [body.min, body.max] = ends)
        }

        /// Moves many boxes: ids of shape (n,), boxes of float64 in shape (n, 6) or (n, 2, 3). If
        /// one is rejected, those before it have moved.
        fn set_many(
            &self, py: Python<'_>, ids: &Bound<'_, PyAny>, boxes: &Bound<'_, PyAny>,
        ) -> PyResult<()> {
            let (ids, boxes) = (id_column(ids, "ids")?, wide_rows::<6>(boxes, "boxes")?);
            check_length("boxes", boxes.len(), ids.len())?;
            locked(py, &self.0, |WorldState { world, .. }| {
                let mut all = ids.iter().zip(boxes);
                all.try_for_each(|(&id, row)| {
                    let ([min, max], id) = (corners(row), BodyId::from_bits(id));
                    let body = PeriodicBox { min, max, ..world.body(id)? };
                    world.set(id, body)
                })
            })
            .map_err(refused)
        }
    }
}

mesh_class! {
    periodic_class, set_pose,
    /// A long-lived set of posed meshes in space that repeats along some axes.
    ///
    /// Bodies may be anywhere, also many periods away. If two meshes, each grown by its body's
    /// margin, meet in exact arithmetic when one of them is moved by whole periods, the pair is
    /// reported. Along a periodic axis, the ball around a body, with its margin, has to be smaller
    /// than half of the period.
    ///
    /// Parameters
    /// ----------
    /// shapes : list of Shape
    /// periods : three floats or None
    ///     The period along x, y and z, a length; None for an axis without one.
    /// strategy : str
    ///     Which volumes are tested: "s-dop-sequential" tests spheres, then or-DOPs.
    /// finder : str
    ///     The algorithm that finds candidates.
    /// threads : int
    ///     Number of threads.
    PeriodicWorld, sdop::world::PeriodicWorld, {
        #[new]
        #[pyo3(signature = (shapes, periods, *, strategy="s-dop-sequential", finder="auto", threads=1))]
        fn new(
            shapes: ShapeList, periods: &Bound<'_, PyAny>, strategy: &str, finder: &str, threads: usize,
        ) -> PyResult<Self> {
            let builder = builder(strategy, finder, threads)?;
            let periods = self::periods(periods)?;
            let world = sdop::world::PeriodicWorld::with(shapes.built(), &builder, periods);
            let (world, shapes) = (world.map_err(refused)?, shapes.0.into_iter().map(Some));
            let (shapes, choices) = (shapes.collect(), Default::default());
            Ok(Self(Mutex::new(WorldState { world, shapes, choices })))
        }
    }
}

fn set_pose(
    world: &mut sdop::world::PeriodicWorld,
    id: BodyId,
    rotation: [f64; 4],
    translation: [f64; 3],
) -> Result<(), PeriodicError> {
    let body = Body { translation, ..world.body(id)? };
    world.set(id, body.turned(rotation))
}

/// One box: six numbers, or two corners.
fn one(given: &Bound<'_, PyAny>) -> PyResult<[[f64; 3]; 2]> {
    let remedy = "pass six numbers: the lower corner, then the upper one";
    Ok(corners(wide_rows::<6>(&one_row::<6>(given, "bounds", remedy)?, "bounds")?[0]))
}

fn corners([a, b, c, d, e, f]: [f64; 6]) -> [[f64; 3]; 2] {
    [[a, b, c], [d, e, f]]
}
