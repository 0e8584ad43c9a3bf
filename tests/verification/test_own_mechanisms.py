"""A viscous guide, and a mechanism that stands in this file alone: term, derivative, off value, switch, candidates.

The latter is a foundation of Winkler's kind, whose springs stiffen and carry the base in place of the clamp,
    t = -(k + k_3 |u|^2) u.
"""

from dataclasses import dataclass, replace
from math import inf

import numpy as np
import pytest
from pydantic import Field

from diagnose.engines.segment.presses import Presses
from diagnose.forward import Candidate, Coordinate
from diagnose.signals.time_scales import TimeScales
from diagnose.vocabulary import base as vocabulary
from diagnose.vocabulary.scene import Scene
from geometry.parameters import NonNegative, Positive
from mesh.options import MeshOptions
from softdot.config.loading import config_from
from softdot.config.model import model_of
from solve.mechanisms import MECHANISMS, register, with_mechanisms
from solve.mechanisms.base import MechanismType, Parameters, in_place, with_physics
from solve.model import Press, Readout
from solve.physics import Physics
from solve.terms.base import Block, Term
from solve.terms.contact import SHAPES, facet_area
from solve.terms.definition import TermDefinition
from solve.terms.guide_viscosity import GuideTerm, ViscousGuide
from solve.terms.inertia import MassTerm
from solve.terms.rig import RigSpring, RigTerm
from tests.solve.test_reduced import solid
from tests.solve.test_rig import drive
from tests.solve.trial import trial
from tests.verification.slices import BLOCK, DEPTH_MM, force, mesh_of, pressed, waved

VISCOUS_N_s_per_mm, STRIBECK_N, STRIBECK_mm_per_s = 0.02, 0.1, 1.5


# the foundation


@dataclass(frozen=True)
class FoundationTerm(Term):
    """Springs on facets (k, 6), area (k, q); linear and cubic : traction per displacement and per its cube."""

    facets: np.ndarray
    dofs: np.ndarray
    area: np.ndarray
    linear: float
    cubic: float

    @property
    def groups(self):
        return (self.dofs,)

    def tractions(self, displacement):
        """Displacement (k, q, 3), traction on the body's side of the springs and its derivative (k, q, 3, 3)."""
        u = np.einsum("qn,kni->kqi", SHAPES, displacement[self.facets])
        stiffness = self.linear + self.cubic * (u**2).sum(axis=-1)
        slope = stiffness[..., None, None] * np.eye(3) + 2.0 * self.cubic * u[..., :, None] * u[..., None, :]
        return stiffness[..., None] * u, slope

    def elements(self, state, history):
        held, slope = self.tractions(state.displacement)
        residual = np.einsum("kq,qn,kqi->kni", self.area, SHAPES, held).reshape(-1, 18)
        matrix = np.einsum("kq,qn,qm,kqij->knimj", self.area, SHAPES, SHAPES, slope, optimize=True)
        yield Block(0, slice(0, len(residual)), matrix.reshape(-1, 18, 18), residual)


@dataclass(frozen=True)
class Foundation(TermDefinition):
    linear_N_per_mm3: float = inf
    cubic_N_per_mm5: float = 0.0
    words = "an elastic foundation"
    frees = ("base",)

    @property
    def is_off(self):
        return bool(np.isinf(self.linear_N_per_mm3))

    def build(self, make):
        facets = make.tet_mesh.facets["base"]
        dofs = make.unknowns.displacement[facets].reshape(-1, 18)
        linear, mm = make.per_area(self.linear_N_per_mm3), 1e-3 / make.units.length
        cubic = make.per_area(self.cubic_N_per_mm5) / mm**2
        yield FoundationTerm(facets, dofs, facet_area(make.points, facets), linear, cubic)


class FoundationParameters(Parameters):
    """A foundation of springs."""

    stiffness_N_per_mm3: Positive = Field(description="traction per displacement")
    cubic_N_per_mm5: NonNegative = Field(0.0, description="traction per its cube")


def founded(model, component, values):  # noqa: ARG001 - as all are called
    foundation = Foundation(values.stiffness_N_per_mm3, values.cubic_N_per_mm5)
    return with_physics(model, terms=in_place(model.physics.terms, foundation))


def foundation_candidates(scene):  # noqa: ARG001 - as all are called
    compliance = Coordinate("compliance", 0.0, 20.0, (0.1, 1.0), nodes=(0.5, 5.0))
    yield Candidate(
        "elastic-foundation", "bond-base", (compliance,), lambda values: {"stiffness_N_per_mm3": 1.0 / values[0]},
        units={"stiffness_N_per_mm3": "N/mm3"},
    )  # fmt: skip


