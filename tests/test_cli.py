"""The command line, on a project of toy figures; by really starting it where the process matters."""

import errno
import json
import math
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import click
import pytest
from click.testing import CliRunner, Result
from PIL import Image, ImageSequence

import lietool
from lietool import atomic, figure, paths
from lietool.cli import command
from lietool.render import context, draw, style, theme, video
from lietool.verbs import _command, _film, _picture, _size, bench

_BALL = '''
"""A ball on a circle."""
from pathlib import Path
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.render.scene import Picture, Points, View


@figure(
    plates={"T1": Plate("Ball", ("1.1", "1.2"), "Red."), "T1b": Plate("Blue", (), "Blue.", {"hue": "blue"})},
    time=Time("turn", 0, 360, frames=8, seconds=0.8, closed=True),
)
def ball(
    hue: Annotated[Literal["red", "blue"], Param("its colour")] = "red",
    q0: Annotated[tuple[float, float, float, float], Param("start (w, x, y, z)")] = (1.0, 0.0, 0.0, 0.0),
    turn: Annotated[float, Param("swept angle", "deg", 0, 360)] = 90.0,
    shaded: Annotated[bool, Param("light it")] = True,
    dent: Annotated[int, Param("what goes wrong", low=0)] = 0,
    mesh: Annotated[Path | None, Param("a mesh of your own")] = None,
) -> Drawing:
    """A ball on a circle.

    What to look for: where it is.
    """
    if not any(q0):
        raise ValueError("quaternion.normalize: q must be different from zero; got 0.")
    if dent:
        missing = OSError(2, "No such file", "x.obj")
        raise [KeyError("a bug"), KeyboardInterrupt(), missing, SystemExit(0), MemoryError()][dent - 1]
    angle = np.radians(turn)
    place = np.array([[32 + 16 * np.cos(angle), 24 + 16 * np.sin(angle), 0]])
    record = Points(place, {"red": "#c8372d", "blue": "#2b66b1"}[hue], radius=6, shaded=shaded)
    return Drawing(Picture((View((record,)),), (64, 48)), {"place": place, "hue": hue})
'''
_STILL = '''
from lietool.figure import Drawing, Plate, figure
from lietool.render.scene import Picture


@figure(plates={"S1": Plate("Paper", (), "Paper.")})
def still() -> Drawing:
    """Nothing but paper."""
    return Drawing(Picture((), (64, 48)), {})
'''
_CHOICE = '''
from typing import Annotated, Literal

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.render.scene import Picture


@figure(
    plates={"C1": Plate("One", (), "One."), "C2": Plate("Two", (), "Two.", {"view": "two"})},
    time=Time("turn", 0, 90),
)
def choice(
    view: Annotated[Literal["one", "two", "three"], Param("what to draw")] = "one",
    turn: Annotated[float, Param("swept angle", "deg", 0, 90, only=("view", "one", "three"))] = 0.0,
    bold: Annotated[bool, Param("thick lines", only=("view", "two"))] = False,
) -> Drawing:
    """Choose."""
    return Drawing(Picture((), (64, 48)), {})
'''
_ENDINGS = ".png, .svg, .pdf, .gif, .apng or .mp4"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to work in, with a project of toy figures and none of ours."""
    chapter = tmp_path / "project/figures/ch9"
    chapter.mkdir(parents=True)
    (chapter / "ball.py").write_text(_BALL)
    (chapter / "still.py").write_text(_STILL)
    monkeypatch.setenv(figure.PROJECT, str(tmp_path / "project"))
    monkeypatch.setattr(paths, "FIGURES", tmp_path / "none")
    work = tmp_path / "work"
    work.mkdir()
    monkeypatch.chdir(work)
    return work


def _run(*arguments: str) -> Result:
    result = CliRunner().invoke(command, arguments)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result


def _start(*arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "lietool", *arguments],
        capture_output=True,
        text=True,
        env=os.environ | variables,
        timeout=60,
    )


def _refused(result: Result) -> str:
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.count("\n") == 1, result.stderr
    return result.stderr.strip()


def test_bare_it_says_what_to_try(folder: Path) -> None:
    result = _run()
    assert result.exit_code == 0
    tried = [line.split()[1] for line in result.stdout.splitlines()[1:]]
    assert tried == ["slerp", "slerp", "figures"]


def test_help_lists_figures_by_chapter_and_verbs(folder: Path) -> None:
    result = _run("--help")
    assert result.exit_code == 0
    assert "Chapter 9:\n  ball   A ball on a circle.\n  still  Nothing but paper." in result.stdout
    assert "  doctor " in result.stdout
    assert "  _command" not in result.stdout


def test_a_broken_file_is_one_line_of_help_and_of_its_command(folder: Path) -> None:
    file = folder.parent / "project/figures/ch9/torn.py"
    file.write_text("def torn(:\n")
    result = _run("--help")
    assert result.exit_code == 0
    assert "torn   broken: " in result.stdout
    assert "A ball on a circle" in result.stdout
    assert _refused(_run("torn")) == f"lietool: {file}: line 1: invalid syntax"
    assert _run("ball", "--json").exit_code == 0


def test_help_of_a_figure_says_all(folder: Path) -> None:
    text = " ".join(_run("ball", "--help").stdout.split())
    for words in (
        "A ball on a circle. What to look for: where it is.",
        "--hue red|blue its colour [default red]",
        "--q0 W,X,Y,Z start (w, x, y, z) [default 1,0,0,0]",
        "--turn NUMBER swept angle [0 to 360 deg; default 90]",
        "--shaded / --no-shaded light it [default --shaded]",
        "--dent N what goes wrong [at least 0; default 0]",
        "--mesh FILE a mesh of your own",
        "Plates: T1 Ball (1.1, 1.2) T1b Blue",
        "[default ./ball.png]",
    ):
        assert words in text
    for option in figure.RESERVED:
        assert f"--{option} " in text


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (
            "--view two --turn 3",
            "--turn has a part in the picture only with --view one or three. Leave it out, or write that",
        ),
        (
            "--plate C2 --turn 3",
            "--turn has a part in the picture only with --view one or three. Leave it out, or write that",
        ),
        ("--no-bold", "--bold has a part in the picture only with --view two. Leave it out, or write that"),
        (
            "--view two -o a.gif",
            "a .gif sweeps --turn, which has a part in the picture only with --view one or three. "
            "Write a .png",
        ),
    ],
)
def test_an_option_without_a_part_in_the_picture(folder: Path, arguments: str, line: str) -> None:
    (folder.parent / "project/figures/ch9/choice.py").write_text(_CHOICE)
    assert _refused(_run("choice", *arguments.split())) == f"lietool choice: {line}"
    text = " ".join(_run("choice", "--help").stdout.split())
    assert "swept angle [with --view one or three; 0 to 90 deg; default 0]" in text
    assert "thick lines [with --view two; default --no-bold]" in text
    for fine in ("--plate C2 --view three --turn 3", "--view two --bold", "--turn 3"):
        assert _run("choice", *fine.split(), "--json").exit_code == 0


def test_the_common_options_are_the_reserved_names(folder: Path) -> None:
    def names(figure_: figure.Figure) -> set[str]:
        made = _command.command(figure_)
        options = {name for option in made.get_params(click.Context(made)) for name in option.opts}
        return options - {parameter.option for parameter in figure_.parameters}

    assert names(figure.load("ball")) == {"-o", *(f"--{name}" for name in figure.RESERVED)}
    assert names(figure.load("ball")) - names(figure.load("still")) == {"--seconds", "--fps"}


def test_backends_sizes_and_themes_are_those_of_the_renderer() -> None:
    assert _size.LARGEST == draw.LARGEST
    assert _command.BACKENDS == context.BACKENDS
    assert set(_picture.THEMES) == theme.THEMES.keys()
    assert _picture.Quality().look == theme.BOOK


def test_a_png_remembers_what_it_is(folder: Path) -> None:
    result = _run("ball", "--draft")
    assert (result.exit_code, result.stdout) == (0, "ball.png\n")
    with Image.open(folder / "ball.png") as image:
        assert image.size == (64, 48)
        text = dict(image.info)
        # 90 degrees: above the middle, and red.
        red, green, _ = image.convert("RGB").getpixel((32, 8))  # type: ignore[misc]
    assert red > 150 > green
    assert text["Software"] == f"lietool {lietool.__version__}"
    assert (text["command"], text["plate"], text["Title"]) == ("ball", "T1", "Ball")
    assert json.loads(text["parameters"])["q0"] == [1.0, 0.0, 0.0, 0.0]
    assert text["renderer"] == context.get().info["renderer"]


def test_a_plate_is_a_start_and_options_win(folder: Path) -> None:
    def hue(*arguments: str) -> str:
        return json.loads(_run("ball", "--json", *arguments).stdout)["hue"]

    assert hue() == "red"
    assert hue("--plate", "T1b") == "blue"
    assert hue("--plate", "t1B") == "blue"
    assert hue("--plate", "T1b", "--hue", "red") == "red"
    assert hue("--hue", "red", "--plate", "T1b") == "red"
    _run("ball", "--draft", "--plate", "T1b", "--turn", "3", "-o", "a.png")
    with Image.open(folder / "a.png") as image:
        assert "plate" not in image.info and image.info["Title"] == "A ball on a circle"


def test_json_alone_writes_nothing_and_with_output_both(folder: Path) -> None:
    result = _run("ball", "--json", "--turn", "0")
    assert json.loads(result.stdout)["place"]["data"] == [48.0, 24.0, 0.0]
    assert list(folder.iterdir()) == []
    result = _run("ball", "--json", "--draft", "-o", "a.png")
    assert json.loads(result.stdout)["hue"] == "red"
    assert result.stderr == "a.png\n"
    assert (folder / "a.png").is_file()


def test_size_and_upper_case_ending(folder: Path) -> None:
    assert _run("still", "--size", "80X40", "--draft", "-o", "a.PNG").exit_code == 0
    with Image.open(folder / "a.PNG") as image:
        assert image.size == (80, 40)


def test_values_that_begin_with_a_minus(folder: Path) -> None:
    assert _run("ball", "--json", "--q0", "-1,0,0,-.5").exit_code == 0
    assert _run("ball", "--json", "--q0=-1,0,0,0").exit_code == 0
    assert "got '-1'" in _refused(_run("ball", "--turn", "-1"))


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ("bal", ": no command 'bal'. Nearest: ball. lietool --help lists all"),
        ("T1b", ": T1b is a plate. Write lietool ball --plate T1b"),
        ("--projct x", ": no option '--projct'. Nearest: --project."),
        ("ball --trn 3", " ball: no option '--trn'. Nearest: --turn."),
        ("ball --plate T2", " ball: --plate must be one of T1, T1b; got 'T2'. Nearest: T1."),
        ("ball --plate S1", " ball: plate S1 belongs to another command. Write lietool still --plate S1"),
        ("ball --hue bleu", " ball: --hue must be one of red, blue; got 'bleu'. Nearest: blue."),
        (
            "ball --q0 1,0,0",
            " ball: --q0 must be four finite numbers w,x,y,z; got '1,0,0'. Write for example --q0 1,0,0,0",
        ),
        (
            "ball --turn nan",
            " ball: --turn must be a finite number, 0 to 360 deg; got 'nan'. Write for example --turn 90",
        ),
        ("ball --q0 0,0,0,0", " ball: quaternion.normalize: q must be different from zero; got 0."),
        ("ball --mesh x.obj", " ball: --mesh must be a file that exists; got 'x.obj'."),
        ("ball --dent 3", " ball: No such file: x.obj"),
        (
            "ball --dent 5",
            " ball: not enough memory. Make a smaller picture with --size, or give a smaller file",
        ),
        ("ball 3", " ball: Got unexpected extra argument (3). See lietool ball --help"),
        ("ball --turn", " ball: Option '--turn' requires an argument."),
        (
            "ball --size 0x3",
            " ball: --size must be 1 to 20000 pixels each way; got '0x3'. Write for example 1200x900",
        ),
        (
            "ball --size 20001x3",
            " ball: --size must be 1 to 20000 pixels each way; got '20001x3'. Write for example 1200x900",
        ),
        *(
            (
                f"ball --size {size}",
                " ball: --size must be width x height in pixels, such as 1200x900, or a width or both in "
                f"cm, mm, in or pt, such as 8.5cm; got '{size}'",
            )
            for size in ("30", "axb", "nancm", "-3cm", "1e2cm", "8.5", "8.5cmx6", "3km", ".cm")
        ),
        *(
            (
                f"ball --size {size}",
                f" ball: --size must be more than 0 and up to 200in; got '{size}'. Write for example 8.5cm",
            )
            for size in ("0cm", "0.0mmx5cm", "201in", "9cmx999cm")
        ),
        (
            "ball --size 180cm",
            " ball: --size must be 1 to 20000 pixels each way; got 180cm at 300 dots per inch, which is "
            "21260 x 15945. Change --size or --dpi",
        ),
        (
            "ball --size 0.1mm --dpi 72",
            " ball: --size must be 1 to 20000 pixels each way; got 0.1mm at 72 dots per inch, which is "
            "0 x 0. Change --size or --dpi",
        ),
        *(
            (
                f"ball --size 8.5cm --dpi {dpi}",
                f" ball: --dpi must be dots per inch, 1 to 4800; got '{dpi}'. Write for example 300",
            )
            for dpi in ("0", "nan", "inf", "-300", "4801", "many")
        ),
        *(
            (
                f"ball --dpi 600{size}",
                " ball: --dpi says how many pixels a length has, and no length is given. "
                "Write for example --size 8.5cm --dpi 600",
            )
            for size in ("", " --size 64x48", " -o a.gif")
        ),
        *(
            (
                f"ball --size 640x480 -o a.{ending}",
                f" ball: --size 640x480 is in pixels, but a .{ending} has none. "
                "Write a length, for example --size 12cm",
            )
            for ending in ("svg", "pdf")
        ),
        (
            "ball --theme night",
            " ball: Invalid value for '--theme': 'night' is not one of 'book', 'dark', 'print'.",
        ),
        *(
            (
                f"ball {option} -o a.{ending}",
                " ball: --seconds and --fps are for films. Write one of .gif, .apng or .mp4 with --output",
            )
            for option, ending in (("--seconds 2", "png"), ("--fps 30", "svg"))
        ),
        (
            "ball --fps 0 -o a.gif",
            " ball: --fps must be a number of pictures a second, more than 0 and up to 60; got '0'. "
            "Write for example 30",
        ),
        (
            "ball --seconds nan -o a.gif",
            " ball: --seconds must be a number of seconds, more than 0 and up to 600; got 'nan'. "
            "Write for example 4",
        ),
        (
            "ball --seconds 600 --fps 60 -o a.mp4",
            " ball: a film must have 2 to 3600 pictures; got 36000, 60 a second in 600 seconds. "
            "Change --seconds or --fps",
        ),
        (
            "ball --fps .1 -o a.apng",
            " ball: a film must have 2 to 3600 pictures; got 0, 0.1 a second in 0.8 seconds. "
            "Change --seconds or --fps",
        ),
        (
            f"ball --dent {'9' * 400}",
            f" ball: --dent must be a whole number, at least 0; got '{'9' * 60}...'. "
            "Write for example --dent 0",
        ),
        (
            "ball --output=",
            " ball: --output '' is a folder. Write a file name, ending in " + _ENDINGS,
        ),
        (
            "ball -o a.png/",
            " ball: --output a.png/ is a folder. Write a file name, ending in " + _ENDINGS,
        ),
        (
            f"ball -o {'a' * 300}.png",
            f" ball: --output {'a' * 300}.png: File name too long. Choose another name",
        ),
        ("ball -o a.jpg", " ball: --output must end in .png, .svg, .pdf, .gif, .apng or .mp4; got 'a.jpg'"),
        ("ball -o no/a.png", " ball: --output no/a.png: there is no folder no. Make it first"),
        ("still -o a.gif", " still: still has no time to animate. Write a .png"),
        (
            "ball -o a.gif --turn 3",
            " ball: a .gif sweeps --turn, so it cannot be given too. Leave out --turn, or write a .png",
        ),
        (
            "ball -o a.mp4 --turn 3",
            " ball: a .mp4 sweeps --turn, so it cannot be given too. Leave out --turn, or write a .png",
        ),
    ],
)
def test_a_mistake_is_one_line(folder: Path, arguments: str, line: str) -> None:
    assert _refused(_run(*arguments.split())) == "lietool" + line
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e400", "360.0001", "", "ninety", "1,2"])
def test_numbers_that_are_none_are_refused(folder: Path, value: str) -> None:
    assert f"--turn must be a finite number, 0 to 360 deg; got {value!r}" in _refused(
        _run("ball", "--turn", value)
    )


def test_an_output_that_is_a_folder(folder: Path) -> None:
    (folder / "a.png").mkdir()
    assert "a.png is a folder" in _refused(_run("ball", "-o", "a.png"))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs a file that is no ordinary one")
def test_an_output_that_is_a_pipe(folder: Path) -> None:
    os.mkfifo(folder / "a.png")
    assert "--output a.png is a device or a pipe" in _refused(_run("ball", "-o", "a.png"))


@pytest.mark.parametrize("text", ["9" * 5000 + "x1", "9" * 400 + "cm", "x" * 5000])
def test_of_a_long_size_the_beginning_is_shown(folder: Path, text: str) -> None:
    said = _refused(_run("ball", "--size", text))
    assert f"got {text[:60] + '...'!r}" in said
    assert len(said) < 300


@pytest.mark.parametrize(("module", "package"), [("jinja2", "jinja2"), ("PIL.Image", "pillow")])
def test_a_package_that_is_missing(
    folder: Path, monkeypatch: pytest.MonkeyPatch, module: str, package: str
) -> None:
    def missing(*_: object) -> None:
        raise ModuleNotFoundError(f"No module named {module!r}", name=module)

    monkeypatch.setattr(atomic, "write_bytes", missing)
    said = _refused(_run("ball"))
    assert said.endswith(f"No module named {module!r}. Install it with: pip install {package}")


def test_a_module_of_our_own_that_is_missing_is_a_bug(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(*_: object) -> None:
        raise ModuleNotFoundError("No module named 'lietool.gone'", name="lietool.gone")

    monkeypatch.setattr(atomic, "write_bytes", missing)
    with pytest.raises(ModuleNotFoundError):
        _run("ball")


def test_a_folder_that_is_not_writable(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)
    assert f"the folder {folder} is not writable" in _refused(_run("ball", "-o", "a.png"))


def test_a_full_disk(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(atomic, "write_bytes", full)
    line = _refused(_run("still", "--draft"))
    assert line.startswith("lietool still: cannot write still.png: No space left on device. Choose another")


def test_nothing_to_render_with(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(*_: object) -> None:
        raise context.NoRendererError({"osmesa": "not there"})

    monkeypatch.setattr(context, "get", none)
    result = _run("still")
    assert (result.exit_code, result.stdout) == (4, "")
    assert "osmesa: not there" in result.stderr
    assert _run("still", "--json").exit_code == 0


def test_two_files_of_one_name(folder: Path) -> None:
    other = folder.parent / "project/figures/ch8"
    other.mkdir()
    (other / "still.py").write_text(_STILL)
    assert "two files make the command still" in _refused(_run("--help"))


def test_a_project_that_is_none(folder: Path) -> None:
    line = _refused(_run("--project", "nowhere", "still"))
    assert line.startswith("lietool: project nowhere must be a folder with a folder figures/ in it")


def test_a_gif_goes_round_without_flicker(folder: Path) -> None:
    assert _run("ball", "--draft", "-o", "a.gif").stdout == "a.gif\n"
    with Image.open(folder / "a.gif") as image:
        assert image.info["loop"] == 0
        frames = [frame.convert("RGB") for frame in ImageSequence.Iterator(image)]
    assert len(frames) == 8
    # The paper stays paper, and the ball is where its angle says.
    assert {frame.getpixel((1, 1)) for frame in frames} == {(255, 255, 255)}
    assert frames[0].getpixel((48, 24)) == frames[4].getpixel((16, 24)) != (255, 255, 255)
    assert frames[0].getpixel((16, 24)) == (255, 255, 255)


def test_a_film_draws_every_moment_once(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[object] = []
    monkeypatch.setattr(figure.Figure, "draw", _counting(drawn))
    assert _run("ball", "--draft", "-o", "a.gif").exit_code == 0
    assert drawn == [45.0 * k for k in range(8)]
    drawn.clear()
    assert json.loads(_run("ball", "--draft", "-o", "a.gif", "--json").stdout)["hue"] == "red"
    assert drawn == [90.0, *(45.0 * k for k in range(8))]


def test_a_figure_may_draw_all_moments_of_a_film_together(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[list[float]] = []
    alone = figure.Figure.draw

    def draw(self: figure.Figure, **params: object) -> figure.Drawing:
        def film(moments: Sequence[float]) -> list[object]:
            asked.append(list(moments))
            return [alone(self, **params | {"turn": turn}).picture for turn in moments]

        return replace(alone(self, **params), film=film)

    monkeypatch.setattr(figure.Figure, "draw", draw)
    assert _run("ball", "--draft", "-o", "a.gif").exit_code == 0
    assert asked == [[45.0 * k for k in range(8)]]
    with Image.open(folder / "a.gif") as image:
        assert len(list(ImageSequence.Iterator(image))) == 8


def _counting(drawn: list[object]) -> Callable[..., object]:
    draw_ = figure.Figure.draw

    def counted(self: figure.Figure, **params: object) -> object:
        drawn.append(params["turn"])
        return draw_(self, **params)

    return counted


def test_a_moving_png_goes_round_in_all_colours(folder: Path) -> None:
    assert _run("ball", "--draft", "-o", "a.apng").stdout == "a.apng\n"
    with Image.open(folder / "a.apng") as image:
        assert image.format == "PNG" and image.info["loop"] == 0 and image.info["command"] == "ball"
        assert image.info["Title"] == "Ball"
        durations, frames = [], []
        for frame in ImageSequence.Iterator(image):
            durations.append(frame.info["duration"])
            frames.append(frame.convert("RGB"))
    # 0.8 seconds at 30 a second.
    assert len(frames) == 24 and sum(durations) == 800.0
    _run("ball", "--draft", "--turn", "0", "-o", "b.png")
    with Image.open(folder / "b.png") as still:
        assert frames[0].tobytes() == still.convert("RGB").tobytes() != frames[12].tobytes()


def test_an_mp4_plays_everywhere(folder: Path) -> None:
    import av

    assert _run("ball", "--draft", "--size", "65x49", "--seconds", "0.5", "-o", "a.mp4").exit_code == 0
    with av.open(str(folder / "a.mp4")) as film:
        (stream,) = film.streams
        assert isinstance(stream, av.VideoStream)
        # Even numbers of pixels, for its colours have half as many.
        assert (stream.width, stream.height, stream.pix_fmt) == (66, 50, "yuv420p")
        assert stream.codec_context.name.startswith("h264") and stream.average_rate == 30
        assert film.metadata["title"] == "Ball" and "command ball" in film.metadata["comment"]
        frames = [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]
    assert len(frames) == 15
    assert frames[0][1, 1].min() >= 254
    red, green, _ = frames[0][25, 49]
    assert red > 150 > green and frames[0][25, 17].min() > 240


def test_an_mp4_without_an_encoder(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("av", "av.codec"):
        monkeypatch.setitem(sys.modules, name, None)
    line = _refused(_run("ball", "-o", "a.mp4"))
    assert line.startswith("lietool ball: a .mp4 needs PyAV with its encoder for H.264, which cannot be used")
    assert line.endswith("Install it with: pip install av, or write a .gif or .apng")
    assert list(folder.iterdir()) == []
    with pytest.raises(video.NoEncoderError):
        video.require()


def test_a_length_and_its_dots_are_kept(folder: Path) -> None:
    for size, dpi, pixels in (
        ("8.5cm", None, (1004, 753)),
        ("85mm", "300", (1004, 753)),
        ("2in", "100", (200, 150)),
        ("72pt", "96", (96, 72)),
        ("4CMx1cm", "127", (200, 50)),
    ):
        arguments = ["--dpi", dpi] if dpi else []
        assert _run("ball", "--draft", "--size", size, *arguments, "-o", "a.png").exit_code == 0
        with Image.open(folder / "a.png") as image:
            assert image.size == pixels
            assert image.info["dpi"] == pytest.approx([float(dpi or 300)] * 2, abs=0.02)
    _run("ball", "--draft", "-o", "a.png")
    with Image.open(folder / "a.png") as image:
        assert "dpi" not in image.info


def test_vectors_have_the_length_asked_for(folder: Path) -> None:
    for size, points in (((), (18.1417, 13.6063)), (("--size", "8.5cm"), (240.9449, 180.7087))):
        for name in ("a.svg", "a.PDF"):
            assert _run("ball", "--no-shaded", *size, "-o", name).exit_code == 0
        text = (folder / "a.svg").read_text()
        found = re.findall(r'width="([\d.]+)pt" height="([\d.]+)pt"', text)[0]
        assert [float(side) for side in found] == pytest.approx(points, abs=1e-3)
        assert "<image" not in text and "<title>" in text
        found = re.findall(rb"/MediaBox \[ 0 0 ([\d.]+) ([\d.]+) \]", (folder / "a.PDF").read_bytes())[0]
        assert [float(side) for side in found] == pytest.approx(points, abs=1e-3)


def test_vectors_of_a_page_need_no_renderer(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(*_: object) -> None:
        raise context.NoRendererError({"osmesa": "not there"})

    monkeypatch.setattr(context, "get", none)
    assert _run("ball", "--no-shaded", "-o", "a.pdf").exit_code == 0
    assert _run("ball", "-o", "b.svg").exit_code == 4
    assert [path.name for path in folder.iterdir()] == ["a.pdf"]


def test_themes(folder: Path) -> None:
    for name, look in theme.THEMES.items():
        assert _run("still", "--draft", "--theme", name, "-o", "a.png").exit_code == 0
        with Image.open(folder / "a.png") as image:
            assert image.convert("RGB").getpixel((5, 5)) == tuple(look.srgb(style.PAPER).astype(int))
        assert _run("still", "--theme", name, "-o", "a.svg").exit_code == 0
        assert f"fill: {look.hex(style.PAPER)}" in (folder / "a.svg").read_text()


def test_a_sweep_that_is_not_closed_goes_forth_and_back() -> None:
    places = _film.sweep(figure.Time("t", 1.0, 3.0, frames=6))
    assert places[0] == 1.0
    assert max(places) == places[3] == 3.0
    assert places[1:3] == places[:3:-1]
    closed = _film.sweep(figure.Time("t", 0.0, 360.0, frames=4, closed=True))
    assert closed == [0.0, 90.0, 180.0, 270.0]


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize(
    ("ending", "pace"), [(".gif", (None, None)), (".mp4", (None, None)), (".apng", (1.7, 25.0))]
)
def test_a_loop_has_no_hitch(closed: bool, ending: str, pace: tuple[float | None, float | None]) -> None:
    time = _film.paced(figure.Time("t", 0.0, 360.0, closed=closed), ending, _film.Pace(*pace))
    places = _film.sweep(time)
    count = len(places)
    # Round the loop, past its end: how far it goes from frame to frame, and how suddenly that changes.
    steps = [places[(k + 1) % count] - places[k] for k in range(count)]
    if closed:
        steps[-1] += 360.0
        assert steps == pytest.approx([360.0 / count] * count)
    else:
        changes = [abs(steps[k] - steps[k - 1]) for k in range(count)]
        assert max(changes) <= 180.0 * (2.0 * math.pi / count) ** 2
        assert places[count // 2] == max(places) == 360.0


@pytest.mark.parametrize(
    ("ending", "pace", "frames", "seconds"),
    [
        (".gif", (None, None), 48, 4.0),
        (".mp4", (None, None), 120, 4.0),
        (".apng", (None, None), 120, 4.0),
        (".gif", (2.0, None), 24, 2.0),
        (".mp4", (2.0, None), 60, 2.0),
        (".gif", (None, 25.0), 100, 4.0),
        (".mp4", (1.0, 24.5), 24, 1.0),
        (".apng", (0.5, 50.0), 26, 0.5),
    ],
)
def test_the_pace_of_a_film(
    ending: str, pace: tuple[float | None, float | None], frames: int, seconds: float
) -> None:
    found = _film.paced(figure.Time("t", 0.0, 1.0), ending, _film.Pace(*pace))
    assert (found.frames, found.seconds) == (frames, seconds)


def test_an_interruption_ends_with_130(folder: Path) -> None:
    result = _run("ball", "--dent", "2", "--json")
    assert (result.exit_code, result.stdout) == (130, "")


def test_a_bug_is_one_line_and_its_traceback_can_be_had(folder: Path) -> None:
    result = _start("ball", "--dent", "1", "--json")
    assert (result.returncode, result.stdout) == (1, "")
    assert result.stderr.count("\n") == 1
    assert result.stderr.startswith("lietool ball --dent 1 --json: KeyError: 'a bug' (ball.py, line ")
    assert "LIETOOL_TRACEBACK=1" in result.stderr
    result = _start("ball", "--dent", "1", "--json", LIETOOL_TRACEBACK="1")
    assert result.returncode == 1
    assert "Traceback" in result.stderr
    result = _start("ball", "--q0", "0,0,0,0", "--json", LIETOOL_TRACEBACK="1")
    assert result.returncode == 2
    assert "Traceback" in result.stderr


def test_a_figure_that_ends_the_process_is_no_success(folder: Path) -> None:
    result = _run("ball", "--dent", "4", "--json")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr == (
        "lietool ball: the figure ended the process, by exit(0). Raise ValueError in it instead\n"
    )


@pytest.mark.skipif(sys.platform == "win32", reason="a shell's way to close a stream")
@pytest.mark.parametrize("words", ["ball", "ball --json", "figures list", ""])
def test_a_closed_output_is_no_error(folder: Path, words: str) -> None:
    call = f'exec "$0" -m lietool {words} >&-'
    result = subprocess.run(["sh", "-c", call, sys.executable], stderr=subprocess.PIPE, text=True, timeout=60)
    assert (result.returncode, result.stderr) == (0, "")


def test_a_name_as_long_as_it_may_be(folder: Path) -> None:
    name = "é" * 120 + ".png"
    assert _run("still", "-o", name).exit_code == 0
    assert [path.name for path in folder.iterdir()] == [name]


def test_a_reader_who_leaves_is_no_error(folder: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    call = [sys.executable, "-m", "lietool", "ball", "--json"]
    result = subprocess.run(call, stdout=writing, stderr=subprocess.PIPE, text=True, timeout=60)
    os.close(writing)
    assert (result.returncode, result.stderr) == (141, "")


def test_ctrl_c_in_the_middle(folder: Path) -> None:
    file = folder.parent / "project/figures/ch9/slow.py"
    slow = _STILL.replace("def still", "def slow").replace('"S1"', '"S2"')
    file.write_text(
        slow.replace(
            "    return", "    import time\n    print('started', flush=True)\n    time.sleep(60)\n    return"
        )
    )
    # A shell ignores the signal for what it runs in the background, and that is inherited.
    heed = (
        "import os, signal, sys\n"
        "signal.signal(signal.SIGINT, signal.SIG_DFL)\n"
        "os.execv(sys.argv[1], sys.argv[1:])"
    )
    call = [sys.executable, "-c", heed, sys.executable, "-m", "lietool", "slow"]
    with subprocess.Popen(call, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "started\n"
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert errors.strip() == ""
    assert list(folder.iterdir()) == []


def test_help_and_completion_import_no_numpy_and_no_figure(folder: Path) -> None:
    (folder.parent / "project/figures/ch9/ball.py").write_text(
        _BALL.replace('"""A ball', 'import sys\nsys.exit(99)\n"""', 1)
    )
    code = (
        "import sys; from lietool.cli import command\n"
        "try: command.main(sys.argv[1:])\n"
        "except SystemExit as stop: assert not stop.code, stop.code\n"
        "loaded = {'numpy', 'rich', 'matplotlib', 'moderngl', 'PIL'} & sys.modules.keys()\n"
        "assert not loaded, loaded\n"
    )
    for variables in (
        {},
        {"_LIETOOL_COMPLETE": "bash_complete", "COMP_WORDS": "lietool b", "COMP_CWORD": "1"},
    ):
        arguments = [] if variables else ["--help"]
        call = [sys.executable, "-c", code, *arguments]
        result = subprocess.run(call, capture_output=True, text=True, env=os.environ | variables, timeout=60)
        assert (result.returncode, result.stderr) == (0, "")
        assert "ball" in result.stdout


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ("lietool st", ["still"]),
        ("lietool fig", ["figures"]),
        ("lietool ball --plate ", ["T1", "T1b"]),
        ("lietool ball --hue b", ["blue"]),
        ("lietool ball --tu", ["--turn"]),
        ("lietool ball --backend e", ["egl"]),
    ],
)
def test_completion(folder: Path, monkeypatch: pytest.MonkeyPatch, words: str, found: list[str]) -> None:
    monkeypatch.setenv("_LIETOOL_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", words)
    monkeypatch.setenv("COMP_CWORD", str(len(words.split(" ")) - 1))
    result = _run()
    assert result.exit_code == 0
    assert [line.partition(",")[2] for line in result.stdout.split()] == found


def test_the_script_for_the_shell(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("_LIETOOL_COMPLETE", "zsh_source")
    assert "#compdef lietool" in _run().stdout


def test_version_and_module(folder: Path) -> None:
    assert _start("--version").stdout == f"lietool, version {lietool.__version__}\n"


def test_the_benchmark_tells_what_it_measured(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = {
        "seconds": {"import numpy": 0.1, "lietool --help": 0.2, "lietool slerp": 0.5},
        "plates": {"T1": 0.39},
        "megabytes": {"twice": 200.0, "six times": 201.0},
        "backend": "osmesa",
        "cpus": 2,
        "runs": 3,
    }
    monkeypatch.setattr(bench, "measure", lambda runs: found | {"runs": runs})
    assert json.loads(_run("bench", "startup", "--runs", "5", "--json").stdout) == found | {"runs": 5}
    rows = [line.split() for line in _run("bench", "startup").stdout.splitlines()]
    assert rows[0][:4] == ["Median", "of", "10", "runs,"]
    assert ["lietool", "--help", "0.200", "s", "<", "0.130", "s", "missed"] in rows
    assert ["plate", "T1", "0.390", "s", "<", "0.400", "s", "met"] in rows


def test_the_benchmark_draws_every_plate(folder: Path) -> None:
    result = _run("bench", "work")
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    assert found["plates"].keys() == {"T1", "T1b", "S1"}
    assert found["megabytes"]["six times"] >= found["megabytes"]["twice"] > 0
    assert "work" not in _run("bench", "--help").stdout


class TestWriting:
    def test_a_link_stays_a_link_and_a_file_keeps_its_mode(self, tmp_path: Path) -> None:
        target, link = tmp_path / "there.png", tmp_path / "link.png"
        target.write_bytes(b"old")
        target.chmod(0o640)
        link.symlink_to(target)
        atomic.write_bytes(link, b"new")
        assert link.is_symlink()
        assert target.read_bytes() == b"new"
        assert target.stat().st_mode & 0o777 == 0o640

    @pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs a file that is no ordinary one")
    def test_a_pipe_or_a_device_stays_what_it_is(self, tmp_path: Path) -> None:
        os.mkfifo(tmp_path / "pipe")
        (tmp_path / "link.png").symlink_to("pipe")
        for name in ("pipe", "link.png"):
            with pytest.raises(OSError, match="device or a pipe"):
                atomic.write_bytes(tmp_path / name, b"new")
        assert (tmp_path / "pipe").is_fifo()
        assert sorted(path.name for path in tmp_path.iterdir()) == ["link.png", "pipe"]

    def test_links_that_go_round_are_an_error_of_the_disk(self, tmp_path: Path) -> None:
        (tmp_path / "a.png").symlink_to("a.png")
        with pytest.raises(OSError, match=os.strerror(errno.ELOOP)):
            atomic.write_bytes(tmp_path / "a.png", b"new")
        assert [path.name for path in tmp_path.iterdir()] == ["a.png"]

    @pytest.mark.skipif(os.geteuid() == 0, reason="root may write what is read-only")
    def test_a_file_that_is_read_only_is_left_alone(self, tmp_path: Path) -> None:
        target = tmp_path / "kept.png"
        target.write_bytes(b"old")
        target.chmod(0o444)
        with pytest.raises(PermissionError):
            atomic.write_bytes(target, b"new")
        assert target.read_bytes() == b"old"
        assert [path.name for path in tmp_path.iterdir()] == ["kept.png"]
