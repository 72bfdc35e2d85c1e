//! One set of bodies against another.

use sdop::boxes::BoxBody;
use sdop::periodic::{PeriodicBox, PeriodicBoxes, PeriodicIndex};
use sdop::volume::DirectionSet;
use sdop::{Aabb, Body, BodyId, BoxWorld, Line, Motion, QueryIndex, QueryVolume, World};
use sdop_reference::Pose;
use sdop_reference::exact::meeting::meet;

use crate::queries::scenes::{Kind, boxes};
use crate::queries::{UNTURNED, cube, reference, shapes, tiers};
use sdop_judge::draw::random::Random;

fn box_world(boxes: &[Aabb]) -> BoxWorld {
    let mut world = BoxWorld::new();
    for (n, &aabb) in boxes.iter().enumerate() {
        let motion = if n % 3 == 0 { Motion::Fixed } else { Motion::Dynamic };
        world.insert(BoxBody { motion, ..aabb.into() }).unwrap();
    }
    world
}

#[test]
fn boxes_of_two_sets_meet_exactly() {
    let random = &mut Random::new(1);
    for kind in Kind::ALL {
        let all = boxes(kind, 400, random);
        let (one, other) = all.split_at(150);
        let worlds = [one, other].map(box_world);
        let mut index = QueryIndex::with_threads(3).unwrap();
        let mut with = QueryIndex::new();
        index.update(&worlds[0]);
        with.update(&worlds[1]);
        let mut wanted = Vec::new();
        for (a, first) in worlds[0].bodies() {
            for (b, second) in worlds[1].bodies() {
                if first.bounds.meets(&second.bounds) {
                    wanted.push([a, b]);
                }
            }
        }
        for index in tiers(&index) {
            assert_eq!(index.pairs_with(&with).unwrap(), wanted, "{kind:?}");
        }
        let mut turned: Vec<_> = wanted.iter().map(|&[a, b]| [b, a]).collect();
        turned.sort();
        assert_eq!(with.pairs_with(&index).unwrap(), turned, "{kind:?}");
    }
}

/// Meshes in two worlds, near the origin and far from it, where the boxes of the two are seen from
/// origins of their own.
#[test]
fn sets_find_meeting_meshes() {
    let random = &mut Random::new(2);
    let shapes = shapes(DirectionSet::K18);
    let meshes: Vec<_> = shapes.iter().map(reference).collect();
    for far in [[0.0; 3], [1.0e9 + 0.1, 0.7, -3.0e10]] {
        let mut draw = |shift: f64| {
            let mut world = World::new(shapes.clone()).unwrap();
            for _ in 0..60 {
                let body = Body {
                    shape: random.below(shapes.len()) as u32,
                    rotation: [(); 4].map(|()| random.within(1.0)),
                    translation: far.map(|x| x + shift + f64::from(random.within(4.0))),
                    ..Body::default()
                };
                world.insert(body).unwrap();
            }
            world
        };
        let worlds = [draw(0.0), draw(1.0)];
        let indices = [0, 1].map(|n: usize| {
            let mut index = QueryIndex::new();
            index.update(&worlds[n]);
            index
        });
        let found = indices[0].pairs_with(&indices[1]).unwrap();
        let mut required = 0;
        let posed = |body: &Body| Pose::from_f64(body.rotation, body.translation).unwrap();
        for (a, first) in worlds[0].bodies() {
            for (b, second) in worlds[1].bodies() {
                let of = |body: &Body| meshes[body.shape as usize].mesh();
                if meet((of(&first), &posed(&first)), (of(&second), &posed(&second))).meets {
                    assert!(found.binary_search(&[a, b]).is_ok(), "{first:?} {second:?}");
                    required += 1;
                }
            }
        }
        assert!(required > 50, "{required}");
        assert!(found.len() <= 2 * required, "{required} of {}", found.len());
    }
}

