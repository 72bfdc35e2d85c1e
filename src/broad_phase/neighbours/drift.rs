//! Checking that every ball has stayed within its skin.

use crate::broad_phase::BLOCK_BODIES;
use crate::rounding::skin::{Skin, stays};
use crate::simd::{Kernel, Lanes, dispatch};
use crate::threads::Executor;

/// Balls that one thread checks at a time.
pub const BALLS_PER_TASK: usize = 4096;

/// Whether no ball has drifted by its skin since `then`.
pub fn all_stay(executor: Executor<'_>, skin: Skin, now: &[[f32; 4]], then: &[[f32; 4]]) -> bool {
    let Executor { tier, pool } = executor;
    pool.all(now.len(), BALLS_PER_TASK, |range| {
        let (now, then) = (&now[range.clone()], &then[range]);
        dispatch(tier, MeasureDrift { skin, now, then })
    })
}

struct MeasureDrift<'a> {
    skin: Skin,
    now: &'a [[f32; 4]],
    then: &'a [[f32; 4]],
}

impl Kernel for MeasureDrift<'_> {
    type Output = bool;
    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> bool {
        let (now, now_rest) = self.now.as_chunks::<BLOCK_BODIES>();
        let (then, then_rest) = self.then.as_chunks::<BLOCK_BODIES>();
        for (now, then) in now.iter().zip(then) {
            if !block_stays(l, self.skin, now, then) {
                return false;
            }
        }
        block_stays(l, self.skin, &padded(now_rest), &padded(then_rest))
    }
}

/// A block of balls: `rest`, then balls of radius 0 at the origin.
pub fn padded(rest: &[[f32; 4]]) -> [[f32; 4]; BLOCK_BODIES] {
    let mut balls = [[0.0; 4]; BLOCK_BODIES];
    balls[..rest.len()].copy_from_slice(rest);
    balls
}

#[inline(always)]
fn block_stays<L: Lanes>(
    l: L,
    skin: Skin,
    now: &[[f32; 4]; BLOCK_BODIES],
    then: &[[f32; 4]; BLOCK_BODIES],
) -> bool {
    // A loop, because a closure would be compiled without the tier's features.
    let mut staying = l.first(L::WIDTH);
    let mut start = 0;
    while start < BLOCK_BODIES {
        let (now, then) = (l.load_quads(&now[start..]), l.load_quads(&then[start..]));
        staying = staying & stays(l, skin, now, then);
        start += L::WIDTH;
    }
    l.bits(staying) == l.bits(l.first(L::WIDTH))
}
