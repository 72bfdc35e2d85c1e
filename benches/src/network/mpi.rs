//! The network between processes that MPI connects.

use mpi::collective::SystemOperation;
use mpi::datatype::{Partition, PartitionMut};
use mpi::topology::SimpleCommunicator;
use mpi::traits::CommunicatorCollectives as _;

use super::Network;
use crate::mpi::Ranks;

/// Bytes of one call: MPI counts them in an i32.
const MOST_BYTES_PER_CALL: usize = 1 << 30;

/// This process among all that `mpirun` started.
pub struct MpiNetwork {
    ranks: Ranks,
    world: SimpleCommunicator,
}

impl MpiNetwork {
    /// All ranks.
    #[must_use]
    pub fn new(ranks: Ranks) -> Self {
        let world = ranks.world();
        Self { ranks, world }
    }

    /// Hands each rank a piece of at most [`MOST_BYTES_PER_CALL`] bytes over all, and returns the
    /// pieces received.
    fn exchange_pieces(&self, outgoing: &[&[u8]], lengths: &[usize]) -> Vec<u8> {
        let (counts, starts) = table(outgoing.iter().map(|piece| piece.len()));
        let (their_counts, their_starts) = table(lengths.iter().copied());
        // A byte more than is sent: the address of an empty Vec is 1, which OpenMPI takes for
        // MPI_IN_PLACE.
        let mut sent = outgoing.concat();
        sent.push(0);
        let mut received = vec![0; lengths.iter().sum::<usize>() + 1];
        let send = Partition::new(&sent[..], &counts[..], &starts[..]);
        let mut receive =
            PartitionMut::new(&mut received[..], &their_counts[..], &their_starts[..]);
        self.world.all_to_all_varcount_into(&send, &mut receive);
        received.pop();
        received
    }
}

/// Counts and where each begins, as MPI has them.
fn table(lengths: impl Iterator<Item = usize>) -> (Vec<i32>, Vec<i32>) {
    let mut start = 0;
    let lengths = lengths.map(|length| {
        // No more than MOST in all.
        let entry = (length as i32, start);
        start += length as i32;
        entry
    });
    lengths.unzip()
}

impl Network for MpiNetwork {
    fn rank(&self) -> usize {
        self.ranks.rank
    }

    fn size(&self) -> usize {
        self.ranks.size
    }

    fn exchange(&self, outgoing: Vec<Vec<u8>>) -> Vec<Vec<u8>> {
        let piece = MOST_BYTES_PER_CALL / self.size();
        let lengths: Vec<u64> = outgoing.iter().map(|message| message.len() as u64).collect();
        let mut theirs = vec![0_u64; self.size()];
        self.world.all_to_all_into(&lengths[..], &mut theirs[..]);
        let mut most = [lengths.into_iter().max().unwrap_or(0)];
        self.max(&mut most);
        let mut received: Vec<Vec<u8>> =
            theirs.iter().map(|&length| Vec::with_capacity(length as usize)).collect();
        for start in (0..most[0] as usize).step_by(piece) {
            let part = |length: usize| start.min(length)..(start + piece).min(length);
            let pieces: Vec<&[u8]> =
                outgoing.iter().map(|message| &message[part(message.len())]).collect();
            let lengths: Vec<usize> =
                theirs.iter().map(|&length| part(length as usize).len()).collect();
            let bytes = self.exchange_pieces(&pieces, &lengths);
            let mut rest = &bytes[..];
            for (message, length) in received.iter_mut().zip(lengths) {
                let (piece, others) = rest.split_at(length);
                message.extend_from_slice(piece);
                rest = others;
            }
        }
        received
    }

    fn gather(&self, mine: &[u64]) -> Vec<u64> {
        let mut all = vec![0; mine.len() * self.size()];
        self.world.all_gather_into(mine, &mut all[..]);
        all
    }

    fn sum(&self, numbers: &mut [u64]) {
        let mine = numbers.to_vec();
        self.world.all_reduce_into(&mine[..], numbers, SystemOperation::sum());
    }

    fn max(&self, numbers: &mut [u64]) {
        let mine = numbers.to_vec();
        self.world.all_reduce_into(&mine[..], numbers, SystemOperation::max());
    }

    fn wait(&self) {
        self.ranks.wait();
    }

    fn machine(&self) -> String {
        // A machine without a name is taken for the only one: its ranks time one after the other.
        mpi::environment::processor_name().unwrap_or_default()
    }
}
