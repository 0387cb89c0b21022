#include "tests/support/documents/page_in_browser.h"

#include <gtest/gtest.h>

#include "tests/support/places.h"
#include "tests/support/run_program.h"

namespace elbowroom::tests {

bool HasBrowser() { return std::filesystem::exists("/usr/bin/chromium"); }

void ExpectPageWorks(const std::filesystem::path& page, const std::filesystem::path& screenshots) {
  const std::filesystem::path source = test_support::SourceFolder();
  const test_support::ProgramRun run = test_support::RunProgram(
      ELBOWROOM_NODE, {(source / "web/test/report_page.mjs").string(),
                       (source / "build/web/node_modules").string(), page.string(), screenshots.string()});
  EXPECT_EQ(run.exit_status, 0) << run.err;
}

}  // namespace elbowroom::tests
