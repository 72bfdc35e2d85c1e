//! Pair finding: the paper's N(N−1)/2 pairs, less those of two bodies that cannot move.

/// All pairs i < j of which at least one is dynamic, in lexicographic order.
pub fn all_pairs(dynamic: &[bool]) -> impl Iterator<Item = (u32, u32)> {
    // A scene holds fewer than 2³² bodies: pairs are recorded as u32.
    let n = dynamic.len() as u32;
    let pairs = (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)));
    pairs.filter(|&(i, j)| dynamic[i as usize] || dynamic[j as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn static_pairs_are_left_out() {
        let found: Vec<_> = all_pairs(&[true, false, false, true]).collect();
        assert_eq!(found, [(0, 1), (0, 2), (0, 3), (1, 3), (2, 3)]);
    }
}
