"""Rewrites Rust sources so that cargo-mutants' mutants sleep in them, each to be woken by its
number.

`a + b` becomes `match (a, b) { (a, b) => match awake(7) { 7 => a - b, 8 => a * b, _ => a + b }
}`; a function's body starts with `if awake(9) == 9 { return 0; }`; a match arm gets the guard `if
awake(10) != 10`, and one that has a guard another; a field is that of its struct's base. Each
call of `awake` names its place by the first mutant there. On request, a process lists at its end
the places that it reached, and thereby the mutants that it could notice. Constants are evaluated
before the program runs, so they can't call `awake`. Those that only running code reads (see
constants.py) are computed when they are first read; each mutant of another constant needs a
separate build.
"""

import re

import tree_sitter
import tree_sitter_rust

# What a process writes to stderr on request when it ends, before the numbers.
SIGN = "its places:"
COMPARISONS = {"==", "!=", "<", ">", "<=", ">="}
CONSTANT = {"const_item", "static_item", "enum_variant", "array_type", "type_arguments", "const_parameter", "match_pattern",
            "range_pattern"}
# `const fn` that no constant calls: as plain functions their mutants can sleep.
CALLED_AT_RUN_TIME = {"members_of", "place_of", "inflate_radius", "reach", "up", "down", "widen", "collide"}

# Read before `main` and never written again, so that asking costs a load and the optimiser may ask
# once for many.
WAKER = f"""
use std::sync::atomic::{{AtomicBool, Ordering::Relaxed}};

static mut AWAKE: u32 = 0;
static mut TRACED: bool = false;
static PLACES: [AtomicBool; 1 << 14] = [const {{ AtomicBool::new(false) }}; 1 << 14];

#[used]
#[unsafe(link_section = ".init_array")]
static INIT: extern "C" fn() = init;

#[used]
#[unsafe(link_section = ".fini_array")]
static FINI: extern "C" fn() = fini;

unsafe extern "C" {{
    fn write(file: i32, bytes: *const u8, length: usize) -> isize;
}}

extern "C" fn init() {{
    let number = std::env::var("MUTANT").map_or(0, |n| n.parse().expect("MUTANT is a number"));
    unsafe {{ (AWAKE, TRACED) = (number, std::env::var_os("TRACED").is_some()) }};
}}

extern "C" fn fini() {{
    if unsafe {{ TRACED }} {{
        let numbers = (0..PLACES.len()).filter(|&n| PLACES[n].load(Relaxed));
        let text = numbers.fold("\\n{SIGN}".to_owned(), |text, n| text + " " + &n.to_string()) + "\\n";
        unsafe {{ write(2, text.as_ptr(), text.len()) }};
    }}
}}

/// What is computed when it is first read.
pub struct Late<T>(std::sync::LazyLock<T>);

impl<T> Late<T> {{
    pub const fn new(value: fn() -> T) -> Self {{
        Self(std::sync::LazyLock::new(value))
    }}
}}

impl<T> std::ops::Deref for Late<T> {{
    type Target = T;
    fn deref(&self) -> &T {{
        &self.0
    }}
}}

impl<T: std::fmt::Display> std::fmt::Display for Late<T> {{
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {{
        (**self).fmt(f)
    }}
}}

/// Either of two iterators.
pub enum One<A, B> {{
    Left(A),
    Right(B),
}}

impl<T, A: Iterator<Item = T>, B: Iterator<Item = T>> Iterator for One<A, B> {{
    type Item = T;
    fn next(&mut self) -> Option<T> {{
        match self {{
            Self::Left(a) => a.next(),
            Self::Right(b) => b.next(),
        }}
    }}
}}

#[inline(always)]
pub fn awake(place: u32) -> u32 {{
    unsafe {{
        if TRACED {{
            came_by(place);
        }}
        AWAKE
    }}
}}

#[cold]
#[inline(never)]
fn came_by(place: u32) {{
    PLACES[place as usize].store(true, Relaxed);
}}
"""


def offset(source, place):
    """Where cargo-mutants' line and column (in characters, from 1) are, in bytes."""
    lines = source.split(b"\n")
    before = sum(len(line) + 1 for line in lines[: place["line"] - 1])
    return before + len(lines[place["line"] - 1].decode()[: place["column"] - 1].encode())


def applied(source, mutant):
    """The source with this one mutant awake, as cargo-mutants would write it."""
    start, end = (offset(source, mutant["span"][at]) for at in ("start", "end"))
    return source[:start] + mutant["replacement"].encode() + source[end:]


