"""Hypothesis strategies: up to three mechanisms that a given segment can have, with random parameters."""

from hypothesis import strategies as st

from tests.softdot.random_numbers import between, log_between

MAXWELL = st.lists(st.tuples(between(0.0, 0.3), log_between(0.01, 10.0)), min_size=1, max_size=3)
PRONY = MAXWELL.map(
    lambda terms: {"relative_moduli": [g for g, _ in terms], "relaxation_times_s": [t for _, t in terms]}
)
FLOWING = st.tuples(PRONY, between(0.0, 1.0)).map(lambda drawn: {**drawn[0], "flowing_share": drawn[1]})
STIFF = log_between(1.0, 1e6)
FACTOR = between(0.7, 1.4)

ANYWHERE = {
    ("charge-leakage", "readout"): {"resistance_MOhm": log_between(0.1, 1e4)},
    ("parasitic-capacitance", "readout"): {"capacitance_pF": between(0.0, 500.0)},
    ("low-pass", "readout"): {"cutoff_Hz": log_between(1.0, 1e4), "order": st.integers(1, 4)},
    ("saturation", "readout"): {"limit_V": log_between(0.01, 10.0), "sharpness": log_between(1.0, 100.0)},
    ("mains-hum", "readout"): {"frequency_Hz": between(40.0, 70.0), "amplitude_V": between(0.0, 1.0)},
    ("pyroelectric-drift", "film"): {
        "temperature_step_K": between(-1.0, 1.0),
        "time_constant_s": log_between(0.1, 10.0),
    },
    ("contact-electrification", "film"): {"charge_pC": between(-50.0, 50.0), "area_exponent": between(0.3, 3.0)},
    ("film-yield", "film"): {"yield_stress_MPa": log_between(2.0, 100.0), "hardening_modulus_MPa": between(0.0, 100.0)},
    ("film-prestretch", "film"): {"strain_x": between(-0.001, 0.02), "strain_y": between(-0.001, 0.02)},
    ("friction", "dot"): {"coefficient": between(0.0, 1.5)},
    ("contact-gap", "dot"): {"gap_mm": between(0.0, 0.1)},
    ("rig-compliance", "rig"): {"compliance_mm_per_N": log_between(1e-3, 1.0)},
    ("inertia", "rig"): {"moving_mass_g": log_between(0.01, 100.0)},
    ("guide-friction", "rig"): {
        "friction_force_N": st.lists(between(0.0, 1.0), min_size=2, max_size=2),
        "presliding_mm": st.lists(log_between(1e-3, 0.1), min_size=2, max_size=2),
    },
    ("viscous-guide", "rig"): {
        "viscous_N_s_per_mm": between(0.0, 1.0),
        "stribeck_N": between(0.0, 1.0),
        "stribeck_mm_per_s": log_between(0.1, 10.0),
    },
    ("hysteresis", "film"): {
        "play_shares": st.lists(between(0.0, 0.4), min_size=2, max_size=2),
        "play_pC": st.lists(log_between(0.1, 100.0), min_size=2, max_size=2),
    },
    ("elastic-sides", "sides"): {"stiffness_N_per_mm3": log_between(0.01, 100.0)},
}
OF_A_MEDIUM = {
    "hyperelastic-stiffening": {"c20_MPa": between(0.0, 0.2), "c30_MPa": between(0.0, 0.05)},
    "foam-densification": {
        "mu_MPa": st.lists(between(0.1, 1.0), min_size=1, max_size=1),
        "alpha": st.lists(between(2.0, 12.0), min_size=1, max_size=1),
        "poisson_ratio": st.lists(between(0.0, 0.3), min_size=1, max_size=1),
    },
    "stress-softening": {"loss_ratio": between(0.0, 0.7), "beta": between(0.1, 0.5)},
    "property-error": {"modulus_factor": FACTOR, "thickness_factor": FACTOR},
}
OF_A_BOND = {
    "adhesive-compliance": {"normal_stiffness_N_per_mm3": STIFF, "shear_stiffness_N_per_mm3": STIFF},
}


@st.composite
def mechanisms(draw, segment, dot, foams):
    """A list of mechanism tables, none twice at one component; foams : layers of foam, which do not flow."""
    where = st.one_of(*choices(segment, dot))
    chosen = draw(st.lists(where, max_size=3, unique_by=lambda m: (m["name"], m["component"])))
    remade = [m for m in chosen if m["name"] in ("hyperelastic-stiffening", "foam-densification")]
    foams = foams | {m["component"] for m in remade if m["name"] == "foam-densification"}
    flowing = [m for m in chosen if m["component"] in foams and "flowing_share" in m["parameters"]]
    return [m for m in chosen if m not in remade[1:] and m not in flowing]


def choices(segment, dot):
    """A strategy for every mechanism that this segment and dot can have."""
    media = [name for name in ("effector", "medium1", "medium2") if name in segment]
    bonds = ["bond-base", "bond-film-medium2", "bond-medium1-film"]
    bonds += ["bond-effector-medium1"] if "effector" in segment else []
    yield from (switch(name, where, table) for (name, where), table in ANYWHERE.items())
    for name, table in OF_A_MEDIUM.items():
        yield st.sampled_from(media).flatmap(lambda where, name=name, table=table: switch(name, where, table))
    for name, table in OF_A_BOND.items():
        yield st.sampled_from(bonds).flatmap(lambda where, name=name, table=table: switch(name, where, table))
    for where in (*media, "film"):
        yield PRONY.map(lambda table, where=where: {"name": "viscoelasticity", "component": where, "parameters": table})
    for where in media:
        flowing = {"name": "viscoelasticity", "component": where}
        yield FLOWING.map(lambda table, flowing=flowing: {**flowing, "parameters": table})
    offset = {"offset_mm": st.tuples(between(-0.3, 0.3), st.just(0.0)).map(list)}
    yield switch("dot-offset", "dot", offset)
    width = min(segment["length_mm"], segment["width_mm"])
    patch = {"diameter_mm": between(0.6, 0.95).map(lambda share: share * width)}
    yield st.sampled_from(bonds[:3]).flatmap(lambda where: switch("delamination", where, patch))
    if segment["film"].get("electrodes"):
        yield switch("crosstalk", "channel-2", {"coupling": between(-0.5, 0.5)})
        yield switch("crosstalk", "channel-1-channel-2", {"capacitance_pF": between(0.0, 100.0)})
        yield switch("charge-leakage", "channel-1", {"resistance_MOhm": between(1.0, 1e4)})
        yield switch("low-pass", "channel-2", {"cutoff_Hz": between(10.0, 1e3)})
    if dot["shape"] != "plate":
        yield switch("property-error", "dot", {"radius_factor": FACTOR})
    if dot["shape"] == "cap" and dot["offset_mm"][1] == 0.0 and dot["tilt_deg"][0] == 0.0:
        yield switch("dimension-reduction", "dot", {})


def switch(name, component, parameters):
    """One mechanism with random parameters."""
    return st.fixed_dictionaries(
        {"name": st.just(name), "component": st.just(component), "parameters": st.fixed_dictionaries(parameters)}
    )
