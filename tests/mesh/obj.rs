//! OBJ files: what is read, and where an invalid file is wrong.

use glam::Vec3;
use sdop::mesh::{
    MeshError, MeshFormat, ProceduralShape, ReadOptions, TriangleMesh, read, read_bytes,
};
use sdop_reference::Pose;
use sdop_reference::exact::meeting::meet;
use sdop_reference::exact::mesh::Mesh;

fn read_text(text: impl AsRef<[u8]>) -> Result<TriangleMesh, MeshError> {
    read_bytes("cube.obj", MeshFormat::Obj, text.as_ref(), &ReadOptions::default())
}

/// Groups, materials and texture seams leave one mesh; colours and weights are not read.
#[test]
fn obj_groups_make_one_mesh() {
    let text = "# a comment\nmtllib none.mtl\no first\nv 0 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nvt 0 0\nvt 1 1\n\
                vn 0 0 1\nusemtl red\nf 1/1/1 2/2/1 3/1/1\ng second\nv 0 0 1 2\nusemtl blue\nf 1/2 3 -1\n";
    let mesh = read_text(text).unwrap();
    assert_eq!(mesh.name, "cube");
    assert_eq!(mesh.vertices, [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|v| v.to_array()));
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
}

/// Polygons become triangles and short faces degenerate ones; a corner may be anywhere on an edge.
#[test]
fn polygons_become_triangles() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\nf 1 2 3 4 5\nf 1 2\nf 5\n";
    let mesh = read_text(text).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 1, 1], [4, 4, 4]]);
}

/// A cube in the notch of an L is apart from it, and one in its arm meets it, whatever the first
/// corner of the L's faces.
#[test]
fn notch_of_a_prism_is_empty() {
    let corners = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]];
    let vertices: String =
        [0, 1].map(|z| corners.map(|[x, y]| format!("v {x} {y} {z}\n")).concat()).concat();
    let sides: String = (0..6)
        .map(|i| format!("f {} {} {} {}\n", i + 1, (i + 1) % 6 + 1, (i + 1) % 6 + 7, i + 7))
        .collect();
    let unturned = |t| Pose::new([0.0, 0.0, 0.0, 1.0], t).unwrap();
    let cube = ProceduralShape::from_name("box", &[]).unwrap().build().unwrap();
    let small: Vec<_> = cube.vertices.iter().map(|v| v.map(|x| 0.25 * x)).collect();
    let small = Mesh::new(&small, &cube.triangles).unwrap();
    for first in 0..6 {
        let turned: Vec<usize> = (0..6).map(|i| (first + i) % 6).collect();
        let top: String = turned.iter().map(|i| format!(" {}", i + 7)).collect();
        let bottom: String = turned.iter().rev().map(|i| format!(" {}", i + 1)).collect();
        let mesh = read_text(format!("{vertices}f{bottom}\nf{top}\n{sides}")).unwrap();
        let prism = Mesh::new(&mesh.vertices, &mesh.triangles).unwrap();
        let meets = |t| meet((&prism, &unturned([0.0; 3])), (&small, &unturned(t))).meets;
        assert!(!meets([1.5, 1.5, 0.5]) && !meets([1.25, 1.25, 1.0]), "{first}");
        assert!(meets([0.5, 1.5, 0.5]) && meets([1.5, 0.5, 0.5]), "{first}");
    }
}

/// Indices of normals are not read.
#[test]
fn indices_of_normals_may_be_anything() {
    let text = "v 0 0 0\nvn 0 0 1\nf 1//6148914691236517206 1 1\n";
    assert_eq!(read_text(text).unwrap().triangles, [[0, 0, 0]]);
}

/// The path names the format and the mesh.
#[test]
fn path_names_format_and_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("Pyramid.OBJ");
    std::fs::write(&path, "v 0 0 0\nf 1 1 1\n").unwrap();
    assert_eq!(read(&path, &ReadOptions::default()).unwrap().name, "Pyramid");
    let message = |file: &str| {
        read(file, &ReadOptions::default()).map(|mesh| mesh.name).unwrap_err().problem()
    };
    assert_eq!(
        message("a.fbx"),
        r#"a.fbx: the extension "fbx" names no mesh format that can be read"#
    );
    assert_eq!(
        message("README"),
        r#"README: the extension "" names no mesh format that can be read"#
    );
    assert!(message("absent.tri").starts_with("absent.tri: cannot read the file: "));
}
