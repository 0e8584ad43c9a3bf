"""Tables of the calibration rig."""

from collections.abc import Mapping

from softdot.studies.paper.calibration import contours
from softdot.studies.paper.calibration.contours import printed_factor
from softdot.studies.paper.calibration.factor import PIECES, Factor, factors
from softdot.studies.paper.calibration.inputs import INPUTS, assumed_inputs
from softdot.studies.paper.calibration.ranges import Ranges, quantiles
from softdot.studies.paper.calibration.solved import MODELS, ROUND, SIMULATED, Rig, Solved
from softdot.studies.paper.section import Cell, PaperTable

TIMES_S = (0.1, 0.2, 0.3, 0.4, 0.5)
WORDS = dict(
    zip(
        PIECES,
        (
            "a round dot instead of a ridge across the whole sensor",
            "a foam instead of a sponge of one modulus",
            "the hand not exactly over the dot",
            "charge leaks through the input while the hand presses",
            "60 Hz low-pass, 48 dB per octave",
        ),
        strict=True,
    )
)


def digits(value: float, count: int = 3) -> float:
    """Rounded to significant digits."""
    return float(f"{value:.{count}g}")


def span(low: float, high: float) -> str:
    """A range for people."""
    return f"{low:.3g} to {high:.3g}"


def pieces(rig: Rig, spread: Ranges) -> PaperTable:
    """Table of both cases piece by piece: factor, its range, its share."""
    found = factors(rig, assumed_inputs())
    rows: list[list[Cell]] = [["ideal output (V/mm)", *_outputs(found, 0)]]
    for number, piece in enumerate(PIECES, start=1):
        cells: list[Cell] = []
        for name, one in found.items():
            low, _, high = quantiles(spread.pieces(name)[piece])
            cells += [digits(one.pieces[piece]), span(low, high), f"{round(100 * one.shares[piece])} %"]
            cells.append(digits(one.outputs_V_per_mm[number]))
        rows.append([f"{piece}: {WORDS[piece]}", *cells])
    rows.append(["p, the product", *_products(found, spread)])
    rows.append(["p printed", *(cell for name in found for cell in (printed_factor(name), "", "", ""))])
    words = ("factor", "5 to 95 %", "share of ln p", "D left (V/mm)")
    headers = [f"{name}: {word}" for name in found for word in words]
    return PaperTable(
        "calibration-pieces",
        "p of both cases as a product",
        ["switched on in turn", *headers],
        rows,
        "Factors with the assumed inputs; ranges over all inputs at once. D is the voltage over the depth; before the "
        "leakage it is that at open circuit, from there on maximum minus minimum, as the paper measures it.",
    )


def _outputs(found: Mapping[str, Factor], number: int) -> list[Cell]:
    return [cell for one in found.values() for cell in ("", "", "", digits(one.outputs_V_per_mm[number]))]


def _products(found: Mapping[str, Factor], spread: Ranges) -> list[Cell]:
    cells: list[Cell] = []
    for name, one in found.items():
        low, _, high = quantiles(spread.p(name))
        cells += [digits(one.p), span(low, high), "100 %", digits(one.outputs_V_per_mm[-1])]
    return cells


def inputs(spread: Ranges) -> PaperTable:
    """Table of the inputs that the paper does not state: range, reason, and share in the spread of p."""
    drivers = {name: spread.drivers(name) for name in spread.factors}
    return PaperTable(
        "calibration-inputs",
        "What the paper does not say of its rig",
        ["input", "low", "assumed", "high", "why", *(f"share in the spread of p, case {name}" for name in drivers)],
        [
            [
                f"{entry.title} ({entry.unit})" if entry.unit else entry.title,
                entry.low,
                digits(entry.assumed),
                entry.high,
                entry.why,
                *(f"{100 * driver[entry.name]:.0f} %" for driver in drivers.values()),
            ]
            for entry in INPUTS.values()
        ],
        f"Each is taken evenly over its range (R: over its logarithm), {len(spread.shares)} quasi-random samples. The "
        "share is the square of the rank correlation with p. The ranges are judged, not measured.",
    )


def exact(rig: Rig) -> PaperTable:
    """Pairs of press time and input resistance that give exactly what is printed."""
    found = {
        name: [contours.resistance_for(solved, printed_factor(name), t) for t in TIMES_S]
        for name, solved in rig.items()
    }
    return PaperTable(
        "calibration-exact",
        "Input resistance that gives exactly the printed p",
        ["press time T (s)", *(f"R for p = {printed_factor(name):g}, case {name} (MΩ)" for name in found)],
        [
            [time, *("none" if each[row] is None else digits(each[row] or 0.0) for each in found.values())]
            for row, time in enumerate(TIMES_S)
        ],
        "The other inputs as assumed.",
    )


def mesh_errors(rig: Rig) -> PaperTable:
    """Table of the presses, with the changes by finer meshes, glue, and the softer sponge of Table 1."""
    rows: list[list[Cell]] = []
    for name, solved in rig.items():
        depth = solved.case.depth_mm
        for model in MODELS:
            curve = solved.curves[model]
            voltage, force = float(curve.voltage_at(depth)), float(curve.force_at(depth))
            finer = solved.finer.get(model)
            change = "" if finer is None else f"{100 * (float(finer.voltage_at(depth)) / voltage - 1):+.1f} %"
            rows.append([f"{name}, {model}", digits(voltage), digits(force), solved.unknowns[model], change])
    return PaperTable(
        "calibration-presses",
        "The presses with the assumed inputs, at the depths of Table 1",
        ["press", "open-circuit voltage (V)", "force (N)", "unknowns", "voltage on a finer mesh"],
        rows,
        "Finer: all element sizes times 0.7.",
    )


def voltage_ratio(solved: Solved, which: str) -> float:
    """Voltage of the cross-section with "glued" or "soft" layers over that without."""
    depth = solved.case.depth_mm
    changed = {"glued": solved.glued, "soft": solved.soft}[which]
    return float(changed.voltage_at(depth) / solved.curves[SIMULATED].voltage_at(depth))


def mesh_error(solved: Solved) -> float:
    """Relative change of the first piece on finer meshes."""
    depth = solved.case.depth_mm
    simulated = float(solved.finer[SIMULATED].voltage_at(depth) / solved.curves[SIMULATED].voltage_at(depth))
    return simulated / float(solved.finer[ROUND].voltage_at(depth) / solved.curves[ROUND].voltage_at(depth)) - 1.0
