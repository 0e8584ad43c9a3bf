"""Baselines that a diagnosis with the 3D model refuses."""

from diagnose.signals.recording import Recording
from foundation.errors import InputError
from geometry.checks import check_press_depth
from solve.materials.parameters import PiezoelectricFilm
from solve.materials.prony import Prony
from solve.model import Model
from solve.physics import laws_of


def refuse_unfit_baseline(model: Model, recording: Recording) -> None:
    """InputError, one sentence, for physics or depths that a diagnosis cannot take as its baseline."""
    film, physics = model.materials["film"], model.physics
    if isinstance(film, PiezoelectricFilm) and film.coupling == "two-way":
        raise InputError("coupling = 'two-way': a diagnosis needs a film whose voltage does not act back")
    viscosity = laws_of(physics.inelastic, Prony)
    if not all(series.linear for series in viscosity.values()):
        raise InputError("mechanisms: a diagnosis of a segment takes viscoelasticity with flowing_share = 0 alone")
    if viscosity and physics.prestretch != (0.0, 0.0):
        raise InputError("mechanisms: a diagnosis accepts declared viscoelasticity or film-prestretch, but not both")
    for run in recording.runs:
        if run.drive == "displacement_mm":
            try:
                check_press_depth(model.segment, float(run.drive_values.max()))
            except InputError as error:
                raise InputError(f"run '{run.label}' goes too deep (are these micrometres?): {error}") from None
