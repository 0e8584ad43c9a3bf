"""Parts of the read-out that are of single channels, each on an amplifier of its own; channels are numbered from 1."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from solve.readout.stages import Stage


class ChannelPart:
    """One part; those methods that are not overridden change nothing."""

    @property
    def channels(self) -> tuple[int, ...]:
        """Those that it needs."""
        return ()

    @property
    def words(self) -> str:
        """What it is, for a reader."""
        return f"a part of {self._named}"

    @property
    def _named(self) -> str:
        return " and ".join(f"'channel-{number}'" for number in self.channels)

    def stages_behind(self, channel: int) -> tuple[Stage, ...]:
        """Stages behind the input of one channel."""
        return ()

    def conductance_uS(self, channels: int) -> Floats:
        """What lies parallel to each of the inputs (e,)."""
        return np.zeros(channels)

    def capacitance_F(self, channels: int) -> Floats:
        """What it adds to the capacitance matrix (e, e) of the inputs. ValueError for a channel that is not there."""
        return np.zeros((channels, channels))

    def mixed_in_V(self, alone_V: Floats) -> Floats:
        """What it adds (e, t) to the voltages (e, t) that the amplifiers give."""
        return np.zeros_like(alone_V)


@dataclass(frozen=True)
class ChannelStage(ChannelPart):
    """A stage of one channel."""

    channel: int
    stage: Stage

    @property
    def channels(self) -> tuple[int, ...]:
        """Its own."""
        return (self.channel,)

    @property
    def words(self) -> str:
        """A filter, as all stages of single channels are."""
        return f"a filter of {self._named}"

    def stages_behind(self, channel: int) -> tuple[Stage, ...]:
        """The stage, of its own channel."""
        return (self.stage,) if channel == self.channel else ()


@dataclass(frozen=True)
class ChannelLeak(ChannelPart):
    """A conductance parallel to one input."""

    channel: int
    leak_uS: float

    @property
    def channels(self) -> tuple[int, ...]:
        """Its own."""
        return (self.channel,)

    @property
    def words(self) -> str:
        """A leak."""
        return f"a leak of {self._named}"

    def conductance_uS(self, channels: int) -> Floats:
        """Of its own input, where it is there."""
        return np.where(np.arange(1, channels + 1) == self.channel, self.leak_uS, 0.0)


@dataclass(frozen=True)
class MutualCapacitance(ChannelPart):
    """A capacitance between two inputs."""

    one: int
    other: int
    mutual_pF: float

    @property
    def channels(self) -> tuple[int, ...]:
        """Both."""
        return (self.one, self.other)

    @property
    def words(self) -> str:
        """Crosstalk of two."""
        return f"crosstalk between {self._named}"

    def capacitance_F(self, channels: int) -> Floats:
        """C [[1, -1], [-1, 1]] of the two. ValueError for one that is not there."""
        highest = max(self.channels)
        if highest > channels:
            raise ValueError(f"there is no channel {highest}: there are {channels}")
        way = np.zeros(channels)
        way[self.one - 1], way[self.other - 1] = 1.0, -1.0
        return np.asarray(1e-12 * self.mutual_pF * np.outer(way, way))


@dataclass(frozen=True)
class Coupling(ChannelPart):
    """A share of the other channels' voltage that adds to one."""

    channel: int
    share: float

    @property
    def channels(self) -> tuple[int, ...]:
        """Its own."""
        return (self.channel,)

    @property
    def words(self) -> str:
        """Crosstalk into one."""
        return f"crosstalk into {self._named}"

    def mixed_in_V(self, alone_V: Floats) -> Floats:
        """The share of the sum of the others, in its own channel."""
        added = np.zeros_like(alone_V)
        if self.channel <= len(alone_V):
            own = alone_V[self.channel - 1]
            added[self.channel - 1] = self.share * (alone_V.sum(axis=0) - own)
        return added


def conductances_uS(parts: Iterable[ChannelPart], channels: int) -> Floats:
    """What leaks from each of the inputs (e,)."""
    return np.asarray(sum((part.conductance_uS(channels) for part in parts), np.zeros(channels)))


def capacitances_F(parts: Iterable[ChannelPart], channels: int) -> Floats:
    """Matrix (e, e) of what lies between the inputs. ValueError for a channel that is not there."""
    none = np.zeros((channels, channels))
    return np.asarray(sum((part.capacitance_F(channels) for part in parts), none))


def mixed_V(parts: Iterable[ChannelPart], alone_V: Floats) -> Floats:
    """Voltages (e, t) of all channels with what couples into each."""
    return np.asarray(alone_V + sum((part.mixed_in_V(alone_V) for part in parts), np.zeros_like(alone_V)))
