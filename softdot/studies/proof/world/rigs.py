"""The rigs of the proof.

Two of them are made as those of another group, whose recordings are diagnosed beside the proof's: thicker layers, one
press a run, more noise, and no modulus that is stated as uncertain.
"""

from dataclasses import replace

import numpy as np

from softdot.studies.proof.world.amplifier import Amplifier, Filter
from softdot.studies.proof.world.bench import LOAD_CELL, Bench
from softdot.studies.proof.world.made import Film, Layer, Made
from softdot.studies.proof.world.runs import CLEAR_MM, Run, Traced, smooth_step, traced_run

NUISANCE = (
    ("gain", 0.02),
    LOAD_CELL[0],
    ("lag_s", 0.001),
    ("offset_V", 0.02),
    LOAD_CELL[1],
    ("modulus.medium1", 0.05),
)


Sized = tuple[float, float]
"""Thickness in mm and modulus in MPa of a layer."""


def _layers(medium2: Sized, medium1: Sized, effector: Sized, held: bool) -> tuple[Layer | Film, ...]:
    """Layers from the base upwards; what is held is held at its sides, all but medium 2."""
    upper = Layer("medium1", *medium1, held=held), Layer("effector", *effector, held=held)
    return (Layer("medium2", *medium2), Film(held=held), *upper)


def _runs(deep: float, resistance_MOhm: float) -> tuple[Run, ...]:
    """Three depths, three speeds, two holds and a second resistor; two presses each."""
    return (
        Run("fast and deep", deep, 0.12, 0.5),
        Run("slow and deep", deep, 0.6, 0.3),
        Run("shallow", 0.5 * deep, 0.2, 0.5),
        Run("long hold", 0.8 * deep, 0.2, 1.6),
        Run("other resistor", deep, 0.2, 0.5, resistance_MOhm=resistance_MOhm),
        Run("half depth, slow", 0.65 * deep, 0.5, 0.4),
    )


CLAMPED = Bench(
    "ridge-clamped",
    Made(
        _layers((2.0, 1.0), (0.5, 5.0), (1.0, 1.0), held=True),
        2.5,
        16.0,
        "ridge",
        0.8125,
    ),
    Amplifier(10_000.0, 100.0, (Filter(60.0, 2, "butterworth"),)),
    _runs(0.25, 1000.0),
    NUISANCE,
    36.0,
    7.6,
    usual=True,
)
FREE = Bench(
    "ridge-free",
    Made(
        _layers((1.5, 0.5), (0.8, 2.0), (0.8, 1.0), held=False),
        3.0,
        10.0,
        "ridge",
        1.15,
    ),
    Amplifier(5_000.0, 220.0, (Filter(100.0, 1, "butterworth"),)),
    _runs(0.3, 500.0),
    NUISANCE,
    6.6,
    3.2,
    usual=True,
)
SOLID = Bench(
    "dot-clamped",
    Made(
        _layers((1.5, 0.5), (0.5, 3.0), (0.8, 1.0), held=True),
        2.5,
        2.5,
        "cap",
        0.8125,
    ),
    Amplifier(20_000.0, 50.0, (Filter(60.0, 2, "butterworth"),)),
    _runs(0.2, 2000.0),
    NUISANCE,
    1.0,
    0.3,
    usual=True,
)
VOLTAGE_ONLY = replace(
    CLAMPED,
    name="ridge-voltage-only",
    force=False,
    amplifier=replace(CLAMPED.amplifier, resistance_MOhm=None),
    runs=CLAMPED.runs[:4],
    nuisance=tuple(one for one in NUISANCE if one not in LOAD_CELL),
)
"""No load cell and no resistor: nothing tells a cable's capacitance from a film of less charge."""
PITCH_MM = 2.5
ROW = Bench(
    "row-free",
    Made(
        (Layer("medium2", 1.5, 0.5), Film(), Layer("medium1", 0.8, 1.5)),
        3.0 * PITCH_MM,
        10.0,
        "ridge",
        1.15,
        fine=0.5,  # elements of half the size change force and charge by 0.1 %
        electrodes=tuple((n * PITCH_MM - 1.15, n * PITCH_MM + 1.15) for n in (-1, 0, 1)),
    ),
    Amplifier(5_000.0, 100.0, (Filter(60.0, 2, "butterworth"),)),
    (
        Run("first, fast", 0.25, 0.12, 0.5, place_mm=-PITCH_MM),
        Run("second, fast", 0.25, 0.12, 0.5),
        Run("first, slow and shallow", 0.16, 0.5, 0.4, place_mm=-PITCH_MM),
        Run("second, long hold", 0.2, 0.2, 1.6),
        Run("first, other resistor", 0.25, 0.2, 0.5, resistance_MOhm=500.0, place_mm=-PITCH_MM),
        Run("second, half depth", 0.125, 0.2, 0.4),
    ),
    NUISANCE,
    25.0,
    5.4,
    noise=0.002,
    mesh_mm=(0.6, 0.2),
)
"""Three electrodes in a row under layers that run through: each run presses over the first or the second of them."""


def _two_steps(depth_mm: float, step_s: float = 0.004) -> Traced:
    """Run to half the depth, a second's rest, to all of it, and back, with the acceleration of the other runs."""
    half_mm = 0.5 * depth_mm
    legs = (1.0, 0.2, half_mm + CLEAR_MM), (2.2, 0.2, half_mm), (3.6, 0.3, -depth_mm - CLEAR_MM)
    times = np.asarray(step_s * np.arange(round(4.6 / step_s) + 1), dtype=np.float64)
    path_mm = -CLEAR_MM + sum(by_mm * smooth_step((times - start_s) / leg_s) for start_s, leg_s, by_mm in legs)
    return replace(traced_run("two steps", times, np.asarray(path_mm), None, 0.0, 0.0), count=1)


ONCE = (
    Run("half-sine", 0.18, 0.15, 0.0, count=1),
    Run("ramp and hold", 0.3, 0.3, 1.6, count=1),
    Run("5 Hz", 0.12, 0.1, 0.0, count=8, pause_s=0.0),
    Run("0.2 Hz", 0.3, 2.5, 0.0, count=1, pause_s=0.5),
    _two_steps(0.25),
)
THICK = (2.0, 1.0), (0.8, 5.0), (1.0, 1.0)
WIDTHS = ("gain", 0.025), ("lag_s", 0.003)
THICK_CLAMPED = Bench(
    "thick-clamped",
    Made(_layers(*THICK, held=True), 2.5, 16.0, "ridge", 1.15),
    Amplifier(1e6, 10.0, (Filter(100.0, 1, "butterworth"),)),
    ONCE,
    (*WIDTHS, ("offset_V", 1.2)),
    120.0,
    16.0,
    noise=0.008,
)
THICK_FREE = replace(
    THICK_CLAMPED,
    name="thick-free",
    made=replace(THICK_CLAMPED.made, layers=_layers(*THICK, held=False)),
    amplifier=replace(THICK_CLAMPED.amplifier, resistance_MOhm=1e4, capacitance_pF=1e4),
    nuisance=(*WIDTHS, ("offset_V", 0.0025)),
    peak_V=0.25,
    peak_N=4.8,
)
BENCHES = {bench.name: bench for bench in (CLAMPED, FREE, SOLID, VOLTAGE_ONLY, ROW, THICK_CLAMPED, THICK_FREE)}
OFFERED = tuple(name for name, bench in BENCHES.items() if bench.force)
"""Names of those that can be asked for: on one without a load cell hardly anything can be told."""
