"""Files of probes: what the documentation shows is read, and every mistake is named by probe and key."""

import json
import textwrap
from pathlib import Path

import numpy as np
import pytest

from lietool.deform import move, probe, probe_io, ways
from lietool.lie import so3


def documented() -> list[str]:
    """The examples of the module's head: what is indented after two colons."""
    assert probe_io.__doc__
    blocks = probe_io.__doc__.split("::\n")[1:]
    lines = [block.splitlines() for block in blocks]
    ends = [
        next((i for i, line in enumerate(ls) if line and not line.startswith("    ")), len(ls))
        for ls in lines
    ]
    return [textwrap.dedent("\n".join(ls[:end])) for ls, end in zip(lines, ends, strict=True)]


def read(tmp_path: Path, text: str, name: str = "p.toml") -> probe_io.Probes:
    file = tmp_path / name
    file.write_text(text)
    return probe_io.read(file)


def example(tmp_path: Path) -> tuple[probe_io.Probes, probe_io.Poses]:
    probes, poses, _ = documented()
    (tmp_path / "poses.toml").write_text(poses)
    found = read(tmp_path, probes)
    return found, probe_io.read_poses(tmp_path / "poses.toml", found)


def test_the_documented_weights(tmp_path):
    found = read(tmp_path, documented()[2])
    assert found.weights is not None and found.weights.data == {"kind": "harmonic"}
    (handle,) = found.handles
    assert handle is not None and handle.data == {"ball": {"centre": [0, 0, 2], "radius": 0.3}}


def test_the_documented_probes(tmp_path):
    probes, _ = example(tmp_path)
    assert probes.names == ("root", "tip", "side")
    np.testing.assert_array_equal(probes.rest[0], np.eye(4))
    np.testing.assert_array_equal(probes.current[0], np.eye(4))
    np.testing.assert_allclose(probes.rest[1, :3, :3], so3.rotation("z", np.radians(30)), atol=1e-15)
    np.testing.assert_array_equal(probes.rest[1, :3, 3], [0, 0, 2])
    A = probes.current[1] @ np.linalg.inv(probes.rest[1])
    np.testing.assert_allclose(
        A[:3, :3], so3.rotation("z", np.radians(20)) @ np.diag([1, 1, 1.5]), atol=1e-15
    )
    np.testing.assert_allclose(probes.current[1, :3, 3], [0, 0, 2.5])
    np.testing.assert_array_equal(probes.turns[1], [0, 0, 1])
    np.testing.assert_array_equal(probes.current[2, :3, :3], so3.rotation("z", np.pi / 2).round())
    np.testing.assert_array_equal(probes.stated, [True, True, False])


def test_the_documented_poses_turn_as_far_as_they_say(tmp_path):
    probes, poses = example(tmp_path)
    assert poses.fps == 24.0 and poses.frames.shape == (2, 3, 4, 4)
    prepared = probe.prepare(np.zeros((5, 3)), probes.rest, np.full((5, 3), 1 / 3))
    track = probe.follow(prepared, poses.frames, poses.turns, poses.stated)
    z = [pose.params[1, 2] for pose in track.poses]
    np.testing.assert_allclose(z, np.radians([180.0, 400.0]))
    assert [(step.frame, step.probe) for step in track.steps] == [(1, 1)]
    np.testing.assert_array_equal(poses.frames[0, 2], probes.current[2])
    np.testing.assert_array_equal(poses.frames[1, 2, :3, 3], [1, 1, 0])
    assert np.all(np.isfinite(move.solve(prepared.anchored, track.poses[1]).points))


def test_json_is_the_same(tmp_path):
    import tomllib

    text = documented()[0]
    a, b = read(tmp_path, text), read(tmp_path, json.dumps(tomllib.loads(text)), "p.json")
    assert a.names == b.names
    for name in ("rest", "current", "turns", "stated"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name))