def awake(mutants):
    """The call that asks which mutant is awake, at the place of these mutants."""
    return f"crate::mutant::awake({mutants[0]['n']})"


def parsed(source):
    return tree_sitter.Parser(tree_sitter.Language(tree_sitter_rust.language())).parse(source).root_node


class File:
    """One file with its mutants asleep; `text` is the result and `asleep` the numbers that are in
    it, each with that of its place. `late` are the names of its constants and `const fn` that are
    computed at run time, `reads` where such ones are read."""

    def __init__(self, source, mutants, late=(), reads=()):
        self.source, self.asleep, self.at, self.late = source, {}, {}, set(late)
        self.opens, self.closes = ({read[end]: mark for read in reads} for end, mark in enumerate(("(*", ")")))
        for mutant in mutants:
            place = offset(source, mutant["span"]["start"])
            self.at.setdefault((mutant["genre"], place), []).append(mutant)
        root = parsed(source)
        self.text = source[: root.start_byte].decode() + self.emit(root) + source[root.end_byte :].decode()
        for name in CALLED_AT_RUN_TIME.union(late):
            self.text = re.sub(rf"\bconst fn {name}\b", f"fn {name}", self.text)

    def take(self, genre, place, node):
        """The mutants at this place, unless it is part of a constant."""
        found = self.at.get((genre, place), [])
        if not found or is_constant(node, self.late):
            return []
        self.asleep.update((mutant["n"], found[0]["n"]) for mutant in found)
        return found

    def between(self, start, end):
        return self.source[start:end].decode()

    def plain(self, node, instead=lambda child: None):
        """A node's text with its children rewritten, or replaced where `instead` says so."""
        out, done = [], node.start_byte
        for child in node.children:
            out += [self.between(done, child.start_byte), instead(child) or self.emit(child)]
            done = child.end_byte
        return "".join(out) + self.between(done, node.end_byte)

    def emit(self, node):
        if not node.children:
            return self.opens.get(node.start_byte, "") + node.text.decode() + self.closes.get(node.end_byte, "")
        rewrite = getattr(self, node.type, None)
        return (rewrite and rewrite(node)) or self.plain(node)

    def const_item(self, node):
        name, kind, value = (node.child_by_field_name(field) for field in ("name", "type", "value"))
        if name.text.decode() not in self.late:
            return None
        visible = "".join(child.text.decode() for child in node.children if child.type == "visibility_modifier")
        late = "crate::mutant::Late"
        return f"{visible} static {name.text.decode()}: {late}<{self.emit(kind)}> = {late}::new(|| {self.emit(value)});"

    static_item = const_item

    def sides(self, node):
        return (self.emit(node.child_by_field_name(side)) for side in ("left", "right"))

    def binary_expression(self, node):
        operator = node.child_by_field_name("operator")
        mutants = self.take("BinaryOperator", operator.start_byte, node)
        if not mutants:
            return None
        old = operator.text.decode()
        left, right = self.sides(node)
        if old in ("&&", "||"):  # the right side may not be evaluated
            arms = "".join(f"{m['n']} => a__ {m['replacement']} ({right}), " for m in mutants)
            return f"({{ let a__ = {left}; match {awake(mutants)} {{ {arms} _ => a__ {old} ({right}) }} }})"
        arms = "".join(f"{m['n']} => a__ {m['replacement']} b__, " for m in mutants)
        borrow = "&" if old in COMPARISONS else ""
        return f"(match ({borrow}({left}), {borrow}({right})) {{ (a__, b__) => match {awake(mutants)} {{ {arms} _ => a__ {old} b__ }} }})"

    def compound_assignment_expr(self, node):
        operator = node.child_by_field_name("operator")
        mutants = self.take("BinaryOperator", operator.start_byte, node)
        if not mutants:
            return None
        left, right = self.sides(node)
        arms = "".join(f"{m['n']} => {{ {left} {m['replacement']} b__; }} " for m in mutants)
        return f"{{ let b__ = {right}; match {awake(mutants)} {{ {arms} _ => {{ {left} {operator.text.decode()} b__; }} }} }}"

    def unary_expression(self, node):
        mutants = self.take("UnaryOperator", node.start_byte, node)
        if not mutants:
            return None
        operator, value = node.children[0].text.decode(), self.emit(node.children[1])
        return f"({{ let v__ = {value}; if {awake(mutants)} == {mutants[0]['n']} {{ v__ }} else {{ {operator}v__ }} }})"

    def match_arm(self, node):
        pattern = node.child_by_field_name("pattern")
        if condition := pattern.child_by_field_name("condition"):
            return self.guarded_arm(node, pattern, condition)
        # An arm with a guard covers nothing for the compiler: another one must.
        others = (arm.child_by_field_name("pattern") for arm in node.parent.children if arm.type == "match_arm")
        mutants = self.take("MatchArm", node.start_byte, node) if any(other.text == b"_" for other in others) else []
        if not mutants:
            return None
        guard = f"{pattern.text.decode()} if {awake(mutants)} != {mutants[0]['n']}"
        return self.plain(node, lambda child: guard if child == pattern else None)

    def guarded_arm(self, node, pattern, condition):
        mutants = self.take("MatchArmGuard", condition.start_byte, node)
        if not mutants:
            return None
        arms = "".join(f"{m['n']} => {m['replacement']}, " for m in mutants)
        guard = f"match {awake(mutants)} {{ {arms} _ => {self.emit(condition)} }}"
        whole = self.between(pattern.start_byte, condition.start_byte) + guard
        return self.plain(node, lambda child: whole if child == pattern else None)

    def field_initializer(self, node):
        return self.field(node, node.child_by_field_name("field"), node.child_by_field_name("value"))

    def shorthand_field_initializer(self, node):
        return self.field(node, node.children[-1], node.children[-1])

    def field(self, node, name, value):
        mutants = self.take("StructField", node.start_byte, node)
        if not mutants:
            return None
        base = next(field for field in node.parent.children if field.type == "base_field_initializer").children[1]
        name, base, value = name.text.decode(), self.emit(base), self.emit(value)
        return f"{name}: if {awake(mutants)} == {mutants[0]['n']} {{ ({base}).{name} }} else {{ {value} }}"

    def function_item(self, node):
        body, result = node.child_by_field_name("body"), node.child_by_field_name("return_type")
        is_opaque = result is not None and b"impl " in result.text
        if body is None or (is_opaque and not result.text.startswith(b"impl Iterator<")):
            return None
        starts = [child.start_byte for child in body.children if child.type not in ("{", "}")] + [body.start_byte]
        start = next((start for start in starts if ("FnValue", start) in self.at), None)
        mutants = self.take("FnValue", start, body) if start is not None else []
        if not mutants:
            return None
        if is_opaque:  # one opaque type has one origin
            one = "crate::mutant::One::"
            head = "".join(f"if {awake(mutants)} == {m['n']} {{ {one}Left({m['replacement']}) }} else {{ {one}Right(" for m in mutants)
            return self.plain(node, lambda child: f"{{ {head}{self.plain(body)}{') }' * len(mutants)} }}" if child == body else None)
        head = "".join(f"if {awake(mutants)} == {m['n']} {{ return {m['replacement']}; }} " for m in mutants)
        return self.plain(node, lambda child: "{ " + head + self.plain(body)[1:] if child == body else None)


