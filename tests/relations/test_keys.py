"""A key stands only where it acts: stated elsewhere it is refused by name, once, in program and schema alike."""

import copy
import tomllib
from collections import ChainMap
from dataclasses import replace
from itertools import permutations, product

import numpy as np
import pytest

from foundation.errors import InputError
from foundation.nearest_name import nearest_name_hint
from geometry.parameters import Dot, Effector, Segment
from mesh.options import MeshOptions
from softdot import Case
from softdot.config.default_design import with_default_design
from softdot.config.errors import tables_at
from softdot.config.loading import config_from
from softdot.config.mistakes import mistakes
from softdot.config.not_modelled import NOT_MODELLED, not_modelled
from softdot.config.rig import Bench
from softdot.config.schema import Config, config_schema
from softdot.config.settings import with_settings
from solve.mechanisms import MECHANISMS, Mechanism, with_mechanisms
from solve.model import Readout
from solve.waveform import Waveform
from tests.cases import for_each

TABLES = {
    ("press", "waveform"): Waveform,
    ("readout",): Readout,
    ("segment",): Segment,
    ("segment", "effector"): Effector,
    ("dot",): Dot,
    ("mesh",): MeshOptions,
}
SCHEMA = config_schema()


def example(name, schema):
    """A value that a key allows, other than its default."""
    kinds = [one for one in schema.get("anyOf", [schema]) if one.get("type") != "null"]
    (kind,) = kinds
    if "$ref" in kind:
        return {}
    if "enum" in kind:
        return kind["enum"][-1]
    if kind["type"] == "array":
        return ["film"] if name == "held_layers" else [0.5]
    return {"string": "a", "boolean": True, "integer": 2, "number": 1.5}[kind["type"]]


def beside(tag, wanted, schema, holds):
    """Values of a tag with which a condition holds, or does not."""
    if isinstance(wanted, str):
        return [{tag: "⠃" if tag == "cell" else example(tag, schema)} if (wanted == "stated") == holds else {}]
    return [{tag: one} for one in schema["enum"] if (one in wanted) == holds]


def conditions():
    """Way of a table, key, a table in which one condition of the key holds, and whether it does."""
    for way, kind in TABLES.items():
        properties = SCHEMA["$defs"][kind.__name__]["properties"]
        for name, acts in kind.conditional_keys():
            told = {name: example(name, properties[name])}
            for tag, wanted in acts.tags.items():  # one of them is enough
                yield from ((way, name, {**tags, **told}, True) for tags in beside(tag, wanted, properties[tag], True))
            for none in product(*(beside(tag, wanted, properties[tag], False) for tag, wanted in acts.tags.items())):
                yield way, name, {**dict(ChainMap(*none)), **told}, False


CONDITIONS = list(conditions())


def put(way, table):
    """A configuration with this table."""
    tables = table
    for part in reversed(way):
        tables = {part: tables}
    return tables


def test_there_are_such_keys():
    assert len({(way, name) for way, name, _, holds in CONDITIONS if not holds}) >= 21


@for_each(
    ("way", "name", "table"),
    [(way, name, table) for way, name, table, holds in CONDITIONS if not holds],
    ids=lambda value: str(value)[:60],
)
def test_a_key_that_does_not_act_is_refused_by_name_and_said_once(way, name, table):
    tables = put(way, table)
    key = ".".join([*way, name])

    def check(found):
        return config_from(with_default_design(found))

    with pytest.raises(InputError) as refused:
        check(tables)
    assert str(refused.value).startswith(f"{key} = ")
    assert ": acts only with" in str(refused.value)
    found, _ = mistakes(tables, check)
    assert [one for one in found if one.startswith(f"{key} ")] == [str(refused.value)]


