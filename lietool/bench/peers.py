"""Other comparisons of pictures, each at its defaults: what it calls different, and how long that takes.

None of them is needed for anything else, and none is fetched: those that are not installed say how they
would be.  From Python come pytest-mpl, pytest-regressions and scikit-image, by npm pixelmatch and odiff.
"""

import importlib
import importlib.util
import json
import shutil
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

SSIM = 0.99
"""What the mean structural similarity must reach; scikit-image has no default for it."""

# One process for all pictures, which measures the comparison alone: starting Node takes longer than that.
_PIXELMATCH = """
import fs from 'node:fs';
import {createInterface} from 'node:readline';
import match from 'pixelmatch';
import {PNG} from 'pngjs';
for await (const line of createInterface({input: process.stdin})) {
  const [a, b] = JSON.parse(line).map(name => PNG.sync.read(fs.readFileSync(name)));
  const start = performance.now();
  const found = match(a.data, b.data, null, a.width, a.height);
  console.log(JSON.stringify([found > 0, (performance.now() - start) / 1000]));
}
"""
# How odiff ends where pictures match, and where pixels differ.
_ODIFF = {0: False, 22: True}


class PeerError(RuntimeError):
    """A comparison that is installed and does not work."""


@dataclass(frozen=True, eq=False)
class Pair:
    """Two pictures of one size (h, w, 3) uint8, and the PNG files that they are read from."""

    expected: np.ndarray
    actual: np.ndarray
    expected_file: Path
    actual_file: Path


@dataclass(frozen=True)
class Judgement:
    """Whether two pictures count as different, and the seconds that it took to say so."""

    differs: bool
    seconds: float


@dataclass(frozen=True, eq=False)
class Peer:
    """One way to compare.

    Parameters
    ----------
    name : str
    rule : str
        What it calls the same, in words.
    install : str
        The command that installs it.
    takes : str
        "arrays" or "files": with files, decoding them is in its time.
    version : str
        Empty where it is not installed.
    judge : callable, optional
        From a `Pair` to a `Judgement`; raises PeerError.
    """

    name: str
    rule: str
    install: str
    takes: str
    version: str = ""
    judge: Callable[[Pair], Judgement] | None = None


@contextmanager
def peers(npm: Path) -> Iterator[tuple[Peer, ...]]:
    """Yield all peers, those too that are not installed; a process that one needs ends with the block.

    Parameters
    ----------
    npm : Path
        The folder in which npm has installed its packages, beneath "node_modules".

    Yields
    ------
    tuple of Peer
    """
    with ExitStack() as stack:
        yield _pytest_mpl(), _regressions(), _scikit_image(), _pixelmatch(npm, stack), _odiff(npm)


def timed(differs: Callable[[Pair], bool], pair: Pair) -> Judgement:
    """Ask one question and time it."""
    start = time.perf_counter()
    found = differs(pair)
    return Judgement(bool(found), time.perf_counter() - start)


def _installed(name: str, module: str) -> str:
    return metadata.version(name) if importlib.util.find_spec(module) else ""


def _pytest_mpl() -> Peer:
    about = "pytest-mpl", "RMS of 8-bit levels <= 2", "pip install pytest-mpl", "files"
    if not (version := _installed("pytest-mpl", "pytest_mpl")):
        return Peer(*about)
    from matplotlib.testing.compare import compare_images

    tolerance = importlib.import_module("pytest_mpl.plugin").DEFAULT_TOLERANCE

    def differs(pair: Pair) -> bool:
        # As its plugin calls it.
        names = str(pair.expected_file), str(pair.actual_file)
        return compare_images(*names, tol=tolerance, in_decorator=True) is not None

    return Peer(*about, version, partial(timed, differs))


def _regressions() -> Peer:
    about = "pytest-regressions", "mean of |difference| <= 0.1 %", "pip install pytest-regressions", "files"
    if not (version := _installed("pytest-regressions", "pytest_regressions")):
        return Peer(*about)
    kind = importlib.import_module("pytest_regressions.image_regression").ImageRegressionFixture
    # A fixture's folders and request are only for finding the golden.
    fixture: Any = kind(None, None, None)
    threshold = kind.check.__defaults__[0]

    def differs(pair: Pair) -> bool:
        try:
            fixture._check_images_manhattan_distance(pair.actual_file, pair.expected_file, True, threshold)
        except AssertionError:
            return True
        return False

    return Peer(*about, version, partial(timed, differs))


def _scikit_image() -> Peer:
    about = "scikit-image SSIM", f"mean SSIM >= {SSIM}", "pip install scikit-image", "arrays"
    if not (version := _installed("scikit-image", "skimage")):
        return Peer(*about)
    from skimage.metrics import structural_similarity

    def differs(pair: Pair) -> bool:
        mean: Any = structural_similarity(pair.expected, pair.actual, channel_axis=2, data_range=255)
        return mean < SSIM

    return Peer(*about, version, partial(timed, differs))


def _pixelmatch(npm: Path, stack: ExitStack) -> Peer:
    about = "pixelmatch", "no pixel beyond 0.1 that is no antialiasing", "npm install pixelmatch", "arrays"
    version, node = _of_npm(npm, "pixelmatch"), shutil.which("node")
    if not version or node is None:
        return Peer(*about)
    server = stack.enter_context(
        subprocess.Popen(
            [node, "--input-type=module", "-e", _PIXELMATCH],
            cwd=npm,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
    )
    stack.callback(server.kill)
    lock = threading.Lock()

    def judge(pair: Pair) -> Judgement:
        question = json.dumps([str(pair.expected_file.absolute()), str(pair.actual_file.absolute())])
        assert server.stdin and server.stdout
        with lock:
            try:
                print(question, file=server.stdin, flush=True)
                answer = server.stdout.readline()
            except OSError:
                answer = ""
        if not answer:
            raise PeerError(f"pixelmatch {version} does not answer. Install it anew: {about[2]}")
        return Judgement(*json.loads(answer))

    return Peer(*about, version, judge)


def _odiff(npm: Path) -> Peer:
    about = "odiff", "no pixel beyond 0.1", "npm install odiff-bin", "files"
    version = _of_npm(npm, "odiff-bin")
    # The program itself: the script around it starts Node first.
    found = sorted(npm.glob("node_modules/@odiff/*/odiff*"))
    programs = [str(file.absolute()) for file in found if file.suffix in ("", ".exe")]
    if not version or not programs:
        return Peer(*about)

    def differs(pair: Pair) -> bool:
        call = [programs[0], str(pair.expected_file), str(pair.actual_file)]
        try:
            return _ODIFF[subprocess.run(call, capture_output=True).returncode]
        except (OSError, KeyError) as error:
            raise PeerError(f"odiff {version} does not work: {error}. Install it anew: {about[2]}") from None

    return Peer(*about, version, partial(timed, differs))


def _of_npm(npm: Path, name: str) -> str:
    try:
        return json.loads((npm / "node_modules" / name / "package.json").read_text())["version"]
    except (OSError, ValueError, KeyError):
        return ""
