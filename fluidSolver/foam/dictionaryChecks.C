// SPDX-License-Identifier: GPL-3.0-or-later
#include "foam/dictionaryChecks.H"

#include "ITstream.H"
#include "OStringStream.H"
#include "Switch.H"
#include "error.H"
#include "wordList.H"

#include <algorithm>
#include <cctype>

namespace flotsam
{

namespace
{

/// Place: a dictionary, or the stream of an entry, which knows its line.
template<class Place>
[[noreturn]] void failAt(const Place& place, const std::string& message)
{
    FatalIOErrorInFunction(place) << message.c_str() << Foam::nl << Foam::exit(Foam::FatalIOError);
    throw std::logic_error(message); // never reached: exit() ends the run or throws
}

} // namespace

void failIn(const Foam::dictionary& dict, const std::string& message) { failAt(dict, message); }

void failOnAll(const std::string& message)
{
    FatalErrorInFunction << message.c_str() << Foam::nl << Foam::exit(Foam::FatalError);
    throw std::logic_error(message); // never reached
}

const Foam::dictionary& subGroup(const Foam::dictionary& dict, const std::string& keyword)
{
    if (!dict.found(keyword)) failIn(dict, text("Entry '", keyword, " { .. }' is missing."));
    if (dict.isDict(keyword)) return dict.subDict(keyword);
    failValue(dict, keyword, text("a group of entries in braces: ", keyword, " { .. }"));
}

std::string toString(const Foam::dimensionSet& dimensions)
{
    std::ostringstream s;
    for (int k = 0; k < 7; ++k) s << (k ? " " : "[") << dimensions[static_cast<Foam::dimensionSet::dimensionType>(k)];
    return s.str() + "]";
}

std::string toString(const Range& range)
{
    if (range.upper >= 1e300)
        return text(range.withoutLower ? "larger than " : "at least ", range.lower);
    return text(range.withoutLower ? "larger than " : "from ", range.lower, range.withoutLower ? ", at most " : " to ", range.upper);
}

namespace
{
char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

std::string suggestion(const std::string& word, const std::vector<std::string>& known)
{
    const auto near = nearestWords(word, known);
    return near.empty() ? std::string() : text("\n    Did you mean: ", joined(near), " ?");
}
}

int editDistance(const std::string& a, const std::string& b)
{
    // optimal string alignment: three rows of the usual table
    const std::size_t n = b.size();
    std::vector<int> older(n + 1), old(n + 1), now(n + 1);
    for (std::size_t j = 0; j <= n; ++j) old[j] = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i)
    {
        now[0] = static_cast<int>(i);
        for (std::size_t j = 1; j <= n; ++j)
        {
            const bool same = lower(a[i - 1]) == lower(b[j - 1]);
            now[j] = std::min({old[j] + 1, now[j - 1] + 1, old[j - 1] + (same ? 0 : 1)});
            if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
                now[j] = std::min(now[j], older[j - 2] + 1);
        }
        older.swap(old);
        old.swap(now);
    }
    return old[n];
}

std::vector<std::string> nearestWords(const std::string& word, const std::vector<std::string>& known)
{
    std::vector<std::pair<int, std::string>> ranked;
    for (const auto& k : known)
    {
        const int d = editDistance(word, k);
        const bool isPart = word.size() >= 3 && (k.find(word) != std::string::npos || word.find(k) != std::string::npos);
        if (isPart || d <= std::max<int>(2, static_cast<int>(std::max(word.size(), k.size())) / 3)) ranked.emplace_back(d, k);
    }
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::string> near;
    for (std::size_t i = 0; i < ranked.size() && i < 3; ++i) near.push_back(ranked[i].second);
    return near;
}

std::string joined(const std::vector<std::string>& words)
{
    std::string s;
    for (const auto& w : words) s += (s.empty() ? "" : ", ") + w;
    return s;
}

void failUnknown(const Foam::dictionary& dict, const std::string& what, const std::string& found, const std::vector<std::string>& known)
{
    failIn(dict, text("Unknown ", what, " '", found, "'.", suggestion(found, known), "\n    Known: ", joined(known)));
}

void checkKeywords(const Foam::dictionary& dict, const std::vector<std::string>& known)
{
    for (const Foam::entry& e : dict)
    {
        const std::string keyword(e.keyword());
        if (keyword != "FoamFile" && std::find(known.begin(), known.end(), keyword) == known.end())
            failUnknown(dict, "keyword", keyword, known);
    }
}

