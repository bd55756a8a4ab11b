"""Errata about rotations and rigid motions, each with its counterexample."""

import numpy as np
from numpy.typing import NDArray

from lietool.lie import groups, quaternion, so2, so3
from lietool.verbs._errata import Erratum, Outcome, erratum, outcome

Array = NDArray[np.float64]
PI = np.pi
ROTATIONS: list[Erratum] = []
LOGARITHMS: list[Erratum] = []


@erratum(
    ROTATIONS,
    "B 2.34",
    printed="slerp(1, exp(theta u), t) = exp(t theta u)",
    true="the same, for 0 < theta < pi only",
    why="slerp sees only the two ends, at most pi apart: it takes the short arc",
    example="theta = 4 about z, t = 0.3",
)
def slerp_past_pi() -> Outcome:
    u, t, one = np.array([0.0, 0.0, 1.0]), 0.3, np.array([1.0, 0.0, 0.0, 0.0])
    short, long = quaternion.exp(3.0 * u), quaternion.exp(4.0 * u)
    rest = quaternion.slerp(one, short, t) - quaternion.exp(3.0 * t * u)
    found = outcome(quaternion.exp(4.0 * t * u), quaternion.slerp(one, long, t))
    return Outcome(found.printed, found.true, found.error, float(np.linalg.norm(rest)))


def _sandwich(q: Array, v: Array) -> Array:
    """Return the point q (1 + v eps) q-bar-star of section 2.8."""
    p = np.concatenate([[1.0, 0.0, 0.0, 0.0, 0.0], v])
    star = np.concatenate([quaternion.conjugate(q[:4]), -quaternion.conjugate(q[4:])])
    return groups.multiply("DQ^x", groups.multiply("DQ^x", q, p), star)[5:]


@erratum(
    ROTATIONS,
    "B 2.8 (text)",
    printed="1 + w eps acts as the translation by w",
    true="it translates by 2 w: the translation by t is 1 + (t/2) eps",
    why="q stands on both sides of the point, and each adds w once",
    example="w = (0.3, -0.5, 0.8), the point (1, 2, 3); the error is the length of w",
)
def translation_by_half() -> Outcome:
    w, v = np.array([0.3, -0.5, 0.8]), np.array([1.0, 2.0, 3.0])

    def moved(dual: Array) -> Array:
        return _sandwich(np.concatenate([[1.0, 0.0, 0.0, 0.0, 0.0], dual]), v)

    found = outcome(v + w, moved(w))
    rest = np.linalg.norm(moved(w / 2) - (v + w))
    return Outcome(found.printed, found.true, found.error, float(rest))


@erratum(
    ROTATIONS,
    "B A.1",
    printed="R(x) = (u, x) + cos(theta) {x - (u, x) u} + sin(theta) u cross x",
    true="R(x) = (u, x) u + cos(theta) {x - (u, x) u} + sin(theta) u cross x",
    why="the part along the axis is a vector; (u, x) alone is a number",
    example="a random axis and point (seed 5), theta = 1; the number is added to every component",
)
def along_the_axis() -> Outcome:
    rng = np.random.default_rng(5)
    u, x, theta = rng.normal(size=3), rng.normal(size=3), 1.0
    u /= np.linalg.norm(u)
    across = np.cos(theta) * (x - (u @ x) * u) + np.sin(theta) * np.cross(u, x)
    return outcome((u @ x) + across, (u @ x) * u + across, so3.from_axis_angle(u, np.array(theta)) @ x)


