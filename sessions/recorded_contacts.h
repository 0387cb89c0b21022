// The contacts and clearances of the parts, read back from rows.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/contact.h"
#include "core/ids.h"
#include "core/layout.h"
#include "sessions/database/database.h"

namespace elbowroom::sessions {

// A part's contact in a frame, with the frame's time and spacings.
struct ContactRow {
  core::FrameIndex frame = 0;
  double time_s = 0.0;
  std::vector<double> spacing_mm;  // in the layout's order
  core::PartContact contact;       // without its points
};

// In how many frames a part had each verdict.
struct PartTotals {
  core::PartIndex part = 0;
  std::int64_t frames_in_contact = 0;
  std::int64_t frames_near = 0;
  std::int64_t frames_undecided = 0;
  std::int64_t frames_clear = 0;
  core::QueryCount count;  // of contact, over all frames
};

using RowVisitor = std::function<void(const ContactRow&)>;

// The largest that a verdict on the part allowed for.
struct PartBudget {
  core::PartIndex part = 0;
  core::ErrorBudget largest;
};

// All throw Error{kDatabase}, or Error{kFormat} where a row is damaged.
// Each part of the layout once, in its order, as far as the frame has rows.
[[nodiscard]] std::vector<core::PartContact> ReadContacts(Database& database, std::size_t parts,
                                                          core::FrameIndex frame);
// Those with the verdict 'contact', and those with a clearance, by frame and part, in one pass. Without a
// visitor rows of its kind aren't read.
void VisitRows(Database& database, const core::Layout& layout, const RowVisitor& on_contact,
               const RowVisitor& on_clearance);
// One a part.
[[nodiscard]] std::vector<PartTotals> ReadPartTotals(Database& database, const core::Layout& layout);
// One a part for which one was computed, by part.
[[nodiscard]] std::vector<PartBudget> ReadPartBudgets(Database& database, const core::Layout& layout);

}  // namespace elbowroom::sessions
