"""Our comparison of pictures beside others, on mistakes and on noise, for `lietool bench peers`."""

import tempfile
from collections import defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

import lietool
from lietool import mutation
from lietool.bench import peers as peers_
from lietool.bench import rules
from lietool.golden import compare, store
from lietool.mutation.mutant import chosen
from lietool.verbs import _figures_noise, _peers_pictures, _studio, _table
from lietool.verbs._peers_pictures import Picture

OWN = rules.Rule(compare.PIXELS, compare.NEAR, compare.STREWN, compare.DELTA_E, compare.LOWPASS)
# Of each time the median is taken.
_RUNS = 7
_SIZE = (1200, 900)


@dataclass(frozen=True)
class Result:
    """What a comparison made of all pictures; `caught` and `missed` are mistakes, `alarms` plates and ways.

    Parameters
    ----------
    name, version, rule, install, takes : str
        As of a `Peer`; without a version it is not installed, and the rest is empty.
    caught, missed, alarms : tuple of str
    seconds_equal, seconds_different, seconds_everywhere : float
        For two equal pictures, for the mistake with the median number of pixels that differ, and for two
        that differ in nearly every pixel.
    """

    name: str
    version: str
    rule: str
    install: str
    takes: str
    caught: tuple[str, ...] = ()
    missed: tuple[str, ...] = ()
    alarms: tuple[str, ...] = ()
    seconds_equal: float | None = None
    seconds_different: float | None = None
    seconds_everywhere: float | None = None


def run(
    npm: Path,
    names: Sequence[str],
    items: Sequence[_studio.Item],
    *,
    plates: int,
    with_rules: bool,
    jobs: int,
) -> dict[str, Any]:
    """Draw the pictures and let all comparisons judge them.

    Parameters
    ----------
    npm : Path
        The folder in which npm has installed its packages.
    names : sequence of str
        What names of mistakes begin with; without any all are tried.
    items : sequence of Item
        The plates.
    plates : int
        At most so many for each mistake.
    with_rules : bool
        Whether rules near our own are tried too.
    jobs : int
        How many processes share the work.

    Returns
    -------
    dict
        For JSON.

    Raises
    ------
    Stop
        With 2 if there is no such mistake or no plate, with 3 if a golden is missing or not whole, with 4
        if no canonical renderer works, with 1 if a comparison that is installed does not.
    """
    try:
        mutants = chosen(names, mutation.catalogue())
    except mutation.MutantError as error:
        raise _studio.Stop(2, str(error)) from None
    if not items:
        raise _studio.Stop(2, "there is no plate to compare. Write a figure first: README.md has an example")
    for item in items:
        try:
            store.provenance(item.place)
        except store.GoldenError as error:
            raise _studio.Stop(3, f"{item.id}: {error}") from None
    _figures_noise.available()
    with tempfile.TemporaryDirectory(prefix="lietool-peers-") as name, peers_.peers(npm) as found:
        folder = Path(name)
        (folder / "mistakes").mkdir()
        (folder / "noise").mkdir()
        wrong, unknown = _peers_pictures.mistaken(
            mutants, items, folder / "mistakes", plates=plates, jobs=jobs
        )
        noise = _peers_pictures.harmless(items, folder / "noise", jobs=jobs)
        try:
            about = measured([ours(), *found], wrong, noise, folder, with_rules=with_rules, jobs=jobs)
        except peers_.PeerError as error:
            raise _studio.Stop(1, str(error)) from None
    return about | {"unknown": unknown}


def ours() -> peers_.Peer:
    """Return our own comparison as one among the others."""

    def differs(pair: peers_.Pair) -> bool:
        return not compare.images(pair.expected, pair.actual).passes

    rule = (
        f"{OWN.pixels} px beyond dE {OWN.delta_e:g} in one place, {OWN.strewn} in all, "
        f"9x9 mean <= {OWN.lowpass:g}"
    )
    return peers_.Peer("lietool", rule, "", "arrays", lietool.__version__, partial(peers_.timed, differs))


def measured(
    those: Sequence[peers_.Peer],
    wrong: Sequence[Picture],
    noise: Sequence[Picture],
    folder: Path,
    *,
    with_rules: bool,
    jobs: int,
) -> dict[str, Any]:
    """Let comparisons judge pictures.

    Parameters
    ----------
    those : sequence of Peer
    wrong, noise : sequence of Picture
        With mistakes, and drawn in harmless ways.
    folder : Path
        For pictures that times are taken of.
    with_rules : bool
        Whether rules near our own are tried too.
    jobs : int
        Threads.

    Returns
    -------
    dict
        For JSON.

    Raises
    ------
    PeerError
        If one does not work.
    """
    asked = rules.neighbours(OWN) if with_rules else [OWN]
    pictures = [*wrong, *noise]
    with ThreadPoolExecutor(jobs) as pool:
        promised = [pool.submit(_judged, those, picture, asked) for picture in pictures]
        found = [promise.result() for promise in _table.progress(promised, "comparing")]
    half = len(wrong)
    mistakes: dict[str, list[rules.Measured]] = defaultdict(list)
    for picture, (_, one) in zip(wrong, found[:half], strict=True):
        mistakes[picture.of].append(one)
    quiet = [one for _, one in found[half:]]
    standings = [rules.standing(rule, mistakes, quiet) for rule in asked]
    return {
        "mistakes": len(mistakes),
        "pictures": half,
        "noise": len(noise),
        "noise_differing": sum(bool(answers) for answers, _ in found[half:]),
        "results": [vars(result) for result in _results(those, wrong, noise, found, folder)],
        "mistakes_use": _uses(mistakes),
        "noise_use": dict(zip(_LIMITS, np.max([q.uses(OWN) for q in quiet], axis=0).tolist(), strict=True)),
        "rules": [s.plain() | {"better": s.better(standings[0]), "own": s.rule == OWN} for s in standings],
    }


