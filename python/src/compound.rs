//! Bodies of several shapes, and the pairs of their parts.

use std::sync::{Arc, Mutex};

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict as _, PyTuple};
use sdop::compound::{CompoundError, Part};

use super::arguments::{ShapeList, ShapeNumber};
use super::arrays::{check_length, pairs, rows, whole_column, wide_rows};
use super::errors::{lock, locked, refused};
use super::ids::{IdPairs, bits_of, collected};
use super::shape::Shape;
use super::world::{ROUND, World};
use super::worlds::counted;

/// Several shapes that move as one body: a robot, a vehicle, a concave mesh in convex pieces.
///
/// Give `compound.shape` to a `World` and insert one body per robot; a `PartCuller` finds the pairs
/// of parts within the world's pairs.
///
/// Parameters
/// ----------
/// shapes : list of Shape
/// part_shapes : array of whole numbers, shape (n,)
///     For each part, the index of its shape.
/// rotations : array of float32 or float64, shape (n, 4)
///     Quaternions x, y, z, w of any non-zero norm: each part's orientation in the body's frame. A
///     part is grown by what rounding to float32 moves.
/// translations : array of floats, shape (n, 3)
///     Position of each part's origin in the body's frame.
/// name : str
///     Its name in errors.
/// exact : bool
///     Whether rotations that float32 can't hold are rejected.
#[pyclass(frozen, module = "sdop")]
pub struct Compound {
    built: sdop::compound::Compound,
    shapes: Vec<Arc<sdop::Shape>>,
    parts: PoseColumns,
}

/// The number of each part's shape, its rotation and its translation.
type PoseColumns = (Vec<u32>, Vec<[f64; 4]>, Vec<[f64; 3]>);

#[pymethods]
impl Compound {
    #[new]
    #[pyo3(signature = (shapes, part_shapes, rotations, translations, *, name="compound", exact=false))]
    fn new(
        shapes: ShapeList,
        part_shapes: &Bound<'_, PyAny>,
        rotations: &Bound<'_, PyAny>,
        translations: &Bound<'_, PyAny>,
        name: &str,
        exact: bool,
    ) -> PyResult<Self> {
        let part_shapes = whole_column(part_shapes, "part_shapes")?;
        let rotations = rows::<4>(rotations, "rotations", exact, ROUND)?.wide();
        let translations = wide_rows::<3>(translations, "translations")?;
        check_length("rotations", rotations.len(), part_shapes.len())?;
        check_length("translations", translations.len(), part_shapes.len())?;
        let poses = rotations.iter().zip(&translations);
        let part = |(&shape, (&rotation, &translation)): (&u32, (&[f64; 4], &[f64; 3]))| {
            Part { shape, translation, ..Part::default() }.turned(rotation)
        };
        let parts: Vec<Part> = part_shapes.iter().zip(poses).map(part).collect();
        let built = sdop::compound::Compound::build(name, &shapes.built(), &parts);
        let parts = (part_shapes, rotations, translations);
        Ok(Self { built: built.map_err(refused)?, shapes: shapes.0, parts })
    }

    /// The shape that contains all parts, for a `World`.
    #[getter]
    fn shape(&self) -> Shape {
        Arc::new(self.built.shape().clone()).into()
    }

    /// Number of parts.
    fn __len__(&self) -> usize {
        self.built.parts()
    }

    /// The arguments of which `pickle` makes it again.
    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let shapes: Vec<Shape> = self.shapes.iter().map(|shape| shape.clone().into()).collect();
        let (numbers, rotations, translations) = self.parts.clone();
        let name = [("name", &self.built.shape().name)].into_py_dict(py)?;
        ((shapes, numbers, rotations, translations), name).into_pyobject(py)
    }

    fn __repr__(&self) -> String {
        let shape = self.built.shape();
        let (parts, radius) = (counted(self.built.parts(), "part", "parts"), shape.ball.radius);
        format!("<sdop.Compound {}: {parts}, radius {radius:.3}>", shape.name)
    }
}

/// Finds the pairs of parts within the pairs of bodies that a `World` reports. Parts of one body
/// are never paired.
///
/// If the meshes of two parts, each grown by its body's margin and posed by its own pose and then
/// by its body's, meet in exact arithmetic, and the world may report the bodies, the pair of parts
/// is reported.
#[pyclass(frozen, module = "sdop")]
pub struct PartCuller(Mutex<sdop::compound::PartCuller>);

/// Ids of bodies and numbers of parts.
type PartPairs<'py> = (IdPairs<'py>, Bound<'py, PyArray2<u32>>);

#[pymethods]
impl PartCuller {
    #[new]
    fn new() -> Self {
        Self(Mutex::default())
    }

    /// Says which parts a shape of the world has. The world's shape of that number has to be
    /// `compound.shape`.
    fn set_parts(&self, py: Python<'_>, shape: ShapeNumber, compound: &Compound) {
        let compound = compound.built.clone();
        locked(py, &self.0, |culler| culler.set_parts(shape.0, compound));
    }

    /// From now on, the world's shape of that number is one part.
    fn remove_parts(&self, py: Python<'_>, shape: ShapeNumber) {
        locked(py, &self.0, |culler| culler.remove_parts(shape.0));
    }

    /// The pairs of parts in the pairs of the world's last `cull`: call it after each, before
    /// bodies change.
    ///
    /// Returns
    /// -------
    /// array of uint64, shape (m, 2)
    ///     Ids of the bodies, sorted.
    /// array of uint32, shape (m, 2)
    ///     The number of each body's part; 0 for a body whose shape is not a compound.
    fn cull<'py>(&self, py: Python<'py>, world: &World) -> PyResult<PartPairs<'py>> {
        let world = &world.0;
        let found: Result<_, CompoundError> = locked(py, &self.0, |culler| {
            let found = culler.cull(&lock(world).world)?;
            let bodies = bits_of(found.iter().map(|pair| pair.bodies));
            Ok((bodies, collected(found.iter().map(|pair| pair.parts))))
        });
        let (bodies, parts) = found.map_err(refused)?;
        Ok((pairs(py, bodies.map_err(refused)?)?, pairs(py, parts.map_err(refused)?)?))
    }

    /// The pairs of bodies of which some parts may touch: ids of shape (m, 2), sorted.
    fn body_pairs<'py>(&self, py: Python<'py>) -> PyResult<IdPairs<'py>> {
        let found = locked(py, &self.0, |culler| bits_of(culler.body_pairs()));
        pairs(py, found.map_err(refused)?)
    }
}
