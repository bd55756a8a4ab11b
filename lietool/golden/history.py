"""What was accepted when and why: a list that the picture itself carries, one entry longer at each accept."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields, replace

KEY = "history"
# Of what has changed, in characters: what comes after it is in the numbers' own file.
_MOST = 400


@dataclass(frozen=True)
class Change:
    """One accept: when (ISO 8601), at which commit, why it was right, and what had changed."""

    date: str = "unknown"
    commit: str = "unknown"
    reason: str = ""
    what: str = ""


def read(found: Mapping[str, str]) -> tuple[Change, ...]:
    """Return all that was accepted for a golden.

    Parameters
    ----------
    found : Mapping[str, str]
        The texts of its picture.

    Returns
    -------
    tuple of Change
        The oldest first; of a picture older than such lists, or with one that cannot be read, the one
        entry that its date, commit and reason make.
    """
    try:
        listed = json.loads(found.get(KEY, "[]"))
        changes = tuple(_change(entry) for entry in listed)
    except (ValueError, TypeError, AttributeError):
        changes = ()
    return changes or ((_change(found),) if "reason" in found else ())


def extended(before: Mapping[str, str], now: Mapping[str, str], what: str) -> str:
    """Return the list that a picture should carry, with one more entry.

    Parameters
    ----------
    before : Mapping[str, str]
        The texts of the picture that it replaces; empty for a new one.
    now : Mapping[str, str]
        Those of the new one: date, commit and reason.
    what : str
        What has changed; what is too long is cut.

    Returns
    -------
    str
        JSON, for the text `KEY`.
    """
    short = what if len(what) <= _MOST else what[:_MOST].rstrip() + " …"
    latest = replace(_change(now), what=short)
    return json.dumps([asdict(change) for change in (*read(before), latest)], ensure_ascii=False)


def _change(entry: Mapping[str, str]) -> Change:
    known = {field.name for field in fields(Change)}
    return Change(**{key: " ".join(str(value).split()) for key, value in entry.items() if key in known})
