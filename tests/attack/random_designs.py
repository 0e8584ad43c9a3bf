"""Random designs that a lab might write, over every key of the configuration, on meshes so coarse that they are quick.

Design n carries mechanism n mod 24, a second one that goes round at another pace, and at times a third. Some solids are
arrays, which leave out mechanisms that change the segment, the dot or a bond.
"""

from typing import get_args

from pydantic import BaseModel

from geometry.fabrication.parameters import Fabrication
from geometry.parameters import Segment
from mesh.options import MeshOptions
from solve.mechanisms import MECHANISMS
from solve.waveform import Waveform
from tests.attack.drawing import Draw
from tests.attack.random_materials import film_material, medium_material, modulus_MPa
from tests.attack.random_mechanisms import mechanism
from tests.softdot.random_configurations import felt_behind

SEED = 20261123
LAYERS = ("effector", "medium1", "film", "medium2")
NAMES = tuple(MECHANISMS)
BY_DEPTH = {"guide-friction", "rig-compliance"}
"""Mechanisms that need a drive by depth."""
TOLD_ONLY = ("source", "confidence", "fabrication")
SOLID, ROUND = 9, 40
"""Every 9th design is a solid, every 40th has a round effector (pytetwild); the rest are plane-strain slices."""
ARRAY, FIRST_ARRAY = 45, 9
"""Every 45th design from the 9th, all of them solids, is an array of two segments."""
ONE_SEGMENTS = {
    "adhesive-compliance",
    "delamination",
    "dimension-reduction",
    "dot-offset",
    "elastic-sides",
    "crosstalk",
}
"""Mechanisms that an array does not take, and one between the halves of a segment."""
STANDARDS = ("marburg-medium", "ada", "nls", "japan", "en-15823")


