//! Texts that are others with a change.

/// What an input `FROM => TO` makes of a text, where `\n` is an end of a line; `None` for others.
pub fn changed(input: &str, text: &str) -> Option<String> {
    let (from, to) = input.split_once(" =>")?;
    let [from, to] =
        [from, to.strip_prefix(' ').unwrap_or(to)].map(|part| part.replace("\\n", "\n"));
    assert!(text.contains(&from), "{from}");
    Some(text.replacen(&from, &to, 1))
}
