#include "scene/vs3_fields.h"

#include <cctype>
#include <cmath>

namespace hemirad {
namespace {

constexpr std::string_view kBlanks = " ,\t\r";

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (auto begin = line.find_first_not_of(kBlanks); begin != std::string_view::npos;
         begin = line.find_first_not_of(kBlanks)) {
        line.remove_prefix(begin);
        if (line.front() == '!' || (words.empty() && line.front() == '/')) break;
        words.push_back(line.substr(0, line.find_first_of(kBlanks)));
        line.remove_prefix(words.back().size());
    }
    return words;
}

char upper_case(char letter) {
    return static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
}

}  // namespace

Vs3Fields::Vs3Fields(const InputFile& file) : file_(file), rest_(file.bytes) {}

bool Vs3Fields::next_line() {
    next_ = 0;
    words_.clear();
    while (words_.empty() && !rest_.empty()) {
        const auto end = rest_.find('\n');
        words_ = words_of(rest_.substr(0, end));
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        ++line_number_;
    }
    const char first = words_.empty() ? '*' : upper_case(words_[0][0]);
    if (first == '*' || first == 'E') rest_ = {}, words_.clear();
    return !words_.empty();
}

char Vs3Fields::card() { return upper_case(word("card")[0]); }

std::string_view Vs3Fields::word(const char* what) {
    if (!has_more()) place().fail(std::string("the ") + what + " is missing");
    return words_[next_++];
}

int Vs3Fields::whole_number(const char* what) { return read_number<int>(place(), word(what)); }

double Vs3Fields::number(const char* what) {
    const std::string_view text = word(what);
    const double value = read_number<double>(place(), text);
    if (!std::isfinite(value)) place().fail(in_quotes(text) + " is not finite");
    return value;
}

double Vs3Fields::coordinate(const char* what) {
    const double value = number(what);
    quantum_.add(words_[next_ - 1], value);
    return value;
}

double Vs3Fields::number_further_on(const char* what) {
    if (!has_more()) next_line();
    return number(what);
}

}  // namespace hemirad
