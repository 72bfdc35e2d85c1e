//! Pairs as a culler with a flaw tests them.

use super::*;

/// The lists of boxes that were nearer than a skin when the list was made.
pub(super) fn listed(renewal: Renewal, case: &Case) -> Lists {
    const SKIN: f32 = 1.5;
    let (mut lists, mut known, mut age): (Lists, Vec<WorldBox>, usize) =
        (Vec::new(), Vec::new(), 0);
    for Frame { boxes, bodies, .. } in &case.frames {
        let moved = boxes.iter().flatten().zip(known.iter().flatten());
        let moved = moved.fold(0.0, |most: f32, (x, y)| most.max((x - y).abs()));
        let is_old = match renewal {
            Renewal::HalfSkin | Renewal::FrameToFrame => moved >= 0.49 * SKIN,
            Renewal::Skin => moved >= 0.98 * SKIN,
            Renewal::Eighth => age == 8,
        };
        age = if is_old || known.is_empty() { 0 } else { age + 1 };
        let mut list = lists.last().cloned().unwrap_or_default();
        if age == 0 {
            let all = (0..boxes.len()).flat_map(|j| (0..j).map(move |i| [i, j]));
            let moves = |&[i, j]: &[usize; 2]| bodies.dynamic[i] || bodies.dynamic[j];
            let near = |&[i, j]: &[usize; 2]| boxes_near(&boxes[i], &boxes[j], [SKIN, 0.0]);
            let near = all.filter(moves).filter(near);
            list = near.map(|pair| pair.map(|body| body as u32)).collect();
        }
        if age == 0 || renewal == Renewal::FrameToFrame {
            known.clone_from(boxes);
        }
        lists.push(list);
    }
    lists
}

/// The right answers, and pairs that the box of the lower number would meet if it were larger.
pub(super) fn grown(flaw: Flaw, case: &Case) -> Lists {
    let with_near = |(frame, mut list): (&Frame, Vec<[u32; 2]>)| {
        for (j, b) in frame.boxes.iter().enumerate() {
            for (i, a) in frame.boxes[..j].iter().enumerate() {
                let [x0, y0, z0, x1, y1, z1] = *a;
                let moves = frame.bodies.dynamic[i] || frame.bodies.dynamic[j];
                let may_grow = flaw == Flaw::Grown || i + 1 == j;
                if moves && may_grow && boxes_meet(&[x0, y0, z0, x1 + 0.5, y1 + 0.5, z1 + 0.5], b) {
                    list.push([i as u32, j as u32]);
                }
            }
        }
        list.sort_unstable();
        list.dedup();
        list
    };
    case.frames.iter().zip(exact(case)).map(with_near).collect()
}

