//! A verdict as files: the smallest scene of a miss, and JUnit's XML for programs that collect test
//! results.

use std::fmt::Write as _;

use super::claim::Claim;
use super::score::Outcome;
pub use super::shrink::STEM;
use super::shrink::Smallest;
use super::verdict::Verdict;
use super::wire::ndjson;
use sdop::bodies::Bodies;
use sdop::mesh::{MeshFormat, ReadOptions, TriangleMesh, read_bytes, write_bytes};
use sdop::volume::{Axes, Origin, Shape, ShapeSpec};

/// A file's name and what is in it.
pub type Named = (String, Vec<u8>);

/// A counter-example as a case file (`.ndjson`, with the pairs that were reported, for `sdop view`
/// and `sdop check`) and, where a scene can state it, as one that `sdop run` takes (`.toml`, and
/// its meshes).
///
/// # Errors
/// A mesh that can't be written: none that was read.
pub fn counter_example(smallest: &Smallest, claim: Claim) -> std::io::Result<Vec<Named>> {
    let case = ndjson::encode(&smallest.case, claim, &smallest.pairs)?;
    let mut files = vec![(format!("{STEM}.ndjson"), case)];
    let Some(axes) = axes_of_scene(smallest) else {
        return Ok(files);
    };
    let shapes = &smallest.case.shapes;
    files.push((
        format!("{STEM}.toml"),
        scene(&smallest.case.frames[0].bodies, shapes, axes).into_bytes(),
    ));
    for (number, shape) in shapes.iter().enumerate() {
        let bytes = write_bytes(&mesh_of(shape), MeshFormat::Obj);
        files.push((format!("{STEM}-{number}.obj"), bytes));
    }
    Ok(files)
}

/// The axes with which a scene has the case's volumes; `None` where no scene can state the miss:
/// one about given boxes, one that takes a history, or one about volumes that aren't those of the
/// meshes.
fn axes_of_scene(smallest: &Smallest) -> Option<Axes> {
    let case = &smallest.case;
    if smallest.claim == Claim::Aabb || case.frames.len() != 1 {
        return None;
    }
    let directions = case.shapes.first()?.ordop.directions;
    let is_stated = |shape: &Shape, axes: Axes| {
        let mesh = mesh_of(shape);
        let text = write_bytes(&mesh, MeshFormat::Obj);
        let read = read_bytes("shape.obj", MeshFormat::Obj, &text, &ReadOptions::default());
        let spec = ShapeSpec {
            origin: Origin::File,
            radius: None,
            directions,
            axes,
        };
        let same = |built: Shape| match smallest.claim {
            Claim::Sphere => built.ball == shape.ball,
            Claim::OrDop => built.ordop == shape.ordop,
            Claim::Hull | Claim::Mesh => built.vertices == shape.vertices,
            Claim::Aabb => false,
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

/// A frame as a scene file. Formatting into a String cannot fail.
fn scene(bodies: &Bodies, shapes: &[Shape], axes: Axes) -> String {
    let mut text = format!("name = \"{STEM}\"\nframes = 1\n");
    for i in 0..bodies.len() {
        let shape = bodies.shape[i] as usize;
        let numbers = pose_in_text(bodies.rotation[i], bodies.translation[i]);
        let _ = write!(
            text,
            "\n[[bodies]] # {i}: {}\nmesh = \"{STEM}-{shape}.obj\"\norigin = \"file\"\nposes = [[{}]]\nstatic = {}\n",
            shapes[shape].name.escape_default(),
            numbers,
            !bodies.dynamic[i]
        );
    }
    let k = shapes[0].ordop.directions;
    let _ = write!(
        text,
        "\n[cull]\nstrategy = \"s-dop-sequential\"\nk = {k}\naxes = \"{axes}\"\n"
    );
    text
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
        for case in verdict
            .cases
            .iter()
            .filter(|case| case.group() == group.name)
        {
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
