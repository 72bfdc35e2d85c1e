//! PLY, text and binary: vertices, and faces as polygons or as strips.
//!
//! The header names elements and their properties; all are passed over but the vertices' x, y, z and the lists of indices.
//! Values that are passed over are not read as numbers: a NaN, or a word, in a property that nobody uses is no error.
//! Polygons become fans; faces of one or two vertices become degenerate triangles; strips are unrolled.

use super::parts::Parts;
use super::text::{self, Fault, Token, excerpt};
use crate::mesh::{Problem, check_triangle, check_vertex};

/// Reads a PLY file.
pub(super) fn read(bytes: &[u8]) -> Result<Parts, Fault> {
    if bytes.is_empty() {
        return Err((None, Problem::NoVertices));
    }
    let header = Header::read(bytes)?;
    let text;
    let mut body = match header.encoding {
        Encoding::Text => {
            text = text::decode(&bytes[header.size..]);
            let first = header.lines;
            let later = move |(line, text): (usize, _)| (line + first, text);
            Body::Text(Box::new(
                text::lines(&text).map(later).flat_map(text::words),
            ))
        }
        Encoding::Binary { big_endian } => Body::Binary {
            rest: &bytes[header.size..],
            big_endian,
        },
    };
    let mut mesh = Mesh::default();
    for element in &header.elements {
        mesh.add(element, &mut body)?;
    }
    body.check_end()?;
    mesh.into_parts()
}

/// A type of numbers.
#[derive(Clone, Copy, PartialEq)]
enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name.to_ascii_lowercase().as_str() {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number that the first bytes of `word`, least significant first, stand for.
    fn number(self, word: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = word;
        match self {
            Self::I8 => i8::from_le_bytes([a]).into(),
            Self::U8 => a.into(),
            Self::I16 => i16::from_le_bytes([a, b]).into(),
            Self::U16 => u16::from_le_bytes([a, b]).into(),
            Self::I32 => i32::from_le_bytes([a, b, c, d]).into(),
            Self::U32 => u32::from_le_bytes([a, b, c, d]).into(),
            Self::F32 => f32::from_le_bytes([a, b, c, d]).into(),
            Self::F64 => f64::from_le_bytes(word),
        }
    }
}

/// What becomes of a property.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    /// A vertex' coordinate of this axis.
    Coordinate(usize),
    /// A face's corners.
    Polygon,
    /// Corners of strips, between which −1 stands.
    Strips,
    Nothing,
}

struct Property {
    /// The type of a list's length.
    length: Option<Scalar>,
    scalar: Scalar,
    used_as: Use,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

#[derive(Clone, Copy)]
enum Encoding {
    Text,
    Binary { big_endian: bool },
}

struct Header {
    encoding: Encoding,
    elements: Vec<Element>,
    /// Bytes and lines up to the end of the line `end_header`.
    size: usize,
    lines: usize,
}

impl Header {
    fn read(bytes: &[u8]) -> Result<Self, Fault> {
        let mut encoding = None;
        let mut header = Self {
            encoding: Encoding::Text,
            elements: Vec::new(),
            size: 0,
            lines: 0,
        };
        while let Some(line) = header.next_line(bytes) {
            let line = text::decode(line);
            let words: Vec<Token> = text::words((header.lines, &line)).collect();
            let lower: Vec<String> = words.iter().map(|w| w.text.to_ascii_lowercase()).collect();
            let lower: Vec<&str> = lower.iter().map(String::as_str).collect();
            let fits = match lower[..] {
                ["ply"] => header.lines == 1,
                _ if header.lines == 1 => false,
                [] | ["comment" | "obj_info", ..] => true,
                ["format", name, ..] => {
                    encoding = match name {
                        "ascii" => Some(Encoding::Text),
                        "binary_little_endian" => Some(Encoding::Binary { big_endian: false }),
                        "binary_big_endian" => Some(Encoding::Binary { big_endian: true }),
                        _ => None,
                    };
                    encoding.is_some()
                }
                ["element", name, count] => header.add_element(name, count).is_some(),
                ["property", ref words @ ..] => header.add_property(words).is_some(),
                ["end_header"] => {
                    let no_format = || (None, malformed("the header names no format".to_owned()));
                    header.encoding = encoding.ok_or_else(no_format)?;
                    return header.checked();
                }
                _ => false,
            };
            if !fits {
                let message = format!("this does not fit a PLY header: {}", excerpt(line.trim()));
                return Err((Some(header.lines), malformed(message)));
            }
        }
        Err((
            Some(header.lines),
            malformed("the file ends in a PLY header".to_owned()),
        ))
    }

