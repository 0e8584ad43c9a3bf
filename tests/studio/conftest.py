"""A studio in a process of its own, and tabs of a browser that look at it."""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from foundation.thread_pools import ONE_THREAD_VARIABLES
from tests.softdot.interrupts import heard

QUICK = """\
# A slice that is pressed in a second.
[segment]
section = "plane-strain"
boundary = "free"  # nothing holds the sides

[segment.medium1]
thickness_mm = 0.5

[segment.film]
thickness_um = 100.0

[segment.medium2]
thickness_mm = 1.0

[dot]
shape = "ridge"

[press]
indentation_mm = 0.1
load_steps = 3

[mesh]
mesher = "layered"
element_size_mm = 0.4
contact_element_size_mm = 0.2
"""


class Running:
    """A studio that has been started. address : of its page, with the key."""

    def __init__(self, folder: Path, text: str, *arguments: str) -> None:
        (folder / "mine.toml").write_text(text, "utf-8")
        command = [sys.executable, "-m", "softdot", "studio", "mine.toml", "--no-browser", *arguments]
        environment = {**os.environ, **ONE_THREAD_VARIABLES, "SOFTDOT_STUDIO": str(folder / "designs")}
        self.folder = folder
        self.process = subprocess.Popen(
            command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8",
            preexec_fn=heard,
        )  # fmt: skip
        assert self.process.stdout is not None
        self.address = self.process.stdout.readline().split()[-1]
        self.port = int(self.address.split(":")[2].split("/")[0])
        self.key = self.address.partition("key=")[2]

    def end(self, number: int = signal.SIGINT) -> int:
        """The exit status after a signal."""
        self.process.send_signal(number)
        return self.process.wait(timeout=20)


@pytest.fixture(scope="module")
def start_studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[..., Running]]:
    """Start one with the text of a design."""
    started: list[Running] = []

    def start(text: str = QUICK, *arguments: str) -> Running:
        started.append(Running(tmp_path_factory.mktemp("studio"), text, *arguments))
        return started[-1]

    yield start
    for one in started:
        if one.process.poll() is None:
            one.end()


@pytest.fixture(scope="session")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """One for all tests that neither end it nor need another design. It complains of nothing on the terminal."""
    found = Running(tmp_path_factory.mktemp("studio"), QUICK)
    yield found
    found.process.send_signal(signal.SIGINT)
    said = found.process.communicate(timeout=20)[1]
    assert "Traceback" not in said, said


class Tab:
    """A tab of the page. wrong : what its console complained of. lacking : files that do not come, until unroute."""

    def __init__(self, context: Any, address: str, lacking: str | None = None) -> None:
        self.wrong: list[str] = []
        self.page = context.new_page()
        if lacking:
            self.page.route(lacking, lambda route: route.abort())
        self.page.on("pageerror", lambda error: self.wrong.append(str(error)))
        self.page.on("console", self._hear)
        self.page.goto(address)
        self.page.locator("#form .field").first.wait_for(state="attached", timeout=60_000)
        if self.page.locator("#start").is_visible():  # a tab with the default design begins there
            self.page.locator("#start .go").click()

    def _hear(self, said: Any) -> None:
        """An error; that a studio which has ended does not answer is none."""
        if said.type == "error" and not re.search("WebSocket connection|ERR_CONNECTION_REFUSED", said.text):
            self.wrong.append(said.text)

    def pressed(self, timeout_s: float = 60.0) -> None:
        """Wait until the accurate press is done."""
        self.says("#press .doing", "as softdot run does", timeout_s)

    def says(self, selector: str, text: str, timeout_s: float = 20.0) -> None:
        """Wait until an element holds a text."""
        place = self.page.locator(selector)
        try:
            place.filter(has_text=text).first.wait_for(timeout=1e3 * timeout_s)
        except Exception as error:  # that of playwright, which need not be installed
            raise AssertionError(f"{selector} says {place.all_inner_texts()}, and the head says {self.head}") from error

    @property
    def head(self) -> str:
        """What stands above the page of link and machine."""
        return self.page.locator("#link").inner_text()

    def write(self, text: str) -> None:
        """Another design as TOML."""
        self.page.get_by_role("tab", name="TOML").click()
        self.page.locator("#text").fill(text)

    @property
    def text(self) -> str:
        """The design as TOML."""
        return str(self.page.locator("#text").input_value())


@pytest.fixture
def open_tab(browser: Any) -> Iterator[Callable[..., Tab]]:
    """Open tabs in one window; a page whose console complains fails."""
    context = browser.new_context(viewport={"width": 1366, "height": 768}, accept_downloads=True)
    tabs: list[Tab] = []

    def open_one(address: str, lacking: str | None = None) -> Tab:
        tabs.append(Tab(context, address, lacking))
        return tabs[-1]

    yield open_one
    context.close()
    assert [said for tab in tabs for said in tab.wrong] == []
