//! A world that bodies enter and leave, posed with glam's types: a ball rolls along a row of boxes,
//! which crumble after it has passed.
use glam::{DVec3, Quat};
use sdop::{Body, ProceduralShape, Shape, ShapeSpec, TriangleMesh, VolumeError, World};

/// A mesh's volumes. Poses place the mesh's own origin, wherever the mesh lies about it.
pub fn volumes(mesh: &TriangleMesh) -> Result<Shape, VolumeError> {
    Shape::build(mesh, &ShapeSpec::default())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let [x, y, z] = [1.0; 3];
    let cube = ProceduralShape::Box { x, y, z }.build()?;
    let mut world = World::new(vec![volumes(&cube)?])?;
    let (radius, subdivisions) = (0.5, 2);
    let ball = ProceduralShape::Icosphere { radius, subdivisions };
    let round = world.add_shape(volumes(&ball.build()?)?)?;
    for i in 0..5 {
        let place = DVec3::X * f64::from(2 * i);
        world.insert(Body::at(0, Quat::IDENTITY, place).fixed())?;
    }
    let start = DVec3::new(-2.0, 0.95, 0.0);
    let ball = world.insert(Body::at(round, Quat::IDENTITY, start))?;
    for step in 0..=48_u8 {
        let rolled = 0.25 * f32::from(step);
        let place = start + DVec3::X * f64::from(rolled);
        world.set_pose(ball, Quat::from_rotation_z(-2.0 * rolled), place)?;
        world.cull()?;
        let events = world.events();
        for pair in events.begun() {
            println!("step {step}: {} and {} might touch", pair[0], pair[1]);
        }
        for pair in events.ended() {
            println!("step {step}: {} is left behind", pair[0]);
            world.remove(pair[0])?;
        }
    }
    println!("bodies left: {}", world.len());
    Ok(())
}
