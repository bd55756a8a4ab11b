r"""An image from its gradient.

An image is to be changed inside a mask and to stay as it is outside. Inside, not its values are given but a
field $g'$, what its gradient is to be: of another image, which is pasted so without a seam. Wanted is the
image $I'$ whose gradient comes nearest to that,
$$\int_\Omega \|\nabla I' - g'\|^2 \,dx\,dy \to \min, \quad (7.10)$$
which is so where Poisson's equation holds,
$$\Delta I' = \mathrm{div}\, g'. \quad (7.11)$$

**On pixels.** The gradient of an image `I` of h rows and w columns is the differences of neighbours: `across`
has those of each pixel and the one to its right, $I_{r,c+1} - I_{r,c}$, and so h rows of w - 1; `down` those
of each pixel and the one below, $I_{r+1,c} - I_{r,c}$, and so h - 1 rows of w. A field has the same shapes.
(7.10) is the sum over those pairs of neighbours of which at least one is inside the mask. Setting its
derivative by the value of a pixel $p$ inside to 0 gives one equation for each,
$$\sum_{q \text{ next to } p} (I'_q - I'_p) = (\mathrm{div}\, g')_p ,$$
over the 4 neighbours $q$ of $p$, of which there are 3 or 2 where $p$ is at the border of the image. The
divergence at $p$ is what flows out of $p$: the sum over the same neighbours of what the field wants for
$I'_q - I'_p$. For the neighbours above and to the left that is minus the number in the field.
Where $q$ is outside of the mask its value is known and goes to the right side.

Images are gray, (h, w), or have c channels, (h, w, c), each of which is solved for by itself. Results are
left as they come, also beyond the values that an image can show.

Write two functions. The image of the picture has 405 x 540 pixels, some 30 000 of them inside: `scipy.sparse`
and `scipy.sparse.linalg` may be imported.
"""

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from lietool.exercise import Case, Check, Claim, Exercise, Function, Mistake, Picture


def divergence(across, down):
    """Return the divergence of a field of differences.

    Parameters
    ----------
    across : ndarray, shape (h, w - 1) or (h, w - 1, c)
        What the pixel to the right is to have more than each pixel.
    down : ndarray, shape (h - 1, w) or (h - 1, w, c)
        What the pixel below is to have more.

    Returns
    -------
    ndarray, shape (h, w) or (h, w, c)
        What flows out of each pixel; nothing flows across the border of the image.
    """
    rest = [(0, 0)] * (across.ndim - 2)
    x = np.pad(across, [(0, 0), (1, 1), *rest])
    y = np.pad(down, [(1, 1), (0, 0), *rest])
    return np.diff(x, axis=1) + np.diff(y, axis=0)


def edit(target, mask, across, down):
    """Return the image that is the target outside of a mask and whose gradient is nearest to a field inside.

    Parameters
    ----------
    target : ndarray, shape (h, w) or (h, w, c)
        The image.
    mask : ndarray of bool, shape (h, w)
        True where it is to change: some pixels, in one or several parts, and not all.
    across : ndarray, shape (h, w - 1) or (h, w - 1, c)
        The field, as for `divergence`.
    down : ndarray, shape (h - 1, w) or (h - 1, w, c)
        The field, as for `divergence`.

    Returns
    -------
    ndarray, of the target's shape
        The image edited; outside of the mask exactly as it was.
    """
    h, w = mask.shape
    number = np.arange(h * w).reshape(h, w)
    # Both ends of every pair of neighbours, and both ways round.
    i = np.concatenate([number[:, :-1].ravel(), number[:-1].ravel()])
    j = np.concatenate([number[:, 1:].ravel(), number[1:].ravel()])
    i, j = np.concatenate([i, j]), np.concatenate([j, i])
    inside = mask.ravel()
    kept = inside[i]
    i, j, one = i[kept], j[kept], np.ones(kept.sum())
    # minus the Laplacian, a row for each pixel, empty outside
    A = csc_array(
        (np.concatenate([one, -one]), (np.concatenate([i, i]), np.concatenate([i, j]))), (h * w,) * 2
    )
    image = np.array(target, float).reshape(h * w, -1)
    b = -divergence(across, down).reshape(h * w, -1)
    rows = A.tocsr()[inside]
    right = b[inside] - rows[:, ~inside] @ image[~inside]
    image[inside] = splu(rows[:, inside].tocsc(), permc_spec="MMD_AT_PLUS_A").solve(right)
    return image.reshape(target.shape)


