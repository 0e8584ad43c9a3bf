"""Presses of the calibration rig that nobody solved, with round numbers."""

import numpy as np

from softdot.studies.paper.calibration.inputs import INPUTS
from softdot.studies.paper.calibration.press_curve import PressCurve
from softdot.studies.paper.calibration.response import RigResponse
from softdot.studies.paper.calibration.rig import CASES
from softdot.studies.paper.calibration.solved import FOAM, ROUND, SIMULATED, VARIED, Solved

FILM_PF = 1000.0


def curve(depth_mm, voltage_V, force_N=1.0, exponent=1.0):
    """A press whose voltage is a power of the depth, and whose force is proportional to it."""
    share = np.linspace(0.0, 1.0, 7)
    return PressCurve(depth_mm * share, force_N * share, voltage_V * share**exponent, FILM_PF)


def solved(name="I", voltages=(40.0, 20.0, 10.0), response=1.0, exponent=1.0):
    """One case: voltages of the cross-section, of the round dot and of that on foam."""
    case = CASES[name]
    models = dict(zip((SIMULATED, ROUND, FOAM), voltages, strict=True))
    curves = {model: curve(case.depth_mm, voltage, 1.0, exponent) for model, voltage in models.items()}
    responses = {model: {entry: _response(entry, response) for entry in VARIED[model]} for model in VARIED}
    finer = {model: curves[model] for model in (SIMULATED, ROUND)}
    return Solved(
        case,
        curves,
        responses,
        finer,
        curves[SIMULATED],
        curves[SIMULATED].scale(0.5, 0.5),
        dict.fromkeys(models, 5000),
        {},
    )


def _response(name, ratio):
    """From 1 at the assumed value to a ratio at the upper end of the range, for voltage and force."""
    entry = INPUTS[name]
    return RigResponse(np.array([entry.assumed, entry.high]), np.array([[1.0, 1.0], [ratio, ratio]]))


def rig(**changes):
    """Both cases; case II loses twice as much to the third dimension."""
    return {"I": solved("I", **changes), "II": solved("II", (40.0, 10.0, 5.0), **changes)}
