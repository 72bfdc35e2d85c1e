//! A verdict as files: the smallest scene of a miss, and JUnit's XML for programs that collect test
//! results.

use std::fmt::Write as _;

use super::case::Case;
use super::claim::Claim;
use super::score::Outcome;
pub use super::shrink::STEM;
use super::shrink::SmallestCase;
use super::verdict::Verdict;
use super::wire::ndjson;
use sdop::mesh::{MeshFormat, ReadOptions, TriangleMesh, read_bytes, write_bytes};
use sdop::volume::{Axes, Origin, Shape, ShapeSpec};

/// A file's name and what is in it.
pub type NamedFile = (String, Vec<u8>);

/// A counter-example as a case file (`.ndjson`, with the pairs that were reported, for `sdop view`
/// and `sdop check`) and, where a scene can state it, as one that `sdop run` takes (`.toml`, and
/// its meshes).
///
/// # Errors
/// A mesh can't be written. This does not happen for meshes that were read.
pub fn counter_example(smallest: &SmallestCase) -> std::io::Result<Vec<NamedFile>> {
    let mut files = vec![case_file(smallest)?];
    if let Some(axes) = axes_of_scene(&smallest.case) {
        let k = smallest.case.shapes[0].ordop.directions;
        let cull = format!("[cull]\nstrategy = \"s-dop-sequential\"\nk = {k}\naxes = \"{axes}\"\n");
        files.extend(scene(&smallest.case, "file", &cull));
    }
    Ok(files)
}

/// The case with the pairs that were reported.
///
/// # Errors
/// As [`counter_example`].
pub fn case_file(smallest: &SmallestCase) -> std::io::Result<NamedFile> {
    let case = ndjson::encode(&smallest.case, &smallest.pairs)?;
    Ok((format!("{STEM}.ndjson"), case))
}

/// The axes with which a scene has the case's volumes; `None` where no scene can state the miss:
/// one about given boxes or parts, one that takes a history, or one about volumes that aren't those
/// of the meshes.
fn axes_of_scene(case: &Case) -> Option<Axes> {
    let has_parts = case.frames.iter().any(|frame| frame.parts.is_some());
    if case.claim.is_of_boxes() || has_parts || case.frames.len() != 1 {
        return None;
    }
    let directions = case.shapes.first()?.ordop.directions;
    let is_stated = |shape: &Shape, axes: Axes| {
        let mesh = mesh_of(shape);
        let text = write_bytes(&mesh, MeshFormat::Obj);
        let read = read_bytes("shape.obj", MeshFormat::Obj, &text, &ReadOptions::default());
        let spec = ShapeSpec { origin: Origin::File, radius: None, directions, axes };
        let same = |built: Shape| match case.claim {
            Claim::Sphere => built.ball == shape.ball,
            Claim::OrDop => built.ordop == shape.ordop,
            Claim::Hull | Claim::Mesh | Claim::Parts => built.vertices == shape.vertices,
            _ => false, // above
        };
        read.is_ok_and(|read| Shape::build(&read, &spec).is_ok_and(same))
    };
    let all = |axes: &&Axes| case.shapes.iter().all(|shape| is_stated(shape, **axes));
    Axes::ALL.iter().find(all).copied()
}

fn mesh_of(shape: &Shape) -> TriangleMesh {
    TriangleMesh {
        name: shape.name.clone(),
        vertices: shape.vertices.clone(),
        triangles: shape.triangles.clone(),
        ..TriangleMesh::default()
    }
}

/// A case's first frame as a scene file and the meshes that it names: where meshes have their
/// origins, and the table that says how to cull. Formatting into a String cannot fail.
#[must_use]
pub fn scene(case: &Case, origin: &str, cull: &str) -> Vec<NamedFile> {
    let mut text = format!("name = \"{STEM}\"\nframes = 1\n");
    let bodies = &case.frames[0].bodies;
    for i in 0..bodies.len() {
        let shape = bodies.shape[i] as usize;
        let _ = write!(
            text,
            "\n[[bodies]] # {i}: {}\nmesh = \"{STEM}-{shape}.obj\"\norigin = \"{origin}\"\nposes = [[{}]]\nstatic = {}\n",
            case.shapes[shape].name.escape_default(),
            pose_in_text(bodies.rotation[i], bodies.translation[i]),
            !bodies.dynamic[i]
        );
    }
    text += &format!("\n{cull}");
    let mesh = |(number, shape)| {
        let bytes = write_bytes(&mesh_of(shape), MeshFormat::Obj);
        (format!("{STEM}-{number}.obj"), bytes)
    };
    let meshes = case.shapes.iter().enumerate().map(mesh);
    std::iter::once((format!("{STEM}.toml"), text.into_bytes())).chain(meshes).collect()
}

/// A pose's seven numbers as a scene file has them: written as f64, so that the translation is this
/// one and no other f64.
#[must_use]
pub fn pose_in_text(rotation: [f32; 4], translation: [f32; 3]) -> String {
    let pose = rotation.into_iter().chain(translation);
    let numbers: Vec<String> = pose.map(|x| format!("{:?}", f64::from(x))).collect();
    numbers.join(", ")
}

/// JUnit's XML: a suite for each group, a test for each case.
#[must_use]
pub fn junit(verdict: &Verdict) -> String {
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n");
    for group in verdict.groups() {
        let tests = group.passed + group.failed + group.skipped + group.errors;
        let _ = writeln!(
            text,
            "  <testsuite name=\"{}\" tests=\"{tests}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\">",
            escaped(&group.name),
            group.failed,
            group.errors,
            group.skipped
        );
        for case in verdict.cases.iter().filter(|case| case.group() == group.name) {
            let _ = write!(
                text,
                "    <testcase classname=\"{}\" name=\"{}\"",
                escaped(&group.name),
                escaped(&case.name)
            );
            let _ = match &case.outcome {
                Outcome::Pass => writeln!(text, "/>"),
                Outcome::Fail { why } => {
                    writeln!(text, "><failure message=\"{}\"/></testcase>", escaped(why))
                }
                Outcome::Skipped { why } => {
                    writeln!(text, "><skipped message=\"{}\"/></testcase>", escaped(why))
                }
                Outcome::Error { trouble } => writeln!(
                    text,
                    "><error message=\"{}\"/></testcase>",
                    escaped(&trouble.to_string())
                ),
            };
        }
        text.push_str("  </testsuite>\n");
    }
    if verdict.not_run > 0 {
        let n = verdict.not_run;
        let _ = writeln!(
            text,
            "  <testsuite name=\"not run\" tests=\"{n}\" failures=\"0\" errors=\"0\" skipped=\"{n}\"/>"
        );
    }
    text.push_str("</testsuites>\n");
    text
}

/// Text in an attribute; XML has no way to write most control characters.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' => escaped.push(' '),
            c if c.is_control() => escaped.push('\u{fffd}'),
            c => escaped.push(c),
        }
    }
    escaped
}
