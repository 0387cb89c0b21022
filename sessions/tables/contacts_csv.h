// Every contact as a line of comma-separated values.
#pragma once

#include <span>
#include <string>

#include "core/layout.h"
#include "sessions/recorded_contacts.h"

namespace elbowroom::sessions {

// A header line, then a line for each row (RFC 4180, but lines end in \n). Numbers have the fewest digits
// that read back exactly; what isn't known is empty. One column a spacing, named "spacing NAME mm".
[[nodiscard]] std::string ContactsCsv(const core::Layout& layout, std::span<const ContactRow> rows);
// One of these lines, as a session of any length is read.
[[nodiscard]] std::string ContactLine(const core::Layout& layout, const ContactRow& row);

}  // namespace elbowroom::sessions
