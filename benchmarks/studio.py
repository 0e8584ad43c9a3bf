"""How quickly the page of softdot studio answers, and what it needs: .venv/bin/python benchmarks/studio.py

Needs softdot[studio], playwright, psutil and Chromium. One table line each; memory is that of the command and of all
processes it started, without the browser.
"""

import json
import os
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import suppress

import psutil
from playwright.sync_api import Page, sync_playwright

FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
MOVES, FEW = 100, 20
ESTIMATES, FIRST_PLACE, OTHER_TABS = 20, 520, 3
LOADED_S = 10.0
"""After which every process has loaded what it needs."""
LEARNT_S = 45.0
"""After which the derivatives of a press are known."""
TOLD = """() => {
  window.told = [];
  document.addEventListener("softdot", (event) => window.told.push([event.detail, performance.now()]));
}"""
MOVED = """([key, place]) => {
  const slider = document.querySelector(`[data-slider="${key}"]`);
  window.told.length = 0;
  slider.value = place;
  window.from = performance.now();
  slider.dispatchEvent(new Event("input"));
  slider.dispatchEvent(new Event("change"));
}"""
SINCE = (
    "(kind) => { const one = window.told.find(([name]) => name === kind); return one ? one[1] - window.from : null; }"
)
ESTIMATED = """() => {
  new MutationObserver(() => {
    if (document.querySelector("#numbers .fresh")) window.told.push(["estimate", performance.now()]);
  }).observe(document.querySelector("#numbers"), { childList: true });
}"""
THICKNESS = "segment.medium1.thickness_mm"
RESISTANCE = "readout.input_resistance_MOhm"


def answer_ms(page: Page, key: str, place: float, kind: str) -> float:
    """From the move of a slider to the first answer of a kind that has been shown."""
    page.evaluate(MOVED, [key, place])
    end = time.monotonic() + 60.0
    while time.monotonic() < end:
        found = page.evaluate(SINCE, kind)
        if found is not None:
            return float(found)
        time.sleep(0.01)
    raise TimeoutError(kind)


def memory_MB(process: psutil.Process) -> float:
    """Proportional memory of a process and of all that it started."""
    total = 0
    for one in [process, *process.children(recursive=True)]:
        with suppress(psutil.NoSuchProcess):
            total += one.memory_full_info().pss
    return 1e-6 * total


def work_s(process: psutil.Process) -> dict[int, float]:
    """How long a process and those that it started have kept a core, by process number."""
    found = {}
    for one in [process, *process.children(recursive=True)]:
        with suppress(psutil.NoSuchProcess):
            found[one.pid] = one.cpu_times().user + one.cpu_times().system
    return found


def measured(address: str, process: psutil.Process, started: float) -> dict[str, float]:
    """All figures of one run."""
    with sync_playwright() as engine:
        browser = engine.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        page = browser.new_context(viewport={"width": 1366, "height": 768}).new_page()
        page.set_content("<p>Another page</p>")
        page.screenshot()  # the browser runs and has drawn
        begin = time.perf_counter()
        page.goto(address)
        page.locator("#start .go").click(timeout=60_000)
        page.locator("#form .field").first.wait_for(timeout=60_000)
        found = {
            "first page after the command": time.perf_counter() - started,
            "first page": time.perf_counter() - begin,
        }
        page.locator("#press .doing", has_text="as softdot run does").wait_for(timeout=300_000)
        page.evaluate(TOLD)
        print(found, file=sys.stderr)
        found["coarse press after rest"] = answer_ms(page, THICKNESS, FIRST_PLACE, "view") / 1e3
        page.locator("#press .doing", has_text="as softdot run does").wait_for(timeout=300_000)
        found |= estimates(page)
        print(found, file=sys.stderr)
        page.locator("#press .cancel").click(timeout=60_000)
        time.sleep(LOADED_S)
        found |= previews(page, process)
        print(found, file=sys.stderr)
        page.locator("#press .doing", has_text="as softdot run does").wait_for(timeout=300_000)
        found["circuit"] = circuit(page)
        found |= tabs(page, address, process)
        browser.close()
    return found


