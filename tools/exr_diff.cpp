// Compares two OpenEXR files channel by channel.
// Exit code 0: identical, or no pixel differs by more than the tolerance; 1: they differ; 2: error.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr int kSame = 0, kDifferent = 1, kError = 2;

struct Picture {
    int width = 0, height = 0;
    std::map<std::string, std::vector<float>> channels;
};

Picture read(const std::string& path) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    Picture picture{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, {}};
    const auto width = static_cast<std::size_t>(picture.width);
    Imf::FrameBuffer frame;
    const Imf::ChannelList& channels = file.header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        auto& pixels = picture.channels[channel.name()];
        pixels.resize(width * static_cast<std::size_t>(picture.height));
        frame.insert(channel.name(), Imf::Slice::Make(Imf::FLOAT, pixels.data(), window,
                                                      sizeof(float), sizeof(float) * width));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return picture;
}

struct Difference {
    double largest = 0, largest_relative = 0, rms = 0;
    std::size_t differing_count = 0;
};

/// NaN against the same NaN is no difference, against all else an infinite one.
double distance(float a, float b) {
    if (std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b)) return 0.0;
    if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::infinity();
    return std::abs(double{a} - double{b});
}

double relative(double difference, float a, float b) {
    const double scale = std::max(std::abs(double{a}), std::abs(double{b}));
    return std::isfinite(difference) && scale > 0.0 ? difference / scale : difference;
}

Difference compare(const std::vector<float>& a, const std::vector<float>& b) {
    Difference result;
    double squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = distance(a[i], b[i]);
        if (difference == 0.0) continue;
        ++result.differing_count;
        squares += difference * difference;
        result.largest = std::max(result.largest, difference);
        result.largest_relative =
            std::max(result.largest_relative, relative(difference, a[i], b[i]));
    }
    result.rms = a.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(a.size()));
    return result;
}

void require_same_shape(const Picture& a, const Picture& b) {
    if (a.width != b.width || a.height != b.height) {
        throw std::runtime_error("sizes differ: " + std::to_string(a.width) + " x " +
                                 std::to_string(a.height) + " and " + std::to_string(b.width) +
                                 " x " + std::to_string(b.height));
    }
    for (const auto& [name, pixels] : a.channels) {
        if (!b.channels.contains(name)) throw std::runtime_error("only the first has " + name);
    }
    for (const auto& [name, pixels] : b.channels) {
        if (!a.channels.contains(name)) throw std::runtime_error("only the second has " + name);
    }
}

int report(const Picture& a, const Picture& b, double tolerance) {
    require_same_shape(a, b);
    std::size_t differing_count = 0;
    double largest = 0.0;
    std::printf("%-16s %12s %12s %12s %10s\n", "channel", "max_abs", "max_rel", "rms", "differing");
    for (const auto& [name, pixels] : a.channels) {
        const Difference d = compare(pixels, b.channels.at(name));
        std::printf("%-16s %12.5g %12.5g %12.5g %10zu\n", name.c_str(), d.largest,
                    d.largest_relative, d.rms, d.differing_count);
        differing_count += d.differing_count;
        largest = std::max(largest, d.largest);
    }
    if (differing_count == 0) std::puts("identical");
    return largest <= tolerance ? kSame : kDifferent;
}

struct Arguments {
    std::vector<std::string> files;
    double tolerance = 0.0;
};

Arguments arguments_of(const std::vector<std::string>& words) {
    Arguments arguments;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] != "--tolerance") {
            arguments.files.push_back(words[i]);
            continue;
        }
        if (++i == words.size()) throw std::runtime_error("--tolerance: a number is missing");
        char* end = nullptr;
        arguments.tolerance = std::strtod(words[i].c_str(), &end);
        if (end == words[i].c_str() || *end != '\0' || !(arguments.tolerance >= 0.0)) {
            throw std::runtime_error("--tolerance " + words[i] + ": not a number of at least 0");
        }
    }
    if (arguments.files.size() != 2) {
        throw std::runtime_error("usage: exr_diff A.exr B.exr [--tolerance LARGEST_DIFFERENCE]");
    }
    return arguments;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const Arguments arguments = arguments_of({argv + 1, argv + argc});
        return report(read(arguments.files[0]), read(arguments.files[1]), arguments.tolerance);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "exr_diff: %s\n", error.what());
        return kError;
    }
}
