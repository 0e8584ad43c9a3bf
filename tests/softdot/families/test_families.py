"""Families: the process on functions that are known, and what a family answers, refuses and keeps."""

import copy
from pathlib import Path

import numpy as np
import pytest

from foundation.errors import InputError
from foundation.executor import HERE
from softdot.cli import main
from softdot.families import presses
from softdot.families.build import Asked, make_family
from softdot.families.family import Family, Region
from softdot.families.fit import JUDGED
from softdot.families.folder import ARRAYS, load_family, write_family
from softdot.families.gradient_process import GradientProcess, Scales
from softdot.families.presses import common_mesh
from softdot.families.quantity import FamilyQuantity
from softdot.families.report import write_page
from softdot.families.space import FamilySpace, load_family_space
from softdot.progress import Untold
from softdot.warm_up import TINY_CONFIG
from tests.cases import for_each

SCALES = Scales(np.array([2.0, 2.0, 2.0]), 1.0, 1e-9, 1e-9)
THICKNESS = {"key": "segment.medium1.thickness_mm", "low": 0.4, "high": 0.6}
DEPTH = {"key": "press.indentation_mm", "low": 0.08, "high": 0.12}
FACTS = {
    "asked_percent": dict.fromkeys(JUDGED, 1.0),
    "expected_error_percent": dict.fromkeys(JUDGED, 1.0),
    "discretisation_error_percent": None,
    "presses": {"solved": 9, "now": 9, "from_cache": 0},
    "reached": True,
    "held_out": [],
    "left_out": [],
    "warnings": [],
    "unknowns": 1,
}


def places_of(count, axes=3, seed=0):
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (count, axes))


def curved(places):
    """A function of three numbers, two outputs, and its slopes."""
    x, y, z = places.T
    one, two = np.exp(0.3 * x) * np.cos(0.5 * y + 0.2 * z), x * y + z**2
    slopes_one = [0.3 * one, *(-k * np.exp(0.3 * x) * np.sin(0.5 * y + 0.2 * z) for k in (0.5, 0.2))]
    return np.stack([one, two], 1), np.stack([np.stack(slopes_one, 1), np.stack([y, x, 2 * z], 1)], 2)


def test_a_process_reproduces_values_and_slopes_and_a_point_left_out_is_one_that_was_never_there():
    places = places_of(12)
    values, slopes = curved(places)
    process = GradientProcess(places, values, slopes, SCALES)
    again = process.predict(places)
    np.testing.assert_allclose(again.mean, values, atol=1e-5)
    np.testing.assert_allclose(again.slopes, slopes, atol=1e-4)
    assert again.deviation.max() < 1e-3
    unseen = places_of(50, seed=1)
    np.testing.assert_allclose(process.mean(unseen), curved(unseen)[0], atol=0.02)
    order = np.random.default_rng(2).permutation(12)
    turned = GradientProcess(places[order], values[order], slopes[order], SCALES)
    np.testing.assert_allclose(turned.mean(unseen), process.mean(unseen), atol=1e-6)
    without = GradientProcess(places[1:], values[1:], slopes[1:], SCALES)
    np.testing.assert_allclose(process.left_out().error[0], values[0] - without.mean(places[:1])[0], atol=1e-5)


def power_law(places, space):
    """Courses of a force and a voltage that are products of powers of thickness and depth, and their slopes."""
    thickness, depth = (one.values(column) for one, column in zip(space.ranges, places.T, strict=True))
    share = np.array([0.0, 0.5, 1.0])
    courses, slopes = {}, {}
    for name, size, powers in (("reaction_force_N", 8.0, (-0.5, 1.5)), ("open_circuit_voltage_V", -3.0, (-1.0, 2.0))):
        full = size * thickness ** powers[0] * depth ** powers[1]
        courses[name] = full[:, None] * share**1.5
        by_place = [
            power * one.slopes(column) / one.values(column)
            for power, one, column in zip(powers, space.ranges, places.T, strict=True)
        ]
        slopes[name] = np.stack([courses[name] * one[:, None] for one in by_place], axis=1)
    return courses, slopes


@pytest.fixture(scope="module")
def family():
    space = FamilySpace(space_of(THICKNESS, DEPTH))
    places = places_of(9, 2)
    courses, slopes = power_law(places, space)
    quantities = {name: FamilyQuantity(places, courses[name], slopes[name]) for name in courses}
    region = Region(np.vstack([places, [[0.6, 0.6]]]), np.array([[0.95, 0.95]]), ("it overlaps",))
    return Family(space, quantities, region, FACTS)


def space_of(*axes, **tables):
    return {**copy.deepcopy(TINY_CONFIG), **tables, "sweep": {"sampling": "sobol", "points": 8, "axes": list(axes)}}


