// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/runEnd.H"

#include <algorithm>

namespace flotsam
{

void fitFirstStep(Foam::Time& runTime, const TimeControls& time, bool isAnew)
{
    if (!time.adjustTimeStep) return;
    const double left = runTime.endTime().value() - runTime.value();
    const double step = std::min(time.maxDeltaT, isAnew && left > 0 ? left : 1e300);
    if (step < runTime.deltaTValue()) runTime.setDeltaT(step, false);
}

bool reportEnded(const Foam::Time& runTime)
{
    const double endTime = runTime.endTime().value(), left = endTime - runTime.value();
    if (left > 0.5*runTime.deltaTValue()) return false;
    Foam::Info<< "Nothing to do: the run is at " << runTime.timeName() << " s, endTime of system/controlDict is " << endTime << " s";
    if (left > 1e-6*runTime.deltaTValue()) Foam::Info<< ", not half a step of " << runTime.deltaTValue() << " s later";
    Foam::Info<< Foam::endl;
    return true;
}

bool reportStopped(const Foam::Time& runTime)
{
    const Foam::dictionary& controls = runTime.controlDict();   // the clock's own endTime is the time of the stop
    const Foam::word stopAt = controls.getOrDefault<Foam::word>("stopAt", "endTime");
    const double endTime = controls.getOrDefault<double>("endTime", runTime.value());
    if (runTime.value() > endTime - 0.5*runTime.deltaTValue()) return false;
    if (stopAt == "endTime")    // meant to end here, and so no run that was broken off
    {
        Foam::Info<< "Ended by a function object of system/controlDict at " << runTime.timeName() << " s, before endTime, " << endTime << " s\n" << Foam::endl;
        return false;
    }
    Foam::Info<< "Stopped by stopAt " << stopAt << " of system/controlDict at " << runTime.timeName() << " s, before endTime, " << endTime << " s. "
        << (stopAt == "noWriteNow" ? "Nothing was written there" : "The state is written") << "; with stopAt endTime the run goes on from its last written time\n" << Foam::endl;
    return true;
}

} // namespace flotsam
