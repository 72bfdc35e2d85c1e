//! Merging shards' files: all shards of one work, each once.

use std::collections::BTreeMap;
use std::path::PathBuf;

use miette::{bail, ensure, miette};

use super::{Header, Shard, Units};

/// All units of a work.
#[derive(Clone, Debug)]
pub struct MergedUnits {
    /// The work to which the units belong.
    pub header: Header,
    /// Results by unit.
    pub done: BTreeMap<usize, String>,
    /// Seconds of all shards together.
    pub seconds: f64,
}

/// The first of some shards' numbers.
fn names(missing: &[usize]) -> String {
    let names: Vec<String> = missing.iter().take(20).map(usize::to_string).collect();
    let more = if missing.len() > 20 { ", …" } else { "" };
    names.join(", ") + more
}

/// Puts shards together.
///
/// # Errors
/// Files that are unfinished, of different works, there twice or missing.
pub fn merge(files: Vec<(PathBuf, Units)>) -> miette::Result<MergedUnits> {
    let first = files.first().ok_or_else(|| miette!("there is no shard to merge"))?;
    let (first, header) = (first.0.clone(), first.1.header.clone());
    let mut parts: BTreeMap<Shard, PathBuf> = BTreeMap::new();
    let (mut done, mut seconds) = (BTreeMap::new(), 0.0);
    for (path, units) in files {
        let (Some(shard), Some(took)) = (units.header.shard, units.seconds) else {
            bail!(help = "run this shard again", "{} is not a finished shard", path.display());
        };
        let number = |header: &Header| header.shard.map_or(0, |shard| shard.of);
        let difference = header.difference(&units.header).or_else(|| {
            let (here, there) = (number(&header), number(&units.header));
            (here != there).then(|| format!("there are {here} shards here and {there} there"))
        });
        if let Some(difference) = difference {
            bail!(
                help = "`here` is the first file; run one of them again with the other's code, settings and scenes",
                "{} and {} are shards of different runs: {difference}",
                first.display(),
                path.display()
            );
        }
        let own = shard.units(header.units);
        let wrong = own.iter().find(|unit| !units.done.contains_key(unit));
        let wrong =
            wrong.or_else(|| units.done.keys().find(|unit| own.binary_search(unit).is_err()));
        if let Some(&unit) = wrong {
            bail!(
                help = "the file was not written by this program: run this shard again",
                "{} does not hold the units of shard {shard}: unit {unit} is the first that differs",
                path.display()
            );
        }
        if let Some(first) = parts.insert(shard, path.clone()) {
            let (first, other) = (first.display(), path.display());
            bail!(help = "name one of them", "{first} and {other} are both shard {shard}");
        }
        done.extend(units.done);
        seconds += took;
    }
    let of = header.shard.map_or(0, |shard| shard.of);
    let present = |&index: &usize| parts.contains_key(&Shard { index, of });
    let missing: Vec<usize> = (1..=of).filter(|index| !present(index)).collect();
    ensure!(
        missing.is_empty(),
        help = "run them: the same command with --shard",
        "{} of {of} shards are missing: {}",
        missing.len(),
        names(&missing)
    );
    Ok(MergedUnits { header, done, seconds })
}
