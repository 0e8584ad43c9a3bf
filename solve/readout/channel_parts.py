"""Parts of the read-out that are of single channels, each on an amplifier of its own; channels are numbered from 1."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from solve.readout.stages import Stage


class ChannelPart:
    """One part of the read-out; those methods that are not overridden change nothing."""

    @property
    def channels(self) -> tuple[int, ...]:
        """Numbers of the channels that the part needs."""
        return ()

    @property
    def words(self) -> str:
        """Name of the part for a reader."""
        return f"a part of {self._channel_names}"

    @property
    def _channel_names(self) -> str:
        """The channels as a reader is told of them: 'channel-1' and 'channel-2'."""
        return " and ".join(f"'channel-{number}'" for number in self.channels)

    def stages_behind(self, channel: int) -> tuple[Stage, ...]:
        """Stages behind the input of one channel."""
        return ()

    def conductance_uS(self, channels: int) -> Floats:
        """Conductance (e,) in uS that the part adds parallel to each input."""
        return np.zeros(channels)

    def capacitance_F(self, channels: int) -> Floats:
        """Capacitance matrix (e, e) in F that the part adds between the inputs. ValueError for a missing channel."""
        return np.zeros((channels, channels))

    def crosstalk_V(self, alone_V: Floats) -> Floats:
        """Voltages (e, t) that the part adds to those (e, t) that the amplifiers give alone."""
        return np.zeros_like(alone_V)


@dataclass(frozen=True)
class ChannelStage(ChannelPart):
    """A stage of one channel."""

    channel: int
    stage: Stage

    @property
    def channels(self) -> tuple[int, ...]:
        """Number of the channel."""
        return (self.channel,)

    @property
    def words(self) -> str:
        """Name of the stage for a reader: a filter, as all stages of single channels are."""
        return f"a filter of {self._channel_names}"

    def stages_behind(self, channel: int) -> tuple[Stage, ...]:
        """The stage, behind the input of its own channel."""
        return (self.stage,) if channel == self.channel else ()


@dataclass(frozen=True)
class ChannelLeak(ChannelPart):
    """A conductance parallel to one input."""

    channel: int
    leak_uS: float

    @property
    def channels(self) -> tuple[int, ...]:
        """Number of the channel."""
        return (self.channel,)

    @property
    def words(self) -> str:
        """Name of the leak for a reader."""
        return f"a leak of {self._channel_names}"

    def conductance_uS(self, channels: int) -> Floats:
        """Conductance (e,) in uS: the leak at its own input, where that is there."""
        return np.where(np.arange(1, channels + 1) == self.channel, self.leak_uS, 0.0)


@dataclass(frozen=True)
class MutualCapacitance(ChannelPart):
    """A capacitance between two inputs."""

    one: int
    other: int
    mutual_pF: float

    @property
    def channels(self) -> tuple[int, ...]:
        """Numbers of the two channels."""
        return (self.one, self.other)

    @property
    def words(self) -> str:
        """Name of the crosstalk for a reader."""
        return f"crosstalk between {self._channel_names}"

    def capacitance_F(self, channels: int) -> Floats:
        """Capacitance matrix C [[1, -1], [-1, 1]] of the two inputs among all (e, e). ValueError for a missing
        channel.
        """
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
        """Number of the channel."""
        return (self.channel,)

    @property
    def words(self) -> str:
        """Name of the crosstalk for a reader."""
        return f"crosstalk into {self._channel_names}"

    def crosstalk_V(self, alone_V: Floats) -> Floats:
        """Voltages (e, t): in its own channel the share of the sum of the others."""
        added = np.zeros_like(alone_V)
        if self.channel <= len(alone_V):
            own = alone_V[self.channel - 1]
            added[self.channel - 1] = self.share * (alone_V.sum(axis=0) - own)
        return added


def conductances_uS(parts: Iterable[ChannelPart], channels: int) -> Floats:
    """Conductance (e,) in uS that the parts add parallel to each input."""
    return np.asarray(sum((part.conductance_uS(channels) for part in parts), np.zeros(channels)))


def capacitances_F(parts: Iterable[ChannelPart], channels: int) -> Floats:
    """Capacitance matrix (e, e) in F that the parts add between the inputs. ValueError for a missing channel."""
    none = np.zeros((channels, channels))
    return np.asarray(sum((part.capacitance_F(channels) for part in parts), none))


def with_crosstalk_V(parts: Iterable[ChannelPart], alone_V: Floats) -> Floats:
    """Voltages (e, t) of all channels with the crosstalk into each."""
    return np.asarray(alone_V + sum((part.crosstalk_V(alone_V) for part in parts), np.zeros_like(alone_V)))
