"""softdot material: files of testing machines, the laws behind them, and what is refused."""

import json

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.special import erf

from diagnose.engines.coupon.kinematics import coupon_kinematics
from diagnose.engines.coupon.point import MaterialPoint
from foundation.errors import InputError
from softdot.cli import main
from softdot.config.loading import load_config
from softdot.config.toml import read_toml
from softdot.material.course import HOLD, LOADING, UNLOADING, course_of
from softdot.material.elastic_fit import FittedLaw, LoadingCurve, fit_law, rank_laws
from softdot.material.memory_fit import MATERIAL, FittedMaterial, fit_memory, without_blocks
from softdot.material.outcome import relaxed_share
from softdot.material.specimen_file import KINDS, SpecimenTest, read_test
from softdot.material.stable_laws import STABLE_LAWS, Deformation, laws_for
from tests.cases import for_each

STRAIN = np.linspace(0.0, 0.6, 61)
C10, C20 = 0.1, 0.02
LAWS = {law.name: law for law in STABLE_LAWS}


def yeoh_kPa(strain, c10=C10, c20=C20):
    """Nominal stress of an incompressible strip: 2 (l - l^-2) (c10 + 2 c20 (I1 - 3))."""
    stretch = 1.0 + strain
    return 2e3 * (stretch - stretch**-2) * (c10 + 2.0 * c20 * (stretch**2 + 2.0 / stretch - 3.0))


def table(head, *columns, separator=","):
    return "\n".join([*head, *(separator.join(f"{value:.9g}" for value in row) for row in zip(*columns, strict=True))])


FORCE_N = 1e-3 * 12.0 * yeoh_kPa(STRAIN)
FILES = {
    "plain": (table(["time (s),strain (%),stress (kPa)"], STRAIN, 100 * STRAIN, yeoh_kPa(STRAIN)), []),
    "instron": (
        table(
            ['"Specimen label","A1"', '"Width","6","mm"', '"Thickness","2","mm"', '"Gauge length","25","mm"', "",
             "Time,Extension,Load,Comment", "(s),(mm),(kN),"],
            STRAIN, 25.0 * STRAIN, 1e-3 * FORCE_N, STRAIN),
        [],
    ),
    "zwick": (
        table(["Probe;1", "a0;2;mm", "b0;6;mm", "L0;25;mm", "", "Standardweg;Standardkraft", "mm;N"],
              25.0 * STRAIN, FORCE_N, separator=";").replace(".", ","),
        [],
    ),
    "options": (
        table(["pos,load", "mm,N"], 50.0 * STRAIN, FORCE_N),
        ["--gauge-length-mm", "50", "--area-mm2", "12"],
    ),
    "by hand": (
        table([], STRAIN, STRAIN, 1e-3 * yeoh_kPa(STRAIN)),
        ["--columns", "time (s),strain (-),stress (MPa)"],
    ),
    "true beside nominal": (
        table(["Specimen Width (mm);6", "Specimen Length (mm);25",
               "True Strain;True Stress (MPa);Engineering Strain;Engineering Stress (MPa)"],
              np.log1p(STRAIN), STRAIN, STRAIN, 1e-3 * yeoh_kPa(STRAIN), separator=";"),
        [],
    ),
}  # fmt: skip


@pytest.fixture
def material(tmp_path, capfd):
    """Run softdot material on a text; material.json."""

    def made(text, *options, status=0):
        (tmp_path / "test.csv").write_text(text, "utf-8")
        assert main(["material", str(tmp_path / "test.csv"), "-o", str(tmp_path / "rubber"), "-q", *options]) == status
        said = capfd.readouterr().err
        return json.loads((tmp_path / "rubber" / "material.json").read_text("utf-8")) if status == 0 else said

    return made


@for_each(("text", "options"), FILES.values(), ids=FILES)
def test_the_law_behind_a_file_is_found(text, options, tmp_path):
    """Whatever machine wrote it: constants of an exact Yeoh curve."""
    path = tmp_path / "test.csv"
    path.write_text(text, "utf-8")
    named = dict(zip((one[2:].replace("-", "_") for one in options[::2]), options[1::2], strict=True))
    columns = named.pop("columns", None)
    test = read_test(path, "tension", {name: float(value) for name, value in named.items()}, columns)
    np.testing.assert_allclose(test.strain, STRAIN, atol=1e-8)
    np.testing.assert_allclose(test.stress_MPa, 1e-3 * yeoh_kPa(STRAIN), rtol=1e-6, atol=1e-9)
    fitted = fit_law(LAWS["yeoh"], [LoadingCurve("tension", test.strain, test.stress_MPa)], None)
    np.testing.assert_allclose(fitted.constants, [C10, C20, 0.0], atol=2e-4)
    assert fitted.slack[0] < 2e-4


