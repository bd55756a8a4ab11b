"""`lietool exercise` for a student: list, show, start, and the verdict on one file."""

import errno
import json
import os
import stat
import tempfile
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from lietool.exercise import load
from lietool.golden import marks_page
from lietool.verbs import _exercise_tell, _exercise_tex, _studio


def pixels(path: Path | str) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


@pytest.mark.parametrize(
    ("tex", "text"),
    [
        (r"\theta_3 \in \mathbb{R}", "θ₃ ∈ ℝ"),
        (r"(\sin\theta)\,(\mathbf{u}\times\mathbf{x})", "(sin θ) (u × x)"),
        (r"w_{ji} = \frac{r_{ji}^{-p}}{\sum_k r_{jk}^{-p}}", "wⱼᵢ = (rⱼᵢ^(−p))/(Σₖ rⱼₖ^(−p))"),
        (r"\begin{pmatrix} c_2 & s_1 \\ -c_3 & \cdot \end{pmatrix}", "[c₂, s₁; −c₃, ·]"),
        (r"\exp\Big(\sum_i w_i x_i\Big)", "exp(Σᵢ wᵢ xᵢ)"),
        (r"R^{-1} = R^T, \quad \det R = 1", "R⁻¹ = Rᵀ,   det R = 1"),
        (r"\{x \mid x > 0\}", "{x | x > 0}"),
        (r"\frac{\sin\frac{\theta}{2}}{\theta}", "(sin θ/2)/θ"),
        (r"\varepsilon z = \bar z\varepsilon", "εz = z̄ε"),
        (r"\sin^2\theta + \unknown{y}", "sin²θ + unknowny"),
        (r"A^{\mathrm{P}} \in \mathfrak{so}(3)", "A^P ∈ so(3)"),
    ],
)
def test_formulas_are_read_without_tex(tex: str, text: str) -> None:
    assert _exercise_tex.plain(tex).replace(" ", "") == text.replace(" ", "")


def test_code_is_left_and_a_formula_of_its_own_is_set_off() -> None:
    said = _exercise_tex.readable("Write `f($x$)` for $x_1$:\n$$x_1 * x_2$$\nin *all*.")
    assert said == "Write `f($x$)` for x₁:\n\n    x₁ * x₂\n\nin *all*."
    assert r"> x₁ \* x₂" in _exercise_tex.readable("$$x_1 * x_2$$", markdown=True)


def test_every_statement_of_ours_is_read_without_tex() -> None:
    for name in load.names():
        said = _exercise_tex.readable(load.load(name).statement)
        prose = "".join(said.split("`")[::2])
        assert "$" not in prose and "\\" not in prose, name


def test_list(submit, exercise, course) -> None:
    lines = exercise("list").stdout.splitlines()
    assert lines[0].split() == ["number", "name", "equations", "plate", "points", "title"]
    assert any(line.split()[:2] == ["1", "square-root"] for line in lines)
    rows = json.loads(exercise("list", "--json").stdout)
    assert [row["number"] for row in rows] == sorted(row["number"] for row in rows)
    (mine,) = [row for row in rows if row["name"] == "square-root"]
    assert mine["plate"] == "R1" and mine["points"] == 10 and mine["equations"] == ["2.1"]


def test_show(submit, exercise) -> None:
    said = exercise("show", "square_root").stdout
    assert "The root of a number (2.1)" in said and "\n    √(x)² = x.       (2.1)\n" in said
    assert "- squares: 2 points\n- bad input: 1 point\n- the picture R1: 3 points" in said
    assert "exercise start square-root" in said and "$" not in said
    told = json.loads(exercise("show", "square-root", "--json").stdout)
    assert told["checks"][-1] == {"title": "the picture R1", "points": 3} and "solution" not in told
    assert "no exercise 'squareroot'. Nearest: square-root" in exercise("show", "squareroot", code=2).output


def test_the_solution_is_a_submission(submit, exercise) -> None:
    Path("mine.py").write_text(exercise("show", "square-root", "--solution").stdout)
    assert "10 of 10" in exercise("check", "mine.py").stdout


def test_start_check_and_full_marks(submit, exercise, course) -> None:
    said = exercise("start", "square-root").stdout
    assert "square_root.py: write root there" in said
    assert f"lietool --project {course} exercise check square_root.py" in said
    again = exercise("start", "square-root", code=2).output
    assert "square_root.py is there already, and stays as it is. Name another folder" in again
    exercise("start", "square-root", "other/folder")
    assert Path("other/folder/square_root.py").read_bytes() == Path("square_root.py").read_bytes()
    # Without a path it is what has been started here.
    said = exercise("check", code=5).stdout
    assert "0 of 10" in said and "It returns nan only" in said
    submit("right", "square_root.py")
    said = exercise("check").stdout
    assert "10 of 10" in said and "What it looks like" not in said
    assert pixels("square_root-R1.png").shape == (60, 80, 3)


