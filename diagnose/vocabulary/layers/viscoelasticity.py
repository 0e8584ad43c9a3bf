"""Viscoelasticity of a layer or a declared compliant bond: Prony branches at fixed times, shifted together."""

from collections.abc import Iterator, Mapping, Sequence
from math import exp, log, log10
from typing import Any

import numpy as np

from diagnose.engines.coupon.relaxation_spectrum import LARGEST_MODULUS_RATIO, relaxation_times, shortest_time_s
from diagnose.engines.coupon.tested_layer import LAYER, SPECIMEN, PartOfLayer
from diagnose.forward import Candidate, Coordinate
from diagnose.signals.recording import Recording
from diagnose.signals.time_scales import TimeScales, time_scales
from diagnose.vocabulary.base import REMEMBERS, Vocabulary, register
from diagnose.vocabulary.scene import CouponScene, Scene
from solve.materials.prony import Prony
from solve.mechanisms.layers.viscoelasticity import VISCOELASTICITY
from solve.model import Model
from solve.physics import laws_of

BRANCHES = 4
LARGEST_SHARE = 0.75
"""Of the stress that may relax; the reduced model is made for it."""
MOST = LARGEST_SHARE / (1.0 - LARGEST_SHARE) / BRANCHES  # modulus of one branch, in terms of what never relaxes
EARLY_S, LATE_S = 0.1, 10.0
FEWEST_SAMPLES = 5.0  # within the shortest time of relaxation that is looked for
LINEAR = Coordinate("linear_share", 0.0, 1.0, (1.0,), levels_off=(False, True))
"""The share of the branches of a coupon by which its stress relaxes; by the others it flows."""
MOST_OF_SENSOR = 1.0  # modulus of one branch of an unknown sensor, in terms of what never relaxes


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """All that can relax."""
    for component in relaxable(scene.model):
        declared = laws_of(scene.model.physics.inelastic, Prony)
        yield _candidate(scene, component, declared.get(component, Prony((), ())))


def of_coupon(scene: CouponScene) -> Iterator[Candidate]:
    """The specimen, two branches a decade; rubber flows, but for a share that is fitted."""
    shares = () if scene.point.law.compressible else (LINEAR,)
    scales = time_scales(scene.recording)
    branches = branches_at(relaxation_times(scales, len(shares)), scales, LARGEST_MODULUS_RATIO)
    yield spectrum(PartOfLayer, SPECIMEN, branches, shares)


def of_unknown_geometry(scene: Scene, recording: Recording) -> Iterator[Candidate]:
    """Whatever medium strains the film, and the film."""
    scales = time_scales(recording)
    branches = branches_at(relaxation_times(scales), scales, MOST_OF_SENSOR)
    yield from (spectrum(Candidate, component, branches) for component in (LAYER, "film"))


def relaxable(model: Model) -> tuple[str, ...]:
    """Every layer, and every bond that is compliant: a perfect one has no jump that could relax.

    None beside a prestretched film, of which the reduced model has no memory.
    """
    return (*model.materials, *model.physics.bonds) if model.physics.prestretch == (0.0, 0.0) else ()


def _candidate(scene: Scene, component: str, declared: Prony) -> Candidate:
    """BRANCHES branches by their moduli over what never relaxes, and one shift of all their times.

    At fixed times the answer is linear in small moduli. The shift, half the spacing to either side, lets one branch
    alone have any time; several together take the form of any spectrum. At one end of it they stand where they do at
    the other, each in the place of its neighbour. What relaxes faster than all of them shows about as the fastest does.
    What rig.toml declares stays beside them.
    """
    times, reach = _branch_times(scene.scales)
    free = 1.0 - sum(declared.relative_moduli)
    moduli = tuple(Coordinate(f"modulus_{n + 1}", 0.0, MOST, (0.1, 0.5)) for n in range(BRANCHES))
    shift = Coordinate("log_time", -reach, reach, (-0.5 * reach, 0.5 * reach), levels_off=(True, True))

    def series(values: Sequence[float]) -> tuple[list[float], list[float]]:
        ratios = np.asarray(values[:BRANCHES])
        shares = free * ratios / (1.0 + ratios.sum())
        taus = [tau * exp(values[BRANCHES]) for tau in times]
        return [*declared.relative_moduli, *map(float, shares)], [*declared.relaxation_times, *taus]

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        moduli, taus = series(values)
        return {"relative_moduli": moduli, "relaxation_times_s": taus}

    def derived(values: Sequence[float]) -> dict[str, float]:
        return {"relaxed_fraction": relaxed_fraction(*series(values))}

    units = {"relative_moduli": "", "relaxation_times_s": "s", "relaxed_fraction": ""}
    return Candidate(VISCOELASTICITY.name, component, (*moduli, shift), parameters, derived, units)


