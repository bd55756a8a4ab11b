"""Cameras: from a space to the page."""

from dataclasses import dataclass
from functools import cached_property
from math import radians, tan

import numpy as np
from numpy.typing import ArrayLike

Box = tuple[float, float, float, float]

STAND = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From y upwards, as many files have it, to z upwards."""


@dataclass(frozen=True)
class Camera:
    """A long lens that looks at `target` from the side of `direction`, z up.

    Parameters
    ----------
    direction : tuple of float
        From the target towards the eye; its length does not matter.
    target : tuple of float
        The point in the middle of the box.
    height : float
        What the box shows at the target, from its lower to its upper edge, in world units.
    fov : float
        Vertical angle of view, radians.
    """

    direction: tuple[float, float, float] = (1.0, 0.75, 0.5)
    target: tuple[float, float, float] = (0.0, 0.0, 0.0)
    height: float = 3.0
    fov: float = radians(17.0)

    @property
    def distance(self) -> float:
        """From the eye to the target, in world units."""
        return self.height / 2.0 / tan(self.fov / 2.0)

    @cached_property
    def axes(self) -> np.ndarray:
        """The camera's right, up and backward directions as rows; shape (3, 3)."""
        back = np.asarray(self.direction, float)
        back = back / np.linalg.norm(back)
        # Seen from straight above, the y axis takes the place of the vertical.
        up = (0.0, 0.0, 1.0) if abs(back[2]) < 1.0 - 1e-9 else (0.0, 1.0, 0.0)
        right = np.cross(up, back)
        right /= np.linalg.norm(right)
        return np.stack([right, np.cross(back, right), back])

    @cached_property
    def eye(self) -> np.ndarray:
        """Where the lens is; shape (3,)."""
        return np.asarray(self.target, float) + self.distance * self.axes[2]

    def view(self, box: Box) -> np.ndarray:
        """Return the 4 x 4 matrix from the world to the camera's space."""
        matrix = np.eye(4)
        matrix[:3, :3] = self.axes
        matrix[:3, 3] = -self.axes @ self.eye
        return matrix

    def projection(self, box: Box) -> np.ndarray:
        """Return the 4 x 4 matrix from the camera's space to clip space."""
        scale = 1.0 / tan(self.fov / 2.0)
        # Tight about the target, since a 24 bit depth buffer has to tell a line from the surface under it.
        near, far = self.distance - 3.0 * self.height, self.distance + 3.0 * self.height
        near = max(near, 0.05 * self.distance)
        matrix = np.zeros((4, 4))
        matrix[0, 0] = scale * box[3] / box[2]
        matrix[1, 1] = scale
        matrix[2, 2] = -(far + near) / (far - near)
        matrix[2, 3] = -2.0 * far * near / (far - near)
        matrix[3, 2] = -1.0
        return matrix

    def sphere_outline(self, center: ArrayLike, radius: float, n: int = 241) -> np.ndarray:
        """Return the circle on a sphere along which the lines of sight touch it.

        Parameters
        ----------
        center : array_like, shape (3,)
        radius : float
        n : int
            Number of points; the last is the first again.

        Returns
        -------
        ndarray, shape (n, 3)
        """
        toward = self.eye - np.asarray(center, float)
        distance = np.linalg.norm(toward)
        toward = toward / distance
        right = np.cross(self.axes[1], toward)
        right /= np.linalg.norm(right)
        up = np.cross(toward, right)
        angle = np.linspace(0.0, 2.0 * np.pi, n)[:, None]
        height = radius / distance
        ring = np.cos(angle) * right + np.sin(angle) * up
        return center + radius * (height * toward + np.sqrt(1.0 - height**2) * ring)


@dataclass(frozen=True)
class Page:
    """No lens: positions are page units inside the box, z towards the viewer."""

    @property
    def height(self) -> float:
        """The unit in which depths are compared."""
        return 100.0

    def view(self, box: Box) -> np.ndarray:
        """Return the 4 x 4 identity."""
        return np.eye(4)

    def projection(self, box: Box) -> np.ndarray:
        """Return the 4 x 4 matrix from page units inside the box to clip space."""
        matrix = np.diag([2.0 / box[2], 2.0 / box[3], -1e-4, 1.0])
        matrix[:2, 3] = -1.0
        return matrix


def around(
    points: ArrayLike, direction: tuple[float, float, float], box: Box, margin: float = 1.12
) -> Camera:
    """Return the camera that shows points as large as a box allows, in its middle.

    Parameters
    ----------
    points : array_like, shape (n, 3)
    direction : tuple of float
        From the points towards the eye.
    box : tuple of float
        The view's box on the page; only its shape matters.
    margin : float
        How much more than the points it shows.
    """
    points = np.asarray(points, float).reshape(-1, 3)
    camera = Camera(direction, tuple(points.mean(axis=0)), max(float(np.ptp(points, axis=0).max()), 1e-6))
    # A lens sees what is near larger, so that where the middle is depends a little on where it is put.
    for _ in range(6):
        seen = project(camera, (0.0, 0.0, box[2] / box[3], 1.0), points)[:, :2]
        low, high = seen.min(axis=0), seen.max(axis=0)
        shift = ((low + high) / 2.0 - (box[2] / box[3] / 2.0, 0.5)) * camera.height
        target = np.asarray(camera.target) + shift @ camera.axes[:2]
        part = max((high[0] - low[0]) * box[3] / box[2], high[1] - low[1])
        camera = Camera(direction, tuple(target), max(camera.height * part * margin, 1e-6))
    return camera


def project(camera: Camera | Page, box: Box, points: ArrayLike) -> np.ndarray:
    """Return where points of a view's space lie on the page.

    Parameters
    ----------
    camera : Camera or Page
    box : tuple of float
        The view's box on the page: x, y, width, height.
    points : array_like, shape (..., 3)

    Returns
    -------
    ndarray, shape (..., 3)
        Page x, page y, and the depth: the distance from the eye along the line of sight's axis.
    """
    points = np.asarray(points, float)
    view = camera.view(box)
    seen = points @ view[:3, :3].T + view[:3, 3]
    clip = np.concatenate([seen, np.ones((*seen.shape[:-1], 1))], axis=-1) @ camera.projection(box).T
    ndc = clip[..., :2] / clip[..., 3:]
    page = (ndc + 1.0) / 2.0 * np.asarray(box[2:]) + np.asarray(box[:2])
    return np.concatenate([page, -seen[..., 2:3]], axis=-1)
