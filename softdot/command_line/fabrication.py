"""The arguments of the commands for a workshop: kit and plate."""

from typing import Any

from softdot.command_line.options import EXIT_STATUS, add_config, add_output, add_scheduler


def add_kit(commands: Any) -> None:
    """Add the command softdot kit."""
    kit = commands.add_parser(
        "kit",
        help="write a fabrication kit: moulds, frame, cut files, build sheet",
        description="Write everything that a workshop needs to make the simulated segment or array.",
        epilog=EXIT_STATUS,
    )
    add_config(kit)
    add_scheduler(kit)
    add_output(kit)


def add_plate(commands: Any) -> None:
    """Add the command softdot plate."""
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
    add_output(plate)
