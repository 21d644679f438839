// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/tableJumps.H"

#include "TableBase.H"
#include "vector.H"

#include <algorithm>

namespace flotsam
{

template<class Type>
std::vector<TimeJump> tableJumps(const Foam::Function1<Type>& function)
{
    constexpr double large = 0.1;   // of the largest difference from the first row
    const auto* table = dynamic_cast<const Foam::Function1Types::TableBase<Type>*>(&function);
    if (!table) return {};
    const Foam::scalarField times(table->x());
    const Foam::Field<Type> values(table->y());
    double range = 0;
    for (const Type& value : values) range = std::max(range, double(Foam::mag(value - values[0])));

    std::vector<TimeJump> jumps;
    double moment = 0, change = 0;  // of the jump that the last row belongs to
    for (Foam::label i = 1; i < times.size(); ++i)
    {
        const double part = Foam::mag(values[i] - values[i - 1]), length = times[i] - times[i - 1];
        const bool isPart = part > 0 && part >= large*range;
        if (isPart && change == 0) jumps.push_back({0, 0});
        moment = isPart ? moment + part*0.5*(times[i] + times[i - 1]) : 0;
        change = isPart ? change + part : 0;
        if (isPart) jumps.back() = {moment/change, jumps.back().length + length};
    }
    return jumps;
}

template std::vector<TimeJump> tableJumps(const Foam::Function1<Foam::scalar>&);
template std::vector<TimeJump> tableJumps(const Foam::Function1<Foam::vector>&);

} // namespace flotsam