@for_each(("way", "name", "table"), [one[:3] for one in CONDITIONS if one[3]], ids=str)
def test_where_it_acts_nothing_is_said_of_it_and_what_is_written_can_be_read(way, name, table):
    kind = TABLES[way]
    keys, properties = kind.conditional_keys(), SCHEMA["$defs"][kind.__name__]["properties"]
    needed = {one: example(one, properties[one]) for one, acts in keys
              if acts.needed and all(table.get(tag) in wanted for tag, wanted in acts.tags.items())}  # fmt: skip
    try:
        written = config_from(with_default_design(put(way, {**needed, **table}))).model_dump(
            mode="json", exclude_none=True
        )
    except InputError as error:
        assert not str(error).startswith(".".join([*way, name]))  # noqa: PT017 - another key of a table made at random
    else:
        assert config_from(written).model_dump(mode="json", exclude_none=True) == written


@for_each("boundary", ["free", "clamped", "elastic"])
def test_an_inherited_key_is_no_statement(boundary):
    assert Case.load(settings=[f"segment.boundary={boundary}"]).config.segment.boundary == boundary


def test_an_overridden_table_keeps_what_still_acts():
    inherited = {"mode": "voltage", "input_capacitance_pF": 9.0, "low_pass_Hz": 60.0, "filter_order": 2}
    found = Readout.override_keys(inherited, {"mode": "charge", "feedback_pF": 100.0})
    assert found == {"mode": "charge", "feedback_pF": 100.0, "low_pass_Hz": 60.0, "filter_order": 2}
    stated = Readout.override_keys(inherited, {"mode": "charge", "input_capacitance_pF": 1.0})
    assert stated["input_capacitance_pF"] == 1.0  # and so it is refused


CHARGE = {"mode": "charge", "feedback_pF": 100.0}
TWO = [{"name": name, "center_mm": [x, 0.0], "size_mm": [1.0, 2.0]} for name, x in (("a", -0.6), ("b", 0.6))]


@for_each(
    ("name", "component", "parameters"),
    [
        ("parasitic-capacitance", "readout", {"capacitance_pF": 10.0}),
        ("charge-leakage", "readout", {"resistance_MOhm": 10.0}),
        ("charge-leakage", "film", {"resistance_MOhm": 10.0}),
        ("charge-leakage", "channel-2", {"resistance_MOhm": 10.0}),
        ("crosstalk", "channel-1-channel-2", {"capacitance_pF": 10.0}),
    ],
)
def test_what_lies_parallel_to_a_virtual_ground_is_refused(name, component, parameters):
    one = {"name": name, "component": component, "parameters": parameters}
    tables = {"segment": {"film": {"electrodes": TWO}}, "mechanisms": [one]}
    assert Case(**tables, readout={}).model
    with pytest.raises(InputError, match=rf"mechanisms\[0\].component = '{component}': {name} acts only with"):
        _ = Case(**tables, readout=CHARGE).model


def other(value):
    """Another value of a parameter."""
    if isinstance(value, tuple):
        return [other(one) for one in value]
    return value + 1 if isinstance(value, int) else 0.87 * (value or 0.0) + 0.07


def without_names(model):
    return replace(model, mechanisms=())


@for_each("name", MECHANISMS)
def test_each_parameter_of_a_mechanism_changes_the_model_or_is_refused(name):
    kind = MECHANISMS[name]
    base = Case(segment={"film": {"electrodes": TWO}}, readout={}).model
    for component in kind.components[:8]:
        for key in kind.parameters.model_fields:
            try:
                first = Mechanism(name=name, component=component, parameters=kind.example)
                changed = {**kind.example, key: other(getattr(first.values(), key))}
                second = Mechanism(name=name, component=component, parameters=changed)
                one, two = (without_names(with_mechanisms(base, [each])) for each in (first, second))
            except ValueError:
                continue
            assert one != two, (component, key)


@for_each("name", [name for name, kind in MECHANISMS.items() if kind.off is not None and "inf" not in str(kind.off)])
def test_what_is_off_changes_nothing_whatever_else_is_stated(name):
    kind = MECHANISMS[name]
    base = Case(segment={"film": {"electrodes": TWO}}, readout={}).model
    for key in kind.parameters.model_fields:
        values = kind.off if key in kind.off else {**kind.off, key: 0.5}
        tried = {**{one: value for one, value in values.items() if value is not None}, key: values[key]}
        for changed in (tried, {**tried, key: 0.5}, {**tried, key: [0.5]}):
            try:
                one = Mechanism(name=name, component=kind.components[0], parameters=changed)
                on = without_names(with_mechanisms(base, [one]))
            except ValueError:
                continue
            known = "hyperelastic" in name or replace(on, physics=base.physics) == base
            assert not one.is_off or known, changed


