//! How deep can a point lie inside a set of half-spaces? A linear program in four variables, over any [`Number`].
//!
//! Maximise t subject to n_i·z + ω_i t ≤ h_i with weights ω_i > 0. The half-spaces have a common point iff the maximum
//! is not negative. The dual simplex method keeps a basis of four rows with multipliers λ ≥ 0, Σλn = 0: when t < 0
//! they show that no point exists (Farkas), otherwise z is one. All steps are signs of determinants (Cramer's rule),
//! so the same code guesses in f64 and decides in integers. Bland's rule after a few steepest pivots ends cycles.

use std::cmp::Ordering;

use crate::linear::{cross, dot};
use crate::number::Number;

/// The half-space n·z + ω t ≤ h as [n_x, n_y, n_z, ω].
#[derive(Clone, Debug)]
pub struct Row<N> {
    /// n and ω
    pub normal: [N; 4],
    /// h
    pub end: N,
}

/// Where the method ended: everything is divided by `determinant` > 0.
#[derive(Clone, Debug)]
pub struct Optimum<N> {
    /// The four rows with equality.
    pub basis: [usize; 4],
    /// Their multipliers λ ≥ 0.
    pub multipliers: [N; 4],
    /// z and t.
    pub solution: [N; 4],
    /// What both are multiplied by.
    pub determinant: N,
}

/// Steepest pivots before Bland's rule.
const STEEPEST: usize = 24;

/// The optimum from a start basis, at most `pivots` later; `None` if a sign is unknown or the basis is no start.
pub fn maximise<N: Number>(
    rows: &[Row<N>],
    start: [usize; 4],
    pivots: usize,
) -> Option<Optimum<N>> {
    let mut basis = start;
    for pivot in 0.. {
        let inverse = Inverse::of(rows, basis)?;
        let solution = inverse.solution(rows, basis);
        let multipliers = inverse.rows[3].clone();
        if pivot == 0 && multipliers.iter().any(|m| m.sign() == Some(Ordering::Less)) {
            return None;
        }
        match entering(rows, &solution, &inverse.determinant, pivot < STEEPEST)? {
            Some(row) if pivot < pivots => basis[inverse.leaving(&rows[row], basis)?] = row,
            _ => {
                return Some(Optimum {
                    basis,
                    multipliers,
                    solution,
                    determinant: inverse.determinant,
                });
            }
        }
    }
    None
}

/// A row that the solution violates: the worst, or the first.
fn entering<N: Number>(
    rows: &[Row<N>],
    solution: &[N; 4],
    determinant: &N,
    steepest: bool,
) -> Option<Option<usize>> {
    let mut worst: Option<(usize, N)> = None;
    for (i, row) in rows.iter().enumerate() {
        let violation = product(&row.normal, solution).minus(&determinant.times(&row.end));
        if violation.sign()? != Ordering::Greater {
            continue;
        }
        let worse = match &worst {
            Some((_, so_far)) => steepest && violation.minus(so_far).sign()? == Ordering::Greater,
            None => true,
        };
        if worse {
            worst = Some((i, violation));
        }
    }
    Some(worst.map(|(i, _)| i))
}

/// The adjugate of the basis rows, signed so that the determinant is positive.
struct Inverse<N> {
    rows: [[N; 4]; 4],
    determinant: N,
}

impl<N: Number> Inverse<N> {
    fn of(rows: &[Row<N>], basis: [usize; 4]) -> Option<Self> {
        let m = basis.map(|i| &rows[i].normal);
        let cofactor = |i: usize, j: usize| {
            let others = |skip: usize| [0, 1, 2, 3].into_iter().filter(move |k| *k != skip);
            let mut kept = others(i).map(|r| {
                let mut entries = others(j).map(|c| m[r][c].clone());
                [(); 3].map(|()| entries.next().unwrap_or_else(|| N::integer(0)))
            });
            let [a, b, c] = [(); 3].map(|()| {
                kept.next()
                    .unwrap_or_else(|| [(); 3].map(|()| N::integer(0)))
            });
            let minor = dot(&a, &cross(&b, &c));
            if (i + j).is_multiple_of(2) {
                minor
            } else {
                N::integer(0).minus(&minor)
            }
        };
        let adjugate = [0, 1, 2, 3].map(|j| [0, 1, 2, 3].map(|i| cofactor(i, j)));
        let determinant = product(m[0], &[0, 1, 2, 3].map(|j| adjugate[j][0].clone()));
        match determinant.sign()? {
            Ordering::Greater => Some(Self {
                rows: adjugate,
                determinant,
            }),
            Ordering::Less => {
                let negate = |x: &N| N::integer(0).minus(x);
                let rows = adjugate.each_ref().map(|row| row.each_ref().map(negate));
                Some(Self {
                    rows,
                    determinant: negate(&determinant),
                })
            }
            Ordering::Equal => None,
        }
    }

    fn solution(&self, rows: &[Row<N>], basis: [usize; 4]) -> [N; 4] {
        let ends = basis.map(|i| rows[i].end.clone());
        self.rows.each_ref().map(|row| product(row, &ends))
    }

    /// Which basis row the entering one replaces so that all multipliers stay ≥ 0: the least λ_j/μ_j with μ_j > 0,
    /// where the entering row is Σ μ_j row_j. Ties go to the lowest row number (Bland).
    fn leaving(&self, entering: &Row<N>, basis: [usize; 4]) -> Option<usize> {
        let mut least: Option<(usize, N)> = None;
        for j in 0..4 {
            let column = [0, 1, 2, 3].map(|k| self.rows[k][j].clone());
            let mu = product(&entering.normal, &column);
            if mu.sign()? != Ordering::Greater {
                continue;
            }
            let replace = match &least {
                None => true,
                Some((i, best)) => {
                    let lambda = |n: usize| &self.rows[3][n];
                    match lambda(j).times(best).minus(&lambda(*i).times(&mu)).sign()? {
                        Ordering::Less => true,
                        Ordering::Equal => basis[j] < basis[*i],
                        Ordering::Greater => false,
                    }
                }
            };
            if replace {
                least = Some((j, mu));
            }
        }
        least.map(|(j, _)| j)
    }
}

fn product<N: Number>(a: &[N; 4], b: &[N; 4]) -> N {
    a[0].times(&b[0])
        .plus(&a[1].times(&b[1]))
        .plus(&a[2].times(&b[2]))
        .plus(&a[3].times(&b[3]))
}
