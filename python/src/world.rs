//! Long-lived worlds.

use std::sync::Mutex;

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sdop::culler::CullerBuilder;
use sdop::{Body, BodyId, CullError, Finder, Groups, Motion, Strategy};

use super::arrays::{check_length, id_column, one_row, pairs, rows, wide_rows};
use super::errors::{locked, refused, with_help};
use super::ids::bits_of;
use super::shape::{Shape, built};

pub(super) const ROUND: &str =
    "pass a float32 quaternion, or leave `exact` out: bodies are then grown by what rounding moves";

pub(super) const QUATERNION: &str = "pass four numbers: a quaternion x, y, z, w";
pub(super) const POSITION: &str = "pass three numbers: x, y, z";

/// A long-lived set of bodies that come and go, with stable ids, groups, contact margins,
/// float64 translations, and pairs as a list or as events.
///
/// At every `cull`, if two meshes, each grown by its body's margin and posed at its float64
/// translation, meet in exact arithmetic, one of them is dynamic and their groups collide, the pair
/// is reported.
///
/// Parameters
/// ----------
/// shapes : list of Shape
/// strategy : str
///     Which volumes are tested: "s-dop-sequential" tests spheres, then or-DOPs.
/// finder : str
///     The algorithm that finds candidates. The reported set doesn't depend on it.
/// threads : int
///     Number of threads.
#[pyclass(frozen, module = "sdop")]
pub struct World(pub(super) Mutex<sdop::World>);

#[pymethods]
impl World {
    #[new]
    #[pyo3(signature = (shapes, *, strategy="s-dop-sequential", finder="auto", threads=1))]
    fn new(
        shapes: Vec<PyRef<'_, Shape>>,
        strategy: &str,
        finder: &str,
        threads: usize,
    ) -> PyResult<Self> {
        let builder = builder(strategy, finder, threads)?;
        let world = sdop::World::with(built(&shapes), &builder).map_err(refused)?;
        Ok(Self(Mutex::new(world)))
    }

    /// Adds a shape and returns its number.
    fn add_shape(&self, py: Python<'_>, shape: &Shape) -> PyResult<u32> {
        let shape = shape.built.clone();
        locked(py, &self.0, |world| world.add_shape(shape)).map_err(refused)
    }

    /// Removes a shape that no body uses.
    fn remove_shape(&self, py: Python<'_>, shape: u32) -> PyResult<()> {
        locked(py, &self.0, |world| world.remove_shape(shape)).map_err(refused)
    }

