//! What crosses the border: statuses, the last error, columns, buffers and callbacks.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::NonNull;
use std::slice;

use crate::bodies::contract::ContractError;
use crate::choice::UnknownChoice;
use crate::compound::CompoundError;
use crate::cull_error::CullError;
use crate::living::{BodyId, Event, Events, SnapshotError, WorldError};
use crate::mesh::MeshError;
use crate::pairs::PairList;
use crate::periodic::PeriodicError;
use crate::query::QueryError;
use crate::volume::VolumeError;

/// How a call ended.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SdopStatus {
    /// The call succeeded.
    Ok = 0,
    /// Invalid input. Entries of a column before the invalid one have been applied.
    Refused = 1,
    /// The buffer is too small; the count says how much is needed.
    TooSmall = 2,
    /// A pointer that must not be null is null.
    Null = 3,
    /// A bug of sdop: free the handle, and report it.
    Bug = 4,
}

/// Two bodies by their numbers, the lower one first.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SdopPair {
    /// The lower number.
    pub first: u32,
    /// The higher number.
    pub second: u32,
}

/// Two bodies of a world by their ids, the lower slot first.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SdopIdPair {
    /// The id of the lower slot.
    pub first: u64,
    /// The id of the higher slot.
    pub second: u64,
}

impl From<[BodyId; 2]> for SdopIdPair {
    fn from(pair: [BodyId; 2]) -> Self {
        let [first, second] = pair.map(BodyId::to_bits);
        Self { first, second }
    }
}

/// How a pair has changed.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SdopEventKind {
    /// Reported now and not before.
    Begun = 0,
    /// Reported now and before.
    Persisting = 1,
    /// Reported before and not now.
    Ended = 2,
}

/// A pair and how it has changed.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SdopEvent {
    /// How it has changed.
    pub kind: SdopEventKind,
    /// The pair.
    pub pair: SdopIdPair,
}

/// Receives some of a frame's pairs and their number, after the pointer that was passed along. Must
/// return normally.
pub type SdopTakePairs = Option<unsafe extern "C" fn(*mut c_void, *const SdopPair, usize)>;

/// Receives an event, after the pointer that was passed along. Must return normally.
pub type SdopTakeEvent = Option<unsafe extern "C" fn(*mut c_void, SdopEvent)>;

thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

pub fn last_error() -> *const c_char {
    LAST_ERROR.with(|text| text.borrow().as_ptr())
}

/// Why a call fails.
pub struct Refusal {
    status: SdopStatus,
    text: String,
}

impl Refusal {
    pub fn new(status: SdopStatus, text: impl Into<String>) -> Self {
        let text = text.into();
        Self { status, text }
    }
}

macro_rules! refusals {
    ($($error:ty),+) => {
        $(impl From<$error> for Refusal {
            fn from(error: $error) -> Self {
                let text = format!("{}\nhelp: {}", error.problem(), error.help());
                Self::new(SdopStatus::Refused, text)
            }
        })+
    };
}
refusals!(
    UnknownChoice,
    CompoundError,
    ContractError,
    CullError,
    MeshError,
    PeriodicError,
    QueryError,
    VolumeError,
    WorldError,
    SnapshotError
);

/// Carries out a call, and keeps why it failed.
pub fn call(run: impl FnOnce() -> Result<(), Refusal>) -> SdopStatus {
    let (status, text) = match catch_unwind(AssertUnwindSafe(run)) {
        Ok(Ok(())) => (SdopStatus::Ok, String::new()),
        Ok(Err(Refusal { status, text })) => (status, text),
        Err(_) => (
            SdopStatus::Bug,
            "a bug of sdop\nhelp: free the handle, and report what was called".to_owned(),
        ),
    };
    let text = CString::new(text.replace('\0', "\\0")).unwrap_or_default();
    LAST_ERROR.with(|last| *last.borrow_mut() = text);
    status
}

pub fn null(what: &str) -> Refusal {
    Refusal::new(SdopStatus::Null, format!("{what} is null\nhelp: pass a pointer"))
}

/// What a handle points to.
///
/// # Safety
/// The pointer is null, or from the function that makes such handles and not freed, and no other
/// call uses it meanwhile.
pub unsafe fn handle<'a, T>(handle: *mut T, what: &str) -> Result<&'a mut T, Refusal> {
    // SAFETY: the caller's promise.
    unsafe { handle.as_mut() }.ok_or_else(|| null(what))
}

