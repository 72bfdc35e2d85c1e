//! S-DOP culling between rapier's broad phase and its narrow phase. An application copies the files
//! that it uses.
#![allow(
    clippy::duplicate_mod,
    clippy::unnecessary_cast,
    reason = "one source serves rapier's two crates, f32 and f64"
)]

macro_rules! filters {
    ($name:ident, $engine:ident) => {
        #[path = "."]
        pub mod $name {
            //! For the crate of this name.
            pub use $engine as rapier;

            #[cfg(test)]
            mod contacts;
            mod dispatcher;
            mod filter;
            mod volumes;

            pub use dispatcher::CullingDispatcher;
            pub use filter::{Cost, Filter, HOOKS};
            pub use volumes::{Step, volume};
        }
    };
}

filters!(single, rapier3d);
filters!(double, rapier3d_f64);
