//! What pages, proofs and examples say about the code.

#[path = "support/forms.rs"]
mod forms;
mod guide;
mod languages;
mod lemmas;
mod origins;
mod records;
mod rooms;
