"""The work step by step, in the order in which it is done."""

from dataclasses import dataclass

from export.build_sheet.contents import GAUGE, Contents, gauging, in_words
from geometry.fabrication.casting import Pour
from geometry.fabrication.clamp_frame import held_names
from geometry.fabrication.kit import stacked_tops
from geometry.flat.electrodes import EDGE_MM, GAP_MM, PAD_LENGTH_MM, PAD_PITCH_MM, PAD_WIDTH_MM, lead_width
from geometry.flat.pattern import FlatPattern


@dataclass(frozen=True)
class WorkStep:
    """title; actions : sentences in order; pictures : names without their ending."""

    title: str
    actions: tuple[str, ...]
    pictures: tuple[str, ...] = ()


def steps(contents: Contents) -> list[WorkStep]:
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


def _print(contents: Contents) -> WorkStep:
    actions = ["Print each part of the table above as often as it says there. The unit of all files is the millimetre."]
    if contents.solid.pours:
        actions.append("Print the moulds with their cavities up; no support may touch a cavity.")
    held = "the base with its groove up" if contents.part("base") else "the frame with its openings up"
    actions.append(f"Print {held} and the jig with its floor down.")
    if contents.fabrication.printer == "sla":
        actions.append("Wash the parts, dry them, cure them under UV light, then heat them for 2 h at 60 °C.")
    if contents.solid.pours:
        actions.append("Try the pins in their holes and the lids on their moulds before you pour anything.")
    return WorkStep("Print the parts", tuple(actions))


def _cast(pour: Pour, contents: Contents) -> WorkStep:
    gauge, name = gauging(contents, pour.component), in_words(pour.component)
    mix = " and ".join(f"{mass:.2f} g of component {one}" for one, mass in pour.mixed_masses_g)
    used = (
        ""
        if pour.mixed_mass_g <= pour.poured_mass_g * 1.001
        else (
            f" Only {_plain(1e3 * pour.poured_mass_g)} mg of it are needed, but less cannot be weighed and mixed well."
        )
    )
    pot = f" You have {pour.pot_life_min:g} minutes to pour." if pour.pot_life_min else ""
    cure = f"Let it cure for {pour.cure_time_h:g} h" if pour.cure_time_h else "Let it cure as its maker says"
    cavities = "the cavity" if pour.cavities == 1 else f"each of the {pour.cavities} cavities"
    bars = [] if not _split(pour, contents) else ["Set the bars onto the pins of the floor and push them together."]
    opened = "take off the lid" if not bars else "take off the lid, draw the bars off sideways"
    return WorkStep(
        f"Cast {name}",
        (
            f"Prepare the mould. {pour.release}",
            *bars,
            f"Weigh {mix}, stir, and draw the air out under vacuum for 5 minutes.{used}{pot}",
            f"Fill {cavities} a little above the rim, {_plain(pour.poured_volume_mm3)} mm³ in all, and break bubbles "
            "with a needle.",
            "Lay acetate film on the underside of the lid. Lower the lid onto its pins from one side, so that it traps "
            "no air, and put 200 g on it.",
            f"{cure}, then {opened}, lift each part out {gauge.grip} and trim off what has set in the vents.",
            f"Keep the parts {gauge.keep}, and write down what you measure. {GAUGE}",
        ),
        (f"mould-{pour.component}",),
    )


def _plain(value: float) -> str:
    """Two digits or all before the point."""
    return f"{value:.0f}" if value >= 10.0 else f"{value:.2g}"


def _split(pour: Pour, contents: Contents) -> bool:
    return any(one.component == pour.component and one.style == "split" for one in contents.solid.cavity_checks)


def _sheets(contents: Contents) -> list[WorkStep]:
    """Components that are cut from sheet."""
    return [
        WorkStep(
            f"Cut {in_words(name)} from sheet",
            (
                f"Measure the sheet: it should be {pattern.thickness_mm:.4g} mm thick. {GAUGE}",
                f"{pattern.instruction} The file is cut/{pattern.name}.",
            ),
        )
        for name in contents.solid.cut_from_sheet
        for pattern in contents.flat.patterns
        if pattern.name == f"sheet-{name}"
    ]


