"""Design by reading: the least force, the Pareto front, what is tried next, and how a search is stopped and resumed."""

import json
from pathlib import Path

import numpy as np
import pytest

from foundation.errors import InputError
from softdot.arrays.case import ArrayCase
from softdot.cli import main
from softdot.config.hashes import config_hash
from softdot.config.loading import load_config
from softdot.progress import Untold
from softdot.reading.conditions import ReadingConditions
from softdot.reading.designs import operating
from softdot.reading.designs.design_file import load_request
from softdot.reading.designs.operating import DesignTask, crosstalk_percent, depths, design_record, reading_at
from softdot.reading.designs.results import reading_rows, write_results
from softdot.reading.designs.run import FOLDER, AskedReading, DesignWork, run_search
from softdot.reading.designs.search import pareto, propose
from softdot.sweeps.folder import read_table
from softdot.sweeps.points import failed_record
from softdot.sweeps.sampling import Axis, share_of, value_at_share
from tests.cases import for_each
from tests.softdot.reading.made_kernel import made_kernel

FILE = Path("examples/array-designs.toml")
ASKED = AskedReading("dots", None, "model", ReadingConditions())


def task(text="dots", **changed):
    told = {"config": load_config("examples/array-cell.toml"), "conditions": ReadingConditions(), "text": text}
    return DesignTask(**{**told, "table": None, "decoder": "model", "repeats": 1, "accuracy": 0.99, **changed})


def better(one, other):
    """By definition: as small in all, and smaller in one."""
    return all(a <= b for a, b in zip(one, other, strict=True)) and any(a < b for a, b in zip(one, other, strict=True))


@for_each("columns", [2, 3])
def test_the_front_is_what_no_other_point_is_better_than(columns):
    """With ties, which random integers have many of; two equal points do not beat each other."""
    points = np.random.default_rng(columns).integers(0, 6, (60, columns)).astype(float)
    front = pareto(points)
    expected = [not any(better(other, one) for other in points.tolist()) for one in points.tolist()]
    assert front.tolist() == expected
    assert 0 < front.sum() < len(points)


def test_readings_of_the_front_have_less_of_something():
    def reading(force, crosstalk, accuracy):
        return {"mean_force_N": force, "crosstalk_percent": crosstalk, "accuracy": accuracy}

    rows = reading_rows(
        [
            {"name": "a", "readings": [reading(0.1, 5.0, 1.0), reading(0.05, 5.0, 0.9), reading(None, 5.0, 0.0)]},
            {"name": "b", "readings": [reading(0.2, 5.0, 1.0), reading(0.2, 1.0, 0.8)]},
        ]
    )
    assert [row["pareto"] for row in rows] == [True, True, False, True]


@for_each("true_mm", [0.04, 0.11, 0.19])
def test_the_least_depth_is_halved(true_mm):
    """A text that is read from a depth on, and not above it."""
    readings = []
    for depth in depths(0.25, readings, 0.99):
        readings.append({"depth_mm": depth, "accuracy": 1.0 if depth >= true_mm else 0.7})
    least = min(one["depth_mm"] for one in readings if one["accuracy"] == 1.0)
    assert 0.0 <= least / true_mm - 1.0 < 0.08
    assert len(readings) == 6


def test_what_does_not_read_at_the_deepest_is_tried_no_more():
    readings = []
    for depth in depths(0.25, readings, 0.99):
        readings.append({"depth_mm": depth, "accuracy": 0.5})
    assert len(readings) == 1


def test_crosstalk_is_that_of_the_charges_where_all_capacitances_are_equal():
    """By the kernel's own formula: one dot over each segment, the largest share of the others."""
    kernel = made_kernel(crosstalk=0.2)
    x, y = kernel.centres_mm.T
    charge = kernel.of_one(x, y, np.full(6, 0.3))[0]
    largest = max(charge[i, j] / charge[i, i] for i in range(6) for j in range(6) if i != j)
    assert crosstalk_percent(kernel, 0.3) == pytest.approx(100.0 * largest)
    assert crosstalk_percent(made_kernel(crosstalk=0.0), 0.3) < crosstalk_percent(kernel, 0.3)


def test_a_reading_tells_characters_interval_and_force():
    kernel = made_kernel(interaction=0.0)
    told = reading_at(kernel, task("dots"), 0.2)
    assert (told["right"], told["of"], told["accuracy"]) == (4, 4, 1.0)
    assert told["low"] < 0.6  # four characters promise little
    one = 0.4 * (0.2 / 0.3) ** 1.3  # of a dot in the middle
    assert one < told["peak_force_N"] < 6.0 * one
    assert 0.0 < told["mean_force_N"] < told["peak_force_N"]


