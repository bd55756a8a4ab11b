"""The nine classes of affine transformations whose parameters make a linear subspace.

So a blend, a spline, any linear operation on parameters of one class stays in
that class.  It is so under both maps, `affine.phi_so` and `affine.phi_se`.
"""

from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import matrix_checks


@dataclass(frozen=True)
class Subspace:
    """Which parts of a parameter are free in a class; `stretch` is 0, 1 (c I) or 2 (any symmetric matrix)."""

    title: str
    translation: bool
    rotation: bool
    stretch: int

    def dimension(self, n: int) -> int:
        """Return the dimension of the class in n dimensions."""
        stretch = (0, 1, n * (n + 1) // 2)[self.stretch]
        return n * self.translation + n * (n - 1) // 2 * self.rotation + stretch


CLASSES = MappingProxyType(
    {
        "dilation": Subspace("uniform scalings, R+", False, False, 1),
        "translation": Subspace("translations, R^n", True, False, 0),
        "SO": Subspace("rotations", False, True, 0),
        "CO+": Subspace("rotations with uniform scalings: linear conformal maps", False, True, 1),
        "Sym+": Subspace("stretches along orthogonal axes: positive definite matrices", False, False, 2),
        "SE": Subspace("rigid transformations", True, True, 0),
        "Sim+": Subspace("similarities that keep orientation", True, True, 1),
        "GL+": Subspace("linear maps that keep orientation", False, True, 2),
        "Aff+": Subspace("affine maps that keep orientation", True, True, 2),
    }
)
"""Each class comes after those that it contains."""


def _parts(p: NDArray[np.float64], n: int) -> tuple[NDArray, NDArray, NDArray, list[int]]:
    """Return views of the rotation, the translation and the symmetric part, and where its diagonal is."""
    turn = n * (n - 1) // 2
    return p[..., :turn], p[..., turn : turn + n], p[..., turn + n :], [0, 3, 5] if n == 3 else [0, 2]


def project(params: ArrayLike, name: str, *, check: bool = True) -> NDArray[np.float64]:
    """Return the nearest parameters that belong to a class of transformations.

    Kaji-Ochiai: (V)

    Parameters
    ----------
    params : (..., 12)
        Or (..., 6), of the plane.
    name : {CLASSES}
    check : bool, False to trust the values

    Returns
    -------
    projected : (..., 12)

    Raises
    ------
    ValueError
        If there is no such class, or params are not finite.
    """
    p, n = matrix_checks.parameters("affine.project", "params", params, check)
    if name not in CLASSES:
        raise ValueError(f"affine.project: name must be one of {', '.join(CLASSES)}; got {name!r}.")
    p = p.copy()
    x, d, Y, diagonal = _parts(p, n)
    if not CLASSES[name].rotation:
        x[...] = 0.0
    if not CLASSES[name].translation:
        d[...] = 0.0
    if CLASSES[name].stretch < 2:
        mean = np.mean(Y[..., diagonal], axis=-1, keepdims=True)
        Y[...] = 0.0
        if CLASSES[name].stretch == 1:
            Y[..., diagonal] = mean
    return p
