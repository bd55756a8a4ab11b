"""The gallery without a browser: formulas, captions, the folder, the verb and the README of the goldens."""

import html
import json
import os
import re
import signal
import subprocess
import sys
import textwrap
import tomllib
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from lietool import figure, paths
from lietool.gallery import chapters, formula, page, prose, readme, site
from lietool.gallery.entry import Equation
from lietool.verbs import _equations_index, _figures_gallery, _studio, equations
from lietool.verbs.figures import command

FILE = '''
"""Toy."""

from pathlib import Path
from typing import Annotated, Literal

import numpy as np

from lietool.figure import Drawing, Param, Plate, Time, figure
from lietool.render.scene import Label, Picture, View


@figure(
    plates={
        "T1": Plate("Dots <em> & x_1", ("4.27", "K 9", "9.9"), "Where theta_2 < 0 & 'A | B' are `x`."),
        "T1b": Plate("Five dots", (), "Five.", {"count": 5}),
    },
    time=Time("at", 0, 1),
)
def dots(
    count: Annotated[int, Param("how many", "", 1, 9)] = 3,
    at: Annotated[float, Param("where on the x axis")] = -0.5,
    hue: Annotated[Literal["red", "blue"], Param("its colour")] = "red",
    shaded: Annotated[bool, Param("light it")] = True,
    mesh: Annotated[Path | None, Param("a mesh")] = None,
) -> Drawing:
    """Draw dots."""
    inner = {"I": np.eye(2), "ok": True, "tiny": -1e-17}
    numbers = {"count": count, "x": np.linspace(0.0, 1.0, 40), "inner": inner}
    return Drawing(Picture((View(()),), (60, 40)), numbers)
'''


class Studio(_studio.Studio):
    """A renderer that paints grey, light or dark."""

    info = {"renderer": "llvmpipe", "backend": "osmesa"}  # noqa: RUF012
    trouble = ""

    def require(self):
        if self.trouble:
            raise _studio.Stop(4, self.trouble)

    def paint(self, item, *, size=None, draft=False, theme="book"):
        grey = {"book": 250, "dark": 20}[theme] + len(item.id)
        image = np.full((40, 60, 3), grey, np.uint8)
        return _studio.Painted(image, item.figure.draw(**item.parameters).numbers)


@pytest.fixture
def studio():
    return Studio()


@pytest.fixture
def run(tmp_path, monkeypatch, studio):
    """Run the verb in a project of its own; the exit code is checked, the output returned."""
    (tmp_path / "mine" / "figures" / "ch9").mkdir(parents=True)
    (tmp_path / "mine" / "figures" / "ch9" / "dots.py").write_text(FILE)
    (tmp_path / "ours").mkdir()
    monkeypatch.setattr(paths, "FIGURES", tmp_path / "ours")
    monkeypatch.setenv(figure.PROJECT, "mine")
    monkeypatch.chdir(tmp_path)

    def invoke(*words, code=0):
        result = CliRunner().invoke(command, ["gallery", *words], obj=studio, catch_exceptions=False)
        assert result.exit_code == code, result.output
        return result.output

    return invoke


def files(folder):
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()
    }


