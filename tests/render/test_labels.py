"""Text: keys that stay, stores that are looked through, and where a label comes to lie."""

import os
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest

from lietool import atomic
from lietool.render import draw, labels, style
from lietool.render.compose import PlacedLabel
from lietool.render.scene import Label, Picture, View

SIZE = (200, 120)


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The texts that matplotlib was asked for."""
    asked = []
    rasterise = labels.rasterise

    def counted(text: str, pixels: float) -> tuple[np.ndarray, int]:
        asked.append(text)
        return rasterise(text, pixels)

    monkeypatch.setattr(labels, "rasterise", counted)
    return asked


@pytest.fixture
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user's cache that is empty."""
    monkeypatch.setenv("LIETOOL_CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache" / f"labels-{metadata.version('matplotlib')}"


def filled(folder: Path, *texts: str, size: float = 24.0) -> labels.Store:
    """A store whose folder holds these labels."""
    folder.mkdir(exist_ok=True)
    maker = labels.Store(())
    for text in texts:
        maker.get(text, size)
    for name, data in maker.fresh.items():
        (folder / name).write_bytes(data)
    return labels.Store((folder,))


def placed(text: str = "$x$", at: tuple[float, float] = (100.0, 60.0), **options) -> PlacedLabel:
    label = Label(text, (*at, 0.0), style.INK, **({"size": 24.0} | options))
    (found,) = draw.render(Picture((View((label,)),), SIZE)).labels
    return found


class TestKeys:
    def test_they_are_the_names_of_files_in_goldens(self):
        # Another key for the same text would orphan every label that is kept: change FORMAT instead.
        assert labels.key("$x$", 30.0) == "x-a86c4ccd7b4a"
        assert labels.key(r"$\theta_1 = -20^{\circ}$", 25.0) == "theta-1-20-circ-58febdc887c9"

    def test_text_and_size_make_them(self):
        keys = [labels.key(t, s) for t in ("$x$", "$X$", "$-$", "") for s in (24.0, 24.01, 25.0)]
        assert len(set(keys)) == len(keys)
        assert len({key.lower() for key in keys}) == len(keys)
        assert labels.key("$x$", 24.0) == labels.key("$x$", 24.001)

    def test_they_are_safe_as_file_names(self):
        for text in ("../../etc/passwd", "a\0b", "x" * 500, "日本", "$\\pi$", "CON"):
            key = labels.key(text, 24.0)
            assert len(key) < 40 and all(c.isascii() and (c.isalnum() or c == "-") for c in key)


class TestStore:
    def test_a_folder_comes_first(self, tmp_path, own_cache, drawn):
        store = filled(tmp_path / "golden", "$x$")
        drawn.clear()
        glyphs = store.get("$x$", 24.0)
        assert drawn == [] and store.fresh == {} and glyphs.key == labels.key("$x$", 24.0)
        first = labels.Store((tmp_path / "none", tmp_path / "golden")).get("$x$", 24.0)
        assert np.array_equal(first.coverage, glyphs.coverage) and first.baseline == glyphs.baseline

    def test_what_is_new_is_kept_for_the_user_and_offered(self, tmp_path, own_cache, drawn):
        store = labels.Store((tmp_path,))
        glyphs = store.get("$x$", 24.0)
        name = f"{glyphs.key}.png"
        assert list(store.fresh) == [name] and [p.name for p in own_cache.iterdir()] == [name]
        again = labels.Store((tmp_path,))
        assert np.array_equal(again.get("$x$", 24.0).coverage, glyphs.coverage)
        assert drawn == ["$x$"] and again.fresh == store.fresh
        assert list(tmp_path.glob("*.png")) == []

    def test_the_file_gives_back_what_was_drawn(self, tmp_path, own_cache):
        store = labels.Store(())
        drawn = store.get("$y$", 24.0)
        (tmp_path / f"{drawn.key}.png").write_bytes(store.fresh[f"{drawn.key}.png"])
        read = labels.Store((tmp_path,), strict=True).get("$y$", 24.0)
        assert np.array_equal(read.coverage, drawn.coverage)
        assert (read.baseline, read.key) == (drawn.baseline, drawn.key)

    def test_strict(self, tmp_path, own_cache):
        filled(tmp_path / "golden", "$x$")
        store = labels.Store((tmp_path / "golden",), strict=True)
        assert store.get("$x$", 24.0).coverage.max() == 255
        # What the user's cache holds does not count.
        labels.Store(()).get(r"$\beta$", 24.0)
        for text, size in ((r"$\beta$", 24.0), ("$x$", 25.0)):
            with pytest.raises(labels.MissingLabelError) as caught:
                store.get(text, size)
            assert isinstance(caught.value, LookupError)
            assert repr(text) in str(caught.value) and f"{size:g} px" in str(caught.value)
            assert (caught.value.text, caught.value.pixels) == (text, size)
        assert store.fresh == {}

    def test_a_strict_store_stops_the_picture(self, tmp_path, own_cache):
        picture = Picture((View((Label("$x$", (9, 9, 0), style.INK),)),), SIZE)
        with pytest.raises(labels.MissingLabelError, match=r"'\$x\$' at 30 px"):
            draw.render(picture, store=labels.Store((tmp_path,), strict=True))

    def test_a_torn_file_is_made_again(self, tmp_path, own_cache, drawn):
        store = filled(tmp_path / "golden", "$x$")
        (file,) = (tmp_path / "golden").iterdir()
        whole = file.read_bytes()
        good = store.get("$x$", 24.0).coverage
        for number, piece in enumerate(whole[:n] for n in range(0, len(whole), 7)):
            # A name of its own each time: what was read is remembered by path and time.
            folder = tmp_path / str(number)
            folder.mkdir()
            (folder / file.name).write_bytes(piece)
            assert np.array_equal(labels.Store((folder,)).get("$x$", 24.0).coverage, good), number

    def test_a_damaged_file_stops_nothing(self, tmp_path, own_cache):
        store = filled(tmp_path / "golden", "$x$")
        (file,) = (tmp_path / "golden").iterdir()
        whole = file.read_bytes()
        for n in range(0, len(whole), 3):
            file.write_bytes(whole[:n] + bytes([whole[n] ^ 255]) + whole[n + 1 :])
            os.utime(file, ns=(n + 1, n + 1))
            assert store.get("$x$", 24.0).key == file.stem

    def test_a_file_of_another_picture_is_not_a_label(self, tmp_path, own_cache):
        from PIL import Image

        Image.new("RGB", (4, 4)).save(tmp_path / f"{labels.key('$x$', 24.0)}.png")
        store = labels.Store((tmp_path,))
        assert store.get("$x$", 24.0).coverage.max() == 255 and len(store.fresh) == 1

    def test_a_file_that_changes_is_read_again(self, tmp_path, own_cache):
        store = filled(tmp_path / "golden", "$x$")
        (file,) = (tmp_path / "golden").iterdir()
        before = store.get("$x$", 24.0)
        other = labels.Glyphs(np.full((3, 3), 7, np.uint8), 1, before.key)
        file.write_bytes(labels.encode(other, "$x$"))
        os.utime(file, ns=(1, 1))
        assert store.get("$x$", 24.0).coverage.tolist() == [[7] * 3] * 3

    def test_a_cache_that_cannot_be_written_is_harmless(self, tmp_path, own_cache, monkeypatch):
        wanted = labels.Store(()).get("$x$", 24.0).coverage

        def full(*_: object) -> None:
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(atomic, "write_bytes", full)
        store = labels.Store(())
        assert store.get(r"$\gamma$", 24.0).coverage.max() == 255 and len(store.fresh) == 1
        blocked = tmp_path / "file"
        blocked.touch()
        monkeypatch.setenv("LIETOOL_CACHE_DIR", str(blocked / "below"))
        monkeypatch.setattr("tempfile.tempdir", str(blocked))
        assert np.array_equal(labels.Store(()).get("$x$", 24.0).coverage, wanted)

    def test_the_name_in_the_picture_is_that_of_the_file(self, own_cache):
        store = labels.Store(())
        label = Label("$x$", (9, 9, 0), style.INK, 20.0)
        rendered = draw.render(Picture((View((label,)),), SIZE), size=(400, 240), store=store)
        assert [f"{x.key}.png" for x in rendered.labels] == list(store.fresh)
        assert rendered.labels[0].key == labels.key("$x$", 40.0)


class TestText:
    def test_the_same_pixels_twice(self):
        first, second = (labels.rasterise(r"$\exp(t\theta u)$", 24.0) for _ in range(2))
        assert np.array_equal(first[0], second[0]) and first[1] == second[1]

    def test_a_users_settings_do_not_matter(self):
        import matplotlib

        plain = labels.rasterise(r"$\theta_1$ is $12^{\circ}$", 24.0)
        with matplotlib.rc_context(
            {"mathtext.fontset": "stix", "font.family": "DejaVu Sans", "text.usetex": True, "savefig.dpi": 30}
        ):
            again = labels.rasterise(r"$\theta_1$ is $12^{\circ}$", 24.0)
        assert np.array_equal(plain[0], again[0])

    @pytest.mark.parametrize("text", [r"$\frac$", "$x", r"$\nosuch$", "a $ b", "$$", r"$x_{1$"])
    def test_what_is_no_mathtext(self, text, own_cache):
        with pytest.raises(ValueError, match=r"^labels\.rasterise: text must be mathtext; got ") as caught:
            labels.Store(()).get(text, 24.0)
        assert "\n" not in str(caught.value) and repr(text) in str(caught.value)

    def test_nothing_is_nothing(self):
        for text in ("", " "):
            assert placed(text).box[2] <= placed(text).box[0] + 1

    def test_size(self):
        heights = [
            np.ptp(np.flatnonzero(labels.rasterise("$H$", s)[0].max(axis=1) > 127)) + 1 for s in (24, 48)
        ]
        # Capitals of Computer Modern are 0.683 of the type size high.
        assert heights == pytest.approx([0.683 * 24, 0.683 * 48], abs=1.01)

    def test_the_rim_is_empty(self):
        coverage = labels.rasterise(r"$\int_0^1 Q_{y}$", 30.0)[0]
        assert coverage[:, 0].max() == coverage[:, -1].max() == 0

    def test_letters_stand_on_the_base_line(self):
        for text in ("$x$", "$H$", "1", "m"):
            coverage, baseline = labels.rasterise(text, 40.0)
            lowest = np.flatnonzero(coverage.max(axis=1) > 127)[-1] + 1
            assert abs(lowest - (len(coverage) - baseline)) <= 1, text
        coverage, baseline = labels.rasterise("$y$", 40.0)
        assert np.flatnonzero(coverage.max(axis=1) > 127)[-1] > len(coverage) - baseline + 4


class TestPlacing:
    @pytest.mark.parametrize("across", "lcr")
    @pytest.mark.parametrize("along", "tcbn")
    def test_anchors(self, across, along):
        left, top, right, bottom = placed("$H$", anchor=across + along).box
        # 60 page units up is the middle of 120 rows; the ink is up to 2 pixels inside of the text's box.
        x, y = 100, 60
        assert {"l": 0 <= left - x <= 2, "c": abs((left + right) / 2 - x) <= 2, "r": 0 <= x - right <= 2}[
            across
        ]
        inside = {
            "t": 0 <= top - y <= 3,
            "c": abs((top + bottom) / 2 - y) <= 2,
            "b": 0 <= y - bottom <= 2,
            "n": abs(bottom - y) <= 1,
        }
        assert inside[along]

    def test_base_lines_agree(self):
        x, y, h = (placed(f"${letter}$", anchor="ln").box for letter in "xyh")
        assert abs(x[3] - 60) <= 1 and abs(h[3] - 60) <= 1 and y[3] >= 64
        # The letters x and y are as high as each other above it.
        assert abs(x[1] - y[1]) <= 1 and h[1] < x[1] - 4

    def test_offset_goes_up_and_right(self):
        here, there = placed().box, placed(offset=(10.0, 20.0)).box
        assert tuple(np.subtract(there, here)) == (10, -20, 10, -20)

    def test_the_box_holds_the_ink(self):
        label = Label("$Q_y$", (100, 60, 0), "#000000", 30.0, halo=False)
        rendered = draw.render(Picture((View((label,)),), SIZE))
        dark = (rendered.image < 255).any(axis=2)
        rows, columns = np.flatnonzero(dark.any(axis=1)), np.flatnonzero(dark.any(axis=0))
        assert rendered.labels[0].box == (columns[0], rows[0], columns[-1] + 1, rows[-1] + 1)

    def test_whole_pixels(self):
        images = [
            draw.render(Picture((View((Label("$x$", (x, 60, 0), style.INK, anchor="lb"),)),), SIZE)).image
            for x in (100, 100.3, 101)
        ]
        assert np.array_equal(images[0], images[1])
        assert np.array_equal(images[0][:, :-1], images[2][:, 1:])

    def test_size_and_place_follow_the_picture(self):
        label = Label("$H$", (50, 60, 0), style.INK, 20.0, (10.0, 0.0), "lb")
        small, large = (
            draw.render(Picture((View((label,)),), SIZE), size=s).labels[0].box for s in (SIZE, (400, 240))
        )
        assert np.abs(np.subtract(large, np.multiply(small, 2))).max() <= 3

    @pytest.mark.parametrize(
        "at",
        [
            (-500.0, 60.0),
            (900.0, 60.0),
            (100.0, -300.0),
            (100.0, 900.0),
            (0.0, 0.0),
            (200.0, 120.0),
            (1e9, -1e9),
        ],
    )
    def test_outside_of_the_picture_it_is_clipped(self, at):
        box = placed("$Q$", at).box
        assert box[2] > box[0] and box[3] > box[1]

    def test_the_halo_is_paper(self):
        dark = Label("$x$", (100, 60, 0), "#000000", 24.0)
        back = View(())
        plain = Label("$x$", (100, 60, 0), "#000000", 24.0, halo=False)
        images = [
            draw.render(Picture((back, View((x,))), SIZE, paper="#6688aa")).image.astype(int)
            for x in (dark, plain)
        ]
        # On its own paper a halo is not to be seen.
        assert np.abs(images[0] - images[1]).max() <= 1

    def test_the_halo_parts_text_from_lines(self):
        from lietool.render.scene import Lines

        line = Lines([(0, 60, 0), (200, 60, 0)], "#000000", 2.0)
        label = Label("$o$", (100, 60, 0), "#000000", 24.0)
        image = draw.render(Picture((View((line, label)),), SIZE)).image[60, :, 0]
        left = draw.render(Picture((View((line, label)),), SIZE)).labels[0].box[0]
        assert image[20] == 0 and image[left - 2] > 100

    @pytest.mark.parametrize("anchor", ["", "x", "lx", "bl", "lbb"])
    def test_anchors_that_are_none(self, anchor):
        with pytest.raises(ValueError, match=rf"Label\.anchor must be .*; got '{anchor}'$"):
            placed(anchor=anchor)
