"""`lietool compare` and `lietool check`: each verdict and its exit code, each refusal, by running them."""

import json
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from lietool import paths
from lietool.cli import command
from lietool.golden import picture

BASE = np.random.default_rng(0).integers(60, 190, (60, 80, 3), np.uint8)
GOLDEN = paths.GOLDEN / "ch2" / "B2.8.png"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    save("a.png", BASE)


def save(path, image, **told):
    info = PngInfo()
    for key, value in told.items():
        info.add_text(key, value)
    Image.fromarray(image).save(path, pnginfo=info)


def run(line, code=0):
    result = CliRunner().invoke(command, line.split())
    assert result.exit_code == code, result.output
    assert "Traceback" not in result.output and (code != 2 or result.output.count("\n") == 1)
    return result.output


def other(box=(10, 20, 30, 40)):
    image = BASE.copy()
    x0, y0, x1, y1 = box
    image[y0:y1, x0:x1] = 255 - image[y0:y1, x0:x1]
    return image


class TestCompare:
    def test_equal_and_the_same(self):
        save("b.png", BASE)
        assert run("compare a.png b.png").splitlines()[0] == "equal"
        save("b.png", BASE + (np.indices(BASE.shape).sum(0) % 2).astype(np.uint8))
        said = run("compare a.png b.png")
        assert said.startswith("same\n") and re.search(r"pixels beyond dE 2 +0 +48", said)

    def test_different_says_where_and_how_far(self):
        save("b.png", other())
        said = run("compare a.png b.png -o d.png", 5)
        assert said.startswith("different\n") and "  20x20 at (10, 20): 4" in said and "see d.png" in said
        assert re.search(r"9x9 mean +[+-]\d+\.\d\d levels of [RGB] +1\.5 +\(\d+, \d+\)", said)
        assert picture.read("d.png").shape == BASE.shape
        about = json.loads(run("compare a.png b.png --json", 5))
        assert about["verdict"] == "different" and about["exit"] == 5 and about["difference"] is None
        assert about["comparison"]["over"] > 300 and about["places"][0]["box"] == [10, 20, 30, 40]

    def test_the_tolerance_is_that_which_is_asked_for(self):
        image = BASE.copy()
        image[5, 5:20] = 0
        save("b.png", image)
        run("compare a.png b.png", 5)
        run("compare a.png b.png --pixels 15 --lowpass 99")
        run("compare a.png b.png --delta-e 200 --lowpass 99")
        run("compare a.png b.png --pixels 15", 5)

    def test_boxes_are_ignored(self):
        save("b.png", other())
        assert run("compare a.png b.png --ignore 10,20,30,40").startswith("equal")
        run("compare a.png b.png --ignore 10,20,30,39 --ignore 0,0,1,1", 5)
        assert "must be x0,y0,x1,y1 with x0 < x1" in run("compare a.png b.png --ignore 10,20,300,40", 2)
        assert "must be X0,Y0,X1,Y1 in whole pixels" in run("compare a.png b.png --ignore 10,20", 2)

    def test_other_sizes_are_a_verdict(self):
        save("b.png", BASE[:30])
        said = run("compare a.png b.png -o d.png", 3)
        assert said == "other size\n  a.png is 80x60, b.png 80x30\n" and not Path("d.png").exists()
        assert json.loads(run("compare a.png b.png --json", 3))["comparison"]["actual_size"] == [80, 30]

    def test_however_they_are_packed(self):
        Image.fromarray(BASE).convert("RGBA").save("b.png")
        Image.fromarray(BASE).save("b.tif")
        assert run("compare a.png b.png") == run("compare a.png b.tif") == "equal\n"

    def test_pictures_that_say_how_they_were_made_are_compared_in_that_too(self):
        save("a.png", BASE, plate="X1", parameters='{"n": 3}', mesa="22")
        save("b.png", other(), plate="X1", parameters='{"n": 4}', mesa="25", numpy="2")
        said = run("compare a.png b.png", 5).splitlines()
        assert said[-2:] == [
            "  made with other parameters: n was 3, is 4",
            "  made by something else: mesa was 22, is 25",
        ]

    @pytest.mark.parametrize(
        ("line", "words"),
        [
            ("a.png nowhere.png", "lietool compare: nowhere.png is not there. Correct the name"),
            ("a.png .", "lietool compare: . is a folder. Name a picture in it"),
            ("torn.png a.png", "lietool compare: torn.png is damaged or cut off ("),
            ("a.png really.png", "really.png is no PNG, as its name says, but a JPEG"),
            ("a.png a.png -o d.jpg", "--output must end in .png; got d.jpg"),
            ("a.png a.png -o no/d.png", "there is no folder no. Make it first"),
            ("a.png really.png -o a.png", "is a picture to compare. Choose another name"),
            ("a.png", "Missing argument 'ACTUAL'"),
            ("a.png a.png --pixels -1", "--pixels"),
            ("a.png a.png --delta-e nan", "--delta-e"),
        ],
    )
    def test_bad_input_is_one_line(self, line, words):
        Path("torn.png").write_bytes(Path("a.png").read_bytes()[:400])
        Image.fromarray(BASE).save("really.png", "JPEG")
        before = Path("a.png").read_bytes()
        assert words in run(f"compare {line}", 2)
        assert Path("a.png").read_bytes() == before

    def test_it_starts_at_once(self):
        """Neither figures nor a renderer are loaded for it, nor what explains, where there is nothing to."""
        code = (
            "import sys; from click.testing import CliRunner; from lietool.cli import command\n"
            "result = CliRunner().invoke(command, ['compare', 'a.png', 'a.png'])\n"
            "assert result.exit_code == 0, (result.output, result.exception)\n"
            "print(*{'moderngl', 'matplotlib', 'scipy', 'skimage', 'trimesh'} & sys.modules.keys())"
        )
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
        assert done.returncode == 0 and done.stdout.split() == [], done.stderr + done.stdout


