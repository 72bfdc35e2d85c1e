//! Scenes: files, errors, placement, effects, and one scene on many ranks.

#[path = "support/answers.rs"]
mod answers;
#[path = "support/changed.rs"]
mod changed;
mod domain;
mod effects;
mod far_scenes;
mod scene_errors;
mod scene_files;
mod scene_generation;
mod smallest_scene;
mod support;
