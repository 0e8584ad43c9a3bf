"""Hypothesis strategies: configurations that a user may write, on meshes so coarse that a press takes seconds."""

from hypothesis import strategies as st

from geometry.parameters import Segment
from solve.mechanisms import MECHANISMS
from solve.waveform import Waveform
from tests.softdot.random_mechanisms import mechanisms
from tests.softdot.random_numbers import between, log_between

FLAT, ROUND = ("layer", "block"), ("cylinder", "dome")
"""Shapes of the effector. Round ones need 3D and pytetwild: a press takes a minute, and with a moving mass many."""
LAYERS = ("effector", "medium1", "film", "medium2")
POISSON = between(0.2, 0.4995)


@st.composite
def valid_configurations(draw, shapes=FLAT):
    """Tables of a configuration with every size, constant and mechanism drawn at random."""
    section = draw(st.sampled_from(("solid",) if shapes == ROUND else ("plane-strain",) * 3 + ("solid",)))
    segment = draw(segments(section, shapes))
    layers = [name for name in LAYERS if name in segment]
    materials = {f"own-{name}": draw(films() if name == "film" else media()) for name in layers}
    for name in layers:
        segment[name]["material"] = f"own-{name}"
    dot = draw(dots(segment))
    softest_MPa = min(modulus_MPa(m) for name, m in materials.items() if name != "own-film")
    press = draw(presses(segment, softest_MPa))
    mesher = "pytetwild" if shapes == ROUND else "layered"
    left_out = {"inertia"} if shapes == ROUND else set()
    left_out |= {"guide-friction", "rig-compliance"} if "force_N" in press else set()
    foams = {name for name in layers if materials[f"own-{name}"].get("model") == "hyperfoam"}
    chosen = [one for one in draw(mechanisms(segment, dot, foams)) if one["name"] not in left_out]
    tables = {
        "segment": segment,
        "materials": materials,
        "dot": dot,
        "press": press,
        "mesh": {"element_size_mm": 1.6, "contact_element_size_mm": 0.8, "mesher": mesher},
        "mechanisms": chosen,
    }
    readout = draw(st.none() | readouts())
    if readout is not None:
        tables["readout"] = readout
        tables["mechanisms"] = felt_behind(readout, chosen)
    return tables


def felt_behind(readout, mechanisms):
    """Those that act behind an amplifier: nothing parallel to the input of a charge amplifier does."""
    charge = readout.get("mode") == "charge"
    return [one for one in mechanisms if not (charge and one["component"] in MECHANISMS[one["name"]].parallel_to_input)]


@st.composite
def segments(draw, section, shapes):
    table = {
        "section": section,
        "length_mm": draw(between(1.5, 4.0)),
        "width_mm": draw(between(1.5, 3.0)),
        "boundary": draw(st.sampled_from(("free", "clamped", "elastic"))),
        "side_stiffness_N_per_mm3": draw(log_between(0.01, 100.0)),
        "medium1": {"thickness_mm": draw(between(0.3, 1.0))},
        "film": {"thickness_um": draw(log_between(10.0, 200.0)), "draw_angle_deg": draw(between(-90.0, 90.0))},
        "medium2": {"thickness_mm": draw(between(0.5, 3.0))},
    }
    some = effectors(section, table, shapes)
    effector = draw(some if shapes == ROUND else st.none() | some)
    if effector is not None:
        table["effector"] = effector
    present = [name for name in LAYERS if name in table]
    table["held_layers"] = draw(st.lists(st.sampled_from(present), unique=True))
    if draw(st.booleans()):
        half = table["length_mm"] / 2
        size = [0.8 * half, draw(between(0.5, 1.0)) * table["width_mm"]]
        sides = ((-1, "left"), (1, "right"))
        table["film"]["electrodes"] = [{"name": n, "center_mm": [s * half / 2, 0.0], "size_mm": size} for s, n in sides]
    if draw(st.booleans()):
        bond = {"between": draw(st.sampled_from((["film", "medium2"], ["medium2", "base"], ["medium1", "film"])))}
        for key in ("normal_stiffness_N_per_mm3", "shear_stiffness_N_per_mm3"):
            bond[key] = draw(log_between(1.0, 1e6))
        table["bonds"] = [bond]
    return Segment.override_keys(table, {})


@st.composite
def effectors(draw, section, segment, shapes):
    shape = draw(st.sampled_from(shapes))
    table = {"shape": shape, "height_mm": draw(between(0.3, 1.5))}
    if shape == "block":
        table["length_mm"] = draw(between(0.4, 1.0)) * segment["length_mm"]
        if section == "solid":
            table["width_mm"] = draw(between(0.4, 1.0)) * segment["width_mm"]
    if shape in ROUND:
        table["diameter_mm"] = draw(between(0.5, 0.9)) * min(segment["length_mm"], segment["width_mm"])
    return table


