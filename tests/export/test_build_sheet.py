"""Every instruction and every part of a kit against the shape that it speaks of, for all effectors."""

import re

import numpy as np
import pytest
import pyvista

from export.build_sheet.contents import gauging
from export.build_sheet.page import checks, traces
from export.build_sheet.pictures import VIEW_FROM_ABOVE, _anchor
from export.build_sheet.steps import steps
from foundation.errors import InputError
from softdot.config.loading import config_from
from softdot.kit.folder import contents_of
from tests.cases import for_each

pytestmark = pytest.mark.press

EFFECTORS = {
    "none": None,
    "layer": {"height_mm": 1.0},
    "block": {"shape": "block", "length_mm": 1.5, "width_mm": 1.0, "height_mm": 0.6},
    "cylinder": {"shape": "cylinder", "diameter_mm": 1.6, "height_mm": 0.7},
    "dome": {"shape": "dome", "diameter_mm": 2.0, "height_mm": 0.8},
}
WIDE = {
    "length_mm": 20.0, "width_mm": 15.0,
    "medium1": {"thickness_mm": 3.0, "material": "dragon-skin-30"},
    "medium2": {"thickness_mm": 6.0, "material": "ecoflex-00-50"},
}  # fmt: skip
HELD = {"held_layers": ["medium1", "medium2"]}
DESIGNS = {name: (EFFECTORS[name], {}, {}) for name in ("none", "block", "dome")}
MORE = {
    "layer": (EFFECTORS["layer"], {}, {}),
    "cylinder": (EFFECTORS["cylinder"], {}, {}),
    "dome on a free segment": (EFFECTORS["dome"], {"boundary": "free"}, {}),
    "hemisphere as wide as the segment": ({"shape": "dome", "diameter_mm": 2.5, "height_mm": 1.25}, {}, {}),
    "small dome": ({"shape": "dome", "diameter_mm": 1.0, "height_mm": 0.41}, {}, {"pin_diameter_mm": 1.5}),
    "wide dome, split mould": ({"shape": "dome", "diameter_mm": 12.0, "height_mm": 3.0}, WIDE, {"cable_exit": "-y"}),
    "wide cylinder": ({"shape": "cylinder", "diameter_mm": 12.0, "height_mm": 5.0}, WIDE, {"cavities": [1, 1]}),
    "wide block": ({"shape": "block", "length_mm": 18.0, "width_mm": 4.0, "height_mm": 5.0}, WIDE, {}),
    "layer, all held but the film": (EFFECTORS["layer"], {"held_layers": ["effector", "medium1", "medium2"]}, {}),
    "cylinder, media held": (EFFECTORS["cylinder"], HELD, {}),
    "film alone held": (None, {"held_layers": ["film"]}, {}),
    "block from sheet": (EFFECTORS["block"], {}, {"routes": {"effector": "sheet", "medium1": "sheet"}}),
    "free cylinder, split moulds": (EFFECTORS["cylinder"], {"boundary": "free"}, {"mould_style": "split"}),
}  # fmt: skip


