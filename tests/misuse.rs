//! What happens when a culler is misused. No entry may panic, hang or silently drop a pair.
//!
//! | misuse | what happens |
//! |---|---|
//! | columns of unequal length; a shape number out of range; a pose that is not finite or beyond 2⁶⁰, at construction | `CullError::Contract`, naming body and quantity |
//! | fewer or more bodies in a frame than at construction | `CullError::Changed` |
//! | a `dynamic` flag toggled between frames | `CullError::Changed`, naming the body |
//! | a translation that is infinite, NaN or beyond 2⁶⁰ in a frame | `CullError::Contract`, naming the body; the next frame is culled as usual |
//! | a rotation that is zero or not finite in a frame | the same; but if balls are tested first and the body's ball is centred at its origin, all pairs whose balls meet are reported |
//! | a shape number changed between frames, out of range or not | `CullError::Changed`, naming the body |
//! | a static body moved between frames | it is found where it is, with every finder |
//! | a method called too early, or after a change | `misuse/calls.rs` has the table |
//! | shapes whose or-DOPs have different directions | `CullError::Shape`, naming the shape |
//! | a column of groups of another length | `CullError::Contract`; the groups stay as they were |
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sdop::{
    Bodies, CullError, Culler, Finder, Groups, Origin, ProceduralShape, Shape, ShapeSpec, Strategy,
    TriangleMesh,
};

#[path = "misuse/calls.rs"]
mod calls;

const UNTURNED: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// A cube about its body's origin, and one next to it, whose ball's centre turns with the body.
fn shapes() -> Vec<Shape> {
    let cube = ProceduralShape::Box { x: 1.0, y: 1.0, z: 1.0 };
    let cube = cube.build().unwrap();
    let beside = cube.vertices.iter().map(|&[x, y, z]| [x + 3.0, y, z]);
    let beside = TriangleMesh::new("beside", beside, cube.triangles.clone()).unwrap();
    let file = ShapeSpec { origin: Origin::File, ..ShapeSpec::default() };
    vec![Shape::build(&cube, &ShapeSpec::default()).unwrap(), Shape::build(&beside, &file).unwrap()]
}

/// Cubes in a row, each touching the next; every tenth is static.
fn row(cubes: usize) -> Bodies {
    let mut bodies = Bodies::default();
    for i in 0..cubes {
        bodies.push(0, i % 10 != 0, UNTURNED, [i as f32, 0.0, 0.0]);
    }
    bodies
}

/// A culler by every strategy that reports anything, by every finder.
fn cullers(bodies: &Bodies) -> Vec<Culler> {
    let shapes = shapes();
    let judged = |strategy: &&Strategy| **strategy != Strategy::None;
    let ways = Strategy::ALL.iter().filter(judged).flat_map(|&strategy| {
        let of = move |&finder: &Finder| {
            Culler::builder()
                .strategy(strategy)
                .finder(finder)
                .interest(sdop::Interest::Bodies(vec![0]))
                .budget(sdop::Budget::Tests(1000))
        };
        Finder::ALL.iter().map(of)
    });
    ways.map(|way| way.build(&shapes, bodies).unwrap()).collect()
}

/// What is wrong with a body, as an error states it.
fn refused(result: Result<&sdop::PairList, CullError>) -> String {
    result.map(sdop::PairList::len).unwrap_err().problem()
}

#[test]
fn construction_names_what_is_wrong() {
    let refusal = |change: fn(&mut Bodies)| {
        let mut bodies = row(200);
        change(&mut bodies);
        Culler::new(&shapes(), &bodies).unwrap_err().problem()
    };
    assert_eq!(refusal(|b| b.shape[7] = 2), "body 7: shape 2 of 2");
    assert_eq!(refusal(|b| b.rotation[7] = [0.0; 4]), "body 7: rotation [0.0, 0.0, 0.0, 0.0]");
    assert_eq!(
        refusal(|b| b.translation[7] = [0.0, f32::INFINITY, 0.0]),
        "body 7: translation [0.0, inf, 0.0]"
    );
    assert_eq!(refusal(|b| b.dynamic.truncate(3)), "body 3: dynamic has 3 entries for 200 bodies");
}

