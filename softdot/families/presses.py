"""The presses of a family by an executor: each kept on disk, so that a stopped command goes on where it was."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from foundation.arrays import Floats
from foundation.cache import recall, remember
from foundation.errors import InputError
from foundation.executor import Executor
from mesh.build import build
from mesh.types import TetMesh
from softdot.families.member import Member, member_at, press_member
from softdot.families.space import FamilySpace, corners
from softdot.json_files import plain
from softdot.prepared_press import PreparedPress
from softdot.progress import Progress
from softdot.sweeps.points import ACCIDENTS, REFUSED, SOLVED, Record, failed_record, records_as_completed


def common_mesh(space: FamilySpace) -> TetMesh:
    """The mesh of the middle of a space, ending only at the mirror planes that all its designs have.

    InputError, MeshingError.
    """
    middle = PreparedPress(space.centre)
    planes = set(middle.planes)
    for place in corners(space.count):
        try:
            planes &= set(PreparedPress(space.config_at(place)).planes)
        except InputError:
            continue
    touching = replace(middle.dot, origin_mm=middle.dot.origin_mm - [0.0, 0.0, middle.model.dot.gap_mm])
    return build(middle.model.segment, touching, middle.config.mesh, tuple(sorted(planes)))


@dataclass
class FamilyPresses:
    """The presses so far. places, records : of those that were solved; refused, reasons : of designs without one.

    buildable : places that were looked at and can be built. pressed, recalled : numbers of presses by this command and
    by earlier ones.
    """

    space: FamilySpace
    tet_mesh: TetMesh
    executor: Executor
    progress: Progress
    most: int
    places: list[Floats] = field(default_factory=list)
    records: list[Record] = field(default_factory=list)
    buildable: list[Floats] = field(default_factory=list)
    refused: list[Floats] = field(default_factory=list)
    reasons: list[str] = field(default_factory=list)
    _was_built: list[bool] = field(default_factory=list)
    pressed: int = 0
    recalled: int = 0

    def press(self, places: Sequence[Floats], joins: bool = True) -> list[tuple[Floats, Record]]:
        """Place and record of those of the designs that could be pressed. joins : whether they take part at once."""
        members: dict[str, Member] = {}
        records: dict[str, Record] = {}
        for place in places:
            try:
                member = member_at(self.space, place)
            except InputError as error:
                self._leave_out(place, failed_record(REFUSED, str(error)))
                continue
            members[member.key(self.tet_mesh)] = member
        for key in members:
            known = recall(f"member-{key}")
            if isinstance(known, dict):
                records[key] = known
        self.recalled += len(records)
        missing = {
            key: (member, self.space.centre, self.tet_mesh) for key, member in members.items() if key not in records
        }
        self._tell("")
        for key, record in records_as_completed(self.executor, press_member, missing):
            records[key] = plain(record)
            if record["status"] not in ACCIDENTS:
                remember(f"member-{key}", records[key])
            self.pressed += 1
            self._tell(record["reason"] or "")
        solved = []
        for key, member in members.items():
            place, record = np.array(member.place), records[key]
            if record["status"] == SOLVED:
                solved.append((place, record))
            else:
                self._leave_out(place, record)
        if joins:
            self.join(solved)
        return solved

    def join(self, solved: Sequence[tuple[Floats, Record]]) -> None:
        """Let presses that took no part so far take part."""
        self.places += [place for place, _ in solved]
        self.records += [record for _, record in solved]

    @property
    def count(self) -> int:
        """Number of presses, also of those that did not reach their end."""
        return self.pressed + self.recalled

    def refuse_unbuildable(self, places: Floats) -> None:
        """Find the designs among places (n, d) that cannot be built or pressed, without a press."""
        for place in places:
            try:
                _ = PreparedPress(self.space.config_at(place)).checked_design
                self.buildable.append(np.asarray(place))
            except InputError as error:
                self._leave_out(place, failed_record(REFUSED, str(error)))

    @property
    def good(self) -> Floats:
        """Places (g, d) of designs that were pressed, and of those that can be built and are nearer to one of these
        than to one whose press did not end.
        """
        stopped = [place for place, built in zip(self.refused, self._was_built, strict=True) if built]
        pressed = np.array(self.places)
        if not stopped or not self.buildable:
            return np.vstack([pressed, *(np.atleast_2d(one) for one in self.buildable)])
        near = nearest(np.array(self.buildable), pressed) < nearest(np.array(self.buildable), np.array(stopped))
        return np.vstack([pressed, np.array(self.buildable)[near]])

    def possible(self, places: Floats) -> Floats:
        """Those of the places (n, d) that are nearer to a design that was pressed, or can be, than to another."""
        known = [*self.places, *self.buildable]
        if not self.refused or not known:
            return places
        return places[nearest(places, np.array(known)) < nearest(places, np.array(self.refused))]

    def _leave_out(self, place: Floats, record: Record) -> None:
        self.refused.append(np.asarray(place))
        self.reasons.append(str(record["reason"]))
        self._was_built.append(record["status"] != REFUSED)

    def _tell(self, reason: str) -> None:
        self.progress.step(min(self.count, self.most), self.most, reason)


def nearest(places: Floats, others: Floats) -> Floats:
    """Distance (q,) of places (q, d) from the nearest of others (n, d)."""
    return np.asarray(KDTree(others).query(places)[0])


def remeshed_warnings(space: FamilySpace, presses: FamilyPresses) -> list[str]:
    """A sentence for each design that has a mesh of its own."""
    return [
        f"{space.told(place)}: pressed on a mesh of its own, since {record['remeshed']}"
        for place, record in zip(presses.places, presses.records, strict=True)
        if record["remeshed"] is not None
    ]


def region(space: FamilySpace, refused: Sequence[Floats], reasons: Sequence[str]) -> list[dict[str, Any]]:
    """For each reason of a refusal, how many designs it was found for, and between which values of each key."""
    found = []
    for reason in dict.fromkeys(reasons):
        places = np.array([place for place, one in zip(refused, reasons, strict=True) if one == reason])
        ends = {
            one.keys[0]: [float(one.values(column.min())), float(one.values(column.max()))]
            for one, column in zip(space.ranges, places.T, strict=True)
        }
        found.append({"reason": reason, "designs": len(places), "between": ends})
    return found
