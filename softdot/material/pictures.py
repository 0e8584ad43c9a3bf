"""Pictures of a material: its curve and what it is beyond the data, what is missed, and whole courses over time."""

from pathlib import Path
from typing import Any

import numpy as np

from diagnose.pictures.style import AFTER, BEFORE, CLOSEST, RECORDED, SOFT, new_figure, save
from softdot.material.characterise import BEST_LAWS, Characterisation
from softdot.material.stable_laws import Deformation

LAW_COLOURS = AFTER, CLOSEST, BEFORE
SHOWN_BEYOND = 1.6  # of the range
POINTS = 200


def draw_material(found: Characterisation, folder: Path) -> dict[str, Path]:
    """Write the pictures, by name: curve, and courses where anything relaxes or softens."""
    drawn = {"curve": save(_curve_figure(found), folder / "curve.png")}
    if found.has_memory:
        drawn["courses"] = save(_course_figure(found), folder / "courses.png")
    return drawn


def _curve_figure(found: Characterisation) -> Any:
    """Stress over strain of each test with the best laws, and below it what they miss."""
    count = len(found.curves)
    figure, panels = new_figure(2, count, 5.6, sharex="col", gridspec_kw={"height_ratios": [2.2, 1.0]})
    for number, (curve, course) in enumerate(zip(found.curves, found.courses, strict=True)):
        above, below = panels[:, number]
        end = 100 * SHOWN_BEYOND * curve.strain.max()
        above.plot(100 * course.strain, 1e3 * course.stress_MPa, ".", color=SOFT, ms=3, label="not fitted", zorder=1)
        above.plot(100 * curve.strain, 1e3 * curve.stress_MPa, "o", color=RECORDED, ms=3.5, label="fitted", zorder=3)
        highest = 1e3 * float(curve.stress_MPa.max())
        for one, colour in zip(found.ranked[:BEST_LAWS], LAW_COLOURS, strict=False):
            slack = one.fitted.slack[number]
            _draw_law(above, one.fitted, curve.kind, slack, float(curve.strain.max()), colour)
            missed = one.fitted.stress_MPa(curve.deformation(slack)) - curve.stress_MPa
            below.plot(100 * curve.strain, 1e3 * missed, "-o", color=colour, ms=2.5, lw=1)
        for axes in (above, below):
            axes.axvspan(100 * curve.strain.max(), end, color=SOFT, alpha=0.15, lw=0)
        above.annotate("beyond this strain\nit is an extrapolation", (100 * curve.strain.max(), 0.03 * highest),
                       xytext=(4, 0), textcoords="offset points", fontsize=8, color=RECORDED)  # fmt: skip
        below.axhline(0.0, color=SOFT, lw=0.8)
        above.set_xlim(0.0, end)
        above.set_ylim(0.0, SHOWN_BEYOND * 1.1 * highest)
        above.set_title(f"{course.test.file.name}, {course.test.kind}", fontsize=9)
        below.set_xlabel("nominal strain (%)" if curve.kind != "shear" else "amount of shear (%)", fontsize=9)
    panels[0, 0].set_ylabel("nominal stress (kPa)", fontsize=9)
    panels[1, 0].set_ylabel("law less data (kPa)", fontsize=9)
    panels[0, 0].legend(frameon=False, fontsize=8, loc="upper left")
    return figure


def _draw_law(axes: Any, fitted: Any, kind: str, slack: float, reached: float, colour: str) -> None:
    """One law within the range, and dashed beyond it."""
    for low, high, line in ((0.0, reached, "-"), (reached, SHOWN_BEYOND * reached, "--")):
        strain = np.linspace(low, min(high, 0.95) if kind == "compression" else high, POINTS)
        stress = fitted.stress_MPa(Deformation.of(kind, np.maximum(strain - slack, 0.0)))
        label = fitted.law.name if line == "-" else None
        axes.plot(100 * strain, 1e3 * stress, line, color=colour, lw=1.4, label=label, zorder=2)


def _course_figure(found: Characterisation) -> Any:
    """Stress over strain and over time of each test, with the material that relaxes and softens."""
    count = len(found.courses)
    figure, panels = new_figure(count, 2, 0.6 + 2.6 * count)
    for course, slack, (left, right) in zip(found.courses, found.material.fitted.slack, panels, strict=True):
        stress = 1e3 * found.material.stress_MPa(course, slack)
        for axes, across in ((left, 100 * course.strain), (right, course.time_s)):
            axes.plot(across, 1e3 * course.stress_MPa, ".", color=RECORDED, ms=3, label="data")
            axes.plot(across, stress, "-", color=AFTER, lw=1.2, label="material")
        left.set_xlabel("strain (%)", fontsize=9)
        left.set_ylabel("nominal stress (kPa)", fontsize=9)
        left.set_title(course.test.file.name, fontsize=9, loc="left")
        right.set_xlabel("time (s)" if course.has_time else "sample", fontsize=9)
        if course.holds_s:
            right.set_xscale("symlog", linthresh=max(float(course.time_s[1]), 1e-3))
    panels[0, 0].legend(frameon=False, fontsize=8)
    return figure
