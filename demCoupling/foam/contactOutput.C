// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/contactOutput.H"

#include <algorithm>

namespace flotsam
{

ContactOutput::ContactOutput(const BodiesInput& input)
:   nStructures_(int(input.structures.size())), nMembers_(nStructures_ + int(input.bodies.size())), numberOfWall_(input.walls.size() + input.movers.size(), -1)
{
    for (int s = 0; s < nStructures_; ++s)
        if (input.structures[s].wall >= 0) numberOfWall_[input.structures[s].wall] = s;
    for (std::size_t w = 0; w < input.walls.size(); ++w)
    {
        // a patch of several planes is one
        const std::string& patch = input.walls[w].patch;
        if (patch.empty()) continue;
        const auto known = std::find(wallNames_.begin(), wallNames_.end(), patch);
        numberOfWall_[w] = nMembers_ + int(known - wallNames_.begin());
        if (known == wallNames_.end()) wallNames_.push_back(patch);
    }
}

int ContactOutput::numberOf(int partner) const { return partner >= 0 ? nStructures_ + partner : numberOfWall_[-1 - partner]; }

namespace
{

/// Of two walls or structures of one body, what is one partner here.
void merge(const MeanContact& c, double& weight, ContactRecord& record)
{
    const double added = c.force.norm();
    record.force += c.force;
    record.overlap = std::max(record.overlap, c.overlap);
    record.spheres += c.spheres;
    if (weight + added > 0) record.point = (weight*record.point + added*c.point)/(weight + added);
    weight += added;
}

/// From centre to centre of two bodies; of a body and something else from the body's centre to the point, as the origin of a structure may be anywhere.
std::array<Vec3, 3> line(const Vec3& from, const Vec3& point, const Vec3* to)
{
    if (to) return {from, point, *to};
    return {from, 0.5*(from + point), point};
}

} // namespace

std::vector<ContactRecord> ContactOutput::records(const std::vector<MeanContact>& contacts, const std::vector<BodyRecord>& records) const
{
    std::vector<ContactRecord> result;
    std::vector<double> weights;
    for (const MeanContact& c : contacts)
    {
        const int first = numberOf(c.body), second = numberOf(c.other);
        const auto isSame = [&](const ContactRecord& r) { return r.first == first && r.second == second; };
        std::size_t at = std::find_if(result.begin(), result.end(), isSame) - result.begin();
        if (at == result.size())
        {
            result.emplace_back();
            result.back().first = first;
            result.back().second = second;
            weights.push_back(0);
        }
        merge(c, weights[at], result[at]);
    }
    for (ContactRecord& r : result) r.line = line(records[r.first].pose.position, r.point, r.second >= nStructures_ && r.second < nMembers_ ? &records[r.second].pose.position : nullptr);
    return result;
}

} // namespace flotsam
