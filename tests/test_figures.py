"""Our plates: goldens, labels in their places, parameters at their ends, the laws in their numbers.

A plate is drawn once for all tests.  That the comparison would notice a mistake is tested by making some.
"""

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from lietool import figure, paths
from lietool.declaration import Figure
from lietool.golden import compare, folder, numbers, store
from lietool.lie import euler, kernels, quaternion, so3
from lietool.render import draw, scene, style
from lietool.verbs import _figures_verify, _picture, _studio

COMMANDS = figure.plates((paths.FIGURES,))
PLATES = list(COMMANDS)
NAMES = list(dict.fromkeys(COMMANDS.values()))


def item(plate_id: str) -> _studio.Item:
    return _studio.Item(plate_id, COMMANDS[plate_id])


@pytest.mark.parametrize("plate_id", PLATES)
class TestPlates:
    def test_picture_and_numbers_are_as_accepted(self, plate_id, plate, canonical):
        built = plate(plate_id)
        found = _figures_verify.judge(built.item, built.painted)
        assert found.passes, "\n".join(finding.message for finding in found.findings)

    def test_numbers_are_as_accepted_without_a_renderer(self, plate_id):
        sketched = _studio.Studio().sketch(item(plate_id))
        found = _figures_verify.judge(item(plate_id), sketched, pictured=False)
        assert found.passes, "\n".join(finding.message for finding in found.findings)

    def test_numbers_are_finite_and_can_be_written(self, plate_id, plate):
        shown = plate(plate_id).painted.numbers
        assert shown
        for name, value in shown.items():
            array = np.asarray(value)
            assert array.dtype.kind not in "fc" or np.isfinite(array).all(), name
        assert numbers.dumps(numbers.loads(numbers.dumps(shown))) == numbers.dumps(shown)

    def test_labels_lie_inside(self, plate_id, plate):
        built = plate(plate_id)
        height, width = built.painted.image.shape[:2]
        outside = [x for x in built.labels if min(x.box) < 4 or x.box[2] > width - 4 or x.box[3] > height - 4]
        assert built.labels and not outside

    def test_labels_do_not_overlap(self, plate_id, plate):
        labels = plate(plate_id).labels
        overlapping = [
            (a.text, b.text)
            for i, a in enumerate(labels)
            for b in labels[:i]
            if a.box[0] < b.box[2] and b.box[0] < a.box[2] and a.box[1] < b.box[3] and b.box[1] < a.box[3]
        ]
        assert not overlapping

    def test_labels_are_not_crossed(self, plate_id, plate):
        built = plate(plate_id)
        bare = without_labels(built.drawing.picture)
        light = draw.render(bare, draft=True).image @ (0.2126, 0.7152, 0.0722)
        for label in built.labels:
            x0, y0, x1, y1 = label.box
            under = light[max(y0 - 3, 0) : y1 + 3, max(x0 - 3, 0) : x1 + 3]
            # Nothing but a hairline or a corner may run under a text: most of it lies on one even ground.
            assert (np.abs(under - np.median(under)) > 40.0).mean() < 0.05, label.text

    def test_labels_can_be_read_in_grey(self, plate_id, plate):
        built = plate(plate_id)
        for label in built.labels:
            x0, y0, x1, y1 = label.box
            pixels = built.painted.image[y0 - 2 : y1 + 2, x0 - 2 : x1 + 2].reshape(-1, 3) / 255.0
            linear = np.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
            light = linear @ (0.2126, 0.7152, 0.0722)
            # The contrast that WCAG asks of large text, between ink and what is around it.
            assert (np.quantile(light, 0.9) + 0.05) / (light.min() + 0.05) >= 3.0, label.text

    def test_it_is_not_empty(self, plate_id, plate):
        image = plate(plate_id).painted.image
        ink = (image != 255).any(axis=2)
        assert 0.02 < ink.mean() < 0.9
        # Nothing is cut off by an edge of the page.
        assert not (ink[0].any() or ink[-1].any() or ink[:, 0].any() or ink[:, -1].any())

    def test_what_is_said_about_it(self, plate_id):
        plate = item(plate_id).plate
        assert plate.title.strip() and len(plate.caption) > 60 and plate.caption.endswith(".")
        assert plate.equations and all(
            re.fullmatch(r"[1-9A]\.\d+|[KM] \d+", number) for number in plate.equations
        )


