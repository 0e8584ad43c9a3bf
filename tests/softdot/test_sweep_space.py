"""SPACE.toml: what is allowed, what is refused by name, and where the points lie."""

import itertools
import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from foundation.errors import InputError
from softdot.cli import main
from softdot.config.toml import key_path, with_value
from softdot.sweeps.space import load_space, space_from
from softdot.warm_up import TINY_CONFIG
from tests.cases import for_each
from tests.softdot.sweep_spaces import depths, space_of
from tests.softdot.toml_text import toml_text

ROOT = Path(__file__).parents[2]
T1, T2 = "segment.medium1.thickness_mm", "segment.medium2.thickness_mm"
RANGE = {"key": T1, "low": 0.4, "high": 1.6}


def values(space, key=T1):
    return [point.values[key] for point in space.points]


BAD_SWEEPS = {
    "none": (None, "sweep is missing: SPACE.toml needs a table [sweep] with at least one [[sweep.axes]]"),
    "no axes": ({}, "sweep.axes is missing: what varies"),
    "no axis": ({"axes": []}, "sweep.axes = []: must have at least 1 value"),
    "typo": ({"axes": [depths(0.1)], "sampling": "sobel"},
             "sweep.sampling = 'sobel': must be 'grid', 'list', 'latin-hypercube' or 'sobol'"),
    "unknown": ({"axes": [depths(0.1)], "number": 3},
                "sweep.number is not a key; known are axes, points, sampling, seed, workers"),
    "no key": ({"axes": [{"values": [1]}]}, "sweep.axes[0].key is missing"),
    "key and keys": ({"axes": [{"key": T1, "keys": [T2], "values": [1]}]},
                     "sweep.axes[0].keys: give either key or keys, not both"),
    "bad key": ({"axes": [{"key": "segment..x", "values": [1]}]},
                "sweep.axes[0].key = 'segment..x': "
                "must be names joined by dots, with [0], [1], … for elements of lists"),
    "no values": ({"axes": [{"key": T1, "values": []}]}, "sweep.axes[0].values = []: must have at least 1 value"),
    "half a range": ({"axes": [{"key": T1, "low": 0.1}]},
                     "sweep.axes[0].high is missing: an axis needs values, or low and high"),
    "neither": ({"axes": [{"key": T1}]}, "sweep.axes[0].values is missing: an axis needs values, or low and high"),
    "both": ({"axes": [{"key": T1, "low": 0.1, "values": [1]}]},
             "sweep.axes[0].low = 0.1: give either values or low and high, not both"),
    "reversed": ({"axes": [{"key": T1, "low": 2.0, "high": 1.0, "n": 2}]},
                 "sweep.axes[0].low = 2: must be below high = 1"),
    "log of zero": ({"axes": [{"key": T1, "low": 0.0, "high": 1.0, "n": 2, "scale": "log"}]},
                    "sweep.axes[0].low = 0: must be above 0 with scale = 'log'"),
    "text as low": ({"axes": [{"key": T1, "low": "0.4 mm", "high": 1.0}]},
                    "sweep.axes[0].low = '0.4 mm': must be a plain number; its unit is part of the key"),
    "grid without n": ({"axes": [RANGE]},
                       "sweep.axes[0].n is missing: a grid needs the number of values from low to high"),
    "grid with points": ({"axes": [depths(0.1)], "points": 9},
                         "sweep.points = 9: the axes of sampling = 'grid' say how many there are"),
    "sobol without points": ({"axes": [RANGE], "sampling": "sobol"},
                             "sweep.points is missing: sampling = 'sobol' needs the number of points"),
    "sobol with n": ({"axes": [{**RANGE, "n": 3}], "sampling": "sobol", "points": 4},
                     "sweep.axes[0].n = 3: is for sampling = 'grid' only"),
    "no points": ({"axes": [RANGE], "sampling": "sobol", "points": 0}, "sweep.points = 0: must be at least 1"),
    "list of a range": ({"axes": [RANGE], "sampling": "list"},
                        "sweep.axes[0].values is missing: sampling = 'list' needs the values themselves"),
    "unequal list": ({"axes": [depths(0.1, 0.2), {"key": T1, "values": [0.5]}], "sampling": "list"},
                     "sweep.axes[1].values has 1 values but axes[0].values has 2: one of each per point"),
    "same key": ({"axes": [depths(0.1), depths(0.2)]},
                 "sweep.axes: 'press.indentation_mm' and 'press.indentation_mm' set the same key; "
                 "remove one of them"),
    "key in key": ({"axes": [depths(0.1), {"key": "press", "values": [{}]}]},
                   "sweep.axes: 'press.indentation_mm' and 'press' set the same key; remove one of them"),
    "huge": ({"axes": [{**RANGE, "n": 200}, {"key": T2, "low": 0.1, "high": 1.0, "n": 200}]},
             "sweep.axes: this grid has 200 × 200 = 40000 points, at most 20000 are allowed"),
    # axes with which no point can be built
    "unknown key of the configuration": (
        {"axes": [{"key": "segment.medium1.thicknes_mm", "values": [0.5]}]},
        "sweep.axes[0]: segment.medium1.thicknes_mm is not a key; did you mean 'thickness_mm'?"),
    "bad value": ({"axes": [depths(0.1), {"key": T1, "values": [0.5, -0.5]}]},
                  f"sweep.axes[1].values[1] = -0.5: {T1} = -0.5: must be above 0"),
    "bad end": ({"axes": [{"key": T1, "low": 0.0, "high": 1.0}], "sampling": "sobol", "points": 4},
                f"sweep.axes[0].low = 0: {T1} = 0: must be above 0"),
    "bad text": ({"axes": [{"key": "segment.boundary", "values": ["free", "fixed"]}]},
                 "sweep.axes[0].values[1] = 'fixed': "
                 "segment.boundary = 'fixed': must be 'free', 'clamped' or 'elastic'"),
    "number for text": ({"axes": [{"key": "segment.boundary", "values": [1, "free"]}]},
                        "sweep.axes[0].values[0] = 1: segment.boundary = 1: must be 'free', 'clamped' or 'elastic'"),
    "no such element": ({"axes": [{"key": "mechanisms[0].parameters.coefficient", "values": [0.1]}]},
                        "sweep.axes[0]: 'mechanisms[0].parameters.coefficient': there is no element [0], the list is "
                        "empty or absent in this file; write it out first"),
    "through a number": ({"axes": [{"key": f"{T1}.deep", "values": [0.1]}]},
                         f"sweep.axes[0]: '{T1}.deep': the part before 'deep' is not a table in this file"),
    "not a list": ({"axes": [{"key": "segment[0]", "values": [0.1]}]},
                   "sweep.axes[0]: 'segment[0]': the part before [0] is not a list in this file"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD_SWEEPS)
def test_a_bad_space_is_one_sentence(name, tmp_path, capfd):
    sweep, sentence = BAD_SWEEPS[name]
    path = tmp_path / "space.toml"
    path.write_text(toml_text(TINY_CONFIG if sweep is None else {**TINY_CONFIG, "sweep": sweep}), "utf-8")
    assert main(["sweep", str(path), "-o", str(tmp_path / "out")]) == 2
    printed = capfd.readouterr()
    assert printed.err == f"softdot: {sentence}\n"
    assert printed.out == ""
    assert [entry.name for entry in tmp_path.iterdir()] == ["space.toml"]


def test_a_bad_configuration_around_good_axes_is_told_as_softdot_run_tells_it():
    tables = space_of(depths(0.05))
    tables["segment"]["film"]["thickness_mm"] = 0.1
    with pytest.raises(InputError, match=r"^segment\.film\.thickness_mm is not a key"):
        space_from(tables)


def test_a_combination_that_cannot_be_stays_as_a_point_with_its_reason():
    along = {"key": "materials.pvdf.youngs_modulus_MPa", "values": [400.0, 2000.0]}
    across = {"key": "materials.pvdf.youngs_modulus_2_MPa", "values": [1000.0, 8000.0]}
    points = space_from(space_of(along, across)).points
    assert [point.config is None for point in points] == [False, True, False, False]
    assert points[1].reason.startswith("materials.pvdf.youngs_modulus_2_MPa = 8000: must be below")
    assert points[1].values == {along["key"]: 400.0, across["key"]: 8000.0}


def test_axes_that_can_never_go_together_are_refused():
    with pytest.raises(InputError, match="give either indentation_mm or force_N, not both"):
        space_from(space_of({"key": "press.force_N", "values": [1.0, 2.0]}))


HELD = {"key": "segment.held_layers", "values": [["film"], ["medium1"]]}


def test_a_key_is_left_out_where_it_does_not_act_beside_another_axis():
    points = space_from(space_of({"key": "segment.boundary", "values": ["free", "clamped"]}, HELD)).points
    stated = ["held_layers" in point.config.model_dump()["segment"] for point in points]
    assert stated == [False, False, True, True]
    assert points[0].config == points[1].config
    tables = space_of({"key": "segment.boundary", "values": ["free", "elastic"]})
    tables["segment"] |= {"boundary": "elastic", "side_stiffness_N_per_mm3": 75.0}
    assert [point.config.segment.boundary for point in space_from(tables).points] == ["free", "elastic"]


def test_an_axis_that_acts_at_no_point_is_refused():
    axes = ({"key": "segment.boundary", "values": ["free"]}, HELD)
    with pytest.raises(
        InputError, match=r"sweep\.axes\[1\]: segment\.held_layers acts beside no value of another axis"
    ):
        space_from(space_of(*axes))


def test_the_example_is_a_space():
    space = load_space(ROOT / "examples" / "sweep.toml")
    assert [point.reason for point in space.points] == [None] * 32


def test_the_space_of_the_document_is_accepted():
    block = re.findall(r"```\n(\[sweep\].*?)```", (ROOT / "docs" / "sweep.md").read_text("utf-8"), re.DOTALL)[0]
    assert [point.reason for point in space_from({**TINY_CONFIG, **tomllib.loads(block)}).points] == [None] * 64


def test_a_grid_is_every_combination_last_axis_fastest():
    space = space_from(space_of({**RANGE, "n": 4}, depths(0.05, 0.1)))
    assert values(space) == [0.4, 0.4, 0.8, 0.8, 1.2, 1.2, 1.6, 1.6]
    assert values(space, "press.indentation_mm") == [0.05, 0.1] * 4


def test_a_logarithmic_grid_has_equal_ratios_and_exact_ends():
    space = space_from(space_of({"key": T1, "low": 0.1, "high": 1.6, "n": 5, "scale": "log"}))
    assert values(space) == [0.1, 0.2, 0.4, 0.8, 1.6]


def test_a_list_takes_first_with_first():
    axes = ({"key": T1, "values": [0.5, 0.8]}, depths(0.1, 0.05))
    assert [tuple(p.values.values()) for p in space_from(space_of(*axes, sampling="list")).points] == [
        (0.5, 0.1),
        (0.8, 0.05),
    ]


def test_tied_keys_have_one_value():
    space = space_from(space_of({"keys": [T1, T2], "values": [0.5, 0.8]}))
    assert [(p.config.segment.medium1.thickness_mm, p.config.segment.medium2.thickness_mm) for p in space.points] == [
        (0.5, 0.5),
        (0.8, 0.8),
    ]


def test_elements_of_lists_materials_texts_and_switches_can_vary():
    tables = space_of(
        {"key": "mechanisms[0].parameters.coefficient", "values": [0.2]},
        {"key": "dot.offset_mm[1]", "values": [0.1]},
        {"key": "materials.vnr.youngs_modulus_MPa", "values": [4.0]},
        {"key": "segment.boundary", "values": ["elastic"]},
        {"key": "segment.held_layers", "values": [["film"]]},
    )
    tables |= {"mechanisms": [{"name": "friction", "component": "dot"}], "dot": {"offset_mm": [0.0, 0.0]}}
    config = space_from(tables).points[0].config
    assert config.mechanisms[0].parameters == {"coefficient": 0.2}
    assert config.dot.offset_mm == (0.0, 0.1)
    assert config.materials["vnr"].youngs_modulus_MPa == 4.0
    assert config.materials["vnr"].poisson_ratio == 0.495  # what the file does not state stays the library's
    assert (config.segment.boundary, config.segment.held_layers) == ("elastic", ("film",))


LOG = {"key": T2, "low": 0.01, "high": 1.0, "scale": "log"}
TEXT = {"key": "segment.boundary", "values": ["free", "clamped"]}


@for_each("sampling", ["latin-hypercube", "sobol"])
def test_a_random_design_has_its_points_inside_the_bounds_and_repeats_by_seed(sampling):
    def design(seed):
        space = space_from(space_of(RANGE, LOG, TEXT, sampling=sampling, points=32, seed=seed))
        return [tuple(point.values.values()) for point in space.points]

    first = design(3)
    assert len(first) == len(set(first)) == 32
    assert all(0.4 <= one <= 1.6 and 0.01 <= two <= 1.0 for one, two, _ in first)
    assert first == design(3)
    assert first != design(4)
    assert [text for *_, text in first].count("free") == 16


def test_a_latin_hypercube_has_one_point_in_each_slice_of_each_axis():
    space = space_from(space_of(RANGE, LOG, sampling="latin-hypercube", points=20))
    one = [int(20 * (value - 0.4) / 1.2) for value in values(space)]
    two = [int(20 * math.log(value / 0.01) / math.log(100.0)) for value in values(space, T2)]
    assert sorted(one) == sorted(two) == list(range(20))


def test_sobol_points_fill_every_cell_of_a_grid_once():
    """16 points of a (0, 4, 2)-net: one in each of the 4 x 4 squares, which random points do with chance 1e-6."""
    space = space_from(space_of(RANGE, LOG, sampling="sobol", points=16))
    one = (np.array(values(space)) - 0.4) / 1.2
    two = np.log(np.array(values(space, T2)) / 0.01) / math.log(100.0)
    cells = {(int(4 * a), int(4 * b)) for a, b in zip(one, two, strict=True)}
    assert cells == set(itertools.product(range(4), range(4)))


@for_each(
    ("key", "way"),
    {
        "seed": ("seed",),
        "dot.offset_mm[1]": ("dot", "offset_mm", 1),
        "materials.vnr-soft.c10_MPa": ("materials", "vnr-soft", "c10_MPa"),
        'materials."my 1.0".c10_MPa': ("materials", "my 1.0", "c10_MPa"),
        "press.path_xy_mm[0][1]": ("press", "path_xy_mm", 0, 1),
    }.items(),
)
def test_dotted_keys(key, way):
    assert key_path(key) == way


@for_each("key", ["", ".", "a.", "a..b", "[0]", "a[x]", "a[-1]", 'a."b', "a b"])
def test_what_is_no_dotted_key(key):
    with pytest.raises(ValueError, match="must"):
        key_path(key)


def test_setting_a_value_leaves_the_tables_as_they_were():
    tables = {"a": {"b": [1, 2]}}
    assert with_value(tables, "a.b[1]", 3) == {"a": {"b": [1, 3]}}
    assert with_value(tables, "c.d", 4) == {"a": {"b": [1, 2]}, "c": {"d": 4}}
    assert tables == {"a": {"b": [1, 2]}}
