"""What each stage of `global-interp` computes: the numbers, and the page that shows them."""

from dataclasses import replace
from fractions import Fraction

import numpy as np

from lietool.figure import Drawing
from lietool.interp import shape
from lietool.mesh import surface
from lietool.mesh.shapes import Shape
from lietool.render import style
from lietool.render.plane import Plane
from lietool.render.scene import Picture, Record

from . import _morph, _morph_compare, _morph_maps, _morph_row, _morph_stages, _morph_strip
from ._morph_form import Forms

# Of E^F, beside E^R, where only the direction of an edge is given: so much keeps the size of the whole.
_SHARE = 0.1


def ends(pair: Shape, t: float) -> Drawing:
    """Return both shapes, with the same band of triangles marked."""
    numbers = {
        "source": pair.source,
        "target": pair.target,
        "faces": pair.faces,
        "along": pair.along,
        "numbered": _morph_stages.tips(pair),
        "band": _morph_stages.band(pair, t),
    }
    return Drawing(_morph_stages.ends(pair, t), numbers)


def maps(pair: Shape, choice: _morph.Choice, t: float) -> Drawing:
    """Return some triangles and their maps."""
    # A map alone turns by less than half a turn; what its neighbours do is not asked here.
    choice = replace(choice, angles="principal", turns=0)
    at = _morph.apart(pair, choice, t)[1]
    chosen = _morph_maps.chosen(pair)
    numbers = {
        "maps": _morph.apart(pair, choice, 1.0)[1][chosen],
        "maps_at_t": at[chosen],
        "source": pair.source[pair.faces[chosen]],
        "target": pair.target[pair.faces[chosen]],
    }
    return Drawing(_morph_maps.picture(pair, at, t), numbers)


