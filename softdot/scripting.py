"""Commands as functions, in a line of Python each: a run, derivatives, many designs, a recording to a verdict."""

import shutil
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

    from softdot.config.schema import Config
    from softdot.differentiation import Derivative
    from softdot.progress import Progress


def run_config(config: "Config", out: Path, progress: "Progress | None" = None) -> dict[str, Any]:
    """Write all files of `softdot run` into the folder out and return its summary; see softdot.run_folder.run_case."""
    from softdot.case import Case
    from softdot.run_folder import run_case

    return run_case(Case(config), out, progress)


def derivatives(config: "Config", keys: Sequence[str]) -> "list[Derivative]":
    """Differentiate the press of a configuration by its keys, such as "materials.vnr.youngs_modulus_MPa",
    "segment.film.thickness_um" or "mechanisms[0].parameters.coefficient" (see solve.solution.sensitivity).

    InputError for a key that is absent, no number, zero or decides which parts there are.

    >>> from softdot import load_config
    >>> coarse = ["segment.section=plane-strain", "dot.shape=ridge", "mesh.mesher=layered", "mesh.element_size_mm=0.8"]
    >>> config = load_config(None, [*coarse, "press.load_steps=1"])
    >>> (by_thickness,) = derivatives(config, ["segment.medium2.thickness_mm"])
    >>> bool(by_thickness.reaction_force_N[-1] < 0.0)  # a thicker medium gives way more
    True
    """
    from softdot.case import Case

    return Case(config).derivatives(keys)


def sweep(space: Path | str | Mapping[str, Any], out: Path | str | None = None) -> "pd.DataFrame":
    """Press every design of a space; one row a point, as in sweep.parquet.

    space : SPACE.toml, or its tables. out : folder of the points, which are not solved again; none: they are not kept.
    InputError for what cannot be read or written.
    """
    from softdot.sweeps.folder import read_table
    from softdot.sweeps.run import run_sweep
    from softdot.sweeps.space import load_space, space_from

    wanted = space_from(space) if isinstance(space, Mapping) else load_space(Path(space))
    with TemporaryDirectory() as folder:
        place = Path(folder) / "sweep" if out is None else Path(out)
        run_sweep(wanted, place)
        return read_table(place).to_pandas()


def diagnose(
    recording: Path | str,
    out: Path | str | None = None,
    *,
    without: Sequence[str] = (),
    hold_out: Sequence[str] = (),
    seed: int | None = None,
    full_model_s: float | None = 240.0,
) -> "Verdict":
    """Compare a recording with the model of its rig; see `softdot diagnose`.

    recording : folder with rig.toml and CSV files. out : folder of the files; none: they live as long as the verdict.
    without : mechanisms that are no candidates. hold_out : parts of labels of runs that only score the result.
    full_model_s : time for runs by the full model; None: every run, 0: none. InputError, NoEquilibriumError.
    """
    from softdot.diagnosis.folder import Options, run_diagnosis

    kept = TemporaryDirectory() if out is None else None
    place = Path(kept.name) / "verdict" if kept is not None else Path(str(out))
    content = run_diagnosis(Path(recording), place, Options(full_model_s, seed, tuple(without), tuple(hold_out)))
    return Verdict(content, place, kept)


class Verdict:
    """The result of a diagnosis. content : verdict.json as plain data. folder : of its files, which live as long as
    this object, or where the caller asked for them.
    """

    def __init__(self, content: dict[str, Any], folder: Path, kept: "TemporaryDirectory[str] | None" = None) -> None:
        self.content, self.folder, self._kept = content, folder, kept

    @property
    def sentences(self) -> list[str]:
        """The verdict in sentences, from what is off to what to do next."""
        return list(self.content["summary"])

    @property
    def mismatch(self) -> bool:
        """Whether recordings and model differ by more than noise."""
        return bool(self.content["mismatch"])

    @property
    def grade(self) -> str:
        """Grade of what the verdict says: agreement, identified, main part, kind only or unexplained."""
        return str(self.content["grade"])

    @property
    def main_part(self) -> list[dict[str, Any]]:
        """Mechanisms that explain most of the mismatch, where the rest has no name; else empty."""
        return list(self.content["main_part"])

    @property
    def missing_physics(self) -> list[dict[str, Any]]:
        """The named mechanisms: name, component, parameters with intervals, probability; empty where none is named."""
        return list(self.content["missing_physics"])

    @property
    def plots(self) -> dict[str, Path]:
        """Name -> PNG of the evidence: where.png, components.png, run-1.png and so on."""
        return {path.stem: path for path in sorted((self.folder / "plots").glob("*.png"))}

    @property
    def report(self) -> Path:
        """The path of the page with all results, which opens offline."""
        return self.folder / "report.html"

    @property
    def improved(self) -> Path | None:
        """The file of the rig with the missing physics, for `softdot run` and Case.load; None where there is none."""
        path = self.folder / "improved.toml"
        return path if path.exists() else None

    def to_dataframe(self) -> "pd.DataFrame":
        """One row for each parameter of a named mechanism, with its interval; fixed : stated, not fitted."""
        import pandas as pd

        columns = ["mechanism", "component", "parameter", "value", "low", "high", "unit", "fixed"]
        rows = [
            {"mechanism": one["mechanism"], "component": one["component"], "parameter": name, **values}
            for one in self.missing_physics
            for name, values in one["parameters"].items()
        ]
        return pd.DataFrame(rows, columns=columns)

    def where(self) -> "pd.DataFrame":
        """One row for each run, channel, phase and band in which the simulation is off."""
        import pandas as pd

        return pd.DataFrame(self.content["where"])

    def save(self, folder: Path | str) -> Path:
        """Copy all files into a folder that is not there yet, and return it. FileExistsError."""
        return Path(shutil.copytree(self.folder, folder))

    def _repr_html_(self) -> str:
        """The sentences as HTML, for notebooks."""
        return "".join(f"<p>{escape(sentence)}</p>" for sentence in self.sentences)

    def __repr__(self) -> str:
        """The sentences, one per line."""
        return "\n".join(self.sentences)
