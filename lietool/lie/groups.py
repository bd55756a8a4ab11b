"""The groups of the book as data: what is known of each, and how to tell, mend, draw and split its elements.

Elements are matrices (..., n, n), homogeneous ones (..., n + 1, n + 1) where there are translations, or the
components of numbers: (re, im), (w, x, y, z), and for dual ones the real part, then the dual part.

Names: SO, O, SE, E, GL, GL+, SL, CO+ (rotation and dilation), R+ (dilations), Sym+ (a set), Diag+, R
(translations), Sim+ (similarities), Aff+, Aff; C^x, S^1, H^x, S^3, DCN and DQ (dual complex numbers and dual
quaternions of length 1), DQ^x (invertible dual quaternions).
"""

from collections.abc import Sequence
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import checks, group_matrices, group_numbers
from lietool.lie.group_maps import MAPS as MAPS
from lietool.lie.group_maps import Map as Map
from lietool.lie.group_maps import contains as contains
from lietool.lie.group_maps import edges as edges
from lietool.lie.group_maps import inclusion as inclusion
from lietool.lie.group_records import GROUPS as GROUPS
from lietool.lie.group_records import Group as Group
from lietool.lie.group_records import Product as Product

Array = NDArray[np.float64]

ELEMENTS = {**group_matrices.MATRICES, **group_numbers.NUMBERS}
ACTING = {**group_matrices.ACTING, **group_numbers.ACTING}


def get(name: str) -> Group:
    """Return the record of a group.

    Raises
    ------
    ValueError
        If there is no group of that name.
    """
    if name not in GROUPS:
        _unknown("groups.get", name)
    return GROUPS[name]


def label(name: str, n: int) -> str:
    """Return the name with its dimension, SE(3) or R^3; numbers have none."""
    if get(name).only is not None or name == "R+":
        return name
    return f"{name}^{n}" if name == "R" else f"{name}({n})"


def is_member(name: str, A: ArrayLike, tol: float = checks.TOLERANCE) -> NDArray[np.bool_]:
    """Tell which of the arrays are elements of a group.

    Equations such as R^T R = I hold within `tol` in their largest entry (relative to the size of A where the
    group has elements of every size).  Inequalities such as det A > 0 hold or do not; a matrix counts as
    singular if its smallest singular value is rounding.

    Book: (2.2), (2.3), (2.4), (2.6), (2.12), (2.13), (2.20), (2.25), (2.36), (2.38), (2.40), (2.42), (2.43)
    Book: (3.1), (3.2), (3.3), (3.4), (4.5), (4.12), (4.13), (4.15), (4.16), (4.18), (4.19)

    Parameters
    ----------
    name : str, one of GROUPS
    A : (..., *shape of an element)
    tol : float, of equations

    Returns
    -------
    member : (...), bool

    Raises
    ------
    ValueError
        If there is no such group, or A has another shape or is not finite.
    """
    A = _array("groups.is_member", name, A)
    if not tol >= 0.0:
        checks.fail("groups.is_member", "tol", "0 or more", f"{tol}", None)
    elements = ELEMENTS[name]
    return elements.inside(A) & (elements.defect(A) <= tol)


def project(name: str, A: ArrayLike) -> Array:
    """Return the nearest element of a group, or its natural representative.

    Rotations, congruences and the like are the nearest in the sum of squares.  The open sets GL, GL+,
    Sym+, Diag+ and R+ have no nearest element: what lies outside gets singular values that are
    `group_matrices.FLOOR` times the largest.
    SL is reached by a change of scale, and unit numbers by division by the length.  An element of the
    group stays as it is, up to rounding.

    Book: (2.20), (2.25), (2.42), (2.43), (3.3), (3.4)

    Parameters
    ----------
    name : str, one of GROUPS
    A : (..., *shape of an element)

    Returns
    -------
    B : (..., *shape of an element)

    Raises
    ------
    ValueError
        If there is no such group, A has another shape or is not finite, or is a number without an inverse.
    """
    A = _array("groups.project", name, A)
    if GROUPS[name].only is not None and np.any(bad := ~ELEMENTS[name].inside(A)):
        index = checks.first(bad)
        checks.fail("groups.project", "A", "a number with an inverse", f"{A[index].tolist()}", index)
    return ELEMENTS[name].project(A.copy())


