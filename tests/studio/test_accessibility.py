"""For everybody: no serious finding of axe-core, keys alone suffice, a narrow screen too."""

import time

import pytest

from tests.axe import axe
from tests.cases import for_each
from tests.studio.test_array import PAIR

pytestmark = pytest.mark.browser
SERIOUS = ("serious", "critical")


def serious(page):
    """What axe-core finds, and where."""
    found = axe().run(page).response["violations"]
    return [(one["id"], [node["html"][:120] for node in one["nodes"][:3]]) for one in found if one["impact"] in SERIOUS]


@for_each(("scheme", "width"), [("light", 1366), ("dark", 1366), ("light", 400)])
def test_axe_finds_nothing_serious(studio, browser, scheme, width):
    """bypass_csp : the policy of the page does not let a script be put into it, that of axe-core neither."""
    context = browser.new_context(color_scheme=scheme, viewport={"width": width, "height": 768}, bypass_csp=True)
    page = context.new_page()
    page.goto(studio.address)
    page.locator("#numbers div").first.wait_for(timeout=60_000)
    page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    page.locator("#keep").get_by_role("button").click()
    page.locator("#compare table").wait_for()
    assert serious(page) == []
    across = page.evaluate("document.documentElement.scrollWidth")
    context.close()
    assert across <= width


@for_each(("scheme", "width"), [("dark", 1366), ("light", 400)])
def test_axe_finds_nothing_serious_in_an_array(start_studio, browser, scheme, width):
    context = browser.new_context(color_scheme=scheme, viewport={"width": width, "height": 768}, bypass_csp=True)
    page = context.new_page()
    page.goto(start_studio(PAIR).address)
    page.locator("#array figcaption", has_text="Voltages at open circuit").wait_for(timeout=60_000)
    assert serious(page) == []
    across = page.evaluate("document.documentElement.scrollWidth")
    context.close()
    assert across <= width


def test_every_control_is_reached_by_the_tab_key_alone(studio, open_tab):
    tab = open_tab(studio.address)
    seen = set()
    tab.pressed()  # before, there may be nothing to turn
    for _ in range(150):
        tab.page.keyboard.press("Tab")
        seen.add(tab.page.evaluate("document.activeElement.id || document.activeElement.textContent.slice(0, 40)"))
    assert {"begin", "tab-form", "find", "Kit to make it", "Each number 10 % larger", "Choose a folder"} <= seen
    tab.page.locator("#view3d canvas").focus()
    before = tab.page.locator("#view3d canvas").screenshot()
    tab.page.keyboard.press("ArrowLeft")
    end = time.monotonic() + 10.0  # the next frame may be late
    while (after := tab.page.locator("#view3d canvas").screenshot()) == before and time.monotonic() < end:
        tab.page.wait_for_timeout(100)
    assert after != before
