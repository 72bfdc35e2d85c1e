//! Records, their comparison and the pages that quote them: one digit changed by hand is found wherever it stands.

use std::path::Path;

use super::{command, sdop, text};

const PAGE: &str = "# Page\n\nA frame takes <!--= (csv(\"box/times/times.csv\") | one(scene=\"a\")).ms | fixed(1) -->1.5<!--/--> ms.\n";

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
        let adopted = command(&["record", "times", "--adopt", "--name", machine])
            .current_dir(root.path())
            .output()
            .unwrap();
        assert!(
            adopted.status.success(),
            "{}",
            String::from_utf8_lossy(&adopted.stderr)
        );
    }
    std::fs::write(root.path().join("README.md"), PAGE).unwrap();
    root
}

/// Exit code and output of `sdop report --check`.
fn check(root: &Path) -> (Option<i32>, String) {
    let output = sdop(&["report", "--check", "--root", text(root)]);
    (
        output.status.code(),
        String::from_utf8_lossy(&output.stdout).into_owned(),
    )
}

fn edit(path: &Path, from: &str, to: &str) {
    let before = std::fs::read_to_string(path).unwrap();
    assert!(before.contains(from));
    std::fs::write(path, before.replacen(from, to, 1)).unwrap();
}

#[test]
fn pages_that_agree_with_whole_records_pass() {
    let root = repository();
    let (code, said) = check(root.path());
    assert_eq!(code, Some(0), "{said}");
}

#[test]
fn a_digit_changed_in_a_page_is_found_and_rendered_again() {
    let root = repository();
    let page = root.path().join("README.md");
    edit(&page, "1.5<!--/-->", "1.4<!--/-->");
    let (code, said) = check(root.path());
    assert_eq!(code, Some(1));
    assert!(said.contains("README.md:3"), "{said}");
    let rendered = sdop(&["report", "--root", text(root.path())]);
    assert_eq!(rendered.status.code(), Some(0));
    assert_eq!(std::fs::read_to_string(&page).unwrap(), PAGE);
}

#[test]
fn a_digit_changed_in_a_record_or_its_manifest_is_found() {
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
    edit(
        &manifest,
        "\"experiment\": \"times\"",
        "\"experiment\": \"rimes\"",
    );
    assert_eq!(check(root.path()).0, Some(1));
}

#[test]
fn two_records_compare_by_counts_and_by_intervals() {
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

#[test]
fn the_repository_s_own_records_and_pages_agree() {
    let (code, said) = check(Path::new(env!("CARGO_MANIFEST_DIR")));
    assert_eq!(code, Some(0), "{said}");
}
