"""The parameters of an array of segments, as the configuration writes them."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from geometry.parameters import LayerName, NonNegative, Positive, Table

MOST_IN_A_LINE = 20


class Groove(Table):
    """A groove midway between all neighbouring segments, cut into a layer that runs through."""

    layer: Literal["effector", "medium1", "medium2"] = Field(description="a layer that runs through")
    width_mm: Positive = Field(description="across the groove")
    depth_mm: Positive = Field(description="from the top of the layer, at most its thickness")


class Array(Table):
    """Several segments side by side. [segment] says what one of them is; its sides are those of the whole array."""

    columns: Annotated[int, Field(ge=1, le=MOST_IN_A_LINE)] = Field(2, description="segments of a cell along x")
    rows: Annotated[int, Field(ge=1, le=MOST_IN_A_LINE)] = Field(3, description="segments along y")
    cells: Annotated[int, Field(ge=1, le=MOST_IN_A_LINE)] = Field(1, description="cells side by side along x")
    pitch_mm: Positive | None = Field(None, description="from segment to segment; none: the dot pitch of dot.standard")
    cell_pitch_mm: Positive | None = Field(None, description="from cell to cell; none: the cell pitch of dot.standard")
    shared: tuple[LayerName, ...] = Field(
        ("film", "medium1", "medium2"), description="layers that run through; the others are islands, one a segment"
    )
    grooves: tuple[Groove, ...] = Field((), description="grooves in layers that run through")
    grid_layers: tuple[LayerName, ...] = Field(
        (), description="layers whose sides a stiff grid holds around every segment; none: no grid"
    )
    electrode_margin_mm: NonNegative = Field(
        0.0, description="bare film between the edge of a segment and that of its electrode"
    )

    @model_validator(mode="after")
    def _cells_apart(self) -> Self:
        if self.cells == 1 and self.cell_pitch_mm is not None:
            raise ValueError(f"cell_pitch_mm = {self.cell_pitch_mm:g}: acts only with cells above 1, here cells = 1")
        return self
