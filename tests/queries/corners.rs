//! Corners of turned bodies, whose places are exact in f64: a query that touches one in that point
//! alone finds the body, though every number on the way is rounded.

use sdop::query::{QueryShape, QueryVolume};
use sdop::volume::{DirectionSet, ShapeSpec};
use sdop::{Body, Line, QueryIndex, Shape, TriangleMesh, World};

use crate::queries::UNTURNED;
use sdop_judge::draw::random::Random;

/// A step of all places.
const STEP: f64 = 1.0 / 1024.0;

/// A tetrahedron, and a pose that takes its corners to places in whole steps.
struct TurnedCorners {
    shape: Shape,
    body: Body,
    corners: [[f64; 3]; 4],
}

impl TurnedCorners {
    /// A quaternion of whole numbers has a rotation matrix of whole numbers over the square of its
    /// norm, and corners are multiples of that square.
    fn new(directions: DirectionSet, random: &mut Random) -> Self {
        let mut whole = |most: usize| random.below(2 * most + 1) as i64 - most as i64;
        let q = [whole(6) * 2 + 1, whole(6), whole(6), whole(6)];
        let corners = [(); 4].map(|()| [(); 3].map(|()| whole(40)));
        let at = [(); 3].map(|()| whole(1 << 20));
        let [x, y, z, w] = q;
        let square = x * x + y * y + z * z + w * w;
        let turn = [
            [square - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), square - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), square - 2 * (x * x + y * y)],
        ];
        let place = |c: [i64; 3]| {
            let along = |axis: usize| (0..3).map(|i| turn[axis][i] * c[i]).sum::<i64>();
            [0, 1, 2].map(|axis| (at[axis] + along(axis)) as f64 * STEP)
        };
        let own = corners.map(|c| c.map(|x| (x * square) as f32 * STEP as f32));
        Self {
            shape: tetrahedron(own, directions),
            body: Body::at(0, q.map(|x| x as f32), at.map(|x| x as f64 * STEP)),
            corners: corners.map(place),
        }
    }

    /// From a corner away from the tetrahedron.
    fn outward(&self, corner: usize) -> [f64; 3] {
        let [a, b, c, d] = self.corners;
        let own = self.corners[corner];
        [0, 1, 2].map(|axis| 4.0 * own[axis] - (a[axis] + b[axis] + c[axis] + d[axis]))
    }
}

fn tetrahedron(corners: [[f32; 3]; 4], directions: DirectionSet) -> Shape {
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mesh = TriangleMesh::from_f32(&corners, &faces).unwrap();
    let spec = ShapeSpec { directions, ..ShapeSpec::default() };
    Shape::build(&mesh, &spec).unwrap()
}

#[test]
fn touched_corners_are_found() {
    let ways = [DirectionSet::K6, DirectionSet::K14, DirectionSet::K18, DirectionSet::K26];
    let mut random = Random::new(7);
    for directions in ways {
        for _ in 0..60 {
            let turned = TurnedCorners::new(directions, &mut random);
            let mut world = World::new(vec![turned.shape.clone()]).unwrap();
            let id = world.insert(turned.body).unwrap();
            let mut index = QueryIndex::new();
            index.update(&world);
            for (number, corner) in turned.corners.into_iter().enumerate() {
                let away = turned.outward(number);
                let ball = QueryVolume::Ball { centre: corner, radius: 0.0 };
                assert_eq!(index.touching(&ball).unwrap(), [id], "{corner:?}");
                let of_box = QueryVolume::Box { min: corner, max: corner };
                assert_eq!(index.touching(&of_box).unwrap(), [id], "{corner:?}");
                let to = [0, 1, 2].map(|axis| corner[axis] + away[axis]);
                let line = Line::Segment { from: to, to: corner };
                let hit = index.first(&line).unwrap().expect("it ends at the corner");
                assert!(hit.at <= 1.0, "{corner:?}");
                // A tetrahedron with its apex there.
                let away = away.map(|x| x as f32);
                let beyond =
                    |axis: usize| [0, 1, 2].map(|i| away[i] + if i == axis { 0.125 } else { 0.0 });
                let apex = [[0.0; 3], beyond(0), beyond(1), beyond(2)];
                let asked = QueryShape::new(&tetrahedron(apex, directions));
                let shape = QueryVolume::Shape {
                    shape: &asked,
                    rotation: UNTURNED,
                    translation: corner,
                    margin: 0.0,
                };
                assert_eq!(index.touching(&shape).unwrap(), [id], "{corner:?}");
            }
        }
    }
}
