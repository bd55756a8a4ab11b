"""The glyph F: closed, oriented, of the size it claims, and with no symmetry."""

from collections import Counter

import numpy as np
import pytest

from lietool.render import letter


def area(outline: np.ndarray) -> float:
    x, y = outline.T
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / 2.0)


class TestOutline:
    def test_size(self):
        outline = letter.outline()
        assert outline.shape == (10, 2)
        assert outline.max(axis=0).tolist() == [0.375, 0.5] and outline.min(axis=0).tolist() == [-0.375, -0.5]
        # Seven of the sixteenths of the square: four in the stem, two in the upper bar, one in the lower.
        assert area(outline) == pytest.approx(7 / 16)

    def test_it_has_no_symmetry(self):
        outline = {tuple(p) for p in letter.outline().tolist()}
        for matrix in ([[-1, 0], [0, 1]], [[1, 0], [0, -1]], [[-1, 0], [0, -1]], [[0, 1], [1, 0]]):
            assert {tuple(p) for p in (letter.outline() @ np.array(matrix)).tolist()} != outline


class TestSolid:
    def test_closed_and_oriented(self):
        vertices, faces, side = letter.solid()
        assert (vertices.shape, faces.shape, side.shape) == ((20, 3), (36, 3), (36,))
        edges = Counter(
            (a, b) for face in faces.tolist() for a, b in zip(face, face[1:] + face[:1], strict=True)
        )
        assert set(edges.values()) == {1}
        assert all(edges[b, a] == 1 for a, b in edges)
        assert len(vertices) - len(edges) // 2 + len(faces) == 2
        assert set(faces.ravel()) == set(range(20))

    @pytest.mark.parametrize("depth", [0.05, 0.25, 1.0])
    def test_volume(self, depth):
        vertices, faces, _ = letter.solid(depth)
        a, b, c = (vertices[faces[:, i]] for i in range(3))
        assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 == pytest.approx(7 / 16 * depth)

    def test_sides(self):
        vertices, faces, side = letter.solid()
        corners = vertices[faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert np.linalg.norm(normals, axis=-1).min() > 0
        normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
        assert (normals[side == 0] == (1, 0, 0)).all() and (normals[side == 1] == (-1, 0, 0)).all()
        assert (normals[side == 2, 0] == 0).all()
        fronts = (
            np.linalg.norm(np.cross(*np.diff(corners[side == 0], axis=1).swapaxes(0, 1)), axis=-1).sum() / 2
        )
        assert fronts == pytest.approx(7 / 16)
