"""The rigs of the proof: what the experimenter believes was built, how it is pressed and how noisy it is."""

from dataclasses import dataclass, replace

from diagnose.prove.world.amplifier import Amplifier, Filter
from diagnose.prove.world.made import Film, Layer, Made
from diagnose.prove.world.programme import Run


@dataclass(frozen=True)
class Bench:
    """nuisance : name -> one sigma, as in rig.toml. noise : one sigma as a share of the largest signal of a channel.

    peak_V, peak_N : about the largest signals, to scale noise and effects. force : whether a load cell is there.
    """

    name: str
    made: Made
    amplifier: Amplifier
    runs: tuple[Run, ...]
    nuisance: tuple[tuple[str, float], ...]
    peak_V: float
    peak_N: float
    noise: float = 0.004
    rate_Hz: float = 250.0
    force: bool = True

    @property
    def deepest_mm(self) -> float:
        """Of all runs."""
        return max(run.depth_mm for run in self.runs)

    @property
    def film_pF(self) -> float:
        """Capacitance of the film."""
        return self.made.capacitance_pF


NUISANCE = (
    ("gain", 0.02),
    ("force_gain", 0.02),
    ("lag_s", 0.001),
    ("offset_V", 0.02),
    ("offset_N", 0.01),
    ("modulus.medium1", 0.05),
)


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
        (
            Layer("medium2", 2.0, 1.0),
            Film(held=True),
            Layer("medium1", 0.5, 5.0, held=True),
            Layer("effector", 1.0, 1.0, held=True),
        ),
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
)
FREE = Bench(
    "ridge-free",
    Made(
        (Layer("medium2", 1.5, 0.5), Film(), Layer("medium1", 0.8, 2.0), Layer("effector", 0.8, 1.0)),
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
)
SOLID = Bench(
    "dot-clamped",
    Made(
        (
            Layer("medium2", 1.5, 0.5),
            Film(held=True),
            Layer("medium1", 0.5, 3.0, held=True),
            Layer("effector", 0.8, 1.0, held=True),
        ),
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
)
VOLTAGE_ONLY = replace(
    CLAMPED,
    name="ridge-voltage-only",
    force=False,
    amplifier=replace(CLAMPED.amplifier, resistance_MOhm=None),
    runs=CLAMPED.runs[:4],
    nuisance=tuple(one for one in NUISANCE if one[0] not in ("force_gain", "offset_N")),
)
"""No load cell and no resistor: nothing tells a cable's capacitance from a film of less charge."""
BENCHES = {bench.name: bench for bench in (CLAMPED, FREE, SOLID, VOLTAGE_ONLY)}
