"""`lietool equations`: the index is complete, derived and true, and is found in a wheel."""

import ast
import json
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from click.testing import CliRunner

from lietool import paths
from lietool.cli import command
from lietool.verbs import _equations_example, _equations_index, equations

ROOT = paths.PACKAGE.parent
LISTED = _equations_index.catalogue(equations.LIST)
FOUND = _equations_index.scan(paths.PACKAGE, paths.FIGURES, ROOT / "tests")
INDEX = _equations_index.join(LISTED, FOUND)
BY_NUMBER = {equation.number: equation for equation in INDEX}


def run(*words: str) -> str:
    result = CliRunner().invoke(command, ["equations", *words])
    assert result.exit_code == 0, result.output
    return result.output


def test_all_numbers_of_the_texts_are_listed():
    last = {"B 2": 45, "B 3": 14, "B 4": 30, "B 5": 2, "B 6": 5, "B 7": 14, "B A": 14}
    wanted = [f"{chapter}.{n}" for chapter, count in last.items() for n in range(1, count + 1)]
    wanted += [f"M {n}" for n in range(1, 6)] + [f"K {n}" for n in range(1, 14)] + ["K Algorithm 1"]
    assert [equation.number for equation in LISTED] == wanted


def test_each_says_something_of_its_own_in_a_line():
    for equation in LISTED:
        assert 10 < len(equation.says) <= 100 and 2 < len(equation.formula) <= 110, equation.number
        assert "\n" not in equation.says + equation.formula
    assert len({(e.number[0], e.says) for e in LISTED}) == len(LISTED)


def test_every_number_has_a_function_or_a_test_or_is_awaited():
    lacking = [e.number for e in INDEX if e.state == "open" and not e.awaited]
    assert not lacking, f"neither a function's docstring nor a test cites {', '.join(lacking)}"


def test_what_is_computed_is_proved():
    unproved = {e.number: e.functions[0].name for e in INDEX if e.state == "implemented"}
    assert not unproved, "no test with @pytest.mark.equation for what these functions cite"


def test_what_is_awaited_is_not_built():
    built = [e.number for e in INDEX if e.awaited and e.state != "open"]
    assert not built, f"{', '.join(built)}: built, take it out of [awaited] in equations.toml"
    modules = {e.awaited for e in INDEX if e.awaited}
    assert modules <= {"lietool/interp", "lietool/deform"}


def test_no_citation_is_of_a_number_that_does_not_exist():
    assert not _equations_index.strays(LISTED, FOUND)


def test_functions_are_found_where_a_reader_calls_them():
    place = BY_NUMBER["B 2.34"].functions[0]
    assert place.name == "quaternion.slerp" and place.file == "lietool/lie/slerp.py"
    line = (ROOT / place.file).read_text().splitlines()[place.line - 1]
    assert line.startswith("def slerp(")


def test_functions_tests_and_plates_are_where_the_index_says():
    for equation in INDEX:
        for kind in ("functions", "tests"):
            for place in getattr(equation, kind):
                line = (ROOT / place.file).read_text().splitlines()[place.line - 1]
                assert re.match(rf"\s*(def|class) {place.name.rpartition('.')[2]}\b", line), place
    assert "B2.8" in [place.name for place in BY_NUMBER["B 2.34"].plates]


@pytest.mark.parametrize(
    ("line", "wanted"),
    [
        ("(2.1), (A.3)", ["B 2.1", "B A.3"]),
        ("(7.3)-(7.5), (2.31) with dual numbers", ["B 7.3", "B 7.4", "B 7.5", "B 2.31"]),
        ("4.6", []),
        ("2.8 (ii), 4.3 (xiii)", []),
    ],
)
def test_citations_are_read(line: str, wanted: list[str]):
    assert _equations_index.numbers(line) == wanted


def documented(name: str, *lines: str) -> str:
    return "\n    ".join([f"def {name}():", '"""Do.', "", *lines, '"""']) + "\n"


def test_sources_are_read(tmp_path: Path):
    sources = {
        "lietool/lie/a.py": documented("f", "Book: (2.1), (9.9)", "Kaji-Ochiai: Algorithm 1, mended")
        + documented("g", "Book: (2.2), for comparison")
        + documented("_h", "Book: (2.3)"),
        "lietool/lie/b.py": "from lietool.lie.a import f as f\n# Book: \n",
        "figures/ch2/p.py": '@figure(plates={"X1": Plate("t", ("2.4", "K 6"), "c")})\ndef p(): ...\n',
        "tests/test_a.py": '@pytest.mark.equation("M 4", "K 6")\n@pytest.mark.erratum("B 7.6")\n'
        "def test(): ...\n",
    }
    for name, text in sources.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    found = _equations_index.scan(tmp_path / "lietool", tmp_path / "figures", tmp_path / "tests")
    names = {number: [place.name for place in places] for number, places in found.functions.items()}
    assert names == {"B 2.1": ["b.f"], "B 9.9": ["b.f"], "K Algorithm 1": ["b.f"]}
    assert found.tests.keys() == {"M 4", "K 6"} and found.errata.keys() == {"B 7.6"}
    assert found.plates.keys() == {"B 2.4", "K 6"}
    assert _equations_index.strays(LISTED, found) == {"B 9.9": ["lietool/lie/a.py:1"]}


