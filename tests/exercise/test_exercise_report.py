"""The pages of graded submissions: what they say, and how they work in a browser, narrow and wide."""

import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

from lietool.golden import marks_page

_FLAGS = (
    *("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--force-color-profile=srgb"),
)
_ABOUT = {
    **{"exercise": "square-root", "title": "The root", "marks": 0, "of": 4, "diagnosis": [], "seed": 0},
    **{"digest": "0" * 64, "printed": "", "trouble": "", "picture": None},
}


def test_one_submission_is_one_page(submit, exercise) -> None:
    submit("half")
    said = exercise("check", "half.py", "--report", "report", code=5).stdout
    assert "report/index.html is written." in said and len(list(Path("report").iterdir())) == 1
    page = Path("report/index.html").read_text()
    assert "<strong>0</strong> of 10 points" in page and "This is half of x; (2.1) wants its root." in page
    assert page.count("data:image/png;base64,") == 2 and "a ValueError" in page
    # It goes to a student as it is.
    assert not re.search(r'(src|href)="(?!data:|#)', page) and "http" not in page.replace(
        "http://www.w3.org", ""
    )
    exercise("check", "half.py", "--report", "again", code=5)
    assert Path("again/index.html").read_text() == page


def test_a_class_has_a_table_and_a_page_each(submit, exercise) -> None:
    for body in ("right", "half", "broken"):
        submit(body)
    files = ("right.py", "half.py", "broken.py", "missing.py")
    exercise("check", *files, "--report", "report", "--jobs", 2, code=5)
    assert {path.name for path in Path("report").iterdir()} == {
        *("index.html", "right.html", "half.html", "broken.html")
    }
    index = Path("report/index.html").read_text()
    assert re.findall(r'<a href="(.*?)">', index) == ["broken.html", "half.html", "right.html"]
    assert "there is no such file" in index and "4 submissions: 25% of the points" in index
    # What is the plate to the last bit is in its page once.
    assert Path("report/right.html").read_text().count("data:image/png;base64,") == 1
    assert "SyntaxError" in Path("report/broken.html").read_text()


def test_what_a_student_writes_is_text(submit, exercise) -> None:
    submit("rude", "<i>&.py")
    exercise("check", "<i>&.py", "--report", "report", code=5)
    page = Path("report/index.html").read_text()
    assert "<script>alert" not in page and "<b>" not in page and "<i>&.py" not in page
    assert "&lt;script&gt;alert()" in page and "&lt;i&gt;&amp;.py" in page
    row = {"file": "<x>", "href": '"><x>', "marks": "<x>", "checks": [], "says": "<x>"}
    made = marks_page.of_class("<x>", ["<x>"], [{"title": "<x>", "checks": ["<x>"], "rows": [row]}], ["<x>"])
    assert "<x>" not in made


def test_who_gets_a_page_does_not_see_folders(submit, exercise) -> None:
    for file in ("secret/a/x.py", "secret/b/y.py"):
        submit("right", file)
    exercise("check", "secret/a/x.py", "secret/b/y.py", "--report", "report")
    assert "secret" not in Path("report/x.html").read_text()
    index = Path("report/index.html").read_text()
    assert '<a href="x.html">a/x.py</a>' in index and '<a href="y.html">b/y.py</a>' in index


def test_a_submission_without_a_picture_has_a_page() -> None:
    about = {**_ABOUT, "checks": [], "trouble": "nothing came"}
    page = marks_page.submission(about, file="x.py", expected=None, actual=None, drawn=False)
    assert "nothing came" in page and 'id="_viewer"' not in page


