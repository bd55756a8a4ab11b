"""The rotations and the energy of `arap` on components, in blocks that stay in the cache.

A rotation is followed from round to round as a quaternion.  Of a matrix S that of the nearest rotation R
maximises tr R^T S, and Newton's method finds it from the one before in two or three steps, of a few dozen
products each; decomposing S anew takes ten times as long.
"""

import numpy as np
from numpy.typing import NDArray

from lietool.lie import blocks, kernels, polar
from lietool.lie import jacobi_kernels as jacobi
from lietool.lie.blocks import Rows

Array = NDArray[np.float64]
Index = NDArray[np.intp]
Mask = NDArray[np.bool_]

_STEPS = 8
"""Of Newton's method; what has not settled then is decomposed."""

_DECIDED = 1e-5
"""The least determinant of the second derivative, over the cube of its trace: 1/27 if S is a rotation."""

_SETTLED = 1e-14
"""The square of a last step in radians, over that quotient: about what the step leaves behind."""

_FACES = 2048
"""Faces in a block: each has three rotations."""


def rotations(S: Array, q: Array) -> tuple[Array, Array]:
    """Return the rotations nearest to matrices, transposed, and their quaternions.

    Not checked for det > 0: of a reflection the nearest rotation is taken, which is what makes the energy
    least.

    Parameters
    ----------
    S : ndarray, shape (n, 9)
        The matrices, transposed.
    q : ndarray, shape (4, n)
        Quaternions of rotations to begin with.

    Returns
    -------
    R : ndarray, shape (n, 9)
    q : ndarray, shape (4, n)
    """
    R, found, left = np.empty_like(S), np.empty_like(q), []
    for start in range(0, len(S), blocks.BLOCK):
        part = slice(start, start + blocks.BLOCK)
        with np.errstate(over="ignore", under="ignore", invalid="ignore", divide="ignore"):
            found[:, part], settled = _followed(np.ascontiguousarray(S[part].T), q[:, part].copy())
            R[part] = np.array(jacobi.transpose(kernels.matrix(list(found[:, part])), 3)).T
        left.append(start + np.flatnonzero(~settled))
    if len(rest := np.concatenate(left)):
        fitted = _decomposed(S[rest].reshape(-1, 3, 3).swapaxes(1, 2))
        R[rest] = fitted.swapaxes(1, 2).reshape(-1, 9)
        found[:, rest] = np.array(kernels.quaternion(list(fitted.reshape(-1, 9).T)))
    return R, found


def _followed(S: Array, q: Array) -> tuple[Array, Mask]:
    """Return the unit quaternions of the rotations nearest to S (9, b), transposed, and which are settled.

    Where the second derivative is definite the maximum is the only one: R^T S is symmetric there, and the
    sums of any two of its eigenvalues are positive.
    """
    settled, live = np.zeros(S.shape[1], bool), np.arange(S.shape[1])
    for _ in range(_STEPS):
        every = len(live) == S.shape[1]
        now = q if every else q[:, live]
        (x, y, z), share = _step(S if every else S[:, live], now)
        turned = np.array(kernels.product([np.ones_like(x), 0.5 * x, 0.5 * y, 0.5 * z], list(now)))
        q[:, live] = turned / np.sqrt(np.sum(turned * turned, axis=0))
        definite = share > _DECIDED
        short = x * x + y * y + z * z <= _SETTLED * share
        settled[live[definite & short]] = True
        live = live[definite & ~short]
        if not len(live):
            break
    return q, settled


def _step(S: Array, q: Array) -> tuple[Rows, Array]:
    """Return the rotation vectors of a step, and how far the second derivative is from being indefinite.

    That is its determinant over the cube of its trace; 0 where it is not definite.
    """
    N = jacobi.product(kernels.matrix(list(q)), list(S), 3)
    a, b, c = N[4] + N[8], N[0] + N[8], N[0] + N[4]
    xy, xz, yz = -0.5 * (N[1] + N[3]), -0.5 * (N[2] + N[6]), -0.5 * (N[5] + N[7])
    g = (N[5] - N[7], N[6] - N[2], N[1] - N[3])
    # The inverse by cofactors.
    C = (
        b * c - yz * yz,
        xz * yz - xy * c,
        xy * yz - xz * b,
        a * c - xz * xz,
        xy * xz - a * yz,
        a * b - xy * xy,
    )
    det = a * C[0] + xy * C[1] + xz * C[2]
    trace = a + b + c
    share = np.where((a > 0.0) & (C[5] > 0.0) & (det > 0.0), det / (trace * trace * trace), 0.0)
    f = 1.0 / det
    x = f * (C[0] * g[0] + C[1] * g[1] + C[2] * g[2])
    y = f * (C[1] * g[0] + C[3] * g[1] + C[4] * g[2])
    z = f * (C[2] * g[0] + C[4] * g[1] + C[5] * g[2])
    return (x, y, z), share


def _decomposed(S: Array) -> Array:
    """Return the nearest rotations (k, 3, 3), one of them where many are as near."""
    R = polar.rotation(S, check=False)
    # Faces crushed to a line or a point, or none at all: many rotations are as near, and polar finds none.
    loss = np.max(np.abs(np.swapaxes(R, 1, 2) @ R - np.eye(3)), axis=(1, 2))
    if (crushed := ~(loss <= 1e-9)).any():
        U, _, W = np.linalg.svd(S[crushed])
        U[:, :, 2] *= np.linalg.det(U @ W)[:, None]
        R[crushed] = U @ W
    return R


def energy(faces: Index, frame: Array, J: Array, R: Array) -> float:
    """Return the energy: a third of the sum over corners of what the map of a face misses of its rotation.

    Squares of differences are summed, not the products that are left of them: near a rigid motion these
    would be all rounding.

    Parameters
    ----------
    faces : ndarray of int, shape (m, 3)
    frame : ndarray, shape (m, 6)
        Two orthonormal vectors in the plane of each face, times the root of its area.
    J : ndarray, shape (m, 6)
        To what the map of each face takes them.
    R : ndarray, shape (n, 9)
        The rotation at each vertex, transposed.

    Returns
    -------
    energy : float
    """
    total = 0.0
    for start in range(0, len(faces), _FACES):
        part = slice(start, start + _FACES)
        corners = np.ascontiguousarray(faces[part].T)
        turn = np.ascontiguousarray(R[corners.ravel()].T).reshape(9, *corners.shape)
        u, j = np.ascontiguousarray(frame[part].T), np.ascontiguousarray(J[part].T)
        for k in range(6):
            v, i = 3 * (k // 3), k % 3
            missed = turn[i] * u[v]
            missed += turn[i + 3] * u[v + 1]
            missed += turn[i + 6] * u[v + 2]
            missed -= j[k]
            total += float(np.vdot(missed, missed))
    return total / 3.0
