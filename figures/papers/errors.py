"""Errors of exp, log, phi, psi over the condition number: table 1 of Kaji and Ochiai, without the times."""

from collections.abc import Callable, Mapping
from typing import Annotated

import numpy as np

from lietool.bench import methods, printed
from lietool.figure import Drawing, Param, Plate, figure
from lietool.lie import affine, so3
from lietool.render import scene, style

CONDITIONS = tuple(range(1, 12, 2))
"""Decades."""
EDGES = (-13, -11, -9, -7, -5)
"""Of the decades of errors; rounding on another processor moves no error over one of them."""

_FEW = 6
"""Matrices for what takes them one after the other."""
_COLORS = {"ours": style.RIGHT, "Newton": style.GREYS[0], "Higham": style.GREYS[0]}
_COLORS |= {"diagonal": style.GREYS[1], "as printed": style.WRONG}
_TEXTS = {"ours": style.ALGEBRA_TEXT, "as printed": style.AXES_TEXT[0]}

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
                "Newton's iteration, and by the square root of A^T A as printed. Each dot is the largest "
                "relative error of many matrices, by the band of two decades that it lies in; lost means "
                "an error above 10^-5, or no number at all."
            ),
        )
    }
)
def errors(
    matrices: Annotated[int, Param("random matrices of each condition number", "", 10, 20000)] = 100,
    seed: Annotated[int, Param("which random matrices", "", 0, 1000)] = 1,
) -> Drawing:
    """The errors of round trips over the condition number: ours, others', and the printed formulas'.

    What to look for: our dots stay in the lowest band whatever the condition
    number. The printed formulas lose as many digits as it has on the left,
    where they subtract, and twice as many on the right, where they also form
    A^T A; Newton's iteration loses half as many.
    """
    rng = np.random.default_rng(seed)
    left = _symmetric(rng, matrices)
    right = _affine(rng, matrices)
    records = [
        *_panel(0, r"largest error of $\exp(\log S)$", left),
        *_panel(1, r"largest error of $\varphi(\psi(A))$", right),
        *_axis(),
    ]
    numbers = {
        "condition_decades": np.array(CONDITIONS),
        "log_error_at_most": {name: [_text(e) for e in row] for name, row in left.items()},
        "psi_error_at_most": {name: [_text(e) for e in row] for name, row in right.items()},
    }
    return Drawing(scene.Picture((scene.View(tuple(records)),)), numbers)


def level(error: float) -> int:
    """Return in which band an error lies: 0 below the lowest edge, and one more for each edge it passes."""
    return len(EDGES) if np.isnan(error) else sum(error > 10.0**edge for edge in EDGES)


def _text(error: float) -> str:
    band = level(error)
    return f"1e{EDGES[band]}" if band < len(EDGES) else "lost"


def _spectra(rng: np.random.Generator, count: int) -> np.ndarray:
    """Return eigenvalues 1, something between, and 1 / condition; shape (conditions, count, 3)."""
    t = rng.uniform(0.0, 1.0, (len(CONDITIONS), count))
    c = 10.0 ** np.array(CONDITIONS, float)[:, None]
    return np.stack([np.ones_like(t), c**-t, np.ones_like(t) / c], axis=-1)


def _rotations(rng: np.random.Generator, count: int) -> np.ndarray:
    return so3.exp(1.2 * rng.normal(size=(len(CONDITIONS), count, 3)))


def _symmetric(rng: np.random.Generator, count: int) -> dict[str, np.ndarray]:
    """Return the largest error of exp(log S) by method and condition number."""
    U = _rotations(rng, count)
    S = (U * _spectra(rng, count)[..., None, :]) @ np.swapaxes(U, -1, -2)
    S = 0.5 * (S + np.swapaxes(S, -1, -2))
    names = {"ours": "Ours", "Higham": "Higham", "diagonal": "Diag", "as printed": "Ours, as printed"}
    errors = {}
    for name, key in names.items():
        exp, log = methods.SYMMETRIC[key]
        some = S[:, :_FEW] if exp is printed.higham_exp else S
        errors[name] = _worst(lambda X, exp=exp, log=log: exp(log(X)), some)
    return errors


def _affine(rng: np.random.Generator, count: int) -> dict[str, np.ndarray]:
    """Return the largest error of phi(psi(A)) by method and condition number."""
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
        name: _worst(lambda X, psi=psi: affine.phi_so(psi(X), check=False), A) for name, psi in ways.items()
    }


