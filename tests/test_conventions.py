"""The docstrings of the mathematics tell the truth: arguments, shapes, domains, batches, book numbers."""

import importlib
import inspect
import math
import pkgutil
import re
from collections.abc import Callable
from types import FunctionType

import numpy as np
import pytest

import lietool.deform
import lietool.interp
import lietool.lie
import lietool.mesh
from lietool.interp import triangle

# They serve the others and are no mathematical objects: their arguments are rows, names and messages.
SUPPORT = ("blocks", "checks", "kernels")
# Parts of modules that would be too long: they are reached, and named in messages, as those modules.
REACHED_AS = {
    "affine_classes": "affine",
    "axis_angle": "so3",
    "dual_blend": "dual_quaternion",
    "dual_complex_blend": "dual_complex",
    "quaternion_complex": "quaternion",
    "screw": "dual_quaternion",
    "slerp": "quaternion",
}
# What an element is depends on the group that is asked for: tests/lie/test_group_records.py tries them all.
GROUPS = ("groups", "group_maps", "group_matrices", "group_numbers", "group_records")
MODULES = sorted(
    name
    for name in (m.name for m in pkgutil.iter_modules(lietool.lie.__path__))
    if name.rsplit("_")[-1] not in SUPPORT and name not in GROUPS
)
ENTRY = re.compile(r"^(?P<name>\w+) : (?P<kind>\([^)]*\)|\{\w+\}|bool)(?:, (?P<words>.+))?$")
BATCH = (2, 5)
ANY_LENGTH = ("(..., n)", "(..., m)")
SIZES = {"k": 3, "n": 3, "m": 4}  # what a letter stands for in a shape


def public(module) -> list[FunctionType]:
    members = inspect.getmembers(module, inspect.isfunction)
    return [f for name, f in members if not name.startswith("_") and f.__module__ == module.__name__]


FUNCTIONS = [
    pytest.param(f, id=f"{name}.{f.__name__}")
    for name in MODULES
    for f in public(importlib.import_module(f"lietool.lie.{name}"))
]
# Of the homotopies the batch comes after that of times; tests/interp tries them.
FUNCTIONS += [
    pytest.param(f, id=f"triangle.{f.__name__}")
    for f in (triangle.frame, triangle.affine_map, triangle.has_real_log, triangle.principal_angle)
]
# Functions on whole meshes: no batches, but what they say of their arguments is as true.
OF_MESHES = [
    pytest.param(f, id=f"{module.name}.{f.__name__}")
    for package in (lietool.interp, lietool.mesh, lietool.deform)
    for module in pkgutil.iter_modules(package.__path__)
    for f in public(importlib.import_module(f"{package.__name__}.{module.name}"))
]


def section(f: Callable, title: str) -> list[str]:
    """Return the unindented lines of a numpydoc section."""
    parts = re.split(r"^(\w+)\n-+\n", inspect.getdoc(f) or "", flags=re.MULTILINE)
    body = dict(zip(parts[1::2], parts[2::2], strict=True)).get(title, "")
    return [line for line in body.splitlines() if line and not line.startswith(" ")]


def entries(f: Callable, title: str) -> list[tuple[str, str, str]]:
    matches = []
    for line in section(f, title):
        match = ENTRY.match(line)
        assert match, f"{f.__module__}.{f.__name__}: cannot read {line!r}"
        matches.append((match["name"], match["kind"], match["words"] or ""))
    return matches


def core(kind: str) -> tuple[int, ...]:
    dimensions = kind.strip("()").replace(" ", "").split(",")
    assert dimensions[0] == "...", f"{kind} must start with ..."
    return tuple(SIZES[d] if d in SIZES else int(d) for d in dimensions[1:] if d)


