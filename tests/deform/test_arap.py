"""The polish: against libigl's, and what its energy promises."""

import igl
import numpy as np
import pytest

from lietool.deform import arap, arap_kernels
from lietool.lie import polar, quaternion, so3
from lietool.mesh import laplacian


def bar(k: int = 14, m: int = 5) -> tuple[np.ndarray, np.ndarray]:
    """A closed tube with sharp triangles, along x."""
    u, v = np.meshgrid(np.arange(k), np.arange(m), indexing="ij")
    angle = 2 * np.pi * v / m + 0.3 * u
    V = np.stack([0.5 * u, np.cos(angle), np.sin(angle)], axis=-1).reshape(-1, 3)
    i = np.arange(k * m).reshape(k, m)
    a, b = i[:-1], i[1:]
    c, d = np.roll(b, -1, 1), np.roll(a, -1, 1)
    F = np.concatenate([np.stack([a, c, b], -1).reshape(-1, 3), np.stack([a, d, c], -1).reshape(-1, 3)])
    ends = np.array([[0.0, 0, 0], [0.5 * (k - 1), 0, 0]])
    first, last = i[0], i[-1]
    caps = [[k * m, first[(j + 1) % m], first[j]] for j in range(m)]
    caps += [[k * m + 1, last[j], last[(j + 1) % m]] for j in range(m)]
    return np.vstack([V, ends]), np.vstack([F, caps])


