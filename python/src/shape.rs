//! Meshes prepared for culling.

use std::sync::OnceLock;

use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::{PyOSError, PyUserWarning};
use pyo3::prelude::*;
use sdop::mesh::{MeshError, Problem, ReadOptions};
use sdop::{Axes, DirectionSet, Origin, ShapeSpec, TriangleMesh};
use sdop_judge::truth::reference_shapes::Shapes;
use sdop_reference as reference;

use super::arrays::{matrix, whole_rows, wide_rows};
use super::errors::{refused, with_help};

/// A mesh with its bounding ball and or-DOP, made once and shared by any number of bodies.
///
/// Parameters
/// ----------
/// vertices : array of floats, shape (n, 3), or a `trimesh.Trimesh`
///     Positions in the mesh's frame, whose origin poses place. float64 is rounded to float32, about
///     a point near the mesh if it is far from its origin. Ball and or-DOP are grown by the bound of
///     that, `rounding`, so that no pair of the float64 meshes is missed.
/// triangles : array of whole numbers, shape (m, 3)
///     Vertex indices of each triangle; left out for a `trimesh.Trimesh`.
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
    pub(super) built: sdop::Shape,
    judged: OnceLock<Result<reference::Shape, reference::InvalidInput>>,
}

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
        let (vertices, triangles) = match triangles {
            Some(triangles) => (vertices.clone(), triangles.clone()),
            None => (vertices.getattr("vertices")?, vertices.getattr("faces")?),
        };
        let vertices = wide_rows::<3>(&vertices, "vertices")?;
        let triangles = whole_rows::<3>(&triangles, "triangles")?;
        let spec = spec(radius, origin, k, axes)?;
        py.detach(|| {
            let mesh = TriangleMesh::from_f64(&vertices, &triangles).map_err(refused)?;
            Self::build(&mesh.named(name), &spec)
        })
    }

    /// Reads a mesh file: OBJ, STL, PLY, OFF or .tri. Keywords as for `Shape`. Warns of what had to
    /// be guessed or ignored. A missing file is a `FileNotFoundError`.
    #[staticmethod]
    #[pyo3(signature = (path, *, radius=None, origin="file", k=18, axes="principal"))]
    fn load(
        py: Python<'_>,
        path: std::path::PathBuf,
        radius: Option<f32>,
        origin: &str,
        k: u32,
        axes: &str,
    ) -> PyResult<Self> {
        let spec = spec(radius, origin, k, axes)?;
        let read = || sdop::mesh::read(&path, &ReadOptions::default());
        let mesh = py.detach(read).map_err(unread)?;
        for warning in &mesh.warnings {
            let text = std::ffi::CString::new(warning.replace('\0', " "))?;
            PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
        }
        py.detach(|| Self::build(&mesh, &spec))
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

    fn __repr__(&self) -> String {
        let Self { built, .. } = self;
        format!(
            "<sdop.Shape {}: {} vertices, {} triangles, k = {}>",
            built.name,
            built.vertices.len(),
            built.triangles.len(),
            self.k()
        )
    }
}

impl Shape {
    fn build(mesh: &TriangleMesh, spec: &ShapeSpec) -> PyResult<Self> {
        let built = sdop::Shape::build(mesh, spec).map_err(refused)?;
        Ok(built.into())
    }

    /// The shape for the exact reference, prepared at first use.
    pub(super) fn judged(&self) -> PyResult<&reference::Shape> {
        if self.built.is_far() {
            return Err(with_help(
                format!("shape `{}` is far from the origin of its mesh", self.built.name),
                "the exact answer is about float32 vertices: move the mesh to its origin, and add its place to the translations",
            ));
        }
        let judged = self.judged.get_or_init(|| {
            let mut shapes = Shapes::new(vec![self.built.clone()])?;
            Ok(shapes.judged.remove(0))
        });
        judged.as_ref().map_err(|error| with_help(error, "pass a mesh that `Culler` takes"))
    }
}

impl From<sdop::Shape> for Shape {
    fn from(built: sdop::Shape) -> Self {
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

/// Shapes of a list.
pub fn built(shapes: &[PyRef<'_, Shape>]) -> Vec<sdop::Shape> {
    shapes.iter().map(|shape| shape.built.clone()).collect()
}
