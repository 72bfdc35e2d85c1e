//! How deep can a point lie inside a set of half-spaces? A linear program in four variables, over
//! any [`Number`].
//!
//! Maximise t subject to n_i·z + ω_i t ≤ h_i with weights ω_i > 0. The half-spaces have a common
//! point iff the maximum is not negative. The dual simplex method keeps a basis of four rows with
//! multipliers λ ≥ 0, Σλn = 0: when t < 0 they show that no point exists (Farkas), otherwise z is
//! one. All steps are signs of determinants (Cramer's rule), so the same code guesses in f64 and
//! decides in integers. Bland's rule after a few steepest pivots ends cycles.

use std::cmp::Ordering;

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

/// When to be content.
pub struct Effort<N> {
    /// Violations up to this size are ignored. Zero for numbers that do not round.
    pub tolerance: N,
    /// Pivots at most.
    pub pivots: usize,
}

/// The optimum from a start basis; `None` if a sign is unknown or the basis is no start.
pub fn maximise<N: Number>(
    rows: &[Row<N>],
    start: [usize; 4],
    effort: &Effort<N>,
) -> Option<Optimum<N>> {
    let mut basis = start;
    for pivot in 0.. {
        let inverse = Inverse::of(rows, basis)?;
        let solution = inverse.solution(rows, basis);
        let multipliers = inverse.multipliers();
        if pivot == 0 && multipliers.iter().any(|m| m.sign() == Some(Ordering::Less)) {
            return None;
        }
        match entering(rows, &solution, &inverse.determinant, &effort.tolerance, pivot < STEEPEST)?
        {
            Some(row) if pivot < effort.pivots => basis[inverse.leaving(&rows[row], basis)?] = row,
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
    tolerance: &N,
    steepest: bool,
) -> Option<Option<usize>> {
    let mut worst: Option<(usize, N)> = None;
    for (i, row) in rows.iter().enumerate() {
        let end = determinant.times(&row.end.plus(tolerance));
        let violation = product(&row.normal, solution).minus(&end);
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

/// The inverse of the basis rows times the determinant, by columns, signed so that the determinant
/// is positive.
struct Inverse<N> {
    columns: [[N; 4]; 4],
    determinant: N,
}

impl<N: Number> Inverse<N> {
    /// A column is perpendicular to the three other rows: their four-dimensional cross product,
    /// signs alternating.
    fn of(rows: &[Row<N>], basis: [usize; 4]) -> Option<Self> {
        let [a, b, c, d] = basis.map(|i| &rows[i].normal);
        let columns = [
            perpendicular(b, c, d),
            perpendicular(a, d, c),
            perpendicular(a, b, d),
            perpendicular(b, a, c),
        ];
        let determinant = product(a, &columns[0]);
        match determinant.sign()? {
            Ordering::Greater => Some(Self { columns, determinant }),
            Ordering::Less => {
                let negate = |x: N| N::integer(0).minus(&x);
                Some(Self {
                    columns: columns.map(|column| column.map(negate)),
                    determinant: negate(determinant),
                })
            }
            Ordering::Equal => None,
        }
    }

    /// z and t where the basis rows hold with equality.
    fn solution(&self, rows: &[Row<N>], basis: [usize; 4]) -> [N; 4] {
        let ends = basis.map(|i| rows[i].end.clone());
        [0, 1, 2, 3]
            .map(|k| product(&ends, &self.columns.each_ref().map(|column| column[k].clone())))
    }

    /// λ with Σ λ_i row_i = (0, 0, 0, 1).
    fn multipliers(&self) -> [N; 4] {
        self.columns.each_ref().map(|column| column[3].clone())
    }

    /// Which basis row the entering one replaces so that all multipliers stay ≥ 0: the least
    /// λ_j/μ_j with μ_j > 0, where the entering row is Σ μ_j row_j. Ties go to the lowest row
    /// number (Bland).
    fn leaving(&self, entering: &Row<N>, basis: [usize; 4]) -> Option<usize> {
        let multipliers = self.multipliers();
        let mut least: Option<(usize, N)> = None;
        for j in 0..4 {
            let mu = product(&entering.normal, &self.columns[j]);
            if mu.sign()? != Ordering::Greater {
                continue;
            }
            let replace = match &least {
                None => true,
                Some((i, best)) => {
                    let (new, old) = (multipliers[j].times(best), multipliers[*i].times(&mu));
                    match new.minus(&old).sign()? {
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
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2])).plus(&a[3].times(&b[3]))
}

/// The vector whose product with x is det(x, a, b, c).
fn perpendicular<N: Number>(a: &[N; 4], b: &[N; 4], c: &[N; 4]) -> [N; 4] {
    let minor = |i: usize, j: usize| b[i].times(&c[j]).minus(&b[j].times(&c[i]));
    let [m01, m02, m03, m12, m13, m23] =
        [minor(0, 1), minor(0, 2), minor(0, 3), minor(1, 2), minor(1, 3), minor(2, 3)];
    let zero = N::integer(0);
    let sum = |x: N, y: N, z: N| x.minus(&y).plus(&z);
    [
        sum(a[1].times(&m23), a[2].times(&m13), a[3].times(&m12)),
        zero.minus(&sum(a[0].times(&m23), a[2].times(&m03), a[3].times(&m02))),
        sum(a[0].times(&m13), a[1].times(&m03), a[3].times(&m01)),
        zero.minus(&sum(a[0].times(&m12), a[1].times(&m02), a[2].times(&m01))),
    ]
}
