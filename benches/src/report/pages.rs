//! Pages whose numbers come from records.
//!
//! A page has rendered blocks between `<!-- BEGIN NAME -->` and `<!-- END NAME -->`, each on a
//! separate line, from the template `paper/templates/NAME.md`. The block `NAME/PART` is what that
//! template gives after the line `<!-- PART -->`. Paragraphs are wrapped ([`super::fill`]). The
//! report and a figure are rendered as a whole: `paper/templates/pages/FILE` becomes `FILE`.
//! Templates are in Jinja's language; they call the macros of a common file as `q`.
//!
//! | function or filter | gives |
//! |---|---|
//! | `csv("experiment/file.csv")` | rows, objects of cells; a column `a.b` is `row.a.b` |
//! | `md("experiment/file.md", n)` | the same for the n-th table of a Markdown file, counted from 0 |
//! | `json("experiment/file.json")`, `text(…)` | the value; the file as it is |
//! | `record("experiment")`, `records(…)` | the manifest, with `id` and `place`; the manifests of all machines |
//! | `rows \| where(column=value, …)`, `rows \| one(column=value, …)` | the rows with these cells; the only one, or an error |
//! | `x \| fixed(2)`, `x \| sig(3)`, `n \| thousands`, `x \| percent(1)` | digits after the point; digits that count; 12,345; 12.3 |
//! | `e \| interval(1e6)`, `x \| number`, `x \| signed(1)` | an estimate times 10⁶ as mean ± half-width; four digits that count; +1.2 |
//! | `lines \| cheapest(1e-6)` | the name of the cheapest of a density's variants if a check takes 1 µs, and those tied with it |
//! | `values \| in_order`, `x \| shortest` | an estimate from values in the order of time; the shortest text that reads back |
//!
//! `experiment` is the record of the machine that `data/record/quoted.toml` names,
//! `machine/experiment` that of any machine.

use std::collections::BTreeMap;
use std::sync::Arc;

use miette::miette;
use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Kwargs, Serde};
use minijinja::{Environment, Error, ErrorKind, Output, State, Value, context, escape_formatter};
use serde_json::Value as Json;

use super::digits::{self, Quantities, markdown_table, significant, thousands};
use super::fill::filled;
use super::store::Store;
use crate::measure::estimate::Estimate;
use crate::tradeoff::pays::{Line, choose};

/// Where templates of whole pages are, below the directory of templates.
pub const WHOLE: &str = "pages";

/// What every page of a repository is rendered from.
#[derive(Clone, Debug)]
pub struct PageSources {
    /// The records.
    pub store: Arc<Store>,
    /// Macros that pages share, a template.
    pub macros: String,
    /// The template of each block that a page may carry, by its name.
    pub templates: BTreeMap<String, String>,
    /// Where recorded numbers stand.
    pub quantities: Arc<Quantities>,
}

/// What is wrong with a page that can't be rendered.
fn flaw(page: &str, line: usize, problem: &str) -> miette::Report {
    let help = "`sdop report --help` says what a template may use";
    miette!(help = help, "{page}:{line}: {problem}")
}

/// A page as its records have it, from its own template.
///
/// # Errors
/// An expression that has no value, a record that was changed.
pub fn whole(page: &str, template: &str, sources: &PageSources) -> miette::Result<String> {
    let environment = environment(page, sources)?;
    evaluate(&environment, page, template)
        .map_err(|error| flaw(&format!("{WHOLE}/{page}"), error.line().unwrap_or(0), &said(&error)))
}

/// A page that people write, with its blocks as its records have them. Nothing outside of blocks
/// changes.
///
/// # Errors
/// A block without an end or a template, a part without a block, an expression that has no value,
/// a record that was changed.
pub fn blocks(page: &str, text: &str, sources: &PageSources) -> miette::Result<String> {
    let environment = environment(page, sources)?;
    let mut rendered = BTreeMap::new();
    let mut out = String::with_capacity(text.len());
    let mut lines = text.split_inclusive('\n').enumerate();
    while let Some((index, line)) = lines.next() {
        out.push_str(line);
        let Some(name) = marked(line, "BEGIN") else {
            continue;
        };
        let failed = |problem: String| flaw(page, index + 1, &problem);
        let (file, part) = name.rsplit_once('/').unwrap_or((name, ""));
        if !rendered.contains_key(file) {
            let none = || failed(format!("no template `paper/templates/{file}.md`"));
            let template = sources.templates.get(file).ok_or_else(none)?;
            let value = evaluate(&environment, file, template);
            rendered.insert(file, value.map_err(|error| failed(said(&error)))?);
        }
        let value = part_of(&rendered[file], part)
            .ok_or_else(|| failed(format!("no line `<!-- {part} -->` in its template")))?;
        out.push_str(&filled(&format!("{}\n", value.trim_matches('\n'))));
        let (_, end) = lines
            .find(|(_, line)| marked(line, "END") == Some(name) || marked(line, "BEGIN").is_some())
            .filter(|(_, line)| marked(line, "END").is_some())
            .ok_or_else(|| failed(format!("`BEGIN {name}` without `END {name}`")))?;
        out.push_str(end);
    }
    for (file, value) in &rendered {
        let parts = value.matches("<!-- ").count();
        let used = text.matches(&format!("<!-- BEGIN {file}/")).count();
        miette::ensure!(used == parts, "{page}: {used} blocks for the {parts} parts of {file}.md");
    }
    Ok(out)
}

