//! Meshes survive every format to the bit, and no reader panics, hangs or allocates more memory
//! than the file's size justifies.

use glam::Vec3;
use proptest::prelude::*;
use sdop::mesh::{MeshFormat, ReadOptions, TriFormat, TriangleMesh, read_bytes, write_bytes};

const FORMATS: [MeshFormat; 5] =
    [MeshFormat::Tri, MeshFormat::Obj, MeshFormat::Stl, MeshFormat::Ply, MeshFormat::Off];

/// Any finite f32 up to 2⁶⁰: both zeros, subnormals, and every exponent as often as the others.
fn coordinate() -> impl Strategy<Value = f32> {
    let size = 0..=sdop::mesh::MAX_COORDINATE.to_bits();
    let any_size = (size, any::<bool>());
    prop_oneof![
        any_size.prop_map(|(bits, minus)| f32::from_bits(bits | u32::from(minus) << 31)),
        Just(-0.0),
        Just(f32::from_bits(1)),
        Just(sdop::mesh::MAX_COORDINATE),
        (-100_i8..100).prop_map(f32::from),
    ]
}

fn mesh() -> impl Strategy<Value = TriangleMesh> {
    (1_usize..12).prop_flat_map(|count| {
        let index = 0..count as u32;
        let vertices = prop::collection::vec([coordinate(), coordinate(), coordinate()], count);
        let triangles = prop::collection::vec([index.clone(), index.clone(), index], 1..12);
        (vertices, triangles).prop_map(|(vertices, triangles)| {
            let vertices = vertices.into_iter().map(Vec3::from_array).collect::<Vec<_>>();
            TriangleMesh::new("mesh", vertices, triangles).unwrap()
        })
    })
}

fn bits(mesh: &TriangleMesh) -> Vec<[u32; 3]> {
    mesh.vertices.iter().map(|v| v.map(f32::to_bits)).collect()
}

/// The positions of all corners, with one zero: what a format of loose triangles can keep.
fn corners(mesh: &TriangleMesh) -> Vec<[u32; 3]> {
    let corner = |&i: &u32| mesh.vertices[i as usize].map(|x| (x + 0.0).to_bits());
    mesh.triangles.as_flattened().iter().map(corner).collect()
}

fn read_any(format: MeshFormat, bytes: &[u8]) -> Option<TriangleMesh> {
    let options = ReadOptions::default();
    for &tri_format in TriFormat::ALL {
        let options = ReadOptions { tri_format: Some(tri_format), ..ReadOptions::default() };
        if format == MeshFormat::Tri
            && let Ok(mesh) = read_bytes("mesh", format, bytes, &options)
        {
            assert_contract(mesh);
        }
    }
    read_bytes("mesh", format, bytes, &options).ok().inspect(|mesh| assert_contract(mesh.clone()))
}

fn assert_contract(mesh: TriangleMesh) {
    TriangleMesh::new(mesh.name, mesh.vertices, mesh.triangles).unwrap();
}

/// Words that the formats are made of, numbers at the ends of their types, and junk.
fn word() -> impl Strategy<Value = String> {
    let numbers = prop_oneof![
        (0_u32..5).prop_map(|n| n.to_string()),
        any::<i64>().prop_map(|n| n.to_string()),
        any::<f32>().prop_map(|x| format!("{x:e}")),
    ];
    let words = "ply|format ascii 1.0|format binary_little_endian 1.0|format binary_big_endian 1.0|\
                 element vertex|element face|element x|property float x|property double y|property uchar z|\
                 property list uchar int vertex_indices|property list int uint vertex_index|\
                 property list float char q|end_header|comment|v|vn|vt|f|l|o|g|usemtl|mtllib|1//2|-1/-1/-1|\
                 1//6148914691236517206|#|-|0x|solid|endsolid|facet normal 0 0 1|outer loop|vertex|endloop|endfacet|end|OFF|4OFF|element tristrips|nan(ind)|1.#QNAN|1d5|\\|\u{feff}|\u{0}";
    let words: Vec<String> = words.split('|').map(|word| word.trim_start().to_owned()).collect();
    prop_oneof![3 => numbers, 3 => prop::sample::select(words), 1 => "\\PC{0,8}"]
}

