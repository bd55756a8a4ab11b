"""What parametrisations of Aff+(3) can do: table 2 and section 6 of Kaji and Ochiai, without the times."""

from typing import Annotated

import numpy as np

from lietool.bench import experiments, methods, tables
from lietool.figure import Drawing, Param, Plate, figure
from lietool.render import scene, style
from lietool.render.plot import number

_COLUMNS = {
    "Ours": ("ours,", r"$\varphi_{so}$"),
    "Ours, by se(3)": ("ours,", r"$\varphi_{se}$"),
    "Alexa/SAM": ("Alexa,", "SAM"),
    "Polar+DQ": ("polar,", "DQ"),
    "Polar+Grassia": ("polar,", "Grassia"),
    "Polar+quaternion": ("polar,", "slerp"),
    "Linear": ("matrix,", "linear"),
}
_ROWS = {
    "Surjectivity": "reaches all of Aff$^+$(3)",
    "Extrapolation": "extrapolates, never singular",
    "Associativity": r"$\alpha\,(\beta A) = (\alpha\beta)\,A$",
    "Powers": r"$(\alpha A)\,(\beta A) = (\alpha + \beta)\,A$",
    "Large rotation": "",
    "Rigid": "rigid stays rigid",
    "Bi-invariance": "bi-invariant",
    "Bi-invariance, SE(3)": "bi-invariant on SE(3)",
}
# Decades of the paper's errors |X - phi(psi(X))|^2.
_PRINTED_ERRORS = {"Ours": -24.7, "Alexa/SAM": 1.5, "Polar+DQ": -27.2, "Polar+Grassia": -27.1}

_LEFT, _STEP, _TOP, _DOWN = 498.0, 105.0, 742.0, 57.0
_LOW, _HIGH = 92.0, 262.0
_DISC = 14.0
# From the middle of a row down to the base line of its text.
_DROP = 10.0


@figure(
    plates={
        "KT2": Plate(
            title="What the parametrisations of affine transformations can do",
            equations=("K 2", "K 3", "K 9"),
            caption=(
                "Table 2 and section 6 of the paper, each answer found by an experiment with the blends of "
                "this library. Ringed in red: the paper's table says otherwise. Alexa's blend is an "
                "exponential, so its determinant is positive wherever it is defined; multiples associate "
                "wherever psi inverts phi, and what only Alexa's have is that they are powers. Below: the "
                "largest squared error of phi(psi(X)), here (discs and bars) and as printed (rings)."
            ),
        )
    }
)
def properties(
    turn: Annotated[float, Param("turn that a body is followed through", "deg", 1.0, 3600.0)] = 860.0,
) -> Drawing:
    """What seven ways to write affine transformations can do, each found by an experiment.

    What to look for: no column is full. Ours never fails to write a
    transformation, never blends to a singular one and tells large turns, but
    its blend depends on the coordinates; Alexa's multiples are powers, but a
    third of all matrices has no real logarithm. Red rings mark where the
    paper's table says otherwise. Below, the error of the round trip.
    """
    found = {
        method.name: {
            item.name: experiments.large_rotation(method, turn)
            if item.name == "Large rotation"
            else item.experiment(method)
            for item in experiments.PROPERTIES
        }
        for method in methods.METHODS
    }
    holds = np.array([[found[m][p].holds for m in _COLUMNS] for p in _ROWS])
    otherwise = np.array(
        [
            [experiments.PRINTED.get(m, {}).get(p, found[m][p].holds) != found[m][p].holds for m in _COLUMNS]
            for p in _ROWS
        ]
    )
    decades, without = _errors()
    records = [*_ground(), *_names(turn), *_answers(holds, otherwise), *_strip(decades), *_legend()]
    numbers = {
        "methods": list(_COLUMNS),
        "properties": list(_ROWS),
        "holds": holds,
        "paper_says_otherwise": otherwise,
        "error_decade": decades,
        "without_real_logarithm": without,
        "known_turn": [int(found[m]["Large rotation"].value) for m in _COLUMNS],
    }
    return Drawing(scene.Picture((scene.View(tuple(records)),)), numbers)


def _errors() -> tuple[list[str], int]:
    """Return the decade of every method's error, and the percentage of matrices without a real logarithm.

    Rounding errors differ a little between processors: they count as four
    decades that they are well inside of.
    """
    X = tables.affine(2000)
    decades, without = [], 0
    for method in sorted(methods.METHODS, key=lambda m: list(_COLUMNS).index(m.name)):
        error, missed = tables.round_trip(X, method.psi, method.phi)
        if missed:
            without = round(100 * missed / len(X))
            error = tables.careless_error(len(X))
        decades.append(_decade(error))
    return decades, without


def _decade(error: float) -> str:
    if error == 0.0:
        return "0"
    return "1e-30 to 1e-26" if 1e-30 < error < 1e-26 else f"1e{round(np.log10(error))}"


def _x(column: int) -> float:
    return _LEFT + _STEP * column


def _y(row: int) -> float:
    return _TOP - _DOWN * row


