"""Slots, runs and capacities by an SMT solver, at the width of the code (seconds).

`.ci/proofs` runs it, with `pip install bitwuzla`. Each claim is integer arithmetic of the code, in
its order of operations, on words of 32 and 64 bits, and its control is the same with one number off
by one or one step left out. A claim is proved for all inputs at once; the solver must refute its
control.
"""

import sys
import time

from bitwuzla import Bitwuzla, Kind, Option, Options, Result, RoundingMode, TermManager

BLOCK_BODIES = 16
MOST_QUADS = 1 << 28  # src/simd/mod.rs
MOST_BODIES = MOST_QUADS - 16  # src/bodies/contract.rs
MOST_CELLS = 1 << 29  # src/broad_phase/grid/cells.rs
WRAPPED_SPAN = 3
LONGEST_WRITTEN, CODES_PER_STORE, RUNS_PER_PAGE = 16, 8, 160  # src/broad_phase/block.rs
CODES_PER_PAGE = RUNS_PER_PAGE * LONGEST_WRITTEN

TM = TermManager()
NEAREST = TM.mk_rm_value(RoundingMode.RNE)
F32, F64 = TM.mk_fp_sort(8, 24), TM.mk_fp_sort(11, 53)


class Word:
    """An unsigned word of 32 or 64 bits; operations wrap as they do in a release build."""

    def __init__(self, term, bits):
        self.term, self.bits = term, bits

    def other(self, value):
        return value.term if isinstance(value, Word) else number(value, self.bits).term

    def with_(self, kind, value):
        return Word(TM.mk_term(kind, [self.term, self.other(value)]), self.bits)

    def __add__(self, value):
        return self.with_(Kind.BV_ADD, value)

    def __sub__(self, value):
        return self.with_(Kind.BV_SUB, value)

    def __mul__(self, value):
        return self.with_(Kind.BV_MUL, value)

    def __and__(self, value):
        return self.with_(Kind.BV_AND, value)

    def __or__(self, value):
        return self.with_(Kind.BV_OR, value)

    def __lshift__(self, value):
        return self.with_(Kind.BV_SHL, value)

    def __rshift__(self, value):
        return self.with_(Kind.BV_SHR, value)

    def __lt__(self, value):
        return TM.mk_term(Kind.BV_ULT, [self.term, self.other(value)])

    def __le__(self, value):
        return TM.mk_term(Kind.BV_ULE, [self.term, self.other(value)])

    def __gt__(self, value):
        return TM.mk_term(Kind.BV_UGT, [self.term, self.other(value)])

    def equals(self, value):
        return TM.mk_term(Kind.EQUAL, [self.term, self.other(value)])

    def least(self, value):
        smaller = TM.mk_term(Kind.ITE, [self < value, self.term, self.other(value)])
        return Word(smaller, self.bits)

    def wide(self):
        return Word(TM.mk_term(Kind.BV_ZERO_EXTEND, [self.term], [64 - self.bits]), 64)

    def low(self):
        return Word(TM.mk_term(Kind.BV_EXTRACT, [self.term], [31, 0]), 32)


def number(value, bits):
    return Word(TM.mk_bv_value(TM.mk_bv_sort(bits), value), bits)


def word(name, bits=32):
    return Word(TM.mk_const(TM.mk_bv_sort(bits), name), bits)


def all_of(*terms):
    return terms[0] if len(terms) == 1 else TM.mk_term(Kind.AND, list(terms))


def any_of(*terms):
    return terms[0] if len(terms) == 1 else TM.mk_term(Kind.OR, list(terms))


def same(a, b):
    return TM.mk_term(Kind.EQUAL, [a, b])


def f64(value):
    return TM.mk_fp_value(F64, NEAREST, str(value))


def from_integer(value):
    return TM.mk_term(Kind.FP_TO_FP_FROM_UBV, [NEAREST, value.term], [11, 53])


def from_bits(value):
    form = [8, 24] if value.bits == 32 else [11, 53]
    return TM.mk_term(Kind.FP_TO_FP_FROM_BV, [value.term], form)


def added(a, b):
    return TM.mk_term(Kind.FP_ADD, [NEAREST, a, b])


def is_power_of_two(value):
    return all_of(value > 0, (value & (value - 1)).equals(0))


# Each claim returns what is given and what follows.


