//! `.tri` dialects: each valid file gives the same mesh, however its lines are broken, and a file
//! that is cut off an error. `files.txt` has invalid and ambiguous files.

use glam::Vec3;
use sdop::mesh::{MeshError, MeshFormat, ReadOptions, TriangleMesh, read_bytes};

fn read(text: impl AsRef<[u8]>) -> Result<TriangleMesh, MeshError> {
    read_bytes("data/a.tri", MeshFormat::Tri, text.as_ref(), &ReadOptions::default())
}

fn read_as(name: &str, text: &str) -> Result<TriangleMesh, MeshError> {
    let options = ReadOptions { tri_format: Some(name.parse().unwrap()), ..ReadOptions::default() };
    read_bytes("data/a.tri", MeshFormat::Tri, text.as_bytes(), &options)
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
