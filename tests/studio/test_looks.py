"""How the page looks and what it answers to mouse, keys and ears: sizes, the 3D view, the curves, the start page."""

import csv
import hashlib
from pathlib import Path

import pytest

from softdot.commands.studio import start_text
from softdot.studio.starts import sizes, starts
from softdot.studio.work import design
from tests.cases import for_each
from tests.diagnose.rigs import write_rig
from tests.studio.conftest import QUICK
from tests.studio.test_page import until

SOLID = QUICK.replace('section = "plane-strain"', 'section = "solid"\nlength_mm = 4.0\nwidth_mm = 4.0').replace(
    'shape = "ridge"', 'standard = "marburg-medium"'
)
RECTANGLE = "(one) => { const box = one.getBoundingClientRect(); return [box.width, box.height, box.top]; }"


def rectangle(page, selector):
    """Width, height and top of an element in px."""
    return page.locator(selector).first.evaluate(RECTANGLE)


def extent_of_the_body(page):
    """Height of what is not background, as a share of the canvas: its lengths are those of the marks."""
    ends = page.locator("svg.marks .length path:not(.fine)").evaluate_all(
        "(all) => all.flatMap((one) => { const box = one.getBBox(); return [box.y, box.y + box.height]; })"
    )
    return (max(ends) - min(ends)) / rectangle(page, "#view3d canvas")[1]


@pytest.fixture(scope="module")
def solid(start_studio):
    return start_studio(SOLID)


@pytest.mark.browser
@for_each(("width", "height"), [(1366, 768), (1920, 1080), (400, 860)])
def test_the_result_takes_the_height(solid, open_tab, width, height):
    tab = open_tab(solid.address)
    tab.page.set_viewport_size({"width": width, "height": height})
    tab.page.locator("svg.marks .length").first.wait_for(timeout=60_000)
    until(lambda: rectangle(tab.page, "#view3d canvas")[1] >= 0.45 * height)
    until(lambda: extent_of_the_body(tab.page) >= 0.45)
    if width > 1100:
        curve = rectangle(tab.page, "#curves .chart")
        assert curve[1] + curve[2] <= height  # seen without scrolling
    small = tab.page.locator("button:visible, select:visible, input:visible, summary:visible").evaluate_all(
        "(all) => all.filter((one) => one.matches(':not([type=checkbox], [type=radio])'))"
        ".map((one) => [one.outerHTML.slice(0, 80), one.getBoundingClientRect()])"
        ".filter(([, box]) => box.height < 24 || box.width < 24).map(([text]) => text)"
    )
    assert small == []


@pytest.mark.browser
def test_the_result_is_reached_within_ten_stops(studio, open_tab):
    tab = open_tab(studio.address)
    stops = []
    for _ in range(10):
        tab.page.keyboard.press("Tab")
        stops.append(tab.page.evaluate("document.activeElement.matches('#view3d canvas')"))
    assert any(stops)


@pytest.mark.browser
def test_the_view_is_turned_cut_and_asked(solid, open_tab):
    tab = open_tab(solid.address)
    page, canvas = tab.page, tab.page.locator("#view3d canvas")
    tab.pressed(120.0)
    box = canvas.bounding_box()
    middle = box["x"] + 0.4 * box["width"], box["y"] + 0.6 * box["height"]
    page.mouse.move(*middle)
    until(lambda: page.locator(".hover").inner_text() in ("effector", "medium1", "medium2", "film", "dot"))
    scale = page.locator(".marks .scale path").get_attribute("d")
    page.mouse.wheel(0, -900)
    page.locator(".wheel").wait_for()  # the wheel is the page's until the view is clicked
    assert page.locator(".marks .scale path").get_attribute("d") == scale
    page.mouse.click(*middle)
    page.mouse.wheel(0, -900)
    until(lambda: page.locator(".marks .scale path").get_attribute("d") != scale)
    handle = page.get_by_role("slider", name="Section plane")
    place = float(handle.get_attribute("aria-valuenow"))
    handle.focus()
    page.keyboard.press("ArrowRight")
    until(lambda: float(handle.get_attribute("aria-valuenow")) > place)
    page.get_by_role("button", name="medium2", exact=True).click()
    assert page.get_by_role("button", name="medium2", exact=True).get_attribute("aria-pressed") == "false"
    page.locator("#view3d .colour").select_option("charge")
    ticks = page.locator(".stage .bar .ticks span").all_inner_texts()
    assert "0" in ticks
    assert len(ticks) >= 3
    page.get_by_role("button", name="Top").click()
    until(lambda: page.locator("svg.marks .length").count() == 2)  # the height is seen end-on


