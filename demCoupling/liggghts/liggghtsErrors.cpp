// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/liggghts/liggghtsErrors.hpp"

#include "demCoupling/liggghts/liggghtsEngine.hpp"

#include <mpi.h>

#include "compute.h"
#include "error.h"
#include "fix.h"

#include <dlfcn.h>

#include <cstring>
#include <iostream>
#include <set>

namespace
{

[[noreturn]] void fail(const char* file, int line, const std::string& text)
{
    const char* name = std::strrchr(file, '/');
    throw flotsam::DemError("LIGGGHTS: " + text + " (" + (name ? name + 1 : file) + ":" + std::to_string(line) + ")");
}

std::string origin(const char* kind, const char* style, const char* id)
{
    return std::string(kind) + " " + (style ? style : "?") + " '" + (id ? id : "?") + "': ";
}

/// Each text once: LIGGGHTS repeats its warnings at every run.
void warn(const char* text)
{
    static std::set<std::string> seen;
    // thermo output, which is off, and moving meshes, which are not used
    if (std::strstr(text, "Energy calculated for multisphere") || std::strstr(text, "highly skewed element"))
        return;
    if (seen.insert(text).second)
        std::cerr << "LIGGGHTS warning: " << text << '\n';
}

} // namespace

namespace LAMMPS_NS
{

void Error::all(const char* file, int line, const char* text) { fail(file, line, text); }
void Error::one(const char* file, int line, const char* text) { fail(file, line, text); }
void Error::universe_all(const char* file, int line, const char* text) { fail(file, line, text); }
void Error::universe_one(const char* file, int line, const char* text) { fail(file, line, text); }
void Error::fix_error(const char* file, int line, Fix* fix, const char* text)
{
    fail(file, line, origin("fix", fix->style, fix->id) + text);
}
void Error::fix_error(const char* file, int line, Fix* fix, const char* style, const char* text)
{
    fail(file, line, origin("fix", style, fix->id) + text);
}
void Error::compute_error(const char* file, int line, Compute* compute, const char* text)
{
    fail(file, line, origin("compute", compute->style, compute->id) + text);
}
void Error::warning(const char*, int, const char* text, int) { warn(text); }
void Error::warningAll(const char*, int, const char* text, int) { warn(text); }

} // namespace LAMMPS_NS

namespace flotsam
{

void checkErrorsAreCaught()
{
    // What the library's procedure linkage table resolves to is the first global definition of the symbol. Asking
    // for it is safe; provoking an error instead would end the process without a word when the check fails.
    void* bound = dlsym(RTLD_DEFAULT, "_ZN9LAMMPS_NS5Error3allEPKciS2_");
    Dl_info info {};
    if (bound == nullptr || dladdr(bound, &info) == 0 || info.dli_fname == nullptr)
        throw DemError("LIGGGHTS errors would end the program: symbol LAMMPS_NS::Error::all is not exported; "
                       "link with default visibility");
    if (std::strstr(info.dli_fname, "liggghts") != nullptr && std::strstr(info.dli_fname, ".so") != nullptr
        && std::strstr(info.dli_fname, "flotsam") == nullptr)
        throw DemError(std::string("LIGGGHTS errors would end the program: ") + info.dli_fname
                       + " uses its own error handler; put flotsam's libraries before liggghts on the link line");
}

} // namespace flotsam
