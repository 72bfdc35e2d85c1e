//! The errors of scenes: where the mistake is, what it is, and how to fix it.

use std::io::ErrorKind;
use std::ops::Range;
use std::path::Path;

use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

use sdop::bodies::contract::ContractError;
use sdop::choice::suggest;
use sdop::files;
use sdop::settings::SettingsError;

/// Why a scene could not be built.
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
        /// The system's error.
        cause: std::io::Error,
    },
    /// More bytes than the caller allows.
    #[error("{file}: the file has more than {most} bytes")]
    #[diagnostic(help("is it the scene you mean? If so, raise the limit: --max-file-size"))]
    TooLong {
        /// The path as given.
        file: String,
        /// How many are allowed.
        most: u64,
    },
    /// Something in the text of the scene file.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Text(Box<TextError>),
    /// Culling settings that can't be carried out.
    #[error("{}", .0.problem())]
    #[diagnostic(help("{}", .0.help()))]
    Settings(SettingsError),
    /// A body outside of the contract.
    #[error("{}", .0.problem())]
    #[diagnostic(help("{}", .0.help()))]
    Contract(ContractError),
}

crate::remedy::held_with_remedy!(SceneError, Settings(SettingsError), Contract(ContractError));

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
pub(super) struct SceneText {
    pub(super) file: String,
    pub(super) text: String,
}

impl SceneText {
    pub(super) fn read(path: &Path, max_bytes: u64) -> Result<Self, SceneError> {
        let file = path.display().to_string();
        match files::read_text(path, max_bytes) {
            Err(error) if error.kind() == ErrorKind::FileTooLarge => {
                Err(SceneError::TooLong { file, most: max_bytes })
            }
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

    /// An error of the TOML reader or of serde, with a hint where the message gives one away.
    pub(super) fn toml_error(&self, error: &toml::de::Error) -> SceneError {
        let end = self.text.len();
        let span = error.span().unwrap_or(end..end);
        let message = error.message().trim_end();
        let hint = hint_of(message).or_else(|| {
            let named_so = Path::new(&self.file).extension().is_some_and(|e| e == "toml");
            (!named_so).then(|| "a scene file is written in TOML; see data/scenes".to_owned())
        });
        self.error(span, message, hint)
    }
}

/// serde names what is missing, or lists the names that it expected after the one that it found,
/// all in backticks.
fn hint_of(message: &str) -> Option<String> {
    let names = |text: &str| -> Vec<String> {
        text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
    };
    if message.starts_with("missing field") {
        return names(message).first().map(|key| format!("add `{key}`"));
    }
    let (found, expected) = message.split_once(", expected ")?;
    let expected = names(expected);
    match names(found).last() {
        Some(found) if !expected.is_empty() => {
            Some(suggest(found, expected.iter().map(String::as_str)))
        }
        _ => None,
    }
}