def _film(contents: Contents) -> WorkStep:
    patterns = {pattern.name: pattern for pattern in contents.flat.patterns}
    angle, count = contents.segment.film.draw_angle_deg, len(contents.flat.metals)
    width = lead_width(contents.flat.layout, count)
    return WorkStep(
        "Make the film and the adhesive sheets",
        (
            "Find the draw direction of the film: it is marked on the roll, and the film tears easily along it. The "
            f"double arrow in the drawing is turned by {angle:g}° from the x axis.",
            patterns["film"].instruction,
            f"The leads are {width:.3g} mm wide, {GAP_MM:g} mm apart and {EDGE_MM:g} mm from the edge of the tab; the "
            f"pads are {PAD_WIDTH_MM:g} × {PAD_LENGTH_MM:g} mm, {PAD_PITCH_MM:g} mm from middle to middle. Seen with "
            "the tab to the right, the pad of the common electrode is the lowest.",
            "Turn the panel over about the axis of its tab: its two registration holes then meet the same pins, and "
            "mask-bottom fits.",
            "Remove the metal with resist and etchant, or with a laser that spares the film. Use no solvent and stay "
            "below 70 °C.",
            f"Cut the adhesive sheets {_list(contents, 'adhesive')}. Leave the liners on.",
            "Hold the film only by its panel or its head, because a crease ruins it. Measure its capacitance and the "
            "resistance of its leads now.",
        ),
    )


def _rings(contents: Contents) -> list[FlatPattern]:
    return [pattern for pattern in contents.flat.patterns if pattern.name.startswith("adhesive-flange")]


def _list(contents: Contents, start: str) -> str:
    return ", ".join(pattern.name for pattern in contents.flat.patterns if pattern.name.startswith(start))


def _jig(contents: Contents) -> WorkStep:
    """What is bonded in the corner of the jig; a narrow effector goes on through the locator."""
    tops = stacked_tops(contents.segment, contents.fabrication)
    locator = contents.part("jig-locator") is not None
    pushed = [in_words(name) for name in tops if not (locator and name == "effector")]
    heights = [f"{top:.4g} mm after {in_words(name)}" for name, top in tops.items() if name != "film"]
    actions = ["Clean the layers with isopropanol and let them dry."]
    actions.append(
        f"Push {pushed[0]} into the corner of the jig, against both stops."
        if len(pushed) == 1
        else f"Push {', then '.join(pushed)} into the corner of the jig, one on the other, each against both stops."
    )
    if "film" in tops:
        actions.append("The tab of the film lies over the open side of the jig, its printed words upwards.")
    if len(tops) > 1:
        actions.append(
            "Bond each layer to the one below with the adhesive that has the names of both: rub it onto the lower "
            "layer, peel off its liner, set the next layer down in the corner first."
            if not locator or len(pushed) > 1
            else "Rub adhesive-medium1-effector onto the middle of medium 1 and peel off its liner."
        )
    if locator:
        actions.append(
            "Lay jig-locator over its pins and set the effector onto medium 1 through its hole, which centres it."
        )
    actions.append(
        f"Lay a straight edge over {'the stack' if len(tops) > 1 else 'it'} and the steps beside the stop: without "
        f"adhesive the height is {', '.join(heights)}."
    )
    if contents.copies > 1:
        actions.append(f"Repeat this for each of the {contents.copies} segments.")
    title = "Stack the layers in the jig" if len(tops) > 1 else "Check the layer in the jig"
    return WorkStep(title, tuple(actions), ("jig",))


def _assembly(contents: Contents) -> list[WorkStep]:
    stacked = stacked_tops(contents.segment, contents.fabrication)
    if contents.part("base") is not None:
        return [_onto_base()]
    if "film" in stacked:
        return [_whole_into_frame(contents)]
    return _one_by_one(contents)


def _onto_base() -> WorkStep:
    actions = (
        "Lay adhesive-base-medium2 inside the groove of the base and peel off its liner.",
        "Set the stack on it, its tab towards the shelf, and press it down for a minute.",
    )
    return WorkStep("Glue the stack onto its base", actions, ("section",))


def _whole_into_frame(contents: Contents) -> WorkStep:
    actions = [
        "Lay adhesive-base-medium2 into the middle of the opening of frame-body and peel off its liner.",
        *_glue_medium2(contents),
        "Lower the stack into the opening, its tab into the channel, with the same gap on all sides.",
    ]
    if contents.part("frame-ring") is not None:
        actions += [
            f"Draw a thin line of flexible adhesive around {_held(contents)}, which the ring holds, and lower "
            "frame-ring over it.",
            "Put in both screws, tighten them in turn until the ring lies flat, and wipe off what is pressed out.",
        ]
    return WorkStep("Set the stack into the frame", tuple(actions), ("section",))


