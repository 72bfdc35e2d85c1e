//! [`Shape`], a mesh with its volumes, and [`Body`], a shape with a pose.

use std::sync::OnceLock;

use crate::InvalidInput;
use crate::exact::mesh::Mesh;
use crate::exact::polytope::Polytope;
use crate::linear::Vector;
use crate::pose::Pose;
use crate::volume::{Ball, DirectionSet, Slabs, check_mesh};

/// A mesh with its volumes.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Bounding ball.
    pub ball: Ball,
    /// Oriented k-DOP.
    pub slabs: Slabs,
    /// Its corners, exact and rounded.
    pub polytope: Polytope,
    /// The oriented box's polytope: of the slabs' first three axes unless [`Shape::with_obb`] gave
    /// another.
    pub obb: Polytope,
    /// Vertices as culled.
    pub vertices: Vec<[f32; 3]>,
    /// Vertex triples.
    pub triangles: Vec<[u32; 3]>,
    mesh: OnceLock<Mesh>,
}

impl Shape {
    /// A shape of a ball, slabs and a mesh. It is not checked whether the volumes contain the mesh.
    ///
    /// # Errors
    /// When a number is not finite, the slabs are not k/2, the basis is not exact or an index is
    /// out of range.
    pub fn new(
        ball: Ball,
        slabs: Slabs,
        vertices: Vec<[f32; 3]>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, InvalidInput> {
        if !ball.centre.iter().all(|x| x.is_finite()) {
            return Err(InvalidInput::NotFinite("the ball's centre"));
        }
        if !(ball.radius >= 0.0 && ball.radius.is_finite()) {
            return Err(InvalidInput::Radius);
        }
        check_mesh(&vertices, &triangles)?;
        let polytope = Polytope::new(&slabs)?;
        let obb = Polytope::new(&slabs.axes_only())?;
        Ok(Self { ball, slabs, polytope, obb, vertices, triangles, mesh: OnceLock::new() })
    }

    /// A mesh of which only the triangles are used: its ball and slabs are those of a cube about
    /// the origin, whatever the mesh.
    ///
    /// # Errors
    /// When a coordinate is not finite or an index is out of range.
    pub fn of_mesh(
        vertices: Vec<[f32; 3]>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, InvalidInput> {
        let ball = Ball { centre: [0.0; 3], radius: 2.0 };
        let slabs = Slabs {
            directions: DirectionSet::K6,
            basis: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            lo: vec![-1.0; 3],
            hi: vec![1.0; 3],
        };
        Self::new(ball, slabs, vertices, triangles)
    }

    /// The shape with another oriented box (`directions` K6) for the `obb` strategy.
    ///
    /// # Errors
    /// As [`Shape::new`].
    pub fn with_obb(self, slabs: &Slabs) -> Result<Self, InvalidInput> {
        Ok(Self { obb: Polytope::new(slabs)?, ..self })
    }

    /// The mesh prepared for exact judgement, at first use.
    pub fn mesh(&self) -> &Mesh {
        self.mesh.get_or_init(|| Mesh::checked(&self.vertices, &self.triangles))
    }

    /// The vertices in f64.
    pub fn points(&self) -> impl Iterator<Item = Vector<f64>> {
        self.vertices.iter().map(|v| v.map(f64::from))
    }
}

/// A rigid body: its shape, its pose, and whether it may move.
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    /// Mesh and volumes in the body frame.
    pub shape: &'a Shape,
    /// Position and orientation.
    pub pose: Pose,
    /// Whether it may move. Pairs of two bodies that may not are never reported.
    pub dynamic: bool,
}
