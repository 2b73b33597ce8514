#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scene/input_file.h"
#include "scene/quantum.h"

namespace hemirad {

/// The numbers of an OBJ file. tinyobjloader takes what is no number for 0 and sums decimals digit
/// by digit; so it reads the structure, and every number is read and checked here, to the last bit.
struct ObjNumbers {
    std::vector<glm::dvec3> positions;
    std::vector<TextQuantum> quanta;      ///< of each position
    std::vector<std::size_t> face_lines;  ///< line of each `f`, from 1
    std::vector<std::string> libraries;   ///< what each `mtllib` names
};

/// Without what begins with a blank and `#`.
std::string_view without_comment(std::string_view line);

/// Line ends become \n, lines that end in a backslash are joined; line numbers stay. Without byte
/// order mark, blanks before lines and comments behind numbers.
std::string unfold_lines(const std::string& bytes);

ObjNumbers read_obj_numbers(const InputFile& file, const std::string& text);

/// The same text with three numbers in each Kd and Ke: one stands for all. Throws InputError where
/// they are others.
std::string spell_out_colours(const InputFile& file, const std::string& text);

}  // namespace hemirad
