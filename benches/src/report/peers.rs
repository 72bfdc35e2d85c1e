//! The experiments of the comparison with other engines.

use super::step::ExperimentStep::{Peers, SdopPrints};
use super::step::{Experiment, PAPER_500};

/// A line per experiment: its name, the program's arguments, and what it measures. Then the finders
/// and threads of which a million bodies are timed by stage.
macro_rules! peers {
    ({ $($name:literal $arguments:literal, $about:literal;)+ } { $($finder:literal $threads:literal)+ }) => {
        /// Engines side by side, what they are compared on, and what the machine gave.
        pub(super) const PEERS: &[Experiment] = &[
            $(Experiment::new(concat!("peers/", $name), $about, &[Peers($arguments)], &[]),)+
            Experiment::new(
                "peers/control",
                "what a second thread is worth, and a million bodies by stage",
                &[Peers("control"), $(SdopPrints(
                    concat!("stages-", $finder, "-", $threads, ".json"),
                    &[
                        "run", "data/scenes/uniform-1m.toml", "--pairs", $finder, "--strategy", "s-dop-batch",
                        "--frames", "100", "--threads", $threads, "--format", "json",
                    ],
                )),+],
                &["data/scenes/uniform-1m.toml"],
            ),
            Experiment::new(
                "peers/narrow",
                "what a narrow phase costs a pair",
                &[Peers("narrow data/scenes/paper-500.toml --frames 5")],
                PAPER_500,
            ),
        ];
    };
}

peers! {
    {
        "verdicts"     "verdicts",
            "every engine judged by the cases of its claim";
        "uniform"      "--sizes 500,1000,10000 --scenes uniform",
            "every engine on uniform boxes, to ten thousand";
        "mixed"        "--sizes 500,1000,10000 --scenes mixed --threads 1",
            "every engine where radii differ 1 : 16";
        "clustered"    "--sizes 500,1000,10000 --scenes clustered --threads 1",
            "every engine where bodies cluster";
        "long"         "--sizes 500,1000,10000 --scenes long --threads 1",
            "every engine for boxes on boxes with sides 1 : 8 : 64";
        "uniform-100k" "--sizes 100000 --scenes uniform --order random --limit-ms 300",
            "a hundred thousand boxes, engines within 300 ms";
        "sorted-100k"  "--sizes 100000 --scenes uniform --order sorted --threads 1 --limit-ms 80",
            "the same in sorted order, engines within 80 ms";
        "spreads-100k" "--sizes 100000 --scenes mixed,clustered --threads 1 --limit-ms 40",
            "a hundred thousand of mixed radii and in clusters, engines within 40 ms";
        "uniform-1m"   "--sizes 1000000 --scenes uniform --order random --limit-ms 1200 --peers sdop,parry3d,rapier3d,PhysX ABP,Embree",
            "a million boxes, the fastest engines";
        "slow-1m"      "--sizes 1000000 --scenes uniform --order random --threads 1 --timed 4 --limit-ms 4000 --peers rapier3d,broccoli",
            "a million boxes, the other engines within 4 s";
        "sorted-1m"    "--sizes 1000000 --scenes uniform --order sorted --threads 1 --peers sdop,parry3d refit,Embree",
            "a million boxes in sorted order";
        "movers"       "movers",
            "engines that are given what has changed, where few boxes move";
        "queries"      "queries",
            "queries on boxes that rest: single ones and batches";
        "robots"       "robots",
            "robots of thirty parts that move: pairs of parts";
        "spreads-1m"   "--sizes 1000000 --scenes mixed,clustered --order random --threads 1 --peers sdop,parry3d refit,Embree",
            "a million of mixed radii and in clusters";
    }
    { "grid" "1" "grid" "2" "auto" "1" "auto" "2" }
}
