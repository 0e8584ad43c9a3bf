"""The [mesh] table of the configuration: element sizes and the mesher."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field

from geometry.parameters import ABSENT, ActsWith, Positive, Table

WITHOUT_FILE = ActsWith(file=ABSENT)
WITH_PYTETWILD = ActsWith(mesher=("pytetwild",))


class MeshOptions(Table):
    """Element sizes and the mesher."""

    element_size_mm: Annotated[Positive, WITHOUT_FILE] = Field(
        0.3, description="edge length away from contact and film"
    )
    contact_element_size_mm: Annotated[Positive, WITHOUT_FILE] = Field(0.1, description="edge length under the dot")
    film_element_size_mm: Annotated[Positive | None, WITHOUT_FILE] = Field(
        None, description="edge length on the film; none: geometric mean of the two"
    )
    accuracy_percent: Annotated[Annotated[float, Field(ge=0.4, le=20.0)] | None, WITHOUT_FILE] = Field(
        None, description="all sizes are scaled together until force and voltages are so accurate; none: as stated"
    )
    mesher: Annotated[Literal["pytetwild", "layered"], WITHOUT_FILE] = Field(
        "pytetwild", description="layered: extruded, deterministic"
    )
    file: str | None = Field(
        None, description="your own mesh instead: .msh, .inp or .xdmf in mm, with the names of the parts"
    )
    film_layers: Annotated[int, Field(ge=1, le=8), WITHOUT_FILE] = Field(
        1, description="quadratic elements through the film"
    )
    coarsen: Annotated[bool, WITHOUT_FILE, WITH_PYTETWILD] = Field(
        False, description="merge elements smaller than requested; half as many where sizes are large"
    )
    symmetry: Annotated[Literal["auto", "none"], WITHOUT_FILE] = Field(
        "auto", description="auto: mesh a half or a quarter where all is symmetric; results are those of the whole"
    )
    timeout_s: Annotated[Positive, WITHOUT_FILE, WITH_PYTETWILD] = Field(
        300.0, description="the mesher is stopped after this time"
    )

    def scale_sizes(self, factor: float) -> Self:
        """The options with all sizes times a factor and no accuracy that would scale them again."""
        sizes = {name: factor * size for name, size in self.sizes_mm.items()}
        return self.model_copy(update={**sizes, "accuracy_percent": None})

    @property
    def sizes_mm(self) -> dict[str, float]:
        """Key -> edge length in mm, of those that are stated."""
        names = ("element_size_mm", "contact_element_size_mm", "film_element_size_mm")
        return {name: size for name in names if (size := getattr(self, name)) is not None}
