"""`lietool figures ...` on a toy project: each verb, each message, each exit code, by running it."""

import html
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from lietool import figure, paths
from lietool.golden import history, store
from lietool.verbs import _studio
from lietool.verbs.figures import command

_DIGESTS = ("picture", "numbers")

FILE = '''
"""Toy."""

from typing import Annotated

import numpy as np

from lietool.figure import Drawing, Param, Plate, figure
from lietool.render.scene import Label, Picture, View


@figure(
    plates={
        "T1": Plate(title="Three dots", equations=("1.1", "1.2"), caption="Three."),
        "T1b": Plate(title="Five dots", equations=(), caption="Five.", params={"count": 5}),
    }
)
def dots(
    count: Annotated[int, Param("how many", "", 1, 9)] = 3,
    start: Annotated[tuple[float, float], Param("where (x, y)")] = (0.5, 0.25),
) -> Drawing:
    """Draw dots."""
    view = View((Label(f"${count}$", (30.0, 20.0, 0.0), "#2b2f36", 20.0),))
    return Drawing(Picture((view,), (60, 40)), {"count": count, "x": np.linspace(0.0, 1.0, count)})
'''


class Studio(_studio.Studio):
    """A renderer that paints what a test wants it to."""

    def __init__(self):
        self.change = None
        self.numbers = {}
        self.keys, self.missing = {"k1"}, ("$q$",)
        self.info = {"renderer": "llvmpipe (LLVM 15)", "backend": "osmesa", "mesa": "22.3.6", "llvm": "15"}
        self.trouble = ""

    def require(self):
        if self.trouble == "nothing":
            raise _studio.Stop(4, "no OpenGL renderer")

    def paint(self, item, *, size=None, draft=False, theme="book"):
        image = np.random.default_rng(len(item.id)).integers(0, 256, (40, 60, 3)).astype(np.uint8)
        if self.change:
            image = self.change(image)
        fresh = {f"{k}.png": b"label" for k in self.keys if not (item.place.labels / f"{k}.png").exists()}
        numbers = {**self.sketch(item).numbers, **self.numbers}
        return _studio.Painted(image, numbers, frozenset(self.keys), fresh, self.missing if fresh else ())


@pytest.fixture
def studio():
    return Studio()


@pytest.fixture
def run(tmp_path, monkeypatch, studio):
    """Run the verb in a project of its own; the exit code is checked, the output returned."""
    (tmp_path / "figures" / "ch9").mkdir(parents=True)
    (tmp_path / "figures" / "ch9" / "dots.py").write_text(FILE)
    (tmp_path / "ours").mkdir()
    monkeypatch.setattr(paths, "FIGURES", tmp_path / "ours")
    monkeypatch.setenv(figure.PROJECT, str(tmp_path))
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    monkeypatch.chdir(tmp_path)

    def invoke(line, code=0, *, obj=studio):
        words = [word.strip('"') for word in re.findall(r'"[^"]*"|\S+', line)]
        result = CliRunner().invoke(command, words, obj=obj, catch_exceptions=False)
        assert result.exit_code == code, result.output
        return result.output

    return invoke


@pytest.fixture
def accepted(run, tmp_path):
    """A project whose goldens are whole: its golden folder."""
    run('accept --all --reason "first look"')
    return tmp_path / "golden"


def files(folder):
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def texts(path, **changed):
    """Change texts in a PNG, leaving its pixels."""
    with Image.open(path) as image:
        info = PngInfo()
        for key, value in {**image.text, **changed}.items():  # type: ignore[attr-defined]
            info.add_text(key, value)
        image.save(path, pnginfo=info)


def test_list_shows_plates_and_the_state_of_their_goldens(run, tmp_path):
    rows = json.loads(run("list --json"))
    assert [(row["plate"], row["command"], row["golden"]) for row in rows] == [
        ("T1", "dots", "missing"),
        ("T1b", "dots", "missing"),
    ]
    assert rows[0]["equations"] == ["1.1", "1.2"]
    run("accept T1 --reason r")
    assert run("list").splitlines()[1].split() == ["T1", "dots", "golden", "1.1,", "1.2", "Three", "dots"]
    (tmp_path / "golden" / "ch9" / "T1.json").unlink()
    assert "half accepted" in run("list T1")


