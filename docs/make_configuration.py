"""Make the tables of the documents from the configuration schema and from the data tables of the program.

Run ``python docs/make_configuration.py`` at the top of the repository after a key, a material or a Braille
standard has changed. It writes the marked blocks of docs/candidates.md, docs/configuration.md, docs/geometry.md,
docs/kit_parts.md, docs/limits.md and docs/mechanisms.md; tests/softdot/test_docs.py fails while they are out of step.
"""

import re
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

DOCS = Path(__file__).resolve().parent
sys.path.insert(0, str(DOCS.parent))  # the rooms of this repository, whatever is installed

from docs.make_candidates import candidate_table  # noqa: E402
from geometry.braille_standards import QUANTITIES, Quantity, standard, standard_names  # noqa: E402
from geometry.fabrication.parameters import (  # noqa: E402
    Fabrication,
    castable_materials,
    recipe_for,
)
from softdot.commands.new import (  # noqa: E402
    acting_condition,
    allowed_values,
    config_schema,
    toml_value,
)
from softdot.config.not_modelled import NOT_MODELLED  # noqa: E402
from solve.materials.parameters import PiezoelectricFilm, library_tables  # noqa: E402
from solve.mechanisms import MECHANISMS  # noqa: E402
from solve.mechanisms.base import in_short  # noqa: E402
from solve.readout.part import Amplifier, amplifier_parts  # noqa: E402

Json = dict[str, Any]

TABLES = {
    "Top level": "Config",
    "`[segment]`": "Segment",
    "`[segment.effector]`": "Effector",
    "`[segment.medium1]` and `[segment.medium2]`": "Medium",
    "`[segment.film]`": "Film",
    "`[[segment.film.electrodes]]`": "Electrode",
    "`[[segment.bonds]]`": "Bond",
    "`[array]`": "Array",
    "`[[array.grooves]]`": "Groove",
    "`[dot]`": "Dot",
    "`[press]`": "Press",
    "`[press.waveform]`": "Waveform",
    "`[readout]`": "Readout",
    "`[readout.amplifier]`": "Amplifier",
    "`[mesh]`": "MeshOptions",
    "`[[mechanisms]]`": "Mechanism",
    "`[fabrication]`": "Fabrication",
    "`[fabrication.casting.NAME]`": "CastingNumbers",
    "`[materials.NAME]`, model `neo-hookean`": "NeoHookean",
    "`[materials.NAME]`, model `linear`": "Linear",
    "`[materials.NAME]`, model `mooney-rivlin`": "MooneyRivlin",
    "`[materials.NAME]`, model `yeoh`": "Yeoh",
    "`[materials.NAME]`, model `knowles`": "Knowles",
    "`[materials.NAME]`, model `ogden`": "Ogden",
    "`[materials.NAME]`, model `hyperfoam`": "Hyperfoam",
    "`[materials.NAME]`, model `piezoelectric-film`": "PiezoelectricFilm",
}
"""Heading -> name of its definition in the schema, in the order of the document."""

MATERIAL = "`[materials.NAME]`"
EVERY_MATERIAL = ("density_kg_m3", "max_fitted_strain", "source", "confidence")
"""What a material of any model may state: it stands once, before the models."""

MATERIAL_NAME = "a [built-in material](#built-in-materials) or the NAME of a `[materials.NAME]`"
HINTS = {
    "Effector.material": MATERIAL_NAME,
    "Medium.material": MATERIAL_NAME,
    "Film.material": f"{MATERIAL_NAME}, of model `piezoelectric-film`",
    "Array.grooves": "tables, one for each layer",
    "Groove.depth_mm": "number above 0 and at most the thickness of the layer",
    "Amplifier.part": "a name of the [built-in amplifiers](#built-in-amplifiers)",
    "Dot.standard": "a name of the [Braille sizes](geometry.md#braille-sizes)",
    "Dot.tilt_deg": "list of 2: number above -90 and below 90, without overlap at rest",
    "Dot.cell": "one character, U+2800 to U+28FF, with `cell_dot` raised",
    "Press.indentation_mm": "number above 0 and below the height of the stack",
    "Fabrication.routes": "a table: `effector`, `medium1` and `medium2`, each `auto`, `cast` or `sheet`",
    "Fabrication.casting": "a table for each material",
    "Mechanism.name": "a name of the [table of mechanisms](mechanisms.md#table)",
    "Mechanism.component": "a component of the same table",
}
"""What is allowed where the schema alone says too little or too much."""


