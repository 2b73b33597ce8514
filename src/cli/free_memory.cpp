#include "cli/free_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

namespace hemirad {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max() / 4;

/// The number behind `name` in a file of the kernel's, or at its beginning; nothing where there is
/// none ("max").
std::optional<std::uint64_t> number_in(const fs::path& file, const std::string& name = "") {
    std::ifstream in(file);
    for (std::string word; word != name && in >> word;) {
    }
    std::uint64_t number = 0;
    return in >> number ? std::optional(number) : std::nullopt;
}

/// What a version of control groups calls what we ask for: Linux's cgroup-v1/memory.txt and
/// cgroup-v2.txt. The numbers of both are with those of the groups within.
struct Names {
    fs::path mount;
    const char *limit, *used, *unused_files;
};

/// One without limit, or where no memory is counted, has no end.
std::uint64_t left_in(const fs::path& group, const Names& names) {
    const auto limit = number_in(group / names.limit);
    if (!limit) return kUnlimited;
    const auto used = number_in(group / names.used).value_or(0);
    const auto unused_files = number_in(group / "memory.stat", names.unused_files).value_or(0);
    const auto held = used - std::min(used, unused_files);
    return *limit - std::min(*limit, held);
}

/// Of `group`, as /proc/self/cgroup says it, and those around it. A container may not see the
/// folders of its group; what is mounted is then that group itself.
std::uint64_t least_left(const fs::path& root, std::string group, const Names& names) {
    std::uint64_t least = left_in(root / names.mount, names);
    // The path of a process outside of its namespace begins with "/..": cgroup_namespaces(7).
    for (fs::path inner = fs::path(std::move(group)).lexically_normal().relative_path();
         !inner.empty(); inner = inner.parent_path())
        least = std::min(least, left_in(root / names.mount / inner, names));
    return least;
}

bool lists_memory(const std::string& controllers) {
    return ("," + controllers + ",").find(",memory,") != std::string::npos;
}

/// A line is ID:CONTROLLERS:PATH, the controllers of version 2 not named: cgroups(7).
std::uint64_t left_in_groups(const fs::path& root) {
    const Names version_1{"sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes",
                          "total_inactive_file"};
    const Names version_2{"sys/fs/cgroup", "memory.max", "memory.current", "inactive_file"};
    std::uint64_t least = kUnlimited;
    std::ifstream groups(root / "proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
        std::istringstream fields(line);
        std::string id, controllers, group;
        std::getline(std::getline(fields, id, ':'), controllers, ':');
        std::getline(fields, group);
        if (lists_memory(controllers)) least = std::min(least, least_left(root, group, version_1));
        if (controllers.empty()) least = std::min(least, least_left(root, group, version_2));
    }
    return least;
}

std::uint64_t left_on_machine(const fs::path& root) {
    const auto kib = number_in(root / "proc/meminfo", "MemAvailable:");
    const auto swap = number_in(root / "proc/meminfo", "SwapFree:").value_or(0);
    return kib ? (*kib + swap) * 1024 : kUnlimited;
}

}  // namespace

std::uint64_t free_memory(const fs::path& root) {
    return std::min(left_on_machine(root), left_in_groups(root));
}

}  // namespace hemirad
