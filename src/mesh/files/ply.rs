//! PLY, text and binary, parsed by `ply-rs-bw`.
//!
//! Elements are read one kind at a time into types that keep only what a mesh needs, and only after a check that the
//! file can hold as many as the header declares: a count alone must not cost memory or time. Polygons become fans;
//! faces of one or two vertices become degenerate triangles.

use std::io::ErrorKind;

use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType,
    ScalarType,
};

use super::read::Parts;
use super::text::{Fault, between_f32, excerpt};
use crate::mesh::{Problem, check_triangle, check_vertex};

/// Reads a PLY file.
pub(super) fn read(bytes: &[u8]) -> Result<Parts, Fault> {
    if bytes.is_empty() {
        return Err((None, Problem::NoVertices));
    }
    let mut file = File {
        bytes,
        reader: Reader::new(bytes),
        text: false,
    };
    let header = Parser::<Skipped>::new()
        .read_header(&mut file.reader)
        .map_err(|error| file.bad_line("a PLY header", &error, true))?;
    file.text = header.encoding == Encoding::Ascii;
    check_header(&header)?;
    let (mut vertices, mut polygons, mut face_line) = (Vec::new(), Vec::new(), None);
    for element in header.elements.values() {
        let first_line = file.line();
        match element.name.as_str() {
            "vertex" => {
                let points = file.points(element, &header)?;
                for (index, position) in points.into_iter().enumerate() {
                    let line = first_line.map(|line| line + index);
                    check_vertex(index, position).map_err(|problem| (line, problem))?;
                    vertices.push(position);
                }
            }
            "face" => {
                face_line = first_line;
                polygons = file.elements::<Polygon>(element, &header)?;
            }
            _ => {
                file.elements::<Skipped>(element, &header)?;
            }
        }
    }
    file.check_end()?;
    let triangles = triangulate(&polygons, vertices.len(), face_line)?;
    Ok(Parts::indexed(vertices, triangles))
}

/// A file that is being read, with what is needed to say where it is wrong.
struct File<'a> {
    bytes: &'a [u8],
    reader: Reader<&'a [u8]>,
    text: bool,
}

impl File<'_> {
    /// The line that comes next, when lines mean anything.
    fn line(&self) -> Option<usize> {
        self.text.then(|| self.reader.line())
    }

    /// The vertices. Text may have more digits than the f32 that the header promises, so it is read as f64.
    fn points(&mut self, element: &ElementDef, header: &Header) -> Result<Vec<[f64; 3]>, Fault> {
        let start = *self.reader.get_ref();
        let mut wide = element.clone();
        for property in wide.properties.values_mut() {
            if self.text && property.data_type == PropertyType::Scalar(ScalarType::Float) {
                property.data_type = PropertyType::Scalar(ScalarType::Double);
            }
        }
        let mut points: Vec<Point> = self.elements(&wide, header)?;
        if points.iter().any(Point::is_between_f32) {
            // What is an f64 is an f32 too, so there is no error to tell.
            let again = Parser::<Point>::new();
            let nearest = again.read_payload_for_element(&mut Reader::new(start), element, header);
            for (point, nearest) in points.iter_mut().zip(nearest.unwrap_or_default()) {
                point.round_to(nearest);
            }
        }
        Ok(points.into_iter().map(|Point(position)| position).collect())
    }

    fn elements<E: PropertyAccess>(
        &mut self,
        element: &ElementDef,
        header: &Header,
    ) -> Result<Vec<E>, Fault> {
        let (name, count, left) = (&element.name, element.count, self.reader.get_ref().len());
        let size = if self.text {
            1
        } else {
            least_binary_size(element)
        };
        if size == 0 {
            // Elements without properties take no bytes, however many the header declares.
            return Ok(Vec::new());
        }
        if count > left / size + usize::from(self.text) {
            let message = format!(
                "the header declares {count} {name} elements, but only {left} bytes follow"
            );
            return Err((self.line(), malformed(message)));
        }
        Parser::<E>::new()
            .read_payload_for_element(&mut self.reader, element, header)
            .map_err(|error| {
                self.bad_line(
                    &format!("one of {count} {name} elements"),
                    &error,
                    self.text,
                )
            })
    }

    fn bad_line(&self, what: &str, error: &ParseError, lines_count: bool) -> Fault {
        let line = error.line().filter(|_| lines_count);
        let message = match line.map(|line| self.line_text(line)) {
            _ if error.kind() == ErrorKind::UnexpectedEof => format!("the file ends in {what}"),
            Some(text) => format!("this does not fit {what}: {}", excerpt(&text)),
            None => format!("the data does not fit {what}"),
        };
        (line, malformed(message))
    }

    fn line_text(&self, line: usize) -> String {
        let text = self
            .bytes
            .split(|&byte| byte == b'\n')
            .nth(line - 1)
            .unwrap_or_default();
        String::from_utf8_lossy(text).trim_end().to_owned()
    }

    fn check_end(&self) -> Result<(), Fault> {
        let rest = *self.reader.get_ref();
        let rest = if self.text { rest.trim_ascii() } else { rest };
        if rest.is_empty() {
            return Ok(());
        }
        let message = format!("{} bytes too many after the last element", rest.len());
        Err((self.line(), malformed(message)))
    }
}

