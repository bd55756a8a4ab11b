"""`lietool figures report`: the verdicts of `verify` as one page, with every picture and number."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import click

from lietool import atomic
from lietool.golden import report, verdict
from lietool.verbs import _figures_verify, _jobs, _studio

REVIEW = "figures accept --from review.json"
_ABOUT = (
    "renderer",
    "backend",
    "mesa",
    "llvm",
    "lietool",
    "numpy",
    "moderngl",
    "matplotlib",
    "commit",
    "date",
)


@dataclass(frozen=True, eq=False)
class Judged:
    """A plate's entry in the report, what was found wrong with it, and how its picture was made."""

    entry: report.Entry
    findings: tuple[verdict.Finding, ...]
    made: Mapping[str, str]


def run(
    items: Sequence[_studio.Item],
    studio: _studio.Studio,
    path: Path,
    *,
    everything: bool,
    jobs: int = 1,
) -> int:
    """Compare plates with their goldens and write the page.

    Parameters
    ----------
    items : sequence of Item
        The plates.
    studio : Studio
        The renderer of this process.
    path : Path
        The file to write.
    everything : bool
        Whether these are all plates, so that goldens without a plate can be found.
    jobs : int
        How many processes share the work.

    Returns
    -------
    int
        The exit code, that of `verify`.

    Raises
    ------
    Stop
        With 2 if the page cannot be written.
    """
    # Before minutes of drawing, not after them.
    if path.is_dir():
        raise _studio.Stop(2, f"{path} is a folder. Name a file with -o, such as {path / 'report.html'}")
    with _studio.writing(str(path)):
        path.parent.mkdir(parents=True, exist_ok=True)
    general = [verdict.Finding("renderer", studio.trouble)] if studio.trouble else []
    work = partial(_judged, studio=studio if jobs < 2 else None)
    judged = list(_jobs.each(work, items, jobs, "comparing"))
    if everything:
        general += _figures_verify.unregistered(items)
    made = next((each.made for each in judged if each.made), {})
    page = report.build(
        [each.entry for each in judged],
        title="Pictures and their goldens",
        about={key: made[key] for key in _ABOUT if key in made},
        notes=[finding.message for finding in general],
        review=f"{items[0].program if items else 'lietool'} {REVIEW}",
    ).encode()
    with _studio.writing(str(path)):
        atomic.write_bytes(path, page)
    kinds = [each.entry.kind for each in judged]
    said = ", ".join(f"{kinds.count(kind)} {kind}" for kind in (report.FAILED, report.CHANGED, report.PASSED))
    click.echo(f"{path}: {said} ({len(page) / 1e6:.1f} MB)")
    for finding in general:
        click.echo(click.style(f"{finding.kind}: ", "red") + finding.message)
    return verdict.exit_code([*general, *(found for each in judged for found in each.findings)])


def _judged(item: _studio.Item, studio: _studio.Studio | None) -> Judged:
    studio = studio or _studio.Studio()
    try:
        painted = studio.sketch(item) if studio.trouble else studio.paint(item)
    except _figures_verify.UNDRAWN as error:
        found = _figures_verify.undrawn(error)
        return _told(item, verdict.Verdict((found,)), None, {})
    made = {} if studio.trouble else _studio.provenance(item, studio.info)
    pictured = not studio.trouble
    found = _figures_verify.judge(item, painted, pictured=pictured, now=made)
    return _told(item, found, painted, made, pictured=pictured)


def _told(
    item: _studio.Item,
    found: verdict.Verdict,
    painted: _studio.Painted | None,
    made: Mapping[str, str],
    *,
    pictured: bool = False,
) -> Judged:
    golden, tolerance = found.golden, item.plate.tolerance
    entry = report.entry(
        item.id,
        title=item.plate.title,
        word=found.word,
        messages=[finding.message for finding in found.findings],
        expected=golden.image if golden else None,
        actual=painted.image if painted and pictured else None,
        comparison=found.comparison,
        before=golden.numbers if golden else None,
        after=painted.numbers if painted else None,
        differences=found.differences,
        relative=tolerance.relative,
        because=tolerance.because,
        parameters=_parameters(item),
        provenance=(golden.provenance if golden else {}, made),
        accept=f"{item.program} figures accept {item.id}",
    )
    return Judged(entry, found.findings, made)


def _parameters(item: _studio.Item) -> dict[str, str]:
    declared = {parameter.name: parameter for parameter in item.declared.parameters}
    return {
        declared[name].option: "none" if value in (None, ()) else declared[name].text(value)
        for name, value in item.parameters.items()
        if name in declared and not declared[name].idle(item.parameters)
    }
