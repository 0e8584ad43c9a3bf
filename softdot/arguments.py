"""The arguments of every command. Nothing heavy is imported here, so that help is instant."""

import argparse
from typing import Any, NoReturn

from softdot.console import BAD_INPUT, GOOD

EXIT_STATUS = "Exit status: 0 good, 2 bad input, 3 a computation did not converge, 130 interrupted."
LISTED = ("materials", "standards", "mechanisms")
TEMPLATES = ("default", "slice", "dome", "circuit", "time-dependent")


class _Parser(argparse.ArgumentParser):
    """Says one sentence instead of the usage and a sentence."""

    def error(self, message: str) -> NoReturn:
        """Exit 2."""
        self.exit(BAD_INPUT, f"{self.prog}: {message}; see {self.prog} --help\n")


class _Version(argparse.Action):
    """Looks the version up only when asked."""

    def __call__(self, parser: argparse.ArgumentParser, *_args: Any) -> None:
        from softdot.console import installed_version

        print(f"softdot {installed_version()}")
        parser.exit(GOOD)


class _Completion(argparse.Action):
    """Prints the completion that shtab makes of the parser."""

    def __call__(self, parser: argparse.ArgumentParser, _namespace: Any, values: Any, _option: Any = None) -> None:
        import shtab

        print(shtab.complete(parser, values))
        parser.exit(GOOD)


def parser() -> argparse.ArgumentParser:
    """The whole command line."""
    top = _Parser(
        prog="softdot",
        description="Design, simulate and fabricate a soft piezoelectric segment over a Braille dot.",
    )
    top.add_argument("--version", action=_Version, nargs=0, help="show the version and exit")
    top.add_argument(
        "--print-completion",
        action=_Completion,
        choices=("bash", "zsh"),
        help="print the completion of this command line for a shell and exit",
    )
    commands = top.add_subparsers(dest="command", metavar="COMMAND", required=True)
    _add_run(commands)
    _add_paper(commands)
    _add_sweep(commands)
    _add_convert(commands)
    _add_diagnose(commands)
    _add_prove(commands)
    _add_kit(commands)
    _add_plate(commands)
    _add_array(commands)
    _add_read(commands)
    _add_verify(commands)
    _add_studio(commands)
    _add_check(commands)
    _add_new(commands)
    _add_list(commands)
    _add_schema(commands)
    return top


def _add_run(commands: Any) -> None:
    run = commands.add_parser(
        "run",
        help="build, mesh, press and export one segment",
        description="Build, mesh and press one segment; write CAD, ParaView results, pictures and a report.",
        epilog="'softdot schema' explains every key of CONFIG.toml; examples/ has files to start from. " + EXIT_STATUS,
    )
    _add_config(run)
    run.add_argument(
        "--mesh-format",
        action="append",
        default=[],
        metavar="FORMAT",
        help="write the mesh for other codes too: msh (Gmsh), inp (Abaqus, CalculiX) or xdmf; may be repeated",
    )
    _add_output(run)


def _add_paper(commands: Any) -> None:
    paper = commands.add_parser(
        "paper",
        help="reproduce and examine every table, figure and number of the paper",
        description="Solve the whole study of the paper and continue it: its tables, figures and published "
        "numbers beside ours, the calibration factor, and a design search. A second run uses the cache.",
        epilog=EXIT_STATUS,
    )
    _add_scheduler(paper)
    _add_output(paper)


def _add_sweep(commands: Any) -> None:
    sweep = commands.add_parser(
        "sweep",
        help="press many designs over any keys of the configuration",
        description="Solve every point of a design space on all cores, or on a Dask cluster, into one table. "
        "A sweep that was stopped resumes where it was.",
        epilog="examples/ has a SPACE.toml to start from. " + EXIT_STATUS,
    )
    sweep.add_argument("space", metavar="SPACE.toml", help="a configuration and its axes")
    _add_set(sweep)
    _add_scheduler(sweep)
    _add_output(sweep)


def _add_convert(commands: Any) -> None:
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


