"""Take the pictures of docs/studio.md and README.md: python docs/make_studio_pictures.py [FOLDER]

Needs softdot[studio], playwright and Chromium; run it after the page has changed. With a folder, every panel is
put into it as well, in light and dark, wide and narrow: to look at.
"""

import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

DOCS = Path(__file__).resolve().parent
PICTURES = DOCS / "pictures"
ARRAY = (DOCS.parent / "examples" / "array-cell.toml").read_text("utf-8")
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
WAIT_MS = 900_000
LOOKS = [(scheme, width) for width in (1366, 1920, 400) for scheme in ("light", "dark")]
HEIGHT = {1366: 768, 1920: 1080, 400: 860}


def pressed(page: Page) -> None:
    """Wait for the accurate press with its error bars."""
    page.locator("#press .doing", has_text="as softdot run does").wait_for(timeout=WAIT_MS)


def write(page: Page, text: str) -> None:
    """Another design as TOML, read at once."""
    page.get_by_role("tab", name="TOML").click()
    page.locator("#text").fill(text)
    page.locator("#text").blur()
    page.get_by_role("tab", name="Numbers").click()


def start(page: Page) -> None:
    """What a new tab begins with."""
    page.locator("#start .cards button").first.wait_for(timeout=WAIT_MS)


def design(page: Page) -> None:
    """The form as it opens."""
    if page.locator("#start").is_visible():
        page.locator("#start .go").click()
    page.locator("#form .field").first.wait_for(timeout=WAIT_MS)


def mistake(page: Page) -> None:
    """A thickness that cannot be, at its field."""
    pressed(page)
    field = page.locator('[data-key="segment.medium1.thickness_mm"] input.number')
    field.fill("-1")
    field.press("Enter")
    page.locator(".field.bad .wrong button").first.wait_for(timeout=WAIT_MS)


def two_designs(page: Page) -> None:
    """A thinner medium 1, beside the design before, and what moves the voltage."""
    page.locator(".field.bad .wrong button").first.click()
    pressed(page)
    page.locator("#keep input").fill("0.5 mm")
    page.locator("#keep button").click()
    slider = page.locator('[data-slider="segment.medium1.thickness_mm"]')
    slider.focus()
    for _ in range(12):
        page.keyboard.press("ArrowLeft")
    page.locator("#before:visible").wait_for(timeout=WAIT_MS)
    page.locator("#before").wait_for(state="hidden", timeout=WAIT_MS)
    pressed(page)
    page.select_option("#view3d .colour", "stress")
    page.locator("[data-start=influences]").click()
    page.locator("#influences svg").wait_for(timeout=WAIT_MS)


def charge(page: Page) -> None:
    """The film alone."""
    page.select_option("#view3d .colour", "charge")


def circuit(page: Page) -> None:
    """An amplifier of 10 MΩ with a low-pass."""
    page.locator("#circuit > summary").click()
    page.locator("#circuit").get_by_label("with amplifier").check()
    for name, value in (("input resistance", "10"), ("low pass", "60")):
        field = page.locator("#circuit").get_by_role("textbox", name=name)
        field.fill(value)
        field.press("Enter")
    page.locator("#circuit .answer svg").wait_for()
    page.wait_for_timeout(1500)


def compared(page: Page) -> None:
    """Three designs side by side; the last one is too deep, of which the warnings tell."""
    page.get_by_role("button", name="Delete 0.5 mm").click()
    page.select_option("#view3d .colour", "part")
    for depth in ("0.3", "0.2", "0.6"):
        write(page, f"[segment]\nheld_layers = ['medium1', 'film', 'medium2']\n[press]\nindentation_mm = {depth}\n")
        page.locator("#before:visible").wait_for(timeout=WAIT_MS)
        page.locator("#before").wait_for(state="hidden", timeout=WAIT_MS)
        page.locator("#keep input").fill(f"{depth} mm deep")
        page.locator("#keep button").click()
        page.locator("#compare th", has_text=f"{depth} mm deep").wait_for()


def downloads(page: Page) -> None:
    """Kit, report and plate are made."""
    page.locator("#reset").click()
    page.locator("#before").wait_for(state="hidden", timeout=WAIT_MS)
    pressed(page)
    for task in ("kit", "report"):
        page.locator(f"[data-start={task}]").click()
    page.locator("#plate button").click()
    page.locator("#tasks li", has_text="Kit").get_by_role("link").first.wait_for(timeout=WAIT_MS)
    page.locator("#tasks li", has_text="Report").locator("p", has_text="done in").wait_for(timeout=WAIT_MS)


