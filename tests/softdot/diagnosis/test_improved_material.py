"""A coupon's material as a configuration that can be run."""

from types import SimpleNamespace

import pytest

from diagnose.forward import Setting
from softdot.config.loading import load_config
from softdot.config.model import model_of
from softdot.diagnosis.improved import improved_text
from tests.diagnose.coupon.coupons import candidate, engine, specimen
from tests.diagnose.verdict.toy import LEAK, fitted

RIG = SimpleNamespace(config=None, recording=SimpleNamespace(specimen=specimen()))


def improved(mechanism, tmp_path, **shared):
    """The configuration when a mechanism of the specimen is named at its first starts; shared : nuisances fitted."""
    of = engine()
    its = candidate(of, mechanism)
    values = tuple(c.starts[0] for c in its.coordinates)
    best = SimpleNamespace(settings=(Setting(its, values),), shared=shared)
    path = tmp_path / "improved.toml"
    path.write_text(improved_text(RIG, of, SimpleNamespace(best=best)), "utf-8")
    return load_config(path)


def test_a_law_of_another_form_becomes_the_material_of_medium_2(tmp_path):
    config = improved("hyperelastic-stiffening", tmp_path)
    assert config.segment.medium2.material == "mine"
    assert config.materials["mine"].model != "neo-hookean"
    assert config.mechanisms == ()


def test_relaxation_becomes_a_mechanism_of_medium_2(tmp_path):
    config = improved("viscoelasticity", tmp_path)
    assert config.materials["mine"].youngs_modulus_MPa == pytest.approx(1.2)
    (relaxing,) = config.mechanisms
    assert (relaxing.name, relaxing.component) == ("viscoelasticity", "medium2")
    assert "medium2" in model_of(config).physics.inelastic


def test_the_modulus_is_that_which_was_fitted(tmp_path):
    """Of a tape that has relaxed before the first second is over it may be several times the one stated."""
    config = improved("viscoelasticity", tmp_path, **{"modulus.specimen": 2.5, "offset_N": 0.1})
    assert config.materials["mine"].youngs_modulus_MPa == pytest.approx(3.5 * 1.2)
    assert [one.name for one in config.mechanisms] == ["viscoelasticity"]


def test_a_coupon_that_teaches_nothing_and_a_sensor_nobody_knows_leave_no_configuration():
    unknown = SimpleNamespace(config=None, recording=SimpleNamespace(specimen=None))
    assert improved_text(RIG, engine(), SimpleNamespace(best=None)) is None
    assert improved_text(unknown, None, SimpleNamespace(best=fitted(LEAK, 0.5))) is None