class Browser:
    """What the tests do with a browser."""

    def __init__(self, driver: webdriver.Chrome) -> None:
        self.driver = driver

    def open(self, page: str, width: int, dark: bool) -> None:
        """Load a page at a width, light or dark."""
        size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "", "features": [scheme]})
        self.driver.get(f"file://{Path(page).resolve()}")

    def js(self, code: str) -> object:
        """Return what a script returns."""
        return self.driver.execute_script(f"const $ = (s) => document.querySelector(s); {code}")

    def wait(self, code: str) -> None:
        """Wait until an expression is true."""
        WebDriverWait(self.driver, 10, 0.02).until(lambda _: self.js(f"return Boolean({code})"), code)

    def complaints(self) -> list[str]:
        """Return what the browser has said on its console since it was last asked."""
        return [entry["message"] for entry in self.driver.get_log("browser")]


@pytest.fixture(scope="module")
def browser(chromium: tuple[str, str], tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    options, profile = Options(), tmp_path_factory.mktemp("profile")
    options.binary_location = chromium[0]
    for flag in (*_FLAGS, f"--user-data-dir={profile}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(chromium[1]))
    yield Browser(driver)
    driver.quit()
    shutil.rmtree(profile, ignore_errors=True)


@pytest.fixture
def report(submit: Callable[..., Path], exercise: Callable) -> str:
    """The folder of a class's report."""
    for body in ("right", "half", "blank"):
        submit(body)
    exercise("check", "right.py", "half.py", "blank.py", "--report", "report", code=5)
    return "report"


def test_the_pages_work(report: str, browser: Browser) -> None:
    for page in ("index", "half", "right", "blank"):
        for width in (400, 1200):
            for dark in (False, True):
                browser.open(f"{report}/{page}.html", width, dark)
                # Nothing is to be scrolled sideways.
                room = "const e = document.documentElement; return e.clientWidth - e.scrollWidth"
                assert browser.js(room) == 0, (page, width)
                ground = browser.js("return getComputedStyle(document.body).backgroundColor")
                assert (int(re.findall(r"\d+", str(ground))[0]) < 100) == dark
                assert not browser.complaints()


def test_pictures_are_swiped_and_subtracted(report: str, browser: Browser) -> None:
    browser.open(f"{report}/half.html", 1200, False)
    browser.wait("$('#_viewer').dataset.ready === '_submission'")
    assert browser.js("return [...document.querySelectorAll('.first .tag')].map((e) => e.textContent)") == [
        *("the book's", "yours")
    ]
    assert "inset" in str(browser.js("return $('.world .actual').style.clipPath"))
    browser.js("document.dispatchEvent(new KeyboardEvent('keydown', { key: '4' }))")
    assert browser.js("return $('.stage').dataset.mode") == "difference"
    grey = browser.js(
        "const c = $('canvas.difference'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
        "return [c.width, c.height, new Set(d).size > 2]"
    )
    assert grey == [80, 60, True]
    shown = "[...document.querySelectorAll('.modes button')].filter((e) => e.checkVisibility())"
    assert browser.js(f"return {shown}.map((e) => e.textContent)") == [
        *("Swipe", "Blink", "Side by side", "Difference")
    ]
    assert not browser.complaints()


def test_one_picture_is_said_whose_it_is(report: str, browser: Browser) -> None:
    for page, says in (("right", "yours, the same"), ("blank", "the book's; yours could not be drawn")):
        browser.open(f"{report}/{page}.html", 1200, False)
        browser.wait("$('#_viewer').dataset.ready === '_submission'")
        assert says in str(browser.js("return $('.first .tag.left').textContent"))


def test_light_and_dark_are_chosen(report: str, browser: Browser) -> None:
    for page in ("index", "half"):
        browser.open(f"{report}/{page}.html", 400, False)
        browser.js("$('#_theme').click()")
        assert browser.js("return document.documentElement.dataset.theme") == "dark"
        browser.js("$('#_theme').click()")
    assert not browser.complaints()


def test_the_name_of_a_function_keeps_its_case() -> None:
    check = {"passed": False}
    about = {"picture": {"plate": "R1", "says": "root was not tried again"}, "checks": [check]}
    assert marks_page._sentence(about, drawn=False) == "root was not tried again."
