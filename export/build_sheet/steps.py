"""The work step by step, in the order in which it is done."""

from export.build_sheet.assembly import WorkStep, assembly_steps, jig_step
from export.build_sheet.bill import FINEST_CRIMP_PITCH_MM
from export.build_sheet.contents import GAUGE_ADVICE, Contents, gauging, layer_in_sentence
from export.build_sheet.electrical import wiring
from geometry.fabrication.casting import Pour
from geometry.flat.film import METAL_EDGE_MM, PAD_LENGTH_MM


def steps(contents: Contents) -> list[WorkStep]:
    """All steps from printing to the first press."""
    return [
        _print_step(contents),
        *(_cast_step(pour, contents) for pour in contents.solid.pours),
        *_sheet_steps(contents),
        _film_step(contents),
        jig_step(contents),
        *assembly_steps(contents),
        _connect_step(contents),
    ]


def _print_step(contents: Contents) -> WorkStep:
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


def _cast_step(pour: Pour, contents: Contents) -> WorkStep:
    gauge, name = gauging(contents, pour.component), layer_in_sentence(pour.component)
    mix = " and ".join(f"{mass:.2f} g of component {one}" for one, mass in pour.mixed_masses_g)
    used = (
        ""
        if pour.mixed_mass_g <= pour.poured_mass_g * 1.001
        else (
            f" Only {_plain_number(1e3 * pour.poured_mass_g)} mg of it are needed, but less cannot be weighed and "
            "mixed well."
        )
    )
    pot = f" You have {pour.pot_life_min:g} minutes to pour." if pour.pot_life_min else ""
    cure = f"Let it cure for {pour.cure_time_h:g} h" if pour.cure_time_h else "Let it cure as its maker says"
    cavities = "the cavity" if pour.cavities == 1 else f"each of the {pour.cavities} cavities"
    lifted = "the part" if pour.cavities == 1 else "each part"
    bars = [] if not _is_split(pour, contents) else ["Set the bars onto the pins of the floor and push them together."]
    opened = "take off the lid" if not bars else "take off the lid, draw the bars off sideways"
    return WorkStep(
        f"Cast {name}",
        (
            f"Prepare the mould. {pour.release}",
            *bars,
            f"Weigh {mix}, stir, and draw the air out under vacuum for 5 minutes.{used}{pot}",
            f"Fill {cavities} a little above the rim, {_plain_number(pour.poured_volume_mm3)} mm³ in all, and break "
            "bubbles with a needle.",
            "Lay acetate film on the underside of the lid. Lower the lid onto its pins from one side, so that it traps "
            "no air, and put 200 g on it.",
            f"{cure}, then {opened}, lift {lifted} out {gauge.grip} and trim off what has set in the vents.",
            f"Keep the parts {gauge.keep}, and write down what you measure. {GAUGE_ADVICE}",
            *_spare_actions(pour, contents),
        ),
        (f"mould-{pour.component}",),
    )


def _spare_actions(pour: Pour, contents: Contents) -> list[str]:
    """A reminder where a mould of islands makes just as many as one array has."""
    if contents.device.piece_count(pour.component) == 1:
        return []
    return [f"The array needs all {pour.cavities} of them: pour again for spares."]


def _plain_number(value: float) -> str:
    """A number with two digits, or with all before the point."""
    return f"{value:.0f}" if value >= 10.0 else f"{value:.2g}"


def _is_split(pour: Pour, contents: Contents) -> bool:
    return any(one.component == pour.component and one.style == "split" for one in contents.solid.cavity_checks)


def _sheet_steps(contents: Contents) -> list[WorkStep]:
    """Steps for the components that are cut from sheet."""
    return [
        WorkStep(
            f"Cut {layer_in_sentence(name)} from sheet",
            (
                f"Measure the sheet: it should be {pattern.thickness_mm:.4g} mm thick. {GAUGE_ADVICE}",
                f"{pattern.instruction} The file is cut/{pattern.name}.",
            ),
        )
        for name in contents.solid.cut_from_sheet
        for pattern in contents.flat.patterns
        if pattern.name == f"sheet-{name}"
    ]