def _gradient(image):
    return np.diff(image, axis=1), np.diff(image, axis=0)


def _blob(h, w):
    """A mask that is nowhere at the border."""
    r, c = np.indices((h, w))
    mask = (r - 0.45 * h) ** 2 + 0.7 * (c - 0.5 * w) ** 2 < (0.3 * h) ** 2
    mask[2, w - 3] = True
    return mask


def _random(rng, h, w, *channels):
    """A target, and a field that is no gradient."""
    return (
        rng.uniform(0.0, 255.0, (h, w, *channels)),
        20.0 * rng.normal(size=(h, w - 1, *channels)),
        20.0 * rng.normal(size=(h - 1, w, *channels)),
    )


def _fields(rng):
    r, c = np.indices((3, 4)).astype(float)
    yield Case("the gradient of a bowl", _gradient(r**2 + c**2), "divergence")
    yield Case("a field to the right", (np.ones((3, 3)), np.zeros((2, 4))), "divergence")
    yield Case("a field downwards", (np.zeros((3, 3)), np.ones((2, 4))), "divergence")
    yield Case("a random field", _random(rng, 5, 7)[1:], "divergence")


def _single(rng):
    target, mask = np.zeros((3, 3)), np.zeros((3, 3), bool)
    mask[1, 1] = True
    target[0, 1], target[1, 0], target[1, 2], target[2, 1] = 1.0, 2.0, 3.0, 6.0
    flat = np.zeros((3, 2)), np.zeros((2, 3))
    yield Case("one pixel, the field 0: the mean of its neighbours", (target, mask, *flat), "edit")
    uneven = np.array([[0.0, 0.0], [1.0, 5.0], [0.0, 0.0]]), np.array([[0.0, 2.0, 0.0], [0.0, -9.0, 0.0]])
    yield Case("one pixel, a field that flows out and in", (target, mask, *uneven), "edit")


def _gray(rng):
    mask = _blob(12, 15)
    target, _, _ = _random(rng, 12, 15)
    source = rng.uniform(0.0, 255.0, (12, 15))
    yield Case("another image's gradient", (target, mask, *_gradient(source)), "edit")
    yield Case("a random field", (target, mask, *_random(rng, 12, 15)[1:]), "edit")


def _colour(rng):
    target, across, down = _random(rng, 10, 12, 3)
    yield Case("three channels", (target, _blob(10, 12), across, down), "edit")
    yield Case("three channels of a field", (across, down), "divergence")


def _laws(f, rng):
    mask, (target, across, down) = _blob(11, 13), _random(rng, 11, 13)
    source = rng.uniform(0.0, 255.0, (11, 13))
    yield Claim("its own gradient: nothing changes", f.edit(target, mask, *_gradient(target)), target)
    brighter = np.where(mask, 0.0, source + 40.0)
    moved = f.edit(brighter, mask, *_gradient(source))
    yield Claim("the gradient of an image that is 40 darker outside: it, 40 brighter", moved, source + 40.0)
    made = f.edit(target, mask, across, down)
    yield Claim("outside nothing changes", made[~mask], target[~mask], tolerance=0.0)
    left, right = (f.divergence(*field) for field in (_gradient(made), (across, down)))
    yield Claim("the equation (7.11) holds inside", left[mask], right[mask], tolerance=1e-9)


def _hard(f, rng):
    """Told as laws, lest they hide which mistake it is."""
    solved = EXERCISE.function("edit").wanted
    target, across, down = _random(rng, 8, 9)
    mask = np.zeros((8, 9), bool)
    mask[:, :4] = True
    says = "a mask that covers the left side, up to the border"
    yield Claim(says, f.edit(target, mask, across, down), solved(target, mask, across, down))
    mask = ~np.eye(8, 9, dtype=bool)
    says = "all but the pixels of a diagonal: two parts, at the corners too"
    yield Claim(says, f.edit(target, mask, across, down), solved(target, mask, across, down))
    says = "a strong field: values below 0 and above 255 are left"
    strong = 30.0 * across, 30.0 * down
    yield Claim(says, f.edit(target, mask, *strong), solved(target, mask, *strong))


def _shown(f):
    """The student's function as the figure calls that of the library."""

    def solve(prepared, target, field):
        from lietool.deform import image

        made = np.asarray(f.edit(target, prepared.mask, *field), float)
        return image.Result(prepared, field, made)

    return {"solve": solve}


