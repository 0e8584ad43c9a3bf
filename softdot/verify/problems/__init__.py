"""The problems, a family in each module."""
