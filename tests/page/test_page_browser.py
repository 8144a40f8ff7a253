"""A page in a real browser, from file:// with the network cut: seen, turned, cut, leaned, read.

The part is the block of ``closed_form_parts``: 20 mm wide, walls of 2 mm, on a base plate.
"""

from __future__ import annotations

import io
import json
import math
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from closed_form_parts import hollow_result
from PIL import Image

from printprep.check.catalogue import finding
from printprep.page.build import page_of_result
from printprep.page.content import Source
from printprep.page.document import document
from printprep.profiles import load_profile

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.xdist_group("browser")]

WALL = (0xF2, 0x8A, 0x2E)  # the cut through the part
CAVITY = (0x5B, 0x9B, 0xD5)
EVIL = "<script>document.title='taken'</script>"


@dataclass
class Browser:
    """A browser window on a page."""

    driver: object

    def open(self, url: str) -> float:
        """Open a page; the seconds from its start to its first picture, as the page measures it."""
        self.driver.get(url)
        self.wait("return document.documentElement.dataset.ready === 'true'")
        script = "return performance.getEntriesByName('first-picture')[0].startTime / 1000"
        return self.driver.execute_script(script)

    def wait(self, script: str, seconds: float = 30.0) -> object:
        """Wait until a script returns something true."""
        end = time.monotonic() + seconds
        while True:
            found = self.driver.execute_script(script)
            if found:
                return found
            assert time.monotonic() < end, f"never true: {script}"
            time.sleep(0.05)

    def run(self, script: str, *arguments: object) -> object:
        return self.driver.execute_script(script, *arguments)

    def find(self, selector: str):
        return self.driver.find_element("css selector", selector)

    def text(self, selector: str) -> str:
        return self.run("return document.querySelector(arguments[0]).textContent", selector)

    def set(self, selector: str, value: float) -> None:
        """Move a slider, as a hand would: its event and all."""
        self.run(
            "const e = document.querySelector(arguments[0]); e.value = arguments[1];"
            "e.dispatchEvent(new Event('input', {bubbles: true}))",
            selector,
            str(value),
        )

    def press(self, selector: str) -> None:
        """Click, whether or not another element covers it (a radio lies under its label)."""
        self.run("document.querySelector(arguments[0]).click()", selector)

    def rest(self) -> None:
        """Wait until the eye has arrived where it flies to."""
        self.wait("return !document.getElementById('canvas').dataset.moving")

    def picture(self) -> np.ndarray:
        """(h, w, 3) what the viewer shows now, once it rests."""
        self.rest()
        before = None
        for _ in range(40):
            time.sleep(0.12)
            png = self.find("#viewer").screenshot_as_png
            if png == before:
                break
            before = png
        return np.asarray(Image.open(io.BytesIO(png)).convert("RGB")).astype(int)

    def errors(self) -> list[str]:
        """What the console complained about since it was last asked."""
        return [entry["message"] for entry in self.driver.get_log("browser")]


def near(picture: np.ndarray, colour: tuple[int, int, int], slack: int = 6) -> int:
    """How many pixels have a colour."""
    return int((np.abs(picture - np.array(colour)).max(axis=2) <= slack).sum())


