//! What happens to invalid input of boxes. No entry may panic, hang or silently drop a pair.
//!
//! | misuse | what happens |
//! |---|---|
//! | an end that is infinite or no number, `min` above `max`, in a frame of a `BoxCuller` | `CullError::Contract`, naming box and ends; the next frame is culled as usual |
//! | the same in a `BoxWorld` | `WorldError::Contract` where it is inserted or set; the world stays as it was |
//! | the same in columns of boxes to be moved | the same, naming the box; those before it have moved |
//! | a column of groups of another length than there are boxes | `CullError::Contract` at the cull |
//! | an id of a box that was removed | `WorldError::Gone` |

use sdop::{Aabb, BoxCuller, BoxWorld, CullError, Finder, Groups, WorldError};

use crate::boxes::scenes::{Kind, boxes, expected};
use sdop_judge::draw::random::Random;

/// Invalid boxes.
pub fn wrong() -> Vec<Aabb> {
    let (inf, nan) = (f32::INFINITY, f32::NAN);
    let slabs = [
        [nan, 1.0],
        [0.0, nan],
        [nan, nan],
        [1.0, 0.0],
        [1e-45, 0.0],
        [inf, inf],
        [-inf, inf],
        [-inf, -inf],
        [0.0, inf],
    ];
    let of = |slab: [f32; 2]| {
        (0..3).map(move |axis| {
            let mut aabb = Aabb::new([0.0; 3], [1.0; 3]);
            (aabb.min[axis], aabb.max[axis]) = (slab[0], slab[1]);
            aabb
        })
    };
    slabs.into_iter().flat_map(of).collect()
}

/// An invalid box is named in the error, and the culler still works.
#[test]
fn invalid_box_is_named() {
    for &finder in Finder::ALL {
        for count in [1, 40, 300] {
            let sound = boxes(Kind::Cubes, count, &mut Random::new(count as u64));
            let wanted = expected(&sound, |_| true, |_| Groups::ALL);
            let mut culler = BoxCuller::builder().finder(finder).build().unwrap();
            for (number, bad) in wrong().into_iter().enumerate() {
                let (mut now, at) = (sound.clone(), number * 7 % count);
                now[at] = bad;
                let told = culler.cull(&now).unwrap_err();
                assert!(matches!(told, CullError::Contract(_)));
                let Aabb { min, max } = bad;
                assert_eq!(told.problem(), format!("body {at}: box from {min:?} to {max:?}"));
                assert!(culler.pairs().is_empty());
                assert_eq!(culler.cull(&sound).unwrap().sorted(), wanted, "{finder}, {bad:?}");
            }
        }
    }
}

/// A world rejects invalid boxes and stays unchanged.
#[test]
fn world_rejects_invalid_boxes() {
    let mut world = BoxWorld::new();
    let cube = Aabb::new([0.0; 3], [1.0; 3]);
    let [a, b] = [(); 2].map(|()| world.insert(cube).unwrap());
    for bad in wrong() {
        let told = [world.insert(bad).map(|_| ()), world.set(a, bad), world.set_bounds(a, bad)];
        assert!(told.iter().all(|told| matches!(told, Err(WorldError::Contract(_)))), "{bad:?}");
        world.cull().unwrap();
        assert!(world.len() == 2 && world.pairs().eq([[a, b]]));
    }
    world.remove(b).unwrap();
    let told =
        [world.remove(b), world.set(b, cube), world.set_bounds(b, cube), world.body(b).map(|_| ())];
    assert!(told.iter().all(|told| *told == Err(WorldError::Gone(b))));
}

#[test]
fn groups_of_another_length_are_told() {
    let mut culler = BoxCuller::new();
    let now = boxes(Kind::Crowd, 5, &mut Random::new(1));
    culler.cull(&now).unwrap();
    for length in [0, 4, 6] {
        culler.set_groups(Some(vec![Groups::ALL; length]));
        let told = culler.cull(&now).unwrap_err().problem();
        assert!(told.contains("groups") && culler.pairs().is_empty(), "{told}");
    }
    culler.set_groups(None);
    assert!(!culler.cull(&now).unwrap().is_empty());
}

#[test]
fn damaged_exclusions_are_refused() {
    let mut world = BoxWorld::new();
    let aabb = Aabb::new([0.0; 3], [1.0; 3]);
    let [a, b, gone] = [(); 3].map(|()| world.insert(aabb).unwrap());
    world.exclude(b, a).unwrap();
    world.exclude(gone, a).unwrap();
    world.remove(gone).unwrap();
    let saved = serde_json::to_value(world.snapshot()).unwrap();
    assert_eq!(saved["excluded"], serde_json::json!([[0, 1]]));
    for bad in [vec![[1, 0]], vec![[0, 2]], vec![[0, 1], [0, 1]]] {
        let mut damaged = saved.clone();
        damaged["excluded"] = serde_json::json!(bad);
        let error = world.restore(&serde_json::from_value(damaged).unwrap()).unwrap_err();
        assert!(error.to_string().contains("excluded pairs"), "{error}");
    }
    assert!(world.is_excluded(a, b));
}
