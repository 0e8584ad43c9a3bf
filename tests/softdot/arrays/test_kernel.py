"""The kernel of an array: what its table gives for one dot and for several, and how it is filled and kept."""

import json
from pathlib import Path

import numpy as np
import pytest

from foundation.errors import InputError
from softdot.arrays.case import ArrayCase
from softdot.arrays.kernel import ArrayKernel, load_kernel
from softdot.arrays.kernel_checks import cells_by_chance, every_cell, places_by_chance
from softdot.arrays.kernel_errors import check, dot_places_mm, kernel_of, measure_errors
from softdot.arrays.kernel_presses import KernelPress, KernelTask, fill_kernel, grid_of
from softdot.arrays.matrix import crosstalk
from softdot.arrays.presses import ArrayPresses
from softdot.config.loading import load_config
from tests.cases import for_each

CELL = Path(__file__).parents[3] / "examples" / "array-cell.toml"
X, Y, DEPTH = np.linspace(-3.0, 3.0, 13), np.linspace(-2.0, 2.0, 9), np.linspace(0.0, 0.4, 5)


def plane(sinks=0.0):
    """Charge and force linear in depth; every dot pushes the surface down by a share of its depth everywhere."""
    charge = np.zeros((len(X), len(Y), len(DEPTH), 2))
    charge[..., 0], charge[..., 1] = 10.0 * DEPTH, X[:, None, None] * DEPTH
    force = np.broadcast_to(2.0 * DEPTH, charge.shape[:3])
    sinking = np.broadcast_to(sinks * DEPTH[:, None, None], (len(X), len(Y), len(DEPTH), len(X), len(Y)))
    return ArrayKernel(X, Y, DEPTH, charge, force, X, Y, DEPTH, sinking, {"labels": ["a", "b"]})


def dots(*places):
    return tuple(np.array([[place[axis] for place in places]]) for axis in range(3))


def test_one_dot_reads_the_table_between_its_nodes_and_nothing_beside_it():
    charge, force = plane().of_one(
        *(np.array(v) for v in ([0.3, 5.0, 0.0, 0.0], [0.1, 0.0, 0.0, 9.0], [0.25, 0.2, -0.1, 0.2]))
    )
    np.testing.assert_allclose(charge, [[2.5, 0.075], [0, 0], [0, 0], [0, 0]], atol=1e-12)
    np.testing.assert_allclose(force, [0.5, 0, 0, 0], atol=1e-12)


def test_dots_that_do_not_feel_each_other_add_up():
    charge, force = plane().of_many(*dots((1.0, 0.0, 0.2), (-2.0, 1.0, 0.3), (np.nan, np.nan, np.nan)))
    np.testing.assert_allclose(charge, [[5.0, -0.4]], atol=1e-12)
    np.testing.assert_allclose(force, [1.0], atol=1e-12)


def test_two_dots_share_what_each_has_pushed_down():
    """d = D - c d, so d = D / (1 + c); three rounds leave c^4 of it."""
    c, deep = 0.1, 0.3
    _, force = plane(c).of_many(*dots((1.0, 0.0, deep), (-1.0, 0.0, deep)))
    np.testing.assert_allclose(force, 2.0 * 2.0 * deep / (1.0 + c), rtol=2.0 * c**4)


def test_deeper_than_the_table_is_refused():
    with pytest.raises(InputError, match=r"a dot is 0\.5 mm deep: the kernel ends at 0\.4 mm"):
        plane().of_one(np.array([0.0]), np.array([0.0]), np.array([0.5]))
    with pytest.raises(InputError, match=r"0\.5 mm deep"):
        plane(0.5).of_many(*dots((1.0, 0.0, 0.5), (-1.0, 0.0, 0.4)))


def test_a_kernel_is_the_same_after_it_was_kept(tmp_path):
    plane(0.1).save(tmp_path)
    again = load_kernel(tmp_path)
    assert again.about["labels"] == ["a", "b"]
    np.testing.assert_allclose(again.charge_pC, plane().charge_pC, rtol=1e-6)
    np.testing.assert_allclose(again.sinking_mm, plane(0.1).sinking_mm, rtol=1e-6)