def test_show_says_what_a_plate_is_and_where_it_comes_from(run, accepted):
    said = run("show t1B")
    assert "Five dots" in said and "lietool --project . dots --plate T1b" in said
    assert re.search(r"dots\.py:\d+", said) and re.search(r"reason +first look", said)
    about = json.loads(run("show T1 --json"))[0]
    assert about["parameters"] == {"count": 3, "start": [0.5, 0.25]}
    assert about["command"] == "lietool --project . dots"
    golden = about["golden"]
    assert golden["date"] == "1970-01-02T00:00:00Z" and golden["renderer"].startswith("llvmpipe")
    assert json.loads(golden["parameters"]) == about["parameters"]
    assert {"plate", "command", "commit", "mesa", "llvm", "moderngl", "numpy", "matplotlib"} <= set(golden)


def test_a_golden_that_is_missing_is_said_so_by_show(run):
    assert "missing: there is no golden at" in run("show T1")


@pytest.mark.parametrize("verb", ["list", "show", "build", "verify", "accept --reason r"])
def test_an_unknown_plate_is_answered_with_the_nearest(run, verb):
    said = run(f"{verb} T1c", 2)
    assert "no plate 'T1c'. Nearest: T1" in said and not Path("golden").exists()


def test_a_plate_is_found_in_any_case_and_a_command_stands_for_all_its_plates(run):
    assert [row["plate"] for row in json.loads(run("list t1b --json"))] == ["T1b"]
    assert [row["plate"] for row in json.loads(run("list DOTS t1 --json"))] == ["T1", "T1b"]


def test_a_broken_figure_file_is_one_line(run, tmp_path):
    (tmp_path / "figures" / "ch9" / "broken.py").write_text("def broken(:\n")
    assert "broken.py: line 1" in run("list", 2)


def test_build_makes_pictures_and_reports_without_judging(run, accepted, studio, tmp_path):
    before = files(accepted)
    said = run("build")
    assert [line.split()[0] for line in said.splitlines()[:3]] == ["plate", "T1", "T1b"]
    assert "equal" in said and "Try next:" in said and "\x1b" not in said
    with Image.open(tmp_path / "out" / "T1.png") as image:
        assert image.size == (60, 40) and image.info["plate"] == "T1"
    studio.change = np.invert
    rows = json.loads(run("build T1 -o elsewhere --json"))
    assert [row["verdict"] for row in rows] == ["picture"] and Path(rows[0]["path"]).is_file()
    why = r"Not as accepted: T1\. `\S*lietool --project \. figures verify T1` says why\."
    assert re.search(why, run("build T1"))
    assert files(accepted) == before


@pytest.mark.parametrize("option", ["--draft", "--size 30x20", "--size 3cm --dpi 72", "--theme dark"])
def test_a_draft_another_size_or_theme_is_not_compared(run, accepted, option):
    rows = json.loads(run(f"build {option} --json"))
    assert {row["verdict"] for row in rows} == {"not compared"}


def test_build_asks_for_the_look_that_was_asked_for(run, studio, tmp_path, monkeypatch):
    seen = []
    paint = studio.paint
    monkeypatch.setattr(studio, "paint", lambda item, **look: seen.append(look) or paint(item, **look))
    run("build T1 --theme print --size 85mm --dpi 200")
    (look,) = seen
    assert (look["theme"], look["draft"], look["size"].pixels((1200, 900))) == ("print", False, (669, 502))
    with Image.open(tmp_path / "out" / "T1.png") as image:
        assert image.info["dpi"] == pytest.approx((200, 200), abs=0.02)
    assert "no length is given" in run("build --dpi 200", 2)


@pytest.mark.parametrize("size", ["30", "0x20", "30x-1", "axb"])
def test_a_size_that_is_none_is_refused(run, size):
    assert "--size must be" in run(f"build --size {size}", 2)


