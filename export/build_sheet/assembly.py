"""Steps in which the layers are put together: in the jig, then onto the base or into the clamp frame."""

from dataclasses import dataclass

from export.build_sheet.contents import Contents, layer_in_sentence
from geometry.fabrication.device import held_layer_names
from geometry.flat.pattern import FlatPattern


@dataclass(frozen=True)
class WorkStep:
    """One step of the work. actions : sentences in order; pictures : names without their ending."""

    title: str
    actions: tuple[str, ...]
    pictures: tuple[str, ...] = ()


def jig_step(contents: Contents) -> WorkStep:
    """The step that bonds layers in the corner of the jig.

    Narrow effectors go on through the locator, islands between spacers.
    """
    tops, locator = contents.stacked_tops_mm, contents.part("jig-locator") is not None
    actions = ["Clean the layers with isopropanol and let them dry.", *_push_actions(contents)]
    if "film" in tops:
        actions.append("The tab of the film lies over the open side of the jig, its printed words upwards.")
    if len(tops) > (2 if locator else 1):
        actions.append(
            "Bond each layer to the one below with the adhesive that has the names of both: rub it onto the lower "
            "layer, peel off its liner, set the next layer down in the corner first."
        )
    if locator:
        actions += _centre_actions(contents)
    heights = [f"{top:.4g} mm after {layer_in_sentence(name)}" for name, top in tops.items() if name != "film"]
    actions.append(
        f"Lay a straight edge over {'the stack' if len(tops) > 1 else 'it'} and the steps beside the stop: without "
        f"adhesive the height is {', '.join(heights)}."
    )
    repeats = contents.copies if contents.jig_device is contents.device else len(contents.device.layout.places)
    if repeats > 1:
        actions.append(f"Repeat this for each of the {repeats} segments.")
    title = "Stack the layers in the jig" if len(tops) > 1 else "Check the layer in the jig"
    return WorkStep(title, tuple(actions), ("jig",))


def _push_actions(contents: Contents) -> list[str]:
    """Actions that push layers against the stops of the jig, in order; islands of an array between their spacers."""
    located = {"effector"} if contents.part("jig-locator") is not None else set()
    whole = contents.jig_device is contents.device
    spaced = [name for name in contents.stacked_tops_mm if whole and name in contents.spaced_layers]
    pushed = [layer_in_sentence(name) for name in contents.stacked_tops_mm if name not in {*located, *spaced}]
    found = []
    if len(pushed) == 1:
        found.append(f"Push {pushed[0]} into the corner of the jig, against both stops.")
    elif pushed:
        found.append(
            f"Push {', then '.join(pushed)} into the corner of the jig, one on the other, each against both stops."
        )
    for name in spaced:
        found.append(_spacer_action(contents, name, "in the corner", "against both stops"))
    return found


def _spacer_action(contents: Contents, name: str, where: str, outer: str) -> str:
    """Action that sets islands between strips. where : the strips stand; outer : how the outer islands lie."""
    count = contents.device.piece_count(name)
    return (
        f"For {layer_in_sentence(name)}, stand the {_strips_text(contents)} {where}, set its {count} pieces between "
        f"them, the outer ones {outer}, and draw the strips out upwards when the pieces are bonded."
    )


def _strips_text(contents: Contents) -> str:
    names = [pattern.name for pattern in contents.flat.patterns if pattern.name.startswith("spacer")]
    return f"strips {' and '.join(names)}" if len(names) > 1 else f"strips {names[0]}"


def _adhesive_text(contents: Contents, joint: str) -> str:
    """The adhesive of a joint in words, of one piece or several."""
    count = next(one.count for one in contents.flat.patterns if one.name == f"adhesive-{joint}") // contents.copies
    return f"adhesive-{joint}" if count == 1 else f"the {count} pieces of adhesive-{joint}"


def _liner_text(contents: Contents, joint: str) -> str:
    return "its liner" if _adhesive_text(contents, joint).startswith("adhesive") else "their liners"


def _centre_actions(contents: Contents) -> list[str]:
    """Actions that set effectors narrower than their segments onto medium 1."""
    if contents.jig_device.is_array:
        return [
            "Lay jig-locator over its pins. Through each of its holes rub a piece of adhesive-medium1-effector onto "
            "medium 1, peel off its liner and set an effector on it: the hole centres it."
        ]
    rub = "Rub adhesive-medium1-effector onto the middle of medium 1 and peel off its liner."
    lay = "Lay jig-locator over its pins and set the effector onto medium 1 through its hole, which centres it."
    return [rub, lay] if len(contents.stacked_tops_mm) == 2 else [lay]


