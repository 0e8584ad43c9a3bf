"""The [fabrication] table of the configuration: how the parts of a segment are made. Lengths in millimetres."""

from typing import Annotated, Literal

from pydantic import Field

from geometry.parameters import NonNegative, Positive, Table

Printer = Literal["sla", "fdm"]
Component = Literal["effector", "medium1", "medium2"]
Route = Literal["auto", "cast", "sheet"]
Direction = Literal["+x", "-x", "+y", "-y"]
Count = Annotated[int, Field(ge=1, le=6)]
Size = Annotated[float, Field(gt=0, le=100)]
Gap = Annotated[float, Field(ge=0, le=10)]


class CastingNumbers(Table):
    """A castable material of your own, or your own numbers for a known one, with whatever a data sheet says."""

    shrinkage_percent: float = Field(ge=0.0, le=10.0, description="linear shrinkage of the cast part")
    density_g_cm3: float = Field(gt=0.1, le=5.0, description="density of the cured part")
    parts_A: Positive = Field(1.0, description="share of component A in the mix")
    parts_B: NonNegative = Field(1.0, description="share of component B in the mix; 0 for one component")
    ratio_by: Literal["mass", "volume"] = Field("mass", description="what the shares count")
    density_A_g_cm3: Positive | None = Field(
        None, description="density of component A; left out: that of the cured part"
    )
    density_B_g_cm3: Positive | None = Field(
        None, description="density of component B; left out: that of the cured part"
    )
    pot_life_min: Positive | None = Field(None, description="time to pour")
    cure_time_h: Positive | None = Field(None, description="time until the part leaves the mould")
    release: str = Field(
        "a thin coat of a release agent that suits the material", description="release agent, for the build sheet"
    )


class Fabrication(Table):
    """How the parts are made; no effect on the simulation."""

    printer: Printer = Field("sla", description="sla (resin, also dlp) or fdm (filament): the limits of what prints")
    routes: dict[Component, Route] = Field(
        {},
        description="how a component is made; auto: cast where a recipe is known for its material, else cut from sheet",
    )
    casting: dict[str, CastingNumbers] = Field(
        {}, description="material name -> numbers for casting it; adds to or overrides the built-in recipes"
    )
    mould_style: Literal["auto", "open", "split"] = Field(
        "auto",
        description="open: one cavity plate with draft; split: bars on a floor, walls without draft; auto: open "
        "while the draft stays within tolerance_mm",
    )
    draft_deg: float = Field(1.0, ge=0.0, le=10.0, description="draft of the walls of an open mould")
    tolerance_mm: Size = Field(
        0.05, description="largest deviation of a cast part from the design that draft may cause"
    )
    lid_face: Literal["base", "top"] = Field(
        "base", description="which face of a component is cast against the smooth lid"
    )
    cavities: tuple[Count, Count] = Field((2, 2), description="cavities of one mould in x and y")
    mould_wall_mm: Size = Field(4.0, description="around the cavities and under them")
    land_mm: Size = Field(1.0, description="flat rim between a cavity and the overflow channel")
    overflow_mm: Size = Field(1.5, description="width of the overflow channels")
    vent_width_mm: Size = Field(0.5, description="width of the vents from a cavity to the overflow")
    vent_depth_mm: Size = Field(0.2, description="depth of the vents")
    pin_diameter_mm: Size = Field(3.0, description="alignment pins of moulds and jig")
    pin_clearance_mm: Gap = Field(0.15, description="gap between a pin and its hole, on each side")
    overfill_percent: float = Field(30.0, ge=0, le=1000, description="what is poured beyond the cavities")
    smallest_batch_g: float = Field(
        10.0, ge=0, le=10000, description="least amount that is weighed and mixed, however little is poured"
    )
    wall_mm: Size = Field(1.2, description="outer walls of the clamp frame and of the jig")
    floor_mm: Size = Field(2.0, description="floor of the clamp frame, of the open base and of the jig")
    side_clearance_mm: Gap = Field(0.3, description="frame: air beside layers that are not held")
    glue_gap_mm: Gap = Field(0.05, description="frame: glue line beside layers that are held")
    array: tuple[Count, Count] = Field((1, 1), description="segments of one frame in x and y")
    pitch_mm: Positive | None = Field(
        None,
        description="from centre to centre of neighbouring segments; needed for an array, and checked for one segment",
    )
    screw_diameter_mm: Size = Field(2.2, description="clearance holes of the screws that close the frame")
    cable_exit: Direction = Field("+x", description="side at which the film's tab leaves the frame")
    tab_width_mm: Size = Field(1.6, description="width of the film's tab")
    film_flange_mm: Gap = Field(
        0.8, description="film beyond the footprint on each side, clamped in the frame; only where the film is held"
    )
    tab_length_mm: Size = Field(12.0, description="length of the film's tab beyond the footprint")
    tab_slot_mm: Size = Field(0.5, description="depth of the channel under the tab in the frame")
    shelf_mm: Size = Field(8.0, description="shelf for the tab and its cable tie beyond the frame")
    kerf_mm: Gap = Field(0.1, description="width of the cut of the laser or knife")
    adhesive_thickness_mm: Size = Field(0.05, description="adhesive sheet between the layers")
    sheet_mm: tuple[Positive, Positive] = Field((100.0, 100.0), description="stock sheet for cutting, x and y")