@pytest.mark.parametrize(
    "degrees", [0, 20, 180, -180, 179.999, 180.001, 270, 360, -360, 380, 540, 720, -900, 1e6]
)
@pytest.mark.parametrize("axis", [[0, 0, 1], [0, 0, -2], [1, -2, 3e-3]])
def test_degrees_become_the_rotation_vector(tmp_path, degrees, axis):
    probes = read(
        tmp_path, f"[[probe]]\ncentre = [1, 2, 3]\ncurrent = {{ axis = {axis}, degrees = {degrees} }}"
    )
    prepared = probe.prepare(np.zeros((1, 3)), probes.rest, [[1.0]])
    pose, _ = probe.pose(prepared, probes.current, ways.PHI_SO, probes.turns)
    expected = np.radians(degrees) * np.array(axis) / np.linalg.norm(axis)
    np.testing.assert_allclose(pose.params[0, :3], expected, atol=1e-12 * max(1.0, abs(degrees)))
    np.testing.assert_allclose(pose.params[0, 3:], 0.0, atol=1e-14)


def test_stretches(tmp_path):
    head = "[[probe]]\ncentre = [1, 0, 0]\nrotation = { axis = [0, 0, 1], degrees = 45 }\n"
    A = {}
    for words in (
        "scale = 2",
        "scale = [2, 2, 2]",
        "scale = [2, 1, 1]",
        "stretch = [[2, 0, 0], [0, 1, 0], [0, 0, 1]]",
    ):
        probes = read(tmp_path, head + f"current = {{ {words} }}")
        A[words] = (probes.current @ np.linalg.inv(probes.rest))[0]
        np.testing.assert_array_equal(probes.current[0, :3, 3], [1, 0, 0])
    np.testing.assert_array_equal(A["scale = 2"], A["scale = [2, 2, 2]"])
    np.testing.assert_allclose(A["scale = 2"][:3, :3], 2 * np.eye(3), atol=1e-15)
    np.testing.assert_allclose(A["scale = [2, 1, 1]"][:2, :2], [[1.5, 0.5], [0.5, 1.5]], atol=1e-15)
    np.testing.assert_allclose(
        A["stretch = [[2, 0, 0], [0, 1, 0], [0, 0, 1]]"][:3, :3], np.diag([2.0, 1, 1]), atol=1e-15
    )


def test_turns_beside_a_matrix(tmp_path):
    text = "[[probe]]\ncentre = [0, 0, 0]\n[probe.current]\naxis = [0, 0, 2]\nturns = -3\nmatrix = "
    probes = read(tmp_path, text + str(np.eye(4).tolist()))
    np.testing.assert_array_equal(probes.turns, [[0, 0, -3]])
    assert probes.stated.all()


def test_words_on_the_command_line():
    probes = probe_io.from_words(
        ["centre=0,0,0", "name=tip centre=0,0,2 axis=0,0,1 degrees=380 translation=1,0,0"]
    )
    assert probes.names == ("1", "tip")
    np.testing.assert_array_equal(probes.turns[1], [0, 0, 1])
    np.testing.assert_array_equal(probes.current[1, :3, 3], [1, 0, 2])


