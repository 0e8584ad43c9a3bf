"""Studies lie apart from the product: only the command that shows one imports it."""

import ast
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGES = ("foundation", "geometry", "mesh", "solve", "export", "diagnose", "softdot")
COMMANDS = {"softdot/commands/paper.py", "softdot/commands/prove.py"}


def imports_a_study(path):
    """Whether a file imports from softdot.studies, inside functions too."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom):
            names = [node.module or "", *(f"{node.module}.{alias.name}" for alias in node.names)]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            continue
        if any(f"{name}.".startswith("softdot.studies.") for name in names):
            return True
    return False


def test_only_its_command_imports_a_study():
    files = [path for top in PACKAGES for path in sorted((ROOT / top).rglob("*.py"))]
    product = [path for path in files if not path.is_relative_to(ROOT / "softdot" / "studies")]
    found = {path.relative_to(ROOT).as_posix() for path in product if imports_a_study(path)}
    assert found <= COMMANDS
