"""A plate from its request: the text in cells, the sizes, and the solid."""

from dataclasses import dataclass

from geometry.plates.braille_sizes import BrailleSizes, braille_sizes
from geometry.plates.height_series import SERIES_HEIGHTS_MM, height_series
from geometry.plates.indenter import THREADS, indenter_tip
from geometry.plates.plate import SLAB_THICKNESS_MM, Plate
from geometry.plates.text_plate import TEXT_MARGIN_MM, text_plate
from softdot.braille_text.lines import Translation, translate
from softdot.plate.options import PlateRequest, check_request


@dataclass(frozen=True)
class BuiltPlate:
    """A plate with what it was built from; translation : None for a plate without text."""

    request: PlateRequest
    plate: Plate
    sizes: BrailleSizes
    translation: Translation | None


def build_plate(request: PlateRequest) -> BuiltPlate:
    """Check a request, translate its text and build the solid. InputError for everything that cannot be built."""
    check_request(request)
    sizes = braille_sizes(request.standard, request.given)
    thickness = request.thickness_mm or SLAB_THICKNESS_MM
    if request.kind == "text":
        translation = translate(request.text or "", request.table, request.width_cells)
        margin = request.margin_mm or TEXT_MARGIN_MM
        return BuiltPlate(request, text_plate(translation.lines, sizes, thickness, margin), sizes, translation)
    base = sizes["base_diameter_mm"]
    if request.kind == "tip":
        plate = indenter_tip(base, sizes["height_mm"], request.thread or next(iter(THREADS)))
    elif request.kind == "dot":
        plate = height_series(base, (sizes["height_mm"],), thickness)
    else:
        plate = height_series(base, request.heights_mm or SERIES_HEIGHTS_MM, thickness)
    return BuiltPlate(request, plate, sizes, None)
