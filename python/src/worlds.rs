//! What the classes of long-lived sets have in common: macros that add methods to a class's own.
//! `mesh_class` adds those of posed meshes, `living_class` those of worlds with snapshots, and both
//! pass on to `world_class`, which adds those of every world.

use std::sync::Arc;

use pyo3::Py;
use sdop_bench::report::digits::thousands;

use super::shape::Shape;

/// A world, and of what it was made.
#[derive(Clone)]
pub struct WorldState<W> {
    pub world: W,
    pub choices: Choices,
    pub shapes: ShapeSlots,
}

/// Strategy, finder and number of threads.
pub type Choices = (String, String, usize);

/// Shapes by their numbers; `None` for a number that is free.
pub type ShapeSlots = Vec<Option<Arc<sdop::Shape>>>;

/// The shapes, choices and snapshot of which a world is made again.
pub type SavedWorld = (Vec<Option<Py<Shape>>>, Choices, Vec<u8>);

/// A number with its noun, such as "1 body" and "5,856 triangles".
pub fn counted(number: usize, one: &str, many: &str) -> String {
    format!("{} {}", thousands(number as f64), if number == 1 { one } else { many })
}

/// A class with its own methods, and those of every world. `$body` is the library's body, and
/// `$contents` says what a world holds.
macro_rules! world_class {
    ($(#[$doc:meta])* $name:ident, $world:ty, $body:ty, $contents:expr, { $($own:tt)* }) => {
        $(#[$doc])*
        #[pyclass(frozen, module = "sdop")]
        pub struct $name(pub(super) Mutex<WorldState<$world>>);

        impl $name {
            /// Changes a body, as `change` says.
            fn change(
                &self, py: Python<'_>, Id(id): Id, change: impl Send + FnOnce(&mut $body),
            ) -> PyResult<()> {
                locked(py, &self.0, |WorldState { world, .. }| {
                    let mut body = world.body(id)?;
                    change(&mut body);
                    world.set(id, body)
                })
                .map_err(refused)
            }
        }

        #[pymethods]
        impl $name {
            $($own)*

            /// Removes a body.
            fn remove(&self, py: Python<'_>, id: Id) -> PyResult<()> {
                locked(py, &self.0, |state| state.world.remove(id.0)).map_err(refused)
            }

            /// Puts a body to rest, wakes it, or fixes it: "resting", "dynamic" or "fixed". Putting
            /// a body to rest begins and ends no pair.
            fn set_motion(&self, py: Python<'_>, id: Id, motion: &str) -> PyResult<()> {
                let motion = super::world::motion(motion)?;
                self.change(py, id, |body| body.motion = motion)
            }

            /// Changes the bits of the groups that a body is in, and of those that it collides
            /// with.
            fn set_groups(&self, py: Python<'_>, id: Id, groups: GroupBits) -> PyResult<()> {
                self.change(py, id, |body| body.groups = groups.0)
            }

            /// Never reports the pair of two bodies again, such as two links that share a joint,
            /// until `include` or until one of them is removed. Returns whether it wasn't excluded
            /// yet.
            fn exclude(&self, py: Python<'_>, a: Id, b: Id) -> PyResult<bool> {
                locked(py, &self.0, |state| state.world.exclude(a.0, b.0)).map_err(refused)
            }

            /// Reports the pair of two bodies again when it meets. Returns whether it was excluded.
            fn include(&self, py: Python<'_>, a: Id, b: Id) -> PyResult<bool> {
                locked(py, &self.0, |state| state.world.include(a.0, b.0)).map_err(refused)
            }

            /// The ids of all bodies: an array of uint64, shape (n,), ascending.
            fn ids<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u64>> {
                let mut ids: Vec<u64> =
                    locked(py, &self.0, |state| state.world.ids().map(BodyId::to_bits).collect());
                ids.sort_unstable();
                PyArray1::from_vec(py, ids)
            }

            fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
                self.ids(py).call_method0("tolist")?.try_iter()
            }

            fn __len__(&self, py: Python<'_>) -> usize {
                locked(py, &self.0, |state| state.world.len())
            }

            fn __contains__(&self, py: Python<'_>, id: &Bound<'_, PyAny>) -> bool {
                let id = id.extract::<u64>();
                id.is_ok_and(|id| locked(py, &self.0, |state| state.world.contains(BodyId::from_bits(id))))
            }

            /// A copy that continues as this world would, with the same ids.
            fn __copy__(&self, py: Python<'_>) -> Self {
                Self(Mutex::new(locked(py, &self.0, |state| state.clone())))
            }

            fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> Self {
                self.__copy__(py)
            }

            fn __repr__(&self, py: Python<'_>) -> String {
                let contents: fn(usize, usize) -> String = $contents;
                let count = |it: &mut WorldState<$world>| (it.world.len(), it.shapes.iter().flatten().count());
                let (bodies, shapes) = locked(py, &self.0, count);
                format!("<sdop.{}: {}>", stringify!($name), contents(bodies, shapes))
            }
        }
    };
}

/// A class with its own methods, and those of worlds with snapshots.
macro_rules! living_class {
    ($(#[$doc:meta])* $name:ident, $world:ty, $body:ty, $contents:expr, { $($own:tt)* }) => {
        world_class! { $(#[$doc])* $name, $world, $body, $contents, {
            $($own)*

            /// Finds the pairs that might touch now: ids of shape (m, 2), sorted. More than `limit`
            /// pairs are an error.
            #[pyo3(signature = (*, limit=None))]
            fn cull<'py>(&self, py: Python<'py>, limit: Option<usize>) -> PyResult<IdPairs<'py>> {
                let found = locked(py, &self.0, |WorldState { world, .. }| {
                    let found = match limit {
                        Some(limit) => world.cull_up_to(limit)?,
                        None => world.cull()?,
                    };
                    Ok::<_, sdop::WorldError>(bits_of(found.iter())?)
                });
                pairs(py, found.map_err(refused)?)
            }

            /// The pairs of the last cull: ids of shape (m, 2), sorted.
            fn pairs<'py>(&self, py: Python<'py>) -> PyResult<IdPairs<'py>> {
                let found = locked(py, &self.0, |state| bits_of(state.world.pairs()));
                pairs(py, found.map_err(refused)?)
            }

            /// The pairs that began, persisted or ended between the last call of this method and
            /// the last cull.
            fn events(&self, py: Python<'_>) -> Events {
                Events(locked(py, &self.0, |state| state.world.events()))
            }

            /// The world as bytes, for `restore` here or elsewhere: bodies, ids, pairs and events,
            /// without shapes.
            fn snapshot(&self, py: Python<'_>) -> PyResult<Vec<u8>> {
                saved(&locked(py, &self.0, |state| state.world.snapshot()))
            }

            /// Replaces this world by that of a snapshot. A `World` must have the same shapes under
            /// the same numbers.
            fn restore(&self, py: Python<'_>, snapshot: &[u8]) -> PyResult<()> {
                let snapshot = read_back(snapshot)?;
                locked(py, &self.0, |state| state.world.restore(&snapshot)).map_err(refused)
            }

            /// Pickles the world with its shapes and choices.
            fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
                let (shapes, choices, snapshot) = locked(py, &self.0, |state| {
                    (state.shapes.clone(), state.choices.clone(), state.world.snapshot())
                });
                let shape = |shape| Py::new(py, super::shape::Shape::from(shape));
                let shapes = shapes.into_iter().map(|it| it.map(shape).transpose());
                let shapes = shapes.collect::<PyResult<Vec<_>>>()?;
                reduced::<Self>(py, (shapes, choices, PyBytes::new(py, &saved(&snapshot)?)))
            }

            #[staticmethod]
            fn _unpickled(version: u32, state: &Bound<'_, PyAny>) -> PyResult<Self> {
                let (shapes, choices, snapshot): SavedWorld = pickles::state(version, state)?;
                let shapes = shapes.iter().map(|it| it.as_ref().map(|shape| shape.get().built.clone())).collect();
                let mut state = Self::made(shapes, choices)?;
                state.world.restore(&read_back(&snapshot)?).map_err(refused)?;
                Ok(Self(Mutex::new(state)))
            }
        } }
    };
}

