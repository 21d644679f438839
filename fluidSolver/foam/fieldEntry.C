// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/fieldEntry.H"

#include "ITstream.H"
#include "vector.H"

namespace flotsam
{

namespace
{

const char* example(const Foam::scalar*) { return "0"; }
const char* example(const Foam::vector*) { return "(0 0 0)"; }

template<class T>
bool isOneValue(Foam::ITstream& stream)
{
    const bool didThrow = Foam::FatalIOError.throwExceptions();
    bool isRead = false;
    try
    {
        Foam::token first;
        T value;
        stream >> first >> value;
        isRead = stream.nRemainingTokens() == 0;
    }
    catch (const Foam::IOerror&) {}
    Foam::FatalIOError.throwExceptions(didThrow);
    return isRead;
}

} // namespace

template<class T>
void checkFieldEntry(const Foam::dictionary& dict, const std::string& keyword, Foam::label size, const std::string& places)
{
    const std::string what = text("'uniform ", example(static_cast<T*>(nullptr)), "', or 'nonuniform List<", Foam::pTraits<T>::typeName, "> ..' of one value for each of the ", size, ' ', places);
    Foam::ITstream& given = valueOf(dict, keyword, what);
    if (given.empty()) failValue(dict, keyword, what);
    if (!given[0].isWord()) return;
    const Foam::word& kind = given[0].wordToken();
    if (kind == "uniform")
    {
        if (!isOneValue<T>(given)) failValue(dict, keyword, what);
        return;
    }
    if (kind != "nonuniform") failValue(dict, keyword, what);
    if (given.size() < 2 || !given[1].isCompound()) return;
    const Foam::label n = given[1].compoundToken().size();
    if (n == size) return;
    failIn(dict, text("Entry '", keyword, "' has ", n, " values for the ", size, ' ', places, ": the field is of another mesh.\n"
        "    Copy 0.orig to 0 and fill it anew (setFields, setExprFields, decomposePar), or map the fields (mapFields)."));
}

template void checkFieldEntry<Foam::scalar>(const Foam::dictionary&, const std::string&, Foam::label, const std::string&);
template void checkFieldEntry<Foam::vector>(const Foam::dictionary&, const std::string&, Foam::label, const std::string&);

} // namespace flotsam
