//! The command line: cases written on one machine and answered on another, recordings by other
//! programs.

use super::commands::{reason, sdop};

#[test]
fn cases_are_answered_elsewhere_and_checked() {
    let directory = tempfile::tempdir().unwrap();
    let (output, _) = sdop(
        directory.path(),
        &["cases", "--out", "c", "--claims", "aabb", "--case", "box/flat/*"],
    );
    assert!(output.status.success());
    let case = "c/box/flat/0000.ndjson";
    assert_eq!(std::fs::read_dir(directory.path().join("c/box/flat")).unwrap().count(), 8);
    let answer = |pairs: &str| {
        std::fs::write(
            directory.path().join("answers"),
            format!("{{\"frame\":0,\"pairs\":[{pairs}]}}\n"),
        )
        .unwrap()
    };
    let every: Vec<String> =
        (0..48).flat_map(|j| (0..j).map(move |i| format!("[{i},{j}]"))).collect();
    for (pairs, code) in [(every.join(","), 0), (String::new(), 1), ("[0,0]".to_owned(), 1)] {
        answer(&pairs);
        let (output, text) = sdop(directory.path(), &["check", case, "--pairs", "answers"]);
        assert_eq!(output.status.code(), Some(code), "{text}");
    }
    // Without answers there is nothing to judge.
    let (output, _) = sdop(directory.path(), &["check", case]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        sdop(directory.path(), &["cases", "--out", "c", "--case", "no/such"]).0.status.code(),
        Some(2)
    );
}

#[test]
fn records_without_all_frames_are_incomplete() {
    let directory = tempfile::tempdir().unwrap();
    let scene = "name = \"two\"\nframes = 4\n[[bodies]]\nshape = \"box\"\nposes = [[0,0,0,1,0,0,0],[0,0,0,1,0.5,0,0]]\n";
    std::fs::write(directory.path().join("two.toml"), scene).unwrap();
    let recorded = ["run", "two.toml", "--record", "whole"];
    assert!(sdop(directory.path(), &recorded).0.status.success());
    let whole = std::fs::read_to_string(directory.path().join("whole")).unwrap();
    let lines: Vec<&str> = whole.lines().collect();
    assert_eq!(lines.len(), 5);
    let missed = lines[2].replace("[[0,1]]", "[]");
    for (kept, code, said) in [
        (lines.clone(), 0, "PASS"),
        (lines[..4].to_vec(), 3, "3 of its 4 frames"),
        (vec![lines[0], lines[2], lines[4]], 3, "2 of its 4 frames"),
        (vec![lines[0]], 3, "0 of its 4 frames"),
        (vec![lines[0], &missed], 1, "NOT PASSED"),
        (vec![lines[0], lines[2], lines[1]], 2, ""),
    ] {
        std::fs::write(directory.path().join("part"), kept.join("\n")).unwrap();
        let (output, text) = sdop(directory.path(), &["check", "part"]);
        assert_eq!(output.status.code(), Some(code), "{said}: {text}");
        assert!(text.contains(said), "{text}");
        if [1, 3].contains(&code) {
            reason(&output);
        }
    }
}

#[test]
fn broadmarks_recordings_are_cases_of_boxes() {
    let directory = tempfile::tempdir().unwrap();
    let written = ["cases", "--out", "c", "--aabbs", "--case", "box/grid/0000"];
    assert!(sdop(directory.path(), &written).0.status.success());
    let bytes = std::fs::read(directory.path().join("c/box/grid/0000.aabbs")).unwrap();
    assert_eq!(bytes.len(), 304 + 48 * 32);
    let every: Vec<String> =
        (0..48).flat_map(|j| (0..j).map(move |i| format!("[{i},{j}]"))).collect();
    for (pairs, code) in [(every.join(","), 0), (String::new(), 1)] {
        let answer = format!("{{\"frame\":0,\"pairs\":[{pairs}]}}\n");
        std::fs::write(directory.path().join("answers"), answer).unwrap();
        let check = ["check", "c/box/grid/0000.aabbs", "--pairs", "answers"];
        let (output, text) = sdop(directory.path(), &check);
        assert_eq!(output.status.code(), Some(code), "{text}");
    }
    std::fs::write(directory.path().join("short.aabbs"), &bytes[..bytes.len() - 1]).unwrap();
    assert_eq!(sdop(directory.path(), &["check", "short.aabbs"]).0.status.code(), Some(2));
}
