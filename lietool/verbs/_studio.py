"""Where the verbs get pictures from: every plate with its place, the renderer, and what is to be recorded."""

import contextlib
import os
import platform
import shlex
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import cache, cached_property
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

import lietool
from lietool import figure as figure_
from lietool import paths
from lietool.figure import Figure, Plate
from lietool.verbs import _recorded
from lietool.verbs._size import Size

if TYPE_CHECKING:
    import numpy as np

    from lietool.golden.store import Place


# What figures compute and pictures are made with.
_PACKAGES = ("moderngl", "numpy", "scipy", "pillow", "matplotlib", "scikit-image", "trimesh")


class Stop(click.ClickException):
    """The end of a verb, with one line of why and its exit code."""

    def __init__(self, code: int, message: str) -> None:
        super().__init__(message)
        # Click declares it for the class, and reads it from the instance.
        vars(self)["exit_code"] = code

    def __reduce__(self) -> tuple[type["Stop"], tuple[int, str]]:
        """Let it travel from one process to another, with its code."""
        return Stop, (self.exit_code, self.message)


@dataclass(frozen=True)
class Item:
    """A plate, its figure, and the place of its golden; loaded once it is looked at."""

    id: str
    command: str

    def __reduce__(self) -> tuple[type["Item"], tuple[str, str]]:
        """Let it travel to another process, which loads the figure for itself."""
        return Item, (self.id, self.command)

    @cached_property
    def figure(self) -> Figure:
        """The figure with its code."""
        return figure_.load(self.command)

    @cached_property
    def declared(self) -> Figure:
        """The figure as far as its signature goes, without what draws it."""
        return figure_.declare(self.command)

    @property
    def plate(self) -> Plate:
        """Title, caption and all that the figure says of this plate."""
        return self.declared.plates[self.id]

    @cached_property
    def place(self) -> "Place":
        """Where the golden lies: beside the folder of figures that the plate comes from."""
        from lietool.golden.store import Place

        return Place.beside(self.declared.file, self.declared.chapter, self.id)

    @property
    def program(self) -> str:
        """How to call the program so that it knows this plate."""
        return program(self.declared.file.is_relative_to(paths.FIGURES))

    @property
    def parameters(self) -> dict[str, Any]:
        """The plate's parameters."""
        return self.declared.plate_params(self.id)

    @property
    def recorded(self) -> str:
        """The plate's parameters as a golden records them."""
        return _recorded.parameters(self.declared, self.parameters)


def program(ours: bool) -> str:
    """Return how to call the program so that it knows what is ours, or what is the project's."""
    if ours:
        return "lietool"
    name = os.environ.get(figure_.PROJECT, "")
    here = "." if name and os.path.realpath(name) == os.path.realpath(".") else name
    return shlex.join(["lietool", "--project", here])


def items(wanted: Sequence[str] = (), *, everything: bool = False) -> list[Item]:
    """List the plates, all or those that are named.

    Parameters
    ----------
    wanted : sequence of str
        Ids in any case; a command stands for all its plates.  Without them it is all, where there is a
        project all of the project: the book's are there to be named.
    everything : bool
        The book's and the project's.

    Returns
    -------
    list of Item
        In the order of chapters and numbers, each once.

    Raises
    ------
    click.UsageError
        If there is no such plate; the message has the nearest.
    Stop
        If a figure file is broken.
    """
    try:
        known = figure_.plates()
        own = figure_.project()
        at_hand = known if own is None else figure_.plates((own / "figures",))
    except figure_.FigureError as error:
        raise Stop(2, str(error)) from None
    chosen = set()
    for word in wanted:
        found = [i for i in known if i == word] or [
            i for i, command in known.items() if word.lower() in (i.lower(), command.lower())
        ]
        if not found:
            hint = figure_.nearest(word, [*known, *known.values()])
            raise click.UsageError(f"no plate {word!r}.{hint} See `lietool figures list`.")
        chosen.update(found)
    listed = chosen if wanted else set(known if everything else at_hand)
    return [Item(i, command) for i, command in known.items() if i in listed]


@dataclass(frozen=True, eq=False)
class Painted:
    """A plate as pixels (h, w, 3), its labels, and the bytes of those that the golden folder lacks."""

    image: "np.ndarray"
    numbers: Mapping[str, object]
    label_keys: frozenset[str] = frozenset()
    fresh: Mapping[str, bytes] = field(default_factory=dict)
    missing_labels: tuple[str, ...] = ()