FOUNDATION = MechanismType(
    "elastic-foundation", ("bond-base",), FoundationParameters, founded, {"stiffness_N_per_mm3": inf}
)


@pytest.fixture
def registered():
    """The foundation, known as long as a test lasts."""
    vocabulary.vocabulary()
    register(FOUNDATION)
    vocabulary.register(vocabulary.Vocabulary(FOUNDATION, "{} gives way", foundation_candidates))
    yield
    del MECHANISMS[FOUNDATION.name], vocabulary.VOCABULARY[FOUNDATION.name]


GUIDE = ViscousGuide(VISCOUS_N_s_per_mm, STRIBECK_N, STRIBECK_mm_per_s)
RAMP = waved("ramp", 4, rise_s=0.1)
SPEED_mm_per_s = DEPTH_MM / 0.1


def central(of, x, step=1e-6):
    """Derivative (r, c) of a residual (r,) by central differences."""
    return np.stack([(of(x + d) - of(x - d)) / (2.0 * step) for d in step * np.eye(len(x))], axis=1)


@pytest.mark.parametrize("speed", [-0.7, 0.01, 0.3, 2.0])
def test_the_tangent_of_the_guide_is_the_derivative_of_its_force(speed):
    term = GuideTerm(0, GUIDE, 0.4, 1.3)

    def block(x):
        state = trial(np.zeros((1, 3)), x, 0.05, previous_move=np.array([0.0, 0.0, -0.02]))
        return next(iter(term.elements(state, None)))

    at = np.array([0.02 + 0.05 * 0.4 * speed])
    slope = central(lambda x: block(x).residuals[0], at, 1e-7)
    np.testing.assert_allclose(block(at).matrices[0], slope, rtol=1e-6)


def test_the_tangent_of_the_foundation_is_the_derivative_of_its_traction():
    flat = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0.5, 0, 0], [0.5, 1, 0], [0, 1, 0]], float)
    facets = np.arange(6)[None]
    term = FoundationTerm(facets, np.arange(18)[None], facet_area(flat, facets), 0.8, 3.0)
    at = 0.3 * np.random.default_rng(1).standard_normal(18)

    def block(x):
        return next(iter(term.elements(trial(x.reshape(6, 3)), None)))

    slope = central(lambda x: block(x).residuals[0], at)
    np.testing.assert_allclose(block(at).matrices[0], slope, atol=1e-8)


@pytest.mark.press
def test_on_a_prescribed_path_the_sensor_carries_the_guide():
    """At a constant speed F(v) more, whatever the segment; with a spring before the dot it is in the balance."""
    plain, on = pressed(RAMP), pressed(RAMP, Physics(terms=(GUIDE,)))
    assert on.follows_time
    expected = VISCOUS_N_s_per_mm * SPEED_mm_per_s + STRIBECK_N * np.exp(-((SPEED_mm_per_s / STRIBECK_mm_per_s) ** 2))
    at_plain = np.interp(on.trace.indentation_m, plain.trace.indentation_m, np.abs(plain.trace.contact_force_N[:, 2]))
    inside = slice(1, -1)  # at its ends the path has a kink
    np.testing.assert_allclose((force(on) - np.abs(on.trace.contact_force_N[:, 2]))[inside], expected, rtol=1e-9)
    np.testing.assert_allclose(np.abs(on.trace.contact_force_N[-1, 2]), at_plain[-1], rtol=1e-6)


@pytest.mark.press
def test_behind_a_spring_the_dot_drags_the_guide_along():
    """(u - a) / c = F_contact + F(a'), with a' over each step."""
    trace = pressed(RAMP, Physics(terms=(RigSpring(0.05), GUIDE))).trace
    speed = np.diff(1e3 * trace.dot_path_m) / np.diff(trace.time_s)
    balance = trace.reaction_force_N - np.abs(trace.contact_force_N[:, 2])
    np.testing.assert_allclose(balance[1:], GUIDE.friction(speed)[0], atol=1e-6 * force_scale(trace))


def test_a_mass_that_a_force_drives_ends_at_the_speed_that_the_guide_allows():
    """v = F / c once m / c has passed: a hundred times that here."""
    guide, push, mass = ViscousGuide(VISCOUS_N_s_per_mm), 0.02, 1e-4
    rig = RigTerm(0, None, alone=False), GuideTerm(0, guide, 1.0, 1.0), MassTerm(0, mass)
    time = np.linspace(0.0, 100.0 * mass / VISCOUS_N_s_per_mm, 401)
    speed = np.gradient(drive(rig, np.full(401, push), time, stiffness=0.0)[:, 0], time)
    np.testing.assert_allclose(speed[200:], push / VISCOUS_N_s_per_mm, rtol=1e-9)


