//! Parts that touch in one point, which is exact in f64 though every number on the way is rounded.

use sdop::TriangleMesh;

use super::*;

/// A tetrahedron. Its corners are in steps.
fn tetrahedron(corners: [[f64; 3]; 4], directions: DirectionSet) -> Shape {
    let corners = corners.map(|corner| {
        let own = corner.map(|x| (x * STEP) as f32);
        assert_eq!(own.map(f64::from), corner.map(|x| x * STEP));
        own
    });
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mesh = TriangleMesh::from_f32(&corners, &faces).unwrap();
    let spec = ShapeSpec { directions, ..ShapeSpec::default() };
    Shape::build(&mesh, &spec).unwrap()
}

/// What two parts of a body are like.
#[derive(Clone, Copy, Debug)]
struct Kind {
    /// Segments instead of tetrahedra, whose balls touch where the segments do.
    are_segments: bool,
    /// Parts are 10⁸ times as far from the body's origin as they are large.
    are_far: bool,
}

/// A body of two parts, and the places of all their corners.
struct TurnedParts {
    compound: Compound,
    body: Body,
    corners: Vec<(u32, [f64; 3])>,
    /// From the middle of the first part to its first corner, in steps.
    along: [f64; 3],
}

impl TurnedParts {
    fn new(directions: DirectionSet, at: [f64; 3], kind: Kind, random: &mut Random) -> Self {
        let mut whole = |most: usize| random.below(2 * most + 1) as i64 - most as i64;
        // Corners of a part are multiples of both squares.
        let mut own = [[(); 4]; 2].map(|part| part.map(|()| [(); 3].map(|()| whole(9))));
        if kind.are_segments {
            own = own.map(|[[x, y, z], ..]| {
                let end = [x | 1, y, z];
                [end, end.map(|x| -x), [0; 3], [0; 3]]
            });
        }
        let (most, factor) = if kind.are_far { (1 << 22, 1 << 22) } else { (60, 1) };
        let moved = [(); 2].map(|()| [(); 3].map(|()| factor * whole(most)));
        let at = at.map(|x| x + whole(1 << 16) as f64 * STEP);
        let [inner, other, outer] = [(); 3].map(|()| whole_rotation(random));
        let rotations = [inner, other];
        let real = |v: [i64; 3], by: i64| v.map(|x| (x * by) as f64);
        let shapes =
            own.map(|corners| tetrahedron(corners.map(|c| real(c, SQUARE * SQUARE)), directions));
        let parts = [0, 1].map(|part| Part {
            shape: part as u32,
            rotation: rotations[part].map(|x| x as f32),
            translation: real(moved[part], SQUARE).map(|x| x * STEP),
            ..Part::default()
        });
        let place = |part: usize, corner: [i64; 3]| {
            let turned = apply(turn(rotations[part]), corner);
            let in_body = [0, 1, 2].map(|axis| turned[axis] + moved[part][axis]);
            let turned = apply(turn(outer), in_body);
            [0, 1, 2].map(|axis| at[axis] + turned[axis] as f64 * STEP)
        };
        let [first, ..] = own;
        let along = apply(turn(outer), apply(turn(inner), first[0]));
        let corners = (0..2).flat_map(|part| own[part].map(|c| (part as u32, place(part, c))));
        Self {
            compound: Compound::build("two", &shapes, &parts).unwrap(),
            body: Body::at(0, outer.map(|x| x as f32), at),
            corners: corners.collect(),
            along: along.map(|x| x as f64),
        }
    }

    /// The corner that is farthest in a direction.
    fn extreme(&self, direction: [f64; 3]) -> (u32, [f64; 3]) {
        let along = |(_, c): &(u32, [f64; 3])| (0..3).map(|i| direction[i] * c[i]).sum::<f64>();
        let by_place = |a: &_, b: &_| along(a).total_cmp(&along(b));
        self.corners.iter().copied().max_by(by_place).unwrap()
    }
}

/// A cone about a direction, with its apex at its origin; a segment if it is not wide.
fn cone(direction: [f64; 3], width: f64, directions: DirectionSet) -> Shape {
    let beyond = |axis: usize| {
        let wide = |i: usize| direction[i] + if i == axis { width } else { 0.0 };
        [0, 1, 2].map(wide)
    };
    tetrahedron([[0.0; 3], beyond(0), beyond(1), beyond(2)], directions)
}

/// The pair is reported, and no longer once the cone is moved away a little.
#[test]
fn touching_corners_are_reported() {
    let mut random = Random::new(3);
    for directions in DIRECTIONS {
        for at in [[0.0; 3], [1.0e6, -1.0e9, 0.0]] {
            for kind in [(false, false), (false, true), (true, false), (true, true)] {
                let (are_segments, are_far) = kind;
                let kind = Kind { are_segments, are_far };
                let (count, mut left) = (60, 0);
                for _ in 0..count {
                    left += usize::from(is_left(directions, at, kind, &mut random));
                }
                // A tetrahedron's corner may be far within its slabs.
                assert!(2 * left > count, "{kind:?}: {left} of {count}");
            }
        }
    }
}

/// Checks that two bodies which touch are reported, and returns whether they no longer are once
/// they are apart.
fn is_left(directions: DirectionSet, at: [f64; 3], kind: Kind, random: &mut Random) -> bool {
    let turned = TurnedParts::new(directions, at, kind, random);
    let (direction, width) = if kind.are_segments {
        (turned.along, 0.0)
    } else {
        ([(); 3].map(|()| random.below(4001) as f64 - 2000.0), 64.0)
    };
    let (part, corner) =
        if kind.are_segments { turned.corners[0] } else { turned.extreme(direction) };
    let cone = cone(direction, width, directions);
    let mut world = World::new(vec![turned.compound.shape().clone(), cone]).unwrap();
    let robot = world.insert(turned.body).unwrap();
    let touching = world.insert(Body::at(1, UNTURNED, corner)).unwrap();
    world.cull().unwrap();
    let compounds = [(0, turned.compound)];
    let found = afresh(&world, &compounds);
    assert!(found.contains(&pair(robot, touching, [part, 0])), "{corner:?} {direction:?} {kind:?}");
    let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
    let distance = if kind.are_segments { 0.02 } else { 16.0 };
    let away = [0, 1, 2].map(|axis| corner[axis] + distance * direction[axis] / length);
    world.set_pose(touching, UNTURNED, away).unwrap();
    world.cull().unwrap();
    let found = afresh(&world, &compounds);
    !found.contains(&pair(robot, touching, [part, 0]))
}
