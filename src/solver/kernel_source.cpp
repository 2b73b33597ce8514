#include "solver/kernel_source.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include "errors.h"
#include "solver/embedded_kernels.h"

namespace hemirad {
namespace {

struct SourceFile {
    std::string path;  ///< as a build log shall name it
    std::string text;
};

std::optional<SourceFile> read_disk(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream || std::filesystem::is_directory(path)) return {};
    return SourceFile{path.string(), {std::istreambuf_iterator<char>(stream), {}}};
}

std::optional<SourceFile> read_embedded(const std::string& path) {
    const auto text = embedded_kernel(path);
    if (text.empty()) return {};
    return SourceFile{path, std::string(text)};
}

std::optional<SourceFile> find_file(const std::string& name,
                                    const std::optional<std::filesystem::path>& kernels_dir) {
    if (!kernels_dir) {
        auto file = read_embedded("kernels/" + name);
        return file ? file : read_embedded("mp1map/" + name);
    }
    if (auto file = read_disk(*kernels_dir / name)) return file;
    if (auto file = read_disk(*kernels_dir / ".." / "mp1map" / name)) return file;
    return read_embedded("mp1map/" + name);
}

/// The name between the quotes of `#include "name"`, without folders; nothing for any other line.
std::optional<std::string> included_name(std::string_view line) {
    const auto skip_blanks = [&line] {
        line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    };
    const auto take = [&](std::string_view word) {
        skip_blanks();
        if (!line.starts_with(word)) return false;
        line.remove_prefix(word.size());
        return true;
    };
    if (!take("#") || !take("include") || !take("\"")) return {};
    const auto path = line.substr(0, line.find('"'));
    return std::string(path.substr(path.find_last_of('/') + 1));
}

class Flattener {
  public:
    explicit Flattener(const std::optional<std::filesystem::path>& kernels_dir)
        : kernels_dir_(kernels_dir) {}

    void append(const std::string& path, std::string_view text) {
        go_to(1, path);
        for (int line_number = 1; !text.empty(); ++line_number) {
            const auto line = text.substr(0, text.find('\n'));
            append_line(line, path, line_number);
            text.remove_prefix(std::min(line.size() + 1, text.size()));
        }
    }

    std::string source() && { return std::move(source_); }

  private:
    void append_line(std::string_view line, const std::string& path, int line_number) {
        if (const auto name = included_name(line)) {
            include(*name, path, line_number);
            go_to(line_number + 1, path);
            return;
        }
        // A file is here once already, and compilers warn of the pragma in what they see as a
        // main file.
        if (!line.starts_with("#pragma once")) source_ += line;
        source_ += '\n';
    }

    void include(const std::string& name, const std::string& from, int line_number) {
        if (!seen_.insert(name).second) return;
        const auto file = find_file(name, kernels_dir_);
        if (!file)
            throw InputError(from + ":" + std::to_string(line_number) + ": include \"" + name +
                             "\": no such file in kernels or mp1map");
        append(file->path, file->text);
    }

    void go_to(int line_number, const std::string& path) {
        source_ += "#line " + std::to_string(line_number) + " \"";
        for (const char c : path) {
            if (c == '"' || c == '\\') source_ += '\\';
            source_ += c;
        }
        source_ += "\"\n";
    }

    std::optional<std::filesystem::path> kernels_dir_;
    std::set<std::string> seen_;
    std::string source_;
};

}  // namespace

std::string kernel_source(std::string_view name,
                          const std::optional<std::filesystem::path>& kernels_dir) {
    const auto file_name = std::string(name) + ".cl";
    const auto file =
        kernels_dir ? read_disk(*kernels_dir / file_name) : read_embedded("kernels/" + file_name);
    if (!file)
        throw InputError((kernels_dir ? (*kernels_dir / file_name).string() : file_name) +
                         ": no such kernel file");
    return resolve_includes(file->text, file->path, kernels_dir);
}

std::string resolve_includes(std::string_view text, std::string_view file,
                             const std::optional<std::filesystem::path>& kernels_dir) {
    Flattener flattener(kernels_dir);
    flattener.append(std::string(file), text);
    return std::move(flattener).source();
}

}  // namespace hemirad
