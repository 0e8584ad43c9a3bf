"""The table of docs/candidates.md: what a diagnosis looks for in which rig, read from the candidates themselves."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from diagnose.engines.coupon.engine import coupon_engine
from diagnose.engines.proportional.engine import proportional_engine
from diagnose.signals.recording import Drive, Recording, Run, Specimen
from diagnose.signals.time_scales import TimeScales
from diagnose.vocabulary.base import candidates_of_segment, vocabulary
from diagnose.vocabulary.scene import FORCE, PATH, VOLTAGE, Scene
from softdot.config.loading import config_from
from softdot.config.model import model_of
from solve.materials.parameters import NeoHookean
from solve.model import Readout

Aspects = Mapping[str, str]
"""Sides, dot, section, drive, read-out and electrodes of a rig, by name."""

ASPECTS: dict[str, dict[str, str]] = {
    "sides": {"clamped": "clamped", "elastic": "elastic sides", "free": "free sides"},
    "section": {"solid": "solid", "plane-strain": "slice"},
    "dot": {"round": "round dot", "plate": "plate"},
    "drive": {PATH: "by depth", FORCE: "by force"},
    "readout": {"voltage": "voltage", "charge": "charge amplifier", "none": "force alone"},
    "electrodes": {"1": "one electrode", "2": "two electrodes"},
}
"""Aspect -> its values and their words; a rig that is not described otherwise has the first of each."""
ORDINARY = {name: next(iter(values)) for name, values in ASPECTS.items()}


def scene_of(aspects: Aspects) -> Scene:
    """Scene of a rig with these aspects, all others ordinary."""
    chosen = {**ORDINARY, **aspects}
    solid, plate = chosen["section"] == "solid", chosen["dot"] == "plate"
    film: dict[str, Any] = {"thickness_um": 28.0}
    if chosen["electrodes"] == "2":
        sides = ("left", -0.6), ("right", 0.6)
        film["electrodes"] = [{"name": name, "center_mm": [x, 0.0], "size_mm": [1.0, 2.5]} for name, x in sides]
    segment = {
        "section": chosen["section"], "boundary": chosen["sides"], "effector": {}, "medium1": {"thickness_mm": 0.5},
        "film": film, "medium2": {"thickness_mm": 2.0},
    }  # fmt: skip
    dot = {"shape": "plate" if plate else "cap" if solid else "ridge"}
    drive: Drive = "displacement_mm" if chosen["drive"] == PATH else "force_N"
    answers = [FORCE if drive == PATH else PATH] + ([VOLTAGE] if chosen["readout"] != "none" else [])
    charge = Readout(mode="charge", feedback_pF=100.0)
    return Scene(
        model=model_of(config_from({"segment": segment, "dot": dot})),
        readouts=(charge if chosen["readout"] == "charge" else Readout(input_resistance_MOhm=1000.0),),
        depth_mm=0.3,
        force_N=2.0,
        voltage_V=0.5,
        scales=TimeScales(0.2, 1e-3, 10.0),
        channels=int(chosen["electrodes"]),
        shown=frozenset((drive, answer) for answer in answers),
    )


def looked_for(aspects: Aspects) -> set[tuple[str, str]]:
    """Mechanisms and components that are looked for in a rig with these aspects."""
    return {one.name for one in candidates_of_segment(scene_of(aspects))}


def _run(drive: Drive, other: str) -> Run:
    time = np.linspace(0.0, 10.0, 201)
    values = np.interp(time, [1.0, 2.0, 8.0, 9.0], [0.0, 1.0, 1.0, 0.0])
    channels: dict[str, Any] = {drive: values, other: values}
    there = {name: np.ones(len(time), dtype=bool) for name in channels}
    return Run("run", "run.csv", time, drive, channels, there, {name: ~flags for name, flags in there.items()})


def mechanisms_of_coupon(drive: Drive) -> set[str]:
    """Mechanisms that are looked for in a compressible coupon driven by its travel, or by its force."""
    specimen = Specimen(kind="compression", material="foam", length_mm=10.0, width_mm=10.0, thickness_mm=10.0)
    foam = NeoHookean(youngs_modulus_MPa=0.1, poisson_ratio=0.3)
    recording = Recording((_run(drive, FORCE if drive == PATH else PATH),), specimen)
    return {one.mechanism for one in coupon_engine(recording, {"foam": foam}, lambda *_: None).candidates}


def mechanisms_of_unknown_sensor() -> set[str]:
    """Mechanisms that are looked for in a sensor of unknown geometry."""
    recording = Recording((_run("force_N", VOLTAGE),))
    return {one.mechanism for one in proportional_engine(recording, lambda *_: None).candidates}


def candidate_table() -> str:
    """A row for each mechanism, a column for each rig that differs in one aspect from the ordinary one."""
    columns = {"ordinary": {name for name, _ in looked_for({})}}
    for aspect, values in ASPECTS.items():
        for value, words in list(values.items())[1:]:
            columns[words] = {name for name, _ in looked_for({aspect: value})}
    columns["coupon by travel"] = mechanisms_of_coupon("displacement_mm")
    columns["coupon by force"] = mechanisms_of_coupon("force_N")
    columns["unknown sensor"] = mechanisms_of_unknown_sensor()
    rows = [[f"`{name}`", *("●" if name in found else "" for found in columns.values())] for name in vocabulary()]
    lines = [["mechanism", *columns], *sorted(rows)]
    first, *others = (f"| {' | '.join(line)} |" for line in lines)
    return "\n".join([first, f"|---|{':-:|' * len(columns)}", *others])
