//! Prepared meshes, and a fixed set of bodies that is culled frame after frame.

use std::ffi::c_char;

use super::border::{SdopPair, SdopTakePairs, border};
use super::call::{Refusal, column, optional, required, text};
use crate::bodies::{Bodies, Groups};
use crate::culler::{Culler, CullerBuilder};
use crate::mesh::{self, ReadOptions, TriangleMesh};
use crate::settings::{Axes, DirectionSet, Finder, Strategy};
use crate::volume::{Origin, Shape, ShapeSpec};

/// A mesh with its bounding ball and or-DOP.
#[derive(Debug)]
pub struct SdopShape(pub(super) Shape);

/// How a mesh becomes a shape. All zeros is the default.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdopShapeSpec {
    /// Number of or-DOP faces: 6, 14, 18 or 26; 0 is 18.
    pub k: u32,
    /// Scales the mesh about its origin until its smallest enclosing ball has this radius; 0 keeps
    /// its size.
    pub radius: f32,
    /// Whether poses place the centre of the smallest enclosing ball instead of the mesh's own
    /// origin.
    pub about_ball: bool,
    /// Whether the or-DOP uses the mesh's own axes instead of the principal axes of its hull.
    pub on_model_axes: bool,
}

/// The directions of or-DOPs with so many faces, or 0 for the default.
pub(super) fn directions(k: u32) -> Result<DirectionSet, Refusal> {
    Ok(if k == 0 { ShapeSpec::default().directions } else { k.to_string().parse()? })
}

/// The specification that C gives.
fn spec(given: Option<&SdopShapeSpec>) -> Result<ShapeSpec, Refusal> {
    let Some(given) = given else {
        return Ok(ShapeSpec::default());
    };
    Ok(ShapeSpec {
        origin: if given.about_ball { Origin::Ball } else { Origin::File },
        radius: (given.radius != 0.0).then_some(given.radius),
        directions: directions(given.k)?,
        axes: if given.on_model_axes { Axes::Model } else { Axes::Principal },
    })
}

border! {
shape: SdopShape;

/// Makes a shape of vertices in the mesh's own frame, to whose origin poses refer, and vertex
/// indices of triangles. Its volumes are grown by what rounding the vertices to float moves. `spec`
/// may be null.
fn sdop_shape_new(
    [*const vertices: [f64; 3]; vertex_count],
    [*const triangles: [u32; 3]; triangle_count],
    ?const spec: SdopShapeSpec,
) -> new SdopShape {
    SdopShape(Shape::build(&TriangleMesh::from_f64(vertices, triangles)?, &self::spec(spec)?)?)
}

/// Makes a shape of the mesh in a file: OBJ, STL, PLY, OFF or `.tri`. `spec` may be null.
fn sdop_shape_load(?text path, ?const spec: SdopShapeSpec) -> new SdopShape {
    let mesh = mesh::read(required(path, "path")?, &ReadOptions::default())?;
    SdopShape(Shape::build(&mesh, &self::spec(spec)?)?)
}

/// Frees a shape; null is fine. Cullers and worlds keep copies.
free sdop_shape_free;
/// The margin that a body needs for a whole step of `seconds`, if its origin is at most as fast as
/// `linear` and it turns at most as fast as `angular`, in radians per second. Two bodies with such
/// margins that meet at any time of the step are a pair at its start.
fn sdop_shape_swept_margin(
    *const shape,
    *const linear: [f32; 3],
    *const angular: [f32; 3],
    seconds: f32,
) -> *mut margin: f32 {
    shape.0.swept_margin(*linear, *angular, seconds)
}
}

/// How bodies are culled. All zeros is the default.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdopOptions {
    /// Which volumes are tested; null is "s-dop-sequential", spheres and then or-DOPs.
    pub strategy: *const c_char,
    /// The finder of candidate pairs; null is "auto".
    pub finder: *const c_char,
    /// Number of threads; 0 is 1.
    pub threads: usize,
}

/// How a culler is made of what C gives.
///
/// # Safety
/// Texts are null or end with a zero.
pub(super) unsafe fn builder(given: Option<&SdopOptions>) -> Result<CullerBuilder, Refusal> {
    let Some(given) = given else {
        return Ok(Culler::builder());
    };
    // SAFETY: the caller's promise.
    let (strategy, finder) = unsafe { (text(given.strategy)?, text(given.finder)?) };
    let strategy: Strategy = strategy.unwrap_or("s-dop-sequential").parse()?;
    let finder: Finder = finder.unwrap_or("auto").parse()?;
    Ok(Culler::builder().strategy(strategy).finder(finder).threads(given.threads))
}