def assembly_steps(contents: Contents) -> list[WorkStep]:
    """Steps onto the base or into the clamp frame.

    The stack goes there at once where all was stacked in the jig, else piece by piece.
    """
    whole = "film" in contents.stacked_tops_mm
    if contents.part("base") is not None:
        return [_base_step(contents)] if whole else _base_steps(contents)
    if whole:
        return [_frame_step(contents)]
    return _frame_steps(contents)


def _base_step(contents: Contents) -> WorkStep:
    actions = (
        f"Lay {_adhesive_text(contents, 'base-medium2')} inside the groove of the base and peel off "
        f"{_liner_text(contents, 'base-medium2')}.",
        "Set the stack on it, its tab towards the shelf, and press it down for a minute.",
    )
    return WorkStep("Glue the stack onto its base", actions, ("section",))


def _base_steps(contents: Contents) -> list[WorkStep]:
    """Steps that set the layers of a free array onto the base one by one.

    Its film stands out beyond the layers, with traces that go around the array.
    """
    layout = contents.flat.layout
    back, side = layout.back_end - layout.frame.along / 2, layout.half_body - layout.frame.across / 2
    front = layout.body_end - layout.frame.along / 2
    sides = ((back, "away from the cable"), (side, "on both sides"), (front, "towards the cable"))
    stands_out = ", ".join(f"{far:.3g} mm {where}" for far, where in sides if far > 1e-6)
    medium2 = "Set medium 2 on it; its edges lie along the inner edge of the groove."
    if "medium2" in contents.spaced_layers:
        medium2 = _spacer_action(contents, "medium2", "on the base", "along the inner edge of the groove")
    return [
        WorkStep(
            "Set medium 2 onto the base",
            (
                f"Lay {_adhesive_text(contents, 'base-medium2')} inside the groove of the base and peel off "
                f"{_liner_text(contents, 'base-medium2')}.",
                medium2,
            ),
            ("assembly-1",),
        ),
        WorkStep(
            "Lay the film onto medium 2",
            (
                f"Lay {_adhesive_text(contents, 'medium2-film')} on medium 2 and peel off "
                f"{_liner_text(contents, 'medium2-film')}.",
                f"Hold the film by its head, top face up, the tab over the shelf. It stands out by "
                f"{stands_out}: look from above and from the sides.",
                "Lower the film from the side of the tab and rub it down from the middle outwards with a soft stick. "
                "Measure the capacitances again: they must not have changed.",
            ),
            ("assembly-2",),
        ),
        _upper_layers_step(contents, "Set the upper layers onto the film"),
    ]


def _frame_step(contents: Contents) -> WorkStep:
    actions = [
        f"Lay {_adhesive_text(contents, 'base-medium2')} into the middle of the opening of frame-body and peel off "
        f"{_liner_text(contents, 'base-medium2')}.",
        *_glue_actions(contents),
        "Lower the stack into the opening, its tab into the channel, with the same gap on all sides.",
    ]
    if contents.part("frame-ring") is not None:
        even = f", so that it fills the gap of {contents.rim_gap_mm:.2g} mm evenly: it is the elastic rim"
        even = even if contents.device.stack.boundary == "elastic" else ""
        actions += [
            f"Draw a thin line of {contents.side_glue} around {_held_text(contents)}, which the ring holds{even}, and "
            "lower frame-ring over it.",
            "Put in both screws, tighten them in turn until the ring lies flat, and wipe off what is pressed out.",
        ]
    return WorkStep("Set the stack into the frame", tuple(actions), ("section",))


