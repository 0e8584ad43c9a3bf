"""What a stack answers: over depth where nothing is remembered, through time where something is. Kept on disk."""

import hashlib
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from io import BytesIO
from pathlib import Path
from tempfile import NamedTemporaryFile

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.made import Made
from softdot.studies.proof.world.stack import Answer, Stack, State

POINTS = {"ridge": 24, "cap": 10}
GRADING = 1.3
STEPS_PER_DEPTH = 18
DIGEST = hashlib.sha256().digest_size
EARLIER = *np.linspace(0.0, 1.0, 9), *np.linspace(0.9, 0.0, 5)
"""Of the depth of an earlier press, where it is solved."""
STILL = 1e-4  # of the deepest press
LONGEST, GROWTH, SHORTEST_S = 0.5, 1.5, 0.006


@dataclass(frozen=True)
class Course:
    """Signals along a path. force_N (t,), charge_pC (t, e) of each electrode, area_mm2 (t,)."""

    force_N: Floats
    charge_pC: Floats
    area_mm2: Floats

    def last(self, count: int) -> "Course":
        """The end of it."""
        return Course(self.force_N[-count:], self.charge_pC[-count:], self.area_mm2[-count:])


@dataclass(frozen=True)
class Table:
    """A course over depth (k,) mm, rising from 0."""

    depth_mm: Floats
    course: Course

    def at(self, depth_mm: Floats) -> Course:
        """Interpolated at depths (t,); nothing before the touch. Force and charge are smooth, the area grows."""
        inside = np.clip(depth_mm, 0.0, self.depth_mm[-1])
        charge = _spline(self.depth_mm, self.course.charge_pC)
        area = PchipInterpolator(self.depth_mm, self.course.area_mm2)
        return Course(self._force(inside), charge(inside), area(inside))

    @property
    def _force(self) -> CubicSpline:
        return _spline(self.depth_mm, self.course.force_N)


def table(made: Made, depth_mm: float) -> Table:
    """Pressed once to a depth. ValueError for what has a memory; RuntimeError without equilibrium."""
    if made.remembers:
        raise ValueError("what remembers has no table over depth")
    if made.offset_mm < 0.0 and made.electrodes:  # solved once for both sides
        image = table(made.mirror_image, depth_mm)
        return replace(image, course=replace(image.course, charge_pC=image.course.charge_pC[:, ::-1]))
    points = depth_mm * np.linspace(0.0, 1.0, POINTS[made.dot] + 1) ** GRADING
    kept = _file_of(f"table-{_program()}-{made.key()}-{depth_mm:.6f}")
    course = kept.load() or kept.write(_press_path(made, points, np.ones(len(points))))
    return Table(points, course)


def through_time(made: Made, time_s: Floats, depth_mm: Floats, before_mm: float) -> tuple[list[int], Course]:
    """Samples (m,) of the path (t,) of the dot at which it was solved, and the answers there; at rest at first.

    before_mm : where the dot has been earlier, which damage remembers; nothing relaxes any more.
    """
    marks = steps(time_s, depth_mm)
    before_mm = before_mm if made.keeps_damage else 0.0
    earlier = before_mm * np.array(EARLIER) if before_mm > 0.0 else np.zeros(0)
    path, waits = np.append(earlier, depth_mm[marks]), np.diff(time_s[marks], prepend=time_s[0] - 1.0)
    kept = _file_of(f"time-{_program()}-{made.key()}-{_digest(time_s[marks], path)}")
    return marks, kept.load() or kept.write(
        _press_path(made, path, np.append(np.ones(len(earlier)), waits)).last(len(marks))
    )