fn text() -> impl Strategy<Value = String> {
    let separator = prop::sample::select(vec![" ", " ", "\n", "\n", "\r\n", "\t"]);
    prop::collection::vec((word(), separator), 0..60)
        .prop_map(|words| words.into_iter().map(|(word, separator)| word + separator).collect())
}

/// A good file of some format with a few bytes changed and perhaps its end cut off.
fn damaged_file() -> impl Strategy<Value = Vec<u8>> {
    let change = (any::<prop::sample::Index>(), any::<u8>());
    let changes = prop::collection::vec(change, 0..4);
    (mesh(), 0..=FORMATS.len(), changes, any::<Option<prop::sample::Index>>()).prop_map(
        |(mesh, format, changes, cut)| {
            let binary = || binary_ply(&mesh);
            let mut bytes = FORMATS.get(format).map_or_else(binary, |f| write_bytes(&mesh, *f));
            for (at, byte) in changes {
                let at = at.index(bytes.len());
                bytes[at] = byte;
            }
            if let Some(cut) = cut {
                bytes.truncate(cut.index(bytes.len()));
            }
            bytes
        },
    )
}

fn binary_ply(mesh: &TriangleMesh) -> Vec<u8> {
    let text = String::from_utf8(write_bytes(mesh, MeshFormat::Ply)).unwrap();
    let text = text.replace("ascii", "binary_little_endian");
    let end = text.find("end_header\n").unwrap() + "end_header\n".len();
    let mut bytes = text.as_bytes()[..end].to_vec();
    for vertex in &mesh.vertices {
        bytes.extend(vertex.iter().flat_map(|x| x.to_le_bytes()));
    }
    for triangle in &mesh.triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|i| i.to_le_bytes()));
    }
    bytes
}

type Point = [i64; 2];

/// Twice the area of a triangle; positive if it is counter-clockwise.
fn area(a: Point, b: Point, c: Point) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn is_on_edge(p: Point, a: Point, b: Point) -> bool {
    let between = |i: usize| p[i] >= a[i].min(b[i]) && p[i] <= a[i].max(b[i]);
    area(a, b, p) == 0 && between(0) && between(1)
}

fn edges(corners: &[Point]) -> impl Iterator<Item = (Point, Point)> {
    corners.iter().copied().zip(corners.iter().copied().cycle().skip(1))
}

/// Whether a point is in a simple polygon or on its boundary.
fn is_in(p: Point, corners: &[Point]) -> bool {
    let passes = |&(a, b): &(Point, Point)| {
        (a[1] > p[1]) != (b[1] > p[1]) && (area(a, b, p) > 0) == (b[1] > a[1])
    };
    edges(corners).any(|(a, b)| is_on_edge(p, a, b))
        || edges(corners).filter(passes).count() % 2 == 1
}

/// A simple polygon: a spiral, or corners in the order of their directions from a point. Some of
/// its edges have a corner in their middle or repeat their first corner.
fn polygon() -> impl Strategy<Value = Vec<Point>> {
    let spiral = [0, 90, 99, 29, 23, 53, 56, 36, 38, 88, 81, 1].map(|n| [n / 10, n % 10]).to_vec();
    let corners = prop::collection::vec([-15..16_i64, -15..16_i64], 6..20);
    let star = corners.prop_filter_map("the point is outside", |mut corners| {
        corners.retain(|&p| p != [0, 0]);
        let is_upper = |p: Point| (p[1], p[0]) > (0, 0);
        corners.sort_by(|&p, &q| is_upper(q).cmp(&is_upper(p)).then(0.cmp(&area([0, 0], p, q))));
        corners.dedup_by(|&mut p, &mut q| is_upper(p) == is_upper(q) && area([0, 0], p, q) == 0);
        let turns_left = |(p, q): (Point, Point)| area([0, 0], p, q) > 0;
        (corners.len() > 3 && edges(&corners).all(turns_left)).then_some(corners)
    });
    let extra = prop::collection::vec(0..6_u8, 20);
    (prop_oneof![9 => star, 1 => Just(spiral)], extra).prop_map(|(corners, extra)| {
        let corner = |((a, b), extra): ((Point, Point), &u8)| match extra {
            0 => vec![[2 * a[0], 2 * a[1]], [a[0] + b[0], a[1] + b[1]]],
            1 => vec![[2 * a[0], 2 * a[1]]; 2],
            _ => vec![[2 * a[0], 2 * a[1]]],
        };
        edges(&corners).zip(&extra).flat_map(corner).collect()
    })
}

