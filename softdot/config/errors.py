"""The mistake in a configuration, in a sentence: the dotted key, its value, and the allowed values."""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, get_args

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from foundation.errors import InputError
from foundation.nearest_name import nearest_name_hint
from geometry.parameters import Table
from softdot.config.not_modelled import not_modelled

BOUNDS = {
    "greater_than": ("gt", "above"),
    "greater_than_equal": ("ge", "at least"),
    "less_than": ("lt", "below"),
    "less_than_equal": ("le", "at most"),
}
"""Kind of a pydantic error about a number -> the bound in its context, and the word for it."""
LENGTHS = {"too_short": ("min_length", "at least"), "too_long": ("max_length", "at most")}
"""Kind of a pydantic error about a list -> the length in its context, and the word for it."""
REQUIREMENTS = {
    "float_type": "must be a plain number; its unit is part of the key",
    "float_parsing": "must be a plain number; its unit is part of the key",
    "int_type": "must be a whole number",
    "int_parsing": "must be a whole number",
    "int_from_float": "must be a whole number",
    "finite_number": "must be a finite number",
    "bool_type": "must be true or false, without quotes",
    "string_type": "must be a text in quotes",
    "tuple_type": "must be a list in square brackets",
    "dict_type": "must be a table",
    "model_type": "must be a table",
    "model_attributes_type": "must be a table",
}
"""Kind of any other pydantic error -> the requirement on a value, in words."""


def sentence(error: ValidationError, tables: Mapping[str, Any], model: type[Table]) -> str:
    """One sentence on the most telling problem: a mistyped key first, a missing one last."""
    rank = {"extra_forbidden": 0, "missing": 2}
    problems = sorted(error.errors(include_url=False), key=lambda p: rank.get(p["type"], 1))
    choices = [p["ctx"]["expected"] for p in problems if p["type"] == "literal_error" and _same_value(p, problems[0])]
    said = _explain(problems[0], tables, model, choices)
    hint = not_modelled(*_unknown_word(problems[0]))
    return f"{said}; {hint}" if hint else said


def _unknown_word(problem: ErrorDetails) -> tuple[str, str]:
    """The key or the value that the schema does not know, and the dotted key of its table."""
    *table, last = problem["loc"] or ("",)
    if problem["type"] == "extra_forbidden":
        return str(last), dotted_key(table)
    if problem["type"] == "literal_error":
        return str(problem["input"]), dotted_key(table)
    unknown = re.match("name = '(.*?)'", str(problem.get("ctx", {}).get("error", "")))
    return (unknown[1] if unknown else ""), dotted_key(problem["loc"])


def _same_value(one: ErrorDetails, other: ErrorDetails) -> bool:
    """Whether both are members of one union that refuse the same value."""
    return one["loc"][:-1] == other["loc"][:-1] and one["input"] == other["input"]


def _explain(problem: ErrorDetails, tables: Mapping[str, Any], model: type[Table], choices: Sequence[str]) -> str:
    """The sentence for one problem, without the hint at what is not modelled."""
    kind, context = problem["type"], problem.get("ctx", {})
    path = _path_in_tables(problem["loc"], tables, kind)
    key = dotted_key(path)
    if kind == "extra_forbidden":
        known = {name for table in tables_at(problem["loc"][:-1], model) for name in table.model_fields}
        return f"{key} is not a key; {_suggestion(path, known, model)}"
    if kind == "missing":
        return f"{key} is missing{_missing_key_description(problem['loc'], model)}"
    if kind == "value_error":
        return _own_message(key, problem, model)
    if kind == "union_tag_invalid":
        tag = str(context["tag"])
        known = {name.strip(" '") for name in str(context["expected_tags"]).split(",")}
        return f"{key}.model = '{tag}': {nearest_name_hint(tag, known)}"
    if kind == "literal_error":
        return f"{key} = {value_text(problem['input'])}: must be {_alternatives(choices)}"
    if kind in BOUNDS:
        name, word = BOUNDS[kind]
        return f"{key} = {value_text(problem['input'])}: must be {word} {context[name]:g}"
    if kind in LENGTHS:
        name, word = LENGTHS[kind]
        return f"{key} = {value_text(problem['input'])}: must have {word} {_value_count(context[name])}"
    text = REQUIREMENTS.get(kind, problem["msg"][:1].lower() + problem["msg"][1:])
    return f"{key} = {value_text(problem['input'])}: {text}"


def _suggestion(path: Sequence[str | int], known: set[str], model: type[Table]) -> str:
    """A hint at the key that was probably meant; a table of the segment may stand outside it by mistake."""
    name = str(path[-1])
    inner = {key for table in tables_at(("segment",), model) for key in table.model_fields}
    if len(path) == 1 and name in inner:
        return f"did you mean 'segment.{name}'?"
    text = nearest_name_hint(name, known)
    same = next((key for key in known if f"'{key}'" in text and _unitless(key) == _unitless(name)), name)
    return text if same == name or _unitless(name) == name else f"{text} (mind the other unit)"


