//! The hull is exact: a closed surface with every vertex on its inner side, by integer
//! determinants.

use std::collections::HashSet;

use dashu_int::IBig;
use glam::{DQuat, Vec3};
use proptest::prelude::*;
use sdop::volume::Hull;

use crate::volume::{
    exact::{dot, point, sub},
    meshes::{box_corners, box_grid, rotated, rotation, vertices},
};

/// A consistently oriented closed surface, each facet of which has all points on its inner side,
/// bounds their hull.
pub fn assert_hull(points: &[impl Into<[f32; 3]> + Copy + std::fmt::Debug]) -> Hull {
    let hull = Hull::of(points);
    let exact: Vec<[IBig; 3]> = points.iter().map(|&v| point(v)).collect();
    let edges: Vec<(u32, u32)> =
        hull.facets.iter().flat_map(|f| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])]).collect();
    let set: HashSet<(u32, u32)> = edges.iter().copied().collect();
    assert_eq!(set.len(), edges.len(), "a directed edge belongs to one facet");
    assert!(set.iter().all(|&(a, b)| set.contains(&(b, a))), "the surface is closed");
    for facet in &hull.facets {
        let [a, b, c] = facet.map(|i| &exact[i as usize]);
        let (u, v) = (sub(b, a), sub(c, a));
        let normal: [IBig; 3] = std::array::from_fn(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            &u[i] * &v[j] - &u[j] * &v[i]
        });
        assert!(normal.iter().any(|n| *n != IBig::ZERO), "facet {facet:?} has an area");
        let outside = exact.iter().filter(|p| dot(&normal, &sub(p, a)) > IBig::ZERO).count();
        assert_eq!(outside, 0, "facet {facet:?} of {points:?}");
    }
    if hull.facets.is_empty() {
        assert_eq!(hull.vertices.len(), points.len(), "a flat set is kept whole");
    } else {
        assert_eq!(hull.vertices.len() + hull.facets.len(), edges.len() / 2 + 2, "Euler");
        let used: HashSet<u32> = hull.facets.iter().flatten().copied().collect();
        assert_eq!(used, hull.vertices.iter().copied().collect());
        assert!(hull.vertices.is_sorted());
    }
    hull
}

proptest! {
    #[test]
    fn hulls_of_all_scales_are_exact(points in vertices()) {
        assert_hull(&points);
    }

    /// Lattice points: coplanar, collinear and duplicate in every way.
    #[test]
    fn hulls_of_lattice_points_are_exact(
        points in prop::collection::vec(prop::array::uniform3((0..4_i8).prop_map(f32::from)), 4..80),
    ) {
        let points: Vec<Vec3> = points.into_iter().map(Vec3::from_array).collect();
        assert_hull(&points);
    }

    /// Faces that are flat but for f32 rounding, where approximate hulls turn inside out.
    #[test]
    fn hulls_of_rotated_grids_are_exact(rotation in rotation(), n in 1..6_usize) {
        let points = rotated(&box_grid(Vec3::new(1.0, 2.0, 0.5), n), rotation);
        let hull = assert_hull(&points);
        prop_assert!((hull.volume(&points) - 1.0).abs() < 1e-6);
        prop_assert!((hull.area(&points) - 7.0).abs() < 1e-5);
    }

    #[test]
    fn hulls_of_cospherical_points_are_exact(turns in prop::collection::vec(rotation(), 1..150)) {
        let points: Vec<Vec3> = turns.iter().map(|&q| (q * glam::DVec3::X).as_vec3()).collect();
        let hull = assert_hull(&points);
        prop_assert!(hull.volume(&points) < 4.19);
    }
}

#[test]
fn flat_sets_have_no_facets() {
    let plate = box_corners(Vec3::new(1.0, 1.0, 0.0));
    let skew: Vec<Vec3> = plate.iter().map(|v| Vec3::new(v.x, v.y, v.x + v.y)).collect();
    let sets: [&[Vec3]; 6] =
        [&[], &[Vec3::ONE; 3], &[Vec3::X, Vec3::Y], &plate, &skew, &[Vec3::ZERO; 1]];
    for points in sets {
        let hull = assert_hull(points);
        assert_eq!((hull.facets.len(), hull.volume(points), hull.area(points)), (0, 0.0, 0.0));
    }
}

