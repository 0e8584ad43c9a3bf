"""VTK without a display: choose a window that draws, or say plainly why none does."""

import os
import subprocess
import sys
from threading import Lock

from foundation.child_processes import child_python_path, python_command
from foundation.errors import InputError

_WINDOW_VARIABLE = "VTK_DEFAULT_OPENGL_WINDOW"
_PROBE = """
from vtkmodules.vtkRenderingCore import vtkRenderer
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderWindow
from vtkmodules.vtkRenderingCore import vtkRenderWindow
window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.AddRenderer(vtkRenderer())
window.Render()
print("drawn", window.ReportCapabilities()[:1])
"""
OPENGL_ADVICE = (
    "Pictures cannot be drawn because no OpenGL library for drawing without a display was found: "
    "install libegl1 and libgl1-mesa-dri (apt-get install libegl1 libgl1 libgl1-mesa-dri) or libosmesa6."
)
TRIAL_TIMEOUTS_S = 60.0, 240.0
"""Longest time of a trial picture, and of a second trial where none was drawn in that time."""
_CHOSEN_WINDOW: list[str] = []
_TRIAL_LOCK = Lock()


def ensure_rendering(known: str | None = None) -> str:
    """Choose VTK's window for this machine, and return its name; to be called before the first picture.

    known : what another process was told here. Without it a short process of its own tries, once: VTK ends the whole
    process by a segmentation fault when neither EGL nor OSMesa can be loaded. Several threads may ask at once.
    Raises InputError, with the libraries to install, when nothing works.
    """
    with _TRIAL_LOCK:
        if not _CHOSEN_WINDOW:
            _CHOSEN_WINDOW.append(_working_window() if known is None else known)
    if _CHOSEN_WINDOW[0]:
        os.environ[_WINDOW_VARIABLE] = _CHOSEN_WINDOW[0]
    return _CHOSEN_WINDOW[0]


def _working_window() -> str:
    """Name of VTK's window class, empty for VTK's own choice. InputError where none draws.

    A window that was only slow is tried once more.
    """
    slow = _candidate_windows()
    for seconds in TRIAL_TIMEOUTS_S:
        waiting, slow = slow, []
        for window in waiting:
            try:
                if _draws(window, seconds):
                    return window
            except subprocess.TimeoutExpired:
                slow.append(window)
    if slow:
        raise InputError(
            f"Pictures cannot be drawn: a trial picture took longer than {TRIAL_TIMEOUTS_S[-1]:g} s; this machine or "
            "its graphics is too slow or too busy, try again when it has less to do"
        )
    raise InputError(OPENGL_ADVICE)


def _draws(window: str, seconds: float) -> bool:
    """Whether a process that draws with this window ends well. TimeoutExpired after the seconds given."""
    environment = {**os.environ, **child_python_path(), **({_WINDOW_VARIABLE: window} if window else {})}
    run = subprocess.run(
        python_command("-c", _PROBE), env=environment, capture_output=True, timeout=seconds, check=False
    )
    return run.returncode == 0 and b"drawn" in run.stdout


def _candidate_windows() -> list[str]:
    """Names of the windows to try.

    Without a display, to name EGL spares VTK's warning about the missing X server.
    """
    if os.environ.get(_WINDOW_VARIABLE):
        return [os.environ[_WINDOW_VARIABLE]]
    if sys.platform != "linux" or os.environ.get("DISPLAY"):
        return [""] if sys.platform != "linux" else ["", "vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow"]
    return ["vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow"]
