"""Children that hear Ctrl-C also where the tests themselves were started in the background, which ignores it."""

import signal


def heard():
    """For preexec_fn of subprocess.Popen."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
