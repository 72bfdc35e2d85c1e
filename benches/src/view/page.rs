//! The page's data: a JSON header and blocks of little-endian numbers in base64, read by
//! `web/src/data.ts`.

use std::io::{self, Write};
use std::path::Path;

use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use rayon::prelude::*;

use super::detail::DrawnShape;
use super::header::{BlockHeader, Header, Level, RunHeader, ShapeHeader};
use super::pairs::Pairs;
use super::terms::{self, TermCourse};
use super::{ShownRun, ShownStrategy};
use crate::remedy::OrReport as _;
use sdop::settings::Strategy;
use sdop::simd::Tier;
use sdop_judge::record::{FrameLine, RecordError, ShapeLine};

/// The page without data, as `web/build.mjs` makes it.
const PAGE: &str = include_str!("web/dist/page.html");
/// The place of the data.
const MARK: &str = "<!--DATA-->";
/// The longest block that a browser reads, in bytes: its base64 must be one string.
const LONGEST: usize = 380 << 20;

/// A page, ready to be written.
#[derive(Debug)]
pub struct Page {
    header: Header,
    blocks: Vec<Block>,
}

#[derive(Debug)]
struct Block {
    name: String,
    bytes: Vec<u8>,
}

impl Page {
    /// Makes the page of a run as culled by one strategy or two. With a `tier`, prices are
    /// calibrated in it, and T is shown.
    ///
    /// # Errors
    /// The run is too large for a browser.
    pub fn new(
        show: &ShownRun,
        culled: &[ShownStrategy],
        tier: Option<Tier>,
    ) -> miette::Result<Self> {
        let mut page = Self { header: Header::of(show), blocks: Vec::new() };
        if show.frames.is_empty() {
            if page.header.messages.is_empty() {
                page.header.messages.push("The record has no frames.".to_owned());
            }
            return Ok(page);
        }
        page.header.frames = show.frames.len();
        page.header.truth = show.frames.iter().all(|frame| frame.meets.is_some());
        page.put_poses(show)?;
        if let Some(boxes) = &show.boxes {
            page.put("boxes", boxes.concat().into_flattened())?;
        }
        if let Some(periods) = &show.periods {
            let periods = periods.as_flattened().iter();
            let periods = periods.map(|period| period.unwrap_or(0.0));
            page.put("periods", periods.collect::<Vec<f64>>())?;
        }
        page.put_pairs(show, culled)?;
        page.put_shapes(show)?;
        for (side, culled) in culled.iter().enumerate() {
            page.put_run(show, culled, side, tier)?;
        }
        Ok(page)
    }

    /// A page with the reason why a record can't be shown.
    #[must_use]
    pub fn broken(path: &Path, error: &RecordError) -> Self {
        Self { header: Header::broken(path, error), blocks: Vec::new() }
    }

