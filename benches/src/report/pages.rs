//! Pages whose numbers come from records: text between markers is rendered, the rest is the author's.
//!
//! A marker is a comment, so that a page reads the same with and without it: `<!--= EXPRESSION -->3.14<!--/-->` in Markdown,
//! `/*= EXPRESSION */3.14/**/` in Typst. What stands in the first comment is an expression, or a template with `{{ … }}` and `{% … %}`
//! (the syntax is Jinja's), and what stands behind it up to the closing one is what it gives. `{% set … %}` of one marker is not seen by
//! the next: `<!--: NAME = EXPRESSION -->` names a value for the rest of the page. Macros that pages share are in one file, `q` in
//! expressions.
//!
//! A page that people read as source carries whole blocks instead, between `<!-- BEGIN NAME -->` and `<!-- END NAME -->`, each on a
//! line of its own. What stands between them is what the template `paper/templates/NAME.md` gives.
//!
//! | function or filter | gives |
//! |---|---|
//! | `csv("experiment/file.csv")` | rows, objects of cells; a column `a.b` is `row.a.b` |
//! | `md("experiment/file.md", n)` | the same of the table that comes n-th in a Markdown file, from 0 |
//! | `json("experiment/file.json")`, `text(…)` | the value; the file as it is |
//! | `record("experiment")`, `records(…)` | the manifest, with `id` and `place`; every machine's |
//! | `rows \| where(column=value, …)`, `rows \| one(column=value, …)` | the rows with these cells; the only one, or an error |
//! | `x \| fixed(2)`, `x \| sig(3)`, `n \| thousands`, `x \| percent(1)` | digits behind the point; digits that count; 12,345; 12.3 |
//!
//! `experiment` is that of the machine that `data/record/quoted.toml` names, `machine/experiment` that of any.

use std::collections::BTreeMap;
use std::sync::Arc;

use miette::Diagnostic;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Kwargs, Serde};
use minijinja::{Environment, Error, ErrorKind, Value, context};
use serde_json::Value as Json;

use super::digits::{Quantities, markdown_table, significant, thousands};
use super::store::Store;

/// The comments of a kind of page.
struct Markers {
    open: &'static str,
    name: &'static str,
    shut: &'static str,
    end: &'static str,
}

const MARKDOWN: Markers = Markers {
    open: "<!--=",
    name: "<!--:",
    shut: "-->",
    end: "<!--/-->",
};
const TYPST: Markers = Markers {
    open: "/*=",
    name: "/*:",
    shut: "*/",
    end: "/**/",
};

/// What every page of a repository is rendered from.
#[derive(Clone, Debug)]
pub struct Sources {
    /// The records.
    pub store: Arc<Store>,
    /// Macros that pages share, a template.
    pub macros: String,
    /// The template of each block that a page may carry, by its name.
    pub templates: BTreeMap<String, String>,
    /// Where recorded numbers stand.
    pub quantities: Arc<Quantities>,
}

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
pub fn render(page: &str, text: &str, sources: &Sources) -> Result<String, PageError> {
    let typst = std::path::Path::new(page)
        .extension()
        .is_some_and(|ending| ending == "typ");
    let markers = if typst { TYPST } else { MARKDOWN };
    let mut environment = environment(page, sources).map_err(|error| PageError {
        page: "macros".to_owned(),
        line: error.line().unwrap_or(0),
        problem: said(&error),
    })?;
    let text = &blocks(page, text, &environment, &sources.templates)?;
    let mut out = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some((start, marker)) = markers.next(rest) {
        let line = 1 + text[..text.len() - rest.len() + start]
            .matches('\n')
            .count();
        let failed = |problem: String| PageError {
            page: page.to_owned(),
            line,
            problem,
        };
        let from = start + marker.len();
        let Markers {
            open, shut, end, ..
        } = markers;
        let length = rest[from..]
            .find(shut)
            .ok_or_else(|| failed(format!("`{marker}` without `{shut}`")))?;
        let (source, behind) = (&rest[from..from + length], from + length + shut.len());
        out.push_str(&rest[..behind]);
        rest = &rest[behind..];
        if marker == markers.name {
            set(&mut environment, source).map_err(|error| failed(said(&error)))?;
            continue;
        }
        let last = rest
            .find(end)
            .ok_or_else(|| failed(format!("`{open}` without `{end}`")))?;
        if markers.next(&rest[..last]).is_some() {
            return Err(failed(format!("`{open}` without `{end}` before the next")));
        }
        let value = evaluate(&environment, source).map_err(|error| failed(said(&error)))?;
        let begins_line = out[..out.len() - marker.len() - length - shut.len()].ends_with('\n');
        if !typst && begins_line && !value.starts_with('\n') {
            return Err(failed(
                "a comment that begins a line ends the paragraph above: begin the line with a word"
                    .to_owned(),
            ));
        }
        out.push_str(&value);
        out.push_str(end);
        rest = &rest[last + end.len()..];
    }
    out.push_str(rest);
    Ok(out)
}