SLICE = {"segment": {"section": "plane-strain"}, "dot": {"shape": "ridge"}}
ELECTRODE = {"name": "a", "center_mm": [0.0, 0.1], "size_mm": [1.0, 1.0]}
PATCH = {"name": "delamination", "component": "bond-base", "parameters": {"diameter_mm": 0.4, "center_mm": [0.0, 0.1]}}
COMPLIANT = {"name": "rig-compliance", "component": "rig", "parameters": {"compliance_mm_per_N": 0.1}}
GLUE = {"normal_stiffness_N_per_mm3": 9.0, "shear_stiffness_N_per_mm3": 9.0, "poisson_ratio": 0.3}
IDLE = {
    "dot.offset_mm[1]": {**SLICE, "dot": {"shape": "ridge", "offset_mm": [0.0, 0.1]}},
    "press.path_xy_mm[1][1]": {**SLICE, "press": {"path_xy_mm": [[0.1, 0.0], [0.1, 0.1]]}},
    "segment.film.electrodes[0].center_mm[1]": {
        **SLICE, "segment": {"section": "plane-strain", "film": {"electrodes": [ELECTRODE]}}
    },
    "mechanisms: the delamination of 'bond-base' with center_mm[1]": {**SLICE, "mechanisms": [PATCH]},
    "mechanisms[0].name": {"press": {"force_N": 0.1}, "mechanisms": [COMPLIANT]},
    "mechanisms[0].parameters.poisson_ratio": {
        "mechanisms": [{"name": "adhesive-compliance", "component": "bond-base", "parameters": GLUE}]
    },
}  # fmt: skip


@for_each(("key", "tables"), IDLE.items(), ids=lambda value: str(value)[:60])
def test_a_place_or_a_number_that_changes_nothing_here_is_refused(key, tables):
    with pytest.raises(InputError) as refused:
        _ = Case(**tables).checked_design
    assert str(refused.value).startswith(key)


@for_each(
    ("settings", "said"),
    [
        (["readout.polarity=true"], "readout.polarity = true: must be 1 or -1"),
        (
            ["press.load_steps=2", "press.load_steps=3"],
            "press.load_steps=3: this key, or one inside it, is given before",
        ),
        (["press.load_steps=2", "press={}"], "press={}: this key, or one inside it, is given before"),
        (["array.cell_pitch_mm=6.0"], "array.cell_pitch_mm = 6: acts only with cells above 1, here cells = 1"),
    ],
)
def test_settings_that_are_overridden_or_mean_nothing_are_refused(settings, said):
    with pytest.raises(InputError) as refused:
        _ = Case.load(settings=settings).config
    assert str(refused.value).endswith(said if "before" not in said else f"{said}; state each once")


def test_the_time_of_a_rise_beside_a_file_acts_only_where_it_starts_pressed(tmp_path):
    for first in (0.0, 0.5):
        (tmp_path / f"{first}.csv").write_text(f"time_s,fraction\n0,{first}\n1,1\n", "utf-8")
        waveform = {"shape": "file", "file": str(tmp_path / f"{first}.csv"), "rise_s": 0.3}
        case = Case(press={"waveform": waveform})
        if first:
            assert case.checked_design
        else:
            with pytest.raises(InputError, match=r"press\.waveform\.rise_s = 0\.3: acts only where the first row"):
                _ = case.checked_design


def test_the_place_of_a_plate_is_told_to_change_nothing():
    told = Case(segment={"boundary": "free"}, dot={"shape": "plate", "offset_mm": [0.1, 0.0]}).checked_design[1]
    assert "dot.offset_mm = [0.1, 0.0]: changes nothing, as a plate has no middle" in told


