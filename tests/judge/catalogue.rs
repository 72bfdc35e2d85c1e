//! Cases are the same whenever they are drawn, differ by seed, and are unchanged after they were
//! written and read.

use std::collections::BTreeSet;

use sdop::volume::check_bodies;
use sdop_judge::catalogue::groups;
use sdop_judge::wire::{Wire, ndjson};
use sdop_judge::{Claim, case::matches};

/// A name is the same case every time, and with a seed it is another one.
#[test]
fn names_and_seeds_determine_cases() {
    let mut names = BTreeSet::new();
    for group in groups().unwrap() {
        let first = group.case(0, None).unwrap();
        let (again, seeded) = (group.case(0, None).unwrap(), group.case(0, Some(9)).unwrap());
        assert_eq!(first.frames, again.frames, "{}", group.name);
        assert_eq!(first.shapes, again.shapes, "{}", group.name);
        assert!(names.insert(first.name.clone()), "{}: a name twice", first.name);
        assert_eq!(seeded.name, format!("{}@9", first.name));
        let empty = first.frames.iter().all(|frame| frame.bodies.is_empty());
        assert!(
            empty || first.frames != seeded.frames,
            "{}: fresh cases are the published ones",
            group.name
        );
        for frame in first.frames.iter().chain(&seeded.frames) {
            check_bodies(&frame.bodies, &first.shapes)
                .unwrap_or_else(|e| panic!("{}: {e}", first.name));
        }
        assert!(!first.claims.is_empty() && !first.flag.is_empty() && !first.source.is_empty());
    }
    assert!(names.len() > 60 && names.iter().any(|name| matches("touch/edge-edge/0000", name)));
}

/// Cases read back from their files to the bit.
#[test]
fn case_files_read_back_exactly() {
    for group in groups().unwrap() {
        let mut case = group.case(group.cases - 1, None).unwrap();
        if case.claims.contains(&Claim::Aabb) {
            case.claim = Claim::Aabb;
        }
        let bytes = Wire::Ndjson.encode(&case).unwrap();
        let back = ndjson::read(bytes.as_slice(), u64::MAX).unwrap().case;
        assert_eq!(back.name, case.name);
        assert_eq!((back.claim, back.claims[0]), (case.claim, case.claim));
        // A case has the vertices as culled, and not how they were scaled and moved.
        let mut shapes = case.shapes.clone();
        for shape in &mut shapes {
            (shape.offset, shape.scale) = ([0.0; 3], 1.0);
        }
        assert_eq!(back.shapes, shapes, "{}", case.name);
        assert_eq!(back.frames, case.frames, "{}", case.name);
    }
}

/// Damaged case files are refused with an error that names the line.
#[test]
fn damaged_case_files_name_their_line() {
    let mut case = groups().unwrap()[0].case(0, None).unwrap();
    case.claim = Claim::Aabb;
    let text = String::from_utf8(Wire::Ndjson.encode(&case).unwrap()).unwrap();
    let problem = |text: &str| ndjson::read(text.as_bytes(), u64::MAX).err().unwrap();
    assert!(problem("").contains("no line"));
    assert!(problem("{}").contains("line 1"));
    assert!(problem(&text.replacen("sdop-record", "other", 1)).contains("other"));
    assert!(problem(&text[..text.len() - 20]).contains("line 2"));
    let frames = text.lines().nth(1).unwrap();
    let short = text.replacen(frames, r#"{"frame":0,"poses":[]}"#, 1);
    assert!(problem(&short).contains("0 poses"), "{}", problem(&short));
    let bent = text.replacen(
        frames,
        &frames.replacen("\"poses\":[[", "\"poses\":[[0,0,0,0,0,0,0],[", 1),
        1,
    );
    assert!(problem(&bent).contains("line 2"), "{}", problem(&bent));
}
