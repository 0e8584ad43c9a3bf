"""Errors of softdot material beside plain SciPy on public tests: python -m benchmarks.materials FOLDER.

FOLDER holds silicones-tensile and vhb-relaxation as they are published. SciPy fits the same samples, 0 to 50 % of
strain, by least squares without a bound on any constant: neo-Hookean, Mooney-Rivlin, Yeoh and Ogden of one and two
terms, each from several starts, with and without a slack of its own; a relaxation by two elastic terms whose Prony
branches are non-negative (quasi-linear viscoelasticity, Fung 1981). Errors are root mean squares over that of the
stress.
"""

import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares, nnls

from benchmarks.experts import remembered
from foundation.arrays import Floats
from softdot.material.characterise import Characterisation, MaterialRequest, characterise

VHB_SIZES = {"gauge_length_mm": 80.0, "width_mm": 10.0, "thickness_mm": 1.0}
Model = Callable[[Sequence[float], Floats], Floats]


def yeoh(p: Sequence[float], stretch: Floats) -> Floats:
    """Nominal stress of a strip."""
    x = stretch**2 + 2.0 / stretch - 3.0
    return 2.0 * (stretch - stretch**-2) * (p[0] + 2.0 * p[1] * x + 3.0 * p[2] * x**2)


def ogden(p: Sequence[float], stretch: Floats) -> Floats:
    """Nominal stress of a strip; mu and alpha of each term in turn."""
    return sum(
        (mu * (stretch ** (a - 1.0) - stretch ** (-0.5 * a - 1.0)) for mu, a in zip(p[::2], p[1::2], strict=True)),
        np.zeros(len(stretch)),
    )


def mooney(p: Sequence[float], stretch: Floats) -> Floats:
    """Nominal stress of a strip."""
    return 2.0 * (stretch - stretch**-2) * (p[0] + p[1] / stretch)


MODELS: list[tuple[Model, list[list[float]]]] = [
    (yeoh, [[0.1, 0.0, 0.0]]),
    (mooney, [[0.1, 0.1]]),
    (ogden, [[0.1, 2.0], [0.1, 5.0], [-0.1, -2.0]]),
    (ogden, [[0.1, 2.0, 0.1, -2.0], [0.1, 2.0, 0.01, 6.0], [0.1, 1.5, -0.1, -3.0], [0.1, 4.0, -0.1, 0.5]]),
]


def best_of_scipy(strain: Floats, stress: Floats, slack: bool) -> float:
    """The least relative error of all models and starts; slack : whether a strain before loading is fitted."""
    errors = []
    for model, starts in MODELS:
        for start in starts:

            def missed(p: Floats, model: Model = model) -> Floats:
                shift = abs(p[-1]) if slack else 0.0
                return model(p[:-1] if slack else p, 1.0 + np.maximum(strain - shift, 0.0)) - stress

            found = least_squares(missed, [*start, 0.01] if slack else start, x_scale="jac", max_nfev=1000)
            errors.append(np.sqrt(2.0 * found.cost / (stress @ stress)))
    return float(min(errors))


def quasi_linear(time_s: Floats, strain: Floats, stress: Floats) -> float:
    """The relative error of two elastic terms with Prony branches a decade apart."""
    stretch, taus = 1.0 + strain, 10.0 ** np.arange(-1.5, 4.0)
    elastic = stretch - stretch**-2, 1.0 - stretch**-3
    rows = np.column_stack([c for one in elastic for c in (one, *(remembered(time_s, one, tau) for tau in taus))])
    return float(nnls(rows, stress)[1] / np.linalg.norm(stress))


def of_silicone(file: Path) -> None:
    """Print a row of a tensile test."""
    started = time.process_time()
    found, kept = characterise(MaterialRequest((file,))), characterise(MaterialRequest((file,), slack=0.0))
    took_s = 0.5 * (time.process_time() - started)
    curve = found.curves[0]
    bare, free = (best_of_scipy(curve.strain, curve.stress_MPa, slack) for slack in (False, True))
    print(
        f"{file.stem:24} {found.ranked[0].fitted.law.name:12} ours {percent(found)}, SciPy {100 * bare:.2f} % and with "
        f"slack {100 * free:.2f} %; ours without slack {percent(kept)}; {took_s:.1f} s"
    )


def percent(found: Characterisation) -> str:
    """The error of a material."""
    return f"{100 * found.error:.2f} %"


def of_relaxation(file: Path) -> None:
    """Print a row of a relaxation."""
    started = time.process_time()
    found = characterise(MaterialRequest((file,), sizes=VHB_SIZES))
    took_s = time.process_time() - started
    course = found.courses[0]
    expert = quasi_linear(course.time_s, course.strain, course.stress_MPa)
    name = found.material.fitted.law.name
    print(f"{file.stem:24} {name:12} ours {percent(found)}, SciPy {100 * expert:.2f} %; {took_s:.1f} s")


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    for path in sorted((folder / "silicones-tensile").glob("*.csv")):
        of_silicone(path)
    of_relaxation(folder / "vhb-relaxation" / "single-step-relaxation__1d5.csv")
