//! Ball and slabs contain every vertex in exact arithmetic: all k, axes and origins, all scales, any degeneracy.

use glam::Vec3;
use proptest::prelude::*;
use sdop::{
    mesh::TriangleMesh,
    volume::{Axes, DirectionSet, Origin, Shape, ShapeSpec},
};

use crate::exact::{ball_contains, slabs_contain};

pub fn mesh(vertices: Vec<Vec3>) -> TriangleMesh {
    TriangleMesh {
        name: "test".into(),
        vertices,
        triangles: Vec::new(),
    }
}

/// Coordinates of one magnitude, from subnormal to 2⁵⁹, and a share of equal, small-integer and zero ones.
fn vertices() -> impl Strategy<Value = Vec<Vec3>> {
    let exponent = prop_oneof![Just(0), -149..=58_i32];
    let coordinate = prop_oneof![
        3 => -1.0..=1.0_f32,
        1 => (-2..=2_i8).prop_map(f32::from),
        1 => Just(0.0_f32),
    ];
    let vertex = prop::array::uniform3(coordinate);
    (exponent, prop::collection::vec(vertex, 1..40), 0..4_usize).prop_map(
        |(exponent, mut list, rank)| {
            let scale = 2.0_f64.powi(exponent);
            for vertex in &mut list {
                vertex[rank.min(3)..].fill(0.5); // 0: a point, 1: a segment, 2: coplanar
            }
            let scaled = |x: f32| (f64::from(x) * scale) as f32;
            list.into_iter()
                .map(|v| Vec3::from_array(v.map(scaled)))
                .collect()
        },
    )
}

fn check(vertices: Vec<Vec3>, radius: Option<f32>) -> Result<(), TestCaseError> {
    for origin in [Origin::Ball, Origin::File] {
        for &axes in Axes::ALL {
            let spec = ShapeSpec {
                origin,
                radius: radius.filter(|_| origin == Origin::Ball),
                directions: DirectionSet::K26,
                axes,
            };
            let shape = Shape::build(&mesh(vertices.clone()), &spec).unwrap();
            prop_assert!(ball_contains(&shape.ball, &shape.vertices), "{shape:?}");
            for &directions in DirectionSet::ALL {
                let shape = shape.with_directions(directions);
                prop_assert!(slabs_contain(&shape.ordop, &shape.vertices), "{shape:?}");
            }
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn every_volume_contains_its_vertices_exactly(vertices in vertices()) {
        check(vertices, None)?;
    }
}
