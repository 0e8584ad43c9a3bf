"""What may float without counting as physics, through the model: sizes, moduli, d31, and the zero of the drive."""

from diagnose.forward import Candidate, Coordinate
from diagnose.recording import Recording
from diagnose.vocabulary.scene import Scene
from diagnose.vocabulary.wrong_numbers import nuisance as wrong_number

ZERO = "zero-of-the-drive"


def nuisance(scene: Scene, recording: Recording, name: str) -> Candidate | None:
    """The candidate with the one coordinate of a nuisance, None where the model has no such part."""
    if name != "offset_mm":
        return wrong_number(scene, name)
    if not any(run.drive == "displacement_mm" for run in recording.runs):
        return None
    most = offset_reach_mm(recording)
    coordinate = Coordinate("offset_mm", -most, most, (0.1 * most, -0.1 * most))
    return Candidate(ZERO, "dot", (coordinate,), lambda _: {}, units={"offset_mm": "mm"})


def offset_reach_mm(recording: Recording) -> float:
    """Six sigma of the largest error of the first touch that is declared."""
    return 6.0 * max((run.nuisance.get("offset_mm", 0.0) for run in recording.runs), default=0.0)
