//! Running a scene on many ranks, and the combined results.

use serde::Serialize;

use super::error::DomainError;
use super::rank::{BorderSeconds, Rank};
use crate::effects::EffectReport;
use crate::hash::{PairsDigest, PairsHash, volumes_sha256};
use crate::network::{Network, tell_first};
use crate::percentiles::Percentiles;
use crate::simulate::Summary;
use sdop::counters::{Counters, Seconds};
use sdop::settings::{TestedVolume, Updates};

/// Up to this many bodies, rank 0 gathers all pairs for `pairs_sha256`, which needs them sorted.
/// With more bodies there is only `pairs_digest`.
const MOST_GATHERED_BODIES: usize = 1 << 20;

/// What one rank says of a run. Sums over frames, except for bodies.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RankLine {
    /// The rank.
    pub rank: usize,
    /// Bodies owned at the end.
    pub bodies: u64,
    /// Ghosts held, summed over frames.
    pub ghosts: u64,
    /// Updated volumes of ghosts, in addition to those in the counters; with lazy updates those of
    /// the first test alone.
    pub ghost_updates: u64,
    /// Pairs found here and reported by another rank.
    pub others_pairs: u64,
    /// Bytes sent of ghosts.
    pub ghost_bytes: u64,
    /// Bytes sent of bodies that changed their owner.
    pub migration_bytes: u64,
    /// Bodies that left for another owner.
    pub migrated: u64,
    /// How often owners and ghosts were found anew.
    pub renewals: u64,
    /// How often space was cut.
    pub cuts: u64,
    /// The most memory that the process has had in use, in bytes; 0 where the system doesn't tell.
    pub peak_bytes: u64,
    /// Its wall time.
    pub seconds: RankSeconds,
}

/// The wall time of one rank. Sums over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct RankSeconds {
    /// Steps of the effects.
    pub effects: f64,
    /// Update, pair finding and or-DOP tests.
    pub culling: f64,
    /// What borders cost.
    #[serde(flatten)]
    pub border: BorderSeconds,
}

/// The results of a finished run. They are the same on every rank, except for the hash of all
/// pairs, which rank 0 alone has.
#[derive(Clone, Debug)]
pub struct DomainSummary {
    /// As of one process. Counters are sums over ranks: updates are those of owned bodies, tests
    /// and hits count what every rank tested, so a pair of ghosts more than once; `reported` counts
    /// each pair once. Seconds are the largest of any rank, term by term, those of single frames
    /// too. The finder is rank 0's.
    pub whole: Summary,
    /// What borders cost, the largest of any rank, term by term.
    pub border: BorderSeconds,
    /// Each rank for itself.
    pub ranks: Vec<RankLine>,
}

/// Runs a scene's share on this rank to the last frame. `observe` sees each frame's number, after
/// its culling. Collective.
///
/// # Errors
/// As [`Rank::next_frame`].
pub fn run<N: Network>(
    mut rank: Rank<'_, N>,
    mut observe: impl FnMut(u32),
) -> Result<DomainSummary, DomainError> {
    let network = rank.network;
    let gathers = rank.scene.share().all <= MOST_GATHERED_BODIES;
    let (mut hash, mut digest) = (PairsHash::default(), PairsDigest::default());
    let mut reported = 0;
    let mut frames = Vec::new();
    while let Some(frame) = rank.next_frame()? {
        let number = frame.number;
        frames.push(frame.seconds.total);
        digest.add(number, frame.pairs.iter().copied());
        reported += frame.pairs.len() as u64;
        if gathers {
            let sorted = gathered(network, frame.pairs);
            hash.frame(number, &sorted);
        }
        observe(number);
    }
    network.sum(&mut digest.0);
    let scene = &rank.scene;
    let culls = scene.cull.strategy.scheme().culls();
    let mut counters = own_counters(&rank, reported);
    sum_counters(network, &mut counters);
    let culling = *rank.culler.seconds();
    let lines = lines(&rank);
    let mut effects = rank.effects.reports().to_vec();
    combine_effects(network, &mut effects);
    let mut seconds = Seconds {
        construct: scene.construct_seconds + culling.construct,
        effects: effects.iter().map(|effect| effect.seconds).sum(),
        ..culling
    };
    take_largest(network, {
        let Seconds { construct, effects, update, pair_finding, ordop, total } = &mut seconds;
        [construct, effects, update, pair_finding, ordop, total]
    });
    let mut border = rank.work.seconds;
    take_largest(network, {
        let BorderSeconds { ghosts, migration, waiting } = &mut border;
        [ghosts, migration, waiting]
    });
    let mut frame_seconds = Percentiles::of(frames);
    take_largest(network, {
        let Percentiles { p50, p99, most } = &mut frame_seconds;
        [p50, p99, most]
    });
    Ok(DomainSummary {
        border,
        ranks: lines,
        whole: Summary {
            counters,
            seconds,
            frame_seconds,
            effects,
            finder: rank.culler.finder(),
            volumes_sha256: volumes_sha256(&scene.shapes),
            pairs_sha256: (culls && gathers && network.rank() == 0).then(|| hash.finish()),
            pairs_digest: culls.then(|| digest.finish()),
        },
    })
}