def _add_diagnose(commands: Any) -> None:
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
    _add_scheduler(diagnose)
    _add_output(diagnose)


def _add_prove(commands: Any) -> None:
    prove = commands.add_parser(
        "prove",
        help="count how often a diagnosis is right, with hidden effects from another code",
        description="Hide effects in recordings of another code, seal the truth, diagnose, reveal and count. "
        "A proof that was stopped resumes where it was.",
        epilog="docs/studies/prove.md explains the cases and the table. " + EXIT_STATUS,
    )
    prove.add_argument("--cases", type=int, required=True, metavar="N", help="how many recordings")
    prove.add_argument("--seed", type=int, default=0, metavar="S", help="of the cases")
    rigs = "of the hidden world, such as thick-clamped,thick-free; default: two ridges and a round dot"
    prove.add_argument("--rigs", metavar="NAME,NAME", help=rigs)
    kinds = "from none, single, pair, left-out, outside, ambiguous; default: all"
    prove.add_argument("--kinds", metavar="KIND,KIND", help=kinds)
    prove.add_argument("--mechanisms", metavar="NAME,NAME", help="known effects are of these; default: all")
    prove.add_argument("--staged", action="store_true", help="the first eight mechanisms only")
    prove.add_argument("--details", action="store_true", help="rigs with small flaws that no mechanism describes")
    prove.add_argument("--workers", type=int, metavar="N", help="number of processes; one per core by default")
    _add_scheduler(prove)
    _add_output(prove)


def _add_kit(commands: Any) -> None:
    kit = commands.add_parser(
        "kit",
        help="write a fabrication kit: moulds, frame, cut files, build sheet",
        description="Write everything that a workshop needs to make the simulated segment or array.",
        epilog=EXIT_STATUS,
    )
    _add_config(kit)
    _add_scheduler(kit)
    _add_output(kit)


def _add_plate(commands: Any) -> None:
    plate = commands.add_parser(
        "plate",
        help="write a printable Braille test plate",
        description="Write a printable plate with a text in Braille, a single dot, a row of dots that grow, "
        "or an indenter tip for a force gauge, and say which printer can make it.",
        epilog="docs/plate.md explains each option. " + EXIT_STATUS,
    )
    plate.add_argument("text", nargs="?", help="the text, or Unicode Braille cells")
    plate.add_argument("--standard", required=True, metavar="NAME", help="a Braille standard, such as ada")
    plate.add_argument("--kind", default="text", choices=("text", "dot", "height-series", "tip"), help="what to make")
    plate.add_argument("--table", metavar="TABLE", help="translate with this table of liblouis, such as en-ueb-g2.ctb")
    plate.add_argument("--width-cells", type=int, metavar="N", help="break lines that are longer")
    for size in ("base-diameter", "height", "dot-pitch", "cell-pitch", "line-pitch"):
        plate.add_argument(f"--{size}-mm", type=float, metavar="MM", help="instead of that of the standard")
    plate.add_argument("--heights-mm", metavar="MM,MM", help="heights of a height series")
    plate.add_argument("--thickness-mm", type=float, metavar="MM", help="of the plate")
    plate.add_argument("--margin-mm", type=float, metavar="MM", help="around the text")
    plate.add_argument("--thread", metavar="NAME", help="thread of the force gauge, M6 by default")
    _add_output(plate)


def _add_array(commands: Any) -> None:
    array = commands.add_parser(
        "array",
        help="press several segments under shared layers: their crosstalk",
        description="Press each segment of an array alone: charge and voltage of every segment, and the lone segment "
        "that stands for one of them. Presses that were solved are kept, so that a second run goes on.",
        epilog="docs/array.md explains the table [array] and the results. " + EXIT_STATUS,
    )
    _add_config(array)
    array.add_argument(
        "--variants",
        dest="parts",
        action="append_const",
        const="variants",
        default=[],
        help="press the same segments joined in other ways too, for comparison",
    )
    array.add_argument(
        "--kernel", dest="parts", action="append_const", const="kernel",
        help="write the kernel: charge of every segment against place and depth of a dot, as softdot read needs it",
    )  # fmt: skip
    _add_scheduler(array)
    _add_output(array)


