"""The forward model of a rig whose segment is known: tables pressed by the 3D model, read in milliseconds."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from diagnose.engines.segment.engine import SegmentEngine, segment_engine

__all__ = ["SegmentEngine", "segment_engine"]


def __getattr__(name: str) -> Any:
    """The engine is imported when it is asked for: a worker needs only its presses."""
    if name not in __all__:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    from diagnose.engines.segment import engine

    return getattr(engine, name)
