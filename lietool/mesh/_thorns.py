"""The targets of the ball with thorns: its large thorn turned and slanted, one way and the other."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lietool.lie import so3, sym
from lietool.mesh._solid import Solid

Array = NDArray[np.float64]

# Where the thorn begins to follow its targets, and from where it follows wholly.
_THORN = (0.92, 1.9)
_ANGLE, _SHEAR, _STRETCH = np.radians(134.0), 0.3, (0.2, 0.2, 0.0)


def thorn_targets(
    ball: Solid, angle: float = _ANGLE, shear: float = _SHEAR, stretch: ArrayLike = _STRETCH
) -> tuple[Array, Array]:
    """Return the large thorn turned one way and slanted, and turned the other way and slanted back.

    At height z the thorn undergoes exp(s X) exp(s (+-Y + D)) about
    the middle of where s rises, X the turn by +-angle about z,
    Y = shear (e_x e_z^T + e_z e_x^T), D the diagonal matrix of `stretch`; s rises smoothly from 0 at the foot
    to 1, so that the ball stays as it is.

    Parameters
    ----------
    ball : Solid
        Of `thorn_ball`.
    angle : float
        In radians.
    shear : float
    stretch : array_like, shape (3,)
        Logarithms of factors along x, y and z.

    Returns
    -------
    one, two : ndarray, shape (n, 3)
    """
    middle = np.array([0.0, 0.0, 0.5 * sum(_THORN)])
    one, two = (
        np.round((A @ (ball.vertices - middle)[:, :, None])[:, :, 0] + middle, 7)
        for A in thorn_maps(ball, angle, shear, stretch)
    )
    return one, two


def thorn_maps(
    ball: Solid, angle: float = _ANGLE, shear: float = _SHEAR, stretch: ArrayLike = _STRETCH
) -> Array:
    """Return the linear maps exp(s X) exp(s (+-Y + D)) that make the targets of `thorn_targets`.

    A face with its normal does not tell them: the normal stays normal, so that what is read off a slanted
    face is turned a little beside X, and a blend of it keeps some of the slant.

    Parameters
    ----------
    ball, angle, shear, stretch
        As of `thorn_targets`.

    Returns
    -------
    ndarray, shape (2, n, 3, 3)
        At each vertex.
    """
    low, high = _THORN
    t = np.clip((ball.vertices[:, 2] - low) / (high - low), 0.0, 1.0)
    s = np.where(ball.of("small"), 0.0, t * t * (3.0 - 2.0 * t))
    D = np.diag(np.asarray(stretch, float))
    Y = shear * np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    return np.stack(
        [
            so3.exp(s[:, None] * np.array([0.0, 0.0, sign * angle]))
            @ sym.exp(s[:, None, None] * (sign * Y + D))
            for sign in (1.0, -1.0)
        ]
    )