def test_build_on_another_renderer_is_not_compared_and_without_one_fails(run, accepted, studio):
    studio.trouble = "the renderer is a GPU"
    assert {row["verdict"] for row in json.loads(run("build --json"))} == {"not compared"}
    studio.trouble = "nothing"
    assert "no OpenGL renderer" in run("build", 4)


@pytest.mark.parametrize("verb", ["build", "verify"])
def test_an_output_folder_that_cannot_be_written_is_one_line(run, tmp_path, verb):
    (tmp_path / "file").write_bytes(b"")
    assert "cannot be written" in run(f"{verb} T1 -o file/out", 2)


def test_verify_passes_what_was_accepted_and_writes_no_golden(run, accepted, studio):
    before = files(accepted)
    assert "2 plates: 2 as accepted, 0 not." in run("verify")
    studio.change = lambda image: np.where(
        image < 255, image + (np.indices((40, 60, 3)).sum(0) % 2), image
    ).astype(np.uint8)
    said = run("verify T1")
    assert "passes  " in said and "0 of 48 beyond dE 2, 0 of 8 in one place" in said
    studio.change = np.invert
    run("verify", 5)
    assert files(accepted) == before and not (accepted.parent / "out" / "failed" / "T9.png").exists()


def verdicts(run, code, line="verify --json"):
    about = json.loads(run(line, code))
    assert about["exit"] == code
    found = [*about["findings"], *(f for plate in about["plates"] for f in plate["findings"])]
    return {finding["kind"]: finding["message"] for finding in found}


def test_a_missing_golden(run):
    (message,) = verdicts(run, 3).values()
    assert "there is no golden at" in message
    assert 'lietool --project . figures accept T1b --reason "..."' in message
    assert Path("out/failed/T1-actual.png").exists() and not Path("out/failed/T1-expected.png").exists()


def test_a_golden_without_a_plate(run, accepted):
    (accepted / "ch9" / "T7.json").write_bytes(b"{}")
    assert "T7.json belongs to no plate" in verdicts(run, 3)["unregistered"]
    run("verify T1 T1b")


def test_another_size(run, accepted, studio):
    studio.change = lambda image: image[:30]
    found = verdicts(run, 3)
    assert set(found) == {"size"} and "the picture is 60x30, its golden 60x40" in found["size"]
    assert not Path("out/failed/T1-difference.png").exists() and Path("out/failed/T1-expected.png").exists()


@pytest.mark.parametrize("damage", [lambda data: data[:200], lambda data: b"", lambda data: b"x" + data])
def test_a_torn_picture(run, accepted, damage):
    path = accepted / "ch9" / "T1.png"
    path.write_bytes(damage(path.read_bytes()))
    found = verdicts(run, 3)
    assert set(found) == {"torn"} and "cannot be decoded" in found["torn"] and "Restore it" in found["torn"]


def test_half_accepted(run, accepted, studio):
    path = accepted / "ch9" / "T1.json"
    path.write_text(path.read_text().replace("3", "4", 1))
    found = verdicts(run, 3)
    assert set(found) == {"half accepted"} and found["half accepted"].startswith(
        "half accepted, run accept again"
    )
    assert "T1: whole again, was half accepted" in run("accept T1 --reason again")
    run("verify")


def test_a_missing_label(run, accepted):
    (accepted / "labels" / "k1.png").unlink()
    found = verdicts(run, 3)
    assert set(found) == {"label"} and "label '$q$' is not in" in found["label"]
    assert "lietool --project . figures accept T1b" in found["label"]
    assert "labels (1 new)" in run("accept T1 --reason again")
    run("verify")


def test_other_parameters(run, accepted):
    texts(accepted / "ch9" / "T1.png", parameters='{"count": 4, "start": [0.5, 0.25]}')
    found = verdicts(run, 5)
    assert "made with other parameters: count was 4, is 3" in found["parameters"]


def test_a_golden_of_another_renderer(run, accepted):
    texts(accepted / "ch9" / "T1.png", renderer="softpipe")
    found = verdicts(run, 5)
    assert set(found) == {"golden's renderer"} and "'softpipe', not by llvmpipe" in found["golden's renderer"]
    assert "was made by 'softpipe'" in run("accept T1 --reason again")
    run("verify")


