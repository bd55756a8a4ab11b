"""A mutant: one small mistake in one module, as two pieces of source, and the catalogues of them."""

import ast
import re
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from pathlib import Path

from lietool import paths

CATALOGUE = Path(__file__).with_name("catalogue")

MISTAKES = {
    "sign": "a plus for a minus, or the other way round",
    "transpose": "rows for columns, or the inverse for the rotation",
    "half angle": "an angle where half of it is wanted, or the other way round",
    "missing term": "a term, a factor or a normalisation is left out",
    "wrong term": "another term, index or operand than the right one",
    "wrong factor": "a factor that does not belong there, or another than the right one",
    "wrong branch": "the other case, root or period of a function with several",
    "wrong order": "factors of a product, or steps, in another order",
    "wrong weights": "weights that are constant, not normalised, or of another kind",
    "swapped weights": "1 - t for t, or the weight of one for that of the other",
    "degrees": "degrees for radians, or the other way round",
    "nlerp": "linear interpolation, normalised, in place of that along the arc",
    "no root": "A^T A where its root is wanted",
    "wrong power": "a power, root or logarithm that is left out or another",
    "off by one": "an index, a count or the end of a range moved by one",
    "erratum": "the formula as it is printed, where the print errs; the place follows",
    "scaled": "the right formula, off by a relative size that follows: 1e-1 to 1e-4",
}
"""What mistakes are called; behind "erratum" and "scaled" stands more."""

_NAME = re.compile(r"[a-z][A-Za-z0-9_.]*: \S.*")
_MORE = re.compile(r"erratum [BKM] \S.*|scaled 1e-[1-4]")


class MutantError(ValueError):
    """A catalogue that cannot be used; the message names the mutant and says what to do."""


@dataclass(frozen=True)
class Mutant:
    """One mistake.

    Parameters
    ----------
    name : str
        Where and what: "so3.exp: half of the angle".
    module : str
        Dotted, such as "lietool.lie.so3".
    old, new : str
        A piece of the module's source that occurs once in it, and what stands there instead.
    mistake : str
        One of `MISTAKES`; "erratum" and "scaled" with the place or the size behind it.
    says : str
        A sentence for a student: what this computes, and what it should be.
    harmless : str
        Why nothing can be seen of it; empty where something can.
    """

    name: str
    module: str
    old: str
    new: str
    mistake: str
    says: str
    harmless: str = ""

    def __post_init__(self) -> None:
        if not _NAME.fullmatch(self.name):
            raise MutantError(f"mutant {self.name!r}: name must be 'where: what', such as 'so3.exp: sign'")
        if not (self.mistake in MISTAKES.keys() - {"erratum", "scaled"} or _MORE.fullmatch(self.mistake)):
            known = ", ".join(MISTAKES)
            raise MutantError(
                f"mutant {self.name!r}: mistake must be one of {known} (erratum B 7.6, scaled 1e-3); "
                f"got {self.mistake!r}. Choose one"
            )
        if not self.old.strip() or self.old == self.new or not self.says.strip():
            raise MutantError(f"mutant {self.name!r}: old, another new, and says must be written out")

    @property
    def file(self) -> Path:
        """The file of the module."""
        words = self.module.split(".")
        if words[0] != "lietool" or not all(word.isidentifier() for word in words):
            raise MutantError(f"mutant {self.name!r}: module must be one of lietool's; got {self.module!r}")
        return paths.PACKAGE.joinpath(*words[1:]).with_suffix(".py")

    @property
    def original(self) -> str:
        """The source of the module as it is."""
        try:
            return self.file.read_text(encoding="utf-8")
        except OSError:
            raise MutantError(f"mutant {self.name!r}: there is no module {self.module}. Rename it") from None

    @property
    def source(self) -> str:
        """The source with the mistake in it; raises MutantError where `old` is not there once."""
        original = self.original
        if (count := original.count(self.old)) != 1:
            raise MutantError(
                f"mutant {self.name!r}: old must occur once in {self.module}; it occurs {count} times. "
                "Copy it from the file as it is now, with more of what stands around it"
            )
        return original.replace(self.old, self.new)

    @property
    def lines(self) -> frozenset[int]:
        """Lines of the original that belong to the statements which are changed, from 1."""
        original, source = self.original, self.source
        start = original.index(self.old)
        # What old and new have in common at their ends is not changed, and may be another statement.
        while original[start] == source[start]:
            start += 1
        end, longer = len(original), len(source) - len(original)
        while min(end, end + longer) > start and original[end - 1] == source[end - 1 + longer]:
            end -= 1
        first = original.count("\n", 0, start) + 1
        last = first + original.count("\n", start, max(end - 1, start))
        return frozenset(_statements(ast.parse(original), first, last))


