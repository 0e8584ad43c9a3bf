"""A model of a segment whose medium 1 is the tested part, so that mechanisms are switched on as in a press.

Only medium 1, the read-out and the physics of such a model are looked at; film, medium 2 and dot stand idle, and so do
they for a sensor of unknown geometry.
"""

from collections.abc import Sequence

from diagnose.forward import Candidate, Coordinate, Setting
from geometry.parameters import Dot, Film, Medium, Segment
from solve.materials.parameters import Material, library
from solve.mechanisms import Mechanism, with_mechanisms
from solve.model import Model, Readout

LAYER = "medium1"
SPECIMEN = "specimen"


class PartOfLayer(Candidate):
    """A candidate whose component in the verdict is no part of a segment: its mechanism acts on medium 1."""

    def as_mechanism(self, values: Sequence[float]) -> Mechanism:
        """Mechanism on medium 1 at values (q,) of the coordinates. ValueError for values beyond its bounds."""
        return Mechanism(name=self.mechanism, component=LAYER, parameters=self.parameters(values))


def layer_model(material: Material, thickness_mm: float, readout: Readout | None = None) -> Model:
    """Model of a segment with this material in medium 1; all else stands idle."""
    idle = Medium(thickness_mm=1.0)
    segment = Segment(medium1=Medium(thickness_mm=thickness_mm), film=Film(thickness_um=28.0), medium2=idle)
    materials = {LAYER: material, "film": library()["pvdf"], "medium2": library()["vnr"]}
    return Model(segment, materials, Dot(), readout=readout)


def active_mechanisms(settings: Sequence[Setting]) -> list[Mechanism]:
    """Mechanisms of the settings that are not off."""
    return [setting.candidate.as_mechanism(setting.values) for setting in settings if any(setting.values)]


def with_factors_last(model: Model, mechanisms: Sequence[Mechanism]) -> Model:
    """Model with the mechanisms, wrong numbers last: a wrong modulus scales whatever law stands there in the end."""
    return with_mechanisms(model, sorted(mechanisms, key=lambda mechanism: mechanism.traits.wrong_number))


def drive_nuisance(name: str) -> Candidate:
    """Candidate of an error of the drive, which is no mechanism: an offset, or for force_gain a relative error."""
    coordinate = Coordinate(name, -1e6 if name != "force_gain" else -0.9, 1e6, (0.01, -0.01))
    return Candidate(name, "drive", (coordinate,), lambda values: {name: values[0]})
