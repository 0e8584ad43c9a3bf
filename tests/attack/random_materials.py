"""Random media of every law, whose energy stays convex where it is asked to, and random films."""

MODELS = ("neo-hookean", "neo-hookean", "linear", "mooney-rivlin", "yeoh", "knowles", "ogden", "hyperfoam")


def medium_material(draw) -> dict:
    """A soft medium, 20 kPa to 10 MPa."""
    model, shear_MPa = draw.among(MODELS), draw.log(0.02, 4.0)
    table = {"model": model, "density_kg_m3": draw.between(200.0, 1500.0)}
    if model in ("neo-hookean", "linear"):
        table["youngs_modulus_MPa"] = 3.0 * shear_MPa
    elif model == "mooney-rivlin":
        share = draw.between(0.0, 1.0)
        table |= {"c10_MPa": share * shear_MPa / 2, "c01_MPa": (1 - share) * shear_MPa / 2}
    elif model == "yeoh":
        table |= {"c10_MPa": shear_MPa / 2, "c20_MPa": draw.between(0.0, 0.1) * shear_MPa}
        table["c30_MPa"] = draw.between(0.0, 0.02) * shear_MPa
    elif model == "knowles":
        table |= {"c10_MPa": shear_MPa / 2, "b": draw.log(0.01, 2.0)}
        if draw.perhaps(0.7):
            table["n"] = draw.between(0.5, 8.0)
    else:
        foam = model == "hyperfoam"
        table["alpha"] = [draw.between(1.5, 12.0 if foam else 6.0) for _ in range(draw.whole(1, 3))]
        share = shear_MPa / len(table["alpha"])
        table["mu_MPa"] = [share if foam else 2 * share / alpha for alpha in table["alpha"]]
    ratio = draw.between(0.2, 0.4995)
    table["poisson_ratio"] = [draw.between(0.0, 0.4) for _ in table["alpha"]] if model == "hyperfoam" else ratio
    if draw.perhaps(0.3):
        table["max_fitted_strain"] = draw.between(0.1, 3.0)
    return table


def modulus_MPa(medium: dict) -> float:
    """Rough Young's modulus of a random medium."""
    if "youngs_modulus_MPa" in medium:
        return medium["youngs_modulus_MPa"]
    if "c10_MPa" in medium:
        return 6.0 * (medium["c10_MPa"] + medium.get("c01_MPa", 0.0))
    foam = medium["model"] == "hyperfoam"
    return 3.0 * sum(m if foam else m * a / 2 for m, a in zip(medium["mu_MPa"], medium["alpha"], strict=True))


def film_material(draw) -> dict:
    """A film from a soft copolymer to stretched PVDF, of either coupling."""
    table = {
        "model": "piezoelectric-film",
        "youngs_modulus_MPa": draw.log(300.0, 5000.0),
        "poisson_ratio": draw.between(0.1, 0.4),
        "d31_pC_per_N": draw.sign(1.0, 30.0),
        "d32_pC_per_N": draw.sign(1.0, 30.0),
        "d33_pC_per_N": draw.sign(5.0, 40.0),
        "relative_permittivity": draw.between(5.0, 60.0),
        "pyroelectric_uC_per_m2_K": draw.sign(5.0, 50.0),
        "density_kg_m3": draw.between(1000.0, 2000.0),
        "coupling": draw.among(("one-way", "one-way", "two-way")),
    }
    if draw.perhaps(0.5):
        table |= {"yield_stress_MPa": draw.between(20.0, 60.0), "max_fitted_strain": draw.between(0.005, 0.05)}
    if draw.perhaps(0.4):
        table["youngs_modulus_2_MPa"] = draw.between(0.6, 1.4) * table["youngs_modulus_MPa"]
    return table
