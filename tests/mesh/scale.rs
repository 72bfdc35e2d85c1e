//! Scaled and mirrored meshes.

use sdop::mesh::{ProceduralShape, TriangleMesh};

use crate::mesh::signed_volume;

fn l_shape() -> TriangleMesh {
    ProceduralShape::from_name("l-shape", &[]).unwrap().build().unwrap()
}

/// Counter-clockwise faces look outward before and after, so the volume has the factors' sizes and
/// no sign.
#[test]
fn scales_keep_faces_outward() {
    let mesh = l_shape();
    let volume = signed_volume(&mesh);
    assert!(volume > 0.0);
    for (scale, factor) in [
        ([2.0, 2.0, 2.0], 8.0),
        ([2.0, 0.5, 4.0], 4.0),
        ([-1.0, 1.0, 1.0], 1.0),
        ([1.0, -2.0, -1.0], 2.0),
        ([-1.0, -1.0, -1.0], 1.0),
    ] {
        let scaled = mesh.scaled(scale).unwrap();
        assert_eq!(signed_volume(&scaled), factor * volume, "{scale:?}");
        assert_eq!(scaled.vertices[1][0], scale[0] as f32 * mesh.vertices[1][0]);
        assert_eq!(scaled.name, mesh.name);
    }
    assert_eq!(mesh.scaled(-1.0).unwrap().scaled(-1.0).unwrap(), mesh);
}

/// A thousandth is no f32: the product is rounded once.
#[test]
fn products_are_rounded_once() {
    let vertices = [[123.0_f32, 456.0, 7.0], [1.0, 0.0, 0.0], [0.0, 3.0, 0.0]];
    let mesh = TriangleMesh::new("a", vertices, vec![[0, 1, 2]]).unwrap();
    let metres = mesh.scaled(0.001).unwrap();
    assert_eq!(metres.vertices[0], [0.123, 0.456, 0.007]);
}

#[test]
fn bad_scales_are_refused() {
    let mesh = l_shape();
    for scale in [[0.0, 1.0, 1.0], [1.0, f64::NAN, 1.0], [1.0, 1.0, f64::INFINITY]] {
        let message = mesh.scaled(scale).unwrap_err().problem();
        assert!(message.contains("zero or not finite"), "{message}");
    }
    assert!(mesh.scaled(1e30).unwrap_err().problem().contains("beyond 2^60"));
}

/// A wall on a map. Factors of 2 round nothing, so its points are exact multiples, and what reading
/// has moved grows with them.
#[test]
fn far_meshes_scale_about_the_origin() {
    let wall = [[6e8, 5e9, 0.1], [6e8 + 4000.1, 5e9, 0.2], [6e8, 5e9 + 3000.3, 0.3]];
    let mesh = TriangleMesh::from_f64(&wall, &[[0, 1, 2]]).unwrap();
    let twice = mesh.scaled([-2.0, 2.0, 2.0]).unwrap();
    assert!(mesh.is_far() && twice.is_far() && mesh.rounding > 0.0);
    let expected: Vec<[f64; 3]> =
        mesh.points().map(|[x, y, z]| [-2.0 * x, 2.0 * y, 2.0 * z]).collect();
    assert_eq!(twice.points().collect::<Vec<_>>(), expected);
    assert!(twice.rounding >= 2.0 * mesh.rounding);
    assert_eq!(twice.triangles, [[0, 2, 1]]);
}