/// The page with its blocks rendered.
fn blocks(
    page: &str,
    text: &str,
    environment: &Environment<'_>,
    templates: &BTreeMap<String, String>,
) -> Result<String, PageError> {
    let mut out = String::with_capacity(text.len());
    let mut lines = text.split_inclusive('\n').enumerate();
    while let Some((index, line)) = lines.next() {
        out.push_str(line);
        let Some(name) = marked(line, "BEGIN") else {
            continue;
        };
        let failed = |problem: String| PageError {
            page: page.to_owned(),
            line: index + 1,
            problem,
        };
        let template = templates
            .get(name)
            .ok_or_else(|| failed(format!("no template `paper/templates/{name}.md`")))?;
        let value = evaluate(environment, template).map_err(|error| failed(said(&error)))?;
        out.push_str(value.trim_matches('\n'));
        out.push('\n');
        let (_, end) = lines
            .find(|(_, line)| marked(line, "END") == Some(name) || marked(line, "BEGIN").is_some())
            .filter(|(_, line)| marked(line, "END").is_some())
            .ok_or_else(|| failed(format!("`BEGIN {name}` without `END {name}`")))?;
        out.push_str(end);
    }
    Ok(out)
}

/// The name in a line that is `<!-- WORD NAME -->`.
fn marked<'l>(line: &'l str, word: &str) -> Option<&'l str> {
    let inside = line.trim().strip_prefix("<!-- ")?.strip_suffix(" -->")?;
    inside.strip_prefix(word)?.strip_prefix(' ')
}

impl Markers {
    /// The next marker and which one it is.
    fn next(&self, text: &str) -> Option<(usize, &'static str)> {
        [self.open, self.name]
            .into_iter()
            .filter_map(|marker| Some((text.find(marker)?, marker)))
            .min()
    }
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

/// What an expression or a template gives, with the shared macros as `q`.
fn evaluate(environment: &Environment<'_>, source: &str) -> Result<String, Error> {
    // What a template begins with isn't the import's own line end.
    const IMPORT: &str = "{% import 'macros' as q %}{{ '' }}";
    if source.contains("{%") || source.contains("{{") {
        return environment.render_str(&format!("{IMPORT}{source}"), context! {});
    }
    let (source, none) = (source.trim(), "\u{0}");
    let text = environment.render_str(
        &format!("{IMPORT}{{% set x = {source} %}}{{{{ '{none}' if x is none else x }}}}"),
        context! {},
    )?;
    if text == none {
        return Err(Error::new(
            ErrorKind::UndefinedError,
            format!("`{source}` has no value"),
        ));
    }
    Ok(text)
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

fn environment<'s>(page: &str, sources: &'s Sources) -> Result<Environment<'s>, Error> {
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
    add_readers(&mut environment, &sources.store);
    environment.add_filter("where", matching);
    environment.add_filter("one", one);
    // Formats, each noted with its number.
    let format = |page: &str, text: fn(f64, usize) -> String| {
        let (page, quantities) = (page.to_owned(), sources.quantities.clone());
        move |x: f64, digits: Option<usize>| {
            let text = text(x, digits.unwrap_or(0));
            quantities.note(&page, x, &text);
            text
        }
    };
    environment.add_filter("fixed", format(page, |x, digits| format!("{x:.digits$}")));
    environment.add_filter("sig", format(page, significant));
    environment.add_filter("thousands", format(page, |x, _| thousands(x)));
    environment.add_filter(
        "percent",
        format(page, |x, digits| format!("{:.digits$}", 100.0 * x)),
    );
    environment.add_template("macros", &sources.macros)?;
    Ok(environment)
}

