//! Long-lived worlds.

use std::sync::Mutex;

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyIterator, PyTuple};
use sdop::culler::CullerBuilder;
use sdop::{Body, BodyId, Groups, Motion};

use super::arguments::{GroupBits, Id, ShapeList, ShapeNumber};
use super::arrays::{check_length, id_column, one_row, pairs, rows, wide_rows};
use super::errors::{locked, refused, with_help};
use super::ids::{IdPairs, bits_of};
use super::pickles::{self, reduced};
use super::shape::Shape;
use super::worlds::{
    Choices, SavedWorld, ShapeSlots, WorldState, counted, events_class, living_class, mesh_class,
    world_class,
};

pub(super) const ROUND: &str =
    "pass a float32 quaternion, or leave `exact` out: bodies are then grown by what rounding moves";

pub(super) const QUATERNION: &str = "pass four numbers: a quaternion x, y, z, w";
pub(super) const POSITION: &str = "pass three numbers: x, y, z";

mesh_class! {
    living_class, sdop::World::set_pose_f64,
    /// A long-lived set of bodies that come and go, with stable ids, groups, contact margins,
    /// float64 translations, and pairs as a list or as events.
    ///
    /// At every `cull`, if two meshes, each grown by its body's margin and posed at its float64
    /// translation, meet in exact arithmetic, one of them is dynamic and their groups collide, the
    /// pair is reported.
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
    World, sdop::World, {
        #[new]
        #[pyo3(signature = (shapes, *, strategy="s-dop-sequential", finder="auto", threads=1))]
        fn new(shapes: ShapeList, strategy: &str, finder: &str, threads: usize) -> PyResult<Self> {
            let shapes = shapes.0.into_iter().map(Some).collect();
            let choices = (strategy.to_owned(), finder.to_owned(), threads);
            Ok(Self(Mutex::new(Self::made(shapes, choices)?)))
        }

        /// Adds a shape and returns its number, the lowest free one.
        fn add_shape(&self, py: Python<'_>, shape: &Shape) -> PyResult<u32> {
            let added = shape.built.clone();
            locked(py, &self.0, |WorldState { world, shapes, .. }| {
                let number = world.add_shape(sdop::Shape::clone(&added))?;
                shapes.resize(shapes.len().max(number as usize + 1), None);
                shapes[number as usize] = Some(added);
                Ok::<_, sdop::WorldError>(number)
            })
            .map_err(refused)
        }

        /// Removes a shape that no body uses.
        fn remove_shape(&self, py: Python<'_>, shape: ShapeNumber) -> PyResult<()> {
            locked(py, &self.0, |WorldState { world, shapes, .. }| {
                world.remove_shape(shape.0).map(|()| shapes[shape.0 as usize] = None)
            })
            .map_err(refused)
        }

        /// Replaces the shape of a number: its bodies have the new one from the next cull on.
        fn replace_shape(&self, py: Python<'_>, number: ShapeNumber, shape: &Shape) -> PyResult<()> {
            let new = shape.built.clone();
            locked(py, &self.0, |WorldState { world, shapes, .. }| {
                let replaced = world.replace_shape(number.0, &new);
                replaced.map(|()| shapes[number.0 as usize] = Some(new))
            })
            .map_err(refused)
        }
    }
}

impl World {
    /// A world with shapes under their numbers, and choices by name.
    fn made(shapes: ShapeSlots, choices: Choices) -> PyResult<WorldState<sdop::World>> {
        // Numbers that are free get a shape for now.
        let any = shapes.iter().flatten().next_back();
        let filled = shapes.iter().filter_map(|shape| shape.as_ref().or(any));
        let filled = filled.map(|shape| sdop::Shape::clone(shape)).collect();
        let builder = builder(&choices.0, &choices.1, choices.2)?;
        let mut world = sdop::World::with(filled, &builder).map_err(refused)?;
        for (number, _) in (0..).zip(&shapes).filter(|(_, shape)| any.is_some() && shape.is_none())
        {
            world.remove_shape(number).map_err(refused)?;
        }
        Ok(WorldState { world, shapes, choices })
    }
}

/// The names of motions.
const MOTIONS: [(&str, Motion); 3] =
    [("dynamic", Motion::Dynamic), ("resting", Motion::Resting), ("fixed", Motion::Fixed)];

/// The motion of a name.
pub(super) fn motion(name: &str) -> PyResult<Motion> {
    let known = MOTIONS.iter().find(|(known, _)| *known == name);
    known.map(|&(_, motion)| motion).ok_or_else(|| {
        with_help(format!("unknown motion `{name}`"), "one of: dynamic, resting, fixed")
    })
}

/// The choices of a world.
pub(super) fn builder(strategy: &str, finder: &str, threads: usize) -> PyResult<CullerBuilder> {
    let builder = sdop::Culler::builder().strategy(strategy.parse().map_err(refused)?);
    Ok(builder.finder(finder.parse().map_err(refused)?).threads(threads))
}

/// A body with the names of `insert`'s parameters, and whether its rotation was "rounded".
pub(super) fn named<'py>(py: Python<'py>, body: &Body) -> PyResult<Bound<'py, PyDict>> {
    let named = PyDict::new(py);
    named.set_item("shape", body.shape)?;
    named.set_item("rotation", body.rotation)?;
    named.set_item("rounded", body.rounded)?;
    named.set_item("translation", body.translation)?;
    named.set_item("margin", body.margin)?;
    let motion = MOTIONS.iter().find(|(_, motion)| *motion == body.motion);
    named.set_item("motion", motion.map(|(name, _)| name))?;
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

events_class! {
    /// The changes between two calls of `events`: lists of pairs, each of shape (m, 2), sorted.
    Events, sdop::Events, IdPairs<'py>, id_pairs
}

/// The ids of pairs.
fn id_pairs(
    py: Python<'_>,
    found: impl Iterator<Item = [BodyId; 2]> + Send,
) -> PyResult<IdPairs<'_>> {
    pairs(py, py.detach(|| bits_of(found)).map_err(refused)?)
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
