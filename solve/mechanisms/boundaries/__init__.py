"""Mechanisms at bonds, sides, dot and rig."""
