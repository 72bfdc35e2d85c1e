//! [`WaitingTime`]: how long this thread was ready to run and waited for a processor, which is the
//! part of a measured time that other processes took.
//!
//! Linux counts it per thread, in nanoseconds. On other systems nothing is subtracted.

use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};

/// The thread's own count.
#[derive(Debug)]
pub struct WaitingTime(Option<File>);

impl WaitingTime {
    /// The count of the calling thread, which alone may read it.
    #[must_use]
    pub fn of_this_thread() -> Self {
        Self(File::open("/proc/thread-self/schedstat").ok())
    }

    /// Seconds that the thread has waited since it began; 0 if the system doesn't report it.
    pub fn seconds(&mut self) -> f64 {
        self.nanoseconds().map_or(0.0, |ns| 1e-9 * ns as f64)
    }

    fn nanoseconds(&mut self) -> Option<u64> {
        let file = self.0.as_mut()?;
        let mut text = [0; 96];
        file.seek(SeekFrom::Start(0)).ok()?;
        let length = file.read(&mut text).ok()?;
        // Time on a processor, time waiting for one, slices.
        let text = std::str::from_utf8(&text[..length]).ok()?;
        text.split_whitespace().nth(1)?.parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waiting_never_shrinks() {
        let mut waiting = WaitingTime::of_this_thread();
        let before = waiting.seconds();
        std::thread::yield_now();
        assert!(waiting.seconds() >= before && before >= 0.0);
    }
}
