//! Culling a fixed set of bodies.

use std::sync::Mutex;
use std::time::Instant;

use numpy::PyArray2;
use pyo3::prelude::*;
use sdop::{Bodies, Finder, Interest, Strategy};

use super::arrays::{check_length, flags, pairs, rows, whole_column};
use super::boxes::{groups, list};
use super::errors::{locked, refused};
use super::shape::{Shape, built};

const ROUND: &str = "pass float32, whose pose is then the one that is culled; `sdop.World` takes float64 translations as they are";

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
}

#[pymethods]
impl Culler {
    #[new]
    #[pyo3(signature = (shapes, body_shapes, *, dynamic=None, strategy="s-dop-sequential", finder="auto", interest=None, groups=None, threads=1))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn new(
        shapes: Vec<PyRef<'_, Shape>>,
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
        let (strategy, finder): (Strategy, Finder) =
            (strategy.parse().map_err(refused)?, finder.parse().map_err(refused)?);
        let mut builder =
            sdop::Culler::builder().strategy(strategy).finder(finder).threads(threads);
        if let Some(bodies) = interest {
            builder = builder.interest(Interest::Bodies(bodies));
        }
        let (rotation, translation) = (vec![[0.0, 0.0, 0.0, 1.0]; n], vec![[0.0; 3]; n]);
        let bodies = Bodies { shape, dynamic, rotation, translation };
        let mut culler = builder.build(&built(&shapes), &bodies).map_err(refused)?;
        culler.set_groups(self::groups(groups, n)?).map_err(refused)?;
        Ok(Self(Mutex::new(State { culler, bodies, is_new: true, seconds: 0.0 })))
    }

    /// The pairs of this frame that might touch.
    ///
    /// Parameters
    /// ----------
    /// rotations : array of float32, shape (n, 4)
    ///     Quaternions x, y, z, w of any non-zero norm.
    /// translations : array of float32, shape (n, 3)
    ///     Position of each body's origin, in world coordinates.
    /// sort : bool
    ///     Whether the rows are sorted.
    /// limit : int, optional
    ///     More pairs than that are an error, and memory for them is never allocated.
    ///
    /// Returns
    /// -------
    /// array of uint32, shape (m, 2)
    ///     Each pair i < j once.
    #[pyo3(signature = (rotations, translations, *, sort=false, limit=None))]
    fn cull<'py>(
        &self,
        py: Python<'py>,
        rotations: &Bound<'py, PyAny>,
        translations: &Bound<'py, PyAny>,
        sort: bool,
        limit: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let rotations = rows::<4>(rotations, "rotations", ROUND)?;
        let translations = rows::<3>(translations, "translations", ROUND)?;
        let (rotations, translations) = (rotations.rows(), translations.rows());
        let found = locked(py, &self.0, |state| state.cull(rotations, translations, sort, limit));
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
}

impl State {
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