@pytest.mark.browser
def test_curves_are_heard_read_and_taken_away(studio, open_tab, tmp_path):
    tab = open_tab(studio.address)
    page = tab.page
    tab.pressed()
    page.locator("#curves .chart").nth(2).focus()
    for key in ("ArrowRight", "ArrowRight", "Enter", "ArrowRight"):
        page.keyboard.press(key)
    until(lambda: "this design: depth (mm) " in page.locator("#heard").inner_text())
    page.keyboard.press("b")
    cells = page.locator("#curves input.braille:visible").input_value()
    assert set(cells) <= set("⣀⠤⠒⠉")
    assert cells[0] == "⣀"
    page.locator("#curves summary").nth(2).click()
    until(lambda: page.locator("#curves .plot").nth(2).locator("tbody tr").count() == len(cells))
    with page.expect_download() as taken:
        page.locator("#csv").click()
    taken.value.save_as(tmp_path / "curves.csv")
    with (tmp_path / "curves.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    assert len(rows[0]) == 6
    assert float(rows[-1][0]) == pytest.approx(0.1)
    with page.expect_download() as picture:
        page.get_by_role("button", name="Force as PNG").click()
    assert picture.value.suggested_filename == "force.png"


@pytest.mark.browser
def test_kept_designs_are_one_list(studio, open_tab):
    tab = open_tab(studio.address)
    page = tab.page
    tab.pressed()
    page.get_by_label("Name", exact=True).fill("thin")
    page.get_by_role("button", name="Keep this design").click()
    page.locator("#legend button", has_text="thin").wait_for()
    page.get_by_label("Name of kept design 1").fill("thinner")
    page.keyboard.press("Enter")
    page.locator("#compare th", has_text="thinner").wait_for()
    page.get_by_role("button", name="Hide or show thinner").click()
    page.locator("#legend button[aria-pressed=false]", has_text="thinner").wait_for()
    page.get_by_role("button", name="Delete thinner").click()
    page.locator("#legend button", has_text="thinner").wait_for(state="detached")


@pytest.mark.browser
def test_a_recording_on_the_curves_lies_over_them(studio, open_tab, tmp_path):
    tab = open_tab(studio.address)
    tab.pressed()
    rig = write_rig(tmp_path / "rig")
    tab.page.locator(".folder-file").set_input_files(rig)
    tab.page.locator("#legend button", has_text="recorded").wait_for(timeout=60_000)
    tab.page.locator("#curves summary").nth(2).click()
    tab.says("#curves th", "recorded")


@pytest.mark.browser
def test_a_new_tab_begins_with_what_the_sensor_is(start_studio, browser):
    page = browser.new_context(viewport={"width": 1366, "height": 768}).new_page()
    page.goto(start_studio(start_text(None)).address)
    page.locator("#start .cards button", has_text="A slice").wait_for()
    assert page.locator("#start .cards svg.sketch path, #start .cards svg.sketch rect").count() > 20
    assert not page.locator("main").is_visible()
    page.locator("#start .cards button", has_text="A slice").click()
    until(lambda: 'section = "plane-strain"' in page.locator("#text").input_value())
    page.get_by_role("button", name="Start page").focus()
    page.keyboard.press("Enter")
    page.locator("#start").wait_for()
    page.keyboard.press("Escape")
    assert page.locator("main").is_visible()
    page.context.close()


def test_every_start_is_a_design_without_mistakes():
    for one in starts():
        assert design.examine(one["text"])["mistakes"] == []
        assert one["sizes"]["medium2"] == 2.0
    assert starts()[0]["text"] == start_text(None)
    assert [sizes(text) for text in ("[", "segment = 1", "[segment]\nlength_mm = -1")] == [None, None, None]


def test_files_of_others_are_those_that_are_named():
    """By their checksums; an example is the design of the start page."""
    root = Path(__file__).parents[2]
    vendor = root / "softdot" / "studio" / "page" / "vendor"
    listed = (vendor / "README.txt").read_text("utf-8").split("SHA-256:\n")[1].splitlines()
    named = {name: found for found, name in (line.split() for line in listed)}
    held = {file.name for file in vendor.iterdir() if not file.name.endswith(".txt")}
    assert named == {name: hashlib.sha256((vendor / name).read_bytes()).hexdigest() for name in held}
    assert starts()[3]["text"] == (root / "examples" / "array-cell.toml").read_text("utf-8")
