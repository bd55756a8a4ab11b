"""The shapes that `blend` blends: ours, or those of a user's files; and the blends of them, prepared once."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from pathlib import Path

import numpy as np

from lietool.deform import shape_blend, ways
from lietool.mesh import cut as cutting
from lietool.mesh import laplacian, solids, surface, surface_io
from lietool.render import mesh_look, style

Array = np.ndarray

TONES = (style.SHELLS[0], style.SHELLS[2], style.SHELLS[1], style.ROUTE_2, style.ROUTE_1, style.BETWEEN_EDGE)
"""Of the targets, in their order; a seventh begins again."""
_FACING = (0.5, 0.866, 0.25)
# From here the thorns of the two targets lean to different sides, though the camera is not in the plane of
# either, and what is not cancelled, which lies between them, is seen from the side.
KEPT = 4
"""So many families, and ways of blending them, are kept, for the pictures of a film."""


@dataclass(frozen=True, eq=False)
class Thorn:
    """How the large thorn is turned and slanted: an angle in degrees, a shear, logarithms of stretches."""

    angle: float
    shear: float
    stretch: tuple[float, float, float]
    stated: bool


@dataclass(frozen=True, eq=False)
class Family:
    """A shape at rest, and targets with the same faces.

    Parameters
    ----------
    names : tuple of str
        Of the targets.
    rest : ndarray, shape (n, 3)
    targets : ndarray, shape (N, n, 3)
    faces : ndarray of int, shape (m, 3)
    mesh : Mesh
        The rest as it came, and for each of its vertices which of ours it is.
    place : ndarray of int
    direction : tuple of float
        From where it looks best.
    ground : bool
        Whether it stands on something.
    up : str
        Its axis that is up: "z" or "y".
    pins : tuple of int
        Vertices that go straight, such as one that never moves.
    solid : Solid, optional
        What is known of our own shapes.
    cut : Cut, optional
        Where their stripes are.
    maps : ndarray, shape (N, m, 3, 3), optional
        The linear maps of the faces, where they are known; else those with the normals.
    thorn : Thorn, optional
        How the targets are made, if they are a thorn's.
    painted : tuple of ndarray, shape (n, 4)
        Colours of the rest's and then the targets' own, None for one that has none; or nothing.
    """

    names: tuple[str, ...]
    rest: Array
    targets: Array
    faces: Array
    mesh: surface.Mesh
    place: Array
    direction: tuple[float, float, float]
    ground: bool = True
    up: str = "z"
    pins: tuple[int, ...] = ()
    solid: solids.Solid | None = None
    cut: cutting.Cut | None = None
    maps: Array | None = None
    thorn: Thorn | None = None
    painted: tuple[Array | None, ...] = ()
    _prepared: dict[str, shape_blend.Prepared] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.targets)

    def prepared(self, way: str) -> shape_blend.Prepared:
        """What a way of blending needs once."""
        if way not in self._prepared:
            self._prepared[way] = shape_blend.prepare(
                self.rest, list(self.targets), self.faces, ways.named(way), maps=self.maps, pins=self.pins
            )
        return self._prepared[way]

    def blended(self, way: str, weights: Array) -> shape_blend.Blended:
        """The shape of some weights."""
        return shape_blend.solve(self.prepared(way), weights)

    def written(self, X: Array) -> surface.Mesh:
        """A blended shape with all that the rest came with."""
        return self.mesh.moved(X[self.place])

    def upright(self, X: Array) -> Array:
        """A shape as it is drawn: its third coordinate up."""
        return X if self.up == "z" else X[..., [2, 0, 1]]

    @cached_property
    def floor(self) -> float:
        """On what all stand."""
        return float(self.upright(self.rest)[:, 2].min())


def family(
    example: str, thorn: Thorn, spacing: float, rest: Path | None, targets: tuple[Path, ...], up: str
) -> Family:
    """Return the shapes of the files where they are given, else those of the example, its triangles so large.

    Raises
    ------
    ValueError
        If only one kind of file is given, or a file is of no use; it names the file.
    """
    if rest is None and not targets:
        return _EXAMPLES[example](thorn, spacing, up)
    if rest is None or not targets:
        got = "no target" if rest is not None else "no rest"
        raise ValueError(f"rest and targets must be given together; got {got}. Name the other files too")
    if thorn.stated:
        raise ValueError("maps must be faces with shapes of your own; got stated. Leave it out")
    files = (rest, *targets)
    # A file may be written anew between two pictures.
    return _read(files, tuple(_stamp(file) for file in files), up)


def _thorn(thorn: Thorn, spacing: float, up: str) -> Family:
    return _thorned(thorn.angle, thorn.shear, thorn.stretch, thorn.stated, spacing, up)


@lru_cache(KEPT)
def _thorned(
    angle: float, shear: float, stretch: tuple[float, float, float], stated: bool, spacing: float, up: str
) -> Family:
    ball = solids.thorn_ball(spacing)
    own = np.radians(angle), shear, stretch
    F = ball.faces
    stripes = cutting.along(F, np.minimum(np.cos(3.0 * ball.around), 20.0 * ball.margin("thorn")))
    return Family(
        ("target 1", "target 2"),
        ball.vertices,
        np.stack(solids.thorn_targets(ball, *own)),
        F,
        surface.Mesh(ball.vertices, F),
        np.arange(len(ball.vertices)),
        _FACING,
        ground=False,
        up=up,
        pins=(int(np.argmin(ball.vertices[:, 2])),),
        solid=ball,
        cut=stripes,
        maps=solids.thorn_maps(ball, *own)[:, F].mean(axis=2) if stated else None,
        thorn=Thorn(angle, shear, stretch, stated),
    )


@lru_cache(KEPT)
def _animals(spacing: float, up: str) -> Family:
    beast, names = solids.animals(spacing), ("tall", "fat", "long")
    return Family(
        names,
        beast.vertices,
        np.stack([beast.targets[name] for name in names]),
        beast.faces,
        surface.Mesh(beast.vertices, beast.faces),
        np.arange(len(beast.vertices)),
        (1.0, -1.2, 0.35),
        up=up,
        solid=beast,
    )


_EXAMPLES: Mapping[str, Callable[[Thorn, float, str], Family]] = {
    "thorn": _thorn,
    "animals": lambda _, spacing, up: _animals(spacing, up),
}


def _stamp(file: Path) -> tuple[int, int]:
    about = file.stat()
    return about.st_mtime_ns, about.st_size


@lru_cache(KEPT)
def _read(files: tuple[Path, ...], stamps: tuple[tuple[int, int], ...], up: str) -> Family:
    meshes = [surface_io.read(file) for file in files]
    faces = meshes[0].faces
    for file, mesh in zip(files[1:], meshes[1:], strict=True):
        if len(mesh.faces) != len(faces):
            got = f"{len(mesh.faces)} in {file}"
            raise ValueError(f"targets must have the {len(faces)} faces of {files[0]}; got {got}")
        try:
            shape_blend.same_faces(faces, [mesh.faces])
        except ValueError as error:
            raise ValueError(str(error).replace("of target 0", f"of {file}")) from None
        if len(mesh.vertices) != len(meshes[0].vertices):
            got = f"{len(mesh.vertices)} in {file}"
            must = f"the {len(meshes[0].vertices)} vertices of {files[0]}"
            raise ValueError(f"targets must have {must}; got {got}. The shapes must correspond")
    for file, mesh in zip(files, meshes, strict=True):
        if (flat := laplacian.degenerate(mesh.vertices, faces)).any():
            got = f"none in {laplacian.named('face', flat)} of {file}"
            remedy = "Move their corners apart, or remove them from all meshes"
            raise ValueError(f"meshes must have an area in every face; got {got}. {remedy}")
    V, place = _welded(np.stack([mesh.vertices for mesh in meshes]))
    return Family(
        tuple(file.stem for file in files[1:]),
        V[0],
        V[1:],
        place[faces],
        meshes[0],
        place,
        (1.0, -0.9, 0.35),
        up=up,
        painted=tuple(_painted(mesh, place) for mesh in meshes),
    )


def _painted(mesh: surface.Mesh, place: Array) -> Array | None:
    """The colours of a mesh at places, of which each has those of its first vertex."""
    if mesh.colours is None:
        return None
    return mesh_look.vertex_colors(mesh.colours[np.unique(place, return_index=True)[1]])


def _welded(V: Array) -> tuple[Array, Array]:
    """Vertices that are at one place in all shapes made one, as files repeat them along seams."""
    rows = np.concatenate(list(V), axis=1) + 0.0
    _, first, place = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(order), np.intp)
    rank[order] = np.arange(len(order))
    return V[:, first[order]], rank[np.reshape(place, -1)]
