//! Proofs are about code: if a function or constant of a lemma changes, the lemma has to be read
//! again. For each lemma, `paper/proofs/code.toml` has digests of the code with which it was last
//! compared.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde::Deserialize;
use sha2::{Digest, Sha256};

const TABLE: &str = "paper/proofs/code.toml";

/// Set, it makes [`lemmas_were_read_with_this_code`] write the digests of today.
const RENEW: &str = "SDOP_LEMMAS_READ";

#[derive(Deserialize)]
struct Table {
    about: Vec<LemmaSources>,
}

/// What a lemma is about.
#[derive(Deserialize)]
struct LemmaSources {
    lemma: String,
    /// Its Gappa scripts.
    #[serde(default)]
    scripts: Vec<String>,
    /// File, item and digest, with spaces between.
    code: Vec<String>,
}

fn table() -> Table {
    toml::from_str(&fs::read_to_string(TABLE).unwrap()).unwrap()
}

/// The source without comments: lines and braces stay.
fn bare(source: &str) -> String {
    let code = |line: &str| {
        let comment = line
            .match_indices("//")
            .map(|(at, _)| at)
            .find(|&at| line[..at].matches('"').count().is_multiple_of(2));
        line[..comment.unwrap_or(line.len())].to_owned() + "\n"
    };
    source.lines().map(code).collect()
}

/// From its start, a function or block up to its closing brace, a constant up to its semicolon.
fn whole(text: &str, ends_with_brace: bool) -> Option<&str> {
    let mut depth = 0;
    for (at, letter) in text.char_indices() {
        match letter {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            _ => {}
        }
        let ends = if ends_with_brace { '}' } else { ';' };
        if depth == 0 && letter == ends {
            return Some(&text[..=at]);
        }
    }
    None
}

/// The blocks that begin with `word` followed by `name` as a whole word, before `{`, `(`, `<`, `:`
/// or a space.
fn starts<'a>(source: &'a str, word: &str, name: &str) -> impl Iterator<Item = &'a str> {
    let (word, name) = (word.to_owned(), name.to_owned());
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
    source
        .match_indices(&word.clone())
        .map(move |(at, _)| (at, &source[at..]))
        .filter(move |&(at, text)| {
            let head = text.split(['{', '\n']).next().unwrap_or(text);
            let alone =
                !source[..at].ends_with(is_part) && !head[word.len()..].starts_with(is_part);
            let named = head.match_indices(&name).any(|(at, _)| {
                let free = !head[..at].ends_with(is_part);
                free && !head[at + name.len()..].starts_with(is_part)
            });
            let first = word == "impl" || head[word.len()..].trim_start().starts_with(&name);
            alone && named && first
        })
        .map(|(_, text)| text)
        .collect::<Vec<_>>()
        .into_iter()
}

/// A function or constant, `name` or `Type::name`, without comments, and without what formatting
/// adds or removes.
fn item(source: &str, name: &str) -> Option<String> {
    let source = bare(source);
    let found = match name.split_once("::") {
        Some((of, name)) => starts(&source, "impl", of)
            .filter_map(|block| whole(block, true))
            .find_map(|block| declared(block, name)),
        None => declared(&source, name),
    };
    found.map(|text| without_layout(text.split_whitespace().collect()))
}

/// `text` has no white space. Formatting also sets a comma after the last of a list, and braces
/// around the single expression of a closure or of an arm of `match`.
fn without_layout(mut text: String) -> String {
    let mut from = 0;
    while let Some(at) = text[from..].find("=>{").map(|at| from + at + 2) {
        from = at;
        if let Some(inner) = single_expression(&text[at..]) {
            let end = at + inner.len() + 2;
            let comma = if text[end..].starts_with(',') { "" } else { "," };
            text.replace_range(at..end, &format!("{inner}{comma}"));
        }
    }
    from = 0;
    while let Some(at) = text[from..].find("|{").map(|at| from + at + 1) {
        from = at;
        if let Some(inner) = single_expression(&text[at..]) {
            text.replace_range(at..at + inner.len() + 2, &inner);
        }
    }
    let closed = |(letter, next): (char, Option<char>)| {
        letter != ',' || !matches!(next, Some(')' | ']' | '}'))
    };
    let next = text.chars().skip(1).map(Some).chain([None]);
    text.chars().zip(next).filter(|&pair| closed(pair)).map(|(letter, _)| letter).collect()
}

/// What is in the block at the start of `text`, if it has no statement.
fn single_expression(text: &str) -> Option<String> {
    let block = whole(text, true)?;
    let inner = &block[1..block.len() - 1];
    (!inner.is_empty() && !inner.contains(';')).then(|| inner.to_owned())
}

fn declared<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let function = starts(text, "fn", name).find_map(|text| whole(text, true));
    function.or_else(|| starts(text, "const", name).find_map(|text| whole(text, false)))
}

