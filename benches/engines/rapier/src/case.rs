//! A dropped pair as a scene that `sdop run` and `sdop verify` take.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use miette::{IntoDiagnostic, Result};
use sdop::mesh::{self, TriangleMesh};
use sdop::volume::Shape;
use sdop_bench::remedy::OrReport as _;

/// One collider of the pair.
pub struct CaseBody {
    /// Its shape, about its own origin.
    pub shape: Shape,
    /// Whether it may move.
    pub fixed: bool,
    /// Quaternion (x, y, z, w).
    pub rotation: [f32; 4],
    /// Relative to the first collider's, so that f32 holds it.
    pub translation: [f32; 3],
}

/// Writes the scene and a mesh file per body into `directory`; `comment` says what happened.
/// Returns the scene's path.
///
/// # Errors
/// A file that can't be written.
pub fn write(directory: &Path, bodies: &[CaseBody], comment: &str) -> Result<PathBuf> {
    std::fs::create_dir_all(directory).into_diagnostic()?;
    let mut text = format!("# {comment}\nname = \"dropped-pair\"\nframes = 1\n");
    for (i, body) in bodies.iter().enumerate() {
        let file = format!("dropped-pair-{i}.obj");
        let mesh = TriangleMesh {
            name: body.shape.name.clone(),
            vertices: body.shape.vertices.clone(),
            triangles: body.shape.triangles.clone(),
            ..TriangleMesh::default()
        };
        mesh::write(&mesh, directory.join(&file)).or_report()?;
        let pose = [&body.rotation[..], &body.translation].concat();
        // As f64, which scene files have for translations: each reads back to this number.
        let numbers = pose.iter().map(|&x| format!("{:?}", f64::from(x)));
        let numbers: Vec<String> = numbers.collect();
        // Formatting into a String cannot fail.
        let _ = write!(
            text,
            "\n[[bodies]]\nmesh = \"{file}\"\norigin = \"file\"\nposes = [[{}]]\nstatic = {}\n",
            numbers.join(", "),
            body.fixed
        );
    }
    let path = directory.join("dropped-pair.toml");
    crate::whole::write(&path, &text)?;
    Ok(path)
}