@pytest.fixture(scope="module")
def start(chromium):
    """Starts browsers: by size, on a phone, offline or not; all are closed in the end."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    binary, driver_path = chromium
    opened = []

    def begin(*, phone: bool = False, offline: bool = True) -> Browser:
        options = webdriver.ChromeOptions()
        options.binary_location = str(binary)
        for flag in (
            "--headless=new", "--no-sandbox", "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--window-size=1280,900",
            "--hide-scrollbars", "--disable-dev-shm-usage",
        ):  # fmt: skip
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        if phone:
            metrics = {"width": 390, "height": 844, "pixelRatio": 2, "touch": True}
            options.add_experimental_option("mobileEmulation", {"deviceMetrics": metrics})
        driver = webdriver.Chrome(options=options, service=Service(str(driver_path)))
        opened.append(driver)
        if offline:
            driver.execute_cdp_cmd("Network.enable", {})
            cut = {"offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0}
            driver.execute_cdp_cmd("Network.emulateNetworkConditions", cut)
        return Browser(driver)

    yield begin
    for driver in opened:
        driver.quit()


@pytest.fixture(scope="module")
def page_file(tmp_path_factory) -> Path:
    profile = load_profile(overrides={"wall_mm": 2.0})
    result = hollow_result(with_base=True, profile=profile, name=EVIL)
    findings = (
        finding("gap", "A gap.", "Widen it.", at_mm=(10.0, 0.0, 15.0), value=0.1),
        finding(
            "sealed-cavity", "A cavity.", severity="info", at_mm=(0.0, 0.0, 10.0), value=4096.0
        ),
        finding("repaired", "No place.", severity="warning"),
    )
    page = page_of_result(result, findings, Source("block.stl", "0" * 64, "printprep hollow"))
    path = tmp_path_factory.mktemp("page") / "block.html"
    path.write_bytes(document(page))
    return path


@pytest.fixture(scope="module")
def window(start) -> Browser:
    return start()


@pytest.fixture
def page(window, page_file) -> Iterator[Browser]:
    """The page as it opens, and at the end a console without an error."""
    window.errors()
    window.open(page_file.as_uri())
    yield window
    assert window.errors() == []


def test_it_opens_without_network_and_shows_the_part(page, page_file):
    assert page.open(page_file.as_uri()) > 0
    assert not page.find("#still").is_displayed()
    assert near(page.picture(), WALL) > 300


def test_a_models_name_is_text(page):
    assert page.driver.title == f"{EVIL} · printprep"
    assert page.text("h1") == EVIL


def test_the_cut_is_coloured_by_what_it_cuts(page):
    """A wall of 2 mm around a cavity of 16 mm: 144 of 400 mm² of the section are wall."""
    page.press("[data-look=front]")
    page.set("#cut", 0.0)
    found = page.picture()
    cut, seen = near(found, WALL), found.shape[0] * found.shape[1]
    assert 0.01 < cut / seen < 0.2
    inside = (np.abs(found - np.array(CAVITY)).sum(axis=2) < 120).sum()
    # Seen straight on, the cavity's far side fills the frame, a little smaller than it
    assert inside / cut == pytest.approx(SIDE_SHARE, rel=0.25)
    page.press("input[name=axis][value=off]")
    assert near(page.picture(), WALL) == 0


SIDE_SHARE = 16.0**2 / (20.0**2 - 16.0**2)


def test_the_section_moves_with_its_handle(page):
    from selenium.webdriver import ActionChains

    before, place = page.picture(), float(page.find("#cut").get_property("value"))
    ActionChains(page.driver).drag_and_drop_by_offset(page.find("#handle"), 60, 0).perform()
    moved = float(page.find("#cut").get_property("value"))
    assert abs(moved - place) > 1.0
    assert float(page.text("#cut-out").removesuffix(" mm")) == pytest.approx(moved, abs=0.06)
    assert (page.picture() != before).any()


@pytest.mark.parametrize("axis", ["x", "y", "z", "view"])
def test_it_is_cut_along_any_axis(page, axis):
    page.press(f"input[name=axis][value={axis}]")
    assert near(page.picture(), WALL) > 200
    low, high = (float(page.find("#cut").get_property(name)) for name in ("min", "max"))
    page.set("#cut", high if axis == "z" else low)
    assert low < high


def test_layers_can_be_switched_off(page):
    assert near(page.picture(), WALL) > 300
    page.press("[data-layer=outside]")
    without = page.picture()
    assert near(without, WALL) == 0
    page.press("[data-layer=cavity]")
    page.press("[data-layer=base]")
    assert np.abs(page.picture() - without).max() > 60


def test_the_outside_can_be_seen_through(page):
    """The cavity is blue, the outside is not."""
    page.press("input[name=axis][value=off]")
    page.press("#show-balance")

    def blue() -> float:
        found = page.picture()
        rows, columns = (slice(size // 2 - 20, size // 2 + 20) for size in found.shape[:2])
        middle = found[rows, columns].reshape(-1, 3)
        return float((middle[:, 2] - middle[:, 0]).mean())

    assert blue() < 0
    page.set("#clear", 80)
    assert blue() > 8


def test_the_bed_leans_until_the_part_tips(page):
    """The footprint is 24 mm wide, and the base lowers the centre of mass from 10 mm to 9.6 mm."""
    stands = page.text("#lean-verdict")
    angle = float(stands.split()[-1].rstrip("°"))
    base, block = 176.0, 20.0**3 - 16.0**3
    height = (10 * block + 0.5 * base) / (block + base)
    assert angle == pytest.approx(math.degrees(math.atan(12 / height)), abs=0.06)
    assert "stands up to" in stands
    before = page.picture()
    page.set("#lean", angle - 1)
    leaning = page.picture()
    assert (leaning != before).any()
    assert "stands" in page.text("#lean-verdict")
    page.set("#lean", angle + 1)
    time.sleep(1.2)
    assert "tips over" in page.text("#lean-verdict")
    fallen = page.picture()
    assert np.abs(fallen - leaning).max() > 60
    page.press("#level")
    assert "stands up to" in page.text("#lean-verdict")
    page.press("#tip-it")
    assert "tips over" in page.text("#lean-verdict")


def test_a_finding_is_flown_to_and_marked(page):
    page.press("[data-finding='0']")
    page.wait("return !document.getElementById('marker').hidden")
    page.rest()
    offset = page.run(
        "const m = document.getElementById('marker').getBoundingClientRect();"
        "const v = document.getElementById('viewer').getBoundingClientRect();"
        "return [m.x + m.width / 2 - v.x - v.width / 2, m.y + m.height / 2 - v.y - v.height / 2]"
    )
    assert max(abs(value) for value in offset) < 2
    assert "gap" in page.text("#live")


def test_a_finding_inside_is_cut_open(page):
    page.press("input[name=axis][value=off]")
    page.press("[data-finding='1']")
    page.rest()
    assert not page.run("return document.querySelector('input[name=axis][value=off]').checked")
    assert near(page.picture(), WALL) > 200


def test_a_finding_without_a_place_has_no_button(page):
    assert page.run("return document.querySelectorAll('[data-finding]').length") == 2


def test_the_wall_under_the_pointer_is_told_in_mm(page):
    """The middle of the block's top lies over 2 mm of wall."""
    from selenium.webdriver import ActionChains

    page.press("input[name=axis][value=off]")
    page.press("[data-look=top]")
    page.press("#by-thickness")
    page.rest()
    assert page.find("#scale").is_displayed()
    ActionChains(page.driver).move_to_element_with_offset(page.find("#canvas"), 12, 8).perform()
    page.wait("return !document.getElementById('tip').hidden")
    assert page.text("#tip").startswith("2.00 mm thick")


