"""The toy sensor as a folder on disk."""

from tests.diagnose.rigs import HEAD, SEGMENT, write_rig
from tests.diagnose.verdict.toy import toy_recording

READOUT = "[readout]\ninput_resistance_MOhm = 10000.0   # as its data sheet says\n"


def write_toy(folder, settings=(), runs=None, seed=0, more=""):
    """A recording folder of the toy; more : further TOML before the runs."""
    recording = toy_recording(settings, runs, seed=seed)
    files = {run.file.removesuffix(".csv"): {"time_s": run.time_s, **run.channels} for run in recording.runs}
    tables = "".join(
        f'[[runs]]\nfile = "{run.file}"\nlabel = "{run.label}"\n[runs.nuisance]\ngain = 0.02\n'
        for run in recording.runs
    )
    return write_rig(folder, HEAD + SEGMENT + READOUT + more + tables, **files)