@pytest.mark.process
def test_a_configuration_includes_the_material(material, tmp_path):
    """The command whole: slack is told and taken out, the law of the data is chosen, its range is that of the fit."""
    late = np.maximum(STRAIN - 0.02, 0.0)
    found = material(table(["strain,stress (kPa)"], STRAIN, yeoh_kPa(late)), "--strain-range-percent", "40")
    best = found["laws"][0]
    assert best["name"] in ("yeoh", "knowles", "fung")  # the first two terms of both are Yeoh's
    assert found["error"] < 1e-3
    assert best["slack"][0] == pytest.approx(0.02, abs=1e-3)
    assert any("slack" in one for one in found["warnings"])
    stated = {one["what"]: one for one in found["values"]}["stress in tension at 10 %"]
    assert stated["low_MPa"] <= 1e-3 * yeoh_kPa(0.1) * 1.002
    assert stated["high_MPa"] >= 1e-3 * yeoh_kPa(0.1) * 0.998
    own = tmp_path / "mine.toml"
    own.write_text(
        'include = ["rubber/material.toml"]\nsegment.medium2.material = "rubber"\nmaterials.rubber.density_kg_m3 = 900'
    )
    read = load_config(own).materials["rubber"]
    assert read.max_fitted_strain == pytest.approx(0.4, abs=0.02)
    assert read.density_kg_m3 == 900.0
    assert read.law.shear_modulus == pytest.approx(2.0 * C10, rel=0.01)
    page = (tmp_path / "rubber" / "material.html").read_text("utf-8")
    assert "extrapolation" in page
    assert "yeoh" in page


@for_each(
    ("text", "options", "words"),
    [
        ("a,b\n1,2\n2,3\n", [], "no column is a strain"),
        (table(["strain (%),load (N)"], STRAIN, STRAIN), [], "--area-mm2, or --width-mm"),
        (table(["extension (mm),stress (MPa)"], STRAIN, STRAIN), [], "--gauge-length-mm"),
        (table(["strain,stress (MPa)"], 100 * STRAIN, STRAIN), [], "is it in %"),
        (table(["strain,stress (MPa)"], -STRAIN, -STRAIN), [], "--kind compression"),
        (table(["strain (%),strain (%),stress (MPa)"], STRAIN, STRAIN, STRAIN), [], "columns 1 and 2 are both strain"),
        (table(["strain,stress (MPa)"], STRAIN, STRAIN), ["--strain-range-percent", "0"], "from 1 to 3000"),
        (table(["strain,stress (MPa)"], STRAIN, STRAIN), ["--area-mm2", "-1"], "--area-mm2 = -1: must be above 0"),
        (table(["strain,stress (MPa)"], STRAIN, STRAIN), ["--preconditioned"], "needs cycles"),
        (table(["strain,stress (MPa)"], STRAIN[:9], STRAIN[:9]), [], "samples of loading"),
    ],
)
def test_what_is_no_test_is_refused(text, options, words, tmp_path, capfd):
    (tmp_path / "test.csv").write_text(text, "utf-8")
    assert main(["material", str(tmp_path / "test.csv"), "-o", str(tmp_path / "out"), "-q", *options]) == 2
    said = capfd.readouterr().err
    assert words in said
    assert said.count("\n") == 1
    assert not (tmp_path / "out").exists()


@for_each("kind", KINDS)
def test_every_law_is_that_of_the_solver_and_rises_far_beyond_any_data(kind):
    """Against the material point, which the elements agree with, at a volume that hardly changes."""
    near, far = (np.linspace(0.0, end, 40) for end in (0.4, 0.85 if kind == "compression" else 5.0))
    for law in STABLE_LAWS:
        for start in law.starts:
            shape = [one[0] for one in start]
            constants = np.full(law.rows([Deformation.of(kind, near)], shape).shape[1], 0.1)
            assert (np.diff(law.rows([Deformation.of(kind, far)], shape) @ constants) > 0.0).all(), law.name
            fitted = FittedLaw(law, tuple(constants), tuple(shape), (0.0,))
            material = MATERIAL.validate_python(FittedMaterial(fitted, 0.49999).table)
            point = MaterialPoint(coupon_kinematics(kind, 1.0, 1.0), material.law, 0.49999)
            solved = point.answer(near, near, "displacement_mm")
            np.testing.assert_allclose(fitted.stress_MPa(Deformation.of(kind, near)), solved, rtol=1e-3, atol=1e-6)


def sheared(tmp_path, time_s, shear, stress_MPa):
    """The course of a sheared layer."""
    return course_of(SpecimenTest(tmp_path / "x.csv", "shear", time_s, shear, stress_MPa, {}), 0.5)


def test_relaxation_is_that_of_the_holds(tmp_path):
    """A step of shear: tau = mu g (1 - sum g_i (1 - exp(-t / tau_i))), and a second one on top of it."""
    time = np.concatenate([np.linspace(0.0, 0.05, 30), 0.05 + np.geomspace(1e-3, 200.0, 300)])
    shear = 0.4 * np.minimum(time / 0.05, 1.0)
    fall = 1.0 - 0.3 * -np.expm1(-time / 1.5) - 0.2 * -np.expm1(-time / 40.0)
    course = sheared(tmp_path, time, shear, 0.2 * shear * fall)
    assert course.holds_s == pytest.approx([200.0], rel=0.05)
    fitted = fit_law(LAWS["neo-hookean"], [LoadingCurve("shear", shear[:30], 0.2 * shear[:30])], 0.0)
    found = fit_memory(fitted, [course], 0.5, 0.499)
    assert found.softening is None
    assert found.fitted.constants[0] == pytest.approx(0.2, rel=0.02)
    for after in (0.3, 3.0, 30.0, 150.0):
        exact = 0.3 * -np.expm1(-after / 1.5) + 0.2 * -np.expm1(-after / 40.0)
        assert relaxed_share(found.series, after) == pytest.approx(exact, abs=0.015)