/// What a pointer that is only read points to. Many threads may read it at the same time.
///
/// # Safety
/// The pointer is null, or to a value that nobody writes for as long as the call lasts.
pub unsafe fn shared<'a, T>(pointer: *const T, what: &str) -> Result<&'a T, Refusal> {
    // SAFETY: the caller's promise.
    unsafe { pointer.as_ref() }.ok_or_else(|| null(what))
}

/// Frees what a handle points to.
///
/// # Safety
/// As [`handle`], and nobody uses it afterwards.
pub unsafe fn free<T>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: it came from `give`, by the caller's promise.
        drop(unsafe { Box::from_raw(handle) });
    }
}

/// Where a call writes its answer: null, or a pointer that may be written. [`answer`], [`make`] and
/// [`list`] check it before they act, as [`call_back`] checks a callback: a call that is refused
/// for a null pointer has changed nothing.
pub struct Out<T>(*mut T);

impl<T> Out<T> {
    /// # Safety
    /// The pointer is null, or may be written for as long as the call lasts.
    pub unsafe fn new(pointer: *mut T) -> Self {
        Self(pointer)
    }

    /// The pointer, unless it is null.
    pub fn checked(self, what: &str) -> Result<NonNull<T>, Refusal> {
        NonNull::new(self.0).ok_or_else(|| null(what))
    }
}

/// Carries out a call that writes one value.
pub fn answer<T>(out: Out<T>, what: &str, run: impl FnOnce() -> Result<T, Refusal>) -> SdopStatus {
    call(|| {
        let out = out.checked(what)?;
        let value = run()?;
        // SAFETY: not null, so it may be written, by the promise of `Out::new`.
        unsafe { out.write(value) };
        Ok(())
    })
}

/// What finds a frame's pairs, behind a handle.
pub trait Culls {
    /// Culls, if a limit is given up to so many pairs, and returns their number.
    fn cull(&mut self, limit: Option<usize>) -> Result<usize, Refusal>;
}

macro_rules! culls {
    ($handle:ty) => {
        impl $crate::c::border::Culls for $handle {
            fn cull(&mut self, limit: Option<usize>) -> Result<usize, $crate::c::border::Refusal> {
                Ok(match limit {
                    Some(limit) => self.0.cull_up_to(limit)?.len(),
                    None => self.0.cull()?.len(),
                })
            }
        }
    };
}
pub(super) use culls;

/// Carries out a cull, whose number of pairs is written.
///
/// # Safety
/// `world` is a handle; `pairs` may be written.
pub unsafe fn cull<W: Culls>(world: *mut W, limit: Option<usize>, pairs: *mut usize) -> SdopStatus {
    // SAFETY: the caller's promise.
    answer(unsafe { Out::new(pairs) }, "pairs", || {
        // SAFETY: the caller's promise.
        unsafe { handle(world, "world") }?.cull(limit)
    })
}

/// Carries out a call that hands a new handle out.
pub fn make<T>(out: Out<*mut T>, run: impl FnOnce() -> Result<T, Refusal>) -> SdopStatus {
    answer(out, "out", || run().map(|value| Box::into_raw(Box::new(value))))
}

/// Carries out a call that calls back.
pub fn call_back<F>(take: Option<F>, run: impl FnOnce(F) -> Result<(), Refusal>) -> SdopStatus {
    call(|| run(take.ok_or_else(|| null("take"))?))
}

/// A caller's buffer, and where the number of values goes, whether they fit or not.
pub struct Buffer<T> {
    first: *mut T,
    capacity: usize,
    count: Out<usize>,
}

impl<T> Buffer<T> {
    /// # Safety
    /// `capacity` entries from `first` on may be written, if there are any; `count` is null or may
    /// be written.
    pub unsafe fn new(first: *mut T, capacity: usize, count: *mut usize) -> Self {
        Self { first, capacity, count: Out(count) }
    }
}

