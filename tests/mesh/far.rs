//! Meshes far from their origin: how f64 coordinates are stored, and that a mesh near its origin
//! has the f32 numbers of its file.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sdop::mesh::topology::Topology;
use sdop::mesh::{MeshFormat, ReadOptions, TriangleMesh, read_bytes, write_bytes};
use sdop::volume::{Hull, Shape, ShapeSpec};

use crate::mesh::forms::BOX_FACES;

const FORMATS: [MeshFormat; 5] =
    [MeshFormat::Tri, MeshFormat::Obj, MeshFormat::Stl, MeshFormat::Ply, MeshFormat::Off];

fn read(format: MeshFormat, text: impl AsRef<[u8]>) -> TriangleMesh {
    read_bytes("test", format, text.as_ref(), &ReadOptions::default()).unwrap()
}

/// A box's corners, x the fastest.
fn corners(lo: [f64; 3], size: [f64; 3]) -> Vec<[f64; 3]> {
    let corner = |i: usize| {
        std::array::from_fn(|axis| lo[axis] + if i >> axis & 1 == 1 { size[axis] } else { 0.0 })
    };
    (0..8).map(corner).collect()
}

/// A file of these words as coordinates, whatever the format calls them.
fn file(format: MeshFormat, real: &str, points: &[[String; 3]], triangles: &[[u32; 3]]) -> String {
    let lines = |head: &str| -> String {
        let line = |[x, y, z]: &[String; 3]| format!("{head}{x} {y} {z}\n");
        points.iter().map(line).collect()
    };
    let faces = |head: &str, first: u32| -> String {
        let line = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| i + first);
            format!("{head}{a} {b} {c}\n")
        };
        triangles.iter().map(line).collect()
    };
    let (n, t) = (points.len(), triangles.len());
    match format {
        MeshFormat::Tri => format!("{n} {t}\n{}{}", lines(""), faces("", 0)),
        MeshFormat::Obj => lines("v ") + &faces("f ", 1),
        MeshFormat::Ply => format!(
            "ply\nformat ascii 1.0\nelement vertex {n}\nproperty {real} x\nproperty {real} y\nproperty {real} z\n\
             element face {t}\nproperty list uchar uint vertex_indices\nend_header\n{}{}",
            lines(""),
            faces("3 ", 0)
        ),
        MeshFormat::Off => format!("OFF\n{n} {t} 0\n{}{}", lines(""), faces("3 ", 0)),
        MeshFormat::Stl => {
            let facet = |t: &[u32; 3]| {
                let corners = t.map(|i| points[i as usize].join(" "));
                let [a, b, c] = corners.map(|corner| format!("vertex {corner}\n"));
                format!("facet normal 0 0 1\nouter loop\n{a}{b}{c}endloop\nendfacet\n")
            };
            let facets: String = triangles.iter().map(facet).collect();
            format!("solid wall\n{facets}endsolid wall\n")
        }
    }
}

/// What triangles have for corners, free of the numbers of vertices.
fn soup(mesh: &TriangleMesh) -> Vec<[[f64; 3]; 3]> {
    let points: Vec<[f64; 3]> = mesh.points().collect();
    let corners = |t: &[u32; 3]| t.map(|i| points[i as usize]);
    mesh.triangles.iter().map(corners).collect()
}

/// A wall on a map keeps its form.
#[test]
fn far_wall_keeps_its_form() {
    let size = [5000.0, 200.0, 3000.0];
    let points = corners([500_000_100.0, 4_649_776_200.0, 0.0], size);
    let words: Vec<_> = points.iter().map(|p| p.map(|x| format!("{x}"))).collect();
    for format in FORMATS {
        for real in ["float", "double"] {
            let mesh = read(format, file(format, real, &words, &BOX_FACES));
            let wanted: Vec<_> = BOX_FACES.iter().map(|t| t.map(|i| points[i as usize])).collect();
            assert_eq!(soup(&mesh), wanted, "{format:?}");
            assert_eq!(mesh.rounding, 0.0);
            let topology = Topology::of(&mesh);
            assert_eq!((topology.components.len(), topology.closed_components()), (1, 1));
            let shape = Shape::build(&mesh, &ShapeSpec::default()).unwrap();
            let volume = Hull::of(&shape.vertices).volume(&shape.vertices);
            assert!((volume / 3.0e9 - 1.0).abs() < 1e-9, "{format:?}: {volume:e}");
            assert_eq!(shape.pose_offset, mesh.offset);
        }
    }
}

