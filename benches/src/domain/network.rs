//! What ranks need of the machine between them: a few collective calls, which all ranks make in the same order.
//!
//! Whoever carries the bytes, MPI or threads of one process, the rest of the room can't tell.

/// Ranks that can reach one another. Every call but the first two is collective: it returns when all ranks have made it.
pub trait Network {
    /// This rank, counted from 0.
    fn rank(&self) -> usize;

    /// How many ranks there are.
    fn size(&self) -> usize;

    /// Hands each rank its message, one a rank in their order; returns what each rank had for this one.
    fn exchange(&self, outgoing: Vec<Vec<u8>>) -> Vec<Vec<u8>>;

    /// The numbers of all ranks, one rank's after the other's. All give equally many.
    fn gather(&self, mine: &[u64]) -> Vec<u64>;

    /// Replaces each number by its sum over ranks, modulo 2⁶⁴.
    fn sum(&self, numbers: &mut [u64]);

    /// Replaces each number by the largest of all ranks.
    fn max(&self, numbers: &mut [u64]);
}

/// Every rank's message, given to all.
pub(super) fn tell_all(network: &impl Network, message: &[u8]) -> Vec<Vec<u8>> {
    network.exchange(vec![message.to_vec(); network.size()])
}

/// Every rank's message, given to rank 0 alone; nothing elsewhere.
pub(super) fn tell_first(network: &impl Network, message: Vec<u8>) -> Vec<Vec<u8>> {
    let mut outgoing = vec![Vec::new(); network.size()];
    outgoing[0] = message;
    network.exchange(outgoing)
}

/// The order of f32 as an order of numbers; −0 is 0.
pub(super) fn key(x: f32) -> u32 {
    let bits = (x + 0.0).to_bits();
    if bits >> 31 == 1 {
        !bits
    } else {
        bits | 1 << 31
    }
}

/// The f32 of a [`key`].
pub(super) fn of_key(key: u32) -> f32 {
    f32::from_bits(if key >> 31 == 1 {
        key & !(1 << 31)
    } else {
        !key
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_in_the_order_of_their_numbers() {
        let inf = f32::INFINITY;
        let ascending = [-inf, -2.5, -1.0e-40, 0.0, 1.0e-40, 1.0, f32::MAX, inf];
        assert!(ascending.windows(2).all(|two| key(two[0]) < key(two[1])));
        assert!(ascending.iter().all(|&x| of_key(key(x)) == x));
        assert_eq!(key(-0.0), key(0.0));
    }
}