READING_OPTIONS = (
    ("speed-mm-per-s", "MM_PER_S", "of the array along the line, 10 by default"),
    ("depth-mm", "MM", "of nominal dots below the resting top; default: three quarters of the kernel's depth"),
    ("force-N", "N", "instead of a depth: the force that is held, at most as deep as the kernel goes"),
    ("yaw-deg", "DEG", "of the array against the line"),
    ("offset-mm", "MM", "of the array's middle across the line"),
    ("tremor-um", "UM", "root mean square of a slow wobble across the line and in depth, 3 by default"),
    ("tremor-Hz", "HZ", "its bandwidth, 2 by default"),
    ("height-mm", "MM", "of all dots; default: that of the standard"),
    ("height-scatter-mm", "MM", "standard deviation of heights; default: by the range of the standard, else 0.015"),
    ("position-scatter-mm", "MM", "standard deviation of places, 0.03 by default"),
    ("worn", "SHARE", "share of the dots that are worn, 0 by default"),
    ("wear-mm", "MM", "by how much a worn dot is lower, 0.1 by default"),
    ("missing", "SHARE", "share of the dots that are missing, 0 by default"),
    ("sampling-Hz", "HZ", "samples a second, 500 by default"),
    ("noise-mV", "MV", "white noise of each sample, 1 by default"),
    ("hum-mV", "MV", "amplitude of hum at 50 Hz, 0 by default"),
    ("press-s", "S", "with --mode press: time to go down, and up, 0.2 by default"),
    ("hold-s", "S", "with --mode press: time between them, 0.2 by default"),
)
"""Name, unit and meaning of what a line is read under."""


def _add_read(commands: Any) -> None:
    read = commands.add_parser(
        "read",
        help="read a line of Braille with an array: voltages and back to text",
        description="Let an array slide over a line of Braille, or set it down cell by cell: the voltages of all "
        "segments by the kernel that softdot array wrote, and the text that decoders read from them.",
        epilog="docs/reading.md explains the decoders, the results and the study. " + EXIT_STATUS,
    )
    read.add_argument("text", nargs="?", help="the text, or Unicode Braille cells; may be left out with --recording")
    read.add_argument("config", nargs="?", metavar="CONFIG.toml", help="the design of the kernel, with its [readout]")
    _add_set(read)
    read.add_argument(
        "--kernel", metavar="FOLDER", help="with kernel.npz and kernel.json; must be given but with --design"
    )
    read.add_argument("--standard", metavar="NAME", help="a Braille standard of the kernel's pitch; default: its own")
    read.add_argument("--table", metavar="TABLE", help="translate with this table of liblouis, such as en-ueb-g2.ctb")
    read.add_argument("--mode", choices=("slide", "press"), help="slide along the line, or press cell by cell")
    for name, unit, meaning in READING_OPTIONS:
        read.add_argument(f"--{name}", type=float, metavar=unit, help=meaning)
    read.add_argument("--seed", type=int, metavar="N", help="of scatter, tremor and noise, 0 by default")
    read.add_argument(
        "--decoders",
        default="model,threshold,learned",
        metavar="NAME,NAME",
        help="the first one's text is what is read",
    )
    read.add_argument("--recording", metavar="FILE.csv", help="decode these voltages: time_s, voltage_1_V, ...")
    read.add_argument("--study", action="store_true", help="how far conditions may go before reading fails")
    read.add_argument("--conditions", metavar="FILE.toml", help="a study of these conditions")
    read.add_argument("--design", metavar="DESIGNS.toml", help="search for the array that reads with the least force")
    read.add_argument(
        "--workers", type=int, metavar="N", help="processes of a study or search; one per core by default"
    )
    _add_scheduler(read, " of a study or search")
    _add_output(read)