class Studio:
    """The renderer, as the verbs need it; a test puts another in its place as the context's object."""

    @cached_property
    def info(self) -> Mapping[str, Any]:
        """What renders; raises NoRendererError."""
        from lietool.render import context

        return context.get().info

    @cached_property
    def trouble(self) -> str:
        """Why pictures cannot be compared here; empty where they can."""
        from lietool.render.context import NoRendererError

        try:
            info = self.info
        except NoRendererError as error:
            return str(error)
        if info["canonical"]:
            return ""
        return (
            f"the renderer is {info['renderer']!r} by {info['backend']}, not llvmpipe: goldens can be "
            "neither made nor judged with it. `lietool doctor` says what to install."
        )

    def require(self) -> None:
        """Stop with exit code 4 where nothing renders."""
        from lietool.render.context import NoRendererError

        try:
            _ = self.info
        except NoRendererError as error:
            raise Stop(4, str(error)) from None

    def sketch(self, item: Item) -> Painted:
        """Compute what a plate shows, for which no renderer is needed; its picture is a blank."""
        import numpy as np

        drawing = item.figure.draw(**item.parameters)
        return Painted(np.zeros((1, 1, 3), np.uint8), drawing.numbers)

    def paint(
        self, item: Item, *, size: Size | None = None, draft: bool = False, theme: str = "book"
    ) -> Painted:
        """Draw and render a plate, with labels from its golden folder alone where that has them."""
        from lietool.render import draw, labels
        from lietool.render.theme import THEMES

        drawing = item.figure.draw(**item.parameters)
        store = labels.Store((item.place.labels,))
        pixels = size.pixels(drawing.picture.size) if size else None
        rendered = draw.render(drawing.picture, size=pixels, draft=draft, store=store, theme=THEMES[theme])
        fresh = store.fresh
        return Painted(
            rendered.image,
            drawing.numbers,
            frozenset(label.key for label in rendered.labels),
            fresh,
            tuple(dict.fromkeys(x.text for x in rendered.labels if f"{x.key}.png" in fresh)),
        )


def current() -> Studio:
    """Return the studio of this invocation."""
    return click.get_current_context().find_object(Studio) or Studio()


def provenance(item: Item, info: Mapping[str, Any]) -> dict[str, str]:
    """Collect what the picture of a plate remembers of how it was made.

    Parameters
    ----------
    item : Item
        The plate.
    info : Mapping[str, object]
        What renders, as the context tells it.

    Returns
    -------
    dict
        Keywords and texts.
    """
    return {
        "plate": item.id,
        "command": item.command,
        "parameters": item.recorded,
        "date": _date(),
        "commit": _commit(item.declared.file.parent),
        **made_by(item, info),
    }


def made_by(item: Item, info: Mapping[str, Any]) -> dict[str, str]:
    """Collect what may make two pictures of a plate differ though its code and parameters are the same.

    Parameters
    ----------
    item : Item
        The plate.
    info : Mapping[str, object]
        What renders, as the context tells it.

    Returns
    -------
    dict
        Keywords and texts: the files that it is drawn from, the renderer, and versions.
    """
    return {
        "inputs": _recorded.inputs(item.parameters),
        "renderer": str(info["renderer"]),
        "backend": str(info["backend"]),
        "mesa": str(info.get("mesa") or "unknown"),
        "llvm": str(info.get("llvm") or "unknown"),
        **_versions(),
    }


@cache
def _versions() -> dict[str, str]:
    found = {name: metadata.version(name) for name in _PACKAGES}
    # Not from the metadata, which an editable install keeps from the day it was made.
    return {"python": platform.python_version(), **found, "lietool": lietool.__version__}


@contextlib.contextmanager
def writing(what: str) -> Iterator[None]:
    """Turn an error of the disk into one line and exit code 2."""
    try:
        yield
    except OSError as error:
        raise Stop(2, f"{what} cannot be written: {error.strerror or error}") from None


def _date() -> str:
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    try:
        now = datetime.fromtimestamp(int(epoch), UTC) if epoch.isdecimal() else datetime.now(UTC)
    except (OverflowError, ValueError, OSError):
        raise Stop(
            2, f"SOURCE_DATE_EPOCH must be seconds since 1970, up to the year 9999; got {epoch}. Correct it"
        ) from None
    return now.strftime("%Y-%m-%dT%H:%M:%SZ")


def _commit(folder: Path) -> str:
    command = ["git", "-C", str(folder), "describe", "--always", "--dirty", "--tags"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=20, check=True)
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return done.stdout.strip() or "unknown"
