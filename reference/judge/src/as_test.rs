//! A counter-example as a unit test for the suite of the culler that misses the pair. The test
//! calls one function that the user supplies, `your_culler`, and needs nothing else.

use std::fmt::Write as _;

use super::case::Frame;
use super::claim::Claim;
use super::contestant::{BodyPart, Filter};
use super::shrink::SmallestCase;
use sdop::choice::choices;
use sdop::volume::Shape;

choices! {
    /// The language of a unit test.
    Language, "language", {
        /// A function with `#[test]`.
        Rust = "rust",
        /// A function that asserts.
        Cpp = "cpp",
        /// A function for pytest.
        Python = "python",
    }
}

impl Language {
    /// The ending of its files.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Rust => "rs",
            Self::Cpp => "cpp",
            Self::Python => "py",
        }
    }
}

/// Numbers in nested lists; every list of one depth holds items of one kind.
enum ArgumentData {
    Float(f32),
    Double(f64),
    Integer(i64),
    Truth(bool),
    List(Vec<ArgumentData>),
    /// Numbers of a fixed count, such as a box.
    Row(Vec<f32>),
}

/// One argument of the culler.
struct Argument {
    name: &'static str,
    meaning: &'static str,
    /// The type in Rust and in C++.
    types: [&'static str; 2],
    data: ArgumentData,
}

/// The test.
#[must_use]
pub fn unit_test(smallest: &SmallestCase, language: Language) -> String {
    let arguments = arguments(smallest);
    let names: Vec<&str> = arguments.iter().map(|argument| argument.name).collect();
    let call = names.join(", ");
    let [i, j] = smallest.miss.pair;
    let comment = |mark: &str| {
        let mut text = format!(
            "{mark} The smallest scene of {} in which the pair [{i}, {j}] was missed (claim {}).\n",
            smallest.from, smallest.case.claim
        );
        for line in smallest.reasons() {
            let _ = writeln!(text, "{mark} {line}");
        }
        let _ = writeln!(
            text,
            "{mark} `your_culler` culls the frames in turn and returns the pairs [i, j], i < j, of the last one."
        );
        text
    };
    let name = format!("reports_{i}_{j}_of_{}", identifier(&smallest.from));
    let declared: String = arguments.iter().map(|argument| argument.declared(language)).collect();
    match language {
        Language::Rust => format!(
            "{}#[test]\nfn {name}() {{\n{declared}    let pairs = your_culler({});\n    assert!(pairs.contains(&[{i}, {j}]), \"{{pairs:?}}\");\n}}\n",
            comment("///"),
            names.iter().map(|name| format!("&{name}")).collect::<Vec<_>>().join(", ")
        ),
        Language::Cpp => format!(
            "#undef NDEBUG\n#include <algorithm>\n#include <array>\n#include <cassert>\n#include <vector>\n\n{}void {name}() {{\n{declared}    \
             const std::vector<std::array<unsigned, 2>> pairs = your_culler({call});\n    \
             assert((std::find(pairs.begin(), pairs.end(), std::array<unsigned, 2>{{{i}, {j}}}) != pairs.end()));\n}}\n",
            comment("//")
        ),
        Language::Python => format!(
            "{}def test_{name}():\n{declared}    pairs = your_culler({call})\n    assert [{i}, {j}] in [list(pair) for pair in pairs], pairs\n",
            comment("#")
        ),
    }
}

/// A case's name as a part of a function's.
fn identifier(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    name.chars().map(plain).collect()
}

/// What the culler needs for the claim.
fn arguments(smallest: &SmallestCase) -> Vec<Argument> {
    let frames = &smallest.case.frames[..=smallest.miss.frame];
    let mut arguments = Vec::new();
    let by_body = |of: &dyn Fn(&Frame, usize) -> ArgumentData| {
        let frame = |frame: &Frame| (0..frame.bodies.len()).map(|i| of(frame, i)).collect();
        ArgumentData::List(frames.iter().map(|f| ArgumentData::List(frame(f))).collect())
    };
    if smallest.case.claim.is_of_boxes() {
        arguments.push(Argument {
            name: "boxes",
            meaning: "of each frame and body: lower corner x, y, z, then the upper one",
            types: ["Vec<Vec<[f32; 6]>>", "std::vector<std::vector<std::array<float, 6>>>"],
            data: by_body(&|frame, i| ArgumentData::Row(frame.boxes[i].to_vec())),
        });
    } else {
        arguments.extend(of_shapes(smallest.case.claim, &smallest.case.shapes));
        arguments.push(Argument {
            name: "shape",
            meaning: "of each frame and body: the number of its shape",
            types: ["Vec<Vec<usize>>", "std::vector<std::vector<std::size_t>>"],
            data: by_body(&|frame, i| ArgumentData::Integer(frame.bodies.shape[i].into())),
        });
        arguments.push(Argument {
            name: "poses",
            meaning: "of each frame and body: quaternion x, y, z, w of any norm, then the translation",
            types: [
                "Vec<Vec<[f32; 7]>>",
                "std::vector<std::vector<std::array<float, 7>>>",
            ],
            data: by_body(&|frame, i| {
                let (q, t) = (frame.bodies.rotation[i], frame.bodies.translation[i]);
                ArgumentData::Row([&q[..], &t].concat())
            }),
        });
        if frames.iter().any(|frame| frame.parts.is_some()) {
            let of_parts = |of: &dyn Fn(&BodyPart) -> ArgumentData| {
                by_body(&|frame, i| {
                    let parts = frame.parts.as_ref().map_or(&[][..], |parts| &parts[i]);
                    ArgumentData::List(parts.iter().map(of).collect())
                })
            };
            arguments.push(Argument {
                name: "part_shapes",
                meaning: "of each frame and body: the shapes of its parts; none if it is its shape alone",
                types: [
                    "Vec<Vec<Vec<usize>>>",
                    "std::vector<std::vector<std::vector<std::size_t>>>",
                ],
                data: of_parts(&|part| integer(part.shape)),
            });
            arguments.push(Argument {
                name: "part_poses",
                meaning: "of each frame and body: the poses of its parts in the frame of the body",
                types: [
                    "Vec<Vec<Vec<[f32; 7]>>>",
                    "std::vector<std::vector<std::vector<std::array<float, 7>>>>",
                ],
                data: of_parts(&|part| ArgumentData::Row(part.pose.to_vec())),
            });
        }
    }
    arguments.push(Argument {
        name: "is_static",
        meaning: "of each frame and body: two static bodies are no pair",
        types: ["Vec<Vec<bool>>", "std::vector<std::vector<bool>>"],
        data: by_body(&|frame, i| ArgumentData::Truth(!frame.bodies.dynamic[i])),
    });
    if frames.iter().any(|frame| frame.was.is_some()) {
        let former = |frame: &Frame, i: usize| match &frame.was {
            Some(was) => was[i].map_or(-1, i64::from),
            None => i as i64, // a few bodies
        };
        arguments.push(Argument {
            name: "was",
            meaning: "of each frame and body: its number in the frame before, -1 for a new body",
            types: ["Vec<Vec<i64>>", "std::vector<std::vector<long>>"],
            data: by_body(&|frame, i| ArgumentData::Integer(former(frame, i))),
        });
    }
    arguments.extend(asked_on_top(frames));
    arguments
}

/// Filters, margins, periods and states, where a frame has them.
fn asked_on_top(frames: &[Frame]) -> Vec<Argument> {
    let list =
        |of: &dyn Fn(&Frame) -> ArgumentData| ArgumentData::List(frames.iter().map(of).collect());
    let mut arguments = Vec::new();
    let of_filter = |of: &dyn Fn(&Filter) -> &Vec<[u32; 2]>| {
        let two = |&ends: &[u32; 2]| ArgumentData::List(ends.map(integer).into());
        list(&|frame| {
            let rows = frame.filter.iter().flat_map(of);
            ArgumentData::List(rows.map(two).collect())
        })
    };
    let rows_of_integers = ["Vec<Vec<Vec<i64>>>", "std::vector<std::vector<std::vector<long>>>"];
    if frames.iter().any(|frame| frame.filter.is_some()) {
        arguments.push(Argument {
            name: "groups",
            meaning: "of each frame and body: the groups that it is in and those that it meets, as bits",
            types: rows_of_integers,
            data: of_filter(&|filter| &filter.groups),
        });
        arguments.push(Argument {
            name: "excluded",
            meaning: "of each frame: pairs that are not asked for",
            types: rows_of_integers,
            data: of_filter(&|filter| &filter.excluded),
        });
    }
    if frames.iter().any(|frame| frame.margins.is_some()) {
        arguments.push(Argument {
            name: "margins",
            meaning: "of each frame and body: how far it reaches beyond its box",
            types: ["Vec<Vec<f32>>", "std::vector<std::vector<float>>"],
            data: list(&|frame| {
                let margins = frame.margins.iter().flatten();
                ArgumentData::List(margins.map(|&x| ArgumentData::Float(x)).collect())
            }),
        });
    }
    if frames.iter().any(|frame| frame.periods.is_some()) {
        arguments.push(Argument {
            name: "periods",
            meaning: "of each frame: the periods of x, y and z, 0 for an axis without one",
            types: ["Vec<Vec<f64>>", "std::vector<std::vector<double>>"],
            data: list(&|frame| {
                let periods = frame.periods.unwrap_or_default();
                let periods = periods.map(|period| ArgumentData::Double(period.unwrap_or(0.0)));
                ArgumentData::List(periods.into())
            }),
        });
    }
    if frames.iter().any(|frame| frame.restore) {
        arguments.push(Argument {
            name: "restore",
            meaning: "of each frame: whether the saved state is restored before it",
            types: ["Vec<bool>", "std::vector<bool>"],
            data: list(&|frame| ArgumentData::Truth(frame.restore)),
        });
        arguments.push(Argument {
            name: "save",
            meaning: "of each frame: whether the state is saved after it",
            types: ["Vec<bool>", "std::vector<bool>"],
            data: list(&|frame| ArgumentData::Truth(frame.save)),
        });
    }
    arguments
}

fn integer(number: u32) -> ArgumentData {
    ArgumentData::Integer(number.into())
}

/// What a posed claim is about.
fn of_shapes(claim: Claim, shapes: &[Shape]) -> Vec<Argument> {
    let list =
        |of: &dyn Fn(&Shape) -> ArgumentData| ArgumentData::List(shapes.iter().map(of).collect());
    let floats = |numbers: &[f32]| {
        ArgumentData::List(numbers.iter().map(|&x| ArgumentData::Float(x)).collect())
    };
    match claim {
        Claim::Sphere => vec![Argument {
            name: "balls",
            meaning: "of each shape, in the body frame: centre x, y, z and radius",
            types: ["Vec<[f32; 4]>", "std::vector<std::array<float, 4>>"],
            data: list(&|shape| {
                let [x, y, z] = shape.ball.centre;
                ArgumentData::Row(vec![x, y, z, shape.ball.radius])
            }),
        }],
        Claim::OrDop => vec![
            Argument {
                name: "basis",
                meaning: "of each shape: the or-DOP's three basis vectors, one after the other",
                types: ["Vec<[f32; 9]>", "std::vector<std::array<float, 9>>"],
                data: list(&|shape| {
                    let columns = shape.ordop.basis.columns;
                    ArgumentData::Row(columns.as_flattened().to_vec())
                }),
            },
            Argument {
                name: "lo",
                meaning: "of each shape: the lower ends of its slabs",
                types: ["Vec<Vec<f32>>", "std::vector<std::vector<float>>"],
                data: list(&|shape| floats(&shape.ordop.lo)),
            },
            Argument {
                name: "hi",
                meaning: "of each shape: the upper ends of its slabs",
                types: ["Vec<Vec<f32>>", "std::vector<std::vector<float>>"],
                data: list(&|shape| floats(&shape.ordop.hi)),
            },
        ],
        _ => {
            let corners = |shape: &Shape| {
                let triangle = |t: &[u32; 3]| {
                    ArgumentData::List(t.map(|v| ArgumentData::Integer(v.into())).into())
                };
                ArgumentData::List(shape.triangles.iter().map(triangle).collect())
            };
            vec![
                Argument {
                    name: "vertices",
                    meaning: "of each shape, in the body frame",
                    types: ["Vec<Vec<[f32; 3]>>", "std::vector<std::vector<std::array<float, 3>>>"],
                    data: list(&|shape| {
                        let vertex = |v: &[f32; 3]| ArgumentData::Row(v.to_vec());
                        ArgumentData::List(shape.vertices.iter().map(vertex).collect())
                    }),
                },
                Argument {
                    name: "triangles",
                    meaning: "of each shape: three vertices each",
                    types: [
                        "Vec<Vec<Vec<usize>>>",
                        "std::vector<std::vector<std::vector<std::size_t>>>",
                    ],
                    data: list(&corners),
                },
            ]
        }
    }
}

impl Argument {
    fn declared(&self, language: Language) -> String {
        let (name, meaning, data) = (self.name, self.meaning, self.data.text(language));
        match language {
            Language::Rust => {
                format!("    // {meaning}\n    let {name}: {} = {data};\n", self.types[0])
            }
            Language::Cpp => {
                format!("    // {meaning}\n    const {} {name}{data};\n", self.types[1])
            }
            Language::Python => format!("    # {meaning}\n    {name} = {data}\n"),
        }
    }
}

impl ArgumentData {
    fn text(&self, language: Language) -> String {
        let joined = |items: &[String], [open, close]: [&str; 2]| {
            format!("{open}{}{close}", items.join(", "))
        };
        let number = |x: f32| match language {
            Language::Rust => format!("{x:?}"),
            // Read as a double, it has to be the same number.
            Language::Python => format!("{:?}", f64::from(x)),
            Language::Cpp => format!("{x:?}f"),
        };
        match (self, language) {
            (Self::Float(x), _) => number(*x),
            (Self::Double(x), _) => format!("{x:?}"),
            (Self::Integer(n), _) => n.to_string(),
            (Self::Truth(true), Language::Python) => "True".to_owned(),
            (Self::Truth(false), Language::Python) => "False".to_owned(),
            (Self::Truth(truth), _) => truth.to_string(),
            (Self::List(items), _) => {
                let items: Vec<String> = items.iter().map(|item| item.text(language)).collect();
                let brackets = match language {
                    Language::Rust => ["vec![", "]"],
                    Language::Cpp => ["{", "}"],
                    Language::Python => ["[", "]"],
                };
                joined(&items, brackets)
            }
            (Self::Row(row), _) => {
                let items: Vec<String> = row.iter().map(|&x| number(x)).collect();
                let brackets = match language {
                    Language::Cpp => ["{{", "}}"],
                    Language::Rust | Language::Python => ["[", "]"],
                };
                joined(&items, brackets)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever the language reads, it is the f32 of the case.
    #[test]
    fn numbers_stay_the_same() {
        let row = ArgumentData::List(vec![ArgumentData::Row(vec![0.1, -0.0, 1e-45, 16_777_216.0])]);
        for (language, text) in [
            (Language::Rust, "vec![[0.1, -0.0, 1e-45, 16777216.0]]"),
            (Language::Cpp, "{{{0.1f, -0.0f, 1e-45f, 16777216.0f}}}"),
            (Language::Python, "[[0.10000000149011612, -0.0, 1.401298464324817e-45, 16777216.0]]"),
        ] {
            assert_eq!(row.text(language), text);
        }
    }
}
