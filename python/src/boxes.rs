//! Axis-aligned boxes: one call, frames, and a world.

use std::sync::Mutex;
use std::time::Instant;

use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyIterator, PyTuple};
use sdop::boxes::BoxBody;
use sdop::{Aabb, BodyId, CullError, Finder, Groups, PairList};

use super::arguments::{GroupBits, Id};
use super::arrays::{Rows, check_length, id_column, matrix, one_row, pairs, rows, whole_rows};
use super::errors::{locked, refused};
use super::ids::{IdPairs, bits_of, collected};
use super::pickles::{self, reduced};
use super::world::{Events, read_back, saved};
use super::worlds::{
    Choices, SavedWorld, ShapeSlots, WorldState, counted, living_class, world_class,
};

const ROUND: &str = "pass float32, or leave `exact` out: boxes are then rounded as by `sdop.rounded_outward`, which misses none and may report boxes that all but touch";

/// Boxes in f32: those that f32 can't hold are rounded outward, unless they have to be `exact`.
fn boxes<'py>(given: &Bound<'py, PyAny>, exact: bool) -> PyResult<Rows<'py, 6>> {
    Ok(match rows(given, "boxes", exact, ROUND)? {
        Rows::Wide(wide) => Rows::Copied(outward(wide.as_chunks().0)),
        narrow => narrow,
    })
}

/// The numbers of the smallest f32 boxes that contain these.
fn outward(boxes: &[[f64; 6]]) -> Vec<f32> {
    let outward = boxes.iter().map(|&[a, b, c, d, e, f]| Aabb::outward([a, b, c], [d, e, f]));
    outward.flat_map(|Aabb { min, max }| [min, max]).flatten().collect()
}

/// The rows as boxes.
fn aabbs<'a>(rows: &'a Rows<'_, 6>) -> &'a [Aabb] {
    Aabb::from_rows(rows.narrow().unwrap_or_default())
}

/// Rounds boxes of float64 to the smallest boxes of float32 that contain them.
///
/// No pair is missed with them; boxes that are apart by less than the rounding may be reported.
///
/// Parameters
/// ----------
/// boxes : array of floats, shape (n, 6) or (n, 2, 3)
///     Lower corner x, y, z, then the upper one.
///
/// Returns
/// -------
/// array of float32, shape (n, 6)
#[pyfunction]
pub fn rounded_outward<'py>(boxes: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<f32>>> {
    let rows = rows::<6>(boxes, "boxes", false, "")?.wide();
    matrix(boxes.py(), outward(&rows).as_chunks::<6>().0)
}

/// Pairs as rows, sorted if `sort` is true.
pub(super) fn list(found: &PairList, sort: bool) -> Result<Vec<[u32; 2]>, CullError> {
    let mut rows = collected(found.iter())?;
    if sort {
        rows.sort_unstable();
    }
    Ok(rows)
}

/// Groups as two numbers: those that a body is in, and those that it collides with.
pub(super) fn groups(
    given: Option<&Bound<'_, PyAny>>,
    bodies: usize,
) -> PyResult<Option<Vec<Groups>>> {
    let Some(given) = given else { return Ok(None) };
    let given = whole_rows::<2>(given, "groups")?;
    check_length("groups", given.len(), bodies)?;
    let groups = given.into_iter().map(|[member, mask]| Groups { member, mask });
    Ok(Some(groups.collect()))
}

/// Finds the pairs of boxes that meet, touching included.
///
/// Parameters
/// ----------
/// boxes : array of float32 or float64, shape (n, 6) or (n, 2, 3)
///     Lower corner x, y, z, then the upper one. Boxes that float32 can't hold are rounded outward.
/// groups : array of whole numbers, shape (n, 2), optional
///     Bits of the groups that each box is in, and of those that it collides with.
/// sort : bool
///     Whether the rows are sorted. Otherwise equal boxes give an equal order.
/// threads : int
///     Number of threads.
/// exact : bool
///     Whether boxes that float32 can't hold are rejected.
/// limit : int, optional
///     More pairs than that are an error, and memory for them is never allocated.
///
/// Returns
/// -------
/// array of uint32, shape (m, 2)
///     Each pair i < j once: exactly those that share a point in exact arithmetic. If boxes were
///     rounded, some may be reported that all but touch.
#[pyfunction]
#[pyo3(signature = (boxes, *, groups=None, sort=false, threads=1, exact=false, limit=None))]
pub fn box_pairs<'py>(
    py: Python<'py>,
    boxes: &Bound<'py, PyAny>,
    groups: Option<&Bound<'py, PyAny>>,
    sort: bool,
    threads: usize,
    exact: bool,
    limit: Option<usize>,
) -> PyResult<Bound<'py, PyArray2<u32>>> {
    BoxCuller::new("auto", threads)?.cull(py, boxes, groups, sort, exact, limit)
}

/// Finds the boxes that meet, frame after frame. It is faster than `box_pairs`, since results of
/// one frame are reused in the next.
///
/// Parameters
/// ----------
/// finder : str
///     The algorithm that finds candidates. The reported set doesn't depend on it.
/// threads : int
///     Number of threads.
#[pyclass(frozen, module = "sdop")]
pub struct BoxCuller(Mutex<TimedCuller>);

struct TimedCuller {
    culler: sdop::BoxCuller,
    seconds: f64,
}

