//! Judges any culler, in any language, by the exact reference.
//!
//! A culler states a [`Claim`]: which pairs it never misses. The [`catalogue`] has the cases for
//! that claim. A [`subject`] answers them: a Rust type ([`judge`]) or a program ([`process`], over
//! a [`wire`]). The answers are compared with the exact [`truth`], and a missed pair is reduced to
//! the smallest scene that shows it ([`shrink`]), with a certificate ([`witness`]).
//!
//! ```
//! use sdop::bodies::Bodies;
//! use sdop_judge::{Claim, Contestant, Scene, judge};
//!
//! /// Reports every pair: slow, and it misses none.
//! struct Everything(usize);
//!
//! impl Contestant for Everything {
//!     fn frame(&mut self, bodies: &Bodies) {
//!         self.0 = bodies.len();
//!     }
//!     fn pairs(&self) -> Vec<[u32; 2]> {
//!         let n = self.0 as u32;
//!         (0..n).flat_map(|j| (0..j).map(move |i| [i, j])).collect()
//!     }
//! }
//!
//! let trial = judge(|scene: &Scene| Everything(scene.bodies.len())).claims(Claim::Mesh).cases("exact/*");
//! assert!(trial.run()?.passed());
//! assert!(!trial.extra_limit(0.0).run()?.passed(), "but it culls nothing");
//! # Ok::<(), sdop_judge::JudgeError>(())
//! ```

pub mod answer;
pub mod as_test;
#[cfg(feature = "programs")]
pub mod broadmark;
pub mod case;
pub mod catalogue;
pub mod claim;
pub mod configuration;
pub mod contestant;
pub mod counter_example;
pub mod draw;
pub mod history;
#[cfg(feature = "programs")]
pub mod json;
#[cfg(feature = "programs")]
pub mod process;
#[cfg(feature = "programs")]
pub mod record;
#[cfg(feature = "programs")]
pub mod report;
pub mod run;
pub mod score;
pub mod shrink;
pub mod subject;
pub mod truth;
#[cfg(feature = "programs")]
pub mod vectors;
pub mod verdict;
pub mod verify;
#[cfg(feature = "programs")]
pub mod wire;
pub mod witness;

pub use crate::contestant::{BodyPart, Contestant, Filter, WorldBox};
pub use case::{Case, Frame};
pub use claim::Claim;
pub use run::{Judge, JudgeError, Options, examine, judge, judge_function, judge_pair_test};
pub use score::{Miss, Outcome, PairCounts};
pub use sdop::bodies::Bodies;
pub use sdop::volume::Shape;
pub use subject::{Scene, Subject};
pub use verdict::{Conclusion, Verdict};
