//! What crosses the border: statuses, pairs and events; and the macro that defines functions of C.

use std::ffi::c_void;

use crate::living::{BodyId, Event};

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
/// | `?text name = "box"`, `?text path` | a text; null is "box" | a `&str`; an `Option` of it |
/// | `#id` | an id | a [`BodyId`] |
/// | `[*const ids: u64, ?const groups: Groups; count]` | columns and their length | slices |
/// | `[*const poses: Pose; = world.len()]` | a column of a known length | a slice |
/// | `take: SdopTakeEvent` between two bars | a callback and its `user` | a [`Callback`](super::call::Callback) |
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
        unsafe { $crate::c::call::column($column, $length, stringify!($column)) }?
    };
    ($handle:ident: $type:ident; $(#[$meta:meta])* free $name:ident; $($rest:tt)*) => {
        $(#[$meta])*
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($handle: *mut $type) {
            // SAFETY: the caller's promise.
            unsafe { $crate::c::call::free($handle) }
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
            $(?text $text:ident $(= $default:literal)?)?
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
            use $crate::c::call;
            call::run(|| {
                $($(call::check_list::<$entry>(buffer, capacity, count)?;)?)?
                $($(call::check::<*mut $made>(out, "out")?;)?)?
                $($(call::check($out, stringify!($out))?;)?)?
                $($(
                    // SAFETY: the caller's promise.
                    let $take = unsafe { call::Callback::new($take, user) }?;
                )?)*
                $(
                    $(
                        let $pointer = $crate::c::border::border!(@reference $access $pointer);
                        let $pointer = call::required($pointer, stringify!($pointer))?;
                    )?
                    $(
                        let $place = $place.cast::<std::mem::MaybeUninit<$place_type>>();
                        let $place = $crate::c::border::border!(@reference mut $place);
                    )?
                    $(let $known = $crate::c::border::border!(@reference const $known);)?
                    $(
                        // SAFETY: the caller's promise.
                        let $text = unsafe { call::text($text) }?$(.unwrap_or($default))?;
                    )?
                    $(let $id = $crate::living::BodyId::from_bits($id);)?
                    $(
                        let length = $($count)? $($length)?;
                        $(
                            $(
                                // SAFETY: the caller's promise.
                                let $optional = unsafe { call::optional($optional, length) };
                            )?
                            $(let $column = $crate::c::border::border!(@column $column length);)?
                        )+
                    )?
                )*
                let value = $body;
                $(
                    $(
                        let buffer: *mut $entry = buffer;
                        // SAFETY: the caller's promise.
                        let value = unsafe { call::write_all(buffer, capacity, count, value) }?;
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
