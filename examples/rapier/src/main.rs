//! probe
use sdop_rapier::plan::*;
use sdop_rapier::single::proof::{calls::Counted, scenes::Stage};
use sdop_rapier::single::rapier::prelude::*;
use sdop_rapier::single::{Filter, HOOKS};
use std::sync::atomic::Ordering;

fn main() {
    let forms = sdop_rapier::forms::forms("data/meshes".as_ref()).unwrap();
    let args: Vec<String> = std::env::args().collect();
    let plan = Plan { scene: args[1].parse().unwrap(), kind: args[2].parse().unwrap(), bodies: args[3].parse().unwrap(), seed: 1 };
    let steps: usize = args[4].parse().unwrap();
    for mode in [Mode::Plain, Mode::Full, Mode::Hook] {
        let hooks = if mode == Mode::Hook { HOOKS } else { ActiveHooks::empty() };
        let mut stage = Stage::new(plan, &forms, hooks);
        let mut filter = Filter::default();
        let counted = Counted::default();
        counted.0.timing.store(args.len() > 5, Ordering::Relaxed);
        stage.world.narrow_phase = NarrowPhase::with_query_dispatcher(counted.clone());
        stage.world.integration_parameters.contact_recycling = mode != Mode::Full;
        let (mut step, mut narrow, mut broad, mut last) = (0.0, 0.0, 0.0, 0);
        for i in 0..steps {
            stage.between_steps();
            let params = stage.world.integration_parameters;
            if mode == Mode::Hook { stage.world.step_with_events(filter.for_step(&params), &()); } else { stage.world.step(); }
            let c = &stage.world.physics_pipeline.counters;
            step += c.step_time_ms();
            narrow += c.cd.narrow_phase_time.time_ms();
            broad += c.cd.broad_phase_time.time_ms() + c.cd.final_broad_phase_time.time_ms();
            if (i + 1) % (steps / 5) == 0 {
                let calls = counted.0.count();
                let k = i as f64 + 1.0;
                println!("{mode:>6} {i}: step {:.3} ms narrow {:.3} broad {:.3} pairs {} calls/step {} hits {} @{:.0} misses {} @{:.0} active {} mirror {:.3} cull {:.3} culls {}", step / k, narrow / k, broad / k,
                    c.cd.ncontact_pairs, (calls - last) as usize / (steps / 5), counted.0.hits.count(), counted.0.hits.mean_ns(), counted.0.misses.count(), counted.0.misses.mean_ns(), stage.world.islands.active_bodies().count(), filter.cost().mirror*1e3/k, filter.cost().cull*1e3/k, filter.cost().culls);
                last = calls;
            }
        }
    }
}
