#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "scene/input_line.h"
#include "scene/quantum.h"

namespace hemirad {

/// The fields of a View3D file, line by line up to its end line. Blanks, tabs and commas part
/// them, `!` begins a comment, and so does `/` at the beginning of a line. What is missing or no
/// number is an InputError that names `what`.
class Vs3Fields {
  public:
    explicit Vs3Fields(const InputFile& file);

    /// To the beginning of the next line that says something; false at the end.
    bool next_line();
    InputLine place() const { return {file_, line_number_}; }

    /// What the line is about: the first letter of its first word, in upper case, which is read.
    char card();

    bool has_more() const { return next_ < words_.size(); }
    std::string_view word(const char* what);
    int whole_number(const char* what);
    double number(const char* what);
    /// The same from this line or one of the next.
    double number_further_on(const char* what);
    /// A number that counts for `quantum`.
    double coordinate(const char* what);
    double quantum() const { return quantum_.value(); }  ///< see Scene

  private:
    const InputFile& file_;
    std::string_view rest_;
    std::size_t line_number_ = 0;
    std::vector<std::string_view> words_ = {};
    std::size_t next_ = 0;
    TextQuantum quantum_ = {};
};

}  // namespace hemirad