@erratum(
    ROTATIONS,
    "B A.11 (solution)",
    printed="(b1, b2) = (-a1, 1; a1^2, -a2 (1 - a2 theta^2)) / det, a matrix",
    true="(b1, b2) = (-a1, a1^2 - a2 (1 - a2 theta^2)) / det",
    why="two unknowns need two numbers; the line break fell into the second and left a 1 in the first row",
    example="theta = 1, the printed rows added up; b1 must be -1/2",
    also=("B A.11",),
)
def coefficients_of_the_inverse() -> Outcome:
    theta = 1.0
    a1, a2 = (1.0 - np.cos(theta)) / theta**2, (theta - np.sin(theta)) / theta**3
    det = a1**2 * theta**2 + (1.0 - a2 * theta**2) ** 2
    printed = np.array([[-a1, 1.0], [a1**2, -a2 * (1.0 - a2 * theta**2)]]) / det
    true = np.array([-a1, a1**2 - a2 * (1.0 - a2 * theta**2)]) / det
    b2 = (2 * np.sin(theta) - (1 + np.cos(theta)) * theta) / (2 * theta**2 * np.sin(theta))
    return outcome(printed.sum(axis=1), true, np.array([-0.5, b2]))


@erratum(
    ROTATIONS,
    "M section 2, d",
    printed="d = (I + (1 - cos theta)/theta^2 R + (theta - sin theta)/theta^3 R^2) l",
    true="the same with X in place of R",
    why="the series of the exponential is in the powers of X; R is its sum",
    example="x = (0.3, 0.4, 0.5), l = (0, 0, 1)",
    also=("M 2",),
)
def translation_from_the_rotation() -> Outcome:
    x, l = np.array([0.3, 0.4, 0.5]), np.array([0.0, 0.0, 1.0])  # noqa: E741 (the papers' symbol)
    theta, X, R = float(np.linalg.norm(x)), so3.hat(x), so3.exp(x)
    a, b = (1.0 - np.cos(theta)) / theta**2, (theta - np.sin(theta)) / theta**3
    printed, true = ((np.eye(3) + a * M + b * M @ M) @ l for M in (R, X))
    # d is the mean of exp(t x) l over 0 <= t <= 1, here by a rule of Gauss with no error left.
    nodes, weights = np.polynomial.legendre.leggauss(12)
    reference = (0.5 * weights) @ (so3.exp(0.5 * (nodes[:, None] + 1.0) * x) @ l)
    return outcome(printed, true, reference)


@erratum(
    ROTATIONS,
    "M section 2, theta",
    printed="theta = acos((Tr(R) - 1) / 2), R being 4 x 4",
    true="the trace of the 3 x 3 part",
    why="the homogeneous matrix has one more 1 on its diagonal",
    example="a quarter turn: pi/3 in place of pi/2",
    also=("M 2",),
)
def angle_of_the_larger_matrix() -> Outcome:
    A = np.eye(4)
    A[:3, :3] = so3.rotation("x", PI / 2)
    printed = np.arccos((np.trace(A) - 1.0) / 2.0)
    return outcome(printed, np.arccos((np.trace(A[:3, :3]) - 1.0) / 2.0), PI / 2)


@erratum(
    ROTATIONS,
    "B 7.6",
    printed="theta = acos(tr(R) / 2)",
    true="theta = acos((tr(R) - 1) / 2)",
    why="tr R = 1 + 2 cos theta",
    example="R = I: the arc cosine of 3/2",
)
def angle_of_the_identity() -> Outcome:
    with np.errstate(invalid="ignore"):
        printed = float(np.arccos(np.trace(np.eye(3)) / 2.0))
    true = float(np.arccos((np.trace(np.eye(3)) - 1.0) / 2.0))
    R = so3.rotation("x", 2.0)
    return Outcome(printed, true, float("nan"), abs(float(np.arccos((np.trace(R) - 1.0) / 2.0)) - 2.0))


@erratum(
    ROTATIONS,
    "K section 1",
    printed="psi = atan(b/a) + k pi with any whole k",
    true="k even where a > 0, odd where a < 0: psi = atan2(b, a) + 2 pi k",
    why="the tangent has half the period of the rotation and cannot tell R from -R",
    example="a = 1, b = 0, k = 1: the rotation by psi is -I",
)
def parity() -> Outcome:
    return outcome(so2.exp(np.arctan(0.0) + PI), so2.exp(np.arctan2(0.0, 1.0)), np.eye(2))


