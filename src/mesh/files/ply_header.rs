//! The header of a PLY file: elements, their properties, and how each is used.

use super::text::{self, LineProblem, LineWarning, Token, excerpt};
use crate::mesh::Problem;

/// A number type.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
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
            // Not in the format's description, but some programs write them.
            "int64" | "long" => Self::I64,
            "uint64" | "ulong" => Self::U64,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The number that the first bytes of `word` encode, least significant first.
    pub fn number(self, word: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = word;
        match self {
            Self::I8 => i8::from_le_bytes([a]).into(),
            Self::U8 => a.into(),
            Self::I16 => i16::from_le_bytes([a, b]).into(),
            Self::U16 => u16::from_le_bytes([a, b]).into(),
            Self::I32 => i32::from_le_bytes([a, b, c, d]).into(),
            Self::U32 => u32::from_le_bytes([a, b, c, d]).into(),
            // Beyond 2⁵³ these round, and no index or count is so large.
            Self::I64 => i64::from_le_bytes(word) as f64,
            Self::U64 => u64::from_le_bytes(word) as f64,
            Self::F32 => f32::from_le_bytes([a, b, c, d]).into(),
            Self::F64 => f64::from_le_bytes(word),
        }
    }
}

/// How a property is used.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum PropertyUse {
    /// A vertex's coordinate along this axis.
    Coordinate(usize),
    /// A face's corners.
    Polygon,
    /// Corners of triangle strips, separated by −1.
    Strips,
    Nothing,
}

/// A property of an element.
pub(super) struct Property {
    /// The type of a list's length.
    pub length: Option<Scalar>,
    /// The type of the value, or of a list's items.
    pub scalar: Scalar,
    pub used_as: PropertyUse,
}

/// A kind of element, and how many there are.
pub(super) struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
}

/// How values are encoded.
#[derive(Clone, Copy)]
pub(super) enum Encoding {
    Text,
    Binary { big_endian: bool },
}

/// A PLY header: what the file has, in order.
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// Number of bytes up to the end of the line `end_header`.
    pub size: usize,
    /// Number of lines up to there.
    pub lines: usize,
}

impl Header {
    pub fn read(bytes: &[u8]) -> Result<Self, LineProblem> {
        let mut encoding = None;
        let mut header = Self { encoding: Encoding::Text, elements: Vec::new(), size: 0, lines: 0 };
        while let Some(line) = header.next_line(bytes) {
            let line = text::decode(line);
            let words: Vec<Token> = text::words((header.lines, &line)).collect();
            let lower: Vec<String> = words.iter().map(|w| w.text.to_ascii_lowercase()).collect();
            let lower: Vec<&str> = lower.iter().map(String::as_str).collect();
            let fits = match lower[..] {
                ["ply"] => header.lines == 1,
                _ if header.lines == 1 => false,
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
                ["format" | "element", ..] => false,
                [] | ["comment" | "obj_info", ..] => true,
                _ => header.elements.is_empty(), // a comment without the word
            };
            if !fits {
                let message = format!("this does not fit a PLY header: {}", excerpt(line.trim()));
                return Err((Some(header.lines), malformed(message)));
            }
        }
        Err((Some(header.lines), malformed("the file ends in a PLY header".to_owned())))
    }

    /// A warning about types that the format doesn't have.
    pub fn warning(&self) -> Option<LineWarning> {
        let mut properties = self.elements.iter().flat_map(|element| &element.properties);
        let wide = |scalar| matches!(scalar, Scalar::I64 | Scalar::U64);
        let found = properties.any(|p| wide(p.scalar) || p.length.is_some_and(wide));
        found
            .then(|| (None, "the header has 64-bit integers, which PLY does not define".to_owned()))
    }

    /// The next line. Lines end with LF (a CR before it is white space), or all of them with CR.
    fn next_line<'a>(&mut self, bytes: &'a [u8]) -> Option<&'a [u8]> {
        let rest = &bytes[self.size..];
        if rest.is_empty() {
            return None;
        }
        let first_end = bytes.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        let end = match first_end.map(|end| &bytes[end..]) {
            Some([b'\r', after @ ..]) if after.first() != Some(&b'\n') => b'\r',
            _ => b'\n',
        };
        let length = rest.iter().position(|&byte| byte == end);
        let length = length.unwrap_or(rest.len());
        self.size += (length + 1).min(rest.len());
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
            ("vertex", Some(axis)) if length.is_none() => PropertyUse::Coordinate(axis),
            ("face", _) if is_indices => PropertyUse::Polygon,
            ("tristrips", _) if is_indices => PropertyUse::Strips,
            _ => PropertyUse::Nothing,
        };
        element.properties.push(Property { length, scalar: Scalar::named(scalar)?, used_as });
        Some(())
    }

    /// A mesh needs vertices with x, y, z and faces or strips with a list of indices.
    fn checked(self) -> Result<Self, LineProblem> {
        let has = |used_as: PropertyUse| {
            let mut properties = self.elements.iter().flat_map(|element| &element.properties);
            properties.any(|property| property.used_as == used_as)
        };
        let missing = if !(0..3).all(|axis| has(PropertyUse::Coordinate(axis))) {
            "an element vertex with the properties x, y and z"
        } else if !has(PropertyUse::Polygon) && !has(PropertyUse::Strips) {
            "an element face with a list property vertex_indices"
        } else {
            return Ok(self);
        };
        let message = format!("the header lacks {missing}");
        let help = "export the mesh as vertices and faces";
        Err((None, Problem::malformed(message, help)))
    }
}

pub(super) fn malformed(message: String) -> Problem {
    let help = "the header's element and property lines must match the data that follows";
    Problem::malformed(message, help)
}
