"""`lietool figures accept`: the only thing that writes goldens."""

import contextlib
from collections.abc import Callable, Mapping, Sequence

import click

from lietool.golden import compare, compare_numbers, folder, history, numbers, store, verdict
from lietool.verbs import _figures_gallery, _recorded, _studio, _table


def run(
    items: Sequence[_studio.Item],
    studio: _studio.Studio,
    reason: str | Mapping[str, str],
    before: Callable[[], None] = lambda: None,
) -> None:
    """Make what plates show now their goldens, and print what has changed.

    Parameters
    ----------
    items : sequence of Item
        The plates.
    studio : Studio
        The renderer.
    reason : str or Mapping[str, str]
        Why they are right, all or each plate.
    before : callable
        What may still stop it, once nobody else can write to the goldens.

    Raises
    ------
    Stop
        With 4 if the renderer is not canonical, with 2 if a golden cannot be kept or written.
    """
    if studio.trouble:
        raise _studio.Stop(4, studio.trouble)
    known = _studio.items(everything=True)
    everything = [item.place for item in known]
    roots = list(dict.fromkeys(item.place.root for item in items))
    with contextlib.ExitStack() as locks:
        # Labels are shared: from looking for them to the last picture nobody else may write or sweep.
        for root in sorted(roots):
            with _studio.writing(str(root)):
                locks.enter_context(folder.lock(root))
        before()
        for item in _table.progress(items, "accepting"):
            why = reason if isinstance(reason, str) else reason[item.id]
            click.echo(f"{item.id}: {_accept(item, studio, why)}")
        for root in roots:
            with _studio.writing(str(root)):
                removed = folder.sweep(root, [place for place in everything if place.root == root])
            if removed:
                click.echo(
                    f"removed {len(removed)} labels that no golden uses: {', '.join(p.stem for p in removed)}"
                )
        for path in _figures_gallery.write_readme([item for item in known if item.place.root in roots]):
            click.echo(f"{path}: renewed")


def _accept(item: _studio.Item, studio: _studio.Studio, reason: str) -> str:
    painted = studio.paint(item)
    try:
        change = _change(item, painted)
        if change:
            made = _studio.provenance(item, studio.info) | {"reason": reason}
            past = history.extended(store.remembered(item.place), made, change)
            with _studio.writing(str(item.place.png)):
                store.write(
                    item.place,
                    painted.image,
                    painted.numbers,
                    labels=painted.fresh,
                    label_keys=painted.label_keys,
                    provenance=made | {history.KEY: past},
                )
    except ValueError as error:
        raise _studio.Stop(2, str(error)) from None
    return change or "unchanged, left as it is"


def _change(item: _studio.Item, painted: _studio.Painted) -> str:
    """What differs from the golden there is, to the last bit; empty if nothing does."""
    try:
        old = store.read(item.place)
    except store.GoldenError as error:
        return "new" if error.kind == "missing" else f"whole again, was {error.kind}"
    before = old.provenance
    said = []
    compared = compare.images(old.image, painted.image)
    if not compared.same_size:
        said.append(f"size was {_by(compared.expected_size)}, is {_by(compared.actual_size)}")
    elif not compared.equal:
        said.append(
            f"{compared.differing} px changed, {compared.over} beyond dE 2,"
            f" largest {compared.largest_delta_e:.1f}, 9x9 mean {compared.lowpass:+.2f}"
        )
    if numbers.dumps(old.numbers) != numbers.dumps(painted.numbers):
        differences = compare_numbers.numbers(old.numbers, painted.numbers, 0.0)
        said.append("numbers: " + ("; ".join(map(str, differences)) or "in another order or type"))
    if change := verdict.changed(before.get("parameters", ""), item.recorded):
        said.append(f"parameters: {change}")
    inputs = _recorded.inputs(item.parameters)
    if change := verdict.changed(before.get("inputs", inputs), inputs):
        said.append(f"files: {change}")
    if not before.get("renderer", "").startswith(verdict.CANONICAL):
        said.append(f"was made by {before.get('renderer', 'unknown')!r}")
    if painted.fresh or store.label_keys(before) != painted.label_keys:
        said.append(f"labels ({len(painted.fresh)} new)")
    return "; ".join(said)


def _by(size: tuple[int, int]) -> str:
    return f"{size[0]}x{size[1]}"