def tables_of_keys() -> str:
    """A section for every table of a configuration, and one each for the built-in amplifiers and materials."""
    schema = config_schema()
    definitions = {**schema["$defs"], "Config": schema}
    examples = _read_toml("configuration_examples.toml")
    parts = []
    for title, name in TABLES.items():
        keys = list(definitions[name]["properties"])
        about = f"{definitions[name].get('description', '').strip()}\n\n" if name != "Config" else ""
        if title.startswith(MATERIAL):
            if name == "NeoHookean":
                common = _keys(title, name, list(EVERY_MATERIAL), definitions, examples[name])
                parts.append(f"## {MATERIAL}, every model\n\n{_common_note()}\n\n{common}")
            keys = [key for key in keys if key not in (*EVERY_MATERIAL, "model")]
        parts.append(f"## {title}\n\n{about}{_keys(title, name, keys, definitions, examples[name])}")
    parts.append(f"## Built-in amplifiers\n\n{AMPLIFIERS_NOTE}\n\n{amplifier_table()}")
    parts.append(f"## Built-in materials\n\n{_materials_note()}\n\n{material_table()}")
    return "\n\n".join(parts)


def _keys(title: str, name: str, keys: list[str], definitions: Json, examples: Json) -> str:
    """The rows of one table of a configuration."""
    table, rows = definitions[name], []
    for key in keys:
        value, required = table["properties"][key], key in table.get("required", [])
        meaning = value.get("description") or _description(value, definitions)
        meaning = "; ".join(part for part in (meaning, acting_condition(value).replace("acts only", "only")) if part)
        bounds = HINTS.get(f"{name}.{key}") or _in_short(allowed_values(value))
        rows.append([f"`{key}`", meaning, _default(title, key, value, required, examples), bounds])
    return _table(["key", "meaning", "default", "allowed"], rows)


def _common_note() -> str:
    return (
        "Beside these, a material states its `model`, one of the following, and the constants of that model. "
        f"Without a density a film has {toml_value(PiezoelectricFilm.model_fields['density_kg_m3'].default)} kg/m³."
    )


def _in_short(bounds: str) -> str:
    """Bounds in the words of a table: 'whole, 1 to 20', 'above 0, at most 100'."""
    short = re.sub(r"number at least (\S+) and at most", r"\1 to", bounds.replace("whole number", "whole, number"))
    return re.sub(r"number (?=above|below|at )", "", short).replace(" and at most", ", at most")


def _description(value: Json, definitions: Json) -> str:
    """What the definition says that a key refers to."""
    return str(definitions[value["$ref"].rpartition("/")[2]]["description"]).rstrip(".").lower()


def _default(title: str, key: str, value: Json, required: bool, examples: Json) -> str:
    """The default, which shows how a value is written; without one an example, or the head of its table."""
    default = None if required else value["default"]
    if isinstance(default, dict) and default:
        return "its own defaults"
    if default not in (None, [], {}):
        return f"`{toml_value(default)}`"
    shown = f"e.g. `{toml_value(examples[key])}`" if key in examples else f"table `{_head(title, key, value)}`"
    return f"{'required' if required else 'none'}, {shown}"


def _head(title: str, key: str, value: Json) -> str:
    """The head of the table of a key."""
    parent = title.strip("[]`") + "." if title.startswith("`") else ""
    head = f"[{parent}{key}{'.my-rubber' if key in ('materials', 'casting') else ''}]"
    return f"[{head}]" if value.get("type") == "array" else head


def _materials_note() -> str:
    return (
        "Defined in `solve/materials/library.toml`. high: read in the source; medium: fitted or secondary; "
        "low: a starting value."
    )


def material_table() -> str:
    """The built-in materials with their constants."""
    about, rows, last = ("model", "source", "confidence"), [], ""
    for name, table in library_tables().items():
        constants = ", ".join(f"{key} {toml_value(value)}" for key, value in table.items() if key not in about)
        source = "the same" if table["source"] == last else table["source"]
        rows.append([f"`{name}`", table["model"], constants, table["confidence"], source])
        last = table["source"]
    return _table(["name", "model", "constants", "confidence", "source"], rows)


AMPLIFIERS_NOTE = (
    "Typical values of data sheets (`solve/readout/parts.toml`, `softdot list amplifiers`). Keys of "
    "`[readout.amplifier]` beside `part` take their place. Without a corner the voltage noise counts as white."
)


def amplifier_table() -> str:
    """The built-in amplifiers with the values of their data sheets."""
    keys = [key for key in Amplifier.model_fields if any(key in part for part in amplifier_parts().values())]
    rows = [
        [f"`{name}`", part["is"], *(f"{part[key]:g}" if key in part else "–" for key in keys), part["source"]]
        for name, part in amplifier_parts().items()
    ]
    return _table(["part", "what it is", *(f"`{key}`" for key in keys), "source"], rows)