def sample(rng: np.random.Generator, kind: str, words: str) -> np.ndarray:
    shape = (*BATCH, *core(kind))
    x = rng.normal(size=shape)
    domain = words.split(",")[0]
    if domain == "rotation":
        q, r = np.linalg.qr(x)
        q = q * np.sign(np.diagonal(r, axis1=-2, axis2=-1))[..., None, :]
        q[..., 0] *= np.sign(np.linalg.det(q))[..., None]
        return q
    if domain == "rigid":
        x[..., :-1, :-1] = sample(rng, f"(..., {x.shape[-1] - 1}, {x.shape[-1] - 1})", "rotation")
        x[..., -1, :] = np.eye(x.shape[-1])[-1]
        return x
    if domain == "complex form":
        z, w = x[..., 0, :] @ [1, 1j], x[..., 1, :] @ [1, 1j]
        return np.stack([z, -w, w.conj(), z.conj()], axis=-1).reshape(x.shape)
    if domain == "unit dual quaternion":
        x /= np.linalg.norm(x[..., :4], axis=-1, keepdims=True)
        x[..., 4:] -= np.sum(x[..., :4] * x[..., 4:], axis=-1, keepdims=True) * x[..., :4]
        return x
    if domain == "unit dual complex number":
        return x / np.linalg.norm(x[..., :2], axis=-1, keepdims=True)
    if domain.startswith("unit "):
        return x / np.linalg.norm(x, axis=-1, keepdims=True)
    if domain == "skew":
        return x - np.swapaxes(x, -1, -2)
    if domain == "basis":  # of so(3)
        return sample(rng, "(..., 3, 3, 3)", "skew")
    if domain == "exponential":
        return np.eye(x.shape[-1]) + 0.5 * x / np.linalg.norm(x, axis=(-1, -2), keepdims=True)
    if domain in ("affine exponential", "infinitesimal affine"):
        x = sample(rng, kind, "exponential")
        x[..., -1, :] = np.eye(x.shape[-1])[-1]
        return x - np.eye(x.shape[-1]) if domain == "infinitesimal affine" else x
    if domain in ("affine", "affine multiple"):
        x[..., -1, :-1] = 0.0
        if domain == "affine":
            x[..., -1, -1] = 1.0
        return x
    if domain in ("GL+", "Aff+"):
        if domain == "Aff+":
            x[..., -1, :] = np.eye(x.shape[-1])[-1]
        x[..., 0] *= np.sign(np.linalg.det(x))[..., None]
        return x
    if domain in ("symmetric", "SPD"):
        return x + np.swapaxes(x, -1, -2) if domain == "symmetric" else x @ np.swapaxes(x, -1, -2)
    if domain == "positive":
        return np.abs(x) + 0.1
    assert domain in ("", "radians", "non-zero"), f"unknown domain {domain!r}"
    return x


def in_domain(value: np.ndarray, words: str) -> bool:
    domain = words.split(",")[0]
    n = value.shape[-1] if value.ndim else 0
    if domain == "rotation":
        gram = np.swapaxes(value, -1, -2) @ value
        return bool(np.allclose(gram, np.eye(n), atol=1e-14) and np.all(np.linalg.det(value) > 0))
    if domain == "rigid":
        last = np.array_equal(value[..., -1, :], np.broadcast_to(np.eye(n)[-1], value[..., -1, :].shape))
        return last and in_domain(value[..., :-1, :-1], "rotation")
    if domain == "unit dual quaternion":
        across = np.allclose(np.sum(value[..., :4] * value[..., 4:], axis=-1), 0.0, atol=1e-14)
        return across and in_domain(value[..., :4], "unit quaternion")
    if domain == "unit dual complex number":
        return in_domain(value[..., :2], "unit vector")
    if domain.startswith("unit "):
        return np.allclose(np.linalg.norm(value, axis=-1), 1.0, atol=1e-14)
    if domain == "skew":
        return np.array_equal(value, -np.swapaxes(value, -1, -2))
    if domain in ("symmetric", "SPD"):
        definite = domain == "symmetric" or bool(np.all(np.linalg.eigvalsh(value) > 0.0))
        return definite and np.array_equal(value, np.swapaxes(value, -1, -2))
    if domain in ("GL+", "Aff+"):
        last = value[..., -1, :]
        affine = domain == "GL+" or np.array_equal(last, np.broadcast_to(np.eye(n)[-1], last.shape))
        return affine and bool(np.all(np.linalg.det(value) > 0.0))
    if domain == "name":
        return bool(np.all(value != ""))
    return bool(np.all(np.isfinite(value)))


def arguments(f: Callable):
    """Yield argument lists, one for each choice of a word, with the flags of what has a batch."""
    rng = np.random.default_rng(7)
    module = inspect.getmodule(f)
    positional = [e for e in entries(f, "Parameters") if e[1] != "bool"]
    choice = next((kind.strip("{}") for _, kind, _ in positional if kind.startswith("{")), None)
    for word in getattr(module, choice) if choice else [None]:
        yield [word if kind.startswith("{") else sample(rng, kind, words) for _, kind, words in positional]


def outputs(result) -> tuple[np.ndarray, ...]:
    return result if isinstance(result, tuple) else (result,)


def test_every_module_is_seen():
    assert {"series", "so2", "so3", "quaternion", "euler"} <= set(MODULES)
    assert len(FUNCTIONS) >= 45


@pytest.mark.parametrize("f", FUNCTIONS)
def test_docstring_names_the_arguments_and_the_text(f):
    doc = inspect.getdoc(f)
    assert doc, "no docstring"
    first = doc.splitlines()[0]
    assert first.endswith(".") or first.endswith(":"), "one sentence first"
    assert re.search(r"^(Book|Kaji-Ochiai|MEIS): ", doc, flags=re.MULTILINE), "no equation number"
    assert [name for name, _, _ in entries(f, "Parameters")] == list(inspect.signature(f).parameters)
    assert entries(f, "Returns"), "no Returns"
    if "check" in inspect.signature(f).parameters:
        assert inspect.signature(f).parameters["check"].kind is inspect.Parameter.KEYWORD_ONLY
        assert "ValueError" in section(f, "Raises")