/// One set is far from the world's origin, the other reaches from there to it.
#[test]
fn sets_of_other_origins_meet() {
    let world = |places: &[f64]| {
        let mut world = World::new(vec![cube()]).unwrap();
        for &x in places {
            world.insert(Body::at(0, UNTURNED, [x, 0.5, 0.0])).unwrap();
        }
        let mut index = QueryIndex::new();
        index.update(&world);
        (index, world.ids().collect::<Vec<_>>())
    };
    let far = 1.0e9 + 0.25;
    let (near_each_other, a) = world(&[far, far + 30.0]);
    let (wide, b) = world(&[0.0, far + 1.5]);
    assert_eq!(near_each_other.pairs_with(&wide).unwrap(), [[a[0], b[1]]]);
    assert_eq!(wide.pairs_with(&near_each_other).unwrap(), [[b[1], a[0]]]);
}

/// Boxes against meshes are what each box finds as a query.
#[test]
fn boxes_against_meshes_are_queries() {
    let random = &mut Random::new(3);
    let shapes = shapes(DirectionSet::K18);
    let mut world = World::new(shapes).unwrap();
    for _ in 0..150 {
        let body = Body {
            shape: random.below(4) as u32,
            rotation: [(); 4].map(|()| random.within(1.0)),
            translation: [(); 3].map(|()| f64::from(random.within(6.0))),
            ..Body::default()
        };
        world.insert(body).unwrap();
    }
    let draw = |random: &mut Random| {
        let min = [(); 3].map(|()| random.within(6.0));
        Aabb::new(min, min.map(|x| x + 2.0 * random.unit()))
    };
    let boxes: Vec<Aabb> = (0..150).map(|_| draw(random)).collect();
    let asked = box_world(&boxes);
    let [mut index, mut with] = [QueryIndex::new(), QueryIndex::new()];
    index.update(&asked);
    with.update(&world);
    let mut wanted: Vec<[BodyId; 2]> = Vec::new();
    for (id, body) in asked.bodies() {
        let found = with.touching(&body.bounds.into()).unwrap();
        wanted.extend(found.into_iter().map(|other| [id, other]));
    }
    assert!(wanted.len() > 100, "{}", wanted.len());
    assert_eq!(index.pairs_with(&with).unwrap(), wanted);
}

/// A call gives all answers or an error with their number, on any number of threads.
#[test]
fn answers_have_a_limit() {
    let world = box_world(&[Aabb::new([0.0; 3], [1.0; 3]); 300]);
    let line = Line::Segment { from: [-1.0; 3], to: [2.0; 3] };
    let volume = QueryVolume::Ball { centre: [0.0; 3], radius: 1.0 };
    let mut cell = PeriodicBoxes::new([Some(9.0); 3]).unwrap();
    for _ in 0..300 {
        cell.insert(PeriodicBox::new([0.0; 3], [1.0; 3])).unwrap();
    }
    let told = |limit: usize, threads: usize| {
        let mut index = QueryIndex::with_threads(threads).unwrap().most_answers(limit);
        let mut images = PeriodicIndex::with_threads(threads).unwrap().most_answers(limit);
        index.update(&world);
        images.update(&cell);
        let answers = [
            index.touching_all(&[volume; 300]).map(|all| all.iter().flatten().count()),
            index.along_all(&[line; 300]).map(|all| all.iter().flatten().count()),
            index.pairs_with(&index).map(|pairs| pairs.len()),
            images.touching_all(&[volume; 300]).map(|all| all.iter().flatten().count()),
        ];
        answers.map(|answer| answer.map_err(|error| error.to_string()))
    };
    for threads in [1, 3] {
        assert_eq!(told(90_000, threads), [(); 4].map(|()| Ok(90_000)));
        for error in told(89_999, threads).map(Result::unwrap_err) {
            assert!(error.contains("answers 90000 in all, of at most 89999"), "{error}");
        }
    }
    assert_eq!(cell.cull_up_to(44_850).map(<[_]>::len), Ok(44_850));
    let error = cell.cull_up_to(44_849).unwrap_err().to_string();
    assert!(error.starts_with("the frame has 44850 pairs, but at most 44849"), "{error}");
}
