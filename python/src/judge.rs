//! Judging a culler that is written in Python.

use numpy::{PyArray1, PyArray2};
use pyo3::call::PyCallArgs;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use sdop::bodies::Bodies;
use sdop_judge::answer::{Answer, AnswerError, StopReason};
use sdop_judge::report::counter_example;
use sdop_judge::shrink::SmallestCase;
use sdop_judge::{BodyPart, Case, Claim, Frame, Options, Subject, examine};

use super::arrays::{matrix, whole_rows};
use super::errors::{CaseSkipped, SdopError, refused};

/// Judges a culler against the exact reference.
///
/// Returns whether it is a pass, the verdict as text and as JSON, and the smallest case of a miss;
/// `sdop.judge` makes a `Verdict` of it.
#[pyfunction]
#[pyo3(signature = (make, claims, cases, seed, extra_limit, fail_fast))]
pub fn judge(
    py: Python<'_>,
    make: Py<PyAny>,
    claims: &str,
    cases: String,
    seed: Option<u64>,
    extra_limit: Option<f64>,
    fail_fast: bool,
) -> PyResult<(bool, String, String, Option<Missed>)> {
    let claim: Claim = claims.parse().map_err(refused)?;
    let options =
        Options { claim, pattern: cases, seed, extra_limit, fail_fast, ..Options::default() };
    let subject = PythonSubject { make };
    let verdict = py
        .detach(|| examine(&subject, &options, |_, _| {}))
        .map_err(|error| SdopError::new_err(error.to_string()))?;
    py.check_signals()?;
    let json =
        serde_json::to_string(&verdict).map_err(|error| SdopError::new_err(error.to_string()))?;
    let missed = verdict.smallest.as_ref().map(|smallest| missed(py, smallest)).transpose()?;
    Ok((verdict.passed(), verdict.to_string(), json, missed))
}

/// A missed pair as JSON, the boxes of its frame, and the counter-example's files.
type Missed = (String, Py<PyArray2<f32>>, Vec<(String, Vec<u8>)>);

fn missed(py: Python<'_>, smallest: &SmallestCase) -> PyResult<Missed> {
    let boxes = &smallest.case.frames[smallest.miss.frame].boxes;
    let data = serde_json::json!({
        "case": smallest.from,
        "frame": smallest.miss.frame,
        "pair": smallest.miss.pair,
        "point": smallest.witness.as_ref().map(|witness| witness.decimals),
        "depth_ulps": smallest.witness.as_ref().and_then(|witness| witness.depth_ulps),
    });
    let files = counter_example(smallest)?;
    Ok((data.to_string(), matrix(py, boxes)?.unbind(), files))
}

/// The input of a culler's constructor: the shapes of a case, and the bodies of its first frame.
#[pyclass(frozen, get_all, module = "sdop")]
pub struct Scene {
    /// The claim by which it is judged.
    claim: &'static str,
    /// A dict for each shape: `name`, `vertices` (n, 3), `triangles` (m, 3), `ball` (centre and
    /// radius), and the or-DOP's `basis` (3, 3, a row for each axis), `lo` and `hi` (k / 2).
    shapes: Py<PyList>,
    /// Number of each body's shape, shape (n,).
    body_shapes: Py<PyArray1<u32>>,
    /// Whether each body may move, shape (n,).
    dynamic: Py<PyArray1<bool>>,
}

impl Scene {
    fn new(py: Python<'_>, case: &Case, bodies: &Bodies) -> PyResult<Self> {
        let shapes = PyList::empty(py);
        for shape in &case.shapes {
            let named = PyDict::new(py);
            named.set_item("name", &shape.name)?;
            named.set_item("vertices", matrix(py, &shape.vertices)?)?;
            named.set_item("triangles", matrix(py, &shape.triangles)?)?;
            named.set_item("ball", (shape.ball.centre, shape.ball.radius))?;
            named.set_item("basis", matrix(py, &shape.ordop.basis.columns)?)?;
            named.set_item("lo", PyArray1::from_slice(py, &shape.ordop.lo))?;
            named.set_item("hi", PyArray1::from_slice(py, &shape.ordop.hi))?;
            shapes.append(named)?;
        }
        Ok(Self {
            claim: case.claim.name(),
            shapes: shapes.unbind(),
            body_shapes: PyArray1::from_slice(py, &bodies.shape).unbind(),
            dynamic: PyArray1::from_slice(py, &bodies.dynamic).unbind(),
        })
    }
}

/// A Python class, or another callable that makes cullers.
struct PythonSubject {
    make: Py<PyAny>,
}

