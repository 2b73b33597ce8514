#include "lightmap/read_exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cmath>

#include "errors.h"
#include "lightmap/exr_header.h"
#include "scene/input_file.h"
#include "scene/printable.h"

namespace hemirad {
namespace {

constexpr std::string_view kOwn = "hemirad.";

using Values = std::vector<float>;

struct Request {
    std::string channel;
    Values* values;
};

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
    throw InputError(printable(path.string()) + ": " + printable(reason));
}

/// A layer is what stands before ".BAND" of every band.
std::vector<std::string> layers_in(const Imf::ChannelList& channels,
                                   const std::vector<std::string>& bands) {
    const std::string ending = "." + bands[0];
    std::vector<std::string> layers;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        const std::string name = channel.name();
        if (!name.ends_with(ending) || std::ranges::count(bands, name) > 0) continue;
        const std::string layer = name.substr(0, name.size() - ending.size());
        if (std::ranges::all_of(bands, [&](const auto& band) {
                return channels.findChannel(layer + "." + band) != nullptr;
            }))
            layers.push_back(layer);
    }
    return layers;
}

/// Rooms for all channels that are wanted.
std::vector<Request> requests_of(const std::filesystem::path& path, const Imf::Header& header,
                                 Lightmap& lightmap) {
    std::vector<Request> requests;
    const auto add = [&](const std::string& channel, Values& values) {
        if (header.channels().findChannel(channel) == nullptr)
            fail(path, "has no channel \"" + channel + "\", a band of the scene");
        values.resize(lightmap.texel_count());
        requests.push_back({channel, &values});
    };
    lightmap.values.resize(lightmap.bands.size());
    for (std::size_t i = 0; i < lightmap.bands.size(); ++i)
        add(lightmap.bands[i], lightmap.values[i]);
    for (const std::string& layer : layers_in(header.channels(), lightmap.bands)) {
        auto& values = lightmap.layers[layer].values;
        values.resize(lightmap.bands.size());
        for (std::size_t i = 0; i < lightmap.bands.size(); ++i)
            add(layer + "." + lightmap.bands[i], values[i]);
    }
    lightmap.coverage.assign(lightmap.texel_count(), 1.0f);
    if (header.channels().findChannel("coverage") != nullptr) add("coverage", lightmap.coverage);
    return requests;
}

/// The sides are checked.
void set_size(const Imf::Header& header, Lightmap& lightmap) {
    const auto window = header.dataWindow();
    lightmap.width = static_cast<std::uint32_t>(window.max.x - window.min.x + 1);
    lightmap.height = static_cast<std::uint32_t>(window.max.y - window.min.y + 1);
}

void read_pixels(Imf::InputFile& file, Lightmap& lightmap, const std::vector<Request>& requests) {
    const auto window = file.header().dataWindow();
    const std::size_t row = sizeof(float) * lightmap.width;
    Imf::FrameBuffer buffer;
    for (const auto& [channel, values] : requests) {
        char* const origin = reinterpret_cast<char*>(values->data()) -
                             std::ptrdiff_t{window.min.x} * std::ptrdiff_t{sizeof(float)} -
                             std::ptrdiff_t{window.min.y} * static_cast<std::ptrdiff_t>(row);
        buffer.insert(channel, Imf::Slice(Imf::FLOAT, origin, sizeof(float), row));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
}

void require_finite(const std::filesystem::path& path, const std::vector<Request>& requests) {
    for (const auto& [channel, values] : requests)
        if (!std::ranges::all_of(*values, [](float v) { return std::isfinite(v); }))
            fail(path, "channel \"" + channel + "\" holds what is no number");
}

std::map<std::string, std::string> texts_in(const Imf::Header& header) {
    std::map<std::string, std::string> texts;
    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
        const std::string name = attribute.name();
        const auto* const text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
        if (text != nullptr && name.starts_with(kOwn))
            texts[name.substr(kOwn.size())] = text->value();
    }
    return texts;
}

}  // namespace

ExrLightmap read_exr(const std::filesystem::path& path, const std::vector<std::string>& bands) {
    if (!std::filesystem::is_regular_file(status_of(path))) fail(path, "no such file");
    check_exr_headers(path);
    try {
        Imf::InputFile file(path.c_str(), 0);
        ExrLightmap exr{{0, 0, bands, {}, {}}, texts_in(file.header())};
        set_size(file.header(), exr.lightmap);
        const auto requests = requests_of(path, file.header(), exr.lightmap);
        read_pixels(file, exr.lightmap, requests);
        require_finite(path, requests);
        return exr;
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail(path, error.what());
    }
}

}  // namespace hemirad
