"""The candidates of a rig: every mechanism and component that it admits, with parameters that a rig file takes."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.optimize import least_squares

from diagnose.signals.time_scales import TimeScales
from diagnose.vocabulary.base import candidates_of_segment as candidates
from diagnose.vocabulary.layers.property_error import nuisance
from diagnose.vocabulary.layers.viscoelasticity import relaxed_fraction
from diagnose.vocabulary.scene import Scene
from docs.make_candidates import ASPECTS, looked_for
from solve.mechanisms import MECHANISMS, with_mechanisms
from solve.mechanisms.base import BONDS, CHANNELS, MEDIA, channels_of
from solve.model import Readout
from solve.readout.stages import Saturation
from tests.cases import for_each
from tests.diagnose.segment.rigs import LEAKY, model

ELECTRODES = [{"name": name, "center_mm": [x, 0.0], "size_mm": [1.0, 2.5]} for name, x in (("a", -0.6), ("b", 0.6))]


def scene(readouts=(LEAKY, LEAKY), channels=1, **tables) -> Scene:
    return Scene(model(**tables), readouts, 0.3, 2.0, 0.5, TimeScales(0.2, 1e-3, 10.0), channels)


def segment(**changes):
    base = {"section": "plane-strain", "effector": {}, "medium1": {"thickness_mm": 0.5},
            "film": {"thickness_um": 28.0}, "medium2": {"thickness_mm": 2.0}}  # fmt: skip
    return {key: value for key, value in {**base, **changes}.items() if value is not None}


def names(of: Scene) -> set:
    return {c.name for c in candidates(of)}


def every(scene_of_all: Scene):
    return [pytest.param(c, id="-".join(c.name)) for c in candidates(scene_of_all)]


GLUED = [{"between": ["film", "medium2"], "normal_stiffness_N_per_mm3": 100.0, "shear_stiffness_N_per_mm3": 20.0}]
FULL = scene(channels=2, segment=segment(bonds=GLUED, film={"thickness_um": 28.0, "electrodes": ELECTRODES}))


def test_a_rig_with_everything_admits_the_whole_vocabulary():
    wanted = {(name, component) for name, kind in MECHANISMS.items() for component in kind.components}
    absent = {("viscoelasticity", bond) for bond in BONDS if bond != "bond-film-medium2"}  # perfect: no jump to relax
    absent |= {(name, one) for name, one in wanted if max(channels_of(one), default=0) > 2}
    identical = {name for c in candidates(FULL) for name in c.identical_to}
    assert names(FULL) | identical == wanted - absent
    assert identical == {("charge-leakage", "film")}
    assert ("crosstalk", "channel-1-channel-2") in names(FULL)


@for_each("candidate", every(FULL))
def test_each_coordinate_alone_is_a_mechanism(candidate):
    """A fit may end where all others are 0."""
    for number, coordinate in enumerate(candidate.coordinates):
        for value in coordinate.starts:
            at = np.zeros(len(candidate.coordinates))
            at[number] = value
            assert candidate.as_mechanism(tuple(at)).component == candidate.component


def test_without_an_effector_nothing_is_looked_for_in_it():
    assert not any("effector" in component for _, component in names(scene(segment=segment(effector=None))))


def test_a_leak_at_the_amplifier_and_one_through_the_film_are_one_element():
    """They make the same model; the same resistance at one input of two does not."""
    of = {c.name: c for c in candidates(FULL)}
    leak = of["charge-leakage", "readout"]
    assert leak.identical_to == (("charge-leakage", "film"),)
    assert of["charge-leakage", "channel-1"].identical_to == ()


def test_what_every_rig_has_a_little_of_is_no_finding():
    """A surface that gives way by 2 um, and 0.3 % of the force as friction, of which 1 % would be one."""
    of = {c.name: c for c in candidates(scene())}
    gap, guide = of.pop(("contact-gap", "dot")), of.pop(("guide-friction", "rig"))
    assert gap.is_ordinary((0.0015,))
    assert not gap.is_ordinary((0.003,))
    assert guide.is_ordinary((0.001, 0.0, 0.0, 0.0015, 0.0, 0.0))
    assert not guide.is_ordinary((0.005, 0.0, 0.0, 0.005, 0.0, 0.0))
    assert not any(c.is_ordinary([1e-6] * len(c.coordinates)) for c in of.values())


@for_each(("boundary", "softest"), [("clamped", 0.5), ("elastic", 0.1), ("free", 0.0)])
def test_any_sides_may_have_another_stiffness(boundary, softest):
    """From free ones on, which lean on nothing, up to those that a film of PVDF takes for a wall."""
    sides = next(c for c in candidates(scene(segment=segment(boundary=boundary))) if c.mechanism == "elastic-sides")
    (coordinate,) = sides.coordinates
    ends = sorted(sides.parameters((x,))["stiffness_N_per_mm3"] for x in (coordinate.low, coordinate.high))
    assert ends[0] == pytest.approx(softest, abs=1e-6)
    assert ends[1] > 100.0


COMBINED = [
    dict(zip(ASPECTS, values, strict=True))
    for values in product(*ASPECTS.values())
    if not {"plane-strain", "plate"} <= set(values) or "clamped" in values
]


def test_a_rig_has_the_candidates_that_all_its_aspects_have():
    """So that a table of single aspects tells all: of sides, section, dot, drive, read-out and electrodes."""
    alone = {(aspect, value): looked_for({aspect: value}) for aspect, values in ASPECTS.items() for value in values}
    two = alone["electrodes", "2"] - alone["electrodes", "1"]
    for aspects in COMBINED:
        brought = two if aspects["electrodes"] == "2" and aspects["readout"] != "none" else set()
        if aspects["readout"] == "charge":  # at virtual grounds nothing leaks, and no two inputs are tied
            brought = {one for one in brought if one[0] != "charge-leakage" and one[1] in CHANNELS}
        plain = [alone[one] for one in aspects.items() if one[0] != "electrodes"]
        assert looked_for(aspects) == set.intersection(*plain) | brought, aspects


@for_each("section", ["solid", "plane-strain"])
def test_a_dot_is_sought_as_far_aside_as_its_contact_stays_over_the_segment(section):
    """Clear of a held rim at any depth, at free sides farther.

    To one side where the rig is its own mirror image, to both where an electrode, a place or a patch is not.
    """

    def aside(of):
        return next(c for c in candidates(of) if c.mechanism == "dot-offset")

    dot = {"shape": "cap" if section == "solid" else "ridge", "radius_mm": 0.9}
    held = scene(segment=segment(section=section, boundary="clamped"), dot=dot)
    assert all(0.5 < c.high < 1.25 - np.sqrt(0.3 * (1.8 - 0.3)) for c in aside(held).coordinates)
    both = scene(segment=segment(section=section, boundary="free"), dot=dot)
    for coordinate in aside(both).coordinates:
        assert (coordinate.low, coordinate.high) == (0.0, pytest.approx(1.25 - 0.5 * np.sqrt(0.9 * 0.3)))
        assert coordinate.high > 0.9  # of a segment of 2.5 mm
    assert aside(both).either_sign == ("offset_mm",)
    placed = replace(both, places=((0.0, 0.0), (0.3, 0.0)))
    x = aside(placed).coordinates[0]
    assert x.low == pytest.approx(-aside(both).coordinates[0].high)
    assert x.high == pytest.approx(aside(both).coordinates[0].high - 0.3)
    drawn = {"thickness_um": 28.0, "draw_angle_deg": 30.0}
    turned = scene(segment=segment(section=section, film=drawn, boundary="free"), dot=dot)
    assert aside(placed).either_sign == aside(turned).either_sign == ()


def test_a_declared_law_of_knowles_may_stiffen_sooner_or_later():
    gel = {"model": "knowles", "c10_MPa": 0.05, "b": 3.0, "n": 4.0}
    of = scene(materials={"vnr": {"model": "neo-hookean", "youngs_modulus_MPa": 5.0}, "gel": gel},
               segment=segment(medium1={"thickness_mm": 0.5, "material": "gel"}))  # fmt: skip
    found = {c.name: c for c in candidates(of)}["hyperelastic-stiffening", "medium1"]
    assert found.parameters((0.0,)) == {"c10_MPa": 0.05, "b": 3.0, "n": 4.0}
    assert found.parameters((np.log(2.0),))["b"] == pytest.approx(6.0)
    for end in (found.coordinates[0].low, found.coordinates[0].high):
        with_mechanisms(of.model, [found.as_mechanism((end,))])


def test_a_charge_amplifier_has_no_leaking_input():
    charge = Readout(mode="charge", feedback_pF=100.0)
    found = {mechanism for mechanism, _ in names(scene(readouts=(charge,)))}
    assert not found & {"charge-leakage", "parasitic-capacitance"}


def test_inputs_at_virtual_ground_tie_no_two_channels():
    charge = Readout(mode="charge", feedback_pF=100.0)
    found = {component for mechanism, component in names(scene((charge,), channels=3)) if mechanism == "crosstalk"}
    assert found == {"channel-1", "channel-2", "channel-3"}


def test_every_pair_of_three_channels_is_a_candidate_once():
    found = {component for mechanism, component in names(scene(channels=3)) if mechanism == "crosstalk"}
    pairs = {"channel-1-channel-2", "channel-1-channel-3", "channel-2-channel-3"}
    assert found - {"channel-1", "channel-2", "channel-3"} == pairs


def test_one_channel_hears_no_other():
    assert not any(mechanism == "crosstalk" for mechanism, _ in names(scene()))


@for_each("candidate", every(FULL))
def test_coordinates_lie_within_their_bounds_and_switch_the_mechanism_on(candidate):
    for coordinate in candidate.coordinates:
        assert coordinate.low <= 0.0 <= coordinate.high
        assert coordinate.starts
        for value in (*coordinate.starts, *coordinate.nodes):
            assert coordinate.low - 1e-9 <= value <= coordinate.high + 1e-9
            assert value != 0.0
    middle = tuple(coordinate.starts[0] for coordinate in candidate.coordinates)
    mechanism = candidate.as_mechanism(middle)
    assert set(candidate.derived(middle)) | set(mechanism.parameters) <= set(candidate.units)
    with_mechanisms(FULL.model, [mechanism])


def test_small_coordinates_are_small_physics():
    """Near 0 the model goes over into the declared one."""
    almost = {c.name: c.parameters(tuple(1e-6 for _ in c.coordinates)) for c in candidates(FULL)}
    assert almost["charge-leakage", "readout"]["resistance_MOhm"] > 1e6
    assert almost["film-yield", "film"]["yield_stress_MPa"] > 1e6
    assert almost["low-pass", "readout"]["cutoff_Hz"] > 1e6
    assert almost["elastic-sides", "sides"]["stiffness_N_per_mm3"] > 1e6
    assert almost["adhesive-compliance", "bond-base"]["normal_stiffness_N_per_mm3"] == pytest.approx(1e6)
    assert almost["adhesive-compliance", "bond-film-medium2"]["shear_stiffness_N_per_mm3"] == pytest.approx(20.0)
    assert sum(almost["viscoelasticity", "medium1"]["relative_moduli"]) < 1e-5
    foam = almost["foam-densification", "effector"]
    assert foam["poisson_ratio"][0] == pytest.approx(0.495, abs=1e-5)
    assert foam["alpha"][0] == pytest.approx(2.0, abs=1e-5)


@for_each(
    ("limited", "largest_error"),
    [
        pytest.param(lambda V: np.clip(V, -0.7, 0.7), 1e-3, id="no knee"),
        pytest.param(lambda V: 0.7 * np.tanh(V / 0.7), 0.01, id="hyperbolic tangent"),
    ],
)
def test_a_fit_finds_a_limit_from_every_start_of_it(limited, largest_error):
    """From where nothing is cut off yet as from far beyond: nowhere is the voltage deaf to the coordinates."""
    candidate = next(c for c in candidates(FULL) if c.mechanism == "saturation")
    voltage = np.linspace(-0.2, 1.0, 400)

    def left(values):
        return Saturation(**candidate.parameters(values)).apply(voltage, voltage) - limited(voltage)

    bounds = np.array([(c.low, c.high) for c in candidate.coordinates]).T
    for start in (0.1, *candidate.coordinates[0].starts):
        found = least_squares(left, (start, 0.0), bounds=bounds, diff_step=1e-3)
        assert np.abs(found.fun).max() < largest_error


def test_what_is_off_has_finite_parameters():
    """An interval may reach down to it."""
    for candidate in candidates(FULL):
        for value in candidate.parameters((0.0,) * len(candidate.coordinates)).values():
            assert np.isfinite(np.asarray(value, dtype=float)).all(), candidate.name


def test_what_is_declared_stays():
    """A declared memory keeps its branches, and the new ones share what it leaves."""
    declared = {"name": "viscoelasticity", "component": "medium2",
                "parameters": {"relative_moduli": [0.2], "relaxation_times_s": [0.5]}}  # fmt: skip
    found = next(c for c in candidates(scene(mechanisms=[declared])) if c.name == ("viscoelasticity", "medium2"))
    moduli = found.parameters((0.5, 0.0, 0.0, 0.0, 0.0))["relative_moduli"]
    assert moduli == pytest.approx([0.2, 0.8 / 3.0, 0.0, 0.0, 0.0])


def test_relaxed_fraction_of_one_branch():
    """1 - G(10) / G(0.1), G = 1 - g (1 - exp(-t / tau))."""
    assert relaxed_fraction([0.4], [1e-3]) == pytest.approx(0.0)
    assert relaxed_fraction([0.4], [1.0]) == pytest.approx(1.0 - 0.6000182 / 0.9619350, rel=1e-5)
    assert relaxed_fraction([0.4], [1e6]) == pytest.approx(0.0, abs=1e-5)


@for_each("medium", MEDIA)
def test_nuisances_are_the_factors_of_the_rig(medium):
    found = nuisance(FULL, f"modulus.{medium}")
    assert found is not None
    assert found.parameters((0.1,))["modulus_factor"] == pytest.approx(1.105, abs=1e-3)
    assert len(found.coordinates) == 1
    assert nuisance(FULL, "gain") is None
    assert nuisance(replace(FULL, model=model(segment=segment(effector=None))), "modulus.effector") is None
