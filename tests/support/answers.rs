//! Files of inputs and answers: a suite answers each input, and the file has the expected answers.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use snapbox::{Data, filter::NormalizeToExpected};

/// Checks a file. A line that begins with `$ ` is an input, which lines with `> ` continue; `#`
/// begins a comment; what follows is the answer. In it, `[..]` matches any text and a line `...`
/// any lines. With `SNAPSHOTS=overwrite` in the environment, the file gets the answers of this run
/// and keeps the patterns that match.
pub fn check(path: &Path, mut answer: impl FnMut(&str) -> String) {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().peekable();
    let (mut whole, mut wrong) = (String::new(), Vec::new());
    while let Some(line) = lines.next() {
        whole += &format!("{line}\n");
        let Some(first) = line.strip_prefix("$ ") else { continue };
        let mut input = first.to_owned();
        while let Some(line) = lines.next_if(|line| line.starts_with('>')) {
            whole += &format!("{line}\n");
            input += &format!("\n{}", line.get(2..).unwrap_or_default());
        }
        let mut expected = Vec::new();
        while let Some(line) = lines.next_if(|line| !line.starts_with(['#', '$'])) {
            expected.push(line);
        }
        let expected = expected.join("\n").trim_end().to_owned();
        let found = Data::text(answer(&input).trim_end());
        let found = NormalizeToExpected::new().redact().normalize(found, &Data::text(&expected));
        let found = found.render().unwrap();
        if found != expected {
            wrong.push(format!("$ {input}\nexpected:\n{expected}\nfound:\n{found}\n"));
        }
        whole += &if found.is_empty() { "\n".to_owned() } else { format!("{found}\n\n") };
    }
    if std::env::var_os("SNAPSHOTS").is_some_and(|action| action == "overwrite") {
        std::fs::write(path, whole.trim_end().to_owned() + "\n").unwrap();
    } else {
        assert!(wrong.is_empty(), "{}:\n{}", path.display(), wrong.join("\n"));
    }
}
