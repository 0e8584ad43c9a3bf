"""The content of kit.json: every number with its unit in its name."""

from dataclasses import asdict
from typing import Any

from export.build_sheet.bill import bill_of_materials
from export.build_sheet.contents import Contents, components
from export.build_sheet.electrical import capacitance_pF
from export.build_sheet.page import checks, traces
from export.build_sheet.steps import steps
from geometry.flat.pattern import FlatPattern, kerf_compensated_pattern
from softdot.config.hashes import config_hash
from softdot.config.schema import Config
from softdot.output import Product
from softdot.version import installed_version


def heading(config: Config, product: Product) -> dict[str, Any]:
    """The keys of kit.json that identify a kit: format, version, configuration and its hash."""
    return {
        "format": product.format,
        "softdot_version": installed_version(),
        "config_hash": config_hash(config),
        "config": config.model_dump(mode="json"),
        "from_default": list(config.from_default),
    }


def press_words(config: Config) -> str:
    """The press of a configuration in words."""
    press, dot = config.press, config.dot
    how_far = f"{press.force_N:g} N" if press.force_N is not None else f"{press.depth_mm:g} mm deep"
    return f"the {dot.shape} pressed {how_far}"


def summary_of(contents: Contents, state: str, failure: str | None) -> dict[str, Any]:
    """Numbers of the kit with their units in their names, in plain data.

    state : of the tolerance budget, "unfinished", "complete" or "failed". failure : why it failed, else None.
    """
    return {
        "failure": failure,
        "warnings": contents.warnings,
        "tolerance_budget_state": state,
        "components": [asdict(one) for one in components(contents)],
        "bill_of_materials": [asdict(item) for item in bill_of_materials(contents)],
        "parts": [
            {
                "label": part.label, "file": f"parts/{part.label}.stl", "copies": part.copies, "process": part.process,
                "size_mm": part.size_mm, "volume_mm3": part.volume_mm3, "purpose": part.purpose,
            }
            for part in contents.solid.parts
        ],
        "printability": [answer.as_dict() for answer in contents.printability],
        "pours": [asdict(pour) for pour in contents.solid.pours],
        "cavity_checks": [asdict(one) for one in contents.solid.cavity_checks],
        "flat_patterns": [_flat(pattern) for pattern in contents.flat.patterns],
        "film": {
            "capacitance_pF": dict(capacitance_pF(contents)),
            "traces": [asdict(trace) for trace in traces(contents)],
        },
        "steps": [{"title": step.title, "actions": step.actions} for step in steps(contents)],
        "checks": [asdict(check) for check in checks(contents)],
        "tolerance_budget": contents.budget,
        "tolerance_budget_of": contents.pressed,
        "crosstalk_budget": contents.crosstalk,
    }  # fmt: skip


def _flat(pattern: FlatPattern) -> dict[str, Any]:
    """A flat pattern: its finished size, and the length of its cuts with the kerf compensated."""
    return {
        "name": pattern.name,
        "files": [f"cut/{pattern.name}.dxf", f"cut/{pattern.name}.svg"],
        "material": pattern.material,
        "thickness_mm": pattern.thickness_mm,
        "pieces": pattern.count,
        "sheet_mm": pattern.size_mm,
        "kerf_mm": pattern.kerf_mm,
        "cut_length_mm": sum(cut.length_mm for cut in kerf_compensated_pattern(pattern).cuts),
    }
