//! Worlds in which space repeats along some axes.

use std::sync::Mutex;

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sdop::periodic::{ImageSource, Periodic, PeriodicBox, PeriodicError, PeriodicPair};
use sdop::{Body, BodyId, Finder, Groups};

use super::arrays::{check_length, id_column, matrix, one_row, pairs, rows, wide_rows};
use super::errors::{locked, refused, with_help};
use super::ids::{bits_of, collected};
use super::shape::{Shape, built};
use super::world::{ROUND, body, builder, motion, named, pose};

/// The ids of pairs, and the image of each.
type PeriodicPairs<'py> = (Bound<'py, PyArray2<u64>>, Bound<'py, PyArray2<i32>>);

fn arrays<'py>(py: Python<'py>, found: &[PeriodicPair]) -> PyResult<PeriodicPairs<'py>> {
    let images = collected(found.iter().map(|pair| pair.image)).map_err(refused)?;
    let ids = bits_of(found.iter().map(|pair| pair.bodies)).map_err(refused)?;
    Ok((pairs(py, ids)?, matrix(py, &images)?))
}

/// A period for each axis that has one.
fn periods(given: &Bound<'_, PyAny>) -> PyResult<[Option<f64>; 3]> {
    let periods = given.try_iter()?.map(|period| period?.extract());
    let periods: Vec<Option<f64>> = periods.collect::<PyResult<_>>()?;
    periods.try_into().map_err(|periods: Vec<_>| {
        with_help(
            format!("periods has {} entries", periods.len()),
            "pass three: the period along x, y and z, or None for an axis without one",
        )
    })
}

/// Changes a body by what `change` makes of it.
fn changed<V: ImageSource>(
    world: &mut Periodic<V>,
    id: u64,
    change: impl FnOnce(&mut V::UserBody),
) -> Result<(), PeriodicError> {
    let id = BodyId::from_bits(id);
    let mut body = world.body(id)?;
    change(&mut body);
    world.set(id, body)
}

/// The changes between two calls of `events`: pairs in the form of `cull`, sorted.
#[pyclass(frozen, module = "sdop")]
pub struct PeriodicEvents(sdop::periodic::PeriodicEvents);

#[pymethods]
impl PeriodicEvents {
    /// Pairs reported now and not before.
    #[getter]
    fn begun<'py>(&self, py: Python<'py>) -> PyResult<PeriodicPairs<'py>> {
        arrays(py, self.0.begun())
    }

    /// Pairs reported now and before.
    #[getter]
    fn persisting<'py>(&self, py: Python<'py>) -> PyResult<PeriodicPairs<'py>> {
        arrays(py, self.0.persisting())
    }

    /// Pairs reported before and not now, with their former images.
    #[getter]
    fn ended<'py>(&self, py: Python<'py>) -> PyResult<PeriodicPairs<'py>> {
        arrays(py, self.0.ended())
    }
}

