#include "scene/cut_contacts.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <optional>

#include "scene/merge_pieces.h"

namespace hemirad::meshing {
namespace {

/// Of one polygon: a round column of a hundred sides cuts some two hundred.
constexpr std::size_t kMostPieces = 512, kMostContacts = 512;

struct Interval {
    double low, high;
};

// Of one axis, what of the contact lies where low <= its other coordinate <= high.
std::optional<Interval> across(const Contact& contact, int axis, double low, double high) {
    const glm::dvec2 along = contact.to - contact.from;
    double t0 = 0, t1 = 1;
    if (along[axis] != 0) {
        const double a = (low - contact.from[axis]) / along[axis];
        const double b = (high - contact.from[axis]) / along[axis];
        t0 = std::max(t0, std::min(a, b));
        t1 = std::min(t1, std::max(a, b));
    } else if (contact.from[axis] < low || contact.from[axis] > high) {
        return {};
    }
    if (t0 > t1) return {};
    const double begin = contact.from[1 - axis] + t0 * along[1 - axis];
    const double end = contact.from[1 - axis] + t1 * along[1 - axis];
    return Interval{std::min(begin, end), std::max(begin, end)};
}

/// Cells first ... end - 1 along an axis.
struct Cells {
    std::uint32_t first, end;
};

Cells cells_of(const Interval& interval, double size, std::uint32_t count, double slack) {
    const auto cell = [&](double at) {
        return std::clamp(std::floor(at / size), -1.0, 1.0 * count);
    };
    const double first = std::max(0.0, cell(interval.low - slack));
    const double end = std::min(1.0 * count, cell(interval.high + slack) + 1);
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(std::max(first, end))};
}

Line line_of(const Contact& contact) {
    const glm::dvec2 along = (contact.to - contact.from) / contact.length();
    const glm::dvec2 across(-along.y, along.x);
    return {across, 0.5 * glm::dot(across, contact.from + contact.to)};
}

// What of the contact lies within the polygon, deeper than `slack` where it is deepest under each
// edge (Cyrus and Beck 1978).
std::optional<Contact> within(const Polygon& polygon, const Contact& contact, double slack) {
    const auto depths = [&](std::size_t i, const Contact& part) {
        const glm::dvec2& a = polygon[i].at;
        const glm::dvec2 edge = polygon[(i + 1) % polygon.size()].at - a;
        const glm::dvec2 inwards = glm::dvec2(-edge.y, edge.x) / glm::length(edge);
        return std::pair(glm::dot(inwards, part.from - a), glm::dot(inwards, part.to - a));
    };
    Contact part = contact;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto [from, to] = depths(i, part);
        if (std::max(from, to) <= slack) return {};
        const glm::dvec2 crossing = part.from + (part.to - part.from) * (from / (from - to));
        if (from < 0) part.from = crossing;
        if (to < 0) part.to = crossing;
    }
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto [from, to] = depths(i, part);
        if (std::max(from, to) <= slack) return {};
    }
    if (part.length() <= slack) return {};
    return part;
}

/// Cuts a polygon along the lines of contacts, the longest first, and each part along those that
/// reach into it (Fuchs, Kedem and Naylor 1980).
class Partition {
  public:
    Partition(double slack, PolygonSplitter& splitter) : slack_(slack), splitter_(splitter) {}

    /// Whether there were few enough pieces.
    bool cut(Polygon polygon, const std::vector<Contact>& contacts) {
        auto reaching = reaching_into(polygon, contacts);
        while (!reaching.empty()) {
            const auto next = longest(reaching);
            const Contact contact = next->whole;
            reaching.erase(next);
            Halves<Polygon> halves = splitter_.split(polygon, line_of(contact), slack_);
            if (is_thin(halves.below) || is_thin(halves.above)) continue;
            std::vector<Contact> others;
            for (const Reaching& other : reaching) others.push_back(other.whole);
            return cut(std::move(halves.below), others) && cut(std::move(halves.above), others);
        }
        pieces_.push_back(std::move(polygon));
        return pieces_.size() <= kMostPieces;
    }

    std::vector<Polygon> take() { return std::move(pieces_); }

  private:
    struct Reaching {
        Contact whole;
        double length;  ///< of what is within
    };

    std::vector<Reaching> reaching_into(const Polygon& polygon,
                                        const std::vector<Contact>& contacts) const {
        std::vector<Reaching> reaching;
        for (const Contact& contact : contacts)
            if (const auto part = within(polygon, contact, slack_))
                reaching.push_back({contact, part->length()});
        return reaching;
    }
    // The first of equals: rounding does not choose.
    std::vector<Reaching>::iterator longest(std::vector<Reaching>& reaching) const {
        auto best = reaching.begin();
        for (auto it = best + 1; it != reaching.end(); ++it)
            if (it->length > best->length + slack_) best = it;
        return best;
    }
    bool is_thin(const Polygon& polygon) const {
        return polygon.empty() || thickness(polygon) <= slack_;
    }

    double slack_;
    PolygonSplitter& splitter_;
    std::vector<Polygon> pieces_;
};

}  // namespace

ContactGrid::ContactGrid(std::vector<Contact> contacts, const Surface& surface, double slack)
    : contacts_(std::move(contacts)) {
    const glm::dvec2& size = surface.cell_size;
    for (std::uint32_t c = 0; c < contacts_.size(); ++c) {
        const auto [low, high] = std::minmax(contacts_[c].from.y, contacts_[c].to.y);
        const Cells rows = cells_of({low, high}, size.y, surface.rows, slack);
        for (std::uint32_t row = rows.first; row < rows.end; ++row) {
            const auto part =
                across(contacts_[c], 1, row * size.y - slack, (row + 1) * size.y + slack);
            if (!part) continue;
            const Cells columns = cells_of(*part, size.x, surface.columns, slack);
            for (std::uint32_t column = columns.first; column < columns.end; ++column)
                in_cells_.emplace_back(row * surface.columns + column, c);
        }
    }
    std::ranges::sort(in_cells_);
}

std::vector<Contact> ContactGrid::in(std::uint32_t cell) const {
    std::vector<Contact> contacts;
    for (const auto& [at, contact] : std::ranges::equal_range(
             in_cells_, cell, {}, &std::pair<std::uint32_t, std::uint32_t>::first))
        contacts.push_back(contacts_[contact]);
    return contacts;
}

// A patch 10,000 times as long as wide is told of (look_for_slender_patches).
double contact_slack(const Surface& surface, const Precision& precision) {
    constexpr double kLeastWidth = 0x1p-12;
    return std::max(precision.plane,
                    kLeastWidth * std::max(surface.cell_size.x, surface.cell_size.y));
}

std::vector<Polygon> cut_along_contacts(const Polygon& polygon,
                                        const std::vector<Contact>& contacts, double slack,
                                        const Precision& precision, PolygonSplitter& splitter) {
    if (contacts.empty() || contacts.size() > kMostContacts) return {polygon};
    Partition partition(slack, splitter);
    if (!partition.cut(polygon, contacts)) return {polygon};
    std::vector<CellPiece> pieces;
    for (Polygon& piece : partition.take()) pieces.push_back({0, 0, std::move(piece)});
    if (pieces.size() == 1) return {polygon};
    std::vector<Polygon> parts;
    for (MergedPiece& merged :
         merge_pieces(pieces, precision.plane, {.contacts = contacts, .slack = slack}))
        if (merged.polygon.size() > 2) parts.push_back(std::move(merged.polygon));
    return parts;
}

}  // namespace hemirad::meshing