def design(number: int) -> dict:
    """Tables of design `number`, the same each time."""
    draw = Draw(SEED, number)
    names = [NAMES[number % len(NAMES)], NAMES[(7 * number + number // len(NAMES) + 5) % len(NAMES)]]
    names += [draw.among(NAMES)] if draw.perhaps(0.4) else []
    several = number % ARRAY == FIRST_ARRAY
    if several:
        names = [name for name in names if name not in ONE_SEGMENTS]
    reducible = "dimension-reduction" in names
    round_one = number % ROUND == 1 and not reducible
    solid = round_one or reducible or (number % SOLID == 0 and "inertia" not in names)
    segment = _segment(draw, solid, round_one, reducible, "crosstalk" in names)
    if several:
        segment = _one_of_several(segment)
    layers = [name for name in LAYERS if name in segment]
    materials = {f"own-{name}": film_material(draw) if name == "film" else medium_material(draw) for name in layers}
    for name in layers:
        segment[name]["material"] = f"own-{name}"
    dot = _dot(draw, segment, reducible)
    if several:
        dot = {"standard": "marburg-medium", "gap_mm": dot["gap_mm"], "offset_mm": [0.05, 0.0]}
    softest = min(modulus_MPa(materials[f"own-{name}"]) for name in layers if name != "film")
    tables = {
        "seed": draw.whole(0, 9),
        "segment": segment,
        "materials": materials,
        "dot": dot,
        "press": _press(
            draw, segment, softest, dot["gap_mm"] + 0.1 * ("contact-gap" in names), not BY_DEPTH.isdisjoint(names)
        ),
        "mesh": _mesh(draw, solid, round_one),
        "mechanisms": _mechanisms(draw, names, segment, dot, materials),
        "fabrication": {},
    }
    if several:
        tables["array"] = _array(draw, segment)
        tables["press"].pop("path_xy_mm", None)
    if draw.perhaps(0.6):
        tables["readout"] = _readout(draw)
        tables["mechanisms"] = felt_behind(tables["readout"], tables["mechanisms"])
    if draw.perhaps(0.3):
        tables["mesh"]["symmetry"] = "none"
    if not solid and draw.perhaps(0.05):
        tables["mesh"]["accuracy_percent"] = 20.0
    return tables


def _mechanisms(draw, names, segment, dot, materials):
    made = [one for one in (mechanism(draw, name, segment, dot) for name in dict.fromkeys(names)) if one is not None]
    remade = [one for one in made if one["name"] in ("hyperelastic-stiffening", "foam-densification")]
    if len({one["component"] for one in remade}) < len(remade):  # both would give one layer its law
        made.remove(remade[-1])
    foams = {name.removeprefix("own-") for name, one in materials.items() if one.get("model") == "hyperfoam"}
    foams |= {one["component"] for one in made if one["name"] == "foam-densification"}
    for one in (one for one in made if one["component"] in foams):
        one["parameters"].pop("flowing_share", None)  # only rubber flows
    return made


def _segment(draw, solid, round_one, reducible, halves):
    table = {
        "length_mm": draw.between(1.5, 5.0),
        "width_mm": draw.between(1.5, 4.0),
        "section": "solid" if solid else "plane-strain",
        "boundary": draw.among(("free", "clamped", "clamped", "elastic")),
        "side_stiffness_N_per_mm3": draw.log(0.01, 100.0),
        "medium1": {"thickness_mm": draw.between(0.3, 1.5)},
        "film": {"thickness_um": draw.log(9.0, 110.0), "draw_angle_deg": draw.between(-90.0, 90.0)},
        "medium2": {"thickness_mm": draw.between(0.5, 3.0)},
    }
    if round_one or draw.perhaps(0.5):
        table["effector"] = _effector(draw, table, round_one, ("layer",) if reducible else ("layer", "block"))
    present = [name for name in LAYERS if name in table]
    if draw.perhaps(0.7):
        table["held_layers"] = draw.some(present)
    if halves or draw.perhaps(0.3):
        length, width = table["length_mm"], table["width_mm"]
        table["film"]["electrodes"] = [
            {"name": name, "center_mm": [side * length / 4, 0.0], "size_mm": [length / 2, width]}
            for side, name in ((-1, "left"), (1, "right"))
        ]
        if solid and not halves:
            table["film"]["electrodes"] = _outlines(draw, length, width)
    if draw.perhaps(0.3):
        table["bonds"] = [
            {
                "between": draw.among((["medium1", "film"], ["film", "medium2"], ["medium2", "base"])),
                "normal_stiffness_N_per_mm3": draw.log(10.0, 1e6),
                "shear_stiffness_N_per_mm3": draw.log(5.0, 1e6),
            }
        ]
    return Segment.override_keys(table, {})


def _one_of_several(table):
    """A segment as an array takes it, and not so long that two of them are dear."""
    table["film"].pop("electrodes", None)
    table.pop("bonds", None)
    for name in ("length_mm", "width_mm"):
        table[name] = min(table[name], 2.5)
        if name in table.get("effector", {}):
            table["effector"][name] = min(table["effector"][name], table[name])
    return table


def _array(draw, segment):
    """Two segments in a row, a column or two cells of one; at times in a grid, at times with a groove."""
    size = max(segment["length_mm"], segment["width_mm"])
    columns, rows, cells = draw.among(((2, 1, 1), (1, 2, 1), (1, 1, 2)))
    table = {
        "columns": columns,
        "rows": rows,
        "cells": cells,
        "pitch_mm": size + draw.between(0.1, 0.5),
        **({"cell_pitch_mm": size + 0.6} if cells > 1 else {}),
        "shared": ["film", "medium2"],
        "electrode_margin_mm": draw.between(0.0, 0.2),
    }
    if draw.perhaps(0.5) and segment["boundary"] != "elastic":
        table["grid_layers"] = ["medium1", "film"]
    thickness_mm = segment["medium2"]["thickness_mm"]
    table["grooves"] = [{"layer": "medium2", "width_mm": 0.2, "depth_mm": draw.between(0.2, 0.8) * thickness_mm}]
    return table


def _effector(draw, segment, round_one, shapes):
    shape = draw.among(("cylinder", "dome")) if round_one else draw.among(shapes)
    table = {"shape": shape, "height_mm": draw.between(0.3, 1.2)}
    if shape == "block":
        table["length_mm"] = draw.between(0.4, 0.9) * segment["length_mm"]
        if segment["section"] == "solid":
            table["width_mm"] = draw.between(0.4, 0.9) * segment["width_mm"]
    if round_one:
        table["diameter_mm"] = draw.between(0.6, 0.9) * min(segment["length_mm"], segment["width_mm"])
    return table


def _dot(draw, segment, reducible):
    sliced = segment["section"] == "plane-strain"
    shapes = ("cap",) if reducible else ("ridge", "ridge", "plate") if sliced else ("cap", "cap", "ridge", "plate")
    across = 0.0 if sliced or reducible else 1.0
    reach = 0.15 * segment["length_mm"] * draw.among((0.0, 1.0, 1.0))
    table = {
        "shape": draw.among(shapes),
        "offset_mm": [draw.between(-reach, reach), across * draw.between(-0.2, 0.2)],
        "gap_mm": draw.among((0.0, draw.between(0.01, 0.1))),
        "tilt_deg": [across * draw.between(-2.0, 2.0), draw.between(-3.0, 3.0)] if draw.perhaps(0.3) else [0.0, 0.0],
    }
    if table["shape"] == "plate":
        return table
    size = draw.whole(0, 2)
    if size == 0:
        table["radius_mm"] = draw.between(0.5, 3.0)
        table |= {"height_mm": draw.between(0.3, 1.0)} if draw.perhaps(0.3) else {}
    elif size == 1:
        table |= {"base_diameter_mm": draw.between(1.0, 2.0), "height_mm": draw.between(0.4, 0.6)}
    else:
        table["standard"] = draw.among(STANDARDS)
        if table["shape"] == "cap" and across and draw.perhaps(0.8):
            table |= {"cell": "⠿", "cell_dot": draw.whole(1, 6)}
            if draw.perhaps(0.5):
                table["cell_heights_mm"] = [draw.between(0.35, 0.55) for _ in range(6)]
    return table


def _press(draw, segment, softest_MPa, clear_mm, by_depth):
    """A depth of up to a fifth of the soft height, or a force that makes about that; at times a slide."""
    soft_mm = segment["medium1"]["thickness_mm"] + segment["medium2"]["thickness_mm"]
    strain = draw.log(0.02, 0.2)
    table = {"load_steps": draw.whole(1, 3)}
    if draw.perhaps(0.65) or by_depth:
        table["indentation_mm"] = clear_mm + strain * soft_mm
    else:
        table["force_N"] = 0.2 * strain * softest_MPa * segment["length_mm"] * segment["width_mm"]
    slide = draw.perhaps(0.15)
    if slide:
        table["path_xy_mm"] = [[draw.between(-0.2, 0.2), 0.0] for _ in range(draw.whole(1, 2))]
    shapes = ("ramp", "raised-cosine", "trapezoid") if slide else ("ramp", "half-sine", "raised-cosine", "trapezoid")
    if draw.perhaps(0.6):
        times = {key: draw.log(0.02, 1.0) for key in ("rise_s", "hold_s", "fall_s")}
        table["waveform"] = Waveform.override_keys({"shape": draw.among(shapes), **times}, {})
    return table


def _outlines(draw, length, width):
    """A circle on the left, a triangle on the right."""
    radius = draw.between(0.3, 0.9) * min(length / 4, width / 2)
    corners = [[0.1 * length, -0.4 * width], [0.45 * length, 0.0], [0.1 * length, 0.4 * width]]
    return [
        {"name": "left", "shape": "circle", "center_mm": [-length / 4, 0.0], "radius_mm": radius},
        {"name": "right", "shape": "polygon", "corners_mm": corners},
    ]


def _mesh(draw, solid, round_one):
    size = draw.between(0.9, 1.4) if solid else draw.between(0.6, 1.0)
    table = {"element_size_mm": size, "contact_element_size_mm": 0.5 * size, "timeout_s": 120.0}
    table["mesher"] = "pytetwild" if round_one else "layered"
    if draw.perhaps(0.3):
        table["film_element_size_mm"] = draw.between(0.6, 1.0) * size
    if draw.perhaps(0.2):
        table["film_layers"] = 2
    if round_one:
        table["coarsen"] = True
    return MeshOptions.override_keys(table, {})


def _readout(draw):
    table = {"polarity": draw.among((1, -1)), "noise_V": draw.log(1e-5, 1e-2)}
    if draw.perhaps(0.7):
        table |= {"input_resistance_MOhm": draw.log(0.1, 1e4), "input_capacitance_pF": draw.between(0.0, 500.0)}
    else:
        table |= {"mode": "charge", "feedback_pF": draw.log(10.0, 1e4), "feedback_MOhm": draw.log(1.0, 1e4)}
    if draw.perhaps(0.5):
        table |= {"low_pass_Hz": draw.log(10.0, 1e4), "high_pass_Hz": draw.log(0.01, 5.0)}
        table["filter_order"] = draw.whole(1, 4)
    if draw.perhaps(0.3):
        table["limit_V"] = draw.log(0.01, 10.0)
    if draw.perhaps(0.3):
        table["amplifier"] = _amplifier(draw)
        del table["noise_V"]
    return table


def _amplifier(draw):
    table = {
        "gain": draw.log(0.5, 100.0), "voltage_noise_nV_per_rtHz": draw.log(1.0, 100.0),
        "noise_corner_Hz": draw.log(1.0, 1e3), "bias_current_pA": draw.log(1e-3, 10.0),
        "current_noise_fA_per_rtHz": draw.log(0.1, 100.0), "input_capacitance_pF": draw.between(0.0, 10.0),
        "hum_mV": draw.between(0.0, 1.0), "hum_Hz": draw.among((50.0, 60.0)), "noise_from_Hz": draw.log(1e-3, 0.1),
        "temperature_C": draw.between(0.0, 40.0),
    }  # fmt: skip
    if draw.perhaps(0.5):
        table |= {"adc_bits": draw.whole(8, 24), "adc_range_V": draw.log(0.1, 100.0), "sample_rate_Hz": 1e4}
    table |= {"bandwidth_Hz": 1e4} if draw.perhaps(0.5) else {"gain_bandwidth_MHz": draw.log(0.1, 100.0)}
    return {"part": "LMP7721", **table} if draw.perhaps(0.3) else table


def keys_set(table) -> set[str]:
    """Keys that a design sets, as TABLE.KEY by the class of the table, so that lists and layers count as one."""
    found = set()
    for name in table.model_fields_set:
        found.add(f"{type(table).__name__}.{name}")
        value = getattr(table, name)
        for one in value.values() if isinstance(value, dict) else value if isinstance(value, tuple) else [value]:
            if isinstance(one, BaseModel):
                found |= keys_set(one)
    return found


def keys_of_schema(table: type[BaseModel]) -> set[str]:
    """All keys of a table and of the tables in it, named alike; how the parts are made is no part of a press."""
    found = set()
    for name, field in table.model_fields.items():
        if name not in TOLD_ONLY:
            found.add(f"{table.__name__}.{name}")
            for inner in _tables(field.annotation):
                found |= keys_of_schema(inner)
    return found


def _tables(annotation):
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield from () if annotation is Fabrication else (annotation,)
    for part in get_args(annotation):
        yield from _tables(part)
