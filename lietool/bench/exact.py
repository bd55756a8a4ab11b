"""The functions of `lietool.lie` for one element, to 50 digits, where formulas need not care about rounding.

Each takes one element as nested lists of floats, and returns its candidates:
the values that are right, mostly one.  A value is a tuple of blocks, such as
rotation and translation, and a block is a flat list of numbers.
"""

from collections.abc import Callable, Sequence
from typing import Any

import mpmath

Number = mpmath.mpf
Matrix = Any
Block = list
Value = tuple[Block, ...]

# Ten digits more than are asked for, and a context of its own: nobody else's precision changes.
MP: Any = mpmath.MPContext()
MP.dps = 60

_HALF_TURN = 1e-14
"""This near to a half turn, rounding may have taken the sign of the axis: both are right."""


def _vector(x: Sequence[float]) -> list:
    return [MP.mpf(float(v)) for v in x]


def _matrix(A: Sequence[Sequence[float]]) -> Matrix:
    return MP.matrix([[float(v) for v in row] for row in A])


def _flat(M: Matrix) -> Block:
    return [M[i, j] for i in range(M.rows) for j in range(M.cols)]


def _norm(x: Sequence) -> Number:
    return MP.sqrt(sum((v * v for v in x), MP.mpf(0)))


def _hat(x: Sequence) -> Matrix:
    return MP.matrix([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])


def _apply(M: Matrix, v: Sequence) -> list:
    return [sum((M[i, j] * v[j] for j in range(len(v))), MP.mpf(0)) for i in range(len(v))]


def _exp(x: Sequence) -> Matrix:
    theta = _norm(x)
    if not theta:
        return MP.eye(3)
    X = _hat(x)
    return MP.eye(3) + MP.sin(theta) / theta * X + 2 * (MP.sin(theta / 2) / theta) ** 2 * X * X


def _jacobian(x: Sequence) -> Matrix:
    theta = _norm(x)
    if not theta:
        return MP.eye(3)
    X = _hat(x)
    # theta - sin(theta) loses twice as many digits as theta has zeros.
    third = (theta - MP.sin(theta)) / theta**3 if theta > 1e-8 else MP.mpf(1) / 6 - theta**2 / 120
    return MP.eye(3) + 2 * (MP.sin(theta / 2) / theta) ** 2 * X + third * X * X


def _nearest_rotation(R: Matrix) -> Matrix:
    """Newton's iteration: the error of a rounded rotation is squared three times."""
    for _ in range(4):
        R = (R + (R**-1).T) / 2
    return R


def _quaternion(R: Matrix) -> list:
    """Shepperd's choice of the largest component, w >= 0."""
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    squares = [1 + trace] + [1 + 2 * R[i, i] - trace for i in range(3)]
    k = max(range(4), key=squares.__getitem__)
    skew = [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]
    if k == 0:
        q = [squares[0], *skew]
    else:
        i = k - 1
        q = [skew[i], *(R[i, j] + R[j, i] for j in range(3))]
        q[k] = squares[k]
    scale = _norm(q) * (1 if q[0] >= 0 else -1)
    return [v / scale for v in q]


def _logs(R: Matrix) -> list[list]:
    q = _quaternion(_nearest_rotation(R))
    sine = _norm(q[1:])
    if not sine:
        return [[MP.mpf(0)] * 3]
    theta = 2 * MP.atan2(sine, q[0])
    angles = [theta, theta - 2 * MP.pi] if MP.pi - theta < _HALF_TURN else [theta]
    return [[angle * v / sine for v in q[1:]] for angle in angles]


def _of_eigenvalues(f: Callable, S: Matrix) -> Matrix:
    d, Q = MP.eigsy(S)
    return Q * MP.diag([f(v) for v in d]) * Q.T


def _symmetric(y: Sequence) -> Matrix:
    xx, xy, xz, yy, yz, zz = y
    return MP.matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def so3_exp(x: Sequence[float]) -> list[Value]:
    """Rodrigues' formula."""
    return [(_flat(_exp(_vector(x))),)]


def so3_log(R: Sequence) -> list[Value]:
    """The logarithm of the rotation nearest to the given numbers; at a half turn, both."""
    return [(x,) for x in _logs(_matrix(R))]


def so3_left_jacobian(x: Sequence[float]) -> list[Value]:
    """The left Jacobian."""
    return [(_flat(_jacobian(_vector(x))),)]


def so3_left_jacobian_inverse(x: Sequence[float]) -> list[Value]:
    """Its inverse."""
    return [(_flat(_jacobian(_vector(x)) ** -1),)]


def se3_exp(x: Sequence[float]) -> list[Value]:
    """Rotation and translation."""
    x = _vector(x)
    return [(_flat(_exp(x[:3])), _apply(_jacobian(x[:3]), x[3:]))]


def se3_log(T: Sequence) -> list[Value]:
    """Rotation and translation of the twist; at a half turn, both."""
    M = _matrix(T)
    d = [M[i, 3] for i in range(3)]
    return [(x, _apply(_jacobian(x) ** -1, d)) for x in _logs(M[:3, :3])]


def so2_exp(x: float) -> list[Value]:
    """The rotation of the plane by x."""
    c, s = MP.cos(MP.mpf(float(x))), MP.sin(MP.mpf(float(x)))
    return [([c, -s, s, c],)]