/// All ranks' pairs, sorted, on rank 0; nothing elsewhere.
fn gathered(network: &impl Network, pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let bytes = pairs.as_flattened().iter().flat_map(|number| number.to_le_bytes());
    let all = tell_first(network, bytes.collect()).concat();
    let (words, _) = all.as_chunks::<4>();
    let (pairs, _) = words.as_chunks::<2>();
    let mut pairs: Vec<_> = pairs.iter().map(|pair| pair.map(u32::from_le_bytes)).collect();
    pairs.sort_unstable();
    pairs
}

/// How many volumes a moving ghost has updated in a frame, beyond what its owner counts.
fn updates_of_a_ghost<N: Network>(
    rank: &Rank<'_, N>,
) -> impl Iterator<Item = TestedVolume> + use<N> {
    let (scheme, updates) = (rank.scene.cull.strategy.scheme(), rank.scene.cull.updates);
    let refining = scheme.refining.filter(|_| updates == Updates::Eager);
    scheme.first.into_iter().chain(refining)
}

/// This rank's counters without the updates of its ghosts, and with the pairs that it reports.
fn own_counters<N: Network>(rank: &Rank<'_, N>, reported: u64) -> Counters {
    let mut counters = Counters { reported, ..*rank.culler.counters() };
    for volume in updates_of_a_ghost(rank) {
        counters.of_mut(volume).updates -= rank.work.moving_ghosts;
    }
    counters
}

fn sum_counters(network: &impl Network, counters: &mut Counters) {
    let mut numbers = vec![counters.untested, counters.reported];
    for volume in TestedVolume::ALL {
        let volume = counters.of(*volume);
        numbers.extend([volume.updates, volume.tests, volume.hits]);
    }
    network.sum(&mut numbers);
    (counters.untested, counters.reported) = (numbers[0], numbers[1]);
    for (volume, sums) in TestedVolume::ALL.iter().zip(numbers[2..].chunks_exact(3)) {
        let volume = counters.of_mut(*volume);
        (volume.updates, volume.tests, volume.hits) = (sums[0], sums[1], sums[2]);
    }
}

/// Steps are taken by all ranks together; bodies add up, and seconds are the largest of any rank.
fn combine_effects(network: &impl Network, effects: &mut [EffectReport]) {
    for effect in effects {
        let mut sums = [effect.visited, effect.changed];
        network.sum(&mut sums);
        [effect.visited, effect.changed] = sums;
        take_largest(network, [&mut effect.seconds]);
    }
}

/// Makes each the largest of any rank; none is negative. Collective.
fn take_largest<const N: usize>(network: &impl Network, mut seconds: [&mut f64; N]) {
    // The bits of numbers that are not negative have their order. Sums of differences may end a
    // little below 0.
    let mut bits = seconds.each_ref().map(|x| x.max(0.0).to_bits());
    network.max(&mut bits);
    for (x, largest) in seconds.iter_mut().zip(bits) {
        **x = f64::from_bits(largest);
    }
}

/// Every rank's line. Collective.
fn lines<N: Network>(rank: &Rank<'_, N>) -> Vec<RankLine> {
    let work = &rank.work;
    let updates = updates_of_a_ghost(rank).count() as u64;
    let BorderSeconds { ghosts, migration, waiting } = work.seconds;
    let effects: f64 = rank.effects.reports().iter().map(|effect| effect.seconds).sum();
    let mine = [
        rank.bodies()[0] as u64,
        work.ghosts,
        work.moving_ghosts * updates,
        work.others_pairs,
        work.bytes_of_ghosts,
        work.bytes_of_migration,
        work.migrated,
        work.renewals,
        work.cuts,
        peak_bytes(),
        effects.to_bits(),
        rank.culler.seconds().total.to_bits(),
        ghosts.to_bits(),
        migration.to_bits(),
        waiting.to_bits(),
    ];
    let all = rank.network.gather(&mine);
    let (all, _) = all.as_chunks::<15>();
    let line = |(rank, line): (usize, &[u64; 15])| {
        let seconds = |at: usize| f64::from_bits(line[at]);
        RankLine {
            rank,
            bodies: line[0],
            ghosts: line[1],
            ghost_updates: line[2],
            others_pairs: line[3],
            ghost_bytes: line[4],
            migration_bytes: line[5],
            migrated: line[6],
            renewals: line[7],
            cuts: line[8],
            peak_bytes: line[9],
            seconds: RankSeconds {
                effects: seconds(10),
                culling: seconds(11),
                border: BorderSeconds {
                    ghosts: seconds(12),
                    migration: seconds(13),
                    waiting: seconds(14),
                },
            },
        }
    };
    all.iter().enumerate().map(line).collect()
}

/// The most memory that this process has had in use.
fn peak_bytes() -> u64 {
    // Only Linux reports it, in a line such as "VmHWM: 12345 kB".
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().next()?.parse().ok());
    kilobytes.map_or(0, |kilobytes: u64| kilobytes << 10)
}
