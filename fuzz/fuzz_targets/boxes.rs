//! Moving boxes of any aspect and size that touch to the last place; the bytes choose everything.
//! Every finder in every tier lists exactly the boxes that have a point in common.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sdop::Tier;
use sdop_judge::{configuration::Rotation, draw::boxes::draw, verify::rounds::check_boxes};

/// A number below another, of as many bytes as that takes; 0 when none are left.
fn below(n: u32, bytes: &mut impl Iterator<Item = u8>) -> u32 {
    let length = (n - 1).max(1).ilog2() / 8 + 1;
    let number = (0..length).fold(0, |sum: u32, _| sum << 8 | u32::from(bytes.next().unwrap_or(0)));
    number % n
}

fuzz_target!(|data: &[u8]| {
    let mut bytes = data.iter().copied();
    let tiers = Tier::available();
    let tier = tiers[below(tiers.len() as u32, &mut bytes) as usize];
    let frames = draw(&mut |n| below(n, &mut bytes));
    let judged = check_boxes(&frames, &Rotation::new(&[tier])).expect("boxes are boxes");
    assert_eq!(judged.failure, None);
});
