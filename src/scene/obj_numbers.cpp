#include "scene/obj_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/input_line.h"

namespace hemirad {
namespace {

constexpr std::string_view kBlanks = " \t";

/// To cut a face that is not convex into triangles takes the square of its corners: some seconds
/// for the largest, and for all faces together.
constexpr std::size_t kMostCorners = 10'000;
constexpr std::size_t kMostSquares = 3 * kMostCorners * kMostCorners, kSquaresAByte = 100;

bool is_blank(char c) { return kBlanks.find(c) != kBlanks.npos; }

std::string_view next_word(std::string_view& line) {
    const auto begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return line = {};
    line.remove_prefix(begin);
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    line.remove_prefix(word.size());
    return word;
}

template <class Visit>
void for_each_line(std::string_view text, Visit visit) {
    for (std::size_t number = 1; !text.empty(); ++number) {
        const auto end = text.find('\n');
        visit(number, text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
}

glm::dvec3 read_vector(const InputLine& place, std::string_view rest, TextQuantum& quantum) {
    glm::dvec3 vector{};
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = next_word(rest);
        vector[axis] = read_number<double>(place, word);
        if (!std::isfinite(vector[axis])) place.fail(in_quotes(word) + " is not finite");
        quantum.add(word, vector[axis]);
    }
    return vector;
}

/// `7`, `7/1`, `7//3` or `7/1/3`; texture and normal indices mean nothing to us.
void check_corner(const InputLine& place, std::string_view corner) {
    for (int slashes = 0; slashes <= 2; ++slashes) {
        const auto slash = corner.find('/');
        const std::string_view index = corner.substr(0, slash);
        const bool may_be_empty = slashes > 0;
        if (!(index.empty() && may_be_empty) && read_number<int>(place, index) == 0) {
            place.fail("index 0, the first is 1");
        }
        if (slash == std::string_view::npos) return;
        corner.remove_prefix(slash + 1);
    }
    place.fail("a corner has more than three indices");
}

/// A comment may end in a backslash (a folder of Windows) without swallowing the next line.
bool is_continued(std::string_view line) { return line.ends_with('\\') && line.front() != '#'; }

/// In other lines what follows may be part of a name, `Material #25`, or is not read.
bool begins_comment(std::string_view line, char next) {
    constexpr std::array<std::string_view, 3> kOfNumbers{"f", "Kd", "Ke"};
    return next == '#' && !line.empty() && is_blank(line.back()) &&
           std::ranges::any_of(kOfNumbers, [&](std::string_view keyword) {
               return line.starts_with(keyword) && is_blank(line[keyword.size()]);
           });
}

/// Returns how many corners it has.
std::size_t check_face(const InputLine& place, std::string_view rest) {
    std::size_t corners = 0;
    for (auto word = next_word(rest); !word.empty(); word = next_word(rest)) {
        check_corner(place, word);
        ++corners;
    }
    if (corners < 3) place.fail("a face needs three corners");
    if (corners > kMostCorners)
        place.fail("a face has " + std::to_string(corners) + " corners, more than the " +
                   std::to_string(kMostCorners) + " that are read");
    return corners;
}

void check_squares(const InputFile& file, std::size_t squares, std::size_t bytes) {
    const std::size_t most = kMostSquares + kSquaresAByte * bytes;
    if (squares <= most) return;
    fail(file, "OBJ",
         "its faces have too many corners: squared and added up " + std::to_string(squares) +
             ", more than the " + std::to_string(most) + " that are read of " +
             std::to_string(bytes) + " bytes");
}

}  // namespace

std::string_view without_comment(std::string_view line) {
    for (auto at = line.find('#'); at != line.npos; at = line.find('#', at + 1))
        if (at > 0 && is_blank(line[at - 1])) return line.substr(0, at);
    return line;
}

std::string unfold_lines(const std::string& bytes) {
    std::string text;
    text.reserve(bytes.size() + 1);
    std::size_t owed = 0, line_begin = 0;
    bool in_comment = false;
    constexpr std::string_view kMark = "\xef\xbb\xbf";  // of byte order; some editors put it there
    for (std::size_t i = bytes.starts_with(kMark) ? kMark.size() : 0; i < bytes.size(); ++i) {
        const bool is_pair = bytes[i] == '\r' && i + 1 < bytes.size() && bytes[i + 1] == '\n';
        if (is_pair) continue;
        const auto line = std::string_view(text).substr(line_begin);
        if (bytes[i] != '\n' && bytes[i] != '\r') {
            in_comment = in_comment || begins_comment(line, bytes[i]);
            const bool leads = line.empty() && is_blank(bytes[i]);
            if (!in_comment && !leads) text += bytes[i];
            continue;
        }
        if (!in_comment && is_continued(line)) {
            text.back() = ' ';
            ++owed;
        } else {
            text.append(1 + owed, '\n');
            owed = 0;
            line_begin = text.size();
        }
        in_comment = false;
    }
    return text;
}

ObjNumbers read_obj_numbers(const InputFile& file, const std::string& text) {
    ObjNumbers numbers;
    std::size_t squares = 0;
    for_each_line(text, [&](std::size_t number, std::string_view line) {
        const std::string_view keyword = next_word(line);
        const InputLine place{file, number};
        if (keyword == "v")
            numbers.positions.push_back(read_vector(place, line, numbers.quanta.emplace_back()));
        if (keyword == "mtllib") numbers.libraries.emplace_back(line);
        if (keyword != "f") return;
        const std::size_t corners = check_face(place, line);
        squares += corners * corners;
        numbers.face_lines.push_back(number);
    });
    check_squares(file, squares, text.size());
    return numbers;
}

std::string spell_out_colours(const InputFile& file, const std::string& text) {
    std::string spelled;
    TextQuantum of_colours;
    for_each_line(text, [&](std::size_t number, std::string_view line) {
        spelled += line;
        const std::string_view keyword = next_word(line);
        if (keyword == "Kd" || keyword == "Ke") {
            const std::size_t begin = spelled.size() - line.size();
            const std::string_view first = next_word(line);
            if (next_word(line).empty())
                for (int i = 0; i < 2; ++i) spelled.append(1, ' ').append(first);
            read_vector({file, number}, std::string_view(spelled).substr(begin), of_colours);
        }
        spelled += '\n';
    });
    return spelled;
}

}  // namespace hemirad
