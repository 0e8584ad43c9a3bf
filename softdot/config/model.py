"""The solver's model of a configuration: bonds declared, mechanisms switched on, impossible combinations refused."""

from pydantic import ValidationError

from foundation.errors import InputError
from geometry.array.layout import ArrayLayout
from geometry.parameters import Table
from geometry.part_checks import check_patch
from softdot.config.errors import sentence
from softdot.config.schema import Config
from solve.mechanisms import MECHANISMS, Mechanism, with_mechanisms
from solve.mechanisms.base import channels_of
from solve.mechanisms.boundaries.rig_compliance import RIG_COMPLIANCE
from solve.model import Model
from solve.physics import Physics, declared_bonds

STIFFEST_BOND_N_PER_MM3 = 1e6  # as in segment.bonds


def model_of(config: Config) -> Model:
    """The model of a configuration. InputError with one sentence for a mechanism that this segment cannot have, and
    for an array.
    """
    refuse_array(config)
    physics = Physics(bonds=declared_bonds(config.segment))
    model = Model(config.segment, config.layer_materials(), config.dot, config.press, config.readout, physics)
    for number, mechanism in enumerate(config.mechanisms):
        key = f"mechanisms[{number}]"
        _refuse_missing_layer(key, mechanism.component, model)
        try:
            model = with_mechanisms(model, [mechanism])
        except ValidationError as error:  # of the material that the mechanism makes of its constants
            raise InputError(f"{key}.parameters: {sentence(error, mechanism.parameters, Mechanism)}") from None
        except ValueError as error:
            raise InputError(f"{key}.{error}") from None
        _refuse_beyond_bounds(key, model)
        if mechanism.name == RIG_COMPLIANCE.name and not mechanism.is_off and config.press.force_N is not None:
            raise InputError(
                f"{key}.name = '{mechanism.name}': a force drives (press.force_N); it needs press.indentation_mm"
            )
    _refuse_patches_outside(model)
    for number, mechanism in enumerate(config.mechanisms):
        key = f"mechanisms[{number}].component = '{mechanism.component}'"
        _refuse_viscous_perfect_bond(key, mechanism, model)
        _refuse_missing_channels(key, mechanism, model)
        _refuse_unfelt_input(key, mechanism, model)
    return model


def refuse_array(config: Config) -> None:
    """InputError where a configuration states an array and one segment is asked for."""
    if config.array is not None:
        raise InputError(
            "array: this is one segment's command; use softdot array, or leave the table out for a segment alone"
        )


def as_segment(config: Config, layout: ArrayLayout) -> Config:
    """An array as the one wide segment that it is, with an electrode on each of its own."""
    return config.model_copy(update={"array": None, "segment": layout.whole})


def _refuse_missing_layer(key: str, component: str, model: Model) -> None:
    if "effector" in component and model.segment.effector is None:
        raise InputError(f"{key}.component = '{component}': segment.effector is absent")


def _refuse_beyond_bounds(key: str, model: Model) -> None:
    """InputError where a mechanism turns a table into one that a configuration would not allow."""
    tables: dict[str, Table] = {"segment": model.segment, "dot": model.dot}
    tables |= {f"{layer} material": material for layer, material in model.materials.items()}
    if model.readout is not None:
        tables["readout"] = model.readout
    for name, table in tables.items():
        values = table.model_dump()
        try:
            type(table).model_validate(values)
        except ValidationError as error:
            raise InputError(f"{key} makes {name}.{sentence(error, values, type(table))}") from None
    for name, line in model.physics.bonds.items():
        stiffest = max(line.normal_stiffness_N_per_mm3, line.shear_stiffness_N_per_mm3)
        if stiffest > STIFFEST_BOND_N_PER_MM3:
            raise InputError(
                f"{key} makes the stiffness of '{name}' {stiffest:.3g} N/mm3: must be at most "
                f"{STIFFEST_BOND_N_PER_MM3:.0e}; leave out a bond that is practically perfect"
            )


def _refuse_viscous_perfect_bond(key: str, mechanism: Mechanism, model: Model) -> None:
    name = mechanism.component
    if name in model.physics.inelastic and name.startswith("bond-") and name not in model.physics.bonds:
        raise InputError(
            f"{key}: {mechanism.name} needs a compliant bond there; add adhesive-compliance or segment.bonds"
        )


def _refuse_patches_outside(model: Model) -> None:
    for patch in (each for each in model.physics.delaminations if not each.outside):
        check_patch(model.segment, patch.bond, patch.center_mm, patch.diameter_mm)


def _refuse_missing_channels(key: str, mechanism: Mechanism, model: Model) -> None:
    channels, needed = len(model.segment.film.electrodes), channels_of(mechanism.component)
    if needed and (max(needed) > channels or channels == 1):
        raise InputError(
            f"{key}: {mechanism.name} needs that electrode and another one; segment.film.electrodes has {channels}"
        )


def _refuse_unfelt_input(key: str, mechanism: Mechanism, model: Model) -> None:
    """InputError for an effect parallel to a virtual ground, the input of a charge amplifier, which never acts."""
    charge = model.readout is not None and model.readout.mode == "charge"
    if charge and mechanism.component in MECHANISMS[mechanism.name].parallel_to_input:
        raise InputError(
            f"{key}: {mechanism.name} acts only with readout.mode = 'voltage', here readout.mode = 'charge', whose "
            "input is a virtual ground"
        )
