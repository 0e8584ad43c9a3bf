"""The one exception for bad input."""


class InputError(ValueError):
    """One clear sentence: the field, its value and what is allowed. The command line exits with 2."""