def force_scale(trace):
    return float(np.abs(trace.reaction_force_N).max())


@pytest.mark.press
def test_a_soft_foundation_alone_carries_the_block():
    """The block moves as a rigid body, F = A (k d + k3 d^3), but for k h / E = 1e-4; h = 3.5 mm, E = 0.6 MPa."""
    k, cubic = 2e-5, 5e-4
    press = Press(indentation_mm=DEPTH_MM, load_steps=1)
    found = pressed(press, Physics(terms=(Foundation(k, cubic),)), flat=True)
    area = BLOCK.length_mm * BLOCK.width_mm
    assert found.steps[-1].reaction_force_N == pytest.approx(area * (k * DEPTH_MM + cubic * DEPTH_MM**3), rel=1e-3)


@pytest.mark.press
def test_a_stiff_foundation_tends_to_the_clamp():
    """The defect is its compliance: a tenth of it for ten times the stiffness."""
    press = Press(indentation_mm=DEPTH_MM, load_steps=1)
    clamped = pressed(press, flat=True).steps[-1].reaction_force_N
    forces = [pressed(press, Physics(terms=(Foundation(k),)), flat=True).steps[-1].reaction_force_N for k in (1e3, 1e4)]
    defects = 1.0 - np.array(forces) / clamped
    assert 0.0 < defects[1] < 1e-3
    assert defects[0] / defects[1] == pytest.approx(10.0, rel=0.1)


TABLES = {
    "segment": {
        "section": "plane-strain", "effector": {"height_mm": 1.0}, "medium1": {"thickness_mm": 0.5},
        "film": {"thickness_um": 28.0}, "medium2": {"thickness_mm": 2.0},
    },
    "dot": {"shape": "ridge"},
    "press": {"indentation_mm": 0.1, "load_steps": 1},
}  # fmt: skip


def configured(*mechanisms):
    """The model of a configuration with mechanisms (name, component, parameters)."""
    tables = [{"name": name, "component": where, "parameters": values} for name, where, values in mechanisms]
    return model_of(config_from({**TABLES, "mechanisms": tables}))


@pytest.mark.usefixtures("registered")
def test_a_configuration_switches_both_on_and_their_off_values_leave_the_model_as_it_is():
    on = configured(
        ("viscous-guide", "rig", {"viscous_N_s_per_mm": 0.02}),
        ("elastic-foundation", "bond-base", {"stiffness_N_per_mm3": 3.0, "cubic_N_per_mm5": 1.0}),
    )
    assert on.physics.terms == (ViscousGuide(0.02), Foundation(3.0, 1.0))
    assert on.follows_time
    off = configured(("viscous-guide", "rig", {"viscous_N_s_per_mm": 0.0}))
    assert replace(off, mechanisms=()) == configured()
    assert founded(off, "bond-base", FoundationParameters.model_construct(stiffness_N_per_mm3=inf)).physics == Physics()


SCALES = TimeScales(loading_s=0.1, step_s=0.002, lasting_s=1.0)


def scene_of(model):
    return Scene(model, (Readout(),), depth_mm=0.2, force_N=2.0, voltage_V=1.0, scales=SCALES)


@pytest.mark.usefixtures("registered")
def test_a_diagnosis_looks_for_both():
    """The guide in what the sensor reads of a table, the foundation in a press of its own."""
    model = configured()
    found = {one.name: one for one in vocabulary.candidates_of_segment(scene_of(model))}
    guide, foundation = found["viscous-guide", "rig"], found["elastic-foundation", "bond-base"]
    on = with_mechanisms(model, [guide.as_mechanism((0.5, 0.2))]).physics
    time = np.linspace(0.0, 1.0, 201)
    more = solid().respond(time, 0.4 * time, on).force_N - solid().respond(time, 0.4 * time).force_N
    np.testing.assert_allclose(more, on.terms[0].friction(0.4)[0], rtol=1e-9)
    with pytest.raises(ValueError, match="a viscous guide"):
        solid().respond(time, None, on, force_N=0.1 * time)
    presses = Presses(model, mesh_of(False), MeshOptions(element_size_mm=0.9, mesher="layered"), 0.1)
    job, _ = presses.candidate_job(foundation, (5.0,))
    assert job.model.physics.terms == (Foundation(0.2),)
    assert on.structure == Physics()