HEAD = "[[probe]]\ncentre = [0, 0, 0]\n[[probe]]\nname = 'tip'\n"
AT = "centre = [0, 0, 1]\n"
EYE = str(np.eye(4).tolist())
SHEARED = str((np.eye(4) + np.eye(4, k=1) * [0, 1, 0, 0]).tolist())
FLAT = str(np.diag([1.0, 1.0, 0.0, 1.0]).tolist())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"p\.toml must be a file with something in it; got an empty one"),
        ("x = ", r"p\.toml must be a TOML file; got Invalid value \(at end of document\)"),
        ("x = 1\nx = 2", r"p\.toml must be a TOML file; got Cannot overwrite a value"),
        ("x = 1", r"p\.toml must be a table of probe, weights; got the key 'x'"),
        ("probe = []", r"p\.toml, probe must be a file of probes, with at least one \[\[probe\]\]; got none"),
        ("[probe]\ncentre = [0, 0, 0]", r"p\.toml, probe must be a file of probes.*; got a table"),
        (
            "probe = [1]",
            r"p\.toml, probe 1, probe 1 must be a table; got 1|p\.toml, probe 1 must be a table; got 1",
        ),
        (HEAD, r"p\.toml, probe 2 \(tip\) must be given a centre or a frame; got neither"),
        (
            HEAD + "centre = [0, 1]",
            r"p\.toml, probe 2 \(tip\), centre must be a list of 3 numbers; got \[0, 1\]",
        ),
        (HEAD + "centre = [0, 1, 'x']", r"probe 2 \(tip\), centre must be a list of 3 numbers"),
        (HEAD + "centre = [0, 1, true]", r"probe 2 \(tip\), centre must be a list of 3 numbers"),
        (HEAD + "centre = [0, [1], 2]", r"probe 2 \(tip\), centre must be a list of 3 numbers"),
        (HEAD + "centre = [0, 1, nan]", r"probe 2 \(tip\), centre must be finite"),
        (HEAD + "centre = [0, 1, inf]", r"probe 2 \(tip\), centre must be finite"),
        (HEAD + f"centre = [0, 1, {10**400}]", r"probe 2 \(tip\), centre must be"),
        (
            HEAD + AT + "center = 1",
            r"probe 2 \(tip\) must be a table of name, centre, .*; got the key 'center'",
        ),
        (HEAD + AT + f"frame = {EYE}", r"probe 2 \(tip\), centre must be left out beside frame"),
        (HEAD + f"frame = {FLAT}", r"probe 2 \(tip\), frame must be invertible; got singular values"),
        (
            HEAD + f"frame = {np.ones((4, 4)).tolist()}",
            r"probe 2 \(tip\), frame must be an affine matrix, last row 0 0 0 1",
        ),
        (HEAD + "frame = [[1, 0], [0, 1]]", r"probe 2 \(tip\), frame must be 4 rows of 4"),
        (
            HEAD + AT + "rotation = [[2, 0, 0], [0, 1, 0], [0, 0, 1]]",
            r"probe 2 \(tip\), rotation must be a rotation",
        ),
        (
            HEAD + AT + "rotation = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]]",
            r"probe 2 \(tip\), rotation must be a rotation",
        ),
        (
            HEAD + AT + "rotation = { axis = [0, 0, 0], degrees = 1 }",
            r"probe 2 \(tip\), rotation, axis must be an axis different from 0",
        ),
        (
            HEAD + AT + "rotation = { degrees = 1 }",
            r"probe 2 \(tip\), rotation, axis must be given beside degrees",
        ),
        (
            HEAD + AT + "current = 1",
            r"probe 2 \(tip\), current must be a table|probe 2 \(tip\), current, current must be a table",
        ),
        (
            HEAD + AT + "current = { angle = 1 }",
            r"probe 2 \(tip\), current must be a table of axis, .*; got the key 'angle'",
        ),
        (
            HEAD + AT + "current = { degrees = '20' }",
            r"probe 2 \(tip\), current, degrees must be a number; got '20'",
        ),
        (
            HEAD + AT + "current = { axis = [0, 0, 1], turns = 0.5 }",
            r"probe 2 \(tip\), current, turns must be a whole number; got 0\.5",
        ),
        (
            HEAD + AT + "current = { axis = [0, 0, 1], degrees = 1e12 }",
            r"probe 2 \(tip\), current, degrees must be at most 1e9",
        ),
        (
            HEAD + AT + "current = { axis = [0, 0, 1] }",
            r"current, axis must be left out, or given degrees or turns beside it; got \[0, 0, 1\]",
        ),
        (
            HEAD + AT + "current = { scale = 1e300 }",
            r"current, scale must be at most 1e\+150 in size, a number or a list of 3 numbers; got 1e\+300",
        ),
        (HEAD + AT + "current = { scale = -1 }", r"probe 2 \(tip\), current, scale must be above 0; got -1"),
        (
            HEAD + AT + "current = { scale = [1, 2] }",
            r"current, scale must be a number or a list of 3 numbers",
        ),
        (
            HEAD + AT + "current = { scale = 1, stretch = 1 }",
            r"current, scale must be left out beside stretch",
        ),
        (
            HEAD + AT + "current = { stretch = [[1, 1, 0], [0, 1, 0], [0, 0, 1]] }",
            r"current, stretch must be symmetric",
        ),
        (
            HEAD + AT + "current = { stretch = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]] }",
            r"current, stretch must be positive definite",
        ),
        (
            HEAD + AT + f"current = {{ matrix = {EYE}, degrees = 3 }}",
            r"current, degrees must be left out beside matrix",
        ),
        (
            HEAD + AT + f"current = {{ matrix = {EYE}, turns = 3 }}",
            r"current must be given axis and turns beside matrix",
        ),
        (HEAD + "name = 'x'", r"p\.toml must be a TOML file"),
        ("[[probe]]\nname = ''\n" + AT, r"probe 1, name must be a word; got ''"),
        (("[[probe]]\nname = 'a'\n" + AT) * 2, r"probe 2, name must be another than those before; got 'a'"),
        (
            f"[[probe]]\nframe = {SHEARED}\ncurrent = {{ scale = [1, 2, 1] }}",
            r"probe 1, current, scale must be one number",
        ),
    ],
)
def test_every_mistake_is_named(tmp_path, text, message):
    with pytest.raises(ValueError, match=rf"^probe_io\.read: [^\n]*({message})[^\n]*$"):
        read(tmp_path, text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", r"p\.json must be a JSON file; got .*line 1"),
        ("[1]", r"p\.json must be a table; got \[1\]"),
        ("[" * 100000, r"p\.json must be a JSON file"),
        ('{"probe": [{"centre": [0, 0, NaN]}]}', r"probe 1, centre must be finite"),
        (
            '{"probe": [{"centre": [0, 0, 0], "centre": [0, 0, 1]}]}',
            r"p\.json must be a JSON file; got the key 'centre' twice in a table",
        ),
        ('{"probe": [{"centre": null}]}', r"probe 1, centre must be a list of 3 numbers; got None"),
        ('{"probe": [{"centre": {}}]}', r"probe 1, centre must be a list of 3 numbers; got a table"),
    ],
)
def test_json_mistakes(tmp_path, text, message):
    with pytest.raises(ValueError, match=rf"^probe_io\.read: [^\n]*{message}[^\n]*$"):
        read(tmp_path, text, "p.json")


