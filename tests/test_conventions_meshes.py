"""What functions on meshes and their deformers claim in their docstrings is true: shapes, bad input."""

import importlib
import inspect
import pkgutil
import re
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from types import FunctionType
from typing import Any

import numpy as np
import pytest

import lietool.deform
import lietool.mesh
from lietool.bench import bodies
from lietool.deform import (
    arap,
    cage,
    cage_frames,
    green,
    harmonic,
    image,
    local_maps,
    mean_value,
    move,
    poisson,
    pose,
    pose_keys,
    probe,
    shape_blend,
    stitch,
    ways,
    weights,
)
from lietool.lie import affine, so3
from lietool.mesh import geodesic, laplacian, surface

# They serve the others: what they take is checked already, or is rows, names and messages.
SUPPORT = re.compile(
    r"_(kernels|checks|view|values|motion|sums|text|svg)$|^(nested_hull|predicates|files|elimination)$"
)
# What they read are files: tests of their own give them good ones and bad ones.
FILES = re.compile(r"_io$|^(io|painted|handle_io)$")
# Of the plane, tried with chapter 6; and what needs no array.
ELSEWHERE = ("outline", "topology", "shapes", "solids", "particles", "cut")

# What they take has been checked by those that call them, and their arguments are arrays already.
TRUSTING = (
    "cage_frames.centres",
    "cage_weights.measures",
    "cage_weights.smooth",
    "green.stretched_normals",
    "local_maps.tangents",
    "move.about",
    "pose_keys.about",
    "shape_blend.homogeneous",
)
# They serve other functions with messages and checks.
HELPERS = re.compile(
    r"^laplacian\.(checked|cotangents|degenerate|listed|named|triangles)$|^mean_value\.current$"
)
# Infinite where no path leads, or where a face has collapsed.
INFINITE = ("weights.cutoff", "weights.gaussian", "weights.inverse_distance", "distortion.summarise")
INFINITE += ("cage_weights.inverse_cube",)

V, F = bodies.sphere(42)
U = bodies.twisted(V)
C, G = bodies.cage(V, 12)
RNG = np.random.default_rng(3)
ENDS = [np.array([0, 1]), np.array([40])]
W = weights.partition_of_unity(weights.inverse_distance(weights.distances(V, [[2.0, 0, 0], [0, 3.0, 0]])))
A = affine.phi_so(0.3 * RNG.normal(size=(2, 12)))
MANY = affine.phi_so(0.3 * RNG.normal(size=(2, 5, 12)))
REST = np.tile(np.eye(4), (2, 1, 1))
MAPS = local_maps.maps(local_maps.frames(V, F), U)
KEYS = pose_keys.principal(ways.PHI_SO, affine.phi_so(0.3 * RNG.normal(size=(6, 12))))
PICTURE, MASK = RNG.random((7, 8)), np.pad(np.ones((3, 4), bool), 2)

