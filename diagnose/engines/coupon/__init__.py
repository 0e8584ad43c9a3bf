"""A coupon as a forward model of a diagnosis: the solver's laws at one material point."""

from diagnose.engines.coupon.engine import CouponEngine, coupon_engine, improved_material

__all__ = ["CouponEngine", "coupon_engine", "improved_material"]