def local(pair: Shape, choice: _morph.Choice, t: float) -> Drawing:
    """Return all triangles at time t, each by its own map."""
    corners, at = _morph.apart(pair, choice, t)
    extents = _extents(pair, choice)
    places = _morph_stages.stage(pair, extents)
    gap = _morph_stages.gaps(pair, corners).max() / _morph_stages.side(pair)
    half = _morph.apart(pair, choice, 0.5)[0]
    picture = _morph_stages.torn(pair, corners, places, t, gap, half, extents)
    numbers = {"corners": corners, "maps": at, "largest_gap": gap}
    apart = np.arange(corners.size // 2).reshape(-1, 3)
    return Drawing(picture, numbers, _mesh(corners.reshape(-1, 2), apart))


def whole(pair: Shape, choice: _morph.Choice, forms: Forms, t: float) -> Drawing:
    """Return the whole shape at time t."""
    way = _morph.way(pair, choice, forms)
    found = way.at(np.array([t]))
    reached = np.concatenate([_extents(pair, choice), way.measured.vertices.reshape(-1, 2)])
    places = _morph_stages.stage(pair, reached)
    least, count = float(found.det.min()), int(found.flipped.sum())
    said = rf"{count} of {len(pair.faces)} flipped, least $\det B_i = {least:.2f}$"
    shown = _led(places.between, way, found)
    picture = _morph_stages.stitched(pair, found.vertices[0], found.flipped[0], places, t, said, shown)
    return _moment(picture, way, found)


def alone(pair: Shape, choice: _morph.Choice, forms: Forms, t: float) -> Drawing:
    """Return nothing but the whole shape at time t, where it is at rest while others pass."""
    way = _morph.way(pair, choice, forms)
    found = way.at(np.array([t]))
    place = _morph_stages.page(way.measured.vertices)
    shown = _led(place, way, found)
    picture = _morph_stages.alone(pair, found.vertices[0], found.flipped[0], place, t, shown)
    return _moment(picture, way, found)


def beside(pair: Shape, choice: _morph.Choice, forms: Forms, other: str, t: float) -> Drawing:
    """Return two ways at time t, and where each of them has its errors, or how far the way back is off."""
    both = "symmetric" in (choice.energy, other)
    strips = []
    for asked in (choice, _rows(choice, other)[1][0]):
        way = _morph.way(pair, asked, forms)
        strips.append(_morph_row.Strip(_name(asked), way, way.at(np.array([t])), both))
    numbers: dict[str, object] = {}
    for suffix, strip in zip(("", "_beside"), strips, strict=True):
        shown = {
            "vertices": strip.frames.vertices[0],
            "det": strip.frames.det[0],
            "error": _morph_compare.errors(strip),
            **strip.way.numbers,
        }
        if both:
            shown |= {"back": strip.way.back(np.array([t]))[0], "asymmetry": strip.way.asymmetry}
        numbers |= {name + suffix: value for name, value in shown.items()}
    return Drawing(
        _morph_compare.picture(strips, t), numbers, _mesh(strips[0].frames.vertices[0], pair.faces)
    )


def _led(place: Plane, way: _morph.Way, found: shape.Result) -> list[Record]:
    """What leads the shape: its curves as far as it has come, and what is held."""
    t, V = float(found.t[0]), found.vertices[0]
    records = _morph_row.loci(place, way, t)
    if way.led.barycentre is not None:
        fine = np.asarray(way.led.barycentre(np.linspace(0.0, 1.0, 4 * _morph.MOMENTS)))
        records.append(place.line(fine, style.ROUTE_1, style.THIN, dash=(9.0, 7.0)))
    return [*records, *_morph_row.held(place, way, V, t)]


def _moment(picture: Picture, way: _morph.Way, found: shape.Result) -> Drawing:
    numbers = {"vertices": found.vertices[0], "det": found.det[0], **way.numbers}
    return Drawing(picture, numbers, _mesh(found.vertices[0], way.pair.faces))


def _mesh(V: np.ndarray, faces: np.ndarray) -> surface.Mesh:
    """A flat mesh in space."""
    return surface.Mesh(np.pad(V, ((0, 0), (0, 1))), faces)


def _extents(pair: Shape, choice: _morph.Choice) -> np.ndarray:
    """All that triangles reach at some times, torn apart or stitched together; shape (k, 2).

    What energy and constraints do has no part in it: torn apart and stitched, shapes have the same scale.
    """
    plain = replace(choice, energy="frobenius", constraint="line", weights="area")
    torn = [_morph.apart(pair, choice, float(t))[0].reshape(-1, 2) for t in np.linspace(0.0, 1.0, 9)]
    return np.concatenate([*torn, _morph.way(pair, plain).measured.vertices.reshape(-1, 2)])


def frames(pair: Shape, choice: _morph.Choice, forms: Forms, beside: str, steps: int, t: float) -> Drawing:
    """Return a strip of frames, or two of them."""
    before, after = _rows(choice, beside)
    choices = [*before, choice, *after]
    times = _morph_row.times(t, steps)
    both = "symmetric" in (choice.energy, beside)
    strips = []
    for asked in choices:
        way = _morph.way(pair, asked, forms)
        strips.append(_morph_row.Strip(_name(asked), way, way.at(times), both))
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
    unseen = _unseen(pair, choice, forms) if len(strips) == 1 else None
    if unseen is not None:
        numbers |= {f"{name}_unseen": value for name, value in unseen.numbers.items()}
    return Drawing(_morph_strip.picture(strips, t, unseen), numbers, _mesh(V, pair.faces))


def _unseen(pair: Shape, choice: _morph.Choice, forms: Forms) -> _morph.Way | None:
    """Where vertices are led on curves, what the other energy makes of it: E^R, or E^F beside the others."""
    if choice.constraint != "loci":
        return None
    energy = "similarity" if choice.energy == "frobenius" else "frobenius"
    return _morph.way(pair, replace(choice, energy=energy), forms)


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
    name = _balance(choice.w) if choice.energy == "balanced" else _morph.NAMES[choice.energy]
    if choice.constraint == "loci":
        return name, "nose (solid) and tail (dashed) on curves"
    if choice.constraint == "held":
        return name, "barycentre (dot) on a curve, an edge (arrow) held"
    if choice.constraint == "direction":
        return name, "barycentre (dot) on a curve, direction of an edge"
    taken = (
        r"angles in $(-180^{\circ}, 180^{\circ}]$" if choice.angles == "principal" else "consistent angles"
    )
    return (name, taken, "an edge held") if choice.forgives else (name, taken)


def _balance(w: float) -> str:
    """w E^F + (1 - w) E^R, as fractions where they are simple."""
    shares = []
    for share in (w, 1.0 - w):
        simple = Fraction(share).limit_denominator(4)
        shares.append(
            rf"\frac{{{simple.numerator}}}{{{simple.denominator}}}"
            if 0.0 < share < 1.0 and abs(float(simple) - share) < 1e-9
            else f"{share:g}"
        )
    return rf"${shares[0]}\, E^F + {shares[1]}\, E^R$"
