//! A counter-example as text: what meets, where, and how deep, in the scene's unit of length.

use std::fmt;

use super::case::Frame;
use super::score::Miss;
use super::shrink::SmallestCase;
use super::truth::images;
use super::witness::DEEPEST;
use crate::contestant::WorldBox;

impl SmallestCase {
    /// The boxes of the missed pair, for the claim that is about boxes.
    #[must_use]
    pub fn boxes(&self) -> Option<[WorldBox; 2]> {
        let Miss { frame, pair } = self.miss;
        let boxes = &self.case.frames[frame].boxes;
        self.case.claim.is_of_boxes().then(|| pair.map(|body| boxes[body as usize]))
    }

    /// The reasons why the missed pair meets, one per line.
    #[must_use]
    pub fn reasons(&self) -> Vec<String> {
        let pair = self.miss.pair;
        let mut lines = Vec::new();
        if let Some(boxes) = self.boxes() {
            let [first, second] = boxes.map(|ends| corners(&ends));
            lines.push(format!("box {}: {first}", pair[0]));
            lines.push(format!("box {}: {second}", pair[1]));
            let periods = self.case.frames[self.miss.frame].periods;
            match periods.and_then(|periods| image_line(&boxes, pair[1], periods)) {
                Some(line) => lines.push(line),
                None => lines.extend(axes(&boxes, pair)),
            }
        }
        let Some(witness) = &self.witness else {
            return lines;
        };
        let point = witness.decimals.map(length).join(", ");
        lines.push(format!("shared point: ({point})"));
        if witness.point.iter().any(|x| x.contains('/')) {
            let exact = witness.point.join(", ");
            if exact.len() < 160 {
                lines.push(format!("exactly ({exact})"));
            }
        }
        if !self.case.claim.is_of_boxes() {
            lines.push(match witness.depth {
                Some(depth) => format!(
                    "depth: {} or less, which is {} of the f32 steps there",
                    length(depth),
                    witness.depth_ulps.unwrap_or_default()
                ),
                None => format!("depth: more than {}", length(DEEPEST as f64 * witness.ulp)),
            });
        }
        lines
    }
}

impl fmt::Display for SmallestCase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Miss { frame, pair: [i, j] } = self.miss;
        writeln!(
            f,
            "smallest: {}, {}, from {}; bodies {i} and {j} share a point in frame {frame}",
            counted(self.case.frames[frame].bodies.len(), "body", "bodies"),
            counted(self.case.frames.len(), "frame", "frames"),
            self.from
        )?;
        let mut lines = self.reasons().into_iter().chain(self.former_frames());
        lines.try_for_each(|line| writeln!(f, "  {line}"))
    }
}

/// The most bodies of a frame whose places are printed.
const MOST_BODIES_TOLD: usize = 4;

impl SmallestCase {
    /// Where the bodies were in the frames before, if they are few, and how the missed pair has
    /// come together.
    fn former_frames(&self) -> Vec<String> {
        let Miss { frame: last, pair } = self.miss;
        let frames = &self.case.frames[..=last];
        if last == 0 || frames.iter().any(|frame| frame.bodies.len() > MOST_BODIES_TOLD) {
            return Vec::new();
        }
        let place = |frame: &Frame, body: usize| match self.case.claim.is_of_boxes() {
            true => format!("box {body}: {}", corners(&frame.boxes[body])),
            false => {
                let numbers =
                    |all: &[f32]| all.iter().map(|&x| coordinate(x)).collect::<Vec<_>>().join(", ");
                let (turn, at) = (frame.bodies.rotation[body], frame.bodies.translation[body]);
                format!("body {body} at ({}), turned by ({})", numbers(&at), numbers(&turn))
            }
        };
        let told = frames[..last].iter().enumerate().flat_map(|(number, frame)| {
            let bodies = 0..frame.bodies.len();
            bodies.map(move |body| format!("frame {number}, {}", place(frame, body)))
        });
        let mut lines: Vec<String> = told.collect();
        if frames.iter().all(Frame::keeps_numbers) {
            let ends = [&frames[0], &frames[last]];
            lines.extend(pair.iter().flat_map(|&body| moved(ends, body)));
        }
        lines
    }
}

/// A line for each axis along which a body has moved since the first frame.
fn moved([first, last]: [&Frame; 2], body: u32) -> impl Iterator<Item = String> {
    let [before, now] = [first, last].map(|frame| frame.boxes[body as usize]);
    let axes = (0..3).filter(move |&axis| before[axis] != now[axis]);
    axes.map(move |axis| {
        let (from, to) = (coordinate(before[axis]), coordinate(now[axis]));
        let along = ["x", "y", "z"][axis];
        format!("body {body} moved along {along}, {from} → {to}, since frame 0")
    })
}

fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// A box by two corners.
fn corners(ends: &WorldBox) -> String {
    let corner = |at: usize| [at, at + 1, at + 2].map(|n| coordinate(ends[n])).join(", ");
    format!("({}) to ({})", corner(0), corner(3))
}

/// The overlap of two boxes along an axis, in real arithmetic rounded once, and which of them ends
/// there.
struct AxisOverlap {
    axis: usize,
    depth: f64,
    /// The box that ends and the one that starts, as 0 or 1.
    ends: usize,
}

impl AxisOverlap {
    fn of(boxes: &[WorldBox; 2], axis: usize) -> Self {
        let between = |ends: usize| {
            let (end, start) = (boxes[ends][axis + 3], boxes[1 - ends][axis]);
            f64::from(end) - f64::from(start)
        };
        let ends = usize::from(between(1) < between(0));
        Self { axis, depth: between(ends), ends }
    }

    fn line(&self, boxes: &[WorldBox; 2], pair: [u32; 2]) -> String {
        let (axis, ends, starts) = (self.axis, self.ends, 1 - self.ends);
        let meeting = if self.depth == 0.0 {
            "touching".to_owned()
        } else {
            format!("overlapping by {}", length(self.depth))
        };
        format!(
            "{}: box {} ends at {}, box {} starts at {}: {meeting}",
            ["x", "y", "z"][axis],
            pair[ends],
            coordinate(boxes[ends][axis + 3]),
            pair[starts],
            coordinate(boxes[starts][axis])
        )
    }
}

/// By how many periods the second box is moved where it meets the first; `None` if it isn't moved.
fn image_line(boxes: &[WorldBox; 2], second: u32, periods: [Option<f64>; 3]) -> Option<String> {
    let met = images(&boxes[0], &boxes[1], periods);
    let image = met.first().filter(|image| **image != [0; 3])?;
    let moved = [0, 1, 2].map(|axis| match periods[axis] {
        Some(period) if image[axis] != 0 => format!("{} · {period}", image[axis]),
        _ => "0".to_owned(),
    });
    let moved = moved.join(", ");
    Some(format!("box {second} meets it when moved by ({moved}), whole periods"))
}

/// Every axis on which two boxes only touch, or the one on which they overlap least.
fn axes(boxes: &[WorldBox; 2], pair: [u32; 2]) -> Vec<String> {
    let mut all = [0, 1, 2].map(|axis| AxisOverlap::of(boxes, axis));
    all.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    let touching = all.iter().filter(|along| along.depth == 0.0).count();
    let shown = all.iter().take(touching.max(1));
    shown.map(|along| along.line(boxes, pair)).collect()
}

/// An f32 as the shortest text that reads back to it.
fn coordinate(x: f32) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        size if (1e-4..1e7).contains(&size) => format!("{x}"),
        _ => format!("{x:e}"),
    }
}

/// A length, to a person's precision: seven digits.
fn length(x: f64) -> String {
    let rounded: f64 = format!("{x:.6e}").parse().unwrap_or(x);
    match x.abs() {
        0.0 => "0".to_owned(),
        size if (1e-4..1e7).contains(&size) => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_name_the_ends_that_meet() {
        let first = [0.0, 0.0, 0.0, 4.0, 2.0, 4.0];
        let pair = [3, 7];
        let touching = [first, [1.0, 2.0, 1.0, 3.0, 5.0, 3.0]];
        assert_eq!(axes(&touching, pair), ["y: box 3 ends at 2, box 7 starts at 2: touching"]);
        let overlapping = [first, [-3.0, -1.0, -2.0, 0.5, 1.0, 2.0]];
        assert_eq!(
            axes(&overlapping, pair),
            ["x: box 7 ends at 0.5, box 3 starts at 0: overlapping by 0.5"]
        );
        let corner = [first, [4.0, 2.0, 4.0, 5.0, 3.0, 5.0]];
        assert_eq!(axes(&corner, pair).len(), 3);
        // One ulp of overlap is an overlap.
        let ulp = [first, [1.0, 2.0_f32.next_down(), 1.0, 3.0, 5.0, 3.0]];
        assert_eq!(
            axes(&ulp, pair),
            ["y: box 3 ends at 2, box 7 starts at 1.9999999: overlapping by 1.192093e-7"]
        );
    }

    /// Numbers have an exponent where zeros would hide their digits.
    #[test]
    fn tiny_numbers_have_an_exponent() {
        assert_eq!(coordinate(-0.0), "0");
        assert_eq!(coordinate(1e-45), "1e-45");
        assert_eq!(coordinate(2.5e17), "2.5e17");
        assert_eq!(length(131_072.0), "131072");
        assert_eq!(length(1.0 / 3.0), "0.3333333");
    }
}
