//! Culling boxes that an engine already has: a crate falls past shelves onto a floor in a
//! `BoxWorld`, and a `BoxCuller` culls a frame of a thousand boxes.
use sdop::boxes::BoxBody;
use sdop::{Aabb, BoxCuller, BoxWorld, Motion};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A world: boxes come and go, some are fixed, and events tell what has changed.
    let mut world = BoxWorld::new();
    let fixed = |bounds: Aabb| BoxBody { motion: Motion::Fixed, ..bounds.into() };
    world.insert(fixed(Aabb::new([-9.0, -9.0, -1.0], [9.0, 9.0, 0.0])))?;
    for z in [2.0, 4.0] {
        world.insert(fixed(Aabb::new([0.5, -3.0, z], [4.0, 3.0, z + 0.125])))?;
    }
    let falling = |z: f32| Aabb::new([0.0, 0.0, z], [1.0, 1.0, z + 1.0]);
    let box_id = world.insert(falling(6.0))?;
    for step in 0..=24_u8 {
        world.set_bounds(box_id, falling(6.0 - 0.25 * f32::from(step)))?;
        world.cull()?;
        let events = world.events();
        for [other, this] in events.begun() {
            println!("step {step}: {this} meets {other}");
        }
        for [other, this] in events.ended() {
            println!("step {step}: {this} leaves {other}");
        }
    }

    // Or pass all boxes in each frame, of any aspect ratio.
    let mut culler = BoxCuller::builder().threads(2).build()?;
    let spoke = |i: u16| {
        let (sin, cos) = (f32::from(i) * 0.01).sin_cos();
        let (x, y) = (50.0 * cos, 50.0 * sin);
        Aabb::new([x.min(0.0), y.min(0.0), 0.0], [x.max(0.0), y.max(0.0), 0.1])
    };
    let spokes: Vec<Aabb> = (0..1000).map(spoke).collect();
    println!("pairs of spokes: {}", culler.cull(&spokes)?.len());
    Ok(())
}
