"""The arguments of the commands on what was measured: material, scan, convert, diagnose and fit."""

from typing import Any

from softdot.command_line.options import EXIT_STATUS, add_output, add_scheduler


def add_material(commands: Any) -> None:
    """Add the command softdot material."""
    material = commands.add_parser(
        "material",
        help="fit a material to tensile, compression, shear or relaxation tests",
        description="Fit the stable laws of the library to tests of a specimen, over the range of strain that a design "
        "uses, with relaxation from holds and softening from cycles; writes material.toml to include, and a page.",
        epilog="docs/material.md explains which files are read. " + EXIT_STATUS,
    )
    material.add_argument("tests", nargs="+", metavar="TEST", help="files of a testing machine: .csv, .txt, .xlsx")
    material.add_argument(
        "--kind", action="append", choices=("tension", "compression", "shear", "planar", "equibiaxial"),
        help="of every test, or once for each in order; by default tension",
    )  # fmt: skip
    for size, what in {
        "width-mm": "of the specimen", "thickness-mm": "of the specimen",
        "gauge-length-mm": "by which displacements are divided; of a block or a sheared layer its thickness",
        "area-mm2": "by which forces are divided",
    }.items():  # fmt: skip
        material.add_argument(f"--{size}", type=float, metavar="N", help=f"{what}, in place of what the file states")
    material.add_argument(
        "--columns", metavar="NAMES", help='header by hand, such as "time (s),,strain (%%),stress (kPa)"'
    )
    material.add_argument(
        "--strain-range-percent", type=float, default=50.0, metavar="N", help="strains to fit, 0 to N; default 50"
    )
    material.add_argument(
        "--slack-percent", type=float, metavar="N", help="strain before the specimen is loaded; by default fitted"
    )
    material.add_argument("--poisson-ratio", type=float, default=0.499, metavar="NU", help="default 0.499")
    material.add_argument(
        "--law", choices=("neo-hookean", "mooney-rivlin", "yeoh", "knowles", "fung", "ogden-1", "ogden-2"),
        help="this law alone; by default the one that predicts best",
    )  # fmt: skip
    material.add_argument("--preconditioned", action="store_true", help="fit the last cycle alone")
    material.add_argument(
        "--layer", action="append", default=[], choices=("effector", "medium1", "medium2"),
        help="write relaxation and softening as mechanisms of this layer; may be repeated",
    )  # fmt: skip
    material.add_argument("--name", help="of the material; by default that of the folder")
    add_output(material)


def add_scan(commands: Any) -> None:
    """Add the command softdot scan."""
    scan = commands.add_parser(
        "scan",
        help="fit a dot to a scanned surface",
        description="Fit a surface of revolution to the scan of one dot and the plate around it, in mm: its profile "
        "for dot.profile_csv, and how far the scan lies from it.",
        epilog="docs/geometry.md#dot says how a profile is pressed. " + EXIT_STATUS,
    )
    scan.add_argument("scan", metavar="SCAN", help="a surface as .stl, .ply or .obj, in mm")
    add_output(scan)


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


def add_fit(commands: Any) -> None:
    """Add the command softdot fit."""
    fit = commands.add_parser(
        "fit",
        help="fit the read-out of a rig to a recording, without a diagnosis",
        description="Fit resistance and capacitance of the read-out, and gain, offset and lag of each run, to the "
        "voltages of a recording: values, intervals, correlations and what is left.",
        epilog="docs/recordings.md describes the format of a recording. " + EXIT_STATUS,
    )
    fit.add_argument("recording", metavar="RECORDING", help="a folder with rig.toml and CSV files")
    fit.add_argument("--only", required=True, choices=("readout",), help="what to fit")
    add_output(fit)
