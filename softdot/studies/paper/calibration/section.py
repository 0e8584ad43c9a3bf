"""The page of part 2: the calibration rig, and the pieces of its factor of 337."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from foundation.executor import Executor
from softdot.progress import Progress
from softdot.studies.paper.calibration import contours, figures, tables
from softdot.studies.paper.calibration.answers import answers
from softdot.studies.paper.calibration.beam import tip_stiffness_N_per_mm
from softdot.studies.paper.calibration.claims import claims
from softdot.studies.paper.calibration.factor import LEAKAGE, Factor, factors
from softdot.studies.paper.calibration.inputs import INPUTS, assumed_inputs
from softdot.studies.paper.calibration.ranges import SAMPLE_EXPONENT, Ranges, quantiles, ranges
from softdot.studies.paper.calibration.rig import FINENESS
from softdot.studies.paper.calibration.solved import Rig, Solved, solve_rig
from softdot.studies.paper.section import Block, Figure, Heading, Section


def section(progress: Progress, folder: Path, executor: Executor) -> Section:
    """Press the rig in both cases and predict p. Figures go to folder / "figures". NotSolvedError."""
    progress.stage("calibration")
    return section_of(solve_rig(progress, executor), folder)


def section_of(rig: Rig, folder: Path, exponent: int = SAMPLE_EXPONENT) -> Section:
    """The section from presses that are solved, with 2^exponent samples of the unknown inputs."""
    spread, found = ranges(rig, exponent), factors(rig, assumed_inputs())
    return Section(
        name="calibration",
        title="The calibration rig, and why simulation gave 337 times too much",
        findings=_findings(rig, spread, found),
        blocks=_blocks(rig, spread, found, folder),
        numbers=_numbers(rig, spread, found),
        claims=claims(rig, spread),
        answers=answers(found),
    )


def _findings(rig: Rig, spread: Ranges, found: Mapping[str, Factor]) -> list[str]:
    shares = [100 * one.shares[LEAKAGE] for one in found.values()]
    return [
        f"Physics that the paper's simulation leaves out gives p without any fit: {_predictions(spread, found)}. "
        f"Leakage through the amplifier's input is {min(shares):.0f} to {max(shares):.0f} % of p on a logarithmic "
        "scale.",
        f"p is not a constant of the sensor. It follows the input resistance R and the press time T, which the paper "
        f"does not give: {_exact(rig)}.",
        "One measurement settles it: the input resistance, by a known resistor in parallel to the film. The press "
        "time is in the authors' recordings already.",
    ]


def _predictions(spread: Ranges, found: Mapping[str, Factor]) -> str:
    parts = []
    for name, one in found.items():
        low, _, high = quantiles(spread.p(name))
        above = 100 * float((spread.p(name) >= contours.printed_factor(name)).mean())
        parts.append(
            f"case {name} {one.p:.0f}, range {low:.0f} to {high:.0f} (printed {contours.printed_factor(name):g}, which "
            f"{above:.0f} % of the samples reach)"
        )
    return "; ".join(parts)


def _exact(rig: Rig) -> str:
    """Press times that give the printed values at the assumed resistance."""
    resistance = assumed_inputs()["resistance_MOhm"]
    times = {name: contours.time_for(solved, contours.printed_factor(name), resistance) for name, solved in rig.items()}
    parts = [
        f"p = {contours.printed_factor(name):g} needs " + ("more than 0.5 s" if time is None else f"T = {time:.2f} s")
        for name, time in times.items()
    ]
    return f"at R = {resistance:g} MΩ, {' and '.join(parts)}"


def _numbers(rig: Rig, spread: Ranges, found: Mapping[str, Factor]) -> dict[str, Any]:
    return {
        "inputs": {name: asdict(entry) for name, entry in INPUTS.items()},
        "cases": {name: _case_numbers(solved, spread, found[name]) for name, solved in rig.items()},
        "p_II_over_p_I": dict(zip(("low", "median", "high"), quantiles(spread.ratio()), strict=True)),
        "samples": len(spread.shares),
    }


def _case_numbers(solved: Solved, spread: Ranges, one: Factor) -> dict[str, Any]:
    name = solved.case.name
    return {
        "p_printed": contours.printed_factor(name),
        "p_assumed_inputs": one.p,
        "p_5_50_95_percent": quantiles(spread.p(name)),
        "pieces": one.pieces,
        "pieces_5_50_95_percent": {piece: quantiles(values) for piece, values in spread.pieces(name).items()},
        "shares_of_log_p": one.shares,
        "outputs_V_per_mm": one.outputs_V_per_mm,
        "spread_explained_by": spread.drivers(name),
        "exact": [
            {"press_time_s": t, "resistance_MOhm": r} for t, r in contours.curve(solved, contours.printed_factor(name))
        ],
        "mesh_change_of_2D_for_3D": tables.mesh_error(solved),
        "voltage_ratio_with_glue": tables.voltage_ratio(solved, "glued"),
        "voltage_ratio_with_5_kPa": tables.voltage_ratio(solved, "soft"),
        "presses": {model: _curve_numbers(solved, model) for model in solved.curves},
        "stopped_mm": solved.stopped_mm,
    }


def _curve_numbers(solved: Solved, model: str) -> dict[str, Any]:
    curve = solved.curves[model]
    return {
        "depth_mm": curve.depth_mm.tolist(),
        "force_N": curve.force_N.tolist(),
        "open_circuit_voltage_V": curve.voltage_V.tolist(),
        "unknowns": solved.unknowns[model],
    }


def _blocks(rig: Rig, spread: Ranges, found: Mapping[str, Factor], folder: Path) -> list[Block]:
    return [*_rig_blocks(rig, folder), *_piece_blocks(rig, spread, found, folder), *_doubt_blocks(rig, spread)]


def _rig_blocks(rig: Rig, folder: Path) -> list[Block]:
    return [
        "The paper built one sensor twice: a film of 16 × 16 mm on a sponge of 5 mm, under an OHP sheet (case I) or "
        "under rubber (case II). A copper dot on an acrylic beam was pressed into it by hand, ten times in ten "
        "seconds, 0.831 and 1.57 mm deep on average. It divided the simulated voltage per depth by the recorded one "
        "and got p = 288 and 385. Here p is not an input. The same rig is simulated twice: as an ideal cross-section "
        "at open circuit, as the paper's drawings suggest its simulation was, and as it was built.",
        Figure(
            figures.draw_signal(rig, folder),
            "One press a second, as in the paper's Fig. 2",
            "Left: what remains of tens of volts after the assumed input and the 60 Hz low-pass. The film gives a "
            "voltage while it is pressed and one of the other sign while it is released, since the charge leaks off "
            "far faster than the hand moves. Right: the depth of the dot.",
        ),
        Figure(
            figures.draw_outputs(rig, folder),
            "Normalised output, as in the paper's Figs. 3 and 4",
            "The paper prints no values of these figures; its p is their ratio.",
        ),
    ]


def _piece_blocks(rig: Rig, spread: Ranges, found: Mapping[str, Factor], folder: Path) -> list[Block]:
    return [
        Heading("p, factor by factor"),
        tables.pieces(rig, spread),
        Figure(
            figures.draw_pieces(rig, spread, folder),
            "p as a product",
            "Logarithmic, so that factors are lengths; a bar that goes down makes p smaller. On the right: p with the "
            "assumed inputs (line), its range over all of them (bar, 5 to 95 %, median white) and the printed value "
            "(diamond).",
        ),
        Heading("What R and T would give the printed values"),
        Figure(
            figures.draw_map(rig, folder),
            "p over input resistance and press time",
            "Coloured: exactly the printed p. Where charge leaks much faster than the hand presses, p depends on T/R "
            "alone.",
        ),
        tables.exact(rig),
        _ratio(spread, found),
    ]


def _ratio(spread: Ranges, found: Mapping[str, Factor]) -> str:
    low, middle, high = quantiles(spread.ratio())
    measured = contours.printed_factor("II") / contours.printed_factor("I")
    ours = found["II"].p / found["I"].p
    within = "within" if low <= measured <= high else "outside"
    return (
        "R, T and the capacitance were the same in both cases (the paper says so of the time), so they nearly cancel "
        f"in p of case II over p of case I. That ratio tests the mechanics alone: {ours:.2f} with the assumed inputs, "
        f"{low:.2f} to {high:.2f} over all of them (median {middle:.2f}). Printed: {measured:.2f}, {within} the range."
    )


def _doubt_blocks(rig: Rig, spread: Ranges) -> list[Block]:
    return [
        Heading("What is not known"),
        tables.inputs(spread),
        _beam(),
        "What would decide. First, R: press once as before, then again with a known resistor (1 MΩ, say) in "
        "parallel to the film. If leakage is the cause, the voltage falls by 1 + R / 1 MΩ; if not, it stays. Second, "
        "T: it can be read off the recorded strain gauge. With both, a single factor is left to test: a press with a "
        "charge amplifier takes R and T out altogether and compares film and mechanics directly.",
        Heading("What cannot be predicted"),
        _causes_left_out(rig),
        tables.mesh_errors(rig),
        _accuracy(rig),
    ]


def _beam() -> str:
    low, high = INPUTS["beam_length_mm"].low, INPUTS["beam_length_mm"].high
    return (
        "The beam is a spring in parallel with the sensor, of "
        f"{tables.span(tip_stiffness_N_per_mm(high), tip_stiffness_N_per_mm(low))} N/mm for {low:g} to {high:g} mm. "
        "Where the hand pushes exactly over the dot it takes force from the hand and nothing else: its factor is 1. "
        "Where the hand pushes a little nearer to the clamp, the gauge shows more depth than the dot has, because the "
        "sensor's own force bends the beam back."
    )


def _causes_left_out(rig: Rig) -> str:
    glue = [tables.voltage_ratio(solved, "glued") for solved in rig.values()]
    soft = [1.0 / tables.voltage_ratio(solved, "soft") for solved in rig.values()]
    return (
        "The film: its constants differ by about 20 % from lot to lot, to which p is proportional. The glue: 30 µm of "
        "0.3 MPa on both faces of the film would change the voltage of the cross-section by "
        f"{100 * (glue[0] - 1):+.0f} % (case I) and {100 * (glue[1] - 1):+.0f} % (case II). The sponge: the text says "
        "50 kPa, Table 1 prints 5; had the paper simulated the one and built the other, p of case I and II would be "
        f"{soft[0]:.2g} and {soft[1]:.2g} times smaller. The dot's height: at 1.57 mm a Braille dot of 0.5 mm is "
        "sunk and the beam lies on the sensor; here the dot is taken high enough. The paper's ANSYS model: mesh, "
        "elements, contact and constants are not given, and neither is whether it was a cross-section."
    )


def _accuracy(rig: Rig) -> str:
    errors = " and ".join(f"{100 * abs(tables.mesh_error(solved)):.1f} %" for solved in rig.values())
    stopped = [f"{name} at {depth:.3g} mm" for solved in rig.values() for name, depth in solved.stopped_mm.items()]
    ended = f" Stopped early and carried on along the tangent: {'; '.join(stopped)}." if stopped else ""
    return (
        f"With all elements smaller by {FINENESS:g} the first factor (2D for 3D) changes by {errors} in case I and II. "
        "Each input changes a press by a factor of its own, found by pressing again with that input alone changed; "
        f"how two of them act together is taken as the product.{ended}"
    )
