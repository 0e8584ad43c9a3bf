"""python -m softdot: the same as the command softdot."""

import sys

from softdot.cli import main

sys.exit(main())