#[pymethods]
impl BoxCuller {
    #[new]
    #[pyo3(signature = (*, finder="auto", threads=1))]
    fn new(finder: &str, threads: usize) -> PyResult<Self> {
        let finder: Finder = finder.parse().map_err(refused)?;
        let builder = sdop::BoxCuller::builder().finder(finder).threads(threads);
        Ok(Self(Mutex::new(TimedCuller {
            culler: builder.build().map_err(refused)?,
            seconds: 0.0,
        })))
    }

    /// The pairs of this frame's boxes, in the form of `box_pairs`. The number of boxes may change
    /// from frame to frame.
    #[pyo3(signature = (boxes, *, groups=None, sort=false, exact=false, limit=None))]
    fn cull<'py>(
        &self,
        py: Python<'py>,
        boxes: &Bound<'py, PyAny>,
        groups: Option<&Bound<'py, PyAny>>,
        sort: bool,
        exact: bool,
        limit: Option<usize>,
    ) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let given = self::boxes(boxes, exact)?;
        let boxes = aabbs(&given);
        let groups = self::groups(groups, boxes.len())?;
        let found = locked(py, &self.0, |TimedCuller { culler, seconds }| {
            culler.set_groups(groups);
            let start = Instant::now();
            let found = match limit {
                Some(limit) => culler.cull_up_to(boxes, limit),
                None => culler.cull(boxes),
            };
            *seconds = start.elapsed().as_secs_f64();
            found.and_then(|found| list(found, sort))
        });
        pairs(py, found.map_err(refused)?)
    }

    /// Seconds of the last `cull`, without the time for passing arrays.
    #[getter]
    fn seconds(&self, py: Python<'_>) -> f64 {
        locked(py, &self.0, |timed| timed.seconds)
    }
}

living_class! {
    /// A long-lived set of boxes: stable ids, boxes at rest, groups, and pairs as a list or as
    /// events. Pairs are exactly those of boxes that share a point.
    ///
    /// Parameters
    /// ----------
    /// finder : str
    ///     The algorithm that finds candidates. The reported set doesn't depend on it.
    /// threads : int
    ///     Number of threads.
    BoxWorld, sdop::BoxWorld, BoxBody, |boxes, _| counted(boxes, "box", "boxes"), {
        #[new]
        #[pyo3(signature = (*, finder="auto", threads=1))]
        fn new(finder: &str, threads: usize) -> PyResult<Self> {
            let choices = (String::new(), finder.to_owned(), threads);
            Ok(Self(Mutex::new(Self::made(Vec::new(), choices)?)))
        }

        /// Adds a box (lower corner x, y, z, then the upper one, rounded outward if float32 can't
        /// hold them) and returns its id, which stays until `remove`. `motion` and `groups` are
        /// those of `World.insert`; `exact` rejects bounds that float32 can't hold.
        #[pyo3(signature = (bounds, *, motion="dynamic", groups=GroupBits(Groups::ALL), exact=false))]
        fn insert(
            &self, py: Python<'_>, bounds: &Bound<'_, PyAny>, motion: &str, groups: GroupBits, exact: bool,
        ) -> PyResult<u64> {
            let bounds = one(bounds, exact)?;
            let body = BoxBody { bounds, motion: super::world::motion(motion)?, groups: groups.0 };
            locked(py, &self.0, |state| state.world.insert(body)).map(BodyId::to_bits).map_err(refused)
        }

        /// Moves or resizes a box.
        #[pyo3(signature = (id, bounds, *, exact=false))]
        fn set_bounds(
            &self, py: Python<'_>, id: Id, bounds: &Bound<'_, PyAny>, exact: bool,
        ) -> PyResult<()> {
            let bounds = one(bounds, exact)?;
            locked(py, &self.0, |state| state.world.set_bounds(id.0, bounds)).map_err(refused)
        }

        /// Moves many boxes: ids of shape (n,), boxes in the form of `box_pairs`. If one is
        /// rejected, those before it have moved.
        #[pyo3(signature = (ids, boxes, *, exact=false))]
        fn set_many(
            &self, py: Python<'_>, ids: &Bound<'_, PyAny>, boxes: &Bound<'_, PyAny>, exact: bool,
        ) -> PyResult<()> {
            let (ids, given) = (id_column(ids, "ids")?, self::boxes(boxes, exact)?);
            let boxes = aabbs(&given);
            check_length("boxes", boxes.len(), ids.len())?;
            let ids: Vec<_> = ids.iter().map(|&id| BodyId::from_bits(id)).collect();
            locked(py, &self.0, |state| state.world.set_many(&ids, boxes)).map_err(refused)
        }
    }
}

impl BoxWorld {
    /// A world of choices by name. It has no shapes and one strategy.
    fn made(shapes: ShapeSlots, choices: Choices) -> PyResult<WorldState<sdop::BoxWorld>> {
        let finder: Finder = choices.1.parse().map_err(refused)?;
        let builder = sdop::BoxCuller::builder().finder(finder).threads(choices.2);
        let world = sdop::BoxWorld::with(&builder).map_err(refused)?;
        Ok(WorldState { world, shapes, choices })
    }
}

/// One box: six numbers, or two corners.
fn one(given: &Bound<'_, PyAny>, exact: bool) -> PyResult<Aabb> {
    let remedy = "pass six numbers: the lower corner, then the upper one";
    let given = boxes(&one_row::<6>(given, "bounds", remedy)?, exact)?;
    Ok(aabbs(&given)[0])
}