    /// The next line, up to LF, CR LF or CR. Numbers may follow the last one, so an LF after a CR belongs to the end only in
    /// a file whose first line ends so.
    fn next_line<'a>(&mut self, bytes: &'a [u8]) -> Option<&'a [u8]> {
        let rest = &bytes[self.size..];
        if rest.is_empty() {
            return None;
        }
        let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
        let first_end = bytes.iter().position(is_end);
        let windows = first_end.is_some_and(|end| bytes[end..].starts_with(b"\r\n"));
        let length = rest.iter().position(is_end).unwrap_or(rest.len());
        let end = if windows && rest[length..].starts_with(b"\r\n") {
            2
        } else {
            1
        };
        self.size += (length + end).min(rest.len());
        self.lines += 1;
        Some(&rest[..length])
    }

    fn add_element(&mut self, name: &str, count: &str) -> Option<()> {
        self.elements.push(Element {
            name: name.to_owned(),
            count: count.parse().ok()?,
            properties: Vec::new(),
        });
        Some(())
    }

    fn add_property(&mut self, words: &[&str]) -> Option<()> {
        let element = self.elements.last_mut()?;
        let (length, scalar, name) = match *words {
            ["list", length, scalar, name] => (Some(Scalar::named(length)?), scalar, name),
            [scalar, name] => (None, scalar, name),
            _ => return None,
        };
        let axis = ["x", "y", "z"].iter().position(|axis| *axis == name);
        let is_indices = length.is_some() && ["vertex_indices", "vertex_index"].contains(&name);
        let used_as = match (element.name.as_str(), axis) {
            ("vertex", Some(axis)) if length.is_none() => Use::Coordinate(axis),
            ("face", _) if is_indices => Use::Polygon,
            ("tristrips", _) if is_indices => Use::Strips,
            _ => Use::Nothing,
        };
        element.properties.push(Property {
            length,
            scalar: Scalar::named(scalar)?,
            used_as,
        });
        Some(())
    }

    /// A mesh needs vertices with x, y, z and faces or strips with a list of indices.
    fn checked(self) -> Result<Self, Fault> {
        let has = |used_as: Use| {
            let mut properties = self.elements.iter().flat_map(|element| &element.properties);
            properties.any(|property| property.used_as == used_as)
        };
        let missing = if !(0..3).all(|axis| has(Use::Coordinate(axis))) {
            "an element vertex with the properties x, y and z"
        } else if !has(Use::Polygon) && !has(Use::Strips) {
            "an element face with a list property vertex_indices"
        } else {
            return Ok(self);
        };
        let message = format!("the header lacks {missing}");
        let help = "export the mesh as vertices and faces";
        Err((None, Problem::malformed(message, help)))
    }
}

fn malformed(message: String) -> Problem {
    let help = "the header's element and property lines must match the data that follows";
    Problem::malformed(message, help)
}

/// What is left of the data.
enum Body<'a> {
    Text(Box<dyn Iterator<Item = Token<'a>> + 'a>),
    Binary { rest: &'a [u8], big_endian: bool },
}

/// A value of the data and its line, if it has one.
struct Value {
    number: f64,
    line: Option<usize>,
}

impl Body<'_> {
    /// The next value, which is not looked at unless it is used; `None` at the end of the file.
    fn next(&mut self, scalar: Scalar, used: bool) -> Option<Result<Value, Fault>> {
        match self {
            Self::Text(tokens) => {
                let token = tokens.next()?;
                let line = Some(token.line);
                if !used {
                    return Some(Ok(Value { number: 0.0, line }));
                }
                let number = match scalar {
                    Scalar::F32 | Scalar::F64 => token.number("a value"),
                    // Every type of whole numbers is exact in f64, and what is larger is no index.
                    _ => token.integer("a value").map(|whole| whole as f64),
                };
                Some(number.map(|number| Value { number, line }))
            }
            Self::Binary { rest, big_endian } => {
                let (bytes, after) = rest.split_at_checked(scalar.size())?;
                *rest = after;
                let mut word = [0; 8];
                word[..bytes.len()].copy_from_slice(bytes);
                if *big_endian {
                    word[..bytes.len()].reverse();
                }
                let number = scalar.number(word);
                Some(Ok(Value { number, line: None }))
            }
        }
    }

    /// The next value; `line` becomes that of an element's first one.
    fn take(
        &mut self,
        scalar: Scalar,
        used: bool,
        line: &mut Option<usize>,
        what: impl Fn() -> String,
    ) -> Result<f64, Fault> {
        let value = self.next(scalar, used).ok_or_else(|| {
            let message = format!("the file ends in {}", what());
            (*line, malformed(message))
        })??;
        *line = line.or(value.line);
        Ok(value.number)
    }

    fn check_end(&mut self) -> Result<(), Fault> {
        let (line, count, what) = match self {
            Self::Text(tokens) => {
                let first = tokens.next();
                let count = usize::from(first.is_some()) + tokens.count();
                (first.map(|token| token.line), count, "numbers")
            }
            Self::Binary { rest, .. } => (None, rest.len(), "bytes"),
        };
        if count == 0 {
            return Ok(());
        }
        let message = format!("{count} {what} too many after the last element");
        Err((line, malformed(message)))
    }
}

