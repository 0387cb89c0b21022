#include "core/procedure/tools_in_use.h"

#include <gtest/gtest.h>

namespace elbowroom::core {
namespace {

using Names = std::vector<std::string>;

TEST(ToolsOfFrames, AreThoseMarkedUpToTheFrame) {
  ToolsOfFrames tools({{3, 0.1, ToolMarked{"tongs", true}},
                       {3, 0.1, Note{"a note"}},
                       {5, 0.2, ToolMarked{"driver", true}},
                       {5, 0.2, ToolMarked{"tongs", true}},
                       {7, 0.3, ToolMarked{"tongs", false}},
                       {7, 0.3, ToolMarked{"saw", false}}});
  EXPECT_EQ(tools.At(2), Names{});
  EXPECT_EQ(tools.At(3), Names{"tongs"});
  EXPECT_EQ(tools.At(6), (Names{"driver", "tongs"}));
  EXPECT_EQ(tools.At(7), Names{"driver"}) << "put away once, though taken twice";
  EXPECT_EQ(tools.At(1000), Names{"driver"});
}

}  // namespace
}  // namespace elbowroom::core
