"""Two points far apart along one axis, no periodic direction: does vesin's NeighborList answer?

    pip install vesin numpy && python far_apart.py

The points are 0 or 2 apart along the other axes. Each distance is tried in a separate process,
because some end the process by a signal. The right answer is always "0 pairs".
"""

import subprocess
import sys

TRY = """
import numpy as np, vesin
points = np.array([[0.0, 0.0, 0.0], [{far}, {width}, {width}]])
i, j = vesin.NeighborList(cutoff=1.0, full_list=False).compute(points, box=np.zeros((3, 3)), periodic=False, quantities="ij")
print(f"{{len(i)}} pairs")
"""

for width in (0.0, 2.0):
    for power in (8, 16, 17, 18, 19, 24):
        run = subprocess.run([sys.executable, "-c", TRY.format(far=2.0**power, width=width)], capture_output=True, text=True)
        last = run.stdout.strip() or "".join(run.stderr.strip().splitlines()[-1:])
        print(f"2^{power} apart, {width:g} along the other axes: exit code {run.returncode} {last}".rstrip())
