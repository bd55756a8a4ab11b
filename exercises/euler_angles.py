r"""Euler angles, and where they lock.

Every rotation of space is a product of three turns about coordinate axes. In the order $x$, $y$, $z$ it is

$$R_z(\theta_3)\,R_y(\theta_2)\,R_x(\theta_1), \qquad (2.21)$$

where for instance $R_z(\theta)$ turns $x$ towards $y$; vectors are columns, and the first turn stands on the
right. Other letters are as good: with $x$, $y$, $x$ the same angles give
$R_x(\theta_3)\,R_y(\theta_2)\,R_x(\theta_1)$, as in (2.23). The way back has a flaw. The matrix of (2.23) is

$$\begin{pmatrix} c_2 & s_2 s_1 & s_2 c_1 \\ s_3 s_2 & \cdot & \cdot \\ -c_3 s_2 & \cdot & \cdot
\end{pmatrix}, \qquad c_k = \cos\theta_k,\; s_k = \sin\theta_k,$$

and where $s_2 = 0$ only the sum of $\theta_1$ and $\theta_3$ is fixed, or their difference: gimbal lock.

Write two functions:

- `matrix(angles, axes)` returns the rotation of angles $(\theta_1, \theta_2, \theta_3)$ about three axes such
  as `"xyz"` (2.21) or `"xyx"` (2.23), in the order in which the turns are made.
- `angles(R)` returns the angles about `"xyx"` of a rotation: $\theta_2$ from $0$ to $\pi$, the others from
  $-\pi$ to $\pi$. At lock, up to rounding, it returns $\theta_3 = 0$, and $\theta_1$ has it all.

Angles are in radians. Both take batches: angles of shape `(..., 3)`, matrices of shape `(..., 3, 3)`.
"""

import numpy as np

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture
from lietool.exercise import compare as _compare


def matrix(angles, axes):
    """Return the rotation of three Euler angles.

    Parameters
    ----------
    angles : ndarray, shape (..., 3)
        The angles theta_1, theta_2, theta_3 in radians.
    axes : str
        The three axes that they turn about, in this order: "xyz", "xyx", ...

    Returns
    -------
    ndarray, shape (..., 3, 3)
        The matrices R, for column vectors.
    """
    first, second, third = (
        turn(axis, theta) for axis, theta in zip(axes, np.moveaxis(angles, -1, 0), strict=True)
    )
    return third @ second @ first


def angles(R):
    """Return the Euler angles of a rotation about x, y, x.

    Parameters
    ----------
    R : ndarray, shape (..., 3, 3)
        Rotations, for column vectors.

    Returns
    -------
    ndarray, shape (..., 3)
        The angles theta_1, theta_2, theta_3 in radians, 0 <= theta_2 <= pi; theta_3 = 0 at lock.
    """
    sine = np.hypot(R[..., 0, 1], R[..., 0, 2])
    first, third = np.arctan2(R[..., 0, 1], R[..., 0, 2]), np.arctan2(R[..., 1, 0], -R[..., 2, 0])
    locked = sine < 1e-14
    first = np.where(locked, np.arctan2(-R[..., 1, 2], R[..., 1, 1]), first)
    return np.stack([first, np.arctan2(sine, R[..., 0, 0]), np.where(locked, 0.0, third)], axis=-1)


def turn(axis, theta):
    """Return the rotation about one of the axes "x", "y", "z", shape (..., 3, 3)."""
    i = "xyz".index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3
    R = np.zeros((*np.shape(theta), 3, 3))
    R[..., i, i] = 1.0
    R[..., j, j] = R[..., k, k] = np.cos(theta)
    R[..., k, j] = np.sin(theta)
    R[..., j, k] = -np.sin(theta)
    return R


_AXES = ("xyz", "xyx", "zxz", "yxz")


def _ordinary(rng):
    yield Case("only the first angle", (np.array([0.5, 0.0, 0.0]), "xyz"), "matrix")
    yield Case("only the last angle", (np.array([0.0, 0.0, 0.5]), "xyz"), "matrix")
    for axes in _AXES:
        yield Case(f"some angles about {'-'.join(axes)}", (rng.uniform(-3.0, 3.0, 3), axes), "matrix")


