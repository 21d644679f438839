// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/endOnErrors.H"

#include "Pstream.H"
#include "error.H"

#include <chrono>
#include <exception>
#include <thread>

namespace flotsam
{

namespace
{

/// In parallel every rank finds the same mistake. The first, which alone knows file and line, says it and ends the run; the others leave it the time to.
void letMasterSpeak()
{
    if (Foam::Pstream::parRun() && !Foam::Pstream::master()) std::this_thread::sleep_for(std::chrono::seconds(5));
}

/// Called where the error was raised, before anything is taken down: destructors that communicate would wait for the other ranks.
[[noreturn]] void sayAndExit()
{
    letMasterSpeak();
    Foam::FatalError.dontThrowExceptions();
    Foam::FatalIOError.dontThrowExceptions();
    try
    {
        if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
    }
    catch (Foam::IOerror& error)
    {
        error.dontThrowExceptions();
        error.exit();
    }
    catch (Foam::error& error)
    {
        error.dontThrowExceptions();
        error.exit();
    }
    catch (const std::exception& error)
    {
        FatalErrorInFunction << error.what() << Foam::exit(Foam::FatalError);
    }
    catch (...) {}
    std::abort();
}

} // namespace

void endOnErrors()
{
    std::set_terminate(sayAndExit);
    Foam::FatalError.throwExceptions();
    Foam::FatalIOError.throwExceptions();
}

} // namespace flotsam

#if OPENFOAM >= 2012
namespace Foam
{

// From v2012 on OpenFOAM's abort ignores throwExceptions: a stack trace and a signal, and every rank says its message. What a program defines comes before the same name in the
// libraries it loads, whichever of them calls it: this is called instead of OpenFOAM's. With FOAM_ABORT in the environment exit() aborts as before.
void error::abort() { exit(1); }
void IOerror::abort() { exit(1); }

} // namespace Foam
#endif
