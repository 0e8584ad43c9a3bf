"""A random mechanism of a given name for a given segment, never at its off value."""


def mechanism(draw, name, segment, dot) -> dict | None:
    """The table of one mechanism; None where this design cannot have it."""
    own = {**_of_the_circuit(draw), **_of_the_rig(draw), **_of_the_layers(draw, segment, dot)}
    if name == "dimension-reduction" and dot["shape"] == "plate":
        return None
    if name == "crosstalk" and "electrodes" not in segment["film"]:
        return None
    component, parameters = own[name]()
    return {"name": name, "component": component, "parameters": parameters}


def _of_the_circuit(draw):
    """Component and parameters of what acts behind the strain of the film, by name."""
    return {
        "charge-leakage": lambda: (draw.among(("readout", "film")), {"resistance_MOhm": draw.log(0.1, 1e4)}),
        "parasitic-capacitance": lambda: ("readout", {"capacitance_pF": draw.between(1.0, 500.0)}),
        "low-pass": lambda: ("readout", _low_pass(draw)),
        "saturation": lambda: ("readout", {"limit_V": draw.log(0.01, 10.0), "sharpness": draw.log(1.0, 100.0)}),
        "mains-hum": lambda: (
            "readout",
            {"frequency_Hz": draw.between(40.0, 70.0), "amplitude_V": draw.log(1e-3, 1.0)},
        ),
        "pyroelectric-drift": lambda: (
            "film",
            {"temperature_step_K": draw.sign(0.01, 2.0), "time_constant_s": draw.log(0.1, 10.0)},
        ),
        "contact-electrification": lambda: (
            "film",
            {"charge_pC": draw.sign(1.0, 50.0), "area_exponent": draw.between(0.3, 3.0)},
        ),
        "hysteresis": lambda: ("film", {"play_shares": [draw.between(0.01, 0.5)], "play_pC": [draw.log(0.1, 100.0)]}),
        "crosstalk": lambda: _crosstalk(draw),
    }


def _of_the_rig(draw):
    """Component and parameters of what acts outside the layers, by name."""
    return {
        "friction": lambda: ("dot", {"coefficient": draw.log(0.05, 1.2)}),
        "elastic-sides": lambda: ("sides", {"stiffness_N_per_mm3": draw.log(0.01, 100.0)}),
        "dot-offset": lambda: ("dot", {"offset_mm": [draw.sign(0.02, 0.3), 0.0]}),
        "contact-gap": lambda: ("dot", {"gap_mm": draw.between(0.01, 0.1)}),
        "rig-compliance": lambda: ("rig", {"compliance_mm_per_N": draw.log(1e-3, 1.0)}),
        "inertia": lambda: ("rig", {"moving_mass_g": draw.log(0.1, 100.0)}),
        "guide-friction": lambda: (
            "rig",
            {"friction_force_N": [draw.log(1e-3, 10.0)], "presliding_mm": [draw.log(1e-4, 0.1)]},
        ),
        "viscous-guide": lambda: (
            "rig",
            {
                "viscous_N_s_per_mm": draw.log(1e-3, 1.0),
                "stribeck_N": draw.log(1e-3, 1.0),
                "stribeck_mm_per_s": draw.log(0.1, 10.0),
            },
        ),
        "dimension-reduction": lambda: ("dot", {}),
    }


def _of_the_layers(draw, segment, dot):
    """Component and parameters of what layers and bonds do, by name."""
    media = [layer for layer in ("effector", "medium1", "medium2") if layer in segment]
    bonds = ["bond-medium1-film", "bond-film-medium2", "bond-base"]
    bonds += ["bond-effector-medium1"] if "effector" in segment else []
    return {
        "viscoelasticity": lambda: _relaxing(draw, media, ["film", *_bonded(segment)]),
        "hyperelastic-stiffening": lambda: (draw.among(media), _stiffening(draw)),
        "foam-densification": lambda: (draw.among(media), _foam(draw)),
        "stress-softening": lambda: (
            draw.among(media),
            {"loss_ratio": draw.between(0.05, 0.6), "energy_MPa": draw.log(1e-5, 1e-2), "beta": draw.between(0.1, 0.5)},
        ),
        "film-yield": lambda: (
            "film",
            {"yield_stress_MPa": draw.log(5.0, 100.0), "hardening_modulus_MPa": draw.between(0.0, 100.0)},
        ),
        "adhesive-compliance": lambda: (draw.among(bonds), _adhesive(draw)),
        "delamination": lambda: (draw.among(bonds[:3]), _patch(draw, segment)),
        "film-prestretch": lambda: ("film", {"strain_x": draw.log(1e-4, 0.02), "strain_y": draw.sign(1e-4, 1e-3)}),
        "property-error": lambda: _property(draw, media, dot),
    }


