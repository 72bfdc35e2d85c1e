//! What crosses the border: statuses, the last error, parameters, answers and callbacks.

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use crate::bodies::contract::ContractError;
use crate::choice::UnknownChoice;
use crate::compound::CompoundError;
use crate::cull_error::CullError;
use crate::living::{BodyId, Event, SnapshotError, WorldError};
use crate::mesh::MeshError;
use crate::periodic::PeriodicError;
use crate::query::QueryError;
use crate::threads::ThreadsError;
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

impl From<[u32; 2]> for SdopPair {
    fn from([first, second]: [u32; 2]) -> Self {
        Self { first, second }
    }
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

impl From<Event> for SdopEvent {
    fn from(event: Event) -> Self {
        let (kind, pair) = match event {
            Event::Begun(pair) => (SdopEventKind::Begun, pair),
            Event::Persisting(pair) => (SdopEventKind::Persisting, pair),
            Event::Ended(pair) => (SdopEventKind::Ended, pair),
        };
        Self { kind, pair: pair.into() }
    }
}

/// Receives some of a frame's pairs and their number, after the pointer that was passed along. Must
/// return normally.
pub type SdopTakePairs = Option<unsafe extern "C" fn(*mut c_void, *const SdopPair, usize)>;

/// As `SdopTakePairs`, of a world.
pub type SdopTakeIdPairs = Option<unsafe extern "C" fn(*mut c_void, *const SdopIdPair, usize)>;

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
refusals! {
    UnknownChoice, CompoundError, ContractError, CullError, MeshError, PeriodicError, QueryError,
    VolumeError, WorldError, SnapshotError, ThreadsError
}

/// Converts the bodies of C, which say how they move in two fields, and those of Rust.
macro_rules! bodies {
    ($c:ident = $rust:ident { $($field:ident),+ }) => {
        impl From<$c> for $rust {
            fn from(body: $c) -> Self {
                let motion = $crate::bodies::Motion::of(!body.fixed, body.resting);
                Self { motion, $($field: body.$field),+ }
            }
        }

        impl From<$rust> for $c {
            fn from(body: $rust) -> Self {
                use $crate::bodies::Motion;
                let [fixed, resting] = [Motion::Fixed, Motion::Resting].map(|it| body.motion == it);
                Self { fixed, resting, $($field: body.$field),+ }
            }
        }
    };
}
pub(super) use bodies;

/// Defines the functions of a handle in C: a list of `fn name(parameters) -> answer { body }` after
/// the handle's name and type. Parameters are in the order of C. All pointers are checked before a
/// body runs: a call that is refused for a null pointer has changed nothing.
///
/// | in the list | in C | in the body |
/// |---|---|---|
/// | `*mut world`, `*const world` | the handle | a reference |
/// | `*const body: T` | a pointer that is not null | a reference |
/// | `?mut hit: T`, `?const part: T` | a pointer that may be null | an `Option` of a reference |
/// | `?text name = "box"` | a text; null is "box" | a `&str` |
/// | `#id` | an id | a [`BodyId`] |
/// | `[*const ids: u64, ?const groups: Groups; count]` | columns and their length | slices |
/// | `[*const poses: Pose; = world.len()]` | a column of a known length | a slice |
/// | `take: SdopTakeEvent` between two bars | a callback and its `user` | a [`Callback`] |
/// | `limit: usize` | a number | the same number |
/// | `-> *mut id: u64` | a pointer that gets the answer | the body's value |
/// | `-> new T` | `out`, which gets a new handle | the body's value |
/// | `-> [T]` | `buffer`, `capacity`, `count` | the body's value has the entries |
///
/// `free name;` defines the function that frees a handle.
macro_rules! border {
    ($handle:ident: $type:ident;) => {};
    (@pointee $type:ident) => { $type };
    (@pointee $type:ident $pointee:tt) => { $pointee };
    (@reference mut $pointer:ident) => {
        // SAFETY: the caller's promise.
        unsafe { $pointer.as_mut() }
    };
    (@reference const $pointer:ident) => {
        // SAFETY: the caller's promise.
        unsafe { $pointer.as_ref() }
    };
    (@column $column:ident $length:ident) => {
        // SAFETY: the caller's promise.
        unsafe { $crate::c::border::column($column, $length, stringify!($column)) }?
    };
    ($handle:ident: $type:ident; $(#[$meta:meta])* free $name:ident; $($rest:tt)*) => {
        $(#[$meta])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($handle: *mut $type) {
            // SAFETY: the caller's promise.
            unsafe { $crate::c::border::free($handle) }
        }
        $crate::c::border::border! { $handle: $type; $($rest)* }
    };
    (
        $handle:ident: $type:ident;
        $(#[$meta:meta])*
        fn $name:ident($(
            $(*$access:ident $pointer:ident $(: $pointee:tt)?)?
            $(?mut $place:ident: $place_type:tt)?
            $(?const $known:ident: $known_type:tt)?
            $(?text $text:ident = $default:literal)?
            $(#$id:ident)?
            $([
                $(
                    $(?const $optional:ident: $optional_type:tt)?
                    $(*const $column:ident: $column_type:ty)?
                ),+;
                $($count:ident)? $(= $length:expr)?
            ])?
            $(|$take:ident: $function:ty|)?
            $($number:ident: $number_type:ty)?
        ),+)
        $(-> $([$entry:ty])? $(new $made:ident)? $(*mut $out:ident: $out_type:ty)?)? $body:block
        $($rest:tt)*
    ) => {
        $(#[$meta])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(
            $(
                $($pointer: *$access $crate::c::border::border!(@pointee $type $($pointee)?),)?
                $($place: *mut $place_type,)?
                $($known: *const $known_type,)?
                $($text: *const std::ffi::c_char,)?
                $($id: u64,)?
                $(
                    $($($optional: *const $optional_type,)? $($column: *const $column_type,)?)+
                    $($count: usize,)?
                )?
                $($take: $function, user: *mut std::ffi::c_void,)?
                $($number: $number_type,)?
            )*
            $(
                $(buffer: *mut $entry, capacity: usize, count: *mut usize,)?
                $(out: *mut *mut $made,)?
                $($out: *mut $out_type,)?
            )?
        ) -> $crate::c::border::SdopStatus {
            use $crate::c::border;
            border::call(|| {
                $($(border::check_list::<$entry>(buffer, capacity, count)?;)?)?
                $($(border::check::<*mut $made>(out, "out")?;)?)?
                $($(border::check($out, stringify!($out))?;)?)?
                $($(
                    // SAFETY: the caller's promise.
                    let $take = unsafe { border::Callback::new($take, user) }?;
                )?)*
                $(
                    $(
                        let $pointer = border::border!(@reference $access $pointer);
                        let $pointer = border::required($pointer, stringify!($pointer))?;
                    )?
                    $(
                        let $place = $place.cast::<std::mem::MaybeUninit<$place_type>>();
                        let $place = border::border!(@reference mut $place);
                    )?
                    $(let $known = border::border!(@reference const $known);)?
                    $(
                        // SAFETY: the caller's promise.
                        let $text = unsafe { border::text($text) }?.unwrap_or($default);
                    )?
                    $(let $id = $crate::living::BodyId::from_bits($id);)?
                    $(
                        let length = $($count)? $($length)?;
                        $(
                            $(
                                // SAFETY: the caller's promise.
                                let $optional = unsafe { border::optional($optional, length) };
                            )?
                            $(let $column = border::border!(@column $column length);)?
                        )+
                    )?
                )*
                let value = $body;
                $(
                    $(
                        let buffer: *mut $entry = buffer;
                        // SAFETY: the caller's promise.
                        let value = unsafe { border::write_all(buffer, capacity, count, value) }?;
                    )?
                    $(
                        let value: *mut $made = Box::into_raw(Box::new(value));
                        // SAFETY: not null, so it may be written, by the caller's promise.
                        let value = unsafe { out.write(value) };
                    )?
                    $(
                        // SAFETY: not null, so it may be written, by the caller's promise.
                        let value = unsafe { $out.write(value) };
                    )?
                )?
                Ok(value)
            })
        }
        $crate::c::border::border! { $handle: $type; $($rest)* }
    };
}
pub(super) use border;

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
/// The handle is null, or from [`border`] and not freed, and nobody uses it afterwards.
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