/// A class with its own methods, and those of both periodic worlds.
macro_rules! periodic_class {
    ($(#[$doc:meta])* $name:ident, $world:ty, { $($own:tt)* }) => {
        $(#[$doc])*
        #[pyclass(frozen, module = "sdop")]
        pub struct $name(Mutex<$world>);

        #[pymethods]
        impl $name {
            $($own)*

            /// Removes a body.
            fn remove(&self, py: Python<'_>, id: u64) -> PyResult<()> {
                locked(py, &self.0, |world| world.remove(BodyId::from_bits(id))).map_err(refused)
            }

            /// Puts a body to rest, wakes it, or fixes it: "resting", "dynamic" or "fixed". Putting
            /// a body to rest begins and ends no pair.
            fn set_motion(&self, py: Python<'_>, id: u64, motion: &str) -> PyResult<()> {
                let motion = self::motion(motion)?;
                locked(py, &self.0, |world| changed(world, id, |body| body.motion = motion))
                    .map_err(refused)
            }

            /// Never reports the pair of two bodies again, in any image, until `include` or until
            /// one of them is removed. Returns whether it wasn't excluded yet.
            fn exclude(&self, py: Python<'_>, a: u64, b: u64) -> PyResult<bool> {
                let [a, b] = [a, b].map(BodyId::from_bits);
                locked(py, &self.0, |world| world.exclude(a, b)).map_err(refused)
            }

            /// Reports the pair of two bodies again when it meets. Returns whether it was excluded.
            fn include(&self, py: Python<'_>, a: u64, b: u64) -> PyResult<bool> {
                let [a, b] = [a, b].map(BodyId::from_bits);
                locked(py, &self.0, |world| world.include(a, b)).map_err(refused)
            }

            /// The period along x, y and z; None for an axis without one.
            #[getter]
            fn periods(&self, py: Python<'_>) -> [Option<f64>; 3] {
                locked(py, &self.0, |world| world.periods())
            }

            /// Changes the periods. Bodies stay where they were put. If a body is too large for
            /// them, nothing changes.
            fn set_periods(&self, py: Python<'_>, periods: &Bound<'_, PyAny>) -> PyResult<()> {
                let periods = self::periods(periods)?;
                locked(py, &self.0, |world| world.set_periods(periods)).map_err(refused)
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
                &self,
                py: Python<'py>,
                limit: Option<usize>,
            ) -> PyResult<PeriodicPairs<'py>> {
                let found = locked(py, &self.0, |world| match limit {
                    Some(limit) => world.cull_up_to(limit).map(<[_]>::to_vec),
                    None => world.cull().map(<[_]>::to_vec),
                });
                arrays(py, &found.map_err(refused)?)
            }

            /// The pairs of the last cull, in the form of `cull`.
            fn pairs<'py>(&self, py: Python<'py>) -> PyResult<PeriodicPairs<'py>> {
                arrays(py, &locked(py, &self.0, |world| world.pairs().to_vec()))
            }

            /// What has changed between the last call of `events` and the last cull. Two bodies are
            /// one pair, whatever their image.
            fn events(&self, py: Python<'_>) -> PeriodicEvents {
                PeriodicEvents(locked(py, &self.0, |world| world.events()))
            }

            fn __len__(&self, py: Python<'_>) -> usize {
                locked(py, &self.0, |world| world.ids().count())
            }

            fn __contains__(&self, py: Python<'_>, id: u64) -> bool {
                locked(py, &self.0, |world| world.contains(BodyId::from_bits(id)))
            }
        }
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
    PeriodicBoxes, sdop::periodic::PeriodicBoxes, {
        #[new]
        #[pyo3(signature = (periods, *, finder="auto", threads=1))]
        fn new(periods: &Bound<'_, PyAny>, finder: &str, threads: usize) -> PyResult<Self> {
            let finder: Finder = finder.parse().map_err(refused)?;
            let builder = sdop::BoxCuller::builder().finder(finder).threads(threads);
            let boxes = sdop::periodic::PeriodicBoxes::with(&builder, self::periods(periods)?);
            Ok(Self(Mutex::new(boxes.map_err(refused)?)))
        }

        /// Adds a box (lower corner x, y, z, then the upper one, float64) and returns its id, which
        /// stays until `remove`.
        #[pyo3(signature = (bounds, *, motion="dynamic", groups=(u32::MAX, u32::MAX)))]
        fn insert(
            &self,
            py: Python<'_>,
            bounds: &Bound<'_, PyAny>,
            motion: &str,
            groups: (u32, u32),
        ) -> PyResult<u64> {
            let [min, max] = one(bounds)?;
            let (member, mask) = groups;
            let body = PeriodicBox {
                motion: self::motion(motion)?,
                groups: Groups { member, mask },
                ..PeriodicBox::new(min, max)
            };
            locked(py, &self.0, |world| world.insert(body))
                .map(BodyId::to_bits)
                .map_err(refused)
        }

        /// Moves or resizes a box.
        fn set_bounds(&self, py: Python<'_>, id: u64, bounds: &Bound<'_, PyAny>) -> PyResult<()> {
            let ends = one(bounds)?;
            locked(py, &self.0, |world| changed(world, id, |body| [body.min, body.max] = ends))
                .map_err(refused)
        }

        /// Moves many boxes: ids of shape (n,), boxes of float64 in shape (n, 6) or (n, 2, 3). If
        /// one is rejected, those before it have moved.
        fn set_many(
            &self,
            py: Python<'_>,
            ids: &Bound<'_, PyAny>,
            boxes: &Bound<'_, PyAny>,
        ) -> PyResult<()> {
            let (ids, boxes) = (id_column(ids, "ids")?, wide_rows::<6>(boxes, "boxes")?);
            check_length("boxes", boxes.len(), ids.len())?;
            locked(py, &self.0, |world| {
                let mut all = ids.iter().zip(boxes);
                all.try_for_each(|(&id, row)| {
                    changed(world, id, |body| [body.min, body.max] = corners(row))
                })
            })
            .map_err(refused)
        }
    }
}

