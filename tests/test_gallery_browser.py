"""The gallery in a real browser, opened from disk: loading, search, copying, keys, themes, widths."""

import base64
import io
import itertools
import json
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

from lietool.gallery import chapters, page, site
from lietool.gallery.entry import Command, Entry, Equation, Picture
from lietool.verbs import _figures_gallery, _studio, equations

# As root a sandbox is refused, and in a container shared memory is short; none may look for updates.
_FLAGS = (
    *("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"),
    *(
        "--disable-background-networking",
        "--disable-component-update",
        "--no-first-run",
        "--force-color-profile=srgb",
    ),
)
WIDTHS = (400, 1000, 1600)


class Browser:
    """What the tests do with a browser."""

    def __init__(self, driver: webdriver.Chrome) -> None:
        self.driver = driver
        self.requested: list[str] = []
        grants = {"permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"]}
        driver.execute_cdp_cmd("Browser.grantPermissions", grants)

    def js(self, code: str, *arguments: object) -> object:
        """Return what a script returns; the elements that the tests name are at hand."""
        names = "const $ = (s) => document.querySelector(s), $$ = (s) => [...document.querySelectorAll(s)];"
        return self.driver.execute_script(names + code, *arguments)

    def wait(self, code: str) -> None:
        """Wait until an expression is true."""
        WebDriverWait(self.driver, 10, 0.02).until(lambda _: self.js(f"return Boolean({code})"), code)

    def show(self, width: int = 1000, height: int = 900, *, dark: bool = False, still: bool = True) -> None:
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
        self.driver.switch_to.active_element.send_keys(*keys)

    def type(self, text: str) -> None:
        """Search."""
        self.js("$('#_query').focus(); $('#_query').select();")
        self.press(text)

    @property
    def seen(self) -> list[str]:
        """The plates that can be seen, in their order."""
        found = self.js("return $$('.grid .plate').filter((p) => p.offsetParent).map((p) => p.id)")
        assert isinstance(found, list)
        return found

    @property
    def focused(self) -> str:
        """The plate that has the focus."""
        return str(self.js("return document.activeElement.closest('.plate')?.id ?? ''"))

    def complaints(self) -> list[str]:
        """What the console says since the last call; and what was asked for is noted."""
        for line in self.driver.get_log("performance"):
            message = json.loads(line["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                self.requested.append(message["params"]["request"]["url"])
        return [line["message"] for line in self.driver.get_log("browser")]


@pytest.fixture(scope="module")
def browser(chromium: tuple[str, str]) -> Iterator[Browser]:
    options = Options()
    options.binary_location = chromium[0]
    for flag in _FLAGS:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    with pytest.MonkeyPatch.context() as patch:
        # The driver is on this machine, whatever leads out of it.
        patch.setenv("no_proxy", "localhost,127.0.0.1")
        driver = webdriver.Chrome(options=options, service=Service(chromium[1]))
        try:
            yield Browser(driver)
        finally:
            driver.quit()


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The page of our own plates with their accepted pictures, for which nothing is drawn."""
    folder = tmp_path_factory.mktemp("gallery") / "page"
    accepted = [item for item in _studio.items() if item.place.png.is_file()]
    _figures_gallery.run(accepted, _studio.Studio(), folder, golden=True)
    return (folder / site.PAGE).as_uri()


@pytest.fixture
def home(browser: Browser, address: str) -> Iterator[Browser]:
    """The page as it is first opened; what a test does must not make it complain."""
    browser.show()
    browser.open(address)
    browser.complaints()
    yield browser
    assert browser.complaints() == []


@pytest.fixture
def toy(browser: Browser, tmp_path: Path) -> Iterator[Browser]:
    """A page of plates whose pictures are of both themes."""

    def picture(grey: int) -> Picture:
        file = io.BytesIO()
        Image.fromarray(np.full((9, 12, 3), grey, np.uint8)).save(file, "PNG")
        return Picture(file.getvalue(), 12, 9)

    equation = Equation("B 4.27", "Twice.", "exp", equations.tex()["B 4.27"])
    entries = [
        Entry(
            *(plate, "dots", chapters.chapter(plate, "ch9"), plate, "A caption.", (equation,)),
            (Command("the picture", f"lietool dots --plate {plate}"),),
            numbers_file=b"{}",
            pictures={"light": picture(200 + i), "dark": picture(10 + i)},
        )
        for i, plate in enumerate(("T1", "T2"))
    ]
    text, assets = page.build(entries, tmp_path)
    site.publish(tmp_path, text, assets)
    browser.show()
    browser.open((tmp_path / site.PAGE).as_uri())
    browser.complaints()
    yield browser
    assert browser.complaints() == []


class TestLoading:
    def test_it_loads_without_an_error_and_asks_for_nothing_beyond_its_folder(self, browser, address):
        browser.show()
        browser.open(address)
        browser.js("$$('img').forEach((image) => { image.loading = 'eager'; })")
        browser.wait("$$('img').every((image) => image.complete)")
        assert browser.complaints() == []
        folder = address.rpartition("/")[0]
        outside = [url for url in browser.requested if not url.startswith((folder, "data:", "about:"))]
        assert browser.requested and not outside

    def test_no_picture_is_missing_and_each_says_what_it_shows(self, home):
        home.js("$$('img').forEach((image) => { image.loading = 'eager'; })")
        home.wait("$$('img').every((image) => image.complete)")
        images = home.js("return $$('.grid img').map((i) => [i.closest('.plate').id, i.naturalWidth, i.alt])")
        assert len(images) == len(home.seen) > 5
        assert not [plate for plate, width, words in images if width < 1000 or len(words) < 60]

    def test_every_equation_that_is_listed_is_set(self, home):
        sizes = home.js(
            "return $$('.grid .equations svg.tex')"
            ".map((s) => [s.getAttribute('aria-label'), s.viewBox.baseVal.width])"
        )
        count = home.js("return $$('.grid .equations li').length")
        assert len(sizes) == count > 10 and all(label and width > 500 for label, width in sizes)
        home.js("location.hash = '#B4.2'")
        home.wait("$('#_large').open")
        boxes = home.js("return $$('#_large svg.tex use').map((u) => u.getBoundingClientRect().width)")
        assert len(boxes) == 4 and all(width > 40 for width in boxes)

    def test_the_command_is_that_of_the_plate(self, home):
        assert home.js("return $('#GL2 .command code').textContent") == "lietool gimbal --plate GL2"

    def test_links_lead_to_files(self, home, address):
        links = home.js("return $$('.plate .links a').map((a) => a.href)")
        assert links and all(Path(url.removeprefix("file://")).is_file() for url in links)

    def test_headings_names_and_ids(self, home):
        assert home.js("return document.documentElement.lang") == "en"
        levels = home.js(
            "return $$('h1, h2, h3, h4').filter((h) => !h.closest('dialog')).map((h) => +h.tagName[1])"
        )
        assert levels[0] == 1 and all(b - a <= 1 for a, b in itertools.pairwise(levels))
        unnamed = home.js(
            "return $$('button, a[href], input')"
            ".filter((e) => !(e.getAttribute('aria-label') || e.textContent.trim())).map((e) => e.outerHTML)"
        )
        assert unnamed == []
        assert home.js("const ids = $$('[id]').map((e) => e.id); return ids.length === new Set(ids).size")

    def test_who_wants_no_motion_has_none(self, home):
        assert home.js("return getComputedStyle(document.documentElement).scrollBehavior") == "auto"
        home.show(still=False)
        assert home.js("return getComputedStyle(document.documentElement).scrollBehavior") == "smooth"

    def test_in_print_all_is_shown_and_no_tool(self, home):
        home.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        assert home.js("return $$('.plate .equations').every((e) => e.offsetParent)")
        assert home.js("return [$('.bar'), $('.copy')].every((e) => !e.offsetParent)")
        done = home.driver.execute_cdp_cmd("Page.printToPDF", {"paperWidth": 8.27, "paperHeight": 11.69})
        assert base64.b64decode(done["data"]).startswith(b"%PDF")


class TestWidths:
    @pytest.mark.parametrize("width", WIDTHS)
    def test_nothing_scrolls_sideways(self, home, width):
        home.show(width)
        sizes = home.js("return [document.scrollingElement.scrollWidth, innerWidth]")
        assert sizes[0] <= sizes[1] == width
        home.js("$$('details').forEach((d) => { d.open = true; })")
        wide = home.js(
            "const wide = [];"
            "for (const { hash } of $$('.grid .open')) {"
            "  location.hash = hash; dispatchEvent(new Event('hashchange'));"
            "  for (const box of [document.scrollingElement, $('.stage'), $('.stage .text')])"
            "    if (box.scrollWidth > box.clientWidth) wide.push(`${hash} ${box.className}`);"
            "}"
            "return wide"
        )
        assert wide == []

    @pytest.mark.parametrize(("width", "columns"), [(400, 1), (1000, 2), (1600, 3)])
    def test_plates_stand_beside_each_other_where_there_is_room(self, home, width, columns):
        home.show(width)
        lefts = home.js("return $$('.grid .plate').filter((p) => p.offsetParent).map((p) => p.offsetLeft)")
        assert len(set(lefts)) == columns

    def test_the_large_view_is_as_large_as_the_window_lets_it_be(self, home):
        home.show(1600, 1000)
        home.js("location.hash = '#B4.2'")
        home.wait("$('#_large').open && $('#_large img').naturalWidth")
        box = home.js(
            "const b = $('#_large img').getBoundingClientRect(); return [b.width, b.height, b.bottom]"
        )
        assert box[0] > 1000 and abs(box[0] / box[1] - 4 / 3) < 0.02 and box[2] <= 1000


class TestSearch:
    def test_it_finds(self, home):
        for text, first, others in (
            ("B4.2", "B4.2", {"B4.2b"}),
            ("b4.2B", "B4.2b", set()),
            ("4.2", "B4.2", {"B4.2b"}),
            ("(4.27)", "B4.2", {"B4.2b"}),
            ("4.27", "B4.2", {"B4.2b"}),
            ("eq. (2.33)", "B2.8", set()),
            ("K 6", "KT1", set()),
            ("K (6)", "KT1", set()),
            ("q0", "B2.8", None),
            ("gimbal", "GL1", {"GL2"}),
            ("SLERP exponential", "B2.8", None),
            ("four stages", "B4.2", None),
        ):
            home.type(text)
            seen = home.seen
            assert seen[0] == first and (others is None or set(seen[1:]) == others), text
            count = "1 plate" if len(seen) == 1 else f"{len(seen)} plates"
            assert home.js("return $('#_count').textContent") == count, text

    def test_an_equation_finds_every_plate_that_shows_it_and_no_other(self, home):
        cited = home.js(
            "return Object.fromEntries($$('.plate').map((p) => [p.id, p.dataset.equations.split(' ')]))"
        )
        for number in ("4.27", "2.22", "k6"):
            home.type(f"({number})")
            assert set(home.seen) == {plate for plate, numbers in cited.items() if number in numbers}

    def test_nothing_found_is_said_and_helps(self, home):
        home.type("xyzzy")
        assert home.seen == [] and home.js("return $('#_none').offsetParent !== null")
        home.driver.find_element(By.CSS_SELECTOR, "#_none [data-find='(4.27)']").click()
        assert home.seen[0] == "B4.2" and home.js("return $('#_query').value") == "(4.27)"

    def test_an_empty_search_brings_all_back_in_order(self, home):
        before = home.seen
        home.type("4.27")
        home.press(Keys.ESCAPE)
        assert home.seen == before and home.js("return $('#_query').value") == ""

    def test_the_number_of_an_equation_leads_to_its_plates(self, home):
        home.js("location.hash = '#B4.2b'")
        home.wait("$('#_large').open")
        home.driver.find_element(By.CSS_SELECTOR, "#_large [data-find='(4.30)']").click()
        assert not home.js("return $('#_large').open") and set(home.seen) == {"B4.2", "B4.2b"}


class TestCopying:
    def click(self, home: Browser) -> str:
        home.js("location.hash = '#GL2'")
        home.wait("$('#_large').open")
        home.driver.find_element(By.CSS_SELECTOR, "#_large .copy").click()
        home.wait("$('#_large .copy').textContent !== 'Copy'")
        return str(home.js("return $('#_large .copy').textContent"))

    def test_it_copies(self, home):
        assert self.click(home) == "Copied"
        assert home.js("return navigator.clipboard.readText()") == "lietool gimbal --plate GL2"

    def test_it_copies_where_the_clipboard_is_denied(self, home):
        home.js(
            "window.kept = navigator.clipboard; kept.writeText('other');"
            "Object.defineProperty(navigator, 'clipboard', { value: undefined, configurable: true })"
        )
        assert self.click(home) == "Copied"
        assert home.js("return kept.readText()") == "lietool gimbal --plate GL2"
        assert home.js("return $('textarea')") is None

    def test_else_the_command_is_selected_to_be_copied_by_hand(self, home):
        home.js("navigator.clipboard.writeText = () => Promise.reject(); document.execCommand = () => false")
        assert self.click(home) == "Ctrl+C"
        assert home.js("return getSelection().toString()") == "lietool gimbal --plate GL2"


class TestKeys:
    def test_slash_leads_to_the_search_and_escape_out_of_it(self, home):
        home.press("/")
        assert home.js("return document.activeElement.id") == "_query"
        home.press("a/b")
        assert home.js("return $('#_query').value") == "a/b"
        home.press(Keys.ESCAPE)
        home.press(Keys.ESCAPE)
        assert home.js("return document.activeElement.id") != "_query"

    def test_arrows_and_letters_move_between_plates(self, home):
        order = home.seen
        home.press(Keys.ARROW_RIGHT)
        assert home.focused == order[0]
        home.press(Keys.ARROW_RIGHT, "j")
        assert home.focused == order[2]
        home.press("k", Keys.ARROW_LEFT, Keys.ARROW_LEFT)
        assert home.focused == order[0]

    def test_up_and_down_keep_to_the_column(self, home):
        home.press(Keys.ARROW_RIGHT)
        left = home.js("return document.activeElement.closest('.plate').getBoundingClientRect().left")
        first = home.focused
        home.press(Keys.ARROW_DOWN)
        assert home.focused not in ("", first)
        assert home.js("return document.activeElement.closest('.plate').getBoundingClientRect().left") == left
        home.press(Keys.ARROW_UP)
        assert home.focused == first

    def test_the_focus_can_be_seen(self, home):
        home.press(Keys.ARROW_RIGHT)
        plain, marked = home.js(
            "return $$('.grid .paper').slice(0, 2).reverse().map((p) => getComputedStyle(p).boxShadow)"
        )
        assert plain != marked
        home.press(Keys.TAB)
        home.press(Keys.SHIFT, Keys.TAB)

    def test_enter_opens_arrows_turn_and_escape_closes(self, home):
        home.press(Keys.ARROW_RIGHT)
        home.press(Keys.ENTER)
        home.wait("$('#_large').open")
        order = home.seen
        assert home.js("return $('#_large').contains(document.activeElement)")
        assert home.js("return $('#_large .number').firstChild.textContent.trim()") == order[0]
        assert home.js("return $('#_large .previous').disabled")
        home.press(Keys.ARROW_RIGHT)
        home.wait(f"$('#_large .number').textContent.includes('{order[1]}')")
        home.press("k")
        home.wait(f"$('#_large .number').textContent.includes('{order[0]}')")
        home.press("j", "j")
        home.wait(f"$('#_large .number').textContent.includes('{order[2]}')")
        home.press(Keys.ESCAPE)
        home.wait("!$('#_large').open")
        home.wait(f"document.activeElement.closest('.plate')?.id === '{order[2]}'")
        assert home.js("return location.hash") == ""

    def test_enter_in_the_search_opens_the_first_and_closing_leads_back_to_it(self, home):
        home.press("/")
        home.press("(4.27)", Keys.ENTER)
        home.wait("$('#_large').open")
        assert home.js("return $('.where').textContent") == "1 of 2"
        home.press(Keys.ESCAPE)
        home.wait("document.activeElement.closest('.plate')?.id === 'B4.2'")
        assert not home.js("return $('#_large').open") and home.seen == ["B4.2", "B4.2b"]

    def test_tab_begins_with_the_way_past_everything_and_stays_in_the_large_view(self, home):
        home.js("document.activeElement.blur()")
        home.press(Keys.TAB)
        assert home.js("return document.activeElement.className") == "skip"
        assert home.js("return document.activeElement.getBoundingClientRect().top") >= 0
        home.press(Keys.ENTER)
        home.press(Keys.TAB)
        assert home.focused == home.seen[0]
        home.press(Keys.ENTER)
        home.wait("$('#_large').open")
        inside = set()
        for _ in range(30):
            home.press(Keys.TAB)
            inside.add(
                home.js(
                    "const e = document.activeElement; return e === document.body || $('#_large').contains(e)"
                )
            )
        assert inside == {True}


class TestLargeView:
    def test_a_link_to_a_plate_opens_it_and_the_button_closes_it(self, browser, address):
        browser.show()
        browser.open(f"{address}#B4.2")
        browser.wait("$('#_large').open")
        assert browser.js("return $('#_large').getAttribute('aria-label')").startswith(
            "B4.2: The exponential map"
        )
        browser.driver.find_element(By.CSS_SELECTOR, "#_large .close").click()
        browser.wait("document.activeElement.closest('.grid .plate')?.id === 'B4.2'")
        assert not browser.js("return $('#_large').open") and browser.complaints() == []

    def test_a_click_on_a_plate_opens_it_and_the_way_back_closes_it(self, home):
        picture = home.driver.find_element(By.CSS_SELECTOR, "#GL1 .paper")
        ActionChains(home.driver).scroll_to_element(picture).move_to_element(picture).click().perform()
        home.wait("$('#_large').open")
        home.driver.back()
        home.wait("!$('#_large').open")

    def test_its_buttons_turn(self, home):
        home.js("location.hash = '#GL1'")
        home.wait("$('#_large').open")
        home.driver.find_element(By.CSS_SELECTOR, "#_large .next").click()
        home.wait("$('#_large .number').textContent.includes('GL2')")


class TestThemes:
    def shade(self, browser: Browser) -> list[bool]:
        """Whether the ground is dark, and the picture is the dark one."""
        browser.wait("$('img').complete && $('img').currentSrc")
        seen = browser.js("return [getComputedStyle(document.body).backgroundColor, $('img').currentSrc]")
        levels = [int(level) for level in seen[0].removeprefix("rgb(").rstrip(")").split(",")]
        return [max(levels) < 60, "-dark." in seen[1]]

    def reloaded(self, browser: Browser) -> list[bool]:
        """The same of the page loaded anew."""
        browser.driver.refresh()
        return self.shade(browser)

    def test_it_follows_the_system(self, toy):
        assert self.shade(toy) == [False, False]
        toy.show(dark=True)
        toy.wait("$('img').currentSrc.includes('-dark')")
        assert self.shade(toy) == [True, True]
        toy.js("location.hash = '#T2'")
        toy.wait("$('#_large').open && $('#_large img').currentSrc.includes('-dark')")

    def test_a_choice_is_remembered_and_beats_the_system(self, toy):
        toy.driver.find_element(By.ID, "_theme").click()
        toy.wait("$('img').currentSrc.includes('-dark')")
        assert self.shade(toy) == [True, True]
        assert toy.js("return $('#_theme').getAttribute('aria-pressed')") == "true"
        # The browser keeps it a moment later: what is loaded anew before then may lose it, or not see it yet.
        time.sleep(1.0)
        WebDriverWait(toy.driver, 10, 0.2).until(lambda _: self.reloaded(toy) == [True, True])
        toy.driver.find_element(By.ID, "_theme").click()
        toy.show(dark=True)
        toy.wait("!$('img').currentSrc.includes('-dark')")
        assert self.shade(toy) == [False, False]
        toy.js("localStorage.clear()")

    @pytest.mark.parametrize("dark", [False, True])
    def test_text_can_be_read(self, toy, dark):
        """The contrast that WCAG asks of text, of every colour of text on its ground."""
        toy.show(dark=dark)
        toy.js("location.hash = '#T1'")
        toy.wait("$('#_large').open")
        code = """
            const channel = (c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
            const parse = (text) => text.match(/[\\d.]+/g).map(Number);
            const light = ([r, g, b]) =>
                0.2126 * channel(r / 255) + 0.7152 * channel(g / 255) + 0.0722 * channel(b / 255);
            const ground = (e) => {
                for (; e; e = e.parentElement) {
                    const color = parse(getComputedStyle(e).backgroundColor);
                    if (color.length === 3 || color[3] === 1) return color;
                }
            };
            const poor = [];
            for (const element of $$('body *')) {
                const own = [...element.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
                if (!own || !element.offsetParent || element.disabled) continue;
                const [a, b] = [light(parse(getComputedStyle(element).color)), light(ground(element))];
                const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
                if (ratio < 4.5) poor.push(`${element.className || element.tagName}: ${ratio.toFixed(2)}`);
            }
            return poor;
        """
        assert toy.js(code) == []