/// Whether a culler with a flawed test reports a pair that must be reported.
pub(super) fn is_seen(
    flaw: Flaw,
    case: &Case,
    [first, frame]: [&Frame; 2],
    pair: [u32; 2],
    (shapes, truth): (&Shapes, &Truth),
) -> bool {
    let at = pair.map(|body| body as usize);
    let [a, b] = at.map(|i| &frame.boxes[i]);
    let is_of_boxes = case.claim.is_of_boxes();
    match flaw {
        Flaw::Strict if !is_of_boxes => {
            let mut alone = frame.picked(&at);
            for axis in 0..3 {
                let [from, to] = [a, b].map(|ends| ends[axis] / 2.0 + ends[axis + 3] / 2.0);
                let t = &mut alone.bodies.translation[1][axis];
                *t = if to > from {
                    t.next_up()
                } else if to < from {
                    t.next_down()
                } else {
                    *t
                };
            }
            truth.pair(&alone, [0, 1]).unwrap()
        }
        Flaw::Strict | Flaw::HalfOpen => {
            let mut alone = frame.picked(&at);
            for ends in &mut alone.boxes {
                for axis in 0..3 {
                    if ends[axis] == ends[axis + 3] {
                        continue;
                    }
                    ends[axis + 3] = ends[axis + 3].next_down();
                    if flaw == Flaw::Strict && ends[axis] < ends[axis + 3] {
                        ends[axis] = ends[axis].next_up();
                    }
                }
            }
            truth.pair(&alone, [0, 1]).unwrap()
        }
        // Boxes that don't meet as given have a margin between them or are images.
        Flaw::Naive(volume) if is_of_boxes => !boxes_meet(a, b) || naive_boxes(volume, a, b),
        Flaw::Naive(volume) => {
            let has_parts = |i: usize| frame.parts.as_ref().is_some_and(|p| !p[i].is_empty());
            if at.into_iter().any(has_parts) {
                return true; // other flaws are about parts
            }
            let bodies = &frame.bodies;
            match volume {
                Volume::Ball if case.claim == Claim::Sphere => {
                    naive_overlap(shapes, bodies, pair, Predicate::Sphere)
                }
                Volume::Ball => balls_meet(case, bodies, at),
                Volume::Box => naive_overlap(shapes, bodies, pair, Predicate::Aabb),
                Volume::OrDop => {
                    naive_overlap(shapes, bodies, pair, Predicate::OrDop(Overlap::TwoSided))
                }
                Volume::Hull => convex_meet(at.map(|i| hull(case, frame, i))),
                Volume::Mesh => {
                    let [of_a, of_b] = at.map(|i| triangles(case, frame, i));
                    of_a.iter().any(|a| of_b.iter().any(|b| convex_meet([a.clone(), b.clone()])))
                }
            }
        }
        Flaw::LargerMargin | Flaw::RoundedMargins => {
            let Some(margins) = &frame.margins else { return true };
            let [p, q] = at.map(|i| margins[i]);
            if flaw == Flaw::LargerMargin {
                return boxes_near(a, b, [p.max(q), 0.0]);
            }
            let apart =
                |a: &WorldBox, b: &WorldBox| (0..3).any(|axis| b[axis] > a[axis + 3] + (p + q));
            !apart(a, b) && !apart(b, a)
        }
        _ => {
            let Some(periods) = frame.periods else { return true };
            let starts = at.map(|i| first.boxes.get(i).unwrap_or(&frame.boxes[i]));
            match flaw {
                Flaw::NextImages => {
                    images(a, b, periods).iter().flatten().all(|n| (-1..=1).contains(n))
                }
                _ => (0..3).all(|axis| meet_along(flaw, [a, b], starts, axis, periods[axis])),
            }
        }
    }
}

fn interval(ends: &WorldBox, axis: usize) -> [f64; 2] {
    [ends[axis], ends[axis + 3]].map(f64::from)
}

/// Whether two boxes meet along an axis, by a flawed search of the image.
fn meet_along(
    flaw: Flaw,
    boxes: [&WorldBox; 2],
    starts: [&WorldBox; 2],
    axis: usize,
    period: Option<f64>,
) -> bool {
    let [a, b] = boxes.map(|ends| interval(ends, axis));
    let overlap = |a: [f64; 2], b: [f64; 2], by: f64| a[0] <= b[1] + by && b[0] + by <= a[1];
    let Some(period) = period else {
        return overlap(a, b, 0.0);
    };
    if flaw == Flaw::FormerImage {
        let [a0, b0] = starts.map(|ends| interval(ends, axis)[0]);
        return overlap(a, b, ((a0 - b0) / period).round() * period);
    }
    let wrapped = |ends: [f64; 2]| ends.map(|end| end - (ends[0] / period).round() * period);
    let (a, b) = (wrapped(a), wrapped(b));
    [-period, 0.0, period].into_iter().any(|by| overlap(a, b, by))
}

