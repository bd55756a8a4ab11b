"""What the book says about its groups, one record each; the tests try every claim by experiment."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Product:
    """The group as H x K, every element being h k in one way: K is normal; in a direct product H is too."""

    kind: str  # "direct" or "semidirect"
    acting: str
    normal: str


@dataclass(frozen=True)
class Group:
    """A group of transformations of R^n, or a set of them, for n >= 2.

    `components` counts the connected components; `exp` is the exponential map from the algebra;
    `unreachable(n)` is an element that is no exponential, where there is one; `only` is the one n of a group
    of numbers.
    """

    name: str
    title: str
    equations: tuple[str, ...]
    dimension: Callable[[int], int]
    shape: Callable[[int], tuple[int, ...]]
    components: int
    compact: bool
    abelian: Callable[[int], bool]
    algebra: str
    exp_injective: bool
    exp_surjective: bool
    exp_reason: str
    product: Product | None = None
    unreachable: Callable[[int], Array] | None = None
    is_group: bool = True
    only: int | None = None

    @property
    def connected(self) -> bool:
        """Whether any two elements are joined by a path."""
        return self.components == 1


def _square(n: int) -> tuple[int, ...]:
    return (n, n)


def _larger(n: int) -> tuple[int, ...]:
    return (n + 1, n + 1)


def _reals(m: int) -> Callable[[int], tuple[int, ...]]:
    return lambda n: (m,)


def _always(n: int) -> bool:
    return True


def _never(n: int) -> bool:
    return False


def _in_the_plane(n: int) -> bool:
    return n == 2


def _skew(n: int) -> int:
    return n * (n - 1) // 2


def _reflection(size: int) -> Array:
    A = np.eye(size)
    A[0, 0] = -1.0
    return A


def _two_negative(n: int, first: float, second: float, size: int | None = None) -> Array:
    A = np.eye(size or n)
    A[0, 0], A[1, 1] = first, second
    return A


_FLIPS = "a flip lies in the other component, where no exponential comes; "
_NEGATIVE = "negative eigenvalues of a real exponential come in equal pairs, and -1, -2 is none; "
_TURNS = "full turns return to the identity"

_MATRICES = (
    Group(
        *("SO", "rotations", ("2.2", "2.3", "2.13", "2.20"), _skew, _square),
        *(1, True, _in_the_plane, "so(n)", False, True),
        f"compact and connected: every rotation turns planes by angles (4.20); {_TURNS}",
    ),
    Group(
        *("O", "rotations and reflections", ("2.12",), _skew, _square),
        *(2, True, _never, "so(n)", False, False),
        _FLIPS + _TURNS,
        unreachable=_reflection,
    ),
    Group(
        *("SE", "rigid motions", ("2.6", "2.43"), lambda n: _skew(n) + n, _larger),
        *(1, False, _never, "se(n)", False, True),
        "the matrix of (7.5) is regular but for full turns, and R = I has the logarithm X = 0, l = d; "
        + _TURNS,
        Product("semidirect", "SO", "R"),
    ),
    Group(
        *("E", "congruences", ("2.42",), lambda n: _skew(n) + n, _larger),
        *(2, False, _never, "se(n)", False, False),
        _FLIPS + _TURNS,
        Product("semidirect", "O", "R"),
        lambda n: _reflection(n + 1),
    ),
    Group(
        *("GL", "linear maps", ("3.1",), lambda n: n * n, _square),
        *(2, False, _never, "gl(n)", False, False),
        _FLIPS + _TURNS,
        unreachable=_reflection,
    ),
    Group(
        *("GL+", "linear maps without a flip", ("3.3",), lambda n: n * n, _square),
        *(1, False, _never, "gl(n)", False, False),
        _NEGATIVE + _TURNS,
        unreachable=lambda n: _two_negative(n, -1.0, -2.0),
    ),
    Group(
        *("SL", "linear maps that keep volume", (), lambda n: n * n - 1, _square),
        *(1, False, _never, "sl(n)", False, False),
        "negative eigenvalues of a real exponential come in equal pairs, and -2, -1/2 is none; " + _TURNS,
        unreachable=lambda n: _two_negative(n, -2.0, -0.5),
    ),
    Group(
        *("CO+", "rotations with a dilation", (), lambda n: _skew(n) + 1, _square),
        *(1, False, _in_the_plane, "R I + so(n)", False, True),
        "a direct product of two groups whose exponentials are surjective; " + _TURNS,
        Product("direct", "SO", "R+"),
    ),
    Group(
        *("R+", "dilations", ("4.12",), lambda n: 1, _square),
        *(1, False, _always, "R I", True, True),
        "the exponential of the real line is a bijection onto the positive numbers (4.12)",
    ),
    Group(
        *("Sym+", "scale-shears: a set, not a group; products of its elements leave it", ("4.19",)),
        *(lambda n: n * (n + 1) // 2, _square),
        *(1, False, _never, "sym(n), no Lie algebra", True, True),
        "diagonalise: each eigenvalue has one real logarithm (4.19)",
        is_group=False,
    ),
    Group(
        *("Diag+", "scalings along the axes", ("4.18",), lambda n: n, _square),
        *(1, False, _always, "diag(n)", True, True),
        "each entry has one real logarithm (4.18)",
    ),
    Group(
        *("R", "translations", ("2.4", "4.5"), lambda n: n, _larger),
        *(1, False, _always, "R^n", True, True),
        "the series ends after the linear term (4.5)",
    ),
    Group(
        *("Sim+", "similarities without a flip", (), lambda n: _skew(n) + n + 1, _larger),
        *(1, False, _never, "R I + se(n)", False, True),
        "with a dilation the translation's matrix is regular, without it is that of SE(n); " + _TURNS,
        Product("semidirect", "CO+", "R"),
    ),
    Group(
        *("Aff+", "affine maps without a flip", ("3.4",), lambda n: n * n + n, _larger),
        *(1, False, _never, "aff(n)", False, False),
        _NEGATIVE + _TURNS,
        Product("semidirect", "GL+", "R"),
        lambda n: _two_negative(n, -1.0, -2.0, n + 1),
    ),
    Group(
        *("Aff", "affine maps", ("3.2",), lambda n: n * n + n, _larger),
        *(2, False, _never, "aff(n)", False, False),
        _FLIPS + _TURNS,
        Product("semidirect", "GL", "R"),
        lambda n: _reflection(n + 1),
    ),
)

_NUMBERS = (
    Group(
        *("C^x", "complex numbers but 0", ("4.13",), lambda n: 2, _reals(2)),
        *(1, False, _always, "C", False, True),
        "r e^(i theta) = exp(log r + i theta) (4.13), with any multiple of 2 pi i added",
        Product("direct", "S^1", "R_>0"),
        only=2,
    ),
    Group(
        *("S^1", "complex numbers of length 1", ("2.36",), lambda n: 1, _reals(2)),
        *(1, True, _always, "i R", False, True),
        "Euler's formula (4.13); the angle counts modulo 2 pi",
        only=2,
    ),
    Group(
        *("H^x", "quaternions but 0", (), lambda n: 4, _reals(4)),
        *(1, False, _never, "H", False, True),
        "exp(a + z) = e^a exp(z), and z in Im H reaches all of S^3, many times",
        Product("direct", "S^3", "R_>0"),
        only=3,
    ),
    Group(
        *("S^3", "quaternions of length 1", ("2.25",), lambda n: 3, _reals(4)),
        *(1, True, _never, "Im H", False, True),
        "cos theta + u sin theta is every unit quaternion (2.31); the angle counts modulo 2 pi",
        only=3,
    ),
    Group(
        *("DCN", "dual complex numbers of length 1", ("2.38", "2.40"), lambda n: 3, _reals(4)),
        *(1, False, _never, "i R + eps C", False, False),
        "above -1 the dual part of an exponential is 0, so -1 + eps is none (though every rigid motion "
        "of the plane is one); the angle counts modulo 2 pi",
        Product("semidirect", "S^1", "1 + eps C"),
        lambda n: np.array([-1.0, 0.0, 1.0, 0.0]),
        only=2,
    ),
    Group(
        *("DQ", "dual quaternions of length 1", ("4.16",), lambda n: 6, _reals(8)),
        *(1, False, _never, "Im H + eps Im H", False, True),
        "as for SE(3); above -1 turn by a half about the translation's own direction; many angles serve",
        Product("semidirect", "S^3", "1 + eps Im H"),
        only=3,
    ),
    Group(
        *("DQ^x", "invertible dual quaternions", ("4.15",), lambda n: 8, _reals(8)),
        *(1, False, _never, "H + eps H", False, True),
        "as for unit ones, times exp(a + b eps), which commutes with all; many angles serve",
        Product("semidirect", "H^x", "1 + eps H"),
        only=3,
    ),
)

GROUPS = {group.name: group for group in (*_MATRICES, *_NUMBERS)}
