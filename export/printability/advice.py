"""One sentence on how to make a part."""

from collections.abc import Sequence

from export.printability.detail_rules import SLACK_MM
from export.printability.findings import Finding, Process
from export.printability.measure import Measured
from geometry.printers import PrinterProfile

Findings = Sequence[Finding]


def advise(
    measured: Measured,
    profile: PrinterProfile,
    findings: Findings,
    others: Sequence[tuple[PrinterProfile, Findings]],
) -> tuple[Process, str]:
    """The process to make the part by, and why.

    findings : of the profile; others : every printer of the table with its findings. The profile's own process
    where it does at least as well as the others.
    """
    name, worst = profile.process.upper(), [_in_words(finding) for finding in findings[:1]]
    rules = {finding.rule for finding in errors(findings)}
    if "manifold" in rules:
        return "repair", f"repair this: {worst[0]}"
    sheet = _sheet_thickness(measured)
    if "wall" in rules and sheet is not None:
        return "cast", f"cast this: {sheet:.2g} mm sheet cannot be printed by {name}"
    best, found = min([(profile, findings), *others], key=lambda pair: (len(errors(pair[1])), len(pair[1])))
    if best.process != profile.process and not errors(found):
        return best.process, f"print this by {best.process.upper()}, not by {name}: {findings[0].problem}"
    if not rules:
        return profile.process, "; ".join([f"print this by {name}", *worst])
    if rules == {"size"}:
        return "split", f"split this: {worst[0]}"
    return "cast", f"cast or machine this: {findings[0].problem}"


def _in_words(finding: Finding) -> str:
    return f"{finding.problem}; {finding.advice}"


def errors(findings: Findings) -> list[Finding]:
    """Those that keep the part from being printed."""
    return [finding for finding in findings if finding.severity == "error"]


def _sheet_thickness(measured: Measured) -> float | None:
    """Thickness in mm of a part that is one flat sheet along an axis of its drawing, else None."""
    if measured.walls is None or len(measured.walls.length_mm) == 0:
        return None
    thinnest = float(measured.walls.length_mm[0])
    return thinnest if min(measured.surface.extents) < thinnest + SLACK_MM else None
