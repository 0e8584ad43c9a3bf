"""Run a module so that it can open nothing but its program, its cache and one folder.

It is called as python -m softdot.studies.proof.guard PARENT FOLDER CACHE MODULE ARGUMENT ...; everything that Python
opens or lists is checked by an audit hook (PEP 578) before it happens. Compiled libraries that open files by themselves
are not seen; what they need lies beside them.
"""

import sys
import sysconfig
from collections.abc import Sequence
from pathlib import Path
from runpy import run_module
from typing import Any

from foundation.child_processes import end_with_parent

PACKAGES = ("foundation", "geometry", "mesh", "solve", "export", "diagnose", "softdot")
SYSTEM = ("/dev", "/proc", "/sys", "/etc", "/usr", "/lib", "/lib64", "/opt")
WATCHED = frozenset({"open", "os.listdir", "os.scandir"})


def allowed_roots(folder: Path, cache: Path) -> tuple[Path, ...]:
    """Folders that the diagnosis may look into."""
    program = Path(__file__).resolve().parents[3]
    python = {sys.prefix, sys.base_prefix, *sysconfig.get_paths().values()}
    here = (*(program / name for name in PACKAGES), *program.glob("*.egg-info"), folder, cache)
    return tuple(path.resolve() for path in (*here, *map(Path, SYSTEM), *map(Path, python)))


def watch(folder: Path, cache: Path) -> None:
    """Watch this process: from now on everything else is a PermissionError. There is no way back."""
    roots = allowed_roots(folder, cache)
    program = Path(__file__).resolve().parents[3]
    open_to_list = {program, *program.parents}

    def hook(event: str, arguments: tuple[Any, ...]) -> None:
        if event not in WATCHED or not isinstance(arguments[0], str | bytes | Path):
            return
        name = arguments[0].decode() if isinstance(arguments[0], bytes) else str(arguments[0])
        path = Path(name).resolve()
        if any(path.is_relative_to(root) for root in roots):
            return
        if event != "open" and path in open_to_list:
            return
        raise PermissionError(13, "outside the isolated folder", name)

    sys.addaudithook(hook)


def main(arguments: Sequence[str]) -> None:
    """Watch, then run the module as a program, which ends with the process numbered PARENT."""
    parent, folder, cache, module, *command = arguments
    end_with_parent(int(parent))
    watch(Path(folder), Path(cache))
    sys.argv = [module, *command]
    run_module(module, run_name="__main__")


if __name__ == "__main__":
    main(sys.argv[1:])
