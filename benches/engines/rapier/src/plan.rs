//! What is run: a scene, what its bodies are made of, how many of them.

use std::fmt;
use std::str::FromStr;

/// A set of names that are read from the command line and written into records.
macro_rules! names {
    ($(#[$doc:meta])* $name:ident { $($(#[$entry_doc:meta])* $entry:ident = $text:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name { $($(#[$entry_doc])* $entry,)* }

        impl $name {
            /// All of them, in the order of tables.
            pub const ALL: &[Self] = &[$(Self::$entry,)*];

            /// As written in records.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$entry => $text,)* }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.pad(self.name())
            }
        }

        impl FromStr for $name {
            type Err = String;

            fn from_str(text: &str) -> Result<Self, String> {
                let found = Self::ALL.iter().find(|entry| entry.name() == text);
                found.copied().ok_or_else(|| {
                    let names: Vec<_> = Self::ALL.iter().map(|entry| entry.name()).collect();
                    format!("unknown name {text:?}; one of {}", names.join(", "))
                })
            }
        }
    };
}

names! {
    /// A scene that people simulate.
    Scene {
        /// Bodies dropped into an open box, where they settle.
        Pile = "pile",
        /// A closed box that turns about a horizontal axis (a kinematic body).
        Tumbler = "tumbler",
        /// A moving belt between two walls: what falls off its end is removed, and a new body is
        /// dropped at its start.
        Conveyor = "conveyor",
        /// Bodies flying about in a closed box, without gravity.
        Cloud = "cloud",
        /// Bodies of every kind that are disturbed from outside: teleported, put to sleep,
        /// exchanged, made sensors, regrouped.
        Zoo = "zoo",
    }
}

names! {
    /// What bodies are made of.
    Kind {
        /// One convex hull.
        Hull = "hull",
        /// One triangle mesh.
        Mesh = "mesh",
        /// One compound shape of two hulls.
        Compound = "compound",
        /// Two hulls that are two colliders of one body.
        Colliders = "colliders",
        /// A box.
        Box = "box",
        /// A ball.
        Ball = "ball",
    }
}

names! {
    /// How a run is stepped.
    Mode {
        /// Rapier as it comes: no hook, contacts recycled.
        Plain = "plain",
        /// No hook, contacts never recycled: what a hook makes of rapier before it rejects any
        /// pair.
        Full = "full",
        /// The filter in the hook.
        Hook = "hook",
        /// The filter in the query dispatcher; contacts recycled.
        Dispatcher = "dispatcher",
        /// The filter in the query dispatcher; contacts never recycled.
        DispatcherFull = "dispatcher-full",
    }
}

names! {
    /// How finely bodies are cut.
    Detail {
        /// Low-polygon meshes, as people simulate them.
        Coarse = "coarse",
        /// Meshes as they come from modelling, of thousands of triangles.
        Fine = "fine",
    }
}

names! {
    /// Rapier's numbers.
    Real {
        /// `rapier3d`.
        F32 = "f32",
        /// `rapier3d-f64`.
        F64 = "f64",
    }
}

impl Mode {
    /// Whether contacts are recycled, as far as a hook lets rapier do so.
    #[must_use]
    pub const fn recycles(self) -> bool {
        matches!(self, Self::Plain | Self::Dispatcher | Self::Hook)
    }

    /// Whether the filter is in the dispatcher.
    #[must_use]
    pub const fn dispatches(self) -> bool {
        matches!(self, Self::Dispatcher | Self::DispatcherFull)
    }

    /// The mode without the filter that makes the same of every pair.
    #[must_use]
    pub const fn unfiltered(self) -> Self {
        match self {
            Self::Plain | Self::Dispatcher => Self::Plain,
            Self::Full | Self::DispatcherFull | Self::Hook => Self::Full,
        }
    }
}

/// A scene to be set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// What happens.
    pub scene: Scene,
    /// To what.
    pub kind: Kind,
    /// How many bodies.
    pub bodies: usize,
    /// Where random draws start.
    pub seed: u64,
}
