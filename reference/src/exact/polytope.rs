//! The polytope that a k-DOP's slabs bound: its exact corners and edge directions.
//!
//! With an orthogonal basis b_j of one norm, ξ_j = b_j·x are Cartesian coordinates up to a scale,
//! and every slab reads lo_i ≤ c_i·ξ ≤ hi_i with the integer coefficients c_i. A corner solves
//! three of these with equality; the determinant of three coefficient rows is 0 to ±4, so 12ξ is an
//! integer combination of the slab ends. We enumerate all triples and keep the feasible corners;
//! that is slow but simple, and is done once per shape. Supports from these corners are the
//! or-DOP's true supports; slabs that bound nothing (lo > hi) have no corner and overlap nothing.

use std::collections::BTreeSet;

use dashu_int::IBig;

use crate::InvalidInput;
use crate::linear::{Matrix, Vector, apply, dot, integers, transpose};
use crate::number::{Number, power_of_two, unit_of};
use crate::volume::Slabs;

/// Corners are stored as multiples of 1/12: the least common multiple of the determinants 1, 2, 3,
/// 4.
pub const DENOMINATOR: i32 = 12;

/// Corners, normals and edge directions of the slabs' polytope.
#[derive(Clone, Debug)]
pub struct Polytope {
    /// The basis as rows: ξ = basis·x.
    pub basis: Matrix<f64>,
    /// Every entry of the basis is a multiple of 2^basis_unit.
    pub basis_unit: i32,
    /// Coefficients c_i of the slab directions: the face normals in ξ.
    pub normals: Vec<[i32; 3]>,
    /// Lower slab ends, exact.
    pub lo: Vec<f64>,
    /// Upper slab ends, exact.
    pub hi: Vec<f64>,
    /// Edge directions in ξ, primitive integers, each line once.
    pub edges: Vec<[i32; 3]>,
    /// Corners: 12·ξ·2^(−unit), each once.
    pub corners: Vec<Vector<IBig>>,
    /// Every slab end is a multiple of 2^unit.
    pub unit: i32,
    /// Corners ξ rounded to f64, in the order of `corners`.
    pub rounded: Vec<Vector<f64>>,
}

impl Polytope {
    /// The polytope of the slabs.
    ///
    /// # Errors
    /// When a number is not finite, the slabs are not k/2 or the basis is not exactly orthogonal
    /// with one norm.
    pub fn new(slabs: &Slabs) -> Result<Self, InvalidInput> {
        let normals = slabs.directions.coefficients();
        let (lo, hi) = (slabs.lo.len(), slabs.hi.len());
        if lo != normals.len() || hi != normals.len() {
            return Err(InvalidInput::SlabCount { slabs: normals.len(), lo, hi });
        }
        if !slabs.lo.iter().chain(&slabs.hi).all(|x| x.is_finite()) {
            return Err(InvalidInput::NotFinite("a slab"));
        }
        let basis = slabs.basis.map(|column| column.map(f64::from));
        check_basis(&basis)?;
        let widen = |ends: &[f32]| ends.iter().copied().map(f64::from).collect::<Vec<_>>();
        let (lo, hi) = (widen(&slabs.lo), widen(&slabs.hi));
        let basis_unit = unit_of(basis.iter().flatten().copied());
        let unit = unit_of(lo.iter().chain(&hi).copied());
        let planes = Planes::new(&normals, &lo, &hi, unit);
        let (corners, edges) = planes.corners_and_edges();
        let round = |x: &IBig| x.to_f64().value() / f64::from(DENOMINATOR) * power_of_two(unit);
        let rounded = corners.iter().map(|corner| [0, 1, 2].map(|i| round(&corner[i]))).collect();
        Ok(Self { basis, basis_unit, normals, lo, hi, edges, corners, unit, rounded })
    }

    /// ‖b‖², one for all three columns.
    pub fn basis_norm_squared(&self) -> f64 {
        dot(&self.basis[0], &self.basis[0])
    }

    /// Slab ends are lengths times the basis: a length that is a multiple of this makes them
    /// multiples of `unit`.
    pub fn length_unit(&self) -> i32 {
        self.unit - self.basis_unit
    }

