//! Scenes built from the grid's own arithmetic: extents, centres and reaches on the borders between
//! its cells, a few units in the last place of f64 to either side.
//!
//! A random coordinate comes that close to a border once in 2⁵⁰ draws, so random scenes can't
//! distinguish a cell found by rounding half to even from one counted by a division that rounds
//! half away from zero. Here the lowest centre, which is the grid's origin, or the coordinate on
//! the border is so small that its last place moves a quotient by the quotient's last place. One
//! function makes all choices, "a number below n". It can be a random generator, or a fuzzer that
//! is guided by coverage.

use sdop::bodies::Bodies;
use sdop::broad_phase::{BallBounds, Cells, TableLayout};
use sdop::culler::{CullError, Culler};
use sdop::mesh::TriangleMesh;
use sdop::rounding::{sphere::inflate_radius, widen};
use sdop::settings::{CullSettings, Finder, Strategy};
use sdop::simd::Tier;
use sdop::volume::{Axes, DirectionSet, Origin, Shape, ShapeSpec, VolumeError};

/// Chooses a number below the given one, which is at least 1.
pub type NumberChoice<'a> = &'a mut dyn FnMut(u32) -> u32;

/// Bars about their own origins, unturned, at rest.
#[derive(Clone, Debug)]
pub struct Borders {
    /// Radius of each shape's ball.
    pub radii: [f32; 2],
    /// The bodies.
    pub bodies: Bodies,
    /// Whether the extent along some axis is so near to a border that a division rounded half away
    /// from zero gives another number of cells than a product rounded half to even.
    pub divides: bool,
}

/// A finder's list that isn't that of all pairs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FinderDifference {
    /// The finder that is wrong.
    pub finder: Finder,
    /// In which frame.
    pub frame: usize,
    /// Pairs that it lacks.
    pub lost: Vec<[u32; 2]>,
    /// Pairs beyond those that there are, such as one reported twice.
    pub surplus: usize,
}

/// A thin body whose ball has about its origin the given radius, which is at least 1e-30.
///
/// # Errors
/// A radius beyond 2⁶⁰.
pub fn bar(radius: f32) -> Result<Shape, VolumeError> {
    let ShapeSpec { directions, axes, .. } = ShapeSpec::default();
    bar_within(radius, directions, axes)
}

/// The same with slabs along these directions and axes.
///
/// # Errors
/// As [`bar`].
pub fn bar_within(radius: f32, directions: DirectionSet, axes: Axes) -> Result<Shape, VolumeError> {
    // The ball of its farthest vertices is rounded up by one step.
    let (reach, half) = (radius.next_down(), radius / 2.0);
    let vertices = [[reach, 0.0, 0.0], [-reach, 0.0, 0.0], [0.0, half, 0.0], [0.0, 0.0, half]];
    let mesh = TriangleMesh {
        name: "bar".to_owned(),
        vertices: vertices.map(Into::into).to_vec(),
        triangles: vec![[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]],
        ..TriangleMesh::default()
    };
    let spec = ShapeSpec { origin: Origin::File, directions, axes, ..ShapeSpec::default() };
    Shape::build(&mesh, &spec)
}

impl Borders {
    /// Each finder's list against that of all pairs, over some frames in which nothing moves, so
    /// that places are reordered. The first difference, and how many pairs there are.
    ///
    /// # Errors
    /// Settings that lack something, bodies outside of the contract.
    pub fn judge(
        &self,
        shapes: &[Shape],
        settings: &CullSettings,
        tier: Tier,
        frames: usize,
    ) -> Result<(usize, Option<FinderDifference>), CullError> {
        let culler = |pairs: Finder| {
            let settings = CullSettings { pairs, ..settings.clone() };
            Culler::builder().settings(&settings).tier(tier).build(shapes, &self.bodies)
        };
        let wanted = culler(Finder::AllPairs)?.cull(&self.bodies)?.sorted();
        for &finder in Finder::ALL {
            let mut culler = culler(finder)?;
            for frame in 0..frames {
                let found = culler.cull(&self.bodies)?.sorted();
                if found != wanted {
                    let lost: Vec<_> = wanted.iter().filter(|pair| !found.contains(pair)).collect();
                    let surplus = found.len() + lost.len() - wanted.len();
                    let lost = lost.into_iter().copied().collect();
                    let difference = FinderDifference { finder, frame, lost, surplus };
                    return Ok((wanted.len(), Some(difference)));
                }
            }
        }
        Ok((wanted.len(), None))
    }