def number_of_cell(wrong):
    """cells.rs: TO_INTEGER, number. The low half of an f64's bits is the number of its cell."""
    cell, bits = word("cell"), word("bits", 64)
    to_integer = f64(3 * 2 ** (50 if wrong else 51))
    given = [cell <= (1 << 31) - 1, same(from_bits(bits), added(to_integer, from_integer(cell)))]
    return given, bits.low().equals(cell)


def clamped_cells(wrong):
    """cells.rs: Cells::around. Whatever f64 a cell is, NaN included, it ends up in the table."""
    bits, count, clamped = word("bits", 64), word("count"), word("clamped", 64)
    to_integer = f64(3 * 2**51)
    last = added(to_integer, from_integer(count - 1))
    cell = TM.mk_term(Kind.FP_MAX, [from_bits(bits), to_integer])
    if not wrong:
        cell = TM.mk_term(Kind.FP_MIN, [cell, last])
    given = [count > 0, count <= MOST_CELLS + 1, same(from_bits(clamped), cell)]
    return given, clamped.low() < count


def wrapped_table(wrong):
    """cells.rs: Cells::wrap. The length of a wrapped table and its mask fit in 32 bits."""
    bodies, table = word("bodies", 64), word("table", 64)
    needed = bodies << (5 if wrong else 2)
    power = all_of(is_power_of_two(table), needed <= table, any_of(table < needed + needed,
                                                                  table.equals(1)))
    longest = any_of(table <= 1 << 30, table <= 64)
    return [bodies <= MOST_BODIES, power], longest


def wrapped_runs(wrong):
    """near.rs: Grid::wrapped; across.rs. One run or two are the entries of cells next to each other
    along a row, wherever the table ends; `starts`, one longer than the table, has their ends."""
    mask, cell, row, span, entry = (word(name) for name in ["mask", "cell", "row", "span", "entry"])
    table = mask.wide() + 1
    at = ((cell + row - 1) & mask).wide()
    end = at + span.wide()
    first_end = end if wrong else end.least(table)
    wide = entry.wide()
    in_runs = any_of(all_of(at <= wide, wide < first_end),
                     all_of(table < end, wide < end - table))
    cells = [all_of(number(i, 32) < span, entry.equals((cell + row - 1 + i) & mask))
             for i in range(WRAPPED_SPAN)]
    given = [is_power_of_two(table), number(63, 32) <= mask, mask <= (1 << 30) - 1, cell <= mask,
             number(1, 32) <= span, span <= WRAPPED_SPAN, entry <= mask]
    bounds = all_of(first_end <= table, any_of(end <= table, end - table <= table))
    return given, all_of(same(in_runs, any_of(*cells)), bounds)


def box_runs(wrong):
    """cells.rs: Cells::lay_out_box; near.rs: Grid::in_box. All that a body looks at is in `starts`:
    the first entry of a row before it, and the end of the third."""
    last, reach, cell, row = (word(name) for name in ["last", "reach", "cell", "row"])
    table = last.wide() + reach.wide() + (1 if wrong else 2)
    most = 6 * MOST_BODIES + 512  # Cells::fit
    given = [last.wide() + reach.wide() <= most, cell <= last, row <= reach, number(1, 32) < row]
    at = (cell + row).wide()
    return given, all_of(cell.wide() + 2 <= table, at > 0, at + 2 <= table)


def codes(wrong):
    """block.rs: RunWriter::push, write. A code holds the slot and the lane of its pair."""
    start, lane, step = word("start"), word("lane"), word("step")
    most = MOST_BODIES + (BLOCK_BODIES + 1 if wrong else 0)
    code = ((start << 4) | lane) + (step << 4)
    given = [lane < BLOCK_BODIES, step < LONGEST_WRITTEN, start.wide() + step.wide() < most]
    return given, all_of((code >> 4).equals(start + step), (code & 15).equals(lane))


def page(wrong):
    """block.rs: RunWriter::is_full, push, write. While a page isn't full for some runs, they fit:
    every store of eight codes is within it, and no short run is dropped."""
    length, runs, written = word("length", 64), word("runs", 64), word("written", 64)
    room = CODES_PER_PAGE + 16
    full = CODES_PER_PAGE < length + runs * (LONGEST_WRITTEN - (4 if wrong else 0))
    given = [number(1, 64) <= runs, runs <= RUNS_PER_PAGE, TM.mk_term(Kind.NOT, [full]),
             length <= CODES_PER_PAGE, written <= (runs - 1) * LONGEST_WRITTEN]
    at = length + written + CODES_PER_STORE
    return given, at + CODES_PER_STORE <= room