def _add_verify(commands: Any) -> None:
    verify = commands.add_parser(
        "verify",
        help="solve problems with known answers: is it right on this machine?",
        description="Solve named verification problems on this machine and compare them with closed forms, published "
        "benchmarks and other codes, each within a bound: a table, a page and verify.json.",
        epilog="docs/verification.md says what is verified, what is validated, and what is neither. Exit status: 0 all "
        "passed, 2 bad input, 3 a problem failed, 130 interrupted.",
    )
    verify.add_argument(
        "--only", action="append", default=[], metavar="NAME", help="this problem alone; may be repeated"
    )
    _add_output(verify)


def _add_studio(commands: Any) -> None:
    studio = commands.add_parser(
        "studio",
        help="design a segment in the browser, on this machine",
        description="Open a page in the browser in which a design is changed by hand and pressed at once. It answers "
        "on this machine only, and only to the address that it prints.",
        epilog="Needs pip install 'softdot[studio]'; docs/studio.md explains the page. " + EXIT_STATUS,
    )
    studio.add_argument("config", nargs="?", metavar="CONFIG.toml", help="default: the final design of the paper")
    studio.add_argument("--port", type=int, default=0, metavar="N", help="port of the page; default: a free one")
    studio.add_argument(
        "--host", default="127.0.0.1", metavar="ADDRESS", help="address of this machine; other than loopback it is open"
    )
    studio.add_argument("--no-browser", action="store_true", help="only print the address of the page")


def _add_check(commands: Any) -> None:
    check = commands.add_parser(
        "check",
        help="find all mistakes of a configuration, or what its run will cost",
        description="Check a configuration and solve nothing: all its mistakes in one answer, or the expected size "
        "of the mesh, time and memory of a run, and the warnings of the design.",
        epilog="Exit status: 0 no mistake, 2 at least one.",
    )
    check.add_argument("config", metavar="CONFIG.toml", help="the configuration to check")
    _add_set(check)
    check.add_argument("--json", action="store_true", help="print the answer as JSON to standard output")
    check.add_argument("-q", "--quiet", action="store_true", help="print only mistakes")


def _add_new(commands: Any) -> None:
    new = commands.add_parser(
        "new",
        help="print a configuration to start from, with every key explained",
        description="Print a configuration that lists each key with its meaning, unit, default and bounds. "
        "What the template does not need is commented out.",
        epilog="softdot new --template dome > mine.toml",
    )
    new.add_argument("--template", choices=TEMPLATES, default="default", help="what to start from")


def _add_list(commands: Any) -> None:
    listing = commands.add_parser(
        "list",
        help="list built-in materials, Braille standards or mechanisms",
        description="Print what is built in, with its numbers, sources and how far to trust them.",
    )
    listing.add_argument("what", choices=LISTED, help="which list")
    listing.add_argument("--json", action="store_true", help="print the list as JSON")


def _add_schema(commands: Any) -> None:
    schema = commands.add_parser(
        "schema",
        help="print the JSON Schema of the configuration",
        description="Print the JSON Schema of the configuration: each key, its meaning, bounds and default.",
    )
    schema.add_argument("--json", action="store_true", help="has no effect, as the schema is JSON")


def _add_config(command: argparse.ArgumentParser) -> None:
    command.add_argument("config", nargs="?", metavar="CONFIG.toml", help="default: the final design of the paper")
    _add_set(command)


def _add_set(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="a value instead of that in the file, such as press.indentation_mm=0.2; may be repeated",
    )


def _add_scheduler(command: argparse.ArgumentParser, of_what: str = "") -> None:
    command.add_argument(
        "--scheduler", metavar="ADDRESS", help=f"presses{of_what} on this Dask cluster, such as tcp://host:8786"
    )


def _add_output(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "-o", "--output", required=True, metavar="OUT", help="folder to write; an earlier result is replaced"
    )
    command.add_argument("--json", action="store_true", help="print the summary, and nothing else, to standard output")
    told = command.add_mutually_exclusive_group()
    told.add_argument("-q", "--quiet", action="store_true", help="print only warnings and errors")
    told.add_argument(
        "-v", "--verbose", action="store_true", help="print details too, such as every iteration of the solver"
    )