    /// The settings that the scenes are made for.
    #[must_use]
    pub fn settings() -> CullSettings {
        CullSettings { strategy: Strategy::Sphere, ..CullSettings::default() }
    }

    /// A scene.
    pub fn draw(choose: NumberChoice<'_>) -> Self {
        BorderDraw { choose }.scene()
    }
}

/// What lies on a border along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BorderItem {
    /// Nothing: all centres have one coordinate.
    Nothing,
    /// The farthest centre.
    Extent,
    /// One between.
    Centre,
    /// A seeker's reach downward, and upward.
    Below,
    Above,
}

/// Coordinates along one axis.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    /// The lowest and the highest centre of the level that has the border.
    lo: f32,
    hi: f32,
    /// A centre of interest in it.
    target: f32,
    /// One of the other level whose reach ends on a border.
    seeker: Option<f32>,
}

/// What is the same for all axes.
#[derive(Clone, Copy, Debug)]
struct BorderPlan {
    radii: [f32; 2],
    /// The level's widest ball, as inflated.
    widest: f32,
    bodies: usize,
    layout: TableLayout,
}

impl BorderPlan {
    fn cells(&self, axes: &[Axis; 3]) -> Cells {
        let bounds = BallBounds {
            lo: axes.map(|axis| axis.lo),
            hi: axes.map(|axis| axis.hi),
            widest: self.widest,
        };
        Cells::fit(&bounds, self.bodies, self.layout)
    }

    /// How far centres of a target and a seeker that touch lie apart.
    fn touch(&self) -> f64 {
        self.radii.iter().map(|&r| f64::from(r)).sum()
    }

    /// How far a seeker looks.
    fn reach(&self) -> f64 {
        let wide = self.radii.map(|r| f64::from(widen(inflate_radius(r))));
        wide[0] + wide[1]
    }
}

struct BorderDraw<'a> {
    choose: NumberChoice<'a>,
}

