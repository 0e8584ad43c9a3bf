"""The report: one HTML file that opens offline."""

import base64
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from export.film_maps import strain_unit
from export.page import page_environment, script_safe
from foundation.files import write_whole_text

HERE = Path(__file__).parent
CAPTIONS = {
    "undeformed": (
        "The segment at rest",
        "The front half is cut away through the dot to show every layer; the dot just touches.",
    ),
    "deformed": (
        "The segment pressed",
        "The same cut at the deepest step: how far each layer follows the dot, drawn to scale.",
    ),
    "von_mises": (
        "Stress in the soft layers",
        "Von Mises stress, one number for how hard the material is sheared; the film keeps its own colour "
        "because it is far stiffer.",
    ),
    "film": (
        "What the film feels",
        "Left: the largest principal strain of the film, averaged through its thickness; right: the charge that "
        "this strain frees on each square millimetre, white where it is none; thin lines join places of equal "
        "deflection. Colours end at the largest values away from held sides.",
    ),
    "force_voltage": (
        "Force and voltage while pressing",
        "Force on the dot and open-circuit voltage of the film (no charge is drawn).",
    ),
    "course": (
        "The press in time",
        "Depth, force, charge of each electrode and what is read, along the whole waveform; dots are the states that "
        "were solved.",
    ),
    "noise": (
        "Noise of the amplifier",
        "Spectrum of each part in the recorded voltage, through the circuit; the legend has the root mean squares.",
    ),
}
"""Title and one plain sentence for each picture, in the order in which the report shows them."""
SLICE_CAPTIONS = {
    "undeformed": (
        "The slice at rest",
        "A slice of the segment seen from the front; the ridge just touches.",
    ),
    "deformed": (
        "The slice pressed",
        "The same slice at the deepest step: how far each layer follows the ridge, drawn to scale.",
    ),
    "film": (
        "What the film feels",
        "Along the length, left: the largest principal strain of the film, averaged through its thickness; "
        "right: the charge that this strain frees on each square millimetre. The scales end at the largest values "
        "away from held sides.",
    ),
}
"""What differs for a plane-strain slice, where nothing varies across the width."""


def write_report(
    summary: Mapping[str, Any], pictures: Mapping[str, Path], view: Mapping[str, Any] | None, path: Path
) -> None:
    """Write one self-contained HTML page with headline numbers, pictures, tables and a 3D view.

    summary : the content of summary.json (plain numbers, lists and strings); what is missing is left out.
    pictures : name -> PNG; captions come from CAPTIONS. view : from viewer_data, None for no 3D view.
    The file appears whole or not at all.
    """
    environment = page_environment(HERE)
    environment.filters["number"] = number
    page = environment.get_template("report.html").render(
        s=summary,
        headline=headline(summary),
        steps=step_rows(summary),
        mesh_errors=_mesh_errors(summary),
        pictures=[_picture_entry(name, file, _captions(summary)) for name, file in _ordered_pictures(pictures)],
        view=script_safe(json.dumps(view)) if view else None,
        viewer="\n".join((HERE / name).read_text(encoding="utf-8") for name in ("webgl.js", "viewer.js")),
        config=json.dumps(summary.get("config", {}), indent=2, ensure_ascii=False),
    )
    write_whole_text(path, page)


def number(value: Any, digits: int = 4) -> str:
    """A number as text for people: significant digits, no exponent between 1e-4 and 1e6; other values as they are."""
    if value is None:
        return "\u2013"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, list | tuple):
        return ", ".join(number(item, digits) for item in value)
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\u202f")
    if not isinstance(value, float):
        return str(value)
    if value and not 1e-4 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    return _plain_text(value, digits)


def _plain_text(value: float, digits: int) -> str:
    """Significant digits without an exponent."""
    text = f"{float(f'{value:.{digits}g}'):.10f}".rstrip("0").rstrip(".")
    return text.replace("-", "\u2212") if text not in ("", "-0") else "0"


def headline(summary: Mapping[str, Any]) -> list[dict[str, str]]:
    """The numbers at the top: label, value, unit and one plain sentence each; missing ones are left out."""
    film, sensitivity = summary.get("film", {}), summary.get("sensitivity", {})
    noise = sensitivity.get("noise_V")
    away = film.get("rim_distance_mm")
    where = "mean through the film" + (f", at least {number(away)} mm from held sides" if away else "")
    of_force, of_voltage = (plus_minus(summary, name, ", ") for name in ("force_percent", "voltage_percent"))
    at_noise = f"for a noise of {number(1e3 * noise)} mV" if noise else "for the stated noise"
    at = f", at {number(sensitivity['at_time_s'])} s" if sensitivity.get("at_time_s") is not None else ""
    rows = [
        ("Depth reached", _last_value(summary, "indentation_mm"), "mm", "travel of the dot"),
        ("Reaction force", _last_value(summary, "reaction_force_N"), "N", "on the dot at that depth" + of_force),
        (
            "Open-circuit voltage",
            _last_value(summary, "open_circuit_voltage_V"),
            "V",
            "charge over capacitance" + of_voltage,
        ),
        ("Read-out voltage", _last_value(summary, "readout_voltage_V"), "V", "after the given amplifier"),
        *_peak_readout(summary),
        ("Charge", _last_value(summary, "film_charge_pC"), "pC", "freed by the film at short circuit"),
        ("Capacitance", film.get("capacitance_pF"), "pF", "of the film at rest"),
        ("Voltage per depth", sensitivity.get("voltage_per_mm"), "V/mm", "at the deepest step" + at),
        ("Charge per force", sensitivity.get("charge_pC_per_N"), "pC/N", "at the deepest step"),
        ("Least detectable press", sensitivity.get("least_detectable_indentation_um"), "µm", at_noise),
        ("Least detectable force", sensitivity.get("least_detectable_force_mN"), "mN", at_noise),
        ("Largest film strain", *_strain(film.get("max_principal_strain")), f"principal, {where}"),
        ("Largest film stress", film.get("max_principal_stress_MPa"), "MPa", f"principal, {where}"),
        *_rim_rows(film),
    ]
    return [
        {"label": label, "value": number(value), "unit": unit, "note": note}
        for label, value, unit, note in rows
        if value is not None
    ]


