//! `.tri` dialects: each valid file gives the same mesh, each invalid one an error with its line,
//! and an ambiguous one an error with both dialects.

use glam::Vec3;
use sdop::mesh::{MeshError, MeshFormat, ReadOptions, TriangleMesh, read_bytes};

fn read(text: impl AsRef<[u8]>) -> Result<TriangleMesh, MeshError> {
    read_bytes("data/a.tri", MeshFormat::Tri, text.as_ref(), &ReadOptions::default())
}

fn read_as(name: &str, text: &str) -> Result<TriangleMesh, MeshError> {
    let options = ReadOptions { tri_format: Some(name.parse().unwrap()), ..ReadOptions::default() };
    read_bytes("data/a.tri", MeshFormat::Tri, text.as_bytes(), &options)
}

fn message(text: impl AsRef<[u8]>) -> String {
    read(text).unwrap_err().problem()
}

/// A tetrahedron's corner: the mesh that every good file below holds.
fn expected() -> TriangleMesh {
    let vertices = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(0.0, 0.0, 1.5)];
    TriangleMesh::new("a", vertices, vec![[0, 2, 1], [0, 1, 3]]).unwrap()
}

const VERTICES: [&str; 4] = ["0 0 0", "1 0 0", "0 1 0", "0 0 1.5"];

/// A file of one record a line: header, the four vertices with a suffix each, what follows.
fn file(header: &str, suffix: &str, tail: &[&str]) -> String {
    let vertices = VERTICES.map(|vertex| format!("{vertex}{suffix}"));
    let lines: Vec<&str> = [header]
        .into_iter()
        .chain(vertices.iter().map(String::as_str))
        .chain(tail.iter().copied())
        .collect();
    lines.join("\n") + "\n"
}

fn bourke() -> String {
    file("4 2", " 0 0 1 .6 .5 .4", &["0 2 1", "0 1 3"])
}

fn good_files() -> Vec<(&'static str, String)> {
    vec![
        ("bourke", bourke()),
        ("indexed", file("4 2", "", &["0 2 1", "0 1 3"])),
        ("cart3d", file("4 2", "", &["1 3 2", "1 2 4"])),
        ("cart3d", file("4 2", "", &["1 3 2", "1 2 4", "1 1"])),
        ("labelled", file("4 2", "", &["3 0 2 1", "3 0 1 3"])),
        ("labelled", file("4 2", "", &["17 0 2 1", "-1 0 1 3"])),
        ("labelled-1", file("4 2", "", &["1 1 3 2", "2 1 2 4"])),
        ("openmeeg", file("- 4", " 0 0 1", &["- 2 2 2", "0 2 1", "0 1 3"])),
    ]
}

/// Each dialect is detected and read.
#[test]
fn each_dialect_is_detected() {
    for (name, text) in good_files() {
        let windows = format!("\u{feff}{}\r\n\r\n", text.replace('\n', "\r\n"));
        for text in [text, windows] {
            assert_eq!(read(&text).unwrap(), expected(), "{name}");
            assert_eq!(read_as(name, &text).unwrap(), expected(), "{name} by name");
        }
    }
}

/// Vertices of a soup are numbered by first use; 0 and −0 are one position; colours in AC3D's
/// manner are passed over.
#[test]
fn a_soup_is_welded() {
    let mut welded = expected();
    welded.vertices.swap(1, 2);
    welded.triangles = vec![[0, 1, 2], [0, 2, 3]];
    for text in [
        "0 0 0 0 1 0 1 0 0\n0 -0 0 1 0 0 0 0 1.5",
        "0 0 0 0 1 0 1 0 0 0xFF8800\n-0 0 0 1 0 0 0 0 1.5 0x00\n",
        "0 0 0  0 1 0\n1 0 0\n0 0 0  1 0 0  0 0 1.5\n",
    ] {
        assert_eq!(read(text).unwrap(), welded, "{text}");
        assert_eq!(read_as("soup", text).unwrap(), welded, "{text}");
    }
}

