//! Scenes on the borders between a finder's cells: the bytes choose which border, how many last
//! places to either side, what moves and how many sizes there are. Every finder reports what all
//! pairs reports.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sdop::Tier;
use sdop_judge::draw::borders::{Borders, bar};

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
    let frames = [1, 1, 1, 6][below(4, &mut bytes) as usize];
    let scene = Borders::draw(&mut |n| below(n, &mut bytes));
    let shapes = scene.radii.map(|radius| bar(radius).expect("within the contract"));
    let judged = scene.judge(&shapes, &Borders::settings(), tier, frames);
    let (_, difference) = judged.expect("the strategy needs nothing");
    assert_eq!(difference, None, "{tier}, {:?}", scene.radii);
});
