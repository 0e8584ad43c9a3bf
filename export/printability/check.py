"""Check of one part against one printer, with one sentence of advice."""

from collections.abc import Sequence
from typing import Any

from export.printability import rules
from export.printability.findings import RULES, SEVERITIES, CriticalSize, Finding, Point, Printability, Process
from export.printability.measure import Measured, measure
from export.printability.rules import SLACK_MM
from geometry.fabrication.part import PrinterProfile, printer_names, printer_profile

Findings = Sequence[Finding]


def advise(
    measured: Measured,
    profile: PrinterProfile,
    findings: Findings,
    others: Sequence[tuple[PrinterProfile, Findings]],
) -> tuple[Process, str]:
    """The process by which to make the part, and a sentence of advice.

    findings : of the profile; others : every printer of the table with its findings. The profile's own process
    where it does at least as well as the others.
    """
    name, worst = profile.process.upper(), [_problem_and_advice(finding) for finding in findings[:1]]
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


def _problem_and_advice(finding: Finding) -> str:
    return f"{finding.problem}; {finding.advice}"


def errors(findings: Findings) -> list[Finding]:
    """Findings that keep the part from being printed."""
    return [finding for finding in findings if finding.severity == "error"]


def _sheet_thickness(measured: Measured) -> float | None:
    """Thickness in mm of a part that is one flat sheet along an axis of its drawing, else None."""
    if measured.walls is None or len(measured.walls.length_mm) == 0:
        return None
    thinnest = float(measured.walls.length_mm[0])
    return thinnest if min(measured.surface.extents) < thinnest + SLACK_MM else None


RULES_WITH_LIMITS = (
    rules.size,
    rules.overhang,
    rules.wall,
    rules.feature,
    rules.relief,
    rules.gap,
)


def check_part(
    label: str,
    body: Any,
    profile: PrinterProfile,
    sizes: Sequence[CriticalSize] = (),
    up: Point = (0.0, 0.0, 1.0),
) -> Printability:
    """Check one part on one printer. body : build123d Solid or trimesh.Trimesh, in mm.

    sizes : what must come out right, for the rule "tolerance".
    up : direction of the part that points up on the printer.
    """
    return check_on_printers(label, body, (profile,), sizes, up)[0]


def check_on_printers(
    label: str,
    body: Any,
    profiles: Sequence[PrinterProfile],
    sizes: Sequence[CriticalSize] = (),
    up: Point = (0.0, 0.0, 1.0),
) -> tuple[Printability, ...]:
    """Check one part on several printers; it is measured once.

    Parameters as of check_part; one answer for each profile.
    """
    measured = measure(body, up)
    known = [printer_profile(name) for name in printer_names()]
    others = {other.name: _findings(measured, other, sizes) for other in known}
    answers = []
    for profile in profiles:
        found = _findings(measured, profile, sizes)
        process, advice = advise(measured, profile, found, [(other, others[other.name]) for other in known])
        answers.append(Printability(label, profile.name, profile.process, found, process, advice))
    return tuple(answers)


def _findings(measured: Measured, profile: PrinterProfile, sizes: Sequence[CriticalSize]) -> tuple[Finding, ...]:
    """Findings of all rules: errors first, then in the order of the rules."""
    found = list(rules.manifold(measured))
    found += [finding for rule in RULES_WITH_LIMITS for finding in rule(measured, profile)]
    found += rules.tolerance(sizes, profile)
    return tuple(sorted(found, key=lambda f: (SEVERITIES.index(f.severity), RULES.index(f.rule))))
