//! Mesh files, and the volumes that contain their vertices.

#[path = "support/answers.rs"]
mod answers;
#[path = "support/changed.rs"]
mod changed;
#[path = "support/forms.rs"]
mod forms;
mod mesh;
mod volume;