@erratum(
    LOGARITHMS,
    "B 4.6 (text)",
    printed="a motion with continuous velocity has a continuous logarithm",
    true="it has if its velocity does not vanish where it passes I",
    why="at rest on I a motion forgets its axis, and may leave about any other",
    example="Rx(2 pi s) resting at I, then Ry: largest step of R, and of its logarithm",
)
def resting_at_the_identity() -> Outcome:
    t = np.linspace(0.0, 1.0, 401)
    rest = t * t * (3.0 - 2.0 * t)
    path = np.concatenate([so3.rotation("x", 2 * PI * rest), so3.rotation("y", rest[1:])])
    step = np.max(np.linalg.norm(so3.log(np.swapaxes(path[:-1], -1, -2) @ path[1:]), axis=-1))
    jump = _largest_step(so3.log_along(path, np.zeros(3)))
    # The same with speed: it goes on about x while the other turn begins, and the logarithm does not jump.
    path = np.concatenate(
        [so3.rotation("x", 2 * PI * t), so3.rotation("x", t[1:]) @ so3.rotation("y", rest[1:])]
    )
    lift = so3.log_along(path, np.zeros(3))
    if _largest_step(lift) > 0.2:
        raise ArithmeticError("errata: the logarithm of a motion with speed must not jump")
    return Outcome(float(step), jump, jump - float(step), float(np.max(np.abs(so3.exp(lift) - path))))


def _largest_step(x: Array) -> float:
    return float(np.max(np.linalg.norm(np.diff(x, axis=0), axis=-1)))


@erratum(
    LOGARITHMS,
    "B 7.1, M 1 (text)",
    printed="psi is a continuous inverse of phi",
    true="only locally: no continuous inverse exists on all of Aff+(3)",
    why="along a full turn a continuous logarithm grows to 2 pi, yet R is I again",
    example="Rx(2 pi t), followed from 0: the logarithm at t = 1, where R = I",
    also=("B 7.1", "M 1"),
)
def around_a_full_turn() -> Outcome:
    path = so3.rotation("x", np.linspace(0.0, 2 * PI, 201))
    lift = so3.log_along(path, np.zeros(3))
    rest = float(np.max(np.abs(so3.exp(lift) - path)))
    return Outcome(so3.log(np.eye(3)), lift[-1], float(np.linalg.norm(lift[-1])), rest)


@erratum(
    LOGARITHMS,
    "K (8) near pi",
    printed="the sign of the angle is that of v2 (R - R^T)13, + where that is 0",
    true="the sign of the inner product of v with the whole vector of R - R^T",
    why="an eigenvector is known up to sign only, and one component of it may be 0",
    example="R = exp((pi - 0.01)(-1, 0, 0)), eigenvector (1, 0, 0)",
    also=("K 8",),
)
def sign_near_pi() -> Outcome:
    x = (PI - 0.01) * np.array([-1.0, 0.0, 0.0])
    R, v = so3.exp(x), np.array([1.0, 0.0, 0.0])
    theta = np.arccos((np.trace(R) - 1.0) / 2.0)
    printed = (1.0 if v[1] * (R - R.T)[0, 2] >= 0 else -1.0) * theta * v
    true = np.copysign(1.0, v @ so3.vee(R - R.T)) * theta * v
    found = outcome(printed, true)
    # The arc cosine has lost some digits; the logarithm that is implemented has not.
    return Outcome(printed, so3.log(R), found.error, float(np.linalg.norm(so3.log(R) - x)))


def algorithm_1(R: Array, reference: Array) -> Array:
    """Kaji and Ochiai's Algorithm 1 as it is printed, on vectors."""
    theta = np.arccos(np.clip((np.trace(R) - 1.0) / 2.0, -1.0, 1.0))
    length = np.linalg.norm(reference)
    if theta == PI:
        return PI / length * reference if length > 0 else np.array([0.0, 0.0, -PI])
    with np.errstate(invalid="ignore"):
        u = so3.vee(R - R.T) / np.sin(theta) / 2.0
    if u @ reference < 0:
        u, theta = -u, -theta
    while length - theta > PI:
        theta += 2 * PI
    while theta - length > PI:
        theta -= 2 * PI
    return theta * u


