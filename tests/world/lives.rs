//! What a world keeps of its bodies (ids, interest and groups) from insertion to removal, and the
//! input that it rejects.

use sdop::culler::Culler;
use sdop::settings::{CullSettings, Interest};
use sdop::world::{Body, BodyId, Groups, Motion, PairLookup, World};

use super::shapes;

/// What breaks the contract is refused and changes nothing.
#[test]
fn invalid_input_changes_nothing() {
    let mut world =
        World::with(shapes(), &Culler::builder().settings(&CullSettings::all_pairs())).unwrap();
    let id = world.insert(Body::default()).unwrap();
    let wrong = [
        (Body { shape: 3, ..Body::default() }, "shape 3 of 3"),
        (Body { rotation: [0.0; 4], ..Body::default() }, "rotation [0.0, 0.0, 0.0, 0.0]"),
        (
            Body { translation: [0.0, f64::NAN, 0.0], ..Body::default() },
            "translation [0.0, NaN, 0.0]",
        ),
        (Body { translation: [1e19, 0.0, 0.0], ..Body::default() }, "translation [1e19, 0.0, 0.0]"),
        (Body { margin: -0.5, ..Body::default() }, "margin -0.5"),
        (Body { margin: f32::NAN, ..Body::default() }, "margin NaN"),
    ];
    for (body, message) in wrong {
        assert_eq!(world.insert(body).unwrap_err().problem(), format!("body 1: {message}"));
        assert_eq!(world.set(id, body).unwrap_err().problem(), format!("body 0: {message}"));
    }
    let nowhere = world.set_pose(id, [0.0; 4], [0.0; 3]).unwrap_err();
    assert_eq!(nowhere.problem(), "body 0: rotation [0.0, 0.0, 0.0, 0.0]");
    let lost = world.set_pose(id, [1.0; 4], [0.0, f64::INFINITY, 0.0]);
    assert!(lost.unwrap_err().problem().contains("translation"));
    assert_eq!((world.len(), world.body(id).unwrap()), (1, Body::default()));
    let cone =
        CullSettings { interest: Some(Interest::Bodies(vec![0])), ..CullSettings::all_pairs() };
    assert!(World::with(shapes(), &Culler::builder().settings(&cone)).is_err());
}

#[test]
fn ids_are_never_given_again() {
    let mut world =
        World::with(shapes(), &Culler::builder().settings(&CullSettings::all_pairs())).unwrap();
    let [a, b] = [(); 2].map(|()| world.insert(Body::default()).unwrap());
    world.cull().unwrap();
    assert!(world.events().begun().eq([[a, b]]));
    world.remove(b).unwrap();
    let c = world.insert(Body::default()).unwrap();
    assert_eq!(world.pairs().collect::<Vec<_>>(), [[a, b]], "as of the last cull");
    world.cull().unwrap();
    let events = world.events();
    assert!(events.begun().eq([[a, c]]) && events.ended().eq([[a, b]]));
    let d = world.insert(Body::default()).unwrap();
    assert_eq!(d.slot(), b.slot(), "slots are");
    assert!(d != b && world.body(b).is_err() && world.slots() == 3);
}

/// An id consists of a slot and a generation.
#[test]
fn ids_have_slot_and_generation() {
    let mut world =
        World::with(shapes(), &Culler::builder().settings(&CullSettings::all_pairs())).unwrap();
    let ids = [(); 3].map(|()| world.insert(Body::default()).unwrap());
    assert_eq!(ids.map(|id| id.slot()), [0, 1, 2]);
    world.remove(ids[2]).unwrap();
    world.cull().unwrap();
    let again = world.insert(Body::default()).unwrap();
    let told = [ids[1], ids[2], again].map(|id| id.to_string());
    assert_eq!(told, ["1", "2", "4294967298 (slot 2, generation 1)"]);
    assert_eq!(again.to_bits(), 4_294_967_298);
}

