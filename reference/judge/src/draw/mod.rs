//! What is judged, drawn from seeds: [`bodies`] in random crowds and in contacts that are put
//! together on purpose, [`boxes`], the grid's [`borders`], and the corpus of [`hard`] cases.

#[cfg(feature = "proptest")]
pub mod arbitrary;
pub mod bodies;
pub mod borders;
pub mod boxes;
pub mod contact;
pub mod forms;
pub mod hard;
pub mod random;
