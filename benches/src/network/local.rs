//! The network between threads of one process, for tests and for machines without MPI.

use std::sync::mpsc::{Receiver, Sender, channel};

use super::Network;

/// One of several ranks of this process.
#[derive(Debug)]
pub struct LocalRank {
    rank: usize,
    to: Vec<Sender<Vec<u8>>>,
    from: Vec<Receiver<Vec<u8>>>,
}

/// Runs `work` on `ranks` ranks, each on its own thread, and returns their results in order.
///
/// # Panics
/// When a rank does.
pub fn on_ranks<T: Send>(ranks: usize, work: impl Fn(&LocalRank) -> T + Sync) -> Vec<T> {
    let mut to: Vec<Vec<_>> = (0..ranks).map(|_| Vec::new()).collect();
    let mut from: Vec<Vec<_>> = (0..ranks).map(|_| Vec::new()).collect();
    for to in &mut to {
        for from in &mut from {
            let (sender, receiver) = channel();
            to.push(sender);
            from.push(receiver);
        }
    }
    let ends = to.into_iter().zip(from).enumerate();
    let ranks: Vec<_> = ends.map(|(rank, (to, from))| LocalRank { rank, to, from }).collect();
    let work = &work;
    std::thread::scope(|scope| {
        let threads = ranks.into_iter().map(|rank| scope.spawn(move || work(&rank)));
        let threads: Vec<_> = threads.collect();
        let ended = threads.into_iter().map(|thread| match thread.join() {
            Ok(value) => value,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        ended.collect()
    })
}

impl LocalRank {
    /// Every rank's numbers, combined one by one.
    fn combine(&self, numbers: &mut [u64], with: impl Fn(u64, u64) -> u64) {
        let all = self.gather(numbers);
        let (first, others) = all.split_at(numbers.len());
        numbers.copy_from_slice(first);
        for other in others.chunks_exact(numbers.len().max(1)) {
            numbers
                .iter_mut()
                .zip(other)
                .for_each(|(number, other)| *number = with(*number, *other));
        }
    }
}

impl Network for LocalRank {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.to.len()
    }

    fn exchange(&self, outgoing: Vec<Vec<u8>>) -> Vec<Vec<u8>> {
        assert_eq!(outgoing.len(), self.to.len(), "a message a rank");
        for (to, message) in self.to.iter().zip(outgoing) {
            // A rank that has panicked receives nothing: a rank that waits for it panics next.
            let _ = to.send(message);
        }
        let received = self.from.iter().map(|from| match from.recv() {
            Ok(message) => message,
            Err(_) => panic!("rank {}: another rank has ended early", self.rank),
        });
        received.collect()
    }

    fn gather(&self, mine: &[u64]) -> Vec<u64> {
        let bytes: Vec<u8> = mine.iter().flat_map(|number| number.to_le_bytes()).collect();
        let all = self.exchange(vec![bytes; self.size()]).concat();
        let (numbers, _) = all.as_chunks::<8>();
        numbers.iter().map(|bytes| u64::from_le_bytes(*bytes)).collect()
    }

    fn sum(&self, numbers: &mut [u64]) {
        self.combine(numbers, u64::wrapping_add);
    }

    fn max(&self, numbers: &mut [u64]) {
        self.combine(numbers, u64::max);
    }

    fn wait(&self) {
        self.gather(&[]);
    }

    fn machine(&self) -> String {
        "this one".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Messages arrive where they are sent and numbers combine.
    #[test]
    fn messages_arrive_and_numbers_combine() {
        for ranks in [1, 2, 5] {
            let seen = on_ranks(ranks, |net| {
                let outgoing = (0..ranks).map(|to| vec![net.rank() as u8, to as u8]);
                let received = net.exchange(outgoing.collect());
                let (mut sum, mut max) = ([net.rank() as u64, 1], [net.rank() as u64]);
                net.sum(&mut sum);
                net.max(&mut max);
                (received, net.gather(&[7, net.rank() as u64]), sum, max)
            });
            for (rank, (received, gathered, sum, max)) in seen.into_iter().enumerate() {
                let expected: Vec<_> =
                    (0..ranks).map(|from| vec![from as u8, rank as u8]).collect();
                assert_eq!(received, expected);
                let expected: Vec<_> = (0..ranks as u64).flat_map(|from| [7, from]).collect();
                assert_eq!(gathered, expected);
                let ranks = ranks as u64;
                assert_eq!((sum, max), ([ranks * (ranks - 1) / 2, ranks], [ranks - 1]));
            }
        }
    }
}
