"""What the configuration says of the mesh."""

from typing import Annotated, Literal

from pydantic import Field

from geometry.parameters import Positive, Table


class MeshOptions(Table):
    """Element sizes and the mesher."""

    element_size_mm: Positive = Field(0.3, description="edge length away from contact and film")
    contact_element_size_mm: Positive = Field(0.1, description="edge length under the dot")
    film_element_size_mm: Positive | None = Field(
        None, description="edge length on the film; none: geometric mean of the two"
    )
    mesher: Literal["pytetwild", "layered"] = Field("pytetwild", description="layered: extruded, deterministic")
    file: str | None = Field(
        None, description="your own mesh instead: .msh, .inp or .xdmf in mm, with the names of the parts"
    )
    film_layers: Annotated[int, Field(ge=1, le=8)] = Field(1, description="quadratic elements through the film")
    coarsen: bool = Field(
        False, description="pytetwild: merge elements smaller than requested; half as many where sizes are large"
    )
    timeout_s: Positive = Field(300.0, description="the mesher is stopped after this time")