CELL = {"length_mm": 2.3, "width_mm": 2.3, "boundary": "free"}
ONE_IN_A_GRID = {"length_mm": 2.0, "width_mm": 2.0, "boundary": "free"}
SHEETS = {"routes": {"effector": "sheet", "medium1": "sheet", "medium2": "sheet"}}
BARS = {"grid_layers": ["effector", "medium1", "film"], "shared": ["film", "medium2"]}
GROOVES = [{"layer": "medium2", "width_mm": 0.5, "depth_mm": 1.5}]
ALL = ["effector", "medium1", "film", "medium2"]
ARRAYS = {
    "cell": (EFFECTORS["layer"], CELL, SHEETS, {}),
    "grid": (EFFECTORS["layer"], ONE_IN_A_GRID, SHEETS, BARS),
    "islands": (EFFECTORS["layer"], CELL, {**SHEETS, "cable_exit": "+y"}, {"shared": ["film"]}),
    "row": (EFFECTORS["layer"], CELL, {**SHEETS, "cable_exit": "-y"}, {"columns": 5, "rows": 1, "shared": ["film"]}),
    "without effector": (None, CELL, {"routes": {"medium1": "sheet", "medium2": "sheet"}}, {}),
    "cast": (EFFECTORS["layer"], CELL, {}, {}),
    "domes over grooves, two cells": (EFFECTORS["dome"] | {"diameter_mm": 1.6, "height_mm": 0.6},
                                      CELL, {"cable_exit": "+y"}, {"cells": 2, "grooves": GROOVES}),
    "cylinders, clamped": (EFFECTORS["cylinder"], {**CELL, "boundary": "clamped"}, {}, {}),
    "blocks in a grid": ({"shape": "block", "length_mm": 1.2, "width_mm": 1.0, "height_mm": 0.6}, ONE_IN_A_GRID, {},
                         {"grid_layers": ["medium1", "film", "medium2"], "shared": ["film"]}),
    "one layer over all": (EFFECTORS["layer"], {**CELL, "boundary": "clamped"}, {"pad_pitch_mm": 1.0}, {"shared": ALL}),
    "split moulds": (EFFECTORS["layer"], CELL, {"mould_style": "split"}, {"shared": ["film"]}),
    "a grid at the effectors": (EFFECTORS["layer"], ONE_IN_A_GRID, {}, {"grid_layers": ["effector"]}),
}  # fmt: skip


def config_of(effector, segment, fabrication, array=None):
    layers = {
        "medium1": {"thickness_mm": 0.5, "material": "dragon-skin-30"}, "film": {"thickness_um": 28.0},
        "medium2": {"thickness_mm": 2.0, "material": "ecoflex-00-50"},
    }  # fmt: skip
    tables = {**layers, **segment} | ({} if effector is None else {"effector": effector})
    several = {} if array is None else {"array": array, "dot": {"standard": "marburg-medium"}}
    return config_from({"segment": tables, "fabrication": fabrication, **several})


def contents_for(design):
    return contents_of(config_of(*design), [])


@pytest.fixture(scope="module", params=DESIGNS)
def contents(request):
    return contents_for(DESIGNS[request.param])


def sentences(contents):
    return [action for step in steps(contents) for action in step.actions]


def refuse_unprintable(contents):
    """Each part can be printed, or a warning names it and says what to do."""
    for answer in contents.printability:
        assert answer.printable or any(one.startswith(answer.label) for one in contents.warnings), answer


def refuse_what_the_shape_has_not(contents):
    """Corners where there are corners, a crown on a dome, sizes that the layers have."""
    sizes = {f"{layer.thickness_mm:.4g}" for layer in contents.layers}
    effector = contents.segment.effector
    for size in () if effector is None else (effector.diameter_mm, effector.length_mm, effector.width_mm):
        sizes |= set() if size is None else {f"{size:.4g}"}
    about = [one for one in sentences(contents) if one.startswith(("Keep the parts", "Measure the sheet"))]
    assert len(about) == len(contents.layers) - 1
    for one in about:
        own = one.partition(". ")[0]
        assert set(re.findall(r"[\d.]*\d", own)) <= sizes, own
    for step in steps(contents):
        if step.title == "Cast the effector":
            refuse_words_of_another_shape(" ".join(step.actions), gauging(contents, "effector").shape)
    for check in checks(contents):
        if re.match(r"(thickness|height|depth).* the effector", check.what):
            refuse_words_of_another_shape(check.what, gauging(contents, "effector").shape)


def refuse_words_of_another_shape(text, shape):
    assert ("corner" in text) <= (shape == "box"), text
    assert ("crown" in text or "deepest" in text) <= (shape == "dome"), text
    assert bool(re.search(r"\brim\b", text.replace("above the rim", ""))) <= (shape == "cylinder"), text
    assert ("thick " in text.partition("Use a")[0]) <= (shape == "box"), text


