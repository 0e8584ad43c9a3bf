"""Hypothesis strategies: a valid configuration with one thing wrong."""

from copy import deepcopy

from hypothesis import strategies as st

from tests.softdot.random_configurations import LAYERS, valid_configurations
from tests.softdot.random_numbers import between, log_between

NOT_POSITIVE = st.sampled_from((0.0, -1e-9, -1.0, -1e6, float("nan"), float("inf"), float("-inf")))
NOT_A_NUMBER = st.sampled_from(("1.0", "0.3 mm", "", True, [1.0], {"value": 1.0}, []))
PRESSED = "press.indentation_mm"


@st.composite
def invalid_configurations(draw):
    """Tables before and after one mistake, and its name."""
    mistake = draw(st.sampled_from(MISTAKES))
    tables = draw(valid_configurations())
    return deepcopy(tables), mistake.__name__, mistake(draw, tables)


def wrong_number(draw, tables):
    """A number out of its range or of the wrong type."""
    paths = [path for path in numbers(tables) if path[-1] in POSITIVE]
    place(tables, draw(st.sampled_from(paths)), draw(NOT_POSITIVE | NOT_A_NUMBER))
    return tables


def wrong_type(draw, tables):
    """Any number replaced by what is none."""
    place(tables, draw(st.sampled_from(list(numbers(tables)))), draw(NOT_A_NUMBER))
    return tables


def unknown_key(draw, tables):
    """A mistyped key in any table."""
    table = draw(st.sampled_from(list(inner_tables(tables))))
    table[draw(st.sampled_from(("colour", "thicknes_mm", "x", "Indentation_mm", "ü")))] = 1.0
    return tables


def missing_key(draw, tables):
    """A key that neither the schema nor the default design gives left out."""
    segment = tables["segment"]
    stiffness = {"normal_stiffness_N_per_mm3": 100.0, "shear_stiffness_N_per_mm3": 10.0}
    if draw(st.booleans()):
        segment["film"]["electrodes"] = [{"name": "one"}]
    else:
        bond = {"between": ["film", "medium2"], **stiffness}
        del bond[draw(st.sampled_from(sorted(bond)))]
        segment["bonds"] = [bond]
    return tables


def material_without_stiffness(draw, tables):
    """Constants whose small-strain moduli are not positive, or a Poisson's ratio outside of -1 to 0.5."""
    layer = draw(st.sampled_from([name for name in LAYERS if name in tables["segment"] and name != "film"]))
    ratio = draw(st.sampled_from((0.5, 0.7, -1.0, -3.0)))
    size = draw(log_between(0.1, 10.0))
    tables["materials"][f"own-{layer}"] = draw(
        st.sampled_from(
            (
                {"model": "neo-hookean", "youngs_modulus_MPa": size, "poisson_ratio": ratio},
                {"model": "linear", "youngs_modulus_MPa": -size},
                {"model": "mooney-rivlin", "c10_MPa": size, "c01_MPa": -2.0 * size},
                {"model": "yeoh", "c10_MPa": -size},
                {"model": "ogden", "mu_MPa": [size], "alpha": [-2.0]},
                {"model": "ogden", "mu_MPa": [size, size], "alpha": [2.0]},
                {"model": "hyperfoam", "mu_MPa": [-size], "alpha": [2.0], "poisson_ratio": [0.1]},
                {"model": "hyperfoam", "mu_MPa": [size], "alpha": [0.0], "poisson_ratio": [0.1]},
                {"model": "piezoelectric-film"},
            )
        )
    )
    return tables


