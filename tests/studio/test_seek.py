"""A number is followed and a goal is sought in the page, on a slice that is pressed in a second."""

import re
import time
import tomllib

import pytest

from tests.studio.test_page import last_point, of_run, slide

pytestmark = pytest.mark.browser

THICKNESS, DEPTH = "segment.medium1.thickness_mm", "press.indentation_mm"


def points(tab):
    """Rows of the table: value of the number, voltage, force, charge."""
    rows = tab.page.locator("#response tbody tr").all()
    return [[float(cell) for cell in row.locator("th, td").all_inner_texts()[:4]] for row in rows]


def test_a_number_is_followed_and_marked_once_another_changes(studio, open_tab, tmp_path):
    tab = open_tab(studio.address)
    page = tab.page
    tab.pressed()
    page.locator("#along select").select_option(THICKNESS)
    page.get_by_role("button", name="Press along it").click()
    page.locator("#response summary").click()
    tab.says("#response-tasks .state", "done in", 90.0)
    found = points(tab)
    assert [row[0] for row in found] == pytest.approx([0.3333, 0.3816, 0.4368, 0.5, 0.5724, 0.6552, 0.75], rel=1e-3)
    page.locator("#response .line.estimate").wait_for(state="attached", timeout=60_000)
    at = tomllib.loads(tab.text)
    assert at["segment"]["medium1"]["thickness_mm"] == 0.5  # nothing was moved
    text = tab.text.replace("thickness_mm = 0.5", f"thickness_mm = {found[0][0]}")
    pressed = of_run(text, tmp_path).press()
    expected = (pressed.open_circuit_voltage_V[-1], pressed.reaction_force_N[-1], pressed.film_charge_pC[-1])
    assert found[0][1:] == pytest.approx(expected, rel=1e-3)
    slide(tab, THICKNESS, 2)
    page.locator("#before").wait_for()
    assert page.locator("#response .before").count() == 0  # its own number
    slide(tab, DEPTH, -2)
    tab.says("#response .before", "Of a design before")
    tab.pressed()
    page.locator("#response .before button").click()
    page.locator("#response-tasks button", has_text="Cancel").click()
    tab.says("#response-tasks .state", "cancelled")
    tab.pressed()


def goal_sought(tab):
    """What the page has found, asked at once after a change, as soon as the derivatives of a press are there."""
    found, refused = tab.page.locator("#goal-found strong", has_text="Goal"), tab.page.locator("#said")
    for rest_s in (1.0, 3.0, 9.0, 27.0):
        tab.pressed()
        time.sleep(rest_s)
        slide(tab, THICKNESS, 1)
        tab.page.get_by_role("button", name="Move the sliders there").click()
        end = time.monotonic() + 20.0
        while time.monotonic() < end and not (found.is_visible() or refused.is_visible()):
            time.sleep(0.05)
        if found.is_visible():
            return tab.page.locator("#goal-found").inner_text()
        said = tab.page.locator("#said").inner_text() + tab.page.locator("#goal-tasks").inner_text()
        assert "nothing is known yet" in said  # and not that it is not checked yet
    raise AssertionError("nothing is known of the press")


def test_a_goal_moves_the_sliders_and_its_press_says_whether_it_is_met(studio, open_tab):
    tab = open_tab(studio.address)
    tab.pressed()
    before, start = tab.text, float(last_point(tab, 2).split(": ")[1].split(" ")[0])
    target = round(1.2 * start, 3)
    tab.page.locator("#goal .target").fill(str(target))
    assert "Moved: " in goal_sought(tab)
    assert tab.text != before
    tab.pressed()
    tab.says("#goal-found", "Its press gives")
    told = tab.page.locator("#goal-found").inner_text()
    volts = float(last_point(tab, 2).split(": ")[1].split(" ")[0])
    assert volts == pytest.approx(target, rel=0.05)  # a straight line in logarithms, 20 % away
    assert float(re.search(r"gives ([\d.]+)", told)[1]) == pytest.approx(volts, rel=0.01)
    assert f"the goal is {'met' if volts >= target else 'missed'}" in told
