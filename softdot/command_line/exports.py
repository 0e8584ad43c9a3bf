"""The arguments of softdot export: spice and robot."""

from typing import Any

from softdot.command_line.options import EXIT_STATUS, add_output, add_set


def add_export(commands: Any) -> None:
    """Add the command softdot export."""
    export = commands.add_parser(
        "export",
        help="write the sensor for a circuit simulator or a robot simulator",
        description="Write the sensor for another program.",
        epilog=EXIT_STATUS,
    )
    kinds = export.add_subparsers(dest="what", metavar="WHAT", required=True)
    spice = kinds.add_parser(
        "spice",
        help="a netlist of film and amplifier",
        description="Write film and amplifier as a netlist, with the charge of a press as a PWL source, and the "
        "voltages that softdot calculates.",
        epilog="softdot export spice out -o netlist",
    )
    spice.add_argument("source", metavar="FOLDER_OR_CONFIG", help="folder of softdot run, or a configuration to press")
    add_set(spice)
    add_output(spice)
    robot = kinds.add_parser(
        "robot",
        help="a kernel as the skin of a finger in MuJoCo",
        description="Write a kernel, a sensor callback that reads it with NumPy alone, and a finger with that skin as "
        "a model of MuJoCo.",
        epilog="softdot export robot cell -o finger, then python slide.py in that folder",
    )
    robot.add_argument("source", metavar="KERNEL", help="a folder of softdot array --kernel")
    add_output(robot)