/// A file with one face, whose corners are the points in their order from the first-th on.
fn one_face(format: MeshFormat, points: &[[i64; 3]], first: usize) -> String {
    let count = points.len();
    let lines = |before: &str| -> String {
        points.iter().map(|[x, y, z]| format!("{before}{x} {y} {z}\n")).collect()
    };
    let from = |base: usize| -> String {
        (0..count).map(|i| format!(" {}", (first + i) % count + base)).collect()
    };
    match format {
        MeshFormat::Obj => format!("{}f{}\n", lines("v "), from(1)),
        MeshFormat::Off => format!("OFF\n{count} 1 0\n{}{count}{}\n", lines(""), from(0)),
        MeshFormat::Ply => format!(
            "ply\nformat ascii 1.0\nelement vertex {count}\nproperty float x\nproperty float y\n\
             property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n{}{count}{}\n",
            lines(""),
            from(0)
        ),
        _ => {
            let turned = points.iter().cycle().skip(first).take(count);
            let vertex = |[x, y, z]: &[i64; 3]| format!("vertex {x} {y} {z}\n");
            let vertices: String = turned.map(vertex).collect();
            format!("solid\nfacet\nouter loop\n{vertices}endloop\nendfacet\nendsolid\n")
        }
    }
}

/// Faces that have no right triangles keep the fan about their first corner, with one warning for
/// all.
#[test]
fn doubtful_faces_are_warned_of() {
    let pentagram = [[0, 3, 0], [2, -3, 0], [-3, 1, 0], [3, 1, 0], [-2, -3, 0]];
    // Winds around a point twice, and yet consists of triangles that all turn left.
    #[rustfmt::skip]
    let spiral = [[0, 0], [8, 0], [8, 8], [0, 8], [0, 2], [6, 2], [6, 9], [-1, 9], [-1, -1], [9, -1], [9, 1], [0, 1]];
    let spiral = spiral.map(|[x, y]| [x, y, 0]);
    let bent = [[0, 0, 0], [4, 0, 2], [4, 4, 0], [0, 4, 2]];
    let dart = [[0, 0, 0], [4, 0, 3], [1, 1, 0], [0, 4, 3]];
    let bow = [[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0]];
    for points in [&pentagram[..], &spiral, &bent, &dart, &bow] {
        for format in &FORMATS[1..] {
            let file = one_face(*format, points, 0);
            let mesh = read_bytes("a", *format, file.as_bytes(), &ReadOptions::default()).unwrap();
            let fan: Vec<_> = (2..points.len() as u32).map(|i| [0, i - 1, i]).collect();
            assert_eq!(mesh.triangles, fan, "{file}");
            assert_eq!(mesh.warnings.len(), 1, "{file}");
            assert!(mesh.warnings[0].contains(": 1 of 1 faces with more than"), "{file}");
        }
    }
}