def without_labels(picture: scene.Picture) -> scene.Picture:
    return replace(
        picture,
        views=tuple(
            replace(view, records=tuple(r for r in view.records if not isinstance(r, scene.Label)))
            for view in picture.views
        ),
    )


def test_goldens_and_labels_belong_to_plates():
    places = [item(plate_id).place for plate_id in PLATES]
    assert not list(folder.unregistered(paths.GOLDEN, places))
    used = set().union(*(store.label_keys(store.provenance(place)) for place in places))
    assert {file.stem for file in (paths.GOLDEN / store.LABELS).glob("*.png")} == used


def sampled(figure_: Figure) -> Iterator[dict[str, object]]:
    """Each plate, and each with one parameter that has a part at an end of its range or at another choice."""
    for plate_id in figure_.plates:
        base = figure_.plate_params(plate_id)
        yield base
        for parameter in figure_.parameters:
            # What is idle changes nothing, which `test_only` tries.
            if parameter.idle(base):
                continue
            values = list(parameter.param.choices)
            if parameter.kind in ("float", "int"):
                kind = float if parameter.kind == "float" else int
                ends = (parameter.param.low, parameter.param.high)
                values += [kind(end) for end in ends if end is not None]
            yield from (base | {parameter.name: v} for v in values if v != base[parameter.name])


def sketch(figure_: Figure, placed: Callable[..., object], **params: object) -> str:
    """Draw small, but type in its size; return what is wrong with the values, in one line, or nothing."""
    try:
        drawing = figure_.draw(**params)
    except ValueError as error:
        return str(error)
    image = draw.render(without_labels(drawing.picture), size=(64, 48), draft=True).image
    assert (image != 255).any()
    # In another size every word would have to be set anew.
    placed(drawing.picture)
    numbers.dumps(drawing.numbers)
    return ""


@pytest.mark.parametrize("name", NAMES)
class TestFigures:
    def test_help(self, name):
        loaded = figure.load(name, (paths.FIGURES,))
        assert "What to look for:" in loaded.help
        assert loaded.summary.endswith(".") and len(loaded.summary) < 110

    def test_parameters(self, name):
        for parameter in figure.load(name, (paths.FIGURES,)).parameters:
            param = parameter.param
            assert param.help and not param.help.endswith("."), parameter.name
            if parameter.kind in ("float", "int"):
                assert param.low is not None and param.high is not None, parameter.name
                assert param.low <= parameter.default <= param.high
            # What turns is in degrees.
            turns = re.search(r"\b(angle|turn(ed)?|rotation)\b", param.help) and parameter.kind == "float"
            assert not turns or param.unit == "deg", parameter.name

    def test_the_ends_of_every_range(self, name, placed):
        loaded = figure.load(name, (paths.FIGURES,))
        complaints = {}
        # Plates of a command meet where one differs from another in a single parameter.
        for params in {repr(params): params for params in sampled(loaded)}.values():
            if complaint := sketch(loaded, placed, **params):
                complaints[json.dumps(params)] = complaint
        for complaint in complaints.values():
            assert "\n" not in complaint and "; got " in complaint, complaint
        # Parameters may exclude each other here and there, but not as a rule.
        assert len(complaints) <= max(3, len(loaded.plates)), complaints


MOVING = [name for name in NAMES if figure.declare(name, (paths.FIGURES,)).time]


