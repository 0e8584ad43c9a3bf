"""The report is one file that needs nothing else, and says plainly what was found."""

import base64
import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pressed_box import DEPTHS_MM, box_mesh, made_up_press

from export.report import number, write_report
from export.viewer_data import viewer_data
from geometry.dot import DotShape
from mesh.types import TetMesh
from solve.result import PressResult
from tests.cases import for_each

PIXEL = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)
NASTY = "</script><script>alert(1)</script>"


def summary(**changes: Any) -> dict[str, Any]:
    base: dict[str, Any] = {
        "format": "softdot-run/1",
        "softdot_version": "0.1.0",
        "config_hash": "0123456789abcdef",
        "seed": 0,
        "config": {"segment": {"length_mm": 2.5, "section": "solid"}, "dot": {"cell": NASTY}},
        "indentation_mm": [0.0, 0.15, 0.3],
        "reaction_force_N": [0.0, 0.5, 1.234],
        "film_charge_pC": [0.0, 10.0, 40.0],
        "open_circuit_voltage_V": [0.0, 0.4, 1.75],
        "film": {"capacitance_pF": 23.7, "max_principal_strain": 0.021, "max_principal_stress_MPa": 44.0},
        "sensitivity": {
            "voltage_per_mm": 5.83, "charge_pC_per_N": 32.4, "least_detectable_indentation_um": 2.5,
            "noise_V": 1e-3,
        },
        "mesh": {"tetrahedra": 13600, "nodes": 20000, "unknowns": 60000, "min_dihedral_deg": 27.0,
                 "region_volume_error": {"film": 1e-9}},
        "solver": {"converged": True, "failure": None, "load_steps": 2, "newton_iterations": 11,
                   "linear_solver": "pardiso", "max_relative_residual": 1e-11},
        "timing_s": {"geometry": 1.0, "mesh": 5.5, "solve": 40.0, "export": 9.0},
        "warnings": [],
    }  # fmt: skip
    return base | changes


def page(path: Path, found: dict[str, Any], view: dict[str, Any] | None = None) -> str:
    picture = path / "film.png"
    picture.write_bytes(PIXEL)
    write_report(found, {"film": picture}, view, path / "report.html")
    return (path / "report.html").read_text(encoding="utf-8")