def _bonded(segment):
    """The compliant bond that the segment declares, if any: only such a one can relax."""
    names = {"medium1": "bond-medium1-film", "film": "bond-film-medium2", "medium2": "bond-base"}
    return [names[bond["between"][0]] for bond in segment.get("bonds", [])]


def _crosstalk(draw):
    """Of one channel or of two."""
    if draw.perhaps(0.5):
        return "channel-1-channel-2", {"capacitance_pF": draw.log(0.1, 100.0)}
    return draw.among(("channel-1", "channel-2")), {"coupling": draw.sign(0.01, 0.5)}


def _low_pass(draw):
    table = {"cutoff_Hz": draw.log(10.0, 1e4), "delay_s": draw.among((0.0, draw.log(1e-4, 1e-2)))}
    if draw.perhaps(0.3):
        return {**table, "order": 2, "quality": draw.between(0.4, 0.8)}
    return {**table, "order": draw.whole(1, 4)}


def _relaxing(draw, media, others):
    where, terms = draw.among([*media, *media, *others]), range(draw.whole(1, 3))
    series = {
        "relative_moduli": [draw.between(0.02, 0.25) for _ in terms],
        "relaxation_times_s": [draw.log(0.01, 10.0) for _ in terms],
    }
    flow = {"flowing_share": draw.among((0.0, 1.0, draw.between(0.0, 1.0)))} if where in media else {}
    return where, {**series, **flow}


def _stiffening(draw):
    law = draw.whole(0, 4)
    if law == 0:
        return {"c10_MPa": draw.log(0.02, 1.0), "c20_MPa": draw.log(1e-3, 0.1), "c30_MPa": draw.log(1e-4, 0.02)}
    if law == 1:
        return {"c01_MPa": draw.log(1e-3, 0.2)}
    if law == 2:
        return {"b": draw.log(0.01, 2.0), "n": draw.between(0.5, 8.0)}
    if law == 3:
        return {"b": draw.log(0.01, 2.0)}
    return {"mu_MPa": [draw.log(0.02, 1.0)], "alpha": [draw.between(2.0, 6.0)]}


def _foam(draw):
    return {
        "mu_MPa": [draw.log(0.05, 1.0)],
        "alpha": [draw.between(2.0, 12.0)],
        "poisson_ratio": [draw.between(0.0, 0.3)],
    }


def _adhesive(draw):
    if draw.perhaps(0.5):
        return {"normal_stiffness_N_per_mm3": draw.log(10.0, 1e6), "shear_stiffness_N_per_mm3": draw.log(5.0, 1e6)}
    return {
        "thickness_um": draw.log(5.0, 100.0),
        "youngs_modulus_MPa": draw.log(0.5, 1000.0),
        "poisson_ratio": draw.between(0.3, 0.48),
    }


def _patch(draw, segment):
    width = min(segment["length_mm"], segment["width_mm"])
    center = [draw.between(-0.02, 0.02) * width, 0.0]
    if draw.perhaps(0.3):
        return {"center_mm": center, "bonded_diameter_mm": draw.between(0.3, 0.6) * width}
    return {"center_mm": center, "diameter_mm": draw.between(0.5, 0.9) * width}


def _property(draw, media, dot):
    factor = [draw.sign(1.05, 1.4) for _ in range(2)]
    first, second = (size if size > 0 else -1.0 / size for size in factor)
    component = draw.among([*media, "film", *(["dot"] if dot["shape"] != "plate" else [])])
    if component == "dot":
        return component, {"radius_factor": max(first, 1.0 / first), "height_factor": 1.0 + 1e-3 * second}
    table = {"modulus_factor": first, "thickness_factor": second}
    return component, {**table, "d31_factor": first} if component == "film" else table
