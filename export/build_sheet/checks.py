"""What to measure on the way, and what to expect."""

from dataclasses import dataclass

from export.build_sheet.contents import Contents, spoken
from geometry.flat.electrodes import stray_area_mm2

VACUUM_PF_PER_MM = 8.8541878128e-3
SHEET_OHM = {"NiAl": 3.0, "silver ink": 0.1}
"""Ohm per square, the most: MSI Piezo Film Sensors Technical Manual, p. 3."""


@dataclass(frozen=True)
class Check:
    """what : to measure; expect : the number; otherwise : what a wrong number tells."""

    what: str
    expect: str
    otherwise: str


def checks(contents: Contents) -> list[Check]:
    """In the order of the work."""
    return [
        *_printed(contents),
        *_thicknesses(contents),
        *_electrical(contents),
        *_stack(contents),
        *_press(contents),
    ]


def capacitance_pF(contents: Contents) -> list[tuple[str, float]]:
    """Of every top electrode against the common one: relative permittivity times area over thickness."""
    per_mm2 = VACUUM_PF_PER_MM * contents.permittivity / (1e-3 * contents.segment.film.thickness_um)
    tops = [metal for metal in contents.flat.metals if metal.face == "top"]
    return [(metal.name, per_mm2 * (metal.rect[1] - metal.rect[0]) * (metal.rect[3] - metal.rect[2])) for metal in tops]


def _printed(contents: Contents) -> list[Check]:
    """Sizes of printed parts on which others depend."""
    along, across = contents.segment.length_mm, contents.segment.width_mm
    found = []
    for pour in contents.solid.pours:
        layer = next(one for one in contents.layers if one.name == pour.component)
        depth = layer.thickness_mm / (1.0 - pour.shrinkage_percent / 100)
        again = "sand the land, or print again with another height"
        found.append(Check(f"depth of each cavity of the mould of {spoken(pour.component)}", f"{depth:.3f} mm", again))
    frame = contents.frame
    for label, run in (("frame-body", frame.body), ("frame-ring", frame.ring[-1] if frame.ring else None)):
        if run is not None:
            size = f"{along + 2 * run.gap:.4g} × {across + 2 * run.gap:.4g} mm"
            found.append(Check(f"opening of {label}, x × y at its top", size, "file it: a tight layer bulges"))
    return found


def _thicknesses(contents: Contents) -> list[Check]:
    rows = {row["label"]: row for row in contents.budget["rows"]} if contents.budget else {}
    found = []
    for layer in reversed(contents.layers):
        if layer.name != "film":
            row = rows.get(f"thickness of {_in_budget(layer.name)}")
            within = f" ± {row['plus_minus']:.2g}" if row else ""
            found.append(
                Check(
                    f"thickness of {spoken(layer.name)}, at its four corners", f"{layer.thickness_mm:.3g}{within} mm",
                    "write the measured value into the configuration and run it again",
                )
            )  # fmt: skip
    return found


def _in_budget(name: str) -> str:
    return spoken(name) if name != "effector" else "the effector"


def _electrical(contents: Contents) -> list[Check]:
    stray = stray_area_mm2(contents.flat.metals)
    area = sum((m.rect[1] - m.rect[0]) * (m.rect[3] - m.rect[2]) for m in contents.flat.metals if m.face == "top")
    more = f", and {100 * stray / area:.2g} % more where leads cross the common electrode" if stray > 0.0 else ""
    found = [
        Check(
            f"capacitance of electrode '{name}' against the common one, 1 kHz, cable subtracted",
            f"{expected:.3g} pF{more}",
            "too high: metal left beside the electrode; too low: a broken lead or thicker film",
        )
        for name, expected in capacitance_pF(contents)
    ]
    squares = max(metal.squares for metal in contents.flat.metals)
    most = ", ".join(f"{squares * ohm:.2g} Ω for {metal}" for metal, ohm in SHEET_OHM.items())
    found += [
        Check(f"resistance from pad to electrode, {squares:.0f} squares", f"at most {most}", "a scratched lead"),
        Check("resistance between the pads", "no reading (above 100 MΩ)", "metal around the cut edge: trim it"),
    ]
    return found


def _stack(contents: Contents) -> list[Check]:
    segment_top, floor = contents.layers[-1].top_mm, contents.fabrication.floor_mm
    lines = contents.fabrication.adhesive_thickness_mm * (3 if contents.segment.effector is None else 4)
    return [
        Check(
            "height of the finished segment over the underside of its frame",
            f"{segment_top + floor:.3g} mm, and up to {lines:.2g} mm more for the adhesive",
            "dirt or a bubble between two layers",
        )
    ]


def _press(contents: Contents) -> list[Check]:
    budget = contents.budget
    if budget is None:
        return []
    total = budget["root_sum_square"]
    return [
        Check(
            f"first press: {contents.press}",
            f"{budget['nominal']['force_N']:.2g} ± {total['force_N']:.2g} N and {budget['nominal']['voltage_V']:.2g} ± "
            f"{total['voltage_V']:.2g} V",
            "see the tolerance budget for what shifts it most; a voltage of the other sign: the film lies upside down",
        )
    ]
