"""Designs to start from: each states its difference to the default design, and its first comment describes it."""
