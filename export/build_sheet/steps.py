"""The work step by step, in the order in which it is done."""

from dataclasses import dataclass

from export.build_sheet.contents import Contents, spoken
from geometry.fabrication.frame_layout import held_names
from geometry.fabrication.jig import stacked_tops
from geometry.fabrication.pours import Pour
from geometry.flat.electrodes import EDGE_MM, GAP_MM, PAD_LENGTH_MM, PAD_PITCH_MM, PAD_WIDTH_MM, lead_width
from geometry.flat.pattern import FlatPattern


@dataclass(frozen=True)
class Step:
    """title; actions : sentences in order; pictures : names without their ending."""

    title: str
    actions: tuple[str, ...]
    pictures: tuple[str, ...] = ()


def steps(contents: Contents) -> list[Step]:
    """From printing to the first press."""
    return [
        _print(contents),
        *(_cast(pour, contents) for pour in contents.solid.pours),
        *_sheets(contents),
        _film(contents),
        _jig(contents),
        *_assembly(contents),
        _connect(contents),
    ]


def _print(contents: Contents) -> Step:
    actions = [
        "Print every part of the table above in the number given there. The unit of all files is the millimetre.",
        "Lay moulds with their cavities up and the frame with its openings up. No support may touch a cavity.",
        "Try the pins in their holes and the lids on their plates before anything is poured.",
    ]
    if contents.fabrication.printer == "sla":
        actions.insert(2, "Wash the parts, dry them, cure them under UV light, then heat them for 2 h at 60 °C.")
    return Step("Print the parts", tuple(actions))


def _cast(pour: Pour, contents: Contents) -> Step:
    layer = next(one for one in contents.layers if one.name == pour.component)
    mix = " and ".join(f"{mass:.2f} g of component {name}" for name, mass in pour.mixed_masses_g)
    used = "" if pour.mixed_mass_g <= pour.poured_mass_g * 1.001 else (
        f" Only {1e3 * pour.poured_mass_g:.0f} mg of it are needed; less cannot be weighed and mixed well."
    )
    pot = f" You have {pour.pot_life_min:g} minutes." if pour.pot_life_min else ""
    cure = f"Cure for {pour.cure_time_h:g} h" if pour.cure_time_h else "Cure as the maker says"
    name = spoken(pour.component)
    return Step(
        f"Cast {name}",
        (
            f"Prepare the mould. {pour.release}",
            f"Weigh {mix}, stir, and draw the air out under vacuum for 5 minutes.{used}{pot}",
            f"Fill each of the {pour.cavities} cavities until it stands a little proud, {pour.poured_volume_mm3:.0f} "
            "mm³ in all; break bubbles with a needle.",
            "Lay acetate film on the inner face of the lid, close the lid onto its pins from one side, add 200 g.",
            f"{cure}. Open the lid, lift the parts at a corner, trim what stands in the vents.",
            f"Keep those that are {layer.thickness_mm:.3g} mm thick at all four corners; note what you measure.",
        ),
        (f"mould-{pour.component}",),
    )


def _sheets(contents: Contents) -> list[Step]:
    """Components that are cut from sheet."""
    return [
        Step(
            f"Cut {spoken(name)} from sheet",
            (
                f"Measure the sheet: {pattern.thickness_mm:.3g} mm are wanted.",
                f"{pattern.instruction} File: cut/{pattern.name}.",
            ),
        )
        for name in contents.solid.cut_from_sheet
        for pattern in contents.flat.patterns
        if pattern.name == f"sheet-{name}"
    ]


def _film(contents: Contents) -> Step:
    patterns = {pattern.name: pattern for pattern in contents.flat.patterns}
    angle, count = contents.segment.film.draw_angle_deg, len(contents.flat.metals)
    width = lead_width(contents.flat.layout, count)
    return Step(
        "Make the film and the adhesive sheets",
        (
            "Find the draw direction of the film: it is marked on the roll, and the film tears easily along it. The "
            f"double arrow of the drawing lies {angle:g}° from the x axis.",
            patterns["film"].instruction,
            f"Leads are {width:.3g} mm wide, {GAP_MM:g} mm apart and {EDGE_MM:g} mm from the edge of the tab; pads "
            f"{PAD_WIDTH_MM:g} × {PAD_LENGTH_MM:g} mm, {PAD_PITCH_MM:g} mm from middle to middle. Seen with the tab to "
            "the right, the pad of the common electrode is the lowest.",
            "To turn the panel over, turn it about the axis of the tab: its two registration holes then meet the same "
            "pins, and mask-bottom fits.",
            "Remove metal with resist and etchant, or with a laser that spares the film. No solvent, at most 70 °C.",
            f"Cut the adhesive: {_list(contents, 'adhesive')}. Leave the liners on.",
            "Hold the film only by its panel or head: a crease is a dead film. Measure capacitance and resistance now.",
        ),
    )


def _rings(contents: Contents) -> list[FlatPattern]:
    return [pattern for pattern in contents.flat.patterns if pattern.name.startswith("adhesive-flange")]


def _list(contents: Contents, start: str) -> str:
    return ", ".join(pattern.name for pattern in contents.flat.patterns if pattern.name.startswith(start))