def test_other_parameters_are_said_instead_of_a_picture_that_differs(run, accepted, studio):
    texts(accepted / "ch9" / "T1.png", parameters='{"count": 4, "start": [0.5, 0.25]}')
    studio.change, studio.numbers = np.invert, {"x": np.zeros(3)}
    found = verdicts(run, 5, "verify T1 --json")
    assert set(found) == {"parameters"}
    said = run("verify T1", 5)
    assert "count was 4, is 3" in said and "SSIM" not in said and "out/failed/T1-difference.png" in said
    texts(accepted / "ch9" / "T1b.png", renderer="softpipe")
    assert set(verdicts(run, 5, "verify T1b --json")) == {"golden's renderer"}


def test_what_else_a_picture_was_made_by_is_said_where_it_differs(run, accepted, studio):
    studio.info = {**studio.info, "mesa": "25.0.7", "llvm": "19"}
    assert "2 as accepted" in run("verify")
    studio.change = np.invert
    found = verdicts(run, 5)
    assert set(found) == {"picture"}
    assert found["picture"].endswith("Made otherwise: mesa was 22.3.6, is 25.0.7, llvm was 15, is 19")


def test_pixels_that_another_program_has_changed_are_no_golden(run, accepted):
    path = accepted / "ch9" / "T1.png"
    with Image.open(path) as image:
        info = PngInfo()
        for key, value in image.text.items():  # type: ignore[attr-defined]
            info.add_text(key, value)
        Image.fromarray(np.array(image) ^ np.uint8(1)).save(path, pnginfo=info)
    found = verdicts(run, 3)
    assert set(found) == {"torn"} and "it has other pixels than were accepted" in found["torn"]


FROM_FILES = '''
"""Toy."""

from pathlib import Path
from typing import Annotated

import numpy as np

from lietool.figure import Drawing, Param, Plate, figure
from lietool.render.scene import Picture, View

HERE = Path(__file__).parent


@figure(
    plates={
        "F0": Plate("From none", (), "From none."),
        "F1": Plate("From files", (), "Two.", {"first": HERE / "a.txt", "more": [HERE / "b.txt"]}),
    }
)
def read(
    first: Annotated[Path | None, Param("a file")] = None,
    more: Annotated[tuple[Path, ...], Param("more of them", positional=True)] = (),
) -> Drawing:
    """Read files."""
    texts = [path.read_text() for path in (*([first] if first else []), *more)]
    return Drawing(Picture((View(()),), (60, 40)), {"length": np.array(list(map(len, texts)))})
'''


def test_files_that_a_plate_is_drawn_from_are_recorded(run, tmp_path):
    folder = tmp_path / "figures" / "ch9"
    (folder / "read.py").write_text(FROM_FILES)
    for name in "ab":
        (folder / f"{name}.txt").write_text(name)
    run("accept F1 --reason r")
    golden = store.provenance(store.Place(tmp_path / "golden", "ch9", "F1"))
    # As in any other folder, on any other machine.
    wanted = {"first": "figures/ch9/a.txt", "more": ["figures/ch9/b.txt"]}
    assert json.loads(golden["parameters"]) == wanted
    assert set(json.loads(golden["inputs"])) == {"first", "more[0]"}
    run("verify F1")
    # Nothing that is compared has changed, but not by any merit of the golden.
    (folder / "b.txt").write_text("x")
    found = verdicts(run, 5, "verify F1 --json")
    assert set(found) == {"inputs"} and "made from other files: more[0] was " in found["inputs"]
    assert "F1: files: more[0] was" in run("accept F1 --reason again")
    run("verify F1")


