//! The cost of the exact answer: triangle pairs by the stage that decides them, and frames of 500
//! real meshes. `cargo bench --bench oracle` prints a Markdown table.

mod common;

use std::hint::black_box;
use std::time::Instant;

use sdop_bench::measure::turns::median;
use sdop_judge::truth::Shapes;
use sdop_reference::Pose;
use sdop_reference::exact::view::View;
use sdop_reference::exact::{Path, judge, mesh::Mesh};

/// Rounds per median.
const ROUNDS: usize = 21;

fn main() {
    let scene = common::scene("paper-500");
    let shapes = Shapes::new(scene.shapes.clone()).unwrap_or_else(|error| panic!("{error}"));
    let frames = common::frames(&scene);

    println!("| triangle pairs | decided by | pairs | ns a pair |");
    println!("|---|---|--:|--:|");
    let [a, b] = [0, 1].map(|i| shapes.judged[i].mesh());
    let turned = Pose::new([0.1, -0.4, 0.3, 0.8], [0.3, 0.2, -0.1]);
    let turned = turned.unwrap_or_else(|error| panic!("{error}"));
    triangles("two meshes through each other, all with all", a, b, turned);
    let quarter = Pose::new([0.0, 0.0, 1.0, 1.0], [0.0; 3]);
    let quarter = quarter.unwrap_or_else(|error| panic!("{error}"));
    let fan = fan();
    triangles("a common corner, a quarter turn apart", &fan, &fan, quarter);

    println!(
        "\n| frame of 500 | mesh pairs near | meet | triangle pairs, rays | filter | interval | exact | ms |"
    );
    println!("|--:|--:|--:|--:|--:|--:|--:|--:|");
    for (number, bodies) in frames.iter().enumerate().step_by(8) {
        let bodies = shapes.bodies(bodies).unwrap_or_else(|error| panic!("{error}"));
        let start = Instant::now();
        let (pairs, tally) = judge::meeting_pairs(&bodies);
        let elapsed = start.elapsed().as_secs_f64();
        let tests = tally.triangles;
        println!(
            "| {number} | {} | {} | {} | {} | {} | {} | {:.0} |",
            tally.meshes.total(),
            pairs.len(),
            tests.total(),
            tests.filter,
            tests.interval,
            tests.exact,
            1e3 * elapsed
        );
    }
}

/// Triangles about the origin, in planes of their own.
fn fan() -> Mesh {
    let rim = [[3, 1, 1], [1, 3, 1], [1, 1, 3], [-3, 1, 2], [2, -3, 1], [1, 2, -3]];
    let vertices: Vec<[f32; 3]> =
        std::iter::once([0; 3]).chain(rim).map(|p| p.map(|x: i8| f32::from(x))).collect();
    let triangles: Vec<[u32; 3]> = (1..6).map(|i| [0, i, i + 1]).collect();
    Mesh::new(&vertices, &triangles).unwrap_or_else(|error| panic!("{error}"))
}

/// Every triangle of `a` with every one of `b`, whose pose as `a` sees it is given.
fn triangles(name: &str, a: &Mesh, b: &Mesh, pose: Pose) {
    let (identity, mut seconds, mut paths) = (Pose::IDENTITY, vec![], [0_usize; 3]);
    for _ in 0..ROUNDS {
        let view = View::new((a, &identity), (b, &pose));
        paths = [0; 3];
        let start = Instant::now();
        for (j, triangle) in b.triangles.iter().enumerate() {
            let mapped = triangle.each_ref().map(|corner| view.map.map(corner));
            for i in 0..a.triangles.len() {
                let decision = view.triangles_meet(i as u32, j as u32, &mapped);
                paths[decision.path as usize] += 1;
                black_box(decision.value);
            }
        }
        seconds.push(start.elapsed().as_secs_f64());
    }
    let total: usize = paths.iter().sum();
    let by = [Path::Filter, Path::Interval, Path::Exact]
        .map(|path| format!("{path:?} {}", paths[path as usize]).to_lowercase());
    println!(
        "| {name} | {} | {total} | {:.0} |",
        by.join(", "),
        1e9 * median(seconds) / total as f64
    );
}
