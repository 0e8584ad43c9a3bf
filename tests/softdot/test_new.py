"""softdot new: a file that loads as it is, names every key of the schema and stays true when keys change."""

import itertools
import re
import tomllib

import pytest

from softdot.case import Case
from softdot.cli import main
from softdot.command_line.configurations import TEMPLATES
from softdot.commands.new import TABLES, config_schema, template_text
from softdot.config.hashes import config_hash
from softdot.config.loading import config_from, load_config
from tests.cases import for_each


@pytest.mark.parametrize("name", TEMPLATES)
def test_what_is_printed_passes_the_checks_of_a_run(name, tmp_path, capfd):
    assert main(["new", "--template", name]) == 0
    path = tmp_path / "mine.toml"
    path.write_text(capfd.readouterr().out, "utf-8")
    _ = Case.load(path).checked_design
    assert main(["check", str(path), "--quiet"]) == 0


def test_the_default_template_is_the_default_design():
    assert config_hash(config_from(tomllib.loads(template_text("default")))) == config_hash(load_config())


@for_each("name", TEMPLATES)
def test_in_short_it_is_the_same_design(name):
    whole, short = (template_text(name, short) for short in (False, True))
    assert config_hash(config_from(tomllib.loads(short))) == config_hash(config_from(tomllib.loads(whole)))
    assert len(short.splitlines()) < 60
    assert all("#" in line for line in short.splitlines() if " = " in line)


def test_each_template_is_another_design():
    assert len({config_hash(config_from(tomllib.loads(template_text(name)))) for name in TEMPLATES}) == len(TEMPLATES)


@for_each("name", TEMPLATES)
def test_every_key_stands_there_with_its_meaning(name):
    text = template_text(name)
    schema = config_schema()
    definitions = {**schema["$defs"], "Config": schema}
    for title, kind in TABLES.items():
        if title:
            assert re.search(rf"^(# )?\[{re.escape(title)}\]$", text, re.MULTILINE), title
        for key, value in definitions[kind]["properties"].items():
            table = f"[{title}.{key}".replace("[.", "[")
            assert re.search(rf"^(# )?{key} = ", text, re.MULTILINE) or table in text or "materials" in key, key
            if "description" in value and "$ref" not in str(value):
                words = value["description"].split()[:3]
                assert " ".join(words) in re.sub(r"\n#\s+", " ", text), key


def test_what_is_commented_out_can_be_switched_on():
    """Every key with a default, one at a time: the file without that # still loads."""
    lines = template_text("default").splitlines()
    inactive = [n for n, line in enumerate(lines) if re.match(r"# [a-zA-Z0-9_]+ = (?!\.\.\.)", line)]
    headed = [n for n in inactive if not _head(lines, n).startswith("# [")]
    assert len(headed) > 30
    for number in headed:
        text = "\n".join([*lines[:number], lines[number].removeprefix("# "), *lines[number + 1 :]])
        if "acts only" not in _comment(lines, number):
            tables = tomllib.loads(text)
            assert tables.pop("include", []) == []  # gone once a file is read
            config_from(tables)


def _comment(lines, number):
    """What stands above a key."""
    above = itertools.takewhile(
        lambda line: re.match(r"# .*[^=]|#   ", line) and " = " not in line[:40], reversed(lines[:number])
    )
    return " ".join(above)


def _head(lines, number):
    """The table in which a line stands."""
    return next((line for line in reversed(lines[:number]) if re.match(r"(# )?\[+[a-z]", line)), "")
