//! Meshes: a culler of posed meshes, and the exact decision whether two of them meet.

use sdop_reference::exact::meeting;
use sdop_reference::{Pose, Shape as ExactShape};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use super::{check_length, one, rows};
use crate::bodies::Bodies;
use crate::counters::Counters;
use crate::culler::{Culler as MeshCuller, CullerBuilder};
use crate::mesh::TriangleMesh;
use crate::settings::{DirectionSet, Finder, Interest, Strategy};
use crate::volume::{Shape, ShapeSpec};

/// A mesh of triangles in its body's frame.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Mesh {
    mesh: TriangleMesh,
    exact: ExactShape,
}

#[wasm_bindgen]
impl Mesh {
    /// Makes a mesh of vertices, three numbers each, and of triangles, three vertex numbers each.
    #[wasm_bindgen(constructor)]
    pub fn new(vertices: &[f32], triangles: &[u32]) -> Result<Self, JsError> {
        let (vertices, triangles) = (rows(vertices, "vertices")?, rows(triangles, "triangles")?);
        let mesh = TriangleMesh::from_f32(vertices, triangles)?;
        let exact = ExactShape::of_mesh(vertices.to_vec(), triangles.to_vec())?;
        Ok(Self { mesh, exact })
    }
}

/// Whether two posed meshes share a point, touching and containment included, decided in exact
/// arithmetic. A pose is seven numbers: the quaternion x, y, z, w of any norm but 0, then the
/// position.
#[wasm_bindgen(js_name = exactMeet)]
pub fn exact_meet(
    first: &Mesh,
    first_pose: &[f32],
    second: &Mesh,
    second_pose: &[f32],
) -> Result<bool, JsError> {
    let (a, b) = (pose(first_pose)?, pose(second_pose)?);
    Ok(meeting::meet((first.exact.mesh(), &a), (second.exact.mesh(), &b)).meets)
}

fn pose(given: &[f32]) -> Result<Pose, JsError> {
    let [x, y, z, w, t @ ..]: [f32; 7] = one(given, "the pose")?;
    Ok(Pose::new([x, y, z, w], t)?)
}

/// Finds the pairs of posed meshes that might touch: it never misses a pair that does.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Culler {
    builder: CullerBuilder,
    spec: ShapeSpec,
    shapes: Vec<Shape>,
    bodies: Bodies,
    /// Made for these shapes and bodies by the first frame after a change.
    culler: Option<MeshCuller>,
    before: Counters,
}

/// What a frame counted: the terms of T = Nu·Cu + Nv·Cv + Co.
#[wasm_bindgen]
#[derive(Clone, Copy, Debug)]
pub struct Counts {
    /// Volumes updated, of all kinds.
    #[wasm_bindgen(readonly)]
    pub nu: f64,
    /// Pairs tested, over all volumes.
    #[wasm_bindgen(readonly)]
    pub nv: f64,
    /// Pairs that passed the first volume's test.
    #[wasm_bindgen(readonly)]
    pub hits: f64,
    /// Pairs reported.
    #[wasm_bindgen(readonly)]
    pub reported: f64,
}

#[wasm_bindgen]
impl Culler {
    /// Makes a culler without bodies. The strategy is "s-dop-sequential" if missing; `k`, the
    /// number of faces of or-DOPs, is 18; the finder of candidates is "auto".
    #[wasm_bindgen(constructor)]
    pub fn new(
        strategy: Option<String>,
        k: Option<u32>,
        finder: Option<String>,
    ) -> Result<Self, JsError> {
        let strategy: Strategy = strategy.as_deref().unwrap_or("s-dop-sequential").parse()?;
        let finder: Finder = finder.as_deref().unwrap_or("auto").parse()?;
        let directions: DirectionSet = k.unwrap_or(18).to_string().parse()?;
        Ok(Self {
            builder: MeshCuller::builder().strategy(strategy).finder(finder).k(directions),
            spec: ShapeSpec { directions, ..ShapeSpec::default() },
            ..Self::default()
        })
    }

    /// Adds a shape, with its bounding sphere and or-DOP, and returns its number.
    #[wasm_bindgen(js_name = addShape)]
    pub fn add_shape(&mut self, mesh: &Mesh) -> Result<u32, JsError> {
        self.shapes.push(Shape::build(&mesh.mesh, &self.spec)?);
        self.culler = None;
        Ok(self.shapes.len() as u32 - 1)
    }

    /// Adds a body of a shape and returns its number. Two fixed bodies are never a pair.
    #[wasm_bindgen(js_name = addBody)]
    pub fn add_body(&mut self, shape: u32, fixed: Option<bool>) -> u32 {
        self.bodies.push(shape, !fixed.unwrap_or(false), [0.0, 0.0, 0.0, 1.0], [0.0; 3]);
        self.culler = None;
        self.bodies.len() as u32 - 1
    }

    /// Sets the bodies of interest, for the strategy "s-dop-object-of-interest".
    #[wasm_bindgen(js_name = setInterest)]
    pub fn set_interest(&mut self, bodies: Vec<u32>) {
        self.builder = std::mem::take(&mut self.builder).interest(Interest::Bodies(bodies));
        self.culler = None;
    }

    /// Culls a frame: a quaternion x, y, z, w and a position for each body. Returns two body
    /// numbers i < j for each reported pair, sorted.
    pub fn cull(&mut self, rotations: &[f32], translations: &[f32]) -> Result<Vec<u32>, JsError> {
        let (rotations, translations) =
            (rows(rotations, "rotations")?, rows(translations, "translations")?);
        check_length("rotations", rotations.len(), self.bodies.len())?;
        check_length("translations", translations.len(), self.bodies.len())?;
        self.bodies.rotation.copy_from_slice(rotations);
        self.bodies.translation.copy_from_slice(translations);
        let culler = match self.culler.take() {
            Some(culler) => culler,
            None => self.builder.build(&self.shapes, &self.bodies)?,
        };
        let culler = self.culler.insert(culler);
        self.before = *culler.counters();
        Ok(culler.cull(&self.bodies)?.sorted().into_flattened())
    }

    /// The counts of the last frame.
    #[wasm_bindgen(getter)]
    pub fn counts(&self) -> Counts {
        let counters = self.culler.as_ref().map(|culler| culler.counters().since(&self.before));
        let counters = counters.unwrap_or_default();
        let volumes = self.builder.settings.strategy.scheme().volumes();
        let counted: Vec<_> = volumes.map(|volume| counters.of(volume)).collect();
        Counts {
            nu: counted.iter().map(|volume| volume.updates as f64).sum(),
            nv: counted.iter().map(|volume| volume.tests as f64).sum(),
            hits: counted.first().map_or(0.0, |volume| volume.hits as f64),
            reported: counters.reported as f64,
        }
    }
}
