"""Recordings that are dropped by the mouse: a folder, files and a zip file, and what is refused of them."""

import base64
import io
import os
import shutil
import zipfile
from pathlib import Path

import pytest

from tests.diagnose.rigs import write_rig
from tests.studio.conftest import Tab

pytestmark = pytest.mark.browser
LONG_S = 120.0  # a process that loads the solver first
DROP = """
([place, files]) => {
  const carried = new DataTransfer();
  for (const [name, content] of files) {
    carried.items.add(new File([Uint8Array.from(atob(content), (c) => c.charCodeAt(0))], name));
  }
  const options = { dataTransfer: carried, bubbles: true, cancelable: true };
  for (const kind of ["dragenter", "dragover", "drop"]) {
    document.querySelector(place).dispatchEvent(new DragEvent(kind, options));
  }
}
"""


def drop_files(tab: Tab, files: dict[str, bytes], place: str = "#drop") -> None:
    """Files with a content, dropped by an event that the page makes itself."""
    sent = [[name, base64.b64encode(content).decode()] for name, content in files.items()]
    tab.page.evaluate(DROP, [place, sent])


def drop_paths(tab: Tab, *paths: Path) -> None:
    """Files or folders of the disk, dropped by the browser as by the hand."""
    field = tab.page.locator("#drop")
    field.scroll_into_view_if_needed()
    box = field.bounding_box()
    at = {"x": box["x"] + box["width"] / 2, "y": box["y"] + 10}
    carried = {"items": [], "files": [str(path) for path in paths], "dragOperationsMask": 1}
    hand = tab.page.context.new_cdp_session(tab.page)
    for kind in ("dragEnter", "dragOver", "drop"):
        hand.send("Input.dispatchDragEvent", {"type": kind, **at, "data": carried})
        if kind == "dragOver":
            assert field.get_attribute("class") == "over"
    assert field.get_attribute("class") == ""


def labelled(folder: Path, label: str) -> Path:
    """A recording whose run has a name of its own."""
    rig = write_rig(folder)
    text = (rig / "rig.toml").read_text("utf-8")
    named = text.replace('file = "press.csv"', f'file = "press.csv"\nlabel = "{label}"')
    (rig / "rig.toml").write_text(named, "utf-8")
    return rig


def zipped(folder: Path) -> bytes:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in folder.iterdir():
            archive.write(path, f"recording/{path.name}")
    return made.getvalue()


@pytest.fixture
def tab(studio, open_tab):
    return open_tab(studio.address)


def test_a_folder_is_read_with_what_lies_in_it(tab, tmp_path):
    rig = labelled(tmp_path / "rig", "from a folder")
    shutil.copytree(rig, tmp_path / "day" / "monday")
    (tmp_path / "day" / "photo.jpg").write_bytes(
        os.urandom(30 << 20)
    )  # no part of a recording, so that it may be large
    drop_paths(tab, tmp_path / "day")
    tab.says("#recording figcaption", "from a folder", LONG_S)
    assert tab.page.locator("#recording svg").count() == 2


def test_a_zip_file_is_read_from_the_disk_and_from_the_page(tab, tmp_path):
    content = zipped(labelled(tmp_path / "one", "from a zip file"))
    (tmp_path / "one.zip").write_bytes(content)
    drop_paths(tab, tmp_path / "one.zip")
    tab.says("#recording figcaption", "from a zip file", LONG_S)
    drop_files(tab, {"two.zip": zipped(labelled(tmp_path / "two", "from another one"))})
    tab.says("#recording figcaption", "from another one", LONG_S)


def test_files_without_a_folder_are_read(tab, tmp_path):
    rig = labelled(tmp_path / "rig", "loose files")
    drop_files(tab, {path.name: path.read_bytes() for path in rig.iterdir()})
    tab.says("#recording figcaption", "loose files", LONG_S)


def test_what_an_upload_refuses_is_refused_when_it_is_dropped(tab, tmp_path):
    drop_files(tab, {"junk.zip": b"PK\x03\x04" + os.urandom(1000)})
    tab.says("#said", "damaged")
    drop_files(tab, {"notes.txt": b"no recording"})
    tab.says("#said", "There is no recording in it")
    drop_files(tab, {"press.csv": b"time_s\n0\n"})
    tab.says("#said", "holds no rig.toml")
    bomb = io.BytesIO()
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("rig.toml", "")
        archive.writestr("press.csv", b"\0" * (101 << 20))
    drop_files(tab, {"bomb.zip": bomb.getvalue()})
    tab.says("#said", "more than 100 MB")
    large = tmp_path / "large"
    large.mkdir()
    (large / "rig.toml").write_text("", "utf-8")
    (large / "press.csv").write_bytes(b"0" * (26 << 20))
    drop_paths(tab, large)
    tab.says("#said", "at most 25 MB")
    many = tmp_path / "many"
    many.mkdir()
    for number in range(502):
        (many / f"{number}.csv").write_text("", "utf-8")
    drop_paths(tab, many)
    tab.says("#said", "more than 500 files")
    assert tab.page.locator("#recording figure").count() == 0
    tab.wrong.clear()  # the browser tells its console of each status 400


def test_a_design_that_is_dropped_on_the_form_is_opened(tab):
    text = "[segment.medium1]\nthickness_mm = 0.7\n"
    drop_files(tab, {"other.toml": text.encode()}, place="#design")
    tab.page.locator("#undo:enabled").wait_for()
    assert tab.text == text


def test_what_is_dropped_elsewhere_does_not_replace_the_page(tab):
    drop_files(tab, {"other.toml": b"seed = 1\n"}, place="#result")
    assert tab.page.locator("#form .field").first.is_visible()
    assert "seed = 1" not in tab.text
