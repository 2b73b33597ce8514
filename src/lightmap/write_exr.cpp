#include "lightmap/write_exr.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <ios>
#include <new>
#include <set>

#include "errors.h"
#include "lightmap/atomic_file.h"

namespace hemirad {
namespace {

constexpr const char* kCoverage = "coverage";

/// Of channels and attributes: Imf::Name cuts what is longer off.
constexpr std::size_t kLongestName = 255;

/// Single-threaded, so that the order of the lines in the file is always the same.
constexpr int kExrThreads = 0;
/// Of ZIP_COMPRESSION.
constexpr int kLinesInChunk = 16;

class ExrStream : public Imf::OStream {
  public:
    ExrStream(std::ostream& stream, const std::string& name)
        : Imf::OStream(name.c_str()), stream_(stream) {}

    void write(const char bytes[], int count) override {
        stream_.write(bytes, count);
        require_good();
        written_ += static_cast<std::uint64_t>(count);
    }
    /// Does not throw, because ~OutputFile() asks; a stream that cannot tell fails its next write.
    std::uint64_t tellp() override {
        const auto position = stream_.tellp();
        if (position < 0) stream_.setstate(std::ios::badbit);
        return static_cast<std::uint64_t>(position);
    }
    void seekp(std::uint64_t position) override {
        stream_.seekp(static_cast<std::streamoff>(position));
        require_good();
    }

    std::uint64_t written() const { return written_; }  ///< bytes

  private:
    void require_good() const {
        if (!stream_.good()) throw std::ios_base::failure("write failed");
    }
    std::ostream& stream_;
    std::uint64_t written_ = 0;
};

/// Ledger::residual() of the worst band, computed here because the solver's library lies beside
/// this one, not below it.
double largest_residual(const Solution& solution) {
    double largest = 0.0;
    for (const Ledger& band : solution.ledger) {
        if (band.emitted == 0.0) continue;
        const double lost = band.emitted - band.absorbed - band.escaped - band.unshot;
        largest = std::max(largest, std::abs(lost) / band.emitted);
    }
    return largest;
}

struct Channel {
    std::string name;
    const std::vector<float>* values;
    bool exact = false;
};

std::vector<Channel> channels_of(const Lightmap& lightmap) {
    std::vector<Channel> channels;
    for (std::size_t band = 0; band < lightmap.bands.size(); ++band)
        channels.push_back({lightmap.bands[band], &lightmap.values[band]});
    channels.push_back({kCoverage, &lightmap.coverage});
    for (const auto& [name, layer] : lightmap.layers) {
        const auto& components = layer.components.empty() ? lightmap.bands : layer.components;
        for (std::size_t i = 0; i < components.size(); ++i)
            channels.push_back({name + "." + components[i], &layer.values[i], layer.exact});
    }
    return channels;
}

void insert(Imf::Header& header, const Attribute& attribute) {
    const std::string name = "hemirad." + attribute.name;
    if (const auto* text = std::get_if<std::string>(&attribute.value)) {
        header.insert(name, Imf::StringAttribute(*text));
    } else {
        header.insert(name, Imf::DoubleAttribute(std::get<double>(attribute.value)));
    }
}

bool fits_half(const std::vector<float>& values) {
    return std::ranges::all_of(values, [](float value) { return half(value).isFinite(); });
}

Imf::PixelType imf_type(const Channel& channel, PixelType type) {
    const bool as_half = type == PixelType::half && !channel.exact && fits_half(*channel.values);
    return as_half ? Imf::HALF : Imf::FLOAT;
}

Imf::Header header_of(const Lightmap& lightmap, const std::vector<Attribute>& attributes,
                      PixelType type) {
    Imf::Header header(static_cast<int>(lightmap.width), static_cast<int>(lightmap.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const Channel& channel : channels_of(lightmap))
        header.channels().insert(channel.name, Imf::Channel(imf_type(channel, type)));
    for (const Attribute& attribute : attributes) insert(header, attribute);
    for (const auto& [name, layer] : lightmap.layers)
        if (!layer.meaning.empty()) insert(header, {"layer." + name, layer.meaning});
    return header;
}

/// OpenEXR reads from the slices of a file it writes, but takes them as char*.
template <typename T>
Imf::Slice slice_of(const std::vector<T>& texels, std::uint32_t width, Imf::PixelType type) {
    char* first = const_cast<char*>(reinterpret_cast<const char*>(texels.data()));
    return {type, first, sizeof(T), sizeof(T) * width};
}

/// Half channels must outlive the frame buffer that points to them.
struct Frame {
    Imf::FrameBuffer buffer;
    std::vector<std::vector<half>> half_channels;
};

Frame frame_of(const Lightmap& lightmap, PixelType type) {
    Frame frame;
    for (const Channel& channel : channels_of(lightmap)) {
        if (imf_type(channel, type) == Imf::FLOAT) {
            frame.buffer.insert(channel.name,
                                slice_of(*channel.values, lightmap.width, Imf::FLOAT));
            continue;
        }
        frame.half_channels.emplace_back(channel.values->begin(), channel.values->end());
        frame.buffer.insert(channel.name,
                            slice_of(frame.half_channels.back(), lightmap.width, Imf::HALF));
    }
    return frame;
}

/// OpenEXR 3.1 leaves out a chunk that it had no memory to compress, and does not say so.
void write_chunks(Imf::OutputFile& file, const ExrStream& stream, int height) {
    for (int line = 0; line < height; line += kLinesInChunk) {
        const auto before = stream.written();
        file.writePixels(std::min(kLinesInChunk, height - line));
        if (stream.written() == before) throw std::bad_alloc();
    }
}

}  // namespace

std::vector<Attribute> describe(const Solution& solution, Quantity quantity) {
    return {{"quantity", quantity == Quantity::irradiance ? "irradiance" : "radiosity"},
            {"unit", "W/m^2"},
            {"shots", static_cast<double>(solution.shots)},
            {"unshot_fraction", solution.unshot_fraction},
            {"ledger_residual", largest_residual(solution)},
            {"converged", solution.converged ? "true" : "false"}};
}

void require_channel_names(const Lightmap& lightmap) {
    for (const std::string& band : lightmap.bands)
        if (band.empty()) throw InputError("band \"\": an EXR channel needs a name");
    std::set<std::string> taken;
    for (const Channel& channel : channels_of(lightmap)) {
        if (channel.name.size() > kLongestName)
            throw InputError("channel \"" + channel.name.substr(0, 40) +
                             "...\": an EXR takes names of up to 255 bytes");
        if (!taken.insert(channel.name).second)
            throw InputError("band \"" + channel.name +
                             "\": the EXR already has a channel of this name");
    }
}

void write_exr(const std::filesystem::path& path, const Lightmap& lightmap,
               const std::vector<Attribute>& attributes, PixelType type) {
    require_channel_names(lightmap);
    const Imf::Header header = header_of(lightmap, attributes, type);
    const Frame frame = frame_of(lightmap, type);
    write_atomically(path, [&](std::ostream& stream) {
        ExrStream exr_stream(stream, path.string());
        Imf::OutputFile file(exr_stream, header, kExrThreads);
        file.setFrameBuffer(frame.buffer);
        write_chunks(file, exr_stream, static_cast<int>(lightmap.height));
    });
}

}  // namespace hemirad
