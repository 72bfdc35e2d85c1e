//! The errors of meshes: where the mistake is (file and line), what it is, and how to fix it.

use super::MAX_COORDINATE;

/// Why a mesh was rejected. It prints as `file:line: problem`; the help text says how to fix it.
#[derive(thiserror::Error)]
#[error("{}: {problem}; {help}", place(.file, *.line), help = self.help())]
pub struct MeshError {
    /// The file as the caller named it, or the mesh's name when it came from no file.
    pub file: String,
    /// 1-based line of a text file; `None` for binary files and problems of the whole file.
    pub line: Option<usize>,
    /// What is wrong. It is not the error's `source`, because its text is part of this error's
    /// text.
    pub problem: Problem,
}

crate::problem::errors!(MeshError);

impl MeshError {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> String {
        self.problem.help()
    }
}

pub(super) fn place(file: &str, line: Option<usize>) -> String {
    line.map_or_else(|| file.to_owned(), |line| format!("{file}:{line}"))
}

/// One way in which a mesh or a mesh file can be wrong.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// The operating system failed to read or write the file.
    #[error("cannot {action} the file: {source}")]
    Io {
        /// "read" or "write".
        action: &'static str,
        /// The system's error.
        source: std::io::Error,
    },
    /// The file has more bytes than the caller allows.
    #[error("the file has more than {most} bytes")]
    TooLong {
        /// The allowed number of bytes.
        most: u64,
    },
    /// The file name's extension is not that of a known format.
    #[error("the extension {found:?} names no mesh format that can be {action}")]
    UnknownFormat {
        /// The extension as found, without the dot.
        found: String,
        /// "read" or "written".
        action: &'static str,
    },
    /// The file is empty, or the mesh has no vertices.
    #[error("the mesh has no vertices")]
    NoVertices,
    /// Vertices without a triangle.
    #[error("the mesh has no triangles")]
    NoTriangles,
    /// More vertices or triangles than a u32 can number.
    #[error("the mesh has {count} {what}: more than 2^32 - 1")]
    TooMany {
        /// "vertices" or "triangles".
        what: &'static str,
        /// How many.
        count: u64,
    },
    /// A NaN or infinite coordinate (also a number beyond f32's range).
    #[error("vertex {vertex} has the coordinate {value}: not a finite f32")]
    NotFinite {
        /// 0-based vertex index.
        vertex: usize,
        /// The offending coordinate.
        value: f32,
    },
    /// A coordinate beyond the culler's contract.
    #[error("vertex {vertex} has the coordinate {value:e}: beyond 2^60")]
    TooLarge {
        /// 0-based vertex index.
        vertex: usize,
        /// The offending coordinate.
        value: f32,
    },
    /// A scale with a factor that is zero or not finite.
    #[error("the scale {scale:?} has a factor that is zero or not finite")]
    Scale {
        /// The factors of x, y and z.
        scale: [f64; 3],
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {index}, but the vertices are {first} to {last}")]
    IndexOutOfRange {
        /// 0-based triangle index.
        triangle: usize,
        /// The index as the file has it.
        index: i64,
        /// The lowest allowed index in the file's own counting.
        first: u64,
        /// The highest allowed index in the file's own counting.
        last: u64,
    },
    /// The text or bytes do not follow the format.
    #[error("{message}")]
    Malformed {
        /// What was expected and what was found.
        message: String,
        /// How to mend it.
        help: String,
    },
    /// Two or more `.tri` dialects fit the file.
    #[error("the file can be read as {}", .readings.join(" or as "))]
    Ambiguous {
        /// A description of each dialect that fits.
        readings: Vec<&'static str>,
        /// The names that select these dialects.
        names: Vec<&'static str>,
    },
}

impl Problem {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> String {
        let help = match self {
            Self::Io { .. } => "check the path and its permissions",
            Self::TooLong { .. } => {
                "is it the file you mean? If so, raise the limit: --max-file-size, or `ReadOptions::max_bytes`"
            }
            Self::UnknownFormat { .. } => "use .tri, .obj, .stl, .ply or .off",
            Self::NoVertices => "give at least one vertex; the file may be empty or cut off",
            Self::NoTriangles => "give at least one triangle; a single point is the triangle 0 0 0",
            Self::TooMany { .. } => "split the mesh",
            Self::NotFinite { .. } => {
                "every coordinate must be a finite number; look for a division by zero in the exporter"
            }
            Self::TooLarge { .. } => {
                return format!(
                    "scale the mesh down: coordinates up to {MAX_COORDINATE:e} (2^60) are allowed"
                );
            }
            Self::Scale { .. } => "give one factor, or three as [x, y, z]; negative ones mirror",
            Self::IndexOutOfRange { .. } => {
                "check the vertex count and whether the file's indices start at 0 or at 1"
            }
            Self::Malformed { help, .. } => help,
            Self::Ambiguous { names, .. } => {
                let names = names.join(" or --tri-format ");
                return format!("say which is meant with --tri-format {names}");
            }
        };
        help.to_owned()
    }

    /// A format violation with its remedy.
    #[cfg(feature = "readers")]
    pub(super) fn malformed(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Malformed { message: message.into(), help: help.into() }
    }

    /// The problem as an error of a file, with a line if it is known.
    pub(super) fn at(self, file: &str, line: impl Into<Option<usize>>) -> MeshError {
        MeshError { file: file.to_owned(), line: line.into(), problem: self }
    }
}
