//! An engine's memory: bytes held and the most held at once, counted by this process's allocator,
//! and from glibc's statistics for engines in C++.
//!
//! The allocator counts only in passes that are not timed.

#![allow(unsafe_code, reason = "an allocator and glibc's statistics are unsafe interfaces")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicBool, AtomicIsize, Ordering::Relaxed};

static COUNTING: AtomicBool = AtomicBool::new(false);
static HELD: AtomicIsize = AtomicIsize::new(0);
static PEAK: AtomicIsize = AtomicIsize::new(0);

/// The system's allocator, with a count of bytes.
pub struct CountingAllocator;

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

fn count(bytes: isize) {
    if COUNTING.load(Relaxed) {
        let held = HELD.fetch_add(bytes, Relaxed) + bytes;
        PEAK.fetch_max(held, Relaxed);
    }
}

// SAFETY: every call is passed on to the system's allocator as it came; counting allocates nothing.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: the caller keeps `alloc`'s contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: the caller keeps `alloc_zeroed`'s contract.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: the caller keeps `dealloc`'s contract.
        unsafe { System.dealloc(block, layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count(size as isize - layout.size() as isize);
        // SAFETY: the caller keeps `realloc`'s contract.
        unsafe { System.realloc(block, layout, size) }
    }
}

/// The bytes that a piece of work still holds at its end, and the most that it held at once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Memory {
    /// Held at the end.
    pub held: u64,
    /// The most held at once; of engines in C++, what was held at the end.
    pub peak: u64,
}

/// Does the work and counts what it allocates in addition to what was held `before`, C++ included.
pub fn measure<T>(before: Memory, work: impl FnOnce() -> T) -> (T, Memory) {
    HELD.store(0, Relaxed);
    PEAK.store(0, Relaxed);
    let booked = in_use();
    COUNTING.store(true, Relaxed);
    let result = work();
    COUNTING.store(false, Relaxed);
    // glibc rounds sizes up: what it has beyond the count is a few per cent, or C++.
    let added = (HELD.load(Relaxed) as i64).max(in_use() as i64 - booked as i64);
    let held = before.held.saturating_add_signed(added);
    let peak = before.held.saturating_add_signed(PEAK.load(Relaxed) as i64);
    (result, Memory { held, peak: peak.max(held).max(before.peak) })
}

/// Bytes in use by glibc's statistics, over all arenas and mapped blocks.
fn in_use() -> u64 {
    // SAFETY: no arguments, no state but glibc's own.
    let books = unsafe { libc::mallinfo2() };
    (books.uordblks + books.hblkhd) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Held and peak are what was allocated.
    #[test]
    fn allocator_counts_held_and_peak() {
        // Other tests allocate less meanwhile. Memory that nobody writes to costs none.
        const GIGABYTE: usize = 1 << 30;
        let (kept, memory) = measure(Memory::default(), || {
            drop(Vec::<u8>::with_capacity(7 * GIGABYTE / 2));
            Vec::<u8>::with_capacity(5 * GIGABYTE / 2)
        });
        assert_eq!(kept.capacity(), 5 * GIGABYTE / 2);
        let gigabytes = [memory.held, memory.peak].map(|bytes| bytes / GIGABYTE as u64);
        assert_eq!(gigabytes, [2, 3], "{memory:?}");
    }
}
