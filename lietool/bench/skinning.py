"""What libigl and pytransform3d have for moving the vertices of a mesh, as pairs of prepare and solve."""

import importlib
import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Pair = tuple[Callable[[], Any], Callable[[Any], Any]]

LINEAR, DUAL, ARAP = "libigl linear blend", "pytransform3d dual quaternions", "libigl ARAP"
"""libigl's Python package has no dual quaternion skinning, so that is made of pytransform3d's functions."""

_PACKAGES = {LINEAR: ("igl", "libigl"), DUAL: ("pytransform3d",) * 2, ARAP: ("igl", "libigl")}


def missing() -> dict[str, str]:
    """Return what cannot be compared with here, and why."""
    return {
        method: f"{name} is not installed"
        for method, (package, name) in _PACKAGES.items()
        if importlib.util.find_spec(package) is None
    }


def linear(V: Array, w: Array, A: Array) -> Pair:
    """Return linear blend skinning by affine transformations (k, 4, 4)."""
    T = np.ascontiguousarray(np.swapaxes(A[:, :3], 1, 2).reshape(-1, 3))
    return lambda: _igl().lbs_matrix(V, w), lambda M: M @ T


def dual(V: Array, w: Array, A: Array) -> Pair:
    """Return dual quaternion skinning by the rigid parts of affine transformations (k, 4, 4)."""
    U, _, W = np.linalg.svd(A[:, :3, :3])
    M = A.copy()
    M[:, :3, :3] = U @ W
    moves: Any = importlib.import_module("pytransform3d.trajectories")

    def blended(dq: Array) -> Array:
        mixed = w @ dq
        mixed /= np.linalg.norm(mixed[:, :4], axis=1, keepdims=True)
        return moves.batch_dq_prod_vector(mixed, V)

    return lambda: moves.dual_quaternions_from_transforms(M), blended


def arap(V: Array, F: Index, held: Index, now: Array, rounds: int) -> Pair:
    """Return libigl's ARAP with some vertices held where they are now, from the shape at rest."""
    igl = _igl()

    def prepare() -> Any:
        data = igl.ARAPData()
        data.max_iter = rounds
        igl.arap_precomputation(V, F, 3, held.astype(np.int32), data)
        return data

    return prepare, lambda data: igl.arap_solve(now, data, V)


def _igl() -> Any:
    return importlib.import_module("igl")