/// A face of many corners is cut in little time, or refused.
#[test]
fn large_faces_end() {
    let read = |points: Vec<[i64; 3]>| {
        let file = one_face(MeshFormat::Obj, &points, 0);
        read_bytes("a", MeshFormat::Obj, file.as_bytes(), &ReadOptions::default())
    };
    let (count, teeth) = (100_000, 10_000);
    let gear = |i: i64| {
        let angle = i as f64 / teeth as f64 * std::f64::consts::TAU;
        let radius = if i % 2 == 0 { 8.0e6 } else { 7.9e6 };
        [(radius * angle.cos()) as i64, (radius * angle.sin()) as i64, 0]
    };
    let mesh = read((0..teeth).map(gear).collect()).unwrap();
    assert_eq!(mesh.triangles.len() as i64, teeth - 2);
    assert_eq!(mesh.warnings, [""; 0]);
    let comb = |i: i64| [i, if i % 2 == 0 { 0 } else { 10 * count }, 0];
    let comb = (0..count).map(comb).chain([[count, -9, 0], [0, -9, 0]]);
    // Sorted along its long teeth, each of which is next to all others.
    let error = read(comb.collect()).unwrap_err().to_string();
    assert!(error.contains("takes too long"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    /// The triangles of a planar simple face cover it exactly once, whatever its first corner.
    #[test]
    fn faces_are_cut_exactly(
        corners in polygon(),
        plane in prop::sample::select(vec![
            [[1, 0, 0], [0, 1, 0]], [[0, 0, 1], [0, 1, 0]], [[1, 2, -3], [0, 5, 1]], [[7, 1, 1], [2, 2, 1]],
        ]),
        format in prop::sample::select(&FORMATS[1..]),
    ) {
        let [u, v] = plane;
        let place = |[x, y]: Point| [0, 1, 2].map(|i| x * u[i] + y * v[i]);
        let points: Vec<[i64; 3]> = corners.iter().copied().map(place).collect();
        let whole: i64 = edges(&corners).map(|(a, b)| area([0, 0], a, b)).sum();
        for first in 0..corners.len() {
            let file = one_face(format, &points, first);
            let mesh = read_bytes("a", format, file.as_bytes(), &ReadOptions::default()).unwrap();
            let corner = |i: &u32| {
                let vertex = mesh.vertices[*i as usize].map(|x| x as i64);
                corners[points.iter().position(|point| *point == vertex).unwrap()]
            };
            let triangles: Vec<[Point; 3]> =
                mesh.triangles.iter().map(|t| t.each_ref().map(corner)).collect();
            let mut used = mesh.triangles.as_flattened().to_vec();
            used.sort_unstable();
            used.dedup();
            prop_assert_eq!(used.len(), mesh.vertices.len());
            prop_assert_eq!(&mesh.warnings, &[""; 0]);
            let areas = triangles.iter().map(|&[a, b, c]| area(a, b, c) * whole.signum());
            prop_assert!(areas.clone().all(|area| area >= 0), "{}", file);
            prop_assert_eq!(areas.sum::<i64>(), whole.abs());
            for p in (0..400).map(|n| [n % 20 * 3 - 30 + first as i64 % 3, n / 20 * 3 - 29]) {
                let covers = |t: &[Point; 3]| area(t[0], t[1], t[2]) != 0 && is_in(p, t);
                prop_assert_eq!(triangles.iter().any(covers), is_in(p, &corners), "{:?} {}", p, file);
            }
        }
    }

    #[test]
    fn indexed_formats_keep_every_bit(mesh in mesh()) {
        let binary = (MeshFormat::Ply, binary_ply(&mesh));
        let written = [MeshFormat::Tri, MeshFormat::Obj, MeshFormat::Ply, MeshFormat::Off];
        for (format, bytes) in written.map(|f| (f, write_bytes(&mesh, f))).into_iter().chain([binary]) {
            let back = read_bytes("mesh", format, &bytes, &ReadOptions::default()).unwrap();
            prop_assert_eq!(bits(&back), bits(&mesh), "{:?}", format);
            prop_assert_eq!(&back.triangles, &mesh.triangles, "{:?}", format);
        }
    }

    #[test]
    fn stl_keeps_every_corner(mesh in mesh()) {
        let bytes = write_bytes(&mesh, MeshFormat::Stl);
        let back = read_bytes("mesh", MeshFormat::Stl, &bytes, &ReadOptions::default()).unwrap();
        prop_assert_eq!(corners(&back), corners(&mesh));
    }

    #[test]
    fn random_bytes_do_no_harm(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        for format in FORMATS {
            read_any(format, &bytes);
        }
    }

    #[test]
    fn random_words_do_no_harm(text in text()) {
        for format in FORMATS {
            read_any(format, text.as_bytes());
            read_any(format, format!("ply\nformat ascii 1.0\n{text}").as_bytes());
            read_any(format, format!("solid \n{text}").as_bytes());
        }
    }

    #[test]
    fn damaged_files_do_no_harm(bytes in damaged_file()) {
        for format in FORMATS {
            read_any(format, &bytes);
        }
    }
}
