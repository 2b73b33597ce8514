#include "view/write_page.h"

#include <gtest/gtest.h>

#include "lightmap/support.h"
#include "lit_scenes.h"

namespace hemirad::write_page_test {
namespace {

class WritePage : public InFolder {
  protected:
    std::string page(const LitScene& lit) const {
        write_page(file("a.html"), lit, {});
        return bytes_of(file("a.html"));
    }
};

TEST_F(WritePage, VerticesThatNoFaceUsesChangeNothing) {
    LitScene lit = scene_lit_by({1});
    add_material(lit, 0.5, 0);
    add_wall(lit, -1);
    const std::string before = page(lit);

    lit.scene.positions.emplace_back(1e6, 0, 0);

    EXPECT_TRUE(page(lit) == before);
}

}  // namespace
}  // namespace hemirad::write_page_test
