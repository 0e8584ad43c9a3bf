"""Time of a reduced model for a 10 s recording at 1 kHz: python -m benchmarks.reduced JSON [ELEMENT_SIZE_MM].

The paper's segment, two relaxing media with five Prony branches, the circuit with two filters and the hum. The model
is made once and kept; the first answer (compilation) is not counted, then the median of 21 answers.
"""

import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.timing import Table, file_argument
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Dot, Effector, Film, Medium, Segment
from mesh.build import build
from mesh.options import MeshOptions
from solve.materials.parameters import NeoHookean, PiezoelectricFilm
from solve.materials.prony import Prony
from solve.model import Readout
from solve.physics import Physics
from solve.readout.stages import Hum
from solve.reduced.build import build_reduced
from solve.reduced.model import ReducedModel
from solve.terms.inertia import MovingMass
from solve.terms.rig import RigSpring

RELAXING = {"medium2": 0.3, "medium1": 0.2}
DEPTH_MM, ANSWERS = 0.3, 21
READOUT = Readout(input_resistance_MOhm=100.0, input_capacitance_pF=100.0, low_pass_Hz=200.0, high_pass_Hz=0.1)
VISCOUS = Physics(
    inelastic={"medium2": (Prony((0.1, 0.1, 0.1), (0.01, 0.2, 3.0)),), "medium1": (Prony((0.1, 0.1), (0.05, 1.0)),)},
    stages=(Hum(50.0, 0.01),),
)
CASES = {
    "rate-independent": (Physics(), False),
    "viscoelastic": (VISCOUS, False),
    "viscoelastic, compliant rig": (replace(VISCOUS, terms=(RigSpring(0.1),)), False),
    "viscoelastic, driven by force": (VISCOUS, True),
    "viscoelastic, compliant rig, 5 g": (replace(VISCOUS, terms=(RigSpring(0.1), MovingMass(5.0))), False),
}


def paper_model(size_mm: float) -> tuple[ReducedModel, float]:
    """The reduced model and the seconds that it took, near zero when it was kept."""
    segment = Segment(
        effector=Effector(height_mm=1.0), medium1=Medium(thickness_mm=0.5), film=Film(thickness_um=28.0),
        medium2=Medium(thickness_mm=2.0),
    )  # fmt: skip
    rubber = {"poisson_ratio": 0.495}
    materials = {
        "effector": NeoHookean(youngs_modulus_MPa=1.0, **rubber),
        "medium1": NeoHookean(youngs_modulus_MPa=5.0, **rubber),
        "medium2": NeoHookean(youngs_modulus_MPa=1.0, **rubber),
        "film": PiezoelectricFilm(),
    }
    dot = resolve_dot(Dot(standard="marburg-medium"), segment)
    options = MeshOptions(element_size_mm=size_mm, contact_element_size_mm=0.5 * size_mm, mesher="layered")
    tet_mesh = build(segment, dot, options)
    start = time.perf_counter()
    model = build_reduced(segment, materials, dot, tet_mesh, DEPTH_MM, RELAXING)
    return model, time.perf_counter() - start


def milliseconds(model: ReducedModel, physics: Physics, by_force: bool) -> float:
    """Median time of an answer to ten seconds of presses at 1.3 Hz."""
    at = 1e-3 * np.arange(10_000)
    drive = 0.5 * DEPTH_MM * (1.0 - np.cos(2.0 * np.pi * 1.3 * at))
    asked = {"force_N": 0.5 * drive} if by_force else {"depth_mm": drive}
    model.respond(at, physics=physics, readout=READOUT, **asked)
    taken = []
    for _ in range(ANSWERS):
        start = time.perf_counter()
        model.respond(at, physics=physics, readout=READOUT, **asked)
        taken.append(time.perf_counter() - start)
    return 1e3 * float(np.median(taken))


def main(path: Path, size_mm: float) -> None:
    """Measure every case."""
    table = Table(path, "reduced")
    model, seconds = paper_model(size_mm)
    errors = {name: float(value) for name, value in vars(model.accuracy).items()}
    for name, (physics, by_force) in CASES.items():
        row = {"case": name, "milliseconds": milliseconds(model, physics, by_force)}
        table.add({**row, "built_in_seconds": seconds, "largest_errors": errors})


if __name__ == "__main__":
    main(file_argument(), float(sys.argv[2]) if len(sys.argv) > 2 else 0.9)
