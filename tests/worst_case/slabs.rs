//! Attacks on the separating-axis test: how far rounding alone, slabs uninflated, favours
//! separation.
//!
//! A body is one vertex with its slabs about c, or a box (k = 6), both rounded outward to f32 but
//! without the margin: their exact supports are known, and `τ − fl(h_A + h_B)` computed minus
//! exact, over u·(ρ_A + ρ_B)·‖a‖, is what the margin must exceed. Quaternions are f64 here, so that
//! a search can turn a body by less than an ulp of its axes.

use sdop::overlap::ordop::edges;
use sdop::overlap::ordop::table::{COEFFICIENTS, members_of};
use sdop::rounding::pose::{rotate, world_axes};
use sdop::rounding::{FLUSH, U};

use super::climb::{Random, climb};
use super::exact::{apply, apply_transposed, dot, norm, rotation};
use super::machine::F;
use super::ordop::{Axis, Frames, Row, Table, multipliers, table};

const IDENTITY: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// What a search tries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    pub k: usize,
    /// Axes edge × edge instead of slab normals.
    pub edges: bool,
    /// Slab centres away from the body origins.
    pub offset: bool,
    /// Boxes of half sizes |x| instead of single vertices x; k = 6.
    pub boxes: bool,
}

/// A posed vertex or box with its slabs.
struct Solid {
    rotation: [[f64; 3]; 3],
    /// Vertex from the slabs' centre, or half sizes.
    arm: [f64; 3],
    boxed: bool,
    centre: [f64; 3],
    t: [f32; 3],
    table: Table,
    /// ρ as the margin takes it: ‖x‖ + ‖c‖; the largest half size of a box.
    reach: f64,
}

impl Solid {
    fn new(target: Target, q: [f64; 4], x: [f32; 3], c: [f32; 3]) -> Self {
        let (vertex, centre) = (x.map(f64::from), c.map(f64::from));
        let arm = [0, 1, 2].map(|i| vertex[i] - centre[i]);
        let ends = |member: usize| {
            let along = dot(COEFFICIENTS[member].map(f64::from), arm);
            if target.boxes {
                return [-(along as f32).abs(), (along as f32).abs()];
            }
            let (lo, hi) = (along.min(0.0) as f32, along.max(0.0) as f32);
            [
                if f64::from(lo) > along { lo.next_down() } else { lo },
                if f64::from(hi) < along { hi.next_up() } else { hi },
            ]
        };
        let largest = vertex.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        Self {
            rotation: rotation(q),
            arm,
            boxed: target.boxes,
            centre,
            t: [0.0; 3],
            table: table(target.k, ends),
            reach: if target.boxes { largest } else { norm(vertex) + norm(centre) },
        }
    }

    fn row<const FLUSH: bool>(&self) -> Row<FLUSH> {
        let offset = rotate(&self.rotation, self.centre.map(|x| x as f32)).map(|x| x as f32);
        Row::new(world_axes(&self.rotation, IDENTITY), self.t, offset)
    }

    /// The exact support of the solid and its centre in a direction of the body frame.
    fn support(&self, direction: [f64; 3]) -> f64 {
        if self.boxed {
            dot(direction.map(f64::abs), self.arm.map(f64::abs))
        } else {
            dot(direction, self.arm).max(0.0)
        }
    }
}

/// q_A, q_B, x_A, x_B, t_A, shift of t_B, c_A, c_B, two picks of axes, low parts of q_A and q_B.
const N: usize = 36;

/// Largest error in units of u·(ρ_A + ρ_B)·‖a‖.
pub fn rounding(target: Target, seed: u64, evaluations: u64) -> f64 {
    let start = |random: &mut Random| start(random, target, 1.0);
    let score = |p: &[f32; N]| {
        attack::<false>(target, p)
            .map_or(f64::NEG_INFINITY, |found| found.error / (U * found.reach * found.length))
    };
    climb(seed, evaluations, start, score).0
}

/// Largest error in units of 2⁻¹²⁶·‖a‖ among bodies so small that their relative errors vanish.
pub fn underflow<const FLUSHED: bool>(target: Target, seed: u64, evaluations: u64) -> f64 {
    let start = |random: &mut Random| {
        let exponent = random.below(22) as i32 + 112;
        start(random, target, 2.0f32.powi(-exponent))
    };
    let score = |p: &[f32; N]| match attack::<FLUSHED>(target, p) {
        Some(found) if found.reach < 65536.0 * FLUSH => found.error / (FLUSH * found.length),
        _ => f64::NEG_INFINITY,
    };
    climb(seed, evaluations, start, score).0
}

fn start(random: &mut Random, target: Target, scale: f32) -> [f32; N] {
    let mut p = std::array::from_fn(|_| random.signed());
    p[8..26].iter_mut().for_each(|x| *x *= scale);
    p[17..20].iter_mut().for_each(|x| *x *= if target.boxes { 2.0 } else { 0.01 });
    if !target.offset {
        p[20..26].fill(0.0);
    }
    p
}

