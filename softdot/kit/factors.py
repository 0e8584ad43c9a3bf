"""Errors of one component at a time: factors of one on its properties, by which a press can be differentiated."""

from softdot.config import Config
from solve.mechanisms import Mechanism

MEDIUM = ("modulus_factor", "thickness_factor")
FACTORS: dict[str, tuple[str, ...]] = {
    "effector": MEDIUM,
    "medium1": MEDIUM,
    "film": (*MEDIUM, "d31_factor"),
    "medium2": MEDIUM,
    "dot": ("radius_factor",),
}


def with_factors(config: Config) -> Config:
    """The same configuration with a property error of every component, all factors one, behind its mechanisms.

    Layers that share a material so get errors of their own.
    """
    added = (
        Mechanism(name="property-error", component=component, parameters=dict.fromkeys(FACTORS[component], 1.0))
        for component in _components(config)
    )
    return config.model_copy(update={"mechanisms": (*config.mechanisms, *added)})


def factor_key(config: Config, component: str, factor: str) -> str:
    """The key of a factor in the configuration that with_factors makes."""
    return f"mechanisms[{len(config.mechanisms) + _components(config).index(component)}].parameters.{factor}"


def _components(config: Config) -> list[str]:
    absent = {"effector"} if config.segment.effector is None else set()
    absent |= {"dot"} if config.dot.shape == "plate" else set()
    return [name for name in FACTORS if name not in absent]