@pytest.mark.parametrize(
    ("damage", "sentence"),
    [
        (lambda folder: (folder / "kernel.npz").unlink(), "is missing"),
        (lambda folder: (folder / "kernel.npz").write_bytes(b"PK\3\4"), "cannot be read"),
        (lambda folder: (folder / "kernel.json").write_text("[", "utf-8"), "cannot be read"),
        (
            lambda folder: (folder / "kernel.json").write_text('{"format": "other/1"}', "utf-8"),
            "must be 'softdot-kernel/1'",
        ),
    ],
)
def test_what_is_no_kernel_is_refused_in_a_sentence(tmp_path, damage, sentence):
    plane().save(tmp_path)
    damage(tmp_path)
    with pytest.raises(InputError, match=sentence):
        load_kernel(tmp_path)


def rewritten(change):
    """A change of what kernel.json says."""

    def damage(folder):
        told = json.loads((folder / "kernel.json").read_text("utf-8"))
        (folder / "kernel.json").write_text(json.dumps(change(told)), "utf-8")

    return damage


def with_axes_reversed(folder):
    tables = dict(np.load(folder / "kernel.npz"))
    np.savez(folder / "kernel.npz", **{**tables, "x_mm": tables["x_mm"][::-1]})


@pytest.mark.parametrize(
    ("damage", "sentence"),
    [
        (rewritten(lambda told: {**told, "labels": told["labels"][::-1]}), "one of which was changed; make it again"),
        (rewritten(lambda told: {**told, "remark": "mine"}), "one of which was changed"),
        (with_axes_reversed, "one of which was changed"),
        (lambda folder: plane(0.3).save(folder.parent) or _exchanged(folder), "one of which was changed"),
        (rewritten(lambda told: {n: v for n, v in told.items() if n != "checksum_sha256"}), "has no checksum_sha256"),
        (rewritten(lambda told: [told]), "must be 'softdot-kernel/1'"),
    ],
)
def test_a_kernel_that_was_changed_is_refused(tmp_path, damage, sentence):
    (tmp_path / "kernel").mkdir()
    plane().save(tmp_path / "kernel")
    load_kernel(tmp_path / "kernel")
    damage(tmp_path / "kernel")
    with pytest.raises(InputError, match=sentence):
        load_kernel(tmp_path / "kernel")


def _exchanged(folder):
    """The numbers of another kernel."""
    (folder.parent / "kernel.npz").replace(folder / "kernel.npz")


def known(case, nodes_mm, x, y):
    """A press by formulas: charges fall with the distance from each segment, and the surface with that from the dot."""
    depth = np.linspace(0.0, 0.3, 4)
    away = np.hypot(*(case.layout.middles - [x, y]).T)
    places = np.stack(np.meshgrid(*nodes_mm, indexing="ij"), axis=-1)
    sunk = np.exp(-np.hypot(places[..., 0] - x, places[..., 1] - y))
    return KernelPress(
        depth, depth * (1.0 + x**2 + 2.0 * y**2), depth[:, None] * np.exp(-away), depth[:, None, None] * sunk
    )


def test_mirror_images_fill_the_table_where_no_press_was_solved():
    case = ArrayCase(load_config(CELL))
    grid = grid_of(case)
    x, y = grid.nodes_mm
    assert len(grid.tasks()) < 0.35 * len(grid.all)
    kernel = fill_kernel(grid, {node: known(case, grid.nodes_mm, x[node[0]], y[node[1]]) for node in grid.tasks()})
    for i, j in grid.all[::7]:
        told = known(case, grid.nodes_mm, x[i], y[j])
        np.testing.assert_allclose(kernel.sinking_mm[i, j], told.sinking_mm, atol=1e-12)
    inside = np.array([1.0, -0.7, -2.2]), np.array([0.4, -3.0, 2.6])
    charge, force = kernel.of_one(*inside, np.full(3, 0.3))
    for number, (a, b) in enumerate(zip(*inside, strict=True)):
        told = known(case, grid.nodes_mm, a, b)
        np.testing.assert_allclose(charge[number], told.charge_pC[-1], atol=0.02 * 0.3)
        np.testing.assert_allclose(force[number], told.force_N[-1], rtol=0.02)