fn malformed(message: String) -> Problem {
    Problem::malformed(
        message,
        "the header's element and property lines must match the data that follows",
    )
}

/// A mesh needs vertices with x, y, z and faces with a list of indices.
fn check_header(header: &Header) -> Result<(), Fault> {
    let scalar = |property: &PropertyType| matches!(property, PropertyType::Scalar(_));
    let vertex_has = |name: &str| {
        let property = header
            .elements
            .get("vertex")
            .and_then(|vertex| vertex.properties.get(name));
        property.is_some_and(|property| scalar(&property.data_type))
    };
    let face_has = |name: &&str| {
        let property = header
            .elements
            .get("face")
            .and_then(|face| face.properties.get(*name));
        property.is_some_and(|property| !scalar(&property.data_type))
    };
    let missing = if !["x", "y", "z"].into_iter().all(vertex_has) {
        "an element vertex with the properties x, y and z"
    } else if !INDEX_LISTS.iter().any(face_has) {
        "an element face with a list property vertex_indices"
    } else {
        return Ok(());
    };
    Err((
        None,
        Problem::malformed(
            format!("the header lacks {missing}"),
            "export the mesh as vertices and faces",
        ),
    ))
}

/// The two names in use for a face's corners.
const INDEX_LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The bytes of one binary element whose lists are all empty.
fn least_binary_size(element: &ElementDef) -> usize {
    let size = |scalar: &ScalarType| match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    let properties = element.properties.values();
    properties
        .map(|property| match &property.data_type {
            PropertyType::Scalar(scalar) | PropertyType::List(scalar, _) => size(scalar),
        })
        .sum()
}

fn triangulate(
    polygons: &[Polygon],
    vertices: usize,
    first_line: Option<usize>,
) -> Result<Vec<[u32; 3]>, Fault> {
    let mut triangles = Vec::new();
    for (face, Polygon(corners)) in polygons.iter().enumerate() {
        let line = first_line.map(|line| line + face);
        let fan: Vec<[i64; 3]> = match corners[..] {
            [] => {
                return Err((
                    line,
                    Problem::malformed(format!("face {face} has no vertices"), "remove it"),
                ));
            }
            [a] => vec![[a, a, a]],
            [a, b] => vec![[a, b, b]],
            [a, ref rest @ ..] => rest.windows(2).map(|edge| [a, edge[0], edge[1]]).collect(),
        };
        for triangle in fan {
            check_triangle(face, triangle, 0, vertices).map_err(|problem| (line, problem))?;
            triangles.push(triangle.map(|index| index as u32));
        }
    }
    Ok(triangles)
}

/// A vertex's position; its other properties are passed over.
struct Point([f64; 3]);

impl Point {
    /// Whether a coordinate lies in the middle of two f32, and the text perhaps on another side of it.
    fn is_between_f32(&self) -> bool {
        self.0.iter().any(|&x| between_f32(x, || Err(())).is_err())
    }

    /// Moves coordinates between two f32 to the side of the text, of which `nearest` was read as f32.
    fn round_to(&mut self, nearest: Self) {
        for (x, nearest) in self.0.iter_mut().zip(nearest.0) {
            *x = between_f32(*x, || Ok::<_, ()>(nearest as f32)).unwrap_or(*x);
        }
    }
}

impl PropertyAccess for Point {
    fn new() -> Self {
        Self([0.0; 3])
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(axis) = ["x", "y", "z"].iter().position(|axis| *axis == name) else {
            return PropertyAccessResult::Ignored;
        };
        self.0[axis] = match property {
            Property::Char(x) => x.into(),
            Property::UChar(x) => x.into(),
            Property::Short(x) => x.into(),
            Property::UShort(x) => x.into(),
            Property::Int(x) => x.into(),
            Property::UInt(x) => x.into(),
            Property::Float(x) => x.into(),
            Property::Double(x) => x,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// A face's vertex indices, as written: negative ones are refused later, with their face.
struct Polygon(Vec<i64>);

impl PropertyAccess for Polygon {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        fn wide<T: Into<i64>>(list: Vec<T>) -> Vec<i64> {
            list.into_iter().map(Into::into).collect()
        }
        if !INDEX_LISTS.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        self.0 = match property {
            Property::ListChar(list) => wide(list),
            Property::ListUChar(list) => wide(list),
            Property::ListShort(list) => wide(list),
            Property::ListUShort(list) => wide(list),
            Property::ListInt(list) => wide(list),
            Property::ListUInt(list) => wide(list),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// An element that a mesh has no use for.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
