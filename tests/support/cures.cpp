// SPDX-License-Identifier: Apache-2.0
#include "tests/support/cures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace treefarm::test {
namespace {

/// An element of a document, as positions in its text.
struct Span {
    std::size_t begin = 0, tag_end = 0, end = 0;  ///< `tag_end`: after the > of its first tag
};

std::size_t position_of(const std::string& document, const Location& where) {
    std::size_t at = 0;
    for (int line = 1; line < where.line; ++line)
        at = document.find('\n', at) + 1;
    return at + static_cast<std::size_t>(std::max(where.column, 1) - 1);
}

/// Element whose < is at `begin`; its end is found by counting tags.
Span element_at(const std::string& document, std::size_t begin) {
    Span span{begin, document.find('>', begin) + 1, 0};
    int depth = 0;
    for (std::size_t at = begin; at < document.size();) {
        const std::size_t close = document.find('>', at);
        if (close == std::string::npos) break;
        if (document[at + 1] == '/')
            --depth;
        else if (document[close - 1] != '/')
            ++depth;
        span.end = close + 1;
        if (depth == 0) return span;
        at = document.find('<', close);
    }
    return span;
}

std::string without(const std::string& document, std::size_t begin, std::size_t end) {
    return document.substr(0, begin) + document.substr(end);
}

std::string quoted_word(const std::string& text) {
    const std::size_t begin = text.find('"'), end = text.find('"', begin + 1);
    return begin == std::string::npos ? "" : text.substr(begin + 1, end - begin - 1);
}

/// Documents in which `word` replaces the text that the problem quotes, or its tag, in an element's first tag.
std::vector<Cured> with_word(const std::string& document, const Span& span, const std::string& problem,
                             const std::string& word) {
    std::string tag = document.substr(span.begin, span.tag_end - span.begin);
    const std::string wrong = quoted_word(problem);
    std::size_t at = tag.find("\"" + wrong + "\""), length = wrong.size();
    if (problem.starts_with("<") && problem.find("is no transformation") != std::string::npos) {
        at = 0;
        length = problem.find('>') - 1;
    } else if (wrong.empty() || at == std::string::npos) {
        return {{"the word " + word + " has no place", ""}};
    }
    tag.replace(at + 1, length, word);
    return {{"the word " + word, document.substr(0, span.begin) + tag + document.substr(span.tag_end)}};
}

/// Document in which a number replaces the one that the problem names, or the whole value.
Cured with_number(const std::string& document, const Span& span, const std::string& problem,
                  const std::string& number) {
    std::string tag = document.substr(span.begin, span.tag_end - span.begin);
    std::smatch named;
    static const std::regex kNumber(R"((?:of|is) (-?[0-9][0-9.e+]*))");
    const bool has_number = std::regex_search(problem, named, kNumber);
    if (const std::size_t at = has_number ? tag.find(named[1].str()) : std::string::npos; at != std::string::npos) {
        tag.replace(at, static_cast<std::size_t>(named[1].length()), number);
    } else if (const std::size_t value = tag.find("value=\""); value != std::string::npos) {
        const std::size_t begin = value + 7;
        tag.replace(begin, tag.find('"', begin) - begin, number);
    }
    return {"the number " + number, document.substr(0, span.begin) + tag + document.substr(span.tag_end)};
}

std::string text_of(double number) {
    std::ostringstream text;
    text << number;
    return text.str();
}

/// Numbers allowed by a cure: its limits, and one between them.
std::vector<std::string> numbers_named(const std::string& cure) {
    static const std::string kNumber = "(-?[0-9.]+)";
    std::smatch m;
    const auto is = [&](const std::string& pattern) { return std::regex_search(cure, m, std::regex(pattern)); };
    const auto number = [&](std::size_t i) { return std::stod(m[i].str()); };
    const bool whole = cure.find('.') == std::string::npos;
    if (is("^give more than " + kNumber + " and (?:less than|at most) " + kNumber))
        return {text_of(0.5 * (number(1) + number(2)))};
    if (is("^give (?:a value from |values from )?" + kNumber + " to " + kNumber)) {
        const double middle = 0.5 * (number(1) + number(2));
        const bool wide = whole && number(2) - number(1) >= 2.0;
        return {m[1].str(), m[2].str(), text_of(wide ? std::floor(middle) : middle)};
    }
    if (is("^give " + kNumber + " to the")) return {m[1].str()};
    if (is("^give more than " + kNumber)) return {text_of(number(1) + 1.0)};
    if (is("^give (?:finite values of |a whole number of |values of )?" + kNumber + " or more"))
        return {m[1].str(), text_of(number(1) + 1.0)};
    if (is("^give at most " + kNumber)) return {m[1].str()};
    if (is("^give (?:a positive number|one that is positive)")) return {"1"};
    if (is("^give a shape index from " + kNumber) || is("^count from " + kNumber)) return {m[1].str()};
    if (is("^write an integer")) return {"3"};
    if (is("^write a finite decimal number")) return {"1.5"};
    return {};
}

/// Words of "use a, b or c", up to the first text that is no such list.
std::vector<std::string> words_named(const std::string& cure) {
    static const std::regex kList(
        R"((?:^|Otherwise |, or )(?:use|choose one of|write(?= true)) ((?:[A-Za-z_0-9]+)(?:(?:, | or )[A-Za-z_0-9]+)*))");
    std::smatch m;
    if (!std::regex_search(cure, m, kList)) return {};
    std::vector<std::string> words;
    static const std::regex kWord(R"([A-Za-z_0-9]+)");
    const std::string list = m[1].str();
    for (std::sregex_iterator at(list.begin(), list.end(), kWord), end; at != end; ++at)
        if (const std::string word = at->str(); word != "or") words.push_back(word);
    const bool is_prose =
        words.size() == 1 && m.suffix().str().starts_with(" ") && !m.suffix().str().starts_with(" (with");
    return is_prose || words.front() == "a" || words.front() == "one" ? std::vector<std::string>{} : words;
}

bool takes_away(const std::string& cure) {
    static const std::regex kAway("^(remove (it|one of them|them)|keep one)");
    return std::regex_search(cure, kAway);
}

}  // namespace

