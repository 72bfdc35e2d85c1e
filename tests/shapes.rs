//! Mesh files, and the volumes that contain their vertices.

#[path = "support/forms.rs"]
mod forms;
mod mesh;
mod volume;
