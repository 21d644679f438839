// SPDX-License-Identifier: GPL-3.0-or-later
#include "demCoupling/foam/repeatedGroups.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <map>

namespace flotsam
{

namespace
{

/// A dictionary's text as words and single brackets and semicolons; without comments and verbatim text (#{ .. #}). A string is a word.
class Words
{
public:
    explicit Words(const std::string& text) : text_(text) {}

    /// False at the end of the text.
    bool next()
    {
        skipGaps();
        line_ = lineHere_;
        const std::size_t begin = at_;
        if (at_ < text_.size()) readOne();
        word_ = text_.substr(begin, at_ - begin);
        return !word_.empty();
    }

    const std::string& word() const { return word_; }
    int line() const { return line_; }  ///< of the word

private:
    bool isAt(const char* part) const { return text_.compare(at_, std::strlen(part), part) == 0; }

    void step(std::size_t n = 1)
    {
        const std::size_t end = std::min(at_ + n, text_.size());
        for (; at_ < end; ++at_) lineHere_ += text_[at_] == '\n';
    }

    /// To behind the next `end`.
    void stepBehind(const char* end)
    {
        while (at_ < text_.size() && !isAt(end)) step();
        step(std::strlen(end));
    }

    void skipGaps()
    {
        while (at_ < text_.size())
        {
            if (isAt("//")) stepBehind("\n");
            else if (isAt("/*")) stepBehind("*/");
            else if (isAt("#{")) stepBehind("#}");
            else if (std::isspace(static_cast<unsigned char>(text_[at_]))) step();
            else return;
        }
    }

    static bool isBracket(char c) { return std::strchr("{}();", c) != nullptr; }

    void readOne()
    {
        if (text_[at_] == '"') readString();
        else if (isBracket(text_[at_])) step();
        else while (at_ < text_.size() && !endsWord()) step();
    }

    bool endsWord() const
    {
        const char c = text_[at_];
        return c == '"' || isBracket(c) || std::isspace(static_cast<unsigned char>(c)) || isAt("//") || isAt("/*");
    }

    void readString()
    {
        step();
        while (at_ < text_.size() && text_[at_] != '"') step(text_[at_] == '\\' ? 2 : 1);
        step();
    }

    const std::string& text_;
    std::size_t at_ = 0;
    int lineHere_ = 1, line_ = 1;
    std::string word_;
};

class Search
{
public:
    explicit Search(const std::vector<std::string>& sections) : sections_(sections) {}

    std::vector<RepeatedGroup> run(const std::string& text)
    {
        Words words(text);
        std::string last;   // a keyword, when a block follows
        int lastLine = 0;
        while (words.next())
        {
            const std::string& word = words.word();
            if (word == "{") open(last, lastLine);
            else if (word == "(") ++depth_;
            else if (word == "}" || word == ")") --depth_;
            else changeBranch(word);
            last = word;
            lastLine = words.line();
        }
        return std::move(found_);
    }

private:
    void open(const std::string& keyword, int line)
    {
        if (depth_ == 0) section_ = keyword;
        if (depth_ == 1 && isName(keyword) && std::find(sections_.begin(), sections_.end(), section_) != sections_.end()) see(keyword, line);
        ++depth_;
    }

    /// Not what ends another entry, nor a directive or a variable, whose value is not known here.
    static bool isName(const std::string& keyword) { return !keyword.empty() && !std::strchr("{}();#$", keyword[0]); }

    void see(const std::string& name, int line)
    {
        const auto [first, isNew] = branches_.back().emplace(std::make_pair(section_, name), line);
        if (!isNew) found_.push_back({section_, name, first->second, line});
    }

    void changeBranch(const std::string& word)
    {
        if (word == "#if" || word == "#ifeq") branches_.emplace_back();
        if (word == "#elif" || word == "#else") branches_.back().clear();
        if (word == "#endif" && branches_.size() > 1) branches_.pop_back();
    }

    using Lines = std::map<std::pair<std::string, std::string>, int>;   // of section and name: where it begins

    const std::vector<std::string>& sections_;
    std::vector<Lines> branches_{1};    // one within the other
    std::string section_;
    int depth_ = 0;
    std::vector<RepeatedGroup> found_;
};

} // namespace

std::vector<RepeatedGroup> repeatedGroups(const std::string& text, const std::vector<std::string>& sections)
{
    return Search(sections).run(text);
}

} // namespace flotsam
