"""Work that is cancelled, killed or left behind; a press of full size, a kit and a diagnosis."""

import json
import os
import re
import signal
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import numpy as np
import pytest

from foundation.thread_pools import ONE_THREAD_VARIABLES
from softdot.commands.studio import start_text
from tests.cases import for_each
from tests.diagnose.rigs import COUPON, HEAD, write_rig
from tests.softdot.test_kit import COARSE
from tests.studio.conftest import QUICK
from tests.studio.test_page import SLIDERS, listen, slide, until

pytestmark = pytest.mark.browser


def children(number: int) -> list[int]:
    """Processes that a process has started, and theirs."""
    found = subprocess.run(
        ["ps", "-o", "pid=", "--ppid", str(number)], capture_output=True, encoding="utf-8", check=False
    )
    own = [int(one) for one in found.stdout.split()]
    return [*own, *(inner for one in own for inner in children(one))]


def workers(number: int) -> list[int]:
    return [one for one in children(number) if b"foundation.worker_process" in command_of(one)]


def command_of(number: int) -> bytes:
    """The command line of a process; empty where it has ended meanwhile."""
    try:
        return Path(f"/proc/{number}/cmdline").read_bytes()
    except OSError:
        return b""


def runs(number: int) -> bool:
    try:
        return ") Z " not in Path(f"/proc/{number}/stat").read_text("ascii")
    except OSError:
        return False


def ticks_in_a_second(numbers: list[int]) -> int:
    """Hundredths of a second of work of processes that are there."""

    def total() -> int:
        return sum(int(Path(f"/proc/{one}/stat").read_text("ascii").split()[13]) for one in numbers if runs(one))

    before = total()
    time.sleep(1.0)
    return total() - before


def the_one_that_works(number: int, longest_s: float = 60.0) -> int:
    """The worker that works while the others have loaded and wait, so that the task is not begun in one that dies."""
    end = time.monotonic() + longest_s
    while time.monotonic() < end:
        busy = [one for one in workers(number) if ticks_in_a_second([one]) > 10]
        if len(busy) == 1:
            return busy[0]
    raise TimeoutError(f"{len(busy)} processes work")


FINE = {"element_size_mm = 0.4": "element_size_mm = 0.06", "element_size_mm = 0.2": "element_size_mm = 0.03"}
SLOW_PRESS = QUICK.replace("load_steps = 3", "load_steps = 400")
for coarse, fine in FINE.items():
    SLOW_PRESS = SLOW_PRESS.replace(coarse, fine)


def steps_done(tab):
    """Number of the load step that the page tells; 0 where it tells none."""
    found = re.search(r"load step (\d+) of", tab.page.locator("#press .doing").inner_text())
    return int(found[1]) if found else 0


def test_a_press_is_cancelled_and_one_whose_process_is_killed_is_told(start_studio, open_tab):
    running = start_studio(SLOW_PRESS)
    tab = open_tab(running.address)
    tab.says("#press .doing", "load step", 60.0)
    tab.page.get_by_role("button", name="Cancel").click()
    tab.says("#press .doing", "cancelled")
    tab.page.get_by_role("button", name="Press again").click()
    tab.says("#press .doing", "load step", 60.0)
    until(lambda: steps_done(tab) >= 3, 60.0)
    reached = steps_done(tab)
    os.kill(the_one_that_works(running.process.pid), signal.SIGKILL)
    until(lambda: steps_done(tab) < reached, 60.0)  # it is begun again, at once where a loaded process waits
    os.kill(the_one_that_works(running.process.pid), signal.SIGKILL)
    tab.says("#press .doing", "ended twice by this machine", 90.0)
    tab.says("#press .doing", "The design is as it was")
    assert tab.text == SLOW_PRESS
    tab.write(QUICK)
    tab.pressed()
    tab.page.close()  # it would ask whether the program is there while that is closing
    assert running.end() == 0