COMMON: dict[str, Any] = {
    "V": V,
    "F": F,
    "points": V,
    "rest": V,
    "deformed": U,
    "targets": [U, 1.1 * V],
    "sources": [0, 3],
    "handles": ENDS,
    "pins": ENDS[0],
    "pinned": ENDS[0],
    "vertices": U,
    "positions": None,
    "way": ways.PHI_SO,
    "distances": np.abs(RNG.normal(size=(42, 3))),
    "w": np.abs(RNG.normal(size=(42, 3))) + 0.1,
    "U": U,
    "reach": 1.5,
    "width": 0.7,
    "A": A,
    "origins": [[0.0, 0, 0], [0, 1.0, 0]],
    "weights": W,
    "turns": None,
    "policy": None,
    "origin": None,
    "keys": KEYS,
    "path": pose.b_spline(KEYS),
    "t": np.linspace(0.0, 1.0, 5),
    "centres": V[:3],
    "mesh": surface.Mesh(V, F),
    "name": "alexa",
    "count": 5,
    "steps": 4,
    "seed": 1,
}
OF: dict[str, dict[str, Any]] = {
    "adjacency.consistent": {
        "R": so3.exp(RNG.normal(size=(80, 3))),
        "pairs": np.array([[0, 1], [1, 2]]),
        "near": None,
    },
    "adjacency.turned": {"x": RNG.normal(size=(2, 5, 3)), "turns": np.ones((2, 5))},
    "arap": {"prepared": arap.prepare(V, F, ENDS[0])},
    "cage": {
        "V": C,
        "F": G,
        "prepared": cage.prepare(V, C, G),
        "poses": [C, bodies.twisted(C)],
        "weights": None,
    },
    "cage.moved": {"pose": cage.pose(cage.prepare(V, C, G), C)},
    "cage_frames": {
        "elements": cage_frames.faces(G),
        "V": C,
        "F": G,
        "at": cage_frames.rest(cage_frames.faces(G), C),
    },
    "cage_weights": {
        "elements": cage_frames.faces(G),
        "V": C,
        "distances": np.ones((4, 20)),
        "t": np.ones(4),
    },
    "controller": {
        "corners": np.array([[1.0, 0], [0, 1], [-1, 0], [0, -1]]),
        "position": 0.3 * RNG.normal(size=(2, 5, 2)),
        "rest": 0,
        "k": 5,
        "radius": 1.0,
    },
    "distortion": {"guide": MAPS},
    "distortion.summarise": {"values": np.arange(5.0), "weights": np.ones(5)},
    "geodesic": {"prepared": geodesic.prepare(V, F)},
    "geodesic.solve": {"sources": ENDS},
    "green": {"V": C, "F": G, "prepared": green.prepare(V, C, G), "rest": C, "now": bodies.twisted(C)},
    "harmonic": {"prepared": harmonic.prepare_harmonic(V, F, ENDS), "values": np.ones((3, 2))},
    "image": {
        "image": PICTURE,
        "across": np.diff(PICTURE, axis=1),
        "down": np.diff(PICTURE, axis=0),
        "mask": MASK[:7, :8],
        "prepared": image.prepare(MASK[:7, :8]),
        "target": PICTURE,
        "field": image.gradient(PICTURE),
        "one": image.gradient(PICTURE),
        "other": image.gradient(PICTURE**2),
    },
    "local_maps": {"at": local_maps.frames(V, F)},
    "mean_value": {"V": C, "F": G, "prepared": mean_value.prepare(V, C, G)},
    "move": {
        "prepared": move.prepare(V, [0.0, 0, 0], W),
        "pose": move.encode(ways.PHI_SO, A),
        "B": A,
        "vectors": None,
    },
    "move.about": {"A": MANY, "origins": RNG.normal(size=(2, 5, 3))},
    "orientation": {"A": MANY},
    "poisson": {
        "prepared": poisson.prepare(V, F, ENDS[0], [ENDS[1]], W[:, 1:]),
        "handles": [ENDS[1]],
        "weights": W[:, 1:],
        "A": A[:1],
        "guide": MAPS,
        "values": V[[0, 1, 40]],
    },
    "poisson.join": {"guide": MAPS, "values": V[np.concatenate(ENDS)]},
    "population": {"targets": 3},
    "pose.hermite": {"velocities": np.zeros((6, 12))},
    "pose_keys": {"times": None, "centre": np.zeros(3), "rest": MANY, "frames": MANY, "near": None},
    "pose_keys.about": {"A": MANY, "centre": np.ones(3)},
    "probe": {"rest": REST, "current": A, "prepared": probe.prepare(V, REST, W), "poses": np.stack([A, A])},
    "shape_blend": {
        "prepared": shape_blend.prepare(V, [U, 1.1 * V], F),
        "weights": np.array([0.3, 0.4]),
        "others": [F],
        "maps": None,
    },
    "shape_blend.homogeneous": {"A": RNG.normal(size=(2, 5, 3, 3))},
    "solve": {"L": laplacian.cotangent(V, F), "fixed": ENDS[0]},
    "stitch": {"prepared": stitch.prepare(V, F), "maps": MAPS, "A": shape_blend.homogeneous(MAPS)},
    "turns": {"x": np.eye(3), "turns": np.eye(3)},
    "ways": {
        "weights": RNG.random((2, 5, 3)),
        "A": affine.phi_so(0.3 * RNG.normal(size=(2, 5, 3, 12))),
        "params": 0.2 * RNG.normal(size=(2, 5, 3, 12)),
    },
    "weights": {"rotation": W, "translation": W, "stretch": 0.5 * W},
}


