"""The gallery: every example with its first comment, its picture and the whole file."""

from pathlib import Path

HEAD = """# Gallery

Every file is complete: `softdot run examples/NAME.toml -o out` runs it, `softdot sweep` the one with a table `[sweep]`,
`softdot array` the one with a table `[array]`. [Examples](../examples/README.md) gives a number for each design,
[Mechanisms](mechanisms.md) the equations and the source of each piece of physics.
"""
CHAPTERS = {"Designs": "examples", "Mechanisms and materials": "examples/mechanisms"}
# The pictures of mechanisms have the names of their files; those of designs were made for other documents.
DESIGNS = {"true-segment": "deformed.png", "braille-cell-wide": "braille-cell.png"}


def page(root: Path) -> str:
    """The text of the page, in Markdown, from the examples of the repository at root."""
    files = {title: sorted((root / folder).glob("*.toml")) for title, folder in CHAPTERS.items()}
    chapters = [_chapter(root, title, found) for title, found in files.items()]
    return "\n".join([HEAD, _overview(root, [file for found in files.values() for file in found]), *chapters])


def _overview(root: Path, files: list[Path]) -> str:
    """All pictures side by side, each leading to its section."""
    cards = [
        f"- [![{file.stem}]({_picture(root, file)}){{ loading=lazy }}<br>{file.stem}](#{file.stem})\n"
        for file in files
        if _picture(root, file)
    ]
    return "\n".join(['<div class="grid cards gallery" markdown>\n', *cards, "</div>\n"])


def _chapter(root: Path, title: str, files: list[Path]) -> str:
    return "\n".join([f"## {title}\n", *(_section(root, file) for file in files)])


def _section(root: Path, file: Path) -> str:
    """One example: what to look at, the picture, a link, the file."""
    name, text, picture = file.relative_to(root).as_posix(), file.read_text("utf-8"), _picture(root, file)
    parts = [f"### {file.stem}", first_comment(text)]
    if picture:
        parts.append(f"![{file.stem}]({picture}){{ loading=lazy }}")
    folded = "\n".join("    " + line for line in text.splitlines())
    parts.append(f'??? example "{name}"\n\n    [Open the file](../{name})\n\n    ```toml\n{folded}\n    ```')
    return "\n\n".join(parts) + "\n"


def _picture(root: Path, file: Path) -> str | None:
    """The picture of an example as seen from docs/, None where there is none."""
    name = f"pictures/mechanisms/{file.stem}.png"
    if file.parent.name != "mechanisms":
        name = f"pictures/{DESIGNS[file.stem]}" if file.stem in DESIGNS else ""
    return name if name and (root / "docs" / name).is_file() else None


def first_comment(toml: str) -> str:
    """The comment at the top of a file, without its marks."""
    lines = []
    for line in toml.splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# "))
    return "\n".join(lines)