def braille_table() -> str:
    """Every standard: minimum, nominal and maximum of every size, with source and confidence."""
    rows = []
    for name in standard_names():
        found = standard(name)
        sizes = [_size(found.quantities[key], found.confidence) for key in QUANTITIES]
        about = f"{found.source}{'; ' + found.note if found.note else ''}"
        rows.append([f"`{name}`", found.title, *sizes, found.confidence, about])
    heads = [key.removesuffix("_mm").replace("_", " ") for key in QUANTITIES]
    return _table(["name", "standard", *heads, "confidence", "source, note"], rows)


def _size(quantity: Quantity, confidence: str) -> str:
    """For example 1.3–**1.5**–1.6; a star marks a nominal that is the middle of the range."""
    text = _range(quantity)
    notes = [quantity.confidence if quantity.confidence != confidence else "", quantity.note]
    more = "; ".join(note for note in notes if note)
    return f"{text} ({more})" if more and text != "–" else text


def _range(quantity: Quantity) -> str:
    low, nominal, high = quantity.minimum_mm, quantity.nominal_mm, quantity.maximum_mm
    if nominal is None:
        return "–" if low is None else f"≥ {low:g}"
    if low == nominal == high:
        return f"**{nominal:g}** exactly"
    before = f"{low:g}–" if low is not None and low < nominal else ""
    after = f"–{high:g}" if high is not None and high > nominal else ""
    star = "\\*" if quantity.nominal_is_middle else ""
    return f"{before}**{nominal:g}**{star}{after}"


def mechanism_table() -> str:
    """Every mechanism name that the schema knows, and where it can act."""
    rows = [[f"`{name}`", ", ".join(in_short(kind.components))] for name, kind in MECHANISMS.items()]
    return _table(["name", "component"], rows)


def with_block(text: str, name: str, block: str) -> str:
    """The text with what stands between the two marks of a block replaced."""
    start, end = f"<!-- {name}: made by docs/make_configuration.py -->", f"<!-- end of {name} -->"
    before, _, rest = text.partition(start)
    _, _, after = rest.partition(end)
    if not rest or end not in text:
        raise ValueError(f"the marks of the block '{name}' are missing")
    return f"{before}{start}\n\n{block}\n\n{end}{after}"


def _table(heads: list[str], rows: list[list[str]]) -> str:
    """A Markdown table; a pipe inside a cell is escaped."""
    escaped = [[cell.replace("|", "\\|") for cell in row] for row in rows]
    first, *others = (f"| {' | '.join(line)} |" for line in (heads, *escaped))
    return "\n".join([first, f"|{'---|' * len(heads)}", *others])


def _read_toml(name: str) -> Json:
    return tomllib.loads((DOCS / name).read_text("utf-8"))


def casting_table() -> str:
    """What can be cast, and from what mix."""
    none, rows = Fabrication(), []
    for name in castable_materials(none):
        recipe = recipe_for(name, none)
        assert recipe is not None
        numbers = (100 * recipe.shrinkage, recipe.density_g_cm3, recipe.pot_life_min, recipe.cure_time_h)
        mix = f"{recipe.parts[0]:g} : {recipe.parts[1]:g} by {recipe.ratio_by}"
        poured = f"`{recipe.name}`" if recipe.name != name else "itself"
        rows.append([f"`{name}`", poured, *(f"{number:g}" for number in numbers), mix, recipe.note or recipe.source])
    heads = ["material", "poured", "shrinkage %", "g/cm³", "pot life min", "cure h", "A : B", "source or note"]
    return _table(heads, rows)


def table_of_nothing() -> str:
    """What this program does not have, as the hints of softdot check say it."""
    return _table(["there is none of", "there is"], [[one.what, one.instead] for one in NOT_MODELLED])


BLOCKS: dict[str, tuple[str, Callable[[], str]]] = {
    "candidates.md": ("table of candidates", candidate_table),
    "configuration.md": ("tables of keys", tables_of_keys),
    "geometry.md": ("Braille table", braille_table),
    "kit_parts.md": ("casting table", casting_table),
    "limits.md": ("table of what there is not", table_of_nothing),
    "mechanisms.md": ("mechanism table", mechanism_table),
}
"""Document -> its generated block."""


def pages() -> dict[str, str]:
    """The text of every document that holds something generated, by file name."""
    made = {}
    for file, (name, block) in BLOCKS.items():
        made[file] = with_block((DOCS / file).read_text("utf-8"), name, block())
    return made


def main() -> None:
    """Write all of them."""
    for file, text in pages().items():
        (DOCS / file).write_text(text, "utf-8")


if __name__ == "__main__":
    main()
