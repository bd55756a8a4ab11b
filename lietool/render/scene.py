"""What a picture is made of: frozen records that say what is there, never how it is drawn.

A `Picture` is a page with `View` s on it; a view is a box on the page, a camera
and the records seen through it.  The page is measured in page units, x to the
right and y up from the lower left corner, whatever the number of pixels it is
rendered to; widths, radii of points, text sizes and label offsets are in page
units too.  Positions of records are in the space of the view's camera, which
for `camera.Page` is the page itself.

Colours are those of `style`, which a theme may change, or hex strings, which it leaves alone; where a
record says so, also a `Mix` or an array of linear RGBA with one row for each point.
"""

from dataclasses import dataclass, field
from typing import Literal

from numpy.typing import ArrayLike

from lietool.render import style
from lietool.render.camera import Camera, Page
from lietool.render.theme import Color


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles: lit ("matte"), lit softly ("soft"), unlit ("flat", "shadow"), or a convex shell of "glass".

    Parameters
    ----------
    vertices : array_like, shape (n, 3)
    faces : array_like of int, shape (m, 3)
    color : str, Mix or ndarray, shape (n, 4)
        One colour, or one for each vertex.
    normals : array_like, shape (n, 3), optional
        Unit normals; without them every face is flat.
    material : {"matte", "flat", "glass", "soft", "shadow"}
        A shadow is under all else that is not opaque.
    alpha : float
        Opacity; below 1 the triangles are sorted by depth.
    """

    vertices: ArrayLike
    faces: ArrayLike
    color: Color
    normals: ArrayLike | None = None
    material: Literal["matte", "flat", "glass", "soft", "shadow"] = "matte"
    alpha: float = 1.0


@dataclass(frozen=True, eq=False)
class Lines:
    """One polyline, or several with a row of NaN between them.

    Parameters
    ----------
    points : array_like, shape (n, 3)
    color : str, Mix or ndarray, shape (n, 4)
    width : float
        In page units.
    alpha : float
    dash : tuple of float, optional
        Lengths of stroke and gap, in page units on the page.
    lift : float
        How far the line is drawn towards the viewer when it is compared with
        surfaces, as a fraction of the height of the view; a line on a surface needs a little.
    """

    points: ArrayLike
    color: Color
    width: float = 2.0
    alpha: float = 1.0
    dash: tuple[float, float] | None = None
    lift: float = 0.004


@dataclass(frozen=True, eq=False)
class Points:
    """Small balls of a fixed size on the page.

    Parameters
    ----------
    positions : array_like, shape (n, 3)
    color : str, Mix or ndarray, shape (n, 4)
    radius : float
        In page units.
    rim : str, optional
        Colour of a thin ring around each.
    shaded : bool
        Lit like a ball, or a plain disc.
    """

    positions: ArrayLike
    color: Color
    radius: float = 8.0
    rim: str | None = None
    shaded: bool = True


@dataclass(frozen=True, eq=False)
class Arrow:
    """A solid arrow from `start` to `end`, `radius` thick in the units of the space it lies in."""

    start: ArrayLike
    end: ArrayLike
    color: str
    radius: float
    head: float = 2.6
    alpha: float = 1.0


@dataclass(frozen=True, eq=False)
class Tube:
    """A round tube along a polyline, `radius` thick in the units of the space it lies in.

    Parameters
    ----------
    points : array_like, shape (n, 3)
    color : str, Mix or ndarray, shape (n, 4)
    radius : float
    closed : bool
    """

    points: ArrayLike
    color: Color
    radius: float
    closed: bool = False


@dataclass(frozen=True, eq=False)
class Frame:
    """Three arrows along the columns of a matrix, red, green and blue.

    Parameters
    ----------
    matrix : array_like, shape (3, 3)
        The columns are the axes, usually a rotation.
    origin : array_like, shape (3,)
    length : float
    """

    matrix: ArrayLike
    origin: ArrayLike = (0.0, 0.0, 0.0)
    length: float = 1.0
    radius: float = 0.03


@dataclass(frozen=True, eq=False)
class Image:
    """A photograph or other image on a parallelogram, opaque, and the same in every theme.

    Parameters
    ----------
    pixels : array_like, shape (h, w) or (h, w, 3)
        Grey, or red, green and blue, as encoded in sRGB from 0 to 1; the upper row first. What is beyond is
        drawn as 0 or 1.
    corner : array_like, shape (3,)
        Where its lower left corner is.
    across, up : array_like, shape (3,)
        From there to the lower right and to the upper left corner.
    smooth : bool
        Between the middles of pixels; else each pixel is a square.
    """

    pixels: ArrayLike
    corner: ArrayLike
    across: ArrayLike
    up: ArrayLike
    smooth: bool = True


@dataclass(frozen=True, eq=False)
class Label:
    """Mathematical text, placed by its anchor.

    Parameters
    ----------
    text : str
        Mathtext, such as ``$q_0$``.
    position : array_like, shape (3,)
        The point that the label belongs to, in the space of the view.
    offset : tuple of float
        From that point to the anchor of the text, in page units.
    anchor : str
        Which point of the text's box goes there: two letters, "l", "c" or "r"
        and then "b", "c", "t" or "n" (the base line).
    room : float
        How far from the point, in page units, the text may be moved to a place that is free of other
        text and of lines; 0 leaves it where `offset` and `anchor` put it. They say which place is liked best.
    """

    text: str
    position: ArrayLike
    color: str
    size: float = 30.0
    offset: tuple[float, float] = (0.0, 0.0)
    anchor: str = "cc"
    halo: bool = True
    room: float = 0.0


Record = Surface | Lines | Points | Arrow | Tube | Frame | Image | Label


@dataclass(frozen=True, eq=False)
class View:
    """Records seen through a camera, inside a box (x, y, width, height) of the page."""

    records: tuple[Record, ...]
    camera: Camera | Page = field(default_factory=Page)
    box: tuple[float, float, float, float] | None = None


@dataclass(frozen=True, eq=False)
class Picture:
    """A page of `size` page units with views on it, the later ones over the earlier."""

    views: tuple[View, ...]
    size: tuple[int, int] = (1200, 900)
    paper: str = style.PAPER
