"""Pictures show what was found, where it was found."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.image import imread

from diagnose.findings import Fit, LocatedExcess
from diagnose.forward import Setting
from diagnose.pictures.evidence import draw_gains, draw_shares
from diagnose.pictures.overview import BAND_EDGES_HZ, band_number, draw_overview, excess_percent
from diagnose.pictures.run import channels_to_draw, draw_run
from tests.cases import for_each
from tests.diagnose.verdict.toy import LEAK, RELAXING, fitted, found, toy_recording, toy_run

LEAKS, RELAXES = fitted(LEAK, 0.5), fitted(RELAXING, 0.3, 0.09)


@pytest.fixture(scope="module")
def recording():
    runs = (toy_run("slow", channels=("voltage_V", "force_N")), toy_run("quick", rise_s=0.1))
    return toy_recording([Setting(LEAK, (0.5,))], runs)


def place(run="slow", phase="hold", press=0, band=(0.0, 2.0), share=0.5, channel="voltage_V"):
    return LocatedExcess(run, channel, phase, press, band, 12.0, 1e-4, share, "")


def share_of(colour, path):
    """Share of the pixels of a picture that are near a colour (r, g, b)."""
    pixels = imread(path)[..., :3]
    return float(np.mean(np.abs(pixels - np.array(colour)).max(axis=-1) < 0.15))


@for_each(
    ("band", "column"), [((0.0, 0.4), 0), ((0.4, 0.8), 0), ((1.0, 2.0), 1), ((5.0, 10.0), 2), ((320.0, 640.0), 6)]
)
def test_a_band_falls_into_the_column_that_holds_its_middle(band, column):
    assert band_number(place(band=band)) == column
    assert len(BAND_EDGES_HZ) == 8


def test_a_cell_shows_the_excess_of_all_its_presses():
    places = [place(share=0.2), place(press=1, share=0.1), place(run="quick", share=0.3), place(phase="after")]
    table = excess_percent(places, [("slow", "voltage_V"), ("quick", "voltage_V")], "hold", [0, band_number(places[0])])
    assert table[:, 1] == pytest.approx([30.0, 30.0])
    assert np.isnan(table[:, 0]).all()


def test_the_overview_is_redder_the_more_places_there_are(recording, tmp_path):
    findings = found(recording, (LEAKS,), LEAKS, ((0,),))
    phases = ("loading", "hold", "unloading", "after")
    many = replace(findings, places=tuple(place(run, phase) for run in ("slow", "quick") for phase in phases))
    dark = (0.4, 0.0, 0.05)
    few_red = share_of(dark, draw_overview(recording, findings, tmp_path / "few.png"))
    assert share_of(dark, draw_overview(recording, many, tmp_path / "many.png")) > 2.0 * few_red > 0.0
    assert draw_overview(recording, found(recording, mismatch=False), tmp_path / "none.png") is None


def test_a_run_shows_before_after_and_the_full_model(recording, tmp_path):
    findings = found(recording, (LEAKS,), LEAKS, ((0,),))
    run, green, amber = recording.runs[1], (0.18, 0.48, 0.3), (0.82, 0.54, 0.0)
    without = draw_run(run, found(recording, mismatch=False), None, tmp_path / "a.png")
    named = draw_run(run, findings, findings.improved["quick"], tmp_path / "b.png")
    assert share_of(green, without) == share_of(amber, without) == 0.0
    assert share_of(green, named) > 0.0
    assert share_of(amber, named) > 0.0


def test_an_explanation_without_a_name_is_drawn_where_it_comes_closer(recording, tmp_path):
    tried = Fit(("quick, press 1",), 0.84, 0.4, 0.026, 100.0)
    closest = found(recording, (LEAKS,), LEAKS, ((0,),)).improved
    findings = found(recording, (LEAKS,), None, ((0,),), unexplained=True, unnamed=tried, closest=closest)
    farther = replace(findings, unnamed=replace(tried, nrmse_after=0.9))
    run, blue, green = recording.runs[1], (0.23, 0.43, 0.66), (0.18, 0.48, 0.3)
    drawn = draw_run(run, findings, None, tmp_path / "closer.png")
    assert share_of(blue, drawn) > 0.0
    assert share_of(green, drawn) == 0.0
    assert share_of(blue, draw_run(run, farther, None, tmp_path / "farther.png")) == 0.0


def test_of_many_channels_those_that_differ_most_are_drawn():
    names = tuple(f"voltage_{n}_V" for n in range(1, 7))
    run = toy_run(channels=names)
    run = replace(run, channels={**run.channels, **{name: np.full(300, float(n)) for n, name in enumerate(names)}})
    findings = replace(found(toy_recording()), baseline={"slow": dict.fromkeys(names, np.zeros(300))})
    assert channels_to_draw(run, findings) == list(names[2:])


def test_bars_are_only_drawn_of_what_there_is(recording, tmp_path):
    findings = found(recording, (LEAKS, RELAXES), LEAKS, ((0,), (1,)))
    assert draw_gains(findings, tmp_path / "gains.png").exists()
    assert draw_shares(findings, tmp_path / "shares.png").exists()
    assert draw_gains(replace(findings, models=()), tmp_path / "no.png") is None
    assert draw_shares(replace(findings, shares={"film": 0.0}), tmp_path / "no.png") is None
