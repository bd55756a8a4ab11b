"""The page of a report: what the template shows of each entry, as text that is ready to be read."""

from collections.abc import Mapping, Sequence

from lietool.golden.report import Entry


def render(entries: Sequence[Entry], *, title: str, about: Mapping[str, str], review: str) -> str:
    """Fill the template."""
    raise NotImplementedError