class TestCheck:
    def test_a_golden_is_itself_and_says_so(self):
        assert run(f"check {GOLDEN}").splitlines()[-1] == "equal"
        assert run(f"check {GOLDEN} --plate b2.8").startswith("B2.8  ")

    def test_a_picture_of_another_program(self):
        """Without a word of where it comes from, in another kind of PNG, and slightly other colours."""
        image = picture.read(GOLDEN)
        Image.fromarray(image).convert("RGBA").save("mine.png")
        assert run("check mine.png --plate B2.8").splitlines()[-1] == "equal"
        assert "mine.png does not say which plate it is. Name it" in run("check mine.png", 2)
        image = image.copy()
        image[300:330, 500:560] = (255, 0, 255)
        save("mine.png", image)
        said = run("check mine.png --plate B2.8 -o d.png", 5)
        assert "different" in said and "60x30 at (500, 300): 1800 px" in said and Path("d.png").is_file()
        about = json.loads(run("check mine.png --plate B2.8 --json", 5))
        assert about["plate"] == "B2.8" and about["golden"] == str(GOLDEN) and about["reasons"] == []
        assert about["places"][0]["box"] == [500, 300, 560, 330]

    def test_other_sizes(self):
        golden = Image.open(GOLDEN).convert("RGB")
        golden.resize((600, 450)).save("half.png")
        said = run("check half.png --plate B2.8", 3)
        assert "it is 600x450, the golden 1200x900, of the same shape. Make it at 1200x900: lietool" in said
        golden.resize((397, 298)).save("third.png")
        assert "of the same shape" in run("check third.png --plate B2.8", 3)
        golden.crop((0, 0, 900, 900)).save("square.png")
        assert "of another shape. Make it at 1200x900" in run("check square.png --plate B2.8", 3)

    @pytest.mark.parametrize(
        ("told", "word", "code", "words"),
        [
            ({"parameters": '{"steps": 7}'}, "other parameters", 5, "steps was 6, is 7"),
            ({"command": "gimbal"}, "other command", 5, "it was made by `lietool gimbal`"),
            ({"renderer": "NVIDIA H100"}, "other renderer", 4, "it was drawn by 'NVIDIA H100'"),
            ({"theme": "dark"}, "other look", 5, "in another look than goldens are: theme dark"),
        ],
    )
    def test_a_picture_that_says_why_it_is_another_is_told_so(self, told, word, code, words):
        before = picture.load(GOLDEN).texts
        if "parameters" in told:
            told = {
                "parameters": json.dumps(json.loads(before["parameters"]) | json.loads(told["parameters"]))
            }
        save("mine.png", 255 - picture.read(GOLDEN), **told)
        said = run("check mine.png --plate B2.8", code)
        assert word in said and words in said and "dE" not in said
        assert json.loads(run("check mine.png --plate B2.8 --json", code))["verdict"] == word
        # Where the pixels are right, nobody asks.
        save("mine.png", picture.read(GOLDEN), **told)
        run("check mine.png --plate B2.8")

    @pytest.mark.parametrize(
        ("line", "code", "words"),
        [
            ("a.png --plate B2.88", 2, "no plate 'B2.88'. Nearest: B2.8"),
            ("a.png --plate slerp", 2, "--plate slerp stands for several, B2.8, B2.8b. Name one of them"),
            ("nowhere.png --plate B2.8", 2, "nowhere.png is not there"),
            ("a.png --plate B2.8 -o a.png", 2, "is a picture to compare"),
        ],
    )
    def test_bad_input_is_one_line(self, line, code, words):
        assert words in run(f"check {line}", code)

    def test_a_plate_without_a_golden(self, monkeypatch, tmp_path):
        monkeypatch.setattr(paths, "GOLDEN", tmp_path / "none")
        assert "B2.8 has no golden to check with: there is no golden at" in run("check a.png --plate B2.8", 3)


def test_a_picture_in_another_look_says_so(monkeypatch):
    from lietool.verbs import _picture

    assert _picture.Quality().other == {}
    assert _picture.Quality(theme="dark", draft=True).other == {"theme": "dark", "draft": "yes"}


def test_comparing_equal_pictures_takes_no_time():
    image = np.tile(BASE, (15, 15, 1))
    from lietool.golden import compare

    best = 1.0
    for _ in range(5):
        start = time.perf_counter()
        assert compare.images(image, image.copy()).equal
        best = min(best, time.perf_counter() - start)
    assert best < 0.02
