//! Culling a fixed set of bodies.

use std::sync::{Arc, Mutex};
use std::time::Instant;

use numpy::PyArray2;
use pyo3::prelude::*;
use sdop::culler::CullerBuilder;
use sdop::{Bodies, Body, BodyId, Groups, Interest, World};

use super::arguments::ShapeList;
use super::arrays::{check_length, flags, pairs, rows, whole_column};
use super::boxes::{groups, list};
use super::errors::{locked, refused};
use super::ids::collected;
use super::world::builder;
use super::worlds::counted;

const ROUND: &str =
    "pass float32, or leave `exact` out: poses of float64 are then culled as they are";

/// Culls the frames of a fixed set of bodies whose poses change.
///
/// If two posed meshes meet in exact arithmetic, touching included, and one of them is dynamic, the
/// pair is reported. Pairs that don't meet may be reported too; how many depends on the strategy.
///
/// Parameters
/// ----------
/// shapes : list of Shape
/// body_shapes : array of whole numbers, shape (n,)
///     For each body, the index of its shape.
/// dynamic : array of bool, shape (n,), optional
///     Whether a body may move; pairs of two static bodies are never reported. Default: all may.
/// strategy : str
///     Which volumes are tested: "s-dop-sequential" tests spheres, then or-DOPs.
/// finder : str
///     The algorithm that finds candidates. The reported set doesn't depend on it.
/// interest : list of int, optional
///     Bodies of interest, for the strategies that need them.
/// groups : array of whole numbers, shape (n, 2), optional
///     Bits of the groups that each body is in, and of those that it collides with.
/// threads : int
///     Number of threads.
#[pyclass(frozen, module = "sdop")]
pub struct Culler(Mutex<State>);

struct State {
    culler: sdop::Culler,
    bodies: Bodies,
    /// Whether there was no frame yet, so that the culler was built for other poses.
    is_new: bool,
    seconds: f64,
    /// What culls poses of float64 that float32 can't hold, since the first of them.
    wide: Option<(World, Vec<BodyId>)>,
    /// What it is made of.
    shapes: Vec<Arc<sdop::Shape>>,
    builder: CullerBuilder,
    interest: Option<Vec<u32>>,
    groups: Option<Vec<Groups>>,
}

#[pymethods]
impl Culler {
    #[new]
    #[pyo3(signature = (shapes, body_shapes, *, dynamic=None, strategy="s-dop-sequential", finder="auto", interest=None, groups=None, threads=1))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn new(
        shapes: ShapeList,
        body_shapes: &Bound<'_, PyAny>,
        dynamic: Option<&Bound<'_, PyAny>>,
        strategy: &str,
        finder: &str,
        interest: Option<Vec<u32>>,
        groups: Option<&Bound<'_, PyAny>>,
        threads: usize,
    ) -> PyResult<Self> {
        let shape = whole_column(body_shapes, "body_shapes")?;
        let n = shape.len();
        let dynamic = match dynamic {
            Some(given) => flags(given, "dynamic")?,
            None => vec![true; n],
        };
        check_length("dynamic", dynamic.len(), n)?;
        let builder = builder(strategy, finder, threads)?;
        let mut with_interest = builder.clone();
        if let Some(bodies) = &interest {
            with_interest = with_interest.interest(Interest::Bodies(bodies.clone()));
        }
        let (rotation, translation) = (vec![[0.0, 0.0, 0.0, 1.0]; n], vec![[0.0; 3]; n]);
        let bodies = Bodies { shape, dynamic, rotation, translation };
        let mut culler = with_interest.build(&shapes.built(), &bodies).map_err(refused)?;
        let groups = self::groups(groups, n)?;
        culler.set_groups(groups.clone()).map_err(refused)?;
        Ok(Self(Mutex::new(State {
            culler,
            bodies,
            is_new: true,
            seconds: 0.0,
            wide: None,
            shapes: shapes.0,
            builder,
            interest,
            groups,
        })))
    }

    /// The pairs of this frame that might touch.
    ///
    /// Parameters
    /// ----------
    /// rotations : array of float32 or float64, shape (n, 4)
    ///     Quaternions x, y, z, w of any non-zero norm.
    /// translations : array of float32 or float64, shape (n, 3)
    ///     Position of each body's origin, in world coordinates. A frame of float64 that float32
    ///     can't hold is culled as by a `World`, which grows bodies by what rounding may move.
    /// sort : bool
    ///     Whether the rows are sorted.
    /// exact : bool
    ///     Whether poses that float32 can't hold are rejected.
    /// limit : int, optional
    ///     More pairs than that are an error, and memory for them is never allocated.
    ///
    /// Returns
    /// -------
    /// array of uint32, shape (m, 2)
    ///     Each pair i < j once.
    #[pyo3(signature = (rotations, translations, *, sort=false, exact=false, limit=None))]
    fn cull<'py>(
        &self,
        py: Python<'py>,
        rotations: &Bound<'py, PyAny>,
        translations: &Bound<'py, PyAny>,
        sort: bool,
        exact: bool,
        limit: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let rotations = rows::<4>(rotations, "rotations", exact, ROUND)?;
        let translations = rows::<3>(translations, "translations", exact, ROUND)?;
        let found = match (rotations.narrow(), translations.narrow()) {
            (Some(rotations), Some(translations)) => {
                locked(py, &self.0, |state| state.cull(rotations, translations, sort, limit))
            }
            _ => {
                let (rotations, translations) = (rotations.wide(), translations.wide());
                locked(py, &self.0, |state| state.cull_wide(&rotations, &translations, limit))
            }
        };
        pairs(py, found?)
    }

    /// The finder in use: the chosen one, or the choice of "auto".
    #[getter]
    fn finder(&self, py: Python<'_>) -> &'static str {
        locked(py, &self.0, |state| state.culler.finder().name())
    }

    /// Seconds of the last `cull`, without the time for passing arrays.
    #[getter]
    fn seconds(&self, py: Python<'_>) -> f64 {
        locked(py, &self.0, |state| state.seconds)
    }

    fn __len__(&self, py: Python<'_>) -> usize {
        locked(py, &self.0, |state| state.bodies.len())
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let (bodies, shapes) =
            locked(py, &self.0, |state| (state.bodies.len(), state.shapes.len()));
        let bodies = counted(bodies, "body", "bodies");
        format!("<sdop.Culler: {bodies} of {}>", counted(shapes, "shape", "shapes"))
    }
}

