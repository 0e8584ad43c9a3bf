"""A kernel learned from touches: what it reads, what must not change it, and what is refused."""

import csv
import json
import shutil
from dataclasses import replace

import numpy as np
import pytest

from foundation.errors import InputError
from softdot.cli import main
from softdot.progress import Untold
from softdot.reading.learned_kernel.answers import answer_touches
from softdot.reading.learned_kernel.kernel_file import load_learned_kernel
from softdot.reading.learned_kernel.layout import layout_warnings
from softdot.reading.learned_kernel.learning import learn_kernel
from softdot.reading.learned_kernel.superposition import PLACES, superposed_courses
from softdot.reading.learned_kernel.touches import Touches, join_touches, letter_cells
from tests.cases import for_each
from tests.softdot.reading.made_touches import made_touches

pytestmark = pytest.mark.press

MET, NOT_MET = "abcdefgijlmnpqstuw", "hkorvx"


def touches_of(letters, repeats, seed, **more):
    made = made_touches(letters, repeats, seed)
    cells = np.array([letter_cells()[str(one)] for one in made["letter"]])
    return Touches(made["taxels"], made["sampling_Hz"], cells, **more)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("learned")
    np.savez(path / "met.npz", **made_touches(MET, 5))
    np.savez(path / "others.npz", **made_touches(MET[:6] + NOT_MET, 4, seed=1))
    assert main(["read", "--learn", str(path / "met.npz"), "-q", "-o", str(path / "kernel")]) == 0
    return path


@pytest.fixture(scope="module")
def kernel(folder):
    return load_learned_kernel(folder / "kernel")


@pytest.fixture(scope="module")
def usual(kernel):
    return answer_touches(kernel, touches_of(MET[:6] + NOT_MET, 4, 1), "all").probability


def test_letters_are_read_that_were_learned_and_that_were_not(kernel, usual):
    cells = touches_of(MET[:6] + NOT_MET, 4, 1).cells
    right = usual.argmax(axis=1) == cells
    assert right[:24].mean() > 0.9
    assert right[24:].mean() > 0.6
    five = touches_of(NOT_MET, 5, 2, together=np.repeat(np.arange(6), 5))
    together = answer_touches(kernel, five, "all").together
    assert [count for _, count, _ in together] == [5] * 6
    assert np.mean([row.argmax() == cell for (_, _, row), cell in zip(together, five.cells[::5], strict=True)]) > 0.8


