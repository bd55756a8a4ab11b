"""What came of trying mutants: for each whether the plates noticed it and how, and the score of all."""

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from lietool.mutation.mutant import Mutant

VISIBLE = 0.35
"""In pixels: what moves as far must be noticed by the picture alone."""

FAILURES = ("undrawn", "hangs")


@dataclass(frozen=True)
class Outcome:
    """One mutant on one plate.

    Parameters
    ----------
    plate : str
    changed : bool
        Whether anything of the picture or the numbers differs by more than rounding.
    picture, numbers : bool
        Whether the comparison of pictures or of numbers fails.
    failure : str
        "undrawn" where it raises, "hangs" where it takes too long; else empty.
    displacement : float or None
        Pixels that the farthest vertex moves; None where the records do not line up or there are none.
    over : int
        Pixels beyond the colour distance.
    lowpass : float
        Grey levels of the 9x9 mean.
    says : str
        How it failed, or the first number that differs.
    ended : bool
        Whether the process hung or died, so that no further plate was tried.
    skipped : bool
        Whether it was not tried, since enough others had noticed.
    """

    plate: str
    changed: bool = False
    picture: bool = False
    numbers: bool = False
    failure: str = ""
    displacement: float | None = 0.0
    over: int = 0
    lowpass: float = 0.0
    says: str = ""
    ended: bool = False
    skipped: bool = False

    @property
    def by(self) -> tuple[str, ...]:
        """What noticed it: of "picture", "numbers", "undrawn", "hangs"."""
        kinds = ["picture"] * self.picture + ["numbers"] * self.numbers
        return (*kinds, self.failure) if self.failure else tuple(kinds)


@dataclass(frozen=True)
class Tried:
    """A mutant and what came of it on every plate that executes what it changes.

    Parameters
    ----------
    mutant : Mutant
    outcomes : tuple of Outcome
    sampled : bool
        Whether some of those plates were left out.
    """

    mutant: Mutant
    outcomes: tuple[Outcome, ...] = ()
    sampled: bool = False

    @property
    def effective(self) -> bool:
        """Whether it changes any plate by more than rounding."""
        return any(outcome.changed for outcome in self.outcomes)

    @property
    def by(self) -> tuple[str, ...]:
        """What noticed it on any plate."""
        found = {kind for outcome in self.outcomes for kind in outcome.by}
        return tuple(kind for kind in ("picture", "numbers", *FAILURES) if kind in found)

    @property
    def plates(self) -> tuple[str, ...]:
        """The plates that noticed it."""
        return tuple(outcome.plate for outcome in self.outcomes if outcome.by)

    @property
    def caught(self) -> bool:
        """Whether any plate noticed it."""
        return bool(self.plates)

    @property
    def displacement(self) -> float | None:
        """Pixels that the farthest vertex of all plates moves; None where that is not known of any."""
        known = [o.displacement for o in self.outcomes if o.changed and o.displacement is not None]
        return max(known) if known else None if self.effective else 0.0

    @property
    def trouble(self) -> str:
        """What is wrong with the plates or with the catalogue; empty where all is well."""
        if self.effective:
            if self.mutant.harmless:
                where = next(outcome.plate for outcome in self.outcomes if outcome.changed)
                return f"declared harmless, but changes {where}"
            if not self.caught:
                return "slips through"
            if (self.displacement or 0.0) >= VISIBLE and "picture" not in self.by:
                return f"moves {self.displacement:.2f} px, and no picture notices"
            return ""
        if self.mutant.harmless or self.sampled:
            return ""
        if not self.outcomes:
            return "no plate executes it, and it is not declared harmless"
        return "changes no plate, and is not declared harmless"

    def plain(self) -> dict[str, Any]:
        """Return it for JSON."""
        about = dataclasses.asdict(self.mutant)
        return {
            **{key: about[key] for key in ("name", "module", "mistake", "says")},
            "effective": self.effective,
            "caught": self.caught,
            "plates": list(self.plates),
            "by": list(self.by),
            "displacement": self.displacement,
            "harmless": self.mutant.harmless,
            "trouble": self.trouble,
            "tried": [{**dataclasses.asdict(o), "by": list(o.by)} for o in self.outcomes],
        }


def score(tried: Sequence[Tried], commands: Mapping[str, str]) -> dict[str, Any]:
    """Count.

    Parameters
    ----------
    tried : sequence of Tried
    commands : Mapping[str, str]
        The command of every plate.

    Returns
    -------
    dict
        For JSON: how many mutants there are, are effective, are caught, by what; of those that move
        something by `VISIBLE` pixels, how many a picture noticed; and how many each command noticed.
    """
    effective = [one for one in tried if one.effective]
    visible = [one for one in effective if (one.displacement or 0.0) >= VISIBLE]
    of_command = dict.fromkeys(commands.values(), 0)
    for one in effective:
        for command in {commands[plate] for plate in one.plates}:
            of_command[command] += 1
    caught = sum(one.caught for one in effective)
    seen = sum("picture" in one.by for one in visible)
    return {
        "mutants": len(tried),
        "effective": len(effective),
        "caught": caught,
        "percent": _percent(caught, len(effective)),
        "by": {kind: sum(kind in one.by for one in effective) for kind in ("picture", "numbers", *FAILURES)},
        "visible": len(visible),
        "visible_by_picture": seen,
        "visible_percent": _percent(seen, len(visible)),
        "only_numbers": sum(one.by == ("numbers",) for one in effective),
        "only_failures": sum(bool(one.by) and set(one.by) <= set(FAILURES) for one in effective),
        "harmless": sum(bool(one.mutant.harmless) for one in tried),
        "commands": of_command,
    }


def _percent(part: int, whole: int) -> float:
    return 100.0 * part / whole if whole else 100.0
