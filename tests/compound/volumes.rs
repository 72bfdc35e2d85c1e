//! The shape of a compound contains all parts in exact arithmetic, and margins grow all parts.

use sdop_reference::containment::{check_ball, check_slabs};
use sdop_reference::{Ball, Pose, Slabs};

use super::*;

/// Ball, slabs and reach of a compound's shape in the reference's terms.
fn volumes(shape: &Shape) -> ([Ball; 2], Slabs) {
    let directions = match shape.ordop.directions {
        DirectionSet::K6 => sdop_reference::DirectionSet::K6,
        DirectionSet::K14 => sdop_reference::DirectionSet::K14,
        DirectionSet::K18 => sdop_reference::DirectionSet::K18,
        DirectionSet::K26 => sdop_reference::DirectionSet::K26,
    };
    let ball = Ball { centre: shape.ball.centre, radius: shape.ball.radius };
    let reach = Ball { centre: [0.0; 3], radius: shape.reach };
    let slabs = Slabs {
        directions,
        basis: shape.ordop.basis.columns,
        lo: shape.ordop.lo.clone(),
        hi: shape.ordop.hi.clone(),
    };
    ([ball, reach], slabs)
}

/// Parts anywhere, so that f32 rounds every vertex of the compound.
#[test]
fn shape_contains_all_parts() {
    let mut random = Random::new(9);
    for directions in DIRECTIONS {
        let shapes = shapes(directions);
        for count in [1, 2, 5, 30] {
            for _ in 0..20 {
                let part = |random: &mut Random| Part {
                    shape: random.below(shapes.len()) as u32,
                    rotation: [(); 4].map(|()| random.within(1.0)),
                    translation: [(); 3].map(|()| 4.0 / (0.7 + f64::from(random.unit())) - 4.0),
                    rounded: false,
                };
                let parts: Vec<Part> = (0..count).map(|_| part(&mut random)).collect();
                let compound = Compound::build("any", &shapes, &parts).unwrap();
                let (balls, slabs) = volumes(compound.shape());
                for part in &parts {
                    let vertices = &shapes[part.shape as usize].vertices;
                    let pose = Pose::from_f64(part.rotation, part.translation).unwrap();
                    for ball in &balls {
                        assert_eq!(check_ball(ball, vertices, &pose), Ok(()), "{part:?}");
                    }
                    assert_eq!(check_slabs(&slabs, vertices, &pose), Ok(()), "{part:?}");
                }
                // Little larger than the parts need.
                assert!(compound.shape().rounding < 1.0e-6);
            }
        }
    }
}

/// Corners of cubes whose balls are apart meet as they are grown by the margins of both bodies.
#[test]
fn margins_grow_all_parts() {
    let [x, y, z] = [1.0; 3];
    let cube = ProceduralShape::Box { x, y, z }.build().unwrap();
    let spec = ShapeSpec {
        axes: sdop::Axes::Model,
        directions: DirectionSet::K26,
        ..ShapeSpec::default()
    };
    let cube = Shape::build(&cube, &spec).unwrap();
    let away = Part { translation: [-8.0; 3], ..Part::default() };
    let parts = [away, Part::default()];
    let compound = Compound::build("two", std::slice::from_ref(&cube), &parts).unwrap();
    for (margins, is_met) in [([0.25, 0.25], true), ([0.5, 0.0], true), ([0.1, 0.1], false)] {
        let mut world = World::new(vec![compound.shape().clone(), cube.clone()]).unwrap();
        let [margin, other_margin] = margins;
        let body = Body { margin, ..Body::default() };
        let two = world.insert(body).unwrap();
        // The corners are 0.25·√3 apart, 0.43.
        let body = Body { margin: other_margin, ..Body::at(1, UNTURNED, [1.25; 3]) };
        let one = world.insert(body).unwrap();
        world.cull().unwrap();
        let found = afresh(&world, &[(0, compound.clone())]);
        let wanted: &[PartPair] = if is_met { &[pair(two, one, [1, 0])] } else { &[] };
        assert_eq!(found, wanted, "{margins:?}");
    }
}