def test_repeats_end_where_no_other_one_can_help():
    """In noise no dot is found: one repeat of the ten is enough to know."""
    told = reading_at(made_kernel(), task("dots", conditions=ReadingConditions(noise_mV=1e6), repeats=10), 0.2)
    assert told["right"] < 4
    assert told["of"] == 4


def test_a_value_of_an_axis_has_a_share_and_comes_back():
    for axis, values in (
        (Axis(key="a", low=0.2, high=3.0), (0.2, 1.1, 3.0)),
        (Axis(key="a", low=0.1, high=10.0, scale="log"), (0.1, 0.7, 10.0)),
        (Axis(key="a", values=("free", "clamped", "elastic")), ("free", "clamped", "elastic")),
    ):
        assert [value_at_share(axis, share_of(axis, value)) for value in values] == pytest.approx(list(values))


AXES = (
    Axis(key="a", low=0.1, high=10.0, scale="log"),
    Axis(key="b", low=0.0, high=1.0),
    Axis(key="c", values=("soft", "hard")),
)


def made_force_N(row):
    """Least at a = 2, b = 0.3, soft; none reads above a = 8."""
    a, b, c = row
    return None if a > 8.0 else 0.05 * np.exp(np.log(a / 2.0) ** 2 + 6.0 * (b - 0.3) ** 2) * (1.0 if c == "soft" else 2)


def test_what_is_tried_next_comes_nearer_to_the_best():
    random = np.random.default_rng(4)
    rows = [
        tuple(value_at_share(axis, share) for axis, share in zip(AXES, random.random(3), strict=True)) for _ in range(8)
    ]
    before = min(filter(None, map(made_force_N, rows)))
    for number in range(4):
        chosen = propose(AXES, rows, [made_force_N(row) for row in rows], 3, number)
        assert len(chosen) == len(set(chosen)) == 3
        assert chosen == propose(AXES, rows, [made_force_N(row) for row in rows], 3, number)
        assert all(0.1 <= a <= 10.0 and 0.0 <= b <= 1.0 and c in ("soft", "hard") for a, b, c in chosen)
        rows += chosen
    after = min(filter(None, map(made_force_N, rows)))
    assert after < before
    assert after < 1.1 * 0.05


def test_where_too_few_read_the_space_is_filled():
    rows = [(1.0, 0.5, "soft"), (2.0, 0.1, "hard")]
    assert len(propose(AXES, rows, [None, None], 3, 0)) == 3


def small(tmp_path, **search):
    """The request of a few designs."""
    told = "".join(f"{name} = {value}\n" for name, value in {"rounds": 2, "each": 2, **search}.items())
    head, _, rest = FILE.read_text("utf-8").partition("\n[search]\n")
    compared = rest[rest.index("[[search.compared]]") :]
    path = tmp_path / "designs.toml"
    path.write_text(head + f"\n[search]\n{told}\n{compared}", "utf-8")
    return load_request(path)


def made_record(asked):
    """As if it had been pressed and read: soft designs read with less force; one kernel fails, one worker dies."""
    hardness = asked.config.materials["vnr"].youngs_modulus_MPa
    readings = [
        {
            "depth_mm": depth, "right": right, "of": 10, "accuracy": right / 10, "low": 0.5, "high": 1.0,
            "mean_force_N": depth * hardness / 10.0, "peak_force_N": depth, "crosstalk_percent": 30.0 / hardness,
        }
        for depth, right in ((0.05, 5), (0.1, 10), (0.2, 10))
    ]  # fmt: skip
    return {"status": "solved", "reason": None, "readings": readings, "least": readings[1], "seconds": 1.0}


class Workers:
    """In place of a cluster: counts what it does, and may stop."""

    def __init__(self, stop_after=99, refuse=(), status="not-converged"):
        self.done, self.stop_after, self.refuse, self.status = [], stop_after, refuse, status

    def all_ended(self, _executor, _function, arguments):
        for name, (asked,) in arguments.items():
            if len(self.done) == self.stop_after:
                raise KeyboardInterrupt
            self.done.append(name)
            yield name, failed_record(self.status, "at 0.1 mm") if name in self.refuse else made_record(asked)