def _frame_steps(contents: Contents) -> list[WorkStep]:
    """Steps that set the layers into the frame one by one.

    The flange of the film is clamped between body and ring, so that the upper layers come last.
    """
    rings = {one.name.rpartition("-")[2] for one in _ring_patterns(contents)}
    lower, upper, body, ring = "", "", contents.frame.body, contents.frame.ring
    if "lower" in rings:
        window = "windows" if body is not None and len(body.feet) > 1 else "window"
        under = "electrodes" if contents.device.is_array else "electrode"
        lower = f"Rub adhesive-flange-lower onto the underside of the film's flange, its {window} under the {under}. "
    if "upper" in rings:
        over = ", its narrow webs between the electrodes" if len(ring[0].feet) > 1 else ""
        upper = f"Rub adhesive-flange-upper onto the top of the flange{over}. "
    rim = contents.frame.half_along - contents.flat.layout.back_end
    edge = f"lies {rim:.3g} mm inside the edge of the frame" if rim > 0.05 else "is flush with the edge of the frame"
    return [
        WorkStep("Set medium 2 into the frame", _medium2_actions(contents), ("assembly-1",)),
        WorkStep(
            "Lay the film onto medium 2",
            (
                f"{lower}Lay {_adhesive_text(contents, 'medium2-film')} on medium 2 and peel off all liners.",
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
        _upper_layers_step(contents, "Set the upper layers into the ring"),
    ]


def _medium2_actions(contents: Contents) -> tuple[str, ...]:
    body, glue = contents.frame.body, contents.fabrication.adhesive_thickness_mm
    gap = contents.fabrication.side_clearance_mm if body is None else body.gap
    paper = "" if "medium2" in held_layer_names(contents.device.stack) else "; strips of paper of that thickness help"
    several = body is not None and len(body.feet) > 1
    opening = "each opening" if several else "the opening"
    set_down = f"Set medium 2 on it with a gap of {gap:g} mm on every side{paper}."
    if several:
        set_down = f"Set a piece of medium 2 into each opening with a gap of {gap:g} mm on every side{paper}."
    elif "medium2" in contents.spaced_layers:
        set_down = _spacer_action(contents, "medium2", "in the opening", f"{gap:g} mm from its walls")
    return (
        f"Lay {_adhesive_text(contents, 'base-medium2')} into the middle of {opening} of frame-body and peel off "
        f"{_liner_text(contents, 'base-medium2')}.",
        *_glue_actions(contents),
        set_down,
        f"Its top should now stand {glue:g} mm above the top of the frame. If it stands higher, look for dirt, "
        "or for a part that is too thick.",
    )


def _glue_actions(contents: Contents) -> list[str]:
    """Action that glues medium 2 to the walls of the opening, where the body of the frame holds it."""
    if "medium2" not in held_layer_names(contents.device.stack):
        return []
    fills = f"it fills the gap of {contents.rim_gap_mm:.2g} mm to medium 2"
    return [f"Wet the walls of the opening thinly with {contents.side_glue}: {fills}."]


def _upper_layers_step(contents: Contents, title: str) -> WorkStep:
    """The step that sets the upper layers onto the film, and glues them to the walls of the ring that hold them."""
    stacked, held = contents.stacked_tops_mm, _held_text(contents)
    what = "the stack from the jig" if len(stacked) > 1 else layer_in_sentence(next(iter(stacked)))
    first = ", medium 1 first" if len(stacked) > 1 else ""
    ring = contents.frame.ring
    each = contents.jig_device is not contents.device
    windows = bool(ring) and len(ring[0].feet) > 1
    within = f" within the {'windows' if windows else 'window'} of the ring" if ring else ""
    actions = [
        f"Lay {_adhesive_text(contents, 'film-medium1')} on the film{within} and peel off "
        f"{_liner_text(contents, 'film-medium1')}.",
        f"Lower {what} into the window{first}, and press it down with about 1 N until the adhesive holds.",
    ]
    if windows:
        actions[1] = f"Lower one stack into each window{first}, and press it down with about 1 N until it holds."
    elif each:
        count = len(contents.device.layout.places)
        actions[1] = (
            f"Stand the {_strips_text(contents)} on the film, above the gaps between the electrodes. Set one of the "
            f"{count} stacks into each place{first}, press it down with about 1 N, then draw the strips out upwards."
        )
    elif not ring:
        actions[1] = (
            f"Set {what} on it{first}, flush with medium 2 on all sides, and press it down until the adhesive holds."
        )
    if held:
        actions.insert(
            1,
            f"Wet the walls of the {'windows' if windows else 'window'} with {contents.side_glue} beside {held}: it "
            f"fills the gap of {contents.rim_gap_mm:.2g} mm there.",
        )
        actions.append("Wipe off what rises between wall and layers and let it cure as its maker says.")
    picture = f"assembly-{3 + bool(ring)}"  # after medium 2, film and ring
    return WorkStep(title, tuple(actions), (picture, "section"))


def _held_text(contents: Contents) -> str:
    """Names of the layers that are glued to the ring."""
    names = held_layer_names(contents.device.stack) - {"film", "medium2"}
    return " and ".join(layer_in_sentence(layer.name) for layer in contents.layers if layer.name in names)


def _ring_patterns(contents: Contents) -> list[FlatPattern]:
    return [pattern for pattern in contents.flat.patterns if pattern.name.startswith("adhesive-flange")]
