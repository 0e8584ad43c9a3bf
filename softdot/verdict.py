"""A verdict as people read it: sentences, tables and plots of what `softdot diagnose` wrote."""

import shutil
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd


class Verdict:
    """content : verdict.json as plain data. folder : of its files, which live as long as this object or where asked."""

    def __init__(self, content: dict[str, Any], folder: Path, kept: "TemporaryDirectory[str] | None" = None) -> None:
        self.content, self.folder, self._kept = content, folder, kept

    @property
    def sentences(self) -> list[str]:
        """From what is off to what to do next."""
        return list(self.content["summary"])

    @property
    def mismatch(self) -> bool:
        """Whether recordings and model differ by more than noise."""
        return bool(self.content["mismatch"])

    @property
    def missing_physics(self) -> list[dict[str, Any]]:
        """What is named: mechanism, component, parameters with intervals, probability; empty where nothing is."""
        return list(self.content["missing_physics"])

    @property
    def plots(self) -> dict[str, Path]:
        """Name -> PNG of the evidence: where.png, components.png, run-1.png and so on."""
        return {path.stem: path for path in sorted((self.folder / "plots").glob("*.png"))}

    @property
    def report(self) -> Path:
        """The page with everything, which opens offline."""
        return self.folder / "report.html"

    @property
    def improved(self) -> Path | None:
        """The rig with what was left out, for `softdot run` and Case.load; None where there is none."""
        path = self.folder / "improved.toml"
        return path if path.exists() else None

    def to_dataframe(self) -> "pd.DataFrame":
        """One row for each parameter of what is named: mechanism, component, parameter, value, low, high, unit."""
        import pandas as pd

        rows = [
            {"mechanism": one["mechanism"], "component": one["component"], "parameter": name, **values}
            for one in self.missing_physics
            for name, values in one["parameters"].items()
        ]
        return pd.DataFrame(rows, columns=["mechanism", "component", "parameter", "value", "low", "high", "unit"])

    def where(self) -> "pd.DataFrame":
        """One row for each run, channel, phase and band in which the simulation is off."""
        import pandas as pd

        return pd.DataFrame(self.content["where"])

    def save(self, folder: Path | str) -> Path:
        """Copy all files into a folder that is not there yet, and return it. FileExistsError."""
        return Path(shutil.copytree(self.folder, folder))

    def _repr_html_(self) -> str:
        """For notebooks: the sentences."""
        return "".join(f"<p>{escape(sentence)}</p>" for sentence in self.sentences)

    def __repr__(self) -> str:
        """The sentences."""
        return "\n".join(self.sentences)
