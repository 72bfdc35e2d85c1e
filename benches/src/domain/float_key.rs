//! f32 as whole numbers of the same order, whose digits a radix selection can take one by one.

/// The order of f32 as an order of numbers; −0 is 0.
pub(super) fn key(x: f32) -> u32 {
    let bits = (x + 0.0).to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

/// The f32 of a [`key`].
pub(super) fn of_key(key: u32) -> f32 {
    f32::from_bits(if key >> 31 == 1 { key & !(1 << 31) } else { !key })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keys are in the order of their numbers.
    #[test]
    fn keys_order_as_numbers() {
        let inf = f32::INFINITY;
        let ascending = [-inf, -2.5, -1.0e-40, 0.0, 1.0e-40, 1.0, f32::MAX, inf];
        assert!(ascending.windows(2).all(|two| key(two[0]) < key(two[1])));
        assert!(ascending.iter().all(|&x| of_key(key(x)) == x));
        assert_eq!(key(-0.0), key(0.0));
    }
}