/// Balls around boxes, or centres and half sizes, in f32.
fn naive_boxes(volume: Volume, a: &WorldBox, b: &WorldBox) -> bool {
    let centre = |ends: &WorldBox, axis: usize| 0.5 * (ends[axis] + ends[axis + 3]);
    let half = |ends: &WorldBox, axis: usize| 0.5 * (ends[axis + 3] - ends[axis]);
    let d = [0, 1, 2].map(|axis| centre(b, axis) - centre(a, axis));
    if volume == Volume::Box {
        return (0..3).all(|axis| d[axis].abs() <= half(a, axis) + half(b, axis));
    }
    let square = |v: [f32; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let radius = |ends| square([0, 1, 2].map(|axis| half(ends, axis))).sqrt();
    square(d).sqrt() <= radius(a) + radius(b)
}

type Vector = [f32; 3];

/// Balls about the bodies' origins, around their vertices, in f32.
fn balls_meet(case: &Case, bodies: &Bodies, at: [usize; 2]) -> bool {
    let square = |[x, y, z]: Vector| x * x + y * y + z * z;
    let radius = |i: usize| {
        let vertices = case.shapes[bodies.shape[i] as usize].vertices.iter();
        vertices.fold(0.0, |m: f32, v| m.max(square(*v).sqrt()))
    };
    let [a, b] = at.map(|i| bodies.translation[i]);
    let reach = radius(at[0]) + radius(at[1]);
    square([0, 1, 2].map(|n| b[n] - a[n])) <= reach * reach
}

/// The corners of a convex piece, and of each of its faces.
#[derive(Clone)]
struct Piece {
    corners: Vec<Vector>,
    faces: Vec<[Vector; 3]>,
}

/// A body's triangles in f32.
fn triangles(case: &Case, frame: &Frame, i: usize) -> Vec<Piece> {
    let shape = &case.shapes[frame.bodies.shape[i] as usize];
    let turn = rotation(frame.bodies.rotation[i]);
    let place = |v: u32| {
        let at = transform(&turn, shape.vertices[v as usize], [0.0; 3]);
        [0, 1, 2].map(|axis| at[axis] as f32 + frame.bodies.translation[i][axis])
    };
    let piece = |corners: &[u32; 3]| {
        let face = corners.map(place);
        Piece { corners: face.to_vec(), faces: vec![face] }
    };
    shape.triangles.iter().map(piece).collect()
}

/// A body's convex hull, if its mesh is convex.
fn hull(case: &Case, frame: &Frame, i: usize) -> Piece {
    let all = triangles(case, frame, i);
    let corners = all.iter().flat_map(|piece| piece.corners.clone()).collect();
    Piece { corners, faces: all.into_iter().flat_map(|piece| piece.faces).collect() }
}

/// Whether no normal of a face and no cross product of edges separates two convex pieces, in f32.
fn convex_meet(pieces: [Piece; 2]) -> bool {
    let minus = |a: Vector, b: Vector| [0, 1, 2].map(|n| a[n] - b[n]);
    let cross = |a: Vector, b: Vector| {
        [0, 1, 2].map(|n| {
            let (m, o) = ((n + 1) % 3, (n + 2) % 3);
            a[m] * b[o] - a[o] * b[m]
        })
    };
    let range = |piece: &Piece, axis: Vector| {
        let along = piece.corners.iter().map(|v| axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]);
        along.fold([f32::INFINITY, f32::NEG_INFINITY], |[lo, hi], x| [lo.min(x), hi.max(x)])
    };
    let parts = |axis: Vector| {
        let [[a, b], [c, d]] = [0, 1].map(|n| range(&pieces[n], axis));
        b < c || d < a
    };
    let edges = |piece: &Piece| -> Vec<Vector> {
        let of = |[a, b, c]: &[Vector; 3]| [minus(*b, *a), minus(*c, *b), minus(*a, *c)];
        piece.faces.iter().flat_map(of).collect()
    };
    let normal = |[a, b, c]: &[Vector; 3]| cross(minus(*b, *a), minus(*c, *a));
    let [of_a, of_b] = [0, 1].map(|n| edges(&pieces[n]));
    let mut normals = pieces.iter().flat_map(|piece| piece.faces.iter().map(normal));
    !normals.any(parts) && !of_a.iter().any(|a| of_b.iter().any(|b| parts(cross(*a, *b))))
}
