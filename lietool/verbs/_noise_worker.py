"""What a process does for `lietool figures noise`: compute drawings, or render those that another computed.

It tells what it found on standard output, a line of JSON for each plate.
"""

import json
import pickle
import sys
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lietool.golden import compare, compare_numbers, store
from lietool.render import draw, labels
from lietool.verbs import _studio


def main(task: str) -> None:
    """Do one task and tell of each plate when it is done.

    Parameters
    ----------
    task : str
        JSON: "do" ("compute", "render" or "keep"), "plates" (their ids), "folder" (of the drawings), and
        to keep pictures "pictures" (their folder).
    """
    told = json.loads(task)
    folder = Path(told["folder"])
    work = {
        "compute": compute,
        "render": render,
        "keep": lambda item, folder: keep(item, folder, Path(told["pictures"])),
    }[told["do"]]
    for item in _studio.items(told["plates"]):
        print(json.dumps({"plate": item.id} | work(item, folder)), flush=True)


def start(task: Mapping[str, Any]) -> Sequence[str]:
    """Return the command line of a process that calls `main`, with the modules that this one has."""
    find = f"import sys; sys.path[:] = {sys.path!r}"
    code = f"{find}; from lietool.verbs import _noise_worker as worker; worker.main(sys.argv[1])"
    return sys.executable, "-c", code, json.dumps(task)


def compute(item: _studio.Item, folder: Path) -> dict[str, Any]:
    """Draw a plate, keep its records, and compare its numbers with the golden's.

    Parameters
    ----------
    item : Item
        The plate, whose golden is whole.
    folder : Path
        Where the records are kept.

    Returns
    -------
    dict
        "numbers": differences in words.
    """
    drawing = item.figure.draw(**item.parameters)
    (folder / f"{item.id}.pickle").write_bytes(pickle.dumps(drawing.picture, pickle.HIGHEST_PROTOCOL))
    golden = store.read(item.place)
    found = compare_numbers.numbers(golden.numbers, drawing.numbers, item.plate.tolerance.relative)
    return {"numbers": list(map(str, found))}


def render(item: _studio.Item, folder: Path) -> dict[str, Any]:
    """Render the records of a plate and compare the picture with its golden, as it is and with jitter.

    Parameters
    ----------
    item : Item
        The plate, whose golden is whole.
    folder : Path
        Where `compute` has kept the records.

    Returns
    -------
    dict
        Each of "plain" and "jitter": "differing", "over", "crowd", "lowpass" and "passes" of `Comparison`.
    """
    image = _rendered(item, folder)
    golden, limits = store.read(item.place).image, item.plate.tolerance
    found = {}
    for name, shown in (("plain", image), ("jitter", jittered(image, item.id))):
        c = compare.images(
            golden, shown, pixels=limits.pixels, delta_e=limits.delta_e, lowpass=limits.lowpass
        )
        found[name] = {
            "differing": c.differing,
            "over": c.over,
            "crowd": c.crowd,
            "lowpass": abs(c.lowpass),
            "passes": c.passes,
        }
    return found


def keep(item: _studio.Item, folder: Path, pictures: Path) -> dict[str, Any]:
    """Render the records of a plate and keep the picture.

    Parameters
    ----------
    item : Item
        The plate.
    folder : Path
        Where `compute` has kept the records.
    pictures : Path
        Where the picture goes.

    Returns
    -------
    dict
        Nothing.
    """
    from PIL import Image

    Image.fromarray(_rendered(item, folder)).save(pictures / f"{item.id}.png")
    return {}


def _rendered(item: _studio.Item, folder: Path) -> np.ndarray:
    # Our own file of a moment ago, in a folder that nobody else may write to.
    picture = pickle.loads((folder / f"{item.id}.pickle").read_bytes())
    return draw.render(picture, store=labels.Store((item.place.labels,))).image


def jittered(image: np.ndarray, name: str) -> np.ndarray:
    """Return a picture with every pixel a grey level darker, lighter or as it was, by chance.

    Parameters
    ----------
    image : (h, w, 3) uint8
        The picture.
    name : str
        What seeds the chance.

    Returns
    -------
    (h, w, 3) uint8
        The same at every call.
    """
    chance = np.random.default_rng(zlib.crc32(name.encode()))
    step = chance.integers(-1, 2, (*image.shape[:2], 1), dtype=np.int16)
    return np.clip(image + step, 0, 255).astype(np.uint8)