/// A shape of no sound size is refused by name.
#[test]
fn invalid_shape_is_named() {
    let bodies = row(3);
    let outcome = |change: fn(&mut Shape, f32), size: f32| {
        let mut shapes = shapes();
        change(&mut shapes[0], size);
        Culler::new(&shapes, &bodies).map(drop)
    };
    let sizes: [fn(&mut Shape, f32); 3] = [
        |shape, size| shape.reach = size,
        |shape, size| shape.ball.radius = size,
        |shape, size| shape.ball.centre[1] = size,
    ];
    for (number, change) in sizes.into_iter().enumerate() {
        for size in [2f32.powi(60).next_up(), f32::INFINITY, f32::NAN] {
            let told = outcome(change, size).unwrap_err().problem();
            assert!(told.starts_with("body 0: shape box"), "{told}");
        }
        assert!(number == 2 || outcome(change, -1.0).is_err(), "{number}");
        assert_eq!(outcome(change, 2f32.powi(60)), Ok(()), "{number}");
    }
}

/// Every quaternion with a finite norm above zero is a rotation.
#[test]
fn every_nonzero_quaternion_is_valid() {
    let is_taken = |rotation: [f32; 4]| {
        let mut bodies = row(3);
        bodies.rotation[1] = rotation;
        Culler::new(&shapes(), &bodies).is_ok()
    };
    for size in [1.0, f32::MAX, f32::from_bits(1)] {
        for pattern in 1..81 {
            let sign = |place: i32| (pattern / 3i32.pow(place as u32) % 3 - 1) as f32;
            let rotation = [sign(0), sign(1), sign(2), sign(3)].map(|x| x * size);
            assert_eq!(is_taken(rotation), rotation != [0.0; 4], "{rotation:?}");
        }
    }
    for place in 0..4 {
        for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut rotation = UNTURNED;
            rotation[place] = wrong;
            assert!(!is_taken(rotation), "{rotation:?}");
        }
    }
}

/// Another number of bodies is an error until refresh.
#[test]
fn changed_body_count_needs_refresh() {
    let bodies = row(200);
    for mut culler in cullers(&bodies) {
        let wanted = culler.cull(&bodies).unwrap().sorted();
        let fewer = row(150);
        let told = refused(culler.cull(&fewer));
        assert!(told.starts_with("150 bodies in place of 200"), "{told}");
        let mut more = bodies.clone();
        more.push(0, true, UNTURNED, [200.0, 0.0, 0.0]);
        let told = refused(culler.cull(&more));
        assert!(told.starts_with("201 bodies in place of 200"), "{told}");
        assert_eq!(culler.cull(&bodies).unwrap().sorted(), wanted);

        culler.refresh(&more).unwrap();
        let now = culler.cull(&more).unwrap().sorted();
        assert!(now.contains(&[199, 200]), "{:?}", culler.finder());
        culler.refresh(&fewer).unwrap();
        let now = culler.cull(&fewer).unwrap().sorted();
        assert!(now.iter().all(|[_, j]| *j < 150) && now.contains(&[148, 149]));
    }
}

/// A toggled flag is an error until refresh, whichever way it was toggled.
#[test]
fn toggled_flag_needs_refresh() {
    let bodies = row(200);
    for mut culler in cullers(&bodies) {
        let wanted = culler.cull(&bodies).unwrap().sorted();
        let mut toggled = bodies.clone();
        (toggled.dynamic[3], toggled.dynamic[4]) = (false, false);
        let told = refused(culler.cull(&toggled));
        assert!(told.starts_with("body 3 has become static"), "{told}");
        let mut released = bodies.clone();
        released.dynamic[50] = true;
        let told = refused(culler.cull(&released));
        assert!(told.starts_with("body 50 has become dynamic"), "{told}");
        assert_eq!(culler.cull(&bodies).unwrap().sorted(), wanted);

        culler.refresh(&toggled).unwrap();
        let now = culler.cull(&toggled).unwrap().sorted();
        assert!(!now.contains(&[3, 4]) && now.contains(&[2, 3]) && now.contains(&[4, 5]));
        culler.refresh(&released).unwrap();
        released.translation[50][1] = 9.0;
        let now = culler.cull(&released).unwrap().sorted();
        assert!(!now.iter().any(|pair| pair.contains(&50)));
    }
}

