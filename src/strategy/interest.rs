//! Which bodies are of interest in a frame (a list, or those whose sphere centres are in a view
//! cone), and which pairs.

use crate::bodies::Bodies;
use crate::pairs::PairList;
use crate::rounding::exp2;
use crate::rounding::pose::rotation;
use crate::settings::{Interest, ViewCone};

/// Marks the bodies of interest. `centre` returns a body's sphere centre in the world frame.
pub(crate) fn mark(
    interest: &Interest,
    bodies: &Bodies,
    centre: impl Fn(usize) -> [f32; 3],
    marks: &mut [bool],
) {
    match interest {
        Interest::Bodies(list) => {
            marks.fill(false);
            for &body in list {
                marks[body as usize] = true;
            }
        }
        Interest::Cone(cone) => {
            let pose = |body: usize| {
                let translation = bodies.translation[body].map(f64::from);
                (bodies.rotation[body], translation)
            };
            let cone = PlacedCone::new(cone, cone.body.map(|body| pose(body as usize)));
            for (body, mark) in marks.iter_mut().enumerate() {
                *mark = cone.sees(centre(body).map(f64::from));
            }
        }
    }
}

/// A list of pairs of places, of which only those with a body of interest are refined.
pub(super) struct InterestFilter<'a> {
    pub pairs: &'a PairList,
    /// The body in each place.
    pub body: &'a [u32],
    pub interest: &'a [bool],
}

impl InterestFilter<'_> {
    /// Every pair with its bodies, and whether one of them is of interest.
    fn classified(&self) -> impl Iterator<Item = ([u32; 2], [u32; 2], bool)> {
        self.pairs.iter().map(|places| {
            let bodies = places.map(|place| self.body[place as usize]);
            let of_interest = bodies.iter().any(|&body| self.interest[body as usize]);
            (places, bodies, of_interest)
        })
    }

    /// Lists the pairs that are to be refined.
    pub fn select(&self, selected: &mut PairList) {
        selected.clear();
        selected.lose_with(self.pairs);
        for ([i, j], _, of_interest) in self.classified() {
            if of_interest {
                selected.push(i, j);
            }
        }
    }

    /// Appends, as pairs of bodies, those that are not refined and those that `passed`, in their
    /// common order. The list must not depend on where blocks, and therefore threads, begin.
    pub fn merge(&self, passed: &PairList, out: &mut PairList) {
        out.lose_with(self.pairs);
        out.lose_with(passed);
        let mut passed = passed.iter().peekable();
        for (_, [a, b], of_interest) in self.classified() {
            if !of_interest || passed.next_if_eq(&[a, b]).is_some() {
                out.push(a, b);
            }
        }
    }
}

/// Exceeds the errors of the half angle's cosine, of the axis' length and of a product, so that
/// points on the rim are in the cone: at right angles for 90°, and opposite to the axis for 180°.
const CONE_SLACK: f64 = exp2(-48);

/// A view cone in the world frame.
#[derive(Debug)]
pub struct PlacedCone {
    apex: [f64; 3],
    direction: [f64; 3],
    cosine: f64,
    range: f64,
}

impl PlacedCone {
    /// Transforms a cone to the world frame. `pose` is that of the body that looks, if there is
    /// one.
    #[must_use]
    pub fn new(cone: &ViewCone, pose: Option<([f32; 4], [f64; 3])>) -> Self {
        let given = cone.direction.map(f64::from);
        let (apex, turned) = match pose {
            Some((q, t)) => (t, rotation(q).map(|row| dot(row, given))),
            None => (cone.apex.unwrap_or_default().map(f64::from), given),
        };
        let length = dot(turned, turned).sqrt();
        Self {
            apex,
            direction: turned.map(|x| x / length),
            cosine: libm::cos(f64::from(cone.half_angle).to_radians()) - CONE_SLACK,
            range: cone.range.map_or(f64::INFINITY, f64::from),
        }
    }

