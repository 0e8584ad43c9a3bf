"""The page in a real Chromium: a design changes under the hands, and its numbers are those of softdot run."""

import json
import os
import re
import time
from pathlib import Path

import numpy as np
import pytest

from softdot import Case, load_config
from tests.diagnose.rigs import write_rig
from tests.studio.conftest import QUICK, Tab

pytestmark = pytest.mark.browser

SLIDERS = ("segment.medium1.thickness_mm", "segment.medium2.thickness_mm", "press.indentation_mm")


def slide(tab: Tab, key: str, steps: int) -> None:
    """Move a slider by its keys."""
    slider = tab.page.locator(f'[data-slider="{key}"]')
    slider.focus()
    for _ in range(abs(steps)):
        tab.page.keyboard.press("ArrowRight" if steps > 0 else "ArrowLeft")


def last_point(tab: Tab, number: int) -> str:
    """What the curve says of its last point to somebody who cannot see it."""
    return tab.page.locator("#curves .chart").nth(number).get_attribute("aria-label")


def of_run(text: str, folder: Path) -> Case:
    (folder / "same.toml").write_text(text, "utf-8")
    return Case(load_config(folder / "same.toml"))


def listen(tab: Tab) -> None:
    """Keep what the program tells of presses; scripts of the page itself may not be evaluated from texts."""
    tab.page.on("websocket", lambda socket: socket.on("framereceived", lambda frame: heard(tab, frame)))
    tab.page.reload()
    tab.page.locator("#form .field").first.wait_for()


def heard(tab: Tab, frame: str) -> None:
    told = json.loads(frame) if isinstance(frame, str) else {"tell": "view"}
    if told["tell"] == "curves":
        tab.presses, tab.numbers = len(told["curves"]), told["curves"][-1]


def until(holds, timeout_s: float = 20.0) -> None:
    """Wait until something holds."""
    end = time.monotonic() + timeout_s
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.05)


def at_full_load(tab: Tab) -> float:
    """Voltage that the circuit panel states; NaN before it states one."""
    said = re.search(r"At full load ([\d.]+)\s(m?)V", tab.page.locator("#circuit .answer").inner_text())
    return float(said[1]) * (1e-3 if said[2] else 1.0) if said else float("nan")


def test_three_sliders_change_the_curves_to_the_numbers_of_a_run(studio, open_tab, tmp_path):
    tab = open_tab(studio.address)
    listen(tab)
    tab.pressed()
    before = [last_point(tab, number) for number in range(3)]
    tab.page.get_by_role("button", name="Keep this design").click()
    for key, steps in zip(SLIDERS, (-12, 8, -4), strict=True):
        slide(tab, key, steps)
    until(lambda: not tab.page.locator("#before").is_visible() and tab.presses >= 2, 90.0)
    tab.pressed()
    assert [last_point(tab, number) for number in range(3)] != before
    text = tab.text
    assert text.startswith("# A slice that is pressed in a second.")
    assert '"free"  # nothing holds the sides' in text
    pressed = of_run(text, tmp_path).press()
    assert tab.numbers["quality"] == "accurate"
    for name in ("indentation_mm", "reaction_force_N", "film_charge_pC", "open_circuit_voltage_V"):
        np.testing.assert_allclose(tab.numbers["numbers"][name], getattr(pressed, name), rtol=1e-6, atol=1e-12)
    assert pressed.indentation_mm[-1] < 0.1
    assert tab.page.locator("#legend").inner_text().split() == ["this", "design", "design", "1"]
    tab.page.locator("#curves summary").first.click()
    columns = tab.page.locator("#curves th", has_text="(N)")
    until(lambda: columns.count() == 2)  # the kept design beside the present one
    error = tab.numbers["numbers"]["uncertainty"]["voltage_percent"]
    assert error > 1.0
    until(lambda: tab.page.locator("#numbers dd", has_text="±").count() == 3)


def test_the_amplifier_answers_from_the_solved_charge(studio, open_tab, tmp_path):
    tab = open_tab(studio.address)
    listen(tab)
    tab.pressed()
    presses = tab.presses
    tab.page.locator("#circuit > summary").click()
    tab.page.locator("#circuit").get_by_label("with amplifier").check()
    field = tab.page.locator("#circuit").get_by_role("textbox", name="input resistance")
    field.fill("10")
    field.press("Enter")
    until(lambda: "input_resistance_MOhm = 10" in tab.text)
    expected = of_run(tab.text, tmp_path).press().readout_voltage_V[-1]
    until(lambda: at_full_load(tab) == pytest.approx(expected, rel=1e-3))
    assert tab.presses == presses  # no other press was made of it


