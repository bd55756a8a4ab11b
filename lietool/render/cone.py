"""Sym+(2) as a cone of glass in the space of symmetric matrices, and what stands in it.

A symmetric matrix is drawn at ((xx - yy) / sqrt 2, sqrt 2 xy, (xx + yy) / sqrt 2): distances are those
between matrices, the multiples of I are the axis, and det = 0 is the cone.
"""

import numpy as np

from lietool.render import plane, scene, solids, style
from lietool.render.camera import Camera
from lietool.render.globe import joined

# Of the stems of the ellipses, over the height of the view.
STEM = 0.045
# From how far above the front a section is seen, so that it is a cone still.
_ABOVE = 0.17


def drawn(S: np.ndarray) -> np.ndarray:
    """Return where symmetric matrices (..., 2, 2) are drawn; shape (..., 3)."""
    x, y, z = S[..., 0, 0] - S[..., 1, 1], 2.0 * S[..., 0, 1], S[..., 0, 0] + S[..., 1, 1]
    return np.stack([x, y, z], axis=-1) / np.sqrt(2.0)


def rim(height: float, n: int = 25) -> np.ndarray:
    """Return points (n + 1, 3) that hold the cone up to a height: its tip and a circle."""
    angle = np.linspace(0.0, 2.0 * np.pi, n)
    ring = height * np.stack([np.cos(angle), np.sin(angle), 1.0 + 0.0 * angle], axis=-1)
    return np.concatenate([ring, [[0.0, 0.0, 0.0]]])


def glass(camera: Camera, height: float) -> list[scene.Record]:
    """Return the cone up to a height, open above: wall, graticule, rim, outline, axis, name."""
    angle = np.linspace(0.0, 2.0 * np.pi, 97)
    ring = np.stack([np.cos(angle), np.sin(angle), np.ones(97)], axis=-1)
    part = np.linspace(0.0, height, 25)
    wall = part[:, None, None] * ring
    normals = np.broadcast_to(ring * (1.0, 1.0, -1.0) / np.sqrt(2.0), wall.shape)
    circles = [k * height / 4.0 * ring for k in range(1, 4)]
    generators = [np.stack([np.zeros(3), height * ring[i]]) for i in range(0, 96, 8)]
    # The lines of sight touch the cone along two of its generators.
    x, y, z = camera.eye
    aside = np.arccos(np.clip(z / np.hypot(x, y), -1.0, 1.0))
    touching = np.arctan2(y, x) + np.array([-aside, aside])
    edges = [height * np.array([[0, 0, 0], [np.cos(a), np.sin(a), 1.0]]) for a in touching]
    right = edges[int(np.argmax([camera.axes[0] @ edge[1] for edge in edges]))]
    return [
        scene.Surface(
            wall.reshape(-1, 3),
            solids.grid_faces(25, 97),
            style.SHELL_FILLS[1],
            normals.reshape(-1, 3),
            "glass",
        ),
        scene.Lines(
            joined([*circles, *generators]), style.GROUP_TEXT, style.HAIR, 0.7 * style.GRATICULE_ALPHA
        ),
        scene.Lines(joined([height * ring, *edges]), style.GROUP_TEXT, style.EDGE),
        scene.Lines([(0, 0, 0), (0, 0, height)], style.MUTED, style.THIN, 0.8, dash=(2.0, 6.0)),
        scene.Label(
            r"$\mathrm{det} = 0$", 0.5 * right[1], style.GROUP_TEXT, style.SMALL_TEXT, (16.0, -6.0), "lt"
        ),
    ]


def before(across: np.ndarray) -> tuple[float, float, float]:
    """Return the direction from which a section, across (2,) from the axis, is seen almost from the front."""
    return (float(across[1]), -float(across[0]), _ABOVE)


def section(camera: Camera, across: np.ndarray, height: float, color: str) -> list[scene.Record]:
    """Return the part in the cone of a plane through its axis: its area, and the two walls where det = 0.

    Parameters
    ----------
    camera : Camera
        From which it is seen.
    across : ndarray, shape (2,)
        A unit vector in the plane, at right angles to the axis.
    height : float
        Of the cone.
    color : str
        Of the area.
    """
    right, left = (height * np.array([*(side * across), 1.0]) for side in (1.0, -1.0))
    tip = np.zeros(3)
    # The area a little behind what lies and stands in it, which it would hide.
    behind = np.stack([tip, right, left]) - 0.08 * height * camera.axes[2]
    return [
        scene.Surface(behind, [[0, 1, 2]], color, material="flat", alpha=0.10),
        scene.Lines(np.stack([left, tip, right]), style.GROUP_TEXT, style.CURVE),
        scene.Lines(np.stack([left, right]), style.GROUP_TEXT, style.HAIR, 0.7),
    ]


def ellipses(
    camera: Camera, S: np.ndarray, size: float, colors: tuple[tuple[str, str], ...], side: float
) -> list[scene.Record]:
    """Return the disc under each matrix (n, 2, 2), facing the viewer, on a stem up (1) or down (-1)."""
    around = plane.arc((0.0, 0.0), size, 0.0, 2.0 * np.pi, 61)
    n = np.arange(1, 61)
    faces = np.stack([0 * n, n, n + 1], axis=-1)
    up = side * camera.axes[1]
    records: list[scene.Record] = []
    for at, matrix, (fill, edge) in zip(drawn(S), S, colors, strict=True):
        foot = at + STEM * camera.height * up
        middle = foot + size * float(np.linalg.norm(matrix[1])) * up
        rim = middle + plane.moved(matrix, around) @ camera.axes[:2]
        records.append(scene.Lines([at, foot], edge, style.THIN))
        records.append(scene.Surface(np.concatenate([[middle], rim]), faces, fill, material="flat"))
        records.append(scene.Lines(rim, edge, style.EDGE))
    return records


def crosses(camera: Camera, points: np.ndarray) -> list[scene.Record]:
    """Return a red cross at each point (n, 3), where a way leaves the cone."""
    across = 0.016 * camera.height * np.array([[1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0]])
    found: list[scene.Record] = []
    for point in points:
        arms = point + across @ camera.axes[:2]
        found.append(scene.Lines(joined([arms[:2], arms[2:]]), style.WRONG, style.CURVE, lift=0.03))
    return found
