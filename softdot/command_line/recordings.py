"""The arguments of the commands on recordings: convert and diagnose."""

from typing import Any

from softdot.command_line.options import EXIT_STATUS, add_output, add_scheduler


def add_convert(commands: Any) -> None:
    """Add the command softdot convert."""
    convert = commands.add_parser(
        "convert",
        help="join logs of instruments into a recording",
        description="Read what oscilloscope, stage and force gauge have written, in their own units, bring it to one "
        "clock and write a recording for softdot diagnose; says what a drive costs that was logged too slowly.",
        epilog="docs/recordings.md explains which files are read. " + EXIT_STATUS,
    )
    convert.add_argument("logs", nargs="+", metavar="LOG", help="files of one run: .csv, .txt, .xlsx, .tdms, .wfm, ...")
    convert.add_argument("--rig", required=True, metavar="rig.toml", help="what was built, with one table [[runs]]")
    convert.add_argument(
        "--column", action="append", default=[], metavar="CHANNEL=COLUMN",
        help="which channel becomes which column, such as CH1=voltage_V; by default units tell; may be repeated",
    )  # fmt: skip
    clocks = convert.add_mutually_exclusive_group()
    clocks.add_argument(
        "--offset", action="append", default=[], metavar="S",
        help="seconds to add to the times of each LOG behind the first; by default one trigger started all clocks",
    )  # fmt: skip
    clocks.add_argument(
        "--align", action="store_true", help="find the offsets by a force or displacement that the logs share"
    )
    convert.add_argument("-o", "--output", required=True, metavar="OUT", help="new folder to write")
    convert.add_argument("-q", "--quiet", action="store_true", help="print only warnings and errors")


def add_diagnose(commands: Any) -> None:
    """Add the command softdot diagnose."""
    diagnose = commands.add_parser(
        "diagnose",
        help="find where simulation and recordings differ, and which physics was left out",
        description="Compare recordings of a real rig with its model: where they differ, which physics was left out, "
        "how well the model does with it, and what to press next. A second diagnosis of a rig uses the cache.",
        epilog="docs/recordings.md describes the format of a recording, docs/diagnose.md how to read the verdict. "
        + EXIT_STATUS,
    )
    diagnose.add_argument("recording", metavar="RECORDING", help="a folder with rig.toml and CSV files")
    last_word = diagnose.add_mutually_exclusive_group()
    last_word.add_argument(
        "--all-presses", action="store_true", help="check every run with the full 3D model, however long it takes"
    )
    last_word.add_argument(
        "--fast-model-only", action="store_true", help="check no run with the full 3D model, to study many recordings"
    )
    diagnose.add_argument(
        "--without", action="append", default=[], metavar="MECHANISM", help="leave a mechanism out of the candidates"
    )
    diagnose.add_argument(
        "--hold-out",
        action="append",
        default=[],
        metavar="TEXT",
        help="runs with this in their label take no part in naming and only score the result",
    )
    diagnose.add_argument("--seed", type=int, metavar="N", help="seed of everything random, instead of rig.toml's")
    add_scheduler(diagnose)
    add_output(diagnose)