def test_start_where_nothing_can_be_written(submit, exercise) -> None:
    Path("file").write_text("")
    assert "file" in exercise("start", "square-root", "file", code=2).output
    Path("square_root.py").symlink_to("nowhere.py")
    assert "is there already" in exercise("start", "square-root", code=2).output
    assert not Path("nowhere.py").exists()


def test_what_failed_is_told(submit, exercise) -> None:
    submit("half")
    said = exercise("check", "half.py", code=5).stdout
    rows = [line.split() for line in said.splitlines()]
    assert ["numbers", "0", "of", "4", "fails"] in rows and ["0", "of", "10"] in rows
    # What is half of four is its root.
    assert (
        "a hundred at once\n    given   x = an array of shape (100,)\n    wanted  [" in said
        and "off by" in said
    )
    assert "bad input\n  minus one\n    given   x = -1\n    wanted  a ValueError\n    got     -0.5" in said
    assert "This is half of x; (2.1) wants its root." in said
    assert "half-R1.png shows what your function draws; --report DIR lays it over" in said


def test_partial_marks(submit, exercise) -> None:
    submit("lenient")
    made = json.loads(exercise("check", "lenient.py", "--json", code=5).stdout)
    (one,) = made["submissions"]
    assert made["exit"] == 5 and (one["file"], one["marks"], one["of"]) == ("lenient.py", 9, 10)
    assert [check["points"] for check in one["checks"]] == [4, 2, 0, 3]
    assert len(one["digest"]) == 64 and one["seed"] == 0 and "summary" not in made


def test_a_file_that_gives_nothing_says_so_once(submit, exercise) -> None:
    submit("broken")
    said = exercise("check", "broken.py", code=5).stdout
    assert said.count("SyntaxError") == 1 and "It gave no value: line 6: SyntaxError" in said
    assert not Path("broken-R1.png").exists()


def test_the_seed_is_of_the_inputs(submit, exercise) -> None:
    submit("half")
    first, again, other = (
        exercise("check", "half.py", "--json", "--seed", seed, code=5).stdout for seed in (0, 0, 1)
    )
    assert first == again != other


def test_pictures_go_where_one_says(submit, exercise, course) -> None:
    submit("right")
    exercise("check", "right.py", "-o", "pictures/of/mine")
    golden = pixels(course / "golden" / "R1.png")
    assert np.array_equal(pixels("pictures/of/mine/right-R1.png"), golden)
    assert not Path("right-R1.png").exists()


def test_a_terminal_is_not_to_be_moved_by_what_is_printed(submit, exercise) -> None:
    submit("rude")
    said = exercise("check", "rude.py", code=5).stdout
    assert "<script>alert()</script>" in said and "\x1b" not in said and "\x07" not in said


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (None, "there is no such file"),
        (b"\xff\xfe\x00", "byte 0 is not UTF-8"),
        (b"a = 1\0", "NUL"),
        (b"#" * 10_000_000, "too large: more than 1 MiB"),
        (b"def root(x): pass", "its first lines do not say what it is for"),
        (b"# lietool exercise: square-rot\n", "no exercise 'square-rot'. Nearest: square-root"),
    ],
)
def test_a_file_that_is_none_is_one_line(submit, exercise, data: bytes | None, says: str) -> None:
    if data is not None:
        Path("bad.py").write_bytes(data)
    said = exercise("check", "bad.py", code=2).output
    assert says in said and "bad.py: " in said


def test_folders_and_pipes_are_no_files(submit, exercise) -> None:
    os.mkfifo("pipe.py")
    assert "pipe.py: it is a device or a pipe" in exercise("check", "pipe.py", code=2).output
    assert ".: it is a folder" in exercise("check", ".", code=2).output
    assert "nothing has been started in this folder" in exercise("check", code=2).output


def test_a_file_without_a_header_is_for_what_one_says(submit, exercise) -> None:
    text = submit("right").read_text().partition("\n")[2]
    # As an editor on Windows writes it.
    Path("plain.py").write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    exercise("check", "plain.py", "--exercise", "square_root")
    assert "Nearest: square-root" in exercise("check", "plain.py", "--exercise", "square", code=2).output


