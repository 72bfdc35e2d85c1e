//! Invalid periods, and bodies that are too large, too far away, invalid or gone.

use sdop::periodic::PeriodicError;
use sdop::{ProceduralShape, Shape, ShapeSpec};

use super::*;

#[test]
fn invalid_periods_are_refused() {
    let subnormal = f64::from_bits(77);
    let invalid = [0.0, -0.0, -3.0, f64::NAN, f64::INFINITY, -f64::INFINITY, subnormal, 1.0e300];
    for period in invalid {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let mut periods = [Some(1.0), None, Some(2.0)];
            periods[axis] = Some(period);
            let error = PeriodicBoxes::new(periods).unwrap_err();
            assert_eq!(error.problem(), format!("the period along {name} is {period}"));
            assert!(error.help().starts_with("give a length from 2^-56 to 2^56"));
            assert!(PeriodicWorld::new(Vec::new(), periods).is_err());
            let mut boxes = PeriodicBoxes::new([Some(5.0); 3]).unwrap();
            assert!(boxes.set_periods(periods).is_err());
            assert_eq!(boxes.periods(), [Some(5.0); 3]);
        }
    }
    for period in [2.0_f64.powi(-56), 2.0_f64.powi(56)] {
        assert!(PeriodicBoxes::new([Some(period); 3]).is_ok());
        let beyond = if period < 1.0 { period.next_down() } else { period.next_up() };
        assert!(PeriodicBoxes::new([Some(beyond); 3]).is_err());
    }
}

/// The error says which body, which axis, what it measures and what is allowed.
#[test]
fn large_bodies_are_refused() {
    let mut boxes = PeriodicBoxes::new([None, Some(6.0), None]).unwrap();
    let along_y = |lo: f64, hi: f64| PeriodicBox::new([-99.0, lo, 0.0], [99.0, hi, 1.0]);
    let first = boxes.insert(along_y(0.0, 2.0)).unwrap();
    let error = boxes.insert(along_y(1.0, 4.0)).unwrap_err();
    let wanted = "body 1 measures 3 along y, but less than 3 is allowed, half of the period";
    assert_eq!(error.problem(), wanted);
    assert!(!error.help().is_empty());
    assert_eq!(boxes.set(first, along_y(0.0, 3.5)).unwrap_err().problem().as_bytes()[5], b'0');
    assert_eq!(boxes.body(first).unwrap(), along_y(0.0, 2.0));
    assert!(boxes.insert(along_y(1.0, 4.0_f64.next_down())).is_ok());

    let cube = ProceduralShape::Box { x: 2.0, y: 2.0, z: 1.0 }.build().unwrap();
    let cube = Shape::build(&cube, &ShapeSpec::default()).unwrap();
    // The diameter of the ball is 3.
    for (period, margin, is_allowed) in
        [(6.0, 0.0, false), (6.0001, 0.0, true), (6.0001, 0.1, false), (6.5, 0.1, true)]
    {
        let mut world = PeriodicWorld::new(vec![cube.clone()], [None, None, Some(period)]).unwrap();
        match world.insert(Body { margin, ..Body::default() }) {
            Ok(_) => assert!(is_allowed, "{period} {margin}"),
            Err(PeriodicError::Size { body, axis, size, period: told }) => {
                assert!(!is_allowed && (body, axis, told) == (0, 'z', period));
                let exact = 3.0 + 2.0 * f64::from(margin);
                assert!((exact..1.000_001 * exact).contains(&size), "{size}");
            }
            Err(error) => panic!("{error}"),
        }
    }
}

#[test]
fn far_and_invalid_bodies_are_refused() {
    let mut boxes = PeriodicBoxes::new([Some(1.0), None, None]).unwrap();
    let at = |x: f64| PeriodicBox::new([x, 0.0, 0.0], [x, 1.0, 1.0]);
    let most = f64::from(1 << 28);
    let id = boxes.insert(at(most)).unwrap();
    boxes.set(id, at(-most)).unwrap();
    boxes.insert(at(most)).unwrap();
    assert_eq!(boxes.cull().unwrap()[0].image, [-(1 << 29), 0, 0]);
    let error = boxes.insert(at(most.next_up())).unwrap_err();
    assert!(error.problem().starts_with("body 2 is at 268435456.0000"), "{error}");
    assert!(error.problem().contains("along x, farther away than 268435456 periods of 1"));
    for x in [f64::NAN, f64::INFINITY, -1.0e300] {
        let error = boxes.set(id, at(x)).unwrap_err();
        assert!(error.problem().starts_with("body 0: box from ["), "{error}");
    }
    let inverted = PeriodicBox::new([1.0, 0.0, 0.0], [1.0_f64.next_down(), 1.0, 1.0]);
    assert!(boxes.insert(inverted).is_err());
    let tall = PeriodicBox::new([0.0; 3], [0.0, 2.0_f64.powi(61), 0.0]);
    assert!(boxes.insert(tall).is_err());

    let cube = ProceduralShape::Box { x: 1.0, y: 1.0, z: 1.0 }.build().unwrap();
    let cube = Shape::build(&cube, &ShapeSpec::default()).unwrap();
    let mut world = PeriodicWorld::new(vec![cube], [Some(8.0), None, None]).unwrap();
    let body = Body::default();
    let invalid = [
        Body { shape: 1, ..body },
        Body { margin: -1.0, ..body },
        Body { margin: f32::NAN, ..body },
        Body { rotation: [0.0; 4], ..body },
        Body { translation: [f64::NAN, 0.0, 0.0], ..body },
        Body { translation: [0.0, 0.0, 1.0e19], ..body },
        Body { translation: [4.0e9, 0.0, 0.0], ..body },
    ];
    let id = world.insert(body).unwrap();
    for invalid in invalid {
        assert!(world.insert(invalid).is_err() && world.set(id, invalid).is_err(), "{invalid:?}");
        assert_eq!(world.body(id).unwrap(), body);
    }
}

/// Removed bodies, and images that are no bodies, are not there.
#[test]
fn only_bodies_can_be_named() {
    let mut boxes = PeriodicBoxes::new([Some(8.0), None, None]).unwrap();
    let at = |x: f64| PeriodicBox::new([x, 0.0, 0.0], [x + 1.0, 1.0, 1.0]);
    let [a, b] = [boxes.insert(at(-4.0)).unwrap(), boxes.insert(at(3.0)).unwrap()];
    assert_eq!(boxes.cull().unwrap().len(), 1);
    assert_eq!(boxes.images().len(), 3);
    let image = boxes.images().ids().find(|id| ![a, b].contains(id)).unwrap();
    let gone = boxes.insert(at(0.0)).unwrap();
    assert_eq!(gone.slot(), 2, "images take no slots of bodies");
    boxes.remove(gone).unwrap();
    for id in [image, gone] {
        assert!(!boxes.contains(id) && boxes.body(id).is_err());
        assert!(boxes.set(id, at(0.0)).is_err() && boxes.remove(id).is_err());
        assert!(boxes.exclude(a, id).is_err() && boxes.include(id, b).is_err());
    }
    assert!(boxes.ids().eq([a, b]));
    boxes.remove(a).unwrap();
    assert_eq!(boxes.pairs().len(), 1, "until the next cull");
    assert_eq!(boxes.cull().unwrap(), []);
    assert_eq!(boxes.images().len(), 1);
}