std::vector<std::pair<std::string, std::string>> misspeltEntries(const Foam::dictionary& dict, const std::vector<std::string>& known)
{
    constexpr std::size_t shortWord = 6;
    std::vector<std::string> missing;
    for (const std::string& word : known)
        if (!dict.found(word, Foam::keyType::LITERAL)) missing.push_back(word);
    std::vector<std::pair<std::string, std::string>> result;
    for (const Foam::entry& e : dict)
    {
        const std::string keyword(e.keyword());
        if (e.keyword().isPattern() || keyword == "FoamFile" || std::find(known.begin(), known.end(), keyword) != known.end()) continue;
        for (const std::string& word : nearestWords(keyword, missing))
        {
            const bool isPart = word.size() >= shortWord && keyword.find(word) != std::string::npos;
            if (!isPart && editDistance(keyword, word) > (keyword.size() < shortWord ? 1 : 2)) continue;
            result.emplace_back(keyword, word);
            break;
        }
    }
    return result;
}

namespace
{

constexpr std::size_t longestValue = 80;    // of a message: what a forgotten ';' swallows may be the rest of the file

std::string written(const Foam::ITstream& value)
{
    Foam::OStringStream found;
    for (const Foam::token& t : value) found << (found.str().empty() ? "" : " ") << t;
    const std::string all = found.str();
    return all.size() > longestValue ? all.substr(0, longestValue) + " .." : all;
}

/// The beginning of an entry is what is wanted: what follows belongs to the next, or is a unit.
bool hasTail(const Foam::ITstream& value)
{
    static const std::vector<std::string> continued{"uniform", "nonuniform", "constant", "table"};
    if (value.size() < 2 || !(value[0].isNumber() || value[0].isWord())) return false;
    if (!value[0].isWord() || std::find(continued.begin(), continued.end(), value[0].wordToken()) == continued.end()) return true;
    for (Foam::label i = 2; i < value.size(); ++i)
        if (value[i - 1].isNumber() && value[i].isWord()) return true;
    return false;
}

} // namespace

void failValue(const Foam::dictionary& dict, const std::string& keyword, const std::string& what)
{
    if (dict.isDict(keyword)) failIn(dict, text("Entry '", keyword, "' is a group of entries in braces, but must be ", what, '.'));
    const Foam::ITstream& value = dict.lookup(keyword);
    failAt(value, text("Entry '", keyword, "' is '", written(value), "', but must be ", what, '.',
        hasTail(value) ? "\n    Values have no unit behind them, and end with ';'." : ""));
}

Foam::ITstream& valueOf(const Foam::dictionary& dict, const std::string& keyword, const std::string& what)
{
    if (!dict.found(keyword)) failIn(dict, text("Entry '", keyword, "' is missing: it must be ", what, '.'));
    if (dict.isDict(keyword)) failValue(dict, keyword, what);
    return dict.lookup(keyword);
}

void checkRange(const Foam::dictionary& dict, const std::string& keyword, double value, const Range& range, const std::string& hint)
{
    if (!range.contains(value))
        failIn(dict, text("Entry '", keyword, "' is ", value, ": it must be ", toString(range), ".", hint.empty() ? "" : "\n    ", hint));
}

double readNumber(const Foam::dictionary& dict, const std::string& keyword, const Range& range, const std::string& hint)
{
    const double value = readAs<Foam::scalar>(dict, keyword, text("a number ", toString(range)));
    checkRange(dict, keyword, value, range, hint);
    return value;
}

double readNumberOr(const Foam::dictionary& dict, const std::string& keyword, double byDefault, const Range& range, const std::string& hint)
{
    return dict.found(keyword, Foam::keyType::LITERAL) ? readNumber(dict, keyword, range, hint) : byDefault;
}

int readCount(const Foam::dictionary& dict, const std::string& keyword, const Range& range, const std::string& hint)
{
    const int value = readAs<Foam::label>(dict, keyword, text("a whole number ", toString(range)));
    checkRange(dict, keyword, value, range, hint);
    return value;
}

int readCountOr(const Foam::dictionary& dict, const std::string& keyword, int byDefault, const Range& range, const std::string& hint)
{
    return dict.found(keyword, Foam::keyType::LITERAL) ? readCount(dict, keyword, range, hint) : byDefault;
}

bool readFlagOr(const Foam::dictionary& dict, const std::string& keyword, bool byDefault)
{
    return dict.found(keyword) ? bool(readAs<Foam::Switch>(dict, keyword, "on or off (yes, no, true, false)")) : byDefault;
}

std::string readWord(const Foam::dictionary& dict, const std::string& keyword, const std::vector<std::string>& known)
{
    return readAs<Foam::word>(dict, keyword, known.empty() ? "a word" : text("one of: ", joined(known)));
}

std::string readWordOr(const Foam::dictionary& dict, const std::string& keyword, const std::string& byDefault)
{
    return dict.found(keyword) ? readWord(dict, keyword) : byDefault;
}

std::vector<std::string> readWords(const Foam::dictionary& dict, const std::string& keyword)
{
    const auto words = readAs<Foam::wordList>(dict, keyword, "a list of words in round brackets: (a b)");
    return std::vector<std::string>(words.begin(), words.end());
}

} // namespace flotsam
