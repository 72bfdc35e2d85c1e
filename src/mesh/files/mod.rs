//! Mesh files: a reader and a writer per format. Feature `readers`.

mod obj;
mod off;
mod parts;
mod ply;
mod ply_header;
mod polygons;
mod read;
mod stl;
mod text;
mod tri;
mod weld;
mod write;

pub use read::{MeshFormat, ReadOptions, read, read_bytes};
pub use tri::TriFormat;
pub(super) use weld::weld;
pub use write::{write, write_bytes};
