#include "lightmap/read_exr.h"

#include "errors.h"
#include "lightmap/exr_header.h"
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

constexpr std::size_t kFirstAttribute = 8;

std::string bytes_of_number(std::uint32_t number) {
    return {reinterpret_cast<const char*>(&number), sizeof number};
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value,
                      std::size_t size) {
    return name + '\0' + type + '\0' + bytes_of_number(std::uint32_t(size)) + value;
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return attribute(name, type, value, value.size());
}

void put_in(std::string& exr, const std::string& attribute) {
    exr.insert(kFirstAttribute, attribute);
}

/// Where the size of the attribute stands.
std::size_t size_of(const std::string& exr, const std::string& name, const std::string& type) {
    const std::string start = name + '\0' + type + '\0';
    return exr.find(start) + start.size();
}

void set_number(std::string& exr, std::size_t at, std::uint32_t number) {
    exr.replace(at, sizeof number, bytes_of_number(number));
}

/// Its last texel where the header says it.
void set_last_texel(std::string& exr, std::int32_t x, std::int32_t y) {
    const auto window = size_of(exr, "dataWindow", "box2i") + 4;
    set_number(exr, window + 8, std::uint32_t(x));
    set_number(exr, window + 12, std::uint32_t(y));
}

TEST_F(ReadExr, TakesWhatIsWritten) { EXPECT_EQ(fault_of(small_exr()), ""); }

/// tools/make-corpus has them of one picture.
TEST_F(ReadExr, TakesWhatOtherProgramsWrite) {
    const auto green = [](const std::string& kind) {
        const auto file = std::filesystem::path(HEMI_CORPUS) / "exr" / (kind + ".exr");
        return read_exr(file, {"G"}).lightmap.values[0];
    };
    const auto picture = green("half");

    for (const char* kind : {"none", "rle", "piz", "pxr24", "mipmap", "ripmap", "parts"})
        EXPECT_EQ(green(kind), picture) << kind;
    for (const char* kind : {"b44", "dwaa", "dwab"}) {
        const auto nearly = green(kind);
        for (std::size_t i = 0; i < picture.size(); ++i)
            EXPECT_NEAR(nearly[i], picture[i], 0.05) << kind;
    }
}

TEST_F(ReadExr, RefusesMoreTexelsThanItsBytesCanHold) {
    std::string exr = small_exr();
    set_last_texel(exr, 16383, 15);

    EXPECT_EQ(fault_of(exr), file("a.exr").string() +
                                 ": announces 16384 x 16 texels of 2 channels, more than its " +
                                 std::to_string(exr.size()) + " bytes can hold");
}

TEST_F(ReadExr, TakesAttributesOfEverySizedType) {
    std::string exr = small_exr();
    put_in(exr, attribute("p", "preview", bytes_of_number(1) + bytes_of_number(2) + "12345678"));
    put_in(exr, attribute("s", "stringvector", bytes_of_number(2) + "ab" + bytes_of_number(0)));
    put_in(exr, attribute("f", "floatvector", std::string(12, '\0')));
    put_in(exr, attribute("m", "m33f", std::string(36, '\0')));
    put_in(exr, attribute("u", "unknown", "what it likes"));
    std::ofstream(file("a.exr"), std::ios::binary) << exr;

    EXPECT_NO_THROW(check_exr_headers(file("a.exr")));
}

struct BadHeader {
    const char* name;
    void (*spoil)(std::string& exr);
    const char* reason;
};

class Headers : public ReadExr, public testing::WithParamInterface<BadHeader> {};

TEST_P(Headers, AreRefusedBeforeRoomIsMade) {
    std::string exr = small_exr();
    GetParam().spoil(exr);

    EXPECT_EQ(fault_of(exr), file("a.exr").string() + ": " + GetParam().reason);
}

