"""What each stage of `global-interp` computes: the numbers, and the page that shows them."""

from dataclasses import replace

import numpy as np

from lietool.figure import Drawing
from lietool.interp import shape
from lietool.mesh import surface
from lietool.mesh.shapes import Shape
from lietool.render.scene import Picture

from . import _morph, _morph_stages, _morph_strip

_NAMES = {
    "frobenius": "E^F",
    "point": "E^P",
    "similarity": "E^R",
    "point-similarity": "E^S",
    "symmetric": "E^F",
}

# Of E^F, beside E^R, where only the direction of an edge is given: so much keeps the size of the whole.
_SHARE = 0.1


def ends(pair: Shape, t: float) -> Drawing:
    """Return both shapes, with the same band of triangles marked."""
    numbers = {
        "source": pair.source,
        "target": pair.target,
        "faces": pair.faces,
        "along": pair.along,
        "band": _morph_stages.band(pair, t),
    }
    return Drawing(_morph_stages.ends(pair, t), numbers)


def maps(pair: Shape, choice: _morph.Choice, t: float) -> Drawing:
    """Return some triangles and their maps."""
    # A map alone turns by less than half a turn; what its neighbours do is not asked here.
    choice = replace(choice, angles="principal", turns=0)
    at = _morph.apart(pair, choice, t)[1]
    chosen = _morph_stages.shown_maps(pair)
    numbers = {
        "maps": _morph.apart(pair, choice, 1.0)[1][chosen],
        "maps_at_t": at[chosen],
        "source": pair.source[pair.faces[chosen]],
        "target": pair.target[pair.faces[chosen]],
    }
    return Drawing(_morph_stages.maps(pair, at, t), numbers)


def local(pair: Shape, choice: _morph.Choice, t: float) -> Drawing:
    """Return all triangles at time t, each by its own map."""
    corners, at = _morph.apart(pair, choice, t)
    place = _morph_stages.stage(pair, _extents(pair, choice))
    gap = _morph_stages.gaps(pair, corners).max() / _morph_stages.side(pair)
    said = f"corners that should meet lie up to {gap:.2g} edge lengths from their mean"
    picture = _morph_stages.torn(pair, corners, place, t, said)
    numbers = {"corners": corners, "maps": at, "largest_gap": gap}
    apart = np.arange(corners.size // 2).reshape(-1, 3)
    return Drawing(picture, numbers, _mesh(corners.reshape(-1, 2), apart))


def whole(pair: Shape, choice: _morph.Choice, t: float) -> Drawing:
    """Return the whole shape at time t."""
    way = _morph.way(pair, choice)
    found = way.at(np.array([t]))
    place = _morph_stages.stage(
        pair, np.concatenate([_extents(pair, choice), way.measured.vertices.reshape(-1, 2)])
    )
    least, count = float(found.det.min()), int(found.flipped.sum())
    said = rf"{count} of {len(pair.faces)} flipped, least $\det B_i = {least:.2f}$"
    shown = _morph_strip.held(place, way, found.vertices[0], t, curves=True)
    picture = _morph_stages.stitched(pair, found.vertices[0], found.flipped[0], place, t, said, shown)
    return _moment(picture, way, found)


def alone(pair: Shape, choice: _morph.Choice, t: float) -> Drawing:
    """Return nothing but the whole shape at time t, where it is at rest while others pass."""
    way = _morph.way(pair, choice)
    found = way.at(np.array([t]))
    place = _morph_stages.page(way.measured.vertices)
    shown = _morph_strip.held(place, way, found.vertices[0], t, curves=True)
    picture = _morph_stages.alone(pair, found.vertices[0], found.flipped[0], place, t, shown)
    return _moment(picture, way, found)


def _moment(picture: Picture, way: _morph.Way, found: shape.Result) -> Drawing:
    numbers = {"vertices": found.vertices[0], "det": found.det[0], **way.numbers}
    return Drawing(picture, numbers, _mesh(found.vertices[0], way.pair.faces))


def _mesh(V: np.ndarray, faces: np.ndarray) -> surface.Mesh:
    """A flat mesh in space."""
    return surface.Mesh(np.pad(V, ((0, 0), (0, 1))), faces)


def _extents(pair: Shape, choice: _morph.Choice) -> np.ndarray:
    """All that the torn triangles reach at some times; shape (k, 2)."""
    moments = np.linspace(0.0, 1.0, 9)
    return np.concatenate([_morph.apart(pair, choice, float(t))[0].reshape(-1, 2) for t in moments])


def frames(pair: Shape, choice: _morph.Choice, beside: str, steps: int, t: float) -> Drawing:
    """Return a strip of frames, or two of them."""
    before, after = _rows(choice, beside)
    choices = [*before, choice, *after]
    times = np.concatenate([np.linspace(0.0, t, steps + 1), np.linspace(t, 1.0, steps + 1)[1:]])
    both = choice.energy == "symmetric"
    strips = []
    for asked in choices:
        way = _morph.way(pair, asked)
        strips.append(_morph_strip.Strip(_name(asked), way, way.at(times), both))
    numbers: dict[str, object] = {"times": times}
    suffixes = [*["_above"] * len(before), "", *["_beside"] * len(after)]
    for suffix, strip in zip(suffixes, strips, strict=True):
        shown = {
            "vertices": strip.frames.vertices,
            "flipped_in_frames": strip.frames.flipped.sum(axis=1),
            **strip.way.numbers,
        }
        if both:
            shown |= {"back": strip.way.back(times), "asymmetry": strip.way.asymmetry}
        numbers |= {name + suffix: value for name, value in shown.items()}
    # The middle one of the row that was asked for is that of the moment t.
    V = strips[len(before)].frames.vertices[steps]
    return Drawing(_morph_strip.picture(strips, t), numbers, _mesh(V, pair.faces))


def _rows(choice: _morph.Choice, beside: str) -> tuple[list[_morph.Choice], list[_morph.Choice]]:
    """What stands above and below the row that was asked for."""
    consistent = replace(choice, energy="frobenius", angles="consistent")
    match beside:
        case "none":
            return [], []
        case "direction":
            return [], [replace(consistent, energy="balanced", w=_SHARE, constraint="direction")]
        case "both-angles":
            return [replace(choice, energy="frobenius")], [consistent]
    return [], [replace(consistent, energy=beside)]


def _name(choice: _morph.Choice) -> tuple[str, ...]:
    """A row's title, in phrases: the energy, and the input that matters."""
    name = (
        rf"{choice.w:g}\, E^F + {1.0 - choice.w:g}\, E^R"
        if choice.energy == "balanced"
        else _NAMES[choice.energy]
    )
    name = f"symmetrised ${name}$" if choice.energy == "symmetric" else f"${name}$"
    if choice.constraint == "loci":
        return name, "nose and tail on given curves"
    if choice.constraint == "held":
        return name, "barycentre on a curve", "an edge held"
    if choice.constraint == "direction":
        return name, "barycentre on a curve", "the direction of an edge"
    taken = (
        r"angles in $(-180^{\circ}, 180^{\circ}]$" if choice.angles == "principal" else "consistent angles"
    )
    return (name, taken, "an edge held") if choice.forgives else (name, taken)
