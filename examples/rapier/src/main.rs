//! probe
use sdop_rapier::plan::*;
use sdop_rapier::single::proof::{calls::Counted, scenes::Stage};
use sdop_rapier::single::rapier::prelude::*;
use std::sync::atomic::Ordering;

fn main() {
    let forms = sdop_rapier::forms::forms("data/meshes".as_ref()).unwrap();
    let args: Vec<String> = std::env::args().collect();
    let plan = Plan { scene: args[1].parse().unwrap(), kind: args[2].parse().unwrap(), bodies: args[3].parse().unwrap(), seed: 1 };
    let steps: usize = args[4].parse().unwrap();
    for recycle in [true, false] {
        let mut stage = Stage::new(plan, &forms, ActiveHooks::empty());
        let counted = Counted::default();
        counted.0.timing.store(args.len() > 5, Ordering::Relaxed);
        stage.world.narrow_phase = NarrowPhase::with_query_dispatcher(counted.clone());
        stage.world.integration_parameters.contact_recycling = recycle;
        let (mut step, mut narrow, mut broad, mut last) = (0.0, 0.0, 0.0, 0);
        for i in 0..steps {
            stage.between_steps();
            stage.world.step();
            let c = &stage.world.physics_pipeline.counters;
            step += c.step_time_ms();
            narrow += c.cd.narrow_phase_time.time_ms();
            broad += c.cd.broad_phase_time.time_ms() + c.cd.final_broad_phase_time.time_ms();
            if (i + 1) % (steps / 5) == 0 {
                let calls = counted.0.count();
                println!("{recycle} {i}: step {:.3} ms narrow {:.3} broad {:.3} pairs {} calls/step {} hits {} @{:.0} misses {} @{:.0} active {}", step / i as f64, narrow / i as f64, broad / i as f64,
                    c.cd.ncontact_pairs, (calls - last) as usize / (steps / 5), counted.0.hits.count(), counted.0.hits.mean_ns(), counted.0.misses.count(), counted.0.misses.mean_ns(), stage.world.islands.active_bodies().count());
                last = calls;
            }
        }
    }
}