def test_markers_are_written_where_they_are_read():
    """A marker that is put together at run time would prove something that no index knows."""
    for file in (ROOT / "tests").rglob("test_*.py"):
        if b"mark.equation" not in file.read_bytes():
            continue
        for node in ast.walk(ast.parse(file.read_bytes())):
            if isinstance(node, ast.Call) and ast.unparse(node.func) == "pytest.mark.equation":
                assert node.args and all(isinstance(a, ast.Constant) for a in node.args), file


# ---- the command


def test_the_table_and_the_count():
    output = run()
    lines = output.splitlines()
    assert lines[0].split()[:2] == ["number", "what"]
    assert sum(bool(re.match(r"[BMK] \S", line)) for line in lines) == 143
    assert "143 equations" in output


def test_json_has_every_equation():
    rows = json.loads(run("--json"))
    assert [row["number"] for row in rows] == [equation.number for equation in LISTED]
    assert {"says", "formula", "functions", "tests", "plates", "errata", "state"} <= rows[0].keys()


@pytest.mark.parametrize(
    ("words", "number"),
    [
        ("7.8", "B 7.8"),
        ("B7.8", "B 7.8"),
        ("b (7.8)", "B 7.8"),
        ("(a.4)", "B A.4"),
        ("K 6", "K 6"),
        ("k6", "K 6"),
        ("m4", "M 4"),
        ("M (4)", "M 4"),
        ("algorithm 1", "K Algorithm 1"),
        ("k alg. 1", "K Algorithm 1"),
    ],
)
def test_one_is_named_in_many_ways(words: str, number: str):
    assert run(*words.split()).startswith(f"{number}  {BY_NUMBER[number].says}\n")


@pytest.mark.parametrize(
    ("words", "count"), [("7", 14), ("A", 14), ("M", 5), ("k", 14), ("B", 124), ("B 2", 45)]
)
def test_a_chapter_or_a_text(words: str, count: int):
    assert len(json.loads(run(*words.split(), "--json"))) == count


@pytest.mark.parametrize(("words", "near"), [("7.18", "B 7.8"), ("Q 4", "K 4"), ("K 66", "K 6"), ("9", "9")])
def test_an_unknown_one_is_answered_by_the_nearest(words: str, near: str):
    result = CliRunner().invoke(command, ["equations", *words.split()])
    assert result.exit_code == 2
    assert f"no equation {words!r}" in result.output and near in result.output


def test_one_shows_formula_function_test_plate_and_example():
    output = run("2.34")
    for words in (
        "slerp(1, exp(theta u), t)",
        "quaternion.slerp",
        "slerp.py:",
        "test_equations_ch2.py:",
        "B2.8",
    ):
        assert words in output
    about = json.loads(run("7.8", "--json"))
    assert about["number"] == "B 7.8" and about["text"] == "Book"
    assert about["example"][-1]["output"] == "[1., 2., 3.]"
    assert run("A.6").rstrip().endswith("[ 0.270447,  0.218504,  0.937611]]")


@pytest.mark.parametrize("equation", [e for e in INDEX if not e.awaited], ids=lambda e: e.number)
def test_every_equation_has_a_computed_example(equation: _equations_index.Equation):
    lines = equations.example(equation)
    assert lines, "write one into [examples] of equations.toml"
    for text, value in lines:
        assert text and value and "nan" not in value and len(value.splitlines()) <= 12


def test_an_example_is_the_truth():
    (_, one), (_, two) = _equations_example.of_expressions(["x = so3.exp([0, 0, 0.5])", "so3.log(x)"])
    assert one.startswith("[[ 0.877583, -0.479426,  0.") and two == "[0.0, 0.0, 0.5]"


def test_the_list_needs_no_numpy():
    code = (
        "import sys; from lietool.cli import command\n"
        "try: command.main(['equations'])\n"
        "except SystemExit: print('numpy' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "False"


# ---- the wheel


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder]
    done = subprocess.run(build, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (wheel,) = folder.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "site")
    return folder / "site"


def test_a_wheel_knows_the_tests_that_it_does_not_hold(site: Path, tmp_path: Path):
    def said(*words: str) -> str:
        call = [sys.executable, "-P", "-m", "lietool", "equations", *words]
        environment = os.environ | {"PYTHONPATH": str(site)}
        done = subprocess.run(call, cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert json.loads(said("--json")) == json.loads(run("--json"))
    page = said("2.34")
    assert f"{site}/lietool/lie/slerp.py:" in page and f"{site}/lietool/figures/ch2/slerp.py:" in page
    assert "test_equations_ch2.py:" in page and "source distribution" in page


def test_a_checkout_reads_its_sources_and_keeps_no_index():
    assert not equations.BUILT.exists()
    found = _equations_index.scan(paths.PACKAGE, paths.FIGURES, ROOT / "tests")
    assert equations.index() == _equations_index.join(LISTED, found)
    assert _equations_index.loads(_equations_index.dumps(INDEX)) == INDEX