def _branch_times(scales: TimeScales) -> tuple[list[float], float]:
    """Times of the branches, evenly in the logarithm, and half their spacing.

    Together they span what the runs show, and LATE_S: without a branch that slow, the relaxed fraction of a material
    that goes on relaxing after the last hold would be too low, and too sure.
    """
    low, high = log10(shortest_time_s(scales, FEWEST_SAMPLES)), log10(max(scales.lasting_s, LATE_S))
    spacing = max((high - low) / BRANCHES, 0.1)
    middle = 0.5 * (low + high)
    times = [10.0 ** (middle + spacing * (n - 0.5 * (BRANCHES - 1))) for n in range(BRANCHES)]
    return times, 0.5 * spacing * log(10.0)


def relaxed_fraction(relative_moduli: Sequence[float], relaxation_times_s: Sequence[float]) -> float:
    """1 - G(10 s) / G(0.1 s) of the relaxation modulus at small strain."""
    g, tau = np.array(relative_moduli), np.array(relaxation_times_s)
    early, late = (1.0 - float((g * -np.expm1(-t / tau)).sum()) for t in (EARLY_S, LATE_S))
    return 1.0 - late / early


def branches_at(times_s: Sequence[float], scales: TimeScales, most: float) -> dict[float, Coordinate]:
    """Time in s -> coordinate E_i / E_inf of a branch, up to most.

    What is slower than the longest run never comes to rest in it, so that nobody knows E_inf: near the end of its range
    more of it changes nothing.
    """
    found = {}
    for time in times_s:
        slow = time >= scales.lasting_s
        high = LARGEST_MODULUS_RATIO if slow else most
        found[time] = Coordinate(f"modulus_at_{time:.3g}_s", 0.0, high, (0.1, 0.5), levels_off=(False, slow))
    return found


def spectrum(
    make: type[Candidate], component: str, branches: Mapping[float, Coordinate], shares: tuple[Coordinate, ...] = ()
) -> Candidate:
    """The candidate at a component, one coordinate a branch by its time.

    make : its class. shares : the share of the branches that does not flow, where the rest does; none where nothing
    does. Branches that are off are no parameters, so that a number in the list of these is now one branch and now
    another: a branch is told by its time.
    """
    count, times_s = len(branches), tuple(branches)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        moduli, times = _branches(values[:count], times_s)
        series = {"relative_moduli": moduli, "relaxation_times_s": times}
        return {**series, **flowing(values)}

    def told(values: Sequence[float]) -> dict[str, Any]:
        series = zip(*_branches(values[:count], times_s), strict=True)
        return {**{f"relative_modulus_at_{float(f'{time:.3g}'):g}_s": g for g, time in series}, **flowing(values)}

    def flowing(values: Sequence[float]) -> dict[str, float]:
        return {"flowing_share": 1.0 - values[count]} if shares else {}

    def derived(values: Sequence[float]) -> dict[str, float]:
        return {"relaxed_fraction": relaxed_fraction(*_branches(values[:count], times_s))}

    units = {"relative_moduli": "", "relaxation_times_s": "s", "flowing_share": "", "relaxed_fraction": ""}
    coordinates = (*branches.values(), *shares)
    return make(VISCOELASTICITY.name, component, coordinates, parameters, derived, units, told=told)


def _branches(values: Sequence[float], times_s: Sequence[float]) -> tuple[list[float], list[float]]:
    """g_i and times of the branches that relax at all, of the values E_i / E_inf."""
    whole = 1.0 + sum(values)
    kept = [(value / whole, time) for value, time in zip(values, times_s, strict=True) if value > 0.0]
    return [g for g, _ in kept], [time for _, time in kept]


register(
    Vocabulary(
        VISCOELASTICITY,
        "{} relaxes (viscoelasticity)",
        of_segment=of_segment,
        of_coupon=of_coupon,
        of_unknown_geometry=of_unknown_geometry,
        kind=REMEMBERS,
    )
)
