"""The maps by which A(t) is made, as a diagram with this example's numbers, for `triangle-interp`."""

from dataclasses import dataclass

import numpy as np

from lietool.interp import triangle
from lietool.lie import so2, sym
from lietool.render import brackets, plane, scene, style
from lietool.render.brackets import fixed

from . import _triangle_map as maps
from . import _triangle_shape as shapes

# Heights of the rows: matrices, factors, and the flat space; columns of the factors at both ends.
_TOP, _GROUP, _FLAT = 716.0, 438.0, 136.0
_COLUMNS = ((150.0, 400.0), (800.0, 1050.0))
_BAND = 196.0
# From the middle of a matrix to its name's base line, and to where arrows begin and end.
_NAME, _ABOVE, _BELOW = 58.0, 104.0, 58.0
# From the middle of a row to the base line of its space's name, below the matrices.
_SPACE = 74.0
_MATRIX = {0: 212.0, 1: 988.0}
_AS_IT_IS = r"\mathrm{as\ it\ is}"


@dataclass(frozen=True, eq=False)
class Factor:
    """One factor on its way: in the group, in the flat space at 1 and at t, and back.

    `down` and `up` are the lines of the names of the maps between; the flat values are matrices or angles.
    """

    names: tuple[str, str, str, str]
    group: tuple[np.ndarray, np.ndarray]
    flat: tuple[np.ndarray | float, np.ndarray | float]
    down: tuple[str, ...]
    up: tuple[str, ...]
    wrong: bool = False


def picture(given: maps.Map, method: str, t: float) -> scene.Picture:
    """Return the page of one method."""
    factors = _factors(given, method, t)
    spaces = _spaces(method)
    title = rf"$\mathrm{{From\ }}A\mathrm{{\ to\ }}{maps.NAMES[method]}$"
    records: list[scene.Record] = [
        *_band(_GROUP + 6.0, style.GROUP, 0.07),
        *_band(_FLAT + 6.0, style.ALGEBRA, 0.07),
        scene.Label(title, (600.0, 846.0, 0.0), style.INK, style.TITLE_TEXT, anchor="cn"),
        scene.Label(spaces[0], (600.0, _GROUP - _SPACE, 0.0), style.GROUP_TEXT, style.TEXT, anchor="cn"),
        scene.Label(spaces[1], (600.0, _FLAT - _SPACE, 0.0), style.ALGEBRA_TEXT, style.TEXT, anchor="cn"),
        *_across(t),
        *_matrices(given, method, t, len(factors)),
    ]
    for k in range(2):
        columns = _COLUMNS[k] if len(factors) == 2 else (_middle(k),)
        for x, factor in zip(columns, factors, strict=True):
            records += _column(factor, x, k)
    return scene.Picture((scene.View(tuple(records)),))


def _factors(given: maps.Map, method: str, t: float) -> tuple[Factor, ...]:
    if method in ("linear", "matrix-log"):
        both = (given.A, given.at(method, t))
        if method == "linear":
            det = float(np.linalg.det(both[1]))
            names = ("A", "A", r"(1 - t)\,I + t\,A", "A^L(t)")
            return (Factor(names, both, both, (_AS_IT_IS,), _if_regular(det, "GL"), det <= 0.0),)
        L = logarithm(given)
        names = ("A", r"\log A", r"t\,\log A", maps.NAMES[method])
        return (Factor(names, both, (L, t * L), (r"\log",), (r"\exp",)),)
    names = ("R", r"\theta", r"t\,\theta", r"R_{t\theta}")
    turn = Factor(
        names, (given.R, so2.exp(t * given.angle)), (given.angle, t * given.angle), (r"\log",), (r"\exp",)
    )
    S = given.stretches(method, np.array(t))
    if method == "logexp":
        L = sym.log(given.S)
        names = ("S", r"\log S", r"t\,\log S", "S^t")
        return turn, Factor(names, (given.S, S), (L, t * L), (r"\log",), (r"\exp",))
    names = ("S", "S", r"(1 - t)\,I + t\,S", "S(t)")
    wrong = bool(np.linalg.eigvalsh(S)[0] <= 0.0)
    up = _if_regular(float(np.linalg.det(S)), r"Sym", wrong)
    return turn, Factor(names, (given.S, S), (given.S, S), (_AS_IT_IS,), up, wrong)


