#include "tests/support/soak.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>

namespace elbowroom::test_support {
namespace {

// Sets the variable for one test and puts the old value back.
class SoakScaleTest : public testing::Test {
 protected:
  SoakScaleTest() {
    if (const char* before = std::getenv(kVariable)) before_ = before;
  }
  ~SoakScaleTest() override {
    if (before_) {
      setenv(kVariable, before_->c_str(), 1);
    } else {
      unsetenv(kVariable);
    }
  }
  static constexpr const char* kVariable = "ELBOWROOM_SOAK_SCALE";

 private:
  std::optional<std::string> before_;
};

TEST_F(SoakScaleTest, IsOneUnlessSet) {
  unsetenv(kVariable);
  EXPECT_EQ(SoakScale(), 1);
}

TEST_F(SoakScaleTest, IsWhatIsSet) {
  setenv(kVariable, "50", 1);
  EXPECT_EQ(SoakScale(), 50);
}

TEST_F(SoakScaleTest, RefusesWhatIsNoFactor) {
  for (const char* text : {"", "0", "-3", "many", "2x", "1.5", "99999999999"}) {
    setenv(kVariable, text, 1);
    EXPECT_THROW((void)SoakScale(), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace elbowroom::test_support