class TestProse:
    @pytest.mark.parametrize(
        ("plain", "wanted"),
        [
            ("R_z(theta_3)", "<i>R</i><sub><i>z</i></sub>(<i>θ</i><sub>3</sub>)"),
            ("q0 and -q1", "<i>q</i><sub>0</sub> and −<i>q</i><sub>1</sub>"),
            (
                "R T_b R^-1 = T_Rb",
                "<i>R</i> <i>T</i><sub><i>b</i></sub> <i>R</i><sup>−1</sup> = <i>T</i><sub><i>Rb</i></sub>",
            ),
            ("|x| = 2n pi", "|<i>x</i>| = 2<i>n</i>\u202f<i>π</i>"),
            ("T_{b+b'}", "<i>T</i><sub><i>b</i>+<i>b</i>′</sub>"),
            ("S' >= 2, x -> y", "<i>S</i>′ ≥ 2, <i>x</i> → <i>y</i>"),
            ("Sym+(2) and GL^+(n)", "Sym<sup>+</sup>(2) and GL<sup>+</sup>(<i>n</i>)"),
            ("an error above 10^-5", "an error above 10<sup>−5</sup>"),
            ("a 3 x 3 or 2x2 matrix", "a 3 × 3 or 2×2 matrix"),
            ("(u.x)u or (u . x) u", "(<i>u</i> · <i>x</i>)<i>u</i> or (<i>u</i> · <i>x</i>) <i>u</i>"),
            ("u x x or u cross x", "<i>u</i> × <i>x</i> or <i>u</i> × <i>x</i>"),
            ("the square root of A^T A", "the square root of <i>A</i><sup><i>T</i></sup> <i>A</i>"),
            ("phi(psi(A)) against A", "<i>φ</i>(<i>ψ</i>(<i>A</i>)) against <i>A</i>"),
            ("x < 0 & y", "<i>x</i> &lt; 0 &amp; <i>y</i>"),
        ],
    )
    def test_formulas_are_set(self, plain, wanted):
        assert prose.to_html(plain) == wanted

    @pytest.mark.parametrize(
        "plain",
        [
            "(a) Rotation. (b) A glyph F, and a path.",
            "Rodrigues's formula, i.e. the command's, e.g. B2.8, K 6, GL2 and 3D",
            "A path through SO(3), O(2) and E(3): so it is.",
            "about 1e-9, as so3.log_near says; well-known",
        ],
    )
    def test_words_are_left_alone(self, plain):
        assert re.sub(r"<i>n</i>", "n", prose.to_html(plain)) == plain

    def test_nothing_is_lost_from_our_captions(self):
        """Apart from signs and spaces the letters and digits that were written are those that are read."""
        greek = {value: key for key, value in prose._GREEK.items()} | {"ε": "eps"}
        for item in _studio.items():
            for text in (item.plate.title, item.plate.caption):
                read = html.unescape(re.sub(r"<[^>]*>", "", prose.to_html(text)))
                read = "".join(greek.get(letter, letter) for letter in read).replace("×", "x")
                assert re.sub(r"[^\w]|_", "", read) == re.sub(r"[^\w]|_", "", text), item.id


class TestFormula:
    tex = equations.tex()

    def test_every_listed_equation_has_tex_and_no_other(self):
        assert list(self.tex) == [equation.number for equation in _equations_index.catalogue(equations.LIST)]

    @pytest.mark.parametrize("number", tex)
    def test_it_is_set_and_fits_a_telephone(self, number):
        box = formula.typeset(self.tex[number], formula.Outlines())
        # 400 px hold 22 of its type sizes beside the margins.
        assert 1000 < box.width <= 20500 and box.above > 0 and box.parts

    def test_every_equation_of_a_plate_is_among_them(self):
        for item in _studio.items():
            for number in item.plate.equations:
                assert (number if " " in number else f"B {number}") in self.tex, item.id

    def test_a_formula_says_the_same_as_its_plain_form(self):
        """Capitals and digits of the plain form occur in the TeX, unless it spells them out otherwise."""
        for equation in _equations_index.catalogue(equations.LIST):
            letters = set(re.findall(r"\b[A-Z]\b", equation.formula)) - {"H"}
            written = set(re.findall(r"[A-Z]", self.tex[equation.number]))
            assert len(letters - written) <= 1, (equation.number, letters - written)

    def test_a_matrix_stands_between_brackets_about_the_axis(self):
        outlines = formula.Outlines()
        one = formula.typeset("a", outlines)
        box = formula.typeset(r"\begin{bmatrix} a & a \\ a & a \end{bmatrix}", outlines)
        assert abs(box.above - box.below - 500) <= 2 and box.width > 2 * one.width
        assert len(outlines.paths) == 1 and "".join(box.parts).count("<use") == 4

    def test_lines_go_down_and_the_base_line_is_the_first(self):
        outlines = formula.Outlines()
        one, two = formula.typeset("x", outlines), formula.typeset(r"x \\ = x", outlines)
        assert two.above == one.above and two.below > one.below + 400

    @pytest.mark.parametrize(
        ("tex", "words"),
        [
            (r"\nosuchword", "tex must be mathtext; got"),
            (r"\begin{bmatrix} a & b \\ c \end{bmatrix}", "rows of a matrix must be of equal length; got"),
        ],
    )
    def test_what_is_none_is_refused_in_one_line(self, tex, words):
        with pytest.raises(ValueError, match=words) as error:
            formula.typeset(tex, formula.Outlines())
        assert "\n" not in str(error.value)

    def test_numbers_as_they_are_read_and_searched_for(self):
        shown = {
            number: Equation(number, "", "", "") for number in ("B 4.27", "B A.3", "K 9", "K Algorithm 1")
        }
        assert [e.shown for e in shown.values()] == ["(4.27)", "(A.3)", "K (9)", "K Algorithm 1"]
        assert [e.key for e in shown.values()] == ["4.27", "a.3", "k9", "kalgorithm1"]

    def test_json_of_the_verb_has_it(self):
        assert equations.describe(equations.select("2.7", equations.index())[0])["tex"] == self.tex["B 2.7"]


