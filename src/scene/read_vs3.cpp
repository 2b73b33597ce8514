#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <map>
#include <numbers>
#include <set>
#include <sstream>
#include <string>

#include "scene/cut_out.h"
#include "scene/input_file.h"
#include "scene/vs3_fields.h"

/// As the View3D user manual has it (G. N. Walton: Calculation of obstructed view factors by
/// adaptive integration, NISTIR 6925).
namespace hemirad {
namespace {

struct Vs3Surface {
    char card = 'S';  ///< S radiates, O obstructs, N leaves a hole in its base
    InputLine place;
    Outline corners = {};
    int base = 0, combined_with = 0;  ///< surfaces, from 1; 0: none
    double emittance = 0;
    std::string name = {};
};

struct Vs3File {
    const InputFile& file;
    Scene scene = {};
    std::vector<glm::dvec3> vertices = {};
    std::vector<Vs3Surface> surfaces = {};
    std::map<double, std::uint32_t> material_of_emittance = {};
    std::set<std::string> names = {};
};

constexpr std::array<std::string_view, 12> kControls{"eps",  "list", "out", "encl", "emit", "maxu",
                                                     "maxo", "mino", "row", "col",  "prjd", "maxv"};

std::string named(const char* what, int number) { return what + (' ' + std::to_string(number)); }

enum class Format { none, vertices, blast };  ///< F 3 and F 3a

Format read_format(Vs3Fields& fields) {
    const std::string_view format = fields.word("format");
    if (format == "3") return Format::vertices;
    if (format == "3a" || format == "3A") return Format::blast;
    fields.place().fail("format " + in_quotes(format) + " is neither 3 nor 3a");
}

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

/// `eps=1e-4, list 2`: names and values.
std::vector<std::string> control_words(Vs3Fields& fields) {
    std::vector<std::string> words;
    while (fields.has_more()) {
        std::string text(fields.word("control"));
        std::ranges::replace(text, '=', ' ');
        std::istringstream parts(text);
        for (std::string part; parts >> part;) words.push_back(lower_case(part));
    }
    return words;
}

/// Warns of what asks for other numbers than the factors; the rest steers View3D's integration.
void read_controls(Vs3File& vs3, Vs3Fields& fields) {
    const auto words = control_words(fields);
    const std::string line = named("line", int(fields.place().number));
    for (std::size_t i = 0; i < words.size(); i += 2) {
        const std::string& name = words[i];
        if (std::ranges::find(kControls, name) == kControls.end())
            fields.place().fail("control " + in_quotes(name) + " is not known");
        const double value = read_number<double>(
            fields.place(), i + 1 < words.size() ? std::string_view(words[i + 1]) : "");
        if (value != 0 && (name == "emit" || name == "row" || name == "col"))
            warn(vs3.scene, line, "control " + in_quotes(name) + " is not followed");
    }
}

void read_vertex(Vs3File& vs3, Vs3Fields& fields) {
    const int number = fields.whole_number("vertex number");
    if (number != int(vs3.vertices.size()) + 1)
        fields.place().fail(named("vertex", number) + " is out of sequence");
    const double x = fields.coordinate("x"), y = fields.coordinate("y"), z = fields.coordinate("z");
    vs3.vertices.emplace_back(x, y, z);
}

Outline read_corners(const Vs3File& vs3, Vs3Fields& fields) {
    Outline corners;
    for (int i = 0; i < 4; ++i) {
        const int vertex = fields.whole_number("vertex");
        if (i == 3 && vertex == 0) break;
        if (vertex < 1 || vertex > int(vs3.vertices.size()))
            fields.place().fail(named("vertex", vertex) +
                                " is out of range, the lines above hold " +
                                std::to_string(vs3.vertices.size()));
        corners.push_back(vs3.vertices[std::size_t(vertex) - 1]);
    }
    return corners;
}

/// Exact at multiples of 90, so that corners of upright walls meet.
double sine_of_degrees(double angle) {
    const double turn = std::remainder(angle, 360);
    if (std::remainder(turn, 180) == 0) return 0;
    if (std::abs(turn) == 90) return turn / 90;
    return std::sin(turn * std::numbers::pi / 180);
}

double cosine_of_degrees(double angle) { return sine_of_degrees(angle + 90); }

std::size_t corner_count(char shape) { return shape == 'T' ? 3 : 4; }

/// In the plane of a BLAST surface, from its lower left corner.
std::vector<glm::dvec2> read_shape(char shape, Vs3Fields& fields) {
    if (shape == 'R') {
        const double width = fields.number_further_on("width");
        const double height = fields.number_further_on("height");
        return {{0, height}, {0, 0}, {width, 0}, {width, height}};
    }
    std::vector<glm::dvec2> corners(corner_count(shape));
    for (auto& corner : corners) {
        corner.x = fields.number_further_on("x");
        corner.y = fields.number_further_on("y");
    }
    return corners;
}

/// The plane stands on the lines after the card: origin, azimuth clockwise from north (y) and tilt
/// from facing up.
Outline read_blast_corners(char shape, Vs3Fields& fields) {
    if (!fields.next_line()) fields.place().fail("the surface's plane is missing");
    glm::dvec3 origin;
    for (int axis = 0; axis < 3; ++axis) origin[axis] = fields.number_further_on("origin");
    const double azimuth = fields.number_further_on("azimuth");
    const double tilt = fields.number_further_on("tilt");
    const double sin_azimuth = sine_of_degrees(azimuth), cos_azimuth = cosine_of_degrees(azimuth);
    const glm::dvec3 right(-cos_azimuth, sin_azimuth, 0);
    const double run = -cosine_of_degrees(tilt);
    const glm::dvec3 up(run * sin_azimuth, run * cos_azimuth, sine_of_degrees(tilt));
    Outline corners;
    for (const auto& at : read_shape(shape, fields))
        corners.push_back(origin + at.x * right + at.y * up);
    return corners;
}

char read_shape_letter(Vs3Fields& fields) {
    const std::string_view word = fields.word("shape");
    const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
    if (letter != 'R' && letter != 'Q' && letter != 'T')
        fields.place().fail("shape " + in_quotes(word) + " is none of R, Q and T");
    return letter;
}

void read_properties(Vs3File& vs3, Vs3Fields& fields, Vs3Surface& surface) {
    surface.base = fields.whole_number("base surface");
    surface.combined_with = fields.whole_number("surface to combine with");
    surface.emittance = fields.number("emittance");
    if (surface.emittance < 0 || surface.emittance > 1)
        fields.place().fail("emittance " + number(surface.emittance) + " is not within 0 and 1");
    const std::string_view name = fields.word("name");
    check_name(vs3.file, "surface", name);
    surface.name = printable(name);
    if (fields.has_more())
        warn(vs3.scene, named("line", int(fields.place().number)),
             in_quotes(fields.word("rest")) + " is not read: names hold no blanks");
}

void check_sequence(const Vs3File& vs3, const Vs3Surface& surface, int number) {
    if (number != int(vs3.surfaces.size()) + 1)
        surface.place.fail(named("surface", number) + " is out of sequence");
    if (surface.card != 'O' && !vs3.surfaces.empty() && vs3.surfaces.back().card == 'O')
        surface.place.fail(named("surface", number) + " must stand before the obstructions");
}

void read_surface(Vs3File& vs3, Vs3Fields& fields, char card, Format format) {
    Vs3Surface surface{.card = card, .place = fields.place()};
    if (format == Format::none) surface.place.fail("an F line must stand before the surfaces");
    check_sequence(vs3, surface, fields.whole_number("surface number"));
    const char shape = format == Format::blast ? read_shape_letter(fields) : 'Q';
    if (format == Format::vertices) surface.corners = read_corners(vs3, fields);
    if (card != 'O') read_properties(vs3, fields, surface);
    if (format == Format::blast) surface.corners = read_blast_corners(shape, fields);
    vs3.surfaces.push_back(std::move(surface));
}

void read_cards(Vs3File& vs3) {
    Vs3Fields fields(vs3.file);
    Format format = Format::none;
    bool any_blast = false;  // whose corners are computed from angles
    while (fields.next_line()) {
        const char card = fields.card();
        if (card == 'F' || card == 'G')
            format = read_format(fields), any_blast |= format == Format::blast;
        else if (card == 'C')
            read_controls(vs3, fields);
        else if (card == 'V')
            read_vertex(vs3, fields);
        else if (card == 'S' || card == 'O' || card == 'N')
            read_surface(vs3, fields, card, format);
        else if (card == 'M')
            fields.place().fail("masking surfaces (M) are not read");
        else if (card == 'X')
            fields.place().fail("coordinate transformations (X) are not read");
        else if (card != 'T')
            fields.place().fail("begins with none of T, C, F, V, S, N, O and E");
    }
    if (!any_blast) vs3.scene.quantum = fields.quantum();
}

/// Files repeat a corner of a triangle, or leave the fourth out.
Outline without_repeats(const Outline& corners) {
    Outline distinct;
    for (const glm::dvec3& corner : corners)
        if (distinct.empty() || distinct.back() != corner) distinct.push_back(corner);
    if (distinct.size() > 1 && distinct.front() == distinct.back()) distinct.pop_back();
    return distinct;
}

void check_corners(Vs3Surface& surface) {
    surface.corners = without_repeats(surface.corners);
    if (surface.corners.size() < 3 || doubled_area(surface.corners) == glm::dvec3{})
        surface.place.fail("the surface has no area");
}

/// Only an obstruction may follow what lies on it.
void check_base(const Vs3File& vs3, const Vs3Surface& surface) {
    const int number = int(&surface - vs3.surfaces.data()) + 1, base = surface.base;
    const bool exists = base >= 0 && base <= int(vs3.surfaces.size());
    if (!exists || (base >= number && vs3.surfaces[std::size_t(base) - 1].card != 'O'))
        surface.place.fail(named("base surface", base) + " does not stand before");
    if (base == 0 && surface.card == 'N') surface.place.fail("a null surface needs a base surface");
}

void check_combination(const Vs3File& vs3, const Vs3Surface& surface) {
    const int number = int(&surface - vs3.surfaces.data()) + 1, other = surface.combined_with;
    if (other == 0) return;
    if (other < 0 || other >= number)
        surface.place.fail(named("surface", other) + " to combine with does not stand before");
    const Vs3Surface& first = vs3.surfaces[std::size_t(other) - 1];
    if (surface.card != 'S' || first.card != 'S')
        surface.place.fail("null surfaces are not combined");
    if (first.combined_with != 0)
        surface.place.fail(named("surface", other) + " is itself combined with another");
}

/// The hole that a subsurface makes in its base, facing as the base does.
Outline hole_in(const Vs3Surface& base, const Vs3Surface& surface) {
    Outline hole = surface.corners;
    if (surface.card == 'N') std::ranges::reverse(hole);
    if (!is_in_plane_of(base.corners, hole))
        surface.place.fail("does not lie in the plane of its base surface");
    if (glm::dot(doubled_area(base.corners), doubled_area(hole)) < 0)
        surface.place.fail(surface.card == 'N' ? "must face its base surface"
                                               : "must face as its base surface does");
    if (!encloses(base.corners, hole)) surface.place.fail("reaches beyond its base surface");
    return hole;
}

std::vector<std::vector<Outline>> holes_of(const Vs3File& vs3) {
    std::vector<std::vector<Outline>> holes(vs3.surfaces.size());
    for (const Vs3Surface& surface : vs3.surfaces) {
        if (surface.base == 0) continue;
        const auto base = std::size_t(surface.base) - 1;
        holes[base].push_back(hole_in(vs3.surfaces[base], surface));
    }
    return holes;
}

std::uint32_t material_index(Vs3File& vs3, double emittance) {
    auto& materials = vs3.scene.materials;
    const auto next = static_cast<std::uint32_t>(materials.size());
    const auto [entry, is_new] = vs3.material_of_emittance.try_emplace(emittance, next);
    if (is_new) materials.push_back({"emittance " + number(emittance), {1 - emittance}, {0}});
    return entry->second;
}

/// Of its own, or that of the surface it is combined with. A name that another has gets the
/// surface's number.
std::uint32_t object_index(Vs3File& vs3, std::size_t index,
                           const std::vector<std::uint32_t>& object_of_surface) {
    const Vs3Surface& surface = vs3.surfaces[index];
    if (surface.combined_with > 0) return object_of_surface[std::size_t(surface.combined_with) - 1];
    std::string name = surface.card == 'O' ? "obstruction" : surface.name;
    const bool is_taken = !vs3.names.insert(name).second;
    if (is_taken || surface.card == 'O') name += '#' + std::to_string(index + 1);
    auto& objects = vs3.scene.objects;
    const auto object = static_cast<std::uint32_t>(objects.size());
    objects.push_back(name);
    if (surface.card == 'O') vs3.scene.obstructions.push_back(object);
    return object;
}

void add_face(Scene& scene, const Outline& corners, std::uint32_t material, std::uint32_t object) {
    Face face{{}, material, object};
    for (const glm::dvec3& corner : corners) {
        face.vertices.push_back(static_cast<std::uint32_t>(scene.positions.size()));
        scene.positions.push_back(corner);
    }
    scene.faces.push_back(std::move(face));
}

void add_faces(Vs3File& vs3) {
    const auto holes = holes_of(vs3);
    std::vector<std::uint32_t> object_of_surface;
    for (std::size_t i = 0; i < vs3.surfaces.size(); ++i) {
        const Vs3Surface& surface = vs3.surfaces[i];
        if (surface.card == 'N') {
            object_of_surface.push_back(0);  // nobody is combined with it
            continue;
        }
        object_of_surface.push_back(object_index(vs3, i, object_of_surface));
        const auto material = material_index(vs3, surface.card == 'O' ? 1 : surface.emittance);
        for (const Outline& piece : cut_out(surface.corners, holes[i]))
            add_face(vs3.scene, piece, material, object_of_surface.back());
    }
}

}  // namespace

Scene read_vs3(const InputFile& file) {
    Vs3File vs3{file};
    vs3.scene.file = file.name;
    vs3.scene.bands = {"grey"};
    read_cards(vs3);
    for (Vs3Surface& surface : vs3.surfaces) {
        check_corners(surface);
        check_base(vs3, surface);
        check_combination(vs3, surface);
    }
    add_faces(vs3);
    return std::move(vs3.scene);
}

}  // namespace hemirad
