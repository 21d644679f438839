// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/contactReader.H"
#include "foam/dictionaryChecks.H"

#include <algorithm>

namespace flotsam
{

namespace
{

std::vector<std::string> materialNames(const Foam::dictionary& bodies)
{
    if (!bodies.found("materials")) return {"default"};
    std::vector<std::string> names;
    if (bodies.isDict("materials"))
        for (const Foam::word& name : subGroup(bodies, "materials").toc()) names.push_back(name);
    else
        names = readWords(bodies, "materials");
    if (names.empty()) failIn(bodies, "'materials' is empty: list at least one name, for instance (wood steel).");
    for (auto name = names.begin(); name != names.end(); ++name)
        if (std::find(names.begin(), name, *name) != name) failIn(bodies, text("'materials' has '", *name, "' twice: give every material once."));
    return names;
}

/// What the dictionary gives; the rest as `base`.
ContactLaw readLaw(const Foam::dictionary& dict, ContactLaw base)
{
    checkKeywords(dict, {"stiffness", "restitution", "frictionAngle", "perBody", "flatRestitution"});
    base.stiffness = readNumberOr(dict, "stiffness", base.stiffness, positive, "Spring constant of a touching sphere [N/m].");
    base.restitution = readNumberOr(dict, "restitution", base.restitution, {0.01, 1}, "0.2 for wet wood; 1: no energy is lost.");
    base.frictionAngleDeg = readNumberOr(dict, "frictionAngle", base.frictionAngleDeg, {0, 85}, "Degrees; 30 is a friction coefficient of 0.58.");
    base.perBody = readFlagOr(dict, "perBody", base.perBody);
    base.flatRestitution = readFlagOr(dict, "flatRestitution", base.flatRestitution);
    return base;
}

/// A pair has two names, one of which would win.
void checkNamedOnce(const Foam::dictionary& contact, const std::vector<std::string>& materials)
{
    for (std::size_t i = 0; i < materials.size(); ++i)
        for (std::size_t j = i + 1; j < materials.size(); ++j)
        {
            const std::string one = materials[i] + "-" + materials[j], other = materials[j] + "-" + materials[i];
            if (contact.found(one, Foam::keyType::LITERAL) && contact.found(other, Foam::keyType::LITERAL))
                failIn(contact, text("'", one, "' and '", other, "' are the same pair: give one of them."));
        }
}

/// All ways to name a pair, with its two materials.
std::vector<std::pair<std::string, std::pair<int, int>>> pairNames(const std::vector<std::string>& names)
{
    std::vector<std::pair<std::string, std::pair<int, int>>> pairs;
    for (std::size_t i = 0; i < names.size(); ++i)
        for (std::size_t j = 0; j < names.size(); ++j)
            pairs.push_back({names[i] + "-" + names[j], {static_cast<int>(i), static_cast<int>(j)}});
    return pairs;
}

} // namespace

MaterialTable readMaterials(const Foam::dictionary& bodies)
{
    MaterialTable table;
    table.names = materialNames(bodies);
    const std::size_t n = table.names.size();
    table.laws.assign(n*n, ContactLaw());
    if (!bodies.found("contact")) return table;

    const Foam::dictionary& contact = subGroup(bodies, "contact");
    const auto pairs = pairNames(table.names);
    std::vector<std::string> known{"default"};
    for (const auto& pair : pairs) known.push_back(pair.first);
    checkKeywords(contact, known);
    checkNamedOnce(contact, table.names);

    ContactLaw byDefault;
    if (contact.found("default")) byDefault = readLaw(subGroup(contact, "default"), byDefault);
    table.laws.assign(n*n, byDefault);
    for (const auto& [name, which] : pairs)
        if (contact.found(name, Foam::keyType::LITERAL))
            table.laws[which.first*n + which.second] = table.laws[which.second*n + which.first] = readLaw(subGroup(contact, name), byDefault);
    return table;
}

int readMaterial(const Foam::dictionary& dict, const char* keyword, const std::vector<std::string>& names)
{
    if (!dict.found(keyword))
    {
        if (names.size() > 1) failIn(dict, text("Entry '", keyword, "' is missing; one of: ", joined(names), "."));
        return 0;
    }
    const std::string name = readWord(dict, keyword, names);
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) failUnknown(dict, "material", name, names);
    return static_cast<int>(at - names.begin());
}

} // namespace flotsam