/// A translation outside of the contract is an error and no freeze.
#[test]
fn invalid_translation_is_an_error() {
    let bodies = row(200);
    for mut culler in cullers(&bodies) {
        let wanted = culler.cull(&bodies).unwrap().sorted();
        for far in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN, f32::MAX, -1.2e18] {
            let mut lost = bodies.clone();
            lost.translation[44][1] = far;
            let told = refused(culler.cull(&lost));
            assert!(told.starts_with("body 44: translation ["), "{told}");
            assert_eq!(culler.pairs().len(), 0);
            assert_eq!(culler.cull(&bodies).unwrap().sorted(), wanted, "after {far}");
        }
        // All of them, apart by as much as f32 can say.
        let mut apart = bodies.clone();
        for (i, t) in apart.translation.iter_mut().enumerate() {
            *t = [f32::MAX; 3].map(|x| if i % 2 == 0 { x } else { -x });
        }
        refused(culler.cull(&apart));
        assert_eq!(culler.cull(&bodies).unwrap().sorted(), wanted);
    }
}

/// The frames around a refused one report what they would without it, in whichever of a finder's
/// frames it comes: also in the last one before the finder plans anew because bodies have gathered.
#[test]
fn refused_frame_has_no_effect() {
    const FRAMES: usize = 14;
    let apart = row(40);
    let mut together = apart.clone();
    for (i, t) in together.translation.iter_mut().enumerate() {
        *t = [i % 4, i / 4 % 4, i / 16].map(|x| 0.25 * x as f32);
    }
    let set = |frame: usize| if frame < 2 { &apart } else { &together };
    for culler in cullers(&apart) {
        let mut undisturbed = culler.clone();
        let wanted: Vec<_> =
            (0..FRAMES).map(|frame| undisturbed.cull(set(frame)).unwrap().sorted()).collect();
        for at in 0..FRAMES {
            for far in [f32::INFINITY, f32::NAN, f32::MAX, -1.2e18] {
                let mut culler = culler.clone();
                for (frame, wanted) in wanted.iter().enumerate() {
                    if frame == at {
                        let mut lost = set(frame).clone();
                        lost.translation[34] = [far; 3];
                        refused(culler.cull(&lost));
                    }
                    let found = culler.cull(set(frame)).unwrap().sorted();
                    assert_eq!(&found, wanted, "{frame} of {at}, {far}");
                }
            }
        }
    }
}

/// A rotation outside of the contract loses no pair.
#[test]
fn invalid_rotation_loses_no_pair() {
    let bodies = row(200);
    for mut culler in cullers(&bodies) {
        let wanted = culler.cull(&bodies).unwrap().sorted();
        for turn in [[0.0; 4], [f32::NAN; 4], [f32::INFINITY, 0.0, 0.0, 1.0]] {
            let mut turned = bodies.clone();
            turned.rotation[44] = turn;
            match culler.cull(&turned).map(sdop::PairList::sorted) {
                Ok(now) => assert!(wanted.iter().all(|pair| now.contains(pair)), "{turn:?}"),
                Err(error) => assert!(error.problem().starts_with("body 44: rotation")),
            }
            assert_eq!(culler.cull(&bodies).unwrap().sorted(), wanted);
        }
    }
    // A sphere whose centre turns with its body has no place then.
    let mut bodies = row(200);
    bodies.shape[44] = 1;
    let mut culler = Culler::builder().strategy(Strategy::Sphere);
    for &finder in Finder::ALL {
        culler = culler.finder(finder);
        let mut culler = culler.build(&shapes(), &bodies).unwrap();
        let mut turned = bodies.clone();
        turned.rotation[44] = [0.0; 4];
        let told = refused(culler.cull(&turned));
        assert_eq!(told, "body 44: rotation [0.0, 0.0, 0.0, 0.0]");
    }
}

/// Static bodies are found where each frame has them, also if that is nowhere.
#[test]
fn moved_static_bodies_are_followed() {
    let bodies = row(200);
    let mut moved = bodies.clone();
    for (body, place) in [(0, [1000.0; 3]), (50, [44.5, 0.5, 0.0]), (190, [0.25, 0.0, 0.0])] {
        (moved.translation[body], moved.rotation[body]) = (place, [1.0, 0.0, 0.0, 2.0]);
    }
    for (mut culler, mut other) in cullers(&bodies).into_iter().zip(cullers(&moved)) {
        let wanted = [&bodies, &moved].map(|bodies| other_set(&mut other, bodies));
        assert!(wanted[0] != wanted[1] && wanted[1].contains(&[44, 50]));
        // Long enough for the grid to put its bodies into another order.
        for frame in 0..40 {
            let at = usize::from(frame % 7 > 2);
            let found = culler.cull([&bodies, &moved][at]).unwrap().sorted();
            assert_eq!(found, wanted[at], "frame {frame}, {:?}", culler.finder());
        }
        let mut lost = moved.clone();
        lost.translation[50][2] = f32::NAN;
        let told = refused(culler.cull(&lost));
        assert!(told.starts_with("body 50: translation ["), "{told}");
        assert_eq!(culler.cull(&moved).unwrap().sorted(), wanted[1]);
    }
}

