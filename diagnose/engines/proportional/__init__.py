"""Sensors of unknown geometry: charge in proportion to the measured force."""
