# SPDX-License-Identifier: GPL-3.0-or-later
"""A computed figure beside the published one."""
from dataclasses import dataclass


@dataclass
class Comparison:
    quantity: str
    value: float
    reference: float = None     # None: a figure that should be small or is only shown
    error: float = None         # relative unless errorUnit says otherwise
    target: float = None        # largest |error| (or |value| without a reference) allowed; None: no verdict
    unit: str = ""
    errorUnit: str = "%"
    source: str = ""

    @property
    def verdict(self):
        if self.target is None:
            return ""
        measured = self.error if self.error is not None else self.value
        return "reached" if abs(measured) <= self.target else "missed"


def relative(quantity, value, reference, target=None, unit="", source="", scale=None):
    """Error relative to the reference, or to `scale` where that is another size."""
    return Comparison(quantity, float(value), float(reference), float((value - reference) / abs(scale or reference)), target, unit, "%", source)


def absolute(quantity, value, reference, target=None, unit="", source=""):
    return Comparison(quantity, float(value), float(reference), float(value - reference), target, unit, unit, source)


def small(quantity, value, target=None, unit="", source=""):
    """A deviation or defect: zero would be exact."""
    return Comparison(quantity, float(value), None, None, target, unit, "", source)


def shown(comparison):
    """Strings (value, reference, error, target) for tables."""
    c = comparison
    unit = f" {c.unit}" if c.unit else ""
    asPercent = c.errorUnit == "%" and c.error is not None

    def size(x, sign=""):
        return "" if x is None else f"{100 * x:{sign}.3g} %" if asPercent else f"{x:{sign}.3g}{unit}"
    return (f"{c.value:.5g}{unit}", "" if c.reference is None else f"{c.reference:.5g}{unit}", size(c.error, "+"), size(c.target))
