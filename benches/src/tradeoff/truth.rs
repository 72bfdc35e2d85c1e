//! The truth: which pairs' meshes meet, decided by the exact reference on sample frames of a run.
//!
//! The denominator of a precision must not depend on any culler. Candidates are therefore all pairs
//! whose bodies' reaches overlap, found here in f64 from the poses alone, and
//! [`sdop_reference::exact::meeting`] decides each. That takes a thousand times as long as culling,
//! so answers are stored in a file named by the hash of everything on which they depend.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use miette::miette;
use rayon::prelude::*;
use sdop_reference::exact::{meeting, mesh::Mesh};
use sdop_reference::{InvalidInput, Pose};
use sha2::{Digest, Sha256};

use super::variant::Variant;
use crate::hash::{PairsHash, hex};
use crate::remedy::OrReport as _;
use crate::scene::Scene;
use crate::simulate::{SimulationError, Trajectory};
use sdop::bodies::Bodies;
use sdop::culler::Culler;
use sdop::files;
use sdop::simd::Tier;
use sdop::volume::Shape;

/// First word of a cache file; the number changes with its layout and with what is inside a mesh.
const HEADER: &str = "sdop-truth-2";

/// One sample frame.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Its number in the run.
    pub frame: u32,
    /// Its poses.
    pub bodies: Bodies,
}

/// The pairs i < j, sorted, whose meshes meet, sample by sample.
pub type TruePairs = Vec<Vec<[u32; 2]>>;

/// Simulates the scene and keeps `count` frames (all, if it has fewer) at equal distances.
///
/// # Errors
/// The scene can't have one of its effects, or a body leaves the contract.
pub fn samples(scene: &Scene, count: u32) -> Result<Vec<Sample>, SimulationError> {
    let windows = windows(scene, count, 1)?.into_iter();
    let sample = |(frame, mut poses): (u32, Vec<Bodies>)| {
        let bodies = poses.pop()?;
        Some(Sample { frame, bodies })
    };
    Ok(windows.filter_map(sample).collect())
}

/// The frames that [`samples`] keeps, by number, each with the frames after it: up to `length`
/// frames, as far as the scene has them.
///
/// # Errors
/// As [`samples`].
pub fn windows(
    scene: &Scene,
    count: u32,
    length: usize,
) -> Result<Vec<(u32, Vec<Bodies>)>, SimulationError> {
    let count = count.clamp(1, scene.frames);
    let wanted = |i: u32| (u64::from(i) * u64::from(scene.frames) / u64::from(count)) as u32;
    let last = wanted(count - 1) as usize + length;
    let mut trajectory = Trajectory::new(scene)?.with_frames(scene.frames.min(last as u32));
    let mut kept: Vec<(u32, Vec<Bodies>)> = Vec::new();
    loop {
        let frame = trajectory.next_number();
        let Some(bodies) = trajectory.advance()? else {
            return Ok(kept);
        };
        if (kept.len() as u32) < count && frame == wanted(kept.len() as u32) {
            kept.push((frame, Vec::new()));
        }
        let open = kept.iter_mut().filter(|(_, poses)| poses.len() < length);
        open.for_each(|(_, poses)| poses.push(bodies.clone()));
    }
}

/// A scene's meshes, prepared for exact judgement.
#[derive(Debug)]
pub struct ExactJudge {
    meshes: Vec<Mesh>,
    reaches: Vec<f64>,
    key: Sha256,
}

impl ExactJudge {
    /// Prepares the shapes' meshes.
    ///
    /// # Errors
    /// The reference rejects a mesh, which never happens for meshes of [`Shape::build`].
    pub fn new(shapes: &[Shape]) -> miette::Result<Self> {
        let mut key = Sha256::new_with_prefix(HEADER);
        let mut meshes = Vec::new();
        for shape in shapes {
            let vertices = shape.vertices.clone();
            key.update((vertices.len() as u64).to_le_bytes());
            key.update((shape.triangles.len() as u64).to_le_bytes());
            vertices.iter().flatten().for_each(|x| key.update(x.to_le_bytes()));
            let corners = shape.triangles.iter().flatten();
            corners.for_each(|i| key.update(i.to_le_bytes()));
            meshes.push(Mesh::new(&vertices, &shape.triangles).map_err(refused)?);
        }
        let reaches = shapes.iter().map(|shape| f64::from(shape.reach)).collect();
        Ok(Self { meshes, reaches, key })
    }