def test_accept_keeps_the_history_of_a_golden(run, accepted, studio):
    place = store.Place(accepted, "ch9", "T1")
    assert [change.what for change in history.read(store.provenance(place))] == ["new"]
    studio.numbers = {"count": 8}
    run('accept T1 --reason "a `second`  look_"')
    place.json.write_text("{}")
    run('accept T1 --reason "third"')
    past = history.read(store.provenance(place))
    assert [change.reason for change in past] == ["first look", "a `second` look_", "third"]
    assert past[1].what.startswith("numbers: count") and past[2].what == "whole again, was half accepted"
    text = (accepted / "CHANGES.md").read_text()
    lines = [line for line in text.splitlines() if line.startswith(("### ", "- "))]
    assert lines[0] == "### [T1](ch9/T1.png)" and lines[4:] == [
        "### [T1b](ch9/T1b.png)",
        "- 1970-01-02, `unknown`: first look (new)",
    ]
    assert [line.split(": ", 1)[1][:20] for line in lines[1:4]] == [
        "third (whole again, ",
        r"a \`second\` look\_ ",
        "first look (new)",
    ]
    said = run("show T1")
    assert "1970-01-02T00:00:00Z  unknown: third (whole again, was half accepted)" in said
    assert json.loads(run("show T1 --json"))[0]["history"][0]["reason"] == "first look"
    # It is made of the pictures alone.
    (accepted / "CHANGES.md").unlink()
    assert run("gallery --readme").strip().endswith("CHANGES.md")
    assert (accepted / "CHANGES.md").read_text() == text


def test_another_picture_is_explained_and_left_until_it_passes_again(run, accepted, studio):
    def changed(image):
        image = image.copy()
        image[5:20, 10:30] = 255 - image[5:20, 10:30]
        return image

    studio.change = changed
    found = verdicts(run, 5)
    assert set(found) == {"picture"} and "px beyond dE 2 (48 allowed)" in found["picture"]
    said = run("verify T1", 5)
    assert re.search(r"20x15 at \(10, 5\): \d+ px, dE", said) and "SSIM" in said
    left = sorted(path.name for path in Path("out/failed").iterdir() if path.name.startswith("T1-"))
    assert left == ["T1-actual.png", "T1-difference.png", "T1-expected.png"]
    studio.change = None
    run("verify")
    assert list(Path("out/failed").iterdir()) == []


def test_other_numbers(run, accepted, studio):
    studio.numbers = {"x": np.array([0.0, 0.5, 1.0 + 1e-6])}
    found = verdicts(run, 5, "verify T1 --json")
    assert set(found) == {"numbers"} and "x[2]: expected 1.0, got 1.000001, off by 1e-06" in found["numbers"]
    studio.numbers = {"x": np.array([0.0, 0.5, 1.0 + 1e-12])}
    run("verify T1")


def test_a_renderer_that_is_not_canonical_leaves_the_numbers_to_judge(run, accepted, studio):
    studio.trouble = "the renderer is a GPU"
    found = verdicts(run, 4)
    assert found == {"renderer": "the renderer is a GPU"}
    assert "pictures were not compared" in run("verify", 4)


def test_with_several_it_is_4_before_3_before_5(run, accepted, studio):
    studio.numbers = {"count": 8}
    assert set(verdicts(run, 5)) == {"numbers"}
    (accepted / "ch9" / "T1.png").unlink()
    assert set(verdicts(run, 3)) == {"numbers", "half accepted"}
    studio.trouble = "the renderer is a GPU"
    assert set(verdicts(run, 4)) == {"renderer", "half accepted"}


@pytest.mark.parametrize(
    "line", ["accept T1", "accept --reason r", 'accept T1 --reason "  "', "accept T1 --all --reason r"]
)
def test_accept_needs_a_reason_and_plates(run, line):
    assert "accept needs" in run(line, 2) and not Path("golden").exists()


def test_accept_refuses_a_renderer_that_is_not_canonical(run, accepted, studio):
    before = files(accepted)
    studio.trouble, studio.change = "the renderer is a GPU", np.invert
    assert "the renderer is a GPU" in run("accept --all --reason r", 4)
    assert files(accepted) == before


