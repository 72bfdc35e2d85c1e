//! Few bodies come and go among many that drift: no pair is lost by what a finder keeps of the
//! others.

use std::collections::BTreeSet;

use sdop::culler::Culler;
use sdop::settings::{CullSettings, Finder, Strategy, Updates};
use sdop::volume::{Shape, ShapeSpec};
use sdop::world::{Body, BodyId, World};

use super::{Random, shapes};

const BODIES: usize = 400;

/// A body of small steps in a box that holds some overlaps a body; one in 40 is a giant, and one in
/// five static.
fn drifting(random: &mut Random, small: u32) -> Body {
    let shape = match random.below(40) {
        0 => small,
        _ => random.below(small),
    };
    Body {
        shape,
        motion: super::motion(random.below(5) > 0),
        rotation: [(); 4].map(|()| random.within(1.0)),
        translation: [(); 3].map(|()| f64::from(random.within(1.0) * 14.0)),
        ..Body::default()
    }
}

/// The small shapes, and one that is eight times as wide.
fn sizes() -> Vec<Shape> {
    let mut shapes = shapes();
    let giant = sdop::mesh::ProceduralShape::Icosphere { radius: 8.0, subdivisions: 1 };
    shapes.push(Shape::build(&giant.build().unwrap(), &ShapeSpec::default()).unwrap());
    shapes
}

/// A world whose few bodies come and go loses no pair.
#[test]
fn few_exchanges_lose_no_pair() {
    let shapes = sizes();
    let small = shapes.len() as u32 - 1;
    for strategy in [Strategy::Sphere, Strategy::SDopSequential, Strategy::KDop] {
        for &updates in Updates::ALL {
            let way =
                |pairs| CullSettings { strategy, updates, pairs, ..CullSettings::all_pairs() };
            let mut worlds: Vec<World> = Finder::ALL
                .iter()
                .map(|&pairs| Culler::builder().settings(&way(pairs)))
                .map(|culler| World::with(shapes.clone(), &culler).unwrap())
                .collect();
            let mut random = Random::new(11);
            let mut ids: Vec<BodyId> = Vec::new();
            let mut seen = 0;
            for frame in 0..40 {
                let comers = match frame {
                    0 => BODIES,
                    _ if frame % 6 < 2 => 3,
                    _ => 0,
                };
                for _ in 0..comers {
                    let body = drifting(&mut random, small);
                    let id = worlds.iter_mut().map(|w| w.insert(body).unwrap()).last();
                    ids.push(id.unwrap());
                }
                for _ in 0..if frame % 6 == 1 { 4 } else { 0 } {
                    let gone = ids.swap_remove(random.below(ids.len() as u32) as usize);
                    worlds.iter_mut().for_each(|w| w.remove(gone).unwrap());
                }
                if frame % 12 == 7 {
                    let id = ids[random.below(ids.len() as u32) as usize];
                    let other = drifting(&mut random, small);
                    worlds.iter_mut().for_each(|w| w.set(id, other).unwrap());
                }
                drift(&mut random, &ids, &mut worlds);
                let reported: Vec<BTreeSet<[BodyId; 2]>> = worlds
                    .iter_mut()
                    .map(|world| {
                        world.cull().unwrap();
                        world.pairs().collect()
                    })
                    .collect();
                for (pairs, finder) in reported.iter().zip(Finder::ALL) {
                    let same = *pairs == reported[0];
                    assert!(same, "{strategy}, {updates}, {finder}, frame {frame}");
                }
                seen += reported[0].len();
            }
            assert!(seen > 40 * BODIES / 4, "{seen}");
        }
    }
}

/// Moves all dynamic bodies a little.
fn drift(random: &mut Random, ids: &[BodyId], worlds: &mut [World]) {
    for &id in ids {
        let mut body = worlds[0].body(id).unwrap();
        if body.motion.is_dynamic() {
            for x in &mut body.translation {
                *x += f64::from(random.within(1.0)) * 0.02;
            }
            for world in worlds.iter_mut() {
                world.set_pose(id, body.rotation, body.translation).unwrap();
            }
        }
    }
}