def test_a_press_of_the_table_itself_has_no_error_and_another_one_has():
    kernel = plane()
    charge = np.stack([10.0 * DEPTH, 1.0 * DEPTH], axis=1)
    at = np.array([[1.0, 0.5]])
    exact = check(kernel, "itself", at, DEPTH, charge, 2.0 * DEPTH)
    assert exact.charge_percent < 1e-10
    assert exact.force_percent < 1e-10
    off = check(kernel, "another", at, DEPTH, charge * 1.25, 2.0 * DEPTH * 0.8)
    assert off.charge_percent == pytest.approx(20.0)
    assert off.force_percent == pytest.approx(25.0)


def places(config):
    return dot_places_mm(KernelTask(config, ((0.0,), (0.0,))))


def test_cells_by_chance_stand_where_their_dots_are_said_to_be():
    case = ArrayCase(load_config(CELL))
    configs = list(cells_by_chance(case, 2).values())
    assert [len(places(config)) for config in configs] == [1, 2, 3, 4, 5, 6] * 2
    for at in map(places, configs):
        # the dots of a cell lie on a grid of 2.5 mm, 0.83 mm at most beside the middles of the segments
        away = at[:, None] - case.layout.middles
        shift = away[0][np.hypot(*away[0].T).argmin()]
        np.testing.assert_allclose(np.abs(away - shift).max(axis=2).min(axis=1), 0.0, atol=1e-9)


@for_each(("settings", "images"), [([], 4), (["array.cells=2", "array.cell_pitch_mm=6.0"], 2)])
def test_every_cell_is_pressed_once_or_a_mirror_image_of_it(settings, images):
    case = ArrayCase(load_config(CELL, settings))
    middles = case.layout.middles
    found = set()
    for config in every_cell(case).values():
        at = places(config)
        assert config.press.indentation_mm == case.config.press.indentation_mm
        mirrored = [at, at * [1, -1], at * [-1, 1], at * [-1, -1]]
        new = {tuple(sorted(map(tuple, np.round(one, 6)))) for one in mirrored[:images]}
        assert not new & found
        assert all((np.abs(middles - one).max(axis=1) < 1e-6).any() for cell in new for one in cell)
        found |= new
    assert len(found) == 63


def test_an_array_smaller_than_a_cell_is_checked_by_one_dot_alone():
    config = load_config(CELL, ["array.rows=1"])
    case = ArrayCase(config.model_copy(update={"dot": config.dot.model_copy(update={"cell": None})}))
    assert (len(places_by_chance(case, 3)), cells_by_chance(case, 2), every_cell(case)) == (3, {}, {})


@pytest.mark.parametrize(
    ("setting", "sentence"),
    [
        ("dot.gap_mm=0.1", r"dot\.gap_mm = 0\.1: depths of a kernel begin at the touch"),
        ("dot.tilt_deg=[1.0, 0.0]", r"dot\.tilt_deg = \[1\.0, 0\.0\]: a kernel is of an upright dot"),
        ("press.force_N=0.2", r"press\.force_N = 0\.2: a kernel is a table over depth"),
    ],
)
def test_what_a_table_over_depth_does_not_hold_is_refused(tmp_path, setting, sentence):
    path = tmp_path / "array.toml"
    path.write_text(CELL.read_text("utf-8").replace("indentation_mm = 0.3\n", ""), "utf-8")
    with pytest.raises(InputError, match=sentence):
        ArrayCase(load_config(path, [setting])).refuse_kernel()


@pytest.mark.evidence
def test_a_kernel_foretells_presses_that_took_no_part_in_it():
    settings = [
        "array.rows=1", "press.indentation_mm=0.2", "press.load_steps=3", "mesh.element_size_mm=0.6",
        "mesh.contact_element_size_mm=0.2",
    ]  # fmt: skip
    config = load_config(CELL, settings)
    case = ArrayCase(config.model_copy(update={"dot": config.dot.model_copy(update={"cell": None})}))
    matrix = crosstalk(case, ArrayPresses())
    kernel, stated = kernel_of(case, matrix, lambda *_: None)
    worst = max(one.charge_percent for one in stated)
    assert worst < 15.0  # twice the element sizes count too
    for one in measure_errors(kernel, places_by_chance(case, 4, seed=1), lambda *_: None):
        assert one.charge_percent < 1.5 * worst
        assert one.force_percent < 10.0
