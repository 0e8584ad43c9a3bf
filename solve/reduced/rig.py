"""What the reduced model knows of the rig: a spring and a mass; and what else of the physics it does not know."""

from solve.materials.prony import Prony
from solve.physics import Physics, like
from solve.terms.inertia import MovingMass
from solve.terms.rig import RigSpring


def compliance_mm_per_N(physics: Physics) -> float:
    """Compliance of the spring between the displacement sensor and the dot."""
    return like(physics.terms, RigSpring()).compliance_mm_per_N


def mass_Ns2_per_mm(physics: Physics) -> float:
    """Mass of what moves with the dot."""
    return 1e-6 * like(physics.terms, MovingMass()).mass_g


def unknown_of_segment(physics: Physics) -> list[str]:
    """Words for the physics of segment and dot that depends on time or path and is no relaxation."""
    laws = [law for laws in physics.inelastic.values() for law in laws if not isinstance(law, Prony)]
    terms = [term for term in physics.terms if term.follows_time and not term.of_rig]
    return sorted({*(law.words for law in laws), *(term.words for term in terms)})


def unknown_of_rig(physics: Physics) -> list[str]:
    """Words for the physics, beside the spring and the mass, that acts on a dot whose own path is not prescribed."""
    known = RigSpring, MovingMass
    return sorted({term.words for term in physics.rig_terms if not isinstance(term, known)})