class TestChapters:
    @pytest.mark.parametrize(
        ("plate", "folder", "label"),
        [
            ("B3.1", "ch2", "Chapter 3"),
            ("GL1", "ch2", "Chapter 2"),
            ("G6.5", "ch6", "Chapter 6"),
            ("T7.1", "ch7", "Chapter 7"),
            ("K1", "ch2", "The papers"),
            ("KT1", "papers", "The papers"),
        ],
    )
    def test_a_plate_belongs_where_its_number_says(self, plate, folder, label):
        assert chapters.chapter(plate, folder).label == label

    def test_a_project_has_its_own(self):
        own = chapters.chapter("B3.1", "ch3", "course")
        assert (own.label, own.name) == ("course", "Chapter 3")
        assert chapters.rank(own) > chapters.rank(chapters.chapter("K1", "papers"))

    def test_every_folder_of_ours_has_a_name(self):
        assert all(
            chapters.chapter("", folder.name).name
            for folder in paths.FIGURES.glob("[a-z]*")
            if folder.is_dir()
        )


class TestPage:
    def test_all_that_is_known_is_on_it(self, run, tmp_path):
        assert run().strip() == "out/gallery/index.html"
        text = (tmp_path / "out/gallery/index.html").read_text()
        assert "Dots &lt;em&gt; &amp; <i>x</i><sub>1</sub>" in text
        assert "<span>(4.27)</span> <span>K (9)</span> <span>(9.9)</span>" in text
        assert text.count('<svg class="tex"') == 2 and "0 &lt; |x| &lt; 2 pi" in text
        plain = re.sub(r"<[^>]+>", "", text)
        for line in (
            "--project mine dots",
            "--project mine dots -o dots.gif",
            "--project mine dots --plate T1b",
        ):
            assert f"lietool {line}" in plain
        for words in ("--count", "1 to 9", "where on the", "red, blue", "none", "yes"):
            assert words in plain
        assert "40" in plain and "inner.I" in plain and "inner.tiny" in plain and "e-17" not in plain
        assert "9 to 9" not in plain and "mine" in plain and "Chapter 9" in plain

    def test_pictures_are_of_both_themes_and_numbers_whole(self, run, tmp_path):
        run()
        found = files(tmp_path / "out/gallery")
        names = [re.sub(r"\.[0-9a-f]{10}\.", ".", name) for name in found]
        assert sorted(names) == [
            ".lietool-gallery",
            "index.html",
            *("numbers/T1.json", "numbers/T1b.json"),
            *("pictures/T1-dark.png", "pictures/T1.png", "pictures/T1b-dark.png", "pictures/T1b.png"),
        ]
        (numbers,) = (data for name, data in found.items() if name.startswith("numbers/T1."))
        assert len(json.loads(numbers)["x"]["data"]) == 40
        text = found["index.html"].decode()
        assert all(name in text for name in found if "/" in name)

    def test_alternative_texts_are_whole_and_escaped(self, run, tmp_path):
        run()
        text = (tmp_path / "out/gallery/index.html").read_text()
        assert 'alt="Dots &lt;em&gt; &amp; x_1. Where theta_2 &lt; 0 &amp; &#39;A | B&#39; are `x`."' in text

    def test_nothing_on_it_needs_the_network(self, run, tmp_path):
        run()
        text = (tmp_path / "out/gallery/index.html").read_text()
        assert not re.search(r"https?:|//[a-z]+\.[a-z]|@import|url\(", text)

    def test_ids_are_unique_and_none_can_be_a_plate(self, run, tmp_path):
        run()
        ids = re.findall(r'\bid="([^"]+)"', (tmp_path / "out/gallery/index.html").read_text())
        assert len(ids) == len(set(ids)) and all(
            name.startswith("_") or name in ("T1", "T1b") for name in ids
        )

    def test_the_code_is_a_link_only_within_its_project(self, run, tmp_path):
        run()
        assert 'href="../../mine' not in (tmp_path / "out/gallery/index.html").read_text()
        run("-o", "mine/out/gallery")
        text = (tmp_path / "mine/out/gallery/index.html").read_text()
        (link, line) = re.search(r'href="(\.\./[^"]+)">figures/ch9/dots.py:(\d+)</a>', text).groups()  # type: ignore[union-attr]
        code = (tmp_path / "mine/out/gallery" / link).resolve().read_text().splitlines()
        assert code[int(line) - 1].startswith("@figure(")

    def test_no_folder_of_this_machine_is_named(self, run, tmp_path, monkeypatch):
        monkeypatch.setenv(figure.PROJECT, str(tmp_path / "mine"))
        run()
        text = (tmp_path / "out/gallery/index.html").read_text()
        assert str(tmp_path) not in text and "--project mine dots" in re.sub(r"<[^>]+>", "", text)

    def test_some_plates_only(self, run, tmp_path):
        run("t1B", "-o", "one")
        assert "1 plate," in (tmp_path / "one/index.html").read_text()
        assert "no plate" in run("T7", code=2)

    def test_without_a_renderer_it_says_what_can_be_done(self, run, studio):
        studio.trouble = "no OpenGL renderer"
        assert "--golden takes the accepted pictures" in run(code=4)