@pytest.mark.parametrize("f", FUNCTIONS)
def test_batch_has_the_claimed_shape_and_equals_single_calls(f):
    claims = entries(f, "Returns")
    for args in arguments(f):
        batch = outputs(f(*args))
        assert len(batch) == len(claims)
        for value, (_, kind, words) in zip(batch, claims, strict=True):
            assert value.shape == (*BATCH, *core(kind))
            assert in_domain(value, words)
        for index in np.ndindex(BATCH):
            single = outputs(f(*(a[index] if isinstance(a, np.ndarray) else a for a in args)))
            for one, many in zip(single, batch, strict=True):
                if many.dtype.kind == "U":
                    assert one == many[index]
                    continue
                np.testing.assert_allclose(one, many[index], rtol=4e-16, atol=4e-16)


@pytest.mark.parametrize("f", FUNCTIONS)
def test_empty_batch_and_broadcast(f):
    for args in arguments(f):
        empty = [a[:0] if isinstance(a, np.ndarray) else a for a in args]
        for value, (_, kind, _) in zip(outputs(f(*empty)), entries(f, "Returns"), strict=True):
            assert value.shape == (0, BATCH[1], *core(kind))
        arrays = [i for i, a in enumerate(args) if isinstance(a, np.ndarray)]
        for i in arrays if len(arrays) > 1 else []:
            one = list(args)
            one[i] = args[i][0, 0]
            repeated = list(args)
            repeated[i] = np.broadcast_to(one[i], args[i].shape).copy()
            for a, b in zip(outputs(f(*one)), outputs(f(*repeated)), strict=True):
                np.testing.assert_allclose(a, b, rtol=4e-16, atol=4e-16)


@pytest.mark.parametrize("f", FUNCTIONS)
def test_arguments_are_left_alone_and_results_own_their_memory(f):
    for args in arguments(f):
        before = [a.copy() if isinstance(a, np.ndarray) else a for a in args]
        for value in outputs(f(*args)):
            value = np.asarray(value)
            assert not any(np.shares_memory(value, a) for a in args if isinstance(a, np.ndarray))
        for a, b in zip(args, before, strict=True):
            assert np.array_equal(a, b)


CHECKED = [p for p in FUNCTIONS if "check" in inspect.signature(p.values[0]).parameters]


@pytest.mark.parametrize("f", CHECKED)
@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_not_a_number_is_refused_by_function_argument_and_index(f, bad):
    where = re.escape(f"{f.__module__.rsplit('.', 1)[1]}.{f.__name__}")
    part, name = where.split("\\.")
    where = "\\.".join([REACHED_AS.get(part, part), name])
    args = next(iter(arguments(f)))
    names = list(inspect.signature(f).parameters)
    for i, a in enumerate(args):
        if isinstance(a, np.ndarray):
            broken = list(args)
            broken[i] = a.copy()
            broken[i][1, 3] = bad
            if f.__name__ == "act" and i == 1:
                continue  # points pass through: nan in, nan out
            with pytest.raises(
                ValueError, match=rf"^{where}: {names[i]} must .* at index \(1, 3(, \d+)*\)\.[^\n]*$"
            ):
                f(*broken)


@pytest.mark.parametrize("f", FUNCTIONS)
def test_wrong_shape_is_refused(f):
    args = next(iter(arguments(f)))
    names = list(inspect.signature(f).parameters)
    for i, (_, kind, _) in enumerate(e for e in entries(f, "Parameters") if e[1] != "bool"):
        if isinstance(args[i], np.ndarray) and core(kind):
            broken = list(args)
            broken[i] = args[i][..., :-1] if kind not in ANY_LENGTH or len(args) > 1 else np.array(1.0)
            with pytest.raises(ValueError, match=rf": {names[i]} must be .* shape .*; got shape"):
                f(*broken)
            broken[i] = "abc"
            with pytest.raises(ValueError, match=rf": {names[i]} must be real numbers"):
                f(*broken)


@pytest.mark.parametrize("f", OF_MESHES)
def test_a_function_on_meshes_says_what_it_takes(f):
    doc = inspect.getdoc(f)
    assert doc, "no docstring"
    assert doc.splitlines()[0].endswith((".", ":")), "one sentence first"
    said = [name for line in section(f, "Parameters") for name in line.partition(" : ")[0].split(", ")]
    if said:
        assert said == list(inspect.signature(f).parameters)
