//! Balls outside the contract: NaN with any payload, infinities, the largest numbers. Culler and
//! World refuse them; a finder that gets them anyway ends, without a panic, whatever it finds.

use std::ops::Range;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sdop::bodies::{Bodies, Places};
use sdop::broad_phase::{Block, FirstTest, PairFinder, Population, Reorder, Volume};
use sdop::settings::Finder;
use sdop::simd::{Kernel, Lanes, Tier, dispatch};
use sdop::threads::{Executor, Threads};

struct Count<'a>(&'a PairFinder, u64);

impl FirstTest for Count<'_> {
    fn run<L: Lanes>(&mut self, _: L, _: usize, run: Range<usize>) {
        self.1 += run.len() as u64;
    }
    fn block<L: Lanes>(&mut self, _: L, block: &Block) {
        self.1 += block.codes().len() as u64;
    }
}

impl Kernel for Count<'_> {
    type Output = u64;
    fn run<L: Lanes>(mut self, l: L) -> u64 {
        self.0.find(l, 0..self.0.parts(), &mut self);
        self.1
    }
}

/// A number within the contract, or one in `rare` that isn't.
fn number(rng: &mut ChaCha8Rng, rare: u32) -> f32 {
    match rng.random_range(0..rare) {
        0 => match rng.random_range(0..6) {
            0 => f32::INFINITY,
            1 => f32::NEG_INFINITY,
            2 => f32::MAX,
            3 => f32::MIN,
            _ => f32::from_bits(0x7f80_0000 | rng.random_range(0..=u32::MAX)),
        },
        _ => rng.random_range(0.0..40.0),
    }
}

/// No finder hangs or panics on numbers outside the contract.
#[test]
fn invalid_numbers_never_hang() {
    for (n, threads, frames) in [(3, 1, 40), (30, 1, 40), (400, 1, 10), (33_000, 3, 5)] {
        for rare in [2, 20, 4 * n as u32] {
            for &finder in Finder::ALL {
                let mut rng = ChaCha8Rng::seed_from_u64(u64::from(rare) + n as u64);
                let population = Population {
                    bodies: n,
                    radii: [1.0, 1.0],
                    cheap_test: true,
                    volume: [Volume::Ball, Volume::Cube][n % 2],
                };
                let mut bodies = Bodies::default();
                for i in 0..n {
                    bodies.push(0, i % 3 > 0, [0.0, 0.0, 0.0, 1.0], [0.0; 3]);
                }
                let (mut found, pool) =
                    (PairFinder::new(finder, &population), Threads::new(threads).unwrap());
                let (mut places, mut order) = (Places::new(&bodies), Vec::new());
                let mut balls: Vec<[f32; 4]> = Vec::new();
                for frame in 0..frames {
                    let draw = |_| std::array::from_fn(|_| number(&mut rng, rare));
                    balls = (0..n).map(draw).collect();
                    let reorder = found.reorder(&places, &balls, &places.body, &mut order);
                    if reorder != Reorder::None {
                        places.body.clone_from(&order);
                    }
                    let tier = Tier::available()[frame % Tier::available().len()];
                    let executor = Executor { tier, pool: &pool };
                    found.arrange(executor, &places, &balls, &places.body, None);
                    let candidates = dispatch(tier, Count(&found, 0));
                    found.observe(candidates);
                }
                assert_eq!(balls.len(), n);
            }
        }
    }
}
