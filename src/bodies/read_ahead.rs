//! Reading a column into the caches before it is gathered from.
//!
//! The user's columns are in the order of bodies and are gathered in the order of places, which is
//! a random order in memory. If a column is no longer in the caches (another thread has just
//! written it, or much other data was written since), reading it from end to end is several times
//! as fast as in that random order.

use std::hint::black_box;

use crate::simd::CACHE_LINE;
use crate::threads::Threads;

/// Elements that one thread reads at a time.
const ELEMENTS_PER_TASK: usize = 8192;

/// Reads one number of each cache line of a column of which `wanted` elements will be used soon, in
/// any order. Returns false without reading anything if most elements won't be used or if the
/// column is longer than `longest` bytes; the caller then prefetches element by element.
pub fn read_ahead<T: Sync>(
    pool: &Threads,
    column: &[T],
    wanted: usize,
    longest: usize,
    number: impl Fn(&T) -> f32 + Sync,
) -> bool {
    if 2 * wanted < column.len() || size_of_val(column) > longest {
        return false;
    }
    let stride = (CACHE_LINE / size_of::<T>().max(1)).max(1);
    pool.ranges(column.len(), ELEMENTS_PER_TASK, |range| {
        let numbers = column[range].iter().step_by(stride);
        black_box(numbers.fold(0, |bits, element| bits ^ number(element).to_bits()));
    });
    true
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    /// The longest column that is read, in bytes.
    const MOST_BYTES: usize = 1 << 20;

    /// The numbers that are read from a column with `N` numbers per element, each of which is its
    /// own index.
    fn read<const N: usize>(elements: usize, wanted: usize) -> Vec<usize> {
        let column: Vec<[f32; N]> = (0..elements).map(|i| [(N * i) as f32; N]).collect();
        let seen = Mutex::new(Vec::new());
        let is_read = read_ahead(&Threads::default(), &column, wanted, MOST_BYTES, |element| {
            let mut seen = seen.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            seen.push(element[0] as usize);
            element[0]
        });
        let seen = seen.into_inner().unwrap_or_default();
        assert_eq!(is_read, !seen.is_empty() || elements == 0);
        seen
    }

    fn leaves_no_line_out<const N: usize>() {
        let elements = 2 * ELEMENTS_PER_TASK + 77;
        let seen = read::<N>(elements, elements);
        // A line is sixteen numbers long, wherever the lines begin.
        let gaps = seen.windows(2).map(|two| two[1] - two[0]);
        assert!(gaps.max().is_some_and(|gap| gap <= 16), "{N}");
        assert!(seen[0] == 0 && N * elements - seen[seen.len() - 1] <= 16 + N, "{N}");
        assert!(seen.len() <= 1 + elements.div_ceil(2), "{N}: {}", seen.len());
    }

    /// Each line of a column is read and hardly one twice.
    #[test]
    fn every_cache_line_is_read() {
        leaves_no_line_out::<3>();
        leaves_no_line_out::<4>();
        leaves_no_line_out::<6>();
    }

    /// Columns of which less than half is wanted or that are too long are left alone.
    #[test]
    fn sparse_or_long_columns_are_skipped() {
        assert!(!read::<4>(101, 51).is_empty() && read::<4>(101, 50).is_empty());
        let longest = MOST_BYTES / 16;
        assert!(!read::<4>(longest, longest).is_empty());
        assert!(read::<4>(longest + 1, longest + 1).is_empty());
        assert!(read::<3>(0, 0).is_empty());
    }
}