def test_a_family_answers_one_design_and_many_with_slopes_by_its_keys(family):
    one = family.press(medium1_thickness_mm=0.5)
    depth = np.sqrt(0.08 * 0.12)  # the middle of what is positive: places are even in the logarithm
    force = 8.0 * 0.5**-0.5 * depth**1.5 * np.array([0.0, 0.5, 1.0]) ** 1.5
    np.testing.assert_allclose(one.reaction_force_N, force, rtol=1e-5)
    np.testing.assert_allclose(one.slopes[THICKNESS["key"]]["reaction_force_N"], -0.5 * force / 0.5, rtol=1e-3)
    low, high = one.interval["open_circuit_voltage_V"]
    assert (low <= one.open_circuit_voltage_V).all()
    assert (one.open_circuit_voltage_V <= high).all()
    many = family.press(medium1_thickness_mm=[[0.45, 0.5]], **{DEPTH["key"]: [[0.1], [0.11], [depth]]})
    assert many.reaction_force_N.shape == (3, 2, 3)
    np.testing.assert_allclose(many.reaction_force_N[2, 1], one.reaction_force_N, rtol=1e-9)


@for_each(
    ("asked", "told"),
    [
        ({"medium1_thickness_mm": 0.61}, "outside of this family, 0.4 to 0.6"),
        ({"medium2_thickness_mm": 2.0}, "varies medium1_thickness_mm, press_indentation_mm"),
        ({"medium1_thickness_mm": np.nan}, "finite"),
        ({"medium1_thickness_mm": "thick"}, "must be a number"),
        ({"medium1_thickness_mm": -0.5}, "outside"),
        ({"medium1_thickness_mm": 0.595, "press_indentation_mm": 0.119}, "it overlaps"),
    ],
)
def test_a_family_refuses_what_it_does_not_know(family, asked, told):
    with pytest.raises(InputError, match=told):
        family.press(**asked)


def test_a_family_answers_a_configuration_of_its_own_alone(family):
    centre = family.space.centre
    found = family.press_config(centre)
    np.testing.assert_allclose(found.reaction_force_N, family.press().reaction_force_N, rtol=1e-6)
    other = centre.model_copy(
        update={"segment": centre.segment.model_copy(update={"length_mm": 1.1 * centre.segment.length_mm})}
    )
    with pytest.raises(InputError, match=r"segment\.length_mm: differs"):
        family.press_config(other)


def test_a_family_is_kept_whole_or_refused(family, tmp_path):
    write_family(family, tmp_path)
    again = load_family(tmp_path).press(medium1_thickness_mm=0.45)
    np.testing.assert_array_equal(again.reaction_force_N, family.press(medium1_thickness_mm=0.45).reaction_force_N)
    whole = (tmp_path / ARRAYS).read_bytes()
    (tmp_path / ARRAYS).write_bytes(whole[:-1] + bytes([whole[-1] ^ 1]))
    with pytest.raises(InputError, match="damaged"):
        load_family(tmp_path)
    with pytest.raises(InputError, match=r"holds no 'family\.json'"):
        load_family(tmp_path / "nothing")


@for_each(
    ("axis", "told"),
    [
        ({"key": "segment.boundary", "values": ["clamped", "free"]}, "segment.boundary has values"),
        ({"key": "mesh.element_size_mm", "low": 0.3, "high": 0.4}, "mesh.element_size_mm is no number of a design"),
        ({"key": "segment.medium1.thickness_mm", "low": 0.5, "high": 0.4}, "must be below"),
        ({"key": "segment.medium1.thick_mm", "low": 0.4, "high": 0.5}, "thick_mm"),
    ],
)
def test_a_family_of_anything_but_numbers_of_a_design_is_refused(axis, told, tmp_path):
    with pytest.raises(InputError, match=told):
        FamilySpace(space_of(axis))
    assert main(["family", str(tmp_path / "none.toml"), "-o", str(tmp_path / "out")]) == 2
    assert not (tmp_path / "out").exists()


@for_each("file", sorted(Path("examples/families").glob("*.toml")))
def test_a_space_needs_no_points_of_a_sweep(file):
    space = load_family_space(file)
    grid = {"sampling": "grid", "axes": [{**axis, "n": 3} for axis in space.tables["sweep"]["axes"]]}
    asked = FamilySpace({**space.tables, "sweep": grid})
    np.testing.assert_array_equal(space.drawn_places(4, 0), asked.drawn_places(4, 0))


@pytest.mark.press
def test_a_family_of_presses_answers_a_press_that_it_has_not_seen(tmp_path, monkeypatch):
    kept = {}
    monkeypatch.setattr(presses, "recall", kept.get)
    monkeypatch.setattr(presses, "remember", kept.__setitem__)
    space = FamilySpace(space_of(THICKNESS, DEPTH))
    tet_mesh = common_mesh(space)
    asked = Asked(dict.fromkeys(JUDGED, 0.05), most=16)
    found = make_family(space, tet_mesh, asked, HERE, Untold())
    assert found.facts["reached"]
    assert max(row[name]["error_percent"] for row in found.facts["held_out"] for name in JUDGED) < 5.0
    again = make_family(space, tet_mesh, asked, HERE, Untold())
    assert again.facts["presses"]["now"] == 0
    write_page(tmp_path / "family.html", found, write_family(found, tmp_path))
    assert "Presses that took no part" in (tmp_path / "family.html").read_text("utf-8")
    np.testing.assert_array_equal(again.press().reaction_force_N, found.press().reaction_force_N)
