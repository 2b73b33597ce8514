#include "lightmap/read_exr.h"

#include <cstring>

#include "errors.h"
#include "lightmap/support.h"
#include "lightmap/write_exr.h"

namespace hemirad {
namespace {

class ReadExr : public InFolder {
  protected:
    std::string fault_of(const std::string& bytes) {
        std::ofstream(file("a.exr"), std::ios::binary) << bytes;
        try {
            read_exr(file("a.exr"), {"Y"});
        } catch (const InputError& fault) {
            return fault.what();
        }
        return {};
    }

    std::string small_exr() {
        const std::vector<float> values(16, 0.5f);
        write_exr(file("b.exr"), {4, 4, {"Y"}, {values}, values}, {}, PixelType::half);
        return bytes_of(file("b.exr"));
    }
};

/// Its last texel where the header says it.
void set_last_texel(std::string& exr, std::int32_t x, std::int32_t y) {
    const std::string name("dataWindow\0box2i\0", 17);
    char* const window = exr.data() + exr.find(name) + name.size() + 4;
    std::memcpy(window + 8, &x, sizeof x);
    std::memcpy(window + 12, &y, sizeof y);
}

TEST_F(ReadExr, TakesWhatIsWritten) { EXPECT_EQ(fault_of(small_exr()), ""); }

TEST_F(ReadExr, RefusesMoreTexelsThanItsBytesCanHold) {
    std::string exr = small_exr();
    set_last_texel(exr, 16383, 15);

    EXPECT_EQ(fault_of(exr), file("a.exr").string() +
                                 ": announces 16384 x 16 texels of 2 channels, more than its " +
                                 std::to_string(exr.size()) + " bytes can hold");
}

TEST_F(ReadExr, RefusesAnAttributeOfMoreBytesThanTheFile) {
    std::string exr = small_exr();
    const std::string name("dataWindow\0box2i\0", 17);
    const std::int32_t size = 1 << 30;
    std::memcpy(exr.data() + exr.find(name) + name.size(), &size, sizeof size);

    EXPECT_EQ(fault_of(exr), file("a.exr").string() +
                                 ": attribute \"dataWindow\" announces more bytes than there are");
}

TEST_F(ReadExr, TakesTheDensestLightmap) {
    constexpr std::uint32_t kSide = 4096;
    const std::vector<float> dark(std::size_t{kSide} * kSide);
    write_exr(file("b.exr"), {kSide, kSide, {"Y"}, {dark}, dark}, {}, PixelType::half);

    EXPECT_EQ(fault_of(bytes_of(file("b.exr"))), "");
}

}  // namespace
}  // namespace hemirad
