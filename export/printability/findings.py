"""Answer of the check: findings with their place, and the process that is advised."""

from dataclasses import dataclass
from typing import Any, Literal, get_args

Rule = Literal["manifold", "size", "wall", "feature", "relief", "gap", "overhang", "tolerance"]
RULES: tuple[Rule, ...] = get_args(Rule)
Severity = Literal["error", "warning", "note"]
SEVERITIES: tuple[Severity, ...] = get_args(Severity)
Process = Literal["fdm", "sla", "cast", "split", "repair"]
"""fdm, sla: print it so; cast: cast it or cut it from sheet; split: too large for any printer; repair: not closed."""
Point = tuple[float, float, float]


@dataclass(frozen=True)
class CriticalSize:
    """A size of the part that must come out right.

    deviation_mm : how far the made part may be off.
    place_mm : (x, y, z) of a point where the size is seen, in the frame of the part.
    """

    name: str
    nominal_mm: float
    deviation_mm: float
    place_mm: Point


@dataclass(frozen=True)
class Finding:
    """One rule that the part violates.

    value, limit : what was measured and what the printer asks for, in unit ("mm", "mm2", "mm3" or "edges").
    place_mm : (x, y, z) of the worst place, in the frame of the part.
    severity : "error": cannot be printed so; "warning": prints, but not as drawn or only with care;
        "note": to be known.
    problem : what is wrong, in words; advice : what to do about it.
    """

    rule: Rule
    value: float
    limit: float
    unit: str
    place_mm: Point
    severity: Severity
    problem: str
    advice: str

    def as_dict(self) -> dict[str, Any]:
        """Plain values for a JSON summary."""
        return {
            "rule": self.rule,
            "value": self.value,
            "limit": self.limit,
            "unit": self.unit,
            "place_mm": list(self.place_mm),
            "severity": self.severity,
            "problem": self.problem,
            "advice": self.advice,
        }


@dataclass(frozen=True)
class Printability:
    """The answer for one part and one printer.

    profile : name of the printer profile; process : its process, "fdm" or "sla".
    findings : errors first; of each rule one, at its worst place; of the rule "tolerance" one for each size.
    advised_process : what to make the part by; the profile's own process where it can be printed by it.
    advice : one sentence on the whole part.
    """

    label: str
    profile: str
    process: Literal["fdm", "sla"]
    findings: tuple[Finding, ...]
    advised_process: Process
    advice: str

    @property
    def printable(self) -> bool:
        """Whether no finding is an error."""
        return all(finding.severity != "error" for finding in self.findings)

    def as_dict(self) -> dict[str, Any]:
        """Plain values for a JSON summary."""
        return {
            "label": self.label,
            "profile": self.profile,
            "process": self.process,
            "printable": self.printable,
            "advised_process": self.advised_process,
            "advice": self.advice,
            "findings": [finding.as_dict() for finding in self.findings],
        }
