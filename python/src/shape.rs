//! Meshes prepared for culling.

use std::sync::{Arc, OnceLock};

use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::{PyOSError, PyUserWarning};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use sdop::mesh::{MeshError, Problem, ReadOptions, Scale};
use sdop::{Axes, DirectionSet, Origin, ShapeSpec, TriangleMesh};
use sdop_reference as reference;

use super::arguments::mistyped;
use super::arrays::{matrix, rows, whole_rows, wide_rows};
use super::errors::{refused, with_help};
use super::pickles::{self, reduced};
use super::worlds::counted;

/// A mesh with its bounding ball and or-DOP, made once and shared by any number of bodies.
///
/// Parameters
/// ----------
/// vertices : array of floats, shape (n, 3)
///     Positions in the mesh's frame, whose origin poses place. float64 is rounded to float32, about
///     a point near the mesh if it is far from its origin. Ball and or-DOP are grown by the bound of
///     that, `rounding`, so that no pair of the float64 meshes is missed. A `trimesh.Trimesh`, all
///     meshes of a `trimesh.Scene`, or a tuple (vertices, triangles) may be given alone.
/// triangles : array of whole numbers, shape (m, 3)
///     Vertex indices of each triangle.
/// radius : float, optional
///     Scales the mesh about its origin until its smallest enclosing ball has this radius.
/// origin : {"file", "ball"}
///     The point of the mesh that poses place: its origin, or the centre of its smallest enclosing
///     ball.
/// k : {6, 14, 18, 26}
///     Number of or-DOP faces.
/// axes : {"principal", "model"}
///     Axes of the or-DOP: principal axes of the hull, or the mesh's own.
/// name : str
///     Its name in errors.
#[pyclass(frozen, module = "sdop")]
pub struct Shape {
    pub(super) built: Arc<sdop::Shape>,
    judged: OnceLock<Result<reference::Shape, reference::InvalidInput>>,
}

/// What `pickle` stores of a shape. Slabs are computed again, to the same bits.
type SavedShape<'py> = (
    (String, Bound<'py, PyAny>, Bound<'py, PyAny>),
    ([f64; 3], [f64; 3], f64),
    (f32, f32, [f32; 3], f32),
    (usize, [[f32; 3]; 3]),
);