    /// Adds a body and returns its id, which stays until `remove`.
    ///
    /// Parameters
    /// ----------
    /// shape : int
    ///     Number of its shape.
    /// rotation : four numbers
    ///     Quaternion x, y, z, w of any non-zero norm. If float32 can't hold it, the body is grown
    ///     by what rounding it may move, rounded up to about 2**-12 of its reach.
    /// translation : three numbers
    ///     Position of its origin, in world coordinates, in float64.
    /// margin : float
    ///     A length: pairs are reported whose meshes, each grown by its margin, meet.
    /// dynamic : bool
    ///     Whether it may move; pairs of two static bodies are never reported.
    /// groups : (int, int)
    ///     Bits of the groups that it is in, and of those that it collides with.
    /// exact : bool
    ///     Whether a rotation that float32 can't hold is rejected.
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
        locked(py, &self.0, |world| world.insert(body)).map(BodyId::to_bits).map_err(refused)
    }

    /// Removes a body.
    fn remove(&self, py: Python<'_>, id: u64) -> PyResult<()> {
        locked(py, &self.0, |world| world.remove(BodyId::from_bits(id))).map_err(refused)
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
        let (rotation, translation) = pose(rotation, translation, exact)?;
        let id = BodyId::from_bits(id);
        locked(py, &self.0, |world| world.set_pose_f64(id, rotation, translation)).map_err(refused)
    }

    /// Moves many bodies: ids of shape (n,), rotations (n, 4), translations (n, 3). If one
    /// is rejected, those before it have moved.
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
            let poses = rotations.iter().zip(&translations);
            let mut all = ids.iter().zip(poses);
            all.try_for_each(|(&id, (&q, &t))| world.set_pose_f64(BodyId::from_bits(id), q, t))
        })
        .map_err(refused)
    }

    /// Puts a body to rest, wakes it, or fixes it: "resting", "dynamic" or "fixed". Putting a body
    /// to rest begins and ends no pair.
    fn set_motion(&self, py: Python<'_>, id: u64, motion: &str) -> PyResult<()> {
        let motion = self::motion(motion)?;
        locked(py, &self.0, |world| world.set_motion(BodyId::from_bits(id), motion))
            .map_err(refused)
    }

    /// Never reports the pair of two bodies again, such as two links that share a joint, until
    /// `include` or until one of them is removed. Returns whether it wasn't excluded yet.
    fn exclude(&self, py: Python<'_>, a: u64, b: u64) -> PyResult<bool> {
        let [a, b] = [a, b].map(BodyId::from_bits);
        locked(py, &self.0, |world| world.exclude(a, b)).map_err(refused)
    }

    /// Reports the pair of two bodies again when it meets. Returns whether it was excluded.
    fn include(&self, py: Python<'_>, a: u64, b: u64) -> PyResult<bool> {
        let [a, b] = [a, b].map(BodyId::from_bits);
        locked(py, &self.0, |world| world.include(a, b)).map_err(refused)
    }

    /// The present body, with the names of `insert`'s parameters, and whether it is "resting" and
    /// its rotation, in float32, was "rounded".
    fn body<'py>(&self, py: Python<'py>, id: u64) -> PyResult<Bound<'py, PyDict>> {
        let body =
            locked(py, &self.0, |world| world.body(BodyId::from_bits(id))).map_err(refused)?;
        named(py, &body)
    }

    /// Finds the pairs that might touch now: ids of shape (m, 2), sorted. More than `limit` pairs
    /// are an error.
    #[pyo3(signature = (*, limit=None))]
    fn cull<'py>(
        &self,
        py: Python<'py>,
        limit: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<u64>>> {
        let found = locked(py, &self.0, |world| {
            let found = match limit {
                Some(limit) => world.cull_up_to(limit)?,
                None => world.cull()?,
            };
            Ok::<_, sdop::WorldError>(bits_of(found.iter())?)
        });
        pairs(py, found.map_err(refused)?)
    }

    /// The pairs of the last cull.
    fn pairs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u64>>> {
        pairs(py, locked(py, &self.0, |world| bits_of(world.pairs())).map_err(refused)?)
    }

    /// The pairs that began, persisted or ended between the last call of this method and the last
    /// cull.
    fn events(&self, py: Python<'_>) -> PyResult<Events> {
        locked(py, &self.0, |world| Events::new(&world.events())).map_err(refused)
    }

    /// The world as bytes, for `restore` here or elsewhere: bodies, ids, pairs and events, without
    /// shapes.
    fn snapshot(&self, py: Python<'_>) -> PyResult<Vec<u8>> {
        let snapshot = locked(py, &self.0, |world| world.snapshot());
        saved(&snapshot)
    }

    /// Replaces this world by that of a snapshot. It must have the same shapes under the same
    /// numbers.
    fn restore(&self, py: Python<'_>, snapshot: &[u8]) -> PyResult<()> {
        let snapshot = read_back(snapshot)?;
        locked(py, &self.0, |world| world.restore(&snapshot)).map_err(refused)
    }

    fn __len__(&self, py: Python<'_>) -> usize {
        locked(py, &self.0, |world| world.len())
    }

    fn __contains__(&self, py: Python<'_>, id: u64) -> bool {
        locked(py, &self.0, |world| world.contains(BodyId::from_bits(id)))
    }
}

/// "dynamic", "resting" or "fixed".
pub(super) fn motion(name: &str) -> PyResult<Motion> {
    match name {
        "dynamic" => Ok(Motion::Dynamic),
        "resting" => Ok(Motion::Resting),
        "fixed" => Ok(Motion::Fixed),
        _ => Err(with_help(format!("unknown motion `{name}`"), "one of: dynamic, resting, fixed")),
    }
}

