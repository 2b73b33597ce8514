#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "cli/sweep_plan.h"
#include "mp1map/device.h"
#include "solver/sweep_point.h"

namespace hemirad {

/// What a row of the CSV is of; its first columns, by which a stopped sweep knows it again.
struct SweepRow {
    std::string scene;
    double patch_size = 0;
    std::uint32_t patches = 0, shots = 0;
    PlannedPoint planned;
    mp1map::DeviceSummary device;  ///< of as many compute units as the point asks for
};

/// The settings as CSV, without a line's end. Throws mp1map::NoSuchDevice where the device cannot
/// hold the array.
std::string settings_text(const SweepRow& row);

/// The settings in words, for progress.
std::string title(const SweepRow& row);

/// A CSV that grows a row at a time. What is there already is kept if it is whole.
class SweepCsv {
  public:
    /// Reads what an earlier sweep left; a torn last line is cut off. Throws InputError where the
    /// file is no sweep of this version, OutputError where it cannot be written.
    explicit SweepCsv(const std::filesystem::path& file);

    bool holds(const std::string& settings) const { return settings_.count(settings) != 0; }
    /// `wrong` empty: not asked for. On disk when this returns.
    void append(const std::string& settings, const SweepMeasurement& measured,
                const std::string& wrong_per_million);

  private:
    std::filesystem::path file_;
    std::ofstream out_;
    std::set<std::string> settings_;
};

/// For --smoke: throws std::logic_error unless the file is the header and `rows` different rows,
/// each as long as the header and with numbers where numbers belong.
void check_shape(const std::filesystem::path& file, std::size_t rows);

}  // namespace hemirad
