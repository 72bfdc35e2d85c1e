//! `sdop mesh`: describes a mesh and how tightly each volume fits it, or converts it.

use std::fmt::Write as _;
use std::path::PathBuf;

use sdop::mesh::topology::{Topology, without_area};
use sdop::mesh::{ReadOptions, TriFormat, TriangleMesh, read, write};
use sdop::volume::{Hull, Origin, Shape, ShapeSpec};
use sdop_bench::decimate::decimate;
use sdop_bench::remedy::OrReport as _;
use sdop_bench::tightness::{Size, TURNS};
use serde::Serialize;

use super::files::ReadArgs;
use super::output::{Format, decimal, emit, table};
use super::{Outcome, one_of};

/// Describe a mesh and its bounding volumes, or convert it
///
/// Prints counts, whether the mesh is closed, its smallest enclosing ball, and the size of every
/// volume relative to the convex hull. World-aligned volumes (aabb, k-dop) change when a body
/// turns; their size is the mean over 64 rotations. Vertices that no triangle uses are ignored.
#[derive(clap::Args)]
#[command(
    after_help = "Examples: sdop mesh data/meshes/spot.tri\n          sdop mesh model.obj --to model.tri\n          sdop mesh model.obj --triangles 4000 --to coarse.tri"
)]
pub struct Args {
    /// The mesh file; its extension selects the format
    file: PathBuf,
    /// Write the mesh to this file, in the format of its extension
    #[arg(long, value_name = "FILE")]
    to: Option<PathBuf>,
    /// First collapse edges until the mesh has at most this many triangles
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    triangles: Option<u32>,
    /// The dialect of a .tri file, if several fit
    #[arg(long, value_name = "DIALECT", value_parser = one_of::<TriFormat>(TriFormat::NAMES))]
    tri_format: Option<TriFormat>,
    #[command(flatten)]
    files: ReadArgs,
    /// Output format
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// What is printed.
#[derive(Serialize)]
struct MeshReport {
    name: String,
    file: String,
    written: Option<String>,
    vertices: usize,
    unused_vertices: usize,
    triangles: usize,
    /// Triangles without area: a repeated index, two equal corners, or three corners on a line.
    degenerate_triangles: usize,
    components: usize,
    closed_components: usize,
    boundary_edges: usize,
    non_manifold_edges: usize,
    /// Vertices that count as another vertex at their position in what is said about components.
    merged_vertices: usize,
    /// What is not as the file or the command wants it.
    warnings: Vec<String>,
    /// Smallest enclosing ball (x, y, z, r) in the file's coordinates, of the vertices that
    /// triangles use, as all that follows.
    ball: [f64; 4],
    /// The origin of the vertices in the file's coordinates: zero unless the mesh is far from its
    /// origin.
    offset: [f64; 3],
    hull_vertices: usize,
    hull_volume: f64,
    volumes: Vec<Size>,
}

/// Runs the command.
///
/// # Errors
/// A mesh that can't be read or written.
pub fn run(args: &Args) -> miette::Result<Outcome> {
    let options = ReadOptions { tri_format: args.tri_format, max_bytes: args.files.max_bytes() };
    let mut mesh = read(&args.file, &options).or_report()?;
    if let Some(most) = args.triangles {
        mesh = decimate(&mesh, most as usize);
        let left = mesh.triangles.len();
        if left > most as usize {
            let reason = "every further collapse would change its topology or turn a triangle over";
            mesh.warnings.push(format!("{left} triangles are left instead of {most}: {reason}"));
        }
    }
    if let Some(path) = &args.to {
        write(&mesh, path).or_report()?;
    }
    let report = describe(args, &mesh)?;
    emit(args.format, &report, text)?;
    Ok(Outcome::Passed)
}

fn describe(args: &Args, mesh: &TriangleMesh) -> miette::Result<MeshReport> {
    let topology = Topology::of(mesh);
    let total = topology.total();
    let spec = ShapeSpec { origin: Origin::File, ..ShapeSpec::default() };
    let shape = Shape::build(&of_used_vertices(mesh), &spec).or_report()?;
    let hull = Hull::of(&shape.vertices);
    let centre = shape.ball.centre;
    let [x, y, z] = std::array::from_fn(|i| shape.offset[i] + f64::from(centre[i]));
    Ok(MeshReport {
        name: mesh.name.clone(),
        file: args.file.display().to_string(),
        written: args.to.as_ref().map(|path| path.display().to_string()),
        vertices: mesh.vertices.len(),
        unused_vertices: topology.unused_vertices,
        triangles: mesh.triangles.len(),
        degenerate_triangles: without_area(mesh),
        components: topology.components.len(),
        closed_components: topology.closed_components(),
        boundary_edges: total.boundary_edges,
        non_manifold_edges: total.non_manifold_edges,
        merged_vertices: topology.merged_vertices,
        warnings: mesh.warnings.clone(),
        ball: [x, y, z, shape.ball.radius.into()],
        offset: shape.offset,
        hull_vertices: hull.corners(&shape.vertices).len(),
        hull_volume: hull.volume(&shape.vertices),
        volumes: Size::of_all(&shape, &hull),
    })
}

/// The mesh without the vertices that no triangle uses.
fn of_used_vertices(mesh: &TriangleMesh) -> TriangleMesh {
    let mut used = mesh.triangles.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    let mut new_index = vec![0; mesh.vertices.len()];
    for (new, &old) in used.iter().enumerate() {
        new_index[old as usize] = new as u32; // no more than there were
    }
    let mut mesh = mesh.clone();
    mesh.vertices = used.iter().map(|&old| mesh.vertices[old as usize]).collect();
    for index in mesh.triangles.as_flattened_mut() {
        *index = new_index[*index as usize];
    }
    mesh
}

fn text(report: &MeshReport) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write_text(&mut text, report);
    text
}

