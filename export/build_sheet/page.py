"""kit.html: one self-contained page for A4, with what to measure on the way and what to expect."""

import base64
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from export.build_sheet.bill import bill_of_materials
from export.build_sheet.contents import RESIN_G_CM3, Contents, components, gauging, layer_in_sentence, layer_title
from export.build_sheet.electrical import capacitance_pF, capacitance_pF_per_mm2, metal_area_mm2, rim_text
from export.build_sheet.steps import steps
from export.cut_files.style import STYLES
from export.page import page_environment
from export.report import number
from foundation.files import write_whole_text
from geometry.fabrication.part import printer_profile
from geometry.flat.electrodes import stray_area_mm2, stray_areas_mm2

SHEET_RESISTANCE_OHM = {"NiAl": 3.0, "silver ink": 0.1}
"""Largest resistance in ohm per square: MSI Piezo Film Sensors Technical Manual, p. 3."""


@dataclass(frozen=True)
class Check:
    """One measurement on the way. what : to measure; expect : the number; otherwise : what a wrong number tells."""

    what: str
    expect: str
    otherwise: str


def checks(contents: Contents) -> list[Check]:
    """All checks in the order of the work."""
    return [
        *_printed_part_checks(contents),
        *_thickness_checks(contents),
        *_electrical_checks(contents),
        *_height_checks(contents),
        *_press_checks(contents),
    ]


@dataclass(frozen=True)
class RoutedTrace:
    """The trace from an electrode to its pad. face : "top" or "bottom".

    length_mm, squares : of the lead without its pad; resistance_ohm : by metal, at most.
    parasitic_area_mm2, parasitic_capacitance_pF : where it lies over metal of the other face.
    """

    pad: int
    electrode: str
    face: str
    length_mm: float
    squares: float
    resistance_ohm: dict[str, float]
    parasitic_area_mm2: float
    parasitic_capacitance_pF: float


def traces(contents: Contents) -> list[RoutedTrace]:
    """The traces of all electrodes, in the order of the pads."""
    stray, per_mm2 = stray_areas_mm2(contents.flat.metals), capacitance_pF_per_mm2(contents)
    found = [
        RoutedTrace(
            pad=metal.pad,
            electrode=metal.name,
            face=metal.face,
            length_mm=metal.length,
            squares=metal.squares,
            resistance_ohm={name: metal.squares * ohm for name, ohm in SHEET_RESISTANCE_OHM.items()},
            parasitic_area_mm2=stray.get(metal.name, 0.0),
            parasitic_capacitance_pF=per_mm2 * stray.get(metal.name, 0.0),
        )
        for metal in contents.flat.metals
    ]
    return sorted(found, key=lambda trace: trace.pad)


def _printed_part_checks(contents: Contents) -> list[Check]:
    """Checks of sizes of printed parts on which others depend."""
    found = []
    off = f" ± {printer_profile(contents.fabrication.printer)['deviation_mm']:g}"
    for pour in contents.solid.pours:
        gauge = gauging(contents, pour.component)
        depth = gauge.size_mm / (1.0 - pour.shrinkage_percent / 100)
        again = "print the mould again, its cavity deeper or shallower by the difference"
        where = ", at its deepest point" if gauge.shape == "dome" else ""
        what = f"depth of each cavity in the mould of {layer_in_sentence(pour.component)}{where}"
        found.append(Check(what, f"{depth:.3f}{off} mm", again))
    rim = rim_text(contents)
    if rim is not None:
        found.append(Check("side stiffness of the rim", rim, "state the shear modulus of your glue, build again"))
    frame = contents.frame
    for label, run in (("frame-body", frame.body), ("frame-ring", frame.ring[-1] if frame.ring else None)):
        if run is not None:
            one, which = contents.device.stack, "opening"
            if len(run.feet) > 1:
                one, which = contents.segment, f"each of the {len(run.feet)} openings"
            size = f"{one.length_mm + 2 * run.gap:.4g} × {one.width_mm + 2 * run.gap:.4g}, each{off} mm"
            tight = "file it wider: a layer that is too tight bulges"
            found.append(Check(f"{which} of {label} at its top, x × y", size, tight))
    return found


def _thickness_checks(contents: Contents) -> list[Check]:
    rows = {row["label"]: row for row in contents.budget["rows"]} if contents.budget else {}
    found, again = [], "write the measured value into the configuration and run it again"
    for layer in reversed(contents.layers):
        if layer.name == "film":
            continue
        name, gauge = layer_in_sentence(layer.name), gauging(contents, layer.name)
        row = rows.get(f"thickness of {name}")
        within = f" ± {row['plus_minus']:.2g}" if row else ""
        expect = f"{gauge.size_mm:.4g}{within} mm"
        found.append(Check(f"{gauge.quantity} of {name}, {gauge.where}", expect, again))
        if gauge.foot is not None:
            found.append(Check(f"{name}: {gauge.foot[0]}", gauge.foot[1], again))
    return found


