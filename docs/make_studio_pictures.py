"""Take the pictures of docs/studio.md and README.md: python docs/make_studio_pictures.py

Needs softdot[studio], playwright and Chromium; run it after the page has changed.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from playwright.sync_api import Page, sync_playwright

PICTURES = Path(__file__).resolve().parent / "pictures"
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
WAIT_MS = 300_000


def pressed(page: Page) -> None:
    """Wait for the accurate press with its error bars."""
    page.locator("#press .doing", has_text="as softdot run does").wait_for(timeout=WAIT_MS)


def whole_page(page: Page) -> None:
    """Two designs, the film's charge and what moves the voltage."""
    pressed(page)
    slider = page.get_by_label("segment.medium1.thickness_mm, slider")
    slider.focus()
    for _ in range(12):
        page.keyboard.press("ArrowLeft")
    page.locator("#designs li").nth(1).wait_for(timeout=WAIT_MS)
    pressed(page)
    page.select_option("#view3d select", "stress")
    page.locator("[data-start=influences]").click()
    page.locator("#influences svg").wait_for(timeout=WAIT_MS)


def circuit(page: Page) -> None:
    """An amplifier of 10 MΩ with a low-pass."""
    pressed(page)
    page.locator("#circuit > summary").click()
    page.locator("#circuit").get_by_label("with amplifier").check()
    for name, value in (("input resistance", "10"), ("low pass", "60")):
        field = page.locator("#circuit").get_by_label(name)
        field.fill(value)
        field.press("Enter")
    page.locator("#circuit .answer svg").wait_for()
    page.wait_for_timeout(1500)
    page.locator("#circuit").evaluate("(one) => one.scrollIntoView()")


def narrow(page: Page) -> None:
    """The result on a small screen."""
    pressed(page)
    page.select_option("#view3d select", "charge")
    page.locator("#result").evaluate("(one) => one.scrollIntoView()")
    page.wait_for_timeout(500)


SHOTS: dict[str, tuple[Any, int, int, str]] = {
    "studio": (whole_page, 1440, 860, "light"),
    "studio-dark": (circuit, 1366, 768, "dark"),
    "studio-narrow": (narrow, 400, 860, "light"),
}


def main() -> None:
    """Take all of them, each in a tab of its own."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "softdot", "studio", "--no-browser"]
        environment = {**os.environ, "SOFTDOT_STUDIO": folder}
        running = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
        assert running.stdout is not None
        address = running.stdout.readline().split()[-1]
        with sync_playwright() as engine:
            browser = engine.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
            for name, (prepare, width, height, scheme) in SHOTS.items():
                page = browser.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
                page.goto(address)
                prepare(page)
                page.screenshot(path=PICTURES / f"{name}.png")
                page.close()
            browser.close()
        running.send_signal(2)
        running.wait(20)


if __name__ == "__main__":
    main()
