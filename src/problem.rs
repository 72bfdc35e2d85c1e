//! The text of errors: what is wrong, and then how to mend it.

/// Gives errors with a `help` what their text needs. `Display` ends with the help, `Debug` prints
/// the same (for `unwrap`, and for a `main` that returns an error), and `problem` is the text
/// without it.
macro_rules! errors {
    ($($error:ty),+) => {$(
        impl $error {
            /// What is wrong, without [how to mend it](Self::help).
            #[must_use]
            pub fn problem(&self) -> String {
                let (mut text, help) = (self.to_string(), format!("; {}", self.help()));
                text.truncate(text.strip_suffix(&help).map_or(text.len(), str::len));
                text
            }
        }

        impl std::fmt::Debug for $error {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                std::fmt::Display::fmt(self, f)
            }
        }
    )+};
}
pub(crate) use errors;
