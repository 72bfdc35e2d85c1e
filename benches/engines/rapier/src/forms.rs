//! The shapes of bodies in all scenes, within a ball of radius ½.

use std::path::Path;

use miette::Result;
use sdop::mesh::decimate::decimate;
use sdop::mesh::{ProceduralShape, ReadOptions, TriangleMesh, read};
use sdop_bench::remedy::OrReport as _;

use crate::plan::Detail;

/// A cow, a ring, an L, a rod, a gear and a knot, all closed: of 16 to 480 triangles, or finely cut
/// of up to 7,680.
///
/// # Errors
/// `meshes` isn't the repository's folder of meshes.
pub fn forms(meshes: &Path, detail: Detail) -> Result<Vec<TriangleMesh>> {
    let cow = read(meshes.join("spot.tri"), &ReadOptions::default()).or_report()?;
    let (cow, n) = match detail {
        Detail::Coarse => (decimate(&cow, 300), 1),
        Detail::Fine => (cow, 4),
    };
    let mut forms = vec![cow];
    for shape in [
        ProceduralShape::Torus { radius: 0.7, tube: 0.3, segments: 16 * n, sides: 8 * n },
        ProceduralShape::LShape { x: 1.0, y: 1.0, arm: 0.3, thickness: 0.4 },
        ProceduralShape::Needle { length: 2.0, radius: 0.3, sides: 8 * n },
        ProceduralShape::Gear { tip: 1.0, root: 0.8, bore: 0.3, thickness: 0.4, teeth: 10 * n },
        ProceduralShape::Knot { radius: 0.8, tube: 0.15, segments: 40 * n, sides: 6 * n },
    ] {
        forms.push(shape.build().or_report()?);
    }
    Ok(forms.iter().map(sized).collect())
}

/// Centred on its box, and scaled into the ball of radius ½.
fn sized(mesh: &TriangleMesh) -> TriangleMesh {
    let (mut lo, mut hi) = (mesh.vertices[0], mesh.vertices[0]);
    for vertex in &mesh.vertices {
        for axis in 0..3 {
            lo[axis] = lo[axis].min(vertex[axis]);
            hi[axis] = hi[axis].max(vertex[axis]);
        }
    }
    let centred = |vertex: &[f32; 3]| -> [f32; 3] {
        std::array::from_fn(|axis| vertex[axis] - (lo[axis] + hi[axis]) * 0.5)
    };
    let length = |[x, y, z]: [f32; 3]| (x * x + y * y + z * z).sqrt();
    let reach = mesh.vertices.iter().fold(0.0, |r: f32, vertex| r.max(length(centred(vertex))));
    let mut sized = mesh.clone();
    for vertex in &mut sized.vertices {
        *vertex = centred(vertex).map(|x| x * (0.5 / reach));
    }
    sized
}