    /// The meetings of every sample, from the file in `cache` if an earlier call wrote one.
    ///
    /// # Errors
    /// The reference rejects a pose, or the cache can't be written.
    pub fn truth(&self, samples: &[Sample], cache: Option<&Path>) -> miette::Result<TruePairs> {
        let file = cache.map(|directory| directory.join(self.file_name(samples)));
        if let Some(truth) = file.as_deref().and_then(|file| read(file, samples)) {
            return Ok(truth);
        }
        let truth = samples
            .par_iter()
            .map(|sample| self.meetings(&sample.bodies, None))
            .collect::<miette::Result<TruePairs>>()?;
        if let Some(file) = file {
            write(&file, samples, &truth).map_err(|error| {
                miette!(
                    help = "choose a writable directory with --cache",
                    "cannot write {}: {error}",
                    file.display()
                )
            })?;
        }
        Ok(truth)
    }

    /// The pairs, not both static, whose meshes meet. `translations` are those of all bodies, if
    /// they aren't all f32.
    ///
    /// # Errors
    /// The reference rejects a pose.
    pub fn meetings(
        &self,
        bodies: &Bodies,
        translations: Option<&[[f64; 3]]>,
    ) -> miette::Result<Vec<[u32; 2]>> {
        let poses = match translations {
            None => poses(bodies)?,
            Some(all) => (bodies.rotation.iter().zip(all))
                .map(|(q, t)| Pose::from_f64(*q, *t))
                .collect::<Result<_, _>>()
                .map_err(refused)?,
        };
        let mut pairs = self.candidates(bodies, &poses);
        pairs.retain(|&[i, j]| self.meet(bodies, &poses, i as usize, j as usize));
        Ok(pairs)
    }

    /// The pairs i < j, sorted, that [`Self::near`] can't exclude and that aren't both static.
    /// Bodies are swept in the order of their x, so that ten thousand of them don't make fifty
    /// million pairs.
    fn candidates(&self, bodies: &Bodies, poses: &[Pose]) -> Vec<[u32; 2]> {
        let x = |body: usize| poses[body].translation()[0];
        let reach = |body: usize| self.reaches[bodies.shape[body] as usize];
        let farthest = (0..bodies.len()).map(reach).fold(0.0, f64::max);
        let mut order: Vec<usize> = (0..bodies.len()).collect();
        order.sort_by(|&a, &b| x(a).total_cmp(&x(b)));
        let mut pairs = Vec::new();
        for (at, &i) in order.iter().enumerate() {
            // Twice the slack of `near`, so that the sweep never ends too early.
            let end = 1.000_002 * (reach(i) + farthest);
            for &j in order[at + 1..].iter().take_while(|&&j| x(j) - x(i) <= end) {
                let moving = bodies.dynamic[i] || bodies.dynamic[j];
                if moving && self.near(bodies, poses, i, j) {
                    pairs.push([i.min(j) as u32, i.max(j) as u32]);
                }
            }
        }
        pairs.sort_unstable();
        pairs
    }

    /// Mean seconds of an exact narrow phase of pairs whose spheres overlap, for those that meet
    /// and for those that don't: Cp. At most `most` pairs are timed, one after the other.
    ///
    /// # Errors
    /// A body leaves the contract.
    pub fn price(&self, scene: &Scene, tier: Tier, most: usize) -> miette::Result<NarrowPhase> {
        let (bodies, settings) = (&scene.bodies, Variant::spheres(&scene.cull).settings);
        let builder = Culler::builder().settings(&settings).tier(tier);
        let mut culler = builder.build(&scene.shapes, bodies).or_report()?;
        let poses = poses(bodies)?;
        let mut sums = [(0.0, 0_u32); 2];
        for [i, j] in culler.cull(bodies).or_report()?.iter().take(most) {
            let start = Instant::now();
            let meets = self.meet(bodies, &poses, i as usize, j as usize);
            let (seconds, count) = &mut sums[usize::from(meets)];
            *seconds += start.elapsed().as_secs_f64();
            *count += 1;
        }
        let [miss, hit] = sums.map(|(seconds, count)| seconds / f64::from(count.max(1)));
        Ok(NarrowPhase { miss, hit })
    }

    fn meet(&self, bodies: &Bodies, poses: &[Pose], i: usize, j: usize) -> bool {
        let posed = |body: usize| (&self.meshes[bodies.shape[body] as usize], &poses[body]);
        meeting::meet(posed(i), posed(j)).meets
    }