def overlapping_electrodes(draw, tables):
    """Two electrodes one above the other, or one beyond the edge."""
    length, width = tables["segment"]["length_mm"], tables["segment"]["width_mm"]
    one = {"name": "one", "center_mm": [0.0, 0.0], "size_mm": [0.5 * length, 0.5 * width]}
    shift = draw(between(0.0, 0.49)) * length
    two = {**one, "name": "two", "center_mm": [shift / 2, 0.0]}
    outside = {**one, "name": "two", "center_mm": [0.3 * length + shift, 0.0]}
    same = {**one, "size_mm": [0.1 * length, 0.1 * width], "center_mm": [0.4 * length, 0.0]}
    tables["segment"]["film"]["electrodes"] = [one, draw(st.sampled_from((two, outside, same)))]
    return tables


def impossible_materials(size):
    """Mechanism, component and parameters that no material has."""
    return [
        ("viscoelasticity", "medium2", {"relative_moduli": [0.6, 0.4 + 0.01 * size], "relaxation_times_s": [0.1, 1.0]}),
        ("viscoelasticity", "medium2", {"relative_moduli": [0.2], "relaxation_times_s": [-size]}),
        ("viscoelasticity", "medium2", {"relative_moduli": [], "relaxation_times_s": [size]}),
        ("viscoelasticity", "medium2", {"relaxation_times_s": [size]}),
        ("viscoelasticity", "bond-medium1-film", {"relative_moduli": [0.2], "relaxation_times_s": [size]}),
        ("viscoelasticity", "film", {"relative_moduli": [0.2], "relaxation_times_s": [size], "flowing_share": 0.5}),
        ("hyperelastic-stiffening", "medium2", {"mu_MPa": [size], "alpha": [-2.0]}),
        ("hyperelastic-stiffening", "medium2", {"mu_MPa": [size], "alpha": [2.0, 3.0]}),
        ("hyperelastic-stiffening", "medium2", {"mu_MPa": [], "alpha": []}),
        ("hyperelastic-stiffening", "medium2", {"mu_MPa": [size], "alpha": [200.0]}),
        ("hyperelastic-stiffening", "medium2", {"c10_MPa": -size}),
        ("hyperelastic-stiffening", "medium2", {"c10_MPa": size, "c01_MPa": -3.0 * size}),
        ("hyperelastic-stiffening", "medium2", {"c01_MPa": size, "c20_MPa": size}),
        ("foam-densification", "medium1", {"mu_MPa": [-size], "alpha": [4.0], "poisson_ratio": [0.1]}),
        ("foam-densification", "medium1", {"mu_MPa": [size], "alpha": [0.0], "poisson_ratio": [0.1]}),
        ("foam-densification", "medium1", {"mu_MPa": [size], "alpha": [4.0], "poisson_ratio": [0.5]}),
        ("foam-densification", "medium1", {"mu_MPa": [size], "alpha": [4.0], "poisson_ratio": []}),
        ("stress-softening", "medium1", {"loss_ratio": 1.0 + size}),
        ("film-yield", "film", {"yield_stress_MPa": 0.0}),
        ("film-yield", "film", {"yield_stress_MPa": size, "hardening_modulus_MPa": -size}),
        ("film-prestretch", "film", {"strain_x": 0.2 + size}),
    ]


