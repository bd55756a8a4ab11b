"""A user's own mesh with its pins and handles, from files."""

from pathlib import Path

import numpy as np

from lietool.deform import handle_io, painted
from lietool.mesh import surface, surface_io

from ._poisson_case import Case, Motions
from ._probe_look import Look
from ._probe_look import own as coloured
from ._probe_own import within

# The frames of handles, over half the diagonal of the mesh's box.
_FRAME = 0.28


def case(mesh: Path | None, handles: Path | None, paint: Path | None) -> Case | None:
    """Return the case of a user's files; None where there are none."""
    if mesh is None and handles is None and paint is None:
        return None
    if mesh is None or handles is None:
        lacking = [name for name, file in (("mesh", mesh), ("handles", handles)) if file is None]
        raise ValueError(
            f"mesh and handles must be given together; got no {' and no '.join(lacking)}. "
            "Name the other file too"
        )
    shape = surface_io.read(mesh)
    found = handle_io.read(handles, shape)
    state = surface.health(shape.vertices, shape.faces)
    notes, pins = [], found.pins
    held = np.concatenate([pins, *found.vertices])
    loose = np.setdiff1d(state.unused, held)
    if len(loose):
        # No equation says where they are to go.
        pins = np.concatenate([pins, loose])
        many = f"{len(loose)} vertices that no face uses stay where they are"
        notes.append(many if len(loose) > 1 else "1 vertex that no face uses stays where it is")
    if len(state.flat):
        raise ValueError(
            f"mesh {mesh} must have an area in every face; got none in face {state.flat[0]}"
            f"{f' and {len(state.flat) - 1} more' if len(state.flat) > 1 else ''}. Remove them"
        )
    rest = np.tile(np.eye(4), (len(found.names), 1, 1))
    rest[:, :3, 3] = found.centres
    within(shape.vertices, "handle", found.names, rest, (found.A @ rest)[None])
    motions = Motions.of(found.centres, found.A, found.turns)
    size = 0.5 * float(np.linalg.norm(np.ptp(shape.vertices, axis=0)))
    before, after = coloured(shape)
    look = Look((1.0, 0.5, 0.35), _FRAME * size, (before,), (after,))
    weights = None
    if paint is not None:
        weights = painted.read(paint, len(shape.vertices))
        if weights.shape[1] != len(found.names):
            raise ValueError(
                f"paint must be weights of {len(found.names)} handle{'s' * (len(found.names) > 1)}, "
                f"{', '.join(found.names)}; "
                f"got {weights.shape[1]} in {paint}. Add or leave out columns"
            )
    return Case("own", shape, look, pins, found.names, found.vertices, motions, weights, tuple(notes))
