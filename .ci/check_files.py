"""Checks of files before a commit: python .ci/check_files.py toml|yaml|end FILE...

toml, yaml : whether the file can be read. end : whether a text ends with exactly one end of line.
"""

import sys
import tomllib
from pathlib import Path


def toml(content: bytes) -> None:
    """ValueError for what is no TOML."""
    tomllib.loads(content.decode())


def yaml(content: bytes) -> None:
    """ValueError for what is no YAML. Tags are not looked at: mkdocs.yml names functions of its extensions."""
    import yaml  # type: ignore[import-untyped]

    try:
        list(yaml.parse(content))
    except yaml.YAMLError as error:
        raise ValueError(str(error)) from None


def end(content: bytes) -> None:
    """ValueError for a text whose last line does not end, or is empty."""
    if content and (not content.endswith(b"\n") or content.endswith(b"\n\n")):
        raise ValueError("must end with exactly one end of line")


def main(kind: str, files: list[str]) -> int:
    """Say what is wrong with which file; the exit status."""
    bad = 0
    for file in files:
        try:
            {"toml": toml, "yaml": yaml, "end": end}[kind](Path(file).read_bytes())
        except ValueError as error:
            print(f"{file}: {error}")
            bad = 1
    return bad


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
