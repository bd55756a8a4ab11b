"""The table of `poisson`: three methods on the same edits, with what is measured."""

from collections.abc import Sequence

from lietool.figure import Drawing
from lietool.render import mesh_page, style
from lietool.render.camera import Box
from lietool.render.plot import number
from lietool.render.scene import Label, Picture, Record, View

from ._poisson_case import Case
from ._poisson_pages import FOOT, NAMES, Method, common, near, notes, shown, tone

METHODS = (
    ("geodesic", "polar-quaternion", ("geodesic weights,", "quaternions")),
    ("harmonic", "polar-quaternion", ("harmonic weights,", "quaternions")),
    ("harmonic", "phi-so", ("harmonic weights,", NAMES["phi_so"])),
)
"""The rows of table 7.1: weights, way of blending, and both in words."""

_LINES = ("mean stretch", "95 % below", "turned over")
# Where the columns begin, their pitch and width; the rows' upper end and the part of the page that they take.
_COLUMNS, _PITCH, _WIDE, _TOP, _ROWS = 208.0, 322.0, 308.0, 790.0, 712.0
_LINE, _BETWEEN = 33.0, 26.0


def table(cases: Sequence[Case], asked: Sequence[float | None], t: float) -> Drawing:
    """The three methods, each on the same edits: one row of pictures for each, and what is measured."""
    pitch = _ROWS / len(cases)
    tall = min(pitch - _LINE * (1 + len(_LINES)) - _BETWEEN, 440.0)
    boxes = [
        [(_COLUMNS + k * _PITCH, _TOP - i * pitch - tall, _WIDE, tall) for k in range(3)]
        for i in range(len(cases))
    ]
    rows = [[Method.of(case, kind, way, t) for kind, way, _ in METHODS] for case in cases]
    views: list[View] = []
    words: list[Record] = []
    for row, places, degrees in zip(rows, boxes, asked, strict=True):
        camera = near(row, places[0], 1.02)
        for m, box in zip(row, places, strict=True):
            views += shown(m, camera, box)
            words += _column(m, box, -1.0 if (degrees or 0.0) < 0.0 else 1.0)
        words += _names(places[0], degrees)
    for box, (_, _, name) in zip(boxes[0], METHODS, strict=True):
        for k, line in enumerate(name):
            at = (box[0] + 0.5 * box[2], 846.0 - 38.0 * k, 0.0)
            words.append(Label(line, at, style.INK, style.TITLE_TEXT, anchor="cn"))
    meant = "stretch: the larger of $s_1$ and $1/s_2$ of a face that is free"
    views.append(View((*words, mesh_page.legend(meant, FOOT))))
    ours = rows[-1][-1]
    found = {
        "edit" if degrees is None else f"asked {degrees:g}": {f"{m.kind}, {m.way}": m.numbers for m in row}
        for degrees, row in zip(asked, rows, strict=True)
    }
    return Drawing(
        Picture(tuple(views)),
        common(ours.case, ours.result) | found,
        ours.case.mesh.moved(ours.result.vertices),
        notes(ours.case, ours.result),
    )


def _names(box: Box, degrees: float | None) -> list[Record]:
    """What was asked for beside a row of pictures, and the names of the lines below it."""
    records: list[Record] = []
    right, middle = _COLUMNS - 10.0, box[1] + 0.5 * box[3]
    asked = () if degrees is None else ("asked for:", rf"${number(degrees, 0)}^{{\circ}}$")
    for k, line in enumerate(asked):
        at = (right, middle + 20.0 - 40.0 * k, 0.0)
        records.append(Label(line, at, style.INK, style.TEXT, anchor="rn"))
    # Without a turn of ours it is a user's mesh, of which only the guidance is followed.
    for k, line in enumerate(("guidance" if degrees is None else "turned by", *_LINES)):
        at = (right, box[1] - _LINE * (k + 1), 0.0)
        records.append(Label(line, at, style.MUTED, style.SMALL_TEXT, anchor="rn", halo=False))
    return records


def _column(m: Method, box: Box, sign: float) -> list[Record]:
    """What is measured, below a picture; turns with a sign."""
    lines = (
        rf"${number(sign * m.degrees[-1], 0)}^{{\circ}}$",
        f"{m.measured.mean:.2f}",
        f"{m.measured.most_of:.2f}",
        f"{m.measured.flipped} faces" if m.measured.flipped else "no face",
    )
    x = box[0] + 0.5 * box[2]
    return [
        Label(line, (x, box[1] - _LINE * (k + 1), 0.0), tone(m), style.SMALL_TEXT, anchor="cn", halo=False)
        for k, line in enumerate(lines)
    ]
