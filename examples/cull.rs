//! Finds which of 4096 tumbling rings might touch, frame after frame: with spheres first, then with
//! or-DOPs.
use sdop::{Bodies, Culler, ProceduralShape, Shape, ShapeSpec, TriangleMesh, VolumeError};

/// A mesh's volumes. Poses place the mesh's own origin, wherever the mesh lies about it.
pub fn volumes(mesh: &TriangleMesh) -> Result<Shape, VolumeError> {
    Shape::build(mesh, &ShapeSpec::default())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ring = ProceduralShape::Torus { radius: 0.8, tube: 0.2, segments: 32, sides: 12 };
    let shapes = [volumes(&ring.build()?)?];
    let mut bodies = Bodies::default();
    for i in 0..4096_u16 {
        let cell = [i % 16, i / 16 % 16, i / 256].map(|n| 1.5 * f32::from(n));
        bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], cell);
    }
    let mut culler = Culler::builder().threads(2).build(&shapes, &bodies)?;
    for frame in 0..=40_u8 {
        for (body, rotation) in bodies.rotation.iter_mut().enumerate() {
            let turned = 0.02 * f32::from(frame) * (1 + body % 7) as f32;
            *rotation = [turned, 0.0, 0.0, 1.0]; // any non-zero norm will do
        }
        let pairs = culler.cull(&bodies)?;
        if frame % 20 == 0 {
            println!("frame {frame}: {} pairs might touch", pairs.len());
        }
    }
    let [first, second] = [culler.counters().sphere, culler.counters().ordop];
    println!("{} of {} pairs of spheres meet", first.hits, first.tests);
    println!("{} of {} pairs of or-DOPs do", second.hits, second.tests);
    Ok(())
}
