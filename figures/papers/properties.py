"""What parametrisations of Aff+(3) can do: table 2 and section 6 of Kaji and Ochiai, without the times."""

from typing import Annotated

import numpy as np

from lietool.bench import experiments, methods, tables
from lietool.figure import Drawing, Param, Plate, figure
from lietool.render import scene, style
from lietool.render.plot import number

from . import _marks

_COLUMNS = {
    "Ours": ("ours", r"$\varphi_{so}$"),
    "Ours, by se(3)": ("ours", r"$\varphi_{se}$"),
    "Alexa/SAM": ("Alexa", "SAM"),
    "Polar+DQ": ("polar", "DQ"),
    "Polar+Grassia": ("polar", "Grassia"),
    "Polar+quaternion": ("polar", "slerp"),
    "Linear": ("matrix", "linear"),
}
_ROWS = {
    "Surjectivity": r"reaches all of $\mathrm{Aff}^{+}\!(3)$",
    "Extrapolation": "no singular extrapolation",
    "Associativity": r"$\alpha\,(\beta A) = (\alpha\beta)\,A$",
    "Powers": r"$(\alpha A)\,(\beta A) = (\alpha + \beta)\,A$",
    "Large rotation": "",
    "Rigid": "rigid stays rigid",
    "Bi-invariance": "bi-invariant",
    "Bi-invariance, SE(3)": r"bi-invariant on $\mathrm{SE}(3)$",
}
_ERROR = r"$|X - \varphi(\psi(X))|^2$"
PRINTED_ERRORS = {"Ours": 1.936e-25, "Alexa/SAM": 32.69, "Polar+DQ": 7.025e-28, "Polar+Grassia": 7.371e-28}
"""Of the paper's table."""
ROUNDING = 1e-26
"""What no error of rounding comes near to, on any processor."""

_MARGIN, _LEFT, _STEP = 40.0, 447.0, 110.0
_TOP, _DOWN = 752.0, 57.0
_RADIUS = 14.0
# From the middle of a row down to the base line of its text.
_DROP = 10.0
_YES = _marks.disc(style.RIGHT, _RADIUS)
_NO = _marks.circle(style.GREYS[1], _RADIUS - 2.0)
_OTHERWISE = _marks.ring(style.WRONG, _RADIUS + 8.0)