def test_by_keyboard_alone(page):
    from selenium.webdriver.common.keys import Keys

    body = page.find("body")
    body.send_keys(Keys.TAB)
    assert page.run("return document.activeElement.textContent") == "Skip the picture"
    page.driver.switch_to.active_element.send_keys(Keys.TAB)
    assert page.run("return document.activeElement.id") == "canvas"
    canvas, seen = page.find("#canvas"), [page.picture()]
    for keys in (Keys.ARROW_LEFT, Keys.ARROW_UP, Keys.SHIFT + Keys.ARROW_RIGHT, "+", "-"):
        canvas.send_keys(keys)
        seen.append(page.picture())
        assert (seen[-1] != seen[-2]).any(), keys
    canvas.send_keys(Keys.HOME)
    for _ in range(40):
        page.driver.switch_to.active_element.send_keys(Keys.TAB)
        if page.run("return document.activeElement.id") == "lean":
            break
    page.driver.switch_to.active_element.send_keys(Keys.END)
    assert "tips over" in page.text("#lean-verdict")


def test_it_turns_by_mouse(page):
    from selenium.webdriver import ActionChains

    before = page.picture()
    ActionChains(page.driver).drag_and_drop_by_offset(page.find("#canvas"), 80, 30).perform()
    assert (page.picture() != before).any()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_serious(page, axe, scheme):
    features = {"features": [{"name": "prefers-color-scheme", "value": scheme}]}
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", features)
    page.driver.execute_cdp_cmd("Page.setBypassCSP", {"enabled": True})
    page.run(axe)
    found = page.driver.execute_async_script(
        "const done = arguments[0]; axe.run().then(r => done(JSON.stringify(r.violations)))"
    )
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
    assert [
        (item["id"], item["nodes"][0]["html"][:120], item["nodes"][0]["failureSummary"])
        for item in json.loads(found)
        if item["impact"] in ("serious", "critical")
    ] == []


def test_dark_and_light_differ(page):
    light = page.picture()
    features = {"features": [{"name": "prefers-color-scheme", "value": "dark"}]}
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", features)
    dark = page.picture()
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})
    assert light[5, light.shape[1] // 2].min() > 200 > 80 > dark[5, dark.shape[1] // 2].max()
    assert near(dark, WALL) == pytest.approx(near(light, WALL), rel=0.1)


def test_on_a_phone_nothing_is_wider_than_the_screen(start, page_file):
    phone = start(phone=True)
    phone.open(page_file.as_uri())
    assert phone.run("return document.documentElement.scrollWidth") <= 390
    assert near(phone.picture(), WALL) > 300
    small = phone.run(
        "return [...document.querySelectorAll('button, input[type=range]')]"
        ".filter(e => e.offsetParent && e.getBoundingClientRect().height < 24).length"
    )
    assert small == 0
    phone.driver.execute_cdp_cmd(
        "Input.dispatchTouchEvent",
        {"type": "touchStart", "touchPoints": [{"x": 190, "y": 300}]},
    )
    before = phone.picture()
    for x in (210, 240, 270):
        phone.driver.execute_cdp_cmd(
            "Input.dispatchTouchEvent",
            {"type": "touchMove", "touchPoints": [{"x": x, "y": 310}]},
        )
    phone.driver.execute_cdp_cmd(
        "Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []}
    )
    assert (phone.picture() != before).any()
    assert phone.errors() == []


def test_on_paper_there_is_a_picture_and_every_figure(page):
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
    page.run("dispatchEvent(new Event('beforeprint'))")
    page.wait("return document.getElementById('still').complete")
    shown = page.run(
        "return ['#still', '#summary', '#figures', '#canvas', '.dock'].map("
        "s => document.querySelector(s).offsetHeight > 0)"
    )
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
    assert shown == [True, True, True, False, False]


def test_without_webgl_the_text_and_a_still_picture_stay(start, page_file):
    window = start()
    window.driver.execute_cdp_cmd(
        "Page.addScriptToEvaluateOnNewDocument",
        {"source": "HTMLCanvasElement.prototype.getContext = () => null"},
    )
    window.driver.get(page_file.as_uri())
    window.wait("return document.documentElement.dataset.ready === 'failed'")
    assert window.find("#still").is_displayed()
    assert "cannot show the part" in window.text("#failure")
    assert window.find("#summary").is_displayed()
