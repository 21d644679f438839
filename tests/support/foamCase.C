// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/foamCase.H"

#include "Time.H"
#include "argList.H"

#include <mpi.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#ifndef FLOTSAM_TEST_CASES
#error FLOTSAM_TEST_CASES must name tests/cases
#endif

namespace flotsam
{

namespace
{

int rank() { int r; MPI_Comm_rank(MPI_COMM_WORLD, &r); return r; }
int ranks() { int n; MPI_Comm_size(MPI_COMM_WORLD, &n); return n; }

/// OpenFOAM learns of MPI once; its arguments are never destroyed (that would end the process).
void startParallel(const std::string& folder)
{
    static Foam::argList* arguments = nullptr;
    if (arguments || ranks() == 1) return;
    static std::string given[] = {"test", "-parallel", "-case", folder};
    static char* values[] = {given[0].data(), given[1].data(), given[2].data(), given[3].data(), nullptr};
    static int n = 4;
    static char** list = values;
    Foam::argList::noBanner();
    arguments = new Foam::argList(n, list, false, false);
}

std::string contentsOf(const std::string& file)
{
    std::ifstream in(file);
    if (!in) throw std::runtime_error("no file " + file);
    std::ostringstream s;
    s << in.rdbuf();
    return s.str();
}

void run(const std::string& command, const std::string& log)
{
    // the tools are serial programs: they must not take themselves for ranks of this MPI job
    const std::string clean = "env -u OMPI_COMM_WORLD_SIZE -u OMPI_COMM_WORLD_RANK -u PMIX_RANK -u PMIX_NAMESPACE ";
    if (std::system((clean + command + " > " + log + " 2>&1").c_str()) != 0) throw std::runtime_error(command + " failed:\n" + contentsOf(log));
}

void replace(const std::string& file, const std::string& from, const std::string& to)
{
    std::string s = contentsOf(file);
    const auto at = s.find(from);
    if (at == std::string::npos) throw std::runtime_error(file + " does not contain: " + from);
    s.replace(at, from.size(), to);
    std::ofstream(file) << s;
}

std::string sharedText(std::string name)
{
    int n = static_cast<int>(name.size());
    MPI_Bcast(&n, 1, MPI_INT, 0, MPI_COMM_WORLD);
    name.resize(n);
    MPI_Bcast(name.data(), n, MPI_CHAR, 0, MPI_COMM_WORLD);
    return name;
}

} // namespace

std::string messageOf(const std::function<void()>& action)
{
    Foam::FatalError.throwExceptions();
    Foam::FatalIOError.throwExceptions();
    std::string message;
    try
    {
        action();
    }
    catch (const Foam::error& error) // IOerror too
    {
        message = error.message();
    }
    Foam::FatalError.dontThrowExceptions();
    Foam::FatalIOError.dontThrowExceptions();
    return message;
}

FoamCase::FoamCase(const std::string& name, const std::vector<Edit>& edits, const std::string& blockMeshDict)
{
    std::string failure;
    if (rank() == 0) failure = prepare(name, edits, blockMeshDict);
    failure = sharedText(failure); // all ranks give up together
    if (!failure.empty()) throw std::runtime_error(failure);
    folder_ = sharedText(folder_);
    startParallel(folder_);
    share_ = ranks() > 1 ? folder_ + "/processor" + std::to_string(rank()) : folder_;
    const std::filesystem::path path(folder_);
    const std::string caseName = path.filename().string() + (ranks() > 1 ? "/processor" + std::to_string(rank()) : "");
    time_ = std::make_unique<Foam::Time>(Foam::word("controlDict"), Foam::fileName(path.parent_path().string()), Foam::fileName(caseName));
    mesh_ = std::make_unique<Foam::fvMesh>(Foam::IOobject(Foam::fvMesh::defaultRegion, time_->timeName(), *time_, Foam::IOobject::MUST_READ));
}

std::string FoamCase::prepare(const std::string& name, const std::vector<Edit>& edits, const std::string& blockMeshDict)
{
    try
    {
        owner_ = std::make_unique<TemporaryFolder>(name);
        folder_ = *owner_ / "case";
        std::filesystem::copy(std::string(FLOTSAM_TEST_CASES) + "/" + name, folder_, std::filesystem::copy_options::recursive);
        for (const Edit& e : edits) replace(folder_ + "/" + e.file, e.from, e.to);
        run("blockMesh -case " + folder_ + " -dict system/" + blockMeshDict, folder_ + "/log.blockMesh");
        if (ranks() > 1) run("decomposePar -case " + folder_, folder_ + "/log.decomposePar");
    }
    catch (const std::exception& error)
    {
        return error.what();
    }
    return {};
}

FoamCase::~FoamCase()
{
    mesh_.reset();
    time_.reset();
    MPI_Barrier(MPI_COMM_WORLD);
}

void FoamCase::edit(const Edit& e) { replace(share_ + "/" + e.file, e.from, e.to); }
std::string FoamCase::read(const std::string& file) const { return contentsOf(share_ + "/" + file); }

} // namespace flotsam
