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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

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
