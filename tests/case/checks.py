# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of figures in case tests: check(), and sys.exit(count()) at the end."""
_failures = 0


def check(what, found, expected, error):
    global _failures
    isGood = abs(found - expected) <= error
    _failures += not isGood
    print(f"{what}: {found:.6g}, {expected:.6g} to {error:.2g}{'' if isGood else ': FAILED'}")


def count():
    """Of those that failed."""
    return _failures
