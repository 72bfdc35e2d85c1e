//! Bodies of several shapes: robots of 30 links on a carousel pass each other and a fixed post. The
//! world reports pairs of robots, and a `PartCuller` which links a narrow phase has to test.
use sdop::compound::{Compound, Part, PartCuller};
use sdop::{Body, ProceduralShape, Shape, ShapeSpec, World};

const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// A turn about z by an angle.
fn about_z(angle: f32) -> [f32; 4] {
    let (sin, cos) = (0.5 * angle).sin_cos();
    [0.0, 0.0, sin, cos]
}

/// A trunk of 6 links and 4 arms of 6 links each.
fn links() -> Vec<Part> {
    let trunk = (0..6)
        .map(|link| Part { translation: [0.0, 0.0, 0.25 * f64::from(link)], ..Part::default() });
    let arm = |number: i32| {
        (1..=6).map(move |link| {
            let angle = std::f32::consts::FRAC_PI_2 * number as f32 + 0.1 * link as f32;
            let (sin, cos) = f64::from(angle).sin_cos();
            let out = 0.3 * f64::from(link);
            Part {
                rotation: about_z(angle),
                translation: [out * cos, out * sin, 0.75],
                ..Part::default()
            }
        })
    };
    trunk.chain((0..4).flat_map(arm)).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let link = ProceduralShape::Box { x: 0.3, y: 0.1, z: 0.2 }.build()?;
    let post = ProceduralShape::Box { x: 0.2, y: 0.2, z: 3.0 }.build()?;
    let shapes = [link, post].map(|mesh| Shape::build(&mesh, &ShapeSpec::default()));
    let [link, post] = shapes;
    let robot = Compound::build("robot", &[link?], &links())?;
    println!("{} parts", robot.parts());

    let mut world = World::new(vec![robot.shape().clone(), post?])?;
    let mut parts = PartCuller::new();
    parts.set_parts(0, robot); // shape 0 of the world has these parts
    world.insert(Body::at(1, UNTURNED, [4.0, 0.0, 0.75]).fixed())?;
    let robots = (0..8).map(|_| world.insert(Body::default()));
    let robots = robots.collect::<Result<Vec<_>, _>>()?;

    for step in 0..=6 {
        for (number, &id) in (0_i16..).zip(&robots) {
            let angle = 0.05 * step as f32 + f32::from(number) * std::f32::consts::FRAC_PI_4;
            let (sin, cos) = f64::from(angle).sin_cos();
            world.set_pose(id, about_z(-3.0 * angle), [4.0 * cos, 4.0 * sin, 0.0])?;
        }
        let bodies = world.cull()?.len();
        let pairs = parts.cull(&world)?;
        println!("step {step}: {bodies} pairs of bodies, {} pairs of parts", pairs.len());
        for pair in pairs.iter().filter(|pair| !robots.contains(&pair.bodies[0])) {
            println!("  the post may meet link {} of {}", pair.parts[1], pair.bodies[1]);
        }
    }
    Ok(())
}
