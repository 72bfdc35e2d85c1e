//! What came out in words, for a reader who knows neither the paper nor this project; and what is cited.

use std::fmt::{Result, Write as _};

use sdop::settings::Strategy;
use sdop_bench::reproduce::check::{Claim, Verdict};
use sdop_bench::reproduce::paper_name;

use super::table_1;
use crate::commands::reproduce::rows::Tables;

/// One paragraph before any table. What it says of rows and claims is computed.
pub fn section(out: &mut String, tables: &Tables) -> Result {
    writeln!(out, "## In words\n")?;
    let rows: Vec<table_1::StrategyMatch> = table_1::rows(tables).collect();
    let of = |wanted: fn(&table_1::StrategyMatch) -> bool| {
        let rows = rows.iter().filter(|row| wanted(row));
        let names: Vec<&str> = rows.map(|row| paper_name(row.strategy)).collect();
        match names.as_slice() {
            [] => "no row".to_owned(),
            names => names.join(", "),
        }
    };
    writeln!(
        out,
        "The paper culls pairs of moving bodies in two steps, bounding spheres first and oriented polytopes (or-DOPs) for the pairs \
         that are left, and reports how many of its tests found a collision (Table 1) and how fast frames were (Figs 12, 13). We \
         ran its experiments again from its text. Of Table 1, these rows reproduce: {}; these have its magnitude but not its \
         trend: {}; these have neither: {}. The reason is arithmetic and not chance: in a box that stays the same, the share \
         of pairs whose spheres overlap doesn't depend on the number of bodies, yet three of the paper's rows rise with it; and its \
         or-DOP row exceeds what its other rows allow. {} Of the claims in its text, {} came out as it says, {} the other way round, and {} in part.\n",
        of(table_1::StrategyMatch::reproduces),
        of(|row| row.same_magnitude() && !row.reproduces()),
        of(|row| !row.same_magnitude() && !row.reproduces()),
        order(tables),
        count(&tables.claims, Verdict::Supported),
        count(&tables.claims, Verdict::Contradicted),
        count(&tables.claims, Verdict::InPart) + count(&tables.claims, Verdict::Undecided),
    )
}

/// The paper's order of speed, as measured in the small box.
fn order(tables: &Tables) -> String {
    let crowded: Vec<&str> = tables
        .boxes
        .iter()
        .filter(|row| row.crowded)
        .map(|row| row.scene.as_str())
        .collect();
    let time = |strategy: Strategy| {
        let rates = tables.rates.iter();
        let mut rates = rates
            .filter(|rate| rate.strategy == strategy && crowded.contains(&rate.scene.as_str()));
        rates.next().map(|rate| rate.culling.mean)
    };
    let [Some(spheres), Some(both), Some(alone)] =
        [Strategy::Sphere, Strategy::SDopSequential, Strategy::OrDop].map(time)
    else {
        return String::new();
    };
    format!(
        "As to speed: in the small box spheres with or-DOPs behind them take {:.1} times as long as spheres alone, and or-DOPs alone {:.1} times.",
        both / spheres,
        alone / spheres
    )
}

fn count(claims: &[Claim], verdict: Verdict) -> usize {
    claims
        .iter()
        .filter(|claim| claim.verdict() == verdict)
        .count()
}

/// What is reproduced, and what it builds on. Where authors, venue or an identifier couldn't be confirmed, none stands.
const REFERENCES: [&str; 6] = [
    "*Sphere Encapsulated Oriented-Discrete Orientation Polytopes (S-DOP) Collision Culling for Multi-Rigid Body Dynamic*: the paper \
     reproduced here. The copy at hand names neither authors nor venue.",
    "N. M. Suaib, A. Bade, D. Mohamad: *Hybrid Collision Culling by Bounding Volumes Manipulation in Massive Rigid Body \
     Simulation*. TELKOMNIKA Indonesian Journal of Electrical Engineering 11(6), 2013, 3115–3122. Its predecessor.",
    "A. Bade, N. M. Suaib, A. M. Zin, T. S. T. M. Sembok: *Oriented Convex Polyhedra for Collision Detection in 3D Computer \
     Animation*. GRAPHITE 2006, Kuala Lumpur. The or-DOP.",
    "J. T. Klosowski, M. Held, J. S. B. Mitchell, H. Sowizral, K. Zikan: *Efficient Collision Detection Using Bounding Volume \
     Hierarchies of k-DOPs*. IEEE Transactions on Visualization and Computer Graphics 4(1), 1998. The cost function with updates.",
    "S. Gottschalk, M. C. Lin, D. Manocha: *OBBTree: A Hierarchical Structure for Rapid Interference Detection*. SIGGRAPH 1996. \
     The cost function; the oriented box.",
    "P. M. Hubbard: *Approximating Polyhedra with Spheres for Time-Critical Collision Detection*. ACM Transactions on Graphics \
     15(3), 1996. Time-critical culling.",
];

/// The list at the end.
pub fn references(out: &mut String) -> Result {
    writeln!(out, "\n## References\n")?;
    for reference in REFERENCES {
        writeln!(out, "- {reference}")?;
    }
    Ok(())
}
