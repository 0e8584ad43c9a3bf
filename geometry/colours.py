"""One colour for each part, shared by CAD files, pictures and the report."""

PART_COLOURS: dict[str, str] = {
    "medium2": "#9dbbd6",
    "film": "#b5263b",
    "medium1": "#7fbf9f",
    "effector": "#e9b872",
    "dot": "#8c929b",
    "case": "#d3d6da",
}
"""Hex colours; "dot" stands for the dots and their plate, "case" for whatever holds the sides."""
