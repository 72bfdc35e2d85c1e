//! The page's header: the facts about a run, and the list of blocks that follow.

use std::path::Path;

use serde::Serialize;

use super::ShownRun;
use super::shown_run::{Focus, file_name, in_words};
use sdop::settings::{Interest, Strategy};
use sdop_judge::Claim;
use sdop_judge::record::{EffectLine, OrDopLine, RecordError};

/// The format's name in the header.
const FORMAT: &str = "sdop-view";
/// The layout of header and blocks; `web/src/data.ts` has the same number.
const VERSION: u32 = 1;

#[derive(Debug, Default, Serialize)]
pub struct Header {
    pub format: &'static str,
    pub version: u32,
    pub scene: String,
    pub source: String,
    /// Text: JavaScript's numbers don't hold all of it.
    pub seed: Option<String>,
    pub dt: Option<f32>,
    pub side: Option<f32>,
    pub interest: Vec<u32>,
    pub bodies: usize,
    pub moving: usize,
    pub frames: usize,
    pub pairs: usize,
    pub shapes: Vec<ShapeHeader>,
    pub runs: Vec<RunHeader>,
    pub truth: bool,
    /// The text that says what meets.
    pub meet: &'static str,
    /// Layers that are switched on at first.
    pub layers: Vec<&'static str>,
    pub effects: Option<Vec<EffectLine>>,
    /// The missed pair of a counter-example.
    pub focus: Option<Focus>,
    pub messages: Vec<String>,
    pub blocks: Vec<BlockHeader>,
}

#[derive(Debug, Serialize)]
pub struct ShapeHeader {
    pub name: String,
    pub triangles: usize,
    pub ball: Option<[f32; 4]>,
    pub reach: f32,
    pub ordop: Option<OrDopLine>,
    pub lods: Vec<Level>,
    pub hull: [usize; 2],
}

/// First and number of vertices, and of triangles, in the blocks of all shapes.
#[derive(Debug, Serialize)]
pub struct Level {
    pub vertices: [usize; 2],
    pub triangles: [usize; 2],
}

#[derive(Debug, Serialize)]
pub struct RunHeader {
    pub name: String,
    pub detail: String,
    pub control: bool,
    pub volumes: Option<Vec<String>>,
    pub construct: Option<f64>,
}

#[derive(Debug, Serialize)]
pub struct BlockHeader {
    pub name: String,
    pub r#type: &'static str,
    pub length: usize,
}

impl Header {
    /// The facts that are known without the frames.
    pub fn of(show: &ShownRun) -> Self {
        let header = &show.header;
        let interest = match header.cull.as_ref().map(|cull| (cull.strategy, &cull.interest)) {
            Some((Strategy::SDopObjectOfInterest, Some(Interest::Bodies(list)))) => list.clone(),
            _ => Vec::new(),
        };
        Self {
            format: FORMAT,
            version: VERSION,
            scene: header.scene.clone(),
            source: show.source.clone(),
            seed: Some(header.seed.to_string()),
            dt: header.dt,
            side: header.side,
            interest,
            bodies: header.bodies.len(),
            meet: meet(show.claim),
            layers: layers(show.claim),
            effects: header.effects.clone(),
            focus: show.focus.clone(),
            messages: show.messages.clone(),
            ..Self::default()
        }
    }

    /// The header for a record that can't be shown.
    pub fn broken(path: &Path, error: &RecordError) -> Self {
        let name = file_name(path);
        Self {
            format: FORMAT,
            version: VERSION,
            scene: name.clone(),
            source: name,
            messages: vec![in_words(error)],
            ..Self::default()
        }
    }
}

/// The page's text for what meets if a claim holds for a pair.
fn meet(claim: Claim) -> &'static str {
    match claim {
        Claim::Sphere => "bounding balls",
        Claim::Aabb | Claim::Order | Claim::Restore => "boxes",
        Claim::Filter => "boxes that no filter parts",
        Claim::Margin => "boxes within their margins",
        Claim::Periodic => "boxes or their images",
        Claim::OrDop => "or-DOPs",
        Claim::Hull => "convex hulls",
        Claim::Mesh => "meshes",
        Claim::Parts => "meshes of parts",
    }
}

/// The volumes of a claim, by their names in the page's address.
fn layers(claim: Claim) -> Vec<&'static str> {
    match claim {
        Claim::Sphere => vec!["spheres"],
        _ if claim.is_of_boxes() => vec!["boxes"],
        Claim::OrDop => vec!["ordops"],
        _ => Vec::new(),
    }
}