    /// Whether a centre is in the cone. The apex is in it, so a body that looks is of interest if
    /// its sphere's centre is its origin.
    #[must_use]
    pub fn sees(&self, centre: [f64; 3]) -> bool {
        let way: [f64; 3] = std::array::from_fn(|i| centre[i] - self.apex[i]);
        let distance = dot(way, way).sqrt();
        distance <= self.range && dot(way, self.direction) >= self.cosine * distance
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use super::*;

    fn seen(cone: &ViewCone, bodies: &Bodies, centre: [f32; 3]) -> bool {
        let mut marks = [false];
        mark(&Interest::Cone(cone.clone()), bodies, |_| centre, &mut marks);
        marks[0]
    }

    /// Pythagorean quadruples, so that distances are f32.
    const CONE_DIRECTIONS: [([f32; 3], f32); 4] = [
        ([2.0, 3.0, 6.0], 7.0),
        ([-4.0, 7.0, 4.0], 9.0),
        ([8.0, -9.0, 12.0], 17.0),
        ([-6.0, -6.0, -7.0], 11.0),
    ];

    const APEXES: [[f32; 3]; 3] = [[0.0; 3], [1000.0, -500.0, 250.0], [-0.5, 0.25, 4096.0]];

    /// A cone reaches as far as its range to the ulp.
    #[test]
    fn cone_range_is_exact() {
        let body = |apex| {
            let mut bodies = Bodies::default();
            bodies.push(0, true, [0.0, 0.0, 0.0, 2.0], apex);
            bodies
        };
        for apex in APEXES {
            for (way, length) in CONE_DIRECTIONS {
                let centre = std::array::from_fn(|i| apex[i] + way[i]);
                for on_body in [false, true] {
                    let cone = |range: f32| ViewCone {
                        body: on_body.then_some(0),
                        apex: (!on_body).then_some(apex),
                        direction: way,
                        half_angle: 10.0,
                        range: Some(range),
                    };
                    let bodies = body(apex);
                    assert!(seen(&cone(length), &bodies, centre), "{apex:?} {way:?}");
                    assert!(!seen(&cone(length.next_down()), &bodies, centre));
                }
            }
        }
    }

    /// Directions at right angles (90°) and opposite to the axis (180°) are on the rim, however the
    /// axis' length was rounded.
    #[test]
    fn cone_includes_its_rim() {
        for apex in APEXES {
            for (way, _) in CONE_DIRECTIONS {
                let cone = |half_angle: f32| ViewCone {
                    body: None,
                    apex: Some(apex),
                    direction: way,
                    half_angle,
                    range: None,
                };
                let at = |by: [f32; 3]| std::array::from_fn(|i| apex[i] + by[i]);
                let (behind, [x, y, z]) = (at(way.map(|x| -x)), way);
                let none = Bodies::default();
                assert!(seen(&cone(180.0), &none, behind), "{apex:?} {way:?}");
                assert!(!seen(&cone(179.99), &none, behind), "{apex:?} {way:?}");
                for sideways in [[-y, x, 0.0], [0.0, -z, y], [z, 0.0, -x]] {
                    assert!(seen(&cone(90.0), &none, at(sideways)), "{apex:?} {way:?}");
                    assert!(!seen(&cone(89.99), &none, at(sideways)));
                }
            }
        }
    }

    /// A mesh may lie off the origin that its cone looks from.
    #[test]
    fn looking_body_follows_its_centre() {
        let mut bodies = Bodies::default();
        bodies.push(0, true, [0.0, 0.0, 0.0, 1.0], [5.0, 6.0, 7.0]);
        let cone = ViewCone {
            body: Some(0),
            apex: None,
            direction: [0.0, 0.0, 1.0],
            half_angle: 30.0,
            range: None,
        };
        assert!(seen(&cone, &bodies, [5.0, 6.0, 7.0]), "about its origin");
        assert!(seen(&cone, &bodies, [5.0, 6.0, 8.0]), "in front of it");
        assert!(!seen(&cone, &bodies, [5.0, 6.0, 6.0]), "behind it");
    }

    /// Bodies 2·10⁻⁵ of their distance to either side of the rim, where f32 can place them: an apex
    /// or an angle that is slightly off is detected.
    #[test]
    fn cone_rim_matches_its_angle() {
        let distance = 64.0_f64;
        for apex in APEXES {
            for half_angle in [1.0_f32, 30.0, 90.0, 135.0, 179.0] {
                for (turn, turned) in
                    [([0.0, 0.0, 0.0, 1.0], [1, 2, 0]), ([0.5, 0.5, 0.5, 0.5], [2, 0, 1])]
                {
                    let mut bodies = Bodies::default();
                    bodies.push(0, true, turn, apex);
                    let cone = ViewCone {
                        body: Some(0),
                        apex: None,
                        direction: [0.0, 3.0, 0.0],
                        half_angle,
                        range: None,
                    };
                    // The axis is y, or z once x → y → z; the rim is taken in all four ways across.
                    for (across, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
                        for (by, inside) in [(-2e-5, true), (2e-5, false)] {
                            let angle = f64::from(half_angle).to_radians() + by;
                            let mut centre = apex.map(f64::from);
                            centre[turned[0]] += distance * libm::cos(angle);
                            centre[turned[1 + across]] += sign * distance * libm::sin(angle);
                            let is_seen = seen(&cone, &bodies, centre.map(|x| x as f32));
                            assert_eq!(is_seen, inside, "{apex:?} {half_angle} {turn:?} {across}");
                        }
                    }
                }
            }
        }
    }

    /// Of two centres that are neighbours in f32, one in the cone and one not, integers say which:
    /// cosines of ½, 0 and −½.
    #[test]
    fn rim_separates_f32_neighbours() {
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let mut below = |most: i64| i64::from(random.next_u32()) % (2 * most + 1) - most;
        let whole = |v: [i64; 3]| v.map(|x| x as f32);
        let dot = |a: [i64; 3], b: [i64; 3]| (0..3).map(|i| i128::from(a[i] * b[i])).sum::<i128>();
        let (mut parted, bits) = (0, 1 << 24);
        for trial in 0..6000 {
            let direction = [below(999), below(999), below(999)];
            let apex = [(); 3].map(|()| below(bits));
            let (axis, degrees) = (trial % 3, [60_u8, 90, 120][trial / 3 % 3]);
            // Inside from 0 on: 4·(way·direction)², with its sign, against
            // 4·cos²·|way|²·|direction|².
            let inside = |centre: [i64; 3]| {
                let way = std::array::from_fn(|i| centre[i] - apex[i]);
                let along = dot(way, direction);
                let rim = dot(way, way) * dot(direction, direction);
                match degrees {
                    60 => (4 * along * along.abs() - rim, rim),
                    90 => (along, rim),
                    _ => (4 * along * along.abs() + rim, rim),
                }
            };
            let cone = ViewCone {
                body: None,
                apex: Some(whole(apex)),
                direction: whole(direction),
                half_angle: f32::from(degrees),
                range: None,
            };
            let is_seen = |centre| seen(&cone, &Bodies::default(), whole(centre));
            let start = [(); 3].map(|()| below(bits));
            let at = |x: i64| std::array::from_fn(|i| if i == axis { x } else { start[i] });
            let (mut here, mut there) = (start[axis], below(bits));
            if direction == [0; 3] || (inside(at(here)).0 >= 0) == (inside(at(there)).0 >= 0) {
                continue;
            }
            while (here - there).abs() > 1 {
                let middle = (here + there).div_euclid(2);
                if (inside(at(middle)).0 >= 0) == (inside(at(here)).0 >= 0) {
                    here = middle;
                } else {
                    there = middle;
                }
            }
            for centre in [here, there].map(at) {
                let (beyond, rim) = inside(centre);
                // What lies outside by less than the rim's own width may be seen.
                if beyond >= 0 || -beyond as f64 > 1e-12 * rim as f64 || degrees == 90 {
                    assert_eq!(is_seen(centre), beyond >= 0, "{centre:?} of {cone:?}");
                    parted += 1;
                }
            }
        }
        assert!(parted > 1500, "{parted}");
    }
}
