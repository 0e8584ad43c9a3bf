"""What a command says besides how far it is."""

import re

PROGRESS = re.compile(r" *\d+\.\d s  ")


def complaints(stderr: str) -> str:
    """Standard error without the lines of progress: warnings and errors."""
    return "".join(line for line in stderr.splitlines(keepends=True) if not PROGRESS.match(line))