#[pymethods]
impl Shape {
    #[new]
    #[pyo3(signature = (vertices, triangles=None, *, radius=None, origin="file", k=18, axes="principal", name="mesh"))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn new(
        py: Python<'_>,
        vertices: &Bound<'_, PyAny>,
        triangles: Option<&Bound<'_, PyAny>>,
        radius: Option<f32>,
        origin: &str,
        k: u32,
        axes: &str,
        name: &str,
    ) -> PyResult<Self> {
        let [vertices, triangles] = match triangles {
            Some(triangles) => [vertices.clone(), triangles.clone()],
            None => mesh_of(vertices)?,
        };
        let vertices = wide_rows::<3>(&vertices, "vertices")?;
        let triangles = whole_rows::<3>(&triangles, "triangles")?;
        let spec = spec(radius, origin, k, axes)?;
        py.detach(|| {
            let mesh = TriangleMesh::from_f64(&vertices, &triangles).map_err(refused)?;
            Self::build(&mesh.named(name), &spec)
        })
    }

    /// Reads a mesh file: OBJ, STL, PLY, OFF or .tri. Coordinates are multiplied by `scale`, a
    /// number or one for each axis; negative ones mirror. Other keywords as for `Shape`. Warns of
    /// what had to be guessed or ignored. A missing file is a `FileNotFoundError`.
    #[staticmethod]
    #[pyo3(signature = (path, *, scale=None, radius=None, origin="file", k=18, axes="principal"))]
    fn load(
        py: Python<'_>,
        path: std::path::PathBuf,
        scale: Option<&Bound<'_, PyAny>>,
        radius: Option<f32>,
        origin: &str,
        k: u32,
        axes: &str,
    ) -> PyResult<Self> {
        let spec = spec(radius, origin, k, axes)?;
        let read = || sdop::mesh::read(&path, &ReadOptions::default());
        let mut mesh = py.detach(read).map_err(unread)?;
        if let Some(scale) = scale.map(self::scale).transpose()? {
            mesh = mesh.scaled(scale).map_err(refused)?;
        }
        for warning in &mesh.warnings {
            let text = std::ffi::CString::new(warning.replace('\0', " "))?;
            PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
        }
        py.detach(|| Self::build(&mesh, &spec))
    }

    /// Prepares the shape for `exact_meet`, which otherwise does so when it first gets the shape.
    fn _prepare(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| self.judged().map(|shape| _ = shape.mesh()))
    }

    /// The mesh's name.
    #[getter]
    fn name(&self) -> &str {
        &self.built.name
    }

    /// Vertices as culled, shape (n, 3): scale · (point of the mesh − offset), rounded to float32.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        matrix(py, &self.built.vertices)
    }

    /// Vertex indices of each triangle, shape (m, 3).
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        matrix(py, &self.built.triangles)
    }

    /// Smallest enclosing ball of the vertices, rounded up: centre x, y, z and radius.
    #[getter]
    fn ball(&self) -> ([f32; 3], f32) {
        (self.built.ball.centre, self.built.ball.radius)
    }

    /// Number of or-DOP faces.
    #[getter]
    fn k(&self) -> usize {
        2 * self.built.ordop.lo.len()
    }

    /// The or-DOP's slabs along its directions: lower and upper ends, each of shape (k / 2,).
    #[getter]
    fn slabs<'py>(
        &self,
        py: Python<'py>,
    ) -> (Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<f32>>) {
        let ordop = &self.built.ordop;
        (PyArray1::from_slice(py, &ordop.lo), PyArray1::from_slice(py, &ordop.hi))
    }

    /// The point of the mesh's coordinates that is the origin of `vertices`.
    #[getter]
    fn offset(&self) -> [f64; 3] {
        self.built.offset
    }

    /// The origin of `vertices` relative to the point that poses place: zero unless the
    /// mesh is so far from its origin that float32 can't hold its vertices there.
    #[getter]
    fn pose_offset(&self) -> [f64; 3] {
        self.built.pose_offset
    }

    /// A bound on the distance of the vertices from the float64 ones that were given; 0 if they are
    /// the same.
    #[getter]
    fn rounding(&self) -> f32 {
        self.built.rounding
    }

    /// The factor by which the mesh was scaled.
    #[getter]
    fn scale(&self) -> f64 {
        self.built.scale
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let (it, (centre, radius)) = (&self.built, self.ball());
        let (vertices, triangles) = (self.vertices(py)?.into_any(), self.triangles(py)?.into_any());
        let mesh = (it.name.clone(), vertices, triangles);
        let sizes = (it.rounding, it.reach, centre, radius);
        let ordop = (self.k(), it.ordop.basis.columns);
        reduced::<Self>(py, (mesh, (it.offset, it.pose_offset, it.scale), sizes, ordop))
    }

    #[staticmethod]
    fn _unpickled(version: u32, state: &Bound<'_, PyAny>) -> PyResult<Self> {
        let saved: SavedShape<'_> = pickles::state(version, state)?;
        let ((name, vertices, triangles), place, sizes, (k, columns)) = saved;
        let vertices = rows::<3>(&vertices, "vertices", true, "pass what was pickled")?;
        let triangles = whole_rows::<3>(&triangles, "triangles")?;
        let mesh = TriangleMesh::from_f32(vertices.narrow().unwrap_or_default(), &triangles);
        let directions = k.to_string().parse().map_err(refused)?;
        let spec = ShapeSpec { directions, axes: Axes::Model, ..ShapeSpec::default() };
        let mesh = mesh.map_err(refused)?.named(name);
        let mut built = sdop::Shape::build(&mesh, &spec).map_err(refused)?;
        (built.offset, built.pose_offset, built.scale) = place;
        (built.rounding, built.reach, built.ball.centre, built.ball.radius) = sizes;
        built.ordop.basis.columns = columns;
        Ok(Arc::new(built.with_directions(directions)).into())
    }

    fn __repr__(&self) -> String {
        let triangles = counted(self.built.triangles.len(), "triangle", "triangles");
        format!(
            "<sdop.Shape {}: {triangles}, radius {:.3}>",
            self.built.name, self.built.ball.radius
        )
    }
}