@pytest.mark.parametrize("name", MOVING)
class TestAnimation:
    def test_it_moves(self, name):
        loaded = figure.load(name, (paths.FIGURES,))
        assert loaded.time is not None
        values = _picture.sweep(loaded.time)
        for plate_id in loaded.plates:
            base = loaded.plate_params(plate_id)
            for value in values:
                loaded.check(base | {loaded.time.param: value})
            first, middle = values[0], values[len(values) // 2]
            pictures = [loaded.draw(**base | {loaded.time.param: value}).picture for value in (first, middle)]
            images = [draw.render(picture, size=(64, 48), draft=True).image for picture in pictures]
            assert not np.array_equal(*images)

    def test_every_frame_can_be_drawn(self, name):
        loaded = figure.load(name, (paths.FIGURES,))
        for value in dict.fromkeys(_picture.sweep(loaded.time)[::3]):
            loaded.draw(**{loaded.time.param: value})


def exchanged(x: np.ndarray) -> tuple[np.ndarray, ...]:
    """Rodrigues' formula with sine and cosine of the half angle exchanged."""
    theta = np.sqrt(np.sum(np.square(x), axis=0))
    u = np.where(theta > 0, x / np.where(theta > 0, theta, 1.0), np.array([[1.0], [0.0], [0.0]]))
    return kernels.matrix((np.sin(theta / 2), *(np.cos(theta / 2) * u)))


def flipped(which: int):
    """The rings of a gimbal with the sign of one angle flipped."""
    ring_frames, sign = euler.ring_frames, np.where(np.arange(3) == which, -1.0, 1.0)
    return lambda angles, *args, **options: ring_frames(angles * sign, *args, **options)


def last_flipped(R: np.ndarray, convention: str) -> np.ndarray:
    return FROM_MATRIX(R, convention) * (1.0, 1.0, -1.0)


FROM_MATRIX = euler.from_matrix
MISTAKES = {
    "sine and cosine exchanged in Rodrigues' formula": ("B4.2", kernels, "rotation_exp", exchanged),
    "the chord instead of the arc": ("B2.8", quaternion, "slerp", quaternion.nlerp),
    "the first Euler angle's sign": ("GL1", euler, "ring_frames", flipped(0)),
    "the second Euler angle's sign": ("GL1", euler, "ring_frames", flipped(1)),
    "the third Euler angle's sign": ("GL1", euler, "ring_frames", flipped(2)),
    "the third Euler angle's sign, the other way": ("GL2", euler, "from_matrix", last_flipped),
    "the principal logarithm all along": ("B4.2b", so3, "log_along", lambda R, start: so3.log(R)),
}


class TestMistakesAreNoticed:
    """Each by its picture alone, at the golden's size and by the golden's rule."""

    def seen(self, plate, repaint, plate_id) -> compare.Comparison:
        return compare.images(plate(plate_id).painted.image, repaint(plate_id))

    @pytest.mark.parametrize("mistake", MISTAKES)
    def test_in_a_formula(self, mistake, plate, repaint, monkeypatch):
        plate_id, module, name, wrong = MISTAKES[mistake]
        plate(plate_id)
        monkeypatch.setattr(module, name, wrong)
        assert not self.seen(plate, repaint, plate_id).passes

    def test_a_colour_that_is_a_little_off(self, plate, repaint, monkeypatch):
        plate("B2.8")
        monkeypatch.setattr(style, "GROUP", "#e0960b")
        assert not self.seen(plate, repaint, "B2.8").passes

    def test_a_label_that_reads_otherwise(self, plate, repaint, monkeypatch):
        plate("GL1")
        from lietool.figures.ch2 import gimbal

        monkeypatch.setattr(gimbal, "number", lambda value, digits=2: f"{value:.{digits}f}")
        assert not self.seen(plate, repaint, "GL1").passes

    @pytest.mark.parametrize("plate_id", PLATES)
    def test_nothing_is_noticed_where_nothing_is_wrong(self, plate_id, plate):
        image = plate(plate_id).painted.image
        jitter = np.random.default_rng(7).integers(-1, 2, image.shape)
        jittered = np.clip(image + jitter, 0, 255).astype(np.uint8)
        compared = compare.images(image, jittered)
        assert compared.passes and not compared.equal
