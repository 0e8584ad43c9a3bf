"""Relaxation as a spectrum: two Prony branches a decade of time, as far as the recording can show it.

The coordinates are the branches' moduli over the long-term one, E_i / E_inf = t_i, so that g_i = t_i / (1 + sum t):
any values that are not negative make a valid series. A material with one time that lies between two branches is met
by their sum within 2 % of what relaxes, root mean square over a hold (5 to 8 % with one branch a decade), so that the
times need not be fitted.

A law that stiffens, or gives way, beyond the one stated: more terms of Ogden's series, or of Yeoh's.

Neo-Hookean is Ogden's law with the exponent 2, Mooney-Rivlin's second term that with -2. Terms of 4, 8 and -2 are
added, in compression -4, -8 and -2, and one of 2 that keeps the small-strain modulus. The coordinates are what all of
them add to the force at the largest strain of the recording, over that of the law as it stands and but for a change of
volume, and what the second and third have of it: 0 leaves the law. Of Gent's law up to 60 % of its limit of I1 - 3 this
family misses 0.6 % of the stress in tension; of the silicones and the natural rubber of examples/recordings, up to
stretch 4 and 7.6, about 1 %. A Yeoh law keeps its form: its quadratic and cubic terms change.
Under a force the terms only add, for a law that turns over has no answer to it.

A segment whose medium 1 is the part that was tested: what switches mechanisms on in a press does so here.

Only medium 1, the read-out and the physics of such a model are looked at; film, medium 2 and dot stand idle.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np
from scipy.ndimage import uniform_filter1d

from diagnose.forward import Candidate, Coordinate, Setting
from diagnose.signals.recording import Recording, Run
from diagnose.statistics.score_test import MOST
from geometry.parameters import Dot, Film, Medium, Segment
from solve.materials.parameters import Material, MooneyRivlin, Ogden, Yeoh, library
from solve.mechanisms import Mechanism, with_mechanisms
from solve.model import Model, Readout

MEDIUM = Yeoh(c10_MPa=0.5, poisson_ratio=0.495)
"""Whatever strains the film of a sensor of unknown geometry: of shear modulus 1, the unit of stress there."""
LARGEST_STRAIN = 0.1
"""Of it, at the largest force: small enough that relaxation is linear."""
MOST_OF_COUPON = 20.0  # of E_i / E_inf: a tape or a gel may relax by 95 % within a decade


SPACING = 0.5  # decades between branches
STAIRCASE = 3.0  # times as long as at the quickest rate: a loading with rests in it
SMOOTHED = 5  # samples, against the noise of the drive


def relaxation_times(recording: Recording, others: int = 0) -> tuple[float, ...]:
    """Times in s between a tenth of the quickest loading and three times the longest run.

    Half a decade apart, or as many as the score test takes beside so many others of the candidate. What has not come to
    rest when the longest run ends would else have to relax within it, and what flows already while it is loaded as
    slowly as that.
    """
    longest = 3.0 * max(float(run.time_s[-1] - run.time_s[0]) for run in recording.runs)
    shortest = max(min(_quickest(recording)) / 10.0, min(2.0 * run.step_s for run in recording.runs))
    decades = np.log10(longest / shortest)
    count = int(np.clip(ceil(decades / SPACING), 1, MOST - others))
    spacing = max(SPACING, decades / count)
    first = 0.5 * (decades - spacing * (count - 1))
    return tuple(float(shortest * 10.0 ** (first + spacing * n)) for n in range(count))


def _quickest(recording: Recording) -> list[float]:
    """Time of every loading, s; of a staircase that in which its quickest step would go through the whole range."""
    found = []
    for run, phases in zip(recording.runs, recording.phases, strict=True):
        through = _through_s(run)
        for press in phases.presses:
            loading = float(run.time_s[max(press.held - 1, press.touch)] - run.time_s[press.touch])
            found.append(through if loading > STAIRCASE * through else loading)
    return [time for time in found if time > 0.0] or [float(recording.runs[0].step_s)]


def _through_s(run: Run) -> float:
    """Range of the drive over its largest rate, s."""
    course = uniform_filter1d(run.drive_values, SMOOTHED, mode="nearest")
    rate = float(np.max(np.abs(np.gradient(course, run.time_s)))) if len(course) > 1 else 0.0
    return float(np.ptp(course)) / rate if rate > 0.0 else np.inf


EXPONENTS = (4.0, 8.0, -2.0)
OF_SHEAR = (4.0, 8.0, 1.0)  # -2 is the same as 2 there
UPWARDS = (4.0, 8.0)
ADDED = Coordinate("force_ratio_less_1", -0.95, 20.0, (0.5, -0.5))
SHARE = 20.0  # of one term, in terms of the force without; terms may compensate each other


@dataclass(frozen=True)
class Stiffening:
    """stretch : the principal one, along the load, at the largest strain.

    lateral : a principal stretch across is stretch ** -lateral, 1/2 in tension and compression, 1 in simple shear.
    by_force : whether any run is driven by its force.
    """

    material: Material
    stretch: float
    lateral: float
    by_force: bool

    @property
    def exponents(self) -> tuple[float, ...]:
        """Of the terms that are added to Ogden's series."""
        if self.by_force:
            chosen: tuple[float, ...] = UPWARDS
        else:
            chosen = OF_SHEAR if self.lateral == 1.0 else EXPONENTS
        return tuple(-abs(exponent) for exponent in chosen) if self.stretch < 1.0 else chosen

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Of the force at the largest strain, and of all terms but the first; of each term where a force drives."""
        names = ("c20", "c30") if isinstance(self.material, Yeoh) else [f"exponent_{a:g}" for a in self.exponents]
        if self.by_force:
            return tuple(Coordinate(f"force_by_{name}", 0.0, SHARE, (0.5,)) for name in names)
        return ADDED, *(Coordinate(f"force_by_{name}", -SHARE, SHARE, (0.5, -0.5)) for name in names[1:])

    def parameters(self, values: Sequence[float]) -> dict[str, Any]:
        """Constants of the law."""
        added = values if self.by_force else [values[0] - sum(values[1:]), *values[1:]]
        if isinstance(self.material, Yeoh):
            whole, x = self._slope_of_yeoh, self._excess
            c20 = self.material.c20_MPa + whole * added[0] / (2.0 * x)
            c30 = self.material.c30_MPa + whole * added[1] / (3.0 * x**2)
            return {"c10_MPa": self.material.c10_MPa, "c20_MPa": c20, "c30_MPa": c30}
        mu, alpha = _terms(self.material)
        whole = sum(m * self._stress(a) for m, a in zip(mu, alpha, strict=True))
        extra = [
            whole * value / (self._stress(a) - 0.5 * a * self._stress(2.0))
            for value, a in zip(added, self.exponents, strict=True)
        ]
        kept = -0.5 * sum(m * a for m, a in zip(extra, self.exponents, strict=True))
        terms: dict[float, float] = {}
        for a, m in zip((*alpha, 2.0, *self.exponents), (*mu, kept, *extra), strict=True):
            terms[a] = terms.get(a, 0.0) + m
        return {"mu_MPa": list(terms.values()), "alpha": list(terms)}

    def _stress(self, exponent: float) -> float:
        """dW / d ln(stretch) over mu of one term, at constant volume."""
        return float(self.stretch**exponent - self.stretch ** (-self.lateral * exponent))

    @property
    def _excess(self) -> float:
        """I1 - 3: stretches l, l^-1 and 1 in shear, l, l^-1/2 twice else."""
        across = self.stretch ** (-2.0 * self.lateral)
        return float(self.stretch**2 + across + (1.0 if self.lateral == 1.0 else across)) - 3.0

    @property
    def _slope_of_yeoh(self) -> float:
        """dW / dI1 at the largest strain."""
        assert isinstance(self.material, Yeoh)
        x = self._excess
        return self.material.c10_MPa + 2.0 * self.material.c20_MPa * x + 3.0 * self.material.c30_MPa * x**2


def _terms(material: Material) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """mu in MPa and alpha of a law as Ogden has it."""
    if isinstance(material, MooneyRivlin):
        return (2.0 * material.c10_MPa, -2.0 * material.c01_MPa), (2.0, -2.0)
    if isinstance(material, Ogden):
        return tuple(material.mu_MPa), tuple(material.alpha)
    return (material.shear_modulus_MPa,), (2.0,)


LAYER = "medium1"
SPECIMEN = "specimen"


class PartOfLayer(Candidate):
    """A candidate whose component in the verdict is none of a segment: its mechanism acts on medium 1."""

    def switched_on(self, values: Sequence[float]) -> Mechanism:
        """The mechanism on medium 1. ValueError for values beyond its bounds."""
        return Mechanism(name=self.mechanism, component=LAYER, parameters=self.parameters(values))


def one_layer(material: Material, thickness_mm: float, readout: Readout | None = None) -> Model:
    """The model with this material in medium 1."""
    idle = Medium(thickness_mm=1.0)
    segment = Segment(medium1=Medium(thickness_mm=thickness_mm), film=Film(thickness_um=28.0), medium2=idle)
    materials = {LAYER: material, "film": library()["pvdf"], "medium2": library()["vnr"]}
    return Model(segment, materials, Dot(), readout=readout)


def switched(settings: Sequence[Setting]) -> list[Mechanism]:
    """The mechanisms of the settings that are not off."""
    return [setting.candidate.switched_on(setting.values) for setting in settings if any(setting.values)]


def with_factors_last(model: Model, mechanisms: Sequence[Mechanism]) -> Model:
    """The model with the mechanisms; a wrong modulus scales whatever law stands there in the end."""
    return with_mechanisms(model, sorted(mechanisms, key=lambda mechanism: mechanism.traits.wrong_number))


def drive_error(name: str) -> Candidate:
    """A nuisance of the drive, which is no mechanism: added to it, or its relative error."""
    coordinate = Coordinate(name, -1e6 if name != "force_gain" else -0.9, 1e6, (0.01, -0.01))
    return Candidate(name, "drive", (coordinate,), lambda values: {name: values[0]})
