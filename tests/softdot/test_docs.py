"""The documents keep step with the program, and their links lead somewhere."""

import json
import re
import tomllib
from importlib import import_module
from pathlib import Path

from pydantic import TypeAdapter

import docs.make_configuration as maker
import geometry.array.parameters
import geometry.fabrication.parameters
import geometry.parameters
import solve.materials.parameters
import solve.mechanisms
import solve.model
from softdot.commands.new import config_schema
from softdot.config.default_design import with_default_design
from softdot.config.loading import config_from
from softdot.config.model import model_of
from softdot.config.schema import Config
from softdot.summary import heading, mesh_part, press_part
from solve.readout.course import course
from tests.cases import for_each
from tests.softdot.stand_ins import result_of

ROOT = Path(__file__).parents[2]
DOCUMENTS = sorted(
    [
        *(ROOT / "docs").glob("*.md"),
        *(ROOT / "docs").glob("*/*.md"),
        *ROOT.glob("*.md"),
        ROOT / "examples" / "README.md",
    ]
)
SOURCES = (
    "foundation",
    "geometry",
    "mesh",
    "solve",
    "export",
    "diagnose",
    "softdot",
    "docs",
    "tests",
    "examples",
    "benchmarks",
)
HOMES = (
    geometry.parameters, geometry.array.parameters, geometry.fabrication.parameters, import_module("mesh.build"),
    solve.model, solve.mechanisms, solve.materials.parameters,
)  # fmt: skip
EXAMPLES = tomllib.loads((ROOT / "docs" / "configuration_examples.toml").read_text("utf-8"))


@for_each("file", ["candidates.md", "configuration.md", "geometry.md", "kit_parts.md", "mechanisms.md"])
def test_generated_text_is_in_step(file):
    assert (ROOT / "docs" / file).read_text("utf-8") == maker.pages()[file]


def test_every_table_of_the_schema_has_its_section():
    assert set(maker.TABLES.values()) == {"Config", *config_schema()["$defs"]}


@for_each("table", EXAMPLES)
def test_every_example_is_allowed(table):
    model = Config if table == "Config" else next(getattr(h, table) for h in HOMES if hasattr(h, table))
    for key, value in EXAMPLES[table].items():
        if key == "include":  # gone once a file is read
            continue
        adapter = TypeAdapter(model.model_fields[key].rebuild_annotation())
        adapter.validate_json(json.dumps(value), strict=True)


def test_every_plain_key_has_an_example():
    schema = config_schema()
    tables = {**schema["$defs"], "Config": schema}
    missing = [
        f"{name}.{key}"
        for name, table in tables.items()
        for key, value in table["properties"].items()
        if key not in EXAMPLES[name] and "$ref" not in json.dumps(value)
    ]
    assert missing == []


def toml_blocks():
    """Configurations; those of CONTRIBUTING.md are pieces of the program's own tables."""
    text = "".join(path.read_text("utf-8") for path in DOCUMENTS if path.name != "CONTRIBUTING.md")
    return re.findall(r"```toml\n(.*?)```", text, re.DOTALL)


def test_every_whole_file_that_is_shown_is_accepted():
    assert [config_from(with_default_design(tomllib.loads(block))) for block in toml_blocks()] != []


def test_every_key_of_the_summary_is_explained():
    config = config_from(with_default_design(tomllib.loads(toml_blocks()[0])))
    history = result_of([0.0, 0.15, 0.3])
    model = model_of(config)
    along = course(history, model.press, model.amplifier, model.physics)
    summary = {**heading(config), **press_part(model, history, along), "mesh": mesh_part({}, 1)}
    flat = [
        f"{key}.{inner}" if isinstance(value, dict) and key != "config" else key
        for key, value in summary.items()
        for inner in (value if isinstance(value, dict) else [""])
    ]
    text = (ROOT / "docs" / "export.md").read_text("utf-8")
    assert [key for key in flat if f"`{key}" not in text] == []


@for_each("path", DOCUMENTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_relative_links_resolve(path):
    targets = re.findall(r"\]\(([^)\s]+)\)", path.read_text("utf-8"))
    broken = [target for target in targets if not _resolves(path, target)]
    assert broken == []


def _resolves(path, target):
    if target.startswith(("https://", "http://")):
        return True
    file, _, anchor = target.partition("#")
    found = path.parent / file if file else path
    return found.exists() and (not anchor or anchor in _anchors(found))


def _anchors(path):
    """Anchors as GitHub makes them from headings."""
    headings = re.findall(r"^#+ (.+)$", path.read_text("utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@for_each("path", DOCUMENTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_named_source_files_exist(path):
    named = re.findall(r"`((?:geometry|mesh|solve|export|softdot|docs|tests)/[\w./]+\.\w+)`", path.read_text("utf-8"))
    to_be_measured = {"docs/verification.md", "docs/_site/index.html"}  # the last one is built
    assert [name for name in named if name not in to_be_measured and not (ROOT / name).exists()] == []
    bare = re.findall(r"`(\w+\.py)`", path.read_text("utf-8"))
    known = {file.name for top in SOURCES for file in (ROOT / top).rglob("*.py")} | {"strip.py"}  # made in the tutorial
    assert [name for name in bare if name not in known] == []


@for_each("path", DOCUMENTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_math_survives_markdown(path):
    text = re.sub(r"```.*?```|`[^`\n]*`", "", path.read_text("utf-8"), flags=re.DOTALL)
    assert text.count("$$") % 2 == 0
    inline = re.sub(r"\$\$.*?\$\$", "", text, flags=re.DOTALL)
    assert [line for line in inline.splitlines() if line.count("$") % 2] == []
    formulas = re.findall(r"\$\$.*?\$\$|\$[^$\n]+\$", text, flags=re.DOTALL)
    # Markdown takes a backslash before punctuation for an escape and eats it
    assert [formula for formula in formulas if re.search(r"\\[^A-Za-z]", formula)] == []