#[test]
fn interior_and_repeated_vertices_are_dropped() {
    let mut points = vec![Vec3::ZERO, Vec3::splat(0.25)];
    points.extend(box_corners(Vec3::ONE));
    points.extend(box_corners(Vec3::splat(0.9)));
    let hull = assert_hull(&points);
    assert_eq!(hull.vertices, (2..10).collect::<Vec<u32>>());
    assert!((hull.volume(&points) - 1.0).abs() < 1e-15);
    assert_eq!(hull.area(&points), 6.0);
    let kept: Vec<[f32; 3]> = points[2..10].iter().map(Vec3::to_array).collect();
    assert_eq!(hull.points(&points), kept);
}

#[test]
fn a_large_set_is_exact() {
    let turn = |i: u32| {
        DQuat::from_rotation_z(f64::from(i) * 2.4) * DQuat::from_rotation_y(f64::from(i) * 0.01)
    };
    let points: Vec<Vec3> = (0..2_000)
        .map(|i| (turn(i) * glam::DVec3::Z * (1.0 - f64::from(i % 7) * 0.05)).as_vec3())
        .collect();
    let hull = assert_hull(&points);
    assert!(hull.vertices.len() < 500 && hull.vertices.len() > 100);
}

/// Steep seen from its first vertex, along any axis, near the origin or beyond it: neither a sum of
/// differences with a sign nor one of sums is a size.
#[test]
fn needles_are_not_flat() {
    let needle = [[0.0, 0.0, 0.0], [0.1, 0.0, 9.0], [0.0, 0.1, 9.05], [-0.1, -0.1, 9.1]];
    for shift in 0..3 {
        for (sign, far) in [(1.0, 0.0), (-1.0, 0.0), (1.0, -20.0)] {
            let needle = needle.map(|[x, y, z]| [x, y, z + far]);
            let turned = needle.map(|v| Vec3::from([0, 1, 2].map(|k| sign * v[(k + shift) % 3])));
            for first in 0..4 {
                let mut points = turned;
                points.swap(0, first);
                assert_eq!(assert_hull(&points).facets.len(), 4, "{points:?}");
            }
        }
    }
}

/// Their volume is a difference of others that are larger by far, unless it is taken near by.
#[test]
fn far_cube_keeps_its_size() {
    for far in [0.0, 1048576.0, -8388608.0] {
        let points: Vec<Vec3> =
            box_corners(Vec3::splat(2.0)).iter().map(|v| v + Vec3::splat(far)).collect();
        let hull = assert_hull(&points);
        let (volume, area) = (hull.volume(&points), hull.area(&points));
        assert!(
            (volume - 8.0).abs() < 1e-12 && (area - 24.0).abs() < 1e-12,
            "{far}: {volume}, {area}"
        );
    }
}

/// Every other vertex differs from the first in one coordinate alone: no product of differences is
/// a size.
#[test]
fn box_corner_is_not_flat() {
    let corner = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    assert_eq!(assert_hull(&corner).facets.len(), 4);
}

/// Of a flat set `vertices` are all, but few span it: the outline's corners, the ends of a line, or
/// a point, each once.
#[test]
fn flat_sets_have_corners() {
    let point = |x: f32, y: f32| Vec3::new(x, y, 2.0 * x + y);
    let grid: Vec<Vec3> = (0..25).map(|i| point((i % 5) as f32, (i / 5) as f32)).collect();
    let corners = |points: &[Vec3]| Hull::of(points).corners(points);
    assert_eq!(Hull::of(&grid).vertices.len(), 25);
    assert_eq!(corners(&grid), [0, 4, 20, 24]);
    let wall: Vec<Vec3> = grid.iter().map(|p| Vec3::new(0.0, p.x, p.y)).collect();
    assert_eq!(corners(&wall), [0, 4, 20, 24]);
    assert_eq!(corners(&[grid[12], grid[0], grid[24], grid[6], grid[24]]), [1, 2]);
    assert_eq!(corners(&[Vec3::ZERO, -Vec3::ZERO]).len(), 1);
    assert_eq!(Hull::of(&grid).volume(&grid).to_bits(), 0);
    let solid = box_corners(Vec3::ONE);
    assert_eq!(corners(&solid), Hull::of(&solid).vertices);
}