def test_a_linear_fit_without_a_block_is_that_of_the_other_samples():
    """One Newton step is exact where residuals are linear; two courses lose a block each at once."""
    chance = np.random.default_rng(0)
    rows, data = chance.standard_normal((48, 3)), chance.standard_normal(48)
    found = least_squares(lambda x: rows @ x - data, np.zeros(3))
    for number, values in enumerate(without_blocks(found, [32, 16])):
        kept = np.ones(48, bool)
        kept[4 * number : 4 * number + 4] = kept[32 + 2 * number : 34 + 2 * number] = False
        exact = np.linalg.lstsq(rows[kept], data[kept], rcond=None)[0]
        assert values == pytest.approx(exact, abs=1e-6)


def test_cycles_are_counted_and_their_softening_is_found(tmp_path):
    """Of sheared neo-Hookean rubber: tau = mu g (1 - l erf((W_max - W) / (b W_max))) with W = mu g^2 / 2."""
    shear = np.interp(np.arange(401) / 100.0, range(5), [0.0, 0.3, 0.0, 0.3, 0.0])
    shear = np.concatenate([shear, np.linspace(0.0, 0.5, 120)])
    peak = np.maximum.accumulate(shear)
    share = np.where(shear < peak, 1.0 - shear**2 / np.maximum(peak, 1e-9) ** 2, 0.0)
    stress = 0.2 * shear * (1.0 - 0.3 * erf(share / 0.4))
    course = sheared(tmp_path, None, shear, stress)
    assert course.cycles == 2
    assert {LOADING, UNLOADING} == set(course.phase.tolist())
    assert HOLD not in course.phase
    fitted = fit_law(LAWS["neo-hookean"], [LoadingCurve("shear", STRAIN[:50], 0.15 * STRAIN[:50])], 0.0)
    found = fit_memory(fitted, [course], 0.5, 0.499)
    assert found.fitted.constants[0] == pytest.approx(0.2, rel=0.02)
    assert found.softening.loss == pytest.approx(0.3, abs=0.03)
    assert found.softening.beta == pytest.approx(0.4, abs=0.1)


def test_one_kind_of_test_chooses_among_laws_that_it_can_tell_apart():
    """Tension and equibiaxial tension of a Mooney-Rivlin rubber together show its second constant, tension cannot."""
    curves = [
        LoadingCurve(kind, STRAIN, 0.2 * Deformation.of(kind, STRAIN).ogden(2.0)
                     + 0.1 * Deformation.of(kind, STRAIN).ogden(-2.0))
        for kind in ("tension", "equibiaxial")
    ]  # fmt: skip
    assert "mooney-rivlin" not in {law.name for law in laws_for(1)}
    assert all(one[0] > 0.0 for law in laws_for(1) for start in law.starts for one in start)
    best = rank_laws(curves, 0.0, [law for law in laws_for(2) if law.starts == ((),)])[0]
    assert best.fitted.law.name == "mooney-rivlin"
    np.testing.assert_allclose(best.fitted.constants, (0.2, 0.1), rtol=1e-6)


@for_each(
    ("texts", "words"),
    [
        ({"mine.toml": "include = 3"}, "must be a list of files"),
        ({"mine.toml": 'include = ["gone.toml"]'}, "gone.toml"),
        ({"mine.toml": 'include = ["a.toml"]', "a.toml": 'include = ["mine.toml"]'}, "includes other files itself"),
    ],
)
def test_an_include_that_leads_nowhere_is_refused(texts, words, tmp_path):
    for name, text in texts.items():
        (tmp_path / name).write_text(text, "utf-8")
    with pytest.raises(InputError, match=words):
        read_toml(tmp_path / "mine.toml")


def test_a_file_comes_before_what_it_includes_and_mechanisms_join(tmp_path):
    (tmp_path / "a.toml").write_text('x = 1\nt = {a = 1, b = 1}\nmechanisms = [{name = "p"}]', "utf-8")
    (tmp_path / "b.toml").write_text("x = 2\ny = 2\nt = {b = 2, c = 2}", "utf-8")
    own = 'include = ["a.toml", "b.toml"]\nt = {c = 3}\nmechanisms = [{name = "q"}]'
    (tmp_path / "mine.toml").write_text(own, "utf-8")
    assert read_toml(tmp_path / "mine.toml") == {
        "x": 2, "y": 2, "t": {"a": 1, "b": 2, "c": 3}, "mechanisms": [{"name": "q"}, {"name": "p"}]
    }  # fmt: skip
