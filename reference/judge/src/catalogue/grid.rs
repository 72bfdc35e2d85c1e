//! Tips that touch across cells. If a cell is as wide as the bodies and cells are counted in f32,
//! the partner is two cells away, where a search of the next cells does not find it.
//!
//! A quotient x / c alone does not cause that: if rounding moves floor(x / c) up at the farther
//! border, it does so at the nearer one as well. A subtraction x − least before the division causes
//! it, and so does a product with a reciprocal.

use rand::{Rng, RngExt};

use super::exact_touches::solids;
use super::{CatalogueError, DrawnCase};
use crate::case::Frame;
use sdop::bodies::Bodies;

/// Pairs per case.
const PAIRS: usize = 16;
/// Sizes that are tried until a case's pairs are found, and places for each pair. About one size in
/// ten and one place in some hundred have such a pair.
const SIZES: usize = 256;
const PLACES: usize = 4096;

/// How a grid counts cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CellCount {
    /// (x − least) / side.
    Quotient,
    /// x · (1 / side).
    Product,
    /// (x − least) · (1 / side).
    ProductFromLeast,
}

impl CellCount {
    const ALL: [Self; 3] = [Self::Quotient, Self::Product, Self::ProductFromLeast];

    fn cell(self, x: f32, least: f32, side: f32) -> f32 {
        match self {
            Self::Quotient => ((x - least) / side).floor(),
            Self::Product => (x * (1.0 / side)).floor(),
            Self::ProductFromLeast => ((x - least) * (1.0 / side)).floor(),
        }
    }
}

/// A grid whose cells are as large as the bodies.
#[derive(Clone, Copy)]
struct CellGrid {
    counting: CellCount,
    /// Where cells begin.
    least: f32,
    side: f32,
}

impl CellGrid {
    /// Two places at most `reach` apart, as exact numbers, with another cell between their cells.
    fn pair_across(self, reach: f32, rng: &mut impl Rng) -> Option<[f32; 2]> {
        (0..PLACES).find_map(|_| {
            let [first, second] = self.near_border(reach, rng);
            let cell = |x| self.counting.cell(x, self.least, self.side);
            (cell(second) - cell(first) > 1.5).then_some([first, second])
        })
    }

    /// A place near a cell's border, and the last place within its reach.
    fn near_border(self, reach: f32, rng: &mut impl Rng) -> [f32; 2] {
        let (least, side) = (f64::from(self.least), f64::from(self.side));
        let border = match self.counting {
            // Rounding steps double at powers of two.
            CellCount::Product => side * f64::from(1_u32 << rng.random_range(1..12)),
            // Near zero coordinates are finer than their distance from the least one.
            CellCount::Quotient | CellCount::ProductFromLeast => {
                let cells = (-least / side).round() + f64::from(rng.random_range(1..=4));
                least + cells * side
            }
        };
        let step = (border - least) * f64::from(f32::EPSILON);
        let first = (border + step * rng.random_range(-1.0..1.0)) as f32;
        // Exact in f64: both are of similar size.
        let most = f64::from(first) + f64::from(reach);
        let second = most as f32;
        if f64::from(second) > most { [first, second.next_down()] } else { [first, second] }
    }
}

/// Pairs of octahedra, tip to tip along an axis, each pair where cells as large as they are lose
/// it.
pub fn tips_across_borders(number: u32, rng: &mut impl Rng) -> Result<DrawnCase, CatalogueError> {
    let counting = CellCount::ALL[number as usize % CellCount::ALL.len()];
    let axis = rng.random_range(0..3);
    let mut drawn = None;
    for _ in 0..SIZES {
        let size = 2_f32.powi(rng.random_range(-6..=6)) * rng.random_range(1.0..2.0_f32);
        let [_, octahedron] = solids(size)?;
        let radius = octahedron.ball.radius;
        let most_left = match counting {
            CellCount::Product => 0.0,
            CellCount::Quotient | CellCount::ProductFromLeast => {
                -size * rng.random_range(100.0..2000.0_f32)
            }
        };
        // Cells begin at the least centre or at the least end.
        let pairs: Vec<[f32; 2]> = (0..PAIRS)
            .map_while(|n| {
                let cells = CellGrid {
                    counting,
                    least: [most_left, most_left - radius][n % 2],
                    side: 2.0 * radius,
                };
                cells.pair_across(2.0 * size, rng)
            })
            .collect();
        if pairs.len() == PAIRS {
            drawn = Some((octahedron, most_left, pairs));
            break;
        }
    }
    // No fresh seed is known to come here; a case without a pair is still a case.
    let (octahedron, most_left, pairs) = match drawn {
        Some(drawn) => drawn,
        None => (solids(1.0)?[1].clone(), 0.0, Vec::new()),
    };
    let size = octahedron.ball.radius;
    let mut bodies = Bodies::default();
    let mut put = |row: usize, x: f32| {
        let mut t = [0.0; 3];
        t[axis] = x;
        // Pairs stay away from one another.
        t[(axis + 1) % 3] = 8.0 * size * row as f32;
        bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], t);
    };
    put(0, most_left);
    for (n, [first, second]) in pairs.into_iter().enumerate() {
        put(n + 1, first);
        put(n + 1, second);
    }
    let shapes = vec![octahedron];
    let frames = vec![Frame::fitted(bodies, &shapes)];
    Ok(DrawnCase { shapes, frames })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use rand::SeedableRng as _;

    use super::*;

    /// Whether a grid of cells as large as the bodies, counted from the least centre, sees the
    /// neighbours of both.
    fn finds(counting: CellCount, from_ends: bool, drawn: &DrawnCase) -> usize {
        let radius = drawn.shapes[0].ball.radius;
        let places = &drawn.frames[0].bodies.translation;
        let cells = |t: &[f32; 3]| {
            [0, 1, 2].map(|axis| {
                let least = places.iter().map(|t| t[axis]).fold(f32::INFINITY, f32::min);
                let least = if from_ends { least - radius } else { least };
                counting.cell(t[axis], least, 2.0 * radius)
            })
        };
        let pairs = places[1..].chunks(2);
        let near = |pair: &&[[f32; 3]]| {
            let [a, b] = [cells(&pair[0]), cells(&pair[1])];
            (0..3).all(|axis| (a[axis] - b[axis]).abs() <= 1.0)
        };
        pairs.filter(near).count()
    }

    /// A grid whose cells are as wide as the bodies loses pairs that touch.
    #[test]
    fn diameter_grids_lose_touching_pairs() {
        for number in 0..12 {
            for seed in 0..4 {
                let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
                rng.set_stream(u64::from(number));
                let drawn = tips_across_borders(number, &mut rng).unwrap();
                let counting = CellCount::ALL[number as usize % 3];
                assert_eq!(drawn.frames[0].bodies.len(), 1 + 2 * PAIRS);
                for from_ends in [false, true] {
                    let found = finds(counting, from_ends, &drawn);
                    assert!(found <= PAIRS / 2, "{counting:?} finds {found}");
                }
            }
        }
    }
}
