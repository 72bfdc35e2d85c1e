//! Enums whose variants have names: one list of names serves scene files, command-line flags,
//! tables and JSON.

use thiserror::Error;

/// The error for an unknown name.
#[derive(Clone, PartialEq, Eq, Error)]
#[error("unknown {what} `{given}`; {help}", help = self.help())]
pub struct UnknownChoice {
    /// The kind of choice, for example "strategy".
    pub what: &'static str,
    /// The name as given.
    pub given: String,
    /// How to mend it.
    pub hint: String,
}

crate::problem::errors!(UnknownChoice);

impl UnknownChoice {
    /// How to mend it.
    #[must_use]
    pub fn help(&self) -> &str {
        &self.hint
    }

    /// The error for the name `given`. Its hint is the nearest name in `known`, or all of them.
    #[must_use]
    pub fn new(what: &'static str, given: &str, known: &[&str]) -> Self {
        Self { what, given: given.to_owned(), hint: suggest(given, known.iter().copied()) }
    }
}

/// "did you mean …" if a known name is close to the given one, otherwise the list of all names.
#[must_use]
pub fn suggest<'a>(given: &str, known: impl Iterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.collect();
    match nearest(given, known.iter().copied()) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("one of: {}", known.join(", ")),
    }
}

/// The known name that is close to the given one, if there is one.
#[must_use]
pub fn nearest<'a>(given: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let lower = given.to_lowercase().replace('_', "-");
    // Allow one edit per three letters: two edits in a short word already make another word.
    let allowed = given.chars().count() / 3;
    let distance = |name: &str| strsim::damerau_levenshtein(&lower, &name.replace('_', "-"));
    known
        .map(|name| (distance(name), name))
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, _)| *distance <= allowed)
        .map(|(_, name)| name)
}

/// Declares an enum of named choices with `ALL`, `NAMES`, `name`, `Display` and `FromStr`; serde
/// reads and writes the name.
#[doc(hidden)]
#[macro_export]
macro_rules! choices {
    ($(#[$meta:meta])* $name:ident, $what:literal, { $($(#[$doc:meta])* $variant:ident = $text:literal,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum $name { $($(#[$doc])* $variant),+ }

        impl $name {
            /// Every choice.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];
            /// The name of every choice, as scene files and flags spell it.
            pub const NAMES: &'static [&'static str] = &[$($text),+];

            /// The name that scene files and flags spell.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $text),+ }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.name())
            }
        }

        impl std::str::FromStr for $name {
            type Err = $crate::choice::UnknownChoice;

            fn from_str(text: &str) -> Result<Self, Self::Err> {
                match text {
                    $($text => Ok(Self::$variant),)+
                    _ => Err($crate::choice::UnknownChoice::new($what, text, Self::NAMES)),
                }
            }
        }

        $crate::choices_as_text!($name, $what);
    };
}
pub use choices;

/// Implements serde for a choice, as its name.
#[cfg(feature = "serde")]
#[doc(hidden)]
#[macro_export]
macro_rules! choices_as_text {
    ($name:ident, $what:literal) => {
        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_str($crate::choice::NameVisitor {
                    what: $what,
                    names: Self::NAMES,
                    values: Self::ALL,
                })
            }
        }
    };
}

/// Implements nothing without the feature `serde`.
#[cfg(not(feature = "serde"))]
#[doc(hidden)]
#[macro_export]
macro_rules! choices_as_text {
    ($name:ident, $what:literal) => {};
}

#[cfg(feature = "serde")]
/// Deserialises one of `names` as the value at the same index.
pub struct NameVisitor<T: 'static> {
    #[doc(hidden)]
    pub what: &'static str,
    #[doc(hidden)]
    pub names: &'static [&'static str],
    #[doc(hidden)]
    pub values: &'static [T],
}

#[cfg(feature = "serde")]
impl<T: Copy> serde::de::Visitor<'_> for NameVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "a {} ({})", self.what, self.names.join(", "))
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<T, E> {
        self.names
            .iter()
            .zip(self.values)
            .find_map(|(name, value)| (*name == text).then_some(*value))
            .ok_or_else(|| E::unknown_variant(text, self.names))
    }
}