def _if_regular(det: float, space: str, wrong: bool = False) -> tuple[str, ...]:
    """The map from the flat space back to a part of it, where the determinant has to be positive."""
    value = fixed(det) if abs(det) < 100.0 else f"{det:.4g}"
    if det <= 0.0 or wrong:
        sign = ">" if det > 0.0 else r"\leq"
        return rf"\notin \mathrm{{{space}}}^{{+}}(2)", rf"\mathrm{{det}} = {value} {sign} 0"
    return _AS_IT_IS, rf"\mathrm{{det}} = {value} > 0"


def logarithm(given: maps.Map) -> np.ndarray:
    """Return the real logarithm of A whose exponentials are the way by `matrix_log`.

    A = m I + Z with Z Z a multiple of I, so that A^t is even(t) I + odd(t) Z, and a small t gives its slope.
    """
    a, b = triangle.coordinates(given.A)
    size = 0.5 * np.log(np.linalg.det(given.A))
    spread = abs(b) ** 2 - a.imag**2
    root = np.sqrt(abs(spread))
    if root <= 1e-8 * abs(a.real):
        # Equal eigenvalues: the slope of the odd part is that of t / m, or the logarithm of a half turn.
        odd, turn = (1.0 / a.real, 0.0) if a.real > 0.0 else (0.0, np.pi)
    else:
        odd, turn = (np.arctan2(root, a.real) if spread < 0.0 else np.arctanh(root / a.real)) / root, 0.0
    return triangle.matrix(np.asarray(size + 1j * (turn + odd * a.imag)), np.asarray(odd * b))


def _spaces(method: str) -> tuple[str, str]:
    """Where the factors are, and the flat space in which the straight line is drawn."""
    match method:
        case "logexp":
            flat = r"$\mathfrak{so}(2) \times \mathfrak{sym}(2)$"
        case "arap":
            flat = r"$\mathfrak{so}(2) \times \mathrm{Sym}(2)$"
        case "linear":
            return r"$\mathrm{GL}^{+}(2)$", r"$\mathrm{M}(2)$"
        case _:
            return r"$\mathrm{GL}^{+}(2)$", r"$\mathfrak{gl}(2)$"
    return r"$\mathrm{SO}(2) \times \mathrm{Sym}^{+}(2)$", flat


def _band(middle: float, color: str, alpha: float) -> list[scene.Record]:
    low, high = middle - _BAND / 2.0, middle + _BAND / 2.0
    corners = [(24.0, low, 0.0), (1176.0, low, 0.0), (1176.0, high, 0.0), (24.0, high, 0.0)]
    return [scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], color, material="flat", alpha=alpha)]


def _across(t: float) -> list[scene.Record]:
    """The arrow between the values at 1 and at t."""
    ends = (_COLUMNS[0][1] + 125.0, _COLUMNS[1][0] - 125.0)
    middle, said = sum(ends) / 2.0, f"$t = {fixed(t)}$"
    return [
        *_arrow((ends[0], _FLAT), (ends[1], _FLAT), style.ALGEBRA),
        scene.Label(
            said,
            (middle, _FLAT, 0.0),
            style.ALGEBRA_TEXT,
            style.SMALL_TEXT,
            (0.0, 14.0),
            "cb",
        ),
    ]


def _arrow(start: tuple[float, float], end: tuple[float, float], color: str) -> list[scene.Record]:
    return plane.path(np.array([[*start, 0.0], [*end, 0.0]]), color, style.CURVE)


