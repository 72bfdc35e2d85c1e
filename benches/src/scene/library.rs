//! The shapes of a scene: each mesh is read once, and built once for every radius that occurs.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use toml::Spanned;

use super::error::{SceneError, SceneText};
use super::file::SceneFile;
use super::group::{BodyForm, BodyGroup, ShapeSizes};
use crate::number::Factors;
use sdop::choice::suggest;
use sdop::mesh::{MeshError, ProceduralShape, ReadOptions, TriangleMesh, read, shapes::ShapeError};
use sdop::settings::CullSettings;
use sdop::volume::{Origin, Shape, ShapeSpec};

/// Meshes and shapes made so far.
#[derive(Default)]
pub(super) struct ShapeLibrary {
    meshes: Vec<TriangleMesh>,
    /// Mesh files by path and scale.
    files: HashMap<(PathBuf, Option<[u64; 3]>), usize>,
    procedural: Vec<(ProceduralShape, Option<[u64; 3]>, usize)>,
    shapes: Vec<Shape>,
    /// The shapes that were built, by mesh, origin and radius (its bits).
    built: HashMap<(usize, Origin, Option<u32>), u32>,
    seconds: f64,
}

impl ShapeLibrary {
    /// The number of a group's mesh, read or made when it is the first of its kind and scale.
    pub(super) fn mesh(
        &mut self,
        file: &SceneFile,
        group: &BodyGroup<'_>,
    ) -> Result<usize, SceneError> {
        let number = self.meshes.len();
        let scale = group.spec.scale.as_ref();
        let bits = scale.map(|scale| scale.get_ref().0.map(f64::to_bits));
        let mesh = match group.form {
            BodyForm::File(name) => {
                let key = (file.directory.join(name.get_ref()), bits);
                if let Some(&known) = self.files.get(&key) {
                    return Ok(known);
                }
                let mesh = read_mesh(file, name, &key.0)?;
                self.files.insert(key, number);
                mesh
            }
            BodyForm::Procedural(name, sizes) => {
                let (shape, mesh) = procedural(&file.source, name, sizes)?;
                let known =
                    |known: &&(ProceduralShape, _, usize)| known.0 == shape && known.1 == bits;
                if let Some((_, _, known)) = self.procedural.iter().find(known) {
                    return Ok(*known);
                }
                self.procedural.push((shape, bits, number));
                mesh
            }
        };
        self.meshes.push(match scale {
            None => mesh,
            Some(scale) => {
                let Factors(factors) = *scale.get_ref();
                let wrong = |error: MeshError| {
                    file.source.error(scale.span(), error.problem(), Some(error.help()))
                };
                mesh.scaled(factors).map_err(wrong)?
            }
        });
        Ok(number)
    }

    /// The number of a mesh's shape, built when it is the first of this origin and radius.
    ///
    /// # Errors
    /// A mesh that has no such volumes: the problem and its remedy.
    pub(super) fn shape(
        &mut self,
        mesh: usize,
        origin: Origin,
        radius: Option<f32>,
        cull: &CullSettings,
    ) -> Result<u32, (String, Option<String>)> {
        let key = (mesh, origin, radius.map(f32::to_bits));
        if let Some(&known) = self.built.get(&key) {
            return Ok(known);
        }
        let spec = ShapeSpec { origin, radius, directions: cull.k, axes: cull.axes };
        let start = Instant::now();
        let shape = Shape::build(&self.meshes[mesh], &spec)
            .map_err(|error| (error.problem(), Some(error.help().to_owned())))?;
        self.seconds += start.elapsed().as_secs_f64();
        // Fewer shapes than bodies, which a u32 counts.
        let number = self.shapes.len() as u32;
        self.shapes.push(shape);
        self.built.insert(key, number);
        Ok(number)
    }

    /// A shape made earlier.
    pub(super) fn get(&self, shape: u32) -> &Shape {
        &self.shapes[shape as usize]
    }

    /// All shapes, and the seconds that building them took.
    pub(super) fn into_shapes(self) -> (Vec<Shape>, f64) {
        (self.shapes, self.seconds)
    }
}

fn read_mesh(
    file: &SceneFile,
    name: &Spanned<String>,
    path: &Path,
) -> Result<TriangleMesh, SceneError> {
    let options = ReadOptions { max_bytes: file.max_bytes, ..ReadOptions::default() };
    let mesh = read(path, &options).map_err(|error| {
        let hint = if path.exists() { Some(error.help()) } else { nearest_file(path) };
        file.source.error(name.span(), error.problem(), hint)
    })?;
    mesh.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
    Ok(mesh)
}

fn procedural(
    source: &SceneText,
    name: &Spanned<String>,
    sizes: &ShapeSizes,
) -> Result<(ProceduralShape, TriangleMesh), SceneError> {
    let known = ProceduralShape::NAMES;
    if !known.contains(&name.get_ref().as_str()) {
        let message = format!("there is no shape `{}`", name.get_ref());
        return Err(source.error(name.span(), message, suggest(name.get_ref(), known.into_iter())));
    }
    let values: Vec<(&str, f64)> = sizes
        .iter()
        .map(|(size, value)| (size.get_ref().as_str(), f64::from(value.get_ref().0)))
        .collect();
    let made = ProceduralShape::from_name(name.get_ref(), &values)
        .and_then(|shape| Ok((shape, shape.build()?)));
    made.map_err(|error| {
        let blamed = match &error {
            ShapeError::UnknownSize { size, .. } => {
                sizes.keys().find(|key| key.get_ref() == size).map(Spanned::span)
            }
            ShapeError::BadSize { size, .. } => {
                sizes.iter().find(|(key, _)| key.get_ref() == size).map(|(_, value)| value.span())
            }
            ShapeError::UnknownShape { .. } => None,
        };
        source.error(blamed.unwrap_or(name.span()), error.problem(), error.help())
    })
}

/// What is next to a file that doesn't exist.
fn nearest_file(path: &Path) -> Option<String> {
    let wanted = path.file_name()?.to_str()?;
    let relative = "mesh paths are relative to the scene file";
    let parent = match path.parent()? {
        empty if empty.as_os_str().is_empty() => Path::new("."),
        parent => parent,
    };
    let Ok(directory) = std::fs::read_dir(parent) else {
        return Some(format!("{relative}; the directory doesn't exist either"));
    };
    let mut names: Vec<String> =
        directory.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    names.sort();
    Some(format!("{relative}; {}", suggest(wanted, names.iter().map(String::as_str))))
}