def sample(name: str, shape: int | Sequence[int] = (), seed: int = 0, n: int = 3) -> Array:
    """Draw elements of a group at random.

    From independent normal numbers, by `project` where that is fair (rotations are uniform), by the
    exponential for Sym+ and Diag+, and by changing the sign of a column for GL+ and SL.

    Book: (3.11), (4.18), (4.19)

    Parameters
    ----------
    name : str, one of GROUPS
    shape : int or tuple of int, of the batch
    seed : int
    n : int, the dimension of the space; of no account for numbers

    Returns
    -------
    A : (*shape, *shape of an element)

    Raises
    ------
    ValueError
        If there is no such group, or n < 2.
    """
    group = get(name)
    if n < 2:
        checks.fail("groups.sample", "n", "2 or more", f"{n}", None)
    batch = (shape,) if isinstance(shape, int) else tuple(shape)
    x = np.random.default_rng(seed).normal(size=(*batch, *group.shape(n)))
    return ELEMENTS[name].generic(x)


def identity(name: str, n: int = 3) -> Array:
    """Return the neutral element.

    Book: (2.20)

    Parameters
    ----------
    name : str, one of GROUPS
    n : int, the dimension of the space; of no account for numbers

    Returns
    -------
    one : (*shape of an element)
    """
    shape = get(name).shape(n)
    return np.eye(shape[0]) if len(shape) == 2 else np.eye(shape[0])[0]


def multiply(name: str, A: ArrayLike, B: ArrayLike) -> Array:
    """Return A B: first B, then A.

    Book: (2.24), (2.38), (3.2)

    Parameters
    ----------
    name : str, one of GROUPS
    A : (..., *shape of an element)
    B : (..., *shape of an element)

    Returns
    -------
    AB : (..., *shape of an element)
    """
    where = "groups.multiply"
    return ELEMENTS[name].multiply(_array(where, name, A), _array(where, name, B, "B"))


def inverse(name: str, A: ArrayLike) -> Array:
    """Return the inverse.

    Book: (2.20), (2.38)

    Parameters
    ----------
    name : str, one of GROUPS
    A : (..., *shape of an element)

    Returns
    -------
    A_inverse : (..., *shape of an element)
    """
    return ELEMENTS[name].inverse(_array("groups.inverse", name, A))


def split(name: str, A: ArrayLike) -> tuple[Array, Array]:
    """Return the factors h, k of A = h k in a product of groups, k in the normal one.

    Book: (3.5), (3.6), (3.7), (3.8), (3.9), (3.10)

    Parameters
    ----------
    name : str, one of GROUPS with a product
    A : (..., *shape of an element)

    Returns
    -------
    h : (..., *shape of an element)
    k : (..., *shape of an element)

    Raises
    ------
    ValueError
        If the group is no product.
    """
    A = _array("groups.split", name, A)
    if name not in ACTING:
        checks.fail("groups.split", "name", f"a product of groups: {', '.join(ACTING)}", name, None)
    h = ACTING[name](A)
    return h, ELEMENTS[name].multiply(ELEMENTS[name].inverse(h), A)


def _unknown(where: str, name: str) -> NoReturn:
    checks.fail(where, "name", f"one of {', '.join(GROUPS)}", repr(name), None)


def _array(where: str, name: str, A: ArrayLike, argument: str = "A") -> Array:
    """Return A as a finite array whose trailing axes fit an element of the group, for some n >= 2."""
    if name not in GROUPS:
        _unknown(where, name)
    group = GROUPS[name]
    if group.only is not None:
        return checks.array(where, argument, A, group.shape(group.only))
    given = np.shape(A)
    least = group.shape(2)[0]
    size = given[-1] if given and given[-1] > least else least
    return checks.array(where, argument, A, (size, size))
