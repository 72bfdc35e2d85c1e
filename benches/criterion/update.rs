//! Cu: the update stage of every volume. An element is a body.
//!
//! Then the update of meshes off their origin, posed by the mesh's own origin (the default) and by
//! the ball's centre.

mod common;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use sdop::mesh::TriangleMesh;
use sdop::volume::{Origin, Shape, ShapeSpec};
use sdop_bench::scene::Scene;

fn updates(criterion: &mut Criterion) {
    let scene = common::scene("paper-500");
    of_each_volume(criterion, "update", &scene);
    for (name, origin) in
        [("update, mesh origin", Origin::File), ("update, ball origin", Origin::Ball)]
    {
        of_each_volume(criterion, name, &off_centre(&scene, origin));
    }
}

fn of_each_volume(criterion: &mut Criterion, name: &str, scene: &Scene) {
    let mut group = criterion.benchmark_group(name);
    for (strategy, volume) in common::one_volume() {
        let id = BenchmarkId::from_parameter(strategy);
        common::stage(&mut group, id, (scene, strategy), |s| s.update, |c| c.of(volume).updates);
    }
}

/// The scene with each mesh moved by half of its ball's radius, as a file may have it, in a box
/// that holds them wherever their origin is.
fn off_centre(scene: &Scene, origin: Origin) -> Scene {
    let moved = |shape: &Shape| {
        let by = 0.5 * shape.ball.radius;
        let vertices: Vec<_> = shape.vertices.iter().map(|v| v.map(|x| x + by)).collect();
        let mesh = TriangleMesh::from_f32(&vertices, &shape.triangles);
        let spec = ShapeSpec {
            origin,
            directions: scene.cull.k,
            axes: scene.cull.axes,
            ..ShapeSpec::default()
        };
        Shape::build(&mesh.expect("a sound mesh"), &spec).expect("a sound mesh")
    };
    Scene {
        shapes: scene.shapes.iter().map(moved).collect(),
        side: scene.side.map(|side| 2.0 * side),
        ..scene.clone()
    }
}

criterion_group!(benches, updates);
criterion_main!(benches);
