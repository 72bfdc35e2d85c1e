//! The optimised culler against the exact reference: `optimised ⊇ reference predicate ⊇ exact mesh
//! intersection`.
//!
//! [`answers`] are the reference's, pair by pair; [`compare()`] compares a culler's list with them.
//! What is judged comes from seeds ([`seeded_draws`]: random crowds, and contacts put together on
//! purpose), from the corpus of [`hard`] cases, and from scenes. Given [`boxes`] are compared with
//! their definition.

pub mod answers;
#[cfg(feature = "proptest")]
pub mod arbitrary;
pub mod borders;
pub mod boxes;
pub mod compare;
pub mod configurations;
pub mod contact;
pub mod coverage;
pub mod forms;
pub mod hard;
pub mod histories;
pub mod naive;
pub mod random;
pub mod reference_shapes;
pub mod seeded_draws;
pub mod world_kind;

pub use answers::{Answers, Predicate};
pub use compare::{ListCount, compare};
pub use contact::Contact;
pub use reference_shapes::Shapes;
