// SPDX-License-Identifier: GPL-3.0-or-later
/// Guards the compile option of sources that include OpenFOAM: g++ 12's loop vectoriser computes this product wrongly, because
/// the result reuses the storage of an operand that is declared __restrict__.
#include "tensorField.H"
#include "vectorField.H"

#include <doctest/doctest.h>

TEST_CASE("tensor & temporary vector field")
{
    const Foam::tensorField t(5, Foam::tensor(1, 2, 3, 4, 5, 6, 7, 8, 9));
    const Foam::vectorField v(5, Foam::vector(1, 2, 3));
    const Foam::vectorField product(t & (1.0*v));
    for (const Foam::vector& p : product)
    {
        CHECK(p.x() == 14);
        CHECK(p.y() == 32);
        CHECK(p.z() == 50);
    }
}
