//! Vectors and rotations over any [`Number`], computed in the order in which the formulas are
//! written.

use crate::number::Number;

/// A column vector.
pub type Vector<N> = [N; 3];
/// A matrix as three rows.
pub type Matrix<N> = [[N; 3]; 3];

/// a·b
pub fn dot<N: Number>(a: &Vector<N>, b: &Vector<N>) -> N {
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
}

/// a × b
pub fn cross<N: Number>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    let minor = |i: usize, j: usize| a[i].times(&b[j]).minus(&a[j].times(&b[i]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// a + b
pub fn add<N: Number>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    [0, 1, 2].map(|i| a[i].plus(&b[i]))
}

/// a − b
pub fn sub<N: Number>(a: &Vector<N>, b: &Vector<N>) -> Vector<N> {
    [0, 1, 2].map(|i| a[i].minus(&b[i]))
}

/// s·a
pub fn scale<N: Number>(s: &N, a: &Vector<N>) -> Vector<N> {
    [0, 1, 2].map(|i| s.times(&a[i]))
}

/// M·a
pub fn apply<N: Number>(m: &Matrix<N>, a: &Vector<N>) -> Vector<N> {
    [0, 1, 2].map(|i| dot(&m[i], a))
}

/// Mᵀ
pub fn transpose<N: Number>(m: &Matrix<N>) -> Matrix<N> {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| m[j][i].clone()))
}

/// L·M
pub fn multiply<N: Number>(l: &Matrix<N>, m: &Matrix<N>) -> Matrix<N> {
    let columns = transpose(m);
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| dot(&l[i], &columns[j])))
}

/// |v|∞
pub fn largest(v: &Vector<f64>) -> f64 {
    v.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// Small integers as a vector of numbers.
pub fn integers<N: Number>(a: [i32; 3]) -> Vector<N> {
    a.map(N::integer)
}

/// |q|² of a quaternion.
pub fn norm_squared<N: Number>(q: &[N; 4]) -> N {
    dot(&[q[0].clone(), q[1].clone(), q[2].clone()], &[q[0].clone(), q[1].clone(), q[2].clone()])
        .plus(&q[3].times(&q[3]))
}

/// R(q), the rotation by the quaternion (x, y, z, w) times |q|²: quadratic in q, free of divisions.
pub fn rotation<N: Number>(q: &[N; 4]) -> Matrix<N> {
    let [x, y, z, w] = q;
    let square = [x, y, z].map(|a| a.times(a));
    let real = w.times(w);
    // Diagonal: w² + a² − b² − c².
    let diagonal =
        |a: usize, b: usize, c: usize| real.plus(&square[a]).minus(&square[b]).minus(&square[c]);
    let twice = |a: N| a.plus(&a);
    let (xy, xz, yz) = (x.times(y), x.times(z), y.times(z));
    let (wx, wy, wz) = (w.times(x), w.times(y), w.times(z));
    [
        [diagonal(0, 1, 2), twice(xy.minus(&wz)), twice(xz.plus(&wy))],
        [twice(xy.plus(&wz)), diagonal(1, 0, 2), twice(yz.minus(&wx))],
        [twice(xz.minus(&wy)), twice(yz.plus(&wx)), diagonal(2, 0, 1)],
    ]
}

/// The product conj(a)·b, whose rotation is R(a)ᵀR(b).
pub fn conjugate_product<N: Number>(a: &[N; 4], b: &[N; 4]) -> [N; 4] {
    let imaginary = |i: usize| [&a[i], &b[i]];
    let component = |i: usize, j: usize, k: usize| {
        // w_a b_i − a_i w_b − (a × b)_i
        let [ai, bi] = imaginary(i);
        a[3].times(bi).minus(&ai.times(&b[3])).minus(&a[j].times(&b[k]).minus(&a[k].times(&b[j])))
    };
    let real = (0..4).map(|i| a[i].times(&b[i])).reduce(|s, p| s.plus(&p));
    [
        component(0, 1, 2),
        component(1, 2, 0),
        component(2, 0, 1),
        real.unwrap_or_else(|| N::integer(0)),
    ]
}

#[cfg(test)]
mod tests {
    use dashu_int::IBig;

    use super::*;

    #[test]
    fn rotations_compose_exactly() {
        let a = [3, -5, 7, 11].map(IBig::from);
        let b = [-2, 13, 1, 4].map(IBig::from);
        let relative = multiply(&transpose(&rotation(&a)), &rotation(&b));
        assert_eq!(rotation(&conjugate_product(&a, &b)), relative);
        let square = multiply(&transpose(&relative), &relative);
        let norm = norm_squared(&a).times(&norm_squared(&b));
        for (i, row) in square.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                assert_eq!(*entry, if i == j { norm.times(&norm) } else { IBig::ZERO });
            }
        }
    }

    /// A quarter turn about z takes x to y.
    #[test]
    fn quarter_turn_takes_x_to_y() {
        let q = [0.0, 0.0, 1.0, 1.0];
        let image = apply(&rotation(&q), &[1.0, 0.0, 0.0]);
        assert_eq!(image, [0.0, 2.0, 0.0]);
    }
}
