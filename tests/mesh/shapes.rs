//! Procedural shapes: closed 2-manifolds of the right genus, facing outward, with the right size,
//! equal on every platform.

use std::collections::HashMap;

use sdop::mesh::shapes::ShapeError;
use sdop::mesh::topology::Topology;
use sdop::mesh::{ProceduralShape, TriangleMesh};

use super::{sha256, signed_volume};

fn default_mesh(name: &str) -> TriangleMesh {
    ProceduralShape::from_name(name, &[]).unwrap().build().unwrap()
}

fn with(name: &str, sizes: &[(&str, f64)]) -> Result<TriangleMesh, ShapeError> {
    ProceduralShape::from_name(name, sizes)?.build()
}

/// Every directed edge once and its reverse once: closed, manifold and consistently oriented.
fn assert_oriented(mesh: &TriangleMesh) {
    let mut directed: HashMap<(u32, u32), u32> = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for edge in [(a, b), (b, c), (c, a)] {
            *directed.entry(edge).or_default() += 1;
        }
    }
    for (&(from, to), &count) in &directed {
        assert_eq!(count, 1, "{}: edge {from}->{to} used twice", mesh.name);
        assert!(directed.contains_key(&(to, from)), "{}: edge {from}->{to} unpaired", mesh.name);
    }
}

/// Every shape is one closed oriented component of its genus.
#[test]
fn shapes_are_closed_and_oriented() {
    for name in ProceduralShape::NAMES {
        let mesh = default_mesh(name);
        let topology = Topology::of(&mesh);
        let euler = if ["torus", "gear", "knot"].contains(&name) { 0 } else { 2 };
        assert_eq!(mesh.name, name);
        assert_eq!(topology.components.len(), 1, "{name}");
        assert!(topology.components[0].is_closed(), "{name}");
        assert_eq!(topology.components[0].euler_characteristic(), euler, "{name}");
        assert_eq!(topology.total().degenerate, 0, "{name}");
        assert_eq!(topology.unused_vertices, 0, "{name}");
        assert_oriented(&mesh);
        TriangleMesh::new(name, mesh.vertices, mesh.triangles).unwrap();
    }
}

/// Closed forms where the polyhedron has one; the smooth body's volume, met from inside, where it
/// has not.
#[test]
fn volumes_match_their_formulas() {
    let pi = std::f64::consts::PI;
    let polygon = |n: f64| 0.5 * n * (2.0 * pi / n).sin();
    let exact = [
        (with("box", &[("x", 2.0), ("y", 3.0), ("z", 5.0)]), 30.0),
        (with("plate", &[("x", 4.0), ("y", 2.0), ("thickness", 0.5)]), 4.0),
        (with("needle", &[("length", 3.0), ("radius", 1.0), ("sides", 5.0)]), polygon(5.0)),
        (with("l-shape", &[("x", 4.0), ("y", 3.0), ("arm", 1.0), ("thickness", 2.0)]), 12.0),
    ];
    for (mesh, volume) in exact {
        let mesh = mesh.unwrap();
        let found = signed_volume(&mesh);
        assert!((found / volume - 1.0).abs() < 1e-6, "{}: {found} for {volume}", mesh.name);
    }
    let smooth = [
        (with("icosphere", &[("subdivisions", 4.0)]), 4.0 / 3.0 * pi),
        (with("torus", &[]), 2.0 * pi * pi * 0.25 * 0.25),
        // Pappus: area of the tube times the knot's length, 3.0 radii a unit of the curve.
        (with("knot", &[("segments", 512.0), ("sides", 64.0)]), pi * 0.15 * 0.15 * knot_length()),
    ];
    for (mesh, volume) in smooth {
        let mesh = mesh.unwrap();
        let share = signed_volume(&mesh) / volume;
        assert!((0.97..1.0).contains(&share), "{}: {share} of the smooth volume", mesh.name);
    }
}

fn knot_length() -> f64 {
    let speed = |u: f64| {
        let (x, y, z) = (
            u.cos() + 4.0 * (2.0 * u).cos(),
            4.0 * (2.0 * u).sin() - u.sin(),
            -3.0 * (3.0 * u).cos(),
        );
        (x * x + y * y + z * z).sqrt() / 3.0
    };
    let n = 4096;
    let step = std::f64::consts::TAU / f64::from(n);
    (0..n).map(|i| speed(step * f64::from(i))).sum::<f64>() * step
}

/// Sizes that make no shape are refused with what would do.
#[test]
fn invalid_sizes_are_rejected() {
    type Case<'a> = (&'a str, &'a [(&'a str, f64)], &'a str, &'a str);
    let cases: [Case; 9] = [
        ("cube", &[], r#"there is no shape "cube""#, "the shapes are box, icosphere, needle"),
        ("box", &[("w", 1.0)], r#"the shape "box" has no size "w""#, "its sizes are x, y, z"),
        (
            "box",
            &[("x", 0.0)],
            r#"the size "x" of the shape "box" cannot be 0"#,
            "x must be from 2^-60",
        ),
        ("box", &[("x", f64::NAN)], "cannot be NaN", "x must be from 2^-60 to 2^58"),
        ("needle", &[("sides", 2.5)], "cannot be 2.5", "sides must be a whole number"),
        ("needle", &[("sides", -3.0)], "cannot be 0", "sides must be from 3 to 1024"),
        ("icosphere", &[("subdivisions", 8.0)], "cannot be 8", "subdivisions must be from 0 to 7"),
        ("torus", &[("tube", 1.0)], "cannot be 1", "tube must be less than 1, the ring's radius"),
        ("gear", &[("bore", 0.75)], "cannot be 0.75", "bore must be less than 0.7"),
    ];
    for (name, sizes, message, help) in cases {
        let error = with(name, sizes).unwrap_err();
        let found_help = error.help();
        assert!(error.to_string().contains(message), "{error}");
        assert!(found_help.contains(help), "{found_help}");
    }
}

/// The bits of all default shapes: they must not depend on the platform's libm, optimisation or
/// hash order.
#[test]
fn shape_bits_are_fixed() {
    let mut bytes = Vec::new();
    for name in ProceduralShape::NAMES {
        let mesh = default_mesh(name);
        for vertex in &mesh.vertices {
            bytes.extend(vertex.iter().flat_map(|c| c.to_bits().to_le_bytes()));
        }
        bytes.extend(mesh.triangles.as_flattened().iter().flat_map(|i| i.to_le_bytes()));
    }
    assert_eq!(sha256(&bytes), "a8925df26c80ade6f49e90e899554bad3151f811aedf245fb136d122973c82ac");
}
