#include "solver/kernel_source.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "errors.h"
#include "solver/embedded_kernels.h"

namespace hemirad::kernel_source_test {
namespace {

namespace fs = std::filesystem;

/// A folder of kernels with its mp1map beside it, as in the source tree.
class KernelSource : public testing::Test {
  protected:
    KernelSource() {
        fs::create_directories(kernels_);
        fs::create_directories(root_ / "mp1map");
    }
    ~KernelSource() override { fs::remove_all(root_); }

    void write(const std::string& file, const std::string& text) {
        std::ofstream(root_ / file) << text;
    }
    std::string line_directive(int line, const std::string& file) const {
        return "#line " + std::to_string(line) + " \"" + (kernels_ / file).string() + "\"\n";
    }

    fs::path root_ = fs::path(testing::TempDir()) /
                     testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::path kernels_ = root_ / "kernels";
};

std::size_t occurrences(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST_F(KernelSource, PutsIncludesInTheirPlaceWithTheLinesOfTheFiles) {
    write("kernels/a.cl", "one\n#include \"b.clh\"\nthree\n");
    write("kernels/b.clh", "two\n");

    EXPECT_EQ(kernel_source("a", kernels_), line_directive(1, "a.cl") + "one\n" +
                                                line_directive(1, "b.clh") + "two\n" +
                                                line_directive(3, "a.cl") + "three\n");
}

TEST_F(KernelSource, IncludesAFileOnce) {
    write("kernels/a.cl", "#include \"b.clh\"\n#include \"c.clh\"\n");
    write("kernels/b.clh", "#pragma once\n#include \"c.clh\"\n");
    write("kernels/c.clh", "#include \"b.clh\"\nsee\n");

    const auto source = kernel_source("a", kernels_);

    EXPECT_EQ(occurrences(source, "see"), 1u);
    EXPECT_EQ(occurrences(source, "#pragma once"), 0u);
}

TEST_F(KernelSource, FindsTheMachineBesideTheKernels) {
    write("kernels/a.cl", "#include \"mp1map/pe.clh\"\n");
    write("mp1map/pe.clh", "the machine\n");

    EXPECT_EQ(occurrences(kernel_source("a", kernels_), "the machine"), 1u);
}

TEST_F(KernelSource, LeavesSystemIncludesAndOtherLinesAlone) {
    write("kernels/a.cl", "#include <stdint.h>\nint include;\n// #include \"b.clh\"\n");

    EXPECT_EQ(kernel_source("a", kernels_), line_directive(1, "a.cl") +
                                                "#include <stdint.h>\nint include;\n"
                                                "// #include \"b.clh\"\n");
}

TEST_F(KernelSource, NamesTheLineOfAMissingInclude) {
    write("kernels/a.cl", "\n#include \"nowhere.clh\"\n");

    try {
        kernel_source("a", kernels_);
        FAIL() << "nothing thrown";
    } catch (const InputError& fault) {
        EXPECT_EQ(std::string(fault.what()), (kernels_ / "a.cl").string() +
                                                 ":2: include \"nowhere.clh\": no such file in "
                                                 "kernels or mp1map");
    }
}

TEST_F(KernelSource, RejectsAKernelThatIsNotThere) {
    EXPECT_THROW(kernel_source("nothing"), InputError);
    EXPECT_THROW(kernel_source("nothing", kernels_), InputError);
}

TEST(EmbeddedKernels, AreTheFilesOfTheTree) {
    std::ifstream file(HEMI_SOURCE_DIR "/kernels/project_patches.cl");
    const std::string text{std::istreambuf_iterator<char>(file), {}};

    EXPECT_EQ(embedded_kernel("kernels/project_patches.cl"), text);
    EXPECT_TRUE(embedded_kernel("kernels/nothing.cl").empty());
}

TEST(EmbeddedKernels, SayTheSameAsTheFolderTheyComeFrom) {
    const auto without_lines = [](const std::string& source) {
        std::istringstream stream(source);
        std::string kept;
        for (std::string line; std::getline(stream, line);)
            if (!line.starts_with("#line ")) kept += line + '\n';
        return kept;
    };

    EXPECT_EQ(without_lines(kernel_source("project_patches")),
              without_lines(kernel_source("project_patches", HEMI_SOURCE_DIR "/kernels")));
}

}  // namespace
}  // namespace hemirad::kernel_source_test
