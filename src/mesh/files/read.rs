//! Reading a mesh file: the extension selects the format's reader, and validation makes the mesh.

use std::io::ErrorKind;
use std::path::Path;

use super::parts::RawMesh;
use super::text::LineProblem;
use super::{TriFormat, obj, off, ply, polygons, stl, tri};
use crate::files;
use crate::mesh::error::place;
use crate::mesh::{MeshError, Problem, TriangleMesh};

/// A mesh file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// `.tri` in one of its dialects.
    Tri,
    /// Wavefront OBJ.
    Obj,
    /// STL, text or binary.
    Stl,
    /// PLY, text or binary.
    Ply,
    /// OFF, text.
    Off,
}

/// Options for reading: what a file does not say about itself, and a size limit.
#[derive(Clone, Copy, Debug)]
pub struct ReadOptions {
    /// The dialect of a `.tri` file; `None` detects the one that fits.
    pub tri_format: Option<TriFormat>,
    /// The largest allowed file, in bytes.
    pub max_bytes: u64,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self { tri_format: None, max_bytes: files::MAX_BYTES }
    }
}

impl MeshFormat {
    /// The format of a path's extension, in upper or lower case.
    pub fn from_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "tri" => Some(Self::Tri),
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            "off" => Some(Self::Off),
            _ => None,
        }
    }

    /// As [`Self::from_path`], with an error for unknown extensions; `action` is "read" or
    /// "written".
    pub(super) fn of_path(path: &Path, action: &'static str) -> Result<Self, Problem> {
        Self::from_path(path).ok_or_else(|| Problem::UnknownFormat {
            found: path.extension().unwrap_or_default().to_string_lossy().into_owned(),
            action,
        })
    }
}

/// Reads a mesh file; the mesh is named after the file's stem.
///
/// # Errors
/// An unknown extension, a file that cannot be read, or any error of [`read_bytes`].
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<TriangleMesh, MeshError> {
    let path = path.as_ref();
    let file = path.display().to_string();
    let format = MeshFormat::of_path(path, "read").map_err(|problem| problem.at(&file, None))?;
    let bytes = files::read(path, options.max_bytes).map_err(|source| {
        let problem = match source.kind() {
            ErrorKind::FileTooLarge => Problem::TooLong { most: options.max_bytes },
            _ => Problem::Io { action: "read", source },
        };
        problem.at(&file, None)
    })?;
    read_bytes(&file, format, &bytes, options)
}

/// Reads a mesh from a file's contents. `file` is the name for messages, and its stem the mesh's
/// name.
///
/// # Errors
/// Anything that breaks the format or the mesh contract, with the line in a text file. No input
/// panics.
pub fn read_bytes(
    file: &str,
    format: MeshFormat,
    bytes: &[u8],
    options: &ReadOptions,
) -> Result<TriangleMesh, MeshError> {
    let parts = match format {
        MeshFormat::Tri => tri::read(bytes, options.tri_format),
        MeshFormat::Obj => obj::read(bytes),
        MeshFormat::Stl => stl::read(bytes),
        MeshFormat::Ply => ply::read(bytes),
        MeshFormat::Off => off::read(bytes),
    };
    let at = |(line, problem): LineProblem| problem.at(file, line);
    let RawMesh { points, triangles, polygons, warnings } = parts.map_err(at)?;
    let stem = Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
    let mesh = match triangles {
        Some(triangles) => {
            TriangleMesh::rounded(&points, &triangles).map_err(|error| error.problem)
        }
        None => TriangleMesh::from_soup(&points),
    };
    let mut mesh = mesh.map_err(|problem| problem.at(file, None))?.named(stem);
    let doubtful = polygons::cut(&mut mesh, &polygons).map_err(at)?;
    let placed = |(line, message)| format!("{}: {message}", place(file, line));
    mesh.warnings = warnings.into_iter().chain(doubtful).map(placed).collect();
    Ok(mesh)
}
