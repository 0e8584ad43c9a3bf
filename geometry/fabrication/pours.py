"""What to mix and pour for one mould."""

from dataclasses import dataclass

from geometry.fabrication.mould import Mould
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.routes import CastComponent


@dataclass(frozen=True)
class Pour:
    """One mould full of one material. Masses in g, volumes in mm^3.

    component : "effector", "medium1" or "medium2".
    material : its material in the configuration.
    recipe : name of what is poured; another one than the material where that cannot be cast.
    cavities : number of them in the mould.
    cavity_volume_mm3 : of all cavities together, enlarged for shrinkage.
    poured_volume_mm3 : with the overfill.
    poured_mass_g : of the poured volume.
    mixed_mass_g : the poured mass, or the smallest batch that can be mixed.
    mixed_masses_g : (name, mass) of each component of the mix, such as (("A", 5.0), ("B", 5.0)).
    shrinkage_percent : linear, by which the cavities are enlarged.
    pot_life_min, cure_time_h : None where not known.
    release : note on the release agent.
    note : what else to know.
    source : of the numbers.
    """

    component: str
    material: str
    recipe: str
    cavities: int
    cavity_volume_mm3: float
    poured_volume_mm3: float
    poured_mass_g: float
    mixed_mass_g: float
    mixed_masses_g: tuple[tuple[str, float], ...]
    shrinkage_percent: float
    pot_life_min: float | None
    cure_time_h: float | None
    release: str
    note: str
    source: str


def pour_of(component: CastComponent, mould: Mould, fabrication: Fabrication) -> Pour:
    """What one mould takes. The liquid is counted at the density of the cured part and the volume of the cavity."""
    recipe, cavities = component.recipe, len(mould.gang.centers)
    cavity_volume = cavities * float(mould.cavity.solid.volume)
    poured_volume = cavity_volume * (1.0 + fabrication.overfill_percent / 100.0)
    poured = poured_volume * 1e-3 * recipe.density_g_cm3
    mixed = max(poured, fabrication.smallest_batch_g)
    return Pour(
        component=component.name,
        material=component.material,
        recipe=recipe.name,
        cavities=cavities,
        cavity_volume_mm3=cavity_volume,
        poured_volume_mm3=poured_volume,
        poured_mass_g=poured,
        mixed_mass_g=mixed,
        mixed_masses_g=recipe.masses_g(mixed),
        shrinkage_percent=100.0 * recipe.shrinkage,
        pot_life_min=recipe.pot_life_min,
        cure_time_h=recipe.cure_time_h,
        release=recipe.release,
        note=recipe.note,
        source=recipe.source,
    )
