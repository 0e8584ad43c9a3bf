"""What softdot material writes: material.toml to include, material.html to read, material.json for programs."""

import base64
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit

from export.page import page_environment
from foundation.arrays import Floats
from softdot.json_files import plain, write_json
from softdot.material.characterise import Characterisation, MaterialRequest, characterise, cycle_peaks
from softdot.material.elastic_fit import FittedLaw
from softdot.material.memory_fit import FittedMaterial
from softdot.material.pictures import draw_material
from softdot.material.stable_laws import Deformation
from softdot.output import Product, staged_folder
from softdot.progress import Logged, Progress
from softdot.version import installed_version
from solve.materials.prony import Prony
from solve.mechanisms.layers.stress_softening import STRESS_SOFTENING
from solve.mechanisms.layers.viscoelasticity import VISCOELASTICITY

PRODUCT = Product("softdot-material/1", "material.json", frozenset(
    {"material.json", "material.toml", "material.html", "pictures"}
))  # fmt: skip
STUDENT_90 = 1.895  # of seven degrees of freedom: eight blocks
STATED_STRAINS = (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0)
DIGITS = 5


def make_material(
    request: MaterialRequest, name: str, layers: tuple[str, ...], out: Path, progress: Progress | None = None
) -> dict[str, Any]:
    """Fit a material and write it into the folder out; the content of material.json. InputError.

    layers : media of whose [[mechanisms]] the file states relaxation and softening; none leaves that as a comment.
    """
    shown = progress or Logged()
    with staged_folder(out, PRODUCT) as folder:
        shown.stage("material")
        found = characterise(request)
        shown.stage("page")
        pictures = draw_material(found, folder / "pictures")
        summary: dict[str, Any] = plain(_content(found, name))
        (folder / "material.toml").write_text(material_text(found, name, layers), "utf-8")
        _write_page(found, summary, pictures, folder / "material.html")
        write_json(folder / PRODUCT.summary, summary)
    return summary


def material_text(found: Characterisation, name: str, layers: tuple[str, ...]) -> str:
    """The text of material.toml."""
    tests = ", ".join(f"{course.test.file.name} ({course.test.kind})" for course in found.courses)
    entry = {
        **_rounded(found.material.table),
        "max_fitted_strain": _rounded(found.reached),
        "source": f"softdot material: {tests}",
        "confidence": "medium",
    }
    head = (
        f'# Include it in a configuration:  include = ["material.toml"]  and  segment.medium2.material = "{name}"\n'
        f"# It misses {100 * found.error:.2g} % of the stress up to {100 * found.reached:.3g} % of strain; beyond, it "
        "is an extrapolation.\n\n"
    )
    text = head + tomlkit.dumps({"materials": {name: entry}})
    mechanisms = memory_mechanisms(found.material)
    if not mechanisms:
        return text
    if layers:
        tables = [{**one, "component": layer} for layer in layers for one in mechanisms]
        return f"{text}\n{tomlkit.dumps({'mechanisms': tables})}"
    more = tomlkit.dumps({"mechanisms": [{**one, "component": "medium2"} for one in mechanisms]})
    comment = "\n".join(f"# {line}".rstrip() for line in more.strip().splitlines())
    return (
        f"{text}\n# The constants above are those of the first instant and of the first loading. Without these\n"
        f"# mechanisms, one for each layer of {name}, it stays as stiff as that.\n{comment}\n"
    )


def memory_mechanisms(material: FittedMaterial) -> list[dict[str, Any]]:
    """Relaxation and softening as [[mechanisms]], without a component."""
    found: list[dict[str, Any]] = []
    if (series := material.series) is not None:
        values = {"relative_moduli": series.relative_moduli, "relaxation_times_s": series.relaxation_times}
        found.append({"name": VISCOELASTICITY.name, "parameters": _rounded(values)})
    if (softening := material.softening) is not None:
        constants = {"loss_ratio": softening.loss, "beta": softening.beta}
        found.append({"name": STRESS_SOFTENING.name, "parameters": _rounded(constants)})
    return found


