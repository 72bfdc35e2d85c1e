#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use super::super::FILE;
use super::*;
use crate::measure::conditions::Load;

fn record(counts: &str, times: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("counts.csv"), counts).unwrap();
    std::fs::write(directory.path().join("times.csv"), times).unwrap();
    let manifest =
        Manifest::describe(directory.path(), "test", String::new(), &["counts.csv".into()]);
    std::fs::write(directory.path().join(FILE), manifest.unwrap().text()).unwrap();
    directory
}

const COUNTS: &str = "scene,hits\na,10\nb,20\n";
const TIMES: &str =
    "scene,bodies,pairs,ms,ms_low,ms_high\na,500,7,1.0,0.9,1.1\nb,500,9,2.5,2.4,2.6\n";

#[test]
fn a_record_equals_itself() {
    let record = record(COUNTS, TIMES);
    let comparison = compare(record.path(), record.path()).unwrap();
    assert_eq!(comparison.equal, ["counts.csv", "times.csv"]);
    assert!(comparison.differences.is_empty() && comparison.changes.is_empty());
}

#[test]
fn a_count_that_differs_is_named() {
    let (a, b) = (record(COUNTS, TIMES), record(&COUNTS.replace("20", "21"), TIMES));
    let differences = compare(a.path(), b.path()).unwrap().differences;
    assert_eq!(differences.len(), 1);
    let CountDifference { row, column, second, .. } = &differences[0];
    assert_eq!((row.as_str(), column.as_deref(), second.as_str()), ("b", Some("hits"), "21"));
    let c = record(COUNTS, &TIMES.replace(",9,", ",8,"));
    let differences = compare(a.path(), c.path()).unwrap().differences;
    assert_eq!(differences[0].column.as_deref(), Some("pairs"));
}

#[test]
fn raw_samples_compare_over_their_seeds() {
    let times = |factor: f64| {
        let row = |seed| format!("a,{seed},{}\n", factor * (1.0 + 0.01 * f64::from(seed)));
        format!("scene,seed,ms\n{}", (1..=5).map(row).collect::<String>())
    };
    let (a, b) = (record(COUNTS, &times(1.0)), record(COUNTS, &times(2.0)));
    let changes = compare(a.path(), b.path()).unwrap().changes;
    assert_eq!(changes.len(), 1);
    assert_eq!(changes[0].row, "a, 5 seeds");
    assert!((changes[0].ratio - 2.0).abs() < 1e-12 && changes[0].same == Some(false));
}

/// Records with other flags say so, and their means are compared by intervals.
#[test]
fn other_flags_compare_means() {
    let with = |command: &str, pairs: &str| {
        let directory = record(&format!("scene,percent,half_width\na,{pairs},0.2\n"), TIMES);
        let mut manifest = Manifest::read(directory.path()).unwrap();
        manifest.command = command.to_owned();
        std::fs::write(directory.path().join(FILE), manifest.text()).unwrap();
        directory
    };
    let whole = with("sdop record test", "1.5");
    let again = with("cargo run --release -- test --out DIR", "1.6");
    let quick = with("sdop record test -- --quick", "1.6");
    let found = |b: &tempfile::TempDir| compare(whole.path(), b.path()).unwrap();
    assert_eq!((found(&again).settings.len(), found(&again).differences.len()), (0, 1));
    let quick = found(&quick);
    assert_eq!(quick.settings, ["flags: none and --quick"]);
    assert!(quick.differences.is_empty(), "{:?}", quick.differences);
}

/// Numbers by strategy, volume and term are those by variant and metric.
#[test]
fn older_rows_compare_with_newer_ones() {
    let older = "scene,strategy,regime,volume,term,unit,value,half_width\n\
                 a,sphere,warm,sphere,Nu,1,2.5,0.1\na,sphere,warm,,sum,s,1.5,0.1\n";
    let newer = "study,scene,variant,regime,metric,unit,value,half_width,n\n\
                 cost,a,sphere,warm,Nu (sphere),1,5,0.1,3\ncost,a,sphere,warm,sum,s,1.5,0.1,3\n";
    let comparison = compare(record(COUNTS, older).path(), record(COUNTS, newer).path()).unwrap();
    let found: Vec<f64> = comparison.changes.iter().map(|change| change.ratio).collect();
    assert_eq!(found, [2.0, 1.0]);
    assert!(comparison.differences.is_empty(), "{:?}", comparison.differences);
}