def estimates(page: Page) -> dict[str, float]:
    """Force, charge and voltage by estimate while a slider moves, once the derivatives of the press are there."""
    page.evaluate(ESTIMATED)
    time.sleep(LEARNT_S)  # a move ends the search for derivatives
    times = [answer_ms(page, THICKNESS, FIRST_PLACE + 5 + 5 * number, "estimate") for number in range(ESTIMATES)]
    return {
        "estimate, median": statistics.median(times) / 1e3,
        "estimate, slowest of ten": statistics.quantiles(times, n=10)[-1] / 1e3,
    }


def tabs(page: Page, address: str, process: psutil.Process) -> dict[str, float]:
    """Another tab until its form is there, and the memory of all of them, each with its press."""
    times = []
    for _ in range(OTHER_TABS):
        other = page.context.new_page()
        begin = time.perf_counter()
        other.goto(address)
        other.locator("#form .field").first.wait_for(state="attached", timeout=60_000)
        times.append(time.perf_counter() - begin)
        other.locator("#press .doing", has_text="as softdot run does").wait_for(state="attached", timeout=300_000)
    return {
        "form of another tab": statistics.median(times),
        f"memory with {1 + OTHER_TABS} tabs (MB)": memory_MB(process),
    }


def previews(page: Page, process: psutil.Process) -> dict[str, float]:
    """Geometry while a slider moves; memory after a few moves and after many."""
    times, memory, before = [], {}, work_s(process)
    for number in range(MOVES):
        times.append(answer_ms(page, THICKNESS, 300 + (37 * number) % 400, "parts"))
        if number + 1 in (FEW, MOVES):
            time.sleep(LOADED_S)
            memory[number + 1] = memory_MB(process)
    few, many = memory.values()
    work = sum(after - before[number] for number, after in work_s(process).items() if number in before)
    return {
        "work of the studio for each move": work / MOVES,
        "geometry preview, median": statistics.median(times) / 1e3,
        "geometry preview, slowest of ten": statistics.quantiles(times, n=10)[-1] / 1e3,
        f"memory after {FEW} moves (MB)": few,
        f"memory after {MOVES} moves (MB)": many,
        "growth (%)": 100 * (many / few - 1),
    }


def circuit(page: Page) -> float:
    """Median of moves of a resistor, after the first."""
    page.locator("#circuit > summary").click()
    page.locator("#circuit").get_by_label("with amplifier").check()
    field = page.locator("#circuit").get_by_role("textbox", name="input resistance")
    field.fill("10")
    field.press("Enter")
    page.locator("#circuit .answer", has_text="At full load").wait_for()
    time.sleep(2.0)
    times = []
    for place in range(400, 600, 20):
        times.append(answer_ms(page, RESISTANCE, place, "circuit"))
        time.sleep(0.4)
    return statistics.median(times) / 1e3


def main() -> None:
    """Start the studio, measure, end it, and count what is left."""
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "SOFTDOT_STUDIO": folder}
        started = time.perf_counter()
        command = [sys.executable, "-m", "softdot", "studio", "--no-browser"]
        running = subprocess.Popen(command, stdout=subprocess.PIPE, encoding="utf-8", env=environment)
        assert running.stdout is not None
        process = psutil.Process(running.pid)
        try:
            found = measured(running.stdout.readline().split()[-1], process, started)
            children = process.children(recursive=True)
        finally:
            running.send_signal(signal.SIGINT)
            running.wait(20)
        time.sleep(1.0)
        found["processes left"] = sum(one.is_running() and one.status() != psutil.STATUS_ZOMBIE for one in children)
    print(json.dumps({name: float(f"{value:.3g}") for name, value in found.items()}, indent=2))


if __name__ == "__main__":
    main()
