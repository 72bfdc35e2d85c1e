//! Long-lived sets: after each change, pairs, events and answers are those of the present bodies.

mod boxes;
mod compound;
#[path = "support/forms.rs"]
mod forms;
#[path = "support/histories.rs"]
mod histories;
mod periodic;
mod queries;
mod world;