def is_constant(node, late):
    """Whether the compiler must know this node's value, though these constants and functions are
    computed late."""
    start = node.start_byte
    while node := node.parent:
        length = node.child_by_field_name("length") if node.type == "array_expression" else None
        guard = node.child_by_field_name("condition") if node.type == "match_pattern" else None
        if guard is not None and guard.start_byte <= start:
            continue
        if node.type in ("const_item", "static_item") and node.child_by_field_name("name").text.decode() in late:
            return False
        if node.type in CONSTANT or (length is not None and length.start_byte <= start):
            return True
        if node.type == "function_item":
            const = any(child.type == "function_modifiers" and b"const" in child.text for child in node.children)
            return const and node.child_by_field_name("name").text.decode() not in CALLED_AT_RUN_TIME.union(late)
    return False


# Where a planted text names a mutant.
NUMBER = r"(\d+) => (?=\{ |a__|true|false)|awake\(\d+\) [!=]= (\d+)"


def numbers(text):
    """The mutants that a planted text names."""
    return {int(next(filter(None, groups))) for groups in re.findall(NUMBER, text)}


def culprits(text, start, end):
    """The mutants that an error between these bytes of a rewritten file points at: the last one
    before it or in it, or, where it is a function's result that is wrong, the first one of its
    body."""
    before, own, behind = text[:start].decode()[-400:], text[start:end].decode(), text[end:].decode()[:400]
    found = re.findall(NUMBER, before)[-1:] or re.findall(NUMBER, own)[-1:] or re.findall(NUMBER, behind)[:1]
    return {int(next(filter(None, groups))) for groups in found}