_LIMITS = ("in one place", "in all", "9x9 mean")


def _uses(mistakes: dict[str, list[rules.Measured]]) -> list[dict[str, Any]]:
    """How often a mistake's clearest picture reaches a limit, the narrowest mistakes first."""
    clearest = {name: max(pictures, key=lambda one: one.use(OWN)) for name, pictures in mistakes.items()}
    ranked = sorted(clearest.items(), key=lambda pair: pair[1].use(OWN))
    return [
        {"name": name, "use": one.use(OWN), "by": _LIMITS[int(np.argmax(one.uses(OWN)))]}
        for name, one in ranked
    ]


@cache
def _golden(item: _studio.Item) -> np.ndarray:
    return store.read(item.place).image


def _pair(picture: Picture) -> peers_.Pair:
    from PIL import Image

    with Image.open(picture.file) as image:
        actual = np.asarray(image)
    return peers_.Pair(_golden(picture.item), actual, picture.item.place.png, picture.file)


def _judged(
    those: Sequence[peers_.Peer], picture: Picture, asked: Sequence[rules.Rule]
) -> tuple[dict[str, bool], rules.Measured]:
    """Whether each calls a picture different, and what our rules measure; no answers for equal ones."""
    pair = _pair(picture)
    expected, actual = pair.expected, pair.actual
    y, x = np.nonzero(compare.differing(expected, actual))
    height, width = expected.shape[:2]
    # All of them pass what is equal in every pixel.
    answers = {p.name: p.judge(pair).differs for p in those if p.judge} if x.size else {}
    far = compare.delta_e76(expected[y, x], actual[y, x])
    mean = abs(compare.images(expected, actual).lowpass)
    return answers, rules.measure(x, y, far, mean, (width, height), asked)


def _results(
    those: Sequence[peers_.Peer],
    wrong: Sequence[Picture],
    noise: Sequence[Picture],
    found: Sequence[tuple[dict[str, bool], rules.Measured]],
    folder: Path,
) -> Iterator[Result]:
    differing = [(one.differing, p) for p, (_, one) in zip([*wrong, *noise], found, strict=True)]
    # Where there are no mistakes, noise differs too, though less.
    pairs = _to_time(differing[: len(wrong)] or differing, folder)
    every = list(dict.fromkeys(picture.of for picture in wrong))
    for peer in those:
        about = (peer.name, peer.version, peer.rule, peer.install, peer.takes)
        if peer.judge is None:
            yield Result(*about)
            continue
        failed = [p for p, (a, _) in zip([*wrong, *noise], found, strict=True) if a.get(peer.name)]
        caught = {picture.of for picture in failed}
        alarms = [f"{p.item.id}: {p.of}" for p in failed if p.of not in every]
        yield Result(
            *about,
            tuple(name for name in every if name in caught),
            tuple(name for name in every if name not in caught),
            tuple(alarms),
            *(_seconds(peer, pair) for pair in pairs),
        )


def _to_time(differing: Sequence[tuple[int, Picture]], folder: Path) -> tuple[peers_.Pair, ...]:
    """Two equal pictures, two with the median of pixels that differ, and two that differ all over."""
    from PIL import Image

    from lietool.verbs import _noise_worker

    fitting = [pair for pair in differing if _golden(pair[1].item).shape[1::-1] == _SIZE]
    ranked = sorted((fitting or list(differing)), key=lambda pair: pair[0])
    usual = _pair(ranked[len(ranked) // 2][1])
    expected, file = usual.expected, usual.expected_file
    other = _noise_worker.jittered(np.roll(expected, 2, axis=1), "to time")
    files = folder / "equal.png", folder / "other.png"
    for name, image in zip(files, (expected, other), strict=True):
        Image.fromarray(image).save(name)
    return (
        peers_.Pair(expected, expected.copy(), file, files[0]),
        usual,
        peers_.Pair(expected, other, file, files[1]),
    )


def _seconds(peer: peers_.Peer, pair: peers_.Pair) -> float:
    assert peer.judge
    # The first is not counted.
    return median([peer.judge(pair).seconds for _ in range(_RUNS + 1)][1:])
