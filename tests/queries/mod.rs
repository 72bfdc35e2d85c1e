//! Queries against exact truth: no body that a volume or a line meets is missed, on any tier, on
//! any number of threads, whatever has come and gone.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod bodies;
mod boxes;
mod corners;
mod lives;
mod sets;

use crate::boxes::scenes;
use crate::forms;
use sdop::volume::{DirectionSet, ShapeSpec};
use sdop::{BodyId, ProceduralShape, QueryIndex, Shape, Tier};

use forms::FORMS;

const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// Meshes of all kinds: with faces on the axes, round, thin, and with a dent.
fn shapes(directions: DirectionSet) -> Vec<Shape> {
    let spec = ShapeSpec { directions, ..ShapeSpec::default() };
    let dented = ProceduralShape::default_of("l-shape").unwrap();
    let build = |form: ProceduralShape| Shape::build(&form.build().unwrap(), &spec).unwrap();
    FORMS.into_iter().chain([dented]).map(build).collect()
}

/// A cube of side 2 about its origin.
fn cube() -> Shape {
    let [x, y, z] = [2.0; 3];
    let mesh = ProceduralShape::Box { x, y, z }.build().unwrap();
    Shape::build(&mesh, &ShapeSpec::default()).unwrap()
}

/// The mesh of a shape as the reference has it.
fn reference(shape: &Shape) -> sdop_reference::Shape {
    mesh(shape.vertices.clone(), shape.triangles.clone())
}

fn mesh(vertices: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> sdop_reference::Shape {
    sdop_reference::Shape::of_mesh(vertices, triangles).unwrap()
}

/// The index on each tier.
fn tiers(index: &QueryIndex) -> Vec<QueryIndex> {
    let tiers = Tier::available().into_iter();
    tiers.map(|tier| index.clone().on_tier(tier)).collect()
}

fn contains(found: &[BodyId], id: BodyId) -> bool {
    found.binary_search(&id).is_ok()
}