def _film_step(contents: Contents) -> WorkStep:
    patterns = {pattern.name: pattern for pattern in contents.flat.patterns}
    angle, layout = contents.segment.film.draw_angle_deg, contents.flat.layout
    common = "the lowest"
    if contents.device.is_array:
        common = f"number {contents.flat.metals[-1].pad} from the top"
    return WorkStep(
        "Make the film and the adhesive sheets",
        (
            "Find the draw direction of the film: it is marked on the roll, and the film tears easily along it. The "
            f"double arrow in the drawing is turned by {angle:g}° from the x axis.",
            patterns["film"].instruction,
            f"The leads are {layout.lead_width:.3g} mm wide, {layout.tab_gap:g} mm apart and {METAL_EDGE_MM:g} mm from "
            f"the edge of the tab; the pads are {layout.pad_width:.3g} × {PAD_LENGTH_MM:g} mm, {layout.pad_pitch:g} mm "
            f"from middle to middle. Seen with the tab to the right, the pad of the common electrode is {common}.",
            "Turn the panel over about the axis of its tab: its two registration holes then meet the same pins, and "
            "mask-bottom fits.",
            "Remove the metal with resist and etchant, or with a laser that spares the film. Use no solvent and stay "
            "below 70 °C.",
            f"Cut the adhesive sheets {_pattern_names(contents, 'adhesive')}. Leave the liners on.",
            *_adhesion_actions(contents),
            *_spacer_actions(contents),
            "Hold the film only by its panel or its head, because a crease ruins it. Measure its capacitance and the "
            "resistance of its leads now.",
        ),
    )


def _adhesion_actions(contents: Contents) -> list[str]:
    """Which adhesive holds on cured silicone."""
    if not contents.has_silicone:
        return []
    return [
        "Acrylic adhesive peels off cured silicone. Take tape with a silicone adhesive on the face towards rubber "
        "(such as 3M 9731, silicone on one side and acrylic on the other, 0.14 mm) and state its thickness as "
        "fabrication.adhesive_thickness_mm; or treat the rubber with oxygen plasma or a primer for silicone and join "
        "within half an hour. Peel a scrap first: it must stretch before it lets go.",
    ]


def _spacer_actions(contents: Contents) -> list[str]:
    strips = [pattern for pattern in contents.flat.patterns if pattern.name.startswith("spacer")]
    if not strips:
        return []
    cut = ", ".join(f"{one.count} of {one.name} from sheet of {one.thickness_mm:.3g} mm" for one in strips)
    return [f"Cut the spacers: {cut}. Put the strips of both directions together at their notches."]


def _pattern_names(contents: Contents, start: str) -> str:
    return ", ".join(pattern.name for pattern in contents.flat.patterns if pattern.name.startswith(start))


def _contact_action(pitch: float) -> str:
    if pitch >= FINEST_CRIMP_PITCH_MM:
        return "Crimp or glue one contact to each"
    return "Glue the stiffener under the head, beside the pad on that face, and close the connector on it"


def _connect_step(contents: Contents) -> WorkStep:
    tops = [metal.name for metal in contents.flat.metals if metal.face == "top"]
    pitch = contents.flat.layout.pad_pitch
    pads = ", ".join(f"'{name}' on the top face" for name in tops) + ", and the common electrode on the other face"
    press = "Press the segment by hand ten times to settle the rubber, then go through the checks below."
    if contents.device.is_array:
        pads = "their order stands in the table of the traces, the common electrode is on the other face"
        press = "Press every segment by hand ten times to settle the rubber, then go through the checks below."
    return WorkStep(
        "Connect and test",
        (
            f"The pads lie at the end of the tab, {pitch:g} mm apart: {pads}. {_contact_action(pitch)}; do not solder.",
            f"{wiring(contents)}Tie the tab loosely down on the shelf.",
            press,
        ),
    )
