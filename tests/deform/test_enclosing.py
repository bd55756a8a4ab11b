"""A cage for those who have none: it encloses, keeps its distance, and is one that the deformers take."""

import igl
import numpy as np
import pytest

from lietool.deform import cage, cage_checks, enclosing, green, mean_value
from lietool.mesh import topology


def ball(count: int = 800, radius: float = 1.0) -> np.ndarray:
    x = np.random.default_rng(0).normal(size=(count, 3))
    return radius * x / np.linalg.norm(x, axis=1, keepdims=True)


def star() -> np.ndarray:
    """A body with three arms."""
    t = np.linspace(0.0, 1.0, 120)[:, None]
    arms = [t * d * 3.0 for d in np.array([[1.0, 0, 0], [-0.5, 0.9, 0], [-0.4, -0.6, 0.7]])]
    return np.concatenate([ball(500, 0.7), *arms])


def holds(found: enclosing.Cage, x: np.ndarray, F: np.ndarray | None = None) -> None:
    """All that is promised."""
    V, G = cage_checks.closed("here", found.vertices, found.faces)
    assert (np.abs(igl.winding_number(V, G, x) - 1.0) < 1e-6).all()
    prepared = mean_value.prepare(x, V, G)
    np.testing.assert_allclose(prepared.coordinates @ V, x, atol=1e-9 * np.ptp(V))
    # The distance from the cage, by points strewn on it.
    share = np.random.default_rng(1).dirichlet([1.0, 1.0, 1.0], size=(len(G), 300))
    on = np.einsum("mqi,mij->mqj", share, V[G]).reshape(-1, 3)
    for p in x[:: max(1, len(x) // 60)]:
        assert np.linalg.norm(on - p, axis=1).min() >= 0.999 * found.margin


@pytest.mark.parametrize("faces", [20, 80, 200])
def test_it_encloses_and_keeps_the_margin(faces):
    x = star()
    found = enclosing.cage(x, faces=faces)
    assert len(found.faces) <= faces
    assert found.components == 1
    holds(found, x)


def test_more_faces_follow_limbs():
    x = star()
    volume = []
    for faces in (20, 80, 200):
        found = enclosing.cage(x, faces=faces)
        volume.append(cage_checks.volumes(found.vertices, found.faces, np.zeros(len(found.faces), int))[0])
    assert volume[0] > 1.3 * volume[1] > 1.3 * 1.05 * volume[2]


def test_it_is_the_same_each_time_and_goes_with_place_and_size():
    x = star()[::3]
    one, two = enclosing.cage(x, faces=60), enclosing.cage(x, faces=60)
    np.testing.assert_array_equal(one.vertices, two.vertices)
    np.testing.assert_array_equal(one.faces, two.faces)
    large = enclosing.cage(1024.0 * x + [4096.0, 0.0, 0.0], faces=60)
    holds(large, 1024.0 * x + [4096.0, 0.0, 0.0])


def test_large_triangles_are_enclosed_not_only_their_corners():
    V, F = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]), np.array([[0, 1, 2], [2, 1, 3]])
    found = enclosing.cage(V, F, faces=40)
    share = np.random.default_rng(2).dirichlet([1.0, 1.0, 1.0], size=(2, 200))
    holds(found, np.einsum("mqi,mij->mqj", share, V[F]).reshape(-1, 3))
    assert found.components == 1
    assert enclosing.cage(V, faces=60).components == 4


def test_parts_that_are_far_apart_get_cages_of_their_own():
    x = np.concatenate([ball(300, 0.3), ball(300, 0.3) + np.array([5.0, 0, 0])])
    found = enclosing.cage(x, faces=80)
    assert found.components == 2
    holds(found, x)
    number, _ = topology.components(len(found.faces), topology.edges("here", found.faces).inner)
    assert number == 2


def test_a_hollow_is_filled():
    found = enclosing.cage(ball(4000), faces=60, margin=0.02)
    assert found.components == 1
    holds(found, ball(4000))


def test_the_deformers_take_it():
    x = star()[::2]
    found = enclosing.cage(x, faces=60)
    R = np.array([[0.0, -2, 0], [2, 0, 0], [0, 0, 2]])
    for points in (
        cage.solve(cage.prepare(x, found.vertices, found.faces), found.vertices @ R.T).points,
        mean_value.solve(mean_value.prepare(x, found.vertices, found.faces), found.vertices @ R.T),
        green.solve(green.prepare(x, found.vertices, found.faces), found.vertices @ R.T),
    ):
        np.testing.assert_allclose(points, x @ R.T, atol=1e-11)


@pytest.mark.parametrize("x", [[[0.0, 0, 0], [1, 0, 0]], np.eye(3), np.linspace([0, 0, 0], [1, 2, 3], 50)])
def test_flat_and_thin_things_have_cages(x):
    found = enclosing.cage(x, faces=80, margin=0.1)
    holds(found, np.asarray(x, float))


def test_bad_input_is_refused_by_name():
    x = ball(20)
    for words, arguments, named in (
        (r"points must be finite", [np.full((3, 3), np.nan)], {}),
        (r"points must be an array of shape \(k, 3\)", [np.zeros((3, 2))], {}),
        (r"n > 0; got none", [np.zeros((0, 3))], {}),
        (r"different from each other; got 3 at one place", [np.ones((3, 3))], {}),
        (r"faces must be a whole number of 12 or more; got 4", [x], {"faces": 4}),
        (r"faces must be a whole number of 12 or more; got 20\.5", [x], {"faces": 20.5}),
        (r"margin must be [^\n]*; got 0", [x], {"margin": 0.0}),
        (r"margin must be [^\n]*; got nan", [x], {"margin": np.nan}),
        (r"F must be indices of the 20 points, from 0; got 0 to 20", [x, [[0, 1, 20]]], {}),
        (r"F must be whole numbers", [x, [[0.0, 1.0, 2.0]]], {}),
    ):
        with pytest.raises(ValueError, match=rf"^enclosing\.cage: [^\n]*{words}[^\n]*$"):
            enclosing.cage(*arguments, **named)


def test_a_kept_cage_is_the_cage(tmp_path, monkeypatch):
    monkeypatch.setenv("LIETOOL_CACHE_DIR", str(tmp_path))
    x = ball(20)
    made = enclosing.cage(x, faces=40)
    for _ in range(2):
        kept = enclosing.kept(x, faces=40)
        assert np.array_equal(kept.vertices, made.vertices) and np.array_equal(kept.faces, made.faces)
        assert (kept.margin, kept.components) == (made.margin, made.components)
    assert len(list((tmp_path / "cages").iterdir())) == 1
    # Other points, another margin, another number of faces are other cages.
    enclosing.kept(x * (1.0, 1.0, 1.0 + 1e-9), faces=40)
    enclosing.kept(x, faces=41)
    enclosing.kept(x, faces=40, margin=0.03)
    assert len(list((tmp_path / "cages").iterdir())) == 4