def bent(V: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pins at both ends, and a shape in which one of them is turned and moved and all else as it was."""
    x = V[:, 0]
    pins = np.flatnonzero((x < 0.6) | (x > x.max() - 0.6))
    end = np.flatnonzero(x > x.max() - 0.6)
    moved = V.copy()
    moved[end] = (V[end] - V[end[0]]) @ so3.exp(np.array([0.4, 0.9, -0.3])).T + V[end[0]] + [0, 1, 0]
    return pins, moved


def unit(n: int) -> np.ndarray:
    """Quaternions (4, n) of no turn."""
    return np.repeat(np.eye(4)[:, :1], n, axis=1)


@pytest.mark.parametrize("rounds", [1, 2, 8])
def test_vertices_are_libigls_after_as_many_rounds(rounds):
    V, F = bar()
    pins, moved = bent(V)
    data = igl.ARAPData()
    data.energy = igl.ARAP_ENERGY_TYPE_SPOKES_AND_RIMS
    data.max_iter = rounds
    igl.arap_precomputation(V, F, 3, pins.astype(np.int64), data)
    theirs = igl.arap_solve(moved[pins], data, moved.copy())
    ours = arap.polish(arap.prepare(V, F, pins), moved, rounds).vertices
    # Its rotations are in single precision.
    np.testing.assert_allclose(ours, theirs, atol=2e-5)


def test_energy_falls_pins_stay_and_the_residual_shrinks():
    V, F = bar()
    assert (laplacian.cotangents(V, F) < -0.1).any()
    pins, moved = bent(V)
    prepared = arap.prepare(V, F, pins)
    few, many = arap.polish(prepared, moved, 5), arap.polish(prepared, moved, 300)
    assert np.array_equal(many.vertices[pins], moved[pins])
    assert many.energy.shape == (301,)
    assert np.all(np.diff(many.energy) <= 1e-12 * many.energy[0]) and many.energy[-1] >= 0.0
    assert np.array_equal(few.energy, many.energy[:6])
    assert many.residual < 0.05 * few.residual


def test_the_energy_is_that_of_the_edges():
    # Of Chao et al.: for each corner of each face half a cotangent times what each edge misses.
    V, F = bar(6, 4)
    pins, moved = bent(V)
    prepared = arap.prepare(V, F, pins)
    turned, _ = arap_kernels.rotations((prepared.sums @ moved).reshape(-1, 9), unit(len(V)))
    R = turned.reshape(-1, 3, 3).swapaxes(1, 2)
    cot = laplacian.cotangents(V, F)
    total = 0.0
    for f, face in enumerate(F):
        for corner in face:
            for k in range(3):
                i, j = face[(k + 1) % 3], face[(k + 2) % 3]
                miss = moved[j] - moved[i] - R[corner] @ (V[j] - V[i])
                total += cot[f, k] / 2 * miss @ miss / 3
    assert arap._energy(prepared, moved, turned) == pytest.approx(total, rel=1e-12)


@pytest.mark.parametrize("start", ["unit", "near", "any"])
def test_rotations_followed_are_those_of_the_singular_values(start):
    rng = np.random.default_rng(5)
    S = rng.normal(size=(9000, 3, 3)) * np.exp(rng.normal(size=(9000, 1, 1)) * 8)
    S[::7] = so3.exp(rng.normal(size=S[::7].shape[:2])) @ np.diag([1.0, 0.5, 0.0])
    S[::11] = so3.exp(2.0 * rng.normal(size=S[::11].shape[:2])) * 1e-7
    U, d, W = np.linalg.svd(S)
    sign = np.linalg.det(U @ W)
    # Where two of the singular values nearly cancel, no method tells the rotation to so many digits.
    clear = d[:, 1] + sign * d[:, 2] > 1e-2 * d[:, 0]
    assert clear.mean() > 0.9 and (sign < 0.0).mean() > 0.3
    U[:, :, 2] *= sign[:, None]
    near = polar.rotation(S, check=False) @ so3.exp(0.1 * rng.normal(size=(len(S), 3)))
    every = so3.exp(4.0 * rng.normal(size=(len(S), 3)))
    q = {"unit": unit(len(S)), "near": quaternion.from_matrix(near).T, "any": quaternion.from_matrix(every).T}
    R, found = arap_kernels.rotations(S.swapaxes(1, 2).reshape(-1, 9), np.ascontiguousarray(q[start]))
    R = R.reshape(-1, 3, 3).swapaxes(1, 2)
    assert np.abs(R - U @ W)[clear].max() <= 1e-12
    assert np.abs(np.swapaxes(R, 1, 2) @ R - np.eye(3)).max() <= 1e-14
    assert np.abs(quaternion.to_matrix(found.T) - R).max() <= 1e-14


def test_a_rigid_motion_is_the_least_and_is_kept():
    V, F = bar()
    pins, _ = bent(V)
    g = V @ so3.exp(np.array([1.0, -2.0, 0.5])).T + [3.0, 1.0, 2.0]
    done = arap.polish(arap.prepare(V, F, pins), g, 3)
    np.testing.assert_allclose(done.vertices, g, atol=1e-12)
    assert done.energy.max() <= 1e-26 * len(F) and done.residual <= 1e-13
    start = np.where(np.isin(np.arange(len(V)), pins)[:, None], g, g + 0.05 * np.sin(7 * V))
    done = arap.polish(arap.prepare(V, F, pins), start, 400)
    np.testing.assert_allclose(done.vertices, g, atol=1e-4)


def test_moving_all_by_a_rigid_g_moves_the_result_by_g():
    V, F = bar()
    pins, moved = bent(V)
    R, t = so3.exp(np.array([0.3, 2.0, 1.0])), np.array([5.0, -2.0, 1.0])
    plain = arap.polish(arap.prepare(V, F, pins), moved, 6)
    turned = arap.polish(arap.prepare(V @ R.T + t, F, pins), moved @ R.T + t, 6)
    np.testing.assert_allclose(turned.vertices, plain.vertices @ R.T + t, atol=1e-11)
    np.testing.assert_allclose(turned.energy, plain.energy, rtol=1e-10)


def test_parts_without_a_pin_keep_their_barycentres_and_lone_vertices_their_places():
    V, F = bar()
    n = len(V)
    W, G = np.vstack([V, V + np.array([0, 5.0, 0]), [[9.0, 9, 9]]]), np.vstack([F, F + n])
    pins, moved = bent(V)
    start = np.vstack([moved, 1.3 * (V + np.array([0, 5.0, 0])), [[1.0, 2, 3]]])
    done = arap.polish(arap.prepare(W, G, pins), start, 200)
    np.testing.assert_allclose(done.vertices[:n], arap.polish(arap.prepare(V, F, pins), moved, 200).vertices)
    mass = laplacian.mass(V, F)
    np.testing.assert_allclose(mass @ done.vertices[n : 2 * n], mass @ start[n : 2 * n], atol=1e-11)
    shape = done.vertices[n : 2 * n] - done.vertices[n]
    assert np.abs(np.linalg.norm(shape, axis=1) - np.linalg.norm(V - V[0], axis=1)).max() <= 1e-6
    assert np.array_equal(done.vertices[-1], [1.0, 2, 3])


def test_what_is_crushed_or_turned_inside_out_gives_no_nan():
    V, F = bar()
    pins, _ = bent(V)
    for start in (0 * V, V * [1, 1, -1], V * [1, 0, 0]):
        done = arap.polish(arap.prepare(V, F, pins), start, 4)
        assert np.isfinite(done.vertices).all() and np.isfinite(done.energy).all()
        assert np.all(np.diff(done.energy) <= 1e-9 * done.energy[0])


def test_broken_arguments_are_refused():
    V, F = bar()
    for pins, message in [
        ([0, 0], "distinct vertices; got vertex 0 twice"),
        ([len(V)], f"indices of the {len(V)} vertices, from 0; got {len(V)}"),
        ([0.5], "whole numbers of shape"),
    ]:
        with pytest.raises(ValueError, match=f"^arap.prepare: pinned must be {message}"):
            arap.prepare(V, F, pins)
    prepared = arap.prepare(V, F, [0])
    with pytest.raises(
        ValueError, match=f"^arap.polish: vertices must be the {len(V)} vertices at rest; got 3"
    ):
        arap.polish(prepared, V[:3])
    with pytest.raises(ValueError, match=r"^arap.polish: vertices must be finite; got .* at vertex 2\."):
        arap.polish(prepared, np.where(np.arange(len(V))[:, None] == 2, np.nan, V))
    for rounds in (0, 1.5):
        with pytest.raises(ValueError, match=r"^arap.polish: rounds must be a whole number, at least 1; got"):
            arap.polish(prepared, V, rounds)
    with pytest.raises(ValueError, match=r"^arap.prepare: F must be triangles with an area"):
        arap.prepare(V, np.vstack([F, [[0, 1, 1]]]), [0])