def _reference(solve, target, mask, across, down):
    from lietool.deform import image

    return solve(image.prepare(mask), target, (across, down)).image


def _with_field(x, y):
    """The edit with the parts of the field times numbers."""
    return lambda target, mask, across, down: edit(target, mask, x * across, y * down)


def _dark(target, mask, across, down):
    """The known neighbours left out of the right side."""
    return _pasted(target, mask, edit(0.0 * target, mask, across, down))


def _pasted(target, mask, made):
    return np.where(mask.reshape(*mask.shape, *[1] * (target.ndim - 2)), made, target)


def _one_sided(across, down):
    """What flows out to the right and down."""
    rest = [(0, 0)] * (across.ndim - 2)
    return np.pad(across, [(0, 0), (0, 1), *rest]) + np.pad(down, [(0, 1), (0, 0), *rest])


def _flipped(across, down):
    """The same to the left and up, with the wrong sign."""
    return _one_sided(across[::-1, ::-1], down[::-1, ::-1])[::-1, ::-1]


def _around(across, down):
    """A divergence that wraps around: in each row what the last pixel lets out comes into the first."""
    x = np.concatenate([across, across[:, :1]], axis=1)
    y = np.concatenate([down, down[:1]], axis=0)
    return x - np.roll(x, 1, axis=1) + y - np.roll(y, 1, axis=0)


EXERCISE = Exercise(
    number=20,
    title="An image from its gradient",
    equations=("7.10", "7.11"),
    functions=(
        Function(
            "divergence",
            library="lietool.deform.image.divergence",
            starter="return np.full((across.shape[0], *down.shape[1:]), np.nan)",
        ),
        Function(
            "edit",
            library="lietool.deform.image.solve",
            call=_reference,
            starter="return np.full(target.shape, np.nan)",
            tolerance=1e-8,
        ),
    ),
    checks=(
        Check("the divergence", 1, cases=_fields),
        Check("one pixel", 1, cases=_single),
        Check("gray images", 2, cases=_gray),
        Check("colours", 1, cases=_colour),
        Check("laws", 2, law=_laws),
        Check("hard inputs: at the border", 1, law=_hard),
    ),
    picture=Picture("G7.10", 2, _shown),
    allowed=("scipy.sparse", "scipy.sparse.linalg"),
    mistakes=(
        Mistake(
            "minus the divergence",
            "This is what flows into a pixel, minus the divergence: the field counts plus to the right and "
            "down, minus to the left and up.",
            {"divergence": lambda across, down: -divergence(across, down)},
        ),
        Mistake(
            "rows the wrong way",
            "Downwards the field is taken the wrong way round: it counts plus for the pixel below, and rows "
            "are counted downwards.",
            {"divergence": lambda across, down: divergence(across, -down)},
        ),
        Mistake(
            "everything flows out",
            "All four numbers are added: of the pairs with the pixel above and the one to the left the field "
            "counts minus.",
            {"divergence": lambda across, down: _one_sided(across, down) + _flipped(across, down)},
        ),
        Mistake(
            "only what flows out to the right and down",
            "Only the pixels to the right and below count here: those to the left and above are neighbours "
            "too.",
            {"divergence": _one_sided},
        ),
        Mistake(
            "around the border",
            "The differences go around from one border of the image to the other: nothing flows across it.",
            {"divergence": _around},
        ),
        Mistake(
            "sign of the field",
            "The pasted image comes out as its negative: with the number of neighbours plus on the diagonal, "
            "the matrix is minus the Laplacian, and the right side -div g'.",
            {"edit": _with_field(-1.0, -1.0)},
        ),
        Mistake(
            "rows the wrong way, in the edit",
            "The pasted image's steps from row to row are taken the wrong way round: down is plus.",
            {"edit": _with_field(1.0, -1.0)},
        ),
        Mistake(
            "no guidance",
            "This is a membrane, the values at the edge spread inwards: the right side of (7.11) is div g', "
            "not 0.",
            {"edit": _with_field(0.0, 0.0)},
        ),
        Mistake(
            "edge of 0",
            "The known pixels next to the mask are left out, as if they were 0: their values belong on the "
            "right side.",
            {"edit": _dark},
        ),
        Mistake(
            "cut off at 0 and 255",
            "Values are cut off at 0 and 255. They are to be left as they come: what is cut off is no "
            "solution.",
            {"edit": lambda *args: _pasted(args[0], args[1], np.clip(edit(*args), 0.0, 255.0))},
        ),
    ),
)
