//! Reads Broadmark's recordings, `.aabbs`: boxes frame by frame, for the claim about given boxes.
//!
//! Numbers are little endian. The head has 304 bytes: two names in 128 bytes each, the numbers of
//! bodies and of frames as i32, two i32 of zero, and the world's box in 2 × 4 f32. Then the bodies'
//! boxes follow 1 + frames times, each in 2 × 4 f32. The fourth f32 has no meaning.

use super::case::{Case, Frame};
use super::catalogue::{CatalogueError, of_boxes};
use super::claim::Claim;
use crate::contestant::WorldBox;

const HEAD: usize = 304;
const NAME: usize = 128;
const BOX: usize = 32;

/// Why a recording can't be read or a case can't be one.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// Too few or too many bytes, or a head that can't be.
    #[error("{0}")]
    Form(String),
    /// A box without finite ends, lower ones first.
    #[error("frame {frame}, box {body}: {ends:?} isn't finite with lower ends first")]
    Ends {
        /// The frame.
        frame: usize,
        /// The body.
        body: usize,
        /// Its box.
        ends: WorldBox,
    },
    /// A case whose set of bodies changes.
    #[error("the set of bodies changes between frames, which a Broadmark recording can't hold")]
    Changes,
    /// Never: a point can be built.
    #[error(transparent)]
    Catalogue(#[from] CatalogueError),
}

/// Reads a recording as a case; all bodies are dynamic.
///
/// # Errors
/// Bytes that are no recording.
pub fn read(bytes: &[u8]) -> Result<Case, RecordingError> {
    let form = |problem: String| RecordingError::Form(problem);
    if bytes.len() < HEAD {
        return Err(form(format!("{} bytes: a recording begins with {HEAD}", bytes.len())));
    }
    let name = |from: usize| -> String {
        let text = bytes[from..from + NAME].split(|byte| *byte == 0).next().unwrap_or(&[]);
        String::from_utf8_lossy(text).into_owned()
    };
    let count = |at: usize| -> Result<usize, RecordingError> {
        let value = i32::from_le_bytes(four(bytes, at));
        usize::try_from(value).map_err(|_| form(format!("a count of {value}")))
    };
    let (bodies, frames) = (count(2 * NAME)?, count(2 * NAME + 4)? + 1);
    let expected = bodies
        .checked_mul(BOX)
        .and_then(|frame| frame.checked_mul(frames))
        .and_then(|all| all.checked_add(HEAD));
    if expected != Some(bytes.len()) {
        return Err(form(format!(
            "{} bytes for {bodies} bodies and {frames} frames, {BOX} a box after {HEAD}",
            bytes.len()
        )));
    }
    let real = |at: usize| f32::from_le_bytes(four(bytes, at));
    let (mut shapes, mut read) = (Vec::new(), Vec::new());
    for frame in 0..frames {
        let mut boxes = Vec::with_capacity(bodies);
        for body in 0..bodies {
            let at = HEAD + (frame * bodies + body) * BOX;
            let ends = [0, 4, 8, 16, 20, 24].map(|offset| real(at + offset));
            let sound = ends.iter().all(|x| x.is_finite())
                && (0..3).all(|axis| ends[axis] <= ends[axis + 3]);
            if !sound {
                return Err(RecordingError::Ends { frame, body, ends });
            }
            boxes.push(ends);
        }
        let (point, frame) = of_boxes(boxes, vec![true; bodies])?;
        shapes = vec![point];
        read.push(frame);
    }
    Ok(Case {
        name: name(0),
        flag: "anything".to_owned(),
        source: format!("Broadmark, {}", name(NAME)),
        claim: Claim::Aabb,
        claims: vec![Claim::Aabb],
        shapes,
        frames: read,
    })
}

/// Writes a case's boxes as a recording.
///
/// # Errors
/// A set of bodies that changes, or no frame.
pub fn write(case: &Case) -> Result<Vec<u8>, RecordingError> {
    let Some(first) = case.frames.first() else {
        return Err(RecordingError::Form("a recording has a frame at least".to_owned()));
    };
    if case
        .frames
        .iter()
        .any(|frame| frame.was.is_some() || frame.restore || frame.boxes.len() != first.boxes.len())
    {
        return Err(RecordingError::Changes);
    }
    let mut bytes = Vec::new();
    for text in [&case.name, &case.source] {
        let mut name = [0; NAME];
        // The last byte stays zero.
        let kept = text.len().min(NAME - 1);
        name[..kept].copy_from_slice(&text.as_bytes()[..kept]);
        bytes.extend(name);
    }
    for count in [first.boxes.len(), case.frames.len() - 1, 0, 0] {
        bytes.extend((count as i32).to_le_bytes()); // fewer than 2³¹ boxes fit into memory
    }
    bytes.extend(packed(&world(&case.frames)));
    for ends in case.frames.iter().flat_map(|frame| &frame.boxes) {
        bytes.extend(packed(ends));
    }
    Ok(bytes)
}

fn four(bytes: &[u8], at: usize) -> [u8; 4] {
    [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]
}

fn packed(ends: &WorldBox) -> [u8; BOX] {
    let mut bytes = [0; BOX];
    for (at, x) in [0, 4, 8, 16, 20, 24].into_iter().zip(ends) {
        bytes[at..at + 4].copy_from_slice(&x.to_le_bytes());
    }
    bytes
}

/// The box of all boxes.
fn world(frames: &[Frame]) -> WorldBox {
    let mut all = [f32::MAX, f32::MAX, f32::MAX, f32::MIN, f32::MIN, f32::MIN];
    for ends in frames.iter().flat_map(|frame| &frame.boxes) {
        for axis in 0..3 {
            all[axis] = all[axis].min(ends[axis]);
            all[axis + 3] = all[axis + 3].max(ends[axis + 3]);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Recordings read back as they were written, and damaged ones are refused.
    #[test]
    fn recordings_survive_a_round_trip() {
        let boxes = |x: f32| vec![[x, 0.0, 0.0, x + 1.0, 1.0, 1.0], [2.0, 0.0, 0.0, 3.0, 1.0, 1.0]];
        let frame = |x: f32| of_boxes(boxes(x), vec![true; 2]).map(|(_, frame)| frame);
        let frames: Vec<Frame> = [0.0, 1.0].into_iter().filter_map(|x| frame(x).ok()).collect();
        assert_eq!(frames.len(), 2);
        let case = Case {
            name: "two".to_owned(),
            flag: String::new(),
            source: "here".to_owned(),
            claim: Claim::Aabb,
            claims: vec![Claim::Aabb],
            shapes: Vec::new(),
            frames,
        };
        let Ok(bytes) = write(&case) else { unreachable!("two frames of two boxes") };
        assert_eq!(bytes.len(), 304 + 2 * 2 * 32);
        assert_eq!(bytes[256..264], [2, 0, 0, 0, 1, 0, 0, 0]);
        let back = read(&bytes);
        assert!(back.is_ok_and(|back| back.name == "two" && back.frames == case.frames));
        assert!(read(&bytes[..bytes.len() - 1]).is_err());
        assert!(read(&bytes[..100]).is_err());
        let mut negative = bytes.clone();
        negative[259] = 0x80;
        assert!(read(&negative).is_err());
        let mut nan = bytes;
        nan[304..308].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(matches!(read(&nan), Err(RecordingError::Ends { frame: 0, body: 0, .. })));
    }
}
