"""A coupon as a forward model of a diagnosis: the solver's laws at one material point."""

from diagnose.coupon.engine import CouponEngine, coupon_engine
from diagnose.coupon.improved import improved_material

__all__ = ["CouponEngine", "coupon_engine", "improved_material"]