/// A body at a pose moves and collides with all.
#[test]
fn default_body_is_dynamic() {
    let (turn, place) = ([0.5, -0.5, 0.5, 0.5], [1.0, -2.0, 3.0]);
    let body = Body {
        shape: 2,
        motion: Motion::Dynamic,
        rotation: turn,
        translation: place,
        rounded: false,
        groups: Groups::ALL,
        margin: 0.0,
    };
    assert_eq!(Body::at(2, turn, place), body);
    assert_ne!(Body::at(2, turn, place).fixed(), body);
}

/// A world counts its bodies and what its culler does.
#[test]
fn world_has_counters() {
    let way = CullSettings::all_pairs();
    let mut world = World::with(shapes(), &Culler::builder().settings(&way)).unwrap();
    assert_eq!((world.is_empty(), world.len()), (true, 0));
    let ids: Vec<_> = (0..5).map(|_| world.insert(Body::default()).unwrap()).collect();
    assert!(!world.is_empty() && world.len() == 5);
    world.cull().unwrap();
    assert_eq!((world.pairs().len(), world.counters().reported), (10, 10));
    let seconds = world.seconds().total;
    assert!(seconds > 0.0);
    for (left, &id) in (0..5).rev().zip(&ids) {
        world.remove(id).unwrap();
        assert_eq!((world.len(), world.is_empty()), (left, left == 0));
        if left % 2 == 0 {
            world.cull().unwrap();
            assert_eq!((world.len(), world.is_empty()), (left, left == 0));
        }
    }
    // Four bodies, two, and none were culled: 6 pairs, 1 and 0 were added where `left` is even.
    assert_eq!(world.counters().reported, 10 + 6 + 1);
    assert!(world.seconds().total > seconds && world.slots() == 5);
}

/// Pairs come, stay and go; the look-up knows them in either order, and no other.
#[test]
fn lookup_has_current_pairs() {
    let culler = Culler::builder().settings(&CullSettings::all_pairs());
    let mut world = World::with(shapes(), &culler).unwrap();
    let at = |x: f64| [x, 0.0, 0.0];
    let ids: Vec<BodyId> = (0..9).map(|_| world.insert(Body::default()).unwrap()).collect();
    let mut before = Vec::new();
    let mut lookup = PairLookup::default();
    // The number of each body's place; places are 20 apart.
    for places in
        [[0, 1, 2, 0, 1, 2, 0, 1, 2], [0, 1, 1, 1, 1, 3, 4, 4, 2], [5, 1, 1, 0, 6, 3, 2, 2, 2]]
    {
        for (&id, place) in ids.iter().zip(places) {
            let turn = Body::default().rotation;
            world.set_pose(id, turn, at(f64::from(place) * 20.0)).unwrap();
        }
        world.cull().unwrap();
        let pairs = (0..9).flat_map(|i| (i + 1..9).map(move |j| [i, j]));
        let (met, apart): (Vec<_>, Vec<_>) = pairs.partition(|&[i, j]| places[i] == places[j]);
        lookup.refill(&world);
        let holds = |i: usize, j: usize| lookup.contains(ids[i], ids[j]);
        assert!(met.iter().all(|&[i, j]| holds(i, j) && holds(j, i)));
        assert!(!apart.iter().any(|&[i, j]| holds(i, j) || holds(j, i)));
        let named = |wanted: &dyn Fn(&[usize; 2]) -> bool, of: &[[usize; 2]]| -> Vec<[BodyId; 2]> {
            of.iter().filter(|pair| wanted(pair)).map(|pair| pair.map(|i| ids[i])).collect()
        };
        let events = world.events();
        let begun: Vec<_> = events.begun().collect();
        let persisting: Vec<_> = events.persisting().collect();
        let ended: Vec<_> = events.ended().collect();
        assert_eq!(begun, named(&|pair| !before.contains(pair), &met));
        assert_eq!(persisting, named(&|pair| before.contains(pair), &met));
        assert_eq!(ended, named(&|pair| !met.contains(pair), &before));
        before = met;
    }
}