/// Numbers as exporters write them, some of them next to the middle of two f32, where f64 alone
/// would round to the other one.
#[test]
fn near_coordinates_are_the_nearest_f32() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut word = |i: usize| {
        let x = f64::from(random.next_u32()) / f64::from(1 << 30) - 2.0;
        let f = x as f32;
        let middle = 0.5 * (f64::from(f) + f64::from(f.next_up()));
        match i % 5 {
            0 => format!("{x}"),
            1 => format!("{f}"),
            2 => format!("{middle:.60}"),
            // Beyond the middle by less than f64 sees.
            3 => format!("{middle:.60}1"),
            _ => {
                let short = format!("{middle:.60}");
                let digits = short.trim_end_matches('0');
                let last = digits.len() - 1;
                let below = digits.as_bytes()[last] - 1;
                format!("{}{}{}", &digits[..last], char::from(below), "9".repeat(40))
            }
        }
    };
    let mut differ = 0;
    for _ in 0..200 {
        let words: Vec<[String; 3]> = (0..8).map(|i| [word(i), word(i + 1), word(i + 2)]).collect();
        let nearest = |w: &String| w.parse::<f32>().unwrap();
        let twice = |w: &String| w.parse::<f64>().unwrap() as f32;
        let wanted = words.iter().map(|point| point.each_ref().map(nearest));
        let wanted: Vec<[f32; 3]> = wanted.collect();
        differ += words.as_flattened().iter().filter(|w| nearest(w) != twice(w)).count();
        for format in FORMATS {
            let mesh = read(format, file(format, "float", &words, &BOX_FACES));
            assert_eq!((mesh.offset, mesh.rounding), ([0.0; 3], 0.0));
            let corners = |t: [u32; 3]| t.map(|i| mesh.vertices[i as usize]);
            for (found, wanted_triangle) in mesh.triangles.iter().zip(BOX_FACES) {
                let wanted = wanted_triangle.map(|i| wanted[i as usize]);
                assert_eq!(corners(*found), wanted, "{format:?}");
            }
        }
    }
    assert!(differ > 100, "{differ} words that f64 would have rounded twice");
}

/// A box whose one corner rounds by `moved` times 2⁻²⁰ of its size.
fn moved_by(moved: f64) -> TriangleMesh {
    let mut points = corners([1.0; 3], [1.0; 3]);
    // Near 2¹⁶ an f32 steps by 2⁻⁷; the size is chosen so that the wanted part of a step is 2⁻²⁰ of
    // it.
    let far = f64::from(1 << 16);
    let off = 2f64.powi(-9);
    let size = off * 2f64.powi(20) / moved;
    for point in &mut points {
        point[0] = far + (point[0] - 1.0) * size.round();
    }
    points[0][0] += off;
    TriangleMesh::from_f64(&points, &BOX_FACES).unwrap()
}

/// A mesh is far from two to the minus twenty on.
#[test]
fn far_means_rounding_above_limit() {
    for moved in [1.01, 1.5, 40.0] {
        assert!(moved_by(moved).is_far(), "{moved}");
    }
    for moved in [0.01, 0.5, 0.9] {
        let mesh = moved_by(moved);
        assert_eq!(mesh.offset, [0.0; 3], "{moved}");
        assert!(mesh.rounding >= 2.0f32.powi(-9), "{moved}: of f64");
        assert_eq!(mesh.vertices[0][0], 65536.0);
    }
}