    /// The corners 12ξ where lengths are counted in 2^unit.
    pub fn lift_corners<N: Number>(&self, unit: i32) -> Vec<Vector<N>> {
        let lift = |x: &IBig| N::lift_integer(x, self.unit, unit + self.basis_unit);
        self.corners.iter().map(|corner| corner.each_ref().map(lift)).collect()
    }

    /// Body-frame position of the coordinates ξ: x = Σ_j ξ_j b_j/‖b‖².
    pub fn position(&self, xi: &Vector<f64>) -> Vector<f64> {
        let x = apply(&transpose(&self.basis), xi);
        x.map(|component| component / self.basis_norm_squared())
    }

    /// Body-frame directions of integer vectors in ξ.
    pub fn directions(&self, integer: &[[i32; 3]]) -> Vec<Vector<f64>> {
        let columns = transpose(&self.basis);
        integer.iter().map(|c| apply(&columns, &integers(*c))).collect()
    }
}

/// Exactly orthogonal rows of one non-zero norm: what makes ξ Cartesian.
fn check_basis(basis: &Matrix<f64>) -> Result<(), InvalidInput> {
    if !basis.iter().flatten().all(|x| x.is_finite()) {
        return Err(InvalidInput::NotFinite("the slab basis"));
    }
    let unit = unit_of(basis.iter().flatten().copied());
    let exact = basis.map(|row| row.map(|x| IBig::lift(x, unit)));
    let norms = [0, 1, 2].map(|i| dot(&exact[i], &exact[i]));
    let crossed = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| dot(&exact[i], &exact[j]));
    let one_norm = norms[0] == norms[1] && norms[1] == norms[2] && !norms[0].is_zero();
    if one_norm && crossed.iter().all(IBig::is_zero) { Ok(()) } else { Err(InvalidInput::Basis) }
}

/// The slabs as integers: plane 2i is lo_i, plane 2i + 1 is hi_i.
struct Planes<'a> {
    normals: &'a [[i32; 3]],
    ends: Vec<[IBig; 2]>,
}

/// A corner and the planes that it lies on.
struct Corner {
    position: Vector<IBig>,
    tight: BTreeSet<usize>,
}

impl<'a> Planes<'a> {
    fn new(normals: &'a [[i32; 3]], lo: &[f64], hi: &[f64], unit: i32) -> Self {
        let lift = |x: f64| IBig::lift(x, unit) * IBig::from(DENOMINATOR);
        let ends = lo.iter().zip(hi).map(|(lo, hi)| [lift(*lo), lift(*hi)]).collect();
        Self { normals, ends }
    }

    fn corners_and_edges(&self) -> (Vec<Vector<IBig>>, Vec<[i32; 3]>) {
        let mut corners: Vec<Corner> = Vec::new();
        let slabs = self.normals.len();
        for i in 0..slabs {
            for j in i + 1..slabs {
                for k in j + 1..slabs {
                    self.corners_of([i, j, k], &mut corners);
                }
            }
        }
        let edges = self.edge_directions(&corners);
        (corners.into_iter().map(|corner| corner.position).collect(), edges)
    }

    /// The up to eight feasible corners of three slabs: ξ = Σ h_i (c_j × c_k)/det.
    fn corners_of(&self, slabs: [usize; 3], corners: &mut Vec<Corner>) {
        let [a, b, c] = slabs.map(|i| self.normals[i]);
        let normals = [cross_product(b, c), cross_product(c, a), cross_product(a, b)];
        let determinant: i32 = a.iter().zip(&normals[0]).map(|(x, y)| x * y).sum();
        if determinant == 0 {
            return;
        }
        for choice in 0..8_usize {
            let mut position = [IBig::ZERO, IBig::ZERO, IBig::ZERO];
            for (n, normal) in normals.iter().enumerate() {
                let end = &self.ends[slabs[n]][choice >> n & 1];
                for (sum, component) in position.iter_mut().zip(normal) {
                    *sum += end * *component;
                }
            }
            // Exact: the ends carry the factor 12, which every determinant divides.
            let position = position.map(|x| x / determinant);
            if let Some(tight) = self.tight_planes(&position)
                && corners.iter().all(|corner| corner.position != position)
            {
                corners.push(Corner { position, tight });
            }
        }
    }