/// A class of posed meshes: its own methods, and those of both such worlds. `$outer` adds more, and
/// `$place` moves a body of the world.
macro_rules! mesh_class {
    ($outer:ident, $place:path, $(#[$doc:meta])* $name:ident, $world:ty, { $($own:tt)* }) => {
        $outer! { $(#[$doc])* $name, $world, sdop::Body, |bodies, shapes| {
            let bodies = counted(bodies, "body", "bodies");
            format!("{bodies} of {}", counted(shapes, "shape", "shapes"))
        }, {
            $($own)*

            /// Adds a body and returns its id, which stays until `remove`.
            ///
            /// Parameters
            /// ----------
            /// shape : int
            ///     Number of its shape.
            /// rotation : four numbers
            ///     Quaternion x, y, z, w of any non-zero norm. If float32 can't hold it, the body
            ///     is grown by what rounding it may move, rounded up to about 2**-12 of its reach.
            /// translation : three numbers
            ///     Position of its origin, in world coordinates, in float64.
            /// margin : float
            ///     A length: pairs are reported whose meshes, each grown by its margin, meet.
            /// motion : {"dynamic", "resting", "fixed"}
            ///     Whether it may move; pairs of two fixed bodies are never reported.
            /// groups : (int, int)
            ///     Bits of the groups that it is in, and of those that it collides with.
            /// exact : bool
            ///     Whether a rotation that float32 can't hold is rejected.
            #[pyo3(signature = (shape, rotation, translation, *, margin=0.0, motion="dynamic", groups=GroupBits(Groups::ALL), exact=false))]
            #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
            fn insert(
                &self, py: Python<'_>, shape: ShapeNumber,
                rotation: &Bound<'_, PyAny>, translation: &Bound<'_, PyAny>,
                margin: f32, motion: &str, groups: GroupBits, exact: bool,
            ) -> PyResult<u64> {
                let (rotation, translation) = pose(rotation, translation, exact)?;
                let (motion, groups) = (super::world::motion(motion)?, groups.0);
                let body = Body { shape: shape.0, motion, margin, groups, ..Body::default() };
                let body = Body { translation, ..body }.turned(rotation);
                locked(py, &self.0, |state| state.world.insert(body)).map(BodyId::to_bits).map_err(refused)
            }

            /// Moves a body by any distance.
            #[pyo3(signature = (id, rotation, translation, *, exact=false))]
            fn set_pose(
                &self, py: Python<'_>, id: Id,
                rotation: &Bound<'_, PyAny>, translation: &Bound<'_, PyAny>, exact: bool,
            ) -> PyResult<()> {
                let (q, t) = pose(rotation, translation, exact)?;
                locked(py, &self.0, |state| $place(&mut state.world, id.0, q, t)).map_err(refused)
            }

            /// Moves many bodies: ids of shape (n,), rotations (n, 4), translations (n, 3). If one
            /// is rejected, those before it have moved.
            #[pyo3(signature = (ids, rotations, translations, *, exact=false))]
            fn set_poses(
                &self, py: Python<'_>, ids: &Bound<'_, PyAny>,
                rotations: &Bound<'_, PyAny>, translations: &Bound<'_, PyAny>, exact: bool,
            ) -> PyResult<()> {
                let ids = id_column(ids, "ids")?;
                let rotations = rows::<4>(rotations, "rotations", exact, ROUND)?.wide();
                let translations = wide_rows::<3>(translations, "translations")?;
                check_length("rotations", rotations.len(), ids.len())?;
                check_length("translations", translations.len(), ids.len())?;
                locked(py, &self.0, |WorldState { world, .. }| {
                    let mut all = ids.iter().zip(rotations.into_iter().zip(translations));
                    all.try_for_each(|(&id, (q, t))| $place(world, BodyId::from_bits(id), q, t))
                })
                .map_err(refused)
            }

            /// Gives a body another shape, by its number.
            fn set_shape(&self, py: Python<'_>, id: Id, shape: ShapeNumber) -> PyResult<()> {
                self.change(py, id, |body| body.shape = shape.0)
            }

            /// Changes the margin of a body, a length.
            fn set_margin(&self, py: Python<'_>, id: Id, margin: f32) -> PyResult<()> {
                self.change(py, id, |body| body.margin = margin)
            }

            /// The present body, with the names of `insert`'s parameters, and whether its rotation,
            /// in float32, was "rounded".
            fn body<'py>(&self, py: Python<'py>, id: Id) -> PyResult<Bound<'py, PyDict>> {
                let body = locked(py, &self.0, |state| state.world.body(id.0)).map_err(refused)?;
                named(py, &body)
            }
        } }
    };
}

