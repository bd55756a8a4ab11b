"""Goldens in any project's tests: the fixture ``lietool_golden`` of pytest.

A check compares, and fails where there is no golden.  Goldens are written by
``--golden-update`` alone, and a run that wrote any does not pass.
"""

import contextlib
import json
import os
import pickle
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    import numpy as np

    from lietool.golden.checks import Record, Settings

# As `checks.UPDATES`, which would load numpy at the start of every run of pytest on this machine.
_UPDATES = ("missing", "changed", "all")
_UNUSED = ("auto", "fail", "ignore")
_FOLDER, _SENT = "lietool_golden_folder", "lietool_golden"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options, all of which begin with --golden."""
    group = parser.getgroup("golden", "pictures and numbers against goldens (lietool)")
    group.addoption(
        "--golden-update",
        choices=_UPDATES,
        help="write goldens that are missing, or that differ as well, or all that are not equal to the last "
        "bit; the run fails if it wrote any",
    )
    group.addoption("--golden-report", metavar="PATH", help="write a page of all pictures, as one HTML file")
    group.addoption("--golden-json", metavar="PATH", help="write all verdicts as JSON")
    group.addoption(
        "--golden-unused",
        choices=_UNUSED,
        default="auto",
        help="goldens that no test asks for: fail, ignore them, or (auto) tell of them after a whole run",
    )
    parser.addini(_FOLDER, "where goldens lie, from the root of the project", default="golden")


def pytest_configure(config: pytest.Config) -> None:
    """Keep the records of this process, and in a run with several processes those of all."""
    config.pluginmanager.register(_Run(config), "lietool-golden-run")


@pytest.fixture
def lietool_golden(request: pytest.FixtureRequest) -> "Iterator[Golden]":
    """Compare pictures and numbers with goldens: ``lietool_golden.check(image, name=..., numbers=...)``.

    A test that asks for this and checks nothing fails.
    """
    run = request.config.pluginmanager.get_plugin("lietool-golden-run")
    assert isinstance(run, _Run)
    golden = Golden(run, request)
    yield golden
    called = request.node.stash.get(_PASSED, False)
    if called and not golden.records:
        pytest.fail(f"{request.node.nodeid} asks for lietool_golden and checks nothing", pytrace=False)


_PASSED = pytest.StashKey[bool]()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Iterator[None]:
    """Remember whether the test itself has passed, for the end of its fixture."""
    report: Any = yield
    if report.when == "call":
        item.stash[_PASSED] = report.passed
    return report


class Golden:
    """What a test compares with; `records` are its checks so far."""

    def __init__(self, run: "_Run", request: pytest.FixtureRequest) -> None:
        self._run, self._request = run, request
        self.records: list[Record] = []

    def check(
        self,
        image: Any,
        *,
        name: str | None = None,
        numbers: Mapping[str, object] | None = None,
        mask: "np.ndarray | None" = None,
        ignore: Sequence[tuple[int, int, int, int]] = (),
        renderer: str | None = None,
        pixels: int | None = None,
        delta_e: float | None = None,
        lowpass: float | None = None,
        relative: float | None = None,
        because: str = "",
    ) -> None:
        """Compare a picture, and numbers, with the golden of that name.

        Parameters
        ----------
        image : ndarray, PIL image, matplotlib figure or moderngl framebuffer
            An array is (h, w), (h, w, 3) or (h, w, 4): uint8, bool, or floats from 0 to 1.
        name : str, optional
            Words with / between them; the test's own name unless given. Each golden belongs to one check.
        numbers : Mapping[str, object], optional
            Nested; its leaves are arrays or scalars. Floats may differ by 1e-9 of the largest of their array.
        mask : (h, w) bool, optional
            True where pixels may be anything.
        ignore : sequence of (x0, y0, x1, y1)
            Boxes, in pixels from the upper left, where they may be anything.
        renderer : str, optional
            Only where renderers are known to draw other pixels: the class that has a golden of its own.
        pixels, delta_e, lowpass, relative : float, optional
            A tolerance other than the usual one.
        because : str
            Why; without it none of them is accepted.

        Raises
        ------
        AssertionError
            If the picture or the numbers are not as their golden, or if there is none.
        ValueError, TypeError
            If what is given cannot be compared.
        """
        __tracebackhide__ = True
        from lietool.golden import asked, checks

        tolerated = asked.tolerance(
            because, pixels=pixels, delta_e=delta_e, lowpass=lowpass, relative=relative
        )
        named = _name_of(self._request.node.nodeid) if name is None else name
        record = checks.check(
            self._run.settings,
            self._request.node.nodeid,
            image,
            name=named,
            numbers=numbers,
            mask=mask,
            ignore=ignore,
            renderer=renderer,
            tolerated=tolerated,
        )
        if any(record.name == other.name for other in self.records):
            raise ValueError(
                "lietool_golden.check: name must be another for each picture of a test; got "
                f"{named!r} twice. Name them"
            )
        self.records.append(record)
        self._run.records.append(record)
        self._request.node.user_properties.append((f"golden {record.name}", record.said))
        if not record.passes:
            raise checks.MismatchError("\n".join((f"golden {record.name}", *record.messages, *record.see)))


def _name_of(nodeid: str) -> str:
    """A name of a file for a test: tests/test_a.py::TestB::test_c[x-1] is test_a/TestB/test_c-x-1."""
    file, *rest = nodeid.split("::")
    words = [Path(file).stem, *rest]
    plain = ["".join(c if c.isalnum() or c in "._+=" else "-" for c in word).strip("-. ") for word in words]
    return "/".join(word for word in plain if word)


class _Run:
    """All checks of a run, of this process and of others that it has started."""

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self.records: list[Record] = []
        self._lines: list[str] = []
        self._settings: Settings | None = None
        self._partial = False

    @property
    def settings(self) -> "Settings":
        if self._settings is None:
            from lietool.golden import checks

            config = self._config
            root = Path(config.rootpath, config.getini(_FOLDER))
            self._settings = checks.Settings(
                root=root,
                left=_left(config),
                update=config.getoption("--golden-update") or "",
                reporting=bool(self._told("--golden-report")),
            )
        return self._settings

    def _told(self, option: str) -> str | None:
        """An option as the process that was started by the user has it."""
        return self._config.getoption(option)

    @pytest.hookimpl(trylast=True)
    def pytest_deselected(self, items: Sequence[pytest.Item]) -> None:
        """Know that this is not a whole run."""
        self._partial = self._partial or bool(items)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Know that a test did not reach its checks."""
        self._partial = self._partial or report.failed or report.skipped

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any, error: object) -> None:
        """Take over what another process has checked."""
        sent = getattr(node, "workeroutput", {}).get(_SENT)
        if sent is None:
            self._partial = True
        else:
            # Our own process, which has just ended.
            records, partial = pickle.loads(sent)
            self.records += records
            self._partial = self._partial or partial

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self, session: pytest.Session, exitstatus: int) -> None:
        """Write what was asked for, and fail a run that wrote goldens or leaves some unused."""
        config = self._config
        # There is such in a process that pytest-xdist has started.
        sending: dict[str, object] | None = getattr(config, "workeroutput", None)
        if sending is not None:
            sending[_SENT] = pickle.dumps((self.records, self._partial))
            return
        wrong = self._judge()
        for option, make in (("--golden-json", self._json), ("--golden-report", self._page)):
            path = config.getoption(option)
            if path:
                wrong |= not self._write(Path(config.invocation_params.dir, path), make)
        if wrong and exitstatus in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def _judge(self) -> bool:
        """Say what is wrong with the run as a whole."""
        unused_is = self._config.getoption("--golden-unused")
        if not self.records and unused_is != "fail":
            return False
        from lietool.golden import checks

        wrote = [record for record in self.records if record.written]
        self._lines += [f"wrote {record.name} ({record.written})" for record in wrote]
        if wrote:
            self._lines.append("look at them, and run again without --golden-update")
        twice = checks.twice(self.records)
        self._lines += [f"one golden for several checks: {line}" for line in twice]
        whole = not (self._partial or self._narrowed())
        unused = []
        if unused_is == "fail" or (unused_is == "auto" and whole):
            unused = checks.unused(self.settings.root, {record.name for record in self.records})
            self._lines += [f"no test asks for {self.settings.root / name}.png" for name in unused]
        return bool(wrote or twice or (unused and unused_is == "fail"))

    def _narrowed(self) -> bool:
        """Whether the user has named files or tests."""
        config = self._config
        narrowing = ("keyword", "markexpr", "lf", "stepwise", "maxfail", "ignore", "ignore_glob", "deselect")
        named = config.args_source is pytest.Config.ArgsSource.ARGS
        return named or any(config.getoption(option, None) for option in narrowing)

    def _write(self, path: Path, make: Any) -> bool:
        from lietool import atomic

        try:
            atomic.write_bytes(path, make().encode())
        except OSError as error:
            self._lines.append(f"{path} cannot be written: {error.strerror or error}")
            return False
        self._lines.append(f"see {path}")
        return True

    def _json(self) -> str:
        told = [record.plain() for record in self._sorted()]
        return (
            json.dumps({"passes": all(record["passes"] for record in told), "checks": told}, indent=2) + "\n"
        )

    def _page(self) -> str:
        from lietool.golden import report

        entries = [record.entry for record in self._sorted() if record.entry is not None]
        about = {"folder of the goldens": str(self.settings.root), "pytest": pytest.__version__}
        return report.build(entries, title=f"Goldens of {self._config.rootpath.name}", about=about)

    def _sorted(self) -> "list[Record]":
        # Of names that two tests use, the page can show one.
        return list({record.name: record for record in sorted(self.records, key=lambda r: r.name)}.values())

    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        """Tell of all that is not said by a test."""
        if self._lines:
            terminalreporter.section("goldens")
            for line in self._lines:
                terminalreporter.line(line)


def _left(config: pytest.Config) -> Path:
    """A folder for pictures of failures, which is nobody's to commit."""
    with contextlib.suppress(AttributeError):
        if config.cache is not None:
            return Path(config.cache.mkdir("lietool-golden"))
    import tempfile

    return Path(tempfile.gettempdir(), f"lietool-golden-{os.getuid() if hasattr(os, 'getuid') else 0}")
