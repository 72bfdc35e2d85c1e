//! Queries about the bodies of a world, many at a time.

use std::sync::Mutex;

use numpy::PyArray1;
use pyo3::prelude::*;
use sdop::query::{Answers, LineHit, QueryShape, QueryVolume};
use sdop::{BodyId, Line};

use super::arguments::mistyped;
use super::arrays::{check_length, pairs, rows, wide_column, wide_rows};
use super::boxes::BoxWorld;
use super::errors::{lock, locked, refused, with_help};
use super::ids::{IdPairs, bits_of};
use super::shape::Shape;
use super::world::{ROUND, World};
use super::worlds::counted;

/// The bodies of a `World` or a `BoxWorld`, prepared for queries: which may touch a volume, and
/// which does a segment meet?
///
/// Queries are about the bodies as they were at the last `update`; no cull is needed. No body is
/// missed that has a point in common with the volume or the segment in exact arithmetic. Bodies of
/// a `World` are grown by their margins and tested by their volumes, so some may be reported whose
/// meshes don't touch. Groups, and whether a body moves, have no effect.
///
/// Coordinates are in the world's frame and of float64. An answer is an array of uint64 of shape
/// (m, 2): in each row the number of a query, counted from 0, and the id of a body.
///
/// Parameters
/// ----------
/// threads : int
///     Number of threads that share the queries of a call. Answers don't depend on it.
/// limit : int, optional
///     More answers to a call are an error.
#[pyclass(frozen, module = "sdop")]
pub struct QueryIndex(Mutex<sdop::QueryIndex>);

/// Rows of a query's number and a body's id, and the hits' parameters.
type Hits<'py> = (IdPairs<'py>, Bound<'py, PyArray1<f64>>);

#[pymethods]
impl QueryIndex {
    #[new]
    #[pyo3(signature = (*, threads=1, limit=None))]
    fn new(threads: usize, limit: Option<usize>) -> PyResult<Self> {
        let index = sdop::QueryIndex::with_threads(threads).map_err(refused)?;
        Ok(Self(Mutex::new(index.most_answers(limit.unwrap_or(usize::MAX)))))
    }

    /// Brings the index up to date with a `World` or a `BoxWorld`. Only bodies that have changed
    /// since the last update cost more than a comparison.
    fn update(&self, py: Python<'_>, world: &Bound<'_, PyAny>) -> PyResult<()> {
        if let Ok(world) = world.cast::<World>().map(Bound::get) {
            locked(py, &self.0, |index| index.update(&lock(&world.0).world));
        } else if let Ok(world) = world.cast::<BoxWorld>().map(Bound::get) {
            locked(py, &self.0, |index| index.update(&lock(&world.0).world));
        } else {
            return Err(mistyped("the world", world, "pass a `World` or a `BoxWorld`"));
        }
        Ok(())
    }