def search_with(workers, request, folder, monkeypatch):
    monkeypatch.setattr("softdot.sweeps.points.records_as_completed", workers.all_ended)
    folder.mkdir(exist_ok=True)
    return run_search(DesignWork(request, ASKED, folder, None, Untold()))


def test_a_kernel_that_fails_is_recorded_and_stops_no_other(tmp_path, monkeypatch):
    request = small(tmp_path)
    found = search_with(Workers(refuse=("design 2",)), request, tmp_path / FOLDER, monkeypatch)
    assert len(found.designs) == 3 + 4 + 2 * 2
    assert found.records["design 2"]["reason"] == "at 0.1 mm"
    assert found.least_N(found.designs[4]) is None
    softest = min(
        (one for one in found.designs if found.least_N(one) is not None),
        key=lambda one: one.config.materials["vnr"].youngs_modulus_MPa,
    )
    assert found.best is softest


@pytest.mark.press
def test_a_search_that_was_stopped_goes_on_where_it_was(tmp_path, monkeypatch):
    request, folder = small(tmp_path), tmp_path / FOLDER
    whole = search_with(Workers(), request, tmp_path / "whole", monkeypatch)
    stopped, resumed, again = Workers(stop_after=8), Workers(), Workers()
    with pytest.raises(KeyboardInterrupt):
        search_with(stopped, request, folder, monkeypatch)
    found = search_with(resumed, request, folder, monkeypatch)
    assert stopped.done + resumed.done == [one.name for one in whole.designs]
    assert [one.values for one in found.designs] == [one.values for one in whole.designs]
    assert search_with(again, request, folder, monkeypatch).records == found.records
    assert again.done == []


def test_a_worker_that_died_is_an_accident_that_is_tried_again(tmp_path, monkeypatch):
    request, folder = small(tmp_path, rounds=0), tmp_path / FOLDER
    search_with(Workers(refuse=("design 1", "design 3"), status="lost"), request, folder, monkeypatch)
    again = Workers()
    search_with(again, request, folder, monkeypatch)
    assert again.done == ["design 1", "design 3"]


@pytest.mark.press
def test_results_are_one_table_a_picture_and_a_design_that_can_be_pressed(tmp_path, monkeypatch):
    request = small(tmp_path)
    found = search_with(Workers(refuse=("design 2",)), request, tmp_path / FOLDER, monkeypatch)
    told = write_results(tmp_path, request, ASKED, found)
    assert told == json.loads((tmp_path / "design.json").read_text("utf-8"))
    assert told["best"]["name"] == found.best.name
    assert "design 2: not-converged, at 0.1 mm" in told["warnings"]
    best = load_config(tmp_path / "best.toml")
    assert config_hash(best) == told["best"]["config_hash"] == config_hash(found.best.config)
    assert ArrayCase(best).warnings is not None
    (tmp_path / "sweep.parquet").write_bytes((tmp_path / "designs.parquet").read_bytes())
    rows = read_table(tmp_path).to_pylist()
    assert [row["name"] for row in rows] == [one.name for one in found.designs]
    assert sum(row["best"] for row in rows) == 1
    front = [(row["mean_force_N"], row["crosstalk_percent"]) for row in rows if row["front"]]
    others = [(row["mean_force_N"], row["crosstalk_percent"]) for row in rows if row["mean_force_N"] is not None]
    assert not any(better(other, one) for one in front for other in others)
    assert (tmp_path / "pareto.png").stat().st_size > 20_000
    page = (tmp_path / "report.html").read_text("utf-8")
    assert "not-converged" in page
    assert "http" not in page.replace("http://www.w3.org", "")


def test_a_design_that_cannot_be_is_refused_with_its_reason():
    config = load_config("examples/array-cell.toml", ["array.electrode_margin_mm=1.2"])
    told = design_record(task(config=config))
    assert (told["status"], told["least"]) == ("refused", None)
    assert told["reason"].startswith("array.electrode_margin_mm = 1.2")