    /// The planes through a point of the polytope, `None` outside it.
    fn tight_planes(&self, position: &Vector<IBig>) -> Option<BTreeSet<usize>> {
        let mut tight = BTreeSet::new();
        for (i, (normal, [lo, hi])) in self.normals.iter().zip(&self.ends).enumerate() {
            let height = dot(&integers(*normal), position);
            if height < *lo || height > *hi {
                return None;
            }
            if height == *lo {
                tight.insert(2 * i);
            }
            if height == *hi {
                tight.insert(2 * i + 1);
            }
        }
        Some(tight)
    }

    /// The directions of the lines on which two planes meet and at least two corners lie.
    fn edge_directions(&self, corners: &[Corner]) -> Vec<[i32; 3]> {
        let mut directions = BTreeSet::new();
        for (n, first) in corners.iter().enumerate() {
            for second in &corners[n + 1..] {
                let shared: Vec<usize> = first.tight.intersection(&second.tight).copied().collect();
                for (m, p) in shared.iter().enumerate() {
                    for q in &shared[m + 1..] {
                        let line = cross_product(self.normals[p / 2], self.normals[q / 2]);
                        directions.extend(primitive(line));
                    }
                }
            }
        }
        directions.into_iter().collect()
    }
}

/// a × b of small integers.
fn cross_product(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    let minor = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// The shortest integer vector on the line of `v`, first non-zero component positive; none for
/// zero.
fn primitive(v: [i32; 3]) -> Option<[i32; 3]> {
    let divisor = v.iter().fold(0, |g, x| gcd(g, x.abs()));
    let lead = v.iter().find(|x| **x != 0)?;
    Some(v.map(|x| x / divisor * lead.signum()))
}

fn gcd(a: i32, b: i32) -> i32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that cannot build its input has failed")]
    use super::*;
    use crate::volume::DirectionSet;

    const AXES: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    /// The regular k-DOP about the origin whose faces all bound it.
    fn regular(directions: DirectionSet) -> Polytope {
        let length = |c: &[i32; 3]| match c.iter().filter(|x| **x != 0).count() {
            1 => 16.0,
            2 => 22.0,
            _ => 27.0,
        };
        let hi: Vec<f32> = directions.coefficients().iter().map(length).collect();
        let lo = hi.iter().map(|x| -x).collect();
        Polytope::new(&Slabs { directions, basis: AXES, lo, hi }).unwrap()
    }

    /// Corners and edge lines are those of the solids.
    #[test]
    fn polytopes_are_known_solids() {
        // Cube, truncated octahedron, chamfered cube, truncated cuboctahedron.
        let counts = DirectionSet::ALL.map(|k| {
            let polytope = regular(k);
            (polytope.corners.len(), polytope.edges.len())
        });
        assert_eq!(counts, [(8, 3), (24, 6), (32, 7), (48, 9)]);
    }

    #[test]
    fn slack_slabs_do_not_support() {
        let mut slabs = Slabs {
            directions: DirectionSet::K18,
            basis: AXES,
            lo: vec![-1.0; 9],
            hi: vec![1.0; 9],
        };
        slabs.hi[3] = 50.0;
        slabs.lo[3] = -50.0;
        let polytope = Polytope::new(&slabs).unwrap();
        let top = polytope.rounded.iter().map(|xi| xi[0] + xi[1]).fold(f64::MIN, f64::max);
        assert!(top < 50.0, "x + y ≤ {top}");
    }

    #[test]
    fn flat_and_empty_slabs() {
        let point = Slabs {
            directions: DirectionSet::K26,
            basis: AXES,
            lo: vec![0.0; 13],
            hi: vec![0.0; 13],
        };
        let polytope = Polytope::new(&point).unwrap();
        assert_eq!((polytope.corners.len(), polytope.edges.len()), (1, 0));
        let mut empty = point;
        empty.lo[5] = 1.0;
        empty.hi[5] = 1.0;
        assert_eq!(Polytope::new(&empty).unwrap().corners.len(), 0);
    }

    #[test]
    fn inexact_bases_are_refused() {
        let mut slabs =
            Slabs { directions: DirectionSet::K6, basis: AXES, lo: vec![0.0; 3], hi: vec![1.0; 3] };
        slabs.basis[1][0] = 1e-30;
        assert_eq!(Polytope::new(&slabs).unwrap_err(), InvalidInput::Basis);
    }
}