@for_each("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_process_is_left_however_the_command_ends(start_studio, open_tab, number):
    running = start_studio(SLOW_PRESS)
    tab = open_tab(running.address)
    tab.says("#press .doing", "load step", 60.0)
    started = children(running.process.pid)
    assert len(started) >= 3
    assert running.end(number) == (0 if number != signal.SIGKILL else -signal.SIGKILL)
    until(lambda: not any(runs(one) for one in started))


def test_a_closed_tab_ends_its_work_and_its_design_is_found_by_the_next_start(start_studio, open_tab):
    running = start_studio(SLOW_PRESS)
    tab = open_tab(running.address)
    tab.says("#press .doing", "load step", 60.0)
    tab.page.close()
    seconds = range(2)  # of rest, as a process may rest for one between two tasks
    until(lambda: all(ticks_in_a_second(workers(running.process.pid)) < 10 for _ in seconds), 60.0)
    again = open_tab(running.address)
    again.write(QUICK)
    again.page.locator("#undo:enabled").wait_for()
    again.page.locator("#begin").click()
    again.page.locator("#earlier button").first.click()
    until(lambda: again.text == SLOW_PRESS)
    assert running.end() == 0


@pytest.mark.evidence
def test_the_default_design_gives_the_numbers_of_softdot_run(start_studio, open_tab, tmp_path):
    """By the command line, after three sliders."""
    running = start_studio(start_text(None))
    tab = open_tab(running.address)
    listen(tab)
    for key, steps in zip(SLIDERS, (-10, 6, -6), strict=True):
        slide(tab, key, steps)
    tab.page.locator("#numbers div").first.wait_for(timeout=60_000)
    tab.pressed(timeout_s=180.0)
    (tmp_path / "mine.toml").write_text(tab.text, "utf-8")
    command = [sys.executable, "-m", "softdot", "run", "mine.toml", "-o", "out", "--json"]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        capture_output=True,
        encoding="utf-8",
        env={**os.environ, **ONE_THREAD_VARIABLES},
        timeout=300,
    )
    summary = json.loads(done.stdout)
    for name in ("reaction_force_N", "film_charge_pC", "open_circuit_voltage_V"):
        np.testing.assert_allclose(tab.numbers["numbers"][name], summary[name], rtol=1e-6)
    assert tab.numbers["numbers"]["uncertainty"]["voltage_percent"] == pytest.approx(
        summary["uncertainty"]["voltage_percent"], rel=1e-3
    )


def test_the_kit_of_an_own_design_is_downloaded(start_studio, open_tab, tmp_path):
    """Of a coarse mesh, on which its budget is quick."""
    running = start_studio(COARSE)
    tab = open_tab(running.address)
    tab.page.get_by_role("button", name="Kit to make it").click()
    link = tab.page.get_by_role("link", name="Download kit.zip")
    link.wait_for(timeout=150_000)
    with tab.page.expect_download() as download:
        link.click()
    download.value.save_as(tmp_path / "kit.zip")
    with zipfile.ZipFile(tmp_path / "kit.zip") as archive:
        names = archive.namelist()
        assert archive.testzip() is None
        assert archive.read("kit/design.toml").decode() == tab.text
    assert {"kit/kit.json", "kit/kit.html", "kit/kit.step"} <= set(names)
    assert any(name.startswith("kit/parts/") and name.endswith(".stl") for name in names)
    assert running.end() == 0


@pytest.mark.evidence
def test_a_recording_is_diagnosed_and_its_improved_model_taken_over(start_studio, open_tab, tmp_path):
    """A strip of rubber that is stiffer than its rig.toml says, by the tenfold of its noise."""
    rng = np.random.default_rng(1)
    time_s = np.arange(0.0, 20.0, 0.05)
    stretch = 1.0 + 1.5 * np.interp(time_s, [0.0, 10.0, 20.0], [0.0, 1.0, 0.0])
    stress_MPa = (stretch - stretch**-2) / 3.0 * (1.0 + 0.1 * (stretch**2 + 2.0 / stretch - 3.0))
    force_N = 10.0 * stress_MPa + 0.02 * rng.standard_normal(len(time_s))
    columns = {"time_s": time_s, "displacement_mm": 20.0 * (stretch - 1.0), "force_N": force_N}
    rig = HEAD + COUPON + '[[runs]]\nfile = "pull.csv"\n[runs.noise]\nforce_N = 0.02\n'
    folder = write_rig(tmp_path / "coupon", rig, pull=columns)
    tab = open_tab(start_studio().address)
    tab.page.locator(".folder-file").set_input_files(folder)
    tab.page.get_by_role("button", name="Quick diagnosis").click(timeout=60_000)
    tab.says(".verdict", "Left out: the specimen stiffens at large strain", 150.0)
    assert tab.page.locator("#verdict img").count() >= 3
    tab.page.get_by_role("button", name="Take the improved model over").click()
    until(lambda: "as its coupon says" in tab.text)
    tab.page.get_by_role("button", name="Keep this design").click()
    tab.says("#compare th", "design 1")
