"""Our values of the numbers of section 2."""

from collections.abc import Mapping

import numpy as np

from softdot.studies.paper.calibration.factor import Factor
from softdot.studies.paper.calibration.rig import CASES, SPONGE_MM, SPONGE_MPA
from softdot.studies.paper.section import Answer

PREDICTED = "predicted with assumed inputs, not fitted; see its range"


def answers(found: Mapping[str, Factor]) -> dict[str, Answer]:
    """Inputs that we took over, and p."""
    ours: dict[str, Answer] = {
        "section2.h2_mm": Answer(SPONGE_MM),
        "section2.E2_kPa": Answer(1e3 * SPONGE_MPA, "taken from the text"),
        "section2.p-mean": Answer(float(np.mean([one.p for one in found.values()])), PREDICTED),
    }
    for name, case in CASES.items():
        ours |= {
            f"table1.{name}.h1_mm": Answer(case.thickness_mm),
            f"table1.{name}.E1_MPa": Answer(case.material["youngs_modulus_MPa"]),
            f"table1.{name}.E2_kPa": Answer(1e3 * SPONGE_MPA, "the 50 kPa of the text are taken"),
            f"table1.{name}.u2_mm": Answer(case.depth_mm),
            f"table1.{name}.p": Answer(found[name].p, PREDICTED),
        }
    return ours
