"""One row of the verification table: printed with `pytest -s`, and held to its tolerance."""


def agrees(case: str, ours: float, reference: float, tolerance: float) -> None:
    """Assert |ours / reference - 1| <= tolerance."""
    error = ours / reference - 1.0
    print(f"ROW | {case} | {reference:.6g} | {ours:.6g} | {100 * error:+.3g} % | {100 * tolerance:g} %")
    assert abs(error) <= tolerance, f"{case}: {ours:.6g} against {reference:.6g}, {100 * error:+.3g} %"
