"""The bill of materials."""

from dataclasses import dataclass

from export.build_sheet.contents import RESIN_G_CM3, Contents, spoken
from geometry.flat.pattern import FlatPattern
from geometry.layer_solids import layer_solids


@dataclass(frozen=True)
class Item:
    """what : to get; amount : how much of it; mass_g : None where it does not matter; used : for what, which file."""

    what: str
    amount: str
    mass_g: float | None
    used: str


@dataclass(frozen=True)
class Component:
    """A layer of the finished segment: sizes, volume and mass of one."""

    name: str
    material: str
    made: str
    size: str
    volume_mm3: float
    mass_mg: float


def bill(contents: Contents) -> list[Item]:
    """All that has to be there before the work begins."""
    return [*_cast(contents), *_flat(contents), *_printed(contents), *_small(contents)]


def components(contents: Contents) -> list[Component]:
    """The layers from the top down."""
    segment = contents.segment
    solids = layer_solids(segment, segment.film.thickness_um * 1e-3)
    cast = {pour.component: pour for pour in contents.solid.pours}
    found = []
    for layer in reversed(contents.layers):
        solid = solids[layer.name]
        size, volume = solid.bounding_box().size, float(solid.volume)
        thick = f"{1e3 * size.Z:.3g} µm" if layer.name == "film" else f"{size.Z:.4g} mm"
        made, density = "cut from sheet", contents.densities_g_cm3[layer.name]
        if layer.name in cast:
            pour = cast[layer.name]
            made, density = f"cast from {pour.recipe}", 1e3 * pour.poured_mass_g / pour.poured_volume_mm3
        made = "cut from film" if layer.name == "film" else made
        effector = segment.effector
        around = layer.name == "effector" and effector is not None and effector.shape in ("cylinder", "dome")
        wide = f"{size.X:.4g} mm across" if around else f"{size.X:.4g} × {size.Y:.4g} mm"
        size_text = f"{wide}, {thick}{' high' if around else ''}"
        found.append(Component(spoken(layer.name), layer.material, made, size_text, volume, density * volume))
    return found


def _cast(contents: Contents) -> list[Item]:
    """Both components of every mix; a material that is poured twice stands once."""
    masses: dict[tuple[str, str], float] = {}
    for pour in contents.solid.pours:
        for name, mass in pour.mixed_masses_g:
            masses[pour.recipe, name] = masses.get((pour.recipe, name), 0.0) + mass
    pours = {recipe: [p.component for p in contents.solid.pours if p.recipe == recipe] for recipe, _ in masses}
    return [
        Item(f"{recipe}, component {name}", "", mass, f"to cast {', '.join(map(spoken, pours[recipe]))}")
        for (recipe, name), mass in masses.items()
    ]


def _flat(contents: Contents) -> list[Item]:
    """Sheets with the size of the panel of each."""
    sheets: dict[tuple[str, float], list[FlatPattern]] = {}
    for pattern in contents.flat.patterns:
        sheets.setdefault((pattern.material, pattern.thickness_mm), []).append(pattern)
    found = []
    for (material, thickness), patterns in sheets.items():
        thick = f"{1e3 * thickness:.3g} µm" if thickness < 0.2 else f"{thickness:.4g} mm"
        used = ", ".join(pattern.name for pattern in patterns)
        found.append(Item(f"{material}, {thick}", _pieces(patterns), None, f"cut/: {used}"))
    return found


def _pieces(patterns: list[FlatPattern]) -> str:
    """How many of which size, in mm."""
    counts: dict[str, int] = {}
    for pattern in patterns:
        size = "{:.1f} × {:.1f} mm".format(*pattern.size_mm)
        counts[size] = counts.get(size, 0) + pattern.count
    return ", ".join(f"{count} of {size}" for size, count in counts.items())


def _printed(contents: Contents) -> list[Item]:
    volume = sum(part.copies * part.volume_mm3 for part in contents.solid.parts) / 1e3
    count = sum(part.copies for part in contents.solid.parts)
    kind = "SLA resin" if contents.fabrication.printer == "sla" else "filament"
    return [Item(kind, f"{volume:.1f} cm³", RESIN_G_CM3 * volume, f"{count} printed parts, supports not counted")]


def _small(contents: Contents) -> list[Item]:
    """Screws, pins, contacts and what the moulds need."""
    made, found = contents.fabrication, []
    if contents.part("frame-ring") is not None:
        frame = contents.frame
        grip = made.floor_mm + frame.ring[-1].top - frame.film_top + frame.film_bottom
        hole = made.screw_diameter_mm
        length = f"2, at least {grip + 2:.0f} mm long"
        found.append(Item(f"screws for {hole:g} mm holes, each with a nut", length, None, "close the frame"))
    found += [
        Item(f"dowel pins of {made.pin_diameter_mm:g} mm", "2", None, "registration holes of film, masks and rings"),
        Item("crimp contacts, or copper tape with conductive glue", f"{len(contents.flat.metals)}", None, "pads"),
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
        gap = f"gap of {made.glue_gap_mm:g} mm"
        found.append(Item("flexible adhesive, thin", gap, None, "sides of the held layers"))
    found.append(Item("etch resist and etchant, or silver ink", "", None, "electrodes"))
    found.append(Item("laser cutter or knife plotter; isopropanol, lint-free cloth, tweezers", "", None, "cutting"))
    found.append(Item("shielded cable, voltmeter or amplifier with more than 1 GΩ", "1", None, "read-out"))
    found.append(Item("calliper or thickness gauge to 0.01 mm, capacitance meter to 1 pF", "", None, "checks"))
    return found
