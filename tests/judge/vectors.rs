//! The vectors in `data/vectors` are up to date, have the same numbers in hexadecimal and in
//! decimal, and include pairs that meet and pairs that don't.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use sdop_judge::{Claim, vectors};
use serde_json::Value;

fn directory() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../data/vectors"))
}

#[test]
fn files_match_their_command() {
    let made = vectors::files().unwrap();
    for (name, bytes) in &made {
        let there = std::fs::read(directory().join(name)).unwrap_or_default();
        assert!(there == *bytes, "{name} is stale: sdop cases --vectors data/vectors");
    }
    let names: BTreeSet<&str> = made.iter().map(|(name, _)| name.as_str()).collect();
    for file in std::fs::read_dir(directory()).unwrap() {
        let name = file.unwrap().file_name().into_string().unwrap();
        assert!(
            names.contains(name.as_str()) || ["README.md", "schema.json"].contains(&name.as_str()),
            "{name}"
        );
    }
}

/// Hexadecimal and decimal numbers agree, and every claim is decided both ways.
#[test]
fn vectors_agree_and_cover_both_answers() {
    let (mut cases, mut answers) = (BTreeSet::new(), BTreeMap::<String, [u32; 2]>::new());
    for (name, bytes) in vectors::files().unwrap() {
        let file: Value = serde_json::from_slice(&bytes).unwrap();
        for case in file["cases"].as_array().unwrap() {
            assert!(
                cases.insert(case["name"].as_str().unwrap().to_owned()),
                "{name}: a name twice"
            );
            for (claim, meets) in case["meet"].as_object().unwrap() {
                answers.entry(claim.clone()).or_default()[usize::from(meets.as_bool().unwrap())] +=
                    1;
            }
            for body in case["bodies"].as_array().unwrap() {
                for (numbers, bits) in [("pose", "pose_hex"), ("box", "box_hex")] {
                    for (x, bits) in
                        body[numbers].as_array().unwrap().iter().zip(body[bits].as_array().unwrap())
                    {
                        let bits = u32::from_str_radix(bits.as_str().unwrap(), 16).unwrap();
                        // Exact, so that readers of doubles compute with the same number.
                        let exact = f64::from(f32::from_bits(bits)).to_bits();
                        assert_eq!(x.as_f64().unwrap().to_bits(), exact, "{name}");
                    }
                }
            }
        }
    }
    assert!(cases.len() >= 200, "{}", cases.len());
    for claim in Claim::PLAIN {
        let [apart, meet] = answers[claim.name()];
        assert!(apart >= 20 && meet >= 20, "{claim}: {apart} apart, {meet} meet");
    }
}