def steps(time_s: Floats, depth_mm: Floats) -> list[int]:
    """Samples at which the equilibrium is solved: where the dot has moved on, and in rest at times that grow.

    Also the last sample at which it still stood: what moves after a rest has not moved before.
    """
    deepest = float(depth_mm.max())
    marks, wait, stood = [0], SHORTEST_S, 0
    for n in range(1, len(time_s)):
        way = abs(max(depth_mm[n], 0.0) - max(depth_mm[marks[-1]], 0.0))
        stood = n if way <= STILL * deepest else stood
        moved = way > deepest / STEPS_PER_DEPTH
        waited = time_s[n] - time_s[marks[-1]] >= wait
        if moved and marks[-1] < stood < n:
            marks.append(stood)
        if moved or waited or n == len(time_s) - 1:
            marks.append(n)
            wait = SHORTEST_S if moved else min(wait * GROWTH, LONGEST)
    return marks


def _press_path(made: Made, depth_mm: Sequence[float] | Floats, step_s: Floats) -> Course:
    """Course of a press along depths (n,), one equilibrium after the other."""
    stack = Stack(made)
    state = stack.rest()
    zero = stack.answer(state)
    answers = []
    for depth, step in zip(depth_mm, step_s, strict=True):
        state = _next_state(stack, state, float(depth), float(step))
        answers.append(stack.answer(state))
    return _course(answers, zero)


def _next_state(stack: Stack, state: State, depth_mm: float, step_s: float) -> State:
    """The next equilibrium; without memory and touch nothing changes."""
    if depth_mm <= 0.0 and not stack.made.remembers:
        return replace(state, depth_mm=depth_mm)
    return stack.press(state, depth_mm, step_s)


def _course(answers: Sequence[Answer], zero: Answer) -> Course:
    return Course(
        np.array([a.force_N for a in answers]),
        np.array([np.subtract(a.charges_pC, zero.charges_pC) for a in answers]),
        np.array([a.area_mm2 for a in answers]),
    )


def _spline(depth_mm: Floats, values: Floats) -> CubicSpline:
    """Spline from rest at the touch. A monotonic interpolant would be 1.3 % off a cap's charge between ten depths."""
    return CubicSpline(depth_mm, values, bc_type=((1, np.zeros(values.shape[1:])), "not-a-knot"))


@cache
def _program() -> str:
    """Hash of the hidden world's own source, so that an edit forgets what was kept."""
    sources = sorted(Path(__file__).parent.glob("*.py"))
    return hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()[:16]


def _digest(*arrays: Floats) -> str:
    return hashlib.sha256(b"".join(np.round(array, 9).tobytes() for array in arrays)).hexdigest()[:32]


@dataclass(frozen=True)
class _CourseFile:
    """A course in a file that begins with the SHA-256 of the rest."""

    path: Path

    def load(self) -> Course | None:
        """Course in the file, None when there is none or it is damaged."""
        try:
            whole = self.path.read_bytes()
        except OSError:
            return None
        content = whole[DIGEST:]
        if hashlib.sha256(content).digest() != whole[:DIGEST]:
            return None
        with np.load(BytesIO(content), allow_pickle=False) as data:
            return Course(data["force_N"], data["charge_pC"], data["area_mm2"])

    def write(self, course: Course) -> Course:
        """Write a course beside the file, then rename it; returns the course."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        buffer = BytesIO()
        np.savez(buffer, force_N=course.force_N, charge_pC=course.charge_pC, area_mm2=course.area_mm2)
        with NamedTemporaryFile(dir=self.path.parent, suffix=".part", delete=False) as file:
            file.write(hashlib.sha256(buffer.getvalue()).digest() + buffer.getvalue())
        Path(file.name).replace(self.path)
        return course


def _file_of(name: str) -> _CourseFile:
    return _CourseFile(store() / f"{name}.npz")


def store() -> Path:
    """Folder of solved presses: SOFTDOT_PROOF_CACHE or the user's cache. A diagnosis has no access to it."""
    from platformdirs import user_cache_dir

    return Path(os.environ.get("SOFTDOT_PROOF_CACHE") or user_cache_dir("softdot-proof"))