def so2_log(R: Sequence) -> list[Value]:
    """The angle; at a half turn, both."""
    M = _matrix(R)
    x = MP.atan2(M[1, 0] - M[0, 1], M[0, 0] + M[1, 1])
    return [([x],), ([x - MP.sign(x) * 2 * MP.pi],)] if MP.pi - abs(x) < _HALF_TURN else [([x],)]


def _plane_jacobian(x: Number) -> Matrix:
    if not x:
        return MP.eye(2)
    a, b = MP.sin(x) / x, 2 * MP.sin(x / 2) ** 2 / x
    return MP.matrix([[a, -b], [b, a]])


def se2_exp(x: Sequence[float]) -> list[Value]:
    """Rotation and translation."""
    theta, *d = _vector(x)
    return [(so2_exp(x[0])[0][0], _apply(_plane_jacobian(theta), d))]


def se2_log(T: Sequence) -> list[Value]:
    """Rotation and translation of the twist; at a half turn, both."""
    M = _matrix(T)
    d = [M[0, 2], M[1, 2]]
    angles = [value[0] for value in so2_log([row[:2] for row in T[:2]])]
    return [(x, _apply(_plane_jacobian(x[0]) ** -1, d)) for x in angles]


def quaternion_exp(x: Sequence[float]) -> list[Value]:
    """The unit quaternion cos |x| + sin |x| x/|x|."""
    x = _vector(x)
    theta = _norm(x)
    return [([MP.cos(theta), *(MP.sin(theta) / theta * v if theta else v for v in x)],)]


def quaternion_log(q: Sequence[float]) -> list[Value]:
    """The logarithm of the unit quaternion nearest to the given numbers; at -1 the axis is free."""
    q = _vector(q)
    sine = _norm(q[1:])
    if not sine:
        return [([0 if q[0] > 0 else MP.pi, MP.mpf(0), MP.mpf(0)],)]
    return [([MP.atan2(sine, q[0]) / sine * v for v in q[1:]],)]


def quaternion_from_matrix(R: Sequence) -> list[Value]:
    """The unit quaternion, and its opposite."""
    q = _quaternion(_nearest_rotation(_matrix(R)))
    return [(q,), ([-v for v in q],)]


def dual_quaternion_exp(x: Sequence[float]) -> list[Value]:
    """The two quaternions of the screw motion by the twist 2 x."""
    z, *v = quaternion_exp(x[:3])[0][0]
    twice = [2 * u for u in _vector(x)]
    a, b, c = (d / 2 for d in _apply(_jacobian(twice[:3]), twice[3:]))
    w = [-a * v[0] - b * v[1] - c * v[2], a * z + b * v[2] - c * v[1]]
    w += [b * z + c * v[0] - a * v[2], c * z + a * v[1] - b * v[0]]
    return [([z, *v], w)]


def sym_exp(Y: Sequence) -> list[Value]:
    """By eigenvalues."""
    return [(_flat(_of_eigenvalues(MP.exp, _matrix(Y))),)]


def sym_log(S: Sequence) -> list[Value]:
    """By eigenvalues."""
    return [(_flat(_of_eigenvalues(MP.log, _matrix(S))),)]


def sym_sqrt(S: Sequence) -> list[Value]:
    """By eigenvalues."""
    return [(_flat(_of_eigenvalues(MP.sqrt, _matrix(S))),)]


def polar_decompose(A: Sequence) -> list[Value]:
    """Rotation and stretch; A^T A loses half of the digits, and enough are left."""
    M = _matrix(A)
    S = _of_eigenvalues(MP.sqrt, M.T * M)
    return [(_flat(M * S**-1), _flat(S))]


def phi_so(p: Sequence[float]) -> list[Value]:
    """Linear part and translation."""
    p = _vector(p)
    return [(_flat(_exp(p[:3]) * _of_eigenvalues(MP.exp, _symmetric(p[6:]))), p[3:6])]


def phi_se(p: Sequence[float]) -> list[Value]:
    """Linear part and translation."""
    p = _vector(p)
    A = _exp(p[:3]) * _of_eigenvalues(MP.exp, _symmetric(p[6:]))
    return [(_flat(A), _apply(_jacobian(p[:3]), p[3:6]))]


def affine_itself(A: Sequence) -> list[Value]:
    """Linear part and translation of what a round trip must give back."""
    M = _matrix(A)
    return [(_flat(M[:3, :3]), [M[i, 3] for i in range(3)])]


def itself(A: Sequence) -> list[Value]:
    """What a round trip must give back."""
    return [(_flat(_matrix(A)),)]


def relative_errors(got: Sequence[Sequence[float]], candidates: Sequence[Value], least: float) -> float:
    """Return the largest relative error of the blocks of a value, against the nearest candidate.

    Parameters
    ----------
    got : sequence of sequence of float
        The blocks, flat.
    candidates : sequence of tuple of list
        What is right.
    least : float
        The error is relative to the norm of the block, or to this if that is larger.

    Returns
    -------
    float
        In the Euclidean norm of each block.
    """

    def error(block: Sequence[float], right: Block) -> float:
        if not all(abs(float(v)) < float("inf") for v in block):
            return float("inf")
        off = _norm([MP.mpf(float(v)) - r for v, r in zip(block, right, strict=True)])
        size = max(_norm(right), MP.mpf(least))
        return float(off / size) if size else 0.0 if not off else float("inf")

    return min(max(error(b, r) for b, r in zip(got, value, strict=True)) for value in candidates)