impl State {
    /// The pairs of poses in f64, by a world whose bodies have their numbers as slots.
    fn cull_wide(
        &mut self,
        rotations: &[[f64; 4]],
        translations: &[[f64; 3]],
        limit: Option<usize>,
    ) -> PyResult<Vec<[u32; 2]>> {
        let n = self.bodies.len();
        check_length("rotations", rotations.len(), n)?;
        check_length("translations", translations.len(), n)?;
        let (world, ids) = match &mut self.wide {
            Some(wide) => wide,
            None => {
                let wide = self.world()?;
                self.wide.insert(wide)
            }
        };
        let start = Instant::now();
        for ((&id, &q), &t) in ids.iter().zip(rotations).zip(translations) {
            world.set_pose_f64(id, q, t).map_err(refused)?;
        }
        let found = match limit {
            Some(limit) => world.cull_up_to(limit),
            None => world.cull(),
        };
        let found = found.map_err(refused)?;
        self.seconds = start.elapsed().as_secs_f64();
        collected(found.iter().map(|pair| pair.map(|id| id.slot() as u32))).map_err(refused)
    }

    /// A world of the bodies, at the origin.
    fn world(&self) -> PyResult<(World, Vec<BodyId>)> {
        let shapes = self.shapes.iter().map(|shape| sdop::Shape::clone(shape)).collect();
        let mut world = World::with(shapes, &self.builder).map_err(refused)?;
        let mut ids = Vec::new();
        for (i, &shape) in self.bodies.shape.iter().enumerate() {
            let groups = self.groups.as_ref().map_or(Groups::ALL, |groups| groups[i]);
            let body = Body { shape, groups, ..Body::default() };
            let body = if self.bodies.dynamic[i] { body } else { body.fixed() };
            ids.push(world.insert(body).map_err(refused)?);
        }
        let interest = self.interest.iter().flatten().map(|&i| ids[i as usize]);
        world.set_interest(&interest.collect::<Vec<_>>()).map_err(refused)?;
        Ok((world, ids))
    }

    fn cull(
        &mut self,
        rotations: &[[f32; 4]],
        translations: &[[f32; 3]],
        sort: bool,
        limit: Option<usize>,
    ) -> PyResult<Vec<[u32; 2]>> {
        let n = self.bodies.len();
        check_length("rotations", rotations.len(), n)?;
        check_length("translations", translations.len(), n)?;
        self.bodies.rotation.copy_from_slice(rotations);
        self.bodies.translation.copy_from_slice(translations);
        if self.is_new {
            self.culler.refresh(&self.bodies).map_err(refused)?;
            self.is_new = false;
        }
        let start = Instant::now();
        let found = match limit {
            Some(limit) => self.culler.cull_up_to(&self.bodies, limit),
            None => self.culler.cull(&self.bodies),
        };
        self.seconds = start.elapsed().as_secs_f64();
        found.and_then(|found| list(found, sort)).map_err(refused)
    }
}
