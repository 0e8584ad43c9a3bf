"""The schema and the keys that other programs rely on."""

import tomllib

from softdot.commands.new import config_schema
from softdot.config.hashes import config_hash
from softdot.config.loading import config_from, load_config
from tests.cases import for_each

EVERY_KEY = """
[segment]
length_mm = 2.5
width_mm = 2.5
section = "solid"
boundary = "elastic"
held_layers = ["effector", "medium1", "film"]
side_stiffness_N_per_mm3 = 5.0
[segment.effector]
shape = "layer"
height_mm = 1.0
material = "rubber"
[segment.medium1]
thickness_mm = 0.5
material = "vnr"
[segment.film]
thickness_um = 28.0
material = "pvdf"
draw_angle_deg = 0.0
[[segment.film.electrodes]]
name = "left"
center_mm = [0.0, 0.0]
size_mm = [1.0, 2.0]
[[segment.bonds]]
between = ["film", "medium2"]
normal_stiffness_N_per_mm3 = 10.0
shear_stiffness_N_per_mm3 = 10.0
[segment.medium2]
thickness_mm = 2.0
material = "vnr-soft"
[materials.vnr-soft]
model = "neo-hookean"
youngs_modulus_MPa = 1.0
poisson_ratio = 0.495
density_kg_m3 = 950.0
[materials.my-film]
model = "piezoelectric-film"
youngs_modulus_MPa = 2000.0
youngs_modulus_2_MPa = 2100.0
poisson_ratio = 0.29
d31_pC_per_N = 23.0
d32_pC_per_N = 2.3
d33_pC_per_N = -33.0
relative_permittivity = 12.0
yield_stress_MPa = 50.0
density_kg_m3 = 1780.0
[dot]
shape = "cap"
standard = "marburg-medium"
offset_mm = [0.0, 0.0]
tilt_deg = [0.0, 0.0]
cell = "⠿"
cell_dot = 1
base_diameter_mm = 1.5
height_mm = 0.5
radius_mm = 0.8125
[press]
indentation_mm = 0.3
load_steps = 6
path_xy_mm = [[0, 0], [0.5, 0]]
[press.waveform]
shape = "trapezoid"
rise_s = 0.1
hold_s = 0.2
fall_s = 0.1
[readout]
input_resistance_MOhm = 1.0
input_capacitance_pF = 100.0
low_pass_Hz = 60.0
mode = "voltage"
high_pass_Hz = 0.1
filter_order = 1
limit_V = 10.0
polarity = -1
[mesh]
element_size_mm = 0.3
contact_element_size_mm = 0.1
mesher = "pytetwild"
[[mechanisms]]
name = "viscoelasticity"
component = "medium2"
parameters = { relative_moduli = [0.2], relaxation_times_s = [0.5] }
"""


def test_every_fixed_key_is_read():
    tables = tomllib.loads(EVERY_KEY)
    dumped = config_from(tables).model_dump(mode="json")
    assert _covers(dumped, tables) == []
    charge = {"mode": "charge", "feedback_pF": 100.0, "feedback_MOhm": 1000.0}
    assert _covers(config_from({**tables, "readout": charge}).readout.model_dump(), charge) == []


def _covers(dumped, tables, path=""):
    """Paths in tables whose value is not the same in dumped."""
    if isinstance(tables, dict):
        return [bad for key, value in tables.items() for bad in _covers(dumped[key], value, f"{path}.{key}")]
    if isinstance(tables, list):
        return [bad for d, t in zip(dumped, tables, strict=True) for bad in _covers(d, t, f"{path}[]")]
    return [] if dumped == tables else [path]


def test_schema_describes_every_key():
    schema = config_schema()
    tables = {"Config": schema, **schema["$defs"]}
    silent = [
        f"{name}.{key}"
        for name, table in tables.items()
        for key, value in table.get("properties", {}).items()
        if not (value.get("description") or "$ref" in value)
    ]
    assert silent == []


def test_only_what_has_no_sensible_value_is_required():
    schema = config_schema()
    required = {name: set(table.get("required", ())) for name, table in schema["$defs"].items()}
    assert set(schema["required"]) == {"segment"}
    assert required["Segment"] == {"medium1", "film", "medium2"}
    assert required["Medium"] == {"thickness_mm"}
    assert required["Film"] == {"thickness_um"}
    for name in ("Effector", "Dot", "Press", "Readout", "MeshOptions", "Waveform", "PiezoelectricFilm"):
        assert required[name] == set()


def test_thicknesses_alone_make_a_segment():
    config = config_from(
        {
            "segment": {
                "medium1": {"thickness_mm": 1},
                "film": {"thickness_um": 28},
                "medium2": {"thickness_mm": 2},
            }
        }
    )
    assert config.segment.effector is None
    assert config.press.indentation_mm == 0.3


def test_default_is_the_final_design_clamped():
    config = load_config()
    segment = config.segment
    assert (segment.boundary, segment.section, segment.length_mm) == ("clamped", "solid", 2.5)
    assert segment.held_layers == ("effector", "medium1", "film")
    assert (segment.effector.height_mm, segment.medium1.thickness_mm, segment.medium2.thickness_mm) == (
        1.0,
        0.5,
        2.0,
    )
    moduli = {name: material.youngs_modulus_MPa for name, material in config.layer_materials().items()}
    assert moduli == {"effector": 1.0, "medium1": 5.0, "film": 2000.0, "medium2": 1.0}
    assert (config.press.indentation_mm, config.press.load_steps) == (0.3, 6)
    assert (config.dot.shape, config.dot.standard) == ("cap", "marburg-medium")
    assert config.readout is None


def test_a_built_in_material_can_be_overridden_in_part():
    tables = tomllib.loads(EVERY_KEY.replace("[materials.my-film]\nmodel", "[materials.pvdf]\nmodel", 1))
    tables["materials"] = {"pvdf": {"d31_pC_per_N": 20.0}, "vnr": {"model": "yeoh", "c10_MPa": 0.8}}
    config = config_from(tables)
    film = config.layer_materials()["film"]
    assert (film.d31_pC_per_N, film.d33_pC_per_N, film.relative_permittivity) == (20.0, -33.0, 12.0)
    assert film.source is None  # it is no longer the built-in one
    assert config.layer_materials()["medium1"].model == "yeoh"


def test_hash_is_of_the_meaning_not_of_the_text():
    short = {
        "segment": {
            "medium1": {"thickness_mm": 1},
            "film": {"thickness_um": 28},
            "medium2": {"thickness_mm": 2},
        }
    }
    spelt = {**short, "press": {"indentation_mm": 0.3}, "seed": 0}
    other = {**short, "press": {"indentation_mm": 0.31}}
    hashes = [config_hash(config_from(tables)) for tables in (short, spelt, other)]
    assert hashes[0] == hashes[1] != hashes[2]
    assert len(hashes[0]) == 64


@for_each("change", ["poisson_ratio = 0.495", "d32_pC_per_N = 2.3"])
def test_hash_follows_the_materials(change):
    more = change.replace("0.495", "0.4").replace("2.3", "2.4")
    name = "pvdf" if "d32" in change else "vnr"
    key, value = more.split(" = ")
    tables = tomllib.loads(EVERY_KEY)
    assert config_hash(config_from(tables)) != config_hash(
        config_from({**tables, "materials": {**tables["materials"], name: {key: float(value)}}})
    )