def _between(rng, *shape):
    """Angles about x, y, x that are not near lock."""
    return rng.uniform((-3.0, 0.2, -3.0), (3.0, 2.9, 3.0), (*shape, 3))


def _back(rng):
    yield Case("a turn about y", (turn("y", 0.7),), "angles")
    yield Case("a turn about z, (2.23)", (turn("z", 0.7),), "angles")
    for _ in range(4):
        yield Case("some rotation", (matrix(_between(rng), "xyx"),), "angles")


def _batches(rng):
    yield Case("five triples of angles", (rng.uniform(-3.0, 3.0, (5, 3)), "xyz"), "matrix")
    yield Case("2 x 3 triples of angles", (rng.uniform(-3.0, 3.0, (2, 3, 3)), "xyx"), "matrix")
    yield Case("five rotations", (matrix(_between(rng, 5), "xyx"),), "angles")
    mixed = np.stack([turn("x", 0.4), turn("z", 0.4)])
    yield Case("two rotations, the first of them at lock", (mixed,), "angles")


def _laws(f, rng):
    theta, R = rng.uniform(-3.0, 3.0, 3), matrix(_between(rng), "xyx")
    yield Claim("matrix(angles(R)) = R", f.matrix(f.angles(R), "xyx"), R, (R,))
    yield Claim("angles(matrix(t)) = t", f.angles(f.matrix(given := _between(rng), "xyx")), given, (given,))
    shifted = (theta - (0.0, np.pi / 2.0, 0.0)) * (1.0, 1.0, -1.0)
    left, right = f.matrix(theta, "xyz"), turn("y", np.pi / 2.0) @ f.matrix(shifted, "xyx")
    yield Claim("x-y-z angles as x-y-x angles, (2.22)", left, right, (theta,))


def _lock(rng):
    yield Case("the identity", (np.eye(3),), "angles")
    yield Case("a turn about x: theta_2 = 0", (turn("x", -1.3),), "angles")
    yield Case("half a turn about y: theta_2 = pi", (turn("y", np.pi),), "angles")
    yield Case("theta_2 = pi and a turn about x", (turn("y", np.pi) @ turn("x", 0.8),), "angles")
    yield Case("theta_2 = 1e-7, not yet at lock", (matrix(np.array([0.5, 1e-7, 1.0]), "xyx"),), "angles")


def _modulo_turns(got, want):
    """How far apart angles are, whole turns apart being the same."""
    # Shapes first: the rest needs none.
    _compare.apart(got, want)
    return _compare.apart(np.exp(1j * np.asarray(got)), np.exp(1j * np.asarray(want)))


def _reversed(angles, axes):
    first, second, third = (turn(a, t) for a, t in zip(axes, np.moveaxis(angles, -1, 0), strict=True))
    return first @ second @ third


def _unlocked(R):
    """Return the angles by the formula for all matrices, at lock too."""
    third = np.arctan2(R[..., 1, 0], -R[..., 2, 0])
    sine = np.hypot(R[..., 0, 1], R[..., 0, 2])
    first = np.arctan2(R[..., 0, 1], R[..., 0, 2])
    return np.stack([first, np.arctan2(sine, R[..., 0, 0]), third], axis=-1)


def _by_arctan(R):
    """Return the angles by quotients, which do not know their quadrants."""
    right = angles(R)
    quotients = np.stack(
        [R[..., 0, 1] / R[..., 0, 2], np.zeros(R.shape[:-2]), -R[..., 1, 0] / R[..., 2, 0]], -1
    )
    return np.where([True, False, True], np.arctan(quotients), right)


def _exchanged(R):
    return angles(R)[..., ::-1]


