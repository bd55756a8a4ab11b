"""A computed example for an equation: expressions of the list, or a function called on small fixed input."""

import importlib
import importlib.util
import inspect
import re
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any

import numpy as np

_ENTRY = re.compile(r"^(?P<name>\w+) : (?P<kind>\([^)]*\)|\{\w+\}|bool)(?:, (?P<words>.+))?$")
_MODULE = re.compile(r"\b([a-z_0-9]+)\.[a-z_]+")
# Numbers without a pattern, so that a wrong entry or a wrong sign cannot hide.
_PLAIN = (0.3, -0.2, 0.6, 0.5, -0.4, 0.1, 0.7, 0.2, -0.5, 0.4, -0.1, 0.8, 0.6, -0.3, 0.9, -0.7)
_DIMENSIONS = {"n": 3, "m": 4, "k": 2}


def of_function(name: str) -> list[tuple[str, str]]:
    """Call a function of `lietool.lie` on a small fixed input.

    Parameters
    ----------
    name : str
        Such as ``so3.exp``.

    Returns
    -------
    list of tuple of str
        What is computed and what comes out, the arguments first.

    Raises
    ------
    ValueError
        If the docstring asks for something that has no sample here.
    """
    module, _, word = name.partition(".")
    function = getattr(importlib.import_module(f"lietool.lie.{module}"), word)
    given = {}
    for i, (argument, kind, words) in enumerate(_arguments(function)):
        given[argument] = _choice(function, kind) if kind.startswith("{") else _sample(kind, words, i)
    names = ", ".join(repr(v) if isinstance(v, str) else k for k, v in given.items())
    lines = [(k, show(v)) for k, v in given.items() if not isinstance(v, str)]
    return [*lines, (f"{name}({names})", show(function(**given)))]


def of_expressions(expressions: list[str]) -> list[tuple[str, str]]:
    """Compute expressions in which ``np`` and the modules of our mathematics are known.

    Parameters
    ----------
    expressions : list of str
        From the list of equations, which is ours; ``name = ...`` keeps a value for those that follow.

    Returns
    -------
    list of tuple of str
        What is computed and what comes out.
    """
    known: dict[str, Any] = {"np": np}
    lines = []
    for text in expressions:
        names, _, expression = text.rpartition(" = ")
        for module in set(_MODULE.findall(expression)) - known.keys():
            known[module] = _module(module)
        value = eval(expression, known)
        kept = names.split(", ") if names else []
        known |= dict(zip(kept, value if len(kept) > 1 else [value], strict=False))
        lines.append((text, show(value)))
    return lines


def _module(name: str) -> ModuleType:
    for part in ("lie", "interp", "deform"):
        if importlib.util.find_spec(f"lietool.{part}.{name}"):
            return importlib.import_module(f"lietool.{part}.{name}")
    return importlib.import_module(f"lietool.mesh.{name}")


def show(value: Any) -> str:
    """Return a result as text, rounded."""
    if isinstance(value, tuple):
        return "\n".join(map(show, value))
    value = np.asarray(value)
    if value.dtype.kind in "fc":
        # Adding 0.0 leaves no -0.
        value = np.round(value, 6) + 0.0
    return np.array2string(value, separator=", ", floatmode="maxprec_equal")


def _arguments(function: Callable[..., Any]) -> Iterator[tuple[str, str, str]]:
    """Name, shape and domain of each argument, as the docstring has them."""
    _, _, rest = (inspect.getdoc(function) or "").partition("Parameters\n----------\n")
    for line in re.split(r"\n\w+\n-+\n", rest)[0].splitlines():
        match = _ENTRY.match(line)
        if match and match["kind"] != "bool":
            yield match["name"], match["kind"], match["words"] or ""
        elif line and not line.startswith(" ") and not match:
            raise ValueError(f"{function.__module__}.{function.__name__}: no sample for {line!r}")


def _choice(function: Callable[..., Any], kind: str) -> str:
    return getattr(inspect.getmodule(function), kind.strip("{}"))[-1]


def _sample(kind: str, words: str, shift: int) -> np.ndarray:
    """A fixed array of a domain; `shift` makes the second argument differ from the first."""
    core = [part.strip() for part in kind.strip("()").split(",")]
    shape = tuple(_DIMENSIONS.get(part) or int(part) for part in core if part not in ("", "..."))
    x = np.resize(np.roll(_PLAIN, -shift), shape)
    domain = words.split(",")[0]
    make = _DOMAINS.get(domain)
    if make is None:
        raise ValueError(f"no sample for the domain {domain!r}. Add it to _DOMAINS")
    return make(x)


def _rotation(x: np.ndarray) -> np.ndarray:
    q, r = np.linalg.qr(x + 2.0 * np.eye(x.shape[-1]))
    return q * np.sign(np.diagonal(r))


def _rigid(x: np.ndarray) -> np.ndarray:
    return _homogeneous(_rotation(x[:-1, :-1]), x[:-1, -1])


def _homogeneous(A: np.ndarray, d: np.ndarray) -> np.ndarray:
    n = d.shape[-1]
    H = np.zeros((*d.shape[:-1], n + 1, n + 1))
    H[..., :n, :n], H[..., :n, n], H[..., n, n] = A, d, 1.0
    return H


def _affine(x: np.ndarray) -> np.ndarray:
    n = x.shape[-1] - 1
    return _homogeneous(x[..., :n, :n] + 2.0 * np.eye(n), x[..., :n, n])


def _unit(x: np.ndarray) -> np.ndarray:
    return x / np.linalg.norm(x)


def _unit_dual(x: np.ndarray) -> np.ndarray:
    q = x / np.linalg.norm(x[:4])
    q[4:] -= (q[:4] @ q[4:]) * q[:4]
    return q


def _complex_form(x: np.ndarray) -> np.ndarray:
    z, w = x @ [1, 1j]
    return np.array([[z, -w], [w.conjugate(), z.conjugate()]])


_DOMAINS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "": lambda x: x,
    "radians": lambda x: x,
    "non-zero": lambda x: x,
    "positive": lambda x: np.abs(x) + 0.1,
    "skew": lambda x: x - x.T,
    "symmetric": lambda x: x + x.T,
    "SPD": lambda x: x @ x.T + np.eye(len(x)),
    "GL+": lambda x: x + 2.0 * np.eye(len(x)),
    "Aff+": _affine,
    "affine": _affine,
    "affine multiple": lambda x: 2.0 * _affine(x),
    "rotation": _rotation,
    "rigid": _rigid,
    "unit vector": _unit,
    "unit quaternion": _unit,
    "unit dual quaternion": _unit_dual,
    "unit dual complex number": lambda x: x / np.linalg.norm(x[:2]),
    "complex form": _complex_form,
}
