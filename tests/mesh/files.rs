//! The table `files.txt`: what is read from a file, or its error with the line and a remedy.

use std::path::Path;

use sdop::mesh::{MeshFormat, ReadOptions, read_bytes};

use crate::answers;

/// The bytes of a text with escapes.
fn bytes(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut rest = text;
    while let Some((before, escape)) = rest.split_once('\\') {
        bytes.extend(before.bytes());
        let digits = if escape.starts_with('x') { 3 } else { 1 };
        let (code, after) = escape.split_at(digits);
        match code {
            "n" => bytes.push(b'\n'),
            "r" => bytes.push(b'\r'),
            "t" => bytes.push(b'\t'),
            "\\" => bytes.push(b'\\'),
            "c" => return bytes,
            _ => bytes.push(u8::from_str_radix(&code[1..], 16).unwrap()),
        }
        rest = after;
    }
    bytes.extend(rest.bytes());
    bytes
}

/// Each place of `from` in the file gets `to`.
fn replace(file: &[u8], from: &[u8], to: &[u8]) -> Vec<u8> {
    let (mut changed, mut rest) = (Vec::new(), file);
    while let Some(at) = rest.windows(from.len()).position(|piece| piece == from) {
        changed.extend([&rest[..at], to].concat());
        rest = &rest[at + from.len()..];
    }
    assert!(rest.len() < file.len(), "{:?} is not in the file", from.escape_ascii().to_string());
    changed.extend(rest);
    changed
}

fn answer(name: &str, file: &[u8], dialect: Option<&str>) -> String {
    let format = MeshFormat::from_path(Path::new(name)).unwrap();
    let tri_format = dialect.map(|name| name.parse().unwrap());
    let options = ReadOptions { tri_format, ..ReadOptions::default() };
    match read_bytes(name, format, file, &options) {
        Ok(mesh) => {
            let vertices: Vec<_> = mesh.points().collect();
            format!("vertices {vertices:?}\ntriangles {:?}", mesh.triangles)
        }
        Err(error) => format!("{error}\nhelp: {}", error.help()),
    }
}

#[test]
fn files_are_read_or_rejected() {
    let table = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mesh/files.txt"));
    let (mut name, mut file, mut mesh) = (String::new(), Vec::new(), String::new());
    answers::check(table, |input| {
        if let Some((first, lines)) = input.split_once('\n') {
            (name, file) = (first.to_owned(), bytes(&format!("{lines}\n")));
            mesh = answer(&name, &file, None);
            return mesh.clone();
        }
        if let Some(dialect) = input.strip_prefix("as ") {
            return answer(&name, &file, Some(dialect));
        }
        let mut changed = file.clone();
        for change in input.split(" && ") {
            let (from, to) = change.split_once(" =>").unwrap();
            let to = to.strip_prefix(' ').unwrap_or(to);
            changed = replace(&changed, &bytes(from), &bytes(to));
        }
        let found = answer(&name, &changed, None);
        if found == mesh { "the same mesh".to_owned() } else { found }
    });
}
