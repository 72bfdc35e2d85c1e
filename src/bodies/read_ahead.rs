//! Reading a column ahead of its use.
//!
//! Users' columns are by body, and what gathers them goes by place: bodies that are neighbours in
//! space lie anywhere in the column. A column that has just been written by another thread, or so
//! much else since that it is in memory again, comes into the caches several times as fast from end
//! to end as in that order.

use std::hint::black_box;

use crate::simd::CACHE_LINE;
use crate::threads::Threads;

/// Elements that one thread reads at a time.
const PIECE: usize = 8192;

/// Reads a number of each cache line of a column whose elements will be wanted soon, `wanted` of
/// them in any order. Does nothing and returns false where most won't be, or where the column is
/// longer than so many bytes: then, what is wanted is better prefetched element by element.
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
    pool.ranges(column.len(), PIECE, |range| {
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
    const LONGEST: usize = 1 << 20;

    /// The numbers that are read of a column of `N` numbers an element, each of which is its own
    /// index.
    fn read<const N: usize>(elements: usize, wanted: usize) -> Vec<usize> {
        let column: Vec<[f32; N]> = (0..elements).map(|i| [(N * i) as f32; N]).collect();
        let seen = Mutex::new(Vec::new());
        let is_read = read_ahead(&Threads::default(), &column, wanted, LONGEST, |element| {
            let mut seen = seen.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            seen.push(element[0] as usize);
            element[0]
        });
        let seen = seen.into_inner().unwrap_or_default();
        assert_eq!(is_read, !seen.is_empty() || elements == 0);
        seen
    }

    fn leaves_no_line_out<const N: usize>() {
        let elements = 2 * PIECE + 77;
        let seen = read::<N>(elements, elements);
        // Wherever lines begin: they are sixteen numbers long.
        let gaps = seen.windows(2).map(|two| two[1] - two[0]);
        assert!(gaps.max().is_some_and(|gap| gap <= 16), "{N}");
        assert!(
            seen[0] == 0 && N * elements - seen[seen.len() - 1] <= 16 + N,
            "{N}"
        );
        assert!(
            seen.len() <= 1 + elements.div_ceil(2),
            "{N}: {}",
            seen.len()
        );
    }

    #[test]
    fn each_line_of_a_column_is_read_and_hardly_one_twice() {
        leaves_no_line_out::<3>();
        leaves_no_line_out::<4>();
        leaves_no_line_out::<6>();
    }

    #[test]
    fn columns_of_which_less_than_half_is_wanted_or_that_are_too_long_are_left_alone() {
        assert!(!read::<4>(101, 51).is_empty() && read::<4>(101, 50).is_empty());
        let longest = LONGEST / 16;
        assert!(!read::<4>(longest, longest).is_empty());
        assert!(read::<4>(longest + 1, longest + 1).is_empty());
        assert!(read::<3>(0, 0).is_empty());
    }
}
