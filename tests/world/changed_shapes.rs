//! Shapes of a world: added late, replaced and removed.

use sdop::culler::Culler;
use sdop::settings::{DirectionSet, Strategy};
use sdop::world::{Body, World, WorldError};

use super::shapes;

/// A shape added late is as good as one from the start.
#[test]
fn late_shape_equals_early() {
    // Some bodies have margins, and so take models of their own before the other shapes come.
    let body = |i: u8, shape: u32| Body {
        margin: 0.25 * f32::from(i % 3),
        ..Body::at(
            shape,
            [0.3 * f32::from(i), 0.2, 0.0, 1.0],
            [1.1 * f64::from(i), 0.4 * f64::from(i % 4), 0.0],
        )
    };
    for way in super::ways() {
        let builder = Culler::builder().settings(&way);
        let mut whole = World::with(shapes(), &builder).unwrap();
        let mut late = World::with(shapes()[..1].to_vec(), &builder).unwrap();
        let mut both = |bodies: Vec<Body>, late: &mut World| {
            for world in [&mut whole, late] {
                for &body in &bodies {
                    world.insert(body).unwrap();
                }
                world.cull().unwrap();
            }
            assert!(whole.pairs().eq(late.pairs()), "{way:?}");
            late.pairs().len()
        };
        let few = both((0..12).map(|i| body(i, 0)).collect(), &mut late);
        for (number, shape) in (1..).zip(&shapes()[1..]) {
            assert_eq!(late.add_shape(shape.clone()), Ok(number));
        }
        let next = both((0..24).map(|i| body(i, 1 + u32::from(i) % 2)).collect(), &mut late);
        assert!(few < next || way.strategy == Strategy::None, "{few} {next}");
        let other = shapes()[0].clone().with_directions(DirectionSet::K26);
        let refused = late.add_shape(other);
        if way.strategy == Strategy::Obb {
            assert_eq!(refused, Ok(3)); // takes boxes, whatever the shapes' or-DOPs
        } else {
            let told = refused.unwrap_err().problem();
            assert!(told.ends_with("of k = 26, shapes before it have k = 18"));
        }
    }
}

/// The first shape of a world sets the directions.
#[test]
fn first_shape_sets_directions() {
    for way in super::ways() {
        let mut world = World::with(Vec::new(), &Culler::builder().settings(&way)).unwrap();
        let shapes = shapes().into_iter().map(|shape| shape.with_directions(DirectionSet::K6));
        for (number, shape) in (0..).zip(shapes) {
            assert_eq!(world.add_shape(shape), Ok(number), "{way:?}");
        }
        for _ in 0..2 {
            world.insert(Body::default()).unwrap();
        }
        world.cull().unwrap();
        let expected = usize::from(way.strategy != Strategy::None);
        assert_eq!(world.pairs().len(), expected, "{way:?}");
    }
}

/// What bodies have can't be removed; what they had is given again, and has its new form at once,
/// for those at rest too.
#[test]
fn unused_shapes_are_removed() {
    for way in super::ways() {
        let mut world = World::with(shapes(), &Culler::builder().settings(&way)).unwrap();
        let [wide, narrow] = [9.0, 0.5].map(|x| {
            let mesh = sdop::mesh::ProceduralShape::Box { x, y: 1.0, z: 1.0 };
            let spec = sdop::volume::ShapeSpec::default();
            sdop::volume::Shape::build(&mesh.build().unwrap(), &spec).unwrap()
        });
        let number = world.add_shape(narrow.clone()).unwrap();
        let at = |x: f64| Body::at(number, [0.0, 0.0, 0.0, 1.0], [x, 0.0, 0.0]);
        let still = world.insert(Body { margin: 0.1, ..at(0.0).fixed() }).unwrap();
        let other = world.insert(at(7.0)).unwrap(); // only two wide ones meet
        let used = world.remove_shape(number).unwrap_err().problem();
        assert!(used.starts_with("shape 3 (") && used.ends_with("of body 0"), "{used}");
        let culled = usize::from(way.strategy != Strategy::None);
        assert_eq!(world.cull().unwrap().len(), 0, "{way:?}");
        for (form, pairs) in [(&wide, culled), (&narrow, 0), (&wide, culled)] {
            world.replace_shape(number, form).unwrap();
            for _ in 0..2 {
                assert_eq!(world.cull().unwrap().len(), pairs, "{way:?}");
            }
        }
        for id in [still, other] {
            world.remove(id).unwrap();
        }
        assert_eq!(world.remove_shape(number), Ok(()));
        assert_eq!(world.remove_shape(number), Err(WorldError::NoShape(3)));
        assert_eq!(world.replace_shape(9, &wide), Err(WorldError::NoShape(9)));
        let gone = world.insert(at(0.0)).unwrap_err().problem();
        assert!(gone.contains("was removed"), "{gone}");
        assert_eq!(world.remove_shape(0), Ok(()));
        assert!(world.shapes().eq([1, 2]));
        let added = [(); 3].map(|()| world.add_shape(narrow.clone()).unwrap());
        assert_eq!(added, [0, 3, 4], "the lowest that is free");
        assert_eq!(world.cull().unwrap().len(), 0);
        (0..5).for_each(|shape| world.remove_shape(shape).unwrap());
        let first = narrow.with_directions(DirectionSet::K6);
        assert_eq!(world.add_shape(first), Ok(0), "the first sets the directions");
        world.insert(Body::default()).unwrap();
        world.insert(Body::default()).unwrap();
        assert_eq!(world.cull().unwrap().len(), culled, "{way:?}");
    }
}
