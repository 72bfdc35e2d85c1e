//! Converts errors of the library and the judge, which name a remedy, to miette's diagnostics,
//! which the program prints.

use std::error::Error;
use std::fmt::{self, Display, Formatter};

use miette::{Diagnostic, Result};

/// An error that may say how to mend it.
pub trait Remedy: Error + Send + Sync + 'static {
    /// How to mend it.
    fn remedy(&self) -> Option<String>;

    /// What is wrong, without the remedy.
    fn problem(&self) -> String;
}

/// Errors whose `help` is always there.
macro_rules! always {
    ($($error:ty),+ $(,)?) => {
        $(impl Remedy for $error {
            fn remedy(&self) -> Option<String> {
                Some(self.help().to_string())
            }

            fn problem(&self) -> String {
                self.problem()
            }
        })+
    };
}

always!(
    sdop::bodies::contract::ContractError,
    sdop::choice::UnknownChoice,
    sdop::compound::CompoundError,
    sdop::culler::CullError,
    sdop::mesh::MeshError,
    sdop::mesh::shapes::ShapeError,
    sdop::periodic::PeriodicError,
    sdop::query::QueryError,
    sdop::settings::SettingsError,
    sdop::threads::ThreadsError,
    sdop::volume::VolumeError,
    sdop::world::SnapshotError,
    sdop::world::WorldError,
);

impl Remedy for sdop_judge::record::RecordError {
    fn remedy(&self) -> Option<String> {
        self.help().map(str::to_owned)
    }

    fn problem(&self) -> String {
        self.to_string()
    }
}

/// An error with its remedy, as a diagnostic that prints what is wrong, and the remedy as its help.
#[derive(Clone, Debug, PartialEq)]
pub struct WithRemedy<E: Remedy>(pub E);

impl<E: Remedy> Display for WithRemedy<E> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.problem())
    }
}

impl<E: Remedy> Error for WithRemedy<E> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.0.source()
    }
}

impl<E: Remedy> Diagnostic for WithRemedy<E> {
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        let help = self.0.remedy()?;
        Some(Box::new(help))
    }
}

/// Converts errors to variants that print them and their remedy apart.
macro_rules! held_with_remedy {
    ($holder:ty, $($variant:ident($error:ty)),+) => {
        $(impl From<$error> for $holder {
            fn from(error: $error) -> Self {
                Self::$variant(error)
            }
        })+
    };
}
pub(crate) use held_with_remedy;

/// Results whose error becomes a report with its remedy.
pub trait OrReport<T> {
    /// The value, or the error as a report.
    ///
    /// # Errors
    /// The same error.
    fn or_report(self) -> Result<T>;
}

impl<T, E: Remedy> OrReport<T> for Result<T, E> {
    fn or_report(self) -> Result<T> {
        self.map_err(|error| WithRemedy(error).into())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use sdop::threads::Threads;

    use super::OrReport as _;

    #[test]
    fn reports_keep_message_and_remedy() {
        let report = Threads::new(5000).or_report().unwrap_err();
        assert!(report.to_string().ends_with("at most 1024 can be asked for"));
        assert_eq!(report.help().unwrap().to_string(), "ask for fewer threads");
    }
}