def test_accept_says_what_has_changed_and_leaves_the_rest_alone(run, accepted, studio):
    before = files(accepted)
    assert run('accept T1 --reason "again"') == "T1: unchanged, left as it is\n"
    assert files(accepted) == before
    studio.numbers = {"x": np.array([0.0, 0.5, 1.0 + 1e-15])}
    assert "numbers: x[2]: expected 1.0, got 1.000000000000001" in run("accept T1 --reason finer")
    studio.change = lambda image: image ^ np.uint8(1)
    assert re.search(r"T1: 2400 px changed, \d+ beyond dE 2, largest ", run('accept T1 --reason "bit one"'))
    assert store.provenance(store.Place(accepted, "ch9", "T1"))["reason"] == "bit one"
    run("verify T1")
    run("verify T1b", 5)


def test_accept_keeps_no_numbers_that_are_not_finite(run, accepted, studio):
    before = files(accepted)
    studio.numbers = {"x": np.array([0.0, np.nan])}
    assert "must be finite; got x[1] is nan" in run("accept T1 --reason r", 2)
    assert files(accepted) == before


def test_accept_removes_labels_that_no_golden_uses(run, accepted, studio):
    studio.keys = {"k2"}
    assert "removed" not in run("accept T1 --reason r")
    assert "removed 1 labels that no golden uses: k1" in run("accept T1b --reason r")
    assert [path.name for path in (accepted / "labels").iterdir()] == ["k2.png"]


def test_accept_in_a_folder_that_cannot_be_written_is_one_line(run, tmp_path):
    (tmp_path / "golden").write_bytes(b"")
    assert "cannot be written" in run("accept T1 --reason r", 2)


def marks(page):
    """The review that somebody would hand in who finds everything right."""
    about = [json.loads(html.unescape(x)) for x in re.findall(r'data-about="([^"]*)"', page.read_text())]
    return [
        {"plate": each["accept"].split()[-1], "reason": "a new look", **{k: each[k] for k in _DIGESTS}}
        for each in about
    ]


def review(tmp_path, listed, **more):
    path = tmp_path / "review.json"
    path.write_text(json.dumps({"review": 1, "accept": listed, **more}))
    return path


def test_report_shows_all_and_ends_as_verify_does(run, accepted, studio, tmp_path):
    assert run("report").startswith("out/report.html: 0 failed, 0 changed, 2 passed")
    before = files(accepted)
    studio.change = lambda image: 255 - image
    assert "page.html: 2 failed" in run("report -o page.html", 5)
    text = (tmp_path / "page.html").read_text()
    assert "picture differs" in text and "llvmpipe (LLVM 15)" in text and "Three dots" in text
    assert files(accepted) == before
    studio.change, studio.trouble = None, "no OpenGL renderer"
    assert "renderer: no OpenGL renderer" in run("report -o page.html", 4)
    assert "no OpenGL renderer" in (tmp_path / "page.html").read_text()


def test_report_with_goldens_missing_stray_or_undrawn(run, accepted, studio, tmp_path):
    (accepted / "ch9" / "T1.png").unlink()
    (accepted / "ch9" / "T1.json").unlink()
    (accepted / "ch9" / "stray.png").write_bytes(b"")
    assert "stray.png belongs to no plate" in run("report", 3)
    studio.paint = lambda *a, **k: 1 // 0
    assert "2 failed" in run("report T1 T1b", 5)
    assert "cannot be drawn any more: ZeroDivisionError" in (tmp_path / "out/report.html").read_text()


def test_report_where_it_cannot_be_written_is_one_line(run, tmp_path):
    (tmp_path / "file").write_text("")
    for path in ("file/report.html", "figures"):
        said = run(f"report -o {path}", 2)
        assert said.startswith("Error: ") and len(said.splitlines()) == 1


def test_a_review_is_accepted_with_its_reasons(run, accepted, studio, tmp_path):
    studio.change = lambda image: 255 - image
    studio.numbers = {"more": 1.0}
    run("report", 5)
    found = marks(tmp_path / "out/report.html")
    found[1]["reason"] = " another   reason "
    review(tmp_path, found)
    assert "T1b: " in run("accept --from review.json")
    run("verify")
    reasons = [store.provenance(store.Place(accepted, "ch9", i))["reason"] for i in ("T1", "T1b")]
    assert reasons == ["a new look", "another reason"]


