"""Errors of exp, log, phi, psi over the condition number: table 1 of Kaji and Ochiai, without the times."""

from collections.abc import Callable, Mapping
from typing import Annotated

import numpy as np

from lietool.bench import methods, printed
from lietool.figure import Drawing, Param, Plate, figure
from lietool.lie import affine, so3
from lietool.render import scene, style
from lietool.render.plot import Axes

from . import _marks

CONDITIONS = tuple(range(1, 12, 2))
"""Decades."""
FEW = 20
"""Matrices for what takes them one after the other."""

_MARKS: Mapping[str, _marks.Mark] = {
    "ours": _marks.disc(style.RIGHT),
    "Higham": _marks.polygon(4, style.GREYS[0], np.pi / 4.0),
    "diagonal": _marks.polygon(3, style.GREYS[1]),
    "Newton": _marks.polygon(4, style.GREYS[0]),
    "as printed": _marks.cross(style.WRONG),
}
_WORDS = {"ours": 52.0, "Higham": 102.0, "diagonal": 109.0, "Newton": 100.0, "as printed": 131.0}
_BOXES = ((124.0, 204.0, 450.0, 600.0), (706.0, 204.0, 450.0, 600.0))
_LOWEST, _HIGHEST = -17.0, 1.4
# What is smaller, such as 0, counts as this power of ten.
_LEAST = -16
# Of marks side by side, where several methods have the same decade.
_APART = 18.0

_Way = Callable[[np.ndarray], np.ndarray]


@figure(
    plates={
        "KT1": Plate(
            title="Errors of closed formulas and their competitors",
            equations=("K 6", "K 7", "K 11"),
            caption=(
                "Left: exp(log S) against S, for random positive definite S of growing condition number, by "
                "this library, by Higham's algorithm, by diagonalisation, and by (6) and (7) as printed. "
                "Right: phi(psi(A)) against A, with the polar decomposition by one-sided Jacobi (ours), by "
                "Newton's iteration, and by the square root of A^T A as printed. Each mark is the root mean "
                "square of the relative errors of 1000 matrices (20 for Higham's algorithm, which takes them "
                "one by one), rounded to a power of ten; marks side by side are equal. An error above 1, or "
                "no number at all, counts as 1. The table with the times, on any machine: lietool bench "
                "table1."
            ),
        )
    }
)
def errors(
    matrices: Annotated[int, Param("random matrices of each condition number", "", 10, 20000)] = 1000,
    seed: Annotated[int, Param("which random matrices", "", 0, 1000)] = 1,
) -> Drawing:
    """The errors of round trips over the condition number: ours, others', and the printed formulas'.

    What to look for: ours stay at rounding whatever the condition number, and
    so do Higham's algorithm and diagonalisation. The printed formulas lose as
    many digits as it has on the left, where they subtract, and all of them
    soon on the right, where they also form A^T A; Newton's iteration loses
    half as many.
    """
    rng = np.random.default_rng(seed)
    found = (_symmetric(rng, matrices), _affine(rng, matrices))
    decades = [{name: decade(row) for name, row in rows.items()} for rows in found]
    records = [
        *_panel(0, r"error of $\exp(\log S)$", "condition number of $S$", decades[0]),
        *_panel(1, r"error of $\varphi(\psi(A))$", "condition number of $A$", decades[1]),
        *_marks.legend([(_MARKS[name], _marks.RADIUS, name, _WORDS[name]) for name in _MARKS], 56.0),
    ]
    numbers = {
        "condition_decades": np.array(CONDITIONS),
        "log_error_decade": decades[0],
        "psi_error_decade": decades[1],
    }
    return Drawing(scene.Picture((scene.View(tuple(records)),)), numbers)


def decade(errors: np.ndarray) -> np.ndarray:
    """Return the nearest powers of ten of errors, in which rounding on another processor changes nothing."""
    return np.rint(np.log10(np.maximum(errors, 10.0**_LEAST))).astype(int)


