"""What section 2 of the paper concludes, put to the test."""

from collections.abc import Mapping

import numpy as np

from softdot.studies.paper.calibration.factor import Factor, charge_pC, factors
from softdot.studies.paper.calibration.inputs import assumed_inputs
from softdot.studies.paper.calibration.ranges import Ranges
from softdot.studies.paper.calibration.readout import chain, swing_V
from softdot.studies.paper.calibration.rig import FILM_MM
from softdot.studies.paper.calibration.solved import FOAM, Rig, Solved
from softdot.studies.paper.section import Claim

SEGMENT_AREAS_MM2 = {"2.5 × 16 mm": 40.0, "2.5 × 2.5 mm": 6.25}


def claims(rig: Rig, spread: Ranges) -> list[Claim]:
    """Claims that section 2 concludes, checked on our presses."""
    found = factors(rig, assumed_inputs())
    return [_order(found), _transfer(rig), _trend(spread)]


def _order(found: Mapping[str, Factor]) -> Claim:
    simulated, recorded = ([one.outputs_V_per_mm[end] for one in found.values()] for end in (0, -1))
    return Claim(
        "A harder and thinner medium 1 gives more: case I above case II, simulated and recorded",
        simulated[0] > simulated[1] and recorded[0] > recorded[1],
        f"simulated {simulated[0]:.3g} against {simulated[1]:.3g} V/mm, recorded {1e3 * recorded[0]:.3g} against "
        f"{1e3 * recorded[1]:.3g} mV/mm",
    )


def _transfer(rig: Rig) -> Claim:
    losses = {size: lost_more(rig["I"], area) for size, area in SEGMENT_AREAS_MM2.items()}
    parts = [f"a film of {size} loses {times:.1f} times more" for size, times in losses.items()]
    return Claim(
        "p of the 16 × 16 mm sensor serves for the segment of 2.5 mm too",
        False,
        f"with the same input and speed {' and '.join(parts)} to leakage, as p is proportional to the area",
    )


def lost_more(solved: Solved, area_mm2: float) -> float:
    """Leakage of a film of another area, pressed alike, over that of the rig's film; cable left out."""
    values = assumed_inputs(capacitance_pF=0.0)
    curve = solved.curve(FOAM, values)
    charge = charge_pC(curve, solved.case.depth_mm, values["press_time_s"])
    share = area_mm2 / FILM_MM**2
    whole = swing_V(charge, curve.capacitance_pF, chain(values))
    return whole / swing_V(share * charge, share * curve.capacitance_pF, chain(values))


def _trend(spread: Ranges) -> Claim:
    ratio = spread.ratio()
    share = float((ratio > 1.0).mean())
    return Claim(
        "p of case II is above p of case I",
        True if share > 0.95 else False if share < 0.05 else None,
        f"in {100 * share:.0f} % of {len(ratio)} samples of the unknown inputs; median ratio {np.median(ratio):.2f}, "
        "printed 1.34",
    )
