"""What to install where nothing can render: one command for each package manager."""

import os
import sys
from pathlib import Path

# EGL with Mesa's drivers, since newer Mesa has no OSMesa; both draw the same pixels.
_PACKAGES = {
    "apt": "apt-get install -y libegl1 libgl1-mesa-dri",
    "dnf": "dnf install -y mesa-libEGL mesa-dri-drivers",
    "pacman": "pacman -S --needed mesa",
}
_FAMILIES = {
    **dict.fromkeys(("debian", "ubuntu"), "apt"),
    **dict.fromkeys(("fedora", "rhel", "centos"), "dnf"),
    **dict.fromkeys(("arch", "archlinux"), "pacman"),
}


def distribution(os_release: Path = Path("/etc/os-release")) -> dict[str, str]:
    """Return the fields of the file by which a Linux distribution names itself.

    Parameters
    ----------
    os_release : Path
        The file.

    Returns
    -------
    dict of str
        Such as ``ID``, ``ID_LIKE``, ``PRETTY_NAME``; empty where there is no such file.
    """
    try:
        lines = os_release.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return {}
    pairs = (line.partition("=") for line in lines if "=" in line and not line.startswith("#"))
    return {key.strip(): value.strip().strip("\"'") for key, _, value in pairs}


def commands(release: dict[str, str] | None = None) -> dict[str, str]:
    """Return the command that installs the software renderer, by package manager.

    Parameters
    ----------
    release : dict of str, optional
        What `distribution` returns; this machine's if not given.

    Returns
    -------
    dict of str
        This distribution's command first, the others after it.
    """
    release = distribution() if release is None else release
    families = [release.get("ID", ""), *release.get("ID_LIKE", "").split()]
    own = next((_FAMILIES[name] for name in families if name in _FAMILIES), None)
    root = not hasattr(os, "geteuid") or os.geteuid() == 0
    order = sorted(_PACKAGES, key=lambda manager: manager != own)
    return {manager: ("" if root else "sudo ") + _PACKAGES[manager] for manager in order}


def text() -> str:
    """Return the advice as lines for a terminal.

    Returns
    -------
    str
        One line for each package manager; one about the driver where there is none.
    """
    if not sys.platform.startswith("linux"):
        return "Install or update the graphics driver: OpenGL 3.3 is needed."
    rows = [f"  {manager:<7} {command}" for manager, command in commands().items()]
    return "\n".join(["Install Mesa's software renderer:", *rows])
