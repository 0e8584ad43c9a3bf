"""The study as files: page, numbers, tables, and nothing at all when it cannot be made."""

import csv
import json
import re

import pytest

from softdot.cli import main
from softdot.commands import paper as whole
from softdot.studies.paper.analytical.section import section as analytical
from softdot.studies.paper.presses import NotSolvedError
from softdot.studies.paper.published import published_numbers
from softdot.studies.paper.segments.section import section_of
from tests.studies.paper.stand_in_study import study

PARTS = {
    "analytical": analytical,
    "segments": lambda _progress, folder, _executor: section_of(study(), folder),
}
NAMES, FIND = whole.STUDY_PARTS, whole._part
FOR_CALIBRATION = ("table1.", "section2.p", "section2.h2", "section2.E2")


@pytest.fixture(autouse=True, scope="module")
def no_presses():
    """Sections of made-up presses, so that nothing is solved."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(whole, "STUDY_PARTS", ("analytical", "segments"))
        patch.setattr(whole, "_part", PARTS.__getitem__)
        yield


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The folder of a study."""
    out = tmp_path_factory.mktemp("study") / "out"
    assert main(["paper", "-o", str(out)]) == 0
    return out


def test_every_part_of_the_page_is_found():
    assert all(callable(FIND(name)) for name in NAMES)
    assert FIND("analytical") is analytical


@pytest.mark.press
def test_the_folder_holds_page_numbers_figures_and_tables(made):
    assert sorted(path.name for path in made.iterdir()) == ["figures", "log.txt", "paper.html", "paper.json", "tables"]
    assert {"segment.png", "fig07-free.png", "fig08-clamped.png", "fig10-selected.png"} <= {
        path.name for path in (made / "figures").iterdir()
    }


def test_the_page_needs_no_other_file(made):
    page = (made / "paper.html").read_text("utf-8")
    sources = re.findall(r'(?:src|href)="([^"]*)"', page)
    assert sources
    assert all(source.startswith(("data:", "#")) for source in sources)
    for target in re.findall(r'href="#([^"]+)"', page):
        assert f'id="{target}"' in page
    assert "{{" not in page
    assert ">None<" not in page


def test_every_published_number_is_in_the_json_with_ours_and_the_ratio(made):
    summary = json.loads((made / "paper.json").read_text("utf-8"))
    assert summary["format"] == "softdot-paper/1"
    entries = {entry["key"]: entry for entry in summary["published"]}
    assert list(entries) == list(published_numbers())
    slip = entries["table4.C1.S1b"]
    assert (slip["paper"], slip["misprint"] is not None) == (5.2, True)
    assert slip["ours"] == pytest.approx(6.1035, rel=1e-4)
    assert slip["ratio"] == pytest.approx(slip["ours"] / 5.2)


def test_what_formulas_and_segments_must_answer_is_answered(made):
    summary = json.loads((made / "paper.json").read_text("utf-8"))
    open_ = {entry["key"] for entry in summary["published"] if entry["ours"] is None}
    mine = {key for key in open_ if not key.startswith(FOR_CALIBRATION)}
    assert mine == {"table2.dot.E_MPa", "table2.dot.nu", "table2.dot.density_kg_m3"}


def test_tables_are_csv_files_with_equally_long_rows(made):
    files = list((made / "tables").glob("*.csv"))
    assert {"paper-table3", "both-readings", "published-numbers", "claims", "misprints"} <= {f.stem for f in files}
    for file in files:
        with file.open(encoding="utf-8", newline="") as stream:
            lengths = {len(row) for row in csv.reader(stream)}
        assert len(lengths) == 1, file


@pytest.mark.press
def test_json_goes_to_standard_output(tmp_path, capfd):
    assert main(["paper", "-o", str(tmp_path / "out"), "--json"]) == 0
    assert json.loads(capfd.readouterr().out)["format"] == "softdot-paper/1"


@pytest.mark.press
def test_a_study_is_replaced_but_a_foreign_folder_is_refused(made, tmp_path, capsys):
    assert main(["paper", "-o", str(made)]) == 0
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "thesis.txt").write_text("x", "utf-8")
    assert main(["paper", "-o", str(tmp_path / "mine")]) == 2
    assert "holds 'thesis.txt'" in capsys.readouterr().err


def test_a_press_without_result_exits_3_and_writes_nothing(monkeypatch, tmp_path, capsys):
    def fails(_progress, _folder, _executor):
        raise NotSolvedError("solid, F1: not-converged, contact")

    monkeypatch.setitem(PARTS, "segments", fails)
    assert main(["paper", "-o", str(tmp_path / "out")]) == 3
    assert "solid, F1: not-converged, contact" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
