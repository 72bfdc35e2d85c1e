//! Pages whose numbers come from records: text between markers is rendered, the rest is the author's.
//!
//! A marker is an HTML comment, so that a page reads the same with and without it: `<!--= EXPRESSION -->3.14<!--/-->`. What stands
//! between `<!--=` and `-->` is an expression, or a template with `{{ … }}` and `{% … %}` (the syntax is Jinja's), and what stands behind it up
//! to `<!--/-->` is what it gives. `{% set … %}` of one marker is not seen by the next: `<!--: NAME = EXPRESSION -->` names a value
//! for the rest of the page.
//!
//! | function or filter | gives |
//! |---|---|
//! | `csv("machine/experiment/file.csv")` | rows, objects of cells |
//! | `json("machine/experiment/file.json")` | the value |
//! | `record("machine/experiment")` | the manifest, with `id` |
//! | `rows \| where(column=value, …)`, `rows \| one(column=value, …)` | the rows with these cells; the only one, or an error |
//! | `x \| fixed(2)`, `x \| sig(3)`, `n \| thousands`, `x \| percent(1)` | digits behind the point; digits that count; 12,345; 12.3 |

use miette::Diagnostic;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Kwargs, Rest, Serde};
use minijinja::{Environment, Error, ErrorKind, Value, context};
use serde_json::Value as Json;
use std::sync::Arc;

use super::store::Store;

const OPEN: &str = "<!--=";
const NAME: &str = "<!--:";
const SHUT: &str = "-->";
const END: &str = "<!--/-->";

/// A page that can't be rendered.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("{page}:{line}: {problem}")]
#[diagnostic(help(
    "a marker is <!--= EXPRESSION -->text<!--/-->; `sdop report --help` lists what an expression may use"
))]
pub struct PageError {
    page: String,
    line: usize,
    problem: String,
}

/// A page as its records have it. Nothing outside of markers changes.
///
/// # Errors
/// A marker without an end, an expression that has no value, a record that was changed.
pub fn render(page: &str, text: &str, store: &Arc<Store>) -> Result<String, PageError> {
    let mut environment = environment(store);
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((start, marker)) = next(rest) {
        let line = 1 + text[..text.len() - rest.len() + start]
            .matches('\n')
            .count();
        let failed = |problem: String| PageError {
            page: page.to_owned(),
            line,
            problem,
        };
        let from = start + marker.len();
        let shut = rest[from..]
            .find(SHUT)
            .ok_or_else(|| failed(format!("`{marker}` without `{SHUT}`")))?;
        let (source, behind) = (&rest[from..from + shut], from + shut + SHUT.len());
        out.push_str(&rest[..behind]);
        rest = &rest[behind..];
        if marker == NAME {
            set(&mut environment, source).map_err(|error| failed(said(&error)))?;
            continue;
        }
        let end = rest
            .find(END)
            .ok_or_else(|| failed(format!("`{OPEN}` without `{END}`")))?;
        if next(&rest[..end]).is_some() {
            return Err(failed(format!("`{OPEN}` without `{END}` before the next")));
        }
        out.push_str(&evaluate(&environment, source).map_err(|error| failed(said(&error)))?);
        out.push_str(END);
        rest = &rest[end + END.len()..];
    }
    out.push_str(rest);
    Ok(out)
}

/// The next marker and which one it is.
fn next(text: &str) -> Option<(usize, &'static str)> {
    [OPEN, NAME]
        .into_iter()
        .filter_map(|marker| Some((text.find(marker)?, marker)))
        .min()
}

fn set(environment: &mut Environment<'_>, source: &str) -> Result<(), Error> {
    let wrong = || Error::new(ErrorKind::SyntaxError, "expected NAME = EXPRESSION");
    let (name, expression) = source.split_once('=').ok_or_else(wrong)?;
    let value = environment
        .compile_expression(expression.trim())?
        .eval(context! {})?;
    environment.add_global(name.trim().to_owned(), value);
    Ok(())
}

fn evaluate(environment: &Environment<'_>, source: &str) -> Result<String, Error> {
    if source.contains("{%") || source.contains("{{") {
        return environment.render_str(source, context! {});
    }
    let value = environment
        .compile_expression(source.trim())?
        .eval(context! {})?;
    if value.is_undefined() || value.is_none() {
        return Err(Error::new(
            ErrorKind::UndefinedError,
            format!("`{}` has no value", source.trim()),
        ));
    }
    Ok(value.to_string())
}

/// An error with its causes.
fn said(error: &Error) -> String {
    let mut text = error.to_string();
    let mut source = std::error::Error::source(error);
    while let Some(cause) = source {
        text.push_str(": ");
        text.push_str(&cause.to_string());
        source = cause.source();
    }
    text
}

fn environment(store: &Arc<Store>) -> Environment<'static> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(minijinja::UndefinedBehavior::Strict);
    // A block's tag takes no line of its own.
    let syntax = SyntaxConfig::builder()
        .trim_blocks(true)
        .lstrip_blocks(true)
        .keep_trailing_newline(true)
        .build();
    debug_assert!(syntax.is_ok(), "the usual delimiters");
    environment.set_syntax(syntax.unwrap_or_default());
    let from = store.clone();
    environment.add_function("csv", move |path: &str| {
        let table = from.table(path).map_err(lost)?;
        Ok::<_, Error>(Value::from(Serde(table.rows)))
    });
    let from = store.clone();
    environment.add_function("json", move |path: &str| {
        from.json(path)
            .map(|json| Value::from(Serde(json)))
            .map_err(lost)
    });
    let from = store.clone();
    environment.add_function("record", move |name: &str| {
        let manifest = from.manifest(name).map_err(lost)?;
        let mut value = serde_json::to_value(&manifest).map_err(lost)?;
        value["id"] = Json::from(manifest.id());
        Ok::<_, Error>(Value::from(Serde(value)))
    });
    environment.add_filter("where", matching);
    environment.add_filter("one", one);
    environment.add_filter("fixed", |x: f64, digits: usize| format!("{x:.digits$}"));
    environment.add_filter("sig", significant);
    environment.add_filter("thousands", thousands);
    environment.add_filter("percent", |x: f64, digits: usize| {
        format!("{:.digits$}", 100.0 * x)
    });
    environment
}