def test_a_slide_is_looked_at_on_its_whole_way():
    """Over the edge of a free segment it is told, onto a held rim refused; back at its end or not."""
    way = {"path_xy_mm": [[1.2, 0.0], [0.0, 0.0]], "indentation_mm": 0.1}
    free = Case(segment={"boundary": "free"}, press=way)
    assert any("beyond the edge of the segment" in one for one in free.checked_design[1])
    with pytest.raises(InputError, match="meets the held rim"):
        _ = Case(press=way).checked_design


def test_the_schema_refuses_the_same_keys():
    jsonschema = pytest.importorskip("jsonschema")
    validator = jsonschema.Draft202012Validator(SCHEMA)
    base = config_from(with_default_design({})).model_dump(mode="json", exclude_none=True)
    assert validator.is_valid(base)
    for way, name, table, holds in CONDITIONS:
        stated = copy.deepcopy(base)
        place = stated
        for part in way:
            place = place.setdefault(part, {})
        place.update(table)
        assert holds or not validator.is_valid(stated), (way, name, table)


def test_the_schema_is_of_the_kind_that_it_says_and_allows_its_defaults():
    jsonschema = pytest.importorskip("jsonschema")
    assert jsonschema.validators.validator_for(SCHEMA, default=None) is jsonschema.Draft202012Validator
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    for kind in SCHEMA, *SCHEMA["$defs"].values():
        for name, key in kind.get("properties", {}).items():
            if "default" in key:
                validator = jsonschema.Draft202012Validator({**key, "$defs": SCHEMA["$defs"]})
                assert validator.is_valid(key["default"]), name


def test_a_bench_is_a_configuration_without_a_segment():
    for name, field in Bench.model_fields.items():
        assert field.default == Config.model_fields[name].default
        assert field.annotation == Config.model_fields[name].annotation


def test_hints_are_for_tables_that_there_are():
    for one in NOT_MODELLED:
        way = one.under.split(".") if one.under else []
        tables = [(Config,), *(tables_at(way[: n + 1], Config) for n in range(len(way)))]
        assert all(part in kind.model_fields for part, (kind, *_) in zip(way, tables, strict=False)), one.under


TYPED = {
    ("readout", "feedback_capacitance_pF"): "feedback_pF",
    ("readout", "input_res_MOhm"): "input_resistance_MOhm",
    ("press", "indentation"): "indentation_mm",
    ("segment", "side_stiffness"): "side_stiffness_N_per_mm3",
    ("mesh", "contact_size_mm"): "contact_element_size_mm",
}


@for_each(("typed", "meant"), TYPED.items(), ids=str)
def test_a_hint_is_by_words_and_letters(typed, meant):
    known = {key for table in tables_at(typed[:1], Config) for key in table.model_fields}
    assert nearest_name_hint(typed[1], known) == f"did you mean '{meant}'?"


def test_mistakes_keep_the_indices_of_the_file():
    wrong = [{"name": "friction", "component": place, "parameters": {"coefficient": 0.1}} for place in "abc"]
    right = {"name": "friction", "component": "dot", "parameters": {"coefficient": -1.0}}
    found, _ = mistakes({"mechanisms": [*wrong, right]}, lambda tables: config_from(with_default_design(tables)))
    assert [one.split(" ")[0] for one in found] == [
        *(f"mechanisms[{n}].component" for n in range(3)),
        "mechanisms[3].parameters.coefficient",
    ]


FOLLOWS = {
    "a material without a constant": {"segment": {"medium1": {"material": "x"}}, "materials": {"x": {"model": "yeoh"}}},
    "an effector without a size": {
        "segment": {"effector": {"shape": "dome"}, "held_layers": ["effector"]},
        "mechanisms": [{"name": "property-error", "component": "effector", "parameters": {"modulus_factor": 1.1}}],
    },
    "a dot of no size": {"dot": {"base_diameter_mm": -1.0, "height_mm": 0.5}},
    "a mistyped key that is needed": {"readout": {"mode": "charge", "feedback_capacitance_pF": 1.0}},
    "an electrode without a size": {
        "segment": {"film": {"electrodes": [TWO[0], {"name": "b"}]}},
        "mechanisms": [{"name": "crosstalk", "component": "channel-2", "parameters": {"coupling": 0.1}}],
    },
    "a boundary that is none": {"segment": {"boundary": "fre", "side_stiffness_N_per_mm3": 1.0}},
}


