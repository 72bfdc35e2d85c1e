//! A user's culler and pair test, judged as in the crate's README.

use sdop_judge::WorldBox;

/// What is judged, as if it were another crate.
mod mine {
    use super::WorldBox;

    /// The pairs of boxes that meet: sorted along x, and swept.
    pub fn sweep(boxes: &[WorldBox]) -> Vec<[u32; 2]> {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        order.sort_by(|&i, &j| boxes[i as usize][0].total_cmp(&boxes[j as usize][0]));
        let mut pairs = Vec::new();
        for (place, &i) in order.iter().enumerate() {
            let a = &boxes[i as usize];
            let within = |j: &&u32| boxes[**j as usize][0] <= a[3];
            let reached = order[place + 1..].iter().take_while(within);
            let partners = reached.filter(|&&j| meet(a, &boxes[j as usize]));
            pairs.extend(partners.map(|&j| [i.min(j), i.max(j)]));
        }
        pairs
    }

    /// Whether two boxes share a point.
    pub fn meet(a: &WorldBox, b: &WorldBox) -> bool {
        (0..3).all(|axis| a[axis] <= b[axis + 3] && b[axis] <= a[axis + 3])
    }
}

include!("lines.rs");

/// The README shows the lines that are compiled here.
#[test]
fn readme_shows_these_lines() {
    let readme = include_str!("../../README.md");
    assert!(readme.contains(include_str!("lines.rs")));
}