fn lost(error: impl std::fmt::Display) -> Error {
    Error::new(ErrorKind::InvalidOperation, error.to_string())
}

/// Rows whose cells equal all that are named.
#[allow(
    clippy::needless_pass_by_value,
    reason = "the signature is minijinja's"
)]
fn matching(rows: Value, cells: Kwargs) -> Result<Vec<Value>, Error> {
    let names: Vec<&str> = cells.args().collect();
    let mut wanted = Vec::new();
    for name in names {
        wanted.push((name.replace("__", "."), cells.get::<Value>(name)?));
    }
    let mut found = Vec::new();
    for row in rows.try_iter()? {
        let mut fits = true;
        for (name, value) in &wanted {
            fits &= row.get_attr(name)? == *value;
        }
        if fits {
            found.push(row);
        }
    }
    Ok(found)
}

fn one(rows: Value, cells: Kwargs) -> Result<Value, Error> {
    let mut found = matching(rows, cells)?;
    match (found.pop(), found.len()) {
        (Some(row), 0) => Ok(row),
        (None, _) => Err(lost("no row has these cells")),
        (Some(_), others) => Err(lost(format!("{} rows have these cells", others + 1))),
    }
}

/// So many digits that count, without an exponent.
fn significant(x: f64, digits: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return x.to_string();
    }
    let magnitude = x.abs().log10().floor() as i64;
    let behind = digits as i64 - 1 - magnitude;
    let text = format!("{x:.*}", usize::try_from(behind).unwrap_or(0));
    // 9.996 to three digits is 10.00: one digit too many behind the point.
    let rounded: f64 = text.parse().unwrap_or(x);
    if rounded.abs().log10().floor() as i64 > magnitude && behind > 0 {
        return format!("{x:.*}", usize::try_from(behind - 1).unwrap_or(0));
    }
    text
}

fn thousands(x: f64, _: Rest<Value>) -> String {
    let digits = format!("{:.0}", x.abs());
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    if x < 0.0 { format!("-{text}") } else { text }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::super::{FILE, Manifest};
    use super::*;

    fn store() -> (tempfile::TempDir, Arc<Store>) {
        let root = tempfile::tempdir().unwrap();
        let record = root.path().join("box/kernels");
        std::fs::create_dir_all(&record).unwrap();
        std::fs::write(
            record.join("t.csv"),
            "tier,k,us.mean\nscalar,18,300.94\navx2,18,62.13\n",
        )
        .unwrap();
        let manifest =
            Manifest::describe(&record, "kernels", "sdop bench".to_owned(), &[]).unwrap();
        std::fs::write(record.join(FILE), manifest.text()).unwrap();
        let store = Arc::new(Store::new(root.path()));
        (root, store)
    }

    #[test]
    fn a_marker_gives_what_its_record_holds_and_the_rest_stays() {
        let (_root, store) = store();
        let page = "a 1\n<!--: t = csv(\"box/kernels/t.csv\") -->\n\
                    <!--= (t | one(tier=\"avx2\"))[\"us.mean\"] | fixed(1) -->99.9<!--/--> µs, 2\n";
        let rendered = render("page.md", page, &store).unwrap();
        assert_eq!(rendered, page.replace("99.9", "62.1"));
        assert_eq!(render("page.md", &rendered, &store).unwrap(), rendered);
        assert_eq!(store.used().len(), 1);
    }

    #[test]
    fn a_template_makes_a_table() {
        let (_root, store) = store();
        let page = "<!--=\n{% for row in csv(\"box/kernels/t.csv\") %}\n| {{ row.tier }} | {{ row[\"us.mean\"] | sig(3) }} |\n\
                    {% endfor %}\n--><!--/-->";
        let rendered = render("page.md", page, &store).unwrap();
        assert!(
            rendered.ends_with("| scalar | 301 |\n| avx2 | 62.1 |\n<!--/-->"),
            "{rendered}"
        );
    }

    #[test]
    fn what_has_no_value_is_an_error_with_its_line() {
        let (_root, store) = store();
        for (marker, said) in [
            (
                "<!--= (csv(\"box/kernels/t.csv\") | one(tier=\"neon\")).k -->1<!--/-->",
                "no row",
            ),
            ("<!--= csv(\"box/none/t.csv\") -->1<!--/-->", "record.json"),
            ("<!--= 1 -->1", "without `<!--/-->`"),
            ("<!--= 1", "without `-->`"),
            ("<!--= nothing -->1<!--/-->", "undefined"),
        ] {
            let error = render("page.md", &format!("x\n\n{marker}"), &store)
                .unwrap_err()
                .to_string();
            assert!(
                error.starts_with("page.md:3: ") && error.contains(said),
                "{error}"
            );
        }
    }

    #[test]
    fn digits_that_count() {
        for (x, digits, text) in [
            (9.996, 3, "10.0"),
            (0.012_349, 3, "0.0123"),
            (1441.0, 3, "1441"),
            (2.16, 3, "2.16"),
            (0.0, 3, "0"),
        ] {
            assert_eq!(significant(x, digits), text);
        }
        assert_eq!(thousands(1_234_567.0, Rest(vec![])), "1,234,567");
        assert_eq!(thousands(-999.0, Rest(vec![])), "-999");
    }
}