@for_each("tables", FOLLOWS.values(), ids=FOLLOWS)
def test_what_follows_from_a_mistake_is_no_second_one(tables):
    found, _ = mistakes(tables, lambda rest: Case(config_from(with_default_design(rest))).checked_design)
    assert len(found) == 1


def test_what_there_is_not_is_said():
    for one in NOT_MODELLED:
        for word in one.words:
            assert not_modelled(f"{word}_mm", one.under).startswith("not modelled: ")
    for table in tables_at((), Config), *(tables_at(way, Config) for way in TABLES):
        known = [key for kind in table for key in kind.model_fields]
        assert all(nearest_name_hint(key, known) == f"did you mean '{key}'?" for key in known)
    with pytest.raises(InputError, match="not modelled: humidity"):
        Case(mechanisms=[{"name": "humidity", "component": "film"}])


COARSE = {
    "segment": {"section": "plane-strain"},
    "dot": {"shape": "ridge"},
    "press": {"load_steps": 1},
    "mesh": {"mesher": "layered", "element_size_mm": 0.8, "contact_element_size_mm": 0.3},
}


@for_each(("strain", "said"), [(0.15, "largest principal stress"), (-0.15, "largest compressive stress")])
def test_a_film_beyond_its_yield_stress_is_told_whichever_the_sign(strain, said):
    taut = {"name": "film-prestretch", "component": "film", "parameters": {"strain_x": strain}}
    told = Case(**COARSE, mechanisms=[taut]).press().warnings
    assert [one for one in told if said in one and "exceeds its yield stress" in one]


def test_the_order_of_mechanisms_does_not_matter():
    """Of those that do not act on one another, on a coarse slice."""
    coarse = {**COARSE, "readout": {"input_resistance_MOhm": 10.0}}
    every = [
        {"name": "film-prestretch", "component": "film", "parameters": {"strain_x": 0.01, "strain_y": 0.0}},
        {"name": "property-error", "component": "medium2", "parameters": {"modulus_factor": 1.2}},
        {"name": "parasitic-capacitance", "component": "readout", "parameters": {"capacitance_pF": 50.0}},
        {"name": "charge-leakage", "component": "film", "parameters": {"resistance_MOhm": 50.0}},
    ]
    one, other = (Case(**coarse, mechanisms=order).press() for order in (every, every[::-1]))
    np.testing.assert_allclose(one.readout_voltage_V, other.readout_voltage_V, rtol=1e-9)
    np.testing.assert_allclose(one.reaction_force_N, other.reaction_force_N, rtol=1e-9)


@for_each(
    ("tag", "idle", "value"),
    [
        ("mesh.file='slice.msh'", "mesh.element_size_mm", "0.4"),
        ("segment.boundary=free", "segment.held_layers", '["film"]'),
        ("press.waveform.shape=half-sine", "press.waveform.hold_s", "0.5"),
        ("readout.mode=charge", "readout.input_capacitance_pF", "50.0"),
    ],
)
def test_a_setting_leaves_out_what_the_file_states_for_another_mode(tag, idle, value):
    """But what is set beside it stays, and is refused where it does not act, whichever comes first."""
    table, _, key = idle.rpartition(".")
    stated = tomllib.loads(f"[{table}]\n{key} = {value}\n")
    assert key in place(stated, table)
    assert key not in place(with_settings(stated, [tag]), table)
    assert key in place(stated, table)
    for both in permutations([tag, f"{idle}={value}"]):
        assert key in place(with_settings(stated, both), table)


def place(tables, dotted):
    for part in dotted.split("."):
        tables = tables[part]
    return tables
