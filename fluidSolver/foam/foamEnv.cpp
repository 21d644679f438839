// SPDX-License-Identifier: GPL-3.0-or-later
/// Lets the executable start without an OpenFOAM environment. libOpenFOAM looks for etc/controlDict through WM_PROJECT_DIR in
/// its static initialisers, before main(). A function in .preinit_array of the EXECUTABLE runs before those; the C library
/// has not taken over the environment at that point (setenv would be lost), so the process executes itself once more with the variable added.
#include <cstring>
#include <unistd.h>

#ifndef FLOTSAM_FOAM_PROJECT_DIR
#define FLOTSAM_FOAM_PROJECT_DIR "/usr/share/openfoam"
#endif

namespace
{

const char variable[] = "WM_PROJECT_DIR=";
const std::size_t variableLength = sizeof(variable) - 1;
char assignment[] = "WM_PROJECT_DIR=" FLOTSAM_FOAM_PROJECT_DIR;

bool isVariable(const char* entry) { return std::strncmp(entry, variable, variableLength) == 0; }

void ensureProjectDir(int, char** argv, char** environment)
{
    std::size_t n = 0;
    for (; environment[n]; ++n)
        if (isVariable(environment[n]) && environment[n][variableLength] != '\0') return;
    if (access(FLOTSAM_FOAM_PROJECT_DIR "/etc/controlDict", R_OK) != 0) return; // OpenFOAM's own message is clear

    auto** extended = static_cast<char**>(__builtin_alloca((n + 2)*sizeof(char*)));
    std::size_t k = 0;
    for (std::size_t i = 0; i < n; ++i)
        if (!isVariable(environment[i])) extended[k++] = environment[i];
    extended[k++] = assignment;
    extended[k] = nullptr;
    execve("/proc/self/exe", argv, extended); // returns only when it fails
}

__attribute__((section(".preinit_array"), used)) void (*const preinit)(int, char**, char**) = ensureProjectDir;

} // namespace
