"""Where each numbered equation is computed, proved and shown: read from the sources, without importing them.

The build of a wheel runs this too, so it needs the standard library only.
"""

import ast
import json
import re
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

TEXTS = {"B": "Book", "M": "MEIS", "K": "Kaji-Ochiai"}
# The parts of the package that compute.
_MATHEMATICS = ("lie", "mesh", "interp", "deform")
# Of several functions the plainest comes first; those of other modules stand between these and the last.
_FIRST = (
    *("so2", "so3", "quaternion", "euler", "se2", "se3"),
    *("affine", "polar", "sym", "blend", "generic", "dual_complex", "triangle", "energy"),
)
_LAST = ("groups", "series")
_CITES = re.compile(rf"^({'|'.join(TEXTS.values())}): (.+(?:\n\(.+)*)", re.MULTILINE)
KINDS = ("functions", "tests", "plates", "errata")
_LETTERS = {name: letter for letter, name in TEXTS.items()}
_NUMBER = re.compile(r"\((A\.\d+|\d+(?:\.\d+)?)\)|(Algorithm \d+)")
# What a citation ends with that only compares.
_NOT_IMPLEMENTED = "for comparison"
_WORDS = {
    "_functions": [f"{name}: ".encode() for name in TEXTS.values()],
    "_plates": [b"Plate("],
    "_errata": [b"@erratum("],
    "_tests": [b"mark.equation", b"mark.erratum"],
}


@dataclass(frozen=True)
class Place:
    """A function, a test or a plate; the file is relative to the folder that holds the package."""

    name: str
    file: str
    line: int


@dataclass(frozen=True)
class Equation:
    """One numbered equation and what the sources say about it."""

    number: str
    says: str
    formula: str
    awaited: str
    functions: tuple[Place, ...] = ()
    tests: tuple[Place, ...] = ()
    plates: tuple[Place, ...] = ()
    errata: tuple[Place, ...] = ()

    @property
    def state(self) -> str:
        """``proved`` (function and test), ``implemented``, ``law`` (test only) or ``open``."""
        if self.functions:
            return "proved" if self.tests else "implemented"
        return "law" if self.tests else "open"


@dataclass
class Found:
    """What the sources cite, by number."""

    functions: dict[str, list[Place]] = field(default_factory=dict)
    tests: dict[str, list[Place]] = field(default_factory=dict)
    plates: dict[str, list[Place]] = field(default_factory=dict)
    errata: dict[str, list[Place]] = field(default_factory=dict)
    later: dict[str, list[Place]] = field(default_factory=dict)
    aliases: dict[str, str] = field(default_factory=dict)


def catalogue(file: Path) -> list[Equation]:
    """Return the equations of the list, with nothing found yet.

    Parameters
    ----------
    file : Path
        ``equations.toml``.

    Returns
    -------
    list of Equation
        In the order of the texts.
    """
    with file.open("rb") as stream:
        listed = tomllib.load(stream)
    awaited = {number: where for where, numbers in listed["awaited"].items() for number in numbers}
    return [
        Equation(f"{text} {number}", says, formula, awaited.get(f"{text} {number}", ""))
        for text in TEXTS
        for number, (says, formula) in listed[text].items()
    ]


def scan(package: Path, figures: Path, tests: Path) -> Found:
    """Read all that is cited.

    Parameters
    ----------
    package, figures, tests : Path
        The folders of the sources; one that is not there has nothing to say.

    Returns
    -------
    Found
        Everything that is cited, also numbers that no list holds.
    """
    found = Found()
    for part in _MATHEMATICS:
        _read(package / part, package.parent, _functions, found)
    _read(figures, figures.parent, _plates, found)
    _read(package / "verbs", package.parent, _errata, found)
    _read(tests, tests.parent, _tests, found)
    for number in found.functions.keys() | found.later.keys():
        plain, remarked = found.functions.get(number, ()), found.later.get(number, ())
        named = [replace(place, name=found.aliases.get(place.name, place.name)) for place in plain]
        found.functions[number] = sorted(named, key=_rank) + list(remarked)
    return found


def _read(folder: Path, root: Path, read: Callable[[ast.Module, str, Found], None], found: Found) -> None:
    for file in sorted(folder.rglob("*.py")):
        data = file.read_bytes()
        # Most files cite nothing, and parsing is what takes the time.
        if any(word in data for word in _WORDS[read.__name__]):
            read(ast.parse(data, str(file)), file.relative_to(root).as_posix(), found)


def _rank(place: Place) -> int:
    module = place.name.partition(".")[0]
    order = (*_FIRST, "", *_LAST)
    return order.index(module) if module in order else len(_FIRST)


def join(equations: list[Equation], found: Found) -> list[Equation]:
    """Return the equations with what was found about each."""
    kinds = {kind: getattr(found, kind) for kind in KINDS}
    return [
        replace(equation, **{kind: tuple(places.get(equation.number, ())) for kind, places in kinds.items()})
        for equation in equations
    ]


def strays(equations: list[Equation], found: Found) -> dict[str, list[str]]:
    """Return the numbers that are cited but in no list, and where: slips of the pen."""
    known = {equation.number for equation in equations}
    return {
        number: [f"{place.file}:{place.line}" for place in places]
        for kind in (found.functions, found.tests, found.plates)
        for number, places in kind.items()
        if number not in known
    }


