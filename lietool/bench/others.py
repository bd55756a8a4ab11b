"""What SciPy and pytransform3d make of the same inputs, one element after the other; both are test extras."""

import importlib
import importlib.util
import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

Blocks = tuple[np.ndarray, ...]

LIBRARIES = ("SciPy", "SciPy expm, logm", "pytransform3d")
_PACKAGES = {"SciPy": "scipy", "SciPy expm, logm": "scipy", "pytransform3d": "pytransform3d"}


def missing() -> dict[str, str]:
    """Return the libraries that cannot be compared with here, and why."""
    found = {}
    for library, package in _PACKAGES.items():
        if importlib.util.find_spec(package) is None:
            found[library] = f"{package} is not installed"
        elif package == "scipy" and importlib.import_module("scipy").__version__ == "1.18.0":
            found[library] = "SciPy 1.18.0 computes wrong exponentials"
    return found


def functions(library: str, name: str) -> Callable[[np.ndarray], Blocks] | None:
    """Return a library's function for one element, by our name for it, or None where it has none.

    The result is in blocks as ours is: rotation and translation apart.
    """
    makers = {"SciPy": _scipy, "SciPy expm, logm": _matrix_functions, "pytransform3d": _pytransform3d}
    return makers[library]().get(name)


def apply(f: Callable[[np.ndarray], Blocks], x: np.ndarray) -> Blocks | None:
    """Return what a function makes of one element, or None if it refuses it; warnings are not shown."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            return f(x)
        except (ValueError, ArithmeticError, np.linalg.LinAlgError):
            return None


def _hat(x: np.ndarray) -> np.ndarray:
    return np.array([[0.0, -x[2], x[1]], [x[2], 0.0, -x[0]], [-x[1], x[0], 0.0]])


def _hat_rigid(x: np.ndarray) -> np.ndarray:
    X = np.zeros((4, 4))
    X[:3, :3], X[:3, 3] = _hat(x), x[3:]
    return X


def _vee(X: Any) -> np.ndarray:
    X = np.real(X)
    return 0.5 * np.array([X[2, 1] - X[1, 2], X[0, 2] - X[2, 0], X[1, 0] - X[0, 1]])


def _two(A: np.ndarray) -> Blocks:
    n = len(A) - 1
    return A[:n, :n], A[:n, n]


def _halves(x: np.ndarray) -> Blocks:
    return x[:3], x[3:]


def _scipy() -> dict[str, Callable[[np.ndarray], Blocks]]:
    from scipy import linalg
    from scipy.spatial import transform

    Rotation = transform.Rotation
    found: dict[str, Callable[[np.ndarray], Blocks]] = {
        "so3.exp": lambda x: (Rotation.from_rotvec(x).as_matrix(),),
        "so3.log": lambda R: (Rotation.from_matrix(R).as_rotvec(),),
        "quaternion.from_matrix": lambda R: (Rotation.from_matrix(R).as_quat()[[3, 0, 1, 2]],),
        "quaternion.to_matrix": lambda q: (Rotation.from_quat(q[[1, 2, 3, 0]]).as_matrix(),),
        "polar.decompose": lambda A: linalg.polar(A),
        "sym.sqrt": lambda S: (np.real(linalg.sqrtm(S)),),
    }
    # Newer than the oldest SciPy that we test with.
    if (Rigid := getattr(transform, "RigidTransform", None)) is not None:
        found["se3.exp"] = lambda x: _two(Rigid.from_exp_coords(x).as_matrix())
        found["se3.log"] = lambda T: _halves(Rigid.from_matrix(T).as_exp_coords())
    return found


def _matrix_functions() -> dict[str, Callable[[np.ndarray], Blocks]]:
    from scipy.linalg import expm, logm

    def twist(T: np.ndarray) -> Blocks:
        X = np.real(logm(T))
        return _vee(X), X[:3, 3]

    def plane(x: np.ndarray) -> Blocks:
        return _two(expm(np.array([[0.0, -x[0], x[1]], [x[0], 0.0, x[2]], [0.0, 0.0, 0.0]])))

    def plane_twist(T: np.ndarray) -> Blocks:
        X = np.real(logm(T))
        return np.array([0.5 * (X[1, 0] - X[0, 1])]), X[:2, 2]

    return {
        "so2.exp": lambda x: (expm(x * np.array([[0.0, -1.0], [1.0, 0.0]])),),
        "so2.log": lambda R: (np.real(logm(R))[1, :1],),
        "so3.exp": lambda x: (expm(_hat(x)),),
        "so3.log": lambda R: (_vee(logm(R)),),
        "se2.exp": plane,
        "se2.log": plane_twist,
        "se3.exp": lambda x: _two(expm(_hat_rigid(x))),
        "se3.log": twist,
        **{f"sym.exp ({n} x {n})": lambda Y: (expm(Y),) for n in (2, 3)},
        **{f"sym.log ({n} x {n})": lambda S: (np.real(logm(S)),) for n in (2, 3)},
        "aff: exp(log A)": lambda A: _two(expm(np.real(logm(A)))),
    }


def _pytransform3d() -> dict[str, Callable[[np.ndarray], Blocks]]:
    from pytransform3d import rotations as pr
    from pytransform3d import transformations as pt

    return {
        "so3.exp": lambda x: (pr.matrix_from_compact_axis_angle(x),),
        "so3.log": lambda R: (pr.compact_axis_angle_from_matrix(R),),
        "so3.left_jacobian": lambda x: (pr.left_jacobian_SO3(x),),
        "so3.left_jacobian_inverse": lambda x: (pr.left_jacobian_SO3_inv(x),),
        "se3.exp": lambda x: _two(pt.transform_from_exponential_coordinates(x)),
        "se3.log": lambda T: _halves(pt.exponential_coordinates_from_transform(T)),
        "quaternion.from_matrix": lambda R: (pr.quaternion_from_matrix(R),),
        "quaternion.to_matrix": lambda q: (pr.matrix_from_quaternion(q),),
    }


def worst(
    f: Callable[[np.ndarray], Blocks], elements: np.ndarray, measure: Callable[[int, Blocks], float]
) -> tuple[float, int]:
    """Return the worst error of a function over elements, and how many it refused."""
    errors: list[float] = []
    refused = 0
    for i, x in enumerate(elements):
        blocks = apply(f, x)
        if blocks is None:
            refused += 1
        else:
            errors.append(measure(i, blocks))
    return max(errors, default=float("nan")), refused


def flat(blocks: Sequence[np.ndarray]) -> list[list[float]]:
    """Return blocks as flat lists of floats."""
    return [np.ravel(block).tolist() for block in blocks]
