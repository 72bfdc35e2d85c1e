//! What can be wrong with a scene: where, what, and how to mend it.

use std::ops::Range;
use std::path::Path;

use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

use super::choice::suggest;
use super::contract::ContractError;
use super::settings::SettingsError;

/// Why a scene could not be made.
#[derive(Debug, Error, Diagnostic)]
pub enum SceneError {
    /// The scene file itself could not be read.
    #[error("{file}: {cause}")]
    #[diagnostic(help(
        "give the path of a scene file in TOML, for example data/scenes/paper-500.toml"
    ))]
    Unreadable {
        /// The path as given.
        file: String,
        /// What the system said.
        cause: std::io::Error,
    },
    /// Something in the text of the scene file.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Text(Box<TextError>),
    /// Culling settings that can't be carried out.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Settings(#[from] SettingsError),
    /// A body outside of the contract.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Contract(#[from] ContractError),
}

/// An error at a place of the scene file. Prints as `file:line:column: message`.
#[derive(Debug, Error, Diagnostic)]
#[error("{file}:{line}:{column}: {message}")]
pub struct TextError {
    /// The scene file as the caller named it.
    pub file: String,
    /// 1-based line.
    pub line: usize,
    /// 1-based column, counted in characters.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// How to mend it.
    #[help]
    pub hint: Option<String>,
    /// The scene file's text.
    #[source_code]
    pub code: NamedSource<String>,
    /// The offending bytes of the text.
    #[label("here")]
    pub span: SourceSpan,
}

/// A scene file's name and text: what an error needs to point at a place.
#[derive(Clone, Debug)]
pub(super) struct Source {
    pub(super) file: String,
    pub(super) text: String,
}

impl Source {
    pub(super) fn read(path: &Path) -> Result<Self, SceneError> {
        let file = path.display().to_string();
        match std::fs::read_to_string(path) {
            Ok(text) => Ok(Self { file, text }),
            Err(cause) => Err(SceneError::Unreadable { file, cause }),
        }
    }

    /// An error at the bytes `span` of the text.
    pub(super) fn error(
        &self,
        span: Range<usize>,
        message: impl Into<String>,
        hint: impl Into<Option<String>>,
    ) -> SceneError {
        let before = self.text.get(..span.start).unwrap_or(&self.text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        SceneError::Text(Box::new(TextError {
            file: self.file.clone(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            message: message.into(),
            hint: hint.into(),
            code: NamedSource::new(&self.file, self.text.clone()).with_language("TOML"),
            span: span.into(),
        }))
    }

    /// An error of the TOML reader or of serde, with the nearest expected name as its hint.
    pub(super) fn toml_error(&self, error: &toml::de::Error) -> SceneError {
        let end = self.text.len();
        let span = error.span().unwrap_or(end..end);
        self.error(
            span,
            error.message().trim_end(),
            expected_names(error.message()),
        )
    }
}

/// serde lists the names that it expected in backticks after the one that it found: suggest from them.
fn expected_names(message: &str) -> Option<String> {
    let (found, expected) = message.split_once(", expected ")?;
    let names = |text: &str| -> Vec<String> {
        text.split('`')
            .skip(1)
            .step_by(2)
            .map(str::to_owned)
            .collect()
    };
    let (found, expected) = (names(found), names(expected));
    if expected.is_empty() {
        return None;
    }
    Some(suggest(found.last()?, expected.iter().map(String::as_str)))
}