impl Shape {
    fn build(mesh: &TriangleMesh, spec: &ShapeSpec) -> PyResult<Self> {
        let built = sdop::Shape::build(mesh, spec).map_err(refused)?;
        Ok(Arc::new(built).into())
    }

    /// The mesh for the exact reference, prepared at first use.
    pub(super) fn judged(&self) -> PyResult<&reference::Shape> {
        let sdop::Shape { name, vertices, triangles, .. } = &*self.built;
        if self.built.is_far() {
            return Err(with_help(
                format!("shape `{name}` is far from the origin of its mesh"),
                "the exact answer is about float32 vertices: move the mesh to its origin, and add its place to the translations",
            ));
        }
        let of_mesh = || reference::Shape::of_mesh(vertices.clone(), triangles.clone());
        let judged = self.judged.get_or_init(of_mesh);
        judged.as_ref().map_err(|error| with_help(error, "pass a mesh that `Culler` takes"))
    }
}

impl From<Arc<sdop::Shape>> for Shape {
    fn from(built: Arc<sdop::Shape>) -> Self {
        Self { built, judged: OnceLock::new() }
    }
}

/// Why a file wasn't read. For the system's errors, `OSError` selects its subclass by the code.
fn unread(error: MeshError) -> PyErr {
    let MeshError { file, problem: Problem::Io { source, .. }, .. } = &error else {
        return refused(error);
    };
    let Some(code) = source.raw_os_error() else { return refused(error) };
    let text = source.to_string();
    let text = text.split(" (os error").next().unwrap_or_default();
    PyOSError::new_err((code, text.to_owned(), file.clone()))
}

fn spec(radius: Option<f32>, origin: &str, k: u32, axes: &str) -> PyResult<ShapeSpec> {
    let origin: Origin = origin.parse().map_err(refused)?;
    let directions: DirectionSet = k.to_string().parse().map_err(refused)?;
    let axes: Axes = axes.parse().map_err(refused)?;
    Ok(ShapeSpec { origin, radius, directions, axes })
}

/// Vertices and triangles of a mesh that comes as one object.
fn mesh_of<'py>(given: &Bound<'py, PyAny>) -> PyResult<[Bound<'py, PyAny>; 2]> {
    if let Ok(Ok(pair)) = given.cast::<PyTuple>().map(|tuple| tuple.extract()) {
        return Ok(pair);
    }
    let merged = given.getattr_opt("to_mesh")?.map(|merge| merge.call0()); // of a `trimesh.Scene`
    let given = &merged.unwrap_or_else(|| Ok(given.clone()))?;
    match (given.getattr_opt("vertices")?, given.getattr_opt("faces")?) {
        (Some(vertices), Some(triangles)) => Ok([vertices, triangles]),
        _ => Err(mistyped("the mesh", given, "pass a `trimesh.Trimesh`, or (vertices, triangles)")),
    }
}

/// One factor, or one for each axis.
fn scale(given: &Bound<'_, PyAny>) -> PyResult<Scale> {
    let axes = || given.extract::<[f64; 3]>().map(Scale::from);
    let scale = given.extract::<f64>().map(Scale::from).or_else(|_| axes());
    scale.map_err(|_| mistyped("scale", given, "pass a number, or three: for x, y and z"))
}