class TestGolden:
    @pytest.fixture
    def accepted(self, run, tmp_path, studio):
        done = CliRunner().invoke(
            command, ["accept", "--all", "--reason", "r"], obj=studio, catch_exceptions=False
        )
        assert done.exit_code == 0, done.output
        return tmp_path / "mine/golden"

    def test_accepted_pictures_need_no_renderer(self, accepted, run, studio, tmp_path):
        studio.trouble = "no OpenGL renderer"
        run("--golden")
        found = files(tmp_path / "out/gallery")
        pictures = {name: data for name, data in found.items() if name.startswith("pictures/")}
        assert len(pictures) == 2 and (accepted / "ch9/T1.png").read_bytes() in pictures.values()
        assert "<source" not in found["index.html"].decode()

    def test_one_that_is_missing_or_half_accepted_is_named(self, accepted, run):
        (accepted / "ch9/T1b.json").unlink()
        assert "T1b: " in run("--golden", code=3) and not Path("out").exists()

    def test_accept_writes_the_readme_and_gallery_renews_it(self, accepted, run):
        path = accepted / "README.md"
        text = path.read_text()
        assert "](ch9/T1.png)" in text and "](ch9/T1b.png)" in text
        assert "nothing has changed" in run("--readme")
        path.write_text("stale")
        assert run("--readme").strip() == str(path) and path.read_text() == text

    def test_the_readme_names_what_is_accepted_only(self, accepted, run):
        (accepted / "ch9/T1b.png").unlink()
        run("--readme")
        assert "T1b" not in (accepted / "README.md").read_text()

    def test_markdown_takes_nothing_in_it_for_its_own(self, accepted):
        text = (accepted / "README.md").read_text()
        assert r"### T1: Dots \<em\> & <i>x</i><sub>1</sub>" in text
        assert r"are \`<i>x</i>\`." in text and r"'A \| B'" in text
        assert "- (4.27) `exp : {0 < |x| < 2 pi} -> {R != I}`" in text and "\n- (9.9)\n" in text
        assert "```sh\nlietool --project mine dots --plate T1b\n```" in text

    def test_readme_is_for_all_plates(self, run):
        assert "--readme is for all plates" in run("T1", "--readme", code=2)


