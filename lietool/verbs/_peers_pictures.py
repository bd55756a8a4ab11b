"""Pictures to try comparisons on: plates with a mistake in the library, and plates drawn in harmless ways."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from lietool.mutation import process, record
from lietool.mutation.mutant import Mutant
from lietool.verbs import _figures_noise, _mutants_work, _noise_worker, _studio, _table
from lietool.verbs import _noise_settings as settings

# Seconds that a plate has at least, and how many times as long as without a mistake.
_LEAST, _TIMES = 20.0, 12.0


@dataclass(frozen=True)
class Picture:
    """One picture of a plate, beside its golden: `of` is the mistake, or the harmless way."""

    of: str
    item: _studio.Item
    file: Path


def mistaken(
    mutants: Sequence[Mutant], items: Sequence[_studio.Item], folder: Path, *, plates: int, jobs: int
) -> tuple[list[Picture], list[str]]:
    """Draw plates with mistakes in the library: of each mistake, plates that are known to notice it.

    Parameters
    ----------
    mutants : sequence of Mutant
    items : sequence of Item
        The plates that may be drawn.
    folder : Path
        Where the pictures go.
    plates : int
        At most so many pictures of each mistake.
    jobs : int
        How many processes share the work.

    Returns
    -------
    pictures : list of Picture
        Those that are not their golden.
    unknown : list of str
        Names of mutants that no whole run has tried yet.
    """
    known, by_id = record.read(), {item.id: item for item in items}
    unknown = [mutant.name for mutant in mutants if mutant.name not in known["mutants"]]
    tasks = []
    for number, mutant in enumerate(mutants):
        about = known["mutants"].get(mutant.name, {})
        chosen = [by_id[plate] for plate in about.get("plates", ()) if plate in by_id]
        if not chosen or not {"picture", "numbers"}.intersection(about["by"]):
            continue
        place = folder / f"{number:03d}"
        place.mkdir()
        steps = {item.id: _LEAST + _TIMES * known["seconds"][item.id] for item in chosen}
        work = (mutant, chosen, place, plates)
        tasks.append((place, chosen, process.Job(mutant.name, _mutants_work.keep, work, steps)))
    bar = iter(_table.progress(tasks, "drawing mistakes"))
    next(bar, None)
    drawn = set()
    for news in process.run([job for *_, job in tasks], jobs):
        if not (news.failure or news.value):
            drawn.add((news.job.key, news.step))
        if news.last:
            next(bar, None)
    return [
        Picture(job.key, item, place / f"{item.id}.png")
        for place, chosen, job in tasks
        for item in chosen
        if (job.key, item.id) in drawn
    ], unknown


def harmless(items: Sequence[_studio.Item], folder: Path, *, jobs: int) -> list[Picture]:
    """Draw plates in the harmless ways that are farthest from each other, and the goldens with jitter.

    Parameters
    ----------
    items : sequence of Item
        The plates, whose goldens are whole.
    folder : Path
        Where the pictures go.
    jobs : int
        How many processes share the work.

    Returns
    -------
    list of Picture
        Those too that are their golden, in every pixel.

    Raises
    ------
    Stop
        With 4 if no canonical renderer works, with 2 if a plate cannot be drawn.
    """
    ways = settings.few(_figures_noise.available()[0])
    with _figures_noise.Crew(jobs) as crew:
        found = list(_drawn(crew, items, ways, folder))
    return found + list(_jittered(items, folder / "jitter"))


def _drawn(
    crew: _figures_noise.Crew, items: Sequence[_studio.Item], ways: Sequence[settings.Setting], folder: Path
) -> Iterator[Picture]:
    plates = [item.id for item in items]
    drawings = {name: folder / name for name in dict.fromkeys(way.computing for way in ways)}
    tasks = []
    for name, place in drawings.items():
        place.mkdir()
        way = settings.Setting(backend=ways[0].backend, computing=name)
        tasks.append((way, {"do": "compute", "plates": plates, "folder": str(place)}))
    for way, told in crew.each(tasks, str(folder), "computing"):
        _require(told, way)
    tasks = []
    for number, way in enumerate(ways):
        place = folder / f"way {number}"
        place.mkdir()
        where = {"folder": str(drawings[way.computing]), "pictures": str(place)}
        tasks.append((way, {"do": "keep", "plates": plates, **where}))
    for (way, told), (_, task) in zip(crew.each(tasks, str(folder), "rendering"), tasks, strict=True):
        _require(told, way)
        yield from (Picture(str(way), item, Path(task["pictures"], f"{item.id}.png")) for item in items)


def _require(told: dict[str, dict], way: settings.Setting) -> None:
    for plate, about in told.items():
        if "trouble" in about:
            raise _studio.Stop(2, f"{plate} cannot be drawn ({way}): {about['trouble']}")


def _jittered(items: Sequence[_studio.Item], folder: Path) -> Iterator[Picture]:
    from PIL import Image

    from lietool.golden import store

    folder.mkdir()
    for item in items:
        file = folder / f"{item.id}.png"
        Image.fromarray(_noise_worker.jittered(store.read(item.place).image, item.id)).save(file)
        yield Picture("jitter of one grey level", item, file)
