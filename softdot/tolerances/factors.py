"""Property errors of a component as factors of the configuration: a modulus or a thickness off its nominal value."""

from geometry.parameters import SIZED_DOTS
from softdot.config.schema import Config
from solve.mechanisms import Mechanism
from solve.mechanisms.layers.property_error import PROPERTY_ERROR

MEDIUM = ("modulus_factor", "thickness_factor")
"""Factors of a layer."""
FACTORS: dict[str, tuple[str, ...]] = {
    "effector": MEDIUM,
    "medium1": MEDIUM,
    "film": (*MEDIUM, "d31_factor"),
    "medium2": MEDIUM,
    "dot": ("radius_factor",),
}
"""Component -> its factors of a property error."""


def with_factors(config: Config) -> Config:
    """The configuration with a property error of every component, all factors one, behind its mechanisms.

    Layers that share a material so get errors of their own.
    """
    added = (
        Mechanism(name=PROPERTY_ERROR.name, component=component, parameters=dict.fromkeys(FACTORS[component], 1.0))
        for component in _components(config)
    )
    return config.model_copy(update={"mechanisms": (*config.mechanisms, *added)})


def factor_key(config: Config, component: str, factor: str) -> str:
    """The key of a factor in the configuration that with_factors makes."""
    return f"mechanisms[{len(config.mechanisms) + _components(config).index(component)}].parameters.{factor}"


def has_component(config: Config, component: str) -> bool:
    """Whether a configuration has a component that FACTORS names, with sizes of its own."""
    if component == "effector":
        return config.segment.effector is not None
    return component != "dot" or config.dot.shape in SIZED_DOTS


def _components(config: Config) -> list[str]:
    """The names of the components in FACTORS that a configuration has."""
    return [name for name in FACTORS if has_component(config, name)]