fn write_text(out: &mut String, report: &MeshReport) -> std::fmt::Result {
    let (closed, all) = (report.closed_components, report.components);
    let state = match closed {
        _ if closed == all => "closed".to_owned(),
        0 => "open".to_owned(),
        _ => format!("{closed} closed, {} open", all - closed),
    };
    let [x, y, z, r] = report.ball;
    writeln!(out, "{} ({})", report.name, report.file)?;
    writeln!(
        out,
        "{} vertices ({} unused), {} triangles ({} degenerate)",
        report.vertices, report.unused_vertices, report.triangles, report.degenerate_triangles
    )?;
    writeln!(
        out,
        "components: {all}, {state}; boundary edges: {}, non-manifold edges: {}",
        report.boundary_edges, report.non_manifold_edges
    )?;
    if report.merged_vertices > 0 {
        writeln!(
            out,
            "{} vertices have the position of another one: components and edges are counted as if they were the same",
            report.merged_vertices
        )?;
    }
    for warning in &report.warnings {
        writeln!(out, "warning: {warning}")?;
    }
    if report.unused_vertices > 0 {
        writeln!(
            out,
            "ball, hull and volumes are of the vertices that triangles use; culled shapes contain all vertices"
        )?;
    }
    // Numbers far below the ball's size are rounding errors.
    let at = |x: f64| decimal(if x.abs() < 1e-6 * r { 0.0 } else { x });
    writeln!(
        out,
        "smallest ball: centre ({}, {}, {}), radius {}; lengths are in the mesh's unit",
        at(x),
        at(y),
        at(z),
        decimal(r)
    )?;
    if report.offset != [0.0; 3] {
        let [x, y, z] = report.offset;
        writeln!(out, "far from its origin: vertices are kept about ({x}, {y}, {z})")?;
    }
    writeln!(
        out,
        "convex hull: {} vertices, volume {} unit³",
        report.hull_vertices,
        volume(report.hull_volume, report)
    )?;
    if is_flat(report.hull_volume, report) {
        writeln!(
            out,
            "warning: the mesh is flat, or nearly so: its hull has no volume to compare with"
        )?;
    }
    let mut rows = table(&["volume", "size, unit³", "size / hull"]);
    for row in &report.volumes {
        let over_hull = row.over_hull.map_or("–".to_owned(), |x| format!("{x:.3}"));
        rows.add_row([row.name.clone(), volume(row.volume, report), over_hull]);
    }
    writeln!(out, "{rows}")?;
    writeln!(
        out,
        "aabb and k-dop are fitted anew when a body turns: means over {TURNS} rotations. obb is along the principal axes, \
         not the smallest box."
    )?;
    match &report.written {
        Some(path) => writeln!(out, "written to {path}"),
        None => Ok(()),
    }
}

/// Whether a volume is negligible compared with the ball's.
fn is_flat(volume: f64, report: &MeshReport) -> bool {
    let radius = report.ball[3];
    volume <= 1e-9 * radius.powi(3)
}

/// A volume; values far below the ball's are rounding errors.
fn volume(volume: f64, report: &MeshReport) -> String {
    decimal(if is_flat(volume, report) { 0.0 } else { volume })
}