class Sources(HTMLParser):
    """Every attribute through which a page could load something, and the visible text."""

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.text = ""

    def handle_starttag(self, _tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.links += [value or "" for name, value in attrs if name in ("src", "href", "srcset", "action", "data")]

    def handle_data(self, data: str) -> None:
        self.text += " " + data


def parsed(html: str) -> Sources:
    sources = Sources()
    sources.feed(html)
    sources.text = re.sub(r"\s+", " ", sources.text)
    return sources


@pytest.fixture(scope="module")
def view(segment: TetMesh, press: PressResult, dot: DotShape) -> dict[str, Any]:
    return viewer_data(segment, press, dot)


def test_nothing_is_loaded_from_elsewhere(tmp_path: Path, view: dict[str, Any]) -> None:
    html = page(tmp_path, summary(), view)
    assert not re.search(r"https?://|@import|url\(|\bfetch\(|XMLHttpRequest|\bimport\(", html)
    assert all(link.startswith("data:") for link in parsed(html).links)
    assert len(parsed(html).links) == 2


def test_headline_numbers_carry_units(tmp_path: Path) -> None:
    text = parsed(page(tmp_path, summary())).text
    for expected in (
        "1.234 N",
        "1.75 V",
        "40 pC",
        "23.7 pF",
        "5.83 V/mm",
        "32.4 pC/N",
        "2.5 µm",
        "2.1 %",
        "44 MPa",
    ):
        assert expected in text
    assert "for a noise of 1 mV" in text
    assert "did not converge" not in text
    assert "Read-out voltage" not in text


def test_readout_is_shown_when_there_is_one(tmp_path: Path) -> None:
    text = parsed(page(tmp_path, summary(readout_voltage_V=[0.0, 0.001, 0.0123]))).text
    assert "Read-out voltage 0.0123 V" in text


def test_a_run_that_did_not_converge_says_so_at_the_top(tmp_path: Path) -> None:
    solver = summary()["solver"] | {"converged": False, "failure": "no equilibrium beyond 0.2 mm"}
    text = parsed(page(tmp_path, summary(solver=solver))).text
    assert "The computation did not converge." in text
    assert "Reason: no equilibrium beyond 0.2 mm." in text
    assert text.index("did not converge") < text.index("Reaction force")


def test_a_run_that_stopped_before_the_solver_still_has_a_report(tmp_path: Path) -> None:
    found = {key: summary()[key] for key in ("config", "warnings")}
    found["solver"] = {"converged": False, "failure": "meshing took too long", "load_steps": 0}
    text = parsed(page(tmp_path, found)).text
    assert "There is no result to show." in text
    assert "Reaction force" not in text


def test_warnings_stand_in_a_box(tmp_path: Path) -> None:
    assert 'id="warnings"' not in page(tmp_path, summary())
    html = page(tmp_path, summary(warnings=["strain 0.4 is beyond <0.3>"]))
    assert "strain 0.4 is beyond &lt;0.3&gt;" in html[html.index('id="warnings"') :]


def test_the_whole_configuration_is_shown_as_text(tmp_path: Path, view: dict[str, Any]) -> None:
    html = page(tmp_path, summary(), {**view, "names": [NASTY]})
    assert NASTY not in html
    assert "alert(1)" in parsed(html).text
    assert html.count("</script>") == 2


def test_slice_is_described_as_a_slice(tmp_path: Path) -> None:
    flat = summary(config={"segment": {"section": "plane-strain"}})
    assert "thin lines" in page(tmp_path, summary())
    assert "thin lines" not in page(tmp_path, flat)


def test_failed_write_leaves_nothing_behind(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        write_report(summary(), {"film": tmp_path / "missing.png"}, None, tmp_path / "report.html")
    assert list(tmp_path.iterdir()) == []


@for_each(
    ("value", "text"),
    [(0.0, "0"), (1.23456, "1.235"), (-0.5, "\u22120.5"), (100.0, "100"), (3e-12, "3.000e-12"),
     (13600, "13\u202f600"),
     (None, "\u2013"), (True, "yes"), ([1.0, 2.5], "1, 2.5"), (1234.56, "1235"), ("pardiso", "pardiso")],
)  # fmt: skip
def test_numbers_are_written_for_people(value: object, text: str) -> None:
    assert number(value) == text


def unpack(text: str, kind: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text), kind)


def test_view_holds_the_deformed_shape(view: dict[str, Any]) -> None:
    points = unpack(view["points"], "<f4").reshape(-1, 3)
    moved = unpack(view["displacement"], "<i2").reshape(len(view["steps"]), -1, 3) * view["displacementUnit"]
    assert [step["indentation"] for step in view["steps"]] == pytest.approx(DEPTHS_MM)
    assert not moved[0].any()
    assert moved[3][:, 2].min() == pytest.approx(-0.3, rel=1e-3)
    for name in ("outer", "section", "film"):
        assert unpack(view[name], "<u4").max() < len(points)
    front = points[unpack(view["section"], "<u4")]
    np.testing.assert_allclose(front[:, 1], view["plane"], atol=1e-5)
    assert len(unpack(view["stress"], "u1")) == len(view["steps"]) * len(points)
    assert np.array(view["dotShift"])[-1] == pytest.approx([0, 0, -0.3])


def test_view_of_twenty_thousand_tetrahedra_fits_the_page(tmp_path: Path, dot: DotShape) -> None:
    big = box_mesh(24)
    assert len(big.tets) > 20_000
    result = made_up_press(big)
    long = type(result)(**{**result.__dict__, "steps": tuple(result.steps[k % 4] for k in range(40))})
    html = page(tmp_path, summary(), viewer_data(big, long, dot))
    room_for_pictures = 1.5e6
    assert len(html) < 6e6 - room_for_pictures
    assert len(json.loads(re.findall(r'id="view-data">(.*?)</script>', html, re.S)[0])["steps"]) == 9


def test_viewer_is_short_and_by_itself() -> None:
    code = Path("export/viewer.js").read_text(encoding="utf-8")
    assert code.count("\n") <= 250
    assert "import " not in code


def test_the_headline_strain_says_where_it_is_and_the_rim_is_told_apart(tmp_path: Path) -> None:
    film = {"max_principal_strain": 0.002, "rim_distance_mm": 0.14, "rim_principal_strain": 0.017}
    html = page(tmp_path, summary(film=film))
    assert "at least 0.14 mm from held sides" in html
    assert "Film strain, held sides included" in html
    free = page(tmp_path, summary(film={**film, "rim_distance_mm": 0.0}))
    assert "held sides included" not in free