/// Carries out a call that copies values into a caller's buffer.
pub fn list<T, I: ExactSizeIterator<Item = T>>(
    buffer: Buffer<T>,
    run: impl FnOnce() -> Result<I, Refusal>,
) -> SdopStatus {
    call(|| {
        let Buffer { first, capacity, count } = buffer;
        let count = count.checked("count")?;
        if capacity > 0 && first.is_null() {
            return Err(null("buffer"));
        }
        let values = run()?;
        let needed = values.len();
        // SAFETY: not null, so it may be written, by the promise of `Buffer::new`.
        unsafe { count.write(needed) };
        if needed > capacity {
            let text = format!(
                "{needed} entries don't fit into a buffer of {capacity}\nhelp: pass a larger buffer"
            );
            return Err(Refusal::new(SdopStatus::TooSmall, text));
        }
        for (at, value) in values.enumerate() {
            // SAFETY: below `capacity`, so writable by the promise of `Buffer::new`.
            unsafe { first.add(at).write(value) };
        }
        Ok(())
    })
}

/// A column of `count` entries.
///
/// # Safety
/// The pointer is null, or `count` entries from it on may be read for as long as the call lasts.
pub unsafe fn column<'a, T>(first: *const T, count: usize, what: &str) -> Result<&'a [T], Refusal> {
    if count == 0 {
        return Ok(&[]);
    }
    if first.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null, and readable by the caller's promise.
    Ok(unsafe { slice::from_raw_parts(first, count) })
}

/// A column that may be left out.
///
/// # Safety
/// As [`column`].
pub unsafe fn optional<'a, T>(first: *const T, count: usize) -> Option<&'a [T]> {
    // SAFETY: the caller's promise.
    unsafe { column(first, count, "") }.ok().filter(|_| !first.is_null())
}

/// A text that may be left out.
///
/// # Safety
/// The pointer is null, or to a text that ends with a zero.
pub unsafe fn text(text: *const c_char, default: &str) -> Result<&str, Refusal> {
    if text.is_null() {
        return Ok(default);
    }
    // SAFETY: not null, and ended by a zero, by the caller's promise.
    let text = unsafe { CStr::from_ptr(text) };
    let refused = |_| Refusal::new(SdopStatus::Refused, "a text is not UTF-8\nhelp: pass UTF-8");
    text.to_str().map_err(refused)
}

/// A snapshot as bytes.
pub fn saved(snapshot: &impl serde::Serialize) -> Result<Vec<u8>, Refusal> {
    let refused =
        |error| Refusal::new(SdopStatus::Bug, format!("{error}\nhelp: report what was called"));
    serde_json::to_vec(snapshot).map_err(refused)
}

/// A snapshot of bytes.
pub fn read_back<T: serde::de::DeserializeOwned>(bytes: &[u8]) -> Result<T, Refusal> {
    let help = "pass what a snapshot of this version has written";
    let refused =
        |error| Refusal::new(SdopStatus::Refused, format!("no snapshot: {error}\nhelp: {help}"));
    serde_json::from_slice(bytes).map_err(refused)
}

pub fn pairs(list: &PairList) -> impl ExactSizeIterator<Item = SdopPair> + '_ {
    list.iter().map(|[first, second]| SdopPair { first, second })
}

/// The pointer that a caller wants back in its callback, which may be called on another thread.
pub struct User(pub *mut c_void);

// SAFETY: it is handed back unchanged and never dereferenced; calls come one at a time, and the
// documentation says that any thread may make them.
unsafe impl Send for User {}

impl User {
    /// Hands pairs to a callback.
    ///
    /// # Safety
    /// The callback may be called with this pointer.
    pub unsafe fn take(
        &self,
        take: unsafe extern "C" fn(*mut c_void, *const SdopPair, usize),
        list: &PairList,
    ) {
        let pairs: Vec<SdopPair> = pairs(list).collect();
        // SAFETY: the caller's promise.
        unsafe { take(self.0, pairs.as_ptr(), pairs.len()) };
    }
}

/// Passes events to a callback.
///
/// # Safety
/// The callback may be called with this pointer.
pub unsafe fn pass_events(
    events: &Events,
    take: unsafe extern "C" fn(*mut c_void, SdopEvent),
    user: *mut c_void,
) {
    for event in events.iter() {
        let (kind, pair) = match event {
            Event::Begun(pair) => (SdopEventKind::Begun, pair),
            Event::Persisting(pair) => (SdopEventKind::Persisting, pair),
            Event::Ended(pair) => (SdopEventKind::Ended, pair),
        };
        let pair = pair.into();
        // SAFETY: the caller's promise.
        unsafe { take(user, SdopEvent { kind, pair }) };
    }
}