fn add_readers(environment: &mut Environment<'_>, store: &Arc<Store>) {
    let from = store.clone();
    environment.add_function("csv", move |path: &str| {
        let table = from.table(path).map_err(lost)?;
        let rows: Vec<Json> = table.rows.into_iter().map(nested).collect();
        Ok::<_, Error>(Value::from(Serde(rows)))
    });
    let from = store.clone();
    environment.add_function("md", move |path: &str, nth: Option<usize>| {
        let text = from.text(path).map_err(lost)?;
        let rows = markdown_table(&text, nth.unwrap_or(0));
        Ok::<_, Error>(Value::from(Serde(rows)))
    });
    let from = store.clone();
    environment.add_function("json", move |path: &str| {
        from.json(path)
            .map(|json| Value::from(Serde(json)))
            .map_err(lost)
    });
    let from = store.clone();
    environment.add_function("text", move |path: &str| from.text(path).map_err(lost));
    let from = store.clone();
    environment.add_function("record", move |name: &str| described(&from, name));
    let from = store.clone();
    environment.add_function("records", move |experiment: &str| {
        let names = from.names();
        let of = names.iter().filter(|name| {
            name.split_once('/')
                .is_some_and(|(_, own)| own == experiment)
        });
        of.map(|name| described(&from, name))
            .collect::<Result<Vec<_>, _>>()
    });
}

/// A manifest with its identifier and its place.
fn described(store: &Store, name: &str) -> Result<Value, Error> {
    let manifest = store.manifest(name).map_err(lost)?;
    let mut value = serde_json::to_value(&manifest).map_err(lost)?;
    value["id"] = Json::from(manifest.id());
    value["place"] = Json::from(store.place(name));
    Ok(Value::from(Serde(value)))
}

