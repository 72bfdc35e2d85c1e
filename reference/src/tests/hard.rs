//! Pairs of poses that a rounding test gets wrong: seeded draws from families with exact contacts,
//! tiny and huge sizes, far translations, quaternions of any norm.

use super::shapes::Draws;
use crate::Pose;
use crate::linear::{apply, rotation, transpose};

/// Two poses and the power of two that the bodies' sizes should have to be near one another.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Body A.
    pub a: Pose,
    /// Body B.
    pub b: Pose,
    /// Sizes of order 2^size.
    pub size: i32,
}

impl Draws {
    fn below(&mut self, n: u64) -> u64 {
        self.bits() % n
    }

    /// A non-zero quaternion of components in {−1, 0, 1}: turns by 90°, 120°, 180°.
    fn grid_quaternion(&mut self) -> [f32; 4] {
        loop {
            let q = [(); 4].map(|()| self.below(3) as f32 - 1.0);
            if q != [0.0; 4] {
                return q;
            }
        }
    }

    fn quaternion(&mut self) -> [f32; 4] {
        let q = match self.below(4) {
            0 | 1 => self.grid_quaternion(),
            // Pythagorean: (3, 4) and (5, 12) turns about an axis.
            2 => {
                let mut q = [0.0; 4];
                q[self.below(3) as usize] = [0.5, 1.5, 0.2][self.below(3) as usize];
                q[3] = 1.0;
                q
            }
            _ => [(); 4].map(|()| self.signed(1.0) + 1e-3),
        };
        let norm = [1.0, -1.0, 1e18, 1e-18, 1.0 + 1e-6, 3e-23, 1e37][self.below(7) as usize];
        q.map(|x| x * norm)
    }

    /// A translation of order `scale`: on a grid of halves of it, of integer length, or neither.
    fn translation(&mut self, scale: f32) -> [f32; 3] {
        match self.below(8) {
            0 => self.vector(2.0 * scale),
            1..4 => {
                let quadruples = [[1, 2, 2], [2, 3, 6], [1, 4, 8], [4, 4, 7], [3, 4, 0], [1, 0, 0]];
                let v = quadruples[self.below(6) as usize].map(|x| x as f32 / 4.0 * scale);
                let first = self.below(3) as usize;
                [v[first], v[(first + 1) % 3], -v[(first + 2) % 3]]
            }
            _ => [(); 3].map(|()| (self.below(9) as f32 - 4.0) / 2.0 * scale),
        }
    }

    /// Two poses that put bodies of size 2^size near one another.
    pub fn hard_case(&mut self) -> Case {
        let size = [0, 0, 0, 59, -60, -140, 20][self.below(7) as usize];
        let power = |e: i32| crate::number::power_of_two(e.clamp(-149, 59)) as f32;
        let scale = power(size);
        let origin = match self.below(7) {
            // As far as may be: bodies of this size are in one place or nowhere near.
            0 => self.translation(power(59)),
            // Far from the origin, where f32 has few digits left for the body's size.
            1 | 2 => self.translation(power(size + 20)),
            // Off by far less than an f32 of the size could say: contact misses or holds by 2⁻²⁰ to
            // 2⁻⁶⁰.
            3 | 4 => {
                let tiny = power(size - 20 - self.below(40) as i32);
                self.translation(tiny)
            }
            _ => [0.0; 3],
        };
        let (qa, qb) = (self.quaternion(), self.quaternion());
        let step = self.translation(0.5 * scale);
        let mut tb = [0, 1, 2].map(|i| origin[i] + step[i]);
        if self.below(3) == 0 {
            let i = self.below(3) as usize;
            tb[i] = if self.below(2) == 0 { tb[i].next_up() } else { tb[i].next_down() };
        }
        let qb = if self.below(5) == 0 { qa } else { qb };
        let tb = if self.below(9) == 0 { origin } else { tb };
        let pose = |q, t| Pose::new(q, t).unwrap();
        Case { a: pose(qa, origin), b: pose(qb, tb), size }
    }
}

/// Exact contacts that no float sees: B is turned against A by g = (1, 2, 3, 5), whose matrix is
/// integers over 39. The A-frame point 39v is the B-frame point [`turned_back`] v.
pub const TURN: f32 = 39.0;

/// R(g)ᵀv without the division: integers for integers.
pub fn turned_back(v: [f32; 3]) -> [f32; 3] {
    let rows = transpose(&rotation(&[1.0, 2.0, 3.0, 5.0]));
    apply(&rows, &v.map(f64::from)).map(|x| x as f32)
}

impl Draws {
    /// Poses of A and B with qB = qA g, in small integers times any powers of two, at one place.
    pub fn turned_poses(&mut self) -> (Pose, Pose) {
        let [x, y, z] = [(); 3].map(|()| self.below(7) as f32 - 3.0);
        let w = 1.0 + self.below(4) as f32;
        // Hamilton product of (x, y, z, w) and (1, 2, 3, 5).
        let b = [
            w + 5.0 * x + 3.0 * y - 2.0 * z,
            2.0 * w - 3.0 * x + 5.0 * y + z,
            3.0 * w + 2.0 * x - y + 5.0 * z,
            5.0 * w - x - 2.0 * y - 3.0 * z,
        ];
        let norm = [1.0, 2.0_f32.powi(60), 2.0_f32.powi(-60)][self.below(3) as usize];
        let place = self.vector(100.0);
        let pose = |q: [f32; 4], norm| Pose::new(q.map(|x| x * norm), place).unwrap();
        (pose([x, y, z, w], norm), pose(b, 1.0 / norm))
    }
}