/// Another set of columns or rows is noted where nothing is promised.
#[test]
fn other_columns_or_rows_are_noted() {
    let other = TIMES
        .replace("ms_high", "ms_high,cold")
        .replace("1.1\n", "1.1,3\n")
        .replace("2.6\n", "2.6,4\n");
    let (a, b) = (record(COUNTS, TIMES), record(COUNTS, &other));
    let comparison = compare(a.path(), b.path()).unwrap();
    assert!(comparison.differences.is_empty() && !comparison.changes.is_empty());
    assert_eq!(comparison.notes.len(), 1);
    let fewer = TIMES.lines().take(2).collect::<Vec<_>>().join("\n");
    let c = record(COUNTS, &fewer);
    let comparison = compare(a.path(), c.path()).unwrap();
    assert!(comparison.differences.is_empty());
    assert!(
        comparison.notes[0].contains("1 rows compared; 1 rows only in the first"),
        "{:?}",
        comparison.notes
    );
}

/// A quick run has fewer rows: those that both have are compared, all others are one line.
#[test]
fn missing_rows_are_one_line() {
    let rows = |from: u32, to: u32| -> String {
        let row = |n: u32| format!("scene-{n},{n}\n");
        format!("scene,hits\n{}", (from..to).map(row).collect::<String>())
    };
    let (a, b) = (record(&rows(0, 3000), TIMES), record(&rows(0, 30), TIMES));
    let comparison = compare(a.path(), b.path()).unwrap();
    assert!(comparison.differences.is_empty(), "{:?}", comparison.differences);
    assert_eq!(
        comparison.notes,
        ["counts.csv: 30 rows compared; 2970 rows only in the first, 0 only in the second"]
    );
    let wrong = rows(0, 30).replace("scene-7,7", "scene-7,8");
    let comparison = compare(a.path(), record(&wrong, TIMES).path()).unwrap();
    assert_eq!(comparison.differences.len(), 1);
    // Nothing compared is nothing shown.
    let others = record(&rows(4000, 4003), TIMES);
    assert_eq!(compare(a.path(), others.path()).unwrap().differences.len(), 1);
}

#[test]
fn older_records_lack_no_counts() {
    let older = record(COUNTS, TIMES);
    std::fs::remove_file(older.path().join("counts.csv")).unwrap();
    let write = |deterministic: &[String]| {
        let manifest = Manifest::describe(older.path(), "test", String::new(), deterministic);
        std::fs::write(older.path().join(FILE), manifest.unwrap().text()).unwrap();
    };
    let newer = record(COUNTS, TIMES);
    write(&[]);
    let comparison = compare(older.path(), newer.path()).unwrap();
    assert!(comparison.differences.is_empty());
    assert_eq!(comparison.notes, ["counts.csv: no such file, the file"]);
    // One that counts other things does lack it.
    write(&["times.csv".to_owned()]);
    for [a, b] in [[&older, &newer], [&newer, &older]] {
        let comparison = compare(a.path(), b.path()).unwrap();
        assert_eq!(comparison.differences[0].file, "counts.csv");
    }
}

#[test]
fn the_control_is_ranked_last() {
    let times =
        |control: f64, s_dop: f64| format!("strategy,ms\nnone,{control}\ns-dop-batch,{s_dop}\n");
    let a = record(COUNTS, &times(0.001, 1.0));
    let b = record(COUNTS, &times(0.009, 1.5));
    let comparison = compare(a.path(), b.path()).unwrap();
    let rows: Vec<&str> = comparison.changes.iter().map(|c| c.row.as_str()).collect();
    assert_eq!(rows, ["s-dop-batch", "none"]);
}

#[test]
fn a_loaded_machine_is_warned_of() {
    let load = |one_minute: f64| Load { one_minute, five_minutes: 0.0 };
    let directory = record(COUNTS, TIMES);
    let mut manifest = Manifest::describe(directory.path(), "test", String::new(), &[]).unwrap();
    manifest.load = Some([load(0.1), load(1.2)]);
    assert_eq!(disturbed(&manifest), None);
    manifest.load = Some([load(0.1), load(3.5)]);
    let warning = disturbed(&manifest).unwrap();
    assert!(warning.contains("2.5 after"), "{warning}");
}

/// Times are ratios and same only where intervals meet.
#[test]
fn times_compare_by_intervals() {
    let slower = TIMES.replace("1.0,0.9,1.1", "1.1,1.0,1.2").replace("2.5,2.4,2.6", "5.0,4.8,5.2");
    let comparison = compare(record(COUNTS, TIMES).path(), record(COUNTS, &slower).path()).unwrap();
    let [b, a] = &comparison.changes[..] else { panic!("two changes") };
    assert_eq!((b.ratio, b.same), (2.0, Some(false)));
    assert_eq!(a.same, Some(true));
    assert_eq!(comparison.slowest(), 1.0);
    assert!(comparison.differences.is_empty());
}
