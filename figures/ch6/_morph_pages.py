"""What each stage of `global-interp` computes: the numbers, and the page that shows them."""

from dataclasses import replace

import numpy as np

from lietool.figure import Drawing
from lietool.mesh.shapes import Shape

from . import _morph, _morph_stages, _morph_strip

_NAMES = {
    "frobenius": "E^F",
    "point": "E^P",
    "similarity": "E^R",
    "point-similarity": "E^S",
    "symmetric": "E^F",
}


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
    said = f"corners that should meet are up to {gap:.2g} edges from their middle"
    picture = _morph_stages.torn(pair, corners, place, t, said)
    return Drawing(picture, {"corners": corners, "maps": at, "largest_gap": gap})


def whole(pair: Shape, choice: _morph.Choice, t: float) -> Drawing:
    """Return the whole shape at time t."""
    way = _morph.way(pair, choice)
    found = way.at(np.array([t]))
    place = _morph_stages.stage(
        pair, np.concatenate([_extents(pair, choice), way.measured.vertices.reshape(-1, 2)])
    )
    least, count = float(found.det.min()), int(found.flipped.sum())
    said = rf"{count} of {len(pair.faces)} flipped, least $\det B_i = {least:.2f}$"
    picture = _morph_stages.stitched(pair, found.vertices[0], found.flipped[0], place, t, said)
    return Drawing(picture, {"vertices": found.vertices[0], "det": found.det[0], **way.numbers})


def _extents(pair: Shape, choice: _morph.Choice) -> np.ndarray:
    """All that the torn triangles reach at some times; shape (k, 2)."""
    moments = np.linspace(0.0, 1.0, 9)
    return np.concatenate([_morph.apart(pair, choice, float(t))[0].reshape(-1, 2) for t in moments])


def frames(pair: Shape, choice: _morph.Choice, beside: str, steps: int, t: float) -> Drawing:
    """Return a strip of frames, or two of them."""
    choices = [choice]
    if beside != "none":
        choices.append(replace(choice, energy=beside, angles="consistent"))
    times = np.concatenate([np.linspace(0.0, t, steps + 1), np.linspace(t, 1.0, steps + 1)[1:]])
    both = choice.energy == "symmetric"
    strips = []
    for asked in choices:
        way = _morph.way(pair, asked)
        strips.append(_morph_strip.Strip(_name(asked), way, way.at(times), both))
    numbers: dict[str, object] = {"times": times}
    for k, strip in enumerate(strips):
        suffix = "" if k == 0 else "_beside"
        shown = {
            "vertices": strip.frames.vertices,
            "flipped_in_frames": strip.frames.flipped.sum(axis=1),
            **strip.way.numbers,
        }
        if both:
            shown |= {"back": strip.way.back(times), "asymmetry": strip.way.asymmetry}
        numbers |= {name + suffix: value for name, value in shown.items()}
    return Drawing(_morph_strip.picture(strips, t), numbers)


def _name(choice: _morph.Choice) -> str:
    """A row's title: the energy, and the input that matters."""
    name = (
        rf"{choice.w:g} E^F + {1.0 - choice.w:g} E^R"
        if choice.energy == "balanced"
        else _NAMES[choice.energy]
    )
    name = f"symmetrised ${name}$" if choice.energy == "symmetric" else f"${name}$"
    if choice.constraint == "loci":
        return f"{name}, nose and tail on given curves"
    if choice.constraint == "held":
        return f"{name}, barycentre on a curve, an edge held"
    taken = (
        r"angles in $(-180^{\circ}, 180^{\circ}]$" if choice.angles == "principal" else "consistent angles"
    )
    held = ", an edge held" if choice.forgives else ""
    return f"{name}, {taken}{held}"