@erratum(
    LOGARITHMS,
    "K Alg. 1, theta = pi",
    printed="pi X' / |X'|",
    true="pi u or -pi u, u from R, whichever is nearer to X'",
    why="the axis is that of R; the reference only chooses its direction",
    example="R = Rx(pi), X' = e_z: the exponential of the answer is Rz(pi)",
)
def half_turn() -> Outcome:
    R, reference = np.diag([1.0, -1.0, -1.0]), np.array([0.0, 0.0, 1.0])
    nearest, _ = so3.log_near(R, reference)
    return outcome(so3.exp(algorithm_1(R, reference)), so3.exp(nearest), R)


@erratum(
    LOGARITHMS,
    "K Alg. 1, theta = 0",
    printed="theta (R - R^T) / (2 sin theta)",
    true="2 pi round(|X'| / 2 pi) X' / |X'|",
    why="at R = I it is 0/0; all of length 2 pi n are logarithms, the nearest along X'",
    example="R = I, X' = (0, 6, 1)",
)
def no_turn() -> Outcome:
    reference = np.array([0.0, 6.0, 1.0])
    printed = algorithm_1(np.eye(3), reference)
    length = np.linalg.norm(reference)
    true = 2 * PI * np.rint(length / (2 * PI)) * reference / length
    nearest, _ = so3.log_near(np.eye(3), reference)
    return Outcome(printed, true, float("nan"), float(np.linalg.norm(true - nearest)))


@erratum(
    LOGARITHMS,
    "K Alg. 1, closest",
    printed="turn on until |theta' - theta| <= pi, theta' = |X'|",
    true="(theta + 2 pi k) u with k = round((<u, X'> - theta) / 2 pi)",
    why="what counts is X' along the axis u; |X'| may be more, and has no sign",
    example="share of 400 random cases (seed 5) that the loop misses: as claimed, as counted",
)
def closest() -> Outcome:
    rng = np.random.default_rng(5)
    R, reference = so3.exp(rng.normal(size=(400, 3)) * 3), rng.normal(size=(400, 3)) * 5
    _, nearest = so3.log_near(R, reference)
    printed = np.array([algorithm_1(r, x) for r, x in zip(R, reference, strict=True)])
    distance = np.linalg.norm(printed - reference, axis=-1)
    share = float(np.mean(distance > nearest + 1e-6))
    # Nearest of all branches, tried one by one.
    x = so3.log(R)
    theta = np.linalg.norm(x, axis=-1, keepdims=True)
    tried = [x + 2 * PI * k * x / theta - reference for k in range(-8, 9)]
    best = np.min(np.linalg.norm(tried, axis=-1), axis=0)
    return Outcome(0.0, share, share, float(np.max(np.abs(best - nearest))))


@erratum(
    LOGARITHMS,
    "K 4.3, 5.3 (text)",
    printed="logarithms nearest to those of the neighbours recover large rotations",
    true="not beyond a full turn, but by luck: state the turns",
    why="a logarithm that is continuous crosses |x| = 2 pi only where R = I exactly",
    example="Ry(6 degrees) Rx(0 to 540 degrees): the largest angle, stated and recovered",
    also=("K 4.3", "K 5.3"),
)
def thorn() -> Outcome:
    turn = np.linspace(0.0, 3 * PI, 1501)
    path = so3.rotation("y", np.deg2rad(6.0)) @ so3.rotation("x", turn)
    lift = so3.log_along(path, np.zeros(3))
    reached = float(np.rad2deg(np.max(np.linalg.norm(lift, axis=-1))))
    stated, _ = so3.log_near(path[-1], np.array([3 * PI, 0.0, 0.0]))
    if np.linalg.norm(stated) < 2 * PI:
        raise ArithmeticError("errata: a stated turn must be found")
    rest = np.max(np.abs(so3.exp(stated) - path[-1]))
    return Outcome(540.0, reached, 540.0 - reached, float(rest))
