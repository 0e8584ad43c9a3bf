"""What rig.toml says beside the configuration: the runs and, for a coupon test, the specimen."""

from collections.abc import Mapping
from pathlib import PurePath
from typing import Any, Literal

from pydantic import Field, field_validator

from geometry.base import nearest
from geometry.parameters import Finite, Positive, Table

FORMAT = "softdot-recording/1"
PARTS = ("effector", "medium1", "film", "medium2", "specimen")
NUISANCES = frozenset(
    {"gain", "force_gain", "lag_s", "clock_ratio", "offset_V", "offset_N", "offset_mm", "d31"}
    | {f"{quantity}.{part}" for quantity in ("modulus", "thickness") for part in PARTS}
)
Drive = Literal["displacement_mm", "force_N"]


class RunTable(Table):
    """One file of samples and what the experimenter believes of it."""

    file: str = Field(description="CSV file in the folder of rig.toml")
    label: str | None = Field(None, description="name in the report; none: the name of the file")
    drive: Drive = Field("displacement_mm", description="which measured column drives the simulation")
    dot_offset_mm: tuple[Finite, Finite] = Field((0.0, 0.0), description="position of the dot, x and y")
    temperature_C: Finite | None = Field(None, description="room temperature during this run")
    readout: dict[str, Any] = Field({}, description="keys of [readout] that differ in this run")
    nuisance: dict[str, Positive] = Field(
        {}, description="nuisance parameters, which are no missing physics, each with its standard deviation"
    )
    noise: dict[str, Positive] = Field(
        {}, description="column and standard deviation of its white noise, where neither rest nor repeated runs show it"
    )

    @field_validator("file")
    @classmethod
    def _inside(cls, value: str) -> str:
        """A recording is whole in its folder, and names no other file of the machine."""
        parts = PurePath(value.replace("\\", "/")).parts
        if not parts or PurePath(value).is_absolute() or ".." in parts or ":" in parts[0]:
            raise ValueError("must be the name of a file in the folder of rig.toml or in a folder below it")
        return value

    @field_validator("nuisance", mode="before")
    @classmethod
    def _flat(cls, value: Any) -> Any:
        """modulus.medium1 = 0.1 is a table in a table to TOML."""
        flat = _flattened(value) if isinstance(value, Mapping) else value
        for name in flat if isinstance(flat, Mapping) else ():
            if name not in NUISANCES:
                raise ValueError(f"'{name}' is not a nuisance parameter; {nearest(name, NUISANCES)}")
        return flat

    @property
    def name(self) -> str:
        """Label, or the name of the file without its ending."""
        return self.label if self.label is not None else self.file.rpartition("/")[2].removesuffix(".csv")


class Specimen(Table):
    """A coupon of one material, uniformly deformed."""

    kind: Literal["tension", "compression", "shear"] = Field(
        description="tension: a strip pulled along its length; compression: a block pressed through its thickness; "
        "shear: a layer between plates that move along its length"
    )
    material: str = Field(description="name of a material")
    length_mm: Positive = Field(description="tension: free length between the grips; otherwise the size along x")
    width_mm: Positive = Field(description="size along y")
    thickness_mm: Positive = Field(description="thickness of the strip, block or layer")

    @property
    def gauge_mm(self) -> float:
        """Length by which a displacement is divided for the nominal strain."""
        return self.length_mm if self.kind == "tension" else self.thickness_mm

    @property
    def area_mm2(self) -> float:
        """Area by which a force is divided for the nominal stress."""
        return self.width_mm * (self.thickness_mm if self.kind == "tension" else self.length_mm)


class RigTables(Table):
    """rig.toml without the configuration."""

    format: Literal["softdot-recording/1"] = Field(description="format of this file")
    geometry: Literal["known", "unknown"] = Field(
        "known", description="unknown: there is no [segment] and no 3D model; the charge is proportional to the force"
    )
    runs: tuple[RunTable, ...] = Field(description="one table per file")
    specimen: Specimen | None = Field(None, description="a coupon in place of [segment]")

    @field_validator("runs")
    @classmethod
    def _some(cls, runs: tuple[RunTable, ...]) -> tuple[RunTable, ...]:
        if not runs:
            raise ValueError("must hold at least one table")
        return runs


def _flattened(table: Mapping[str, Any]) -> dict[str, Any]:
    """{"modulus": {"medium1": 0.1}} -> {"modulus.medium1": 0.1}."""
    flat: dict[str, Any] = {}
    for name, value in table.items():
        inner = _flattened(value) if isinstance(value, Mapping) else None
        flat |= {name: value} if inner is None else {f"{name}.{key}": item for key, item in inner.items()}
    return flat
