// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/laterTimes.H"

#include "foam/dictionaryChecks.H"

#include "OSspecific.H"

namespace flotsam
{

namespace
{

/// Fields that others have put there, to be mapped for instance, are no results.
bool isResult(const Foam::fileName& folder)
{
    return Foam::isFile(folder/"flotsamState.h5") || Foam::isFile(folder/"uniform"/"flotsamState.h5") || Foam::isFile(folder/"pointU");
}

} // namespace

void warnLaterTimes(const Foam::Time& runTime)
{
    Foam::wordList later;
    for (const Foam::instant& time : runTime.times())    // sorted
        if (time.value() > runTime.value() && time.name() != runTime.timeName() && isResult(runTime.path()/time.name())) later.append(time.name());
    if (later.empty()) return;
    const std::string first = later.first(), last = later.last();
    Foam::Info<< text("Warning: results of an earlier run lie ahead of this start, ", first == last ? "" : "times " + first + " to ", first == last ? "time " : "", last,
        ". Until this run has overwritten the last of them, `startFrom latestTime` would continue the earlier run, not this one,\n    and ParaView shows both as one."
        " To remove them before the start:  foamListTimes ", Foam::Pstream::parRun() ? "-processor " : "", "-rm -time '", first, ":'\n").c_str() << Foam::endl;
}

} // namespace flotsam