@cache
def functions() -> dict[str, FunctionType]:
    """All public functions by name, but those that serve or read files."""
    found = {}
    for package in (lietool.deform, lietool.mesh):
        for module in pkgutil.iter_modules(package.__path__):
            if module.name.startswith("_") or any(p.search(module.name) for p in (SUPPORT, FILES)):
                continue
            if package is lietool.mesh and module.name in ELSEWHERE:
                continue
            loaded = importlib.import_module(f"{package.__name__}.{module.name}")
            for name, f in inspect.getmembers(loaded, inspect.isfunction):
                if name.startswith("_") or f.__module__ != loaded.__name__:
                    continue
                if not HELPERS.match(f"{module.name}.{name}"):
                    found[f"{module.name}.{name}"] = f
    return found


EVERY = pytest.mark.parametrize("name", functions())
ENTRY = re.compile(r"^(?P<names>\w+(?:, \w+)*) : (?P<kind>.+)$")
SHAPE = re.compile(r"\((?P<dimensions>(?:\.\.\.|\w+| m)?(?:, ?[\w ]+)*,?)\)")


def section(f: Callable, title: str) -> list[str]:
    parts = re.split(r"^(\w+)\n-+\n", inspect.getdoc(f) or "", flags=re.MULTILINE)
    body = dict(zip(parts[1::2], parts[2::2], strict=True)).get(title, "")
    return [line for line in body.splitlines() if line and not line.startswith(" ")]


def claims(f: Callable, title: str) -> Iterator[tuple[str, str]]:
    """Yield names with what is said of them; "" for the names of results that are records."""
    for line in section(f, title):
        match = ENTRY.match(line)
        for name in match["names"].split(", ") if match else [""]:
            yield name, match["kind"] if match else line


def example(name: str, argument: str) -> Any:
    known = COMMON | OF.get(name.split(".")[0], {}) | OF.get(name, {})
    return known[argument]


def arguments(name: str) -> dict[str, Any]:
    """Return an example of every argument that must be given."""
    parameters = inspect.signature(functions()[name]).parameters.values()
    return {p.name: example(name, p.name) for p in parameters if p.default is p.empty}


def call(name: str, given: dict[str, Any]) -> Any:
    f = functions()[name]
    named = {p.name for p in inspect.signature(f).parameters.values() if p.kind is p.KEYWORD_ONLY}
    return f(*(v for k, v in given.items() if k not in named), **{k: given[k] for k in named & given.keys()})


def arrays(thing: Any) -> Iterator[np.ndarray]:
    """Yield all arrays in a result, in the order of their fields."""
    if isinstance(thing, np.ndarray | np.generic):
        yield np.asarray(thing)
    elif isinstance(thing, tuple | list):
        for part in thing:
            yield from arrays(part)
    elif is_dataclass(thing):
        for part in fields(thing):
            yield from arrays(getattr(thing, part.name))
    elif hasattr(thing, "toarray"):
        yield thing.toarray()


def same(one: Any, other: Any) -> bool:
    pairs = list(zip(arrays(one), arrays(other), strict=True))
    return all(a.shape == b.shape and np.array_equal(a, b, equal_nan=a.dtype.kind == "f") for a, b in pairs)


def floats(given: dict[str, Any]) -> list[str]:
    return [k for k, v in given.items() if isinstance(v, np.ndarray) and v.dtype.kind == "f"]


