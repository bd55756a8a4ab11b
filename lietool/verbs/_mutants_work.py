"""What a process does that draws plates, with a mistake in the library or without one.

Each of these functions has a process of its own and yields once for every plate.
"""

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NoReturn

from lietool import atomic, cache
from lietool.golden import compare, compare_numbers
from lietool.mutation import hook, process, reference, scene, trace
from lietool.mutation.mutant import Mutant
from lietool.mutation.score import Outcome
from lietool.verbs import _studio


def file(folder: Path, plate: str) -> Path:
    """Return where the reference of a plate is kept."""
    return folder / f"{plate}.npz"


def refer(items: Sequence[_studio.Item], folder: Path) -> Iterator[str]:
    """Keep references of plates, and yield why pictures cannot be compared here; empty where they can."""
    studio = _studio.Studio()
    for item in items:
        if studio.trouble:
            yield studio.trouble
            continue
        begun = time.perf_counter()
        drawing = item.figure.draw(**item.parameters)
        drawn = time.perf_counter()
        image = _rendered(item, drawing)
        seconds = (drawn - begun, time.perf_counter() - drawn)
        extra = [value for value in item.parameters.values() if isinstance(value, Path)]
        made = reference.Reference(
            item.id,
            scene.shape(drawing.picture),
            drawing.numbers,
            image,
            seconds,
            reference.made_of(extra),
            str(studio.info["renderer"]),
        )
        reference.write(file(folder, item.id), made)
        yield ""


def follow(items: Sequence[_studio.Item]) -> Iterator[dict[str, list[int]]]:
    """Yield the lines of the subjects that each plate executes, by module; imports count for the first."""
    _keep_nothing()
    for item in items:
        with trace.lines() as found:
            item.figure.draw(**item.parameters)
        yield {module: sorted(numbers) for module, numbers in found.items()}


def attempt(mutant: Mutant, items: Sequence[_studio.Item], folder: Path, enough: int) -> Iterator[Outcome]:
    """Yield what comes of a mistake on each plate, until `enough` pictures have noticed it."""
    _keep_nothing()
    hook.install(mutant)
    seen = 0
    for item in items:
        if seen >= enough:
            yield Outcome(item.id, skipped=True)
            continue
        outcome = _tried(item, folder)
        seen += outcome.picture
        yield outcome


def keep(mutant: Mutant, items: Sequence[_studio.Item], folder: Path, enough: int) -> Iterator[str]:
    """Keep the pictures of plates with a mistake, and yield why there is none; empty where there is one.

    A picture that is the golden is none, and after `enough` no more are drawn.
    """
    from PIL import Image

    from lietool.golden import store

    _keep_nothing()
    hook.install(mutant)
    kept = 0
    for item in items:
        if kept >= enough:
            yield "there are enough"
            continue
        try:
            image = _rendered(item, item.figure.draw(**item.parameters))
        except Exception as error:
            yield process.told(error)
            continue
        if compare.images(store.read(item.place).image, image).equal:
            yield "nothing changes"
            continue
        # Others' programs read it; its name is known to nobody before this process tells it.
        Image.fromarray(image).save(folder / f"{item.id}.png")
        kept += 1
        yield ""


def _tried(item: _studio.Item, folder: Path) -> Outcome:
    before = reference.read(file(folder, item.id))
    assert before is not None
    try:
        return _outcome(item, before)
    except Exception as error:
        return Outcome(item.id, changed=True, failure="undrawn", displacement=None, says=process.told(error))


def _outcome(item: _studio.Item, before: reference.Reference) -> Outcome:
    drawing = item.figure.draw(**item.parameters)
    shape = scene.shape(drawing.picture)
    moved = scene.differences(before.shape, shape)
    tolerance = item.plate.tolerance
    differing = compare_numbers.numbers(before.numbers, drawing.numbers)
    beyond = compare_numbers.numbers(before.numbers, drawing.numbers, tolerance.relative)
    first = str((beyond or differing or [""])[0])
    if not moved:
        return Outcome(item.id, changed=bool(differing), numbers=bool(beyond), says=first)
    found = compare.images(
        before.image,
        _rendered(item, drawing),
        pixels=tolerance.pixels,
        delta_e=tolerance.delta_e,
        lowpass=tolerance.lowpass,
    )
    return Outcome(
        item.id,
        changed=True,
        picture=not found.passes,
        numbers=bool(beyond),
        displacement=scene.displacement(before.shape, shape),
        over=found.over,
        lowpass=found.lowpass,
        says=first,
    )


def _rendered(item: _studio.Item, drawing: Any) -> Any:
    from lietool.render import draw, labels

    return draw.render(drawing.picture, store=labels.Store((item.place.labels,))).image


def _keep_nothing() -> None:
    """Let this process write nothing, and read nothing that was computed by what may be mutated.

    What is kept is known by the sources it was made by, and the mistake is not in them.
    """
    folder = cache.folder
    atomic.write_bytes = _refuse
    cache.folder = lambda name="": None if name == "cages" else folder(name)


def _refuse(path: Path, data: bytes) -> NoReturn:
    raise OSError(f"{path} is not written by a process with a mistake in it")