def impossible_rest(size, reach):
    """The same of the dot, the bonds, the rig, the read-out and the numbers themselves."""
    return [
        ("friction", "dot", {"coefficient": -size}),
        ("friction", "dot", {"coefficient": "0.5"}),
        ("friction", "dot", {"coefficient": True}),
        ("friction", "film", {"coefficient": size}),
        ("friktion", "dot", {"coefficient": size}),
        ("delamination", "bond-base", {"center_mm": [reach, 0.0], "diameter_mm": 0.3 * reach}),
        ("delamination", "bond-film-medium2", {"diameter_mm": 1.1 * reach}),
        ("delamination", "bond-film-medium2", {"diameter_mm": -size}),
        ("delamination", "bond-film-medium2", {"diameter_mm": [size]}),
        ("adhesive-compliance", "bond-film-medium2", {"normal_stiffness_N_per_mm3": size}),
        ("adhesive-compliance", "bond-film-medium2", {}),
        ("adhesive-compliance", "bond-film-medium2", {"thickness_um": 1e-6, "youngs_modulus_MPa": 1e3}),
        ("rig-compliance", "rig", {"compliance_mm_per_N": float("inf")}),
        ("inertia", "rig", {"moving_mass_g": -size}),
        ("guide-friction", "rig", {"friction_force_N": [-size], "presliding_mm": [0.01]}),
        ("guide-friction", "rig", {"friction_force_N": [size], "presliding_mm": [0.0]}),
        ("guide-friction", "rig", {"friction_force_N": [size], "presliding_mm": []}),
        ("viscous-guide", "rig", {"viscous_N_s_per_mm": -size}),
        ("hysteresis", "film", {"play_shares": [0.1], "play_pC": []}),
        ("hysteresis", "film", {"play_shares": [0.1], "play_pC": [0.0]}),
        ("crosstalk", "channel-9", {"coupling": 0.1}),
        ("crosstalk", "channel-99", {"coupling": 0.1}),
        ("crosstalk", "channel-1-channel-9", {"capacitance_pF": size}),
        ("crosstalk", "channel-2-channel-1", {"capacitance_pF": size}),
        ("crosstalk", "channel-1-channel-2", {"coupling": 0.1}),
        ("crosstalk", "channel-1", {"capacitance_pF": size}),
        ("charge-leakage", "channel-9", {"resistance_MOhm": size}),
        ("low-pass", "channel-9", {"cutoff_Hz": size}),
        ("low-pass", "readout", {"cutoff_Hz": size, "order": 2.5}),
        ("low-pass", "readout", {"cutoff_Hz": size, "order": 9}),
        ("low-pass", "readout", {"cutoff_Hz": size, "order": 3, "quality": 0.5}),
        ("property-error", "medium2", {"modulus_factor": 0.0}),
        ("property-error", "medium2", {"thickness_factor": float("nan")}),
        ("property-error", "film", {"d31_factor": -1.0}),
        ("dot-offset", "dot", {"offset_mm": [0.1]}),
        ("dot-offset", "dot", {"offset_mm": ["a", 0.0]}),
        ("contact-gap", "dot", {"gap_mm": -0.1}),
        ("contact-gap", "dot", {"gap": 0.1}),
    ]


def impossible_mechanism(draw, tables):
    """A mechanism with parameters that physics does not allow, at a component that it has not, or unknown."""
    segment = tables["segment"]
    size = draw(log_between(0.01, 10.0))
    options = impossible_materials(size) + impossible_rest(size, max(segment["length_mm"], segment["width_mm"]))
    if "effector" not in segment:
        options.append(("stress-softening", "effector", {"loss_ratio": 0.1}))
        options.append(("delamination", "bond-effector-medium1", {"diameter_mm": 0.5}))
    name, component, parameters = draw(st.sampled_from(options))
    wrong = {"name": name, "component": component, "parameters": parameters}
    without = [m for m in tables["mechanisms"] if m["name"] != "adhesive-compliance"]
    tables["mechanisms"] = [*without, wrong]
    tables["segment"].pop("bonds", None)
    if component == "channel-9":
        tables["segment"]["film"].pop("electrodes", None)
    return tables


