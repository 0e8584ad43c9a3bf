"""The check of one part against one printer."""

from collections.abc import Sequence
from typing import Any

from export.printability import body_rules, detail_rules
from export.printability.advice import advise
from export.printability.findings import RULES, SEVERITIES, CriticalSize, Finding, Point, Printability
from export.printability.measure import Measured, measure
from geometry.printers import PrinterProfile, printer_names, printer_profile

RULES_WITH_LIMITS = (
    body_rules.size,
    body_rules.overhang,
    detail_rules.wall,
    detail_rules.feature,
    detail_rules.relief,
    detail_rules.gap,
)


def check_part(
    label: str,
    body: Any,
    profile: PrinterProfile,
    sizes: Sequence[CriticalSize] = (),
    up: Point = (0.0, 0.0, 1.0),
) -> Printability:
    """Check one part. body : build123d Solid or trimesh.Trimesh, in mm.

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
    """As check_part, for several printers; the part is measured once."""
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
    """Errors first, then in the order of the rules."""
    found = list(body_rules.manifold(measured))
    found += [finding for rule in RULES_WITH_LIMITS for finding in rule(measured, profile)]
    found += detail_rules.tolerance(sizes, profile)
    return tuple(sorted(found, key=lambda f: (SEVERITIES.index(f.severity), RULES.index(f.rule))))
