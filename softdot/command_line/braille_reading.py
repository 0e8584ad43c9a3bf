"""The arguments of softdot read."""

from typing import Any

from softdot.command_line.options import EXIT_STATUS, add_output, add_scheduler, add_set

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
    ("hum-mV", "MV", "amplitude of hum, 0 by default"),
    ("hum-Hz", "HZ", "its frequency, 50 by default"),
    ("hum-drift-Hz", "HZ", "standard deviation of its frequency, which drifts in 2 s, 0 by default"),
    ("hum-third", "SHARE", "amplitude of its third harmonic over its own, 0 by default"),
    ("drift-mV", "MV", "standard deviation of a voltage of each channel that drifts in 10 s, 0 by default"),
    ("speed-cv", "SHARE", "standard deviation of the logarithm of the speed, 0 by default"),
    ("speed-time-s", "S", "its correlation time, 0.5 by default"),
    ("pauses", "N", "pauses of 0.3 to 1.5 s in the line, 0 by default"),
    ("ways-back", "N", "ways back of 3 to 10 mm in the line, 0 by default"),
    ("wander-mm", "MM", "standard deviation of a slow wander across the line, 0 by default"),
    ("skew-deg", "DEG", "of the path against the line, 0 by default"),
    ("contact-losses", "N", "how often contact is lost in the line, 0 by default"),
    ("contact-loss-s", "S", "how long, 0.2 by default"),
    ("gain-scatter", "SHARE", "largest deviation of the gain of a channel, 0 by default"),
    ("dead-channel", "N", "number of a channel that gives noise alone"),
    ("swapped-channel", "N", "number of a channel that is exchanged with the next one"),
    ("reversed-channel", "N", "number of a channel whose polarity is turned"),
    ("press-s", "S", "with --mode press: time to go down, and up, 0.2 by default"),
    ("hold-s", "S", "with --mode press: time between them, 0.2 by default"),
)
"""Name, unit and meaning of the conditions under which a line is read."""


def add_read(commands: Any) -> None:
    """Add the command softdot read."""
    read = commands.add_parser(
        "read",
        help="read a line of Braille with an array: voltages and back to text",
        description="Let an array slide over a line of Braille, or set it down cell by cell: the voltages of all "
        "segments by the kernel that softdot array wrote, and the text that decoders read from them.",
        epilog="docs/reading.md explains the decoders, the results and the study, docs/learned_kernel.md touches of "
        "single cells by any sensor. Exit status 3 also where nothing of a recording is stated. " + EXIT_STATUS,
    )
    read.add_argument("text", nargs="?", help="the text, or Unicode Braille cells; may be left out with --recording")
    read.add_argument("config", nargs="?", metavar="CONFIG.toml", help="the design of the kernel, with its [readout]")
    add_set(read)
    read.add_argument(
        "--kernel", metavar="FOLDER", help="with kernel.npz and kernel.json; must be given but with --design"
    )
    read.add_argument("--standard", metavar="NAME", help="a Braille standard of the kernel's pitch; default: its own")
    read.add_argument("--table", metavar="TABLE", help="translate with this table of liblouis, such as en-ueb-g2.ctb")
    read.add_argument("--language", metavar="NAME", help="en or de: words complete what hand leaves uncertain, apart")
    read.add_argument("--mode", choices=("slide", "press"), help="slide along the line, or press cell by cell")
    for name, unit, meaning in READING_OPTIONS:
        read.add_argument(f"--{name}", type=float, metavar=unit, help=meaning)
    read.add_argument("--leftward", action="store_true", default=None, help="the array moves from right to left")
    read.add_argument(
        "--reversed-all", action="store_true", default=None, help="the polarity of all channels is turned"
    )
    read.add_argument("--preset", choices=("machine", "hand"), help="conditions of a machine (default) or a hand")
    read.add_argument("--seed", type=int, metavar="N", help="of scatter, tremor and noise, 0 by default")
    read.add_argument(
        "--decoders",
        metavar="NAME,NAME",
        help="the first one's text is what is read; default: model,threshold,learned, with --preset hand hand",
    )
    read.add_argument(
        "--recording",
        metavar="FILE.csv",
        help="decode these voltages: time_s, voltage_1_V, ...; FILE.npz of touches with a learned kernel",
    )
    read.add_argument("--text", dest="text_of_option", metavar="TEXT", help="the same as the text before the options")
    read.add_argument(
        "--calibrate", metavar="FILE.csv", help="find leads, gains and width by voltages of the text, at least 8 cells"
    )
    read.add_argument(
        "--calibration", metavar="FILE.json", help="with --recording: correct the voltages by what --calibrate wrote"
    )
    read.add_argument("--learn", nargs="+", metavar="FILE.npz", help="learn a kernel from labelled touches of cells")
    read.add_argument("--keep-rest", action="store_true", help="with --learn: use what channels say before the touch")
    read.add_argument(
        "--among", choices=("all", "letters", "learned"), help="cells that touches may be of: all 64 by default"
    )
    read.add_argument("--study", action="store_true", help="how far conditions may go before reading fails")
    read.add_argument("--conditions", metavar="FILE.toml", help="a study of these conditions")
    read.add_argument("--design", metavar="DESIGNS.toml", help="search for the array that reads with the least force")
    read.add_argument(
        "--workers", type=int, metavar="N", help="processes of a study or search; one per core by default"
    )
    add_scheduler(read, " of a study or search")
    add_output(read)
