// SPDX-License-Identifier: GPL-3.0-or-later
/// Groups that a file describes twice: OpenFOAM would merge them into one, the second's entries over the first's, without a word.
#pragma once

#include <string>
#include <vector>

namespace flotsam
{

/// `name { .. }` for the second time directly within `section { .. }`.
struct RepeatedGroup
{
    std::string section, name;
    int firstLine, line;    ///< where the two begin, from 1
};

/// Of the text of a dictionary, in the order of its lines. Only what stands twice in this text and in the same branch of #if: with an included file,
/// or under a condition, a second description is how an OpenFOAM user changes entries of the first. Never fails: errors of syntax are OpenFOAM's to report.
std::vector<RepeatedGroup> repeatedGroups(const std::string& text, const std::vector<std::string>& sections);

} // namespace flotsam
