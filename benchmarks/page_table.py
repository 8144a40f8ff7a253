"""Pages by size: bytes, seconds to make one, and seconds to its first picture in a browser.

    .venv/bin/python benchmarks/page_table.py

The part is a hollow ball with a wavy skin.  The browser is Chromium without a graphics card,
started anew for each page; its seconds count from the opening of the file.
"""

from __future__ import annotations

import shutil
import tempfile
import time
from pathlib import Path

import numpy as np
from manifold3d import Manifold

from printprep.check import context_of_solid
from printprep.page.build import page_of_checked
from printprep.page.content import Source
from printprep.page.document import write_page
from printprep.pipeline.check import Checked
from printprep.profiles import load_profile
from printprep.stand.stability import stability
from printprep.types import Lean, Repair

SEGMENTS = (100, 316, 708)  # around the ball: 10,000, 100,000 and 500,000 triangles
FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--window-size=1280,900",
)


def wavy(points: np.ndarray) -> np.ndarray:
    """(n, 3) points of a ball, moved along their radius by up to 6 %."""
    around, up = np.arctan2(points[:, 1], points[:, 0]), points[:, 2] / 20
    return points * (1 + 0.06 * np.sin(9 * around) * np.sin(7 * up))[:, None]


def ball(segments: int) -> Manifold:
    outer, inner = (Manifold.sphere(r, segments).warp_batch(wavy) for r in (40.0, 37.5))
    return (outer - inner).translate((0, 0, 45)).trim_by_plane((0, 0, 1), 7)


def make_page(part: Manifold, path: Path) -> float:
    """Write the page of a part; the seconds of processor time that it takes."""
    profile = load_profile()
    standing = stability(part, profile.printer.first_layer_mm)
    checked = Checked(context_of_solid(part, standing, Lean(10), Repair("as-is")), (), profile)
    start = time.process_time()
    source = Source("ball.stl", "0" * 64)
    write_page(page_of_checked(checked, source, name="ball", poses=(), points=()), path)
    return time.process_time() - start


def first_picture(path: Path) -> float:
    """Seconds from the opening of a page to its first picture."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = str(shutil.which("chromium"))
    for flag in FLAGS:
        options.add_argument(flag)
    driver = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
    try:
        driver.get(path.as_uri())
        while not driver.execute_script("return document.documentElement.dataset.ready"):
            time.sleep(0.05)
        script = "return performance.getEntriesByName('first-picture')[0].startTime / 1000"
        return float(driver.execute_script(script))
    finally:
        driver.quit()


def main() -> None:
    print("| triangles | page, MB | made in, s | first picture, s |")
    print("|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for segments in SEGMENTS:
            part, path = ball(segments), Path(folder) / f"{segments}.html"
            made = make_page(part, path)
            shown = min(first_picture(path) for _ in range(3))
            size = path.stat().st_size / 1e6
            print(f"| {part.num_tri()} | {size:.2f} | {made:.1f} | {shown:.2f} |")


if __name__ == "__main__":
    main()
