//! After any insertions, moves and removals, a culler of parts reports what a new one would.

use sdop::Motion;

use super::*;
use crate::histories::{HistoryKind, live};

fn random_body(random: &mut Random) -> Body {
    Body {
        shape: random.below(3) as u32,
        motion: [Motion::Dynamic, Motion::Resting, Motion::Fixed][random.below(3)],
        rotation: [(); 4].map(|()| random.within(1.0)),
        translation: [(); 3].map(|()| f64::from(random.within(6.0))),
        margin: [0.0, 0.125][random.below(2)],
        ..Body::default()
    }
}

/// No two parts that meet are missed, whatever has happened to their bodies.
#[test]
fn histories_of_compounds() {
    live(HistoryKind::Compounds, 2..3);
}

/// Parts of a number that change.
#[test]
fn followed_world_gives_fresh_pairs() {
    let mut random = Random::new(5);
    let shapes = shapes(DirectionSet::K18);
    let mut build = |count| Compound::build("t", &shapes, &tree(count, 4, &mut random)).unwrap();
    let mut compounds = vec![(0, build(5)), (1, build(12))];
    let others = [build(9), build(3)];
    let all =
        vec![compounds[0].1.shape().clone(), compounds[1].1.shape().clone(), shapes[2].clone()];
    let mut world = World::new(all).unwrap();
    let mut culler = PartCuller::new();
    for (number, compound) in &compounds {
        culler.set_parts(*number, compound.clone());
    }
    let mut ids: Vec<BodyId> = Vec::new();
    let (mut kept, mut most, mut fewer) = (0, 0, 0);
    for round in 0..160 {
        match round {
            60 => {
                world.replace_shape(0, others[0].shape()).unwrap();
                compounds[0].1 = others[0].clone();
                culler.set_parts(0, others[0].clone());
            }
            90 => {
                world.replace_shape(2, others[1].shape()).unwrap();
                compounds.push((2, others[1].clone()));
                culler.set_parts(2, others[1].clone());
            }
            120 => {
                world.replace_shape(0, &shapes[3]).unwrap();
                compounds.remove(0);
                culler.remove_parts(0);
            }
            130 => world.replace_shape(0, &shapes[1]).unwrap(),
            _ => {}
        }
        for _ in 0..1 + 20 / (round + 1) {
            let id = (!ids.is_empty()).then(|| ids[random.below(ids.len())]);
            match (random.below(6), id) {
                (0, Some(id)) if ids.len() > 30 => {
                    world.remove(id).unwrap();
                    ids.retain(|other| *other != id);
                }
                (1, Some(id)) => {
                    let other = ids[random.below(ids.len())];
                    world.exclude(id, other).unwrap();
                }
                (2, Some(id)) => {
                    let body = world.body(id).unwrap();
                    let rotation = [(); 4].map(|()| random.within(1.0));
                    world.set_pose(id, rotation, body.translation).unwrap();
                }
                (3, Some(id)) => {
                    let margin = random.unit();
                    let body = world.body(id).unwrap();
                    world.set(id, Body { margin, ..body }).unwrap();
                }
                _ => ids.push(world.insert(random_body(&mut random)).unwrap()),
            }
        }
        world.cull().unwrap();
        let former = culler.pairs().to_vec();
        let found = culler.cull(&world).unwrap();
        assert_eq!(found, afresh(&world, &compounds), "round {round}");
        let mut bodies: Vec<[BodyId; 2]> = found.iter().map(|pair| pair.bodies).collect();
        bodies.dedup();
        fewer += usize::from(bodies.len() < world.pairs().len());
        kept += found.iter().filter(|pair| former.contains(pair)).count();
        most = most.max(found.len());
        assert!(culler.body_pairs().eq(bodies), "round {round}");
    }
    assert!(kept > 1000 && most > 100, "{kept} kept, {most} at most");
    assert!(fewer > 20, "{fewer} rounds with pairs of bodies without parts");
}

/// A removed body is in no pair, though the world has not been culled since.
#[test]
fn removed_bodies_have_no_parts() {
    let shapes = shapes(DirectionSet::K18);
    let compound = Compound::build("two", &shapes, &[Part::default(); 2]).unwrap();
    let mut world = World::new(vec![compound.shape().clone()]).unwrap();
    let [a, b, c] = [(); 3].map(|()| world.insert(Body::default()).unwrap());
    world.cull().unwrap();
    let compounds = [(0, compound)];
    assert_eq!(afresh(&world, &compounds).len(), 3 * 4);
    world.remove(a).unwrap();
    world.cull().unwrap();
    let all = [[0, 0], [0, 1], [1, 0], [1, 1]];
    assert_eq!(afresh(&world, &compounds), all.map(|parts| pair(b, c, parts)));
}
