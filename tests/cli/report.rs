//! Records, their comparison and the pages that quote them: a digit changed by hand is found
//! everywhere.

use std::path::Path;

use sdop_bench::report::{Experiment, Store};

use super::{command, sdop, stdout, text};

const PAGE: &str = "# Page\n<!-- BEGIN frame -->\nA frame takes 1.5 ms.\n<!-- END frame -->\n";

const BLOCK: &str =
    "A frame takes {{ (csv(\"box/times/times.csv\") | one(scene=\"a\")).ms | fixed(1) }} ms.\n";

/// A repository with one page and two records of one experiment.
fn repository() -> tempfile::TempDir {
    let root = tempfile::tempdir().unwrap();
    for (machine, ms) in [("box", "1.5,1.4,1.6"), ("other", "3.1,3.0,3.2")] {
        let record = root.path().join("data/record").join(machine).join("times");
        std::fs::create_dir_all(&record).unwrap();
        std::fs::write(
            record.join("times.csv"),
            format!("scene,bodies,hits,ms,ms_low,ms_high\na,500,7,{ms}\n"),
        )
        .unwrap();
        adopt(root.path(), "times", machine);
    }
    std::fs::write(root.path().join("README.md"), PAGE).unwrap();
    template(root.path(), "frame.md", BLOCK);
    root
}

