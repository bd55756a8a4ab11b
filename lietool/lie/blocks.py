"""Run elementwise kernels over large batches in blocks that stay in the cache.

A kernel gets each argument as its components, one contiguous row per entry
of the matrix or vector, and returns the components of the result.  So the
formulas read as they do for one element, and a million take no more time per
element than a thousand.
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Rows = Sequence[NDArray[np.float64]]

BLOCK = 4096
"""Elements in a block: a few dozen rows of them fit in a 2 MiB cache."""


def run(
    kernel: Callable[..., Rows], core: tuple[int, ...], *arguments: tuple[NDArray[np.float64], int]
) -> NDArray[np.float64]:
    """Apply a kernel to every element of a batch.

    `arguments` are pairs of an array and the number of its trailing axes that
    make one element; `core` is the shape of one element of the result.
    """
    batches = [a.shape[: a.ndim - n] for a, n in arguments]
    batch = batches[0] if len(batches) == 1 else np.broadcast_shapes(*batches)
    size = int(np.prod(batch))
    flat = [
        np.broadcast_to(a, batch + a.shape[a.ndim - n :]).reshape(size, int(np.prod(a.shape[a.ndim - n :])))
        for a, n in arguments
    ]
    result = np.empty((size, int(np.prod(core))))
    for start in range(0, size, BLOCK):
        stop = start + BLOCK
        rows = kernel(*(np.ascontiguousarray(f[start:stop].T) for f in flat))
        for i, row in enumerate(rows):
            result[start:stop, i] = row
    return result.reshape(batch + core)
