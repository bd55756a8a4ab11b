"""The words of figure 7.1: titles, names of the spaces, numbers, and what is what at its foot."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lietool.render import scene, style
from lietool.render.camera import Box
from lietool.render.mesh_page import legend, titles
from lietool.render.plot import number

from ._parametrise_shown import NOTHING, Shown

# The lines of titles, and of the numbers under the columns.
_TITLES, _NUMBERS = 836.0, (134.0, 98.0)
_SIDE, _ROWS = 104.0, (640.0, 290.0)
_SMALL = style.SMALL_TEXT


def maps(s: Shown) -> list[scene.Record]:
    """Between both rows, phi upwards and psi downwards."""
    low, high = _ROWS[1] + 74.0, _ROWS[0] - 60.0
    records: list[scene.Record] = []
    for x, start, stop, name, side in ((-12.0, low, high, s.symbol, -40.0), (16.0, high, low, r"\psi", 28.0)):
        at = _SIDE + x
        records.append(scene.Arrow((at, start, 0), (at, stop, 0), style.INK, 2.2, 3.4))
        records.append(
            scene.Label(f"${name}$", (at, (low + high) / 2.0, 0), style.INK, style.TITLE_TEXT, (side, 0.0))
        )
    return records


def texts(s: Shown, upper: Sequence[Box], lower: Sequence[Box]) -> list[scene.Record]:
    """What stands over the columns of boxes and under them, at their left, and at the foot of the page."""
    last = r"$\mathbf{d} = J(\mathbf{x})\,\mathbf{l}$" if s.map == "phi_se" else r"$+\ \mathbf{l}$"
    heads = (r"$S = \exp(Y)$", r"$R = \exp(X)$", last)
    space = (r"$\mathfrak{se}(3)$", r"$\times\,\mathfrak{sym}(3)$")
    if s.map == "phi_so":
        space = (r"$\mathfrak{so}(3)$", r"$\times\ \mathrm{\mathbb{R}}^3$", r"$\times\,\mathfrak{sym}(3)$")
    names = [
        scene.Label(text, (_SIDE, _ROWS[1] + 24.0 - 48.0 * k, 0), style.INK, style.TEXT)
        for k, text in enumerate(space)
    ]
    labels = [
        *(
            replace(title, position=(np.asarray(title.position)[0], _TITLES, 0.0))
            for title in titles(upper, heads)
        ),
        scene.Label(r"$\mathrm{Aff}^{+}\!(3)$", (_SIDE, _ROWS[0], 0), style.INK, style.TEXT),
        *names,
    ]
    for box, texts in zip(lower, _below(s), strict=True):
        for k, text in enumerate(texts):
            at = (box[0] + box[2] / 2.0, _NUMBERS[k], 0.0)
            labels.append(scene.Label(text, at, style.INK if k == 0 else style.MARK, _SMALL, anchor="cn"))
    return [*labels, legend(_legend(s))]


def _below(s: Shown) -> tuple[tuple[str, ...], ...]:
    """The lines under each column: what is given, and what psi answers where that is another."""
    stretch = [r"$\mathrm{eigenvalues\ of}\ Y$"]
    if not np.allclose(s.back_logs, np.sort(s.logs), atol=NOTHING):
        stretch.append(rf"$Y':\ {_triple(s.back_logs[::-1])}$")
    degrees = [rf"${_turned(s.x, '')}$"]
    moved = [rf"$\mathbf{{l}} = ({_triple(s.shift)})$"]
    if not s.same:
        degrees.append(rf"${_turned(s.back_x, chr(39))}$")
        if np.linalg.norm(s.back_shift - s.shift) > NOTHING:
            moved.append(rf"$\mathbf{{l}}' = ({_triple(s.back_shift)})$")
    return tuple(stretch), tuple(degrees), tuple(moved)


def _turned(x: np.ndarray, mark: str) -> str:
    return rf"|\mathbf{{x}}{mark}| = {number(np.degrees(np.linalg.norm(x)), 1)}^{{\circ}}"


def _triple(v: np.ndarray) -> str:
    return r",\ ".join(signed(float(x), plus="") for x in v)


def _legend(s: Shown) -> str:
    whole = (
        r"\hat{A} = \exp(\hat{X})\,\iota(\exp Y)"
        if s.map == "phi_se"
        else r"\hat{A}\,\mathbf{p} = R S\,\mathbf{p} + \mathbf{l}"
    )
    back = r"(\mathbf{x}, \mathbf{l}, Y)"
    if not s.returns:
        back = rf"(\mathbf{{x}}', \mathbf{{l}}', Y'),\ \ {s.symbol}(\psi(\hat{{A}})) \neq \hat{{A}}"
    elif not s.same:
        moved = r"\mathbf{l}'" if np.linalg.norm(s.back_shift - s.shift) > NOTHING else r"\mathbf{l}"
        back = rf"(\mathbf{{x}}', {moved}, Y),\ \ {s.symbol}(\psi(\hat{{A}})) = \hat{{A}}"
    return rf"${whole}$,   $\psi(\hat{{A}}) = {back}$"


def signed(value: float, plus: str = "+") -> str:
    """A number with two decimals and its sign."""
    text = f"{round(value, 2) + 0.0:.2f}"
    return "{-}" + text[1:] if text[0] == "-" else (plus if float(text) else "") + text