fn template(root: &Path, name: &str, text: &str) {
    let path = root.join("paper/templates").join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

/// Exit code and output of `sdop report --check`.
fn check(root: &Path) -> (Option<i32>, String) {
    let output = sdop(&["report", "--check", "--root", text(root)]);
    (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
}

fn edit(path: &Path, from: &str, to: &str) {
    let before = std::fs::read_to_string(path).unwrap();
    assert!(before.contains(from));
    std::fs::write(path, before.replacen(from, to, 1)).unwrap();
}

/// Describes the files of an experiment that are there already.
fn adopt(root: &Path, experiment: &str, machine: &str) {
    let adopt = ["record", experiment, "--adopt", "--name", machine];
    let adopted = command(&adopt).current_dir(root).output().unwrap();
    let said = String::from_utf8_lossy(&adopted.stderr);
    assert!(adopted.status.success(), "{said}");
}

/// Pages that agree with whole records pass.
#[test]
fn consistent_pages_pass() {
    let root = repository();
    let (code, said) = check(root.path());
    assert_eq!(code, Some(0), "{said}");
}

/// A digit changed in a page is found and rendered again.
#[test]
fn changed_page_digit_is_found() {
    let root = repository();
    let page = root.path().join("README.md");
    edit(&page, "1.5", "1.4");
    let (code, said) = check(root.path());
    assert_eq!(code, Some(1));
    assert!(said.contains("README.md:3"), "{said}");
    let rendered = sdop(&["report", "--root", text(root.path())]);
    assert_eq!(rendered.status.code(), Some(0));
    assert_eq!(std::fs::read_to_string(&page).unwrap(), PAGE);
}

/// A digit changed in a record or its manifest is found.
#[test]
fn changed_record_digit_is_found() {
    let root = repository();
    let record = root.path().join("data/record/other/times");
    edit(&record.join("times.csv"), "3.1", "3.0");
    let (code, said) = check(root.path());
    assert_eq!(code, Some(1));
    assert!(said.contains("changed since it was recorded"), "{said}");
    let root = repository();
    let manifest = root.path().join("data/record/other/times/record.json");
    edit(&manifest, "\"version\": 1", "\"version\":  1");
    assert_eq!(check(root.path()).0, Some(0), "spacing is no content");
    edit(&manifest, "\"experiment\": \"times\"", "\"experiment\": \"rimes\"");
    assert_eq!(check(root.path()).0, Some(1));
}

/// A whole page is what its template gives.
#[test]
fn whole_page_follows_its_template() {
    let root = repository();
    template(root.path(), "pages/paper/report.typ", &format!("= Report\n{BLOCK}"));
    assert_eq!(check(root.path()).0, Some(1), "it isn't made yet");
    sdop(&["report", "--root", text(root.path())]);
    let page = root.path().join("paper/report.typ");
    let made = std::fs::read_to_string(&page).unwrap();
    assert_eq!(made, "= Report\nA frame takes 1.5 ms.\n");
    assert_eq!(check(root.path()).0, Some(0));
    edit(&page, "1.5", "1.6");
    let (code, said) = check(root.path());
    assert_eq!(code, Some(1));
    assert!(said.contains("report.typ:2"), "{said}");
}

/// Two pages that give one number differently are found.
#[test]
fn inconsistent_numbers_are_found() {
    let root = repository();
    let page = |digits: usize| {
        format!(
            "It is {{{{ ((csv(\"box/times/times.csv\") | one(scene=\"a\")).ms / 7) | fixed({digits}) }}}}.\n"
        )
    };
    for name in ["pages/paper/machines.md", "pages/paper/many-ranks.md"] {
        template(root.path(), name, &page(2));
    }
    let rendered = sdop(&["report", "--quantities", "--root", text(root.path())]);
    let said = String::from_utf8_lossy(&rendered.stdout).into_owned();
    assert_eq!(rendered.status.code(), Some(0), "{said}");
    assert!(said.contains("0.21") && said.contains("paper/many-ranks.md"), "{said}");
    template(root.path(), "pages/paper/many-ranks.md", &page(1));
    sdop(&["report", "--root", text(root.path())]);
    let (code, said) = check(root.path());
    assert_eq!(code, Some(1));
    assert!(said.contains("two ways to give one number"), "{said}");
}

/// The figure and its part of a page appear with the record.
#[test]
fn figure_is_drawn_from_table() {
    let root = repository();
    let path = |name: &str| root.path().join(name);
    std::fs::write(path("data/record/quoted.toml"), "machine = \"box\"\n").unwrap();
    let part = "{% if is_recorded(\"kernels/far/far.csv\") %}far{% else %}near{% endif %}\n";
    template(root.path(), "pages/PAGE.md", part);
    let page = |expected: &str| {
        let rendered = sdop(&["report", "--root", text(root.path())]);
        let said = String::from_utf8_lossy(&rendered.stderr);
        assert_eq!(rendered.status.code(), Some(0), "{said}");
        assert_eq!(std::fs::read_to_string(path("PAGE.md")).unwrap(), expected);
    };
    page("near");
    let record = path("data/record/box/kernels/far");
    std::fs::create_dir_all(&record).unwrap();
    let table = "series,distance,pairs,lost,extra,ns_per_body\n\"f32\",0e0,900,0,0,80.5\n\
        \"f32\",1e7,700,300,100,70.0\n\"f64\",0e0,900,0,0,90.5\n\"f64\",1e11,901,0,1,91.0\n";
    std::fs::write(record.join("far.csv"), table).unwrap();
    adopt(root.path(), "kernels/far", "box");
    page("far");
    let figure = path("paper/figures/far.svg");
    let svg = std::fs::read_to_string(&figure).unwrap();
    for word in ["f32", "f64", "1e11", "ns per body"] {
        assert!(svg.contains(word), "{word}: {svg}");
    }
    assert_eq!(check(root.path()).0, Some(0));
    edit(&figure, "ns per body", "ms per body");
    let (code, said) = check(root.path());
    assert_eq!(code, Some(1));
    assert!(said.contains("paper/figures/far.svg"), "{said}");
}

/// Runs git in a separate repository.
fn git(root: &Path, arguments: &[&str]) {
    let status = std::process::Command::new("git")
        .current_dir(root)
        .args(["-c", "user.name=a", "-c", "user.email=a@example.org"])
        .args(arguments)
        .stdout(std::process::Stdio::null())
        .status();
    assert!(status.unwrap().success(), "git {arguments:?}");
}

/// A record older than the code must be called so.
#[test]
fn old_record_must_be_named() {
    let root = tempfile::tempdir().unwrap();
    let record = root.path().join("data/record/box/times");
    std::fs::create_dir_all(&record).unwrap();
    std::fs::create_dir_all(root.path().join("src")).unwrap();
    std::fs::write(root.path().join("src/lib.rs"), "// 1\n").unwrap();
    std::fs::write(record.join("times.csv"), "scene,ms\na,1.5\n").unwrap();
    git(root.path(), &["init", "-q"]);
    git(root.path(), &["add", "."]);
    git(root.path(), &["commit", "-q", "-m", "code"]);
    adopt(root.path(), "times", "box");
    std::fs::write(root.path().join("README.md"), PAGE).unwrap();
    template(root.path(), "frame.md", BLOCK);
    let (code, said) = check(root.path());
    assert_eq!(code, Some(0), "{said}");
    std::fs::write(root.path().join("src/lib.rs"), "// 2\n").unwrap();
    git(root.path(), &["commit", "-q", "-a", "-m", "other code"]);
    let (code, said) = check(root.path());
    assert_eq!(code, Some(1));
    assert!(said.contains("older than the code"), "{said}");
    let named = format!("{BLOCK}Commit {{{{ record(\"box/times\").code.commit[:7] }}}}.\n");
    template(root.path(), "frame.md", &named);
    sdop(&["report", "--root", text(root.path())]);
    let (code, said) = check(root.path());
    assert_eq!(code, Some(0), "{said}");
}

/// A scene on which a comparison takes a moment.
const SCENE: &str = r#"
name = "small"
frames = 5
[box]
side = 5.0
[[bodies]]
shape = "l-shape"
count = 12
radius = [0.5, 1.0]
speed = [0.5, 2.0]
[effects]
motion = true
"#;

#[test]
fn fresh_results_make_their_pages() {
    let root = tempfile::tempdir().unwrap();
    let root = root.path();
    let scene = root.join("small.toml");
    std::fs::write(&scene, SCENE).unwrap();
    let records = root.join("data/record/box");
    let [reproduced, compared] = ["reproduce", "tradeoff"].map(|name| records.join(name));
    let cache = root.join("cache");
    for arguments in [
        &["reproduce", "--seeds", "2", "--frames", "3", "--out", text(&reproduced)][..],
        &[
            "tradeoff",
            text(&scene),
            "--frames",
            "2",
            "--cache",
            text(&cache),
            "--out",
            text(&compared),
        ],
    ] {
        let output = sdop(&[arguments, &["--quick"]].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
    }
    std::fs::write(root.join("data/record/quoted.toml"), "machine = \"box\"\n").unwrap();
    git(root, &["init", "-q"]);
    git(root, &["add", "data"]);
    git(root, &["commit", "-q", "-m", "records"]);
    adopt(root, "reproduce", "box");
    adopt(root, "tradeoff", "box");
    let own = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../paper"));
    for name in [
        "templates/pages/paper/summary.md",
        "templates/pages/paper/tradeoff.md",
        "quantities.jinja",
    ] {
        let to = root.join("paper").join(name);
        std::fs::create_dir_all(to.parent().unwrap()).unwrap();
        std::fs::copy(own.join(name), to).unwrap();
    }
    let made = sdop(&["report", "--root", text(root)]);
    let said = String::from_utf8_lossy(&made.stderr);
    assert_eq!(made.status.code(), Some(0), "{said}");
    for (page, last) in [("summary.md", "## References"), ("tradeoff.md", "## The price of safety")]
    {
        let made = std::fs::read_to_string(root.join("paper").join(page)).unwrap();
        assert!(made.contains(last), "{page}");
        assert!(!made.contains("NaN"), "{page}");
    }
    // Figures are drawn from the records' numbers: here by the program that has just drawn them.
    for (record, name) in
        [(&reproduced, "costs.svg"), (&reproduced, "useful_tests.svg"), (&compared, "tradeoff.svg")]
    {
        let own = std::fs::read_to_string(record.join("figures").join(name)).unwrap();
        let drawn = std::fs::read_to_string(root.join("paper/figures").join(name)).unwrap();
        assert_eq!(own, drawn, "{name}");
    }
    assert_eq!(check(root).0, Some(0));
    edit(&root.join("paper/figures/costs.svg"), "Nu·Cu", "Nu·Cv");
    let (code, said) = check(root);
    assert_eq!(code, Some(1));
    assert!(said.contains("paper/figures/costs.svg"), "{said}");
}

/// Two records compare by counts and by intervals.
#[test]
fn records_compare_counts_and_intervals() {
    let root = repository();
    let records = root.path().join("data/record");
    let [first, second] = ["box/times", "other/times"].map(|name| records.join(name));
    let arguments = ["cmp", text(&first), text(&second)];
    let slower = sdop(&arguments);
    assert_eq!(slower.status.code(), Some(0), "counts are equal");
    let said = String::from_utf8_lossy(&slower.stdout).into_owned();
    assert!(said.contains("2.067") && said.contains("slower"), "{said}");
    let limit = sdop(&[&arguments[..], &["--fail-slower", "50"]].concat());
    assert_eq!(limit.status.code(), Some(1));
    let none = sdop(&["cmp", text(&first), text(root.path())]);
    assert_eq!(none.status.code(), Some(2));
}

/// A record compares with what a commit had.
#[test]
fn record_compares_with_a_commit() {
    let root = repository();
    git(root.path(), &["init", "-q"]);
    git(root.path(), &["add", "."]);
    git(root.path(), &["commit", "-q", "-m", "records"]);
    let table = root.path().join("data/record/box/times/times.csv");
    edit(&table, ",7,", ",8,");
    adopt(root.path(), "times", "box");
    let compared = |first| {
        let arguments = ["cmp", first, "data/record/box/times"];
        command(&arguments).current_dir(root.path()).output().unwrap()
    };
    let output = compared("HEAD:data/record/box/times");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("DIFFERS times.csv: a, bodies 500, hits: 7 and 8"), "{said}");
    assert_eq!(compared("HEAD:data/record/box/rimes").status.code(), Some(2));
}

/// Every record of the repository names its command.
#[test]
fn every_record_names_its_command() {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let store = Store::new(root.join("data/record")).unwrap();
    for name in store.names() {
        let manifest = store.manifest(&name).unwrap();
        let known = Experiment::named(&manifest.experiment).is_some();
        let script = manifest.command.starts_with(".ci/full ");
        assert!(known || script, "{name}: {}", manifest.command);
        assert!(!manifest.command.is_empty(), "{name}");
    }
}

/// The repository's own records and pages agree.
#[test]
fn own_records_and_pages_agree() {
    let (code, said) = check(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")));
    assert_eq!(code, Some(0), "{said}");
}

/// A record names the level that ran.
#[test]
fn record_names_the_tier() {
    let place = tempfile::tempdir().unwrap();
    let out = ["record", "--name", "here", "--out", text(place.path())];
    let record = |arguments: &[&str]| sdop(&[&out, arguments].concat());
    let short = ["--quick", "--seeds", "1", "--frames", "2"];
    let run = record(&[&["reproduce", "--simd", "scalar", "--"][..], &short].concat());
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    for file in ["results.json", "record.json"] {
        let read = std::fs::read(place.path().join("here/reproduce").join(file)).unwrap();
        let read: serde_json::Value = serde_json::from_slice(&read).unwrap();
        assert_eq!(read["machine"]["simd"], "scalar", "{file}");
        let expected = "sdop record reproduce --simd scalar -- --quick --seeds 1 --frames 2";
        assert_eq!(read["command"], expected, "{file}");
    }

    // What chooses its own levels takes none, and none is slipped past the record.
    let wrong = [
        (&["kernels/tiers", "--simd", "scalar"][..], "chooses its SIMD levels"),
        (&["reproduce", "--", "--simd", "scalar"], "--simd after the --"),
    ];
    for (arguments, told) in wrong {
        let run = record(arguments);
        assert_eq!(run.status.code(), Some(2));
        let error = String::from_utf8_lossy(&run.stderr);
        assert!(error.contains(told), "{error}");
    }
}

/// Without a name the experiments are listed; outside of a checkout, what is missing is named.
#[test]
fn records_say_what_they_need() {
    let list = stdout(&["record"]);
    let head = list.lines().find(|line| line.contains("experiment"));
    assert!(head.is_some_and(|line| line.contains("takes") && line.contains("needs")), "{list}");
    assert!(list.contains("valgrind"), "{list}");
    let elsewhere = tempfile::tempdir().unwrap();
    let output = command(&["record", "reproduce", "--name", "here"])
        .current_dir(elsewhere.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    for words in ["needs data/scenes/paper-50.toml", "root of a checkout"] {
        assert!(said.contains(words), "{said}");
    }
}