periodic_class! {
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
            shapes: Vec<PyRef<'_, Shape>>,
            periods: &Bound<'_, PyAny>,
            strategy: &str,
            finder: &str,
            threads: usize,
        ) -> PyResult<Self> {
            let builder = builder(strategy, finder, threads)?;
            let periods = self::periods(periods)?;
            let world = sdop::world::PeriodicWorld::with(built(&shapes), &builder, periods);
            Ok(Self(Mutex::new(world.map_err(refused)?)))
        }

        /// Adds a body and returns its id, which stays until `remove`. Parameters are those of
        /// `World.insert`.
        #[pyo3(signature = (shape, rotation, translation, *, margin=0.0, dynamic=true, groups=(u32::MAX, u32::MAX), exact=false))]
        #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
        fn insert(
            &self,
            py: Python<'_>,
            shape: u32,
            rotation: &Bound<'_, PyAny>,
            translation: &Bound<'_, PyAny>,
            margin: f32,
            dynamic: bool,
            groups: (u32, u32),
            exact: bool,
        ) -> PyResult<u64> {
            let body = body(shape, pose(rotation, translation, exact)?, margin, dynamic, groups);
            locked(py, &self.0, |world| world.insert(body))
                .map(BodyId::to_bits)
                .map_err(refused)
        }

        /// Moves a body by any distance.
        #[pyo3(signature = (id, rotation, translation, *, exact=false))]
        fn set_pose(
            &self,
            py: Python<'_>,
            id: u64,
            rotation: &Bound<'_, PyAny>,
            translation: &Bound<'_, PyAny>,
            exact: bool,
        ) -> PyResult<()> {
            let pose = pose(rotation, translation, exact)?;
            locked(py, &self.0, |world| changed(world, id, |body| set_pose(body, pose)))
                .map_err(refused)
        }

        /// Moves many bodies: ids of shape (n,), rotations (n, 4), translations (n, 3). If one is
        /// rejected, those before it have moved.
        #[pyo3(signature = (ids, rotations, translations, *, exact=false))]
        fn set_poses(
            &self,
            py: Python<'_>,
            ids: &Bound<'_, PyAny>,
            rotations: &Bound<'_, PyAny>,
            translations: &Bound<'_, PyAny>,
            exact: bool,
        ) -> PyResult<()> {
            let ids = id_column(ids, "ids")?;
            let rotations = rows::<4>(rotations, "rotations", exact, ROUND)?.wide();
            let translations = wide_rows::<3>(translations, "translations")?;
            check_length("rotations", rotations.len(), ids.len())?;
            check_length("translations", translations.len(), ids.len())?;
            locked(py, &self.0, |world| {
                let mut all = ids.iter().zip(rotations.into_iter().zip(translations));
                all.try_for_each(|(&id, pose)| changed(world, id, |body| set_pose(body, pose)))
            })
            .map_err(refused)
        }

        /// The present body, in the form of `World.body`.
        fn body<'py>(&self, py: Python<'py>, id: u64) -> PyResult<Bound<'py, PyDict>> {
            let body = locked(py, &self.0, |world| world.body(BodyId::from_bits(id)));
            named(py, &body.map_err(refused)?)
        }
    }
}

fn set_pose(body: &mut Body, (rotation, translation): ([f64; 4], [f64; 3])) {
    *body = Body { translation, ..*body }.turned(rotation);
}

/// One box: six numbers, or two corners.
fn one(given: &Bound<'_, PyAny>) -> PyResult<[[f64; 3]; 2]> {
    let remedy = "pass six numbers: the lower corner, then the upper one";
    Ok(corners(wide_rows::<6>(&one_row::<6>(given, "bounds", remedy)?, "bounds")?[0]))
}

fn corners([a, b, c, d, e, f]: [f64; 6]) -> [[f64; 3]; 2] {
    [[a, b, c], [d, e, f]]
}
