"""Two points far apart along one axis, no periodic direction: does vesin's NeighborList answer?

    pip install vesin numpy && python far_apart.py

Each distance is tried in a separate process, because some end the process by a signal. The right
answer is always "0 pairs".
"""

import subprocess
import sys

TRY = """
import numpy as np, vesin
points = np.array([[0.0, 0.0, 0.0], [{far}, 2.0, 2.0]])
i, j = vesin.NeighborList(cutoff=1.0, full_list=False).compute(points, box=np.zeros((3, 3)), periodic=False, quantities="ij")
print(f"{{len(i)}} pairs")
"""

for power in range(4, 26, 3):
    run = subprocess.run([sys.executable, "-c", TRY.format(far=2.0**power)], capture_output=True, text=True)
    said = run.stdout.strip() or "".join(run.stderr.strip().splitlines()[-1:])
    print(f"2^{power} apart: exit code {run.returncode} {said}")