def _spectra(rng: np.random.Generator, count: int) -> np.ndarray:
    """Return eigenvalues 1, something between, and 1 / condition; shape (conditions, count, 3)."""
    t = rng.uniform(0.0, 1.0, (len(CONDITIONS), count))
    c = 10.0 ** np.array(CONDITIONS, float)[:, None]
    return np.stack([np.ones_like(t), c**-t, np.ones_like(t) / c], axis=-1)


def _rotations(rng: np.random.Generator, count: int) -> np.ndarray:
    return so3.exp(1.2 * rng.normal(size=(len(CONDITIONS), count, 3)))


def _symmetric(rng: np.random.Generator, count: int) -> dict[str, np.ndarray]:
    """Return the error of exp(log S) by method and condition number."""
    U = _rotations(rng, count)
    S = (U * _spectra(rng, count)[..., None, :]) @ np.swapaxes(U, -1, -2)
    S = 0.5 * (S + np.swapaxes(S, -1, -2))
    names = {"ours": "Ours", "Higham": "Higham", "diagonal": "Diag", "as printed": "Ours, as printed"}
    errors = {}
    for name, key in names.items():
        exp, log = methods.SYMMETRIC[key]
        some = S[:, :FEW] if exp is printed.higham_exp else S
        errors[name] = _mean(lambda X, exp=exp, log=log: exp(log(X)), some)
    return errors


def _affine(rng: np.random.Generator, count: int) -> dict[str, np.ndarray]:
    """Return the error of phi(psi(A)) by method and condition number."""
    U, V = _rotations(rng, count), _rotations(rng, count)
    A = np.zeros((*U.shape[:2], 4, 4))
    A[..., :3, :3] = (U * _spectra(rng, count)[..., None, :]) @ np.swapaxes(V, -1, -2)
    A[..., 3, 3] = 1.0
    ways: Mapping[str, _Way] = {
        "ours": lambda X: affine.psi_so(X, check=False),
        "Newton": methods.newton_psi,
        "as printed": methods.printed_psi,
    }
    return {
        name: _mean(lambda X, psi=psi: affine.phi_so(psi(X), check=False), A) for name, psi in ways.items()
    }


def _mean(again: _Way, X: np.ndarray) -> np.ndarray:
    """Return the root mean square of the relative errors for each condition number."""
    with np.errstate(all="ignore"):
        off = np.linalg.norm((again(X) - X)[..., :3, :3], axis=(-2, -1))
    relative = np.nan_to_num(off / np.linalg.norm(X[..., :3, :3], axis=(-2, -1)), nan=1.0)
    return np.sqrt(np.mean(np.minimum(relative, 1.0) ** 2, axis=-1))


def _panel(which: int, title: str, below: str, decades: Mapping[str, np.ndarray]) -> list[scene.Record]:
    box = _BOXES[which]
    left, low, width = box[:3]
    axes = Axes(box, (0.0, CONDITIONS[-1] + 1.0), (_LOWEST, _HIGHEST))
    middle = left + 0.5 * width
    corners = axes.at([0.0, axes.xlim[1], axes.xlim[1], 0.0], [-15.5, -15.5, -14.5, -14.5])
    xticks = [(d, f"$10^{{{d}}}$" if d > 1 else "$10$") for d in CONDITIONS]
    yticks = [(d, f"$10^{{{d}}}$" if d else "$1$") for d in range(-15, 1, 3)]
    records: list[scene.Record] = [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], style.BAND, material="flat"),
        *axes.frame(xticks, yticks),
        scene.Label(title, (middle, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn", halo=False),
        _marks.label(below, middle, low - 92.0, "cn"),
        _marks.label("rounding", left + width - 10.0, axes.at(0.0, -15.5)[1] - 7.0, "rt", style.MUTED),
        _marks.label(
            "no digit is right", left + width - 10.0, axes.at(0.0, 0.0)[1] + 20.0, "rn", style.MUTED
        ),
    ]
    for column, condition in enumerate(CONDITIONS):
        for level in range(_LEAST, 1):
            here = [name for name, row in decades.items() if row[column] == level]
            x, y, _ = axes.at(condition, level)
            for k, name in enumerate(here):
                records += _MARKS[name](x + _APART * (k - 0.5 * (len(here) - 1)), y)
    return records