const BadHeader kBadHeaders[] = {
    {"OfAnotherFormat", [](std::string& exr) { exr[0] = 'P'; }, "is no OpenEXR file"},
    {"BrokenOff", [](std::string& exr) { exr.resize(exr.find("dataWindow") + 5); },
     "its header breaks off, or a name in it has more than 255 bytes"},
    {"OfALongName",
     [](std::string& exr) { put_in(exr, attribute(std::string(256, 'n'), "int", "1234")); },
     "its header breaks off, or a name in it has more than 255 bytes"},
    {"OfMoreBytesThanTheFile",
     [](std::string& exr) { set_number(exr, size_of(exr, "dataWindow", "box2i"), 1u << 30); },
     "attribute \"dataWindow\" announces more bytes than there are"},
    {"OfAFixedSizeThatIsAnother",
     [](std::string& exr) { put_in(exr, attribute("a", "m44f", std::string(63, '\0'))); },
     "attribute \"a\": its 63 bytes are no \"m44f\""},
    {"OfChannelsBeyondTheirSize",
     [](std::string& exr) {
         const auto size = size_of(exr, "channels", "chlist");
         set_number(exr, size, std::uint32_t(std::uint8_t(exr[size])) - 1);
     },
     "attribute \"channels\": its 43 bytes are no \"chlist\""},
    {"OfChannelsThatEndBefore",
     [](std::string& exr) { exr[size_of(exr, "channels", "chlist") + 4] = '\0'; },
     "attribute \"channels\": its 44 bytes are no \"chlist\""},
    {"OfAPreviewThatIsLarger",
     [](std::string& exr) {
         put_in(exr, attribute("preview", "preview",
                               bytes_of_number(20000) + bytes_of_number(20000) + "1234"));
     },
     "attribute \"preview\": its 12 bytes are no \"preview\""},
    {"OfTextsBeyondTheirSize",
     [](std::string& exr) {
         put_in(exr, attribute("a", "stringvector", bytes_of_number(1u << 30) + "text"));
     },
     "attribute \"a\": its 8 bytes are no \"stringvector\""},
    {"OfNumbersCutShort",
     [](std::string& exr) { put_in(exr, attribute("a", "floatvector", "12345")); },
     "attribute \"a\": its 5 bytes are no \"floatvector\""},
    {"OfAnAttributeTwice",
     [](std::string& exr) {
         put_in(exr, attribute("a", "int", "1234") + attribute("a", "int", "1234"));
     },
     "attribute \"a\" is there twice"},
    {"OfADeepImage", [](std::string& exr) { exr[5] = 0x8; }, "is a deep image, no lightmap"},
    {"OfADeepPart",
     [](std::string& exr) { put_in(exr, attribute("type", "string", "deepscanline")); },
     "is a deep image, no lightmap"},
    {"OfNoSize", [](std::string& exr) { set_last_texel(exr, -1, 3); },
     "is 0 x 4 texels, a lightmap is at most 16384 a side"},
    {"OfASideThatIsTooLong", [](std::string& exr) { set_last_texel(exr, 3, 16384); },
     "is 4 x 16385 texels, a lightmap is at most 16384 a side"},
    {"OfWideTiles",
     [](std::string& exr) {
         put_in(exr, attribute("tiles", "tiledesc",
                               bytes_of_number(1u << 31) + bytes_of_number(1) + '\0'));
     },
     "is in tiles of 2147483648 x 1 texels, more than 16384 a side"},
    {"OfLargeTiles",
     [](std::string& exr) {
         put_in(exr, attribute("tiles", "tiledesc",
                               bytes_of_number(16384) + bytes_of_number(2049) + '\0'));
     },
     "announces tiles or groups of lines of 67141632 numbers, more than it holds in all"},
    {"OfASecondPart",
     [](std::string& exr) {
         exr[5] = 0x10;
         put_in(exr, std::string(attribute("channels", "chlist", std::string(1, '\0'))) +
                         attribute("dataWindow", "box2i", std::string(16, '\0')) + '\0' +
                         attribute("a", "int", "12345"));
     },
     "attribute \"a\": its 5 bytes are no \"int\""},
};

INSTANTIATE_TEST_SUITE_P(ReadExr, Headers, testing::ValuesIn(kBadHeaders),
                         [](const auto& header) { return std::string(header.param.name); });

TEST_F(ReadExr, TakesTheDensestLightmap) {
    constexpr std::uint32_t kSide = 4096;
    const std::vector<float> dark(std::size_t{kSide} * kSide);
    write_exr(file("b.exr"), {kSide, kSide, {"Y"}, {dark}, dark}, {}, PixelType::half);

    EXPECT_EQ(fault_of(bytes_of(file("b.exr"))), "");
}

}  // namespace
}  // namespace hemirad
