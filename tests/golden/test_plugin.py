"""The fixture ``lietool_golden`` in projects of others: each is written anew and run by pytest itself."""

import json
import os
import shutil
import sys
from importlib import metadata, util
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from lietool.golden import place, store

pytest_plugins = ["pytester"]

PLUGIN = "lietool.golden.plugin"
INSTALLED = any(entry.value == PLUGIN for entry in metadata.entry_points(group="pytest11"))
EXAMPLE = Path(__file__).parents[1] / "data" / "example_project"
ROOT = Path(__file__).parents[2]

TEST = """
import numpy as np

def picture():
    image = np.full((40, 60, 3), 230, np.uint8)
    image[10:30, 20:40] = (43, 102, 177)
    return image

def test_square(lietool_golden):
    lietool_golden.check(picture(), name="square", numbers={"corners": [[20.0, 10.0], [40.0, 30.0]]})
"""


@pytest.fixture
def run(pytester, monkeypatch):
    """Run pytest in a project, as its user would."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), *sys.path]))
    monkeypatch.delenv("PYTEST_ADDOPTS", raising=False)
    pytester.makeini("[pytest]")
    plugin = () if INSTALLED else ("-p", PLUGIN)

    def invoke(*arguments):
        done = pytester.runpytest_subprocess(*plugin, *arguments, timeout=120)
        done.said = "\n".join(done.outlines)
        assert "INTERNALERROR" not in done.said + "\n".join(done.errlines)
        return done

    return invoke


@pytest.fixture
def accepted(run, pytester):
    """The test of a square, whose golden has been written."""
    path = pytester.makepyfile(test_square=TEST)
    assert run("--golden-update=missing").ret == 1
    assert run().ret == 0
    return path


def changed(path, old, new):
    text = path.read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))


def golden(pytester, name="square"):
    above, _, last = name.rpartition("/")
    return store.read(place.Place(pytester.path / "golden", above, last))


def test_a_golden_is_written_only_where_asked_and_never_silently(run, pytester):
    pytester.makepyfile(test_square=TEST)
    done = run()
    assert done.ret == 1 and not (pytester.path / "golden").exists()
    assert "there is no golden at" in done.said and "--golden-update=missing" in done.said

    done = run("--golden-update=missing")
    done.assert_outcomes(passed=1)
    assert done.ret == 1 and "wrote square (new)" in done.said
    found = golden(pytester)
    assert found.image.shape == (40, 60, 3) and np.shape(found.numbers["corners"]) == (2, 2)
    assert found.provenance["test"] == "test_square.py::test_square"
    assert run().ret == 0


def test_a_change_fails_with_pictures_and_is_written_only_by_changed(run, pytester, accepted):
    changed(accepted, "10:30, 20:40", "11:31, 20:40")
    done = run()
    assert done.ret == 1 and "golden square" in done.said
    assert "picture differs: 40 px beyond dE 2" in done.said and "test_square.py:9" in done.said
    left = sorted((pytester.path / ".pytest_cache" / "d" / "lietool-golden").glob("*.png"))
    assert [path.name for path in left] == [f"square-{x}.png" for x in ("actual", "difference", "expected")]

    before = golden(pytester).image
    assert run("--golden-update=missing").ret == 1 and (golden(pytester).image == before).all()
    done = run("--golden-update=changed")
    assert done.ret == 1 and "wrote square (picture)" in done.said
    assert not (golden(pytester).image == before).all()
    assert run().ret == 0 and not left[0].exists()


def test_a_changed_number_says_which_and_by_how_much(run, accepted):
    changed(accepted, "[40.0, 30.0]", "[40.0, 30.5]")
    done = run()
    assert done.ret == 1
    assert "numbers differ: corners[1, 1]: expected 30.0, got 30.5, off by 0.5" in done.said


def test_what_passes_and_is_not_equal_is_written_by_all_alone(run, pytester, accepted):
    changed(accepted, "np.full((40, 60, 3), 230", "np.full((40, 60, 3), 231")
    assert run().ret == 0
    assert run("--golden-update=changed").ret == 0
    assert run("--golden-update=all").ret == 1
    assert golden(pytester).image[0, 0, 0] == 231 and run("--golden-update=all").ret == 0


def test_another_size_a_torn_golden_and_half_of_one_are_told_apart(run, pytester, accepted):
    png = pytester.path / "golden" / "square.png"
    whole = png.read_bytes()
    changed(accepted, "(40, 60, 3)", "(40, 61, 3)")
    assert "the picture is 61x40, its golden 60x40" in run().said
    png.write_bytes(whole[:200])
    done = run()
    assert done.ret == 1 and "cannot be decoded" in done.said
    png.unlink()
    done = run()
    assert done.ret == 1 and "is missing beside its other half" in done.said
    assert run("--golden-update=changed").ret == 1 and run().ret == 0


@pytest.mark.parametrize(
    ("call", "said"),
    [
        ("check(picture().astype(float), name='a')", "floats from 0 to 1; got 43 to 230"),
        ("check(picture()[:0], name='a')", "at least one pixel; got shape (0, 60, 3)"),
        ("check('a.png', name='a')", "a moderngl framebuffer; got str"),
        ("check(picture() * 2.0 * np.nan, name='a')", "floats from 0 to 1; got nan to nan"),
        ("check(picture().astype(np.uint16), name='a')", "uint8, bool or floats; got uint16"),
        ("check(picture(), name='../a')", "none of them . or .."),
        ("check(picture(), name='')", "none of them . or .."),
        ("check(picture(), name='a\\0b')", "none of them . or .."),
        ("check(picture(), name='a', pixels=20)", "because must say why pixels differ"),
        ("check(picture(), name='a', because='so')", "because must stand beside a tolerance"),
        ("check(picture(), name='a', lowpass=-1.0, because='so')", "lowpass must be finite and not negative"),
        ("check(picture(), name='a', mask=np.ones((2, 2), bool))", "mask must be bool of shape (40, 60)"),
        ("check(picture(), name='a', mask=np.ones((40, 60), bool))", "must leave something to compare"),
        (
            "check(picture(), name='a', numbers={'x': [1j]})",
            "must be floats, integers, texts or truth values",
        ),
    ],
)
def test_what_cannot_be_compared_is_one_line_and_writes_nothing(run, pytester, call, said):
    pytester.makepyfile(
        test_a=TEST.partition("def test")[0] + f"def test_a(lietool_golden): lietool_golden.{call}"
    )
    done = run("--golden-update=all")
    assert done.ret == 1 and said in done.said
    assert not list(pytester.path.rglob("golden/**/*.png"))


def test_a_test_that_checks_nothing_fails_and_one_that_is_skipped_does_not(run, pytester):
    pytester.makepyfile(
        "import pytest\ndef test_a(lietool_golden): pass\ndef test_b(lietool_golden): pytest.skip('no')\n"
    )
    done = run()
    done.assert_outcomes(passed=1, errors=1, skipped=1)
    assert "asks for lietool_golden and checks nothing" in done.said


def test_goldens_that_no_test_asks_for(run, pytester, accepted):
    shutil.copy(pytester.path / "golden" / "square.png", pytester.path / "golden" / "old.png")
    done = run()
    assert done.ret == 0 and "no test asks for" in done.said and "old.png" in done.said
    # One who runs a part of the tests is told nothing.
    assert "no test asks for" not in run("-k", "square").said
    assert "no test asks for" not in run("test_square.py").said
    assert "no test asks for" not in run("--golden-unused=ignore").said
    done = run("--golden-unused=fail")
    assert done.ret == 1 and "old.png" in done.said


def test_one_golden_for_two_tests_fails(run, pytester, accepted):
    changed(
        accepted,
        "def test_square",
        "def test_other(lietool_golden):\n    test_square(lietool_golden)\n\ndef test_square",
    )
    done = run()
    assert done.ret == 1 and "one golden for several checks: square: " in done.said


def test_masks_and_renderers(run, pytester):
    pytester.makepyfile(
        test_a=TEST.partition("def test")[0]
        + """
