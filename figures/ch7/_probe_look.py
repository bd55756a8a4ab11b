"""How the shapes of `probe` look: patches of colours, pale at rest and strong when moved, eyes; or clouds."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lietool.mesh import cut, solids
from lietool.mesh.surface import Mesh
from lietool.render import mesh_lines, mesh_look, style
from lietool.render.camera import STAND, Camera
from lietool.render.scene import Record
from lietool.render.theme import Color

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Direction = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Patches:
    """The faces of a shape in groups with clean seams, by cuts one after the other."""

    faces: tuple[Index, ...]
    cuts: tuple[cut.Cut, ...] = ()

    def carry(self, x: Array) -> Array:
        """Values at the vertices (n, ...), with those at the vertices of the seams behind them."""
        for each in self.cuts:
            x = each.carry(x)
        return x


def patches(F: Index, functions: Sequence[Array]) -> Patches:
    """Return what is above 0 of each function in turn, and the rest last."""
    rest, cuts, faces = F, [], []
    for function in functions:
        values = function
        for each in cuts:
            values = each.carry(values)
        found = _along(rest, values)
        cuts.append(found)
        faces.append(found.above)
        rest = found.below
    return Patches((*faces, rest), tuple(cuts))


def _along(F: Index, values: Array) -> cut.Cut:
    """Cut a part of the faces, which does not use every vertex."""
    used = np.unique(F)
    made = cut.along(np.searchsorted(used, F), values[used])
    new = len(values) + np.arange(len(made.ends))
    place = np.append(used, new)
    return cut.Cut(used[made.ends], made.share, place[made.above], place[made.below])


def by_part(F: Index, function: Array, part: Index, count: int) -> Patches:
    """Return for each part what is above 0 of a function, then for each part the rest."""
    made = cut.along(F, function)
    owner = made.carry(part.astype(float)).round().astype(np.intp)
    groups = [f[owner[f[:, 0]] == k] for f in (made.above, made.below) for k in range(count)]
    return Patches(tuple(groups), (made,))


def own(mesh: Mesh, before: Color = style.BEFORE) -> tuple[Color, Color]:
    """Return the colours of a user's shape at rest and moved: its own where its vertices have them."""
    if mesh.colours is None:
        return before, style.AFTER
    colors = mesh_look.vertex_colors(mesh.colours)
    return colors, colors


@dataclass(frozen=True, eq=False)
class Look:
    """How a shape is shown.

    `before` and `after` are the colours of its patches, or of a cloud its points'; `eyes` are vertices;
    `lens` is its angle of view in degrees, if not the usual one; `folds` is how deep a fold must be, in
    heights of the view, to have an outline before the shape itself; an outline that is `smooth` goes across
    faces, for shapes whose faces are twisted far.
    """

    direction: Direction
    probe: float
    before: tuple[Color, ...] = (style.BEFORE,)
    after: tuple[Color, ...] = (style.AFTER,)
    patches: Patches | None = None
    edges: tuple[str, str] = (style.BEFORE_EDGE, style.AFTER_EDGE)
    eyes: tuple[int, ...] = ()
    eye: float = 0.0
    dots: float = 0.0
    stands: bool = True
    y_up: bool = False
    margin: float = 1.10
    lens: float | None = None
    folds: float = 0.0
    smooth: bool = False

    def turned(self, around: float, above: float) -> "Look":
        """Return the same, seen from elsewhere: degrees round the shape and upwards."""
        x, y, z = self.direction
        azimuth = np.arctan2(y, x) + np.radians(around)
        height = np.clip(np.arctan2(z, np.hypot(x, y)) + np.radians(above), -1.5, 1.5)
        flat = np.cos(height)
        seen = (flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(height))
        return replace(self, direction=tuple(round(float(c), 12) for c in seen))  # type: ignore[arg-type]

    def upright(self, x: Array) -> Array:
        """Return points (..., 3), or frames (..., 4, 4), as they are drawn, z up."""
        if not self.y_up:
            return x
        if x.shape[-2:] == (4, 4):
            stood = x.copy()
            stood[..., :3, :] = STAND @ x[..., :3, :]
            return stood
        return x @ STAND.T

    def body(
        self, V: Array, F: Index, camera: Camera, stage: float, ground: float | None = None
    ) -> list[Record]:
        """Return the shape with upright vertices V; at stage 0 it has not moved, at any other it has."""
        moved = stage > 0.0
        colors, edge = (self.after if moved else self.before), self.edges[int(moved)]
        if self.dots:
            return mesh_look.cloud(V, colors[0], self.dots)
        if self.patches is None:
            return [
                *self._shadow(V, F, ground),
                *mesh_look.surface(V, F, colors[0]),
                *self._outline(V, F, camera, edge),
            ]
        N = solids.normals(V, F)
        X, M = self.patches.carry(V), mesh_lines.unit(self.patches.carry(N))
        records = self._shadow(V, F, ground)
        for faces, color in zip(self.patches.faces, colors, strict=True):
            records += mesh_look.surface(X, faces, color, normals=M)
        records += self._outline(V, F, camera, edge)
        return records + mesh_look.eyes(V, N, self.eyes, self.eye)

    def _outline(self, V: Array, F: Index, camera: Camera, color: str) -> list[Record]:
        records = mesh_look.outline(V, F, camera, color)
        if self.smooth:
            facing = np.sum(solids.normals(V, F) * (camera.eye - V), axis=1)
            lines = mesh_lines.level_lines(V, F, facing, [0.0])
            return [replace(r, points=lines) for r in records]  # type: ignore[call-arg]
        # Behind its place it is hidden by what is a little behind it.
        return [replace(r, lift=-self.folds) for r in records] if self.folds else records  # type: ignore[call-arg]

    def _shadow(self, V: Array, F: Index, ground: float | None) -> list[Record]:
        return mesh_look.shadow(V, F, ground) if self.stands else []
