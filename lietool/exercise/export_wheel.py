"""The wheel of the lietool that runs: a class is graded by what its teacher has tried, released or not."""

import base64
import csv
import hashlib
import importlib.metadata
import importlib.util
import io
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from lietool import paths
from lietool.exercise.export import ExportError

# What an installer adds to what is in a wheel.
_INSTALLED = ("RECORD", "INSTALLER", "REQUESTED", "direct_url.json")
# The first that a zip file can say.
DATE = (1980, 1, 1, 0, 0, 0)


def wheel() -> tuple[str, bytes]:
    """Make a wheel of the lietool that runs: built in a checkout, packed again where it is installed.

    Returns
    -------
    name : str
        Of the file.
    data : bytes

    Raises
    ------
    ExportError
        If it cannot be made.
    """
    checkout = paths.PACKAGE.parent
    if (checkout / "pyproject.toml").is_file():
        return _built(checkout)
    return _packed()


def _built(checkout: Path) -> tuple[str, bytes]:
    # Without hatchling pip fetches it, where it can.
    known = importlib.util.find_spec("hatchling")
    how = (
        ["hatchling", "build", "-t", "wheel", "-d"]
        if known
        else ["pip", "wheel", "-q", "--no-deps", ".", "-w"]
    )
    with tempfile.TemporaryDirectory(prefix="lietool-wheel-") as folder:
        command = [sys.executable, "-m", *how, folder]
        try:
            done = subprocess.run(command, cwd=checkout, capture_output=True, text=True, timeout=600)
        except subprocess.TimeoutExpired:
            raise ExportError("the wheel of lietool was not built in ten minutes. Try again") from None
        made = sorted(Path(folder).glob("*.whl"))
        if done.returncode or not made:
            said = (done.stderr.strip() or done.stdout.strip() or "nothing was said").splitlines()[-1]
            raise ExportError(
                f"the wheel of lietool cannot be built: {said}. Install hatchling, and try again"
            )
        return made[0].name, made[0].read_bytes()


def _packed() -> tuple[str, bytes]:
    try:
        dist = importlib.metadata.distribution("lietool")
    except importlib.metadata.PackageNotFoundError:
        raise ExportError(
            f"{paths.PACKAGE} is not installed, and no checkout either. Install lietool"
        ) from None
    if Path(str(dist.locate_file("lietool"))).resolve() != paths.PACKAGE:
        raise ExportError(
            f"{paths.PACKAGE} runs, but another lietool is installed. Run the one that is installed"
        )
    files: dict[str, bytes] = {}
    for path in dist.files or ():
        # What lies outside are the programs, which an installer makes anew.
        if path.parts[0] != ".." and path.suffix != ".pyc" and path.name not in _INSTALLED:
            files[path.as_posix()] = Path(str(path.locate())).read_bytes()
    folder = f"lietool-{dist.version}.dist-info"
    files[f"{folder}/RECORD"] = _record(files, f"{folder}/RECORD")
    return f"lietool-{dist.version}-py3-none-any.whl", zipped(files)


def _record(files: Mapping[str, bytes], own: str) -> bytes:
    """The list of a wheel: each file with its digest and size, and itself without."""

    def rows() -> Iterator[tuple[str, str, str]]:
        for name, data in files.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            yield name, f"sha256={digest}", str(len(data))
        yield own, "", ""

    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows())
    return text.getvalue().encode()


def zipped(files: Mapping[str, bytes]) -> bytes:
    """Return a zip file, the same for the same files; what begins with ``#!`` can be executed."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, DATE)
            # A wheel is compressed already.
            entry.compress_type = zipfile.ZIP_STORED if name.endswith(".whl") else zipfile.ZIP_DEFLATED
            entry.create_system = 3
            entry.external_attr = (0o100755 if data.startswith(b"#!") else 0o100644) << 16
            archive.writestr(entry, data)
    return out.getvalue()
