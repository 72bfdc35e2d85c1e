//! `mpirun -n R sdop run`: each rank builds its share of the scene, and rank 0 prints the results.
//!
//! An error on one rank reaches all ranks before any of them ends, so that none waits for a rank
//! that has ended.

use miette::IntoDiagnostic as _;
use sdop::bodies::Bodies;
use sdop_bench::domain::{DomainError, DomainSummary, Rank};
use sdop_bench::effects::Velocities;
use sdop_bench::hash::volumes_sha256;
use sdop_bench::measure::conditions::Conditions;
use sdop_bench::mpi::Ranks;
use sdop_bench::network::{MpiNetwork, Network as _};
use sdop_bench::scene::Scene;
use sdop_bench::sweep::{code, digest};

use super::super::output::progress;
use super::super::{Outcome, complain};
use super::{Args, print};

/// Runs the command on this rank. Of ranks in trouble, the first says why.
pub(super) fn run(args: &Args) -> Outcome {
    let network = MpiNetwork::new(Ranks::start());
    let scene = agreed(&network, share(args, &network).map_err(Some));
    let ran = scene
        .and_then(|scene| agreed(&network, same(&network, scene).map_err(Some)))
        .and_then(|scene| frames(args, &network, scene))
        .and_then(|ran| agreed(&network, tell(args, &network, &ran).map_err(Some)));
    ran.map_or(Outcome::Told, |()| Outcome::Passed)
}

/// The rank's share of the scene, and digits of a digest of program, scene and settings.
fn share(args: &Args, network: &MpiNetwork) -> miette::Result<(u64, Scene)> {
    if args.record.is_some() {
        miette::bail!(
            help = "record a smaller scene in one process: `sdop run SCENE --record FILE` without mpirun",
            "--record on {} ranks: a record is one file of all poses and pairs",
            network.size()
        );
    }
    let file = args.scene.read_culled()?;
    let scene = file.build_share(network.rank(), network.size())?;
    let work = digest(&(code(), &file.spec, volumes_sha256(&scene.shapes)));
    let work = u64::from_str_radix(&work[..16], 16).into_diagnostic()?;
    Ok((work, scene))
}

/// The share, when all ranks have the same program, scene and settings. Collective.
fn same(network: &MpiNetwork, (work, scene): (u64, Scene)) -> miette::Result<Scene> {
    let works = network.gather(&[work]);
    match works.iter().position(|work| *work != works[0]) {
        None => Ok(scene),
        Some(rank) => miette::bail!(
            help = "all ranks must have the same program, scene, meshes and flags",
            "rank {rank} would run another scene than rank 0, or otherwise"
        ),
    }
}

/// Runs all frames of a share. Returns the scene without its bodies, and the results.
fn frames(args: &Args, network: &MpiNetwork, scene: Scene) -> Option<(Scene, DomainSummary)> {
    let about = without_bodies(&scene);
    let bar = (network.rank() == 0).then(|| progress(about.frames.into(), &about.name));
    let rank = Rank::new(network, scene, args.machine.tier(), args.threads.into());
    let ran = rank
        .and_then(|rank| sdop_bench::domain::run(rank, |_| bar.iter().for_each(|bar| bar.inc(1))));
    bar.iter().for_each(|bar| bar.finish_and_clear());
    let summary = ran.map_err(|error| match error {
        DomainError::Elsewhere { .. } => None,
        own => Some(own.into()),
    });
    Some((about, agreed(network, summary)?))
}

/// Prints the results of all ranks, on rank 0.
fn tell(
    args: &Args,
    network: &MpiNetwork,
    (about, summary): &(Scene, DomainSummary),
) -> miette::Result<()> {
    let DomainSummary { whole, border, ranks } = summary;
    match network.rank() {
        0 => print(args, about, whole, Conditions::default(), Some((*border, ranks))),
        _ => Ok(()),
    }
}

/// The value, if every rank has one. Otherwise `None` on all of them, and the first rank with its
/// own error prints it, with the rank's number unless all ranks have the error. Collective.
fn agreed<T>(network: &MpiNetwork, outcome: Result<T, Option<miette::Report>>) -> Option<T> {
    let own = matches!(outcome, Err(Some(_)));
    let troubles = network.gather(&[u64::from(outcome.is_err()), own.into()]);
    let (troubles, _) = troubles.as_chunks::<2>();
    if troubles.iter().all(|[failed, _]| *failed == 0) {
        return outcome.ok();
    }
    let first = troubles.iter().position(|[_, own]| *own == 1);
    if let (Some(rank), Err(Some(report))) = (first, outcome)
        && rank == network.rank()
    {
        let alike = troubles.iter().all(|[_, own]| *own == 1);
        complain(&if alike { report } else { report.wrap_err(format!("rank {rank}")) });
    }
    None
}

/// What is printed of a scene: all but its bodies, which change their owners.
fn without_bodies(scene: &Scene) -> Scene {
    Scene {
        name: scene.name.clone(),
        shapes: Vec::new(),
        bodies: Bodies::default(),
        velocities: Velocities::default(),
        effects: scene.effects.clone(),
        cull: scene.cull.clone(),
        share: Some(scene.share()),
        fine: scene.fine.clone(),
        ..*scene
    }
}