@figure(
    plates={
        "KT2": Plate(
            title="What the parametrisations of affine transformations can do",
            equations=("K 2", "K 3", "K 9"),
            caption=(
                "Table 2 and section 6 of the paper, each answer found by an experiment with the blends of "
                "this library. Multiples with a from -1 to 2 and b from 0 to 1, of matrices that have a real "
                "logarithm and turn by less than 90 degrees; extrapolations of such matrices with weights "
                "1 - t and t, t from -4 to 5. Ringed in red: found otherwise within these ranges than the "
                "paper's table has it, which may mean wider ones. Errors are the largest of 2000 random "
                "matrices. The table with the times, on any machine: lietool bench table2."
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
    third of all matrices has no real logarithm. Multiples associate wherever
    psi inverts phi, and Alexa's blend is an exponential, whose determinant is
    positive. Below, the error of the round trip.
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
    # The paper's answer about large turns is about those beyond a whole one.
    compared = [p for p in _ROWS if p != "Large rotation" or turn > 360.0]
    otherwise = np.array(
        [
            [p in compared and experiments.PRINTED.get(m, {}).get(p, yes) != yes for m, yes in row]
            for p, row in ((p, [(m, found[m][p].holds) for m in _COLUMNS]) for p in _ROWS)
        ]
    )
    decades, without = _errors()
    records = [*_ground(), *_names(turn), *_answers(holds, otherwise), *_below(decades, without)]
    numbers = {
        "methods": list(_COLUMNS),
        "properties": list(_ROWS),
        "holds": holds,
        "paper_says_otherwise": otherwise,
        "error": decades,
        "without_real_logarithm": without,
        "known_turn": [int(found[m]["Large rotation"].value) for m in _COLUMNS],
    }
    return Drawing(scene.Picture((scene.View(tuple(records)),)), numbers)


def _errors() -> tuple[list[str], int]:
    """Return every method's error as text, and the percentage of matrices without a real logarithm.

    Rounding errors differ a little between processors: they are told by a bound.
    """
    X = tables.affine(2000)
    texts, without = [], 0
    for method in sorted(methods.METHODS, key=lambda m: list(_COLUMNS).index(m.name)):
        error, missed = tables.round_trip(X, method.psi, method.phi)
        if missed:
            without = round(100 * missed / len(X))
            error = tables.careless_error(len(X))
        texts.append(error_text(error))
    return texts, without


def error_text(error: float, rounding: float = ROUNDING) -> str:
    """Return an error as mathtext without the dollars: a power of ten, or that it is below `rounding`."""
    if error == 0.0:
        return "0"
    if error < rounding:
        return rf"<\!10^{{{round(np.log10(rounding))}}}"
    return number(error, 0) if error >= 1.0 else rf"10^{{{round(np.log10(error))}}}"


def _x(column: int) -> float:
    return _LEFT + _STEP * column


def _y(row: int) -> float:
    return _TOP - _DOWN * row


def _rule(row: float, color: str = style.RULE, width: float = style.HAIR) -> scene.Lines:
    return _marks.line(_MARGIN, _y(0) - _DOWN * row, 1200.0 - _MARGIN, _y(0) - _DOWN * row, color, width)


def _ground() -> list[scene.Record]:
    """A band behind our columns, and a rule under every row."""
    x0, x1 = _x(0) - 0.5 * _STEP, _x(1) + 0.5 * _STEP
    low, high = _y(len(_ROWS) + 1) - 0.5 * _DOWN, 884.0
    corners = [(x0, low, 0), (x1, low, 0), (x1, high, 0), (x0, high, 0)]
    rules = [_rule(row + 0.5) for row in range(len(_ROWS) + 1) if row != len(_ROWS) - 1]
    return [
        scene.Surface(corners, [[0, 1, 2], [0, 2, 3]], style.BAND, material="flat"),
        *rules,
        *(_rule(row, style.INK, style.THIN) for row in (-0.5, len(_ROWS) - 0.5)),
    ]


def _names(turn: float) -> list[scene.Record]:
    records: list[scene.Record] = []
    for column, (first, second) in enumerate(_COLUMNS.values()):
        records.append(_marks.label(first, _x(column), 846.0, "cn"))
        records.append(_marks.label(second, _x(column), 804.0, "cn"))
    for row, text in enumerate(_ROWS.values()):
        text = text or rf"knows a turn of ${number(turn, 0)}^{{\circ}}$"
        records.append(_marks.label(text, _MARGIN, _y(row) - _DROP, "ln"))
    return records


def _answers(holds: np.ndarray, otherwise: np.ndarray) -> list[scene.Record]:
    records: list[scene.Record] = []
    for (row, column), yes in np.ndenumerate(holds):
        records += (_YES if yes else _NO)(_x(column), _y(row))
        if otherwise[row, column]:
            records += _OTHERWISE(_x(column), _y(row))
    return records


def _below(errors: list[str], without: int) -> list[scene.Record]:
    """The errors here and as printed, what the marks mean, and what the multiples are."""
    here, there = len(_ROWS), len(_ROWS) + 1
    records: list[scene.Record] = [
        _marks.label(f"{_ERROR} here", _MARGIN, _y(here) - _DROP, "ln"),
        _marks.label("as the paper prints it", _MARGIN, _y(there) - _DROP, "ln"),
    ]
    for column, (name, text) in enumerate(zip(_COLUMNS, errors, strict=True)):
        star = "^{*}" if name == "Alexa/SAM" else ""
        records.append(_marks.label(f"${text}{star}$", _x(column), _y(here) - _DROP, "cn"))
        said = f"${error_text(PRINTED_ERRORS[name], 0.0)}$" if name in PRINTED_ERRORS else "$-$"
        records.append(_marks.label(said, _x(column), _y(there) - _DROP, "cn"))
    entries = (
        (_YES, _RADIUS, "yes", 42.0),
        (_NO, _RADIUS - 2.0, "no", 34.0),
        (lambda x, y: [*_YES(x, y), *_OTHERWISE(x, y)], _RADIUS + 8.0, "the paper has it otherwise", 344.0),
    )
    records += _marks.legend(entries, 140.0)
    note = rf"$^{{*}}$ {without} % have no real logarithm; with the real part of a complex one instead"
    return [
        *records,
        _marks.label(r"$\alpha A$  stands for  $\varphi(\alpha\,\psi(A))$", 600.0, 84.0, "cn"),
        _marks.label(note, 600.0, 40.0, "cn"),
    ]