def _one_by_one(contents: Contents) -> list[WorkStep]:
    """The flange of the film is clamped between body and ring, so that the upper layers come last."""
    gap = contents.fabrication.side_clearance_mm if contents.frame.body is None else contents.frame.body.gap
    rings = {one.name.rpartition("-")[2] for one in _rings(contents)}
    lower, upper = "", ""
    if "lower" in rings:
        lower = "Rub adhesive-flange-lower onto the underside of the film's flange, its window under the electrode. "
    if "upper" in rings:
        upper = "Rub adhesive-flange-upper onto the top of the flange. "
    rim = contents.frame.half_along - contents.frame.frame.along / 2 - contents.flat.layout.flange
    edge = f"lies {rim:.3g} mm inside the edge of the frame" if rim > 0.05 else "is flush with the edge of the frame"
    glue = contents.fabrication.adhesive_thickness_mm
    paper = "" if "medium2" in held_names(contents.segment) else "; strips of paper of that thickness help"
    return [
        WorkStep(
            "Set medium 2 into the frame",
            (
                "Lay adhesive-base-medium2 into the middle of the opening of frame-body and peel off its liner.",
                *_glue_medium2(contents),
                f"Set medium 2 on it with a gap of {gap:g} mm on every side{paper}.",
                f"Its top should now stand {glue:g} mm above the top of the frame. If it stands higher, look for dirt, "
                "or for a part that is too thick.",
            ),
            ("assembly-1",),
        ),
        WorkStep(
            "Lay the film onto medium 2",
            (
                f"{lower}Lay adhesive-medium2-film on medium 2 and peel off all liners.",
                f"Hold the film by its head, top face up, the tab over its channel. The edge of the film that is away "
                f"from the cable {edge}.",
                "Lower the film from the side of the tab and rub it down from the middle outwards with a soft stick.",
            ),
            ("assembly-2",),
        ),
        WorkStep(
            "Screw the ring onto the film",
            (
                f"{upper}Peel off its liner and lower frame-ring so that its holes meet those of the body."
                if upper
                else "Lower frame-ring so that its holes meet those of the body.",
                "Put in both screws and tighten them in turn until the ring lies flat.",
                "Measure the capacitance again: it must not have changed.",
            ),
            ("assembly-3",),
        ),
        _upper_layers(contents),
    ]


def _glue_medium2(contents: Contents) -> list[str]:
    """Where the body of the frame holds it."""
    if "medium2" not in held_names(contents.segment):
        return []
    fills = f"it fills the gap of {contents.fabrication.glue_gap_mm:g} mm to medium 2"
    return [f"Wet the walls of the opening thinly with flexible adhesive: {fills}."]


def _upper_layers(contents: Contents) -> WorkStep:
    """Into the ring, bonded to the film, and to the walls of the ring where these hold them."""
    stacked, held = stacked_tops(contents.segment, contents.fabrication), _held(contents)
    what = "the stack from the jig" if len(stacked) > 1 else in_words(next(iter(stacked)))
    first = ", medium 1 first" if len(stacked) > 1 else ""
    actions = [
        "Lay adhesive-film-medium1 on the film within the window of the ring and peel off its liner.",
        f"Lower {what} into the window{first}, and press it down with about 1 N until the adhesive holds.",
    ]
    if held:
        actions.insert(
            1,
            f"Wet the walls of the window thinly with flexible adhesive beside {held}: it fills the gap of "
            f"{contents.fabrication.glue_gap_mm:g} mm there.",
        )
        actions.append("Wipe off what rises between wall and layers and let it cure as its maker says.")
    return WorkStep("Set the upper layers into the ring", tuple(actions), ("assembly-4", "section"))


def _held(contents: Contents) -> str:
    """Layers that are glued to the ring."""
    names = held_names(contents.segment) - {"film", "medium2"}
    return " and ".join(in_words(layer.name) for layer in contents.layers if layer.name in names)


def _connect(contents: Contents) -> WorkStep:
    tops = [metal.name for metal in contents.flat.metals if metal.face == "top"]
    pads = ", ".join(f"'{name}' on the top face" for name in tops)
    return WorkStep(
        "Connect and test",
        (
            f"The pads lie at the end of the tab, {PAD_PITCH_MM:g} mm apart: {pads}, and the common electrode on the "
            "other face. Crimp or glue one contact to each; do not solder.",
            "Wire the common electrode to the shield of a short shielded cable and the top to its core. Tie the tab "
            "loosely down on the shelf.",
            "Press the segment by hand ten times to settle the rubber, then go through the checks below.",
        ),
    )