/// Random clouds as far out as 2⁵⁰ times their size and as near as their origin.
fn cloud(random: &mut ChaCha8Rng) -> Vec<[f64; 3]> {
    let mut unit = || random.next_u64() as f64 / 2f64.powi(63) - 1.0;
    let size = 2f64.powf(60.0 * unit() - 10.0);
    let far: [f64; 3] = std::array::from_fn(|_| size * 2f64.powf(25.0 + 30.0 * unit()) * unit());
    let bits = 2f64.powi((26.0 + 26.0 * unit()) as i32);
    let mut point = |_| {
        std::array::from_fn(|i| {
            let x: f64 = unit();
            (far[i] + (x * bits).round() / bits * size).clamp(-1.0e18, 1.0e18)
        })
    };
    (0..9).map(&mut point).collect()
}

const FAN: [[u32; 3]; 3] = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];

/// A written mesh is read as it is.
#[test]
fn written_mesh_reads_back() {
    let mut random = ChaCha8Rng::seed_from_u64(9);
    let (mut far, mut rounded) = (0, 0);
    for _ in 0..4000 {
        let mesh = TriangleMesh::from_f64(&cloud(&mut random), &FAN).unwrap();
        far += usize::from(mesh.is_far());
        rounded += usize::from(mesh.rounding > 0.0);
        for (point, vertex) in mesh.points().zip(&mesh.vertices) {
            for i in 0..3 {
                assert_eq!(point[i] - mesh.offset[i], f64::from(vertex[i]), "exact");
            }
        }
        for format in FORMATS {
            let again = read(format, write_bytes(&mesh, format));
            assert_eq!(soup(&again), soup(&mesh), "{format:?}");
            assert_eq!(again.offset, mesh.offset, "{format:?}");
            assert_eq!(again.rounding, 0.0, "{format:?}");
        }
    }
    assert!(far > 2000 && far < 4000 && rounded > 500, "{far} far, {rounded} rounded");
}

/// The bound holds exactly, in whole numbers, and isn't far above what it bounds.
#[test]
fn the_rounding_is_what_was_moved() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut tight = 0;
    for round in 0..2000 {
        let size = 2f64.powi(round % 8);
        let points: Vec<[f64; 3]> = (0..9)
            .map(|_| {
                // Multiples of 2⁻³², all f64.
                [(); 3].map(|()| {
                    let x = f64::from(random.next_u32()) / 2f64.powi(32) - 0.5;
                    500_000.0 + (x * size * 2f64.powi(32)).round() / 2f64.powi(32)
                })
            })
            .collect();
        let mesh = TriangleMesh::from_f64(&points, &FAN).unwrap();
        assert!(mesh.is_far());
        let whole = |x: f64| (x * 2f64.powi(33)) as i128;
        let moved = points.iter().zip(mesh.points()).map(|(a, b)| {
            let off = [0, 1, 2].map(|i| whole(a[i]) - whole(b[i]));
            off.iter().map(|x| x * x).sum::<i128>()
        });
        let moved = (moved.max().unwrap() as f64).sqrt() / 2f64.powi(33);
        let bound = f64::from(mesh.rounding);
        assert!(moved <= bound && bound <= moved * 1.001 + 1e-30, "{moved:e}, {bound:e}");
        assert!(bound <= size * 2f64.powi(-23));
        tight += usize::from(moved > 0.0);
    }
    assert!(tight > 1500, "{tight}");
}

#[test]
fn tiny_meshes_stay_where_they_are() {
    let points = corners([1.0e-200, 0.0, 0.0], [1.0e-60; 3]);
    let mesh = TriangleMesh::from_f64(&points, &BOX_FACES).unwrap();
    assert_eq!(mesh.offset, [0.0; 3]);
    assert!(f64::from(mesh.rounding) >= 1.7e-60 && mesh.rounding < 1.0e-44);
}
