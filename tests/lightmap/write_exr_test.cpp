#include "lightmap/write_exr.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <limits>
#include <map>

#include "errors.h"
#include "lightmap/support.h"

namespace hemirad::write_exr_test {
namespace {

class WriteExr : public InFolder {};

const std::vector<std::string> kRgb{"R", "G", "B"};

struct ReadBack {
    Imf::Header header;
    std::map<std::string, std::vector<float>> channels;
};

ReadBack read_back(const std::filesystem::path& path) {
    Imf::InputFile file(path.c_str());
    ReadBack result{file.header(), {}};
    const auto window = file.header().dataWindow();
    const auto width = static_cast<std::size_t>(window.max.x + 1);
    const auto height = static_cast<std::size_t>(window.max.y + 1);
    Imf::FrameBuffer frame;
    for (auto c = file.header().channels().begin(); c != file.header().channels().end(); ++c) {
        auto& values = result.channels[c.name()];
        values.resize(width * height);
        frame.insert(c.name(), Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()),
                                          sizeof(float), sizeof(float) * width));
    }
    file.setFrameBuffer(frame);
    file.readPixels(0, window.max.y);
    return result;
}

std::string text_of(const Imf::Header& header, const std::string& name) {
    return header.typedAttribute<Imf::StringAttribute>("hemirad." + name).value();
}

double number_of(const Imf::Header& header, const std::string& name) {
    return header.typedAttribute<Imf::DoubleAttribute>("hemirad." + name).value();
}

TEST_F(WriteExr, ValuesAndChannelNamesComeBack) {
    const auto lightmap = numbered_lightmap(37, 21, kRgb);

    write_exr(file("a.exr"), lightmap, {});

    const auto read = read_back(file("a.exr"));
    const auto window = read.header.dataWindow();
    EXPECT_EQ(window.max.x, 36);
    EXPECT_EQ(window.max.y, 20);
    ASSERT_EQ(read.channels.size(), 4u);
    EXPECT_EQ(read.channels.at("R"), lightmap.values[0]);
    EXPECT_EQ(read.channels.at("G"), lightmap.values[1]);
    EXPECT_EQ(read.channels.at("B"), lightmap.values[2]);
    EXPECT_EQ(read.channels.at("coverage"), lightmap.coverage);
}

TEST_F(WriteExr, BandsNameTheirChannels) {
    write_exr(file("a.exr"), numbered_lightmap(3, 2, {"450nm", "550nm"}), {});

    const auto read = read_back(file("a.exr"));
    EXPECT_TRUE(read.channels.contains("450nm"));
    EXPECT_TRUE(read.channels.contains("550nm"));
}

TEST_F(WriteExr, LayersHaveTheirBandsBehindTheirName) {
    auto lightmap = numbered_lightmap(5, 4, kRgb);
    lightmap.layers["error"].values = {lightmap.values[2], lightmap.values[0], lightmap.values[1]};
    lightmap.layers["error"].meaning = "error, W/m^2";

    write_exr(file("a.exr"), lightmap, {});

    const auto read = read_back(file("a.exr"));
    EXPECT_EQ(text_of(read.header, "layer.error"), "error, W/m^2");
    ASSERT_EQ(read.channels.size(), 7u);
    EXPECT_EQ(read.channels.at("error.R"), lightmap.values[2]);
    EXPECT_EQ(read.channels.at("error.B"), lightmap.values[1]);
    EXPECT_EQ(read.channels.at("R"), lightmap.values[0]);
}

TEST_F(WriteExr, ABandMayNotTakeALayersName) {
    auto lightmap = numbered_lightmap(3, 2, {"R", "error.R"});
    lightmap.layers["error"].values = lightmap.values;

    EXPECT_THROW(write_exr(file("a.exr"), lightmap, {}), InputError);
}

TEST_F(WriteExr, LayersMayHaveComponentsOfTheirOwnAndKeepAllDigits) {
    auto lightmap = numbered_lightmap(3, 2, {"R"});
    const std::vector<float> exact(6, 1000.0625f);
    lightmap.layers["position"] = {{"X", "Y"}, {exact, lightmap.values[0]}, "", true};

    write_exr(file("a.exr"), lightmap, {}, PixelType::half);

    const auto read = read_back(file("a.exr"));
    ASSERT_EQ(read.channels.size(), 4u);
    EXPECT_EQ(read.channels.at("position.X"), exact);
    EXPECT_EQ(read.channels.at("position.Y"), lightmap.values[0]);
    EXPECT_EQ(read.header.channels()["R"].type, Imf::HALF);
}

