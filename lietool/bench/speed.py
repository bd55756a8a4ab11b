"""Time every public function of `lietool.lie`; what it takes is read from its docstring."""

import importlib
import inspect
import pkgutil
import re
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lietool import lie
from lietool.bench import tables
from lietool.lie import dual_quaternion, se2, se3, so2, so3, sym

Array = NDArray[np.float64]

SIZES = (1, 1000, 1_000_000)
PATIENCE = 3.0
"""A batch that would take longer than so many seconds is left out."""

_ENTRY = re.compile(r"^(\w+) : (\([^)]*\)|\{\w+\})(?:, (.+))?$")
_SUPPORT = ("blocks", "checks", "kernels")
_LETTERS = {"k": 3, "m": 4, "n": 3}


def functions() -> dict[str, Callable]:
    """Return the public functions by the names under which they are reached, in the order of modules."""
    found: dict[Callable, str] = {}
    for module in pkgutil.iter_modules(lie.__path__):
        if module.name.rsplit("_")[-1] in _SUPPORT:
            continue
        loaded = importlib.import_module(f"lietool.lie.{module.name}")
        for name, f in inspect.getmembers(loaded, inspect.isfunction):
            home = f.__module__.rpartition(".")[2]
            ours = f.__module__.startswith("lietool.lie.") and not name.startswith("_")
            ours = ours and not (home.startswith("group_") or home.split("_")[-1] in _SUPPORT)
            # `import f as f` in another module says that f is meant to be found there.
            if ours and (f not in found or loaded.__name__ != f.__module__):
                found[f] = f"{module.name}.{name}"
    return {name: f for f, name in sorted(found.items(), key=lambda item: item[1])}


def _symmetric(x: Array) -> Array:
    return x + np.swapaxes(x, -1, -2)


def _rotations(x: Array) -> Array:
    n = x.shape[-1]
    return so2.exp(x[..., 0, 0]) if n == 2 else so3.exp(x[..., 0, :])


def _rigid(x: Array) -> Array:
    n = x.shape[-1]
    return (
        se2.exp(x[..., 0, :]) if n == 3 else se3.exp(np.concatenate([x[..., 0, :3], x[..., 1, :3]], axis=-1))
    )


def _affine(x: Array) -> Array:
    # So near to I that every determinant is positive and every logarithm is real.
    A = np.eye(x.shape[-1]) + 0.1 * np.tanh(x)
    A[..., -1, :] = np.eye(x.shape[-1])[-1]
    return A


def _basis(x: Array) -> Array:
    # One for all: of a million random ones, some are nearly dependent.
    return np.broadcast_to(x[:1] - np.swapaxes(x[:1], -1, -2), x.shape).copy()


def _positive(x: Array) -> Array:
    x[..., 0] *= np.sign(np.linalg.det(x))[..., None]
    return x


def _unit(x: Array) -> Array:
    return x / np.linalg.norm(x, axis=-1, keepdims=True)


def _unit_dual_complex(x: Array) -> Array:
    return x / np.linalg.norm(x[..., :2], axis=-1, keepdims=True)


_DOMAINS: dict[str, Callable[[Array], Array]] = {
    "": lambda x: x,
    "basis": _basis,
    "exponential": _affine,
    "radians": lambda x: x,
    "non-zero": lambda x: x,
    "positive": lambda x: np.abs(x) + 0.1,
    "rotation": _rotations,
    "rigid": _rigid,
    "skew": lambda x: x - np.swapaxes(x, -1, -2),
    "symmetric": _symmetric,
    "SPD": lambda x: sym.exp(0.5 * _symmetric(x)),
    "GL+": _positive,
    "affine": _affine,
    "Aff+": _affine,
    "affine exponential": _affine,
    "infinitesimal affine": lambda x: _affine(x) - np.eye(x.shape[-1]),
    "unit vector": _unit,
    "unit quaternion": _unit,
    "unit dual quaternion": lambda x: dual_quaternion.normalize(x),
    "unit dual complex number": _unit_dual_complex,
}


def arguments(f: Callable, size: int) -> list[Any] | None:
    """Return random arguments of a function, a batch of this size, or None where the domain is another."""
    rng = np.random.default_rng(31)
    found = []
    text = re.split(r"^Parameters\n-+\n", inspect.getdoc(f) or "", flags=re.MULTILINE)[-1]
    for line in re.split(r"^\w+\n-+\n", text, flags=re.MULTILINE)[0].splitlines():
        if line.startswith(" ") or not line or " : bool" in line:
            continue
        match = _ENTRY.match(line)
        if match and match[2].startswith("{"):
            # A choice: the first of the words that the module lists.
            found.append(next(iter(getattr(inspect.getmodule(f), match[2].strip("{}")))))
            continue
        domain = (match[3] or "").split(",")[0] if match else "?"
        core = [d.strip() for d in match[2].strip("()").split(",") if d.strip()] if match else []
        known = all(d in _LETTERS or d.isdigit() for d in core[1:])
        if not core or core[0] != "..." or domain not in _DOMAINS or not known:
            return None
        shape = (size, *(_LETTERS.get(d) or int(d) for d in core[1:]))
        found.append(_DOMAINS[domain](rng.normal(size=shape)))
    return found or None


def time_of(name: str, sizes: tuple[int, ...] = SIZES, repeats: int = 5) -> dict[int, float | None]:
    """Return seconds per element by the number of elements, None where it would take too long.

    Parameters
    ----------
    name : str
        As in `functions`.
    sizes : tuple of int
        Rising.
    repeats : int
        The median of so many calls, after one that is not counted; arguments
        are checked, as a caller meets the function.
    """
    f = functions()[name]
    found: dict[int, float | None] = {}
    last = 0.0
    for size in sizes:
        if last * size > PATIENCE:
            found[size] = None
            continue
        given = arguments(f, size) or []
        last = tables.seconds(lambda given=given: f(*given), repeats if size < 100_000 else 3) / size
        found[size] = last
    return found


def left_out(only: str = "") -> list[str]:
    """Return the functions that are not timed: they take names, paths, or a domain of their own."""
    return [n for n, f in functions().items() if n.startswith(only) and arguments(f, 1) is None]