/// What a rendered template has after the line of this part, up to the next part.
fn part_of<'t>(rendered: &'t str, part: &str) -> Option<&'t str> {
    let mark = if part.is_empty() { String::new() } else { format!("<!-- {part} -->\n") };
    rendered.split_once(&mark)?.1.split("<!-- ").next()
}

/// The name in a line that is `<!-- WORD NAME -->`.
fn marked<'l>(line: &'l str, word: &str) -> Option<&'l str> {
    let inside = line.trim().strip_prefix("<!-- ")?.strip_suffix(" -->")?;
    inside.strip_prefix(word)?.strip_prefix(' ')
}

/// What a template gives, with the shared macros as `q`.
fn evaluate(env: &Environment<'_>, name: &str, template: &str) -> Result<String, Error> {
    // The import is not on a separate line, so that errors have the template's line numbers.
    const IMPORT: &str = "{% import 'macros' as q %}{{ '' }}";
    env.render_named_str(name, &format!("{IMPORT}{template}"), context! {})
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

fn environment<'s>(page: &str, sources: &'s PageSources) -> miette::Result<Environment<'s>> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(minijinja::UndefinedBehavior::Strict);
    // A line that only has a block tag is removed.
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
    environment.add_filter("percent", format(page, |x, digits| format!("{:.digits$}", 100.0 * x)));
    environment.add_filter("interval", interval);
    environment.add_filter("in_order", in_order);
    environment.add_filter("cheapest", cheapest);
    environment.add_filter("number", digits::number);
    environment.add_filter("signed", |x: f64, digits: usize| format!("{x:+.digits$}"));
    environment.add_filter("shortest", |x: f64| x.to_string());
    let added = environment.add_template("macros", &sources.macros);
    added.map_err(|error| flaw("macros", error.line().unwrap_or(0), &said(&error)))?;
    environment.set_formatter(formatted);
    Ok(environment)
}

/// Writes a value into a page. A cell that a record leaves empty must be given a text by the
/// template.
fn formatted(out: &mut Output, state: &mut State, value: &Value) -> Result<(), Error> {
    if value.is_none() {
        return Err(lost("an expression has no value"));
    }
    escape_formatter(out, state, value)
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
        from.json(path).map(|json| Value::from(Serde(json))).map_err(lost)
    });
    let from = store.clone();
    environment.add_function("text", move |path: &str| from.text(path).map_err(lost));
    let from = store.clone();
    environment.add_function("record", move |name: &str| described(&from, name));
    let from = store.clone();
    environment.add_function("records", move |experiment: &str| {
        let names = from.names();
        let of = names
            .iter()
            .filter(|name| name.split_once('/').is_some_and(|(_, own)| own == experiment));
        of.map(|name| described(&from, name)).collect::<Result<Vec<_>, _>>()
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

/// An estimate from values in the order of time. As in JSON, one value alone has no half-width.
#[allow(clippy::needless_pass_by_value, reason = "the signature is minijinja's")]
fn in_order(values: Vec<f64>) -> Result<Value, Error> {
    let estimate = serde_json::to_value(Estimate::in_order(&values)).map_err(lost)?;
    Ok(Value::from(Serde(estimate)))
}

/// The choice among the variants of a density, if a check takes so many seconds.
fn cheapest(lines: Value, check: f64) -> Result<Value, Error> {
    let lines = serde_json::to_value(lines).and_then(serde_json::from_value::<Vec<Line>>);
    let lines = lines.map_err(lost)?;
    let choice = choose(&lines, check).ok_or_else(|| lost("no variants to choose from"))?;
    Ok(context! { name => choice.best, tied => choice.tied })
}

/// An estimate, scaled; one without a half-width is its mean alone.
#[allow(clippy::needless_pass_by_value, reason = "the signature is minijinja's")]
fn interval(estimate: Value, scale: Option<f64>) -> Result<String, Error> {
    let scale = scale.unwrap_or(1.0);
    let half_width = estimate.get_attr("half_width")?;
    Ok(digits::interval(&Estimate {
        mean: scale * f64::try_from(estimate.get_attr("mean")?)?,
        half_width: if half_width.is_none() {
            f64::INFINITY
        } else {
            scale * f64::try_from(half_width)?
        },
        seeds: 0,
    }))
}

/// Rows whose cells equal all that are named.
#[allow(clippy::needless_pass_by_value, reason = "the signature is minijinja's")]
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
mod tests;
