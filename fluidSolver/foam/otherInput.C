// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/otherInput.H"

#include "foam/dictionaryChecks.H"

#include "OSspecific.H"
#include "Time.H"
#include "fileOperation.H"
#include "processorPolyPatch.H"

#include <algorithm>
#include <climits>
#include <cstdlib>
#include <iostream>
#include <unistd.h>

namespace flotsam
{

namespace
{

/// Of the function objects of OpenFOAM those that end the run without a turbulence model; others of their kind only warn.
const std::vector<std::string> needTurbulence{"forces", "forceCoeffs", "wallShearStress", "wallHeatFlux", "turbulenceFields"};

std::vector<std::string> namesOf(const Foam::polyBoundaryMesh& patches)
{
    std::vector<std::string> names;
    for (const Foam::polyPatch& patch : patches)
        if (!Foam::isA<Foam::processorPolyPatch>(patch)) names.push_back(patch.name());
    return names;
}

/// Of a patch, or of a group of patches. A loop: newer versions' lists of pointers have no iterators for algorithms.
bool isMeant(const Foam::keyType& name, const Foam::polyBoundaryMesh& patches)
{
    for (const Foam::polyPatch& patch : patches)
        if (patch.name() == name || patch.inGroups().found(name)) return true;
    return false;
}

} // namespace

void checkFunctionObjects(const Foam::dictionary& functions)
{
    for (const Foam::entry& e : functions)
    {
        if (!e.isDict() || !readFlagOr(e.dict(), "enabled", true) || readFlagOr(e.dict(), "directForceDensity", false)) continue;
        const std::string type = readWordOr(e.dict(), "type", "");
        if (std::find(needTurbulence.begin(), needTurbulence.end(), type) == needTurbulence.end()) continue;
        failIn(e.dict(), text("Function object '", std::string(e.keyword()), "' of type ", type, " needs OpenFOAM's turbulence model, which there is none of: it would end the run at its first step.\n"
            "    Remove it, or set 'enabled no;'. For forces on patches give them in system/controlDict:  wallForces { ", std::string(e.keyword()), " { patches (names); origin (0 0 0); } }  (docs/output.md, Forces on patches);"
            " structures of constant/bodies have theirs in bodies.h5."));
    }
}

std::vector<std::string> strayPatches(const Foam::dictionary& boundaryField, const Foam::polyBoundaryMesh& patches)
{
    std::vector<std::string> strays;
    for (const Foam::entry& e : boundaryField)
    {
        const Foam::keyType& name = e.keyword();
        if (name.isLiteral() && e.isDict() && !isMeant(name, patches)) strays.push_back(name);
    }
    return strays;
}

std::string describeStray(const std::vector<std::string>& strays, const Foam::polyBoundaryMesh& patches)
{
    std::vector<std::string> described;
    for (const std::string& stray : strays)
    {
        const auto meant = nearestWords(stray, namesOf(patches));
        described.push_back(text("'", stray, "'", meant.empty() ? "" : text(" (of ", meant.front(), "?)")));
    }
    return joined(described);
}

void checkCasePath(int argc, char* const* argv)
{
    const auto isRead = [](const std::string& path) { return std::all_of(path.begin(), path.end(), Foam::fileName::valid); };
    char folder[PATH_MAX] = "";
    const char* const logical = std::getenv("PWD");     // which OpenFOAM prefers: a link may lead here
    std::string path = getcwd(folder, sizeof folder) && !(logical && isRead(logical)) ? folder : "";
    for (int i = 1; i + 1 < argc; ++i)
        if (std::string(argv[i]) == "-case") path = isRead(path) ? argv[i + 1] : path;
    if (isRead(path)) return;
    std::cerr << "flotsamFoam: the folder " << path << " has a blank or a quote in its path, which OpenFOAM's programs cannot read. Rename it, or work in a link to it:"
        "  ln -s \"" << path << "\" ~/case; cd ~/case" << std::endl;
    std::exit(1);
}

void checkFileHandler(const Foam::fileName& folder)
{
    if (!Foam::Pstream::parRun()) return;
    const Foam::word& type = Foam::fileHandler().type();
    const Foam::fileName gathered = folder/("processors" + std::to_string(Foam::Pstream::nProcs()));
    const bool gathers = type == "collated" || type == "hostCollated";
    const bool isGathered = !Foam::isDir(folder/"processor0") && Foam::isDir(gathered);     // by a decomposePar of another fileHandler than the run's
    if (!gathers && !isGathered) return;
    failOnAll(text(!gathers ? text("There is no processor0, but ", std::string(gathered), ", as fileHandler collated decomposes, which") : text("fileHandler ", std::string(type)),
        " is not available: every process reads and writes in its own folder processor*; allowed: uncollated, masterUncollated.\n"
        "    Decompose with `decomposePar -fileHandler uncollated`, and run without the option -fileHandler, the environment variable FOAM_FILEHANDLER and the entry fileHandler"
        " (OptimisationSwitches)."));
}

void checkLatestTimes(const Foam::fileName& folder, const Foam::dictionary& controlDict)
{
    if (!Foam::Pstream::parRun() || readWordOr(controlDict, "startFrom", "latestTime") != "latestTime") return;
    const Foam::instantList times = Foam::Time::findTimes(folder); // "constant" is one of them
    const auto isTime = [](const Foam::instant& t) { return t.name() != "constant"; };
    const auto last = std::find_if(times.rbegin(), times.rend(), isTime);
    Foam::List<Foam::instant> latest(Foam::Pstream::nProcs());
    if (last != times.rend()) latest[Foam::Pstream::myProcNo()] = *last;
    Foam::Pstream::gatherList(latest);
    Foam::Pstream::scatterList(latest);
    const auto byValue = [](const Foam::instant& a, const Foam::instant& b) { return a.name().empty() || (!b.name().empty() && a.value() < b.value()); };
    const auto [first, end] = std::minmax_element(latest.begin(), latest.end(), byValue);
    if (first->equal(end->value()) && first->name().empty() == end->name().empty()) return;
    if (first->name().empty())  // not one that a run that was killed has left: all have the start
        failOnAll(text("Folder ", std::string(folder.path()), "/processor", first - latest.begin(), " is missing, or has no time folder; processor", end - latest.begin(), " has time ", std::string(end->name()), ".\n"
            "    Decompose anew (decomposePar -force), with as many subdomains as processes are started."));
    const auto of = [&](const Foam::instant* t) { return text("processor", t - latest.begin(), " has ", std::string(t->name())); };
    failOnAll(text("The processor folders have different latest times: ", of(end), ", ", of(first), ". A run that was killed while it wrote leaves them so.\n"
        "    Remove what not all have (rm -r processor*/", std::string(end->name()), ") to go on from the time before, or decompose anew (decomposePar -force)."));
}

void checkMesh(const Foam::Time& runTime)
{
    const bool didThrow = Foam::FatalError.throwExceptions();
    bool isThere = true;
    try { runTime.findInstance(Foam::polyMesh::meshSubDir, "points"); } // as the mesh itself will look for it
    catch (const Foam::error&) { isThere = false; }
    Foam::FatalError.throwExceptions(didThrow);
    if (isThere) return;
    failOnAll(text("There is no mesh: ", std::string(runTime.path()/runTime.constant()/Foam::polyMesh::meshSubDir), "/points is missing.\n"
        "    Make one with blockMesh, snappyHexMesh or a converter (gmshToFoam, fluentMeshToFoam, ..)", Foam::Pstream::parRun() ? ", then decomposePar." : "."));
}

} // namespace flotsam
