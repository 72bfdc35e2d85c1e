//! The direction sets of the k-DOPs: small integer combinations of an orthogonal basis.
//!
//! Directions are never normalised, so (1,1,0) = (1,0,0) + (0,1,0) holds to the bit and the support
//! of any axis can be bounded from the slabs alone (weak duality). All sets share one order: axes,
//! face diagonals, cube diagonals.

use crate::choice::choices;

/// All directions.
pub(crate) const K26: [[i8; 3]; 13] = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 1, 0],
    [1, -1, 0],
    [1, 0, 1],
    [1, 0, -1],
    [0, 1, 1],
    [0, 1, -1],
    [1, 1, 1],
    [-1, 1, 1],
    [1, -1, 1],
    [-1, -1, 1],
];
/// Axes and cube diagonals.
const K14: [[i8; 3]; 7] = {
    let [x, y, z, .., a, b, c, d] = K26;
    [x, y, z, a, b, c, d]
};

choices! {
    /// The slab directions of a k-DOP, as integer combinations of its orthogonal basis.
    DirectionSet, "k", {
        /// The three axes.
        K6 = "6",
        /// Axes and the four cube diagonals.
        K14 = "14",
        /// Axes and the six face diagonals: the Tribox set (Crosnier & Rossignac 1999).
        K18 = "18",
        /// Axes, face diagonals and cube diagonals.
        K26 = "26",
    }
}

impl DirectionSet {
    /// The coefficients of each direction with respect to the basis, in the order of all slab
    /// columns.
    #[must_use]
    pub const fn coefficients(self) -> &'static [[i8; 3]] {
        match self {
            Self::K6 => K26.split_at(3).0,
            Self::K14 => &K14,
            Self::K18 => K26.split_at(9).0,
            Self::K26 => &K26,
        }
    }

    /// The number of slabs, k/2.
    #[must_use]
    pub const fn slabs(self) -> usize {
        self.coefficients().len()
    }

    /// The number of half-spaces.
    #[must_use]
    pub const fn k(self) -> usize {
        2 * self.slabs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each set has k over two directions and none twice.
    #[test]
    fn direction_sets_have_k_halves() {
        for (set, k) in DirectionSet::ALL.iter().zip([6, 14, 18, 26]) {
            assert_eq!((set.k(), set.to_string()), (k, k.to_string()));
            let directions = set.coefficients();
            for (i, d) in directions.iter().enumerate() {
                let opposite = d.map(|c| -c);
                assert!(directions[i + 1..].iter().all(|e| e != d && *e != opposite));
            }
        }
    }

    #[test]
    fn the_sets_share_one_order() {
        let [k6, k14, k18, k26] = [0, 1, 2, 3].map(|i| DirectionSet::ALL[i].coefficients());
        assert_eq!((k18, &k26[9..]), (&k26[..9], &k14[3..]));
        assert_eq!((k6, k6), (&k14[..3], &k18[..3]));
        // Records and hashes depend on this order.
        let faces = [[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]];
        assert_eq!(k18[3..], faces);
        assert_eq!(k14[3..], [[1, 1, 1], [-1, 1, 1], [1, -1, 1], [-1, -1, 1]]);
    }
}
