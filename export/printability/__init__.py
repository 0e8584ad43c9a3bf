"""Can this part be printed? Measured against the limits of a printer, with the place and advice in words."""

from export.printability.check import check_part
from export.printability.findings import CriticalSize, Finding, Printability
from export.printability.picture import draw_findings
from geometry.fabrication.printers import PrinterProfile, printer_names, printer_profile

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
