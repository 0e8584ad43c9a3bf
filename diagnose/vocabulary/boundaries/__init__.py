"""Candidates at bonds, sides, dot and rig."""
