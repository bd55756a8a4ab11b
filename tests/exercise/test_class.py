"""A class: submissions in processes that may hang or die, marks as a table, and going on after a kill."""

import csv
import errno
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from lietool import cache
from lietool.exercise import load
from lietool.verbs import _exercise_class, _exercise_csv, _exercise_read, _exercise_tell

CHECKS = ["numbers", "squares", "bad input", "the picture R1"]
MARKS = {"right": 10, "lenient": 9, "half": 0, "blank": 0, "broken": 0}


def table(path: str = "grades.csv") -> list[dict[str, str]]:
    with Path(path).open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture
def hand_in(submit):
    """Hand in one of each of `MARKS`, in an order that is not that of their names."""
    for body in reversed(MARKS):
        submit(body, f"in/{body}.py")
    return sorted(map(str, Path("in").iterdir()), reverse=True)


def test_a_class_is_a_table(hand_in, exercise, submit) -> None:
    said = exercise("check", *hand_in, "--csv", "grades.csv", code=5).stdout
    rows = table()
    assert list(rows[0]) == ["file", "exercise", "marks", "of", *CHECKS, "diagnosis", "digest"]
    assert [row["file"] for row in rows] == [f"in/{name}.py" for name in sorted(MARKS)]
    assert {Path(row["file"]).stem: int(row["marks"]) for row in rows} == MARKS
    for row in rows:
        assert int(row["marks"]) == sum(int(row[check]) for check in CHECKS) and row["of"] == "10"
    by_name = {Path(row["file"]).stem: row for row in rows}
    assert by_name["half"]["diagnosis"] == "This is half of x; (2.1) wants its root."
    assert by_name["broken"]["diagnosis"] == "line 6: SyntaxError: invalid syntax"
    assert "5 submissions: 38% of the points on average, 1 with all of them." in said
    assert "Most often wrong: bad input (4), numbers (3), squares (3), the picture R1 (3)." in said
    lines = {line.split()[0]: line for line in said.splitlines() if line}
    assert "9 of 10" in lines["in/lenient.py"] and "bad input" in lines["in/lenient.py"]
    # No pictures where nobody has asked for them.
    assert not list(Path().rglob("*.png"))


def test_with_any_number_of_processes_the_bytes_are_the_same(hand_in, exercise) -> None:
    for name, *more in (("a", "--jobs", 1), ("b", "--jobs", 2, "--fresh"), ("c",)):
        done = exercise("check", *hand_in, "--csv", f"{name}.csv", "--json", *more, code=5).stdout
        Path(f"{name}.json").write_text(done)
    for ending in ("csv", "json"):
        assert len({Path(f"{name}.{ending}").read_bytes() for name in "abc"}) == 1


def test_the_whole_as_json(hand_in, exercise) -> None:
    made = json.loads(exercise("check", *hand_in, "zmissing.py", "--json", code=5).stdout)
    files = [one["file"] for one in made["submissions"]]
    assert files == [*(f"in/{name}.py" for name in sorted(MARKS)), "zmissing.py"]
    assert made["submissions"][-1]["trouble"] == "there is no such file"
    assert made["summary"]["submissions"] == 6 and made["summary"]["full"] == 1
    # Who is not told for what a file is, but sees the others, knows how much it loses.
    assert made["submissions"][-1]["of"] == 10


def test_a_second_run_grades_what_is_missing(hand_in, exercise, submit, monkeypatch) -> None:
    graded = []
    run = _exercise_class.process.run

    def watched(jobs, *args, **options):
        graded.extend(step for job in jobs for step in job.steps)
        return run(jobs, *args, **options)

    monkeypatch.setattr(_exercise_class.process, "run", watched)
    monkeypatch.setenv("LIETOOL_CACHE_DIR", str(Path("kept").resolve()))
    exercise("check", *hand_in, code=5)
    assert len(graded) == len(MARKS)
    exercise("check", *hand_in, code=5)
    assert len(graded) == len(MARKS)
    # A copy is not graded again, and another text, seed or a run from nothing is.
    submit("right", "in/copy.py")
    submit("    return x\n", "in/other.py")
    exercise("check", *hand_in, "in/copy.py", "in/other.py", code=5)
    assert len(graded) == len(MARKS) + 1
    exercise("check", *hand_in, "--seed", 3, code=5)
    assert len(graded) == 2 * len(MARKS) + 1
    exercise("check", *hand_in, "--fresh", code=5)
    assert len(graded) == 3 * len(MARKS) + 1


