"""Constants that only running code reads: where they are computed as late as that, their mutants
can sleep too.

`const X: T = e;` becomes `static X: Late<T> = Late::new(|| e);`, and `X` becomes `(*X)` where it is
read; a `const fn` of theirs becomes a plain one. What the compiler must know, such as an array's
length or a pattern, keeps all constants that it is made of.
"""

import collections
import functools
import re

import plant

# Here the compiler needs a value, whatever may be around it.
KNOWN = plant.CONSTANT - {"const_item", "static_item"} | {"const_block", "attribute_item"}
NAME = re.compile(rb"[A-Z][A-Z0-9_]*$")


def is_const_fn(node):
    modifiers = next((child for child in node.children if child.type == "function_modifiers"), None)
    return node.type == "function_item" and modifiers is not None and b"const" in modifiers.text


def name_of(node):
    return node.child_by_field_name("name").text


def walk(node):
    yield node
    for child in node.children:
        yield from walk(child)


def is_of_a_type(node):
    around = node.parent.parent
    return around is not None and around.type in ("impl_item", "trait_item")


def enclosing(node):
    """What reads a name here: the constant or `const fn` that it is part of, `running` code, or the
    compiler: none."""
    start = node.start_byte
    while node := node.parent:
        length = node.child_by_field_name("length") if node.type == "array_expression" else None
        guard = node.child_by_field_name("condition") if node.type == "match_pattern" else None
        if guard is not None and guard.start_byte <= start:
            continue
        if node.type in KNOWN or (length is not None and length.start_byte <= start):
            return None
        if node.type in ("const_item", "static_item"):
            return None if name_of(node) == b"_" or is_of_a_type(node) else node
        if node.type == "function_item":
            return node if is_const_fn(node) else "running"
    return "running"


def path_of(node):
    """The tokens of a path up to this name, the first of them first."""
    if node.parent.type == "scoped_identifier" and node.parent.child_by_field_name("name") == node:
        return [token for token in walk(node.parent) if not token.children]
    tokens, before = [node], node.prev_sibling
    while node.parent.type == "token_tree" and before is not None and before.type == "::":
        tokens[:0], before = [before.prev_sibling, before], before.prev_sibling.prev_sibling
    return tokens


def is_called(node):
    parent = node.parent
    if parent.type == "token_tree":
        return node.next_sibling is not None and node.next_sibling.type == "token_tree"
    if parent.type in ("scoped_identifier", "field_expression", "generic_function"):
        node, parent = parent, parent.parent
    return parent.type == "call_expression" and parent.child_by_field_name("function") == node


def is_parameter(node):
    """Whether this is a constant that a function, or what it is of, is given."""
    name = node.text
    while node := node.parent:
        given = node.child_by_field_name("type_parameters")
        if given is not None and any(one.type == "const_parameter" and name_of(one) == name for one in given.children):
            return True
    return False


def is_named(node):
    """Whether this is where a constant gets its name, or where it is imported; or a name of
    something else: a field, a variant."""
    before, behind = node.prev_sibling, node.next_sibling
    if node.type == "field_identifier" or (node.parent.type == "token_tree" and (
            before.type == "." or (behind is not None and behind.type == "="))):
        return True
    if node.parent.type in ("const_item", "static_item", "const_parameter"):
        return node.parent.child_by_field_name("name") == node
    while node := node.parent:
        if node.type == "use_declaration":
            return True
        if node.type.endswith(("_item", "_expression")):
            return False
    return False


class Names:
    """All Rust files' constants by name: where each is defined, and who reads it."""

    def __init__(self, files):
        self.roots = {name: plant.parsed(text) for name, text in files.items() if re.match(r"(src|tests)/.*\.rs$", name)}
        self.defined, self.functions = collections.defaultdict(dict), collections.defaultdict(list)
        for file, root in self.roots.items():
            for node in walk(root):
                if node.type in ("const_item", "static_item") and NAME.match(name_of(node)) and not is_of_a_type(node):
                    self.defined[name_of(node)][file] = node
                elif is_const_fn(node):
                    self.functions[name_of(node)].append(node)
        # By definition: the reader of each place, and the place.
        self.reads = collections.defaultdict(list)
        self.calls = collections.defaultdict(list)
        for file, root in self.roots.items():
            for node in walk(root):
                if node.type in ("identifier", "type_identifier", "field_identifier"):
                    self.note(file, node)

    def note(self, file, node):
        if node.text in self.functions and is_called(node):
            self.calls[node.text].append(enclosing(node))
        if node.text not in self.defined or is_named(node):
            return
        meant = self.meant(file, node)
        known = len(meant) > 1 or node.type == "type_identifier"
        for definition in meant:
            self.reads[definition].append((file, node, None if known else enclosing(node)))

    def meant(self, file, node):
        """The constants that this name may be."""
        path, all_of_name = [token.text.decode() for token in path_of(node)][:-1], self.defined[node.text]
        if any(part[0].isupper() for part in path) or is_parameter(node):
            return []  # of a type or a function
        if file in all_of_name and not path:
            return [(file, node.text)]
        if not path and not re.search(rb"\buse [^;]*(\b" + node.text + rb"\b|::\*)[^;]*;", self.roots[file].text):
            return []  # another thing of that name
        return [(other, node.text) for other in all_of_name if other.startswith("src/")]


def late(files, mutants):
    """What can be computed as late as this, of all that some of these mutants are in: by file, the
    names of its constants and of every `const fn`; and where in it such constants are read, from
    and to."""
    names = Names(files)

    @functools.cache
    def needs(key):
        """Which definitions must be late if this one is; none if it can't."""
        file, name = key[:2]
        if key[2:]:
            readers, ambiguous = names.calls[name], len(names.functions[name]) > 1
        else:
            readers, ambiguous = [reader for _, _, reader in names.reads[key]], False
        if ambiguous or None in readers:
            return None
        return {definition(reader) for reader in readers if reader != "running"}

    own = {node.id: (file, name) for name, by_file in names.defined.items() for file, node in by_file.items()}
    own |= {node.id: (None, name, "fn") for name, nodes in names.functions.items() for node in nodes}

    def definition(node):
        return own.get(node.id, ("?", b"?"))

    def closure(key):
        found, todo = {key}, [key]
        while todo:
            more = needs(todo.pop())
            if more is None or ("?", b"?") in more:
                return None
            todo += more - found
            found |= more
        return found

    wanted = set()
    for mutant in mutants:
        root = names.roots[mutant["file"]]
        at = plant.offset(files[mutant["file"]], mutant["span"]["start"])
        node = enclosing(root.descendant_for_byte_range(at, at + 1))
        if node is not None and node != "running":
            wanted.add(definition(node))
    chosen = set().union(*(closure(key) or set() for key in wanted))
    functions = {name.decode() for _, name, *is_function in chosen if is_function}
    own = {file: functions | {name.decode() for other, name, *_ in chosen if other == file} for file in names.roots}
    reads = collections.defaultdict(set)
    for file, node, _ in (read for key in chosen for read in names.reads[key]):
        reads[file].add((path_of(node)[0].start_byte, node.end_byte))
    return own, reads
