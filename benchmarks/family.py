"""A family beside full presses that it has not seen: python -m benchmarks.family FAM [DESIGNS].

FAM : folder of softdot family. DESIGNS : 200 if not given, drawn from the space, each pressed in full on the mesh of
the family moved to it, and kept in FAM-unseen.json, so that a stopped run goes on. Errors are at full load. Beside it,
from the same presses: the same process without derivatives, quadratic response surfaces in the logarithms with and
without them, and a sparse polynomial chaos without.
"""

import json
import sys
import time
from collections.abc import Callable
from itertools import product
from pathlib import Path

import numpy as np
from numpy.polynomial.legendre import legvander
from sklearn.linear_model import LassoLarsCV

from foundation.arrays import Floats
from softdot.executors import executor_for
from softdot.families.family import Family
from softdot.families.fit import JUDGED
from softdot.families.folder import load_family
from softdot.families.member import Member, press_member
from softdot.families.presses import common_mesh
from softdot.families.quantity import FamilyQuantity
from softdot.sweeps.points import SOLVED, records_as_completed

SEED, ANSWERS, AT_ONCE, CHAOS_DEGREE = 4711, 50, 20_000, 4


def unseen(family: Family, count: int, path: Path) -> tuple[Floats, dict[str, Floats]]:
    """Places (n, d) of drawn designs, and what their presses give at the load steps, (n, s) by quantity."""
    rows = json.loads(path.read_text("utf-8")) if path.exists() else {}
    space, mesh = family.space, common_mesh(family.space)
    places = space.drawn_places(count, SEED)
    members = {
        str(number): (Member(tuple(place), space.config_at(place), ()), space.centre, mesh)
        for number, place in enumerate(places)
        if str(number) not in rows and family.region.holds(place[None])[0]
    }
    with executor_for() as executor:
        for name, record in records_as_completed(executor, press_member, members):
            rows[name] = {key: record.get(key) for key in ("status", "reason", "seconds", "courses")}
            path.write_text(json.dumps(rows), "utf-8")
    good = sorted(int(name) for name, row in rows.items() if row["status"] == SOLVED and int(name) < count)
    return places[good], {name: np.array([rows[str(n)]["courses"][name] for n in good]) for name in JUDGED}


def quadratic(quantity: FamilyQuantity, with_slopes: bool) -> Callable[[Floats], Floats]:
    """Least squares of a full quadratic polynomial of the places for the logarithm of the last step."""
    places, sign = quantity.places, np.sign(quantity.values[0, -1])
    axes = places.shape[1]

    def basis(at: Floats) -> Floats:
        products = [at[:, i] * at[:, j] for i in range(axes) for j in range(i, axes)]
        return np.column_stack([np.ones(len(at)), at, *products])

    def slope(at: Floats, axis: int) -> Floats:
        step = 1e-4 * np.eye(axes)[axis]
        return (basis(at + step) - basis(at - step)) / 2e-4  # exact for a quadratic

    rows, right = [basis(places)], [np.log(np.abs(quantity.values[:, -1]))]
    if with_slopes and quantity.slopes is not None:
        rows += [slope(places, axis) for axis in range(axes)]
        right += list((quantity.slopes[:, :, -1] / quantity.values[:, [-1]]).T)
    found = np.linalg.lstsq(np.vstack(rows), np.concatenate(right), rcond=None)[0]
    return lambda at: sign * np.exp(basis(at) @ found)


def polynomial_chaos(quantity: FamilyQuantity) -> Callable[[Floats], Floats]:
    """A sparse chaos of Legendre polynomials up to degree four for the logarithm of the last step, its terms chosen by
    least angle regression (Blatman and Sudret, J. Comput. Phys. 230, 2011).
    """
    places, sign = quantity.places, np.sign(quantity.values[0, -1])
    grades = [g for g in product(range(CHAOS_DEGREE + 1), repeat=places.shape[1]) if 0 < sum(g) <= CHAOS_DEGREE]

    def basis(at: Floats) -> Floats:
        by_axis = legvander(at, CHAOS_DEGREE)  # (n, d, degree + 1)
        return np.stack([by_axis[:, np.arange(at.shape[1]), grade].prod(axis=1) for grade in grades], axis=1)

    chosen = LassoLarsCV(cv=min(5, len(places))).fit(basis(places), np.log(np.abs(quantity.values[:, -1])))
    return lambda at: sign * np.exp(chosen.predict(basis(at)))


def percent(answer: Floats, pressed: Floats) -> str:
    """The error that 95 % of the designs stay below, and the largest."""
    off = 100.0 * np.abs(answer - pressed) / np.abs(pressed)
    return f"{np.quantile(off, 0.95):6.2f} % {off.max():8.2f} %"


def compare(family: Family, places: Floats, pressed: dict[str, Floats]) -> None:
    """Print errors of all methods, and how often the intervals hold."""
    print(f"{len(family.places)} presses, {len(places)} unseen designs; 95 % of the errors below, and the largest")
    for name in JUDGED:
        quantity, last = family.quantities[name], pressed[name][:, -1]
        course = quantity.course(places)
        within = (course.low <= pressed[name]) & (pressed[name] <= course.high)
        bare = FamilyQuantity(quantity.places, quantity.values, None)
        print(f"{name}: the family                   {percent(course.value[:, -1], last)}")
        print(f"{name}: without derivatives          {percent(bare.course_values(places)[:, -1], last)}")
        for words, with_slopes in (("quadratic, derivatives", True), ("quadratic, none       ", False)):
            print(f"{name}: {words}       {percent(quadratic(quantity, with_slopes)(places), last)}")
        print(f"{name}: polynomial chaos, none       {percent(polynomial_chaos(quantity)(places), last)}")
        shares = 100.0 * within.all(axis=1).mean(), 100.0 * within[:, -1].mean()
        print(f"{name}: within the 95 % interval {shares[0]:.0f} % of whole courses, {shares[1]:.0f} % at full load")


def measure_time(family: Family) -> None:
    """Print the processor time of an answer, and of 100,000 at once."""
    start = time.process_time()
    for _ in range(ANSWERS):
        family.press()
    print(f"{1e3 * (time.process_time() - start) / ANSWERS:.1f} ms an answer")
    places = family.space.drawn_places(AT_ONCE, SEED)
    places = places[family.region.holds(places)]
    values = np.column_stack([one.values(column) for one, column in zip(family.space.ranges, places.T, strict=True)])
    start = time.process_time()
    family.at_values(values)
    print(f"{1e5 * (time.process_time() - start) / len(places):.1f} s for 100,000, with derivatives and intervals")


def main(folder: Path, count: int) -> None:
    """Press what is missing, and print the table."""
    family = load_family(folder)
    compare(family, *unseen(family, count, folder.with_name(f"{folder.name}-unseen.json")))
    measure_time(family)


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 200)