TEST_F(WriteExr, ANameThatAnExrWouldCutOffIsRefused) {
    const std::string longest(255, 'x');
    write_exr(file("a.exr"), numbered_lightmap(2, 2, {longest}), {});

    EXPECT_TRUE(read_back(file("a.exr")).channels.contains(longest));
    EXPECT_THROW(write_exr(file("b.exr"), numbered_lightmap(2, 2, {longest + 'x'}), {}),
                 InputError);
}

TEST_F(WriteExr, AttributesComeBack) {
    auto attributes = describe(solution_of({1.0}), Quantity::radiosity);
    attributes.push_back({"scene", "hall.gltf"});
    attributes.push_back({"setting.kernels", ""});
    attributes.push_back({"setting.a_name_longer_than_31_characters", 0.1});

    write_exr(file("a.exr"), numbered_lightmap(3, 2, kRgb), attributes);

    const auto header = read_back(file("a.exr")).header;
    EXPECT_EQ(text_of(header, "quantity"), "radiosity");
    EXPECT_EQ(text_of(header, "unit"), "W/m^2");
    EXPECT_EQ(text_of(header, "converged"), "false");
    EXPECT_EQ(text_of(header, "scene"), "hall.gltf");
    EXPECT_EQ(text_of(header, "setting.kernels"), "");
    EXPECT_EQ(number_of(header, "shots"), 12.0);
    EXPECT_EQ(number_of(header, "unshot_fraction"), 0.09);
    EXPECT_NEAR(number_of(header, "ledger_residual"), 0.01, 1e-12);
    EXPECT_EQ(number_of(header, "setting.a_name_longer_than_31_characters"), 0.1);
}

TEST_F(WriteExr, HalfHoldsRoundedValues) {
    const auto lightmap = numbered_lightmap(5, 4, kRgb);

    write_exr(file("a.exr"), lightmap, {}, PixelType::half);

    const auto read = read_back(file("a.exr"));
    EXPECT_EQ(read.header.channels()["R"].type, Imf::HALF);
    EXPECT_EQ(read.channels.at("B"), lightmap.values[2]);  // multiples of 1/8 below 256 are exact
}

TEST_F(WriteExr, AChannelWithAValueBeyondHalfIsOneOfFloats) {
    auto lightmap = numbered_lightmap(2, 2, kRgb);
    lightmap.values[1][3] = 70000.0f;

    write_exr(file("a.exr"), lightmap, {}, PixelType::half);

    const auto read = read_back(file("a.exr"));
    EXPECT_EQ(read.header.channels()["R"].type, Imf::HALF);
    EXPECT_EQ(read.header.channels()["G"].type, Imf::FLOAT);
    EXPECT_EQ(read.channels.at("G"), lightmap.values[1]);
}

TEST_F(WriteExr, TheSameLightmapGivesTheSameBytes) {
    const auto lightmap = numbered_lightmap(130, 70, kRgb);
    const auto attributes = describe(solution_of({1.0}), Quantity::irradiance);

    write_exr(file("a.exr"), lightmap, attributes);
    write_exr(file("b.exr"), lightmap, attributes);

    EXPECT_FALSE(bytes_of(file("a.exr")).empty());
    EXPECT_EQ(bytes_of(file("a.exr")), bytes_of(file("b.exr")));
}

TEST_F(WriteExr, ABandCannotTakeAnotherChannelsName) {
    EXPECT_THROW(write_exr(file("a.exr"), numbered_lightmap(2, 2, {"coverage"}), {}), InputError);
    EXPECT_THROW(write_exr(file("a.exr"), numbered_lightmap(2, 2, {"R", "R"}), {}), InputError);
    EXPECT_THROW(write_exr(file("a.exr"), numbered_lightmap(2, 2, {""}), {}), InputError);
    EXPECT_TRUE(names_in_folder().empty());
}

TEST_F(WriteExr, AFullDiskIsTold) {
    const auto message = message_of<OutputError>(
        [&] { write_exr("/dev/full", numbered_lightmap(300, 300, kRgb), {}); });

    EXPECT_EQ(message, "/dev/full: No space left on device");
}

TEST_F(WriteExr, AMissingFolderIsTold) {
    EXPECT_THROW(write_exr(file("no/a.exr"), numbered_lightmap(2, 2, kRgb), {}), OutputError);
    EXPECT_TRUE(names_in_folder().empty());
}

}  // namespace
}  // namespace hemirad::write_exr_test
