"""A term as a mechanism states it, before there is a mesh: what others must know of it, and how it is built."""

from abc import ABC, abstractmethod
from collections.abc import Iterator

import numpy as np

from foundation.arrays import Floats
from solve.added import Motion
from solve.terms.base import Term
from solve.terms.builder import Builder


class TermDefinition(ABC):
    """A part of the problem that a mechanism adds. words : what it is, for a reader.

    follows_time : whether the path or its speed matters to it. of_rig : it acts between the rig and the dot, not on the
    segment. resists : by itself it holds a dot whose approach is unknown. is_contact : it stands in for the contact
    without friction. frees : surfaces of the mesh that it holds in place of the clamp, such as "base". mirrored : it is
    its own image in the planes x = 0 and y = 0.
    """

    words: str
    follows_time = False
    of_rig = False
    resists = False
    is_contact = False
    frees: tuple[str, ...] = ()
    mirrored = True

    @property
    def is_off(self) -> bool:
        """Whether its values change nothing."""
        return False

    @property
    def frees_dot(self) -> bool:
        """Whether with it the dot's approach is unknown, as the rig no longer prescribes it."""
        return False

    @abstractmethod
    def build(self, make: Builder) -> Iterator[Term]:
        """Build its terms. One of the rig builds none where make.unknowns.approach is -1, prescribed."""

    def force_N(self, motion: Motion) -> Floats:
        """Force (t,) in N that the sensor carries beside the segment's where the dot's path is prescribed."""
        return np.zeros(len(motion.path_mm))