std::vector<Cured> apply_cure(const std::string& document, const InputError& error) {
    const std::string &cure = error.cure(), &problem = error.problem();
    const Span span = element_at(document, position_of(document, error.where()));
    std::vector<Cured> cured;
    const auto add = [&](std::vector<Cured> more) { cured.insert(cured.end(), more.begin(), more.end()); };
    if (cure.starts_with("did you mean")) add(with_word(document, span, problem, quoted_word(cure)));
    if (const std::size_t at = cure.find("use <emitter type=\"area\">"); at != std::string::npos)
        add(with_word(document, span, problem, "area"));
    for (const std::string& word : words_named(cure))
        add(with_word(document, span, problem, word));
    for (const std::string& number : numbers_named(cure))
        cured.push_back(with_number(document, span, problem, number));
    if (takes_away(cure)) {
        const std::size_t attribute = problem.find("unknown attribute ");
        if (attribute != std::string::npos) {
            const std::size_t begin = document.find(" " + quoted_word(problem.substr(attribute)) + "=\"", span.begin);
            const std::size_t end = document.find('"', document.find('"', begin) + 1) + 1;
            cured.push_back({"without the attribute", without(document, begin, end)});
        } else if (cure.starts_with("remove them") && document[span.tag_end - 2] != '/') {
            const std::size_t inside_end = document.rfind("</", span.end - 1);
            cured.push_back({"without what is inside", without(document, span.tag_end, inside_end)});
        } else {
            cured.push_back({"without the element", without(document, span.begin, span.end)});
        }
    }
    if (cure.starts_with("add <sensor")) {
        std::string more = document;
        cured.push_back({"added", more.insert(document.rfind("</scene>"), "<sensor type=\"perspective\"/>")});
    }
    return cured;
}

bool is_mechanical(const std::string& cure) {
    return cure.starts_with("did you mean") || cure.starts_with("add <sensor") || takes_away(cure) ||
           !words_named(cure).empty() || !numbers_named(cure).empty();
}

namespace {

/// Source with its raw string literals rewritten as ordinary ones.
std::string with_escapes(std::string source) {
    for (std::size_t at = 0; (at = source.find("R\"(", at)) != std::string::npos;) {
        const std::size_t end = source.find(")\"", at);
        if (end == std::string::npos) break;
        std::string text = "\"";
        for (const char c : source.substr(at + 3, end - at - 3)) {
            if (c == '"' || c == '\\') text += '\\';
            text += c;
        }
        source.replace(at, end + 2 - at, text + '"');
        at += text.size() + 1;
    }
    return source;
}

/// Arguments of a call, starting after its opening parenthesis.
std::vector<std::string> arguments(const std::string& source, std::size_t at) {
    std::vector<std::string> parts(1);
    bool in_text = false;
    for (int depth = 1; at < source.size(); ++at) {
        const char c = source[at];
        if (in_text) {
            parts.back() += c;
            if (c == '\\') parts.back() += source[++at];
            in_text = c != '"';
            continue;
        }
        in_text = c == '"';
        if (c == '(' || c == '{' || c == '[') ++depth;
        if (c == ')' || c == '}' || c == ']') --depth;
        if (depth == 0) break;
        if (c == ',' && depth == 1)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

/// String literals of an expression; adjacent ones are joined.
std::vector<std::string> literals(const std::string& expression) {
    std::vector<std::string> texts;
    static const std::regex kText(R"re("((?:[^"\\]|\\.)*)"(?:\s*"((?:[^"\\]|\\.)*)")?)re");
    for (std::sregex_iterator at(expression.begin(), expression.end(), kText), end; at != end; ++at) {
        std::string text = (*at)[1].str() + (*at)[2].str();
        for (std::size_t escape; (escape = text.find('\\')) != std::string::npos;)
            text.erase(escape, 1);
        texts.push_back(text);
    }
    return texts;
}

}  // namespace

std::vector<Refusal> refusals_in(const std::string& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".cpp") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<Refusal> refusals;
    static const std::regex kCall(R"(throw InputError\(|\bunsupported\()");
    for (const auto& file : files) {
        std::ifstream in(file);
        const std::string source = with_escapes({std::istreambuf_iterator<char>(in), {}});
        for (std::sregex_iterator at(source.begin(), source.end(), kCall), end; at != end; ++at) {
            const auto begin = static_cast<std::size_t>(at->position());
            const auto parts = arguments(source, begin + static_cast<std::size_t>(at->length()));
            if (parts.size() < 3) continue;
            const auto line = std::count(source.begin(), source.begin() + at->position(), '\n') + 1;
            refusals.push_back({file.filename().string() + ":" + std::to_string(line), literals(parts[2])});
        }
    }
    return refusals;
}

}  // namespace treefarm::test