/// Fortran wraps its lines where it likes; where no dialect fits by lines, it is enough that
/// sections start lines.
#[test]
fn records_may_run_over_line_ends() {
    for name in ["bourke", "indexed", "cart3d", "openmeeg"] {
        let (_, text) = good_files().into_iter().find(|(found, _)| *found == name).unwrap();
        let one_number_a_line = text.replace(' ', "\n");
        let (header, body) = text.split_once('\n').unwrap();
        let lines: Vec<&str> = body.lines().collect();
        let (vertices, faces) = (lines[..4].join(" "), lines[4..].join("\n"));
        let (start, end) = vertices.split_at(vertices.len() - 3);
        let wrapped = format!("{header}\n{start}\n{end}\n{faces}\n");
        for text in [one_number_a_line, wrapped] {
            assert_eq!(read(&text).unwrap(), expected(), "{text}");
            assert_eq!(read_as(name, &text).unwrap(), expected(), "{text}");
        }
    }
}

/// [text, the message's end, names that settle it with what they make of the first triangle].
#[test]
fn ambiguous_dialect_needs_a_name() {
    let inner_indices = file("4 1", "", &["1 2 3"]);
    let counted = file("4 1", "", &["3 1 2 3"]);
    let numbers_and_components = file("4 2", "", &["1 3 2 2 3 1", "1 1"]);
    let cases = [
        (
            inner_indices,
            "indexed (faces of three indices from 0) or as Cart3D (faces of three indices from 1)",
            vec![("indexed", [1, 2, 3]), ("cart3d", [0, 1, 2])],
        ),
        (
            counted,
            "labelled (faces of a count or label and three indices from 0) \
             or as labelled (faces of a count or label and three indices from 1)",
            vec![("labelled", [1, 2, 3]), ("labelled-1", [0, 1, 2])],
        ),
        (
            numbers_and_components,
            "Cart3D (faces of three indices from 1) \
             or as labelled (faces of a count or label and three indices from 0) \
             or as labelled (faces of a count or label and three indices from 1)",
            vec![("cart3d", [0, 2, 1]), ("labelled", [3, 2, 2]), ("labelled-1", [2, 1, 1])],
        ),
    ];
    for (text, readings, names) in cases {
        let error = read(&text).unwrap_err();
        assert_eq!(error.problem(), format!("data/a.tri: the file can be read as {readings}"));
        let help = error.help();
        for (name, triangle) in names {
            assert!(help.contains(&format!("--tri-format {name}")), "{help}");
            assert_eq!(read_as(name, &text).unwrap().triangles[0], triangle, "{name}");
        }
    }
}

/// With six triangles a vertex, a file in Bourke's format has as many numbers as a labelled one.
/// Lines tell them apart.
#[test]
fn bourke_and_labelled_of_equal_counts() {
    let faces = "0 0 0\n".repeat(6);
    let text = format!("1 6\n0 0 0 0 0 0 0 0 0\n{faces}");
    assert_eq!(read(&text).unwrap().triangles.len(), 6);
    let error = message(text.replace(' ', "\n"));
    assert!(error.starts_with("data/a.tri: the file can be read as Bourke's format"), "{error}");
    assert!(
        error.ends_with("labelled (faces of a count or label and three indices from 0)"),
        "{error}"
    );
}

/// Whole numbers everywhere make it hard: a cut-off file must not pass for one of another dialect.
#[test]
fn truncated_file_is_rejected() {
    let whole = |text: String| text.replace("1.5", "2").replace(".6 .5 .4", "1 1 1");
    let files = good_files().into_iter().filter(|(_, text)| !text.ends_with("1 1\n"));
    for (name, text) in files {
        let text = whole(text);
        assert!(read(text.trim_end()).is_ok(), "{name}");
        for end in 0..text.trim_end().len() {
            let cut = &text[..end];
            assert!(read(cut).is_err(), "{name} cut to {cut:?}");
        }
    }
}

/// Bourke's own example, cut to its first lines, with decimal normals and colours.
#[test]
fn a_point_may_be_a_mesh() {
    let mesh = read("1 1\n0.25 -1e-3 7 0 0 1 1 1 1\n0 0 0\n").unwrap();
    // It has no size next to which rounding could be small, and so it is kept in f64.
    assert_eq!(mesh.points().collect::<Vec<_>>(), [[0.25, -1e-3, 7.0]]);
    assert_eq!(mesh.triangles, [[0, 0, 0]]);
}
