"""Figure 3.3 of the book."""

from dataclasses import replace
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Library, Param, Plate, Time, figure
from lietool.lie import so2
from lietool.lie.polar import svd

from . import _decompose_page as page

Matrix = tuple[float, float, float, float]
# Nearer than this, relative to the larger, singular values are the same: rounding chose the axes.
_EQUAL = 1e-9


@figure(
    plates={
        "B3.3": Plate(
            title="The singular value decomposition",
            equations=("3.14",),
            caption=(
                "Clockwise from the upper left: R_beta turns the right singular directions of A (red and "
                "green) into the axes of the page, D stretches along them (dotted) by the singular values, "
                "R_alpha turns them into the left ones. The dashed arrow is A at once. In each step the "
                "grey outline is the one before it. Below, the factors in numbers."
            ),
        ),
        "B3.3b": Plate(
            title="The polar decomposition A = R S",
            equations=("3.11", "3.13"),
            caption=(
                "The same matrix in two steps, the stretch first: S stretches along its own eigenvectors "
                "(red and green, dotted), which are at right angles; then R turns all. The eigenvalues of S "
                "are the singular values of A. The dashed arrow is A at once. In each step the grey outline "
                "is the one before it. Below, the factors in numbers."
            ),
            params={"kind": "polar"},
        ),
        "B3.3c": Plate(
            title="The polar decomposition in the other order, A = S' R",
            equations=("3.12", "3.13"),
            caption=(
                "The same matrix in two steps, the rotation first: R is the same as in A = R S, but S' is "
                "another stretch, by the same factors, along the eigenvectors of S turned by R (dotted). "
                "The dashed arrow is A at once. In each step the grey outline is the one before it. Below, "
                "the factors in numbers."
            ),
            params={"kind": "polar-left"},
        ),
    },
    time=Time("t", 0.0, 1.0),
)
def decompose(
    kind: Annotated[
        Literal["svd", "polar", "polar-left"], Param("A = R_alpha D R_beta, A = R S or A = S' R")
    ] = "svd",
    matrix: Annotated[Matrix, Param("the matrix A, row by row", low=-10.0, high=10.0)] = (
        0.9,
        -0.3,
        1.0,
        1.0,
    ),
    t: Annotated[float, Param("how far the steps have come, one after the other", low=0.0, high=1.0)] = 1.0,
    *,
    polar: Library = Library("lietool.lie.polar.decompose"),
) -> Drawing:
    """A linear map taken apart: rotation, stretch along axes, rotation; or a stretch and a rotation.

    What to look for: the red and the green axis are at right angles from the
    beginning to the end, and no other pair of directions is; their lengths in the
    end are the singular values. A matrix with a negative determinant has a
    reflection, marked with its mirror, for its last orthogonal factor; one with determinant 0
    flattens the disc to a segment. Where the singular values are equal, any pair
    of axes will do: they are drawn pale, as the algorithm happens to choose them.
    """
    A = np.array(matrix).reshape(2, 2)
    U, d, V = _singular(A)
    steps = _steps(kind, U, d, V)
    # What flattens or reflects has none.
    if kind == "polar" and d[1] > 0.0 and np.linalg.det(U) > 0.0:
        R, S = polar(A)
        turn = _orthogonal(R)
        off = R - so2.exp(turn.angle) if turn.kind == "turn" else 0.0
        steps = (page.Step("S", S, "stretch", V), replace(turn, off=off))
    stages = _stages(steps, V, t)
    film = tuple(_stages(steps, V, moment) for moment in np.linspace(0.0, 1.0, 12 * len(steps) + 1))
    numbers = {
        "A": A,
        "singular_values": d,
        "left_axes": U,
        "right_axes": V,
        "factors": np.array([step.matrix for step in steps[::-1]]),
        "angles": np.array([step.angle for step in steps if step.kind != "stretch"]),
        "shown": np.array([stage.matrix for stage in stages]),
    }
    same = bool(d[0] - d[1] <= _EQUAL * d[0])
    return Drawing(page.picture(A, steps, stages, film, d, same), numbers)


def _singular(A: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A = U diag(d) V^T with a rotation V by -90 to 90 degrees and d >= 0; U reflects where A does."""
    U, d, V = svd(A, check=False)
    if d[0] == 0.0:
        return np.eye(2), d, np.eye(2)
    # (U, V) and (-U, -V) are the same decomposition: the smaller turn is taken.
    if V[0, 0] < 0.0 or (V[0, 0] == 0.0 and V[0, 1] < 0.0):
        U, V = -U, -V
    return U * np.where(d < 0.0, -1.0, 1.0), np.abs(d), V


def _steps(kind: str, U: np.ndarray, d: np.ndarray, V: np.ndarray) -> tuple[page.Step, ...]:
    """The factors in the order in which they act."""
    if kind == "svd":
        return (
            _orthogonal(V.T, r"\beta"),
            page.Step("D", np.diag(d), "stretch", np.eye(2)),
            _orthogonal(U, r"\alpha"),
        )
    turn = _orthogonal(U @ V.T)
    if kind == "polar":
        return page.Step("S", (V * d) @ V.T, "stretch", V), turn
    return turn, page.Step("S'", (U * d) @ U.T, "stretch", U)


def _orthogonal(Q: np.ndarray, angle: str = "") -> page.Step:
    """A rotation by its angle, or a reflection by the angle of its mirror."""
    if np.linalg.det(Q) > 0.0:
        turned = float(so2.log(Q, check=False))
        return page.Step(f"R_{angle}" if angle else "R", Q, "turn", np.eye(2), turned, angle)
    mirror = 0.5 * np.arctan2(Q[1, 0], Q[0, 0])
    return page.Step("Q", Q, "flip", so2.exp(mirror), float(mirror), angle)


def _stages(steps: tuple[page.Step, ...], V: np.ndarray, t: float) -> tuple[page.Stage, ...]:
    """What there is at first and after every step, each as far as it has come."""
    stages = [page.Stage(np.eye(2), V, None)]
    for k, step in enumerate(steps):
        done = float(np.clip(len(steps) * t - k, 0.0, 1.0))
        so_far = step.part(done) @ stages[-1].matrix
        stages.append(page.Stage(so_far, so_far @ V, step, done))
    return tuple(stages)
