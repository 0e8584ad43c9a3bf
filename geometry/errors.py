"""The one exception for bad input, shared by every room."""


class InputError(ValueError):
    """One clear sentence: the field, its value and what is allowed. The command line exits with 2."""