/// The class of what has changed between two calls of `events`; `$arrays` makes arrays of a list.
macro_rules! events_class {
    ($(#[$doc:meta])* $name:ident, $events:ty, $lists:ty, $arrays:path) => {
        $(#[$doc])*
        #[pyclass(frozen, module = "sdop")]
        pub struct $name(pub(super) $events);

        #[pymethods]
        impl $name {
            /// Pairs reported now and not before.
            #[getter]
            fn begun<'py>(&self, py: Python<'py>) -> PyResult<$lists> {
                $arrays(py, self.0.begun())
            }

            /// Pairs reported now and before.
            #[getter]
            fn persisting<'py>(&self, py: Python<'py>) -> PyResult<$lists> {
                $arrays(py, self.0.persisting())
            }

            /// Pairs reported before and not now; in periodic space with their former images.
            #[getter]
            fn ended<'py>(&self, py: Python<'py>) -> PyResult<$lists> {
                $arrays(py, self.0.ended())
            }

            fn __repr__(&self) -> String {
                let Self(it) = self;
                let [begun, ended] = [it.begun().into_iter().count(), it.ended().into_iter().count()];
                let [begun, ended] = [begun, ended].map(|pairs| counted(pairs, "pair", "pairs"));
                format!("<sdop.{}: {begun} begun, {ended} ended>", stringify!($name))
            }
        }
    };
}

pub(super) use {events_class, living_class, mesh_class, world_class};