    /// Whether two bodies' reaches overlap, which contain their meshes; the slack is far above the
    /// rounding of f64.
    fn near(&self, bodies: &Bodies, poses: &[Pose], i: usize, j: usize) -> bool {
        let [a, b] = [i, j].map(|body| poses[body].translation());
        let squared: f64 = a.iter().zip(b).map(|(a, b)| (b - a).powi(2)).sum();
        let reach: f64 = [i, j].iter().map(|&body| self.reaches[bodies.shape[body] as usize]).sum();
        squared <= (1.000_001 * reach).powi(2)
    }

    fn file_name(&self, samples: &[Sample]) -> PathBuf {
        let mut key = self.key.clone();
        for sample in samples {
            let Bodies { shape, dynamic, rotation, translation } = &sample.bodies;
            key.update(sample.frame.to_le_bytes());
            for body in 0..shape.len() {
                key.update(shape[body].to_le_bytes());
                key.update([u8::from(dynamic[body])]);
                rotation[body]
                    .iter()
                    .chain(&translation[body])
                    .for_each(|x| key.update(x.to_le_bytes()));
            }
        }
        format!("{}.pairs", hex(&key.finalize())).into()
    }
}

fn refused(error: InvalidInput) -> miette::Report {
    miette!("the exact reference refuses the scene: {error}")
}

/// Cp: seconds of the exact narrow phase per pair.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct NarrowPhase {
    /// The price of a pair that doesn't meet, which culling saves.
    pub miss: f64,
    /// The price of a pair that meets.
    pub hit: f64,
}

fn poses(bodies: &Bodies) -> miette::Result<Vec<Pose>> {
    let pose = |(q, t): (&[f32; 4], &[f32; 3])| Pose::new(*q, *t);
    let poses = bodies.rotation.iter().zip(&bodies.translation).map(pose);
    poses.collect::<Result<_, _>>().map_err(refused)
}

/// Reads a cache file: the header, a line of numbers per sample, and the hash of all pairs. A file
/// with other contents is ignored.
fn read(file: &Path, samples: &[Sample]) -> Option<TruePairs> {
    let text = files::read_text(file, files::MAX_BYTES).ok()?;
    let mut lines = text.lines();
    if lines.next()? != HEADER {
        return None;
    }
    let mut truth = TruePairs::new();
    for _ in samples {
        let numbers: Vec<u32> = lines
            .next()?
            .split_whitespace()
            .map(|number| number.parse().ok())
            .collect::<Option<_>>()?;
        truth.push(numbers.as_chunks().0.to_vec());
    }
    (lines.next()? == hash(samples, &truth)).then_some(truth)
}

/// Writes a cache file as a whole, so that nothing reads half a file.
fn write(file: &Path, samples: &[Sample], truth: &TruePairs) -> io::Result<()> {
    let mut text = format!("{HEADER}\n");
    for pairs in truth {
        let numbers: Vec<String> = pairs.iter().flatten().map(u32::to_string).collect();
        text += &format!("{}\n", numbers.join(" "));
    }
    text += &hash(samples, truth);
    if let Some(directory) = file.parent() {
        fs::create_dir_all(directory)?;
    }
    files::write(file, text)
}

fn hash(samples: &[Sample], truth: &TruePairs) -> String {
    let mut hash = PairsHash::default();
    for (sample, pairs) in samples.iter().zip(truth) {
        hash.frame(sample.frame, pairs);
    }
    hash.finish()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::random::Stream;

    /// The sweep lists what all pairs would.
    #[test]
    fn sweep_lists_all_pairs() {
        let judge =
            ExactJudge { meshes: Vec::new(), reaches: vec![0.05, 0.4, 6.0], key: Sha256::new() };
        let mut random = Stream::new(7, 0);
        let mut bodies = Bodies::default();
        for body in 0..300 {
            let at = [(); 3].map(|()| random.between(-4.0, 4.0));
            let shape = if body == 150 { 2 } else { body % 2 };
            bodies.push(shape, body % 3 > 0, [0.0, 0.0, 0.0, 1.0], at);
        }
        let poses = poses(&bodies).unwrap();
        let mut all = Vec::new();
        for i in 0..bodies.len() {
            for j in i + 1..bodies.len() {
                let moving = bodies.dynamic[i] || bodies.dynamic[j];
                if moving && judge.near(&bodies, &poses, i, j) {
                    all.push([i as u32, j as u32]);
                }
            }
        }
        assert!((30..3000).contains(&all.len()), "{}", all.len());
        assert_eq!(judge.candidates(&bodies, &poses), all);
    }
}