def _worst(again: _Way, X: np.ndarray) -> np.ndarray:
    """Return the largest relative error for each condition number, nan where a single one is nan."""
    with np.errstate(all="ignore"):
        off = np.linalg.norm((again(X) - X)[..., :3, :3], axis=(-2, -1))
    return np.max(off / np.linalg.norm(X[..., :3, :3], axis=(-2, -1)), axis=-1)


_LOW, _FIRST, _BAND = 128.0, 176.0, 96.0
_WIDTH, _STARTS = 360.0, (140.0, 680.0)


def _edge(band: int) -> float:
    """The height of the lower edge of a band."""
    return _LOW if band == 0 else _LOW + _FIRST + _BAND * (band - 1)


def _x(panel: int, decade: float) -> float:
    return _STARTS[panel] + 26.0 + (decade - 1.0) / 10.0 * (_WIDTH - 52.0)


def _line(points: list[tuple[float, float]], color: str, width: float) -> scene.Lines:
    return scene.Lines([(x, y, 0.0) for x, y in points], color, width)


def _label(text: str, x: float, y: float, anchor: str, color: str = style.INK) -> scene.Label:
    return scene.Label(text, (x, y, 0.0), color, style.SMALL_TEXT, anchor=anchor, halo=False)


def _panel(panel: int, title: str, errors: Mapping[str, np.ndarray]) -> list[scene.Record]:
    left, right, top = _STARTS[panel], _STARTS[panel] + _WIDTH, _edge(len(EDGES) + 1)
    corners = [(left, _LOW, 0), (right, _LOW, 0), (right, _edge(1), 0), (left, _edge(1), 0)]
    records: list[scene.Record] = [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], style.BAND, material="flat"),
        scene.Label(title, (left, top + 30.0, 0), style.INK, style.TITLE_TEXT, anchor="ln", halo=False),
        _line([(left, _LOW), (right, _LOW)], style.INK, style.THIN),
    ]
    for band in range(1, len(EDGES) + 2):
        records.append(_line([(left, _edge(band)), (right, _edge(band))], style.RULE, style.HAIR))
    for decade in CONDITIONS:
        x = _x(panel, decade)
        records.append(_line([(x, _LOW), (x, _LOW - 7.0)], style.INK, style.THIN))
        if decade % 4 == 1:
            text = "$10$" if decade == 1 else f"$10^{{{decade}}}$"
            records.append(_label(text, x, _LOW - 42.0, "cn"))
    for track, (name, row) in enumerate(errors.items()):
        records += _curve(panel, name, row, (track + 0.5) / len(errors))
    return records


def _curve(panel: int, name: str, errors: np.ndarray, track: float) -> list[scene.Record]:
    """Dots in their bands, joined; side by side where several methods share the lowest."""
    levels = [level(float(error)) for error in errors]
    places = [
        (_x(panel, decade), _edge(band) + (track * _FIRST if band == 0 else 0.5 * _BAND))
        for decade, band in zip(CONDITIONS, levels, strict=True)
    ]
    color = _COLORS[name]
    radius = 10.0 if name == "ours" else 8.0
    dots = scene.Points([(x, y, 0.0) for x, y in places], color, radius, shaded=False)
    text_color = _TEXTS.get(name, style.INK)
    y = places[-1][1]
    right = _STARTS[panel] + _WIDTH
    if levels[-1] == len(EDGES):
        label = _label(name, right, y + 20.0, "rn", text_color)
    else:
        label = _label(name, right + 12.0, y - 10.0, "ln", text_color)
    return [_line(places, color, style.CURVE if name == "ours" else style.EDGE), dots, label]


def _axis() -> list[scene.Record]:
    """Names of the bands' edges at the left, of the conditions below."""
    records: list[scene.Record] = []
    for band, edge in enumerate(EDGES, start=1):
        records.append(_label(f"$10^{{{edge}}}$", _STARTS[0] - 14.0, _edge(band), "rc"))
    records.append(_label("lost", _STARTS[0] - 14.0, _edge(len(EDGES)) + 0.5 * _BAND - 9.0, "rn"))
    for panel, text in enumerate(("condition number of $S$", "condition number of $A$")):
        records.append(_label(text, _STARTS[panel] + 0.5 * _WIDTH, 30.0, "cn"))
    return records
