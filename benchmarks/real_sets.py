"""A scoreboard of real recordings: python -m benchmarks.real_sets JSON FOLDER [SET…] [--stability].

FOLDER holds the published sets as they are handed out: raw files for the converters of examples/recordings, and ready
recordings. What an expert would accept of each is written down here, before it is run. Beside it stand controls in
which no physics is left to find; with --stability also the changes of benchmarks.verdicts, which leave the physics
alone. Rows that the file has are not diagnosed again.
"""

import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from benchmarks.timing import Table, file_argument
from benchmarks.verdicts import AS_IT_IS, VARIANTS, diagnosed
from diagnose.signals.recording import Recording
from examples.recordings.controls import reversed_answers, shuffled
from softdot.config.rig import RIG_FILE

CONVERTERS = {
    "adhesive-shear": "adhesive_shear",
    "vhb-relaxation": "vhb_relaxation",
    "pvdf-presses": "pvdf_presses",
    "silicones-tensile": "silicones_tensile",
    "rubber-treloar": "rubber_treloar",
}
"""Folder of raw files -> converter."""


@dataclass(frozen=True)
class Accepted:
    """What an expert would accept. mechanisms : one of them is in the name. known : whether its physics is in the
    vocabulary; otherwise nothing may be identified. never : what must not be named.
    """

    mechanisms: tuple[str, ...]
    known: bool = True
    never: tuple[str, ...] = ()


ACCEPTED = {
    "adhesive-shear": Accepted(("viscoelasticity",)),
    "vhb-relaxation": Accepted(("viscoelasticity",)),
    "vhb-uneven": Accepted(("viscoelasticity",)),
    "pvdf-presses": Accepted(("charge-leakage",)),
    "pvdf-presses-cube3": Accepted(("charge-leakage",), known=False),
    "silicones-tensile": Accepted(("hyperelastic-stiffening",)),
    "rubber-treloar": Accepted(("hyperelastic-stiffening",)),
    "foam-compression": Accepted(("foam-densification", "viscoelasticity", "stress-softening", "hysteresis")),
    "foam-leap": Accepted(("foam-densification", "viscoelasticity", "stress-softening", "hysteresis")),
    "oring-friction": Accepted(("guide-friction", "friction", "viscous-guide"), never=("viscoelasticity",)),
    "hysteresis-loop": Accepted(("hysteresis",), known=False, never=("viscoelasticity", "charge-leakage", "low-pass")),
}
CONTROLS: dict[str, Callable[[Recording], Recording]] = {
    "shuffled": shuffled,
    "reversed": reversed_answers,
}


def recordings(source: Path, work: Path) -> Iterator[Path]:
    """Folders of the recordings of one set, converted where it is raw."""
    if source.name in CONVERTERS:
        import_module(f"examples.recordings.{CONVERTERS[source.name]}").convert(source, work / source.name)
        source = work / source.name
    yield from sorted(path.parent for path in source.rglob(RIG_FILE))


def judged(accepted: Accepted, control: str, row: dict[str, Any]) -> str:
    """Whether a verdict is right, wrong or none: "right", "kind", "none" or "wrong"."""
    named, whole = row["named"], row["grade"] == "identified"
    if control in CONTROLS:
        return "wrong" if named else "right"
    if any(name in named for name in accepted.never) or (whole and not accepted.known):
        return "wrong"
    if named:
        return "right" if any(name in named for name in accepted.mechanisms) else "wrong"
    return "kind" if row["grade"] == "kind only" else "none"


def main(path: Path, folder: Path, names: list[str], is_stability_asked: bool) -> None:
    """Diagnose what the file has not."""
    changes = {AS_IT_IS: VARIANTS[AS_IT_IS], **CONTROLS, **(VARIANTS if is_stability_asked else {})}
    table = Table(path, "real sets")
    with tempfile.TemporaryDirectory() as work:
        for name, accepted in ACCEPTED.items():
            if names and name not in names:
                continue
            for place in recordings(folder / name, Path(work)):
                for control, change in changes.items():
                    if table.has(recording=place.name, control=control):
                        continue
                    row = diagnosed(place, change)
                    if row is not None:
                        told = {"recording": place.name, "control": control, "is": judged(accepted, control, row)}
                        table.add({**told, **row})


if __name__ == "__main__":
    sets = [word for word in sys.argv[3:] if not word.startswith("--")]
    main(file_argument(), Path(sys.argv[2]), sets, "--stability" in sys.argv)