def verdict(page: Page) -> None:
    """The recording of the tutorial and its diagnosis."""
    text = (DOCS / "tutorial.md").read_text("utf-8")
    program = re.search(r"Save it as `strip.py`:\n\n```python\n(.*?)```", text, re.S)
    assert program is not None
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-c", program[1]], cwd=folder, check=True)
        page.locator(".folder-file").set_input_files(Path(folder) / "coupon")
        page.locator("#recording figure").first.wait_for(timeout=WAIT_MS)
    page.get_by_role("button", name="Quick diagnosis").click()
    page.locator("#verdict img").first.wait_for(timeout=WAIT_MS)


def array(page: Page) -> None:
    """Three dots of a cell on six segments, in a tab that has done nothing else."""
    page.evaluate("sessionStorage.clear()")
    page.reload()
    design(page)
    write(page, ARRAY.replace("⠿", "⠙"))
    page.locator("#array figcaption", has_text="at open circuit").wait_for(timeout=WAIT_MS)


STAGES: dict[str, tuple[Callable[[Page], None], tuple[str, ...]]] = {
    "start": (start, ("#start",)),
    "design": (design, ("#design",)),
    "mistake": (mistake, ("#design",)),
    "pressed": (two_designs, ("#result", "#curves", "#influences")),
    "charge": (charge, ("#result",)),
    "circuit": (circuit, ("#circuit",)),
    "compared": (compared, ("#next", "#compare")),
    "downloads": (downloads, ("#tasks",)),
    "verdict": (verdict, ("#drop", "#verdict")),
    "array": (array, ("#result", "#array")),
}
"""What is done one after the other in one tab, and the panels at which it is then looked."""
CHOSEN = {
    ("start", "#start", "light", 1366): "studio-start",
    ("pressed", "#result", "light", 1366): "studio",
    ("circuit", "#circuit", "dark", 1366): "studio-dark",
    ("charge", "#result", "light", 400): "studio-narrow",
    ("compared", "#compare", "light", 1366): "studio-compare",
    ("downloads", "#tasks", "light", 1366): "studio-bench",
    ("verdict", "#verdict", "light", 1366): "studio-verdict",
    ("array", "#result", "light", 1366): "studio-array",
    ("array", "#array", "dark", 400): "studio-array-narrow",
}
"""Pictures of the documents: stage, panel, look -> name."""


def save(page: Page, path: Path) -> None:
    """A screenshot with a palette."""
    shot = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    shot.quantize(256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(path, optimize=True)


def look(page: Page, stage: str, panels: tuple[str, ...], folder: Path | None) -> None:
    """Pictures of some panels in every look, of which the chosen ones go into the documents."""
    for scheme, width in LOOKS:
        page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
        page.set_viewport_size({"width": width, "height": HEIGHT[width]})
        for panel in panels:
            page.locator(panel).evaluate("(one) => { one.scrollIntoView(); one.scrollTop = 0; }")
            page.evaluate("window.dispatchEvent(new Event('resize'))")
            page.wait_for_timeout(400)
            name = CHOSEN.get((stage, panel, scheme, width))
            if name is not None:
                save(page, PICTURES / f"{name}.png")
            if folder is not None:
                save(page, folder / f"{stage}-{panel[1:]}-{scheme}-{width}.png")
    page.emulate_media(color_scheme="light")
    page.set_viewport_size({"width": 1366, "height": 768})


def main() -> None:
    """All stages in one tab."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    with tempfile.TemporaryDirectory() as designs:
        command = [sys.executable, "-m", "softdot", "studio", "--no-browser"]
        environment = {**os.environ, "SOFTDOT_STUDIO": designs}
        running = subprocess.Popen(command, stdout=subprocess.PIPE, encoding="utf-8", env=environment)
        assert running.stdout is not None
        address = running.stdout.readline().split()[-1]
        with sync_playwright() as engine:
            browser = engine.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
            page = browser.new_page(viewport={"width": 1366, "height": 768})
            page.goto(address)
            for stage, (prepare, panels) in STAGES.items():
                print(stage, flush=True)
                prepare(page)
                look(page, stage, panels, folder)
            browser.close()
        running.send_signal(2)
        running.wait(20)


if __name__ == "__main__":
    main()