def fits(shape: tuple[int, ...], dimensions: list[str], letters: dict[str, int]) -> bool:
    """Whether an array has the claimed shape; letters mean the same number everywhere."""
    if dimensions[:1] == ["..."]:
        dimensions = dimensions[1:]
        shape = shape[len(shape) - len(dimensions) :]
    if len(shape) != len(dimensions):
        return False
    for size, word in zip(shape, dimensions, strict=True):
        factor, letter = re.fullmatch(r"(\d+)? ?([A-Za-z]\w*)?", word).groups()
        wanted = int(factor or 1) * (letters.setdefault(letter, size // int(factor or 1)) if letter else 1)
        if size != wanted:
            return False
    return True


def shaped(kind: str) -> list[str] | None:
    """Return the dimensions that are claimed, None where there are none or several."""
    found = SHAPE.findall(kind)
    return [word.strip() for word in found[0].split(",") if word.strip()] if len(found) == 1 else None


def test_every_module_is_seen():
    assert {"probe.solve", "cage.prepare", "poisson.solve", "geodesic.heat", "surface.health"} <= set(
        functions()
    )
    assert len(functions()) > 80


@EVERY
def test_it_names_its_arguments_and_what_it_returns(name):
    f = functions()[name]
    doc = inspect.getdoc(f) or ""
    assert doc.splitlines()[0].endswith((".", ":")), "one sentence first"
    said = [
        argument for line in section(f, "Parameters") for argument in line.partition(" : ")[0].split(", ")
    ]
    assert said == list(inspect.signature(f).parameters)
    assert section(f, "Returns") or f.__annotations__.get("return") is None


@EVERY
def test_what_comes_has_the_claimed_shape_and_the_arguments_are_left_alone(name):
    f, given = functions()[name], arguments(name)
    before = [a.copy() for a in arrays(list(given.values()))]
    result = call(name, given)
    assert all(np.array_equal(a, b) for a, b in zip(arrays(list(given.values())), before, strict=True))
    assert same(result, call(name, given)), "not the same again"
    letters: dict[str, int] = {}
    for argument, kind in claims(f, "Parameters"):
        dimensions = shaped(kind)
        if dimensions and isinstance(given.get(argument), np.ndarray):
            assert fits(given[argument].shape, dimensions, letters), f"{argument} : {kind}"
    found = list(claims(f, "Returns"))
    if not found:
        assert result is None
        return
    for value, (_, kind) in zip(result if len(found) > 1 else [result], found, strict=True):
        dimensions = shaped(kind)
        if dimensions:
            assert fits(np.shape(value), dimensions, letters), f"{kind}, got {np.shape(value)}, {letters}"
            assert not np.issubdtype(np.asarray(value).dtype, np.floating) or not np.isnan(value).any()
        elif re.fullmatch(r"[A-Z]\w+", kind):
            assert type(value).__name__ == kind


@EVERY
def test_lists_do_as_well_as_arrays(name):
    if name in TRUSTING:
        pytest.skip("takes arrays only")
    given = arguments(name)
    plain = {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in given.items()}
    assert same(call(name, plain), call(name, given))


@EVERY
@pytest.mark.parametrize("bad", [np.nan, np.inf, "shape", "words"])
def test_bad_input_is_refused_in_one_line(name, bad):
    given, kinds = arguments(name), dict(claims(functions()[name], "Parameters"))
    for argument in floats(given):
        if name in TRUSTING or (bad == np.inf and name in INFINITE):
            continue
        if bad == "shape" and shaped(kinds.get(argument, "")) == ["..."]:
            continue
        broken = given[argument].copy()
        if bad == "shape":
            broken = broken[..., None, None]
        elif bad == "words":
            broken = "abc"
        else:
            broken.flat[0] = bad
        with pytest.raises(ValueError, match=r"^\w+\.[\w.\[\]]+: [^\n]+ must be [^\n]+; got [^\n]*$") as told:
            call(name, given | {argument: broken})
        assert told.type is ValueError
        assert section(functions()[name], "Raises") == ["ValueError"]
