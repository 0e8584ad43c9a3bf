"""The forward model of a coupon test: one material point that deforms as the whole coupon does."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from diagnose.engines.coupon.kinematics import coupon_kinematics
from diagnose.engines.coupon.point import MaterialPoint, youngs_modulus_MPa
from diagnose.engines.coupon.relaxation import NO_SERIES
from diagnose.engines.coupon.tested_layer import (
    LAYER,
    SPECIMEN,
    PartOfLayer,
    active_mechanisms,
    drive_nuisance,
    layer_model,
    with_factors_last,
)
from diagnose.forward import Candidate, Setting, Signals, SolvedOutright
from diagnose.signals.recording import Drive, Recording, Run, Specimen
from diagnose.vocabulary.base import candidates_of_coupon
from diagnose.vocabulary.layers.property_error import relative_error
from diagnose.vocabulary.scene import CouponScene
from foundation.arrays import Floats
from foundation.errors import InputError
from foundation.progress import Report
from solve.added import Motion
from solve.materials.mullins import Softening
from solve.materials.parameters import Material, PiezoelectricFilm, find_material
from solve.materials.prony import Prony
from solve.mechanisms import Mechanism
from solve.model import Model
from solve.physics import laws_of
from solve.reduced.rig import compliance_mm_per_N
from solve.solution.errors import NoEquilibriumError

DRIVE_ACCURACY = 1e-3  # of a drive that is taken as straight between its samples
FACTOR_OF_NUISANCE = {f"modulus.{SPECIMEN}": "modulus_factor", f"thickness.{SPECIMEN}": "thickness_factor"}
DRIVE_ERRORS: Mapping[str, Drive] = {"offset_mm": "displacement_mm", "offset_N": "force_N", "force_gain": "force_N"}
Starts = dict[tuple[str, int], Floats]
"""Label and length of a run -> unknowns (t, m) of its last answer."""


@dataclass(frozen=True)
class CouponEngine(SolvedOutright):
    """Forward model of a coupon that deforms uniformly, one material point; the 3D elements would find the same.

    material : as rig.toml states it. Nothing has to be prepared, and solve is predict. last : unknowns of the last
    answers, from which the next ones start, as fits move in small steps; None to start each at small strains, so that
    it depends on nothing but its arguments.
    """

    recording: Recording
    specimen: Specimen
    material: Material
    candidates: tuple[Candidate, ...]
    name: str = "material point"
    accuracy: Mapping[str, float] = field(
        default_factory=lambda: {"force_N": DRIVE_ACCURACY, "displacement_mm": DRIVE_ACCURACY}
    )
    free_nuisances: tuple[Candidate, ...] = ()
    shortfalls: tuple[str, ...] = ()
    last: Starts | None = field(default=None, repr=False, compare=False)

    def nuisance(self, name: str) -> Candidate | None:
        """Candidate of a relative error of modulus.specimen or thickness.specimen, or of an error of the drive.

        None for any other name.
        """
        if name in FACTOR_OF_NUISANCE:
            return relative_error(PartOfLayer, name, FACTOR_OF_NUISANCE[name])
        return drive_nuisance(name) if name in DRIVE_ERRORS else None

    def with_candidates(self, candidates: tuple[Candidate, ...]) -> Self:
        """This engine with fewer candidates."""
        return replace(self, candidates=candidates)

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """Force or displacement (t,) of a run. ValueError beyond the bounds of a value, or where a law turns over."""
        return self.imagine(self.recording.runs[run], settings)

    def imagine(self, run: Run, settings: Sequence[Setting]) -> Signals:
        """Every answer of a run that was not made. ValueError as predict."""
        of_drive = {s.candidate.mechanism: s.values[0] for s in settings if s.candidate.component == "drive"}
        of_coupon = [s for s in settings if s.candidate.component != "drive"]
        try:
            return self._answers(run, active_mechanisms(of_coupon), of_drive)
        except NoEquilibriumError as error:
            raise ValueError(str(error)) from None

    def solve(self, run: int, mechanisms: Sequence[Mechanism], report: Report) -> Signals:
        """Every answer of a run with these mechanisms, which act on medium 1. NoEquilibriumError."""
        return self._answers(self.recording.runs[run], mechanisms, {})

    def model(self, mechanisms: Sequence[Mechanism]) -> Model:
        """Model of a segment whose medium 1 is the coupon with these mechanisms."""
        return with_factors_last(layer_model(self.material, self.specimen.thickness_mm), mechanisms)

    def _answers(self, run: Run, mechanisms: Sequence[Mechanism], of_drive: Mapping[str, float]) -> Signals:
        """Answers of a run with these mechanisms; of_drive : errors of the drive by name. NoEquilibriumError."""
        kind = run.drive
        shift = sum(of_drive.get(name, 0.0) for name, of in DRIVE_ERRORS.items() if of == kind and name != "force_gain")
        gain = of_drive.get("force_gain", 0.0) if kind == "force_N" else 0.0
        drive = (run.smoothed_drive.values - shift) / (1.0 + gain)
        model = self.model(mechanisms)
        course = run.label, len(drive)
        near = None if self.last is None else self.last.get(course)
        point = material_point(self.specimen, model)
        found = point.answer_near(run.time_s, drive, kind, near, point.peak_energy(run.largest_before))
        if self.last is not None:
            self.last[course] = found.unknown
        if kind == "force_N":
            return {"displacement_mm": found.values}
        held = np.maximum(found.values, -buckling_load_N(self.specimen, model.materials[LAYER]))
        motion = Motion(drive, lambda: run.velocity_mm_per_s, lambda: run.acceleration_mm_per_s2)
        return {"force_N": np.asarray(held + model.physics.added_force_N(motion, dot_is_free=False))}


def buckling_load_N(specimen: Specimen, material: Material) -> float:
    """Load at which a strip between grips buckles and goes slack; infinite for a block or a layer.

    Euler's load of a column with clamped ends, 4 pi^2 E I / L^2 (Timoshenko and Gere, Theory of Elastic Stability, 2nd
    edition, 1961, section 2.1), with Young's modulus at small strain.
    """
    if specimen.kind != "tension":
        return np.inf
    thin, wide = sorted((specimen.width_mm, specimen.thickness_mm))
    stiffness = youngs_modulus_MPa(material.law) * wide * thin**3 / 12.0
    return float(4.0 * np.pi**2 * stiffness / specimen.length_mm**2)


def material_point(specimen: Specimen, model: Model) -> MaterialPoint:
    """Material point with the geometry of a coupon and the material, thickness and physics of medium 1 of a model."""
    physics, material = model.physics, model.materials[LAYER]
    thickness = model.segment.medium1.thickness_mm
    ratio = material.poisson_ratio
    built = specimen.model_copy(update={"thickness_mm": thickness})
    return MaterialPoint(
        coupon_kinematics(built.kind, built.gauge_mm, built.area_mm2),
        material.law,
        float(np.mean(ratio)),
        laws_of(physics.inelastic, Softening).get(LAYER),
        laws_of(physics.inelastic, Prony).get(LAYER, NO_SERIES),
        compliance_mm_per_N(physics),
    )


def coupon_engine(
    recording: Recording, materials: Mapping[str, Material], report: Report, last: Starts | None = None
) -> CouponEngine:
    """Engine of a recording with a specimen. materials : the user's own. last : see CouponEngine.

    InputError for a material that is none of a coupon, a column that is missing, or a travel beyond the specimen.
    """
    specimen = recording.specimen
    assert specimen is not None
    material = find_material(specimen.material, materials, "specimen.material")
    if isinstance(material, PiezoelectricFilm):
        raise InputError(f"specimen.material = '{specimen.material}': a film cannot be a coupon; name a medium")
    _refuse_unfit_runs(recording, specimen)
    point = material_point(specimen, layer_model(material, specimen.thickness_mm))
    candidates = candidates_of_coupon(CouponScene(recording, material, point))
    engine = CouponEngine(recording, specimen, material, candidates, last=last)
    report("material point", 1, 1)
    return engine


def _refuse_unfit_runs(recording: Recording, specimen: Specimen) -> None:
    """InputError for a missing column, a voltage, or a block that is pressed through its whole thickness."""
    for run in recording.runs:
        for name in ("displacement_mm", "force_N"):
            if name not in run.channels:
                raise InputError(f"recording '{run.file}': column {name} is missing; a coupon test has both")
        for name in run.voltages:
            raise InputError(f"recording '{run.file}', column {name}: a coupon has no voltage")
        deepest = float(np.nanmax(run.channels["displacement_mm"]))
        if specimen.kind == "compression" and deepest >= 0.95 * specimen.thickness_mm:
            raise InputError(
                f"recording '{run.file}', column displacement_mm: reaches {deepest:.3g} mm, but the specimen is "
                f"{specimen.thickness_mm:g} mm thick"
            )
