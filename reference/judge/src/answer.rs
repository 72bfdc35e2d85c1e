//! A culler's answer to a frame, and the ways in which an answer can be invalid.

use super::case::Frame;

/// One frame's answer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Answer {
    /// The pairs as reported.
    pub pairs: Vec<[u32; 2]>,
    /// The culler's own time, in nanoseconds.
    pub ns: Option<u64>,
    /// Volumes that it updated for this frame: Nu of the cost formula.
    pub nu: Option<u64>,
    /// Pairs that it tested: Nv.
    pub nv: Option<u64>,
}

/// Why a case ended without an answer to judge. None of these is a pass.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, serde::Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum AnswerError {
    /// The program can't be started.
    #[error("cannot be started: {why}")]
    Start {
        /// What the system says.
        why: String,
    },
    /// It has computed for as long as a case may take.
    #[error("no answer to frame {frame} within {seconds:.1} s")]
    Timeout {
        /// The first frame without an answer.
        frame: usize,
        /// The time that the case had.
        seconds: Seconds,
    },
    /// It has neither answered nor computed for as long as a case may take.
    #[error("hangs: no answer to frame {frame} in {seconds:.1} s, most of them without computing")]
    Idle {
        /// The first frame without an answer.
        frame: usize,
        /// How long the judge has waited.
        seconds: Seconds,
    },
    /// All frames were answered, but the process continues after the end of its input.
    #[error("answered, but did not end within {seconds:.1} s after the end of its input")]
    Hanging {
        /// The time that the case had.
        seconds: Seconds,
    },
    /// It ended with a failure, by a signal or a panic.
    #[error("crashed ({how}) with {answered} frames answered{said}")]
    Crashed {
        /// Exit code, signal or panic.
        how: String,
        /// Frames answered before.
        answered: usize,
        /// The end of what it wrote to standard error.
        said: String,
    },
    /// It ended with success, but before all frames were answered.
    #[error("ended after {answered} of {frames} frames{said}")]
    Early {
        /// Frames answered.
        answered: usize,
        /// Frames of the case.
        frames: usize,
        /// The end of what it wrote to standard error.
        said: String,
    },
    /// A line is not an answer.
    #[error("frame {frame}: {why}: `{line}`")]
    Malformed {
        /// The frame that was to be answered.
        frame: usize,
        /// What is wrong.
        why: String,
        /// The beginning of the line.
        line: String,
    },
    /// An answer is to another frame than the next one: twice, late or too early.
    #[error("the answer to frame {expected} is about frame {found}")]
    OutOfTurn {
        /// The next frame.
        expected: usize,
        /// What was answered.
        found: u64,
    },
    /// More lines than frames.
    #[error("answers more than the {frames} frames there are: `{line}`")]
    TooMany {
        /// Frames of the case.
        frames: usize,
        /// The beginning of the line.
        line: String,
    },
    /// The output is longer than any correct answer.
    #[error("floods its output: more than {bytes} bytes")]
    Flood {
        /// The limit.
        bytes: usize,
    },
    /// A body that doesn't exist.
    #[error("frame {frame}: the pair [{i},{j}] names no body of {bodies}", i = pair[0], j = pair[1])]
    NoBody {
        /// The frame.
        frame: usize,
        /// The pair.
        pair: [u32; 2],
        /// How many bodies the frame has.
        bodies: usize,
    },
    /// A body with itself.
    #[error("frame {frame}: body {body} is paired with itself")]
    SelfPair {
        /// The frame.
        frame: usize,
        /// The body.
        body: u32,
    },
    /// The larger number first.
    #[error("frame {frame}: the pair [{i},{j}] has the larger number first", i = pair[0], j = pair[1])]
    Reversed {
        /// The frame.
        frame: usize,
        /// The pair.
        pair: [u32; 2],
    },
    /// A pair reported twice.
    #[error("frame {frame}: the pair [{i},{j}] is reported twice", i = pair[0], j = pair[1])]
    Twice {
        /// The frame.
        frame: usize,
        /// The pair.
        pair: [u32; 2],
    },
}

/// Seconds that compare like numbers and print like them.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Seconds(pub f64);

impl Eq for Seconds {}

impl std::fmt::Display for Seconds {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(&self.0, f)
    }
}

/// The reason why a culler gave no answers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StopReason {
    /// It skips this case, with a reason, after some answers.
    Skipped {
        /// The reason that it gives.
        why: String,
        /// Its answers before.
        answered: Vec<Answer>,
    },
    /// It failed.
    Trouble(AnswerError),
}

impl From<AnswerError> for StopReason {
    fn from(trouble: AnswerError) -> Self {
        Self::Trouble(trouble)
    }
}

/// Sorts a frame's pairs and checks that they are valid.
///
/// # Errors
/// A body that doesn't exist or is paired with itself, the larger number first, a pair twice.
pub fn sorted(number: usize, frame: &Frame, answer: &Answer) -> Result<Vec<[u32; 2]>, AnswerError> {
    let bodies = frame.bodies.len();
    for &pair in &answer.pairs {
        let [i, j] = pair;
        if i as usize >= bodies || j as usize >= bodies {
            return Err(AnswerError::NoBody { frame: number, pair, bodies });
        }
        if i == j {
            return Err(AnswerError::SelfPair { frame: number, body: i });
        }
        if i > j {
            return Err(AnswerError::Reversed { frame: number, pair });
        }
    }
    let mut sorted = answer.pairs.clone();
    sorted.sort_unstable();
    match sorted.windows(2).find(|two| two[0] == two[1]) {
        Some(two) => Err(AnswerError::Twice { frame: number, pair: two[0] }),
        None => Ok(sorted),
    }
}