def contradiction(draw, tables):
    """Two statements that cannot both hold."""
    segment, dot, press = tables["segment"], tables["dot"], tables["press"]
    stack = segment["medium1"]["thickness_mm"] + segment["medium2"]["thickness_mm"]
    size = draw(between(1.5, 5.0))
    options = [
        (press, {"indentation_mm": 0.1, "force_N": 0.1}),
        (tables, {"press": {"indentation_mm": 3.0 * size * stack}}),
        (tables, {"press": {"force_N": 0.1}, "dot": {**dot, "offset_mm": [size * segment["length_mm"], 0.0]}}),
        (press, {"path_xy_mm": [[0.1, 0.0]], "waveform": {"shape": "trapezoid"}}),
        (press, {"waveform": {"shape": "file"}}),
        (press, {"waveform": {"shape": "file", "file": "nowhere.csv"}}),
        (dot, {"shape": "ridge", "standard": "marburg-medium", "radius_mm": size}),
        (dot, {"shape": "plate", "radius_mm": size, "standard": None}),
        (dot, {"shape": "ridge", "standard": "no-such-standard", "radius_mm": None}),
        (dot, {"tilt_deg": [0.0, 89.0 + size]}),
        (segment, {"effector": {"shape": "block", "length_mm": size * segment["length_mm"], "width_mm": 0.5}}),
        (segment, {"effector": {"shape": "cylinder"}}),
        (segment, {"effector": {"shape": "layer", "diameter_mm": size}}),
        (segment, {"effector": {"shape": "dome", "diameter_mm": 0.5, "height_mm": size}}),
        (segment, {"held_layers": ["film", "film"]}),
        (segment, {"bonds": [bond("film", "base")]}),
        (segment, {"bonds": [bond("film", "medium2"), bond("medium2", "film")]}),
        (segment, {"section": "plane-strain"} if segment["section"] == "solid" else {"section": "sliced"}),
        (segment["medium1"], {"material": "own-film"}),
        (segment["film"], {"material": "own-medium1"}),
        (segment["medium2"], {"material": "no-such-material"}),
        (tables, {"readout": {"mode": "charge"}}),
        (tables, {"mesh": {"element_size_mm": 1e-6, "contact_element_size_mm": 1e-6, "mesher": "layered"}}),
    ]
    if segment["section"] == "plane-strain":
        options += [(dot, {"shape": "cap"}), (dot, {"offset_mm": [0.0, 0.1]}), (dot, {"tilt_deg": [1.0, 0.0]})]
        options = [one for one in options if "mesh" not in one[1]]
    elif dot["shape"] != "cap":
        options = [one for one in options if one[1] != {"section": "plane-strain"}]
    table, changes = draw(st.sampled_from(options))
    table.update(changes)
    for key in [key for key, value in table.items() if value is None]:
        del table[key]
    return tables


def bond(one, other):
    """A compliant bond."""
    return {"between": [one, other], "normal_stiffness_N_per_mm3": 1.0, "shear_stiffness_N_per_mm3": 1.0}


MISTAKES = (
    wrong_number,
    wrong_type,
    unknown_key,
    missing_key,
    material_without_stiffness,
    overlapping_electrodes,
    impossible_mechanism,
    impossible_mechanism,
    impossible_mechanism,
    contradiction,
    contradiction,
)
POSITIVE = {
    "length_mm", "width_mm", "thickness_mm", "thickness_um", "height_mm", "diameter_mm", "youngs_modulus_MPa",
    "relative_permittivity", "radius_mm", "indentation_mm", "force_N", "rise_s", "fall_s", "element_size_mm",
    "contact_element_size_mm", "normal_stiffness_N_per_mm3", "shear_stiffness_N_per_mm3", "load_steps",
    "resistance_MOhm", "cutoff_Hz", "limit_V", "feedback_pF", "low_pass_Hz", "input_resistance_MOhm",
}  # fmt: skip


def numbers(tables, path=()):
    """Paths of all numbers."""
    items = tables.items() if isinstance(tables, dict) else enumerate(tables)
    for key, value in items:
        if isinstance(value, dict | list):
            yield from numbers(value, (*path, key))
        elif isinstance(value, int | float):
            yield (*path, key)


def inner_tables(tables):
    """Every table but the lists' and those that take any name."""
    for key, value in tables.items():
        if isinstance(value, dict) and key != "parameters":
            if key != "materials":
                yield value
            yield from inner_tables(value)


def place(tables, path, value):
    """Put a value at a path."""
    for key in path[:-1]:
        tables = tables[key]
    tables[path[-1]] = value