impl Subject for PythonSubject {
    fn answer(&self, case: &Case) -> Result<Vec<Answer>, StopReason> {
        let mut answered = Vec::new();
        // Threads of the judge hold the interpreter for a whole case: a case's frames come one
        // after the other.
        Python::attach(|py| match self.run(py, case, &mut answered) {
            Ok(None) => Ok(answered),
            Ok(Some(why)) => Err(StopReason::Skipped { why, answered }),
            Err(error) if error.is_instance_of::<CaseSkipped>(py) => {
                Err(StopReason::Skipped { why: error.value(py).to_string(), answered })
            }
            Err(error) => Err(StopReason::Trouble(AnswerError::Crashed {
                how: how(py, &error),
                answered: answered.len(),
                said: String::new(),
            })),
        })
    }
}

impl PythonSubject {
    /// Answers all frames, or returns the reason why the case is skipped.
    fn run(
        &self,
        py: Python<'_>,
        case: &Case,
        answers: &mut Vec<Answer>,
    ) -> PyResult<Option<String>> {
        let Some(first) = case.frames.first() else {
            return Ok(None);
        };
        let culler = self.make.bind(py).call1((Scene::new(py, case, &first.bodies)?,))?;
        for frame in &case.frames {
            if let Some(why) = prepared(&culler, frame)? {
                return Ok(Some(why.to_owned()));
            }
            let pairs = if case.claim.is_of_boxes() {
                culler.call_method1("frame", (matrix(py, &frame.boxes)?,))?
            } else {
                let rotations = matrix(py, &frame.bodies.rotation)?;
                let translations: Bound<'_, PyArray2<f32>> = matrix(py, &frame.bodies.translation)?;
                culler.call_method1("frame", (rotations, translations))?
            };
            let pairs = whole_rows::<2>(&pairs, "pairs")?;
            answers.push(Answer { pairs, ..Answer::default() });
            if frame.save && !told(&culler, "save", ())? {
                return Ok(Some("its state can't be saved".to_owned()));
            }
        }
        Ok(None)
    }
}

/// Calls a method that a culler may have. Returns false if it has none.
fn told<'py>(
    culler: &Bound<'py, PyAny>,
    method: &str,
    with: impl PyCallArgs<'py>,
) -> PyResult<bool> {
    let has = culler.hasattr(method)?;
    if has {
        culler.call_method1(method, with)?;
    }
    Ok(has)
}

/// Gives a culler what comes before a frame; what it can't do, if anything.
fn prepared(culler: &Bound<'_, PyAny>, frame: &Frame) -> PyResult<Option<&'static str>> {
    let py = culler.py();
    if frame.restore && !told(culler, "restore", ())? {
        return Ok(Some("it can't go back to a saved state"));
    }
    if let Some(was) = &frame.was
        && !change(culler, frame, was)?
    {
        return Ok(Some("its set of bodies can't change"));
    }
    if let Some(filter) = &frame.filter {
        let groups: Bound<'_, PyArray2<u32>> = matrix(py, &filter.groups)?;
        let excluded: Bound<'_, PyArray2<u32>> = matrix(py, &filter.excluded)?;
        if !told(culler, "filter", (groups, excluded))? {
            return Ok(Some("it has no filters"));
        }
    }
    if let Some(margins) = &frame.margins {
        let margins = PyArray1::from_slice(py, margins);
        if !told(culler, "margins", (margins,))? {
            return Ok(Some("it has no margins"));
        }
    }
    if let Some(periods) = frame.periods
        && !told(culler, "periods", (periods,))?
    {
        return Ok(Some("its space has no periods"));
    }
    if let Some(parts) = &frame.parts {
        let of_body = |parts: &Vec<BodyPart>| -> Vec<(u32, [f32; 7])> {
            parts.iter().map(|part| (part.shape, part.pose)).collect()
        };
        let parts: Vec<_> = parts.iter().map(of_body).collect();
        if !told(culler, "body_parts", (parts,))? {
            return Ok(Some("its bodies are single shapes"));
        }
    }
    Ok(None)
}

/// Tells a culler of another set of bodies; false if it can't have one.
fn change(culler: &Bound<'_, PyAny>, frame: &Frame, was: &[Option<u32>]) -> PyResult<bool> {
    let py = culler.py();
    if !culler.hasattr("change")? {
        return Ok(false);
    }
    let was: Vec<i64> = was.iter().map(|was| was.map_or(-1, i64::from)).collect();
    let shapes = PyArray1::from_slice(py, &frame.bodies.shape);
    let dynamic = PyArray1::from_slice(py, &frame.bodies.dynamic);
    culler.call_method1("change", (shapes, dynamic, PyArray1::from_vec(py, was)))?;
    Ok(true)
}

/// An exception with the line that raised it.
fn how(py: Python<'_>, error: &PyErr) -> String {
    let traceback = error.traceback(py).and_then(|traceback| traceback.format().ok());
    let last = traceback.as_deref().and_then(|text| text.trim_end().rsplit("File ").next());
    match last {
        Some(last) => {
            format!("{error}, in {}", last.split_whitespace().collect::<Vec<_>>().join(" "))
        }
        None => error.to_string(),
    }
}
