//! Scenes, their simulation, and the studies that judge and measure the culler; the library of the
//! program `sdop`. Engines only need the crate `sdop`.

extern crate self as sdop_bench; // commands name the rooms as from outside

#[cfg(feature = "maintain")]
pub mod board;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod commands;
pub mod cost;
pub mod decimate;
pub mod domain;
pub mod effects;
pub mod hash;
pub mod hull_test;
pub mod measure;
pub mod mpi;
pub mod network;
pub mod number;
pub mod outsiders;
pub mod percentiles;
pub mod posed_ordops;
pub mod random;
pub mod record;
pub mod remedy;
pub mod report;
pub mod reproduce;
pub mod roster;
pub mod scene;
pub mod simulate;
pub mod sweep;
pub mod tightness;
pub mod tradeoff;
pub mod verify;
pub mod view;
