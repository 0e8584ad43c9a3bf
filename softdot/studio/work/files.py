"""What is made of a design for the bench: the kit, a plate to test with, the report. Each is one zip file."""

import shutil
from pathlib import Path
from typing import Any, get_args

from foundation.errors import InputError
from foundation.worker_process import Tell
from softdot.config.schema import Config
from softdot.studio.work.design import case_of, config_of
from softdot.studio.work.press import TaskProgress


def kit(text: str, folder: str, tell: Tell) -> dict[str, Any]:
    """As `softdot kit`. The file is told of before the tolerance budget is known, and then replaced."""
    from softdot.commands.kit import short_text
    from softdot.kit.folder import make_kit

    config, place = config_of(text), Path(folder) / "kit"

    class WithFile(TaskProgress):
        """The kit is there when its tolerances begin."""

        def stage(self, name: str) -> None:
            """As above."""
            if name == "tolerances":
                said = ["the kit is ready; its tolerance budget follows"]
                tell({"file": _zipped(place, text), "page": str(place / "kit.html"), "said": said})
            super().stage(name)

    summary = make_kit(config, place, WithFile(tell))
    said = short_text(summary, "kit").splitlines()[:-1]
    return {
        "file": _zipped(place, text),
        "page": str(place / "kit.html"),
        "said": said,
        "warnings": summary["warnings"],
    }


def plate(asked: dict[str, Any], folder: str, tell: Tell) -> dict[str, Any]:
    """As `softdot plate` with a text or a kind, and a standard. InputError."""
    from softdot.commands.plate import short_text
    from softdot.plate.folder import make_plate
    from softdot.plate.options import Kind, PlateRequest

    kind, words, standard = asked.get("kind", "text"), asked.get("text"), asked.get("standard")
    if kind not in get_args(Kind) or not isinstance(standard, str) or not isinstance(words, str | None):
        raise InputError("a plate needs a kind, a standard and, of kind text, a text")
    if words is not None and len(words) > 1000:
        raise InputError(f"text: has {len(words)} characters, at most 1000 are allowed here")
    place = Path(folder) / "plate"
    request = PlateRequest(
        standard, kind, words if kind == "text" else None, width_cells=30 if kind == "text" else None
    )
    summary = make_plate(request, place, TaskProgress(tell))
    return {"file": _zipped(place), "said": short_text(summary, "plate").splitlines()[:-1], "warnings": []}


def report(text: str, folder: str, tell: Tell) -> dict[str, Any]:
    """As `softdot run`, or `softdot array`: the report, CAD files, fields for ParaView and every number."""
    from softdot.commands.run import short_text
    from softdot.run_folder import run_case

    config, place = config_of(text), Path(folder) / "run"
    if config.array is not None:
        return _report_of_array(config, text, place.with_name("array"), tell)
    summary = run_case(case_of(text), place, TaskProgress(tell))
    solver = summary["solver"]
    said = [] if solver["converged"] else [f"not converged, {solver['failure']}"]
    said += short_text(summary, "run").splitlines()[:-1]
    page = str(place / "report.html")
    return {"file": _zipped(place, text), "page": page, "said": said, "warnings": summary["warnings"]}


def _report_of_array(config: Config, text: str, place: Path, tell: Tell) -> dict[str, Any]:
    from softdot.arrays.folder import run_array
    from softdot.commands.array import short_text

    summary = run_array(config, place, TaskProgress(tell))
    said = short_text(summary, "array").splitlines()[:-1]
    page = str(place / "report.html")
    return {"file": _zipped(place, text), "page": page, "said": said, "warnings": summary["warnings"]}


def _zipped(place: Path, text: str | None = None) -> str:
    """A zip file of a folder, replaced whole; text : the design, which lies beside the rest."""
    if text is not None:
        (place.parent / "design.toml").write_text(text, "utf-8")
    made = shutil.make_archive(str(place.parent / f".{place.name}"), "zip", place.parent, place.name)
    if text is not None:
        import zipfile

        with zipfile.ZipFile(made, "a") as archive:
            archive.write(place.parent / "design.toml", f"{place.name}/design.toml")
    return str(Path(made).replace(place.with_suffix(".zip")))
