//! The distance at which two things are just apart.

/// The last distance at which something isn't apart, and the next float, at which it is: between 0
/// and 16.
pub fn limit(apart: impl Fn(f32) -> bool) -> [f32; 2] {
    let (mut near, mut far) = (0.0f32, 16.0);
    while near.next_up() < far {
        // Halving the bits halves the number of floats between.
        let middle = f32::from_bits(near.to_bits().midpoint(far.to_bits()));
        *if apart(middle) { &mut far } else { &mut near } = middle;
    }
    [near, far]
}