def _electrical_checks(contents: Contents) -> list[Check]:
    stray = stray_area_mm2(contents.flat.metals)
    area = sum(metal_area_mm2(metal) for metal in contents.flat.metals if metal.face == "top")
    more = f", and {100 * stray / area:.2g} % more where leads cross the common electrode" if stray > 1e-9 else ""
    against = "against the common one, 1 kHz, cable subtracted"
    otherwise = "too high: metal is left beside the electrode; too low: a lead is broken or the film is thicker"
    expected = capacitance_pF(contents)
    if contents.device.is_array:
        what = [(f"capacitance of each of the {len(expected)} electrodes {against}", expected[0][1])]
    else:
        what = [(f"capacitance of electrode '{name}' {against}", value) for name, value in expected]
    rows = {row["label"]: row for row in contents.budget["rows"]} if contents.budget else {}
    thickness = rows.get("thickness of the film")
    off = (
        "" if thickness is None else f" ± {100 * thickness['plus_minus'] / thickness['nominal']:.2g} % by its thickness"
    )
    found = [Check(words, f"{value:.3g} pF{off}{more}", otherwise) for words, value in what]
    squares = max(metal.squares for metal in contents.flat.metals)
    most = ", ".join(f"{number(squares * ohm, 2)} Ω for {metal}" for metal, ohm in SHEET_RESISTANCE_OHM.items())
    found += [
        Check(f"resistance from pad to electrode, {squares:.0f} squares", f"at most {most}", "a lead is scratched"),
        Check("resistance between the pads", "no reading (above 100 MΩ)", "metal bridges the cut edge: trim it"),
    ]
    return found


def _height_checks(contents: Contents) -> list[Check]:
    segment_top, floor = contents.layers[-1].top_mm, contents.fabrication.floor_mm
    carrier = "base" if contents.part("base") is not None else "frame"
    effector = contents.segment.effector
    where = ", at the crown of the dome" if effector is not None and effector.shape == "dome" else ""
    lines = contents.fabrication.adhesive_thickness_mm * (3 if contents.segment.effector is None else 4)
    return [
        Check(
            f"height of the finished {contents.what} above the underside of its {carrier}{where}",
            f"{segment_top + floor:.4g} mm, and up to {lines:.2g} mm more for the adhesive",
            "there is dirt or a bubble between two layers",
        )
    ]


def _press_checks(contents: Contents) -> list[Check]:
    budget = contents.budget
    if contents.device.is_array:
        return [
            Check(
                "first press: each segment in turn, with all pads read",
                "the largest voltage at its own pad; softdot array computes all of them",
                "another pad answers most: two leads are exchanged; two answer alike: metal bridges them",
            )
        ]
    if budget is None:
        return []
    total = budget["root_sum_square"]
    return [
        Check(
            f"first press: {contents.press}",
            f"{budget['nominal']['force_N']:.2g} ± {total['force_N']:.2g} N and {budget['nominal']['voltage_V']:.2g} ± "
            f"{total['voltage_V']:.2g} V",
            "the tolerance budget tells what shifts it most; a voltage of the other sign: the film is upside down",
        )
    ]


HERE = Path(__file__).parent


def write_page(contents: Contents, heading: Mapping[str, Any], pictures: Path, path: Path) -> None:
    """Write the page. heading : what names this kit; pictures : folder of the PNG files, which go into the page.

    The file appears whole or not at all.
    """
    environment = page_environment(HERE)
    environment.filters["number"] = number
    environment.filters["layer_title"] = layer_title
    page = environment.get_template("page.html").render(
        c=contents,
        heading=heading,
        bill=bill_of_materials(contents),
        components=components(contents),
        checks=checks(contents),
        steps=steps(contents),
        traces=traces(contents),
        layers=STYLES,
        resin=RESIN_G_CM3,
        picture=_Pictures(pictures),
        total_height=contents.layers[-1].top_mm,
    )
    write_whole_text(path, page)


class _Pictures:
    """Pictures of a folder as data URIs, by their names."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __call__(self, name: str) -> str:
        content = (self.folder / f"{name}.png").read_bytes()
        return f"data:image/png;base64,{base64.b64encode(content).decode('ascii')}"