def test_the_files_say_what_was_read(folder, tmp_path, capfd):
    command = ["read", "--kernel", str(folder / "kernel"), "--recording", str(folder / "others.npz"), "--json", "-q"]
    assert main([*command, "-o", str(tmp_path / "out")]) == 0
    told = json.loads(capfd.readouterr().out)
    assert told == json.loads((tmp_path / "out" / "cells.json").read_text("utf-8"))
    with (tmp_path / "out" / "cells.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(told["touches"]) == 48
    for row, one in zip(rows, told["touches"], strict=True):
        assert [row[f"cell_{place}"] for place in range(1, 6)] == [best["cell"] for best in one["best"]]
        sure = one["best"][0]["probability"] >= 0.9 and not one["unlike"]
        assert one["answer"] == (one["best"][0]["cell"] if sure else "?")
        assert row["answer"] == one["answer"]
    assert told["cells"] == "".join(one["answer"] for one in told["touches"])
    assert told["score"]["cells"]["right"] == sum(one["best"][0]["cell"] == one["true"] for one in told["touches"])


def test_probabilities_do_not_depend_on_the_order_of_touches_or_on_the_resting_values(kernel, usual):
    asked = touches_of(MET[:6] + NOT_MET, 4, 1)
    order = np.random.default_rng(3).permutation(len(asked.taxels))
    np.testing.assert_allclose(answer_touches(kernel, asked.part(order), "all").probability, usual[order], atol=1e-9)
    raised = Touches(asked.taxels + np.arange(6.0), asked.sampling_Hz)
    np.testing.assert_allclose(answer_touches(kernel, raised, "all").probability, usual, atol=1e-9)


def test_other_channels_and_units_in_both_recordings_and_a_channel_of_clipped_noise_change_nothing(usual):
    def changed(values):
        noise = np.maximum(np.random.default_rng(7).standard_normal((*values.shape[:2], 1)), 0.5)
        return 1e3 * np.concatenate([values[:, :, [3, 0, 5, 1, 4, 2]], noise], axis=2)

    met, asked = touches_of(MET, 5, 0), touches_of(MET[:6] + NOT_MET, 4, 1)
    kernel = learn_kernel(Touches(changed(met.taxels), met.sampling_Hz, met.cells), False, Untold())
    assert kernel.about["channels_heard"] == [1, 2, 3, 4, 5, 6]
    found = answer_touches(kernel, Touches(changed(asked.taxels), asked.sampling_Hz), "all").probability
    np.testing.assert_allclose(found, usual, atol=2e-3)


def test_dots_of_one_row_differ_by_the_lag_and_those_of_one_column_by_a_pitch_across():
    courses = np.random.default_rng(0).standard_normal((3, len(PLACES), 32, 2))
    superposed = superposed_courses(np.array([1, 6, 8]), np.ones((3, len(PLACES))), courses, 4.0)
    empty, dot_1, dot_2, dot_4 = superposed[[0, 1, 2, 8]] - superposed[0]
    assert not empty.any()
    low, high = 0, np.flatnonzero(np.isclose(PLACES, PLACES[0] + 1.0))[0]
    np.testing.assert_allclose(dot_1[low], dot_2[high], atol=1e-9)
    np.testing.assert_allclose(dot_1[:, :-4], dot_4[:, 4:], atol=1e-9)


def refused(arguments, out, capfd):
    assert main(["read", *map(str, arguments), "-q", "-o", str(out)]) == 2
    said = capfd.readouterr().err
    assert said.startswith("softdot: "), said
    assert said.count("\n") == 1
    assert not out.exists()
    return said


def test_a_changed_kernel_is_refused(folder, tmp_path, capfd):
    for name, change in {
        "kernel.json": lambda data: data.replace(b'"sampling_Hz": 50.0', b'"sampling_Hz": 51.0'),
        "kernel.npz": lambda data: data[:-40],
    }.items():
        changed = tmp_path / f"changed-{name}"
        shutil.copytree(folder / "kernel", changed)
        before = (changed / name).read_bytes()
        (changed / name).write_bytes(change(before))
        assert (changed / name).read_bytes() != before
        said = refused(["--kernel", changed, "--recording", folder / "others.npz"], tmp_path / "out", capfd)
        assert "softdot read --learn" in said


def damaged(**changes):
    return {**made_touches("abcdefgh", 4), **changes}


def with_nan():
    made = made_touches("abcdefgh", 4)
    made["taxels"][3, 2, 1] = np.nan
    return made


@for_each(
    "arrays, says",
    [
        (with_nan(), "taxels[3, 2, 1]: is not finite"),
        (damaged(taxels=np.ones((32, 40))), "taxels has the shape (32, 40)"),
        (damaged(taxels=np.full((32, 40, 6), 1e200)), "taxels[0, 0, 0]: is 1e+200, it must be below 1e+30"),
        ({"signals": np.ones(3)}, "taxels is missing among signals"),
        (damaged(sampling_Hz=0.0), "sampling_Hz must be one number above 0"),
        (damaged(letter=np.array(["ß"] * 32)), "letter[0] = 'ß'"),
        (damaged(letter=np.array(["a"] * 31)), "one text for each of the 32 touches"),
        ({"taxels": made_touches("abcdefgh", 4)["taxels"], "sampling_Hz": 50.0}, "letter is missing"),
        (made_touches("abcdefgh", 1), "at least"),
        (made_touches("abc", 9), "at least"),
        (damaged(place_mm=np.ones((32, 39))), "place_mm has the shape"),
    ],
)
def test_touches_that_nothing_can_be_learned_from_are_one_sentence(arrays, says, tmp_path, capfd):
    np.savez(tmp_path / "bad.npz", **arrays)
    assert says in refused(["--learn", tmp_path / "bad.npz"], tmp_path / "out", capfd)


def test_a_file_that_is_no_npz_is_one_sentence(tmp_path, capfd):
    for content in (b"", b"time_s,voltage_1_V\n0,1\n"):
        (tmp_path / "touches.npz").write_bytes(content)
        assert "is no NPZ file" in refused(["--learn", tmp_path / "touches.npz"], tmp_path / "out", capfd)


def test_recordings_of_another_sensor_are_one_sentence(folder, tmp_path, capfd):
    made = made_touches("abc", 2)
    for changes, says in (
        ({"taxels": made["taxels"][:, :, :5]}, "5 channels, the kernel has 6"),
        ({"taxels": made["taxels"][:, :30]}, "0.6 s"),
        ({"sampling_Hz": 5.0}, "s"),
    ):
        np.savez(tmp_path / "other.npz", **{**made, **changes})
        said = refused(["--kernel", folder / "kernel", "--recording", tmp_path / "other.npz"], tmp_path / "out", capfd)
        assert says in said
    said = refused(["a text", "--kernel", folder / "kernel"], tmp_path / "out", capfd)
    assert "text" in said
    assert "--recording is missing" in refused(["--kernel", folder / "kernel"], tmp_path / "out", capfd)
    assert "--learn" in refused(["--learn", folder / "met.npz", "--noise-mV", "2"], tmp_path / "out", capfd)


def test_another_rate_is_read(kernel, usual):
    asked = touches_of(MET[:6] + NOT_MET, 4, 1)
    double = Touches(np.repeat(asked.taxels, 2, axis=1), 2.0 * asked.sampling_Hz)
    np.testing.assert_allclose(answer_touches(kernel, double, "all").probability, usual, atol=0.1)


@for_each(
    "changed, says",
    [
        (
            lambda values: 3.0 + np.random.default_rng(5).standard_normal(values.shape).cumsum(axis=1),
            "24 of 24 touches are unlike all that were learned",
        ),
        (lambda values: np.full_like(values, 7.0), "24 of 24 touches change less than the noise at rest"),
        (lambda values: 0.1 * values, "of that of the learned touches: other units"),
        (lambda values: 0.5 * values, "times as large as the learned ones of their cells, 0.65 to 1.5 is allowed"),
        (lambda values: values[:, :, [1, 0, 2, 3, 5, 4]], "touches are of another kind than the learned ones"),
        (lambda values: values[:, ::-1], "touches are of another kind than the learned ones"),
    ],
    ids=["noise", "dead", "other units", "half the gain", "exchanged channels", "backward"],
)
def test_what_is_no_braille_of_this_sensor_is_never_a_cell(changed, says, folder, tmp_path, capfd):
    made = made_touches("abcdef", 4)
    np.savez(tmp_path / "other.npz", **{**made, "taxels": changed(made["taxels"])})
    command = ["read", "--kernel", str(folder / "kernel"), "--recording", str(tmp_path / "other.npz"), "--json", "-q"]
    assert main([*command, "-o", str(tmp_path / "out")]) == 3
    told, said = capfd.readouterr()
    assert json.loads(told)["cells"] == "?" * 24
    assert says in said


def test_a_dead_channel_and_arrays_that_are_not_read_are_told(folder, tmp_path, capfd):
    made = made_touches("abcdef", 4)
    made["taxels"][:, :, 3] = 3.0
    made["letters"] = made.pop("letter")
    np.savez(tmp_path / "other.npz", **made)
    command = ["read", "--kernel", str(folder / "kernel"), "--recording", str(tmp_path / "other.npz"), "-q"]
    main([*command, "-o", str(tmp_path / "out")])
    said = capfd.readouterr().err
    assert "channels that never change, though the kernel needs them: 4" in said
    assert "letters: not read" in said


def test_touches_are_compared_over_the_place_where_it_was_measured():
    def placed(seed):
        touches = touches_of(MET[:12], 4, seed)
        return replace(touches, place_mm=np.tile(np.linspace(0.0, 10.0, 40), (48, 1)))

    kernel, asked = learn_kernel(placed(0), False, Untold()), placed(1)
    assert np.mean(answer_touches(kernel, asked, "all").probability.argmax(axis=1) == asked.cells) > 0.9
    with pytest.raises(InputError, match="place_mm is missing"):
        answer_touches(kernel, replace(asked, place_mm=None), "all")
    with pytest.raises(InputError, match="from 0 to 10 mm"):
        answer_touches(kernel, replace(asked, place_mm=asked.place_mm + 5.0), "all")


def test_time_and_channels_exchanged_and_another_order_of_channels_are_told():
    first, second = (touches_of(MET, 4, seed) for seed in (0, 1))
    assert layout_warnings([first, second], ["one.npz", "two.npz"]) == []
    turned = replace(first, taxels=first.taxels.swapaxes(1, 2))
    assert "'one.npz': taxels (72, 6, 40) change" in layout_warnings([turned], ["one.npz"])[0]
    mixed = replace(second, taxels=second.taxels[:, :, [0, 4, 2, 3, 1, 5]])
    (told,) = layout_warnings([first, mixed], ["one.npz", "two.npz"])
    assert "'two.npz': channels 2, 5 look like channels 5, 2 of 'one.npz'" in told


def test_several_files_of_one_sensor_are_one():
    whole = touches_of(MET, 5, 0)
    parts = [whole.part(np.arange(40)), whole.part(np.arange(40, 90))]
    joined = join_touches(parts, ["one.npz", "two.npz"])
    np.testing.assert_array_equal(joined.taxels, whole.taxels)
    np.testing.assert_array_equal(joined.cells, whole.cells)
    with pytest.raises(InputError, match=r"'two\.npz': has 49"):
        join_touches([parts[0], replace(parts[1], sampling_Hz=49.0)], ["one.npz", "two.npz"])
