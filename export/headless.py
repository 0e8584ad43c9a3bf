"""Make VTK draw without a display, or say plainly why it cannot."""

import functools
import os
import subprocess
import sys

from geometry.base import InputError

_SWITCH = "VTK_DEFAULT_OPENGL_WINDOW"
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
ADVICE = (
    "Pictures cannot be drawn because no OpenGL library for drawing without a display was found: "
    "install libegl1 and libgl1-mesa-dri (apt-get install libegl1 libgl1 libgl1-mesa-dri) or libosmesa6."
)


def ensure_rendering() -> None:
    """Choose VTK's window for this machine; to be called before the first picture.

    VTK ends the whole process by a segmentation fault when neither EGL nor OSMesa can be loaded, so a short
    process of its own tries first. Raises InputError, with the libraries to install, when nothing works.
    """
    window = _working_window()
    if window:
        os.environ[_SWITCH] = window


@functools.cache
def _working_window() -> str:
    """Name of VTK's window class; empty for VTK's own choice."""
    for window in _candidates():
        environment = {**os.environ, **({_SWITCH: window} if window else {})}
        try:
            run = subprocess.run(
                [sys.executable, "-c", _PROBE], env=environment, capture_output=True, timeout=60, check=False
            )
        except subprocess.TimeoutExpired:
            continue
        if run.returncode == 0 and b"drawn" in run.stdout:
            return window
    raise InputError(ADVICE)


def _candidates() -> list[str]:
    """Without a display naming EGL spares VTK's warning about the missing X server."""
    if os.environ.get(_SWITCH):
        return [os.environ[_SWITCH]]
    if sys.platform != "linux" or os.environ.get("DISPLAY"):
        return [""] if sys.platform != "linux" else ["", "vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow"]
    return ["vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow"]
