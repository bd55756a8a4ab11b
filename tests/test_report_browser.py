"""The report in a real browser, opened from disk: ways of comparing, zoom and loupe, filter, keys, review."""

import json
import re
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

from lietool.golden import compare, explain, report, store
from lietool.verbs import _figures_report, _studio

_FLAGS = (
    *("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--force-color-profile=srgb"),
)
WIDTHS = (400, 1000, 1600)
SIZE = (300, 400)
FAILED, CHANGED, PASSED = "T1", "T 2/[é]", "T3"
MODES = ("swipe", "blink", "side", "difference", "ssim")


class Browser:
    """What the tests do with a browser."""

    def __init__(self, driver: webdriver.Chrome, downloads: Path) -> None:
        self.driver, self.downloads = driver, downloads
        self.requested: list[str] = []

    def js(self, code: str, *arguments: object) -> object:
        """Return what a script returns; the elements that the tests name are at hand."""
        names = (
            "const $ = (s) => document.querySelector(s), $$ = (s) => [...document.querySelectorAll(s)],"
            " seen = (e) => e.checkVisibility({ visibilityProperty: true });"
        )
        return self.driver.execute_script(names + code, *arguments)

    def wait(self, code: str) -> None:
        """Wait until an expression is true."""
        WebDriverWait(self.driver, 10, 0.02).until(lambda _: self.js(f"return Boolean({code})"), code)

    def show(self, width: int = 1600, height: int = 900, *, dark: bool = False, still: bool = True) -> None:
        """Make the page so large, in light or dark."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        motion = {"name": "prefers-reduced-motion", "value": "reduce" if still else "no-preference"}
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "", "features": [scheme, motion]})

    def open(self, url: str) -> None:
        """Load a page afresh: another hash alone would not do it."""
        self.driver.get("about:blank")
        self.driver.get(url)

    def press(self, *keys: str) -> None:
        """Press keys one after another, wherever the focus is."""
        ActionChains(self.driver).send_keys(*keys).perform()

    def click(self, selector: str) -> None:
        """Click what a reader clicks."""
        self.driver.find_element(By.CSS_SELECTOR, selector).click()

    def ready(self) -> str:
        """Wait until the pictures of the plate in view are read, and return its name."""
        self.wait("$('.plate.current') && $('#_viewer').dataset.ready === $('.plate.current').id")
        return str(self.js("return $('.plate.current').id"))

    @property
    def mode(self) -> str:
        """How the pictures are compared now."""
        return str(self.js("return $('.stage').dataset.mode"))

    @property
    def listed(self) -> list[str]:
        """The plates that the list shows."""
        found = self.js("return $$('.list li').filter(seen).map((item) => item.innerText)")
        assert isinstance(found, list)
        return [text.splitlines()[0] for text in found]

    def pixel(self, selector: str, x: int, y: int) -> list[int]:
        """A pixel of a canvas on the page."""
        # From a copy: the page's own canvases are not for reading.
        code = (
            "const copy = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });"
            " copy.drawImage($(arguments[0]), -arguments[1], -arguments[2]);"
            " return [...copy.getImageData(0, 0, 1, 1).data]"
        )
        found = self.js(code, selector, x, y)
        assert isinstance(found, list)
        return found[:3]

    def complaints(self) -> list[str]:
        """What the console says since the last call; and what was asked for is noted."""
        for line in self.driver.get_log("performance"):
            message = json.loads(line["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                self.requested.append(message["params"]["request"]["url"])
        return [line["message"] for line in self.driver.get_log("browser")]


@pytest.fixture(scope="module")
def browser(chromium: tuple[str, str], tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    options = Options()
    options.binary_location = chromium[0]
    for flag in _FLAGS:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    downloads = tmp_path_factory.mktemp("downloads")
    with pytest.MonkeyPatch.context() as patch:
        # The driver is on this machine, whatever leads out of it.
        patch.setenv("no_proxy", "localhost,127.0.0.1")
        driver = webdriver.Chrome(options=options, service=Service(chromium[1]))
        try:
            where = {"behavior": "allow", "downloadPath": str(downloads)}
            driver.execute_cdp_cmd("Browser.setDownloadBehavior", where)
            yield Browser(driver, downloads)
        finally:
            driver.quit()


def picture(seed: int) -> np.ndarray:
    """Smooth, and another for each seed."""
    y, x = np.mgrid[: SIZE[0], : SIZE[1]]
    waves = [np.sin((x * (k + seed) + y * (3 - k)) / 40) for k in range(3)]
    return (140 + 80 * np.stack(waves, axis=-1)).astype(np.uint8)


def wrong_one() -> np.ndarray:
    """The first picture with two places that differ."""
    wrong = picture(1)
    wrong[50:80, 60:120] = 255 - wrong[50:80, 60:120]
    wrong[200:210, 300:320] //= 2
    return wrong


def toys() -> list[report.Entry]:
    """One that failed in two places and in a number, one that changed, one that passed."""
    second = picture(2)
    near = second.copy()
    near[100, 200] += np.uint8(12)
    vertices = np.arange(60.0).reshape(20, 3)
    moved = vertices.copy()
    moved[12, 1] += 0.25
    accept = "lietool figures accept"
    return [
        report.entry(
            FAILED,
            expected=picture(1),
            actual=wrong_one(),
            title="Waves",
            word="picture, numbers",
            messages=["picture differs"],
            before={"vertices": vertices},
            after={"vertices": moved},
            accept=f"{accept} {FAILED}",
        ),
        report.entry(CHANGED, expected=second, actual=near, title="More waves", accept=f"{accept} T2"),
        report.entry(PASSED, expected=picture(3), actual=picture(3), title="Still waters"),
    ]


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("report") / "report.html"
    about = {"renderer": "llvmpipe", "date": "today"}
    path.write_text(
        report.build(toys(), title="Toys", about=about, review=f"lietool {_figures_report.REVIEW}"),
        encoding="utf-8",
    )
    return path.as_uri()


@pytest.fixture
def toy(browser: Browser, address: str) -> Iterator[Browser]:
    """The page as it is first opened, on the plate that failed; a test must not make it complain."""
    browser.show()
    browser.open(address)
    browser.js("localStorage.clear()")
    browser.open(address)
    browser.complaints()
    assert browser.ready() == FAILED
    yield browser
    assert browser.complaints() == []


def test_it_opens_on_what_failed_and_asks_for_nothing(toy: Browser, address: str) -> None:
    toy.requested.clear()
    toy.open(address)
    toy.ready()
    assert toy.complaints() == []
    assert {url.partition(":")[0] for url in toy.requested} <= {"file", "data", "about"}
    assert toy.js("return $('.plate.current .verdict').innerText") == "failed: picture, numbers"


def test_the_swipe_shows_one_left_and_the_other_right(toy: Browser) -> None:
    def cut() -> float:
        return float(str(toy.js("return $('.world .actual').style.clipPath.match(/([\\d.]+)px\\)/)[1]")))

    assert toy.mode == "swipe" and cut() == pytest.approx(200, abs=2)
    toy.press("]]]]]")
    assert cut() == pytest.approx(240, abs=4)
    stage = toy.driver.find_element(By.CSS_SELECTOR, ".pane.first")
    ActionChains(toy.driver).move_to_element(stage).click_and_hold().move_by_offset(
        -200, 30
    ).release().perform()
    box = toy.js("return $('.pane.first').getBoundingClientRect().width")
    assert isinstance(box, int | float)
    assert toy.js("return Number($('#_split').value)") == pytest.approx(50 - 100 * 200 / box, abs=1)
    toy.js("$('#_split').focus()")
    before = cut()
    toy.press(Keys.ARROW_LEFT)
    assert cut() < before


def test_it_blinks_until_it_is_paused(toy: Browser) -> None:
    toy.show(still=False)
    toy.press("2")
    assert toy.mode == "blink"
    for part in ("actual", "expected", "actual"):
        toy.wait(f"$('.pane.first .tag.left').textContent === '{part}'")
        assert toy.js("return seen($('.world .actual'))") == (part == "actual")
    toy.press(" ")
    shown = toy.js("return $('.tag.left').textContent")
    time.sleep(1.0)
    assert toy.js("return $('.tag.left').textContent") == shown
    toy.press(" ")
    assert toy.js("return $('.tag.left').textContent") != shown


def test_nothing_blinks_by_itself_where_motion_is_unwanted(toy: Browser) -> None:
    toy.click("[data-mode=blink]")
    time.sleep(1.0)
    assert toy.js("return $('.tag.left').textContent") == "expected"
    toy.click("#_pause")
    assert toy.js("return $('.tag.left').textContent") == "actual"


def test_side_by_side_both_are_zoomed_alike(toy: Browser) -> None:
    toy.press("3")
    assert toy.js("return seen($('.pane.second .actual')) && seen($('.pane.first .expected'))") is True
    toy.press("++n")
    places = toy.js("return $$('.world').map((w) => w.style.transform)")
    assert isinstance(places, list) and places[0] == places[1] and "scale" in places[0]
    toy.press("1")
    assert toy.js("return $$('.pane.first .actual').length") == 1


def test_the_difference_is_amplified_as_much_as_one_likes(toy: Browser) -> None:
    toy.press("4")
    first, wrong = picture(1), wrong_one()
    wanted = explain.amplified(first, wrong)
    for x, y in ((10, 10), (61, 51), (119, 79), (200, 150)):
        assert np.abs(np.array(toy.pixel("canvas.difference", x, y)) - wanted[y, x]).max() <= 1
    toy.press(",,,,")
    assert toy.js("return $('#_gain + output').textContent") == "1×"
    ghost = 128 + 0.15 * (first[60, 90].mean() - 128)
    off = ghost + wrong[60, 90].astype(float) - first[60, 90]
    assert np.abs(np.array(toy.pixel("canvas.difference", 90, 60)) - off.clip(0, 255)).max() <= 1


def test_the_map_of_similarity_lies_over_the_golden(toy: Browser) -> None:
    toy.press("5")
    assert toy.mode == "ssim"
    assert toy.js(
        "return seen($('.world .ssim')) && seen($('.world .expected')) && !seen($('.world .actual'))"
    )


def test_the_loupe_tells_both_colours_and_their_distance(toy: Browser) -> None:
    toy.press("s")
    toy.press(Keys.ARROW_LEFT)
    said = toy.js("return $('.point').textContent")
    found = compare.images(picture(1), wrong_one())
    assert found.largest_delta_e_at is not None
    x, y = found.largest_delta_e_at
    far = compare.delta_e76(picture(1)[y, x - 1], wrong_one()[y, x - 1])
    assert str(said).startswith(f"({x - 1}, {y})") and f"dE {float(far):.1f}" in str(said)
    ActionChains(toy.driver).key_down(Keys.SHIFT).send_keys(Keys.ARROW_DOWN).key_up(Keys.SHIFT).perform()
    toy.wait(f"$('.point').textContent.startsWith('({x - 1}, {y + 10})')")
    colours = toy.js("return $$('.loupe figcaption span').map((s) => s.textContent)")
    assert isinstance(colours, list)
    assert colours[0] == "#" + "".join(f"{v:02x}" for v in picture(1)[y + 10, x - 1])
    # The middle of each lens is the pixel itself.
    assert toy.pixel(".loupe [data-part=expected]", 68, 68) == picture(1)[y + 10, x - 1].tolist()


def test_places_that_differ_are_boxed_and_gone_to(toy: Browser) -> None:
    boxes = (60, 50, 120, 80), (300, 200, 320, 210)
    off = np.abs(picture(1).astype(int) - wrong_one()).sum(axis=-1)

    def loupe_is_in(number: int) -> bool:
        """Whether it shows the pixel of a box that is off most."""
        x, y = map(int, re.findall(r"\d+", str(toy.js("return $('.point').textContent")))[:2])
        x0, y0, x1, y1 = boxes[number]
        return x0 <= x < x1 and y0 <= y < y1 and off[y, x] == off[y0:y1, x0:x1].max()

    assert toy.js("return $$('.pane.first .blob').length") == 2
    toy.press("n")
    assert toy.js("return $('.pane.first .blob.here').getAttribute('x')") == "57"
    assert loupe_is_in(0)
    toy.press("n")
    assert loupe_is_in(1)
    toy.click(".plate.current .places li:first-child .go")
    assert loupe_is_in(0)
    toy.press("b")
    assert toy.js("return seen($('.pane.first .blob'))") is False
    toy.press("0")
    assert toy.js("return $('#_scale').textContent") == "Fit"
    toy.click(".plate.current .tolerance .go")
    assert toy.js("return $('#_scale').textContent") != "Fit"


def test_it_is_zoomed_by_wheel_and_keys_and_dragged(toy: Browser) -> None:
    toy.press("4")
    toy.press("+")
    scale = toy.js("return $('#_scale').textContent")
    toy.press("++")
    assert toy.js("return $('#_scale').textContent") != scale
    before = toy.js("return $('.world').style.transform")
    stage = toy.driver.find_element(By.CSS_SELECTOR, ".pane.first")
    ActionChains(toy.driver).move_to_element(stage).click_and_hold().move_by_offset(
        40, 20
    ).release().perform()
    assert toy.js("return $('.world').style.transform") != before
    toy.press(Keys.ESCAPE)
    assert toy.js("return $('#_scale').textContent") == "Fit"
    toy.js(
        "$('.pane.first').dispatchEvent(new WheelEvent('wheel', { deltaY: -300, ctrlKey: true, bubbles: true,"
        " cancelable: true, clientX: 700, clientY: 300 }))"
    )
    assert toy.js("return $('#_scale').textContent") != "Fit"


def test_the_filter_shows_one_kind_and_search_finds(toy: Browser) -> None:
    assert toy.listed == [FAILED, CHANGED, PASSED]
    for kind, name in (("failed", FAILED), ("changed", CHANGED), ("passed", PASSED)):
        toy.click(f"[data-filter={kind}]")
        assert toy.listed == [name] and toy.ready() == name
    toy.press("f")
    assert toy.listed == [FAILED, CHANGED, PASSED]
    for text, found in (
        ("waves", [FAILED, CHANGED]),
        ("still", [PASSED]),
        ("vertices", [FAILED]),
        ("zz", []),
    ):
        toy.press("/")
        toy.press(text)
        assert toy.listed == found
        assert toy.js("return seen($('#_none'))") == (not found)
        toy.press(Keys.ESCAPE)
        toy.press(Keys.ESCAPE)
    assert toy.listed == [FAILED, CHANGED, PASSED]
    toy.press("/")
    toy.press("still", Keys.ENTER)
    assert toy.ready() == PASSED


def test_one_goes_through_the_plates_by_keys_and_by_address(toy: Browser, address: str) -> None:
    toy.press("j")
    assert toy.ready() == CHANGED
    assert toy.js("return $('[data-mode=ssim]').disabled && !$('[data-mode=swipe]').disabled") is True
    toy.press("j")
    assert toy.ready() == PASSED and toy.mode == "single"
    assert toy.js("return seen($('.modes'))") is False
    toy.press("jkk")
    assert toy.ready() == FAILED
    toy.press("j")
    linked = str(toy.js("return location.href"))
    toy.open(linked)
    assert toy.ready() == CHANGED


def test_help_and_theme_by_keys_and_single_keys_can_be_left_out(toy: Browser) -> None:
    toy.press("?")
    assert toy.js("return $('#_help').open") is True
    toy.press(Keys.ESCAPE)
    toy.press("t")
    assert toy.js("return getComputedStyle(document.body).backgroundColor") == "rgb(20, 22, 26)"
    toy.press("?")
    toy.click("#_single")
    toy.press(Keys.ESCAPE)
    toy.press("j")
    assert toy.ready() == FAILED


def test_a_changed_number_is_told_with_its_vertex(toy: Browser) -> None:
    text = str(toy.js("return $('.plate.current .numbers').innerText"))
    assert "vertices" in text and "vertex 12, y" in text and "+0.25" in text and "5.9e-08 allowed" in text


def test_what_is_marked_is_kept_reviewed_and_downloaded(toy: Browser) -> None:
    toy.press("a", Keys.ENTER)
    assert toy.js("return $('.plate.current .accept input').validationMessage") != ""
    toy.press("it's  a better wave", Keys.ENTER)
    assert toy.js("return $('#_review').innerText") == "Review 1"
    # The browser keeps it a moment later: what is loaded anew before then may lose it.
    time.sleep(1.0)
    toy.driver.refresh()
    assert toy.ready() == FAILED and toy.js("return $('#_review').innerText") == "Review 1"
    toy.press("j")
    toy.ready()
    toy.press("a", "so be it", Keys.ENTER)
    toy.press("r")
    assert toy.js("return $('#_reviewing').open") is True
    assert toy.js("return $('#_from').textContent") == "lietool figures accept --from review.json"
    assert toy.js("return $('#_each').textContent") == (
        f"lietool figures accept {FAILED} --reason 'it'\\''s a better wave'\n"
        "lietool figures accept T2 --reason 'so be it'"
    )
    toy.click("#_download")
    path = toy.downloads / "review.json"
    WebDriverWait(toy.driver, 10, 0.05).until(lambda _: path.is_file() and path.stat().st_size)
    found = json.loads(path.read_text(encoding="utf-8"))
    path.unlink()
    wanted = {entry.name: entry.digests for entry in toys()}
    assert found["review"] == 1
    assert [(m["plate"], m["reason"], (m["picture"], m["numbers"])) for m in found["accept"]] == [
        (FAILED, "it's a better wave", wanted[FAILED]),
        (CHANGED, "so be it", wanted[CHANGED]),
    ]
    toy.click(".marks li:first-child button")
    assert toy.js("return $$('.marks li').length") == 1
    toy.press(Keys.ESCAPE)
    assert toy.js("return $('#_review').innerText") == "Review 1"


def test_another_reason_is_another_mark(toy: Browser) -> None:
    toy.press("a", "one", Keys.ENTER)
    toy.press("a", " more")
    assert toy.js("return $('#_review').innerText") == "Review 0"


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("dark", [False, True])
def test_nothing_is_wider_than_the_window(toy: Browser, address: str, width: int, dark: bool) -> None:
    toy.show(width, dark=dark)
    toy.open(address)
    names = (FAILED, CHANGED, PASSED)
    for name in names:
        toy.js("location.hash = encodeURIComponent(arguments[0])", name)
        toy.wait("$('.plate.current')?.id === decodeURIComponent(location.hash.slice(1))")
        toy.ready()
        for number in "12345":
            toy.press(number)
            assert toy.js("return document.documentElement.scrollWidth") == toy.js("return innerWidth") or (
                toy.js("return document.documentElement.scrollWidth <= document.documentElement.clientWidth")
            )
        outside = toy.js(
            "return $$('.plate.current *').filter((e) => seen(e) && !e.closest('.pane, .scroll') &&"
            " e.getBoundingClientRect().right > innerWidth + 1).map((e) => e.outerHTML.slice(0, 80))"
        )
        assert outside == []


def test_a_narrow_page_is_a_list_first_and_comes_back_to_it(toy: Browser, address: str) -> None:
    toy.show(400)
    toy.open(address)
    assert toy.listed == [FAILED, CHANGED, PASSED] and toy.js("return seen($('main'))") is False
    toy.click(".list li:nth-child(2) a")
    assert toy.ready() == CHANGED and toy.js("return seen($('.list'))") is False
    toy.click(".plate.current .back")
    toy.wait("seen($('.list'))")
    assert toy.js("return document.activeElement.closest('li').innerText").startswith(CHANGED)  # type: ignore[union-attr]


def test_what_has_one_picture_none_or_two_sizes_is_shown_as_far_as_it_goes(
    browser: Browser, tmp_path: Path
) -> None:
    small = picture(1)[:100, :120]
    entries = [
        report.entry("sizes", expected=picture(1), actual=small, messages=["size"]),
        report.entry("new 100%", expected=None, actual=small, messages=["missing"]),
        report.entry("gone", expected=None, actual=None, messages=["undrawn"]),
    ]
    path = tmp_path / "report.html"
    path.write_text(report.build(entries, title="Odd", about={}, notes=["a note"]), encoding="utf-8")
    browser.show()
    browser.complaints()
    browser.open(path.as_uri())
    assert browser.ready() == "sizes"
    off = browser.js("return $$('.modes button').filter((b) => b.disabled).map((b) => b.dataset.mode)")
    assert off == ["difference", "ssim"]
    browser.press("3s", Keys.ARROW_LEFT, "j")
    assert browser.ready() == "new 100%" and browser.mode == "single"
    assert browser.js("return seen($('.world .actual')) && $('.tag.left').textContent") == "now"
    browser.press("j")
    assert browser.js("return $('.plate.current').id") == "gone"
    assert browser.js("return seen($('#_viewer'))") is False
    browser.press("n123 ]+0k")
    assert browser.ready() == "new 100%"
    assert browser.complaints() == []


def test_everything_that_can_be_pressed_has_a_name(toy: Browser) -> None:
    nameless = toy.js(
        "return $$('button, input, a').filter((e) =>"
        " !(e.textContent.trim() || e.ariaLabel || e.labels?.length))"
        ".map((e) => e.outerHTML.slice(0, 90))"
    )
    assert nameless == []
    assert toy.js("return new Set($$('[id]').map((e) => e.id)).size === $$('[id]').length") is True


@pytest.fixture(scope="module")
def everything(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Our own goldens, for which nothing is drawn: most are equal, one is not."""
    entries = []
    for item in _studio.items():
        if item.place.png.is_file():
            entries.append(
                report.Entry(
                    item.id, item.plate.title, "passed", "equal", expected=item.place.png.read_bytes()
                )
            )
    golden = store.read(_studio.items([entries[5].name])[0].place).image
    wrong = golden.copy()
    wrong[300:340, 500:600] //= 2
    entries[5] = report.entry(entries[5].name, expected=golden, actual=wrong)
    path = tmp_path_factory.mktemp("all") / "report.html"
    path.write_text(report.build(entries, title="All", about={}), encoding="utf-8")
    return path


def test_all_our_plates_are_on_one_page_that_opens_at_once(browser: Browser, everything: Path) -> None:
    assert everything.stat().st_size < 30e6
    browser.show(400)
    browser.open(everything.as_uri())
    browser.wait("seen($('.list'))")
    outside = browser.js(
        "const edge = document.documentElement.clientWidth;"
        " return $$('.rail *').filter((e) => seen(e) && e.getBoundingClientRect().right > edge)"
        ".map((e) => e.outerHTML.slice(0, 80))"
    )
    assert outside == []
    browser.show()
    browser.complaints()
    start = time.perf_counter()
    browser.open(everything.as_uri())
    browser.ready()
    # About half a second on an idle machine.
    assert time.perf_counter() - start < 10
    names = browser.listed
    assert len(names) == len([item for item in _studio.items() if item.place.png.is_file()])
    assert browser.ready() == names[5]
    browser.js("location.hash = arguments[0]", names[0])
    browser.wait(f"$('.plate.current').id === '{names[0]}'")
    for name in names:
        assert browser.ready() == name
        assert browser.js("return $('.world .expected').naturalWidth") == 1200
        browser.press("j")
    assert browser.complaints() == []
