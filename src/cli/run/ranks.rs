//! `mpirun -n R sdop run`: each rank builds its share of the scene, rank 0 prints.

use sdop::bodies::Bodies;
use sdop::lab::domain::{DomainError, DomainSummary, MpiNetwork, Network as _, Rank};
use sdop::lab::effects::Velocities;
use sdop::lab::mpi::Ranks;
use sdop::lab::scene::Scene;

use super::super::Outcome;
use super::super::output::progress;
use super::{Args, print};

/// Runs the command on this rank. Of ranks in trouble, the first says why and ends all.
///
/// # Errors
/// As in one process, and what can't be shared.
pub(super) fn run(args: &Args) -> miette::Result<Outcome> {
    let network = MpiNetwork::new(Ranks::start());
    let Some(scene) = first_says(&network, share(args, &network))? else {
        return Ok(Outcome::Failed);
    };
    let about = without_bodies(&scene);
    let threads = usize::from(args.threads);
    let rank = Rank::new(&network, scene, args.machine.tier(), threads);
    let is_first = network.rank() == 0;
    let bar = is_first.then(|| progress(about.frames.into(), &about.name));
    let ran = rank
        .and_then(|rank| sdop::lab::domain::run(rank, |_| bar.iter().for_each(|bar| bar.inc(1))));
    bar.iter().for_each(|bar| bar.finish_and_clear());
    match ran {
        // The rank whose trouble it is says so, and ends all.
        Err(DomainError::Elsewhere { .. }) => Ok(Outcome::Failed),
        // All ranks refuse the same; one says so.
        Err(DomainError::Unsupported { .. }) if !is_first => Ok(Outcome::Failed),
        Err(error) => Err(error.into()),
        Ok(DomainSummary {
            whole,
            border,
            ranks,
        }) => {
            if is_first {
                print(args, &about, &whole, Some((border, &ranks)))?;
            }
            Ok(Outcome::Passed)
        }
    }
}

fn share(args: &Args, network: &MpiNetwork) -> miette::Result<Scene> {
    if args.record.is_some() {
        miette::bail!(
            help = "record a smaller scene in one process: `sdop run SCENE --record FILE` without mpirun",
            "--record on {} ranks: a record is one file of all poses and pairs",
            network.size()
        );
    }
    let file = args.scene.read()?;
    Ok(file.build_share(network.rank(), network.size())?)
}

/// The value, or the error on the first rank that has one and nothing on the others.
fn first_says<T>(network: &MpiNetwork, outcome: miette::Result<T>) -> miette::Result<Option<T>> {
    let failed = network.gather(&[outcome.is_err().into()]);
    match failed.iter().position(|&failed| failed == 1) {
        None => outcome.map(Some),
        Some(rank) if rank == network.rank() => outcome.map(|_| None),
        Some(_) => Ok(None),
    }
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
        ..*scene
    }
}
