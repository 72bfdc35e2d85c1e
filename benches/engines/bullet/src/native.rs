//! A scene in Bullet: `native/scene.cpp`.

#![allow(unsafe_code, reason = "the other side is C++")]

use std::ffi::c_void;

use sdop::mesh::TriangleMesh;
use serde::{Deserialize, Serialize};

use crate::plan::{Kind, Mode};

unsafe extern "C" {
    fn scene_new(mode: u32) -> *mut c_void;
    fn scene_free(scene: *mut c_void);
    fn scene_gravity(scene: *mut c_void, gravity: *const [f32; 3]);
    fn scene_wall(scene: *mut c_void, normal: *const [f32; 3], d: f32, restitution: f32);
    fn scene_shape(
        scene: *mut c_void,
        kind: u32,
        vertices: *const [f32; 3],
        count: usize,
        triangles: *const [u32; 3],
        triangle_count: usize,
    ) -> u32;
    fn scene_model(
        scene: *mut c_void,
        shape: u32,
        vertices: *const [f32; 3],
        count: usize,
        triangles: *const [u32; 3],
        triangle_count: usize,
        share: f32,
    ) -> i32;
    fn scene_body(
        scene: *mut c_void,
        shape: u32,
        model: i32,
        motion: *const Motion,
        restitution: f32,
        friction: f32,
    );
    fn scene_step(scene: *mut c_void, seconds: f32);
    fn scene_counts(scene: *const c_void) -> Counts;
}

/// How a body starts.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Quaternion x, y, z, w.
    pub rotation: [f32; 4],
    /// Where its origin is.
    pub translation: [f32; 3],
    /// Per second.
    pub velocity: [f32; 3],
    /// Radians per second.
    pub spin: [f32; 3],
}

/// Sums over all steps so far.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    /// Pairs whose boxes overlap, with a body awake.
    pub asked: u64,
    /// Of them, those that the filter rejects.
    pub rejected: u64,
    /// Those with contact points after Bullet's check. Judged runs alone, as all below.
    pub touching: u64,
    /// Of these, those that the filter rejects. Must be zero.
    pub dropped: u64,
    /// Nanoseconds of Bullet's checks of the pairs that the filter rejects.
    pub rejected_ns: f64,
    /// Of the pairs with contact points.
    pub touching_ns: f64,
    /// Of the filter's tests.
    pub test_ns: f64,
}

/// Vertices and triangles that a shape looks at.
type Mesh = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// A scene, and the meshes that its shapes look at.
pub struct Scene {
    scene: *mut c_void,
    meshes: Vec<Mesh>,
}

/// A shape that bodies can have.
#[derive(Clone, Copy, Debug)]
pub struct ShapeId {
    shape: u32,
    model: i32,
}

impl Scene {
    /// An empty one.
    #[must_use]
    pub fn new(mode: Mode) -> Self {
        Self {
            // SAFETY: it asks for nothing.
            scene: unsafe { scene_new(mode as u32) },
            meshes: Vec::new(),
        }
    }

    /// Gravity from now on; wakes all bodies.
    pub fn set_gravity(&mut self, gravity: [f32; 3]) {
        // SAFETY: three floats, read during the call.
        unsafe { scene_gravity(self.scene, &raw const gravity) }
    }

    /// A wall; the half-space n·x ≥ d stays free.
    pub fn wall(&mut self, normal: [f32; 3], d: f32, restitution: f32) {
        // SAFETY: three floats, read during the call.
        unsafe { scene_wall(self.scene, &raw const normal, d, restitution) }
    }

    /// A shape, whose pairs are filtered if it is a hull or a mesh. Its margin is taken times
    /// `share`: 1, but for a planted bug.
    pub fn shape(&mut self, kind: Kind, mesh: &TriangleMesh, share: f32) -> ShapeId {
        self.meshes.push((mesh.vertices.clone(), mesh.triangles.clone()));
        let (vertices, triangles) = &self.meshes[self.meshes.len() - 1];
        let (v, n, t, m) = (vertices.as_ptr(), vertices.len(), triangles.as_ptr(), triangles.len());
        // SAFETY: the counts are those of the vectors; the vectors' buffers stay where they are
        // until the scene has ended.
        let shape = unsafe { scene_shape(self.scene, kind as u32, v, n, t, m) };
        let model = match kind {
            // SAFETY: a shape of this scene; arrays as above, read during the call; the scene isn't
            // stepping.
            Kind::Hull | Kind::Mesh => unsafe { scene_model(self.scene, shape, v, n, t, m, share) },
            Kind::Box | Kind::Ball => -1,
        };
        ShapeId { shape, model }
    }

    /// A body of mass 1.
    pub fn body(&mut self, shape: ShapeId, motion: Motion, restitution: f32, friction: f32) {
        let ShapeId { shape, model } = shape;
        // SAFETY: a shape of this scene; thirteen floats, read during the call.
        unsafe {
            scene_body(self.scene, shape, model, &raw const motion, restitution, friction);
        }
    }

    /// One step.
    pub fn step(&mut self, seconds: f32) {
        // SAFETY: a scene that hasn't ended.
        unsafe { scene_step(self.scene, seconds) }
    }

    /// What has happened so far.
    #[must_use]
    pub fn counts(&self) -> Counts {
        // SAFETY: a scene that hasn't ended.
        unsafe { scene_counts(self.scene) }
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: made by `new`, and ended once, before the arrays that its shapes look at.
        unsafe { scene_free(self.scene) }
    }
}