import os
STEP = np.uint8(os.environ.get("STEP", "0"))

def test_mask(lietool_golden):
    image = picture()
    image[:5] += STEP
    mask = np.zeros((40, 60), bool)
    mask[:5] = True
    lietool_golden.check(image, name="a/mask", mask=mask)

def test_box(lietool_golden):
    image = picture()
    image[:5, :7] += STEP
    lietool_golden.check(image, name="a/box", ignore=[(0, 0, 7, 5)])

def test_renderer(lietool_golden):
    image = picture()
    image[:5] += STEP
    lietool_golden.check(image, name="a/own", renderer=f"agg-{STEP}")
"""
    )
    assert run("--golden-update=missing").ret == 1
    assert run().ret == 0
    names = sorted(path.name for path in (pytester.path / "golden" / "a").glob("*.png"))
    assert names == ["box.png", "mask.png", "own@agg-0.png"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("STEP", "20")
        done = run()
        done.assert_outcomes(passed=2, failed=1)
        assert "own@agg-20.png" in done.said
        # What is not looked at stays what it was.
        run("--golden-update=all")
    assert golden(pytester, "a/mask").image[0, 0, 0] == 230


def test_report_json_and_junit(run, pytester, accepted):
    changed(accepted, "10:30, 20:40", "11:31, 20:40")
    done = run("--golden-report=out/a.html", "--golden-json=out/a.json", "--junitxml=junit.xml")
    assert done.ret == 1
    told = json.loads((pytester.path / "out" / "a.json").read_text())
    (check,) = told["checks"]
    assert not told["passes"] and check["name"] == "square" and check["word"] == "picture"
    assert check["numbers"]["over"] == 40 and len(check["left"]) == 3
    page = (pytester.path / "out" / "a.html").read_text()
    assert "test_square.py::test_square" in page and page.count("data:image/png") >= 2
    tree = ElementTree.parse(pytester.path / "junit.xml")
    (told,) = (node.get("value") for node in tree.iter("property") if node.get("name") == "golden square")
    assert told.startswith("picture; picture differs: 40 px")

    (pytester.path / "file").write_text("")
    done = run("--golden-json=file/a.json")
    assert "cannot be written" in done.said and "Traceback" not in done.said


@pytest.mark.skipif(util.find_spec("xdist") is None, reason="pytest-xdist is not installed")
def test_several_processes_write_and_judge_as_one(run, pytester):
    pytester.makepyfile(
        test_many=TEST.partition("def test")[0]
        + """
