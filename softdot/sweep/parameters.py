"""What SPACE.toml says of the sweep itself: the table [sweep]."""

from typing import Annotated, Any, Literal, Self

from pydantic import Field, field_validator, model_validator

from geometry.parameters import Finite, Table
from softdot.dotted_keys import parsed

MOST_POINTS = 20_000
Count = Annotated[int, Field(ge=1, le=MOST_POINTS)]


class Axis(Table):
    """One direction of the space: a key, or several that always have the same value, and its values."""

    key: str | None = Field(None, description="dotted key, such as segment.medium1.thickness_mm")
    keys: tuple[str, ...] = Field((), description="instead of key: several keys that get the same value")
    values: tuple[Any, ...] | None = Field(None, description="the values: numbers, strings, lists or tables")
    low: Finite | None = Field(None, description="instead of values: smallest value")
    high: Finite | None = Field(None, description="largest value")
    n: Annotated[int, Field(ge=2, le=MOST_POINTS)] | None = Field(None, description="grid: values from low to high")
    scale: Literal["linear", "log"] = Field("linear", description="how the values from low to high are spaced")

    @field_validator("key", "keys")
    @classmethod
    def _readable(cls, given: Any) -> Any:
        for key in [given] if isinstance(given, str) else given or ():
            try:
                parsed(key)
            except ValueError as error:
                raise ValueError(str(error) if key == given else f"'{key}' {error}") from None
        return given

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if (self.key is None) == (not self.keys):
            raise ValueError("key is missing" if self.key is None else "keys: give either key or keys, not both")
        if self.values is not None:
            self._require_values_alone()
        elif self.low is None or self.high is None:
            missing = "values" if self.low is None and self.high is None else "low" if self.low is None else "high"
            raise ValueError(f"{missing} is missing: an axis needs values, or low and high")
        elif self.low >= self.high:
            raise ValueError(f"low = {self.low:g}: must be below high = {self.high:g}")
        elif self.scale == "log" and self.low <= 0:
            raise ValueError(f"low = {self.low:g}: must be above 0 with scale = 'log'")
        return self

    def _require_values_alone(self) -> None:
        if not self.values:
            raise ValueError("values = []: must have at least 1 value")
        for name in ("low", "high", "n"):
            if getattr(self, name) is not None:
                raise ValueError(f"{name} = {getattr(self, name):g}: give either values or low and high, not both")

    def names(self) -> tuple[str, ...]:
        """The keys that this axis sets."""
        return self.keys if self.key is None else (self.key,)


class Sweep(Table):
    """How the space is sampled."""

    sampling: Literal["grid", "list", "latin-hypercube", "sobol"] = Field(
        "grid", description="grid: every combination; list: first values together, second values together, …"
    )
    points: Count | None = Field(None, description="latin-hypercube and sobol: number of points")
    seed: int = Field(0, ge=0, description="of latin-hypercube and sobol")
    workers: Annotated[int, Field(ge=1, le=1024)] | None = Field(
        None, description="processes on this computer; none: one per core"
    )
    axes: tuple[Axis, ...] = Field(min_length=1, description="what varies")

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        random = self.sampling in ("latin-hypercube", "sobol")
        if random and self.points is None:
            raise ValueError(f"points is missing: sampling = '{self.sampling}' needs the number of points")
        if not random and self.points is not None:
            raise ValueError(f"points = {self.points}: the axes of sampling = '{self.sampling}' say how many there are")
        for number, axis in enumerate(self.axes):
            self._require_fitting(axis, f"axes[{number}]")
        self._require_apart()
        return self

    def _require_fitting(self, axis: Axis, name: str) -> None:
        """An axis says as many values as the sampling needs, no more."""
        if self.sampling == "grid" and axis.values is None and axis.n is None:
            raise ValueError(f"{name}.n is missing: a grid needs the number of values from low to high")
        if self.sampling != "grid" and axis.n is not None:
            raise ValueError(f"{name}.n = {axis.n}: is for sampling = 'grid' only")
        if self.sampling != "list":
            return
        if axis.values is None:
            raise ValueError(f"{name}.values is missing: sampling = 'list' needs the values themselves")
        first = self.axes[0].values or ()
        if len(axis.values) != len(first):
            raise ValueError(
                f"{name}.values has {len(axis.values)} values but axes[0].values has {len(first)}: "
                "one of each per point"
            )

    def _require_apart(self) -> None:
        """No key is set twice, and none lies inside another one."""
        ways = [(key, parsed(key)) for axis in self.axes for key in axis.names()]
        for number, (key, way) in enumerate(ways):
            for other, before in ways[:number]:
                shorter = min(len(way), len(before))
                if way[:shorter] == before[:shorter]:
                    raise ValueError(f"axes: '{other}' and '{key}' set the same key; remove one of them")