def test_what_cannot_be_written_is_said_before_grading(submit, exercise, monkeypatch) -> None:
    submit("right")
    Path("folder").mkdir()
    Path("file").write_text("kept")
    Path("only").write_text("")
    Path("only").chmod(stat.S_IRUSR)
    monkeypatch.setattr("lietool.verbs._exercise_class.alone", lambda *_: pytest.fail("it was graded"))
    assert "folder" in exercise("check", "right.py", "--csv", "folder", code=2).output
    assert "file" in exercise("check", "right.py", "--report", "file", code=2).output
    assert (
        "file/x.csv cannot be written" in exercise("check", "right.py", "--csv", "file/x.csv", code=2).output
    )
    assert Path("file").read_text() == "kept"


class _Otherwise(_studio.Studio):
    trouble = "the renderer is 'other', not llvmpipe"


def test_where_pictures_cannot_be_compared_they_have_no_points(submit) -> None:
    from click.testing import CliRunner

    from lietool.cli import command

    submit("right")
    done = CliRunner().invoke(command, ["exercise", "check", "right.py"], obj=_Otherwise())
    assert done.exit_code == 0 and "7 of 7" in done.stdout
    assert "Pictures were not compared, and have no points here: the renderer is 'other'" in done.stdout


@pytest.fixture
def read_only(monkeypatch) -> None:
    """Let no file be made in the folder `kept`, as on a read-only disk: root may write to any other."""
    make, temporary = tempfile.mkstemp, tempfile.TemporaryFile

    def refusing(made):
        def make(*args, dir=None, **options):
            if "kept" in Path(dir or "").parts or Path(dir or "").resolve().name == "kept":
                raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(dir))
            return made(*args, dir=dir, **options)

        return make

    Path("kept").mkdir()
    monkeypatch.setattr(tempfile, "mkstemp", refusing(make))
    monkeypatch.setattr(tempfile, "TemporaryFile", refusing(temporary))


@pytest.mark.parametrize("words", [("--csv", "kept/x.csv"), ("--report", "kept/pages"), ("-o", "kept")])
def test_a_read_only_folder_is_seen_before_grading(submit, exercise, read_only, monkeypatch, words) -> None:
    submit("right")
    monkeypatch.setattr("lietool.verbs._exercise_class.alone", lambda *_: pytest.fail("it was graded"))
    said = exercise("check", "right.py", *words, code=2).output
    assert f"{words[1].partition('.')[0]}" in said and "cannot be written: Read-only file system" in said


def test_marks_need_no_picture_beside_a_submission_that_is_on_a_read_only_disk(
    submit, exercise, read_only
) -> None:
    submit("right", "kept/right.py")
    done = exercise("check", "kept/right.py", "--csv", "marks.csv")
    assert "10 of 10" in done.stdout and "kept/right.py,square-root,10,10" in Path("marks.csv").read_text()
    assert (
        done.stderr == "kept/right-R1.png cannot be written: Read-only file system. Name a folder: -o DIR\n"
    )


def test_a_matrix_is_told_row_by_row_beside_others() -> None:
    text = "p = [[0, 0], [1, 2]], q = [[4, 5], [6, 7]], t = [0.5, 1], 2"
    assert marks_page.rows(text) == [
        "p = [[0, 0],",
        "     [1, 2]],",
        "q = [[4, 5],",
        "     [6, 7]],",
        "t = [0.5, 1], 2",
    ]
    assert marks_page.rows("[0] [[1, 2], [3, 4]]; [5, 6], [7, 8]") == [
        "[0] [[1, 2],",
        "     [3, 4]];",
        "[5, 6], [7, 8]",
    ]
    assert marks_page.rows("[[[1, 2], [3, 4]], [[5, 6], [7, 8]]]") == [
        "[[[1, 2],",
        "  [3, 4]],",
        " [[5, 6],",
        "  [7, 8]]]",
    ]
    assert _exercise_tell._wrapped("given", text)[1] == " " * 17 + "[1, 2]],"


def test_what_was_printed_is_cut_in_the_open(submit, exercise) -> None:
    submit("    for k in range(20):\n        print(k)\n    return np.sqrt(x)\n", "talks.py")
    said = exercise("check", "talks.py", code=5).stdout
    assert "\n  7\n  and " in said and " lines more\n" in said


def test_a_plate_without_a_golden_is_told_with_the_way_to_one(submit, exercise, course) -> None:
    submit("right")
    golden = course / "golden"
    golden.rename(course / "away")
    try:
        for words in (("check", "right.py"), ("export", "square-root", "--to", "plain", "out")):
            said = exercise(*words, code=3).output
            assert "there is no golden at" in said and "lietool figures accept R1 --reason" in said
            assert said.count("\n") == 1
    finally:
        (course / "away").rename(golden)
    assert not Path("out").exists()


def test_a_folder_among_the_exercises_is_none(submit, exercise, course) -> None:
    folder = course / "exercises" / "old.py"
    folder.mkdir()
    try:
        assert "old" not in exercise("list").stdout
    finally:
        folder.rmdir()
