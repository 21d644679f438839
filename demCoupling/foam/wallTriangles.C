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
    ThinTriangle widest(Vec3::Zero(), Vec3::Zero(), Vec3::Zero());
    Vec3 place = Vec3::Zero();
    for (const auto& t : s.triangles)
    {
        const ThinTriangle thin(s.points[t[0]], s.points[t[1]], s.points[t[2]]);
        if (!thin.isRefused || thin.width < widest.width) continue;
        widest = thin;
        place = s.points[t[0]];
    }
    failIn(dict, text("The surface of ", wall.name, " has ", count, " triangles with angles below ", needleAngle, " rad, which the contact engine does not take, the widest ", widest.length, " m long and ",
        widest.width, " m wide at (", place[0], ' ', place[1], ' ', place[2], "): divided across their length, those of all surfaces would be more than ", mostWallPieces, ".\n"
        "    Remesh the STL file (surfaceMeshTriangulate, a CAD program), make cells at a patch less flat, or let bodies not feel it ('contact off;' of a structure, wallPatches)."));
}

} // namespace

void divideWallTriangles(BodiesInput& input, const Foam::dictionary& dict)
{
    ShortList names;
    std::size_t count = 0, pieces = 0;
    for (WallDefinition& wall : input.walls)
    {
        if (wall.kind != WallDefinition::Kind::Surface) continue;
        DividedSurface divided = divideThinTriangles(wall.surface, mostWallPieces - pieces);
        if (divided.pieces > mostWallPieces - pieces) failDivision(wall, divided.divided, dict);
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