def test_a_press_that_stops_is_told(monkeypatch):
    def stop(_):
        raise operating.StoppedDesignError("the press at x = 0 mm, y = 0 mm did not converge: at 0.1 mm")

    monkeypatch.setattr(operating, "coarse_kernel", stop)
    told = design_record(task())
    assert (told["status"], told["least"], told["readings"]) == ("not-converged", None, [])


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('key = "segment.medium1.thickness_mm"', 'key = "segment.medium9.thickness_mm"', "medium9 is not a key"),
        ("low = 0.3\nhigh = 1.0", "low = 0.3\nhigh = 0.2", "sweep.axes[2]"),
        ("rounds = 2", "round = 2", "search.round"),
        ("rounds = 2", "rounds = -1", "search.rounds = -1"),
        ("accuracy = 0.99", "accuracy = 1.5", "search.accuracy = 1.5"),
        ("paper's final design, rim between", "paper's final design, free", "search.compared"),
        ('"segment.side_stiffness_N_per_mm3" = 75.0', '"segment.side_stifness" = 75.0', "search.compared[1]"),
        ("indentation_mm = 0.3", "force_N = 0.3", "press.force_N = 0.3: give either"),
    ],
)
def test_bad_designs_are_one_sentence(tmp_path, capfd, old, new, sentence):
    text = FILE.read_text("utf-8")
    assert old in text
    path = tmp_path / "designs.toml"
    path.write_text(text.replace(old, new), "utf-8")
    assert main(["read", "--design", str(path), "-q", "-o", str(tmp_path / "out")]) == 2
    said = capfd.readouterr().err
    assert said.count("softdot: ") == 1
    assert sentence in said
    assert not (tmp_path / "out").exists()


def test_a_file_without_axes_or_array_is_refused(tmp_path):
    path = tmp_path / "designs.toml"
    path.write_text(Path("examples/array-cell.toml").read_text("utf-8"), "utf-8")
    with pytest.raises(InputError, match="sweep is missing"):
        load_request(path)
    path.write_text(path.read_text("utf-8") + "\n[sweep]\naxes = []\n", "utf-8")
    with pytest.raises(InputError, match=r"sweep\.axes"):
        load_request(path)
    with pytest.raises(InputError, match="array is missing"):
        load_request(Path("examples/sweep.toml"))


def test_bad_requests_for_designs_are_one_sentence(kernel_folder, tmp_path, capfd):
    for options, sentence in {
        ("--depth-mm", "0.1"): "--depth-mm = 0.1: --design finds it",
        ("--force-N", "0.1"): "--force-N = 0.1: --design finds it",
        ("--mode", "press"): "--mode press: --design slides",
        ("--kernel", str(kernel_folder)): "--design: makes its own kernels",
        ("--study",): "--design: is another search than --study",
        ("--scheduler", "nowhere"): "--scheduler 'nowhere': must be tcp://HOST:PORT",
    }.items():
        assert main(["read", "a", "--design", str(FILE), *options, "-q", "-o", str(tmp_path / "out")]) == 2
        assert capfd.readouterr().err.startswith(f"softdot: {sentence}")
        assert not (tmp_path / "out").exists()
    assert main(["read", "a", "-q", "-o", str(tmp_path / "out")]) == 2
    assert "--kernel is missing" in capfd.readouterr().err


TINY = """
[mesh]
element_size_mm = 0.6
contact_element_size_mm = 0.3
"""


@pytest.mark.evidence
def test_designs_are_pressed_read_and_kept(tmp_path):
    """From the command line, by a real cluster: two designs on the coarsest mesh, and nothing is pressed twice."""
    text = FILE.read_text("utf-8")
    text = text.replace("[mesh]\nelement_size_mm = 0.5\ncontact_element_size_mm = 0.15\n", TINY.lstrip())
    for old, new in (("points = 4", "points = 1"), ("rounds = 2", "rounds = 0"), ("repeats = 2", "repeats = 1")):
        text = text.replace(old, new)
    cut = text.index("[[search.compared]]\nname = \"paper's final design, rim")
    path, out = tmp_path / "designs.toml", tmp_path / "out"
    path.write_text(text[:cut], "utf-8")
    command = ["read", "dots", "--design", str(path), "--workers", "1", "-q", "-o", str(out)]
    assert main(command) == 0
    told = json.loads((out / "design.json").read_text("utf-8"))
    assert [one["name"] for one in told["designs"]] == ["paper's final design, free", "design 1"]
    papers = told["designs"][0]
    assert papers["status"] == "solved"
    forces = [one["mean_force_N"] for one in papers["readings"] if one["mean_force_N"] is not None]
    assert forces == sorted(forces)
    kept = {one: one.stat().st_mtime_ns for one in (out / "designs").iterdir()}
    assert main(command) == 0
    assert {one: one.stat().st_mtime_ns for one in (out / "designs").iterdir()} == kept
    assert json.loads((out / "design.json").read_text("utf-8")) == told