def _content(found: Characterisation, name: str) -> dict[str, Any]:
    chosen, request = found.ranked[0], found.request
    strains = np.array([one for one in STATED_STRAINS if one <= 1.001 * found.reached])
    kind = found.courses[0].test.kind

    def values(fitted: FittedLaw) -> Floats:
        return np.array([_shear_modulus_MPa(fitted), *fitted.stress_MPa(Deformation.of(kind, strains))])

    names = ["shear modulus", *(f"stress in {kind} at {100 * one:g} %" for one in strains)]
    deviations = chosen.deviation(values)
    return {
        "format": PRODUCT.format,
        "softdot_version": installed_version(),
        "name": name,
        "law": chosen.fitted.law.name,
        "material": found.material.table,
        "mechanisms": memory_mechanisms(found.material),
        "range_of_strain": request.strain_range,
        "reached_strain": found.reached,
        "error": found.error,
        "laws": [
            {"name": one.fitted.law.name, "error": one.error, "held_out_error": one.held_out,
             "material": FittedMaterial(one.fitted, request.poisson_ratio).table,
             "slack": one.fitted.slack} for one in found.ranked
        ],
        "relaxation": relaxation_rows(found),
        "values": [
            {"what": what, "value_MPa": value, "deviation_MPa": deviation, "low_MPa": value - STUDENT_90 * deviation,
             "high_MPa": value + STUDENT_90 * deviation}
            for what, value, deviation in zip(names, values(chosen.fitted), deviations, strict=True)
        ],
        "other_kinds": {one: {"strain": strain, "stress_MPa": stress} for one, (strain, stress)
                        in found.other_kinds.items()},
        "tests": [
            {"file": course.test.file.name, "kind": course.test.kind, "sizes": dict(course.test.sizes),
             "largest_strain": float(course.strain.max()), "slack": slack,
             "cycles": course.cycles, "holds_s": course.holds_s}
            for course, slack in zip(found.courses, chosen.fitted.slack, strict=True)
        ],
        "cycle_peaks_MPa": dict(cycle_peaks(found.courses)),
        "warnings": found.warnings,
    }  # fmt: skip


def _shear_modulus_MPa(fitted: FittedLaw) -> float:
    """Shear modulus at a strain of a millionth."""
    return 1e6 * float(fitted.stress_MPa(Deformation.of("shear", np.array([1e-6])))[0])


def _rounded(value: Any) -> Any:
    """Numbers with a few digits, inside lists and tables too."""
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}")
    if isinstance(value, tuple | list):
        return [_rounded(one) for one in value]
    return {key: _rounded(one) for key, one in value.items()} if isinstance(value, dict) else value


def relaxed_share(series: Prony | None, time_s: float) -> float:
    """Share of the instantaneous stress that is gone a time after a step."""
    if series is None:
        return 0.0
    pairs = zip(series.relative_moduli, series.relaxation_times, strict=True)
    return float(sum(g * -np.expm1(-time_s / tau) for g, tau in pairs))


def relaxation_rows(found: Characterisation) -> list[dict[str, float]]:
    """Share of the stress that is gone after each decade of the longest hold, with a 90 % interval by the jackknife."""
    series = found.material.series
    longest = max((max(course.holds_s) for course in found.courses if course.holds_s), default=0.0)
    times = [10.0**n for n in range(-1, 6) if 10.0**n <= longest] if series is not None else []
    rows = []
    for time in times:
        share, others = relaxed_share(series, time), [relaxed_share(one.series, time) for one in found.material.without]
        count = len(others)
        off = STUDENT_90 * float(np.sqrt((count - 1) * np.var(others)))
        rows.append({"time_s": time, "share": share, "low": max(share - off, 0.0), "high": min(share + off, 1.0)})
    return rows


def _write_page(found: Characterisation, summary: dict[str, Any], pictures: dict[str, Path], path: Path) -> None:
    images = {name: base64.b64encode(file.read_bytes()).decode() for name, file in pictures.items()}
    page = page_environment(Path(__file__).parent).get_template("material.html").render(
        v=summary, images=images, toml=material_text(found, summary["name"], ()),
        best=[one.fitted.law.name for one in found.ranked[:3]],
    )  # fmt: skip
    path.write_text(page, "utf-8")
