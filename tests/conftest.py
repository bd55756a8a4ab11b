"""One environment for all tests, what a missing renderer means, and every plate drawn once.

Where several processes share the tests (`./run test`), those of a file stay together, for the sake of what
they have in common, and so do all tests of a command and its plates; the long ones go alone.
"""

import os
import re
import shutil
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, NoReturn

import numpy as np
import pytest

from lietool import figure, paths
from lietool.declaration import Drawing
from lietool.render import compose, context, draw, labels, scene, theme
from lietool.render.compose import PlacedLabel
from lietool.verbs import _studio

_REQUIRE = "LIETOOL_REQUIRE_RENDERER"
_REQUIRE_BROWSER = "LIETOOL_REQUIRE_BROWSER"
# Projects of others, which tests copy and run.
collect_ignore_glob = ["data/*"]
# What the caller set for other purposes: no test may pass or fail by it.
_FOREIGN = ("GALLIUM_DRIVER", "LP_NUM_THREADS", "LP_NATIVE_VECTOR_WIDTH", "SOURCE_DATE_EPOCH")
# Tests that take so long that each command's is one by itself.
ALONE = ("TestFigures::", "TestAnimation::", "test_what_has_a_part_is_said")


def pytest_configure() -> None:
    """Forget the caller's settings before figures are listed, which happens before any fixture runs."""
    for name in list(os.environ):
        if name in _FOREIGN or (name.startswith("LIETOOL_") and name not in (_REQUIRE, _REQUIRE_BROWSER)):
            del os.environ[name]


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Compiled shaders and labels of this session, shared by all its processes and those that tests start."""
    base = tmp_path_factory.getbasetemp()
    # Each process that runs tests has a folder of its own in that of the session.
    cache = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "cache"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("LIETOOL_CACHE_DIR", str(cache))
        yield


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Share tests among processes by `together`."""
    from xdist.scheduler import LoadScopeScheduling

    if config.getvalue("dist") != "loadscope":
        return None
    commands = figure.plates((paths.FIGURES,))

    class Scheduler(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return together(nodeid, commands)

    return Scheduler(config, log)


def together(nodeid: str, commands: Mapping[str, str]) -> str:
    """Return the name of the tests that one process runs, so that what they have in common is made once.

    Parameters
    ----------
    nodeid : str
    commands : mapping of str to str
        The command of each plate.
    """
    file, _, test = nodeid.partition("::")
    case = re.search(r"\[(.*)\]$", test)
    if file == "tests/test_figures.py" and case and case[1] in commands:
        file = f"tests/figures/test_{commands[case[1]].replace('-', '_')}.py"
    elif case and test.startswith(ALONE):
        return nodeid
    return file


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup() -> Iterator[None]:
    """Skip what a fixture cannot render, or fail it where a renderer is required."""
    return (yield from _without_renderer())


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call() -> Iterator[None]:
    """Skip a test that cannot render, or fail it where a renderer is required."""
    return (yield from _without_renderer())


def _without_renderer() -> Iterator[None]:
    try:
        return (yield)
    except context.NoRendererError as error:
        reason = str(error).splitlines()[0]
        if set(error.tried) == {"osmesa"} and context.get().canonical:
            # Mesa has had no OSMesa since 25.1, and what renders by EGL there is as good.
            pytest.skip(reason)
        _give_up(reason)


def _give_up(reason: str, unless: str = _REQUIRE) -> NoReturn:
    if os.environ.get(unless) == "1":
        pytest.fail(f"{unless}=1, but {reason}", pytrace=False)
    pytest.skip(reason)


@pytest.fixture(scope="session")
def chromium() -> tuple[str, str]:
    """The browser and what drives it, for tests of pages."""
    found = [shutil.which(name) for name in ("chromium", "chromedriver")]
    for name, path in zip(("chromium", "chromium-driver"), found, strict=True):
        if path is None:
            _give_up(f"{name} is not installed; apt-get install chromium chromium-driver", _REQUIRE_BROWSER)
    return str(found[0]), str(found[1])


@dataclass(frozen=True, eq=False)
class Built:
    """A plate as `figures verify` sees it, and what it was made of."""

    item: _studio.Item
    drawing: Drawing
    painted: _studio.Painted
    labels: tuple[PlacedLabel, ...]

    @property
    def numbers(self) -> dict[str, Any]:
        """The numbers shown, as arrays where they are arrays."""
        return dict(self.painted.numbers)


def build(item: _studio.Item) -> Built:
    """Paint a plate by the verbs' own code, and keep what passes between its parts."""
    seen: list[tuple[Any, draw.Rendered]] = []
    render = draw.render

    def watched(picture: Any, **options: Any) -> draw.Rendered:
        seen.append((picture, render(picture, **options)))
        return seen[-1][1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(draw, "render", watched)
        painted = _studio.Studio().paint(item)
    ((picture, rendered),) = seen
    return Built(item, Drawing(picture, painted.numbers), painted, rendered.labels)


@pytest.fixture(scope="session")
def plate() -> Callable[[str], Built]:
    """Each of our plates by its id: drawn once, when it is first asked for."""
    commands = figure.plates((paths.FIGURES,))
    return cache(lambda plate_id: build(_studio.Item(plate_id, commands[plate_id])))


@pytest.fixture(scope="session")
def placed() -> Callable[..., tuple[PlacedLabel, ...]]:
    """The labels of a picture where rendering puts them, with nothing drawn under them."""

    def place(picture: scene.Picture, unit: float = 1.0) -> tuple[PlacedLabel, ...]:
        width, height = (round(unit * side) for side in picture.size)
        blank = np.zeros((height, width, 3), np.uint8)
        return compose.compose(blank, picture, unit, (0.0, 0.0), labels.Store(), theme.BOOK)

    return place


@pytest.fixture
def canonical() -> None:
    """For tests that compare with goldens, which not every renderer can."""
    context.get()
    if trouble := _studio.Studio().trouble:
        _give_up(trouble)


@pytest.fixture
def repaint() -> Callable[[str], np.ndarray]:
    """The picture of a plate, drawn anew."""
    commands = figure.plates((paths.FIGURES,))
    return lambda plate_id: build(_studio.Item(plate_id, commands[plate_id])).painted.image