def _line(x0: float, y0: float, x1: float, y1: float, color: str, width: float) -> scene.Lines:
    return scene.Lines([(x0, y0, 0.0), (x1, y1, 0.0)], color, width)


def _label(text: str, x: float, y: float, anchor: str, color: str = style.INK) -> scene.Label:
    return scene.Label(text, (x, y, 0.0), color, style.SMALL_TEXT, anchor=anchor, halo=False)


def _ground() -> list[scene.Record]:
    """A band behind our columns, and a rule under every row."""
    x0, x1 = _x(0) - 0.5 * _STEP, _x(1) + 0.5 * _STEP
    corners = [(x0, _LOW - 10.0, 0), (x1, _LOW - 10.0, 0), (x1, 890.0, 0), (x0, 890.0, 0)]
    records: list[scene.Record] = [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], style.BAND, material="flat"),
        _line(30.0, _y(0) + 0.5 * _DOWN, 1180.0, _y(0) + 0.5 * _DOWN, style.INK, style.THIN),
    ]
    for row in range(1, len(_ROWS)):
        y = _y(row) + 0.5 * _DOWN
        records.append(_line(30.0, y, 1180.0, y, style.RULE, style.HAIR))
    return records


def _names(turn: float) -> list[scene.Record]:
    records: list[scene.Record] = []
    for column, (first, second) in enumerate(_COLUMNS.values()):
        records.append(_label(first, _x(column), 838.0, "cn"))
        records.append(_label(second, _x(column), 796.0, "cn"))
    for row, text in enumerate(_ROWS.values()):
        text = text or rf"knows a turn of ${number(turn, 0)}^{{\circ}}$"
        records.append(_label(text, 36.0, _y(row) - _DROP, "ln"))
    return records


def _disc(x: float, y: float, yes: bool) -> scene.Points:
    if yes:
        return scene.Points([(x, y, 0.0)], style.RIGHT, _DISC, shaded=False)
    return scene.Points([(x, y, 0.0)], style.PAPER, _DISC - 2.0, rim=style.GREYS[1], shaded=False)


def _ring(x: float, y: float, radius: float, color: str, width: float) -> scene.Lines:
    angle = np.linspace(0.0, 2.0 * np.pi, 49)
    circle = np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle), 0.0 * angle], axis=-1)
    return scene.Lines(circle, color, width)


def _answers(holds: np.ndarray, otherwise: np.ndarray) -> list[scene.Record]:
    records: list[scene.Record] = []
    for (row, column), yes in np.ndenumerate(holds):
        records.append(_disc(_x(column), _y(row), bool(yes)))
        if otherwise[row, column]:
            records.append(_ring(_x(column), _y(row), _DISC + 8.0, style.WRONG, style.CURVE))
    return records


def _strip(decades: list[str]) -> list[scene.Record]:
    """The errors on an axis of decades, those of rounding as bars, and the printed ones as rings."""

    def y(decade: float) -> float:
        return _LOW + (decade + 32.0) / 36.0 * (_HIGH - _LOW)

    records: list[scene.Record] = [_label(r"$|X - \varphi(\psi(X))|^2$", 36.0, 0.5 * (_LOW + _HIGH), "lc")]
    for decade in (0, -15, -30):
        records.append(_line(_x(0) - 0.5 * _STEP, y(decade), 1180.0, y(decade), style.RULE, style.HAIR))
        text = "$1$" if decade == 0 else f"$10^{{{decade}}}$"
        records.append(_label(text, _x(0) - 0.5 * _STEP - 12.0, y(decade), "rc"))
    for column, (name, decade) in enumerate(zip(_COLUMNS, decades, strict=True)):
        if decade == "0":
            records.append(_label("0", _x(column), y(-28.0) - _DROP, "cn"))
        elif " to " in decade:
            low, high = (y(float(part.removeprefix("1e"))) for part in decade.split(" to "))
            records.append(_line(_x(column), low, _x(column), high, style.INK, 9.0))
        else:
            at = (_x(column), y(float(decade.removeprefix("1e"))), 0.0)
            records.append(scene.Points([at], style.INK, 9.0, shaded=False))
        if name in _PRINTED_ERRORS:
            records.append(_ring(_x(column) + 24.0, y(_PRINTED_ERRORS[name]), 8.0, style.INK, style.EDGE))
    return records


def _legend() -> list[scene.Record]:
    y = 40.0
    texts = ((80.0, "yes"), (208.0, "no"), (352.0, "the paper has it otherwise"), (822.0, "error here"))
    records: list[scene.Record] = [_label(text, x, y - _DROP, "ln") for x, text in texts]
    records += [_disc(56.0, y, True), _disc(184.0, y, False), _disc(318.0, y, True)]
    records.append(_ring(318.0, y, _DISC + 8.0, style.WRONG, style.CURVE))
    records.append(_line(800.0, y - 13.0, 800.0, y + 13.0, style.INK, 9.0))
    records.append(_ring(1018.0, y, 8.0, style.INK, style.EDGE))
    records.append(_label("as printed", 1036.0, y - _DROP, "ln"))
    return records