impl BorderDraw<'_> {
    fn below(&mut self, n: u32) -> u32 {
        (self.choose)(n)
    }

    fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len() as u32) as usize]
    }

    /// A number in [0, 1).
    fn unit(&mut self) -> f64 {
        f64::from(self.below(1 << 24)) / f64::from(1 << 24)
    }

    /// Moves a positive number by a few of its last places.
    fn nudge(&mut self, x: f64) -> f64 {
        let ulps = self.pick(&[-1, -1, -1, 0, 0, 1, 1, -2, 2, -3, 3]);
        f64::from_bits(x.to_bits().wrapping_add_signed(ulps))
    }

    fn nudge_f32(&mut self, x: f32) -> f32 {
        match self.below(5) {
            0 => x.next_down(),
            1 => x.next_up(),
            2 => x.next_up().next_up(),
            _ => x,
        }
    }

    fn scene(mut self) -> Borders {
        let (target_moves, seeker_moves) =
            self.pick(&[(true, true), (false, true), (false, true), (true, false)]);
        let exponent = self.pick(&[0, 0, 0, 0, -60, -20, 30, 45]);
        let radius = ((1.0 + self.unit()) * f64::from(exponent).exp2()) as f32;
        let ratio = self.pick(&[1.0, 1.0, 1.0, 0.5, 2.0, 8.0, 300.0, 1.0 / 8.0, 1.0 / 300.0]);
        let mut other = radius * ratio;
        if self.below(2) == 0 {
            other = self.nudge_f32(other);
        }
        let radii = [radius, other];
        let fill = self.pick(&[0, 4, 40, 40, 200]);
        let joint = target_moves == seeker_moves && self.below(2) == 0;
        let plan = BorderPlan {
            radii,
            widest: inflate_radius(if joint { radius.max(other) } else { radius }),
            bodies: (CORNERS + fill) as usize,
            layout: self.pick(&[TableLayout::Box, TableLayout::Box, TableLayout::Wrapped]),
        };
        let (axes, size, divides) = self.axes(&plan);
        let mut scene = Borders { radii, bodies: Bodies::default(), divides };
        self.fill(&mut scene.bodies, &plan, &axes, (fill, size), [target_moves, seeker_moves]);
        scene
    }

    /// Extents first, whose cells have some size; then coordinates on the borders between cells of
    /// that size.
    fn axes(&mut self, plan: &BorderPlan) -> ([Axis; 3], f64, bool) {
        let least = plan.cells(&[Axis::default(); 3]).size();
        let on: [BorderItem; 3] = std::array::from_fn(|_| {
            self.pick(&[
                BorderItem::Nothing,
                BorderItem::Nothing,
                BorderItem::Extent,
                BorderItem::Extent,
                BorderItem::Extent,
                BorderItem::Centre,
                BorderItem::Below,
                BorderItem::Above,
            ])
        });
        let scale = self.pick(&[0, 0, 0, 1, 1, 2]);
        let cells: [f64; 3] = std::array::from_fn(|k| match (on[k], scale) {
            (BorderItem::Nothing, _) => 0.0,
            (_, 0) => f64::from(self.below(6)),
            (_, 1) => f64::from(self.below(90)),
            // Far clusters, within the contract.
            _ => f64::from(self.below(28)).exp2() * (1.0 + self.unit()),
        });
        let rough = cells
            .map(|n| Axis { hi: (n * least).min((1u64 << 58) as f64) as f32, ..Axis::default() });
        let size = plan.cells(&rough).size();
        let axes = std::array::from_fn(|k| {
            let number = (f64::from(rough[k].hi) / size).floor();
            self.axis(plan, on[k], number, size)
        });
        let fitted = plan.cells(&axes).size();
        let divides = (0..3).any(|k| {
            let extent = f64::from(axes[k].hi) - f64::from(axes[k].lo);
            let (by_division, by_product) = (extent / fitted, extent * (1.0 / fitted));
            by_division.round() != by_product.round_ties_even()
        });
        (axes, size, divides)
    }

    fn axis(&mut self, plan: &BorderPlan, on: BorderItem, number: f64, size: f64) -> Axis {
        let border = (number + 0.5) * size;
        let border = self.nudge(border);
        let beyond = self.pick(&[0.0, 0.0, 1.0, 2.0]) * self.unit() * size;
        let (lo, x) = match on {
            BorderItem::Nothing => return Axis::default(),
            BorderItem::Extent | BorderItem::Centre => self.apart(border),
            BorderItem::Below => self.apart(border + plan.reach()),
            BorderItem::Above => self.apart(border - plan.reach()),
        };
        let touching = match on {
            BorderItem::Below => f64::from(x) - plan.touch(),
            BorderItem::Above => f64::from(x) + plan.touch(),
            _ => f64::from(x),
        };
        let mut target = touching as f32;
        if matches!(on, BorderItem::Below | BorderItem::Above) {
            target = self.nudge_f32(target);
        }
        let hi = match on {
            BorderItem::Extent => x,
            _ => (f64::from(target) + beyond) as f32,
        };
        Axis {
            lo,
            hi,
            target,
            seeker: matches!(on, BorderItem::Below | BorderItem::Above).then_some(x),
        }
    }

    /// Two coordinates as far apart as f32 and their difference in f64 can tell: one of them is
    /// small.
    fn apart(&mut self, by: f64) -> (f32, f32) {
        let near = by as f32;
        if self.below(2) == 0 {
            ((f64::from(near) - by) as f32, near)
        } else {
            (-near, (by - f64::from(near)) as f32)
        }
    }

    /// Targets in the corners, seekers that touch them, and others about them.
    fn fill(
        &mut self,
        bodies: &mut Bodies,
        plan: &BorderPlan,
        axes: &[Axis; 3],
        (fill, size): (u32, f64),
        [target_moves, seeker_moves]: [bool; 2],
    ) {
        let mut corners = Vec::new();
        for corner in 0..CORNERS {
            let at = axes.map(|axis| match corner {
                0 => axis.lo,
                1 => axis.hi,
                2 => axis.target,
                _ => self.pick(&[axis.lo, axis.hi, axis.target]),
            });
            corners.push(at);
            bodies.push(0, target_moves, NO_TURN, at);
        }
        for &corner in &corners {
            let mut at = corner;
            let seekers = axes.map(|axis| axis.seeker);
            if self.below(4) > 0 && seekers.iter().any(Option::is_some) {
                at = std::array::from_fn(|k| seekers[k].unwrap_or(corner[k]));
            } else {
                let k = self.below(3) as usize;
                let by = self.pick(&[plan.touch(), -plan.touch(), 0.5 * plan.touch()]);
                at[k] = (f64::from(at[k]) + by) as f32;
                at[k] = self.nudge_f32(at[k]);
            }
            bodies.push(1, seeker_moves, NO_TURN, at);
        }
        for _ in 0..fill {
            let corner = self.pick(&corners);
            let at = std::array::from_fn(|k| {
                let x = f64::from(corner[k]) + (self.unit() - 0.5) * 4.0 * size;
                (x as f32).min(axes[k].hi).max(axes[k].lo)
            });
            bodies.push(0, target_moves, NO_TURN, at);
        }
    }
}

const NO_TURN: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// Targets with coordinates of the axes alone.
const CORNERS: u32 = 8;
