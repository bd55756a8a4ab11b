"""All maps by rotation and stretch, and where they have no real logarithm, for `triangle-interp`."""

import numpy as np

from lietool.interp import triangle
from lietool.render import brackets, plane, scene, style
from lietool.render.brackets import fixed
from lietool.render.plot import Axes

from . import _triangle_map as maps
from . import _triangle_shape as shapes

MIDDLE = 1026.0
_BOX = (924.0, 580.0, 204.0, 172.0)
_MATRIX, _VALUES, _LOUPE = 466.0, 388.0, (MIDDLE, 184.0)
_RADIUS, _LARGER = 124.0, 4.0


def without_log(angle: float, unequal: float) -> bool:
    """Return whether A has no real logarithm, by the angle of R and (s1 - s2) / (s1 + s2) of S.

    Its eigenvalues are negative: past a quarter turn, where the sine is at most that part.
    """
    return bool(np.cos(angle) < 0.0 and np.abs(np.sin(angle)) <= unequal and unequal > 0.0)


def chart(given: maps.Map) -> list[scene.Record]:
    """All maps A by the angle of R and how unequal S stretches: where A has no real logarithm."""
    axes = Axes(_BOX, (0.0, 2.0 * np.pi), (0.0, 1.0))
    records = axes.frame(
        [(0.0, "$0$"), (np.pi, r"$\pi$"), (2.0 * np.pi, r"$2\pi$")],
        [(0.0, "$0$"), (1.0, "$1$")],
    )
    # The border of `without_log`.
    angles = np.linspace(np.pi / 2.0, 1.5 * np.pi, 121)
    low = axes.at(angles, np.abs(np.sin(angles)))
    high = axes.at(angles, np.ones(121))
    n = np.arange(120)
    faces = np.concatenate([np.stack([n, n + 1, n + 122], axis=-1), np.stack([n, n + 122, n + 121], axis=-1)])
    records.insert(
        0, scene.Surface(np.concatenate([low, high]), faces, style.WRONG, material="flat", alpha=0.16)
    )
    records.append(scene.Lines(low, style.WRONG, style.EDGE))
    a, b = (np.abs(x) for x in triangle.coordinates(given.A))
    angle = np.mod(triangle.principal_angle(given.A), 2.0 * np.pi)
    at = axes.at(angle, b / a)
    color = style.GROUP if given.has_log else style.WRONG
    none = r"$\mathrm{no\ real}\ \log A$"
    records += [
        scene.Points([axes.at(np.pi, 0.0)], style.PAPER, 7.0, rim=style.WRONG, shaded=False),
        scene.Points([at], color, 12.5, rim=style.PAPER),
        scene.Label(r"$\theta$", axes.at(2 * np.pi, 0.0), style.INK, style.SMALL_TEXT, (24.0, 0.0), "lc"),
        scene.Label(
            r"$\frac{\sigma_1 - \sigma_2}{\sigma_1 + \sigma_2}$",
            axes.at(0.0, 0.5),
            style.INK,
            style.TITLE_TEXT,
            (-16.0, 0.0),
            "rc",
        ),
        scene.Label(none, axes.at(np.pi, 1.0), style.WRONG, style.SMALL_TEXT, (0.0, 14.0), "cb"),
        scene.Label("$A$", at, style.INK, style.SMALL_TEXT, (0.0, 18.0), "cb", room=50.0),
    ]
    return records


def facts(given: maps.Map) -> list[scene.Record]:
    """The matrix and its eigenvalues."""
    left = MIDDLE - (brackets.width(given.A) + 80.0) / 2.0
    values = np.sort_complex(np.linalg.eigvals(given.A))[::-1]
    if np.abs(values.imag).max() <= 1e-9 * np.abs(values).max():
        # In braces, so that a minus after a comma is a sign.
        said = rf"$\lambda = {{{fixed(values[0].real)}}},\ {{{fixed(values[1].real)}}}$"
    else:
        said = rf"$\lambda = {fixed(values[0].real)} \pm {fixed(abs(values[0].imag))}\,i$"
    return [
        scene.Label(r"$A\ \approx$", (left, _MATRIX, 0.0), style.INK, style.TEXT, (-10.0, 0.0), "lc"),
        *brackets.matrix(given.A, left + 80.0, _MATRIX),
        scene.Label(said, (MIDDLE, _VALUES, 0.0), style.INK, style.SMALL_TEXT, anchor="cn"),
    ]


def loupe(given: maps.Map, shape: shapes.Shape, t: float, scale: float) -> list[scene.Record]:
    """A ring with larger triangles: that of A^L, or, where A has a logarithm, those of A^E and the power."""
    methods = ("logexp", "matrix-log") if given.has_log else ("linear",)
    place = plane.Plane(_LOUPE, 1.0)
    at = [given.at(method, t) for method in methods]
    reach = max(float(np.linalg.norm(shape.corners @ A.T, axis=-1).max()) for A in at)
    larger = min(_LARGER * scale, 0.88 * _RADIUS / reach)
    names = r"\mathrm{\ and\ }".join(maps.NAMES[method] for method in methods)
    said = rf"${names}\mathrm{{,\ larger}}$"
    records: list[scene.Record] = [
        place.circle((0.0, 0.0), _RADIUS, style.MUTED, style.THIN),
        scene.Label(said, (*_LOUPE, 0.0), style.INK, style.SMALL_TEXT, (0.0, _RADIUS + 16.0), "cb"),
    ]
    for method, A in zip(methods, at, strict=True):
        edge = maps.COLORS[method][0] if np.linalg.det(A) > 0.0 else style.WRONG
        if method == "matrix-log":
            records.append(shape.rim(A, _LOUPE, larger, edge, maps.DASHES[method]))
        else:
            records += shape.draw(A, _LOUPE, larger, (shapes.tint(edge), edge))
    return records