def test_marks_are_forgotten_where_the_exercise_is_another(submit, course, monkeypatch) -> None:
    from lietool.verbs import _exercise_journal

    submit("right")
    made = load.load("square-root")
    keys = set()
    for _ in range(2):
        _exercise_journal._edition.cache_clear()
        keys.add(_exercise_journal.Journal().key(made, "0" * 64, 0, True))
    assert len(keys) == 1
    (course / "exercises" / "_more.py").write_text("A = 1")
    try:
        _exercise_journal._edition.cache_clear()
        keys.add(_exercise_journal.Journal().key(made, "0" * 64, 0, True))
    finally:
        (course / "exercises" / "_more.py").unlink()
        _exercise_journal._edition.cache_clear()
    assert len(keys) == 2


def test_what_is_kept_may_be_damaged(hand_in, exercise, monkeypatch) -> None:
    monkeypatch.setenv("LIETOOL_CACHE_DIR", str(Path("kept").resolve()))
    exercise("check", *hand_in, "--csv", "a.csv", code=5)
    files = sorted(Path("kept/exercises").rglob("*.json"))
    assert len(files) == len(MARKS)
    for file, data in zip(files, (b"", b"{", b"[]", b'{"about": {}}', b"\xff"), strict=True):
        file.write_bytes(data)
    exercise("check", *hand_in, "--csv", "b.csv", code=5)
    assert Path("a.csv").read_bytes() == Path("b.csv").read_bytes()


def test_nothing_need_be_kept(hand_in, exercise, monkeypatch) -> None:
    monkeypatch.setattr(cache, "folder", lambda name="": None)
    exercise("check", *hand_in[:2], code=5)


def test_what_is_for_no_exercise_is_a_line_of_the_table(hand_in, exercise, submit) -> None:
    Path("in/folder.py").mkdir()
    Path("in/bytes.py").write_bytes(b"\x80")
    Path("in/=1+1.py").write_text("def root(x): return x")
    Path("in/twice.py").write_text("# lietool exercise: rodrigues\n")
    said = exercise("check", *hand_in, *map(str, Path("in").iterdir()), "--csv", "grades.csv", code=5).stdout
    rows = {row["file"]: row for row in table()}
    # Now that there are two exercises, nobody knows for which one the others are.
    assert (
        rows["in/bytes.py"]["of"] == rows["in/bytes.py"]["exercise"] == "" == rows["in/bytes.py"]["numbers"]
    )
    assert rows["in/bytes.py"]["marks"] == "0" and "UTF-8" in rows["in/bytes.py"]["diagnosis"]
    assert "it is a folder" in rows["in/folder.py"]["diagnosis"]
    assert rows["in/twice.py"]["exercise"] == "rodrigues" and rows["in/twice.py"]["ordinary angles"] == "0"
    assert "3 could not be graded" in said and len(rows) == len(MARKS) + 4
    exercise("check", *map(str, Path("in").iterdir()), "--exercise", "square-root", "--csv", "g.csv", code=5)
    assert {row["of"] for row in table("g.csv")} == {"10"}


def test_a_cell_is_no_formula() -> None:
    row = _exercise_tell.Row("=cmd|x.py", "e", 0, 0, {}, '-1, "+"\n', "")
    lines = _exercise_csv.dumps([row], ["@a", "b"])
    assert lines == 'file,exercise,marks,of,\'@a,b,diagnosis,digest\n\'=cmd|x.py,e,0,,,,"\'-1, ""+""\n",\n'


