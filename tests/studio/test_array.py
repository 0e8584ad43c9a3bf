"""An array in the studio: the dots of a cell are toggled, and every segment tells its voltage."""

import json
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest

from softdot.commands.studio import start_text
from softdot.config.toml import parse_toml
from softdot.studio.document import Document
from softdot.studio.work import design, files, press
from tests.studio.test_page import until

CELL = (Path(__file__).parents[2] / "examples" / "array-cell.toml").read_text("utf-8")
PAIR = CELL.replace('cell = "⠿"', 'cell = "⠃"').replace("columns = 2", "columns = 1").replace("rows = 3", "rows = 2")
PAIR = PAIR.replace("element_size_mm = 0.5", "element_size_mm = 0.9").replace("load_steps = 4", "load_steps = 1")
PAIR = PAIR.replace("contact_element_size_mm = 0.15", "contact_element_size_mm = 0.4")


def test_an_array_is_no_mistake_and_says_where_its_segments_are():
    told = design.examine(CELL)
    assert told["mistakes"] == []
    assert told["presses"] == ["press:press_of_cell"]
    array = told["array"]
    assert [array["labels"][array["under"][str(dot)]] for dot in (1, 2, 3, 4, 6)] == [
        "segment-r1c1", "segment-r2c1", "segment-r3c1", "segment-r1c2", "segment-r3c2",
    ]  # fmt: skip
    assert told["cost"]["tetrahedra"] > 10_000
    assert design.examine(CELL.replace("⠿", "⠟"))["press_hash"] != told["press_hash"]
    assert design.examine(re.sub("cell = .*", "", CELL))["press_hash"] is None  # there is nothing to press


def test_mistakes_of_an_array_are_told_and_mended():
    told = design.examine(PAIR.replace("⠃", "⠉"))
    assert told["mistakes"] == ["dot.cell = '⠉': dot 4 has no segment under it, array.rows = 2 and 1 in each"]
    assert told["remedies"][0]["changes"] == [[["dot", "cell"], None]]
    assert design.draw(PAIR.replace("length_mm = 2.3", "length_mm = 2.3\nwidth_mm = -1")) is None


def test_the_default_design_becomes_an_array_by_its_buttons():
    """What a switch in the form begins, two gaps and six dots complete."""
    document = Document(start_text(None))
    document.set(["array"], {})
    told = design.examine(document.text)
    while told["mistakes"]:
        before = told["mistakes"]
        for key, value in told["remedies"][0]["changes"]:
            document.set(key, value)
        told = design.examine(document.text)
        assert told["mistakes"] != before
    segment = parse_toml(document.text, "design")["segment"]
    assert (segment["length_mm"], segment["width_mm"]) == (2.3, 2.3)
    document.set(["dot", "cell"], "⠿")
    told = design.examine(document.text)
    assert told["mistakes"] == []
    assert told["press_hash"] is not None


def test_an_array_is_drawn_with_all_its_islands():
    view = design.draw(PAIR)
    assert view["names"] == ["effector", "medium1", "film", "medium2", "case"]
    one = design.draw(PAIR.replace("rows = 2", "rows = 1").replace("⠃", "⠁"))
    assert len(view["points"]) > len(one["points"])


@pytest.mark.press
def test_each_segment_under_a_raised_dot_reads_most():
    """Of two segments one is pressed, then both: mirror images of each other."""
    one = press.press_of_cell(PAIR.replace('"⠃"', '"⠂"\ncell_dot = 2'), lambda _: None)["array"]  # dot 2 alone
    assert one["failure"] is None
    assert one["voltage_V"][1] > 3 * abs(one["voltage_V"][0])
    told = []
    both = press.press_of_cell(PAIR, told.append)
    np.testing.assert_allclose(*both["array"]["voltage_V"], rtol=1e-6)
    assert both["array"]["force_N"] > 1.5 * one["force_N"]
    assert both["view"]["steps"][-1]["indentation"] == pytest.approx(0.3)
    assert {one["progress"]["stage"] for one in told} == {"mesh", "press"}


@pytest.mark.browser
def test_the_report_of_an_array_is_that_of_softdot_array(tmp_path):
    found = files.report(PAIR, str(tmp_path), lambda _: None)
    with zipfile.ZipFile(found["file"]) as archive:
        assert {"array/array.json", "array/design.toml", "array/report.html"} <= set(archive.namelist())
        summary = json.loads(archive.read("array/array.json"))
    assert summary["labels"] == ["segment-r1c1", "segment-r2c1"]
    assert "2 segments" in found["said"][0]


def volts(tab):
    """What the view from above tells of each segment."""
    said = tab.page.locator("#array svg title").text_content()
    return {label: float(value) for label, value in re.findall(r"(r\dc\d) ([-\d.e]+) V", said)}


@pytest.mark.browser
def test_dots_are_toggled_and_the_segments_under_them_read(start_studio, open_tab):
    tab = open_tab(start_studio(CELL).address)
    until(lambda: len(volts(tab)) == 6, 90.0)
    assert tab.page.locator("#array").get_by_role("button", pressed=True).count() == 6
    assert not tab.page.locator("#curves").is_visible()  # those of one segment
    for dot in (2, 3, 5, 6):
        button = tab.page.get_by_role("button", name=f"Dot {dot}")
        button.focus()
        tab.page.keyboard.press("Space")
        assert button.get_attribute("aria-pressed") == "false"
    assert volts(tab) == {}  # those of the cell before are gone
    until(lambda: 'cell = "⠉"' in tab.text)
    until(lambda: len(volts(tab)) == 6, 90.0)
    found = volts(tab)
    assert min(found["r1c1"], found["r1c2"]) > 2 * max(abs(found[one]) for one in ("r2c1", "r2c2", "r3c1", "r3c2"))
    tab.page.get_by_role("button", name="Dot 1").click()
    until(lambda: 'cell = "⠈"' in tab.text and "cell_dot = 4" in tab.text)
    until(lambda: len(volts(tab)) == 6, 90.0)
    assert max(volts(tab), key=volts(tab).get) == "r1c2"


@pytest.mark.browser
def test_the_press_of_a_cell_is_cancelled(start_studio, open_tab):
    fine = CELL.replace("element_size_mm = 0.15", "element_size_mm = 0.08").replace("⠿", "⠙")
    tab = open_tab(start_studio(fine).address)
    tab.says("#press .doing", "Pressing", 60.0)
    tab.page.get_by_role("button", name="Cancel").click()
    tab.says("#press .doing", "cancelled")
    tab.page.get_by_role("button", name="Dot 1").click()
    tab.says("#press .doing", "Pressing", 60.0)
    for dot in (4, 5):
        tab.page.get_by_role("button", name=f"Dot {dot}").click()
    tab.says("#press .doing", "Raise a dot")
    tab.says("#array .which", "No dot is raised")