def page_of_a_block(wrong):
    """near.rs: Grid::wrapped. The runs of sixteen bodies, ten at most for each, fit on a page."""
    bodies, runs = word("bodies", 64), word("runs", 64)
    most = 11 if wrong else 10
    given = [bodies <= BLOCK_BODIES, runs <= bodies * most]
    return given, all_of(runs <= RUNS_PER_PAGE, runs * LONGEST_WRITTEN <= CODES_PER_PAGE)


def spare_entries(wrong):
    """level.rs: GridLevel::sort. What is reserved is no less than the entries, and doesn't wrap."""
    entries, length, capacity = (word(name, 64) for name in ["entries", "length", "capacity"])
    spare = entries + (entries >> 3) - length
    given = [entries <= (1 << 33), length <= (capacity + 1 if wrong else capacity),
             capacity < entries, capacity <= (1 << 40)]
    if wrong:
        spare = entries - length - 1
    return given, all_of(spare <= entries + (entries >> 3), entries <= length + spare)


def own_cell(wrong):
    """level.rs: count, CellShare::place. A thread counts the cells of its share and no others."""
    cell, first, ends = word("cell"), word("first"), word("ends")
    given = [first.wide() + ends.wide() <= (1 << 32) + (1 if wrong else 0)]
    counted = cell - first < ends
    if wrong:
        given.append(first > 0)
    in_share = all_of(first <= cell, cell.wide() < first.wide() + ends.wide())
    return given, same(counted, in_share)


def margin_classes(wrong):
    """margins.rs: class_of. A class is no smaller than its margin, and larger margins have no
    smaller classes; bits of f32 are rounded up to a multiple of 2^20."""
    a, b = word("a"), word("b")
    step = 1 << 20
    up = lambda x: (x + (step - (2 if wrong else 1))) & (0xFFFFFFFF ^ (step - 1))
    less = lambda x, y: TM.mk_term(Kind.FP_LEQ, [from_bits(x), from_bits(y)])
    given = [number(1, 32) <= a, a <= 0x7F000000, number(1, 32) <= b, b <= 0x7F000000, less(a, b)]
    return given, all_of(less(a, up(a)), less(up(a), up(b)))


def size_numbers(wrong):
    """levels.rs: size_number, size_of_number. A size is no greater than that of its number. Numbers
    are of biased exponents here; positive floats are ordered as their bits."""
    size = word("size", 64)
    exponent, fraction = size >> 52, size & ((1 << 52) - 1)
    one = lambda condition: Word(TM.mk_term(Kind.ITE, [condition, number(1, 64).term,
                                                       number(0, 64).term]), 64)
    numbered = exponent + exponent + one(fraction > 0)
    if not wrong:
        numbered = numbered + one(fraction > 1 << 51)
    given = [number(1, 64) <= exponent, exponent <= 2045]
    return given, size <= ((numbered >> 1) << 52) | ((numbered & 1) << 51)


CLAIMS = [number_of_cell, clamped_cells, wrapped_table, wrapped_runs, box_runs, codes, page,
          page_of_a_block, spare_entries, own_cell, margin_classes, size_numbers]


def decide(claim, wrong):
    given, follows = claim(wrong)
    options = Options()
    options.set(Option.TIME_LIMIT_PER, 60_000)
    solver = Bitwuzla(TM, options)
    for term in given:
        solver.assert_formula(term)
    if solver.check_sat() != Result.SAT:
        return "unknown"  # or true of nothing
    solver.assert_formula(TM.mk_term(Kind.NOT, [follows]))
    result = solver.check_sat()
    return {Result.SAT: "refuted", Result.UNSAT: "proved"}.get(result, "unknown")


def main():
    fine, start = True, time.time()
    for claim in CLAIMS:
        found = decide(claim, False), decide(claim, True)
        if found != ("proved", "refuted"):
            print(f"{claim.__name__}: {found[0]}, its control {found[1]}")
            fine = False
    if fine:
        print(f"{len(CLAIMS)} claims on slots, runs and sizes: proved, their controls refuted, "
              f"{time.time() - start:.1f} s")
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
