// Every clearance as a line of comma-separated values.
#pragma once

#include <span>
#include <string>

#include "core/session.h"
#include "sessions/recorded_contacts.h"

namespace elbowroom::sessions {

// A header line, then a line for each row, as ContactsCsv writes them; what isn't bounded is empty. Beside
// the verdict stands which way it errs.
[[nodiscard]] std::string ClearanceCsv(const core::SessionHeader& header, std::span<const ContactRow> rows);

// "may be the hull's alone", ...: plain text.
[[nodiscard]] std::string_view HowItErrs(core::Verdict verdict);

}  // namespace elbowroom::sessions
