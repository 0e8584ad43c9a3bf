"""The output of commands: summaries, complaints in one sentence, and nothing else on standard output."""

import os
import sys
from argparse import Namespace
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from softdot.json_files import json_text
from softdot.log import warn

LONGEST_SENTENCE = 2000  # characters of a sentence; a path may have some
GOOD, BAD_INPUT, NOT_CONVERGED, INTERRUPTED = 0, 2, 3, 130
"""Exit statuses of the commands."""


def show(summary: dict[str, Any], chosen: Namespace, short_text: Callable[[dict[str, Any], str], str]) -> None:
    """Print a summary, as JSON when asked for, else in short; its warnings always go to standard error."""
    warn(summary.get("warnings", []))
    if chosen.json:
        sys.stdout.write(json_text(summary))
    elif not chosen.quiet:
        print(short_text(summary, chosen.output))


def complain(text: str) -> None:
    """Print one sentence on standard error, of a bounded length whatever the text that it quotes."""
    line = " ".join(text.split())
    print("softdot:", line if len(line) <= LONGEST_SENTENCE else f"{line[: LONGEST_SENTENCE - 3]}...", file=sys.stderr)


@contextmanager
def only_the_summary_on_stdout() -> Iterator[None]:
    """Send what compiled libraries print to standard error while the pipeline runs."""
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)