def test_pictures_of_a_class_have_names_of_their_own(submit, exercise) -> None:
    for file in ("a/same.py", "b/SAME.py", "c/index.py"):
        submit("right", file)
    exercise("check", "a/same.py", "b/SAME.py", "c/index.py", "-o", "drawn", "--report", "report")
    assert {path.name for path in Path("drawn").iterdir()} == {
        "SAME-R1.png",
        "same-2-R1.png",
        "index-2-R1.png",
    }
    pages = {path.name for path in Path("report").iterdir()}
    assert pages == {"SAME.html", "same-2.html", "index-2.html", "index.html"}


def _graded(submissions, jobs, seconds):
    names = {each.exercise for each in submissions}
    exercises = {name: load.load(name) for name in names}
    return _exercise_class.together(
        submissions, exercises, seed=0, picture=True, jobs=jobs, fresh=True, seconds=seconds
    )


def test_one_that_hangs_or_kills_its_process_loses_only_its_own(submit) -> None:
    bodies = ("right", "hangs", "kills", "half", "refused", "lenient")
    paths = [submit(body, f"{k}.py") for k, body in enumerate(bodies)]
    marked = _graded(_exercise_read.read(paths, None), 2, 8.0)
    marks = [made.record and made.record.about["marks"] for made in marked]
    assert marks == [10, None, None, 0, 0, 9]
    assert marked[1].trouble == "it could not be graded: not done in 8 s"
    assert marked[2].trouble == "it could not be graded: the process that drew it died"
    assert marked[4].record is not None
    says = marked[4].record.about["picture"]["says"]
    assert says == "the figure cannot be drawn with what your function returns: no roots: 44"


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="there are no process groups here")
def test_after_a_kill_it_goes_on_where_it_was(submit, exercise, tmp_path, monkeypatch) -> None:
    kept = tmp_path / "kept"
    monkeypatch.setenv("LIETOOL_CACHE_DIR", str(kept))
    names = [str(submit(f"    return x * {k}.0\n", f"in/{k:02}.py")) for k in range(7)]
    call = [sys.executable, "-m", "lietool", "exercise", "check", *names, "--csv", "grades.csv"]
    running = subprocess.Popen(call, stdout=subprocess.DEVNULL, start_new_session=True)
    deadline = time.monotonic() + 120.0
    while not list(kept.rglob("exercises/*/*.json")):
        assert running.poll() is None and time.monotonic() < deadline
        time.sleep(0.02)
    os.kill(running.pid, signal.SIGKILL)
    running.wait()
    before = {path: path.stat().st_mtime_ns for path in kept.rglob("exercises/*/*.json")}
    assert len(before) < len(names) and not Path("grades.csv").exists()
    exercise("check", *names, "--csv", "grades.csv", code=5)
    after = {path: path.stat().st_mtime_ns for path in kept.rglob("exercises/*/*.json")}
    assert len(after) == len(names) and before.items() <= after.items()
    assert [row["file"] for row in table()] == names


def test_one_that_may_not_be_read_does_not_stop_the_class(hand_in, exercise, monkeypatch) -> None:
    # Root may read all: what stands before the reading asks so, and the reading finds out.
    monkeypatch.setattr(os, "access", lambda path, mode, **_: not str(path).endswith("half.py"))
    read = Path.open

    def refusing(self, *args, **options):
        if self.name == "half.py":
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(self))
        return read(self, *args, **options)

    monkeypatch.setattr(Path, "open", refusing)
    said = exercise("check", *hand_in, "--csv", "grades.csv", code=5).stdout
    assert {Path(row["file"]).stem: row["diagnosis"] for row in table()}["half"] == (
        "it cannot be read: Permission denied"
    )
    assert "5 submissions" in said


def test_what_could_not_be_graded_is_no_part_of_the_average() -> None:
    rows = [
        _exercise_tell.Row("a.py", "one", 10, 10, {}, "", ""),
        _exercise_tell.Row("b.py", "", 0, 0, {}, "it is too large", ""),
    ]
    said = _exercise_tell.sentences(_exercise_tell.summary(rows))
    assert said[0] == "1 of 2 submissions: 100% of the points on average, 1 with all of them."
    assert said[1] == "1 could not be graded, and the reason stands beside each."