def test_files_that_are_none(tmp_path):
    for name, words in (("no.toml", "none of that name"), ("p.yaml", r"got \.yaml"), ("p", "got no ending")):
        with pytest.raises(ValueError, match=rf"^probe_io\.read: [^\n]*{words}[^\n]*$"):
            probe_io.read(tmp_path / name)
    (tmp_path / "b.toml").write_bytes(b"x = '\xff'")
    with pytest.raises(ValueError, match="UTF-8"):
        probe_io.read(tmp_path / "b.toml")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("fps = 24", r"must be a sequence, with at least one \[\[pose\]\]; got none"),
        ("fps = 0\n[[pose]]", r"fps must be above 0 and at most 1000; got 0"),
        ("fps = 'x'\n[[pose]]", r"fps must be a number; got 'x'"),
        ("pose = 3", r"pose must be a sequence"),
        ("pose = [3]", r"pose 1.* must be a table; got 3"),
        ("[[pose]]\nleft = {}", r"pose 1 must be a table of root, tip, side; got the key 'left'"),
        ("[[pose]]\n[[pose]]\ntip = 3", r"pose 2, tip must be a table; got 3"),
        (
            "[[pose]]\ntip = { degrees = 3 }",
            r"pose 1, probe tip, axis must be given beside degrees or turns; got none",
        ),
    ],
)
def test_mistakes_in_a_sequence(tmp_path, text, message):
    probes, _ = example(tmp_path)
    (tmp_path / "poses.toml").write_text(text)
    with pytest.raises(ValueError, match=rf"^probe_io\.read_poses: [^\n]*{message}[^\n]*$"):
        probe_io.read_poses(tmp_path / "poses.toml", probes)


@pytest.mark.parametrize(
    ("word", "message"),
    [
        ("centre=0,0", r"--probe, probe 1, centre must be a list of 3 numbers"),
        ("centre", r"--probe, probe 1 must be key=value"),
        (
            "centre=0,0,0 center=1",
            r"--probe, probe 1 must be key=value with name, centre, .*; got 'center=1'",
        ),
        ("centre=0,0,0 centre=0,0,0", r"--probe, probe 1, centre must be given once"),
        ("centre=0,0,x", r"--probe, probe 1, centre must be a list of 3 numbers; got '0,0,x'"),
        ("centre=0,0,nan", r"--probe, probe 1, centre must be finite"),
        ("", r"--probe, probe 1 must be given a centre or a frame"),
    ],
)
def test_mistakes_on_the_command_line(word, message):
    with pytest.raises(ValueError, match=rf"^probe_io\.from_words: {message}[^\n]*$"):
        probe_io.from_words([word])