/// What was read of the mesh.
#[derive(Default)]
struct Mesh {
    points: Vec<[f64; 3]>,
    triangles: Vec<[i64; 3]>,
    /// The line of each triangle, in a text file.
    lines: Vec<Option<usize>>,
}

impl Mesh {
    /// Reads all elements of a kind.
    fn add(&mut self, element: &Element, body: &mut Body) -> Result<(), Fault> {
        if element.properties.is_empty() {
            return Ok(()); // takes no bytes, however many the header declares
        }
        for index in 0..element.count {
            let what = || format!("{} {index} of {}", element.name, element.count);
            let mut position = [0.0; 3];
            let mut line = None;
            for property in &element.properties {
                let used = property.used_as != Use::Nothing;
                let Some(length) = property.length else {
                    let number = body.take(property.scalar, used, &mut line, &what)?;
                    if let Use::Coordinate(axis) = property.used_as {
                        position[axis] = number;
                    }
                    continue;
                };
                let length = body.take(length, true, &mut line, &what)?;
                let mut list = Vec::new();
                for _ in 0..length as u64 {
                    let number = body.take(property.scalar, used, &mut line, &what)?;
                    if used {
                        list.push(whole(number).ok_or_else(|| {
                            let message = format!("{} has the index {number}", what());
                            (line, malformed(message))
                        })?);
                    }
                }
                self.add_corners(property.used_as, &list, line, &what)?;
            }
            if element.name == "vertex" {
                check_vertex(index, position).map_err(|problem| (line, problem))?;
                self.points.push(position);
            }
        }
        Ok(())
    }

    fn add_corners(
        &mut self,
        used_as: Use,
        corners: &[i64],
        line: Option<usize>,
        what: impl Fn() -> String,
    ) -> Result<(), Fault> {
        match used_as {
            Use::Polygon if corners.is_empty() => {
                let message = format!("{} has no vertices", what());
                return Err((line, Problem::malformed(message, "remove it")));
            }
            Use::Polygon => self.triangles.extend(text::fan(corners)),
            Use::Strips => {
                for strip in corners.split(|&corner| corner == -1) {
                    // Every second triangle of a strip has its first two corners exchanged.
                    let turned = |(i, corners): (usize, &[i64])| match (i % 2, corners) {
                        (1, &[a, b, c]) => [b, a, c],
                        (_, corners) => [corners[0], corners[1], corners[2]],
                    };
                    self.triangles
                        .extend(strip.windows(3).enumerate().map(turned));
                }
            }
            Use::Coordinate(_) | Use::Nothing => {}
        }
        self.lines.resize(self.triangles.len(), line);
        Ok(())
    }

    fn into_parts(self) -> Result<Parts, Fault> {
        if self.points.is_empty() {
            return Err((None, Problem::NoVertices));
        }
        for (index, (triangle, line)) in self.triangles.iter().zip(&self.lines).enumerate() {
            check_triangle(index, *triangle, 0, self.points.len())
                .map_err(|problem| (*line, problem))?;
        }
        let triangles = self.triangles.iter().map(|t| t.map(|index| index as u32));
        Ok(Parts::indexed(self.points, triangles.collect()))
    }
}

/// A number as an index, if it is a whole one.
fn whole(number: f64) -> Option<i64> {
    (number == number.trunc() && number.abs() < 2_f64.powi(53)).then_some(number as i64)
}
