//! `sdop-record`, version 1: a run as lines of JSON, enough for an independent oracle to judge the
//! pairs.
//!
//! Line 1 holds shapes and bodies. Every further line holds a frame: its poses and sorted pairs.
//! Vertices, balls and slabs are the body-frame numbers exactly as built, before any inflation for
//! rounding. A number is written as the shortest text of the f64 that equals it ([`crate::json`]);
//! records with the shorter text of an f32 are read as well. Bodies and frames are counted from 0;
//! frame numbers ascend.
//!
//! ```text
//! {"format":"sdop-record","version":1,"scene":name,"seed":n,"shapes":[{"name","vertices":[[x,y,z]…],"triangles":[[a,b,c]…],
//!  "ball":[cx,cy,cz,r],"ordop":{"k","basis":[9 numbers],"lo":[…],"hi":[…]}}…],"bodies":[{"shape":i,"static":bool}…]}
//! {"frame":n,"poses":[[qx,qy,qz,qw,tx,ty,tz]…],"pairs":[[i,j]…]}
//! ```
//!
//! A record of another program may leave out `scene`, `seed`, names, balls and or-DOPs: then it is
//! not judged by claims about these.
//!
//! Readers ignore keys that they don't know, so keys may be added without a new `version`; `minor`
//! counts such additions. `version` increases only if an old reader would misread a record. Minors
//! 1 and 2 added these keys, all optional:
//!
//! | line | key | holds |
//! |---|---|---|
//! | first | `minor` | 2 |
//! | first | `program` | the program that culled, with its version |
//! | first | `dt`, `side` | seconds between frames; the side of the box about the origin |
//! | first | `effects` | `[{"name","on"}…]`: which effects are simulated and which aren't |
//! | first | `cull` | the `[cull]` table of the scene, as run |
//! | frame | `counters` | `[{"volume","updates","tests","hits"}…]` of this frame, in the order of the tests |
//! | frame | `translations` | `[[tx,ty,tz]…]` in f64 of every body, where f32 doesn't hold them all; `poses` then have the nearest f32 (minor 2) |
//! | first | `frames` | the number of frames of the complete record (minor 2) |
//! | frame | `meets` | the pairs, not both static, whose meshes meet in exact arithmetic, sorted |

mod error;
mod reader;
mod writer;

pub use error::RecordError;
pub use reader::Reader;
pub use writer::Recorder;

use serde::{Deserialize, Serialize};

use sdop::bodies::Bodies;
use sdop::counters::VolumeCounters;
use sdop::settings::CullSettings;
use sdop::volume::Shape;

/// The format's name in every record's first line.
pub const FORMAT: &str = "sdop-record";
/// The version written and read here.
pub const VERSION: u32 = 1;
/// The additions to it that are written here.
pub const MINOR: u32 = 2;

/// The first line. A case of the judge has other bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header<Body = BodyLine> {
    /// [`FORMAT`].
    pub format: String,
    /// [`VERSION`].
    pub version: u32,
    /// Additions that the writer knows.
    #[serde(default)]
    pub minor: u32,
    /// Who culled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program: Option<String>,
    /// Frames that the record has when it is complete.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frames: Option<u32>,
    /// The scene's name.
    #[serde(default)]
    pub scene: String,
    /// The seed of all random draws.
    #[serde(default)]
    pub seed: u64,
    /// Seconds between frames.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dt: Option<f32>,
    /// Distance between opposite walls of the box about the origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<f32>,
    /// What is simulated and what isn't.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub effects: Option<Vec<EffectLine>>,
    /// The settings of culling.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cull: Option<CullSettings>,
    /// The shapes as built.
    pub shapes: Vec<ShapeLine>,
    /// The bodies, each with its shape.
    pub bodies: Vec<Body>,
}

/// An effect that the program knows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EffectLine {
    /// Its name.
    pub name: String,
    /// Whether the scene lists it.
    pub on: bool,
}

/// A shape as built.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShapeLine {
    /// The mesh's name.
    #[serde(default)]
    pub name: String,
    /// Body frame.
    pub vertices: Vec<[f32; 3]>,
    /// Vertex indices.
    pub triangles: Vec<[u32; 3]>,
    /// Centre and radius, body frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ball: Option<[f32; 4]>,
    /// The oriented k-DOP.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ordop: Option<OrDopLine>,
}

/// An or-DOP as built: slabs lo ≤ d·x ≤ hi along combinations of the basis vectors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrDopLine {
    /// 6, 14, 18 or 26.
    pub k: usize,
    /// The three basis vectors, one after the other.
    pub basis: [f32; 9],
    /// Lower ends.
    pub lo: Vec<f32>,
    /// Upper ends.
    pub hi: Vec<f32>,
}

/// A body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BodyLine {
    /// Index into the shapes.
    pub shape: u32,
    /// Whether it never moves; pairs of two such bodies are never listed.
    #[serde(rename = "static")]
    pub fixed: bool,
}

/// Every further line.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameLine {
    /// Its number.
    pub frame: u32,
    /// q (x, y, z, w), then t, of every body.
    pub poses: Vec<[f32; 7]>,
    /// The translations of every body in f64, where f32 doesn't hold them all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub translations: Option<Vec<[f64; 3]>>,
    /// The reported pairs i < j, sorted.
    pub pairs: Vec<[u32; 2]>,
    /// The counters of this frame's culling, in the order of its tests.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub counters: Option<Vec<VolumeLine>>,
    /// The pairs whose meshes meet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meets: Option<Vec<[u32; 2]>>,
}

/// What was counted of one volume.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VolumeLine {
    /// The volume's name.
    pub volume: String,
    /// Its counters in this frame.
    #[serde(flatten)]
    pub counters: VolumeCounters,
}

impl ShapeLine {
    /// A shape's numbers.
    #[must_use]
    pub fn of(shape: &Shape) -> Self {
        let [x, y, z] = shape.ball.centre;
        let [a, b, c] = shape.ordop.basis.columns;
        Self {
            name: shape.name.clone(),
            vertices: shape.vertices.clone(),
            triangles: shape.triangles.clone(),
            ball: Some([x, y, z, shape.ball.radius]),
            ordop: Some(OrDopLine {
                k: shape.ordop.directions.k(),
                basis: [a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]],
                lo: shape.ordop.lo.clone(),
                hi: shape.ordop.hi.clone(),
            }),
        }
    }
}

impl FrameLine {
    /// The poses of these bodies.
    #[must_use]
    pub fn poses(bodies: &Bodies) -> Vec<[f32; 7]> {
        let poses = bodies.rotation.iter().zip(&bodies.translation);
        poses.map(|(&[qx, qy, qz, qw], &[tx, ty, tz])| [qx, qy, qz, qw, tx, ty, tz]).collect()
    }

    /// Moves the bodies to this frame's poses.
    ///
    /// # Panics
    /// The numbers of bodies differ; a [`Reader`] has compared them.
    pub fn pose(&self, bodies: &mut Bodies) {
        assert_eq!(self.poses.len(), bodies.len(), "a pose per body");
        for (body, &[qx, qy, qz, qw, tx, ty, tz]) in self.poses.iter().enumerate() {
            bodies.rotation[body] = [qx, qy, qz, qw];
            bodies.translation[body] = [tx, ty, tz];
        }
    }
}
