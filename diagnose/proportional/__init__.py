"""A sensor of unknown geometry as a forward model of a diagnosis: charge in proportion to force, then the amplifier."""

from diagnose.proportional.engine import ProportionalEngine, proportional_engine

__all__ = ["ProportionalEngine", "proportional_engine"]
