#include "mp1map/program.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "mp1map/acu.h"
#include "solver/kernel_source.h"

namespace mp1map::program_test {
namespace {

namespace fs = std::filesystem;

std::string build_failure(const std::vector<std::string>& names, const std::string& source) {
    try {
        build_kernels(Device::open(""), names, source, "");
    } catch (const DeviceError& error) {
        return error.what();
    }
    return {};
}

// A folder of kernels that is gone with the test.
class KernelFolder {
  public:
    KernelFolder() { fs::create_directories(path_); }
    ~KernelFolder() { fs::remove_all(path_); }
    KernelFolder(const KernelFolder&) = delete;
    KernelFolder& operator=(const KernelFolder&) = delete;

    void write(const std::string& file, const std::string& text) {
        std::ofstream(path_ / file) << text;
    }
    const fs::path& path() const { return path_; }

  private:
    fs::path path_ = fs::path(testing::TempDir()) / ("hemirad-kernels-" + std::to_string(getpid()));
};

TEST(Program, HoldsAKernelOfEachName) {
    const auto kernels = build_kernels(Device::open(""), {"one", "two"},
                                       "__kernel void one(__global int* a) { *a = 1; }\n"
                                       "__kernel void two(__global int* a) { *a = 2; }\n",
                                       "");

    EXPECT_EQ(kernels.size(), 2u);
    EXPECT_EQ(kernels.at("two").name, "two");
}

TEST(Program, OptionsReachTheCompiler) {
    const auto device = Device::open("");
    auto kernels = build_kernels(
        device, {"say"}, "__kernel void say(__global int* a) { *a = WORD; }", "-DWORD=4711");
    Acu acu(device, false);
    auto word = acu.plural<std::int32_t>(1);

    acu.issue(kernels.at("say"), {}, word);

    EXPECT_EQ(acu.unload(word).front(), 4711);
}

TEST(Program, SquareRootsAndQuotientsAreRoundedCorrectly) {
    const auto device = Device::open("");
    auto kernels = build_kernels(device, {"divide"},
                                 "__kernel void divide(__global float* a) {\n"
                                 "    const int i = get_global_id(0);\n"
                                 "    a[i] = sqrt((float)i) / 3.0f;\n"
                                 "}\n",
                                 "");
    Acu acu(device, false);
    auto values = acu.plural<float>(1 << 16);

    acu.issue(kernels.at("divide"), {1 << 10, 1 << 6}, values);

    const auto result = acu.unload(values);
    for (std::size_t i = 0; i < result.size(); ++i)
        ASSERT_EQ(result[i], std::sqrt(static_cast<float>(i)) / 3.0f) << i;
}

// NVIDIA's does not.
bool minds_line_directives() { return Device::open("").summary().platform != "NVIDIA CUDA"; }

TEST(Program, ASourceThatDoesNotCompileNamesItsFileAndLine) {
    if (!minds_line_directives()) GTEST_SKIP() << "a compiler that counts a kernel's own lines";
    const auto message = build_failure({"wrong"},
                                       "#line 41 \"kernels/wrong.cl\"\n"
                                       "__kernel void wrong(__global int* a) {\n"
                                       "    *a = no_such_name;\n"
                                       "}\n");

    EXPECT_NE(message.find("kernels/wrong.cl:42"), std::string::npos) << message;
    EXPECT_NE(message.find("no_such_name"), std::string::npos) << message;
    EXPECT_NE(message.find(Device::open("").summary().name), std::string::npos) << message;
}

TEST(Program, AMistakeInAnIncludedFileIsNamedThereAndTheNextOneInTheKernelsOwn) {
    if (!minds_line_directives()) GTEST_SKIP() << "a compiler that counts a kernel's own lines";
    KernelFolder folder;
    folder.write("angle.clh", "static int angle(void) {\n    return no_such_angle;\n}\n");
    folder.write("turn.cl",
                 "#include \"angle.clh\"\n"
                 "\n"
                 "__kernel void turn(__global int* a) {\n"
                 "    *a = angle() + no_such_turn;\n"
                 "}\n");

    const auto message = build_failure({"turn"}, hemirad::kernel_source("turn", folder.path()));

    EXPECT_NE(message.find("angle.clh:2"), std::string::npos) << message;
    EXPECT_NE(message.find("turn.cl:4"), std::string::npos) << message;
}

TEST(Program, AKernelThatTheSourceLacksIsADeviceError) {
    const auto message = build_failure({"present", "absent"}, "__kernel void present(void) {}\n");

    EXPECT_FALSE(message.empty());
}

}  // namespace
}  // namespace mp1map::program_test