/// A row whose columns `a.b` are objects in objects.
fn nested(row: serde_json::Map<String, Json>) -> Json {
    let mut root = Json::Object(serde_json::Map::new());
    for (column, cell) in row {
        let mut place = &mut root;
        for part in column.split('.') {
            place = &mut place[part];
        }
        *place = cell;
    }
    root
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
        wanted.push((name, cells.get::<Value>(name)?));
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::super::{FILE, Manifest};
    use super::*;

    const TIMES: &str =
        "{% for row in csv(\"box/kernels/t.csv\") %}\n- {{ q.us(row) }}\n{% endfor %}\n";

    fn sources() -> (tempfile::TempDir, Sources) {
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
        let sources = Sources {
            store: Arc::new(Store::new(root.path()).unwrap()),
            macros: "{% macro us(row) %}{{ row.us.mean | fixed(1) }} µs{% endmacro %}".to_owned(),
            templates: BTreeMap::from([("times".to_owned(), TIMES.to_owned())]),
            quantities: Arc::default(),
        };
        (root, sources)
    }

    #[test]
    fn a_marker_gives_what_its_record_holds_and_the_rest_stays() {
        let (_root, sources) = sources();
        let page = "a 1\n<!--: t = csv(\"box/kernels/t.csv\") -->\n\
                    It is <!--= (t | one(tier=\"avx2\")).us.mean | fixed(1) -->99.9<!--/--> µs, 2\n";
        let rendered = render("page.md", page, &sources).unwrap();
        assert_eq!(rendered, page.replace("99.9", "62.1"));
        assert_eq!(render("page.md", &rendered, &sources).unwrap(), rendered);
        assert_eq!(sources.store.used().len(), 1);
    }

    #[test]
    fn typst_has_markers_of_its_own_and_macros_are_shared() {
        let (_root, sources) = sources();
        let page = "/*: t = csv(\"box/kernels/t.csv\") */\n= Time\n/*= q.us(t | one(tier=\"avx2\")) */0 µs/**/ a frame\n";
        let rendered = render("page.typ", page, &sources).unwrap();
        assert_eq!(rendered, page.replace("0 µs", "62.1 µs"));
    }

    #[test]
    fn two_roundings_of_one_number_are_noticed() {
        let (_root, sources) = sources();
        let number = "(csv(\"box/kernels/t.csv\") | one(tier=\"scalar\")).us.mean / 7";
        for (page, digits) in [("a.md", 1), ("b.md", 2)] {
            render(
                page,
                &format!("x <!--= ({number}) | fixed({digits}) --><!--/-->"),
                &sources,
            )
            .unwrap();
        }
        assert_eq!(sources.quantities.given_differently().len(), 1);
    }

    #[test]
    fn a_template_makes_a_table() {
        let (_root, sources) = sources();
        let page = "<!--=\n{% for row in csv(\"box/kernels/t.csv\") %}\n| {{ row.tier }} | {{ row.us.mean | sig(3) }} |\n\
                    {% endfor %}\n--><!--/-->";
        let rendered = render("page.md", page, &sources).unwrap();
        assert!(
            rendered.ends_with("| scalar | 301 |\n| avx2 | 62.1 |\n<!--/-->"),
            "{rendered}"
        );
    }

    #[test]
    fn blocks_are_rendered_from_templates() {
        let (_root, sources) = sources();
        let page =
            |between: &str| format!("a\n<!-- BEGIN times -->\n{between}<!-- END times -->\nb\n");
        let whole = page("- 300.9 µs\n- 62.1 µs\n");
        for between in ["", "old\n\nlines\n", "- 300.9 µs\n- 62.1 µs\n"] {
            assert_eq!(render("page.md", &page(between), &sources).unwrap(), whole);
        }
        for (text, problem) in [
            (
                "x\n<!-- BEGIN nothing -->\n<!-- END nothing -->",
                "no template",
            ),
            ("x\n<!-- BEGIN times -->\n", "without `END times`"),
            (
                "x\n<!-- BEGIN times -->\n<!-- BEGIN times -->\n<!-- END times -->",
                "without `END times`",
            ),
        ] {
            let error = render("page.md", text, &sources).unwrap_err().to_string();
            assert!(
                error.starts_with("page.md:2: ") && error.contains(problem),
                "{error}"
            );
        }
    }

    #[test]
    fn what_has_no_value_is_an_error_with_its_line() {
        let (_root, sources) = sources();
        for (marker, said) in [
            (
                "<!--= (csv(\"box/kernels/t.csv\") | one(tier=\"neon\")).k -->1<!--/-->",
                "no row",
            ),
            ("<!--= csv(\"box/none/t.csv\") -->1<!--/-->", "record.json"),
            ("<!--= 1 -->1", "without `<!--/-->`"),
            ("<!--= 1", "without `-->`"),
            ("<!--= nothing -->1<!--/-->", "undefined"),
            ("<!--= 1 -->1<!--/-->", "ends the paragraph"),
        ] {
            let error = render("page.md", &format!("x\n\n{marker}"), &sources)
                .unwrap_err()
                .to_string();
            assert!(
                error.starts_with("page.md:3: ") && error.contains(said),
                "{error}"
            );
        }
    }
}