/// What a culler finds of bodies that it reads anew.
fn other_set(culler: &mut Culler, bodies: &Bodies) -> Vec<[u32; 2]> {
    culler.refresh(bodies).unwrap();
    culler.cull(bodies).unwrap().sorted()
}

/// A changed shape is an error until refresh.
#[test]
fn changed_shape_needs_refresh() {
    let bodies = row(200);
    for mut culler in cullers(&bodies) {
        let wanted = culler.cull(&bodies).unwrap().sorted();
        let mut changed = bodies.clone();
        (changed.shape[44], changed.shape[45]) = (7, 1);
        let told = refused(culler.cull(&changed));
        assert!(told.starts_with("body 44 has shape 7 in place of 0"), "{told}");
        let told = culler.refresh(&changed).unwrap_err().problem();
        assert_eq!(told, "body 44: shape 7 of 2");
        assert_eq!(culler.cull(&bodies).unwrap().sorted(), wanted);

        changed.shape[44] = 0;
        culler.refresh(&changed).unwrap();
        let now = culler.cull(&changed).unwrap().sorted();
        assert!(now.contains(&[45, 47]) || now.contains(&[45, 48]) || now.contains(&[45, 49]));
    }
}

/// `?`, `unwrap`, and `main` print what is wrong and the rule.
#[test]
fn errors_print_value_and_rule() {
    let mut bodies = row(2);
    bodies.rotation[0] = [0.0; 4];
    let error = Culler::new(&shapes(), &bodies).unwrap_err();
    let rule = "a quaternion (x, y, z, w) has a finite norm above zero";
    assert_eq!(
        (error.problem().as_str(), error.help()),
        ("body 0: rotation [0.0, 0.0, 0.0, 0.0]", rule)
    );
    assert_eq!(error.to_string(), format!("{}; {rule}", error.problem()));
    assert_eq!(format!("{error:?}"), error.to_string());
}

#[test]
fn groups_have_one_entry_a_body() {
    let bodies = row(200);
    for mut culler in cullers(&bodies) {
        let wanted = culler.cull(&bodies).unwrap().sorted();
        for length in [0, 199, 201] {
            let told = culler.set_groups(Some(vec![Groups::ALL; length]));
            let told = told.unwrap_err().problem();
            let expected = format!("groups has {length} entries for 200 bodies");
            assert!(told.ends_with(&expected), "{told}");
        }
        assert_eq!(culler.cull(&bodies).unwrap().sorted(), wanted);
        let nobody = Groups { member: 0, mask: 0 };
        culler.set_groups(Some(vec![nobody; 200])).unwrap();
        assert_eq!(culler.cull(&bodies).unwrap().len(), 0);
        culler.set_groups(None).unwrap();
        assert_eq!(culler.cull(&bodies).unwrap().sorted(), wanted);
    }
}

/// Groups are forgotten with another number of bodies only.
#[test]
fn groups_survive_equal_body_counts() {
    let (some, more) = (row(40), row(41));
    let nobody = Groups { member: 0, mask: 0 };
    for mut culler in cullers(&some) {
        culler.set_groups(Some(vec![nobody; 40])).unwrap();
        culler.refresh(&some).unwrap();
        assert_eq!(culler.cull(&some).unwrap().len(), 0);
        culler.refresh(&more).unwrap();
        assert!(!culler.cull(&more).unwrap().is_empty());
    }
}

/// Shapes of unlike directions are refused where slabs are compared.
#[test]
fn mixed_directions_are_rejected() {
    let mut unlike = shapes();
    unlike[1] = unlike[1].clone().with_directions(sdop::DirectionSet::K26);
    let told = Culler::new(&unlike, &row(3)).unwrap_err().problem();
    assert_eq!(told, "shape `beside` has an or-DOP of k = 26, shapes before it have k = 18");
    let boxes = Culler::builder().strategy(Strategy::Obb);
    boxes.build(&unlike, &row(3)).unwrap();
}