@st.composite
def media(draw):
    """A soft medium of any law; the constants keep the energy positive."""
    model = draw(st.sampled_from(("neo-hookean", "linear", "mooney-rivlin", "yeoh", "knowles", "ogden", "hyperfoam")))
    shear_MPa = draw(log_between(0.05, 5.0))
    if model in ("neo-hookean", "linear"):
        table = {"youngs_modulus_MPa": 3.0 * shear_MPa}
    elif model == "mooney-rivlin":
        share = draw(between(0.0, 1.0))
        table = {"c10_MPa": share * shear_MPa / 2, "c01_MPa": (1 - share) * shear_MPa / 2}
    elif model == "yeoh":
        table = {"c10_MPa": shear_MPa / 2, "c20_MPa": draw(between(0.0, 0.2)) * shear_MPa}
    elif model == "knowles":
        table = {"c10_MPa": shear_MPa / 2, "b": draw(log_between(0.01, 2.0)), "n": draw(between(0.5, 8.0))}
    else:
        exponents = between(1.5, 6.0) if model == "ogden" else between(1.5, 12.0)
        alpha = draw(st.lists(exponents, min_size=1, max_size=3))
        share = shear_MPa / len(alpha)
        table = {"alpha": alpha, "mu_MPa": [2 * share / a if model == "ogden" else share for a in alpha]}
    ratio = [draw(between(0.0, 0.4)) for _ in table["alpha"]] if model == "hyperfoam" else draw(POISSON)
    return {"model": model, **table, "poisson_ratio": ratio}


def modulus_MPa(medium):
    """Rough Young's modulus of a random medium."""
    if "youngs_modulus_MPa" in medium:
        return medium["youngs_modulus_MPa"]
    if "c10_MPa" in medium:
        return 6.0 * (medium["c10_MPa"] + medium.get("c01_MPa", 0.0))
    foam = medium["model"] == "hyperfoam"
    return 3.0 * sum(m if foam else m * a / 2 for m, a in zip(medium["mu_MPa"], medium["alpha"], strict=True))


@st.composite
def films(draw):
    return {
        "model": "piezoelectric-film",
        "youngs_modulus_MPa": draw(log_between(100.0, 5000.0)),
        "poisson_ratio": draw(between(0.0, 0.45)),
        "d31_pC_per_N": draw(between(-30.0, 30.0)),
        "d32_pC_per_N": draw(between(-30.0, 30.0)),
        "d33_pC_per_N": draw(between(-40.0, 40.0)),
        "relative_permittivity": draw(between(2.0, 100.0)),
        "coupling": draw(st.sampled_from(("one-way", "two-way"))),
    }


@st.composite
def dots(draw, segment):
    sliced = segment["section"] == "plane-strain"
    shape = draw(st.sampled_from(("ridge", "ridge", "plate") if sliced else ("cap", "cap", "ridge", "plate")))
    table = {"shape": shape, "gap_mm": draw(st.just(0.0) | between(0.0, 0.1))}
    table["offset_mm"] = [draw(between(-0.3, 0.3)), 0.0 if sliced else draw(between(-0.3, 0.3))]
    tilt = st.just(0.0) | between(-3.0, 3.0)
    table["tilt_deg"] = [0.0 if sliced else draw(tilt), draw(tilt)]
    if shape == "cap" and draw(st.booleans()):
        table["standard"] = draw(st.sampled_from(("marburg-medium", "ada-2010")))
    elif shape != "plate":
        table["radius_mm"] = draw(between(0.4, 3.0))
    return table


@st.composite
def presses(draw, segment, softest_MPa):
    """A depth of up to a quarter of the soft height, or a force that is about as much; at times a slide."""
    effector = segment.get("effector")
    soft_mm = segment["medium1"]["thickness_mm"] + segment["medium2"]["thickness_mm"]
    soft_mm += effector["height_mm"] if effector else 0.0
    table = {"load_steps": draw(st.integers(1, 2))}
    strain = draw(log_between(0.005, 0.2))
    if draw(st.booleans()):
        table["indentation_mm"] = strain * soft_mm
    else:
        table["force_N"] = 0.3 * strain * softest_MPa * segment["length_mm"] * segment["width_mm"]
    slide = draw(st.integers(0, 5)) == 0
    if slide:
        table["path_xy_mm"] = [[draw(between(-0.2, 0.2)), 0.0]]
    shapes = ("ramp", "raised-cosine") if slide else ("ramp", "half-sine", "raised-cosine", "trapezoid")
    if draw(st.booleans()):
        table["waveform"] = {"shape": draw(st.sampled_from(shapes))}
        for key in ("rise_s", "hold_s", "fall_s"):
            table["waveform"][key] = draw(log_between(0.01, 1.0))
        table["waveform"] = Waveform.override_keys(table["waveform"], {})
    return table


@st.composite
def readouts(draw):
    table = {"polarity": draw(st.sampled_from((1, -1)))}
    if draw(st.booleans()):
        table["input_resistance_MOhm"] = draw(log_between(0.1, 1e4))
        table["input_capacitance_pF"] = draw(between(0.0, 500.0))
    else:
        table["mode"] = "charge"
        table["feedback_pF"] = draw(log_between(10.0, 1e4))
        table["feedback_MOhm"] = draw(log_between(1.0, 1e4))
    if draw(st.booleans()):
        table |= {"low_pass_Hz": draw(log_between(1.0, 1e4)), "filter_order": draw(st.integers(1, 4))}
    if draw(st.booleans()):
        table["limit_V"] = draw(log_between(0.01, 10.0))
    return table
