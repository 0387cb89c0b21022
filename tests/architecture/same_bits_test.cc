// What equal bits on every processor rest on: nothing is fused or reordered that the source doesn't.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/places.h"
#include "tests/support/text_file.h"

namespace elbowroom::architecture {
namespace {

namespace fs = std::filesystem;

// As kernels are compiled: for processors that can multiply and add in one step, rounding once.
__attribute__((target("fma"), noinline)) double ProductPlus(double a, double b, double c) {
  return a * b + c;
}

TEST(SameBits, AProductIsRoundedBeforeItIsAddedTo) {
  if (!__builtin_cpu_supports("fma")) GTEST_SKIP() << "NOT TESTED: this processor can't fuse";
  const double tiny = 0x1p-27;
  EXPECT_EQ(ProductPlus(1.0 + tiny, 1.0 - tiny, -1.0), 0.0) << "fused, it would be -2^-54";
}

TEST(SameBits, EveryFileIsCompiledSo) {
  const fs::path commands = test_support::ProgramFile().parent_path() / "compile_commands.json";
  const nlohmann::json all = nlohmann::json::parse(test_support::ReadText(commands));
  ASSERT_GT(all.size(), 100U);
  for (const auto& one : all) {
    const auto command = one["command"].get<std::string>(), file = one["file"].get<std::string>();
    EXPECT_NE(command.find(" -ffp-contract=off"), std::string::npos) << file;
    for (const char* unsafe : {"-ffast-math", "-funsafe-math-optimizations", "-Ofast", "-march="})
      EXPECT_EQ(command.find(unsafe), std::string::npos) << file;
  }
}

}  // namespace
}  // namespace elbowroom::architecture
