#include "lightmap/png.h"

#include <cstdlib>
#include <limits>
#include <memory>
#include <new>

#include "lightmap/deflate.h"

namespace hemirad {
namespace {

// stb asks for memory and does not look whether there was any.
void* reallocated(void* memory, std::size_t bytes) {
    void* const result = std::realloc(memory, bytes);
    if (result == nullptr) throw std::bad_alloc();
    return result;
}

}  // namespace
}  // namespace hemirad

#define STBIW_MALLOC(bytes) hemirad::reallocated(nullptr, bytes)
#define STBIW_REALLOC(memory, bytes) hemirad::reallocated(memory, bytes)
#define STBIW_FREE(memory) std::free(memory)
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace hemirad {
namespace {

void append(void* stream, void* bytes, int count) {
    static_cast<std::ostream*>(stream)->write(static_cast<const char*>(bytes), count);
}

}  // namespace

void write_png(std::ostream& stream, const Picture& picture) {
    const int channel_count = static_cast<int>(picture.channel_count);
    const int width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
    const int done = stbi_write_png_to_func(append, &stream, width, height, channel_count,
                                            picture.pixels.data(), width * channel_count);
    if (done == 0) throw std::bad_alloc();
}

std::string deflated(std::string_view bytes) {
    constexpr int kQuality = 8;  // as stb's own PNGs
    if (bytes.size() > std::size_t{std::numeric_limits<int>::max()}) throw std::bad_alloc();
    std::string copy(bytes);  // stb takes no const
    int size = 0;
    const std::unique_ptr<unsigned char, void (*)(void*)> stream(
        stbi_zlib_compress(reinterpret_cast<unsigned char*>(copy.data()),
                           static_cast<int>(copy.size()), &size, kQuality),
        std::free);
    if (!stream) throw std::bad_alloc();
    return {reinterpret_cast<const char*>(stream.get()), static_cast<std::size_t>(size)};
}

}  // namespace hemirad
