#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use super::super::{FILE, Manifest};
use super::*;

const TIMES: &str =
    "{% for row in csv(\"box/kernels/t.csv\") %}\n- {{ q.us(row) }}\n{% endfor %}\n";

fn sources() -> (tempfile::TempDir, PageSources) {
    let root = tempfile::tempdir().unwrap();
    let record = root.path().join("box/kernels");
    std::fs::create_dir_all(&record).unwrap();
    std::fs::write(record.join("t.csv"), "tier,k,us.mean\nscalar,18,300.94\navx2,18,62.13\n")
        .unwrap();
    let manifest = Manifest::describe(&record, "kernels", "sdop bench".to_owned(), &[]).unwrap();
    std::fs::write(record.join(FILE), manifest.text()).unwrap();
    let sources = PageSources {
        store: Arc::new(Store::new(root.path()).unwrap()),
        macros: "{% macro us(row) %}{{ row.us.mean | fixed(1) }} µs{% endmacro %}".to_owned(),
        templates: BTreeMap::from([("times".to_owned(), TIMES.to_owned())]),
        quantities: Arc::default(),
    };
    (root, sources)
}

#[test]
fn templates_give_pages() {
    let (_root, sources) = sources();
    let template = "a 1\n{% set t = csv(\"box/kernels/t.csv\") %}\n\
                    It is {{ (t | one(tier=\"avx2\")).us.mean | fixed(1) }} µs, {{ q.us(t[0]) }}\n\
                    {% for row in t %}\n| {{ row.tier }} | {{ row.us.mean | sig(3) }} |\n{% endfor %}\n";
    let page = whole("page.typ", template, &sources).unwrap();
    assert_eq!(page, "a 1\nIt is 62.1 µs, 300.9 µs\n| scalar | 301 |\n| avx2 | 62.1 |\n");
    assert_eq!(sources.store.used().len(), 1);
}

/// Two roundings of one number are noticed.
#[test]
fn two_roundings_are_detected() {
    let (_root, sources) = sources();
    let number = "(csv(\"box/kernels/t.csv\") | one(tier=\"scalar\")).us.mean / 7";
    for (page, digits) in [("a.md", 1), ("b.md", 2)] {
        let template = format!("x {{{{ ({number}) | fixed({digits}) }}}}");
        whole(page, &template, &sources).unwrap();
    }
    assert_eq!(sources.quantities.given_differently().len(), 1);
}

#[test]
fn blocks_are_rendered_from_templates() {
    let (_root, sources) = sources();
    let page = |between: &str| format!("a\n<!-- BEGIN times -->\n{between}<!-- END times -->\nb\n");
    let whole = page("- 300.9 µs\n- 62.1 µs\n");
    for between in ["", "old\n\nlines\n", "- 300.9 µs\n- 62.1 µs\n"] {
        assert_eq!(blocks("page.md", &page(between), &sources).unwrap(), whole);
    }
    for (text, problem) in [
        ("x\n<!-- BEGIN nothing -->\n<!-- END nothing -->", "no template"),
        ("x\n<!-- BEGIN times/us -->\n", "no line `<!-- us -->`"),
        ("x\n<!-- BEGIN times -->\n", "without `END times`"),
        (
            "x\n<!-- BEGIN times -->\n<!-- BEGIN times -->\n<!-- END times -->",
            "without `END times`",
        ),
    ] {
        let error = blocks("page.md", text, &sources).unwrap_err().to_string();
        assert!(error.starts_with("page.md:2: ") && error.contains(problem), "{error}");
    }
}

/// The parts of a template share what is set above them.
#[test]
fn parts_of_a_template_are_separate_blocks() {
    let (_root, mut sources) = sources();
    let template =
        format!("{{% set k = 18 %}}\n<!-- k -->\nk = {{{{ k }}}}\n\n<!-- us -->\n{TIMES}");
    sources.templates.insert("far/times".to_owned(), template);
    let block = |part: &str, text: &str| {
        format!("a\n<!-- BEGIN far/times/{part} -->\n{text}<!-- END far/times/{part} -->\n")
    };
    let page = |k: &str, us: &str| block("us", us) + &block("k", k);
    let rendered = blocks("page.md", &page("", "- 1 µs\n"), &sources).unwrap();
    assert_eq!(rendered, page("k = 18\n", "- 300.9 µs\n- 62.1 µs\n"));
    assert!(blocks("page.md", &block("k", ""), &sources).is_err(), "a block is missing");
}

#[test]
fn a_missing_value_names_its_line() {
    let (_root, sources) = sources();
    for (expression, problem) in [
        ("(csv(\"box/kernels/t.csv\") | one(tier=\"neon\")).k", "no row"),
        ("csv(\"box/none/t.csv\")", "record.json"),
        ("nothing", "undefined"),
        ("none", "no value"),
    ] {
        let template = format!("x\n\n{{{{ {expression} }}}}");
        let error = whole("page.md", &template, &sources).unwrap_err().to_string();
        assert!(error.starts_with("pages/page.md:3: ") && error.contains(problem), "{error}");
    }
}
