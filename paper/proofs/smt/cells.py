"""The grid's count of cells by an SMT solver, in 16-bit floats (half a minute).

`.ci/proofs` runs it, with `pip install bitwuzla`. Cell numbers are computed as `CellRule::cell`
does (src/broad_phase/grid/cells.rs). The former count, round(extent / size) + 1, is refuted.
Today's, the number of the farthest centre's cell and one, is proved; Coq proves it for f64
(coq/Cells.v, centre_in_table).
"""

import sys
import time

from bitwuzla import Bitwuzla, Kind, Option, Options, Result, RoundingMode, TermManager

EXPONENT, SIGNIFICAND = 5, 11
MOST_CELLS = 64


def farthest_centre(former, expected):
    """Whether a centre x <= hi can fall in a cell beyond the last one, as expected."""
    tm = TermManager()
    sort = tm.mk_fp_sort(EXPONENT, SIGNIFICAND)
    to_even = tm.mk_rm_value(RoundingMode.RNE)
    away_from_zero = tm.mk_rm_value(RoundingMode.RNA)

    def number(value):
        return tm.mk_fp_value(sort, to_even, str(value))

    def less_or_equal(a, b):
        return tm.mk_term(Kind.FP_LEQ, [a, b])

    def rounded(kind, a, b):
        return tm.mk_term(kind, [to_even, a, b])

    x, hi, size = (tm.mk_const(sort, name) for name in ["x", "hi", "size"])
    to_integer = number(3 * 2 ** (SIGNIFICAND - 2))
    inverse = rounded(Kind.FP_DIV, number(1), size)

    def cell(centre):
        return rounded(Kind.FP_ADD, rounded(Kind.FP_MUL, centre, inverse), to_integer)

    last = cell(hi)
    if former:
        quotient = rounded(Kind.FP_DIV, hi, size)
        quotient = tm.mk_term(Kind.FP_RTI, [away_from_zero, quotient])
        last = rounded(Kind.FP_ADD, quotient, to_integer)

    options = Options()
    options.set(Option.TIME_LIMIT_PER, 600_000)
    solver = Bitwuzla(tm, options)
    solver.assert_formula(less_or_equal(number(0), x))
    solver.assert_formula(less_or_equal(x, hi))
    solver.assert_formula(less_or_equal(hi, number(MOST_CELLS)))
    solver.assert_formula(less_or_equal(number(1), size))
    solver.assert_formula(less_or_equal(size, number(2)))
    solver.assert_formula(tm.mk_term(Kind.FP_LT, [last, cell(x)]))
    start = time.time()
    result = solver.check_sat()
    found = {Result.SAT: "refuted", Result.UNSAT: "proved"}.get(result, "unknown")
    name = "former count" if former else "count"
    print(f"{name}: {found}, {time.time() - start:.1f} s", flush=True)
    return result == expected


if __name__ == "__main__":
    fine = [farthest_centre(True, Result.SAT), farthest_centre(False, Result.UNSAT)]
    sys.exit(0 if all(fine) else 1)
