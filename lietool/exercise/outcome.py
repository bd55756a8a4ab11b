"""What grading gives: for every check its points and what was found, for the whole marks and a diagnosis."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Finding:
    """One input of a check, and what came of it, each in a line of text.

    Parameters
    ----------
    says : str
        What the input is, or which law.
    passed : bool
        Whether all is right.
    given, wanted, got, off : str
        The input, what was expected, what came, and how far apart; empty where it passed.
    trouble : str
        Why nothing came.
    """

    says: str
    passed: bool
    given: str = ""
    wanted: str = ""
    got: str = ""
    off: str = ""
    trouble: str = ""


@dataclass(frozen=True)
class Outcome:
    """A check: its points, all or none, and its inputs.

    Parameters
    ----------
    title : str
        Of the check.
    kind : str
        "cases", "law" or "picture".
    points, of : int
        Earned, and to be had.
    findings : tuple of Finding
        In the order of the check's inputs.
    trouble : str
        What kept the check from its end.
    """

    title: str
    kind: str
    points: int
    of: int
    findings: tuple[Finding, ...] = ()
    trouble: str = ""

    @property
    def passed(self) -> bool:
        """Whether its points are earned."""
        return self.points == self.of


@dataclass(frozen=True, eq=False)
class Shown:
    """The plate drawn with a student's function, beside the accepted picture.

    Parameters
    ----------
    plate : str
        Its id.
    student : ndarray of uint8, shape (h, w, 3), optional
        None where it could not be drawn.
    reference : ndarray of uint8, shape (h, w, 3)
        The golden.
    says : str
        How they compare: "12345 pixels differ", or why there is none.
    """

    plate: str
    student: np.ndarray | None
    reference: np.ndarray
    says: str


@dataclass(frozen=True, eq=False)
class Graded:
    """A submission with its marks.

    Parameters
    ----------
    exercise, title : str
        Which exercise.
    outcomes : tuple of Outcome
        In the order of the exercise; the picture is last.
    diagnosis : tuple of str
        Typical mistakes that explain it, a sentence or two each.
    seed : int
        Of the random inputs.
    digest : str
        SHA-256 of the submission.
    printed : str
        What the submission printed, cut.
    shown : Shown, optional
        The picture, where it was asked for.
    trouble : str
        Why the submission as a whole could not be tried.
    """

    exercise: str
    title: str
    outcomes: tuple[Outcome, ...]
    diagnosis: tuple[str, ...] = ()
    seed: int = 0
    digest: str = ""
    printed: str = ""
    shown: Shown | None = None
    trouble: str = ""

    @property
    def marks(self) -> int:
        """All points earned."""
        return sum(outcome.points for outcome in self.outcomes)

    @property
    def of(self) -> int:
        """All points to be had."""
        return sum(outcome.of for outcome in self.outcomes)

    def as_json(self) -> dict[str, Any]:
        """Return all but the pictures, as what JSON has; the same for the same file and seed."""
        told = {"exercise": self.exercise, "title": self.title, "marks": self.marks, "of": self.of}
        checks = [asdict(outcome) | {"passed": outcome.passed} for outcome in self.outcomes]
        shown = {"plate": self.shown.plate, "says": self.shown.says} if self.shown else None
        return told | {
            "checks": checks,
            "diagnosis": list(self.diagnosis),
            "seed": self.seed,
            "digest": self.digest,
            "printed": self.printed,
            "picture": shown,
            "trouble": self.trouble,
        }
