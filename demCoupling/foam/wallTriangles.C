// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/wallTriangles.H"
#include "demCoupling/foam/shortList.H"

#include "foam/dictionaryChecks.H"
#include "geometry/thinTriangles.hpp"

namespace flotsam
{

namespace
{

[[noreturn]] void failDivision(const WallDefinition& wall, std::size_t count, const Foam::dictionary& dict)
{
    const TriSurface& s = wall.surface;
    const double extent = extentOf(s);
    for (const auto& t : s.triangles)
    {
        const Vec3& a = s.points[t[0]];
        const ThinTriangle thin(a, s.points[t[1]], s.points[t[2]]);
        if (!thin.isRefused || thin.isNegligible(extent)) continue;
        failIn(dict, text("The surface of ", wall.name, " has ", count, " triangles with angles below ", needleAngle, " rad, which the contact engine does not take, the first ", thin.length, " m long and ",
            thin.width, " m wide at (", a[0], ' ', a[1], ' ', a[2], "): divided across their length they would be more than ", mostWallPieces, ", the most of one surface.\n"
            "    Remesh the STL file (surfaceMeshTriangulate, a CAD program), or divide it into several structures, make cells at a patch less flat, or let bodies not feel it "
            "('contact off;' of a structure, wallPatches)."));
    }
    failIn(dict, text("The surface of ", wall.name, " has triangles that cannot be divided."));
}

} // namespace

void divideWallTriangles(BodiesInput& input, const Foam::dictionary& dict)
{
    ShortList names;
    std::size_t count = 0, pieces = 0;
    for (WallDefinition& wall : input.walls)
    {
        if (wall.kind != WallDefinition::Kind::Surface) continue;
        DividedSurface divided = divideThinTriangles(wall.surface, mostWallPieces);
        if (divided.pieces > mostWallPieces) failDivision(wall, divided.divided, dict);
        if (divided.divided == 0 && divided.leftOut == 0) continue;
        wall.surface = std::move(divided.surface);
        if (divided.divided == 0) continue;
        names.add(wall.name);
        count += divided.divided;
        pieces += divided.pieces;
    }
    if (count > 0)
        Foam::Info<< "Contact: " << count << (count == 1 ? " long narrow triangle of " : " long narrow triangles of ") << names.text().c_str() << " divided into " << pieces << " pieces" << Foam::nl;
}

} // namespace flotsam
