"""Studies in a few lines of Python: many designs to a data frame, a recording to a verdict."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas as pd

    from softdot.verdict import Verdict


def sweep(space: Path | str | Mapping[str, Any], out: Path | str | None = None) -> "pd.DataFrame":
    """Press every design of a space; one row a point, as in sweep.parquet.

    space : SPACE.toml, or its tables. out : folder of the points, which are not solved again; none: they are not kept.
    A script that calls this needs `if __name__ == "__main__":`, since the processes that solve import it again.
    InputError for what cannot be read or written.
    """
    from softdot.commands.sweep import run_sweep
    from softdot.sweeps.space import load_space, space_from
    from softdot.sweeps.table import read_table

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
    from softdot.commands.diagnose import Options, run_diagnosis
    from softdot.verdict import Verdict

    kept = TemporaryDirectory() if out is None else None
    place = Path(kept.name) / "verdict" if kept is not None else Path(str(out))
    content = run_diagnosis(Path(recording), place, Options(full_model_s, seed, tuple(without), tuple(hold_out)))
    return Verdict(content, place, kept)