def catalogue(folder: Path = CATALOGUE) -> tuple[Mutant, ...]:
    """Read all catalogues.

    Parameters
    ----------
    folder : Path
        Where their files lie.

    Returns
    -------
    tuple of Mutant
        In the order of the files' names, and in each as written.

    Raises
    ------
    MutantError
        If a file is not as it should be, or two mutants have one name.
    """
    found: dict[str, Mutant] = {}
    for file in sorted(folder.glob("*.toml")):
        for mutant in _read(file):
            if mutant.name in found:
                raise MutantError(f"{file.name}: there are two mutants {mutant.name!r}. Rename one")
            found[mutant.name] = mutant
    return tuple(found.values())


def chosen(names: Sequence[str], mutants: Sequence[Mutant]) -> tuple[Mutant, ...]:
    """Choose mutants by what their names begin with, or by their modules; all without any.

    Parameters
    ----------
    names : sequence of str
        Such as "so3.", "so3.exp: half of the angle" or "lietool.lie.so3".
    mutants : sequence of Mutant
        From these.

    Returns
    -------
    tuple of Mutant
        In their order.

    Raises
    ------
    MutantError
        If there is none for a name.
    """
    wanted: set[Mutant] = set()
    for name in names:
        found = [m for m in mutants if m.name.startswith(name) or m.module == name]
        if not found:
            raise MutantError(
                f"no mutant begins with {name!r}. `lietool figures mutants --list` has them all"
            )
        wanted.update(found)
    return tuple(m for m in mutants if m in wanted or not names)


def _read(file: Path) -> Iterator[Mutant]:
    known = {field.name for field in fields(Mutant)}
    try:
        tables = tomllib.loads(file.read_text(encoding="utf-8"))["mutant"]
    except (tomllib.TOMLDecodeError, KeyError, UnicodeDecodeError) as error:
        raise MutantError(
            f"{file.name}: it must be TOML with tables [[mutant]]; {error}. Correct it"
        ) from None
    for table in tables:
        wrong = table.keys() ^ known
        if wrong - {"harmless"}:
            raise MutantError(
                f"{file.name}: mutant {table.get('name', '')!r} must have {', '.join(sorted(known))}; "
                f"wrong or missing: {', '.join(sorted(wrong - {'harmless'}))}"
            )
        # Behind the last line of a text of several there is an end of line, which nobody means.
        texts = {key: value.removesuffix("\n") for key, value in table.items()}
        yield Mutant(**texts)


def _statements(tree: ast.Module, first: int, last: int) -> Iterator[int]:
    """Yield the lines of the statements that lines first to last touch: of a compound one, its head."""
    for node in ast.walk(tree):
        if not isinstance(node, ast.stmt):
            continue
        start, end = node.lineno, node.end_lineno or node.lineno
        body = getattr(node, "body", None)
        if isinstance(body, list) and body:
            start = min([start, *(d.lineno for d in getattr(node, "decorator_list", ()))])
            end = max(start, body[0].lineno - 1)
        if start <= last and end >= first:
            yield from range(start, end + 1)
