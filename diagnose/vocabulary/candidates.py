"""All candidates of a rig."""

from diagnose.forward import Candidate
from diagnose.vocabulary.bonds import of_bonds
from diagnose.vocabulary.electric import electric
from diagnose.vocabulary.film import of_film
from diagnose.vocabulary.laws import of_media
from diagnose.vocabulary.memory import viscoelastic
from diagnose.vocabulary.place import of_place
from diagnose.vocabulary.rig import around
from diagnose.vocabulary.scene import Scene
from diagnose.vocabulary.wrong_numbers import wrong_numbers

GROUPS = (electric, around, viscoelastic, of_media, of_bonds, of_film, of_place, wrong_numbers)


def candidates(scene: Scene) -> tuple[Candidate, ...]:
    """Every mechanism and component that the rig admits."""
    return tuple(candidate for group in GROUPS for candidate in group(scene))
