"""A kernel learned from labelled touches of single cells by a sensor of any kind, and what it reads."""
