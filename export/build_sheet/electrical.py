"""What of a kit is electrical: capacitances to expect, the amplifier and its wiring."""

from export.build_sheet.contents import Contents
from geometry.flat.electrodes import Metal
from geometry.polygons import signed_area_mm2
from solve.materials.parameters import VACUUM_PERMITTIVITY
from solve.model import Readout


def capacitance_pF(contents: Contents) -> list[tuple[str, float]]:
    """Name and capacitance in pF of every top electrode against the common one.

    It is the relative permittivity times area over thickness.
    """
    per_mm2 = capacitance_pF_per_mm2(contents)
    return [(metal.name, per_mm2 * metal_area_mm2(metal)) for metal in contents.flat.metals if metal.face == "top"]


def capacitance_pF_per_mm2(contents: Contents) -> float:
    """Capacitance of a film between two electrodes, by its area."""
    return 1e9 * VACUUM_PERMITTIVITY * contents.permittivity / (1e-3 * contents.segment.film.thickness_um)


def metal_area_mm2(metal: Metal) -> float:
    """Area of an electrode without its lead."""
    return sum(signed_area_mm2(piece) for piece in metal.plates)


METER_SHARE = 0.02
"""What a capacitance meter must resolve of an electrode: a fifth of what a wrong film or a short lead shows."""


def meter_step_pF(contents: Contents) -> float:
    """What the capacitance meter must resolve."""
    return METER_SHARE * min(value for _, value in capacitance_pF(contents))


def amplifier_text(readout: Readout | None) -> str:
    """The amplifier of a configuration in words; without one, what open-circuit voltages need."""
    if readout is None:
        return "voltmeter or amplifier with more than 1 GΩ and less than 1 pF (none is stated in [readout])"
    if readout.mode == "charge":
        parallel = f" and {readout.feedback_MOhm:g} MΩ" if readout.feedback_MOhm is not None else ""
        return f"the charge amplifier of [readout]: {readout.feedback_pF:g} pF{parallel} in its feedback"
    into = "infinite resistance" if readout.input_resistance_MOhm is None else f"{readout.input_resistance_MOhm:g} MΩ"
    return f"the voltage amplifier of [readout]: {into} and {readout.input_capacitance_pF:g} pF, its cable included"


def wiring(contents: Contents) -> str:
    """How amplifier, cable and guard are connected, in sentences."""
    several = contents.device.is_array or len(contents.flat.metals) > 2
    top = "each top electrode to the core of a cable and an amplifier of its own" if several else "the top to its core"
    common = f"Wire the common electrode to the shield of a short shielded cable and {top}. "
    readout = contents.readout
    if readout is not None and readout.mode == "charge":
        return (
            f"{common}Core to the inverting input, shield to the amplifier's ground, which the other input lies on: a "
            "virtual ground, beside which capacitance and length of the cable do not count. "
            "Keep the core covered up to its contact, and ground the screws of the frame. "
        )
    return (
        f"{common}Cable and input load the film: measure their capacitance together and state it as "
        "readout.input_capacitance_pF. Where leakage matters, take a triaxial cable and drive its inner shield as a "
        "guard from the amplifier's output at gain 1. "
    )


RIM_TOLERANCE_MM = 0.05
"""How evenly a glue line is filled by hand (judged here)."""


def rim_text(contents: Contents) -> str | None:
    """Stiffness of the rim that the glue line makes, for an elastic one."""
    stack, modulus = contents.device.stack, contents.fabrication.rim_glue_modulus_MPa
    if stack.boundary != "elastic":
        return None
    gap = contents.rim_gap_mm
    stiff = modulus / max(gap - RIM_TOLERANCE_MM, 0.5 * gap)
    return (
        f"{stack.side_stiffness_N_per_mm3:g} N/mm³: G / t with glue of shear modulus G = {modulus:g} MPa in a gap of "
        f"t = {gap:.2g} mm; {modulus / (gap + RIM_TOLERANCE_MM):.2g} to {stiff:.2g} if off by {RIM_TOLERANCE_MM:g} mm. "
        "Across the gap the glue is at least four times as stiff, which the simulated rim is not"
    )
