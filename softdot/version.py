"""The version of the distribution that is installed."""

from importlib.metadata import PackageNotFoundError, version


def installed_version() -> str:
    """The version of the installed distribution, "unknown" for a bare copy of the sources."""
    try:
        return version("softdot")
    except PackageNotFoundError:
        return "unknown"
