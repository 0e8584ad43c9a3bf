"""A film that yields: one over its yield stress."""

from collections.abc import Iterator, Sequence
from math import sinh
from typing import Any

from diagnose.forward import Candidate
from diagnose.vocabulary.base import REMEMBERS, Vocabulary, register
from diagnose.vocabulary.scales import growing, shrinking
from diagnose.vocabulary.scene import Scene
from solve.materials.parameters import PiezoelectricFilm
from solve.mechanisms.layers.film_yield import FILM_YIELD

WEAKEST_MPA = 5.0  # a tenth of what PVDF is sold with


def of_segment(scene: Scene) -> Iterator[Candidate]:
    """Yield candidates for any film."""
    yield _yield_stress(scene)


def _yield_stress(scene: Scene) -> Candidate:
    """One over the yield stress, in terms of that of the film's table: below some value nothing yields."""
    film = scene.model.materials["film"]
    assert isinstance(film, PiezoelectricFilm)
    usual = film.yield_stress_MPa or 50.0
    most = max(usual / WEAKEST_MPA, 2.0)
    nodes = tuple(share * most for share in (0.12, 0.22, 0.35, 0.6, 1.0))
    coordinate = growing("inverse_stress", 1.0, most, (1.5, 0.5 * most), nodes)

    def parameters(values: Sequence[float]) -> dict[str, Any]:
        return {"yield_stress_MPa": shrinking(usual, sinh(values[0]))}

    units = {"yield_stress_MPa": "MPa"}
    return Candidate(FILM_YIELD.name, "film", (coordinate,), parameters, units=units)


register(Vocabulary(FILM_YIELD, "{} yields", of_segment=of_segment, kind=REMEMBERS))