    /// The bodies that may touch boxes on the world's axes.
    ///
    /// Parameters
    /// ----------
    /// boxes : array of floats, shape (n, 6) or (n, 2, 3)
    ///     Lower corner x, y, z, then the upper one.
    ///
    /// Returns
    /// -------
    /// array of uint64, shape (m, 2)
    ///     Rows of a box's number and a body's id, sorted by both.
    fn touching_boxes<'py>(
        &self,
        py: Python<'py>,
        boxes: &Bound<'py, PyAny>,
    ) -> PyResult<IdPairs<'py>> {
        let boxes = wide_rows::<6>(boxes, "boxes")?;
        let volumes = boxes.into_iter().map(|[ax, ay, az, bx, by, bz]| {
            let (min, max) = ([ax, ay, az], [bx, by, bz]);
            QueryVolume::Box { min, max }
        });
        self.touching(py, volumes.collect())
    }

    /// The bodies that may touch balls, or points where a radius is 0.
    ///
    /// Parameters
    /// ----------
    /// centres : array of floats, shape (n, 3)
    /// radii : array of floats, shape (n,)
    ///
    /// Returns
    /// -------
    /// array of uint64, shape (m, 2)
    ///     Rows of a ball's number and a body's id, sorted by both.
    fn touching_balls<'py>(
        &self,
        py: Python<'py>,
        centres: &Bound<'py, PyAny>,
        radii: &Bound<'py, PyAny>,
    ) -> PyResult<IdPairs<'py>> {
        let (centres, radii) = (wide_rows::<3>(centres, "centres")?, wide_column(radii, "radii")?);
        check_length("radii", radii.len(), centres.len())?;
        let balls = centres.into_iter().zip(radii);
        let volumes = balls.map(|(centre, radius)| QueryVolume::Ball { centre, radius });
        self.touching(py, volumes.collect())
    }

    /// The bodies that may touch a shape at poses, for example to find a free place for it.
    ///
    /// Parameters
    /// ----------
    /// shape : Shape
    ///     Its ball and its or-DOP are tested.
    /// rotations : array of float32 or float64, shape (n, 4)
    ///     Quaternions x, y, z, w of any non-zero norm. If float32 can't hold one, the shape is
    ///     grown by what rounding moves.
    /// translations : array of floats, shape (n, 3)
    /// margin : float
    ///     A length by which the shape is grown.
    /// exact : bool
    ///     Whether rotations that float32 can't hold are rejected.
    ///
    /// Returns
    /// -------
    /// array of uint64, shape (m, 2)
    ///     Rows of a pose's number and a body's id, sorted by both.
    #[pyo3(signature = (shape, rotations, translations, *, margin=0.0, exact=false))]
    fn touching_shapes<'py>(
        &self,
        py: Python<'py>,
        shape: &Shape,
        rotations: &Bound<'py, PyAny>,
        translations: &Bound<'py, PyAny>,
        margin: f32,
        exact: bool,
    ) -> PyResult<IdPairs<'py>> {
        let rotations = rows::<4>(rotations, "rotations", exact, ROUND)?.wide();
        let translations = wide_rows::<3>(translations, "translations")?;
        check_length("translations", translations.len(), rotations.len())?;
        let shape = &QueryShape::new(&shape.built);
        let poses = rotations.into_iter().zip(translations);
        let volumes = poses.map(|(q, t)| QueryVolume::shape(shape, q, t, margin));
        self.touching(py, volumes.collect())
    }

    /// All bodies that segments or rays may meet.
    ///
    /// Parameters
    /// ----------
    /// starts : array of floats, shape (n, 3)
    /// ends : array of floats, shape (n, 3)
    ///     For segments: the points start + s·(end − start) for 0 ≤ s ≤ 1.
    /// directions : array of floats, shape (n, 3)
    ///     For rays, in place of ends: the points start + s·direction for 0 ≤ s.
    ///
    /// Returns
    /// -------
    /// array of uint64, shape (m, 2)
    ///     Rows of a line's number and a body's id, sorted by the number and by s.
    /// array of float64, shape (m,)
    ///     For each row an s at or before the first point that the line shares with the body.
    #[pyo3(signature = (starts, ends=None, *, directions=None))]
    fn along<'py>(
        &self,
        py: Python<'py>,
        starts: &Bound<'py, PyAny>,
        ends: Option<&Bound<'py, PyAny>>,
        directions: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Hits<'py>> {
        let lines = lines(starts, ends, directions)?;
        let found = locked(py, &self.0, |index| index.along_all(&lines));
        hits(py, &found.map_err(refused)?)
    }

    /// The body that each segment or ray may meet first: none is met at a smaller s. Parameters and
    /// result as for `along`, with at most one row per line.
    #[pyo3(signature = (starts, ends=None, *, directions=None))]
    fn first<'py>(
        &self,
        py: Python<'py>,
        starts: &Bound<'py, PyAny>,
        ends: Option<&Bound<'py, PyAny>>,
        directions: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Hits<'py>> {
        let lines = lines(starts, ends, directions)?;
        let found = locked(py, &self.0, |index| index.first_all(&lines));
        hits(py, &found.map_err(refused)?)
    }

    /// The pairs of a body of this index and one of another that may touch: ids of shape (m, 2),
    /// this index's first. More than this index's `limit` are an error.
    fn pairs_with<'py>(&self, py: Python<'py>, other: &Self) -> PyResult<IdPairs<'py>> {
        // A copy, so that one lock at a time is held.
        let other = locked(py, &other.0, |index| index.clone());
        let found = locked(py, &self.0, |index| index.pairs_with(&other)).map_err(refused)?;
        pairs(py, bits_of(found.into_iter()).map_err(refused)?)
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        format!("<sdop.QueryIndex: {}>", counted(self.__len__(py), "body", "bodies"))
    }

    fn __len__(&self, py: Python<'_>) -> usize {
        locked(py, &self.0, |index| index.len())
    }
}

impl QueryIndex {
    fn touching<'py>(
        &self,
        py: Python<'py>,
        volumes: Vec<QueryVolume<'_>>,
    ) -> PyResult<IdPairs<'py>> {
        let found = locked(py, &self.0, |index| index.touching_all(&volumes));
        pairs(py, numbered(&found.map_err(refused)?, |&id| id))
    }
}

fn lines(
    starts: &Bound<'_, PyAny>,
    ends: Option<&Bound<'_, PyAny>>,
    directions: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<Line>> {
    let starts = wide_rows::<3>(starts, "starts")?;
    let Some(given) = ends.xor(directions) else {
        let help = "pass `ends` for segments, or `directions` for rays";
        return Err(with_help("a line has either an end or a direction", help));
    };
    let what = if ends.is_some() { "ends" } else { "directions" };
    let given = wide_rows::<3>(given, what)?;
    check_length(what, given.len(), starts.len())?;
    let line = |(from, to)| match ends {
        Some(_) => Line::Segment { from, to },
        None => Line::Ray { origin: from, direction: to },
    };
    Ok(starts.into_iter().zip(given).map(line).collect())
}

fn hits<'py>(py: Python<'py>, answers: &Answers<LineHit>) -> PyResult<Hits<'py>> {
    let at: Vec<f64> = answers.iter().flatten().map(|hit| hit.at).collect();
    let rows = pairs(py, numbered(answers, |hit| hit.body))?;
    Ok((rows, PyArray1::from_vec(py, at)))
}

/// Rows of a query's number and the id in each of its answers.
fn numbered<T>(answers: &Answers<T>, id: impl Fn(&T) -> BodyId) -> Vec<[u64; 2]> {
    let mut rows = Vec::new();
    for (query, found) in (0..).zip(answers.iter()) {
        rows.extend(found.iter().map(|answer| [query, id(answer).to_bits()]));
    }
    rows
}
