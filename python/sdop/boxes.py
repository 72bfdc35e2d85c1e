"""Boxes of float64."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def rounded_outward(boxes: ArrayLike) -> NDArray[np.float32]:
    """Rounds boxes of float64 to the smallest boxes of float32 that contain them.

    No pair is missed with them; boxes that are apart by less than the rounding may be reported.

    Parameters
    ----------
    boxes : array of floats, shape (n, 6) or (n, 2, 3)
        Lower corner x, y, z, then the upper one.

    Returns
    -------
    array of float32, shape (n, 6)
    """
    wide = np.asarray(boxes, dtype=np.float64).reshape(-1, 6)
    narrow = wide.astype(np.float32)
    outward = np.array([-np.inf] * 3 + [np.inf] * 3, dtype=np.float32)
    is_inside = np.where(outward < 0, narrow > wide, narrow < wide)
    return np.where(is_inside, np.nextafter(narrow, outward), narrow)
