// The queries that docs/session_database.md tells readers to ask.
#pragma once

#include <string>
#include <vector>

namespace elbowroom::test_support {

// The text of every ```sql block, in order.
[[nodiscard]] std::vector<std::string> DocumentedQueries();

}  // namespace elbowroom::test_support
