"""kit.html: one self-contained page for A4."""

import base64
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from export.build_sheet.bill import bill, components
from export.build_sheet.checks import checks
from export.build_sheet.contents import RESIN_G_CM3, Contents, spoken
from export.build_sheet.steps import steps
from export.cut_files.layers import STYLES
from export.files import write_whole_text
from export.page.environment import page_environment
from export.report import number

HERE = Path(__file__).parent


def write_page(contents: Contents, heading: Mapping[str, Any], pictures: Path, path: Path) -> None:
    """Write the page; heading : what names this kit; pictures : folder of the PNG files, which go into the page.

    The file appears whole or not at all.
    """
    environment = page_environment(HERE)
    environment.filters["number"] = number
    environment.filters["spoken"] = spoken
    page = environment.get_template("page.html").render(
        c=contents,
        heading=heading,
        bill=bill(contents),
        components=components(contents),
        checks=checks(contents),
        steps=steps(contents),
        layers=STYLES,
        resin=RESIN_G_CM3,
        picture=_Pictures(pictures),
        total_height=contents.layers[-1].top_mm,
    )
    write_whole_text(path, page)


class _Pictures:
    """Pictures of a folder as data URIs."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __call__(self, name: str) -> str:
        content = (self.folder / f"{name}.png").read_bytes()
        return f"data:image/png;base64,{base64.b64encode(content).decode('ascii')}"
