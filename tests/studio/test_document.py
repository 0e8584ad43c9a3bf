"""A design is a text: edits keep its comments, and every change can be undone."""

import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foundation.errors import InputError
from softdot.studio.document import LARGEST, MOST_KEPT, Document
from tests.cases import for_each

TEXT = """# my segment
[segment.medium1]
thickness_mm = 0.5  # of the sheet

[[mechanisms]]
name = "friction"  # measured
component = "dot"
parameters = { coefficient = 0.5 }
"""


def test_an_edit_changes_one_value_and_keeps_every_comment():
    document = Document(TEXT)
    document.set(["segment", "medium1", "thickness_mm"], 0.4)
    assert document.text == TEXT.replace("0.5  #", "0.4  #")
    document.set(["mechanisms", 0, "parameters", "coefficient"], 0.7)
    assert document.text == TEXT.replace("0.5  #", "0.4  #").replace("= 0.5 }", "= 0.7 }")


def test_missing_tables_are_made_and_keys_are_taken_out():
    document = Document(TEXT)
    document.set(["segment", "film", "electrodes", 0], {"name": "one", "center_mm": [0.0, 0.0], "size_mm": [1.0, 1.0]})
    document.set(["mechanisms", 1], {"name": "contact-gap", "component": "dot", "parameters": {"gap_mm": 0.05}})
    found = tomllib.loads(document.text)
    assert found["segment"]["film"]["electrodes"][0]["name"] == "one"
    assert [one["name"] for one in found["mechanisms"]] == ["friction", "contact-gap"]
    document.set(["mechanisms", 0], None)
    document.set(["segment", "medium1", "thickness_mm"], None)
    document.set(["segment", "medium1", "thickness_mm"], None)
    document.set(["readout", "limit_V"], None)
    found = tomllib.loads(document.text)
    assert [one["name"] for one in found["mechanisms"]] == ["contact-gap"]
    assert found["segment"]["medium1"] == {}
    assert "readout" not in found


def test_a_list_that_is_stated_in_brackets_grows():
    document = Document("mechanisms = []\n[segment.film]\nelectrodes = []\n")
    document.set(["mechanisms", 0], {"name": "contact-gap", "component": "dot", "parameters": {"gap_mm": 0.05}})
    assert tomllib.loads(document.text)["mechanisms"][0]["parameters"] == {"gap_mm": 0.05}


def test_undo_and_redo():
    document = Document(TEXT)
    for thickness in (0.4, 0.3):
        document.set(["segment", "medium1", "thickness_mm"], thickness)
    last = document.text
    document.undo()
    document.undo()
    assert (document.text, document.can_undo, document.can_redo) == (TEXT, False, True)
    document.redo()
    document.redo()
    assert (document.text, document.can_redo) == (last, False)


def test_a_slider_that_is_held_is_one_change():
    document = Document(TEXT)
    for number, thickness in enumerate((0.4, 0.3, 0.2)):
        document.set(["segment", "medium1", "thickness_mm"], thickness, joined=number > 0)
    document.undo()
    assert document.text == TEXT


def test_what_is_kept_for_undo_is_bounded():
    document = Document("seed = 0\n")
    for seed in range(1, 3 * MOST_KEPT):
        document.set(["seed"], seed)
    for _ in range(3 * MOST_KEPT):
        document.undo()
    assert document.text == f"seed = {2 * MOST_KEPT - 1}\n"


@for_each("key", [["segment", "medium1", "thickness_mm", "x"], ["mechanisms", 7, "name"], ["segment", 0]])
def test_a_place_that_cannot_be_is_refused_in_one_sentence(key):
    document = Document(TEXT)
    with pytest.raises(InputError, match="there is no such place in this design"):
        document.set(key, 1)
    assert document.text == TEXT


def test_text_that_is_no_toml_is_refused_by_an_edit_and_may_be_undone():
    document = Document(TEXT)
    document.write("[segment")
    with pytest.raises(InputError, match="not valid TOML"):
        document.set(["seed"], 1)
    document.undo()
    assert document.text == TEXT
    with pytest.raises(InputError, match="characters"):
        document.write("#" * (LARGEST + 1))


Numbers = st.one_of(st.integers(-(10**9), 10**9), st.floats(allow_nan=False, allow_infinity=False), st.booleans())


@given(st.lists(st.tuples(st.sampled_from(["a", "b.c", "ä", ""]), st.sampled_from(["x", "y z"]), Numbers), max_size=6))
def test_any_name_and_number_comes_back(edits):
    document, expected = Document("# nothing\n"), {}
    for table, name, value in edits:
        anew = Document(document.text)
        for one in (document, anew):
            one.set([table, name], value)
        assert document.text == anew.text
        expected.setdefault(table, {})[name] = value
    assert tomllib.loads(document.text) == expected
    assert document.text.startswith("# nothing")
