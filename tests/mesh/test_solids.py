"""Solids: closed, outward, even, the same every time, and their parts are where their names say."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lietool.lie import so3, sym
from lietool.mesh import _kept, cut, particles, solids, topology
from lietool.mesh.solids import DRAFT, SOLIDS


def angles(V, F):
    """Return the angles of triangles in degrees, (m, 3)."""
    found = []
    for k in range(3):
        u, v = V[F[:, (k + 1) % 3]] - V[F[:, k]], V[F[:, (k + 2) % 3]] - V[F[:, k]]
        cosine = np.sum(u * v, axis=1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
        found.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return np.stack(found, axis=1)


def volume(V, F):
    a, b, c = V[F[:, 0]], V[F[:, 1]], V[F[:, 2]]
    return float(np.sum(a * np.cross(b, c)) / 6.0)


def check_closed(V, F, pieces=1):
    F = topology.faces("test", F, len(V))
    edges = topology.edges("test", F)
    assert (edges.sides >= 0).all()
    assert topology.components(len(V), edges.ends)[0] == pieces
    assert len(V) - len(edges.ends) + len(F) == 2 * pieces
    assert volume(V, F) > 0.0


@pytest.mark.parametrize("name", SOLIDS)
def test_closed_outward_and_even(name):
    solid = SOLIDS[name](DRAFT)
    V, F = solid.vertices, solid.faces
    check_closed(V, F)
    least = angles(V, F).min(axis=1)
    assert np.mean(least < 20.0) < 0.001
    assert np.percentile(least, 1.0) > 28.0
    # A vertex normal points to the side of its triangles that is outside.
    middle = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    assert (np.sum(middle[:, None] * solid.normals[F], axis=2) > 0.0).mean() > 0.999
    np.testing.assert_allclose(np.linalg.norm(solid.normals, axis=1), 1.0, atol=1e-12)


@pytest.mark.parametrize("name", SOLIDS)
def test_parts_and_marks(name):
    solid = SOLIDS[name](DRAFT)
    n = len(solid.vertices)
    assert solid.part.shape == solid.along.shape == solid.around.shape == (n,)
    assert solid.part.max() < len(solid.parts)
    assert solid.along.min() >= 0.0
    assert solid.along.max() <= 1.0
    assert np.abs(solid.around).max() <= np.pi + 1e-6
    assert all(0 <= vertex < n for vertex in solid.marks.values())
    assert all(name in solid.parts or name == "bar" for name in solid.axes)
    for target in solid.targets.values():
        assert target.shape == (n, 3)
        check_closed(target, solid.faces)


def test_the_same_in_another_process_and_from_the_cache(tmp_path: Path):
    code = (
        "import hashlib; from lietool.mesh import solids; s = solids.bar(0.12);"
        "print(hashlib.sha256(b''.join(x.tobytes() for x in (s.vertices, s.faces, s.along))).hexdigest())"
    )
    seen = set()
    # Made, then read; and made again where nothing can be kept.
    for folder in (tmp_path / "a", tmp_path / "a", tmp_path / "b"):
        result = subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            check=True,
            timeout=120,
            env={"LIETOOL_CACHE_DIR": str(folder), "PYTHONPATH": ":".join(sys.path), "PATH": ""},
        )
        seen.add(result.stdout)
    assert len(seen) == 1
    assert len(list((tmp_path / "a" / "solids").iterdir())) == 1


def test_a_torn_cache_is_made_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("LIETOOL_CACHE_DIR", str(tmp_path))
    made = []

    def make():
        made.append(1)
        return {"x": np.arange(3.0)}

    assert _kept.kept("thing", make)["x"].tolist() == [0.0, 1.0, 2.0]
    assert _kept.kept("thing", make)["x"].tolist() == [0.0, 1.0, 2.0]
    assert len(made) == 1
    [file] = (tmp_path / "solids").iterdir()
    for broken in (b"", b"PK\x03\x04", file.read_bytes()[:-30]):
        file.write_bytes(broken)
        assert _kept.kept("thing", make)["x"].tolist() == [0.0, 1.0, 2.0]
    assert len(made) == 4
    assert not _kept.kept("thing", make)["x"].flags.writeable


def test_octopus_has_eight_separate_arms():
    solid = solids.octopus(DRAFT)
    arms = [f"arm {k}" for k in range(8)]
    assert [part for part in solid.parts if part.startswith("arm")] == arms
    pairs = topology.edges("test", solid.faces).ends
    # Beyond its root no arm touches another.
    for arm in arms:
        far = solid.of(arm) & (solid.along > 0.25)
        assert far.sum() > 100
        for other in (solid.of(name) for name in arms if name != arm):
            assert not (far[pairs[:, 0]] & other[pairs[:, 1]]).any()
            assert not (far[pairs[:, 1]] & other[pairs[:, 0]]).any()
    for k in range(8):
        tip = solid.marks[f"tip {k}"]
        assert solid.parts[solid.part[tip]] == f"arm {k}"
        assert solid.along[tip] > 0.97
    # Under a lying arm the angle is 0: the vertices there look down.
    under = solid.of("arm 2") & (np.abs(solid.around) < 0.5) & (solid.along > 0.2) & (solid.along < 0.6)
    assert solid.normals[under, 2].max() < -0.5


def test_thorn_targets():
    ball = solids.thorn_ball(DRAFT)
    V, F = ball.vertices, ball.faces
    one, two = ball.targets["one"], ball.targets["two"]
    still = V[:, 2] < 0.92
    assert still.mean() > 0.5
    np.testing.assert_allclose(one[still], V[still], atol=2e-7)
    np.testing.assert_allclose(two[still], V[still], atol=2e-7)
    # Above, the map is linear: its polar rotation is the stated angle about z.
    top = (V[:, 2] > 1.92) & ball.of("thorn")
    for target, sign in ((one, 1.0), (two, -1.0)):
        A = np.linalg.lstsq(V[top] - V[top].mean(axis=0), target[top] - target[top].mean(axis=0), rcond=None)[
            0
        ].T
        U, _, W = np.linalg.svd(A)
        np.testing.assert_allclose(so3.log(U @ W), [0.0, 0.0, sign * np.radians(134.0)], atol=1e-4)
    same, again = solids.thorn_targets(ball, 0.0, 0.0, (0.0, 0.0, 0.0))
    np.testing.assert_allclose(same, V, atol=2e-7)
    np.testing.assert_allclose(again, V, atol=2e-7)
    assert (angles(one, F).min(axis=1) > 2.0).all()


def test_animals_stand_on_the_ground_and_differ():
    family = solids.animals(DRAFT)
    assert list(family.targets) == ["tall", "fat", "long", "bent"]
    shapes = {"rest": family.vertices, **family.targets}
    for shape in shapes.values():
        assert abs(shape[:, 2].min()) < 1e-6
        assert (angles(shape, family.faces).min(axis=1) > 4.0).all()
    height = {name: np.ptp(shape[:, 2]) for name, shape in shapes.items()}
    assert height["tall"] > 1.4 * height["rest"]
    assert height["long"] > 1.25 * height["rest"]
    assert volume(shapes["fat"], family.faces) > 1.8 * volume(shapes["rest"], family.faces)


def test_bar_knows_its_sides():
    bar = solids.bar(DRAFT)
    middle = bar.vertices[:, 2] > 0.2
    outward = {
        "front": (0, 1),
        "left": (1, 1),
        "back": (0, -1),
        "right": (1, -1),
        "top": (2, 1),
        "bottom": (2, -1),
    }
    for name, (axis, sign) in outward.items():
        mine = bar.of(name) & (middle | (axis == 2))
        assert np.median(sign * bar.normals[mine, axis]) > 0.95


@pytest.mark.parametrize("name", SOLIDS)
def test_margins_tell_the_parts_apart(name):
    solid = SOLIDS[name](DRAFT)
    for k, part in enumerate(solid.parts):
        if sum(other.startswith(part) for other in solid.parts) == 1:
            margin = solid.margin(part)
            assert (margin[solid.part == k] > -2e-6).all()
            assert (margin[solid.part != k] < 2e-6).all()


def test_strings():
    rope = solids.strings()
    check_closed(rope.vertices, rope.faces, pieces=4)
    assert rope.parts == ("string 0", "string 1", "string 2", "string 3")
    least = angles(rope.vertices, rope.faces).min(axis=1)
    assert np.mean(least < 20.0) < 0.02
    assert np.percentile(least, 10.0) > 55.0
    assert np.ptp(rope.vertices[:, 2]) == pytest.approx(4.0)
    for k, name in enumerate(rope.parts):
        off = rope.vertices[rope.part == k, :2] - rope.axes[name][0, :2]
        assert np.linalg.norm(off, axis=1).max() == pytest.approx(0.10)


def test_particles():
    for make in (particles.disc, particles.block):
        cloud, same, other = make(), make(), make(seed=2)
        assert np.array_equal(cloud.points, same.points)
        assert not np.array_equal(cloud.points, other.points)
        assert sorted(set(cloud.strip.tolist())) == list(range(cloud.strips))
        share = np.bincount(cloud.strip) / len(cloud.strip)
        np.testing.assert_allclose(share, 1.0 / cloud.strips, rtol=0.05)
    assert np.linalg.norm(particles.disc().points[:, :2], axis=1).max() < 1.02


def test_cut_keeps_the_surface_and_follows_the_level():
    solid = solids.bar(0.15)
    V, F = solid.vertices, solid.faces
    values = np.sin(3.0 * V[:, 2]) + V[:, 0]
    made = cut.along(F, values)
    W, level = made.carry(V), made.carry(values)
    whole = np.concatenate([made.above, made.below])
    check_closed(W, whole)
    assert volume(W, whole) == pytest.approx(volume(V, F), rel=1e-12)
    assert level[made.above].min() > -2e-3
    assert level[made.below].max() < 2e-3
    nothing = cut.along(F, np.ones(len(V)))
    assert len(nothing.ends) == len(nothing.below) == 0
    assert np.array_equal(nothing.carry(V), V)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (
            lambda: solids.octopus(0.001),
            r"solids\.octopus: spacing must be a number, 0\.015 to 0\.15; got 0\.001",
        ),
        (lambda: solids.thorn_ball(float("nan")), r"solids\.thorn_ball: spacing must be .* got nan"),
        (lambda: solids.strings(0), r"solids\.strings: count must be a whole number, 1 to 100; got 0"),
        (lambda: solids.strings(4, 5), r"solids\.strings: around must be a whole number, 6 to 200; got 5"),
        (lambda: particles.disc(0), r"particles\.disc: count must be a whole number"),
        (
            lambda: particles.block(thickness=-1.0),
            r"particles\.block: thickness must be 0 or more; got -1\.0",
        ),
        (lambda: cut.along([[0, 1, 2]], [1.0, np.nan, 0.0]), r"cut\.along: values must be finite"),
        (lambda: cut.along([[0, 1, 5]], [1.0, 2.0, 0.0]), r"cut\.along: F must be indices of the 3 vertices"),
    ],
)
def test_refusals(call, words):
    with pytest.raises(ValueError, match=words):
        call()


def test_thorn_maps_are_the_stated_ones():
    ball = solids.thorn_ball(DRAFT)
    maps = solids.thorn_maps(ball)
    whole = (ball.vertices[:, 2] > 1.9) & ball.of("thorn")
    Y, D = 0.3 * np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), np.diag([0.2, 0.2, 0.0])
    for A, sign in zip(maps, (1.0, -1.0), strict=True):
        expected = so3.exp([0.0, 0.0, sign * np.radians(134.0)]) @ sym.exp(sign * Y + D)
        np.testing.assert_allclose(A[whole], np.broadcast_to(expected, A[whole].shape), atol=1e-12)
        np.testing.assert_allclose(A[ball.of("small")], np.broadcast_to(np.eye(3), A[ball.of("small")].shape))