def _unitless(key: str) -> str:
    """A key without the unit at its end: thickness_um -> thickness."""
    return re.sub(r"_(mm|um|deg|pF|MOhm|Hz|MPa|kPa|GPa|Pa|m|cm|V|mV|N|mN|s|ms)$", "", key)


def _own_message(key: str, problem: ErrorDetails, model: type[Table]) -> str:
    """The sentence for an error of our own validators: about a value, about a key in a table, or about the whole."""
    text = str(problem["ctx"]["error"])
    if not isinstance(problem["input"], dict):
        return f"{key} = {value_text(problem['input'])}: {text}"
    if not key:
        return text
    names = {name for table in tables_at(problem["loc"], model) for name in table.model_fields}
    first = re.split(r"[\s.:\[]", text, maxsplit=1)[0]
    return f"{key}.{text}" if first in names else f"{key}: {text}"


def _value_count(count: int) -> str:
    """The words for a number of values: 1 -> '1 value', 2 -> '2 values'."""
    return f"{count} value" if count == 1 else f"{count} values"


def _alternatives(choices: Sequence[str]) -> str:
    """Alternatives joined in words: ["'a' or 'b'", "'c'"] -> "'a', 'b' or 'c'"."""
    words = [word for choice in choices for word in re.split(r", | or ", choice)]
    return " or ".join([*([", ".join(words[:-1])] if words[:-1] else []), words[-1]])


def dotted_key(path: Sequence[str | int]) -> str:
    """The dotted key of a path: ('dot', 'offset_mm', 1) -> 'dot.offset_mm[1]'."""
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{abridge(str(part))}" for part in path)
    return text.removeprefix(".")


def _path_in_tables(loc: Sequence[str | int], tables: Any, kind: str) -> list[str | int]:
    """The location of an error without the names of union members, which pydantic puts between the keys."""
    path: list[str | int] = []
    for number, part in enumerate(loc):
        last = number == len(loc) - 1
        try:
            tables = tables[part]
        except (KeyError, IndexError, TypeError):
            if not (last and kind == "missing"):
                continue
        path.append(part)
    return path


def tables_at(loc: Sequence[str | int], model: type[Table]) -> list[type[Table]]:
    """The models that may stand at a location of the configuration."""
    here = [model]
    for part in loc:
        fields = [table.model_fields[part] for table in here if part in table.model_fields]
        tagged = [
            table for table in here if "model" in table.model_fields and table.model_fields["model"].default == part
        ]
        if fields:
            here = [found for field in fields for found in _models_in(field.annotation)]
        elif tagged:
            here = tagged
    return here


def _models_in(annotation: Any) -> list[type[Table]]:
    """The tables among the members of a type annotation."""
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return [annotation]
    return [found for inner in get_args(annotation) for found in _models_in(inner)]


def _missing_key_description(loc: Sequence[str | int], model: type[Table]) -> str:
    """A colon and the description of a missing key, "" where the schema has none."""
    for table in tables_at(loc[:-1], model):
        field = table.model_fields.get(str(loc[-1]))
        if field is not None and field.description:
            return f": {field.description}"
    return ""


def value_text(value: Any) -> str:
    """A value much as TOML writes it, with at most 60 characters."""
    if isinstance(value, str):
        text = f"'{value}'"
    elif isinstance(value, float):
        text = f"{value:g}"
    else:
        text = json.dumps(value, default=str)
    return abridge(text)


def abridge(text: str) -> str:
    """Shorten a text to at most 60 characters, for a message."""
    return text if len(text) <= 60 else f"{text[:57]}..."


LARGEST_NUMBER = 1e12
"""Largest magnitude of a number in a configuration, in the unit of its key; smaller ones than its inverse are
round-off.
"""


def refuse_absurd_numbers(tables: Any) -> None:
    """InputError for a finite number whose magnitude is above LARGEST_NUMBER."""
    for path, number in _numbers_with_paths(tables, ()):
        if LARGEST_NUMBER < abs(number) < float("inf"):
            raise InputError(f"{dotted_key(path)} = {value_text(number)}: must be at most {LARGEST_NUMBER:.0e} in size")


def without_round_off(value: Any) -> Any:
    """The tables with zero for every number below 1e-12 in magnitude: a script that subtracts leaves -1.1e-16."""
    if isinstance(value, dict):
        return {key: without_round_off(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [without_round_off(item) for item in value]
    return 0.0 if isinstance(value, float) and abs(value) < 1.0 / LARGEST_NUMBER else value


def _numbers_with_paths(value: Any, path: tuple[str | int, ...]) -> Iterator[tuple[tuple[str | int, ...], float]]:
    """Numbers of the tables with their paths."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _numbers_with_paths(item, (*path, str(key)))
    elif isinstance(value, list | tuple):
        for index, item in enumerate(value):
            yield from _numbers_with_paths(item, (*path, index))
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield path, value
