// SPDX-License-Identifier: GPL-3.0-or-later
/// Function objects that would end the run, and conditions of patches that the mesh does not have.
#include "foam/dictionaryChecks.H"
#include "foam/otherInput.H"
#include "support/foamCase.H"

#include <doctest/doctest.h>

using namespace flotsam;

TEST_CASE("function objects that need a turbulence model are refused by name, unless they do nothing")
{
    const auto message = [](const std::string& functions) { return messageOf([&] { checkFunctionObjects(parse(functions)); }); };
    const std::string refused = message("level { type probes; } drag { type forces; patches (pier); }");
    CHECK(refused.find("Function object 'drag' of type forces") != std::string::npos);
    CHECK(refused.find("wallForces { drag { patches (names); origin (0 0 0); } }") != std::string::npos);
    CHECK(refused.find("bodies.h5") != std::string::npos);
    CHECK(!message("shear { type wallShearStress; }").empty());
    CHECK(!message("shear { type wallShearStress; enabled on; }").empty());
    CHECK(message("shear { type wallShearStress; enabled off; }").empty());
    CHECK(message("drag { type forces; directForceDensity yes; }").empty());
    CHECK(message("level { type probes; } force { type surfaceFieldValue; } includedOnly on; q { type Q; }").empty());
}

TEST_CASE("conditions of what is no patch are found; names, groups of patches and patterns are left alone")
{
    FoamCase foam("foamChannel");
    const Foam::polyBoundaryMesh& patches = foam.mesh().boundaryMesh();
    const auto strays = [&](const std::string& field) { return strayPatches(parse(field), patches); };
    CHECK(strays("inlet { type slip; } outlet { type slip; } floor { type noSlip; } top { type slip; } frontAndBack { type empty; }").empty());
    CHECK(strays("\".*\" { type slip; } \"in.*t\" { type slip; } empty { type empty; } value 3;").empty());
    const auto found = strays("\".*\" { type slip; } inlett { type fixedValue; } somewhere { type slip; }");
    CHECK(found == std::vector<std::string>{"inlett", "somewhere"});
    CHECK(describeStray(found, patches) == "'inlett' (of inlet?), 'somewhere'");
}

TEST_CASE("a case with a mesh passes")
{
    FoamCase foam("foamChannel");
    CHECK(messageOf([&] { checkMesh(foam.time()); }).empty());
}
