"""Editing an image by its gradient (Perez, Gangnet and Blake 2003): Poisson's equation on a grid of pixels.

Inside a mask the image is sought whose differences between neighbouring pixels come nearest to a given
field, while outside it stays as it is.  The field has one number for each pair of neighbours: `gradient`
of another image pastes that image without a seam; `stronger` of two keeps what is most marked in either.

The sum runs over the pairs of which one pixel at least is inside.  Where the mask touches the border of
the image there are no pairs across it: nothing is prescribed there, and the derivative across the border is
the field's own (Neumann).  Values are left as they come, beyond those of the images too.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks
from lietool.mesh import solve as systems
from lietool.mesh import topology

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]
Field = tuple[Array, Array]


@dataclass(frozen=True, eq=False)
class Prepared:
    """The factored system of a mask, good for any images and any number of channels.

    Parameters
    ----------
    mask : ndarray of bool, shape (h, w)
    nodes : ndarray of int, shape (k,)
        The pixels inside and next to it, row by row: w times the row plus the column.
    matrix : sparse array, shape (k, k)
        The positive Laplacian of the pairs.
    fixed : ndarray of int
        Which of the nodes are outside.
    factor : Factor
    """

    mask: Mask
    nodes: Index
    matrix: Any
    fixed: Index
    factor: systems.Factor


@dataclass(frozen=True, eq=False)
class Result:
    """An edited image.

    Parameters
    ----------
    prepared : Prepared
    field : tuple of ndarray
        What its differences were to be.
    image : ndarray, shape (h, w) or (h, w, c)
    """

    prepared: Prepared
    field: Field
    image: Array

    @cached_property
    def energy(self) -> float:
        """The sum of squared differences from the field, over pairs with a pixel inside: (7.10)."""
        total = 0.0
        for one, wanted, pairs in zip(
            gradient(self.image), self.field, _inside(self.prepared.mask), strict=True
        ):
            total += float(np.sum((one - wanted)[pairs] ** 2))
        return total

    @cached_property
    def residual(self) -> float:
        """The largest error in an equation of (7.11), relative to the largest value."""
        mask, field = self.prepared.mask, self.field
        left, right = (divergence(*_only(mask, f)) for f in (gradient(self.image), field))
        scale = max(float(np.max(np.abs(self.image))), float(np.max(np.abs(right))), 1e-300)
        return float(np.max(np.abs(left - right)[mask])) / scale


def gradient(image: ArrayLike) -> Field:
    """Return the differences of neighbouring pixels, across and down.

    Book: (7.10)

    Parameters
    ----------
    image : array_like, shape (h, w) or (h, w, c)

    Returns
    -------
    across : (h, w - 1) or (h, w - 1, c)
        Of each pixel and the one to its right: the right one's value less the left one's.
    down : (h - 1, w) or (h - 1, w, c)

    Raises
    ------
    ValueError
        If it is no image or not finite.
    """
    a = _image("image.gradient", "image", image)
    return np.diff(a, axis=1), np.diff(a, axis=0)


def divergence(across: ArrayLike, down: ArrayLike) -> Array:
    """Return the divergence of a field; of a gradient, the Laplacian, the sum of neighbours less the pixel.

    Book: (7.11)

    Parameters
    ----------
    across : array_like, shape (h, w - 1) or (h, w - 1, c)
    down : array_like, shape (h - 1, w) or (h - 1, w, c)

    Returns
    -------
    div : (h, w) or (h, w, c)
        Nothing flows across the border.

    Raises
    ------
    ValueError
        If the shapes are not those of a field or it is not finite.
    """
    x, y = _field("image.divergence", (across, down), None)
    total = np.zeros((x.shape[0], y.shape[1], *x.shape[2:]))
    total[:, :-1] += x
    total[:, 1:] -= x
    total[:-1] += y
    total[1:] -= y
    return total


def stronger(one: tuple[ArrayLike, ArrayLike], other: tuple[ArrayLike, ArrayLike]) -> Field:
    """Return, for each pair of pixels, that of two fields which is larger in size: Perez's mixed gradients.

    Book: (7.10)

    Parameters
    ----------
    one, other : tuple of array_like
        Of one shape; several channels choose together, by their sum of squares. Equal, the first is taken.

    Returns
    -------
    field : tuple of ndarray

    Raises
    ------
    ValueError
        If the shapes are not those of a field, differ, or a number is not finite.
    """
    a = _field("image.stronger", one, None)
    b = _field("image.stronger", other, None)
    if [x.shape for x in a] != [x.shape for x in b]:
        topology.fail("image.stronger", "other", f"a field of shapes {_shapes(a)}", _shapes(b))
    chosen = []
    for x, y in zip(a, b, strict=True):
        over = (y * y - x * x).sum(axis=2) > 0.0 if x.ndim == 3 else np.abs(y) > np.abs(x)
        chosen.append(np.where(over[..., None] if x.ndim == 3 else over, y, x))
    return chosen[0], chosen[1]


def prepare(mask: ArrayLike) -> Prepared:
    """Factor the Laplacian inside a mask, with the values next to it given.

    Book: (7.11)

    Parameters
    ----------
    mask : array_like of bool, shape (h, w)
        True where the image is to change: any shape, in several parts, touching the border or not.

    Returns
    -------
    Prepared

    Raises
    ------
    ValueError
        If no pixel is inside, or all are: then nothing says how bright the image is.
    """
    inside = _mask(mask)
    x, y = _inside(inside)
    number = np.arange(inside.size).reshape(inside.shape)
    ends = np.concatenate(
        [np.stack([number[:, :-1][x], number[:, 1:][x]], 1), np.stack([number[:-1][y], number[1:][y]], 1)]
    )
    nodes = np.unique(ends)
    matrix = _laplacian(np.searchsorted(nodes, ends), len(nodes))
    fixed = np.flatnonzero(~inside.ravel()[nodes])
    return Prepared(inside, nodes, matrix, fixed, systems.factor(matrix, fixed))


def solve(prepared: Prepared, target: ArrayLike, field: tuple[ArrayLike, ArrayLike]) -> Result:
    """Return the image that is the target outside the mask and whose gradient is nearest to a field inside.

    Book: (7.10), (7.11)

    Parameters
    ----------
    prepared : Prepared
    target : array_like, shape (h, w) or (h, w, c)
    field : tuple of array_like
        As `gradient` returns it, of an image of the target's shape. Only pairs with a pixel inside matter.

    Returns
    -------
    Result

    Raises
    ------
    ValueError
        If a shape does not fit or a number is not finite.
    """
    where = "image.solve"
    mask = prepared.mask
    given = _image(where, "target", target)
    if given.shape[:2] != mask.shape:
        topology.fail(where, "target", f"of the mask's size {mask.shape}", f"shape {given.shape}")
    wanted = _field(where, field, given.shape)
    # With the positive Laplacian on the left, the divergence changes its sign.
    div = divergence(*_only(mask, wanted)).reshape(mask.size, -1)
    flat = given.reshape(mask.size, -1)
    found = prepared.factor.solve(-div[prepared.nodes], flat[prepared.nodes[prepared.fixed]])
    image = flat.copy()
    image[prepared.nodes] = found
    # Outside nothing may change, not even by rounding.
    image[~mask.ravel()] = flat[~mask.ravel()]
    return Result(prepared, wanted, image.reshape(given.shape))


def _laplacian(ends: Index, count: int) -> Any:
    from scipy.sparse import csc_array

    i, j = ends.T
    one = np.ones(len(ends))
    data = np.concatenate([one, one, -one, -one])
    row, column = np.concatenate([i, j, i, j]), np.concatenate([i, j, j, i])
    return csc_array((data, (row, column)), (count, count))


def _inside(mask: Mask) -> tuple[Mask, Mask]:
    """Which pairs, across and down, have a pixel inside."""
    return mask[:, :-1] | mask[:, 1:], mask[:-1] | mask[1:]


def _only(mask: Mask, field: Field) -> Field:
    """The field on the pairs with a pixel inside, 0 elsewhere."""
    x, y = (
        np.where(pairs[..., None] if f.ndim == 3 else pairs, f, 0.0)
        for f, pairs in zip(field, _inside(mask), strict=True)
    )
    return x, y


def _mask(mask: ArrayLike) -> Mask:
    try:
        a = np.asarray(mask)
    except ValueError:
        topology.fail("image.prepare", "mask", "true or false, of shape (h, w)", "a ragged list")
    if a.dtype.kind != "b" or a.ndim != 2:
        topology.fail(
            "image.prepare", "mask", "true or false, of shape (h, w)", f"{a.dtype} of shape {a.shape}"
        )
    if not a.any() or a.all():
        got = "every pixel" if a.size and a.all() else "none"
        topology.fail("image.prepare", "mask", "some pixels of the image and not all", got)
    return a.copy()


def _numbers(where: str, name: str, a: ArrayLike) -> Array:
    try:
        x = np.asarray(a)
    except ValueError:
        topology.fail(where, name, "an array of numbers", "a ragged list")
    if x.dtype.kind not in "fiu" or x.ndim not in (2, 3):
        topology.fail(where, name, "numbers of shape (h, w) or (h, w, c)", f"{x.dtype} of shape {x.shape}")
    bad = ~(np.abs(x) <= checks.LARGEST)
    if bad.any():
        index = tuple(int(i) for i in np.argwhere(bad)[0])
        limit = f"at most {checks.LARGEST:.0e} in size" if np.isfinite(x[index]) else "finite"
        topology.fail(where, name, limit, f"{x[index]} at index {index}")
    return x.astype(np.float64)


def _image(where: str, name: str, image: ArrayLike) -> Array:
    a = _numbers(where, name, image)
    if not a.size:
        topology.fail(where, name, "at least one pixel", f"shape {a.shape}")
    return a


def _field(where: str, field: tuple[ArrayLike, ArrayLike], shape: tuple[int, ...] | None) -> Field:
    """The two parts of a field, of an image of a shape where one is given."""
    if len(field) != 2:
        topology.fail(where, "field", "differences across and down", f"{len(field)} arrays")
    x, y = (_numbers(where, name, a) for name, a in zip(("across", "down"), field, strict=True))
    h, w, rest = shape[0] if shape else len(x), shape[1] if shape else y.shape[1], (shape or x.shape)[2:]
    if x.shape != (h, w - 1, *rest) or y.shape != (h - 1, w, *rest):
        wanted = f"({h}, {w - 1}{_more(rest)}) and ({h - 1}, {w}{_more(rest)})"
        topology.fail(where, "field", f"of shapes {wanted}", _shapes((x, y)))
    return x, y


def _more(rest: tuple[int, ...]) -> str:
    return "".join(f", {c}" for c in rest)


def _shapes(field: Field) -> str:
    return " and ".join(str(x.shape) for x in field)
