"""What a file leaves out comes from the default design, and a recording's rig.toml never does."""

import pytest

from foundation.errors import InputError
from softdot.case import Case
from softdot.config.hashes import config_hash
from softdot.config.loading import load_config
from softdot.config.rig import load_rig
from tests.cases import for_each

DEFAULT = load_config()


@pytest.fixture
def loaded(tmp_path):
    def load(text, *settings):
        path = tmp_path / "mine.toml"
        path.write_text(text, "utf-8")
        return load_config(path, settings)

    return load


def test_an_empty_file_is_the_default_design(loaded):
    assert config_hash(loaded("")) == config_hash(DEFAULT)
    assert loaded("") == DEFAULT
    assert loaded("").from_default == DEFAULT.from_default


def test_one_key_changes_one_value_and_the_rest_is_told(loaded):
    config = loaded('[dot]\nstandard = "ada"')
    assert config.dot.standard == "ada"
    assert config.segment == DEFAULT.segment
    told = {"segment.film.thickness_um", "segment.effector.height_mm", "press.indentation_mm"}
    assert told <= set(config.from_default)
    assert "dot.standard" not in config.from_default


def test_another_material_keeps_the_thickness_of_the_default(loaded):
    config = loaded('[segment.medium2]\nmaterial = "ecoflex-00-50"')
    assert (config.segment.medium2.material, config.segment.medium2.thickness_mm) == ("ecoflex-00-50", 2.0)
    assert "segment.medium2.thickness_mm" in config.from_default
    assert "segment.medium2.material" not in config.from_default


def test_a_file_that_states_the_whole_stack_gets_no_effector(loaded):
    config = loaded("[segment]\nmedium1.thickness_mm = 0.5\nfilm.thickness_um = 28.0\nmedium2.thickness_mm = 2.0")
    assert config.segment.effector is None
    assert not any(key.startswith("segment.effector") for key in config.from_default)


def test_a_dome_needs_its_diameter(loaded):
    config = loaded('[segment.effector]\nshape = "dome"')
    with pytest.raises(InputError, match=r"segment.effector.diameter_mm is missing: shape = 'dome' needs it"):
        _ = Case(config).checked_design


def test_an_explicit_dot_does_not_meet_the_standard_of_the_default(loaded):
    config = loaded("[dot]\nradius_mm = 1.0")
    _ = Case(config).checked_design
    assert config.dot.standard is None
    assert "dot.standard" not in config.from_default


def test_a_force_takes_the_place_of_the_depth(loaded):
    config = loaded("[press]\nforce_N = 2.0")
    assert config.press.indentation_mm is None
    assert "press.indentation_mm" not in config.from_default


def test_a_slice_is_pressed_by_a_ridge(loaded):
    config = loaded('[segment]\nsection = "plane-strain"')
    _ = Case(config).checked_design
    assert config.dot.shape == "ridge"


def test_another_law_inherits_no_constant_of_the_built_in_material(loaded):
    with pytest.raises(InputError, match=r"materials.vnr.c10_MPa is missing"):
        loaded('[materials.vnr]\nmodel = "yeoh"')


def test_a_wrong_kind_of_table_is_still_refused_by_name(loaded):
    with pytest.raises(InputError, match=r"segment.film = 28: must be a table"):
        loaded("[segment]\nfilm = 28")
    with pytest.raises(InputError, match=r"segment = 1: must be a table"):
        loaded("segment = 1")


def test_a_recording_says_what_was_built(tmp_path):
    (tmp_path / "rig.toml").write_text(
        'format = "softdot-recording/1"\n[dot]\nstandard = "ada"\n[[runs]]\nfile = "a.csv"\nlabel = "a"\n'
        'drive = "displacement_mm"\n',
        "utf-8",
    )
    with pytest.raises(InputError, match=r"segment.medium1.thickness_mm is missing"):
        load_rig(tmp_path)


def test_set_changes_a_value_after_the_file(loaded):
    settings = ("press.indentation_mm=0.2", "dot.standard=ada", "dot.offset_mm=[0.1, 0.0]")
    config = loaded("[press]\nindentation_mm = 0.1", *settings)
    assert (config.press.indentation_mm, config.dot.standard, config.dot.offset_mm) == (0.2, "ada", (0.1, 0.0))
    assert "dot.standard" not in config.from_default


@for_each(
    ("setting", "said"),
    [
        ("press", "--set press: must be key=value"),
        ("press.indentation_mm=deep", "--set press.indentation_mm=deep: press.indentation_mm = 'deep': must be a"),
        ("press.indentation_mm=-1", "--set press.indentation_mm=-1: press.indentation_mm = -1: must be above 0"),
        ("press.depth=1", "--set press.depth=1: press.depth is not a key"),
        ("dot.offset_mm[0]=1", r"--set dot.offset_mm\[0\]=1: 'dot.offset_mm\[0\]': there is no element"),
        ("dot.offset_mm=[1", r"--set dot.offset_mm=\[1: the value is not TOML"),
        ("seed=1\nb=2", "must be a single value"),
        ("=3", "--set =3: must not be empty"),
    ],
)
def test_a_bad_setting_names_its_flag(loaded, setting, said):
    with pytest.raises(InputError, match=said):
        loaded("", setting)