def _jig(contents: Contents) -> Step:
    """What is bonded in the corner of the jig."""
    tops = stacked_tops(contents.segment, contents.fabrication)
    order = ", then ".join(spoken(name) for name in tops)
    heights = ", ".join(f"{top:.3g} mm after {spoken(name)}" for name, top in tops.items())
    actions = [
        "Clean the layers with isopropanol, let them dry.",
        f"Push {order} into the corner of the jig, one on the other, each against both stops.",
        "Between two layers lay the adhesive that has the names of both: rub it onto the lower one, peel the liner, "
        "set the next one down in the corner first.",
        f"Compare with the steps beside the stop: the heights are {heights}, without adhesive.",
    ]
    if contents.part("jig-locator") is not None:
        actions.insert(3, "Lay jig-locator over its pins and set the effector through its hole, so that it is centred.")
    if "film" in tops:
        actions.insert(2, "The tab of the film lies over the open side of the jig, its printed words upwards.")
    return Step("Stack in the jig", tuple(actions), ("jig",))


def _assembly(contents: Contents) -> list[Step]:
    stacked = stacked_tops(contents.segment, contents.fabrication)
    if contents.part("base") is not None:
        return [_onto_base()]
    if "film" in stacked:
        return [_whole_into_frame(contents)]
    return _one_by_one(contents)


def _onto_base() -> Step:
    actions = (
        "Lay adhesive-base-medium2 inside the groove of the base and peel its liner.",
        "Set the stack on it, tab towards the shelf, and press for a minute.",
    )
    return Step("Glue the stack onto its base", actions, ("section",))


def _whole_into_frame(contents: Contents) -> Step:
    actions = [
        "Lay adhesive-base-medium2 into the middle of the opening of frame-body, peel its liner.",
        "Lower the stack into the opening, its tab into the channel. Keep the same air on all sides.",
    ]
    if contents.part("frame-ring") is not None:
        actions += [
            "Draw a thin line of flexible adhesive around the layers that the ring holds, lower frame-ring over them.",
            "Put in both screws and tighten them by turns until the ring lies flat; wipe off what is pressed out.",
        ]
    return Step("Set the stack into the frame", tuple(actions), ("section",))


def _one_by_one(contents: Contents) -> list[Step]:
    """The flange of the film is clamped between body and ring, so that the upper layers come last."""
    gap = contents.fabrication.side_clearance_mm if contents.frame.body is None else contents.frame.body.gap
    rings = {one.name.rpartition("-")[2] for one in _rings(contents)}
    lower, upper = "", ""
    if "lower" in rings:
        lower = "Rub adhesive-flange-lower onto the underside of the film's flange, window over the electrode. "
    if "upper" in rings:
        upper = "Rub adhesive-flange-upper onto the top of the flange. "
    rim = contents.frame.half_along - contents.frame.frame.along / 2 - contents.flat.layout.flange
    found = [
        Step(
            "Medium 2 into the frame",
            (
                "Lay adhesive-base-medium2 into the middle of the opening of frame-body, peel its liner.",
                f"Set medium 2 on it with {gap:g} mm of air on every side; a strip of paper of that thickness helps.",
                f"Its top is then {contents.fabrication.adhesive_thickness_mm:g} mm above the top of the frame; "
                "more is dirt, or a part that is too thick.",
            ),
            ("assembly-1",),
        ),
        Step(
            "Film onto medium 2",
            (
                f"{lower}Lay adhesive-medium2-film on medium 2, peel all liners.",
                "Hold the film by its head, top face up, the tab over its channel. Away from the cable its edge lies "
                f"{rim:.3g} mm inside the edge of the frame.",
                "Let it down from the side of the tab, rub it down from the middle outwards with a soft stick.",
            ),
            ("assembly-2",),
        ),
    ]
    if contents.part("frame-ring") is None:
        return found
    ring = Step(
        "Ring onto the film",
        (
            f"{upper}Peel its liner, lower frame-ring so that its holes meet those of the body.",
            "Put in both screws and tighten them by turns until the ring lies flat.",
            "Measure the capacitance again: it must not have changed.",
        ),
        ("assembly-3",),
    )
    block = Step(
        "Upper layers into the ring",
        (
            "Lay adhesive-film-medium1 on the film within the window, peel its liner.",
            f"Wet the walls of the window thinly with flexible adhesive, gap {contents.fabrication.glue_gap_mm:g} mm, "
            f"only where they hold: {_held(contents)}.",
            "Lower the stack from the jig into the window, medium 1 first; press it with 1 N until the adhesive holds.",
            "Wipe off what rises between wall and layers; let it cure as its maker says.",
        ),
        ("assembly-4", "section"),
    )
    return [*found, ring, block]


def _held(contents: Contents) -> str:
    names = held_names(contents.segment)
    return ", ".join(spoken(layer.name) for layer in contents.layers if layer.name in names and layer.name != "film")


def _connect(contents: Contents) -> Step:
    tops = [metal.name for metal in contents.flat.metals if metal.face == "top"]
    pads = ", ".join(f"'{name}' on the top face" for name in tops)
    return Step(
        "Connect and test",
        (
            f"Pads at the end of the tab, {PAD_PITCH_MM:g} mm apart: {pads}; the common electrode is on the other "
            "face. Crimp or glue one contact to each; do not solder.",
            "Wire the common electrode to the shield and the top to the core of a short shielded cable. Tie the tab "
            "loosely down on the shelf.",
            "Press by hand ten times to settle the rubber, then go through the checks below.",
        ),
    )
