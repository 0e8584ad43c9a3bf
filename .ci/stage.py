"""Run one stage of .ci/run and say what it took: python .ci/stage.py NAME COMMAND [--most-processor-s S]

The exit status is the command's, and 1 where it took more processor time than allowed: time of the clock is shared with
whatever else the machine does, processor time is the stage's own.
"""

import argparse
import resource
import subprocess
import sys
import time


def main() -> int:
    """The stage's exit status."""
    parser = argparse.ArgumentParser()
    parser.add_argument("name")
    parser.add_argument("command", help="one line for a shell")
    parser.add_argument("--most-processor-s", type=float, default=float("inf"))
    asked = parser.parse_args()
    began = time.monotonic()
    status = subprocess.run(["bash", "-c", asked.command], check=False).returncode
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    processor_s = used.ru_utime + used.ru_stime
    print(f"{asked.name}: {time.monotonic() - began:.0f} s, {processor_s:.0f} s of processor", flush=True)
    if status == 0 and processor_s > asked.most_processor_s:
        print(f"{asked.name}: at most {asked.most_processor_s:.0f} s of processor are allowed")
        return 1
    return status


if __name__ == "__main__":
    sys.exit(main())