/// Copies of the shapes to which a column of handles refers.
pub(super) fn copies(handles: &[Option<&SdopShape>]) -> Result<Vec<Shape>, Refusal> {
    let copy = |shape: &Option<&SdopShape>| Ok(required(*shape, "shape")?.0.clone());
    handles.iter().map(copy).collect()
}

/// Culls the frames of a fixed set of bodies whose poses change.
#[derive(Debug)]
pub struct SdopCuller {
    culler: Culler,
    bodies: Bodies,
}

/// Bodies as columns of `count` entries.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SdopBodies {
    /// Number of bodies.
    pub count: usize,
    /// For each body, the number of its shape.
    pub shape: *const u32,
    /// Whether each body may move; null: all may. A pair of two bodies that may not is never
    /// reported.
    pub dynamic: *const bool,
    /// Quaternions x, y, z, w of any non-zero norm.
    pub rotation: *const [f32; 4],
    /// Translations of the bodies' origins, world frame.
    pub translation: *const [f32; 3],
    /// Which bodies may collide; null: all.
    pub groups: *const Groups,
}

impl SdopBodies {
    /// Copies of the columns.
    ///
    /// # Safety
    /// They have `count` entries, or are null.
    unsafe fn copied(&self) -> Result<(Bodies, Option<Vec<Groups>>), Refusal> {
        let n = self.count;
        // SAFETY: the caller's promise.
        unsafe {
            let dynamic = optional(self.dynamic, n);
            let bodies = Bodies {
                shape: column(self.shape, n, "shape")?.to_vec(),
                dynamic: dynamic.map_or_else(|| vec![true; n], <[bool]>::to_vec),
                rotation: column(self.rotation, n, "rotation")?.to_vec(),
                translation: column(self.translation, n, "translation")?.to_vec(),
            };
            Ok((bodies, optional(self.groups, n).map(<[Groups]>::to_vec)))
        }
    }
}

impl SdopCuller {
    /// Puts all bodies at new poses.
    fn pose(&mut self, rotation: &[[f32; 4]], translation: &[[f32; 3]]) {
        self.bodies.rotation.copy_from_slice(rotation);
        self.bodies.translation.copy_from_slice(translation);
    }
}

border! {
culler: SdopCuller;

/// Makes the culler of these bodies. `options` may be null.
fn sdop_culler_new(
    [*const shapes: Option<&SdopShape>; shape_count],
    *const bodies: SdopBodies,
    ?const options: SdopOptions,
) -> new SdopCuller {
    // SAFETY: the caller's promise.
    let ((bodies, groups), builder) = unsafe { (bodies.copied()?, builder(options)?) };
    let mut culler = builder.build(&copies(shapes)?, &bodies)?;
    culler.set_groups(groups)?;
    SdopCuller { culler, bodies }
}

/// Frees a culler; null is fine.
free sdop_culler_free;
/// Finds the pairs that might touch at these poses, one of each column for each body. Static bodies
/// that have moved are found where they are now; such a frame takes about twice as long. `pairs`
/// gets their number; read them with `sdop_culler_pairs`.
fn sdop_culler_cull(
    *mut culler,
    [*const rotation: [f32; 4], *const translation: [f32; 3]; = culler.bodies.len()],
) -> *mut pairs: usize {
    culler.pose(rotation, translation);
    culler.culler.cull(&culler.bodies)?.len()
}

/// `sdop_culler_cull`, if there are at most `limit` pairs; more are an error that has their number,
/// and memory for them is never allocated.
fn sdop_culler_cull_up_to(
    *mut culler,
    [*const rotation: [f32; 4], *const translation: [f32; 3]; = culler.bodies.len()],
    limit: usize,
) -> *mut pairs: usize {
    culler.pose(rotation, translation);
    culler.culler.cull_up_to(&culler.bodies, limit)?.len()
}

/// Copies the pairs of the last frame into `buffer`. If they don't fit, `count` says how many there
/// are.
fn sdop_culler_pairs(*mut culler) -> [SdopPair] { culler.culler.pairs().iter() }
/// Culls as `sdop_culler_cull` does and passes the pairs to `take`, about 65,000 at a time, so that
/// memory doesn't grow with their number. With several threads, `take` is called from any of them,
/// one call at a time.
fn sdop_culler_cull_each(
    *mut culler,
    [*const rotation: [f32; 4], *const translation: [f32; 3]; = culler.bodies.len()],
    |take: SdopTakePairs|,
) {
    culler.pose(rotation, translation);
    culler.culler.cull_in_portions(&culler.bodies, move |pairs| take.all(pairs.iter()))?;
}
}