    /// Writes the page.
    ///
    /// # Errors
    /// The writer fails.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let [before, after] = Self::around()?;
        out.write_all(before.as_bytes())?;
        self.write_data(out)?;
        out.write_all(after.as_bytes())
    }

    /// The parts of every page before and after its data.
    ///
    /// # Errors
    /// The page has no mark, which never happens for the built-in one.
    pub fn around() -> io::Result<[&'static str; 2]> {
        let parts = PAGE.split_once(MARK).map(<[_; 2]>::from);
        parts.ok_or_else(|| io::Error::other("the page has no mark"))
    }

    /// Writes only the data, as elements of HTML.
    ///
    /// # Errors
    /// The writer fails.
    pub fn write_data(&self, out: &mut impl Write) -> io::Result<()> {
        // Nothing in the header may end its element: "<" is written as the escape that JSON has for
        // it.
        let header = serde_json::to_string(&self.header)?.replace('<', "\\u003c");
        writeln!(out, "<script type=\"application/json\" id=\"sdop-header\">{header}</script>")?;
        for block in &self.blocks {
            write!(out, "<script type=\"text/plain\" id=\"block-{}\">", block.name)?;
            let mut encoder = EncoderWriter::new(&mut *out, &STANDARD);
            encoder.write_all(&block.bytes)?;
            encoder.finish()?;
            drop(encoder);
            writeln!(out, "</script>")?;
        }
        Ok(())
    }

    /// The poses of all bodies in the first frame, and in every frame those of bodies that ever
    /// move.
    fn put_poses(&mut self, show: &ShownRun) -> miette::Result<()> {
        let frames = &show.frames;
        let first = &frames[0].poses;
        let bits = |pose: &[f32; 7]| pose.map(f32::to_bits);
        let moves = |&body: &u32| {
            let body = body as usize;
            frames.iter().any(|frame| bits(&frame.poses[body]) != bits(&first[body]))
        };
        let moving: Vec<u32> = (0..first.len() as u32).filter(moves).collect();
        let posed = |frame: &FrameLine| {
            moving.iter().flat_map(|&body| frame.poses[body as usize]).collect::<Vec<_>>()
        };
        self.header.moving = moving.len();
        self.put("numbers", frames.iter().map(|frame| frame.frame).collect::<Vec<u32>>())?;
        self.put("shape", show.bodies.shape.clone())?;
        self.put(
            "static",
            show.bodies.dynamic.iter().map(|&dynamic| u8::from(!dynamic)).collect::<Vec<u8>>(),
        )?;
        self.put("moving", moving.clone())?;
        self.put("first", first.as_flattened().to_vec())?;
        self.put("poses", frames.iter().flat_map(posed).collect::<Vec<f32>>())
    }

    fn put_pairs(&mut self, show: &ShownRun, culled: &[ShownStrategy]) -> miette::Result<()> {
        let Pairs { starts, pairs, flags } = Pairs::join(show, culled).or_report()?;
        self.header.pairs = pairs.len();
        self.put("starts", starts.iter().map(|&start| start as f64).collect::<Vec<f64>>())?;
        match u16::try_from(show.bodies.len()) {
            Ok(_) => self.put(
                "pairs",
                pairs.as_flattened().iter().map(|&body| body as u16).collect::<Vec<u16>>(),
            )?,
            Err(_) => self.put("pairs", pairs.as_flattened().to_vec())?,
        }
        self.put("flags", flags)
    }

    fn put_shapes(&mut self, show: &ShownRun) -> miette::Result<()> {
        let drawn: Vec<DrawnShape> = show.shapes.par_iter().map(DrawnShape::of).collect();
        let (mut vertices, mut triangles, mut hulls) = (Vec::new(), Vec::new(), Vec::new());
        for (shape, drawn) in show.shapes.iter().zip(drawn) {
            let ShapeLine { name, ball, ordop, .. } = ShapeLine::of(shape);
            let hull = [hulls.len(), drawn.hull.len()];
            hulls.extend(drawn.hull);
            let lods = drawn.levels.iter().map(|mesh| {
                let level = Level {
                    vertices: [vertices.len(), mesh.vertices.len()],
                    triangles: [triangles.len(), mesh.triangles.len()],
                };
                vertices.extend(&mesh.vertices);
                triangles.extend_from_slice(&mesh.triangles);
                level
            });
            self.header.shapes.push(ShapeHeader {
                name,
                triangles: shape.triangles.len(),
                ball,
                reach: shape.reach,
                ordop,
                lods: lods.collect(),
                hull,
            });
        }
        self.put("vertices", vertices.into_flattened())?;
        self.put("triangles", triangles.into_flattened())?;
        self.put("hull", hulls.into_flattened())
    }

    fn put_run(
        &mut self,
        show: &ShownRun,
        culled: &ShownStrategy,
        side: usize,
        tier: Option<Tier>,
    ) -> miette::Result<()> {
        let prices = match tier {
            Some(tier) if culled.counters.is_some() => terms::prices(show, culled, tier)?,
            _ => None,
        };
        let course = prices.and_then(|prices| TermCourse::predict(show, culled, &prices));
        let mut run = RunHeader {
            name: culled.name.clone(),
            detail: culled.detail.clone(),
            control: culled.settings.as_ref().is_some_and(|cull| cull.strategy == Strategy::None),
            volumes: None,
            construct: None,
        };
        if let Some(counters) = &culled.counters {
            let names = counters[0].iter().map(|line| line.volume.clone());
            run.volumes = Some(names.collect());
            let numbers = counters.iter().flatten().flat_map(|line| {
                let counted = &line.counters;
                [counted.updates, counted.tests, counted.hits].map(|count| count as f64)
            });
            self.put(&format!("counters-{side}"), numbers.collect::<Vec<f64>>())?;
        }
        if let Some(TermCourse { construct, frames }) = course {
            run.construct = Some(construct);
            self.put(&format!("terms-{side}"), frames.into_flattened())?;
        }
        self.header.runs.push(run);
        Ok(())
    }

    fn put<T: Number>(&mut self, name: &str, numbers: Vec<T>) -> miette::Result<()> {
        let size = numbers.len() * size_of::<T>();
        if size > LONGEST {
            miette::bail!(
                help = "show fewer frames: --frames N",
                "{} of {} frames take {} MB, more than browsers can read",
                if name == "poses" { "the poses" } else { "the pairs" },
                self.header.frames,
                size >> 20
            );
        }
        let mut bytes = Vec::with_capacity(size);
        for number in &numbers {
            number.put(&mut bytes);
        }
        self.header.blocks.push(BlockHeader {
            name: name.to_owned(),
            r#type: T::TYPE,
            length: numbers.len(),
        });
        self.blocks.push(Block { name: name.to_owned(), bytes });
        Ok(())
    }
}

/// The type of a block's numbers.
trait Number: Copy {
    /// Its name on the page.
    const TYPE: &'static str;
    fn put(self, bytes: &mut Vec<u8>);
}

macro_rules! numbers {
    ($($number:ident = $name:literal),+) => {
        $(impl Number for $number {
            const TYPE: &'static str = $name;
            fn put(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }
        })+
    };
}

numbers!(u8 = "u8", u16 = "u16", u32 = "u32", f32 = "f32", f64 = "f64");