def _last_at_lock(R):
    """Return the angles with the first of them 0 at lock."""
    found = angles(R)
    locked = (np.hypot(R[..., 0, 1], R[..., 0, 2]) < 1e-14)[..., None]
    sign = np.where(R[..., 0, 0] > 0.0, 1.0, -1.0)
    other = np.stack([np.zeros_like(sign), found[..., 1], sign * found[..., 0]], axis=-1)
    return np.where(locked, other, found)


def _shown(f):
    """Return what the figure takes; one call for each rotation, for who has written functions of one."""
    return {
        "to_matrix": lambda angles, axes: np.stack([f.matrix(x, axes) for x in angles]),
        "from_matrix": lambda R, axes: np.reshape([f.angles(x) for x in R.reshape(-1, 3, 3)], R.shape[:-1]),
    }


EXERCISE = Exercise(
    number=2,
    title="Euler angles, and where they lock",
    equations=("2.21", "2.22", "2.23"),
    functions=(
        Function(
            "matrix",
            library="lietool.lie.euler.to_matrix",
            starter="return np.full((*np.shape(angles), 3), np.nan)",
            tolerance=1e-12,
        ),
        Function(
            "angles",
            library="lietool.lie.euler.from_matrix",
            call=lambda function, R: function(R, "xyx"),
            starter="return np.full(np.shape(R)[:-1], np.nan)",
            apart=_modulo_turns,
        ),
    ),
    checks=(
        Check("the matrix", 2, cases=_ordinary),
        Check("the angles", 2, cases=_back),
        Check("batches", 1, cases=_batches),
        Check("there and back, and (2.22)", 1, law=_laws),
        Check("at lock", 1, cases=_lock),
    ),
    picture=Picture("GL2", 3, _shown),
    mutants=("so3.rotation", "euler.to_matrix", "euler.from_matrix"),
    mistakes=(
        Mistake(
            "order",
            "The factors stand in the reverse order. In (2.21) the first turn, by theta_1, stands on the "
            "right, next to the vector; the other way round the axes would turn along.",
            {"matrix": _reversed},
        ),
        Mistake(
            "all turns backwards",
            "Every single turn goes the other way. R_z(theta) carries x towards y: -sin(theta) stands "
            "above the diagonal, but in R_y, from z to x, below it.",
            {"matrix": lambda angles, axes: matrix(-np.asarray(angles), axes)},
        ),
        Mistake(
            "R_y backwards",
            "The turn about y goes the other way. It carries z to x, so that its -sin(theta) stands below "
            "the diagonal, where R_x and R_z have theirs above: (2.21).",
            {
                "matrix": lambda angles, axes: matrix(
                    angles * np.array([-1.0 if axis == "y" else 1.0 for axis in axes]), axes
                )
            },
        ),
        Mistake(
            "transposed",
            "This is the transpose, the turns undone. For column vectors the matrix is "
            "R_z(theta_3) R_y(theta_2) R_x(theta_1), (2.21).",
            {"matrix": lambda angles, axes: np.swapaxes(matrix(angles, axes), -1, -2)},
        ),
        Mistake(
            "arctan",
            "An arctangent of a quotient does not know its quadrant and is half a turn off for every other "
            "rotation. The function atan2 of sine and cosine does.",
            {"angles": _by_arctan},
        ),
        Mistake(
            "nothing at lock",
            "Right but at lock. Where sin(theta_2) = 0 the entries that theta_1 and theta_3 come from are "
            "0, or what rounding left of them; there take theta_3 = 0, and theta_1 from the middle of the "
            "matrix.",
            {"angles": _unlocked},
        ),
        Mistake(
            "the last angle at lock",
            "Right but at lock, where the last angle has it all: wanted is theta_3 = 0.",
            {"angles": _last_at_lock},
        ),
        Mistake(
            "exchanged",
            "The first and the last angle have changed places. In the first row of (2.23) theta_1 is found, "
            "in the first column theta_3.",
            {"angles": _exchanged},
        ),
        Mistake(
            "degrees",
            "The angles come out in degrees; wanted are radians.",
            {"angles": lambda R: np.rad2deg(angles(R))},
        ),
    ),
)