struct Found {
    /// (τ − fl(h_A + h_B)) computed minus exact.
    error: f64,
    /// ρ_A + ρ_B.
    reach: f64,
    /// ‖a‖.
    length: f64,
}

/// One axis of one pair; `None` outside what the proof covers.
fn attack<const FLUSH: bool>(target: Target, p: &[f32; N]) -> Option<Found> {
    let three = |i: usize| [p[i], p[i + 1], p[i + 2]];
    let q = |i: usize| [0, 1, 2, 3].map(|j| f64::from(p[i + j]) + f64::from(p[28 + i + j]) * U);
    let centre = |i: usize| if target.offset { three(i) } else { [0.0; 3] };
    let mut a = Solid::new(target, q(0), three(8), centre(20));
    let mut b = Solid::new(target, q(4), three(11), centre(23));
    place(&mut a, &mut b, three(14), three(17));

    let frames = Frames::<FLUSH>::new(&a.row(), &b.row());
    let (axis, direction) = pick_axis(target, &frames, &a, &b, [p[26], p[27]])?;
    if axis.raw == F::ZERO {
        return None; // culls nothing, whatever the supports
    }
    let (reach, length) = (a.reach + b.reach, norm(direction));
    let farthest = if target.edges { 1.73 } else { 3.0 };
    let gap = gap(&a, &b);
    let facing = if axis.raw < F::ZERO { -1.0 } else { 1.0 };
    let world = apply(&a.rotation, direction.map(|x| facing * x));
    let away = apply_transposed(&b.rotation, world).map(|x| -x);
    let own = a.support(direction.map(|x| facing * x));
    let exact = dot(world, gap) - own - b.support(away);
    let computed = axis.tau.real() - (axis.own + axis.other).real();
    (norm(gap) <= farthest * reach && computed.is_finite()).then_some(Found {
        error: computed - exact,
        reach,
        length,
    })
}

/// Puts B's vertex on A's (a box's centre on A's), but for the shift and the rounding of t.
fn place(a: &mut Solid, b: &mut Solid, t: [f32; 3], shift: [f32; 3]) {
    let vertex = |s: &Solid| {
        let x = [0, 1, 2].map(|i| if s.boxed { 0.0 } else { s.arm[i] + s.centre[i] });
        apply(&s.rotation, x)
    };
    let (xa, xb) = (vertex(a), vertex(b));
    a.t = t;
    b.t = [0, 1, 2].map(|i| (f64::from(t[i]) + xa[i] - xb[i] + f64::from(shift[i])) as f32);
}

/// The exact way from centre to centre.
fn gap(a: &Solid, b: &Solid) -> [f64; 3] {
    let (oa, ob) = (apply(&a.rotation, a.centre), apply(&b.rotation, b.centre));
    [0, 1, 2].map(|i| (f64::from(b.t[i]) - f64::from(a.t[i])) + (ob[i] - oa[i]))
}

/// The axis that the two picks in [−1, 1] name, as computed, with its direction in A's frame.
fn pick_axis<const FLUSH: bool>(
    target: Target,
    frames: &Frames<FLUSH>,
    a: &Solid,
    b: &Solid,
    picks: [f32; 2],
) -> Option<(Axis<FLUSH>, [f64; 3])> {
    let index = |pick: f32, n: usize| ((pick.abs() * n as f32) as usize).min(n - 1);
    if target.edges {
        let edges = edges::of(target.k);
        let [e, f] = picks.map(|pick| edges[index(pick, edges.len())]);
        let axis = frames.edge_axis(e, f);
        Some((frames.free(target.k, axis, &a.table, &b.table)?, axis.map(F::real)))
    } else {
        let members = members_of(target.k);
        let member = members[index(picks[0], members.len())];
        let axis = frames.normal(target.k, member, &a.table, &b.table);
        Some((axis, COEFFICIENTS[member].map(f64::from)))
    }
}

/// How far the support multipliers combine from e, in u·‖e‖.
pub fn multiplier(k: usize, seed: u64, evaluations: u64) -> f64 {
    let start = |random: &mut Random| std::array::from_fn(|_| random.between(0.0, 1.0));
    climb(seed, evaluations, start, |e: &[f32; 3]| {
        let e = e.map(f32::abs);
        let m = multipliers(k, e.map(F::<false>::new));
        let [axes, pairs, [over_c, over_b, over_a]] =
            [m.axes, m.pairs, m.bent].map(|v| v.map(F::real));
        let all = m.diagonal.real();
        let reached = [
            axes[0] + pairs[0] + pairs[1] + all + over_c + over_b - over_a,
            axes[1] + pairs[0] + pairs[2] + all + over_c - over_b + over_a,
            axes[2] + pairs[1] + pairs[2] + all - over_c + over_b + over_a,
        ];
        let e = e.map(f64::from);
        norm([0, 1, 2].map(|i| reached[i] - e[i])) / (U * norm(e))
    })
    .0
}