def test_toml_and_form_follow_each_other_and_mistakes_are_told(studio, open_tab):
    tab = open_tab(studio.address)
    tab.write(QUICK.replace("thickness_mm = 0.5", "thickness_mm = 0.55"))
    thickness = tab.page.locator('[data-key="segment.medium1.thickness_mm"] input.number')
    until(lambda: thickness.input_value() == "0.55")
    tab.write(QUICK.replace("thickness_mm = 0.5", "thickness_mm = -1.0"))
    tab.says("#mistakes", "segment.medium1.thickness_mm = -1: must be above 0")
    assert tab.page.locator("#form .field.bad").count() == 1
    assert tab.page.locator("#toml .lines .bad").inner_text() == "7"  # its line
    tab.page.get_by_role("tab", name="Numbers").click()
    tab.says(".field.bad .wrong", "must be above 0")
    tab.page.get_by_role("button", name="Back to 0.55").click()
    tab.page.locator("#mistakes li").wait_for(state="detached")
    assert "thickness_mm = 0.55\n" in tab.text
    tab.page.get_by_role("button", name="Undo").click()
    tab.page.get_by_role("button", name="Mend it: set segment.medium1.thickness_mm to 0.1").click()
    tab.page.locator("#mistakes li").wait_for(state="detached")
    assert "thickness_mm = 0.1\n" in tab.text
    tab.page.get_by_role("button", name="Undo").click()
    tab.says("#mistakes", "must be above 0")
    tab.page.get_by_role("button", name="Reset").click()
    tab.page.locator("#mistakes li").wait_for(state="detached")
    assert tab.text == QUICK


def test_a_mechanism_is_a_switch(studio, open_tab):
    tab = open_tab(studio.address)
    tab.page.get_by_label("Find a number").fill("prestretch")
    tab.page.get_by_label("film prestretch").check()
    tab.page.get_by_role("textbox", name="strain x").wait_for()
    assert 'name = "film-prestretch"' in tab.text
    assert "strain_x = 0.005" in tab.text
    tab.page.get_by_label("film prestretch").uncheck()
    tab.page.get_by_role("textbox", name="strain x").wait_for(state="detached")
    assert "film-prestretch" not in tab.text


def test_a_tab_that_is_loaded_again_has_its_design_and_another_tab_its_own(studio, open_tab):
    first, second = open_tab(studio.address), open_tab(studio.address)
    first.write(QUICK.replace("0.5", "0.61"))
    second.write(QUICK.replace("0.5", "0.47"))
    for tab, thickness in ((first, "0.61"), (second, "0.47")):
        tab.page.locator("#undo:enabled").wait_for()
        tab.page.reload()
        tab.page.locator("#form .field").first.wait_for(state="attached")
        assert f"thickness_mm = {thickness}" in tab.text
        assert tab.page.locator("#undo").is_enabled()


def test_a_dropped_recording_is_read(studio, open_tab, tmp_path):
    rig = write_rig(tmp_path / "rig")
    text = (
        (rig / "rig.toml")
        .read_text("utf-8")
        .replace('file = "press.csv"', 'file = "press.csv"\nlabel = "a slow press"')
    )
    (rig / "rig.toml").write_text(text, "utf-8")
    tab = open_tab(studio.address)
    tab.page.locator(".folder-file").set_input_files(rig)
    tab.says("#recording figcaption", "a slow press", 40.0)
    assert tab.page.locator("#recording svg").count() == 2  # displacement and voltage
    assert tab.page.locator("#recording rect.band").count() == 10
    (rig / "rig.toml").write_text("seed = 'none'\n", "utf-8")
    tab.page.locator(".folder-file").set_input_files(rig)
    tab.says("#drop-tasks", "format is missing")


def test_junk_is_refused_and_the_page_goes_on(studio, open_tab, tmp_path):
    junk = tmp_path / "junk.zip"
    junk.write_bytes(os.urandom(1 << 20) * 30)
    tab = open_tab(studio.address)
    tab.page.locator(".zip-file").set_input_files(junk)
    tab.says("#said", "at most 25 MB")
    junk.write_bytes(b"PK\x03\x04" + os.urandom(1000))
    tab.page.locator(".zip-file").set_input_files(junk)
    tab.says("#said", "damaged")
    tab.wrong.clear()  # the browser tells its console of the status 400
    tab.page.get_by_label("Close this message").click()
    assert not tab.page.locator("#said").is_visible()


def test_a_mistake_leads_to_its_number_also_where_a_search_hides_it(studio, open_tab):
    tab = open_tab(studio.address)
    search = tab.page.get_by_label("Find a number")
    search.fill("medium 2")
    wanted = tab.page.locator('.field[data-key="segment.medium2.thickness_mm"]')
    wanted.wait_for()  # the title of its group is enough
    hidden = tab.page.locator('.field[data-key="segment.medium1.thickness_mm"]')
    assert not hidden.is_visible()
    tab.write(QUICK.replace("thickness_mm = 0.5", "thickness_mm = -1.0"))
    tab.page.get_by_role("button", name="Show the number").click()
    assert hidden.is_visible()
    assert search.input_value() == ""
    assert tab.page.evaluate("document.activeElement.closest('.field').dataset.key") == "segment.medium1.thickness_mm"
    tab.says("#press .doing", "has a mistake")


def test_numbers_and_files_of_the_design_before_say_so(studio, open_tab):
    tab = open_tab(studio.address)
    tab.pressed()
    tab.page.locator("[data-start=influences]").click()
    tab.says("#tasks li", "done in", 60.0)
    assert not tab.page.locator("#before").is_visible()
    assert not tab.page.locator("#tasks .old").is_visible()
    tab.write(QUICK.replace("0.5", "0.62"))
    tab.page.locator("#before:visible").wait_for()
    tab.says("#tasks .old", "has been changed since")
    tab.page.locator("#before").wait_for(state="hidden", timeout=60_000)
    tab.page.get_by_role("button", name="Undo").click()
    tab.page.locator("#tasks .old").wait_for(state="hidden")
