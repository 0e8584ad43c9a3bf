"""What the page says is so: under a busy machine, after a reload, with the program gone, and of which design it is."""

import os
import re
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest

from softdot.commands.studio import start_text
from tests.studio.conftest import QUICK, Running
from tests.studio.test_drop import drop_files, drop_paths, labelled
from tests.studio.test_page import slide, until

pytestmark = pytest.mark.browser
SAID = """() => {
  window.said = [];
  const place = document.querySelector("#press .doing");
  new MutationObserver(() => window.said.push(place.textContent)).observe(place, { childList: true, subtree: true });
}"""


@contextmanager
def busy_machine():
    """Two processes beside it that never rest."""
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    try:
        yield
    finally:
        for one in loops:
            one.kill()
            one.wait()


def thickness(value):
    return QUICK.replace("thickness_mm = 0.5", f"thickness_mm = {value}")


def write(tab, text):
    tab.write(text)
    tab.page.locator("#text").blur()


def test_a_busy_machine_is_blamed_and_not_the_numbers(start_studio, open_tab):
    """Of the default design; its accurate press is given to the process that is loaded already."""
    with busy_machine():
        tab = open_tab(start_studio(start_text(None)).address)
        tab.page.evaluate(SAID)
        tab.says("#link", "is being loaded on this machine", 60.0)
        tab.says("#view3d .shown", "parts at rest", 120.0)
        tab.says("#view3d .shown", "The coarse press", 240.0)
        until(lambda: any("load step 1" in one for one in tab.page.evaluate("window.said")), 240.0)
        said = tab.page.evaluate("window.said")
    assert not tab.page.locator("#said").is_visible()
    assert not any("absurd" in one or "failed" in one for one in said)
    begun = next(i for i, one in enumerate(said) if "load step" in one)
    assert not any("being loaded" in one for one in said[begun:])


def test_a_mistake_that_is_taken_back_while_it_presses_leads_to_a_press(studio, open_tab):
    tab = open_tab(studio.address)
    write(tab, thickness(0.47))
    tab.says("#press .doing", "Pressing")
    write(tab, thickness(-1.0))
    tab.says("#press .doing", "has a mistake")
    write(tab, thickness(0.47))
    tab.pressed()
    assert tab.page.locator("#mistakes li").count() == 0


def test_after_a_reload_everything_is_told_as_it_is(studio, open_tab):
    tab = open_tab(studio.address)
    tab.pressed()
    tab.page.locator("[data-start=influences]").click()
    tab.says("#influences", "to first order", 60.0)
    shown = ("#press .doing", "#view3d .shown", "#numbers", "#legend", "#influences")
    before = [tab.page.locator(one).inner_text() for one in shown]
    tab.page.reload()
    tab.page.locator("#form .field").first.wait_for(state="attached")
    assert [tab.page.locator(one).inner_text() for one in shown] == before
    write(tab, thickness(0.86))
    tab.says("#influences .before", "Of a design before: medium1.thickness_mm = 0.5")
    tab.pressed()
    assert tab.page.locator("#influences.stale").count() == 1
    tab.page.get_by_role("button", name="Undo").click()
    tab.page.locator("#influences.stale").wait_for(state="detached")
    tab.says("#press .doing", "as softdot run does", 1.0)  # its press is there still
    assert [tab.page.locator(one).inner_text() for one in shown[2:3]] == before[2:3]
    tab.page.get_by_role("button", name="Redo").click()
    tab.page.get_by_role("button", name="Make it anew").click()
    tab.page.locator("#influences.stale").wait_for(state="detached", timeout=60_000)


def test_numbers_are_what_was_typed_and_undo_reaches_the_form(studio, open_tab):
    tab = open_tab(studio.address)
    field = tab.page.locator('.field[data-key="segment.medium1.thickness_mm"] input.number')
    field.fill("0,47")
    field.press("Enter")
    until(lambda: "thickness_mm = 0.47" in tab.text)
    field.press("Control+z")
    until(lambda: "thickness_mm = 0.5\n" in tab.text)
    until(lambda: field.input_value() == "0.5")
    for typed, sentence in (
        ("1e-9", "must be at least 0.0001"),
        ("1e9", "must be at most 1000"),
        ("x", "plain number"),
    ):
        field.fill(typed)
        field.press("Enter")
        tab.says("#mistakes", sentence)


