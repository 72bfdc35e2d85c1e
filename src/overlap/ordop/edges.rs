//! Edge directions of a k-DOP, up to sign: the cross products of its slab normals, as integer
//! coefficients.
//!
//! An edge of a polytope is in two of its facets, so it is parallel to the cross product of their
//! normals. Which of these edges a DOP has depends on its slabs. Trying all of them is
//! conservative, and the same for every body.

/// 3 axes; with cube or face diagonals also the 6 face diagonals; face diagonals bring the 4 cube
/// diagonals, and both diagonals together the 12 of type (1, 1, 2).
const EDGES: [[f32; 3]; 25] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, 1.0, -1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [1.0, -1.0, 1.0],
    [-1.0, -1.0, 1.0],
    [2.0, 1.0, 1.0],
    [-2.0, 1.0, 1.0],
    [2.0, -1.0, 1.0],
    [2.0, 1.0, -1.0],
    [1.0, 2.0, 1.0],
    [-1.0, 2.0, 1.0],
    [1.0, -2.0, 1.0],
    [1.0, 2.0, -1.0],
    [1.0, 1.0, 2.0],
    [-1.0, 1.0, 2.0],
    [1.0, -1.0, 2.0],
    [1.0, 1.0, -2.0],
];

/// The edge directions of a DOP with k half-spaces.
#[must_use]
pub fn of(k: usize) -> &'static [[f32; 3]] {
    match k {
        6 => &EDGES[..3],
        14 => &EDGES[..9],
        18 => &EDGES[..13],
        _ => &EDGES,
    }
}

#[cfg(test)]
mod tests {
    use super::super::table::{COEFFICIENTS, members_of};
    use super::*;

    /// Edges are all cross products of the normals up to sign and length.
    #[test]
    fn edges_are_normals_cross_products() {
        for k in [6, 14, 18, 26] {
            let mut found = std::collections::BTreeSet::new();
            for &i in members_of(k) {
                for &j in members_of(k) {
                    let [a, b] = [COEFFICIENTS[i], COEFFICIENTS[j]].map(|c| c.map(i32::from));
                    let v = [
                        a[1] * b[2] - a[2] * b[1],
                        a[2] * b[0] - a[0] * b[2],
                        a[0] * b[1] - a[1] * b[0],
                    ];
                    found.extend((v != [0; 3]).then(|| primitive(v)));
                }
            }
            let listed = of(k).iter().map(|e| primitive(e.map(|x| x as i32)));
            assert_eq!(listed.collect::<std::collections::BTreeSet<_>>(), found, "k = {k}");
            assert_eq!(of(k).len(), found.len());
        }
    }

    /// Shortest integer multiple, the first non-zero coordinate positive.
    fn primitive(v: [i32; 3]) -> [i32; 3] {
        let gcd = v.iter().fold(0i32, |a, &b| {
            let (mut a, mut b) = (a.abs(), b.abs());
            while b != 0 {
                (a, b) = (b, a % b);
            }
            a
        });
        let sign = v.iter().find(|&&x| x != 0).map_or(1, |x| x.signum());
        v.map(|x| x / gcd * sign)
    }
}
