// Every clearance as a line of comma-separated values.
#pragma once

#include <span>
#include <string>

#include "core/session.h"
#include "sessions/recorded_contacts.h"

namespace elbowroom::sessions {

// A header line, then a line for each row, as ContactsCsv writes them; an infinite bound is empty. The column
// after the verdict says how the verdict may err.
[[nodiscard]] std::string ClearanceCsv(const core::SessionHeader& header, std::span<const ContactRow> rows);
// One of these lines, as a session of any length is read.
[[nodiscard]] std::string ClearanceLine(const core::SessionHeader& header, const ContactRow& row);

// How the verdict may err, as plain text: "may be the hull's alone", ...
[[nodiscard]] std::string_view HowItErrs(core::Verdict verdict);

}  // namespace elbowroom::sessions