/// The choices of a world.
pub(super) fn builder(strategy: &str, finder: &str, threads: usize) -> PyResult<CullerBuilder> {
    let (strategy, finder): (Strategy, Finder) =
        (strategy.parse().map_err(refused)?, finder.parse().map_err(refused)?);
    let builder = sdop::Culler::builder().strategy(strategy).finder(finder);
    Ok(builder.threads(threads))
}

/// A body of `insert`'s parameters.
pub(super) fn body(
    shape: u32,
    (rotation, translation): ([f64; 4], [f64; 3]),
    margin: f32,
    dynamic: bool,
    (member, mask): (u32, u32),
) -> Body {
    let body = Body {
        shape,
        motion: if dynamic { Motion::Dynamic } else { Motion::Fixed },
        translation,
        margin,
        groups: Groups { member, mask },
        ..Body::default()
    };
    body.turned(rotation)
}

/// A body with the names of `insert`'s parameters, and whether it is "resting" or "rounded".
pub(super) fn named<'py>(py: Python<'py>, body: &Body) -> PyResult<Bound<'py, PyDict>> {
    let named = PyDict::new(py);
    named.set_item("shape", body.shape)?;
    named.set_item("rotation", body.rotation)?;
    named.set_item("rounded", body.rounded)?;
    named.set_item("translation", body.translation)?;
    named.set_item("margin", body.margin)?;
    named.set_item("dynamic", body.motion.is_dynamic())?;
    named.set_item("resting", body.motion == Motion::Resting)?;
    named.set_item("groups", (body.groups.member, body.groups.mask))?;
    Ok(named)
}

/// A rotation and a translation.
pub(super) fn pose(
    rotation: &Bound<'_, PyAny>,
    translation: &Bound<'_, PyAny>,
    exact: bool,
) -> PyResult<([f64; 4], [f64; 3])> {
    let rotation = one_row::<4>(rotation, "rotation", QUATERNION)?;
    let translation = one_row::<3>(translation, "translation", POSITION)?;
    Ok((
        rows::<4>(&rotation, "rotation", exact, ROUND)?.wide()[0],
        wide_rows::<3>(&translation, "translation")?[0],
    ))
}

/// The changes between two calls of `events`: three lists of pairs, each of shape (m, 2), sorted.
#[pyclass(frozen, module = "sdop")]
pub struct Events {
    begun: Vec<[u64; 2]>,
    persisting: Vec<[u64; 2]>,
    ended: Vec<[u64; 2]>,
}

impl Events {
    pub(super) fn new(events: &sdop::Events) -> Result<Self, CullError> {
        Ok(Self {
            begun: bits_of(events.begun())?,
            persisting: bits_of(events.persisting())?,
            ended: bits_of(events.ended())?,
        })
    }
}

#[pymethods]
impl Events {
    /// Pairs reported now and not before.
    #[getter]
    fn begun<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u64>>> {
        pairs(py, self.begun.clone())
    }

    /// Pairs reported now and before.
    #[getter]
    fn persisting<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u64>>> {
        pairs(py, self.persisting.clone())
    }

    /// Pairs reported before and not now.
    #[getter]
    fn ended<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u64>>> {
        pairs(py, self.ended.clone())
    }
}

/// A snapshot as bytes.
pub fn saved(snapshot: &impl serde::Serialize) -> PyResult<Vec<u8>> {
    serde_json::to_vec(snapshot)
        .map_err(|error| with_help(error, "this is a bug of sdop: please report it"))
}

/// A snapshot of bytes.
pub fn read_back<T: serde::de::DeserializeOwned>(bytes: &[u8]) -> PyResult<T> {
    let help = "pass what `snapshot` of this version has returned";
    serde_json::from_slice(bytes).map_err(|error| with_help(format!("no snapshot: {error}"), help))
}
