//! What a world holds of its bodies: ids, interest and groups, from insertion to removal, and what it refuses.

use sdop::settings::{CullSettings, Strategy};
use sdop::simd::Tier;
use sdop::world::{Body, Groups, World, WorldError};

use super::shapes;

#[test]
fn what_breaks_the_contract_is_refused_and_changes_nothing() {
    let mut world = World::new(shapes(), &CullSettings::default(), Tier::detect()).unwrap();
    let id = world.insert(Body::default()).unwrap();
    let wrong = [
        (
            Body {
                shape: 3,
                ..Body::default()
            },
            "shape 3 of 3",
        ),
        (
            Body {
                rotation: [0.0; 4],
                ..Body::default()
            },
            "rotation [0.0, 0.0, 0.0, 0.0]",
        ),
        (
            Body {
                translation: [0.0, f64::NAN, 0.0],
                ..Body::default()
            },
            "translation [0.0, NaN, 0.0]",
        ),
        (
            Body {
                translation: [1e19, 0.0, 0.0],
                ..Body::default()
            },
            "translation [1e19, 0.0, 0.0]",
        ),
        (
            Body {
                margin: -0.5,
                ..Body::default()
            },
            "margin -0.5",
        ),
        (
            Body {
                margin: f32::NAN,
                ..Body::default()
            },
            "margin NaN",
        ),
    ];
    for (body, message) in wrong {
        assert_eq!(
            world.insert(body).unwrap_err().to_string(),
            format!("body 1: {message}")
        );
        assert_eq!(
            world.set(id, body).unwrap_err().to_string(),
            format!("body 0: {message}")
        );
    }
    let nowhere = world.set_pose(id, [0.0; 4], [0.0; 3]).unwrap_err();
    assert_eq!(nowhere.to_string(), "body 0: rotation [0.0, 0.0, 0.0, 0.0]");
    let lost = world.set_pose(id, [1.0; 4], [0.0, f64::INFINITY, 0.0]);
    assert!(lost.unwrap_err().to_string().contains("translation"));
    assert_eq!((world.len(), world.body(id).unwrap()), (1, Body::default()));
    let cone = CullSettings {
        interest: Some("0".parse().unwrap()),
        ..CullSettings::default()
    };
    assert!(World::new(shapes(), &cone, Tier::detect()).is_err());
}

#[test]
fn ids_are_never_given_again() {
    let mut world = World::new(shapes(), &CullSettings::default(), Tier::detect()).unwrap();
    let [a, b] = [(); 2].map(|()| world.insert(Body::default()).unwrap());
    world.cull().unwrap();
    assert_eq!(world.events().begun, [[a, b]]);
    world.remove(b).unwrap();
    let c = world.insert(Body::default()).unwrap();
    assert_eq!(
        world.pairs().collect::<Vec<_>>(),
        [[a, b]],
        "as of the last cull"
    );
    world.cull().unwrap();
    let events = world.events().clone();
    assert_eq!((events.begun, events.ended), (vec![[a, c]], vec![[a, b]]));
    let d = world.insert(Body::default()).unwrap();
    assert_eq!(d.slot(), b.slot(), "slots are");
    assert!(d != b && world.body(b).is_err() && world.slots() == 3);
}

#[test]
fn interest_ends_with_its_body() {
    let way = CullSettings {
        strategy: Strategy::SDopObjectOfInterest,
        ..CullSettings::default()
    };
    let mut world = World::new(shapes(), &way, Tier::detect()).unwrap();
    // Two needles side by side: their spheres meet, their or-DOPs don't.
    let needle = Body {
        shape: 2,
        ..Body::default()
    };
    let id = world.insert(needle).unwrap();
    world
        .insert(Body {
            translation: [0.0, 1.0, 1.0],
            ..needle
        })
        .unwrap();
    world.set_interest(&[id]).unwrap();
    world.cull().unwrap();
    assert_eq!(world.pairs().len(), 0);
    world.remove(id).unwrap();
    world.cull().unwrap();
    let other = world.insert(needle).unwrap();
    assert_eq!(other.slot(), id.slot());
    world.cull().unwrap();
    assert_eq!(world.pairs().len(), 1, "left to the spheres");
    assert_eq!(world.set_interest(&[id]), Err(WorldError::Gone(id)));
}

#[test]
fn a_body_that_collides_with_all_joins_others_that_do_not() {
    let mut world = World::new(shapes(), &CullSettings::default(), Tier::detect()).unwrap();
    let apart = |member| Body {
        groups: Groups {
            member,
            mask: !member,
        },
        ..Body::default()
    };
    let [a, b] = [(); 2].map(|()| world.insert(apart(1)).unwrap());
    world.cull().unwrap();
    assert_eq!(world.pairs().len(), 0);
    let all = world.insert(Body::default()).unwrap();
    world.cull().unwrap();
    assert_eq!(world.events().begun, [[a, all], [b, all]]);
}
