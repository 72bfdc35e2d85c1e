//! Invalid compounds, and worlds that have other shapes.

use sdop::compound::CompoundError;

use super::*;

fn refusal(parts: &[Part]) -> String {
    let error = Compound::build("arm", &shapes(DirectionSet::K18), parts).unwrap_err();
    assert!(!error.help().is_empty());
    error.problem()
}

#[test]
fn invalid_parts_are_named() {
    let part = Part::default();
    assert_eq!(refusal(&[]), "compound `arm` has no parts");
    let shape = Part { shape: 4, ..part };
    assert_eq!(refusal(&[part, shape]), "part 1 of compound `arm`: shape 4 of 4");
    let rotation = [0.0; 4];
    let still = Part { rotation, ..part };
    let said = refusal(&[part, part, still]);
    assert!(said.starts_with("part 2 of compound `arm`: rotation"), "{said}");
    let translation = [0.0, f64::NAN, 0.0];
    let nowhere = Part { translation, ..part };
    let said = refusal(&[nowhere]);
    assert!(said.starts_with("part 0 of compound `arm`: translation"), "{said}");
    let translation = [2.0_f64.powi(60), 0.0, 0.0];
    let far = Part { translation, ..part };
    assert!(refusal(&[part, far]).contains("2⁶⁰"), "{}", refusal(&[part, far]));
}

#[test]
fn other_shapes_are_refused() {
    let shapes = shapes(DirectionSet::K18);
    let along = |x| Part { translation: [x, 0.0, 0.0], ..Part::default() };
    let compound = Compound::build("arm", &shapes, &[along(0.0), along(1.5)]).unwrap();
    assert_eq!(compound.parts(), 2);
    let mut world = World::new(vec![shapes[0].clone(), compound.shape().clone()]).unwrap();
    world.cull().unwrap();
    let mut culler = PartCuller::new();
    for (number, is_right) in [(0, false), (1, true), (2, false)] {
        culler.set_parts(number, compound.clone());
        let outcome = culler.cull(&world);
        match outcome {
            Err(error) => {
                assert!(!is_right && matches!(error, CompoundError::OtherShape { .. }));
                let wanted =
                    format!("shape {number} of the world is not the shape of compound `arm`");
                assert_eq!(error.problem(), wanted);
            }
            Ok(_) => assert!(is_right),
        }
        culler.remove_parts(number);
    }
    culler.set_parts(1, compound);
    world.replace_shape(1, &shapes[0]).unwrap();
    world.cull().unwrap();
    assert!(culler.cull(&world).is_err());
    culler.remove_parts(1);
    world.cull().unwrap();
    assert!(culler.cull(&world).is_ok());
}

/// A compound is recognised by what it is, not by its size; a number beyond all shapes takes no
/// memory.
#[test]
fn compounds_of_equal_size_are_told_apart() {
    let shapes = shapes(DirectionSet::K18);
    let along = |x| Part { translation: [x, 0.0, 0.0], ..Part::default() };
    let of = |middle| Compound::build("arm", &shapes, &[along(-2.0), along(middle), along(2.0)]);
    let [one, other] = [0.0, 0.25].map(|middle| of(middle).unwrap());
    assert_eq!((one.shape().ball, one.shape().reach), (other.shape().ball, other.shape().reach));
    let mut world = World::new(vec![one.shape().clone()]).unwrap();
    let mut culler = PartCuller::new();
    culler.set_parts(0, one.clone());
    world.cull().unwrap();
    culler.cull(&world).unwrap();
    world.replace_shape(0, other.shape()).unwrap();
    world.cull().unwrap();
    let error = culler.cull(&world).unwrap_err();
    assert!(matches!(error, CompoundError::OtherShape { shape: 0, .. }), "{error}");
    culler.set_parts(0, other);
    culler.cull(&world).unwrap();
    culler.set_parts(u32::MAX, one);
    let error = culler.cull(&world).unwrap_err();
    assert!(matches!(error, CompoundError::OtherShape { shape: u32::MAX, .. }), "{error}");
}
