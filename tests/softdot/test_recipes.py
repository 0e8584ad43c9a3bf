"""The recipes of CONTRIBUTING.md, applied to a copy of the source, do what they promise."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
RECIPES = dict(re.findall(r"^### (.+?)\n(.*?)(?=^### |\Z)", TEXT, re.DOTALL | re.MULTILINE))
BLOCK = re.compile(r"^```(?:python|toml)\n# (.+?)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
LEFT_OUT = shutil.ignore_patterns("*.pyc.*", "*.tmp.*")  # what is compiled stays, else it takes 20 s again
PACKAGES = ("foundation", "geometry", "mesh", "solve", "export", "diagnose", "softdot")


def apply(folder: Path, where: str, text: str) -> None:
    """Put a block where its first line says."""
    name, _, place = where.partition(": ")
    path = folder / name
    if place == "new file":
        assert not path.exists()
        path.write_text(text, "utf-8")
        return
    source = path.read_text("utf-8")
    if place == "at the end":
        path.write_text(source + text, "utf-8")
        return
    kind, quoted = re.fullmatch(r"(before|in place of) \"(.*)\"", place).groups()
    assert source.count(quoted) == 1
    new = f"{text}\n\n{quoted}" if kind == "before" else text.removesuffix("\n")
    path.write_text(source.replace(quoted, new), "utf-8")


@pytest.mark.process
@pytest.mark.parametrize("name", RECIPES)
def test_a_recipe_works(name, tmp_path):
    program, here = tmp_path / "program", tmp_path / "here"
    here.mkdir()
    for package in PACKAGES:
        shutil.copytree(ROOT / package, program / package, ignore=LEFT_OUT)
    blocks = BLOCK.findall(RECIPES[name])
    checks = [text for where, text in blocks if where == "check"]
    for where, text in blocks:
        if where != "check":
            apply(program, where, text)
    assert len(checks) == 1
    assert len(blocks) > 1
    environment = {**os.environ, "PYTHONPATH": str(program), "SOFTDOT_CACHE": str(tmp_path / "cache")}
    ended = subprocess.run(
        [sys.executable, "-c", checks[0]], cwd=here, env=environment, capture_output=True, encoding="utf-8", check=False
    )
    assert ended.returncode == 0, ended.stderr[-2000:]


def test_there_is_a_recipe_for_each_thing_that_is_added_often():
    often = ["mechanism", "mechanism", "material", "export", "Braille", "converter", "command", "decoder"]
    assert [name.split()[1] for name in RECIPES] == often
