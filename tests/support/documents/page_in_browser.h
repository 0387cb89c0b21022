// A report's page in a browser.
#pragma once

#include <filesystem>

namespace elbowroom::tests {

[[nodiscard]] bool HasBrowser();

// Fails the running test unless the page makes no request, tells the console nothing, isn't wider than its
// window, draws its charts with and without scripts, and its filters and 3-D view, where it has them, work.
// Screenshots in light and dark go to a folder, which is made.
void ExpectPageWorks(const std::filesystem::path& page, const std::filesystem::path& screenshots);

}  // namespace elbowroom::tests