@pytest.mark.parametrize("other", ["picture", "numbers"])
def test_a_review_of_anything_else_is_refused_whole(run, accepted, studio, tmp_path, other):
    studio.change = lambda image: 255 - image
    run("report", 5)
    review(tmp_path, marks(tmp_path / "out/report.html"))
    before = files(accepted)
    if other == "picture":
        studio.change = lambda image: 254 - image // 2 if image[0, 0, 0] % 2 else 253 - image // 2
    else:
        studio.numbers = {"more": 1.0}
    said = run("accept --from review.json", 5)
    assert f"T1: {other} drawn now" in said and "nothing was accepted" in said
    assert len(said.splitlines()) == 1 and files(accepted) == before


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is not the review.json"),
        ("[]", "has no list `accept`"),
        ('{"review": 2, "accept": []}', "has no list `accept`"),
        ('{"review": 1, "accept": []}', "marks nothing"),
        ('{"review": 1, "accept": [3]}', "mark 1 needs texts plate, reason, picture, numbers"),
        ('{"review": 1, "accept": [{"plate": "T1", "reason": 3}]}', "mark 1 needs texts"),
        ("[" * 100_000, "is not the review.json"),
    ],
)
def test_a_review_that_is_none_is_one_line(run, accepted, tmp_path, text, says):
    (tmp_path / "review.json").write_text(text)
    said = run("accept --from review.json", 2)
    assert says in said and len(said.splitlines()) == 1


def test_a_review_with_wrong_marks_is_one_line(run, accepted, tmp_path):
    run("report")
    first, second = marks(tmp_path / "out/report.html")
    wrong = {
        "T1 has no reason": [{**first, "reason": "  "}],
        "there is no plate 'T9' here": [first, {**second, "plate": "T9"}],
        "T1 is marked twice": [first, first],
    }
    before = files(accepted)
    for says, listed in wrong.items():
        review(tmp_path, listed)
        said = run("accept --from review.json", 2)
        assert says in said and len(said.splitlines()) == 1, said
    assert "Leave out the others" in run("accept T1 --from review.json", 2)
    assert files(accepted) == before


def test_the_commit_is_recorded_where_there_is_one(tmp_path):
    assert _studio._commit(tmp_path / "nowhere") == "unknown"


def test_the_whole_way_with_the_real_renderer(run, tmp_path):
    """Accept, twice at once, in processes of their own; verify; find a label missing."""
    environment = {**os.environ, "LIETOOL_CACHE_DIR": str(tmp_path / "cache")}
    line = [sys.executable, "-m", "lietool", "figures", "accept", "dots", "--reason", "look"]
    both = [
        subprocess.Popen(line, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        for _ in "12"
    ]
    said = [process.communicate(timeout=120)[0].decode() for process in both]
    assert [process.returncode for process in both] == [0, 0], said
    # Whoever came second waited, and then found that nothing had changed.
    assert sorted(text.count("T1: new") for text in said) == [0, 1]
    found = store.read(store.Place(tmp_path / "golden", "ch9", "T1"))
    labels = {path.stem for path in (tmp_path / "golden" / "labels").iterdir()}
    assert store.label_keys(found.provenance) <= labels and len(labels) == 2
    assert "2 as accepted" in run("verify", obj=None)
    for path in (tmp_path / "golden" / "labels").iterdir():
        path.unlink()
    assert "label '$3$' is not in" in run("verify T1", 3, obj=None)


def test_a_plate_that_cannot_be_drawn_any_more_fails_and_the_others_are_judged(run, accepted, studio):
    def break_three(image):
        if image[0, 0, 0] == first:
            raise ValueError("dots: count must be lucky; got 3")
        return image

    first = np.random.default_rng(len("T1")).integers(0, 256, (40, 60, 3)).astype(np.uint8)[0, 0, 0]
    studio.change = break_three
    said = run("verify", 5)
    assert "cannot be drawn any more: dots: count must be lucky" in said
    assert re.search(r"T1b +equal", said)