import pytest

@pytest.mark.parametrize("k", range(6))
def test_many(lietool_golden, k):
    lietool_golden.check(picture(), name=f"many/{k}")
"""
    )
    done = run("-n", "2", "--golden-update=missing")
    assert done.ret == 1 and done.said.count("wrote many/") == 6
    shutil.copy(pytester.path / "golden" / "many" / "0.png", pytester.path / "golden" / "many" / "old.png")
    done = run("-n", "2", "--golden-json=a.json", "--golden-report=a.html")
    assert done.ret == 0 and "many/old.png" in done.said
    assert len(json.loads((pytester.path / "a.json").read_text())["checks"]) == 6
    assert "many/5" in (pytester.path / "a.html").read_text()
    assert run("-n", "2", "--golden-unused=fail").ret == 1


def test_pictures_of_other_libraries(run, pytester):
    pytester.makepyfile(
        """
import numpy as np
import pytest
from PIL import Image

def test_all(lietool_golden):
    from matplotlib.figure import Figure
    levels = np.linspace(0.0, 1.0, 12).reshape(3, 4)
    eight = np.rint(255 * levels).astype(np.uint8)
    lietool_golden.check(levels, name="floats")
    lietool_golden.check(eight > 99, name="truth")
    lietool_golden.check(Image.fromarray(eight), name="grey")
    lietool_golden.check(Image.new("P", (4, 3)), name="palette")
    clear = np.zeros((3, 4, 4), np.uint8)
    lietool_golden.check(clear, name="clear")
    figure = Figure(figsize=(1, 1), dpi=40)
    before = figure.canvas
    lietool_golden.check(figure, name="figure")
    assert figure.canvas is before

def test_framebuffer(lietool_golden):
    from lietool.render import context
    gl = context.get().gl
    buffer = gl.simple_framebuffer((8, 6))
    buffer.use()
    buffer.clear(1.0, 0.0, 0.0, 1.0)
    buffer.clear(0.0, 0.0, 1.0, 1.0, viewport=(0, 0, 8, 2))
    lietool_golden.check(buffer, name="buffer")

def test_sixteen_bits(lietool_golden):
    with pytest.raises(ValueError, match="8 bits a channel; got Pillow's mode I;16"):
        lietool_golden.check(Image.new("I;16", (4, 3)), name="sixteen")
    lietool_golden.check(Image.new("RGB", (4, 3)), name="rgb")
"""
    )
    assert run("--golden-update=missing", "-k", "not framebuffer").ret == 1
    folder = pytester.path / "golden"
    with Image.open(folder / "floats.png") as one, Image.open(folder / "grey.png") as other:
        assert (np.asarray(one) == np.asarray(other)).all()
    assert (golden(pytester, "clear").image == 255).all() and golden(pytester, "figure").image.shape == (
        40,
        40,
        3,
    )
    assert set(np.unique(golden(pytester, "truth").image)) == {0, 255}


def test_a_framebuffer_is_upright(canonical):
    from lietool.golden import pixels
    from lietool.render import context

    buffer = context.get().gl.simple_framebuffer((8, 6))
    buffer.clear(1.0, 0.0, 0.0, 1.0)
    buffer.clear(0.0, 0.0, 1.0, 1.0, viewport=(0, 0, 8, 2))
    image = pixels.of(buffer)
    assert image.shape == (6, 8, 3)
    assert (image[:4] == (255, 0, 0)).all() and (image[4:] == (0, 0, 255)).all()


def test_the_example_project_passes_as_it_is_and_notices(run, pytester):
    for path in EXAMPLE.iterdir():
        copy = shutil.copytree if path.is_dir() else shutil.copy
        copy(path, pytester.path / path.name)
    (pytester.path / "tox.ini").unlink()
    done = run("--golden-unused=fail")
    assert done.ret == 0, done.said
    done.assert_outcomes(passed=6)
    changed(pytester.path / "spirals.py", "2.0 * np.pi * turns * t", "np.pi * turns * t")
    run().assert_outcomes(passed=1, failed=5)
