//! [`Network`]: the collective calls between ranks, which all ranks make in the same order.
//!
//! It is implemented by MPI, and between threads of one process for tests.

mod local;
#[cfg(feature = "mpi")]
mod mpi;

pub use local::{LocalRank, on_ranks};
#[cfg(feature = "mpi")]
pub use mpi::MpiNetwork;

/// Ranks that can reach one another. Every call is collective unless it says otherwise: it returns
/// when all ranks have made it.
pub trait Network {
    /// This rank, counted from 0. Not collective.
    fn rank(&self) -> usize;

    /// How many ranks there are. Not collective.
    fn size(&self) -> usize;

    /// Sends one message to each rank, in their order, and returns the messages of all ranks for
    /// this one.
    fn exchange(&self, outgoing: Vec<Vec<u8>>) -> Vec<Vec<u8>>;

    /// The numbers of all ranks, one rank's after the other's. All give equally many.
    fn gather(&self, mine: &[u64]) -> Vec<u64>;

    /// Replaces each number by its sum over ranks, modulo 2⁶⁴.
    fn sum(&self, numbers: &mut [u64]);

    /// Replaces each number by the largest of all ranks.
    fn max(&self, numbers: &mut [u64]);

    /// Returns when all ranks have called it. A waiting rank sleeps, so that others can measure
    /// times.
    fn wait(&self);

    /// The name of this rank's machine. Not collective.
    fn machine(&self) -> String;
}

/// Every rank's message, given to all.
pub fn tell_all(network: &impl Network, message: &[u8]) -> Vec<Vec<u8>> {
    network.exchange(vec![message.to_vec(); network.size()])
}

/// Every rank's message, given to rank 0 alone; nothing elsewhere.
pub fn tell_first(network: &impl Network, message: Vec<u8>) -> Vec<Vec<u8>> {
    let mut outgoing = vec![Vec::new(); network.size()];
    outgoing[0] = message;
    network.exchange(outgoing)
}
