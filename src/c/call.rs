//! Carrying out a call: parameters are checked, answers written, errors kept and panics caught.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use super::border::SdopStatus;
use crate::bodies::contract::ContractError;
use crate::choice::UnknownChoice;
use crate::compound::CompoundError;
use crate::cull_error::CullError;
use crate::living::{SnapshotError, WorldError};
use crate::mesh::MeshError;
use crate::periodic::PeriodicError;
use crate::query::QueryError;
use crate::threads::ThreadsError;
use crate::volume::VolumeError;

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
refusals! {
    UnknownChoice, CompoundError, ContractError, CullError, MeshError, PeriodicError, QueryError,
    VolumeError, WorldError, SnapshotError, ThreadsError
}

/// Carries out a call, and keeps why it failed.
pub fn run(call: impl FnOnce() -> Result<(), Refusal>) -> SdopStatus {
    let (status, text) = match catch_unwind(AssertUnwindSafe(call)) {
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

/// The value of a pointer that must not be null.
pub fn required<T>(value: Option<T>, name: &str) -> Result<T, Refusal> {
    value.ok_or_else(|| null(name))
}

/// A text that may be null.
///
/// # Safety
/// The pointer is null, or to a text that ends with a zero.
pub unsafe fn text<'a>(text: *const c_char) -> Result<Option<&'a str>, Refusal> {
    if text.is_null() {
        return Ok(None);
    }
    // SAFETY: not null, and ended by a zero, by the caller's promise.
    let text = unsafe { CStr::from_ptr(text) };
    let refused = |_| Refusal::new(SdopStatus::Refused, "a text is not UTF-8\nhelp: pass UTF-8");
    text.to_str().map(Some).map_err(refused)
}

/// A column of `count` entries.
///
/// # Safety
/// The pointer is null, or nobody writes its entries for as long as the call lasts.
pub unsafe fn column<'a, T>(first: *const T, count: usize, name: &str) -> Result<&'a [T], Refusal> {
    if count == 0 {
        return Ok(&[]);
    }
    check(first, name)?;
    // SAFETY: not null, and readable by the caller's promise.
    Ok(unsafe { slice::from_raw_parts(first, count) })
}

/// A column that may be null.
///
/// # Safety
/// As [`column`].
pub unsafe fn optional<'a, T>(first: *const T, count: usize) -> Option<&'a [T]> {
    // SAFETY: the caller's promise.
    unsafe { column(first, count, "") }.ok().filter(|_| !first.is_null())
}

/// A callback of the caller, and the pointer that it gets back.
pub struct Callback<F> {
    take: F,
    user: *mut c_void,
}

// SAFETY: the pointer is handed back unchanged and never dereferenced; calls come one at a time,
// and the documentation says that any thread may make them.
unsafe impl<F: Send> Send for Callback<F> {}

impl<F> Callback<F> {
    /// # Safety
    /// The function is null, or may be called with this pointer for as long as the call lasts.
    pub unsafe fn new(take: Option<F>, user: *mut c_void) -> Result<Self, Refusal> {
        Ok(Self { take: take.ok_or_else(|| null("take"))?, user })
    }
}

impl<T> Callback<unsafe extern "C" fn(*mut c_void, T)> {
    /// Passes events one by one.
    pub fn each(&self, events: impl IntoIterator<Item: Into<T>>) {
        for event in events {
            // SAFETY: by the promise of `new`.
            unsafe { (self.take)(self.user, event.into()) };
        }
    }
}

impl<T> Callback<unsafe extern "C" fn(*mut c_void, *const T, usize)> {
    /// Passes pairs at once.
    pub fn all(&self, pairs: impl IntoIterator<Item: Into<T>>) {
        let pairs: Vec<T> = pairs.into_iter().map(Into::into).collect();
        // SAFETY: by the promise of `new`.
        unsafe { (self.take)(self.user, pairs.as_ptr(), pairs.len()) };
    }
}

/// Frees a handle. It may move between threads, and many may use it at the same time as `const`.
///
/// # Safety
/// The handle is null, or from a list of functions and not freed, and nobody uses it afterwards.
pub unsafe fn free<T: Send + Sync>(handle: *mut T) {
    if !handle.is_null() {
        // SAFETY: it came from a `Box`, by the caller's promise.
        drop(unsafe { Box::from_raw(handle) });
    }
}

/// Refuses a null pointer.
pub fn check<T>(pointer: *const T, name: &str) -> Result<(), Refusal> {
    if pointer.is_null() { Err(null(name)) } else { Ok(()) }
}

/// Refuses a list that can't be written.
pub fn check_list<T>(first: *mut T, capacity: usize, count: *mut usize) -> Result<(), Refusal> {
    check(count, "count")?;
    if capacity > 0 { check(first, "buffer") } else { Ok(()) }
}

/// Writes the number of entries, and the entries if they fit.
///
/// # Safety
/// `count` and `capacity` entries from `first` on may be written.
pub unsafe fn write_all<T>(
    first: *mut T,
    capacity: usize,
    count: *mut usize,
    entries: impl IntoIterator<Item: Into<T>, IntoIter: ExactSizeIterator>,
) -> Result<(), Refusal> {
    let entries = entries.into_iter();
    let needed = entries.len();
    // SAFETY: the caller's promise.
    unsafe { count.write(needed) };
    if needed > capacity {
        let text = format!(
            "{needed} entries don't fit into a buffer of {capacity}\nhelp: pass a larger buffer"
        );
        return Err(Refusal::new(SdopStatus::TooSmall, text));
    }
    for (at, entry) in entries.enumerate() {
        // SAFETY: below `capacity`, so writable by the caller's promise.
        unsafe { first.add(at).write(entry.into()) };
    }
    Ok(())
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
