"""What a figure file declares, what is refused, and the loader."""

import math
import os
import sys
import textwrap
from pathlib import Path

import pytest

from lietool import figure as figures
from lietool import paths

_ARC = '''
from pathlib import Path
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Param, Plate, Time, figure

AXES = Literal["x", "y"]


@figure(
    plates={"T10": Plate("One", ("1.1",), "One."), "T9": Plate("Two", (), "Two.", {"axis": "y"})},
    time=Time("turn", 0, 360),
)
def arc(
    axis: Annotated[AXES, Param("what to turn about")] = "x",
    q0: Annotated[tuple[float, float, float, float], Param("start (w, x, y, z)")] = (1.0, 0.0, 0.0, 0.0),
    knots: Annotated[tuple[float, ...], Param("moments", low=0)] = (0.0, 1.0),
    turn: Annotated[float, Param("swept angle", "deg", 0, 360)] = 90,
    steps: Annotated[int, Param("steps", low=1, high=50)] = 8,
    solid: Annotated[bool, Param("draw the solid")] = True,
    mesh: Annotated[Path | None, Param("a mesh")] = None,
) -> Drawing:
    """Turn an arc.

    What to look for: that it turns.
    """
    return Drawing(None, {"turn": np.array([turn]), "steps": steps})
'''


