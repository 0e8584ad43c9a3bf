"""A press that was stopped goes on only where all that it depends on is as it was."""

from dataclasses import replace

import numpy as np

from softdot.case import Case
from softdot.config.hashes import input_hash
from softdot.config.loading import config_from
from softdot.config.schema import Config
from softdot.prepared_press import press_key
from tests.cases import for_each
from tests.softdot.stand_ins import one_tetrahedron

SLOW, FAST = "time_s,fraction\n0,0\n2,1\n", "time_s,fraction\n0,0\n1,1\n"


def configured(wave: str) -> Config:
    layers = {"medium1": {"thickness_mm": 0.5}, "film": {"thickness_um": 28.0}, "medium2": {"thickness_mm": 2.0}}
    return config_from({"segment": layers, "press": {"waveform": {"shape": "file", "file": wave}}})


def test_a_waveform_that_was_edited_is_another_press(tmp_path):
    wave = tmp_path / "wave.csv"
    config = configured(str(wave))
    wave.write_text(SLOW, "utf-8")
    key = press_key(Case(config), one_tetrahedron())
    assert press_key(Case(config), one_tetrahedron()) == key
    wave.write_text(FAST, "utf-8")
    assert press_key(Case(config), one_tetrahedron()) != key


def test_an_own_mesh_that_was_edited_is_another_input(tmp_path):
    file = tmp_path / "mine.inp"
    config = configured("none.csv")
    config = config.model_copy(update={"mesh": config.mesh.model_copy(update={"file": str(file)})})
    file.write_text("*NODE\n", "utf-8")
    before = input_hash(config)
    assert input_hash(config) == before
    file.write_text("*NODE\n1, 0, 0, 0\n", "utf-8")
    assert input_hash(config) != before


TOP = {"contact": np.array([[0, 1, 2, 3, 4, 5]])}


@for_each("change", [{"facets": TOP}, {"thickness_mm": 2.0}, {"twin": np.zeros(10, int)}])
def test_other_contact_facets_thickness_or_twins_are_another_press(change):
    config, same = configured("none.csv"), one_tetrahedron()
    assert press_key(Case(config), replace(same, **change)) != press_key(Case(config), same)
