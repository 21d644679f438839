# SPDX-License-Identifier: GPL-3.0-or-later
"""A box of gas so thin that bodies in it move as in a vacuum: contact through the whole program, from dictionaries to bodies.h5."""
from .files import blockMesh, bodies, control, even, field, gravity, merged, oneFluid


def files(box, cells, g, text, endTime, maxDeltaT):
    """box: ((x0, x1), (y0, y1), (z0, z1)) [m] with walls but for an open top; text: of constant/bodies."""
    axes = [even(*ends, n) for ends, n in zip(box, cells)]
    return merged(
        blockMesh(*axes, {"walls": ("wall", "x- x+ y- y+ z-"), "top": ("patch", "z+")}),
        field("U", {"walls": "noSlip", "top": "type pressureInletOutletVelocity; value uniform (0 0 0);"}),
        field("p_rgh", {"walls": "type fixedFluxPressure; value uniform 0;", "top": "type totalPressure; p0 uniform 0; value uniform 0;"}),
        oneFluid(1e-3, 1e-4), gravity(*g), bodies(text), control(endTime, min(1e-3, maxDeltaT), maxDeltaT=maxDeltaT))