def _write(folder: Path, name: str, text: str) -> Path:
    file = folder / "figures" / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(textwrap.dedent(text))
    return file


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the figure `arc` as the project, and without our own figures."""
    _write(tmp_path, "ch9/arc.py", _ARC)
    monkeypatch.setenv(figures.PROJECT, str(tmp_path))
    monkeypatch.setattr(paths, "FIGURES", tmp_path / "none")
    return tmp_path


_PART = 'view: Annotated[Literal["a", "b"], Param("v")] = "a", x: Annotated[float, Param("x", only={})] = 1.0'


def _tiny(
    parameters: str = "", arguments: str = 'plates={"A": Plate("T", (), "C.")}', doc: str = '"""D."""'
) -> str:
    return f"""
    from typing import Annotated, Literal
    from lietool.figure import *
    from lietool.figure import figure
    @figure({arguments})
    def tiny({parameters}) -> Drawing:
        {doc}
        return Drawing(None, {{}})
    """


def test_a_figure_is_its_signature(project: Path) -> None:
    arc = figures.load("arc")
    assert (arc.name, arc.chapter, arc.summary) == ("arc", "ch9", "Turn an arc.")
    assert "What to look for" in arc.help
    assert arc.file == project / "figures/ch9/arc.py"
    kinds = {parameter.name: (parameter.kind, parameter.length) for parameter in arc.parameters}
    assert kinds == {
        "axis": ("str", 0),
        "q0": ("vector", 4),
        "knots": ("vector", 0),
        "turn": ("float", 0),
        "steps": ("int", 0),
        "solid": ("bool", 0),
        "mesh": ("path", 0),
    }
    assert arc.parameters[0].param.choices == ("x", "y")
    assert arc.time == figures.Time("turn", 0, 360)
    assert figures.load("arc") is arc


def test_draw_completes_the_parameters_in_their_own_types(project: Path) -> None:
    arc = figures.load("arc")
    assert arc.draw().numbers["turn"] == [90.0]
    assert arc.draw(turn=3, steps=2).numbers == {"turn": [3.0], "steps": 2}
    assert arc.plate_params("T9")["axis"] == "y"
    assert arc.plate_params("T10") == arc.check({})
    values = arc.check({"q0": [0, 0, 0, 1], "mesh": str(arc.file), "turn": 0})
    assert values["q0"] == (0.0, 0.0, 0.0, 1.0)
    assert values["mesh"] == arc.file
    assert type(values["turn"]) is float


@pytest.mark.parametrize(
    ("name", "value", "wanted"),
    [
        (
            "turn",
            math.nan,
            "turn must be a finite number, 0 to 360 deg; got nan. Write for example turn=90.0",
        ),
        ("turn", -math.inf, "0 to 360 deg; got -inf"),
        ("turn", 360.1, "got 360.1"),
        ("turn", "ten", "got 'ten'"),
        ("turn", True, "got True"),
        ("steps", 2.5, "steps must be a whole number, 1 to 50; got 2.5"),
        ("steps", 51, "got 51"),
        ("q0", (1, 0, 0), "q0 must be four finite numbers w,x,y,z; got (1, 0, 0)"),
        ("q0", (1, 0, 0, math.nan), "got (1, 0, 0, nan)"),
        ("knots", (), "knots must be finite numbers with commas between them, at least 0; got ()"),
        ("knots", (-1.0,), "got (-1.0,)"),
        ("axis", "z", "axis must be one of x, y; got 'z'"),
        ("solid", 1, "solid must be true or false; got 1"),
        ("mesh", "no/such", "mesh must be a file that exists; got 'no/such'"),
        ("stps", 3, "no parameter 'stps'. Nearest: steps"),
    ],
)
def test_draw_refuses(project: Path, name: str, value: object, wanted: str) -> None:
    with pytest.raises(ValueError, match=r"^arc\.draw: ") as error:
        figures.load("arc").draw(**{name: value})
    assert wanted in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "text", ["", "1,0,0", "1,0,0,0,0", "1,,0,0", "1,0,0,nan", "1,0,0,inf", "a,b,c,d", "1 0 0 0"]
)
def test_a_malformed_vector_is_refused(project: Path, text: str) -> None:
    q0 = figures.load("arc").parameters[1]
    with pytest.raises(ValueError, match="must be four finite numbers w,x,y,z; got"):
        q0.parse(text)
    assert q0.parse(q0.text((-1.0, 0.5, 1e-9, 0.1))) == (-1.0, 0.5, 1e-9, 0.1)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (_tiny(doc="pass"), "tiny has no docstring"),
        (
            _tiny(
                'a: Annotated[float, Param("a", unless=("b",))] = 1.0, b: Annotated[float, Param("b")] = 1.0'
            ),
            "parameter a: unless and needs must be other parameters without a default; got b",
        ),
        (_tiny(_PART.format('("view",)')), "parameter x: only must be another parameter and some of its"),
        (_tiny(_PART.format('("view", "c")')), "choices; got ('view', 'c'). Correct it"),
        (_tiny(_PART.format('("x", "a")')), "got ('x', 'a')"),
        (
            _tiny('x: Annotated[float, Param("x", positional=1)] = 1.0'),
            "parameter x is positional but no file. Leave that out",
        ),
        (
            _tiny(
                'x: Annotated[tuple[Path, ...], Param("x", positional=1)] = (), '
                'y: Annotated[Path | None, Param("y", positional=2)] = None'
            ),
            "parameter x takes all files that follow. Make it the last",
        ),
        *(
            (
                _tiny(
                    f'x: Annotated[Path | None, Param("x", positional={places[0]})] = None, '
                    f'y: Annotated[Path | None, Param("y", positional={places[1]})] = None'
                ),
                f"positional must count x, y from 1 to 3 at most; got {sorted(places)}. Correct it",
            )
            for places in ((1, 1), (2, 3), (1, 3))
        ),
        *(
            (
                _tiny(
                    'view: Annotated[Literal["a", "b"], Param("v")] = "a"',
                    f'plates={{"A": Plate("T", (), "C.")}}, mesh={mesh}',
                ),
                f"mesh must be True, or a parameter and some of its choices; got {mesh}. Correct it",
            )
            for mesh in ("('view',)", "('view', 'c')", "('x', 'a')")
        ),
        (_tiny("a: float = 1.0"), "parameter a must be annotated"),
        (_tiny("a=1.0"), "parameter a must be annotated"),
        (_tiny('a: Annotated[float, Param("a")]'), "parameter a has no default"),
        (_tiny('a: Annotated[float, Param("")] = 1.0'), "parameter a has no help"),
        (_tiny('a: Annotated[float, Param("a", "rad")] = 1.0'), "parameter a is in radians"),
        (
            _tiny('a: Annotated[float, Param("a", "", 0, 1)] = 2.0'),
            "parameter a has a default that must be a finite",
        ),
        (_tiny('a: Annotated[float, Param("a", "", 1, 0)] = 1.0'), "parameter a has an empty range, 1 to 0"),
        (
            _tiny('a: Annotated[str, Param("a", "deg")] = "b"'),
            "parameter a has a unit or a range but is no number",
        ),
        (
            _tiny('a: Annotated[Literal["b"], Param("a")] = "c"'),
            "parameter a has a default that must be one of b",
        ),
        (_tiny('a: Annotated[dict, Param("a")] = {}'), "parameter a has the type"),
        (_tiny('size: Annotated[float, Param("a")] = 1.0'), "parameter size has the name of an option"),
        (_tiny(arguments="plates={}"), "no plates"),
        (_tiny(arguments='plates={"a/b": Plate("T", (), "C.")}'), "plate 'a/b' must be named by letters"),
        (_tiny(arguments='plates={"A": Plate("", (), "C.")}'), "plate A has no title"),
        (_tiny(arguments='plates={"A": Plate("T", ("1.1"), "C.")}'), "plate A: equations must be a tuple"),
        (_tiny(arguments='plates={"A": Plate("T", (), "C.", {"a": 1})}'), "plate A is the first"),
        (
            _tiny(arguments='plates={"A": Plate("T", (), "C."), "B": Plate("T", (), "C.", {"a": 1})}'),
            "plate B: tiny.draw: no parameter 'a'",
        ),
        (
            _tiny(
                'a: Annotated[float, Param("a", "", 0, 1)] = 0.0',
                'plates={"A": Plate("T", (), "C."), "B": Plate("T", (), "C.", {"a": 2.0})}',
            ),
            "plate B: tiny.draw: a must be a finite number, 0 to 1; got 2.0",
        ),
        (
            _tiny(arguments='plates={"A": Plate("T", (), "C.", tolerance=Tolerance(pixels=9))}'),
            "plate A has a tolerance of its own. Say why",
        ),
        (
            _tiny(
                arguments='plates={"A": Plate("T", (), "C.", '
                'tolerance=Tolerance(delta_e=float("nan"), because="b"))}'
            ),
            "plate A: the limits of a tolerance must be finite and at least 0; got (8, nan, 1.5, 1e-09)",
        ),
        (
            _tiny(arguments='plates={"A": Plate("T", (), "C."), "a": Plate("T", (), "C.")}'),
            "two plates have ids that differ only in case",
        ),
        (_tiny(arguments='plates={"A": None}'), "plates must map texts to Plate(...); got 'A': NoneType"),
        (
            _tiny('a: Annotated[int, Param("a")] = 10**400'),
            "parameter a has a default that must be a whole number",
        ),
        (
            _tiny(
                'a: Annotated[float, Param("a", "", 0, 1)] = 0.0',
                'plates={"A": Plate("T", (), "C.")}, time=Time("a", 0, 1, frames=10**9)',
            ),
            "time must have 2 to 1000 frames",
        ),
        (
            _tiny().replace("@", "import nosuchpackage\n    @", 1),
            "No module named 'nosuchpackage'. Install what is missing",
        ),
        (_tiny().replace("@", "float('x')\n    @", 1), "could not convert string to float: 'x'"),
        (
            _tiny(arguments='plates={"A": Plate("T", (), "C.")}, time=Time("a", 0, 1)'),
            "time is 'a', which must be",
        ),
        (
            _tiny(
                'a: Annotated[float, Param("a", "", 0, 1)] = 0.0',
                'plates={"A": Plate("T", (), "C.")}, time=Time("a", 0, 2)',
            ),
            "time goes outside of its parameter: a must be a finite number, 0 to 1; got 2",
        ),
        (_tiny(arguments='plates=dict(A=Plate("T", (), "C."))'), "plates must be written out"),
        (_tiny().replace("def tiny", "def other"), "no function tiny with @figure"),
        ("x = 1\ndef broken(:\n", "line 2: invalid syntax"),
    ],
)
def test_a_bad_file_is_refused_by_name(project: Path, text: str, message: str) -> None:
    file = _write(project, "ch9/tiny.py", text)
    with pytest.raises(figures.FigureError) as error:
        figures.load("tiny")
    assert message in str(error.value)
    assert str(error.value).startswith(str(file))
    assert "\n" not in str(error.value)


_TAKES = 'x: Annotated[float, Param("x")] = 1.0, *, root: Library = Library("math.sqrt")'


def test_a_function_may_be_passed_in(project: Path) -> None:
    _write(project, "ch9/tiny.py", _tiny(_TAKES).replace("{})", "{'y': root(x)})"))
    tiny = figures.declare("tiny")
    assert tiny.functions == {"root": figures.Library("math.sqrt")}
    assert [p.name for p in tiny.parameters] == ["x"]
    tiny = figures.load("tiny")
    assert tiny.draw(x=9.0).numbers == {"y": 3.0}
    assert tiny.draw_with({"root": lambda x: -x}, x=9.0).numbers == {"y": -9.0}
    with pytest.raises(ValueError, match="no parameter 'functions'"):
        tiny.draw(functions=1.0)
    with pytest.raises(ValueError, match=r"tiny.draw_with: it takes no function 'rot'\. Nearest: root"):
        tiny.draw_with({"rot": abs})


def test_a_function_is_keyword_only(project: Path) -> None:
    _write(project, "ch9/tiny.py", _tiny(_TAKES.replace("*, ", "")))
    with pytest.raises(figures.FigureError, match="function root must be keyword-only"):
        figures.load("tiny")


def test_a_mesh_is_returned_just_where_it_is_declared(project: Path) -> None:
    view = 'view: Annotated[Literal["a", "b"], Param("v")] = "a"'
    for mesh, fine in ((("view", "b"), {"b"}), (True, {"a", "b"}), (False, set())):
        text = _tiny(view, f'plates={{"A": Plate("T", (), "C.")}}, mesh={mesh}')
        _write(project, "ch9/tiny.py", text.replace("{}", "{}, 3 if view == 'b' else None"))
        sys.modules.pop("lietool_project.ch9.tiny", None)
        tiny = figures.load("tiny")
        assert {name for name in "ab" if tiny.shows_mesh({"view": name})} == fine
        for name in "ab":
            if (name == "b") == (name in fine):
                tiny.draw(view=name)
            else:
                with pytest.raises(figures.FigureError, match="just where @figure"):
                    tiny.draw(view=name)


def test_a_tolerance_with_a_reason_is_accepted(project: Path) -> None:
    tolerance = 'Tolerance(relative=1e-7, because="condition 4e7")'
    _write(
        project,
        "ch9/tiny.py",
        _tiny(arguments=f'plates={{"A": Plate("T", (), "C.", tolerance={tolerance})}}'),
    )
    assert figures.load("tiny").plates["A"].tolerance.relative == 1e-7


def test_names_and_plates_are_in_order(project: Path) -> None:
    _write(project, "ch10/tiny.py", _tiny())
    _write(
        project,
        "own_figure.py",
        _tiny(arguments='plates={"Z": Plate("T", (), "C.")}').replace("tiny", "own_figure"),
    )
    _write(project, "ch9/_helper.py", "raise RuntimeError")
    assert list(figures.names()) == ["own-figure", "tiny", "arc"]
    assert figures.plates() == {"Z": "own-figure", "A": "tiny", "T9": "arc", "T10": "arc"}
    assert figures.load("own-figure").chapter == ""
    assert figures.summaries()["arc"] == "Turn an arc."


def test_two_files_with_one_command_are_named(project: Path) -> None:
    files = [project / "figures/ch9/arc.py", _write(project, "ch8/arc.py", _ARC)]
    with pytest.raises(figures.FigureError, match="two files make the command arc") as error:
        figures.names()
    assert all(str(file) in str(error.value) for file in files)


def test_two_files_with_one_plate_are_named(project: Path) -> None:
    files = [
        project / "figures/ch9/arc.py",
        _write(project, "ch9/bow.py", _ARC.replace("def arc", "def bow")),
    ]
    with pytest.raises(figures.FigureError, match="two files have the plate T10") as error:
        figures.plates()
    assert all(str(file) in str(error.value) for file in files)


def test_a_broken_file_is_listed_as_broken_and_stops_the_list_of_plates(project: Path) -> None:
    _write(project, "ch9/tiny.py", "def broken(:\n")
    assert figures.summaries()["tiny"].startswith("broken: ")
    assert figures.summaries()["arc"] == "Turn an arc."
    with pytest.raises(figures.FigureError, match="invalid syntax"):
        figures.plates()


def test_the_declaration_says_what_the_figure_does(project: Path) -> None:
    declared, loaded = figures.declare("arc"), figures.load("arc")
    for field in ("name", "parameters", "plates", "time", "file", "chapter", "summary", "help"):
        assert getattr(declared, field) == getattr(loaded, field), field


def test_a_declaration_that_needs_numpy_is_loaded(project: Path) -> None:
    text = _ARC.replace("= 90,", "= float(np.degrees(0.5 * np.pi)),")
    _write(project, "ch9/bow.py", text.replace("def arc", "def bow").replace('"T', '"U'))
    assert figures.declare("bow").parameters[3].default == 90.0


def test_a_name_that_is_near_is_told(project: Path) -> None:
    with pytest.raises(figures.FigureError, match=r"no figure 'arck'. Nearest: arc\."):
        figures.load("arck")


def test_a_project_must_have_figures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(figures.PROJECT, str(tmp_path))
    with pytest.raises(figures.FigureError, match="must be a folder with a folder figures/ in it"):
        figures.names()


def test_two_projects_may_have_figures_of_one_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in ("a", "b"):
        _write(tmp_path / folder, "ch9/tiny.py", _tiny(doc=f'"""In {folder}."""'))
    for folder in ("a", "b"):
        monkeypatch.setenv(figures.PROJECT, str(tmp_path / folder))
        assert figures.load("tiny").summary == f"In {folder}."


def test_what_our_own_figures_declare_needs_no_numpy() -> None:
    import subprocess

    code = (
        "import sys; from lietool import figure\n"
        "for name in figure.names(): figure.declare(name)\n"
        "assert 'numpy' not in sys.modules, 'numpy'"
    )
    environment = {key: value for key, value in os.environ.items() if key != figures.PROJECT}
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)
