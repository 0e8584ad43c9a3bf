"""Bill of materials of a kit: what to buy and what it is for."""

from dataclasses import dataclass

from export.build_sheet.contents import RESIN_G_CM3, Contents, layer_title
from export.build_sheet.electrical import amplifier_text, meter_step_pF
from geometry.flat.pattern import FlatPattern


@dataclass(frozen=True)
class Item:
    """One row of the bill of materials.

    what : to get; amount : how much of it; mass_g : None where it does not matter; used : for what, which file.
    """

    what: str
    amount: str
    mass_g: float | None
    used: str


def bill_of_materials(contents: Contents) -> list[Item]:
    """All that has to be there before the work begins."""
    return [*_casting_items(contents), *_sheet_items(contents), *_printing_items(contents), *_small_items(contents)]


def _casting_items(contents: Contents) -> list[Item]:
    """Components of every mix; a material that is poured twice stands once."""
    masses: dict[tuple[str, str], float] = {}
    for pour in contents.solid.pours:
        for name, mass in pour.mixed_masses_g:
            masses[pour.recipe, name] = masses.get((pour.recipe, name), 0.0) + mass
    pours = {recipe: [p.component for p in contents.solid.pours if p.recipe == recipe] for recipe, _ in masses}
    return [
        Item(f"{recipe}, component {name}", "", mass, f"to cast {', '.join(map(layer_title, pours[recipe]))}")
        for (recipe, name), mass in masses.items()
    ]


def _sheet_items(contents: Contents) -> list[Item]:
    """Sheets to cut, with the sizes that are needed of each."""
    sheets: dict[tuple[str, float], list[FlatPattern]] = {}
    for pattern in contents.flat.patterns:
        sheets.setdefault((pattern.material, pattern.thickness_mm), []).append(pattern)
    found = []
    for (material, thickness), patterns in sheets.items():
        thick = f"{1e3 * thickness:.3g} µm" if thickness < 0.2 else f"{thickness:.4g} mm"
        used = ", ".join(pattern.name for pattern in patterns)
        found.append(Item(f"{material}, {thick}", _pieces_text(patterns), None, f"cut/: {used}"))
    return found


def _pieces_text(patterns: list[FlatPattern]) -> str:
    """Number of pieces of each size, in mm, in words."""
    counts: dict[str, int] = {}
    for pattern in patterns:
        size = "{:.1f} × {:.1f} mm".format(*pattern.size_mm)
        counts[size] = counts.get(size, 0) + pattern.count
    return ", ".join(f"{count} of {size}" for size, count in counts.items())


def _printing_items(contents: Contents) -> list[Item]:
    volume = sum(part.copies * part.volume_mm3 for part in contents.solid.parts) / 1e3
    count = sum(part.copies for part in contents.solid.parts)
    kind = "SLA resin" if contents.fabrication.printer == "sla" else "filament"
    return [Item(kind, f"{volume:.1f} cm³", RESIN_G_CM3 * volume, f"{count} printed parts, supports not counted")]


def _small_items(contents: Contents) -> list[Item]:
    """Screws, pins, contacts, tools and what the moulds need."""
    made, found = contents.fabrication, []
    if contents.part("frame-ring") is not None:
        frame = contents.frame
        grip = made.floor_mm + frame.ring[-1].top - frame.film_top + frame.film_bottom
        hole = made.screw_diameter_mm
        length = f"2, at least {grip + 2:.0f} mm long"
        found.append(Item(f"screws for {hole:g} mm holes, each with a nut", length, None, "close the frame"))
    found += [
        Item(f"dowel pins of {made.pin_diameter_mm:g} mm", "2", None, "registration holes of film, masks and rings"),
        _contact_item(contents),
        Item("cable tie, at most 1.5 × 3 mm", "1", None, "holds the tab on the shelf"),
    ]
    if contents.solid.pours:
        found += [
            Item("acetate film or glass slide", f"{len(contents.solid.pours)}", None, "smooth face under each lid"),
            Item("sealer and release agent", "", None, "see the pours"),
            Item("nitrile gloves, cups, stirrers, needle, scale to 0.01 g, vacuum chamber", "", None, "mixing"),
            Item("weight of 200 g", "1", None, "on the lid"),
        ]
    if contents.segment.boundary != "free":
        gap = f"gap of {contents.rim_gap_mm:.2g} mm"
        found.append(Item(contents.side_glue, gap, None, "sides of the held layers"))
    found.append(Item("etch resist and etchant, or silver ink", "", None, "electrodes"))
    found.append(Item("laser cutter or knife plotter; isopropanol, lint-free cloth, tweezers", "", None, "cutting"))
    channels = f"{len(contents.flat.metals) - 1}"
    found.append(Item(amplifier_text(contents.readout), channels, None, "read-out"))
    found.append(Item("low-noise coaxial or triaxial cable, short", channels, None, "read-out"))
    meter = f"capacitance meter to {meter_step_pF(contents):.1g} pF at 1 kHz, three-terminal (guarded)"
    found.append(Item(f"calliper or thickness gauge to 0.01 mm, {meter}", "", None, "checks"))
    return found


FINEST_CRIMP_PITCH_MM = 2.0


def _contact_item(contents: Contents) -> Item:
    """Contacts of the pads; as the common electrode lies on the other face, a connector needs them on both."""
    count, pitch = len(contents.flat.metals), contents.fabrication.pad_pitch_mm
    if pitch >= FINEST_CRIMP_PITCH_MM:
        return Item("crimp contacts, or copper tape with conductive glue", f"{count}", None, "pads")
    what = f"ZIF connector, {pitch:g} mm pitch, contacts on both faces, and a stiffener for the head"
    return Item(what, f"1 of {count} contacts", None, "pads")
