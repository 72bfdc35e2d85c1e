//! `sdop view` of hard cases and of the judge's cases, with the answers to them.

use serde_json::Value;

use crate::cli::view::{header, view};
use crate::cli::{refusal, stdout, text};

/// Hard cases are shown run by run.
#[test]
fn hard_cases_show_single_runs() {
    let directory = tempfile::tempdir().unwrap();
    let page = directory.path().join("case.html");
    let case = "data/hard_cases/contained.toml";
    view(&[case, "--run", "1", "--out", text(&page)]);
    let header = header(&page);
    assert_eq!((&header["scene"], &header["truth"]), (&"contained".into(), &true.into()));
    assert!(header["pairs"].as_u64().unwrap() > 0);
    assert!(
        header["messages"][1].as_str().unwrap().starts_with("Run 1 of "),
        "{}",
        header["messages"]
    );
    for (flags, said) in
        [(["--run", "100000"], "runs are counted from 0"), (["--seed", "4"], "has its own seed")]
    {
        let message = refusal(&[&["view", case], flags.as_slice()].concat());
        assert!(message.contains(said), "{message}");
    }
    let message = refusal(&["view", "data/scenes/paper-50.toml", "--run", "1"]);
    assert!(message.contains("--run is for groups of hard cases"), "{message}");
}

/// A case is shown with the answers to it.
#[test]
fn case_is_shown_with_answers() {
    let directory = tempfile::tempdir().unwrap();
    let cases = directory.path().join("cases");
    let name = "hard/contained/0000";
    stdout(&["cases", "--out", text(&cases), "--claims", "sphere", "--case", name]);
    let case = cases.join(format!("{name}.ndjson"));
    let page = directory.path().join("page.html");
    view(&[text(&case), "--out", text(&page)]);
    let unasked = header(&page);
    assert_eq!(unasked["runs"][0]["control"], true);
    assert_eq!(
        (&unasked["meet"], &unasked["layers"]),
        (&"bounding balls".into(), &serde_json::json!(["spheres"]))
    );
    assert!(unasked["messages"].to_string().contains("--answers FILE"), "{}", unasked["messages"]);

    let frames = unasked["frames"].as_u64().unwrap();
    let answers = directory.path().join("answers");
    let said: String =
        (0..frames).map(|frame| format!("{{\"frame\":{frame},\"pairs\":[]}}\n")).collect();
    std::fs::write(&answers, said).unwrap();
    view(&[text(&case), "--answers", text(&answers), "--out", text(&page)]);
    let asked = header(&page);
    assert_eq!(asked["runs"][0]["control"], false);
    assert!(asked["pairs"].as_u64().unwrap() > 0, "what meets is shown, and it is missed");

    for (said, why) in [
        ("{\"frame\":0,\"pairs\":[[1,0]]}\n", "larger"),
        ("{\"frame\":0,\"pairs\":[[0,77]]}\n", "77"),
        ("", "0 answers"),
        ("skip too hard\n", "skipped: too hard"),
        ("what?\n", "answers"),
    ] {
        std::fs::write(&answers, said).unwrap();
        let message =
            refusal(&["view", text(&case), "--answers", text(&answers), "--out", text(&page)]);
        assert!(message.contains(why), "{said}: {message}");
    }
    let scene = "data/scenes/paper-50.toml";
    let message = refusal(&["view", scene, "--answers", text(&answers)]);
    assert!(message.contains("--answers needs a case or record"), "{message}");
    let message = refusal(&["view", text(&case), "--strategy", "sphere"]);
    assert!(message.contains("its poses are given"), "{message}");
}

/// A case of a claim, of which a program reports nothing in the frames from `missed` on; the header
/// of its page.
fn silent_from(claim: &str, missed: u64, name: &str) -> Value {
    let directory = tempfile::tempdir().unwrap();
    let cases = directory.path().join("cases");
    let arguments = ["cases", "--claims", claim, "--case", name, "--out"];
    stdout(&[&arguments[..], &[text(&cases)]].concat());
    let case = cases.join(format!("{name}.ndjson"));
    let [answers, page] = ["answers", "page.html"].map(|name| directory.path().join(name));
    let lines = std::fs::read_to_string(&case).unwrap();
    let bodies = |line: &str| {
        let line: Value = serde_json::from_str(line).unwrap();
        line["poses"].as_array().unwrap().len()
    };
    let answer = |(frame, line): (u64, &str)| {
        let all = (0..bodies(line)).flat_map(|j| (0..j).map(move |i| format!("[{i},{j}]")));
        let pairs = if frame < missed { all.collect::<Vec<_>>().join(",") } else { String::new() };
        format!("{{\"frame\":{frame},\"pairs\":[{pairs}]}}\n")
    };
    let said: String = (0..).zip(lines.lines().skip(1)).map(answer).collect();
    std::fs::write(&answers, said).unwrap();
    let flags = [text(&case), "--answers", text(&answers), "--out", text(&page)];
    view(&flags);
    header(&page)
}

/// The page of a case about boxes has the judged boxes, and opens at the missed pair.
#[test]
fn counter_example_shows_judged_volumes() {
    // The first frame is answered rightly; each pair meets in every other frame.
    let header = silent_from("aabb", 1, "churn/teleport/0004");
    assert_eq!(header["layers"], serde_json::json!(["boxes"]));
    let focus = &header["focus"];
    let body = |n: usize| focus["bodies"][n].as_u64().unwrap();
    assert_eq!((&focus["frame"], body(1)), (&1.into(), body(0) + 1));
    assert!(focus["point"][0].is_f64(), "{focus}");
    let blocks = header["blocks"].as_array().unwrap();
    let boxes = blocks.iter().find(|block| block["name"] == "boxes");
    let numbers = 6 * header["bodies"].as_u64().unwrap() * header["frames"].as_u64().unwrap();
    assert_eq!(boxes.unwrap()["length"], numbers);
    assert!(header["messages"].to_string().contains("The case aims at: "));
    // Where space repeats, it has the periods of each frame.
    let header = silent_from("periodic", 2, "periodic/changed/0000");
    let blocks = header["blocks"].as_array().unwrap();
    let periods = blocks.iter().find(|block| block["name"] == "periods");
    assert_eq!(periods.unwrap()["length"], 3 * 6);
    assert_eq!(header["meet"], "boxes or their images");
    // Where the set of bodies changes, the frames with the set of the miss are shown.
    let header = silent_from("aabb", 2, "churn/insert-remove/0004");
    assert_eq!((&header["frames"], &header["focus"]["frame"]), (&1.into(), &0.into()));
    assert!(header["messages"].to_string().contains("frames 3 to 3 of 6"), "{header}");
}
