//! Prepared meshes, and a fixed set of bodies that is culled frame after frame.

use std::ffi::c_char;

use super::border::{
    Buffer, Out, Refusal, SdopPair, SdopStatus, answer, column, free, handle, list, make, optional,
    pairs, shared, text,
};
use crate::bodies::{Bodies, Groups};
use crate::culler::{Culler, CullerBuilder};
use crate::mesh::TriangleMesh;
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

/// The specification that C gives.
///
/// # Safety
/// The pointer is null or to a specification.
unsafe fn spec(given: *const SdopShapeSpec) -> Result<ShapeSpec, Refusal> {
    // SAFETY: the caller's promise.
    let Some(given) = (unsafe { given.as_ref() }) else {
        return Ok(ShapeSpec::default());
    };
    let directions: DirectionSet = match given.k {
        0 => ShapeSpec::default().directions,
        k => k.to_string().parse()?,
    };
    Ok(ShapeSpec {
        origin: if given.about_ball { Origin::Ball } else { Origin::File },
        radius: (given.radius != 0.0).then_some(given.radius),
        directions,
        axes: if given.on_model_axes { Axes::Model } else { Axes::Principal },
    })
}

/// Makes a shape of vertices in the mesh's own frame, to whose origin poses refer, and vertex
/// indices of triangles. Its volumes are grown by what rounding the vertices to float moves. `spec`
/// may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_shape_new(
    vertices: *const [f64; 3],
    vertex_count: usize,
    triangles: *const [u32; 3],
    triangle_count: usize,
    spec: *const SdopShapeSpec,
    out: *mut *mut SdopShape,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || {
        // SAFETY: the caller's promise.
        let vertices = unsafe { column(vertices, vertex_count, "vertices") }?;
        // SAFETY: the caller's promise.
        let triangles = unsafe { column(triangles, triangle_count, "triangles") }?;
        let mesh = TriangleMesh::from_f64(vertices, triangles)?;
        // SAFETY: the caller's promise.
        let shape = Shape::build(&mesh, &unsafe { self::spec(spec) }?)?;
        Ok(SdopShape(shape))
    })
}

/// Frees a shape; null is fine. Cullers and worlds keep copies.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_shape_free(shape: *mut SdopShape) {
    // SAFETY: the caller's promise.
    unsafe { free(shape) }
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
/// The pointer is null or to options, whose texts are null or end with a zero.
pub(super) unsafe fn builder(options: *const SdopOptions) -> Result<CullerBuilder, Refusal> {
    // SAFETY: the caller's promise.
    let Some(options) = (unsafe { options.as_ref() }) else {
        return Ok(Culler::builder());
    };
    // SAFETY: the caller's promise.
    let strategy: Strategy = unsafe { text(options.strategy, "s-dop-sequential") }?.parse()?;
    // SAFETY: the caller's promise.
    let finder: Finder = unsafe { text(options.finder, "auto") }?.parse()?;
    let builder = Culler::builder().strategy(strategy).finder(finder);
    Ok(builder.threads(options.threads))
}

/// Copies of the shapes to which a column of handles refers.
///
/// # Safety
/// The column has the stated number of entries, each a shape or null.
pub(super) unsafe fn shapes(
    first: *const *const SdopShape,
    count: usize,
) -> Result<Vec<Shape>, Refusal> {
    // SAFETY: the caller's promise.
    let handles = unsafe { column(first, count, "shapes") }?;
    // SAFETY: the caller's promise.
    let copy = |shape: &*const SdopShape| Ok(unsafe { shared(*shape, "shape") }?.0.clone());
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

/// Makes the culler of these bodies. `options` may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_culler_new(
    shapes: *const *const SdopShape,
    shape_count: usize,
    bodies: *const SdopBodies,
    options: *const SdopOptions,
    out: *mut *mut SdopCuller,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    make(unsafe { Out::new(out) }, || {
        // SAFETY: the caller's promise.
        let (shapes, given) =
            unsafe { (self::shapes(shapes, shape_count)?, shared(bodies, "bodies")?) };
        let n = given.count;
        // SAFETY: the caller's promise.
        let bodies = unsafe {
            Bodies {
                shape: column(given.shape, n, "shape")?.to_vec(),
                dynamic: optional(given.dynamic, n).map_or_else(|| vec![true; n], <[bool]>::to_vec),
                rotation: column(given.rotation, n, "rotation")?.to_vec(),
                translation: column(given.translation, n, "translation")?.to_vec(),
            }
        };
        // SAFETY: the caller's promise.
        let (builder, groups) = unsafe { (builder(options)?, optional(given.groups, n)) };
        let mut culler = builder.build(&shapes, &bodies)?;
        culler.set_groups(groups.map(<[Groups]>::to_vec))?;
        Ok(SdopCuller { culler, bodies })
    })
}

/// Frees a culler; null is fine.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_culler_free(culler: *mut SdopCuller) {
    // SAFETY: the caller's promise.
    unsafe { free(culler) }
}

/// Finds the pairs that might touch at these poses, one of each column for each body. Static bodies
/// that have moved are found where they are now; such a frame takes about twice as long. `pairs`
/// gets their number; read them with `sdop_culler_pairs`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_culler_cull(
    culler: *mut SdopCuller,
    rotation: *const [f32; 4],
    translation: *const [f32; 3],
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { cull(culler, rotation, translation, None, pairs) }
}

/// `sdop_culler_cull`, if there are at most `limit` pairs; more are an error that has their number,
/// and memory for them is never allocated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_culler_cull_up_to(
    culler: *mut SdopCuller,
    rotation: *const [f32; 4],
    translation: *const [f32; 3],
    limit: usize,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    unsafe { cull(culler, rotation, translation, Some(limit), pairs) }
}

/// Culls at poses, up to a number of pairs if there is a limit.
///
/// # Safety
/// As `sdop_culler_cull`.
unsafe fn cull(
    culler: *mut SdopCuller,
    rotation: *const [f32; 4],
    translation: *const [f32; 3],
    limit: Option<usize>,
    pairs: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    answer(unsafe { Out::new(pairs) }, "pairs", || {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(culler, "culler") }?;
        let n = it.bodies.len();
        // SAFETY: the caller's promise.
        let (rotation, translation) =
            unsafe { (column(rotation, n, "rotation")?, column(translation, n, "translation")?) };
        it.bodies.rotation.copy_from_slice(rotation);
        it.bodies.translation.copy_from_slice(translation);
        Ok(match limit {
            Some(limit) => it.culler.cull_up_to(&it.bodies, limit)?.len(),
            None => it.culler.cull(&it.bodies)?.len(),
        })
    })
}

/// Copies the pairs of the last frame into `buffer`. If they don't fit, `count` says how many there
/// are.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdop_culler_pairs(
    culler: *mut SdopCuller,
    buffer: *mut SdopPair,
    capacity: usize,
    count: *mut usize,
) -> SdopStatus {
    // SAFETY: the caller's promise.
    list(unsafe { Buffer::new(buffer, capacity, count) }, || {
        // SAFETY: the caller's promise.
        let it = unsafe { handle(culler, "culler") }?;
        Ok(pairs(it.culler.pairs()))
    })
}
