"""Check whether a part can be printed, against the limits of a printer, with the place and advice in words."""

from export.printability.check import check_part
from export.printability.drawing import draw_findings
from export.printability.findings import CriticalSize, Finding, Printability
from geometry.fabrication.part import PrinterProfile, printer_names, printer_profile

__all__ = [
    "CriticalSize",
    "Finding",
    "Printability",
    "PrinterProfile",
    "check_part",
    "draw_findings",
    "printer_names",
    "printer_profile",
]