def test_a_change_that_the_program_did_not_hear_is_kept_and_sent_again(tmp_path, open_tab):
    first = Running(tmp_path, QUICK)
    tab = open_tab(first.address)
    first.end(signal.SIGKILL)
    tab.says("#link", "does not answer")
    assert "saved" not in tab.head
    assert tab.page.locator("#design").evaluate("(one) => one.inert")
    tab.page.evaluate("""(text) => {
      document.querySelector("#text").value = text;
      document.querySelector("#text").dispatchEvent(new Event("change"));
    }""", thickness(0.61))  # fmt: skip
    tab.says("#said", "kept in the page and sent")
    again = Running(tmp_path, QUICK)
    assert again.address == first.address
    tab.says("#link", "every change is saved", 30.0)
    until(lambda: "0.61" in "".join(one.read_text("utf-8") for one in (tmp_path / "designs").glob("*.toml")))
    tab.pressed()
    tab.wrong.clear()  # the browser tells its console that nobody listens
    assert again.end() == 0


def test_a_folder_that_cannot_be_written_is_told(tmp_path, open_tab):
    (tmp_path / "designs").write_text("no folder", "utf-8")
    running = Running(tmp_path, QUICK)
    tab = open_tab(running.address)
    tab.says("#link", "This design is not saved")
    tab.says("#view3d .shown", "The", 60.0)  # the page has all its files before the program ends
    assert "every change is saved" not in tab.head
    assert running.end() == 0


def test_a_view_that_did_not_come_is_told_and_there_as_soon_as_the_program_is_again(tmp_path, open_tab):
    first = Running(tmp_path, QUICK)
    tab = open_tab(first.address, lacking="**/view.js")
    tab.says("#said", "The 3D view could not be loaded")
    tab.page.unroute("**/view.js")
    first.end(signal.SIGKILL)
    tab.says("#link", "does not answer")
    again = Running(tmp_path, QUICK)
    tab.says("#view3d .shown", "accurate press", 60.0)
    tab.wrong.clear()  # what was aborted here
    tab.page.close()  # it would ask whether the program is there while that is closing
    assert again.end() == 0


def test_a_refused_recording_takes_that_before_with_it(studio, open_tab, tmp_path):
    tab = open_tab(studio.address)
    drop_paths(tab, labelled(tmp_path / "rig", "the first"))
    tab.page.get_by_role("button", name="Quick diagnosis").wait_for(timeout=120_000)
    drop_files(tab, {"junk.zip": b"PK\x03\x04" + os.urandom(1000)})
    tab.says("#said", "damaged")
    tab.page.get_by_role("button", name="Quick diagnosis").wait_for(state="detached")
    tab.wrong.clear()


def estimated(tab):
    """What the numbers say of an estimate of the voltage, e.g. "0.41 ± 0.02 V"; None where they are of a press."""
    return tab.page.evaluate("[...document.querySelectorAll('#numbers .fresh dd')].at(2)?.textContent")


def test_an_estimate_follows_the_slider_and_the_press_agrees(studio, open_tab):
    tab = open_tab(studio.address)
    said = None
    for rest_s in (1.0, 3.0, 9.0, 27.0):  # some seconds after a press its derivatives are there
        tab.pressed()
        time.sleep(rest_s)
        slide(tab, "press.indentation_mm", 1)
        end = time.monotonic() + 2.0
        while said is None and time.monotonic() < end:
            said = estimated(tab)
        if said is not None:
            break
    expected, error = re.match(r"([\d.]+)\s±\s([\d.]+)\sV", said).groups()
    tab.pressed()
    label = tab.page.locator("#curves .chart").nth(2).get_attribute("aria-label")
    volts = float(label.split(": ")[1].split(" ")[0])
    assert abs(volts - float(expected)) < float(error)
    assert estimated(tab) is None
