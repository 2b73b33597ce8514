#include "formfactor/write_factors.h"

#include <algorithm>
#include <string>

#include "scene/csv.h"

namespace hemirad {
namespace {

void write_pair(std::ostream& out, const std::string& from, const std::string& to, double value) {
    out << from << ',' << to << ',' << decimal(value) << '\n';
}

std::vector<std::string> csv_names(const FactorSurfaces& surfaces) {
    std::vector<std::string> names;
    for (const auto& name : surfaces.names) names.push_back(csv_field(name));
    return names;
}

/// `out`, `encl`, `emit` and the number of surfaces (View3D user manual); 30 characters wide, as
/// View3D's own reader expects.
std::string view3d_header(int format, const FormFactors& among) {
    const bool is_enclosure = closure_error(among) < 1e-6 &&
                              std::ranges::all_of(among.outside, [](double f) { return f < 1e-6; });
    std::string header = "View3D 3.3.1 " + std::to_string(format) + (is_enclosure ? " 1" : " 0") +
                         " 0 " + std::to_string(among.area.size());
    header.resize(std::max<std::size_t>(header.size(), 30), ' ');
    return header + '\n';
}

void write_line(std::ostream& out, const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) out << (i ? " " : "") << decimal(values[i]);
    out << '\n';
}

std::vector<double> listed_emittances(const FactorSurfaces& surfaces) {
    std::vector<double> emittance;
    for (std::size_t s = 0; s < surfaces.size(); ++s)
        if (surfaces.as_from[s] && surfaces.as_to[s]) emittance.push_back(surfaces.emittance[s]);
    return emittance;
}

}  // namespace

void write_factors_csv(std::ostream& out, const FormFactors& factors,
                       const FactorSurfaces& surfaces, bool every_pair) {
    const auto names = csv_names(surfaces);
    out << "from,to,form_factor\n";
    for (std::size_t row = 0; row < factors.from.size(); ++row) {
        const auto from = factors.from[row];
        if (!surfaces.as_from[from]) continue;
        auto next = factors.rows[row].begin();
        for (std::uint32_t to = 0; to < surfaces.size(); ++to) {
            const bool is_there = next != factors.rows[row].end() && next->to == to;
            const double value = is_there ? (next++)->value : 0;
            if (surfaces.as_to[to] && (value != 0 || (every_pair && !surfaces.is_back[to])))
                write_pair(out, names[from], names[to], value);
        }
    }
    for (std::size_t row = 0; row < factors.from.size(); ++row)
        if (surfaces.as_from[factors.from[row]])
            write_pair(out, names[factors.from[row]], "outside", factors.outside[row]);
}

void write_view3d(std::ostream& out, const FormFactors& factors, const FactorSurfaces& surfaces) {
    const FormFactors among = among_listed(factors, surfaces);
    out << view3d_header(0, among);
    write_line(out, among.area);
    std::vector<double> values(among.area.size());
    for (const auto& row : among.rows) {
        std::ranges::fill(values, 0);
        for (const FormFactor& f : row) values[f.to] = f.value;
        write_line(out, values);
    }
    write_line(out, listed_emittances(surfaces));
}

void write_view3d_sparse(std::ostream& out, const FormFactors& factors,
                         const FactorSurfaces& surfaces) {
    const FormFactors among = among_listed(factors, surfaces);
    out << view3d_header(2, among);
    write_line(out, among.area);
    for (std::size_t row = 0; row < among.rows.size(); ++row)
        for (const FormFactor& f : among.rows[row])
            if (f.value != 0)
                out << among.from[row] + 1 << ' ' << f.to + 1 << ' ' << decimal(f.value) << '\n';
    write_line(out, listed_emittances(surfaces));
}

}  // namespace hemirad