class TestFolder:
    def test_a_second_run_replaces_the_first(self, run, tmp_path, monkeypatch):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
        run()
        before = files(tmp_path / "out/gallery")
        monkeypatch.setenv("SOURCE_DATE_EPOCH", "90000")
        run()
        assert files(tmp_path / "out/gallery") == before
        run("T1")
        assert len(files(tmp_path / "out/gallery")) == 5

    @pytest.mark.parametrize("name", ["notes.txt", "pictures/mine.png", "numbers/deep/a.json", "index.html"])
    def test_a_folder_with_other_things_is_refused(self, run, tmp_path, name):
        if name != "index.html":
            run()
        path = tmp_path / "out/gallery" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("mine")
        before = files(tmp_path / "out")
        assert "Name another folder with -o" in run(code=2)
        assert files(tmp_path / "out") == before

    def test_a_file_is_refused(self, run, tmp_path):
        (tmp_path / "page").write_text("")
        assert "it is a file" in run("-o", "page", code=2)

    def test_one_that_cannot_be_written_is_one_line(self, run, tmp_path):
        (tmp_path / "file").write_text("")
        assert "cannot be written" in run("-o", "file/page", code=2)

    def test_what_a_killed_run_left_is_taken_over(self, run, tmp_path):
        folder = tmp_path / "out/gallery"
        (folder / "pictures").mkdir(parents=True)
        (folder / site.MARK).write_text("")
        (folder / "pictures/.T1.abc.part").write_text("half")
        (folder / "pictures/T0.0123456789.png").write_text("old")
        run()
        assert not any(name.endswith(".part") or "T0" in name for name in files(folder))

    def test_a_run_killed_at_any_file_leaves_the_old_page_whole(self, tmp_path):
        """The old page stands until the new one replaces it, with everything that it names."""
        code = textwrap.dedent("""
            import os, signal, sys
            from pathlib import Path
            from lietool import atomic
            from lietool.gallery import site
            write, left = atomic.write_bytes, [int(sys.argv[2])]
            def dying(path, data):
                if not left[0]:
                    os.kill(os.getpid(), signal.SIGKILL)
                left[0] -= 1
                write(path, data)
            atomic.write_bytes = dying
            new = {site.named("pictures", f"P{i}", b"new%d" % i, "png"): b"new%d" % i for i in range(3)}
            site.publish(Path(sys.argv[1]), " ".join(new).encode(), new)
        """)
        old = {site.named("pictures", "P0", b"old", "png"): b"old"}
        for writes in range(6):
            folder = tmp_path / str(writes)
            site.publish(folder, " ".join(old).encode(), old)
            done = subprocess.run(
                [sys.executable, "-c", code, folder, str(writes)], env=os.environ, check=False
            )
            assert done.returncode == (0 if writes == 5 else -signal.SIGKILL)
            assert not site.stranger(folder)
            named = (folder / site.PAGE).read_text().split()
            assert (named == list(old)) == (writes < 5) and all((folder / name).is_file() for name in named)

    def test_a_folder_named_like_a_file_of_ours_is_somebody_elses(self, tmp_path):
        (tmp_path / site.MARK).touch()
        (tmp_path / ".notes.part").mkdir()
        assert ".notes.part" in site.stranger(tmp_path)

    def test_what_came_while_it_was_drawn_stays(self, tmp_path):
        old = {site.named("pictures", "T1", b"old", "png"): b"old"}
        site.publish(tmp_path, b"", old)
        for name in ("notes.txt", "pictures/mine.png", "numbers/deep/T1.0123456789.json"):
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text("mine")
        assert site.publish(tmp_path, b"", {}) == [tmp_path / name for name in old]
        assert sum(data == b"mine" for data in files(tmp_path).values()) == 3

    def test_assets_are_named_by_their_content(self):
        one, two = (site.named("pictures", "T1", data, "png") for data in (b"one", b"two"))
        assert one != two and site._ASSET.fullmatch(one.partition("/")[2])


class TestReadmeOfOurGoldens:
    path = paths.GOLDEN / _figures_gallery.README

    def test_it_is_as_it_would_be_written_now(self):
        wanted = _figures_gallery.readmes(_studio.items())[self.path]
        current = self.path.read_bytes() if self.path.is_file() else b""
        assert current == wanted, "golden/README.md is stale: `lietool figures gallery --readme` renews it"

    def test_the_history_is_as_it_would_be_written_now(self):
        path = paths.GOLDEN / _figures_gallery.CHANGES
        wanted = _figures_gallery.readmes(_studio.items())[path]
        current = path.read_bytes() if path.is_file() else b""
        assert current == wanted, "golden/CHANGES.md is stale: `lietool figures gallery --readme` renews it"

    def test_its_pictures_and_anchors_are_there(self):
        text = self.path.read_text()
        pictures = re.findall(r"^!\[(.+)\]\((.+?)\)$", text, re.MULTILINE)
        assert pictures and all(
            (paths.GOLDEN / name).is_file() and len(words) > 60 for words, name in pictures
        )
        links, anchors = re.findall(r"\]\(#(.+?)\)", text), re.findall(r'<a id="(.+?)">', text)
        assert links == anchors and len(set(anchors)) == len(anchors) == len(pictures)


def test_data_files_are_read_as_they_are_packed():
    """What the page is made of lies in the package, and TOML that a wheel carries is TOML."""
    for name in ("page.html", "page.css", "page.js"):
        assert (Path(page.__file__).parent / name).is_file()
    assert set(tomllib.loads(equations.TEX.read_text(encoding="utf-8"))) == set(_equations_index.TEXTS)
    assert readme.build([]).startswith("# The plates")