def refuse_parts_that_are_not_there(contents):
    """What is named is made: files of parts and patterns, the jig's locator, the bars of a mould; nothing is empty."""
    text = " ".join(sentences(contents))
    assert not re.search(r"  |: \.|, ,|\(\)|None", text), text
    patterns = {pattern.name for pattern in contents.flat.patterns}
    assert set(re.findall(r"(?:adhesive|sheet|mask)-[\w-]*\w", text)) <= patterns
    for part in ("jig-locator", "frame-ring", "frame-body"):
        assert (part in text) == (contents.part(part) is not None), part
    assert ("bars" in text) == any("-bar-" in part.label for part in contents.solid.parts)
    assert ("cavit" in text) == bool(contents.solid.pours)


def test_every_part_can_be_printed(contents):
    refuse_unprintable(contents)


def test_every_instruction_fits_its_shape(contents):
    refuse_what_the_shape_has_not(contents)


def test_every_instruction_names_what_is_there(contents):
    refuse_parts_that_are_not_there(contents)


@pytest.mark.parametrize("name", ARRAYS)
def test_arrays_of_all_kinds(name):
    found = contents_for(ARRAYS[name])
    refuse_unprintable(found)
    refuse_what_the_shape_has_not(found)
    refuse_parts_that_are_not_there(found)
    refuse_pieces_that_are_miscounted(found)
    assert [trace.pad for trace in traces(found)] == list(range(1, len(found.flat.metals) + 1))


def refuse_pieces_that_are_miscounted(contents):
    """A pattern of several pieces is spoken of as several, and spacers are cut where something is set between them."""
    text = " ".join(sentences(contents))
    counts = {pattern.name: pattern.count for pattern in contents.flat.patterns}
    laid = re.findall(r"Lay (?:the (\d+) pieces of )?(adhesive-[\w-]+\w)", text)
    assert laid
    assert all(int(count or 1) == counts[name] for count, name in laid)
    assert ("draw the strips out" in text) == any(one.name.startswith("spacer") for one in contents.flat.patterns)


def test_a_narrow_effector_is_centred_and_not_pushed_against_the_stops(contents):
    text = next(" ".join(step.actions) for step in steps(contents) if "jig" in step.title)
    pushed = re.search(r"Push (.*) into the corner", text).group(1)
    narrow = contents.part("jig-locator") is not None
    assert ("effector" in pushed) == (contents.segment.effector is not None and not narrow)
    assert ("centres it" in text) == narrow


def test_a_dome_is_measured_at_its_crown():
    """Its edge is thin by design."""
    found = contents_for(DESIGNS["dome"])
    keep = next(one for one in sentences(found) if one.startswith("Keep the parts whose"))
    assert "crown is 0.8 mm above their base and whose foot is 2 mm across" in keep
    measured = {check.what: check.expect for check in checks(found)}
    assert measured["height of the effector, from its base to its crown"] == "0.8 mm"
    assert measured["the effector: diameter of its foot"] == "2 mm"


def test_a_dome_too_low_for_a_mould_is_not_sent_to_a_sheet():
    low = {"shape": "dome", "diameter_mm": 2.0, "height_mm": 0.3}
    with pytest.raises(InputError, match=r"cavity of 0\.3.* mm, below .*; make it larger"):
        contents_for((low, {}, {}))


@pytest.mark.evidence
@for_each("name", MORE)
def test_other_sizes_and_other_frames(name):
    found = contents_for(MORE[name])
    refuse_unprintable(found)
    refuse_what_the_shape_has_not(found)
    refuse_parts_that_are_not_there(found)


def test_a_name_finds_its_part_however_high_the_part_is_drawn():
    box = pyvista.Box((0.0, 1.0, 0.0, 1.0, 40.0, 41.0))
    box.points = box.points.astype(np.float32)
    assert np.isfinite(_anchor(box, VIEW_FROM_ABOVE)).all()
