// One frame as rows: time, spacings, silhouettes, and the results of every part.
#pragma once

#include <span>

#include "core/session.h"
#include "sessions/database/database.h"
#include "sessions/database/statement.h"
#include "sessions/packing.h"

namespace elbowroom::sessions {

// Whether there is evidence of the part. Without any, its row in part_frame holds all that there is.
[[nodiscard]] bool HasContactRow(const core::PartContact& contact);

// Keeps its statements prepared from frame to frame.
class FrameInserter {
 public:
  explicit FrameInserter(Database& database);

  // Inserts into the open transaction. Throws: Error{kDatabase}, also when the frame is there already.
  void Insert(const core::FrameRecord& record);

 private:
  void InsertSilhouettes(core::FrameIndex frame, std::span<const core::SoftMask> masks);
  [[nodiscard]] std::int64_t MaskIdOf(const core::SoftMask& mask);
  void InsertPart(core::FrameIndex frame, const core::PartContact& contact);
  void InsertEvidence(core::FrameIndex frame, const core::PartContact& contact);
  void InsertClearance(core::FrameIndex frame, const core::PartContact& contact);
  void InsertMotions(const core::FrameRecord& record);
  void InsertStamps(const core::FrameRecord& record);

  Compressor compressor_;
  Statement insert_frame_;
  Statement insert_spacing_;
  Statement find_mask_;
  Statement insert_mask_;
  Statement insert_silhouette_;
  Statement insert_part_frame_;
  Statement insert_contact_;
  Statement insert_point_;
  Statement insert_clearance_;
  Statement insert_motion_;
  Statement insert_stamp_;
};

// Throws: Error{kRange} when there is no such frame; Error{kFormat} naming it where its rows are damaged or
// don't fit the rig and layout of `header`.
[[nodiscard]] core::FrameRecord ReadFrame(Database& database, const core::SessionHeader& header,
                                          core::FrameIndex frame);

}  // namespace elbowroom::sessions
