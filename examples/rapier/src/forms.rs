//! What the bodies of all scenes look like: low-polygon meshes as people simulate them, within a ball of radius ½.

use std::path::Path;

use miette::{IntoDiagnostic, Result};
use sdop::mesh::decimate::decimate;
use sdop::mesh::{ProceduralShape, ReadOptions, TriangleMesh, read};

/// Closed meshes of 20 to 480 triangles: a cow, a ring, an L, a rod, a gear and a knot.
///
/// # Errors
/// `meshes` isn't the repository's folder of meshes.
pub fn forms(meshes: &Path) -> Result<Vec<TriangleMesh>> {
    let cow = read(meshes.join("spot.tri"), &ReadOptions::default())?;
    let mut forms = vec![decimate(&cow, 300)];
    for shape in [
        ProceduralShape::Torus {
            radius: 0.7,
            tube: 0.3,
            segments: 16,
            sides: 8,
        },
        ProceduralShape::LShape {
            x: 1.0,
            y: 1.0,
            arm: 0.3,
            thickness: 0.4,
        },
        ProceduralShape::Needle {
            length: 2.0,
            radius: 0.3,
            sides: 8,
        },
        ProceduralShape::Gear {
            tip: 1.0,
            root: 0.8,
            bore: 0.3,
            thickness: 0.4,
            teeth: 10,
        },
        ProceduralShape::Knot {
            radius: 0.8,
            tube: 0.15,
            segments: 40,
            sides: 6,
        },
    ] {
        forms.push(shape.build().into_diagnostic()?);
    }
    Ok(forms.iter().map(sized).collect())
}

/// Centred on its box, and scaled into the ball of radius ½.
fn sized(mesh: &TriangleMesh) -> TriangleMesh {
    let first = mesh.vertices[0];
    let (lo, hi) = mesh
        .vertices
        .iter()
        .fold((first, first), |(lo, hi), &v| (lo.min(v), hi.max(v)));
    let middle = (lo + hi) * 0.5;
    let reach = mesh
        .vertices
        .iter()
        .fold(0.0, |r: f32, v| r.max((*v - middle).length()));
    let mut sized = mesh.clone();
    for vertex in &mut sized.vertices {
        *vertex = (*vertex - middle) * (0.5 / reach);
    }
    sized
}
