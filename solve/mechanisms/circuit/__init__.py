"""Mechanisms of the circuit and of charge that is not the press's: they need no press of their own."""