def numbers(text: str, letter: str = "B") -> list[str]:
    """Return the numbers cited in a line such as ``(2.1), (7.3)-(7.5)``, with the letter of their text."""
    found = [(match, match[1] or match[2]) for match in _NUMBER.finditer(text)]
    cited: list[str] = []
    for i, (match, number) in enumerate(found):
        between = text[found[i - 1][0].end() : match.start()] if i else ""
        if between.strip() in ("-", "–", "to"):
            chapter, _, last = number.rpartition(".")
            first = int(cited[-1].rpartition(" ")[2].rpartition(".")[2])
            dot = f"{chapter}." if chapter else ""
            cited += [f"{letter} {dot}{n}" for n in range(first + 1, int(last))]
        cited.append(f"{letter} {number}")
    return cited


def dumps(equations: list[Equation]) -> str:
    """Return equations as the JSON that a wheel carries."""
    return json.dumps([asdict(equation) for equation in equations], indent=1, ensure_ascii=False) + "\n"


def loads(text: str) -> list[Equation]:
    """Return the equations of `dumps`."""
    return [_loaded(row) for row in json.loads(text)]


def _loaded(row: dict[str, Any]) -> Equation:
    places = {kind: tuple(Place(**place) for place in row.pop(kind)) for kind in KINDS}
    return replace(Equation(**row), **places)


def _functions(tree: ast.Module, file: str, found: Found) -> None:
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("lietool."):
            # `import f as f` says that f is meant to be found here.
            for alias in node.names:
                if alias.asname == alias.name:
                    name = f"{node.module.rpartition('.')[2]}.{alias.name}"
                    found.aliases[name] = f"{Path(file).stem}.{alias.name}"
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            place = Place(f"{Path(file).stem}.{node.name}", file, node.lineno)
            for number, plain in dict(_cited(ast.get_docstring(node) or "")).items():
                # What has a remark such as "with dual numbers" stands behind the others.
                (found.functions if plain else found.later).setdefault(number, []).append(place)


def _cited(docstring: str) -> Iterator[tuple[str, bool]]:
    """The numbers in a docstring, and whether each stands there without a remark."""
    for match in _CITES.finditer(docstring):
        if _NOT_IMPLEMENTED not in match[2]:
            for part in match[2].split(","):
                plain = not re.search(r"[a-z]", part.replace("Algorithm", "").replace(" to ", ""))
                yield from ((number, plain) for number in numbers(part, _LETTERS[match[1]]))


def _tests(tree: ast.Module, file: str, found: Found) -> None:
    classes = [node for node in tree.body if isinstance(node, ast.ClassDef)]
    # Markers stand above functions and classes; walking through all of a test would take most of the time.
    for node in [*tree.body, *(inner for outer in classes for inner in outer.body)]:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            place = Place(node.name, file, node.lineno)
            for mark in (call for item in node.decorator_list for call in ast.walk(item)):
                kind = _mark(mark)
                for cited in _strings(mark) if kind else ():
                    for number in _equations_of(cited) if kind == "erratum" else [cited]:
                        (found.errata if kind == "erratum" else found.tests).setdefault(number, []).append(
                            place
                        )


def _mark(node: ast.AST) -> str:
    """Return which of our two markers a node of the syntax tree is, if any."""
    name = ast.unparse(node.func) if isinstance(node, ast.Call) else ""
    return name.rpartition(".")[2] if name in ("pytest.mark.equation", "pytest.mark.erratum") else ""


def _errata(tree: ast.Module, file: str, found: Found) -> None:
    """The list of `lietool errata`: each is a function under ``@erratum(list, where, ...)``."""
    for node in tree.body:
        for call in getattr(node, "decorator_list", ()):
            if isinstance(call, ast.Call) and ast.unparse(call.func) == "erratum":
                where = next((text for argument in call.args for text in _strings(argument)), "")
                for number in _equations_of(where):
                    found.errata.setdefault(number, []).append(Place(where, file, call.lineno))


def _equations_of(where: str) -> list[str]:
    """The equations that a place such as ``B 6.1, 6.3`` or ``K (8) near pi`` names; a section is none."""
    if where.endswith("(text)"):
        return []
    number = r"(?:A|\d+)\.\d+(?![\d.])|\(\d+\)|(?<=^[MK] )\d+$|Alg\. 1"
    return [f"{where[0]} {n.strip('()').replace('Alg.', 'Algorithm')}" for n in re.findall(number, where)]


def _plates(tree: ast.Module, file: str, found: Found) -> None:
    decorators = [item for node in tree.body for item in getattr(node, "decorator_list", ())]
    for node in (inner for item in decorators for inner in ast.walk(item)):
        if not isinstance(node, ast.Dict):
            continue
        for key, value in zip(node.keys, node.values, strict=True):
            called = isinstance(value, ast.Call) and ast.unparse(value.func).rpartition(".")[2] == "Plate"
            if called and isinstance(key, ast.Constant):
                for number in _plate_equations(value):
                    text, _, digits = number.rpartition(" ")
                    place = Place(str(key.value), file, value.lineno)
                    found.plates.setdefault(f"{text or 'B'} {digits}", []).append(place)


def _plate_equations(call: Any) -> Iterator[str]:
    given = [k.value for k in call.keywords if k.arg == "equations"] or call.args[1:2]
    for node in given:
        yield from _strings(node)


def _strings(node: ast.AST) -> list[str]:
    return [n.value for n in ast.walk(node) if isinstance(n, ast.Constant) and isinstance(n.value, str)]