def _matrices(given: maps.Map, method: str, t: float, count: int) -> list[scene.Record]:
    """A and A(t), each beside its triangle, and the arrows to and from their factors."""
    shape = shapes.Shape.of(given)
    now = given.at(method, t)
    det = float(np.linalg.det(now))
    edge = maps.COLORS[method][0] if det > 0.0 else style.WRONG
    high = float(np.concatenate([shape.extent(np.stack([np.eye(2), given.A, now]))]).max())
    scale = 82.0 / high
    records: list[scene.Record] = []
    for k, (A, name, colors) in enumerate(
        ((given.A, "A", shapes.stage(1.0, 1.0)), (now, maps.NAMES[method], (style.PAPER, edge)))
    ):
        x, sign = _MATRIX[k], 1.0 - 2.0 * k
        if count == 1:
            # The matrix itself is the only factor, below.
            records += shape.draw(A, (_middle(k), _TOP - 30.0), scale, colors)
            continue
        records += _matrix(A, name, x, _TOP, style.INK)
        records += shape.draw(A, (x + sign * 218.0, _TOP + 6.0), scale, colors)
        for column in _COLUMNS[k]:
            outer, inner = (x + (column - x) * 0.22, _TOP - _BELOW), (column, _GROUP + _ABOVE)
            records += _arrow(inner, outer, style.INK) if k else _arrow(outer, inner, style.INK)
        said = "$A = R\\,S$" if k == 0 else f"${maps.NAMES[method]} = {_product(method)}$"
        at, anchor = (x + sign * 190.0, _TOP - 116.0, 0.0), ("lc", "rc")[k]
        records.append(scene.Label(said, at, style.INK, style.SMALL_TEXT, anchor=anchor))
    return records


def _middle(k: int) -> float:
    """Where the only factor stands."""
    return sum(_COLUMNS[k]) / 2.0


def _product(method: str) -> str:
    return r"R_{t\theta}\,S^t" if method == "logexp" else r"R_{t\theta}\,S(t)"


def _matrix(A: np.ndarray, name: str, x: float, y: float, color: str) -> list[scene.Record]:
    return [
        *brackets.matrix(A, x - brackets.width(A) / 2.0, y, color),
        scene.Label(f"${name}$", (x, y + _NAME, 0.0), color, style.TEXT, anchor="cn"),
    ]


def _column(factor: Factor, x: float, k: int) -> list[scene.Record]:
    """A factor above, its value in the flat space below, and the map between."""
    color = style.WRONG if factor.wrong and k else style.INK
    records: list[scene.Record] = []
    records += _matrix(factor.group[k], factor.names[3 * k], x, _GROUP, color)
    value, name = factor.flat[k], factor.names[1 + k]
    if isinstance(value, float):
        degrees = rf"${round(np.degrees(value), 1) + 0.0:.1f}^{{\circ}}$"
        records.append(scene.Label(degrees, (x, _FLAT, 0.0), style.ALGEBRA_TEXT, style.TEXT))
        records.append(
            scene.Label(f"${name}$", (x, _FLAT + _NAME, 0.0), style.ALGEBRA_TEXT, style.TEXT, anchor="cn")
        )
    else:
        blue = style.WRONG if factor.wrong and k else style.ALGEBRA_TEXT
        records += _matrix(np.asarray(value), name, x, _FLAT, blue)
    high, low = (x, _GROUP - _BELOW - 6.0), (x, _FLAT + _ABOVE)
    said = (factor.down, factor.up)[k]
    text = style.WRONG if factor.wrong and k else (style.ALGEBRA_TEXT, style.GROUP_TEXT)[k]
    # Towards the middle of the page where a longer name of the other factor has the room between them.
    left = x in (_COLUMNS[0][1], *_COLUMNS[1])
    y, aside, anchor = (high[1] + low[1]) / 2.0, -18.0 if left else 18.0, "rc" if left else "lc"
    up = style.WRONG if factor.wrong else style.GROUP
    records += _arrow(low, high, up) if k else _arrow(high, low, style.ALGEBRA)
    for i, words in enumerate(said):
        at = (x, y + 40.0 * ((len(said) - 1) / 2.0 - i), 0.0)
        records.append(scene.Label(f"${words}$", at, text, style.SMALL_TEXT, (aside, 0.0), anchor))
    return records
