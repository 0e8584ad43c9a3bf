"""The callback by which long work reports its progress."""

from collections.abc import Callable

Report = Callable[[str, int, int], None]
"""Called with the name of the work, the number of pieces that are done, and that of all pieces."""
