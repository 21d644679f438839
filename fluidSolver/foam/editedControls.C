// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/editedControls.H"
#include "foam/caseCheck.H"
#include "foam/controlsReader.H"
#include "foam/dictionaryChecks.H"

namespace flotsam
{

namespace
{

/// What is wrong with the entries; empty: `time` has them.
std::string readInto(TimeControls& time, const Foam::dictionary& controlDict)
{
    const bool didThrow = Foam::FatalIOError.throwExceptions();
    std::string mistake;
    try
    {
        time = readTimeControls(controlDict);
    }
    catch (const Foam::IOerror& error)
    {
        mistake = error.message();
    }
    Foam::FatalIOError.throwExceptions(didThrow);
    while (!mistake.empty() && mistake.back() == '\n') mistake.pop_back();
    return mistake;
}

} // namespace

std::string EditedControls::update(const Foam::dictionary& controlDict)
{
    TimeControls read = time_;
    const std::string mistake = readInto(read, controlDict);
    const bool isNew = mistake != mistake_;
    mistake_ = mistake;
    if (!mistake.empty()) return isNew ? text("Warning: system/controlDict was changed, to what cannot be used: ", mistake, "\nThe time step stays ", describe(time_)) : "";
    if (read == time_) return "";
    time_ = read;
    return text("system/controlDict was changed: time step ", describe(time_));
}

EditedNumerics::EditedNumerics(const Foam::dictionary& fvSolution) : atStart_(fvSolution.subOrEmptyDict("flotsam").digest()), last_(atStart_) {}

std::string EditedNumerics::update(const Foam::dictionary& fvSolution)
{
    const Foam::SHA1Digest now = fvSolution.subOrEmptyDict("flotsam").digest();
    if (now == last_) return "";
    last_ = now;
    return now == atStart_ ? "" : "Warning: `flotsam` of system/fvSolution was changed. This run keeps what it has started with; the next one, with startFrom latestTime, goes on with what is changed";
}

} // namespace flotsam
