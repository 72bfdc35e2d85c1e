//! The separating-axis arithmetic once more, number by number on [`F`], so that a search can read τ
//! and the supports, which the culler's kernel only compares. `kernel.rs` compares both.

use sdop::overlap::ordop::table::{COEFFICIENTS, members_of};

use super::machine::F;

pub type V<const FLUSH: bool> = [F<FLUSH>; 3];

/// Slab ends by group and octant: the three axes, the pairs xy, xz, yz, and the cube diagonals.
pub type Table = [f32; 56];
/// First group of the pairs.
const PAIRS: usize = 3;
/// The group of the cube diagonals.
const DIAGONALS: usize = 6;

/// A direction's group, the octant of its upper end, and that of its opposite.
fn slab(member: usize) -> (usize, usize, usize) {
    let [x, y, z] = COEFFICIENTS[member];
    let bits = |bit: fn(i8) -> bool| {
        usize::from(bit(x)) | usize::from(bit(y)) << 1 | usize::from(bit(z)) << 2
    };
    let (plus, used) = (bits(|c| c < 0), bits(|c| c != 0));
    let group = match used {
        1 => 0,
        2 => 1,
        4 => 2,
        3 => PAIRS,
        5 => PAIRS + 1,
        6 => PAIRS + 2,
        _ => DIAGONALS,
    };
    (group, plus, plus ^ used)
}

/// A body's row: world directions of its basis, translation, offset of the slabs' centre.
pub struct Row<const FLUSH: bool> {
    pub axes: [V<FLUSH>; 3],
    pub t: V<FLUSH>,
    pub o: V<FLUSH>,
}

/// Two rows in each other's coordinates.
pub struct Frames<const FLUSH: bool> {
    /// `turn[i][j]`: axis i of A · axis j of B.
    pub turn: [V<FLUSH>; 3],
    /// The gap along A's axes, and the way back along B's.
    pub gap: [V<FLUSH>; 2],
}

/// Along an axis turned to face the other body: τ ≥ 0, and the supports that it must exceed.
#[derive(Clone, Copy, Debug)]
pub struct Axis<const FLUSH: bool> {
    /// τ before the turn: its sign is the side that was tested.
    pub raw: F<FLUSH>,
    pub tau: F<FLUSH>,
    pub own: F<FLUSH>,
    pub other: F<FLUSH>,
}

impl<const FLUSH: bool> Row<FLUSH> {
    pub fn new(axes: [[f32; 3]; 3], t: [f32; 3], o: [f32; 3]) -> Self {
        let v = |x: [f32; 3]| x.map(F::new);
        Self { axes: axes.map(v), t: v(t), o: v(o) }
    }
}

impl<const FLUSH: bool> Frames<FLUSH> {
    pub fn new(a: &Row<FLUSH>, b: &Row<FLUSH>) -> Self {
        let gap = [0, 1, 2].map(|i| (b.t[i] - a.t[i]) + (b.o[i] - a.o[i]));
        Self {
            turn: a.axes.map(|x| b.axes.map(|y| dot(x, y))),
            gap: [a.axes.map(|x| dot(x, gap)), b.axes.map(|x| F::ZERO - dot(x, gap))],
        }
    }

    /// A's slab normal `member`; tables of A and of B.
    pub fn normal(&self, k: usize, member: usize, a: &Table, b: &Table) -> Axis<FLUSH> {
        let c = COEFFICIENTS[member];
        let tau = combine(c, self.gap[0]);
        let e = [0, 1, 2].map(|j| combine(c, self.turn.map(|row| row[j])));
        let (group, plus, minus) = slab(member);
        let own = a[8 * group + if tau < F::ZERO { minus } else { plus }];
        let away = e.map(|x| x.flip(F::ZERO - tau));
        Axis { raw: tau, tau: tau.abs(), own: F::new(own), other: support(k, b, away) }
    }

    /// The cross product of two edges, in A's coordinates.
    pub fn edge_axis(&self, edge_a: [f32; 3], edge_b: [f32; 3]) -> V<FLUSH> {
        let [x, y, z] = edge_a.map(F::new);
        let f = self.turn.map(|row| dot(edge_b.map(F::new), row));
        [y * f[2] - z * f[1], z * f[0] - x * f[2], x * f[1] - y * f[0]]
    }

    /// Any vector in A's coordinates as an axis; `None` when too short.
    pub fn free(&self, k: usize, axis: V<FLUSH>, a: &Table, b: &Table) -> Option<Axis<FLUSH>> {
        if !(dot(axis, axis) > F::new(0.25)) {
            return None;
        }
        let tau = dot(axis, self.gap[0]);
        let towards = axis.map(|x| x.flip(tau));
        let away = [0, 1, 2].map(|j| F::ZERO - dot(self.turn.map(|row| row[j]), towards));
        Some(Axis {
            raw: tau,
            tau: tau.abs(),
            own: support(k, a, towards),
            other: support(k, b, away),
        })
    }
}