/// Sixteen digits of the SHA-256 of an item.
fn digest(file: &str, name: &str) -> String {
    let source = fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let text = item(&source, name).unwrap_or_else(|| panic!("{TABLE}: {file} has no `{name}`"));
    let hash = Sha256::digest(text);
    hash[..8].iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The code is what the lemmas were read with.
#[test]
fn lemmas_were_read_with_this_code() {
    let mut changed = Vec::new();
    let mut renewed = fs::read_to_string(TABLE).unwrap();
    for LemmaSources { lemma, scripts, code } in table().about {
        for line in code {
            let words: Vec<&str> = line.split(' ').collect();
            let [file, name, read] = words[..] else {
                panic!("{TABLE}: `{line}` isn't a file, an item and a digest")
            };
            let today = digest(file, name);
            if today != read {
                changed.push(format!("{lemma} {scripts:?}: `{name}` in {file}"));
                renewed = renewed.replace(&line, &format!("{file} {name} {today}"));
            }
        }
    }
    if std::env::var_os(RENEW).is_some() {
        fs::write(TABLE, renewed).unwrap();
        return;
    }
    assert!(
        changed.is_empty(),
        "code has changed since these lemmas were read with it:\n  {}\nRead each in paper/proofs/LEMMAS.md and its scripts, \
         mend what no longer describes the code, run .ci/proofs, and then keep the new digests with\n  {RENEW}=1 cargo test \
         --test lemmas",
        changed.join("\n  ")
    );
}

/// Every script and every theorem is about some code.
#[test]
fn every_script_names_its_code() {
    let table = table();
    assert!(table.about.iter().all(|about| !about.code.is_empty()));
    let named: BTreeSet<String> = table.about.iter().flat_map(|a| a.scripts.clone()).collect();
    let mut scripts = BTreeSet::new();
    for entry in fs::read_dir("paper/proofs").unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        if path.extension() == Some("g".as_ref()) && !name.ends_with("_control") {
            scripts.insert(name);
        }
    }
    assert_eq!(named, scripts);
    let text = fs::read_to_string(Path::new(TABLE).with_file_name("LEMMAS.md")).unwrap();
    let lemmas: BTreeSet<String> = table.about.into_iter().map(|about| about.lemma).collect();
    let theorems = text.split("**Theorem ").skip(1);
    let theorems = theorems.map(|rest| format!("Theorem {}", &rest[..1]));
    assert_eq!(lemmas, theorems.collect());
}

/// Definitions in Coq name their code: a file and names in it, which exist.
#[test]
fn coq_definitions_name_existing_code() {
    let mut named = 0;
    for entry in fs::read_dir("paper/proofs/coq").unwrap() {
        let path = entry.unwrap().path();
        let text = fs::read_to_string(&path).unwrap();
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        for (at, _) in text.match_indices("src/") {
            let (file, names) = text[at..].split_once(": ").unwrap();
            let source = fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
            for (place, name) in names.split(", ").enumerate() {
                let end =
                    name.find(|letter: char| !letter.is_alphanumeric() && !"_:".contains(letter));
                let (word, rest) = name.split_at(end.unwrap_or(name.len()));
                // Prose may follow the names.
                if place > 0 && rest.starts_with(' ') && !rest.starts_with(" *)") {
                    break;
                }
                let word = word.trim_end_matches(':');
                assert!(
                    item(&source, word).is_some(),
                    "{}: {file} has no `{word}`",
                    path.display()
                );
                named += 1;
                if !rest.is_empty() {
                    break;
                }
            }
        }
    }
    assert!(named > 60, "{named}");
}

/// A digest is of the code and not of its layout.
#[test]
fn digest_ignores_layout() {
    let source = "
        /// Doc.
        const SIZES: [f64; 2] = [1.0, 2.0]; // two
        impl Other { fn near(x: f64) -> f64 { x } }
        impl<T> Cells<T> {
            const STEP: f64 = 3.0;
            fn nearest(x: f64) -> f64 { x - 1.0 }
            /// `fn near(` of another kind.
            fn near(x: f64) -> f64 {
                if x > 0.0 { x + 1.0 } else { 0.0 }
            }
        }
    ";
    let near = item(source, "Cells::near").unwrap();
    assert_eq!(near, "fnnear(x:f64)->f64{ifx>0.0{x+1.0}else{0.0}}");
    assert_eq!(item(source, "near").unwrap(), "fnnear(x:f64)->f64{x}");
    assert_eq!(item(source, "SIZES").unwrap(), "constSIZES:[f64;2]=[1.0,2.0];");
    assert_eq!(item(source, "Cells::STEP").unwrap(), "constSTEP:f64=3.0;");
    assert_eq!(item(source, "Cells::far"), None);
    let other = source.replace("x + 1.0", "x // one\n + 1.0");
    assert_eq!(item(&other, "Cells::near"), Some(near.clone()));
    let arms = |text: &str| without_layout(text.split_whitespace().collect());
    let one_line = arms("match x { Some(y) => f(y), None => g(|z| z + 1, 2) }");
    let many = "match x {\n Some(y) => {\n f(\n y,\n )\n }\n None => g(\n |z| {\n z + 1\n },\n 2,\n ),\n }";
    assert_eq!(one_line, arms(many));
    assert_ne!(one_line, arms(&many.replace("f(", "f(y);\n f(")));
    let other = source.replace("x + 1.0", "x + 2.0");
    assert_ne!(item(&other, "Cells::near"), Some(near));
}
