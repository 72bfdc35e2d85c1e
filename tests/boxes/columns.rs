//! Boxes that are moved by columns: as if one by one.

use std::collections::{BTreeMap, BTreeSet};

use sdop::boxes::BoxBody;
use sdop::{Aabb, BodyId, BoxCuller, BoxWorld, Finder, Motion, Tier, WorldError};

use crate::boxes::lives::{drawn, pairs};
use crate::boxes::misuse::wrong;
use crate::boxes::scenes::{Kind, boxes, moved};
use sdop_judge::draw::random::Random;

/// More boxes than are checked at once, so many that columns end within a vector.
const COUNT: usize = 1203;

/// A world with boxes of any motion and groups.
fn world_of(kind: Kind, world: &mut BoxWorld, random: &mut Random) -> BTreeMap<BodyId, BoxBody> {
    let all = boxes(kind, COUNT, random);
    let bodies = all.into_iter().map(|bounds| BoxBody { bounds, ..drawn(random, kind) });
    bodies.map(|body| (world.insert(body).unwrap(), body)).collect()
}

/// Pairs and events are those of the definition, whether pairs are read in a frame or not. Some
/// boxes keep their ends, some come twice.
#[test]
fn columns_move_boxes() {
    for (kind, seed) in [Kind::Cubes, Kind::Lattice, Kind::Needles].into_iter().zip(40..) {
        for tier in Tier::available() {
            let random = &mut Random::new(seed);
            let mut world = BoxWorld::with(&BoxCuller::builder().tier(tier)).unwrap();
            let mut bodies = world_of(kind, &mut world, random);
            world.cull().unwrap();
            world.events();
            let mut before = pairs(&bodies);
            for frame in 0..16 {
                let share = [1, 1, 1, 3, 100][random.below(5)];
                let mut ids: Vec<_> = bodies.keys().copied().collect();
                ids.retain(|_| random.below(share) == 0);
                ids.extend_from_within(..ids.len() / 7);
                let bounds: Vec<Aabb> = (ids.iter())
                    .map(|id| {
                        let body = bodies.get_mut(id).unwrap();
                        if random.below(4) > 0 {
                            moved(std::slice::from_mut(&mut body.bounds), 0.1, random);
                        }
                        body.bounds
                    })
                    .collect();
                world.set_many(&ids, &bounds).unwrap();
                world.cull().unwrap();
                let wanted = pairs(&bodies);
                let are_read = |when| frame % 7 == when;
                let are_wanted = |world: &BoxWorld| world.pairs().eq(wanted.iter().copied());
                assert!(!are_read(5) || are_wanted(&world));
                let events = world.events();
                let what = format!("{kind:?}, {tier}, frame {frame}");
                assert!(events.begun().eq(wanted.difference(&before).copied()), "{what}");
                assert!(events.ended().eq(before.difference(&wanted).copied()), "{what}");
                assert!(!are_read(0) || are_wanted(&world), "{what}");
                before = wanted;
            }
        }
    }
}

/// A fixed box is found where it goes, though it comes late in a column of others, which move so
/// little that a finder may keep what it knows.
#[test]
fn column_moves_a_fixed_box() {
    let at = |x: usize, y: f32| Aabb::new([2.0 * x as f32, y, 0.0], [2.0 * x as f32 + 1.0, y, 1.0]);
    for &finder in Finder::ALL {
        let mut world = BoxWorld::with(&BoxCuller::builder().finder(finder)).unwrap();
        let mut ids: Vec<_> = (0..COUNT).map(|x| world.insert(at(x, 0.0)).unwrap()).collect();
        let motion = Motion::Fixed;
        let fixed = BoxBody { motion, ..at(0, 99.0).into() };
        ids.push(world.insert(fixed).unwrap());
        for frame in 1..8 {
            let y = frame as f32 / 1024.0;
            let mut bounds: Vec<_> = (0..COUNT).map(|x| at(x, y)).collect();
            let goes = frame % 4 == 3;
            bounds.push(if goes { at(7 * frame, y) } else { at(0, 99.0) });
            world.set_many(&ids, &bounds).unwrap();
            world.cull().unwrap();
            let wanted = goes.then_some([ids[7 * frame], ids[COUNT]]);
            assert!(world.pairs().eq(wanted), "{finder}, frame {frame}");
        }
    }
}

/// Boxes before a refused one have moved, no others have, and the error tells which it is.
#[test]
fn refused_boxes_end_a_column() {
    let random = &mut Random::new(3);
    let mut world = BoxWorld::new();
    let ids: Vec<_> = (0..COUNT).map(|_| world.insert(Aabb::default()).unwrap()).collect();
    let gone = world.insert(Aabb::default()).unwrap();
    world.remove(gone).unwrap();
    for (number, bad) in wrong().into_iter().enumerate() {
        let refused = [0, 5, 511, 512, COUNT - 1][number % 5];
        let mut all = boxes(Kind::Cubes, COUNT, random);
        let mut named = ids.clone();
        let is_gone = number % 3 == 0;
        if is_gone {
            named[refused] = gone;
        } else {
            all[refused] = bad;
        }
        let former: Vec<_> = ids.iter().map(|&id| world.body(id).unwrap().bounds).collect();
        match world.set_many(&named, &all).unwrap_err() {
            WorldError::Gone(id) => assert!(is_gone && id == gone),
            WorldError::Contract(error) => assert!(!is_gone && error.body == refused),
            other => panic!("{other}"),
        }
        for (at, &id) in ids.iter().enumerate() {
            let wanted = if at < refused { all[at] } else { former[at] };
            assert_eq!(world.body(id).unwrap().bounds, wanted, "{at} of {refused}");
        }
    }
}

/// Columns of unlike lengths change nothing; a zero is a zero of either sign.
#[test]
fn columns_are_of_one_length() {
    let mut world = BoxWorld::new();
    let ids = [(); 2].map(|()| world.insert(Aabb::default()).unwrap());
    let far = Aabb::new([9.0; 3], [9.0; 3]);
    let told = world.set_many(&ids, &[far; 3]).unwrap_err().problem();
    assert!(told.contains("bounds") && told.contains("3 entries for 2"), "{told}");
    world.cull().unwrap();
    assert_eq!(world.pairs().collect::<BTreeSet<_>>(), [ids].into());
    world.set_many(&ids, &[far, Aabb::new([0.0; 3], [-0.0; 3])]).unwrap();
    world.set_many(&[], &[]).unwrap();
    assert!(world.cull().unwrap().is_empty());
}