pub fn dot<const FLUSH: bool>(a: V<FLUSH>, b: V<FLUSH>) -> F<FLUSH> {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

/// c·v for coefficients from {−1, 0, 1}, left to right.
fn combine<const FLUSH: bool>(c: [i8; 3], v: V<FLUSH>) -> F<FLUSH> {
    let terms = c.iter().zip(v).filter(|(c, _)| **c != 0);
    let mut signed = terms.map(|(&c, x)| if c < 0 { -x } else { x });
    let first = signed.next().unwrap_or(F::ZERO);
    signed.fold(first, |sum, x| sum + x)
}

/// The multipliers of the slab groups in direction |e| = (a, b, c): axes, pairs ab ac bc, the
/// octant's cube diagonal and those bent over c, b, a.
pub struct Multipliers<const FLUSH: bool> {
    pub axes: V<FLUSH>,
    pub pairs: V<FLUSH>,
    pub diagonal: F<FLUSH>,
    pub bent: V<FLUSH>,
}

pub fn multipliers<const FLUSH: bool>(k: usize, [a, b, c]: V<FLUSH>) -> Multipliers<FLUSH> {
    let (zero, half) = (F::ZERO, F::new(0.5));
    let (ab, ac, bc) = (a.min(b), a.min(c), b.min(c));
    let low = ab.min(c);
    let leads = [(a - b.max(c)).max(zero), (b - a.max(c)).max(zero), (c - a.max(b)).max(zero)];
    let none = Multipliers { axes: [a, b, c], pairs: [zero; 3], diagonal: zero, bent: [zero; 3] };
    match k {
        6 => none,
        14 => Multipliers {
            axes: leads,
            diagonal: half * (ab.max(ac).max(bc) + low),
            bent: [ab, ac, bc].map(|x| half * (x - low)),
            ..none
        },
        18 => {
            let (a1, b1, c1) = (a.min(b + c), b.min(a + c), c.min(a + b));
            let pair = |x, y, z| (half * ((x + y) - z)).max(zero);
            Multipliers {
                axes: [a - a1, b - b1, c - c1],
                pairs: [pair(a1, b1, c1), pair(a1, c1, b1), pair(b1, c1, a1)],
                ..none
            }
        }
        _ => {
            Multipliers { axes: leads, pairs: [ab, ac, bc].map(|x| x - low), diagonal: low, ..none }
        }
    }
}

/// The weak-duality bound on the support in direction e.
pub fn support<const FLUSH: bool>(k: usize, table: &Table, e: V<FLUSH>) -> F<FLUSH> {
    let octant = e
        .iter()
        .enumerate()
        .map(|(i, x)| usize::from(x.get().is_sign_negative()) << i)
        .sum::<usize>();
    let facing = |group: usize, octant: usize| F::<FLUSH>::new(table[8 * group + octant]);
    let m = multipliers(k, e.map(F::abs));
    let axes = || {
        let [x, y, z] = [0, 1, 2].map(|i| m.axes[i] * facing(i, octant));
        (x + y) + z
    };
    let pairs = || [0, 1, 2].map(|i| m.pairs[i] * facing(PAIRS + i, octant));
    match k {
        6 => axes(),
        14 => {
            let [c, b, a] = [4, 2, 1].map(|bit| octant ^ bit);
            let bent = (m.bent[0] * facing(DIAGONALS, c) + m.bent[1] * facing(DIAGONALS, b))
                + m.bent[2] * facing(DIAGONALS, a);
            (m.diagonal * facing(DIAGONALS, octant) + bent) + axes()
        }
        18 => {
            let [ab, ac, bc] = pairs();
            ((ab + ac) + bc) + axes()
        }
        _ => {
            let [ab, ac, bc] = pairs();
            (m.diagonal * facing(DIAGONALS, octant) + ((ab + ac) + bc)) + axes()
        }
    }
}

/// A table from the ends of the members' slabs, [lo, hi] each.
pub fn table(k: usize, ends: impl Fn(usize) -> [f32; 2]) -> Table {
    let mut table = [0.0; 56];
    for &member in members_of(k) {
        let ([lo, hi], (group, plus, minus)) = (ends(member), slab(member));
        let used = plus ^ minus;
        for octant in 0..8 {
            if octant & used == plus & used {
                table[8 * group + octant] = hi;
            } else if octant & used == minus & used {
                table[8 * group + octant] = -lo;
            }
        }
    }
    table
}