def _peak_readout(summary: Mapping[str, Any]) -> list[tuple[str, Any, str, str]]:
    """A row with the largest voltage behind an amplifier along the course, or none.

    With its sign, its time, and how far it may be off.
    """
    course = summary.get("course", {})
    peaks = [(max(curve, key=abs), curve, name) for name, curve in course.get("readout_V", {}).items()]
    if not peaks:
        return []
    value, curve, name = max(peaks, key=lambda peak: abs(peak[0]))
    when, error = course["time_s"][curve.index(value)], course["readout_error_percent"]
    note = f"'{name}' at {number(when)} s; may be off by {number(error, 2)} % between solved states"
    return [("Largest read-out", value, "V", note)]


def plus_minus(summary: Mapping[str, Any], name: str, before: str = " ") -> str:
    """Text ' ± 12 %' where an uncertainty is stated, '' for a given force.

    It has two digits, as more would claim too much.
    """
    stated = summary.get("uncertainty", {}).get(name)
    return "" if not stated else f"{before}±\u00a0{number(float(stated), 2)}\u00a0%"


def _mesh_errors(summary: Mapping[str, Any]) -> dict[str, float]:
    """Electrode -> error of its voltage in percent, where it is known."""
    each = summary.get("discretisation_error", {}).get("electrodes", [])
    return {one["name"]: one["voltage_percent"] for one in each}


def _rim_rows(film: Mapping[str, Any]) -> list[tuple[str, Any, str, str]]:
    """A row with the strain where held sides count too, where there are such sides."""
    if not film.get("rim_distance_mm"):
        return []
    about = "the mesh does not resolve the film there, so do not compare it with a material constant"
    return [("Film strain, held sides included", *_strain(film.get("rim_principal_strain")), about)]


def step_rows(summary: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    """Column heads, and one row for each load step."""
    columns = [
        ("indentation (mm)", "indentation_mm"),
        ("force (N)", "reaction_force_N"),
        ("charge (pC)", "film_charge_pC"),
        ("open-circuit voltage (V)", "open_circuit_voltage_V"),
        ("read-out voltage (V)", "readout_voltage_V"),
    ]
    present = [(head, summary[key]) for head, key in columns if summary.get(key) is not None]
    each = summary.get("electrodes", [])
    for one in each if len(each) > 1 else []:
        present += [
            (f"{one['name']}: charge (pC)", one["film_charge_pC"]),
            (f"{one['name']}: open-circuit voltage (V)", one["open_circuit_voltage_V"]),
        ]
        if one.get("readout_voltage_V") is not None:
            present.append((f"{one['name']}: read-out (V)", one["readout_voltage_V"]))
    rows = [[number(value) for value in row] for row in zip(*(values for _, values in present), strict=True)]
    return [head for head, _ in present], rows


def _last_value(summary: Mapping[str, Any], key: str) -> Any:
    """The value at the last step, None where there is no history."""
    history = summary.get(key)
    return history[-1] if history else None


def _strain(strain: float | None) -> tuple[float | None, str]:
    """Strain in the unit in which it is easily read, and that unit."""
    factor, unit = strain_unit(strain or 1.0)
    return None if strain is None else factor * strain, unit


def _ordered_pictures(pictures: Mapping[str, Path]) -> list[tuple[str, Path]]:
    """Name and path of the pictures, known ones first and in their order."""
    names = [name for name in CAPTIONS if name in pictures]
    return [(name, pictures[name]) for name in [*names, *(n for n in pictures if n not in CAPTIONS)]]


def _captions(summary: Mapping[str, Any]) -> dict[str, tuple[str, str]]:
    """Captions of the pictures of a solid or of a slice."""
    section = summary.get("config", {}).get("segment", {}).get("section")
    return CAPTIONS | (SLICE_CAPTIONS if section == "plane-strain" else {})


def _picture_entry(name: str, path: Path, captions: Mapping[str, tuple[str, str]]) -> dict[str, str]:
    title, text = captions.get(name, (name.replace("_", " "), ""))
    return {"title": title, "text": text, "data": base64.b64encode(path.read_bytes()).decode("ascii")}
